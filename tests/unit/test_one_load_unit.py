"""One pair at one load has one tooth stiffness: all results of a run hand the same load to ISO 6336-1."""

import copy
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.case.built.pair_surface import pair_surface
from fegear.case.built.rated_pair import pair_to_rate
from fegear.case.reading import build_scene
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.load_factors import iso_face_load_factor, straight_gap
from fegear.formulas.friction import MEAN_LAWS, law_load
from fegear.formulas.iso6336.part1_stiffness import pair_stiffness
from fegear.formulas.iso6336.safety import rate_pair
from fegear.results.gear.crosscheck import _pair_check
from fegear.results.gear.crosscheck_iso import iso_inputs

GEAR = {
    "module": "2 mm", "face_width": "20 mm", "tolerance_class": 6, "strength": {"material": "case-hardened-steel"},
    "roughness": {"flank": "0.5 um", "root": "2 um"},
}  # fmt: skip
CASE = {
    "results": ["geometry"],
    "gear": {"a": {"teeth": 30, **GEAR}, "b": {"teeth": 62, **GEAR}},
    "pair": {
        "I": {
            "driver": "a", "driven": "b", "torque": "10 N m", "speed": "1500 rpm",
            "lubricant": {"viscosity_40": "220 mm^2/s", "temperature": "70 degC"},
        }
    },
}  # fmt: skip


def scene(helix: str | None = None, **pair):
    found = copy.deepcopy(CASE)
    found["pair"]["I"] |= pair
    if "load" in pair or "loads" in pair:
        del found["pair"]["I"]["torque"]
    if helix:
        for gear, hand in zip(found["gear"].values(), ("left", "right"), strict=True):
            gear["normal_module"] = gear.pop("module")
            gear |= {"helix_angle": helix, "hand": hand}
    return build_scene(found, "case", Path())


CASES = [
    {},
    {"operation": {"application_factor": 1.25, "mesh_load_factor": 1.1}},
    {"load": "900 N"},
    {"loads": ["200 N", "600 N"]},
]


@pytest.mark.parametrize("changes", CASES, ids=["plain", "K_A", "load", "loads"])
@pytest.mark.parametrize("helix", [None, "25 deg"], ids=["spur", "helical"])
def test_rating_crosscheck_and_flank_surface_have_one_tooth_stiffness(helix, changes):
    made = scene(helix, **changes)
    pair = made.pairs["I"]
    rated = rate_pair(pair_to_rate(made, "I").conditions)["c'"].value
    if helix is None:
        checked = _pair_check(made, "I").applied_load
    else:
        check = iso_inputs(made, "I", None).helical
        checked = check.applied_load
        assert check.specific_load == pytest.approx(pair_to_rate(made, "I").conditions.duty.tangential / 20e-3)
    assert checked < 100e3  # below, the stiffness falls with the load
    assert pair_stiffness(pair, specific_load=checked).single == pytest.approx(rated, rel=1e-12)
    assert pair_surface(made, "I").rated.single_stiffness == pytest.approx(rated, rel=1e-12)


def test_the_load_along_the_line_of_action_would_give_another_one():
    pair = scene().pairs["I"]
    force = 10.0 / pair.driver.base_radius
    right, wrong = (
        pair_stiffness(pair, specific_load=load).single for load in (pair.specific_load(force), force / pair.face_width)
    )
    assert wrong / right == pytest.approx(np.cos(np.deg2rad(20.0)) ** -0.25)
    assert right == pytest.approx(8.8436e9, rel=1e-4)


def test_one_torque_is_tangential_and_along_the_line_of_action():
    for helix in (None, "25 deg"):
        pair = scene(helix).pairs["I"]
        along = 12.0 / pair.driver.base_radius
        assert pair.tangential_load(along) == pytest.approx(12.0 / pair.driver.pitch_radius, rel=1e-14)
        assert pair.tangential_load(along) == pytest.approx(12.0 * pair.ratio / pair.driven.pitch_radius, rel=1e-14)
        assert pair.tangential_load(1.0) == pytest.approx(np.cos(pair.driver.transverse_pressure_angle), rel=1e-14)
        assert iso_face_load_factor(pair, FlankGaps(), along) == 1.0


def test_laws_of_friction_take_their_own_load():
    pair = scene("25 deg").pairs["I"]
    at = {law: law_load(law, pair, [0.0, 50e3, 400e3]) for law in MEAN_LAWS}
    cos = pair.tangential_load(1.0)
    assert at["schlenk"] == pytest.approx([0.0, 50e3, 400e3])
    assert at["iso-6336-20"] == pytest.approx([0.0, 50e3 * cos, 400e3 * cos])
    crowded = at["iso-6336-22"][2] / 400e3
    assert crowded > 1.0
    assert at["iso-6336-21"] == pytest.approx([0.0, 150e3 * crowded, 400e3 * cos * crowded])


def test_the_straight_part_of_a_gap_is_read_over_the_whole_face_between_its_ends():
    """A bulge that is even about the middle leaves it, and so does a constant."""
    seen = []

    def at(_pair, lines):
        seen.append(lines)
        return 4e-6 + 3e-4 * lines.z + 2e-2 * lines.z**2

    pair = SimpleNamespace(face_width=0.03)
    assert straight_gap(pair, SimpleNamespace(at=at)) == pytest.approx(3e-4 * 0.03)
    (lines,) = seen
    assert (lines.low, lines.high) == (-0.015, 0.015)
    assert (lines.z.min(), lines.z.max()) == (-0.015, 0.015)
    assert not lines.at_edge.any()
