"""Deviations drawn inside tolerances: bits, bounds, statistics, and what comes of single draws."""

import math
from dataclasses import replace
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.built.tolerances import limits_of, untold
from fegear.case.reading import build_scene
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.formula_root_stress import formula_root_stress
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.design.robustness import tolerance_draws
from fegear.design.robustness.deviated_pair import OUTCOMES, bench, deviated, drawn_outcomes, loaded, quadrature
from fegear.design.robustness.draw_statistics import influences, percentile, sure_of_less, together
from fegear.design.robustness.tolerance_draws import NO_LIMITS, Limits, ProfileDeviation, draw, unit_points
from fegear.design.tip_relief.robust import _trials, robust_tip_relief
from fegear.engine.executor import Executor
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.rack import BasicRack
from fegear.results.catalogue import STAGES
from fegear.results.relief.tolerance_benches import set_up
from fegear.results.relief.tolerance_robustness import TOLERANCE_ROBUSTNESS

LIMITS = Limits(20e-6, (7e-6, 8e-6), (9e-6, 9e-6), (0.0, 0.0), (9e-6, 10e-6))
LOAD = 2000.0


@cache
def small_bench(*, corners=False):
    """A pair by closed forms, quick to set up."""
    rack = BasicRack(1.0, 1.25, 0.25)
    a, b = (
        Gear(Tooth(z, rack, profile_shift=x, thickness_allowance=0.02), 3e-3, r, 10e-3)
        for z, x, r in ((23, 0.3, 15e-3), (57, -0.1, 40e-3))
    )
    pair = GearPair(a, b)
    compliance = PairCompliance(pair, *(closed_form_compliance(g, "weber-banaschek") for g in (a, b)), coupling=False)
    ends = [sorted(float(pair.radius(x, m)) for x in (pair.x_start, pair.x_end)) for m in MEMBERS]
    if corners:
        ends = [[g.form_radius, g.involute_tip_radius] for g in (a, b)]
    roots = [formula_root_stress(g, "iso-6336-3", *end) for g, end in zip((a, b), ends, strict=True)]
    return bench(Engagement(compliance, corner_contact=corners), LOAD, (roots[0], roots[1]))


def drawn(count, limits=LIMITS, seed=1, **how):
    return draw(limits, count, seed, small_bench().teeth, **how)


def test_first_draws_stay_when_more_are_asked_for():
    few, many = drawn(17), drawn(200)
    for name in few.__dataclass_fields__:
        assert np.array_equal(getattr(few, name), getattr(many, name)[:17])


def test_leaving_a_kind_out_changes_no_other():
    without = drawn(32, replace(LIMITS, pitch=(0.0, 0.0), centre_distance=0.0))
    whole = drawn(32)
    assert np.array_equal(without.profile_slope, whole.profile_slope)
    assert np.array_equal(without.phase, whole.phase)
    assert not without.pitch.any()
    assert not without.centre_distance.any()


@pytest.mark.parametrize("sequence", ["sobol", "halton", "random"])
def test_another_seed_gives_other_draws(sequence):
    assert not np.array_equal(unit_points(8, 5, 1, sequence), unit_points(8, 5, 2, sequence))
    assert np.array_equal(unit_points(8, 5, 1, sequence), unit_points(8, 5, 1, sequence))


def test_draws_fill_their_distributions():
    """Against the closed forms: T/sqrt(3) for even draws; for normal ones cut at 3 sigma, .9866 sigma."""
    for distribution, spread in (("uniform", 1.0 / math.sqrt(3.0)), ("normal", 0.98658 / 3.0)):
        found = drawn(4096, distribution=distribution)
        for values, limit in (
            (found.centre_distance, 20e-6),
            (found.profile_slope[:, 1], 8e-6),
            (found.pitch[:, 0, 1], 9e-6),
        ):
            assert np.abs(values).max() <= limit
            assert np.abs(values).max() > 0.9 * limit
            assert values.std() == pytest.approx(spread * limit, rel=3e-3)
            assert abs(values.mean()) < 2e-3 * limit


