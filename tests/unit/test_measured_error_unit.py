"""Measured transmission errors: orders, the curve of the mesh, and a synthetic trace beside the computed curve."""

import copy
from dataclasses import replace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.base.printed import figures, percent
from fegear.base.solution_cache import SolutionCache
from fegear.case.built.encoders import encoders_of
from fegear.case.reading import build_scene
from fegear.contact.fitted_error import beside_computed
from fegear.contact.measured_error import ShortTraceError, measured_error
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.results.catalogue import STAGES
from fegear.results.pair.error_otherwise import counted

TEETH, PITCH, TURN = 23, 9e-3, 2.0 * np.pi
X = np.linspace(-2e-3, -2e-3 + PITCH, 181)


def curve(x):
    phase = TURN * np.asarray(x) / PITCH
    return 1e-6 * (10.0 + np.cos(phase - 0.4) + 0.5 * np.sin(2.0 * phase) + 0.2 * np.cos(3.0 * phase))


def trace(turns, a_tooth=46.7, start=0.3, shift=0.0, offset=0.0, scale=1.0, noise=0.0):
    """Samples of a shaft that turns uniformly, with once and twice a turn besides."""
    count = int(turns * TEETH * a_tooth)
    angle = start + TURN * turns * np.arange(count) / count
    te = offset + scale * curve((angle - shift) * TEETH * PITCH / TURN)
    te = te + 8e-6 * np.cos(angle - 0.7) + 2e-6 * np.cos(2.0 * angle - 2.0)
    return angle, te + noise * np.random.default_rng(1).normal(size=count)


@pytest.mark.parametrize("wrapped", [False, True])
def test_orders_of_a_trace_are_those_that_it_was_made_of(wrapped):
    angle, te = trace(3.4)
    found = measured_error(np.mod(angle, TURN) if wrapped else angle, te, TEETH)
    spectrum = found.spectrum
    assert spectrum.turns == 3.0
    for order, amplitude, phase in ((1, 8e-6, 0.7), (2, 2e-6, 2.0), (23, 1e-6, 0.4), (46, 0.5e-6, 0.5 * np.pi)):
        at = int(np.argmin(np.abs(spectrum.order - order)))
        assert spectrum.order[at] == pytest.approx(order)
        assert spectrum.amplitude[at] == pytest.approx(amplitude, rel=1e-4)
        assert np.angle(np.exp(1j * (spectrum.phase[at] - phase))) == pytest.approx(0.0, abs=1e-3)
    others = np.abs(spectrum.order[:, None] - [1, 2, 23, 46, 69]).min(axis=1) > 1e-6
    assert spectrum.amplitude[others].max() < 1e-9
    assert found.n[:3].tolist() == [1, 2, 3]
    np.testing.assert_allclose(found.amplitude[:3], [1e-6, 0.5e-6, 0.2e-6], rtol=1e-3)
    # Parseval: the mean square is that of all orders.
    assert 0.5 * (spectrum.amplitude**2).sum() == pytest.approx(0.5 * (64 + 4 + 1 + 0.25 + 0.04) * 1e-12, rel=1e-3)


