"""Parts of results that long runs alone reach: harmonics of forces, waves once per turn, ways that leave less."""

import json
import math
import tomllib
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest
import tomlkit

from fegear.base.errors import InputError
from fegear.base.notes import NoteClass, class_of
from fegear.case.drafts import placed_shafts
from fegear.case.reading import build_scene
from fegear.contact.fitted_curve import FittedCurve
from fegear.engine import added_stage
from fegear.engine.citation import Citation, bibliography
from fegear.geometry.custom_fillet_tooth import with_fillet
from fegear.geometry.fillet_shapes import EllipseOnSpace
from fegear.output import dxf
from fegear.results.helical import double_helical_data as double
from fegear.results.helical.pair_forced_response import _lines
from fegear.results.pair import fillet_design_sheet, load_distribution
from fegear.results.pair.trace_levels import _less_runout
from fegear.results.relief import flank_design_answer, tolerance_words
from fegear.results.relief.applied_fillet import applied_fillet
from fegear.results.train.dynamic_strain_data import DynamicStrain


# ---- excitation of a helical pair ------------------------------------------------------------------------------------
def test_forces_go_with_the_turns_of_their_own_shaft_and_errors_with_the_teeth_of_the_driver():
    """The driven shaft at 0.4 of the driver's speed: what comes twice in its turn comes 0.8 times in the driver's."""
    force = {"phase": math.pi / 2, "components": (1.0, 0.0, 0.0, 2.0, 0.0), "frequency": None, "order": None}
    forces = [
        SimpleNamespace(**force | {"on": "driver", "order": 2.0}),
        SimpleNamespace(**force | {"on": "driven", "order": 2.0}),
        SimpleNamespace(**force | {"on": "driven", "frequency": 50.0}),
    ]
    part = SimpleNamespace(transmission_error=SimpleNamespace(along="theta_x"), external=forces)
    found = _lines(SimpleNamespace(excitation=part, teeth=20), np.array([3e-6, 0.0, 1e-6j]), 0.4)
    first, third, own, other, steady = found
    assert [one.order for one in found] == pytest.approx([20.0, 60.0, 2.0, 0.8, 0.0])
    assert [one.frequency for one in found] == pytest.approx([0.0, 0.0, 0.0, 0.0, 100.0 * math.pi])
    assert first.error == (0.0, 0.0, 3e-6, 0.0, 0.0)
    assert third.error == (0.0, 0.0, 1e-6j, 0.0, 0.0)
    assert own.on_driver == pytest.approx((1j, 0.0, 0.0, 2j, 0.0))
    assert not any(own.on_driven)
    assert other.on_driven == steady.on_driven == own.on_driver
    assert not any(other.on_driver)
    assert [one.source for one in found] == ["transmission error"] * 2 + [f"external {n}" for n in (1, 2, 3)]


# ---- traces ----------------------------------------------------------------------------------------------------------
def test_what_a_level_has_once_per_turn_beside_the_mesh_is_subtracted_where_asked_for():
    angle = np.linspace(0.0, 4.0 * math.pi, 1440, endpoint=False)
    wave = 20e-6 * np.cos(angle - 1.0)
    place = np.mod(angle - 0.3 + math.pi, 2.0 * math.pi) - math.pi  # the mesh, as wide as 0.4 rad
    pulse = np.where(np.abs(place) < 0.2, 500e-6 * (1.0 - (place / 0.2) ** 2), 0.0)
    level = SimpleNamespace(angle=angle, strain=wave + pulse)
    found = SimpleNamespace(shift=0.3, angle=np.array([0.2, -0.2, 0.0]))
    assert _less_runout(level, found, False) is level.strain
    assert _less_runout(level, found, True) == pytest.approx(pulse, abs=1e-9)
    short = SimpleNamespace(angle=angle[:60], strain=level.strain[:60])  # a sixth of a turn has no wave
    assert _less_runout(short, found, True) is short.strain


def trace_of(curve, angle):
    zero = np.zeros(angle.size)
    more = dict.fromkeys(("offset", "shift", "gain_error"), 0.0)
    return FittedCurve(fit=("scale",), errors={}, outside=0, scale=1.0, gain=1.0, angle=angle, measured=curve + zero,
                       computed=curve, **more)  # fmt: skip


