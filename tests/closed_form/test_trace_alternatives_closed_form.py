"""Traces that are described wrongly, and samples that are no measurement: found where they are, and only there."""

import math
from itertools import product

import numpy as np
import pytest

from fegear.contact.curve_fit import fit_curve
from fegear.contact.trace_alternatives import alternatives, unexplained, whole_pitches
from fegear.contact.trace_outliers import suspected
from fegear.contact.trace_scatter import gains_of_turns, noise_of, of_mean, step_of

#: Places [deg] and strain of a tooth of a spur pair in its tension and in its compression fillet.
_AT = np.array([-25.0, -12.0, -10.5, -1.5, 0.0, 3.0, 4.5, 13.0, 14.5, 28.0])
_TENSION = np.array([-33.0, -38.0, 280.0, 460.0, 800.0, 890.0, 590.0, 605.0, 45.0, 30.0])
_COMPRESSION = np.array([-30.0, -30.0, -210.0, -500.0, -880.0, -1070.0, -680.0, -700.0, 50.0, 30.0])
ANGLE = np.radians(np.linspace(-25.0, 28.0, 400))
CURVES = {
    name: np.interp(np.degrees(ANGLE), _AT, one) for name, one in (("", _TENSION), ("opposite", _COMPRESSION))
}  # fmt: skip
#: The sign, the sense of the angle and the curve of a trace that is described wrongly.
WRONG = {
    "sign": (-1.0, 1.0, ""), "reverse": (1.0, -1.0, ""), "curve": (1.0, 1.0, "opposite"),
    "reverse curve": (1.0, -1.0, "opposite"),
}  # fmt: skip


def trace(seed, sign=1.0, sense=1.0, name="", *, shift=None, noise=20.0, turns=3, step=0.5, spikes=0):
    """Angle [rad] and strain of a trace of known numbers, whose zero is anywhere unless it is given."""
    rng = np.random.default_rng(seed)
    angle = np.radians(np.arange(0.0, 360.0 * turns, step))
    shift = float(rng.uniform(0.0, 2.0 * math.pi)) if shift is None else shift
    place = sense * (np.mod(angle - shift + math.pi, 2.0 * math.pi) - math.pi)
    strain = sign * rng.uniform(0.8, 1.2) * np.interp(place, ANGLE, CURVES[name], left=0.0, right=0.0)
    strain += rng.uniform(-100.0, 100.0) + rng.normal(0.0, noise, angle.size)
    strain[rng.choice(angle.size, spikes, replace=False)] += rng.choice([-1.0, 1.0], spikes) * 3000.0
    return angle, strain


def others(angle, strain, fit):
    """A trace as it is described, and what fits it better."""
    found = fit_curve(angle, strain, ANGLE, CURVES[""], fit)
    return found, alternatives(found, angle, strain, ANGLE, CURVES, fit)


@pytest.mark.dear("0.0", "None")
@pytest.mark.parametrize("shift", [None, 0.0])
def test_nothing_is_said_of_traces_that_are_described_rightly(shift):
    fit = ("offset", "scale", "shift")[: 3 if shift is None else 2]
    for seed in range(100):
        noise = (3.0, 30.0, 100.0, 300.0)[seed % 4]  # up to a third of the peak
        found, better = others(*trace(seed, shift=shift, noise=noise, turns=1 + seed % 3, spikes=seed % 5), fit)
        assert better == ()
        assert 0.7 < found.gain < 1.35


@pytest.mark.dear
@pytest.mark.parametrize("kind", WRONG)
@pytest.mark.parametrize("shift", [None, 0.0])
def test_what_is_described_wrongly_is_found(kind, shift):
    fit = ("offset", "scale", "shift")[: 3 if shift is None else 2]
    for seed in range(12):
        noise = (3.0, 30.0, 100.0)[seed % 3]
        better = others(*trace(seed, *WRONG[kind], shift=shift, noise=noise, turns=1 + seed % 3), fit)[1]
        found = [one.fitted for one in better if one.changes == tuple(kind.split())]
        assert len(found) == 1  # beside another one at most, where noise hides the difference
        assert len(better) == 1 or (noise > 50.0 and len(better) == 2)
        assert 0.75 < found[0].gain < 1.25


