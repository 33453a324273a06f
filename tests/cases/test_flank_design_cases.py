"""``flank-design``: from a case to tables, keys and files that a case reads back, and what it refuses."""

from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import read_scene
from fegear.contact.wide.compliance import flank_compliance
from fegear.design.flanks.scatter import Scatter
from fegear.design.flanks.topography import lines_at
from fegear.design.flanks.trials import FlankTrials
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.sheet.seen import Seen
from fegear.engine.stage import Task
from fegear.output.tables import write_table
from fegear.results.catalogue import STAGES
from fegear.results.relief.flank_design_data import topography_points
from fegear.results.relief.flank_design_sheet import TOPOGRAPHY
from fegear.results.relief.ground_flank_keys import keys_of

CASE = Path(__file__).parents[2] / "cases" / "helical_flank_design.toml"
COARSE = (
    "accuracy.tolerance=1e-1", "load_distribution.positions=9", "load_distribution.panels=5",
    "flank_design.positions=12", "flank_design.largest_face_load_factor=9",
    'gear.pinion.face_width="6 mm"', 'gear.wheel.face_width="6 mm"', 'pair.I.load="1800 N"',
    'flank_design.grid={tip_amounts=["12 um", "20 um"], tip_lengths=["4.5 mm"], crownings=["4 um"], biases=["-4 um"]}',
    'flank_design.families=["profile-lead-and-bias"]', "flank_design.map.load_factors=[0.5, 1.0]",
    'flank_design.scatter={over_face="6 um", levels=2}',
)  # fmt: skip


@pytest.fixture(scope="module")
def cache():
    return SolutionCache()


def ran(cache, *overrides, path=CASE, result="flank-design"):
    scene = read_scene(path, [*COARSE, *overrides])
    return run_plan(scene, make_plan(scene, STAGES), cache=cache).outcomes[Task(result, "I")]


@pytest.fixture(scope="module")
def outcome(cache):
    return ran(cache)


def table(outcome, name):
    (found,) = (one for one in outcome.tables if one.name == name)
    return found


def columns(outcome, name):
    return {column.head: np.asarray(column.values) for column in table(outcome, name).columns}


def value(outcome, name):
    (found,) = (one for one in outcome.values if one.name == f"I.{name}")
    return found


@pytest.mark.long
def test_what_is_left_is_told(outcome):
    rows = columns(outcome, "flank_designs_I")
    label = rows["relief"].tolist()
    left = dict(zip(label, rows["te_peak_to_peak [um]"].tolist(), strict=True))
    assert label[:2] == ["no relief", "exact topography"]
    assert left["exact topography"] < 0.015 * left["no relief"]
    assert left["profile-lead-and-bias"] < 0.3 * left["no relief"]
    assert value(outcome, "no_relief.te_peak_to_peak").value == left["no relief"]
    assert (rows["combinations"][2:] > 0).all()
    assert rows["proven"].min() == 1.0
    error = rows["quick_error [um]"]  # nothing was searched for where nothing is ground, or exactly that
    assert np.isnan(error[:2]).all()
    assert (error[2:] >= 0.0).all()
    assert (rows["te_mean_over_scatter [um]"] >= 0.9 * rows["te_peak_to_peak [um]"]).all()
    assert (rows["te_p95_over_scatter [um]"] >= rows["te_mean_over_scatter [um]"]).all()
    for head in ("te_peak_to_peak", "K_Hbeta", "hertz_pressure"):
        one = value(outcome, f"robust.{head}")
        assert 0.0 < one.error < 0.3 * one.value
    # the robust one has the least mean over the scatter of all that its family can do
    mean = dict(zip(label, rows["te_mean_over_scatter [um]"].tolist(), strict=True))
    assert mean["robust"] <= 1.03 * mean["profile-lead-and-bias"]


@pytest.mark.long
def test_its_answer_says_what_to_grind_what_theory_leaves_and_what_the_robust_one_is_chosen_by(outcome):
    grind, within, *others = outcome.answer.sentences
    best = outcome.data.design.best
    begins = {"exact": "Pair I: the exact topography reduces the transmission error from ",
              "robust": f"Pair I: {best.label} is chosen by the mean over the scatter of misalignment: "}  # fmt: skip
    said = {key: [one for one in others if one.startswith(begin)] for key, begin in begins.items()}
    (robust,) = said["robust"]
    assert len(others) == 3  # an answer has five sentences: what theory leaves is the first that has no room
    fewer = [one for one in others if one not in (robust, *said["exact"])]
    assert grind.startswith("Pair I: grind ")
    torque = f"{1800.0 * 29.06345e-3:.2f} N m"  # base radius: 0.5 x 20 x 3 mm / cos 15° x cos(atan(tan 20° / cos 15°))
    assert grind.endswith(f"µm) at {torque}, peak to peak.")
    assert "(within tolerances at most " in grind
    assert within.startswith("Pair I: within ± ")
    assert all("modifications) is only" in one or "tolerance" in one for one in fewer)
    assert all(one.endswith(f"µm at {torque}.") for one in said["exact"])
    left = best.judged.mean_over_scatter.value * 1e6
    assert f" -> {left:.2g} µm at {torque}" in robust
    assert not any("keys of the gears" in said for said in outcome.answer.sentences)


@pytest.mark.long
def test_the_map_holds_the_design_load(outcome):
    rows = columns(outcome, "flank_map_I")
    assert set(rows["load [N]"].tolist()) == {900.0, 1800.0}
    assert np.unique(rows["over_face [um]"]).tolist() == pytest.approx([-12.0, -6.0, 0.0, 6.0, 12.0])
    here = (rows["relief"] == "exact topography") & (rows["over_face [um]"] == 0.0)
    # at as many roll positions as a search has, a fourth of those of what is stated
    left = value(outcome, "exact_topography.te_peak_to_peak")
    assert abs(rows["te_peak_to_peak [um]"][here & (rows["load [N]"] == 1800.0)][0] - left.value) < 2.0 * left.error


