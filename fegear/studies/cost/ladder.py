"""The configurations that are tried: closed forms, sectors of a few teeth, the whole gear, tolerances.

One way to compute: a formula, a sector with free sides, the whole ring with some settings, or a tolerance.

The configurations of a pair that is loaded over its face: thin slices, coupled slices, solid gears.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass, field, replace
from typing import TYPE_CHECKING, Any, Literal, cast

from fegear.case.accuracy import AccuracyPart
from fegear.case.built.solid_influence import seconds_of_solid_gear
from fegear.case.built.tooth_influence import settings_for
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.solid.settings import SolidSettings, solid_settings
from fegear.formulas.root_stress_formulas import ROOT_STRESS_SOURCES
from fegear.formulas.sources import SOURCES

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.studies.cost.asked import Asked


#: Edge lengths over the usual ones, for each order of the elements.
_FACTORS = {
    2: (4.0, 2.8, 2.0, 1.4, 1.0, 0.7, 0.5),
    3: (4.0, 2.8, 2.0, 1.4, 1.0, 0.7),
    4: (4.0, 2.8, 2.0, 1.4, 1.0, 0.7),
}


_QUICK_FACTORS = {2: (4.0, 2.0, 1.0), 3: (4.0, 2.0), 4: (2.8, 1.4)}


#: Half-widths of the pressure that loads the mesh, over the usual one.
_PATCHES, _QUICK_PATCHES = (2.0, 1.0, 0.5), (2.0, 1.0)


#: A pressure narrower than this many edges of the flank is not worth a configuration.
_NARROWEST = 0.75


#: Teeth of the sectors with free sides; those that the picture names are 3, 5 and 9.
_SECTORS, _QUICK_SECTORS = (3, 5, 7, 9, 13), (3, 5, 9)


#: Mesh of the sectors: fine enough that what they miss is the sector.
_SECTOR_ORDER, _SECTOR_FACTOR = 4, 1.4


_TOLERANCES = (1e-1, 1e-2, 1e-3, 1e-4, 1e-5)


#: The reference lies one step beyond the ladder: order 4, edges along flank and fillet finer than its finest, and the
#: true contact's half-width for the pressure (within bounds that the mesh resolves).
_REFERENCE_FACTOR, _QUICKER, _CHECK = 1.0, 2.0, 1.4


_REFERENCE_EDGES: dict[str, Any] = {
    "flank_edge_length": 0.0125, "root_edge_length": 0.02, "root_fraction": 0.1,
    "tip_edge_length": 0.008, "junction_edge_length": 0.008,
}  # fmt: skip


_NARROW, _WIDE = 0.04, 0.08


@dataclass(frozen=True)
class Ladder:
    """The configurations, and what they are compared with.

    Parameters
    ----------
    reference : Configuration
    check : Configuration
        A coarser one beside it; their difference is the floor below which no error is claimed.
    meshes : tuple of tuple of Configuration
        Finite-element configurations that differ in the patch alone, which costs no new solution.
    others : tuple of Configuration
        Closed forms and tolerances, each on its own.
    """

    reference: Configuration
    check: Configuration
    meshes: tuple[tuple[Configuration, ...], ...]
    others: tuple[Configuration, ...]

    @property
    def configurations(self) -> tuple[Configuration, ...]:
        """All but reference and check."""
        return tuple(configuration for group in self.meshes for configuration in group) + self.others


def _ring(order: int, factor: float, patch: float) -> Configuration:
    s = MeshSettings().scaled(factor)
    # No coarser than a case file may ask for.
    s = replace(s, rim_fraction=min(s.rim_fraction, 1.0), body_fraction=min(s.body_fraction, 10.0))
    return Configuration("ring", replace(s, order=order, patch_half_width=patch), factor)


def make_ladder(
    half_width: float, quantities: Sequence[str], teeth: int, *, tabled: bool = False, quick: bool = False
) -> Ladder:
    """Make the ladder for what is asked.

    Parameters
    ----------
    half_width : float
        Usual half-width of the true contact [modules].
    quantities : sequence of str
        Names of the quantities that finite elements and formulas have a say in; none, no such configurations.
    teeth : int
        Smallest number of teeth of a gear: a sector must be smaller.
    tabled : bool
        Whether a pair's compliances come from the case's own table.
    quick : bool
        A few configurations instead of all.

    Returns
    -------
    Ladder
    """
    patch = min(max(half_width, _NARROW), _WIDE) if half_width > 0.0 else _WIDE
    reference, check = _reference(patch, quick=quick)
    others = [Configuration("table")] if tabled else []
    if not quantities:
        return Ladder(reference, check, (), tuple(others))
    usual = MeshSettings().patch_half_width
    patches = sorted({*(usual * p for p in (_QUICK_PATCHES if quick else _PATCHES)), round(patch, 4)}, reverse=True)
    meshes = []
    for order, factors in (_QUICK_FACTORS if quick else _FACTORS).items():
        for factor in factors:
            narrowest = _NARROWEST * MeshSettings().scaled(factor).flank_edge_length * 2.0 / order
            meshes.append(tuple(_ring(order, factor, p) for p in patches if p >= narrowest))
    # The same mesh as one of the ring's, so that both can be compared.
    plain = _ring(_SECTOR_ORDER, _SECTOR_FACTOR, usual)
    settings = plain.settings
    if settings is not None:
        both = replace(plain, family="scikit-fem", settings=replace(settings, solver="scikit-fem"))
        meshes.append((both,))
    sectors = _QUICK_SECTORS if quick else _SECTORS
    meshes += [(Configuration("sector", settings, _SECTOR_FACTOR, n),) for n in sectors if n < teeth]
    if set(quantities) - {"root-stress"}:
        others += [Configuration("compliance-formula", formula=name) for name in (*SOURCES, ISO_STIFFNESS)]
    if "root-stress" in quantities:
        others += [Configuration("stress-formula", formula=name) for name in ROOT_STRESS_SOURCES]
    others += [Configuration("tolerance", tolerance=t) for t in (_TOLERANCES[:3] if quick else _TOLERANCES)]
    return Ladder(reference, check, tuple(meshes), tuple(others))


def _reference(patch: float, *, quick: bool) -> tuple[Configuration, Configuration]:
    """Order 4 with edges along flank and fillet finer than any of the ladder's, and the same a step coarser."""
    fine = MeshSettings().scaled(_REFERENCE_FACTOR)
    fine = replace(fine, order=4, patch_half_width=patch, **_REFERENCE_EDGES)
    both = (fine.scaled(_QUICKER), fine.scaled(_QUICKER * _CHECK)) if quick else (fine, fine.scaled(_CHECK))
    made = [Configuration("ring", s, s.flank_edge_length / MeshSettings().flank_edge_length) for s in both]
    return made[0], made[1]


