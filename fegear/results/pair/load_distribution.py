"""Stage ``load-distribution``: line load and pressure over the flanks of gears with a width, and what they sum to.

Figures of loaded flanks: line load over the plane of action with contact lines, and load over the face.
"""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.case.built.solid_influence import check_ends
from fegear.contact.error_over_pitch import ErrorOverPitch
from fegear.contact.loaded_teeth import LoadHistory
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of, column_of, error_column, value_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import DeferredFigure, Figure
from fegear.engine.figure.items import Curve, HeatMap, few, ramp
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results import forecasts
from fegear.results.forecasts import HERTZ, INVOLUTE, RING
from fegear.results.pair.flank_surface_tables import flank_pressure_figure
from fegear.results.pair.loaded_flanks import loaded_flanks, needs_flanks
from fegear.results.pair.loaded_teeth import drawn_loads, gears_of

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.contact.wide.loaded import LoadedFlanks
    from fegear.contact.wide.loaded_pair import LoadedWidePair


#: Begins the names of what a pair's plane teeth have, too.
_WIDE = "wide_"
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


def _stations(name: str, found: LoadedFlanks, i: int) -> Table:
    """Every station of every contact line."""
    lines = found.lines
    on = lines.present
    position = np.broadcast_to(np.arange(1, lines.roll.size + 1)[:, None], on.shape)
    roll = np.broadcast_to(lines.roll[:, None], on.shape)
    load, pressure = found.line_load[:, :, i], found.pressure[:, :, i]
    width = found.known.half_width(found.line_load)[:, :, i]
    columns = (
        Column("position", position[on], "", "number of the roll position"),
        column_of(lines, "roll", roll[on]),
        *(column_of(lines, key, getattr(lines, key)[on]) for key in ("pair", "x", "z")),
        column_of(found, "line_load", load[on]),
        column_of(found, "pressure", pressure[on]),
        Column("half_width", width[on], "um", "of the contact that goes with it"),
        Column("active", (load > 0.0)[on].astype(float), "", "1 where the flanks touch"),
        column_of(lines, "at_edge", lines.at_edge[on].astype(float)),
    )
    return Table(f"load_distribution_{name}", columns, f"Line load and pressure on the flanks of pair {name}")


def _over_face(name: str, found: LoadedFlanks, i: int) -> Table:
    ends, whole = found.cells, found.over_face[:, :, i]
    mean = float(found.load[i] / (ends[-1] - ends[0]))
    columns = (
        column_of(found.lines, "z", 0.5 * (ends[1:] + ends[:-1])),
        column_of(found, "mean_over_face", load=i),
        column_of(found, "over_face", whole.min(axis=0), name="least_line_load"),
        column_of(found, "over_face", whole.max(axis=0), name="largest_line_load"),
        Column("factor", found.mean_over_face[:, i] / mean, "", "mean_line_load over load per face width"),
    )
    return Table(f"load_over_face_{name}", columns, f"Load over the face of pair {name}")


def _positions(name: str, data: LoadedWidePair) -> Table:
    found, i = data.found, data.at
    columns = [
        column_of(found.lines, "roll"),
        te := column_of(found, "transmission_error", load=i),
        error_column(te, data.error.transmission_error[:, i]),
        Column("te_unloaded", data.unloaded, "um", "of rigid flanks: what is left of te as the load goes to zero"),
        Column("mesh_stiffness", found.contact.stiffness[:, i], "N/um", "of the stations that touch: tangent"),
    ]
    for j, share, error in zip(found.pair_numbers.tolist(), found.share[:, :, i], data.error.share[:, :, i],
                               strict=True):  # fmt: skip
        columns += [
            Column(f"share_{j}", share, "", f"of the load on pair {j}"),
            Column(f"share_{j}_error", error, "", "estimated error"),
        ]
    columns.append(column_of(found, "equilibrium", load=i))
    return Table(f"load_distribution_roll_{name}", tuple(columns), f"Shares and transmission error of pair {name}")


def _loads(name: str, data: LoadedWidePair) -> Table:
    columns = [column_of(ErrorOverPitch, "total_load", data.found.load, name="load")]
    for key, further in (("mean", " over a base pitch"), ("peak_to_peak", ""), ("face_load_factor", "")):
        stated = column_of(data.error, key, getattr(data.stated, key), further=further)
        columns += [stated, error_column(stated, getattr(data.error, key), "estimated error")]
    return Table(f"load_distribution_loads_{name}", tuple(columns), f"Pair {name} under every load")


