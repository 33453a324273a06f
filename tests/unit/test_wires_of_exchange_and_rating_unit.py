"""Lines between formulas and those who ask, on inputs made up: shifts of REXS, rated flanks, harmonics, processes."""

import math
from dataclasses import dataclass
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.base.notes import NoteClass, class_of
from fegear.case.built import tooth_influence
from fegear.contact.wide import load_factors, over_pitch, rated, root_stress
from fegear.contact.wide.load_factors import FactorsLeft, RootFactors
from fegear.contact.wide.rated import SolvedFlanks, computed_flanks
from fegear.engine import processes
from fegear.exchange.rexs import model_to_case
from fegear.exchange.rexs.model_to_case import _height, _rest_of_shift, _roman
from fegear.formulas.iso6336 import safety
from fegear.geometry.involute import inv
from fegear.results.helical import pair_forced_response
from fegear.results.rating import rating
from fegear.results.train import motion

HELIX, NORMAL, MODULE = math.radians(15.0), math.radians(22.0), 3e-3


@pytest.fixture
def gears(monkeypatch):
    """A pinion of 19, wheels of 47 and a ring of -85 teeth: `shift` and `distance` say what is known."""

    @dataclass(frozen=True)
    class One:
        id: int
        teeth: int
        type: str = "cylindrical_gear"

    def stage(*two, internal=False):
        return SimpleNamespace(gears=two, internal=internal, component=SimpleNamespace(said="stage 1"))

    known = SimpleNamespace(shift={}, distance={}, angle=NORMAL)
    one, two, ring = One(1, 19), One(2, 47), One(3, -85, "ring_gear")
    numbers = {"helix_angle_reference_diameter": HELIX, "normal_pressure_angle": NORMAL}
    said = SimpleNamespace(number=lambda component, kind, name: numbers.get(name))
    monkeypatch.setattr(model_to_case, "profile_shift", lambda said, gear: known.shift.get(gear.id))
    monkeypatch.setattr(model_to_case, "distance_of", lambda said, stage: known.distance.get(stage.internal))
    monkeypatch.setattr(model_to_case, "teeth_of", lambda said, gear: gear.teeth)
    monkeypatch.setattr(model_to_case, "flank_of", lambda said, gear: "flank")
    monkeypatch.setattr(model_to_case, "module_of", lambda said, gear: MODULE)
    stages = [stage(two, ring, internal=True), stage(one, two)]
    return SimpleNamespace(known=known, said=said, numbers=numbers, one=one, two=two, ring=ring, stages=stages)


def distance(teeth, shifts, normal=NORMAL):
    """Centre distance without backlash of external gears, or with differences that of an internal pair."""
    alpha = math.atan(math.tan(normal) / math.cos(HELIX))
    wanted = inv(alpha) + 2.0 * math.tan(normal) * shifts / teeth
    low, high = 1e-3, 1.4
    for _ in range(200):
        middle = 0.5 * (low + high)
        low, high = (middle, high) if inv(middle) < wanted else (low, middle)
    return 0.5 * teeth * MODULE / math.cos(HELIX) * math.cos(alpha) / math.cos(low)


def test_a_gear_with_a_shift_of_its_own_has_no_rest(gears):
    gears.known.shift = {1: 0.3}
    assert _rest_of_shift(gears.said, gears.one, gears.stages) is None
    assert _rest_of_shift(gears.said, gears.two, gears.stages) == 0.0  # no distance is said


def test_the_centre_distance_leaves_a_shift_to_the_gear_that_has_none(gears):
    gears.known.distance = {False: distance(66, 0.7)}
    assert _rest_of_shift(gears.said, gears.two, gears.stages) == pytest.approx(0.35, rel=1e-9)
    gears.known.shift = {1: 0.25}
    assert _rest_of_shift(gears.said, gears.two, gears.stages) == pytest.approx(0.45, rel=1e-9)
    gears.known.shift = {1: 0.0}
    assert _rest_of_shift(gears.said, gears.two, gears.stages) == pytest.approx(0.7, rel=1e-9)
    gears.numbers.pop("normal_pressure_angle")  # 20 degrees where none is said
    gears.known.distance = {False: distance(66, 0.7, math.radians(20.0))}
    assert _rest_of_shift(gears.said, gears.two, gears.stages) == pytest.approx(0.7, rel=1e-9)


