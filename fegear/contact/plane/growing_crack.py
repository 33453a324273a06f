"""A crack that grows under the loads of its tooth in mesh: path, stress intensity, stiffness and cycles, in SI."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.base.shown import shown
from fegear.fem.plane.odd.growth import End, equivalent, grow
from fegear.formulas.paris import ParisLaw, cycles_to, length_at

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.fem.plane.odd.crack import Crack
    from fegear.geometry.gear import Gear


@dataclass(frozen=True)
class GrowingCrack:
    """A crack step by step; the first row is the crack of the case.

    Attributes
    ----------
    crack : Crack
        With all its pieces [modules].
    path : ndarray, shape (2, n)
        Mouth, corners and tip in the frame of its tooth [m].
    end : {"tooth", "rim"}
        What it breaks off, or heads for.
    stopped : {"surface", "steps", "closed"}
        Why it was followed no further.
    fracture : float or None
        Length at which the toughness is reached [m].
    """

    crack: Crack
    path: Array
    end: End
    stopped: Literal["surface", "steps", "closed"]
    fracture: float | None
    length: Array = shown("mm", "length of the crack", label="length of the crack", table="path")
    x: Array = shown("mm", "crack tip, from the tooth centre line towards the loaded flank", table="path")
    y: Array = shown("mm", "crack tip, from the gear axis along the tooth centre line", table="path")
    k_1: Array = shown(
        "MPa.m^(1/2)", "maximum stress intensity factor K_I at the nominal load", name="K_I",
        label="stress intensity", table="path",
    )  # fmt: skip
    k_2: Array = shown("MPa.m^(1/2)", "stress intensity factor K_II at that load", name="K_II", table="path")
    turn: Array = shown("deg", "change of direction after this step, positive to the left", table="path")
    load_radius: Array = shown("mm", "radius of the load that opens the crack most", table="path")
    stiffness: Array = shown(
        "N/(mm.um)", "stiffness of the tooth per face width, load at one radius", label="stiffness", table="path"
    )
    stiffness_loss: Array = shown(
        "%", "loss of stiffness since the first step", label="loss of stiffness", table="path"
    )
    tip_error: Array = shown("mm", "estimated error of the crack tip beside its path", table="path")
    growth_rate: Array | None = shown("mm", "mean growth per load cycle", table="path", default=None)
    cycles: Array | None = shown("", "load cycles", label="load cycles", table="path", default=None)
    closed: Array | None = shown("%", "share of the crack faces in contact", table="path", default=None)
    k_1_error: Array | None = None
    k_2_error: Array | None = None
    stiffness_error: Array | None = None
    cycles_error: Array | None = None

    @property
    def cycles_to_fracture(self) -> float | None:
        """Load cycles to the toughness, or to the last step where it is not reached."""
        return self._to_fracture(self.cycles)

    @property
    def cycles_to_fracture_error(self) -> float | None:
        """Estimated error of it by those of K; None where the crack may stop."""
        error = self._to_fracture(self.cycles_error)
        return error if error is not None and math.isfinite(error) else None

    def _to_fracture(self, cycles: Array | None) -> float | None:
        if cycles is None:
            return None
        if self.fracture is None:
            return float(cycles[-1])
        return float(np.interp(self.fracture, self.length, cycles))


def growing_crack(
    gear: Gear,
    crack: Crack,
    loads: tuple[Array, Array],
    *,
    step: float,
    steps: int,
    law: ParisLaw | None = None,
    toughness: float | None = None,
    factors: Sequence[float] = (1.0,),
    shares: Sequence[float] = (1.0,),
) -> GrowingCrack:
    """Follow a crack of a gear's tooth.

    Parameters
    ----------
    gear : Gear
    crack : Crack
        [modules].
    loads : (ndarray, ndarray), shape (P,) each
        Radii on the flank of its tooth [m], and the line load there [N/m].
    step : float
        [m].
    steps : int
    law : ParisLaw, optional
    toughness : float, optional
        [Pa m^(1/2)].
    factors, shares : sequence of float
        A spectrum, as of `ParisLaw.rate`.
    """
    m, radius, force = gear.module, loads[0] / gear.module, loads[1]
    found = grow(
        gear.symmetric_tooth, gear.bore_radius / m, gear.material.poisson_ratio, gear.plane_assumption, crack,
        (radius, force), step=step / m, steps=steps, support=gear.support_in_modules,
    )  # fmt: skip
    length, corners = found.length * m, found.path[:, -found.length.size :]
    k_1, k_2 = found.k_1 / math.sqrt(m), found.k_2 / math.sqrt(m)
    opened = equivalent(found.k_1, found.k_2) / math.sqrt(m)
    stiffness = gear.material.young_modulus / found.compliance
    rate = None if law is None else law.rate(opened, factors, shares)
    fracture = None if toughness is None else length_at(length, opened * max(factors), toughness)
    # What the path is off by changes K_I; K_II is what turns the crack, and follows the elements only.
    off = (found.k_1_error + found.off_the_path) / math.sqrt(m)
    cycles, spread = None, None
    if law is not None and rate is not None:
        cycles = cycles_to(length, rate)
        slower, faster = (law.rate(np.maximum(opened + way * off, 0.0), factors, shares) for way in (-1.0, 1.0))
        with np.errstate(invalid="ignore"):  # where the crack stops either way
            spread = np.maximum(np.abs(cycles_to(length, slower) - cycles), np.abs(cycles_to(length, faster) - cycles))
        spread[np.isinf(cycles)] = math.inf
    return GrowingCrack(
        found.crack, found.path * m, found.end, found.stopped, fracture, length, corners[0] * m, corners[1] * m, k_1,
        k_2, found.turn, found.radius * m, stiffness, 1.0 - stiffness / stiffness[0], found.tip_error * m, rate, cycles,
        found.shut if crack.closing else None, off, found.k_2_error / math.sqrt(m),
        stiffness * found.compliance_error / found.compliance, spread,
    )  # fmt: skip
