"""Where a growing crack ends, straight on: at the bore or at a tooth's outline, beside walking there step by step."""

import math

import numpy as np
import pytest

from fegear.fem.plane.odd.growth import _ends_in, tooth_outline
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

TOOTH = Tooth(18, BasicRack(1.0, 1.25, 0.25))
STEP = 5e-3


def turned(points, angle):
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s], [s, c]]) @ points


RIGHT = (outline := tooth_outline(TOOTH))[:, outline[0] >= 0.0]
RADIUS, HALF = np.hypot(*RIGHT), np.arctan2(*RIGHT)
UP = np.lexsort((-HALF, RADIUS))


def inside(points):
    """Whether points lie within the nearest tooth: nearer to its centre line than its flank at their radius is."""
    radius, pitch = np.hypot(*points), 2.0 * math.pi / TOOTH.teeth
    angle = np.abs((np.arctan2(*points) + 0.5 * pitch) % pitch - 0.5 * pitch)
    return (radius < TOOTH.root_radius) | (
        (radius < TOOTH.tip_radius) & (angle < np.interp(radius, RADIUS[UP], HALF[UP]))
    )


@pytest.mark.parametrize("bore", [3.0, 6.8])
@pytest.mark.parametrize("tip", [(0.5, 7.9), (-0.2, 7.2), (0.0, 9.2)])
def test_a_crack_ends_where_walking_straight_on_ends(tip, bore):
    """All directions, given by the crack's last piece and a turn together."""
    tip, ends = np.array(tip), set()
    for angle in np.arange(0.03, 2.0 * math.pi, 0.31):
        way = np.array([math.cos(angle), math.sin(angle)])
        walk = tip[:, None] + way[:, None] * np.arange(1, 4200) * STEP
        off = ~inside(walk)
        first_off = int(np.argmax(off)) if off.any() else 10**6
        in_bore = np.hypot(*walk) < bore
        first_in_bore = int(np.argmax(in_bore)) if in_bore.any() else 10**6
        expected = "rim" if first_in_bore < first_off else "tooth"
        turn = 0.4 * math.sin(5.0 * angle)
        path = np.column_stack([tip - 0.7 * turned(way[:, None], -turn)[:, 0] * s for s in (1.3, 1.0, 0.0)])
        assert _ends_in(TOOTH, bore, path, turn, 2) == expected, math.degrees(angle)
        sectors = abs(math.atan2(*walk[:, min(first_off, walk.shape[1] - 1)])) / (2.0 * math.pi / TOOTH.teeth)
        if expected == "rim" or sectors < 1.4:  # teeth next to the patch are looked at, too
            assert _ends_in(TOOTH, bore, path, turn, 0) == expected
        ends.add(expected)
    assert ends == {"rim", "tooth"}
