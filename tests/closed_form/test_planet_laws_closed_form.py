"""Solved teeth in a set: loads by independent solvers, a set of one planet, and what the stated errors cover."""

import itertools
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import root

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import build_scene
from fegear.contact.plane.transmission_error import transmission_error
from fegear.dynamics.planetary import mesh_law, set_cycle
from fegear.dynamics.planetary.mesh_law import LawSprings
from fegear.dynamics.planetary.one_sided import equilibrium
from fegear.dynamics.planetary.phases import mesh_phases
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

SIZE = {"module": "2 mm", "face_width": "25 mm", "thickness_allowance": "20 um"}
RING = {"internal": True, "teeth": 83, "cutter": {"teeth": 30}, "tip_diameter": "162.4 mm", "rim_thickness": "10 mm"}
PINS = {"tangential": ["20 um", "0 um", "-8 um", "0 um"], "radial": ["4 um", "0 um", "9 um", "0 um"]}
CACHE = SolutionCache()


def run(tolerance=1e-2, cache=CACHE, **keys):
    part = {"sun": "s", "planet": "p", "ring": "r", "planets": 4, "torque": "320 N*m", "pin_errors": PINS,
            "floating": [], "stiffness": {"pin": "250 N/um", "sun": "80 N/um"}} | keys  # fmt: skip
    case = {
        "results": ["planet-load-sharing"],
        "accuracy": {"tolerance": tolerance},
        "effects": {"hertz": "load-dependent", "neighbour_coupling": True, "corner_contact": True},
        "gear": {"s": SIZE | {"teeth": 25}, "p": SIZE | {"teeth": 29}, "r": SIZE | RING},
        "planetary": {"P": part},
    }
    scene = build_scene(case, "case", None)
    results = run_plan(scene, make_plan(scene, STAGES), cache=cache)
    return {task.subject + task.stage: outcome.data for task, outcome in results.outcomes.items()}


def loads_of(found):
    return found["Pplanet-load-sharing"]


@pytest.fixture(scope="module")
def unequal():
    """Four planets whose pins stand off their places, so that they carry unequal loads."""
    return run()


def test_a_set_of_one_planet_gives_way_as_its_two_pairs_do():
    """Between rigid bearings the sun turns by both transmission errors: their means add up."""
    found = run(planets=1, pin_errors={}, stiffness={}, fixed="carrier", torque="80 N*m")
    loads = loads_of(found)
    means = [transmission_error(found[f"P_{mesh}loaded-pair"].engagement, loads.mean_force) for mesh in ("sun", "ring")]
    assert loads.te_mean == pytest.approx(sum(one.mean for one in means), rel=1e-6)
    assert loads.largest_share == pytest.approx(1.0, abs=1e-12)


def test_every_mesh_gives_way_as_solved_load_sharing_says(unequal):
    """Whatever load a planet carries: its approach is that of the teeth under this load, within what is stated."""
    loads, worst = loads_of(unequal), 0.0
    cycle, delays = loads.cycle, mesh_phases(loads.cycle.model.found).delays
    assert 1.05 < loads.mesh_load_factor < 2.0
    for mesh, name in enumerate(("sun", "ring")):
        engagement = unequal[f"P_{name}loaded-pair"].engagement
        for n, at in itertools.product(range(4), range(0, loads.s.size, 37)):
            force, own = loads.mesh_force[mesh, n, at], 4 * mesh + n
            place = (loads.s[at] - delays[mesh, n]) * engagement.pair.base_pitch
            true = engagement.solve(engagement.grid([place]), [force]).transmission_error[0, 0]
            gap = true - cycle.separation[at, own]
            push, bearing = cycle.stiffness[at, own] * np.maximum(gap, 0.0), cycle.stiffness[at, own][gap > 0.0].sum()
            off = abs(push.sum() - force) / bearing  # of the approach
            worst = max(worst, off / true)
            assert off < cycle.bent[at, own].max() + 1e-12 * true
    assert 0.0 < worst < 5e-3


def answers(loads):
    order = np.arange(1.0, 9.0)
    return {
        "shares": (loads.shares, loads.shares_error),
        "K_gamma": (loads.mesh_load_factor, loads.mesh_load_factor_error),
        "largest share": (loads.largest_share, loads.largest_share_error),
        "largest load": (loads.largest_load, loads.largest_load_error),
        "mean": (loads.te_mean, loads.te_mean_error),
        "peak-to-peak value": (loads.te_peak_to_peak, loads.te_peak_to_peak_error),
        "harmonics": (np.abs(loads.harmonics(loads.te, order)), loads.harmonics_error(lambda one: one.te, order)),
    }


