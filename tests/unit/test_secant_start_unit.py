"""Where the secant of the mesh has no force: te_0 of tables, beside contact of tips and with relief."""

import math

import numpy as np
import pytest

import fegear

FORCE = 60.0 / (0.025 * math.cos(math.radians(20.0)))


def tables_of(*, corner_contact, amount="0 um"):
    gear = {"module": "2 mm", "face_width": "20 mm", "relief": {"tip": {"amount": amount, "normalised_length": 0.5}}}
    case = {
        "title": "Where the secant has no force",
        "results": ["mesh-stiffness-revolution", "transmission-error"],
        "gear": {"a": {"teeth": 25, **gear}, "b": {"teeth": 30, **gear}},
        "pair": {"I": {"driver": "a", "driven": "b", "torque": "60 N*m", "compliance": {"source": "weber-banaschek"}}},
        "effects": {"hertz": "load-dependent", "corner_contact": corner_contact, "relief": True},
        "transmission_error": {"even_positions": 200},
    }
    found = fegear.run(case, progress=False)
    return found.tables["mesh_stiffness_revolution_I"], found.tables["mesh_table_I"]


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
    table, _ = tables_of(corner_contact=False, amount="6 um")
    assert 1e-6 < table.column("te_0").si.max() <= 6e-6


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
