"""Mass, damping and stiffness matrices of a gear train, its element list and its static state."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fegear.base.arrays import Array
from fegear.dynamics.train.train import Train


@dataclass(frozen=True, slots=True)
class Element:
    """A spring and damper in parallel that acts on ``radius_a theta_a + radius_b theta_b``.

    `b` is -1 for the ground; `mesh` is the number of the gear pair, or -1. `geared` says that the element is
    consistent with the rigid-body motion of the train by construction, so that it adds nothing to it.
    """

    a: int
    b: int
    radius_a: float
    radius_b: float
    stiffness: float
    damping: float
    mesh: int = -1
    geared: bool = True


def elements(train: Train) -> tuple[Element, ...]:
    """All springs and dampers of a train: gear pairs first, then shafts, dampers between bodies, dampers to ground."""
    dof = train.dof
    found = [
        Element(dof[m.a], dof[m.b], m.radius_a, m.radius_b, m.stiffness, m.damping, mesh=index)
        for index, m in enumerate(train.meshes)
    ]
    found += [Element(dof[s.a], dof[s.b], 1.0, -1.0, s.stiffness, s.damping) for s in train.elastic_shafts]
    for damper in train.dampers:
        a = dof[damper.a]
        if damper.b is None:
            found.append(Element(a, -1, 1.0, 0.0, 0.0, damper.damping, geared=False))
        elif dof[damper.b] != a:
            b = dof[damper.b]
            geared = train.exact_ratios[a] == train.exact_ratios[b]
            found.append(Element(a, b, 1.0, -1.0, 0.0, damper.damping, geared=geared))
    return tuple(found)


def _assemble(train: Train, weights: list[float]) -> Array:
    total = np.zeros((train.size, train.size))
    for element, weight in zip(elements(train), weights, strict=True):
        row = np.zeros(train.size)
        row[element.a] += element.radius_a
        if element.b >= 0:
            row[element.b] += element.radius_b
        total += weight * np.outer(row, row)
    return total


def mass_matrix(train: Train) -> Array:
    """Diagonal mass matrix [kg m^2], shape (size, size)."""
    return np.diag(train.inertia)


def damping_matrix(train: Train, *, meshes: bool = True) -> Array:
    """Damping matrix [N m s/rad], shape (size, size), with or without the gear pairs' own damping."""
    return _assemble(train, [e.damping if meshes or e.mesh < 0 else 0.0 for e in elements(train)])


def stiffness_matrix(train: Train, *, meshes: bool = True) -> Array:
    """Stiffness matrix [N m/rad], shape (size, size), with the mean stiffness of the gear pairs or without them."""
    return _assemble(train, [e.stiffness if meshes or e.mesh < 0 else 0.0 for e in elements(train)])


def projected(train: Train, shapes: Array, of: Literal["stiffness", "damping"]) -> Array:
    """Stiffness or damping matrix without the gear pairs, in coordinates whose shapes are columns of rotation angles.

    Each spring and damper counts by what the shapes strain it, and zeros stay zeros: shapes that turn both of its ends
    alike do not strain it by round-off.

    Parameters
    ----------
    train : Train
    shapes : ndarray, shape (size, n)
    of : {"stiffness", "damping"}

    Returns
    -------
    ndarray, shape (n, n)
    """
    parts = [part for part in elements(train) if part.mesh < 0 and getattr(part, of) > 0.0]
    rows = np.zeros((len(parts), shapes.shape[1]))
    for index, part in enumerate(parts):
        one = part.radius_a * shapes[part.a]
        other = part.radius_b * shapes[part.b] if part.b >= 0 else np.zeros_like(one)
        row = one + other
        row[np.abs(row) <= 8.0 * np.finfo(float).eps * np.abs(one)] = 0.0
        rows[index] = math.sqrt(getattr(part, of)) * row
    found: Array = rows.T @ rows
    return found


def static_forces(train: Train) -> Array:
    """Mean force of each gear pair under the constant torques [N], positive when it presses the teeth together.

    Divided by the speed ratios, every spring joins two nodes: what it carries follows from equilibrium alone wherever
    the train is a tree. Forces and angles are therefore unknowns beside each other; angles alone would leave the force
    of a gear pair beside a stiff shaft as a small difference (half its digits lost at 1e16 N m/rad).
    """
    springs = [e for e in elements(train) if e.stiffness > 0.0]
    count, ratio = len(springs), train.ratios
    matrix = np.zeros((count + train.size, count + train.size))
    turns = np.array([spring.radius_a * ratio[spring.a] for spring in springs])
    compliance = np.array([1.0 / (e.stiffness * turn**2) for e, turn in zip(springs, turns, strict=True)])
    for k, spring in enumerate(springs):
        matrix[k, k] = compliance[k] / compliance.max()
        for node, sign in ((spring.a, 1.0), (spring.b, -1.0)):
            matrix[k, count + node] = -sign
            matrix[count + node, k] = sign
    # The first body stands still; its equilibrium follows from that of the others once the torques are balanced.
    share = train.inertia * ratio**2
    load = train.torque * ratio
    load -= share / share.sum() * load.sum()
    matrix[count, :] = 0.0
    matrix[count, count], load[0] = 1.0, 0.0
    through = np.linalg.solve(matrix, np.concatenate([np.zeros(count), load]))
    forces: Array = (through[:count] / turns)[: len(train.meshes)]
    return forces
