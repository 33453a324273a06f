"""Measured flanks: traces of known slope, form and crown are found again, and pairs feel what was measured."""

from __future__ import annotations

import math
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.built.flank_modifications import gear_face
from fegear.case.built.gear_flanks import gear_flanks
from fegear.case.built.measured_flanks import measured_gear
from fegear.case.reading import build_scene, read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.formulas.iso1328 import tolerances_of
from fegear.formulas.iso1328_traces import cutoff, evaluate, filtered, helix_range, tightest_class
from fegear.results.catalogue import STAGES

CASES = Path(__file__).parents[2] / "cases"


def scene_of(folder, measured, **more):
    """A spur pair whose pinion is measured."""
    pinion = {"teeth": 21, "module": "3 mm", "face_width": "12 mm", "tolerance_class": 5, "measured": measured, **more}
    return build_scene(
        {
            "results": ["measured-flanks"], "effects": {"relief": True, "neighbour_coupling": True},
            "gear": {"a": pinion, "b": {"teeth": 32, "module": "3 mm", "face_width": "12 mm"}},
            "pair": {"I": {"driver": "a", "driven": "b", "load": "1 kN", "width": "slices"}},
        },
        "case", folder,
    )  # fmt: skip


def write(path, heads, *columns):
    lines = [",".join(heads), *(",".join(f"{one:.12g}" for one in row) for row in zip(*columns, strict=True))]
    path.write_text("\n".join(lines) + "\n", "utf-8")


def flank(scene):
    """Roll angles of the involute of the pinion, and where it is evaluated [rad]."""
    gear, pair = scene.gears["a"], scene.pairs["I"]
    start = min(float(pair.roll_angle(x, "driver")) for x in (pair.x_start, pair.x_end))
    end = gear.tooth.involute.end
    return np.linspace(start - 0.01, end, 400), start, start + 0.95 * (end - start)


@pytest.mark.parametrize("waves", [30.0, 10.0, 60.0])
def test_the_filter_lets_half_of_its_cut_off_through_and_leaves_lines_alone(waves):
    """2 to the power -(cut-off over wavelength) squared of a wave, by ISO 16610-21."""
    length = 10e-3
    x = np.linspace(0.0, 12e-3, 2401)
    wavelength = length / waves
    y = np.cos(2.0 * math.pi * (x - 6e-3) / wavelength)
    kept = filtered(x, y, cutoff(length))[1200]
    assert kept == pytest.approx(2.0 ** -((cutoff(length) / wavelength) ** 2), abs=2e-4)
    line = 3e-6 - 2e-3 * x
    assert np.abs(filtered(x, line, cutoff(length)) - line).max() < 1e-18


@pytest.mark.parametrize("phase", [0.0, 1.3])
def test_the_filter_weighs_lengths_not_points(phase):
    """Places three times as dense on one half of each wave as on the other: half of it is let through."""
    t, wavelength = np.linspace(-6.0, 6.0, 1201), 0.5
    x = wavelength * (t + 0.08 * np.sin(2.0 * math.pi * t))
    y = np.cos(2.0 * math.pi * x / wavelength + phase)
    inside = np.abs(t) < 3.0
    np.testing.assert_allclose(filtered(x, y, wavelength)[inside], 0.5 * y[inside], atol=1e-3)


def test_the_cut_off_is_a_thirtieth_of_the_range_and_at_least_25_um():
    assert cutoff(9e-3) == pytest.approx(0.3e-3)
    assert cutoff(0.3e-3) == 25e-6
    assert helix_range(20e-3, 2e-3) == pytest.approx((-9e-3, 9e-3))
    assert helix_range(100e-3, 2e-3) == pytest.approx((-48e-3, 48e-3))


@pytest.mark.parametrize(("slope", "crown", "form"), [(8e-6, 0.0, 0.0), (-5e-6, 3e-6, 0.0), (4e-6, -2e-6, 1.5e-6)])
def test_slope_crown_form_and_total_of_a_known_trace(slope, crown, form):
    """A line, a parabola, and a wave of whole periods and of both their symmetries, which neither fit sees."""
    x = np.linspace(0.0, 12e-3, 4001)
    s = (x - 6e-3) / 5e-3
    wave = np.cos(2.0 * math.pi * 20.0 * s)
    found = evaluate(x, 0.5 * slope * s - crown * s**2 + 0.5 * form * wave, 1e-3, 11e-3)
    assert found.slope == pytest.approx(slope, abs=1e-10)
    assert found.crown == pytest.approx(crown, abs=3e-9)
    assert found.form == pytest.approx(abs(crown) + form, rel=0.05, abs=1e-12)
    straight = 0.5 * slope * s - crown * s**2
    inside = np.abs(s) <= 1.0
    assert found.total == pytest.approx(np.ptp(straight[inside]) + form, rel=0.1)


