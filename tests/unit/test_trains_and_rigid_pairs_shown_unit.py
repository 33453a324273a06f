"""Trains and helical pairs of rigid gears: ripple of torques, losses, increments, models and drawn modes, by hand."""

from __future__ import annotations

import math
from fractions import Fraction
from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.built import torque_ripple
from fegear.case.transmissibility import FollowPart, MeshStiffnessPart, NumbersPart, RigidGearPart
from fegear.dynamics.helical_pair.model import HelicalPairModel, ReducedPairModel
from fegear.engine.stage import Task
from fegear.results.helical import mode_shapes
from fegear.results.pair.train_power_loss import TrainLossInputs, _compute_train
from fegear.results.train.dynamic_increments import Difference, Increment, IncrementsData


# ---- ripple of torques -----------------------------------------------------------------------------------------------
def ripple_part(**given) -> Space:
    usual = {"body": "motor", "order_of": None, "file": None, "amplitude": None, "amplitude_over_mean": None,
             "phase": 0.25, "frequency": None, "order": 2, "harmonics": 3}  # fmt: skip
    return Space(**usual | given)


#: The machine turns 2/5 as fast as the motor, and the other way.
TRAIN = Space(
    torques=(Space(body="motor", value=30.0), Space(body="motor", value=10.0), Space(body="machine", value=-100.0)),
    exact_ratios=(Fraction(1), Fraction(-2, 5)), dof={"motor": 0, "machine": 1},
)  # fmt: skip


def ripples(**parts):
    part = Space(torque_ripple={name: ripple_part(**given) for name, given in parts.items()})
    return torque_ripple.torque_ripples(Space(file=lambda file, _key: file), part, TRAIN)


def test_a_harmonic_has_its_size_its_phase_and_its_order_of_the_first_shaft():
    (one, two, three, four), means = ripples(
        a={"amplitude": 8.0}, b={"amplitude_over_mean": 0.2}, c={"amplitude": 8.0, "frequency": 50.0, "phase": 1.0},
        d={"body": "machine", "amplitude_over_mean": 0.05, "order": 0.5},
    )  # fmt: skip
    assert means == {}
    assert (one.name, one.body, one.amplitudes, one.phases, one.order) == ("a", "motor", (8.0,), (0.25,), (2, 1))
    assert (two.amplitudes, two.phases) == ((pytest.approx(8.0),), (0.25,))  # of 40 N m
    assert (three.frequency, three.order, three.phases) == (50.0, None, (1.0,))
    # half an order of the machine is a fifth of one of the motor; a braking torque swings against its sign
    assert (four.amplitudes, four.order) == ((pytest.approx(5.0),), (1, 5))
    assert four.phases == (pytest.approx(0.25 + math.pi),)
    (other,), _ = ripples(e={"amplitude": 1.0, "order_of": "machine", "order": 5})
    assert other.order == (2, 1)
    assert ripples(f={"amplitude": 0.0}) == ((), {})
    with pytest.raises(InputError, match="refers to the constant torque of body wheel, which has none"):
        ripples(g={"body": "wheel", "order_of": "motor", "amplitude_over_mean": 0.1})