def test_waves_and_their_phases_are_even_over_what_they_may_be():
    found, (low, high) = drawn(4096), tolerance_draws._WAVES
    for values, first, last in ((found.waves, low, high), (found.phase, 0.0, 2.0 * math.pi)):
        assert values.shape == (4096, 2)
        assert first <= values.min() < first + 1e-2 * (last - first)
        assert last - 1e-2 * (last - first) < values.max() <= last
        assert values.mean(axis=0) == pytest.approx(np.full(2, 0.5 * (first + last)), rel=5e-3)
    columns = [found.profile_slope[:, 0], found.profile_form[:, 0], found.helix_slope[:, 1]]
    columns += [found.waves[:, 0], found.phase[:, 1]]
    columns = [one for one in columns if np.ptp(one) > 0.0]
    assert np.abs(np.corrcoef(columns) - np.eye(len(columns))).max() < 0.02  # each has numbers of its own


def test_pitch_tolerances_are_those_along_the_line_of_action():
    from fegear.case.built.tolerances import limits_of
    from fegear.case.reading import read_scene
    from fegear.formulas.iso1328 import tolerances_of

    cases = Path(__file__).parents[2] / "cases"
    scene = read_scene(cases / "robust_pair.toml", ["gear.wheel.tolerance_class=9"])
    found = limits_of(scene, "I", ("pitch",))
    arcs = [tolerances_of(scene.gears[name], grade).single_pitch for name, grade in (("pinion", 6), ("wheel", 9))]
    assert found.pitch == pytest.approx([arc * math.cos(math.radians(20.0)) for arc in arcs], rel=1e-12)
    assert limits_of(scene, "I", ("profile-slope",)).pitch == (0.0, 0.0)


def test_pitches_add_up_to_positions():
    one = draw(LIMITS, 3, 1, 4)
    place = one.spacing(2, 1, 57)
    f = one.pitch[2, 1]
    assert place[0] == 0.0
    assert place[1] == pytest.approx(f[1])
    assert place[2] == pytest.approx(f[1] + f[3])
    assert place[-1] == pytest.approx(-f[0])
    assert place[-2] == pytest.approx(-f[0] - f[2])
    # fp between teeth k and k + 1 is what their positions differ by
    assert place[0] - place[-1] == pytest.approx(f[0])
    assert np.count_nonzero(one.spacing(2, 1, 5)) <= 4  # a gear of five teeth has no more


def test_profile_deviation_has_its_slope_and_its_band():
    off = ProfileDeviation(0.3, 0.7, 6e-6, 0.0, 2.0, 0.0)
    assert off.removal([0.3, 0.5, 0.7]) == pytest.approx([3e-6, 0.0, -3e-6])  # positive: stands out at the tip
    assert off.removal([0.0, 1.0]) == pytest.approx([3e-6, -3e-6])
    wave = ProfileDeviation(0.3, 0.7, 0.0, 6e-6, 2.0, 1.0).removal(np.linspace(0.3, 0.7, 2001))
    assert np.ptp(wave) == pytest.approx(6e-6, rel=1e-5)


def test_no_tolerance_is_the_nominal_pair_to_the_last_bit():
    table = small_bench()
    nominal = drawn_outcomes(table, draw(NO_LIMITS, 1, 5, table.teeth)).values[0]
    zero = drawn_outcomes(table, drawn(4, NO_LIMITS, seed=9)).values
    assert (zero == nominal).all()
    assert np.isfinite(nominal).all()


@pytest.mark.parametrize("corners", [False, True])
def test_each_draw_has_the_same_bits_in_any_company(corners):
    table = small_bench(corners=corners)
    some = draw(LIMITS, 6, 1, table.teeth)
    whole = drawn_outcomes(table, some).values
    assert not np.isnan(whole).any()
    for size in (1, 4):
        parts = [drawn_outcomes(table, some.rows(slice(k, k + size))).values for k in range(0, 6, size)]
        assert np.array_equal(np.concatenate(parts), whole)


