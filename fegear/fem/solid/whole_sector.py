"""A solid sector as one matrix, whose inner unknowns scikit-fem eliminates at once, beside `dissection`."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.fem.plane.condensation import Condensed
from fegear.fem.plane.scikit_fem_solver import between_kept
from fegear.fem.solid.scikit_fem_solver import SectionMatrices

if TYPE_CHECKING:
    from fegear.base.arrays import Index
    from fegear.fem.solid.face import FaceFunctions, JoinedFunctions
    from fegear.fem.solid.section import Section
    from fegear.fem.solid.unknowns import Unknowns


def condense_whole(
    section: Section,
    zones: tuple[SectionMatrices, ...],
    face: FaceFunctions | JoinedFunctions,
    known: Unknowns,
    kept: Index,
    *,
    expandable: bool = False,
) -> Condensed:
    """As `dissection.condense_solid`, by one factorization of the whole sector."""
    stiffness = assembled_sector(section, zones, face, known)
    wanted = known.of(kept)
    between, motions = between_kept(stiffness, wanted, np.zeros(0, dtype=np.int64), motions=expandable)
    return Condensed(wanted, between, known.size, (), motions)


def assembled_sector(
    section: Section, zones: tuple[SectionMatrices, ...], face: FaceFunctions | JoinedFunctions, known: Unknowns
) -> Any:
    """Stiffness of a solid sector: section integrals times those along the face, sparse, shape (size, size)."""
    from scipy.sparse import csr_array, kron

    there = np.flatnonzero(known.number.reshape(-1) >= 0)
    found = csr_array((there.size, there.size))
    for (in_section, mixed, along), (m0, m1, m2) in zip(zones, section.products_along(face), strict=True):
        for left, right in ((in_section, m0), (mixed, m1), (mixed.T, m1.T), (along, m2)):
            if left.nnz:
                found = found + csr_array(kron(left, csr_array(right), format="csr"))[there][:, there]
    return found
