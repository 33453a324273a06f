"""A gear's influence functions as small tables of plain numbers, for processes that share many states of one pair."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.plane.fe_compliance import FiniteElementCompliance, chebyshev_over, roll_length
from fegear.contact.plane.spline import Spline
from fegear.fem.alike_teeth import AlikeTeeth

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.contact.plane.compliance import GearCompliance, RootStressInfluence, Side
    from fegear.fem.plane.root_stress import CutFillet, FilletCurve
    from fegear.geometry.gear import Gear


#: Radii at which root stress is tabulated, evenly in roll length; cubic between them.
_RADII = 129


@dataclass(frozen=True)
class ToothTable(AlikeTeeth):
    """What `FiniteElementCompliance` answers about deflections, without the finite elements.

    Parameters
    ----------
    gear : Gear
    own_spline : Spline
        c_0 at the reference half-width [m^2/N] over the roll length [m].
    neighbours : mapping of int to ndarray
        Chebyshev coefficients of c_k(p, q) by k.
    lowest, highest : float
        Roll lengths of the ends of the flank [m].
    half_width : float
        The reference [m].
    log_slope : float
        kappa [m^2/N].
    reach : int
    tip_wedge : tuple of float
        As the source has it.
    """

    gear: Gear
    own_spline: Spline
    neighbours: Mapping[int, Array]
    lowest: float
    highest: float
    half_width: float
    log_slope: float
    reach: int
    tip_wedge: tuple[float, float]

    kinks = ()
    power = 0.0
    remarks = ()

    @classmethod
    def of(cls, source: FiniteElementCompliance) -> ToothTable:
        """Take the tables of a source."""
        half_width = float(source.reference_half_width(np.zeros(1))[0])
        return cls(
            source.influence.gear, source.own_spline, dict(source.neighbours), source.lowest, source.highest,
            half_width, source.log_slope, source.reach, source.tip_wedge,
        )  # fmt: skip

    def own(self, i: int, radius: ArrayLike) -> Array:  # noqa: ARG002  (all alike)
        """c_0 at the reference half-width [m^2/N]."""
        return np.asarray(self.own_spline(roll_length(self.gear, radius, self.lowest, self.highest)))

    def reference_half_width(self, radius: ArrayLike) -> Array:
        """The half-width that `own` is for [m]."""
        return np.full(np.shape(radius), self.half_width)

    def between(self, i: int, j: int, radius_p: ArrayLike, radius_q: ArrayLike) -> Array:
        """c_k(p, q), k = i - j, zero beyond the reach."""
        if abs(k := i - j) > self.reach:
            return np.zeros(np.broadcast_shapes(np.shape(radius_p), np.shape(radius_q)))
        ends = self.lowest, self.highest
        p, q = (roll_length(self.gear, r, *ends) for r in (radius_p, radius_q))
        return chebyshev_over(*ends, p, q, self.neighbours[k])

    def root_stress(self, i: int, j: int, radius_q: ArrayLike, side: Side) -> Array | None:  # noqa: ARG002  (as of every source)
        """Unknown: see `RootTable`."""
        return None

    def fillet_curve(self, i: int, side: Side) -> FilletCurve | CutFillet | None:  # noqa: ARG002  (the interface)
        """Unknown."""
        return None

    def root_stress_error(self, i: int, j: int, radius_q: ArrayLike, side: Side = "tension") -> Array:  # noqa: ARG002  (as of every source)
        """Unknown."""
        return np.full(np.shape(radius_q), np.nan)

    def describe(self) -> str:
        """Return what it is."""
        return "tables of finite elements"


def light(source: GearCompliance) -> GearCompliance:
    """The same compliances without the finite elements behind them; other sources as they are."""
    return ToothTable.of(source) if isinstance(source, FiniteElementCompliance) else source


@dataclass(frozen=True)
class RootTable(AlikeTeeth):
    """Root tension of one gear's teeth over the flank, below the loaded flank: a source of plain numbers.

    Parameters
    ----------
    base_radius : float
        [m].
    lowest, step : float
        Roll length of the first entry and distance of the next [m].
    tension : mapping of int to ndarray, shape (N, points)
        Stress along the fillet of tooth k per unit line load on tooth 0 [1/m], by k.
    curve : FilletCurve, CutFillet or None
        How its largest value is found.
    remarks : tuple of str
        Of the source.
    """

    base_radius: float
    lowest: float
    step: float
    tension: Mapping[int, Array]
    curve: FilletCurve | CutFillet | None
    remarks: tuple[str, ...] = ()

    @property
    def reach(self) -> int:
        """Teeth on either side that a load is felt by."""
        return max(self.tension)

    def at(self, k: int, radius: Array) -> Array:
        """Stress along the fillet of tooth k, shape (*radius, points) [1/m]: cubic through four entries."""
        table = self.tension[k]
        length = np.sqrt(np.maximum((radius - self.base_radius) * (radius + self.base_radius), 0.0))
        t = np.clip((length - self.lowest) / self.step, 0.0, table.shape[0] - 1.0)
        i = np.clip(t.astype(np.intp) - 1, 0, table.shape[0] - 4)
        s = (t - i)[..., None]
        a, b, c = s - 1.0, s - 2.0, s - 3.0
        return np.asarray(
            table[i] * (-a * b * c / 6.0) + table[i + 1] * (s * b * c / 2.0)
            - table[i + 2] * (s * a * c / 2.0) + table[i + 3] * (s * a * b / 6.0)
        )  # fmt: skip

    def root_stress(self, i: int, j: int, radius_q: ArrayLike, side: Side) -> Array | None:
        """Stress along the fillet of tooth i under a load on tooth j, (points, Q) [1/m]; None for the other fillet."""
        if side == "compression":
            return None
        radius = np.atleast_1d(np.asarray(radius_q, dtype=float))
        return self.at(i - j, radius).T if i - j in self.tension else np.zeros((self.tension[0].shape[1], radius.size))

    def fillet_curve(self, i: int, side: Side) -> FilletCurve | CutFillet | None:  # noqa: ARG002  (all alike)
        """As of the source; None for the other fillet."""
        return self.curve if side == "tension" else None

    def root_stress_error(self, i: int, j: int, radius_q: ArrayLike, side: Side = "tension") -> Array:  # noqa: ARG002  (as of every source)
        """Unknown."""
        return np.full(np.shape(radius_q), np.nan)


def root_table(source: RootStressInfluence, gear: Gear, lowest: float, highest: float, *, coupled: bool) -> RootTable:
    """Tabulate the root tension of a gear between two radii of its flank.

    Parameters
    ----------
    source : RootStressInfluence
        That knows root stress.
    gear : Gear
    lowest, highest : float
        Radii [m].
    coupled : bool
        Whether the loads of neighbouring teeth are felt.
    """
    rb = gear.base_radius
    low, high = (math.sqrt(max((r - rb) * (r + rb), 0.0)) for r in (lowest, highest))
    lengths = np.linspace(low, high, _RADII)
    radii = np.clip(np.hypot(rb, lengths), lowest, highest)
    reach = source.reach if coupled else 0
    found = {}
    for k in range(-reach, reach + 1):
        kernel = source.root_stress(k, 0, radii, "tension")
        if kernel is not None:
            found[k] = np.ascontiguousarray(kernel.T)
    return RootTable(rb, low, (high - low) / (_RADII - 1), found, source.fillet_curve(0, "tension"))
