"""From a case's pair to its loaded flanks: what a case says of reliefs and of the gap over the face."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import Literal

from fegear.base.errors import InputError
from fegear.case.built.flank_errors import FlankErrors, cutter_modification, flank_errors
from fegear.case.built.flank_modifications import FaceModifications, gear_face
from fegear.case.built.loaded_pair import build_relief
from fegear.case.built.pair_inputs import Flanks, gear_flanks, gear_name
from fegear.case.built.shafts import check_heights, on_shafts
from fegear.case.built.solid_influence import check_solid_gear, check_source
from fegear.case.built.table_ends import face_table_notes
from fegear.case.effects import WIDE_EFFECTS, EffectsPart
from fegear.case.part import at
from fegear.case.reading import Scene
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.shaft_gaps import ShaftGaps
from fegear.geometry.flank_modification import FlankModification
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.geometry.plausible_flanks import refuse_load
from fegear.geometry.relief import Relief

#: Panels per module of face.
_PANELS_PER_MODULE = 4.0


@dataclass(frozen=True)
class FlanksToLoad:
    """All that loaded flanks depend on, besides the gears' influence functions.

    Parameters
    ----------
    pair : GearPair
    effects : EffectsPart
        `WIDE_EFFECTS`; all others are off.
    flanks : tuple of (Flanks, Flanks)
        Of driver and driven.
    faces : tuple of (FaceModifications, FaceModifications)
        The same over the face.
    cutter : tuple of FlankModification
        `modification` of the pair, which its pinion's cutter leaves.
    errors : FlankErrors
    loads : tuple of float
        [N], ascending.
    nominal : float
        [N].
    positions, panels, base_pitch : int
    width : {"solid", "slices"}
        What the gears are solved as.
    name : str
        Of the pair.
    tolerance : float
        That the changes by neglected effects are compared with.
    estimates, neglected : bool
        Whether errors and the changes by neglected effects are estimated, some three fifths of the time.
    """

    pair: GearPair
    effects: EffectsPart
    flanks: tuple[Flanks, Flanks]
    faces: tuple[FaceModifications, FaceModifications]
    cutter: tuple[FlankModification, ...]
    errors: FlankErrors
    loads: tuple[float, ...]
    nominal: float
    positions: int
    panels: int
    width: Literal["solid", "slices"] = "solid"
    base_pitch: int = 0
    name: str = field(default="", compare=False)
    tolerance: float = field(default=0.0, compare=False)
    estimates: bool = True
    neglected: bool = True

    @property
    def gears(self) -> tuple[str, str]:
        """Names of driver and driven."""
        return self.flanks[0].gear, self.flanks[1].gear

    @property
    def panel(self) -> float:
        """Length of a panel [modules]."""
        return self.pair.face_width / self.panels / self.pair.driver.module

    @property
    def misaligned(self) -> GearPair:
        """The pair at the centre distance that its error leaves, whether or not the effect is on."""
        return self.pair if self.effects.misalignment else _placed(self.pair, self.errors.apart, self.name)

    def has_data(self, effect: str) -> bool:
        """Whether the case says what an effect needs; of others than these three it does."""
        if effect == "relief":
            relieved = any(flank.relief for flank in self.flanks) or any(face.given for face in self.faces)
            relieved = relieved or bool(self.cutter)
            return relieved and not any(flank.wants_delta for flank in self.flanks)
        if effect == "spacing_errors":
            return any(flank.spacing.size for flank in self.flanks)
        return effect != "misalignment" or self.errors.given

    def on(self, shafts: ShaftGaps) -> FlanksToLoad:
        """The same on shafts that open other gaps."""
        return replace(self, errors=replace(self.errors, shafts=shafts))

    def _relief(self, member: Member) -> Relief:
        flank = self.flanks[MEMBERS.index(member)]
        try:
            return build_relief(self.pair, member, flank, math.nan)
        except InputError as error:
            raise at(f"gear.{flank.gear}", error) from None

    def gaps(self, *, relief: bool, misalignment: bool, spacing_errors: bool = False) -> FlankGaps:
        """What keeps the flanks apart."""
        from fegear.contact.wide.gaps import FlankGaps

        apart = FlankGaps()
        if relief:
            driver, driven = (self._relief(member) for member in MEMBERS)
            first, second = (face.built(self.pair, m) for m, face in zip(MEMBERS, self.faces, strict=True))
            apart = FlankGaps(driver, driven, driver_flank=(*first, *self.cutter), driven_flank=second)
        if misalignment:
            off = self.errors
            apart = replace(
                apart, face_position=off.face_position, line_gap=off.line_gap, tilt=off.tilt, shafts=off.shafts,
                driver_flank=(*apart.driver_flank, *off.cutting),
            )  # fmt: skip
        if spacing_errors:
            one, other = (flank.spacing for flank in self.flanks)
            apart = replace(apart, driver_spacing=one, driven_spacing=other, base_pitch=self.base_pitch)
        return apart


def table_notes(asked: FlanksToLoad) -> tuple[str, ...]:
    """Where tables of relief, lead and topography end before the flanks do, if the effect `relief` counts them."""
    if not asked.effects.relief:
        return ()
    parts = zip(MEMBERS, asked.flanks, asked.faces, strict=True)
    notes = (
        note
        for member, flank, face in parts
        for note in (
            *flank.table_notes(asked.pair, member),
            *face_table_notes(asked.pair, member, flank.gear, face.parts),
        )
    )
    return tuple(dict.fromkeys(notes))


def flanks_to_load(scene: Scene, name: str) -> FlanksToLoad:
    """Collect what a case says of the loaded flanks of a pair.

    Raises
    ------
    InputError
        If a file is missing or has not what it is named for.
    """
    part, pair, effects = scene.case.pair[name], scene.pairs[name], scene.case.effects
    first, second = (gear_flanks(scene, gear_name(scene, name, member)) for member in MEMBERS)
    own = effects.only(WIDE_EFFECTS)
    faces = gear_face(scene, first.gear), gear_face(scene, second.gear)
    errors = flank_errors(scene, name)
    nominal = part.normal_load(pair) or math.nan
    asked = scene.case.load_distribution
    panels = asked.panels or max(4, math.ceil(_PANELS_PER_MODULE * pair.face_width / pair.driver.module - 1e-9))
    width: Literal["solid", "slices"] = "slices" if part.width == "slices" else "solid"
    if effects.misalignment:
        pair = _placed(pair, errors.apart, name)
    return FlanksToLoad(
        pair, own, (first, second), faces, cutter_modification(scene, name), errors, part.all_loads(pair), nominal,
        asked.positions, panels, width, asked.base_pitch, name, scene.case.accuracy.tolerance, scene.estimates,
        scene.sizes_neglected,
    )  # fmt: skip


def _placed(pair: GearPair, apart: float, name: str) -> GearPair:
    """The pair at a centre distance that is off by `apart` [m]."""
    try:
        return replace(pair, centre_distance=pair.centre_distance + apart) if apart else pair
    except InputError as error:
        raise at(f"pair.{name}.misalignment", error) from None


def _check_misalignment(scene: Scene, name: str) -> None:
    part = scene.case.pair[name]
    if on_shafts(scene, name):
        if scene.pairs[name].driver.tooth.internal:
            raise InputError(
                f"pair.{name}.driver", f'"{part.driver}"', "is an internal gear: misalignment from shafts is not "
                                                           "available for 3D flanks",
                "make the planet the driver, or specify the misalignment of the pair",
            )  # fmt: skip
        check_heights(scene, name)
    elif part.line_error is None and part.misalignment is None:
        raise InputError(
            "effects.misalignment", "true", "has no effect: no misalignment or gap over the face width of pair "
                                            f"{name} is specified",
            f"specify pair.{name}.misalignment = {{ driven = {{ out_of_plane = \"10 um\" }} }} or shafts for both "
            "gears, or switch the effect off",
        )  # fmt: skip


def check_flanks_to_load(scene: Scene, name: str) -> None:
    """Refuse pairs that cannot be loaded with their width, and effects without data.

    Raises
    ------
    InputError
    """
    part, pair, effects = scene.case.pair[name], scene.pairs[name], scene.case.effects
    for gear in (part.driver, part.driven):
        check_solid_gear(scene, gear)
        check_source(scene, gear, f"pair.{name}.width", "slices" if part.width == "slices" else "solid")
    if part.normal_load(pair) is None:
        raise InputError(
            f"pair.{name}.load", "(not given)", "is required for the load distribution", "specify load or torque"
        )
    try:
        refuse_load(pair, max(part.all_loads(pair)))
    except InputError as error:
        raise at(f"pair.{name}", error) from None
    if pair.total_contact_ratio < 1.0 and not effects.corner_contact:
        raise InputError(
            f"pair.{name}", f"total contact ratio {pair.total_contact_ratio:.4f}",
            "is below 1: no tooth pair is in contact at some roll positions",
            "increase tooth depth, face width or number of teeth, or set effects.corner_contact = true",
        )  # fmt: skip
    if effects.misalignment:
        _check_misalignment(scene, name)
    asked = flanks_to_load(scene, name)
    gears = scene.case.gear.values()
    if effects.relief and not (asked.cutter or any(gear.relieved or gear.over_face for gear in gears)):
        raise InputError(
            "effects.relief", "true", "has no effect: no gear of this case has relief, lead, bias or topography",
            f"specify gear.{part.driver}.relief or lead, or switch the effect off",
        )  # fmt: skip
    if effects.spacing_errors and all(gear.spacing_errors is None for gear in gears):
        raise InputError(
            "effects.spacing_errors", "true", "has no effect: no gear of this case has spacing_errors",
            f"specify gear.{part.driver}.spacing_errors, or switch the effect off",
        )  # fmt: skip
    for flank in asked.flanks:
        if effects.relief and flank.wants_delta:
            raise InputError(
                f"gear.{flank.gear}.relief", "amount_over_delta", "is defined for the plane (2D) model only",
                "specify the amount as a length for 3D gears",
            )  # fmt: skip
    asked.gaps(relief=effects.relief, misalignment=False)
