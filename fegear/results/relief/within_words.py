"""What a relief leaves at most within its tolerances beside no relief, in words, and which tolerances would do."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.results.relief.answer_numbers import told_apart, torque_words

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.base.arrays import Array


def lost_words(
    none: Array, most: Array, torque: Array, finer: int | None, allowed: Callable[[int], str], which: str = "",
    *, slopes: bool = False,
) -> str:  # fmt: skip
    """That no relief leaves less at every torque within the tolerances, and which would do; empty where it does not.

    Parameters
    ----------
    none, most : ndarray, shape (L,)
        Peak-to-peak transmission error without relief, and at most within the tolerances [m].
    torque : ndarray, shape (L,)
        [N m].
    finer, allowed
        As in `within_words`.
    which : str
        Shape of the relief, where a sentence about another follows: "parabolic tip ".
    slopes : bool
        Whether `none` is the maximum with profile slopes inside the same tolerances.
    """
    if finer == 0 or not np.all(most > none):
        return ""
    i = int(np.argmax(torque))
    less, more = told_apart(none[i], most[i])
    at = " at every torque" if torque.size > 1 else ""
    said = (
        f"within {allowed(0)} the transmission error is smaller without relief{at}: "
        f"{'at most ' if slopes else ''}{less} µm at "
        f"{torque_words(torque[i])}, with {which}relief at most {more} µm"
    )
    if finer is None:
        return f"{said}; no finer class makes relief pay{at}"
    return f"{said}; {which}relief requires {allowed(finer)}"


def within_words(
    none: float, most: float, torque: float, finer: int | None, allowed: Callable[[int], str],
    slopes: float | None = None,
) -> str:  # fmt: skip
    """What tolerances may leave at the torque where they take most of the gain, and which would do.

    Parameters
    ----------
    none, most : float
        Without relief, and at most within the tolerances [m].
    torque : float
        [N m].
    finer : int or None
        By how many classes the tolerances would have to be finer for the relief to pay at every torque.
    allowed : callable
        Tolerances that are so many classes finer, in words.
    slopes : float, optional
        Without relief at most, with profile slopes inside the same tolerances [m].
    """
    more, less = told_apart(most, none)
    same = ""
    if slopes is not None:
        more, same = told_apart(most, slopes)
        same = f", at most {same} µm with profile slopes within the same tolerance"
    said = f"within {allowed(0)} at most {more} µm at {torque_words(torque)} ({less} µm without relief{same})"
    if finer == 0:
        return said
    if finer is None:
        return f"{said}: no finer class keeps it below that at every torque"
    return f"{said}: to stay below that at every torque it needs {allowed(finer)}"
