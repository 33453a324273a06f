"""Stage ``root-stress-study``: a sweep of teeth that shows where each formula is high, low or breaks down.

How often each root-stress formula is how far off over a population of gears: a picture, a sentence a formula.
"""

from __future__ import annotations

import math
from dataclasses import asdict, dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.base.shown import declared
from fegear.case.built.tooth_influence import mesh_settings, seconds_of_gear
from fegear.engine.citation import citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure, View
from fegear.engine.figure.items import Curve, HeatMap, Mark, Points, Zone
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results import forecasts
from fegear.results.forecasts import RING, ROOT_STRESS_FORMULAS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from numpy.typing import NDArray

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.case.studies import StudyPart
    from fegear.contact.compared.root_stress_study import Variant, VariantStress
    from fegear.fem.plane.settings import MeshSettings
    from fegear.geometry.gear import Gear


_KEYS = ("teeth", "profile_shift", "rack_tip_radius", "load_position")


#: Ratios beyond 1 -+ this have the full colour; height of a row of tiles; steps and end of the histogram.
_FULL, _TILE, _BIN, _WIDEST = 0.4, 0.1, 0.05, 2.0


#: Share of the room of a number of teeth in which the formulas stand next to each other.
_LANES = 0.8


_RATIO = "root stress, formula / FE"


def _gear(scene: Scene) -> str:
    study = scene.case.study
    return (study.gear if study else None) or next(iter(scene.spur_gears))


def _study(scene: Scene) -> StudyPart:
    if scene.case.study is None:
        raise InputError("study", "(not given)", "is required for root-stress-study", "add a table [study]")
    return scene.case.study


def _check(scene: Scene, _subject: str) -> None:
    study = _study(scene)
    if study.gear is None and len(scene.spur_gears) > 1:
        raise InputError(
            "study.gear", "(not given)", "must specify the gear to vary", f"one of {', '.join(scene.spur_gears)}"
        )
    name = _gear(scene)
    for key in ("tip_diameter", "tooth_mesh"):
        if getattr(scene.case.gear[name], key) is not None:
            raise InputError(f"gear.{name}.{key}", "(given)", "is not used in a study of many gears", f"remove {key}")


def _rack(v: Variant) -> tuple[float, float]:
    """Dedendum [modules] and pressure angle [rad] of a gear's rack."""
    if v.gear is None:
        return math.nan, math.nan
    rack = v.gear.external_tooth.rack
    return rack.dedendum, rack.pressure_angle


def _table(found: tuple[VariantStress, ...], names: tuple[str, ...], module: float, *, drawn: bool) -> Table:
    from fegear.contact.compared.crosscheck import RootStressAnswers
    from fegear.contact.compared.root_stress_study import verdict

    rows = []
    for one in found:
        v = one.variant
        for name in names:
            answers = one.answers.get(name)
            for i, position in enumerate(one.position):
                stress = answers.stress[i] if answers else np.nan
                ratio = stress / one.fe[i]
                rows.append(
                    (
                        v.teeth,
                        v.profile_shift,
                        v.rack_tip_radius,
                        position,
                        one.radius[i],
                        name,
                        stress / module,
                        one.fe[i] / module,
                        ratio,
                        answers.tangent_angle[i] if answers else np.nan,
                        one.fe_angle[i],
                        verdict(ratio),
                        answers.reasons[i] if answers else v.reason,
                        *((_rack(v)[0], _rack(v)[1], one.fe_error[i] / module) if drawn else ()),
                    )
                )
    columns = list(zip(*rows, strict=True))
    heads: tuple[tuple[str, str, str], ...] = (
        ("teeth", "", "number of teeth"),
        ("profile_shift", "", "profile shift coefficient"),
        ("rack_tip_radius", "", "of the basic rack, in modules"),
        ("load_position", "", "load position: fraction of roll angle from start (0) to end (1) of the involute"),
        ("load_radius", "mm", "radius of the load"),
        ("formula", "", "name of the formula"),
        ("stress", "MPa.mm/N", "root stress per line load, formula"),
        ("stress_fe", "MPa.mm/N", "root stress per line load, FE"),
        ("ratio_to_fe", "", "formula / FE"),
        ("place_angle", "deg", "angle of the fillet tangent at the critical section, formula"),
        ("place_angle_fe", "deg", "angle of the fillet tangent at the maximum, FE"),
        ("verdict", "", "high, low, within 5 %, or no result"),
        ("reason", "", declared(RootStressAnswers, "reasons").meaning),
    )
    if drawn:
        heads += (
            ("rack_dedendum", "", "of the basic rack, in modules"),
            ("pressure_angle", "deg", "of the basic rack"),
            ("stress_fe_error", "MPa.mm/N", "estimated error of FE"),
        )
    made = (Column(h, np.array(c), unit, meaning) for (h, unit, meaning), c in zip(heads, columns, strict=True))
    return Table("root_stress_study", tuple(made), "Over- and underestimation of each root-stress formula")


