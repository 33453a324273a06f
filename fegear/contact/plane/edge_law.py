"""Contact at the corner of a tip: what it adds to the approach of a Hertzian line contact.

Inward from the corner the surfaces part as theta s + s^2/(2R). Between two half-planes the contact then covers [0, c]
with the pressure (E*/2R) sqrt((c - s)/s) (s + c/2 + theta R), load (pi E*/4)(theta c + 3 c^2/(4R)), and moves at the
corner as a Hertzian contact of half-width (c/2) exp(-1/2 + 3 y^2/8) would at its centre, y = c / b (Johnson, Contact
Mechanics, 2.7 and 5).

A tip is no half-plane but a wedge, on which a load at a distance d from the corner sinks by a further
-(sigma - 1) kappa_T ln d, sigma = pi/2 `wedge_slope` of its angle, kappa_T its share of kappa = kappa_T + kappa_F.
A finite-element solution has that logarithm in its c_0 for a pressure of half-width b_0, which nowhere stands nearer to
the corner than b_0 itself. What a contact that reaches the corner adds is

    gamma ln(max(d, b_0) / m),    gamma = (sigma - 1) kappa_T / kappa,

m the distance at which a concentrated load would sink as far. With every length in units of b the problem depends on
t = theta R / b, the angle and kappa_T / kappa alone. Solved for angles of 100 to 135 degrees and shares of .3 to .7,
from the wedge's own Mellin symbol (`tests/closed_form/test_edge_law_closed_form.py`), m follows from t and gamma within
.02 kappa of approach up to a share of one half, .1 at .7 and 100 degrees; see `_distance`.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.tally import tallied

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array

#: m over the contact's width far from Hertz's contact, by powers of gamma: of the solved wedges.
_CONCENTRATED = (0.282, 0.241, -0.0436)
#: Wedges softer than this are none of a gear's tips; the largest solved is .97.
_SOFTEST = 1.0


@dataclass(frozen=True, slots=True)
class EdgeContacts:
    """Contacts near tip corners under the reference load; arrays of one shape.

    Parameters
    ----------
    tilt : ndarray
        t = theta R / b, theta the slope at which the flanks part from the tip corner inward: minus the distance from
        the corner over b where the contact lies inside of it.
    wedge : ndarray
        gamma; 0 where the source's c_0 takes no notice of the tip.
    room : ndarray
        b_0 / b.
    """

    tilt: Array
    wedge: Array
    room: Array

    def law(self, root: Array) -> tuple[Array, Array]:
        """psi and its slope at loads whose square root over that of the reference is `root`: see `edge_law`."""
        return edge_law(self.tilt / root, self.wedge, self.room / root)

    def rise(self, root: Array, tilt: Array, room: Array) -> Array:
        """Growth of psi at such loads as tilt and room grow."""
        at = self.tilt / root, self.wedge, self.room / root
        by_room = room_slope(*at)
        by_tilt = (edge_law(*at)[1] - by_room) / np.where(self.tilt == 0.0, 1.0, self.tilt)
        return np.asarray(by_tilt * tilt + by_room / np.where(self.room == 0.0, 1.0, self.room) * room)

    def under(self, root: Array) -> EdgeContacts:
        """The same with other reference loads, `root` the root of the old one over the new one, with an axis more."""
        return EdgeContacts(self.tilt * root, self.wedge, self.room * root)

    @classmethod
    def none(cls, shape: tuple[int, ...]) -> EdgeContacts:
        """Far inside of every corner."""
        return cls(np.full(shape, -np.inf), np.zeros(shape), np.zeros(shape))


@tallied("corner contacts")
def edge_law(t: ArrayLike, wedge: ArrayLike = 0.0, room: ArrayLike = 0.0) -> tuple[Array, Array]:
    """What the corner of a tip adds to the approach of a line contact, per kappa W.

    Zero with zero slope up to t = -1, where the corner no longer matters, unless a wedge has less room.

    Parameters
    ----------
    t : array_like
        theta R / b, b the Hertzian half-width at the present load.
    wedge, room : array_like
        gamma and b_0 / b, of the shape of t; see `EdgeContacts`.

    Returns
    -------
    psi, slope : ndarray
        psi and t dpsi/dt + room dpsi/droom, which is -2 W dpsi/dW.
    """
    at = np.asarray(t, dtype=float)
    near = at > -1.0
    psi, slope = np.zeros(at.shape), np.zeros(at.shape)
    s = at[near]
    y = 2.0 / (s + np.sqrt(s * s + 3.0))
    inside = np.minimum(s, 0.0)
    psi[near] = 0.5 - 0.375 * y * y - np.log(0.5 * y) + inside * inside
    slope[near] = s * (2.0 - s * y) / (1.5 * y + s) + 2.0 * inside * inside
    gamma = np.minimum(np.asarray(wedge, dtype=float), _SOFTEST)
    if gamma.any():
        s = np.where(near, at, -1.0)
        m, m_slope = _distance(s, 2.0 / (s + np.sqrt(s * s + 3.0)), gamma)
        m = np.where(near, m, np.maximum(-at, 1.0))
        farther = np.maximum(np.maximum(-at, room), np.finfo(float).tiny)  # no room where gamma is zero
        felt = near | (farther > m)
        psi = psi + gamma * np.log(np.where(felt, farther, 1.0) / np.where(felt, m, 1.0))
        slope = slope + np.where(near, gamma * (1.0 - m_slope), 0.0)
    return psi, slope


def room_slope(t: ArrayLike, wedge: ArrayLike, room: ArrayLike) -> Array:
    """The part room dpsi/droom of the slope of `edge_law`, same shape."""
    nearer = np.asarray(room, dtype=float) > -np.asarray(t, dtype=float)
    return np.asarray(np.where(nearer, np.minimum(wedge, _SOFTEST), 0.0))


def _distance(s: Array, y: Array, gamma: Array) -> tuple[Array, Array]:
    """M over b at s = t > -1, y the contact's width over b, and d ln m / d ln t.

    From half the width (Hertz's centre, with that of its distance as slope) to a share of it where the pressure is that
    of a sharp edge.
    """
    a, b, c = _CONCENTRATED
    least = a + gamma * (b + gamma * c)
    fading = (0.5 * y) ** (0.5 / (0.5 - least))
    share = least + (0.5 - least) * fading
    return y * share, -s / np.sqrt(s * s + 3.0) * (1.0 + 0.5 * fading / share)
