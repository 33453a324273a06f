"""Stage ``tolerance-robustness``: a pair whose gears and housing deviate inside the tolerances of the drawing.

What is drawn of a pair, how it is set up and what that takes stands in `fegear.results.relief.tolerance_benches`.
"""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from fegear.base.errors import FegearError, InputError
from fegear.engine.citation import Citation, citing
from fegear.engine.stage import Upstream, Work
from fegear.results.forecasts import HERTZ
from fegear.results.pair.loaded_teeth import teeth_stage
from fegear.results.relief.tolerance_benches import (
    DrawInputs,
    check_draws,
    draw_inputs,
    forecast_draws,
    needs_of_draws,
    pairs_to_draw,
    set_up,
)
from fegear.results.relief.tolerance_data import NOMINAL, OWN, ROBUST, ToleranceData
from fegear.results.relief.tolerance_sheet import TOLERANCE_SHEET

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fegear.base.arrays import Array
    from fegear.design.robustness.deviated_pair import Bench, DrawBench
    from fegear.design.robustness.tolerance_draws import Deviations
    from fegear.design.tip_relief.robust import RobustRelief
    from fegear.geometry.relief import Relief

#: Beside the seed of the case, that of the draws over which reliefs are searched for.
_SEARCHED = 1
#: Chunks that are done here sooner than other processes start.
_FEW = 4


@dataclass(frozen=True)
class Chunk:
    """Some draws of a pair: all that a process needs.

    Parameters
    ----------
    inputs : DrawInputs
    relief : tuple of float
        Numbers of a relief that is not the case's own.
    bench : DrawBench
    deviations : Deviations
    """

    inputs: DrawInputs
    relief: tuple[float, ...]
    bench: DrawBench
    deviations: Deviations


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
    return asked.teeth, asked.source, asked.solved, asked.moved, chunk.relief, chunk.deviations


def _compute(asked: DrawInputs, upstream: Upstream, work: Work) -> ToleranceData:
    from fegear.base.one_thread import one_thread
    from fegear.design.robustness.deviated_pair import drawn_outcomes
    from fegear.design.robustness.tolerance_draws import NO_LIMITS, draw

    part, size = asked.part, asked.chunk
    own = set_up(asked, upstream)
    deviations = draw(asked.limits, part.draws, part.seed, own.teeth, part.sequence, part.distribution)
    benches: dict[str, tuple[tuple[float, ...], DrawBench]] = {OWN: ((), own)}
    relief: RobustRelief | None = None
    numbers: tuple[float, ...] = ()
    with one_thread():
        exact = own.exact
        if part.reliefs is not None:
            numbers, relief, found = _reliefs(asked, cast("Bench", own))
            benches |= found
        none = draw(NO_LIMITS, 1, 0, own.teeth)
        nominal = {state: drawn_outcomes(one, none).values[0] for state, (_, one) in benches.items()}
    starts = range(0, part.draws, size)
    chunks = [
        Chunk(asked, key, one, deviations.rows(slice(first, first + size)))
        for key, one in benches.values()
        for first in starts
    ]
    done = _drawn(chunks, asked.name, work)
    values: dict[str, Array] = {}
    reasons: dict[int, str] = {}
    for number, state in enumerate(benches):
        values[state], failed = _together(done[number * len(starts) : (number + 1) * len(starts)], size)
        reasons |= failed
    return ToleranceData(own.names, deviations, values, nominal, reasons, exact, relief, numbers)


def _drawn(chunks: Sequence[Chunk], name: str, work: Work) -> list[dict[str, Any]]:
    """Outcomes of every chunk of draws of a pair, on all cores where there are many."""
    from fegear.engine.executor import map_points
    from fegear.engine.processes import Failure

    executor = work.executor
    if executor.scheduler is None and len(chunks) <= _FEW:
        executor = replace(executor, here=True)
    done = map_points(compute_chunk, chunks, executor, work.cache, key=chunk_content, progress=work.progress)
    for one in done:
        if isinstance(one, Failure):
            raise FegearError(f"Samples of pair {name} failed: {one.reason}")
    return list(done)


def _together(done: Sequence[Mapping[str, Any]], size: int) -> tuple[Array, dict[int, str]]:
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
        raise InputError("robustness.reliefs", "(not given)", "is required to compare reliefs")
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


TOLERANCE_ROBUSTNESS = teeth_stage(
    subjects=pairs_to_draw,
    needs=needs_of_draws,
    inputs=draw_inputs,
    compute=_compute,
    present=TOLERANCE_SHEET.present,
    check=check_draws,
    cites=citing(
        Citation("iso-1328-1", "tolerances of the sampled deviations", "5.3, formulas (5) to (12)"),
        Citation("mark", "load sharing of the tooth pairs", "Appendix A"), HERTZ,
    ),
    forecast=forecast_draws,
    in_points=True,
)  # fmt: skip