def _values(table: Table, names: tuple[str, ...], *, drawn: bool) -> tuple[Value, ...]:
    """Ratios and shares of all points; shares of drawn gears are those of their box within a standard error."""
    from fegear.contact.compared.population import LOADS, share_error

    values = []
    for name in names:
        ratio = np.asarray(table["ratio_to_fe"], dtype=float)[table["formula"] == name]
        r = ratio[np.isfinite(ratio)]
        verdicts = table["verdict"][table["formula"] == name]
        if r.size:
            for key, number, words in (
                ("lowest_ratio", r.min(), "minimum formula / FE"),
                ("median_ratio", np.median(r), "median formula / FE"),
                ("highest_ratio", r.max(), "maximum formula / FE"),
            ):
                values.append(Value(f"{name}.{key}", float(number), "", None, f"{words} in the study"))
        for key in ("high", "low", "within 5 %", "breaks down"):
            hits = verdicts == key
            error = share_error(hits.reshape(-1, LOADS)) if drawn else 0.0
            head = key.replace(" %", "_percent").replace(" ", "_")
            values.append(
                Value(f"{name}.share_{head}", float(np.mean(hits)), "", error, f"fraction of all points: {key}")
            )
    return tuple(values)


@dataclass(frozen=True)
class StudyInputs:
    """What the study depends on.

    Parameters
    ----------
    base : Gear
        The gear that is varied.
    study : StudyPart
    settings : MeshSettings
    """

    base: Gear
    study: StudyPart
    settings: MeshSettings


def _inputs(scene: Scene, _subject: str) -> StudyInputs:
    return StudyInputs(scene.gears[_gear(scene)], _study(scene), mesh_settings(scene.case.accuracy))


def _compute(asked: StudyInputs, _upstream: Upstream, work: Work) -> tuple[VariantStress, ...]:
    from fegear.contact.compared.population import drawn_gears
    from fegear.contact.compared.root_stress_study import of_population, root_stress_study, variants

    study, tooth = asked.study, asked.base.external_tooth
    if study.samples:
        population = of_population(drawn_gears(asked.base, study.bounds, study.samples, study.seed))
        settings, progress, cache = asked.settings, work.progress, work.cache
        return tuple(root_stress_study(population, (), settings, progress, cache, estimate_error=True))
    gears = variants(
        asked.base,
        study.teeth or [tooth.teeth],
        study.profile_shift or [tooth.profile_shift],
        study.rack_tip_radius or [tooth.rack.tip_radius],
    )
    return tuple(root_stress_study(gears, study.load_position, asked.settings, work.progress, work.cache))


