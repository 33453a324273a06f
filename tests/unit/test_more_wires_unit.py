"""Small parts by what they stand for: peaks, loads that change places, motions over revolutions, lists of defaults."""

import math
import os
import time
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.atlas.shipped import shipped_atlas
from fegear.base.errors import GeometryError
from fegear.case.crack_growth import CrackGrowthPart
from fegear.case.flank_design import FlankDesignPart
from fegear.contact.plane.neglected_effects import _load_change
from fegear.contact.wide import spots
from fegear.design.flanks.designed_flanks import FlankDesign
from fegear.dynamics.motion import motion_over_revolution as over_revolution
from fegear.dynamics.train.tooth_strain import ToothStrain
from fegear.engine import processes
from fegear.engine.stage import Task
from fegear.fem.plane.estimate import Estimate
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.results.gear import stiffness
from fegear.results.pair import crack_path
from fegear.studies.cost import knobs


def test_the_peak_of_a_strain_is_in_the_sense_of_the_largest_static_one():
    peak = ToothStrain._peak.fget
    total = np.array([5.0, -3.0, 1.0])
    assert peak(SimpleNamespace(static=np.array([0.1, -2.0, 1.0]), total=total)) == 1
    assert peak(SimpleNamespace(static=np.array([-0.1, -0.2, 1.0]), total=total)) == 0
    assert peak(SimpleNamespace(static=np.array([0.0, -2.0, 0.5]), total=-total)) == 0


@pytest.mark.parametrize("turned", [False, True])
def test_the_largest_change_of_a_load_is_of_pairs_with_one_number(turned):
    def state(numbers, loads):
        grid = SimpleNamespace(contacts=SimpleNamespace(number=np.array(numbers)))
        return SimpleNamespace(grid=grid, loads=np.array(loads, dtype=float)[:, None, None])

    less, more = state([0, 1], [60.0, 40.0]), state([-1, 0, 1, 2], [50.0, 20.0, 15.0, 15.0])
    after, before = (less, more) if turned else (more, less)
    change = _load_change(lambda x: [after, before], np.zeros(1))
    assert change.tolist() == [[-50.0 if turned else 50.0]]  # of the pair that the other state does not have


@pytest.mark.parametrize(("cycles", "duration", "averaged"), [(3, 6.0, 2), (3, 3.0, 1), (4, 1.0, 1)])
def test_a_motion_over_a_revolution_is_the_mean_of_its_repetitions(monkeypatch, cycles, duration, averaged):
    """A mesh once a second from phase 0.25 on; every other revolution is higher by two."""
    asked = []

    def signal(at, order):
        asked.append(order)
        high = 2.0 * (np.floor((at + 0.25 + 1e-9) / cycles) % 2.0)
        own = (order + 1.0) * np.cos(2.0 * np.pi * (at + 0.25) / cycles) + high
        return np.stack([np.zeros_like(at), own], axis=1)

    path = SimpleNamespace(duration=duration, approach=signal, mesh_forces=lambda at: signal(at, 4))
    model = SimpleNamespace(parts=lambda: SimpleNamespace(frequency=np.array([9.0, 1.0])))
    state = SimpleNamespace(trajectory=lambda **_: path, model=model, repeats=True, behind=np.array([0.5, 0.25]))
    monkeypatch.setattr(over_revolution, "without_mesh_harmonics", lambda te, n: te * n)
    pair = SimpleNamespace(driver=SimpleNamespace(teeth=20))
    found = over_revolution.motion_over_revolution(state, 1, pair, cycles, 0.25)
    samples = 128 * cycles
    assert (found.averaged, found.behind) == (averaged, 0.25)
    assert found.te.shape == (samples,)
    assert sorted(asked) == [0, 2, 4]
    s = np.arange(samples) / 128
    assert found.time == pytest.approx(s)
    assert found.driver_angle == pytest.approx(2.0 * math.pi * s / 20)
    assert (found.cycles, found.frequency, found.repeats) == (cycles, 1.0, True)
    assert found.te_residual == pytest.approx(found.te * cycles)
    if duration == 6.0:
        wave = np.cos(2.0 * np.pi * s / cycles)
        for values, times in ((found.te, 1.0), (found.acceleration, 3.0), (found.force, 5.0)):
            assert values == pytest.approx(times * wave + 1.0, abs=1e-9)


