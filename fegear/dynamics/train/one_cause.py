"""Which one spring or inertia of a train explains measured natural frequencies.

Each stiffness of a mesh or a shaft, each inertia and all springs together are changed by a factor alone until the
natural frequencies are nearest to the measured ones (least squares of logarithms); what each leaves puts them in order.
To first order a change of a stiffness by a part e moves a natural frequency by e/2 times its share of the strain energy
of the mode, one of an inertia by -e/2 times its share of the kinetic energy (Rayleigh's quotient).
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.arrays import ReadOnlyArrays
from fegear.base.printed import percent
from fegear.base.shown import shown, shows
from fegear.dynamics.train.matrices import elements
from fegear.dynamics.train.measured_modes import beside_modes

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.dynamics.train.measured_modes import MeasuredModes
    from fegear.dynamics.train.train import Train

#: Largest factor of a stiffness or an inertia, and its inverse; factors that are tried first.
_LARGEST, _TRIED = 3.0, 81
#: Deviation that needs no reason, and deviation up to which a cause explains, also over the largest one before.
_AGREES, _EXPLAINS, _OF_BEFORE = 0.01, 0.01, 0.25
#: Deviation within which causes of a single frequency explain it, and causes that a sentence names.
_EXACT, _NAMED = 1e-3, 3
#: What causes that are as near as the nearest leave over what that one does.
_SIMILAR = 1.5
#: Measured frequencies of which one may be none of the train.
_FEWEST_WITH_FOREIGN = 3
#: Relative step of a derivative, and digits of a deviation from which on the smaller change comes first.
_STEP, _DIGITS = 1e-4, 6
_OTHERS = ("", "", "", "both other", "the other three", "the other four", "the other five")
_COUNTS = ("", "", "both", "all three", "all four", "all five", "all six")


class _Part(NamedTuple):
    """A stiffness or an inertia: its name, its place (-1: all springs), what becomes of it with a larger factor."""

    name: str
    place: int
    inertia: float = 0.0


@dataclass(frozen=True)
class OneCause(ReadOnlyArrays):
    """Causes of measured natural frequencies, what explains most first; C of them, K frequencies.

    Parameters
    ----------
    before : float
        Largest deviation of a measured frequency from the computed one, relative.
    inertia : ndarray of bool, shape (C,)
        Whether an inertia is changed, and not a stiffness.
    shares : ndarray, shape (C, K)
    modes : ndarray, shape (K,)
        Numbers of the modes, from 1.
    foreign, others : float
        Of three or more the measured frequency without which the others agree [Hz], and their largest deviation then,
        relative; zero for none.
    """

    before: float
    inertia: NDArray[np.bool_]
    modes: NDArray[np.int64]
    part: NDArray[np.str_] = shown("", "stiffness or inertia that is changed alone")
    factor: Array = shown("", "factor with which the natural frequencies are nearest to the measured ones")
    left: Array = shown("", "maximum remaining deviation of a measured frequency, relative", name="remaining_maximum")
    rms: Array = shown("", "remaining deviation, root mean square, relative", name="remaining_rms")
    shares: Array = shown("", "share of the part in strain energy (inertias: kinetic energy) of the mode", name="share")
    foreign: float = 0.0
    others: float = 0.0

    @property
    def shares_by_mode(self) -> dict[str, Array]:
        """Of every part, by the number of the mode."""
        return {str(mode): self.shares[:, k] for k, mode in enumerate(self.modes)}

    @property
    def explaining(self) -> NDArray[np.int64]:
        """Causes that explain the frequencies."""
        limit = _EXACT if self.modes.size == 1 else min(_EXPLAINS, _OF_BEFORE * self.before)
        return np.flatnonzero(self.left <= limit)

    @property
    def said(self) -> str:
        """What explains the frequencies, a sentence; empty where they agree."""
        if self.before <= _AGREES or not self.part.size:
            return ""
        found, count = self.explaining, self.modes.size
        if count == 1 and found.size > 1:
            near = found[np.argsort(np.abs(np.log(self.factor[found])), kind="stable")][:_NAMED]
            return f"One frequency does not determine the cause: {self._either(near)} would explain it."
        every = _COUNTS[count] if count < len(_COUNTS) else f"all {count}"
        if not found.size and self.foreign:
            others = _OTHERS[count] if count < len(_OTHERS) else f"the other {count - 1}"
            return (
                f"Without {self.foreign:.4g} Hz {others} measured frequencies agree with the computed ones within "
                f"{percent(self.others)}: it is probably no natural frequency of this train (bending of a shaft, "
                "housing, supports, a multiple of the shaft frequency); remove it."
            )
        if not found.size:
            near = np.flatnonzero(self.rms[:_NAMED] <= _SIMILAR * self.rms[0])
            return (
                f"No single spring or inertia explains the measured frequencies (deviations of up to "
                f"{percent(self.before)}): nearest {'is' if near.size == 1 else 'are'} "
                f"{self._either(near, within=True)}."
            )
        first = (
            f"{self._named(0)} explains {every if count > 1 else 'the'} measured frequenc{'ies' if count > 1 else 'y'}"
        )
        also = f"; so would {self._either(found[1:_NAMED], within=True)}" if found.size > 1 else ""
        return f"{first[0].upper()}{first[1:]} within {percent(self.left[0])} (now {percent(self.before)}){also}."

    def _either(self, places: NDArray[np.int64], *, within: bool = False) -> str:
        named = [self._named(k) + (f" (within {percent(self.left[k])})" if within else "") for k in places]
        return " or ".join([", ".join(named[:-1]), named[-1]] if len(named) > 1 else named)

    def _named(self, k: int) -> str:
        off = float(self.factor[k]) - 1.0
        if self.inertia[k]:
            return f"{self.part[k]} {percent(abs(off))} {'larger' if off >= 0.0 else 'smaller'}"
        return f"{self.part[k]} {percent(abs(off))} {'stiffer' if off >= 0.0 else 'softer'}"

    @property
    @shows("", "number of the cause")
    def number(self) -> NDArray[np.int64]:
        """From 1."""
        return 1 + np.arange(self.part.size)


@dataclass(frozen=True)
class _Springs:
    """Springs and inertias of a train.

    Parameters
    ----------
    rows : ndarray, shape (springs, size)
        Elongation per rotation.
    stiffness, inertia : ndarray
    """

    rows: Array
    stiffness: Array
    inertia: Array

    @classmethod
    def of(cls, train: Train) -> _Springs:
        """Those that have a stiffness."""
        springs = [one for one in elements(train) if one.stiffness > 0.0]
        rows = np.zeros((len(springs), train.size))
        for k, one in enumerate(springs):
            rows[k, one.a] += one.radius_a
            rows[k, one.b] += one.radius_b
        return cls(rows, np.array([one.stiffness for one in springs]), train.inertia)

    def natural(self, part: _Part, factor: Array) -> Array:
        """Natural frequencies above zero [Hz] with one part times each factor, shape (F, size - 1)."""
        k, j = (np.tile(one, (factor.size, 1)) for one in (self.stiffness, self.inertia))
        if part.inertia:
            j[:, part.place] += (factor - 1.0) * part.inertia
        else:
            which = slice(None) if part.place < 0 else slice(part.place, part.place + 1)
            k[:, which] *= factor[:, None]
        scaled = np.sqrt(k)[:, :, None] * self.rows / np.sqrt(j)[:, None, :]
        padded = np.concatenate([scaled, np.zeros((factor.size, j.shape[1], j.shape[1]))], axis=1)
        values = np.linalg.svd(padded, compute_uv=False)[:, : j.shape[1]][:, ::-1]
        return np.asarray(values[:, 1:] / (2.0 * math.pi))

    def shares(self, part: _Part, modes: NDArray[np.int64]) -> Array:
        """Share of a part in the energy of modes: twice the change of logarithms of frequency with that of the part."""
        step = np.array([1.0 - _STEP, 1.0 + _STEP])
        logs = np.log(self.natural(part, step)[:, modes - 1])
        return np.asarray(2.0 * np.abs(logs[1] - logs[0]) / math.log(step[1] / step[0]))


def one_cause(train: Train, found: MeasuredModes) -> OneCause:
    """What explains measured natural frequencies, each stiffness and each inertia changed alone.

    Parameters
    ----------
    train : Train
        With mean mesh stiffnesses.
    found : MeasuredModes
        Measured frequencies with their modes as computed.
    """
    springs = _Springs.of(train)
    names = [f"mesh {one.name}" for one in train.meshes if one.stiffness > 0.0]
    names += [f"shaft {one.name}" for one in train.elastic_shafts if one.stiffness > 0.0]
    parts = [_Part(name, k) for k, name in enumerate(names)]
    parts += [_Part("every spring", -1)] if len(parts) > 1 else []
    parts += [_Part(f"inertia of {one.name}", train.dof[one.name], one.inertia) for one in train.bodies]
    fitted = [_fitted(partial(springs.natural, part), found.measured) for part in parts]
    factor = np.array([one for one, _ in fitted])
    off = np.array([found.measured / near - 1.0 for _, near in fitted])
    rms = np.sqrt((np.log1p(off) ** 2).mean(axis=1))
    order = np.lexsort((np.abs(np.log(factor)), np.round(rms, _DIGITS)))
    foreign, others = _foreign(found, springs.natural(parts[0], np.ones(1))[0])
    return OneCause(
        float(np.abs(found.ratio - 1.0).max()), np.array([one.inertia > 0.0 for one in parts])[order], found.mode,
        np.array([one.name for one in parts])[order], factor[order], np.abs(off).max(axis=1)[order], rms[order],
        np.array([springs.shares(part, found.mode) for part in parts])[order], foreign, others,
    )  # fmt: skip


def _foreign(found: MeasuredModes, natural: Array) -> tuple[float, float]:
    """The measured frequency without which the others agree [Hz], and their largest deviation; zeros for none."""
    if found.measured.size < _FEWEST_WITH_FOREIGN:
        return 0.0, 0.0
    without = [beside_modes(np.delete(found.measured, k), natural) for k in range(found.measured.size)]
    off = np.array([np.abs(one.ratio - 1.0).max() for one in without])
    k = int(off.argmin())
    return (float(found.measured[k]), float(off[k])) if off[k] <= _AGREES else (0.0, 0.0)


def _fitted(natural: Callable[[Array], Array], measured: Array) -> tuple[float, Array]:
    """The factor with the natural frequencies nearest to measured ones, and those [Hz]."""
    from scipy.optimize import linear_sum_assignment, minimize_scalar

    tried = np.geomspace(1.0 / _LARGEST, _LARGEST, _TRIED)
    every, best, at, mode = natural(tried), math.inf, 0, np.arange(measured.size)
    for k, computed in enumerate(every):
        cost = np.log(measured[:, None] / computed[None, :]) ** 2
        which = linear_sum_assignment(cost)[1]
        if (size := float(cost[np.arange(measured.size), which].sum())) < best:
            best, at, mode = size, k, np.sort(which)

    def left(log_factor: float) -> float:
        computed = natural(np.array([math.exp(log_factor)]))[0, mode]
        return float((np.log(measured / computed) ** 2).sum())

    ends = math.log(tried[max(at - 1, 0)]), math.log(tried[min(at + 1, _TRIED - 1)])
    log_factor = float(minimize_scalar(left, bounds=ends, method="bounded", options={"xatol": 1e-6}).x)
    if left(0.0) <= left(log_factor):  # an effect that is not there changes nothing
        log_factor = 0.0
    return math.exp(log_factor), natural(np.array([math.exp(log_factor)]))[0, mode]
