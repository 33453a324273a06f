"""How well what a relief leaves is known: by the errors of the compliances, and of the search that found the relief."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

from fegear.contact.plane.shifted_loads import transmission_error_shift

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.contact.plane.engagement import Engagement
    from fegear.contact.plane.transmission_error import TransmissionError

#: What the last digits of a mesh's coordinates move, over the mean: nothing is known any better.
_DIGITS = 1e-9


class LeftError(NamedTuple):
    """Estimated errors of the transmission error that is left [m]; None where nothing states one."""

    peak_to_peak: float | None
    effective: float | None

    @property
    def larger(self) -> float | None:
        """Of both."""
        known = [one for one in self if one is not None]
        return max(known, default=None)


def left_error(te: TransmissionError, shifted: Sequence[Engagement], searched: float | None = None) -> LeftError:
    """Errors of what is left at one load.

    Parameters
    ----------
    te : TransmissionError
        With the relief.
    shifted : sequence of Engagement
        The pair with one compliance each off by its error; its own relief does not count.
    searched : float, optional
        Of the search by its own roll positions [m].
    """
    shift = transmission_error_shift(te, shifted)
    if shift is None:
        return LeftError(searched, searched)
    more, least = searched or 0.0, _DIGITS * te.mean
    return LeftError(max(shift.peak_to_peak + more, least), max(shift.effective + more, least))
