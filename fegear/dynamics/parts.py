"""The parts of a gear train: bodies that turn, shafts, gear pairs, dampers and torques."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from fegear.errors import InputError

#: How a gear pair's damping goes with the stiffness of the teeth that touch.
DampingLaw = Literal["constant", "momentary"]
#: Largest mismatch of base radii against tooth numbers.
RATIO_TOLERANCE = 1e-6


def require_positive(key: str, value: float, *, infinite: bool = False, zero: bool = False) -> None:
    """Refuse a value that is not positive; zero and infinity pass where they are allowed."""
    if math.isnan(value) or value < 0.0 or (value == 0.0 and not zero) or (math.isinf(value) and not infinite):
        raise InputError(key, value, "must be " + ("zero or positive" if zero else "positive and finite"))


@dataclass(frozen=True, slots=True)
class Body:
    """A rigid body that turns about a fixed axis.

    Parameters
    ----------
    name : str
        Name that shafts, gear pairs, dampers and torques refer to.
    inertia : float
        Mass moment of inertia about the axis [kg m^2].
    """

    name: str
    inertia: float

    def __post_init__(self) -> None:
        require_positive(f"body.{self.name}.inertia", self.inertia)


@dataclass(frozen=True, slots=True)
class Shaft:
    """A shaft that couples the rotation of two bodies on one axis.

    Parameters
    ----------
    name, a, b : str
        Its name and the two bodies.
    stiffness : float
        Torsional stiffness [N m/rad]; infinity joins the two bodies into one.
    damping : float
        Viscous damping [N m s/rad].
    """

    name: str
    a: str
    b: str
    stiffness: float
    damping: float = 0.0

    def __post_init__(self) -> None:
        key = f"shaft.{self.name}"
        if self.stiffness == 0.0:
            raise InputError(
                f"{key}.stiffness",
                0.0,
                "couples nothing",
                "leave the shaft out, or make it a damper between the bodies",
            )
        require_positive(f"{key}.stiffness", self.stiffness, infinite=True)
        require_positive(f"{key}.damping", self.damping, zero=True)


@dataclass(frozen=True, slots=True)
class Mesh:
    """A gear pair in mesh between two bodies.

    The teeth approach each other by ``radius_a theta_a + radius_b theta_b``; the signs of the radii say which senses
    of rotation close the loaded flanks (an external pair whose bodies share one sense of rotation has equal signs).

    Parameters
    ----------
    name, a, b : str
        Its name and the two bodies.
    radius_a, radius_b : float
        Signed base radii [m].
    teeth_a, teeth_b : int
        Numbers of teeth.
    stiffness : float
        Mean mesh stiffness along the line of action [N/m].
    damping : float
        Mesh damping C on the rate of approach [N s/m], at the mean stiffness.
    damping_law : {"constant", "momentary"}
        Whether motion in time keeps it while any teeth touch, or has it follow their stiffness, C sqrt(K(t)/K), as
        TM-100180 writes it ((2), (3), (16), (20), (24)). Transfer functions know the mean stiffness only.
    backlash : float
        Backlash along the line of action [m]; infinity means that the back flanks never touch.
    """

    name: str
    a: str
    b: str
    radius_a: float
    radius_b: float
    teeth_a: int
    teeth_b: int
    stiffness: float
    damping: float = 0.0
    backlash: float = math.inf
    damping_law: DampingLaw = "constant"

    def __post_init__(self) -> None:
        key = f"mesh.{self.name}"
        require_positive(f"{key}.radius_a", abs(self.radius_a))
        require_positive(f"{key}.radius_b", abs(self.radius_b))
        require_positive(f"{key}.stiffness", self.stiffness)
        require_positive(f"{key}.damping", self.damping, zero=True)
        require_positive(f"{key}.backlash", self.backlash, infinite=True, zero=True)
        if self.damping_law not in ("constant", "momentary"):
            raise InputError(f"{key}.damping_law", self.damping_law, 'must be "constant" or "momentary"')
        for side, teeth in (("a", self.teeth_a), ("b", self.teeth_b)):
            if teeth < 1:
                raise InputError(f"{key}.teeth_{side}", teeth, "must be a whole number of at least 1")
        ratio = abs(self.radius_a / self.radius_b) * self.teeth_b / self.teeth_a
        if abs(ratio - 1.0) > RATIO_TOLERANCE:
            raise InputError(
                key,
                f"base radii {abs(self.radius_a):.6g} m and {abs(self.radius_b):.6g} m",
                f"must be in the ratio of the tooth numbers {self.teeth_a} and {self.teeth_b}",
            )


@dataclass(frozen=True, slots=True)
class Damper:
    """A viscous damper between two bodies, or from one body to the ground (``b`` is None); damping in N m s/rad."""

    a: str
    b: str | None
    damping: float

    def __post_init__(self) -> None:
        require_positive(f"damper.{self.a}.{self.b or 'ground'}.damping", self.damping, zero=True)


@dataclass(frozen=True, slots=True)
class Torque:
    """A constant torque on a body [N m], positive in the sense of its rotation angle."""

    body: str
    value: float

    def __post_init__(self) -> None:
        if not math.isfinite(self.value):
            raise InputError(f"torque.{self.body}", self.value, "must be finite")
