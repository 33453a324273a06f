"""The studies that hold closed forms against finite elements, run as users run them."""

from __future__ import annotations

import csv
import math
import re
from pathlib import Path

import numpy as np
import pytest
from helical_gears import helical_gear
from solved_once import CACHE

from fegear.base.errors import InputError
from fegear.case.built.tooth_influence import mesh_settings
from fegear.case.reading import read_scene
from fegear.cli import program
from fegear.contact.compared.crosscheck import pair_compliance_answers, root_stress_answers
from fegear.contact.compared.root_stress_study import root_stress_study, variants, verdict
from fegear.contact.compared.single_contact import at_single_contact
from fegear.contact.compared.virtual_gear import virtual_root_stress
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import solve_gear
from fegear.formulas import cornell_heywood as cornell
from fegear.formulas.iso6336.part3_pair import RatingChoice, ToothLoad, rate_helical, rate_spur
from fegear.formulas.root_stress_formulas import ROOT_STRESS_SOURCES
from fegear.formulas.sources import SOURCES, pair_compliance
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.results.catalogue import STAGES

ROOT = Path(__file__).parents[2]
CASES = ROOT / "cases"


def run(name, *overrides):
    scene = read_scene(CASES / f"{name}.toml", overrides)
    results = run_plan(scene, make_plan(scene, STAGES), cache=CACHE)
    tables = {table.name: {column.name: column.values for column in table.columns} for table in results.tables}
    return tables, {value.name: value.value for value in results.values}, results


@pytest.fixture(scope="module")
def cornell_case():
    return run("cornell_test_gear")


#: The study's gears at the ends of every range, for the ordinary run: 8 of its 45.
ENDS = (
    "study={gear='base', teeth=[14, 100], profile_shift=[-0.3, 0.5], rack_tip_radius=[0.1, 0.38], "
    "load_position=[0.1, 0.4, 0.7, 1.0]}"
)
#: Which of the documented extremes stand at these.
AT_THE_ENDS = {
    "lowest": ("cornell-trochoid", "heywood", "iso-6336-3"),
    "highest": ("cornell-trochoid", "heywood", "agma-908", "dolan-broghamer"),
}


@pytest.fixture(scope="module", params=["ends", pytest.param("every gear", marks=pytest.mark.long)])
def study(request):
    every = request.param == "every gear"
    return *run("root_stress_validation", *(() if every else (ENDS,))), 45 if every else 8


def rows_of(table, formula):
    return {name: column[table["formula"] == formula] for name, column in table.items()}


# ---- the paper's test gear ------------------------------------------------------------------------------------------
def test_cornells_claim_is_answered_by_a_number(cornell_case):
    # The paper says "within about 5 percent". Against the whole gear's finite elements (own estimate: below 0.5 %) it
    # is 0.7 % at the lowest of the five loads and 22.0 % at the highest, always on the safe side.
    tables, values, results = cornell_case
    answer = results.outcomes[Task("crosscheck", "")].answer.sentences[0]
    assert answer.startswith("Pair I, test loaded at its outer point of single pair contact (HPSTC, diameter 90.117")
    assert f"Cornell {values['I.driver.root_stress.cornell.hpstc_ratio']:.2f}, " in answer
    assert values["test.root_stress.cornell.largest_deviation"] == pytest.approx(0.220, abs=0.006)
    assert values["test.root_stress.cornell.lowest_ratio"] == pytest.approx(1.007, abs=0.006)
    table = tables["crosscheck_root_stress_test"]
    ratio = rows_of(table, "cornell")["ratio_to_fe"]
    assert ratio == pytest.approx([1.007, 1.053, 1.113, 1.171, 1.220], abs=0.006)
    assert np.max(table["root_tension_fe_error"] / table["root_tension_fe"]) < 5e-3


