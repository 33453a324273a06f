"""Measured natural frequencies beside computed ones: which is which, and how far they are off together and apart."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import ReadOnlyArrays
from fegear.base.printed import percent
from fegear.base.shown import shown, shows

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Array


@dataclass(frozen=True)
class MeasuredModes(ReadOnlyArrays):
    """Measured natural frequencies, ascending, each with the mode that it is taken for; K of them."""

    mode: NDArray[np.int64] = shown("", "natural mode", label="natural mode")
    measured: Array = shown("Hz", "natural frequency measured", label="natural frequency")
    computed: Array = shown("Hz", "natural frequency computed, undamped", label="natural frequency")

    @property
    @shows("", "measured / computed natural frequency")
    def ratio(self) -> Array:
        """Shape (K,)."""
        return np.asarray(self.measured / self.computed)

    @property
    @shows("", "measured / computed natural frequency, geometric mean", name="measured_frequency_ratio")
    def mean_ratio(self) -> float:
        """By which a factor of all stiffnesses or inertias would move the computed ones."""
        return float(np.exp(np.log(self.ratio).mean()))

    @property
    @shows("", "standard deviation of measured / computed about its mean", name="measured_frequency_scatter")
    def scatter(self) -> float:
        """Zero for one frequency."""
        return float((self.ratio / self.mean_ratio).std())

    @property
    def off(self) -> str:
        """How far they are off, a sentence without its end."""
        off, k = self.mean_ratio - 1.0, int(np.abs(np.log(self.ratio)).argmax())
        where = f"{self.measured[k]:.4g} Hz for {self.computed[k]:.4g} Hz of mode {self.mode[k]}"
        one = self.measured.size == 1
        return (
            f"{percent(abs(off))} {'above' if off >= 0.0 else 'below'} the computed "
            f"{'one' if one else 'ones on average'} ({where}{'' if one else ' is farthest off'})"
        )

    @property
    def verdict(self) -> str:
        """The same with what a common factor would say."""
        off, said, one = self.mean_ratio - 1.0, self.off, self.measured.size == 1
        stiff = self.mean_ratio**2 - 1.0
        if self.scatter > max(abs(off), _ONE_FACTOR):
            return f"{said}, with a scatter of ±{percent(self.scatter)}: no common factor; check which modes they are"
        said += f", as a stiffness {percent(abs(stiff))} {'higher' if stiff >= 0.0 else 'lower'} would make it"
        return said if one else f"{said}; scatter about that ±{percent(self.scatter)}"


#: Scatter of ratios up to which they are taken for one factor, however small that is.
_ONE_FACTOR = 0.05
#: Rounds after which modes are taken as they are.
_ROUNDS = 20


def beside_modes(measured: Array, computed: Array) -> MeasuredModes:
    """Assign measured natural frequencies to modes: in order, with the least scatter of ratios about their mean.

    Close modes are told apart by the common factor of all: the assignment with the least sum of squared logarithms is
    repeated with frequencies divided by the mean ratio until it stays.

    Parameters
    ----------
    measured : ndarray, shape (K,)
        [Hz].
    computed : ndarray, shape (M,)
        Of the modes from 1 on, ascending; at least as many [Hz].
    """
    from scipy.optimize import linear_sum_assignment

    wanted, factor = np.sort(measured), 1.0
    known: list[int] = []
    for _ in range(_ROUNDS):
        cost = np.log(wanted[:, None] / factor / computed[None, :]) ** 2
        mode = np.sort(linear_sum_assignment(cost)[1])
        if mode.tolist() == known:
            break
        known = mode.tolist()
        factor = float(np.exp(np.log(wanted / computed[mode]).mean()))
    return MeasuredModes(mode + 1, wanted, computed[mode])
