"""Natural frequencies of Lin and Parker (1999), J. Vibration and Acoustics 121: table of their example."""

from collections import Counter

import numpy as np
import pytest

from fegear.dynamics.planetary.set_modes import set_modes
from fegear.verify.planetary_sets import lin_parker

#: Printed for three planets: those of rotational modes, and those of pairs of translational modes [Hz].
ROTATION = (0.0, 1475.7, 1930.3, 2658.3, 7462.8, 11775.3)
TRANSLATION = (743.2, 1102.4, 1896.0, 2276.4, 6986.3, 9647.9)


@pytest.fixture(scope="module")
def three():
    return set_modes(lin_parker(3), 5e8, 5e8)


def test_the_list_is_theirs_to_the_printed_digit(three):
    asked = np.sort([*ROTATION, *TRANSLATION, *TRANSLATION])
    assert np.max(np.abs(three.frequency - asked)) < 0.05 + 1e-6


def test_each_mode_is_of_their_kind(three):
    found = {kind: [f for f, k in zip(three.frequency, three.kind, strict=True) if k == kind] for kind in three.kind}
    assert set(found) == {"rotation", "translation"}
    assert np.round(found["rotation"], 1).tolist() == list(ROTATION)
    assert np.round(found["translation"][::2], 1).tolist() == list(TRANSLATION)


@pytest.mark.parametrize(("planets", "alone"), [(4, 1), (6, 3)])
def test_more_planets_bring_modes_in_which_they_move_alone(planets, alone):
    """Three frequencies of N - 3 modes each, and six of every other kind, translational ones twice."""
    count = Counter(set_modes(lin_parker(planets), 5e8, 5e8).kind)
    assert count == {"rotation": 6, "translation": 12, "planets": 3 * alone}


def test_frequencies_of_planet_modes_do_not_depend_on_their_number():
    """The closed form of one planet's 3 by 3 matrix: sun, ring and carrier stand still."""
    four, six = (set_modes(lin_parker(n), 5e8, 5e8) for n in (4, 6))
    alone = [np.unique(np.round([f for f, k in zip(m.frequency, m.kind, strict=True) if k == "planets"], 6))
             for m in (four, six)]  # fmt: skip
    assert np.allclose(*alone, rtol=1e-10)
    model = lin_parker(4)
    own = model.stiffness(5e8, 5e8)[9:12, 9:12]
    mass = np.sqrt(model.masses[9:12])
    assert np.allclose(np.sqrt(np.linalg.eigvalsh(own / np.outer(mass, mass))) / (2 * np.pi), alone[0], rtol=1e-8)
