"""Which contact half-widths a flank can hold."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.errors import RangeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

#: A contact's usual half-width [modules], at which what depends on it is reported.
REFERENCE_HALF_WIDTH = 0.02
#: Wider contacts than this [modules] are refused: the flank is too short to hold them.
LARGEST_HALF_WIDTH = 0.5
#: A contact that reaches past an end of the flank by no more than this [modules] is reported; by more it is refused.
FARTHEST_PAST_END = 0.1


def check_half_widths(
    half_width: ArrayLike, room: ArrayLike, *, unit: str = "modules", scale: float = 1.0, key: str = "half_width"
) -> None:
    """Refuse contacts that no flank holds.

    Parameters
    ----------
    half_width : array_like
        [modules].
    room : array_like
        Length of the flank from the contact's centre to the nearer end [modules], broadcast against `half_width`.
    unit, scale, key : str, float, str
        Unit of the refusal, modules times `scale`, and what it is about.

    Raises
    ------
    RangeError
        If a half-width is not positive, exceeds half a module, or reaches past the flank's end by more than a tenth
        of one.
    """
    b, room = np.broadcast_arrays(np.asarray(half_width, dtype=float), np.asarray(room, dtype=float))
    wrong = ~(np.isfinite(b) & (b > 0.0))
    if wrong.any():
        raise RangeError(key, f"{b[wrong][0] * scale:.6g} {unit}", "must be positive and finite")
    usual = f"{REFERENCE_HALF_WIDTH * scale:.6g} {unit} is usual"
    wide = b > LARGEST_HALF_WIDTH * (1.0 + 1e-9)
    if wide.any():
        raise RangeError(
            key,
            f"{b[wide][0] * scale:.6g} {unit}",
            f"is no contact on a flank: it exceeds half a module, {LARGEST_HALF_WIDTH * scale:.6g} {unit}",
            usual,
        )
    past = b > np.maximum(room, 0.0) + FARTHEST_PAST_END * (1.0 + 1e-9)
    if past.any():
        raise RangeError(
            key,
            f"{b[past][0] * scale:.6g} {unit}",
            f"reaches past the end of the flank, {room[past][0] * scale:.6g} {unit} from the contact's centre, "
            f"by more than a tenth of a module",
            usual + ", or choose radii farther from the flank's ends",
        )
