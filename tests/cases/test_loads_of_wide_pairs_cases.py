"""``transmission-error`` and ``load-sharing`` of pairs with a width: tables as in the plane, and their laws."""

from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
from solved_once import CACHE

from fegear.base.errors import InputError
from fegear.case.reading import read_scene
from fegear.contact.fourier import fourier_series, panels
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.load_factors import (
    even_along_the_lines,
    iso_face_load_factor,
    root_factors,
    straight_gap,
    transverse_load_factor,
)
from fegear.contact.wide.load_sharing import hat_averages
from fegear.contact.wide.pair_history import separation
from fegear.contact.wide.roll_points import roll_points
from fegear.contact.wide.root_stress import rooted_lines
from fegear.contact.wide.transmission_error import curve_through, flank_transmission_errors, from_half
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.fem.solid.slice_laws import missed_by_slices
from fegear.geometry.pair import MEMBERS
from fegear.results.catalogue import STAGES
from fegear.results.pair.iso_mesh_stiffness import said_beside_iso
from fegear.results.pair.transmission_error import TRANSMISSION_ERROR

CASE = Path(__file__).parents[2] / "cases" / "helical_load.toml"
COARSE = (
    "accuracy.tolerance=1e-1", "load_distribution.positions=13", "load_distribution.panels=8",
    'gear.pinion.face_width="8 mm"', 'gear.wheel.face_width="8 mm"', 'pair.I.loads=["900 N", "7200 N"]',
    'results=["load-distribution", "transmission-error", "load-sharing", "root-stress-history"]',
    'pair.I.speed="600 rpm"',
    'pair.I.width="slices"',
)  # fmt: skip


@pytest.fixture(scope="module")
def results():
    scene = read_scene(CASE, COARSE)
    return run_plan(scene, make_plan(scene, STAGES), cache=CACHE)


def columns(results, name):
    return {column.head: np.asarray(column.values) for column in results.tables[name].columns}


def test_the_flanks_are_loaded_once_for_all_results(results):
    tasks = [str(task) for task in results.outcomes]
    assert tasks.count("loaded-flanks of I") == 1
    assert "loaded-pair of I" not in tasks


def test_errors_of_slices_count_what_slices_are_known_to_miss(results):
    loaded = results.outcomes[Task("loaded-flanks", "I")].data
    assert loaded.missed == missed_by_slices(1.0)["contact"]
    assert any("coupled slices used instead of 3D gears" in remark for remark in results.remarks)
    for name in ("te_mean", "te_peak_to_peak", "mesh_stiffness_mean"):
        value = results.values[f"I.{name}"]
        assert value.error > loaded.missed * value.value
    factor, pressure = (results.values[f"I.{name}"] for name in ("K_Hbeta", "largest_hertz_pressure"))
    assert factor.error > loaded.missed * (factor.value - 1.0)
    assert pressure.error > 0.1 * pressure.value


def test_without_estimates_the_numbers_are_the_same_and_no_error_is_stated(results):
    """As while a value is moved in the window; peaks between roll positions and limits at rest are not looked for."""
    scene = replace(read_scene(CASE, COARSE), estimates=False)
    quick = run_plan(scene, make_plan(scene, STAGES), cache=CACHE)
    assert not quick.outcomes[Task("loaded-flanks", "I")].data.estimated
    estimated = [value for value in results.values if value.error and value.name.startswith("I.")]
    assert len(estimated) > 10
    for value in estimated:
        # slices know how far their root stress is off
        assert quick.values[value.name].error is None or "root_" in value.name, value.name
        off = value.error if value.name.endswith("peak_to_peak") else 1e-9 * abs(value.value)
        assert quick.values[value.name].value == pytest.approx(value.value, abs=off)
    for name, table in results.tables.items():
        for column in table.columns:
            if column.si.dtype.kind == "f" and not column.name.endswith(("_error", "peak_to_peak", "te_unloaded")):
                again = quick.tables[name].column(column.name).si
                np.testing.assert_allclose(again, column.si, rtol=1e-9, err_msg=f"{name}.{column.name}")


