"""A solid sector assembled, condensed and solved by scikit-fem, beside the nested dissection of `dissection`.

`asm` integrates the section's weak forms over functions with three components; products along the face come from
`face`, and the sum of Kronecker products of both is the sector's stiffness, whose inner unknowns `condense` and `solve`
eliminate as in the plane (`fem.plane.scikit_fem_solver`). It takes the memory of a direct solver in space.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.fem.plane.elasticity import lame

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index
    from fegear.fem.plane.elements import SectorElements

#: Integrals of B0' C B0, B0' C B1 and B1' C B1 over one zone of a section, sparse.
SectionMatrices = tuple[Any, Any, Any]


def assembled_zones(
    elements: SectorElements, axes: Array, tau: float, poisson_ratio: float, zone: Index, lean: Array | None
) -> tuple[SectionMatrices, ...]:
    """Sparse matrices of a section, zone by zone; E = 1.

    Parameters
    ----------
    elements : SectorElements
    axes : ndarray, shape (N, 3, 3)
        Columns are the axes of each node, along which its unknowns count.
    tau : float
        Twist [rad/module].
    poisson_ratio : float
    zone : ndarray of int, shape (M,)
        That each element belongs to.
    lean : ndarray, shape (M,), or None
        Tangent of the inclination of the web that each element belongs to.

    Returns
    -------
    tuple of SectionMatrices
        Each of shape (3 N, 3 N); unknown 3 i + c is component c of node i along the node's axes.
    """
    from scipy.sparse import block_diag
    from skfem import asm
    from skfem.element import DiscreteField

    from fegear.fem.forms import turned_along, turned_mixed, turned_section

    turned = block_diag(list(axes), format="csr")
    lam, mu = lame(poisson_ratio, "strain")
    found = []
    for number in range(int(zone.max()) + 1):
        chosen = np.flatnonzero(zone == number)
        if not chosen.size:
            zero = turned * 0.0
            found.append((zero, zero, zero))
            continue
        basis = elements.vector_basis(components=3, chosen=chosen)
        leaning = np.zeros(chosen.size) if lean is None else lean[chosen]
        given = {
            "place": DiscreteField(basis.mapping.F(basis.X, tind=chosen) + elements.tip),
            "lean": DiscreteField(np.repeat(leaning[:, None], basis.X.shape[1], axis=1)),
        }
        matrices = (
            asm(form, basis, lam=lam, mu=mu, tau=tau, **given) for form in (turned_section, turned_mixed, turned_along)
        )
        first, second, third = (turned.T @ matrix @ turned for matrix in matrices)
        found.append((first, second, third))
    return tuple(found)
