"""Bearings of a REXS model as ``[bearing.NAME]``, and how they sit on shafts.

A bearing supports the shaft where it moves to +u (``positive``), to -u, both ways or none; so does each of its rows.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.exchange.case_tables import Key, Table, inline, listed, number, quantity, text
from fegear.exchange.rexs.catalogue_bearings import catalogue_keys, printed_bearing
from fegear.exchange.rexs.places import BEARINGS
from fegear.exchange.rexs.said import RIGID

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fegear.exchange.rexs.catalogue_bearings import Printed
    from fegear.exchange.rexs.model import Component
    from fegear.exchange.rexs.places import Place
    from fegear.exchange.rexs.said import Said

_BOTH, _NONE, _PLUS, _MINUS = "both_directions", "no_direction", "positive", "negative"
#: Distance of axes that are one [m].
_COAXIAL = 1e-6
#: What a bearing that slides in its seat holds along the axis [N/m]: nothing beside any other.
_SLIDES = 1e3


@dataclass(frozen=True, slots=True)
class Held:
    """A bearing of a shaft.

    Parameters
    ----------
    component : Component
    name : str
        In the case.
    at : float
        Where it acts [m].
    outside : bool
        Whether the shaft is its outer part.
    rows : Rows, optional
        What rolls in it, where that is said.
    stopped : bool
        Whether something beside what rolls in it holds the shaft along its axis.
    joins : Component, optional
        The other shaft of the case that it sits on; the inner one has it in the case.
    """

    component: Component
    name: str
    at: float
    outside: bool = False
    rows: Rows | None = None
    stopped: bool = False
    joins: Component | None = None

    @property
    def seats(self) -> list[tuple[str, bool, bool]]:
        """Of each bearing of the case at this place: its name, whether it holds to -u, and whether that matters."""
        ways = self.rows.ways if self.rows else (False,)
        found = [(self.name, way != self.outside, bool(self.rows and self.rows.angle)) for way in ways]
        return [*found, (self._stop, False, False)] if self.stopped else found

    @property
    def _stop(self) -> str:
        return f"{self.name}_along"

    def tilts(self, said: Said) -> bool:
        """Whether it resists tilt: its rollers do, and what has a stiffness against it."""
        if self.rows:
            return self.rows.length is not None
        return bool(said.number(self.component, "tilting stiffness", "bending_stiffness"))


@dataclass(frozen=True, slots=True)
class Rows:
    """What rolls in a bearing, alike in its rows.

    Parameters
    ----------
    count : float
        Elements of a row.
    diameter, pitch : float
        Of an element, and of the circle of their centres [m].
    angle : float
        Contact angle [rad].
    length : float or None
        Of a roller [m]; None for balls.
    grooves : tuple of float, optional
        Radii of the grooves of inner and outer ring over the ball's diameter.
    ways : tuple of bool
        Of each row whether it holds to -u in place of +u.
    about : str
        Where it comes from.
    printed : Printed, optional
        From what it was estimated, if the model has dimensions and ratings only.
    """

    count: float
    diameter: float
    pitch: float
    angle: float
    length: float | None
    grooves: tuple[float, float] | None
    ways: tuple[bool, ...]
    about: str
    printed: Printed | None = None

    @property
    def locates(self) -> bool:
        """Whether it holds a shaft both ways without a contact angle: balls, ribs of both rings, two rows."""
        return self.length is None or (self.printed is not None and self.printed.locates)


def bearings_of(
    said: Said, shaft: Component, names: Mapping[int, str], places: Mapping[int, Place] | None = None
) -> list[Held]:
    """What holds a shaft; of bearings between shafts of which the case has one alone the casing holds the other ring.

    Such a one inside the end of a shaft that other bearings hold at two places holds the inner shaft alone.

    Parameters
    ----------
    said : Said
    shaft : Component
    names : mapping
        Of the bearings.
    places : mapping
        Where the shafts of the case stand.
    """
    found: list[Held] = []
    for side, other, at in (("inner_part", "outer_part", "inner"), ("outer_part", "inner_part", "outer")):
        for one in said.linked(shaft, side, "side", "assembly", *BEARINGS):
            mates = [mate for mate in said.linked(one, "assembly", "side", other) if mate.type == "shaft"]
            joins = next((mate for mate in mates if _coaxial(places or {}, shaft, mate)), None)
            alone = bool(mates) and joins is None
            if alone and at == "outer" and len({held.at for held in found}) > 1:
                said.notes.append(f"{one.said}: reaction on {shaft.said} neglected.")
                continue
            if alone:
                said.notes.append(
                    f"{one.said} supports {shaft.said} in another shaft; treated as supported by the housing."
                )
            place = said.needed(one, "length", f"u_coordinate_on_shaft_{at}_side", "u_coordinate_on_shaft_inner_side")
            found.append(Held(one, names[one.id], place, outside=at == "outer", rows=_rows(said, one), joins=joins))
    return sorted(found, key=lambda one: one.at)


def _coaxial(places: Mapping[int, Place], one: Component, other: Component) -> bool:
    """Whether both are shafts of the case on one axis."""
    if one is other or one.id not in places or other.id not in places:
        return False
    first, second = places[one.id], places[other.id]
    return math.hypot(second.v - first.v, second.w - first.w) <= _COAXIAL


def fixed_bearing(said: Said, shaft: Component, bearings: Sequence[Held], push: float) -> Held:
    """The bearing that holds a shaft along its axis; a note where the model does not say one that does.

    Parameters
    ----------
    said : Said
    shaft : Component
    bearings : sequence of Held
    push : float
        Force of its meshes along the shaft's own u [N]: of bearings that hold one way, that which takes it is chosen.
    """
    bearings = sorted(bearings, key=lambda one: one.joins is not None)  # the casing holds before another shaft does
    ways = [_holds(said, one.component) for one in bearings]
    for kind in (_BOTH, *((_MINUS, _PLUS) if push < 0.0 else (_PLUS, _MINUS))):
        if kind not in ways:
            continue
        found = bearings[ways.index(kind)]
        if kind != _BOTH and not (found.rows and found.rows.angle and {_PLUS, _MINUS} <= set(ways)):
            said.notes.append(
                f"{shaft.said}: no axial support in both directions; {found.component.said} assumed as locating "
                "bearing."
            )
        return found
    if any(ways):
        said.notes.append(
            f"{shaft.said}: no axial support specified; {bearings[0].component.said} assumed as locating bearing."
        )
    return bearings[0]


def stopped_along(said: Said, shaft: Component, bearings: Sequence[Held], along: Held) -> list[Held]:
    """Bearings of a shaft, that which holds it along its axis with a stop where what rolls in them cannot.

    Parameters
    ----------
    said : Said
    shaft : Component
    bearings : sequence of Held
    along : Held
        The one of them that holds the shaft.
    """
    held = {way for one in bearings if one.rows for way in _thrust(said, one, one.rows)}
    if along.rows is None or held == {False, True}:
        return list(bearings)
    said.notes.append(
        f"{along.component.said}: rolling elements do not support {shaft.said} in both axial "
        "directions; ring assumed axially fixed."
    )
    return [replace(one, stopped=one is along) for one in bearings]


def _thrust(said: Said, one: Held, rows: Rows) -> set[bool]:
    """Whether it holds to +u (False) and to -u (True): balls and ribs both ways, others by their contact angle."""
    if _holds(said, one.component) == _NONE or not (rows.angle or rows.locates):
        return set()
    return {way != one.outside for way in rows.ways} if rows.angle else {False, True}


def _holds(said: Said, one: Component) -> str:
    return (said.word(one, "axial_force_absorption") or "").lower()


def bearing_tables(said: Said, held: Held, *, fixed: bool) -> list[Table]:
    """``[bearing.NAME]``: what rolls in it, else its stiffness, else rigid; and its stop.

    Parameters
    ----------
    said : Said
    held : Held
    fixed : bool
        Whether it holds the shaft along the axis, where it has no axial stiffness.
    """
    one = held.component
    keys = _elements(said, held, fixed=fixed) if held.rows else _stiffness(said, one, fixed=fixed)
    life = _life(said, one, len(held.rows.ways) if held.rows else 1)
    if not life and held.rows and held.rows.printed:
        known = any(key.name == "designation" for key in keys)
        rating = "that of the designation" if known else "estimated from the dimensions"
        life = [Key("life", "{}", f"no dynamic load rating: {rating}")]
    designation = said.word(one, "catalogue_designation", "name") or ""
    maker = said.word(one, "manufacturer") or ""
    about = " ".join(part for part in (one.said, one.name, designation, maker) if part)
    tables = [Table(f"bearing.{held.name}", (*keys, *life), about)]
    if held.stopped:
        stop = (
            Key("radial", quantity(0.0, "N/um"), "no radial stiffness"),
            Key("fixed", "true", "axial_force_absorption"),
        )
        tables.append(Table(f"bearing.{held.name}_along", stop, f"flanges of {one.said}"))
    return tables


def _stiffness(said: Said, one: Component, *, fixed: bool) -> list[Key]:
    radial = said.number(one, "stiffness", "radial_stiffness")
    axial = said.number(one, "stiffness", "axial_stiffness")
    tilting = said.number(one, "tilting stiffness", "bending_stiffness")
    clearance = _clearance(said, one)
    keys = []
    soft = radial is not None and 0.0 < radial < RIGID
    if said.yes(one, "radial_force_absorption") is False:
        keys.append(Key("radial", quantity(0.0, "N/um"), "radial_force_absorption"))
    elif soft:
        keys.append(Key("radial", quantity(radial or 0.0, "N/um"), "radial_stiffness"))
    elif radial is not None and radial < 0.0:
        raise InputError(
            "radial_stiffness", f"{radial:g} N/m", f"of {one.said} must not be negative", "correct the value"
        )
    else:
        said.notes.append(f"{one.said}: neither rolling elements nor stiffness specified; radially rigid.")
    if fixed and axial is not None and 0.0 < axial < RIGID:
        keys.append(Key("axial", quantity(axial, "N/um"), "axial_stiffness"))
    elif fixed:
        keys.append(Key("fixed", "true", "axial_force_absorption; axially rigid"))
    if tilting:
        keys.append(Key("tilting", quantity(min(tilting, RIGID), "N*m/rad"), "bending_stiffness"))
    if clearance and soft and not fixed:
        keys.append(Key("radial_clearance", quantity(0.5 * clearance, "um"), "half the radial bearing clearance"))
    elif clearance:
        said.notes.append(f"{one.said}: clearance of {clearance * 1e6:g} um ignored (rigid or fixed bearing).")
    return keys or [Key("tilting", quantity(0.0, "N*m/rad"), "radially rigid, free to tilt and to move axially")]


def _clearance(said: Said, one: Component) -> float | None:
    return said.number(
        one, "length", "operating_radial_bearing_clearance", "mounted_radial_bearing_clearance",
        "radial_bearing_clearance", "radial_clearance", "radial_backlash",
    )  # fmt: skip


def _rows(said: Said, one: Component) -> Rows | None:
    """What rolls in a bearing, where its rows say it, else estimated; a note where that is impossible or differs."""
    rows = said.linked(one, "assembly", "assembly", "part", "rolling_bearing_row")
    if not rows:
        return _estimated(said, one, rows)
    row = rows[0]
    count = said.number(row, "number", "number_of_rolling_elements")
    pitch = said.number(row, "length", "reference_diameter")
    rolls = said.linked(row, "assembly", "assembly", "part", "rolling_element")
    diameter = said.number(rolls[0], "length", "diameter_of_rolling_element") if rolls else None
    roller = "roller" in (said.word(one, "bearing_type") or "")
    length = said.number(rolls[0], "length", "length_of_rolling_element") if roller and rolls else None
    if not (count and pitch and diameter) or (roller and not length):
        return _estimated(said, one, rows)
    if count < 3.0 or count != round(count) or diameter > pitch * math.sin(math.pi / count):
        said.notes.append(
            f"{one.said}: {count:g} elements of {diameter * 1e3:g} mm do not fit on a pitch diameter of "
            f"{pitch * 1e3:g} mm; ignored."
        )
        return None
    angle = abs(said.number(row, "angle", "pressure_angle") or 0.0)
    if angle and _holds(said, one) == _NONE:
        said.notes.append(
            f"{one.said} is a non-locating bearing: contact angle of {math.degrees(angle):g} deg ignored."
        )
        angle = 0.0
    races = [
        said.number(row, "length", f"raceway_radius_of_{ring}_ring", f"running_path_radius_of_{ring}_ring")
        for ring in ("inner", "outer")
    ]  # the latter in version 1.0
    grooves = None if roller or not all(races) else ((races[0] or 0.0) / diameter, (races[1] or 0.0) / diameter)
    return Rows(
        count, diameter, pitch, angle, length, grooves, _ways(said, one, rows, angle), f"{row.said}, {rolls[0].said}"
    )


def _estimated(said: Said, one: Component, rows: Sequence[Component]) -> Rows | None:
    """What rolls in a bearing of which the model prints dimensions and ratings."""
    printed = printed_bearing(said, one, rows, _clearance(said, one) or 0.0)
    if printed is None:
        return None
    inside = printed.bearing.inside
    angle = 0.0 if inside.aligning else inside.contact_angle
    if angle and _holds(said, one) == _NONE:
        said.notes.append(f"{one.said} is a non-locating bearing: contact angle of {math.degrees(angle):g} deg kept.")
    length = None if inside.kind == "ball" else inside.roller_length
    one_row = rows and not inside.aligning  # whose two rows are one bearing
    ways = _ways(said, one, rows, angle) if one_row else (bool(angle) and _holds(said, one) == _MINUS,)
    about = "dimensions and load ratings; rolling elements estimated"
    return Rows(
        inside.count, inside.element_diameter, inside.pitch_diameter, angle, length, None, ways, about, printed
    )  # fmt: skip


def _ways(said: Said, one: Component, rows: Sequence[Component], angle: float) -> tuple[bool, ...]:
    """Of each row whether it holds to -u: as it says, else as the bearing says, else every second one."""
    if len(rows) > 1:
        said.notes.append(f"{one.said}: {len(rows)} rows modelled as identical bearings at the same position.")
    own = [(said.word(row, "axial_force_absorption_of_row") or "").lower() for row in rows]
    if angle and len(rows) == 1:
        own = [own[0] if own[0] in (_PLUS, _MINUS) else _holds(said, one)]
        if own[0] not in (_PLUS, _MINUS):
            said.notes.append(f"{one.said}: direction of the contact angle not specified; +u assumed.")
    return tuple(way == _MINUS if way in (_PLUS, _MINUS) else bool(n % 2) for n, way in enumerate(own))


def _elements(said: Said, held: Held, *, fixed: bool) -> list[Key]:
    """What rolls in it; a bearing that would locate and slides has a seat that holds nothing along the axis."""
    one, rows = held.component, held.rows
    assert rows is not None  # noqa: S101  (for mypy: looked at before)
    clearance = _clearance(said, one)
    value = inline(
        kind=text("ball" if rows.length is None else "roller"), count=number(rows.count),
        diameter=quantity(rows.diameter, "mm"), pitch_diameter=quantity(rows.pitch, "mm"),
        contact_angle=quantity(rows.angle, "deg") if rows.angle else None,
        groove_ratio=listed(map(number, rows.grooves)) if rows.grooves else None,
        roller_length=quantity(rows.length, "mm") if rows.length else None,
        clearance=quantity(clearance, "um") if clearance else None,
    )  # fmt: skip
    keys = catalogue_keys(rows.printed, rows.about) if rows.printed else [Key("elements", value, rows.about)]
    if rows.locates and not fixed and _holds(said, one) == _NONE:
        keys.append(Key("housing_axial", quantity(_SLIDES, "N/um"), "axial_force_absorption: non-locating bearing"))
    return keys


def _life(said: Said, one: Component, rows: int) -> list[Key]:
    rating = said.number(one, "force", "radial_dynamic_load_rating", "dynamic_capacity")
    if not rating:
        return []
    x, y = (said.number(one, "number", name) for name in ("radial_factor_x_2", "axial_factor_y_2"))
    limit = said.number(one, "number", "catalogue_value_e")
    spoken = said.word(one, "bearing_type") or ""
    roller = "roller" in spoken
    if "spherical_roller" in spoken:
        x = None  # Y below e is in no attribute: factors of two rows follow from the contact angle
    # ISO 281: C of i rows alike is i^0.7 times that of one of balls, i^(7/9) times that of one of rollers.
    shared = rating / rows ** (7.0 / 9.0 if roller else 0.7)
    value = inline(
        dynamic_rating=quantity(shared, "kN"), kind=text("roller" if roller else "ball"),
        radial_factor=number(x) if x and y and limit else None, axial_factor=number(y) if x and y and limit else None,
        limit=number(limit) if x and y and limit else None,
    )  # fmt: skip
    also = f", one of {rows} rows to ISO 281" if rows > 1 else ""
    return [Key("life", value, f"dynamic load rating and catalogue factors{also}")]