def _present(found: tuple[VariantStress, ...], asked: StudyInputs) -> Outcome:
    from fegear.formulas.sources import ROOT_STRESS_SOURCES

    base, names, drawn = asked.base, tuple(ROOT_STRESS_SOURCES), asked.study.samples is not None
    table = _table(found, names, base.module, drawn=drawn)
    about = (
        "Study of root stress: one tooth of the full gear, load normal to the flank, no friction; FE: maximum "
        "tangential stress in the fillet of the loaded flank, including radial compression; ratio of bore to root "
        f"radius {base.bore_radius / base.root_radius:.4g} in all gears. A stress per line load is the same in plane "
        "stress and plane strain."
    )
    remarks = (about, *(f"{s.name} ({s.citation}): {s.compared}." for s in ROOT_STRESS_SOURCES.values()))
    settings = {**asdict(asked.settings), "gears": len(found)}
    if drawn:
        remarks = (about, *sentences(_columns(table)), *remarks[1:])
        return Outcome(
            found, (table,), _values(table, names, drawn=drawn), settings, remarks, (spread_figure(_columns(table)),)
        )
    return Outcome(found, (table,), _values(table, names, drawn=drawn), settings, remarks, _figures(table, names))


def _columns(table: Table) -> dict[str, Array]:
    """The columns by name, the pressure angle in degrees: in what is read by people."""
    columns = {column.name: np.asarray(column.values) for column in table.columns}
    return {**columns, "pressure_angle": np.degrees(columns["pressure_angle"])}


def _figures(table: Table, names: tuple[str, ...]) -> tuple[Figure, ...]:
    ratio = np.asarray(table["ratio_to_fe"], dtype=float)
    found = _tiles(table, names, ratio), _scatter(table, names, ratio)
    return (*found, _histogram(table, names, ratio)) if np.isfinite(ratio).any() else found


def _tiles(table: Table, names: tuple[str, ...], ratio: Array) -> Figure:
    """A tile for every gear, load position and formula."""
    keys = [np.asarray(table[key], dtype=float) for key in _KEYS[:3]]
    gears = list(dict.fromkeys(zip(*keys, strict=True)))
    positions = list(dict.fromkeys(float(p) for p in table["load_position"]))
    labels = tuple(f"{z:.0f} | {x:+.2g} | {r:.2g}" for z, x, r in gears)
    shares = tuple(f"{p:g}" for p in positions)
    edges = np.flatnonzero(np.diff([z for z, *_ in gears]))
    marks = tuple(Mark("y", len(gears) - 1.5 - int(edge)) for edge in edges)
    axes = (
        Axis("load position: fraction of roll angle (0 start, 1 end)", categories=shares),
        Axis("teeth | profile shift | rack tip radius in modules", categories=labels[::-1]),
    )
    tiles = ratio.reshape(len(gears), len(names), len(positions))
    across, down = np.arange(len(positions)), np.arange(len(gears))[::-1]
    views = tuple(
        View(name, (Panel(
            *axes, (HeatMap(across, down, tiles[:, i], _RATIO, centre=(1.0, _FULL), numbers=True),),
            marks, height=_TILE * len(gears),
        ),))
        for i, name in enumerate(names)
    )  # fmt: skip
    return Figure(
        "root_stress_study",
        "Over- and underestimation of each root-stress formula",
        "Root stress of one tooth under a load normal to the flank, formula over finite elements: white: agreement, "
        "orange: overestimate (conservative), blue: underestimate, × on grey: formula not applicable (reason in the "
        "table).",
        views=views,
        most_views=len(views),
    )