def test_pitch_error_of_the_only_tooth_in_contact_adds_to_the_transmission_error():
    """Single contact: the flank that lies back by e makes the driven gear lag by e, whatever the teeth give way."""
    table = small_bench()
    pair, none = table.engagement.pair, draw(NO_LIMITS, 1, 0, table.teeth)
    x = np.linspace(pair.x_lpstc, pair.x_hpstc, 9)[1:-1]
    plain = loaded(deviated(table, none, 0), LOAD, x)
    assert ((plain.loads > 0.0).sum(axis=0) == 1).all()
    pitch = none.pitch.copy()
    pitch[0, :, 1] = 4e-6, -1e-6  # between teeth 0 and 1 of driver and driven gear
    state = loaded(deviated(table, replace(none, pitch=pitch), 0), LOAD, x)
    moved = dict(zip(state.cycles.tolist(), (state.transmission_error - plain.transmission_error).T, strict=True))
    assert moved[0] == pytest.approx(np.zeros(x.size), abs=1e-20)  # teeth 0 alone
    assert moved[1] == pytest.approx(np.full(x.size, 3e-6), abs=1e-19)  # teeth 1 alone


def test_quadrature_spans_the_base_pitch_of_the_deviated_pair():
    table = small_bench()
    e = deviated(table, drawn(3), 1)
    points = quadrature(e, table.engagement)
    assert points.weights.sum() == pytest.approx(e.pair.base_pitch, rel=1e-12)
    assert e.pair.centre_distance != table.engagement.pair.centre_distance


def test_percentiles_and_their_intervals():
    values = np.arange(1.0, 101.0)
    found = percentile(values, 50.0)
    assert found.value == pytest.approx(50.5)
    assert (found.low, found.high) == (40.0, 61.0)  # numbers 40 and 61 of 100: textbook 95 % interval of the median
    assert percentile(np.append(values, np.nan), 50.0) == found
    few = percentile(values[:10], 95.0)
    assert few.high == np.inf  # ten draws bound no 95th percentile from above


def test_intervals_cover_the_truth_as_often_as_they_say():
    """Brute force over 400 samples: at least 95 %, at most 98.5 % since order statistics are few."""
    generator = np.random.Generator(np.random.MT19937(3))
    truth = 1.6448536269514722
    hits = 0
    for _ in range(400):
        p = percentile(generator.standard_normal(200), 95.0)
        hits += p.low <= truth <= p.high
    assert 0.93 < hits / 400 < 0.99


def test_influence_of_a_known_law():
    """y = a + 2 b^2: shares 1/12 and 4 x 4/45 of the variance; b acts alike to both sides."""
    generator = np.random.Generator(np.random.MT19937(1))
    a, b, c = generator.uniform(-1.0, 1.0, (3, 20000))
    found = influences([a, b, c, np.zeros(20000)], a + 2.0 * b**2)
    whole = 1.0 / 3.0 + 4.0 * 4.0 / 45.0
    assert found[0].share == pytest.approx(1.0 / 3.0 / whole, abs=0.02)
    assert found[1].share == pytest.approx(16.0 / 45.0 / whole, abs=0.02)
    assert abs(found[2].share) < 0.005
    assert [one.resolved for one in found] == [True, True, False, False]
    assert abs(found[1].rank_correlation) < 0.03 < found[0].rank_correlation
    assert found[3].rank_correlation == found[3].share == 0.0


@pytest.mark.parametrize("count", [200, 2000])
def test_shares_are_within_their_errors_and_what_is_left_is_that_of_interactions(count):
    """y = a b + c / 5: a and b change nothing alone, 1/9 of 1/9 + 1/75 is theirs together."""
    generator, true = np.random.Generator(np.random.MT19937(5)), np.array([0.0, 0.0, 0.12 / 1.12, 1.0 / 1.12])
    off = []
    for _ in range(100):
        a, b, c = generator.uniform(-1.0, 1.0, (3, count))
        found = influences([a, b, c], a * b + c / 5.0)
        share, error = np.transpose([*((one.share, one.error) for one in found), together(found)])
        off.append((share - true) / error)
    assert np.mean(np.abs(off) < 2.0) == pytest.approx(0.95, abs=0.03)
    assert np.abs(np.mean(off, axis=0)).max() < 0.4
    assert np.std(off, axis=0) == pytest.approx(1.0, abs=0.3)


