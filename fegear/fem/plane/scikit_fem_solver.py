"""A sector assembled, condensed and solved by scikit-fem: the plain way, beside `condensation`.

`asm` integrates the weak form of `fem.forms` over vector-valued functions of every element. Then each kept unknown is
moved by one while the others stay: `condense` makes these motions boundary values, `solve` finds all of them with one
factorization of a direct solver, and the forces that they take are the stiffness between the kept unknowns.
"""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.errors import FegearError

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index
    from fegear.fem.plane.elements import SectorElements

#: Motions are solved for so many at a time: what scikit-fem makes of them is dense.
_AT_ONCE = 64


def assembled(elements: SectorElements, lam: float, mu: float, chosen: Index | None = None) -> Any:
    """Stiffness of the whole sector, or of some of its elements, E = 1.

    Parameters
    ----------
    elements : SectorElements
    lam, mu : float
        Lame's constants.
    chosen : ndarray of int, optional

    Returns
    -------
    scipy.sparse.csr_matrix, shape (size, size)
        Unknown 2 i + c is component c of node i.
    """
    from skfem import asm

    from fegear.fem.forms import plane_elasticity

    return asm(plane_elasticity, elements.vector_basis(chosen=chosen), lam=lam, mu=mu)


def between_kept(stiffness: Any, kept: Index, held: Index, *, motions: bool = False) -> tuple[Array, Array | None]:
    """Eliminate every unknown that is neither kept nor held.

    Parameters
    ----------
    stiffness : scipy.sparse.csr_matrix, shape (size, size)
        Positive semi-definite.
    kept : ndarray of int, shape (n,)
        Unknowns to keep, in this order.
    held : ndarray of int
        Unknowns that are zero.
    motions : bool
        Whether to keep the motions of all unknowns, which takes memory.

    Returns
    -------
    stiffness : ndarray, shape (n, n)
        Between the kept unknowns.
    motions : ndarray, shape (size, n), or None
        Of every unknown where one of the kept is moved by one and the others stay.

    Raises
    ------
    FegearError
        If the stiffness is singular.
    """
    from skfem import condense, solve

    size, n = stiffness.shape[0], kept.size
    fixed, seen, factored = np.union1d(kept, held), stiffness[kept], _Factored()
    forces = np.empty((n, n))
    every = np.empty((size, n)) if motions else None
    for first in range(0, n, _AT_ONCE):
        some = np.arange(first, min(first + _AT_ONCE, n))
        moved = np.zeros((size, some.size))
        moved[kept[some], some - first] = 1.0
        found = solve(*condense(stiffness, np.zeros_like(moved), x=moved, D=fixed), solver=factored)
        forces[:, some] = seen @ found
        if every is not None:
            every[:, some] = found
    return 0.5 * (forces + forces.T), every


class _Factored:
    """A direct solver for scikit-fem's `solve` that factors the first matrix it gets: all that follow are the same."""

    def __init__(self) -> None:
        self._lu: Any = None

    def __call__(self, matrix: Any, right: Array) -> Array:
        from scipy.sparse.linalg import splu

        if self._lu is None:
            options = {"SymmetricMode": True}
            try:
                self._lu = splu(matrix.tocsc(), permc_spec="MMD_AT_PLUS_A", diag_pivot_thresh=0.0, options=options)
            except RuntimeError as error:
                raise FegearError(f"the sector's stiffness cannot be factored: {error}") from None
        return np.asarray(self._lu.solve(right))
