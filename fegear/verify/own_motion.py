"""Rows of planetary sets and of motion against closed forms and independent code of our own."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from fegear.base.arrays import Array
from fegear.verify.row import Compared, Rows, near

ROWS = Rows()
SUN, RING, PIN = 3.0e8, 4.1e8, 2.2e8


def _set(planets: int, sun: float, pin: float = PIN) -> Any:
    from fegear.dynamics.planetary.set_model import CentralBody, PlanetBody, SetModel
    from fegear.verify.planetary_sets import constant, meshed, unshifted

    found = unshifted(24, 30, planets) if planets != 5 else unshifted(20, 20, 5)
    held = CentralBody(bearing=math.inf)
    model = SetModel(found, CentralBody(bearing=sun), held, held, PlanetBody(pin=pin), False)
    return meshed(model, constant(SUN), constant(RING))


def _pin_error(planets: int, size: float) -> Array:
    errors = np.zeros((2, planets))
    errors[1, 0] = size
    return errors


def _in_series() -> float:
    return 1.0 / (1.0 / SUN + 1.0 / RING + (2.0 * math.cos(math.radians(20.0))) ** 2 / PIN)


@ROWS.add(
    "loads of planets with pin errors", "own", "F_1 = F_0 - 2 cos a k e (1 - 3/N), floating sun; (1 - 1/N), fixed sun"
)
def pin_errors() -> Iterator[Compared]:
    """One tangential pin error of 1.5 um, 3, 4 and 5 planets."""
    from fegear.dynamics.planetary.planet_loads import planet_loads

    for planets, (bearing, part) in itertools.product((3, 4, 5), ((0.0, 3.0), (math.inf, 1.0))):
        run = _set(planets, bearing)
        loads = planet_loads(run, _pin_error(planets, 1.5e-6)).mesh_force[:, 0]
        less = 2.0 * math.cos(math.radians(20.0)) * _in_series() * 1.5e-6 * (1.0 - part / planets)
        yield from near((loads.min(), loads.max()), run.mean_force - less, 1e-10)


@ROWS.add("loss of contact of planets", "own", "closed form: with four planets the opposite one also loses contact")
def planets_that_lift() -> Iterator[Compared]:
    """Shares of four planets with pin errors of 100 um to 1 mm."""
    from fegear.dynamics.planetary.planet_loads import planet_loads

    for error in (100e-6, 301e-6, 1e-3):
        run = _set(4, 0.0)
        less = 2.0 * math.cos(math.radians(20.0)) * _in_series() * error / 4.0 / run.mean_force
        left = max(0.0, 1.0 - less)
        shares = planet_loads(run, _pin_error(4, error)).shares
        yield from near(
            shares, np.array([left, 2.0 - left, left, 2.0 - left]).reshape(shares.shape[-1:]), 1e-9, scale=1.0
        )


@ROWS.add("contact states of planetary sets", "own", "all contact states enumerated, least squares")
def planetary_contact_states() -> Iterator[Compared]:
    """Mesh forces of 40 random sets of two to four planets, most of which lift one or several."""
    from fegear.dynamics.planetary.planet_loads import planet_loads
    from fegear.dynamics.planetary.set_model import CentralBody, PlanetBody, SetModel
    from fegear.verify.planetary_sets import constant, meshed, unshifted
    from fegear.verify.rolled import enumerated

    rng = np.random.default_rng(7)
    for _ in range(40):
        planets = int(rng.integers(2, 5))
        angles = np.sort(rng.choice(108, planets, replace=False)) * math.tau / 108
        found = unshifted(24, 30, angles - angles[0], addendum=-15.0)
        sun, ring = (CentralBody(bearing=10.0 ** rng.uniform(*decades)) for decades in ((5, 9), (7, 10)))
        made = SetModel(found, sun, ring, CentralBody(bearing=math.inf), PlanetBody(pin=PIN), False)
        one, other = (10.0 ** rng.uniform(8, 9) for _ in range(2))
        run = meshed(made, constant(one), constant(other), torque=300.0)
        errors = rng.normal(0.0, 40e-6, (2, planets))
        free = made.freed(("ring", "carrier"))
        rows = made.mesh_rows.reshape(-1, made.size) @ free
        load = (made.torque_load(300.0) - PIN * errors.ravel() @ made.pin_rows.reshape(-1, made.size)) @ free
        k = np.repeat([one, other], planets)
        asked = enumerated(free.T @ made.held_stiffness() @ free, rows, k, np.zeros(len(rows)), load)
        yield from near(
            planet_loads(run, errors).mesh_force[..., 0].ravel(),
            np.nan if asked is None else asked,
            1e-7,
            run.mean_force,
        )


@ROWS.add("planet modes", "own", "the 3 by 3 matrix of one planet")
def planet_modes() -> Iterator[Compared]:
    """Natural frequencies of four and of six planets."""
    from fegear.dynamics.planetary.set_modes import set_modes
    from fegear.verify.planetary_sets import lin_parker

    model = lin_parker(4)
    mass = np.sqrt(model.masses[9:12])
    alone = np.linalg.eigvalsh(model.stiffness(5e8, 5e8)[9:12, 9:12] / np.outer(mass, mass))
    for planets in (4, 6):
        modes = set_modes(lin_parker(planets), 5e8, 5e8)
        found = [f for f, kind in zip(modes.frequency, modes.kind, strict=True) if kind == "planets"]
        yield from near(found, np.repeat(np.sqrt(alone) / math.tau, planets - 3), 1e-8)


# ---- motion -----------------------------------------------------------------------------------------------------
@ROWS.add("steady motion of a gear pair", "own", "one oscillator in closed form")
def one_oscillator() -> Iterator[Compared]:
    """Largest and smallest mesh force of two discs below, at and above resonance."""
    from fegear.dynamics.motion.motion_model import MotionModel
    from fegear.dynamics.motion.steady_state import steady_state
    from fegear.dynamics.train.excitation import MeshExcitation
    from fegear.dynamics.train.periodic import Periodic
    from fegear.dynamics.train.train import Body, Mesh, Torque, Train, mesh_damping

    radius, inertia, k, force, zeta, amplitude = 0.05, 2e-3, 2e8, 500.0, 0.02, 5e-8
    natural = math.sqrt(2.0 * k * radius**2 / inertia)
    train = Train(
        (Body("1", inertia), Body("2", inertia)),
        meshes=(
            Mesh(
                "g",
                "1",
                "2",
                radius,
                radius,
                30,
                30,
                k,
                mesh_damping(zeta, k, radius, radius, inertia, inertia),
                math.inf,
            ),
        ),
        torques=(Torque("1", force * radius), Torque("2", force * radius)),
    )
    error = Periodic.fit(lambda s: amplitude * np.cos(2.0 * np.pi * s), degree=10, tolerance=1e-13)
    excitation = MeshExcitation.from_mesh(Periodic.constant(k), error)
    mass = inertia / (2.0 * radius**2)
    c = 2.0 * zeta * math.sqrt(k * mass)
    for ratio in (0.2, 0.9, 1.0, 1.7):
        w = ratio * natural
        h = k / (k - mass * w * w + 1j * w * c)
        swing = abs(k * (h - 1.0) * amplitude + 1j * w * c * h * amplitude)
        state = steady_state(MotionModel(train, (excitation,), w / 30), tolerance=1e-10)
        yield from near((state.largest[0], state.smallest[0]), (force + swing, force - swing), 1e-9)


@ROWS.add(
    "motion with loss of contact and back-side contact", "own", "scipy's DOP853 with events, three rigs, rtol 1e-12"
)
def motion_by_dop853() -> Iterator[Compared]:
    """Largest mesh force of the steady motion, of the mean force."""
    from fegear.verify.rigs import CASES, four_inertia, reference, shooting

    for rpm, backlash, amplitude, force, shaft in CASES.values():
        system = four_inertia(force, backlash, shaft)
        state = shooting(system, rpm, amplitude, 1e-11)
        path = state.trajectory(1)
        start = np.concatenate([path.angles(0.0), path.angles(0.0, 1)])
        largest, changes, _ = reference(system, rpm, amplitude, 2, "DOP853", 1e-12, start)
        yield from near(state.largest[0], largest, 1e-9, scale=force)
        yield from near(2.0 * state.changes, changes, 0.0, scale=1.0)
