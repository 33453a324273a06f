"""Figures of a designed relief: the reliefs, what they leave, and Harris maps."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Curve, Figure, Panel, View, Zone
from fegear.results.drawn_pair import roll_marks
from fegear.results.harris_map import harris_panel
from fegear.results.loaded_pair import BASE_PITCH, pitch_marks

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fegear.arrays import Array
    from fegear.design.minimum_excitation import ReliefTable
    from fegear.engine.outcome import Table
    from fegear.results.relief import ReliefData


def relief_figures(name: str, data: ReliefData, tables: Sequence[Table], gears: Sequence[str]) -> tuple[Figure, ...]:
    """Every figure of a design; `tables` and `gears` are of driver and driven."""
    points = (_points_figure(name, data, gears),) if data.points else ()
    return (
        _relief_figure(name, data, tables, gears),
        *points,
        _candidates_figure(name, data),
        _harris_figure(name, data),
    )


def _relief_figure(name: str, data: ReliefData, tables: Sequence[Table], gears: Sequence[str]) -> Figure:
    """Reliefs of both gears (`tables` and `gears` of driver and driven) and the loads that they were designed for."""
    x, reliefs, loads = Axis("roll angle", "deg"), [], []
    for member, table, gear in zip(data.design.reliefs, tables, gears, strict=True):
        shown = {column.name: np.asarray(column.values, dtype=float) for column in table.columns}
        roll = shown["roll_angle"]
        curves = [Curve(roll, shown["relief"], "designed", "designed", shown.get("relief_error"), markers=False)]
        if "relief_diagonal" in shown:
            curves.append(Curve(roll, shown["relief_diagonal"], "diagonal only", "diagonal only", markers=False))
        for shape, ground in data.design.ground.items():
            label = f"{shape} tip relief"
            removal = getattr(ground, member).removal(table.column("roll_angle").si) * 1e6
            curves.append(Curve(roll, removal, label, label, markers=False))
        points = roll_marks(data.pair.engagement.pair, member)
        loaded = roll[shown["load"] > 0.0]
        zone = Zone("x", float(loaded.min()), float(loaded.max()))
        reliefs.append(
            Panel(x, Axis("material to remove", "um"), tuple(curves), (zone, *points), f"{member}: gear {gear}")
        )
        load = Curve(roll, shown["load"], "load of the design", "grey", dash="solid", markers=False)
        loads.append(Panel(x, Axis("load", "N", zero=True), (load,), (zone, *points), f"{member}: load", height=0.6))
    return Figure(
        f"relief_{name}",
        f"Profile relief of pair {name}",
        f"Pair {name}: relief of both gears for {data.design.task.load:.5g} N over the active profile, and the load of "
        "the tooth. Shaded: the design zone, where the tooth is loaded at the design load. Ground reliefs are at the "
        "tips only; a constant over the whole flank makes no difference.",
        (*reliefs, *loads),
        columns=2,
        under=f"{data.design.task.load:.5g} N",
    )


def _points_figure(name: str, data: ReliefData, gears: Sequence[str]) -> Figure:
    """Load, deflection and relief at the roll angles that the case asks for."""
    roll = Axis("roll angle of the gear", "deg")
    rows: list[tuple[Axis, Callable[[ReliefTable], Array]]] = [
        (Axis("load", "N", zero=True), lambda t: t.load),
        (Axis("deflection of the flank", "um", zero=True), lambda t: t.deflection * 1e6),
        (Axis("relief from the least", "um", zero=True), lambda t: (t.relief - t.relief.min()) * 1e6),
    ]
    both = list(zip(data.points.items(), gears, strict=True))
    panels = tuple(
        Panel(roll, y, tuple(
            Curve(np.degrees(t.roll_angle), of(t), f"{member}: gear {gear}", member, markers=True)
            for (member, t), gear in both
        ))
        for y, of in rows
    )  # fmt: skip
    return Figure(
        f"relief_points_{name}", f"Loads, deflections and relief of pair {name}",
        f"Pair {name}: at the roll angles asked for, the load of the design, the deflection of the flank under it, and "
        "the relief that makes up for it, counted from the least of these points.",
        panels, under=f"{data.design.task.load:.5g} N",
    )  # fmt: skip


def _candidates_figure(name: str, data: ReliefData) -> Figure:
    curves = []
    for label, curve in data.design.curves.items():
        i = int(np.argmin(np.abs(curve.load - data.design.task.load)))
        te = (curve.transmission_error[:, i] - data.design.te[label].mean) * 1e6
        left = data.design.te[label].peak_to_peak * 1e6
        size = f"{left:.3g} µm" if left > 1e-6 else "0"
        curves.append(Curve(curve.x * 1e3, te, f"{label}: {size} peak to peak", label, markers=False))
    load = f"{data.design.task.load:.5g} N"
    marks = pitch_marks(data.pair.engagement.pair, next(iter(data.design.curves.values())).x)
    caption = f"Pair {name}: what each relief leaves of the transmission error at the design load, {load}."
    if "diagonal only" in data.design.te:
        caption += (
            " Diagonal only: relief designed without the neighbours' loads (Mark, Eq. 5.4), on teeth that do deflect "
            "each other."
        )
    return Figure(
        f"relief_candidates_{name}",
        f"Transmission error of pair {name} with and without relief",
        caption,
        (Panel(BASE_PITCH, Axis("transmission error less its mean", "um"), tuple(curves), marks),),
        under=load,
    )


def _harris_figure(name: str, data: ReliefData) -> Figure:
    views = []
    places = ("designed", "linear tip relief", "parabolic tip relief", "no relief", "diagonal only")
    order = sorted(data.design.curves, key=lambda label: places.index(label) if label in places else len(places))
    for label in order:
        curve = data.design.curves[label]
        panel = harris_panel(curve, data.pair.engagement.pair, data.design.task.load, "design")
        views.append(View(label, (panel,)))
    return Figure(
        f"harris_map_{name}",
        f"Harris map of pair {name}",
        f"Pair {name}: transmission error over the mesh cycle for a family of loads, with each relief; "
        f"wide: the design load, {data.design.task.load:.5g} N.",
        views=tuple(views),
    )
