"""Where the secant of the mesh has no force: te_0 of tables, beside contact of tips and with relief."""

import math

import numpy as np
import pytest

import fegear
from fegear.contact.plane.base_pitch import secant_stiffness
from fegear.contact.plane.transmission_error import contact_changes

FORCE = 60.0 / (0.025 * math.cos(math.radians(20.0)))


def case_of(*, corner_contact, amount="0 um", torques=("60 N*m",)):
    gear = {"module": "2 mm", "face_width": "20 mm", "relief": {"tip": {"amount": amount, "normalised_length": 0.5}}}
    pair = {"driver": "a", "driven": "b", "torques": list(torques), "compliance": {"source": "weber-banaschek"}}
    return {
        "title": "Where the secant has no force",
        "results": ["mesh-stiffness-revolution", "transmission-error"],
        "gear": {"a": {"teeth": 25, **gear}, "b": {"teeth": 30, **gear}},
        "pair": {"I": pair},
        "effects": {"hertz": "load-dependent", "corner_contact": corner_contact, "relief": True},
        "transmission_error": {"even_positions": 200},
    }


def tables_of(**given):
    found = fegear.run(case_of(**given), progress=False)
    return [found.tables[f"{name}_I"] for name in ("mesh_stiffness_revolution", "mesh_table", "transmission_error")]


@pytest.mark.parametrize(("corner_contact", "amount"), [(False, "0 um"), (True, "0 um"), (False, "6 um")])
def test_the_secant_from_te_0_carries_the_load(corner_contact, amount):
    for table in tables_of(corner_contact=corner_contact, amount=amount):
        te, stiffness, te_0 = (table.column(name).si for name in ("te", "mesh_stiffness", "te_0"))
        np.testing.assert_allclose(stiffness * (te - te_0), FORCE, rtol=1e-4)
        assert table.column("te_0").unit == "um"
        if not corner_contact and amount == "0 um":  # nothing but deflection
            assert not te_0.any()
        else:  # gaps closed first: by tips off the line of action, by relief
            assert te_0.min() >= 0.0
            assert 0.2 * te.max() < te_0.max() < te.max()
            assert 0.05 < (te_0 > 0.0).mean() < 0.95


def test_te_0_of_a_relief_is_at_most_its_gap():
    for table in tables_of(corner_contact=False, amount="6 um"):
        assert 1e-6 < table.column("te_0").si.max() <= 6e-6


@pytest.mark.parametrize(("corner_contact", "amount"), [(True, "0 um"), (False, "12 um")])
def test_the_recipe_of_the_page_gives_the_force_between_the_rows(corner_contact, amount):
    """At angles that are in no table: columns interpolated as the page says, and the functions in Python."""
    found = fegear.run(case_of(corner_contact=corner_contact, amount=amount), progress=False)
    table = found.tables["transmission_error_I"]
    angle, stiffness, te_0 = (table.column(name).si for name in ("driver_angle", "mesh_stiffness", "te_0"))
    (loaded,) = (outcome.data for outcome in found.outcomes.values() if hasattr(outcome.data, "engagement"))
    at = angle[0] + np.random.default_rng(5).random(3000) * (angle[-1] - angle[0])
    e = loaded.engagement
    deflection = e.solve(e.grid(at * e.pair.driver.base_radius), [FORCE]).transmission_error[:, 0]
    by_table = np.interp(at, angle, stiffness) * (deflection - np.interp(at, angle, te_0))
    by_function = found.mesh_stiffness(at, kind="secant") * (deflection - found.te_0(at))
    for force in (by_table, by_function):
        off = np.abs(force / FORCE - 1.0)
        assert off.max() < 5e-3
        assert np.median(off) < 1e-4
    assert np.abs(np.interp(at, angle, stiffness) * deflection / FORCE - 1.0).max() > 0.3  # without te_0


def test_te_0_of_every_load_and_over_a_revolution():
    found = fegear.run(case_of(corner_contact=True, torques=("20 N*m", "60 N*m")), progress=False)
    table = found.tables["transmission_error_loads_I"]
    load, te, stiffness, te_0 = (
        table.column(name).si for name in ("total_load", "te", "mesh_stiffness", "te_0")
    )  # fmt: skip
    np.testing.assert_allclose(stiffness * (te - te_0), load, rtol=1e-6)
    assert (te_0[load < 0.5 * FORCE] > 0.0).any()
    te_at, k, start = found.transmission_error(0.3), found.mesh_stiffness(0.3, kind="secant"), found.te_0(0.3)
    assert k * (te_at - start) == pytest.approx(FORCE, rel=1e-6)


