"""Lines that call: what they call is made up, so that what goes where, and what is taken of what comes, is seen."""

import math
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.built import measured_flanks
from fegear.contact.wide import roots_about_load
from fegear.dynamics.train import back_flanks, flank_excitation, mesh_excitation, stress_on_face
from fegear.engine.stage import Task
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.results.helical import transmissibility
from fegear.results.pair import loaded_flanks
from fegear.results.planetary import planet_revolution, planet_vibration_revolution
from fegear.results.shafts.gearbox_scheme import _of_gear, _pieces
from fegear.results.sizing import by_fe
from fegear.results.train import dynamic_root_stress, gear_train

PAIR = GearPair(Gear(Tooth(24), 2e-3, 0.01, face_width=0.02), Gear(Tooth(37), 2e-3, 0.01, face_width=0.02))


# ---- back flanks of a mesh -------------------------------------------------------------------------------------------
def test_back_flanks_of_symmetric_teeth_follow_half_a_pitch_and_half_the_backlash_behind():
    stiffness = SimpleNamespace(scaled=lambda factor: ("stiffness", factor))
    assert back_flanks.leverage(PAIR) == pytest.approx(1.0)
    found = back_flanks.back_flanks(PAIR, stiffness)
    assert found.stiffness == ("stiffness", pytest.approx(1.0))
    assert found.shift == pytest.approx(-0.5)
    apart = GearPair(PAIR.driver, PAIR.driven, PAIR.centre_distance * 1.004)
    turned = apart.driver.base_radius / math.cos(apart.working_pressure_angle)
    width = 2.0 * math.pi * turned / 24
    thick = apart.driver.tooth.thickness_angle(turned / 2e-3) * turned
    space = apart.circumferential_backlash
    assert space > 0.0
    assert back_flanks.back_flanks(apart, stiffness).shift == pytest.approx(-(thick + 0.5 * space) / width)


@pytest.mark.parametrize("forward", [True, False])
@pytest.mark.parametrize("wide", [True, False])
def test_back_flanks_of_a_mesh_are_loaded_by_the_same_torque_as_the_working_ones_run(monkeypatch, forward, wide):
    asked = []

    def spring(load, halves):
        return SimpleNamespace(widened=lambda by: spring(load, by), total_stiffness=lambda: ("total", load, halves))

    engagement = SimpleNamespace(name="as named", reversed=lambda: SimpleNamespace(name="reversed"))
    data = SimpleNamespace(engagement=engagement, nominal=70.0)
    monkeypatch.setattr(back_flanks, "leverage", lambda pair: 2.0)
    monkeypatch.setattr(back_flanks, "back_flanks", lambda pair, stiffness: (pair, stiffness))
    monkeypatch.setattr(loaded_flanks, "loaded_flanks", lambda upstream, name: ("flanks", name))
    monkeypatch.setattr(gear_train, "loaded_pair", lambda upstream, name: data if name == "I back" else None)
    monkeypatch.setattr(
        flank_excitation, "excitation_of_flanks",
        lambda flanks, load, forward: asked.append((flanks, forward)) or spring(load, 1),
    )  # fmt: skip
    monkeypatch.setattr(
        mesh_excitation, "mesh_excitation", lambda one, load: asked.append(one.name) or spring(load, None)
    )
    mesh = SimpleNamespace(pair=SimpleNamespace(reversed=lambda: "turned round"))
    teeth = SimpleNamespace(back="I back", halves=2)
    upstream = {Task("loaded-flanks", "I back"): 1} if wide else {}
    pair, stiffness = gear_train._back(mesh, teeth, 300.0, upstream, forward=forward)
    assert pair == (mesh.pair if forward else "turned round")
    assert stiffness == (("total", 75.0, 2) if wide else ("total", 150.0, None))
    assert asked == [(("flanks", "I back"), forward)] if wide else asked == ["as named" if forward else "reversed"]
    if not wide:
        assert gear_train._back(mesh, teeth, 0.0, upstream, forward=forward)[1] == ("total", 70.0, None)