def test_formulas_are_compared_where_ratings_put_the_load(cornell_case):
    # Once more by hand: the point where the pair before lets go, a solution of its own, the standard's own factors.
    tables, values, results = cornell_case
    pair = results.scene.pairs["I"]
    radius = float(pair.radius(pair.x_start + pair.base_pitch, "driver"))
    gear = results.scene.gears["test"]
    known = solve_gear(gear, mesh_settings(results.scene.case.accuracy), reach=0)
    fe = float(known.largest_root_stress(0, "tension", [radius])[0][0])
    factors = rate_spur(pair, "driver", 1.0, RatingChoice(2006, 6)).form
    by_iso = math.cos(gear.external_tooth.rack.pressure_angle) / gear.module * factors.Y_F * factors.Y_S
    assert values["I.driver.root_stress.iso-6336-3.hpstc_ratio"] == pytest.approx(by_iso / fe, rel=1e-4)
    table = tables["crosscheck_single_contact_I"]
    assert set(table["formula"]) == set(ROOT_STRESS_SOURCES)
    assert table["hpstc_radius"] == pytest.approx(1e3 * radius, rel=1e-12)  # identical gears: the same of both
    assert table["ratio_to_fe"] == pytest.approx(table["root_tension"] / table["root_tension_fe"], rel=1e-12)
    iso = tables["crosscheck_iso_6336_I"]["ratio_to_fe"]
    assert rows_of(table, "iso-6336-3")["ratio_to_fe"] == pytest.approx(iso, rel=1e-9)
    # the load that ratings take is not among the extremes over the whole flank
    low, high = (values[f"test.root_stress.iso-6336-3.{one}_ratio"] for one in ("lowest", "highest"))
    assert low < values["I.driver.root_stress.iso-6336-3.hpstc_ratio"] < high
    figure = next(one for one in results.figures if one.name == "crosscheck_root_stress_test")
    assert any(getattr(item, "label", "") == "HPSTC I" for panel in figure.panels for item in panel.marks)


def test_without_a_single_pair_the_upper_half_of_the_flank_is_compared():
    _, _, results = run("cornell_test_gear", "stiffness={gear='test', positions=5}", "pair={}")
    sentences = results.outcomes[Task("crosscheck", "")].answer.sentences
    assert sentences[0].startswith("Gear test, loads on the upper half of the flank: root stress by formula / FE ")
    assert not any("single pair contact" in one for one in sentences)
    high = next(iter(read_scene(CASES / "high_contact_ratio.toml", ()).pairs.values()))
    assert high.contact_ratio > 2.0
    assert at_single_contact(high, ()) == ()


def test_the_case_has_the_papers_gear_and_roll_angles(cornell_case):
    # The generated root has the paper's section, so that Cornell's formula on the paper's own numbers agrees to the
    # digits to which rack and thinning are given (1e-4).
    tables, _, _ = cornell_case
    found = rows_of(tables["crosscheck_root_stress_test"], "cornell")
    rolls = np.array([0.2208, 0.2922, 0.3640, 0.4350, 0.5080])
    assert np.radians(found["roll_angle"]) == pytest.approx(rolls, rel=1e-5)
    base = 1.75 * 25.4e-3 * math.cos(math.radians(20.0))
    section = cornell.RootSection(base, math.radians(3.98222), 1.016e-3, 40.909406e-3, 5.6958151e-3)
    paper = cornell.root_stress(section, rolls)
    assert found["root_tension"] == pytest.approx(paper.stress * 1e-3, rel=1e-4)
    assert np.radians(found["place_angle"]) == pytest.approx(paper.angle, abs=1e-4)


def test_tables_hold_every_formula_and_never_a_silent_nan(cornell_case):
    tables, _, results = cornell_case
    for name, sources in (
        ("root_stress_test", ROOT_STRESS_SOURCES),
        ("compliance_test", SOURCES),
        ("compliance_I", SOURCES),
    ):
        table = tables[f"crosscheck_{name}"]
        assert set(table["formula"]) == set(sources)
        assert np.array_equal(np.isnan(table["ratio_to_fe"]), table["reason"] != "")
    told = tables["crosscheck_sources"]
    assert len(told["formula"]) == len(ROOT_STRESS_SOURCES) + len(SOURCES)
    assert all("compression" in words for words, gives in zip(told["what_is_compared"], told["gives"], strict=True)
               if gives == "root stress")  # fmt: skip
    assert any("secant" in remark for remark in results.remarks)


