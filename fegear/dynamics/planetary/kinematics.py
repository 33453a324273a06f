"""Speeds, torques and frequencies of a planetary set: Willis' relation, with the losses of its meshes.

What passes where how often: the mesh frequency, planets past a tooth, and the sidebands that moving planets make.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError, RangeError
from fegear.base.shown import shown, shows
from fegear.dynamics.planetary.planet_set import CENTRALS

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.dynamics.planetary.planet_set import Central, PlanetarySet

#: A sideband with a smaller share of the planets' sum is cancelled.
CANCELLED = 1e-9


@dataclass(frozen=True)
class Running:
    """How a set runs: speeds [rad/s] and outer torques [N m] count counter-clockwise.

    Parameters
    ----------
    fixed, input, output : {"sun", "ring", "carrier"}
    speed, torque : mapping of member to float
        Torques are those that act on the set from outside; they balance.
    planet_speed : float
        Of the planets, against the housing [rad/s].
    mesh_frequency : float
        [Hz]
    efficiency : float
        Power out over power in, with the losses of both meshes.
    mesh_efficiency : float
        Of both meshes one after the other, with the carrier at rest.
    """

    fixed: Central
    input: Central
    output: Central
    speed: dict[Central, float]
    torque: dict[Central, float]
    planet_speed: float = shown("rpm", "speed of the planets relative to the housing, counter-clockwise")
    mesh_frequency: float = shown("Hz", "mesh frequency")
    efficiency: float = shown("", "efficiency (output / input power) with friction of both meshes")
    mesh_efficiency: float = shown("", "efficiency of both meshes in series, carrier fixed")

    @property
    @shows("", "ratio of input to output speed")
    def ratio(self) -> float:
        """i."""
        return self.speed[self.input] / self.speed[self.output]

    @property
    def sun_turns(self) -> float:
        """Speed of the sun relative to the carrier [rad/s]."""
        return self.speed["sun"] - self.speed["carrier"]

    @property
    def sun_drives(self) -> bool:
        """Whether the sun drives the planets in the motion relative to the carrier, and these the ring."""
        return self.torque["sun"] * self.sun_turns > 0.0

    @property
    def mirrored(self) -> bool:
        """Whether the torque on the sun acts clockwise: the other flanks of all teeth carry."""
        return self.torque["sun"] < 0.0


def running(
    found: PlanetarySet, fixed: Central, driving: Central, speed: float, torque: float, mesh_efficiency: float = 1.0
) -> Running:
    """Speeds, torques and efficiency of a set with one member fixed.

    Parameters
    ----------
    found : PlanetarySet
    fixed, driving : {"sun", "ring", "carrier"}
    speed : float
        Of the driving member [rad/s], counter-clockwise.
    torque : float
        On the driving member [N m], in the sense of its rotation.
    mesh_efficiency : float
        eta_0, of both meshes one after the other with the carrier at rest.

    Raises
    ------
    InputError
        If the driving member is the fixed one.
    RangeError
        If speed, torque or efficiency is out of range.
    """
    if fixed == driving:
        raise InputError("input", f'"{driving}"', "is fixed as well", "choose a different fixed or driving member")
    if not (math.isfinite(speed) and speed != 0.0):
        raise RangeError("speed", speed, "must be finite and not zero")
    if not (math.isfinite(torque) and torque > 0.0):
        raise RangeError("torque", torque, "must be positive (acts in the direction of rotation)")
    if not 0.0 < mesh_efficiency <= 1.0:
        raise RangeError("mesh_efficiency", mesh_efficiency, "must be above 0 and at most 1")
    (driven,) = (name for name in CENTRALS if name not in (fixed, driving))
    ratio = found.ring_teeth / found.sun_teeth
    # z_s w_s + z_r w_r = (z_s + z_r) w_c, one of the speeds zero
    share = {"sun": 1.0, "ring": ratio, "carrier": -(1.0 + ratio)}
    speeds: dict[Central, float] = dict.fromkeys(CENTRALS, 0.0)
    speeds[driving] = speed
    speeds[driven] = -share[driving] * speed / share[driven]
    turns = speeds["sun"] - speeds["carrier"]
    # without losses torques are as the shares; their signs tell which way power rolls through the meshes
    rolling = math.copysign(1.0, share[driving] * speed) * turns
    passed = mesh_efficiency if rolling > 0.0 else 1.0 / mesh_efficiency
    torques = {"sun": 1.0, "ring": ratio * passed, "carrier": -(1.0 + ratio * passed)}
    scale = math.copysign(torque, speed) / torques[driving]
    outer: dict[Central, float] = {name: scale * torques[name] for name in CENTRALS}
    return Running(
        fixed, driving, driven, speeds, outer,
        planet_speed=speeds["carrier"] - turns * found.sun_teeth / found.planet_teeth,
        mesh_frequency=abs(turns) * found.sun_teeth / (2.0 * math.pi),
        efficiency=-outer[driven] * speeds[driven] / (torque * abs(speed)),
        mesh_efficiency=mesh_efficiency,
    )  # fmt: skip


@dataclass(frozen=True)
class AxialForces:
    """What helical teeth do along the axis where all planets carry alike; heights count toward the observer.

    Parameters
    ----------
    sun : float
        On the sun by all planets [N]. The ring takes the opposite, and the carrier nothing.
    tilting : float
        On each planet by its two meshes, about the tangent of its path counter-clockwise [N m].
    """

    sun: float = shown("N", "axial force of all planets on the sun, towards the observer", name="axial_force")
    tilting: float = shown("N.m", "tilting moment of each planet (equal load sharing)", name="tilting_moment")


def axial_forces(found: PlanetarySet, run: Running, base_twist: float) -> AxialForces:
    """Forces along the axis, by the principle of the screw: without friction F_z = -(tan(beta_b) / r_b) M on any gear.

    A planet's two meshes push it along the axis with opposite forces, which act at the pitch points of both.

    Parameters
    ----------
    found : PlanetarySet
    run : Running
    base_twist : float
        tan(beta_b) of the sun, positive for a right hand.
    """
    on_sun = base_twist * run.torque["sun"] / found.base_radius("sun")
    at_sun = found.base_radius("planet", "sun") / math.cos(found.sun_angle)
    arm = at_sun + found.base_radius("planet", "ring") / math.cos(found.ring_angle)
    return AxialForces(on_sun, -on_sun / found.count * arm)


@dataclass(frozen=True)
class Passing:
    """How often things meet [Hz].

    Parameters
    ----------
    what : tuple of str
    frequency : ndarray
    """

    what: tuple[str, ...] = shown("", "event")
    frequency: Array = shown("Hz", "frequency of the event")


def passing(found: PlanetarySet, run: Running) -> Passing:
    """Rotations, and planets that pass a place of each member."""
    turn = 2.0 * math.pi
    sun, ring = (abs(run.speed[name] - run.speed["carrier"]) / turn for name in ("sun", "ring"))
    planet = abs(run.planet_speed - run.speed["carrier"]) / turn
    rows = {
        "tooth mesh": run.mesh_frequency,
        "rotation of the sun": abs(run.speed["sun"]) / turn,
        "rotation of the ring": abs(run.speed["ring"]) / turn,
        "rotation of the carrier": abs(run.speed["carrier"]) / turn,
        "rotation of a planet": abs(run.planet_speed) / turn,
        "rotation of a planet in the carrier": planet,
        "passing frequency of a sun tooth (planets)": found.count * sun,
        "passing frequency of a ring tooth (planets)": found.count * ring,
        "contact frequency of a planet flank with the sun": planet,
        "contact frequency of a planet flank with the ring": planet,
    }
    return Passing(tuple(rows), np.array(list(rows.values())))


@dataclass(frozen=True)
class Sidebands:
    """Lines that a pick-up on the ring sees round a harmonic of the mesh frequency, as planets pass it.

    Parameters
    ----------
    harmonic, order : ndarray of int, shape (lines,)
    frequency, share : ndarray, shape (lines,)
    """

    harmonic: NDArray[np.intp] = shown("", "mesh harmonic")
    order: NDArray[np.intp] = shown("", "order, per revolution of the carrier relative to the ring")
    frequency: Array = shown("Hz", "frequency of the spectral line, observed at the ring")
    share: Array = shown(
        "", "resultant of all planets relative to the sum of their amplitudes: 1 in phase, 0 cancelled"
    )


def sidebands(found: PlanetarySet, run: Running, harmonics: int = 2, beside: int = 6) -> Sidebands:
    """Sidebands by the passing planets, all planets loaded alike (McFadden and Smith 1985).

    A planet that passes with the angle psi_n behind brings its mesh harmonic m with the phase -m z_r psi_n. Order
    q = m z_r + k of the carrier is left with abs(sum exp(-i q psi_n)) / N: of evenly spaced planets whole multiples of
    their number alone.
    """
    turns = abs(run.speed["ring"] - run.speed["carrier"]) / (2.0 * math.pi)
    m, k = (grid.ravel() for grid in np.meshgrid(
        np.arange(1, harmonics + 1), np.arange(-beside, beside + 1), indexing="ij"
    ))  # fmt: skip
    order = m * found.ring_teeth + k
    share = np.abs(np.exp(-1j * np.outer(order, found.angles)).sum(axis=1)) / found.count
    return Sidebands(m, order, np.asarray(order * turns, dtype=float), np.where(share < CANCELLED, 0.0, share))
