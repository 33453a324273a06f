"""Rows against closed forms and independent code of our own, which runs with the row."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from typing import Any

import numpy as np

from fegear.base.arrays import Array
from fegear.dynamics.planetary.planet_set import Central
from fegear.geometry.internal_tooth import InternalTooth
from fegear.shafts.beam import Shaft
from fegear.shafts.bearing import Bearing
from fegear.shafts.solution import Deflection
from fegear.verify.row import Compared, Rows, near

ROWS = Rows()
E, NU = 206e9, 0.3


# ---- geometry ---------------------------------------------------------------------------------------------------
def random_internal_teeth(count: int) -> Iterator[InternalTooth]:
    """Internal teeth, spur and helical, that are not refused."""
    from fegear.base.errors import GeometryError
    from fegear.geometry.internal_tooth import InternalTooth, PinionCutter

    rng = np.random.default_rng(28)
    while count:
        z = int(rng.integers(25, 160))
        z0 = int(rng.integers(10, max(12, z - 8)))
        beta = float(rng.choice([0.0, math.radians(rng.uniform(1.0, 35.0))]))
        cutter = PinionCutter(z0, rng.uniform(-0.3, 0.5), rng.uniform(1.0, 1.4), tip_radius=rng.uniform(0.0, 0.4))
        x = rng.uniform(-0.6, 0.8)
        tip = z / 2 / math.cos(beta) - x - rng.uniform(0.4, 1.1)
        try:
            tooth = InternalTooth(
                z, cutter, math.radians(rng.uniform(15.0, 26.0)), x, rng.uniform(0.0, 0.05), tip,
                tip_rounding=float(rng.choice([0.0, rng.uniform(0.0, 0.1)])), helix_angle=beta,
            )  # fmt: skip
        except GeometryError:
            continue
        count -= 1
        yield tooth


@ROWS.add("internal teeth as cut", "own", "the cutter rolled in small steps, without an equation of meshing")
def internal_teeth_rolled() -> Iterator[Compared]:
    """Distance of fillet and involute of 60 random internal teeth from their cutter, in modules."""
    from fegear.verify.rolled import nearest

    for tooth in random_internal_teeth(60):
        for curve in (tooth.fillet, tooth.involute):
            apart = nearest(tooth, curve.points(np.linspace(curve.start, curve.end, 9)))
            yield from near(np.abs(apart).max(), 0.0, 1e-12, scale=1.0)


@ROWS.add("external teeth as cut", "own", "the rack's tip circle rolled in small steps, without an equation of meshing")
def fillets_rolled() -> Iterator[Compared]:
    """Depth of the trace of the tip circle at the fillet's points of four gears, in modules."""
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.rack import BasicRack

    for z, shift in ((12, 0.4), (20, 0.0), (43, 0.25), (90, -0.3)):
        tooth = Tooth(z, BasicRack(1.0, 1.25, 0.25), shift)
        rack, r = tooth.rack, 0.5 * z
        points = tooth.fillet.points(np.linspace(tooth.fillet.start, tooth.fillet.end, 9))
        half = math.pi / z  # to the middle of the space
        x = points[0] * math.cos(half) - points[1] * math.sin(half)
        y = points[1] * math.cos(half) + points[0] * math.sin(half)
        depth = r - (rack.dedendum - rack.tip_radius - shift)

        turns = np.linspace(-0.6, 0.6, 200_001)[:, None] * min(1.0, 12.0 / z)
        u, v = x * np.cos(turns) - y * np.sin(turns), y * np.cos(turns) + x * np.sin(turns)
        along = np.minimum(*(np.abs(u + r * turns + side * rack.tip_centre_offset) for side in (-1.0, 1.0)))
        apart = (np.hypot(along, v - depth) - rack.tip_radius).min(axis=0)
        yield from near(np.abs(apart), 0.0, 1e-7, scale=1.0)