def test_misalignment_scatters_over_more_than_one_place():
    for size, scattered in ((1, False), (2, True), (3, True)):
        task = SimpleNamespace(scatter=SimpleNamespace(over_face=np.zeros(size)))
        assert FlankDesign.scattered.fget(SimpleNamespace(task=task)) is scattered


def test_spots_of_several_loads_are_put_together_with_the_most_steps(monkeypatch):
    from fegear.base.errors import ConvergenceError
    from fegear.contact.wide.load_sharing import Contact

    def solve(known, gap, load, *more, **_):
        raise ConvergenceError("never together")

    def own(known, gap, load):
        at = float(load[0, 0])
        parts = (np.full((1, 1), value * at) for value in (1.0, 2.0, 3.0, 4.0))
        return SimpleNamespace(spot=None if at == 3.0 else np.array([at])), Contact(*parts, int(10 - at))

    monkeypatch.setattr(spots, "solve_contact", solve)
    monkeypatch.setattr(spots, "_own_width", own)
    known = SimpleNamespace(fixed_half_width=None, line_half_width=1.0)
    widest, found = spots.solve_spots(known, np.zeros((1, 1)), np.array([[1.0, 3.0, 2.0]]), None)
    assert widest.spot == 2.0
    assert found.steps == 9
    for name, times in (("force", 1.0), ("approach", 2.0), ("stiffness", 3.0), ("residual", 4.0)):
        assert getattr(found, name).tolist() == [[times, 3.0 * times, 2.0 * times]]


def test_neighbours_err_no_less_than_usually_and_than_what_the_gear_turns():
    def kept(beside=0.0):
        one = SimpleNamespace(
            _least_beside=beside, _neighbour_at_samples=lambda k: np.full((99, 99), 2.0), common_errors=(0.0, 0.5)
        )
        (found,) = Estimate._neighbour_estimate(one, 1, np.zeros(1))
        return found

    assert kept(1e8) == pytest.approx(10.0)  # a ten-millionth of what the gear turns
    assert kept() == pytest.approx(2.5)


def test_a_pair_may_jam_by_what_rounded_profile_shifts_are_off_and_by_no_more():
    gear = Gear(Tooth(24, BasicRack(1.0, 1.25, 0.38)), 2e-3, 0.01)
    tight = GearPair(gear, gear).tight_centre_distance
    GearPair(gear, gear, tight - 4.9e-4 * 2e-3)
    with pytest.raises(GeometryError, match="leaves no backlash"):
        GearPair(gear, gear, tight - 5.1e-4 * 2e-3)


def test_a_gear_of_the_atlas_states_nothing_that_all_teeth_have_in_common():
    gear = Gear(Tooth(31, BasicRack(1.0, 1.25, 0.38), 0.1), 3e-3, 0.02)
    assert shipped_atlas("A").gear(gear).common_errors() == (0.0, 0.0)


def test_a_count_as_a_knob_has_no_floor_of_its_own():
    knob = knobs._counted("te", "positions", "here", (2, 4, 8), lambda n: 1.0 / n)
    assert knob.floor == 0.0
    assert knob.step.tolist() == knob.error.tolist() == [0.5, 0.25, 0.125]
    assert knob.order.slope == pytest.approx(1.0)
    assert knobs._counted("te", "positions", "here", (2, 4), lambda n: 1.0 / n, 0.3).floor == 0.3


def test_the_deflection_that_an_answer_says_is_of_a_hundred_newtons_a_millimetre(monkeypatch):
    at_pitch = {"c_self": SimpleNamespace(compliance=4e-11, error=1e-15)}
    monkeypatch.setattr(stiffness, "_at_pitch", lambda seen: at_pitch)
    (said,) = stiffness._at_a_load(SimpleNamespace(name="pinion"))
    assert said == "Gear pinion: 100 N/mm deflect the loaded tooth by 4 µm." or said.startswith(
        "Gear pinion: 100 N/mm deflect the loaded tooth by 4.0"
    )


