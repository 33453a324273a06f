"""``dynamics.method = "averaging"``, the iteration of TM-100180: what a run says of where it settled and where not."""

from pathlib import Path

import numpy as np
import pytest
from solved_once import CACHE

import fegear
from fegear.base.errors import FegearError
from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.results.catalogue import STAGES

CASE = Path(__file__).parents[2] / "cases" / "sources" / "lin_huston_coy_iteration.toml"
SETS = Path(__file__).parents[2] / "cases" / "planetary_set.toml"


def run(speeds, **overrides):
    return fegear.run(CASE, {"dynamics.speeds": [f"{n} rpm" for n in speeds], **overrides}, cache=CACHE)


def column(results, head):
    return next(c.values for c in results.tables["dynamic_factor_I"].columns if c.head == head)


@pytest.mark.dear
def test_it_settles_at_the_resonance_and_where_it_does_not_a_sentence_says_what_was_seen():
    """It does not stall near resonance, as was claimed here, but far above it, by the swing of the shafts."""
    averaged = run([2000, 10_500, 11_000, 28_000])
    newton = run([2000, 10_500, 11_000], **{"dynamics.method": "shooting"})
    assert list(column(averaged, "motion")) == ["periodic"] * 3 + ["not settled"]
    factor, error = (np.array(column(averaged, head)) for head in ("dynamic_factor", "dynamic_factor_error"))
    assert np.all(np.abs(factor[:3] - column(newton, "dynamic_factor")) <= error[:3])
    assert column(averaged, "repetitions")[3] == 1000
    assert max(column(averaged, "repetitions")[:3]) < 400
    said = [remark for remark in averaged.remarks if remark.startswith("Averaging iteration")]
    assert said[0] == "Averaging iteration converged at 3 of 4 speeds, after 27 to 369 periods."
    assert said[1].startswith("Averaging iteration did not converge at 1 of 4 speeds: 28000 rpm after 1,000 periods, ")
    assert "of the static deflection, dynamic factor 0.6783 to 0.6796 of mesh I in the last 100." in said[1]
    assert said[1].endswith('Set dynamics.method = "shooting" there.')
    assert "repetitions" not in [c.head for c in newton.tables["dynamic_factor_I"].columns]
    assert not [remark for remark in newton.remarks if "Averaging" in remark]


def test_a_motion_that_no_machine_stays_in_is_named():
    """With a damping ratio of 0.005 the shafts build up a swing beside the mesh's; averaging sees nothing of it."""
    weak = {f"train.shaft.{name}.damping_ratio": 0.005 for name in ("input", "output")}
    found = run([9000, 10_500], **weak)
    assert list(column(found, "motion")) == ["periodic", "unstable"]
    (said,) = [remark for remark in found.remarks if "Averaging iteration converged to an unstable" in remark]
    assert "at 1 of 2 speeds: 10500 rpm (multiplier 1.000" in said
    assert np.isnan(column(found, "dynamic_factor_error")[1])


@pytest.mark.parametrize(
    ("case", "overrides", "said"),
    [
        (
            CASE, ("effects.contact_loss=false", "effects.parametric=false", "train.mesh.I.damping_law='constant'"),
            "applies to time-domain results only",
        ),
        (SETS, ("results=['planet-motion']", "dynamics.method='averaging'"),
            "applies to gear trains, not to planetary gear"),
        (CASE, ("dynamics.method='newton'",), "method"),
    ],
)  # fmt: skip
def test_where_it_has_no_meaning_it_is_refused(case, overrides, said):
    with pytest.raises(FegearError, match=said):
        make_plan(read_scene(case, overrides), STAGES)