def test_a_file_is_one_period_of_an_angle_or_of_time(monkeypatch):
    angle, torque = 2.0 * math.pi * np.array([0.0, 0.125, 0.25, 0.5]), np.array([10.0, 14.0, 10.0, 10.0])
    columns = {}

    class Columns(dict):
        has = "some"

    def columns_of(_file, key, _kinds):
        assert key == "train.torque_ripple.a.file"
        return Columns(columns)

    monkeypatch.setattr("fegear.case.csv_file.read_columns", columns_of)
    columns |= {"angle": angle, "torque": torque}
    (found,), means = ripples(a={"file": "t.csv", "body": "machine"})
    assert means == {"a": pytest.approx(11.0)}  # a triangle of 4 N m over half of the period
    assert found.order == (4, 5)  # twice per turn of the machine
    assert len(found.amplitudes) == 3
    columns.clear()
    columns |= {"time": np.array([0.0, 0.005, 0.01, 0.02]), "torque": torque}
    (found,), means = ripples(a={"file": "t.csv"})
    assert (found.order, found.frequency, means["a"]) == (None, pytest.approx(50.0), pytest.approx(11.0))
    with pytest.raises(InputError, match="is not used with torques over time"):
        ripples(a={"file": "t.csv", "order_of": "machine"})
    columns["torque"] = torque + np.array([0.0, 0.0, 0.0, 0.0041])
    with pytest.raises(InputError, match="not a full period"):
        ripples(a={"file": "t.csv"})
    columns["torque"] = torque + np.array([0.0, 0.0, 0.0, 0.0039])
    assert len(ripples(a={"file": "t.csv"})[0]) == 1
    for wrong, said in (
        ({"angle": angle, "time": angle, "torque": torque}, "one of them"), ({"time": angle}, "one of them"),
        ({"angle": angle[:2], "torque": torque[:2]}, "at least 3 lines"),
        ({"angle": angle[[0, 2, 2, 3]], "torque": torque}, "strictly increasing"),
    ):  # fmt: skip
        columns.clear()
        columns |= wrong
        with pytest.raises(InputError, match=said):
            ripples(a={"file": "t.csv"})


# ---- losses of trains ------------------------------------------------------------------------------------------------
def test_a_mesh_loses_the_share_of_its_pair_and_the_train_the_sum():
    def pair(loss, error, factor, friction):
        found = Space(loss=loss, transmitted=1000.0, loss_factor=factor, mean_coefficient=friction)
        return Space(found=found, error=error)

    asked = TrainLossInputs(("I", "II", "I"), (2000.0, 1500.0, 0.0), 2500.0, (), ("1", "2", "3"))
    upstream = {
        Task("gear-mesh-power-loss", "I"): pair(10.0, 0.01, 0.15, 0.05),
        Task("gear-mesh-power-loss", "II"): pair(20.0, 0.02, 0.25, 0.06),
    }
    found = _compute_train(asked, upstream, None)
    np.testing.assert_allclose(found.loss, [20.0, 30.0, 0.0])
    np.testing.assert_allclose(found.factor, [0.15, 0.25, 0.15])
    np.testing.assert_allclose(found.friction, [0.05, 0.06, 0.05])
    np.testing.assert_allclose(found.efficiencies, [0.99, 0.98, 1.0])
    np.testing.assert_array_equal(found.place, [0.0, 1.0, 2.0])
    assert (found.whole_loss, found.efficiency) == (pytest.approx(50.0), pytest.approx(0.98))
    assert found.error == pytest.approx(20.0 * 0.01 + 30.0 * 0.02)


# ---- increments ------------------------------------------------------------------------------------------------------
def test_an_increment_has_its_largest_modulus_and_room_above_it():
    frequency = np.array([10.0, 20.0, 40.0])
    one = Increment("a", "b", "series:1", frequency, np.array([3.0 + 4.0j, -10.0, 0.0]), None, None)
    np.testing.assert_allclose(one.modulus, [5.0, 10.0, 0.0])
    assert (one.largest, one.resonance, one.top) == (10.0, 20.0, pytest.approx(11.5))
    assert one.log_limits == pytest.approx((2.5, 23.0))
    none = Increment("a", "b", "", frequency, np.zeros(3, dtype=complex), None, None)
    assert (none.top, none.log_limits) == (1.0, (0.5, 2.0))
    off = Difference("key", "words", frequency, np.array([0.1, 0.05, 0.2]))
    assert (off.largest, off.worst) == (0.2, 40.0)