def load_distribution(cache, folder, *overrides):
    """Transmission error of a case with reliefs of its own."""
    case = folder / "again.toml"
    case.write_text(CASE.read_text().replace('"flank-design"', '"load-distribution"'))
    found = ran(cache, "effects.relief=true", *overrides, path=case, result="load-distribution")
    return columns(found, "load_distribution_roll_I")["te [um]"]


@pytest.mark.long
@pytest.mark.parametrize("on", ["driver", "both"])
def test_its_topography_is_read_back_by_a_case(cache, outcome, tmp_path, on):
    overrides = []
    for gear, member in (("pinion", "driver"), ("wheel", "driven")):
        if on == "both":
            points = topography_points(outcome.data, member, gear, 0.5)
            (found,) = replace(TOPOGRAPHY, each=None).tables(Seen(None, name="I", one=points))
        elif gear == "pinion":
            found = table(outcome, "flank_topography_I_pinion")
        else:
            continue
        path = write_table(tmp_path, found)
        overrides.append(f'gear.{gear}.topography.file="{path.name}"')
    te = load_distribution(cache, tmp_path, *overrides)
    wanted = columns(outcome, "flank_design_roll_I")["te_exact_topography [um]"]
    np.testing.assert_allclose(te, wanted, atol=1e-4)


@pytest.mark.long
def test_its_keys_grind_what_it_says(cache, outcome, tmp_path):
    design, pair = outcome.data.design, outcome.data.pair
    for label in ("robust", "profile-lead-and-bias"):
        keys = keys_of(design.found[label].relief, pair, {"driver": "pinion", "driven": "wheel"})
        assert keys
        te = load_distribution(cache, tmp_path, *(key.replace(" = ", "=", 1) for key in keys))
        wanted = columns(outcome, "flank_design_roll_I")[f"te_{label.replace('-', '_')} [um]"]
        np.testing.assert_allclose(np.ptp(te), np.ptp(wanted), atol=2e-3)
        if label in {state.label for state in design.chosen}:
            assert any(keys[0] in remark for remark in outcome.remarks)


@pytest.mark.parametrize(
    ("override", "key"),
    [
        ('flank_design.pair="J"', "flank_design.pair"),
        ('flank_design.length="90 mm"', "flank_design.length"),
        ("flank_design.contact_ratio=0.9", "length"),
        ('flank_design.centre="20 mm"', "flank_design.centre"),
        ('flank_design.end_length="7 mm"', "flank_design.end_length"),
        ('flank_design.grid={tip_amounts=["5 um"]}', "tip_amounts"),
        pytest.param("flank_design.largest_face_load_factor=1.001", "largest_face_load_factor", marks=pytest.mark.long),
    ],
)
def test_what_cannot_be_is_refused(cache, override, key):
    with pytest.raises(InputError, match=key):
        ran(cache, override)


def test_a_plane_pair_is_sent_to_relief(cache):
    spur = [f"gear.{g}.{k}" for g in ("pinion", "wheel") for k in ('helix_angle="0 deg"', 'hand="spur"')]
    with pytest.raises(InputError, match="solid"):
        ran(cache, *spur)


def fresh(outcome, cache, panels):
    """The pair at 192 evenly spread roll positions and other panels than any search had."""
    scene = read_scene(CASE, [*COARSE, f"load_distribution.panels={panels}", 'results=["load-distribution"]'])
    flanks = run_plan(scene, make_plan(scene, STAGES), cache=cache).outcomes[Task("load-distribution", "I")].data.flanks
    pair, task = flanks.pair, outcome.data.design.task
    lines = lines_at(pair, pair.x_start + pair.base_pitch * (np.arange(192) + 0.37) / 192, flanks.panel * 3e-3)
    known = flank_compliance(pair, flanks.gears, lines, task.load)
    return FlankTrials(pair, known, np.zeros(lines.x.shape), np.array([task.load]))


@pytest.mark.long
@pytest.mark.parametrize("panels", [5, 13])
def test_what_is_stated_holds_where_no_search_looked(outcome, cache, panels):
    """Positions, panels and 400 draws of the misalignment of their own."""
    trials, design = fresh(outcome, cache, panels), outcome.data.design
    drawn = np.random.default_rng(3).normal(scale=design.task.deviation, size=400)
    over = replace(trials, scatter=Scatter(drawn, np.full(drawn.size, 1.0 / drawn.size)))
    for state in (design.best, *design.robust):
        found = trials.of_numbers(state.relief.numbers)
        for key, number in (
            ("peak_to_peak", state.judged.peak_to_peak), ("face_load_factor", state.judged.face_load_factor),
        ):  # fmt: skip
            assert abs(float(getattr(found, key)[0, 0]) - number.value) < 1.5 * number.error, key
        left = over.of_numbers(state.relief.numbers).peak_to_peak[:, 0]
        mean, most = state.judged.mean_over_scatter, state.judged.most_over_scatter
        assert abs(left.mean() - mean.value) < 2.0 * left.std() / np.sqrt(left.size) + mean.error
        # of 400 draws 20 exceed it, give or take two standard deviations
        exceeding = [(left > most.value + sign * most.error).sum() for sign in (-1.0, 1.0)]
        assert exceeding[1] <= 29
        assert exceeding[0] >= 11
