"""Sun, planets, ring and carrier put together: what turns where, and whether it can be assembled.

Angles count counter-clockwise and the sun turns counter-clockwise relative to the carrier; lengths are in metres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.base.errors import GeometryError, InputError
from fegear.base.shown import shows
from fegear.geometry.involute import inv

if TYPE_CHECKING:
    from fegear.base.arrays import Array

Central = Literal["sun", "ring", "carrier"]

#: The members that turn about the axis of the set.
CENTRALS: tuple[Central, Central, Central] = ("sun", "ring", "carrier")

#: How far planets may be from angles at which both meshes fit [pitches]: a part of what no drawing writes.
_FITS = 1e-6


@dataclass(frozen=True)
class PlanetarySet:
    """One sun, equal planets at given angles, one ring, one carrier.

    Parameters
    ----------
    sun_teeth, planet_teeth, ring_teeth : int
        Positive, the ring's too.
    base_pitch : float
        Transverse base pitch [m]: of all meshes, or of the sun's where flanks differ.
    centre_distance : float
        From the axis of the set to that of a planet [m].
    angles : ndarray, shape (planets,)
        Of the planets [rad], increasing, within one turn of the first.
    planet_base_half_angle : float
        Half the angle of a planet's tooth at its base circle [rad].
    planet_tip_radius : float
        [m]; zero where neighbours are not checked.
    ring_base_pitch, planet_ring_half_angle : float
        Base pitch of the ring's meshes [m] and the angle of a planet's flank there from the middle of its tooth, at its
        base circle [rad], of asymmetric teeth: a planet meets sun and ring on different flanks. By default as at the
        sun.

    Raises
    ------
    GeometryError
        If base circles do not suit the centre distance, planets do not fit between sun and ring, or they meet each
        other.
    """

    sun_teeth: int
    planet_teeth: int
    ring_teeth: int
    base_pitch: float
    centre_distance: float
    angles: Array
    planet_base_half_angle: float
    planet_tip_radius: float = 0.0
    ring_base_pitch: float = math.nan
    planet_ring_half_angle: float = math.nan

    def __post_init__(self) -> None:
        """Fill in what is as at the sun, and refuse sets that cannot be assembled."""
        for key, usual in (("ring_base_pitch", "base_pitch"), ("planet_ring_half_angle", "planet_base_half_angle")):
            if math.isnan(getattr(self, key)):
                object.__setattr__(self, key, getattr(self, usual))
        angles = np.array(self.angles, dtype=float)
        angles.setflags(write=False)
        object.__setattr__(self, "angles", angles)
        for key in ("sun_teeth", "planet_teeth", "ring_teeth"):
            if getattr(self, key) < 1:
                raise GeometryError(key, getattr(self, key), "must be a positive number of teeth")
        if not angles.size:
            raise InputError("planets", 0, "must be at least 1")
        span = float(angles[-1] - angles[0])
        if np.any(np.diff(angles) <= 0.0) or span >= 2.0 * math.pi:
            raise InputError(
                "angles", ", ".join(f"{one:.6g} deg" for one in np.degrees(angles)),
                "must be increasing within one revolution", "specify the planets counter-clockwise, from 0 deg",
            )  # fmt: skip
        self._check_distance()
        check_assembly(self)
        check_neighbours(self)

    def _check_distance(self) -> None:
        sun, planet, ring = (self.base_radius(name) for name in ("sun", "planet", "ring"))
        inside = self.base_radius("planet", "ring")
        least = max(sun + planet, ring - inside)
        if ring <= inside:
            raise GeometryError("ring", self.ring_teeth, f"must have more teeth than the planet's {self.planet_teeth}")
        if self.centre_distance <= least:
            raise GeometryError(
                "centre_distance", f"{self.centre_distance * 1e3:.6g} mm",
                f"must exceed {least * 1e3:.6g} mm, for both lines of action to exist",
                "increase it, or check the numbers of teeth",
            )  # fmt: skip

    @property
    def count(self) -> int:
        """Number of planets."""
        return int(self.angles.size)

    def base_radius(self, body: Literal["sun", "planet", "ring"], mesh: Literal["sun", "ring"] = "sun") -> float:
        """Base radius [m]; of a planet that of the flanks which meet sun or ring."""
        teeth: int = getattr(self, f"{body}_teeth")
        pitch = self.ring_base_pitch if "ring" in (body, mesh) else self.base_pitch
        return teeth * pitch / (2.0 * math.pi)

    @property
    def ring_lever(self) -> float:
        """Base radius of a planet's flanks at the ring over that of those at the sun; 1 of equal flanks.

        The force in a ring's mesh is that in the sun's mesh divided by it.
        """
        return self.ring_base_pitch / self.base_pitch

    def lever(self, member: Central) -> float:
        """Radius by which a rotation of the member counts as a length [m]: base radius, or the centre distance."""
        return self.centre_distance if member == "carrier" else self.base_radius(member)

    @cached_property
    @shows("deg", "working pressure angle, sun-planet")
    def sun_angle(self) -> float:
        """alpha_w of the sun's mesh [rad]."""
        return math.acos((self.base_radius("sun") + self.base_radius("planet")) / self.centre_distance)

    @cached_property
    @shows("deg", "working pressure angle, planet-ring")
    def ring_angle(self) -> float:
        """alpha_w of the ring's mesh [rad]."""
        return math.acos((self.base_radius("ring") - self.base_radius("planet", "ring")) / self.centre_distance)

    def half_tooth_angle(self, mesh: Literal["sun", "ring"]) -> float:
        """tau: half the angle of a planet's tooth at its working pitch radius of a mesh [rad].

        Of asymmetric teeth from the middle of the tooth to the flank that is loaded in the mesh.
        """
        if mesh == "sun":
            return self.planet_base_half_angle - float(inv(self.sun_angle))
        return self.planet_ring_half_angle - float(inv(self.ring_angle))

    @cached_property
    def neighbours(self) -> Array:
        """Angle from each planet to the next one counter-clockwise [rad], shape (planets,)."""
        return np.diff(np.append(self.angles, self.angles[0] + 2.0 * math.pi))

    @property
    def evenly_spaced(self) -> bool:
        """Whether the planets stand at equal angles."""
        return bool(np.max(np.abs(self.neighbours - 2.0 * math.pi / self.count)) < 1e-9)

    @property
    @shows("mm", "minimum distance between tip circles of adjacent planets")
    def neighbour_clearance(self) -> float:
        """2 a sin(psi/2) - d_a of the planets [m]; infinite for one planet."""
        if self.count == 1:
            return math.inf
        gap = float(np.min(self.neighbours))
        return 2.0 * self.centre_distance * math.sin(0.5 * gap) - 2.0 * self.planet_tip_radius

    def spacing_misfit(self) -> Array:
        """How far each planet is from the nearest angle at which both meshes fit [rad], shape (planets,).

        Sun and ring at rest, a planet goes in at every whole multiple of 2 pi / (z_s + z_r) from another one.
        """
        step = 2.0 * math.pi / (self.sun_teeth + self.ring_teeth)
        places = (self.angles - self.angles[0]) / step
        return np.asarray((places - np.rint(places)) * step)


