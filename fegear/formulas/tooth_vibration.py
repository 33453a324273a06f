"""The lowest natural frequency of a tooth: a cantilever of varying depth that shears, turns and sits on its foundation.

Flexibilities are those of `beam` and `cornell_compliance` for loads across the tooth, at every pair of sections; the
mass of each section moves and turns (S. P. Timoshenko, Phil. Mag. 41 (1921) 744-746). Nothing else is discretised:
1/omega^2 is the largest eigenvalue of flexibility times mass. The gear body below the foundation stands still.
"""

from __future__ import annotations

import math

import numpy as np

from fegear.base.arrays import Array
from fegear.formulas import beam
from fegear.formulas.cornell import FOUNDATION_TANGENT, foundation_compliance
from fegear.formulas.root_section import fillet_parameter, load_line, tangent_range
from fegear.geometry.gear import Gear

#: Gauss nodes on fillet and involute; 48 leave 2e-5 of the frequency.
_NODES = 48


def lowest_frequency(
    height: Array,
    depth: Array,
    weight: Array,
    modulus: float,
    shear_modulus: float,
    density: float,
    foundation: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> float:
    """Lowest natural frequency [Hz] of a beam of unit width and varying depth that is built in at height zero.

    Parameters
    ----------
    height, depth, weight : ndarray, shape (n,)
        Sections in rising order, their depth, and quadrature weights [m].
    modulus, shear_modulus : float
        Of bending and of shear, whose section counts with 5/6 [Pa].
    density : float
        [kg/m^3].
    foundation : tuple of float
        Turning per moment [1/N], turning per force or moving per moment [m/N], moving per force [m^2/N]; unit width.
    """
    y, turning, coupling, moving = height, *foundation
    inertia, area = depth**3 / 12.0, depth

    def up_to(what: Array) -> Array:
        """Integral from the foot to the lower of every two places; a section's own weight counts half."""
        total = np.cumsum(weight * what) - 0.5 * weight * what
        return np.minimum(total[:, None], total[None, :])

    bend = 1.0 / (modulus * inertia)
    zeroth, first, second = up_to(bend), up_to(y * bend), up_to(y * y * bend)
    here, there = y[:, None], y[None, :]
    move = here * there * (zeroth + turning) - (here + there) * (first - coupling) + second + moving
    move += up_to(1.2 / (shear_modulus * area))
    turn = there * (zeroth + turning) - first + coupling  # at one place, per force at the other
    flexibility = np.block([[move, turn.T], [turn, zeroth + turning]])
    root = np.sqrt(density * np.concatenate([weight * area, weight * inertia]))
    largest = float(np.linalg.eigvalsh(root[:, None] * flexibility * root)[-1])
    return 1.0 / (2.0 * math.pi * math.sqrt(largest))


def tooth_frequency(gear: Gear, nodes: int = _NODES) -> float:
    """Lowest natural frequency of a tooth of `gear` [Hz]; its face width does not matter.

    Built in where Cornell's foundation begins, the gear's plane assumption deciding between his wide and narrow tooth.
    """
    tooth, material, plane, nu = gear.external_tooth, gear.material, gear.plane_assumption, gear.material.poisson_ratio
    root = fillet_parameter(tooth, min(FOUNDATION_TANGENT, tangent_range(tooth)[1]))
    half, foot = (float(v) for v in tooth.trochoid.points(root))
    cut = beam.sections(tooth, load_line(tooth, np.array([tooth.involute_tip_radius])), root, nodes)
    order = np.argsort(cut.height[0])
    height, depth, weight = (
        v * gear.module for v in (cut.height[0, order] - foot, 2.0 * cut.half_thickness[0, order], cut.weight[0, order])
    )
    # Cornell's foundation is a quadratic in the slenderness k of the arm: turning, both, moving.
    moving, once, twice = (
        float(foundation_compliance(k, 0.0, material.poisson_ratio, plane)) for k in (0.0, 1.0, -1.0)
    )
    turning, coupling = 0.5 * (once + twice) - moving, 0.25 * (once - twice)
    h, e = 2.0 * half * gear.module, material.young_modulus
    return lowest_frequency(
        height, depth, weight, gear.plane_modulus, 0.5 * gear.plane_modulus / (1.0 + nu),
        material.density, (turning / (e * h * h), coupling / (e * h), moving / e),
    )  # fmt: skip
