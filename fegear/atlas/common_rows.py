"""Rows of many gears as combinations of few common ones, kept in few bytes."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import ReadOnlyArrays

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.atlas.tables import Layout
    from fegear.base.arrays import Array

#: What rows that an atlas keeps leave out at most, in proportion to the largest numbers of their kind.
KEPT = 2e-5
#: Of that, the step of the whole numbers that the common rows are kept as.
_STEP = 0.15


@dataclass(frozen=True, eq=False)
class CommonRows(ReadOnlyArrays):
    """Common rows, and the steps of which their numbers are multiples.

    Parameters
    ----------
    rows : ndarray, shape (R, numbers)
    steps : ndarray, shape (R,)
    scale : ndarray, shape (numbers,)
        By which steps are longer for some kinds of numbers than for others.
    """

    rows: Array
    steps: Array
    scale: Array

    def parts(self, rows: Array) -> Array:
        """Parts of the common rows in rows, (N, R), that fit them best."""
        return np.asarray(np.linalg.lstsq((self.rows / self.scale).T, (rows / self.scale).T, rcond=None)[0].T)

    def kept(self) -> dict[str, Array]:
        """As arrays for a file: differences of neighbouring whole numbers, their bytes apart, which packs well."""
        whole = np.rint(self.rows / self.scale / self.steps[:, None]).astype(np.int64)
        apart = np.diff(whole, axis=1, prepend=0)
        unsigned = ((apart << 1) ^ (apart >> 63)).astype("<u4")
        planes = np.moveaxis(np.ascontiguousarray(unsigned)[..., None].view(np.uint8), -1, 0)
        return {"common": np.ascontiguousarray(planes), "steps": self.steps, "scale": self.scale}

    @classmethod
    def of(cls, file: Mapping[str, Array]) -> CommonRows:
        """From those arrays."""
        planes, steps, scale = file["common"], file["steps"], file["scale"]
        unsigned = np.ascontiguousarray(np.moveaxis(planes, 0, -1)).view("<u4")[..., 0].astype(np.int64)
        whole = np.cumsum((unsigned >> 1) ^ -(unsigned & 1), axis=1)
        return cls(whole * steps[:, None] * scale, steps, scale)


def common_rows(rows: Array, layout: Layout) -> CommonRows:
    """Few common rows of many: as many as leave out of none more than `KEPT`.

    Compliances count in proportion to the largest of their kind, and so do stresses.
    """
    scale = _scale(rows, layout)
    left, values, right = np.linalg.svd(rows / scale, full_matrices=False)
    parts, fewest, most = left * values, 1, values.size
    while fewest < most:  # the smallest count that is enough
        count = (fewest + most) // 2
        if np.abs(parts[:, count:] @ right[count:]).max() <= KEPT:
            most = count
        else:
            fewest = count + 1
    steps = _STEP * KEPT / np.abs(parts[:, :fewest]).max(axis=0)
    whole = np.rint(right[:fewest] / steps[:, None])
    return CommonRows(whole * steps[:, None] * scale, steps, scale)


def _scale(rows: Array, layout: Layout) -> Array:
    """Largest number of each kind, of shape of a row."""
    scale = np.empty(rows.shape[1])
    layout.own(scale)[...] = np.abs(layout.own(rows)).max()
    for k in range(1, layout.reach + 1):
        layout.neighbour(scale, k)[...] = np.abs(layout.own(rows)).max()
    for kernel in layout.kernels:
        layout.stress(scale, kernel)[...] = np.abs(layout.stress(rows, (0, kernel[1]))).max()
    layout.ends(scale)[...] = 0.1 * np.abs(layout.ends(rows)).max()
    return scale
