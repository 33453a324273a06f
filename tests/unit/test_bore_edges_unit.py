"""Edges along the bore of a sector that is held on a part of it."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fegear.fem.plane.boundary import _WIDEST_BORE_EDGE, _graded_bore
from fegear.fem.plane.settings import settings_at


@pytest.mark.parametrize(("teeth", "bore", "end"), [(12, 2.0, 0.02), (12, 2.0, 0.2), (60, 25.0, 0.05), (12, 40.0, 0.3)])
def test_edges_are_short_at_the_ends_and_nowhere_longer_than_the_body_s(teeth, bore, end):
    settings, pitch = settings_at(-2), 2.0 * math.pi / teeth
    right = bore * np.array([math.sin(0.5 * pitch), math.cos(0.5 * pitch)])
    chain = _graded_bore(right, bore, end, settings, pitch)
    length = np.hypot(*np.diff(chain.vertices, axis=1))
    half = 0.5 * pitch * bore
    assert length.sum() == pytest.approx(2.0 * half, rel=0.05)
    assert length == pytest.approx(length[::-1])
    assert length.max() < 1.05 * min(_WIDEST_BORE_EDGE * bore, settings.body_fraction * half)
    assert length.max() > 0.5 * min(_WIDEST_BORE_EDGE * bore, end + settings.growth * half)
    assert length[0] < 1.3 * end
    assert length[0] <= length.min() * 1.000001
