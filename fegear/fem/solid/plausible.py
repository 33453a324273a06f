"""Which solid gears make no sense or cannot be meshed."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

from fegear.errors import RangeError

if TYPE_CHECKING:
    from fegear.fem.solid.settings import SolidSettings
    from fegear.geometry.tooth import Tooth

#: Widest and narrowest face that is solved [modules]: wider ones take polynomials of a degree and matrices of a size
#: beyond reason, on narrower ones no contact has room.
_WIDEST, _NARROWEST = 60.0, 0.2
#: Of a width that is a length over a module: .6 mm of 3 mm is .2 modules.
_ROUND_OFF = 1e-9
#: Steepest helix at the tip [rad]: the flank runs along the tooth no longer.
_STEEPEST = math.radians(60.0)
#: Highest degree along the face.
_HIGHEST_DEGREE = 100
#: The shortest part of the width on which a bore is held.
_SHORTEST_HELD = 0.02


def check_solid(
    section: Tooth,
    tau: float,
    width: float,
    poisson_ratio: float,
    settings: SolidSettings,
    held: tuple[float, float] | None,
    reach: int,
) -> None:
    """Refuse widths, twists and held parts that cannot be meshed or make no sense; arguments as of `solid_influence`.

    Raises
    ------
    RangeError
    """
    if not (1.0 - _ROUND_OFF) * _NARROWEST <= width <= (1.0 + _ROUND_OFF) * _WIDEST:
        raise RangeError(
            "face_width", f"{width:.12g} modules", f"must lie between {_NARROWEST:g} and {_WIDEST:g} modules",
            "treat a narrower gear as plane, and shorten a wider one to the part that carries the load",
        )  # fmt: skip
    steepest = math.tan(_STEEPEST) / section.tip_radius
    if not abs(tau) <= steepest:
        angle = math.degrees(math.atan(tau * section.tip_radius)) if math.isfinite(tau) else tau
        raise RangeError(
            "helix_angle", f"{angle:.6g} degrees at the tip", f"must stay below {math.degrees(_STEEPEST):g} degrees"
        )
    if not -1.0 < poisson_ratio < 0.5:
        raise RangeError("poisson_ratio", poisson_ratio, "must lie between -1 and 0.5")
    if settings.degree(width) > _HIGHEST_DEGREE:
        raise RangeError(
            "accuracy.waves_per_module", settings.waves_per_module,
            f"asks for polynomials of degree {settings.degree(width)} along a face of {width:.6g} modules; "
            f"{_HIGHEST_DEGREE} is what can be solved", "lower it, or shorten the face",
        )  # fmt: skip
    if reach < 0:
        raise RangeError("reach", reach, "must be at least 0: so many teeth to either side are known")
    if held is None:
        return
    low, high = held
    half = 0.5 * width * (1.0 + 1e-9)
    if not -half <= low < high <= half or high - low < _SHORTEST_HELD * width:
        raise RangeError(
            "held", f"({low:.6g}, {high:.6g}) modules",
            f"must be a part of the face, from {-0.5 * width:.6g} to {0.5 * width:.6g} modules, and at least "
            f"{_SHORTEST_HELD:.0%} of it",
        )  # fmt: skip
