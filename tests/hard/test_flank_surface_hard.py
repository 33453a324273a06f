"""Flanks at the ends of what can be: contact on a base circle, loads of a gram, honey and petrol, standstill."""

import math

import numpy as np
import pytest

from fegear.base.errors import FegearError, InputError
from fegear.formulas.lubricant import Oil
from fegear.workbench.run import run

pytestmark = pytest.mark.last_bit

KINDS = ("mineral", "polyalphaolefin", "polyglycol", "water-soluble-polyglycol", "traction-fluid", "phosphate-ester")


def asked(rng):
    one = {"module": "3 mm", "face_width": "20 mm", "roughness": {"flank": rng.choice(["0.02 um", "0.5 um", "8 um"])}}
    oil = {
        "viscosity_40": rng.choice(["7 mm^2/s", "220 mm^2/s", "3200 mm^2/s"]),
        "temperature": rng.choice(["-20 degC", "60 degC", "200 degC"]), "kind": rng.choice(KINDS),
        "supply": rng.choice(["dip", "spray", "submerged"]), "scuffing_load_stage": int(rng.integers(1, 15)),
        "micropitting_load_stage": int(rng.integers(5, 11)),
    }  # fmt: skip
    friction = (
        {"coefficient": 0.0},
        {"law": "schlenk", "local": True},
        {"law": "iso-6336-21"},
        {"law": "benedict-kelley"},
    )
    pair = {
        "driver": "a", "driven": "b", "load": rng.choice(["0.01 N", "3000 N", "40000 N"]),
        "speed": rng.choice(["0.01 rpm", "1500 rpm", "30000 rpm"]), "compliance": {"source": "weber-banaschek"},
        "lubricant": oil, "friction": friction[rng.integers(len(friction))],
    }  # fmt: skip
    teeth = [int(z) for z in rng.choice([14, 17, 24, 60, 300], 2)]
    gears = {
        name: {"teeth": z, "profile_shift": 0.2 if z < 20 else 0.0} | one for name, z in zip("ab", teeth, strict=True)
    }
    effects = {"hertz": "load-dependent", "corner_contact": bool(rng.random() < 0.3)}
    return {
        "results": ["flank-surface", "gear-mesh-power-loss"],
        "gear": gears,
        "pair": {"I": pair},
        "effects": effects,
    }


@pytest.mark.parametrize("seed", [*range(8), *(pytest.param(k, marks=pytest.mark.long) for k in range(8, 150))])
def test_flanks_of_every_load_speed_and_oil_have_finite_temperatures_and_films(seed):
    case = asked(np.random.default_rng(seed))
    try:
        found = run(
            {**case, "effects": {key: value for key, value in case["effects"].items() if value}}, progress=False
        )
    except FegearError as error:
        assert error.rule  # what cannot be is refused in words  # noqa: PT017
        return
    values = {value.name.removeprefix("I."): value.value for value in found.values}
    assert all(math.isfinite(value) or name.startswith(("S_", "least_specific")) for name, value in values.items())
    assert 0.0 <= values["tooth_loss"] < values["transmitted_power"]
    assert values["largest_contact_temperature"] >= values["bulk_temperature"] - 1e-9
    assert values["least_film_ratio"] > 0.0
    (table,) = (table for table in found.tables if table.name == "flank_surface_I")
    for column in table.columns:
        if not column.name.startswith("specific_sliding"):
            assert np.isfinite(column.si).all(), column.name


def test_contact_that_reaches_a_base_circle_slides_without_bound_and_says_so():
    """A path from the driver's base circle on: rolling speed zero there, no film, and the rest finite."""
    gear = {"module": "3 mm", "face_width": "20 mm", "roughness": {"flank": "0.5 um"},
            "rack": {"addendum": 1.0, "dedendum": 1.25, "tip_radius": 0.39}}  # fmt: skip
    case = {
        "results": ["flank-surface"],
        "gear": {"a": {"teeth": 17} | gear, "b": {"teeth": 300} | gear},
        "pair": {"I": {"driver": "a", "driven": "b", "torque": "50 N*m", "speed": "1000 rpm",
                       "compliance": {"source": "weber-banaschek"},
                       "lubricant": {"viscosity_40": "220 mm^2/s", "temperature": "60 degC"}}},
        "effects": {"hertz": "load-dependent"},
    }  # fmt: skip
    found = run(case, progress=False)
    assert any("close to the base circle" in remark for remark in found.remarks)
    (table,) = (table for table in found.tables if table.name == "flank_surface_I")
    path = {column.name: np.asarray(column.si) for column in table.columns}
    assert path["radius_driver"][0] < 0.02 * found.scene.gears["a"].base_radius
    assert path["specific_sliding_driver"][0] < -20.0
    assert path["film_thickness"][0] < 0.3 * path["film_thickness"][len(path["x"]) // 2]
    assert np.isfinite(path["contact_temperature"]).all()


def test_flanks_that_stand_still_are_refused():
    case = asked(np.random.default_rng(0))
    del case["pair"]["I"]["speed"]
    with pytest.raises(InputError, match="\\(sliding velocity\\)"):
        run({**case, "effects": {"hertz": "load-dependent"}}, progress=False)


def test_oils_beyond_any_machine_keep_positive_viscosity_and_density():
    for kind in KINDS:
        for cold, hot in ((7e-6, 2e-6), (220e-6, 19e-6), (3200e-6, 100e-6), (50e-6, 49e-6)):
            oil, over = Oil(cold, hot, 895.0, kind), np.array([-60.0, 0.0, 100.0, 300.0, 2000.0])
            for known in (oil.dynamic(over), oil.density(over), oil.pressure_viscosity(over)):
                assert (known > 0.0).all()
                assert np.isfinite(known).all()
