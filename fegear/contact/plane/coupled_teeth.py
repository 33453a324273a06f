"""What loads on the teeth of two bodies in mesh do to each other: compliances of the tooth pairs in contact.

Whatever the two are, gears or a pinion and a rack, a source answers for each by its teeth's numbers and by a place on
the flank (a radius, or a height on a rack); here they are added.
"""

from __future__ import annotations

import math
from abc import ABC, abstractmethod
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.base.tally import tallied
from fegear.contact.contact_law import LINEAR, ContactLaw
from fegear.contact.plane.closing_faces import ClosingFaces, closing_faces, faces_of, share_with_faces
from fegear.contact.plane.edge_law import EdgeContacts
from fegear.contact.plane.load_sharing import SharedLoad, share_load
from fegear.fem.alike_teeth import together
from fegear.formulas.palmgren import EXPONENT
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import ArrayLike, NDArray

    from fegear.base.arrays import Array
    from fegear.contact.plane.compliance import GearCompliance
    from fegear.contact.plane.meshing import Contacts
    from fegear.geometry.pair import Member

Hertz = Literal["load-dependent", "linear", "none"]

#: Line load at which the diagonal of a load-dependent compliance is stated [N/m]; any would do.
_REFERENCE_LINE_LOAD = 1e5


@dataclass(frozen=True, slots=True)
class PairMatrices:
    """Compliances of n pairs at P roll positions, for the whole face, ready for `share_load`.

    Parameters
    ----------
    compliance : ndarray, shape (n, n, P)
        c_jj' [m/N], the diagonal at the reference load; zero in rows of pairs that are absent.
    law : ContactLaw
        What the loads change of the diagonal.
    faces : ClosingFaces, optional
        Crack faces that close as the loads want; the compliances are those of free ones.
    """

    compliance: Array
    law: ContactLaw = LINEAR
    faces: ClosingFaces | None = None

    def at_load(self, loads: Array) -> Array:
        """Secant compliances at loads of shape (n, P, L), shape (n, n, P, L) [m/N]."""
        return self._with_diagonal(loads, ContactLaw.secant)

    def tangent(self, loads: Array) -> Array:
        """Derivatives d u_j / d W_j' at loads of shape (n, P, L), shape (n, n, P, L) [m/N]."""
        return self._with_diagonal(loads, ContactLaw.tangent)

    def share(self, separation: ArrayLike, load: ArrayLike) -> SharedLoad:
        """Loads of the pairs at separations [m] under loads [N]; see `share_load`."""
        if self.faces is not None:
            return share_with_faces(self.compliance, self.faces, separation, load, self.law)
        return share_load(self.compliance, separation, load, self.law)

    def _with_diagonal(self, loads: Array, of: Callable[[ContactLaw, Array, Array], Array]) -> Array:
        each = np.arange(loads.shape[0])
        c = np.broadcast_to(self.compliance[..., None], (each.size, *loads.shape)).copy()
        c[each, each] = of(self.law.each(lambda values: values[..., None]), c[each, each], loads)
        return c if self.faces is None else c - self.faces.stiffening_under(loads)


