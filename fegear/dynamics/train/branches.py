"""Trains without loops: what every gear pair's transmission error does to all, at the price of about one of them.

A link of such a train cuts it in two. What the part behind it leaks, seen through the link, depends on that part alone
and not on which pair excites: one sweep towards a root and one back give it for both sides of every link, in the same
arithmetic as the elimination towards one pair (`star_mesh`). From a pair outwards turns then follow as products of
what each link passes on, made once for each stretch between two gear pairs.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Floats
from fegear.dynamics.train.network import Network
from fegear.dynamics.train.segments import Rounded, in_series, share
from fegear.dynamics.train.star_mesh import Response, close_pair


@dataclass(frozen=True)
class Branches:
    """A train without loops, seen from one of its gear pairs.

    Attributes
    ----------
    order : tuple of int
        Nodes from the root outwards.
    parent : tuple of int
        The next node towards the root of each; -1 of the root.
    links : tuple of tuple of int
        Numbers of the links between each node and its parent.
    between : tuple of bool
        Whether a node lies on the way from a gear pair to the root, so that something of it is asked.
    """

    order: tuple[int, ...]
    parent: tuple[int, ...]
    links: tuple[tuple[int, ...], ...]
    between: tuple[bool, ...]

    @classmethod
    def of(cls, network: Network) -> Branches:
        """See a network without loops from its first gear pair."""
        joined: dict[tuple[int, int], list[int]] = {}
        for number, link in enumerate(network.links):
            if link.a != link.b:
                joined.setdefault((link.a, link.b), []).append(number)
                joined.setdefault((link.b, link.a), []).append(number)
        near = network.neighbours()
        root = network.links[0].a if network.links else 0
        parent, order = [-1] * network.size, [root]
        for node in order:
            for other in sorted(near[node]):
                if other != parent[node]:
                    parent[other] = node
                    order.append(other)
        links = tuple(tuple(joined.get((node, parent[node]), ())) for node in range(network.size))
        between = [any(network.links[k].mesh >= 0 for k in own) for own in links]
        for node in reversed(order):
            if between[node] and parent[node] >= 0:
                between[parent[node]] = True
        return cls(tuple(order), tuple(parent), links, tuple(between))

    @property
    def kept(self) -> int:
        """Numbers that are kept of each frequency while it is solved."""
        return 8 * sum(self.between) + 8


@dataclass(frozen=True, slots=True)
class _Side:
    """One side of a link: what leaks out at its near node, and with the link's admittance in series to that."""

    leak: Rounded
    total: Rounded

    @classmethod
    def behind(cls, leak: Rounded, y: Rounded) -> _Side:
        total, floor = leak + y, np.finfo(leak.error.dtype).eps * (leak.error + y.error)
        value = np.where(total.value == 0.0, np.where(floor == 0.0, 1.0, floor), total.value)
        return cls(leak, Rounded(value, total.error))

    def seen(self, y: Rounded) -> Rounded:
        """What the side leaks, seen through the link."""
        return in_series(y, self.leak, self.total.value)

    def passed(self, y: Rounded) -> Rounded:
        """Turn of this side's node over that of the node beyond the link, from where it is driven."""
        return share(y, self.leak, self.total.value)


class _Solved:
    """Both sides of every link between gear pairs, at some frequencies."""

    def __init__(self, network: Network, plan: Branches, w: Floats) -> None:
        self.network, self.plan, self.w = network, plan, w
        self.y: dict[int, Rounded] = {}
        #: of the link between each node and its parent: the node's own side, and its parent's
        self.out: dict[int, _Side] = {}
        self.back: dict[int, _Side] = {}
        self._sweep()

    def admittance(self, numbers: Iterable[int]) -> Rounded:
        """Of parallel links."""
        links = [self.network.links[k] for k in numbers]
        parts = [Rounded.given(link.stiffness + 1j * self.w * link.damping) for link in links]
        return _sum(parts)

    def _leak(self, node: int) -> Rounded:
        own = Rounded.given(-np.square(self.w) * self.network.mass[node] + 0j)
        ground = self.network.ground[node]
        return own + Rounded.given(1j * self.w * ground) if ground else own

    def _sweep(self) -> None:
        plan = self.plan
        # what each node collects: its own leak and that of its branches, those between gear pairs kept apart
        at: dict[int, Rounded] = {}
        branches: dict[int, list[tuple[int, Rounded]]] = {}
        for node in reversed(plan.order):
            own = at.pop(node, None)
            own = self._leak(node) if own is None else own + self._leak(node)
            if plan.between[node]:
                at[node] = own
                own = _sum([own, *(seen for _, seen in branches.get(node, ()))])
            parent = plan.parent[node]
            if parent < 0:
                continue
            y = self.admittance(plan.links[node])
            side = _Side.behind(own, y)
            seen = side.seen(y)
            if plan.between[node]:
                self.y[node], self.out[node] = y, side
                branches.setdefault(parent, []).append((node, seen))
            else:
                at[parent] = at[parent] + seen if parent in at else seen
        for node in plan.order:
            if not plan.between[node]:
                continue
            base = at[node]
            if node in self.back:
                base = base + self.back[node].seen(self.y[node])
            for child, rest in _without_each(base, branches.get(node, [])):
                self.back[child] = _Side.behind(rest, self.y[child])


