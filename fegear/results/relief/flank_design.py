"""Result ``flank-design``: relief of loaded flanks in two dimensions, exact and as it can be ground.

Figures of designed flanks: charts for the drawing, what each relief leaves, maps over misalignment and load.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.case.built.members import gear_name
from fegear.case.built.pair_spec import pair_spec
from fegear.case.flank_design import FlankDesignPart
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure, View
from fegear.engine.figure.items import Curve, HeatMap, Points, ramp
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.results.forecasts import HERTZ, INVOLUTE, RING
from fegear.results.gear.solved_gear import needs_solid_solution, solid_solution_of
from fegear.results.pair.loaded_flanks import loaded_flanks, needs_flanks
from fegear.results.relief.flank_design_tables import (
    FlankDesignData,
    designs_table,
    keys_of,
    map_table,
    roll_table,
    topography_table,
    values_of,
)

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.design.flanks.flank_design import FlankDesignTask, FlankState
    from fegear.design.flanks.grid import ReliefGrid


#: Misalignments of a map: over the standard deviation of the scatter, or [m] without one.
_MAPPED, _MAPPED_ALONE = (-2.0, -1.0, 0.0, 1.0, 2.0), (-10e-6, -5e-6, 0.0, 5e-6, 10e-6)


#: Seconds of a contact line on both gears, of one combination of a grid and of the exact loads of one family.
_LINE, _COMBINATION, _FAMILY = 0.05, 4e-4, 1.0


@dataclass(frozen=True)
class FlankDesignInputs:
    """What the design of a pair's flanks depends on, besides its loaded flanks.

    Parameters
    ----------
    part : FlankDesignPart
    name : str
        Of the pair.
    gears : mapping of str to str
        Names of driver and driven.
    """

    part: FlankDesignPart
    name: str
    gears: Mapping[Member, str]


def _part(scene: Scene) -> FlankDesignPart:
    return scene.case.flank_design or FlankDesignPart()


def _pairs(scene: Scene) -> tuple[str, ...]:
    named, wide = _part(scene).pair, tuple(scene.wide_pairs)
    if named is not None:
        if named not in scene.pairs:
            raise InputError("flank_design.pair", f'"{named}"', "is no pair of this case")
        return (named,)
    if len(wide) > 1:
        raise InputError("flank_design.pair", "(not given)", "is required with several 3D pairs", "name one of them")
    return wide or tuple(scene.pairs)


def _check(scene: Scene, name: str) -> None:
    if name not in scene.wide_pairs:
        raise InputError(
            f"pair.{name}.width", '"plane"', "is not available for flank design (3D)",
            f'set pair.{name}.width = "solid", or request relief',
        )  # fmt: skip
    _task(_part(scene), scene.pairs[name], 1.0)


def _inputs(scene: Scene, name: str) -> FlankDesignInputs:
    return FlankDesignInputs(_part(scene), name, {member: gear_name(scene, name, member) for member in MEMBERS})


def _grid(part: FlankDesignPart) -> ReliefGrid | None:
    from fegear.design.flanks.grid import ReliefGrid

    if part.grid is None:
        return None
    g = part.grid
    lists = (g.tip_amounts, g.tip_lengths, g.crownings, g.end_amounts, g.end_lengths, g.slopes, g.biases)
    return ReliefGrid(*(tuple(values) for values in lists))


def _task(part: FlankDesignPart, pair: GearPair, nominal: float) -> FlankDesignTask:
    from fegear.design.flanks.flank_design import FlankDesignTask
    from fegear.design.flanks.scatter import NOMINAL, normal_scatter
    from fegear.design.flanks.topography import FlankLoading
    from fegear.design.loading import LoadingFunction, Ramp

    length = part.length or (part.contact_ratio * pair.base_pitch if part.contact_ratio else pair.path_length)
    if length > pair.path_length * (1.0 + 1e-9):
        raise InputError(
            "flank_design.length", f"{length * 1e3:.6g} mm",
            f"is longer than the path of contact, {pair.path_length * 1e3:.6g} mm "
            f"({pair.contact_ratio:.5g} base pitches)",
        )  # fmt: skip
    centre = 0.5 * (pair.x_start + pair.x_end) if part.centre is None else part.centre
    ramp = Ramp(part.slope)
    loading = FlankLoading(LoadingFunction(length, pair.base_pitch, centre, ramp, ramp), pair.face_width,
                           part.end_length)  # fmt: skip
    zone = loading.over_path
    slack = 1e-9 * pair.base_pitch
    if zone.x_start < pair.x_start - slack or zone.x_end > pair.x_end + slack:
        raise InputError(
            "flank_design.centre", f"{centre * 1e3:.6g} mm", "places the loading outside the path of contact",
            "choose a shorter design length, or remove centre",
        )  # fmt: skip
    load = part.load or nominal
    loads = tuple(sorted(part.loads)) if part.loads else (load,)
    scatter = normal_scatter(part.scatter.over_face, part.scatter.levels) if part.scatter else NOMINAL
    over_face = part.map.over_face
    if over_face is None:
        over_face = [k * part.scatter.over_face for k in _MAPPED] if part.scatter else list(_MAPPED_ALONE)
    return FlankDesignTask(
        loading, load, loads, tuple(part.families), _grid(part), part.largest_face_load_factor or math.inf, scatter,
        part.scatter.over_face if part.scatter else 0.0, part.positions, tuple(sorted(set(over_face))),
        tuple(sorted({load * f for f in part.map.load_factors})),
    )  # fmt: skip


def _compute(inputs: FlankDesignInputs, upstream: Upstream, work: Work) -> FlankDesignData:
    from fegear.design.flanks.flank_design import design_flanks

    found = loaded_flanks(upstream, inputs.name)
    flanks, apart = found.flanks, found.unrelieved
    task = _task(inputs.part, flanks.pair, found.nominal)
    solved = {member: solid_solution_of(upstream, inputs.gears[member]) for member in MEMBERS}
    coarse = {member: one.coarse or one.fine for member, one in solved.items()}
    design = design_flanks(flanks, coarse, found.known, apart, task, work.progress)
    return FlankDesignData(flanks.pair, design, apart.shafts.given)


def _present(data: FlankDesignData, inputs: FlankDesignInputs) -> Outcome:
    name, design, task = inputs.name, data.design, data.design.task
    shares: dict[str, dict[Member, float]] = {
        "driver": {"driver": 1.0},
        "driven": {"driven": 1.0},
        "both": dict.fromkeys(MEMBERS, 0.5),
    }
    chosen = shares[inputs.part.gear]
    tables = [topography_table(name, inputs.gears[m], m, share, data) for m, share in chosen.items()]
    tables += [designs_table(name, data), map_table(name, design), roll_table(name, design)]
    loading = task.loading
    settings: dict[str, object] = {
        "design_load": task.load, "design_contact_ratio": loading.over_path.length / loading.over_path.base_pitch,
        "slope": loading.over_path.ramp.slope, "end_length": loading.end_length, "positions": task.positions,
        "combinations": sum(one.candidates for one in design.found.values()),
        "loaded_exactly": sum(one.exact for one in design.found.values()),
    }  # fmt: skip
    figures = flank_design_figures(name, data, inputs.gears)
    return Outcome(data, tuple(tables), values_of(name, design), settings, _remarks(data, inputs), figures)


def _remarks(data: FlankDesignData, inputs: FlankDesignInputs) -> tuple[str, ...]:
    name, design = inputs.name, data.design
    remarks = []
    for state in (design.best, *design.robust):
        keys = "; ".join(keys_of(design.found[state.label].relief, data.pair, inputs.gears))
        remarks.append(f"Pair {name}, {state.label}: keys of the gears: {keys or 'none'}.")
    if data.on_shafts:
        remarks.append(
            f"Pair {name}: shaft deflection is kept at that of the present flanks during the design; rerun with the "
            "designed modification to update it."
        )
    unproven = [label for label, one in design.found.items() if not one.proven]
    if unproven:
        remarks.append(
            f"Pair {name}: {', '.join(unproven)}: too many combinations come so near the least that not all of them "
            "were computed exactly; the optimum is likely but not proven. A coarser grid can be proven."
        )
    return tuple(remarks)


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    gears = tuple(gear_name(scene, name, member) for member in MEMBERS)
    return (*needs_flanks(scene, name), *needs_solid_solution(*gears))


def _forecast(scene: Scene, name: str) -> Forecast:
    from fegear.design.flanks.grid import usual_grid

    part, asked = _part(scene), pair_spec(scene, name, over_face=True)
    pair = asked.placed
    grid = _grid(part) or usual_grid(1.0, pair.path_length, pair.face_width, pair.base_pitch)
    counts = [len(grid.combinations(family)) for family in part.families]
    levels = part.scatter.levels if part.scatter else 0
    combinations = (sum(counts) + levels * max(counts)) * len(part.loads or (1.0,))
    stations = asked.panel_count * (1.0 + pair.contact_ratio)
    lines = part.positions * (1.0 + pair.total_contact_ratio)
    exact = _FAMILY * (len(counts) + levels) * (stations / 34.0) ** 1.5 * len(part.loads or (1.0,))
    seconds = _LINE * lines + _COMBINATION * combinations * part.positions / 24.0 + exact
    return Forecast({"combinations": combinations, "positions": part.positions}, seconds)


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
        f"Flank modification of pair {name}",
        f"Pair {name}: total modification of both gears over roll angle of {gears['driver']} (driver, tip at right) "
        "and face width. Exact topography: zero transmission error at the design load; others: best grindable "
        "modifications.",
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
        f"diameters of {gears['driver']} (lead), as in a gear inspection report, relative to the highest point.",
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
    left = [Points(ripple, place, "alignment as specified", "series:0", size=9)]
    shares = [Points(factor, place, "alignment as specified", "series:0", size=9)]
    caption = f"Pair {name} at the design load: remaining transmission error with each relief, and K_Hβ."
    scatter = design.task.scatter
    if scatter.over_face.size > 1:
        mean = np.array([s.judged.mean_over_scatter.value for s in states]) * 1e6
        left.append(Points(mean, place, "mean over the scatter", "series:1", size=9))
        worst = np.array([s.judged.factor_over_scatter.value for s in states])
        shares.append(Points(worst, place, "95th percentile of the scatter", "series:3", size=9))
        deviation = design.task.deviation
        caption += f" Scatter: misalignment over the face width, standard deviation {deviation * 1e6:.3g} µm."
    return Figure(
        f"flank_designs_{name}",
        f"Transmission error with each modification, pair {name}",
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
    y, x = Axis("transmission error minus mean", "um"), Axis("mesh position", "mm")
    small = _SMALL * design.unrelieved.judged.peak_to_peak.value
    panels = []
    for title, chosen in (
        (
            "modifications with high transmission error",
            [s for s in design.states if s.judged.peak_to_peak.value >= small],
        ),
        (
            "reliefs with small remaining transmission error",
            [s for s in design.states if s.judged.peak_to_peak.value < small],
        ),
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
        f"Pair {name}: transmission error minus mean over a base pitch, at mesh positions not used in the design. "
        "Legend: peak to peak.",
        tuple(panels),
        under=f"{design.task.load:.5g} N",
    )


def _map(name: str, data: FlankDesignData) -> Figure:
    design = data.design
    over_face, loads = np.array(design.task.map_over_face) * 1e6, np.array(design.task.map_loads)
    shown = [design.unrelieved, *_drawn(data)]
    ripple = max(float(s.mapped.peak_to_peak.max()) for s in shown) * 1e6
    factor = max(float(s.mapped.face_load_factor.max()) for s in shown)
    x, y = Axis("misalignment over the face width", "um"), Axis("load", "N")
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


FLANK_DESIGN = Stage(
    subjects=_pairs,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    needs=_needs,
    check=_check,
    cites=citing(
        Citation("mark", "relief with zero transmission error at the design load", "Eqs. 4.6 to 4.14"),
        *RING, HERTZ, INVOLUTE,
    ),
    forecast=_forecast,
)  # fmt: skip
