"""Result ``stiffness-study``: formulas over finite elements of random pairs, against single pairs by other ways."""

import re

import numpy as np
import pytest

import fegear
from fegear.base.notes import NoteClass, class_of
from fegear.base.printed import percent
from fegear.contact.compared.population import drawn_gears
from fegear.contact.compared.stiffness_study import MESH, SINGLE, compare_stiffness, drawn_pairs
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import solve_gear
from fegear.formulas.iso6336.part1_stiffness import pair_stiffness
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack

pytestmark = pytest.mark.dear
STUDY = {"samples": 12, "seed": 3, "teeth": [18, 80], "profile_shift": [-0.2, 0.4]}
BASE = {"teeth": 28, "module": "2 mm", "rack": "ISO 53 A"}


def case(**study):
    return {"results": ["stiffness-study"], "gear": {"a": BASE}, "study": {**STUDY, **study}}


@pytest.fixture(scope="module")
def found():
    return fegear.run(case(), progress=False)


def rows(found):
    table = found.tables["stiffness_study"]
    return {column.name: np.asarray(column.values) for column in table.columns}


def test_quantiles_are_those_of_the_rows(found):
    table, values = rows(found), found.values
    assert len(set(table["pair"])) == 12
    for quantity in (SINGLE, MESH):
        for formula in ("iso-6336-1", "weber-banaschek"):
            ratio = table["ratio_to_fe"][(table["quantity"] == quantity) & (table["formula"] == formula)]
            assert ratio.size == 12
            low, middle, high = np.quantile(ratio, [0.05, 0.5, 0.95])
            name = f"{quantity}.{formula}"
            assert values[f"{name}.median"].value == pytest.approx(middle, rel=1e-9)
            assert values[f"{name}.percentile_5"].value == pytest.approx(low, rel=1e-9)
            assert values[f"{name}.percentile_95"].value == pytest.approx(high, rel=1e-9)
            assert 0.0 < values[f"{name}.median"].error < high - low
    assert np.array_equal(np.isnan(table["ratio_to_fe"]), table["reason"] != "")
    first, second = found.answer.sentences[:2]
    assert first.startswith("Stiffness c' of one tooth pair by formula / FE, 12 random pairs")
    assert second.startswith("Mean mesh stiffness c_gamma by formula / FE, 12 random pairs")
    assert all(len(number.split(".")[1]) == 3 for number in re.findall(r"\d+\.\d+", first + second))  # to compare
    (figure,) = found.figures
    assert figure.key == "stiffness_spread"
    ratio = table["ratio_to_fe"][np.isfinite(table["ratio_to_fe"])]
    for panel in figure.panels:
        low, high = panel.x.limits  # about what is drawn, by the names of the sentences
        assert min(1.0, ratio.min()) - 0.15 < low < min(1.0, ratio.min())
        assert max(1.0, ratio.max()) < high < max(1.0, ratio.max()) + 0.15
        assert "ISO 6336-1" in {curve.name for curve in panel.items if hasattr(curve, "name")}
    assert figure.panels[1].title == "mean mesh stiffness c_γ"


def test_errors_that_are_due_to_few_pairs_say_so_and_those_of_alike_pairs_do_not(found):
    few = next(one for one in found.remarks if "study.samples" in one)
    assert class_of(few) is NoteClass.BEYOND_TOLERANCE
    table = found.tables["stiffness_study_quantiles"]
    column = {one.name: np.asarray(one.values) for one in table.columns}
    worst = max((column[f"{one}_error"] / column[one]).max() for one in ("median", "percentile_5", "percentile_95"))
    assert few == (
        f"Study of stiffness: estimated errors of medians and percentiles, up to {percent(worst)}, are due to the "
        f"number of pairs (12; finite elements {percent(found.values['fe_error'].si)}); increase study.samples "
        "to reduce them."
    )
    alike = fegear.run(case(teeth=[40, 41], profile_shift=[0.0, 0.01]), progress=False)
    assert not [one for one in alike.remarks if "study.samples" in one]


