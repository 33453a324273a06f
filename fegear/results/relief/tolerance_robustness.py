"""Stage ``tolerance-robustness``: a pair whose gears and housing deviate inside the tolerances of the drawing.

Figures of deviations drawn inside tolerances: distributions, which deviation matters, reliefs side by side.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.errors import FegearError, InputError
from fegear.base.units import from_si
from fegear.case.built.flank_errors import (
    chosen_pair,
    limits_of,
    refuse_jammed,
    refuse_no_tolerance,
    tolerance_part,
    untold,
)
from fegear.case.built.loaded_pair import check_relief
from fegear.case.built.pair_inputs import (
    EFFECTS,
    FINITE_ELEMENTS,
    check_formulas,
    gear_name,
    pair_inputs,
    root_stress_source,
)
from fegear.case.built.tooth_influence import gear_to_solve
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.figure import Axis, Figure, Panel, View
from fegear.engine.figure.items import Bars, Curve, Mark, Points
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage
from fegear.geometry.pair import MEMBERS
from fegear.results.forecasts import HERTZ
from fegear.results.gear.stiffness import solution_of
from fegear.results.pair.loaded_teeth import loaded_pair, needs_teeth
from fegear.results.pair.root_stress_history import needs_sources, stress_sources
from fegear.results.relief.tolerance_tables import (
    NOMINAL,
    OWN,
    ROBUST,
    SHOWN,
    PairDrawn,
    influence_table,
    leading_told,
    nominal,
    outcome,
    percentiles,
    search_told,
    told,
    tolerance_remarks,
    tolerance_tables,
    tolerance_values,
)

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from fegear.base.arrays import Array
    from fegear.case.built.pair_inputs import PairInputs
    from fegear.case.built.tooth_influence import GearToSolve
    from fegear.case.reading import Scene
    from fegear.case.studies import TolerancePart
    from fegear.design.robustness.deviated_pair import Bench
    from fegear.design.robustness.tolerance_draws import Deviations, Kind, Limits
    from fegear.design.tip_relief.robust import RobustRelief
    from fegear.engine.stage import Task, Upstream, Work
    from fegear.geometry.relief import Relief


#: Draws that a process is given at a time; each is computed alone, so that the number changes no bit.
CHUNK = 25


#: Beside the seed of the case, that of the draws over which reliefs are searched for.
_SEARCHED = 1


#: Processor seconds of a draw without and with corner contact, and of the search over its draws.
_DRAW, _DRAW_CORNERS, _SEARCH = 0.005, 0.014, 0.035


#: Kinds that are drawn of plane teeth unless the case names others.
_PLANE: tuple[Kind, ...] = ("centre-distance", "profile-slope", "profile-form", "pitch")


#: Chunks that are done here sooner than other processes start.
_FEW = 4


@dataclass(frozen=True)
class DrawInputs:
    """What the draws of a pair depend on.

    Parameters
    ----------
    part : TolerancePart
    teeth : PairInputs
    limits : Limits
    source : str
        Of root stress.
    solved : tuple of GearToSolve
        Gears whose finite elements are behind compliances or root stress.
    name : str
        Of the pair.
    gears : tuple of (str, str)
        Driver and driven.
    untold : tuple of str
        Sentences on deviations that the case does not tell.
    """

    part: TolerancePart
    teeth: PairInputs
    limits: Limits
    source: str
    solved: tuple[GearToSolve, ...]
    name: str = field(compare=False)
    gears: tuple[str, str] = field(compare=False)
    untold: tuple[str, ...] = field(compare=False)

    @property
    def load(self) -> float:
        """[N]."""
        return self.teeth.nominal

    @property
    def own_spacing(self) -> bool:
        """Whether the case has spacing errors, which draws replace."""
        return self.teeth.effects.spacing_errors


@dataclass(frozen=True)
class Chunk:
    """Some draws of one relief: all that a process needs."""

    inputs: DrawInputs
    relief: tuple[float, ...]
    bench: Bench
    deviations: Deviations


@dataclass(frozen=True)
class ToleranceData:
    """What came of the draws.

    Parameters
    ----------
    outcomes : tuple of str
        Names of the numbers of a draw.
    deviations : Deviations
    values : mapping of str to ndarray, shape (D, outcomes)
        By the state of relief; NaN for draws without a result.
    nominal : mapping of str to ndarray, shape (outcomes,)
        Without deviations.
    reasons : mapping of int to str
        Why draws have no result.
    exact : float
        Peak-to-peak transmission error of the nominal pair with points at its jumps [m]; NaN where it is not known.
    relief : RobustRelief or None
    nominal_relief : tuple of floats
        Numbers of the nominal optimum, see `RobustRelief`; empty where none is asked for.
    """

    outcomes: tuple[str, ...]
    deviations: Deviations
    values: Mapping[str, Array]
    nominal: Mapping[str, Array]
    reasons: Mapping[int, str]
    exact: float
    relief: RobustRelief | None
    nominal_relief: tuple[float, ...]


def compute_chunk(chunk: Chunk) -> dict[str, object]:
    """Outcomes of some draws, as plain data."""
    from fegear.base.one_thread import one_thread
    from fegear.design.robustness.deviated_pair import drawn_outcomes

    with one_thread():
        found = drawn_outcomes(chunk.bench, chunk.deviations)
    return {"values": found.values, "reasons": found.reasons}


def chunk_content(chunk: Chunk) -> object:
    """All that the numbers of a chunk depend on: its own draws, not how many there are besides."""
    asked = chunk.inputs
    return asked.teeth, asked.source, asked.solved, chunk.relief, chunk.deviations


def _subjects(scene: Scene) -> tuple[str, ...]:
    return tuple(name for name in chosen_pair(scene) if name in scene.plane_pairs)


def _check(scene: Scene, name: str) -> None:
    part = tolerance_part(scene)
    if part.deviations and "helix-slope" in part.deviations:
        raise InputError(
            "robustness.deviations", '"helix-slope"', "has no meaning for plane teeth, which are alike along the face",
            f'leave it out, or give pair.{name} width = "solid"',
        )  # fmt: skip
    limits = limits_of(scene, name, _PLANE)
    refuse_no_tolerance(scene, name, limits)
    refuse_jammed(scene.pairs[name], name, limits)
    check_relief(scene, name)
    check_formulas(scene, name, tips=scene.case.effects.corner_contact)


def _inputs(scene: Scene, name: str) -> DrawInputs:
    teeth = pair_inputs(scene, name)
    source = stress_sources(scene, name)[0]
    solved = teeth.gears if FINITE_ELEMENTS in (source, teeth.compliance.source) else ()
    gears = gear_name(scene, name, "driver"), gear_name(scene, name, "driven")
    return DrawInputs(
        tolerance_part(scene), teeth, limits_of(scene, name, _PLANE), source,
        tuple(gear_to_solve(scene, gear) for gear in dict.fromkeys(solved)), name, gears, untold(scene, gears, _PLANE),
    )  # fmt: skip


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    return (*needs_teeth(scene, name), *needs_sources(scene, name))


def _bench(asked: DrawInputs, upstream: Upstream) -> Bench:
    from fegear.design.robustness.deviated_pair import bench

    engagement = loaded_pair(upstream, asked.name).engagement
    fe = asked.source == FINITE_ELEMENTS
    solved = {gear: solution_of(upstream, gear) for gear in dict.fromkeys(asked.gears)} if fe else {}
    driver, driven = (
        root_stress_source(
            asked.source, asked.name, gear, engagement.pair, member, solved, tips=engagement.corner_contact
        )
        for gear, member in zip(asked.gears, MEMBERS, strict=True)
    )
    return bench(engagement, asked.teeth.nominal, (driver, driven))


def _compute(asked: DrawInputs, upstream: Upstream, work: Work) -> ToleranceData:
    from fegear.base.one_thread import one_thread
    from fegear.contact.plane.transmission_error import transmission_error
    from fegear.design.robustness.deviated_pair import OUTCOMES, drawn_outcomes
    from fegear.design.robustness.tolerance_draws import NO_LIMITS, draw

    part, own = asked.part, _bench(asked, upstream)
    deviations = draw(asked.limits, part.draws, part.seed, own.teeth, part.sequence, part.distribution)
    benches: dict[str, tuple[tuple[float, ...], Bench]] = {OWN: ((), own)}
    relief: RobustRelief | None = None
    numbers: tuple[float, ...] = ()
    with one_thread():
        exact = transmission_error(own.engagement, own.load, 12).peak_to_peak
        if part.reliefs is not None:
            numbers, relief, found = _reliefs(asked, own)
            benches |= found
        none = draw(NO_LIMITS, 1, 0, own.teeth)
        nominal = {state: drawn_outcomes(one, none).values[0] for state, (_, one) in benches.items()}
    starts = range(0, part.draws, CHUNK)
    chunks = [
        Chunk(asked, key, one, deviations.rows(slice(first, first + CHUNK)))
        for key, one in benches.values()
        for first in starts
    ]
    done = drawn(compute_chunk, chunks, chunk_content, asked.name, work)
    values: dict[str, Array] = {}
    reasons: dict[int, str] = {}
    for number, state in enumerate(benches):
        values[state], failed = together(done[number * len(starts) : (number + 1) * len(starts)], CHUNK)
        reasons |= failed
    return ToleranceData(OUTCOMES, deviations, values, nominal, reasons, exact, relief, numbers)


def drawn(
    function: Callable[..., object], chunks: Sequence[object], key: Callable[[Any], object], name: str, work: Work
) -> list[dict[str, Any]]:
    """What a function makes of every chunk of draws of a pair, on all cores where there are many."""
    from fegear.engine.executor import map_points
    from fegear.engine.point_job import Failure

    executor = work.executor
    if executor.scheduler is None and len(chunks) <= _FEW:
        executor = replace(executor, here=True)
    done = map_points(function, chunks, executor, work.cache, key=key, progress=work.progress)
    for one in done:
        if isinstance(one, Failure):
            raise FegearError(f"Draws of pair {name} failed: {one.reason}")
    return list(done)


def together(done: Sequence[Mapping[str, Any]], size: int) -> tuple[Array, dict[int, str]]:
    """Outcomes of all draws of a state, and why some have none, from those of its chunks in their order."""
    reasons: dict[int, str] = {}
    for number, chunk in enumerate(done):
        reasons |= {number * size + row: reason for row, reason in chunk["reasons"].items()}
    return np.concatenate([chunk["values"] for chunk in done]), reasons


def _reliefs(
    asked: DrawInputs, own: Bench
) -> tuple[tuple[float, ...], RobustRelief, dict[str, tuple[tuple[float, ...], Bench]]]:
    """The nominal and the robust optimum, and the pair with each of them."""
    from fegear.design.robustness.tolerance_draws import draw
    from fegear.design.tip_relief.grindable import grindable
    from fegear.design.tip_relief.robust import robust_tip_relief

    wish = asked.part.reliefs
    if wish is None:
        raise InputError("robustness.reliefs", "(not given)", "is needed to compare reliefs")
    pair = own.engagement.pair
    best = grindable(own.engagement.unmodified(), own.load, wish.shape)
    numbers: list[float] = []
    for gear, tip in ((pair.driver, best.driver), (pair.driven, best.driven)):
        numbers += [tip.amount, (tip.end - tip.start) * gear.base_radius / pair.path_length]
    nominal = (numbers[0], numbers[1], numbers[2], numbers[3])
    # Draws of their own: a percentile over draws that a search has seen is the search's, and not that of any pair.
    part = asked.part
    searched = draw(asked.limits, wish.draws, (part.seed, _SEARCHED), own.teeth, part.sequence, part.distribution)
    relief = robust_tip_relief(
        own, searched, nominal, amounts=wish.amounts, lengths=wish.lengths,
        power=1.0 if wish.shape == "linear" else 2.0, percent=wish.percentile,
    )  # fmt: skip

    def with_tips(driver: Relief, driven: Relief) -> Bench:
        return replace(own, engagement=replace(own.engagement, driver_relief=driver, driven_relief=driven))

    shape = 1.0 if wish.shape == "linear" else 2.0
    return nominal, relief, {
        NOMINAL: ((*nominal, shape), with_tips(best.driver, best.driven)),
        ROBUST: ((*relief.numbers, shape), with_tips(relief.driver, relief.driven)),
    }  # fmt: skip


def present_draws(data: ToleranceData, asked: PairDrawn) -> Outcome:
    """Tables, values, remarks and figures of the draws of a pair."""
    part, limits = asked.part, asked.limits
    settings: dict[str, object] = {
        "draws": part.draws, "seed": part.seed, "sequence": part.sequence, "distribution": part.distribution,
        "centre_distance_tolerance": limits.centre_distance, "profile_slope_tolerance": list(limits.profile_slope),
        "profile_form_tolerance": list(limits.profile_form), "helix_slope_tolerance": list(limits.helix_slope),
        "base_pitch_tolerance": list(limits.pitch),
    }  # fmt: skip
    return Outcome(
        data, tolerance_tables(data, asked), tolerance_values(data, asked), settings, tolerance_remarks(data, asked),
        tolerance_figures(data, asked),
    )  # fmt: skip


def _forecast(scene: Scene, _name: str) -> Forecast:
    """Draws of every state of relief, and the search for the best."""
    part = tolerance_part(scene)
    each = _DRAW_CORNERS if scene.case.effects.corner_contact else _DRAW
    states, search = (3, part.reliefs.draws * _SEARCH) if part.reliefs else (1, 0.0)
    chunks = math.ceil(part.draws / CHUNK) * states
    return Forecast({"draws": part.draws, "chunks": chunks}, part.draws * states * each + search)


#: Deviations that the picture of influences has, and classes of a histogram.
_MOST, _LEAST_CLASSES, _MOST_CLASSES = 12, 8, 60


_ROLES = {OWN: "relief of the case", NOMINAL: "designed", ROBUST: "linear tip relief"}


def tolerance_figures(data: ToleranceData, asked: PairDrawn) -> tuple[Figure, ...]:
    """Of one pair; none where no draw has a result."""
    if not np.isfinite(outcome(data, "te_peak_to_peak")).any():
        return ()
    figures = [_distributions(data, asked), _drawn_influences(data, asked)]
    if data.relief is not None:
        figures.append(_drawn_reliefs(data, asked))
    return tuple(figures)


def _histogram(values: Array) -> tuple[Array, Array]:
    """Middles and shares [%] of classes as wide as Freedman and Diaconis ask for."""
    low, high = float(values.min()), float(values.max())
    if high - low <= 1e-9 * abs(high):
        low, high = low - 5e-4 * abs(low), high + 5e-4 * abs(high)
    quartiles = np.quantile(values, [0.25, 0.75])
    width = 2.0 * float(quartiles[1] - quartiles[0]) / np.cbrt(values.size)
    classes = int(np.clip(np.ceil((high - low) / width) if width > 0.0 else 1, _LEAST_CLASSES, _MOST_CLASSES))
    counts, edges = np.histogram(values, classes, (low, high))
    return 0.5 * (edges[1:] + edges[:-1]), 100.0 * counts / values.size


def _distributions(data: ToleranceData, asked: PairDrawn) -> Figure:
    views = []
    for name in (key for key in told(data) if key != "te_harmonic_1"):
        one, factor = SHOWN[name], from_si(SHOWN[name].unit) if SHOWN[name].unit else 1.0
        values = outcome(data, name)
        values = np.sort(values[np.isfinite(values)]) * factor
        axis, mark = Axis(one.label, one.unit), Mark("x", nominal(data, name) * factor, "nominal")
        below = 100.0 * (np.arange(values.size) + 0.5) / values.size
        levels = tuple(Mark("y", p.percent, f"{p.value * factor:.4g}") for p in percentiles(data, name))
        views.append(
            View(one.label, (
                Panel(axis, Axis("draws in a class", "%", zero=True),
                      (Bars(*_histogram(values), "", "blue"),), (mark,), title=one.label),
                Panel(axis, Axis("draws below", "%", limits=(0.0, 100.0)),
                      (Curve(values, below, "", "blue", markers=False),), (mark, *levels)),
            ))
        )  # fmt: skip
    return Figure(
        f"robustness_distributions_{asked.name}",
        f"Pair {asked.name} inside its tolerances",
        f"Pair {asked.name}, {asked.part.draws} draws: how results are spread, and which share lies below. Dotted: the "
        "pair of the drawing (nominal), and percentiles 5, 50 and 95 with their values.",
        views=tuple(views),
        under=f"{asked.load:.5g} N",
    )


def _drawn_influences(data: ToleranceData, asked: PairDrawn) -> Figure:
    rows = influence_table(data, asked.gears)
    views = []
    for name in told(data):
        ranked = sorted(rows, key=lambda row: np.nan_to_num(row[1][name].share))[-_MOST:]
        names = tuple(column.name.replace("_", " ") for column, _ in ranked)
        places = np.arange(len(ranked), dtype=float)
        share = np.array([100.0 * np.nan_to_num(found[name].share) for _, found in ranked])
        rank = np.array([found[name].rank_correlation for _, found in ranked])
        across = Axis("", categories=names)
        views.append(
            View(SHOWN[name].label, (
                Panel(Axis("share of the variance by itself", "%", zero=True), across,
                      (Points(share, places, "", "blue", size=8.0),), title=SHOWN[name].label),
                Panel(Axis("rank correlation", limits=(-1.0, 1.0)), across,
                      (Points(rank, places, "", "orange", "diamond", size=8.0),), (Mark("x", 0.0),)),
            ))
        )  # fmt: skip
    return Figure(
        f"robustness_influences_{asked.name}",
        f"Which deviations of pair {asked.name} matter",
        f"Pair {asked.name}: share of a result's variance that each deviation explains by itself (either sign may "
        "raise the result), and its rank correlation with it. The rest of 100 % is what deviations do together."
        f"{leading_told(data, asked.gears)}",
        views=tuple(views),
        most_views=2,
    )


def _drawn_reliefs(data: ToleranceData, asked: PairDrawn) -> Figure:
    name, factor = "te_peak_to_peak", 1e6
    curves, marks = [], []
    percent = asked.part.reliefs.percentile if asked.part.reliefs else 95.0
    for state in data.values:
        values = outcome(data, name, state)
        values = np.sort(values[np.isfinite(values)]) * factor
        below = 100.0 * (np.arange(values.size) + 0.5) / values.size
        curves.append(Curve(values, below, f"tip relief {state}", _ROLES[state], markers=False))
    marks.append(Mark("y", percent, f"percentile {percent:g}"))
    return Figure(
        f"robustness_reliefs_{asked.name}",
        f"Tip reliefs of pair {asked.name} over the draws",
        f"Pair {asked.name}: share of the draws whose peak-to-peak transmission error lies below, with the relief of "
        f"the case, the tip reliefs that are best for the drawing, and those that are best at percentile {percent:g}."
        f"{search_told(data, asked)}",
        (
            Panel(
                Axis("peak-to-peak transmission error", "um", zero=True), Axis("draws below", "%", limits=(0.0, 100.0)),
                tuple(curves), tuple(marks),
            ),
        ),
        under=f"{asked.load:.5g} N",
    )  # fmt: skip


TOLERANCE_ROBUSTNESS = Stage(
    subjects=_subjects,
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=present_draws,
    check=_check,
    effects=EFFECTS,
    cites=citing(
        Citation("iso-1328-1", "tolerances that deviations are drawn inside", "5.3, formulas (5) to (12)"),
        Citation("mark", "load sharing of the tooth pairs in reach", "Appendix A"), HERTZ,
    ),
    forecast=_forecast,
)  # fmt: skip
