"""The everyday questions as the cases that they are: what each puts into its document; nothing is run."""

import math
from dataclasses import dataclass, field
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import fegear
from fegear.base.errors import InputError
from fegear.case.built.encoders import encoders_of
from fegear.case.built.gauges import check_gauge, gauge_of
from fegear.case.reading import build_scene
from fegear.engine.named import Named
from fegear.engine.plan import make_plan
from fegear.engine.table import Column as TableColumn
from fegear.engine.table import Table as RunTable
from fegear.results.catalogue import STAGES
from fegear.workbench import moving, questions
from fegear.workbench.pair import Pair
from fegear.workbench.results import Results

PINION = fegear.Gear(20, "3 mm", name="pinion", face_width="10 mm")
WHEEL = fegear.Gear(33, "3 mm", name="wheel", face_width="10 mm")
BASE = 0.03 * math.cos(math.radians(20.0))


@pytest.fixture
def pair():
    return fegear.Pair(PINION, WHEEL, compliance="cornell")


@pytest.fixture
def asked(monkeypatch):
    """The scenes that would be run, with what they are run with."""
    scenes = []
    monkeypatch.setattr(questions, "run_scene", lambda scene, **how: scenes.append((scene, how)) or scene)
    return scenes


def test_loads_along_the_line_of_action_are_torques_over_the_base_radius(pair, asked):
    one = fegear.transmission_error(pair, torque="90 N*m").case.pair["I"]
    assert (one.torque, one.load, one.loads) == (90.0, None, None)
    several = fegear.transmission_error(pair, torque=["30 N*m", 90.0]).case.pair["I"]
    assert several.loads == pytest.approx([30.0 / BASE, 90.0 / BASE])
    between = fegear.transmission_error(pair, torque="30 to 90 N m").case.pair["I"]
    assert between.loads == pytest.approx([30.0 / BASE, 60.0 / BASE, 90.0 / BASE])
    forces = fegear.load_sharing(pair, load=["1 kN", 2500.0])
    assert forces.case.pair["I"].loads == pytest.approx([1000.0, 2500.0])
    assert forces.case.results == ["load-sharing"]
    assert forces.case.title == "Load sharing of pinion and wheel"
    for wrong in ({}, {"torque": "90 N*m", "load": "1 kN"}):
        with pytest.raises(InputError, match="is required, or load"):
            fegear.transmission_error(pair, **wrong)
    with pytest.raises(InputError, match=r"must be a fegear\.Pair"):
        fegear.transmission_error(PINION, torque="90 N*m")


def test_what_is_neglected_is_sized_only_where_asked_and_tolerances_are_the_case_s(pair, asked):
    plain = fegear.root_stress(pair, load="1 kN")
    assert plain.case.results == ["root-stress-history"]
    asking = fegear.root_stress(pair, load="1 kN", neglected=True, tolerance=3e-2, effects={"hertz": "linear"})
    assert (asking.neglects, asking.case.accuracy.tolerance) == (True, 3e-2)
    assert asking.case.effects.hertz == "linear"
    assert plain.neglects is False
    assert asked[0][1]["cache"] is pair.known  # what was solved for the pair is recalled
    with pytest.raises(InputError, match="applies to gears only"):
        fegear.root_stress(pair, load="1 kN", positions=3)


def test_tables_of_gears_stand_where_they_are_asked_for(asked):
    table = fegear.stiffness_table(PINION, ["29 mm", 0.031], contact_half_width="40 um", tolerance=1e-2).case
    assert (table.results, table.stiffness.gear) == (["stiffness"], "pinion")
    assert table.stiffness.radii == pytest.approx((0.029, 0.031))
    assert table.stiffness.contact_half_width == pytest.approx(40e-6)
    assert fegear.stiffness_table(PINION, "29 mm").case.stiffness.radii == pytest.approx((0.029,))
    over_face = fegear.stiffness_table(PINION, positions=7, face_positions=5, source="slices").case.stiffness
    assert (over_face.positions, over_face.face_positions, over_face.source) == (7, 5, "slices")
    assert table.title == "Stiffness of pinion"
    with pytest.raises(InputError, match=r"must be a fegear\.Gear"):
        fegear.stiffness_table("pinion")


