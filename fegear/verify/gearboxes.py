"""Rows of planetary sets, gearboxes and tooth friction against statics and brute force of our own."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from itertools import pairwise
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.base.arrays import Array
from fegear.dynamics.planetary.planet_set import CENTRALS, Central
from fegear.verify.row import Compared, Rows, near

if TYPE_CHECKING:
    from fegear.geometry.gear import Gear
    from fegear.shafts.gearbox import Gearbox

ROWS = Rows()
E, NU = 206e9, 0.3


# ---- planetary sets ---------------------------------------------------------------------------------------------
@ROWS.add("phases of the meshes of planetary sets", "own", "polygons of sun, planets and ring rotated until contact")
def planetary_phases() -> Iterator[Compared]:
    """Delays of every mesh of five sets with profile shifts, unevenly spaced planets among them, in base pitches."""
    from fegear.dynamics.planetary.phases import mesh_phases
    from fegear.verify.polygons import SETS, apart, by_polygons, described

    for one in SETS:
        found, seen = mesh_phases(described(one)), by_polygons(one)
        yield from near(apart(seen[0, 0] - seen[0], found.sun), 0.0, 1e-10, scale=1.0)
        yield from near(apart(seen[1, 0] - seen[1], found.ring), 0.0, 1e-5, scale=1.0)
        yield from near(apart(seen[0] - seen[1], found.delays[1] - found.delays[0]), 0.0, 1e-5, scale=1.0)


@ROWS.add(
    "statics of helical planetary sets", "own",
    "rigid bodies with six degrees of freedom, helicoids with normals from cross products of tangents",
)  # fmt: skip
def helical_sets_in_space() -> Iterator[Compared]:
    """Mesh forces with errors of the pins, of the mean force; axial force on the sun and moments that tilt planets."""
    from fegear.dynamics.planetary.kinematics import axial_forces, running
    from fegear.dynamics.planetary.planet_loads import planet_loads
    from fegear.dynamics.planetary.planet_set import PlanetarySet, even_angles
    from fegear.dynamics.planetary.set_model import CentralBody, PlanetBody, SetModel
    from fegear.verify.bodies import PIN, TWIST, bodies_in_space
    from fegear.verify.planetary_sets import constant, meshed

    pitch, torque, springs = math.pi * 2e-3 * math.cos(math.radians(21.0)), 300.0, np.array([4e8, 6e8])
    found = PlanetarySet(24, 28, 81, pitch, 52.6e-3, even_angles(3), 0.07)  # other working angles at sun and ring
    errors = np.array([[10e-6, 0.0, -15e-6], [0.0, 30e-6, -5e-6]])
    cos_b = math.cos(math.atan(TWIST))
    supports: dict[Central, float] = {"sun": 2e8, "ring": math.inf, "carrier": 5e8}
    for driving in CENTRALS:
        sun, ring, carrier = (CentralBody(bearing=supports[name]) for name in CENTRALS)
        model = SetModel(found, sun, ring, carrier, PlanetBody(pin=PIN))
        run = meshed(model, constant(springs[0]), constant(springs[1]), torque=torque, driving=driving)
        outer = model.torque_load(torque)[[2, 5, 8]] * [found.lever(name) for name in CENTRALS]
        asked = bodies_in_space(
            found, supports, springs / cos_b**2, errors, float(outer[CENTRALS.index(driving)]), driving
        )
        if asked is None:
            raise AssertionError("the bodies in space find no equilibrium")
        normal, moments, along = asked
        loads = planet_loads(run, errors)
        yield from near(loads.mesh_force[..., 0], normal * cos_b, 1e-8, scale=run.mean_force)
        equal = axial_forces(found, running(found, "ring", "sun", 100.0, torque), TWIST)
        yield from near(equal.sun, -along[0].sum(), 1e-6)
        yield from near(equal.tilting * loads.shares, moments, 1e-6, scale=abs(equal.tilting))


# ---- gearboxes --------------------------------------------------------------------------------------------------
_LENGTH, _LOAD, _RADIAL, _AXIAL = 0.1, 4000.0, 2e8, 1e8
_DIAMETERS = {"in": 0.022, "mid": 0.025, "out": 0.028}


def _helical(teeth: int, hand: Literal["left", "right"]) -> Gear:
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.gear import Gear, Material

    return Gear(Tooth(teeth, helix_angle=math.radians(15.0)), 3e-3, 11e-3, 20e-3, Material(E, NU), hand=hand)


def _two_stages() -> Gearbox:
    """Three shafts on two bearings each, the left one of which holds along the axis, and two helical meshes."""
    from fegear.geometry.pair import GearPair
    from fegear.shafts.beam import Shaft
    from fegear.shafts.bearing import stiff
    from fegear.shafts.gearbox import Gearbox
    from fegear.shafts.held import LoadedShaft, Seat
    from fegear.shafts.mesh import MeshPlace
    from fegear.shafts.section import Section

    pairs = GearPair(_helical(20, "right"), _helical(31, "left")), GearPair(_helical(23, "left"), _helical(40, "right"))
    meshes = (
        MeshPlace("I", ("in", "mid"), (0.03, 0.03), np.array([1.0, 0.0]), 1, pairs[0], _LOAD),
        MeshPlace("II", ("mid", "out"), (0.07, 0.07), np.array([0.6, 0.8]), -1, pairs[1], 1.4 * _LOAD),
    )
    seats = Seat(stiff(_RADIAL, _AXIAL), 0.0), Seat(stiff(_RADIAL), _LENGTH)
    shafts = tuple(
        LoadedShaft(Shaft((Section(_LENGTH, d),), E, NU), seats, np.empty(0), np.empty((0, 6)), name)
        for name, d in _DIAMETERS.items()
    )
    return Gearbox(shafts, (0.0, 0.0, _LENGTH), meshes, np.zeros((30, 30)), tuple(_DIAMETERS))


def _pitch_forces(box: Gearbox) -> dict[str, list[tuple[float, Array, Array]]]:
    """Of every shaft: middle of a face, force of the mesh, and where it acts across the axis, by the rules of a book.

    F_t = T / r, F_r = F_t tan(alpha_wt), F_a = F_t tan(beta_w); a driver thrusts along the thumb of the hand of its
    helix whose fingers turn with it.
    """
    found: dict[str, list[tuple[float, Array, Array]]] = {name: [] for name in box.names}
    for mesh in box.meshes:
        pair, y = mesh.found, np.array([*mesh.towards, 0.0])
        tangent = mesh.sense * np.array([-y[1], y[0], 0.0])
        r = [0.5 * 3e-3 * gear.teeth / math.cos(math.radians(15.0)) for gear in (pair.driver, pair.driven)]
        alpha = math.atan(math.tan(math.radians(20.0)) / math.cos(math.radians(15.0)))  # no shifts: it works there
        turn = mesh.load * math.cos(alpha)
        thrust = mesh.sense * (1.0 if pair.driver.hand == "right" else -1.0) * turn * math.tan(math.radians(15.0))
        on_driven = turn * tangent + turn * math.tan(alpha) * y - np.array([0.0, 0.0, thrust])
        found[mesh.shafts[0]].append((mesh.at[0], -on_driven, r[0] * y))
        found[mesh.shafts[1]].append((mesh.at[1], on_driven, -r[1] * y))
    return found


def _bearings(forces: list[tuple[float, Array, Array]]) -> tuple[Array, Array]:
    """Forces of the left and the right bearing on a shaft, by moments about the left one."""
    total = np.sum([force for _, force, _ in forces], axis=0)
    moment = np.sum([np.cross(arm + np.array([0.0, 0.0, at]), force) for at, force, arm in forces], axis=0)
    right = np.array([-moment[1] / _LENGTH, moment[0] / _LENGTH, 0.0])
    return -total - right, right


@ROWS.add("bearing forces of a two-stage helical gearbox", "own", "moments by hand, tooth forces from a textbook")
def gearbox_reactions() -> Iterator[Compared]:
    """Three forces of six bearings under two meshes in different planes, of the mesh force."""
    box = _two_stages()
    for bent, forces in zip(box.under(box.even), _pitch_forces(box).values(), strict=True):
        for found, wanted in zip(bent.bearing_forces[:, :3], _bearings(forces), strict=True):
            yield from near(found, wanted, 1e-10, scale=_LOAD)


@ROWS.add("bending of the shafts of a two-stage helical gearbox", "own", "energy of beams and bearings by quadrature")
def gearbox_energy() -> Iterator[Compared]:
    """Work of all mesh forces on what shafts and bearings give way, and twice the energy that these then hold."""
    box = _two_stages()
    bent, forces = box.under(box.even), _pitch_forces(box)
    for number, name in enumerate(box.names):
        one, own, share = bent[number], forces[name], np.full(17, 1.0 / 16.0)
        share[[0, -1]] *= 0.5  # as evenly over the face as 17 places have it
        parts = [(at + z, part * force, arm) for at, force, arm in own
                 for z, part in zip(np.linspace(-10e-3, 10e-3, 17), share, strict=True)]  # fmt: skip
        torque = -sum(float(np.cross(arm, force)[2]) for _, force, arm in own)  # of the coupling
        coupling = box.couplings[number] or 0.0
        work = torque * one.at(coupling)[0, 5]
        for at, force, arm in parts:
            moved = one.at(at)[0]
            work += float(force @ (moved[:3] + np.cross(moved[3:], arm)))
        yield from near(work, 2.0 * _energy(parts, (coupling, torque), _bearings(own), name), 1e-9)


def _energy(
    parts: list[tuple[float, Array, Array]], coupling: tuple[float, float], bearings: tuple[Array, Array], name: str
) -> float:
    """Of a round shaft, by stretching, shear, torsion and bending, and of its two bearings."""
    d = _DIAMETERS[name]
    area, inertia, shear = 0.25 * math.pi * d**2, math.pi / 64.0 * d**4, E / (2.0 * (1.0 + NU))
    kappa = 6.0 * (1.0 + NU) / (7.0 + 6.0 * NU)  # Cowper's, of a solid round section
    points = [(at, force, np.cross(arm, force)) for at, force, arm in parts]
    points += [(at, force, np.zeros(3)) for at, force in zip((0.0, _LENGTH), bearings, strict=True)]
    points.append((coupling[0], np.zeros(3), np.array([0.0, 0.0, coupling[1]])))
    ends = np.unique([0.0, _LENGTH, *(at for at, _, _ in points)])
    x, w = np.polynomial.legendre.leggauss(4)
    total = 0.0
    for low, high in pairwise(ends.tolist()):
        for s, weight in zip(0.5 * (low + high) + 0.5 * (high - low) * x, 0.5 * (high - low) * w, strict=True):
            force, moment = np.zeros(3), np.zeros(3)
            for at, f, m in points:
                if at < s:
                    force, moment = force + f, moment + m + np.cross([0.0, 0.0, at - s], f)
            held = force**2 / [kappa * shear * area, kappa * shear * area, E * area]
            total += 0.5 * weight * float((held + moment**2 / [E * inertia, E * inertia, 2.0 * shear * inertia]).sum())
    for one, axial in zip(bearings, (_AXIAL, math.inf), strict=True):
        total += 0.5 * float((one**2 / [_RADIAL, _RADIAL, axial]).sum())
    return total


@dataclass(frozen=True)
class _Springs:
    """Flanks as springs side by side, which push where they touch."""

    stiffness: Array

    def under(self, gap: Array, load: float) -> tuple[Array, Array]:
        """Forces at the heights and their growth with the gaps."""
        order = np.argsort(gap[0])
        for count in range(gap[0].size, 0, -1):
            on = order[:count]
            k = self.stiffness[on]
            approach = (load + k @ gap[0, on]) / k.sum()
            if (approach > gap[0, on]).all():
                break
        force, growth = np.zeros_like(gap), np.zeros((gap.size, gap.size))
        force[0, on] = k * (approach - gap[0, on])
        growth[np.ix_(on, on)] = np.outer(k, k) / k.sum() - np.diag(k)
        return force, growth


@ROWS.add("two meshes on shafts, coupled solution", "own", "shafts and meshes solved alternately until converged")
def two_meshes_in_turn() -> Iterator[Compared]:
    """Loads over both faces of a gearbox whose flanks are springs, some of which do not touch, of the mean one."""
    from fegear.contact.wide.on_shafts import load_gearbox

    box = _two_stages()
    flanks = []
    for mesh in box.meshes:
        share = np.full(mesh.heights.size, 1.0 / (mesh.heights.size - 1))
        share[[0, -1]] *= 0.5
        flanks.append(_Springs(4e9 * share))
    (found,) = load_gearbox(box, flanks, [1.0])
    gaps = [np.zeros_like(gap) for gap in found.gaps]
    for _ in range(400):
        forces = tuple(one.under(gap, m.load)[0] for one, gap, m in zip(flanks, gaps, box.meshes, strict=True))
        moved = tuple(one.at(z) for one, z in zip(box.under(forces), box.places, strict=True))
        opened = box.gaps(moved)
        left = max(float(np.abs(one - other).max()) for one, other in zip(gaps, opened, strict=True))
        gaps = [0.85 * one + 0.15 * other for one, other in zip(gaps, opened, strict=True)]
        if left < 1e-13:  # forces to 1e-10 of the mean one
            break
    for mine, other, mesh in zip(found.forces, forces, box.meshes, strict=True):
        yield from near(mine[0], other[0], 1e-8, scale=mesh.load / mesh.heights.size)


# ---- friction of the teeth --------------------------------------------------------------------------------------
@ROWS.add("gear mesh power loss", "own", "mu W |v| integrated over a base pitch, piece by piece")
def friction_loss() -> Iterator[Compared]:
    """Mean power of a constant coefficient at an external and an internal mesh whose pairs in contact share evenly."""
    from fegear.dynamics.train.excitation import MeshExcitation
    from fegear.dynamics.train.friction import friction_over_path
    from fegear.dynamics.train.gear_train import TrainMesh
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.gear import Gear
    from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
    from fegear.geometry.pair import GearPair

    pinion: Gear = Gear(Tooth(25), 2e-3, 15e-3, 20e-3)
    wheel: Gear = Gear(Tooth(60), 2e-3, 40e-3, 20e-3)
    ring: Gear = Gear(InternalTooth(80, PinionCutter(30), tip_radius=39.1), 2e-3, 90e-3, 20e-3)
    mu, load, frequency = 0.05, 2000.0, 500.0
    for other, inside in ((wheel, False), (ring, True)):
        pair = GearPair(pinion, other)
        a, b, p = pair.x_start, pair.x_end, pair.base_pitch
        even = MeshExcitation.from_tooth_pair(lambda x: np.full_like(x, 3e8), np.zeros_like, a, b, p)
        found = friction_over_path(TrainMesh.under(pair, even, load), frequency, lambda v, _roll, _load: mu + 0.0 * v)
        turns = [2.0 * math.pi * frequency / gear.teeth for gear in (pinion, other)]
        sliding = abs(turns[0] + (-turns[1] if inside else turns[1]))

        def area(low: float, high: float) -> float:
            """Integral of |x|."""
            return 0.5 * (high * abs(high) - low * abs(low))

        one, two = area(b - p, a + p), area(a, b - p) + area(a + p, b)  # one pair in contact, and two
        yield from near(found.loss, mu * load * sliding * (one + 0.5 * two) / p, 1e-6)
        yield from near(found.power, load * 0.5 * 25 * 2e-3 * math.cos(math.radians(20.0)) * turns[0], 1e-12)
