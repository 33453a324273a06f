"""What draws inside tolerances show: all draws, percentiles, which deviation matters, reliefs side by side."""

from __future__ import annotations

from collections.abc import Callable
from typing import TYPE_CHECKING

from fegear.base.shown import declared
from fegear.engine.declared import axis_of, drawn
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.results.relief.tolerance_data import (
    NOMINAL,
    OWN,
    PERCENTS,
    ROBUST,
    DrawOutcomes,
    Ranked,
    Sampled,
    TipsOfStates,
    ToleranceShown,
)
from fegear.results.relief.tolerance_words import leading_told, search_told, tolerance_remarks

if TYPE_CHECKING:
    from fegear.engine.sheet.seen import Seen

_ROLES = {OWN: "relief of the case", NOMINAL: "designed", ROBUST: "linear tip relief"}
_INTERVAL = "95 % interval by order statistics"
_UNMARKED = {"markers": False}


def _outcomes(_seen: Seen) -> type:
    return DrawOutcomes


def _at_percentiles(which: str, end: str, meaning: str) -> Cell:
    """Percentiles of an outcome, or ends of their intervals."""
    return Cell(
        "{key}", lambda seen: [getattr(p, which) for p in seen.one.percentiles], _outcomes, f"{{key}}{end}", meaning
    )


def _influence_class(_seen: Seen) -> type:
    from fegear.design.robustness.draw_statistics import Influence

    return Influence


def _influence(quantity: str, end: str, meaning: str) -> Cell:
    """How all deviations go with an outcome."""
    return Cell(
        quantity, lambda seen: [getattr(one, quantity) for one in seen.data.influences[seen.key]],
        _influence_class, f"{{key}}_{end}", meaning,
    )  # fmt: skip


def _over_states(of: Callable[[Sampled], float], end: str, meaning: str) -> Cell:
    """A number of an outcome with every relief."""
    return Cell(
        "{key}", lambda seen: [of(one) for one in seen.data.by_state(seen.key)], _outcomes, f"{{key}}_{end}", meaning
    )


def _percentile_of_state(which: int) -> Cell:
    percent = PERCENTS[which]
    return _over_states(lambda one: one.percentiles[which].value, f"{percent:g}", f"percentile {percent:g}")


def _percentile(which: int) -> Number:
    percent = PERCENTS[which]
    return Number(
        "{key}", lambda seen: seen.one.error(which), _outcomes, lambda seen: seen.one.percentiles[which].value,
        name=f"{{key}}_{percent:g}", meaning=f"{{one.label}}, percentile {percent:g} of the samples",
    )  # fmt: skip


def _tip_of_states(quantity: str, meaning: Callable[[Seen], str]) -> Cell:
    return Cell(quantity, quantity, lambda _: TipsOfStates, f"{{key}}_{quantity}", meaning)


def _of_tip(seen: Seen) -> str:
    return f"tip relief of {seen.one.gear}"


def _robust_tip(quantity: str, meaning: str) -> Number:
    return Number(
        quantity, si=lambda seen: getattr(seen.one, quantity)[-1], owner="{name}.{key}", name=f"robust_{quantity}",
        meaning=meaning,
    )  # fmt: skip


def _samples_axis(seen: Seen) -> Axis:
    return axis_of(DrawOutcomes, seen.one.name)


def _nominal_mark(seen: Seen) -> Mark:
    return Mark("x", float(drawn(DrawOutcomes, seen.one.name, seen.one.nominal)), "nominal")


def _levels(seen: Seen) -> tuple[Mark, ...]:
    name = seen.one.name
    return tuple(
        Mark("y", p.percent, f"{float(drawn(DrawOutcomes, name, p.value)):.4g}") for p in seen.one.percentiles
    )  # fmt: skip


def _relief_percent(seen: Seen) -> float:
    reliefs = seen.asked.part.reliefs
    return float(reliefs.percentile) if reliefs else 95.0