def test_the_class_is_the_tightest_that_holds_slope_form_and_total():
    gear = read_scene(CASES / "measured_flanks.toml", ()).gears["pinion"]
    x = np.linspace(-6e-3, 6e-3, 501)
    allowed = tolerances_of(gear, 5).rounded.helix_slope
    for part, kept in ((0.99, 5), (1.01, 6)):
        found = evaluate(x, part * allowed * x / 10.8e-3, -5.4e-3, 5.4e-3)
        assert tightest_class(found, gear, "helix") == kept
    assert tightest_class(evaluate(x, x * 0.1, -5.4e-3, 5.4e-3), gear, "helix") is None


def test_what_exceeds_every_class_is_said_and_is_no_value(tmp_path):
    z = np.linspace(-6.0, 6.0, 49)
    write(tmp_path / "lead.csv", ["z [mm]", "deviation [um]"], z, 40.0 * z)
    scene = scene_of(tmp_path, {"lead": "lead.csv"})
    plan = make_plan(scene, STAGES)
    (found,) = (out for task, out in run_plan(scene, plan).outcomes.items() if task.stage == "measured-flanks")
    assert "a.helix_slope" in {value.name for value in found.values}
    assert not [value.name for value in found.values if math.isnan(value.si)]
    assert any("exceed class 11" in remark for remark in found.remarks)


def test_traces_of_a_drawn_relief_and_lead_load_the_pair_as_they_do(tmp_path):
    relief = {"tip": {"amount": "10 um", "length": "2 mm"}}
    drawn = scene_of(tmp_path, None, relief=relief, lead={"crowning": "4 um", "slope": "6 um"})
    pair = drawn.pairs["I"]
    roll, *_ = flank(drawn)
    want = gear_flanks(drawn, "a").profile(pair, "driver").removal(roll)
    z = np.linspace(-6e-3, 6e-3, 97)
    over = sum(part.removal(0.3, z) for part in gear_face(drawn, "a"))
    write(tmp_path / "p.csv", ["roll_angle [deg]", "deviation [um]"], np.degrees(roll), -want * 1e6 + 3.0)
    write(tmp_path / "l.csv", ["z [mm]", "deviation [um]"], z * 1e3, -over * 1e6 - 7.0)
    scene = scene_of(tmp_path, {"profile": "p.csv", "lead": "l.csv", "filter": False})
    found = gear_flanks(scene, "a").profile(pair, "driver").removal(roll)
    assert np.abs(found - want).max() < 0.2e-6  # its kink lies between places
    (table,) = gear_face(scene, "a")
    assert np.abs(table.removal(0.3, z) - (over - over.min())).max() < 0.05e-6
    # With the drawn flank as the design nothing deviates from it.
    both = scene_of(tmp_path, {"profile": "p.csv", "lead": "l.csv"}, relief=relief,
                    lead={"crowning": "4 um", "slope": "6 um"})  # fmt: skip
    values = run_plan(both, make_plan(both, STAGES)).values
    for kind in ("profile", "helix"):
        for key in ("slope", "form", "total"):
            assert abs(values[f"a.{kind}_{key}"].si) < 0.3e-6, (kind, key)


def test_radius_roll_angle_and_length_of_roll_say_the_same(tmp_path):
    plain = scene_of(tmp_path, None)
    gear = plain.gears["a"]
    roll, start, end = flank(plain)
    y = 3.0 * (roll - start) / (end - start)
    places = {
        "roll_angle [deg]": np.degrees(roll), "roll_length [mm]": roll * gear.base_radius * 1e3,
        "radius [mm]": gear.tooth.radius_of_roll(roll) * gear.module * 1e3,
    }  # fmt: skip
    slopes = []
    for n, (head, x) in enumerate(places.items()):
        write(tmp_path / f"{n}.csv", [head, "deviation [um]"], x, y)
        found = measured_gear(scene_of(tmp_path, {"profile": f"{n}.csv"}), "a").profile
        slopes.append(found.deviations(np.zeros(found.x.size))[0].slope)
    assert slopes == pytest.approx([3e-6] * 3, rel=1e-6)


