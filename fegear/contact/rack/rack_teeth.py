"""A solved rack as a source of compliance and root stress, each tooth by its number, in SI.

It answers as gears do (`GearCompliance`); a place on the flank is a height above the reference line. Teeth that stand
alike are tabulated once, when they are first asked for.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.plane.coupled_teeth import CoupledTeeth
from fegear.contact.plane.spline import Spline, spline
from fegear.fem.plane.contact_width import REFERENCE_HALF_WIDTH, corner_angles, wedge_slope

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.contact.plane.compliance import GearCompliance, Side
    from fegear.contact.plane.coupled_teeth import Hertz
    from fegear.fem.plane.rack.solved_rack import SolvedRack
    from fegear.fem.plane.root_stress import FilletCurve
    from fegear.geometry.rack_and_pinion import RackAndPinion
    from fegear.geometry.toothed_rack import Rack

#: Half-width that c_0 is given for [modules], as of gears.
_NOMINAL = 0.08
#: Points over the flank, half of them in the last tenth of a module below the tip.
_POINTS = 97
_COUPLING_POINTS = 14


@dataclass(frozen=True)
class RackTeeth:
    """Influence functions of a rack's teeth in SI.

    Parameters
    ----------
    rack : Rack
    solved : SolvedRack
    patch : float
        Half-width of the wider pressure that loads the mesh [modules].
    """

    rack: Rack
    solved: SolvedRack
    patch: float

    power = 0.0
    kinks = ()
    remarks = ()

    @cached_property
    def _own(self) -> dict[int, Spline]:
        """Tabulated c_0, by the first tooth that stands as asked."""
        return {}

    @cached_property
    def _beside(self) -> dict[tuple[int, int], Array]:
        """Series of c_k, by the loaded tooth and k."""
        return {}

    @cached_property
    def _runs(self) -> dict[tuple[int, ...], int]:
        """First of successive teeth, by how these stand."""
        return {}

    @property
    def reach(self) -> int:
        """Neighbours that a tooth is coupled to."""
        return self.solved.reach

    @property
    def period(self) -> int:
        """Teeth after which answers repeat: never before the end."""
        return self.rack.teeth

    def exists(self, i: int) -> bool:
        """Whether the rack has a tooth of this number."""
        return 0 <= i < self.rack.teeth

    def same_as(self, first: int, count: int) -> int:
        """First of so many successive teeth that answer as those from `first` on; beyond an end none are alike."""
        if not (self.exists(first) and self.exists(first + count - 1)):
            return first
        return self._runs.setdefault(self.solved.alike[first : first + count], first)

    @property
    def log_slope(self) -> float:
        """kappa [m^2/N]."""
        return self.solved.loaded(0).log_slope / self.rack.material.young_modulus

    @property
    def tip_wedge(self) -> tuple[float, float]:
        """As of gears."""
        angle = corner_angles(self.rack.tooth)[1]
        return 0.5 * math.pi * wedge_slope(angle) - 1.0, REFERENCE_HALF_WIDTH * self.rack.module

    def reference_half_width(self, radius: ArrayLike) -> Array:
        """The half-width that `own` is for [m]."""
        return np.full(np.shape(radius), _NOMINAL * self.rack.module)

    def _heights(self, radius: ArrayLike) -> Array:
        low, high = self.solved.flank.heights
        return np.clip(np.asarray(radius, dtype=float) / self.rack.module, low, high)

    def own(self, i: int, radius: ArrayLike) -> Array:
        """c_0 of tooth i at heights [m], for the reference half-width [m^2/N]."""
        i = self.solved.alike[i]
        if i not in self._own:
            low, high = self.solved.flank.heights
            corner = min(0.1, 0.3 * (high - low))
            s = np.linspace(0.0, 1.0, _POINTS // 2)
            below = low + (high - corner - low) * (s * s * (3.0 - 2.0 * s))
            y = np.concatenate([below[:-1], high - corner * (1.0 - s)])
            loaded = self.solved.loaded(i)
            c = loaded.self_compliance(y, self.patch, np.asarray(REFERENCE_HALF_WIDTH))
            self._own[i] = spline(y, c - loaded.log_slope * math.log(_NOMINAL / REFERENCE_HALF_WIDTH))
        return np.asarray(self._own[i](self._heights(radius)) / self.rack.material.young_modulus)

    def self_compliance(self, i: int, height: ArrayLike, half_width: ArrayLike) -> Array:
        """c_0 of tooth i at heights and half-widths [m], without tables [m^2/N]."""
        m = self.rack.module
        c = self.solved.loaded(i).self_compliance(
            np.asarray(height, dtype=float) / m, self.patch, np.asarray(half_width, dtype=float) / m
        )
        return np.asarray(c / self.rack.material.young_modulus)

    def between(self, i: int, j: int, radius_p: ArrayLike, radius_q: ArrayLike) -> Array:
        """Deflection of tooth i per unit line load on tooth j [m^2/N]; zero beyond the reach and the ends."""
        p, q = np.broadcast_arrays(self._heights(radius_p), self._heights(radius_q))
        k = i - j
        if abs(k) > self.reach or not (self.exists(i) and self.exists(j)):
            return np.zeros(p.shape)
        kept = self.solved.alike[j]
        if (kept, k) not in self._beside:
            self._beside[kept, k] = self._tabulated(kept, k)
        low, high = self.solved.flank.heights
        chebyshev = np.polynomial.chebyshev
        first, second = (2.0 * (at - low) / (high - low) - 1.0 for at in (p, q))
        found = chebyshev.chebval2d(first, second, self._beside[kept, k])
        return np.asarray(found / self.rack.material.young_modulus)

    def _tabulated(self, j: int, k: int) -> Array:
        low, high = self.solved.flank.heights
        t = np.cos(math.pi * (np.arange(_COUPLING_POINTS) + 0.5) / _COUPLING_POINTS)
        to_series = np.linalg.inv(np.polynomial.chebyshev.chebvander(t, _COUPLING_POINTS - 1))
        y = 0.5 * (low + high) + 0.5 * (high - low) * t
        return np.asarray(to_series @ self.solved.loaded(j).neighbour(k, y, y, self.patch) @ to_series.T)

    def root_stress(self, i: int, j: int, radius_q: ArrayLike, side: Side) -> Array | None:
        """Stress along a root rounding of tooth i per unit line load on tooth j [1/m], (points, Q)."""
        y, k = np.atleast_1d(self._heights(radius_q)), i - j
        if abs(k) > self.reach or not (self.exists(i) and self.exists(j)):
            return np.zeros((self.solved.fillets[side].arc.size, y.size))
        return self.solved.loaded(j).fillet_stress(k, side, y) / self.rack.module

    def fillet_curve(self, i: int, side: Side) -> FilletCurve | None:  # noqa: ARG002  (one for all)
        """How the largest stress is found between the points."""
        return self.solved.loaded(0).fillet_curve(side, self.rack.module)

    def root_stress_error(self, i: int, j: int, radius_q: ArrayLike, side: Side = "tension") -> Array:  # noqa: ARG002  (as of every source)
        """Not known of one load: errors over the stroke are found from two solutions."""
        return np.full(np.shape(radius_q), np.nan)

    def describe(self) -> str:
        """Return what it includes."""
        return f"FE of the rack ({self.rack.teeth} teeth), coupling to neighbours up to {self.reach} teeth away"


@dataclass(frozen=True)
class RackCompliance(CoupledTeeth):
    """Compliance of a pinion (driver) on a rack (driven), as `PairCompliance`.

    Parameters
    ----------
    pair : RackAndPinion
    driver : GearCompliance
        Of the pinion.
    driven : RackTeeth
    coupling, hertz, nominal_load
        As of `PairCompliance`.
    """

    pair: RackAndPinion
    driver: GearCompliance
    driven: RackTeeth
    coupling: bool = True
    hertz: Hertz = "load-dependent"
    nominal_load: float = math.nan

    @property
    def face_width(self) -> float:
        """Common face width [m]."""
        return self.pair.face_width

    @property
    def contact_modulus(self) -> float:
        """E* [Pa]."""
        return 1.0 / (1.0 / self.pair.pinion.plane_modulus + 1.0 / self.pair.rack.plane_modulus)

    @property
    def middle_of_path(self) -> float:
        """Before it the rack's tip is the nearer one [m]."""
        return 0.5 * (self.pair.x_start + self.pair.x_end)