def test_a_ring_takes_what_its_planet_s_mesh_with_the_sun_leaves(gears):
    """x_ring + x_planet of signed teeth; that of the planet follows from its mesh with the sun, which comes first."""
    gears.known.distance = {True: distance(38, -0.4), False: distance(66, 0.7)}
    gears.known.shift = {2: 0.2}
    assert _rest_of_shift(gears.said, gears.ring, gears.stages) == pytest.approx(0.2, rel=1e-9)
    gears.known.shift = {1: 0.5}
    assert _rest_of_shift(gears.said, gears.two, gears.stages) == pytest.approx(0.2, rel=1e-9)
    assert _rest_of_shift(gears.said, gears.ring, gears.stages) == pytest.approx(0.2, rel=1e-9)
    only = gears.stages[:1]
    gears.known.shift = {}
    assert _rest_of_shift(gears.said, gears.two, only) == pytest.approx(
        0.4 - _rest_of_shift(gears.said, gears.ring, only), abs=1e-9
    )


def test_a_distance_that_no_teeth_reach_is_refused(gears):
    for wrong in (0.09, -0.1):
        gears.known.distance = {False: wrong}
        with pytest.raises(InputError, match="is too small for the teeth of stage 1"):
            _rest_of_shift(gears.said, gears.two, gears.stages)


def test_stages_are_counted_in_roman_numbers_and_faces_along_the_gearbox():
    assert [_roman(n) for n in (1, 3, 4, 8, 9, 14, 19, 20)] == ["I", "III", "IV", "VIII", "IX", "XIV", "XIX", "XX"]
    assert _height(SimpleNamespace(u=0.5, reversed=False), 0.2) == pytest.approx(0.7)
    assert _height(SimpleNamespace(u=0.5, reversed=True), 0.2) == pytest.approx(0.3)


def test_rated_flanks_hand_their_factors_on(monkeypatch):
    """Root factor: s_3 b m_n / F_t, in the order of the wheels; errors by coarser gears and fewer positions."""
    numbers = {  # solution, member, load: K_Fbeta, K_Falpha, largest tension
        ("fine", "driver", 0): (1.2, 1.1, 3e8), ("fine", "driven", 0): (1.3, 1.05, 2e8),
        ("fine", "driver", 1): (1.4, 1.15, 6e8), ("fine", "driven", 1): (1.5, 1.25, 5e8),
        ("coarse", "driver", 0): (1.2, 1.1, 3.3e8), ("coarse", "driven", 0): (1.3, 1.05, 1.9e8),
    }  # fmt: skip

    class Found:
        def __init__(self, load, gaps, known):
            size = 1.0 if known == "fine" else 1.1
            self.face_load_factor = np.array([1.6, 1.7])[: len(load)] * size
            self.largest_pressure, self.lines, self.known, self.gaps = (
                np.array([1e9, 2e9])[: len(load)],
                "lines",
                known,
                gaps,
            )

    pair = SimpleNamespace(gear=lambda member: SimpleNamespace(module=2e-3 if member == "driver" else 3e-3))
    flanks = SimpleNamespace(pair=pair, solve=Found, points="points")
    influences = {
        "driver": SimpleNamespace(fine=("fine", "driver"), coarse=("coarse", "driver")),
        "driven": SimpleNamespace(fine=("fine", "driven"), coarse=None),
    }
    asked = []

    def rooted_lines(pair, member, lines, body, coupling):
        asked.append((member, body, coupling))
        return member

    def factors(found, perfect, rooted, z, case):
        assert (perfect.gaps, z) == (None, "places")
        left = {"driver": 6e6, "driven": 1e6}[rooted] if found.known == "fine" else 9e9
        return RootFactors(*numbers[found.known, rooted, case], FactorsLeft(7.0, 8.0, left))

    def face_left(points, found):
        assert points == "points"
        return 0.032 * np.ones(found.face_load_factor.size)

    monkeypatch.setattr(root_stress, "rooted_lines", rooted_lines)
    monkeypatch.setattr(over_pitch, "face_left_by_positions", face_left)
    monkeypatch.setattr(
        load_factors, "transverse_left_by_positions", lambda found, _: 0.0102 * np.ones(found.face_load_factor.size)
    )
    monkeypatch.setattr(load_factors, "root_factors", factors)
    monkeypatch.setattr(
        load_factors, "transverse_load_factor",
        lambda found, perfect: np.array([1.02, 1.04])[: found.face_load_factor.size]
        * (1.0 if found.known == "fine" else 0.9),
    )  # fmt: skip
    monkeypatch.setattr(rated, "root_width", lambda pair, member: 0.02 if member == "driver" else 0.03)
    solved = SolvedFlanks(flanks, "gaps", "fine", "coarse", influences, "places", True)
    first, second = computed_flanks(solved, ("driven", "driver"), [(1e4, 9e3), (2e4, 1.8e4)])
    assert asked == [
        ("driver", ("fine", "driver"), True), ("driven", ("fine", "driven"), True),
        ("driver", ("coarse", "driver"), True), ("driven", ("fine", "driven"), True),
    ]  # fmt: skip
    one = first.replacement
    assert (one.K_Hbeta, one.K_Halpha, one.K_Fbeta, one.K_Falpha) == (1.6, 1.02, (1.3, 1.2), (1.05, 1.1))
    assert one.root_factor == pytest.approx((
        2e8 / (1.3 * 1.05) * 0.03 * 3e-3 / 9e3, 3e8 / (1.2 * 1.1) * 0.02 * 2e-3 / 9e3,
    ))  # fmt: skip
    assert second.replacement.root_factor[1] == pytest.approx(6e8 / (1.4 * 1.15) * 0.02 * 2e-3 / 1.8e4)
    assert first.contact_error == second.contact_error == pytest.approx(0.5 * (0.1 + 0.1 + 0.02 + 0.01))
    assert first.bending_error == pytest.approx((0.05 + 0.005, 0.1 + 0.02))
    assert [(found.load, found.pressure) for found in (first, second)] == [(1e4, 1e9), (2e4, 2e9)]


