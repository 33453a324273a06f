"""Faces of cracks that may press on each other while the tooth pairs share the load: both contacts at once.

Loads W of the pairs open the nodes of all faces by B W, pairs of forces p between the faces by C p, and the forces
deflect the pairs by B' p. With the pairs' compliances c of free faces and their law it is one complementarity problem,

    u + e = zeta, W > 0  or  u + e >= zeta, W = 0,  sum W = given;   B W + C p >= 0, p >= 0, p'(B W + C p) = 0,

the condition of a strictly convex minimum: one answer only. While a set S of nodes presses the pairs have the
compliance c - B_S' C_SS^-1 B_S (the set's own minimum over p), so that loads are shared as always and the next set is
that which presses under them: Newton's method on a convex function that is quadratic piece by piece. A step that goes
too far is shortened to the minimum along it.

B and C count for the whole face as the pairs' compliances do: forces in N.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import ConvergenceError
from fegear.contact.plane.load_sharing import SharedLoad, share_load
from fegear.fem.plane.odd.crack_faces import pressed, shut_by
from fegear.geometry.pair import MEMBERS, Member

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array, Index, Mask
    from fegear.contact.contact_law import ContactLaw
    from fegear.contact.plane.meshing import Contacts
    from fegear.contact.plane.odd_compliance import OddCompliance

#: Steps with the whole way to the next answer, steps in all, and halvings of a step that is shortened.
_WHOLE_STEPS, _MOST_STEPS, _HALVINGS = 8, 60, 50
#: Loads that change by less than this share of the total stay.
_STAYS = 1e-13


@dataclass(frozen=True)
class ClosingFaces:
    """Nodes of all crack faces of both gears at P roll positions.

    Parameters
    ----------
    opening : ndarray, shape (N, n, P)
        B: opening of free faces per load on each of n pairs [m/N].
    compliance : ndarray, shape (N, N)
        C: opening per pair of forces between the faces [m/N].
    of : mapping of {"driver", "driven"} to slice
        Which nodes are of which gear.
    """

    opening: Array
    compliance: Array
    of: Mapping[Member, slice]

    def at(self, change: Callable[[Array], Array]) -> ClosingFaces:
        """The same with its positions changed."""
        return replace(self, opening=change(self.opening))

    def forces(self, loads: Array) -> Array:
        """Between opposite nodes under loads of the pairs, shape (n, P, L) [N], shape (N, P, L) [N]."""
        opened = np.einsum("kjp,jpl->kpl", self.opening, loads)
        return pressed(self.compliance, opened.reshape(opened.shape[0], -1)).reshape(opened.shape)

    def stiffening(self, shut: Mask) -> Array:
        """What nodes that are shut, (N, P), take away of the pairs' compliances, shape (n, n, P) [m/N]."""
        unit = 1.0 / np.sqrt(np.diagonal(self.compliance))
        opening = unit[:, None, None] * self.opening
        held = shut_by(self.compliance * unit * unit[:, None], shut, opening)
        return np.asarray(np.einsum("kip,kjp->ijp", opening, held))

    def stiffening_under(self, loads: Array) -> Array:
        """The same with the nodes that press under loads, shape (n, n, P, L) [m/N]."""
        shut = self.forces(loads) > 0.0
        found = [self.stiffening(shut[:, :, load]) for load in range(loads.shape[2])]
        return np.stack(found, axis=-1)


def closing_faces(
    sources: Sequence[object], teeth: Sequence[Sequence[int]], at: Contacts, face_width: float
) -> ClosingFaces | None:
    """Faces of all cracks that loads on the pairs can move; None where there are none.

    Parameters
    ----------
    sources : sequence of GearCompliance
        Of driver and driven gear.
    teeth : sequence of sequence of int
        The teeth of each on the n pairs.
    at : Contacts
    face_width : float
        [m].
    """
    openings, compliances, of, first = [], [], {}, 0
    radii = at.radius_driver, at.radius_driven
    for member, radius, given, numbers in zip(MEMBERS, radii, sources, teeth, strict=True):
        source = faces_of(given)
        if source is None or not any(source.moves_faces(i) for i in numbers):
            continue
        count = source.influence.faces_compliance.shape[0]
        found = np.zeros((count, *at.x.shape))
        for row, i in enumerate(numbers):
            here = at.present[row]
            if here.any() and source.moves_faces(i):
                found[:, row, here] = source.face_openings(i, radius[row, here])
        openings.append(found / face_width)
        compliances.append(source.influence.faces_compliance / face_width)
        of[member] = slice(first, first + count)
        first += count
    if not openings:
        return None
    compliance = np.zeros((first, first))
    for part, each in zip(of.values(), compliances, strict=True):
        compliance[part, part] = each
    return ClosingFaces(np.concatenate(openings), compliance, of)


