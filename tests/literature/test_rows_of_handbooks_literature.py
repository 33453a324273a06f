"""Rows of a handbook typed as they are printed: no refusal, and the numbers beside them.

KHK Stock Gears, Gear technical reference, "Calculation of gear dimensions": standard and profile shifted spur gears,
spur gear and rack, helical gears of the normal system.
"""

from pathlib import Path

import pytest

from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES


def computed(document):
    scene = build_scene(document, "row", Path())
    found = run_plan(scene, make_plan(scene, STAGES))
    return scene, {value.name: value.value for value in found.values}


def pair(first, second, distance):
    return {
        "results": ["geometry"], "gear": {"a": first, "b": second},
        "pair": {"I": {"driver": "a", "driven": "b", "centre_distance": distance}},
    }  # fmt: skip


def spur(teeth, **more):
    return {"teeth": teeth, "module": "3 mm", "pressure_angle": "20 deg", **more}


def test_standard_spur_gears():
    """m = 3, z = 12/24: a = 54, d_b = 33.829/67.658, d_a = 42/78, d_f = 28.5/64.5."""
    scene, values = computed(pair(spur(12, tip_diameter="42 mm"), spur(24, tip_diameter="78 mm"), "54 mm"))
    assert values["I.working_pressure_angle"] == pytest.approx(20.0)
    for name, base, root in (("a", 33.829, 28.5), ("b", 67.658, 64.5)):
        gear = scene.gears[name]
        assert 2e3 * gear.base_radius == pytest.approx(base, abs=5e-4)
        assert 2e3 * gear.root_radius == pytest.approx(root)


def test_profile_shifted_spur_gears():
    """x = 0.6/0.36: a = 56.4999, alpha_w = 26.0886 deg, d_a = 44.840/79.400, d_f = 32.100/66.660."""
    first = spur(12, profile_shift=0.6, tip_diameter="44.840 mm")
    scene, values = computed(pair(first, spur(24, profile_shift=0.36, tip_diameter="79.400 mm"), "56.4999 mm"))
    assert values["I.working_pressure_angle"] == pytest.approx(26.0886, abs=1e-4)
    assert values["I.normal_backlash"] == pytest.approx(0.0, abs=1e-4)
    assert [2e3 * scene.gears[name].root_radius for name in "ab"] == pytest.approx([32.100, 66.660])


def test_spur_gear_and_rack():
    """m = 3, z = 12, x = 0.6, height of the pitch line 32: a = 51.800 to the back of the rack; d_a = 45.6."""
    document = {
        "results": ["rack-geometry"], "gear": {"a": spur(12, profile_shift=0.6, tip_diameter="45.600 mm")},
        "rack": {"r": {"pinion": "a", "teeth": 20, "reference_height": "32.000 mm", "mounting_distance": "51.800 mm"}},
    }  # fmt: skip
    scene, values = computed(document)
    assert values["r.backlash"] == pytest.approx(0.0, abs=1e-9)
    assert values["r.mounting_distance"] == pytest.approx(51.8)
    assert values["r.distance"] == pytest.approx(19.8)
    assert 2e3 * scene.gears["a"].root_radius == pytest.approx(32.1)


def test_helical_gears_of_the_normal_system():
    """m_n = 3, beta = 30 deg, z = 12/60, x = 0.09809: a = 125, alpha_wt = 23.1126 deg, d_a = 48.153/213.842."""

    def helical(teeth, hand, **more):
        return {"teeth": teeth, "normal_module": "3 mm", "pressure_angle": "20 deg", "helix_angle": "30 deg",
                "hand": hand, "face_width": "30 mm", **more}  # fmt: skip

    first = helical(12, "right", profile_shift=0.09809, tip_diameter="48.153 mm")
    scene, values = computed(pair(first, helical(60, "left", tip_diameter="213.842 mm"), "125.000 mm"))
    assert values["I.working_pressure_angle"] == pytest.approx(23.1126, abs=2e-4)
    for name, base, root in (("a", 38.322, 34.657), ("b", 191.611, 200.346)):
        assert 2e3 * scene.gears[name].base_radius == pytest.approx(base, abs=1e-3)
        assert 2e3 * scene.gears[name].root_radius == pytest.approx(root, abs=1e-3)
