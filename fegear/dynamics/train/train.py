"""A gear train as a graph: bodies that turn, shafts, gear pairs, dampers and torques.

The parts of a gear train: bodies that turn, shafts, gear pairs, dampers and torques.

Inertias, shaft stiffnesses and damping constants from dimensions and damping ratios (NASA TM-100180, 12 to 16).
"""

from __future__ import annotations

import math
from collections import Counter
from collections.abc import Iterable, Sequence
from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from typing import Literal

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError

#: Largest unbalanced torque, as a share of the torques applied.
TORQUE_TOLERANCE = 1e-6


@dataclass(frozen=True)
class Train:
    """A gear train; branches and closed power loops are allowed.

    Parameters
    ----------
    bodies, shafts, meshes, dampers, torques : tuple
        The parts. Bodies that a shaft of infinite stiffness couples move as one degree of freedom.

    Raises
    ------
    InputError
        If names repeat or are unknown, a body hangs on nothing, a closed loop locks (its speed ratios do not
        multiply to one), or the torques are not in equilibrium.
    """

    bodies: tuple[Body, ...]
    shafts: tuple[Shaft, ...] = ()
    meshes: tuple[Mesh, ...] = ()
    dampers: tuple[Damper, ...] = ()
    torques: tuple[Torque, ...] = ()

    def __post_init__(self) -> None:
        if not self.bodies:
            raise InputError("train.bodies", 0, "must contain at least one body")
        for kind, parts in (("body", self.bodies), ("shaft", self.shafts), ("mesh", self.meshes)):
            for name, count in Counter(part.name for part in parts).items():
                if count > 1:
                    raise InputError(f"train.{kind}", name, "is used twice", "use unique names")
        self._check_references()
        if not self.meshes and not self.shafts and len(self.bodies) > 1:
            raise InputError("train", len(self.bodies), "bodies need shafts or gear pairs that connect them")
        self._check_torques()

    def _check_references(self) -> None:
        known = {body.name for body in self.bodies}
        ends: list[tuple[str, str]] = []
        parts: tuple[Shaft | Mesh, ...] = (*self.shafts, *self.meshes)
        for part in parts:
            ends += [(part.name, part.a), (part.name, part.b)]
            if part.a == part.b:
                raise InputError(part.name, part.a, "connects a body with itself")
        for damper in self.dampers:
            ends += [("damper", damper.a)] + ([("damper", damper.b)] if damper.b is not None else [])
        ends += [("torque", torque.body) for torque in self.torques]
        for part_name, body in ends:
            if body not in known:
                raise InputError(part_name, body, "is not a body of this train", f"known: {', '.join(sorted(known))}")

    def _check_torques(self) -> None:
        total = np.abs(self.ratios * self.torque).sum()
        unbalanced = abs(float(self.ratios @ self.torque))
        if unbalanced > TORQUE_TOLERANCE * total:
            raise InputError(
                "train.torques",
                f"{unbalanced:.6g} N m",
                f"is not balanced, referred to the speed of {self.bodies[0].name}",
                "the load torque must equal the drive torque times the speed ratio",
            )

    @cached_property
    def dof(self) -> dict[str, int]:
        """Degree of freedom of each body; bodies joined by rigid shafts share one."""
        return joined_bodies(self.bodies, self.shafts)

    @cached_property
    def size(self) -> int:
        """Number of degrees of freedom."""
        return max(self.dof.values()) + 1

    @cached_property
    def inertia(self) -> Array:
        """Inertia of each degree of freedom [kg m^2]."""
        total = np.zeros(self.size)
        for body in self.bodies:
            total[self.dof[body.name]] += body.inertia
        return total

    @cached_property
    def torque(self) -> Array:
        """Constant torque on each degree of freedom [N m]."""
        total = np.zeros(self.size)
        for torque in self.torques:
            total[self.dof[torque.body]] += torque.value
        return total

    @cached_property
    def elastic_shafts(self) -> tuple[Shaft, ...]:
        """Shafts of finite stiffness."""
        return tuple(shaft for shaft in self.shafts if math.isfinite(shaft.stiffness))

    @cached_property
    def exact_ratios(self) -> tuple[Fraction, ...]:
        """Speed of each degree of freedom over that of the first body, from the tooth numbers."""
        links = [(s.name, self.dof[s.a], self.dof[s.b], Fraction(1)) for s in self.elastic_shafts]
        for mesh in self.meshes:
            sign = -1 if mesh.radius_a * mesh.radius_b > 0.0 else 1
            links.append((mesh.name, self.dof[mesh.a], self.dof[mesh.b], Fraction(sign * mesh.teeth_a, mesh.teeth_b)))
        at: list[list[tuple[str, int, Fraction]]] = [[] for _ in range(self.size)]
        for name, a, b, ratio in links:
            at[a].append((name, b, ratio))
            at[b].append((name, a, 1 / ratio))
        ratios: dict[int, Fraction] = {0: Fraction(1)}
        reached = [0]
        for a in reached:
            for name, b, ratio in at[a]:
                if b not in ratios:
                    ratios[b] = ratios[a] * ratio
                    reached.append(b)
                elif ratios[b] != ratios[a] * ratio:
                    raise InputError(
                        name, f"{float(ratios[a] * ratio / ratios[b]):.6g}",
                        "is the speed ratio around a closed loop, which locks",
                        "the ratios around the loop must multiply to 1 (mind the signs of the base radii)",
                    )  # fmt: skip
        if len(ratios) < self.size:
            lost = [body.name for body in self.bodies if self.dof[body.name] not in ratios]
            raise InputError(
                "train",
                ", ".join(lost),
                f"is not connected with {self.bodies[0].name} by shafts or gear pairs",
                "model it as a separate train, or add the shaft",
            )
        return tuple(ratios[index] for index in range(self.size))

    @cached_property
    def ratios(self) -> Array:
        """Speed of each degree of freedom over that of the first body (the rigid-body motion)."""
        values = np.array([float(ratio) for ratio in self.exact_ratios])
        return _readonly(values)

    @cached_property
    def mesh_orders(self) -> tuple[Fraction, ...]:
        """Mesh frequency of each gear pair over the rotation frequency of the first body."""
        return tuple(abs(self.exact_ratios[self.dof[mesh.a]]) * mesh.teeth_a for mesh in self.meshes)

    @cached_property
    def mesh_turns(self) -> Fraction:
        """Turns of the first body after which all gear pairs stand as before, teeth alike."""
        return common_multiple(1 / order for order in self.mesh_orders)

    @cached_property
    def approach(self) -> Array:
        """Rows that turn rotation angles into the approach of each gear pair [m], shape (meshes, size)."""
        rows = np.zeros((len(self.meshes), self.size))
        for index, mesh in enumerate(self.meshes):
            rows[index, self.dof[mesh.a]] += mesh.radius_a
            rows[index, self.dof[mesh.b]] += mesh.radius_b
        return _readonly(rows)

    def mesh_frequencies(self, speed: float | Array) -> Array:
        """Mesh frequency [Hz] of each gear pair, shape (meshes, ...), at the speed [rad/s] of the first body."""
        orders = np.array([float(order) for order in self.mesh_orders])
        return np.multiply.outer(orders, np.abs(np.asarray(speed, dtype=float)) / (2.0 * math.pi))

    def mesh_index(self, name: str) -> int:
        """Position of the gear pair of this name."""
        for index, mesh in enumerate(self.meshes):
            if mesh.name == name:
                return index
        raise InputError("mesh", name, "is not a gear pair of this train")