@pytest.mark.parametrize(
    ("name", "factor", "sense"), [("mate", 31.0 / 19.0, -1.0), ("twice", 0.5, 1.0), ("half", 2.0, 1.0)]
)
def test_an_angle_of_another_shaft_or_counted_otherwise_is_found(name, factor, sense):
    """Also where it begins again with every turn of the shaft that it is of, and where it is counted backwards."""
    turnings = {"mate": 31.0 / 19.0, "twice": 0.5, "half": 2.0}
    for seed, wrapped in ((1, False), (2, True)):
        angle, strain = trace(seed, turns=5, shift=1.0, noise=10.0, step=1.0)
        counted = sense * angle / factor
        counted = np.mod(counted, 2.0 * math.pi) if wrapped else counted
        found = fit_curve(counted, strain, ANGLE, CURVES[""], ("offset", "scale"))
        better = alternatives(found, counted, strain, ANGLE, CURVES, ("offset", "scale"), turnings=turnings)
        changes = ("turning",) if sense > 0.0 else ("reverse", "turning")
        assert [(one.changes, one.turning) for one in better] == [(changes, name)]
        assert better[0].fitted.gain == pytest.approx(1.0, abs=0.25)
    rightly = trace(3, turns=4, noise=30.0)
    found = fit_curve(*rightly, ANGLE, CURVES[""], ("offset", "scale", "shift"))
    assert not alternatives(found, *rightly, ANGLE, CURVES, ("offset", "scale", "shift"), turnings=turnings)


def test_what_is_left_unexplained_is_that_of_own_least_squares():
    """Of every sign, sense and fillet, by numpy alone: without noise aside, and with its zero where it is."""
    angle, strain = trace(5, -1.0, 1.0, "", shift=0.0, noise=30.0, step=0.37)
    for sign, sense, name in product((1.0, -1.0), (1.0, -1.0), CURVES):
        place = np.mod(sense * angle + math.pi, 2.0 * math.pi) - math.pi
        inside = (place >= ANGLE[0]) & (place <= ANGLE[-1])
        columns = np.stack([np.ones(inside.sum()), np.interp(place[inside], ANGLE, CURVES[name])], axis=1)
        own, squares = np.linalg.lstsq(columns, sign * strain[inside], rcond=None)[:2]
        found = fit_curve(sense * angle, sign * strain, ANGLE, CURVES[name], ("offset", "scale"))
        assert (found.offset, found.scale) == pytest.approx(own, rel=1e-9)
        left = squares[0] / (inside.sum() * (sign * strain[inside]).var())
        assert 1.0 - found.correlation**2 == pytest.approx(left, rel=1e-9)
        assert unexplained(found) <= left if own[1] > 0.0 else unexplained(found) == 1.0
    (first, *_) = others(angle, strain, ("offset", "scale"))[1]
    assert first.changes == ("sign",)


@pytest.mark.parametrize(("teeth", "pitches"), [(24, 1), (24, -1), (24, 2), (24, 0.4), (17, -2)])
def test_a_gauge_on_the_next_tooth_is_a_shift_by_a_pitch(teeth, pitches):
    shift = pitches * 2.0 * math.pi / teeth
    (one,) = others(*trace(1, shift=shift), ("offset",))[1]
    assert one.changes == ("shift",)
    assert one.fitted.shift == pytest.approx(shift, abs=2e-3)
    assert whole_pitches(one.fitted.shift, teeth) == (pitches if isinstance(pitches, int) else 0)
    assert whole_pitches(1e-3, teeth) == whole_pitches(5 * 2.0 * math.pi / teeth, teeth) == 0


@pytest.mark.parametrize("turns", [1, 2, 4])
def test_spikes_are_counted_and_change_nothing_that_is_fitted(turns):
    fit = ("offset", "scale", "shift")
    for seed in range(10):
        clean, spoiled = (trace(seed, noise=6.0, turns=turns, spikes=n * turns) for n in (0, 12))
        one, other = (fit_curve(*each, ANGLE, CURVES[""], fit) for each in (clean, spoiled))
        place = np.mod(spoiled[0] - other.shift + math.pi, 2.0 * math.pi) - math.pi
        inside = (place >= ANGLE[0]) & (place <= ANGLE[-1])
        assert one.spikes == one.saturated == other.saturated == 0
        assert other.spikes == np.count_nonzero(np.abs(spoiled[1] - clean[1])[inside] > 0.0) == other.left_out.size
        for name in fit:
            assert getattr(other, name) == pytest.approx(getattr(one, name), abs=3.0 * one.errors[name])