Family = Literal[
    "compliance-formula", "stress-formula", "sector", "ring", "scikit-fem", "tolerance", "table",
    "thin-slices", "thin-slices-alone", "coupled-slices", "coupled-slices-alone", "solid", "solid-alone",
]  # fmt: skip


#: The mean stiffness of the standard as a compliance of each tooth.
ISO_STIFFNESS = "iso6336-stiffness"


@dataclass(frozen=True, slots=True)
class Configuration:
    """One configuration of a cost study.

    Parameters
    ----------
    family : str
        ``compliance-formula``, ``stress-formula``, ``sector`` (teeth with free sides), ``ring`` (the whole gear),
        ``scikit-fem`` (the whole gear, its sector assembled and condensed by scikit-fem: ``accuracy.solver``),
        ``tolerance`` (what a run picks for ``accuracy.tolerance``), ``table`` (the case's own compliances); of a pair
        that is loaded over its face ``thin-slices``, ``coupled-slices`` and ``solid``, with ``-alone`` without
        neighbouring teeth.
    settings : MeshSettings or None
        Of finite elements with given settings.
    factor : float
        Edge lengths over the usual ones.
    teeth : int
        Teeth of a sector.
    formula : str
        Name of a closed form.
    tolerance : float
    """

    family: Family
    settings: MeshSettings | None = None
    factor: float = math.nan
    teeth: int = 0
    formula: str = ""
    tolerance: float = math.nan

    @property
    def label(self) -> str:
        """Short name, unlike that of any other configuration of a study."""
        if self.family == "tolerance":
            return f"tolerance = {self.tolerance:.0e}"
        if self.family == "table":
            return "table of the case"
        if self.settings is None:
            return f"{self.formula}, {'root stress' if self.family == 'stress-formula' else 'compliance'}"
        s = self.settings
        who = f"sector of {self.teeth} teeth" if self.family == "sector" else "full gear"
        by = ", by scikit-fem" if self.family == "scikit-fem" else ""
        return f"{who}, order {s.order}, edges x {self.factor:.3g}, patch {s.patch_half_width:.4g}{by}"

    def paste(self, pair: str) -> str:
        """The configuration as lines of a case file; empty for what no case can ask for.

        Parameters
        ----------
        pair : str
            Name of the pair whose compliance source it may be; empty for none.
        """
        if self.family == "tolerance":
            return f"accuracy = {{ tolerance = {self.tolerance:g} }}"
        if self.family in ("ring", "scikit-fem") and self.settings is not None:
            usual = asdict(settings_for(AccuracyPart().tolerance))  # what the line would mean without them
            own = {k: v for k, v in asdict(self.settings).items() if v != usual[k]} or {"order": self.settings.order}
            keys = (f'{k} = "{v}"' if isinstance(v, str) else f"{k} = {v:.6g}" for k, v in own.items())
            return "accuracy = { " + ", ".join(keys) + " }"
        if self.family == "compliance-formula" and pair and self.formula != ISO_STIFFNESS:
            return f'pair.{pair}.compliance = {{ source = "{self.formula}" }}'
        return ""


