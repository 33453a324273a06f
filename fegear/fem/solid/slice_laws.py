"""How the shapes of a flank spread along the face: laws whose constants are fitted to solid gears.

With k the wave number along the face, a dent of compliance c in the section answers as a half-space does, by
c / sqrt(1 + (k c / 2 (1 - nu^2))^2), which needs no constant. The bending of the tooth on its body answers by
c / (1 + alpha k^2 + beta k^4), a plate's bending and shear: with natural ends, as polynomials have them. The ends of
the face add what mirror images lack; the helix turns the force out of the section, stiffens nothing and bends the body.
The constants were found by tests/golden/make_slices.py from solid gears whose list and residuals stand there.
"""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType

import numpy as np

from fegear.base.arrays import Array
from fegear.fem.solid.bands import function_cosines
from fegear.fem.solid.face import FaceFunctions

#: Cosines along the face: for each function, and at least.
_PER_FUNCTION, _FEWEST = 6, 80
#: Points of the quadrature of the ends' decay.
_POINTS = 80


@dataclass(frozen=True)
class SliceLaws:
    """Constants of the laws; lengths in modules, angles by tan(beta_b), depth from the root circle to the bore.

    Parameters
    ----------
    dent : float
        Compliance of the dent that the first shape holds beside bending [1/E].
    shear, shear_by_depth, deepest, bending : float
        alpha of the first shape: its first part, what a module of depth adds, the depth beyond which it adds nothing
        more; and beta.
    lean : (float, float, float)
        Powers of 1 / cos(beta_b) with which the first, second and further shapes soften.
    end : (float, float, float)
        What an end adds to the compliance of each kind of shape [1/E].
    end_reach : (float, float, float)
        How far it reaches from there [modules]; of the further shapes times their compliance.
    acute : (float, float, float)
        Logarithm by which it grows at the acute end per tan(beta_b), and falls at the obtuse.
    wider : (float, float)
        By how much the second and further shapes spread more than a half-space's.
    body_shear, body_bending : (float, float)
        alpha and beta of the next tooth: factor and power of the depth.
    tilt, own_tilt : float
        How much the axial force bends the body, times depth and tan(beta_b)^2: on the next tooth and on the own.
    root : (float, float, float, float)
        Of the stress of the fillets: alpha of loads at the flank's foot and what a module up the flank adds, beta, and
        a power of 1 / cos(beta_b).
    """

    dent: float
    shear: float
    shear_by_depth: float
    deepest: float
    bending: float
    lean: tuple[float, float, float]
    end: tuple[float, float, float]
    end_reach: tuple[float, float, float]
    acute: tuple[float, float, float]
    wider: tuple[float, float]
    body_shear: tuple[float, float]
    body_bending: tuple[float, float]
    tilt: float
    own_tilt: float
    root: tuple[float, float, float, float]


#: Fitted by tests/golden/make_slices.py.
LAWS = SliceLaws(
    dent=2.318, shear=0.8128, shear_by_depth=0.358, deepest=20.35, bending=1.459, lean=(2.059, 1.747, 0.5685),
    end=(0.7998, 1.281, 1.151), end_reach=(0.9239, 0.2883, 0.3308), acute=(5.336, 4.266, 4.446), wider=(1.396, 1.271),
    body_shear=(6.428, 0.5403), body_bending=(57.72, 0.8035), tilt=0.5996, own_tilt=0.7862,
    root=(1.672, 0.692, 0.6617, 1.685),
)  # fmt: skip
#: The largest relative misses on that script's gears, spur and helical (8 to 30 degrees), ends of the face included.
#: Spur gears in the corners of the flank, 7 % of its length from its ends: contact 7 %, next tooth 6 %.
_MISSED: Mapping[bool, Mapping[str, float]] = MappingProxyType({
    False: MappingProxyType({"contact": 0.08, "neighbour": 0.08, "root_tension": 0.28, "root_compression": 0.06}),
    True: MappingProxyType({"contact": 0.21, "neighbour": 0.29, "root_tension": 0.35, "root_compression": 0.31}),
})  # fmt: skip


def missed_by_slices(tau: float) -> Mapping[str, float]:
    """Largest relative misses of slices, by what is missed; `tau` is the gear's twist."""
    return _MISSED[tau != 0.0]


