"""A loaded gear pair: contacts, compliances, modifications and errors brought together and solved."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array, Index
from fegear.base.brief import Brief
from fegear.base.tally import note
from fegear.contact.plane.coupled_teeth import PairMatrices
from fegear.contact.plane.load_sharing import SharedLoad, pair_tangent
from fegear.contact.plane.meshing import Contacts, Meshing
from fegear.contact.plane.odd_contacts import OddContacts, on_less_face, refuse_no_contact
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.roll_grids import RollGrid, RollGrids, columns_of
from fegear.geometry.pair import GearPair
from fegear.geometry.relief import UNMODIFIED, Relief

if TYPE_CHECKING:
    from fegear.contact.odd_flank import OddFlank

#: Roll positions nearer to each other are one [base pitches]: beyond round-off, below any length that a shop measures.
_APART = 1e-12


@dataclass(frozen=True)
class Loaded:
    """Load sharing at P roll positions under L loads.

    Parameters
    ----------
    grid : RollGrid
    load : ndarray, shape (L,)
        [N].
    shared : SharedLoad
    separation : ndarray, shape (n, P)
        e_j [m]: modifications, errors and, off the path, the corner's gap.
    cycle : int
        Number of the base pitch: which teeth are on the pairs.
    """

    grid: RollGrid
    load: Array
    shared: SharedLoad
    separation: Array
    cycle: int = 0

    def under(self, number: int) -> Loaded:
        """The same under one of the loads alone."""
        one, shared = slice(number, number + 1), self.shared
        alone = SharedLoad(shared.loads[..., one], shared.transmission_error[:, one], shared.steps)
        return Loaded(self.grid, self.load[one], alone, self.separation, self.cycle)

    def at(self, which: Index) -> Loaded:
        """The same at some of the roll positions."""
        shared = self.shared
        loads, error = shared.loads[:, which], shared.transmission_error[which]
        return Loaded(
            columns_of(self.grid, which), self.load, SharedLoad(loads, error, shared.steps), self.separation[:, which],
            self.cycle,
        )  # fmt: skip

    @property
    def x(self) -> Array:
        """Roll positions, shape (P,) [m]."""
        return self.grid.x

    @property
    def pair_x(self) -> Array:
        """Position of each pair, shape (n, P) [m]."""
        return self.grid.contacts.x

    @property
    def loads(self) -> Array:
        """W_j, shape (n, P, L) [N]."""
        return self.shared.loads

    @property
    def transmission_error(self) -> Array:
        """Loaded static transmission error, shape (P, L) [m]."""
        return self.shared.transmission_error

    @property
    def deflection(self) -> Array:
        """Deflection of loaded pairs, both gears and the contact, shape (n, P, L) [m]; zero where unloaded."""
        u = self.transmission_error[None] - np.where(self.grid.contacts.present, self.separation, 0.0)[:, :, None]
        return np.where(self.loads > 0.0, u, 0.0)

    @cached_property
    def pair_tangent(self) -> Array:
        """Local stiffness dW_j/dzeta of each pair, shape (n, P, L) [N/m]; zero where it is unloaded.

        Mark's K_Sj (A.8): the sum over j' of the inverse of the pairs' tangent compliances, of those in contact. Unlike
        a share of the mesh stiffness it knows that a pair which a relief holds back gives way no less than the others.
        """
        return pair_tangent(self.grid.matrices.tangent(self.loads), self.loads > 0.0)

    @property
    def local_stiffness(self) -> Array:
        """Local mesh stiffness dW/dzeta of the pairs in contact, shape (P, L) [N/m]."""
        return np.asarray(self.pair_tangent.sum(axis=0))

    @property
    def corner_bears(self) -> Array:
        """Whether a loaded pair touches at a tip corner or so near to one that it is narrower, bool, shape (P, L)."""
        contacts, law = self.grid.contacts, self.grid.matrices.law
        at_corner = np.broadcast_to((contacts.gap > 0.0)[:, :, None], self.loads.shape)
        if law.edges is not None:
            # the Hertzian width grows with the square root of the load; see `edge_law`
            width = np.sqrt(self.loads / law.reference_load)
            at_corner = at_corner | (law.edges.tilt[:, :, None] > -width)
        return np.asarray(((self.loads > 0.0) & at_corner).any(axis=0))


@dataclass(frozen=True)
class Engagement(Brief):
    """A gear pair with its compliances, modifications and spacing errors.

    Parameters
    ----------
    compliance : PairCompliance
    driver_relief, driven_relief : Relief
        Modifications of all teeth of each gear.
    driver_spacing, driven_spacing : ndarray
        Spacing error of each tooth in the order of meshing, removal positive [m]; empty for none.
    corner_contact : bool
    driver_odd, driven_odd : mapping of int to OddFlank
        Flanks that differ from the others, by the number of the tooth in the order of meshing.
    grids : RollGrids, optional
        Of the same gears under another load or with other reliefs, so that their contacts and compliances are
        evaluated once; its own where it has none or they are of other gears.
    """

    compliance: PairCompliance
    driver_relief: Relief = UNMODIFIED
    driven_relief: Relief = UNMODIFIED
    driver_spacing: Array = field(default_factory=lambda: np.empty(0))
    driven_spacing: Array = field(default_factory=lambda: np.empty(0))
    corner_contact: bool = False
    driver_odd: Mapping[int, OddFlank] = field(default_factory=dict)
    driven_odd: Mapping[int, OddFlank] = field(default_factory=dict)
    grids: RollGrids = field(default=None, repr=False, compare=False)  # type: ignore[assignment]  # set below

    def __post_init__(self) -> None:
        """Begin anew where the grids are of other gears: a copy with another compliance has them handed down, too."""
        if self.grids is None or not self.grids.serves(self.compliance, self.corner_contact):
            object.__setattr__(self, "grids", RollGrids(self.compliance, self.corner_contact))

    @property
    def pair(self) -> GearPair:
        """The gears."""
        return self.compliance.pair

    @property
    def meshing(self) -> Meshing:
        """Finds the contacts."""
        return self.grids.meshing

    def unmodified(self) -> Engagement:
        """The same pair with perfect involutes at equal distances."""
        none, odd = np.empty(0), (self.driver_odd, self.driven_odd)
        driver, driven = ({tooth: one.as_the_others() for tooth, one in flanks.items()} for flanks in odd)
        return replace(
            self, driver_relief=UNMODIFIED, driven_relief=UNMODIFIED, driver_spacing=none, driven_spacing=none,
            driver_odd=driver, driven_odd=driven,
        )  # fmt: skip

    def reversed(self) -> Engagement:
        """The same gears with driver and driven exchanged; x changes sign."""
        return Engagement(
            self.compliance.reversed(), self.driven_relief, self.driver_relief, self.driven_spacing,
            self.driver_spacing, self.corner_contact, self.driven_odd, self.driver_odd,
        )  # fmt: skip

    def grid(self, x: ArrayLike, *, again: bool = True) -> RollGrid:
        """Evaluate contacts and compliances at roll positions, shape (P,) [m], brought into one base pitch.

        `again` says whether the same positions may be asked for again.
        """
        at = np.atleast_1d(np.array(x, dtype=float))
        return self.grids.at(at) if again else self.grids.new(at)

    def modification(self, contacts: Contacts, cycle: int | None = None) -> Array:
        """m_j of both gears together, shape (n, P) [m]; a flank without modification is not asked.

        Of a base pitch with the profiles of its teeth where these differ; by default of ordinary ones.
        """
        total = np.zeros(contacts.gap.shape)
        for relief, roll in ((self.driver_relief, contacts.roll_driver), (self.driven_relief, contacts.roll_driven)):
            if relief != UNMODIFIED:
                total = total + relief.removal(roll)
        if cycle is None or self.odd is None:
            return total
        return self.odd.modified(total, contacts, cycle, (self.driver_relief, self.driven_relief))

    def spacing(self, contacts: Contacts, cycle: int) -> Array:
        """Spacing error of each pair, shape (n, 1) [m], in the base pitch number `cycle`.

        Teeth are numbered in the order in which they come into mesh, so pair j is on teeth cycle - j.
        """
        total = np.zeros(contacts.number.size)
        for errors in (self.driver_spacing, self.driven_spacing):
            if errors.size:
                note("spacing errors")
                total += errors[np.mod(cycle - contacts.number, errors.size)]
        return total[:, None]

    @property
    def cycles(self) -> int:
        """Base pitches after which teeth that differ meet again, by their spacing errors or as they are; else 1."""
        errors = (errors.size for errors in (self.driver_spacing, self.driven_spacing) if errors.size)
        odd = (
            gear.teeth
            for gear, flanks in ((self.pair.driver, self.driver_odd), (self.pair.driven, self.driven_odd))
            if flanks
        )
        return math.lcm(self.compliance.cycles, *errors, *odd)

    def teeth_in(self, number: Index, cycle: int) -> tuple[object, ...]:
        """What tells a base pitch from others: how the teeth on these pairs answer, and where they stand."""
        spacing = tuple(
            errors[np.mod(cycle - number, errors.size)].tobytes()
            for errors in (self.driver_spacing, self.driven_spacing)
            if errors.size
        )
        flanks = () if self.odd is None else self.odd.kinds(number, cycle)
        return (*self.compliance.pattern(number, cycle), *spacing, flanks)

    @property
    def uneven(self) -> bool:
        """Whether one base pitch is not as the other: teeth have spacing errors, or differ."""
        spaced = self.driver_spacing.size or self.driven_spacing.size
        return bool(spaced or self.driver_odd or self.driven_odd) or self.compliance.cycles > 1

    def separation(self, contacts: Contacts, cycle: int = 0) -> Array:
        """e_j, shape (n, P) [m]; infinite where a pair is out of reach."""
        added = self.modification(contacts, cycle)
        if self.driver_spacing.size or self.driven_spacing.size:
            added = added + self.spacing(contacts, cycle)
        if self.odd is not None:
            added = added + self.odd.gap(contacts, cycle)
        return np.where(contacts.present, contacts.gap + added, np.inf)

    def solve(self, grid: RollGrid, load: ArrayLike, cycle: int = 0) -> Loaded:
        """Share loads, shape (L,) [N], at the positions of a grid, by the teeth of a base pitch."""
        at = self._turned(grid, cycle)
        e = self.separation(at.contacts, cycle)
        if at.contacts is not grid.contacts:
            refuse_no_contact(e)
        loads = np.atleast_1d(np.asarray(load, dtype=float))
        return Loaded(at, loads, self.grids.share(at, e, loads), e, cycle)

    @cached_property
    def odd(self) -> OddContacts | None:
        """Contacts of flanks that differ from the others; None without any."""
        if not (self.driver_odd or self.driven_odd):
            return None
        return OddContacts(self.pair, self.driver_odd, self.driven_odd, self.corner_contact)

    def _turned(self, grid: RollGrid, cycle: int) -> RollGrid:
        """The grid with the teeth of a base pitch, their flanks among them."""
        odd = self.odd
        if odd is None or not odd.on(grid.contacts.number, cycle):
            return self.grids.turned(grid, cycle)
        contacts = odd.changed(grid.contacts, cycle)
        known = self.grids.turned(grid, cycle).matrices if contacts is grid.contacts else None
        matrices = self.matrices(contacts, cycle, known)
        return RollGrid(grid.x, contacts, matrices, self.compliance.pattern(contacts.number, cycle))

    def matrices(self, contacts: Contacts, cycle: int, known: PairMatrices | None = None) -> PairMatrices:
        """Compliances at contacts in a base pitch, those on pitted flanks with less of the face.

        `known` are the same without pits, where they are at hand.
        """
        matrices = known or self.compliance.matrices(contacts, cycle)
        if self.odd is None or not self.odd.on(contacts.number, cycle):
            return matrices
        return on_less_face(matrices, self.odd.bearing_share(contacts, cycle), contacts, self.compliance)

    @property
    def breaks(self) -> tuple[float, ...]:
        """Roll positions [m] in one base pitch where pairs enter or leave or a modification has a kink.

        Those that coincide but for round-off, across the seam of the pitch too, are one.
        """
        pair = self.pair
        places = [
            pair.x_start,
            pair.x_end,
            *(float(pair.x_of_roll(roll, "driver")) for roll in self.driver_relief.kinks),
            *(float(pair.x_of_roll(roll, "driven")) for roll in self.driven_relief.kinks),
            *(float(pair.x_of_radius(radius, "driver")) for radius in self.compliance.driver.kinks),
            *(float(pair.x_of_radius(radius, "driven")) for radius in self.compliance.driven.kinks),
            *(self.odd.places if self.odd is not None else ()),
        ]
        apart = _APART * pair.base_pitch
        inside = [x for x in places if pair.x_start - apart <= x <= pair.x_end + apart]
        found: list[float] = []
        for x in sorted(float(x) for x in self.meshing.reduced(inside)):
            if not found or found[-1] + apart < x < pair.x_start + pair.base_pitch - apart:
                found.append(x)
        return tuple(found)


def solve_again(other: Engagement, loaded: Loaded) -> Loaded:
    """Solve with another engagement's compliances at the same contacts, loads and separations."""
    grid = loaded.grid
    matrices = other.matrices(grid.contacts, loaded.cycle)
    shared = matrices.share(loaded.separation, loaded.load)
    again = RollGrid(grid.x, grid.contacts, matrices, grid.teeth)
    return Loaded(again, loaded.load, shared, loaded.separation, loaded.cycle)
