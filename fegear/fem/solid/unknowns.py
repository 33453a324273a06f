"""Unknowns of a solid sector: which functions along the face each node of its section has."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.base.arrays import Index, Mask


@dataclass(frozen=True)
class Unknowns:
    """Unknowns of the solid: which functions along the face each unknown of the section has.

    Parameters
    ----------
    number : ndarray of int, shape (size of the section, functions)
        Number of the unknown, section by section unknown; -1 where there is none.
    """

    number: Index

    @property
    def size(self) -> int:
        """Number of unknowns."""
        return int(self.number.max()) + 1

    def split(self, mask: Mask) -> tuple[Unknowns, Unknowns]:
        """Those within a mask of shape (size of the section, functions), and the others, each numbered anew."""
        has = self.number >= 0
        return unknowns(has & mask), unknowns(has & ~mask)

    def of(self, section_unknowns: Index) -> Index:
        """Unknowns of some of the section's, one after the other, short waves last."""
        found = self.number[section_unknowns]
        return found[found >= 0]


def unknowns(has: Mask) -> Unknowns:
    """Number the unknowns.

    Parameters
    ----------
    has : ndarray of bool, shape (size of the section, functions)
    """
    number = np.full(has.shape, -1, dtype=np.int64)
    number[has] = np.arange(int(has.sum()))
    return Unknowns(number)
