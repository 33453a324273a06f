"""How far the gear must have turned for a pinion point to touch its flank: an explicit function, and its derivatives.

The gear's flank is an involute helicoid, so the gear angle at which it passes through a given point X of the pinion
flank is explicit (`InvoluteHelicoid.separation_angle`). Both flanks touch without penetration at the *largest* such
angle over the part of the pinion flank that faces the gear's flank: tangency inside is surface contact, a maximum on
an edge of either flank is edge contact, on two edges it is corner contact. One maximisation thus covers all of them.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import numpy as np
    from numpy.typing import NDArray

    from fegear.base.arrays import Complex

    Codes = NDArray[np.int8]


@dataclass(frozen=True, slots=True)
class Helix:
    """Pinion points at one s (one helix of the flank) and pinion angle each: X(z) = w exp(i (twist z - crown z^2)).

    Parameters
    ----------
    w : ndarray of complex
        Profile point turned by phi_1 [m].
    dw : ndarray of complex
        Its derivative by s.
    """

    w: Complex
    dw: Complex

    def __getitem__(self, index: NDArray[np.bool_]) -> Helix:
        """The helices chosen by a mask."""
        return Helix(self.w[index], self.dw[index])