def test_eccentricity_of_the_mating_gear_is_no_part_of_the_orders_of_the_shaft():
    angle, te = trace(3.4)
    ratio = TEETH / 61
    eccentric = te + 5e-6 * np.cos(ratio * angle - 1.1) + 1e-6 * np.cos(2.0 * ratio * angle + 0.4)
    plain, found = measured_error(angle, eccentric, TEETH), measured_error(angle, eccentric, TEETH, 61)

    def line(of, order):
        at = int(np.argmin(np.abs(of.spectrum.order - order)))
        assert of.spectrum.order[at] == pytest.approx(order, rel=1e-12)
        return of.spectrum.amplitude[at], of.spectrum.phase[at]

    assert line(found, 1.0) == pytest.approx((8e-6, 0.7), rel=4e-3)
    assert abs(line(plain, 1.0)[0] - 8e-6) > 0.02e-6
    assert found.mate_order == ratio
    assert line(found, ratio) == pytest.approx((5e-6, 1.1), rel=4e-3)
    assert line(found, 2.0 * ratio) == pytest.approx((1e-6, TURN - 0.4), rel=2e-2)
    between = np.abs(found.spectrum.order[:, None] - [1, 2, ratio, 2 * ratio, 23, 46, 69]).min(axis=1) > 1e-6
    assert found.spectrum.amplitude[between].max() < 0.02e-6
    # too short for a revolution of the mating gear, or one whose order the shaft has itself: nothing is fitted
    assert measured_error(*trace(1.2), TEETH, 61).mate_order == 0.0
    assert measured_error(angle, te, TEETH, TEETH).mate_order == 0.0
    np.testing.assert_array_equal(measured_error(angle, te, TEETH, TEETH).spectrum.order, plain.spectrum.order)


@pytest.mark.parametrize("turns", [4.0, 4.6, 5.0])
def test_an_encoder_that_counts_twice_or_half_is_known_by_the_mesh_order(turns):
    angle, te = trace(turns, a_tooth=90.0, noise=0.1e-6)
    assert counted(measured_error(angle, te, TEETH)) == ""
    assert counted(measured_error(2.0 * angle, te, TEETH)) == "twice"
    assert counted(measured_error(0.5 * angle, te, TEETH)) == "half"
    assert counted(measured_error(*trace(1.2), TEETH)) == ""  # too short


def test_the_curve_of_the_mesh_has_nothing_of_slow_parts():
    found = measured_error(*trace(2.0, a_tooth=40.0, start=0.0), TEETH)
    expected = curve(found.angle * TEETH * PITCH / TURN)
    np.testing.assert_allclose(found.te - found.te.mean(), expected - expected.mean(), atol=2e-8)
    assert found.te.mean() == pytest.approx(10e-6, abs=1e-7)
    assert found.spread < 0.1e-6  # what bends within a tooth pitch of once a turn
    assert found.pitches == 45


def test_a_part_of_a_turn_serves_too():
    found = measured_error(*trace(0.4, start=1.0), TEETH)
    assert found.spectrum.turns == pytest.approx(9.0 / TEETH)
    np.testing.assert_allclose(found.spectrum.order[:9:1][0], TEETH / 9.0)
    np.testing.assert_allclose(np.ptp(found.te), np.ptp(curve(X)), rtol=0.02)


@pytest.mark.parametrize(("turns", "a_tooth"), [(0.1, 50.0), (2.0, 4.0)])
def test_short_and_sparse_traces_are_refused(turns, a_tooth):
    with pytest.raises(ShortTraceError):
        measured_error(*trace(turns, a_tooth), TEETH)


def test_an_encoder_that_trembles_and_repeats_its_angle_gives_the_same_curve():
    angle, te = trace(2.0, start=0.0, noise=0.02e-6)
    step = angle[1]
    seen = 0.002 * step * np.rint((angle / step + np.random.default_rng(2).uniform(-1.2, 1.2, angle.size)) / 0.002)
    assert (np.diff(seen) < 0.0).any()
    assert np.unique(seen).size < seen.size
    exact = curve(seen * TEETH * PITCH / TURN) + 8e-6 * np.cos(seen - 0.7) + 2e-6 * np.cos(2.0 * seen - 2.0)
    found = measured_error(seen, exact + te - trace(2.0, start=0.0)[1], TEETH)
    expected = curve(found.angle * TEETH * PITCH / TURN)
    np.testing.assert_allclose(found.te - found.te.mean(), expected - expected.mean(), atol=3e-8)
    assert found.spread < 0.1e-6


