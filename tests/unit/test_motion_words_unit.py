"""What is said of motions that do not repeat, grow, settle late or share no period with a ripple; motions made up."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.notes import NoteClass
from fegear.case.built.neglected_in_motion import FactorChange
from fegear.dynamics.motion.motion_model import MotionModel
from fegear.results.train import motion
from fegear.results.train.motion import _common_period, _unsteady, _without_backlash, averaging_remarks, undamped

RPM = math.pi / 30.0
SHAFTS = tuple(
    SimpleNamespace(name=name, damping=damping, stiffness=stiffness)
    for name, damping, stiffness in (("s", 0.0, 1e4), ("t", 2.0, 1e4), ("rigid", 0.0, math.inf))
)
MESHES = tuple(
    SimpleNamespace(name=name, damping=damping, backlash=backlash)
    for name, damping, backlash in (("I", 3.0, 0.0), ("II", 0.0, 1e-5))
)
#: Two meshes, the second of which carries nothing.
TRAIN = SimpleNamespace(
    names=("I", "II"), forces=np.array([200.0, 0.0]), speed_ratio=0.5, ripple=(), meshes=(),
    train=SimpleNamespace(shafts=SHAFTS, meshes=MESHES),
)  # fmt: skip


def state(kind, rpm, *, per_period=(300.0, 500.0), followed=1250, coexisting=(), periods=0, growth=0.0, residual=0.0):
    """A motion of the first body at twice the speed that the case names."""
    forces = np.array([[one, 0.0] for one in per_period])
    return SimpleNamespace(
        kind=kind, model=SimpleNamespace(speed=2.0 * rpm * RPM), followed=followed, coexisting=coexisting,
        periods=periods, measured=periods or len(per_period), tooth_force=forces.max(axis=0), residual=residual,
        multiplier=math.exp(growth), quantile=lambda share: np.quantile(forces, share, axis=0, method="inverted_cdf"),
    )  # fmt: skip


QUIET = state("periodic", 1000.0, periods=1)


def test_motions_that_repeat_need_no_words():
    assert _unsteady(TRAIN, (QUIET,)) == []
    assert averaging_remarks(TRAIN, ()) == []


def test_a_motion_that_does_not_repeat_is_named_with_its_speed_and_over_how_many_periods():
    (said,) = _unsteady(TRAIN, (QUIET, state("chaotic", 1500.0), state("quasi-periodic", 1750.0)))
    assert said.startswith(
        "The motion does not repeat at 2 of 3 speeds: 1500 rpm chaotic, 1750 rpm quasi-periodic. The factors are "
        "maxima over 2 periods"
    )


def test_a_motion_that_did_not_settle_says_what_was_seen_and_which_damping_it_wants():
    (said,) = _unsteady(TRAIN, (state("not settled", 2000.0), state("not settled", 2500.0, per_period=(100.0,) * 3)))
    assert said.startswith(
        "Motion not converged at 2 of 2 speeds: 2000 rpm after 1,250 periods, dynamic factor 1.5 to 2.5 of mesh I; "
        "2500 rpm after 1,250 periods, dynamic factor 0.5 to 0.5 of mesh I (minimum and maximum of "
        "the last 2 to 3 periods"
    )
    assert said.endswith("set train.shaft.s.damping_ratio, train.mesh.II.damping_ratio (0.01 to 0.1).")
    (alone,) = _unsteady(TRAIN, (state("not settled", 2000.0),))
    assert "of the last 2 periods; may change" in alone
    assert undamped(TRAIN) == ["train.shaft.s", "train.mesh.II"]
    damped = SimpleNamespace(train=SimpleNamespace(shafts=TRAIN.train.shafts[1:], meshes=TRAIN.train.meshes[:1]))
    assert undamped(damped) == []
    assert motion._settling(damped).startswith("Increase damping")


def test_a_stable_motion_beside_one_that_does_not_repeat_is_named_with_its_factors():
    beside = (
        state("periodic", 1.0, per_period=(260.0,), periods=1),
        state("periodic", 1.0, per_period=(320.0,), periods=3),
    )
    said = _unsteady(
        TRAIN, (state("chaotic", 1500.0, coexisting=beside), state("not settled", 9.0, coexisting=beside[:1]))
    )
    assert len(said) == 3
    assert said[2].endswith(
        "(other initial conditions): 1500 rpm of 1 period, dynamic factor 1.3 of mesh I; 1500 rpm of 3 periods, "
        "dynamic factor 1.6 of mesh I; 9 rpm of 1 period, dynamic factor 1.3 of mesh I."
    )


def test_growth_is_said_with_its_multiplier_in_either_method():
    growing = state("growing", 3000.0, growth=math.log(1.25))
    for told in (_unsteady(TRAIN, (QUIET, growing)), averaging_remarks(TRAIN, (growing,))):
        assert told[0].startswith("Parametric instability at 1 of ")
        assert "3000 rpm (multiplier 1.25 per period)" in told[0]


def test_the_averaging_iteration_says_where_it_settled_gave_up_and_found_what_nothing_holds():
    settled, unstable, left = averaging_remarks(TRAIN, (
        state("periodic", 1000.0, followed=300), state("unstable", 1100.0, followed=2400, growth=0.1),
        state("not settled", 1200.0, followed=1000, residual=0.0125),
    ))  # fmt: skip
    assert settled == "Averaging iteration converged at 2 of 3 speeds, after 300 to 2,400 periods."
    assert unstable.startswith("Averaging iteration did not converge at 1 of 3 speeds: 1200 rpm after 1,000 periods")
    assert "0.013 of the static deflection, dynamic factor 1.5 to 2.5 of mesh I in the last 2." in unstable
    assert "unstable motion at 1 of 3 speeds: 1100 rpm (multiplier 1.10517 per period)" in left


def test_teeth_without_backlash_cannot_lose_contact_and_rounded_shifts_are_said():
    meshes = (SimpleNamespace(pair=SimpleNamespace(normal_backlash=-2.5e-6)),
              SimpleNamespace(pair=SimpleNamespace(normal_backlash=0.0)))  # fmt: skip
    data = SimpleNamespace(train=TRAIN.train, meshes=meshes)
    (said,) = _without_backlash(data)
    assert said.startswith("Mesh I: no backlash (negative by 2.5 um, rounded profile shifts): contact on both flanks")
    (plain,) = _without_backlash(SimpleNamespace(train=TRAIN.train, meshes=meshes[::-1]))
    assert plain.startswith("Mesh I: no backlash: contact on both flanks")


def test_non_working_flanks_that_carry_load_are_said_where_they_do_most():
    meshes = (SimpleNamespace(pair=SimpleNamespace(normal_backlash=0.0)),) * 2
    data = SimpleNamespace(**{**vars(TRAIN), "meshes": meshes, "speed_of": "motor"})
    states = [state("periodic", rpm, periods=1) for rpm in (900.0, 1000.0, 1100.0)]
    for one, share in zip(states, (0.0, 0.15, 0.02), strict=True):
        one.behind = np.array([share, 0.0])
    changes = [FactorChange(m, 2.0 * rpm * RPM, 1.9, -0.2) for m, rpm in ((0, 1000.0), (0, 1100.0), (1, 1000.0))]
    (said,) = _without_backlash(data, tuple(states), changes)
    assert said.kind is NoteClass.ASSUMED
    assert "at 2 of 3 speeds the non-working flanks carry load, up to 15 % of the time at 1000 rpm" in said
    assert "(dynamic factor 1.9, with unlimited backlash 1.7)" in said
    assert said.count("unlimited backlash") == 1
    assert "unlimited backlash" not in _without_backlash(data, tuple(states))[0]
    (silent,) = _without_backlash(data, tuple(states[:1]))
    assert silent.startswith("Mesh I: no backlash: contact on both flanks")


@pytest.mark.parametrize("shift", [0.0, 0.9e-9, 2e-4, -3e-3])
def test_a_ripple_whose_frequency_was_shifted_to_share_a_period_is_named_at_its_worst_speed(shift):
    def model(speed, stretch):
        found = object.__new__(MotionModel)
        for key, value in {"ripple": ("one",), "speed": speed}.items():
            object.__setattr__(found, key, value)
        found.__dict__["common"] = SimpleNamespace(stretch=stretch)
        return found

    states = tuple(SimpleNamespace(model=model(speed, stretch)) for speed, stretch in (
        (100.0, (1.0, 1.0 + 0.5 * shift)), (200.0, (1.0, 1.0 + shift)),
    ))  # fmt: skip
    ripple = tuple(
        SimpleNamespace(name=name, base_frequency=lambda speed, k=k: k * speed)
        for name, k in (("pump", 0.1), ("fan", 0.25))
    )
    data = SimpleNamespace(ripple=ripple)
    said = _common_period(data, states)
    if abs(shift) < 1e-9:
        assert said == []
        return
    (sentence,) = said
    per_cent = {2e-4: "0.020 %", -3e-3: "0.30 %"}[shift]
    assert sentence.startswith(
        f"Torque ripple fan (by up to {per_cent}: 50 Hz taken as {50.0 * (1.0 + shift):.6g} Hz): no common period"
    )
    assert _common_period(data, (SimpleNamespace(model=SimpleNamespace()),)) == []


def test_with_a_ripple_the_motion_is_found_without_and_with_it_each_half_of_the_work(monkeypatch):
    from dataclasses import dataclass

    @dataclass(frozen=True)
    class Data:
        ripple: tuple

    told = []

    def steady(spec, data, progress):
        assert spec == "spec"
        progress(0.5)
        return ("still" if not data.ripple else "moved",)

    monkeypatch.setattr(motion, "gear_train", lambda upstream: upstream)
    monkeypatch.setattr("fegear.dynamics.motion.moving_train.steady_motions", steady)
    monkeypatch.setattr(motion, "neglected_in_motion", lambda spec, data, states: (spec, data.ripple, states))
    monkeypatch.setattr(motion, "backlash_changes", lambda *_args: ["room"])
    asked = SimpleNamespace(motion="spec", neglected=True)
    found = motion._compute(asked, Data(("one",)), SimpleNamespace(progress=told.append))
    assert (found.states, found.still) == (("moved",), ("still",))
    assert found.neglected == ("spec", ("one",), ("moved",))
    assert found.with_room == ("room",)
    assert told == [0.25, 0.75]
    plain = motion._compute(
        SimpleNamespace(motion="spec", neglected=False), Data(()), SimpleNamespace(progress=told.append)
    )
    assert (plain.states, plain.still, told[2:]) == (("still",), (), [0.5])
