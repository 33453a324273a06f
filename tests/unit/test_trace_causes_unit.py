"""Causes of a measured transmission error: traces of pairs with another relief or torque name it, within its error."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.contact.load import load
from fegear.contact.measured_error import measured_error
from fegear.contact.pair_spec import FlankSpec, PairSpec
from fegear.contact.plane.possible_flanks import possible_flanks
from fegear.contact.trace_causes import Traced, likeliest_causes
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.relief_spec import ReliefSpec, TipReliefSpec
from fegear.results.pair.likeliest_flank import LikeliestFlank

TURN = 2.0 * math.pi
TEETH, MATE, MODULE, LOAD = 25, 38, 3e-3, 3000.0


def gear(teeth):
    return Gear(Tooth(teeth), MODULE, 15e-3, 20e-3)


def relieved(amount, length=2.5e-3):
    return FlankSpec(relief=ReliefSpec(tip=(TipReliefSpec(amount=amount, length=length),)))


def engagement(driver=25e-6, driven=25e-6, load_factor=1.0):
    flanks = [relieved(one) if one else FlankSpec() for one in (driver, driven)]
    pair = GearPair(gear(TEETH), gear(MATE))
    return load(PairSpec(pair, (LOAD,), compliance="weber-banaschek", driver=flanks[0], driven=flanks[1], relief=True,
                         neighbour_coupling=False)).engagement  # fmt: skip


X = np.linspace(0.0, 1.0, 257)


def curve(e, factor=1.0, torque=1.0):
    pair = e.pair
    x = pair.x_start + pair.base_pitch * X[:-1]
    te = e.solve(e.grid(x), [LOAD * torque * factor]).transmission_error[:, 0]
    return TURN * (pair.x_start / pair.base_pitch + X), np.append(te, te[0])


def traced(e, torque=1.0, noise=0.1e-6, seed=0, turns=2, a_tooth=60, shift=0.03, factor=1.0):
    """A trace of encoders with runout of both gears, an arbitrary zero, noise."""
    rng = np.random.default_rng(seed)
    angle = 0.7 + TURN * turns * np.arange(turns * TEETH * a_tooth) / (turns * TEETH * a_tooth)
    te = np.interp(TEETH * (angle - shift), *curve(e, factor, torque), period=TURN)
    te = te + 9e-6 * np.cos(angle - 1.0) + 4e-6 * np.cos(angle * TEETH / MATE) + 3e-6
    found = measured_error(angle, te + noise * rng.normal(size=angle.size), TEETH, MATE)
    return Traced(TEETH * found.angle, found.te, found.spread / math.sqrt(found.pitches), True, math.pi, 0.01, TURN,
                  0.01)  # fmt: skip


def causes(e, *traces, torques=(1.0,)):
    return likeliest_causes(
        traces, possible_flanks(e), lambda one, value: [curve(*one.made(value), torque) for torque in torques],
        lambda one: one.of.kind == "load" and abs(one.value - 1.0) <= 0.01,
    )  # fmt: skip


def said(e, found, torques=(100.0,)):
    return LikeliestFlank(found, e.pair, torques, float(np.ptp(curve(e)[1]))).said


def test_a_relief_that_is_less_than_stated_is_named_with_its_error():
    e = engagement()
    found = causes(e, traced(engagement(18e-6, 18e-6)))
    best = found.best
    assert (best.of.kind, best.of.of, found.alike) == ("tip relief", ("driver", "driven"), 1)
    assert best.value == pytest.approx(18e-6, abs=2.0 * best.error)
    assert 0.1e-6 < best.error < 0.5e-6  # a load that is known to 1 % alone is 0.18 um
    assert best.explained > 0.97
    words = said(e, found)
    assert words.startswith("the trace agrees with a tip relief of both gears of 18.")
    assert " µm in place of 25 µm: RMS of the residual " in words


def test_of_two_equal_torques_neither_relief_nor_torque_is_named_where_the_trace_is_as_stated():
    e = engagement()
    found = causes(e, traced(e))
    assert (found.causes, found.alike, said(e, found)) == ((), 0, "")
    assert causes(e, traced(e, torque=1.006)).alike == 0  # within the tolerance of the load


@pytest.mark.parametrize(("driver", "driven", "of"), [(14e-6, 25e-6, ("driver",)), (25e-6, 34e-6, ("driven",))])
def test_the_gear_whose_relief_is_another_is_named(driver, driven, of):
    best = causes(engagement(), traced(engagement(driver, driven))).best
    assert best.of.of == of
    assert best.value == pytest.approx(driver if of == ("driver",) else driven, abs=2.0 * best.error)


def test_a_torque_is_distinguished_from_a_relief_and_several_torques_have_one_cause():
    e = engagement()
    found = causes(e, traced(e, torque=0.8), traced(e, torque=1.2, seed=1), torques=(1.0, 1.5))
    best = found.best
    assert best.of.kind == "load"
    assert best.value == pytest.approx(0.8, abs=3.0 * best.error)
    words = said(e, found, (100.0, 150.0))
    assert words.startswith("the traces agree with torques 20")
    assert " % lower than stated: RMS" in words


def test_a_relief_where_none_is_stated_is_one_from_the_highest_point_of_single_contact():
    e = engagement(0.0, 0.0)
    (added,) = (one for one in possible_flanks(e) if one.of == ("driver",))
    relief = added.made(12e-6)[0].driver_relief.parts[0]
    pair = e.pair
    assert relief.start == pytest.approx(float(pair.roll_angle(pair.x_start + pair.base_pitch, "driver")))
    found = causes(e, traced(added.made(12e-6)[0]))
    assert found.best.of.added
    assert found.best.value == pytest.approx(12e-6, abs=2.0 * found.best.error)
    assert said(e, found).startswith("the trace agrees with a linear tip relief of the driver of 12.0 ± 0.2 µm in pla")


def test_causes_that_leave_as_little_are_said_to_be_as_likely():
    """A hand-made family: two numbers with the same curve cannot be distinguished, a third one explains a part."""
    angle = np.linspace(0.0, TURN, 129)
    one, other, half = (replace(possible_flanks(engagement())[0], kind="start", of=("driver",), low=-3.0, high=3.0,
                                stated=0.0, tooth=k) for k in (0, 1, 2))  # fmt: skip

    def curves(of, value):
        ripple = np.cos(3.0 * angle) + (0.6 * np.sin(5.0 * angle) if of.tooth < 2 else 0.0)
        return [(angle, 4e-6 * np.cos(angle) + 1e-6 * value * ripple)]

    rng = np.random.default_rng(3)
    values = curves(one, 1.2)[0][1][:-1] + 0.02e-6 * rng.normal(size=128)
    trace = Traced(angle[:-1], values, 0.02e-6, True, 0.0, 0.01, TURN)
    found = likeliest_causes([trace], [one, other, half], curves)
    assert found.alike == 2
    assert found.causes[0].value == pytest.approx(1.2, abs=3.0 * found.causes[0].error)
    assert found.causes[2].explained == pytest.approx(1.0 / 1.36, abs=0.02)


@pytest.mark.dear
def test_thirty_random_reliefs_are_found_within_three_standard_errors():
    e, rng = engagement(), np.random.default_rng(11)
    off = []
    for k in range(30):
        both = rng.integers(3)
        amount = rng.choice([rng.uniform(8e-6, 20e-6), rng.uniform(30e-6, 45e-6)])
        true = [amount if both in (0, 1) else 25e-6, amount if both in (0, 2) else 25e-6]
        trace = traced(engagement(*true), torque=rng.uniform(0.995, 1.005), noise=rng.uniform(0.02, 0.4) * 1e-6, seed=k,
                       turns=int(rng.integers(1, 5)), shift=rng.uniform(-0.1, 0.1))  # fmt: skip
        best = causes(e, trace).best
        assert best.of.kind == "tip relief"
        assert best.of.of == (("driver", "driven"), ("driver",), ("driven",))[both]
        off.append((best.value - amount) / best.error)
    assert np.abs(off).max() < 3.0
    assert np.mean(np.abs(off) < 2.0) > 0.85
