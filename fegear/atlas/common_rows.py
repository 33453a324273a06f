"""Rows of many gears as combinations of few common ones, kept in few bytes as sums of cosines."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import ReadOnlyArrays

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.atlas.tables import Layout
    from fegear.base.arrays import Array

#: What rows that an atlas keeps leave out of stresses at most, in proportion to the largest of their kind, and of
#: compliances this part of it.
KEPT, _OF_COMPLIANCES = 6e-5, 0.1
#: Ends of flank and fillet that count as much as the largest stress [modules].
_OF_ENDS = 0.3
#: Of what is left out, the step of the whole numbers that the common rows are kept as.
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

    def kept(self, layout: Layout) -> dict[str, Array]:
        """As arrays for a file: whole numbers of waves, their bytes apart, which packs well."""
        whole = np.rint(_waves(self.rows / self.scale, layout) / self.steps[:, None]).astype(np.int64)
        unsigned = ((whole << 1) ^ (whole >> 63)).astype("<u4")
        planes = np.moveaxis(np.ascontiguousarray(unsigned)[..., None].view(np.uint8), -1, 0)
        return {"common": np.ascontiguousarray(planes), "steps": self.steps, "scale": self.scale}

    @classmethod
    def of(cls, file: Mapping[str, Array], layout: Layout) -> CommonRows:
        """From those arrays."""
        planes, steps, scale = file["common"], file["steps"], file["scale"]
        unsigned = np.ascontiguousarray(np.moveaxis(planes, 0, -1)).view("<u4")[..., 0].astype(np.int64)
        whole = (unsigned >> 1) ^ -(unsigned & 1)
        return cls(_waves(whole * steps[:, None], layout, back=True) * scale, steps, scale)


def common_rows(rows: Array, layout: Layout) -> CommonRows:
    """Few common rows of many: as many as leave out of none more than `KEPT`.

    Stresses count in proportion to the largest of their kind, and compliances more.
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
    whole = np.rint(_waves(right[:fewest], layout) / steps[:, None])
    return CommonRows(_waves(whole * steps[:, None], layout, back=True) * scale, steps, scale)


def _waves(rows: Array, layout: Layout, *, back: bool = False) -> Array:
    """The same with c_0 and stress as sums of cosines, most of which are next to nothing; or back from these."""
    found = np.array(rows)
    own, stress = layout.own(found), layout.stresses(found)
    over, contact, point = (_cosines(count, back=back) for count in (own.shape[-1], *stress.shape[-2:]))
    own[...] = own @ over.T
    stress[...] = contact @ stress @ point.T
    return found


def _cosines(count: int, *, back: bool) -> Array:
    """Orthonormal cosines, one a row: from values to their waves, or transposed."""
    waves = np.cos(np.pi * np.outer(np.arange(count), np.arange(count) + 0.5) / count) * np.sqrt(2.0 / count)
    waves[0] *= np.sqrt(0.5)
    return np.asarray(waves.T if back else waves)


def _scale(rows: Array, layout: Layout) -> Array:
    """What errors of each number count in proportion to, of shape of a row: the largest of its kind."""
    scale = np.empty(rows.shape[1])
    layout.own(scale)[...] = np.abs(layout.own(rows)).max()
    for k in range(1, layout.reach + 1):
        layout.neighbour(scale, k)[...] = np.abs(layout.own(rows)).max()
    for kernel in layout.kernels:
        layout.stress(scale, kernel)[...] = np.abs(layout.stress(rows, (0, kernel[1]))).max()
    scale[: layout.compliances] *= _OF_COMPLIANCES
    layout.ends(scale)[...] = _OF_ENDS
    return scale
