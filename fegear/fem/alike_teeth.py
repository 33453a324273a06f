"""Teeth by their numbers: what every source of answers about a gear's teeth says of which of them are alike.

Numbers rise toward the side that a load comes from: tooth i + 1 is ahead of tooth i of a driving gear, behind it of a
driven one; they go on through any number of turns.
"""

from __future__ import annotations

from collections.abc import Hashable, Iterable
from typing import Literal, Protocol

import numpy as np
from numpy.typing import NDArray


class Teeth(Protocol):
    """Which teeth of a gear answer alike."""

    @property
    def period(self) -> int:
        """Teeth after which all answers repeat: 1 where they are alike, else those of the gear."""

    def same_as(self, first: int, count: int) -> int:
        """First of `count` successive teeth that answer as those from `first` on: the same for all that do."""


class AlikeTeeth:
    """Base of sources whose teeth are all alike: answers about two teeth depend on the difference of their numbers."""

    __slots__ = ()
    period = 1

    def same_as(self, first: int, count: int) -> int:  # noqa: ARG002  (the interface)
        """Any are the same: 0."""
        return 0


def together(keys: Iterable[Hashable]) -> list[NDArray[np.intp]]:
    """Numbers of equal keys, together in the order in which keys come."""
    found: dict[Hashable, list[int]] = {}
    for number, key in enumerate(keys):
        found.setdefault(key, []).append(number)
    return [np.array(numbers) for numbers in found.values()]


def meshing_order(tooth: int, teeth: int, member: Literal["driver", "driven"]) -> int:
    """Number in the order of meshing of a tooth by its own number, 0 to z - 1, and the other way round.

    Tooth 0 is on pair 0 in base pitch 0, whichever way one counts; the tooth that comes into mesh after it is tooth -1
    of a driving gear, tooth 1 of a driven one.
    """
    return (-tooth if member == "driver" else tooth) % teeth