def test_a_mesh_is_as_doubtful_as_its_coarser_flanks_say_under_its_load():
    def side(stiffness):
        lines = SimpleNamespace(mean=lambda values: float(np.mean(values)))
        return SimpleNamespace(lines=lines, contact=SimpleNamespace(stiffness=np.array(stiffness)))

    fine, coarse = side([[9.0, 2.0], [9.0, 6.0]]), side([[9.0, 4.0], [9.0, 4.0]])
    error = SimpleNamespace(coarse=coarse, peak_to_peak=np.array([8.0, 5.0]))
    found = gear_train._doubt(SimpleNamespace(at=1, found=fine, error=error), 2)
    assert found == (pytest.approx(2.0 * (4.0 - 3.0)), 5.0)  # harmonic means 3 and 4


# ---- root stress on the face -----------------------------------------------------------------------------------------
@dataclass
class Roots:
    """Stress that is five times what the flanks come closer, more by each place."""

    share = 0.01

    def largest(self, closer):
        tension = 5.0 * np.asarray(closer) + np.arange(3.0) + 1.0
        return SimpleNamespace(tension=tension, z=tension + 100.0)


@pytest.mark.parametrize("drives", [True, False])
def test_stress_on_the_face_is_that_of_all_pairs_of_its_own_and_without_vibration(monkeypatch, drives):
    asked = []
    error = SimpleNamespace(
        static=np.array([1.0, 2.0, 3.0]), own=np.array([4.0, 4.0, 4.0]), with_others=np.array([2.0, 5.0, 9.0]),
        cross_least=np.array([[-1.0, -1.0, -1.0]]), cross_reach=np.array([[2.0, 0.0, 1.0], [1.0, 0.0, 3.0]]),
    )  # fmt: skip
    monkeypatch.setattr(stress_on_face, "tooth_force", lambda *given, **more: asked.append((given, more)) or error)
    known = SimpleNamespace(at=lambda x, mirrored: asked.append((x, mirrored)) or Roots())
    made = SimpleNamespace(a_drives=drives, pair=SimpleNamespace(base_pitch=8e-3))
    train = SimpleNamespace(
        meshes={2: made}, train="train", errors="errors", speed_ratio=4.0, phases="phases", ripple="ripple"
    )
    x = np.array([0.1, 0.2, 0.3])
    found = stress_on_face.stress_on_face(train, 2, known, x, 200.0, 7)
    assert asked[0] == (x, not drives) or (asked[0][0] is x and asked[0][1] == (not drives))
    given, more = asked[1]
    assert given[:4] == ("train", "errors", 2, 50.0)
    assert given[4] is x
    assert (given[5].tolist(), given[6].tolist(), given[7]) == ([1.0] * 3, [0.0] * 3, 8e-3)
    assert more == {"harmonics": 7, "phases": "phases", "ripple": "ripple"}
    by_place = np.array([1.0, 2.0, 3.0])
    total, static, own = (5.0 * np.array(v) + by_place for v in ([1.0, 3.0, 6.0], [0.0] * 3, [4.0] * 3))
    ends = [5.0 * (4.0 + np.array(v)) + by_place for v in ([-1.0] * 3, [3.0, 0.0, 4.0])]
    parts = [np.asarray(one) for one in vars(found).values()]
    for wanted in (
        total,
        np.maximum.reduce([total, *ends]),
        own,
        static,
        0.01 * own.max() * np.ones(()),
        total + 100.0,
        static + 100.0,
    ):
        assert any(one.shape == wanted.shape and np.allclose(one, wanted) for one in parts)
    np.testing.assert_allclose(
        [vars(found)[k] for k in list(vars(found))[:4]], [total, np.maximum.reduce([total, *ends]), own, static]
    )


@pytest.mark.parametrize(("halves", "force", "load"), [(1, 600.0, 600.0), (2, 600.0, 300.0), (1, 0.0, 55.0)])
def test_roots_on_the_face_are_those_about_the_mean_force_of_one_half(monkeypatch, halves, force, load):
    asked, fractions = [], []
    teeth = SimpleNamespace(nominal=55.0)
    monkeypatch.setattr(dynamic_root_stress, "loaded_teeth", lambda upstream, pair: teeth if pair == "I" else None)
    monkeypatch.setattr(dynamic_root_stress, "solid_solution_of", lambda upstream, gear: f"solved {gear}")
    monkeypatch.setattr(roots_about_load, "roots_about_load", lambda *given: given)
    monkeypatch.setattr(stress_on_face, "stress_on_face", lambda *given: asked.append(given) or len(asked))
    train = SimpleNamespace(meshes={3: SimpleNamespace(force=force)})
    data = SimpleNamespace(train=train, mesh=3, force=SimpleNamespace(x="x"), harmonics=9)
    given = SimpleNamespace(
        pair="I", halves=halves, gears={"driver": "p", "driven": "w"}, speed=70.0, wide=True, mesh="m"
    )
    work = SimpleNamespace(progress=fractions.append)
    found = dynamic_root_stress._compute(given, {Task("tooth-force", "m"): data}, work)
    assert [one[2] for one in asked] == [(teeth, "driver", "solved p", load), (teeth, "driven", "solved w", load)]
    assert all((one[0], one[1], *one[3:]) == (train, 3, "x", 70.0, 9) for one in asked)
    assert [list(of.values()) for of in found.stress.values()] == [[1], [2]]
    assert fractions == [0.5, 1.0]