def test_slices_add_what_they_are_known_to_miss(monkeypatch):
    from fegear.fem.solid import slice_laws

    monkeypatch.setattr(slice_laws, "missed_by_slices", lambda tau: {"contact": tau, "root_tension": 0.3})
    asked = SimpleNamespace(pair=SimpleNamespace(driver=SimpleNamespace(twist=0.2)))
    known = rated.Computed(rated.Replacement(K_Hbeta=1.25, K_Halpha=2.0), 0.01, (0.02, 0.04))
    found = rating._with_misses(known, asked)
    assert found.contact_error == pytest.approx(0.01 + 0.5 * 0.2 * (0.2 + 0.5))
    assert found.bending_error == pytest.approx((0.32, 0.34))
    none = rating._with_misses(rated.Computed(rated.Replacement(), 0.01, (0.0, 0.0)), asked)
    assert none.contact_error == 0.01


def test_loads_of_a_rating_are_with_its_factors():
    duty = SimpleNamespace(application_factor=1.5, mesh_load_factor=1.2, tangential=8e3)
    asked = SimpleNamespace(conditions=SimpleNamespace(duty=duty), load=9e3)
    rated_pair = {"K_v": SimpleNamespace(value=1.1)}
    at_base, at_reference = rating._applied(asked, rated_pair, 4e3)
    assert at_reference == pytest.approx(4e3 * 1.5 * 1.2 * 1.1)
    assert at_base == pytest.approx(at_reference * 9.0 / 8.0)


@pytest.mark.parametrize("size", [16, 15])
def test_harmonics_of_even_values_are_those_that_made_them(size):
    at = 2.0 * np.pi * np.arange(size) / size
    values = 3.0 + 2.0 * np.cos(at) - 4.0 * np.sin(2.0 * at)
    found = pair_forced_response._harmonics(values, 1, 3)
    assert found == pytest.approx([2.0, 4.0j, 0.0], abs=1e-12)
    half = pair_forced_response._harmonics(values, 2, 1)
    assert half[0] == pytest.approx(2.0, abs=1e-12 if size % 2 == 0 else 0.5)


