"""Cheap runs with nearly every result: they give what is kept, and their columns agree with each other."""

import importlib.util
import math
from pathlib import Path

import numpy as np
import pytest

import fegear
from fegear.base.notes import OPEN
from fegear.case.drafts.answers import Answers
from fegear.case.drafts.kinds import KINDS
from fegear.case.drafts.text import draft
from fegear.engine.run import Silence
from fegear.output.figures import described
from fegear.output.report.blocks import Group
from fegear.output.report.run import run_page
from fegear.results.catalogue import RESULTS

_SPEC = importlib.util.spec_from_file_location("small_net", Path(__file__).with_name("small_net.py"))
small_net = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(small_net)


def close(one, other, slack=1e-9):
    np.testing.assert_allclose(
        one, other, rtol=slack, atol=slack * np.abs(np.asarray(other, dtype=float)).max(initial=0)
    )


def columns(table):
    return {column.name: column.si for column in table.columns}


def number_of(found, name):
    return {value.name: value.si for value in found.values}[name]


# ---- what holds of every table


def check_any(table):
    for column in table.columns:
        if column.si.dtype.kind != "f":
            continue
        known = column.si[np.isfinite(column.si)]
        name = column.name
        if name.endswith("_error") and name not in {"tangential_error", "radial_error"}:
            assert (known >= 0.0).all(), f"{table.name}.{name}: an error below zero"
        if not name.endswith(("_rank", "_share")) and name.startswith(
            ("S_H", "S_F", "life", "hertz_pressure", "half_width", "frequency", "mesh_stiffness")
        ):
            assert (known >= 0.0).all(), f"{table.name}.{name}: below zero"
        if name.startswith(("share_", "printed_share", "energy_")) or name == "share":
            assert ((known >= -1e-9) & (known <= 1.3)).all(), f"{table.name}.{name}: no share"
    data = columns(table)
    for name in data:
        if name.endswith("_re") and f"{name[:-3]}_abs" in data:
            close(data[f"{name[:-3]}_abs"], np.hypot(data[name], data[f"{name[:-3]}_im"]))


# ---- what holds of tables of one kind


def check_load_sharing(data, name, found):
    pair = name.removeprefix("load_sharing_")
    total = data["load"][data["share"] > 0.5].mean() / data["share"][data["share"] > 0.5].mean()
    close(data["load"], data["share"] * total)
    assert ((data["hertz_pressure"] > 0.0) == (data["load"] > 0.0)).all()
    assert (np.diff(data["x"]) >= 0.0).all()
    steps = np.diff(data["roll_angle"]) / np.maximum(np.diff(data["x"]), 1e-12)
    steps = steps[(data["corner"][1:] == 0) & (data["corner"][:-1] == 0) & (np.diff(data["x"]) > 0.0)]
    close(steps, np.full(steps.size, steps[0]), 1e-6)  # along the line of action the roll angle grows evenly
    close(np.nanmax(data["load"]), number_of(found, f"{pair}.largest_load"), 1e-6)
    close(np.nanmax(data["share"]), number_of(found, f"{pair}.largest_share"), 1e-6)


def check_transmission_error(data, name, found):
    pair = name.removeprefix("transmission_error_")
    te, values = data["te"], {value.name: value.si for value in found.values}
    if f"{pair}.te_peak_to_peak" in values:
        close(np.ptp(te), values[f"{pair}.te_peak_to_peak"], 0.03)
        assert te.min() <= values[f"{pair}.te_mean"] <= te.max()
    assert (np.diff(data["x"]) >= 0.0).all()
    assert set(np.unique(data["pairs_in_contact"])) <= set(range(1, 5))
    assert (data["local_stiffness"] >= data["mesh_stiffness"] * 0.8).all()


def check_harmonics(data, name, found):
    close(data["amplitude"], np.hypot(data["cosine"], data["sine"]))
    assert (data["n"] == 1 + np.arange(data["n"].size)).all()
    pair = name.removeprefix("transmission_error_harmonics_")
    close(data["amplitude"][0], number_of(found, f"{pair}.te_first_harmonic"))


def check_bearing_forces(data, _name, _found):
    close(data["force_radial"], np.hypot(data["force_x"], data["force_y"]))
    assert (data["life"][np.isfinite(data["life"])] > 0.0).all()
    assert (data["shift"] >= 0.0).all()
    assert (data["tilt"] >= 0.0).all()


