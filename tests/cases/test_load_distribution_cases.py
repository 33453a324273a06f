"""``load-distribution``: from a case to line load, K_Hbeta, shares and pictures, and what it refuses."""

import math
import pickle
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.built.pair_spec import pair_spec
from fegear.case.built.solid_influence import solid_gear_to_solve
from fegear.case.reading import read_scene
from fegear.contact.wide.flanks import open_gaps
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.lines import contact_lines
from fegear.engine.figure.figure import Figure
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.output.draw_png import draw_pictures
from fegear.results.catalogue import STAGES
from fegear.results.pair.loaded_flanks import LOADED_FLANKS

CASE = Path(__file__).parents[2] / "cases" / "helical_load.toml"
COARSE = (
    "accuracy.tolerance=1e-1", "load_distribution.positions=4", "load_distribution.panels=8",
    'gear.pinion.face_width="8 mm"', 'gear.wheel.face_width="8 mm"',
)  # fmt: skip


@pytest.fixture(scope="module")
def cache():
    return SolutionCache()


def ran(cache, *overrides):
    scene = read_scene(CASE, [*COARSE, *overrides])
    return run_plan(scene, make_plan(scene, STAGES), cache=cache).outcomes[Task("load-distribution", "I")]


def neglected(outcome, *overrides):
    """What the stage before says of the effects that are off."""
    inputs = LOADED_FLANKS.inputs(read_scene(CASE, [*COARSE, "accuracy.tolerance=1e-3", *overrides]), "I")
    return LOADED_FLANKS.present(outcome.data, inputs).remarks


@pytest.fixture(scope="module")
def outcome(cache):
    return ran(cache)


def columns(outcome, name):
    (table,) = (table for table in outcome.tables if table.name == name)
    return {column.head: np.asarray(column.values) for column in table.columns}


def value(outcome, name):
    (found,) = (one for one in outcome.values if one.name == f"I.{name}")
    return found


def test_tables_sum_to_the_load(outcome):
    face = columns(outcome, "load_over_face_I")
    width = np.diff(face["z [mm]"])[0]
    assert face["mean_line_load [N/mm]"].sum() * width == pytest.approx(3600.0, rel=1e-9)
    assert face["factor"].max() == pytest.approx(value(outcome, "K_Hbeta").si, rel=1e-12)
    roll = columns(outcome, "load_distribution_roll_I")
    shares = sum(v for k, v in roll.items() if k.startswith("share_") and not k.endswith("error"))
    np.testing.assert_allclose(shares, 1.0, rtol=1e-9)
    places = columns(outcome, "load_distribution_I")
    loaded = places["line_load [N/mm]"] > 0.0
    np.testing.assert_array_equal(places["active"] == 1.0, loaded)
    # Hertz: p = 2 f / (pi b)
    f, b = places["line_load [N/mm]"][loaded], places["half_width [um]"][loaded] * 1e-3
    np.testing.assert_allclose(places["hertz_pressure [MPa]"][loaded], 2.0 * f / (np.pi * b), rtol=1e-9)


@pytest.mark.dear
def test_the_load_goes_to_the_end_without_a_gap_and_crowning_takes_it_from_there(cache, outcome):
    face = columns(outcome, "load_over_face_I")["factor"]
    assert face[0] > 1.1 > 0.9 > face[-1]
    other = ran(cache, 'pair.I.line_error.over_face="-10 um"')
    assert columns(other, "load_over_face_I")["factor"][-1] > 1.1
    crowned = ran(cache, 'pair.I.line_error={over_face="10 um", crowning="8 um"}')
    assert columns(crowned, "load_over_face_I")["factor"][0] < face[0]
    even = ran(cache, "effects.misalignment=false")
    assert value(even, "K_Hbeta").si < value(outcome, "K_Hbeta").si
    (said,) = (r for r in neglected(even, "effects.misalignment=false") if "misalignment is off" in r)
    grown = value(outcome, "te_mean").si - value(even, "te_mean").si
    assert f"the mean transmission error by {grown * 1e6:+.3g} um" in said
    assert "Set misalignment = true under [effects]" in said
    (change, _) = even.data.neglected.changes["misalignment"]
    assert change.size == pytest.approx(grown, rel=1e-6)