@pytest.mark.skipif(not hasattr(os, "fork"), reason="no fork")
def test_a_folder_is_removed_as_soon_as_the_process_that_held_it_has_ended(tmp_path):
    folder = tmp_path / "scratch"
    folder.mkdir()
    read, write = os.pipe()
    if not (child := os.fork()):
        processes._remove_after_the_end(str(folder))
        os.read(read, 1)  # of the process itself, or of the one that waits for its end
        os._exit(0)
    time.sleep(0.05)
    assert folder.exists()
    os.write(write, b"xx")
    os.waitpid(child, 0)
    ends = time.monotonic() + 20.0
    while folder.exists() and time.monotonic() < ends:
        time.sleep(0.01)
    assert not folder.exists()
    os.close(read)
    os.close(write)


def test_lists_that_are_defaults_are_those_of_the_pages():
    assert FlankDesignPart().map.load_factors == [0.25, 0.5, 0.75, 1.0, 1.25]
    from fegear.case.design import RobustnessPart
    from fegear.case.sizing import SizingPart

    assert RobustnessPart().load_factors == [0.7, 0.85, 1.0, 1.15, 1.3]
    assert RobustnessPart().relief_errors == [-0.2, 0.0, 0.2]
    assert SizingPart.model_fields["pinion_teeth"].default_factory() == [15, 40]


def test_a_crack_of_either_gear_is_followed_under_the_loads_of_its_own_tooth(monkeypatch):
    """A fifth of a module a step of its own, a tenth else; loads where there are any, from the pitch point on."""
    tooth = Tooth(20, BasicRack(1.0, 1.25, 0.38))
    gear = Gear(tooth, 2e-3, 0.01)
    pair = GearPair(gear, gear)
    ordinary = SimpleNamespace(lowest_radius=gear.base_radius, highest_radius=0.0219)
    known = SimpleNamespace(gear=gear, ordinary=ordinary)
    angle, load = np.array([-0.05, 0.0, 0.04, 0.3]), np.array([0.0, 100.0, 200.0, 300.0])
    asked, calls = [], []
    monkeypatch.setattr(crack_path, "odd_solution_of", lambda upstream, name: known)
    monkeypatch.setattr(crack_path, "over_revolution", lambda *given: given)
    monkeypatch.setattr(
        crack_path, "crack_in_mesh",
        lambda *given: asked.append(given) or SimpleNamespace(gear_angle=angle, load=load, k_1=0.1 * load - 7.0),
    )  # fmt: skip
    found = SimpleNamespace(length=np.array([1e-3, 4e-3]), cycles_to_fracture=5e6, cycles_to_fracture_error=2e5)
    monkeypatch.setattr(crack_path, "growing_crack", lambda *given, **more: calls.append((given, more)) or found)
    engagement = SimpleNamespace(compliance=SimpleNamespace(face_width=0.02))
    loaded = SimpleNamespace(engagement=engagement, nominal=500.0, pair=pair)
    for step, toughness in ((None, None), (0.4e-3, 50.0)):
        part = SimpleNamespace(
            step=step, steps=7, law="law", toughness=toughness, load_factors=[1.0, 2.0], shares=(0.5, 0.5)
        )
        given = SimpleNamespace(
            revolution=SimpleNamespace(name="I", gears=("a", "b")), part=part, cracks=(("a", 3, "x"), ("b", 4, "y"))
        )
        progress = []
        work = SimpleNamespace(progress=progress.append)
        data = crack_path._compute(given, {Task(crack_path.ODD, "I"): loaded}, work)
        assert progress == [0.5, 1.0]
        first, second = data.paths
        assert (first.gear, first.tooth, first.final_length, first.cycles) == ("a", 3, 4e-3, 5e6)
        assert (second.gear, second.tooth) == ("b", 4)
        assert (first.cycles_error, first.k_1_max, first.k_1_min) == (2e5, 23.0, -7.0)
    assert [one[2] for one in asked[:2]] == ["driver", "driven"]
    at_pitch = math.tan(pair.working_pressure_angle)
    for (call, more), way in zip(calls[:2], (1.0, -1.0), strict=True):
        radius = gear.base_radius * np.hypot(1.0, at_pitch + way * angle[1:])
        assert call[2][0] == pytest.approx(np.clip(radius, gear.base_radius, 0.0219))
        assert call[2][1] == pytest.approx(load[1:] / 0.02)
        assert more == {"step": pytest.approx(0.2e-3), "steps": 7, "law": "law", "toughness": None,
                        "factors": [1.0, 2.0], "shares": (0.5, 0.5)}  # fmt: skip
    assert (calls[2][1]["step"], calls[2][1]["toughness"]) == (0.4e-3, 50e6)
    assert CrackGrowthPart().shares == (1.0,)