def test_root_stress_of_gears_is_compared_at_twenty_places(asked):
    both = fegear.root_stress([PINION, WHEEL]).case
    assert (both.results, both.stiffness.positions, list(both.gear)) == (["crosscheck"], 20, ["pinion", "wheel"])
    assert both.title == "Root stress and compliance of pinion and wheel"
    three = fegear.Gear(17, "3 mm", name="third", face_width="10 mm")
    assert fegear.root_stress((PINION, WHEEL, three)).case.title.endswith("of pinion, wheel and third")
    assert fegear.root_stress(PINION, positions=3).case.stiffness.positions == 3
    for wrong, words in (
        ([], "must be gears"), ([PINION, "x"], "must be gears"), (3, "must be gears"),
        ([PINION, PINION], "name of several"),
    ):  # fmt: skip
        with pytest.raises(InputError, match=words):
            fegear.root_stress(wrong)
    for key in ("torque", "load", "effects"):
        with pytest.raises(InputError, match="applies to pairs, not to gears"):
            fegear.root_stress(PINION, **{key: {"relief": True} if key == "effects" else "1 kN"})


def test_reliefs_are_designed_for_the_pair_under_its_load(pair, asked):
    case = fegear.relief(pair, load="1 kN", design={"grind": ["linear"]}).case
    assert (case.results, case.design.pair, case.design.grind) == (["relief"], "I", ["linear"])
    assert case.pair["I"].load == 1000.0


HELICAL = {"normal_module": "2.5 mm", "helix_angle": "18 deg", "face_width": "28 mm"}
HELICAL_CASE = {
    "results": ["relief"],
    "gear": {
        "pinion": {**HELICAL, "teeth": 23, "hand": "right"}, "wheel": {**HELICAL, "teeth": 71, "hand": "left"},
    },
    "effects": {"start": "described"},
}  # fmt: skip


@pytest.mark.parametrize(
    ("torque", "in_case"),
    [
        ("320 N*m", {"torque": "320 N*m"}),
        (["120 N*m", 220.0, "320 N*m"], {"torques": ["120 N*m", "220 N*m", "320 N*m"]}),
        ({"start": "120 N*m", "stop": "320 N*m", "count": 3}, {"torques": ["120 N*m", "220 N*m", "320 N*m"]}),
        ("120 to 320 N m", {"torques": ["120 N*m", "220 N*m", "320 N*m"]}),
    ],
)
def test_reliefs_of_helical_pairs_are_those_of_the_case_file(asked, torque, in_case):
    gears = (
        fegear.Gear(z, hand=hand, name=name, **HELICAL)
        for z, hand, name in ((23, "right", "pinion"), (71, "left", "wheel"))
    )
    scene = fegear.relief(fegear.Pair(*gears), torque=torque, neglected=True)
    pair = {"driver": "pinion", "driven": "wheel", **in_case}
    written = build_scene({**HELICAL_CASE, "pair": {"I": pair}}, "case", Path())
    asked_for, of_case = (make_plan(one, STAGES).steps for one in (scene, written))
    assert [step.task for step in asked_for] == [step.task for step in of_case]
    for step in of_case:
        ours, case_s = step.inputs(scene), step.inputs(written)
        if step.task.stage != "relief-over-face":  # which holds what names its pair
            assert repr(ours) == repr(case_s)
            continue
        assert ours.gears == case_s.gears == {"driver": "pinion", "driven": "wheel"}
        assert (case_s.over is None) == ("torque" in in_case)
        if case_s.over is not None:
            assert ours.over.loads == pytest.approx(case_s.over.loads, rel=1e-12)


def test_several_loads_are_a_range_of_the_design(pair, asked):
    case = fegear.relief(pair, load=["1 kN", "2 kN"]).case
    assert (case.design.over, case.pair["I"].loads) == ("torques", [1000.0, 2000.0])
    only = fegear.relief(pair, load=["1 kN", "2 kN"], design={"over": "load"}).case
    assert only.design.over == "load"


