"""Shafts with what holds and loads them: bearings in the housing, or in another shaft around them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.shafts.carried import carry

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index
    from fegear.shafts.beam import Shaft
    from fegear.shafts.bearing import Bearing

#: Torques about an axis that balance to so much of the largest are round-off.
_BALANCED = 1e-9
#: Smallest over largest stiffness of a shaft on its bearings below which it is loose.
_LOOSE = 1e-12


@dataclass(frozen=True)
class Around:
    """Where the outer ring of a bearing sits in another shaft: its number, and the place from its left end [m]."""

    shaft: int
    at: float


@dataclass(frozen=True)
class Seat:
    """A bearing on a shaft.

    Parameters
    ----------
    bearing : Bearing
    at : float
        From the shaft's left end [m].
    name : str
        For messages.
    around : Around, optional
        Shaft in which its outer ring sits; the housing without it.
    """

    bearing: Bearing
    at: float
    name: str = "bearing"
    around: Around | None = None


@dataclass(frozen=True)
class LoadedShaft:
    """A shaft, its bearings and the forces from outside.

    Parameters
    ----------
    shaft : Shaft
    seats : tuple of Seat
    loads_at : ndarray, shape (m,)
        From its left end [m].
    loads : ndarray, shape (m, 6)
        Forces and moments F_x, F_y, F_z, M_x, M_y, M_z at the axis [N, N m].
    name : str

    Raises
    ------
    InputError
        If a bearing or force is off the shaft.
    """

    shaft: Shaft
    seats: tuple[Seat, ...]
    loads_at: Array
    loads: Array
    name: str = "shaft"

    def __post_init__(self) -> None:
        """Refuse what is off the shaft."""
        for seat in self.seats:
            self.shaft.place(seat.at, f"{self.name}.{seat.name}.at")
        for at in self.loads_at:
            self.shaft.place(float(at), f"{self.name}.load.at")


@dataclass(frozen=True)
class Held:
    """Where bearings hold a shaft, on it or in it; arrays of shape (k,).

    Parameters
    ----------
    bearings : ndarray
        Their numbers, over all shafts and seats.
    at : ndarray
        From the shaft's left end [m].
    sign : ndarray
        1 where the shaft carries the inner ring, -1 where it carries the outer one.
    """

    bearings: Index
    at: Array
    sign: Array

    @property
    def rows(self) -> Index:
        """Of the five motions of each in those of all bearings, shape (5 k,)."""
        return np.asarray((5 * self.bearings[:, None] + np.arange(5)).ravel())


def held_by(shafts: tuple[LoadedShaft, ...]) -> tuple[Held, ...]:
    """Where bearings hold each shaft; those on it first."""
    found: list[list[tuple[int, float, float]]] = [[] for _ in shafts]
    inside: list[tuple[int, tuple[int, float, float]]] = []
    number = 0
    for own, one in zip(found, shafts, strict=True):
        for seat in one.seats:
            own.append((number, seat.at, 1.0))
            if seat.around is not None:
                inside.append((seat.around.shaft, (number, seat.around.at, -1.0)))
            number += 1
    for shaft, held in inside:
        found[shaft].append(held)
    columns = [np.array(own, dtype=float).reshape(-1, 3).T for own in found]
    return tuple(Held(which.astype(int), at, sign) for which, at, sign in columns)


def groups_of(shafts: tuple[LoadedShaft, ...]) -> tuple[tuple[int, ...], ...]:
    """Numbers of shafts that bearings join, ascending; those of the housing join none."""
    leader = list(range(len(shafts)))
    for n, one in enumerate(shafts):
        for seat in one.seats:
            if seat.around is not None and (first := leader[n]) != (second := leader[seat.around.shaft]):
                leader = [first if top == second else top for top in leader]
    return tuple(tuple(n for n, one in enumerate(leader) if one == top) for top in dict.fromkeys(leader))


def refuse_loose(shafts: tuple[LoadedShaft, ...]) -> None:
    """Refuse shafts that are not held.

    Raises
    ------
    InputError
        If one has no bearings, or is loose.
    """
    held, bearings = held_by(shafts), [seat.bearing for one in shafts for seat in one.seats]
    for one, places in zip(shafts, held, strict=True):
        if not places.at.size:
            raise InputError(f"{one.name}.bearings", "(none)", "do not support the shaft", "specify two bearings")
    for group in groups_of(shafts):
        scale = np.concatenate([[1.0, 1.0, 1.0, *[1.0 / shafts[n].shaft.length] * 2] for n in group])
        stiff = np.zeros((scale.size, scale.size))
        for number in sorted({int(b) for n in group for b in held[n].bearings}):
            moved = np.hstack([
                sum((sign * carry(at)[:5, :5].T for b, at, sign in zip(one.bearings, one.at, one.sign, strict=True)
                     if b == number), np.zeros((5, 5)))
                for one in (held[n] for n in group)
            ])  # fmt: skip
            soft = np.abs(np.diag(bearings[number].usual))
            firm = np.diag(
                np.where(bearings[number].rigid, max(1e9, float(soft[:3].max())) / scale[:5] ** 2 * 1e3, 0.0)
            )
            stiff += moved.T @ (bearings[number].usual + firm) @ moved
        values, motions = np.linalg.eigh(stiff * np.outer(scale, scale))
        if not values[0] > _LOOSE * values[-1]:
            which, way = divmod(int(np.argmax(np.abs(motions[:, 0]))), 5)
            ways = ("radially (x)", "radially (y)", "axially", "in tilt about x", "in tilt about y")
            raise InputError(
                f"{shafts[group[which]].name}.bearings", f"{held[group[which]].at.size} in number",
                f"do not support the shaft {ways[way]}", "specify a bearing that supports it",
            )  # fmt: skip


def refuse_torque(shafts: tuple[LoadedShaft, ...]) -> None:
    """Refuse torques about an axis that nothing takes.

    Raises
    ------
    InputError
    """
    for one in shafts:
        torque = one.loads[:, 5]
        if abs(torque.sum()) > _BALANCED * max(float(np.abs(torque).max(initial=0.0)), 1e-12):
            raise InputError(
                one.name, f"{torque.sum():.6g} N m", "is an unbalanced torque about the shaft axis",
                "specify a coupling",
            )  # fmt: skip
