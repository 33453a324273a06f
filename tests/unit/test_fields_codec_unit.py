"""Solutions kept field by field: they come back whole, and bytes of another kind are not used."""

from dataclasses import dataclass

import numpy as np
import pytest

from fegear.base.plain import pack
from fegear.base.solution_cache import fields_codec


@dataclass(frozen=True)
class Kept:
    best: np.ndarray
    left: float
    count: int = 0


CODEC = fields_codec(Kept)


def test_what_is_kept_comes_back():
    kept = Kept(np.array([1e-6, np.nan, 0.5]), 1e-300, 3)
    found = CODEC.read(CODEC.write(kept))
    np.testing.assert_array_equal(found.best, kept.best)
    assert (type(found), found.left, found.count) == (Kept, 1e-300, 3)


@pytest.mark.parametrize(
    "data", [b"", b"\0\1", pack({"best": np.zeros(1), "left": 1.0, "other": 2}), pack({"left": 1.0}), pack([1.0])]
)
def test_bytes_of_another_kind_are_not_used(data):
    assert CODEC.read(data) is None
