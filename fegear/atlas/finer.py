"""Compliances of a region of an atlas by more products than its stresses have, and how a file keeps them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.atlas.polynomials import products
from fegear.base.arrays import ReadOnlyArrays

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index

#: Of compliances left out of the common ones, over the largest, and the step of their parts: whole steps pack well.
_KEPT, _STEP = 2e-6, 1e-7


@dataclass(frozen=True, eq=False)
class Finer(ReadOnlyArrays):
    """Compliances of a region's gears, without what the body turns by.

    Parameters
    ----------
    degrees : ndarray of int, shape (M, 4)
    coefficients : ndarray, shape (M, compliances)
    """

    degrees: Index
    coefficients: Array

    def compliances(self, at: Array) -> Array:
        """At coordinates of shape (4, G), shape (G, compliances)."""
        return np.asarray(products(self.degrees, at) @ self.coefficients)


def kept(finer: list[Finer]) -> dict[str, Array]:
    """Of all regions as arrays for a file: parts of compliances that they have in common."""
    if not finer:
        return {}
    stacked = np.concatenate([one.coefficients for one in finer])
    _, sizes, common = np.linalg.svd(stacked, full_matrices=False)
    most = _KEPT * np.abs(stacked).max()
    step = 2.0 ** math.floor(math.log2(_STEP * np.abs(stacked).max()))
    count = max(1, int(np.count_nonzero(sizes > most)))
    common = common[:count].astype(np.float32)
    found: dict[str, Array] = {"finer": common}
    for number, one in enumerate(finer):
        parts = np.linalg.lstsq(common.astype(float).T, one.coefficients.T, rcond=None)[0].T
        found[f"finer_degrees_{number}"] = one.degrees.astype(np.uint8)
        found[f"finer_parts_{number}"] = (np.rint(parts / step) * step).astype(np.float32)
    return found