def test_parts_add_up_and_the_pair_is_symmetric(cornell_case):
    tables, values, _ = cornell_case
    tooth, pair = tables["crosscheck_compliance_test"], tables["crosscheck_compliance_I"]
    total = tooth["bending"] + tooth["shear"] + tooth["axial"] + tooth["foundation"]
    assert tooth["compliance"] == pytest.approx(total, rel=1e-12)
    assert pair["compliance"] == pytest.approx(pair["driver"] + pair["driven"] + pair["contact"], rel=1e-12)
    assert pair["compliance_fe"] == pytest.approx(pair["driver_fe"] + pair["driven_fe"], rel=1e-12)
    # Equal gears: turning the pair around mirrors the path of contact.
    for name in SOURCES:
        one = rows_of(pair, name)
        assert one["compliance"] == pytest.approx(one["compliance"][::-1], rel=1e-9)
        assert one["compliance_fe"] == pytest.approx(one["compliance_fe"][::-1], rel=1e-9)
    # As measured: textbook pairs are within 10 % of FE here, the tooth without fillet within 18 %; ISO's c' within 5 %.
    for name in SOURCES:
        beyond = np.nanmax(np.abs(rows_of(pair, name)["ratio_to_fe"] - 1.0))
        assert beyond < (0.18 if name == "potential-energy-simplified" else 0.1), name
    assert values["I.single_stiffness_iso"] == pytest.approx(
        values["I.single_stiffness_iso.ratio_to_fe"] * values["I.single_stiffness_fe"], rel=1e-12
    )
    assert values["I.single_stiffness_iso.ratio_to_fe"] == pytest.approx(1.046, abs=0.01)
    assert values["I.single_stiffness_fe"] == pytest.approx(1.0 / pair["compliance_fe"].min(), rel=1e-12)


def test_mean_mesh_stiffness_is_beside_that_of_iso():
    few = 'stiffness={gear="test", load="254.33 N/mm", positions=6}'
    ideal = 'effects={neighbour_coupling=true, hertz="load-dependent"}'
    asked = ('results=["crosscheck", "transmission-error"]', f'pair.I.load="{254.33 * 6.35} N"', few, ideal)
    tables, values, results = run("cornell_test_gear", *asked)
    mean, iso = values["I.mesh_stiffness_fe"], values["I.mesh_stiffness_iso"]
    assert mean * 6.35 == pytest.approx(values["I.mesh_stiffness_mean"], rel=1e-9)
    ratio = results.outcomes[Task("transmission-error", "I")].data.found.pair.contact_ratio
    assert iso == pytest.approx(values["I.single_stiffness_iso"] * (0.75 * ratio + 0.25), rel=1e-9)
    assert values["I.mesh_stiffness_iso.ratio_to_fe"] == pytest.approx(iso / mean, rel=1e-12)
    # contacts that reach past a tip are none: towards both ends the compliance grows, and does not stop
    fe = rows_of(tables["crosscheck_compliance_I"], "cornell")["compliance_fe"]
    assert (np.diff(fe, 2) > 0.0).all()


