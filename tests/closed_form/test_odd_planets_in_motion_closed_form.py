"""Planetary sets with odd teeth in motion: own time integration, teeth that differ by nothing, rigid motion."""

import math

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.dynamics.motion.steady_state import steady_state
from fegear.dynamics.planetary.phases import whole_delays
from fegear.dynamics.planetary.planet_set import CENTRALS
from fegear.dynamics.planetary.set_motion import OddMeshes, SetMotion
from fegear.dynamics.planetary.set_motion_over_revolution import transmission_error_row
from fegear.dynamics.planetary.set_revolution import with_ordinary_teeth
from fegear.dynamics.train.mesh_excitation import mesh_excitation
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

CACHE = SolutionCache()
SIZE = {"module": "2 mm", "face_width": "20 mm", "thickness_allowance": "20 um"}
RING = {"internal": True, "teeth": 56, "cutter": {"teeth": 20}, "tip_diameter": "108.6 mm", "rim_thickness": "10 mm"}
RESULT = "planet-vibration-revolution"


def scene_of(odd=None, results=(RESULT,), **keys):
    gears = {"s": SIZE | {"teeth": 16}, "p": SIZE | {"teeth": 20}, "r": SIZE | RING}
    for name, teeth in (odd or {}).items():
        gears[name] = gears[name] | {"odd_tooth": teeth}
    part = {"sun": "s", "planet": "p", "ring": "r", "planets": 3, "torque": "100 N*m", "speed": "20000 rpm",
            "floating": ["sun"], "odd_planet": 2,
            "body": {"carrier": {"mass": "2 kg", "inertia": "0.01 kg*m^2"}}} | keys  # fmt: skip
    part = {key: value for key, value in part.items() if value is not None}
    case = {
        "results": list(results),
        "gear": gears,
        "planetary": {"P": part},
        "accuracy": {"tolerance": 2e-2},
        "effects": {"neighbour_coupling": True, "odd_teeth": bool(odd)},
    }
    return build_scene(case, "case", None)


def run(odd=None, results=(RESULT,), **keys):
    scene = scene_of(odd, results, **keys)
    return dict(run_plan(scene, make_plan(scene, STAGES), cache=CACHE).outcomes)


def data(outcomes, stage):
    return next(outcome.data for task, outcome in outcomes.items() if task.stage == stage)


def pit(depth, tooth=0):
    return {"tooth": tooth, "pits": [{"diameter": ["20 mm", "60 mm"], "depth": depth}]}


def odd_meshes(outcomes, scene):
    """Springs of every mesh, put together here: the planet that is odd, and what its teeth meet, counted again."""
    from fegear.case.built.planetary import set_inputs

    asked, linear = set_inputs(scene, "P"), data(outcomes, "planet-modes")
    teeth = []
    for mesh, member, force in zip(("sun", "ring"), ("driven", "driver"), linear.meshed.mean_forces, strict=True):
        pair = next(o.data for t, o in outcomes.items() if t.stage == "odd-pair" and t.subject.endswith(mesh))
        odd, plain = (
            mesh_excitation(one, force) for one in (pair.engagement, with_ordinary_teeth(pair.engagement, member))
        )
        teeth.append((plain, odd, plain))
    delays = whole_delays(
        asked.found, asked.phases, 1, clockwise=asked.run.sun_turns < 0.0, sun_drives=asked.run.sun_drives
    )
    return asked, linear, OddMeshes((teeth[0], teeth[1]), delays)


def own_motion(motion, state, steps_of_fastest=200):
    """One cycle of the teeth by Runge and Kutta's method in the bodies' coordinates, from a state at time zero.

    Springs are read from tables over the cycle; damping acts on every mode about the mean stiffnesses.
    """
    linear, odd = motion.linear, motion.odd
    model, modes = linear.meshed.model, linear.modes
    flexible = modes.frequency > 0.0
    shapes, natural = modes.shapes[:, flexible], 2.0 * math.pi * modes.frequency[flexible]
    count, period = odd.base_pitches, motion.period
    steps = int(steps_of_fastest * period * natural.max() / (2.0 * math.pi))
    cells = 4 * steps
    s = (np.arange(cells + 1) + 0.5) / cells * count
    rows, stiffness, gap = [], [], []
    for mesh in (0, 1):
        for n, one in enumerate(odd.teeth[mesh]):
            for k, m in zip(one.stiffness, one.separation, strict=True):
                place = s - odd.delays[mesh, n] + one.phase
                rows.append(model.mesh_rows[mesh, n] @ shapes)
                stiffness.append(k(place))
                gap.append(m(place))
    rows, stiffness, gap = np.array(rows), np.array(stiffness), np.array(gap)
    load = model.torque_load(linear.meshed.sun_torque) @ shapes
    held = shapes.T @ model.held_stiffness() @ shapes
    damping = 2.0 * linear.damping_ratio * natural

    def rate(cell, x, v):
        reach = rows @ x - gap[:, cell]
        force = np.where(reach > 0.0, stiffness[:, cell] * reach, 0.0)
        return load - held @ x - damping * v - force @ rows, force

    packed = state.trajectory().packed
    unit = np.linalg.norm(packed.shapes) / np.linalg.norm(shapes)
    x, v = state.x * unit, state.v * unit / packed.time_unit
    h = period / steps
    moved, force = np.empty((steps, natural.size)), np.empty((steps, len(rows)))
    for i in range(steps):
        c = 4 * i
        a1, force[i] = rate(c, x, v)
        moved[i] = x
        a2, _ = rate(c + 2, x + 0.5 * h * v, v + 0.5 * h * a1)
        a3, _ = rate(c + 2, x + 0.5 * h * v + 0.25 * h * h * a1, v + 0.5 * h * a2)
        a4, _ = rate(c + 4, x + h * v + 0.5 * h * h * a2, v + h * a3)
        x = x + h * v + h * h / 6.0 * (a1 + a2 + a3)
        v = v + h / 6.0 * (a1 + 2.0 * a2 + 2.0 * a3 + a4)
    slots = [len(one.stiffness) for mesh in odd.teeth for one in mesh]
    of_mesh = np.add.reduceat(force, np.append(0, np.cumsum(slots)[:-1]), axis=1)
    return np.arange(steps) / steps * count, moved @ shapes.T, of_mesh.T.reshape(2, model.count, -1)


