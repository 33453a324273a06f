"""ISO 6336 of a rack: the factors of part 3 and part 2 in their limits as the number of teeth grows without bound.

With z -> infinity the 30 degree tangents of part 3 touch the root rounding itself, the load angle is the pressure angle
everywhere, and the reduced radius of curvature is the pinion's:

    s_Fn / m = pi/2 + 2 h_fP tan(alpha) + 2 rho (1 - sin alpha)/cos(alpha) - sqrt(3) rho,     rho_F = rho,

h_Fe from the load's line to the section, rho/2 above the root. What holds for gears only (dynamic factors from masses
on shafts, life of a wheel's teeth over its turns) has no limit, and is left blank by whoever asks for it.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from fegear.formulas.iso6336.part3_root_stress import stress_correction_factor

if TYPE_CHECKING:
    from fegear.geometry.rack_and_pinion import RackAndPinion
    from fegear.geometry.rack_tooth import RackTooth


class RackForm(NamedTuple):
    """Part 3, method B, of a rack's tooth; lengths in modules."""

    s_Fn: float  # noqa: N815  (symbol of the standard)
    h_Fe: float  # noqa: N815  (symbol of the standard)
    rho_F: float  # noqa: N815  (symbol of the standard)
    Y_F: float
    Y_S: float


def rack_root_form(tooth: RackTooth, height: float) -> RackForm:
    """Y_F and Y_S of a load at a height of the flank.

    Parameters
    ----------
    tooth : RackTooth
    height : float
        Above the reference line [modules].
    """
    alpha, rho = tooth.pressure_angle, tooth.rack.tip_radius
    centre = tooth.root_height + rho
    beside = float(tooth.half_thickness(centre)) + rho / math.cos(alpha)
    s_Fn = 2.0 * (beside - rho * math.cos(math.radians(30.0)))
    section = centre - rho * math.sin(math.radians(30.0))
    h_Fe = height - float(tooth.half_thickness(height)) * math.tan(alpha) - section
    Y_F = 6.0 * h_Fe * math.cos(alpha) / (s_Fn**2 * math.cos(alpha))
    return RackForm(s_Fn, h_Fe, rho, Y_F, stress_correction_factor(s_Fn, h_Fe, rho))


def outer_single_contact_height(pair: RackAndPinion) -> float:
    """Height on the rack at which a load stands alone nearest to the tip [m]."""
    pitch = pair.rack.base_pitch
    return float(pair.height(pair.x_end - pitch if pair.contact_ratio < 2.0 else pair.x_start))


def nominal_root_stress_of_rack(pair: RackAndPinion, tangential: float) -> float:
    """sigma_F0 = F_t / (b m) Y_F Y_S of the rack [Pa], all K factors 1.

    Parameters
    ----------
    pair : RackAndPinion
    tangential : float
        F_t, along the rack [N].
    """
    form = rack_root_form(pair.rack.tooth, outer_single_contact_height(pair) / pair.rack.module)
    return tangential / (pair.face_width * pair.rack.module) * form.Y_F * form.Y_S


def nominal_contact_stress_on_rack(pair: RackAndPinion, tangential: float) -> float:
    """sigma_H0 [Pa] at the pitch point with u -> infinity, (u + 1)/u -> 1, all K factors 1; Z_beta = 1.

    Parameters
    ----------
    pair : RackAndPinion
    tangential : float
        F_t, along the rack [N].
    """
    alpha, ratio = pair.rack.pressure_angle, pair.contact_ratio
    z_h = math.sqrt(2.0 / (math.cos(alpha) * math.sin(alpha)))
    z_eps = math.sqrt((4.0 - ratio) / 3.0) if ratio < 4.0 else 0.0
    softness = sum(
        (1.0 - one.poisson_ratio**2) / one.young_modulus for one in (pair.pinion.material, pair.rack.material)
    )
    z_e = math.sqrt(1.0 / (math.pi * softness))
    return z_h * z_e * z_eps * math.sqrt(tangential / (2.0 * pair.pinion.pitch_radius * pair.face_width))