def test_mesh_stiffness_by_formulas_is_that_of_springs_in_parallel(cornell_case):
    # A formula with a linear contact, added up by hand over the pairs that are on the path of contact.
    tables, values, results = cornell_case
    pair, table = results.scene.pairs["I"], tables["crosscheck_mesh_stiffness_I"]
    x = 1e-3 * table["x"]
    assert np.radians(table["driver_angle"]) == pytest.approx(x / pair.driver.base_radius, rel=1e-12)
    total = np.zeros(x.size)
    for number in range(3):
        at = x + number * pair.base_pitch
        on = at < pair.x_end
        by_hand = pair_compliance(SOURCES["potential-energy-simplified"], pair, at[on], 250e3)
        total[on] += 1e-6 * pair.face_width / by_hand.total
    found = table["mesh_stiffness_potential_energy_simplified"]
    assert found == pytest.approx(total, rel=1e-5)
    # one pair in contact: no neighbour is loaded that could be coupled; two: the coupling takes stiffness away
    alone = x + pair.base_pitch >= pair.x_end
    assert alone.any()
    assert not alone.all()
    fe, uncoupled = table["mesh_stiffness_fe"], table["mesh_stiffness_fe_uncoupled"]
    assert uncoupled[alone] == pytest.approx(fe[alone], rel=1e-9)
    assert (uncoupled[~alone] > 1.05 * fe[~alone]).all()
    # the mean of the values is that over the whole base pitch, which the rows show
    width = np.diff(x)

    def mean(curve):
        return np.sum(0.5 * (curve[1:] + curve[:-1]) * width) / np.sum(width)

    ratio = values["I.mesh_stiffness.potential-energy-simplified.ratio_to_fe"]
    assert ratio == pytest.approx(mean(found) / mean(fe), rel=2e-3)
    assert values["I.mesh_stiffness_fe_uncoupled.ratio_to_fe"] == pytest.approx(mean(uncoupled) / mean(fe), rel=2e-3)
    assert values["I.mesh_stiffness_fe"] * pair.face_width * 1e3 == pytest.approx(mean(fe), rel=2e-3)
    assert any(figure.name == "crosscheck_mesh_stiffness_I" for figure in results.figures)


def test_a_gear_without_pair_and_one_out_of_range():
    # Ten teeth: Sainsot's fit does not reach so far; the row says so and the others go on.
    tables, values, results = run("cornell_test_gear", "pair={}", "stiffness={positions=4}", "gear.test.teeth=10")
    assert not any(name.startswith("crosscheck_compliance_I") for name in tables)
    table = tables["crosscheck_compliance_test"]
    sainsot = rows_of(table, "potential-energy")
    assert np.isnan(sainsot["compliance"]).all()
    assert all("half root angle" in reason or "Sainsot" in reason for reason in sainsot["reason"])
    assert np.isfinite(rows_of(table, "cornell")["compliance"]).all()
    assert "test.compliance.potential-energy.lowest_ratio" not in values
    assert any("potential-energy is out of its range" in remark for remark in results.remarks)


def test_unloaded_pairs_say_which_load_they_use():
    _, _, results = run("cornell_test_gear", "stiffness={gear='test', positions=3}")
    assert any("no load was given" in remark for remark in results.remarks)
    tables, _, results = run("cornell_test_gear", "stiffness={gear='test', positions=3}", "pair.I.load='1270 N'")
    assert not any("no load was given" in remark for remark in results.remarks)
    assert len(tables["crosscheck_compliance_I"]["x"]) == 3 * len(SOURCES)


def test_c_prime_outside_the_stated_range_is_remarked_and_where_it_has_no_value_the_reason_is():
    def with_mate(shift, addendum=1.0):
        mate = f"teeth=40, diametral_pitch='8 / inch', rack={{addendum={addendum}, dedendum=1.25, tip_radius=0.25}}"
        return run(
            "cornell_test_gear",
            "stiffness={gear='test', positions=2}",
            f"gear.mate={{{mate}, profile_shift={shift}, plane='stress', face_width='6.35 mm'}}",
            "pair.I={driver='test', driven='mate'}",
        )

    _, values, results = with_mate(0.3)
    assert values["I.single_stiffness_iso"] > 0.0
    assert any("x_1 = 0 is below x_2 = 0.3" in remark for remark in results.remarks)
    _, values, results = with_mate(-0.6)
    assert values["I.single_stiffness_iso"] > 0.0
    assert any("x_1 + x_2 = -0.6 is outside -0.5 to 2" in remark for remark in results.remarks)
    _, values, results = with_mate(0.0, addendum=0.1)
    assert "I.single_stiffness_iso" not in values
    assert any("ISO 6336-1 gives no c': contact ratio = 0.9162" in remark for remark in results.remarks)