@pytest.mark.dear
def test_a_set_in_motion_is_that_of_an_own_integration():
    """Runge and Kutta's method over one cycle of the teeth; planets lose contact on the way."""
    odd = {"p": [pit("20 um", 1)]}
    scene = scene_of(odd)
    outcomes = run(odd)
    asked, linear, meshes = odd_meshes(outcomes, scene)
    motion = SetMotion(linear, asked.run.mesh_frequency, None, math.inf, meshes)
    state = steady_state(motion, tolerance=5e-4)
    assert state.kind == "periodic"
    assert state.apart.max() > 0.0
    found = data(outcomes, RESULT)
    assert found.base_pitches == 20
    s, moved, force = own_motion(motion, state)
    # the sun against a carrier that turns: pins at radius a move the teeth by cos(alpha_w) of sun and ring together
    angles = asked.found.sun_angle, asked.found.ring_angle
    te = moved[:, 2] + moved[:, 5] - (math.cos(angles[0]) + math.cos(angles[1])) * moved[:, 8]
    same = np.interp(s, found.s, found.te)
    assert np.abs(te - same).max() < 4e-3 * np.ptp(found.te)  # jumps of the springs between steps: first order
    mean = linear.meshed.mean_force
    for mesh in (0, 1):
        for n in range(3):
            there = np.interp(s, found.s, found.mesh_force[mesh, n])
            # but between the samples beside a jump
            assert np.quantile(np.abs(force[mesh, n] - there), 0.95) < 1e-2 * mean
    assert found.mesh_force_max == pytest.approx(force.max(), rel=3e-3)


@pytest.mark.dear
def test_teeth_that_differ_by_nothing_move_as_all_others():
    """A tooth that differs by nothing: each base pitch as the one before, and as the motion of ordinary teeth."""
    keys = {"speeds": {"values": ["20000 rpm"]}}
    outcomes = run({"p": [pit("0 um")]}, (RESULT, "planet-motion"), **keys)
    found, usual = data(outcomes, RESULT), data(outcomes, "planet-motion")
    assert found.base_pitches == 20
    each = found.te.reshape(20, -1)
    assert np.ptp(each, axis=0).max() < 1e-4 * np.ptp(found.te)
    (state,) = usual.states
    factor = found.mesh_force_max / found.signals.mean_force
    assert factor == pytest.approx(max(usual.sun_factor[0], usual.ring_factor[0]), rel=1e-3)
    assert found.kind == state.kind == "periodic"


def test_rigid_motion_leaves_no_transmission_error():
    scene = scene_of()
    from fegear.case.built.planetary import set_inputs

    model = set_inputs(scene, "P").model
    # bodies that turn as gears without deflection: no mesh and no pin is moved
    rows = np.concatenate([model.mesh_rows.reshape(-1, model.size), model.pin_rows.reshape(-1, model.size)])
    central = [3 * k + axis for k in range(3) for axis in (0, 1)]
    rows = np.vstack([rows, np.eye(model.size)[central]])
    rigid = np.linalg.svd(rows)[2][np.linalg.matrix_rank(rows, 1e-9) :]
    assert len(rigid) == 2  # the set turns as a whole, and by its ratio
    for driving in CENTRALS:
        row = transmission_error_row(model, driving)
        assert abs(row[3 * CENTRALS.index(driving) + 2]) == pytest.approx(1.0, rel=1e-12)
        assert np.abs(rigid @ row).max() < 1e-12


def test_motion_over_all_base_pitches_needs_a_speed_and_masses():
    for keys, key in (({"speed": None}, "planetary.P.speed"), ({"body": None}, "planetary.P.body.carrier")):
        with pytest.raises(InputError) as refusal:
            make_plan(scene_of({"p": [pit("1 um")]}, **keys), STAGES)
        assert key in str(refusal.value)
