"""X, Y and e of a bearing from what rolls in it: ISO 281:2007, Tables 3 and 7.

Of balls they follow from the contact angle and, up to 15 degrees, from F_a/(Z D_w^2) in N/mm^2, which is f_0 F_a/C_0 of
a catalogue; the rows are round numbers of pounds per square inch. Between rows and between angles the factors are
interpolated; below the first and above the last row they stay. Each row has X + e Y = 1 within its digits, so that P
has no step where F_a = e F_r.

Rollers in two rows, of spherical roller bearings and of two tapered ones side by side, carry axial force of any size:
P = F_r + 0.45 cot(alpha) F_a up to e = 1.5 tan(alpha), 0.67 F_r + 0.67 cot(alpha) F_a above.

Cylindrical roller bearings carry axial force on ribs, which ISO 281 does not rate: catalogues print P = 0.92 F_r + Y
F_a above e, with e = 0.2, Y = 0.6 for the series 2 and 3 and e = 0.3, Y = 0.4 for the wide ones, 22 and 23.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

#: F_a/(Z D_w^2) of the rows [N/mm^2].
_ROWS = (0.172, 0.345, 0.689, 1.03, 1.38, 2.07, 3.45, 5.17, 6.89)
#: X, and e and Y over the rows, of contact angles of 5, 10 and 15 degrees; a deep groove counts as 5 degrees.
_SMALL = {
    5.0: (
        0.56, (0.19, 0.22, 0.26, 0.28, 0.30, 0.34, 0.38, 0.42, 0.44),
        (2.30, 1.99, 1.71, 1.55, 1.45, 1.31, 1.15, 1.04, 1.00),
    ),
    10.0: (
        0.46, (0.29, 0.32, 0.36, 0.38, 0.40, 0.44, 0.49, 0.54, 0.54),
        (1.88, 1.71, 1.52, 1.41, 1.34, 1.23, 1.10, 1.01, 1.00),
    ),
    15.0: (
        0.44, (0.38, 0.40, 0.43, 0.46, 0.47, 0.50, 0.55, 0.56, 0.56),
        (1.47, 1.40, 1.30, 1.23, 1.19, 1.12, 1.02, 1.00, 1.00),
    ),
}  # fmt: skip
#: X, e and Y of larger contact angles of balls, whatever the load.
_LARGE = {
    20.0: (0.43, 0.57, 1.00), 25.0: (0.41, 0.68, 0.87), 30.0: (0.39, 0.80, 0.76), 35.0: (0.37, 0.95, 0.66),
    40.0: (0.35, 1.14, 0.57), 45.0: (0.33, 1.34, 0.50),
}  # fmt: skip
#: e of a deep groove ball bearing under a small axial force, the least of all.
LEAST_LIMIT = _SMALL[5.0][1][0]
#: X of rollers at a contact angle; Y = 0.4 cot(alpha), e = 1.5 tan(alpha).
_ROLLERS = 0.4
#: Y of two rows of rollers over cot(alpha) up to e, and X and Y over cot(alpha) above.
_TWO_ROWS_BELOW, _TWO_ROWS_ABOVE = 0.45, 0.67
#: X of rollers between ribs, and Y and e of narrow and of wide series.
_RIBBED, _NARROW, _WIDE = 0.92, (0.6, 0.2), (0.4, 0.3)
#: Axial over radial force that ribs should carry at most: guide value of makers, not verified against a printed source.
MOST_ON_RIBS = 0.4


def ribs_of(designation: str) -> tuple[float, float] | None:
    """Y and e of a bearing with ribs on both rings that locates a shaft (NUP); None of any other.

    Parameters
    ----------
    designation : str
        Without what a maker adds.
    """
    if not designation.startswith("NUP"):
        return None
    return _WIDE if len(designation) > len("NUP200") else _NARROW


@dataclass(frozen=True)
class AxialFactors:
    """What the factors of a bearing follow from.

    Parameters
    ----------
    balls : bool
        Balls; rollers otherwise.
    angle : float
        Nominal contact angle, not negative [rad].
    area : float
        Z D_w^2 of its balls [m^2].
    ribs : tuple of float, optional
        Y and e of a cylindrical roller bearing whose ribs carry axial force.
    rows : int
        Of rollers at a contact angle: 1 or 2.
    """

    balls: bool
    angle: float
    area: float
    ribs: tuple[float, float] | None = None
    rows: int = 1

    def equivalent_load(self, radial: float, axial: float) -> float:
        """P [N].

        Parameters
        ----------
        radial, axial : float
            Forces, not negative [N].
        """
        x, y, e = self.at(axial)
        if axial > e * radial:
            return x * radial + y * axial
        below = _TWO_ROWS_BELOW / math.tan(self.angle) if self.rows > 1 and self.angle else 0.0
        return radial + below * axial

    @property
    def rated(self) -> bool:
        """Whether there are factors: cylindrical roller bearings without ribs are rated for radial force only."""
        return self.balls or self.angle > 0.0 or self.ribs is not None

    def at(self, axial: float) -> tuple[float, float, float]:
        """X, Y and e under an axial force.

        Parameters
        ----------
        axial : float
            Not negative [N].

        Returns
        -------
        tuple of float
            1, 0 and infinity where no force counts but the radial one. X and Y are those above e.
        """
        if not self.rated:
            return 1.0, 0.0, math.inf
        if self.ribs is not None:
            return _RIBBED, *self.ribs
        if not self.balls:
            slope = math.tan(self.angle)
            if self.rows > 1:
                return _TWO_ROWS_ABOVE, _TWO_ROWS_ABOVE / slope, 1.5 * slope
            return _ROLLERS, _ROLLERS / slope, 1.5 * slope
        pressure = axial / self.area * 1e-6
        rows: list[tuple[float, ...]] = list(_LARGE.values())
        rows[:0] = ((x, *(float(np.interp(pressure, _ROWS, row)) for row in over)) for x, *over in _SMALL.values())
        angles = (*_SMALL, *_LARGE)
        x, e, y = (float(np.interp(math.degrees(self.angle), angles, row)) for row in zip(*rows, strict=True))
        return x, y, e
