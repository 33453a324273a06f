"""A gearbox at a glance: margins that mean what they say, the weakest first, what to change, and the drawing."""

import copy
import math
import tomllib
import types
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fegear.base.notes import NoteClass, failing
from fegear.case.built.shafts import gearbox_of
from fegear.case.reading import build_scene
from fegear.design.flanks.lead_correction import LevelLead
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.run_answer import _within
from fegear.engine.stage import Task
from fegear.geometry.flank_modification import HelixSlope
from fegear.results.catalogue import STAGES
from fegear.results.shafts.at_glance import BearingAtGlance, MeshAtGlance, Safety
from fegear.results.shafts.gearbox_changes import CAUSE_WORDS, change_of_load, change_of_mesh, end_of_slope
from fegear.results.shafts.gearbox_data import GearboxData
from fegear.results.shafts.gearbox_scheme import apart, scheme, unrolled
from fegear.results.shafts.gearbox_sentences import sentences
from fegear.results.shafts.other_direction import (
    lives_under_uniform_load,
    other_direction,
    said_of_other_direction,
    shares_of_life,
)
from fegear.shafts.life import LifeRating

CASES = Path(__file__).parents[2] / "cases"
RATED = {"strength": {"material": "case-hardened-steel"}, "tolerance_class": 6, "roughness": {"flank_rz": "4 um",
         "root_rz": "16 um"}}  # fmt: skip

#: Factors that do not follow the load.
OPERATION = {"life": "5000 h", "dynamic_factor": 1.1, "face_load_factor": 1.3, "transverse_load_factor": 1.0}


def overview(times=1.0, *, rated=True, **changed):
    """Two stages of plane teeth on their shafts, rated for 5,000 h, at `times` their torques."""
    case = tomllib.loads((CASES / "two_stage_shafts.toml").read_text(encoding="utf-8"))
    case["results"] = ["gearbox"]
    for gear in (case["gear"]["a"], case["gear"]["b"]):  # spur gears: plane teeth are loaded within a second
        gear["module"] = gear.pop("normal_module")
        del gear["helix_angle"], gear["hand"]
    del case["pair"]["I"]["centre_distance"]
    case["shaft"]["mid"]["axis"], case["shaft"]["out"]["axis"] = ["105 mm", "0 mm"], ["235 mm", "0 mm"]
    for name, torque, speed in (("I", 100.0, 1500.0), ("II", 250.0, 600.0)):
        case["pair"][name]["torque"] = f"{times * torque} N*m"
        if rated:
            case["pair"][name] |= {"speed": f"{speed} rpm", "operation": OPERATION,
                                   "lubricant": {"viscosity_40": "220 mm^2/s", "temperature": "70 degC"}}  # fmt: skip
    if rated:
        for gear in case["gear"].values():
            gear.update(copy.deepcopy(RATED))
    for path, value in changed.items():
        table, name, key = path.split("__")
        case[table][name][key] = value
    scene = build_scene(case, "box", Path())
    run = run_plan(scene, make_plan(scene, STAGES))
    return run, run.outcomes[Task("gearbox", "all")]


@pytest.fixture(scope="module")
def usual():
    return overview()


def test_at_its_margin_a_mesh_has_the_minimum_safety(usual):
    worst = usual[1].data.meshes[0]
    assert worst.margin == min(one.margin for one in usual[1].data.meshes)
    again = next(one for one in overview(worst.margin)[1].data.meshes if one.pair == worst.pair)
    assert again.margin == pytest.approx(1.0, rel=0.01)  # Z_L, Z_V and Y hardly follow the load