def test_profile_traces_of_a_ring_gear_may_have_either_sign(tmp_path):
    def scene(measured):
        ring = {"teeth": 97, "internal": True, "module": "2.25 mm", "face_width": "20 mm", "rim_thickness": "10 mm",
                "cutter": {"teeth": 25, "addendum": 1.25, "tip_radius": 0.3}, "measured": measured}  # fmt: skip
        return build_scene({"results": ["measured-flanks"], "gear": {"a": ring}}, "case", tmp_path)

    gear = scene(None).gears["a"]
    involute = gear.tooth.involute
    roll = np.linspace(involute.start, involute.end, 400)
    y = 3.0 * (roll - roll[0]) / np.ptp(roll)
    radius = gear.tooth.radius_of_roll(roll) * gear.module * 1e3
    write(tmp_path / "radius.csv", ["radius [mm]", "deviation [um]"], radius, y)
    base = measured_gear(scene({"profile": "radius.csv"}), "a").profile
    for n, (sign, head, size) in enumerate(
        (sign, head, size)
        for sign in (1.0, -1.0)
        for head, size in (("roll_angle [deg]", 180.0 / np.pi), ("roll_length [mm]", gear.base_radius * 1e3))
    ):
        write(tmp_path / f"{n}.csv", [head, "deviation [um]"], sign * np.abs(roll) * size, y)
        found = measured_gear(scene({"profile": f"{n}.csv"}), "a").profile
        np.testing.assert_allclose(found.x, base.x, rtol=1e-9)
        np.testing.assert_allclose(found.deviation, base.deviation, atol=1e-12)


def test_every_tooth_is_evaluated_and_the_mean_is_what_pairs_take(tmp_path):
    roll, start, end = flank(scene_of(tmp_path, None))
    s = (2.0 * roll - start - end) / (end - start)
    teeth = {1: 2.0, 8: 6.0, 15: -5.0}
    write(
        tmp_path / "p.csv", ["tooth", "roll_angle [deg]", "deviation [um]"],
        np.repeat(list(teeth), roll.size), np.tile(np.degrees(roll), 3),
        np.concatenate([0.5 * k * s for k in teeth.values()]),
    )  # fmt: skip
    scene = scene_of(tmp_path, {"profile": "p.csv"})
    results = run_plan(scene, make_plan(scene, STAGES))
    table = results.tables["measured_deviations_a"]
    rows = {column.name: column.values for column in table.columns}
    assert list(rows["tooth"]) == ["1", "8", "15", "mean"]
    assert rows["slope_deviation"] == pytest.approx([2.0, 6.0, -5.0, 1.0], abs=1e-6)
    assert results.values["a.profile_slope"].value == pytest.approx(6.0, abs=1e-6)
    allowed = tolerances_of(scene.gears["a"], 5).rounded
    assert results.values["a.profile_slope_tolerance"].si == pytest.approx(allowed.profile_slope)
    removal = measured_gear(scene, "a").relief.removal(np.array([start, end]))
    assert removal == pytest.approx([1e-6, 0.0], abs=1e-10)


def test_a_topography_holds_its_own_traces(tmp_path):
    roll, *_ = flank(scene_of(tmp_path, None))
    roll = roll[::8]
    z = np.linspace(-6.0, 6.0, 25)
    t, h = np.meshgrid(roll, z, indexing="ij")
    u = (t - roll[0]) / np.ptp(roll)
    y = 4.0 * u + 2.0 * h / 12.0 + 3.0 * u * h / 12.0
    write(tmp_path / "t.csv", ["roll_angle [deg]", "z [mm]", "deviation [um]"],
          np.degrees(t).ravel(), h.ravel(), y.ravel())  # fmt: skip
    scene = scene_of(tmp_path, {"topography": "t.csv"}, lead={"crowning": "9 um"})
    found = measured_gear(scene, "a")
    (part,) = gear_face(scene, "a")
    assert part.removal(roll[5], 2e-3) == pytest.approx((y.max() - np.interp(2.0, z, y[5])) * 1e-6, rel=1e-9)
    share = (found.helix.ends[1] - found.helix.ends[0]) / 12e-3
    middle = 0.5 * sum(found.profile.ends) / scene.gears["a"].base_radius
    u = (middle - roll[0]) / np.ptp(roll)
    assert found.helix.deviations(np.zeros(found.helix.x.size))[0].slope == pytest.approx(
        share * (2.0 + 3.0 * u) * 1e-6, rel=1e-6
    )
    assert gear_flanks(scene, "a").relief is None


