"""Trains with ring gears: senses of rotation, mean forces, modes; a star of two planets beside the planetary set."""

import math

import numpy as np
import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.case.built.planetary import set_inputs
from fegear.case.built.train import train_inputs
from fegear.case.reading import build_scene
from fegear.dynamics.planetary.set_modes import set_modes
from fegear.dynamics.train.friction import with_friction
from fegear.dynamics.train.matrices import mass_matrix, static_forces, stiffness_matrix
from fegear.dynamics.train.train_spec import build_train
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.formulas.flank_speeds import flank_speeds, speeds_on_line
from fegear.results.catalogue import STAGES

SIZE = {"module": "2 mm", "face_width": "25 mm", "thickness_allowance": "20 um"}
RING = {"internal": True, "teeth": 83, "cutter": {"teeth": 30}, "tip_diameter": "162.4 mm", "rim_thickness": "10 mm"}
PLANETARY = {"P": {"sun": "s", "planet": "p", "ring": "r", "planets": 2, "torque": "100 N*m", "fixed": "carrier",
                   "floating": [], "stiffness": {"sun_mesh": "300 N/um", "ring_mesh": "480 N/um"},
                   "body": {"sun": {"mass": "1 kg", "inertia": "1e-3 kg*m^2"},
                            "planet": {"mass": "1 kg", "inertia": "2e-3 kg*m^2"},
                            "ring": {"mass": "5 kg", "inertia": "4e-2 kg*m^2"}}}}  # fmt: skip


def scene(train, results, **more):
    case = {
        "results": list(results), "accuracy": {"tolerance": 1e-2},
        "gear": {"s": SIZE | {"teeth": 25}, "p": SIZE | {"teeth": 29}, "r": SIZE | RING}, "train": train,
    } | more  # fmt: skip
    return build_scene(case, "case", None)


def single(results=("natural-modes",), drives="planet", more_of_pair=None, **more):
    torque = {"planet": {"planet": "80 N*m"}, "ring": {"ring": "80 N*m"}}[drives]
    roles = ("p", "r") if drives == "planet" else ("r", "p")
    train = {
        "body": {"planet": {"inertia": "2e-3 kg*m^2"}, "ring": {"inertia": "4e-2 kg*m^2"}},
        "mesh": {"M": {"driver": drives, "driven": "ring" if drives == "planet" else "planet", "pair": "I",
                       "damping_ratio": 0.05}},
        "torque": torque, "balance": "ring" if drives == "planet" else "planet",
    }  # fmt: skip
    own = (more_of_pair or {}).get("I", {})
    pair = {"I": {"driver": roles[0], "driven": roles[1]} | {"torque": "80 N*m"} | own}
    return scene(train, results, pair=pair, **more)


@pytest.mark.parametrize("drives", ["planet", "ring"])
def test_planet_and_ring_turn_the_same_way_under_the_force_of_the_torque(drives):
    found = single(drives=drives)
    train = build_train(train_inputs(found).spec, {"M": 400e6})
    assert train.ratios == pytest.approx([1.0, 29 / 83], rel=1e-12)  # both counter-clockwise
    driver = found.pairs["I"].driver
    assert static_forces(train) == pytest.approx([80.0 / driver.base_radius], rel=1e-12)
    stiff, mass = stiffness_matrix(train), mass_matrix(train)
    squares = np.sort(np.linalg.eigvals(np.linalg.solve(mass, stiff)).real)
    radii, inertias = (found.gears["p"].base_radius, found.gears["r"].base_radius), (2e-3, 4e-2)
    expected = 400e6 * sum(r * r / j for r, j in zip(radii, inertias, strict=True))
    assert squares == pytest.approx([0.0, expected], abs=1e-6 * expected)


