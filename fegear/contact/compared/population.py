"""Gears drawn evenly over ranges of their numbers, and where they are loaded: a population for a study of formulas."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear

#: Loads on every gear, one in each of as many equal parts of the range of load positions.
LOADS = 8

#: So many draws for one gear at most: ranges that hold fewer teeth are no population.
_DRAWS = 20


@dataclass(frozen=True, slots=True)
class Drawn:
    """A gear of a population.

    Parameters
    ----------
    gear : Gear
    load_position : tuple of float
        Shares of the roll angle between the involute's start (0) and end (1).
    """

    gear: Gear
    load_position: tuple[float, ...]


@dataclass(frozen=True, slots=True)
class Population:
    """What was drawn.

    Parameters
    ----------
    gears : tuple of Drawn
    tried : int
        Draws that it took: the others gave teeth that cannot be cut, pointed ones or none.
    """

    gears: tuple[Drawn, ...]
    tried: int


def drawn_gears(base: Gear, bounds: Mapping[str, tuple[float, float]], samples: int, seed: int = 0) -> Population:
    """Draw gears evenly (a scrambled Sobol sequence) over the part of a box in which teeth can be cut.

    Parameters
    ----------
    base : Gear
        What the box leaves open: module, addendum, tip shape, ratio of bore to root radius.
    bounds : mapping of str to (float, float)
        Lowest and highest ``teeth`` (drawn evenly in their logarithm), ``profile_shift``, ``rack_tip_radius``,
        ``rack_dedendum``, ``pressure_angle`` [rad] and ``load_position``; without one the base gear's own, and all of
        the involute.
    samples : int
    seed : int
        The same seed draws the same gears.

    Raises
    ------
    InputError
        If hardly any draw gives a tooth.
    """
    from scipy.stats import qmc

    t = base.external_tooth
    own = {
        "teeth": t.teeth, "profile_shift": t.profile_shift, "rack_tip_radius": t.rack.tip_radius,
        "rack_dedendum": t.rack.dedendum, "pressure_angle": t.rack.pressure_angle,
    }  # fmt: skip
    box = {**{k: (float(v), float(v)) for k, v in own.items()}, "load_position": (0.0, 1.0), **bounds}
    keys = list(own)
    sequence = qmc.Sobol(len(keys) + 1, seed=seed)
    found: list[Drawn] = []
    tried = 0
    while len(found) < samples and tried < _DRAWS * samples + 256:
        for u in sequence.random(64):
            tried += 1
            tooth = tooth_of(
                t, {k: _between(box[k], float(v), log=k == "teeth") for k, v in zip(keys, u, strict=False)}
            )
            if tooth is None:
                continue
            bore = base.bore_radius / base.root_radius * tooth.root_radius * base.module
            low, high = box["load_position"]
            at = low + (high - low) * (np.arange(LOADS) + u[-1]) / LOADS
            gear = Gear(tooth, base.module, bore, base.face_width, base.material, base.plane)
            found.append(Drawn(gear, tuple(at.tolist())))
            if len(found) == samples:
                break
    if len(found) < samples:
        raise InputError("study", f"{len(found)} of {tried} samples", "gave a feasible tooth", "choose narrower ranges")
    return Population(tuple(found), tried)


def share_error(hits: Array) -> float:
    """Standard error of a share over drawn gears, from its spread between them: loads of one gear are not independent.

    Where all gears say the same the next may be the first that does not: that is one of two more (Laplace).

    Parameters
    ----------
    hits : ndarray, shape (gears, loads)
        0 or 1.
    """
    each = np.asarray(hits, dtype=float).mean(axis=1)
    spread = each.std(ddof=1) / math.sqrt(each.size) if each.size > 1 else 0.5
    return math.hypot(float(spread), 1.0 / (each.size + 2.0))


def _between(bounds: tuple[float, float], share: float, *, log: bool) -> float:
    low, high = bounds
    return low * (high / low) ** share if log else low + share * (high - low)


def tooth_of(base: Tooth, drawn: Mapping[str, float]) -> Tooth | None:
    """The tooth of a draw, or None where there is none."""
    try:
        rack = replace(
            base.rack, tip_radius=drawn["rack_tip_radius"], dedendum=drawn["rack_dedendum"],
            pressure_angle=drawn["pressure_angle"],
        )  # fmt: skip
        return Tooth(
            round(drawn["teeth"]), rack, drawn["profile_shift"], thickness_allowance=base.thickness_allowance,
            tip_rounding=base.tip_rounding, tip_chamfer=base.tip_chamfer,
        )  # fmt: skip
    except InputError:
        return None


def unevenness(values: Array, low: Array, high: Array) -> float:
    """Largest miss of the share of points in any of the sixteenths of each coordinate's range: 0 is even.

    Parameters
    ----------
    values : ndarray, shape (N, D)
    low, high : ndarray, shape (D,)
    """
    counts = [np.histogram(v, 16, (a, b))[0] / v.size for v, a, b in zip(values.T, low, high, strict=True) if b > a]
    return max((float(np.abs(c * 16.0 - 1.0).max()) for c in counts), default=math.nan)