def test_at_its_margin_a_bearing_lives_as_long_as_required(usual):
    data = usual[1].data
    first = data.bearings[0]
    assert first.margin == min(one.margin for one in data.bearings if math.isfinite(one.margin))
    (again,) = (one for one in overview(first.margin)[1].data.bearings
                if one.shaft == first.shaft
                and abs(one.radial / first.radial / first.margin - 1.0) < 0.02)  # fmt: skip
    assert again.duration == pytest.approx(5000 * 3600.0, rel=0.05)
    # 1,500 rpm at the input, 600 rpm in the middle: revolutions per hour
    for one in data.bearings:
        if math.isfinite(one.life):
            speed = {"in": 1500.0, "mid": 600.0}[one.shaft]
            assert one.duration / 3600.0 == pytest.approx(one.life / (60.0 * speed), rel=1e-9)


def test_causes_add_up_and_the_table_is_in_order(usual):
    tables = {table.name: table for table in usual[1].tables}
    meshes = tables["gearbox_meshes"]
    total = sum(np.array(meshes[f"misalignment_{cause} [um]"]) for cause in CAUSE_WORDS)
    np.testing.assert_allclose(total, meshes["misalignment [um]"], rtol=1e-9)
    seats = np.abs(meshes["misalignment_housing [um]"])
    assert all(one == 0.0 or one > 1e-9 for one in seats)
    assert np.all(np.diff(meshes["load_margin"]) >= 0.0)


def test_beside_the_safety_factors_stands_the_face_load_factor_that_they_contain(usual):
    (meshes,) = (table for table in usual[1].tables if table.name == "gearbox_meshes")
    names = [column.name for column in meshes.columns]
    assert names.index("K_Hbeta_rated") == names.index("S_F_min") + 1
    np.testing.assert_array_equal(meshes["K_Hbeta_rated"], [OPERATION["face_load_factor"]] * 2)


def test_an_overload_names_all_that_fails_and_begins_with_the_verdict():
    run, outcome = overview(6.0)
    data = outcome.data
    failing = [one for one in (*data.meshes, *data.checked) if one.margin < 1.0]
    short = [one for one in data.bearings if one.margin < 1.0]
    tilted = [one for one in data.bearings if one.tilted is not None and one.tilted.margin < 1.0]
    assert len(data.changes) == len(failing) + len(short) + len(tilted) > 3
    assert all(one.fails and one.verdict and one.brief for one in data.changes)
    kinds = [one.part.split()[0] for one in data.changes[:3]]
    assert sorted(kinds) == ["bearing", "pair", "shaft"]  # the weakest of each first
    everything = [one.margin for one in (*data.meshes, *data.bearings) if math.isfinite(one.margin)]
    assert data.changes[0].margin == pytest.approx(min(everything))
    said = outcome.answer.sentences
    weakest = data.bearings[0]
    assert said[0].startswith("Fails: ")
    assert said[0].count(" required)") + said[0].count("arcmin") >= 3
    assert f"and {len(data.changes) - 4} more" in said[0] or len(data.changes) <= 4
    lines = said[1].splitlines()
    assert [line.split(",")[0] for line in lines[:3]] == ["Change 1", "Change 2", "Change 3"]
    assert len(lines) == 4
    assert all(one.part in said[1] for one in data.changes)
    # a value that the verdict has is not said again
    assert f"bearing {weakest.bearing} life" in said[0]
    assert "shaft mid yielding S_yield 1.11 (1.2 required)" in said[0]
    assert said[2].startswith(f"Pair {data.meshes[0].pair}, the weakest of 2: ")
    assert " ".join(said).count(f"S_H {data.meshes[0].contact:.2f}") == 1
    assert all(one.count("K_Hβ") <= 1 for one in (said[0], *said[2:]))
    assert run.answer.tables == ("gearbox_changes", "gearbox_meshes", "gearbox_bearings", "gearbox_shafts")
    assert not any("mesh stiffness" in one for one in run.answer.sentences)
    bearing = next(one for one in data.changes if one.part.startswith("bearing"))
    assert "times as large" in bearing.remedy


