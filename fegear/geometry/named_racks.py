"""Basic racks and tool profiles by the names that stand on drawings: ISO 53, DIN 867, JIS B 1701, DIN 3972, numbers."""

from __future__ import annotations

import math
import re

from fegear.base.errors import GeometryError
from fegear.geometry.rack import BasicRack

#: Names of one profile: DIN 867:1986 with its usual clearance of 0.25 m; JIS B 1701-1 takes over ISO 53.
_AS_ISO_53_A = ("DIN 867", "JIS B 1701", "JIS B 1701-1")
#: DIN 3972:1952, profiles that finish: dedendum of the gear [modules].
_DIN_3972 = {"I": 1.167, "II": 1.25}
#: DIN 3972:1952, rounding of the tool's tip by module [mm].
_TIP_ROUNDING = {
    1.0: 0.08, 1.25: 0.12, 1.5: 0.20, 1.75: 0.25, 2.0: 0.30, 2.25: 0.40, 2.5: 0.50, 2.75: 0.50, 3.0: 0.60, 3.25: 0.60,
    3.5: 0.70, 3.75: 0.75, 4.0: 0.80, 4.5: 0.90, 5.0: 1.00, 5.5: 1.10, 6.0: 1.20, 6.5: 1.30, 7.0: 1.40, 8.0: 1.60,
    9.0: 1.80, 10.0: 2.00, 11.0: 2.20, 12.0: 2.40, 13.0: 2.60, 14.0: 2.80, 15.0: 3.00, 16.0: 3.20,
}  # fmt: skip
_NUMBER = r"\d+(?:\.\d*)?|\.\d+"
_THREE = re.compile(rf"\s*({_NUMBER})\s*/\s*({_NUMBER})\s*/\s*({_NUMBER})\s*")
_CHOICES = '"ISO 53 A" to "D", "DIN 867", "JIS B 1701", "DIN 3972 I" or "II", "1.25/0.38/1.0" (h_fP*/rho_fP*/h_aP*)'
_SPACES = re.compile(r"[\s._]+")


def named_rack(name: str, pressure_angle: float, module: float = math.nan) -> BasicRack:
    """Return the profile of a name.

    Parameters
    ----------
    name : str
        "ISO 53 A" (or "A") to D, "DIN 867", "JIS B 1701", "DIN 3972 I" or "II", or the numbers of
        dedendum, tip radius and addendum in modules: "1.25/0.38/1.0".
    pressure_angle : float
        alpha_P [rad].
    module : float
        m_n [m]: profiles of DIN 3972 depend on it.

    Raises
    ------
    GeometryError
        If there is no profile of that name, or not for that module.
    """
    three = _THREE.fullmatch(name)
    if three is not None:
        dedendum, tip_radius, addendum = map(float, three.groups())
        return BasicRack(addendum, dedendum, tip_radius, pressure_angle)
    text = _SPACES.sub(" ", name.strip().upper())
    if text.replace(" ", "") in {known.replace(" ", "") for known in _AS_ISO_53_A}:
        return BasicRack.named("A", pressure_angle)
    if (profile := re.fullmatch(r"DIN ?3972[ -]*(I{1,3}|IV)", text)) is not None:
        return _din_3972(name, profile[1], pressure_angle, module)
    try:
        return BasicRack.named(name, pressure_angle)
    except GeometryError as error:
        if error.key != "rack":
            raise
        raise GeometryError("rack", error.value, "is not a known profile", f"choose {_CHOICES}") from None


def _din_3972(name: str, profile: str, pressure_angle: float, module: float) -> BasicRack:
    """Profile I or II: finishing tools, whose tip rounding is that of the table for their module."""
    if profile not in _DIN_3972:
        raise GeometryError(
            "rack", f'"{name}"', "is a profile for pre-machining, which leaves stock on the flanks",
            'use "DIN 3972 II", or a table with protuberance and grinding_allowance',
        )  # fmt: skip
    millimetres = round(module * 1e3, 9) if math.isfinite(module) else math.nan
    if millimetres not in _TIP_ROUNDING:
        raise GeometryError(
            "rack", f'"{name}"', f"has no tip rounding for a module of {millimetres:.6g} mm (1 to 16 mm, DIN 3972)",
            f'give the profile as numbers, "{_DIN_3972[profile]:g}/0.2/1.0"',
        )  # fmt: skip
    return BasicRack(1.0, _DIN_3972[profile], _TIP_ROUNDING[millimetres] / millimetres, pressure_angle)
