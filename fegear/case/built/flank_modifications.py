"""What a case grinds off the flanks of a gear over its face: lead modifications, bias, topography.

The relief that a case gives a gear, for drawings: whether or not the effect `relief` counts it in load sharing.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.case.built.loaded_pair import build_relief
from fegear.case.built.pair_inputs import gear_flanks, gear_name, one_column
from fegear.case.csv_file import read_columns
from fegear.case.part import at
from fegear.case.reading import Scene
from fegear.case.relief import BiasPart, LeadPart, TopographyPart
from fegear.geometry.flank_modification import (
    Bias,
    FlankModification,
    HelixSlope,
    LeadCrowning,
    LeadEndRelief,
    LeadTable,
    Topography,
)
from fegear.geometry.gear import Gear
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.geometry.plausible_flanks import DEEPEST_RELIEF
from fegear.geometry.relief import Relief, roll_of_radius

#: Part of the face that a table over it may leave out at either end.
_LEFT_OUT = 0.2


@dataclass(frozen=True)
class FaceModifications:
    """What a case gives a gear over its face.

    Parameters
    ----------
    parts : tuple of FlankModification
        Lead modifications and topography.
    bias : BiasPart or None
        Its ends may be those of the active profile, which only the pair knows.
    gear : str
        Name of the gear, for messages.
    """

    parts: tuple[FlankModification, ...] = ()
    bias: BiasPart | None = None
    gear: str = field(default="", compare=False)

    @property
    def given(self) -> bool:
        """Whether there are any."""
        return bool(self.parts) or self.bias is not None

    def built(self, pair: GearPair, member: Member) -> tuple[FlankModification, ...]:
        """All of them for one gear of a pair.

        Raises
        ------
        InputError
            If they take more than the tooth has.
        """
        found, gear = self.parts, pair.gear(member)
        low, high = sorted(float(pair.roll_angle(x, member)) for x in (pair.x_start, pair.x_end))
        if self.bias is not None:
            radii = self.bias.start_radius, self.bias.end_radius
            key = f"gear.{self.gear}.bias"
            start, end = (
                end if radius is None else float(_rolls(gear, np.array(radius), key))
                for radius, end in zip(radii, (low, high), strict=True)
            )
            if not end > start:
                raise InputError(key, "start_radius and end_radius", "must ascend")
            found = (*found, Bias(self.bias.amount, start, end, gear.face_width))
        for part in found:
            if isinstance(part, Topography) and (part.roll[0] >= high or part.roll[-1] <= low):
                raise InputError(
                    f"gear.{self.gear}.topography",
                    f"from roll angle {math.degrees(part.roll[0]):.5g} to {math.degrees(part.roll[-1]):.5g} deg",
                    f"lies outside the active profile, {math.degrees(low):.5g} to {math.degrees(high):.5g} deg",
                    "check the units of its radii and angles",
                )  # fmt: skip
        half = 0.5 * gear.face_width
        kinks = [k for part in found for k in part.face_kinks]
        z = np.union1d(np.linspace(-half, half, 65), np.clip(kinks, -half, half))
        roll = np.linspace(low, high, 33)[:, None]
        total = np.abs(sum((part.removal(roll, z) for part in found), np.zeros((33, z.size))))
        if total.max() > DEEPEST_RELIEF * gear.module:
            raise InputError(
                f"gear.{self.gear}", f"lead, bias and topography of {total.max() * 1e6:.4g} um",
                f"equal {total.max() / gear.module:.3g} modules, more than the maximum of {DEEPEST_RELIEF:g} modules",
                "check the unit: modifications are some tens of micrometres",
            )  # fmt: skip
        return found


def gear_face(scene: Scene, name: str, *, drawn: bool = False) -> FaceModifications:
    """Read what a case gives a gear over its face.

    Parameters
    ----------
    scene : Scene
    name : str
        Of the gear.
    drawn : bool
        Whether that is wanted which is drawn, where another one is measured.

    Raises
    ------
    InputError
        If a file is missing or has not what it is named for, or a part does not fit the face.
    """
    part, gear = scene.case.gear[name], scene.gears[name]
    found: list[FlankModification] = []
    if part.measured is not None and not drawn:
        from fegear.case.built.measured_flanks import measured_gear

        measured = measured_gear(scene, name)
        if measured.topography is not None:
            return FaceModifications((measured.topography,), None, name)
        if measured.lead is not None:
            found.append(measured.lead)
    if part.lead is not None and not found:
        found += _lead(scene, name, part.lead, gear.face_width)
    if part.topography is not None:
        found.append(_topography(scene, name, part.topography))
    return FaceModifications(tuple(found), part.bias, name)


def _lead(scene: Scene, name: str, part: LeadPart, width: float) -> list[FlankModification]:
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
            key = f"gear.{name}.lead.end_relief[{i}].length"
            raise InputError(key, error.value, error.rule, error.remedy) from None
    if part.file is not None:
        key = f"gear.{name}.lead.file"
        columns = read_columns(scene.file(part.file, key), key, {"z": "length", "removal": "length"})
        if not {"z", "removal"} <= columns.keys() or not (np.diff(columns["z"]) > 0.0).all():
            raise InputError(key, f'"{part.file}"', "requires the columns z [mm], ascending, and removal [um]")
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
    _refuse_uncovered(columns["z"], scene.gears[name].face_width, key)
    rows, i = np.unique(at, return_inverse=True)
    heights, k = np.unique(columns["z"], return_inverse=True)
    values = np.full((rows.size, heights.size), np.nan)
    values[i, k] = columns["removal"]
    if min(rows.size, heights.size) < 2 or at.size != values.size or np.isnan(values).any():
        raise InputError(
            key, f'"{part.file}"', f"has {at.size} entries at {rows.size} roll angles or radii and {heights.size} "
            "heights", "specify each roll angle at each height once, at least two of both",
        )  # fmt: skip
    return Topography(rows if "roll_angle" in columns else _rolls(scene.gears[name], rows, key), heights, values)


def _rolls(gear: Gear, radii: Array, key: str) -> Array:
    """Roll angles of radii [m]."""
    if (radii < gear.base_radius).any():
        raise InputError(key, f"radius {radii.min() * 1e3:.6g} mm", "lies inside the base circle")
    return roll_of_radius(gear, radii)


@dataclass(frozen=True, slots=True)
class DescribedRelief:
    """Relief of both flanks of a gear.

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