def test_what_cannot_be_computed_is_said_once():
    _, outcome = overview(rated=False)
    assert [one for one in outcome.remarks if "is not rated" in one]
    (table,) = (table for table in outcome.tables if table.name == "gearbox_meshes")
    assert not [column.name for column in table.columns if column.name.startswith(("S_", "K_", "load_margin"))]
    assert not outcome.data.changes


def mesh(peak=0.9, factor=1.5, margin=math.nan, over=12e-6, by=(10e-6, 1e-6, 3e-6, -2e-6)):
    safety = Safety(0.8, 2.0, (1.0, 1.4), 1.8) if margin < 1.0 else None
    return MeshAtGlance(safety, 0.0, 0.0, peak, "I", over, by, factor, 0.8, 1.0, 2.0, 1.4, 3e-6, margin)


def test_the_answer_names_both_face_load_factors_and_what_flank_modifications_leave_of_the_misalignment():
    def said(remaining):
        one = replace(mesh(margin=0.8), remaining=remaining)
        data = types.SimpleNamespace(
            meshes=(one,), bearings=(), changes=(), failures=(), checked=(), required_hours=math.nan, turned_by=()
        )
        return " ".join(sentences(types.SimpleNamespace(data=data)))

    assert said(12e-6) == (
        "Pair I: S_H 0.80 (1 required), S_F 2.00 (1.4 required); S_H and S_F at K_Hβ 1.80 (ISO 6336-1, with "
        "manufacturing deviations). Pair I: misaligned by 12 µm, K_Hβ 1.50 of the loaded flanks (without these "
        "deviations), transmission error 3 µm peak to peak."
    )
    assert "misaligned by 12 µm (linear gap with the flank modifications 1.5 µm)" in said(1.5e-6)
    assert "linear gap" not in said(math.nan)
    assert "linear gap" not in said(12.05e-6)


def test_the_remedy_follows_the_cause():
    assert change_of_mesh(mesh(factor=1.1)) is None
    assert change_of_load(mesh(factor=1.1)) is None
    assert "crowning" in change_of_load(mesh(peak=0.1)).remedy
    assert "end II" in change_of_load(mesh()).finding
    assert "bearings" in change_of_load(mesh()).remedy
    assert "thicker shaft" in change_of_load(mesh(by=(1e-6, 0.0, 13e-6, -2e-6))).remedy
    # a cause against the sum is none: bending makes this misalignment smaller
    assert mesh(over=-4e-6, by=(-10e-6, 0.0, 11e-6, -5e-6)).main_cause == 0
    weak = change_of_mesh(mesh(margin=0.64))
    assert weak.finding.startswith("S_H 0.80 of 1 (pitting), 64 %")
    assert "S_H" not in weak.remedy  # no number without a rating
    assert "against K_Hβ 1.80 of the rating; or 1.56 times the face width at equal K factors" in weak.remedy


def test_the_safety_after_a_lead_correction_is_that_of_the_rating():
    """2.24 -> 1.6 on the flanks; what is said is that of the rating, with manufacturing deviations."""
    weak = replace(mesh(margin=0.64), lead=LevelLead(4e-6, 2.24, 1.6, 3e-6))
    unrated = change_of_mesh(weak).remedy
    assert (
        "helix slope C_Hβ 4 µm with more removal at end II and crowning C_β 3 µm on the driver; estimate, lead-"
        in unrated
    )
    assert "S_H" not in unrated
    failing_still = change_of_mesh(replace(weak, levelled=Safety(0.9, 2.3, (1.0, 1.4), 1.42))).remedy
    assert "lead-correction computes it): S_H 0.90 at K_Hβ 1.42 in place of 1.80 of the rating, or " in failing_still
    assert failing_still.count("K_Hβ") == 1
    assert "; with the lead correction still 1.23 times the face width" in failing_still
    enough = change_of_mesh(replace(weak, levelled=Safety(1.1, 2.3, (1.0, 1.4), 1.2))).remedy
    assert "S_H 1.10" in enough
    assert "face width" not in enough
    sagging = change_of_mesh(replace(weak, lead=LevelLead(0.0, 2.24, 1.6, 3e-6))).remedy
    assert "(crowning C_β 3 µm on the driver" in sagging
    # what is named is the whole lead, as that of the lead correction
    present = change_of_mesh(replace(weak, present=(-1e-6, 2e-6))).remedy
    assert (
        "helix slope C_Hβ 3 µm with more removal at end II and crowning C_β 5 µm on the driver, in place of" in present
    )
    flat = change_of_mesh(replace(weak, present=(-4e-6, 2e-6), lead=LevelLead(4e-6, 2.24, 1.6, -2e-6))).remedy
    assert "(crowning C_β 0 µm on the driver, in place of its present lead; estimate" in flat
    assert "face width" in change_of_mesh(replace(weak, lead=LevelLead(4e-6, 2.59, 2.5))).remedy


