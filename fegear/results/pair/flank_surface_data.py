"""What a flank surface study has found, and how it is shown: along the path, factors, safeties."""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.engine.sheet.load_words import load_words
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.path_of_contact import specific_sliding

if TYPE_CHECKING:
    from fegear.case.built.pair_surface import PairSurface
    from fegear.contact.surface import FlankSurface
    from fegear.formulas.flank_speeds import FlankSpeeds
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


#: Films so many times the thinnest one are not drawn: beside unloaded places they have no bound.
_THICKEST = 4.0
#: What is least where it matters; of everything else the largest is.
_LEAST = ("film", "ratio")


def over_face(values: Array, *, least: bool = False) -> Array:
    """Largest (or least) value over the face at every place on the path; NaN where nothing touches."""
    filled = np.where(np.isnan(values), np.inf if least else -np.inf, values)
    found = filled.min(axis=0) if least else filled.max(axis=0)
    return np.asarray(np.where(np.isfinite(found), found, np.nan))


def mean_over_face(values: Array) -> Array:
    """Mean over those places of the face that touch."""
    on = np.isfinite(values)
    total = np.where(on, values, 0.0).sum(axis=0)
    return np.asarray(np.where(on.any(axis=0), total / np.maximum(on.sum(axis=0), 1), np.nan))


@dataclass(frozen=True)
class SurfaceFactor:
    """A factor with its clause, its number in the unit of the standards."""

    symbol: str = shown("", "symbol", name="factor")
    value: float = shown("", "value, in the unit of the next column")
    unit: str = shown("", "unit", name="in")
    clause: str = shown("", "reference")


@dataclass(frozen=True)
class SurfaceSafeties:
    """Safeties against scuffing and micropitting; None where the case gives no test."""

    flash: float | None = shown("", "safety factor for scuffing, flash temperature, FE load", name="S_B")
    flash_iso: float | None = shown(
        "",
        "safety factor for scuffing, flash temperature, X_Gamma and all load factors of the standard",
        name="S_B_iso",
    )
    integral: float | None = shown("", "safety factor for scuffing, mean flash temperature, FE load", name="S_intS")
    integral_iso: float | None = shown("", "safety factor for scuffing, integral temperature", name="S_intS_iso")
    film: float | None = shown("", "safety factor for micropitting, FE load", name="S_lambda")
    film_iso: float | None = shown("", "safety factor for micropitting, ISO/TS 6336-22 method B", name="S_lambda_iso")