@pytest.mark.parametrize(("count", "classes"), [(39, 1), (40, 2), (399, 19), (420, 20), (4000, 20)])
def test_shares_follow_from_classes_of_twenty_draws_or_more_and_twenty_at_most(count, classes):
    """Kelley's epsilon^2, by a table of its own."""
    generator = np.random.Generator(np.random.MT19937(8))
    a = generator.uniform(-1.0, 1.0, count)
    y = a + generator.uniform(-1.0, 1.0, count)
    (found,) = influences([a], y)
    if classes < 2:
        assert np.isnan(found.share)
        return
    groups = np.array_split(y[np.argsort(a)], classes)
    within = sum(((one - one.mean()) ** 2).sum() for one in groups) / (count - classes)
    assert found.share == pytest.approx(1.0 - within * (count - 1) / ((y - y.mean()) ** 2).sum(), rel=1e-9)


def test_a_seed_of_two_numbers_is_another_sequence():
    one, other = unit_points(64, 5, 1), unit_points(64, 5, (1, 1))
    assert not set(one.ravel().tolist()) & set(other.ravel().tolist())


def test_paired_draws_tell_a_small_difference():
    generator = np.random.Generator(np.random.MT19937(2))
    values = generator.standard_normal(500)
    here, there, sure = sure_of_less(values - 0.01, values, 95.0)
    assert there - here == pytest.approx(0.01)
    assert sure == 1.0


@pytest.mark.dear
def test_quasi_random_and_another_generator_agree_within_their_intervals():
    table = small_bench()
    quasi = drawn_outcomes(table, drawn(60)).values
    plain = drawn_outcomes(table, drawn(60, seed=11, sequence="random")).values
    for k, name in enumerate(OUTCOMES):
        for percent in (5.0, 50.0, 95.0):
            one, other = percentile(quasi[:, k], percent), percentile(plain[:, k], percent)
            slack = 1e-9 * abs(one.value)
            assert one.low - slack <= other.high, (name, percent)
            assert other.low - slack <= one.high, (name, percent)


@pytest.mark.dear
def test_nothing_on_the_grid_is_better_than_the_relief_found():
    """Every combination by exact load sharing over the same draws."""
    table, some = small_bench(), drawn(20)
    amounts, lengths = (6e-6, 14e-6), (0.3, 0.6)
    found = robust_tip_relief(table, some, (10e-6, 0.4, 10e-6, 0.4), amounts=amounts, lengths=lengths, percent=90.0)
    trials = _trials(table, some, 1.0, 90.0)
    each = [(0.0, 0.3), *((a, n) for a in amounts for n in lengths)]
    least = min(trials.exact((*one, *other)) for one in each for other in each)
    assert found.candidates == 25
    assert found.left <= least * (1.0 + 1e-12)
    assert found.left <= found.nominal_left
    assert found.left == trials.exact(found.numbers)


@pytest.mark.parametrize("named", [{"lengths": (0.3, 0.6)}, {"amounts": (14e-6,)}], ids=["no amounts", "no lengths"])
def test_amounts_and_lengths_that_nobody_names(named):
    """Eight amounts up to three mean transmission errors, lengths from a tenth of the path to 0.7, and no relief."""
    table, some = small_bench(), drawn(3)
    found = robust_tip_relief(table, some, (10e-6, 0.4, 10e-6, 0.4), percent=90.0, **named)
    trials = _trials(table, some, 1.0, 90.0)
    mean = float(trials.base.min(axis=0).mean())
    amounts = named.get("amounts", [a * mean * 3.0 / 8.0 for a in range(1, 9)])
    lengths = named.get("lengths", [0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7])
    each = [(0.0, lengths[0]), *((a, n) for a in amounts for n in lengths)]
    one, other = ([np.float32(a) * trials.form(gear, n) for a, n in each] for gear in (0, 1))
    least = min(trials.left(trials.base + a + b) for a in one for b in other)
    assert found.candidates == len(each) ** 2
    assert found.on_grid == pytest.approx(least, rel=1e-5)
    assert found.draws == 3


