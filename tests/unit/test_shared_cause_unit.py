"""A cause that several traces have in common is found where its values agree, and is none of grids."""

from dataclasses import replace

import pytest

from fegear.contact.plane.possible_flanks import Possible
from fegear.contact.trace_causes import Cause, Causes
from fegear.results.pair.likeliest_flank import LikeliestFlank
from fegear.results.pair.shared_cause import NamedCause, of_shared_cause, shared_cause

RELIEF = Possible("tip relief", ("driver", "driven"), 22e-6, 0.0, 1e-4, lambda _: None)
GRID = Possible("place", ("driver",), 0.0, -1e-4, 1e-4, lambda _: None)


def named(name, value, error=0.2e-6, of=RELIEF, kind="gauge", *, others=(), within=False):
    causes = (Cause(of, value, error, 0.99, 1e-6), *others)
    ranked = LikeliestFlank(Causes(causes, len(causes), 1e-5, within), None, (100.0,), 1e-3, of_gauge=True)
    return NamedCause(kind, name, "I", ranked)


def test_gauges_and_encoders_with_one_relief_are_one_sentence():
    said = of_shared_cause(
        [named("a", 13.0e-6), None, named("b", 13.3e-6, 0.4e-6), named("rig", 12.9e-6, kind="encoders")]
    )
    assert said == (
        "One cause explains gauges a and b and encoders rig: a tip relief of both gears of 13.0 ± 0.4 µm in place of "
        "22 µm."
    )


@pytest.mark.parametrize("other", [16e-6, 8e-6])
def test_values_that_differ_have_no_common_cause(other):
    assert of_shared_cause([named("a", 13e-6), named("b", other)]) == ""
    assert shared_cause([named("a", 13e-6), named("b", 13e-6), named("c", other)]).cause.value == pytest.approx(13e-6)


def test_displaced_grids_of_two_gauges_and_what_is_within_its_tolerance_are_no_common_cause():
    assert of_shared_cause([named("a", 5e-5, of=GRID), named("b", 5e-5, of=GRID)]) == ""
    assert of_shared_cause([named("a", 13e-6, within=True), named("b", 13e-6)]) == ""


def test_the_common_one_of_causes_that_cannot_be_distinguished_is_taken():
    driver = replace(RELIEF, of=("driver",))
    either = named("b", 10e-6, of=driver, others=(Cause(RELIEF, 13.1e-6, 0.2e-6, 0.99, 1e-6),))
    assert shared_cause([named("a", 13e-6), either]).cause.of is RELIEF
