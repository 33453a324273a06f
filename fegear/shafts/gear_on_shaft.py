"""A gear's body that sits fast on its shaft: it stiffens the shaft there, and carries its motion to the teeth."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array
from fegear.fem.revolved_body import RevolvedBody, condensed
from fegear.shafts.carried import carry

#: Of the six motions of a section, those across the axis and their tilts, d/dz of each, in both planes.
_PLANES = ((0, 4, 1.0), (1, 3, -1.0))
_ALONG, _TURN = 2, 5


@dataclass(frozen=True, slots=True)
class GearOnShaft:
    """A gear's body on a shaft.

    Parameters
    ----------
    body : RevolvedBody
    at : float
        Middle of its face from the shaft's left end, along which the body counts its places [m].
    young_modulus : float
        [Pa].
    """

    body: RevolvedBody
    at: float
    young_modulus: float

    @property
    def places(self) -> Array:
        """Where it sits on the shaft, shape (n,) [m]."""
        return self.at + condensed(self.body).seat

    def root(self, length: float) -> Array:
        """B of its stiffness S = B B^T against the motions of the sections at `places`, shape (n, 6, m).

        What sits beyond an end of the shaft is carried by that end.
        """
        known, own = condensed(self.body), self.places
        n, turns, bends = own.size, known.torsion.shape[1], known.bending.shape[1]
        found = np.zeros((n, 6, turns + 2 * bends))
        found[:, _TURN, :turns] = known.torsion
        for plane, (shift, tilt, sign) in enumerate(_PLANES):
            columns = slice(turns + plane * bends, turns + (plane + 1) * bends)
            found[:, shift, columns] = known.bending[:n]
            found[:, tilt, columns] = sign * known.bending[n:]
        return np.sqrt(self.young_modulus) * carry(own - np.clip(own, 0.0, length)) @ found

    def carried(self, own: Array, length: float) -> Array:
        """How the ring under the teeth moves at places `own` with the sections at `places`, shape (k, 6, n, 6)."""
        from scipy.interpolate import CubicSpline

        known, places = condensed(self.body), self.places
        n, k = places.size, known.teeth.size
        at = np.clip(own - self.at, known.teeth[0], known.teeth[-1])
        spread = CubicSpline(known.teeth, np.eye(k))(at)
        found = np.zeros((own.size, 6, n, 6))
        found[:, _TURN, :, _TURN] = spread @ known.turned
        found[:, _ALONG, :, _ALONG] = np.stack([np.interp(at, known.seat, one) for one in np.eye(n)], axis=1)
        for shift, tilt, sign in _PLANES:
            for row, (to, first) in enumerate(((shift, 1.0), (tilt, sign))):
                for column, (of, second) in enumerate(((shift, 1.0), (tilt, sign))):
                    part = known.moved[row * k : (row + 1) * k, column * n : (column + 1) * n]
                    found[:, to, :, of] = first * second * (spread @ part)
        return np.einsum("kanb,ncb->kanc", found, carry(places - np.clip(places, 0.0, length)))
