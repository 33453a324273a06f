"""What a flank surface study has found, for its tables and pictures."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.geometry.pair import GearPair

if TYPE_CHECKING:
    from fegear.contact.surface import FlankSurface
    from fegear.formulas.iso6336.part20_flash import FlashTemperatures
    from fegear.formulas.iso6336.part21_integral import IntegralTemperature
    from fegear.formulas.iso6336.part22_micropitting import RatedFilm


@dataclass(frozen=True)
class FlankSurfaceData:
    """Flanks of a pair by computed load and by the standards.

    Parameters
    ----------
    pair : GearPair
    computed : FlankSurface
    wide : bool
        Whether the load is that over the face.
    flash : FlashTemperatures
        ISO/TS 6336-20 with its own load sharing, at the same places.
    film : RatedFilm
        ISO/TS 6336-22, at the same places.
    least_film : (float, str)
        Its lambda_GF,min, and at which point.
    integral : IntegralTemperature or None
        ISO/TS 6336-21; None outside its range.
    scuffing, scuffing_integral : float
        Theta_S and theta_intS [degC]; NaN where the case gives no test.
    permissible_film : float
        lambda_GFP; NaN where the case gives no test.
    share_outside : float
        Largest share of the load that tip corners bear off the path.
    why_not : str
        Why there is no integral temperature.
    """

    pair: GearPair
    computed: FlankSurface
    wide: bool
    flash: FlashTemperatures
    film: RatedFilm
    least_film: tuple[float, str]
    integral: IntegralTemperature | None
    scuffing: float
    scuffing_integral: float
    permissible_film: float
    share_outside: float
    why_not: str