def described_relief(scene: Scene, gear: str) -> DescribedRelief:
    """Relief of a gear from its own keys and, for lengths that count on the path of contact, from its pairs.

    Raises
    ------
    InputError
        If the relief does not fit the gear.
    """
    if scene.case.gear[gear].relief is None:
        return DescribedRelief()
    flanks = gear_flanks(scene, gear, drawn=True)
    if "relief" in flanks.wrong:
        raise flanks.wrong["relief"]
    if flanks.wants_delta:
        return DescribedRelief(left_out="amount depends on the deflection (amount_over_delta)")
    built: dict[str, Relief] = {}
    for name, pair in scene.pairs.items():
        for member in MEMBERS:
            if gear_name(scene, name, member) == gear and name not in built:
                try:
                    built[name] = build_relief(pair, member, flanks, math.nan)
                except InputError as error:
                    raise at(f"gear.{gear}", error) from None
    if not built:
        return DescribedRelief(left_out="start and end depend on the path of contact, and the gear belongs to no pair")
    (first, relief), *others = built.items()
    involute = scene.gears[gear].tooth.involute
    roll = np.linspace(involute.start, involute.end, 101)
    differ = any(np.abs(other.removal(roll) - relief.removal(roll)).max() > 1e-9 for _, other in others)
    return DescribedRelief(relief, pair=first if differ else "")