def test_mean_stiffness_without_contact_outside_the_path_is_that_of_a_run_without_it():
    both = [
        fegear.run(case_of(corner_contact=on) | {"results": ["transmission-error"]}, progress=False)
        for on in (True, False)
    ]
    values = [one.values for one in both]
    for kind in ("mesh", "local"):
        on_path = values[0][f"I.{kind}_stiffness_mean_on_path"].value
        assert on_path == pytest.approx(values[1][f"I.{kind}_stiffness_mean"].value, rel=1e-9)
        assert values[0][f"I.{kind}_stiffness_mean"].value > 1.02 * on_path
    assert "I.mesh_stiffness_mean_on_path" not in [one.name for one in values[1]]
    words = [" ".join(one.answer.sentences) for one in both]
    assert "contact outside the path of contact included; " in words[0]
    assert "without it." in words[0]
    assert "contact on the path of contact only." in words[1]


def test_relief_that_keeps_tips_apart_says_that_they_have_no_influence():
    case = case_of(corner_contact=True, amount="40 um", torques=["20 N*m"]) | {"results": ["transmission-error"]}
    found = fegear.run(case, progress=False)
    assert "I.mesh_stiffness_mean_on_path" not in [one.name for one in found.values]
    assert "included (no influence)." in " ".join(found.answer.sentences)


@pytest.mark.parametrize("given", [{"speed": ["2000 rpm", "3000 rpm"]}, {"torque": ["20 N*m", "80 N*m"]}])
def test_a_motion_over_a_revolution_at_several_speeds_is_refused_with_a_loop(given):
    pair = fegear.Pair(*(fegear.Gear(z, "2 mm", face_width="20 mm") for z in (25, 30)))
    (key,) = given
    said = rf"must be one {key}.*call it in a loop.*vibration_revolution\(pair, {key}=one"
    with pytest.raises(fegear.InputError, match=said):
        fegear.vibration_revolution(pair, **{"torque": "20 N*m", "speed": "2000 rpm"} | given)


@pytest.mark.parametrize("given", [{"torque": ["20 N*m", "80 N*m"]}, {"torque": "20 to 80 N m"}, {"load": [1e3, 2e3]}])
def test_a_revolution_under_several_loads_is_refused_with_a_loop(given):
    pair = fegear.Pair(*(fegear.Gear(z, "2 mm", face_width="20 mm") for z in (25, 30)))
    (key,) = given
    with pytest.raises(fegear.InputError, match=rf"must be one {key}.*call it in a loop.*{key}=one"):
        fegear.mesh_stiffness_revolution(pair, **given)


def test_a_case_with_several_torques_says_that_one_is_followed():
    case = {
        "results": ["mesh-stiffness-revolution"],
        "gear": {name: {"teeth": z, "module": "2 mm", "face_width": "20 mm"} for name, z in (("a", 25), ("b", 30))},
        "pair": {"I": {"driver": "a", "driven": "b", "compliance": {"source": "weber-banaschek"}}},
    }
    case["pair"]["I"]["torques"] = ["20 N*m", "80 N*m"]
    several = fegear.run(case, progress=False)
    assert any("is for 80 N m only, the nominal of 2 loads" in note for note in several.notes())
    case["pair"]["I"] |= {"torques": ["80 N*m"]}
    one = fegear.run(case, progress=False)
    assert not any("the nominal of" in note for note in one.notes())


def test_a_revolution_has_both_sides_of_every_change_of_contact():
    """Its stiffness drops where that of the teeth does, not over a line between two rows beside the change."""
    found = fegear.run(case_of(corner_contact=True), progress=False)
    (loaded,) = (outcome.data for outcome in found.outcomes.values() if hasattr(outcome.data, "engagement"))
    e, pitch = loaded.engagement, loaded.pair.base_pitch
    changes = contact_changes(e, FORCE)
    assert changes.size
    x = np.concatenate([changes + side * 1e-5 * pitch for side in (-1.0, 1.0)])
    truth = secant_stiffness(e.solve(e.grid(np.sort(x)), [FORCE]))[:, 0]
    angle = np.sort(x) / loaded.pair.driver.base_radius
    np.testing.assert_allclose(
        found.mesh_stiffness(angle, kind="secant"), truth, rtol=0.05
    )  # 0.16 where a row cuts the jump
    table = found.tables["mesh_stiffness_revolution_I"]
    rows, stiffness = table.column("x").si, table.column("mesh_stiffness").si
    first, last = (float(stiffness[np.abs(rows - one) < 3e-7 * pitch].min()) for one in (changes[0], changes[-1]))
    assert min(first, last) < 0.9 * stiffness.max()  # one pair less