def test_harmonics_of_a_pair_come_from_its_own_error():
    """Of a spur pair with their errors; of a helical one the mate's turn over the arm, removal positive."""
    part = SimpleNamespace(transmission_error=SimpleNamespace(harmonics=2, shuttling=False))
    series = SimpleNamespace(coefficients=np.array([9.0, 1.0 + 1.0j, 2.0, 3.0]))
    over = SimpleNamespace(series=[None, series], at=1, shift=SimpleNamespace(amplitude=np.array([0.1, 0.2, 0.3])))

    class Task:
        stage = "transmission-error"

    task = Task()
    asked = SimpleNamespace(excitation=part, flanks="", arm=0.0)
    found, errors = pair_forced_response._pair_harmonics(asked, {task: SimpleNamespace(found=over)})
    assert found.tolist() == [2.0 + 2.0j, 4.0]
    assert errors.tolist() == [0.1, 0.2]
    over.shift = None
    assert pair_forced_response._pair_harmonics(asked, {task: SimpleNamespace(found=over)})[1] is None
    at = 2.0 * np.pi * np.arange(16) / 16
    contact = SimpleNamespace(error=1e-6 * (np.cos(at) + np.cos(7.0 * at)))
    asked.arm, task.stage = 0.5, "tooth-contact"
    found, errors = pair_forced_response._pair_harmonics(asked, {task: SimpleNamespace(contact=contact)})
    assert found == pytest.approx([-0.5e-6, 0.0], abs=1e-18)
    # Of every second of 16 positions the seventh harmonic is the first.
    assert errors == pytest.approx([0.5e-6, 0.0], abs=1e-18)
    asked.excitation = SimpleNamespace(transmission_error=None)
    assert pair_forced_response._pair_harmonics(asked, {task: SimpleNamespace(contact=contact)})[0].size > 2


def test_a_ring_on_pins_says_how_its_teeth_differ():
    support = SimpleNamespace(pins=6, kind="pins", rollers=False)
    each = {"c_self": np.array([[1.0], [2.0], [3.0]]), "root_tension": np.array([[4.0], [5.0], [9.0]])}
    asked = []

    def over_the_teeth(radius, width):
        asked.append((radius, width))
        return each

    influence = SimpleNamespace(
        gear=SimpleNamespace(support=support, involute_radii=(0.1, 0.2), tooth=SimpleNamespace(internal=True)),
        fine=SimpleNamespace(pins=object()),
        over_the_teeth=over_the_teeth, reference_half_width=6e-5,
    )  # fmt: skip
    text, apart = tooth_influence.support_remarks("ring", influence)
    assert asked == [([pytest.approx(0.15)], [6e-5])]
    assert text.startswith("Gear ring: compliance varies over 3 consecutive teeth because of its 6 pins.")
    assert "c_self -50 % to +50 % from the mean" in text
    assert "tension side, -33 % to +50 %" in text
    influence.fine.pins = None
    assert tooth_influence.support_remarks("ring", influence) == (apart,)
    influence.gear.tooth.internal = False  # a planet is in no ring
    assert tooth_influence.support_remarks("ring", influence) == ()
    support.kind = "web"
    assert tooth_influence.support_remarks("ring", influence) == ()
    influence.gear.support = None
    assert tooth_influence.support_remarks("ring", influence) == ()


def test_a_point_that_kills_its_process_fails_and_the_others_are_computed(monkeypatch):
    from concurrent.futures.process import BrokenProcessPool

    tried = []

    def pool(job, todo, workers):
        tried.append((sorted(todo), workers))
        for i in sorted(todo):
            if i == 2:
                raise BrokenProcessPool
            yield i, f"reply {i}"

    monkeypatch.setattr(processes, "_pool", pool)
    found = dict(processes.on_cores(None, {i: f"point {i}" for i in range(9)}, 2))
    assert sorted(found) == list(range(9))
    assert {i: reply for i, reply in found.items() if i != 2} == {i: f"reply {i}" for i in range(9) if i != 2}
    assert not found[2].lasting
    assert "terminated while computing this point" in str(found[2])
    assert tried[0] == (list(range(9)), 2)
    # Those handed out first are looked at by themselves, the rest together.
    assert [todo for todo, workers in tried[1:] if workers == 1] == [[2], [3], [4], [5], [6]]
    assert tried[-1] == ([7, 8], 2)


