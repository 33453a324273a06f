"""Keys of double helical pairs: what a case becomes, what is refused in one sentence, numbers of both halves."""

import copy
import math
from functools import cache
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import FegearError
from fegear.base.solution_cache import SolutionCache
from fegear.case.built.double_helical import double_to_load
from fegear.case.reading import build_scene
from fegear.contact.double_helical.double_spec import mirrored
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.results.catalogue import STAGES
from fegear.results.helical.double_helical_data import DoubleHelicalData, ShownDouble

HERE = Path(__file__).parent
CACHE = SolutionCache()


def gear(teeth, hand, **more):
    return {
        "teeth": teeth, "normal_module": "3 mm", "pressure_angle": "20 deg", "helix_angle": "20 deg", "hand": hand,
        "face_width": "9 mm", **more,
    }  # fmt: skip


def case(double=None, results=("double-helical",), pinion=None, **pair):
    return {
        "results": list(results),
        "gear": {"p": gear(20, "right", **(pinion or {})), "w": gear(31, "left")},
        "pair": {
            "I": {"driver": "p", "driven": "w", "load": "6000 N", "width": "slices",
                  "double_helical": {"floating": "none"} if double is None else double, **pair},
        },
        "effects": {"hertz": "load-dependent", "neighbour_coupling": True},
        "load_distribution": {"positions": 4, "panels": 3},
        "accuracy": {"tolerance": 0.05},
    }  # fmt: skip


def scene_of(document):
    return build_scene(document, "double", HERE)


def run(document):
    scene = scene_of(document)
    return run_plan(scene, make_plan(scene, STAGES), cache=CACHE)


def values(document):
    found = run(document)
    return {v.name: v for outcome in found.outcomes.values() for v in outcome.values}, found


@cache
def located(apex="0 um"):
    return values(case({"floating": "none", "apex_offset": apex, "gap": "10 mm"}))


def test_load_torque_and_power_are_those_of_both_halves():
    whole = scene_of(case())
    pair = whole.pairs["I"]
    part = whole.case.pair["I"]
    assert part.normal_load(pair) == pytest.approx(3000.0)
    document = case()
    del document["pair"]["I"]["load"]
    by_torque = copy.deepcopy(document)
    by_torque["pair"]["I"]["torque"] = f"{6000.0 * pair.driver.base_radius} N m"
    by_power = copy.deepcopy(document)
    by_power["pair"]["I"] |= {"power": f"{6.0 * pair.driver.base_radius * 100.0} kW", "speed": "100 rad/s"}
    for one in (by_torque, by_power):
        assert scene_of(one).case.pair["I"].normal_load(pair) == pytest.approx(3000.0)
    several = copy.deepcopy(document)
    several["pair"]["I"]["loads"] = ["2 kN", "5 kN"]
    asked = double_to_load(scene_of(several), "I")
    assert asked.spec.loads == (2000.0, 5000.0)
    assert asked.nominal == 5000.0


def test_keys_become_the_spec():
    given = {
        "gap": "12 mm", "apex_offset": "-7 um", "axial_play": "0.2 mm", "axial_force": "-40 N", "stagger": 0.25,
        "torque_in": "I",
    }  # fmt: skip
    asked = double_to_load(scene_of(case(given, speed="600 rpm")), "I")
    spec = asked.spec
    assert (spec.gap, spec.apex_offset, spec.axial_play, spec.axial_force, spec.stagger) == (
        12e-3, pytest.approx(-7e-6), pytest.approx(2e-4), -40.0, 0.25,
    )  # fmt: skip
    assert spec.floating == "driver"  # the gear with fewer teeth
    assert asked.assumed
    assert spec.twist_compliance[1] > 0.0 == spec.twist_compliance[0]  # driven at end I, its other half lags
    assert spec.halves[1] == mirrored(spec.halves[0])
    assert asked.frequency == pytest.approx(10.0 * 20)
    turned = case(given)
    turned["pair"]["I"] |= {"driver": "w", "driven": "p"}
    assert double_to_load(scene_of(turned), "I").spec.floating == "driven"


