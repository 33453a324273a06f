"""Figures of designed flanks: charts for the drawing, what each relief leaves, maps over misalignment and load."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Curve, Figure, HeatMap, Panel, Points, View, ramp

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.arrays import Array
    from fegear.design.flank_design import FlankState
    from fegear.geometry.pair import Member
    from fegear.results.flank_design import FlankDesignData

#: Sections of the charts: heights over half the face, and parts of the path of contact.
_HEIGHTS, _DEPTHS = (-0.9, 0.0, 0.9), (0.1, 0.5, 0.9)
#: Points of the maps and curves.
_ACROSS, _ALONG = 121, 81
#: Reliefs that leave less than this share of the unrelieved transmission error have a panel of their own.
_SMALL = 0.25


def flank_design_figures(name: str, data: FlankDesignData, gears: Mapping[Member, str]) -> tuple[Figure, ...]:
    """Describe all figures of one pair."""
    return (
        _topography(name, data, gears),
        _charts(name, data, gears),
        _left(name, data),
        _roll(name, data),
        _map(name, data),
    )


def _drawn(data: FlankDesignData) -> list[FlankState]:
    """The exact topography, and what is ground best."""
    design = data.design
    return [design.exact, design.best, *design.robust]


def _removal(data: FlankDesignData, state: FlankState, x: Array, z: Array) -> Array:
    """Removal by both gears over a grid, counted from its least, shape (x, z) [um]."""
    from scipy.interpolate import RegularGridInterpolator

    first, second = np.meshgrid(x, z, indexing="ij")
    if state.relief is not None:
        found = state.relief.removal(data.pair, first, second)
    else:
        design = data.design
        found = RegularGridInterpolator((design.x, design.z), design.removal)((first, second))
    return np.asarray((found - found.min()) * 1e6)


def _topography(name: str, data: FlankDesignData, gears: Mapping[Member, str]) -> Figure:
    pair, design = data.pair, data.design
    x = np.linspace(design.x[0], design.x[-1], _ACROSS)
    z = np.linspace(design.z[0], design.z[-1], _ALONG)
    roll = np.degrees(pair.roll_angle(x, "driver"))
    states = _drawn(data)
    maps = [_removal(data, state, x, z) for state in states]
    most = max(float(found.max()) for found in maps)
    views = tuple(
        View(state.label, (
            Panel(
                Axis(f"roll angle of {gears['driver']}", "deg"), Axis("face position z", "mm"),
                (HeatMap(roll, z * 1e3, found.T, "removal", "um", limits=(0.0, most)),), title=state.label,
            ),
        ))
        for state, found in zip(states, maps, strict=True)
    )  # fmt: skip
    return Figure(
        f"flank_topography_{name}",
        f"Relief over the flanks of pair {name}",
        f"Pair {name}: material that both gears together are relieved by, over the roll angle of {gears['driver']} "
        f"(driver, tip to the right) and over the face. Exact topography: leaves no transmission error at the design "
        "load; the others are the best that can be ground.",
        views=views,
        under=f"{design.task.load:.5g} N",
    )


def _charts(name: str, data: FlankDesignData, gears: Mapping[Member, str]) -> Figure:
    """Profile and lead diagrams, as a gear measuring machine draws them."""
    pair, design = data.pair, data.design
    x = np.linspace(design.x[0], design.x[-1], _ACROSS)
    z = np.linspace(design.z[0], design.z[-1], _ALONG)
    roll = np.degrees(pair.roll_angle(x, "driver"))
    heights = 0.5 * pair.face_width * np.array(_HEIGHTS)
    places = pair.x_start + pair.path_length * np.array(_DEPTHS)
    diameters = 2.0 * np.asarray(pair.radius(places, "driver"))
    panels = []
    for state in _drawn(data):
        over_profile = _removal(data, state, x, np.sort(np.append(heights, z[[0, -1]])))[:, 1:-1]
        over_face = _removal(data, state, np.sort(np.append(places, x[[0, -1]])), z)[1:-1]
        profile = tuple(
            Curve(roll, over_profile[:, k], f"z = {h * 1e3:.3g} mm", role, dash="solid", markers=False)
            for k, (h, role) in enumerate(zip(heights, ramp(len(heights)), strict=True))
        )
        lead = tuple(
            Curve(z * 1e3, over_face[k], f"diameter {d * 1e3:.5g} mm", role, dash="solid", markers=False)
            for k, (d, role) in enumerate(zip(diameters, ramp(len(diameters)), strict=True))
        )
        depth = Axis("removal", "um", zero=True)
        panels += [
            Panel(Axis(f"roll angle of {gears['driver']}", "deg"), depth, profile, title=f"{state.label}: profile"),
            Panel(Axis("face position z", "mm"), depth, lead, title=f"{state.label}: lead"),
        ]
    return Figure(
        f"flank_charts_{name}",
        f"Profile and lead charts of pair {name}",
        f"Pair {name}: relief of both gears together in three sections across the axis (profile) and on three "
        f"diameters of {gears['driver']} (lead), as a measuring machine draws them; counted from the highest point.",
        tuple(panels),
        columns=2,
        under=f"{design.task.load:.5g} N",
    )


def _left(name: str, data: FlankDesignData) -> Figure:
    design = data.design
    states = design.states[::-1]
    place = np.arange(len(states), dtype=float)
    names = Axis(categories=tuple(s.label.replace("-", " ") for s in states))
    ripple = np.array([s.judged.peak_to_peak.value for s in states]) * 1e6
    factor = np.array([s.judged.face_load_factor.value for s in states])
    left = [Points(ripple, place, "aligned as given", "series:0", size=9)]
    shares = [Points(factor, place, "aligned as given", "series:0", size=9)]
    caption = f"Pair {name} at the design load: what each relief leaves of the transmission error, and K_Hβ."
    scatter = design.task.scatter
    if scatter.over_face.size > 1:
        mean = np.array([s.judged.mean_over_scatter.value for s in states]) * 1e6
        left.append(Points(mean, place, "mean over the scatter", "series:1", size=9))
        worst = np.array([s.judged.factor_over_scatter.value for s in states])
        shares.append(Points(worst, place, "95 % of the scatter", "series:3", size=9))
        deviation = design.task.deviation
        caption += f" Scatter: misalignments of {deviation * 1e6:.3g} µm over the face (standard deviation)."
    return Figure(
        f"flank_designs_{name}",
        f"What reliefs of pair {name} leave",
        caption,
        (
            Panel(Axis("transmission error, peak to peak", "um", log=True), names, tuple(left)),
            Panel(Axis("K_{Hβ}"), names, tuple(shares)),
        ),
        columns=2,
        under=f"{design.task.load:.5g} N",
    )


def _roll(name: str, data: FlankDesignData) -> Figure:
    design = data.design
    y, x = Axis("transmission error less its mean", "um"), Axis("roll position", "mm")
    small = _SMALL * design.unrelieved.judged.peak_to_peak.value
    panels = []
    for title, chosen in (
        ("reliefs that leave most of it", [s for s in design.states if s.judged.peak_to_peak.value >= small]),
        ("reliefs that leave little", [s for s in design.states if s.judged.peak_to_peak.value < small]),
    ):
        curves = tuple(
            Curve(design.roll * 1e3, (s.te - s.te.mean()) * 1e6,
                  f"{s.label}: {s.judged.peak_to_peak.value * 1e6:.3g} µm",
                  "no relief" if s is design.unrelieved else f"series:{k}", markers=False)
            for k, s in enumerate(chosen)
        )  # fmt: skip
        if curves:
            panels.append(Panel(x, y, curves, title=title))
    return Figure(
        f"flank_design_roll_{name}",
        f"Transmission error of pair {name} with each relief",
        f"Pair {name}: transmission error over a base pitch less its mean, at roll positions that the exact "
        "topography has not seen. In the legend: peak to peak.",
        tuple(panels),
        under=f"{design.task.load:.5g} N",
    )


def _map(name: str, data: FlankDesignData) -> Figure:
    design = data.design
    over_face, loads = np.array(design.task.map_over_face) * 1e6, np.array(design.task.map_loads)
    shown = [design.unrelieved, *_drawn(data)]
    ripple = max(float(s.mapped.peak_to_peak.max()) for s in shown) * 1e6
    factor = max(float(s.mapped.face_load_factor.max()) for s in shown)
    x, y = Axis("misalignment over the face", "um"), Axis("load", "N")
    views = tuple(
        View(s.label, (
            Panel(x, y, (HeatMap(over_face, loads, s.mapped.peak_to_peak.T * 1e6, "peak to peak", "um", numbers=True,
                                 limits=(0.0, ripple)),), title=f"{s.label}: transmission error"),
            Panel(x, y, (HeatMap(over_face, loads, s.mapped.face_load_factor.T, "K_{Hβ}", numbers=True,
                                 limits=(1.0, factor)),), title=f"{s.label}: K_{{Hβ}}"),
        ))
        for s in shown
    )  # fmt: skip
    return Figure(
        f"flank_map_{name}",
        f"Pair {name} over misalignment and load",
        f"Pair {name}: transmission error, peak to peak, and K_Hβ over misalignment and load with each relief; "
        f"design load {design.task.load:.5g} N.",
        views=views,
        columns=2,
    )
