"""Rows against closed forms and independent code of our own, which runs with the row."""

from __future__ import annotations

import itertools
import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import Any

import numpy as np

from fegear.base.arrays import Array
from fegear.dynamics.planetary.planet_set import Central
from fegear.geometry.internal_tooth import InternalTooth
from fegear.verify.row import Compared, Rows, near

ROWS = Rows()
E, NU = 206e9, 0.3


@dataclass(frozen=True)
class StiffeningHalf:
    """Half of a double helical pair whose approach is gap + (W / a)^n."""

    a: float
    n: float
    gap: float

    @property
    def touch(self) -> Array:
        """Approach at which it first touches [m]."""
        return np.array([[self.gap]])

    def under(self, load: Array) -> tuple[Array, Array]:
        """Approach [m] and stiffness [N/m] under loads [N]."""
        zeta = (load / self.a) ** self.n
        return self.gap + zeta, load / (self.n * zeta)

    def force(self, zeta: float) -> float:
        """Load at an approach [N]."""
        return self.a * max(zeta - self.gap, 0.0) ** (1.0 / self.n)


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
        k, l = ellipk(e2), ellipe(e2)  # noqa: E741  (names of the literature)
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


@ROWS.add(
    "load sharing of double helical halves", "own", "the floating member's axial position searched for, not the share"
)
def double_helical_halves() -> Iterator[Compared]:
    """Share, transmission error and position of 40 pairs of stiffening halves: free, with play, located."""
    from scipy.optimize import brentq

    from fegear.contact.double_helical.balance import AxialSeat, balance

    rng = np.random.default_rng(52)
    for number in range(40):
        halves = [StiffeningHalf(rng.uniform(1e8, 1e9), rng.uniform(0.7, 1.0), rng.uniform(0, 1e-5)) for _ in range(2)]
        twist = (rng.uniform(0.2, 0.6), -rng.uniform(0.2, 0.6))
        room = (0.0, 1e-6, 1e-2)[number % 3]
        seat, load = AxialSeat(twist, rng.uniform(-1e-5, 1e-5), room, rng.uniform(-50.0, 50.0)), 4000.0

        def at(q: float, halves: Any = halves, twist: Any = twist, load: float = load) -> tuple[float, float]:
            def forces(zeta: float) -> list[float]:
                return [half.force(zeta + t * q) for half, t in zip(halves, twist, strict=True)]

            zeta = brentq(lambda one: sum(forces(one)) - load, -1e-2, 1.0, xtol=1e-18, rtol=1e-14)
            return zeta, forces(zeta)[0]

        def push(q: float, at: Any = at, seat: Any = seat, twist: Any = twist, load: float = load) -> float:
            first = at(q)[1]
            return float(first * twist[0] + (load - first) * twist[1] - seat.force)

        low, high = seat.offset - room, seat.offset + room
        q = low if push(low) >= 0.0 else high if push(high) <= 0.0 else brentq(push, low, high, xtol=1e-18, rtol=1e-14)
        found, (zeta, first) = balance(halves[0], halves[1], load, seat), at(q)
        yield from near(found.share.item(), first / load, 1e-7, scale=1.0)
        yield from near(found.approach.item(), zeta, 1e-8)
        yield from near(found.position.item(), q, 1e-6, scale=1e-5)


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
