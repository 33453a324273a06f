"""What is said of traces that do not fit as they are described, and of samples left out."""

import math
import re
from dataclasses import replace

import numpy as np
import pytest

from fegear.base.notes import NoteClass
from fegear.contact.curve_fit import fit_curve
from fegear.contact.fitted_error import beside_computed, better_described
from fegear.contact.gauge_strain import gains_of_places, reach_of_places
from fegear.contact.measured_error import measured_error
from fegear.contact.once_per_turn import OncePerTurn
from fegear.contact.trace_alternatives import Alternative, alternatives
from fegear.results.pair.error_otherwise import OtherwiseError, orders_of_mate
from fegear.results.pair.gauge_otherwise import Otherwise
from fegear.results.pair.placed_gauge import counted_angle
from fegear.results.pair.trace_named import drawn_as, left_out, runout_named, thinned
from fegear.results.pair.trace_verdict import ComputedPeak, verdict

ANGLE = np.linspace(-0.4, 0.5, 300)
STRAIN = 9e-4 * np.interp(ANGLE, [-0.2, -0.15, 0.0, 0.05, 0.1, 0.2, 0.24], [0.0, 0.3, 0.9, 1.0, 0.6, 0.65, 0.0])
TURNS = np.arange(0.0, 4.0 * math.pi, 0.01)
_PHASE = 2.0 * math.pi * np.arange(101) / 100.0
#: Transmission error over a base pitch of 8 mm under two torques.
X, LIGHT = 8e-3 * _PHASE / (2.0 * math.pi), 1e-6 * (np.sin(_PHASE) + 0.6 * np.cos(2.0 * _PHASE))
HEAVY = 1e-6 * (3.0 * np.sin(_PHASE + 1.0) + 0.8 * np.sin(2.0 * _PHASE))
#: Computed peak with places of the grid that change the strain by 1/90 to either side.
PEAK = ComputedPeak(9e-4, 0.0, 1e-4 * np.array([-1.0, 0.0, 1.0]), 1.0 + np.array([1.0, 0.0, -1.0]) / 90.0, 0.01)


def strain(sign=1.0, sense=1.0, shift=0.0, noise=4e-6):
    place = sense * (np.mod(TURNS - shift + math.pi, 2.0 * math.pi) - math.pi)
    found = sign * np.interp(place, ANGLE, STRAIN, left=0.0, right=0.0)
    return found + np.random.default_rng(4).normal(0.0, noise, TURNS.size)


def judged(measured, fit=("offset", "scale"), *, teeth=24, brief=True, curves=None, torques=None):
    found = fit_curve(TURNS, measured, ANGLE, STRAIN, fit)
    better = alternatives(found, TURNS, measured, ANGLE, {"": STRAIN, **(curves or {})}, fit)
    otherwise = Otherwise(better, "tension", teeth, torques or {})
    return verdict(found, PEAK, otherwise, brief=brief)


@pytest.mark.parametrize(
    ("trace", "way", "remedy"),
    [
        ({"sign": -1.0}, "with its sign reversed", "check the polarity of the bridge"),
        ({"sense": -1.0}, "with its angle reversed", "check reverse (direction of the angle)"),
        ({"shift": 0.4}, "shifted by 22.9°", 'check the zero of the angle (add "shift" to fit)'),
        ({"shift": -2.0 * math.pi / 24}, "shifted by -15° (-1 tooth pitch)", "check the tooth of the gauge and the"),
        ({"shift": 4.0 * math.pi / 24}, "shifted by 30° (+2 tooth pitches)", "check the tooth of the gauge and the"),
        ({"sign": -1.0, "sense": -1.0}, "with its sign reversed and with its angle reversed", "the bridge and reverse"),
    ],
)  # fmt: skip
def test_the_way_in_which_a_trace_fits_is_said_in_place_of_a_verdict(trace, way, remedy):
    said = judged(strain(**trace))
    assert said.startswith(f"the trace fits {way}: RMS of the residual 0.4")
    assert remedy in said
    assert re.search(r" of the peak(, as described no fit| instead of [\d.]+ %), measured", said)
    assert "above the computed one" not in said
    assert judged(strain(**trace), brief=False).startswith(said)


def test_the_other_fillet_is_named():
    other = -1.2 * STRAIN * (1.0 + ANGLE)
    measured = np.interp(np.mod(TURNS + math.pi, 2.0 * math.pi) - math.pi, ANGLE, other, left=0.0, right=0.0)
    said = judged(measured, curves={"opposite": other})
    assert said.startswith("the trace fits the compression fillet: ")
    assert said.endswith("measured / computed 1.00; check fillet")


