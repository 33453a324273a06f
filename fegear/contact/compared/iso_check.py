"""ISO 6336's nominal root stress of a pair's gears compared with finite elements of the same (virtual) spur tooth.

Finite elements of the virtual spur gear of a helical one, whose number of teeth is not whole.

The wheels with the whole numbers of teeth below and above are solved, and their root stress is interpolated in 1/z_n.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np

from fegear.base.solution_cache import SolutionCache
from fegear.fem.plane.gear import GearInfluence
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import solve_gear
from fegear.formulas.iso6336 import part3_pair as rating
from fegear.formulas.iso6336.part1_stiffness import Stiffness, pair_stiffness
from fegear.formulas.iso6336.part3_root_stress import virtual_teeth
from fegear.formulas.outcome import Outcome, attempt
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair, Member


@dataclass(frozen=True, slots=True)
class HelicalCheck:
    """A helical pair as ISO 6336 rates it.

    Parameters
    ----------
    pair : GearPair
    overlap_ratio : float
        epsilon_beta of the faces as they stand.
    line_load : float
        F_t / b [N/m].
    """

    pair: GearPair
    overlap_ratio: float
    line_load: float


@dataclass(frozen=True, slots=True)
class RatedGear:
    """One gear: its rating or the reason why there is none, and the finite elements' largest root tension.

    Parameters
    ----------
    rating : Outcome of RootRating
    form_stress : float
        F_t/(b m_n) Y_F Y_S [Pa], what a spur tooth alone carries; NaN without a rating.
    fe : float
        Largest root tension of the (virtual) spur tooth under the same load at the same place [Pa]; NaN without one.
    reason : str
        Why a number is missing; empty where none is.
    """

    rating: Outcome[rating.RootRating]
    form_stress: float
    fe: float
    reason: str


@dataclass(frozen=True, slots=True)
class RatedPair:
    """Driver and driven; the stiffness of helical pairs, whose spur twins have theirs in the pair's own comparison."""

    gears: tuple[RatedGear, RatedGear]
    stiffness: Outcome[Stiffness] | None = None


def _nothing(answer: Outcome[rating.RootRating]) -> RatedGear:
    return RatedGear(answer, math.nan, math.nan, answer.reason)


def rated_spur_pair(
    pair: GearPair,
    influences: tuple[GearInfluence, GearInfluence],
    line_load: float,
    choice: rating.RatingChoice,
    rims: Sequence[float | None],
) -> RatedPair:
    """Both gears of a spur pair.

    Parameters
    ----------
    pair : GearPair
    influences : (GearInfluence, GearInfluence)
        Driver and driven.
    line_load : float
        Normal to the flank [N/m].
    choice : RatingChoice
    rims : sequence of float or None
        Rim thickness [m]; None for a solid gear.
    """
    members: tuple[Member, Member] = ("driver", "driven")
    found = []
    for member, known, rim in zip(members, influences, rims, strict=True):
        gear = pair.gear(member)
        answer = attempt(partial(rating.rate_spur, pair, member, line_load, choice, rim))
        if answer.value is None:
            found.append(_nothing(answer))
            continue
        one = answer.value
        form = line_load * math.cos(gear.normal_pressure_angle) / gear.module * one.form.Y_F * one.form.Y_S
        at = np.array([0.5 * one.load_diameter * gear.module])
        tension = float(known.largest_root_stress(0, "tension", at)[0][0])
        found.append(RatedGear(answer, form, line_load * tension, ""))
    return RatedPair((found[0], found[1]))


def rated_helical_pair(
    check: HelicalCheck,
    choice: rating.RatingChoice,
    rims: Sequence[float | None],
    settings: MeshSettings,
    cache: SolutionCache | None = None,
) -> RatedPair:
    """Both gears of a helical pair through their virtual spur teeth.

    Parameters
    ----------
    check : HelicalCheck
    choice : RatingChoice
    rims : sequence of float or None
        Rim thickness [m]; None for a solid gear.
    settings : MeshSettings
    cache : SolutionCache, optional
    """
    found = []
    for gear, rim in zip((check.pair.driver, check.pair.driven), rims, strict=True):

        def rate(gear: Gear = gear, rim: float | None = rim) -> tuple[rating.RootRating, float]:
            load = rating.ToothLoad(
                check.line_load, rating.virtual_contact_ratio(gear, check.pair.contact_ratio), check.overlap_ratio,
                gear.helix_angle,
            )  # fmt: skip
            one = rating.rate_helical(gear, load, choice, rim)
            tension = virtual_root_stress(gear, one.load_diameter, settings, cache).tension
            normal = check.line_load / math.cos(gear.normal_pressure_angle)
            return one, normal * tension / gear.module

        both = attempt(rate)
        if both.value is None:
            found.append(_nothing(Outcome(None, both.reason)))
            continue
        one, fe = both.value
        form = check.line_load / gear.module * one.form.Y_F * one.form.Y_S
        found.append(RatedGear(Outcome(one), form, fe, ""))
    stiffness = attempt(partial(pair_stiffness, check.pair, check.line_load))
    return RatedPair((found[0], found[1]), stiffness)


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
