"""How many harmonics of a planetary set's vibration count where the case gives none."""

from dataclasses import replace

import numpy as np
import pytest

from fegear.case.planetary import PlanetaryPart
from fegear.dynamics.planetary.set_response import enough_harmonics, forced_response, linear_set
from fegear.dynamics.train.excitation import MeshExcitation
from fegear.dynamics.train.periodic import Periodic
from fegear.results.planetary.planet_vibration import PLANET_VIBRATION, VibrationInputs
from fegear.verify.planetary_sets import jumping, lin_parker, meshed

#: [Hz], far below the natural frequencies, which high harmonics then meet.
SLOW = np.array([61.0, 210.0])
#: At which fewer harmonics meet them.
FASTER = np.array([210.0, 700.0])


@pytest.fixture(scope="module")
def teeth_that_jump():
    return linear_set(meshed(lin_parker(3), jumping(4e8, 5.5e8, 0.6), jumping(4.5e8, 5.8e8, 0.7)), 0.03, None)


def missing(linear, frequency, count):
    """Largest part of the force of 256 harmonics that so many do not give."""
    every = forced_response(linear, frequency).largest_force
    return np.max(np.abs(forced_response(replace(linear, harmonics=count), frequency).largest_force / every - 1.0))


@pytest.mark.parametrize("frequency", [SLOW, FASTER], ids=["slow", "faster"])
def test_the_fewest_that_leave_the_force_within_the_tolerance_count(teeth_that_jump, frequency):
    linear, chosen = teeth_that_jump, []
    lacking = {n: missing(linear, frequency, n) for n in (12, 25, 50, 100, 200)}
    for tolerance in (1.0, 0.3, 0.1, 0.03, 0.01, 0.0):
        chosen.append(enough_harmonics(linear, frequency, tolerance).harmonics)
        assert chosen[-1] == next((n for n, lacks in lacking.items() if lacks <= tolerance), 200), lacking
    assert (chosen[0], chosen[-1]) == (12, 200)
    assert frequency is SLOW or len(set(chosen)) > 2


def test_teeth_of_one_harmonic_need_no_more_than_the_fewest():
    law = MeshExcitation.from_mesh(Periodic.fit(lambda s: 5e8 * (1.0 + 1e-3 * np.cos(2.0 * np.pi * s))))
    assert enough_harmonics(linear_set(meshed(lin_parker(3), law, law), 0.03, None), SLOW, 1e-2).harmonics == 12


def test_a_tolerance_that_is_not_met_is_stated_as_an_error(teeth_that_jump):
    found = forced_response(enough_harmonics(teeth_that_jump, SLOW, 0.0), SLOW)
    every = forced_response(teeth_that_jump, SLOW).largest_force
    assert (found.shift(lambda one: one.largest_force) >= 0.999 * np.abs(every - found.largest_force)).all()


@pytest.mark.parametrize(
    ("harmonics", "remedy"),
    [(1, "increase planetary.P.harmonics"), (200, "reduce accuracy.tolerance"), (None, "reduce accuracy.tolerance")],
)
def test_the_note_on_a_rough_force_names_the_key_that_helps(teeth_that_jump, harmonics, remedy):
    linear = replace(teeth_that_jump, harmonics=1)
    inputs = VibrationInputs(SLOW, 1.0, 0.03, harmonics, 1e-3, "sun", "P")
    (note,) = (one for one in PLANET_VIBRATION.present(forced_response(linear, SLOW), inputs).remarks if "20 %" in one)
    assert note.startswith("P.dynamic_force (")
    assert note.endswith(f"estimated error above 20 % of the value; {remedy}.")
    assert "harmonics" in PlanetaryPart.model_fields
