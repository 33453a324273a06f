"""Speeds and torques of a planetary set described as data, exactly: Willis' relation for any shafts and meshes.

Every mesh is one linear relation between speeds (`CompoundSet.rolling`), and by the principle of virtual power the same
numbers turn tooth forces into torques. Losses take a share of the power that rolls through a mesh with the carrier at
rest, whichever way it rolls.
"""

from __future__ import annotations

from dataclasses import dataclass
from fractions import Fraction
from functools import cached_property
from itertools import combinations, product
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.dynamics.compound.whole_numbers import null_vectors, solved

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from fegear.dynamics.compound.compound_set import CompoundSet

#: Denominators to which efficiencies are taken.
_FINE = 10**9
#: Meshes of which every combination of directions of power is tried where the likely one contradicts itself.
_TRIED = 10


@dataclass(frozen=True)
class Drive:
    """A set with some shafts fixed, one driven and one loaded, per turn and per torque of the driving one.

    Parameters
    ----------
    fixed : tuple of str
    driving, loaded : str
        Other shafts run idle.
    speed : mapping of str to Fraction
        Of shafts and planets, that of the driving shaft 1.
    torque : mapping of str to Fraction
        On the shafts from outside, that on the driving one 1; they balance.
    tooth : tuple of Fraction
        Force of each mesh: the torque on each of its gears over the signed number of teeth, without losses.
    rolling : tuple of Fraction
        Power through the teeth of each mesh, seen from the carrier: positive from the planet to the other gear.
    loss : tuple of Fraction
        Of each mesh.
    """

    fixed: tuple[str, ...]
    driving: str
    loaded: str
    speed: Mapping[str, Fraction]
    torque: Mapping[str, Fraction]
    tooth: tuple[Fraction, ...]
    rolling: tuple[Fraction, ...]
    loss: tuple[Fraction, ...]

    @property
    def ratio(self) -> Fraction:
        """Speed of the input over that of the output."""
        return 1 / self.speed[self.loaded]

    @property
    def efficiency(self) -> Fraction:
        """Power out over power in."""
        return -self.torque[self.loaded] * self.speed[self.loaded]


