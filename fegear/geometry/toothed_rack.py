"""A rack: a straight row of teeth in its real size, with the body below them, how it is held, and its material.

Sides and ends of a helical rack follow its teeth: its section at z is that in the middle of the face, moved along the
rack by tan(beta) z.

It is no `Gear`: it has no bore, no circles and no axis, and it has two ends. What takes a gear cannot be given one.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

from fegear.base.errors import GeometryError, InputError
from fegear.base.given import given
from fegear.base.shown import shown
from fegear.geometry.gear import Hand, Material, Plane
from fegear.geometry.rack_tooth import RackTooth

#: Teeth of the longest rack; the middle teeth of longer ones answer as these.
MOST_TEETH = 1000
#: Beyond it plane strain elements stiffen, as of gears.
_LARGEST_POISSON_RATIO = 0.4999
#: Narrowest pin, and the least free width beside it [modules].
_NARROWEST = 0.1


@dataclass(frozen=True, slots=True)
class RackPins:
    """Pins (bolts, dowels) that hold a rack at its back, in the middle below teeth of equal distance.

    Parameters
    ----------
    every : int
        Teeth from one pin to the next.
    first : int
        Number of the tooth above the first pin, from 0.
    width : float
        Of the part of the back that each holds [m].
    """

    every: int
    first: int
    width: float

    def holds(self, tooth: int) -> bool:
        """Whether there is a pin below a tooth."""
        return tooth >= self.first and (tooth - self.first) % self.every == 0


@dataclass(frozen=True)
class Rack:
    """A spur or helical rack in SI.

    Parameters
    ----------
    tooth : RackTooth
    module : float
        [m].
    teeth : int
        Number of teeth, 1 to 1000, numbered from 0 in the order in which they come into mesh.
    reference_height : float
        From the back to the reference line [m].
    face_width : float
        [m].
    material : Material
    plane : {"strain", "stress"}
    pins : RackPins, optional
        By default all of the back is held.
    hand : {"spur", "left", "right"}
        As of the gear that the rack is the limit of: a right-handed one meshes with a left-handed pinion.

    Raises
    ------
    GeometryError
        If a size breaks its rule.
    """

    tooth: RackTooth
    module: float
    teeth: int = given(meaning="Number of teeth of the rack.", at_least=1, at_most=MOST_TEETH)
    reference_height: float = given(
        "length",
        "Height of the reference line above the back of the rack (catalogues: height of pitch line, h_0).",
        above=0.0,
    )
    face_width: float = shown("mm", "face width")
    material: Material = field(default_factory=Material)
    plane: Plane = "strain"
    pins: RackPins | None = None
    hand: Hand = "spur"

    def __post_init__(self) -> None:
        """Refuse sizes that cannot be."""
        if not 1 <= self.teeth <= MOST_TEETH:
            raise GeometryError("teeth", self.teeth, f"must be between 1 and {MOST_TEETH}",
                                "model the part of a longer rack that the pinion meets")  # fmt: skip
        for name in ("module", "reference_height", "face_width"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise GeometryError(name, value, "must be positive and finite")
        if (self.hand == "spur") != (self.tooth.helix_angle == 0.0):
            raise GeometryError("hand", f'"{self.hand}"', "contradicts the helix angle of "
                                f"{math.degrees(self.tooth.helix_angle):.6g} deg")  # fmt: skip
        if not self.body > 0.0:
            raise GeometryError(
                "reference_height", f"{self.reference_height * 1e3:.6g} mm",
                f"must exceed the dedendum of {-self.tooth.root_height * self.module * 1e3:.6g} mm",
                "it is measured from the back to the reference line",
            )  # fmt: skip
        if self.plane == "strain" and self.material.poisson_ratio > _LARGEST_POISSON_RATIO:
            raise InputError("material.poisson_ratio", self.material.poisson_ratio,
                             "is too close to 0.5 (incompressible) for plane strain elements",
                             f"use at most {_LARGEST_POISSON_RATIO}, or plane stress")  # fmt: skip
        if self.pins is not None:
            self._check_pins(self.pins)

    def _check_pins(self, pins: RackPins) -> None:
        if not 1 <= pins.every <= MOST_TEETH:
            raise GeometryError("pin_every", pins.every, f"must be between 1 and {MOST_TEETH} teeth")
        if not 0 <= pins.first < self.teeth:
            raise GeometryError(
                "first_pin", pins.first + 1, f"must be between 1 and {self.teeth}, the teeth of the rack"
            )
        low, high = _NARROWEST * self.module, (self.tooth.pitch - _NARROWEST) * self.module
        if not low <= pins.width <= high:
            raise GeometryError("pin_width", f"{pins.width * 1e3:.6g} mm",
                                f"must be between {low * 1e3:.4g} and {high * 1e3:.4g} mm (one pitch)")  # fmt: skip

    @property
    def pitch(self) -> float:
        """p_t = pi m_n / cos(beta) [m]."""
        return self.tooth.pitch * self.module

    @property
    def base_pitch(self) -> float:
        """p_bt = p_t cos(alpha_t) [m]."""
        return self.pitch * math.cos(self.pressure_angle)

    @property
    def pressure_angle(self) -> float:
        """alpha_t [rad]."""
        return self.tooth.pressure_angle

    @property
    def helix_angle(self) -> float:
        """beta [rad]."""
        return self.tooth.helix_angle

    @property
    def slide(self) -> float:
        """Way of the section along the rack per length along the face: -tan(beta) of a right hand."""
        return {"spur": 0.0, "left": 1.0, "right": -1.0}[self.hand] * math.tan(self.helix_angle)

    @property
    def body(self) -> float:
        """From the back to the root [m]."""
        return self.reference_height + self.tooth.root_height * self.module

    @property
    def height(self) -> float:
        """From the back to the tip [m]."""
        return self.reference_height + self.tooth.tip_height * self.module

    @property
    def length(self) -> float:
        """Of all teeth [m]."""
        return self.teeth * self.pitch

    @property
    def plane_modulus(self) -> float:
        """E / (1 - nu^2) in plane strain, E in plane stress [Pa]."""
        return self.material.plane_modulus(self.plane)