def _present(data: LoadedWidePair, inputs: LoadDistributionInputs) -> Outcome:
    name, found, i = inputs.name, data.found, data.at
    stated, largest, cells = data.stated, data.largest, found.cells.size - 1
    averaged = (
        f"largest load per face width over the mean one, averaged over a base pitch and over 1/{cells} of the "
        f"face: at most {cells}"
    )

    def of_pitch(key: str, meaning: str = "") -> Value:
        number, off = float(getattr(stated, key)[i]), float(getattr(data.error, key)[i])
        return value_of(data.error, key, name, off, si=number, meaning=meaning)

    def also(of: type, key: str, si: float, off: float, further: str = "") -> Value:
        return value_of(of, key, name, off, si=si, name=f"{inputs.also}{key}", further=further)

    error = data.error
    values: tuple[Value, ...] = (
        also(ErrorOverPitch, "te_mean", float(stated.mean[i]), float(error.mean[i])),
        also(ErrorOverPitch, "te_peak_to_peak", float(stated.peak_to_peak[i]), float(error.peak_to_peak[i])),
        of_pitch("face_load_factor", meaning=averaged),
        of_pitch("largest_line_load"),
        also(LoadHistory, "largest_hertz_pressure", largest.pressure, largest.pressure_error, f", {largest.place}"),
        also(LoadHistory, "largest_share", largest.share, largest.share_error),
    )
    whole = data.over.found
    tables = (_stations(name, found, i), _over_face(name, whole, i), _positions(name, data), _loads(name, data))
    figures = load_distribution_figures(name, whole, i)
    settings = {"equilibrium": float(found.equilibrium.max())}
    return Outcome(data, tables, values, settings, tuple(_remarks(name, data)), figures)


def _remarks(name: str, data: LoadedWidePair) -> list[str]:
    found, i = data.found, data.at
    lines, load = found.lines, found.line_load[:, :, i]
    remarks = []
    if (edge := float(np.where(lines.at_edge, load, 0.0).max())) > 0.0:
        tips = lines.edges is not None
        remarks.append(
            f"Pair {name}: "
            + ("sharp tip edges carry" if tips else "contact lines end at tips or form circles under")
            + f" up to {edge * 1e-3:.4g} N/mm. A sharp edge has no largest pressure: the value next to it grows with "
            "the number of panels, and largest_hertz_pressure excludes it. "
            + (
                "Round the tips (tip_radius_rounding) to give it one."
                if tips
                else "Relieve the tips, or set effects.corner_contact = true for what their edges carry."
            )
        )
    if lines.edges is not None:
        gap = np.where(load > 0.0, lines.edges.gap, 0.0)
        on = (found.contact.force[:, :, i] * (lines.edges.gap > 0.0)).sum(axis=1) / found.load[i]
        remarks.append(
            f"Pair {name}: tip edges carry up to {float(on.max()):.2%} of the load, {float(found.lines.mean(on)):.2%} "
            f"on the average over a base pitch, and touch up to {float(gap.max()) * 1e6:.3g} um beyond the path."
        )
    ends = np.isclose(np.abs(lines.z), lines.high, rtol=1e-9) & lines.present
    if (end := float(np.where(ends, load, 0.0).max())) > 0.0:
        remarks.append(
            f"Pair {name}: the ends of the face carry up to {end * 1e-3:.4g} N/mm. They are sharp; what is "
            "stated there is an average over the last half panel."
        )
    active = (found.contact.force[:, :, i] > 0.0).sum() / lines.present.sum()
    if active < 1.0:
        remarks.append(f"Pair {name}: {1.0 - active:.1%} of the stations on the contact lines do not touch.")
    return [*remarks, *limit_remarks(name, found, i)]


def limit_remarks(name: str, found: LoadedFlanks, i: int) -> tuple[str, ...]:
    """Where a load stands on so little of the face that the averaging of K_Hbeta bounds it."""
    largest, most = float(found.face_load_factor[i]), found.cells.size - 1
    if largest < _OF_MOST * most:
        return ()
    width = float(found.cells[1] - found.cells[0])
    said = (
        f"Pair {name}: K_Hbeta is {largest:.4g}, and cannot exceed {most}: loads per face width are averaged over "
        f"{width * 1e3:.4g} mm of it, half a module or less, and all of the load may stand on so little. A larger "
        "misalignment or crown shows in largest_line_load and largest_hertz_pressure, not in K_Hbeta."
    )
    return (said,)


def distributed_pairs(scene: Scene) -> tuple[str, ...]:
    """All pairs that carry a load and are not plane by their key; all where none is, so that it is reported."""
    loaded = [name for name, pair in scene.pairs.items() if scene.case.pair[name].normal_load(pair) is not None]
    return tuple(name for name in loaded if scene.case.pair[name].width != "plane") or tuple(loaded or scene.pairs)


#: Stage of a result that stands on a load distributed over the face.
flank_stage = partial(Stage, subjects=distributed_pairs, needs=needs_flanks, internal=True)


def _check(scene: Scene, name: str) -> None:
    if scene.case.pair[name].width == "plane":
        raise InputError(
            f"pair.{name}.width", '"plane"', 'contradicts results = ["load-distribution"], which is over the face',
            'write width = "solid" or "slices", or remove it',
        )  # fmt: skip
    for gear in gears_of(scene, name).values():
        check_ends(scene, gear, distributed_pairs(scene))


def _forecast(_scene: Scene, _name: str) -> Forecast:
    return forecasts.constant(0.05)