@dataclass(frozen=True)
class Trains:
    """What a set can do: its degrees of freedom, and its speeds and torques for fixed, driving and loaded shafts.

    Raises
    ------
    InputError
        If meshes close a loop: torques would divide by stiffness, or tooth numbers lock the set.
    """

    of: CompoundSet

    def __post_init__(self) -> None:
        """Refuse loops."""
        rows = self.of.rolling()
        loops = null_vectors([list(one) for one in zip(*rows, strict=True)], len(rows))
        if loops:
            names = ", ".join(mesh.name for mesh, part in zip(self.of.meshes, loops[0], strict=True) if part)
            raise InputError("mesh", names, "close a loop: torques of its meshes depend on their stiffness",
                             "remove one of them, or give several equal planets by planets = N")  # fmt: skip
        if self.free < 1:
            raise InputError("mesh", len(rows), "lock the set: no shaft can rotate", "remove a mesh, or add a shaft")

    @cached_property
    def _motions(self) -> list[list[Fraction]]:
        return null_vectors(self.of.rolling(), len(self.of.names))

    @property
    def free(self) -> int:
        """Degrees of freedom: shafts to be fixed and driven."""
        return len(self._motions)

    def speeds(self, fixed: Sequence[str], driving: str) -> dict[str, Fraction] | str:
        """Speeds per turn of the driving shaft, or why there are none."""
        names = self.of.names
        rows = self.of.rolling()
        for shaft in fixed:
            rows.append([int(name == shaft) for name in names])
        found = null_vectors(rows, len(names))
        with_fixed = f" with {' and '.join(fixed)} fixed" if fixed else ""
        at = names.index(driving)
        moving = next((one for one in found if one[at]), None)
        if moving is None:
            return f"{driving} cannot rotate{with_fixed} (the set is locked)"
        if len(found) > 1:
            others = null_vectors([*rows, [int(name == driving) for name in names]], len(names))
            loose = [name for k, name in enumerate(names) if any(one[k] for one in others)]
            return f"speeds of {', '.join(loose)} are not determined{with_fixed}: fix another shaft"
        return {name: one / moving[at] for name, one in zip(names, moving, strict=True)}

    def drive(self, fixed: Sequence[str], driving: str, loaded: str) -> Drive | str:
        """Speeds, torques and losses, or one sentence on why there are none."""
        if driving == loaded or {driving, loaded} & set(fixed):
            return f"fixed, driving and loaded shafts must differ ({', '.join((*fixed, driving, loaded))})"
        speed = self.speeds(fixed, driving)
        if isinstance(speed, str):
            return speed
        if not speed[loaded]:
            return f"{loaded} does not rotate when {driving} drives" + (f" with {' and '.join(fixed)} fixed" if fixed
                                                                        else "")  # fmt: skip
        efficiency = [Fraction(one.efficiency).limit_denominator(_FINE) for one in self.of.meshes]
        plain = self._torques(fixed, driving, loaded, [Fraction(1)] * len(efficiency), [True] * len(efficiency))
        if plain is None:
            return f"torques are not determined by equilibrium with {loaded} as output"
        likely = [power >= 0 for power in self._powers(speed, plain[1])]
        several = product((True, False), repeat=len(likely)) if len(likely) <= _TRIED else ()
        for ways in (likely, *(several if any(one < 1 for one in efficiency) else ())):
            found = self._torques(fixed, driving, loaded, efficiency, list(ways))
            if found is None:
                continue
            torque, tooth = found
            rolling = self._powers(speed, tooth)
            # a tooth force is that of the planet; what arrives at the driven gear is smaller by the loss
            if any(power and (power > 0) != way for power, way in zip(rolling, ways, strict=True)):
                continue
            drive = Drive(tuple(fixed), driving, loaded, speed, torque, tuple(tooth), tuple(rolling),
                          tuple(_lost(power, one) for power, one in zip(rolling, efficiency, strict=True)))  # fmt: skip
            if drive.efficiency > 0:
                return drive
        return f"the set is self-locking with {driving} as input and {loaded} as output (friction of the meshes)"

    def _torques(
        self, fixed: Sequence[str], driving: str, loaded: str, efficiency: Sequence[Fraction], ways: Sequence[bool]
    ) -> tuple[dict[str, Fraction], list[Fraction]] | None:
        """Outer torques and tooth forces; `ways`: whether the planet of a mesh drives it."""
        names, meshes = self.of.names, self.of.toothed
        unknown = [*fixed, loaded]
        size = len(meshes) + len(unknown)
        rows = [[Fraction(0)] * size for _ in names]
        at = {name: k for k, name in enumerate(names)}
        for m, (one, share, way) in enumerate(zip(meshes, efficiency, ways, strict=True)):
            # the planet has the whole tooth force; its mate the share that losses leave, or what it has to bring
            planet, mate = Fraction(one.wheel.signed), one.other_wheel.signed * (share if way else 1 / share)
            rows[at[one.planets.name]][m] += planet
            rows[at[one.other.name]][m] += mate
            rows[at[one.planets.carrier]][m] -= planet + mate
        for k, shaft in enumerate(unknown):
            rows[at[shaft]][len(meshes) + k] = Fraction(1)
        right = [Fraction(-1) if name == driving else Fraction(0) for name in names]
        found = solved(rows, right)
        if found is None:
            return None
        outer = dict.fromkeys(self.of.shaft_names, Fraction(0)) | {driving: Fraction(1)}
        outer |= dict(zip(unknown, found[len(meshes) :], strict=True))
        return outer, found[: len(meshes)]

    def _powers(self, speed: Mapping[str, Fraction], tooth: Sequence[Fraction]) -> list[Fraction]:
        """Power from the planet into each mesh, seen from the carrier."""
        return [
            -force * one.wheel.signed * (speed[one.planets.name] - speed[one.planets.carrier])
            for one, force in zip(self.of.toothed, tooth, strict=True)
        ]

    def every(self, most: int) -> Iterator[tuple[tuple[str, ...], str, str, Drive | str]]:
        """Fixed, driving and loaded shafts in all combinations that leave one motion, up to `most` of them."""
        count = 0
        shafts = self.of.shaft_names
        for fixed in combinations(shafts, self.free - 1):
            for driving, loaded in product([one for one in shafts if one not in fixed], repeat=2):
                if driving == loaded:
                    continue
                if count == most:
                    return
                count += 1
                yield fixed, driving, loaded, self.drive(fixed, driving, loaded)


def _lost(power: Fraction, efficiency: Fraction) -> Fraction:
    """Loss of a mesh through which the planet puts this power, negative where it takes it."""
    return power * (1 - efficiency) if power >= 0 else -power * (1 / efficiency - 1)
