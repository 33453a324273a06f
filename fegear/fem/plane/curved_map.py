"""scikit-fem's map of curved elements, with what a basis asks of it for every function computed once."""

from __future__ import annotations

from collections.abc import Callable
from functools import lru_cache
from typing import Any

import numpy as np
from skfem import MappingIsoparametric

from fegear.base.arrays import Array, Index


class CurvedMap(MappingIsoparametric):  # type: ignore[misc]  # scikit-fem has no types
    """Isoparametric map of the elements of a grid that keeps the derivatives that were last asked for.

    A basis asks for them once for each shape function, at the same points of the same elements.
    """

    def __init__(self, grid: Any) -> None:
        super().__init__(grid, grid.elem())
        self._kept: dict[str, tuple[Any, Any, Array]] = {}

    def J(self, i: int, j: int, X: Array, tind: Index | None = None) -> Array:
        """Derivative of coordinate i along reference coordinate j, shape (m, q)."""
        return self._once("J", self._derivatives, X, tind)[i, j]

    def invDF(self, X: Array, tind: Index | None = None) -> Array:
        """Derivatives of the reference coordinates along x and y, shape (2, 2, m, q)."""
        return self._once("invDF", super().invDF, X, tind)

    def _once(self, what: str, find: Callable[..., Array], at: Array, chosen: Index | None) -> Array:
        last = self._kept.get(what)
        if last is None or last[0] is not at or last[1] is not chosen:
            self._kept[what] = last = (at, chosen, find(at, chosen))
        return last[2]

    def _derivatives(self, at: Array, chosen: Index | None) -> Array:
        nodes = self.mesh.dofs.element_dofs
        places = self.mesh.doflocs[:, nodes if chosen is None else nodes[:, chosen]]
        kind: Any = type(self.elem)
        found = places.transpose(0, 2, 1) @ _slopes(kind, at.tobytes())
        return found.reshape(2, -1, 2, at.shape[1]).transpose(0, 2, 1, 3)


@lru_cache(maxsize=16)
def _slopes(kind: Any, places: bytes) -> Array:
    """Slopes of a kind of element's shape functions at reference points, shape (n, 2 q)."""
    at, element = np.frombuffer(places).reshape(2, -1), kind()
    return np.stack([element.lbasis(at, i)[1].reshape(-1) for i in range(element.doflocs.shape[0])])
