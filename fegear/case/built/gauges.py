"""Strain gauges of a case: which pair loads them, where their grids lie, what they measured."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, cast

from fegear.base.errors import InputError
from fegear.case.built.measured_strain import MeasuredStrain, measured_strain
from fegear.case.gauge import PLACES
from fegear.case.nearest import nearest
from fegear.fem.plane.gauge import ISO_TANGENT, ISO_TANGENT_INTERNAL, FilletProfile, Grid, PlaceKey
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from fegear.case.gauge import GaugePart
    from fegear.case.reading import Scene
    from fegear.fem.plane.influence import Side
    from fegear.geometry.pair import Member

#: Part of the strain along the profile below which a direction measures nothing.
_NOTHING = 1e-3


@dataclass(frozen=True)
class Gauge:
    """A gauge on a gear of a pair.

    Parameters
    ----------
    pair, gear : str
    member : {"driver", "driven"}
    tooth : int
        In meshing order, the first is 0.
    side : {"tension", "compression"}
    key, value : str, float
        Where the middle of its grid lies.
    grid : Grid
    z : float
        Place along the face of 3D gears, from the middle of the common face [m].
    placement, load_tolerance : float
        Uncertainties: [m], and relative.
    measured : MeasuredStrain or None
    name : str
    second : str
        Other gauge of the half bridge that measured, empty for none.
    """

    pair: str
    gear: str
    member: Member
    tooth: int
    side: Side
    key: PlaceKey
    value: float
    grid: Grid
    z: float
    placement: float
    load_tolerance: float
    measured: MeasuredStrain | None
    name: str = field(compare=False)
    second: str = ""

    @property
    def trace_speed(self) -> float | None:
        """Speed of its gear during its trace, where that is over time [rad/s]."""
        return None if self.measured is None else self.measured.speed

    @property
    def over_time(self) -> bool:
        """Whether its trace has the time in place of an angle."""
        return self.trace_speed is not None


def gauge_of(scene: Scene, name: str) -> Gauge:
    """A gauge of a case with its trace.

    Raises
    ------
    InputError
        If the case does not say where it is, or its file is no trace.
    """
    part = scene.case.gauge[name]
    pair, member = _place_in_mesh(scene, name, part)
    gear = scene.gears[part.gear]
    key, value = _place_on_fillet(part, internal=gear.tooth.internal)
    teeth = gear.tooth.teeth
    if part.tooth > teeth:
        raise InputError(f"gauge.{name}.tooth", part.tooth, f"must be at most {teeth}, the teeth of gear {part.gear}")
    if abs(part.direction) > 0.5 * math.pi * (1.0 + 1e-12):
        raise InputError(
            f"gauge.{name}.direction", f"{math.degrees(part.direction):.6g} deg", "must be between -90 and 90 deg"
        )
    grid = Grid(part.grid_length, part.grid_width, part.direction)
    measured = None if part.measured is None else measured_strain(scene, name, part.measured, pair, teeth)
    second = "" if part.measured is None else part.measured.bridge or ""
    return Gauge(
        pair, part.gear, member, part.tooth - 1, part.fillet, key, value, grid, part.face_position,
        part.placement_tolerance, part.load_tolerance, measured, name, second,
    )  # fmt: skip


def seconds_of_bridges(scene: Scene) -> set[str]:
    """Gauges whose strain is subtracted from that of another one in a half bridge."""
    parts = [one.measured for one in scene.case.gauge.values()]
    return {part.bridge for part in parts if part is not None and part.bridge is not None}


def check_gauge(scene: Scene, name: str) -> None:
    """Refuse gauges that cannot be computed, before anything is."""
    found = gauge_of(scene, name)
    if found.second:
        _check_bridge(scene, found)
    gear, part = scene.gears[found.gear], scene.case.gear[found.gear]
    if wide := found.pair in scene.wide_pairs:
        _check_on_face(scene, name, found)
    elif found.z != 0.0:
        raise InputError(
            f"gauge.{name}.face_position", f"{found.z * 1e3:.6g} mm",
            f"has no effect on plane (2D) gears, those of pair {found.pair}",
            f'remove it or set pair.{found.pair}.width = "solid"',
        )  # fmt: skip
    plane = gear.plane_assumption
    along = Grid(0.0, 0.0, 0.0).strain_per_stress(gear.material, plane)
    if not wide and abs(found.grid.strain_per_stress(gear.material, plane)) < _NOTHING * along:
        raise InputError(
            f"gauge.{name}.direction", f"{math.degrees(found.grid.direction):.6g} deg",
            "measures no strain: in this direction it is zero", "choose a direction nearer to the profile, 0 deg",
        )  # fmt: skip
    if part.tooth_mesh is None or part.tooth_mesh_fillet == "rack":
        place_gauge(found, FilletProfile.of_tooth(gear.symmetric_tooth, gear.module))


def _check_bridge(scene: Scene, found: Gauge) -> None:
    """Refuse a half bridge whose gauges are not on one tooth, or the same."""
    key, part = f"gauge.{found.name}.measured.bridge", scene.case.gauge[found.second]
    if found.second == found.name:
        raise InputError(key, f'"{found.second}"', "is the gauge itself", "name the gauge in the other fillet")
    if part.measured is not None and part.measured.bridge is not None:
        raise InputError(
            key, f'"{found.second}"', "has a bridge itself: one trace of a half bridge is that of one of its gauges",
            f"remove gauge.{found.second}.measured",
        )  # fmt: skip
    for one in ("gear", "pair", "member", "tooth"):
        if getattr(gauge_of(scene, found.second), one) != getattr(found, one):
            raise InputError(key, f'"{found.second}"', f"is on another {one}", "name a gauge on the same tooth")


def sharper_strain(scene: Scene, pair: str) -> str:
    """The setting that makes the computed strain of a pair's gears more accurate."""
    sliced = pair in scene.wide_pairs and scene.width_of(pair) == "slices"
    return f'set pair.{pair}.width = "solid"' if sliced else "reduce accuracy.tolerance"