def even_angles(planets: int) -> Array:
    """Angles of equally spaced planets, the first at zero [rad]."""
    if planets < 1:
        raise InputError("planets", planets, "must be at least 1")
    return 2.0 * math.pi * np.arange(planets) / planets


def check_assembly(found: PlanetarySet) -> None:
    """Refuse planets that do not fit between the teeth of sun and ring.

    Raises
    ------
    GeometryError
        With the margin and the angles or numbers of teeth that would do.
    """
    misfit = found.spacing_misfit()
    teeth = found.sun_teeth + found.ring_teeth
    step = 2.0 * math.pi / teeth
    if np.max(np.abs(misfit)) <= _FITS * step:
        return
    worst = int(np.argmax(np.abs(misfit)))
    angle, off = math.degrees(found.angles[worst]), math.degrees(misfit[worst])
    if found.evenly_spaced:
        raise GeometryError(
            "planets", found.count,
            f"cannot be equally spaced with {found.sun_teeth} and {found.ring_teeth} teeth (assembly condition): "
            f"{teeth} / {found.count} = {teeth / found.count:.6g} is not an integer; planet {worst + 1} would be "
            f"{abs(off):.4g} deg off",
            f"{_counts_that_fit(found)}change a number of teeth by "
            f"{min(teeth % found.count, found.count - teeth % found.count)}, or set angles = [...] in integer "
            f"multiples of 360/{teeth} deg",
        )  # fmt: skip
    raise GeometryError(
        f"angles[{worst}]", f"{angle:.8g} deg",
        f"violates the assembly condition: {abs(off):.4g} deg off an integer multiple of 360/{teeth} deg",
        f"use {angle - off:.8g} deg",
    )  # fmt: skip


def _counts_that_fit(found: PlanetarySet) -> str:
    """The nearest numbers of planets that stand evenly without meeting each other, as the beginning of a remedy."""
    teeth, reach = found.sun_teeth + found.ring_teeth, found.planet_tip_radius / found.centre_distance
    most = int(math.pi / math.asin(reach)) if 0.0 < reach < 1.0 else teeth
    fit = [one for one in range(1, most + 1) if teeth % one == 0]
    near = [max((one for one in fit if one < found.count), default=0), min((one for one in fit if one > found.count),
                                                                        default=0)]  # fmt: skip
    said = " or ".join(str(one) for one in near if one)
    return f"use {said} planets, " if said else ""


def check_neighbours(found: PlanetarySet) -> None:
    """Refuse planets whose tip circles meet.

    Raises
    ------
    GeometryError
        With the margin and the most planets that go in evenly.
    """
    room = found.neighbour_clearance
    if room > 0.0:
        return
    most = int(math.pi / math.asin(min(found.planet_tip_radius / found.centre_distance, 1.0)))
    raise GeometryError(
        "planets", found.count,
        f"adjacent planets interfere: tip circles overlap by {-room * 1e3:.4g} mm (2 a sin(psi/2) - d_a, psi = "
        f"{math.degrees(float(np.min(found.neighbours))):.4g} deg)",
        f"at most {most} equally spaced planets of this tip diameter fit at this centre distance",
    )  # fmt: skip
