"""ISO 6336-3 method B on the exact outline of a tooth: section, Y_F and Y_S of ring gears as of external ones.

The standard puts the critical section of an internal tooth where the tangent to the fillet makes 60 degrees with the
centre line (30 degrees on external teeth). Its own formulas describe the outlines of racks; here section, fillet radius
and lever are those of the curves that the cutter leaves. No printed example of an internal tooth was at hand: on
external teeth the same steps give the numbers of the formulas.
"""

from __future__ import annotations

import math

import numpy as np
from scipy.optimize import brentq

from fegear.base.errors import RangeError
from fegear.formulas.iso6336.part3_root_stress import RootForm, stress_correction_factor
from fegear.geometry.involute_tooth import InvoluteTooth

#: Angle of the tangent to the tooth's centre line at the critical section [rad].
EXTERNAL_TANGENT, INTERNAL_TANGENT = math.radians(30.0), math.radians(60.0)


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
        raise RangeError("load radius", f"{radius:.6g} modules", "lies beside the root section: there is no lever")
    chord = 2.0 * x
    y_f = 6.0 * h * math.cos(load_angle) / (chord**2 * math.cos(tooth.pressure_angle))
    return RootForm(chord, rho, h, load_angle, y_f, stress_correction_factor(chord, h, rho), at, y)


def ring_load_diameter(tooth: InvoluteTooth, tip_diameter: float, contact_ratio: float) -> float:
    """d_en of a spur internal gear [modules]: from its tip the path of contact runs toward the root.

    Parameters
    ----------
    tooth : InvoluteTooth
    tip_diameter : float
        d_Na, where its involute ends [modules].
    contact_ratio : float
        epsilon_alpha.
    """
    cosine = math.cos(tooth.pressure_angle)
    base, pitch = 0.5 * tooth.teeth * cosine, math.pi * cosine
    reach = math.sqrt(max(0.25 * tip_diameter**2 - base**2, 0.0)) + pitch * (contact_ratio - 1.0)
    return 2.0 * math.hypot(reach, base)
