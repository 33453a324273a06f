"""Cases that choose where their root stress comes from: a formula's chain by hand, beside finite elements, refusals."""

import math
import re
from functools import cache
from pathlib import Path
from typing import get_args

import numpy as np
import pytest
from solved_once import CACHE

from fegear.base.errors import InputError
from fegear.case.pair import RootStressName
from fegear.case.reading import read_scene
from fegear.contact.plane.formula_root_stress import formula_root_stress
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.formulas.root_stress_formulas import ROOT_STRESS_SOURCES
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.results.catalogue import STAGES
from fegear.results.forecasts import ROOT_STRESS_CITATIONS

CASES = Path(__file__).parents[2] / "cases"
HISTORY = 'results=["root-stress-history"]'
#: A pair in closed form throughout, and the rig with the paper's own root.
PAIR = ("calculix_pair", HISTORY, 'pair.I.compliance.source="weber-banaschek"', "effects={}", "pair.I.loads=['800 N']")
RIG = ("four_square_dynamics", 'results=["dynamic-root-stress"]')


@cache
def run(name, *overrides):
    scene = read_scene(CASES / f"{name}.toml", overrides)
    results = run_plan(scene, make_plan(scene, STAGES), cache=CACHE)
    tables = {table.name: {column.head: column.values for column in table.columns} for table in results.tables}
    return scene, tables, {value.name: value for value in results.values}, results


def source(*names):
    return f"pair.I.root_stress={{source={list(names)}}}"


def test_every_formula_can_be_chosen_and_is_cited():
    names = set(get_args(RootStressName))
    assert names == {"fe", *ROOT_STRESS_SOURCES} == set(ROOT_STRESS_CITATIONS)


@pytest.mark.parametrize("name", ROOT_STRESS_SOURCES)
def test_table_over_the_flank_is_the_formula(name):
    rng = np.random.default_rng(7)
    gear = read_scene(CASES / "cornell_test_gear.toml").gears["test"]
    ends = gear.form_radius, gear.involute_tip_radius
    table = formula_root_stress(gear, name, *ends)
    for radius in (*ends, *rng.uniform(*ends, 5)):
        direct = ROOT_STRESS_SOURCES[name].formula(gear.tooth, radius / gear.module).stress / gear.module
        assert float(table.root_stress(0, 0, radius, "tension")[0, 0]) == pytest.approx(direct, rel=1e-5)
    assert not table.root_stress(1, 0, radius, "tension").any()
    assert table.root_stress(0, 0, radius, "compression") is None
    assert np.isnan(table.root_stress_error(0, 0, radius)).all()


def test_a_formula_is_blank_where_it_does_not_hold_and_exact_up_to_there():
    """Wide roots of many shifted teeth under a low load: the Lewis section sees more compression than bending."""
    tooth = Tooth(100, profile_shift=0.5)
    gear = Gear(tooth, 1e-3, 0.5e-3 * tooth.root_radius)
    low = (tooth.form_radius + 0.1 * (tooth.tip_radius - tooth.form_radius)) * 1e-3
    found = formula_root_stress(gear, "agma-908", low, gear.tip_radius)
    (part,), (why,) = found.over_length, found.missing
    assert re.match(r"no value for loads at radii 49\.6466 to 49\.\d+ mm \(.*radial compression exceeds bending", why)
    assert found.remarks[-1].endswith("; left blank, extremes are from the other loads")

    def direct(length: float) -> float:
        return ROOT_STRESS_SOURCES["agma-908"].formula(tooth, math.hypot(gear.base_radius, length) / gear.module).stress

    assert direct(part.x[0]) > 0.0 >= direct(part.x[0] * (1.0 - 1e-6))  # it begins to hold there
    first = math.sqrt(low**2 - gear.base_radius**2)
    radii = np.hypot(gear.base_radius, np.linspace(first * (1.0 + 1e-9), part.x[-1] * (1.0 - 1e-9), 41))
    table = found.root_stress(0, 0, radii, "tension")[0]
    exact = np.array([direct(math.sqrt(r**2 - gear.base_radius**2)) / gear.module for r in radii])
    assert part.x[0] > first
    assert (np.isnan(table) == (radii < np.hypot(gear.base_radius, part.x[0]))).all()
    np.testing.assert_allclose(table, np.where(np.isnan(table), np.nan, exact), rtol=1e-5, atol=5e-5 * exact.max())


MANY_TEETH = (
    "gear.a.teeth=45", "gear.b={teeth=137, module='2.5 mm', face_width='56 mm', bore_radius='60 mm'}",
    "gear.a.module=2.5 mm", "gear.a.face_width=56 mm", "gear.a.bore_radius=30 mm", "pair.I.driven=b",
    "effects={}", "pair.I.load=8 kN", "pair.I.loads=['3 kN', '5 kN']", "pair.I.compliance={source='weber-banaschek'}",
)  # fmt: skip