def test_a_train_without_damping_is_told_which_keys_to_set():
    shaft = SimpleNamespace(name="s", damping=0.0, stiffness=1e5)
    rigid = SimpleNamespace(name="r", damping=0.0, stiffness=math.inf)
    mesh = SimpleNamespace(name="m", damping=2.0)
    train = SimpleNamespace(shafts=[shaft, rigid], meshes=[mesh])
    data = SimpleNamespace(train=train)
    assert motion.undamped(data) == ["train.shaft.s"]
    assert motion._settling(data) == (
        "Vibrations do not decay without damping; set train.shaft.s.damping_ratio (0.01 to 0.1)."
    )
    shaft.damping = 1.0
    assert motion._settling(data).startswith("Increase damping")
    mesh.damping = 0.0
    assert motion.undamped(data) == ["train.mesh.m"]


def test_largest_forces_are_over_mean_ones_and_none_of_meshes_that_carry_nothing():
    data = SimpleNamespace(forces=[200.0, 0.0])
    state = SimpleNamespace(tooth_force=np.array([500.0, 3.0]))
    assert motion._factors(data, state) == [2.5, 0.0]


def test_how_a_motion_settled_is_asked_by_its_method(monkeypatch):
    monkeypatch.setattr(motion, "averaging_remarks", lambda train, states: ["averaged", train, states])
    monkeypatch.setattr(motion, "_unsteady", lambda train, states: ["in time", train, states])
    seen = SimpleNamespace(
        data=SimpleNamespace(train="train", states="states"),
        asked=SimpleNamespace(motion=SimpleNamespace(method="averaging")),
    )
    assert motion._how_it_settled(seen) == ["averaged", "train", "states"]
    assert motion._method(seen) == "averaging"
    seen.asked.motion.method = "integration"
    assert motion._how_it_settled(seen) == ["in time", "train", "states"]
    assert motion._method(seen) is None


@pytest.mark.parametrize(("width", "ratio", "single"), [
    ("plane", 1.999, True), ("plane", 2.0, False), ("plane", 2.6, False), ("solid", 2.6, True),
])  # fmt: skip
def test_a_plane_pair_without_single_contact_is_not_rated_by_what_is_computed(monkeypatch, width, ratio, single):
    for name, made_up in (
        ("inputs_with_shares", lambda inputs, _upstream: inputs), ("given", lambda _asked: "own"),
        ("rated", lambda _asked: "conditions"), ("_computed", lambda *_: ("computed", ())),
        ("bent_ratio", lambda *_: None), ("_standing", lambda *both: both), ("_agma", lambda _: (None, "")),
    ):  # fmt: skip
        monkeypatch.setattr(rating, name, made_up)
    monkeypatch.setattr(safety, "rate_pair", lambda conditions, own: ("rated", conditions, own))
    monkeypatch.setattr(safety, "sn_curves", lambda conditions, own: ("curves", conditions, own))
    asked = SimpleNamespace(width=width, pair=SimpleNamespace(contact_ratio=ratio), levels=())
    for computed in (False, True):
        found = rating._rate(SimpleNamespace(asked=asked, computed=computed), {})
        assert found.formula == ("rated", "conditions", "own")
        assert found.by_computed == (("rated", "conditions", ("computed", "own")) if single and computed else None)
        assert found.why_not == ((rating._NO_SINGLE,) if computed and not single else ())


@pytest.mark.parametrize(("errors", "open_", "says"), [
    ([0.005], None, None), ([0.05, 0.004], False, "mesh refined once for tolerance 1 %"),
    ([0.05, 0.02, 0.004], False, "mesh refined 2 times"), ([0.05], True, "solved for tolerance 1 %"),
    ([0.05, 0.02], True, "(finest allowed) is used although c_next exceeds the tolerance."),
])  # fmt: skip
def test_a_mesh_that_stays_beyond_the_tolerance_is_said_to_exceed_and_one_that_was_refined_is_told(errors, open_, says):
    rounds = [
        SimpleNamespace(error=error, unknowns=100, errors={"c_self": 0.1 * error, "c_next": error}) for error in errors
    ]
    said = tooth_influence._tolerance_remarks("a", SimpleNamespace(rounds=rounds), 0.01)
    assert len(said) == (says is not None)
    for one in said:
        assert says in one
        assert (class_of(one) is NoteClass.BEYOND_TOLERANCE) == open_
