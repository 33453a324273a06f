"""Whether planets of a set described as data go in at their angles, the room between them, and mesh phases.

Seen from its carrier, planet n is the first one turned round the axis by psi_n, and about itself by delta_n besides. A
mesh with a shaft that has z_c teeth (negative: internal) fits where z_p delta_n - z_c psi_n is a whole number of turns,
one of two planets where z_p delta_p + z_q delta_q is. Whole multiples of these conditions in which all delta cancel are
what angles and tooth numbers have to meet.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from fractions import Fraction
from itertools import combinations
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import GeometryError
from fegear.dynamics.compound.compound_set import Shaft
from fegear.dynamics.compound.whole_numbers import echelon

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.dynamics.compound.compound_set import CompoundSet, Planets, Toothed

#: How far planets may be from angles at which all meshes fit [pitches]: a part of what no drawing writes.
FITS = 1e-6


@dataclass(frozen=True)
class Cluster:
    """Planets that mesh with each other, on one carrier, and all of their meshes.

    Parameters
    ----------
    planets : tuple of Planets
    meshes : tuple of Toothed
    """

    planets: tuple[Planets, ...]
    meshes: tuple[Toothed, ...]

    @property
    def turns(self) -> tuple[float, ...]:
        """Angle of each planet from the first one of its group [rad]."""
        first = self.planets[0].angles
        return tuple(one - first[0] for one in first)

    def _rows(self) -> list[list[int]]:
        """Whole numbers that turn the delta of all planets into turns of each mesh."""
        at = {one.name: k for k, one in enumerate(self.planets)}
        rows = []
        for toothed in self.meshes:
            row = [0] * len(at)
            row[at[toothed.planets.name]] += toothed.wheel.teeth
            if not isinstance(toothed.other, Shaft):
                row[at[toothed.other.name]] += toothed.other_wheel.teeth
            rows.append(row)
        return rows

    def _needed(self) -> list[int]:
        """Turns of each mesh per turn psi: signed teeth of the shaft's gear, none between planets."""
        return [one.other_wheel.signed if isinstance(one.other, Shaft) else 0 for one in self.meshes]

    def conditions(self) -> list[int]:
        """Whole numbers c: all meshes fit where every c psi / 2 pi is whole."""
        made, _, rank = echelon(self._rows())
        needed = self._needed()
        return [sum(a * b for a, b in zip(row, needed, strict=True)) for row in made[rank:]]

    @property
    def step(self) -> int:
        """Planets go in at whole multiples of 2 pi over this; zero where they go in anywhere."""
        return math.gcd(*self.conditions())

    def misfit(self) -> list[float]:
        """How far each planet is from the nearest angle that fits [rad]."""
        step = self.step
        if not step:
            return [0.0] * len(self.turns)
        places = [psi * step / (2.0 * math.pi) for psi in self.turns]
        return [(one - round(one)) / step * 2.0 * math.pi for one in places]

    def turned(self, psi: float) -> dict[str, float]:
        """By how much each planet at psi is turned about itself in the frame of the first one [turns].

        Where planets may be put in in several ways, in one of them.
        """
        made, form, rank = echelon(self._rows())
        needed = [one * psi / (2.0 * math.pi) for one in self._needed()]
        right = [sum(a * b for a, b in zip(row, needed, strict=True)) for row in made[:rank]]
        found = [0.0] * len(self.planets)
        for k in reversed(range(rank)):
            column = next(c for c, one in enumerate(form[k]) if one)
            rest = sum(form[k][c] * found[c] for c in range(column + 1, len(found)))
            found[column] = (right[k] - rest) / form[k][column]
        return {one.name: turn for one, turn in zip(self.planets, found, strict=True)}


def clusters(of: CompoundSet) -> tuple[Cluster, ...]:
    """Planets of a set by what meshes with what."""
    groups: list[set[str]] = [{one.name} for one in of.planets]
    for toothed in of.toothed:
        joined = {toothed.planets.name, toothed.other.name}
        together = [one for one in groups if one & joined]
        groups = [one for one in groups if not one & joined] + [set().union(*together)]
    order = sorted(groups, key=lambda names: min(of.names.index(one) for one in names))
    return tuple(
        Cluster(
            tuple(one for one in of.planets if one.name in names),
            tuple(one for one in of.toothed if one.planets.name in names),
        )
        for names in order
    )