@ROWS.add("speeds, torques and efficiency of planetary sets", "own", "Willis' equation, six arrangements, by hand")
def planetary_kinematics() -> Iterator[Compared]:
    """Speed ratios of sun 24, planets 30, ring 84."""
    from fegear.dynamics.planetary.kinematics import running
    from fegear.verify.planetary_sets import unshifted

    i = 84 / 24
    arrangements: tuple[tuple[Central, Central, float], ...] = (
        ("ring", "sun", 1 + i), ("ring", "carrier", 1 / (1 + i)), ("carrier", "sun", -i), ("carrier", "ring", -1 / i),
        ("sun", "ring", 1 + 1 / i), ("sun", "carrier", 1 / (1 + 1 / i)),
    )  # fmt: skip
    for fixed, driving, ratio in arrangements:
        run = running(unshifted(24, 30, 3), fixed, driving, 100.0, 50.0, 0.98)
        yield from near(run.ratio, ratio, 1e-13)
        yield from near(sum(run.torque.values()), 0.0, 1e-10, scale=50.0)
    yield from near(
        running(unshifted(24, 30, 3), "ring", "sun", 10.0, 1.0, 0.97).efficiency, (1 + i * 0.97) / (1 + i), 1e-13
    )


# ---- contact ----------------------------------------------------------------------------------------------------
@ROWS.add(
    "Hertzian line contact", "own", "pressure and Johnson's stresses (Contact Mechanics, Eqs. 4.42, 4.46) by quadrature"
)
def line_contact() -> Iterator[Compared]:
    """The pressure carries the load, makes a parabola, and its strains add up to the approach."""
    from scipy.integrate import quad

    from fegear.formulas import hertz

    modulus = hertz.contact_modulus(E, NU, E, NU)
    for load, curvature in ((1e4, 30.0), (1e5, 100.0), (3e6, 250.0)):
        c = hertz.line_contact(load, curvature, modulus)
        a, p0 = float(c.half_width), float(c.peak_pressure)
        yield from near(quad(lambda x, a=a, p0=p0: p0 * math.sqrt(1.0 - (x / a) ** 2), -a, a)[0], load, 1e-9)
        yield from near(2.0 * p0 / (a * modulus), curvature, 1e-12)
        for depth in (a, 7.0 * a, 1e3 * a):

            def strain(z: float, a: float = a, p0: float = p0) -> float:
                root = math.hypot(a, z)
                down, across = -p0 * a / root, -p0 * ((a * a + 2 * z * z) / root - 2 * z) / a
                return -(1.0 - NU**2) / E * (down - NU / (1.0 - NU) * across)

            ends = [x for x in (0.0, a, 10 * a, 100 * a) if x < depth] + [depth]
            total = sum(quad(strain, *pair, epsrel=1e-12)[0] for pair in itertools.pairwise(ends))
            yield from near(hertz.approach(load, a, depth, E, NU), total, 1e-8)


@ROWS.add("Hertzian point contact", "own", "the potential of the pressure over its ellipse by quadrature")
def point_contacts() -> Iterator[Compared]:
    """A ball on a plate, and ellipses of ratios from 1.1 to 40."""
    from scipy.integrate import quad

    from fegear.shafts.rolling_bearing import point_contact

    yield from near(point_contact((100.0, 100.0, 0.0, 0.0), 226e9), 2.0 / 3.0 * 226e9 * 0.1, 1e-12)
    for ratio in (1.1, 1.5, 6.7, 40.0):
        b2 = ratio**-2

        def integral(power_a: int, power_b: int, b2: float = b2) -> float:
            def of(t: float) -> float:
                s = t * t
                return 2.0 / ((1.0 + s) ** (0.5 + power_a) * (b2 + s) ** (0.5 + power_b))

            ends = ((0.0, math.sqrt(b2)), (math.sqrt(b2), 1.0), (1.0, math.inf))
            return float(sum(quad(of, *pair, epsabs=0, epsrel=1e-12, limit=500)[0] for pair in ends))

        # w = (p_0 b/2 E*) int_0^inf (1 - x^2/(1 + s) - y^2/(b^2 + s)) ds / sqrt((1 + s)(b^2 + s) s), p_0 = E* = 1
        approach, along, across = (integral(*powers) / ratio for powers in ((0, 0), (1, 0), (0, 1)))
        load = 2.0 / 3.0 * math.pi / ratio
        yield from near(point_contact((2.0 * along, 2.0 * across, 0.0, 0.0), 1.0) * approach**1.5, load, 1e-9)


