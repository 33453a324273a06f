"""What computed load distribution and root stress put in the place of ISO 6336's factors, each counted once.

Of a pair with a width all loads are solved at F_t K_A K_gamma K_v, the load at which the standard takes its factors.
K_Hbeta and K_Halpha are the computed ones. The largest root tension s_1 of the solved load holds face distribution,
load sharing and helix already: it is split into s_3 (shares of perfect flanks, spread evenly along each contact line),
K_Fbeta = s_1 / s_2 and K_Falpha = s_2 / s_3, of which s_3 b m_n / (F_t K_A K_gamma K_v) stands for Y_F Y_S Y_beta Y_B
Y_DT. The product is s_1. Of a plane spur pair the tooth alone is computed: root tension under a load at the outer point
of single pair contact stands for Y_F Y_S Y_B, and the load factors stay those of the formulas.
"""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array
from fegear.contact.wide.compliance import FlankCompliance
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.loaded import FlankPair
from fegear.fem.plane.gear import GearInfluence
from fegear.fem.solid.influence import SolidInfluence
from fegear.formulas.iso6336.conditions import Replacement
from fegear.formulas.iso6336.rated import Both
from fegear.geometry.pair import MEMBERS, GearPair, Member


@dataclass(frozen=True)
class Computed:
    """What was computed in the place of formulas.

    Parameters
    ----------
    replacement : Replacement
        Of pinion and wheel.
    contact_error : float
        Estimated relative error of the contact stress.
    bending_error : (float, float)
        Those of the root stresses, of pinion and wheel.
    load : float
        Along the transverse line of action at which it was solved [N]; NaN of a plane pair, whose root stress is
        proportional to the load.
    pressure : float
        Largest pressure over the flanks at that load, tips and sharp edges left out [Pa]; NaN of a plane pair.
    """

    replacement: Replacement
    contact_error: float
    bending_error: Both
    load: float = math.nan
    pressure: float = math.nan


def root_width(pair: GearPair, member: Member) -> float:
    """b that carries at the root: the gear's own, but at most one module beyond the common one on either side [m]."""
    return min(pair.gear(member).face_width, pair.face_width + 2.0 * pair.driver.module)


def computed_plane(
    pair: GearPair, members: tuple[Member, Member], influences: Mapping[Member, GearInfluence]
) -> Computed:
    """Root stress of a plane spur pair at its outer points of single pair contact.

    Parameters
    ----------
    pair : GearPair
        Spur, contact ratio from 1 to below 2.
    members : (Member, Member)
        Which of driver and driven pinion and wheel are.
    influences : mapping of Member to GearInfluence
    """
    factor, error = [], []
    for member in members:
        gear, known = pair.gear(member), influences[member]
        place = pair.x_hpstc if member == "driver" else pair.x_lpstc
        at = np.array([float(pair.radius(place, member))])
        tension = float(known.largest_root_stress(0, "tension", at)[0][0])
        off = float(np.asarray(known.root_stress_error(0, "tension", at)).ravel()[0])
        # Stress per normal line load w = F_t / (b cos alpha).
        factor.append(tension * gear.module / math.cos(gear.normal_pressure_angle))
        error.append(off / tension)
    return Computed(Replacement(root_factor=(factor[0], factor[1])), 0.0, (error[0], error[1]))


@dataclass(frozen=True)
class SolvedFlanks:
    """Loaded flanks of a pair, ready to be loaded again.

    Parameters
    ----------
    flanks : FlankPair
    gaps : FlankGaps
    fine, coarse : FlankCompliance
        Its compliances, and those of coarser solutions for error estimates.
    influences : mapping of Member to SolidInfluence
    places : ndarray
        Along the face at which root stress is looked for [m].
    coupling : bool
        Whether neighbouring teeth's loads count.
    """

    flanks: FlankPair
    gaps: FlankGaps
    fine: FlankCompliance
    coarse: FlankCompliance
    influences: Mapping[Member, SolidInfluence]
    places: Array
    coupling: bool


