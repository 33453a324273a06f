"""Each zone of a body has products of functions over its own span along the face; only a hub's places are stretched."""

from __future__ import annotations

from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.fem.solid.section import HUB, Section

SPANS = (-5.0, 5.0), (-1.0, 1.0), (-3.0, 3.0)


@pytest.mark.parametrize("spans", [SPANS, SPANS[:2], SPANS[:1]])
@pytest.mark.parametrize("along", [None, Space(stretched="stretched")])
def test_products_along_are_those_of_each_zone_with_the_stretch_of_an_inclined_web_in_the_hub(spans, along):
    section = Space(spans=spans, along=along)
    face = Space(products_over=lambda low, high, stretched: (low, high, stretched))
    expected = [(*span, None) for span in spans]
    if along is not None and len(spans) > HUB:
        expected[HUB] = (*spans[HUB], "stretched")
    assert Section.products_along(section, face) == expected


def test_nodes_of_boundaries_are_each_once_ascending():
    edges = {"flank": np.array([[3, 1], [1, 0]]), "tip": np.array([[7], [3]])}
    section = Space(edge_nodes=edges)
    np.testing.assert_array_equal(Section.nodes_of(section, "flank", "tip", "bore"), [0, 1, 3, 7])
    assert Section.nodes_of(section, "bore").shape == (0,)
