"""Shafts of a REXS model as ``[shaft.NAME]``."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from itertools import pairwise
from typing import TYPE_CHECKING

from fegear.base.errors import GeometryError, InputError
from fegear.exchange.case_tables import Key, Table, inline, listed, quantity, text
from fegear.exchange.rexs.places import joints_of, own_axes
from fegear.exchange.rexs.teeth import elasticity
from fegear.geometry.plausible import refuse_shaft

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fegear.exchange.rexs.bearings import Held
    from fegear.exchange.rexs.model import Component
    from fegear.exchange.rexs.places import Place
    from fegear.exchange.rexs.said import Frame, Said

#: Sections may overlap or leave a gap by so much, and a bearing or gear may lie so far off the ends [m].
_GAP = 1e-7
#: Gaps up to this are closed, as programs that round lengths leave them, and told [m].
_CLOSED = 0.2e-3


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
    coupling : float, optional
        Where the torque enters or leaves that balances the others.
    twisting : frozenset of int
        Loads whose torque acts where they stand.
    around : dict of str to str
        Shafts in which the outer rings of its bearings sit, by bearing.
    """

    gears: tuple[tuple[str, float], ...]
    coupling: float | None = None
    twisting: frozenset[int] = frozenset()
    around: dict[str, str] = field(default_factory=dict)


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
    _refuse_sizes(shaft, found)
    found.sort(key=lambda one: one.begin)
    for n, (one, two) in enumerate(pairwise(found)):
        if _GAP < two.begin - one.end <= _CLOSED:
            said.notes.append(f"{shaft.said}: gap of {1e3 * (two.begin - one.end):.4g} mm between sections closed.")
            found[n] = replace(one, length=two.begin - one.begin)
        elif abs(two.begin - one.end) > _GAP:
            what = "overlap" if two.begin < one.end else "leave a gap"
            raise InputError(
                "u_coordinate_on_shaft", f"{two.begin * 1e3:.6g} mm",
                f"makes sections of {shaft.said} {what} at {one.end * 1e3:.6g} mm", "correct lengths or positions",
            )  # fmt: skip
    return tuple(found)


def _refuse_sizes(shaft: Component, sections: Sequence[Section]) -> None:
    """Refuse a shaft of no length, of no thickness, or of a size that none has."""
    names = {"length": "length", "diameter": "outer_diameter_begin"}
    for one in sections:
        sizes = {"length": one.length, "outer_diameter_begin": min(one.outer)}
        for name, size in sizes.items():
            if not size > 0.0:
                rule = f"of a section of {shaft.said} must be positive"
                raise InputError(name, f"{size * 1e3:.6g} mm", rule, "correct the model")
        for outer, inner in zip(one.outer, one.inner, strict=True):
            if not 0.0 <= inner < outer:
                raise InputError(
                    "inner_diameter_begin", f"{inner * 1e3:.6g} mm",
                    f"of a section of {shaft.said} must be below its outer diameter of {outer * 1e3:.6g} mm",
                    "correct the model",
                )  # fmt: skip
    try:
        for one in sections:
            refuse_shaft(sum(part.length for part in sections), max(one.outer))
    except GeometryError as error:
        rule = f"of {shaft.said} {error.rule}"
        raise InputError(names[error.key], error.value, rule, "check the unit of the attribute") from None


def hole_below(sections: Sequence[Section], at: float) -> float | None:
    """Diameter of a shaft's hole at a place [m], zero where it is solid; None off its ends."""
    for one in sections:
        if one.begin <= at <= one.end:
            part = (at - one.begin) / one.length if one.length > 0.0 else 0.0
            return one.inner[0] + part * (one.inner[1] - one.inner[0])
    return None


