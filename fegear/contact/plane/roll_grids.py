"""What load sharing needs of a pair at roll positions: neither a load nor a relief changes it, so the last is kept."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field, fields, replace
from functools import cached_property
from operator import attrgetter
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array, Mask
from fegear.contact.contact_law import ContactLaw
from fegear.contact.plane.coupled_teeth import PairMatrices
from fegear.contact.plane.edge_law import EdgeContacts
from fegear.contact.plane.load_sharing import SharedLoad
from fegear.contact.plane.meshing import Contacts, Meshing
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.geometry.pair import GearPair

#: So many grids are kept for each pair: those of its history, its table, its quadrature, its stiffness, for two loads.
_KEPT = 8
#: So many of them are kept with other teeth of gears whose teeth differ.
_PATTERNS = 64
#: So many of the states under load that were found last on each of them: with the flanks as they are, and perfect.
_STATES = 2
#: Of longer ones none: they serve one question of a design.
_LONGEST = 4000
#: A grid that shares this part of its positions with one that is kept takes their columns from it.
_SHARED = 0.3


@dataclass(frozen=True)
class RollGrid:
    """All that load sharing needs at P roll positions, evaluated once.

    Parameters
    ----------
    x : ndarray, shape (P,)
        Roll positions [m].
    contacts : Contacts
    matrices : PairMatrices
    teeth : tuple of int
        Which teeth of driver and driven gear they are of; see `PairCompliance.pattern`.
    others : dict
        The same positions with teeth that differ from these, by these; empty where all teeth are alike.
    """

    x: Array
    contacts: Contacts
    matrices: PairMatrices
    teeth: tuple[int, int] = (0, 0)
    others: dict[tuple[int, int], RollGrid] = field(default_factory=dict, repr=False, compare=False)


_PLACES = tuple(one.name for one in fields(Contacts) if one.name != "number")


class _Kept(NamedTuple):
    """A grid, its positions in ascending order, and where each of them stands in it."""

    grid: RollGrid
    ascending: Array
    column: NDArray[np.intp]


class _Shared(NamedTuple):
    """Loads that were shared before."""

    grid: RollGrid
    separation: Array
    load: Array
    found: SharedLoad


def _same(one: object, other: object) -> bool:
    """Whether two fields are the same: gears, texts and numbers by what they are, solutions by being one object."""
    return one is other or (isinstance(one, (GearPair, str, float)) and one == other)


class RollGrids:
    """Contacts and compliances of one pair, of which the grids asked for last are kept.

    Parameters
    ----------
    compliance : PairCompliance
    corner_contact : bool
    """

    def __init__(self, compliance: PairCompliance, corner_contact: bool) -> None:
        self._compliance, self._corner_contact = compliance, corner_contact
        self._kept: tuple[_Kept, ...] = ()
        self._shared: tuple[_Shared, ...] = ()

    def __reduce__(self) -> tuple[type[RollGrids], tuple[PairCompliance, bool]]:
        """Travel to other processes without what is kept."""
        return RollGrids, (self._compliance, self._corner_contact)

    def serves(self, compliance: PairCompliance, corner_contact: bool) -> bool:
        """Whether another pair's grids are these: only its load may be another."""
        own, of_load = self._compliance, frozenset({"nominal_load"} if compliance.hertz != "linear" else ())
        return corner_contact == self._corner_contact and (
            own is compliance
            or all(
                _same(getattr(own, one.name), getattr(compliance, one.name))
                for one in fields(compliance)
                if one.name not in of_load
            )
        )

    @cached_property
    def meshing(self) -> Meshing:
        """Finds the contacts."""
        return Meshing(self._compliance.pair, self._corner_contact)

    def at(self, x: Array) -> RollGrid:
        """The grid at roll positions, shape (P,) [m], each brought into one base pitch; kept for the next time."""
        for number, kept in enumerate(self._kept):
            if np.array_equal(kept.grid.x, x):
                self._kept = (*self._kept[:number], *self._kept[number + 1 :], kept)
                return kept.grid
        grid = _read_only(self._with_known(x))
        if x.size <= _LONGEST:
            order = np.argsort(x, kind="stable")
            # in one step, so that who is interrupted leaves nothing half
            self._kept = (*self._kept[-_KEPT + 1 :], _Kept(grid, x[order], order))
        return grid

    def new(self, x: Array) -> RollGrid:
        """The same at positions that will not be asked for again."""
        pair = self._compliance.pair
        start, pitch = pair.x_start, pair.base_pitch
        outside = (x < start) | (x > start + pitch)
        contacts = self.meshing.contacts(np.where(outside, self.meshing.reduced(x), x))
        teeth = self._compliance.pattern(contacts.number, 0)
        return RollGrid(x, contacts, self._compliance.matrices(contacts), teeth)

    def turned(self, grid: RollGrid, cycle: int) -> RollGrid:
        """The grid with the teeth of a base pitch: itself where they answer alike."""
        teeth = self._compliance.pattern(grid.contacts.number, cycle)
        if teeth == grid.teeth:
            return grid
        if teeth not in grid.others:
            while len(grid.others) >= _PATTERNS:
                del grid.others[next(iter(grid.others))]
            matrices = self._compliance.matrices(grid.contacts, cycle)
            grid.others[teeth] = _read_only(RollGrid(grid.x, grid.contacts, matrices, teeth))
        return grid.others[teeth]

    def share(self, grid: RollGrid, separation: Array, load: Array) -> SharedLoad:
        """Share loads, shape (L,) [N], at the positions of a grid; kept for the next time."""
        for number, one in enumerate(self._shared):
            if one.grid is grid and np.array_equal(one.load, load) and np.array_equal(one.separation, separation):
                self._shared = (*self._shared[:number], *self._shared[number + 1 :], one)
                return one.found
        found = grid.matrices.share(separation, load)
        kept = {id(grid) for one in self._kept for grid in (one.grid, *one.grid.others.values())}
        others = [one for one in self._shared if one.grid is not grid and id(one.grid) in kept]
        own = [one for one in self._shared if one.grid is grid]
        self._shared = (*others, *own[-_STATES + 1 :], _Shared(grid, separation, load, found))
        return found

    def _with_known(self, x: Array) -> RollGrid:
        """Columns of a kept grid where it has the same positions, new ones elsewhere."""
        best, known, column = None, np.zeros(x.size, dtype=bool), np.zeros(x.size, dtype=np.intp)
        for kept in reversed(self._kept):
            place = np.minimum(np.searchsorted(kept.ascending, x), kept.ascending.size - 1)
            same = kept.ascending[place] == x
            if same.sum() > max(known.sum(), _SHARED * x.size):
                best, known, column = kept.grid, same, kept.column[place]
        if best is None:
            return self.new(x)
        if known.all():
            return _joined(x, best, column, None, known)
        return _joined(x, best, column, self.new(x[~known]), known)