@dataclass(frozen=True)
class ShownSurface:
    """Flanks of a pair with what they are rated by."""

    data: FlankSurfaceData
    asked: PairSurface

    @property
    def computed(self) -> FlankSurface:
        """By the computed load."""
        return self.data.computed

    @cached_property
    def at(self) -> FlankSpeeds:
        """Speeds and radii along the path."""
        return self.asked.rated.at(self.computed.x)

    @property
    @shows("deg", "roll angle of the driver")
    def roll_angle_driver(self) -> Array:
        """[rad]."""
        return np.asarray(self.data.pair.roll_angle(self.computed.x, "driver"))

    @property
    @shows("deg", "roll angle of the driven gear")
    def roll_angle_driven(self) -> Array:
        """[rad]."""
        return np.asarray(self.data.pair.roll_angle(self.computed.x, "driven"))

    @property
    @shows("", "specific sliding of the driver")
    def specific_sliding_driver(self) -> Array:
        """Along the path."""
        return specific_sliding(self.data.pair, self.computed.x, "driver")

    @property
    @shows("", "specific sliding of the driven gear")
    def specific_sliding_driven(self) -> Array:
        """Along the path."""
        return specific_sliding(self.data.pair, self.computed.x, "driven")

    @property
    @shows("N/mm", "with X_Gamma of ISO/TS 6336-20 and all load factors")
    def line_load_iso(self) -> Array:
        """[N/m]."""
        return np.asarray(self.data.flash.load_sharing * self.asked.rated.line_load)

    @property
    def largest_at(self) -> str:
        """What the largest number at a place on the path is."""
        return "maximum over the face width" if self.data.wide else "FE load"

    @property
    def least_at(self) -> str:
        """What the least one is."""
        return "minimum over the face width" if self.data.wide else "FE load"

    def extreme(self, key: str) -> Array:
        """What counts of a quantity at every place on the path."""
        return over_face(getattr(self.computed, key), least=key in _LEAST)

    def mean(self, key: str) -> Array:
        """Mean of a quantity over the face."""
        return mean_over_face(getattr(self.computed, key))

    def _over_width(self, key: str) -> Array | None:
        return self.mean(key) if self.data.wide else None

    @property
    @shows("N/mm", "over the face width in contact")
    def line_load_mean(self) -> Array | None:
        """[N/m]; None of plane teeth."""
        return self._over_width("line_load")

    @property
    @shows("K", "over the face width")
    def flash_temperature_mean(self) -> Array | None:
        """None of plane teeth."""
        return self._over_width("flash")

    @property
    @shows("", "lambda_GF, over the face width")
    def film_ratio_mean(self) -> Array | None:
        """None of plane teeth."""
        return self._over_width("ratio")

    def touching(self, key: str) -> Array:
        """A quantity where the flanks touch, in rows."""
        c = self.computed
        on = np.isfinite(c.line_load)
        values = {"x": c.x, "z": c.z[:, None]}.get(key, getattr(c, key))
        return np.broadcast_to(values, on.shape)[on]

    # ---- what is drawn

    @property
    def top(self) -> float:
        """Largest film ratio that is drawn beside the standard's."""
        least = _THICKEST * min(self.computed.least_ratio, self.data.least_film[0])
        return least if math.isnan(self.data.permissible_film) else max(least, 1.2 * self.data.permissible_film)

    def _thin(self, key: str, values: Array) -> Array:
        """Without films that are too thick to be drawn."""
        if key not in _LEAST:
            return values
        most = self.top * (self.roughness if key == "film" else 1.0)
        return np.asarray(np.where(values > most, np.nan, values))

    def drawn_extreme(self, key: str) -> Array:
        """What counts of a quantity along the path, as far as it is drawn."""
        values = self._thin(key, getattr(self.computed, key))
        return over_face(values, least=key in _LEAST) if self.data.wide else values[0]

    def drawn_mean(self, key: str) -> Array | None:
        """Its mean over the face; None of plane teeth."""
        return mean_over_face(self._thin(key, getattr(self.computed, key))) if self.data.wide else None

    def drawn_standard(self, key: str) -> Array:
        """What the standards have for it."""
        from fegear.formulas.iso6336.part22_micropitting import pressure

        if key == "line_load":
            return self.line_load_iso
        if key == "pressure":
            return pressure(self.at, self.line_load_iso, self.asked.rated.modulus)
        theirs = self.data.flash if key in ("flash", "contact") else self.data.film.film
        return self._thin(key, getattr(theirs, {"film": "thickness"}.get(key, key)))

    @property
    @shows("", "specific film thickness")
    def mapped_ratio(self) -> Array:
        """Film ratio over the path and the face, as far as it is drawn, shape (X, Z)."""
        ratio = self.computed.ratio
        return np.where(ratio > _THICKEST * self.computed.least_ratio, np.nan, ratio).T

    @property
    @shows("um", "roughness of the flanks")
    def roughness(self) -> float:
        """Ra [m]."""
        return self.asked.rated.surface.roughness

    @property
    def under(self) -> str:
        """Load and speed that figures hold for."""
        return f"{load_words(self.asked.rated.load)}, {self.asked.rated.speed * 30.0 / math.pi:.5g} rpm"

    # ---- single numbers

    @property
    @shows("m/s", "at A or E")
    def largest_sliding_velocity(self) -> float:
        """[m/s]."""
        pair = self.data.pair
        return float(np.abs(self.asked.rated.at(np.array([pair.x_start, pair.x_end])).sliding).max())

    @property
    @shows("", "of each flank")
    def least_specific_sliding(self) -> float:
        """At A or E."""
        pair = self.data.pair
        return min(float(specific_sliding(pair, x, m)) for x in (pair.x_start, pair.x_end) for m in MEMBERS)

    @property
    @shows("", "lambda_GF,min of ISO/TS 6336-22")
    def least_film_ratio_iso(self) -> float:
        """By the standard."""
        return self.data.least_film[0]

    @property
    @shows("degC", "ISO/TS 6336-21")
    def integral_temperature_iso(self) -> float | None:
        """None outside its range."""
        return None if self.data.integral is None else self.data.integral.integral

    def _place(self, values: Array, *, least: bool = False) -> str:
        x, z = self.computed.place(values, least=least)
        return f"at x = {x * 1e3:.4g} mm" + (f", z = {z * 1e3:.4g} mm" if self.data.wide else "")

    @property
    def hottest(self) -> str:
        """Where the flanks are hottest, in words."""
        return self._place(self.computed.contact)

    @property
    def thinnest(self) -> str:
        """Where the film is thinnest, in words."""
        return self._place(self.computed.ratio, least=True)

    @property
    def thinnest_iso(self) -> str:
        """The point at which it is by the standard."""
        return self.data.least_film[1]

    @property
    def safeties(self) -> SurfaceSafeties:
        """By the computed load and by the standards."""
        from fegear.formulas.iso6336 import part20_flash, part21_integral

        data, c, oil = self.data, self.computed, self.asked.rated.surface.temperature
        flash = flash_iso = own = integral = film = film_iso = None
        if not math.isnan(data.scuffing):
            flash = part20_flash.safety(data.scuffing, c.largest, oil)
            flash_iso = part20_flash.safety(data.scuffing, data.flash.largest, oil)
        if data.integral is not None and not math.isnan(data.scuffing_integral):
            heat = c.mean_flash if self.asked.friction else c.mean_flash * data.integral.friction / data.flash.friction
            computed = part21_integral.computed_integral(self.asked.rated, heat)
            own = part21_integral.safety(data.scuffing_integral, computed)
            integral = part21_integral.safety(data.scuffing_integral, data.integral.integral)
        if not math.isnan(data.permissible_film):
            film, film_iso = c.least_ratio / data.permissible_film, data.least_film[0] / data.permissible_film
        return SurfaceSafeties(flash, flash_iso, own, integral, film, film_iso)

    @property
    def factors(self) -> list[SurfaceFactor]:
        """Every factor with its clause."""
        from fegear.formulas.flash_temperature import STEEL_HEAT
        from fegear.formulas.iso6336 import part22_micropitting

        data, asked = self.data, self.asked
        r, f, i, oil = asked.rated, data.flash, data.integral, asked.rated.surface.oil
        warm = r.surface.temperature
        rows: list[tuple[str, float, str, str]] = [
            ("K_A K_gamma", r.factors.application, "", "ISO 6336-1, clause 5"),
            ("K_v", r.factors.dynamic, "", "ISO 6336-1, clause 6"),
            ("K_Hbeta", r.factors.face, "", "ISO 6336-1, clause 7"),
            ("K_Halpha", r.factors.transverse, "", "ISO 6336-1, clause 8"),
            ("w_Bt", r.unit_load * 1e-3, "N/mm", "ISO/TR 13989-1, Eq. 11"),
            ("v_t", r.pitch_line_speed, "m/s", "ISO/TR 13989-1, clause 5"),
            ("E_r", r.modulus * 1e-6, "N/mm^2", "ISO/TR 13989-1, Eq. A.10"),
            ("Ra", r.surface.roughness * 1e6, "um", "mean of both flanks"),
            ("nu_oil", float(oil.kinematic(warm)) * 1e6, "mm^2/s", "ASTM D341, at the oil temperature"),
            ("eta_oil", float(oil.dynamic(warm)) * 1e3, "mPa s", "ISO/TR 15144-1, Formula 16"),
            ("X_L", oil.factor, "", "base oil"),
            ("B_M", STEEL_HEAT / math.sqrt(1e6), "N/(mm s^0.5 K)", "of steel, for scuffing and micropitting"),
            ("X_S", r.supply, "", "ISO/TR 13989-1, Eq. 22"),
            ("X_W", r.structure, "", "ISO/TR 13989-1, Table 2"),
            ("C_eff", f.optimal_relief * 1e6, "um", "ISO/TR 13989-1, Eq. B.1"),
            ("C_a driver", r.tip_relief[0] * 1e6, "um", "from the case, or from running-in"),
            ("C_a driven", r.tip_relief[1] * 1e6, "um", "from the case, or from running-in"),
            ("mu_m", f.friction, "", "ISO/TR 13989-1, Eq. 25"),
            ("X_J,max", float(f.approach.max()), "", "ISO/TR 13989-1, Eqs. 45 to 48"),
            ("Theta_flm", f.mean_flash, "K", "ISO/TR 13989-1, Eq. 24"),
            ("Theta_M", f.bulk, "degC", "ISO/TR 13989-1, Eq. 22"),
            ("Theta_Bmax", f.largest, "degC", "ISO/TR 13989-1, Eq. 2"),
            ("Theta_S", data.scuffing, "degC", "ISO/TR 13989-1, Eq. 99"),
        ]
        if i is not None:
            rows += [
                ("mu_mC", i.friction, "", "ISO/TR 13989-2, Eq. 1"),
                ("K_Bgamma", i.helical, "", "ISO/TR 13989-2, Eq. 5"),
                ("X_M", i.thermal, "K N^-0.75 s^0.5 m^-0.5 mm", "ISO/TR 13989-2, Eq. 11"),
                ("X_alphabeta", i.angle, "", "ISO/TR 13989-2, Eq. 13"),
                ("X_BE", i.geometry, "", "ISO/TR 13989-2, Eq. 22"),
                ("X_Q", i.approach, "", "ISO/TR 13989-2, Eqs. 25 to 29"),
                ("X_Ca", i.relief, "", "ISO/TR 13989-2, Eqs. 32 to 38"),
                ("X_epsilon", i.contact_ratio, "", "ISO/TR 13989-2, Eqs. 39 to 45"),
                ("theta_flaE", i.at_tip, "K", "ISO/TR 13989-2, Eq. 19"),
                ("theta_flaint", i.mean, "K", "ISO/TR 13989-2, Eq. 18"),
                ("theta_M", i.bulk, "degC", "ISO/TR 13989-2, Eq. 20"),
                ("theta_int", i.integral, "degC", "ISO/TR 13989-2, Eq. 17"),
                ("theta_intS", data.scuffing_integral, "degC", "ISO/TR 13989-2, Eq. 94"),
            ]
        rows += [
            ("mu_m", data.film.friction, "", "ISO/TR 15144-1, Formula 86"),
            ("H_v", part22_micropitting.loss_factor(data.pair), "", "ISO/TR 15144-1, Formulae 91 and 92"),
            ("X_Ca", part22_micropitting.relief_factor(r), "", "ISO/TR 15144-1, Formulae 100 and 101"),
            ("theta_M", data.film.bulk, "degC", "ISO/TR 15144-1, Formula 84"),
            ("alpha_thetaM", float(oil.pressure_viscosity(data.film.bulk)) * 1e9, "1/GPa", "ISO/TR 15144-1, Formula 8"),
            ("eta_thetaM", float(oil.dynamic(data.film.bulk)) * 1e3, "mPa s", "ISO/TR 15144-1, Formula 16"),
            ("W_W", asked.tests.material_factor, "", "ISO/TR 15144-1, clause 5, steels of both flanks"),
            ("lambda_GF,min", data.least_film[0], "", f"ISO/TR 15144-1, 8.2, at {data.least_film[1]}"),
            ("lambda_GFP", data.permissible_film, "", "ISO/TR 15144-1, clause 5"),
        ]
        return [SurfaceFactor(*row) for row in rows]
