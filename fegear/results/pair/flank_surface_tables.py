"""Tables and values of the result ``flank-surface``.

Figures of the result ``flank-surface``: each quantity from A to E, and over the face where there is one.

Picture in space: the largest pressure that every place on the flanks sees, on a tooth of either gear.
"""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.case.built.pair_surface import PairSurface
from fegear.engine.declared import axis_of, column_of, columns_of, drawn, value_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, HeatMap, Mark, Skin
from fegear.engine.figure.panel import Panel
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.geometry.outline import tooth_outline, turned
from fegear.geometry.pair import MEMBERS, GearPair, Member, specific_sliding
from fegear.results.gear.drawing import LINE_OF_ACTION, path_marks
from fegear.results.pair.flank_surface_data import FlankSurfaceData

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index
    from fegear.contact.wide.loaded import LoadedFlanks


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
        column_of(c, "x"),
        *(Column(f"roll_angle_{m}", np.asarray(pair.roll_angle(x, m)), "deg", f"of the {m} gear") for m in MEMBERS),
        *columns_of(at, "radius_driver", "radius_driven", "relative_radius", "sliding", "sum"),
        *(Column(f"specific_sliding_{m}", specific_sliding(pair, x, m), "", f"of the {m} gear") for m in MEMBERS),
        column_of(c, "line_load", over_face(c.line_load), further=f", {where}"),
        Column("line_load_iso", standard, "N/mm", "with X_Gamma of ISO/TS 6336-20 and all load factors"),
        column_of(c, "pressure", over_face(c.pressure), further=f", {where}"),
        column_of(c, "friction", mean_over_face(c.friction)),
        column_of(c, "flash", over_face(c.flash), further=f", {where}"),
        column_of(c, "contact", over_face(c.contact), meaning=where),
        *columns_of(data.flash, "flash", "contact"),
        column_of(c, "film", over_face(c.film, least=True), meaning=thinnest),
        column_of(c, "ratio", over_face(c.ratio, least=True), further=f", {thinnest}"),
        *columns_of(data.film, "sharing", "nominal", "dynamic"),
        *columns_of(data.film.film, "thickness", "ratio"),
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
    everywhere = {"x": np.broadcast_to(c.x, on.shape), "z": np.broadcast_to(c.z[:, None], on.shape)}
    everywhere |= {key: getattr(c, key) for key in ("line_load", "pressure", "flash", "contact", "film", "ratio")}
    columns = tuple(column_of(c, key, values[on]) for key, values in everywhere.items())
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
        value_of(c, "largest", name, further=f", {_at(hot, data)}"),
        value_of(f, "largest", name),
        value_of(c, "bulk", name),
        value_of(c, "least_ratio", name, further=f", {_at(thin, data)}"),
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


#: The most negative specific sliding that an axis shows.
_MOST_SLIDING = -5.0


#: Films so many times the thinnest one are not drawn: beside unloaded places they have no bound.
_THICKEST = 4.0


def surface_figures(name: str, data: FlankSurfaceData, asked: PairSurface) -> tuple[Figure, ...]:
    """Sliding, load and pressure, temperatures, film; maps over path and face for pairs with a width."""
    under = f"{asked.rated.load:.5g} N, {asked.rated.speed * 30.0 / math.pi:.5g} rpm"
    figures = [
        _sliding(name, data, asked, under), _pressed(name, data, asked, under), _temperatures(name, data, under),
        _films(name, data, asked, under),
    ]  # fmt: skip
    if data.wide:
        figures.append(_maps(name, data, under))
    return tuple(figures)


def _panel(axis: Axis, data: FlankSurfaceData, curves: list[Curve], *extra: Mark) -> Panel:
    return Panel(LINE_OF_ACTION, axis, tuple(curves), (*path_marks(data.pair), *extra))