def columns_of(grid: RollGrid, which: NDArray[np.intp]) -> RollGrid:
    """A grid at some of its positions."""
    return _joined(grid.x[which], grid, which, None, np.ones(which.size, dtype=bool))


def _joined(x: Array, old: RollGrid, column: NDArray[np.intp], new: RollGrid | None, known: Mask) -> RollGrid:
    """Columns of two grids, those of the old one where they are known."""

    def columns(of: Callable[[RollGrid], Any]) -> Any:
        found = of(old)[..., column]
        if new is not None:
            found[..., ~known] = of(new)
        return found

    places = {name: columns(attrgetter(f"contacts.{name}")) for name in _PLACES}
    none = old.matrices.law.edges is None and (new is None or new.matrices.law.edges is None)
    law = replace(
        old.matrices.law,
        log_slope=columns(lambda grid: grid.matrices.law.log_slope),
        edges=None if none else EdgeContacts(*columns(lambda grid: _edges(grid.matrices.law))),
    )
    faces = old.matrices.faces  # those of the same teeth
    if faces is not None:
        faces = replace(faces, opening=columns(attrgetter("matrices.faces.opening")))
    matrices = PairMatrices(columns(lambda grid: grid.matrices.compliance), law, faces)
    return RollGrid(x, replace(old.contacts, **places), matrices, old.teeth)


def _edges(law: ContactLaw) -> Array:
    """Tilt, wedge and room, shape (3, n, P); none at all is the same as far inside of every corner."""
    found = law.edges or EdgeContacts.none(np.shape(law.log_slope))
    return np.stack([found.tilt, found.wedge, found.room])


def _read_only(grid: RollGrid) -> RollGrid:
    parts = (grid.contacts, grid.matrices, grid.matrices.law, grid.matrices.law.edges)
    for part in parts:
        for one in fields(part) if part is not None else ():
            value = getattr(part, one.name)
            if isinstance(value, np.ndarray):
                value.setflags(write=False)
    return grid