def check_modes(data, _name, _found):
    assert (np.diff(data["frequency"]) >= 0.0).all()
    energies = [data[key] for key in data if key.startswith("energy_")]
    if energies:
        assert (np.sum(energies, axis=0) <= 1.0 + 1e-9).all()  # the rest is in the shafts


def check_spectrum(data, name, found):
    """Largest line and root mean square of each pair's part of the force, as the values say them."""
    pair = name.removeprefix("mesh_force_spectrum_")
    for other in np.unique(data["from_pair"]):
        one = data["from_pair"] == other
        close(data["force"][one].max(), number_of(found, f"{pair}.largest_line_from_{other}"))
        steps = data["frequency"][one] / data["n"][one]
        close(steps, np.full(steps.size, steps[0]))
        close(data["power"][one], 0.5 * data["force"][one] ** 2)
        rms = number_of(found, f"{pair}.rms_from_{other}")
        assert math.sqrt(data["power"][one].sum()) == pytest.approx(rms, rel=1e-6)


def check_safety(data, _name, _found):
    """S times the stress is what is borne: one number by each method for both gears of one material."""
    for part in ("H", "F"):
        for gear in ("driver", "driven"):
            known = data[f"S_{part}_{gear}"] * data[f"sigma_{part}_{gear}"]
            assert (known[np.isfinite(known)] > 0.0).all()


def check_levels(data, _name, found):
    close(data["share"].sum(), 1.0)
    said = {value.name for value in found.values}  # above the static strength there is no damage to add
    for gear in ("driver", "driven"):
        for part in ("H", "F"):
            if f"I.{gear}.damage_{part}" not in said:
                assert not np.isfinite(data[f"damage_{part}_{gear}"]).all()
                continue
            total = number_of(found, f"I.{gear}.damage_{part}")
            close(data[f"damage_{part}_{gear}"].sum(), total, 1e-6)
    ratio = data["cycles_driver"] / data["cycles_driven"]
    close(ratio, np.full(ratio.size, ratio[0]))


def check_geometry(data, _name, _found):
    for smaller, larger in (("root_radius", "form_radius"), ("form_radius", "involute_tip_radius"),
                            ("involute_tip_radius", "tip_radius"), ("bore_radius", "root_radius")):  # fmt: skip
        external = data["bore_radius"] < data["tip_radius"]
        assert (data[smaller][external] <= data[larger][external] * (1.0 + 1e-9)).all()
    close(data["pitch_radius"] / data["module"] * 2.0, np.abs(data["teeth"]), 0.07)  # helical: over cos(beta)


def check_surface(data, _name, found):
    pair = "I"
    close(data["relative_radius"], np.abs(1.0 / (1.0 / data["radius_driver"] + 1.0 / data["radius_driven"])), 0.05)
    assert (np.abs(data["sliding_velocity"]) <= data["sum_velocity"]).all()
    for kind in ("", "_iso"):
        rise = data[f"contact_temperature{kind}"] - data[f"flash_temperature{kind}"]
        close(rise, np.full(rise.size, rise[0]), 1e-6)
    roughness = data["film_thickness"] / data["film_ratio"]
    close(roughness, np.full(roughness.size, roughness[0]), 1e-6)
    close(data["contact_temperature"].max(), number_of(found, f"{pair}.largest_contact_temperature"), 1e-6)
    close(np.abs(data["sliding_velocity"]).max(), number_of(found, f"{pair}.largest_sliding_velocity"), 1e-3)


def check_loss(data, name, found):
    """Power is the load times friction times sliding; over a base pitch it adds to the loss."""
    pair = name.removeprefix("tooth_loss_")
    assert (data["power_loss"] >= 0.0).all()
    loss, transmitted = number_of(found, f"{pair}.tooth_loss"), number_of(found, f"{pair}.transmitted_power")
    assert number_of(found, f"{pair}.tooth_efficiency") == pytest.approx(1.0 - loss / transmitted, rel=1e-9)
    mean = number_of(found, f"{pair}.mean_friction")
    assert data["friction_coefficient"].min() <= mean * (1 + 1e-9)
    assert mean <= data["friction_coefficient"].max() * (1 + 1e-9)
    assert loss / transmitted == pytest.approx(mean * number_of(found, f"{pair}.loss_factor"), rel=1e-6)


def check_stiffness(data, _name, _found):
    assert (data["c_self"] > 0.0).all()
    assert (data["root_tension"] > 0.0).all()
    assert (data["root_compression"] < 0.0).all()
    assert (data["c_next"] < data["c_self"]).all()