@pytest.mark.dear
def test_an_apex_offset_moves_load_by_the_axial_stiffness():
    """No float: W_1 t_1 + W_2 t_2 = k_ax q by hand, and K_gamma is twice the share of the more loaded half."""
    even, _ = located()
    moved, found = located("3 um")
    assert even["I.K_gamma"].value == pytest.approx(1.0, abs=1e-9)
    assert moved["I.apex_distance"].value == pytest.approx(3.0)
    force = -moved["I.axial_stiffness"].value * 3.0
    assert moved["I.axial_force_mean"].value == pytest.approx(force, rel=0.01)
    assert moved["I.K_gamma"].value == pytest.approx(2.0 * moved["I.share_I"].value)
    assert moved["I.share_I"].value + moved["I.share_II"].value == pytest.approx(1.0)
    assert moved["I.root_tension_driver_I"].value > moved["I.root_tension_driver_II"].value
    span = 2.0 * math.tan(scene_of(case()).pairs["I"].driver.base_helix_angle)
    uneven = (moved["I.share_I"].value - moved["I.share_II"].value) * 6000.0
    assert abs(moved["I.axial_force_mean"].value) == pytest.approx(0.5 * uneven * span, rel=1e-6)
    (answer,) = (outcome.answer for outcome in found.outcomes.values() if outcome.answer)
    assert "carries" in answer.sentences[0]
    assert "an axial force of" in answer.sentences[1]


def test_an_axial_force_that_is_only_round_off_is_zero():
    """As it was on halves of 3D gears with the same load: 1.7e-12 N, with a note on its error."""
    seat = SimpleNamespace(span=-0.6)
    pair = SimpleNamespace(
        axial_force=np.array([[1e-12], [-7e-13], [2e-13]]), load=np.array([6000.0]), spec=SimpleNamespace(seat=seat),
        mean=lambda values: values.mean(axis=0),
    )  # fmt: skip
    shown = ShownDouble(DoubleHelicalData(pair, 0, ()), math.nan)
    assert shown.axial_force_mean == shown.axial_force_peak_to_peak == 0.0
    pair.axial_force = np.array([[1e-2], [-7e-3], [3e-3]])
    assert shown.axial_force_mean == pytest.approx(2e-3)
    assert shown.axial_force_peak_to_peak == pytest.approx(0.017)


def test_a_floating_member_takes_the_offset_up_until_its_play_ends():
    free, _ = values(case({"floating": "driven", "apex_offset": "3 um"}))
    assert free["I.K_gamma"].value == pytest.approx(1.0)
    assert free["I.axial_motion_mean"].value == pytest.approx(3.0)
    assert free["I.axial_motion_peak_to_peak"].value == 0.0
    stopped, found = values(case({"floating": "driven", "apex_offset": "3 um", "axial_play": "2 um"}))
    assert stopped["I.axial_motion_mean"].value == pytest.approx(1.0)
    assert stopped["I.apex_distance"].value == pytest.approx(2.0)
    between = located("3 um")[0]["I.K_gamma"].value
    assert 1.0 < stopped["I.K_gamma"].value < between
    notes = [note for outcome in found.outcomes.values() for note in outcome.remarks]
    assert any("touches a stop of its axial play" in note for note in notes)


def test_one_half_carries_all_of_a_large_offset():
    found, ran = located("0.1 mm")
    assert found["I.K_gamma"].value == 2.0
    assert "I.K_Hbeta_II" not in found
    assert "I.root_tension_driver_II" not in found
    notes = [str(note) for outcome in ran.outcomes.values() for note in outcome.remarks]
    assert any("the half at end II carries no load" in note for note in notes)


@pytest.mark.dear
def test_each_half_is_the_helical_pair_under_half_of_the_load():
    """Results of the pair itself are those of one half."""
    half, _ = values(case(results=("load-distribution",)))
    single = case(results=("load-distribution",), load="3000 N")
    del single["pair"]["I"]["double_helical"]
    alone, _ = values(single)
    for name, value in alone.items():
        assert half[name].value == value.value, name
    notes = [str(n) for o in run(case(results=("load-distribution",))).outcomes.values() for n in o.remarks]
    assert sum("one half (end I) of a double helical pair" in note for note in notes) == 1