@pytest.mark.parametrize(
    ("ratio", "words"),
    [
        (1e-3, "; with a unit 1000 times larger it is 1 times: check the unit of the strain"),
        (1.1e6, "; with a unit 1e+06 times smaller it is 1.1 times: check the unit of the strain"),
        (0.5, ", as of half the torque, or a quarter bridge evaluated as a half bridge; check torque and bridge"),
        (2.0, ", as of twice the torque, or a half bridge evaluated as a quarter bridge; check torque and bridge"),
        (0.7, ", as computed at 150 N m; check the torque of the trace"), (1.3, "; likeliest cause: a torque, gauge"),
        (1.0, "measured strain agrees with the computed one: "),
    ],
)  # fmt: skip
def test_a_ratio_with_a_reason_is_named_by_it(ratio, words):
    assert words in judged(ratio * strain(), torques={"150 N m": 0.7})
    half = Otherwise(torques={"150 N m": 0.51}).of_ratio(0.505, 0.02)
    both = ", as computed at 150 N m, or as of a quarter bridge evaluated as a half bridge; check torque and bridge"
    assert half == both
    assert Otherwise().of_ratio(1.0, 0.01) == Otherwise().of_ratio(1.3, 0.01) == ""


def test_a_difference_of_shape_makes_no_verdict_milder():
    """The limit of a trace with noise is that of its noise, however large the residual of a wrong curve is."""
    bent = 1.06 * strain() + 8e-5 * np.sin(40.0 * TURNS)  # too far off, and of another shape
    said = judged(bent, brief=False)
    assert "(limit 1.5 %: placement 1.1 %" in said  # of placement and load, nearly
    assert "scatter 0.2" in said
    noise = float(said.split("noise ")[1].split(" %")[0])
    assert noise < 3.0
    assert float(said.split("residual ")[1].split(" %")[0]) > 5.0


def test_the_limit_by_the_place_is_that_of_the_side_on_which_the_difference_lies():
    """Near the maximum over the fillet a grid elsewhere sees less, never more."""
    low, high = (fit_curve(TURNS, ratio * strain(), ANGLE, STRAIN, ("offset", "scale")) for ratio in (0.95, 1.05))
    peak = replace(PEAK, gains=np.array([1.01, 1.0, 0.875]))
    below, above = (verdict(one, peak) for one in (low, high))
    assert "agrees with the computed one: 5.0 % below it (limit 13 %: placement 12 %" in below
    assert "; a grid 0.04 mm nearer to the tip or a torque or gauge factor 5.0 % lower would explain it; RMS" in below
    assert "does not agree with the computed one: 5.0 % above it (limit 1.4 %: placement 1.0 %" in above
    assert (
        "; likeliest cause: a torque, gauge factor or bridge supply 5.0 % higher (5 times load_tolerance); no grid "
        "within 0.25 mm would explain it" in above
    )
    assert reach_of_places(np.array([-7.0, -10.0, -10.5]), -10.0) == (3.0, 0.5)
    assert reach_of_places(np.array([10.0]), 10.0) == (0.0, 0.0)


@pytest.mark.parametrize("fit", [("offset", "scale"), ("offset", "scale", "shift"), ("scale",)])
def test_a_grid_displaced_by_its_tolerance_or_less_agrees_also_where_its_peak_changes_less_than_its_curve(fit):
    """The measured side is the scale of the whole curve, so the limit is, too; the place found is the one it had."""
    beside = 0.08 * (1.0 - np.exp(-(((ANGLE - 0.05) / 0.06) ** 2)))  # zero at the peak
    displaced = STRAIN[:, None] * (1.0 - beside[:, None] * np.array([-1.0, -0.5, 0.0, 0.5, 1.0]))
    assert displaced.max(axis=0) == pytest.approx(np.full(5, STRAIN.max()), rel=2e-3)
    place = np.mod(TURNS + math.pi, 2.0 * math.pi) - math.pi
    noise = np.random.default_rng(4).normal(0.0, 4e-6, TURNS.size)
    for k in (1, 3, 4):
        measured = np.interp(place, ANGLE, displaced[:, k], left=0.0, right=0.0) + noise
        found = fit_curve(TURNS, measured, ANGLE, STRAIN, fit)
        gains = gains_of_places(found, ANGLE, displaced)
        assert gains[2] == pytest.approx(1.0, abs=1e-12)
        assert gains[k] == pytest.approx(found.gain, abs=4e-3)
        peak = ComputedPeak(9e-4, 0.0, 1e-4 * np.array([-1.0, -0.5, 0.0, 0.5, 1.0]), gains, 0.01)
        assert abs(found.gain - 1.0) > 0.015
        assert abs(found.gain - 1.0) < peak.limits(2.0 * found.gain_scatter).together(found.gain - 1.0)