def _check_on_face(scene: Scene, name: str, found: Gauge) -> None:
    """Refuse what gauges on 3D gears cannot be, before anything is solved."""
    half = 0.5 * scene.pairs[found.pair].face_width
    reach = found.grid.half_across
    if abs(found.z) + reach > half * (1.0 + 1e-9):
        room = max(half - reach, 0.0)
        raise InputError(
            f"gauge.{name}.face_position", f"{found.z * 1e3:.6g} mm",
            f"puts the grid beyond the common face, {-half * 1e3:.5g} to {half * 1e3:.5g} mm",
            f"choose {-room * 1e3:.5g} to {room * 1e3:.5g} mm",
        )  # fmt: skip
    if found.tooth:
        raise InputError(
            f"gauge.{name}.tooth", found.tooth + 1, "must be 1: gauges on 3D gears follow the first tooth", "remove it"
        )


def place_gauge(gauge: Gauge, profile: FilletProfile) -> float:
    """Arc length of the middle of a gauge on a fillet [m]."""
    try:
        return profile.place(gauge.key, gauge.value, gauge.grid)
    except InputError as error:
        raise error.under(f"gauge.{gauge.name}") from None


def _place_in_mesh(scene: Scene, name: str, part: GaugePart) -> tuple[str, Member]:
    """Pair and member of the gear of a gauge."""
    pairs = {
        key: [member for member in MEMBERS if getattr(one, member) == part.gear]
        for key, one in scene.case.pair.items() if part.gear in (one.driver, one.driven)
    }  # fmt: skip
    if not pairs:
        raise InputError(f"gauge.{name}.gear", f'"{part.gear}"', "is in no pair of this case", "specify its pair")
    if part.pair is None and len(pairs) > 1:
        raise InputError(
            f"gauge.{name}.pair", "(not given)", f"is required: gear {part.gear} is in {len(pairs)} pairs",
            f"specify one of {', '.join(pairs)}",
        )  # fmt: skip
    pair = part.pair or next(iter(pairs))
    if pair not in pairs:
        raise InputError(f"gauge.{name}.pair", f'"{pair}"', f"does not contain gear {part.gear}", nearest(pair, pairs))
    members = pairs[pair]
    member: Member = part.member or members[0]
    if member not in members:
        raise InputError(
            f"gauge.{name}.member", f'"{member}"', f"is another gear: {part.gear} is the {members[0]} of pair {pair}",
            "remove it",
        )  # fmt: skip
    return pair, member


def _place_on_fillet(part: GaugePart, *, internal: bool) -> tuple[PlaceKey, float]:
    for key in PLACES:
        if (value := getattr(part, key)) is not None:
            return cast("PlaceKey", key), float(value)
    return "tangent_angle", ISO_TANGENT_INTERNAL if internal else ISO_TANGENT