def test_all_results_tell_the_same(results):
    te, roll = columns(results, "transmission_error_I"), columns(results, "load_distribution_roll_I")
    np.testing.assert_allclose(te["te [um]"], roll["te [um]"], rtol=1e-12)
    np.testing.assert_allclose(te["local_stiffness [N/um]"], roll["mesh_stiffness [N/um]"], rtol=1e-12)
    followed = columns(results, "load_sharing_I")
    # one tooth pair over its path is all pairs over a base pitch
    assert followed["load [N]"].sum() == pytest.approx(13 * 3600.0, rel=1e-9)
    assert followed["share"].max() == pytest.approx(results.values["I.largest_share"].si)
    summary = columns(results, "transmission_error_summary_I")
    np.testing.assert_allclose(summary["te_mean [um]"], columns(results, "load_distribution_loads_I")["te_mean [um]"])
    assert len(columns(results, "load_sharing_loads_I")["load [N]"]) == 3 * len(followed["load [N]"])
    assert all(np.diff(followed["x [mm]"]) > 0.0)
    assert {"transmission_error_I", "transmission_error_harmonics_I", "load_sharing_I"} <= set(results.figures.keys())
    for name in ("te_mean", "te_peak_to_peak", "te_first_harmonic", "mesh_stiffness_mean"):
        assert results.values[f"I.{name}"].error > 0.0


def test_harmonics_and_means_are_those_of_the_curve(results):
    loaded = results.outcomes[Task("loaded-flanks", "I")].data
    points = loaded.flanks.points
    for te in flank_transmission_errors(loaded.found, points):
        assert te.mean == pytest.approx(np.sum(te.values * points.weights) / points.period, rel=1e-12)
        assert te.series.amplitude.size == 6
        assert 0.0 < te.series.amplitude[0] < te.peak_to_peak
    # a wave that the positions know comes back
    wave = np.cos(2.0 * np.pi * (points.x - points.x[0]) / points.period)
    between = panels(points.breaks[0], points.period, points.breaks[1:-1], waves=6)
    through = curve_through(points, wave, between.x)
    np.testing.assert_allclose(fourier_series(between, through, 3).amplitude, [1.0, 0.0, 0.0], atol=0.02)
    # too few for a polynomial on every piece: straight between them, which never overshoots
    few = roll_points(loaded.found.pair, 4)
    through = curve_through(
        few, np.array([1.0, -1.0, 1.0, -1.0]), few.breaks[0] + few.period * np.linspace(0.0, 1.0, 50)
    )
    assert np.abs(through).max() <= 1.0 + 1e-12
    # and half of them know what is straight on every piece
    np.testing.assert_allclose(from_half(points, 2.0 * points.x + 1.0), 2.0 * points.x + 1.0, rtol=1e-12)
    assert np.abs(from_half(points, wave) - wave).max() > 0.0


def test_secant_stiffness_is_load_over_transmission_error_of_perfect_flanks(results):
    loaded = results.outcomes[Task("loaded-flanks", "I")].data
    for load in (900.0, 7200.0):
        perfect = loaded.flanks.solve([load], None, loaded.known)
        (te,) = flank_transmission_errors(perfect, loaded.flanks.points)
        np.testing.assert_allclose(te.secant, load / te.values, rtol=1e-9)
        assert (te.local > te.secant).all()  # a Hertzian contact stiffens under its load
    # linear contacts have one stiffness
    wide = loaded.known.half_width(perfect.line_load)[:, :, 0].max()
    fixed = replace(loaded.known, fixed_half_width=np.full(loaded.known.lines.x.shape, wide))
    (te,) = flank_transmission_errors(loaded.flanks.solve([900.0], None, fixed), loaded.flanks.points)
    np.testing.assert_allclose(te.local, te.secant, rtol=1e-9)
    assert results.values["I.mesh_compliance_mean"].si > 0.0


