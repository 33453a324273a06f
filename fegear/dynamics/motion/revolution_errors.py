"""Estimated errors of a motion over a revolution: the same motion with softer teeth and coarser steps beside it.

All teeth are softer by the estimated error of their compliance, and steps are found at a lower tolerance: what that
changes is taken for the error. A curve takes the largest change within half a base pitch on either side, since the
changes of a vibration pass through zero. Maxima between samples count by what half of the samples miss.
"""

from __future__ import annotations

from dataclasses import astuple, replace
from typing import TYPE_CHECKING

import numpy as np
from scipy.ndimage import maximum_filter1d

from fegear.contact.plane.sidebands import ConditionIndicators, indicators_of
from fegear.dynamics.motion.motion_over_revolution import MotionOverRevolution, RevolutionErrors
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.base.arrays import Array
    from fegear.dynamics.motion.motion_model import MotionModel

#: Tolerance of the motion beside over that of the motion.
COARSER = 10.0
#: Of every condition indicator: how its relative error goes with that of the odd teeth (see `indicator_errors`).
_BY_OWN = np.array([1.0, 1.0, 0.0, 1.0, 2.0, 0.0, 0.0])


def softer(model: MotionModel, compliances: Sequence[float]) -> MotionModel:
    """The model with the teeth of each mesh softer by a relative error of their compliance."""
    parts = zip(model.excitations, compliances, strict=True)
    return replace(model, excitations=tuple(one.widened(1.0 / (1.0 + part)) for one, part in parts))


def revolution_errors(
    found: MotionOverRevolution, beside: MotionOverRevolution, own: float, tolerance: float
) -> RevolutionErrors:
    """Estimated errors.

    Parameters
    ----------
    found, beside : MotionOverRevolution
        The motion, and that with softer teeth and coarser steps, at the same samples.
    own : float
        Relative error of what odd teeth change.
    tolerance : float
        Of the motion, relative to the largest value.
    """
    samples = found.te.size // found.cycles

    def curve(key: str, part: float = 0.0) -> Array:
        here, there = getattr(found, key), getattr(beside, key)
        change = np.maximum(np.abs(there - here), part * np.abs(here))
        return np.asarray(maximum_filter1d(change, samples + 1, mode="wrap") + tolerance * np.abs(here).max())

    def orders(key: str) -> Array:
        here, there = getattr(found.orders, key), getattr(beside.orders, key)
        # lines of a transient share its error: no less than their neighbours between two mesh harmonics
        change = maximum_filter1d(np.abs(there - here), found.cycles + 1, mode="nearest")
        return np.asarray(change + tolerance * here.max())

    def largest(key: str, values: Array, part: float = 0.0) -> float:
        here, there = getattr(found, key), getattr(beside, key)
        return max(abs(there - here), part * here) + _between(values) + tolerance * float(values.max())

    return RevolutionErrors(
        curve("te"), curve("te_residual", own), curve("te_change", own), curve("force"), curve("acceleration"),
        orders("te"), orders("force"), orders("acceleration"),
        largest("mesh_force_max", found.fine_force),
        largest("mesh_force_max_ordinary", np.median(found.fine_force.reshape(found.cycles, -1), axis=0)),
        largest("dynamic_te_change_max", found.fine_change, own),
        largest("dynamic_te_residual_max", found.fine_residual, own),
        _of_indicators(found, beside, own),
    )  # fmt: skip


def _between(values: Array) -> float:
    """By how much the maximum of a curve may lie above its largest sample: what half of the samples miss of it."""
    return float(values.max() - min(values[0::2].max(), values[1::2].max()))


def _of_indicators(found: MotionOverRevolution, beside: MotionOverRevolution, own: float) -> ConditionIndicators:
    """What softer teeth and half of the samples change; no less than by the error of the odd teeth alone."""
    teeth = [found.pair.gear(member).teeth for member in MEMBERS]
    here, there, half = (
        np.array(astuple(one))
        for one in (found.indicators, beside.indicators, indicators_of(found.te[::2], found.cycles, teeth))
    )
    off = np.maximum(np.abs(there - here) + np.abs(half - here), own * _BY_OWN * here)
    return ConditionIndicators(*off.tolist())
