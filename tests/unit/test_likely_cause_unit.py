"""Likely causes of a measured strain that differs, the one that has to be the fewest times its tolerance first."""

import numpy as np
import pytest

from fegear.results.pair.likely_cause import likely_causes, place_of_gain

PLACES = np.linspace(-1e-4, 1e-4, 21)
GAINS = 1.0 + 400.0 * PLACES  # 4 % for a tenth of a millimetre


def test_a_place_is_found_within_and_beyond_the_tolerance():
    assert place_of_gain(PLACES, GAINS, 1.02) == pytest.approx(5e-5)
    assert place_of_gain(PLACES, GAINS, 0.94) is None
    assert place_of_gain(PLACES, GAINS, 0.94, 2.5) == pytest.approx(-1.5e-4)
    assert place_of_gain(PLACES, GAINS, 1.11, 2.5) is None
    peaked = 1.0 - (PLACES / 1e-3) ** 2  # the largest strain of the fillet: no place has more
    assert place_of_gain(PLACES, peaked, 1.01, 2.5) is None
    assert place_of_gain(np.zeros(1), np.ones(1), 1.0, 2.5) is None
    assert place_of_gain(PLACES[10:], GAINS[10:], 0.98, 2.5) is None  # there the fillet ends


def test_the_cause_that_takes_least_of_its_tolerance_is_first():
    assert likely_causes(-0.06, 0.01, PLACES, GAINS) == (
        "; likeliest cause: a grid 0.15 mm nearer to the root (1.5 times placement_tolerance), then a torque, gauge "
        "factor or bridge supply 6.0 % lower (or leads of a quarter bridge with two wires) (6 times load_tolerance)"
    )
    assert likely_causes(0.06, 0.05, PLACES, GAINS).startswith(
        "; likeliest cause: a torque, gauge factor or bridge supply 6.0 % higher (1.2 times load_tolerance), then a"
    )
    assert "leads" not in likely_causes(-0.06, 0.01, PLACES, GAINS, leads=False)
    assert "times load_tolerance" not in likely_causes(0.06, 0.0, PLACES, GAINS)
    assert likely_causes(0.3, 0.01, PLACES, GAINS).endswith("; no grid within 0.25 mm would explain it")
    alone = likely_causes(0.3, 0.01, np.zeros(1), np.ones(1))
    assert alone == "; likeliest cause: a torque, gauge factor or bridge supply 30 % higher (30 times load_tolerance)"


@pytest.mark.parametrize(("off", "said"), [(0.1, "two equal and opposite strains"), (1.2, "a quarter bridge")])
def test_a_half_bridge_over_both_fillets_is_named_by_its_ratio(off, said):
    words = f"; likeliest cause: a half bridge with the other fillet, evaluated as {said} (set bridge), then "
    assert likely_causes(off, 0.01, PLACES, GAINS, 1.2).startswith(words)
    assert "half bridge" not in likely_causes(off + 0.12, 0.01, PLACES, GAINS, 1.2)
    assert "half bridge" not in likely_causes(off, 0.01, PLACES, GAINS)