def test_root_stress_over_the_face_and_its_largest_value_are_one(results):
    rate = 20.0 * np.pi * read_scene(CASE, COARSE).pairs["I"].driver.base_radius  # 600 rpm
    for gear, member in (("pinion", "driver"), ("wheel", "driven")):
        way = columns(results, f"root_stress_history_I_{gear}")
        face = columns(results, f"root_stress_over_face_I_{gear}")
        shape = len(way["x [mm]"]), -1
        over = face["stress [MPa]"].reshape(shape)
        np.testing.assert_allclose(way["stress [MPa]"], over.max(axis=1), rtol=1e-12)
        z = face["face_position [mm]"].reshape(shape)
        np.testing.assert_allclose(way["stress_face_position [mm]"], z[np.arange(len(z)), over.argmax(axis=1)])
        largest = results.values[f"I.{member}.largest_root_tension"]
        assert largest.si == pytest.approx(1e6 * over.max(), rel=1e-9)
        assert 0.0 < largest.error < largest.value
        assert (way["stress at 7200 N [MPa]"].max() > over.max() > way["stress at 900 N [MPa]"].max()).all()
        assert way["t [s]"][-1] == pytest.approx(np.ptp(way["x [mm]"]) * 1e-3 / rate, rel=1e-6)
        # slices know no shear along the face, and so nothing of the stress at right angles to the helix
        assert f"I.{member}.largest_root_tension_across" not in [one.name for one in results.values]
        # the gap opens toward +z, so the load and with it the stress are at -z
        assert way["stress_face_position [mm]"][over.max(axis=1).argmax()] < 0.0


@pytest.mark.long
def test_solid_helical_gears_tell_their_tension_across_the_root():
    scene = read_scene(CASE, [*COARSE, "pair.I.width=solid", 'results=["root-stress-history"]'])
    found = run_plan(scene, make_plan(scene, STAGES), cache=CACHE)
    for member in MEMBERS:
        largest, across = (found.values[f"I.{member}.largest_root_tension{end}"] for end in ("", "_across"))
        # of a helix of 15 degrees it is larger, by what the shear in the fillet adds
        assert largest.si < across.si < 1.08 * largest.si
        assert across.error / across.value == pytest.approx(largest.error / largest.value, rel=1e-6)
    assert sum("largest at right angles to the helix differs by +" in one for one in found.remarks) == 1


def test_load_factors(results):
    rows = columns(results, "load_factors_I")
    np.testing.assert_allclose(rows["K_Hbeta"], columns(results, "load_distribution_loads_I")["K_Hbeta"])
    # less and less as the load closes the gap, by ISO 6336-1 as well
    assert (np.diff(rows["K_Hbeta"]) < 0.0).all()
    assert (np.diff(rows["K_Hbeta_iso"]) < 0.0).all()
    assert (rows["K_Fbeta_iso"] < rows["K_Hbeta"]).all()
    for member in MEMBERS:
        assert 1.0 < results.values[f"I.{member}.K_Fbeta"].si < rows["K_Hbeta"][1]
    data = results.outcomes[Task("flank-load-factors", "I")].data
    root = results.outcomes[Task("root-stress-history", "I")].data.found
    # across the root and away from the ends of the face: near the stress along the section there, off by
    # sin(15 deg)^2 and the shear
    over = root.over_face["driver"]["tension"]
    inside = np.abs(over.z) <= over.z[-1] - 0.5 * data.loaded.found.pair.driver.module
    along = over.value[:, inside].max()
    assert data.root["driver"].largest == pytest.approx(along, rel=np.sin(np.radians(15.0)) ** 2)
    assert data.root["driver"].largest != pytest.approx(along, rel=1e-4)
    # 10 um over the face, straight; crowning has no straight part
    assert data.gap == pytest.approx(10e-6, rel=1e-9)
    pair = data.loaded.found.pair
    z = np.linspace(-4e-3, 4e-3, 801)
    assert straight_gap(pair, FlankGaps(face_position=z, line_gap=8e-6 * (z / 4e-3) ** 2)) == pytest.approx(
        0.0, abs=1e-9
    )