@ROWS.add("contact ellipse of flanks", "own", "Hertz's equations with complete elliptic integrals")
def contact_ellipses() -> Iterator[Compared]:
    """Curvatures and approach from the axes, over four decades of curvature."""
    from scipy.special import ellipe, ellipk

    from fegear.contact.unloaded.contact_ellipse import contact_ellipse

    for decades in (0.1, 0.7, 2.0, 4.0):
        large, modulus = 80.0, 1.1e11
        small = large * 10.0**-decades
        found = contact_ellipse(large, small, 300.0, modulus)
        a, b, p0 = float(found.long), float(found.short), float(found.pressure)
        e2 = (1.0 - b / a) * (1.0 + b / a)
        k, l = ellipk(e2), ellipe(e2)  # noqa: E741
        front = p0 / modulus * b / (e2 * a * a)
        yield from near((2.0 * front * (k - l), 2.0 * front * ((a / b) ** 2 * l - k)), (small, large), 1e-7)
        yield from near(found.approach, p0 / modulus * b * k, 1e-9)


@ROWS.add("load sharing of tooth pairs", "own", "every set of pairs in contact tried, linear compliance")
def load_sharing_enumerated() -> Iterator[Compared]:
    """Loads and transmission error of 200 random problems of up to four pairs, of the whole load."""
    from fegear.contact.plane.load_sharing import share_load

    rng = np.random.default_rng(3)
    for _ in range(200):
        n = int(rng.integers(1, 5))
        own = rng.uniform(0.5, 4.0, n)
        c = np.diag(own)
        for j, k in itertools.combinations(range(n), 2):
            c[j, k] = c[k, j] = 0.2 * rng.uniform(-0.3, 1.0) * math.sqrt(own[j] * own[k])
        gap, total = rng.uniform(-2.0, 2.0, n), 10.0 ** rng.uniform(-3.0, 1.0)
        found = share_load(c[:, :, None], gap[:, None], [total])
        for size in range(1, n + 1):
            for on in map(list, itertools.combinations(range(n), size)):
                system = np.block([[c[np.ix_(on, on)], -np.ones((size, 1))], [np.ones((1, size)), np.zeros((1, 1))]])
                *loads, z = np.linalg.solve(system, [*(-gap[on]), total])
                w = np.zeros(n)
                w[on] = loads
                if min(loads) >= 0.0 and np.all(c @ w + gap - z >= -1e-12):
                    yield from near(found.loads[:, 0, 0], w, 1e-10, scale=total)
                    yield from near(found.transmission_error[0, 0], z, 1e-10, scale=4.0 * total + 2.0)


@ROWS.add("face load factor of ISO 6336-1", "own", "a row of 200,000 springs, the approach by bisection")
def face_load_of_springs() -> Iterator[Compared]:
    """K_Hbeta of a straight gap over the face, from full contact to a fifth of it."""
    from scipy.optimize import brentq

    from fegear.formulas.iso6336.part1_face_load import face_load_factor

    stiffness, specific_load, place = 20e9, 4e5, (np.arange(200_000) + 0.5) / 200_000
    for gap in (2e-6, 15e-6, 40e-6, 200e-6, 1e-3):

        def load(zeta: float, gap: float = gap) -> Array:
            return stiffness * np.maximum(zeta - gap * place, 0.0)

        zeta = brentq(lambda at, load=load: load(at).mean() - specific_load, 0.0, gap + 1.0)
        yield from near(face_load_factor(gap, stiffness, specific_load), load(zeta).max() / specific_load, 1e-4)


