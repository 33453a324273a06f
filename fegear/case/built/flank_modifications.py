"""What a case grinds off the flanks of a gear over its face: lead modifications, bias, topography.

The relief that a case gives a gear, for drawings: whether or not the effect `relief` counts it in load sharing.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from fegear.base.arrays import Array
from fegear.base.effects import RELIEF
from fegear.base.errors import InputError
from fegear.case.built.gear_flanks import gear_flanks
from fegear.case.built.members import gear_name
from fegear.case.csv_file import one_column, read_columns
from fegear.case.reading import Scene
from fegear.case.relief import LeadPart, TopographyPart
from fegear.contact.pair_spec import FlankSpec
from fegear.geometry.flank_modification import (
    FlankModification,
    HelixSlope,
    LeadCrowning,
    LeadEndRelief,
    LeadTable,
    MirroredModification,
    Topography,
)
from fegear.geometry.gear import Gear
from fegear.geometry.involute_side import Flank
from fegear.geometry.pair import MEMBERS
from fegear.geometry.relief import Relief, roll_as_given, roll_of_radius
from fegear.geometry.relief_spec import BiasSpec

#: Part of the face that a table over it may leave out at either end.
_LEFT_OUT = 0.2


def with_face(scene: Scene, flank: FlankSpec, *, drawn: bool = False) -> FlankSpec:
    """The flanks of a gear with what a case gives them over its face.

    Parameters
    ----------
    scene : Scene
    flank : FlankSpec
    drawn : bool
        Whether that is wanted which is drawn, where another one is measured.

    Raises
    ------
    InputError
        If a file is missing or has not what it is named for, or a part does not fit the face.
    """
    part, whole = scene.case.gear[flank.gear], _whole_flank(scene, flank.gear, drawn=drawn)
    if whole:
        return replace(flank, face=whole)
    bias = None if part.bias is None else BiasSpec(part.bias.amount, part.bias.start_radius, part.bias.end_radius)
    return replace(flank, face=gear_face(scene, flank.gear, drawn=drawn), bias=bias)


def _whole_flank(scene: Scene, name: str, *, drawn: bool) -> tuple[FlankModification, ...]:
    """The measured topography of a gear, which stands for all that is drawn."""
    if drawn or scene.case.gear[name].measured_of(_flank(scene, name))[0] is None:
        return ()
    from fegear.case.built.measured_flanks import measured_gear

    found = measured_gear(scene, name).topography
    return () if found is None else _as_seen(scene, name, [found])


def _flank(scene: Scene, name: str) -> Flank | None:
    """Flank of asymmetric teeth that a gear is seen from."""
    return scene.gears[name].tooth.working_flank


def _as_seen(scene: Scene, name: str, found: list[FlankModification]) -> tuple[FlankModification, ...]:
    """Modifications whose ends are those of the drive flanks, as the flank that is seen has them.

    A flank counts its ends from where it is seen on the right of an upright tooth: the coast flank from the other end.
    """
    if _flank(scene, name) != "coast":
        return tuple(found)
    return tuple(_mirrored(one) for one in found)


def _mirrored(one: FlankModification) -> FlankModification:
    """A modification with its ends exchanged; tables stay tables, whose ends notes name."""
    if isinstance(one, LeadCrowning):
        return one
    if isinstance(one, LeadTable):
        return LeadTable(-one.z[::-1], one.values[::-1])
    if isinstance(one, Topography):
        return Topography(one.roll, -one.z[::-1], one.values[:, ::-1])
    return MirroredModification(one)


def gear_face(scene: Scene, name: str, *, drawn: bool = False) -> tuple[FlankModification, ...]:
    """Lead modifications and topography of a gear; see `with_face`."""
    part, gear = scene.case.gear[name], scene.gears[name]
    if whole := _whole_flank(scene, name, drawn=drawn):
        return whole
    found: list[FlankModification] = []
    if not drawn and part.measured_of(_flank(scene, name))[0] is not None:
        from fegear.case.built.measured_flanks import measured_gear

        lead = measured_gear(scene, name).lead
        found += [] if lead is None else [lead]
    modified, key = part.lead_of(_flank(scene, name))
    if modified is not None and not found:
        found += _lead(scene, modified, f"gear.{scene.written.get(name, name)}.{key}", gear.face_width)
    if part.topography is not None:
        found.append(_topography(scene, name, part.topography))
    return _as_seen(scene, name, found)


def _lead(scene: Scene, part: LeadPart, prefix: str, width: float) -> list[FlankModification]:
    found: list[FlankModification] = []
    if part.crowning:
        found.append(LeadCrowning(part.crowning, width))
    if part.slope:
        found.append(HelixSlope(part.slope, width))
    for i, end in enumerate(part.end_relief):
        power = 1.0 if end.shape == "linear" else 2.0
        try:
            found.append(LeadEndRelief(end.amount, end.length, width, end.end, power))
        except InputError as error:
            key = f"{prefix}.end_relief[{i}].length"
            raise InputError(key, error.value, error.rule, error.remedy) from None
    if part.file is not None:
        key = f"{prefix}.file"
        columns = read_columns(scene.file(part.file, key), key, {"z": "length", "removal": "length"})
        if not {"z", "removal"} <= columns.keys() or not (np.diff(columns["z"]) > 0.0).all():
            rule = f"requires the columns z [mm], ascending, and removal [um]; it has {columns.has}"
            raise InputError(key, f'"{part.file}"', rule)
        _refuse_uncovered(columns["z"], width, key)
        found.append(LeadTable(columns["z"], columns["removal"]))
    return found


def _refuse_uncovered(z: Array, width: float, key: str) -> None:
    """Refuse a table over the face that leaves much of it out: it is held at its ends there."""
    half = 0.5 * width
    missing = max(float(z.min()) + half, half - float(z.max()), 0.0) / width
    if missing > _LEFT_OUT:
        raise InputError(
            key, f"z from {z.min() * 1e3:.6g} to {z.max() * 1e3:.6g} mm",
            f"must cover the face width, {-half * 1e3:.6g} to {half * 1e3:.6g} mm, except at most a fifth at each end",
            "specify the full face width; check the unit of z (measured from mid-face)",
        )  # fmt: skip


def _topography(scene: Scene, name: str, part: TopographyPart) -> Topography:
    key = f"gear.{name}.topography.file"
    columns = read_columns(
        scene.file(part.file, key), key,
        {"roll_angle": "angle", "radius": "length", "z": "length", "removal": "length"},
    )  # fmt: skip
    if not {"z", "removal"} <= columns.keys() or not columns.keys() & {"roll_angle", "radius"}:
        raise InputError(
            key, f'"{part.file}"', "requires the columns roll_angle [deg] or radius [mm], z [mm] and removal [um]"
        )
    at = columns[one_column(columns, ("roll_angle", "radius"), key, part.file)]
    if "roll_angle" in columns:
        at = roll_as_given(scene.gears[name], at)
    _refuse_uncovered(columns["z"], scene.gears[name].face_width, key)
    rows, i = np.unique(at, return_inverse=True)
    heights, k = np.unique(columns["z"], return_inverse=True)
    values = np.full((rows.size, heights.size), np.nan)
    values[i, k] = columns["removal"]
    if min(rows.size, heights.size) < 2 or at.size != values.size or np.isnan(values).any():
        raise InputError(
            key, f'"{part.file}"', f"has {at.size} entries at {rows.size} roll angles or radii and {heights.size} "
            "positions along the face", "specify each roll angle at each position once, at least two of both",
        )  # fmt: skip
    return Topography(rows if "roll_angle" in columns else _rolls(scene.gears[name], rows, key), heights, values)


def _rolls(gear: Gear, radii: Array, key: str) -> Array:
    """Roll angles of radii [m]."""
    if (radii < gear.base_radius).any():
        raise InputError(key, f"radius {radii.min() * 1e3:.6g} mm", "lies inside the base circle")
    return roll_of_radius(gear, radii)


@dataclass(frozen=True, slots=True)
class DescribedRelief:
    """Relief of both flanks of a gear, or of one of asymmetric teeth.

    Parameters
    ----------
    relief : Relief or None
        None if the case gives none, or if it cannot be had.
    left_out : str
        Why it cannot be had; else empty.
    pair : str
        The pair with which it was built, where other pairs of the gear would give another; else empty.
    """

    relief: Relief | None = None
    left_out: str = ""
    pair: str = ""


def described_relief(scene: Scene, gear: str, *, back: bool = False) -> DescribedRelief:
    """Relief of a gear from its own keys and, for lengths that count on the path of contact, from its pairs.

    Parameters
    ----------
    scene : Scene
    gear : str
    back : bool
        Whether that of the flanks is wanted that are not loaded; of equal flanks it is the same.

    Raises
    ------
    InputError
        If the relief does not fit the gear.
    """
    seen = scene.gears[gear].from_the_back if back else scene.gears[gear]
    if scene.case.gear[gear].relief_of(seen.tooth.working_flank) is None:
        return DescribedRelief()
    flanks = gear_flanks(scene, gear, drawn=True, back=back)
    if RELIEF.name in flanks.wrong:
        raise flanks.wrong[RELIEF.name]
    if flanks.wants_delta:
        return DescribedRelief(left_out="amount depends on the deflection (amount_over_delta)")
    built: dict[str, Relief] = {}
    for name, pair in scene.pairs.items():
        for member in MEMBERS:
            if gear_name(scene, name, member) == gear and name not in built:
                built[name] = flanks.profile(pair.from_the_back if back else pair, member)
    if not built:
        return DescribedRelief(left_out="start and end depend on the path of contact, and the gear belongs to no pair")
    (first, relief), *others = built.items()
    involute = seen.tooth.involute
    roll = np.linspace(involute.start, involute.end, 101)
    differ = any(np.abs(other.removal(roll) - relief.removal(roll)).max() > 1e-9 for _, other in others)
    return DescribedRelief(relief, pair=first if differ else "")
