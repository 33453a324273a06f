"""What results are asked for and by what they are found in cases that are rare; limits of refusals from both sides."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.engine.stage import Task
from fegear.exchange.rexs import catalogue_bearings
from fegear.output import fmu, run_folder
from fegear.output.progress_bar import watcher
from fegear.output.sweep import sweep_table
from fegear.results.gear import crosscheck
from fegear.results.helical import pair_forced_response
from fegear.results.pair import flank_surface_sheet, followed_gauge, gauge, odd_pair, tooth_friction
from fegear.results.rack import rack_stroke, solid_rack
from fegear.results.sizing import applied_variant, by_fe
from fegear.results.train import dynamic_factor, dynamic_root_stress, torque_ripple
from fegear.studies.sweep import Axis, Point, SweepResults
from fegear.verify import calculix
from fegear.workbench.mesh_curve import _OverRevolution


# ---- refusals at their limits ----------------------------------------------------------------------------------------
@pytest.mark.parametrize(("own", "refused"), [(0.2, False), (0.20099, False), (0.19901, False), (-0.20099, False),
                                              (0.20101, True), (0.19899, True), (-0.19899, True)])  # fmt: skip
def test_a_pair_that_shakes_a_mesh_has_its_helix_to_a_thousandth_of_a_radian(monkeypatch, own, refused):
    error = SimpleNamespace(pair="I", shuttling=False, harmonics=None)
    monkeypatch.setattr(pair_forced_response, "_excitation", lambda *_: SimpleNamespace(transmission_error=error))
    monkeypatch.setattr(pair_forced_response, "_source", lambda *_: "transmission-error")
    mesh = SimpleNamespace(pair=None, base_helix_angle=own)
    pair = SimpleNamespace(driver=SimpleNamespace(base_helix_angle=0.2))
    scene = SimpleNamespace(case=SimpleNamespace(transmissibility={"t": SimpleNamespace(mesh=mesh)}), pairs={"I": pair})
    if refused:
        with pytest.raises(InputError, match="contradicts pair I"):
            pair_forced_response._check(scene, "t")
    else:
        pair_forced_response._check(scene, "t")


@pytest.mark.parametrize(("source", "harmonics", "positions", "least"), [
    ("tooth-contact", None, 31, 32), ("tooth-contact", None, 32, None), ("tooth-contact", 3, 11, 12),
    ("loaded-flanks", 5, 19, 20), ("loaded-flanks", 5, 20, None), ("loaded-flanks", None, 1, None),
])  # fmt: skip
def test_harmonics_of_a_helical_pair_need_four_positions_each(monkeypatch, source, harmonics, positions, least):
    error = SimpleNamespace(pair="I", shuttling=False, harmonics=harmonics)
    monkeypatch.setattr(pair_forced_response, "_excitation", lambda *_: SimpleNamespace(transmission_error=error))
    monkeypatch.setattr(pair_forced_response, "_source", lambda *_: source)
    own = SimpleNamespace(mesh=SimpleNamespace(pair="I"))
    sizes = {name: SimpleNamespace(positions=0 if name not in source.replace("-", "_") else positions)
             for name in ("tooth_contact", "load_distribution")}  # fmt: skip
    sizes["load_distribution" if source == "loaded-flanks" else "tooth_contact"].positions = positions
    scene = SimpleNamespace(case=SimpleNamespace(transmissibility={"t": own}, **sizes),
                            pairs={"I": SimpleNamespace(driver=SimpleNamespace(base_helix_angle=0.2))})  # fmt: skip
    if least is None:
        pair_forced_response._check(scene, "t")
    else:
        with pytest.raises(InputError, match=f"set at least {least} positions"):
            pair_forced_response._check(scene, "t")
    error.shuttling = True
    if source == "tooth-contact":
        with pytest.raises(InputError, match="requires the mesh of the loaded flanks"):
            pair_forced_response._check(scene, "t")


# ---- trains ----------------------------------------------------------------------------------------------------------
def test_a_mesh_that_carries_nothing_has_no_friction_and_no_factor(monkeypatch):
    data = SimpleNamespace(train=SimpleNamespace(mesh_index=lambda _: 1), meshes=["first", SimpleNamespace(pair="p")],
                           speed_of="a", speed_ratio=0.5, ripple=())  # fmt: skip
    asked = []
    for module in (tooth_friction, dynamic_factor):
        monkeypatch.setattr(module, "gear_train", lambda _: data)
        monkeypatch.setattr(module, "carries_nothing", lambda _data, i: asked.append(i) or True)
    law = SimpleNamespace(of=lambda pair: None)
    given = SimpleNamespace(mesh="II", law=law, speeds=np.array([3.0, 5.0]), stated=5.0)
    found = tooth_friction._compute(given, {}, None)
    assert (found.found, found.stated) == ((), 5.0)
    factor = dynamic_factor._compute(SimpleNamespace(mesh="II", motion=SimpleNamespace(speeds=np.ones(2))), {}, None)
    assert factor.chart is None
    assert asked == [1, 1]


def test_charts_in_time_are_those_of_the_motion_with_and_without_ripple(monkeypatch):
    charts = []

    class Charted:
        @staticmethod
        def of(speeds, states, i, force):
            charts.append((speeds.tolist(), states, i, force))
            return SimpleNamespace(speeds=speeds, of=states, growing=np.ones(2, dtype=bool), worst=(1.2, 20.0))

    train = SimpleNamespace(mesh_index=lambda _: 1)
    data = SimpleNamespace(train=train, forces=[3.0, 7.0], speed_ratio=0.5, speed_of="a")
    monkeypatch.setattr("fegear.dynamics.train.charts.SpeedChart", Charted)
    monkeypatch.setattr(dynamic_factor, "gear_train", lambda _: data)
    monkeypatch.setattr(dynamic_factor, "carries_nothing", lambda *_: False)
    monkeypatch.setattr("fegear.dynamics.train.mesh_resonance.mesh_resonance", lambda *given: given)
    monkeypatch.setattr(dynamic_factor, "replace", lambda one, **more: SimpleNamespace(**vars(one) | more))
    motion = SimpleNamespace(speeds=np.array([10.0, 20.0]), in_time=True)
    for still in ("still", None):
        upstream = {Task("motion"): SimpleNamespace(states="states", still=still)}
        found = dynamic_factor._compute(SimpleNamespace(mesh="II", motion=motion), upstream, None)
        assert found.resonance == (data, 1, 20.0)  # nearest to the speed of the maximum
        assert found.chart.of == "states"
        assert found.chart.speeds.tolist() == [10.0, 20.0]  # of the named body again
        assert (None if found.still is None else found.still.of) == still
    assert charts[:2] == [([20.0, 40.0], "states", 1, 7.0), ([20.0, 40.0], "still", 1, 7.0)]
    assert len(charts) == 3


def test_a_train_without_ripple_has_no_response_to_it(monkeypatch):
    monkeypatch.setattr(torque_ripple, "gear_train", lambda _: SimpleNamespace(ripple=()))
    found = torque_ripple._compute(SimpleNamespace(frequencies=np.array([1.0, 2.0])), {}, None)
    assert found.responses == {}
    assert found.lines is None


def test_wide_pairs_cost_more_than_plane_ones(monkeypatch):
    scene = SimpleNamespace(wide_pairs={"I"}, case=SimpleNamespace(effects=SimpleNamespace(neighbour_coupling=True)))
    part = SimpleNamespace(pair_of=lambda mesh: {"m": "I", "n": "II"}[mesh])
    monkeypatch.setattr(dynamic_root_stress, "train_part", lambda _: part)
    monkeypatch.setattr(dynamic_root_stress, "stress_sources", lambda *_: ("fe",))
    wide, plane = (dynamic_root_stress._forecast(scene, mesh).seconds for mesh in "mn")
    assert wide > plane
    monkeypatch.setattr(gauge, "gauge_of", lambda _, name: SimpleNamespace(pair=part.pair_of(name)))
    monkeypatch.setattr(gauge.forecasts, "loads", lambda *_: 3)
    monkeypatch.setattr(gauge.forecasts, "engagements", lambda *_: 1.0)
    assert gauge._forecast(scene, "m").seconds > gauge._forecast(scene, "n").seconds
    three = gauge._forecast(scene, "m").seconds
    monkeypatch.setattr(gauge.forecasts, "loads", lambda *_: 6)
    assert gauge._forecast(scene, "m").seconds == pytest.approx(2.0 * three)


@pytest.mark.parametrize("wide", [True, False])
def test_a_rack_s_stroke_costs_by_its_teeth_and_positions(monkeypatch, wide):
    def seconds(teeth, positions):
        asked = SimpleNamespace(pair=SimpleNamespace(rack=SimpleNamespace(teeth=teeth)), wide=wide, positions=positions)
        monkeypatch.setattr(rack_stroke, "rack_inputs", lambda *_: asked)
        return rack_stroke._forecast(None, "r").seconds

    assert seconds(3, 40) - seconds(3, 20) == pytest.approx(seconds(3, 60) - seconds(3, 40))
    assert seconds(3, 40) > seconds(2, 40)
    assert seconds(500, 40) == seconds(400, 40)  # teeth in the middle of a long rack are alike
    if wide:
        assert seconds(3, 40) == pytest.approx(2.0 * seconds(3, 20))


# ---- what is asked for -----------------------------------------------------------------------------------------------
def test_subjects_are_those_of_the_kind(monkeypatch):
    monkeypatch.setattr(odd_pair, "plane_pairs", lambda _: ("I", "II", "III"))
    monkeypatch.setattr(odd_pair, "odd_gears_of", lambda _, name: {"II": ("a",)}.get(name, ()))
    assert odd_pair._pairs(None) == ("II",)
    monkeypatch.setattr(solid_rack, "racks", lambda _: ("r", "s"))
    monkeypatch.setattr(solid_rack, "is_wide_rack", lambda _, name: name == "s")
    assert solid_rack.wide_racks(None) == ("s",)


@pytest.mark.parametrize("neglected", [True, False])
def test_a_gauge_on_a_3d_tooth_is_followed_where_it_sits(monkeypatch, neglected):
    asked = {}
    place = SimpleNamespace(middle="middle", displacement="places", clearance=lambda *given: given)
    pair = SimpleNamespace(gear=lambda member: f"gear {member}")
    flank = SimpleNamespace(fine=SimpleNamespace(flank="flank"))
    monkeypatch.setattr(followed_gauge, "solid_solution_of", lambda _, gear: flank)
    monkeypatch.setattr(followed_gauge, "loaded_teeth", lambda _, name: SimpleNamespace(pair=pair, name=name))
    monkeypatch.setattr(followed_gauge, "placed_on_face", lambda one, solved, gear: asked.update(gear=gear) or place)
    for name in ("history", "neglects"):
        monkeypatch.setattr(f"fegear.contact.wide.gauge_on_face.wide_gauge_{name}",
                            lambda *given, name=name: asked.update({name: given}) or name)  # fmt: skip
    one = SimpleNamespace(gear="g", pair="I", member="driven", side="tension", grid="grid", z="z")
    found = followed_gauge.gauge_on_face(one, {}, neglected=neglected)
    assert asked["gear"] == "gear driven"
    assert asked["history"][1:] == ("driven", "tension", "grid", "middle", "places", "z", flank)
    assert ("neglects" in asked) is neglected
    if neglected:
        assert asked["neglects"][1:] == ("driven", "tension", "grid", "middle", "z", flank)
    assert found == followed_gauge.FollowedGauge(place, "history", (pair, "driven", "tension", "flank"),
                                                 "neglects" if neglected else {})  # fmt: skip


@pytest.mark.parametrize(("key", "extreme"), [("film", "minimum"), ("ratio", "minimum"), ("pressure", "maximum")])
def test_over_the_face_films_have_a_minimum_and_the_rest_a_maximum(key, extreme):
    wide = SimpleNamespace(data=SimpleNamespace(data=SimpleNamespace(wide=True)))
    assert flank_surface_sheet._extreme_word(key)(wide) == f"{extreme} over the face width"
    wide.data.data.wide = False
    assert flank_surface_sheet._extreme_word(key)(wide) == "computed load"


def test_cracked_gears_are_those_whose_bodies_differ(monkeypatch):
    monkeypatch.setattr(crosscheck, "reshaped_gears", lambda _: ("a", "c"))
    monkeypatch.setattr(crosscheck, "odd_gears_of", lambda *_: ("a", "b"))
    assert crosscheck._cracked(None, "I") == ("a",)


def test_a_variant_that_is_not_in_the_table_is_refused_with_those_that_are():
    column = SimpleNamespace(name="variant", si=np.arange(1.0, 21.0))
    tables = {"sizing": SimpleNamespace(columns=[column])}
    with pytest.raises(InputError, match="for example 1, 2, 3, 4, 5, 6, 7, 8"):
        applied_variant.text_of_variant({"sizing": {}}, tables, 21, "run")


def test_points_of_a_sizing_are_kept_by_their_case_without_its_title():
    one = {"document": {"title": "A", "gear": 1}, "estimates": True, "folder": "here"}
    assert by_fe._content(one) == by_fe._content({**one, "document": {"title": "B", "gear": 1}, "folder": "there"})
    assert by_fe._content(one) != by_fe._content({**one, "document": {"title": "A", "gear": 2}})
    assert by_fe._content(one) != by_fe._content({**one, "estimates": False})


# ---- files -----------------------------------------------------------------------------------------------------------
def test_springs_of_an_fmu_are_those_of_plane_or_of_wide_flanks(monkeypatch):
    class Engagement:
        def reversed(self):
            return "reversed"

    monkeypatch.setattr("fegear.dynamics.train.mesh_excitation.mesh_excitation", lambda *given: given)
    monkeypatch.setattr("fegear.dynamics.train.flank_excitation.flank_excitation", lambda *g, forward: (*g, forward))
    own = Engagement()
    plane = SimpleNamespace(engagement=own)
    assert fmu._springs(plane, 5.0, forward=True) == (own, 5.0)
    assert fmu._springs(plane, 5.0, forward=False) == ("reversed", 5.0)
    flanks = SimpleNamespace(solve=lambda *given: given)
    wide = SimpleNamespace(flanks=flanks, gaps="gaps", known="known")
    assert fmu._springs(wide, 5.0, forward=False) == (flanks, ([5.0], "gaps", "known"), False)


def test_a_folder_of_tables_that_cannot_be_read_is_refused(monkeypatch, tmp_path):
    assert run_folder._tables(tmp_path, "RESULTS") == []
    (tmp_path / "tables").mkdir()
    for name in ("b.csv", "a.csv", "c.txt"):
        (tmp_path / "tables" / name).write_text("")
    assert [path.name for path in run_folder._tables(tmp_path, "RESULTS")] == ["a.csv", "b.csv"]

    def refuses(_):
        raise PermissionError(13, "Permission denied")

    monkeypatch.setattr(type(tmp_path), "iterdir", refuses)
    with pytest.raises(InputError, match=r"cannot be read \(Permission denied\)"):
        run_folder._tables(tmp_path, "RESULTS")


def value(number, error):
    return SimpleNamespace(name="I.te", unit="um", meaning="error", value=number, error=error)


@pytest.mark.parametrize(("errors", "columns"), [((0.1, None), 4), ((None, None), 3), ((0.0, 0.0), 3)])
def test_a_sweep_has_a_column_of_errors_where_any_is_known(errors, columns):
    points = []
    for number, error in zip((5.0, 7.0), errors, strict=True):
        point = object.__new__(Point)
        object.__setattr__(point, "values", (value(number, error),))
        points.append(point)
    axis = Axis("gear.a.teeth", (20, 21), (20.0, 21.0))
    table = sweep_table(SweepResults("s", "", (axis,), tuple(points), 1.0, 0, (0, 0, 0.0)))
    assert len(table.columns) == columns
    assert table.columns[0].values.tolist() == [20, 21]
    assert table.columns[1].values.tolist() == [5.0, 7.0]
    if columns == 4:
        assert table.columns[2].values[0] == 0.1
        assert math.isnan(table.columns[2].values[1])


class Terminal:
    encoding = "utf-8"

    def __init__(self):
        self.text = ""

    def isatty(self):
        return True

    def write(self, text):
        self.text += text
        return len(text)

    def flush(self):
        return None


@pytest.mark.parametrize("remaining", [True, False])
def test_a_bar_says_what_remains_where_steps_are_alike(monkeypatch, remaining):
    monkeypatch.setenv("TERM", "xterm")
    stream = Terminal()
    with watcher(stream, remaining=remaining) as bar:
        bar.begin("points", 1, 2)
        bar.advance(0.5)
        bar.end(0.1)
    assert ("remaining" in stream.text) is remaining
    assert "[1/2] points" in stream.text


# ---- bearings of catalogues, curves, other programs ------------------------------------------------------------------
@pytest.mark.parametrize(
    ("kind", "angle", "wanted"),
    [("tapered", None, math.atan(0.24)), ("spherical", None, math.atan(0.24)), ("tapered", 0.3, 0.3),
     ("ball", None, None)],
)  # fmt: skip
def test_the_contact_angle_of_a_tapered_bearing_follows_from_its_e(monkeypatch, kind, angle, wanted):
    """ISO 281: e = 1.5 tan(alpha); 0.36 is that of 13.5 degrees."""
    found = []
    says = {"catalogue_value_e": 0.36, "pressure_angle": angle}
    said = SimpleNamespace(number=lambda _one, _kind, *names: next((says[n] for n in names if says.get(n)), None),
                           yes=lambda *_: None, word=lambda *_: "", notes=[])  # fmt: skip
    size = SimpleNamespace(kind=kind, known=None, bore=0.025, outside_diameter=0.052, width=0.015)
    monkeypatch.setattr(catalogue_bearings, "_size", lambda *_: size)

    def made(*given):
        found.append(given[6])
        raise InputError("bore", "", "")

    monkeypatch.setattr(catalogue_bearings, "CatalogueBearing", made)
    one = SimpleNamespace(type="rolling_bearing", said="bearing 1")
    function = catalogue_bearings.printed_bearing
    function(said, one, [one], 0.0)
    assert found == [pytest.approx(wanted) if wanted else None]


def test_a_curve_over_a_revolution_has_the_torque_of_its_load_at_the_base_circle():
    found = SimpleNamespace(load=2000.0, driver_base_radius=0.03,
                            stiffness_at=lambda angle, secant: (angle, secant),
                            error_at=lambda angle: ("error", angle),
                            start_at=lambda angle: ("start", angle))  # fmt: skip
    curve = _OverRevolution(found)
    assert curve.driver_torque.tolist() == [60.0]
    assert curve.stiffness(0.1, secant=True) == (0.1, True)
    assert curve.stiffness(0.1) == (0.1, False)
    assert (curve.error(0.2), curve.start(0.3)) == (("error", 0.2), ("start", 0.3))


def test_deflections_beside_calculix_are_judged_by_the_loaded_band_s_own(monkeypatch):
    """A constant difference of 0.001 of two bands under two loads: relative to 1 and to 2."""
    known = {"deflection": [[1.0, 0.4], [0.5, 2.0]], "tension": [[1.0, -4.0], [0.5, 2.0]]}
    bands = ["first", "second"]

    def deflection(_radius, band, load):
        return np.array([[known["deflection"][bands.index(load)][bands.index(band)] + 1e-3]])

    def root(_radius, side, load, _stations):
        assert side == "tension"
        return np.array(known["tension"][bands.index(load)])[:, None] + 1e-3, None

    solution = SimpleNamespace(deflection=deflection, largest_root_stress=root)
    deflections = [(1.0, 1.0), (0.4, 1.0), (0.5, 2.0), (2.0, 2.0)]  # with the loaded band's own
    for which in ("off", "inclined"):
        monkeypatch.setattr(
            calculix, "_on_a_web", lambda asked, which=which: (solution, bands) if asked == which else ()
        )
        monkeypatch.setattr(calculix, "kept", lambda _, which=which: {which: known})
        named = "web" if which == "off" else "inclined_web"
        judged = list(getattr(calculix, f"calculix_{named}_deflection")())
        assert [(one.wanted, one.scale) for one in judged] == deflections
        assert [one.found - one.wanted for one in judged] == pytest.approx([1e-3] * 4)
        stresses = list(getattr(calculix, f"calculix_{named}_root_tension")())
        assert [(one.wanted, one.scale) for one in stresses] == [(1.0, 1.0), (-4.0, 1.0), (0.5, 2.0), (2.0, 2.0)]
    monkeypatch.setattr(calculix, "_over_holes", lambda: [(solution, bands, known)] * 2)
    assert list(calculix.calculix_web_holes_deflection()) == 2 * judged
    assert list(calculix.calculix_web_holes_root_tension()) == 2 * stresses
