"""From a case's pair to its loaded flanks: what a case says of reliefs and of the gap over the face."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.case.csv_columns import read_columns
from fegear.case.effects import EffectsPart
from fegear.case.part import at
from fegear.errors import InputError
from fegear.geometry.pair import MEMBERS
from fegear.geometry.plausible import refuse_load
from fegear.models.flank_modifications import gear_face
from fegear.models.loaded_pair import build_relief
from fegear.models.pair_inputs import gear_flanks, gear_name
from fegear.models.solid_influence import check_solid_gear

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.case.reading import Scene
    from fegear.contact.flank import FlankGaps
    from fegear.geometry import GearPair
    from fegear.models.flank_modifications import FaceModifications
    from fegear.models.pair_inputs import Flanks

#: Effects that loaded flanks know.
FLANK_EFFECTS = ("neighbour_coupling", "hertz", "relief", "misalignment")
#: Panels per module of face, and points of a crowned line error.
_PANELS_PER_MODULE, _POINTS = 4.0, 65


@dataclass(frozen=True)
class FlanksToLoad:
    """All that loaded flanks depend on, besides the gears' influence functions.

    Parameters
    ----------
    pair : GearPair
    effects : EffectsPart
        `FLANK_EFFECTS`; all others are off.
    flanks : tuple of (Flanks, Flanks)
        Of driver and driven.
    faces : tuple of (FaceModifications, FaceModifications)
        The same over the face.
    face_position, line_gap : ndarray, shape (n,)
        [m]; empty for none.
    loads : tuple of float
        [N], ascending.
    nominal : float
        [N].
    positions, panels : int
    width : {"solid", "slices"}
        What the gears are solved as.
    name : str
        Of the pair.
    """

    pair: GearPair
    effects: EffectsPart
    flanks: tuple[Flanks, Flanks]
    faces: tuple[FaceModifications, FaceModifications]
    face_position: Array
    line_gap: Array
    loads: tuple[float, ...]
    nominal: float
    positions: int
    panels: int
    width: Literal["solid", "slices"] = "solid"
    name: str = field(default="", compare=False)

    @property
    def gears(self) -> tuple[str, str]:
        """Names of driver and driven."""
        return self.flanks[0].gear, self.flanks[1].gear

    @property
    def panel(self) -> float:
        """Length of a panel [modules]."""
        return self.pair.face_width / self.panels / self.pair.driver.module

    def has_data(self, effect: str) -> bool:
        """Whether the case says what an effect needs; of others than relief and misalignment it does."""
        if effect == "relief":
            relieved = any(flank.relief for flank in self.flanks) or any(face.given for face in self.faces)
            return relieved and not any(flank.wants_delta for flank in self.flanks)
        return effect != "misalignment" or self.line_gap.size > 0

    def gaps(self, *, relief: bool, misalignment: bool) -> FlankGaps:
        """What keeps the flanks apart."""
        from fegear.contact.flank import FlankGaps

        apart = FlankGaps()
        if relief:
            driver, driven = (
                build_relief(self.pair, member, flank, math.nan)
                for member, flank in zip(MEMBERS, self.flanks, strict=True)
            )
            first, second = (face.built(self.pair, m) for m, face in zip(MEMBERS, self.faces, strict=True))
            apart = replace(apart, driver_relief=driver, driven_relief=driven, driver_flank=first, driven_flank=second)
        if misalignment:
            apart = replace(apart, face_position=self.face_position, line_gap=self.line_gap)
        return apart


def flanks_to_load(scene: Scene, name: str) -> FlanksToLoad:
    """Collect what a case says of the loaded flanks of a pair.

    Raises
    ------
    InputError
        If a file is missing or has not what it is named for.
    """
    part, pair, effects = scene.case.pair[name], scene.pairs[name], scene.case.effects
    first, second = (gear_flanks(scene, gear_name(scene, name, member)) for member in MEMBERS)
    own = EffectsPart(**{effect: getattr(effects, effect) for effect in FLANK_EFFECTS})
    faces = gear_face(scene, first.gear), gear_face(scene, second.gear)
    z, gap = _line_gap(scene, name)
    nominal = part.normal_load(pair) or math.nan
    asked = scene.case.load_distribution
    panels = asked.panels or max(4, math.ceil(_PANELS_PER_MODULE * pair.face_width / pair.driver.module - 1e-9))
    width: Literal["solid", "slices"] = "slices" if part.width == "slices" else "solid"
    return FlanksToLoad(
        pair, own, (first, second), faces, z, gap, part.all_loads(pair), nominal, asked.positions, panels, width, name
    )


def _line_gap(scene: Scene, name: str) -> tuple[Array, Array]:
    """Gap over the face of a pair, from its keys and its file."""
    part, half = scene.case.pair[name].line_error, 0.5 * scene.pairs[name].face_width
    if part is None:
        return np.empty(0), np.empty(0)
    z = np.linspace(-half, half, _POINTS if part.crowning or part.file else 2)
    gap = 0.5 * part.over_face * (1.0 + z / half) + part.crowning * (z / half) ** 2
    if part.file is not None:
        key = f"pair.{name}.line_error.file"
        columns = read_columns(scene.file(part.file, key), key, {"z": "length", "gap": "length"})
        if not {"z", "gap"} <= columns.keys() or not (np.diff(columns["z"]) > 0.0).all():
            raise InputError(key, f'"{part.file}"', "needs the columns z [mm], ascending, and gap [um]")
        if columns["z"][0] > -half * (1.0 - 1e-6) or columns["z"][-1] < half * (1.0 - 1e-6):
            raise InputError(
                key, f'"{part.file}"', f"must cover the face, from {-half * 1e3:.6g} to {half * 1e3:.6g} mm"
            )
        z, old = np.union1d(z, columns["z"]), z
        gap = np.interp(z, old, gap) + np.interp(z, columns["z"], columns["gap"])
    return z, gap


def check_flanks_to_load(scene: Scene, name: str) -> None:
    """Refuse pairs that cannot be loaded with their width, and effects without data.

    Raises
    ------
    InputError
    """
    part, pair, effects = scene.case.pair[name], scene.pairs[name], scene.case.effects
    for gear in (part.driver, part.driven):
        check_solid_gear(scene, gear)
    if part.normal_load(pair) is None:
        raise InputError(f"pair.{name}.load", "(not given)", "is needed to load the flanks", "give load or torque")
    if abs(pair.driver.face_width - pair.driven.face_width) > 1e-9 * pair.face_width:
        raise InputError(
            f"gear.{part.driven}.face_width", f"{pair.driven.face_width * 1e3:.6g} mm",
            f"differs from its mate's, {pair.driver.face_width * 1e3:.6g} mm, and contact that ends inside a face is "
            "not computed yet", "give both gears one face width",
        )  # fmt: skip
    if part.axial_offset:
        raise InputError(
            f"pair.{name}.axial_offset", f"{part.axial_offset * 1e3:.6g} mm", "is not known to a pair with a width yet",
            "leave it out",
        )  # fmt: skip
    try:
        refuse_load(pair, max(part.all_loads(pair)))
    except InputError as error:
        raise at(f"pair.{name}", error) from None
    if pair.contact_ratio < 1.0:
        raise InputError(
            f"pair.{name}", f"contact ratio {pair.contact_ratio:.4f}", "is below 1",
            "lengthen the teeth or raise the number of teeth",
        )  # fmt: skip
    if effects.misalignment and part.line_error is None:
        raise InputError(
            "effects.misalignment", "true", f"finds no gap over the face of pair {name}",
            f'give pair.{name}.line_error = {{ over_face = "10 um" }}, or leave the effect out',
        )  # fmt: skip
    asked = flanks_to_load(scene, name)
    for member, flank in zip(MEMBERS, asked.flanks, strict=True):
        if effects.relief and flank.wants_delta:
            raise InputError(
                f"gear.{flank.gear}.relief", "amount_over_delta", "counts in deflections of plane teeth",
                "give the amount as a length for a pair with a width",
            )  # fmt: skip
        if effects.relief:
            asked.faces[MEMBERS.index(member)].built(pair, member)
        try:
            build_relief(pair, member, flank, math.nan) if effects.relief else None
        except InputError as error:
            raise at(f"gear.{flank.gear}", error) from None