def test_a_bridge_s_peak_is_that_of_the_difference_and_its_limits_have_both_grids():
    """Displaced grids that see 0.9 and 1.25 of the computed difference would give a trace of so much of it."""
    angle = np.linspace(0.0, 1.0, 101)
    curve = np.sin(math.pi * angle)
    first = SimpleNamespace(peak=300e-6, peak_error=3e-6, angle=angle, displacement=np.array([0.0, 1e-4]),
                            displaced=np.stack([curve, curve], axis=1))  # fmt: skip
    seen = SimpleNamespace(**vars(first) | {"peak": 500e-6, "peak_error": None,
                                            "displaced": np.stack([curve, 0.9 * curve], axis=1)})  # fmt: skip
    made = {"found": first, "alone": True, "load_tolerance": 0.02, "compared": None, "otherwise": None}
    bridge = DynamicStrain(**made, seen=seen, displaced_second=np.stack([curve, 1.25 * curve], axis=1))
    assert (bridge.bridge_peak, DynamicStrain(**made).bridge_peak) == (500e-6, None)
    known = bridge._computed(trace_of(curve, angle))
    assert (known.strain, known.error, known.load_tolerance) == (500e-6, 0.0, 0.02)
    assert known.gains == pytest.approx([1.0, 0.9])
    assert known.gains_of_second == pytest.approx([1.0, 1.25])
    alone = DynamicStrain(**made)._computed(trace_of(curve, angle))
    assert (alone.strain, alone.error) == (300e-6, 3e-6)
    assert np.array_equal(alone.gains_of_second, [1.0])


# ---- drafts ----------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize(("left", "right", "order"), [(900.0, 500.0, ["floating", "locating"]),
                                                      (500.0, 900.0, ["locating", "floating"])])  # fmt: skip
def test_the_bearing_with_less_radial_load_holds_the_axial_force_alone(monkeypatch, left, right, order):
    asked = []

    def bearing(kind, seat, radial, axial, _forces):
        asked.append((kind, radial, axial))
        return placed_shafts.ChosenBearing(kind, None, max(seat, 0.025 if kind == "roller" else 0.02), 0.015, 0.05)

    monkeypatch.setattr(placed_shafts, "_bearing", bearing)
    found = placed_shafts._located(0.02, placed_shafts._Forces(left, right, 300.0, 1e8, 0.06))
    assert set(asked) == {("ball", 500.0, 300.0), ("roller", 900.0, 0.0)}
    assert list(found.bearings) == order
    assert asked[-1][0] == "roller"
    assert len(asked) == 4  # the ball bearing again on the larger bore of the other


# ---- stages of others ------------------------------------------------------------------------------------------------
def test_citations_of_another_distribution_are_of_works_that_the_bibliography_has():
    known = next(iter(bibliography()))
    added_stage._cited((Citation(known, "everything"),))
    with pytest.raises(ValueError, match='names "nobody2020"'):
        added_stage._cited((Citation(known, "a"), Citation("nobody2020", "b")))
    for wrong in ([Citation(known, "a")], (known,)):
        with pytest.raises(TypeError, match="cites"):
            added_stage._cited(wrong)


# ---- designed flanks and fillets -------------------------------------------------------------------------------------
def ways(torque, ours, theirs):
    design = SimpleNamespace(
        left_by=lambda one: {"best": ours, "least": theirs}[one.label][0],
        left_under=lambda one: np.array({"best": ours, "least": theirs}[one.label]),
        worst_load=lambda left: int(np.argmax(np.asarray(left) / np.array(torque))),
    )
    over = {name: SimpleNamespace(torque=np.array(torque), peak_to_peak=np.array(of))
            for name, of in (("best", ours), ("least", theirs))}  # fmt: skip
    data = SimpleNamespace(design=design, over_range=over)
    return SimpleNamespace(name="I", data=data, asked=SimpleNamespace(over=True))


@pytest.mark.parametrize(
    ("torque", "ours", "theirs", "said"),
    [([40.0], [3e-6], [2e-6], "(2, not 3 µm at 40 N·m)"),
     ([20.0, 40.0], [3e-6, 4e-6], [1e-6, 3.5e-6], "(1, not 3 µm at 20 N·m)"),
     ([20.0, 40.0], [1e-6, 4e-6], [0.5e-6, 3e-6], "(3, not 4 µm at 40 N·m)")],
)  # fmt: skip
def test_two_ways_are_compared_at_the_torque_at_which_the_one_to_grind_is_worst(torque, ours, theirs, said):
    best, least = (SimpleNamespace(label=name) for name in ("best", "least"))
    shown = flank_design_answer._drawn(ways(torque, ours, theirs), best, least)
    numbers = [word.strip("(),") for word in shown.split()]
    wanted = [word.strip("(),") for word in said.split()]
    assert [float(numbers[k]) for k in (0, 2, 5)] == [float(wanted[k]) for k in (0, 2, 5)]


FILLETS = {
    "results": ["fillet-design"], "neglected": False,
    "gear": {"a": {"teeth": 20, "module": "3 mm", "face_width": "6 mm", "bore_radius": "12 mm"},
             "b": {"teeth": 31, "module": "3 mm", "face_width": "6 mm", "bore_radius": "12 mm"}},
    "pair": {"I": {"driver": "a", "driven": "b", "load": "1 kN"}},
    "fillet_design": {"gear": "b", "waves": 1, "searches": 1},
    "effects": {"neighbour_coupling": True}, "accuracy": {"tolerance": 0.1},
}  # fmt: skip