def test_a_verdict_that_hangs_on_an_effect_that_is_off_is_not_given():
    """What agrees without it need not agree with it; what is off either way is off."""
    peak = replace(PEAK, neglected={"corner_contact": 0.04}, including="set corner_contact = true under [effects]")
    without, far, both = (
        verdict(fit_curve(TURNS, gain * strain(), ANGLE, STRAIN, ("offset", "scale")), peak, brief=True)
        for gain in (0.96, 1.03, 0.98)
    )
    assert without == (
        "measured strain is 4.0 % below the one computed without corner_contact and 0.20 % below that with it: this "
        "cannot be judged; set corner_contact = true under [effects]"
    )
    assert "does not agree with the computed one: 3.0 % above it (limit 1.5 %), 7.1 % above it with corner_con" in far
    assert "this cannot be judged" in both
    small = verdict(
        fit_curve(TURNS, strain(), ANGLE, STRAIN, ("offset", "scale")), replace(peak, neglected={"a": 5e-3})
    )
    assert (
        "(limit 1.6 %: placement 1.1 %, load and gauge factor 1.0 %, computation 0 %, neglected effects 0.50 %" in small
    )


def test_a_scale_near_zero_is_no_fit_and_has_no_residual_over_it():
    curves = {"elsewhere": np.roll(STRAIN, 60) - 0.1 * STRAIN}
    measured = np.interp(np.mod(TURNS + math.pi, 2.0 * math.pi) - math.pi, ANGLE, curves["elsewhere"])
    own = fit_curve(TURNS, measured, ANGLE, STRAIN, ("offset", "scale"))
    rest = measured - own.scale * np.interp(np.mod(TURNS + math.pi, 2.0 * math.pi) - math.pi, ANGLE, STRAIN)
    lost = fit_curve(TURNS, rest, ANGLE, STRAIN, ("offset", "scale"))
    assert abs(own.scale) > abs(lost.scale)
    assert not lost.fits
    assert fit_curve(TURNS, strain(), ANGLE, STRAIN, ("offset", "scale")).fits
    assert Otherwise((Alternative(("sign",), "", own),)).said(lost, 9e-4).count("of the peak, as described no fit") == 1


def test_what_is_left_out_is_counted_and_drawn_otherwise():
    measured = strain()
    inside = np.flatnonzero(np.abs(np.mod(TURNS + math.pi, 2.0 * math.pi) - math.pi) < 0.3)
    measured[inside[::17]] += 5e-3
    found = fit_curve(TURNS, measured, ANGLE, STRAIN, ("offset",))
    count = inside[::17].size
    assert left_out(found).startswith(f"{count} of {found.samples + count} samples are spikes or dropouts; left out")
    assert drawn_as(found).endswith(" Crosses: samples left out of the comparison, far ones nearer than they are.")
    shown, room = thinned(found), np.ptp(found.measured)
    assert shown.left_out.size == count
    assert shown.left_out == pytest.approx(np.full(count, found.measured.max() + room))
    cut = fit_curve(TURNS, np.minimum(strain(), 6e-4), ANGLE, STRAIN, ("offset", "scale"))
    assert left_out(cut).endswith(
        "samples are saturated at 600 µm/m (range of the amplifier); left out of the comparison, drawn as crosses"
    )
    brief = verdict(cut, PEAK, brief=True)
    assert "samples are saturated at 600 µm/m" in brief
    assert brief.word.endswith(", saturated at 600 µm/m")
    clean = fit_curve(TURNS, strain(), ANGLE, STRAIN)
    assert left_out(clean) == left_out(None) == drawn_as(None) == ""
    assert drawn_as(clean) == " Points: strain as measured."


def encoders(te, sign=1.0, sense=1.0, teeth=24, at=1.0):
    """A trace of two turns with eccentricity and noise."""
    angle = np.linspace(0.0, 4.0 * math.pi, 24 * 2 * 40, endpoint=False)
    phase = np.mod(sense * teeth * angle, 2.0 * math.pi)
    found = sign * np.interp(phase, _PHASE, te) + 5e-6 * np.sin(angle)
    return at * angle, found + np.random.default_rng(2).normal(0.0, 2e-8, angle.size)