def test_formats_say_what_they_need_and_what_they_can_write():
    from fegear.output.export_formats import FORMATS

    def of(flag):
        return {name for name, one in FORMATS.items() if getattr(one, flag)}

    asymmetric = {"dxf", "step", "msh", "vtu", "inp", "solid-inp", "solid-vtu"}
    assert of("asymmetric") == asymmetric, "a format that was tried with asymmetric teeth belongs in this list"
    assert of("takes_results") == {"rexs"}
    assert of("needs") == {"fmu"}


@pytest.mark.parametrize(("against", "u", "w"), [(False, (1, 0, 0), (0, 0, 1)), (True, (-1, 0, 0), (0, 0, -1))])
def test_axes_of_a_shaft_that_says_no_more_are_those_of_the_gearbox(monkeypatch, against, u, w):
    from fegear.exchange.rexs import places

    monkeypatch.setattr(places, "direction", lambda said, shaft: against)
    found = places.own_axes(SimpleNamespace(vector=lambda shaft, key: None), None)
    assert [tuple(one) for one in found] == [u, (0, 1, 0), w]
    own = places.own_axes(SimpleNamespace(vector=lambda shaft, key: (0.0, 2.0, 0.0)), None)
    assert tuple(own[2]) == pytest.approx((0, 1, 0))


def test_traces_of_a_topography_are_those_through_its_middle(monkeypatch):
    """Measured off the middle of the face, and in other places than its evaluation ends."""
    from fegear.case.built import measured_flanks

    x, z = np.linspace(2.0, 8.0, 7), np.linspace(-4.0, 6.0, 6)
    tooth, along, across = (part.ravel() for part in np.meshgrid([1.0, 5.0], x, z, indexing="ij"))
    rows = {"tooth": tooth, "x": along, "z": across, "deviation": 1e-3 * tooth * (along**2 + 0.1 * across)}
    monkeypatch.setattr(measured_flanks, "_columns", lambda *given: rows)
    part = SimpleNamespace(topography="flank.csv", filter=False)
    tooth_of = SimpleNamespace(working_flank=None)
    scene = SimpleNamespace(
        gears={"pinion": SimpleNamespace(base_radius=2.0, tooth=tooth_of)},
        written={},
        case=SimpleNamespace(gear={"pinion": SimpleNamespace(measured_of=lambda flank: (part, "measured"))}),
    )
    profile, helix, both = measured_flanks._flank(scene, "pinion", part, (3.0, 7.0), (-3.0, 5.0))
    assert (profile.kind, helix.kind) == ("profile", "helix")
    (removed,) = [one for one in vars(both).values() if np.ndim(one) == 2]
    mean = 3e-3 * (x[:, None] ** 2 + 0.1 * z)
    assert removed == pytest.approx(mean.max() - mean)
    known = np.interp(profile.x, x, x**2)
    for found, number in zip(profile.deviation, (1.0, 5.0), strict=True):
        assert found == pytest.approx(1e-3 * number * known)
    for found, number in zip(helix.deviation, (1.0, 5.0), strict=True):
        assert found == pytest.approx(1e-3 * number * (25.0 + 0.1 * helix.x))