def test_the_halves_mirror_each_other_with_their_flanks():
    """Slope and end relief of the lead turn with the gear: located halves without offset still share evenly."""
    lead = {"slope": "6 um", "end_relief": [{"amount": "5 um", "length": "2 mm", "end": "II"}]}
    document = case({"floating": "none"}, pinion={"lead": lead, "bias": {"amount": "4 um"}})
    document["effects"]["relief"] = True
    found, ran = values(document)
    assert found["I.share_I"].value == pytest.approx(0.5, abs=1e-9)
    assert found["I.K_Hbeta_I"].value == pytest.approx(found["I.K_Hbeta_II"].value, rel=1e-9)
    assert found["I.K_Hbeta_I"].value > located()[0]["I.K_Hbeta_I"].value
    (table,) = (t for o in ran.outcomes.values() for t in o.tables if t.name == "double_helical_face_I")
    z, load = (next(c.values for c in table.columns if c.name == name) for name in ("z", "load"))
    np.testing.assert_allclose(z, -z[::-1], atol=1e-12)
    np.testing.assert_allclose(load, load[::-1], rtol=1e-8)
    own = copy.deepcopy(document)
    own["gear"]["q"] = gear(20, "left")
    own["pair"]["I"]["double_helical"]["second_driver"] = "q"
    second = double_to_load(scene_of(own), "I").spec.halves[1]
    assert not second.driver.face
    assert second.pair.driver.hand == "left"


def test_a_mirrored_solution_is_that_of_the_other_hand():
    from fegear.fem.solid.mirrored import can_be_mirrored, mirrored_solution
    from fegear.fem.solid.settings import SolidSettings
    from fegear.fem.solid.solution import solve_solid
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.rack import BasicRack

    tooth = Tooth(17, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(15.0))
    settings = SolidSettings().scaled(2.5)
    one, other = (solve_solid(tooth, tau, 1.5, 0.3, 5.0, settings) for tau in (0.03, -0.03))
    assert can_be_mirrored(one)
    turned = mirrored_solution(one)
    assert turned.tau == other.tau
    for k, c in other.compliance.items():
        np.testing.assert_allclose(turned.compliance[k], c, atol=1e-9 * np.abs(c).max())
    for key, moved in other.displacement.items():
        np.testing.assert_allclose(turned.displacement[key], moved, atol=1e-9 * np.abs(moved).max())


STRONG = {"strength": {"material": "case-hardened-steel"}}


def rated(double, **operation):
    document = case(double, ("rating",), pinion=STRONG, speed="3000 rpm")
    document["gear"]["w"] |= STRONG
    document["pair"]["I"]["operation"] = {"face_load_factor": 1.2, "life": "1000 h", **operation}
    return values(document)


def test_the_rating_is_that_of_one_half_with_k_gamma_of_the_uneven_load():
    """Even halves: the helical pair under half of the load; uneven ones: as if their K_gamma were given."""
    even, ran = rated({"floating": "driver"})
    assert Task("double-helical", "I") not in ran.outcomes  # a member that floats freely needs no load sharing
    document = case(None, ("rating",), pinion=STRONG, speed="3000 rpm", load="3000 N")
    document["gear"]["w"] |= STRONG
    document["pair"]["I"]["operation"] = {"face_load_factor": 1.2, "life": "1000 h"}
    del document["pair"]["I"]["double_helical"]
    single, _ = values(document)
    for name, value in single.items():
        twice = 2.0 if "transmittable_power" in name else 1.0
        assert even[name].value == pytest.approx(twice * value.value, rel=1e-12), name
    uneven, ran = rated({"floating": "none", "apex_offset": "3 um", "gap": "10 mm"})
    factor = uneven["I.K_gamma"].value
    assert factor == located("3 um")[0]["I.K_gamma"].value > 1.01
    given, _ = rated({"floating": "none", "apex_offset": "3 um", "gap": "10 mm"}, mesh_load_factor=factor)
    for key in ("driver.S_H", "driven.S_F", "K_v_rated", "driver.S_F_agma"):
        assert uneven[f"I.{key}"].value == pytest.approx(given[f"I.{key}"].value, rel=1e-12)
        assert uneven[f"I.{key}"].value != pytest.approx(even[f"I.{key}"].value, rel=1e-3)
    notes = [str(note) for outcome in ran.outcomes.values() for note in outcome.remarks]
    assert any("K_gamma from its double-helical" in note for note in notes)


