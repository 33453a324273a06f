"""Compliances measured or computed elsewhere and given as a table over the path of contact."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass
from typing import Literal

import numpy as np
from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.contact.plane.compliance import GearCompliance, OneTooth, Rigid
from fegear.geometry.pair import MEMBERS, GearPair, Member

Fit = Literal["linear", "cubic"]
Of = Literal["tooth", "pair"]

#: Part of the path of contact that a table may leave out at either end; its fit is continued there, and a note says so.
_LEFT_OUT = 0.15
#: Parts of the path that are too little to be said.
_NOTHING = 1e-3
#: Compliance of a tooth or of a pair of teeth per unit face width, times Young's modulus. Teeth have some 3 to 30; the
#: limits let thin rims and stiff models pass, not a prefix of a unit.
_TEETH = (0.05, 1000.0)
#: Places of the path at which a fit is looked at.
_LOOKED_AT = 201


@dataclass(frozen=True)
class CompliancePolynomial:
    """A least-squares polynomial in x / scale, or a linear interpolation when there are `knots`.

    Parameters
    ----------
    coefficients : ndarray
        Highest power first [m/N]; or the values at the knots.
    scale : float
        [m].
    knots : ndarray
        Positions [m] of a linear table; empty for a polynomial.
    """

    coefficients: Array
    scale: float
    knots: Array

    def __call__(self, x: ArrayLike) -> Array:
        """Compliance [m/N] at x [m]; a linear table continues its end pieces."""
        at = np.asarray(x, dtype=float)
        if self.knots.size == 0:
            return np.asarray(np.polyval(self.coefficients, at / self.scale))
        i = np.clip(np.searchsorted(self.knots, at) - 1, 0, self.knots.size - 2)
        step = self.knots[i + 1] - self.knots[i]
        return np.asarray(
            self.coefficients[i] + (self.coefficients[i + 1] - self.coefficients[i]) * (at - self.knots[i]) / step
        )


def fit_compliance(x: ArrayLike, compliance: ArrayLike, fit: Fit = "cubic") -> CompliancePolynomial:
    """Represent a table of compliance over position.

    Parameters
    ----------
    x : array_like, shape (N,)
        Positions on the line of action [m], positive toward the gear's own tip.
    compliance : array_like, shape (N,)
        Deflection per load [m/N], positive.
    fit : {"linear", "cubic"}
        Interpolate between the entries, or pass one unweighted least-squares cubic through all.

    Returns
    -------
    CompliancePolynomial

    Raises
    ------
    InputError
        If the table is too short, not finite, has equal positions or negative compliances.
    """
    at, c = np.asarray(x, dtype=float), np.asarray(compliance, dtype=float)
    least = 2 if fit == "linear" else 4
    if fit not in ("linear", "cubic"):
        raise InputError("compliance.fit", f'"{fit}"', 'must be "linear" or "cubic"')
    if at.ndim != 1 or at.shape != c.shape or at.size < least:
        raise InputError(
            "compliance.file", f"{at.size} entries", f"must have at least {least} positions, one compliance each"
        )
    if not (np.isfinite(at).all() and np.isfinite(c).all() and (c > 0.0).all()):
        raise InputError("compliance.file", "an entry", "must be a finite position with a positive compliance")
    order = np.argsort(at)
    at, c = at[order], c[order]
    if (np.diff(at) <= 0.0).any():
        raise InputError("compliance.file", f"{at[:-1][np.diff(at) <= 0][0]:.6g} m", "occurs twice as a position")
    scale = float(np.abs(at).max())
    if fit == "linear":
        return CompliancePolynomial(c, scale, at)
    return CompliancePolynomial(np.polyfit(at / scale, c, 3), scale, np.empty(0))


@dataclass(frozen=True)
class TableCompliance(OneTooth):
    """Compliance of one gear's tooth as a function of the position on its own flank.

    Parameters
    ----------
    table : callable
        Compliance [m/N] of the whole face over x [m], positive toward this gear's tip (or as `sign` says).
    base_radius : float
        [m].
    pitch_roll_length : float
        Roll length (radius of curvature) of the flank at the pitch point [m], negative on an internal gear.
    face_width : float
        [m]; the table holds for it.
    sign : float
        +1, or -1 for a table whose x runs toward the other gear's tip.
    knots : tuple of float
        Positions x [m] at which the table has kinks.
    """

    table: Callable[[ArrayLike], Array]
    base_radius: float
    pitch_roll_length: float
    face_width: float
    sign: float = 1.0
    knots: tuple[float, ...] = ()

    reach = 0
    log_slope = 0.0
    power = 0.0

    @property
    def kinks(self) -> tuple[float, ...]:
        """Radii of the knots [m]."""
        lengths = (self.pitch_roll_length + self.sign * x for x in self.knots)
        return tuple(math.hypot(self.base_radius, rho) for rho in lengths if rho * self.pitch_roll_length > 0.0)

    def own(self, i: int, radius: ArrayLike) -> Array:  # noqa: ARG002  (all alike)
        """Compliance per unit face width [m^2/N], contact included."""
        r = np.asarray(radius, dtype=float)
        rho = np.sqrt(np.maximum((r - self.base_radius) * (r + self.base_radius), 0.0))
        rho = np.copysign(rho, self.pitch_roll_length)
        return self.table(self.sign * (rho - self.pitch_roll_length)) * self.face_width

    def reference_half_width(self, radius: ArrayLike) -> Array:
        """One: the table's contact compliance is fixed."""
        return np.ones(np.shape(radius))

    def describe(self) -> str:
        """Return what the table includes."""
        return "compliance from a table, including load-independent contact deformation, no neighbour coupling"


