"""State of the flanks where they touch: pressure, flash and contact temperature, film, from the computed load.

The formulas of ISO/TS 6336-20 and -22 at every place, with the load that was computed there in place of the standard's
load sharing factors.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.formulas.flank_speeds import FlankSpeeds
from fegear.formulas.flash_temperature import flash_temperature
from fegear.formulas.iso6336 import part20_flash, part22_micropitting
from fegear.formulas.iso6336.rated import RatedSurface

FrictionLaw = Callable[[FlankSpeeds, Array], Array]


@dataclass(frozen=True)
class FlankSurface:
    """Flanks over the path, x of shape (X,), and the face, z of shape (Z,); the rest (Z, X), NaN where nothing touches.

    A plane section has one z; the film is compared with the roughness.
    """

    x: Array = shown("mm", "on the line of action, from the pitch point")
    z: Array = shown("mm", "face position from mid-face", label="face position z")
    line_load: Array = shown("N/mm", "with load factors", label="line load")
    pressure: Array = shown("MPa", "with load factors", name="hertz_pressure", label="Hertzian pressure")
    friction: Array = shown("", "coefficient of friction used for frictional heat")
    flash: Array = shown(
        "K", "flash temperature (rise above bulk temperature)", name="flash_temperature", label="flash temperature"
    )
    contact: Array = shown("degC", name="contact_temperature", label="contact temperature")
    film: Array = shown("um", name="film_thickness", label="film thickness")
    ratio: Array = shown("", "lambda_GF", name="film_ratio", label="specific film thickness λ_{GF}")
    bulk: float = shown("degC", "bulk temperature of the teeth, FE load, to ISO/TS 6336-20", name="bulk_temperature")
    film_bulk: float = shown("degC", "bulk temperature of the teeth, for the film")
    mean_flash: float = shown("K", "mean over path of contact and face width")

    @property
    @shows("degC", "FE load", name="largest_contact_temperature")
    def largest(self) -> float:
        """Largest contact temperature [degC]."""
        return max(self.bulk, float(np.nanmax(self.contact)))

    @property
    @shows("", "lambda_GF,min, FE load", name="least_film_ratio")
    def least_ratio(self) -> float:
        """Least film ratio."""
        return float(np.nanmin(self.ratio))

    def place(self, values: Array, *, least: bool = False) -> tuple[float, float]:
        """x and z of the largest (or least) value [m]."""
        find = np.nanargmin if least else np.nanargmax
        row, column = np.unravel_index(int(find(values)), values.shape)
        return float(self.x[column]), float(self.z[row])


def flank_surface(
    rated: RatedSurface,
    x: Array,
    z: Array,
    line_load: Array,
    law: FrictionLaw | None = None,
    losses: float | None = None,
) -> FlankSurface:
    """Evaluate the flanks under a computed load.

    Parameters
    ----------
    rated : RatedSurface
        Its load is not used but in mean friction coefficients and the bulk temperature of the film.
    x : ndarray, shape (X,)
        Rising, on the path of contact [m].
    z : ndarray, shape (Z,)
        Along the face [m].
    line_load : ndarray, shape (Z, X)
        With load factors [N/m]; NaN where nothing is known.
    law : callable, optional
        Friction law; without one the mean coefficients of either standard.
    losses : float, optional
        Computed loss factor H_V for the bulk temperature of the film; that of the standard without.
    """
    at, modulus = rated.at(x), rated.modulus
    load = np.atleast_2d(line_load)
    touch = np.where(np.nan_to_num(load) > 0.0, load, np.nan)
    known = np.nan_to_num(load)
    mu_heat = np.full(load.shape, part20_flash.friction(rated)) if law is None else law(at, known)
    mu_film = np.full(load.shape, part22_micropitting.friction(rated)) if law is None else mu_heat
    flash = flash_temperature(at, known, mu_heat, modulus)
    mean = float(np.trapezoid(flash.mean(axis=0), x) / (x[-1] - x[0]))
    bulk = part20_flash.bulk_temperature(rated, mean)
    factor = part22_micropitting.loss_factor(rated.pair) if losses is None else losses
    weight = known.sum()
    film_bulk = part22_micropitting.bulk_temperature(
        rated, float((mu_film * known).sum() / weight) if weight > 0.0 else 0.0, factor
    )
    pressed = part22_micropitting.pressure(at, known, modulus)
    film = part22_micropitting.film(rated.surface, at, pressed, mu_film, film_bulk, modulus)
    on = np.isfinite(touch)

    def where(values: Array) -> Array:
        return np.asarray(np.where(on, values, np.nan))

    return FlankSurface(
        x, z, where(known), where(pressed), where(np.asarray(mu_heat)), where(flash), where(bulk + flash),
        where(film.thickness), where(film.ratio), bulk, film_bulk, mean,
    )  # fmt: skip
