"""Phases of the meshes of a planetary set, and what they let its planets excite together.

The phase of a mesh is the place of a tooth pair on the line of action in base pitches, zero at the pitch point. That of
planet n follows the first planet's by the delays gamma: s - gamma_sn at the sun, s - gamma_rs - gamma_rn at the ring.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.shown import shown, shows

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.dynamics.planetary.planet_set import PlanetarySet

#: A sum of planets below this share of what they are together is cancelled.
CANCELLED = 1e-9


@dataclass(frozen=True)
class Phases:
    """Delays of the meshes of a set [base pitches].

    Parameters
    ----------
    angle : ndarray, shape (planets,)
        Of the planets [rad].
    sun, ring : ndarray, shape (planets,)
        gamma_sn and gamma_rn: of each planet's mesh behind that of the first.
    ring_behind_sun : float
        gamma_rs: of a planet's mesh with the ring behind its mesh with the sun.
    """

    angle: Array = shown("deg", "angular position of the planet, counter-clockwise")
    sun: Array = shown(
        "", "phase lag of the sun-planet mesh relative to the first planet, in base pitches", name="gamma_sn"
    )
    ring: Array = shown(
        "", "phase lag of the planet-ring mesh relative to the first planet, in base pitches", name="gamma_rn"
    )
    ring_behind_sun: float = shown(
        "", "phase lag of the ring mesh of a planet relative to its sun mesh, in base pitches", name="gamma_rs"
    )

    @property
    @shows("", "counter-clockwise")
    def planet(self) -> NDArray[np.intp]:
        """Numbers of the planets."""
        return np.arange(1, self.angle.size + 1)

    @property
    def delays(self) -> Array:
        """Delay of every mesh, sun's in row 0 and ring's in row 1 [base pitches], shape (2, planets)."""
        return np.array([self.sun, self.ring + self.ring_behind_sun])


def mesh_phases(found: PlanetarySet, *, clockwise: bool = False, sun_drives: bool = True) -> Phases:
    """Phases from tooth numbers, angles and half the tooth of a planet.

    gamma_sn = z_s psi_n / 2 pi, gamma_rn = -z_r psi_n / 2 pi, gamma_rs = z_p/2 - z_p (tau_s + tau_r) / 2 pi, all modulo
    1, with the sun turning counter-clockwise against the carrier and driving the planets. Turning clockwise it meets
    the planets the other way round; where it is driven, the other flanks bear and gamma_rs changes its sign.

    Parameters
    ----------
    found : PlanetarySet
    clockwise : bool
        Whether the sun turns clockwise relative to the carrier.
    sun_drives : bool
        Whether the sun drives the planets in the motion relative to the carrier.
    """
    turn = 2.0 * math.pi
    psi = (found.angles - found.angles[0]) * (-1.0 if clockwise else 1.0)
    z = found.planet_teeth
    behind = 0.5 * z - z * (found.half_tooth_angle("sun") + found.half_tooth_angle("ring")) / turn
    return Phases(
        found.angles,
        _part(found.sun_teeth * psi / turn),
        _part(-found.ring_teeth * psi / turn),
        float(_part(behind if sun_drives else -behind)),
    )


def whole_delays(
    found: PlanetarySet, phases: Phases, planet: int, *, clockwise: bool = False, sun_drives: bool = True
) -> Array:
    """Delays of the meshes with the whole base pitches that phases leave out: which teeth meet where.

    Teeth have numbers in the order of meshing. Tooth 0 of one planet meets teeth 0 of the sun, and half a turn of this
    planet later, but for the thickness of its tooth, tooth 0 of the ring with its other flank. Every other planet meets
    teeth 0 of sun and ring when they have come round to it; teeth of these planets are all alike.

    Parameters
    ----------
    found : PlanetarySet
    phases : Phases
        Of the same set.
    planet : int
        The planet with tooth 0, from 0.
    clockwise, sun_drives : bool
        As of `mesh_phases`.

    Returns
    -------
    ndarray, shape (2, planets)
        Place in the cycle at which teeth 0 of sun (0) and ring (1) are at the pitch point [base pitches].
    """
    turn = 2.0 * math.pi
    psi = (found.angles - found.angles[planet]) * (-1.0 if clockwise else 1.0)
    z, thick = found.planet_teeth, found.half_tooth_angle("sun") + found.half_tooth_angle("ring")
    behind = 0.5 * z + (-z if sun_drives else z) * thick / turn
    first = phases.sun[planet]
    whole = first + np.stack([found.sun_teeth * psi / turn, behind - found.ring_teeth * psi / turn])
    return np.asarray(phases.delays + np.rint(whole - phases.delays))


def _part(pitches: Array | float) -> Array:
    """The part of a phase below one; what is whole but for round-off is zero."""
    part = np.asarray(pitches, dtype=float) % 1.0
    return np.where(np.abs(part - np.rint(part)) < 1e-12, 0.0, part)


def common_parts(found: PlanetarySet) -> int:
    """Into how many equal parts of a base pitch the delays between planets are whole multiples."""
    teeth = found.sun_teeth + found.ring_teeth
    places = np.rint((found.angles - found.angles[0]) * teeth / (2.0 * math.pi)).astype(int)
    return math.lcm(*(Fraction(found.sun_teeth * int(place), teeth).denominator for place in places))


@dataclass(frozen=True)
class Phasing:
    """What each harmonic of equal meshes adds up to over the planets.

    Parameters
    ----------
    harmonic : ndarray of int, shape (harmonics,)
    torque, force : ndarray, shape (harmonics,)
        Share of the planets' sum that is left as a torque, and as a force across the axis.
    excites : tuple of str
        "rotation", "translation", both, or "planets" alone.
    """

    harmonic: NDArray[np.intp] = shown("", "mesh harmonic")
    torque: Array = shown("", "resultant torque about the axis, relative to planets in phase")
    force: Array = shown("", "resultant radial force, relative to planets in phase")
    excites: tuple[str, ...] = shown("", "type of modes excited")


def phasing(found: PlanetarySet, harmonics: int) -> Phasing:
    """Which harmonics of the mesh frequency the phases of the planets cancel.

    Of harmonic l planet n brings exp(-2 pi i l gamma_n): as a torque these add as they are, as a force each with its
    direction exp(+-i psi_n). Evenly spaced planets leave the torque where l z_s / N is whole, the force where
    (l z_s +- 1) / N is, and neither in all other harmonics (Parker 2000).
    """
    order = np.arange(1, harmonics + 1)
    psi = found.angles - found.angles[0]
    turned = np.exp(-1j * np.outer(order * found.sun_teeth, psi))
    torque = np.abs(turned.sum(axis=1)) / found.count
    force = np.maximum(*(np.abs((turned * np.exp(sign * 1j * psi)).sum(axis=1)) for sign in (1.0, -1.0))) / found.count
    torque, force = (np.where(share < CANCELLED, 0.0, share) for share in (torque, force))
    words = {(True, False): "rotation", (False, True): "translation", (True, True): "rotation and translation"}
    excites = tuple(words.get((t > 0.0, f > 0.0), "planets") for t, f in zip(torque, force, strict=True))
    return Phasing(order, torque, force, excites)