@pytest.mark.parametrize(
    ("trace", "words"),
    [
        ({"te": HEAVY, "sign": -1.0}, "with its sign reversed"), ({"te": HEAVY, "sense": -1.0}, "with its angle rev"),
        ({"te": LIGHT}, "as computed at 60 N m"), ({"te": HEAVY}, ""),
    ],
)  # fmt: skip
def test_traces_of_encoders_that_are_described_wrongly_are_named(trace, words):
    measured = measured_error(*encoders(**trace), 24, 36)
    fit = ("offset", "scale")
    fitted = beside_computed(measured, X, HEAVY, 8e-3, fit)
    better = better_described(measured, fitted, X, {"": HEAVY, "60 N m": LIGHT}, 8e-3, fit)
    said = OtherwiseError(better).said(fitted, float(np.ptp(HEAVY)))
    assert said.startswith(f"the trace fits {words}") if words else said == ""


def test_the_shape_at_another_torque_is_not_named_where_the_size_is_not_that_of_it():
    fit = ("offset", "scale", "shift")
    for size, named in ((1.05, True), (1.4, False), (0.7, False)):
        measured = measured_error(*encoders(size * LIGHT), 24, 36)
        fitted = beside_computed(measured, X, HEAVY, 8e-3, fit)
        better = better_described(measured, fitted, X, {"": HEAVY, "60 N m": LIGHT}, 8e-3, fit)
        assert ("60 N m" in [one.curve for one in better]) is named


@pytest.mark.parametrize("seed", range(6))
def test_a_reversed_angle_of_a_nearly_symmetric_curve_is_found_and_nothing_of_a_right_one(seed):
    """Of the variance it leaves some thousandths, far above the noise of the mean of all teeth."""
    rng = np.random.default_rng(seed)
    te = 1e-6 * (3.0 * np.cos(_PHASE) + 0.8 * np.cos(2.0 * _PHASE) + 0.03 * (1.0 + seed % 3) * np.sin(2.0 * _PHASE))
    fit = ("offset", "scale", "shift")
    for sense in (1.0, -1.0):
        angle, trace = encoders(te, sense=sense)
        measured = measured_error(angle, trace + rng.normal(0.0, 1e-7, trace.size), 24, 36)
        fitted = beside_computed(measured, X, te, 8e-3, fit)
        better = better_described(measured, fitted, X, {"": te}, 8e-3, fit)
        assert [one.changes for one in better] == ([] if sense > 0.0 else [("reverse",)])


def test_the_other_shaft_shows_in_the_orders():
    right, wrong = (measured_error(*encoders(HEAVY, at=at), 24, 36) for at in (1.0, 24.0 / 36.0))
    assert not orders_of_mate(right, 36)
    angle, te = encoders(HEAVY, at=24.0 / 36.0)
    long = np.concatenate([angle, angle + angle[-1] + angle[1]]), np.tile(te, 2)
    assert orders_of_mate(measured_error(*long, 24, 36), 36)
    assert wrong.spectrum.turns >= 1.0
    assert "the ratio of the teeth being 1.5; check te_at" in OtherwiseError(ratio=1.5).of_ratio(1.49)
    assert OtherwiseError(ratio=1.5).of_ratio(1.2) == OtherwiseError(ratio=1.0).of_ratio(1.02) == ""


def test_spikes_of_encoders_change_neither_curve_nor_verdict():
    angle, te = encoders(HEAVY)
    spoiled = te.copy()
    spoiled[50::97] += 3e-5
    one, other = (measured_error(angle, each, 24, 36) for each in (te, spoiled))
    assert one.spikes == 0
    assert other.spikes == te[50::97].size
    assert other.te == pytest.approx(one.te, abs=3e-8)
    fits = [beside_computed(each, X, HEAVY, 8e-3, ("offset", "scale")) for each in (one, other)]
    assert fits[1].gain == pytest.approx(fits[0].gain, rel=2e-3)


def test_the_limit_of_encoders_is_the_scatter_between_teeth():
    """Not the residual: of a curve of another shape the scatter stays what it is."""
    measured = measured_error(*encoders(HEAVY), 24, 36)
    bent = HEAVY + 2e-7 * np.sin(5.0 * _PHASE)
    one, other = (beside_computed(measured, X, te, 8e-3, ("offset", "scale")) for te in (HEAVY, bent))
    assert other.gain_error > 5.0 * one.gain_error
    assert other.gain_scatter == pytest.approx(one.gain_scatter, rel=0.1)
    few = replace(measured, by_teeth=measured.by_teeth[:2])
    assert beside_computed(few, X, HEAVY, 8e-3, ("offset", "scale")).gain_scatter > 0.0


