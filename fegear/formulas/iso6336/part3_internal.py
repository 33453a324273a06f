"""ISO 6336-3 method B of internal teeth: the standard's equations, and the same steps on the exact outline.

Source: ISO 6336-3:2006, 6.2 and 7.2, recalled: a rack whose rounding follows from that of the pinion-type cutter
(rho_fPv), the critical section where the tangent to the fillet makes 60 degrees with the centre line, z_n negative in
its lengths and positive in its fillet radius. So written the equations give every printed digit of two published rings
(KISSsoft 03/2017 reports on the NREL 5 MW gearbox). Helical rings go through z_n; the cutter's number of teeth stays.

`outline_root_form` takes section, fillet radius and lever from the curves that the cutter leaves, external or internal:
on external teeth the same steps give the numbers of the formulas.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from scipy.optimize import brentq

from fegear.base.errors import RangeError
from fegear.formulas.iso6336.part3_root_stress import (
    RootForm,
    auxiliary_angle,
    stress_correction_factor,
    virtual_teeth,
)
from fegear.geometry.internal_tooth import InternalTooth
from fegear.geometry.involute_tooth import InvoluteTooth

#: Angle of the tangent to the tooth's centre line at the critical section [rad].
EXTERNAL_TANGENT, INTERNAL_TANGENT = math.radians(30.0), math.radians(60.0)


@dataclass(frozen=True, slots=True)
class RingTooth:
    """An internal gear as ISO 6336-3 sees it: a spur gear of `teeth` (virtual, not necessarily whole), lengths in m_n.

    Parameters
    ----------
    teeth : float
        |z_n|.
    profile_shift : float
        x, positive toward the tip; the generating one when the tooth is thinned for backlash.
    dedendum : float
        h_fP: depth of the root circle below the reference circle that the shift moves.
    cutter_teeth, cutter_shift, cutter_rounding : float
        z_0, x_0 and rho_fP of the pinion-type cutter.
    pressure_angle : float
        alpha_n [rad].
    """

    teeth: float
    profile_shift: float
    dedendum: float
    cutter_teeth: float
    cutter_shift: float = 0.0
    cutter_rounding: float = 0.3
    pressure_angle: float = math.radians(20.0)

    @property
    def rounding(self) -> float:
        """rho_fPv of the rack that stands for the cutter: rho_fP + (x_0 + h_fP - rho_fP)^1.95 / (3.156 1.036^z_0)."""
        reach = self.cutter_shift + self.dedendum - self.cutter_rounding
        if not reach > 0.0:
            raise RangeError("cutter.tip_radius", self.cutter_rounding, "must be smaller than the dedendum")
        return float(self.cutter_rounding + reach**1.95 / (3.156 * 1.036**self.cutter_teeth))

    def load_diameter(self, tip_diameter: float, contact_ratio: float) -> float:
        """d_en: from the tip of the virtual gear the path of contact runs toward its root.

        Parameters
        ----------
        tip_diameter : float
            d_an, where its involute ends.
        contact_ratio : float
            epsilon_alpha_n of the virtual pair.
        """
        cosine = math.cos(self.pressure_angle)
        base, pitch = 0.5 * self.teeth * cosine, math.pi * cosine
        reach = math.sqrt(max(0.25 * tip_diameter**2 - base**2, 0.0)) + pitch * (contact_ratio - 1.0)
        return 2.0 * math.hypot(reach, base)


def ring_tooth(tooth: InternalTooth) -> RingTooth:
    """A generated internal tooth, spur or helical, as ISO 6336-3 sees it; the cutter's rounding counts as given."""
    shift, cutter = tooth.generating_shift, tooth.cutter
    return RingTooth(
        virtual_teeth(tooth.teeth, tooth.helix_angle, tooth.normal_pressure_angle), shift,
        tooth.root_radius - tooth.pitch_radius + shift, cutter.teeth, cutter.profile_shift, cutter.tip_radius,
        tooth.normal_pressure_angle,
    )  # fmt: skip


