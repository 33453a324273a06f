"""Shafts and bearings of a REXS model as ``[shaft.NAME]`` and ``[bearing.NAME]``."""

from __future__ import annotations

from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.exchange.case_tables import Key, Table, inline, listed, number, quantity, text
from fegear.exchange.rexs.places import BEARINGS
from fegear.exchange.rexs.said import RIGID
from fegear.exchange.rexs.teeth import elasticity

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from fegear.exchange.rexs.model import Component
    from fegear.exchange.rexs.places import Place
    from fegear.exchange.rexs.said import Said

#: Sections may overlap or leave a gap by so much, and a bearing or gear may lie so far off the ends [m].
_GAP = 1e-7


@dataclass(frozen=True, slots=True)
class Section:
    """From where on a shaft and how long [m], with its outer and inner diameters at both ends [m]."""

    begin: float
    length: float
    outer: tuple[float, float]
    inner: tuple[float, float]

    @property
    def end(self) -> float:
        """Where it ends [m]."""
        return self.begin + self.length


@dataclass(frozen=True, slots=True)
class OnShaft:
    """What stands on a shaft, counted from the end where its own u begins [m].

    Parameters
    ----------
    gears : tuple of (str, float)
        Names and middles of faces.
    torque_at : tuple of float
        Where torque enters or leaves.
    """

    gears: tuple[tuple[str, float], ...]
    torque_at: tuple[float, ...] = ()


@dataclass(frozen=True, slots=True)
class Held:
    """A bearing of a shaft: its component, the case's name, and where it acts [m]."""

    component: Component
    name: str
    at: float


def sections_of(said: Said, shaft: Component) -> tuple[Section, ...]:
    """The sections of a shaft from end to end.

    Raises
    ------
    InputError
        If one lacks a size, or they overlap or leave a gap.
    """
    found = []
    at = 0.0
    for part in said.linked(shaft, "assembly", "assembly", "part", "shaft_section"):
        given = said.number(part, "length", "u_coordinate_on_shaft")
        begin = given if given is not None else at
        length = said.needed(part, "length", "length")
        outer = said.needed(part, "length", "outer_diameter_begin")
        outer_end = said.number(part, "length", "outer_diameter_end")
        inner = said.number(part, "length", "inner_diameter_begin") or 0.0
        inner_end = said.number(part, "length", "inner_diameter_end")
        at = begin + length
        ends = outer if outer_end is None else outer_end, inner if inner_end is None else inner_end
        found.append(Section(begin, length, (outer, ends[0]), (inner, ends[1])))
    found.sort(key=lambda one: one.begin)
    for one, two in pairwise(found):
        if abs(two.begin - one.end) > _GAP:
            what = "overlap" if two.begin < one.end else "leave a gap"
            raise InputError(
                "u_coordinate_on_shaft", f"{two.begin * 1e3:.6g} mm",
                f"makes sections of {shaft.said} {what} at {one.end * 1e3:.6g} mm", "correct lengths or places",
            )  # fmt: skip
    return tuple(found)


def diameter_below(sections: Sequence[Section], at: float) -> float | None:
    """Outer diameter of a shaft at a place [m]; None off its ends."""
    for one in sections:
        if one.begin <= at <= one.end:
            part = (at - one.begin) / one.length if one.length > 0.0 else 0.0
            return one.outer[0] + part * (one.outer[1] - one.outer[0])
    return None


def bearings_of(said: Said, shaft: Component, names: Mapping[int, str]) -> list[Held]:
    """What holds a shaft; bearings between shafts count as held by the casing."""
    found = []
    for side, other, at in (("inner_part", "outer_part", "inner"), ("outer_part", "inner_part", "outer")):
        for one in said.linked(shaft, side, "side", "assembly", *BEARINGS):
            mates = said.linked(one, "assembly", "side", other)
            if any(mate.type == "shaft" for mate in mates):
                said.notes.append(f"{one.said} holds {shaft.said} in another shaft: it is taken as held by the casing.")
            place = said.needed(one, "length", f"u_coordinate_on_shaft_{at}_side", "u_coordinate_on_shaft_inner_side")
            found.append(Held(one, names[one.id], place))
    return sorted(found, key=lambda one: one.at)


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
    ways = [(said.word(one.component, "axial_force_absorption") or "").lower() for one in bearings]
    for kind in ("both_directions", *(("negative", "positive") if push < 0.0 else ("positive", "negative"))):
        if kind not in ways:
            continue
        found = bearings[ways.index(kind)]
        if kind != "both_directions":
            said.notes.append(
                f"{shaft.said}: no bearing holds it both ways along its axis; {found.component.said} is taken to."
            )
        return found
    if any(ways):
        said.notes.append(
            f"{shaft.said}: no bearing holds it along its axis; {bearings[0].component.said} is taken to."
        )
    return bearings[0]