def test_two_gears_turn_between_steady_torques_where_no_train_is_given(pair, monkeypatch):
    @dataclass(frozen=True)
    class Plan:
        remarks: tuple = ("first",)

    @dataclass(frozen=True)
    class Found:
        plan: Plan = field(default_factory=Plan)

    documents = []
    monkeypatch.setattr(moving, "ask_of_pair", lambda *given, **how: documents.append(given[2]) or Found())
    found = fegear.dynamic_factor(pair, torque="90 N*m", speeds="9000 rpm")
    (document,) = documents
    assert document["train"] == {
        "body": {"driver": {"gears": ["pinion"]}, "driven": {"gears": ["wheel"]}},
        "mesh": {"I": {"driver": "driver", "driven": "driven", "damping_ratio": 0.1}},
        "torque": {"driver": "90 N*m"}, "balance": "driven",
    }  # fmt: skip
    assert document["dynamics"] == {"speeds": ["9000 rpm"], "speed_of": "driver"}  # as the function says
    assert found.plan.remarks[0] == "first"
    assert found.plan.remarks[1].endswith("Damping ratio of the mesh not specified, 0.1 assumed.")
    told = fegear.dynamic_factor(pair, torque="90 N*m", speeds=["1 rpm", "2 rpm"], damping_ratio=0.0,
                                 dynamics={"direction": "up"})  # fmt: skip
    assert documents[1]["train"]["mesh"]["I"]["damping_ratio"] == 0.0
    assert documents[1]["dynamics"] == {"speeds": ["1 rpm", "2 rpm"], "speed_of": "driver", "direction": "up"}
    assert told.plan.remarks[1].endswith("without shafts.")
    own = fegear.dynamic_factor(pair, torque="90 N*m", speeds={"start": "1 rpm"}, train={"balance": "x"})
    assert (documents[2]["train"], documents[2]["dynamics"]) == ({"balance": "x"}, {"speeds": {"start": "1 rpm"}})
    assert own.plan.remarks == ("first",)
    turned = fegear.vibration_revolution(pair, torque="90 N*m", speed="9000 rpm", dynamics={"tolerance": 1e-3})
    assert documents[3]["train"] == document["train"]
    assert documents[3]["dynamics"] == {"speed_of": "driver", "speed": "9000 rpm", "tolerance": 1e-3}
    assert turned.plan.remarks == found.plan.remarks
    own = fegear.vibration_revolution(pair, torque="90 N*m", speed="1 rpm", train={"balance": "x"})
    assert (documents[4]["train"], documents[4]["dynamics"]) == ({"balance": "x"}, {"speed": "1 rpm"})
    assert own.plan.remarks == ("first",)


# ---- pairs with a designed relief ------------------------------------------------------------------------------------
class Column:
    def __init__(self, *values):
        self.si = np.array(values)


class Table(dict):
    def column(self, key):
        return Column(*self[key])


def design_of(pair):
    """What a design holds, of the pair's own case."""
    tables = {
        "relief_I_pinion": Table(roll_angle=[0.3, 0.5], relief=[0.0, 12e-6]),
        "relief_I_wheel": Table(roll_angle=[0.2, 0.4], relief=[0.0, 8e-6]),
        "grindable_I": Table(
            shape=np.array(["linear", "linear", "parabolic", "parabolic"]),
            gear=np.array(["driver", "driven", "driver", "driven"]), amount=[10e-6, 20e-6, 30e-6, 40e-6],
            start_roll_angle=[0.41, 0.42, 0.43, 0.44],
        ),
    }  # fmt: skip

    class Design(Results):
        def __init__(self):
            pass

        scene = SimpleNamespace(case=SimpleNamespace(pair={"I": SimpleNamespace(driver="pinion", driven="wheel")}))

    Design.tables = tables
    return Design()


def test_a_pair_takes_the_relief_of_its_design_and_keeps_its_names_and_solutions(pair, monkeypatch):
    monkeypatch.setattr("fegear.workbench.pair.table_names", lambda scene, name: {
        "driver": "I_pinion", "driven": "I_wheel",
    })  # fmt: skip
    found = design_of(pair)
    designed = pair.relieved(found)
    assert designed.names == ("pinion", "wheel")
    assert designed.driver.keys["relief"] == {"table": {"roll_angles": [0.3, 0.5], "removals": [0.0, 12e-6]}}
    assert designed.driven.keys["relief"]["table"]["removals"] == [0.0, 8e-6]
    assert designed.known is pair.known
    assert designed.keys["compliance"] == {"source": "cornell"}
    ground = pair.relieved(found, "parabolic")
    assert ground.driver.keys["relief"]["tip"] == {
        "amount": pytest.approx(30e-6), "start_roll_angle": pytest.approx(0.43), "shape": "parabolic",
    }  # fmt: skip
    assert ground.driven.keys["relief"]["tip"]["amount"] == pytest.approx(40e-6)
    assert pair.relieved(found, "parabolic tip relief") == ground  # as tables name it
    with pytest.raises(InputError, match='choose from "designed", "linear", "parabolic"'):
        pair.relieved(found, "cubic")
    for wrong, shape in ((1, "designed"), (found, 3)):
        with pytest.raises(InputError):
            pair.relieved(wrong, shape)