@pytest.mark.parametrize(
    ("measured", "words"),
    [
        ({}, "must have a file"),
        ({"profile": "none.csv"}, "none.csv"),
        ({"profile": "l.csv"}, "requires the columns radius"),
        ({"lead": "p.csv"}, r"requires the columns z \[mm\]"),
        ({"lead": "short.csv"}, r"lead_range = -5.4 to 5.4 mm: is not covered by at least five points of the trace"),
        ({"lead": "twice.csv"}, "tooth 0: has fewer than five points, or one point twice"),
        ({"lead": "l.csv", "lead_range": ["3 mm", "-3 mm"]}, "lead_range = 3 to -3 mm: must be strictly increasing"),
        ({"topography": "p.csv", "lead": "l.csv"}, "contradicts profile and lead"),
        ({"topography": "p.csv"}, r"requires the column z \[mm\]"),
    ],
)
def test_what_is_no_measurement_is_refused_in_words(tmp_path, measured, words):
    z = np.linspace(-6.0, 6.0, 25)
    write(tmp_path / "l.csv", ["z [mm]", "deviation [um]"], z, 0.0 * z)
    write(tmp_path / "short.csv", ["z [mm]", "deviation [um]"], 0.5 * z, 0.0 * z)
    write(tmp_path / "twice.csv", ["z [mm]", "deviation [um]"], np.floor(z), 0.0 * z)
    write(tmp_path / "p.csv", ["roll_angle [deg]", "deviation [um]"], z + 20.0, 0.0 * z)
    with pytest.raises(InputError, match=words):
        measured_gear(scene_of(tmp_path, measured), "a")


def test_the_case_with_synthetic_traces_says_that_they_are():
    for name in ("profile", "lead"):
        head = (CASES / "data" / f"measured_pinion_{name}.csv").read_text("utf-8").splitlines()[0]
        assert head.startswith("# Synthetic")


@pytest.mark.parametrize(
    ("change", "said"),
    [
        (lambda text: text.replace("[um]", "[mm]"), r"deviation 1000 um.*more than a tenth of the module.*unit"),
        (lambda text: text.replace("\n1,", "\n1.5,"), r"tooth 1.5.*whole number up to 21"),
        (lambda text: text.replace("\n1,", "\n22,"), r"tooth 22.*whole number up to 21"),
        (lambda text: text.replace("\n1,", "\n-1,"), r"tooth -1.*whole number"),
        (lambda text: text.replace(",1\n", ",1e300\n", 1), r"p\.csv.*1e300.*line 2, deviation.*check the unit"),
    ],
)
def test_what_no_tooth_can_be_measured_to_be_is_refused(tmp_path, change, said):
    """Two metres of deviation and tooth 9,999 of 21 were evaluated as if they had been measured."""
    roll = np.degrees(flank(scene_of(tmp_path, {"profile": "p.csv"}))[0])
    write(tmp_path / "p.csv", ("tooth", "roll_angle [deg]", "deviation [um]"), np.ones(400), roll, np.ones(400))
    measured_gear(scene_of(tmp_path, {"profile": "p.csv"}), "a")
    (tmp_path / "p.csv").write_text(change((tmp_path / "p.csv").read_text("utf-8")), "utf-8")
    with pytest.raises(InputError, match=said):
        measured_gear(scene_of(tmp_path, {"profile": "p.csv"}), "a")


def test_a_file_of_a_million_lines_is_refused_before_it_is_read_line_by_line(tmp_path):
    """Three million places took a minute and 1.4 GB until they were refused."""
    (tmp_path / "p.csv").write_text("roll_angle [deg],deviation [um]\n" + "x\n" * 1_000_000, "utf-8")
    with pytest.raises(InputError, match="has more than 400,000 lines; use every second point"):
        measured_gear(scene_of(tmp_path, {"profile": "p.csv"}), "a")


def test_a_long_trace_is_filtered_alike_wherever_it_is_taken_apart(monkeypatch):
    x = np.linspace(0.0, 20e-3, 700)
    trace = 1e-6 * np.sin(2.0 * np.pi * x / 0.8e-3) + 2e-6 * (x / 20e-3) ** 2
    whole = filtered(x, trace, 0.8e-3)
    for size in (7, 64, 701):
        monkeypatch.setattr("fegear.formulas.iso1328_traces._AT_ONCE", size)
        np.testing.assert_allclose(filtered(x, trace, 0.8e-3), whole, atol=1e-10)
    # Of a wave as long as the filter half is let through, inside the trace.
    inside = slice(100, 600)
    np.testing.assert_allclose(
        whole[inside], (0.5e-6 * np.sin(2.0 * np.pi * x / 0.8e-3) + 2e-6 * (x / 20e-3) ** 2)[inside], atol=2e-8
    )
