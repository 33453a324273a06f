"""The configurations that are tried: closed forms, sectors of a few teeth, the whole gear, tolerances."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fegear.fem.settings import MeshSettings
from fegear.formulas.root_stress_sources import ROOT_STRESS_SOURCES
from fegear.formulas.sources import SOURCES
from fegear.studies.cost.configuration import ISO_STIFFNESS, Configuration

if TYPE_CHECKING:
    from collections.abc import Sequence

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
_REFERENCE_EDGES = {
    "flank_edge_length": 0.0125, "root_edge_length": 0.02, "root_fraction": 0.1,
    "tip_edge_length": 0.008, "junction_edge_length": 0.008,
}  # fmt: skip
_NARROW, _WIDE = 0.04, 0.08


@dataclass(frozen=True)
class Ladder:
    """The configurations, and what they are held against.

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
    settings = _ring(_SECTOR_ORDER, _SECTOR_FACTOR, usual).settings
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