def _scatter(table: Table, names: tuple[str, ...], ratio: Array) -> Figure:
    points, counts = [], np.unique(np.asarray(table["teeth"], dtype=float))
    lane = _LANES / len(names)
    for number, name in enumerate(names):
        rows = table["formula"] == name
        found = zip(*(np.asarray(table[key], dtype=float)[rows] for key in _KEYS), strict=True)
        notes = tuple(
            f"{name}: {z:.0f} teeth, shift {x:.3g}, rack tip radius {r:.3g}, load position {p:.3g}"
            for z, x, r, p in found
        )
        teeth = np.searchsorted(counts, np.asarray(table["teeth"], dtype=float)[rows])
        place = teeth + lane * (number - 0.5 * (len(names) - 1))
        points.append(Points(place, ratio[rows], name, f"series:{number}", size=4.5, notes=notes))
    ticks = tuple((float(k), f"{z:.0f}") for k, z in enumerate(counts))
    edges = tuple(Mark("x", k + 0.5) for k in range(counts.size - 1))
    panel = Panel(
        Axis("number of teeth; one bar per formula", ticks=ticks),
        Axis("formula / FE"),
        tuple(points),
        (*edges, Mark("y", 1.0, "finite elements")),
    )
    return Figure(
        "root_stress_ratios",
        "Root-stress formulas relative to FE",
        "One point for each gear and load position; 1 agrees, above 1 is safe. In the report, hover over a point to "
        "identify the gear.",
        (panel,),
    )


def _histogram(table: Table, names: tuple[str, ...], ratio: Array) -> Figure:
    edges, curves = np.arange(0.0, _WIDEST + 0.5 * _BIN, _BIN), []
    for number, name in enumerate(names):
        count, _ = np.histogram(ratio[(table["formula"] == name) & np.isfinite(ratio)], edges)
        curves.append(Curve(edges, np.append(count, 0), name, f"series:{number}", dash="steps", markers=False))
    panel = Panel(Axis("formula / FE"), Axis("points", zero=True), tuple(curves), (Mark("x", 1.0, "agreement"),))
    return Figure(
        "root_stress_histogram",
        "Distribution of formula / FE",
        f"Distribution of the ratio formula / FE over the points of the study, in steps of {_BIN:g}.",
        (panel,),
    )


def _forecast(scene: Scene, _subject: str) -> Forecast:
    """One gear without neighbours and without its error for each combination."""
    study, settings = scene.case.study, mesh_settings(scene.case.accuracy)
    if study is None:
        return Forecast()
    count = math.prod(len(values or [0]) for values in (study.teeth, study.profile_shift, study.rack_tip_radius))
    each = 0.3
    if study.samples:
        count, each = study.samples, 0.5
    seconds = forecasts.LIBRARIES + each * count * seconds_of_gear(settings)
    return Forecast({"gears": count, **asdict(settings)}, seconds)


#: Columns of a range, and the words and units by which a sentence calls them.
WORDS = {
    "teeth": ("z", ""),
    "profile_shift": ("x", ""),
    "rack_tip_radius": ("rack tip radius", "modules"),
    "rack_dedendum": ("rack dedendum", "modules"),
    "pressure_angle": ("pressure angle", "°"),
    "load_position": ("load position", ""),
}


#: Ratios that the picture shows; what lies beyond stands at its edges.
_SHOWN = (0.5, 1.5)


#: Load positions from which on a load counts as high: about where the outer point of single pair contact begins.
HIGH = 0.5


def _number(table: Mapping[str, Array], key: str) -> Array:
    return np.asarray(table[key], dtype=float)


def names_of(table: Mapping[str, Array]) -> tuple[str, ...]:
    """Names of the formulas of a table of a study, in its order."""
    return tuple(dict.fromkeys(str(n) for n in table["formula"]))


def fe_error(table: Mapping[str, Array]) -> float:
    """95th percentile of the estimated relative error of the finite elements."""
    fe, off = _number(table, "stress_fe"), _number(table, "stress_fe_error")
    known = np.isfinite(fe) & np.isfinite(off)
    return float(np.quantile(off[known] / fe[known], 0.95)) if known.any() else 0.0


