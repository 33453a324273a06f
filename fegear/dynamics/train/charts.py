"""Design charts of TM-89901: largest dynamic factor over a range of speeds, against amount and length of relief.

The four-inertia model: motor, two gears, load, two shafts (TM-100180, Eqs. 1 to 4; TM-89901).
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, fields, replace
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array
from fegear.base.errors import InputError, RangeError
from fegear.base.shown import shown
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.steady_state import SteadyState, speed_sweep
from fegear.dynamics.train.excitation import MeshExcitation, effective_error
from fegear.dynamics.train.train import Body, DampingLaw, Mesh, Shaft, Torque, Train, mesh_damping, shaft_damping

Direction = Literal["up", "down", "static", "rest"]


@dataclass(frozen=True)
class SpeedChart:
    """Dynamic factor of a gear pair against speed, in increasing order of speed.

    Arrays of shape (n,). Quantiles are those of the largest force on one tooth pair in a period; of a motion that
    repeats they are the dynamic factor itself. Kinds are those of `SteadyState`.
    """

    speeds: Array = shown("rpm", "speed of the first body", name="speed")
    dynamic_factor: Array = shown("", "maximum tooth pair force / mean mesh force")
    mesh_force_factor: Array = shown("", "maximum mesh force / mean mesh force")
    apart: Array = shown("", "fraction of time without contact", name="contact_loss_fraction")
    behind: Array = shown("", "fraction of time with back-side contact", name="backside_fraction")
    periods: NDArray[np.int64] = shown("", "period of the motion in excitation periods; 0: not periodic")
    kinds: tuple[str, ...] = shown(
        "", "periodic (stable), quasi-periodic, chaotic, long-period, unstable, not settled, or growing (unbounded)",
        name="motion",
    )  # fmt: skip
    median: Array = shown("", "dynamic factor, median over the periods", name="median_factor")
    upper: Array = shown("", "dynamic factor, 99th percentile over the periods", name="factor_99_percent")
    measured: NDArray[np.int64] = shown("", "number of excitation periods evaluated", name="periods_measured")
    multiplier: Array = shown("", "largest Floquet multiplier over one excitation period; above 1: unstable")
    lower: Array = shown("", "minimum over the periods of the dynamic factor", name="smallest_factor")
    repetitions: NDArray[np.int64] = shown("", "number of periods of the averaging iteration")
    difference: Array = shown(
        "",
        "difference between start and end of the last period, relative to the static deflection",
        name="left_difference",
    )
    off: Array = shown("", "residual of the averaging iteration in the dynamic factor")

    @classmethod
    def of(cls, speeds: Array, states: Sequence[SteadyState], mesh: int, mean: float) -> SpeedChart:
        """One mesh of steady motions at speeds [rad/s], over its mean force [N]."""
        return cls(
            speeds,
            np.array([s.tooth_force[mesh] for s in states]) / mean,
            np.array([s.largest[mesh] for s in states]) / mean,
            np.array([s.apart[mesh] for s in states]),
            np.array([s.behind[mesh] for s in states]),
            np.array([s.periods for s in states], dtype=np.int64),
            tuple(s.kind for s in states),
            np.array([s.quantile(0.5)[mesh] for s in states]) / mean,
            np.array([s.quantile(0.99)[mesh] for s in states]) / mean,
            np.array([s.measured for s in states], dtype=np.int64),
            np.array([s.multiplier for s in states]),
            np.array([s.quantile(0.0)[mesh] for s in states]) / mean,
            np.array([s.followed for s in states], dtype=np.int64),
            np.array([s.residual for s in states]),
            np.array([s.off for s in states]),
        )

    @classmethod
    def linear(cls, speeds: Array, dynamic_factor: Array, mesh_force_factor: Array) -> SpeedChart:
        """Factors of a linear train whose teeth never part: periodic at every speed."""
        none, one = np.zeros(speeds.size), np.ones(speeds.size, dtype=np.int64)
        kinds = ("periodic",) * speeds.size
        return cls(
            speeds, dynamic_factor, mesh_force_factor, none, none.copy(), one, kinds, dynamic_factor, dynamic_factor,
            one.copy(), np.full(speeds.size, np.nan), dynamic_factor, 0 * one, none.copy(), none.copy(),
        )  # fmt: skip

    @property
    def growing(self) -> NDArray[np.bool_]:
        """Speeds at which the motion grows without bound."""
        return np.array([kind == "growing" for kind in self.kinds], dtype=bool)

    def at(self, which: NDArray[np.bool_]) -> SpeedChart:
        """Only some of the speeds."""
        picked = {f.name: getattr(self, f.name)[which] for f in fields(self) if f.name != "kinds"}
        return replace(self, **picked, kinds=tuple(np.array(self.kinds)[which].tolist()))

    @property
    def worst(self) -> tuple[float, float]:
        """Largest dynamic factor, infinite where a motion grows, and the speed [rad/s] at which it occurs."""
        index = int(np.argmax(self.dynamic_factor))
        return float(self.dynamic_factor[index]), float(self.speeds[index])


def speed_chart(
    model: MotionModel,
    speeds: ArrayLike,
    *,
    mesh: int = 0,
    direction: Direction = "down",
    tolerance: float = 5e-4,
) -> SpeedChart:
    """Dynamic factor against speed.

    Parameters
    ----------
    model : MotionModel
        What moves; its own speed is not used.
    speeds : array_like
        Speeds of the first body [rad/s].
    mesh : int
        Gear pair looked at.
    direction : {"up", "down", "static", "rest"}
        Sweeping (each speed starts from the one before), or every speed afresh from the static state or from rest.
        A pair that loses contact keeps its large motion when speed falls, so that "down" finds the larger factors.
    tolerance : float
        Accuracy of the dynamic factor.
    """
    speed = np.sort(np.atleast_1d(np.asarray(speeds, dtype=float)))
    if direction not in ("up", "down", "static", "rest"):
        raise InputError("direction", direction, 'must be "up", "down", "static" or "rest"')
    if not model.static[mesh] > 0.0:
        raise RangeError(
            "dynamic factor", f"{float(model.static[mesh]):.6g} N", "is the mean force: must be positive",
            "use the forces of `speed_sweep` for an idling gear pair",
        )  # fmt: skip
    order = speed[::-1] if direction == "down" else speed
    start = "follow" if direction in ("up", "down") else direction
    states: tuple[SteadyState, ...] = speed_sweep(model, order, start=start, tolerance=tolerance)
    if direction == "down":
        states = states[::-1]
    return SpeedChart.of(speed, states, mesh, float(model.static[mesh]))


@dataclass(frozen=True)
class ChartPoint:
    """One point of a design chart: largest factors over the speeds, where [rad/s], and the effective error [m]."""

    dynamic_factor: float
    mesh_force_factor: float
    speed: float
    effective_error: float
    lost_contact: bool
    unsteady_speeds: int


def chart_point(
    system: FourInertia,
    excitation: MeshExcitation,
    speeds: ArrayLike,
    *,
    direction: Direction = "down",
    tolerance: float = 5e-4,
) -> ChartPoint:
    """Largest dynamic factor of the four-inertia model over a range of speeds, beside the effective error A_e.

    The mesh damping follows the mean stiffness of the gear pair (1 over its mean compliance).
    """
    train = system.train(1.0 / excitation.mean_compliance())
    chart = speed_chart(MotionModel(train, (excitation,), 1.0), speeds, direction=direction, tolerance=tolerance)
    worst, where = chart.worst
    error = excitation.transmission_error(system.force, tolerance=1e-8)
    return ChartPoint(
        worst,
        float(np.max(chart.mesh_force_factor)),
        where,
        effective_error(error),
        bool(np.any(chart.apart > 0.0)),
        int(np.count_nonzero(chart.periods == 0)),
    )


@dataclass(frozen=True)
class FourInertia:
    """Motor, shaft, gear 1, gear 2, shaft, load; angles as they run, so that the approach is R1 a1 - R2 a2.

    Parameters
    ----------
    motor, gear_1, gear_2, load : float
        Inertias [kg m^2].
    shaft_1, shaft_2 : float
        Shaft stiffnesses [N m/rad].
    base_radius_1, base_radius_2 : float
        Base radii [m].
    teeth_1, teeth_2 : int
        Tooth numbers.
    force : float
        Mean mesh force along the line of action [N].
    shaft_ratio, mesh_ratio : float
        Damping ratios of the shafts (14, 15) and of the gear pair (16), for the gears' own inertias as the report
        has it, whatever the shafts: stiff ones tend to rigid ones.
    backlash : float
        Backlash along the line of action [m].
    damping_law : {"constant", "momentary"}
        Mesh damping from the mean stiffness, or, as the report writes it, from that of the teeth that touch.
    """

    motor: float
    gear_1: float
    gear_2: float
    load: float
    shaft_1: float
    shaft_2: float
    base_radius_1: float
    base_radius_2: float
    teeth_1: int
    teeth_2: int
    force: float
    shaft_ratio: float = 0.005
    mesh_ratio: float = 0.1
    backlash: float = math.inf
    damping_law: DampingLaw = "constant"

    def train(self, mesh_stiffness: float) -> Train:
        """The model as a train, for a mean mesh stiffness [N/m]."""
        r1, r2 = self.base_radius_1, self.base_radius_2
        damping = mesh_damping(self.mesh_ratio, mesh_stiffness, r1, r2, self.gear_1, self.gear_2)

        def damp(stiffness: float, a: float, b: float) -> float:
            return shaft_damping(self.shaft_ratio, stiffness, a, b) if math.isfinite(stiffness) else 0.0

        pair = Mesh(
            "pair", "gear 1", "gear 2", r1, -r2, self.teeth_1, self.teeth_2, mesh_stiffness, damping, self.backlash,
            self.damping_law,
        )  # fmt: skip
        return Train(
            bodies=(
                Body("motor", self.motor),
                Body("gear 1", self.gear_1),
                Body("gear 2", self.gear_2),
                Body("load", self.load),
            ),
            shafts=(
                Shaft("shaft 1", "motor", "gear 1", self.shaft_1, damp(self.shaft_1, self.motor, self.gear_1)),
                Shaft("shaft 2", "gear 2", "load", self.shaft_2, damp(self.shaft_2, self.gear_2, self.load)),
            ),
            meshes=(pair,),
            torques=(Torque("motor", self.force * r1), Torque("load", -self.force * r2)),
        )  # fmt: skip


def linear_tip_relief(x: ArrayLike, tip: float, start: float, amount: float) -> Array:
    """Linear relief [m] at positions x [m]: zero up to `start`, `amount` at `tip`; the tip may lie on either side."""
    if tip == start:
        raise RangeError("relief length", 0.0, "must not be zero", "set the amount to zero instead")
    share = (np.asarray(x, dtype=float) - start) / (tip - start)
    found: Array = amount * np.clip(share, 0.0, None)
    return found


def relief_start(tip: float, single_contact: float, length: float) -> float:
    """Position x [m] where relief of length L_n starts: L_n = 1 runs from the tip to the HPSTC (TM-89901)."""
    return tip - length * (tip - single_contact)