def test_tip_relief_of_a_pair_with_a_width_is_taken_from_its_grinding_table(pair, monkeypatch):
    monkeypatch.setattr("fegear.workbench.pair.table_names", lambda scene, name: {
        "driver": "I_pinion", "driven": "I_wheel",
    })  # fmt: skip
    found, columns = design_of(pair), {
        "gear": (["pinion", "wheel", "pinion"], ""),
        "design": (["linear tip relief"] * 2 + ["parabolic tip relief"], ""),
        "modification": (["tip relief"] * 3, ""), "shape": (["linear", "linear", "parabolic"], ""),
        "amount": ([12e-6, 18e-6, 20e-6], "um"), "start_diameter": ([61e-3, 101e-3, 60e-3], "mm"),
        "end_diameter": ([65.9e-3, 104.9e-3, 65.9e-3], "mm"),
    }  # fmt: skip
    made = (TableColumn(name, np.array(values), unit) for name, (values, unit) in columns.items())
    type(found).tables = Named([RunTable("grinding_I", tuple(made))])
    ground = pair.relieved(found, "linear")
    assert ground.driver.keys["relief"]["tip"]["start_radius"] == "30.5 mm"
    assert ground.driven.keys["relief"]["tip"]["amount"] == "18 um"
    curved = pair.relieved(found, "parabolic")
    assert curved.driver.keys["relief"]["tip"]["shape"] == "parabolic"
    assert "relief" not in curved.driven.keys  # nothing is ground there
    for shape in ("cubic", "designed"):
        with pytest.raises(InputError, match='choose from "linear", "parabolic"'):
            pair.relieved(found, shape)


def test_flanks_designed_over_the_face_are_taken_whole_and_replace_lead_and_twist(pair, monkeypatch):
    monkeypatch.setattr("fegear.workbench.pair.table_names", lambda scene, name: {
        "driver": "I_pinion", "driven": "I_wheel",
    })  # fmt: skip
    found, columns = design_of(pair), {
        "gear": (["pinion", "pinion", "wheel"], ""), "design": (["profile-and-lead"] * 3, ""),
        "modification": (["tip relief", "crowning", "tip relief"], ""), "shape": (["linear"] * 3, ""),
        "amount": ([12e-6, 6e-6, 18e-6], "um"), "start_diameter": ([61e-3, np.nan, 101e-3], "mm"),
        "end_diameter": ([65.9e-3, np.nan, 104.9e-3], "mm"),
    }  # fmt: skip
    made = (TableColumn(name, np.array(values), unit) for name, (values, unit) in columns.items())
    type(found).tables = Named([RunTable("grinding_I", tuple(made))])
    bent = fegear.Gear.of("wheel", {**WHEEL.keys, "lead": {"crowning": "9 um"}})
    ground = Pair(PINION, bent, compliance="cornell").relieved(found, "profile-and-lead")
    assert ground.driver.keys["lead"] == {"crowning": "6 um"}
    assert ground.driven.keys["relief"]["tip"]["amount"] == "18 um"
    assert "lead" not in ground.driven.keys  # that of before is replaced


def test_flanks_are_designed_for_one_torque_a_range_or_loads(monkeypatch):
    seen = {}
    monkeypatch.setattr(questions, "ask_of_pair", lambda wanted, pair, document, *rest, **more: seen.update(document))
    wide = Pair(PINION, WHEEL, width="slices")
    fegear.flank_design(wide, torque="60 to 90 N m", design={"families": ["profile"]})
    assert seen["pair"]["I"]["torques"] == {"start": "60 N m", "stop": "90 N m", "count": 3}
    assert seen["flank_design"] == {"pair": "I", "families": ["profile"]}
    fegear.flank_design(wide, load=[1000.0, 2000.0])
    assert seen["flank_design"]["loads"] == [1000.0, 2000.0]
    fegear.flank_design(wide, torque="90 N m")
    assert seen["flank_design"] == {"pair": "I"}


def test_pairs_are_alike_where_they_are_described_alike(pair):
    same = Pair(PINION, WHEEL, compliance="cornell")
    assert pair == same
    assert hash(pair) == hash(same)
    assert pair != Pair(PINION, WHEEL, compliance="weber-banaschek")
    assert pair != Pair(PINION, WHEEL, compliance="cornell", name="II")
    assert pair != Pair(WHEEL, PINION, compliance="cornell")
    assert pair != Pair(PINION, WHEEL, compliance="cornell", load_distribution={"positions": 12})
    assert pair != "I"
    assert (pair.is_spur, pair.is_wide) == (True, False)
    assert Pair(PINION, WHEEL, width="slices").is_wide
    assert "compliance" not in Pair(PINION, WHEEL, width="slices").document()["pair"]["I"]
    assert pair.document(load="1 kN")["pair"]["I"]["load"] == "1 kN"
    with pytest.raises(InputError, match="is required for tooth contact analysis"):
        _ = pair.flanks