def test_loaded_flanks_travel_between_processes(outcome):
    there = pickle.loads(pickle.dumps(outcome.data))  # noqa: S301  (our own)
    np.testing.assert_array_equal(there.found.transmission_error, outcome.data.found.transmission_error)
    assert repr(there.neglected) == repr(outcome.data.neglected)  # NaN equals no other NaN


def test_a_table_over_the_face_is_the_same_as_its_key(cache, outcome, tmp_path):
    table = tmp_path / "gap.csv"
    table.write_text("z [mm],gap [um]\n-4,0\n4,10\n", "utf-8")
    found = ran(cache, f'pair.I.line_error={{file="{table.as_posix()}"}}')
    assert value(found, "K_Hbeta").si == pytest.approx(value(outcome, "K_Hbeta").si, rel=1e-9)


def gaps(*overrides):
    """What the case says of the gaps on a few contact lines, without its profile relief; the pair; what it knows."""
    asked = pair_spec(read_scene(CASE, [*COARSE, *overrides]), "I")
    pair = asked.placed
    lines = contact_lines(pair, pair.x_start + pair.base_pitch * np.array([0.2, 0.7]), 1e-3)
    plain = open_gaps(replace(asked, relief=True, misalignment=False))
    found = open_gaps(replace(asked, relief=True))
    bare = FlankGaps(plain.driver_relief, plain.driven_relief)
    return (found.at(pair, lines) - bare.at(pair, lines))[lines.present], lines, asked


def test_lead_modifications_of_either_gear_count_as_line_errors_do(tmp_path):
    """One formula, four ways to write it: per pair, per gear, as a table over the face, on a grid."""
    lead = tmp_path / "lead.csv"
    lead.write_text("z [mm],removal [um]\n-4,0\n4,10\n", "utf-8")
    grid = tmp_path / "grid.csv"
    rows = [f"{r},{z},{1.25 * (z + 4)}" for r in (5, 60) for z in (-4, 4)]
    grid.write_text("\n".join(["roll_angle [deg],z [mm],removal [um]", *rows]), "utf-8")
    wanted, lines, _ = gaps()
    np.testing.assert_allclose(wanted, 1.25e-3 * (lines.z[lines.present] + 4e-3), atol=1e-18)
    end = '{amount="4 um", length="8 mm", end="II"}'
    own = (
        'gear.pinion.lead={slope="10 um"}',
        f'gear.wheel.lead={{slope="6 um", end_relief={end}}}',
        f'gear.pinion.lead={{file="{lead.as_posix()}"}}',
        f'gear.wheel.topography={{file="{grid.as_posix()}"}}',
    )
    for key in own:
        np.testing.assert_allclose(gaps(key, "effects.misalignment=false")[0], wanted, atol=1e-18, err_msg=key)
    twisted = gaps('gear.pinion.bias="10 um"', "effects.misalignment=false")[0]
    assert 2e-6 < np.abs(twisted).max() <= 2.5e-6 * (1.0 + 1e-9)
    assert gaps(own[0])[2].has_data("relief")


def test_shafts_count_by_the_part_of_them_in_the_plane_of_action():
    """Sine and cosine of alpha_wt, 1/cos(beta_b)^2 along a contact line; over any length, or as an angle."""
    _, lines, asked = gaps()
    pair, straight = asked.pair, 'pair.I.line_error={over_face="0 um"}'
    share = {"in_plane": math.sin(pair.working_pressure_angle), "out_of_plane": math.cos(pair.working_pressure_angle)}
    keys = [f'{{{member}={{{key}="{20.0 / part:.15g} um", over="16 mm"}}}}'
            for key, part in share.items() for member in ("driver", "driven")]  # fmt: skip
    keys.append(f'{{shaft_angle="{1.25e-3 / share["out_of_plane"]:.15g} rad"}}')
    for key in keys:
        found = gaps(straight, f"pair.I.misalignment={key}")[0]
        for j in np.unique(lines.pair[lines.present]):
            for p in range(2):
                on = (lines.pair[p] == j) & lines.present[p]
                at = np.split(found, np.cumsum(lines.present.sum(axis=1))[:-1])[p][on[lines.present[p]]]
                slope = np.diff(at) / np.diff(lines.z[p, on])
                np.testing.assert_allclose(slope, 1.25e-3 / math.cos(pair.driver.base_helix_angle) ** 2, rtol=1e-6)


