"""ISO 6336's nominal root stress of a pair's gears compared with finite elements of the same (virtual) spur tooth."""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import partial

import numpy as np

from fegear.base.solution_cache import SolutionCache
from fegear.contact.compared.virtual_gear import virtual_root_stress
from fegear.fem.plane.gear import GearInfluence
from fegear.fem.plane.settings import MeshSettings
from fegear.formulas.iso6336 import part3_pair as rating
from fegear.formulas.iso6336.part1_stiffness import Stiffness, pair_stiffness
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
    specific_load : float
        F_t / b [N/m].
    load_factor : float
        K_A K_gamma, which c' takes and a nominal root stress does not.
    """

    pair: GearPair
    overlap_ratio: float
    specific_load: float
    load_factor: float = 1.0

    @property
    def applied_load(self) -> float:
        """F_t K_A K_gamma / b [N/m]."""
        return self.load_factor * self.specific_load


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
        w = F_bt / b, along the line of action [N/m].
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
        form = pair.tangential_load(line_load) / gear.module * one.form.Y_F * one.form.Y_S
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
                check.specific_load, rating.virtual_contact_ratio(gear, check.pair.contact_ratio), check.overlap_ratio,
                gear.helix_angle,
            )  # fmt: skip
            one = rating.rate_helical(gear, load, choice, rim)
            tension = virtual_root_stress(gear, one.load_diameter, settings, cache).tension
            normal = check.specific_load / math.cos(gear.normal_pressure_angle)
            return one, normal * tension / gear.module

        both = attempt(rate)
        if both.value is None:
            found.append(_nothing(Outcome(None, both.reason)))
            continue
        one, fe = both.value
        form = check.specific_load / gear.module * one.form.Y_F * one.form.Y_S
        found.append(RatedGear(Outcome(one), form, fe, ""))
    stiffness = attempt(partial(pair_stiffness, check.pair, specific_load=check.applied_load))
    return RatedPair((found[0], found[1]), stiffness)