@pytest.mark.parametrize("fit", [("offset", "scale", "shift"), ("offset", "shift"), ("scale", "offset"), ("offset",)])
def test_offset_scale_and_shift_are_recovered_within_their_errors(fit):
    true = {
        "offset": 7e-6 if "offset" in fit else 0.0, "scale": 1.12 if "scale" in fit else 1.0,
        "shift": 0.05 if "shift" in fit else 0.0,
    }  # fmt: skip
    found = measured_error(*trace(5.2, noise=0.3e-6, **true), TEETH)
    fitted = beside_computed(found, X, curve(X), PITCH, fit)
    for name in fit:
        error = fitted.errors[name]
        assert error > 0.0
        assert abs(getattr(fitted, name) - true[name]) < 4.0 * error + 2e-3 * abs(true[name])
    assert fitted.correlation > 0.99
    assert fitted.rms < 0.1e-6
    # Angles are those of the shaft: the computed curve at them is that of the same position of the mesh.
    np.testing.assert_allclose(fitted.computed, curve(fitted.angle * TEETH * PITCH / TURN), atol=2e-9)
    assert fitted.angle.max() <= TURN / TEETH


CASE = {
    "results": ["measured-transmission-error"],
    "gear": {
        "a": {"teeth": 20, "module": "2 mm", "face_width": "10 mm", "profile_shift": 0.1},
        "b": {"teeth": 31, "module": "2 mm", "face_width": "10 mm"},
    },
    "pair": {"p": {"driver": "a", "driven": "b", "torques": ["10 N*m", "20 N*m"]}},
    "encoders": {"rig": {"traces": [{"file": "high.csv"}], "fit": ["offset", "scale", "shift"]}},
    "effects": {"neighbour_coupling": True, "hertz": "load-dependent", "corner_contact": True},
    "accuracy": {"tolerance": 1e-2},
}
_CACHE = SolutionCache()


def ran(document, folder):
    scene = build_scene(document, "case", folder)
    return run_plan(scene, make_plan(scene, STAGES), cache=_CACHE)


def changed(**encoders):
    document = copy.deepcopy(CASE)
    for key, value in encoders.items():
        document["encoders"]["rig"][key] = value
    return document


@pytest.fixture(scope="module")
def computed(tmp_path_factory):
    document = copy.deepcopy(CASE)
    document["results"] = ["transmission-error"]
    del document["encoders"]
    return ran(document, tmp_path_factory.mktemp("computed")).outcomes[Task("transmission-error", "p")].data.found


def written(folder, name, computed, at, shaft="driver", sign=1.0, unit=1e-6, head="te [um]", noise=0.05e-6):
    """A trace of two turns: offset 3 um, scale 0.9, shift 0.04 rad, eccentricity, noise."""
    pair = computed.pair
    teeth = pair.gear(shaft).teeth
    angle = TURN * 2.0 * np.arange(100 * teeth) / (100 * teeth)
    x = (angle - 0.04) * teeth * pair.base_pitch / TURN
    inside = computed.x < computed.x[0] + pair.base_pitch
    te = np.interp(x, computed.x[inside], computed.te[inside, at], period=pair.base_pitch)
    te = 3e-6 + 0.9 * te + 5e-6 * np.cos(angle) + noise * np.random.default_rng(2).normal(size=angle.size)
    rows = zip(np.rad2deg(angle), sign * te / unit, strict=True)
    (folder / name).write_text(f"angle [deg],{head}\n" + "".join(f"{a:.6f},{v:.8g}\n" for a, v in rows))


def numbers(results, name="rig"):
    found = results.outcomes[Task("measured-transmission-error", name)]
    return found, {value.name.removeprefix(f"{name}."): value.si for value in found.values}


