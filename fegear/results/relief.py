"""Stage ``relief``: the profile relief of both gears that removes the transmission error at the design load."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.case.design import DesignPart
from fegear.engine.citation import Citation, citing
from fegear.engine.figure import Axis, Curve, Figure, Panel, View, Zone
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Forecast, Stage
from fegear.errors import InputError
from fegear.models.neglected_effects import design_remarks, neglected_in_design
from fegear.models.pair_inputs import MEMBERS, gear_name, pair_inputs
from fegear.results import forecasts
from fegear.results.loaded_pair import BASE_PITCH, drawn_loads, needs_pair
from fegear.results.root_stress_history import table_names
from fegear.results.transmission_error import HARMONICS, POSITIONS

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fegear.case.effects import EffectsPart
    from fegear.case.reading import Scene
    from fegear.contact import Loaded, TransmissionError
    from fegear.design import LoadingFunction, TipReliefPair
    from fegear.design.relief_design import ReliefDesign
    from fegear.design.root_stress_loading import StressOptimum
    from fegear.engine.stage import Upstream, Work
    from fegear.geometry import GearPair
    from fegear.geometry.pair import Member
    from fegear.geometry.relief import Shape
    from fegear.models.loaded_pair import LoadedPair
    from fegear.models.pair_inputs import PairInputs


#: What the design knows of the effects; the gears' own reliefs are what it replaces.
DESIGN_EFFECTS = ("neighbour_coupling", "hertz", "corner_contact")


@dataclass(frozen=True)
class ReliefData:
    """A designed relief.

    Parameters
    ----------
    pair : LoadedPair
    design : ReliefDesign
    neglected : mapping of str to tuple of str
        What effects that are off would change, in words.
    """

    pair: LoadedPair
    design: ReliefDesign
    neglected: Mapping[str, tuple[str, ...]]


@dataclass(frozen=True)
class ReliefInputs:
    """What the design of a pair's relief depends on.

    Parameters
    ----------
    part : DesignPart
    asked : PairInputs
    tolerance : float
        That neglected effects are held against.
    effects : EffectsPart
        All of the case, for the remedies.
    labels, gears : mapping of str to str
        Names of the tables and of the gears by member.
    """

    part: DesignPart
    asked: PairInputs
    tolerance: float
    effects: EffectsPart = field(compare=False)
    labels: Mapping[Member, str] = field(compare=False)
    gears: Mapping[Member, str] = field(compare=False)


def design_part(scene: Scene) -> DesignPart:
    """``[design]``, or its defaults."""
    return scene.case.design or DesignPart()


def design_pairs(scene: Scene) -> tuple[str, ...]:
    """The pair that ``[design]`` names, or the only pair of spur gears."""
    named = design_part(scene).pair
    if named is not None:
        return (named,)
    if len(scene.pairs) > 1:
        raise InputError("design.pair", "(not given)", "is needed where there are several pairs", "name one of them")
    return tuple(scene.pairs)


def _loading(part: DesignPart, p: GearPair) -> LoadingFunction:
    from fegear.design import LoadingFunction, Ramp

    length = part.length or (part.contact_ratio * p.base_pitch if part.contact_ratio else p.path_length)
    centre = 0.5 * (p.x_start + p.x_end) if part.centre is None else part.centre
    exponent = (part.exponent or 7) if part.family == "polynomial" else None
    peak = part.peak if isinstance(part.peak, float) else math.nan
    ramp, inner = Ramp(part.slope, exponent), Ramp(part.inner_slope, exponent)
    return LoadingFunction(length, p.base_pitch, centre, ramp, inner, peak)


def _check(scene: Scene, name: str) -> None:
    if design_part(scene).peak == "least-root-stress" and scene.case.pair[name].compliance.source != "fe":
        raise InputError(
            "design.peak", '"least-root-stress"', "needs root stresses", f'set pair.{name}.compliance.source = "fe"'
        )


def _inputs(scene: Scene, name: str) -> ReliefInputs:
    gears = {member: gear_name(scene, name, member) for member in MEMBERS}
    case = scene.case
    return ReliefInputs(
        design_part(scene), pair_inputs(scene, name), case.accuracy.tolerance, case.effects,
        table_names(scene, name), gears,
    )  # fmt: skip


def _compute(inputs: ReliefInputs, upstream: Upstream, work: Work) -> ReliefData:
    from fegear.design.relief_design import DesignTask, design_relief

    (found,) = upstream.values()
    pair: LoadedPair = found.pair
    part = inputs.part
    load = part.load or pair.nominal
    task = DesignTask(
        _loading(part, pair.engagement.pair), load, part.peak == "least-root-stress", tuple(part.grind), part.metric,
        tuple(sorted({*pair.loads, load})), POSITIONS, HARMONICS,
    )  # fmt: skip
    design = design_relief(pair.engagement, pair.shifted, task, work.progress)
    return ReliefData(pair, design, neglected_in_design(inputs.asked, design.designed, load, inputs.tolerance))


def _present(data: ReliefData, inputs: ReliefInputs) -> Outcome:
    name, design, load = inputs.asked.name, data.design, data.design.task.load
    loading, tables, values = design.task.loading, [], []
    if design.chosen is not None:
        table, value = _least_stress(name, design.chosen, load)
        tables.append(table)
        values.append(value)
    reliefs = _relief_tables(name, design, inputs)
    tables += reliefs
    if design.ground:
        tables.append(_ground_table(name, design.ground, design.te, data.pair.engagement.pair))
    tables.append(_harris_table(name, design.curves))
    settings = {
        "design_load": load, "design_contact_ratio": loading.length / loading.base_pitch, "peak": loading.peak,
        "slope": loading.ramp.slope, "exponent": loading.ramp.exponent or 0, "centre": loading.centre,
    }  # fmt: skip
    figures = _figures(name, data, reliefs, [inputs.gears[member] for member in MEMBERS])
    values += _values(name, design)
    return Outcome(data, tuple(tables), tuple(values), settings, _remarks(data, inputs), figures)


def _least_stress(name: str, best: StressOptimum, load: float) -> tuple[Table, Value]:
    labels = ["sinusoidal" if r is None else f"polynomial, r = {r}" for r, _, _ in best.candidates]
    table = Table(
        f"loading_candidates_{name}",
        (
            Column("family", np.array(labels), "", "of the ramps"),
            Column("peak", np.array([f for _, f, _ in best.candidates]), "", "F, best of its family"),
            Column("root_tension", np.array([s * load for _, _, s in best.candidates]), "MPa", "largest of both gears"),
        ),
        f"Loadings of {name} tried for the least root stress",
    )
    return table, Value(
        f"{name}.design_root_tension", best.stress * load, "MPa", None, "largest of both gears, design load"
    )


def _relief_tables(name: str, design: ReliefDesign, inputs: ReliefInputs) -> list[Table]:
    tables = []
    for member, label in inputs.labels.items():
        found = design.reliefs[member]
        t = found.table
        columns = [
            Column("x", t.x, "mm", "position on the line of action, positive toward the driver's tip"),
            Column("radius", t.radius, "mm", "radius of the flank point"),
            Column("roll_angle", t.roll_angle, "deg", "roll angle of the flank point"),
            Column("load", t.load, "N", "design load on the pair there"),
            Column("relief", t.relief, "um", "material to remove, along the normal"),
        ]
        if found.diagonal is not None:
            columns.append(Column("relief_diagonal", found.diagonal, "um", "without the neighbours' loads (Mark 5.4)"))
        if found.error is not None:
            columns.append(Column("relief_error", found.error, "um", "estimated error of relief"))
        title = f"Relief of gear {inputs.gears[member]} in pair {name}"
        tables.append(Table(f"relief_{label}", tuple(columns), title))
    return tables


def _ground_table(
    name: str, ground: Mapping[Shape, TipReliefPair], te: Mapping[str, TransmissionError], p: GearPair
) -> Table:
    # What is left comes from the same evaluation as the single values, not from the search's coarser one.
    rows = [(shape, m, te[f"{shape} tip relief"], getattr(g, m)) for shape, g in ground.items() for m in MEMBERS]
    start = np.array([r.start for *_, r in rows])
    runner_up = np.array([ground[shape].runner_up for shape, *_ in rows])
    base = np.array([p.gear(m).base_radius for _, m, *_ in rows])
    return Table(
        f"grindable_{name}",
        (
            Column("shape", np.array([shape for shape, *_ in rows]), "", "of the tip relief"),
            Column("gear", np.array([m for _, m, *_ in rows]), "", "driver or driven"),
            Column("amount", np.array([r.amount for *_, r in rows]), "um", "removal at the tip"),
            Column("start_roll_angle", start, "deg", "where the relief starts"),
            Column("start_radius", base * np.hypot(1.0, start), "mm", "the same as a radius"),
            Column("te_peak_to_peak", np.array([t.peak_to_peak for _, _, t, _ in rows]), "um", "left at design load"),
            Column("te_effective", np.array([t.effective_error for _, _, t, _ in rows]), "um", "A_e left"),
            Column("candidates", np.array([ground[shape].candidates for shape, *_ in rows]), "", "reliefs scanned"),
            Column("starts", np.array([ground[shape].starts for shape, *_ in rows]), "", "valleys searched to the end"),
            Column("agreeing", np.array([ground[shape].agreeing for shape, *_ in rows]), "", "of them, within 5 %"),
            Column("runner_up", runner_up, "um", "the least that the other valleys leave"),
        ),
        f"Tip reliefs of {name} that a shop can grind",
    )


def _harris_table(name: str, curves: Mapping[str, Loaded]) -> Table:
    first = next(iter(curves.values()))
    n, loads = first.x.size, first.load
    columns = [
        Column("total_load", np.repeat(loads, n), "N", "along the line of action"),
        Column("x", np.tile(first.x, loads.size), "mm", "roll position over one base pitch"),
    ]
    for label, curve in curves.items():
        head = "te_" + label.replace(" ", "_")
        columns.append(Column(head, curve.transmission_error.T.ravel(), "um", f"transmission error, {label}"))
    return Table(f"harris_map_{name}", tuple(columns), f"Harris map of {name}")


def _values(name: str, design: ReliefDesign) -> list[Value]:
    values = []
    for label, t in design.te.items():
        key = label.replace(" ", "_")
        error = design.left if label == "designed" else None
        values.append(Value(f"{name}.te_peak_to_peak.{key}", t.peak_to_peak, "um", error, f"{label}, design load"))
        values.append(Value(f"{name}.te_effective.{key}", t.effective_error, "um", None, f"A_e, {label}, design load"))
    about = "designed, its relief tables read back linearly, design load"
    values.append(Value(f"{name}.te_peak_to_peak.relief_tables", design.tables_leave, "um", None, about))
    values.append(Value(f"{name}.te_mean.designed", design.te["designed"].mean, "um", None, "design load"))
    for member, found in design.reliefs.items():
        largest = float(found.table.relief.max())
        values.append(Value(f"{name}.{member}.largest_relief", largest, "um", None, "over the path"))
    return values


def _remarks(data: ReliefData, inputs: ReliefInputs) -> tuple[str, ...]:
    remarks, te, name = [], data.design.te, inputs.asked.name
    if "diagonal only" in te:
        d, n = te["diagonal only"].peak_to_peak, te["no relief"].peak_to_peak
        remarks.append(
            f"Pair {name}: a design without the neighbours' loads (Mark 5.4) would leave {d * 1e6:.3g} um, "
            f"{d / te['diagonal only'].mean:.1%} of the mean, peak to peak, and {d / n:.0%} of what no relief leaves."
        )
    return (*remarks, *design_remarks(name, data.neglected, inputs.effects, inputs.tolerance))


def _figures(name: str, data: ReliefData, tables: Sequence[Table], gears: Sequence[str]) -> tuple[Figure, ...]:
    return _relief_figure(name, data, tables, gears), _candidates_figure(name, data), _harris_figure(name, data)


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
        loaded = roll[shown["load"] > 0.0]
        zone = Zone("x", float(loaded.min()), float(loaded.max()))
        reliefs.append(Panel(x, Axis("material to remove", "um"), tuple(curves), (zone,), f"{member}: gear {gear}"))
        load = Curve(roll, shown["load"], "load of the design", "grey", dash="solid", markers=False)
        loads.append(Panel(x, Axis("load", "N", zero=True), (load,), (zone,), f"{member}: load", height=0.6))
    return Figure(
        f"relief_{name}",
        f"Profile relief of {name}",
        f"Pair {name}: relief of both gears for {data.design.task.load:.5g} N over the active profile, and the load of "
        "the tooth. Shaded: the design zone, where the tooth is loaded at the design load. Ground reliefs are at the "
        "tips only; a constant over the whole flank makes no difference.",
        (*reliefs, *loads),
        columns=2,
    )


def _candidates_figure(name: str, data: ReliefData) -> Figure:
    curves = []
    for label, curve in data.design.curves.items():
        i = int(np.argmin(np.abs(curve.load - data.design.task.load)))
        te = (curve.transmission_error[:, i] - data.design.te[label].mean) * 1e6
        left = data.design.te[label].peak_to_peak * 1e6
        size = f"{left:.3g} µm" if left > 1e-6 else "0"
        curves.append(Curve(curve.x * 1e3, te, f"{label}: {size} peak to peak", label, markers=False))
    load = f"{data.design.task.load:.5g} N"
    caption = f"Pair {name}: what each relief leaves of the transmission error at the design load, {load}."
    if "diagonal only" in data.design.te:
        caption += (
            " Diagonal only: relief designed without the neighbours' loads (Mark, Eq. 5.4), on teeth that do deflect "
            "each other."
        )
    return Figure(
        f"relief_candidates_{name}",
        f"Transmission error with and without relief, {name}",
        caption,
        (Panel(BASE_PITCH, Axis("transmission error less its mean", "um"), tuple(curves)),),
    )


def _harris_figure(name: str, data: ReliefData) -> Figure:
    views = []
    order = sorted(data.design.curves, key=lambda label: label == "diagonal only")
    for label in order:
        curve = data.design.curves[label]
        loads = [float(w) for w in curve.load]
        curves = tuple(
            Curve(curve.x * 1e3, curve.transmission_error[:, i] * 1e6, text, role)
            for i, text, role in drawn_loads(loads, data.design.task.load, "design")
        )
        views.append(View(label, (Panel(BASE_PITCH, Axis("transmission error", "um", zero=True), curves),)))
    return Figure(
        f"harris_map_{name}",
        f"Harris map of {name}",
        f"Pair {name}: transmission error over the mesh cycle for a family of loads, with each relief.",
        views=tuple(views),
    )


def _forecast(scene: Scene, name: str) -> Forecast:
    """Reliefs to grind, fitted by repeated load sharing."""
    design = scene.case.design
    grind = len(design.grind) if design else 2
    return forecasts.constant(0.1 + 0.3 * grind * (1.3 if forecasts.engagements(scene, name) > 1 else 1.0))


RELIEF = Stage(
    name="relief",
    title="Relief for least excitation",
    results=("relief",),
    subjects=design_pairs,
    needs=needs_pair,
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    effects=DESIGN_EFFECTS,
    cites=citing(
        Citation("mark", "relief that leaves no transmission error at the design load", "Eqs. 4.6 to 4.16, 5.4"),
        Citation("lin-townsend-oswald", "linear and parabolic tip relief"),
        Citation("harris", "Harris maps"),
    ),
    forecast=_forecast,
)
