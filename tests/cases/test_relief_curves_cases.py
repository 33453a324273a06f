"""`relief-curves`: the numbers of `transmission-error` and `load-sharing` for the same relief; refusals."""

from functools import cache
from pathlib import Path

import numpy as np
import pytest
from solved_once import CACHE

from fegear.base.errors import InputError
from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

CASES = Path(__file__).parents[2] / "cases"


@cache
def run(*overrides, case="sources/lin_townsend_oswald_fig4"):
    scene = read_scene(CASES / f"{case}.toml", overrides)
    results = run_plan(scene, make_plan(scene, STAGES), cache=CACHE)
    tables = {t.name: {c.head: np.asarray(c.values) for c in t.columns} for t in results.tables}
    return tables, {value.name: value.value for value in results.values}


def test_each_relief_is_that_of_the_results_for_one():
    chart = "design.chart={ amounts_over_delta = [1.25], lengths = [0.52, 1.0] }"
    tables, values = run(chart)
    one, ones = run(
        'results=["load-sharing", "transmission-error"]', "effects.relief=true",
        "gear.a.relief={ tip = { amount_over_delta = 1.25, normalised_length = 0.52 } }",
    )  # fmt: skip
    summary, curves = tables["relief_curves_summary_I"], tables["relief_curves_I"]
    k = int(np.flatnonzero(summary["length"] == 0.52)[0])
    assert summary["te_effective [um]"][k] == pytest.approx(ones["I.te_effective"], rel=1e-6)
    assert summary["te_peak_to_peak [um]"][k] == pytest.approx(ones["I.te_peak_to_peak"], rel=1e-4)
    assert summary["amplitude_3 [um]"][k] == pytest.approx(
        one["transmission_error_harmonics_I"]["amplitude [um]"][2], rel=1e-6
    )
    assert summary["amount [um]"][k] == pytest.approx(1.25 * values["I.delta"])
    rows = curves["length"] == 0.52
    alone = one["load_sharing_I"]
    got = np.interp(alone["x [mm]"], curves["x [mm]"][rows], curves["load [N]"][rows])
    np.testing.assert_allclose(got, alone["load [N]"], atol=30.0)
    # a pair and the next one, a base pitch behind, carry the whole load
    x, share = curves["x [mm]"][rows], curves["share"][rows]
    pitch = np.pi * 3.175 * np.cos(np.radians(20.0))
    both = share + np.interp(x - pitch, x, share, left=0.0) + np.interp(x + pitch, x, share, right=0.0)
    np.testing.assert_allclose(both, 1.0, atol=5e-3)


def test_the_unmodified_pair_is_the_first():
    tables, _ = run()
    summary = tables["relief_curves_summary_I"]
    plain, values = run('results=["transmission-error"]')
    assert (summary["amount [um]"][0], summary["length"][0]) == (0.0, 0.0)
    assert summary["te_effective [um]"][0] == pytest.approx(values["I.te_effective"], rel=1e-6)
    assert plain


def test_amounts_are_lengths_or_shares_of_delta():
    _, values = run()
    delta = values["I.delta"]
    by_share = run("design.chart={ amounts_over_delta = [0.5], lengths = [0.8] }")[0]["relief_curves_summary_I"]
    by_length = run(f"design.chart={{ amounts = ['{0.5 * delta!r} um'], lengths = [0.8] }}")[0]
    for head, found in by_length["relief_curves_summary_I"].items():
        np.testing.assert_allclose(found, by_share[head], rtol=1e-9, atol=1e-12)


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("design.chart={ amounts_over_delta = [1.0], amounts = ['20 um'] }", "contradicts amounts"),
        ("design.chart={ amounts_over_delta = [0.0], lengths = [1.0] }", "greater than 0"),
        (f"design.chart={{ lengths = {[0.04 * k for k in range(1, 26)]} }}", "25 reliefs exceed the maximum of 24"),
        ("gear.a.rack={ addendum = 1.4, dedendum = 1.6, tip_radius = 0.2 }", "has no highest point of single tooth"),
    ],
)
def test_refusals(override, words):
    with pytest.raises(InputError) as caught:
        run(override)
    assert words in str(caught.value).replace(": ", " ").replace("= ", "")