def ring_root_form(ring: RingTooth, load_diameter: float) -> RootForm:
    """Critical section and factors for a load at `load_diameter` d_en [modules] (ISO 6336-3:2006, 6.2 and 7.2).

    Raises
    ------
    RangeError
        If the load point is off the involute or beside the section, or q_s leaves 1 to 8.
    ConvergenceError
        If the tooth has no 60 degree tangent.
    """
    z, a, x, rho = -ring.teeth, ring.pressure_angle, ring.profile_shift, ring.rounding
    e = math.pi / 4 - ring.dedendum * math.tan(a) - (1.0 - math.sin(a)) * rho / math.cos(a)
    g = rho - ring.dedendum + x
    theta = auxiliary_angle(g, z, 2.0 / z * (math.pi / 2 - e) - math.pi / 6)
    c = math.cos(theta)
    if not 0.0 <= theta <= math.pi / 2 - a + 1e-9:
        given = f"{math.degrees(theta):.4g} deg"
        raise RangeError("auxiliary angle theta", given, "is outside the rounding of the cutter (ISO 6336-3, 6.2)")
    s = z * math.sin(math.pi / 6 - theta) + g / c - rho
    fillet = rho + 2.0 * g * g / (c * (-z * c * c - 2.0 * g))
    base = ring.teeth * math.cos(a)
    if not load_diameter >= base:
        raise RangeError("load diameter", f"{load_diameter:.6g} modules", f"is below the base diameter {base:.6g}")
    alpha_e = math.acos(base / load_diameter)
    gamma = (math.pi / 2 + 2.0 * x * math.tan(a)) / z + (math.tan(a) - a) - (math.tan(alpha_e) - alpha_e)
    alpha_f = alpha_e - gamma
    height = 0.5 * (z * math.cos(math.pi / 6 - theta) + math.sqrt(3.0) * (g / c - rho))
    h = -0.5 * (math.cos(gamma) - math.sin(gamma) * math.tan(alpha_f)) * load_diameter - height
    if not (s > 0.0 and h > 0.0 and fillet > 0.0):
        raise RangeError(
            "tooth", f"s_Fn = {s:.4g}, h_Fe = {h:.4g}", "has no root section below the load (no bending moment arm)"
        )
    y_f = 6.0 * h * math.cos(alpha_f) / (s * s * math.cos(a))
    return RootForm(s, fillet, h, alpha_f, y_f, stress_correction_factor(s, h, fillet), theta, -height)


def outline_root_form(tooth: InvoluteTooth, load_diameter: float) -> RootForm:
    """Critical section and factors of a spur tooth, external or internal, from its outline.

    Parameters
    ----------
    tooth : InvoluteTooth
    load_diameter : float
        Where the load stands [modules], normal to the flank there.

    Returns
    -------
    RootForm
        `theta` is the fillet's parameter at the section; `height` its distance from the gear's centre.

    Raises
    ------
    RangeError
        If the load is off the involute or beside the section, the fillet has no such tangent, or q_s leaves 1 to 8.
    """
    radius = 0.5 * load_diameter
    low, high = tooth.involute_radii
    if not low * (1.0 - 1e-9) <= radius <= high * (1.0 + 1e-9):
        raise RangeError("load radius", f"{radius:.6g} modules", "is not on the involute")
    fillet, asked = tooth.fillet, INTERNAL_TANGENT if tooth.internal else EXTERNAL_TANGENT

    def beyond(at: float) -> float:
        """How much more than the asked angle the tangent leans from the centre line."""
        x, y = np.abs(fillet.normals(np.array([at]))[:, 0])
        return math.atan2(y, x) - asked

    if beyond(fillet.start) * beyond(fillet.end) > 0.0:
        raise RangeError(
            "tooth", f"{math.degrees(asked):.0f} degree tangent", "does not touch the fillet (ISO 6336-3, 6.1)"
        )
    at = float(brentq(beyond, fillet.start, fillet.end, xtol=1e-14))
    x, y = (float(v) for v in fillet.points(np.array([at]))[:, 0])
    rho = 1.0 / abs(float(fillet.curvatures(np.array([at]))[0]))
    roll = np.array([float(tooth.roll(radius))])
    (px, py), (nx, ny) = tooth.involute.points(roll)[:, 0], tooth.involute.normals(roll)[:, 0]
    # the load's line meets the centre line at py - px ny / nx
    load_angle = math.atan2(abs(float(ny)), abs(float(nx)))
    h = tooth.side * (float(py - px * ny / nx) - y)
    if not h > 0.0:
        raise RangeError("load radius", f"{radius:.6g} modules", "is at the root section (no bending moment arm)")
    chord = 2.0 * x
    y_f = 6.0 * h * math.cos(load_angle) / (chord**2 * math.cos(tooth.pressure_angle))
    return RootForm(chord, rho, h, load_angle, y_f, stress_correction_factor(chord, h, rho), at, y)