@pytest.mark.parametrize("rooms", [(20e-6, 12e-6), (9e-6, 30e-6)])
def test_no_relief_is_deeper_than_either_tooth_has_room_for(rooms, monkeypatch):
    """A tenth of the module as a rule; pointed teeth have less."""
    table, some = small_bench(), drawn(3)
    named = {"amounts": (50e-6,), "lengths": (0.3, 0.6), "percent": 90.0}
    of = dict(zip(MEMBERS, rooms, strict=True))
    monkeypatch.setattr("fegear.design.tip_relief.robust._room", lambda _, member: of[member])
    found = robust_tip_relief(table, some, (5e-6, 0.4, 5e-6, 0.4), **named)
    trials = _trials(table, some, 1.0, 90.0)
    each = [(0.0, 0.3), *((min(rooms), n) for n in (0.3, 0.6))]
    least = min(trials.quick((*one, *other)) for one in each for other in each)
    assert found.on_grid == pytest.approx(least, rel=1e-5)
    assert max(found.numbers[::2]) <= min(rooms)


CASE = {
    "results": ["robustness"],
    "gear": {
        name: {
            "teeth": teeth, "module": "3 mm", "profile_shift": shift, "face_width": "10 mm", "tolerance_class": 6,
            "thickness_allowance": "50 um",
        }
        for name, teeth, shift in (("pinion", 23, 0.3), ("wheel", 57, -0.1))
    },
    "pair": {
        "I": {
            "driver": "pinion", "driven": "wheel", "torque": "90 N*m", "compliance": {"source": "weber-banaschek"},
            "root_stress": {"source": "iso-6336-3"},
        }
    },
    "effects": {"hertz": "load-dependent"},
    "robustness": {"draws": 30, "centre_distance": "20 um"},
}  # fmt: skip


def run(case, cache=None, executor=None):
    scene = build_scene(case, "case", None)
    return run_plan(
        scene, make_plan(scene, STAGES), cache=cache or SolutionCache(), executor=executor or Executor(here=True)
    )


@pytest.mark.dear
def test_a_draw_is_an_ordinary_case_with_its_deviations_written_down():
    """Relief tables, spacing errors and centre distance of a draw, by the results that know nothing of draws."""
    results = run(CASE)
    data = next(one.data for task, one in results.outcomes.items() if task.stage == "tolerance-robustness")
    d, row = data.deviations, 4
    scene = build_scene(CASE, "case", None)
    pair = scene.pairs["I"]
    case = {**CASE, "results": ["transmission-error", "load-sharing", "root-stress-history"]}
    case["effects"] = {"hertz": "load-dependent", "relief": True, "spacing_errors": True}
    case["gear"] = {name: dict(part) for name, part in CASE["gear"].items()}
    case["pair"] = {
        "I": CASE["pair"]["I"] | {"centre_distance": f"{pair.centre_distance + d.centre_distance[row]:.17g} m"}
    }
    for i, (name, member) in enumerate(zip(("pinion", "wheel"), MEMBERS, strict=True)):
        low, high = sorted(float(pair.roll_angle(x, member)) for x in (pair.x_start, pair.x_end))
        off = ProfileDeviation(
            low, high, d.profile_slope[row, i], d.profile_form[row, i], d.waves[row, i], d.phase[row, i]
        )
        rolls = np.linspace(low, high, 41)
        case["gear"][name]["relief"] = {"table": {
            "roll_angles": [f"{t:.17g} rad" for t in rolls], "removals": [f"{m:.17g} m" for m in off.removal(rolls)],
            "interpolation": "cubic",
        }}  # fmt: skip
        case["gear"][name]["spacing_errors"] = [f"{v:.17g} m" for v in d.spacing(row, i, scene.gears[name].teeth)]
    found = {value.name: value.si for value in run(case).values}
    mine = dict(zip(OUTCOMES, data.values["as in the case"][row], strict=True))
    assert mine["te_mean"] == pytest.approx(found["I.te_mean"], rel=1e-4)
    assert mine["te_peak_to_peak"] == pytest.approx(found["I.te_peak_to_peak"], rel=3e-3)
    assert mine["te_harmonic_1"] == pytest.approx(found["I.te_first_harmonic"], rel=3e-3)
    assert mine["driver_root_tension"] == pytest.approx(found["I.driver.largest_root_tension"], rel=3e-3)
    assert mine["driven_root_tension"] == pytest.approx(found["I.driven.largest_root_tension"], rel=3e-3)
    assert mine["hertz_pressure"] == pytest.approx(found["I.largest_hertz_pressure"], rel=3e-3)
    assert mine["largest_load"] == pytest.approx(found["I.largest_load"], rel=1e-9)