# ---- tooth beams ------------------------------------------------------------------------------------------------
@ROWS.add(
    "beam integrals of tooth formulas",
    "own",
    "adaptive quadrature over the height, the outline inverted point by point",
)
def tooth_beam() -> Iterator[Compared]:
    """Bending and area integrals of teeth of 10, 28 and 120."""
    from scipy.integrate import quad
    from scipy.optimize import brentq

    from fegear.formulas import beam
    from fegear.formulas.root_section import load_line
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.rack import BasicRack

    for z in (10, 28, 120):
        tooth = Tooth(z, BasicRack(1.0, 1.25, 0.25), tip_radius=z / 2 + 0.95)
        load = load_line(tooth, 0.3 * tooth.form_radius + 0.7 * tooth.involute_tip_radius)
        found = beam.integrals(beam.sections(tooth, load, tooth.fillet.start), load.apex)
        apex, bend, area = float(load.apex[0]), 0.0, 0.0
        (_, low), (_, mid) = tooth.fillet.points(tooth.fillet.start), tooth.fillet.points(tooth.fillet.end)
        for curve, lo, hi in ((tooth.fillet, float(low), float(mid)), (tooth.involute, float(mid), float(load.y[0]))):

            def half(y: float, curve: Any = curve) -> float:
                u = brentq(lambda p: float(curve.points(p)[1]) - y, curve.start, curve.end, xtol=1e-15)
                return float(curve.points(u)[0])

            ends, rule = (lo + 1e-12 * (hi - lo), hi - 1e-12 * (hi - lo)), {"epsrel": 1e-9, "limit": 200}
            bend += quad(lambda y, h=half, apex=apex: 12 * (apex - y) ** 2 / (2 * h(y)) ** 3, *ends, **rule)[0]
            area += quad(lambda y, h=half: 0.5 / h(y), *ends, **rule)[0]
        yield from near((found.bending_2[0], found.area[0]), (bend, area), 1e-8)


# ---- planetary sets ---------------------------------------------------------------------------------------------
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


@ROWS.add("contact states of planetary sets", "own", "every state of contact tried, least squares")
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


# ---- shafts and bearings ----------------------------------------------------------------------------------------
def _shaft(*sections: tuple[float, ...]) -> Shaft:
    from fegear.shafts.beam import Section, Shaft

    return Shaft(tuple(Section(*one) for one in sections), E, NU)


def _deflected(shaft: Shaft, seats: tuple[tuple[Bearing, float], ...], at: float, *load: float) -> Deflection:
    from fegear.shafts.held import LoadedShaft, Seat
    from fegear.shafts.solution import deflect

    held = tuple(Seat(bearing, z) for bearing, z in seats)
    return deflect((LoadedShaft(shaft, held, np.array([at]), np.array([load], dtype=float), "shaft"),))[0]


def _bending(d: float, h: float = 0.0) -> float:
    return E * math.pi / 64.0 * (d**4 - h**4)


def _shear(d: float, h: float = 0.0) -> float:
    """Cowper's coefficient for a hollow circle."""
    m = (h / d) ** 2
    kappa = 6 * (1 + NU) * (1 + m) ** 2 / ((7 + 6 * NU) * (1 + m) ** 2 + (20 + 12 * NU) * m)
    return kappa * E / (2 * (1 + NU)) * math.pi / 4 * (d * d - h * h)


def _held() -> tuple[Bearing, Bearing, Bearing]:
    """A fixed bearing, a floating one, a clamp: all rigid."""
    from fegear.shafts.bearing import stiff

    return stiff(math.inf, math.inf), stiff(math.inf), stiff(math.inf, math.inf, math.inf)


