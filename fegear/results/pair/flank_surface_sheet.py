"""The sheet of the result ``flank-surface``: tables along the path and of factors, values, figures from A to E."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np

from fegear.engine.figure.axis import Axis
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.chart import Chart, Line, Map, Over
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.seen import Seen
from fegear.results.gear.path_marks import LINE_OF_ACTION, path_marks

#: The most negative specific sliding that an axis shows.
_MOST_SLIDING = -5.0


def _extreme(key: str, meaning: str = "", further: str = "") -> Cell:
    """What counts of a quantity over the face."""
    return Cell(f"computed.{key}", lambda seen: seen.data.extreme(key), meaning=meaning, further=further)


def _touching(key: str) -> Cell:
    """A quantity at every place of path and face that touches."""
    return Cell(f"computed.{key}", lambda seen: seen.data.touching(key))


_AT, _LEAST = "{d.largest_at}", "{d.least_at}"
TABLES = (
    Rows(
        "flank_surface_{name}", "Flanks of pair {name} along the path of contact",
        (
            "computed.x", "roll_angle_driver", "roll_angle_driven",
            *(f"at.{key}" for key in ("radius_driver", "radius_driven", "relative_radius", "sliding", "sum")),
            "specific_sliding_driver", "specific_sliding_driven", _extreme("line_load", further=f", {_AT}"),
            "line_load_iso", _extreme("pressure", further=f", {_AT}"),
            Cell("computed.friction", lambda seen: seen.data.mean("friction")), _extreme("flash", further=f", {_AT}"),
            _extreme("contact", _AT), "data.flash.flash", "data.flash.contact", _extreme("film", _LEAST),
            _extreme("ratio", further=f", {_LEAST}"),
            *(f"data.film.{key}" for key in ("sharing", "nominal", "dynamic", "film.thickness", "film.ratio")),
            "line_load_mean", "flash_temperature_mean", "film_ratio_mean",
        ),
    ),
    Rows(
        "flank_surface_over_face_{name}", "Flanks of pair {name} over path of contact and face width",
        tuple(_touching(key) for key in ("x", "z", "line_load", "pressure", "flash", "contact", "film", "ratio")),
        when="data.wide",
    ),
    Rows(
        "surface_factors_{name}", "Factors of scuffing and micropitting of pair {name}",
        ("symbol", "value", "unit", "clause"), of="factors",
    ),
)  # fmt: skip
VALUES = (
    Number("largest_sliding_velocity", exact),
    Number("least_specific_sliding", exact),
    Number("computed.largest", further=", {d.hottest}"),
    Number("data.flash.largest"),
    Number("computed.bulk"),
    Number("computed.least_ratio", further=", {d.thinnest}"),
    Number("least_film_ratio_iso", further=", at {d.thinnest_iso}"),
    Number("integral_temperature_iso"),
    *(
        Number(f"safeties.{key}")
        for key in ("flash", "flash_iso", "integral", "integral_iso", "film", "film_iso")
    ),
)  # fmt: skip


def _path(seen: Seen) -> tuple[Mark, ...]:
    return path_marks(seen.data.data.pair)


def _along(axis: Axis, *lines: Line) -> Over:
    """Curves from A to E."""
    return Over(LINE_OF_ACTION, lines, axis, marks=_path)


def _speed(key: str, label: str, role: str, dash: str = "solid") -> Line:
    """A speed or a radius of curvature."""
    return Line(f"at.{key}", label, role, x="computed.x", look={"dash": dash, "markers": False})


def _shares(member: str) -> Line:
    """Specific sliding of one flank, as far as it is drawn."""
    return Line(
        f"specific_sliding_{member}", member, member, x="computed.x", look={"dash": "solid", "markers": False},
        si=lambda seen: np.maximum(getattr(seen.data, f"specific_sliding_{member}"), _MOST_SLIDING),
    )  # fmt: skip


def _extreme_word(key: str) -> Callable[[Seen], str]:
    """What the computed curve is of a quantity, in the legend."""

    def word(seen: Seen) -> str:
        if not seen.data.data.wide:
            return "computed load"
        return "minimum over the face width" if key in ("film", "ratio") else "maximum over the face width"

    return word


def _compared(
    key: str, standard: str, *, zero: bool = True, limit: Callable[[Seen], tuple[Mark, ...]] | None = None
) -> Over:
    """The computed curve and the standard's: of a pair with a width the extreme over the face and the mean."""
    quantity, x = f"computed.{key}", "computed.x"
    return Over(
        LINE_OF_ACTION,
        (
            Line(
                quantity, _extreme_word(key), "series:0", x=x, look={"markers": False, "width": 2.0},
                si=lambda seen: seen.data.drawn_extreme(key),
            ),
            Line(
                quantity, "mean over the face width", "series:0", x=x, look={"dash": "dot", "markers": False},
                si=lambda seen: seen.data.drawn_mean(key),
            ),
            Line(
                quantity, standard, "series:1", x=x, look={"dash": "dash", "markers": False},
                si=lambda seen: seen.data.drawn_standard(key),
            ),
        ),
        quantity, options={"zero": zero},
        marks=lambda seen: (*_path(seen), *(() if limit is None else limit(seen))),
    )  # fmt: skip


