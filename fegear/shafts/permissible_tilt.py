"""How far the rings of a bearing may be tilted against each other: guide values by kind.

Source: J. E. Shigley, Mechanical Engineering Design (R. G. Budynas, J. K. Nisbett, 9th edition, 2011), Table 7-2,
typical maximum ranges for slopes. Catalogues of makers have values of their own (deep groove ball bearings 2 to 10
minutes of arc), which depend on clearance, load and crowning of rollers; angular contact ball bearings are in none of
the rows. Spherical roller bearings are not either: NSK, Rolling Bearings, prints 1 to 2.5 degrees for them.
"""

from __future__ import annotations

from dataclasses import dataclass

from fegear.shafts.printed_bearing import Kind

#: Least and largest of the range by kind [rad].
_RANGES: dict[Kind, tuple[float, float]] = {
    "ball": (0.001, 0.003), "cylindrical": (0.0008, 0.0012), "tapered": (0.0005, 0.0012),
    "spherical": (0.018, 0.045),
}  # fmt: skip


@dataclass(frozen=True, slots=True)
class PermissibleTilt:
    """From `low` on a maker should be asked, above `high` no bearing of the kind lasts [rad]."""

    low: float
    high: float
    kind: str = ""


def tilt_of_kind(kind: Kind, contact_angle: float) -> PermissibleTilt | None:
    """Guide values; None for ball bearings of a contact angle.

    Parameters
    ----------
    kind : {"ball", "cylindrical", "tapered", "spherical"}
    contact_angle : float
        [rad].
    """
    if kind == "ball" and contact_angle:
        return None
    name = "deep groove ball" if kind == "ball" else f"{kind} roller"
    return PermissibleTilt(*_RANGES[kind], name)
