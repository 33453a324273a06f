"""From ``[compound.NAME]`` to the set: its gears with their geometry, where planets stand, and how it runs."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

from fegear.base.errors import GeometryError, InputError
from fegear.case.nearest import nearest
from fegear.case.part import at
from fegear.dynamics.compound.assembly import check_assembly, check_neighbours, even_turns
from fegear.dynamics.compound.compound_set import CompoundSet, End, Mesh, Planets, Shaft, Wheel
from fegear.dynamics.compound.speeds_and_torques import Drive, Trains
from fegear.geometry.pair import GearPair

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.compound import CompoundPart, CompoundPlanetPart, CompoundShaftPart
    from fegear.case.reading import Scene
    from fegear.geometry.gear import Gear

#: Keys under which a pair refuses its gears.
_OF_GEARS = (
    "pair", "internal", "hand", "teeth", "normal_module", "helix_angle", "normal_pressure_angle", "axial_offset",
)  # fmt: skip


@dataclass(frozen=True)
class CompoundInputs:
    """A set as the mechanics takes it, and how it runs.

    Parameters
    ----------
    found : CompoundSet
    fixed : tuple of str
    input, output : str
        Driving and loaded shafts, empty where the case does not say how it runs.
    torque, speed : float
        Of the driving shaft [N m], [rad/s], the speed 1 where the case gives none.
    at_speed, clockwise : bool
    turning : tuple of (str, float)
        Torsional stiffness that holds the fixed shafts [N m/rad].
    harmonics : int
    name : str
    """

    found: CompoundSet
    fixed: tuple[str, ...]
    input: str
    output: str
    torque: float
    speed: float
    at_speed: bool
    clockwise: bool
    turning: tuple[tuple[str, float], ...]
    harmonics: int
    name: str = field(compare=False)

    @property
    def direction(self) -> int:
        """1 where the driving shaft turns counter-clockwise, else -1."""
        return -1 if self.clockwise else 1

    @cached_property
    def trains(self) -> Trains:
        """Motions of the set."""
        return Trains(self.found)

    @cached_property
    def drive(self) -> Drive | None:
        """How it runs; None where the case does not say, or it cannot."""
        if not self.input:
            return None
        found = self.trains.drive(self.fixed, self.input, self.output)
        return None if isinstance(found, str) else found


def compound_part(scene: Scene, name: str) -> CompoundPart:
    """The table of a set."""
    return scene.case.compound[name]


def compound_inputs(scene: Scene, name: str) -> CompoundInputs:
    """Collect what a case says of a set.

    Raises
    ------
    InputError
        If names are wrong, gears do not mesh, planets do not go in, or the set cannot run as wanted.
    """
    part, key = compound_part(scene, name), f"compound.{name}"
    found = _set(scene, part, key)
    try:
        check_assembly(found)
        check_neighbours(found)
        trains = Trains(found)
    except InputError as error:
        raise at(key, error) from None
    turning = tuple(
        (one, math.inf if part.shaft[one].turning is None else part.shaft[one].turning or 0.0) for one in part.fixed
    )
    _check_drive(part, trains, key)
    runs = (part.input, part.loaded) if part.input else ("", "")
    return CompoundInputs(
        found, tuple(part.fixed), *runs, part.torque or 1.0, part.speed or 1.0, part.speed is not None, part.clockwise,
        turning, part.harmonics, name,
    )  # fmt: skip


def _check_drive(part: CompoundPart, trains: Trains, key: str) -> None:
    if part.input is None:
        return
    drive = trains.drive(part.fixed, part.input, part.loaded)
    if isinstance(drive, str):
        fixed = ", ".join(f'"{one}"' for one in part.fixed)
        wanted = trains.free - 1
        remedy = "choose other fixed, driving or loaded shafts"
        if len(part.fixed) != wanted:
            remedy = f"fix {wanted} shaft{'' if wanted == 1 else 's'} (degrees of freedom of the set: {trains.free})"
        raise InputError(f"{key}.fixed", f"[{fixed}]", f"does not run: {drive}", remedy)


def _set(scene: Scene, part: CompoundPart, key: str) -> CompoundSet:
    gears = {
        member: _gears_of(scene, member, own, f"{key}.{kind}.{member}", carrier=kind == "shaft")
        for kind, members in (("shaft", part.shaft), ("planet", part.planet))
        for member, own in members.items()
    }
    meshes = []
    for number, one in enumerate(part.mesh):
        first, second = (_end(text, gears, f"{key}.mesh[{number}].gears") for text in one.gears)
        meshes.append(Mesh(first, second, one.efficiency, one.stiffness or math.nan))
    shafts = tuple(
        Shaft(one, _wheels(gears[one]), *_body(own, gears[one]), math.inf if own.bearing is None else own.bearing)
        for one, own in part.shaft.items()
    )
    # without places first: what names and counts refuse comes before geometry
    groups = tuple(
        Planets(one, own.carrier, _wheels(gears[one]), tuple(own.angles or even_turns(own.planets or 1)), math.nan,
                *_body(own, gears[one]), own.pin or math.inf)
        for one, own in part.planet.items()
    )  # fmt: skip
    try:
        bare = CompoundSet(shafts, groups, tuple(meshes))
    except InputError as error:
        raise at(key, error) from None
    placed = _placed(bare, part, gears, key)
    for number, toothed in enumerate(placed.toothed):
        _pair(gears, toothed.planets.name, toothed.wheel.name, toothed.other.name, toothed.other_wheel.name,
              placed.distance(toothed), f"{key}.mesh[{number}]")  # fmt: skip
    return placed


def _gears_of(
    scene: Scene, member: str, own: CompoundShaftPart | CompoundPlanetPart, key: str, *, carrier: bool
) -> dict[str, Gear]:
    names = own.gears
    if names is None:
        names = [member] if member in scene.gears else []
        if not names and not carrier:
            raise InputError(f"{key}.gears", "(not given)", f"is required: {member} is not a gear of this case",
                             'set gears = ["GEAR"], or name the planets after their gear')  # fmt: skip
    for name in names:
        if name not in scene.gears:
            raise InputError(f"{key}.gears", f'"{name}"', "is not a gear of this case", nearest(name, scene.gears))
    if len(set(names)) < len(names):
        raise InputError(f"{key}.gears", ", ".join(names), "names a gear twice", "name each gear once")
    if not names and not carrier:
        raise InputError(f"{key}.gears", "[]", "must name at least one gear", 'set gears = ["GEAR"]')
    return {name: scene.gears[name] for name in names}


def _end(text: str, gears: Mapping[str, Mapping[str, Gear]], key: str) -> End:
    """The member and gear that ``MEMBER`` or ``MEMBER.GEAR`` names; names may have dots themselves."""
    for member, own in gears.items():
        if text == member:
            if len(own) != 1:
                raise InputError(
                    key, f'"{text}"', f"has {len(own)} gears" if own else "has no gear",
                    f"name one: {', '.join(f'{member}.{one}' for one in own)}" if own else
                    f"set gears of {member}, or name another member",
                )  # fmt: skip
            return End(member, next(iter(own)))
        for wheel in own:
            if text == f"{member}.{wheel}":
                return End(member, wheel)
    known = [*gears, *(f"{member}.{wheel}" for member, own in gears.items() for wheel in own)]
    raise InputError(key, f'"{text}"', "is not a member of this set", nearest(text, known))


def _wheels(gears: Mapping[str, Gear]) -> tuple[Wheel, ...]:
    return tuple(
        Wheel(name, gear.teeth, gear.tooth.internal, gear.base_radius, gear.tip_radius, gear.half_base_tooth_angle)
        for name, gear in gears.items()
    )


def _body(own: CompoundShaftPart | CompoundPlanetPart, gears: Mapping[str, Gear]) -> tuple[float, float]:
    """Mass and inertia [kg, kg m^2]: as given, or of the gears; nan where neither is known."""
    if own.body is not None:
        return own.body.mass, own.body.inertia
    if not gears:
        return math.nan, math.nan
    every = [gear.mass_properties for gear in gears.values()]
    return sum(one.mass for one in every), sum(one.inertia for one in every)


def _pair(
    gears: Mapping[str, Mapping[str, Gear]], planet: str, wheel: str, other: str, other_wheel: str, distance: float,
    key: str,
) -> GearPair:  # fmt: skip
    """The pair of a mesh at its centre distance, zero backlash where that is not a number."""
    try:
        return GearPair(gears[planet][wheel], gears[other][other_wheel], distance)
    except InputError as error:
        if error.key == "centre_distance":
            said = f"centre distance {error.value}", error.rule, error.remedy
            error = type(error)("gears", *said)
        raise at(key, error, dict.fromkeys(_OF_GEARS, "gears")) from None


def _placed(bare: CompoundSet, part: CompoundPart, gears: Mapping[str, Mapping[str, Gear]], key: str) -> CompoundSet:
    """The set with planets at their centre distances and angles."""
    known: dict[str, Planets] = {}
    for group in bare.planets:
        own = part.planet[group.name]
        radius = own.centre_distance
        if radius is None:
            number, first = next(
                ((k, one) for k, one in enumerate(bare.toothed)
                 if one.planets.name == group.name and isinstance(one.other, Shaft)), (0, None),
            )  # fmt: skip
            if first is None:
                raise InputError(
                    f"{key}.planet.{group.name}.centre_distance", "(not given)",
                    "is required for planets that mesh with no shaft", 'set centre_distance = "60 mm"',
                )  # fmt: skip
            radius = _pair(gears, group.name, first.wheel.name, first.other.name, first.other_wheel.name, math.nan,
                           f"{key}.mesh[{number}]").centre_distance  # fmt: skip
        angles = group.angles
        if own.planets is not None:
            turn = own.first_angle
            if turn is None:
                turn = _beside(bare, replace(group, radius=radius), known, gears, key)
            angles = even_turns(own.planets, turn)
        known[group.name] = replace(group, radius=radius, angles=angles)
    try:
        return replace(bare, planets=tuple(known.values()))
    except InputError as error:
        raise at(key, error) from None


def _beside(
    bare: CompoundSet, group: Planets, known: Mapping[str, Planets], gears: Mapping[str, Mapping[str, Gear]], key: str
) -> float:
    """Angle of the first planet of a group: counter-clockwise of a planet that it meshes with, else zero [rad]."""
    for number, one in enumerate(bare.toothed):
        names = one.planets.name, one.other.name
        mate = next((known[name] for name in names if name in known), None)
        if isinstance(one.other, Shaft) or group.name not in names or mate is None:
            continue
        distance = _pair(gears, one.planets.name, one.wheel.name, one.other.name, one.other_wheel.name, math.nan,
                         f"{key}.mesh[{number}]").centre_distance  # fmt: skip
        share = (group.radius**2 + mate.radius**2 - distance**2) / (2.0 * group.radius * mate.radius)
        if not -1.0 < share < 1.0:
            raise GeometryError(
                f"{key}.mesh[{number}].gears", f"centre distance {distance * 1e3:.6g} mm",
                f"must be between {abs(group.radius - mate.radius) * 1e3:.6g} and "
                f"{(group.radius + mate.radius) * 1e3:.6g} mm, for these planets to reach each other",
                "change numbers of teeth or centre distances",
            )  # fmt: skip
        return mate.angles[0] + math.acos(share)
    return 0.0