def test_a_synthetic_measurement_of_a_case_is_recovered(computed, tmp_path):
    for name, at in (("low.csv", 0), ("high.csv", 1)):
        written(tmp_path, name, computed, at)
    traces = [{"file": "low.csv", "torque": "10 N*m"}, {"file": "high.csv", "torque": "20 N*m"}]
    found, values = numbers(ran(changed(traces=traces), tmp_path))
    assert values["measured_offset"] == pytest.approx(3e-6, abs=5.0 * values["measured_offset_standard_error"] + 2e-8)
    assert values["measured_scale"] == pytest.approx(0.9, abs=5.0 * values["measured_scale_standard_error"] + 1e-3)
    assert np.angle(np.exp(20j * (values["measured_shift"] - 0.04))) == pytest.approx(0.0, abs=0.01)
    assert values["correlation"] > 0.999
    assert values["measured_to_computed"] == pytest.approx(0.9, rel=0.02)
    assert (values["largest_other_order"], values["largest_other_amplitude"]) == pytest.approx((1.0, 5e-6), rel=1e-2)
    harmonics = next(one for one in found.tables if one.name == "measured_te_harmonics_rig")
    columns = {column.name: column.si for column in harmonics.columns}
    assert np.unique(columns["torque"].round(9)).tolist() == pytest.approx([10.0, 20.0])
    first = columns["n"] == 1
    np.testing.assert_allclose(columns["measured_amplitude"][first], 0.9 * columns["computed_amplitude"][first],
                               rtol=0.01)  # fmt: skip
    assert any(
        "measured transmission error does not agree with the computed one: 10 % below it (limit " in remark
        for remark in found.remarks
    )
    judged, cause, sides, once = found.answer.sentences
    # of a torque between those computed the transmission error is that of both
    low, high = (one.computed_peak_to_peak for one in found.data.traces)
    needed, gain = found.data.last.torque_needed, 0.9 * high / low  # at the other torque
    assert np.log2(needed / 10.0) == pytest.approx(np.log(gain) / np.log(gain / 0.9), abs=0.03)
    assert cause.startswith("Encoders rig: measured / computed is the same at both torques, 0.9, as of the scale of ")
    assert sides.startswith("Encoders rig at 20 N m, peak-to-peak values: measured")
    assert "(includes noise), computed" in sides
    assert judged == (
        "Encoders rig: measured transmission error does not agree with the computed one: 10 % below it (limit 1.0 %); "
        f"a torque of {figures(needed)} N m ({percent(1.0 - needed / 20.0)} "
        "lower) would explain it; check torque, relief and the unit of the trace."
    )
    assert once.startswith("Encoders rig: once per revolution 5 µm of the driver (maximum at ")
    assert once.endswith(": runout of gear, shaft or encoder, not part of the comparison.")
    assert values["runout"] == pytest.approx(5e-6, rel=1e-2)
    assert np.cos(values["runout_angle"]) == pytest.approx(1.0, abs=1e-3)
    high = found.data.last
    assert replace(high, estimated=False).verdict == ""
    near = replace(high, fitted=replace(high.fitted, gain=1.05), computed_error=0.35 * high.computed_peak_to_peak)
    assert (
        "is 5.0 % above the computed one; this cannot be judged: the computed one is known to ±35 % only"
        in near.verdict
    )
    assert {figure.name for figure in found.figures} >= {"measured_te_rig", "measured_te_orders_rig",
                                                         "measured_te_harmonics_rig"}  # fmt: skip