def test_teeth_too_small_for_a_class_are_refused_under_the_name_of_their_module():
    own = {"base_pitch": "3 um", "profile_form": "2 um", "helix_slope": "4 um"}
    small = {name: part | {"module": "0.4 mm", "deviations": own} for name, part in CASE["gear"].items()}
    scene = build_scene(CASE | {"gear": small}, "case", None)
    with pytest.raises(InputError) as refused:
        limits_of(scene, "I", ("profile-slope",))
    assert refused.value.key == "gear.pinion.module"


def test_own_deviations_take_the_place_of_those_by_class_when_drawn():
    """Each for itself; of a gear too small for ISO 1328-1 nothing else is asked, and one without a class says so."""
    kinds = ("profile-slope", "profile-form", "pitch")
    own = {"base_pitch": "3 um", "profile_form": "2 um"}
    case = CASE | {"gear": {"pinion": CASE["gear"]["pinion"] | {"deviations": own}, "wheel": CASE["gear"]["wheel"]}}
    plain, mine = (limits_of(build_scene(one, "case", None), "I", kinds) for one in (CASE, case))
    assert mine.pitch == (pytest.approx(3e-6), plain.pitch[1])
    assert mine.profile_form == (pytest.approx(2e-6), plain.profile_form[1])
    assert mine.profile_slope == plain.profile_slope
    assert untold(build_scene(case, "case", None), ("pinion", "wheel"), kinds) == ()
    # without a class: what it says is drawn, the rest is told; with one, of a face below 4 mm, the rest is asked for
    lone = {key: value for key, value in case["gear"]["pinion"].items() if key != "tolerance_class"}
    scene = build_scene(case | {"gear": case["gear"] | {"pinion": lone}}, "case", None)
    assert limits_of(scene, "I", kinds).profile_slope == (0.0, plain.profile_slope[1])
    (said,) = untold(scene, ("pinion", "wheel"), kinds)
    assert "no profile_slope specified in its deviations" in said
    narrow = case["gear"]["pinion"] | {"face_width": "3 mm", "deviations": own | {"helix_slope": "4 um"}}
    scene = build_scene(case | {"gear": case["gear"] | {"pinion": narrow}}, "case", None)
    with pytest.raises(InputError, match=r"specify profile_slope of gear\.pinion\.deviations"):
        limits_of(scene, "I", kinds)
    narrow["deviations"] = narrow["deviations"] | {"profile_slope": "1 um"}
    scene = build_scene(case | {"gear": case["gear"] | {"pinion": narrow}}, "case", None)
    assert limits_of(scene, "I", kinds).profile_slope[0] == pytest.approx(1e-6)


WIDE = {
    "results": ["robustness"],
    "gear": {
        name: {
            "teeth": teeth, "module": "3 mm", "face_width": "8 mm", "tolerance_class": 6, "bore_radius": "18 mm",
            "thickness_allowance": "50 um",
        }
        for name, teeth in (("pinion", 20), ("wheel", 24))
    },
    "pair": {"I": {"driver": "pinion", "driven": "wheel", "load": "2 kN", "width": "slices"}},
    "load_distribution": {"positions": 4, "panels": 6},
    "effects": {"neighbour_coupling": True, "hertz": "load-dependent"},
    "accuracy": {"tolerance": 0.1},
    "robustness": {"draws": 25},
}  # fmt: skip