class Spread:
    """The laws on one face: matrices of functions along it, which give displacements for loads.

    Parameters
    ----------
    face : FaceFunctions
    poisson_ratio : float
    lean : float
        tan(beta_b), positive for a right hand.
    depth : float
        From the root circle to the bore [modules].
    laws : SliceLaws
    """

    def __init__(self, face: FaceFunctions, poisson_ratio: float, lean: float, depth: float, laws: SliceLaws) -> None:
        count = max(_FEWEST, _PER_FUNCTION * face.count)
        self._waves = function_cosines(face, count)[0] * math.sqrt(2.0 / face.width)
        self._k = np.pi * np.arange(1, count + 1) / face.width
        self._mass, _, self._slope = face.products
        self._curvature = _curvature(face)
        self._face, self._modulus = face, 2.0 * (1.0 - poisson_ratio**2)
        self._lean, self._depth, self._laws = lean, depth, laws

    def own(self, values: Array, next_tooth: float) -> Array:
        """Compliances of the loaded tooth's shapes, the first of which is bending, shape (m, functions, functions).

        Parameters
        ----------
        values : ndarray, shape (m,)
            Plane compliances of the shapes [1/E].
        next_tooth : float
            What the first shape's load does to it on the next tooth [1/E].
        """
        laws, longer = self._laws, math.hypot(1.0, self._lean)
        found = np.empty((values.size, *self._mass.shape))
        alpha = laws.shear + laws.shear_by_depth * min(self._depth, laws.deepest)
        dent = min(laws.dent, 0.5 * float(values[0]))
        for m, value in enumerate(values.tolist()):
            kind = min(m, 2)
            if m == 0:
                spread = (value - dent) * self._plate(alpha, laws.bending) + self._dent(dent, 1.0)
            else:
                spread = self._dent(value, laws.wider[kind - 1])
            reach = laws.end_reach[kind] * (value if kind == 2 else 1.0)
            ends = sum(laws.end[kind] * math.exp(laws.acute[kind] * lean) * np.outer(a, a)
                       for a, lean in zip(self._decay(reach), (self._lean, -self._lean), strict=True))  # fmt: skip
            found[m] = longer ** laws.lean[kind] * spread + ends
        found[0] += laws.own_tilt * self._depth * self._lean**2 * next_tooth * self._body()
        return found

    def beside(self) -> Array:
        """What multiplies the plane compliance of the next tooth, shape (functions, functions)."""
        return np.asarray((1.0 + self._laws.tilt * self._depth * self._lean**2) * self._body())

    def root(self, arc: Array) -> Array:
        """What multiplies the plane stress of the loaded tooth's fillets, shape (n, functions, functions).

        Parameters
        ----------
        arc : ndarray, shape (n,)
            How far up the flank the loads stand [modules].
        """
        first, higher, beta, power = self._laws.root
        longer = math.hypot(1.0, self._lean) ** power
        return np.stack([longer * self._plate(first + higher * s, beta) for s in arc.tolist()])

    def _body(self) -> Array:
        (a, p), (b, q) = self._laws.body_shear, self._laws.body_bending
        return self._plate(a * self._depth**p, b * self._depth**q)

    def _plate(self, alpha: float, beta: float) -> Array:
        return _inverse(self._mass + alpha * self._slope + beta * self._curvature)

    def _dent(self, value: float, wider: float) -> Array:
        more = np.sqrt(1.0 + (self._k * value * wider / self._modulus) ** 2) - 1.0
        return value * _inverse(self._mass + (self._waves * more) @ self._waves.T)

    def _decay(self, reach: float) -> tuple[Array, Array]:
        """The functions' shares in what falls off from each end."""
        half = 0.5 * self._face.width
        x, w = np.polynomial.legendre.leggauss(_POINTS)
        # Points crowd at the end: a decay may be far shorter than the face is wide.
        away, weight = 2.0 * half * (0.5 + 0.5 * x) ** 3, 3.0 * half * (0.5 + 0.5 * x) ** 2 * w
        found = [
            np.linalg.solve(self._mass, self._face.values(side * (half - away)) @ (weight * np.exp(-away / reach)))
            for side in (-1.0, 1.0)
        ]
        return np.asarray(found[0], dtype=float), np.asarray(found[1], dtype=float)


def _inverse(stiffness: Array) -> Array:
    found = np.linalg.inv(stiffness)
    return np.asarray(0.5 * (found + found.T))


def _curvature(face: FaceFunctions) -> Array:
    """Integrals of P_k'' P_l'' on a face of one piece, shape (functions, functions)."""
    half = 0.5 * face.width
    x, w = np.polynomial.legendre.leggauss(face.count + 2)
    slopes = face.at(half * x)[1]
    series = np.polynomial.legendre.legfit(x, slopes.T, face.count - 2)
    bent = np.polynomial.legendre.legval(x, np.polynomial.legendre.legder(series)) / half
    return np.asarray((bent * (w * half)) @ bent.T)
