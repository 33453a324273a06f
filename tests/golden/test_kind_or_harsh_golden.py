"""The page "Where a formula is kind or harsh" says what its tables say."""

import importlib.util
import sys
from pathlib import Path

import numpy as np
import pytest

STUDIES = Path(__file__).resolve().parents[2] / "benchmarks"


@pytest.fixture(scope="module")
def study():
    sys.path.insert(0, str(STUDIES))
    try:
        spec = importlib.util.spec_from_file_location("kind_or_harsh_study", STUDIES / "kind_or_harsh_study.py")
        module = importlib.util.module_from_spec(spec)
        spec.loader.exec_module(module)
    finally:
        sys.path.remove(str(STUDIES))
    return module


@pytest.mark.dear
def test_the_page_says_what_its_tables_say(study):
    page = study.PAGE.read_text("utf-8")
    assert study.filled(page) == page


def test_the_population_is_the_one_that_the_script_draws(study):
    table = study.population()
    first = table["formula"] == "iso-6336-3"
    assert first.sum() == 8 * sum(study.GEARS.values())
    base = study.Gear(study.Tooth(28, study.BasicRack(1.0, 1.25, 0.25)), 1e-3, 6.375e-3)
    drawn = study.drawn_gears(base, study.BOX, 128, study.SEED + 20)
    z = np.repeat([d.gear.teeth for d in drawn.gears], 8)
    assert (table["teeth"][first][: z.size] == z).all()
    # and a formula of the first gear is what the table holds
    gear, at = drawn.gears[0].gear, drawn.gears[0].load_position
    answers = study.of_population(drawn)[0]
    assert answers.load_position == at
    from fegear.contact.compared.crosscheck import root_stress_answers
    from fegear.contact.compared.root_stress_study import load_radii

    found = root_stress_answers(gear.tooth, load_radii(gear, at) / gear.module)["iso-6336-3"].stress
    kept = (table["ratio_to_fe"] * table["stress_fe"])[first][:8]
    assert kept == pytest.approx(found, rel=1e-3, nan_ok=True)


def test_formulas_of_the_helical_table_are_what_the_program_says(study):
    helical = study.helical
    for row in helical.table()[:4]:
        pair = helical.the_pair(helical.population()[int(row["pair"])])
        found = helical.formulas(pair, row["member"])
        assert [float(row[k]) for k in ("iso_2006", "iso_2019", "agma")] == pytest.approx(found, rel=1e-5)
    assert study.helical_error() < 0.02


def test_the_closed_formula_is_more_than_a_tenth_off_on_both_pairs(study):
    rows = study.khbeta.table()
    for name in study.khbeta.STUDIED:
        k = [float(r["K_Hbeta"]) for r in rows if r["case"] == name]
        assert k[-1] > 1.1 * k[0]
        # the changes multiply to all of the difference
        changes = [1.0 + float(r["change"]) for r in rows if r["case"] == name and r["change"]]
        assert np.prod(changes) == pytest.approx(k[-1] / k[0], rel=1e-3)


@pytest.mark.long
def test_the_rows_of_k_hbeta_come_out_again(study):
    for name in study.khbeta.STUDIED:
        rows = [r for r in study.khbeta.table() if r["case"] == name]
        found = study.khbeta.ladder(name, study.khbeta.COARSE)
        for row, (k, _) in zip(rows, found, strict=True):
            assert k == pytest.approx(float(row["K_Hbeta"]), abs=2.0 * float(row["error"]) + 1e-3)


@pytest.mark.long
def test_a_helical_pair_comes_out_again(study):
    row = study.helical.rows(3, study.helical.TOLERANCE)[0]
    kept = next(r for r in study.helical.table() if r["pair"] == "3" and r["member"] == "driver")
    assert float(row[11]) == pytest.approx(float(kept["fe"]), rel=5e-3)
    assert float(row[12]) == pytest.approx(float(kept["fe_even"]), rel=5e-3)


def test_both_editions_of_iso_6336_3_are_one_on_a_spur_tooth_and_part_on_a_helical_one(study):
    from fegear.formulas.iso6336.part3_pair import RatingChoice, rate_spur

    tooth = study.Tooth(25, study.BasicRack(1.0, 1.25, 0.25), 0.2)
    gear = study.Gear(tooth, 3e-3, 0.02, 0.03)
    pair = study.helical.GearPair(gear, study.Gear(study.Tooth(40, tooth.rack), 3e-3, 0.03, 0.03))
    one, other = (rate_spur(pair, "driver", 3e5, RatingChoice(e)).stress for e in (2006, 2019))
    assert one == other
    ratios = study.helical_ratios("fe")
    apart = ratios["iso_2019"] / ratios["iso_2006"]
    assert apart.min() < 0.99
    assert apart.max() > 1.1
