"""Whether two things have the same content: what caches and comparisons of results rest on."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from functools import partial

import numpy as np
import pytest

from fegear.base.arrays import same


@dataclass(frozen=True)
class Named:
    value: float
    name: str = field(default="", compare=False)


def power(base, exponent):
    return base**exponent


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (partial(power, 2.0, exponent=3), partial(power, 2.0, exponent=3)),
        (math.nan, math.nan),
        (Named(1.0, "a"), Named(1.0, "b")),
        ({"a": np.array([1.0, np.nan])}, {"a": np.array([1.0, np.nan])}),
        ((1, [2.0, np.zeros(3)]), (1, [2.0, np.zeros(3)])),
        (np.array([None, np.ones(2)], dtype=object), np.array([None, np.ones(2)], dtype=object)),
    ],
)
def test_alike(one, other):
    assert same(one, other)
    assert same(other, one)


@pytest.mark.parametrize(
    ("one", "other"),
    [
        (partial(power, 2.0, exponent=3), partial(power, 2.5, exponent=3)),
        (partial(power, 2.0, exponent=3), partial(power, 2.0, exponent=4)),
        (partial(power, 2.0), partial(math.pow, 2.0)),
        (math.nan, 0.0),
        (Named(1.0), Named(2.0)),
        ({"a": 1.0, "b": 2.0}, {"a": 1.0, "b": 2.5}),
        ({"a": 1.0}, {"b": 1.0}),
        ((1, 2), (1, 2, 3)),
        ((1, 2), (1, 3)),
        (np.zeros(3), np.array([0.0, 0.0, 1.0])),
        (np.zeros((1, 3)), np.zeros(3)),
        (np.zeros(3), [0.0, 0.0, 0.0]),
        (np.array([None, np.ones(2)], dtype=object), np.array([None, np.zeros(2)], dtype=object)),
    ],
)
def test_different(one, other):
    assert not same(one, other)
    assert not same(other, one)