#: What pairs without neighbouring teeth have at the end of their family.
ALONE = "-alone"


#: What bodies are called.
BODIES = {"thin-slices": "thin slices", "coupled-slices": "coupled slices", "solid": "solid"}


#: Tolerances whose settings are tried, the last without neighbours and slices with other panels, too; that of the
#: reference, and by how much the check of it is coarser.
_WIDE_TOLERANCES, _REFERENCE, _WIDE_CHECK = (1e-1, 3e-2, 1e-2), 3e-3, 1.35


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
            f'pair.{pair}.width = "{width}"', f"accuracy.tolerance = {_WIDE_TOLERANCES[-1]:g}",
            f"effects.neighbour_coupling = {str(self.neighbours).lower()}", f"load_distribution.panels = {self.panels}",
        ))  # fmt: skip


def flank_ladder(panels: int, *, quick: bool = False, internal: bool = False) -> Ladder:
    """Make the ladder; groups of its `meshes` share their solved gears.

    Parameters
    ----------
    panels : int
        Along the face, as the case has them.
    quick : bool
        Coarser gears and reference.
    internal : bool
        Whether a gear is internal, which coupled slices do not know.
    """
    tolerances = _QUICK_TOLERANCES if quick else _WIDE_TOLERANCES
    best = solid_settings(_QUICK_REFERENCE if quick else _REFERENCE)
    second = best.scaled(_WIDE_CHECK)
    second = replace(second, room_share=_ROOM * best.room_share)
    counts = {share: max(_FEWEST_PANELS, round(share * panels)) for share in (*_PANELS, _FINE_PANELS, _CHECK_PANELS)}
    usual = solid_settings(tolerances[-1])

    groups = [
        tuple(dict.fromkeys((
            *((_one(f"{body}{ALONE}", settings, counts[1.0]),) if settings == usual else ()),
            *(_one(body, settings, counts[s]) for s in (_PANELS if body == "solid" or settings == usual else (1.0,))),
        )))
        for body in BODIES
        if not (internal and body == "coupled-slices")
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
