"""How far up a fillet stress is root stress, beside contact lines that press along all, a part or none of them."""

import numpy as np
import pytest

from fegear.contact.wide.fillet_ends import FilletEnds, LineOnTooth

ZETA = np.array([-2.0, -1.0, 0.0, 1.0, 2.0])
END = np.array([0.5, 0.6, 0.7, 0.8, 0.9])
PLACES = np.array([-2.4, -2.2, -1.5, -0.5, 0.0, 0.5, 1.5, 2.05, 2.2])


def ends(*tooth):
    """Three teeth, and lines on some of them: at the first roll position on stations 1 to 5."""
    lines = tuple(LineOnTooth(one, 1, slice(1, 6), ZETA, (0.3, 0.1), END) for one in tooth)
    return FilletEnds(1.5, 3, lines)


def force(*pressed):
    found = np.zeros((2, 7))
    found[1, [1 + one for one in pressed]] = 3.0
    found[0] = 5.0  # at another position
    return found


def test_below_a_line_that_presses_all_along_the_fillet_ends_early():
    found = ends(1).at(PLACES, force(0, 1, 2, 3, 4))
    wanted = [1.5, 0.5, 0.55, 0.65, 0.7, 0.75, 0.85, 0.9, 1.5]
    assert found[:, 1] == pytest.approx(wanted)
    assert (found[:, [0, 2]] == 1.5).all()


def test_a_line_that_presses_nothing_hides_nothing():
    """A tooth on the path without load was looked at as if a contact hid a part of its fillet."""
    assert (ends(0, 2).at(PLACES, force()) == 1.5).all()


def test_only_where_flanks_touch_is_a_fillet_hidden():
    """A station's force reaches as far as the stations beside it."""
    found = ends(0).at(np.append(ZETA, [0.5, 1.5]), force(4))[:, 0]
    assert found == pytest.approx([1.5, 1.5, 1.5, 0.8, 0.9, 0.5 * (1.5 + 0.8), 0.85])