def bearing_table(said: Said, held: Held, *, fixed: bool) -> Table:
    """``[bearing.NAME]``: what rolls in it, else its stiffness, else rigid.

    Parameters
    ----------
    said : Said
    held : Held
    fixed : bool
        Whether it holds the shaft along the axis, where it has no axial stiffness.
    """
    one = held.component
    keys = _elements(said, one) or _stiffness(said, one, fixed=fixed)
    life = _life(said, one)
    designation = said.word(one, "catalogue_designation", "name") or ""
    maker = said.word(one, "manufacturer") or ""
    about = " ".join(part for part in (one.said, one.name, designation, maker) if part)
    return Table(f"bearing.{held.name}", (*keys, *life), about)


def _stiffness(said: Said, one: Component, *, fixed: bool) -> list[Key]:
    radial = said.number(one, "stiffness", "radial_stiffness")
    axial = said.number(one, "stiffness", "axial_stiffness")
    tilting = said.number(one, "tilting stiffness", "bending_stiffness")
    clearance = said.number(
        one, "length", "operating_radial_bearing_clearance", "mounted_radial_bearing_clearance",
        "radial_bearing_clearance", "radial_clearance", "radial_backlash",
    )  # fmt: skip
    keys = []
    soft = radial is not None and 0.0 < radial < RIGID
    if soft:
        keys.append(Key("radial", quantity(radial or 0.0, "N/um"), "radial_stiffness"))
    else:
        said.notes.append(f"{one.said}: neither what rolls in it nor a stiffness is said; it is rigid across the axis.")
    if fixed and axial is not None and 0.0 < axial < RIGID:
        keys.append(Key("axial", quantity(axial, "N/um"), "axial_stiffness"))
    elif fixed:
        keys.append(Key("fixed", "true", "axial_force_absorption; rigid along the axis"))
    if tilting:
        keys.append(Key("tilting", quantity(min(tilting, RIGID), "N*m/rad"), "bending_stiffness"))
    if clearance and soft and not fixed:
        keys.append(Key("radial_clearance", quantity(0.5 * clearance, "um"), "half the radial bearing clearance"))
    elif clearance:
        said.notes.append(f"{one.said}: its clearance of {clearance * 1e6:g} um is not used, for it is rigid or fixed.")
    return keys or [Key("tilting", quantity(0.0, "N*m/rad"), "rigid across the axis, free to tilt and to slide")]


def _elements(said: Said, one: Component) -> list[Key]:
    """``elements`` where the first row says what rolls in it."""
    rows = said.linked(one, "assembly", "assembly", "part", "rolling_bearing_row")
    if not rows:
        return []
    row = rows[0]
    count = said.number(row, "number", "number_of_rolling_elements")
    pitch = said.number(row, "length", "reference_diameter")
    rolls = said.linked(row, "assembly", "assembly", "part", "rolling_element")
    diameter = said.number(rolls[0], "length", "diameter_of_rolling_element") if rolls else None
    if not (count and pitch and diameter):
        return []
    if len(rows) > 1:
        said.notes.append(f"{one.said} has {len(rows)} rows, of which the first is read.")
    roller = "roller" in (said.word(one, "bearing_type") or "")
    length = said.number(rolls[0], "length", "length_of_rolling_element") if roller else None
    if roller and not length:
        return []
    angle = said.number(row, "angle", "pressure_angle") or 0.0
    clearance = said.number(
        one, "length", "operating_radial_bearing_clearance", "mounted_radial_bearing_clearance",
        "radial_bearing_clearance", "radial_backlash",
    )  # fmt: skip
    races = [said.number(row, "length", f"raceway_radius_of_{ring}_ring") for ring in ("inner", "outer")]
    grooves = None if roller or not all(races) else listed(number((race or 0.0) / diameter) for race in races)
    value = inline(
        kind=text("roller" if roller else "ball"), count=number(count), diameter=quantity(diameter, "mm"),
        pitch_diameter=quantity(pitch, "mm"), contact_angle=quantity(angle, "deg") if angle else None,
        groove_ratio=grooves, roller_length=quantity(length, "mm") if length else None,
        clearance=quantity(clearance, "um") if clearance else None,
    )  # fmt: skip
    return [Key("elements", value, f"{row.said}, {rolls[0].said}")]


def _life(said: Said, one: Component) -> list[Key]:
    rating = said.number(one, "force", "radial_dynamic_load_rating", "dynamic_capacity")
    if not rating:
        return []
    x, y = (said.number(one, "number", name) for name in ("radial_factor_x_2", "axial_factor_y_2"))
    limit = said.number(one, "number", "catalogue_value_e")
    kind = said.word(one, "bearing_type") or ""
    value = inline(
        dynamic_rating=quantity(rating, "kN"), kind=text("roller" if "roller" in kind else "ball"),
        radial_factor=number(x) if x and y and limit else None, axial_factor=number(y) if x and y and limit else None,
        limit=number(limit) if x and y and limit else None,
    )  # fmt: skip
    return [Key("life", value, "dynamic load rating and factors of the catalogue")]