# ---- evaluation ranges of measured flanks ----------------------------------------------------------------------------
def measured_scene(part=None):
    gears = {"p": PAIR.driver, "w": PAIR.driven}
    case = SimpleNamespace(pair={"I": SimpleNamespace(driver="p", driven="w")})
    return SimpleNamespace(gears=gears, pairs={"I": PAIR}, case=case, given=part)


@pytest.mark.parametrize("name", ["p", "w"])
def test_profiles_are_judged_from_where_contact_starts_to_near_the_tip(monkeypatch, name):
    monkeypatch.setattr(measured_flanks, "_given", lambda scene, name: (scene.given, f"gear.{name}.measured"))
    monkeypatch.setattr(measured_flanks, "profile_range", lambda start, end: (start, end))
    scene = measured_scene()
    gear, member = scene.gears[name], "driver" if name == "p" else "driven"
    low, high = measured_flanks._profile_ends(scene, name)
    starts = min(float(PAIR.roll_angle(x, member)) for x in (PAIR.x_start, PAIR.x_end))
    assert low == pytest.approx(gear.base_radius * starts)
    assert high == pytest.approx(gear.base_radius * max(gear.tooth.involute.start, gear.tooth.involute.end))
    scene.pairs = {}
    alone, _ = measured_flanks._profile_ends(scene, name)
    assert alone == pytest.approx(gear.base_radius * min(gear.tooth.involute.start, gear.tooth.involute.end))
    given = [1.02 * gear.base_radius, 1.01 * gear.base_radius]
    found = measured_flanks._profile_ends(measured_scene(SimpleNamespace(profile_range=given)), name)
    assert found == pytest.approx(tuple(gear.base_radius * math.sqrt(k**2 - 1.0) for k in (1.01, 1.02)))
    for inside in (0.999, 0.5):
        given[0] = inside * gear.base_radius
        with pytest.raises(InputError, match="inside the base circle"):
            measured_flanks._profile_ends(measured_scene(SimpleNamespace(profile_range=given)), name)


def test_leads_are_judged_where_it_is_said_or_within_the_ends_of_the_face(monkeypatch):
    monkeypatch.setattr(measured_flanks, "_given", lambda scene, name: (scene.given, "key"))
    monkeypatch.setattr(measured_flanks, "helix_range", lambda width, module: ("usual", width, module))
    for part in (None, SimpleNamespace(lead_range=None)):
        assert measured_flanks._lead_ends(measured_scene(part), "p") == ("usual", 0.02, 2e-3)
    part = SimpleNamespace(lead_range=[-3e-3, 5e-3])
    assert measured_flanks._lead_ends(measured_scene(part), "p") == (-3e-3, 5e-3)


