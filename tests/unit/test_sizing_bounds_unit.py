"""Which numbers of a variant lie at the end of what may vary."""

from __future__ import annotations

import pytest

from fegear.design.sizing.space import _ends


@pytest.mark.parametrize(
    ("value", "low", "high", "said"),
    [
        (1.0, 1.0, 3.0, ["face_width (minimum)"]),
        (3.0, 1.0, 3.0, ["face_width (maximum)"]),
        (2.0, 1.0, 3.0, []),
        (2.0, 2.0, 2.0, []),
    ],
)
def test_an_end_is_named_where_there_are_two(value, low, high, said):
    assert _ends("face_width", value, low, high) == said