@pytest.mark.parametrize("gains", [(1.0, 1.0, 0.7, 0.7), (0.7, 1.0, 0.7, 1.0)])
def test_a_trace_that_is_not_steady_does_not_agree_by_its_own_scatter(gains):
    four = np.arange(0.0, 8.0 * math.pi, 0.01) - 2.0  # turns begin outside the mesh
    turn = np.minimum((four + 2.0) / (2.0 * math.pi), 3.99).astype(int)
    place = np.mod(four + math.pi, 2.0 * math.pi) - math.pi
    measured = np.array(gains)[turn] * np.interp(place, ANGLE, STRAIN, left=0.0, right=0.0)
    measured += np.random.default_rng(8).normal(0.0, 4e-6, four.size)
    found = fit_curve(four, measured, ANGLE, STRAIN, ("offset", "scale"))
    said = verdict(found, PEAK)
    assert "15 % below the computed one; this cannot be judged: measured / computed strain is 0.70 to 1.00 from" in said
    assert said.kind is NoteClass.BEYOND_TOLERANCE
    assert said.word == "cannot be judged: 15 % below, not steady"
    steady = fit_curve(four, measured / np.array(gains)[turn], ANGLE, STRAIN, ("offset", "scale"))
    assert verdict(steady, PEAK).word.startswith("agrees: ")
    assert "not steady" not in verdict(steady, PEAK).word


def test_what_a_wrong_description_leaves_is_no_runout():
    often = np.tile(strain()[::4], 4)[: TURNS.size]
    found = fit_curve(TURNS, often, ANGLE, STRAIN, ("offset", "scale"))
    waving = replace(found, wave=OncePerTurn(3e-5, 1e-7, 0.2))
    assert waving.likeness < 0.6
    assert runout_named(waving) == ""
    told = replace(fit_curve(TURNS, strain(), ANGLE, STRAIN, ("offset", "scale")), wave=waving.wave)
    assert runout_named(told).startswith("once per turn the measured strain has 30 µm/m")


@pytest.mark.parametrize("factor", [1.0, 0.996, 1.007])
def test_an_encoder_that_loses_pulses_is_named_and_not_the_torque(factor):
    """The angle counts other than the gear turns; a part of the trace is noise."""
    turned = np.arange(0.0, 12.0 * math.pi, 0.01)
    place = np.mod(turned - 1.0 + math.pi, 2.0 * math.pi) - math.pi
    trace = np.interp(place, ANGLE, STRAIN) + np.random.default_rng(4).normal(0.0, 6e-6, turned.size)
    angle, fit = np.mod(factor * turned, 2.0 * math.pi), ("offset", "scale", "shift")
    found = fit_curve(angle, trace, ANGLE, STRAIN, fit)
    counted = counted_angle(angle, trace, found)
    if factor == 1.0:
        assert counted is None
        return
    assert counted == pytest.approx(1.0 / factor, abs=1e-4)
    better = alternatives(found, angle, trace, ANGLE, {"": STRAIN}, fit, turnings={"twice": 0.5, "counted": counted})
    said = Otherwise(better, teeth=24, mate_teeth=41).said(found, 9e-4)
    way, pulses = ("0.40 % longer (1.4°", "lost") if factor < 1.0 else ("0.70 % shorter (2.5°", "additional")
    assert said.startswith(f"the trace fits with an angle {way} per turn): RMS of the residual 0.")
    assert said.endswith(f"check the encoder ({pulses} pulses, lines per revolution)")


def test_a_ratio_that_agrees_with_a_shape_that_does_not_says_so():
    wider = np.interp(ANGLE, ANGLE * 1.07, STRAIN)  # another load sharing
    place = np.mod(TURNS + math.pi, 2.0 * math.pi) - math.pi
    clause = "times the noise: check relief, pitch deviations (load sharing) and filters"
    for noise, said in ((3e-6, True), (3e-5, False)):
        trace = np.interp(place, ANGLE, wider) + np.random.default_rng(4).normal(0.0, noise, TURNS.size)
        found = fit_curve(TURNS, trace, ANGLE, STRAIN, ("offset", "scale"))
        judged = verdict(found, replace(PEAK, load_tolerance=0.1), brief=True)
        assert judged.startswith("measured strain agrees with the computed one: ")
        assert (clause in judged) is said
    plain = fit_curve(TURNS, strain(), ANGLE, STRAIN, ("offset", "scale"))
    assert clause not in verdict(plain, PEAK, brief=True)
