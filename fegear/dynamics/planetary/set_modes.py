"""Natural frequencies of a planetary set, and modes sorted by what moves: rotation, translation, planets alone.

Lin and Parker (1999): of evenly spaced, equal planets every mode is of one of three kinds, and the phases of the meshes
decide which kinds a harmonic can excite.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.linalg import cholesky, solve_triangular

from fegear.base.arrays import Array
from fegear.base.shown import shown
from fegear.dynamics.planetary.planet_set import CENTRALS
from fegear.dynamics.planetary.set_model import SetModel
from fegear.dynamics.train.modes import RIGID, same_way_up

#: Frequencies closer than this share of the highest are one, with several modes.
_ONE = 1e-8
#: Share of a mode's motion below which sun, ring and carrier do not take part in it.
_STILL = 1e-8


@dataclass(frozen=True)
class SetModes:
    """Undamped modes of a set with its mean mesh stiffnesses, by rising frequency.

    Parameters
    ----------
    shapes : ndarray, shape (size, modes)
        Coordinates as in `SetModel`, for unit modal mass.
    frequency : ndarray, shape (modes,)
        [Hz]; turning of the whole set is exactly zero.
    kind : tuple of str
        "rotation" (sun, ring and carrier turn only), "translation" (they move across the axis only), "planets" (they
        stay), or "mixed" where the set has no such symmetry.
    turning, moving : ndarray, shape (modes,)
        Share of the mode's kinetic energy in rotation, and in translation, of sun, ring and carrier.
    sun_mesh, ring_mesh : ndarray, shape (modes,)
        Share of its strain energy in the meshes.
    """

    shapes: Array
    frequency: Array = shown("Hz", "undamped natural frequency with mean mesh stiffnesses")
    kind: tuple[str, ...] = shown("", "mode type (motion of sun, ring and carrier)")
    turning: Array = shown("", "kinetic energy share, rotation of sun, ring and carrier")
    moving: Array = shown("", "kinetic energy share, translation of sun, ring and carrier")
    sun_mesh: Array = shown("", "strain energy share of the sun meshes")
    ring_mesh: Array = shown("", "strain energy share of the ring meshes")


def set_modes(model: SetModel, sun_mesh: float, ring_mesh: float) -> SetModes:
    """Modes of a set.

    Parameters
    ----------
    model : SetModel
        With masses of all bodies that move.
    sun_mesh, ring_mesh : float
        Mean mesh stiffness of each planet's meshes [N/m].
    """
    masses, central = model.masses, np.arange(3 * len(CENTRALS))
    turns = central % 3 == 2
    found = modes_by_kind(model.free, masses, model.stiffness(sun_mesh, ring_mesh), central[turns], central[~turns])
    shapes, squared = found.shapes, found.squared
    strain = [
        np.divide(
            k * ((rows @ shapes) ** 2).sum(axis=0), squared, out=np.zeros_like(squared), where=squared > 0.0
        )
        for k, rows in zip((sun_mesh, ring_mesh), model.mesh_rows, strict=True)
    ]  # fmt: skip
    return SetModes(shapes, found.frequency, found.kind, found.turning, found.moving, *strain)


@dataclass(frozen=True)
class ModesByKind:
    """Modes of bodies about one axis and of planets, by rising frequency.

    Parameters
    ----------
    shapes : ndarray, shape (size, modes)
        For unit modal mass.
    squared : ndarray, shape (modes,)
        Squares of the frequencies [rad^2/s^2].
    turning, moving : ndarray, shape (modes,)
        As those of `SetModes`.
    kind : tuple of str
        As that of `SetModes`.
    """

    shapes: Array
    squared: Array
    turning: Array
    moving: Array
    kind: tuple[str, ...]

    @property
    def frequency(self) -> Array:
        """[Hz]."""
        return np.asarray(np.sqrt(self.squared) / (2.0 * math.pi))


def modes_by_kind(free: Array, masses: Array, stiffness: Array, turns: Array, moves: Array) -> ModesByKind:
    """Modes and their kinds.

    Parameters
    ----------
    free : ndarray, shape (size, free)
        Coordinates as functions of those that are free.
    masses : ndarray, shape (size,)
    stiffness : ndarray, shape (size, size)
    turns, moves : ndarray of int
        Coordinates of the bodies about the axis: rotations, and motions across the axis.
    """
    root = cholesky((free.T * masses) @ free, lower=True)
    reduced = free.T @ stiffness @ free
    half = solve_triangular(root, reduced, lower=True)
    squared, vectors = np.linalg.eigh(solve_triangular(root, half.T, lower=True))
    shapes = free @ solve_triangular(root.T, vectors)
    squared = np.where(squared <= RIGID * squared[-1], 0.0, squared)
    shapes = _sorted_out(shapes, squared, masses, turns, moves)
    energy = masses[:, None] * shapes**2
    turning, moving = energy[turns].sum(axis=0), energy[moves].sum(axis=0)
    turning, moving = (np.where(share < _STILL, 0.0, share) for share in (turning, moving))
    words = {(True, False): "rotation", (False, True): "translation", (False, False): "planets"}
    kind = tuple(
        words.get((t > _STILL, m > _STILL), "mixed") if w > 0.0 else "rotation"
        for t, m, w in zip(turning, moving, squared, strict=True)
    )
    return ModesByKind(shapes, squared, turning, moving, kind)


def _sorted_out(shapes: Array, squared: Array, masses: Array, turns: Array, moves: Array) -> Array:
    """Modes of one frequency turned within their space so that each is of one kind, and the signs made definite."""
    found = shapes.copy()
    edges = np.flatnonzero(np.diff(squared) > _ONE * squared[-1]) + 1
    for own in np.split(np.arange(squared.size), edges):
        if own.size > 1:
            one = np.sqrt(masses)[:, None] * shapes[:, own]
            _, order = np.linalg.eigh(one[turns].T @ one[turns] + 2.0 * one[moves].T @ one[moves])
            found[:, own] = shapes[:, own] @ order
    return same_way_up(found)
