"""The Lewis parabola: the section at which a beam of uniform strength, hung from the load, touches the fillet.

Source: W. Lewis, Investigation of the Strength of Gear Teeth, Proc. Engineers' Club of Philadelphia (1892); with the
apex where the line of action crosses the tooth's centre line, as in AGMA 908-B89, section 5.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.errors import RangeError
from fegear.formulas.fillet_section import FilletPoint, fillet_parameter, fillet_point, tangent_range
from fegear.formulas.load_line import LoadLine, load_line

if TYPE_CHECKING:
    from fegear.formulas.fillet_section import Filleted
    from fegear.geometry import Tooth


def lewis_section(tooth: Tooth, radius: float) -> tuple[FilletPoint, LoadLine]:
    """Section where the parabola through the load apex touches the fillet, for a load at `radius` [modules].

    On a parabola with its apex h above the section the tangent makes atan(x / (2 h)) with the axis. Many teeth loaded
    near the tip are so like a wedge that the parabola touches above the fillet; as in AGMA 908-B89, whose iteration
    knows no end of the trochoid, it then touches the trochoid continued beyond the start of the involute.

    Raises
    ------
    RangeError
        If the parabola touches neither the fillet nor its continuation.
    """
    load = load_line(tooth, radius)
    section = touching_section(tooth, float(load.apex[0]))
    if section is not None:
        return section, load
    raise RangeError(
        "load radius",
        f"{radius:.6g} modules",
        "gives a Lewis parabola that does not touch the fillet",
        "the formula has no critical section here",
    )


def touching_section(tooth: Filleted, apex: float) -> FilletPoint | None:
    """Section where the parabola with its apex at a height [modules] touches the trochoid; None if nowhere."""
    from scipy.optimize import brentq

    def excess(gamma: float) -> float:
        p = fillet_point(tooth, fillet_parameter(tooth, gamma))
        return math.tan(gamma) * 2.0 * (apex - p.height) - p.half_thickness

    low, high = tangent_range(tooth)
    high = min(high, 0.5 * math.pi - 1e-9)
    if excess(low) > 0.0:
        return _above_the_fillet(tooth, apex)
    if excess(high) >= 0.0:
        gamma = brentq(excess, low, high, xtol=1e-13)
        return fillet_point(tooth, fillet_parameter(tooth, gamma))
    return None


def _above_the_fillet(tooth: Filleted, apex: float) -> FilletPoint | None:
    """Section at which the parabola touches the trochoid beyond its junction with the involute; None if nowhere."""
    from scipy.optimize import brentq

    def excess(beta: float) -> float:
        p = fillet_point(tooth, beta)
        return math.tan(p.tangent_angle) * 2.0 * (apex - p.height) - p.half_thickness

    end, steps = tooth.trochoid.end, 200
    last = 0.5 * math.pi - 1e-6
    for i in range(1, steps):
        beta = end + (last - end) * i / steps
        if excess(beta) <= 0.0:
            return fillet_point(tooth, brentq(excess, end, beta, xtol=1e-14))
    return None