def _scuffing(seen: Seen) -> tuple[Mark, ...]:
    """The scuffing temperature, where the case gives a test."""
    limit = seen.data.data.scuffing
    return () if math.isnan(limit) else (Mark("y", limit, f"scuffing at {limit:.0f} degC"),)


def _permissible(seen: Seen) -> tuple[Mark, ...]:
    """The permissible film ratio, where the case gives a test."""
    limit = seen.data.data.permissible_film
    return () if math.isnan(limit) else (Mark("y", limit, f"permissible {limit:.3f}"),)


def _over_face(quantity: str, title: str, **options: Any) -> Over:
    """A map over path and face."""
    return Over(
        "computed.z", (Map(quantity, "computed.x", **options),), LINE_OF_ACTION, title=title,
        marks=lambda seen: tuple(Mark("y", mark.at, mark.label) for mark in _path(seen)),
    )  # fmt: skip


_UNDER, _STANDARD, _FLASH, _FILM = "{d.under}", "ISO/TS 6336-20, X_{{Γ}}", "ISO/TS 6336-20", "ISO/TS 6336-22"
FIGURES = (
    Chart(
        "surface_sliding_{name}", "Sliding velocity and radius of curvature, pair {name}",
        "Pair {name}: speed of both flanks through the contact and their difference, specific sliding of both flanks "
        "(negative in the dedendum, tends to minus infinity at the base circle), and radii of curvature. No sliding "
        "at C.",
        (
            _along(
                Axis("speed", "m/s"), _speed("rolling_driver", "driver", "driver"),
                _speed("rolling_driven", "driven", "driven"),
                _speed("sliding", "sliding velocity, driver minus driven", "ink", "dash"),
            ),
            _along(Axis("specific sliding ζ"), _shares("driver"), _shares("driven")),
            _along(
                Axis("radius of curvature", "mm", zero=True), _speed("radius_driver", "driver", "driver"),
                _speed("radius_driven", "driven", "driven"),
                _speed("relative_radius", "relative radius of curvature, normal section", "ink", "dash"),
            ),
        ),
        under=_UNDER,
    ),
    Chart(
        "surface_pressure_{name}", "Load and pressure on the flanks of pair {name}",
        "Pair {name}: line load and Hertzian pressure of a tooth pair from A to E including load factors: FE load "
        "sharing and load sharing factor of the standard.",
        (_compared("line_load", _STANDARD), _compared("pressure", _STANDARD)),
        under=_UNDER,
    ),
    Chart(
        "surface_temperature_{name}", "Temperature of the flanks of pair {name}",
        "Pair {name}: flash temperature (rise above the bulk temperature) and contact temperature, from A to E: by the "
        "computed load (bulk temperature {d.computed.bulk:.4g}) and by ISO/TS 6336-20 ({d.data.flash.bulk:.4g}). "
        "No sliding at C.",
        (_compared("flash", _FLASH), _compared("contact", _FLASH, zero=False, limit=_scuffing)),
        under=_UNDER,
    ),
    Chart(
        "surface_film_{name}", "Lubricant film between the flanks of pair {name}",
        "Pair {name}: thickness of the lubricant film and its ratio to the roughness Ra = {d.roughness:.3g!} um, from "
        "A to E: by the computed load (bulk temperature {d.computed.film_bulk:.4g}) and by ISO/TS 6336-22 "
        "({d.data.film.bulk:.4g}). Below 1 the flanks are in contact through the film.",
        (_compared("film", _FILM), _compared("ratio", _FILM, limit=_permissible)),
        under=_UNDER,
    ),
    Chart(
        "surface_map_{name}", "Flank surface of pair {name} over the face width",
        "Pair {name}: contact temperature and specific film thickness over path of contact and face width, FE load; "
        "blank: no contact.",
        (
            _over_face("computed.contact", "Contact temperature", si=lambda seen: seen.data.computed.contact.T),
            _over_face("mapped_ratio", "Film ratio λ_{{GF}}"),
        ),
        when="data.wide", under=_UNDER, columns=2,
    ),
)  # fmt: skip
