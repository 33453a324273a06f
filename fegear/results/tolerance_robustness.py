"""Stage ``tolerance-robustness``: a pair whose gears and housing deviate inside the tolerances of the drawing."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage
from fegear.errors import FegearError, InputError
from fegear.geometry.pair import MEMBERS
from fegear.models.pair_checks import check_relief
from fegear.models.pair_inputs import gear_name, pair_inputs
from fegear.models.root_stress_source import FINITE_ELEMENTS, check_formulas, root_stress_source
from fegear.models.tolerances import (
    chosen_pair,
    limits_of,
    refuse_jammed,
    refuse_no_tolerance,
    tolerance_part,
    untold,
)
from fegear.models.tooth_influence import gear_to_solve
from fegear.results.drawn_tolerances import tolerance_figures
from fegear.results.gear_solution import solution_of
from fegear.results.loaded_pair import EFFECTS, loaded_pair, needs_pair
from fegear.results.root_stress_parts import needs_sources, stress_sources
from fegear.results.sources import HERTZ
from fegear.results.tolerance_remarks import tolerance_remarks
from fegear.results.tolerance_tables import NOMINAL, OWN, ROBUST, PairDrawn, tolerance_tables, tolerance_values

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping, Sequence

    from fegear.arrays import Array
    from fegear.case.reading import Scene
    from fegear.case.robustness import TolerancePart
    from fegear.design.deviated_pair import Bench
    from fegear.design.robust_relief import RobustRelief
    from fegear.design.tolerance_draws import Deviations, Kind, Limits
    from fegear.engine.stage import Task, Upstream, Work
    from fegear.geometry.relief import Relief
    from fegear.models.pair_inputs import PairInputs
    from fegear.models.tooth_influence import GearToSolve

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
    from fegear.design.deviated_pair import drawn_outcomes
    from fegear.one_thread import one_thread

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
    return (*needs_pair(scene, name), *needs_sources(scene, name))


def _bench(asked: DrawInputs, upstream: Upstream) -> Bench:
    from fegear.design.deviated_pair import bench

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
    from fegear.contact import transmission_error
    from fegear.design.deviated_pair import OUTCOMES, drawn_outcomes
    from fegear.design.tolerance_draws import NO_LIMITS, draw
    from fegear.one_thread import one_thread

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
    from fegear.design.optimise import grindable
    from fegear.design.robust_relief import robust_tip_relief
    from fegear.design.tolerance_draws import draw

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