@pytest.mark.parametrize("ask", [fegear.load_sharing, fegear.transmission_error, fegear.root_stress, fegear.rating])
def test_every_question_of_a_pair_hands_on_effects_tolerance_progress_and_neglected(pair, asked, ask):
    scene = ask(pair, load="1 kN", effects={"hertz": "linear"}, tolerance=3e-2, neglected=True, progress=False)
    assert (scene.case.effects.hertz, scene.case.accuracy.tolerance, scene.neglects) == ("linear", 3e-2, True)
    assert asked[0][1]["progress"] is False


def test_a_rating_has_the_pair_s_own_keys_and_those_that_are_asked_for(pair, asked):
    one = fegear.rating(pair, torque="90 N*m", speed="1500 rpm", operation={"application_factor": 1.3}).case
    assert list(one.rating.beside) == ["agma-2101"]
    assert (one.pair["I"].torque, one.pair["I"].operation.application_factor) == (90.0, 1.3)
    assert one.pair["I"].speed == pytest.approx(50.0 * math.pi)
    assert list(fegear.rating(pair, load="1 kN", beside="computed").case.rating.beside) == ["computed"]


def test_gauges_and_traces_are_asked_for_by_the_keys_of_a_case(asked, tmp_path):
    pair = fegear.Pair(PINION, WHEEL)
    one = fegear.gauge(pair, {"grid_length": "0.5 mm", "fillet": "compression"}, torque="90 N*m").case
    assert list(one.gauge) == ["g"]
    assert (one.gauge["g"].gear, one.gauge["g"].pair, one.gauge["g"].fillet) == ("pinion", "I", "compression")
    two = fegear.gauge(pair, {"left": {"gear": "wheel"}, "right": {"height": "0.4 mm"}}, load="3 kN").case.gauge
    assert [(name, gauge.gear) for name, gauge in two.items()] == [("left", "wheel"), ("right", "pinion")]
    files = [{"file": "one.csv", "torque": "60 N*m"}, {"file": "two.csv", "torque": "90 N*m"}]
    found = fegear.measured_transmission_error(
        pair, files, torque=["60 N*m", "90 N*m"], encoders={"fit": ["offset"], "te_at": "driven"}
    ).case
    assert [trace.torque for trace in found.encoders["rig"].traces] == [60.0, 90.0]
    assert (found.encoders["rig"].fit, found.encoders["rig"].te_at) == (["offset"], "driven")
    single = fegear.measured_transmission_error(pair, tmp_path / "one.csv", load="3 kN").case.encoders["rig"]
    assert single.traces[0].file == str(tmp_path / "one.csv")
    with pytest.raises(InputError, match="at least one file"):
        fegear.measured_transmission_error(pair, [], torque="90 N*m")
    with pytest.raises(InputError, match="grid_lenght"):
        fegear.gauge(pair, {"grid_lenght": "0.5 mm"}, torque="90 N*m")


def test_a_number_of_positions_is_no_radius():
    with pytest.raises(InputError, match="use positions=40"):
        fegear.stiffness_table(PINION, 40)


_AT = np.radians(np.arange(-20.0, 21.0))
_STRAIN = 5e-4 - 1e-6 * np.degrees(_AT) ** 2


def _trace(scene):
    return gauge_of(scene, "g").measured


