"""Ring gears in a rating: the sign of their teeth belongs to involutes, not to speeds, torques, cycles and lives."""

import copy
import math
from dataclasses import replace
from pathlib import Path

import pytest

from fegear.base.errors import RangeError
from fegear.base.solution_cache import SolutionCache
from fegear.case.built.rated_duty import Level
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.formulas.iso6336.life import Knots
from fegear.formulas.iso6336.part6_spectrum import Bin, ServiceLife
from fegear.results.catalogue import STAGES

ROUGH = {"roughness": {"flank_rz": "4 um", "root_rz": "16 um"}, "tolerance_class": 6}
GEARS = {
    "planet": {
        "teeth": 22, "module": "4 mm", "face_width": "50 mm", "strength": {"material": "case-hardened-steel"}, **ROUGH,
    },
    "ring": {
        "internal": True, "teeth": 61, "module": "4 mm", "cutter": {"teeth": 23}, "tip_diameter": "237.2 mm",
        "rim_thickness": "14 mm", "face_width": "50 mm", **ROUGH,
        "strength": {"material": "through-hardened-alloy-steel", "hardness": "300 HV"},
    },
}  # fmt: skip
PLANET_DRIVES = {"driver": "planet", "driven": "ring", "torque": "700 N*m", "speed": "900 rpm"}
RING_DRIVES = {
    "driver": "ring", "driven": "planet", "torque": f"{700 * 61 / 22!r} N*m", "speed": f"{900 * 22 / 61!r} rpm",
}  # fmt: skip
OIL = {"viscosity_40": "100 mm^2/s", "temperature": "70 degC"}


def rated(pair, **more):
    case = {
        "results": ["rating"], "rating": {"beside": []}, "gear": copy.deepcopy(GEARS),
        "pair": {"I": {**pair, "lubricant": OIL, **more}},
    }  # fmt: skip
    scene = build_scene(case, "case", Path())
    done = run_plan(scene, make_plan(scene, STAGES), cache=SolutionCache())
    (outcome,) = (one for task, one in done.outcomes.items() if task.stage == "rating")
    return {value.name: value.si for value in outcome.values}, {table.name: table for table in outcome.tables}, outcome


def member(pair, gear):
    return "driver" if pair["driver"] == gear else "driven"


@pytest.mark.parametrize("pair", [PLANET_DRIVES, RING_DRIVES], ids=["planet drives", "ring drives"])
def test_lives_are_positive_and_those_of_the_cycles_that_are_borne(pair):
    values, _, outcome = rated(pair)
    curves, formula = outcome.data.curves, outcome.data.formula
    for i, (gear, speed) in enumerate((("planet", 900.0), ("ring", 900.0 * 22 / 61))):
        for symbol, curve, stress in (
            ("life_H", curves.contact[i], formula.contact_stress[i]),
            ("life_F", curves.bending[i], formula.bending_stress[i]),
        ):
            life = values.get(f"I.{member(pair, gear)}.{symbol}", math.inf)
            borne = curve.at(life * speed / 60.0) if math.isfinite(life) else curve.values[-1]
            assert life > 0.0
            assert borne >= stress * (1.0 - 1e-9)
    ring = member(pair, "ring")
    flank, load = values[f"I.{ring}.life_H"], formula.contact_stress[1]
    assert curves.contact[1].at(flank * 900.0 * 22 / 61 / 60.0) == pytest.approx(load, rel=1e-9)
    assert flank / 3600.0 == pytest.approx(2162.6, rel=1e-4)


def test_damage_is_what_is_run_over_what_is_borne():
    """Of flanks and of roots: after cycles over damage a test gear of that stress would fail."""
    values, _, outcome = rated({**PLANET_DRIVES, "torque": "2400 N*m"}, operation={"life": "500 h"})
    curves, formula, count = outcome.data.curves, outcome.data.formula, 0
    for i, (gear, speed) in enumerate((("planet", 900.0), ("ring", 900.0 * 22 / 61))):
        for symbol, curve, stress in (
            ("damage_H", curves.contact[i], formula.contact_stress[i]),
            ("damage_F", curves.bending[i], formula.bending_stress[i]),
        ):
            damage = values.get(f"I.{member(PLANET_DRIVES, gear)}.{symbol}", 0.0)
            if math.isfinite(damage) and damage > 0.0:
                assert curve.at(500.0 * 60.0 * speed / damage) == pytest.approx(stress, rel=1e-9)
                count += symbol == "damage_F"
    assert count >= 1