class CoupledTeeth(ABC):
    """Compliance of tooth pairs from the sources of the two bodies that are in mesh."""

    driver: GearCompliance
    driven: GearCompliance
    #: Whether a loaded tooth deflects its neighbours.
    coupling: bool
    hertz: Hertz
    #: Load for the linear contact [N].
    nominal_load: float

    @property
    @abstractmethod
    def face_width(self) -> float:
        """Common face width [m]."""

    @property
    @abstractmethod
    def contact_modulus(self) -> float:
        """E* [Pa] of the two bodies: Hertzian line contact."""

    @property
    @abstractmethod
    def middle_of_path(self) -> float:
        """Before it the driven tip is the nearer one [m]."""

    @property
    def both(self) -> tuple[GearCompliance, GearCompliance]:
        """Of driver and driven."""
        return self.driver, self.driven

    def contact_slope(self, member: Member) -> float:
        """kappa of a gear's part in a contact that follows its load [m^2/N]."""
        return self.source(member).log_slope

    @property
    def log_slope(self) -> float:
        """kappa of both gears for the whole face [m/N]."""
        return (self.contact_slope("driver") + self.contact_slope("driven")) / self.face_width

    def power(self, member: Member) -> float:
        """q of a gear's part in a contact that approaches by q w^0.9 more under a line load w [m (m/N)^0.9]."""
        return self.source(member).power

    @property
    def cycles(self) -> int:
        """Base pitches after which the same teeth meet again, as far as they differ: 1 where all are alike."""
        return math.lcm(self.driver.period, self.driven.period)

    def tooth(self, member: Member, number: int, cycle: int) -> int:
        """Number of a gear's tooth on a pair in a base pitch; see `fegear.fem.alike_teeth`.

        Parameters
        ----------
        member : {"driver", "driven"}
        number : int
            Of the pair: pair j + 1 is ahead of pair j.
        cycle : int
            Number of the base pitch: pair j is on the teeth of pair j - 1 in the base pitch before.
        """
        return number - cycle if member == "driver" else cycle - number

    def pattern(self, number: NDArray[np.int64], cycle: int) -> tuple[int, int]:
        """Which teeth of driver and driven gear are on successive pairs: the same where they answer alike."""
        first, last = int(number[0]), int(number[-1])
        return (
            self.driver.same_as(self.tooth("driver", first, cycle), number.size),
            self.driven.same_as(self.tooth("driven", last, cycle), number.size),
        )

    def source(self, member: Member) -> GearCompliance:
        """Driver's or driven's."""
        return self.driver if member == "driver" else self.driven

    @tallied("Hertz widths")
    def half_width(self, load: Array, relative_radius: Array) -> Array:
        """Hertzian half-width b = sqrt(4 w R / (pi E*)) [m] under loads [N]."""
        w = np.asarray(load) / self.face_width
        return np.asarray(np.sqrt(4.0 * w * relative_radius / (math.pi * self.contact_modulus)))

    def pressure(self, load: Array, relative_radius: Array) -> Array:
        """Largest Hertzian pressure sqrt(w E* / (pi R)) [Pa]."""
        w = np.asarray(load) / self.face_width
        return np.asarray(np.sqrt(w * self.contact_modulus / (math.pi * relative_radius)))

    def matrices(self, at: Contacts, cycle: int = 0) -> PairMatrices:
        """Compliances of all pairs at all roll positions, with the teeth of a base pitch."""
        n, positions = at.x.shape
        face, present = self.face_width, at.present
        c = np.zeros((n, n, positions))
        slope = np.zeros((n, positions))
        reference, follows = _REFERENCE_LINE_LOAD * face, self.hertz == "load-dependent"
        for j in range(n):
            here = present[j]
            if not here.any():
                c[j, j] = 1.0
                continue
            relative = at.relative_radius[j, here]
            parts = [
                part
                for member, radius in zip(MEMBERS, (at.radius_driver, at.radius_driven), strict=True)
                for part in self.own_parts(
                    member,
                    self.tooth(member, int(at.number[j]), cycle),
                    radius[j, here],
                    relative,
                    self.contact_load,
                    power=not follows,
                )
            ]
            own = np.asarray(sum(parts))
            c[j, j, here] = own / face
            c[j, j, ~here] = 1.0
            if follows:
                slope[j, here] = self.log_slope
        on_pairs = [[self.tooth(member, int(j), cycle) for j in at.number] for member in MEMBERS]
        faces = closing_faces(self.both, on_pairs, at, face) if self.coupling else None
        if faces is not None:
            self._free(c, at, cycle)
        if self.coupling and max(self.driver.reach, self.driven.reach) > 0:
            self._couple(c, at, cycle)
        edges = None
        if follows and at.edge.max() > -np.inf and self.log_slope > 0.0:
            edges = self._edges(at, self.half_width(np.asarray(reference), at.relative_radius))
        q = self.power("driver") + self.power("driven") if follows else 0.0
        return PairMatrices(c, ContactLaw(slope, reference, edges, q * face**-EXPONENT), faces)

    def _free(self, c: Array, at: Contacts, cycle: int) -> None:
        """Give back what crack faces take away of the diagonal by closing under the load of their pair alone."""
        for member, radius in zip(MEMBERS, (at.radius_driver, at.radius_driven), strict=True):
            source = faces_of(self.source(member))
            for j, here in enumerate(at.present if source is not None else ()):
                if source is not None and here.any():
                    i = self.tooth(member, int(at.number[j]), cycle)
                    c[j, j, here] -= source.by_closing(i, radius[j, here]) / self.face_width

    @property
    def contact_load(self) -> float:
        """Load at which the diagonal of `matrices` holds, and all of a contact that does not follow its load [N]."""
        return self.nominal_load if self.hertz == "linear" else _REFERENCE_LINE_LOAD * self.face_width

    def own_parts(
        self, member: Member, i: int, radius: Array, relative_radius: Array, load: ArrayLike, *, power: bool = True
    ) -> tuple[Array, ...]:
        """What a tooth's own compliance per line load adds up from, its contact that of a load [m^2/N].

        Parameters
        ----------
        member : {"driver", "driven"}
        i : int
            Number of the tooth.
        radius, relative_radius : ndarray, shape (P,)
            Of points of the flank, and of curvature there [m].
        load : array_like, shape () or (P,)
            [N].
        power : bool
            Whether Palmgren's contact counts.
        """
        source, q = self.source(member), self.power(member)
        parts = [source.own(i, radius)]
        if power and q > 0.0:
            parts.append(np.asarray(q * (np.asarray(load) / self.face_width) ** (EXPONENT - 1.0)))
        kappa = self.contact_slope(member)
        if self.hertz != "none" and kappa > 0.0:
            b = self.half_width(np.asarray(load), relative_radius)
            parts.append(kappa * np.log(source.reference_half_width(radius) / b))
        return tuple(parts)

    def _edges(self, at: Contacts, half_width: Array) -> EdgeContacts:
        """Contacts near the tips: that of the driven gear touches at the start of the path, the driver's at its end."""
        early = at.x < self.middle_of_path
        (soft1, least1), (soft2, least2) = (
            (softer * self.contact_slope(member) / self.log_slope / self.face_width, least)
            for member in MEMBERS
            for softer, least in (self.source(member).tip_wedge,)
        )
        wedge, least = np.where(early, soft2, soft1), np.where(early, least2, least1)
        return EdgeContacts(at.edge / half_width, wedge, least / half_width)

    @tallied("neighbours")
    def _couple(self, c: Array, at: Contacts, cycle: int) -> None:
        """Add what a load on pair j' does to pair j < j', and its transpose (Maxwell)."""
        for k in range(1, at.number.size):
            for rows in self._alike(at.number, k, cycle):
                both = at.present[rows] & at.present[rows + k]
                if not both.any():
                    continue
                first = int(at.number[rows[0]])
                driver, driven = (
                    self.source(member).between(
                        self.tooth(member, first, cycle), self.tooth(member, first + k, cycle),
                        radius[rows][both], radius[rows + k][both],
                    )
                    for member, radius in zip(MEMBERS, (at.radius_driver, at.radius_driven), strict=True)
                )  # fmt: skip
                value = driver + driven
                j, p = np.nonzero(both)
                c[rows[j], rows[j] + k, p] = c[rows[j] + k, rows[j], p] = value / self.face_width

    def _alike(self, number: NDArray[np.int64], k: int, cycle: int) -> list[NDArray[np.intp]]:
        """Rows j of pairs such that pairs j and j + k are on like teeth: all of them at once where all teeth are."""
        return together(self.pattern(number[j : j + k + 1], cycle) for j in range(number.size - k))
