"""Back flanks of asymmetric teeth in motion: where they touch, how stiff they are, equal flanks as the limit."""

import copy
import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.reading import build_scene
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.dynamics.motion.packed_model import pack
from fegear.dynamics.motion.steady_state import steady_state
from fegear.dynamics.train.back_flanks import BackFlanks, back_flanks, leverage
from fegear.dynamics.train.periodic import Periodic
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.results.catalogue import STAGES
from fegear.verify.rigs import CASES, excitation, four_inertia

GEAR = {
    "teeth": 22, "module": "3 mm", "pressure_angle": "30 deg", "coast_pressure_angle": "20 deg",
    "rack": {"tip_radius": 0.15, "coast_tip_radius": 0.3}, "face_width": "10 mm", "bore_radius": "12 mm",
    "thickness_allowance": "30 um", "profile_shift": 0.1,
}  # fmt: skip
FLAT = Periodic.constant(2e8)


def case(results=("gear-train",), exchanged=False, mesh=(), **pair):
    """A driver on a driven gear, both flanks loaded; `exchanged`: the other way round, the same teeth mirrored."""
    gear = copy.deepcopy(GEAR)
    if exchanged:
        gear |= {"pressure_angle": "20 deg", "coast_pressure_angle": "30 deg"}
        gear["rack"] = {"tip_radius": 0.3, "coast_tip_radius": 0.15}
    front = {"driver": "p", "driven": "w", "torque": "20 N*m", "flank": "coast" if exchanged else "drive"}
    back = {"driver": "w", "driven": "p", "torque": "30 N*m", **pair}
    return {
        "results": list(results), "gear": {"p": gear, "w": {**gear, "teeth": 35, "profile_shift": -0.1}},
        "pair": {"I": front, "back": back},
        "train": {
            "torque": {"one": "20 N*m"}, "balance": "two", "body": {"one": {"gears": ["p"]}, "two": {"gears": ["w"]}},
            "mesh": {"I": {"driver": "one", "driven": "two", "damping_ratio": 0.05, "back_pair": "back", **dict(mesh)}},
        },
        "effects": {"contact_loss": True, "parametric": True}, "accuracy": {"tolerance": 0.3},
        "dynamics": {"speeds": ["1000 rpm"]},
    }  # fmt: skip


def built(document):
    return build_scene(copy.deepcopy(document), "case", Path())


def test_the_teeth_and_the_backlash_fill_the_pitch():
    """Seen from either flank: thickness of both and the backlash are one pitch."""
    pair = built(case()).pairs["I"]
    assert pair.asymmetric
    assert pair.circumferential_backlash > 40e-6
    other = pair.from_the_back.reversed()
    ahead = back_flanks(pair, FLAT).shift + back_flanks(other, FLAT).shift
    assert ahead == pytest.approx(-1.0, abs=1e-12)
    assert -0.55 < back_flanks(pair, FLAT).shift < -0.45
    assert leverage(pair) * leverage(pair.from_the_back) == pytest.approx(1.0, rel=1e-14)


def test_stiffness_counts_along_the_line_of_action_of_the_working_flanks():
    """The same torque for the same turn."""
    pair = built(case()).pairs["I"]
    found = float(back_flanks(pair, FLAT).stiffness(0.3))
    radii = pair.driver.from_the_back.base_radius, pair.driver.base_radius
    assert found * radii[1] ** 2 == pytest.approx(2e8 * radii[0] ** 2, rel=1e-12)


def test_back_flanks_like_the_others_change_nothing():
    rpm, backlash, amplitude, force, shaft = CASES["loss of contact"]
    train = four_inertia(force, 3e-6, shaft).train(3.6e8)
    one = excitation(amplitude)
    same = replace(one, back=BackFlanks(one.stiffness[0]))
    packed = [pack(MotionModel(train, (each,), rpm * math.pi / 30)) for each in (one, same)]
    for key in ("poly", "cuts", "phase", "rate", "side"):
        assert (getattr(packed[0], key) == getattr(packed[1], key)).all()
    assert backlash > 0.0


def test_a_shift_moves_the_stiffness_along_the_path():
    rpm, backlash, amplitude, force, shaft = next(one for name, one in CASES.items() if "back-side" in name)
    train = four_inertia(force, backlash, shaft).train(3.6e8)
    k = Periodic.through_points([0, 0.5, 0.5, 1], [5e8, 5e8, 2e8, 2e8])
    moved = Periodic.through_points([0, 0.25, 0.25, 0.75, 0.75, 1], [5e8, 5e8, 2e8, 2e8, 5e8, 5e8])
    forces = [
        steady_state(
            MotionModel(train, (replace(excitation(amplitude), back=back),), rpm * math.pi / 30), tolerance=1e-10
        )
        for back in (BackFlanks(k, 0.25), BackFlanks(moved), BackFlanks(k))
    ]
    assert forces[0].behind[0] > 0.0
    assert forces[0].largest[0] == pytest.approx(forces[1].largest[0], rel=1e-8)
    assert forces[0].largest[0] != pytest.approx(forces[2].largest[0], rel=1e-3)


@pytest.mark.dear
def test_a_mirrored_train_is_one_with_exchanged_flanks():
    """The drive flanks carry, and the same teeth whose coast flanks do."""
    found = []
    for exchanged in (False, True):
        scene = built(case(exchanged=exchanged))
        kept = {}
        run_plan(scene, make_plan(scene, STAGES), found=lambda task, outcome, kept=kept: kept.update({task: outcome}))
        found.append(kept[Task("gear-train")].data.meshes[0].back)
    one, other = found
    s = np.linspace(0.0, 1.0, 50)
    assert other.stiffness(s) == pytest.approx(one.stiffness(s), rel=1e-12)
    assert other.shift == pytest.approx(one.shift, abs=1e-12)
    assert float(one.even.stiffness(0.0)) == pytest.approx(1.0 / np.mean(1.0 / one.stiffness(s[:-1])), rel=2e-2)


@pytest.mark.parametrize(
    ("document", "said"),
    [
        (case(mesh={"back_pair": "I"}), "must be a pair of the gears of pair I with driver and driven exchanged; set "),
        (case(mesh={"back_pair": "bakc"}), 'did you mean "back"?'),
        (case(mesh={"back_pair": 3}), "train.mesh.I.back_pair = 3"),
    ],
)  # fmt: skip
def test_what_is_no_pair_of_back_flanks_is_refused(document, said):
    with pytest.raises(InputError) as refused:
        make_plan(built(document | {"results": ["gear-train"]}), STAGES)
    assert said in str(refused.value)


def test_back_flanks_are_wanted_where_they_may_touch_only():
    with pytest.raises(InputError, match=r"train\.mesh\.I\.backlash = .* requires back_pair for asymmetric teeth"):
        make_plan(built(case(("dynamic-factor",), mesh={"back_pair": None})), STAGES)
    make_plan(built(case(("dynamic-factor",))), STAGES)
    make_plan(built(case(("dynamic-factor",), mesh={"back_pair": None, "backlash": "unlimited"})), STAGES)


def test_equal_flanks_need_none():
    equal = case()
    for gear in equal["gear"].values():
        gear |= {"coast_pressure_angle": "30 deg", "rack": {"tip_radius": 0.1}}
    del equal["pair"]["I"]["flank"]
    with pytest.raises(InputError, match=r"back_pair = .*requires asymmetric teeth"):
        make_plan(built(equal), STAGES)