# ---- ISO 6336's root stress of pairs --------------------------------------------------------------------------------
def test_sigma_f0_of_a_spur_pair_has_every_factor_of_the_case(cornell_case):
    tables, values, _ = cornell_case
    table = tables["crosscheck_iso_6336_I"]
    tooth = read_scene(CASES / "cornell_test_gear.toml").gears["test"].tooth
    force = 254.33 * math.cos(math.radians(20.0)) / (25.4 / 8.0)  # F_t / (b m) [MPa]
    assert table["form_stress"] == pytest.approx(force * table["Y_F"] * table["Y_S"], rel=1e-9)
    assert table["sigma_f0"] == pytest.approx(table["form_stress"], rel=1e-12)
    assert values["I.driver.sigma_f0_iso"] == table["sigma_f0"][0]
    assert table["ratio_to_fe"] == pytest.approx(table["form_stress"] / table["root_tension_fe"], rel=1e-12)
    assert ((table["ratio_to_fe"] > 0.8) & (table["ratio_to_fe"] < 1.2)).all()
    # A thin rim, grade 3, edition 2019: Y_B = 1.6 ln(2.242 h_t / s_R); the rest stays 1 below a contact ratio of 2.
    rim = 0.7 * (tooth.tip_radius - tooth.root_radius) * 25.4 / 8.0
    found, _, _ = run(
        "cornell_test_gear", "stiffness.radii=['44.450425 mm']", f"gear.test.rim_thickness='{rim} mm'",
        "pair.I.iso_6336={edition=2019, accuracy_grade=3}",
    )  # fmt: skip
    thin = found["crosscheck_iso_6336_I"]
    assert thin["Y_B"] == pytest.approx(1.6 * math.log(2.242 / 0.7), rel=1e-9)
    assert thin["sigma_f0"] == pytest.approx(table["sigma_f0"] * thin["Y_B"], rel=1e-9)
    assert (thin["f_epsilon"] == 1.0).all()
    assert (thin["Y_DT"] == 1.0).all()


@pytest.mark.dear
def test_a_helical_pair_is_compared_through_its_virtual_teeth():
    tables, values, results = run(
        "litvin_shaft_angle", "results=['crosscheck']", "pair.I.iso_6336={edition=2019}", "pair.I.torque='500 N m'",
        "gear.pinion.helix_angle='15 deg'", "gear.gear.helix_angle='15 deg'",
    )  # fmt: skip
    table = tables["crosscheck_iso_6336_I"]
    beta, alpha = math.radians(15.0), math.radians(20.0)
    base = math.asin(math.sin(beta) * math.cos(alpha))
    assert table["z_n"] == pytest.approx(np.array([30, 100]) / (math.cos(base) ** 2 * math.cos(beta)), rel=1e-12)
    overlap = min(1.6 * math.sin(beta) * 5.0 / math.pi, 1.0)
    assert table["Y_beta"] == pytest.approx((1.0 - overlap * 15.0 / 120.0) / math.cos(beta) ** 3, rel=1e-9)
    assert (table["f_epsilon"] < 1.0).all()
    radius = 0.5 * 30 * 25.4 / 5.0 / math.cos(beta)
    force = 500e3 / radius / (1.6 * 25.4) / (25.4 / 5.0)
    assert table["form_stress"] == pytest.approx(force * table["Y_F"] * table["Y_S"], rel=1e-9)
    factors = table["f_epsilon"] * table["Y_beta"] * table["Y_B"] * table["Y_DT"]
    assert table["sigma_f0"] == pytest.approx(table["form_stress"] * factors, rel=1e-12)
    assert ((table["ratio_to_fe"] > 0.85) & (table["ratio_to_fe"] < 1.15)).all()
    assert values["I.single_stiffness_iso"] > 0.0
    assert any("virtual spur teeth" in remark for remark in results.remarks)
    # Remarks on spur gears' finite elements came with it, of which there are none.
    assert not any(
        "Crosscheck: single tooth of the complete gear" in r or "one tooth pair with" in r for r in results.remarks
    )