def computed_flanks(
    solved: SolvedFlanks, members: tuple[Member, Member], loads: Sequence[Both]
) -> tuple[Computed, ...]:
    """Load factors and root stresses of a pair with a width, under several loads.

    Parameters
    ----------
    solved : SolvedFlanks
    members : (Member, Member)
        Which of driver and driven pinion and wheel are.
    loads : sequence of (float, float)
        Along the transverse line of action, with K_A K_gamma and K_v, and the same at the reference circle [N]. Errors
        are estimated under the first one and hold for all: what coarser solutions change, and what the number of roll
        positions leaves open.
    """
    fine = _factors(solved, loads, solved.fine, coarse=False)
    again, one = _factors(solved, loads[:1], solved.coarse, coarse=True)[0], fine[0]
    # contact stress goes with the root of both factors
    contact = 0.5 * (abs(again.face / one.face - 1.0) + abs(again.transverse / one.transverse - 1.0) + one.left)
    root = {m: abs(again.largest(m) / one.largest(m) - 1.0) + one.root_left[m] for m in MEMBERS}

    def both(values: Mapping[Member, float]) -> Both:
        return values[members[0]], values[members[1]]

    return tuple(
        Computed(
            Replacement(
                K_Hbeta=one.face, K_Halpha=one.transverse, K_Fbeta=both(one.root_face),
                K_Falpha=both(one.root_transverse), root_factor=both(one.root),
            ),
            contact, both(root), load, one.pressure,
        )
        for one, (load, _) in zip(fine, loads, strict=True)
    )  # fmt: skip


@dataclass(frozen=True)
class _Factors:
    """Factors of one solution; those of the root by member.

    The number of roll positions leaves `left` open of K_Hbeta K_Halpha, and `root_left` of the largest root stress,
    relatively.
    """

    face: float
    transverse: float
    root_face: Mapping[Member, float]
    root_transverse: Mapping[Member, float]
    root: Mapping[Member, float]
    pressure: float
    left: float
    root_left: Mapping[Member, float]

    def largest(self, member: Member) -> float:
        """Root stress with all its factors."""
        return self.root_face[member] * self.root_transverse[member] * self.root[member]


def _factors(solved: SolvedFlanks, loads: Sequence[Both], known: FlankCompliance, *, coarse: bool) -> list[_Factors]:
    """Factors under every load, solved in one go."""
    from fegear.contact.wide.load_factors import (
        root_factors,
        transverse_left_by_positions,
        transverse_load_factor,
    )
    from fegear.contact.wide.over_pitch import face_left_by_positions
    from fegear.contact.wide.root_stress import rooted_lines

    pair, normal = solved.flanks.pair, [load for load, _ in loads]
    found = solved.flanks.solve(normal, solved.gaps, known)
    perfect = solved.flanks.solve(normal, None, known)
    across = transverse_load_factor(found, perfect)
    left = face_left_by_positions(solved.flanks.points, found) / found.face_load_factor
    left = left + transverse_left_by_positions(found, perfect) / across
    rooted = {}
    for member in MEMBERS:
        influence = solved.influences[member]
        body = (influence.coarse or influence.fine) if coarse else influence.fine
        rooted[member] = rooted_lines(pair, member, found.lines, body, coupling=solved.coupling)
    made = []
    for case, (_, tangential) in enumerate(loads):
        factors = {m: root_factors(found, perfect, rooted[m], solved.places, case) for m in MEMBERS}
        size = {m: root_width(pair, m) * pair.gear(m).module / tangential for m in MEMBERS}
        made.append(
            _Factors(
                float(found.face_load_factor[case]), float(across[case]), {m: factors[m].face for m in MEMBERS},
                {m: factors[m].transverse for m in MEMBERS},
                {m: factors[m].largest / (factors[m].face * factors[m].transverse) * size[m] for m in MEMBERS},
                float(found.largest_pressure[case]), float(left[case]),
                {m: factors[m].left_by_positions.largest / factors[m].largest for m in MEMBERS},
            )
        )  # fmt: skip
    return made
