"""The springs of all meshes of a set over its mesh cycle, each mesh at its phase."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.base.errors import InputError, RangeError
from fegear.dynamics.planetary.mesh_law import SlotSprings
from fegear.dynamics.planetary.phases import common_parts
from fegear.fem.alike_teeth import together

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.dynamics.planetary.mesh_law import MeshSprings, MeshTeeth
    from fegear.dynamics.planetary.phases import Phases
    from fegear.dynamics.planetary.planet_set import Central
    from fegear.dynamics.planetary.set_model import SetModel
    from fegear.dynamics.train.excitation import MeshExcitation

#: Lobatto's rules, with the ends of every piece, and the rule on every other point that tells their error: five points
#: and three, and of cycles with many pieces three points and two.
_FIVE = (
    np.array([-1.0, -math.sqrt(3.0 / 7.0), 0.0, math.sqrt(3.0 / 7.0), 1.0]),
    np.array([0.1, 49.0 / 90.0, 32.0 / 45.0, 49.0 / 90.0, 0.1]),
    np.array([1.0, 0.0, 4.0, 0.0, 1.0]) / 3.0,
)
_THREE = np.array([-1.0, 0.0, 1.0]), np.array([1.0, 4.0, 1.0]) / 3.0, np.array([1.0, 0.0, 1.0])
_MANY = 200
#: Positions between two break points at least, where there are few of them.
_FINEST = 1.0 / 48.0
#: The same where teeth differ: there are many base pitches, and little changes within one but at break points.
_FINE = 1.0 / 24.0
#: Base pitches until the same teeth meet again at most.
MOST_PITCHES = 2000
#: Breaks closer than this are one, and ends of pieces stand so far inside them [base pitches].
_ONE, _INSIDE = 1e-9, 3e-10


@dataclass(frozen=True)
class SetCycle:
    """A set, the torque that it carries, and the springs of its meshes at M places of the mesh cycle.

    The meshes stand in the order sun 1, 2, ..., ring 1, 2, ... (2N of them).

    Parameters
    ----------
    model : SetModel
    sun_torque : float
        Size of the torque on the sun [N m].
    driving : {"sun", "ring", "carrier"}
        Whose rotation the transmission error is; the other two do not turn.
    s : ndarray, shape (M,)
        Places [base pitches of the first planet's mesh with the sun], piece by piece between break points.
    weights, coarse : ndarray, shape (M,)
        Shares of the cycle that the places stand for, and those of every other place.
    points : int
        Places of one piece.
    stiffness, separation, bent : ndarray, shape (M, 2N, L)
        See `MeshSprings`.
    level : ndarray, shape (2N, L)
        See `MeshSprings`.
    off : ndarray, shape (K, M, 2N)
        How far the approach of each mesh under the mean force is off by each of K errors [m].
    cycles : int
        Base pitches of the cycle: 1, or more where teeth differ.
    """

    model: SetModel
    sun_torque: float
    driving: Central
    s: Array
    weights: Array
    coarse: Array
    points: int
    stiffness: Array
    separation: Array
    bent: Array
    level: Array
    off: Array
    cycles: int = 1

    @property
    def mean_force(self) -> float:
        """Force in every mesh with the sun where all planets carry alike [N]; of equal flanks with the ring, too."""
        return mean_force(self.model, self.sun_torque)


def mean_force(model: SetModel, sun_torque: float, mesh: Literal["sun", "ring"] = "sun") -> float:
    """Force in every mesh with sun or ring where all planets carry alike [N]."""
    force = sun_torque / (model.found.base_radius("sun") * model.count)
    return force / model.found.ring_lever if mesh == "ring" else force


def set_cycle(
    model: SetModel,
    teeth: tuple[MeshTeeth | Sequence[MeshTeeth], MeshTeeth | Sequence[MeshTeeth]],
    phases: Phases,
    sun_torque: float,
    driving: Central,
    delays: Array | None = None,
) -> SetCycle:
    """Springs of a set over its mesh cycle, or until the same teeth meet again.

    Parameters
    ----------
    model : SetModel
    teeth : pair of MeshTeeth
        Of the meshes with sun and ring: those of every planet, or one by one.
    phases : Phases
    sun_torque : float
        Size of the torque on the sun [N m].
    driving : {"sun", "ring", "carrier"}
    delays : ndarray, shape (2, planets), optional
        Whole ones (`whole_delays`), where teeth differ.

    Raises
    ------
    RangeError
        If the torque carries nothing.
    InputError
        If teeth differ that are not said where they stand, or meet again after too many base pitches.
    """
    if not (math.isfinite(sun_torque) and sun_torque > 0.0):
        raise RangeError("torque", sun_torque, "must be positive and finite")
    count = model.count
    each = [list(one) if isinstance(one, Sequence) else [one] * count for one in teeth]
    cycles = math.lcm(*(one.cycles for mesh in each for one in mesh))
    if cycles > 1 and delays is None:
        raise InputError("spacing_errors", "(given)", "are not supported in a planetary set", "use identical teeth")
    if cycles > MOST_PITCHES:
        raise InputError(
            "planetary", f"{cycles} base pitches until the same teeth mesh again", f"must be at most {MOST_PITCHES}",
            "specify different teeth on one gear only",
        )  # fmt: skip
    late = phases.delays if delays is None else delays
    parts = common_parts(model.found) if cycles == 1 else 1
    s, weights, coarse = _places(parts, each, phases.delays, cycles)
    points, s, weights, coarse = s.shape[1], s.ravel(), weights.ravel(), coarse.ravel()
    found: list[MeshSprings] = []
    for mesh, lags in zip(each, late, strict=True):
        # planets follow each other by whole parts of the grid: most places are those of another planet as well
        springs_of: dict[int, MeshSprings] = {}
        for same in together(map(id, mesh)):
            one = mesh[same[0]]
            places = np.round(s - lags[same, None], 12) % one.cycles
            known, back = np.unique(places, return_inverse=True)
            springs = one.at(known)
            for n, own in zip(same, back.reshape(places.shape), strict=True):
                springs_of[int(n)] = springs._replace(
                    **{key: getattr(springs, key)[own] for key in ("stiffness", "separation", "bent")},
                    off=springs.off[:, own],
                )
        found += [springs_of[n] for n in range(count)]
    most = max(one.stiffness.shape[1] for one in found)
    stiffness, separation, bent = (
        np.stack([np.pad(getattr(one, key), ((0, 0), (0, most - getattr(one, key).shape[1]))) for one in found], axis=1)
        for key in ("stiffness", "separation", "bent")
    )
    level = np.stack([np.pad(one.level, (0, most - one.level.size), constant_values=np.inf) for one in found])
    errors = [max(one.off.shape[0] for one in found[first : first + count]) for first in (0, count)]
    off = np.zeros((sum(errors), s.size, 2 * count))
    for n, springs in enumerate(found):
        first = 0 if n < count else errors[0]
        off[first : first + springs.off.shape[0], :, n] = springs.off
    return SetCycle(
        model, sun_torque, driving, s, weights, coarse, points, stiffness, separation, bent, level, off, cycles
    )


def _places(parts: int, teeth: Sequence[Sequence[MeshTeeth]], delays: Array, cycles: int) -> tuple[Array, Array, Array]:
    """Places of a mesh cycle, their weights and coarser ones [base pitches], shape (pieces, points).

    Break points of the teeth are ends of pieces, and the whole grid repeats after the common part of all delays:
    what the phases cancel then cancels in the sums as well, to round-off. Where teeth differ it is the same grid in
    every base pitch.
    """
    cuts = [np.arange(0.0, 1.0, _FINEST if cycles == 1 else _FINE)]
    for mesh, late in zip(teeth, delays, strict=True):
        cuts += [(mesh[same[0]].breaks[:, None] + late[same]).ravel() for same in together(map(id, mesh))]
    first = np.sort(np.concatenate(cuts) % (1.0 / parts))
    first = first[np.append(True, np.diff(first) > _ONE)]
    starts = (first[None, :] + np.arange(parts)[:, None] / parts).ravel()
    lengths = np.diff(np.append(starts, starts[0] + 1.0))
    if cycles > 1:
        starts = (starts + np.arange(cycles)[:, None]).ravel()
        lengths = np.tile(lengths, cycles)
    points, weights, coarse = _FIVE if starts.size <= _MANY else _THREE
    # a jump is seen from both of its sides
    half = 0.5 * lengths[:, None]
    inside = half - np.minimum(_INSIDE, 0.1 * half)
    s = starts[:, None] + half + inside * points
    return s, half * weights / cycles, half * coarse / cycles


@dataclass(frozen=True)
class MeshedSet:
    """A set with the teeth of its meshes as springs over the base pitch, and the torque that it carries.

    Parameters
    ----------
    model : SetModel
    sun, ring : MeshExcitation
        Teeth of the first planet's meshes.
    phases : Phases
    sun_torque : float
        Size of the torque on the sun [N m].
    driving : {"sun", "ring", "carrier"}
        Whose rotation the transmission error is; the other two do not turn.
    """

    model: SetModel
    sun: MeshExcitation
    ring: MeshExcitation
    phases: Phases
    sun_torque: float
    driving: Central

    def __post_init__(self) -> None:
        """Refuse teeth that differ from one another, and torques that carry nothing."""
        if not (math.isfinite(self.sun_torque) and self.sun_torque > 0.0):
            raise RangeError("torque", self.sun_torque, "must be positive and finite")
        for name, one in (("sun", self.sun), ("ring", self.ring)):
            if any(part.pitches != 1 for part in (*one.stiffness, *one.separation)):
                raise InputError(
                    name, "spacing errors", "are not supported in a planetary set (identical teeth required)"
                )

    @property
    def teeth(self) -> tuple[MeshExcitation, MeshExcitation]:
        """Of the sun's and of the ring's mesh."""
        return self.sun, self.ring

    @property
    def mean_force(self) -> float:
        """Force in every mesh with the sun where all planets carry alike [N]; of equal flanks with the ring, too."""
        return mean_force(self.model, self.sun_torque)

    @property
    def mean_forces(self) -> tuple[float, float]:
        """The same in the meshes with sun and ring [N]."""
        return self.mean_force, mean_force(self.model, self.sun_torque, "ring")

    @cached_property
    def delays(self) -> Array:
        """Of every mesh behind the first planet's with the sun [base pitches], shape (2, planets)."""
        return self.phases.delays

    @property
    def cycle(self) -> SetCycle:
        """The same at places of the mesh cycle."""
        teeth = SlotSprings(self.sun), SlotSprings(self.ring)
        return set_cycle(self.model, teeth, self.phases, self.sun_torque, self.driving)