def _compared(
    data: FlankSurfaceData, key: str, values: Array, standard: Array, label: str, *extra: Mark, zero: bool = True
) -> Panel:
    """The computed curve and the standard's: of a pair with a width the extreme over the face and the mean."""
    c, least = data.computed, key in ("film", "ratio")
    x, iso, y = drawn(c, "x"), drawn(c, key, standard), drawn(c, key, values)
    if data.wide:
        word = "least over the face" if least else "largest over the face"
        curves = [
            Curve(x, over_face(y, least=least), word, "series:0", markers=False, width=2.0),
            Curve(x, mean_over_face(y), "mean over the face", "series:0", dash="dot", markers=False),
        ]
    else:
        curves = [Curve(x, y[0], "computed load", "series:0", markers=False, width=2.0)]
    curves.append(Curve(x, iso, label, "series:1", dash="dash", markers=False))
    return _panel(axis_of(c, key, zero=zero), data, curves, *extra)


def _sliding(name: str, data: FlankSurfaceData, asked: PairSurface, under: str) -> Figure:
    x, pair = data.computed.x, data.pair
    at = asked.rated.at(x)
    speeds = [
        Curve(x * 1e3, at.rolling_driver, "driver", "driver", dash="solid", markers=False),
        Curve(x * 1e3, at.rolling_driven, "driven", "driven", dash="solid", markers=False),
        Curve(x * 1e3, at.sliding, "sliding, driver less driven", "ink", dash="dash", markers=False),
    ]
    shares = [
        Curve(x * 1e3, np.maximum(specific_sliding(pair, x, member), _MOST_SLIDING), member, member, dash="solid",
              markers=False)
        for member in MEMBERS
    ]  # fmt: skip
    radii = [
        Curve(x * 1e3, at.radius_driver * 1e3, "driver", "driver", dash="solid", markers=False),
        Curve(x * 1e3, at.radius_driven * 1e3, "driven", "driven", dash="solid", markers=False),
        Curve(x * 1e3, at.relative_radius * 1e3, "relative radius, normal section", "ink", dash="dash", markers=False),
    ]
    return Figure(
        f"surface_sliding_{name}",
        f"Sliding and curvature of the flanks of pair {name}",
        f"Pair {name}: speed of both flanks through the contact and their difference, specific sliding of either flank "
        "(negative where it is dragged; on the base circle it goes to minus infinity), and radii of curvature. At C "
        "nothing slides.",
        (
            _panel(Axis("speed", "m/s"), data, speeds),
            _panel(Axis("specific sliding ζ"), data, shares),
            _panel(Axis("radius of curvature", "mm", zero=True), data, radii),
        ),
        under=under,
    )


def _pressed(name: str, data: FlankSurfaceData, asked: PairSurface, under: str) -> Figure:
    from fegear.formulas.iso6336.part22_micropitting import pressure

    c, rated = data.computed, asked.rated
    standard = data.flash.load_sharing * rated.line_load
    theirs = pressure(rated.at(c.x), standard, rated.modulus)
    label = "ISO/TS 6336-20, X_{Γ}"
    return Figure(
        f"surface_pressure_{name}",
        f"Load and pressure on the flanks of pair {name}",
        f"Pair {name}: load per face width and Hertzian pressure on a tooth pair from A to E with the load factors: by "
        "the computed load, and by the load sharing factor of the standard.",
        (
            _compared(data, "line_load", c.line_load, standard, label),
            _compared(data, "pressure", c.pressure, theirs, label),
        ),
        under=under,
    )


def _temperatures(name: str, data: FlankSurfaceData, under: str) -> Figure:
    c, f = data.computed, data.flash
    limit = () if math.isnan(data.scuffing) else (Mark("y", data.scuffing, f"scuffing at {data.scuffing:.0f} degC"),)
    return Figure(
        f"surface_temperature_{name}",
        f"Temperature of the flanks of pair {name}",
        f"Pair {name}: rise of the flanks above the teeth while they touch, and contact temperature, from A to E: by "
        f"the computed load (teeth {c.bulk:.4g} degC) and by ISO/TS 6336-20 (teeth {f.bulk:.4g} degC). At C nothing "
        "slides.",
        (
            _compared(data, "flash", c.flash, f.flash, "ISO/TS 6336-20"),
            _compared(data, "contact", c.contact, f.contact, "ISO/TS 6336-20", *limit, zero=False),
        ),
        under=under,
    )


