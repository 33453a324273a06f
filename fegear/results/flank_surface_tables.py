"""Tables and values of the result ``flank-surface``."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.outcome import Column, Table, Value
from fegear.geometry.pair import MEMBERS
from fegear.geometry.path_of_contact import specific_sliding

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.models.pair_surface import PairSurface
    from fegear.results.flank_surface import FlankSurfaceData


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


def surface_tables(name: str, data: FlankSurfaceData, asked: PairSurface) -> tuple[Table, ...]:
    """Along the path, over the face where the pair has a width, and every factor with its clause."""
    tables = [_path(name, data, asked)]
    if data.wide:
        tables.append(_face(name, data))
    return (*tables, _factors(name, data, asked))


def _path(name: str, data: FlankSurfaceData, asked: PairSurface) -> Table:
    c, x, pair = data.computed, data.computed.x, data.pair
    at = asked.rated.at(x)
    standard = np.asarray(data.flash.load_sharing * asked.rated.line_load)
    where = "largest over the face" if data.wide else "by the computed load"
    thinnest = "least over the face" if data.wide else "by the computed load"
    columns = [
        Column("x", x, "mm", "on the line of action, from the pitch point"),
        *(Column(f"roll_angle_{m}", np.asarray(pair.roll_angle(x, m)), "deg", f"of the {m} gear") for m in MEMBERS),
        Column("radius_driver", at.radius_driver, "mm", "radius of curvature of the driver's flank"),
        Column("radius_driven", at.radius_driven, "mm", "of the driven gear's flank"),
        Column("relative_radius", at.relative_radius, "mm", "of both in the normal section"),
        Column("sliding_velocity", at.sliding, "m/s", "of the driver's flank on the driven one"),
        Column("sum_velocity", at.sum, "m/s", "of both flanks through the contact"),
        *(Column(f"specific_sliding_{m}", specific_sliding(pair, x, m), "", f"of the {m} gear") for m in MEMBERS),
        Column("line_load", over_face(c.line_load), "N/mm", f"with load factors, {where}"),
        Column("line_load_iso", standard, "N/mm", "with X_Gamma of ISO/TS 6336-20 and all load factors"),
        Column("hertz_pressure", over_face(c.pressure), "MPa", f"with load factors, {where}"),
        Column("friction", mean_over_face(c.friction), "", "coefficient with which heat is computed"),
        Column("flash_temperature", over_face(c.flash), "K", f"rise above the teeth, {where}"),
        Column("contact_temperature", over_face(c.contact), "degC", where),
        Column("flash_temperature_iso", data.flash.flash, "K", "ISO/TS 6336-20, rise above the teeth"),
        Column("contact_temperature_iso", data.flash.contact, "degC", "ISO/TS 6336-20"),
        Column("film_thickness", over_face(c.film, least=True), "um", thinnest),
        Column("film_ratio", over_face(c.ratio, least=True), "", f"lambda_GF, {thinnest}"),
        Column("load_sharing_iso", data.film.sharing, "", "X_Y of ISO/TS 6336-22"),
        Column("hertz_pressure_nominal_iso", data.film.nominal, "MPa", "p_H,Y of ISO/TS 6336-22, no load factors"),
        Column("hertz_pressure_iso", data.film.dynamic, "MPa", "p_dyn,Y of ISO/TS 6336-22, all load factors"),
        Column("film_thickness_iso", data.film.film.thickness, "um", "h_Y of ISO/TS 6336-22"),
        Column("film_ratio_iso", data.film.film.ratio, "", "lambda_GF,Y of ISO/TS 6336-22"),
    ]
    if data.wide:
        columns += [
            Column("line_load_mean", mean_over_face(c.line_load), "N/mm", "over the face where it touches"),
            Column("flash_temperature_mean", mean_over_face(c.flash), "K", "over the face"),
            Column("film_ratio_mean", mean_over_face(c.ratio), "", "lambda_GF, over the face"),
        ]
    return Table(f"flank_surface_{name}", tuple(columns), f"Flanks of pair {name} along the path of contact")


def _face(name: str, data: FlankSurfaceData) -> Table:
    c = data.computed
    on = np.isfinite(c.line_load)
    x, z = np.broadcast_to(c.x, on.shape), np.broadcast_to(c.z[:, None], on.shape)
    columns = (
        Column("x", x[on], "mm", "on the line of action, from the pitch point"),
        Column("z", z[on], "mm", "along the face, from its middle"),
        Column("line_load", c.line_load[on], "N/mm", "with load factors"),
        Column("hertz_pressure", c.pressure[on], "MPa", "with load factors"),
        Column("flash_temperature", c.flash[on], "K", "rise above the teeth"),
        Column("contact_temperature", c.contact[on], "degC", ""),
        Column("film_thickness", c.film[on], "um", ""),
        Column("film_ratio", c.ratio[on], "", "lambda_GF"),
    )
    return Table(f"flank_surface_over_face_{name}", columns, f"Flanks of pair {name} over path and face")


def _factors(name: str, data: FlankSurfaceData, asked: PairSurface) -> Table:
    """Every factor with its clause; numbers in the units of the standards."""
    from fegear.formulas.flash_temperature import STEEL_HEAT
    from fegear.formulas.iso6336 import part22_micropitting

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
        ("B_M", STEEL_HEAT / math.sqrt(1e6), "N/(mm s^.5 K)", "of steel, for scuffing and micropitting"),
        ("X_S", r.supply, "", "ISO/TR 13989-1, Eq. 22"),
        ("X_W", r.structure, "", "ISO/TR 13989-1, Table 2"),
        ("C_eff", f.optimal_relief * 1e6, "um", "ISO/TR 13989-1, Eq. B.1"),
        ("C_a driver", r.tip_relief[0] * 1e6, "um", "of the case, or of running in"),
        ("C_a driven", r.tip_relief[1] * 1e6, "um", "of the case, or of running in"),
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
            ("X_M", i.thermal, "K N^-.75 s^.5 m^-.5 mm", "ISO/TR 13989-2, Eq. 11"),
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
        ("W_W", asked.tests.material_factor, "", "ISO/TR 15144-1, clause 5, of both flanks' steels"),
        ("lambda_GF,min", data.least_film[0], "", f"ISO/TR 15144-1, 8.2, at {data.least_film[1]}"),
        ("lambda_GFP", data.permissible_film, "", "ISO/TR 15144-1, clause 5"),
    ]
    symbols, values, units, clauses = zip(*rows, strict=True)
    columns = (
        Column("factor", np.array(symbols), "", "symbol"),
        Column("value", np.array(values), "", "in the unit of the next column"),
        Column("in", np.array(units), "", "unit"),
        Column("clause", np.array(clauses), "", "where it stands"),
    )
    return Table(f"surface_factors_{name}", columns, f"Factors of scuffing and micropitting of pair {name}")


def surface_values(name: str, data: FlankSurfaceData, asked: PairSurface) -> tuple[Value, ...]:
    """Largest and least of everything, and safeties by the computed load and by the standards."""
    from fegear.formulas.iso6336 import part20_flash, part21_integral

    c, f, pair = data.computed, data.flash, data.pair
    oil = asked.rated.surface.temperature
    at = asked.rated.at(np.array([pair.x_start, pair.x_end]))
    least = min(float(specific_sliding(pair, x, m)) for x in (pair.x_start, pair.x_end) for m in MEMBERS)
    hot, thin = c.place(c.contact), c.place(c.ratio, least=True)
    found = [
        Value(f"{name}.largest_sliding_velocity", float(np.abs(at.sliding).max()), "m/s", 0.0, "at A or E"),
        Value(f"{name}.least_specific_sliding", least, "", 0.0, "of either flank"),
        Value(f"{name}.largest_contact_temperature", c.largest, "degC", None, f"computed load, {_at(hot, data)}"),
        Value(f"{name}.largest_contact_temperature_iso", f.largest, "degC", None, "ISO/TS 6336-20"),
        Value(f"{name}.bulk_temperature", c.bulk, "degC", None, "of the teeth, computed load, as ISO/TS 6336-20"),
        Value(f"{name}.least_film_ratio", c.least_ratio, "", None, f"lambda_GF,min, computed load, {_at(thin, data)}"),
        Value(f"{name}.least_film_ratio_iso", data.least_film[0], "", None,
              f"lambda_GF,min of ISO/TS 6336-22, at {data.least_film[1]}"),
    ]  # fmt: skip
    if data.integral is not None:
        found.append(Value(f"{name}.integral_temperature_iso", data.integral.integral, "degC", None, "ISO/TS 6336-21"))
    if not math.isnan(data.scuffing):
        found += [
            Value(f"{name}.S_B", part20_flash.safety(data.scuffing, c.largest, oil), "", None,
                  "against scuffing by the flash temperature, computed load"),
            Value(f"{name}.S_B_iso", part20_flash.safety(data.scuffing, f.largest, oil), "", None,
                  "the same with X_Gamma and all load factors of the standard"),
        ]  # fmt: skip
    if data.integral is not None and not math.isnan(data.scuffing_integral):
        safety = part21_integral.safety(data.scuffing_integral, data.integral.integral)
        heat = c.mean_flash if asked.friction else c.mean_flash * data.integral.friction / data.flash.friction
        own = part21_integral.computed_integral(asked.rated, heat)
        found += [
            Value(f"{name}.S_intS", part21_integral.safety(data.scuffing_integral, own), "", None,
                  "against scuffing by the mean flash temperature, computed load"),
            Value(f"{name}.S_intS_iso", safety, "", None, "against scuffing by the integral temperature"),
        ]  # fmt: skip
    if not math.isnan(data.permissible_film):
        found += [
            Value(f"{name}.S_lambda", c.least_ratio / data.permissible_film, "", None,
                  "against micropitting, computed load"),
            Value(f"{name}.S_lambda_iso", data.least_film[0] / data.permissible_film, "", None,
                  "against micropitting, ISO/TS 6336-22 method B"),
        ]  # fmt: skip
    return tuple(found)


def _at(place: tuple[float, float], data: FlankSurfaceData) -> str:
    along = f"at x = {place[0] * 1e3:.4g} mm"
    return f"{along}, z = {place[1] * 1e3:.4g} mm" if data.wide else along
