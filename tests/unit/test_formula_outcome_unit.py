"""Outcomes: a value or a reason, never both and never a NaN."""

import math

import numpy as np
import pytest

from fegear.base.errors import InputError, RangeError
from fegear.formulas.outcome import Outcome, attempt
from fegear.formulas.root_stress_formulas import ROOT_STRESS_SOURCES, root_stress_table
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack


def fail() -> float:
    raise RangeError("x", -1, "must be positive")


def test_attempt_turns_a_range_error_into_words():
    assert attempt(lambda: 2.0).unwrap() == 2.0
    o = attempt(fail)
    assert not o.ok
    assert "must be positive" in o.reason
    with pytest.raises(RangeError, match="must be positive"):
        o.unwrap()


def test_attempt_lets_programming_errors_through():
    with pytest.raises(ZeroDivisionError):
        attempt(lambda: 1 // 0)


def test_an_outcome_says_one_thing():
    with pytest.raises(InputError):
        Outcome(None)
    with pytest.raises(InputError):
        Outcome(1.0, "both")


@pytest.mark.parametrize("z", [5, 8, 12, 17, 28, 41, 60, 200, 500, 1000])
@pytest.mark.parametrize("rack", [BasicRack(1, 1.25, 0.25), BasicRack(1, 1.25, 0.0), BasicRack.full_fillet(1, 1.3)])
def test_the_table_has_a_number_or_a_reason_everywhere(z, rack):
    tooth = Tooth(z, rack, tip_radius=z / 2 + (0.6 if z < 8 else 0.9))
    radii = [0.99 * tooth.form_radius, *np.linspace(tooth.form_radius, tooth.tip_radius, 5)]
    table = root_stress_table(tooth, radii)
    assert list(table) == list(ROOT_STRESS_SOURCES)
    for name, outcomes in table.items():
        # The Lewis parabola of these two may touch the trochoid beyond the fillet, as AGMA 908's own iteration has it.
        last = tooth.tip_radius if name in ("agma-908", "dolan-broghamer") else tooth.form_radius
        assert not outcomes[0].ok  # below the form circle
        for o in outcomes:
            if o.ok:
                value = o.unwrap()
                assert all(map(math.isfinite, (value.stress, value.radius, value.fillet_radius, value.tangent_angle)))
                assert tooth.root_radius * (1 - 1e-9) <= value.radius <= last * (1 + 1e-9)
            else:
                assert len(o.reason) > 20
    usable = sum(o.ok for outcomes in table.values() for o in outcomes)
    assert usable >= 10