def sentences(table: Mapping[str, Array]) -> tuple[str, ...]:
    """A sentence for each formula: where it is near the finite elements, and how far off it is over all gears.

    Parameters
    ----------
    table : mapping of str to ndarray
        Columns of table ``root_stress_study`` of gears that were drawn.
    """
    from fegear.contact.compared.formula_reach import reach, sentence

    found = []
    for name in names_of(table):
        rows = np.asarray(table["formula"]) == name
        columns = {key: _number(table, key)[rows] for key in WORDS}
        keys = np.stack([columns[key] for key in WORDS if key != "load_position"], axis=1)
        _, gear = np.unique(np.nan_to_num(keys), axis=0, return_inverse=True)
        # Numbered in the order of drawing: any run of them fills the box evenly, sorted ones would not.
        order = {int(g): i for i, g in enumerate(dict.fromkeys(gear.ravel().tolist()))}
        number = np.array([order[int(g)] for g in gear.ravel()])
        high = columns["load_position"] >= HIGH
        found.append(sentence(reach(name, _number(table, "ratio_to_fe")[rows], columns, number, high), WORDS))
    return tuple(found)


def bounds_in_words(table: Mapping[str, Array]) -> str:
    """What the population spans."""
    parts = []
    for key, (word, unit) in WORDS.items():
        values = _number(table, key)
        low, high = float(np.nanmin(values)), float(np.nanmax(values))
        tail = ("" if unit == "°" else " ") + unit if unit else ""
        parts.append(f"{word} {low:.3g}{tail}" if low == high else f"{word} {low:.3g} to {high:.3g}{tail}")
    return ", ".join(parts)


def spread_figure(table: Mapping[str, Array], key: str = "root_stress_spread") -> Figure:
    """Cumulative distribution of formula over finite elements, a curve for each formula: all loads, and high ones."""
    off, upper = fe_error(table), _number(table, "load_position") >= HIGH
    panels = [_panel(table, np.ones(upper.size, dtype=bool), "all loads", off)]
    if upper.any() and not upper.all():
        panels.append(_panel(table, upper, "loads on the upper half of the flank (as in ratings)", off))
    gears = len(np.unique(np.stack([_number(table, k) for k in WORDS if k != "load_position"], axis=1), axis=0))
    points = int((np.asarray(table["formula"]) == names_of(table)[0]).sum())
    return Figure(
        key,
        "Distribution of the errors of the root-stress formulas",
        f"{points} loads on {gears} gears drawn evenly over {bounds_in_words(table)} (share of the roll angle). Left "
        "of 1: stress underestimated (unsafe). The steeper the curve, the better a constant correction factor works. "
        "Grey, and narrower than the dotted line where it is not seen: estimated error of the finite elements, "
        f"{100.0 * off:.2g} % at 95 % of the points.",
        tuple(panels),
        columns=2,
    )


def _panel(table: Mapping[str, Array], rows: NDArray[np.bool_], title: str, off: float) -> Panel:
    curves = []
    for number, name in enumerate(names_of(table)):
        ratio = _number(table, "ratio_to_fe")[rows & (np.asarray(table["formula"]) == name)]
        curves.append(spread_curve(ratio, name, f"series:{number}"))
    return Panel(
        Axis("root stress, formula / FE", limits=_SHOWN),
        Axis("fraction of points with a smaller ratio", "%", limits=(0.0, 100.0)),
        tuple(c for c in curves if c is not None),
        (Zone("x", 1.0 - off, 1.0 + off), Mark("x", 1.0), Mark("y", 50.0)),
        title=title,
    )


def spread_curve(ratio: Array, name: str, role: str) -> Curve | None:
    """Share of points [%] below each ratio, of those at which the formula answers; None where it answers nowhere."""
    known = np.sort(ratio[np.isfinite(ratio)])
    if not known.size:
        return None
    share = 100.0 * np.arange(1, known.size + 1) / known.size
    below = 100.0 * float((known < _SHOWN[0]).mean())
    x = np.concatenate([[_SHOWN[0]], np.clip(known, *_SHOWN), [_SHOWN[1]]])
    return Curve(x, np.concatenate([[below], share, [100.0]]), name, role, dash="steps", markers=False)


ROOT_STRESS_STUDY = Stage(
    subjects=lambda scene: ("",) if scene.spur_gears else (),
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    cites=citing(*ROOT_STRESS_FORMULAS, *RING),
    forecast=_forecast,
)
