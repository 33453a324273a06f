"""A stepped, hollow or conical shaft as a Timoshenko beam, by its compliance: exact for prisms and cones.

With the left end clamped, a force p = (F, M) at z_j moves the place z_i by

    u_i = int_0^min(z_i, z_j)  B(z_i - s)^T C(s) B(z_j - s) ds  p_j,

B(l) carrying a force to a section l before it, C(s) = diag(1/kappa G A (twice), 1/E A, 1/E I (twice), 1/G J). The
integrals are taken by Gauss's rule between all places and steps, which is exact for prisms and converges geometrically
for cones. No stiffness of short pieces is ever formed, so places may be as close to one another as they like.

Bodies of gears that sit fast on the shaft hold its sections there by S = B B^T. With A the compliance of the shaft
alone, and s their seats, that of both is A - A_s B (I + B^T A_ss B)^-1 B^T A_s^T: symmetric, rigid shafts stay rigid.

Sources: S. P. Timoshenko, On the correction for shear of the differential equation for transverse vibrations of
prismatic bars, Philosophical Magazine 41 (1921); shear coefficient kappa of hollow circles: G. R. Cowper, The shear
coefficient in Timoshenko's beam theory, Journal of Applied Mechanics 33 (1966), 335-340.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError, RangeError
from fegear.shafts.carried import carry
from fegear.shafts.section import Section

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.shafts.gear_on_shaft import GearOnShaft

#: Gauss points between two places in a prism, whose integrands are of the second degree.
_PRISM = 2
#: Gauss points in a piece of a cone (`Section.pieces`): they leave 1e-13 (1e-9 is asked for).
_CONE = 12
#: Gauss's points and weights by their number.
_GAUSS = {count: np.polynomial.legendre.leggauss(count) for count in (_PRISM, _CONE)}


@dataclass(frozen=True)
class Shaft:
    """A straight shaft of consecutive sections, from its left end on.

    Parameters
    ----------
    sections : tuple of Section
    young_modulus : float
        [Pa]; infinite for a rigid shaft.
    poisson_ratio : float
    gears : tuple of GearOnShaft
        Bodies that sit fast on it.

    Raises
    ------
    InputError
        If it has no section, or its material is none.
    """

    sections: tuple[Section, ...]
    young_modulus: float = 206e9
    poisson_ratio: float = 0.3
    gears: tuple[GearOnShaft, ...] = ()

    def __post_init__(self) -> None:
        """Refuse shafts without sections and impossible materials."""
        if not self.sections:
            raise InputError("sections", "(none)", "specify no shaft", 'specify { length = "50 mm", outer = "30 mm" }')
        if not self.young_modulus > 0.0:
            raise RangeError("young_modulus", self.young_modulus, "must be positive")
        if not 0.0 <= self.poisson_ratio < 0.5:
            raise RangeError("poisson_ratio", self.poisson_ratio, "must be at least 0 and below 0.5")

    @cached_property
    def steps(self) -> Array:
        """Where sections begin and end, shape (sections + 1,) [m]."""
        return np.concatenate([[0.0], np.cumsum([one.length for one in self.sections])])

    @property
    def length(self) -> float:
        """Of all sections together [m]."""
        return float(self.steps[-1])

    def place(self, z: float, key: str) -> float:
        """A place on the shaft, to round-off.

        Raises
        ------
        RangeError
            If it is off the shaft.
        """
        length, slack = self.length, 1e-9 * self.length
        if not -slack <= z <= length + slack:
            raise RangeError(
                key, f"{z * 1e3:.6g} mm", f"is outside the shaft, 0 to {length * 1e3:.6g} mm",
                "correct its position, or the length of a section",
            )  # fmt: skip
        return min(max(z, 0.0), length)

    def diameters(self, z: ArrayLike, of: ArrayLike | None = None) -> tuple[Array, Array]:
        """Outer and inner diameter at places [m].

        Parameters
        ----------
        z : array_like
            From the left end [m].
        of : array_like, optional
            As many places that say which of two sections that meet there counts; that to the right without them.
        """
        at = np.asarray(z, dtype=float)
        inside = at if of is None else np.asarray(of, dtype=float)
        which = np.clip(np.searchsorted(self.steps, inside, side="right") - 1, 0, len(self.sections) - 1)
        ends = np.array([one.ends for one in self.sections])[which]
        share = (at - self.steps[which]) / np.diff(self.steps)[which]
        found = ends[..., 0] + (ends[..., 1] - ends[..., 0]) * share[..., None]
        return found[..., 0], found[..., 1]

    def section_compliance(self, z: ArrayLike) -> Array:
        """C at places inside sections, shape (..., 6) [1/N, 1/(N m^2)]."""
        d, h = self.diameters(z)
        e, nu = self.young_modulus, self.poisson_ratio
        area, bending = 0.25 * math.pi * (d - h) * (d + h), math.pi / 64.0 * (d**4 - h**4)
        m = (h / d) ** 2
        shear = 6.0 * (1.0 + nu) * (1.0 + m) ** 2 / ((7.0 + 6.0 * nu) * (1.0 + m) ** 2 + (20.0 + 12.0 * nu) * m)
        across, along = 2.0 * (1.0 + nu) / (shear * e * area), 1.0 / (e * area)
        bend, twist = 1.0 / (e * bending), (1.0 + nu) / (e * bending)
        return np.stack([across, across, along, bend, bend, twist], axis=-1)

    def quadrature(self, places: ArrayLike) -> tuple[Array, Array]:
        """Gauss points and weights between all places and steps [m], shapes (G,)."""
        cuts = [self.steps, np.atleast_1d(np.asarray(places, dtype=float))]
        for one, start in zip(self.sections, self.steps, strict=False):
            cuts.append(start + one.length * np.arange(1, one.pieces) / max(one.pieces, 1))
        ends = np.unique(np.clip(np.concatenate(cuts), 0.0, self.length))
        # The middle of two places a last digit apart is one of them: it may be the shaft's end.
        which = np.searchsorted(self.steps[1:-1], 0.5 * (ends[1:] + ends[:-1]), side="right")
        conical = np.array([one.pieces > 0 for one in self.sections])[which]
        points, weights = [], []
        for count, chosen in ((_PRISM, ~conical), (_CONE, conical)):
            x, w = _GAUSS[count]
            start, half = ends[:-1][chosen], 0.5 * np.diff(ends)[chosen]
            points.append((start[:, None] + half[:, None] * (1.0 + x)).ravel())
            weights.append((half[:, None] * w).ravel())
        return np.concatenate(points), np.concatenate(weights)

    def strains(self, loads_at: Array, loads: Array, s: Array) -> Array:
        """Strains and curvatures at sections from forces and moments to the right of them, shape (G, 6)."""
        arm = np.maximum(loads_at[None, :] - s[:, None], 0.0)
        beyond = (arm > 0.0).astype(float)
        resultant = beyond @ loads
        resultant[:, 3] -= arm @ loads[:, 1]
        resultant[:, 4] += arm @ loads[:, 0]
        return np.asarray(self.section_compliance(s) * resultant)

    def bent(self, places: ArrayLike, loads_at: Array, loads: Array) -> Array:
        """Displacements and turns with the left end clamped, shape (n, 6) [m, rad].

        Parameters
        ----------
        places : array_like, shape (n,)
            Where they are wanted [m].
        loads_at : ndarray, shape (m,)
            Where forces act [m].
        loads : ndarray, shape (m, 6)
            F_x, F_y, F_z, M_x, M_y, M_z [N, N m].
        """
        z = np.atleast_1d(np.asarray(places, dtype=float))
        if not self.gears:
            return self._alone(z, loads_at, loads)
        seats, root, held = self._stiffened
        found = self._alone(np.concatenate([z, seats]), loads_at, loads)
        forces = root @ np.linalg.solve(held, np.einsum("sam,sa->m", root, found[z.size :]))
        return found[: z.size] - self._alone(z, seats, forces)

    def _alone(self, z: Array, loads_at: Array, loads: Array) -> Array:
        """What the shaft without its gears answers, see `bent`."""
        s, weight = self.quadrature(np.concatenate([z, loads_at]))
        strain = self.strains(loads_at, loads, s) * weight[:, None]
        arm = np.maximum(z[:, None] - s[None, :], 0.0)
        found = (arm > 0.0).astype(float) @ strain
        found[:, 0] += arm @ strain[:, 4]
        found[:, 1] -= arm @ strain[:, 3]
        return found

    @cached_property
    def _stiffened(self) -> tuple[Array, Array, Array]:
        """Seats of the gears, shape (s,), B of all their stiffness (s, 6, m), and I + B^T A_ss B."""
        places = np.concatenate([one.places for one in self.gears])
        roots = [one.root(self.length) for one in self.gears]
        widths = np.cumsum([0, *(one.shape[2] for one in roots)])
        root = np.zeros((places.size, 6, widths[-1]))
        first = 0
        for one, start in zip(roots, widths, strict=False):
            root[first : first + len(one), :, start : start + one.shape[2]] = one
            first += len(one)
        seats = np.clip(places, 0.0, self.length)
        flat = root.reshape(-1, widths[-1])
        held = self._alone_compliance(seats).reshape(len(flat), -1)
        return seats, root, np.eye(widths[-1]) + flat.T @ held @ flat

    def _alone_compliance(self, z: Array) -> Array:
        """That of the shaft without its gears, see `compliance`."""
        s, weight = self.quadrature(z)
        carried = carry(z[:, None] - s[None, :]) * (z[:, None] > s[None, :])[:, :, None, None]
        return np.einsum("igka,gk,jgkb->iajb", carried, self.section_compliance(s) * weight[:, None], carried,
                         optimize=True)  # fmt: skip

    def compliance(self, places: ArrayLike) -> Array:
        """Compliance between places with the left end clamped, shape (n, 6, n, 6) [m/N, 1/N, 1/(N m)]."""
        z = np.atleast_1d(np.asarray(places, dtype=float))
        if not self.gears:
            return self._alone_compliance(z)
        seats, root, held = self._stiffened
        both = self._alone_compliance(np.concatenate([z, seats]))
        at = np.tensordot(both[: z.size, :, z.size :], root, 2).reshape(6 * z.size, -1)
        return both[: z.size, :, : z.size] - (at @ np.linalg.solve(held, at.T)).reshape(z.size, 6, z.size, 6)