def test_factors_are_one_where_nothing_is_uneven(results):
    loaded = results.outcomes[Task("loaded-flanks", "I")].data
    perfect = loaded.flanks.solve([3600.0], None, loaded.known)
    np.testing.assert_array_equal(transverse_load_factor(perfect, perfect), 1.0)
    even = even_along_the_lines(perfect.lines, perfect.contact.force[:, :, 0])
    for p in range(perfect.lines.roll.size):
        for s in perfect.lines.at(p):
            assert even[p, s].sum() == pytest.approx(perfect.contact.force[p, s, 0].sum(), rel=1e-12)
            line_load = even[p, s] / perfect.lines.support[p, s]
            np.testing.assert_allclose(line_load, line_load[0], rtol=1e-12)
    spread = replace(perfect, contact=replace(perfect.contact, force=even[:, :, None]))
    rooted = rooted_lines(perfect.pair, "driver", perfect.lines, loaded.flanks.gears["driver"], coupling=True)
    factors = root_factors(spread, perfect, rooted, np.linspace(-4e-3, 4e-3, 9), 0)
    assert (factors.face, factors.transverse) == pytest.approx((1.0, 1.0), rel=1e-12)
    assert iso_face_load_factor(perfect.pair, FlankGaps(), 3600.0) == 1.0


def test_no_last_digit_tells_whether_a_place_near_an_end_of_the_face_counts(results):
    loaded = results.outcomes[Task("loaded-flanks", "I")].data
    found, perfect = loaded.found, loaded.flanks.solve([3600.0], None, loaded.known)
    rooted = rooted_lines(found.pair, "driver", found.lines, loaded.flanks.gears["driver"], coupling=True)
    end = found.lines.high - 0.5 * found.pair.driver.module
    some = [
        root_factors(found, perfect, rooted, np.array([-end, 0.0, end]) * (1.0 + noise), 0).face
        for noise in (-1e-13, 0.0, 1e-13)
    ]
    np.testing.assert_allclose(some, some[0], rtol=1e-9)


def test_the_contact_pattern_grows_with_load_and_coat_and_is_the_gap_of_rigid_flanks_without_load(results):
    rows = columns(results, "contact_pattern_I")
    np.testing.assert_allclose(rows["load [N]"], [36.0, 900.0, 3600.0, 7200.0])
    assert (np.diff(rows["printed_share"]) >= 0.0).all()
    assert 0.0 < rows["printed_share"][0] < 0.8
    assert (rows["z_first [mm]"] == -4.0).all()  # the gap opens toward +z
    pattern = results.outcomes[Task("contact-pattern", "I")].data.pattern
    assert (pattern.printed_share(12e-6) >= pattern.printed_share(6e-6)).all()
    assert (pattern.printed(1e-12) == (pattern.separation < 1e-12)).all()
    loaded = results.outcomes[Task("loaded-flanks", "I")].data
    found, gap = loaded.found, loaded.gaps.at(loaded.found.pair, loaded.found.lines)
    apart = separation(found, gap)
    assert (apart[found.contact.force > 0.0] == 0.0).all()
    assert (apart >= 0.0).all()
    # hardly loaded, the flanks stand apart by what the gap is more than at the place that is nearest
    lines = found.lines
    light = loaded.flanks.solve([0.01], loaded.gaps, loaded.known)
    averaged = hat_averages(lines, gap)
    rigid = averaged - np.where(lines.present, averaged, np.inf).min(axis=1, keepdims=True)
    np.testing.assert_allclose(
        separation(light, gap)[:, :, 0][lines.present], rigid[lines.present], atol=1e-9
    )  # 0.01 N deflects a pair of 150 N/um by far less than a nanometre


def test_maps_reach_the_tips(results):
    found = results.outcomes[Task("loaded-flanks", "I")].data.found
    x = np.linspace(found.pair.x_start, found.pair.x_end, 31)
    z = np.linspace(found.lines.low, found.lines.high, 11)
    assert np.isfinite(found.over_plane(x, z, 1)).all()
    # what is linear over the plane of action comes back
    line = found.spread(x, z, 2.0 * found.lines.x - 3.0 * found.lines.z)
    # but in the corners, where lines are too short to be divided
    wanted = 2.0 * x - 3.0 * z[:, None]
    np.testing.assert_allclose(line[1:-1], wanted[1:-1], atol=1e-6 * found.pair.base_pitch)


