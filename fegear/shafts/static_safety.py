"""Static safety factor of a rolling bearing: ISO 76:2006, s_0 = C_0/P_0 with P_0 = X_0 F_r + Y_0 F_a, at least F_r.

At s_0 = 1 the most loaded contact keeps an indentation of about 0.0001 of the diameter of its rolling element. C_0 is
that of a catalogue, otherwise of what rolls in the bearing (`load_ratings`). Between contact angles Y_0 of balls is
interpolated. Rollers without a contact angle have P_0 = F_r: what ribs carry is not rated.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

#: X_0 and Y_0 of deep groove ball bearings.
_GROOVE = (0.6, 0.5)
#: X_0 of one row at a contact angle.
_ONE_ROW = 0.5
#: Y_0 of balls in one row over the contact angle in degrees.
_Y_BALLS = {
    5.0: 0.52, 10.0: 0.50, 15.0: 0.46, 20.0: 0.42, 25.0: 0.38, 30.0: 0.33, 35.0: 0.29, 40.0: 0.26, 45.0: 0.22,
}  # fmt: skip
#: Y_0 over cot(alpha) of rollers in one and in two rows; X_0 of two rows.
_Y_ROLLERS, _Y_TWO_ROWS, _TWO_ROWS = 0.22, 0.44, 1.0


@dataclass(frozen=True)
class StaticRating:
    """What a static safety factor follows from.

    Parameters
    ----------
    rating : float
        C_0 [N].
    balls : bool
        Balls; rollers otherwise.
    angle : float
        Nominal contact angle, not negative [rad].
    rows : int
        Of rollers at a contact angle: 1 or 2.
    """

    rating: float
    balls: bool
    angle: float = 0.0
    rows: int = 1

    @property
    def factors(self) -> tuple[float, float]:
        """X_0 and Y_0."""
        if self.balls:
            if self.angle == 0.0:
                return _GROOVE
            y = np.interp(math.degrees(self.angle), list(_Y_BALLS), list(_Y_BALLS.values()))
            return _ONE_ROW, float(y)
        if self.angle == 0.0:
            return 1.0, 0.0
        x, y_cot = (_TWO_ROWS, _Y_TWO_ROWS) if self.rows > 1 else (_ONE_ROW, _Y_ROLLERS)
        return x, y_cot / math.tan(self.angle)

    def safety(self, radial: float, axial: float) -> float:
        """s_0; infinite without load.

        Parameters
        ----------
        radial, axial : float
            Forces [N].
        """
        x, y = self.factors
        load = max(abs(radial), x * abs(radial) + y * abs(axial))
        return self.rating / load if load > 0.0 else math.inf
