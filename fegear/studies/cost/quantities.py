"""The quantities of a cost study, and how far an answer is from the reference's."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from fegear.base.arrays import Array


#: Quantities of one gear, at many load positions; the others are numbers of a pair or a mesh.
OF_GEAR = ("c_0", "c_1", "root-stress")

#: Those of a pair that is loaded over its face.
OF_FLANKS = ("te-mean", "te-peak-to-peak", "face-load-factor")


@dataclass(frozen=True)
class Quantity:
    """One quantity of a cost study.

    Parameters
    ----------
    name, subject : str
        What, and of which gear, pair or mesh.
    unit, meaning : str
    """

    name: str
    subject: str
    unit: str
    meaning: str

    @property
    def of_gear(self) -> bool:
        """Whether it belongs to one gear, at many load positions."""
        return self.name in OF_GEAR


@dataclass(frozen=True, slots=True)
class Miss:
    """How far an answer is from the reference, relative.

    Parameters
    ----------
    largest, rms : float
        Over the load positions that have an answer; alike for a single number. NaN without any.
    answered : float
        Share of the positions that have an answer.
    """

    largest: float
    rms: float
    answered: float


def miss(quantity: str, values: Array, reference: Array) -> Miss:
    """Compare an answer with the reference.

    Parameters
    ----------
    quantity : str
    values, reference : ndarray, shape (P,)
        NaN where a formula is out of its range. Each position counts relative to its own reference, but c_1, which
        may pass through zero, relative to the largest c_1.
    """
    scale = np.full(reference.shape, np.abs(reference).max()) if quantity == "c_1" else np.abs(reference)
    found = np.isfinite(values)
    if not found.any():
        return Miss(math.nan, math.nan, 0.0)
    relative = (np.abs(values - reference) / scale)[found]
    return Miss(float(relative.max()), float(np.sqrt(np.mean(relative**2))), float(found.mean()))