def test_a_pair_of_the_study_has_the_stiffness_of_a_run_and_of_a_solved_gear(found):
    """Mean by finite elements and by a formula as `transmission-error` has them; atlas against solved gears."""
    table = rows(found)
    base = Gear(Tooth(28, BasicRack.named("A")), 2e-3, 0.0125, 0.02)
    bounds = {"teeth": (18.0, 80.0), "profile_shift": (-0.2, 0.4)}
    pair = drawn_pairs(base, bounds, 12, 3)[0]
    assert (table["driver_teeth"][0], table["driven_teeth"][0]) == (pair.driver.teeth, pair.driven.teeth)
    torque = 100e3 * 0.02 * pair.driver.base_radius
    effects = {"neighbour_coupling": True, "hertz": "load-dependent"}

    def mean(quantity, formula):
        here = (table["pair"] == 1) & (table["quantity"] == quantity) & (table["formula"] == formula)
        return float(table["stiffness"][here][0]), float(table["stiffness_fe"][here][0])

    document = {
        "results": ["transmission-error"],
        "gear": {
            name: {"teeth": g.teeth, "module": "2 mm", "profile_shift": g.tooth.profile_shift, "rack": "ISO 53 A",
                   "face_width": "20 mm"}
            for name, g in zip("ab", (pair.driver, pair.driven), strict=True)
        },
        "pair": {"I": {"driver": "a", "driven": "b", "torque": f"{torque} N*m"}},
        "effects": effects,
    }  # fmt: skip
    run = fegear.run(document, progress=False)
    by_formula, fe = mean(MESH, "weber-banaschek")
    assert fe * 20.0 == pytest.approx(run.values["I.mesh_stiffness_mean"].value, rel=2e-3)
    document["pair"]["I"]["compliance"] = {"source": "weber-banaschek"}
    document["effects"] = {"hertz": "load-dependent"}
    run = fegear.run(document, progress=False)
    assert by_formula * 20.0 == pytest.approx(run.values["I.mesh_stiffness_mean"].value, rel=1e-6)
    iso = pair_stiffness(pair, specific_load=pair.tangential_load(100e3))
    assert mean(SINGLE, "iso-6336-1")[0] == pytest.approx(iso.single * 1e-9, rel=1e-6)


def test_gears_that_are_solved_give_what_the_atlas_gives(found):
    base = Gear(Tooth(28, BasicRack.named("A")), 2e-3, 0.5 * 2e-3 * (14.0 - 1.25), 0.02)
    pair = drawn_pairs(base, {"teeth": (18.0, 80.0), "profile_shift": (-0.2, 0.4)}, 12, 3)[0]
    settings = MeshSettings()
    solved = compare_stiffness(pair, lambda gear: solve_gear(gear, settings), 100e3)
    table = rows(found)
    for one in solved.answers:
        here = (table["pair"] == 1) & (table["quantity"] == one.quantity) & (table["formula"] == one.formula)
        assert one.fe * 1e-9 == pytest.approx(float(table["stiffness_fe"][here][0]), rel=1e-3)


def test_the_same_seed_draws_the_same_pairs_and_mates_have_one_rack():
    base = Gear(Tooth(28, BasicRack.named("A")), 2e-3, 0.0125, 0.02)
    bounds = {"teeth": (12.0, 60.0), "profile_shift": (-0.5, 0.8), "rack_tip_radius": (0.1, 0.38)}
    once, again = (drawn_pairs(base, bounds, 8, 5) for _ in range(2))
    assert once == again
    for pair in once:
        assert pair.driver.external_tooth.rack == pair.driven.external_tooth.rack
        assert 1.05 <= pair.contact_ratio < 2.0
        assert pair.tip_clearance("driver") > 0.0
    drawn = [one.gear for one in drawn_gears(base, bounds, 64, 5).gears]
    assert all(pair.driver in drawn for pair in once)


def test_a_study_of_stiffness_needs_samples_and_ranges_in_which_pairs_mesh():
    with pytest.raises(fegear.InputError, match=r"study.samples.*is required for stiffness-study; set samples"):
        fegear.run(case(samples=None) | {"study": {"teeth": [20, 30]}}, progress=False)
    with pytest.raises(fegear.InputError, match="is required for stiffness-study"):
        fegear.run({"results": ["stiffness-study"], "gear": {"a": BASE}}, progress=False)
    stub = {**BASE, "rack": {"addendum": 0.5, "dedendum": 1.25, "tip_radius": 0.2}}  # contact ratio below 1
    with pytest.raises(fegear.InputError, match="gave a pair that meshes; choose narrower ranges"):
        fegear.run(case(teeth=[20, 22]) | {"gear": {"a": stub}}, progress=False)
