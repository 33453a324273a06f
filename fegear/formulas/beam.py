"""A tooth as a beam of varying depth: the integrals that every cantilever formula is made of.

Heights y run along the tooth's centre line from the gear's centre, half thicknesses x(y) follow the exact outline
(involute and trochoid) without a table or a polygon. Each smooth piece of the outline is integrated in a parameter
in which it is analytic, by Gauss-Legendre quadrature: the error falls geometrically with the nodes.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache
from typing import TYPE_CHECKING

import numpy as np

from fegear.geometry.involute import roll_of_polar_angle

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.formulas.root_section import LoadLine
    from fegear.geometry.curves import Curve
    from fegear.geometry.external_tooth import Tooth

#: Nodes per smooth piece; 32 leave 1e-12 of every integral even under sharp fillets (tests hold it to that).
NODES = 32
#: Logarithm of rho (see `_nodes_for_waist`) from which on they do.
_LOG_RHO = 0.45
#: At most so many times as many nodes, and how many points of the fillet are looked at for its waist.
_MOST_TIMES, _LOOKED_AT = 32, 65


@dataclass(frozen=True, slots=True)
class Sections:
    """Quadrature sections below each load, shape (N, M): N loads, M sections.

    Parameters
    ----------
    height : ndarray
        y of the sections [modules].
    half_thickness : ndarray
        x of the sections [modules].
    weight : ndarray
        Quadrature weights dy [modules].
    """

    height: Array
    half_thickness: Array
    weight: Array


@dataclass(frozen=True, slots=True)
class BeamIntegrals:
    """Integrals over the sections between the root section and the load, shape (N,), of the tooth of module 1.

    With u = arm height - y and the section's depth 2 x per unit width: area A = 2 x, moment of inertia I = (2 x)^3/12.

    Parameters
    ----------
    bending_2, bending_1, bending_0 : ndarray
        Integrals of u^2 / I, u / I and 1 / I dy.
    area : ndarray
        Integral of 1 / A dy.
    """

    bending_2: Array
    bending_1: Array
    bending_0: Array
    area: Array


@lru_cache(maxsize=8)
def _gauss(nodes: int) -> tuple[Array, Array]:
    x, w = np.polynomial.legendre.leggauss(nodes)
    return x, w


def _cut(curve: Curve, u: Array, du: Array) -> Sections:
    """Sections at parameters u of a curve with weights du, shape (N, nodes)."""
    x, y = curve.points(u)
    # travelling from the tooth space to the tip the outward normal is the tangent turned clockwise: dy/ds = n_x
    return Sections(y, x, du * curve.speed(u) * curve.normals(u)[0])


def _nodes_for_waist(tooth: Tooth, root_parameter: float, nodes: int) -> int:
    """So many nodes, or more where undercut leaves a waist so thin that 1/x^3 has its pole near the fillet.

    n Gauss nodes leave about rho^(-2 n), where the pole lies on the ellipse of half axes' sum rho about the interval:
    i d off it below a waist inside, delta beyond it where the tooth is thinnest at an end.
    """
    u = np.linspace(root_parameter, tooth.fillet.end, _LOOKED_AT)
    x, step, half = tooth.fillet.points(u)[0], abs(u[1] - u[0]), 0.5 * abs(u[-1] - u[0])
    i = int(np.argmin(x))
    if 0 < i < _LOOKED_AT - 1:
        curvature = (x[i - 1] - 2.0 * x[i] + x[i + 1]) / step**2
        log_rho = np.arcsinh(np.sqrt(2.0 * x[i] / max(curvature, 1e-300)) / half)
    else:
        slope = abs(x[i] - x[i - 1 if i else 1]) / step
        log_rho = np.arccosh(1.0 + x[i] / max(slope, 1e-300) / half)
    return nodes * min(max(math.ceil(_LOG_RHO / log_rho), 1), _MOST_TIMES)


def _fillet(tooth: Tooth, root_parameter: float, nodes: int) -> Sections:
    """Sections from the fillet's point `root_parameter` up to the involute, shape (1, `nodes` or more)."""
    g, w = _gauss(_nodes_for_waist(tooth, root_parameter, nodes))
    half = 0.5 * abs(root_parameter - tooth.fillet.end)
    mid = 0.5 * (root_parameter + tooth.fillet.end)
    return _cut(tooth.fillet, (mid + half * g)[None], (half * w)[None])


def involute_sections(tooth: Tooth, load: LoadLine, start: float, nodes: int = NODES) -> Sections:
    """Sections of the involute from the roll angle `start` [rad] up to each load, shape (N, nodes).

    1/x^3 has a pole where the flanks would meet, at the roll angle t_p, which a slender tip comes near. With
    t = t_p - (t_p - t_0) exp(-lambda s) the pole is moved to infinity and Gauss quadrature in s keeps its accuracy.
    """
    g, w = _gauss(nodes)
    pole = float(roll_of_polar_angle(tooth.base_half_angle))
    stretch = np.log((pole - start) / (pole - np.maximum(load.roll, start)))[:, None]
    gap = (pole - start) * np.exp(-0.5 * stretch * (1.0 + g))
    return _cut(tooth.involute, pole - gap, 0.5 * w * stretch * gap)


def sections(tooth: Tooth, load: LoadLine, root_parameter: float, nodes: int = NODES) -> Sections:
    """Sections from the fillet's point `root_parameter` up to each load.

    Parameters
    ----------
    tooth : Tooth
    load : LoadLine
        N loads on the involute.
    root_parameter : float
        Parameter of `Tooth.fillet` at which the beam is built in [rad].
    nodes : int
        Gauss nodes on the fillet (more below a thin waist), and as many on the involute.
    """
    low, high = _fillet(tooth, root_parameter, nodes), involute_sections(tooth, load, tooth.involute.start, nodes)
    shape = (load.roll.size, low.height.shape[1])
    return Sections(
        *(
            np.concatenate([np.broadcast_to(getattr(low, name), shape), getattr(high, name)], axis=1)
            for name in ("height", "half_thickness", "weight")
        )
    )


def integrals(cut: Sections, arm_height: Array) -> BeamIntegrals:
    """Integrate over the sections with arms measured from `arm_height`, shape (N,) [modules]."""
    u = arm_height[:, None] - cut.height
    inertia = cut.weight * 12.0 / (2.0 * cut.half_thickness) ** 3
    return BeamIntegrals(
        np.sum(u * u * inertia, axis=1),
        np.sum(u * inertia, axis=1),
        np.sum(inertia, axis=1),
        np.sum(cut.weight / (2.0 * cut.half_thickness), axis=1),
    )


def root_circle_chord(tooth: Tooth) -> tuple[float, float]:
    """Half thickness and height [modules] of the section where the fillet meets the root circle."""
    x, y = tooth.fillet.points(tooth.fillet.start)
    return float(x), float(y)


def root_half_angle(tooth: Tooth) -> float:
    """Half the tooth's angle on the root circle, theta_f [rad]: pi/z less half the root land."""
    return math.pi / tooth.teeth - tooth.root_land_half_angle