TOLERANCE_SHEET = Sheet(
    of=ToleranceShown,
    tables=(
        Rows(
            "robustness_draws_{name}", "All samples of {name}",
            (
                "draw",
                Each("varied", Cell("{one.quantity}", "drawn", lambda seen: seen.data.data.deviations, "{one.name}",
                                    "{one.meaning}")),
                Each("in_columns", Cell("{one.name}", "values", _outcomes, "{key}", "{one.label}, relief {one.state}")),
                "failure",
            ),
        ),
        Rows(
            "robustness_percentiles_{name}", "Percentiles of the samples of {name}",
            (
                "percentile",
                Each(
                    "outcomes", _at_percentiles("value", "", "{one.label}: {one.meaning}"),
                    _at_percentiles("low", "_low", _INTERVAL), _at_percentiles("high", "_high", _INTERVAL),
                ),
            ),
        ),
        Rows(
            "robustness_influences_{name}", "Ranking of the deviations of {name}",
            (
                "deviation", "meaning",
                Each(
                    "told", _influence("rank_correlation", "rank", "rank correlation with {one.label}"),
                    _influence(
                        "share", "share",
                        "share of the variance of {one.label} by this deviation only; values around zero: none",
                    ),
                    _influence("error", "share_error", "standard error of {key}_share"),
                ),
            ),
        ),
        Rows(
            "robustness_reliefs_{name}", "Tip reliefs of {name} over the samples",
            (
                "states",
                Each(
                    "tips",
                    _tip_of_states("amount", lambda seen: f"{_of_tip(seen)} ({seen.asked.part.reliefs.shape})"),
                    _tip_of_states("length", lambda seen: f"{_of_tip(seen)} / path of contact"),
                ),
                Each(
                    "told", _over_states(lambda one: one.nominal, "nominal", "without deviations"),
                    *map(_percentile_of_state, range(len(PERCENTS))),
                ),
            ),
            when="tips",
        ),
    ),
    values=(
        Each(
            "told",
            Number("{key}", "missed", _outcomes, "nominal", name="{key}_nominal",
                   meaning="{one.label}, no deviations"),
            *map(_percentile, range(1, len(PERCENTS))),
        ),
        Number(
            "interactions", lambda seen: seen.one[1], _outcomes, lambda seen: seen.one[0], name="{key}_interactions",
            meaning=lambda seen: (
                f"{declared(DrawOutcomes, seen.key).label}: share of the variance due to interactions of deviations"
            ),
            each="together",
        ),
        Number(
            "te_peak_to_peak", lambda seen: seen.one.error(-1), _outcomes,
            lambda seen: seen.one.percentiles[-1].value,
            name=lambda seen: seen.one.column.replace("te_peak_to_peak", f"te_peak_to_peak_{PERCENTS[-1]:g}"),
            meaning=f"percentile {PERCENTS[-1]:g}, tip reliefs {{one.state}}", each="found_reliefs",
        ),
        Each(
            "tips", _robust_tip("amount", "at the tip, {one.gear}"),
            _robust_tip("length", "length of this relief of {one.gear} / path of contact"),
        ),
    ),
    figures=(
        Chart(
            "robustness_distributions_{name}", "Pair {name} within its tolerances",
            "Pair {name}, {asked.part.draws} draws: histogram and cumulative distribution of the results. Dotted: "
            "the pair of the drawing (nominal), and percentiles 5, 50 and 95 with their values.",
            (
                Over(
                    _samples_axis,
                    (
                        Line("in_class", kind="bars", x="{one.name}", of=_outcomes,
                             si=lambda seen: seen.one.histogram[1], x_si=lambda seen: seen.one.histogram[0]),
                    ),
                    lambda _: axis_of(DrawOutcomes, "in_class", zero=True), title="{one.label}",
                    marks=lambda seen: (_nominal_mark(seen),),
                ),
                Over(
                    _samples_axis,
                    (Line("below", x="{one.name}", of=_outcomes, si="below", x_si="rising", look=_UNMARKED),),
                    lambda _: axis_of(DrawOutcomes, "below", limits=(0.0, 100.0)),
                    marks=lambda seen: (_nominal_mark(seen), *_levels(seen)),
                ),
            ),
            when="any_result", views="distributed", view="{one.label}", under="{asked.load:said}",
        ),
        Chart(
            "robustness_influences_{name}", "Influence of the deviations of pair {name}",
            lambda seen: (
                f"Pair {seen.name}: first-order (Sobol) share of the variance and rank correlation; the remainder to "
                f"100 % is due to interactions.{leading_told(seen.data)}"
            ),
            (
                Over(
                    lambda _: axis_of(Ranked, "share", zero=True),
                    (Line("place", x="share", kind="points", look={"size": 8.0}),),
                    lambda seen: Axis("", categories=seen.one.names), title="{one.label}",
                ),
                Over(
                    lambda _: axis_of(Ranked, "rank", limits=(-1.0, 1.0)),
                    (Line("place", role="orange", x="rank", kind="points", look={"symbol": "diamond", "size": 8.0}),),
                    lambda seen: Axis("", categories=seen.one.names), marks=lambda _: (Mark("x", 0.0),),
                ),
            ),
            when="any_result", views="ranked", view="{one.label}", most_views=2,
        ),
        Chart(
            "robustness_reliefs_{name}", "Tip reliefs of pair {name} over the samples",
            lambda seen: (
                f"Pair {seen.name}: fraction of samples with a lower peak-to-peak transmission error, for the relief "
                f"of the case, the nominal optimum and the optimum at percentile {_relief_percent(seen):g}."
                f"{search_told(seen.data)}"
            ),
            (
                Over(
                    lambda _: axis_of(DrawOutcomes, "te_peak_to_peak", zero=True),
                    (
                        Line("below", "tip relief {one.state}", lambda seen: _ROLES[seen.one.state], of=_outcomes,
                             x="te_peak_to_peak", x_si="rising", si="below", look=_UNMARKED,
                             each=Family(lambda seen: seen.data.by_state("te_peak_to_peak"))),
                    ),
                    lambda _: axis_of(DrawOutcomes, "below", limits=(0.0, 100.0)),
                    marks=lambda seen: (
                        Mark("y", _relief_percent(seen), f"percentile {_relief_percent(seen):g}"),
                    ),
                ),
            ),
            when=lambda seen: seen.data.any_result and seen.data.tips, under="{asked.load:said}",
        ),
    ),
    remarks=(tolerance_remarks,),
    settings={
        "draws": "asked.part.draws", "seed": "asked.part.seed", "sequence": "asked.part.sequence",
        "distribution": "asked.part.distribution",
        "centre_distance_tolerance": "asked.limits.centre_distance",
        "profile_slope_tolerance": lambda seen: list(seen.asked.limits.profile_slope),
        "profile_form_tolerance": lambda seen: list(seen.asked.limits.profile_form),
        "helix_slope_tolerance": lambda seen: list(seen.asked.limits.helix_slope),
        "base_pitch_tolerance": lambda seen: list(seen.asked.limits.pitch),
    },
)  # fmt: skip