@pytest.mark.long
def test_a_draw_over_the_face_is_an_ordinary_case_with_its_deviations_written_down():
    """Leads, relief tables, spacing errors, centre distance of a draw, by load-distribution; none is the nominal pair.

    Between solved centre distances results are laid straight: within 5e-4, for a change of 3e-3.
    """
    cache = SolutionCache()
    drawn_too = {**WIDE, "robustness": WIDE["robustness"] | {"centre_distance": "30 um"}}
    data = next(
        one.data for task, one in run(drawn_too, cache).outcomes.items() if task.stage == "tolerance-robustness"
    )
    assert (np.ptp(data.values["as in the case"], axis=0) > 0.0).all()
    d, row = data.deviations, 7
    scene = build_scene(WIDE, "case", None)
    pair = scene.pairs["I"]
    case = {**WIDE, "results": ["load-distribution", "root-stress-history"]}
    case["effects"] = WIDE["effects"] | {"relief": True, "spacing_errors": True}
    case["gear"] = {name: dict(part) for name, part in WIDE["gear"].items()}
    moved = pair.centre_distance + d.centre_distance[row]
    case["pair"] = {"I": WIDE["pair"]["I"] | {"centre_distance": f"{moved:.17g} m"}}
    for i, (name, member) in enumerate(zip(("pinion", "wheel"), MEMBERS, strict=True)):
        low, high = sorted(float(pair.roll_angle(x, member)) for x in (pair.x_start, pair.x_end))
        rolls = np.linspace(low, high, 41)
        slope, form = d.profile_slope[row, i], d.profile_form[row, i]
        removed = ProfileDeviation(low, high, slope, form, d.waves[row, i], d.phase[row, i]).removal(rolls)
        case["gear"][name]["relief"] = {"table": {
            "roll_angles": [f"{t:.17g} rad" for t in rolls], "removals": [f"{m:.17g} m" for m in removed],
            "interpolation": "cubic",
        }}  # fmt: skip
        case["gear"][name]["lead"] = {"slope": f"{d.helix_slope[row, i]:.17g} m"}
        case["gear"][name]["spacing_errors"] = [f"{v:.17g} m" for v in d.spacing(row, i, scene.gears[name].teeth)]
    found = {value.name: value.si for value in run(case, cache).values}
    mine = dict(zip(data.outcomes, data.values["as in the case"][row], strict=True))
    # A lead slope takes nothing from end I and all from end II: half of it more in the middle than the deviation.
    assert mine["te_mean"] + 0.5 * d.helix_slope[row].sum() == pytest.approx(found["I.te_mean"], rel=1e-4)
    assert mine["te_peak_to_peak"] == pytest.approx(found["I.te_peak_to_peak"], rel=2e-3)
    assert mine["face_load_factor"] == pytest.approx(found["I.K_Hbeta"], rel=5e-4)
    assert mine["hertz_pressure"] == pytest.approx(found["I.largest_hertz_pressure"], rel=5e-4)
    assert mine["largest_line_load"] == pytest.approx(found["I.largest_line_load"], rel=5e-4)
    plain = {value.name: value.si for value in run({**WIDE, "results": case["results"]}, cache).values}
    nominal = dict(zip(data.outcomes, data.nominal["as in the case"], strict=True))
    assert nominal["face_load_factor"] == plain["I.K_Hbeta"]
    assert nominal["hertz_pressure"] == plain["I.largest_hertz_pressure"]
    for member in MEMBERS:
        key = f"I.{member}.largest_root_tension"
        assert nominal[f"{member}_root_tension"] == pytest.approx(plain[key], rel=1e-9)
        assert mine[f"{member}_root_tension"] == pytest.approx(found[key], rel=5e-4)


@pytest.mark.long
def test_processes_draw_the_same_bits_over_the_face():
    case = {**WIDE, "robustness": {"draws": 520}}
    cache = SolutionCache()
    here, there = run(case, cache), run(case, executor=Executor(workers=2))
    for one, other in zip(here.tables, there.tables, strict=True):
        for mine, theirs in zip(one.columns, other.columns, strict=True):
            assert np.array_equal(mine.si, theirs.si, equal_nan=mine.si.dtype.kind == "f"), mine.name


def test_draws_that_are_finished_are_not_drawn_again(tmp_path):
    from fegear.base.solution_cache import cache_on_disk

    few = run(CASE, cache_on_disk(tmp_path))
    done = sorted(tmp_path.rglob("*.entry"))
    more = run({**CASE, "robustness": {**CASE["robustness"], "draws": 50}}, cache_on_disk(tmp_path))
    assert len(sorted(tmp_path.rglob("*.entry"))) == len(done) + 1  # the first 25 draws are recalled, 26 to 50 are new
    before, after = (next(table for table in one.tables if table.name == "robustness_draws_I") for one in (few, more))
    assert np.array_equal(before["te_peak_to_peak"], after["te_peak_to_peak"][:30])