@pytest.mark.dear
def test_traces_are_arrays_quantities_or_tables_as_well_as_files(asked, tmp_path):
    pair = fegear.Pair(PINION, WHEEL)
    pd, pint = pytest.importorskip("pandas"), pytest.importorskip("pint")
    degrees, micro = np.degrees(_AT), _STRAIN * 1e6
    frame, unit = pd.DataFrame({"angle [deg]": degrees, "strain [um/m]": micro, "note": "x"}), pint.UnitRegistry()
    rows = [f"{a!r},{s!r}\n" for a, s in zip(degrees.tolist(), micro.tolist(), strict=True)]
    (tmp_path / "t.csv").write_text("angle [deg],strain [um/m]\n" + "".join(rows))
    ways = [
        {"file": str(tmp_path / "t.csv")}, {"angle": _AT, "strain": _STRAIN},
        {"angle": list(_AT), "strain": tuple(_STRAIN)},
        {"angle [deg]": degrees, "strain [um/m]": pd.Series(micro)}, frame,
        {"data": {"phi": degrees, "SG": micro}, "angle": "deg", "strain": "um/m", "angle_column": "phi",
         "strain_column": "SG"},
        {"data": frame}, {"angle": degrees * unit.deg, "strain": _STRAIN},
    ]  # fmt: skip
    for measured in ways:
        found = _trace(fegear.gauge(pair, {"measured": measured}, torque="90 N*m"))
        np.testing.assert_allclose(found.angle, _AT, rtol=1e-12, atol=1e-15)
        np.testing.assert_allclose(found.strain, _STRAIN, rtol=1e-12)
    left = {"measured": {"angle": _AT, "strain": _STRAIN, "fit": ["offset", "scale"]}}
    fitted = fegear.gauge(pair, {"left": left, "right": {}}, load="3 kN").case.gauge
    assert (fitted["left"].measured.fit, fitted["right"].measured) == (["offset", "scale"], None)
    gap = np.where(np.arange(_AT.size) == 7, np.nan, _STRAIN)
    short = _trace(fegear.gauge(pair, {"measured": {"angle": _AT, "strain": gap}}, load="3 kN"))
    assert short.angle.size == _AT.size - 1
    te = 1e-6 * np.sin(np.linspace(0.0, 900.0, 4000))
    traces = [{"angle": np.linspace(0.0, 6.0, 4000), "te": te, "torque": "60 N*m"},
              {"data": pd.DataFrame({"angle [deg]": np.linspace(0.0, 350.0, 4000), "te [um]": 2e6 * te}),
               "torque": "90 N*m"}]  # fmt: skip
    scene = fegear.measured_transmission_error(pair, traces, torque=["60 N*m", "90 N*m"], encoders={"fit": ["shift"]})
    one, two = encoders_of(scene, "rig").traces
    np.testing.assert_allclose((one.te, 0.5 * two.te), (te, te), rtol=1e-12)
    assert (one.angle[-1], two.angle[-1]) == pytest.approx((6.0, math.radians(350.0)))


@pytest.mark.parametrize(
    ("measured", "rule"),
    [
        ({"angle": _AT, "strain": _STRAIN[:-1]},
         "gauge.g.measured = angle [rad] 41, strain [m/m] 40: must be columns of one length"),
        ({"angle": _AT}, "gauge.g.measured = (arrays): requires a column strain"),
        ({"angle": _AT[:5], "strain": _STRAIN[:5]}, "gauge.g.measured = (arrays): has 5 samples, fewer than 8"),
        ({"angle": _AT, "strain": _STRAIN, "file": "t.csv"}, 'measured.file = "t.csv": contradicts arrays'),
        ({"angle": _AT, "strain": np.ones((41, 2))},
         "measured.strain = (array of float64, shape (41, 2)): must be one"),
        ({"angle": _AT, "strain": np.array(["a"] * 41)}, "must be one column of numbers"),
        ({"angle": _AT, "strain": np.zeros(0)}, "must be one column of numbers"),
        ({"angle": [1.0, [2.0, 3.0]], "strain": _STRAIN}, "must be one column of numbers"),
        ({"angle": _AT, "strain": 1e6 * _STRAIN}, "above 5 %"),
        ({"angle": _AT, "strain": np.ones(41)}, "(arrays): has the same strain in every line"),
        ({"angle": _AT, "strain": np.where(_AT > 0.2, np.inf, _STRAIN)}, "(arrays): has "),
        ({"angle": _AT, "strain": _STRAIN, "fit": ["drift", "offset"]},
         "requires a trace of 2 turns, the trace has 0.114"),
        ({"angle [mm]": _AT, "strain": _STRAIN}, "is not an angle"),
        ({"data": 7}, "measured.data = 7: must be a mapping of heads to arrays, or a DataFrame"),
        ({"data": {}}, "must have at least one column"), ([1.0], "must be a table"),
    ],
)  # fmt: skip
def test_wrong_arrays_are_refused_in_one_sentence(asked, monkeypatch, measured, rule):
    monkeypatch.setattr(questions, "run_scene", lambda scene, **_: check_gauge(scene, "g"))
    with pytest.raises(InputError) as refused:
        fegear.gauge(fegear.Pair(PINION, WHEEL), {"measured": measured}, load="3 kN")
    assert rule in str(refused.value)
    assert "\n" not in str(refused.value)
    assert "arrays_" not in str(refused.value)
