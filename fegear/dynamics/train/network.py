"""A gear train as an electrical network, the order in which its nodes are eliminated, and the admittances at work.

Angles are divided by the speed ratios. Every spring then joins two nodes, and only inertia and dampers to ground leak
out. A damper that the rigid-body motion of the train works ("slipping": between bodies of different speed) is neither:
it acts on a sum of two angles of its own and keeps a place of its own.
"""

from __future__ import annotations

import heapq
from dataclasses import dataclass
from fractions import Fraction

import numpy as np

from fegear.base.arrays import Floats
from fegear.dynamics.train.matrices import elements
from fegear.dynamics.train.train import Train


@dataclass(frozen=True, slots=True)
class Link:
    """A spring and damper between two nodes, in the angles over the speed ratios [N m/rad, N m s/rad]."""

    a: int
    b: int
    stiffness: np.floating
    damping: np.floating
    mesh: int


@dataclass(frozen=True, slots=True)
class Slip:
    """A damper [N m s/rad] on ``turn_a q_a + turn_b q_b``, which the rigid-body motion does not leave at rest."""

    a: int
    b: int
    turn_a: np.floating
    turn_b: np.floating
    damping: float


@dataclass(frozen=True)
class Network:
    """Nodes, links and leaks of a train.

    Attributes
    ----------
    size : int
        Number of nodes.
    mass, ground : ndarray, shape (size,)
        Inertia [kg m^2] and damping to ground [N m s/rad], referred to the speed of the first body.
    links : tuple of Link
        The gear pairs first, in their order.
    slips : tuple of Slip
        The one that damps the rigid-body motion most comes first.
    turns : ndarray, shape (meshes,)
        Approach of each gear pair [m] for a unit difference q_a - q_b.
    """

    size: int
    mass: Floats
    ground: Floats
    links: tuple[Link, ...]
    slips: tuple[Slip, ...]
    turns: Floats

    @classmethod
    def of(cls, train: Train, kind: type[np.floating] = np.float64) -> Network:
        """The network of a train, in floats of a kind."""
        near = [float(ratio) for ratio in train.exact_ratios]
        rest = [float(ratio - Fraction(value)) for ratio, value in zip(train.exact_ratios, near, strict=True)]
        ratio = np.array(near, dtype=kind) + np.array(rest, dtype=kind)
        ground = np.zeros(train.size, dtype=kind)
        links, slips, turns = [], [], []
        for part in elements(train):
            turn = kind(part.radius_a) * ratio[part.a]
            if part.mesh >= 0:
                turns.append(turn)
            if part.b < 0:
                ground[part.a] += part.damping * turn**2
            elif part.geared:
                links.append(Link(part.a, part.b, part.stiffness * turn**2, part.damping * turn**2, part.mesh))
            elif part.damping > 0.0:
                slips.append(Slip(part.a, part.b, turn, kind(part.radius_b) * ratio[part.b], part.damping))
        slips.sort(key=lambda slip: -float(slip.damping * (slip.turn_a + slip.turn_b) ** 2))
        mass = train.inertia.astype(kind) * ratio**2
        return cls(train.size, mass, ground, tuple(links), tuple(slips), np.array(turns, dtype=kind))

    def neighbours(self) -> list[set[int]]:
        """Nodes that links join to each node."""
        found: list[set[int]] = [set() for _ in range(self.size)]
        for link in self.links:
            if link.a != link.b:
                found[link.a].add(link.b)
                found[link.b].add(link.a)
        return found

    def _distances(self, start: tuple[int, int], near: list[set[int]]) -> list[int]:
        distance = [self.size] * self.size
        waiting = list(start)
        for node in start:
            distance[node] = 0
        for node in waiting:
            for other in near[node]:
                if distance[other] == self.size:
                    distance[other] = distance[node] + 1
                    waiting.append(other)
        return distance

    def order(self, mesh: int, variant: int = 0) -> list[tuple[int, tuple[int, ...]]]:
        """Order of elimination towards a gear pair: (node, neighbours left), ends of branches first.

        A node with one neighbour leaves no new link behind, one with two leaves one: of long trains and single loops
        nothing fills in. Variant 0 takes far nodes first among equals, others a random one.
        """
        near = self.neighbours()
        ends = self.links[mesh].a, self.links[mesh].b
        rank = [-d for d in self._distances(ends, near)]
        if variant:
            rank = [int(place) for place in np.random.default_rng(variant).permutation(self.size)]
        heap = [(len(near[node]), rank[node], node) for node in range(self.size) if node not in ends]
        heapq.heapify(heap)
        gone = [False] * self.size
        found = []
        while heap:
            degree, _, node = heapq.heappop(heap)
            if gone[node] or degree != len(near[node]):
                continue
            gone[node] = True
            others = tuple(sorted(near[node]))
            found.append((node, others))
            for a in others:
                near[a].discard(node)
                near[a].update(b for b in others if b != a)
                if a not in ends:
                    heapq.heappush(heap, (len(near[a]), rank[a], a))
        return found

    @property
    def branches_only(self) -> bool:
        """Whether there is one way only between any two nodes: no loop, no slipping damper."""
        pairs = {frozenset((link.a, link.b)) for link in self.links if link.a != link.b}
        return len(pairs) == self.size - 1 and not self.slips
