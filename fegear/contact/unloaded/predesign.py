"""Predesigned parabolic transmission error that absorbs a linear one (closing remark of NASA TM-107451, section 3)."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np

from fegear.base.errors import RangeError
from fegear.contact.unloaded.pair import HelicalPair
from fegear.contact.unloaded.pair_contact import pair_contact


@dataclass(frozen=True, slots=True)
class Predesign:
    """A lengthwise crown of the pinion and the transmission error it is made for.

    Parameters
    ----------
    pair : HelicalPair
        The drive with the crown (and the cutter parabola and errors it had).
    slope : float
        Linear transmission error to absorb, d(Delta phi_2)/d(phi_1).
    error_parabola : float
        a of the predesigned error -a phi_1^2 [1/rad].
    crown : float
        c [rad/m^2] (see `RackFlank`).
    peak_to_peak : float
        Variation of the sum of both errors over a cycle, a (pi/N_1)^2 [rad]; the linear error leaves it as it is.
    """

    pair: HelicalPair
    slope: float
    error_parabola: float
    crown: float
    peak_to_peak: float


def linear_error(pair: HelicalPair) -> float:
    """Slope of the transmission error where contact is on the surface: d(Delta phi_2)/d(phi_1).

    Parameters
    ----------
    pair : HelicalPair
        A drive with a cutter parabola, so that misalignment leaves surface contact; its crown is ignored.

    Raises
    ------
    RangeError
        If the contact stays on edges.
    """
    lo, hi = pair.engagement
    contact = pair_contact(pair.with_modification(parabola=pair.parabola), np.linspace(lo, hi, 65))
    inside = contact.kind == "surface"
    if not inside.any():
        raise RangeError(
            "parabola", f"{pair.parabola:.6g} 1/m", "gives edge contact",
            "increase it until contact is inside the flanks",
        )  # fmt: skip
    return float(np.median(contact.slope[inside]))


def absorb_linear_error(pair: HelicalPair, slope: float | None = None, face_share: float = 0.95) -> Predesign:
    """The smallest lengthwise crown whose parabolic transmission error absorbs a linear one.

    In the aligned drive the flanks meet at height z_0 = phi_1/twist on the pitch line, and at s = k (z_0 - z),
    k = sin(alpha_t) tan(beta_b)/cos(alpha_n), along the rest of the contact line. The cutter's parabola lets the gear
    lag by T (z_0 - z)^2 there, T = a_c k^2/(r_b2 cos(beta_b)); a crown adds C z^2, C = c N_1/N_2, and a linear error
    e z. The point that touches is the largest of -T (z_0 - z)^2 - C z^2 + e z over z, so that::

        error = -T C/(T + C) z_0^2 + e T/(T + C) z_0 + const,    z = (T z_0 + e/2)/(T + C):

    the linear error moves the parabola's top to z_0 = e/(2 C) without changing its height, and each pair is in
    contact for one pitch 2 z_p around it. The smallest C keeps that pitch on the face,
    abs(e)/(2 C) + z_p T/(T + C) <= face_share L/2: a quadratic equation for C.

    Parameters
    ----------
    pair : HelicalPair
        A helical drive with a positive cutter parabola; its own crown is replaced.
    slope : float, optional
        Linear error to absorb, d(Delta phi_2)/d(phi_1) without crown (either sign); by default that of the pair's own
        errors.
    face_share : float
        Part of the common face that the path of contact may use, within (0, 1].

    Returns
    -------
    Predesign

    Raises
    ------
    RangeError
        If there is no cutter parabola or no helix, or the path of contact would leave the flank's height.
    """
    if not 0.0 < face_share <= 1.0:
        raise RangeError("face_share", face_share, "must lie within (0, 1]")
    g, twist = pair.cut_pinion, abs(pair.cut_pinion.twist)
    if twist == 0.0:
        raise RangeError(
            "helix_angle", "0 deg", "gives no motion of the contact point along the tooth", "use helical gears"
        )
    if pair.parabola <= 0.0:
        raise RangeError("parabola", pair.parabola, "must be positive to localise the contact")
    b = linear_error(pair) if slope is None else float(slope)
    k = math.sin(g.transverse_pressure_angle) * math.tan(g.base_helix_angle) / math.cos(g.normal_pressure_angle)
    T = pair.parabola * k**2 / (pair.gear.base_radius * math.cos(g.base_helix_angle))
    e, half_pitch = abs(b) * twist, math.pi / (pair.pinion.teeth * twist)
    lo, hi = pair.overlap
    room = face_share * min(-lo, hi)
    if room <= 0.0:
        raise RangeError("axial_offset", f"{pair.axial_offset:.6g} m", "gives no contact at pinion mid-face")
    p = room * T - 0.5 * e - half_pitch * T
    # The positive root of room C^2 + p C - e T/2, without cancellation for either sign of p.
    root = math.sqrt(p * p + 2.0 * room * e * T)
    C = (root - p) / (2.0 * room) if p < 0.0 else e * T / (root + p) if root + p > 0.0 else 0.0
    height = k * half_pitch * C / (T + C)
    if height > min(-pair.flank.s_form, pair.flank.s_tip):
        raise RangeError(
            "parabola", f"{pair.parabola:.6g} 1/m", "gives a contact path that leaves the active profile at tip and "
                                                    "root",
            "increase it, increase the face width or accept a larger share of the face",
        )  # fmt: skip
    a = T * C / (T + C) / twist**2
    crown = C / pair.ratio
    changed = pair.with_modification(parabola=pair.parabola, crown=crown)
    return Predesign(changed, b, a, crown, a * (math.pi / pair.pinion.teeth) ** 2)
