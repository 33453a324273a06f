"""ISO 1328-1:2013: what flank tolerance classes 1 to 11 allow a gear's pitch, profile and helix to deviate.

Source: ISO 1328-1:2013, Cylindrical gears - ISO system of flank tolerance classification - Part 1; formulas (5) to
(12) of clause 5.3, step between classes 5.2.2, rounding 5.2.3, ranges clause 1. The edition of 1995 (grades 0 to 12,
tolerances of geometric means of ranges, printed in tables) gives other numbers under the same class number.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, fields
from decimal import ROUND_HALF_UP, Decimal

from fegear.base.errors import RangeError
from fegear.geometry.gear import Gear

#: Flank tolerance classes of the standard, and the one that its formulas are written for.
CLASSES = range(1, 12)
_WRITTEN_FOR = 5
_MM, _UM = 1e-3, 1e-6
#: Ranges of clause 1, beyond which 5.2.1 forbids to extrapolate.
_RANGES = {
    "teeth": (5.0, 1000.0, ""),
    "reference_diameter": (5.0, 15000.0, " mm"),
    "normal_module": (0.5, 70.0, " mm"),
    "face_width": (4.0, 1200.0, " mm"),
    "helix_angle": (0.0, 45.0, " deg"),
}


@dataclass(frozen=True, slots=True)
class FlankTolerances:
    """Tolerances of one gear's flanks [m]; slopes may deviate to either side, all others are ranges or magnitudes.

    Parameters
    ----------
    single_pitch : float
        f_pT, formula (5).
    cumulative_pitch : float
        F_pT, formula (6): range of the total cumulative pitch deviation.
    profile_slope, profile_form, profile_total : float
        f_HalphaT, f_falphaT and F_alphaT, formulas (7) to (9), over the profile evaluation range.
    helix_slope, helix_form, helix_total : float
        f_HbetaT, f_fbetaT and F_betaT, formulas (10) to (12), over the helix evaluation range.
    """

    single_pitch: float
    cumulative_pitch: float
    profile_slope: float
    profile_form: float
    profile_total: float
    helix_slope: float
    helix_form: float
    helix_total: float

    @property
    def rounded(self) -> FlankTolerances:
        """The same as clause 5.2.3 rounds them, each from its unrounded value."""
        return FlankTolerances(*(rounded(getattr(self, one.name)) for one in fields(self)))

    def base_pitch(self, transverse_pressure_angle: float) -> float:
        """Transverse base pitch tolerance f_pT cos(alpha_t) [m], the pitch deviation along the line of action.

        ISO 6336-1's f_pb may also be taken as f_pT itself, which is larger.
        """
        return self.single_pitch * math.cos(transverse_pressure_angle)


def flank_tolerances(
    tolerance_class: int, reference_diameter: float, normal_module: float, face_width: float
) -> FlankTolerances:
    """Unrounded tolerances of a class.

    Parameters
    ----------
    tolerance_class : int
        1 to 11.
    reference_diameter : float
        d [m], 5 mm to 15 m.
    normal_module : float
        m_n [m], 0.5 to 70 mm.
    face_width : float
        b [m], 4 mm to 1.2 m.

    Raises
    ------
    RangeError
        If the class is none of the standard's or a size lies outside its ranges.
    """
    if tolerance_class not in CLASSES:
        raise RangeError("tolerance_class", tolerance_class, "must be 1 to 11, the classes of ISO 1328-1:2013")
    d, m, b = reference_diameter / _MM, normal_module / _MM, face_width / _MM
    for key, value in (("reference_diameter", d), ("normal_module", m), ("face_width", b)):
        _inside(key, value)
    step = math.sqrt(2.0) ** (tolerance_class - _WRITTEN_FOR) * _UM
    form, slope = (0.55 * m + 5.0) * step, (0.4 * m + 0.001 * d + 4.0) * step
    lead_form = (0.07 * math.sqrt(d) + 0.45 * math.sqrt(b) + 4.0) * step
    lead_slope = (0.05 * math.sqrt(d) + 0.35 * math.sqrt(b) + 4.0) * step
    return FlankTolerances(
        single_pitch=(0.001 * d + 0.4 * m + 5.0) * step,
        cumulative_pitch=(0.002 * d + 0.55 * math.sqrt(d) + 0.7 * m + 12.0) * step,
        profile_slope=slope,
        profile_form=form,
        profile_total=math.hypot(slope, form),
        helix_slope=lead_slope,
        helix_form=lead_form,
        helix_total=math.hypot(lead_slope, lead_form),
    )


def tolerances_of(gear: Gear, tolerance_class: int) -> FlankTolerances:
    """Unrounded tolerances of a gear's flanks.

    Raises
    ------
    RangeError
        If the gear or the class lies outside the standard's ranges.
    """
    _inside("teeth", float(gear.teeth))
    _inside("helix_angle", math.degrees(abs(gear.helix_angle)))
    return flank_tolerances(tolerance_class, 2.0 * gear.pitch_radius, gear.module, gear.face_width)


def rounded(tolerance: float) -> float:
    """A tolerance [m] as clause 5.2.3 rounds it: whole micrometres above 10, halves above 5, tenths to 5 um."""
    micrometres = Decimal(f"{tolerance / _UM:.9f}")
    if micrometres > 10:
        step = Decimal(1)
    elif micrometres > 5:
        step = Decimal("0.5")
    else:
        step = Decimal("0.1")
    return float((micrometres / step).quantize(Decimal(1), rounding=ROUND_HALF_UP) * step) * _UM


def _inside(key: str, value: float) -> None:
    least, most, unit = _RANGES[key]
    slack = 1e-9 * most  # 4 mm is 4.000000000000001 after a conversion of units
    if not least - slack <= value <= most + slack:
        raise RangeError(
            key, f"{value:.6g}{unit}", f"must be {least:g} to {most:g}{unit}, the range of ISO 1328-1:2013",
            "specify deviations of your own",
        )  # fmt: skip