def _needed(pair: GearPair, of: Of) -> tuple[float, float]:
    """Positions between which a table is read on the path of contact [m]."""
    ends = np.array([pair.x_start, pair.x_end])
    if of == "pair":
        return pair.x_start, pair.x_end
    own = [pair.flank_curvature_radius(ends, m) - pair.flank_curvature_radius(0.0, m) for m in MEMBERS]
    return float(np.min(own)), float(np.max(own))


def _left_out(pair: GearPair, x: ArrayLike, of: Of) -> float:
    """Largest part of the path, at either end, that a table does not cover."""
    (low, high), at = _needed(pair, of), np.asarray(x, dtype=float)
    return max(float(at.min()) - low, high - float(at.max()), 0.0) / pair.path_length


def _ends(at: ArrayLike) -> str:
    return f"{float(np.min(at)) * 1e3:.6g} to {float(np.max(at)) * 1e3:.6g} mm"


def refuse_table(pair: GearPair, x: ArrayLike, compliance: ArrayLike, of: Of = "tooth", fit: Fit = "cubic") -> None:
    """Refuse a table that is none of this pair's teeth; parameters as of `table_sources`.

    Raises
    ------
    InputError
        If it does not cover the path of contact, its compliances are in another unit, or its fit is not positive on
        the path or leaves the range of its entries far behind.
    """
    table = fit_compliance(x, compliance, fit)
    at, c = np.asarray(x, dtype=float), np.asarray(compliance, dtype=float)
    needed = _needed(pair, of)
    if (part := _left_out(pair, at, of)) > _LEFT_OUT:
        raise InputError(
            "compliance.file", f"x from {_ends(at)}",
            f"must cover the path of contact, {_ends(needed)}, except at most 15 % at each end; {100.0 * part:.3g} % "
            "is missing",
            "specify the entire path; check the unit of the positions (measured from the pitch point)",
        )  # fmt: skip
    soft = sum(1.0 / pair.gear(member).material.young_modulus for member in MEMBERS)
    relative = c * pair.face_width / soft
    if not (_TEETH[0] <= relative.min() and relative.max() <= _TEETH[1]):
        worst = c[int(np.argmax(np.abs(np.log(relative / math.sqrt(_TEETH[0] * _TEETH[1])))))]
        low, high = (limit * soft / pair.face_width * 1e6 for limit in _TEETH)
        raise InputError(
            "compliance.file", f"compliance {worst * 1e6:.6g} um/N",
            f"is outside {low:.3g} to {high:.3g} um/N, the plausible range for this material and face width",
            "check the unit in the head of the column",
        )  # fmt: skip
    fitted = table(np.linspace(*needed, _LOOKED_AT))
    if fitted.min() < 0.2 * c.min() or fitted.max() > 5.0 * c.max():
        raise InputError(
            "compliance.fit", f'"{fit}"',
            f"gives {fitted.min() * 1e6:.4g} to {fitted.max() * 1e6:.4g} um/N on the path of contact; the table has "
            f"{c.min() * 1e6:.4g} to {c.max() * 1e6:.4g} um/N",
            'set fit = "linear" or specify more positions' if fit == "cubic" else
                "specify positions up to the path's ends",
        )  # fmt: skip


def table_note(pair: GearPair, x: ArrayLike, of: Of = "tooth") -> str:
    """Sentence about the ends of the path that a table leaves out; empty where it covers them."""
    if _left_out(pair, x, of) <= _NOTHING:
        return ""
    return (
        f"The compliance table covers {_ends(x)}, the path of contact is {_ends(_needed(pair, of))}; extrapolated to "
        "its ends."
    )


def table_sources(
    pair: GearPair,
    x: ArrayLike,
    compliance: ArrayLike,
    of: Of = "tooth",
    fit: Fit = "cubic",
) -> tuple[GearCompliance, GearCompliance]:
    """Turn a table into the sources of driver and driven.

    Parameters
    ----------
    pair : GearPair
    x : array_like, shape (N,)
        Positions [m] from the pitch point, positive toward the tip of the tooth (``of="tooth"``) or of the driver.
    compliance : array_like, shape (N,)
        [m/N] for the pair's face width.
    of : {"tooth", "pair"}
        A tooth of either gear, so that the pair has C(x) = c(x) + c(-x) (equal gears); or the pair as a whole.
    fit : {"linear", "cubic"}
    """
    if of not in ("tooth", "pair"):
        raise InputError("compliance.of", f'"{of}"', 'must be "tooth" or "pair"')
    refuse_table(pair, x, compliance, of, fit)
    table = fit_compliance(x, compliance, fit)
    face = pair.face_width
    knots = tuple(float(k) for k in table.knots)

    def source(member: Member) -> TableCompliance:
        at_pitch = float(pair.flank_curvature_radius(0.0, member))
        return TableCompliance(table, pair.gear(member).base_radius, at_pitch, face, 1.0, knots)

    return (source("driver"), source("driven")) if of == "tooth" else (source("driver"), Rigid())
