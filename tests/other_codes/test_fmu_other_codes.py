"""The FMU of a mesh, run by fmpy: against fegear's own motion over one revolution, and against what it was made of."""

import math
import shutil
from contextlib import contextmanager

import fmpy
import numpy as np
import pytest
from fmpy.fmi3 import FMU3Slave
from fmpy.validation import validate_fmu
from scipy.integrate import solve_ivp

import fegear
from fegear.base.errors import InputError
from fegear.case.built.train import motion_spec
from fegear.dynamics.motion.motion import simulate
from fegear.dynamics.motion.moving_train import motion_model
from fegear.engine.stage import Task

SPEED = 8000.0 * math.pi / 30.0
CASE = {
    "title": "A mesh in another program",
    "results": ["natural-modes"],
    "gear": {
        "a": {"teeth": 23, "module": "3 mm", "face_width": "10 mm", "bore_radius": "15 mm"},
        "b": {"teeth": 41, "module": "3 mm", "face_width": "10 mm", "bore_radius": "15 mm"},
    },
    "pair": {
        "I": {"driver": "a", "driven": "b", "load": "500 N", "loads": ["250 N", "500 N"],
              "compliance": {"source": "weber-banaschek"}},
    },
    "train": {
        "body": {"motor": {"gears": ["a"]}, "brake": {"gears": ["b"]}},
        "mesh": {"I": {"driver": "motor", "driven": "brake", "damping_ratio": 0.05, "backlash": "20 um",
                       "damping_law": "momentary", "phase": 0.3}},
        "torque": {"motor": f"{500.0 * 1.5e-3 * 23 * math.cos(math.radians(20.0)):.12g} N*m"},
        "balance": "brake",
    },
    "effects": {"contact_loss": True, "parametric": True, "hertz": "load-dependent"},
    "dynamics": {"speeds": [f"{SPEED} rad/s"]},
}  # fmt: skip
pytestmark = pytest.mark.skipif(
    not any(map(shutil.which, ("cc", "gcc", "clang"))), reason="exporting an FMU requires a C compiler."
)


@pytest.fixture(scope="module")
def made(tmp_path_factory):
    results = fegear.run(CASE, progress=False)
    with pytest.warns(UserWarning, match="damping and phase from train.mesh.I"):
        (path,) = results.export(tmp_path_factory.mktemp("fmu"), "fmu")
    return results, path


@contextmanager
def opened(path):
    """The FMU as a function of its inputs: wanted outputs of named values."""
    described = fmpy.read_model_description(path)
    reference = {one.name: one.valueReference for one in described.modelVariables}
    folder = fmpy.extract(path)
    unit = FMU3Slave(guid=described.guid, unzipDirectory=folder, modelIdentifier=described.coSimulation.modelIdentifier)
    unit.instantiate()
    unit.enterInitializationMode()
    unit.exitInitializationMode()

    def ask(wanted, **given):
        unit.setFloat64([reference[name] for name in given], list(given.values()))
        return unit.getFloat64([reference[name] for name in wanted])

    ask.unit = unit
    yield ask
    unit.terminate()
    unit.freeInstance()
    shutil.rmtree(folder)


def test_it_keeps_the_standard(made):
    assert validate_fmu(str(made[1])) == []
    described = fmpy.read_model_description(made[1], validate=True)
    assert described.modelExchange is not None
    assert fmpy.supported_platforms(str(made[1]))[-1] in ("c-code", fmpy.platform_tuple, fmpy.platform)


@pytest.mark.parametrize("kind", ["ModelExchange", "CoSimulation"])
def test_fmpy_turns_it_through_the_teeth_under_both_interfaces(made, kind):
    results, path = made
    data = results.outcomes[Task("gear-train", "")].data
    mesh = data.meshes[0]
    r1, speed = mesh.pair.driver.base_radius, 1.0
    time = np.linspace(0.0, 1.0, 201)
    r2 = mesh.pair.driven.base_radius
    inputs = np.array(
        [(t, speed * t, (r1 * speed * t - 20e-6) / r2) for t in time],
        dtype=[("time", float), ("driver_angle", float), ("driven_angle", float)],
    )
    found = fmpy.simulate_fmu(
        str(path), fmi_type=kind, stop_time=1.0, output_interval=0.005, input=inputs, start_values={"damping": 0.0},
        output=["mesh_force", "approach", "static_transmission_error"],
    )  # fmt: skip
    found = found[np.isin(np.round(found["time"] / 0.005, 6), np.arange(201))]
    held = found["time"] if kind == "ModelExchange" else np.maximum(found["time"] - 0.005, 0.0)  # inputs of a step ago
    phase = 23.0 * speed * held / (2.0 * math.pi) + 0.3
    own = sum(mesh.excitation.tooth_force(j, phase, found["approach"]) for j in range(len(mesh.excitation.stiffness)))
    assert np.ptp(own) > 0.2 * own.mean()
    np.testing.assert_allclose(found["approach"], 20e-6, rtol=1e-9)
    # an input read at the jump of a stiffness may be of either side
    close = np.isclose(found["mesh_force"], own, rtol=1e-9)
    assert close.mean() > 0.99
    np.testing.assert_allclose(
        found["static_transmission_error"], mesh.excitation.approach(500.0, phase), rtol=1e-9, atol=1e-15
    )  # fmt: skip


