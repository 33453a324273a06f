"""Elimination of a train's network, node by node (star to mesh), towards one gear pair, and the way back.

What is left at the end are the pair's own two nodes a and b with what leaks out at each, A and B, the ways P from a
to b around the pair, and, where a damper slips, its flexibility phi and its turns t_a, t_b. With the pair's own
admittance Y this is Mark's ratio of determinants (2.57, repaired) for any train:

    Q = -N/(N + M Y),    M = phi (A + B) + (t_a + t_b)^2,
    N = phi (A B + (A + B) P) + t_a^2 B + t_b^2 A + (t_a + t_b)^2 P

(without slipping dampers phi = 1, t = 0): N is the determinant without the pair. Inertia and dampers to ground are
never added to a stiffness, so nothing of them is lost beside it. For a train without loops each step is
1/(1/y + 1/D), exact for parameters changed in the last place, in whatever order (Demmel and Gragg, acyclic matrices).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Floats
from fegear.dynamics.train.network import Network
from fegear.dynamics.train.segments import Rounded, beside_zero, in_series, share

#: Relative change of inertias and stiffnesses that is enough to bring an undamped resonance to a frequency that counts
#: as one.
RESONANCE = 2e-14


@dataclass(frozen=True, slots=True)
class _Step:
    """An eliminated node: its links to the others, its leak, their sum, and what slipping dampers turn at it."""

    node: int
    others: tuple[int, ...]
    links: tuple[Rounded, ...]
    leak: Rounded
    total: Rounded
    turns: tuple[Rounded | None, ...]


@dataclass(frozen=True)
class Response:
    """What one gear pair's transmission error does.

    Attributes
    ----------
    own : Rounded
        Q of the pair itself.
    lags : dict
        Difference of approach [m] of the other gear pairs, by number, per unit force on the pair's approach [N].
    resonance : ndarray of bool
        Frequencies that are natural frequencies without damping.
    """

    own: Rounded
    lags: dict[int, Rounded]
    resonance: NDArray[np.bool_]


def _plus(one: Rounded | None, other: Rounded) -> Rounded:
    return other if one is None else one + other


class _Elimination:
    """The network at some frequencies while nodes are taken out of it."""

    def __init__(self, network: Network, w: Floats, mesh: int) -> None:
        self.network, self.mesh, self.w = network, mesh, w
        iw = 1j * w
        self.leak = [Rounded.given(-np.square(w) * mass + 0j) for mass in network.mass]
        for node in np.flatnonzero(network.ground):
            self.leak[node] = self.leak[node] + Rounded.given(iw * network.ground[node])
        self.links: dict[tuple[int, int], Rounded] = {}
        for link in network.links:
            if link.mesh != mesh and link.a != link.b:
                self.join(link.a, link.b, self.admittance(link.stiffness, link.damping))
        # at standstill dampers neither push nor turn
        slips = network.slips if np.all(w > 0.0) else ()
        self.turns: list[dict[int, Rounded]] = []
        self.flexibility: dict[tuple[int, int], Rounded] = {}
        for k, slip in enumerate(slips):
            ends = ((slip.a, slip.turn_a), (slip.b, slip.turn_b))
            self.turns.append({node: Rounded.given(np.full(w.shape, turn + 0j)) for node, turn in ends})
            self.flexibility[k, k] = Rounded.given(1.0 / (iw * slip.damping))

    def admittance(self, stiffness: np.floating, damping: np.floating) -> Rounded:
        """Stiffness and damping of a link at work."""
        return Rounded.given(stiffness + 1j * self.w * damping)

    def join(self, a: int, b: int, y: Rounded) -> None:
        """Put a link beside what joins two nodes already."""
        pair = min(a, b), max(a, b)
        self.links[pair] = _plus(self.links.get(pair), y)

    def take_out(self, node: int, others: tuple[int, ...]) -> _Step:
        """Eliminate a node: star to mesh."""
        links = tuple(self.links.pop((min(node, b), max(node, b))) for b in others)
        leak = self.leak[node]
        total = leak
        for y in links:
            total = total + y
        errors = leak.error + sum(y.error for y in links)
        floor = np.finfo(self.w.dtype).eps * errors
        value = np.where(total.value == 0.0, np.where(floor == 0.0, 1.0, floor), total.value)
        total = Rounded(value, total.error)
        turns = tuple(row.pop(node, None) for row in self.turns)
        for m, (a, y) in enumerate(zip(others, links, strict=True)):
            others_err = np.maximum(errors - leak.error - y.error, 0.0) if len(others) > 1 else 0.0
            self.leak[a] = self.leak[a] + in_series(y, leak, value, others_err)
            for b, z in zip(others[:m], links[:m], strict=True):
                self.join(a, b, in_series(y, z, value, np.maximum(errors - y.error - z.error, 0.0)))
            for row, turn in zip(self.turns, turns, strict=True):
                if turn is not None:
                    rest = Rounded(value - y.value, np.maximum(errors - y.error, 0.0))
                    row[a] = _plus(row.get(a), turn * share(y, rest))
        for k, turn in enumerate(turns):
            for m in range(k + 1):
                other = turns[m]
                if turn is not None and other is not None:
                    self.flexibility[m, k] = _plus(self.flexibility.get((m, k)), turn * other / total)
        return _Step(node, others, links, leak, total, turns)


@dataclass(frozen=True, slots=True)
class Root:
    """The state of the pair's two nodes under a unit force on the approach: turns, their difference, slip forces."""

    own: Rounded
    at: tuple[Rounded, Rounded]
    lag: Rounded
    slip_forces: tuple[Rounded, ...]
    resonance: NDArray[np.bool_]


