"""Strain under a gauge in a root fillet over the rotation of its gear, of plane (2D) and 3D teeth."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.shown import shown, shows
from fegear.contact.fitted_line import linear

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.contact.fitted_curve import FittedCurve
    from fegear.contact.fitted_line import Fitted
    from fegear.fem.plane.influence import Side
    from fegear.geometry.pair import GearPair, Member


def reach_of_places(peaks: Array, peak: float) -> tuple[float, float]:
    """How far below and above a peak, in size, those at other places of the grid are; neither is negative.

    Parameters
    ----------
    peaks : ndarray, shape (G,)
        At all places, of the sign of the peak.
    peak : float
    """
    change = np.sign(peak) * (peaks - peak)
    return max(-float(change.min()), 0.0), max(float(change.max()), 0.0)


def gains_of_places(found: FittedCurve, angle: Array, displaced: Array) -> Array:
    """Measured / computed strain that grids at other places would give, by the least squares of a trace, shape (G,).

    A displaced grid changes the curve as a whole, not only its peak: with the peak's change a grid within its
    tolerance was said to disagree.

    Parameters
    ----------
    found : FittedCurve
        The trace beside the strain computed where the grid should be.
    angle : ndarray, shape (P,)
        Rotation of the gear, ascending [rad].
    displaced : ndarray, shape (P, G)
        Strain computed at each place.
    """
    free: tuple[Fitted, ...] = ("offset", "scale") if "offset" in found.fit else ("scale",)
    still = np.zeros(found.samples)
    return np.array(
        [linear(found.computed, np.interp(found.angle, angle, one), still, free).scale for one in displaced.T]
    )


def at_positions(x: Array, known: Array, values: Array) -> Array:
    """Values along straight lines between the positions at which they are known, the first axis of any shape.

    Parameters
    ----------
    x : ndarray, shape (P,)
    known : ndarray, shape (Q,)
        Ascending.
    values : ndarray, shape (Q, ...)
    """
    flat = values.reshape(known.size, -1)
    found = np.stack([np.interp(x, known, one) for one in flat.T], axis=-1)
    return np.asarray(found.reshape(x.size, *values.shape[1:]))


@dataclass(frozen=True)
class StrainWith:
    """What a gauge sees at the nominal load with one effect more.

    Parameters
    ----------
    change : float
        Of the peak, relative.
    angle, strain : ndarray, shape (P,)
        Rotation of the gear as in `GaugeHistory` [rad], and mean strain under the grid.
    """

    change: float
    angle: Array
    strain: Array

    def less(self, second: StrainWith, before: float) -> StrainWith:
        """Of a half bridge with a second gauge in the adjacent arm, of which the peak without the effect is given."""
        strain = self.strain - at_positions(self.angle, second.angle, second.strain)
        return StrainWith(float(np.abs(strain).max()) / abs(before) - 1.0, self.angle, strain)


@dataclass(frozen=True)
class GaugeHistory:
    """What a gauge sees; strains in its direction, arrays over P positions of its tooth and L loads.

    Parameters
    ----------
    pair : GearPair
    member : {"driver", "driven"}
    side : {"tension", "compression"}
    sense : float
        1 where the peak is the largest strain, -1 where it is the smallest one: of the compression fillet, and across
        the profile.
    known_error, stress_error : ndarray, shape (P, L)
        Estimated errors; NaN if unknown.
    displaced : ndarray, shape (P, L, G)
        Mean strain of grids that are glued elsewhere.
    strain_opposite : ndarray, shape (P, L)
        Of a like gauge in the other fillet of the tooth.
    x : ndarray, shape (P,)
        Position of the tooth's contact, at mid-face [m].
    strain : ndarray, shape (P, L)
    stress : ndarray, shape (P, L)
        Mean tangential stress under the grid [Pa].
    displacement : ndarray, shape (G,)
        Of grids that are glued elsewhere along the fillet, towards the tip [m]; zero is among them.
    """

    pair: GearPair
    member: Member
    side: Side
    sense: float
    known_error: Array
    stress_error: Array
    displaced: Array
    x: Array = shown("mm", "position of the tooth's contact on the line of action", table="gauge")
    strain: Array = shown("um/m", "mean strain under the grid", label="strain", table="gauge")
    strain_opposite: Array = shown(
        "um/m", "strain of an equal gauge in the opposite fillet of the tooth", table="gauge"
    )
    stress: Array = shown("MPa", "mean tangential stress under the grid")
    displacement: Array = shown("mm", "displacement of the grid along the fillet towards the tip")

    @property
    @shows(
        "deg", "rotation of the gear, zero with its tooth in contact at the pitch point", label="rotation of the gear",
        table="gauge",
    )  # fmt: skip
    def angle(self) -> Array:
        """Of the gear of the gauge, in the sense of its rotation [rad], shape (P,)."""
        return self.x / self.pair.gear(self.member).base_radius

    @property
    @shows("deg", "roll angle of the contact point on the gear of the gauge", table="gauge")
    def roll_angle(self) -> Array:
        """[rad], shape (P,)."""
        return self.pair.roll_angle(self.x, self.member)

    @property
    def strain_error(self) -> Array | None:
        """Estimated, shape (P, L); None where it is not known."""
        return None if np.isnan(self.known_error).any() else self.known_error

    @property
    @shows("um/m", "strain with the grid displaced towards the root by placement_tolerance", table="gauge")
    def strain_towards_root(self) -> Array | None:
        """Shape (P, L); None without a tolerance."""
        return self._of_end(0)

    @property
    @shows("um/m", "strain with the grid displaced towards the tip by placement_tolerance", table="gauge")
    def strain_towards_tip(self) -> Array | None:
        """Shape (P, L); None without a tolerance."""
        return self._of_end(-1)

    def _of_end(self, end: int) -> Array | None:
        return None if self.displacement.size == 1 else self.displaced[:, :, end]

    def peak_position(self, i: int) -> int:
        """Position of the peak under load number i."""
        return int(np.argmax(self.sense * self.strain[:, i]))

    def peak_of_places(self, i: int) -> Array:
        """Peak strain at every displacement under load number i, shape (G,)."""
        return np.asarray(self.sense * (self.sense * self.displaced[:, i]).max(axis=0))

    @property
    def peak_opposite(self) -> Array:
        """Peak strain of the gauge in the other fillet under every load, shape (L,)."""
        return np.asarray(-self.sense * (-self.sense * self.strain_opposite).max(axis=0))

    def less(self, second: GaugeHistory) -> GaugeHistory:
        """What a half bridge sees that has a second gauge of the tooth in the adjacent arm: the difference of strains.

        Errors add, since both may be off to opposite sides. Displaced is the grid of the first gauge.
        """
        strain = self.strain - self._at_own(second.x, second.strain)
        return replace(
            self, sense=1.0 if strain.flat[int(np.abs(strain).argmax())] >= 0.0 else -1.0, strain=strain,
            known_error=self.known_error + self._at_own(second.x, second.known_error),
            stress_error=self.stress_error + self._at_own(second.x, second.stress_error),
            displaced=self.displaced - (self.strain - strain)[:, :, None],
            strain_opposite=self.strain_opposite - self._at_own(second.x, second.strain_opposite),
            stress=self.stress - self._at_own(second.x, second.stress),
        )  # fmt: skip

    def less_displaced(self, second: GaugeHistory, i: int) -> Array:
        """The same under load number i with the grid of the second gauge displaced, shape (P, G)."""
        return self.strain[:, i, None] - self._at_own(second.x, second.displaced[:, i])

    def _at_own(self, x: Array, values: Array) -> Array:
        """What is known at other positions."""
        return at_positions(self.x, x, values)