def test_a_life_below_the_required_one_fails_in_a_note_and_its_change_stays_beside_another_answer():
    short, lasting = bearing("A", 1e9, 0.35), bearing("B", 1e10, 2.0)
    box = GearboxData(None, None, (mesh(margin=0.64),), (short, lasting), 1.8e7)
    (note,) = box.said_of_lives()
    assert (note.kind, note.margin) == (NoteClass.FAILS, 0.35)
    assert note.startswith("Bearing A: basic rating life 214 h of 5000 h required on shaft in; a dynamic load rating ")
    assert not list(replace(box, bearings=(lasting,)).said_of_lives())
    said = list(sentences(types.SimpleNamespace(data=box)))
    beside = _within([said, ["Pair I: grind.", "Pair II: grind.", "Pair III: grind."]])
    assert any("bearing A of shaft in: life 214 h of 5000 h" in one for one in beside)


def test_a_weak_mesh_is_changed_before_a_second_bearing():
    """Three bearings with short lives hid what the weakest mesh needs."""
    lives = tuple(bearing(name, 1e9, margin) for name, margin in (("A", 0.4), ("B", 0.6), ("C", 0.7)))
    weak, uneven = mesh(margin=0.79), replace(mesh(factor=1.8), pair="II")
    box = GearboxData(None, None, (weak, uneven), lives, 1.8e7)
    assert [one.part.split(" of")[0] for one in box.changes] == ["bearing A", "pair I", "bearing B", "bearing C"]
    said = list(sentences(types.SimpleNamespace(data=box)))
    assert said[0] == (
        "Fails: bearing A life 320 h (5000 h required), pair I pitting S_H 0.80 (1 required), bearing B life 1080 h "
        "(5000 h required), bearing C life 1710 h (5000 h required)."
    )
    assert said[1].splitlines()[3] == ("Change 4: bearing C of shaft in: a dynamic load rating C 1.43 times as large.")
    # load that is uneven fails nothing: every failure comes before it
    box = GearboxData(None, None, (uneven,), lives[:2], 1.8e7)
    assert [one.part for one in box.changes] == ["bearing A of shaft in", "bearing B of shaft in", "pair II"]


def bearing(name, life, margin, exponent=3.0):
    hours = 5000.0 * margin**exponent
    return BearingAtGlance(name, "in", 1000.0, 0.0, life, 3600.0 * hours, margin, exponent)