def test_torques_of_a_spectrum_are_those_of_both_halves():
    level = {"torque": "150 N m", "share": 1.0}
    found, ran = rated({"floating": "driver"}, spectrum=[level])
    double = case({"floating": "driver"}, pinion=STRONG)
    torque = 6000.0 * scene_of(double).pairs["I"].driver.base_radius
    nominal, _ = rated({"floating": "driver"}, spectrum=[{"load_factor": 150.0 / torque, "share": 1.0}])
    assert found["I.driver.S_H"].value == pytest.approx(nominal["I.driver.S_H"].value, rel=1e-9)
    (table,) = (t for o in ran.outcomes.values() for t in o.tables if t.name == "rating_spectrum_I")
    assert next(c.values for c in table.columns if c.name == "torque")[0] == pytest.approx(150.0, rel=1e-9)


REFUSED = {
    "spur": ({"floating": "none"}, 'pair.I.driver = "p": is a spur gear: double_helical requires helical gears'),
    "play": ({"floating": "none", "axial_play": "1 mm"}, "axial_play = 1 mm: requires a floating member; set floating"),
    "force": ({"floating": "none", "axial_force": "10 N"}, "axial_force = 10 N: requires a floating member"),
    "far": ({"floating": "none", "apex_offset": "1 m"}, "apex_offset = 1000 mm: must be below 13"),
    "pushed": ({"axial_force": "-3000 N"}, "axial_force = -3000 N: must be below 2036.4 N"),
    "second": ({"second_driver": "x"}, 'pair.I.double_helical.second_driver = "x": is not a gear of this case'),
    "hand": ({"second_driver": "p"}, 'second_driver = "p": must be of the other hand than p; set gear.p.hand = "left"'),
    "teeth": ({"second_driver": "w"}, 'second_driver = "w": must have the teeth of p; make gear.w.teeth'),
    "stagger": ({"stagger": 1.5}, "pair.I.double_helical.stagger = 1.5: must be at least 0 and below 1"),
    "end": ({"torque_in": "III"}, 'pair.I.double_helical.torque_in = "III"'),
    "gap": ({"gap": "-1 mm"}, 'pair.I.double_helical.gap = "-1 mm": must not be negative'),
    "unknown": ({"gapp": "1 mm"}, "pair.I.double_helical.gapp"),
}


@pytest.mark.parametrize("name", REFUSED)
def test_what_is_no_double_helical_pair_is_refused(name):
    double, message = REFUSED[name]
    document = case(double)
    if name == "spur":
        for one in document["gear"].values():
            one["module"] = one.pop("normal_module")
            del one["helix_angle"], one["hand"]
    with pytest.raises(FegearError) as refused:
        make_plan(scene_of(document), STAGES)
    assert message in str(refused.value)


@pytest.mark.parametrize(
    ("change", "message"),
    [
        ({"line_error": {"over_face": "5 um"}}, "pair.I.line_error = (given): is not available with double_helical"),
        ({"axial_offset": "1 mm"}, "pair.I.axial_offset = 1 mm: is not available with double_helical; specify"),
        ({"width": "plane"}, 'pair.I.width = "plane"'),
        ({"double_helical": None}, "pair.I.double_helical = (not given): is required for double-helical"),
    ],
)
def test_other_keys_of_the_pair_are_refused(change, message):
    document = case()
    document["pair"]["I"] |= change
    document["pair"]["I"] = {key: value for key, value in document["pair"]["I"].items() if value is not None}
    with pytest.raises(FegearError) as refused:
        make_plan(scene_of(document), STAGES)
    assert message in str(refused.value)


def in_a_train(double, torque, **pair):
    document = case(double, ("gear-train", "natural-modes"), **pair)
    del document["pair"]["I"]["load"]
    document["pair"]["I"]["torque"] = f"{torque} N m"
    document["train"] = {
        "body": {"a": {"gears": ["p"]}, "b": {"gears": ["w"]}}, "shaft": {},
        "mesh": {"I": {"driver": "a", "driven": "b"}}, "torque": {"a": f"{torque} N m"}, "balance": "b",
    }  # fmt: skip
    return document


