"""Tooth loading functions by name: families, spectra and what is refused."""

from pathlib import Path

import numpy as np
import pytest
from solved_once import CACHE

from fegear.base.errors import FegearError
from fegear.case.reading import build_scene, read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

SOURCES = Path(__file__).parents[2] / "cases" / "sources"


def found(scene):
    return run_plan(scene, make_plan(scene, STAGES), cache=CACHE)


def asked(**loading):
    return build_scene({"results": ["loading-spectrum"], "loading": loading}, "case", Path())


def test_a_family_with_its_spectra():
    """Both families are the straight line for s = 1; every spectrum vanishes at whole orders and keeps its envelope."""
    tables = []
    for more in ({"family": "sinusoidal"}, {"family": "polynomial", "exponents": [3, 9]}):
        results = found(asked(contact_ratio=1.4, slopes=[0.0, 1.0, 1.5], **more))
        values = {v.name: v.value for v in results.values}
        assert values["loading_contact_ratio"] == 1.4
        assert values["loading_sum_misfit"] < 1e-14
        family = results.tables["loading_families"]
        straight = family["slope"] == 1.0
        np.testing.assert_allclose(family["load"][straight], family["x"][straight], atol=1e-15)
        spectra, off = results.tables["loading_spectra"], results.tables["loading_spectrum_factors"]
        high = (spectra["order"] > 20.0) & (spectra["slope"] > 0.0)
        assert (spectra["spectrum"][high] <= 1.05 * spectra["envelope"][high]).all()
        assert (spectra["envelope"][spectra["slope"] == 0.0] == 0.0).all()
        assert any("Loading with zero initial slope has no" in remark for remark in results.remarks)
        (one,) = {len(f.panels) for f in results.figures if f.key == "loading_spectrum_factors"}
        assert one == len(results.tables["loading_trade_off"]["slope"])
        tables.append(off)
    # (4.20): curves of one s end on one asymptote, whatever the family.
    last = [t["factor"][(t["slope"] == 1.5) & (t["q"] > 20.0)] for t in tables]
    size = np.abs(last[0]).max()
    for part in np.split(last[1], 2):
        assert np.abs(part - last[0]).max() < 0.1 * size


def test_the_report_s_own_loading_of_the_test_gears():
    """Mark (5.1), (5.2) and Fig. 12: .93730 cm, .29241 cm, 1.312; Table 1's load at 12.65 degrees is 93.05 N."""
    results = found(read_scene(SOURCES / "mark_fig12.toml"))
    values = {v.name: v.value for v in results.values}
    assert values["I.loading_base_pitch"] == pytest.approx(9.3730, abs=5e-5)
    assert values["I.loading_ramp"] == pytest.approx(2.9241, abs=5e-5)
    assert values["I.loading_contact_ratio"] == pytest.approx(1.312, abs=5e-4)
    table = results.tables["loading_functions_I"]
    base_radius = 44.45 * np.cos(np.radians(20.0))
    at = base_radius * (0.2208 - np.tan(np.radians(20.0)))
    assert np.interp(at, table["x"], table["load"]) == pytest.approx(93.05, abs=0.5)
    assert table["load"].max() == 1615.0


@pytest.mark.dear("mark_fig06_11", "mark_fig05_10")
@pytest.mark.parametrize("case", sorted(path.stem for path in SOURCES.glob("mark_fig0*.toml")))
def test_cases_of_the_report_run(case):
    results = found(read_scene(SOURCES / f"{case}.toml"))
    assert {v.name: v.value for v in results.values}["loading_sum_misfit"] < 1e-14
    keys = [figure.key for figure in results.figures]
    two_ramps = case == "mark_fig08"
    assert ("loading_spectrum_factors" in keys) != two_ramps
    if two_ramps:
        table = results.tables["loading_functions"]
        assert table["load"][table["peak"] == 0.7].max() == pytest.approx(0.7, abs=1e-15)


@pytest.mark.parametrize(
    ("loading", "words"),
    [
        ({"slopes": [1.0]}, "loading.contact_ratio"),
        ({"contact_ratio": 0.9}, "loading.contact_ratio = 0.9: is below 1"),
        ({"contact_ratio": 1.4, "slopes": [2.5]}, "loading.slopes"),
        ({"contact_ratio": 1.4, "family": "polynomial", "exponents": [4]}, "loading.exponents"),
        ({"contact_ratio": 1.4, "exponents": [3]}, "loading.exponents"),
        ({"contact_ratio": 2.4, "peaks": [0.4]}, "loading.peaks"),
        ({"contact_ratio": 1.4, "length": "5 mm"}, "contradicts length"),
        ({"contact_ratio": 1.4, "load": "5 N"}, "requires a pair"),
        ({"contact_ratio": 1.4, "pair": "X"}, "loading.pair"),
        ({"contact_ratio": 1.4, "slope": [1.0]}, "slopes"),
    ],
)
def test_what_no_teeth_can_carry_is_refused(loading, words):
    with pytest.raises(FegearError, match=words.replace(".", r"\.")):
        make_plan(asked(**loading), STAGES)


def test_at_contact_ratio_one_and_two_the_load_jumps():
    for ratio in (1.0, 2.0):
        results = found(asked(contact_ratio=ratio, slopes=[1.0]))
        assert {v.name: v.value for v in results.values}["loading_sum_misfit"] < 1e-14
        spectra = results.tables["loading_spectra"]
        assert (spectra["spectrum"] <= spectra["envelope"] * (1.0 + 1e-12)).all()
        assert np.isinf(results.tables["loading_trade_off"]["initial_slope"]).all()
        assert any("the load starts with a step (infinite slope)" in remark for remark in results.remarks)