@pytest.mark.dear
def test_stated_errors_cover_what_finer_settings_change(unequal, monkeypatch):
    """Teeth solved to 1e-3, three times the forces and twice the places: within what was stated at 1e-2."""
    rough = answers(loads_of(unequal))
    levels = np.array(mesh_law._LEVELS)
    between = [levels[:-1] + part * np.diff(levels) for part in (1.0 / 3.0, 2.0 / 3.0)]
    monkeypatch.setattr(mesh_law, "_LEVELS", tuple(np.sort(np.concatenate([levels, *between])).tolist()))
    monkeypatch.setattr(set_cycle, "_FINEST", 1.0 / 97.0)
    fine = answers(loads_of(run(1e-3, SolutionCache())))
    for key, (value, error) in rough.items():
        off = np.max(np.abs(np.asarray(value) - fine[key][0]) / np.asarray(error))
        assert off < 1.0, key
    for key in ("shares", "mean", "peak-to-peak value"):  # nor are they hundreds of times too large
        value, error = rough[key]
        assert np.max(np.asarray(error) / np.abs(value)) < 0.04, key


def test_laws_never_soften_and_bear_what_all_planets_carry(unequal):
    cycle = unequal["Pset-cycle"]
    assert np.all(cycle.stiffness >= 0.0)
    assert np.all(np.diff(cycle.separation, axis=2) >= 0.0)
    assert cycle.level.max() > 3.9 * cycle.mean_force


def test_springs_of_many_forces_find_the_equilibrium_of_another_solver():
    """Random convex laws of five springs on each of six approaches, by MINPACK from the answer disturbed."""
    rng = np.random.default_rng(3)
    for _ in range(20):
        n, rows = 4, rng.normal(size=(6, 4))
        stiffness, separation = 10.0 ** rng.uniform(-1, 1, (1, 6, 5)), rng.normal(0.0, 1.0, (1, 6, 5))
        linear, load = np.diag(rng.uniform(0.1, 1.0, n)), rng.normal(0.0, 5.0, n)

        def residual(z, rows=rows, k=stiffness[0], m=separation[0], linear=linear, load=load):
            push = (k * np.maximum((rows @ z)[:, None] - m, 0.0)).sum(axis=1)
            return linear @ z + rows.T @ push - load

        found = equilibrium(linear, rows, stiffness, separation, load)[0]
        assert np.max(np.abs(residual(found))) < 1e-11 * np.max(np.abs(load))
        other = root(residual, found + rng.normal(0.0, 0.1, n), method="hybr", tol=1e-12)
        if other.success:
            assert np.allclose(other.x, found, atol=1e-8)


def test_spacing_errors_are_refused(unequal):
    engagement = replace(unequal["P_sunloaded-pair"].engagement, driver_spacing=np.array([1e-6, 0.0]))
    law, cycle = LawSprings(engagement, (), 1e3, 3), unequal["Pset-cycle"]
    assert law.cycles == 2
    with pytest.raises(InputError, match="use identical teeth"):
        set_cycle.set_cycle(cycle.model, (law, law), mesh_phases(cycle.model.found), 1.0, "sun")


@pytest.mark.long
def test_the_stated_error_of_motion_covers_what_finer_settings_change():
    """Contact loss at a speed where the integration alone states a third of what the teeth's errors change."""
    found = {}
    for tolerance, exactness in ((1e-2, 5e-4), (1e-3, 5e-5)):
        case = {
            "results": ["planet-motion"], "accuracy": {"tolerance": tolerance},
            "dynamics": {"tolerance": exactness, "direction": "static"},
            "effects": {"hertz": "load-dependent", "contact_loss": True, "parametric": True},
            "gear": {"s": SIZE | {"teeth": 25}, "p": SIZE | {"teeth": 29}, "r": SIZE | RING},
            "planetary": {"P": {
                "sun": "s", "planet": "p", "ring": "r", "planets": 4, "torque": "160 N*m", "floating": ["sun"],
                "stiffness": {"pin": "250 N/um"}, "pin_errors": {"tangential": ["8 um", "0 um", "-5 um", "0 um"]},
                "body": {"carrier": {"mass": "3 kg", "inertia": "0.01 kg*m^2"}}, "speeds": ["2500 rpm", "4000 rpm"],
            }},
        }  # fmt: skip
        scene = build_scene(case, "case", None)
        results = run_plan(scene, make_plan(scene, STAGES), cache=SolutionCache())
        (found[tolerance],) = (o.data for task, o in results.outcomes.items() if task.stage == "planet-motion")
    rough, fine = found[1e-2], found[1e-3]
    assert np.all(rough.error > 5e-4)
    for key in ("sun_factor", "ring_factor", "tooth_factor"):
        assert np.all(np.abs(getattr(rough, key) - getattr(fine, key)) <= rough.error), key