def test_a_star_of_two_planets_has_the_rotational_modes_of_its_set():
    """Carrier at rest, rigid bearings and pins: the set's bodies only turn, as those of a train with a loop."""
    bodies = {"sun": 1e-3, "a": 2e-3, "b": 2e-3, "ring": 4e-2}
    mesh = {"sa": ("sun", "a", "P_sun"), "sb": ("sun", "b", "P_sun"), "ar": ("a", "ring", "P_ring"),
            "br": ("b", "ring", "P_ring")}  # fmt: skip
    train = {
        "body": {name: {"inertia": f"{inertia} kg*m^2"} for name, inertia in bodies.items()},
        "mesh": {name: {"driver": a, "driven": b, "pair": pair} for name, (a, b, pair) in mesh.items()},
        "torque": {"sun": "100 N*m"}, "balance": "ring",
    }  # fmt: skip
    found = scene(train, ["natural-modes"], planetary=PLANETARY)
    made = build_train(train_inputs(found).spec, {"sa": 300e6, "sb": 300e6, "ar": 480e6, "br": 480e6})
    ratio = dict(zip(bodies, (made.ratios[made.dof[name]] for name in bodies), strict=True))
    assert ratio == pytest.approx({"sun": 1.0, "a": -25 / 29, "b": -25 / 29, "ring": -25 / 83}, rel=1e-12)
    assert static_forces(made) == pytest.approx([50.0 / found.gears["s"].base_radius] * 4, rel=1e-9)
    squares = np.linalg.eigvals(np.linalg.solve(mass_matrix(made), stiffness_matrix(made))).real
    hertz = np.sqrt(np.maximum(np.sort(squares), 0.0)) / (2.0 * math.pi)
    of_set = np.sort(set_modes(set_inputs(found, "P").model, 300e6, 480e6).frequency)
    assert hertz[1:] == pytest.approx(of_set[1:4], rel=1e-9)
    assert hertz[0] < 1e-3 * hertz[1]


def test_mesh_force_follows_the_formula_of_one_degree_of_freedom():
    """F_1 = k e_1 w^2 / (w_n^2 - w^2 + 2 i zeta w w_n), with the teeth solved and the ring turning with the planet."""
    what = single(
        ("dynamic-increments", "mesh-force-spectrum"), dynamics={"speed": "600 rpm", "harmonics": 3},
        effects={"hertz": "linear"},
    )  # fmt: skip
    results = run_plan(what, make_plan(what, STAGES), cache=SolutionCache())
    train = next(o.data for task, o in results.outcomes.items() if task.stage == "gear-train")
    mesh = train.train.meshes[0]
    table = next(t for t in results.tables if t.name == "mesh_force_spectrum_M")
    columns = {column.name: column.si for column in table.columns}
    radii = abs(mesh.radius_a), abs(mesh.radius_b)
    mass = 1.0 / (radii[0] ** 2 / 2e-3 + radii[1] ** 2 / 4e-2)
    natural = math.sqrt(mesh.stiffness / mass)
    for n, frequency, force in zip(columns["n"][:3], columns["frequency"][:3], columns["force"][:3], strict=True):
        w = 2.0 * math.pi * frequency
        s = (np.arange(4096) + 0.5) / 4096
        e = 2.0 * abs(np.mean(train.meshes[0].error(s) * np.exp(-2j * math.pi * n * s)))
        expected = mesh.stiffness * e * w * w / abs(natural**2 - w * w + 0.1j * w * natural)
        assert force == pytest.approx(expected, rel=0.02)


@pytest.mark.parametrize("drives", ["planet", "ring"])
def test_flanks_of_a_ring_slide_in_a_train_as_they_do_in_a_pair(drives):
    """Lever arms and speeds are those of the flanks' radii of curvature, the ring's base radius counting negative."""
    pair = single(drives=drives).pairs["I"]
    x = np.linspace(pair.x_start, pair.x_end, 7)
    radii = pair.driver.tooth.side * pair.driver.base_radius, pair.driven.tooth.side * pair.driven.base_radius
    found = speeds_on_line(x, radii, pair.working_pressure_angle, 30.0 * pair.driver.base_radius)
    known = flank_speeds(pair, x, 30.0)
    assert found.radius_driver == pytest.approx(known.radius_driver, rel=1e-9)
    assert found.radius_driven == pytest.approx(known.radius_driven, rel=1e-9)
    assert found.sliding == pytest.approx(known.sliding, abs=1e-12)
    assert found.sum == pytest.approx(known.sum, rel=1e-9)