def close_pair(
    w: Floats,
    A: Rounded,
    B: Rounded,
    around: Rounded,
    own_link: Rounded,
    turn: np.floating,
    chain: _Slips | None = None,
) -> Root:
    """Put the gear pair between what is left of the train on both of its sides.

    Parameters
    ----------
    w : ndarray, shape (frequencies,)
    A, B : Rounded
        What leaks out at its nodes a and b.
    around, own_link : Rounded
        Admittance from a to b around the pair, and its own.
    turn : float
        Approach [m] for a unit difference of the nodes.
    chain : optional
        Slipping dampers.
    """
    still = w == 0.0
    if np.any(still):
        # no speed: nothing leaks; any split of the difference will do
        A, B = (Rounded(np.where(still, 0.5, x.value), np.where(still, 0.0, x.error)) for x in (A, B))
    if chain is None:
        # divided by A + B, so that a side at a resonance of its own passes on no more than the other one's leak
        M = Rounded(np.ones_like(A.value), np.zeros_like(A.error))
        through = in_series(A, B, beside_zero(A, B))
        if np.any(still):
            through = Rounded(np.where(still, 0.0, through.value), np.where(still, 0.0, through.error))
        N = through + around
        a, b = share(B, A), -share(A, B)
        slip: Rounded | None = None
    else:
        phi, ta, tb, around = chain.phi, chain.turn_a, chain.turn_b, chain.around
        tau = ta + tb
        M = phi * (A + B) + tau * tau
        N = phi * A * B + ta * ta * B + tb * tb * A + M * around
        a, b = phi * B + tau * tb, -(phi * A + tau * ta)
        slip = B * ta - A * tb
    pull = M * own_link
    D = N + pull
    own = -share(N, pull)
    resonance = RESONANCE * own.error >= 1.0 + np.abs(own.value)
    D = Rounded(np.where(D.value == 0.0, 1.0, D.value), D.error)
    lag = M / D
    forces: tuple[Rounded, ...] = ()
    if chain is not None and slip is not None:
        forces = tuple(f.times(turn) for f in chain.forces(slip / D, lag))
    return Root(own, ((a / D).times(turn), (b / D).times(turn)), lag.times(turn), forces, resonance)


def _root(state: _Elimination) -> Root:
    network = state.network
    link = network.links[state.mesh]
    none = Rounded.zero(state.leak[link.a].value)
    around = state.links.get((min(link.a, link.b), max(link.a, link.b)), none)
    chain = _reduce_slips(state, link.a, link.b, around, none)
    own_link = state.admittance(link.stiffness, link.damping)
    return close_pair(
        state.w, state.leak[link.a], state.leak[link.b], around, own_link, network.turns[state.mesh], chain
    )


def _picked(parts: Sequence[Rounded], which: NDArray[np.intp]) -> Rounded:
    """The part of this number at each frequency."""
    at = np.arange(which.size)
    return Rounded(np.stack([x.value for x in parts])[which, at], np.stack([x.error for x in parts])[which, at])


@dataclass(frozen=True, slots=True)
class _Slips:
    """Slipping dampers at the root, made into one; the others follow from it and from the difference of the nodes.

    Beside the first only combinations that the rigid-body motion does not work are kept, so that they act on the
    difference alone and their small forces are not lost beside the first one's. `places`: which damper is first,
    second ... at each frequency.
    """

    phi: Rounded
    turn_a: Rounded
    turn_b: Rounded
    around: Rounded
    ratios: tuple[Rounded, ...]
    rows: tuple[tuple[Rounded, tuple[Rounded, ...]], ...]
    places: NDArray[np.intp]

    def forces(self, first: Rounded, lag: Rounded) -> list[Rounded]:
        """Force of each damper, from the first one's and the difference of the two nodes."""
        found = [first]
        for own, couplings in self.rows:
            force = couplings[0] * lag
            for coupling, known in zip(couplings[1:], found, strict=True):
                force = force - coupling * known
            found.append(force / own)
        for ratio, force in zip(self.ratios, found[1:], strict=True):
            found[0] = found[0] - ratio * force
        # places only swap two, so that they are their own inverse
        return [_picked(found, place) for place in self.places]