@ROWS.add("shafts between and beyond their bearings", "own", "Timoshenko beams in closed form")
def beams() -> Iterator[Compared]:
    """A force between the bearings (solid and hollow), on an overhung end, and in the middle of a stepped shaft."""
    pin, roller, _ = _held()
    length, a, force, d = 0.4, 0.15, 3000.0, 0.05
    b = length - a
    for hole in (0.0, 0.02):
        found = _deflected(_shaft((length, d, hole)), ((pin, 0.0), (roller, length)), a, 0, force, 0, 0, 0, 0)
        wanted = force * a**2 * b**2 / (3 * _bending(d, hole) * length) + force * a * b / length / _shear(d, hole)
        yield from near(found.at(a)[0, 1], wanted, 1e-10)
    span, over = 0.3, 0.1
    found = _deflected(_shaft((span + over, 0.04)), ((pin, 0.0), (roller, span)), span + over, force, 0, 0, 0, 0, 0)
    wanted = force * over**2 * (span + over) / (3 * _bending(0.04)) + force * over / _shear(0.04) * (1 + over / span)
    yield from near(found.at(span + over)[0, 0], wanted, 1e-10)
    stepped, thin, thick = _shaft((0.1, 0.04), (0.2, 0.06), (0.1, 0.04)), 0.04, 0.06
    found = _deflected(stepped, ((pin, 0.0), (roller, 0.4)), 0.2, force, 0, 0, 0, 0, 0)
    bent = (0.1**3 / _bending(thin) + (0.2**3 - 0.1**3) / _bending(thick)) * force / 6
    yield from near(found.at(0.2)[0, 0], bent + force / 2 * (0.1 / _shear(thin) + 0.1 / _shear(thick)), 1e-10)


@ROWS.add("conical shafts", "own", "the integral of the bending line in closed form")
def cones() -> Iterator[Compared]:
    """Free end of a clamped cone."""
    length, d0, d1, force = 0.2, 0.06, 0.02, 800.0
    found = _deflected(_shaft((length, d0, 0.0, d1)), ((_held()[2], 0.0),), length, force, 0, 0, 0, 0, 0)
    wanted = 64 * force * length**3 / (3 * math.pi * E * d0**3 * d1) + force * length / _shear(1.0) / (d0 * d1)
    yield from near(found.at(length)[0, 0], wanted, 1e-10)


@ROWS.add("tension and torsion of shafts", "own", "rods in closed form")
def tension_and_twist() -> Iterator[Compared]:
    """Free end of a hollow shaft."""
    from fegear.shafts.held import LoadedShaft, Seat
    from fegear.shafts.solution import deflect

    loads = np.array([[0, 0, 700.0, 0, 0, -50.0], [0, 0, 0, 0, 0, 50.0]])
    held = (Seat(_held()[2], 0.0),)
    loaded = LoadedShaft(_shaft((0.3, 0.03, 0.01)), held, np.array([0.3, 0.1]), loads, "shaft")
    found = deflect((loaded,))[0].at(0.3)[0]
    area, polar = math.pi / 4 * (0.03**2 - 0.01**2), math.pi / 32 * (0.03**4 - 0.01**4)
    yield from near(found[2], 700 * 0.3 / (E * area), 1e-11)
    yield from near(found[5], -50 * 0.2 / (E / 2.6 * polar), 1e-11)


@ROWS.add("bearings with clearance", "own", "springs behind a gap in closed form")
def clearances() -> Iterator[Compared]:
    """A rigid shaft on two bearings of 30 um radial and 10 um axial clearance."""
    from fegear.shafts.beam import Section, Shaft
    from fegear.shafts.bearing import LooseBearing

    bearing, force = LooseBearing(2e8, 1e8, 0.0, 30e-6, 10e-6), 1000.0
    rigid = Shaft((Section(0.2, 0.05),), math.inf)
    found = _deflected(rigid, ((bearing, 0.0), (bearing, 0.2)), 0.1, 0.6 * force, 0.8 * force, 500, 0, 0, 0).at(0.1)[0]
    across = 30e-6 + force / 2 / 2e8
    yield from near(found[:3], (0.6 * across, 0.8 * across, 10e-6 + 500 / 2e8), 1e-8)
