"""The configurations of a pair that is loaded over its face: thin slices, coupled slices, solid gears."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Literal, cast

from fegear.fem.solid import SolidSettings
from fegear.fem.solid.settings import solid_settings
from fegear.models.solid_influence import seconds_of_solid_gear
from fegear.studies.cost.configuration import Configuration
from fegear.studies.cost.ladder import Ladder

if TYPE_CHECKING:
    from fegear.studies.cost.asked import Asked
    from fegear.studies.cost.configuration import Family

#: What pairs without neighbouring teeth have at the end of their family.
ALONE = "-alone"
#: What bodies are called.
BODIES = {"thin-slices": "thin slices", "coupled-slices": "coupled slices", "solid": "solid"}
#: Tolerances whose settings are tried, the last without neighbours and slices with other panels, too; that of the
#: reference, and by how much the check beside it is coarser.
_TOLERANCES, _REFERENCE, _CHECK = (1e-1, 3e-2, 1e-2), 3e-3, 1.35
_QUICK_TOLERANCES, _QUICK_REFERENCE = (1e-1, 3e-2), 1e-2
#: Its bands take less room beside the ends of the flank.
_ROOM = 0.7
#: Panels along the face over the case's; of reference and check.
_PANELS, _FINE_PANELS, _CHECK_PANELS = (0.5, 1.0, 2.0), 3.0, 2.0
_FEWEST_PANELS = 2
#: Seconds of the compliances and the contact of one configuration at a roll position, about.
_POSITION = 0.012


@dataclass(frozen=True, slots=True)
class FlankConfiguration(Configuration):
    """A pair that is loaded over its face in one way.

    Parameters
    ----------
    solid : SolidSettings
        Of its gears.
    panels : int
        Along the face.
    """

    solid: SolidSettings = field(default_factory=SolidSettings)
    panels: int = 0

    @property
    def body(self) -> str:
        """What its gears are: a key of `BODIES`."""
        return self.family.removesuffix(ALONE)

    @property
    def neighbours(self) -> bool:
        """Whether tooth pairs deflect each other."""
        return not self.family.endswith(ALONE)

    @property
    def label(self) -> str:
        """Short name, unlike that of any other configuration of a study."""
        s = self.solid.section
        alone = "" if self.neighbours else " without neighbours"
        return f"{BODIES[self.body]}{alone}, order {s.order}, edges x {self.factor:.3g}, {self.panels} panels"

    def paste(self, pair: str) -> str:
        """Lines of a case file that ask for it; empty for what no case can ask for."""
        if self.body == "thin-slices" or self.solid != SolidSettings() or not pair:
            return ""
        width = "slices" if self.body == "coupled-slices" else "solid"
        return "\n".join((
            f'pair.{pair}.width = "{width}"', f"accuracy.tolerance = {_TOLERANCES[-1]:g}",
            f"effects.neighbour_coupling = {str(self.neighbours).lower()}", f"load_distribution.panels = {self.panels}",
        ))  # fmt: skip


def flank_ladder(panels: int, *, quick: bool = False) -> Ladder:
    """Make the ladder; groups of its `meshes` share their solved gears.

    Parameters
    ----------
    panels : int
        Along the face, as the case has them.
    quick : bool
        Coarser gears and reference.
    """
    tolerances = _QUICK_TOLERANCES if quick else _TOLERANCES
    best = solid_settings(_QUICK_REFERENCE if quick else _REFERENCE)
    second = best.scaled(_CHECK)
    second = replace(second, room_share=_ROOM * best.room_share)
    counts = {share: max(_FEWEST_PANELS, round(share * panels)) for share in (*_PANELS, _FINE_PANELS, _CHECK_PANELS)}
    usual = solid_settings(tolerances[-1])

    groups = [
        tuple(dict.fromkeys((
            *((_one(f"{body}{ALONE}", settings, counts[1.0]),) if settings == usual else ()),
            *(_one(body, settings, counts[s]) for s in (_PANELS if body == "solid" or settings == usual else (1.0,))),
        )))
        for body in BODIES
        for settings in map(solid_settings, tolerances)
    ]  # fmt: skip
    reference, check = _one("solid", best, counts[_FINE_PANELS]), _one("solid", second, counts[_CHECK_PANELS])
    return Ladder(reference, check, tuple(groups), ())


def _one(family: str, solid: SolidSettings, panels: int) -> FlankConfiguration:
    section = replace(solid.section, patch_half_width=solid.band_half_width)
    factor = section.root_edge_length / SolidSettings().section.root_edge_length
    return FlankConfiguration(cast("Family", family), section, factor, solid=solid, panels=panels)


def flank_seconds(asked: Asked, ladder: Ladder) -> float:
    """About how long its study takes on one core [s]."""
    pair = asked.scene.pairs[asked.pair]
    width = pair.face_width / pair.driver.module
    total = _POSITION * asked.scene.case.load_distribution.positions * (len(ladder.configurations) + 2)
    for one in (ladder.reference, ladder.check, *(group[0] for group in ladder.meshes)):
        if isinstance(one, FlankConfiguration):
            source: Literal["solid", "slices"] = "solid" if one.body == "solid" else "slices"
            total += 2.0 * seconds_of_solid_gear(replace(one.solid, source=source), width)
    return total