def _reduce_slips(state: _Elimination, a: int, b: int, around: Rounded, none: Rounded) -> _Slips | None:
    count = len(state.turns)
    if count == 0:
        return None
    of_a = [row.get(a, none) for row in state.turns]
    of_b = [row.get(b, none) for row in state.turns]
    flexible = [[state.flexibility.get((min(m, k), max(m, k)), none) for k in range(count)] for m in range(count)]
    # the one that holds the rigid-body motion most comes first
    hold = [np.abs(of_a[k].value + of_b[k].value) ** 2 / np.abs(flexible[k][k].value) for k in range(count)]
    first = np.argmax(np.stack(hold), axis=0)
    places = np.repeat(np.arange(count)[:, None], first.size, axis=1)
    places[first, np.arange(first.size)], places[0] = 0, first
    ta, tb = ([_picked(parts, place) for place in places] for parts in (of_a, of_b))
    flat = [x for row in flexible for x in row]
    old = {(m, k): _picked(flat, places[m] * count + places[k]) for m in range(count) for k in range(count)}
    phi = dict(old)
    tau = ta[0] + tb[0]
    ratios = [none] + [(ta[k] + tb[k]) / tau for k in range(1, count)]
    u = [none] + [(ta[k] * tb[0] - tb[k] * ta[0]) / tau for k in range(1, count)]
    for k in range(1, count):
        r = ratios[k]
        phi[0, k] = phi[k, 0] = old[0, k] - r * old[0, 0]
        for m in range(1, count):
            phi[m, k] = old[m, k] - r * old[m, 0] - ratios[m] * old[0, k] + r * ratios[m] * old[0, 0]
    rows: list[tuple[Rounded, tuple[Rounded, ...]]] = []
    turn_a, turn_b = ta[0], tb[0]
    for k in range(count - 1, 0, -1):
        own = phi[k, k]
        rows.append((own, (u[k], *(phi[k, m] for m in range(k)))))
        pull = u[k] / own
        around = around + u[k] * pull
        turn_a, turn_b = turn_a - phi[0, k] * pull, turn_b + phi[0, k] * pull
        for m in range(k):
            u[m] = u[m] - phi[m, k] * pull if m else none
            for n in range(k):
                phi[m, n] = phi[m, n] - phi[m, k] * phi[k, n] / own
    return _Slips(phi[0, 0], turn_a, turn_b, around, tuple(ratios[1:]), tuple(reversed(rows)), places)


def respond(network: Network, w: Floats, mesh: int, order: Sequence[tuple[int, tuple[int, ...]]]) -> Response:
    """What the transmission error of one gear pair does to all, at positive frequencies or at zero.

    Parameters
    ----------
    network : Network
    w : ndarray, shape (frequencies,)
        Angular frequencies [rad/s], all positive or all zero, in the floats of the network.
    mesh : int
        The gear pair.
    order : sequence
        Order of elimination towards it, of `Network.order`.
    """
    needed = {node for link in network.links if 0 <= link.mesh != mesh for node in (link.a, link.b)}
    state = _Elimination(network, w, mesh)
    steps = []
    for node, others in order:
        step = state.take_out(node, others)
        if node in needed:
            needed.update(others)
            steps.append(step)
    root = _root(state)
    link = network.links[mesh]
    q = {link.a: root.at[0], link.b: root.at[1]}
    lags = {(link.a, link.b): root.lag, (link.b, link.a): -root.lag}
    for step in reversed(steps):
        _way_back(step, q, lags, root.slip_forces)
    found = {}
    for other in network.links:
        if 0 <= other.mesh != mesh:
            turn = network.turns[other.mesh]
            lag = lags.get((other.a, other.b))
            found[other.mesh] = Rounded.zero(root.lag.value) if lag is None else lag.times(turn)
    return Response(root.own, found, root.resonance)


def _way_back(
    step: _Step, q: dict[int, Rounded], lags: dict[tuple[int, int], Rounded], slip_forces: tuple[Rounded, ...]
) -> None:
    """Turn of an eliminated node, and its difference to each of its neighbours from what pulls at it."""
    slip: Rounded | None = None
    for turn, force in zip(step.turns, slip_forces, strict=True):
        if turn is not None:
            slip = _plus(slip, turn * force)
    pull = step.links[0] * q[step.others[0]]
    for y, b in zip(step.links[1:], step.others[1:], strict=True):
        pull = pull + y * q[b]
    q[step.node] = (pull if slip is None else pull - slip) / step.total
    for a in step.others:
        back = -(step.leak * q[a])
        for y, b in zip(step.links, step.others, strict=True):
            if b != a:
                back = back + y * lags[b, a]
        lag = (back if slip is None else back - slip) / step.total
        lags[step.node, a], lags[a, step.node] = lag, -lag