def test_a_formula_that_fails_at_some_positions_is_planned():
    """The low loads on a gear of 137 teeth have no section of ISO 6336-3; the whole run was refused."""
    for names in (("fe", "iso-6336-3"), ("iso-6336-3",)):
        make_plan(read_scene(CASES / "calculix_pair.toml", (HISTORY, *MANY_TEETH, source(*names))), STAGES)


@pytest.mark.dear
def test_a_formula_that_fails_at_some_positions_takes_nothing_with_it():
    _, tables, values, results = run("calculix_pair", HISTORY, *MANY_TEETH, source("heywood", "iso-6336-3"))
    _, alone, other, _ = run("calculix_pair", HISTORY, *MANY_TEETH, source("heywood"))
    for gear in "ab":
        table = tables[f"root_stress_history_I_{gear}"]
        blank = np.isnan(table["stress_iso_6336_3 [MPa]"])
        assert blank.any() == (gear == "b")
        assert np.count_nonzero(blank) < 0.1 * blank.size
        # where it is blank the pair carries; under each load alike, and all else is there
        for column in ("stress_iso_6336_3 at 3000 N [MPa]", "stress_iso_6336_3 at 5000 N [MPa]"):
            assert (np.isnan(table[column]) == blank).all()
        assert np.isfinite(table["stress [MPa]"]).all()
        wanted = alone[f"root_stress_history_I_{gear}"]
        np.testing.assert_allclose(np.interp(wanted["x [mm]"], table["x [mm]"], table["stress [MPa]"]),
                                   wanted["stress [MPa]"], rtol=1e-6, atol=1e-3)  # fmt: skip
    for name, value in other.items():
        assert values[name].si == pytest.approx(value.si, rel=1e-9)
    assert values["I.driven.largest_root_tension_iso_6336_3"].si > 100e6
    said = [note for outcome in results.outcomes.values() for note in outcome.remarks if "no value for loads" in note]
    assert len(said) == 1
    assert said[0].startswith("Pair I, gear b, root stress by iso-6336-3: no value for loads at radi")


def test_a_formula_that_holds_nowhere_leaves_its_columns_blank_beside_others():
    formula = "pair.I.compliance={source='weber-banaschek'}"
    changes = ("effects={}", "gear.a.teeth=80", "gear.a.bore_radius='60 mm'", formula)
    _, tables, values, results = run("calculix_pair", HISTORY, *changes, source("heywood", "cornell"))
    table = tables["root_stress_history_I_a"]
    assert np.isnan(table["stress_cornell [MPa]"]).all()
    assert np.isfinite(table["stress [MPa]"]).all()
    assert not any("cornell" in name for name in values)
    notes = [note for outcome in results.outcomes.values() for note in outcome.remarks]
    assert any("root stress by cornell: no value for loads at radii" in note for note in notes)
    with pytest.raises(InputError, match="is not valid on the flank: no value for loads"):
        run("calculix_pair", HISTORY, *changes, source("cornell"))


@pytest.mark.parametrize("name", ["cornell", "iso-6336-3"])
def test_history_is_load_times_formula_on_both_gears(name):
    """No finite element anywhere: the load on the pair from load sharing, the formula by hand at each contact."""
    scene, tables, values, results = run(*PAIR[:2], *PAIR[2:], source(name))
    assert not any("gear-solution" in str(task) for task in results.outcomes)
    pair = scene.pairs["I"]
    shared = run(PAIR[0], 'results=["load-sharing"]', *PAIR[2:])[1]["load_sharing_I"]
    for label, member in (("I_a", "driver"), ("I_a_driven", "driven")):
        table = tables[f"root_stress_history_{label}"]
        assert not any("compression" in head or "error" in head for head in table)
        x, stress = table["x [mm]"], table["stress [MPa]"]
        on = (x > pair.x_start * 1e3 + 0.01) & (x < pair.x_end * 1e3 - 0.01)
        load = np.interp(x, shared["x [mm]"], shared["load [N]"])
        gear, width = pair.gear(member), min(pair.driver.face_width, pair.driven.face_width)
        for i in np.flatnonzero(on)[::23]:
            radius = float(pair.radius(x[i] * 1e-3, member))
            per_load = ROOT_STRESS_SOURCES[name].formula(gear.tooth, radius / gear.module).stress / gear.module
            assert stress[i] == pytest.approx(per_load * load[i] / width * 1e-6, rel=2e-3)
        assert not stress[~on & ((x < pair.x_start * 1e3 - 0.01) | (x > pair.x_end * 1e3 + 0.01))].any()
        assert values[f"I.{member}.largest_root_tension"].si_error is None
    # identical gears: what the driver's tooth feels at x, the driven one's feels at -x
    a, b = (tables[f"root_stress_history_{label}"] for label in ("I_a", "I_a_driven"))
    mirrored = np.interp(-a["x [mm]"], b["x [mm]"], b["stress [MPa]"])
    assert np.median(np.abs(mirrored - a["stress [MPa]"])) < 1e-3 * a["stress [MPa]"].max()