def shaft_table(
    said: Said, shaft: Component, name: str, place: Place, on: OnShaft, bearings: Sequence[Held], origin: Place,
    *, clockwise: bool,
) -> Table:  # fmt: skip
    """``[shaft.NAME]``, from its left end in the sense of the gearbox.

    Parameters
    ----------
    said : Said
    shaft : Component
    name : str
    place, origin : Place
        Of this shaft and of the one where counting begins.
    on : OnShaft
    bearings : sequence of Held
    clockwise : bool
        Whether it turns against u.
    """
    sections = sections_of(said, shaft)
    begin, end = sections[0].begin, sections[-1].end
    for what, at in ((one.component.said, one.at) for one in bearings):
        _on(shaft, what, at, begin, end)
    for what, at in on.gears:
        _on(shaft, f"gear {what}", at, begin, end)

    def along(at: float) -> str:
        return quantity(end - at if place.reversed else at - begin, "mm")

    start = place.u - end if place.reversed else place.u + begin
    ordered = sections[::-1] if place.reversed else sections
    keys = [
        Key("axis", listed(quantity(one, "mm") for one in (place.v - origin.v, place.w - origin.w)), "support_vector"),
        Key("start", quantity(start - origin.u, "mm"), "support_vector along u"),
        Key("sections", listed(_section(one, flipped=place.reversed) for one in ordered), "shaft_section"),
    ]
    found = said.linked(shaft, "origin", "reference", "referenced", "material")
    elastic = elasticity(said, found[0]) if found else {}
    if "young_modulus" in elastic and found and _stiff(said, found[0]):
        keys.append(Key("rigid", "true", f"elastic_modulus of {found[0].said} is that of a rigid body"))
    elif elastic:
        keys.append(Key("material", inline(**elastic), found[0].said))
    if on.gears:
        places = listed(inline(gear=text(gear), at=along(at)) for gear, at in on.gears)
        keys.append(Key("gears", places, "middle of the face"))
    seats = listed(inline(bearing=text(one.name), at=along(one.at)) for one in bearings)
    keys.append(Key("bearings", seats, "u_coordinate_on_shaft"))
    if on.torque_at:
        keys.append(Key("coupling", along(on.torque_at[0]), "external_load that transmits torque"))
    loads = _loads(said, shaft, along, place)
    keys += [Key("loads", loads, "forces of external_load")] if loads else []
    keys += [Key("clockwise", "true", "rotational_speed below zero")] if clockwise else []
    return Table(f"shaft.{name}", tuple(keys), f"{shaft.said} {shaft.name}".strip())


def _stiff(said: Said, material: Component) -> bool:
    return (said.number(material, "stress", "elastic_modulus") or 0.0) > 1e13


def _on(shaft: Component, what: str, at: float, begin: float, end: float) -> None:
    if not begin - _GAP <= at <= end + _GAP:
        raise InputError(
            "u_coordinate_on_shaft", f"{at * 1e3:.6g} mm",
            f"puts {what} off {shaft.said}, which reaches from {begin * 1e3:.6g} to {end * 1e3:.6g} mm",
            "correct its place or the sections",
        )  # fmt: skip


def _section(one: Section, *, flipped: bool) -> str:
    outer, inner = (ends[::-1] if flipped else ends for ends in (one.outer, one.inner))
    return inline(
        length=quantity(one.length, "mm"),
        outer=quantity(outer[0], "mm"),
        outer_end=quantity(outer[1], "mm") if outer[1] != outer[0] else None,
        inner=quantity(inner[0], "mm") if any(inner) else None,
        inner_end=quantity(inner[1], "mm") if inner[1] != inner[0] else None,
    )


def _loads(said: Said, shaft: Component, along: Callable[[float], str], place: Place) -> str | None:
    """Forces and bending moments from outside; the torque about the axis is the coupling's."""
    found = []
    sign = -1.0 if place.reversed else 1.0
    for one in said.linked(shaft, "assembly", "assembly", "part", "external_load"):
        force = [said.number(one, "force", f"force_{axis}_direction") or 0.0 for axis in "vwu"]
        moment = [said.number(one, "torque", f"torque_around_{axis}_axis") or 0.0 for axis in "vw"]
        if not any((*force, *moment)):
            continue
        # A shaft drawn against u is turned about its v axis.
        force = [force[0], sign * force[1], sign * force[2]]
        moment = [moment[0], sign * moment[1], 0.0]
        at = said.needed(one, "length", "u_coordinate_on_shaft")
        found.append(
            inline(
                at=along(at),
                force=listed(quantity(value, "N") for value in force),
                moment=listed(quantity(value, "N*m") for value in moment),
            )
        )
    return listed(found) if found else None
