"""Finite elements of the virtual spur gear of a helical one, whose number of teeth is not whole.

The wheels with the whole numbers of teeth below and above are solved, and their root stress is interpolated in 1/z_n.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

import numpy as np

from fegear.base.solution_cache import SolutionCache
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import solve_gear
from fegear.formulas.iso6336.part3_root_stress import virtual_teeth
from fegear.geometry.gear import Gear


@dataclass(frozen=True, slots=True)
class VirtualRootStress:
    """Largest root tension of the virtual spur gear per line load normal to the flank.

    Parameters
    ----------
    teeth : tuple of int
        Whole numbers of teeth that were solved.
    tension : float
        Stress x module / line load.
    """

    teeth: tuple[int, ...]
    tension: float


def virtual_root_stress(
    gear: Gear,
    load_diameter: float,
    settings: MeshSettings,
    cache: SolutionCache | None = None,
) -> VirtualRootStress:
    """Root tension of the virtual spur gear under a load at the standard's point, from finite elements.

    Parameters
    ----------
    gear : Gear
        The helical gear; its virtual one has its rack and profile shift.
    load_diameter : float
        d_en of the virtual gear [modules]; whole gears take the load at the same height above the pitch circle.
    settings : MeshSettings
    cache : SolutionCache, optional
        Of solved teeth.
    """
    z_n = virtual_teeth(gear.teeth, gear.helix_angle, gear.normal_pressure_angle)
    m, addendum = gear.module, gear.tooth.tip_radius - gear.tooth.pitch_radius
    counts = sorted({math.floor(z_n + 1e-9), math.ceil(z_n - 1e-9)})
    found = []
    for z in counts:
        tooth = replace(gear.external_tooth, teeth=z, tip_radius=0.5 * z + addendum, helix_angle=0.0)
        radius = 0.5 * (load_diameter - z_n + z)
        wheel = Gear(tooth, m, 0.5 * tooth.root_radius * m)
        known = solve_gear(wheel, settings, reach=0, estimate_error=False, cache=cache)
        found.append(m * float(known.largest_root_stress(0, "tension", np.array([radius * m]))[0][0]))
    if len(found) == 1:
        return VirtualRootStress(tuple(counts), found[0])
    low, high = counts
    part = (1.0 / low - 1.0 / z_n) / (1.0 / low - 1.0 / high)
    return VirtualRootStress((low, high), found[0] + part * (found[1] - found[0]))
