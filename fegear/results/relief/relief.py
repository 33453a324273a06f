"""Result ``relief``: the profile relief of both gears that removes the transmission error at the design load.

A designed relief as a case writes it: by Eq. 4.6 as tables, or the tip reliefs that a shop can grind.

Figures of a designed relief: the reliefs, what they leave, and Harris maps.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING, Any, Literal

import numpy as np

from fegear.base.errors import InputError, RangeError
from fegear.base.printed import percent
from fegear.case.built.members import gear_name
from fegear.case.built.neglected_effects import design_remarks, neglected_in_design
from fegear.case.built.pair_spec import pair_spec
from fegear.case.design import DesignPart
from fegear.contact.loaded_teeth import HARMONICS, POSITIONS
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of, drawn
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure, View
from fegear.engine.figure.items import Curve, Zone
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.engine.value import Value
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.results import forecasts
from fegear.results.gear.drawing import roll_marks
from fegear.results.pair.loaded_teeth import BASE_PITCH, needs_teeth, pitch_marks
from fegear.results.pair.root_stress_history import table_names
from fegear.results.relief.relief_tables import (
    ReliefInputs,
    grindable_table,
    harris_panel,
    harris_table,
    least_stress_table,
    points_table,
    relief_tables,
    relief_values,
)

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fegear.case.reading import Scene
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.design.loading import LoadingFunction
    from fegear.design.minimum_excitation import ReliefTable
    from fegear.design.relief_design import ReliefDesign
    from fegear.design.tip_relief.grindable import TipReliefPair
    from fegear.engine.run import Results
    from fegear.engine.table import Table
    from fegear.geometry.relief import Shape


@dataclass(frozen=True)
class ReliefData:
    """A designed relief.

    Parameters
    ----------
    pair : LoadedPair
    design : ReliefDesign
    neglected : mapping of str to tuple of str
        What effects that are off would change, in words.
    points : mapping of member to ReliefTable
        At the roll angles that the case asks for; empty where it names none.
    """

    pair: LoadedPair
    design: ReliefDesign
    neglected: Mapping[str, tuple[str, ...]]
    points: Mapping[Member, ReliefTable]


def design_part(scene: Scene) -> DesignPart:
    """``[design]``, or its defaults."""
    return scene.case.design or DesignPart()


def design_pairs(scene: Scene) -> tuple[str, ...]:
    """The pair that ``[design]`` names, or the only pair of spur gears."""
    named = design_part(scene).pair
    if named is not None:
        return (named,)
    if len(scene.spur_pairs) > 1:
        raise InputError("design.pair", "(not given)", "is required with several pairs", "specify one of them")
    return tuple(scene.spur_pairs)


#: Stage of a result about the reliefs that a case asks to design.
relief_stage = partial(Stage, subjects=design_pairs, needs=needs_teeth)


def _loading(part: DesignPart, p: GearPair) -> LoadingFunction:
    from fegear.design.loading import LoadingFunction, Ramp

    length = part.length or (part.contact_ratio * p.base_pitch if part.contact_ratio else p.path_length)
    centre = 0.5 * (p.x_start + p.x_end) if part.centre is None else part.centre
    exponent = (part.exponent or 7) if part.family == "polynomial" else None
    peak = part.peak if isinstance(part.peak, float) else math.nan
    ramp, inner = Ramp(part.slope, exponent), Ramp(part.inner_slope, exponent)
    return LoadingFunction(length, p.base_pitch, centre, ramp, inner, peak)


def _check(scene: Scene, name: str) -> None:
    peak = design_part(scene).peak
    if isinstance(peak, str) and scene.case.pair[name].compliance.source != "fe":
        raise InputError(
            "design.peak", f'"{peak}"', "requires root stresses", f'set pair.{name}.compliance.source = "fe"'
        )
    from fegear.design.loading import refuse_beyond_path

    pair, part = scene.pairs[name], design_part(scene)
    if pair.contact_ratio < 1.0 and part.length is None and part.contact_ratio is None:
        rule = "is below 1: relief design requires at least 1"
        raise InputError(f"pair.{name}", f"contact ratio {pair.contact_ratio:.4f}", rule, "increase the contact ratio")
    refuse_beyond_path(_loading(part, pair), pair)
    for member in MEMBERS:
        ends = [float(pair.roll_angle(x, member)) for x in (pair.x_start, pair.x_end)]
        for roll in design_part(scene).roll_angles or ():
            if not min(ends) - 1e-9 <= roll <= max(ends) + 1e-9:
                raise RangeError(
                    "design.roll_angles", f"{math.degrees(roll):.6g} deg",
                    f"is outside the active profile of the {member}, {math.degrees(min(ends)):.6g} to "
                    f"{math.degrees(max(ends)):.6g} deg",
                )  # fmt: skip


def _inputs(scene: Scene, name: str) -> ReliefInputs:
    gears = {member: gear_name(scene, name, member) for member in MEMBERS}
    case = scene.case
    return ReliefInputs(
        design_part(scene), pair_spec(scene, name), case.accuracy.tolerance, case.effects,
        scene.sizes_neglected, table_names(scene, name), gears,
    )  # fmt: skip


def _compute(inputs: ReliefInputs, upstream: Upstream, work: Work) -> ReliefData:
    from fegear.design.oil_film import OilFilm
    from fegear.design.relief_design import DesignTask, design_relief, relief_at
    from fegear.design.root_stress_loading import Allowed

    pair: LoadedPair
    (pair,) = upstream.values()
    part = inputs.part
    load = part.load or pair.nominal
    limits = part.allowable
    film = None if part.film is None else OilFilm(tuple(part.film.x), tuple(part.film.thickness))
    allowed = None if limits is None else Allowed(limits.root_tension, limits.hertz_pressure, load)
    task = DesignTask(
        _loading(part, pair.engagement.pair), load, isinstance(part.peak, str), tuple(part.grind), part.metric,
        tuple(sorted({*pair.loads, load})), POSITIONS, HARMONICS, allowed, film,
    )  # fmt: skip
    design = design_relief(pair.engagement, pair.shifted, task, work.progress)
    best = best_ground(design) if design.ground else None
    neglected: dict[str, tuple[str, ...]] = {}
    if inputs.neglected:
        neglected = neglected_in_design(inputs.asked, design.designed, best, task, inputs.tolerance)
    wanted = part.roll_angles or ()
    points = {member: relief_at(design.designed, member, wanted) for member in MEMBERS if wanted}
    return ReliefData(pair, design, neglected, points)


def _present(data: ReliefData, inputs: ReliefInputs) -> Outcome:
    name, design, load = inputs.asked.name, data.design, data.design.task.load
    loading, tables = design.task.loading, []
    values: list[Value] = []
    if design.chosen is not None:
        table, stresses = least_stress_table(name, design.chosen, load)
        tables.append(table)
        values += stresses
    reliefs = relief_tables(name, design, inputs)
    tables += reliefs
    tables += [points_table(name, inputs.labels[m], inputs.gears[m], table) for m, table in data.points.items()]
    if design.ground:
        tables.append(grindable_table(name, design.ground, design.te, data.pair.engagement.pair))
    tables.append(harris_table(name, design.curves, design.ground))
    settings = {
        "design_load": load, "design_contact_ratio": loading.length / loading.base_pitch, "peak": loading.peak,
        "slope": loading.ramp.slope, "exponent": loading.ramp.exponent or 0, "centre": loading.centre,
    }  # fmt: skip
    figures = relief_figures(name, data, reliefs, [inputs.gears[member] for member in MEMBERS])
    values += relief_values(name, design)
    return Outcome(data, tuple(tables), tuple(values), settings, _remarks(data, inputs), figures)


def _remarks(data: ReliefData, inputs: ReliefInputs) -> tuple[str, ...]:
    remarks, te, name = [], data.design.te, inputs.asked.name
    if inputs.part.film is not None:
        remarks.append(
            f"Pair {name}: each relief compensates half the oil film at the design load; the remaining transmission "
            "error includes the film, assumed equally thick at all loads. Grindable tip reliefs are searched without "
            "it."
        )
    if "diagonal only" in te:
        d, n = te["diagonal only"].peak_to_peak, te["no relief"].peak_to_peak
        remarks.append(
            f"Pair {name}: relief designed without tooth coupling (Mark 5.4) gives a peak-to-peak transmission error "
            f"of {d * 1e6:.3g} um, {percent(d / te['diagonal only'].mean)} of the mean and {percent(d / n)} of the "
            "value without relief."
        )
    return (*remarks, *design_remarks(name, data.neglected, inputs.effects, inputs.tolerance))


def _forecast(scene: Scene, name: str) -> Forecast:
    """Reliefs to grind, fitted by repeated load sharing."""
    design = scene.case.design
    grind = len(design.grind) if design else 2
    return forecasts.constant(0.3 + 1.2 * grind * (1.3 if forecasts.engagements(scene, name) > 1 else 1.0))


#: ``exact``: by Mark's Eq. 4.6, as tables; ``ground``: linear or parabolic tip reliefs that a shop can grind.
How = Literal["exact", "ground"]


#: Points of a designed relief that a case is given: straight lines between them stay within its own error.
_POINTS = 61


#: A removal below this is none [um].
_NOTHING = 0.005


def relief_for_case(results: Results, pair: str, how: How) -> dict[str, dict[str, Any] | None]:
    """Reliefs of both gears of a pair.

    Parameters
    ----------
    results : Results
        Of a case that asks for ``relief`` of that pair.
    pair : str
    how : {"exact", "ground"}

    Returns
    -------
    dict
        By gear ``gear.NAME.relief`` as plain data; None where nothing is removed.
    """
    part = results.scene.case.pair[pair]
    if how == "exact":
        return {gear: {"table": _table(results, pair, gear)} for gear in (part.driver, part.driven)}
    shape, best = best_ground(_design(results))
    form = {} if shape == "linear" else {"shape": shape}
    found: dict[str, dict[str, Any] | None] = {}
    for gear, relief in ((part.driver, best.driver), (part.driven, best.driven)):
        amount, start = relief.amount * 1e6, math.degrees(relief.start)
        tip = {"amount": f"{amount:.4g} um", "start_roll_angle": f"{start:.6g} deg", **form}
        found[gear] = {"tip": tip} if amount > _NOTHING else None
    return found


def _design(results: Results) -> ReliefDesign:
    (data,) = (one.data for one in results.outcomes.values() if isinstance(one.data, ReliefData))
    return data.design


def _table(results: Results, pair: str, gear: str) -> dict[str, list[str]]:
    table = results.tables[f"relief_{pair}_{gear}"]
    roll, removal = (np.asarray(table[name], dtype=float) for name in ("roll_angle", "relief"))
    order = np.argsort(roll)
    places = np.linspace(roll.min(), roll.max(), _POINTS)
    taken = np.interp(places, roll[order], removal[order])
    return {
        "roll_angles": [f"{one:.6g} deg" for one in places],
        "removals": [f"{one:.4g} um" for one in taken],
    }


def best_ground(design: ReliefDesign) -> tuple[Shape, TipReliefPair]:
    """The shape that leaves the least by the metric of the case, and its reliefs."""
    return min(design.ground.items(), key=lambda one: one[1].objective)


def what_it_leaves(results: Results, how: How) -> str:
    """What the reliefs leave of the transmission error, peak to peak, in a sentence or two."""
    design = _design(results)
    te, load = {label: one.peak_to_peak * 1e6 for label, one in design.te.items()}, f"{design.task.load:.5g} N"
    before = f"peak to peak ({te['no relief']:.3g} um without relief, at {load})"
    if how == "exact":
        left = "0 um" if te["designed"] < _NOTHING else f"{te['designed']:.3g} um"
        return f"Relief by Mark's Eq. 4.6: transmission error {left} {before}."
    shape, best = best_ground(design)
    others = [f"{one} ones {te[f'{one} tip relief']:.3g} um" for one in design.ground if one != shape]
    beside = f"; {', '.join(others)}" if others else ""
    return (
        f"Best {shape} tip relief: transmission error {te[f'{shape} tip relief']:.3g} um {before}{beside}. Two "
        f"independent searches (after a scan of {best.candidates:,} reliefs) agree within "
        f"{percent(best.least_error / best.least if best.least > 0.0 else 0.0)}."
    )


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
    some = next(iter(data.design.reliefs.values())).table
    x, reliefs, loads = axis_of(some, "roll_angle"), [], []
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
        reliefs.append(Panel(x, axis_of(some, "relief"), tuple(curves), (zone, *points), f"{member}: gear {gear}"))
        load = Curve(roll, shown["load"], "load of the design", "grey", dash="solid", markers=False)
        loads.append(
            Panel(x, axis_of(some, "load", zero=True), (load,), (zone, *points), f"{member}: load", height=0.6)
        )
    return Figure(
        f"relief_{name}",
        f"Profile relief of pair {name}",
        f"Pair {name}: relief of both gears for {data.design.task.load:.5g} N over the active profile, and the load "
        "of the tooth. Shaded: the design zone, where the tooth is loaded at the design load. Grindable reliefs are "
        "tip reliefs only; a constant offset has no effect.",
        (*reliefs, *loads),
        columns=2,
        under=f"{data.design.task.load:.5g} N",
    )


def _points_figure(name: str, data: ReliefData, gears: Sequence[str]) -> Figure:
    """Load, deflection and relief at the roll angles that the case asks for."""
    roll = Axis("roll angle of the gear", "deg")
    both = list(zip(data.points.items(), gears, strict=True))
    some = both[0][0][1]

    def curves(key: str, *, from_least: bool = False) -> tuple[Curve, ...]:
        return tuple(
            Curve(drawn(t, "roll_angle"), drawn(t, key) - (drawn(t, key).min() if from_least else 0.0),
                  f"{member}: gear {gear}", member, markers=True)
            for (member, t), gear in both
        )  # fmt: skip

    panels = (
        Panel(roll, axis_of(some, "load", zero=True), curves("load")),
        Panel(roll, axis_of(some, "deflection", zero=True), curves("deflection")),
        Panel(roll, axis_of(some, "relief", "relief from the minimum", zero=True), curves("relief", from_least=True)),
    )
    return Figure(
        f"relief_points_{name}", f"Loads, deflections and relief of pair {name}",
        f"Pair {name}: at the roll angles asked for, design load, flank deflection and compensating relief, relative "
        "to the minimum of these points.",
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
    caption = f"Pair {name}: remaining transmission error with each relief at the design load, {load}."
    if "diagonal only" in data.design.te:
        caption += (
            " Diagonal only: relief designed without the neighbours' loads (Mark, Eq. 5.4), applied to teeth with "
            "coupling."
        )
    return Figure(
        f"relief_candidates_{name}",
        f"Transmission error of pair {name} with and without relief",
        caption,
        (Panel(BASE_PITCH, Axis("transmission error minus mean", "um"), tuple(curves), marks),),
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


RELIEF = relief_stage(
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    cites=citing(
        Citation("mark", "relief with zero transmission error at the design load", "Eqs. 4.6 to 4.16, 5.4"),
        Citation("lin-townsend-oswald", "linear and parabolic tip relief"),
        Citation("harris", "Harris maps"),
    ),
    forecast=_forecast,
)