def test_where_nothing_falls_short_three_improvements_are_named():
    safe = Safety(1.6, 2.8, (1.0, 1.4), 1.2)
    lead = LevelLead(4e-6, 1.2, 1.0)
    first = replace(mesh(factor=1.2, margin=2.0), safety=safe, contact=1.8, bending=2.8, lead=lead)
    second = replace(mesh(factor=1.2, margin=3.0), pair="II", safety=safe, lead=LevelLead(2e-6, 1.2, 1.1))
    third = replace(mesh(factor=1.01, margin=4.0), pair="III", safety=safe, lead=LevelLead(1e-6, 1.02, 1.01))
    box = GearboxData(None, None, (first, second, third), (bearing("A", 1e9, 1.5), bearing("B", 1e10, 2.0)), 1.8e7)
    assert [one.part for one in box.changes] == ["pair I", "bearing A of shaft in", "pair II"]
    assert not any(one.urgent for one in box.changes)
    assert box.changes[0].finding.startswith("S_F 2.80 of 1.4")
    assert (
        box.changes[0].remedy
        == "lead correction (helix slope C_Hβ 4 µm with more removal at end II on the driver: K_Hβ of the loaded "
        "flanks 1.20 -> 1.00; estimate, lead-correction computes it)"
    )
    rated = replace(first, levelled=Safety(1.9, 3.1, (1.0, 1.4), 1.1))
    better = replace(box, meshes=(rated, second, third)).changes[0].remedy
    assert better.endswith(": S_F 3.10 at K_Hβ 1.10 in place of 1.20 of the rating")
    assert f"{16875 * 1.1**3 / 100:.0f}00 h" in box.changes[1].remedy
    # what falls short stays in front, and is named once
    short = replace(box, bearings=(bearing("A", 1e9, 0.9), *box.bearings[1:]))
    assert [(one.part, one.urgent) for one in short.changes] == [
        ("bearing A of shaft in", True), ("pair I", False), ("pair II", False),
    ]  # fmt: skip


def test_names_in_the_drawing_do_not_lie_over_each_other():
    x, y = np.array([0.0, 1.0, 2.0, 60.0, 1.0]), np.array([0.0, 0.1, 0.0, 0.0, 40.0])
    labels = ("lager_6202_j", "stirnrad_pos_2", "lager_6202_j_33", "far", "above")
    moved = apart(x, y, labels, 1.4)
    assert moved[[3, 4]].tolist() == [0.0, 40.0]  # these are in nobody's way
    assert np.abs(np.subtract.outer(moved[:3], moved[:3]))[~np.eye(3, dtype=bool)].min() > 2.7
    assert np.abs(moved[:3]).max() < 6.0
    assert apart(x[:1], y[:1], labels[:1], 1.4).tolist() == [0.0]
    # a bearing in the way: beside it, as near as both heights allow
    box = np.array([[0.0, 0.5, 4.0, 6.0]])
    beside = float(apart(x[:1], y[:1], labels[:1], 1.4, box)[0])
    assert abs(beside - 0.5) >= 0.999 * 0.5 * (2.8 + 6.0)
    assert abs(beside - 0.5) < 0.5 * (2.8 + 6.0) + 0.25 * 2.8


def test_the_drawing_has_its_centre_distances_and_displacements(usual):
    data = usual[1].data
    heights = unrolled(data.shafts)
    assert heights["in"] - heights["mid"] == pytest.approx(0.105)
    assert heights["mid"] - heights["out"] == pytest.approx(0.13)
    figure = scheme(data)
    curves = {item.name: item for item in figure.panels[0].items if item.name}
    factor = float(figure.caption.partition("magnified ")[2].partition(" times")[0].replace(" ", ""))
    bent = dict(zip(data.shafts.gearbox.names, data.shafts.nominal.bent, strict=True))
    largest = max(float(np.hypot(one.line.x, one.line.y).max()) for one in bent.values())
    x = np.asarray(curves["axes under load"].x) * 1e-3
    across = [-heights[name] for name in bent]
    parts = np.split(x, np.flatnonzero(np.isnan(x)))
    off = max(float(np.nanmax(np.abs(part - at))) for part, at in zip(parts, across, strict=False))
    assert off == pytest.approx(factor * largest, rel=1e-6)