def test_increments_are_named_by_their_mesh_and_what_excites_it():
    q = np.arange(8.0).reshape(2, 2, 2) + 0j
    high = 10.0 * q
    high[0, 1] = 0.0  # bodies that nothing joins
    peaks = (Space(mesh=1, source=0), Space(mesh=0, source=1))
    data = IncrementsData(Space(names=("a", "b")), np.array([1.0, 2.0]), q, 5.0 * q, high, peaks)
    assert [(one.first, one.second, one.role) for one in data.pairs] == [
        ("a", "a", "series:0"), ("a", "b", "series:1"), ("b", "a", "series:0"), ("b", "b", "series:1")
    ]  # fmt: skip
    for one, at in zip(data.pairs, ((0, 0), (0, 1), (1, 0), (1, 1)), strict=True):
        np.testing.assert_array_equal(one.q, q[at])
        np.testing.assert_array_equal(one.low, 5.0 * q[at])
        assert (one.high is None) == (at == (0, 1))
    np.testing.assert_array_equal(data.pairs[2].high, high[1, 0])
    assert data.peak_names.tolist() == ["Q_b_a", "Q_a_b"]
    assert data.determinants is None
    bare = IncrementsData(Space(names=("a", "b")), np.array([1.0, 2.0]), q, None, None)
    assert {(one.low, one.high) for one in bare.pairs} == {(None, None)}


# ---- rigid pairs -----------------------------------------------------------------------------------------------------
def test_rigid_gears_have_their_numbers_in_their_places():
    known = {"mass": 2.0, "inertia_x": 3.0, "inertia_y": 4.0, "inertia_z": 5.0, "base_radius": 0.05,
             "half_face_width": 0.01}  # fmt: skip
    part = RigidGearPart(mass="7 kg", bearing={"y": "1 N/um", "z": "2 N/um", "theta_x": "3 N*m/rad",
                                               "theta_y": "4 N*m/rad"})  # fmt: skip
    gear = part.filled(known).build()
    assert (gear.mass, gear.inertia, gear.base_radius, gear.half_face_width) == (7.0, (3.0, 4.0, 5.0), 0.05, 0.01)
    np.testing.assert_allclose(gear.bearing_stiffness, np.diag([1e6, 2e6, 3.0, 4.0, 0.0]))
    np.testing.assert_array_equal(gear.bearing_damping, np.zeros((5, 5)))
    matrix = (np.arange(25.0).reshape(5, 5) + np.arange(25.0).reshape(5, 5).T + 200.0 * np.eye(5)).tolist()
    gear = RigidGearPart(bearing={"matrix": matrix}, damping=matrix).filled(known).build()
    np.testing.assert_array_equal(gear.bearing_stiffness, matrix)
    np.testing.assert_array_equal(gear.bearing_damping, matrix)


def test_contact_is_uniform_to_one_end_where_its_rotary_stiffness_is_not_given():
    mesh = MeshStiffnessPart(stiffness="300 N/um", kappa=0.4, base_helix_angle="20 deg").build()
    # a load of equal length from -0.2 to 1: its middle is at 0.4, its second moment about 0 over its length
    assert mesh.mu == pytest.approx((1.0**3 + 0.2**3) / 3.0 / 1.2)
    assert (mesh.stiffness, mesh.kappa, mesh.base_helix_angle) == pytest.approx((3e8, 0.4, math.radians(20.0)))
    assert MeshStiffnessPart(stiffness="300 N/um", kappa=0.4, mu=0.5).build().mu == 0.5


def test_ranges_are_even_in_steps_or_in_ratios():
    np.testing.assert_allclose(NumbersPart(start=1.0, stop=16.0, count=4).array, [1.0, 6.0, 11.0, 16.0])
    part = {"start": 1.0, "stop": 16.0, "count": 5, "spacing": "logarithmic"}
    np.testing.assert_allclose(NumbersPart(**part).array, [1.0, 2.0, 4.0, 8.0, 16.0])
    assert NumbersPart(start=-1.0, stop=1.0).array.size == 61
    found = FollowPart(mu=part, alpha_z=part).ranges
    assert list(found) == ["alpha_z", "mu"]
    for wrong in ({"start": 1.0, "stop": 1.0}, {"start": 0.0, "stop": 1.0, "spacing": "logarithmic"}):
        with pytest.raises(Exception, match="must be greater"):
            NumbersPart(**wrong)