def _sum(parts: list[Rounded]) -> Rounded:
    total = parts[0]
    for part in parts[1:]:
        total = total + part
    return total


def _without_each(base: Rounded, parts: list[tuple[int, Rounded]]) -> Iterator[tuple[int, Rounded]]:
    """The sum of all but one, for each: by sums from both ends, so that nothing is taken away again."""
    behind = [base]
    for _, part in reversed(parts[1:]):
        behind.append(behind[-1] + part)
    before: Rounded | None = None
    for (node, part), rest in zip(parts, behind[::-1][: len(parts)], strict=True):
        yield node, rest if before is None else rest + before
        before = part if before is None else before + part


@dataclass(frozen=True, slots=True)
class _Stretch:
    """A way from one node to another without a gear pair before its last link.

    Attributes
    ----------
    before, end : int
        Its last two nodes.
    passed : Rounded
        Turn of the end over that of the start.
    lags : tuple
        Of each gear pair on the last link: its number and its difference of approach over the turn of the start.
    """

    before: int
    end: int
    passed: Rounded
    lags: tuple[tuple[int, Rounded], ...]


class Ways:
    """From any gear pair's transmission error to all gear pairs of a train without loops.

    Parameters
    ----------
    network : Network
    plan : Branches
        Of the network.
    w : ndarray, shape (frequencies,)
        Angular frequencies [rad/s], all positive or all zero, in the floats of the network.
    """

    def __init__(self, network: Network, plan: Branches, w: Floats) -> None:
        self.solved = _Solved(network, plan, w)
        self.near: dict[int, list[int]] = {}
        for node in self.solved.out:
            self.near.setdefault(node, []).append(plan.parent[node])
            self.near.setdefault(plan.parent[node], []).append(node)
        self.stretches: dict[tuple[int, int], _Stretch] = {}

    def respond(self, mesh: int) -> Response:
        """What the transmission error of one gear pair does."""
        solved, network = self.solved, self.solved.network
        link = network.links[mesh]
        child = link.a if solved.plan.parent[link.a] == link.b else link.b
        own, beyond = solved.out[child].leak, solved.back[child].leak
        beside = [k for k in solved.plan.links[child] if k != mesh]
        around = solved.admittance(beside) if beside else Rounded.zero(own.value)
        root = close_pair(
            solved.w, *((own, beyond) if child == link.a else (beyond, own)), around, solved.admittance([mesh]),
            network.turns[mesh],
        )  # fmt: skip
        lags = {k: self._signed(k, link.a, root.lag) for k in beside if network.links[k].mesh >= 0}
        waiting = [(link.a, link.b, root.at[0]), (link.b, link.a, root.at[1])]
        while waiting:
            node, source, turn = waiting.pop()
            for other in self.near[node]:
                if other == source:
                    continue
                stretch = self._stretch(node, other)
                for k, lag in stretch.lags:
                    lags[k] = lag * turn
                if len(self.near[stretch.end]) > 1:
                    waiting.append((stretch.end, stretch.before, stretch.passed * turn))
        # gear pairs come first among the links, in their order; those on rigid shafts feel nothing
        found = {k: Rounded.zero(root.lag.value) for k in range(network.turns.size) if k != mesh}
        found |= {k: lag.times(network.turns[k]) for k, lag in lags.items()}
        return Response(root.own, found, root.resonance)

    def _signed(self, mesh: int, start: int, difference: Rounded) -> Rounded:
        """Difference of a pair's nodes a and b, from that of a start and the other one."""
        return difference if self.solved.network.links[mesh].a == start else -difference

    def _stretch(self, start: int, first: int) -> _Stretch:
        """From a node over a neighbour, on to the next gear pair or fork."""
        if (start, first) in self.stretches:
            return self.stretches[start, first]
        solved, plan = self.solved, self.solved.plan
        passed: Rounded | None = None
        before, node = start, first
        while True:
            outwards = plan.parent[node] == before
            child, side = (node, solved.out[node]) if outwards else (before, solved.back[before])
            y = solved.y[child]
            meshes = [k for k in plan.links[child] if solved.network.links[k].mesh >= 0]
            step = side.passed(y)
            if meshes or len(self.near[node]) != 2:
                break
            passed = step if passed is None else passed * step
            before, node = node, next(other for other in self.near[node] if other != before)
        # start minus end of the last link: what it does not pass on
        lost = share(side.leak, y, side.total.value) if meshes else step
        lost = lost if passed is None else passed * lost
        lags = tuple((solved.network.links[k].mesh, self._signed(k, before, lost)) for k in meshes)
        found = _Stretch(before, node, step if passed is None else passed * step, lags)
        self.stretches[start, first] = found
        return found