@pytest.mark.parametrize("with_table", [False, True])
def test_points_of_a_designed_fillet_are_those_of_the_gear_that_reads_them_back(with_table):
    scene = build_scene(FILLETS, "case", Path())
    gear = scene.gears["b"]
    side = with_fillet(gear.tooth, EllipseOnSpace())
    points = np.asarray(side.fillet.points(np.linspace(side.fillet.start, side.fillet.end, 60)))
    shape = 1e3 * gear.module * points
    tables = {"designed_fillet_I_b": dict(zip("xy", shape, strict=True))}
    document = json.loads(json.dumps(FILLETS))
    if with_table:
        document["gear"]["b"]["fillet"] = {"kind": "ellipse"}
    text = tomlkit.dumps(document)
    for pair in ("", "I"):
        made = applied_fillet(text, Path("case.toml"), FILLETS, tables, "run", pair)
        kept = tomllib.loads(made.text)
        fillet = kept["gear"]["b"].pop("fillet")
        assert fillet["kind"] == "points"
        for axis, values in zip("xy", shape, strict=True):
            assert [float(one.removesuffix(" mm")) for one in fillet[axis]] == pytest.approx(values, rel=1e-8)
        document["gear"]["b"].pop("fillet", None)
        assert kept == document
        assert "gear b, 60 points" in made.said
    with pytest.raises(InputError, match="set --pair I"):
        applied_fillet(text, Path("case.toml"), FILLETS, tables, "run", "II")
    with pytest.raises(InputError, match="has no designed fillet"):
        applied_fillet(text, Path("case.toml"), FILLETS, {}, "run", "")


@pytest.mark.parametrize(
    ("spread", "agree", "note"),
    [(4.9e-3, True, False), (5e-3, True, False), (5.1e-3, False, True), (None, None, False)],
)
def test_searches_agree_within_half_a_percent(spread, agree, note):
    tooth = SimpleNamespace(internal=False)
    design = SimpleNamespace(
        kept=True, found=[0, 1], off_by=0.01, off=(0.02, math.nan), full=None, best=SimpleNamespace(tooth=tooth),
    )  # fmt: skip
    shown = SimpleNamespace(
        design=design, spread_of_searches=spread, module=3e-3, gain=0.2, gain_error=0.01, gain_over_full_rounded=None,
        designed=[SimpleNamespace(minimum_tool_radius=None, suffix="", key="fillet")], both=False, tool=True,
    )  # fmt: skip
    seen = SimpleNamespace(
        data=shown, name="I", asked=SimpleNamespace(gear="b", limits=SimpleNamespace(generated=True))
    )
    remarks = list(fillet_design_sheet._remarks(seen))
    differ = [one for one in remarks if "the searches differ by" in one]
    assert bool(differ) is note
    assert all(class_of(one) == NoteClass.BEYOND_TOLERANCE for one in differ)
    assert any("a single search" in one for one in remarks) is (spread is None)
    present, best = (SimpleNamespace(stress=size, error=1e6) for size in (300e6, 240e6))
    design.present, design.best = present, SimpleNamespace(**vars(best), tooth=tooth)
    shown.designed[0].side, shown.designed[0].x = "", np.zeros(60)
    seen.asked.objective, seen.asked.other = "alternating", ""
    first, *more = fillet_design_sheet._answer(seen)
    assert "alternating root stress" in first
    assert "-20 ± 1 %" in first
    assert ["agree within" in one for one in more] == ([] if agree is None else [agree])
    assert ["differ by" in one for one in more] == ([] if agree is None else [not agree])
    assert all("30 µm (0.01 modules) off" in one and "up to 2.0 % more stress" in one for one in more), more


# ---- loads over the face ---------------------------------------------------------------------------------------------
def over_face(gap, force, load, *, edges=True):
    """Two points on lines at three positions: one inside, one at a tip edge."""
    gap, force, load = (np.asarray(one, dtype=float) for one in (gap, force, load))
    lines = SimpleNamespace(
        at_edge=np.zeros(gap.shape, dtype=bool), edges=SimpleNamespace(gap=gap) if edges else None,
        z=np.zeros(gap.shape), high=5e-3, present=np.ones(gap.shape, dtype=bool), mean=lambda one: float(one.mean()),
    )  # fmt: skip
    found = SimpleNamespace(lines=lines, line_load=load[..., None], load=np.array([1000.0]),
                            contact=SimpleNamespace(force=force[..., None]))  # fmt: skip
    return SimpleNamespace(name="I", data=SimpleNamespace(pair=SimpleNamespace(found=found, at=0)))