def faces_of(source: object) -> OddCompliance | None:
    """A source that has cracks whose faces may close, as such."""
    from fegear.contact.plane.odd_compliance import OddCompliance

    return source if isinstance(source, OddCompliance) and source.influence.fine.closing else None


def share_with_faces(
    compliance: Array, faces: ClosingFaces, separation: ArrayLike, load: ArrayLike, law: ContactLaw
) -> SharedLoad:
    """`share_load` with faces of cracks that close as these loads want.

    Parameters
    ----------
    compliance : ndarray, shape (n, n, P)
        Of pairs whose cracks' faces are free [m/N].
    faces : ClosingFaces
    separation, load, law
        See `share_load`.

    Raises
    ------
    ConvergenceError
        If no shortened step is the last.
    """
    total, e = np.atleast_1d(np.asarray(load, dtype=float)), np.asarray(separation, dtype=float)
    positions, cases = compliance.shape[2], total.shape[-1]
    column = np.repeat(np.arange(positions), cases)
    total = np.broadcast_to(total, (positions, cases)).reshape(-1, 1)
    flat = np.broadcast_to(e[:, :, None] if e.ndim == 2 else e, (e.shape[0], positions, cases)).reshape(len(e), -1)
    problem = _Problem(compliance[:, :, column], faces.at(lambda values: values[..., column]), flat, total,
                       law.at(column))  # fmt: skip
    loads, error, steps = _solve(problem)
    return SharedLoad(loads.reshape(-1, positions, cases), error.reshape(positions, cases), steps)


@dataclass(frozen=True)
class _Problem:
    """B problems: compliances (n, n, B), faces, separations (n, B), total loads (B, 1)."""

    compliance: Array
    faces: ClosingFaces
    separation: Array
    total: Array
    law: ContactLaw

    def at(self, which: Index) -> _Problem:
        """Some of them."""
        return _Problem(
            self.compliance[:, :, which], self.faces.at(lambda values: values[..., which]), self.separation[:, which],
            self.total[which], self.law.at(which),
        )  # fmt: skip

    def shared(self, shut: Mask | None) -> SharedLoad:
        """Loads while these nodes press; by default none."""
        c = self.compliance if shut is None else self.compliance - self.faces.stiffening(shut)
        return share_load(c, self.separation, self.total, self.law)

    def shut(self, loads: Array) -> Mask:
        """Nodes that press under loads, shape (n, B)."""
        return np.asarray(self.faces.forces(loads[:, :, None])[:, :, 0] > 0.0)

    def slope(self, loads: Array, way: Array) -> Array:
        """Derivative of the energy along a way, shape (B,): what the pairs' gaps do on it."""
        each = np.arange(loads.shape[0])
        deflection = np.einsum("ijb,jb->ib", self.compliance, loads)
        own = self.compliance[each, each]
        deflection += (self.law.secant(own, loads) - own) * loads
        deflection += np.einsum("kib,kb->ib", self.faces.opening, self.faces.forces(loads[:, :, None])[:, :, 0])
        reached = np.where(np.isfinite(self.separation), self.separation, 0.0)
        return np.asarray(((deflection + reached) * way).sum(axis=0))


def _solve(problem: _Problem) -> tuple[Array, Array, int]:
    """Loads, shape (n, B), transmission errors, shape (B,), and the steps of the slowest."""
    first = problem.shared(None)
    loads, error, steps = first.loads[:, :, 0], first.transmission_error[:, 0], first.steps
    shut = problem.shut(loads)
    index = np.flatnonzero(shut.any(axis=0))
    shut, left = shut[:, index], problem.at(index)
    for turn in range(_MOST_STEPS):
        if not index.size:
            return loads, error, steps
        found = left.shared(shut)
        before, after = loads[:, index], found.loads[:, :, 0]
        steps = max(steps, turn + found.steps)
        new = left.shut(after)
        done = (new == shut).all(axis=0) | (np.abs(after - before) <= _STAYS * left.total[:, 0]).all(axis=0)
        if turn >= _WHOLE_STEPS and not done.all():
            after = np.where(done, after, _shortened(left, before, after))
            new = left.shut(after)
        loads[:, index], error[index] = after, found.transmission_error[:, 0]
        index, shut, left = index[~done], new[:, ~done], left.at(np.flatnonzero(~done))
    raise ConvergenceError(
        f"No consistent contact of the crack faces found for {index.size} of {error.size} load sharings. Set "
        'crack_faces = "open".'
    )


def _shortened(problem: _Problem, before: Array, after: Array) -> Array:
    """Loads of minimum energy between two answers, shape (n, B)."""
    way = after - before
    low, high = np.zeros(before.shape[1]), np.ones(before.shape[1])
    low = np.where(problem.slope(after, way) <= 0.0, 1.0, low)
    for _ in range(_HALVINGS):
        middle = 0.5 * (low + high)
        falls = problem.slope(before + middle * way, way) < 0.0
        low, high = np.where(falls, middle, low), np.where(falls, high, middle)
    return np.asarray(before + low * way)