@pytest.mark.dear
@pytest.mark.parametrize("drives", ["planet", "ring"])
def test_friction_of_an_internal_mesh_takes_what_the_pair_loses(drives):
    """Both torques times both speeds are the loss of the pair's own result."""
    law = {"law": "constant", "coefficient": 0.06}
    speed = {"planet": 600.0, "ring": 600.0 * 29 / 83}[drives]
    pair = {"I": {"speed": f"{speed} rpm", "friction": law}}
    what = single(
        ("tooth-friction", "gear-mesh-power-loss"), drives, more_of_pair=pair,
        dynamics={"speeds": ["600 rpm"], "friction": law},
        effects={"friction": True, "parametric": True, "contact_loss": True, "hertz": "linear"},
    )  # fmt: skip
    found = run_plan(what, make_plan(what, STAGES), cache=SolutionCache())
    values = {value.name: value.si for value in found.values}
    assert values["M.friction_loss"] == pytest.approx(values["I.tooth_loss"], rel=2e-3)
    assert values["M.friction_efficiency"] == pytest.approx(values["I.tooth_efficiency"], abs=1e-5)
    (data,) = (
        one.data for one in found.outcomes.values() if hasattr(one.data, "train") and hasattr(one.data, "meshes")
    )
    mesh, one = data.train.meshes[0], data.meshes[0]
    turn = 600.0 * math.pi / 30.0 * data.train.ratios[data.train.dof["planet" if mesh.a == "planet" else "ring"]]
    base_pitch, speed_along = one.pair.base_pitch, abs(turn * mesh.radius_a)
    rubbed = with_friction(
        one.excitation, mesh, base_pitch, one.pair.working_pressure_angle, speed_along / base_pitch, one.force,
        lambda v, _r, _w: np.full(np.shape(v), 0.06), a_drives=one.a_drives, internal=True,
    )  # fmt: skip
    phase = np.array([0.11, 0.37, 0.83])
    for slot, (on_a, on_b) in enumerate(rubbed.friction):
        power = on_a(phase) * turn - on_b(phase) * turn * mesh.radius_a / mesh.radius_b
        x = rubbed.place(slot, phase) * base_pitch
        slides = np.abs(flank_speeds(one.pair, x, speed_along / one.pair.driver.base_radius).sliding)
        bears = one.excitation.stiffness[slot](phase) > 0.0
        assert power == pytest.approx(np.where(bears, -0.06 * slides, 0.0), abs=1e-6)
    (rows,) = (t for t in found.tables if t.name == "tooth_friction_M")
    at = {column.name: column.si for column in rows.columns}
    turning = speed * math.pi / 30.0, speed * math.pi / 30.0 * (29 / 83 if drives == "planet" else 83 / 29)
    on = (at["load"] > 0.0) & (at["sliding_velocity"] != 0.0)
    lost = -(at["torque_driver"] * turning[0] + at["torque_driven"] * turning[1])
    assert lost[on] == pytest.approx((0.06 * at["load"] * np.abs(at["sliding_velocity"]))[on], rel=1e-9)


@pytest.mark.dear
def test_every_result_of_a_train_takes_an_internal_mesh():
    """A ring that drives, too; motion with contact loss far above the resonance stays at the static force."""
    results = ("dynamic-increments", "tooth-force", "dynamic-root-stress", "dynamic-factor")
    law = {"law": "constant", "coefficient": 0.06}
    for drives in ("planet", "ring"):
        what = single(
            results, drives, dynamics={"speed": "600 rpm", "speeds": ["300 rpm"], "harmonics": 4, "friction": law},
            effects={"hertz": "linear", "contact_loss": True, "parametric": True, "friction": drives == "ring"},
        )  # fmt: skip
        found = run_plan(what, make_plan(what, STAGES), cache=SolutionCache())
        (factor,) = next(t for t in found.tables if t.name == "dynamic_factor_M").columns[1].si
        assert 1.0 < factor < 3.0