def _films(name: str, data: FlankSurfaceData, asked: PairSurface, under: str) -> Figure:
    c, theirs = data.computed, data.film.film
    limit: tuple[Mark, ...] = ()
    if not math.isnan(data.permissible_film):
        limit = (Mark("y", data.permissible_film, f"permissible {data.permissible_film:.3f}"),)
    top = _THICKEST * min(c.least_ratio, data.least_film[0])
    if limit:
        top = max(top, 1.2 * data.permissible_film)
    rough = asked.rated.surface.roughness

    def thin(values: Array, highest: float) -> Array:
        return np.asarray(np.where(values > highest, np.nan, values))

    def both(key: str, ours: Array, iso: Array, highest: float, *marks: Mark) -> Panel:
        return _compared(data, key, thin(ours, highest), thin(iso, highest), "ISO/TS 6336-22", *marks)

    return Figure(
        f"surface_film_{name}",
        f"Lubricant film between the flanks of pair {name}",
        f"Pair {name}: thickness of the lubricant film and its ratio to the roughness Ra = {rough * 1e6:.3g} um, from "
        f"A to E: by the computed load (teeth {c.film_bulk:.4g} degC) and by ISO/TS 6336-22 (teeth {data.film.bulk:.4g}"
        " degC). Below 1 the flanks touch through the film.",
        (
            both("film", c.film, theirs.thickness, top * rough),
            both("ratio", c.ratio, theirs.ratio, top, *limit),
        ),
        under=under,
    )


def _maps(name: str, data: FlankSurfaceData, under: str) -> Figure:
    c = data.computed
    face, path = c.z * 1e3, c.x * 1e3
    top = _THICKEST * c.least_ratio
    maps = (
        ("contact temperature", "degC", c.contact, "Contact temperature"),
        ("film ratio", "", np.where(c.ratio > top, np.nan, c.ratio), "Film ratio λ_{GF}"),
    )
    marks = tuple(Mark("y", mark.at, mark.label) for mark in path_marks(data.pair))
    panels = tuple(
        Panel(axis_of(c, "z"), LINE_OF_ACTION, (HeatMap(face, path, values.T, label, unit),), marks, title)
        for label, unit, values, title in maps
    )
    return Figure(
        f"surface_map_{name}",
        f"Flank surface of pair {name} over the face",
        f"Pair {name}: contact temperature and film ratio over path and face, by the computed load; blank where "
        "nothing touches.",
        panels,
        under=under,
        columns=2,
    )


#: How far chords of the outline may lie off it [modules], and longest steps on it and along the face.
_CHORD, _STEP, _ALONG = 1e-4, 0.05, 0.1


#: Room between both teeth, of the face width.
_APART = 0.2


#: Where the scale of colours ends: this share of the pressed places has less pressure.
_TOP = 98.0


def flank_pressure_figure(name: str, found: LoadedFlanks, case: int) -> Figure:
    """Draw the driver's tooth on the left and the driven gear's on the right, loaded flanks toward the eye."""
    shift = 0.5 * (1.0 + _APART) * (found.lines.high - found.lines.low)
    parts = [_tooth(found, member, case) for member in MEMBERS]
    moved = [
        points + np.array([[0.0], [parts[0][0][1].max() - points[1].max()], [sign * shift]])
        for sign, (points, _, _) in zip((1, -1), parts, strict=True)
    ]  # side by side with the driver, however different the radii
    count = moved[0].shape[1]
    values = np.concatenate([value for _, _, value in parts]) * 1e-6
    top = float(np.percentile(values[values > 0.0], _TOP)) if (values > 0.0).any() else 1.0
    skin = Skin(
        np.hstack(moved) * 1e3, np.hstack([parts[0][1], parts[1][1] + count]), values, top, "pressure", "MPa"
    )  # fmt: skip
    return Figure(
        f"flank_pressure_{name}",
        f"Pressure on the flanks of pair {name}",
        f"Pair {name}: largest Hertzian pressure that a place on the flank sees as the contact lines pass over it; "
        f"driver on the left, driven gear on the right, +z to the left. The scale of colours ends at {top:.4g} MPa; at "
        "tips and ends of the face the pressure may be higher.",
        (Panel(Axis(), Axis(), (skin,), height=1.0, camera=((1.6, 0.6, 0.0), (0.0, 0.0, 0.0), (0.0, 1.0, 0.0))),),
        under=f"{found.load[case]:.5g} N",
    )


