"""Inertias, shaft stiffnesses and damping constants from dimensions and damping ratios (NASA TM-100180, 12 to 16)."""

from __future__ import annotations

import math

from fegear.dynamics.parts import require_positive
from fegear.errors import InputError


def disc_inertia(radius: float, width: float, density: float, bore_radius: float = 0.0) -> float:
    """Inertia of a solid or bored disc [kg m^2]: pi rho b (R^4 - r^4) / 2."""
    require_positive("radius", radius)
    require_positive("width", width)
    require_positive("density", density)
    require_positive("bore_radius", bore_radius, zero=True)
    if bore_radius >= radius:
        raise InputError("bore_radius", bore_radius, f"must be smaller than the radius {radius:g} m")
    return math.pi * density * width * (radius**4 - bore_radius**4) / 2.0


def shaft_stiffness(length: float, diameter: float, shear_modulus: float, bore_diameter: float = 0.0) -> float:
    """Torsional stiffness of a round shaft [N m/rad]: J G / l with J = pi D^4/32 (TM-100180, 12 and 13)."""
    require_positive("length", length)
    require_positive("diameter", diameter)
    require_positive("shear_modulus", shear_modulus)
    require_positive("bore_diameter", bore_diameter, zero=True)
    if bore_diameter >= diameter:
        raise InputError("bore_diameter", bore_diameter, f"must be smaller than the diameter {diameter:g} m")
    return math.pi * (diameter**4 - bore_diameter**4) / 32.0 * shear_modulus / length


def shaft_damping(ratio: float, stiffness: float, inertia_a: float, inertia_b: float) -> float:
    """Shaft damping from a damping ratio: 2 zeta sqrt(K / (1/J_a + 1/J_b)) (TM-100180, 14 and 15) [N m s/rad]."""
    return 2.0 * ratio * math.sqrt(stiffness / (1.0 / inertia_a + 1.0 / inertia_b))


def mesh_damping(
    ratio: float, stiffness: float, radius_a: float, radius_b: float, inertia_a: float, inertia_b: float
) -> float:
    """Mesh damping from a damping ratio (TM-100180, 16, repaired) [N s/m]."""
    mass = inertia_a * inertia_b / (radius_a**2 * inertia_b + radius_b**2 * inertia_a)
    return 2.0 * ratio * math.sqrt(stiffness * mass)