def test_without_a_helix_the_virtual_tooth_is_the_tooth():
    rack = BasicRack(1.0, 1.25, 0.25)
    spur = [Gear(Tooth(z, rack), 4e-3, 20e-3) for z in (25, 40)]
    pair = GearPair(*spur)
    choice = RatingChoice()
    load = ToothLoad(1e5 * math.cos(rack.pressure_angle), pair.contact_ratio)
    for member, gear in zip(("driver", "driven"), spur, strict=True):
        straight = helical_gear(gear.teeth, 4e-3, rack.pressure_angle, 0.0, 0.02, "spur")
        one, other = rate_helical(straight, load, choice), rate_spur(pair, member, 1e5, choice)
        assert one.stress == pytest.approx(other.stress, rel=1e-9)
        assert one.load_diameter == pytest.approx(other.load_diameter, rel=1e-12)
    # Between whole numbers of teeth the finite elements follow; on them they are those of the wheel itself.
    coarse = MeshSettings().scaled(1.6)
    tension = {}
    for beta, teeth in ((0.0, 25), (math.radians(9.0), 25), (0.0, 26)):
        gear = helical_gear(teeth, 4e-3, rack.pressure_angle, beta, 0.02, "spur" if beta == 0.0 else "left")
        z_n = rate_helical(gear, load, choice).teeth
        tension[z_n] = virtual_root_stress(gear, z_n + 1.0, coarse).tension
    low, middle, high = tension
    assert 25.0 == low < middle < high == 26.0
    part = (1.0 / low - 1.0 / middle) / (1.0 / low - 1.0 / high)
    assert tension[middle] == pytest.approx(tension[low] + part * (tension[high] - tension[low]), rel=1e-9)


# ---- the study ------------------------------------------------------------------------------------------------------
def test_study_marks_every_point(study):
    tables, values, _, gears = study
    table = tables["root_stress_study"]
    assert len(table["teeth"]) == gears * 4 * len(ROOT_STRESS_SOURCES)
    silent = np.isnan(table["ratio_to_fe"])
    assert np.array_equal(silent, table["reason"] != "")
    assert np.array_equal(silent, table["verdict"] == "breaks down")
    assert 0 < silent.sum() < 0.15 * silent.size
    assert np.array_equal(table["verdict"] == "high", table["ratio_to_fe"] > 1.05)
    assert np.array_equal(table["verdict"] == "low", table["ratio_to_fe"] < 0.95)
    for name in ROOT_STRESS_SOURCES:
        keys = ("high", "low", "within_5_percent", "breaks_down")
        assert sum(values[f"{name}.share_{key}"] for key in keys) == pytest.approx(1.0, rel=1e-12)


def test_study_finds_what_the_documentation_says(study):
    # Coarse meshes: two digits in the documentation, +-0.015 here for the FE's own error (below 1 %).
    tables, values, _, gears = study
    text = (ROOT / "docs" / "formulas.md").read_text("utf-8")
    pattern = r"^\| `([a-z0-9-]+)` \| (\d\.\d\d), (\d\.\d\d), (\d\.\d\d) \|"
    rows = {name: [float(v) for v in rest] for name, *rest in re.findall(pattern, text, re.MULTILINE)}
    assert set(rows) == set(ROOT_STRESS_SOURCES)
    for name, row in rows.items():
        found = [values[f"{name}.{key}_ratio"] for key in ("lowest", "median", "highest")]
        if gears == 45:
            assert found == pytest.approx(row, abs=0.015), name
        # Some of the gears are within the range of all of them, and reach what stands at them.
        assert row[0] - 0.015 <= found[0] <= found[2] <= row[2] + 0.015, name
        for key, i in (("lowest", 0), ("highest", 2)):
            assert name not in AT_THE_ENDS[key] or found[i] == pytest.approx(row[i], abs=0.015), name
    table = tables["root_stress_study"]
    cornell_rows = rows_of(table, "cornell")
    broken = cornell_rows["reason"] != ""
    assert all("no radial flank" in reason for reason in cornell_rows["reason"][broken])
    tip = rows_of(table, "heywood")
    tip = tip["ratio_to_fe"][tip["load_position"] == 1.0]
    assert 0.9 < tip.min() < tip.max() < 1.02


