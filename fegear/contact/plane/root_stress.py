"""Root stress of a gear's teeth in mesh: the one place where loads on teeth add up to the stress along a fillet.

A fillet is stressed by the load on its own tooth and, through the body, by those on its neighbours. Whoever has loads,
shared at rest, of a vibrating train, of a design or of a drawn population, has `RootStress` give the rows of what a
unit load does, superpose them, and find the largest between the points of the fillet. Effects on root stress only
(`fegear.base.effects.RootEffects`) act here, and nowhere else.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.base.effects import RootEffects
from fegear.base.errors import InputError
from fegear.contact.plane.stress_rows import Rows, StressRows

if TYPE_CHECKING:
    from collections.abc import Iterable
    from types import EllipsisType

    from numpy.typing import ArrayLike, NDArray

    from fegear.base.arrays import Array
    from fegear.contact.plane.compliance import RootStressInfluence, Side
    from fegear.contact.plane.pair_compliance import PairCompliance
    from fegear.fem.plane.root_stress import CutFillet, FilletCurve
    from fegear.geometry.pair import Member


class Felt(NamedTuple):
    """The load on a tooth, and what it does along the fillet that is looked at.

    Attributes
    ----------
    line_load : ndarray, shape (...)
        [N/m].
    row : ndarray, shape (..., points)
        Stress per unit line load [1/m], broadcast to the loads.
    at : ndarray of int, or Ellipsis
        Which of the states that are looked at have the load; Ellipsis: all.
    """

    line_load: Array
    row: Array
    at: NDArray[np.intp] | EllipsisType = ...


@dataclass(frozen=True)
class RootStress:
    """One fillet of the teeth of one gear in a pair.

    Parameters
    ----------
    source : RootStressInfluence
        Where the stress under unit loads comes from.
    member : {"driver", "driven"}
        What the gear is as the pair runs.
    side : {"tension", "compression"}
        The tension fillet lies below the loaded flank.
    coupling : bool
        Whether loads on neighbouring teeth are felt.
    effects : RootEffects
    """

    source: RootStressInfluence
    member: Member
    side: Side = "tension"
    coupling: bool = True
    effects: RootEffects = field(default_factory=RootEffects)

    @classmethod
    def of(
        cls,
        compliance: PairCompliance,
        member: Member,
        side: Side = "tension",
        source: RootStressInfluence | None = None,
    ) -> RootStress:
        """That of a pair, from where its compliance comes from unless another source is given."""
        return cls(source or compliance.source(member), member, side, compliance.coupling, compliance.roots)

    @property
    def reach(self) -> int:
        """Teeth on either side whose loads are felt."""
        return self.source.reach if self.coupling else 0

    def tooth(self, pair: int) -> int:
        """Number of the gear's tooth on a pair: pair j + 1 is ahead of pair j."""
        return pair if self.member == "driver" else -pair

    def row(self, i: int, j: int, radius: ArrayLike) -> Array | None:
        """Stress along the fillet of tooth i per unit line load at radii of tooth j, (Q, points) [1/m].

        None where the source knows only deflections, or only the other fillet.
        """
        stress = self.source.root_stress(i, j, radius, self.side)
        return None if stress is None else np.ascontiguousarray(stress.T)

    def known_row(self, i: int, j: int, radius: ArrayLike) -> Array:
        """As `row`, where there must be one.

        Raises
        ------
        InputError
            If the source knows no root stress.
        """
        row = self.row(i, j, radius)
        if row is None:
            raise InputError(
                "results", '"root-stress"', "is not available with this compliance source (deflections only)",
                'set pair.root_stress.source = "fe" or a formula',
            )  # fmt: skip
        return row

    def rows(self, tooth: int, radius: Array, reach: int | None = None) -> Rows:
        """Stress along fillets per unit line load at radii of a tooth, by how far their teeth are from it, (Q, points).

        Parameters
        ----------
        tooth : int
            That is loaded.
        radius : ndarray, shape (Q,)
            [m].
        reach : int, optional
            Teeth on either side that are looked at; by default all that feel it.

        Raises
        ------
        InputError
            If the source knows no root stress.
        """
        far = self.reach if reach is None else reach

        def evaluate(at: Array) -> Rows:
            return {k: self.known_row(tooth + k, tooth, at) for k in range(-far, far + 1)}

        kept: dict[object, StressRows] | None = getattr(self.source, "stress_rows", None)
        if kept is None:
            return evaluate(radius)
        like = self.source.same_as(tooth - far, 2 * far + 1)
        return kept.setdefault((self.side, far, like, self.effects), StressRows()).at(radius, evaluate)

    def superposed(self, felt: Iterable[Felt], shape: tuple[int, ...]) -> Array:
        """Stress along a fillet under the loads of several teeth at once [Pa].

        Parameters
        ----------
        felt : iterable of Felt
        shape : tuple of int
            (..., points).
        """
        total, felt = np.zeros(shape), list(felt)
        with np.errstate(invalid="ignore"):
            for one in felt:
                total[one.at] += one.line_load[..., None] * one.row
        if np.isfinite(total).all():
            return total
        # a formula may give nothing for a load at this place, which is no matter where there is none
        total = np.zeros(shape)
        for one in felt:
            load = one.line_load[..., None]
            total[one.at] += np.where(load != 0.0, load * one.row, 0.0)
        return total

    def bound(
        self, felt: Iterable[Felt], least: Iterable[Array], most: Iterable[Array], shape: tuple[int, ...]
    ) -> Array:
        """Largest stress that each point of a fillet can have where every load may differ from what is given [Pa].

        Parameters
        ----------
        felt, shape
            See `superposed`.
        least, most : iterable of ndarray, shape (...)
            What each load may have besides [N/m].
        """
        felt = list(felt)
        total = self.superposed(felt, shape)
        for one, low, high in zip(felt, least, most, strict=True):
            total[one.at] += np.maximum(low[..., None] * one.row, high[..., None] * one.row)
        return total

    def largest(self, tooth: int, stress: Array, radius: ArrayLike = math.inf) -> Array:
        """Largest tension or most negative compression of the fillet of a tooth, shape (Q,) [Pa].

        Parameters
        ----------
        tooth : int
        stress : ndarray, shape (Q, points)
        radius : array_like, shape (Q,)
            Of the contact on the tooth itself [m]; infinite where nothing touches it.
        """
        return self.largest_and_place(tooth, stress, radius)[0]

    def largest_and_place(self, tooth: int, stress: Array, radius: ArrayLike = math.inf) -> tuple[Array, Array]:
        """As `largest`, and where along the fillet it sits, in the unit of its curve; NaN where no curve is known."""
        curve = self.curve(tooth)
        if curve is not None:
            return curve.largest(stress.T, radius)
        found = np.asarray(stress.max(axis=1) if self.side == "tension" else stress.min(axis=1))
        return found, np.full(found.shape, math.nan)

    def at_place(self, tooth: int, row: Array, place: Array) -> Array:
        """What rows of the fillet of a tooth, (Q, points), have at the places of its largest stress, (S,): (S, Q).

        Where no curve is known, the largest magnitude at any of the points.
        """
        curve = self.curve(tooth)
        if curve is None:
            return np.broadcast_to(np.abs(row).reshape(row.shape[0], -1).max(axis=1), (place.size, row.shape[0]))
        return curve.at(row.T, place)

    def curve(self, tooth: int) -> FilletCurve | CutFillet | None:
        """How the largest of a tooth is found between the points of its fillet; None if they are all there is."""
        return self.source.fillet_curve(tooth, self.side)

    def error(self, i: int, j: int, radius: ArrayLike) -> Array:
        """Estimated error of the largest stress of tooth i per unit line load on tooth j, (Q,) [1/m]; NaN: unknown."""
        return self.source.root_stress_error(i, j, radius, self.side)
