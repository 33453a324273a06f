"""Figures of the result ``flank-surface``: each quantity from A to E, and over the face where there is one."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Curve, Figure, HeatMap, Mark, Panel
from fegear.geometry.pair import MEMBERS
from fegear.geometry.path_of_contact import specific_sliding
from fegear.results.drawn_pair import LINE_OF_ACTION, path_marks
from fegear.results.flank_surface_tables import mean_over_face, over_face

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.models.pair_surface import PairSurface
    from fegear.results.flank_surface import FlankSurfaceData

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


def _panel(label: str, unit: str, data: FlankSurfaceData, curves: list[Curve], *extra: Mark, zero: bool = False,
           limits: tuple[float, float] | None = None) -> Panel:  # fmt: skip
    marks = (*path_marks(data.pair), *extra)
    return Panel(LINE_OF_ACTION, Axis(label, unit, zero=zero, limits=limits), tuple(curves), marks)


def _computed(data: FlankSurfaceData, values: Array, *, least: bool = False) -> list[Curve]:
    """The computed curve: of a plane pair one, of a pair with a width the extreme over the face and the mean."""
    x = data.computed.x * 1e3
    if not data.wide:
        return [Curve(x, values[0], "computed load", "series:0", markers=False, width=2.0)]
    word = "least over the face" if least else "largest over the face"
    return [
        Curve(x, over_face(values, least=least), word, "series:0", markers=False, width=2.0),
        Curve(x, mean_over_face(values), "mean over the face", "series:0", dash="dot", markers=False),
    ]


def _iso(data: FlankSurfaceData, values: Array, label: str) -> Curve:
    return Curve(data.computed.x * 1e3, values, label, "series:1", dash="dash", markers=False)


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
            _panel("speed", "m/s", data, speeds),
            _panel("specific sliding ζ", "", data, shares),
            _panel("radius of curvature", "mm", data, radii, zero=True),
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
            _panel("line load", "N/mm", data,
                   [*_computed(data, c.line_load * 1e-3), _iso(data, standard * 1e-3, label)], zero=True),
            _panel("Hertzian pressure", "MPa", data,
                   [*_computed(data, c.pressure * 1e-6), _iso(data, theirs * 1e-6, label)], zero=True),
        ),
        under=under,
    )  # fmt: skip


def _temperatures(name: str, data: FlankSurfaceData, under: str) -> Figure:
    c, f = data.computed, data.flash
    limit = () if math.isnan(data.scuffing) else (Mark("y", data.scuffing, f"scuffing at {data.scuffing:.0f} degC"),)
    contact = [*_computed(data, c.contact), _iso(data, f.contact, "ISO/TS 6336-20")]
    flash = [*_computed(data, c.flash), _iso(data, f.flash, "ISO/TS 6336-20")]
    return Figure(
        f"surface_temperature_{name}",
        f"Temperature of the flanks of pair {name}",
        f"Pair {name}: rise of the flanks above the teeth while they touch, and contact temperature, from A to E: by "
        f"the computed load (teeth {c.bulk:.4g} degC) and by ISO/TS 6336-20 (teeth {f.bulk:.4g} degC). At C nothing "
        "slides.",
        (
            _panel("flash temperature", "K", data, flash, zero=True),
            _panel("contact temperature", "degC", data, contact, *limit),
        ),
        under=under,
    )


def _films(name: str, data: FlankSurfaceData, asked: PairSurface, under: str) -> Figure:
    c = data.computed
    limit: tuple[Mark, ...] = ()
    if not math.isnan(data.permissible_film):
        limit = (Mark("y", data.permissible_film, f"permissible {data.permissible_film:.3f}"),)
    top = _THICKEST * min(c.least_ratio, data.least_film[0])
    if limit:
        top = max(top, 1.2 * data.permissible_film)
    rough = asked.rated.surface.roughness

    def shown(values: Array, highest: float) -> Array:
        return np.asarray(np.where(values > highest, np.nan, values))

    ratio = [
        *_computed(data, shown(c.ratio, top), least=True),
        _iso(data, shown(data.film.film.ratio, top), "ISO/TS 6336-22"),
    ]
    thick = [
        *_computed(data, shown(c.film, top * rough) * 1e6, least=True),
        _iso(data, shown(data.film.film.thickness, top * rough) * 1e6, "ISO/TS 6336-22"),
    ]
    return Figure(
        f"surface_film_{name}",
        f"Lubricant film between the flanks of pair {name}",
        f"Pair {name}: thickness of the lubricant film and its ratio to the roughness Ra = {rough * 1e6:.3g} um, from "
        f"A to E: by the computed load (teeth {c.film_bulk:.4g} degC) and by ISO/TS 6336-22 (teeth {data.film.bulk:.4g}"
        " degC). Below 1 the flanks touch through the film.",
        (
            _panel("film thickness", "um", data, thick, zero=True),
            _panel("film ratio λ_{GF}", "", data, ratio, *limit, zero=True),
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
        Panel(
            Axis("face position z", "mm"), LINE_OF_ACTION, (HeatMap(face, path, values.T, label, unit),), marks, title
        )
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
