"""Root stress of a spur pair's gears under a load at the outer point of single pair contact, by formulas and by FE.

ISO 6336-3 and AGMA 908 put the load there: a tooth pair alone carries it all, and its arm is longest. Over the rest of
the flank their ratio to finite elements is one of loads that no rating has.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fegear.contact.compared.crosscheck import RootStressAnswers, root_stress_answers
from fegear.fem.plane.gear import GearInfluence
from fegear.geometry.pair import MEMBERS, GearPair, Member


@dataclass(frozen=True, slots=True)
class AtSingleContact:
    """One gear loaded normal to its flank at its outer point of single pair contact, per unit line load.

    Parameters
    ----------
    member : {"driver", "driven"}
    radius : float
        Of the load [m].
    fe, fe_error : float
        Largest tangential stress of the fillet below the loaded flank, and its estimated error [1/m].
    answers : mapping of str to RootStressAnswers
        Of every formula at this one load, for a tooth of module 1.
    """

    member: Member
    radius: float
    fe: float
    fe_error: float
    answers: Mapping[str, RootStressAnswers]


def at_single_contact(pair: GearPair, influences: Sequence[GearInfluence]) -> tuple[AtSingleContact, ...]:
    """Both gears of a spur pair; empty where no tooth pair is ever alone or flanks are not meshed so far.

    Parameters
    ----------
    pair : GearPair
    influences : sequence of GearInfluence
        Of driver and driven.
    """
    if not 1.0 <= pair.contact_ratio < 2.0:
        return ()
    found = []
    for member, known in zip(MEMBERS, influences, strict=True):
        gear = pair.gear(member)
        radius = float(pair.radius(pair.x_hpstc if member == "driver" else pair.x_lpstc, member))
        slack = 1e-9 * gear.module
        if not known.lowest_radius - slack <= radius <= known.highest_radius + slack:
            return ()
        radius = float(np.clip(radius, known.lowest_radius, known.highest_radius))
        stress, _, error = known.root_stress_with_error(0, "tension", np.array([radius]))
        answers = root_stress_answers(gear.external_tooth, radius / gear.module)
        found.append(AtSingleContact(member, radius, float(stress[0]), float(error[0]), answers))
    return tuple(found)