def check_assembly(of: CompoundSet) -> None:
    """Refuse planets that do not fit between the gears with which they mesh.

    Raises
    ------
    GeometryError
        With the margin, and angles or numbers of planets that would do.
    """
    for cluster in clusters(of):
        misfit = cluster.misfit()
        step, first = cluster.step, cluster.planets[0]
        worst = max(range(len(misfit)), key=lambda n: abs(misfit[n]))
        if not step or abs(misfit[worst]) * step <= FITS * 2.0 * math.pi:
            continue
        off, angle = math.degrees(misfit[worst]), math.degrees(first.angles[worst])
        fit = [n for n in range(1, step + 1) if step % n == 0]
        near = [max((n for n in fit if n < first.count), default=0), min((n for n in fit if n > first.count),
                                                                        default=0)]  # fmt: skip
        counts = " or ".join(str(n) for n in near if n)
        even = np.ptp(np.diff([*cluster.turns, 2.0 * math.pi])) < 1e-9
        raise GeometryError(
            f"planet.{first.name}.{'planets' if even else f'angles[{worst}]'}",
            first.count if even else f"{angle:.8g} deg",
            f"violates the assembly condition: planet {worst + 1} is {abs(off):.4g} deg off an integer multiple of "
            f"360/{step} deg",
            (f"use {counts} planets, set angles = [...] in these multiples, or change a number of teeth" if even else
             f"use {angle - off:.8g} deg"),
        )  # fmt: skip


@dataclass(frozen=True)
class Clearance:
    """Room between two planets on one carrier.

    Parameters
    ----------
    first, second : str
        Groups.
    gap : float
        Between tip circles [m]; negative: they overlap.
    certain : bool
        Whether both are in one plane: of one group, or a mesh apart.
    """

    first: str
    second: str
    gap: float
    certain: bool


def clearances(of: CompoundSet) -> tuple[Clearance, ...]:
    """Smallest distances between tip circles of planets that do not mesh, group by group, of gears in one plane.

    Gears that mesh, directly or by others between, count as one plane: a long planet may pass several.
    """
    planes = _planes(of)
    meshing = {frozenset((one.planets.name, one.other.name)) for one in of.toothed}
    found = []
    pairs = [*((one, one) for one in of.planets), *combinations(of.planets, 2)]
    for a, b in pairs:
        if a.carrier != b.carrier:
            continue
        gaps = [
            _gap(a, b, n, k) - one.tip_radius - other.tip_radius
            for one in a.wheels for other in b.wheels
            if planes[a.name, one.name] == planes[b.name, other.name]
            for n in range(a.count) for k in range(b.count)
            if not (a is b and n <= k) and not (frozenset((a.name, b.name)) in meshing and n == k)
        ]  # fmt: skip
        if gaps:
            found.append(Clearance(a.name, b.name, float(min(gaps)), a is b or frozenset((a.name, b.name)) in meshing))
    return tuple(found)


def check_neighbours(of: CompoundSet) -> None:
    """Refuse planets of one group, and planets beside those that they mesh with, whose tip circles overlap.

    Raises
    ------
    GeometryError
        With the overlap.
    """
    for one in clearances(of):
        if one.certain and one.gap <= 0.0:
            both = f"planets of {one.first}" if one.first == one.second else f"planets of {one.first} and {one.second}"
            raise GeometryError(
                f"planet.{one.first}", both, f"interfere: tip circles overlap by {-one.gap * 1e3:.4g} mm",
                "reduce the number of planets or their teeth, or increase the centre distance",
            )  # fmt: skip


def _gap(a: Planets, b: Planets, n: int, k: int) -> float:
    between = a.angles[n] - b.angles[k]
    return math.sqrt(max(a.radius**2 + b.radius**2 - 2.0 * a.radius * b.radius * math.cos(between), 0.0))


def _planes(of: CompoundSet) -> dict[tuple[str, str], int]:
    """Number of the plane of every gear, by member and gear."""
    plane = {(member.name, wheel.name): k for k, (member, wheel) in enumerate(
        (member, wheel) for member in of.members.values() for wheel in member.wheels
    )}  # fmt: skip
    for one in of.toothed:
        low, high = sorted((plane[one.planets.name, one.wheel.name], plane[one.other.name, one.other_wheel.name]))
        plane = {key: low if own == high else own for key, own in plane.items()}
    return plane


def even_turns(count: int, first: float = 0.0) -> tuple[float, ...]:
    """Angles of equally spaced planets [rad]."""
    return tuple(first + 2.0 * math.pi * float(Fraction(n, count)) for n in range(count))


def mesh_turns(cluster: Cluster, number: int) -> Sequence[float]:
    """Turns of a mesh, in teeth, by which each planet's is ahead of the first one's where the planet turns forward."""
    toothed = cluster.meshes[number]
    return [cluster.turned(psi)[toothed.planets.name] * toothed.wheel.teeth for psi in cluster.turns]