def test_in_a_train_equal_halves_are_two_meshes_side_by_side():
    """Twice the stiffness and twice the inertia of one half under half of the torque: the same frequencies."""
    both, ran = values(in_a_train({"floating": "driver", "apex_offset": "5 um"}, 200.0))
    single = in_a_train({}, 100.0)
    del single["pair"]["I"]["double_helical"]
    half, _ = values(single)
    factor = {"I.mean_force": 2.0, "I.mean_stiffness": 2.0, "a.inertia": 2.0, "b.inertia": 2.0}
    for name, value in half.items():
        if name != "I.axial_force":
            assert both[name].value == pytest.approx(factor.get(name, 1.0) * value.value, rel=1e-9), name
    assert "I.axial_force" not in both
    notes = [str(note) for outcome in ran.outcomes.values() for note in outcome.remarks]
    assert any("double helical, two equal meshes in parallel" in note for note in notes)


@pytest.mark.parametrize(
    ("double", "message"),
    [
        ({"floating": "none"}, "pair.I.double_helical.floating = none: is not available in a train"),
        ({"axial_play": "1 mm"}, "pair.I.double_helical.floating = (limited): is not available in a train"),
        ({"stagger": 0.5}, "pair.I.double_helical.stagger = 0.5: is not available in a train"),
    ],
)
def test_a_train_refuses_halves_that_are_not_equal(double, message):
    with pytest.raises(FegearError) as refused:
        scene_of(in_a_train(double, 200.0))
    assert message in str(refused.value)


def test_shafts_and_planetary_sets_do_not_take_it_for_a_single_helical_pair():
    document = case()
    document["shaft"] = {
        "s": {"sections": [{"length": "50 mm", "outer": "20 mm"}], "gears": [{"gear": "p", "at": "25 mm"}]}
    }
    with pytest.raises(FegearError, match="double_helical = \\(given\\): is not available for gears on shafts"):
        scene_of(document)


WILD = (
    "-1 mm", "0 mm", "5 km", "12 um", 0.5, -3, "I", "II", "none", "driver", "p", "w", "", True, [], {}, "40 N", "nan",
    "1e400 mm", "7 deg", 1e300,
)  # fmt: skip


def test_a_hundred_mutations_of_the_keys_are_refused_in_one_sentence_or_taken():
    generator = np.random.default_rng(52)
    keys = ("gap", "apex_offset", "floating", "axial_play", "axial_force", "stagger", "torque_in", "torque_out",
            "second_driver", "second_driven")  # fmt: skip
    taken = 0
    for _ in range(100):
        double = {
            key: WILD[generator.integers(len(WILD))]
            for key in generator.choice(keys, generator.integers(1, 4), replace=False).tolist()
        }
        try:
            scene = scene_of(case(double))
            make_plan(scene, STAGES)
            taken += 1
        except FegearError as error:
            said = str(error)
            assert said.startswith("pair.I"), (double, said)
            assert "\n" not in said, double
            assert len(said) < 400, double
    assert 0 < taken < 60


def test_rexs_gets_one_half_with_its_torque_and_says_so():
    from fegear.exchange.rexs.written_gearbox import model_text

    scene = scene_of(case())
    text, remarks = model_text(scene, "2026-01-01")
    said = "only one half (end I) of the double helical pair written to REXS, with half of the torque."
    assert f"Pair I: {said}" in remarks
    torque = 3000.0 * scene.pairs["I"].driver.base_radius
    assert f"{torque:.6g}"[:6] in text


def test_harmonics_have_the_frequency_of_the_mesh_and_its_axial_acceleration():
    _, ran = values(case({"floating": "driver", "stagger": 0.5}, speed="600 rpm"))
    (table,) = (t for o in ran.outcomes.values() for t in o.tables if t.name == "double_helical_harmonics_I")
    n, frequency, motion, acceleration = (
        next(c.values for c in table.columns if c.name == name)
        for name in ("n", "frequency", "axial_motion", "axial_acceleration")
    )
    np.testing.assert_allclose(frequency, n * 200.0)
    np.testing.assert_allclose(acceleration, (2.0 * np.pi * frequency) ** 2 * motion * 1e-6, rtol=1e-9)
    assert motion[0] > 0.0


def test_odd_teeth_of_double_helical_pairs_are_refused():
    document = case(
        pinion={"odd_tooth": [{"tooth": 0, "missing": True}]}, results=("mesh-stiffness-revolution",), width="solid"
    )
    document["effects"]["odd_teeth"] = True
    with pytest.raises(FegearError, match=r"gear\.p\.odd_tooth = \(given\): is not available for double helical pairs"):
        run(document)