def check_members(data, _name, _found):
    """Torques of a set balance, and so do powers but for the losses."""
    close(data["power"], data["torque"] * data["speed"], 1e-6)
    assert abs(data["torque"].sum()) <= 1e-6 * np.abs(data["torque"]).max()


def check_planets(data, _name, _found):
    assert data["shares"].mean() == pytest.approx(1.0, rel=1e-6) or data["shares"].sum() == pytest.approx(1.0, rel=1e-6)
    assert ((data["apart_sun"] >= 0.0) & (data["apart_sun"] <= 1.0)).all()


def check_over_face(data, name, found):
    assert (data["least_line_load"] <= data["mean_line_load"]).all()
    assert (data["mean_line_load"] <= data["largest_line_load"] * (1 + 1e-12)).all()
    close(
        data["factor"] / data["mean_line_load"], np.full(data["z"].size, data["factor"][0] / data["mean_line_load"][0])
    )
    assert (np.diff(data["z"]) > 0.0).all()
    assert data["factor"].max() <= number_of(found, f"{name.removeprefix('load_over_face_')}.K_Hbeta") * (1.0 + 1e-6)


def check_over_roll(data, _name, _found):
    shares = [data[key] for key in data if key.startswith("share_") and not key.endswith("_error")]
    close(np.nansum(shares, axis=0), np.ones(data["roll"].size), 1e-6)
    assert (data["equilibrium"] <= 1e-6).all()
    assert (data["te"] >= data["te_unloaded"]).all()


#: Checks by how a table's name begins; the longest that fits counts.
OF_TABLES = {
    "load_sharing_loads": None, "load_sharing": check_load_sharing,
    "transmission_error_summary": None, "transmission_error_loads": None,
    "transmission_error_rotational": None, "transmission_error_series": None, "transmission_error_convergence": None,
    "transmission_error_harmonics": check_harmonics, "transmission_error": check_transmission_error,
    "bearing_forces": check_bearing_forces, "natural_modes": check_modes, "planet_modes": check_modes,
    "mesh_force_spectrum": check_spectrum, "rating_safety": check_safety, "rating_spectrum": check_levels,
    "geometry": check_geometry, "flank_surface": check_surface, "tooth_loss": check_loss, "stiffness": check_stiffness,
    "planet_members": check_members, "planet_shares": check_planets, "load_over_face": check_over_face,
    "load_distribution_roll": check_over_roll,
}  # fmt: skip


def check_first_screen(found):
    """The report begins with the wanted answer, has at most three open notes, and its first values are wanted ones."""
    page = run_page(found, described(found), list(found.remarks))
    assert [section.title for section in page.sections[:3]] == ["Answer", "Notes", "Results"]
    said, notes, values = (section.blocks for section in page.sections[:3])
    wanted = {step.task for step in found.plan.steps if step.wanted}
    assert found.answer.sentences == (said[0].sentences if found.answer.sentences else ())
    outcomes = [found.outcomes[task] for task in wanted]
    assert said or not any(outcome.values or outcome.figures for outcome in outcomes)
    assert sum(len(block.notes) for block in notes if hasattr(block, "notes")) <= OPEN + 1
    groups = [block for block in values if isinstance(block, Group)]
    if any(outcome.values for outcome in outcomes):
        first = groups[0].blocks[1].values[0]
        assert any(value.name == first.name for outcome in outcomes for value in outcome.values)


#: Results that no run of the net has, and the tests that compute them.
ELSEWHERE = {
    "crack-path": "cases/test_odd_teeth_cases.py",
    "dynamic-strain": "closed_form/test_dynamic_strain_closed_form.py",
    "fillet-design": "cases/test_fillet_design_cases.py",
    "gauge": "closed_form/test_dynamic_strain_closed_form.py",
    "gearbox": "cases/test_gearbox_overview_cases.py",
    "idler-root-stress": "closed_form/test_asymmetric_idlers_closed_form.py",
    "lead-correction": "cases/test_lead_correction_cases.py",
    "measured-transmission-error": "unit/test_measured_error_unit.py",
    "rack-geometry": "unit/test_racks_unit.py",
    "rack-stiffness": "unit/test_racks_unit.py",
    "rack-transmission-error": "unit/test_racks_unit.py",
    "sizing": "cases/test_sizing_cases.py",
    "vibration-revolution": "cases/test_odd_teeth_cases.py",
}


