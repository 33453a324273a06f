"""What every compliance formula returns, and the sources that a load-sharing calculation can choose from.

All of them treat one tooth on its own: there is **no coupling to the neighbouring teeth** (c_k = 0 for k != 0), which
the finite elements have, and the gear body below the foundation is rigid (Weber and Banaschek, Cornell) or an elastic
ring (Sainsot).
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Protocol

from fegear.frozen import ReadOnlyArrays

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.geometry import Gear


@dataclass(frozen=True, slots=True)
class ToothCompliance(ReadOnlyArrays):
    """Deflection of one tooth along the line of action per unit line load, without the contact; shape (N,) [m^2/N].

    Parameters
    ----------
    radius : ndarray
        Load radii [m].
    bending, shear, axial : ndarray
        The tooth as a cantilever.
    foundation : ndarray
        The body below it.
    """

    radius: Array
    bending: Array
    shear: Array
    axial: Array
    foundation: Array

    @property
    def total(self) -> Array:
        """Sum of the parts [m^2/N]."""
        return self.bending + self.shear + self.axial + self.foundation


class ComplianceFormula(Protocol):
    """Tooth compliance as a function of the load radius."""

    def __call__(self, gear: Gear, radius: ArrayLike) -> ToothCompliance:
        """Compliance of a tooth of `gear` under loads at `radius` [m]."""


class ContactFormula(Protocol):
    """Approach of one body of a loaded contact."""

    def __call__(self, gear: Gear, radius: ArrayLike, line_load: ArrayLike, half_width: ArrayLike) -> Array:
        """Contact deflection [m] of the tooth of `gear` loaded at `radius` [m] by `line_load` [N/m].

        `half_width` [m] is that of the Hertzian contact with the mating flank; formulas that know no radius of
        curvature ignore it.
        """


@dataclass(frozen=True, slots=True)
class ComplianceSource:
    """A closed form as a source of compliance for load sharing.

    Parameters
    ----------
    name : str
        As a case file writes it.
    tooth : ComplianceFormula
        Tooth and foundation, linear in the load.
    contact : ContactFormula
        Contact approach of one body, in general not linear in the load.
    citation : str
        Where it comes from.
    remark : str
        What it neglects.
    """

    name: str
    tooth: ComplianceFormula
    contact: ContactFormula
    citation: str
    remark: str = "one tooth on its own: no coupling to the neighbouring teeth"