def test_both_gears_have_their_runout_with_its_place(computed, tmp_path):
    """Of the mating gear by its own rotation; neither has a part in the comparison."""
    written(tmp_path, "high.csv", computed, 1)
    _, plain = numbers(ran(changed(), tmp_path))
    lines = [line.split(",") for line in (tmp_path / "high.csv").read_text().splitlines()[1:]]
    angle, te = np.array(lines, dtype=float).T
    more = te + 3.0 * np.cos(np.radians(angle) * 20.0 / 31.0 - 2.0)
    text = "".join(f"{a:.6f},{v:.8g}\n" for a, v in zip(angle, more, strict=True))
    (tmp_path / "high.csv").write_text("angle [deg],te [um]\n" + text)
    outcome, values = numbers(ran(changed(), tmp_path))
    assert values["mate_runout"] == pytest.approx(3e-6, rel=2e-2)
    assert values["mate_runout_angle"] == pytest.approx(2.0, abs=2e-2)
    assert values["runout"] == pytest.approx(5e-6, rel=2e-2)
    assert values["measured_scale"] == pytest.approx(plain["measured_scale"], rel=2e-3)
    off = values["measured_offset"] - plain["measured_offset"]  # of the mate there are no whole turns
    assert abs(off) < 3.0 * values["measured_offset_standard_error"] < 1e-6
    once = outcome.answer.sentences[2]
    assert "µm of the driven gear (maximum at 11" in once, once
    assert "° of the measured angle) and " in once
    assert "° of its own rotation from there): runout" in once
    orders = next(one for one in outcome.tables if one.name == "measured_te_orders_rig")
    assert "phase" in [column.name for column in orders.columns]


def test_a_double_helical_pair_has_the_torques_of_both_halves(tmp_path):
    """Its loads are those of one half: a torque of 20 N m was refused, and is a load of 10 N m on each."""
    document = changed(traces=[{"file": "high.csv", "torque": "20 N*m"}])
    for name, hand in (("a", "right"), ("b", "left")):
        document["gear"][name] |= {"helix_angle": "20 deg", "hand": hand, "normal_module": "2 mm"}
        del document["gear"][name]["module"]
    document["pair"]["p"] |= {"double_helical": {"floating": "none"}, "width": "slices"}
    rows = "".join(f"{a},{a % 7},{20 if a > 200 else 10}\n" for a in range(720))
    (tmp_path / "high.csv").write_text("angle [deg],te [um],torque [N*m]\n" + rows)
    scene = build_scene(document, "case", tmp_path)
    found = encoders_of(scene, "rig")
    radius = scene.pairs["p"].driver.base_radius
    assert found.halves == 2
    assert found.traces[0].load == pytest.approx(10.0 / radius)
    document["encoders"]["rig"]["traces"] = [{"file": "high.csv"}]
    both = encoders_of(build_scene(document, "case", tmp_path), "rig").traces
    assert [one.load * radius for one in both] == pytest.approx([5.0, 10.0])
    assert both[0].angle.size == pytest.approx(200, abs=20)


def test_a_column_of_the_torque_parts_a_trace_by_the_torques_of_the_pair(computed, tmp_path):
    rng, rows, parts = np.random.default_rng(3), [], {}
    for name, at, torque in (("low.csv", 0, 10.0), ("high.csv", 1, 20.0)):
        written(tmp_path, name, computed, at)
        parts[name] = [line.split(",") for line in (tmp_path / name).read_text().splitlines()[1:]]
        rows += [(*row, torque * (1.0 + 0.02 * rng.normal())) for row in parts[name]]
        rows += [("0", "1", 13.0 + 0.05 * k) for k in range(200)]  # a ramp, of no torque of the pair
    text = "".join(f"{a},{te},{torque:.4f}\n" for a, te, torque in rows)
    (tmp_path / "both.csv").write_text("angle [deg],te [um],torque [N*m]\n" + text)
    found, both = numbers(ran(changed(traces=[{"file": "both.csv"}]), tmp_path))
    separate = [{"file": "low.csv", "torque": "10 N*m"}, {"file": "high.csv", "torque": "20 N*m"}]
    _, apart = numbers(ran(changed(traces=separate), tmp_path))
    for name in ("measured_scale", "measured_shift", "measured_peak_to_peak"):
        assert both[name] == pytest.approx(apart[name], rel=0.01)
    assert any("samples at other torques left out" in remark for remark in found.remarks)
    case = build_scene(changed(traces=[{"file": "both.csv"}], torque_band=0.001), "case", tmp_path)
    assert [trace.load for trace in encoders_of(case, "rig").traces]  # the mean over a tooth pitch sheds noise
    (tmp_path / "both.csv").write_text("angle [deg],te [um],torque [N*m]\n0,1,50\n1,2,50\n2,1,50\n")
    with pytest.raises(InputError, match=r"add the measured torques to pair\.p\.torques"):
        encoders_of(build_scene(changed(traces=[{"file": "both.csv"}]), "case", tmp_path), "rig")


