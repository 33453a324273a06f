"""Root stress of a tooth in the mesh as it is shown: by source, under every load, along the face."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.case.built.root_stress_sources import FINITE_ELEMENTS

if TYPE_CHECKING:
    from fegear.contact.plane.tooth_stress import ToothStress
    from fegear.contact.wide.root_stress import StressOverFace
    from fegear.geometry.pair import GearPair, Member

#: Points of a map over the way of the tooth and along the face.
_ACROSS, _ALONG = 181, 81


def ending(sources: Sequence[str], k: int) -> str:
    """What the names of columns and values of the k-th source end in: nothing for the first."""
    return f"_{sources[k].replace('-', '_')}" if k else ""


def told(source: str) -> str:
    """A source in words."""
    return "finite elements" if source == FINITE_ELEMENTS else source


@dataclass(frozen=True)
class StressUnder:
    """Largest tension by one source under a load that is not the nominal one."""

    ending: str
    stress: ToothStress
    tension: Array
    load: float = shown("N", "load along the line of action")


@dataclass(frozen=True)
class StressBySource:
    """Root stress of one tooth by one source.

    Parameters
    ----------
    stress : ToothStress
    member, gear, source : str
    ending : str
        Of names of columns and values.
    role : str
        Of its curve.
    several : bool
        Whether there are other sources of this gear.
    loads : tuple of float
        [N].
    at : int
        Number of the nominal one.
    over_face : StressAlongFace or None
    """

    stress: ToothStress
    member: Member
    gear: str
    source: str
    ending: str
    role: str
    several: bool
    loads: Sequence[float]
    at: int
    over_face: StressAlongFace | None

    @property
    def said(self) -> str:
        """The source in words."""
        return told(self.source)

    @property
    def label(self) -> str:
        """In a legend."""
        return f"{self.member} {self.gear}" + (f", {self.said}" if self.several else "")

    @property
    def known_error(self) -> Array | None:
        """Estimated error of the tension at the nominal load [Pa], shape (P,)."""
        return self.stress.tension_error[:, self.at] if self.stress.knows_error else None

    @property
    def under_others(self) -> list[StressUnder]:
        """Under every other load."""
        return [
            StressUnder(self.ending, self.stress, self.stress.tension[:, j], load)
            for j, load in enumerate(self.loads)
            if j != self.at
        ]

    @property
    def known(self) -> bool:
        """Whether it gives any stress at the nominal load."""
        return not bool(np.isnan(self.stress.tension[:, self.at]).all())

    def _at(self, x: float) -> str:
        by = self.said
        if self.stress.between is not None:
            by = f"largest tension at face position {float(self.stress.between.tension_z[self.at]) * 1e3:.4g} mm"
        return f"gear {self.gear}, {by}, contact at x = {x * 1e3:.5g} mm"

    @property
    def at_tension(self) -> str:
        """Where tension is largest, and by what it was found."""
        return self._at(self.stress.x_of_tension(self.at))

    @property
    def at_compression(self) -> str:
        """The same of compression."""
        x = self.stress.x_of_compression(self.at)
        return "" if x is None else self._at(x)

    @property
    def tension_off(self) -> float | None:
        """Estimated error of the largest tension [Pa]."""
        return self.stress.error(self.at)

    @property
    def compression_off(self) -> float | None:
        """Estimated error of the largest compression [Pa]."""
        return self.stress.compression_off(self.at)

    @property
    def range_off(self) -> float | None:
        """Estimated error of the range of stress [Pa]."""
        return self.stress.range_off(self.at)


@dataclass(frozen=True)
class StressAlongFace:
    """Stress of both fillets along the face at every position of a tooth, at the nominal load."""

    tension: StressOverFace
    compression: StressOverFace

    @property
    def pulled_z(self) -> Array:
        """Where tension is largest along the face [m]."""
        return self.tension.largest(1.0)[1]

    @property
    def pulled_radius(self) -> Array:
        """Radius of the place [m]."""
        return self.tension.largest(1.0)[2]

    @property
    def pressed_z(self) -> Array:
        """Where compression is largest along the face [m]."""
        return self.compression.largest(-1.0)[1]

    def rows(self, side: str, quantity: str) -> Array:
        """A quantity of one fillet in rows, the place along the face fastest."""
        found: StressOverFace = getattr(self, side)
        return np.broadcast_to(getattr(found, quantity), found.value.shape).ravel()

    @property
    def x(self) -> Array:
        """Position of the tooth in each row [m]."""
        return np.repeat(self.tension.x, self.tension.z.size)


@dataclass(frozen=True)
class StressedTooth:
    """One tooth of a gear on its way through the mesh, by every source.

    Parameters
    ----------
    member, gear, label : str
        The label stands in the names of its tables.
    sources : tuple of StressBySource
    rate : float or None
        Velocity of the contact along the line of action [m/s].
    over_face : StressAlongFace or None
    across_off : float or None
        Estimated error of `across` [Pa].
    """

    member: Member
    gear: str
    label: str
    sources: tuple[StressBySource, ...]
    rate: float | None
    over_face: StressAlongFace | None
    across_off: float | None
    across: float | None = shown(
        "MPa", "maximum root stress, tension side, in the normal section (comparable with formulas)",
        name="largest_root_tension_across",
    )  # fmt: skip

    @property
    def first(self) -> ToothStress:
        """By the source that is the result."""
        return self.sources[0].stress

    @property
    @shows("s", "time from the first position")
    def t(self) -> Array | None:
        """Time, where a speed is given [s]."""
        return None if self.rate is None else (self.first.x - self.first.x[0]) / self.rate


@dataclass(frozen=True)
class FaceMap:
    """Largest tension of a gear along the face over the way of a tooth, on even steps."""

    member: Member
    gear: str
    x: Array = shown("mm", "position of the tooth's contact on the line of action")
    z: Array = shown("mm", "face position z")
    value: Array = shown("MPa", "largest root tension")
    most: float = shown("MPa", "largest root tension")

    @classmethod
    def of(cls, tooth: StressedTooth, found: StressOverFace) -> FaceMap:
        """Of a tooth; its roll positions stand unevenly, it is straight between them."""
        x, z = np.linspace(found.x[0], found.x[-1], _ACROSS), np.linspace(found.z[0], found.z[-1], _ALONG)
        way = np.stack([np.interp(x, found.x, along) for along in found.value.T])
        value = np.stack([np.interp(z, found.z, along) for along in way.T], axis=1)
        return cls(tooth.member, tooth.gear, x, z, value, float(found.value.max()))


@dataclass(frozen=True)
class StressInMesh:
    """Teeth of both gears in the mesh.

    Parameters
    ----------
    pair : GearPair
    loads : tuple of float
        [N].
    at : int
        Number of the nominal one.
    notes : mapping of member to mapping of str to tuple of str
        What sources say of their own values.
    teeth : mapping of member to StressedTooth
    """

    pair: GearPair
    loads: Sequence[float]
    at: int
    notes: Mapping[Member, Mapping[str, tuple[str, ...]]]
    teeth: Mapping[Member, StressedTooth]

    @property
    @shows("N.m", "torque on the driver")
    def torque(self) -> float:
        """Nominal [N m]."""
        return self.loads[self.at] * self.pair.driver.base_radius

    @property
    def sources(self) -> list[StressBySource]:
        """Of both gears."""
        return [source for tooth in self.teeth.values() for source in tooth.sources]

    @cached_property
    def maps(self) -> list[FaceMap]:
        """Of gears with a width."""
        return [FaceMap.of(tooth, tooth.over_face.tension) for tooth in self.teeth.values() if tooth.over_face]

    @property
    def top(self) -> float:
        """Largest of both maps [Pa]."""
        return max(one.most for one in self.maps)

    @property
    def largest(self) -> str:
        """Largest tensions in words."""
        most = [(one, float(one.stress.largest_tension[one.at]) * 1e-6) for one in self.sources]
        return " and ".join(
            f"{value:.4g} MPa ({one.member}{f', {one.said}' if one.several else ''})"
            for one, value in most
            if np.isfinite(value)
        )