def test_every_result_has_a_run_in_the_net_or_a_test_elsewhere():
    wanted = {result for name in small_net.RUNS for result in small_net.wanted(name)}
    how = "give each a run in RUNS of small_net.py and accept it, or name the test that computes it in ELSEWHERE"
    assert {*RESULTS} - wanted == {*ELSEWHERE}, how
    tests = Path(__file__).resolve().parents[1]
    assert [name for name, test in ELSEWHERE.items() if f'"{name}"' not in (tests / test).read_text("utf-8")] == []


#: Takes 20 s; the same search with other options is tried at every change.
LONG = {"flank_design"}


@pytest.mark.dear("flank_design_options", "robustness")
@pytest.mark.parametrize(
    "name", [pytest.param(name, marks=pytest.mark.long) if name in LONG else name for name in small_net.RUNS]
)
def test_a_cheap_run_gives_what_is_kept_and_its_columns_agree(name, monkeypatch):
    done = []
    monkeypatch.setattr(Silence, "advance", lambda _self, fraction: done.append(fraction))
    found = small_net.computed(name)
    assert all(0.0 <= fraction <= 1.0 + 1e-9 for fraction in done)
    for table in found.tables:
        check_any(table)
        kind = max((kind for kind in OF_TABLES if f"{table.name}_".startswith(f"{kind}_")), key=len, default=None)
        if kind and OF_TABLES[kind]:
            OF_TABLES[kind](columns(table), table.name, found)
    assert small_net.differences(small_net.kept()[name], small_net.of_run(found)) == []
    check_first_screen(found)


#: Cases that no cheap run takes, with what makes them as cheap as they get.
FURTHER = {
    "calculix_pair": {"accuracy.tolerance": 0.1},
    "fillet_design": {"accuracy.tolerance": 0.1, "fillet_design.searches": 1},
    "four_square_fe": {"accuracy.tolerance": 0.1},
    "helical_load": small_net.ROUGH,
    "helical_pair": small_net.ROUGH,
    "helical_planet_and_ring": small_net.ROUGH,
    "inclined_web": {"accuracy.tolerance": 0.3},
    "khbeta_helical": small_net.ROUGH,
    "khbeta_spur": small_net.ROUGH,
    "lin_dynamic_factor": {"dynamics.speeds": ["6000 rpm", "9000 rpm"]},
    "litvin_lead": {},
    "litvin_shaft_angle": {},
    "litvin_under_load": small_net.ROUGH,
    "measured_transmission_error": {"accuracy.tolerance": 0.1},
    "nasa_four_square": {"accuracy.tolerance": 0.1},
    "nasa_relief_design": {"accuracy.tolerance": 0.1, "design.grind": ["linear"]},
    "relief_torque_range": {"accuracy.tolerance": 0.1},
    "root_stress_validation": {"accuracy.tolerance": 0.1},
    "spur_over_the_face": {"accuracy.tolerance": 0.3},
    "strain_gauges": {"accuracy.tolerance": 0.1},
    "torque_ripple": {"accuracy.tolerance": 0.1},
    "typed_drawing": {"accuracy.tolerance": 0.1},
    "web_holes": {"accuracy.tolerance": 0.3},
}  # fmt: skip


#: With what the first sentence of some begins.
BEGINS = {
    "helical_load": "Pair I: K_Hβ", "helical_pair": "Pair I: K_Hβ", "khbeta_helical": "Pair I: K_Hβ",
    "khbeta_spur": "Pair I: K_Hβ", "relief_torque_range": "Pair I: grind ",
    "strain_gauges": "Gauge tension: measured strain is ",
    "spur_over_the_face": "Gear a, force on one band of the flank: self-compliance",
}  # fmt: skip


@pytest.mark.long
@pytest.mark.parametrize("name", FURTHER)
def test_the_first_screen_of_further_cases_has_the_answer(name):
    found = fegear.run(small_net.ROOT / "cases" / f"{name}.toml", FURTHER[name], progress=False)
    check_first_screen(found)
    assert found.answer.sentences[0].startswith(BEGINS.get(name, ""))


@pytest.mark.long
@pytest.mark.parametrize("kind", KINDS)
def test_a_fresh_template_has_no_open_note(kind, tmp_path):
    """All that stands open on a report are failures, tolerances, neglected effects and assumptions."""
    path = tmp_path / f"{kind}.toml"
    path.write_text(draft(Answers(kind, {}), kind), encoding="utf-8")
    found = fegear.run(path, progress=False)
    check_first_screen(found)
    assert found.notes(information=False) == ()
