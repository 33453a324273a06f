"""What a sizing shows: the variants compared, what excluded the others, the present design among them, answers."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.notes import Note, assuming, failing, neglecting
from fegear.base.printed import figures
from fegear.base.shown import shown
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Every, Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.results.sizing.parallel_coordinates import parallel_coordinates
from fegear.results.sizing.sizing_data import MARGIN, SizedVariant

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.engine.sheet.seen import Seen
    from fegear.results.sizing.sizing_data import SizingData

#: How many reasons a sentence names.
_NAMED = 3
#: Variants whose names are shown on the page.
_POINT = 7.0


@dataclass(frozen=True)
class Drawn:
    """Some of the variants as points."""

    notes: tuple[str, ...]
    total_mass: Array = shown("kg", "mass of both gears")
    te: Array = shown("um", "peak-to-peak transmission error")
    te_relieved: Array = shown("um", "peak-to-peak transmission error with tip relief")
    margin: Array = shown("", "load margin")


def _points(variants: tuple[SizedVariant, ...]) -> Drawn:
    return Drawn(
        tuple(f"variant {one.number}: {one.words}" if one.number else f"present: {one.words}" for one in variants),
        *(np.array([getattr(one, name) for one in variants]) for name in ("mass", "te", "te_relieved", "margin")),
    )  # fmt: skip


def _groups(seen: Seen) -> dict[str, Drawn]:
    """Points of the scatter chart, by the entry of its legend."""
    data: SizingData = seen.data
    rest = tuple(one for one in data.chosen if not one.place)
    groups = {"compared": rest, "Pareto front": data.front}
    if data.present is not None:
        groups["present design"] = (data.present.design,)
    return {name: _points(variants) for name, variants in groups.items() if variants}


def _has_te(seen: Seen) -> bool:
    return any(math.isfinite(one.te) for one in seen.data.chosen)


def _main(seen: Seen) -> str:
    """What is drawn over the mass."""
    if seen.data.relieved:
        return "te_relieved"
    return "te" if _has_te(seen) else "margin"


def _look(seen: Seen) -> dict[str, object]:
    return {"size": _POINT, "notes": seen.one.notes}


def _chart(key: str, y: str, words: str) -> Chart:
    line = Line(y, kind="points", each=Family(_groups, most=None), look=_look)
    return Chart(
        key, f"Variants: {words} over mass",
        "Variants that meet all limits and were compared. In the report, hover over a point for the variant.",
        (Over("total_mass", (line,), of=lambda _: Drawn),),
        when=lambda seen: bool(seen.data.chosen) and _main(seen) == y,
    )  # fmt: skip


def _um(te: float) -> str:
    return f"{figures(te * 1e6, 2)} µm"


def _said_of(one: SizedVariant) -> str:
    """Numbers of a variant in a sentence."""
    found = []
    if math.isfinite(one.te):
        kind = "verified" if math.isfinite(one.te_verified) else "estimated"
        found.append(f"transmission error {_um(one.te)} peak to peak ({kind})")
    if one.relief is not None and one.relief.amount > 0.0 and math.isfinite(one.te_relieved):
        kind = "verified" if math.isfinite(one.te_relieved_verified) else "estimated"
        found.append(f"{_um(one.te_relieved)} with {one.relief.kind} tip relief of {_um(one.relief.amount)} ({kind})")
    margin = f"load margin {figures(one.margin)}" if math.isfinite(one.margin) else "not rated"
    return ", ".join([*found, f"mass {figures(one.mass)} kg", margin])


def _answers(seen: Seen) -> Iterator[str]:
    data: SizingData = seen.data
    if data.best is None:
        ranked = sorted(data.reasons, key=lambda one: -one.variants)[:_NAMED]
        named = ", ".join(f"{one.reason} {one.variants:,}" for one in ranked)
        yield f"None of {data.count:,} variants meets all limits: {named}."
        return
    best = data.best
    margin = f" ({MARGIN})" if math.isfinite(best.margin) else ""
    yield f"Best of {data.count:,} variants: number {best.number}, {best.words}; {_said_of(best)}{margin}."
    if best.on_bounds:
        yield f"Variant {best.number} lies at the end of the range of {', '.join(best.on_bounds)}."
    known = f"; of {data.known:,} with known transmission error" if data.known < data.feasible and data.known else ","
    few = f", {len(data.front):,} of them shown" if len(data.chosen) < data.on_front else ""
    yield f"{data.feasible:,} variants meet all limits{known} {data.on_front:,} are on the Pareto front{few}."
    if data.present is not None:
        yield from _present(seen)


def _present(seen: Seen) -> Iterator[str]:
    """Where the present design is placed."""
    placed = seen.data.present
    own = placed.design
    breaks = f"breaks {', '.join(placed.reasons)}" if placed.reasons else "meets all limits"
    yield f"Present design ({own.words}) {breaks}; {_said_of(own)}."
    better = placed.better
    if better is not None:
        yield (
            f"Variant {better.number} is better than the present design by all criteria: {better.words}; "
            f"{_said_of(better)}."
        )
        return
    by = "of all" if placed.by_all else "by formulas"
    yield f"No variant shown is better than the present design by all criteria ({by}: {placed.dominating:,})."


def _bounds(seen: Seen) -> tuple[Note, ...]:
    best = seen.data.best
    if best is None or not best.on_bounds:
        return ()
    return (
        Note(
            f"Variant {best.number}: {', '.join(best.on_bounds)} at the end of the range; a better variant may lie "
            "beyond it. Widen the range."
        ),
    )


def _failed(seen: Seen) -> tuple[Note, ...]:
    failed = seen.data.failed
    if not failed:
        return ()
    number, reason = failed[0]
    first = f"variant {number}" if number else "present design"
    more = f" (and {len(failed) - 1} more)" if len(failed) > 1 else ""
    return (failing(f"No transmission error by FE for {first}{more}: {reason}"),)


def _unseen(seen: Seen) -> tuple[Note, ...]:
    """Variants whose transmission error is not known."""
    data: SizingData = seen.data
    if not data.known or data.known >= data.feasible:
        return ()
    key, outside = "screened", " outside the range of the atlas (pre-solved gears)" if data.by_atlas else ""
    if data.by_atlas and data.feasible > seen.asked.part.estimated:
        key, outside = "estimated", ""
    return (
        neglecting(
            f"Transmission error unknown for {data.feasible - data.known:,} of {data.feasible:,} variants{outside}; "
            f"increase sizing.{key} to include more."
        ),
    )


def _source(seen: Seen) -> tuple[Note, ...]:
    """Estimates by the atlas beside what finite elements say."""
    pairs = [(one.te_estimated, one.te_verified) for one in seen.data.chosen if one.estimated_by == "atlas"]
    off = [abs(estimate - verified) for estimate, verified in pairs if math.isfinite(verified)]
    if not seen.data.by_atlas:
        return ()
    beside = f"; verified values differ by at most {_um(max(off))} ({len(off)} variants)" if off else ""
    return (Note(f"Transmission error estimated by the atlas of solved gears{beside}."),)


def _unsearched(seen: Seen) -> tuple[Note, ...]:
    data: SizingData = seen.data
    if not data.relieved or data.relieved >= data.known:
        return ()
    return (
        neglecting(
            f"Tip relief searched for {data.relieved:,} of {data.known:,} variants, the best without relief; increase "
            "sizing.relieved for more."
        ),
    )


def _slices(seen: Seen) -> tuple[Note, ...]:
    if not any(one.helix_angle for one in seen.data.chosen) or not _has_te(seen):
        return ()
    return (
        assuming(
            "Transmission error of helical variants estimated with coupled slices; near integer overlap ratios the "
            "error may be a third. Use the verified values."
        ),
    )


def _said(seen: Seen) -> tuple[str, ...]:
    return tuple(seen.asked.said)


SIZING_SHEET = Sheet(
    name=lambda _asked: "",
    tables=(
        Rows("sizing", "Variants compared, the Pareto front first", (Every("sizing"),), of="chosen",
             when=lambda seen: bool(seen.data.chosen) and not seen.data.relieved),
        Rows("sizing", "Variants compared, the Pareto front first", (Every("sizing"), Every("relief")), of="chosen",
             when=lambda seen: bool(seen.data.chosen) and bool(seen.data.relieved)),
        Rows("excluded_variants", "What excluded variants", (Every("reasons"),), of="reasons",
             when=lambda seen: bool(seen.data.reasons)),
        Rows("placed_design", "Present design among the variants", (Every("present"),),
             of=lambda seen: seen.data.present.placed, when=lambda seen: seen.data.present is not None),
        Rows("present_design", "Numbers of the present design", (Every("sizing"),),
             of=lambda seen: (seen.data.present.design,), when=lambda seen: seen.data.present is not None),
    ),
    values=(
        Number("count", exact, owner="sizing", name="variants"),
        Number("feasible", exact, owner="sizing"),
        Number("on_front", exact, owner="sizing"),
        Number("te_verified", lambda seen: seen.data.best.te_verified_error, "best", owner="sizing",
               when=lambda seen: seen.data.best is not None and seen.data.best.verified is not None),
        Number("te_relieved_verified", lambda seen: seen.data.best.te_relieved_verified_error, "best", owner="sizing",
               when=lambda seen: seen.data.best is not None and seen.data.best.verified_relieved is not None),
        Number("mass", exact, "best", owner="sizing"),
        Number("margin", exact, "best", owner="sizing"),
    ),
    figures=(
        _chart("sizing_te", "te", "transmission error"),
        _chart("sizing_te_relieved", "te_relieved", "transmission error with tip relief"),
        _chart("sizing_margin", "margin", "load margin"),
        parallel_coordinates,
    ),
    answer=Answer(_answers, figure=lambda seen: f"sizing_{_main(seen)}"),
    remarks=(_failed, _unseen, _slices, _source, _unsearched, _bounds, _said),
    settings=lambda seen: {"variants": seen.data.count},
)  # fmt: skip