@pytest.mark.parametrize(
    ("change", "key"),
    [
        ({"robustness": {"pair": "II"}}, "robustness.pair"),
        ({"robustness": {"deviations": ["helix-slope"]}}, "robustness.deviations"),
        ({"robustness": {"centre_distance": "500 um"}}, "robustness.centre_distance"),
        ({"robustness": {"deviations": ["centre-distance"]}}, "robustness"),
        ({"robustness": {"draws": 5}}, "robustness.draws"),
    ],
)
def test_what_cannot_be_drawn_is_refused(change, key):
    with pytest.raises(InputError) as refused:
        run({**CASE, **change})
    assert refused.value.key == key


@pytest.mark.parametrize("part", [{"centre_distance": "500 um"}, {"reliefs": {}}])
def test_what_is_not_drawn_over_the_face_is_refused(part):
    with pytest.raises(InputError) as refused:
        run({**WIDE, "robustness": part})
    assert refused.value.key == f"robustness.{next(iter(part))}"


@pytest.mark.dear
@pytest.mark.parametrize("draws", [60, pytest.param(400, marks=pytest.mark.long)])
def test_a_stated_percentile_of_a_relief_is_that_of_draws_of_one_s_own(draws):
    """Plain Monte Carlo of another seed; half the 95 % interval is 1.96 standard errors, and so has one's own."""
    case = {**CASE, "robustness": {**CASE["robustness"], "draws": draws}}
    case["robustness"]["reliefs"] = {"draws": 20, "amounts": ["6 um", "14 um"], "lengths": [0.3, 0.6]}
    results = run(case)
    asked = TOLERANCE_ROBUSTNESS.inputs(results.scene, "I")
    own = set_up(asked, {task: outcome.data for task, outcome in results.outcomes.items()})
    found = results.outcomes[Task("tolerance-robustness", "I")].data
    tips = replace(own.engagement, driver_relief=found.relief.driver, driven_relief=found.relief.driven)
    fresh = draw(asked.limits, draws, 12345, own.teeth, "random")
    values = drawn_outcomes(replace(own, engagement=tips), fresh).values[:, 0]
    for percent in (50.0, 95.0) if draws > 73 else (50.0,):
        mine, stated = (percentile(v, percent) for v in (values, found.values["best percentile"][:, 0]))
        errors = [0.5 * (p.high - p.low) / 1.96 for p in (mine, stated)]
        assert abs(mine.value - stated.value) < 2.0 * np.hypot(*errors), percent
    searched = draw(asked.limits, 20, (asked.part.seed, 1), own.teeth).centre_distance
    assert not set(searched) & set(found.deviations.centre_distance)


@pytest.mark.long
@pytest.mark.parametrize("workers", [1, 2, 3])
def test_processes_draw_the_same_bits(workers):
    case = {**CASE, "robustness": {**CASE["robustness"], "draws": 150, "reliefs": {"draws": 40}}}
    case["effects"] = {"hertz": "load-dependent", "corner_contact": True}
    here, there = run(case), run(case, executor=Executor(workers=workers))
    for one, other in zip(here.tables, there.tables, strict=True):
        for mine, theirs in zip(one.columns, other.columns, strict=True):
            assert np.array_equal(mine.si, theirs.si, equal_nan=mine.si.dtype.kind == "f"), mine.name


@pytest.mark.long
def test_a_dask_cluster_draws_the_same_bits():
    distributed = pytest.importorskip("distributed")
    case = {**CASE, "robustness": {**CASE["robustness"], "draws": 150}}
    with distributed.LocalCluster(n_workers=2, threads_per_worker=1, processes=True, dashboard_address=None) as cluster:
        there = run(case, executor=Executor(scheduler=cluster.scheduler_address))
    here = run(case)
    for one, other in zip(here.tables, there.tables, strict=True):
        for mine, theirs in zip(one.columns, other.columns, strict=True):
            assert np.array_equal(mine.si, theirs.si, equal_nan=mine.si.dtype.kind == "f"), mine.name
