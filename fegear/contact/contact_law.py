"""How a contact's approach grows with its load, apart from the compliances of the teeth: the one law of all solvers.

The Hertzian half-width b of a line contact grows with the root of its load W, and both bodies approach by
-kappa W ln b: over a compliance that holds at the load W_ref, a contact approaches by

    -(kappa / 2) W (ln(W / W_ref) - 2 psi) + q W^0.9,

psi what a tip corner makes narrower (`edge_law`), q of Palmgren's contact. Secant and tangent of the logarithm are
written once, in `logarithm`, for single forces (plane teeth) as for line loads along a contact line (wide ones).
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.plane.edge_law import EdgeContacts
from fegear.formulas.palmgren import EXPONENT

if TYPE_CHECKING:
    from collections.abc import Callable

    from numpy.typing import NDArray

    from fegear.base.arrays import Array

    Index = NDArray[np.intp] | NDArray[np.int64]

#: Share of the reference load below which the logarithm is continued by its tangent: W ln W has an infinite slope at
#: zero. Its effect on any share is below its own size.
SMALLEST_SHARE = 1e-20


def logarithm(share: Array, tangent: float, edge: tuple[Array, Array] | None = None) -> Array:
    """Secant or tangent of W (ln(W / W_ref) - 2 psi), of which a contact approaches by minus kappa / 2.

    Parameters
    ----------
    share : ndarray
        W / W_ref, or the square of the half-widths' ratio.
    tangent : float
        1 for the derivative over W, 0 for the secant.
    edge : (ndarray, ndarray), optional
        psi and -2 W dpsi/dW of `edge_law`; without it no corner is near.
    """
    grown = np.log(share) + tangent
    return np.asarray(grown if edge is None else grown - 2.0 * edge[0] + tangent * edge[1])


def _acts(coefficient: Array | float) -> bool:
    """Whether a coefficient is other than zero for any contact; asked at every step, of arrays without a detour."""
    return bool(coefficient.any()) if isinstance(coefficient, np.ndarray) else coefficient != 0.0


@dataclass(frozen=True, slots=True)
class ContactLaw:
    """What n contacts at P positions approach by beyond compliances that hold at the reference load.

    Parameters
    ----------
    log_slope : float or ndarray, shape (n, P)
        kappa, change of both bodies' approach per unit load with ln(1 / half-width) [m/N]; 0 for a linear contact.
    reference_load : float or ndarray, shape (n, P)
        W_ref [N].
    edges : EdgeContacts or None
        Contacts near tip corners at the reference load, shape (n, P); None when corners do not matter.
    power : float or ndarray, shape (n, P)
        q of a contact deflection q W^0.9 [m/N^0.9] (Palmgren).
    """

    log_slope: Array | float = 0.0
    reference_load: Array | float = 1.0
    edges: EdgeContacts | None = None
    power: Array | float = 0.0

    @property
    def is_linear(self) -> bool:
        """Whether no compliance depends on its load."""
        return not (_acts(self.log_slope) or _acts(self.power))

    def each(self, change: Callable[[Array], Array]) -> ContactLaw:
        """The same with every array changed alike; what is one number for all contacts stays."""
        slope, reference, power = (
            change(np.asarray(values)) if np.ndim(values) else values
            for values in (self.log_slope, self.reference_load, self.power)
        )
        edges = self.edges and EdgeContacts(change(self.edges.tilt), change(self.edges.wedge), change(self.edges.room))
        return replace(self, log_slope=slope, reference_load=reference, edges=edges, power=power)

    def at(self, positions: Index) -> ContactLaw:
        """That of some of the positions."""
        return self.each(lambda values: values[..., positions])

    def in_shares(self, total: Array) -> tuple[Array, ContactLaw]:
        """What the compliances are less at the whole load [m/N], and the law of shares W_j / W, with an axis of loads.

        In shares every load is the same problem: only the compliances and the separations change with it.

        Parameters
        ----------
        total : ndarray, shape (P, L)
            W [N].
        """
        law = self.each(lambda values: values[..., None])
        less = 0.5 * law.log_slope * np.log(total / law.reference_load)
        edges = law.edges and law.edges.under(np.sqrt(law.reference_load / total))
        return less, replace(law, reference_load=1.0, edges=edges, power=law.power * total ** (EXPONENT - 1.0))

    def secant(self, compliance: Array, loads: Array) -> Array:
        """Approach over load of contacts whose own compliance at the reference load is given [m/N].

        Parameters
        ----------
        compliance, loads : ndarray
            Of one shape with the law [m/N], [N].
        """
        w, share = self._shares(loads)
        if _acts(self.log_slope):
            compliance = compliance - 0.5 * self.log_slope * logarithm(share, 0.0, self._edge(share))
        if _acts(self.power):
            compliance = compliance + self.power * w ** (EXPONENT - 1.0)
        return compliance

    def tangent(self, compliance: Array, loads: Array) -> Array:
        """Derivative of the approach over the load [m/N]; see `secant`."""
        return self.linearised(compliance, loads, np.zeros(1))[0]

    def linearised(self, compliance: Array, loads: Array, gap: Array) -> tuple[Array, Array]:
        """Straight line that touches the approach at given loads: slope [m/N], and height at no load [m].

        The logarithm's part is concave: Newton's method on these lines stays below and converges monotonically.

        Parameters
        ----------
        compliance, loads : ndarray
            See `secant`.
        gap : ndarray
            Distance of the unloaded contacts, which the height counts [m].
        """
        w, share = self._shares(loads)
        slope, height = compliance, gap
        if _acts(self.log_slope):
            half, edge = 0.5 * self.log_slope, self._edge(share)
            slope = slope - half * logarithm(share, 1.0, edge)
            height = height + half * w
            if edge is not None:
                height = height + half * w * edge[1]
        if _acts(self.power):
            approach = self.power * w**EXPONENT
            slope = slope + EXPONENT * approach / w
            height = height + (1.0 - EXPONENT) * approach
        return slope, height

    def rise(self, loads: Array, tilt: Array, room: Array) -> Array:
        """Growth of the approach as tilt and room of contacts near corners grow, the loads staying [m]."""
        if self.edges is None:
            return np.zeros_like(loads)
        _, share = self._shares(loads)
        return np.asarray(self.log_slope * self.edges.rise(np.sqrt(share), tilt, room) * loads)

    def _shares(self, loads: Array) -> tuple[Array, Array]:
        """Loads, none of them zero, and the same over the reference load."""
        w = np.maximum(loads, SMALLEST_SHARE * self.reference_load)
        return w, np.asarray(w / self.reference_load)

    def _edge(self, share: Array) -> tuple[Array, Array] | None:
        return None if self.edges is None else self.edges.law(np.sqrt(share))


#: Of contacts whose approach is proportional to their load.
LINEAR = ContactLaw()