def test_lead_angles_of_the_driven_shaft_are_the_same_measurement(computed, tmp_path):
    written(tmp_path, "high.csv", computed, 1, "driven")
    _, plain = numbers(ran(changed(shaft="driven"), tmp_path))
    radius = computed.pair.driven.base_radius
    written(tmp_path, "high.csv", computed, 1, "driven", -1.0, radius * np.pi / 180.0 / 3600.0, "te [arcsec]")
    _, other = numbers(ran(changed(shaft="driven", te_at="driven", positive="lead"), tmp_path))
    for name in ("measured_offset", "measured_scale", "measured_shift", "correlation", "measured_peak_to_peak"):
        assert other[name] == pytest.approx(plain[name], rel=1e-5)


@pytest.mark.parametrize("shaft", ["driver", "driven"])
@pytest.mark.parametrize("mate_sense", [1.0, -1.0])
def test_the_angles_of_both_shafts_are_the_same_measurement(computed, shaft, mate_sense, tmp_path):
    """Each from its own zero, starting again with every revolution, counted in either sense by the mate's encoder."""
    written(tmp_path, "high.csv", computed, 1, shaft)
    plain = encoders_of(build_scene(changed(shaft=shaft), "case", tmp_path), "rig").traces[0]
    pair = computed.pair
    own, mate = (gear.base_radius for gear in (pair.driver, pair.driven)[:: 1 if shaft == "driver" else -1])
    lag = plain.te if shaft == "driver" else -plain.te
    turned = mate_sense * (plain.angle * own - lag) / mate + 2.1
    rows = zip(*(np.mod(np.degrees(one), 360.0) for one in (plain.angle + 0.0, turned)), strict=True)
    (tmp_path / "high.csv").write_text("a [deg],b [deg]\n" + "".join(f"{a:.9f},{b:.9f}\n" for a, b in rows))
    keys = {"shaft": shaft, "angle_column": "a", "mate_column": "b", "fit": ["offset", "scale", "shift"]}
    found = encoders_of(build_scene(changed(**keys), "case", tmp_path), "rig").traces[0]
    np.testing.assert_allclose(found.angle, plain.angle, atol=1e-9)
    np.testing.assert_allclose(found.te, plain.te - plain.te.mean(), atol=2e-11)
    with pytest.raises(InputError, match=r'column "a": turns .* times as far as "b"; the teeth require'):
        encoders_of(build_scene(changed(**{**keys, "angle_column": "b", "mate_column": "a"}), "case", tmp_path), "rig")


