"""What a torque that fluctuates at a body does to the gear pairs and shafts of a train with its mean mesh stiffnesses.

A body under torque turns the whole train slowly to and fro, far more than any spring of it yields: forces from angles
would be small differences. Forces of springs and angles are therefore unknowns beside each other, as in the static
state (`matrices.static_forces`): a spring's force is its admittance times the difference of its two nodes, and at
each node forces, inertia and torque balance. Angles are divided by the speed ratios (`network`) and scaled to the size
of a torque. A spring that closes a power loop follows from the loop, in which all that springs yield adds up to
nothing. So neither slow torques nor stiff shafts take digits, and loops keep the shares of their two ways.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from fegear.base.arrays import Array, Complex
from fegear.base.errors import InputError, RangeError
from fegear.base.shown import shown, shows
from fegear.base.tally import note
from fegear.dynamics.train.matrices import elements
from fegear.dynamics.train.modes import modes
from fegear.dynamics.train.network import Link, Network
from fegear.dynamics.train.torque_ripple import TorqueRipple
from fegear.dynamics.train.train import Train

#: Memory that the equations of one block of frequencies may take [bytes].
_MEMORY = 16 * 2**20
#: How near to the frequency of a mode without damping the response has no bound, as a share of it.
_NEAR = 1e-12
#: A mode has no damping where a radian takes less than this share of it.
_NO_DAMPING = 1e-15


@dataclass(frozen=True)
class TorqueResponse:
    """Complex amplitudes per unit of torque at one body, exp(+i w t).

    Attributes
    ----------
    forces : ndarray, shape (meshes, ...)
        Of the gear pairs, their damping included [N/(N m)].
    shafts : ndarray, shape (elastic shafts, ...)
        Torque that the shafts carry from their body a to b, their damping included [N m/(N m)].
    """

    forces: Complex
    shafts: Complex


def torque_response(train: Train, omega: ArrayLike, body: str) -> TorqueResponse:
    """Forces of gear pairs and torques of shafts per unit of torque at a body.

    Parameters
    ----------
    train : Train
        Gear pairs with their mean stiffness.
    omega : array_like, shape (...)
        Angular frequency [rad/s], positive.
    body : str
        Where the torque acts.

    Raises
    ------
    InputError
        If the body is unknown.
    RangeError
        If a frequency is not positive and finite, or meets a resonance without damping.
    """
    w = np.asarray(omega, dtype=float)
    if body not in train.dof:
        raise InputError("body", body, "is not a body of this train", f"known: {', '.join(sorted(train.dof))}")
    if not np.all(np.isfinite(w) & (w > 0.0)):
        raise RangeError("frequency", float(np.min(w)), "must be positive and finite", "constant torques are static")
    note("ripple lines", int(w.size))
    _refuse_resonance(train, w.ravel())
    forces, shafts = _solved(train, w.ravel(), train.dof[body])
    return TorqueResponse(forces.reshape(len(train.meshes), *w.shape), shafts.reshape(-1, *w.shape))


def _refuse_resonance(train: Train, w: Array) -> None:
    """Refuse frequencies at which a mode without damping has no bounded response."""
    found = modes(train)
    strain = np.zeros(train.size)
    for part in elements(train):
        turn = part.radius_a * found.shapes[part.a]
        turn = turn + part.radius_b * found.shapes[part.b] if part.b >= 0 else turn
        strain += part.damping * turn**2
    natural = 2.0 * math.pi * found.frequencies
    for omega, damping in zip(natural[1:], strain[1:], strict=True):
        met = np.abs(w - omega) <= _NEAR * omega
        if damping <= _NO_DAMPING * omega and np.any(met):
            raise RangeError(
                "frequency", f"{float(w[met][0]) / (2.0 * math.pi):.9g} Hz",
                "is a natural frequency of the undamped train: unbounded response",
                "specify damping or remove this frequency",
            )  # fmt: skip


def _solved(train: Train, w: Array, node: int) -> tuple[Complex, Complex]:
    """Forces of gear pairs and torques of shafts for torque one at a degree of freedom, shapes (count, frequencies)."""
    network = Network.of(train)
    links = [link for link in network.links if link.stiffness > 0.0 or link.damping > 0.0]
    slips, springs, size = network.slips, len(links) + len(network.slips), network.size
    ends = np.zeros((springs, size))
    for k, link in enumerate(links):
        ends[k, link.a] += 1.0
        ends[k, link.b] -= 1.0
    for k, slip in enumerate(slips, start=len(links)):
        ends[k, slip.a] += float(slip.turn_a)
        ends[k, slip.b] += float(slip.turn_b)
    ways = _ways(links, size)  # differences of angles are the forces' own, and those of every loop add up to none
    closes = np.zeros((springs, springs))
    closes[: len(links), : len(links)] = ways
    closes[len(links) :, len(links) :] = np.eye(len(slips))
    loops = np.count_nonzero(closes, axis=1) > 1
    nodes = np.where(loops[:, None], 0.0, ends)
    stiff = np.array([*(float(link.stiffness) for link in links), *(0.0 for _ in slips)])
    damping = np.array([*(float(link.damping) for link in links), *(slip.damping for slip in slips)])
    mass, ground = network.mass.astype(float), network.ground.astype(float)
    held = float(ground.sum()) + float(damping @ ends.sum(axis=1) ** 2)
    load = np.zeros(springs + size, dtype=complex)
    load[springs + node] = train.ratios[node]
    found = np.empty((springs, w.size), dtype=complex)
    block = max(int(_MEMORY // (16 * (springs + size) ** 2)), 1)
    for start in range(0, w.size, block):
        part = w[start : start + block]
        matrix = np.zeros((part.size, springs + size, springs + size), dtype=complex)
        scale = part**2 * float(mass.sum()) + part * held  # angles times this are of the size of the torque
        yields = scale[:, None] / (stiff + 1j * part[:, None] * damping)
        matrix[:, :springs, :springs] = closes * yields[:, None, :]
        matrix[:, :springs, springs:] = -nodes
        matrix[:, :springs] /= np.max(np.abs(matrix[:, :springs]), axis=2, keepdims=True)
        matrix[:, springs:, :springs] = ends.T
        at = springs + np.arange(size)
        matrix[:, at, at] = (-(part[:, None] ** 2) * mass + 1j * part[:, None] * ground) / scale[:, None]
        right = np.broadcast_to(load, (part.size, load.size))[..., None]
        answer = np.linalg.solve(matrix, right)
        answer = answer + np.linalg.solve(matrix, right - matrix @ answer)  # round-off, entry by entry
        found[:, start : start + block] = answer[:, :springs, 0].T
    turns = network.turns.astype(float)
    count = turns.size
    shafts = np.array([train.ratios[train.dof[shaft.a]] for shaft in train.elastic_shafts])
    return found[:count] / turns[:, None], found[count : count + shafts.size] / shafts[:, None]


def _ways(links: Sequence[Link], size: int) -> Array:
    """For each link what its own angle is the sum of: itself on a tree of springs, and of others the loop they close.

    Returns
    -------
    ndarray, shape (links, links)
        Signs; a row with one entry is a link of the tree.
    """
    rows = np.eye(len(links))
    way: dict[int, Array] = {0: np.zeros(len(links))}  # angle of each node over that of the first, link by link
    waiting = sorted(range(len(links)), key=lambda k: links[k].stiffness <= 0.0)
    on_tree: set[int] = set()
    while len(way) < size:
        for k in waiting:
            a, b = links[k].a, links[k].b
            if (a in way) != (b in way):
                step = rows[k]
                if a in way:
                    way[b] = way[a] - step
                else:
                    way[a] = way[b] + step
                on_tree.add(k)
                break
    for k in set(range(len(links))) - on_tree:
        if links[k].a != links[k].b:
            rows[k] = np.eye(len(links))[k] - (way[links[k].a] - way[links[k].b])
    return rows


@dataclass(frozen=True)
class RippleSpectrum:
    """Line spectrum of what gear pairs and shafts carry by torque ripple, complex amplitudes (0-peak).

    Shapes: of, harmonics, torques (lines,), frequencies (lines, speeds), forces (meshes, lines, speeds), shafts
    (elastic shafts, lines, speeds). Line k is of ripple number of[k].
    """

    speeds: Array
    ripple: tuple[TorqueRipple, ...]
    of: tuple[int, ...]
    harmonics: NDArray[np.int64] = shown("", "harmonic of the torque ripple", name="n")
    torques: Complex = shown("N.m", "complex amplitude of the torque")
    frequencies: Array = shown("Hz", "frequency of the spectral line", name="frequency")
    forces: Complex = shown("N", "complex amplitude of the mesh force")
    shafts: Complex = shown("N.m", "complex amplitude of the torque in a shaft")

    @property
    @shows("N^2", "one-sided power of the torque ripple line", name="power")
    def power_lines(self) -> Array:
        """Half the square of each amplitude of the mesh forces [N^2]."""
        return np.asarray(0.5 * np.abs(self.forces) ** 2)


def ripple_spectrum(train: Train, ripple: Sequence[TorqueRipple], speeds: ArrayLike) -> RippleSpectrum:
    """Forces of every gear pair and torques of every elastic shaft by every harmonic of every ripple.

    Parameters
    ----------
    train : Train
        Gear pairs with their mean stiffness.
    ripple : sequence of TorqueRipple
    speeds : array_like, shape (speeds,)
        Of the first body [rad/s].
    """
    speed = np.atleast_1d(np.asarray(speeds, dtype=float))
    frequencies = [one.frequencies(speed) for one in ripple]
    found = [torque_response(train, 2.0 * math.pi * at, one.body) for one, at in zip(ripple, frequencies, strict=True)]
    lines = list(zip(ripple, found, strict=True))
    return RippleSpectrum(
        speed, tuple(ripple), tuple(k for k, one in enumerate(ripple) for _ in one.harmonics),
        np.concatenate([one.harmonics for one in ripple]), np.concatenate([one.torques for one in ripple]),
        np.concatenate(frequencies), np.concatenate([one.torques[:, None] * r.forces for one, r in lines], axis=1),
        np.concatenate([one.torques[:, None] * r.shafts for one, r in lines], axis=1),
    )  # fmt: skip


def ripple_increment(train: Train, one: TorqueRipple, speed: float, mesh: int) -> Complex:
    """What each harmonic of a ripple adds to the approach of a gear pair, as a force over its stiffness [m]."""
    found = torque_response(train, 2.0 * math.pi * one.frequencies(speed), one.body).forces[mesh]
    return np.asarray(one.torques * found / train.meshes[mesh].stiffness)