def diameter_below(sections: Sequence[Section], at: float) -> float | None:
    """Outer diameter of a shaft at a place [m]; None off its ends."""
    for one in sections:
        if one.begin <= at <= one.end:
            part = (at - one.begin) / one.length if one.length > 0.0 else 0.0
            return one.outer[0] + part * (one.outer[1] - one.outer[0])
    return None


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
    whole = round(end - begin, 12)
    for what, at in ((one.component.said, one.at) for one in bearings):
        _on(shaft, what, at, begin, end)
    for what, at in on.gears:
        _on(shaft, f"gear {what}", at, begin, end)

    def along(at: float) -> str:
        found = end - at if place.reversed else at - begin
        return quantity(next((one for one in (0.0, whole) if abs(found - one) <= _GAP), found), "mm")

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
        keys.append(Key("rigid", "true", f"elastic_modulus of {found[0].said} (rigid body)"))
    elif elastic:
        keys.append(Key("material", inline(**elastic), found[0].said))
    if found and (limit := said.number(found[0], "stress", "yield_strength")):
        keys.append(Key("yield_strength", quantity(limit, "MPa"), found[0].said))
    if on.gears:
        places = listed(inline(gear=text(gear), at=along(at)) for gear, at in on.gears)
        keys.append(Key("gears", places, "mid-face"))
    seats = listed(
        inline(
            bearing=text(name),
            at=along(one.at),
            reversed="true" if back != place.reversed and turns else None,
            around=text(on.around[one.name]) if one.name in on.around else None,
        )
        for one in bearings
        for name, back, turns in one.seats
    )
    keys.append(Key("bearings", seats, "u_coordinate_on_shaft"))
    if on.coupling is not None:
        keys.append(Key("coupling", along(on.coupling), "external_load that transmits torque"))
    loads = _loads(said, shaft, along, on.twisting)
    keys += [Key("loads", loads, "forces of external_load")] if loads else []
    keys += [Key("clockwise", "true", "rotational_speed below zero")] if clockwise else []
    return Table(f"shaft.{name}", tuple(keys), f"{shaft.said} {shaft.name}".strip())


def is_rigid(said: Said, shaft: Component) -> bool:
    """Whether a shaft's material is that of a rigid body."""
    return any(_stiff(said, one) for one in said.linked(shaft, "origin", "reference", "referenced", "material")[:1])


def _stiff(said: Said, material: Component) -> bool:
    return (said.number(material, "stress", "elastic_modulus") or 0.0) > 1e13


def _on(shaft: Component, what: str, at: float, begin: float, end: float) -> None:
    if not begin - _GAP <= at <= end + _GAP:
        raise InputError(
            "u_coordinate_on_shaft", f"{at * 1e3:.6g} mm",
            f"places {what} outside {shaft.said}, {begin * 1e3:.6g} to {end * 1e3:.6g} mm",
            "correct its position or the sections",
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


def coupling_of(said: Said, shaft: Component) -> tuple[float | None, frozenset[int]]:
    """Where the torque of a shaft enters that balances the rest [m], and the loads whose own torque acts beside it.

    A case has one such place. It is where the model leaves the torque open, so that what it gives elsewhere stands.
    """
    given: dict[int, float] = {}
    places: list[tuple[bool, float, Component | None]] = []
    for one in said.linked(shaft, "assembly", "assembly", "part", "external_load"):
        torque = said.number(one, "torque", "torque_around_u_axis")
        if torque or said.yes(one, "transmits_torque"):
            at = said.needed(one, "length", "u_coordinate_on_shaft")
            balances = not torque or (said.yes(one, "transmits_torque") and not said.yes(one, "defines_torque"))
            places.append((not balances, at, one))
            given.update({one.id: at} if torque else {})
    places += [(False, at, None) for at in joints_of(said, shaft)]
    if not places:
        return None, frozenset()
    _, coupling, chosen = min(places, key=lambda one: one[0])
    twisting = frozenset(given) - ({chosen.id} if chosen is not None else set())
    for _, at, other in places:
        if at != coupling and (other is None or other.id not in given):
            said.notes.append(
                f"{shaft.said}: torque input at {at * 1e3:.4g} mm not specified; total torque assumed at "
                f"{coupling * 1e3:.4g} mm."
            )
    return coupling, twisting


def _loads(said: Said, shaft: Component, along: Callable[[float], str], twisting: frozenset[int]) -> str | None:
    """Forces and moments from outside, along x, y and z; torques about the axis that the coupling does not take."""
    found = []
    axes = own_axes(said, shaft)
    for one in said.linked(shaft, "assembly", "assembly", "part", "external_load"):
        force = [said.number(one, "force", f"force_{axis}_direction") or 0.0 for axis in "uvw"]
        moment = [said.number(one, "torque", f"torque_around_{axis}_axis") or 0.0 for axis in "uvw"]
        moment[0] *= one.id in twisting
        if not any((*force, *moment)):
            continue
        # Loads are given along the shaft's own axes; x is v, y is w and z is u of the gearbox.
        force, moment = ([_part(axes, given, n) for n in (1, 2, 0)] for given in (force, moment))
        at = said.needed(one, "length", "u_coordinate_on_shaft")
        found.append(
            inline(
                at=along(at),
                force=listed(quantity(value, "N") for value in force),
                moment=listed(quantity(value, "N*m") for value in moment),
            )
        )
    return listed(found) if found else None


def _part(axes: Frame, along: Sequence[float], n: int) -> float:
    """Part along axis n of the gearbox of a vector that is given along a shaft's own axes."""
    return sum(value * axis[n] for value, axis in zip(along, axes, strict=True))