# ---- a variant of a sizing -------------------------------------------------------------------------------------------
@pytest.mark.parametrize(("torques", "te"), [(None, 3e-6), ([50.0, 100.0], 7e-6), ([100.0], 5e-6)])
def test_a_variant_has_the_larger_root_stress_and_the_largest_error_of_its_own_torques(monkeypatch, torques, te):
    @dataclass(frozen=True)
    class Scene:
        case: object
        estimates: bool = True

    asked = {}
    given = None if torques is None else SimpleNamespace(array=np.array(torques))
    scene = Scene(SimpleNamespace(pair={by_fe.PAIR: SimpleNamespace(torques=given)}))
    monkeypatch.setattr(by_fe, "build_scene", lambda *parts, **more: asked.update(built=parts, **more) or scene)

    def value(name, si, error):
        return SimpleNamespace(name=f"{by_fe.PAIR}.{name}", si=si, si_error=error)

    def column(name, *values):
        return SimpleNamespace(name=name, si=values)

    tables = [
        SimpleNamespace(name="another", columns=[]),
        SimpleNamespace(name=f"transmission_error_summary_{by_fe.PAIR}", columns=[
            column("driver_torque", 50.0, 75.0, 100.0), column("te_peak_to_peak", 7e-6, 9e-6, 5e-6),
        ]),
    ]  # fmt: skip
    results = SimpleNamespace(tables=tables, values=[
        value("te_peak_to_peak", 3e-6, 1e-8), value("driver.largest_root_tension", 2e8, None),
        value("driven.largest_root_tension", 3e8, 1e6),
    ])  # fmt: skip
    monkeypatch.setattr("fegear.engine.plan.make_plan", lambda scene, stages: ("plan", scene.estimates))
    monkeypatch.setattr(
        "fegear.engine.run.run_plan",
        lambda scene, plan, cache, executor: asked.update(plan=plan, cache=cache, here=executor.here) or results,
    )  # fmt: skip
    found = by_fe.compute_variant({"document": "d", "folder": "f", "estimates": False}, "cache")
    assert found == {"te": te, "te_error": 1e-8, "root_stress": 3e8, "root_stress_error": 1e6}
    assert (asked["plan"], asked["cache"], asked["here"], asked["bare_si"]) == (("plan", False), "cache", True, True)
    assert asked["built"][:2] == ("d", "variant")
    results.values[1].si = 4e8
    again = by_fe.compute_variant({"document": "d", "folder": "f", "estimates": True}, "cache")
    assert again["root_stress"] == 4e8
    assert math.isnan(again["root_stress_error"])
    assert asked["plan"] == ("plan", True)


# ---- planetary sets with odd teeth -----------------------------------------------------------------------------------
@pytest.mark.parametrize(("odd", "pitches"), [((), 1), (("sun",), 20), (("sun", "planet"), 60)])
def test_a_set_takes_as_long_as_the_base_pitches_until_its_odd_teeth_meet_again(monkeypatch, odd, pitches):
    gears = {"sun": SimpleNamespace(teeth=20), "planet": SimpleNamespace(teeth=30)}
    scene = SimpleNamespace(gears=gears)

    def of_set(answer):
        def fake(given, name):
            assert (given, name) == (scene, "P")
            return answer

        return fake

    for place in (planet_revolution, planet_vibration_revolution):
        monkeypatch.setattr(place, "odd_gears_of_set", of_set(odd))
    monkeypatch.setattr(planet_vibration_revolution, "planetary_part", of_set(SimpleNamespace(count=3)))
    static = planet_revolution._forecast(scene, "P")
    assert static.settings == {"base pitches": pitches}
    moving = planet_vibration_revolution._forecast(scene, "P")
    assert moving.settings == {"base pitches": pitches, "planets": 3}
    for place in (planet_revolution, planet_vibration_revolution):
        monkeypatch.setattr(place, "odd_gears_of_set", of_set(()))
    monkeypatch.setattr(planet_vibration_revolution, "planetary_part", of_set(SimpleNamespace(count=1)))
    one = planet_revolution._forecast(scene, "P").seconds
    assert static.seconds - one == pytest.approx((pitches - 1) * planet_revolution._PITCH)
    assert moving.seconds == pytest.approx(3 * pitches * planet_vibration_revolution._forecast(scene, "P").seconds)


@pytest.mark.parametrize("given", [None, "given"])
def test_planets_have_given_springs_or_those_of_their_own_teeth(monkeypatch, given):
    engagement, shifted = "engagement", ("one more", "one less")
    pair = SimpleNamespace(engagement=engagement, shifted=shifted)
    for place in (planet_revolution, planet_vibration_revolution):
        monkeypatch.setattr(place, "pair_over_revolution", lambda upstream, name: pair if name == "P sun" else None)
        monkeypatch.setattr(place, "set_pair", lambda name, mesh: f"{name} {mesh}")
    monkeypatch.setattr(planet_revolution, "given_or_wide_teeth", lambda asked, mesh, upstream: given)
    monkeypatch.setattr(planet_vibration_revolution, "given_or_wide_springs", lambda asked, mesh, upstream: given)
    monkeypatch.setattr(planet_revolution, "mean_force", lambda model, torque: (model.count, torque))
    monkeypatch.setattr("fegear.dynamics.planetary.mesh_law.LawSprings", lambda *parts: parts)
    monkeypatch.setattr("fegear.dynamics.train.mesh_excitation.mesh_excitation", lambda one, force: (one, force))
    asked = SimpleNamespace(name="P", model=SimpleNamespace(count=3), sun_torque=40.0)
    inputs = SimpleNamespace(
        asked=asked, name="P", of_planets=lambda mesh, both, make: (mesh, make(tuple(both))),
    )  # fmt: skip
    laws = planet_revolution._laws(inputs, "sun", {})
    springs = planet_vibration_revolution._teeth(inputs, "sun", 70.0, {})
    if given:
        assert (list(laws), list(springs)) == (["given"] * 3, ["given"] * 3)
    else:
        assert laws == ("sun", (engagement, shifted, (3, 40.0), 3))
        assert springs == ("sun", (engagement, 70.0))


