"""Pairs with a width and a transverse contact ratio below 1: computed where some line, or some tip, is in contact."""

import pytest

import fegear
from fegear.base.errors import InputError
from fegear.case.reading import build_scene


def case(addendum=0.5, beta=0.0, width="slices", corners=False, driver="a", **more):
    gears = {}
    for name, teeth, hand in (("a", 25, "left"), ("b", 36, "right")):
        gears[name] = {"teeth": teeth, "rack": {"addendum": addendum}, "face_width": "12 mm"}
        gears[name] |= (
            {"normal_module": "2 mm", "helix_angle": f"{beta} deg", "hand": hand} if beta else {"module": "2 mm"}
        )
    pair = {"driver": driver, "driven": "ba"[driver == "b"], "load": "1500 N"} | (
        {} if width is None else {"width": width}
    )
    return {
        "results": ["transmission-error"], "gear": gears, "pair": {"I": pair},
        "effects": {"corner_contact": corners, "hertz": "load-dependent"}, "accuracy": {"tolerance": 5e-2},
    } | more  # fmt: skip


def run(*given, **named):
    return fegear.run(case(*given, **named), progress=False)


def ratios(**named):
    pair = build_scene(case(**named), "case", ".").pairs["I"]
    return pair.contact_ratio, pair.total_contact_ratio


def test_without_any_line_at_some_roll_positions_corner_contact_is_asked_for():
    assert max(ratios()) < 1.0
    with pytest.raises(InputError) as error:
        fegear.run(case(), progress=False)
    assert "total contact ratio" in str(error.value)
    assert "set effects.corner_contact = true" in str(error.value)


@pytest.mark.dear
def test_spur_slices_whose_tips_bridge_the_path_are_as_stiff_as_the_plane_pair():
    wide, plane = run(corners=True), run(corners=True, width=None)
    for name in ("I.te_mean", "I.te_peak_to_peak", "I.mesh_stiffness_mean"):
        one, other = wide.values[name], plane.values[name]
        assert abs(one.value - other.value) < one.error + other.error
        assert one.value == pytest.approx(other.value, rel=0.08)
    assert "I.mesh_compliance_mean" not in (*wide.values.keys(), *plane.values.keys())


@pytest.mark.dear
def test_helical_pairs_are_the_same_just_below_and_above_a_transverse_ratio_of_one():
    """Short teeth that get longer: nothing happens where the transverse contact ratio passes 1."""
    low, high = {"addendum": 0.6265, "beta": 20.0}, {"addendum": 0.6285, "beta": 20.0}
    assert ratios(**low)[0] < 1.0 < ratios(**high)[0]
    assert ratios(**low)[1] > 1.3
    one, two = (run(**named).values for named in (low, high))
    for name, within in (("I.te_mean", 5e-3), ("I.te_peak_to_peak", 0.03), ("I.mesh_compliance_mean", 5e-3)):
        assert one[name].value == pytest.approx(two[name].value, rel=within)


@pytest.mark.dear
def test_every_result_of_loaded_flanks_is_there_and_the_load_is_shared_whole():
    asked = ["load-sharing", "load-distribution", "mesh-stiffness-matrix", "root-stress-history"]
    found = run(addendum=0.5, beta=20.0, results=asked)
    assert 0.5 < found.values["I.largest_share"].value <= 1.0 + 1e-12
    assert found.values["I.K_Hbeta"].value < 1.3
    assert found.values["I.driver.largest_root_tension"].value > 0.0
