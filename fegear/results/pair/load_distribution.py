"""Stage ``load-distribution``: line load and pressure over the flanks of gears with a width, and what they sum to."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.base.notes import exceeding
from fegear.base.printed import percent
from fegear.case.built.solid_influence import check_ends
from fegear.contact.error_over_pitch import ErrorOverPitch
from fegear.contact.loaded_teeth import LoadHistory
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.figure import DeferredFigure
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import LOADS, Chart, Family, Line, Map, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Off, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage
from fegear.results import forecasts
from fegear.results.forecasts import HERTZ, INVOLUTE, RING
from fegear.results.pair.flank_pressure import flank_pressure_figure
from fegear.results.pair.load_over_flanks import LoadOverFlanks
from fegear.results.pair.loaded_flanks import loaded_flanks, needs_flanks
from fegear.results.pair.loaded_teeth import gears_of

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.contact.wide.loaded import LoadedFlanks


#: Begins the names of what a pair's plane teeth have, too.
_WIDE = "wide_"
#: Contact lines that are drawn: all there are.
_ALL = 1000
#: K_Hbeta above this part of the largest that its averaging allows is remarked on.
_OF_MOST = 0.5


@dataclass(frozen=True)
class LoadDistributionInputs:
    """What is read of the case besides the loaded flanks.

    Parameters
    ----------
    name : str
        Of the pair.
    also : str
        Begins the names of numbers that a pair has by its other results, too, where these load plane teeth.
    """

    name: str = field(compare=False)
    also: str = field(compare=False)


def _inputs(scene: Scene, name: str) -> LoadDistributionInputs:
    return LoadDistributionInputs(name, "" if name in scene.wide_pairs else _WIDE)


def _station(key: str) -> Cell:
    """What the contact lines know of every station."""
    return Cell(f"found.lines.{key}", lambda seen: seen.data.stations.of_lines(key))


def _over_loads(key: str, further: str = "") -> tuple[Cell, Off]:
    """A number of the whole base pitch under every load, with its error."""
    return (
        Cell(key, f"pair.stated.{key}", "pair.error", further=further),
        Off(key, f"pair.error.{key}", "estimated error", "pair.error"),
    )


def _stated(key: str, meaning: str = "") -> Number:
    """The same at the nominal load."""
    return Number(key, f"pair.error.{key}", "pair.error", f"pair.stated.{key}", meaning=meaning)


def _also(of: type, key: str, si: str, error: str, further: str = "") -> Number:
    """A number that a pair has by its other results, too."""
    return Number(key, error, lambda _: of, si, name=f"{{asked.also}}{key}", further=further)


_DRAWN_LINE = {"dash": "solid", "markers": False}
_DASHED = {"dash": "dash", "markers": False}
_FACE_TITLE = "Load distribution over the face width of pair {name}"
_TABLES = (
    Rows(
        "load_distribution_{name}", "Line load and pressure on the flanks of pair {name}",
        (
            "position", *(_station(key) for key in ("roll", "pair", "x", "z")),
            Cell("found.line_load", "stations.line_load"), Cell("found.pressure", "stations.pressure"), "half_width",
            "active", Cell("found.lines.at_edge", lambda seen: seen.data.stations.of_lines("at_edge").astype(float)),
        ),
        of="stations",
    ),
    Rows(
        "load_over_face_{name}", _FACE_TITLE,
        (
            Cell("found.lines.z", "over_face.z"), "found.mean_over_face",
            Cell("found.over_face", "over_face.least", name="least_line_load"),
            Cell("found.over_face", "over_face.largest", name="largest_line_load"), "factor",
        ),
        of="over_face",
    ),
    Rows(
        "load_distribution_roll_{name}", "Load shares and transmission error of pair {name}",
        (
            "pair.found.lines.roll", "pair.found.transmission_error",
            Off("pair.found.transmission_error", "over_roll.te_error"), "unloaded", "mesh_stiffness",
            Each(
                "over_roll.shares", Cell("share", name="share_{one.number}", further=" {one.number}"),
                Off("share", "error", "estimated error", name="share_{one.number}"),
            ),
            "pair.found.equilibrium",
        ),
        of="over_roll",
    ),
    Rows(
        "load_distribution_loads_{name}", "Pair {name} for every load",
        (
            Cell("total_load", "pair.found.load", lambda _: ErrorOverPitch, name="load"),
            *_over_loads("mean", " over a base pitch"), *_over_loads("peak_to_peak"), *_over_loads("face_load_factor"),
        ),
    ),
)  # fmt: skip
_VALUES = (
    _also(ErrorOverPitch, "te_mean", "pair.stated.mean", "pair.error.mean"),
    _also(ErrorOverPitch, "te_peak_to_peak", "pair.stated.peak_to_peak", "pair.error.peak_to_peak"),
    _stated(
        "face_load_factor",
        "largest load per face width over the mean one, averaged over a base pitch and over 1/{d.cells} of the face: "
        "at most {d.cells}",
    ),
    _stated("largest_line_load"),
    _also(
        LoadHistory, "largest_hertz_pressure", "pair.largest.pressure", "pair.largest.pressure_error",
        ", {d.pair.largest.place}",
    ),
    _also(LoadHistory, "largest_share", "pair.largest.share", "pair.largest.share_error"),
)  # fmt: skip
_FIGURES = (
    Chart(
        "load_distribution_{name}", "Line load over the plane of action of pair {name}",
        "Pair {name}: line load as the contact line moves from the driver's root (left) to its tip (right), and "
        "contact lines at {d.plane.count} roll positions. The colour scale ends at {d.plane.top:.4g}; tips and "
        "face ends may exceed it.",
        (
            Over(
                "lines.x",
                (
                    Map("load", "z", "x", limits=lambda seen: (0.0, seen.data.plane.top)),
                    Line(
                        "z", x="x", look={**_DRAWN_LINE, "width": 0.8},
                        each=Family("plane.drawn", "", "ink", most=_ALL),
                    ),
                ),
                "lines.z", panel={"height": 1.4},
            ),
        ),
        of="plane", under="{load:said}",
    ),
    Chart(
        "load_over_face_{name}", _FACE_TITLE,
        "Pair {name}: load of all contact lines together per face width; K_Hβ = {d.over_face.face_load_factor:.4g}.",
        (
            Over(
                "found.lines.z",
                (
                    Line(
                        "load", x="z", look={**_DRAWN_LINE, "width": 1.2},
                        each=Family("over_face.at_rolls", "roll {one.roll:.3g}", "ramp"),
                    ),
                    Line(
                        "found.mean_over_face", "mean over a base pitch", "ink", x="z",
                        look={**_DRAWN_LINE, "width": 2.4},
                    ),
                    Line("even", "load / face width", "grey", x="z", look=_DASHED, ends=True),
                ),
                "found.over_face", options={"zero": True},
            ),
        ),
        of="over_face", under="{load:said}",
    ),
    Chart(
        "load_over_face_loads_{name}", "Load distribution over the face width of pair {name} for every load",
        "Pair {name}: line load, averaged over a base pitch, relative to its mean; the maximum is K_Hβ.",
        (
            Over(
                "found.lines.z",
                (
                    Line("relative", x="z", each=LOADS, look=_DRAWN_LINE),
                    Line("one", "even", "grey", x="z", look=_DASHED, ends=True),
                ),
                options={"zero": True},
            ),
        ),
        of="over_face", when=lambda seen: len(seen.loads) > 1,
    ),
)  # fmt: skip


def _in_space(seen: Seen) -> tuple[DeferredFigure, ...]:
    """Pressure on a tooth of either gear."""
    made = partial(flank_pressure_figure, seen.name, seen.data.pair.over.found, seen.data.pair.at)
    return (DeferredFigure(f"flank_pressure_{seen.name}", f"Pressure on the flanks of pair {seen.name}", made),)


def _remarks(seen: Seen) -> list[str]:
    """What edges and ends carry, and where the averaging over the face bounds K_Hbeta."""
    name, found, i = seen.name, seen.data.pair.found, seen.data.pair.at
    lines, load = found.lines, found.line_load[:, :, i]
    remarks = []
    if (edge := float(np.where(lines.at_edge, load, 0.0).max())) > 0.0:
        tips = lines.edges is not None
        remarks.append(
            f"Pair {name}: "
            + ("sharp tip edges carry" if tips else "contact lines end at tip or form circles with")
            + f" up to {edge * 1e-3:.4g} N/mm. Pressure at a sharp edge is singular (it rises with the number of "
            "panels) and is excluded from largest_hertz_pressure. "
            + (
                "Specify tip_radius_rounding for a finite pressure."
                if tips
                else "Specify tip relief, or set effects.corner_contact = true."
            )
        )
    if lines.edges is not None:
        gap = np.where(load > 0.0, lines.edges.gap, 0.0)
        on = (found.contact.force[:, :, i] * (lines.edges.gap > 0.0)).sum(axis=1) / found.load[i]
        remarks.append(
            f"Pair {name}: corner contact carries up to {percent(float(on.max()))} of the load, "
            f"{percent(float(found.lines.mean(on)))} on average over a base pitch, gap outside the path of contact "
            f"up to {float(gap.max()) * 1e6:.3g} um."
        )
    ends = np.isclose(np.abs(lines.z), lines.high, rtol=1e-9) & lines.present
    if (end := float(np.where(ends, load, 0.0).max())) > 0.0:
        remarks.append(
            f"Pair {name}: line load up to {end * 1e-3:.4g} N/mm at the face ends (sharp edge; mean over the last "
            "half panel)."
        )
    active = (found.contact.force[:, :, i] > 0.0).sum() / lines.present.sum()
    if active < 1.0:
        remarks.append(f"Pair {name}: no contact at {percent(1.0 - active)} of the points on the contact lines.")
    return [*remarks, *limit_remarks(name, found, i)]


def limit_remarks(name: str, found: LoadedFlanks, i: int) -> tuple[str, ...]:
    """Where a load stands on so little of the face that the averaging of K_Hbeta bounds it."""
    largest, most = float(found.face_load_factor[i]), found.cells.size - 1
    if largest < _OF_MOST * most:
        return ()
    width = float(found.cells[1] - found.cells[0])
    said = exceeding(
        f"Pair {name}: K_Hbeta is {largest:.4g}, the maximum that can be resolved ({most}): line loads are averaged "
        f"over {width * 1e3:.4g} mm of face width (half a module or less). A larger misalignment or crown increases "
        "largest_line_load and largest_hertz_pressure, not K_Hbeta."
    )
    return (said,)


def distributed_pairs(scene: Scene) -> tuple[str, ...]:
    """All pairs that carry a load and are not plane by their key; all where none is, so that it is reported."""
    loaded = [name for name, pair in scene.pairs.items() if scene.case.pair[name].normal_load(pair) is not None]
    return tuple(name for name in loaded if scene.case.pair[name].width != "plane") or tuple(loaded or scene.pairs)


#: Stage of a result that stands on a load distributed over the face.
flank_stage = partial(Stage, subjects=distributed_pairs, needs=needs_flanks)


def _check(scene: Scene, name: str) -> None:
    if scene.case.pair[name].width == "plane":
        raise InputError(
            f"pair.{name}.width", '"plane"', 'contradicts results = ["load-distribution"] (3D)',
            'set width = "solid" or "slices", or remove it',
        )  # fmt: skip
    for gear in gears_of(scene, name).values():
        check_ends(scene, gear, distributed_pairs(scene))


def _forecast(_scene: Scene, _name: str) -> Forecast:
    return forecasts.constant(0.05)


_SHEET = Sheet(
    of=lambda data, _asked: LoadOverFlanks(data),
    loads="pair.loads",
    nominal="pair.at",
    tables=_TABLES,
    values=_VALUES,
    figures=(*_FIGURES, _in_space),
    remarks=(_remarks,),
    settings={"equilibrium": "equilibrium"},
    answer=Answer(
        "Pair {name}: K_Hβ {v[K_Hbeta]}, maximum line load {v[largest_line_load]}.",
        "Pair {name}: maximum Hertzian pressure {v[largest_hertz_pressure]}.",
        "Pair {name}: transmission error {v[te_peak_to_peak]} peak to peak, mean {v[te_mean]}.",
        figure="load_over_face_{name}",
        rank=lambda seen: -seen.data.pair.stated.face_load_factor[seen.nominal],
        among="the largest of {count} pairs",
    ),
)


LOAD_DISTRIBUTION = flank_stage(
    inputs=_inputs,
    compute=lambda inputs, upstream, _work: loaded_flanks(upstream, inputs.name),
    present=_SHEET.present,
    check=_check,
    cites=citing(*RING, HERTZ, INVOLUTE, Citation("johnson", "half-space under the contacts", "sections 3.2 and 4.2")),
    forecast=_forecast,
)