def test_corner_contact_carries_what_stands_outside_the_path(monkeypatch):
    """250 of 1000 N at one of two positions, at a gap of 3 um; a gap of 9 um carries nothing."""
    monkeypatch.setattr(load_distribution, "limit_remarks", lambda *_: [])
    seen = over_face([[0.0, 3e-6], [0.0, 9e-6]], [[750.0, 250.0], [1000.0, 0.0]], [[75e3, 25e3], [100e3, 0.0]])
    (corner, idle) = load_distribution._remarks(seen)
    assert "carries up to 25 % of the load, 12 % on average" in corner
    assert corner.endswith("up to 3 um.")
    assert "25 %" in idle  # of four points one has no contact
    seen = over_face([[0.0, 3e-6]], [[500.0, 500.0]], [[5e4, 5e4]], edges=False)
    assert load_distribution._remarks(seen) == []
    seen.data.pair.found.lines.z = np.array([[5e-3, 0.0]])
    (end,) = load_distribution._remarks(seen)
    assert "up to 50 N/mm at the face ends" in end


def test_a_double_helical_pair_over_its_loads_has_its_own_means_and_ranges():
    motion = np.array([[1e-6, 4e-6], [3e-6, 8e-6], [2e-6, 0.0]])
    pair = SimpleNamespace(
        load=np.array([1e3, 2e3]), load_factor=np.array([1.1, 1.2]), mean_transmission_error=np.array([5e-6, 9e-6]),
        peak_to_peak=np.array([1e-6, 2e-6]), face_load_factors=(np.array([1.3, 1.4]), np.array([1.5, 1.6])),
        axial_motion=motion, axial_force=10.0 * motion, mean=lambda values: values.mean(axis=0),
    )  # fmt: skip
    for floating in (True, False):
        found = double.ShownDouble.over_loads.func(SimpleNamespace(pair=pair, floating=floating))
        assert np.array_equal(found.K_Hbeta_I, [1.3, 1.4])
        assert np.array_equal(found.K_Hbeta_II, [1.5, 1.6])
        assert np.array_equal(found.te_mean, [5e-6, 9e-6])
        assert np.array_equal(found.te_peak_to_peak, [1e-6, 2e-6])
        assert found.force_mean == pytest.approx([20e-6, 40e-6])
        if floating:
            assert found.motion_mean == pytest.approx([2e-6, 4e-6])
            assert found.motion_peak_to_peak == pytest.approx([2e-6, 8e-6])
        else:
            assert found.motion_mean is found.motion_peak_to_peak is None


def test_the_first_draw_without_a_result_is_named_with_its_reason():
    percentile = SimpleNamespace(percent=95.0, value=3e-6, low=2e-6, high=4e-6)
    te = SimpleNamespace(percentiles=[percentile], nominal=1e-6)
    part = SimpleNamespace(distribution="normal", draws=100, sequence="sobol", seed=1, reliefs=None)
    asked = SimpleNamespace(name="I", part=part, untold=(), own_spacing=False)
    data = SimpleNamespace(reasons={17: "no contact", 5: "too little backlash", 60: "third"}, relief=None)
    found = SimpleNamespace(data=data, asked=asked, told={"te_peak_to_peak": te})
    told, lost = tolerance_words.tolerance_remarks(SimpleNamespace(data=found))
    assert "95th percentile: 3 um (95 % confidence interval 2 to 4 um); without deviations 1 um." in told
    assert "3 standard deviations" in told
    assert "3 of 100 samples" in lost
    assert "(sample 5): too little backlash" in lost


# ---- drawings --------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize(
    ("front", "back", "said"),
    [("relief", None, ", right flank"), (None, "relief", ", left flank"), ("relief", "other", ", right and left flank"),
     (None, None, "")],
)  # fmt: skip
def test_a_drawing_of_asymmetric_teeth_says_which_of_their_flanks_are_relieved(monkeypatch, front, back, said):
    def described(_scene, _name, back=False, given=(front, back)):
        return SimpleNamespace(relief=given[bool(back)], pair="")

    def seen(flank):
        return SimpleNamespace(asymmetric=True, tooth=SimpleNamespace(working_flank=flank))

    gear = seen("right")
    gear.from_the_back = seen("left")
    monkeypatch.setattr(dxf, "described_relief", described)
    monkeypatch.setattr(dxf, "write_dxf", lambda *given: given)
    request = SimpleNamespace(name="p", scene=SimpleNamespace(spur_gears=["p"]), gear=gear, folder=Path())
    (written, remarks) = dxf.written_dxf(request)
    assert written[3:] == (front, f"with the relief of the case{said}" if said else dxf.AS_GENERATED, back)
    assert remarks == ()
