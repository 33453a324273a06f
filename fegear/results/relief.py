"""Stage ``relief``: the profile relief of both gears that removes the transmission error at the design load."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.case.design import DesignPart
from fegear.engine.citation import Citation, citing
from fegear.engine.figure import Axis, Curve, Figure, Panel, View, Zone
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Forecast, Stage
from fegear.errors import InputError
from fegear.models.neglected_effects import design_remarks, neglected_in_design
from fegear.models.pair_inputs import gear_name, pair_inputs
from fegear.results import forecasts
from fegear.results.loaded_pair import BASE_PITCH, drawn_loads, loaded_pair, needs_pair
from fegear.results.root_stress_history import table_names
from fegear.results.transmission_error import HARMONICS, POSITIONS

if TYPE_CHECKING:
    from collections.abc import Sequence

    from numpy.typing import NDArray

    from fegear.case.reading import Scene
    from fegear.contact import Engagement, Loaded, TransmissionError
    from fegear.design import LoadingFunction, MinimumExcitationRelief, TipReliefPair
    from fegear.design.minimum_excitation import ReliefTable
    from fegear.engine.stage import Done, Progress
    from fegear.geometry.pair import Member
    from fegear.geometry.relief import Shape
    from fegear.models.loaded_pair import LoadedPair

    Array = NDArray[np.float64]

#: What the design knows of the effects; the gears' own reliefs are what it replaces.
DESIGN_EFFECTS = ("neighbour_coupling", "hertz", "corner_contact")


@dataclass(frozen=True)
class ReliefData:
    """What the stage hands to pictures and later stages.

    Parameters
    ----------
    pair : LoadedPair
    loading : LoadingFunction
    load : float
        W_d [N].
    designed : Engagement
        With the relief of (4.6) by the full influence matrix.
    tables : mapping of member to ReliefTable
    ground : mapping of shape to TipReliefPair
        What a shop can grind.
    te : mapping of str to TransmissionError
        At the design load: "no relief", "designed", "diagonal only", and each shape ground.
    curves : mapping of str to Loaded
        The same over roll positions, for every load of the case.
    """

    pair: LoadedPair
    loading: LoadingFunction
    load: float
    designed: Engagement
    tables: dict[Member, ReliefTable]
    ground: dict[Shape, TipReliefPair]
    te: dict[str, TransmissionError]
    curves: dict[str, Loaded]


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


def _loading(scene: Scene, pair: LoadedPair) -> LoadingFunction:
    from fegear.design import LoadingFunction, Ramp

    part, p = design_part(scene), pair.engagement.pair
    length = part.length or (part.contact_ratio * p.base_pitch if part.contact_ratio else p.path_length)
    centre = 0.5 * (p.x_start + p.x_end) if part.centre is None else part.centre
    exponent = (part.exponent or 7) if part.family == "polynomial" else None
    peak = part.peak if isinstance(part.peak, float) else math.nan
    ramp, inner = Ramp(part.slope, exponent), Ramp(part.inner_slope, exponent)
    return LoadingFunction(length, p.base_pitch, centre, ramp, inner, peak)


def _least_stress(
    scene: Scene, name: str, pair: LoadedPair, loading: LoadingFunction, load: float
) -> tuple[LoadingFunction, Table, Value]:
    from fegear.design import design_stress, least_root_stress

    if scene.case.pair[name].compliance.source != "fe":
        raise InputError(
            "design.peak", '"least-root-stress"', "needs root stresses", f'set pair.{name}.compliance.source = "fe"'
        )
    best = least_root_stress(design_stress(pair.engagement.compliance), loading)
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
    value = Value(f"{name}.design_root_tension", best.stress * load, "MPa", None, "largest of both gears, design load")
    return best.loading, table, value


def _relief_tables(
    scene: Scene,
    name: str,
    designed: Engagement,
    diagonal: Engagement | None,
    others: list[Engagement],
) -> tuple[dict[Member, ReliefTable], list[Table]]:
    from fegear.design import relief_nodes, relief_table

    nodes = relief_nodes(
        *(cast("MinimumExcitationRelief", r) for r in (designed.driver_relief, designed.driven_relief))
    )
    found: dict[Member, ReliefTable] = {}
    tables = []
    for member, label in table_names(scene, name).items():

        def of(e: Engagement, member: Member = member) -> MinimumExcitationRelief:
            # minimum_excitation has put its own relief on both flanks
            return cast("MinimumExcitationRelief", e.driver_relief if member == "driver" else e.driven_relief)

        t = found[member] = relief_table(of(designed), nodes)
        columns = [
            Column("x", t.x, "mm", "position on the line of action, positive toward the driver's tip"),
            Column("radius", t.radius, "mm", "radius of the flank point"),
            Column("roll_angle", t.roll_angle, "deg", "roll angle of the flank point"),
            Column("load", t.load, "N", "design load on the pair there"),
            Column("relief", t.relief, "um", "material to remove, along the normal"),
        ]
        if diagonal is not None:
            plain = of(diagonal).at(t.x)
            columns.append(Column("relief_diagonal", plain, "um", "without the neighbours' loads (Mark 5.4)"))
        if others:
            error = np.sum([np.abs(of(other).at(t.x) - t.relief) for other in others], axis=0)
            columns.append(Column("relief_error", error, "um", "estimated error of relief"))
        gear = gear_name(scene, name, member)
        tables.append(Table(f"relief_{label}", tuple(columns), f"Relief of gear {gear} in pair {name}"))
    return found, tables


def _ground_table(
    name: str, pair: LoadedPair, ground: dict[Shape, TipReliefPair], te: dict[str, TransmissionError]
) -> Table:
    # What is left comes from the same evaluation as the single values, not from the search's coarser one.
    members: tuple[Member, Member] = ("driver", "driven")
    rows = [(shape, m, te[f"{shape} tip relief"], getattr(g, m)) for shape, g in ground.items() for m in members]
    p = pair.engagement.pair
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


def _run(scene: Scene, name: str, done: Done, progress: Progress) -> Outcome:
    from fegear.contact import transmission_error
    from fegear.contact.mesh_curve import roll_positions
    from fegear.design import grindable, minimum_excitation
    from fegear.geometry.relief import UNMODIFIED

    pair, part = loaded_pair(done, name), design_part(scene)
    load = part.load or pair.nominal
    loading, values, tables = _loading(scene, pair), [], []
    if part.peak == "least-root-stress":
        loading, table, value = _least_stress(scene, name, pair, loading, load)
        tables.append(table)
        values.append(value)
    plain = replace(pair.engagement, driver_relief=UNMODIFIED, driven_relief=UNMODIFIED)
    plain = replace(plain, driver_spacing=np.empty(0), driven_spacing=np.empty(0))
    states = {"no relief": plain, "designed": minimum_excitation(plain, loading, load)}
    designed = states["designed"]
    coupled = plain.compliance.coupling and max(plain.compliance.driver.reach, plain.compliance.driven.reach) > 0
    if coupled:
        states["diagonal only"] = minimum_excitation(plain, loading, load, full_matrix=False)
    others = [minimum_excitation(replace(plain, compliance=s.compliance), loading, load) for s in pair.shifted]
    found, relief_tables = _relief_tables(scene, name, designed, states.get("diagonal only"), others)
    tables += relief_tables
    progress(0.3)
    ground: dict[Shape, TipReliefPair] = {}
    for number, shape in enumerate(dict.fromkeys(part.grind)):
        ground[shape] = grindable(designed, load, shape, part.metric)
        states[f"{shape} tip relief"] = ground[shape].applied(plain)
        progress(0.3 + 0.5 * (number + 1) / len(part.grind))
    te = {label: transmission_error(state, load, HARMONICS) for label, state in states.items()}
    if ground:
        tables.append(_ground_table(name, pair, ground, te))
    loads = sorted({*pair.loads, load})
    x = roll_positions(pair.engagement, POSITIONS)
    curves = {label: state.solve(state.grid(x), loads) for label, state in states.items()}
    tables.append(_harris_table(name, curves))
    values += _values(name, pair, designed, te, found)
    settings = {
        "design_load": load, "design_contact_ratio": loading.length / loading.base_pitch, "peak": loading.peak,
        "slope": loading.ramp.slope, "exponent": loading.ramp.exponent or 0, "centre": loading.centre,
    }  # fmt: skip
    data = ReliefData(pair, loading, load, designed, found, ground, te, curves)
    figures = _figures(name, data, relief_tables, [gear_name(scene, name, member) for member in found])
    return Outcome(data, tuple(tables), tuple(values), settings, _remarks(scene, name, designed, te), figures)


def _harris_table(name: str, curves: dict[str, Loaded]) -> Table:
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


def _values(
    name: str,
    pair: LoadedPair,
    designed: Engagement,
    te: dict[str, TransmissionError],
    found: dict[Member, ReliefTable],
) -> list[Value]:
    from fegear.contact import transmission_error

    values = []
    # How much transmission error a design with compliances that are off by their error leaves on the true teeth.
    left = None
    if pair.shifted:
        left = 0.0
        for shifted in pair.shifted:
            state = replace(designed, compliance=shifted.compliance)
            left += transmission_error(state, te["designed"].load, HARMONICS).peak_to_peak
    for label, t in te.items():
        key = label.replace(" ", "_")
        error = left if label == "designed" else None
        values.append(Value(f"{name}.te_peak_to_peak.{key}", t.peak_to_peak, "um", error, f"{label}, design load"))
        values.append(Value(f"{name}.te_effective.{key}", t.effective_error, "um", None, f"A_e, {label}, design load"))
    read = replace(designed, driver_relief=found["driver"].relieved(), driven_relief=found["driven"].relieved())
    tables_leave = transmission_error(read, te["designed"].load, HARMONICS).peak_to_peak
    about = "designed, its relief tables read back linearly, design load"
    values.append(Value(f"{name}.te_peak_to_peak.relief_tables", tables_leave, "um", None, about))
    values.append(Value(f"{name}.te_mean.designed", te["designed"].mean, "um", None, "design load"))
    for member, relief in found.items():
        values.append(Value(f"{name}.{member}.largest_relief", float(relief.relief.max()), "um", None, "over the path"))
    return values


def _remarks(scene: Scene, name: str, designed: Engagement, te: dict[str, TransmissionError]) -> tuple[str, ...]:
    remarks = []
    if "diagonal only" in te:
        d, n = te["diagonal only"].peak_to_peak, te["no relief"].peak_to_peak
        remarks.append(
            f"Pair {name}: a design without the neighbours' loads (Mark 5.4) would leave {d * 1e6:.3g} um, "
            f"{d / te['diagonal only'].mean:.1%} of the mean, peak to peak, and {d / n:.0%} of what no relief leaves."
        )
    effects, tolerance = scene.case.effects, scene.case.accuracy.tolerance
    neglected = neglected_in_design(pair_inputs(scene, name), designed, te["designed"].load, tolerance)
    return (*remarks, *design_remarks(name, neglected, effects, tolerance))


def _figures(name: str, data: ReliefData, tables: Sequence[Table], gears: Sequence[str]) -> tuple[Figure, ...]:
    return _relief_figure(name, data, tables, gears), _candidates_figure(name, data), _harris_figure(name, data)


def _relief_figure(name: str, data: ReliefData, tables: Sequence[Table], gears: Sequence[str]) -> Figure:
    """Reliefs of both gears (`tables` and `gears` of driver and driven) and the loads that they were designed for."""
    x, reliefs, loads = Axis("roll angle", "deg"), [], []
    for member, table, gear in zip(data.tables, tables, gears, strict=True):
        shown = {column.name: np.asarray(column.shown, dtype=float) for column in table.columns}
        roll = shown["roll_angle"]
        curves = [Curve(roll, shown["relief"], "designed", "designed", shown.get("relief_error"), markers=False)]
        if "relief_diagonal" in shown:
            curves.append(Curve(roll, shown["relief_diagonal"], "diagonal only", "diagonal only", markers=False))
        for shape, ground in data.ground.items():
            label = f"{shape} tip relief"
            removal = getattr(ground, member).removal(table["roll_angle"]) * 1e6
            curves.append(Curve(roll, removal, label, label, markers=False))
        loaded = roll[shown["load"] > 0.0]
        zone = Zone("x", float(loaded.min()), float(loaded.max()))
        reliefs.append(Panel(x, Axis("material to remove", "um"), tuple(curves), (zone,), f"{member}: gear {gear}"))
        load = Curve(roll, shown["load"], "load of the design", "grey", dash="solid", markers=False)
        loads.append(Panel(x, Axis("load", "N", zero=True), (load,), (zone,), height=0.6))
    return Figure(
        f"relief_{name}",
        f"Profile relief of {name}",
        f"Pair {name}: relief of both gears for {data.load:.5g} N over the active profile, and the load of the tooth. "
        "Shaded: the design zone, where the tooth is loaded at the design load. Ground reliefs are at the tips only; a "
        "constant over the whole flank makes no difference.",
        (*reliefs, *loads),
        columns=2,
    )


def _candidates_figure(name: str, data: ReliefData) -> Figure:
    curves = []
    for label, curve in data.curves.items():
        i = int(np.argmin(np.abs(curve.load - data.load)))
        te = (curve.transmission_error[:, i] - data.te[label].mean) * 1e6
        left = data.te[label].peak_to_peak * 1e6
        told = f"{left:.3g} µm" if left > 1e-6 else "0"
        curves.append(Curve(curve.x * 1e3, te, f"{label}: {told} peak to peak", label, markers=False))
    caption = f"Pair {name}: what each relief leaves of the transmission error at the design load, {data.load:.5g} N."
    if "diagonal only" in data.te:
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
    order = sorted(data.curves, key=lambda label: label == "diagonal only")
    for label in order:
        curve = data.curves[label]
        loads = [float(w) for w in curve.load]
        curves = tuple(
            Curve(curve.x * 1e3, curve.transmission_error[:, i] * 1e6, text, role)
            for i, text, role in drawn_loads(loads, data.load, "design")
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
    run=_run,
    needs=needs_pair,
    effects=DESIGN_EFFECTS,
    cites=citing(
        Citation("mark", "relief that leaves no transmission error at the design load", "Eqs. 4.6 to 4.16, 5.4"),
        Citation("lin-townsend-oswald", "linear and parabolic tip relief"),
        Citation("harris", "Harris maps"),
    ),
    forecast=_forecast,
)