def test_the_transmission_error_says_what_spacing_errors_leave_open(results):
    data = results.outcomes[Task("transmission-error", "I")].data
    inputs = TRANSMISSION_ERROR.inputs(results.scene, "I")
    assert not any("rotational" in remark.lower() for remark in TRANSMISSION_ERROR.present(data, inputs).remarks)
    loaded = results.outcomes[Task("loaded-flanks", "I")].data
    assert loaded.transmission_error(lambda _share: None).only is None
    uneven = replace(loaded, gaps=replace(loaded.gaps, driver_spacing=np.array([0.0, 1e-6])))
    found = uneven.transmission_error(lambda _share: None)
    assert found.only == 0
    said = TRANSMISSION_ERROR.present(replace(data, found=found), inputs).remarks
    (told,) = (remark for remark in said if "rotational" in remark.lower())
    assert "base pitch 0" in told


def test_what_has_no_meaning_over_the_face_is_refused():
    with pytest.raises(InputError, match=r"transmission_error\.method.*for the plane \(2D\) model; pair I is 3D"):
        make_plan(read_scene(CASE, [*COARSE, 'transmission_error.method="mark-series"']), STAGES)


def test_a_spur_pair_takes_its_width_from_its_key():
    straight = [f"gear.{gear}.{key}" for gear in ("pinion", "wheel") for key in ('helix_angle="0 deg"', 'hand="spur"')]
    asked = [*COARSE[:-1], *straight, 'results=["transmission-error", "load-sharing"]', "effects.misalignment=false"]
    plane = {str(step.task) for step in make_plan(read_scene(CASE, asked), STAGES).steps}
    wide = {str(step.task) for step in make_plan(read_scene(CASE, [*asked, 'pair.I.width="solid"']), STAGES).steps}
    assert {"transmission-error of I", "load-sharing of I"} <= plane
    assert {"transmission-error of I", "load-sharing of I", "loaded-flanks of I"} <= wide
    assert not any("flank" in task for task in plane)
    assert "loaded-pair of I" not in wide


def test_the_mean_stiffness_stands_beside_c_gamma_of_iso(results):
    """c' (0.75 eps_alpha + 0.25) with q' of ISO 6336-1, Eq. 86, virtual teeth z / cos^3 beta."""
    values = {one.name: one for one in results.values}
    e = results.outcomes[Task("transmission-error", "I")].data.found
    fe, iso, ratio = (values[f"I.c_gamma_{key}"] for key in ("fe", "iso", "iso_to_fe"))
    assert fe.value * 8.0 == pytest.approx(values["I.mesh_stiffness_mean"].value, rel=1e-9)
    assert fe.error / fe.value == pytest.approx(values["I.mesh_stiffness_mean"].error * 8.0 / fe.value / 64.0, rel=1e-9)
    assert ratio.value == pytest.approx(iso.value / fe.value, rel=1e-12)
    assert ratio.error / ratio.value == pytest.approx(fe.error / fe.value, rel=1e-9)
    beta, (one, two) = e.pair.driver.helix_angle, (e.pair.driver, e.pair.driven)
    z1, z2 = (gear.teeth / np.cos(beta) ** 3 for gear in (one, two))
    x1, x2 = one.tooth.profile_shift, two.tooth.profile_shift
    q = (
        0.04723 + 0.15551 / z1 + 0.25791 / z2 - 0.00635 * x1 - 0.11654 * x1 / z1 - 0.00193 * x2 - 0.24188 * x2 / z2
        + 0.00529 * x1**2 + 0.00182 * x2**2
    )  # fmt: skip
    rack = np.mean([1.0 + 0.5 * (1.2 - gear.symmetric_tooth.dedendum) for gear in (one, two)])
    elastic = 2.0 / (206e9 / one.material.young_modulus + 206e9 / two.material.young_modulus)
    single = 0.8 / q * rack * np.cos(beta) * elastic * min(e.pair.specific_load(e.load) / 1e5, 1.0) ** 0.25
    assert iso.value == pytest.approx(single * (0.75 * e.pair.contact_ratio + 0.25), rel=1e-2)
    seen = SimpleNamespace(name="I", data=results.outcomes[Task("transmission-error", "I")].data)
    assert said_beside_iso(seen)[0].endswith(f"(secant): ratio {ratio.value:.2f}.")