@pytest.mark.dear
def test_one_revolution_moves_as_in_fegear(made):
    """Bodies that the FMU drives against fegear's own motion, as teeth part and meet again (asked: 1e-3; found: 3e-6).

    fegear takes the phase from the mean turning, the FMU from the driver's momentary angle; its parameter `phase` makes
    up for the difference of some 3e-4 base pitches.
    """
    results, path = made
    data = results.outcomes[Task("gear-train", "")].data
    model = motion_model(motion_spec(results.scene), data, SPEED)
    duration = 2.0 * math.pi / SPEED
    own = simulate(model, duration)
    pair, (j1, j2) = data.meshes[0].pair, data.train.inertia
    r1, r2, force = pair.driver.base_radius, pair.driven.base_radius, data.meshes[0].force
    mean = np.array([SPEED, SPEED * r1 / r2])
    begin = own.angles(np.array([0.0]))[0] * np.array([1.0, -1.0]) * np.sign(data.train.meshes[0].radius_a)

    with opened(path) as ask:

        def answer(wanted, t, y):
            a, b = mean * t + y[:2]
            return ask(
                (wanted,), driver_angle=a, driven_angle=b, driver_speed=mean[0] + y[2], driven_speed=mean[1] + y[3],
                phase=0.3 - 23.0 * y[0] / (2.0 * math.pi),
            )[0]  # fmt: skip

        def rate(t, y):
            off = force - answer("mesh_force", t, y)
            return [*y[2:], r1 * off / j1, -r2 * off / j2]

        found = solve_ivp(
            rate, (0.0, duration), [*begin, 0.0, 0.0], method="DOP853", rtol=1e-8, atol=1e-13, max_step=duration / 1000,
            dense_output=True,
        )  # fmt: skip
        time = np.linspace(0.0, duration, 2001)[1:]
        y = found.sol(time)
        forces = np.array([answer("mesh_force", t, one) for t, one in zip(time, y.T, strict=True)])
    expected, carried = own.approach(time)[:, 0], own.mesh_forces(time)[:, 0]
    assert 0.2 < np.mean(carried == 0.0) < 0.4, "minimum / mean mesh force; negative: loss of"
    # the integrator of this test knows nothing of the moments at which they do
    assert np.abs(r1 * y[0] - r2 * y[1] - expected).max() < 1e-5 * expected.mean()
    # at the steps of the force, where a pair enters stiff, a place within round-off of one is of either side
    assert np.sort(np.abs(forces - carried))[-3] < 1e-5 * force


def test_its_state_is_kept_and_its_inputs_are_checked(made):
    with opened(made[1]) as ask:
        first = ask(("mesh_force",), driver_angle=1e-3, driven_angle=0.0, load=400.0)
        kept = ask.unit.getFMUState()
        ask((), driver_angle=-0.5)
        ask.unit.setFMUState(kept)
        assert ask(("mesh_force",)) == first
        again = ask.unit.deserializeFMUState(ask.unit.serializeFMUState(kept))
        ask.unit.setFMUState(again)
        assert ask(("mesh_force",)) == first
        low, middle, high = (ask(("mesh_force",), load=w)[0] for w in (250.0, 375.0, 500.0))
        assert low != high
        assert middle == pytest.approx(0.5 * (low + high), rel=1e-12)
        back = ask(("mesh_force", "mesh_stiffness"), driver_angle=0.0, driven_angle=1e-3)
        assert back[0] == pytest.approx(back[1] * (20e-6 - 1e-3 * 1.5e-3 * 41 * math.cos(math.radians(20.0))), rel=1e-9)
        assert ask(("mesh_force",), driven_angle=1e-6, driver_speed=3.0) == [0.0]
        with pytest.raises(Exception, match="fmi3SetFloat64 failed"):
            ask((), driver_angle=math.nan)


def test_without_a_compiler_it_is_refused_before_anything_is_solved(monkeypatch, tmp_path, made):
    monkeypatch.setattr(shutil, "which", lambda _name: None)
    with pytest.raises(InputError, match="requires a C compiler; cc, gcc and clang not found; install one"):
        made[0].export(tmp_path / "none", "fmu")


@pytest.mark.dear
def test_a_helical_pair_has_the_stiffness_and_error_of_python_under_every_load(tmp_path):
    """At the rows of the curve; force over approach is linear about the load."""
    gears = {
        name: {"teeth": teeth, "normal_module": "3 mm", "helix_angle": "15 deg", "hand": hand, "face_width": "10 mm"}
        for name, teeth, hand in (("a", 23, "right"), ("b", 41, "left"))
    }
    results = fegear.run(
        {
            "results": ["transmission-error"],
            "gear": gears,
            "pair": {"I": {"driver": "a", "driven": "b", "width": "slices", "loads": ["700 N", "2 kN", "4 kN"]}},
            "load_distribution": {"positions": 13, "panels": 6},
            "accuracy": {"tolerance": 0.1},
        },
        progress=False,
    )
    with pytest.warns(UserWarning, match="no damping specified"):
        (path,) = results.export(tmp_path, "fmu")
    curve = results.outcomes[Task("transmission-error", "I")].data.found
    r1, r2 = curve.pair.driver.base_radius, curve.pair.driven.base_radius
    wanted = ["mesh_stiffness", "static_transmission_error", "mesh_force"]
    with opened(path) as ask:
        for load, torque in zip(curve.loads, curve.driver_torque.tolist(), strict=True):
            angle = curve.driver_angle[1:-1]
            stiffness, te = (
                results.mesh_stiffness(angle, torque=torque),
                results.transmission_error(angle, torque=torque),
            )
            found = np.array([
                ask(wanted, load=load, driver_angle=a, driven_angle=(a * r1 - z - 0.3e-6) / r2)
                for a, z in zip(angle.tolist(), te.tolist(), strict=True)
            ])  # fmt: skip
            np.testing.assert_allclose(found[:, 0], stiffness, rtol=1e-6)
            np.testing.assert_allclose(found[:, 1], te, rtol=1e-6)
            np.testing.assert_allclose(found[:, 2], load + 0.3e-6 * stiffness, rtol=1e-6)
