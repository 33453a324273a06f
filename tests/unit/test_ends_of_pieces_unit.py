"""Whether positions on a piece of the base pitch reach both of its ends."""

from __future__ import annotations

from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.contact.wide.transmission_error import _ON_END, _reaches_ends

BREAKS, PERIOD = np.array([1.0, 3.0, 6.0]), 8.0


@pytest.mark.parametrize("piece", [1, 2])
@pytest.mark.parametrize(("first", "last", "reaches"), [
    (0.0, 0.0, True), (0.9, 0.9, True), (1.1, 0.0, False), (0.0, 1.1, False), (1e5, 0.0, False), (0.0, 1e5, False),
])  # fmt: skip
def test_a_piece_is_reached_at_both_ends_or_it_is_not(piece, first, last, reaches):
    low, high = BREAKS[piece - 1], BREAKS[piece]
    near = _ON_END * PERIOD
    x = np.sort(np.array([low + first * near, 0.5 * (low + high), high - last * near]))
    points = Space(x=np.append(x, 7.5), breaks=BREAKS, period=PERIOD)
    own = np.array([piece] * 3 + [3])
    assert _reaches_ends(points, piece, own) is reaches