def test_stress_from_the_neighbours_loads_has_an_error_too():
    """It was zero wherever a tooth carries nothing itself, and less than round-off of the sections beside that."""
    _, tables, _, _ = run(
        "calculix_pair", HISTORY, "effects.corner_contact=false", "accuracy={tolerance=5e-3}", "pair.I.loads=['800 N']"
    )
    for label in ("I_a", "I_a_driven"):
        table = tables[f"root_stress_history_{label}"]
        stress, error = np.abs(table["stress [MPa]"]), table["stress_error [MPa]"]
        most = int(np.argmax(stress))
        felt = stress > 1e-6 * stress.max()
        assert (error[felt] >= 0.5 * error[most] / stress[most] * stress[felt]).all()


def test_formula_stands_beside_finite_elements_and_changes_nothing_of_theirs():
    coarse = ("effects.corner_contact=false", "accuracy={tolerance=5e-3}", "pair.I.loads=['800 N']")
    _, alone, told, _ = run("calculix_pair", HISTORY, *coarse)
    _, both, found, results = run("calculix_pair", HISTORY, *coarse, source("fe", "cornell"))
    _, turned, other, _ = run("calculix_pair", HISTORY, *coarse, source("cornell", "fe"))
    for label in ("I_a", "I_a_driven"):
        a, b, c = (one[f"root_stress_history_{label}"] for one in (alone, both, turned))
        shared = np.isin(b["x [mm]"], a["x [mm]"])  # the formula's own peaks are rows of their own
        assert a["x [mm]"].size <= shared.sum()
        for key in set(a) - {"t [s]"}:
            for x, value in zip(a["x [mm]"], a[key], strict=True):
                assert value in b[key][b["x [mm]"] == x]
        np.testing.assert_array_equal(b["stress [MPa]"], c["stress_fe [MPa]"])
        np.testing.assert_array_equal(b["compression [MPa]"], c["compression_fe [MPa]"])
        np.testing.assert_array_equal(b["stress_cornell [MPa]"], c["stress [MPa]"])
    assert set(told) < set(found)
    assert found["I.driver.largest_root_tension_cornell"].si == other["I.driver.largest_root_tension"].si
    assert any("does not include the loads on neighbouring" in remark for remark in results.remarks)
    names = [curve.name for figure in results.figures for panel in figure.made().panels for curve in panel.items]
    assert sum("cornell" in name for name in names) == 2
    assert sum("finite elements" in name for name in names) == 4


def test_dynamic_root_stress_is_tooth_force_times_formula():
    scene, tables, values, results = run(*RIG[:1], 'results=["tooth-force", "dynamic-root-stress"]', source("cornell"))
    assert not any("gear-solution" in str(task) for task in results.outcomes)
    force, pair = tables["tooth_force_I"], scene.pairs["I"]
    gear = pair.driver
    for label, member in (("I_test", "driver"), ("I_test_driven", "driven")):
        table = tables[f"root_stress_history_{label}"]
        for column, load in (
            ("stress [MPa]", "force_with_others [N]"), ("stress_own_mesh [MPa]", "force [N]"),
            ("static_stress [MPa]", "static [N]"),
        ):  # fmt: skip
            for i in range(5, 200, 39):
                radius = float(pair.radius(table["x [mm]"][i] * 1e-3, member))
                per_load = ROOT_STRESS_SOURCES["cornell"].formula(gear.tooth, radius / gear.module).stress
                expected = per_load / gear.module * force[load][i] / gear.face_width
                assert table[column][i] * 1e6 == pytest.approx(expected, rel=1e-5)
        assert "stress_error [MPa]" not in table
        assert values[f"I.{member}.largest_dynamic_root_tension"].si_error is None


@pytest.mark.parametrize(
    ("case", "overrides", "words"),
    [
        ("calculix_pair", (HISTORY, source("cornel")), r"root_stress.*source.*cornel"),
        ("calculix_pair", (HISTORY, source("fe", "fe")), "contains a source twice"),
        ("calculix_pair", (HISTORY, "pair.I.root_stress={source=[]}"), "root_stress"),
        ("calculix_pair", (HISTORY, "pair.I.root_stress={sourc='fe'}"), 'unknown key; known here: source'),
        (
            "calculix_pair", (HISTORY, "gear.a.teeth=80", "gear.a.bore_radius='60 mm'", source("cornell")),
            "pair.I.root_stress.source = \"cornell\": is not valid on the flank.* no radial flank.*gear a.*choose",
        ),
        ("litvin_lead", ('pair.I.root_stress={source="cornell"}',), r"is defined for the plane \(2D\) model"),
    ],
)  # fmt: skip
def test_refusals_say_what_to_do(case, overrides, words):
    def plan():
        make_plan(read_scene(CASES / f"{case}.toml", overrides), STAGES)

    with pytest.raises(InputError, match=words):
        plan()