@pytest.mark.parametrize(
    ("encoders", "rule"),
    [
        ({"mate_column": "b", "fit": ["scale"]}, 'requires "offset" with mate_column'),
        ({"mate_column": "angle"}, "is the column of the angle"), ({"mate_column": "b"}, "requires a column b"),
        ({"mate_column": "b", "te_at": "driven"}, "te_at = driven: contradicts mate_column; remove either"),
        ({"traces": []}, "must not be empty"), ({"traces": [{}]}, "is required"),
        ({"fit": ["scale", "scale"]}, "twice"),
        ({"te_column": "angle"}, "is the column of the angle"), ({"te_column": "SG"}, "requires a column SG"),
        ({"traces": [{"file": "t.csv", "te_column": "x"}]}, "unknown key; use encoders.rig.te_column"),
        ({"traces": [{"file": "none.csv"}]}, "file not found"), ({"pair": "q"}, "is not a pair"),
        ({"traces": [{"file": "t.csv", "torque": "11 N*m"}]}, "is not a torque of pair p"),
        ({"traces": [{"file": "t.csv", "torque": f"{20.0 * 31 / 20} N*m"}]}, "on the driven gear is 20 N*m (divided"),
        ({"traces": [{"file": "t.csv", "torque": "20 N*m"}] * 2}, "one torque twice"),
        ({"traces": [{"file": "t.csv"}, {"file": "t.csv"}]}, "is that of another trace"),
        ({"torque_column": "te"}, "is the column of the transmission error"),
        ({"traces": [{"file": "t.csv"}, {"file": "t.csv", "torque": "20 N*m"}]}, "traces[0].torque = 20 N*m: is"),
        ({"traces": [{"file": "t.csv", "torque": "20 N*m"}, {"file": "t.csv"}]}, "traces[1].torque = 20 N*m: is"),
        ({"angle_column": "te"}, "angle_column = te: is the column of the transmission error"),
        ({"te_at": "driven"}, "is not an angle"), ({"te": "mm"}, "the case has mm"),
        ({"load_tolerance": 2.0}, "less than or equal to 1"),
    ],
)  # fmt: skip
def test_wrong_keys_are_one_sentence(encoders, rule, tmp_path):
    (tmp_path / "t.csv").write_text("angle [deg],te [um]\n" + "".join(f"{a},{a % 7}\n" for a in range(400)))
    with pytest.raises(InputError) as refused:
        encoders_of(build_scene(changed(**{"traces": [{"file": "t.csv"}], **encoders}), "case", tmp_path), "rig")
    assert rule in str(refused.value)
    assert str(refused.value).startswith("encoders.rig")
    assert "\n" not in str(refused.value)


@pytest.mark.parametrize(
    ("lines", "rule"),
    [
        (range(30), "fewer than 3"), (range(0, 400, 9), "samples per tooth pitch"),
        ([5] * 400, "has the same angle in every line"),
        ([0.5 * k for k in range(1600) if not 400 < k < 800], "has no sample over 200 deg after 200 deg"),
        ([0.5 * k for k in (*range(900), *range(800, 0, -1))], "runs back by 449 deg"),
    ],
)  # fmt: skip
def test_traces_that_say_too_little_are_refused(lines, rule, tmp_path):
    (tmp_path / "high.csv").write_text("angle [deg],te [um]\n" + "".join(f"{a},{k % 7}\n" for k, a in enumerate(lines)))
    with pytest.raises(InputError) as refused:
        ran(changed(), tmp_path)
    assert rule in str(refused.value)
    assert "encoders.rig.traces[0].file" in str(refused.value)


@pytest.mark.parametrize("turns", [1.0, 2.4, 5.2])
def test_the_mean_of_a_trace_without_whole_turns_of_the_mate_has_its_error(turns):
    """Eccentricities of both gears about a mean of -40 um: off by less than three stated errors."""
    rng, off, stated = np.random.default_rng(4), [], []
    for _ in range(12):
        angle = np.linspace(0.0, 2.0 * np.pi * turns, int(turns * 27 * 40))
        te = -40e-6 + 9e-6 * np.cos(angle - rng.uniform(0.0, 6.0)) + rng.normal(0.0, 3e-7, angle.size)
        te += 6e-6 * np.cos(angle * 27.0 / 49.0 - rng.uniform(0.0, 6.0)) + 1e-6 * np.cos(27.0 * angle)
        found = measured_error(angle, te, 27, 49)
        off.append(abs(found.te.mean() + 40e-6))
        stated.append(found.mean_error)
    assert sum(one < 3.0 * error for one, error in zip(off, stated, strict=True)) >= 10
    assert np.median(off) > 3e-3 * np.median(stated)  # no error is so large that it says nothing
    assert (np.median(stated) < 1e-8) == (turns > 3.0)