# ---- names on the scheme of a gearbox --------------------------------------------------------------------------------
def body(outer, inner, z=(0.1, 0.3), name="gear", shaft="s"):
    ends = np.asarray(z)
    return SimpleNamespace(
        name=name, shaft=shaft, z=ends, outer=np.full(ends.size, outer) if np.isscalar(outer) else np.asarray(outer),
        inner=np.full(ends.size, inner),
    )  # fmt: skip


def test_a_name_stands_on_its_gear_where_there_is_room_and_else_past_its_face():
    letter = 0.01
    wide = letter * 5.0  # "gear" and a letter more
    along, across = _of_gear(body(0.12, 0.02), 0.03, letter, upright=True)
    assert (along, across) == (pytest.approx(0.2), pytest.approx(0.075))
    along, across = _of_gear(body(0.07, 0.02), 0.03, letter, upright=True)  # 40 mm for 50 mm
    line = (along - 0.3) / 0.6
    assert 0.0 < line < 0.03
    assert across == pytest.approx(0.03 + 0.5 * wide)
    assert _of_gear(body(0.07, 0.02), 0.03, letter, upright=False) == (pytest.approx(0.2), pytest.approx(0.05))
    along, across = _of_gear(body(0.03 + 0.9 * line, 0.02), 0.03, letter, upright=False)
    assert (along, across) == (pytest.approx(0.3 + 0.5 * wide), pytest.approx(0.03 + 0.6 * line))
    # A ring's inner radius counts where it is larger than the shaft.
    assert _of_gear(body(0.2, 0.1), 0.03, letter, upright=True)[1] == pytest.approx(0.15)


def test_a_shaft_is_boxes_of_its_pieces_without_those_of_no_length():
    one = body((0.02, 0.03, 0.03, 0.01), 0.0, (0.0, 0.1, 0.1, 0.4))
    boxes = _pieces(one, {"s": 0.7}, {"s": 1.0})
    assert boxes == [
        [pytest.approx(1.05), 0.7, pytest.approx(0.1), 0.06], [pytest.approx(1.25), 0.7, pytest.approx(0.3), 0.06]
    ]  # fmt: skip


# ---- modes of two parameters beside those of the whole mesh ----------------------------------------------------------
@pytest.mark.parametrize(
    ("own", "full", "mode", "change"),
    [
        ([0.0, 10.0, 20.0], [0.0, 11.0, 25.0], 3, "+25 %"), ([0.0, 10.0, 20.0], [0.0, 8.0, 21.0], 2, "−20 %"),
        ([0.0, 10.0, 20.0], [5.0, 11.0, 0.0], 2, "+10 %"),  # what moves freely in one of both is no change
        ([0.0, 10.0], [3.0, 0.0], 0, ""), ([4.0, 10.0], [], 0, ""),
    ],
)  # fmt: skip
def test_the_frequency_that_one_kappa_changes_most_is_said(own, full, mode, change):
    own, full = 2.0 * np.pi * np.array(own), 2.0 * np.pi * np.array(full)
    data = SimpleNamespace(modes=SimpleNamespace(frequency=own), full=full)
    said = transmissibility._two_parameters(SimpleNamespace(name="I", data=SimpleNamespace(data=data)))
    assert len(said) == bool(mode)
    for one in said:
        assert (
            f"change by up to {change.replace('−', '-')} (mode {mode}, {own[mode - 1] / (2.0 * np.pi):.5g} Hz)" in one
        )