def test_dropouts_and_saturation_are_left_out_of_the_fit():
    fit = ("offset", "scale", "shift")
    angle, strain = trace(3, noise=6.0)
    known = fit_curve(angle, strain, ANGLE, CURVES[""], fit)
    end = known.offset + 600.0
    cut = fit_curve(angle, np.minimum(strain, end), ANGLE, CURVES[""], fit)
    assert cut.saturated == pytest.approx(np.count_nonzero(strain > end), abs=3)
    assert (cut.saturated_at, cut.spikes) == (pytest.approx(end), 0)
    assert cut.scale == pytest.approx(known.scale, abs=4.0 * cut.scale_error)
    assert np.ptp(cut.left_out) == pytest.approx(0.0, abs=1e-9)
    lost = strain.copy()
    at = int(np.argmax(strain))
    lost[at - 3 : at + 5] = -9999.0  # what an amplifier writes for nothing
    dropped = fit_curve(angle, lost, ANGLE, CURVES[""], fit)
    assert (dropped.spikes, dropped.saturated) == (8, 0)
    assert dropped.scale == pytest.approx(known.scale, abs=2.0 * known.scale_error)


def test_a_difference_of_shape_and_coarse_steps_are_no_outliers():
    """What repeats in every turn, kinks of another curve, rest at one value, and exact curves are measurement."""
    fit = ("offset", "scale", "shift")
    for kind, turns in product(WRONG, (1, 4)):
        found = fit_curve(*trace(2, *WRONG[kind], noise=5.0, turns=turns), ANGLE, CURVES[""], fit)
        assert found.spikes <= 0.01 * found.samples
    for noise, step in product((0.0, 2.0), (2.0, 5.0)):
        angle, strain = trace(2, noise=noise)
        found = fit_curve(angle, step * np.round(strain / step), ANGLE, CURVES[""], fit)
        assert found.spikes == found.saturated == 0
    assert not np.any(suspected(np.arange(5.0)))


def test_noise_is_what_does_not_repeat():
    """Not the residual, in which a difference of shape is."""
    rng = np.random.default_rng(8)
    place = np.mod(np.linspace(0.0, 12.0, 3000), 1.0)
    shape, noise = np.sin(12.0 * place), rng.normal(0.0, 0.05, place.size)
    assert noise_of(place, shape + noise) == pytest.approx(0.05, rel=0.06)
    assert noise_of(np.sort(place), noise) == pytest.approx(0.05, rel=0.06)
    spoiled = shape + noise
    spoiled[::300] += 50.0
    assert noise_of(place, spoiled) == pytest.approx(0.05, rel=0.15)
    assert noise_of(place, 3.0 * place) == pytest.approx(0.0, abs=1e-9)  # a line has none
    assert noise_of(place[:2], noise[:2]) == 0.0


def test_the_limit_of_a_gain_does_not_grow_with_a_difference_of_shape():
    angle, strain = trace(4, noise=5.0, turns=4)
    fit = ("offset", "scale", "shift")
    bent = CURVES[""] + 60.0 * np.sin(np.radians(9.0) ** -1 * ANGLE)
    one, other = (fit_curve(angle, strain, ANGLE, curve, fit) for curve in (CURVES[""], bent))
    assert other.gain_error > 4.0 * one.gain_error  # the residual has the shape
    assert other.gain_scatter < 1.5 * one.gain_scatter


def test_a_torque_that_fluctuates_from_turn_to_turn_widens_the_limit():
    rng = np.random.default_rng(2)
    turn = np.repeat(np.arange(8.0), 200) + 0.1
    curve = np.tile(np.interp(np.linspace(-25.0, 28.0, 200), _AT, _TENSION), 8)
    gain = 1.0 + rng.normal(0.0, 0.03, 8)
    measured = np.repeat(gain, 200) * curve
    assert of_mean(gains_of_turns(turn, curve, measured, gain.mean(), free=True)) == pytest.approx(
        gain.std(ddof=1) / math.sqrt(8.0), rel=1e-9
    )
    assert of_mean(gains_of_turns(turn[:400], curve[:400], measured[:400], 1.0, free=True)) == 0.0


@pytest.mark.parametrize("step", [0.5, 20.0])
def test_samples_taken_in_steps_have_their_step_and_its_noise(step):
    """Rounding to steps is noise of step / sqrt(12), also where most samples are equal to those beside them."""
    angle, strain = trace(4, shift=1.0, noise=0.0, turns=6, step=0.1)
    rounded = step * np.round(strain / step)
    assert step_of(rounded) == pytest.approx(step, rel=1e-6)
    assert step_of(strain) == 0.0
    found = fit_curve(angle, rounded, ANGLE, CURVES[""], ("offset", "shift"))
    assert found.step == pytest.approx(step, rel=1e-6)
    assert found.noise >= 0.99 * step / math.sqrt(12.0)
    assert found.gain_noise > 0.0