# ---- drawn modes -----------------------------------------------------------------------------------------------------
def test_the_motion_of_both_gears_is_over_its_largest():
    shape = np.array([1.0, 2.0, -4.0, 0.5, 3.0])
    both = mode_shapes._both(object.__new__(ReducedPairModel), shape)
    np.testing.assert_allclose(both, np.array([shape, [-1.0, -2.0, 4.0, 0.5, 3.0]]) / 4.0)  # its image in the mesh
    ten = np.arange(-3.0, 7.0)
    np.testing.assert_allclose(mode_shapes._both(object.__new__(HelicalPairModel), ten), ten.reshape(2, 5) / 6.0)
    modes = Space(ratio=np.array([0.0, 0.5, 1.25]), normal=np.array([0.0, 0.1, 0.2]), shapes=np.eye(5)[:, :3])
    motions = mode_shapes.mode_motions(object.__new__(ReducedPairModel), modes)
    titles = [one.title for one in motions]
    assert titles == ["mode 2, Λ = 0.5, Δ_{η} = 0.1", "mode 3, Λ = 1.25, Δ_{η} = 0.2"]
    np.testing.assert_array_equal(motions[0].driver, [0.0, 1.0, 0.0, 0.0, 0.0])
    np.testing.assert_array_equal(motions[0].driven, [0.0, -1.0, 0.0, 0.0, 0.0])
    np.testing.assert_array_equal(motions[0].place, np.arange(5.0))


def test_base_circles_touch_the_line_of_action_on_either_side_and_move_with_the_mode():
    shape = np.array([[0.5, 0.0, 0.0, 0.0, 1.0], [-1.0, 0.0, 0.0, 0.0, 0.25]])
    panel = mode_shapes._drawing(shape, "title", (2.0, 3.0))
    line, *rest = panel.items
    np.testing.assert_allclose([line.x, line.y], [[2.0, 2.0], [-2.0, 0.8 * 5.0 + 3.0]])
    assert (panel.title, panel.equal, len(rest)) == ("title", True, 8)
    size = 0.35 * 2.0
    gears = (((0.0, 0.0), 2.0, 0.0, shape[0]), ((5.0, 4.0), 3.0, math.pi, shape[1]))
    for g, ((x, y), radius, towards, motion) in enumerate(gears):
        for m, moved in enumerate((0.0, 1.0)):
            circle, arm = rest[4 * g + 2 * m : 4 * g + 2 * m + 2]
            up = y + size * motion[0] * moved
            np.testing.assert_allclose(np.hypot(circle.x - x, circle.y - up), radius)
            assert np.ptp(circle.x) == pytest.approx(2.0 * radius, rel=1e-3)
            turn = towards + size * motion[4] / radius * moved
            np.testing.assert_allclose(arm.x, [x, x + radius * math.cos(turn)], atol=1e-12)
            np.testing.assert_allclose(arm.y, [up, up + radius * math.sin(turn)], atol=1e-12)
            names = {(one.name, one.role, one.width) for one in (circle, arm)}
            gear = ("driver", "driven")[g]
            assert names == {(gear, gear, 2.2) if moved else ("at rest", "grey", 1.0)}
    # at rest both arms end on the line of action
    assert [rest[1].x[1], rest[5].x[1]] == pytest.approx([2.0, 2.0])


def test_modes_that_nothing_shows_along_the_axes_are_left_out_unless_all_are_such():
    def motion(title, **at):
        shape = np.zeros((2, 5))
        for key, value in at.items():
            shape[0 if key.startswith("driver") else 1, int(key[-1])] = value
        return mode_shapes.ModeMotion(title, shape)

    model = Space(driver=Space(base_radius=2.0), driven=Space(base_radius=3.0))
    axial = motion("axial", driver_1=1.0, driven_0=0.019)
    seen = [motion("up", driver_0=-0.021, driver_1=1.0), motion("turns", driven_4=0.03, driven_2=1.0)]

    def titles(*motions):
        (figure,) = mode_shapes.mesh_mode_shapes(Space(name="I", data=Space(model=model, motions=list(motions))))
        return [panel.title for panel in figure.panels], figure.panels[0].items[0].x[0]

    assert titles(seen[0], axial, seen[1]) == (["up", "turns"], 2.0)
    assert titles(axial) == (["axial"], 2.0)
    model = object.__new__(ReducedPairModel)
    assert titles(seen[0]) == (["up"], 1.0)