@pytest.mark.dear
def test_the_finite_elements_of_the_study_are_fine_enough():
    # The study's coarse meshes against the default ones with a fillet twice as fine, on a sharp and a soft root.
    scene = read_scene(CASES / "root_stress_validation.toml")
    coarse = mesh_settings(scene.case.accuracy)
    fine = MeshSettings(root_edge_length=0.5 * coarse.root_edge_length)
    gears = variants(scene.gears["base"], [100], [0.0], [0.1, 0.38])
    for a, b in zip(
        root_stress_study(gears, [0.4, 1.0], coarse), root_stress_study(gears, [0.4, 1.0], fine), strict=True
    ):
        assert a.fe == pytest.approx(b.fe, rel=0.015)


def test_gears_that_cannot_be_are_marked_and_the_study_goes_on():
    base = Gear(Tooth(28, BasicRack(1.0, 1.25, 0.25)), 1e-3, 6e-3)
    some = variants(base, [28], [0.0], [0.25, 5.0])
    found = root_stress_study(some, [0.5], MeshSettings().scaled(1.6))
    assert found[0].fe[0] > 0.0
    assert np.isnan(found[1].fe).all()
    assert found[1].variant.reason.startswith("no such gear")
    tables, _, _ = run(
        "root_stress_validation", "study={gear='base', rack_tip_radius=[0.25, 5.0], load_position=[1.0]}"
    )
    table = tables["root_stress_study"]
    assert all("no such gear" in reason for reason in table["reason"][table["rack_tip_radius"] == 5.0])
    assert np.isfinite(table["ratio_to_fe"][table["rack_tip_radius"] == 0.25]).all()


@pytest.mark.long
def test_a_population_ends_with_its_distribution_and_a_sentence_for_each_formula():
    tables, _, results = run("root_stress_population", "study.samples=2", "study.pressure_angle=['20 deg', '25 deg']")
    table = tables["root_stress_study"]
    assert len(table["teeth"]) == 2 * 8 * len(ROOT_STRESS_SOURCES)
    assert ((table["rack_dedendum"] >= 1.15) & (table["rack_dedendum"] <= 1.4)).all()
    assert len(set(table["pressure_angle"].tolist())) == 2
    assert (table["stress_fe_error"] < 0.02 * table["stress_fe"]).all()
    assert (table["stress_fe_error"] > 0.0).all()
    assert [figure.key for figure in results.figures] == ["root_stress_spread"]
    panels = results.figures[0].panels
    assert [len(panel.items) for panel in panels] == [len(set(table["formula"][np.isfinite(table["ratio_to_fe"])]))] * 2
    said = [
        r
        for r in results.remarks
        if "90 % of its values are" in r or "gives no value for any gear of this population." in r
    ]
    assert len(said) == len(ROOT_STRESS_SOURCES)
    # every row's numbers are those of the gear that they name
    gear = table["formula"] == "iso-6336-3"
    i = int(np.flatnonzero(gear)[-1])
    rack = BasicRack(
        1.0, table["rack_dedendum"][i], table["rack_tip_radius"][i], math.radians(table["pressure_angle"][i])
    )
    tooth = Tooth(int(table["teeth"][i]), rack, table["profile_shift"][i])
    pure = ROOT_STRESS_SOURCES["iso-6336-3"].formula(tooth, table["load_radius"][i]).stress
    assert table["stress"][i] == pytest.approx(pure, rel=1e-6)


@pytest.mark.parametrize(
    ("ratio", "word"),
    [(1.06, "high"), (0.94, "low"), (1.04, "within 5 %"), (0.96, "within 5 %"), (math.nan, "breaks down")],
)
def test_verdicts(ratio, word):
    assert verdict(ratio) == word


def test_a_formula_that_finds_compression_has_a_reason():
    # Wide roots of many shifted teeth under a low load: the Lewis section sees more compression than bending.
    tooth = Tooth(100, BasicRack(1.0, 1.25, 0.25), profile_shift=0.5)
    low, middle = (tooth.form_radius + t * (tooth.tip_radius - tooth.form_radius) for t in (0.1, 0.6))
    answers = root_stress_answers(tooth, [low, middle])
    assert "radial compression exceeds bending" in answers["agma-908"].reasons[0]
    assert np.isnan(answers["agma-908"].stress[0])
    assert answers["agma-908"].stress[1] > 0.0