def test_the_pinion_s_cutting_counts_along_the_line_of_action():
    """TM-107451's keys: a lead angle turns the flank, a crown counts along the normal, a parabola up it."""
    none = 'pair.I.line_error={over_face="0 um"}'
    _, lines, asked = gaps(none)
    z, lean = lines.z[lines.present], asked.pair.driver.base_helix_angle
    found, _, _ = gaps(none, 'pair.I.misalignment={lead_angle="1 arcmin"}')
    assert np.polyfit(z, found, 1)[0] == pytest.approx(-math.radians(1.0 / 60.0), rel=0.02)
    by_lead, _, _ = gaps(none, 'pair.I.misalignment={lead="0.1 mm"}')
    assert np.polyfit(z, by_lead, 1)[0] < 0.0  # a longer lead is a smaller helix angle
    found, _, _ = gaps(none, 'pair.I.modification={crown="5 um"}')
    np.testing.assert_allclose(found, 5e-6 / math.cos(lean) * (z / 4e-3) ** 2, atol=1e-10)
    found, _, _ = gaps(none, 'pair.I.modification={parabola="1 / m"}')
    # a_c s^2 along the cutter's normal, s along its profile from the pitch line
    s = lines.x[lines.present] * math.cos(lean) / math.tan(asked.pair.driver.normal_pressure_angle)
    assert np.corrcoef(found, s**2)[0, 1] > 0.99
    assert found.min() > -1e-9
    absorbed, _, _ = gaps(none, 'pair.I.modification={parabola="1 / m", absorb=true}',
                          'pair.I.misalignment={shaft_angle="1 arcmin"}', "effects.misalignment=true")  # fmt: skip
    assert np.isfinite(absorbed).all()
    pair = gaps(none, 'pair.I.misalignment={centre_distance="0.1 mm"}')[2].misaligned
    assert pair.centre_distance - asked.pair.centre_distance == pytest.approx(1e-4)
    assert pair.contact_ratio < asked.pair.contact_ratio


def test_left_out_coupling_is_told_with_its_size(cache, outcome):
    off = "effects.neighbour_coupling=false", 'effects.hertz="none"'
    found = ran(cache, *off)
    assert value(found, "te_mean").si < value(outcome, "te_mean").si
    assert any("neighbour_coupling is off" in remark for remark in neglected(found, *off))
    assert any("hertz is off" in remark for remark in neglected(found, *off))


def test_every_load_of_the_case_has_its_row(cache, outcome):
    found = ran(cache, 'pair.I.loads=["900 N", "7200 N"]')
    rows = columns(found, "load_distribution_loads_I")
    np.testing.assert_allclose(rows["load [N]"], [900.0, 3600.0, 7200.0])
    assert np.all(np.diff(rows["te_mean [um]"]) > 0.0)
    assert np.all(np.diff(rows["K_Hbeta"]) < 0.0)  # what keeps the flanks apart matters less under more load
    assert rows["te_mean [um]"][1] == pytest.approx(value(outcome, "te_mean").si * 1e6, rel=1e-6)


def test_the_pictures_are_drawn(outcome, tmp_path):
    flat = [figure for figure in outcome.figures if isinstance(figure, Figure)]
    for figure in flat:
        list(draw_pictures(figure, tmp_path))
    assert {path.name for path in tmp_path.rglob("*.png")} == {"load_distribution_I.png", "load_over_face_I.png"}


def test_pressure_stands_on_the_loaded_flanks_of_both_teeth(outcome):
    found = outcome.data.over.found
    (deferred,) = (figure for figure in outcome.figures if not isinstance(figure, Figure))
    (skin,) = deferred.made().panels[0].items
    values, points = np.asarray(skin.values), np.asarray(skin.points)
    on = np.isfinite(values)
    radius = np.hypot(*points[:2, on]) * 1e-3
    reach = found.pair.radius(np.array([found.pair.x_start, found.pair.x_end]), "driver")
    assert radius.min() >= reach.min() * (1.0 - 1e-6)
    assert radius.max() <= reach.max() * (1.0 + 1e-6)
    assert np.nanmax(values) <= found.pressure.max() * 1e-6 * (1.0 + 1e-9)
    assert 0.5 * found.pressure.max() * 1e-6 < np.nanmax(values)
    half = points[2] > 0.0  # driver
    assert on[half].any()
    assert on[~half].any()
    assert skin.triangles.max() == points.shape[1] - 1