def common_multiple(parts: Iterable[Fraction]) -> Fraction:
    """Smallest multiple of every one of some positive ratios."""
    known = tuple(parts)
    return Fraction(math.lcm(*(p.numerator for p in known)), math.gcd(*(p.denominator for p in known)))


def joined_bodies(bodies: Sequence[Body], shafts: Iterable[Shaft]) -> dict[str, int]:
    """Number of the degree of freedom of each body, by name; rigid shafts give their bodies the same one."""
    root = {body.name: body.name for body in bodies}

    def find(name: str) -> str:
        while root[name] != name:
            root[name] = root[root[name]]
            name = root[name]
        return name

    for shaft in shafts:
        if math.isinf(shaft.stiffness):
            root[find(shaft.b)] = find(shaft.a)
    order: dict[str, int] = {}
    return {body.name: order.setdefault(find(body.name), len(order)) for body in bodies}


def joined_inertias(bodies: Sequence[Body], shafts: Iterable[Shaft]) -> dict[str, float]:
    """Inertia that turns with each body [kg m^2], by name: its own and those that rigid shafts join to it.

    Damping ratios of shafts and gear pairs (TM-100180, 14 to 16) refer to these.
    """
    number = joined_bodies(bodies, shafts)
    total = dict.fromkeys(number.values(), 0.0)
    for body in bodies:
        total[number[body.name]] += body.inertia
    return {name: total[index] for name, index in number.items()}


def _readonly(array: Array) -> Array:
    array.flags.writeable = False
    return array


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
                "has neither stiffness nor damping",
                "remove the shaft, or replace it by a damper between the bodies",
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


def disc_inertia(radius: float, width: float, density: float, bore_radius: float = 0.0) -> float:
    """Inertia of a solid or bored disc [kg m^2]: pi rho b (R^4 - r^4) / 2."""
    require_positive("radius", radius)
    require_positive("width", width)
    require_positive("density", density)
    require_positive("bore_radius", bore_radius, zero=True)
    if bore_radius >= radius:
        raise InputError("bore_radius", bore_radius, f"must be smaller than the radius {radius:g} m")
    return math.pi * density * width * (radius**4 - bore_radius**4) / 2.0


def shaft_stiffness(length: float, diameter: float, shear_modulus: float, bore_diameter: float = 0.0) -> float:
    """Torsional stiffness of a round shaft [N m/rad]: J G / l with J = pi D^4/32 (TM-100180, 12 and 13)."""
    require_positive("length", length)
    require_positive("diameter", diameter)
    require_positive("shear_modulus", shear_modulus)
    require_positive("bore_diameter", bore_diameter, zero=True)
    if bore_diameter >= diameter:
        raise InputError("bore_diameter", bore_diameter, f"must be smaller than the diameter {diameter:g} m")
    return math.pi * (diameter**4 - bore_diameter**4) / 32.0 * shear_modulus / length


def shaft_damping(ratio: float, stiffness: float, inertia_a: float, inertia_b: float) -> float:
    """Shaft damping from a damping ratio: 2 zeta sqrt(K / (1/J_a + 1/J_b)) (TM-100180, 14 and 15) [N m s/rad]."""
    return 2.0 * ratio * math.sqrt(stiffness / (1.0 / inertia_a + 1.0 / inertia_b))


def mesh_damping(
    ratio: float, stiffness: float, radius_a: float, radius_b: float, inertia_a: float, inertia_b: float
) -> float:
    """Mesh damping from a damping ratio (TM-100180, 16, repaired) [N s/m]."""
    mass = inertia_a * inertia_b / (radius_a**2 * inertia_b + radius_b**2 * inertia_a)
    return 2.0 * ratio * math.sqrt(stiffness * mass)