def test_positions_off_a_flank_keep_their_own_reason():
    gear = Gear(Tooth(28, BasicRack(1.0, 1.25, 0.25)), 3.175e-3, 20e-3)
    pair = GearPair(gear, gear)
    answers = pair_compliance_answers(pair, [pair.x_start, 0.0, 3.0 * pair.x_end], 1e5)["cornell"]
    assert [bool(reason) for reason in answers.reasons] == [False, False, True]
    assert np.isnan(answers.total).tolist() == [False, False, True]


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        (["study={gear='b'}"], "study.gear"),
        (["study={teeth=[3]}"], "study.teeth"),
        (["study={load_position=[1.5]}"], "load_position"),
        (["study={teeth=[]}"], "must not be empty"),
        (["gear.base.tip_diameter=31 mm"], "is not used in a study of many gears"),
        (["study={pressure_angle=['20 deg']}"], "set samples (number of gears)"),
        (["study={samples=4, teeth=[20, 30, 40]}"], "must be one value, or minimum and maximum"),
        (["study={samples=4, rack_tip_radius=[0.3, 0.1]}"], "must be one value, or minimum and maximum"),
    ],
)
def test_studies_that_mean_nothing_are_refused(overrides, words):
    with pytest.raises(InputError, match=re.escape(words)):
        run("root_stress_validation", *overrides)


@pytest.mark.dear
def test_the_command_writes_tables_pictures_and_report(tmp_path):
    with pytest.raises(SystemExit) as left:
        program()(["run", str(CASES / "cornell_test_gear.toml"), "--out", str(tmp_path / "o")])
    assert left.value.code in (0, None)
    for name in ("root_stress_test", "compliance_test", "compliance_I"):
        assert (tmp_path / "o" / "plots" / f"crosscheck_{name}.png").stat().st_size > 20_000
        with (tmp_path / "o" / "tables" / f"crosscheck_{name}.csv").open(newline="", encoding="utf-8") as stream:
            head = next(csv.reader(stream))
        assert head[0] == "formula"
        assert head[-1] == "reason"
        assert "ratio_to_fe" in head
    assert "crosscheck_root_stress_test" in (tmp_path / "o" / "report.html").read_text("utf-8")


@pytest.mark.dear
def test_the_study_ends_with_its_pictures(tmp_path):
    with pytest.raises(SystemExit):
        program()([
            "run", str(CASES / "root_stress_validation.toml"), "--out", str(tmp_path / "o"),
            "--set", "study={gear='base', teeth=[20, 28], load_position=[0.5, 1.0]}",
            "--set", "gear.base.module='2 mm'",
        ])  # fmt: skip
    names = {path.name for path in (tmp_path / "o" / "plots").iterdir()}
    assert names == {"root_stress_study.png", "root_stress_ratios.png", "root_stress_histogram.png"}
    assert [path.name for path in (tmp_path / "o" / "tables").iterdir()] == ["root_stress_study.csv"]
    # The formula's pure number over the module of 2 mm is the stress per line load.
    with (tmp_path / "o" / "tables" / "root_stress_study.csv").open(encoding="utf-8") as file:
        rows = [row for row in csv.DictReader(file) if (row["formula"], row["teeth"]) == ("iso-6336-3", "20")]
    tooth = read_scene(CASES / "root_stress_validation.toml").gears["base"].tooth
    formula = ROOT_STRESS_SOURCES["iso-6336-3"].formula
    for row in rows:
        pure = formula(Tooth(20, tooth.rack, tooth.profile_shift), float(row["load_radius [mm]"]) / 2.0).stress
        assert float(row["stress [MPa.mm/N]"]) == pytest.approx(pure / 2.0, rel=1e-9)
        assert 0.5 < float(row["stress [MPa.mm/N]"]) / float(row["stress_fe [MPa.mm/N]"]) < 1.5