def test_which_gear_drives_changes_no_life():
    one, other = (rated(pair)[0] for pair in (PLANET_DRIVES, RING_DRIVES))
    for gear in GEARS:
        for symbol in ("life_H", "damage_H", "S_H", "S_F"):
            a, b = (values.get(f"I.{member(pair, gear)}.{symbol}", math.inf) for pair, values in
                    ((PLANET_DRIVES, one), (RING_DRIVES, other)))  # fmt: skip
            assert b == pytest.approx(a, rel=1e-9)


@pytest.mark.parametrize("pair", [PLANET_DRIVES, RING_DRIVES], ids=["planet drives", "ring drives"])
def test_a_spectrum_of_the_nominal_load_alone_is_the_nominal_load(pair):
    operation = {"life": "500 h", "spectrum": [{"load_factor": 1.0, "share": 1.0}]}
    under, tables, _ = rated(pair, operation=operation)
    plain, *_ = rated(pair, operation={"life": "500 h"})
    (level,) = tables["rating_spectrum_I"]["torque"].tolist()
    assert level == pytest.approx(float(pair["torque"].split()[0]), rel=1e-12)
    assert tables["rating_spectrum_I"]["speed"][0] == pytest.approx(float(pair["speed"].split()[0]))
    for one in ("driver", "driven"):
        for symbol in ("S_H", "S_F"):
            key = f"I.{one}.{symbol}"
            # a level's safety stretches to its load cycles on the S-N line, which a rating reads at those cycles
            assert under[f"{key}_spectrum"] == pytest.approx(plain[key], rel=1e-9)
        life = [values.get(f"I.{one}.life_H", math.inf) for values in (under, plain)]
        assert life[0] == pytest.approx(life[1], rel=1e-9)
        if f"I.{one}.equivalent_torque_H" in under:
            assert under[f"I.{one}.equivalent_torque_H"] > 0.0


def test_k_v_by_method_c_takes_a_ring():
    values, *_ = rated(PLANET_DRIVES | {"speed": "200 rpm"}, iso_6336={"dynamic_method": "C"})
    assert 1.0 < values["I.K_v_rated"] < 1.5


def test_the_ring_is_loaded_between_its_root_and_its_tip_and_has_a_safety():
    """d_en of the ring, in virtual modules; with the sign of d wrong it lay far off the tooth, S_F below zero."""
    *_, outcome = rated(PLANET_DRIVES)
    formula = outcome.data.formula
    place = formula["d_en"].values[1]
    assert 237.2e-3 <= place <= 2.0 * outcome_ring_root()
    assert formula.bending_safety[1] == pytest.approx(formula.bending_permissible[1] / formula.bending_stress[1])
    assert min(formula.bending_safety) > 0.0
    for name in ("contact_safety", "bending_safety", "bending_stress"):
        with pytest.raises(RangeError, match="must be positive"):
            replace(formula, **{name: (1.0, -0.152)})


def outcome_ring_root():
    scene = build_scene({"results": ["geometry"], "gear": GEARS}, "case", Path())
    return scene.gears["ring"].root_radius


@pytest.mark.parametrize(
    ("made", "said"),
    [
        (lambda: ServiceLife(-1.0, 1.0), "life of the flank"),
        (lambda: ServiceLife(math.inf, -2162.6 * 3600.0), "life of the root"),
        (lambda: Bin(1e9, -1.0, Knots((1.0, 10.0), (2e9, 1e9))), "cycles"),
        (lambda: Bin(-1e9, 1.0, Knots((1.0, 10.0), (2e9, 1e9))), "stress"),
        (lambda: Level(-1.0, 1.0, 1.0, (1.0, 1.0)), "load of a level"),
        (lambda: Level(1.0, -1.0, 1.0, (1.0, 1.0)), "speed of a level"),
        (lambda: Level(1.0, 1.0, 1.0, (1.0, -1.0)), "load cycles of a level"),
    ],
)
def test_what_cannot_be_negative_is_refused_by_its_own_class(made, said):
    with pytest.raises(RangeError, match=rf"(?s){said}.*must not be negative"):
        made()


def test_the_signed_numbers_of_a_ring_are_used_by_the_formulas_of_the_standard_only():
    root = Path(__file__).parents[2] / "fegear"
    users = {
        path.relative_to(root).parts[0]
        for path in root.rglob("*.py")
        if any(f".signed_{name}" in path.read_text() for name in ("teeth", "diameters", "base_diameters", "ratio"))
    }
    assert users == {"formulas", "verify"}
