"""Random pairs with an odd tooth over a revolution: stated errors are no less than the true ones / 1.5.

`helpers/random_odd_pairs.py` draws and judges them.
"""

import pytest

from tests.helpers.random_odd_pairs import case_of, judged

#: Times the stated error that a true one may be.
BEYOND = 1.5


def covered(number, plane, seed=511):
    each = judged(case_of(seed, number, plane=plane), 1e-2)
    assert {"root_a", "root_b"} < set(each)
    assert not {name: found for name, found in each.items() if found[0] > BEYOND * found[1]}


@pytest.mark.dear
def test_stated_errors_of_a_plane_pair_with_a_cracked_tooth_cover_the_true_ones():
    covered(1, plane=True)


@pytest.mark.long
@pytest.mark.parametrize(("number", "plane"), [(0, True), (2, True), (0, False)])
def test_stated_errors_of_pairs_with_an_odd_tooth_cover_the_true_ones(number, plane):
    covered(number, plane=plane)