#: Points of the maps along the line of action and along the face.
_ACROSS, _ALONG = 121, 81


#: Roll positions that are drawn, and where the scale of colours ends: this share of the places bears less.
_DRAWN, _TOP = 4, 99.7


def load_distribution_figures(name: str, found: LoadedFlanks, case: int) -> tuple[Figure | DeferredFigure, ...]:
    """Describe all figures of one pair under one of its loads."""
    pressure = DeferredFigure(
        f"flank_pressure_{name}", f"Pressure on the flanks of pair {name}",
        partial(flank_pressure_figure, name, found, case),
    )  # fmt: skip
    several = (_over_face_loads(name, found, case),) if found.load.size > 1 else ()
    return _over_plane(name, found, case), _drawn_over_face(name, found, case), *several, pressure


def _over_plane(name: str, found: LoadedFlanks, case: int) -> Figure:
    pair, lines = found.pair, found.lines
    x = np.linspace(pair.x_start, pair.x_end, _ACROSS)
    z = np.linspace(lines.low, lines.high, _ALONG)
    load = found.over_plane(x, z, case) * 1e-3
    top = float(np.nanpercentile(load, _TOP))
    items: list[HeatMap | Curve] = [HeatMap(x * 1e3, z * 1e3, load, "line load", "N/mm", limits=(0.0, top))]
    start, pitch = float(lines.roll[0]), pair.base_pitch
    drawn = [int(np.abs(lines.roll - start - (k + 0.5) * pitch / _DRAWN).argmin()) for k in range(_DRAWN)]
    items += [
        Curve(lines.x[p, s] * 1e3, lines.z[p, s] * 1e3, "", "ink", dash="solid", width=0.8, markers=False)
        for p in sorted(set(drawn))
        for s in lines.at(p)
    ]
    return Figure(
        f"load_distribution_{name}",
        f"Line load over the plane of action of pair {name}",
        f"Pair {name}: line load as the contact line moves from the driver's root (left) to its tip (right), and "
        f"contact lines at {len(set(drawn))} roll positions. The scale of colours ends at {top:.4g} N/mm; tips and "
        "ends of the face may bear more.",
        (Panel(axis_of(lines, "x"), axis_of(lines, "z"), tuple(items), height=1.4),),
        under=f"{found.load[case]:.5g} N",
    )


def _drawn_over_face(name: str, found: LoadedFlanks, case: int) -> Figure:
    ends, whole = found.cells * 1e3, found.over_face[:, :, case] * 1e-3
    z = 0.5 * (ends[1:] + ends[:-1])
    mean = float(found.load[case] / (found.lines.high - found.lines.low)) * 1e-3
    chosen = few(len(whole), (), _DRAWN)
    curves = [
        Curve(z, whole[p], f"roll {found.lines.roll[p] * 1e3:.3g} mm", role, dash="solid", width=1.2, markers=False)
        for p, role in zip(chosen, ramp(len(chosen)), strict=True)
    ]
    curves.append(
        Curve(
            z,
            found.mean_over_face[:, case] * 1e-3,
            "mean over a base pitch",
            "ink",
            dash="solid",
            width=2.4,
            markers=False,
        )
    )
    curves.append(Curve(z[[0, -1]], np.full(2, mean), "load / face width", "grey", dash="dash", markers=False))
    return Figure(
        f"load_over_face_{name}",
        f"Load over the face of pair {name}",
        f"Pair {name}: load of all contact lines together per face width; K_Hβ = {found.face_load_factor[case]:.4g}.",
        (Panel(axis_of(found.lines, "z"), axis_of(found, "over_face", zero=True), tuple(curves)),),
        under=f"{found.load[case]:.5g} N",
    )


def _over_face_loads(name: str, found: LoadedFlanks, case: int) -> Figure:
    ends, loads = found.cells * 1e3, found.load.tolist()
    z = 0.5 * (ends[1:] + ends[:-1])
    relative = found.mean_over_face / (found.load / (found.lines.high - found.lines.low))
    curves = [
        Curve(z, relative[:, i], label, role, dash="solid", markers=False)
        for i, label, role in drawn_loads(loads, loads[case])
    ]
    curves.append(Curve(z[[0, -1]], np.ones(2), "even", "grey", dash="dash", markers=False))
    return Figure(
        f"load_over_face_loads_{name}",
        f"Load over the face of pair {name} under every load",
        f"Pair {name}: load per face width, averaged over a base pitch, over its mean; the largest of it is K_Hβ.",
        (Panel(axis_of(found.lines, "z"), Axis("load per face width over its mean", zero=True), tuple(curves)),),
    )


LOAD_DISTRIBUTION = flank_stage(
    inputs=_inputs,
    compute=lambda inputs, upstream, _work: loaded_flanks(upstream, inputs.name),
    present=_present,
    check=_check,
    cites=citing(*RING, HERTZ, INVOLUTE, Citation("johnson", "half-space under the contacts", "sections 3.2 and 4.2")),
    forecast=_forecast,
)