def test_what_cannot_be_built_begins_the_answer_and_is_the_first_change():
    note = failing("Gear a and shaft b intersect: radii 143.6 mm, axes 124.5 mm apart; move one along its shaft", 0.9)
    box = GearboxData(None, None, (mesh(margin=0.64),), (bearing("A", 1e9, 0.2),), 1.8e7, (note,))
    first, *others = sentences(types.SimpleNamespace(data=box))
    assert first == "Cannot be built: Gear a and shaft b intersect: radii 143.6 mm, axes 124.5 mm apart."
    (change,) = [one for one in others if one.startswith("Change 1, ")]
    assert change.startswith("Change 1, assembly: Gear a and shaft b intersect")
    assert "apart; move one along its shaft.\nChange 2, " in change  # all of them, within five sentences
    assert len(others) < 5


@pytest.mark.parametrize(("slope", "end"), [(4e-6, "II"), (-4e-6, "I")])
def test_the_end_of_a_helix_slope_is_that_with_more_removal(slope, end):
    low, high = HelixSlope(slope, 0.02).removal(0.0, np.array([-0.01, 0.01]))
    assert bool(high > low) is (end == "II")
    assert end_of_slope(slope) == f"more removal at end {end}"


def test_the_other_direction_is_the_mirror_image_with_the_other_hand():
    """Mirrored in the plane of its axes a gearbox turns the other way with gears of the other hand."""
    document = tomllib.loads((CASES / "two_stage_shafts.toml").read_text(encoding="utf-8"))
    scene, hands = build_scene(document, "box", CASES), {"right": "left", "left": "right"}
    mirrored = copy.deepcopy(document)
    for gear in mirrored["gear"].values():
        if "hand" in gear:
            gear["hand"] = hands[gear["hand"]]
    rated = [
        [LifeRating(40e3, "ball", radial_factor=0.56, axial_factor=1.6, limit=0.3)] * len(one.bearings)
        for one in scene.case.shaft.values()
    ]
    other = other_direction(scene)
    assert other.changes == ("shaft.in.clockwise=true",)
    turned = lives_under_uniform_load(other.gearbox, rated)
    flat = [np.array([one for row in lives for one in row]) for lives in (
        turned, lives_under_uniform_load(gearbox_of(build_scene(mirrored, "box", CASES)), rated),
        lives_under_uniform_load(gearbox_of(scene), rated),
    )]  # fmt: skip
    np.testing.assert_allclose(flat[0], flat[1], rtol=1e-6)
    assert np.abs(flat[0] / flat[2] - 1.0).max() > 0.1  # axial forces find other bearings
    (shares,) = [shares_of_life(gearbox_of(scene), other, rated)]
    np.testing.assert_allclose([one for row in shares for one in row], flat[0] / flat[2], rtol=1e-9)


def test_spur_gears_in_a_row_last_the_same_in_both_directions_and_nothing_is_said():
    document = tomllib.loads((CASES / "two_stage_shafts.toml").read_text(encoding="utf-8"))
    for gear in document["gear"].values():
        if gear.pop("hand", None):
            gear["module"] = gear.pop("normal_module")
            del gear["helix_angle"]
    document["pair"]["I"]["centre_distance"] = "108.75 mm"
    scene = build_scene(document, "box", CASES)
    rated = [[LifeRating(40e3, "ball")] * len(one.bearings) for one in scene.case.shaft.values()]
    assert shares_of_life(gearbox_of(scene), other_direction(scene), rated) is None
    assert not said_of_other_direction((bearing("A", 1e9, 1.5),), 1.8e7, ("shaft.in.clockwise=true",))
    turned = (replace(bearing("A", 1e9, 1.5), other=1.7e7), replace(bearing("B", 1e9, 1.5), other=9e7))
    (said,) = said_of_other_direction(turned, 1.8e7, ("shaft.in.clockwise=true",))
    assert "minimum life 4720 h, bearing A (fails, 5000 h required); " in said
    assert said.endswith("run with --set shaft.in.clockwise=true.")