def _tooth(found: LoadedFlanks, member: Member, case: int) -> tuple[Array, Index, Array]:
    """Points (3, N) [m], triangles (3, T) and pressure (N,) [Pa] of a tooth's skin, its loaded flank toward +x."""
    pair, lines = found.pair, found.lines
    gear = pair.gear(member)
    section = _refined(tooth_outline(gear.tooth, _CHORD)) * gear.module
    stations = np.linspace(lines.low, lines.high, max(9, round((lines.high - lines.low) / (_ALONG * gear.module)) + 1))
    layers = [np.vstack([turned(section, -gear.twist * z), np.full(section.shape[1], z)]) for z in stations.tolist()]
    value = _on_flank(found, pair, member, section, stations, case)
    low = float(section[1].min())
    centre = np.array([[0.0], [0.5 * (low + gear.tooth.root_radius * gear.module)]])  # of both ends, inside the tooth
    ends = [np.append(turned(centre, -gear.twist * z).ravel(), z) for z in (stations[0], stations[-1])]
    n, m = section.shape[1], stations.size
    points = np.hstack([*layers, np.array(ends).T])
    return points, _triangles(n, m), np.append(value.ravel(), [np.nan, np.nan])


def _refined(outline: Array) -> Array:
    """The outline with chords no longer than a step [modules], shape (2, N)."""
    parts = [outline[:, :1]]
    for a, b in zip(outline.T[:-1], outline.T[1:], strict=True):
        count = max(1, int(np.ceil(np.hypot(*(b - a)) / _STEP)))
        parts.append(a[:, None] + (b - a)[:, None] * np.arange(1, count + 1) / count)
    return np.hstack(parts)


def _on_flank(found: LoadedFlanks, pair: GearPair, member: Member, section: Array, stations: Array, case: int) -> Array:
    """Pressure at the points of the section at all stations, shape (stations, N)."""
    radius = np.hypot(*section)
    reach = np.sort(pair.radius(np.array([pair.x_start, pair.x_end]), member))
    tip = radius.min() if pair.gear(member).tooth.internal else radius.max()
    corner = int(np.flatnonzero(np.isclose(radius, tip, rtol=1e-9, atol=0.0))[-1])  # the outline goes on down the flank
    low, high = reach * np.array([1.0 - 1e-9, 1.0 + 1e-9])
    on = corner + np.flatnonzero((radius[corner:] >= low) & (radius[corner:] <= high))
    on = on[section[0, on] > 0.0]
    value = np.full((stations.size, radius.size), np.nan)  # nothing presses on the rest of the tooth
    x = pair.x_of_radius(np.clip(radius[on], *reach), member)
    order = np.argsort(x)
    value[:, on[order]] = found.spread(x[order], stations, found.pressure[:, :, case])
    return value


def _triangles(n: int, m: int) -> Index:
    """Of m layers of n points, and of fans over both ends about two more points, shape (3, T)."""
    first = (np.arange(m - 1)[:, None] * n + np.arange(n - 1)).ravel()
    sides = [np.stack([first, first + 1, first + n]), np.stack([first + 1, first + n + 1, first + n])]
    edge = np.arange(n - 1)
    fans = [
        np.stack([edge + start, edge + start + 1, np.full(n - 1, m * n + k)]) for k, start in ((0, 0), (1, (m - 1) * n))
    ]
    return np.hstack([*sides, *fans])