def test_sums_of_shifts_vary_slower_than_the_pinions():
    from fegear.case.sizing import SizingPart
    from fegear.results.sizing.basis import space_of

    space = space_of(SizingPart.model_validate({
        "power": "2.9 kW", "speed": "725 rpm", "ratio": 2.5, "ratio_tolerance": 0.2,
        "centre_distance": ["60 mm", "160 mm"], "strength": {"material": "18CrNiMo7-6"},
        "operation": {"life": "5000 h"}, "width_ratios": [0.6],
        "normal_modules": ["2 mm"], "pinion_teeth": [18, 19],
        "pinion_shifts": [0.0, 0.3, 0.6], "shift_sums": [-0.2, 0.4],
    }))  # fmt: skip
    shift = space.pairs(np.arange(6)).profile_shift
    assert shift[0] == pytest.approx([0.0, 0.3, 0.6] * 2)
    assert shift.sum(axis=0) == pytest.approx([-0.2] * 3 + [0.4] * 3)


def test_what_two_reliefs_take_off_is_found_again_by_amount_and_length():
    from fegear.design.tip_relief import grindable

    found = next(one for one in vars(grindable).values() if hasattr(one, "removal_error"))
    ends = (SimpleNamespace(power=1.0, amount=10e-6), SimpleNamespace(power=2.0, amount=4e-6))
    error = found.removal_error.fget(SimpleNamespace(driver=ends[0], driven=ends[1]))
    assert error == pytest.approx(1e-6 * (2.0 * 10e-6 + 3.0 * 4e-6))


@pytest.mark.parametrize("factor", [0.5, 2.0])
def test_coarser_settings_of_a_solid_have_longer_edges_and_fewer_waves(factor):
    from fegear.fem.solid.settings import SolidSettings

    one = SolidSettings(least_degree=8, wave_reach=4.0, fewest_waves=6.0, waves_per_module=3.0, band_half_width=0.1)
    other = one.scaled(factor)
    assert other.section == one.section.scaled(factor)
    assert (other.waves_per_module, other.wave_reach, other.fewest_waves) == (3.0 / factor, 4.0 / factor, 6.0 / factor)
    assert other.least_degree == round(8 / factor)
    assert other.band_half_width == pytest.approx(0.1 * math.sqrt(factor))
    assert SolidSettings(band_half_width=0.4).scaled(2.0).band_half_width == 0.5


def test_lines_through_points_beside_a_kink_meet_in_it_and_points_in_one_place_have_no_line():
    from fegear.contact.fourier import Panels

    def above(x):
        x = np.array(x)
        values = np.where(x < 0.1, 1.0 + x, 1.1 - 2.0 * (x - 0.1))
        points = Panels(x, np.ones(x.size), 4.0, np.zeros(1), kinks=True)
        return points._kink_above(values, 2)

    assert above([-2.0, -1.0, 0.0, 1.0, 2.0]) == pytest.approx(0.1)
    for x in ([-1.0, -1.0, 0.0, 1.0, 2.0], [-2.0, -1.0, 0.0, 1.0, 1.0]):
        assert above(x) == math.inf


def test_what_a_gear_answers_for_each_quantity():
    from fegear.studies.cost.answers import FiniteElements

    known = SimpleNamespace(
        self_compliance=lambda r, b: r + b, neighbour=lambda k, p, q: k * np.outer(p, q),
        largest_root_stress=lambda k, side, r: (7.0 * r, None),
    )  # fmt: skip
    radii, answers = np.array([1.0, 2.0]), FiniteElements({"pinion": known})
    asked = SimpleNamespace(gear="pinion", radii=radii, half_width=0.5)
    assert answers.of_gear("c_0", asked).tolist() == [1.5, 2.5]
    assert answers.of_gear("c_1", asked).tolist() == [1.0, 4.0]
    assert answers.of_gear("root-stress", asked).tolist() == [7.0, 14.0]


def test_indicators_of_a_motion_are_those_of_its_error_with_one_hunting_tooth(monkeypatch):
    """Sidebands stand a shaft's order beside the mesh: of the teeth of driver and driven, over so many base pitches."""
    monkeypatch.setattr(over_revolution, "indicators_of", lambda *given: given)
    gears = {"driver": SimpleNamespace(teeth=20), "driven": SimpleNamespace(teeth=40)}
    found = SimpleNamespace(pair=SimpleNamespace(gear=gears.__getitem__), te="te", cycles=40)
    assert over_revolution.MotionOverRevolution.indicators.func(found) == ("te", 40, [20, 40])
