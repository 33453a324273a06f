"""How deep the case of surface-hardened teeth should be: ISO 6336-5 and ANSI/AGMA 2101-D04.

All numbers of this module are recalled: printed papers name both standards' rules, none at hand has their equations.
"""

from __future__ import annotations

import math

from fegear.geometry.pair import GearPair

#: Usual case depths at 550 HV of finished flanks, and the largest one, in normal modules; that is at most 6 mm.
USUAL, LARGEST, DEEPEST = (0.15, 0.25), 0.4, 6e-3
#: U_H of ISO 6336-5 by quality of case-carburized steel [Pa].
ISO_CRUSHING = {"ML": 44e9, "MQ": 66e9, "ME": 66e9}
#: U_H of AGMA 2101: carburized, and hardened by induction tooth by tooth [Pa].
AGMA_CRUSHING = {"carburized": 44e9, "induction-hardened": 30e9}


def crushing_depth(pair: GearPair, contact_stress: float, hardening: float) -> float:
    """Eht_c = sigma_H d_w1 sin(alpha_wt) z2 / (U_H cos(beta_b) (z1 + z2)), below which the case is crushed [m].

    The same form stands for ISO 6336-5 and for h_e,min of AGMA 2101.

    Parameters
    ----------
    pair : GearPair
    contact_stress : float
        sigma_H of the standard [Pa].
    hardening : float
        U_H of the standard [Pa].
    """
    one, two = pair.driver, pair.driven
    angle = pair.working_pressure_angle
    diameter = 2.0 * one.base_radius / math.cos(angle)
    share = two.teeth / (one.teeth + two.teeth)
    return contact_stress * diameter * math.sin(angle) * share / (hardening * math.cos(one.base_helix_angle))


def recommended(normal_module: float) -> tuple[float, float, float]:
    """Least and largest usual case depth, and the one not to exceed [m]."""
    least, most = (factor * normal_module for factor in USUAL)
    return least, most, min(LARGEST * normal_module, DEEPEST)