@pytest.mark.parametrize(
    ("override", "word"),
    [
        ('pair.I.axial_offset="8 mm"', "axial_offset = 8 mm: leaves no common face width"),
        ("pair.I.line_error={}", "line_error"),
        ('pair.I.line_error={file="nowhere.csv"}', "nowhere.csv"),
        ("load_distribution.positions=1", "positions"),
        ('load_distribution.coat="0 um"', "coat"),
        ('pair.I.width="plane"', "is not available for helical gears"),
        ('pair.I.width="thick"', "width"),
        ('pair.I.compliance={source="cornell"}', "pair.I.compliance"),
        ('pair.I.root_stress={source="heywood"}', "root_stress.source"),
        ("gear.wheel.lead={}", "lead"),
        ("effects.spacing_errors=true", "effects.spacing_errors.*no gear of this case has spacing_errors"),
        ('pair.I.misalignment={driven={in_plane="10 mm"}}', "pair.I.misalignment.driven.in_plane.*is not small"),
        ('gear.wheel.lead={crowning="5 mm"}', "gear.wheel.*check the unit"),
        ('gear.wheel.bias={amount="5 um", start_radius="10 mm"}', "gear.wheel.bias.*base circle"),
        ('gear.wheel.lead={end_relief={amount="5 um", length="9 mm"}}', r"wheel.lead.end_relief\[0\].length"),
        ('gear.wheel.topography={file="nowhere.csv"}', "nowhere.csv"),
    ],
)
def test_what_cannot_be_computed_is_refused(override, word):
    with pytest.raises(InputError, match=word):
        make_plan(read_scene(CASE, [*COARSE, override]), STAGES)


def test_the_width_of_a_spur_pair_is_plane_unless_it_is_named_or_asked_for():
    straight = [f"gear.{gear}.{key}" for gear in ("pinion", "wheel") for key in ('helix_angle="0 deg"', 'hand="spur"')]
    scene = read_scene(CASE, straight)
    assert scene.width_of("I") == "plane"
    assert set(scene.plane_pairs) == {"I"}
    assert not scene.wide_pairs
    steps = {str(step.task) for step in make_plan(scene, STAGES).steps}
    assert "loaded-flanks of I" in steps  # the result is over the face
    with pytest.raises(InputError, match="contradicts results"):
        make_plan(read_scene(CASE, [*straight, 'pair.I.width="plane"']), STAGES)
    wide = read_scene(CASE, [*straight, 'pair.I.width="slices"'])
    assert wide.width_of("I") == "slices"
    assert set(wide.wide_pairs) == {"I"}
    assert solid_gear_to_solve(wide, "pinion").settings.source == "slices"
    assert solid_gear_to_solve(scene, "pinion").settings.source == "solid"


def test_one_gear_is_not_solved_as_a_solid_and_in_slices():
    both = ['results=["load-distribution", "stiffness"]', "stiffness.face_positions=3", 'stiffness.gear="pinion"']
    with pytest.raises(InputError, match=r"stiffness.source.*contradicts pair.I.width"):
        make_plan(read_scene(CASE, [*both, 'stiffness.source="slices"']), STAGES)
    scene = read_scene(CASE, [*both, 'stiffness.source="slices"', 'pair.I.width="slices"'])
    assert solid_gear_to_solve(scene, "pinion").settings.source == "slices"
    assert make_plan(scene, STAGES).steps


@pytest.mark.dear
def test_pressures_beside_stations_that_a_line_lacks_raise_no_warning(cache):
    """With corner contact a line has fewer stations than another: infinity less infinity was computed for the rest."""
    path = CASE.with_name("nasa_relief_design.toml")
    few = ("accuracy.tolerance=0.3", "load_distribution.positions=3", "load_distribution.panels=4")
    scene = read_scene(path, ['results=["load-distribution"]', "pair.I.width='slices'", *few])
    outcome = run_plan(scene, make_plan(scene, STAGES), cache=cache).outcomes[Task("load-distribution", "I")]
    assert all(np.isfinite(value.si) for value in outcome.values)
