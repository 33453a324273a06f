"""What a designed relief shows: tables, values, figures and sentences."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fegear.base.printed import percent
from fegear.case.built.neglected_effects import design_remarks
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Every, Off, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.results.pair.loaded_teeth import BASE_PITCH, pitch_marks
from fegear.results.relief.grinding import grinding_table
from fegear.results.relief.ground_tips import GRINDABLE, said_of_flat_optima, tip_numbers
from fegear.results.relief.harris import HARRIS_CHART
from fegear.results.relief.profile_charts import k_chart
from fegear.results.relief.relief_answer import RELIEF_ANSWER
from fegear.results.relief.relief_over_range import OVER_RANGE, RANGE_CHART, TIME_MEANS
from fegear.results.relief.relief_shown import ReliefShown

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.engine.sheet.seen import Seen

#: Reliefs by theory, in words.
_WORDS = {"designed": "exact relief by theory", "diagonal only": "exact relief without tooth coupling"}


def _key(seen: Seen) -> str:
    return seen.key.replace(" ", "_")


def _meant(seen: Seen) -> str:
    """What a relief is, in words."""
    return _WORDS.get(seen.key, seen.key)


def _is_taken_away(seen: Seen) -> bool:
    """Whether it is what a designed relief leaves: a difference of nearly alike numbers, with the errors of both."""
    return seen.key not in ("no relief", "present relief")


def _removal(y: str, label: str, **options: Any) -> Line:
    """A relief over the roll angle."""
    return Line(y, label, label, look={"markers": False}, **options)


def _at_points(y: str, axis: str = "", **options: Any) -> Over:
    """A quantity at the roll angles that the case asks for, a curve for each gear."""
    line = Line(
        f"table.{y}", "{key}: gear {one.gear}", "{key}", x="table.roll_angle", each=Family("points"),
        look={"markers": True}, **options
    )  # fmt: skip
    named = {"label": axis} if axis else {}
    return Over(Axis("roll angle of the gear", "deg"), (line,), options={**named, "zero": True})


def _diagonal_remark(seen: Seen) -> str:
    te = {label: one.te for label, one in seen.data.left.items()}
    d, n = te["diagonal only"].peak_to_peak, te["no relief"].peak_to_peak
    return (
        f"Pair {seen.name}: relief designed without tooth coupling (Mark 5.4) gives a peak-to-peak transmission error "
        f"of {d * 1e6:.3g} um, {percent(d / te['diagonal only'].mean)} of the mean and {percent(d / n)} of the "
        "value without relief."
    )


def _neglected(seen: Seen) -> Iterator[str]:
    yield from design_remarks(seen.name, seen.data.data.neglected, seen.asked.effects, seen.asked.tolerance)


_LEFT_CAPTION = "Pair {name}: remaining transmission error with each relief at the design load, {d.load:said}."
_DIAGONAL_CAPTION = (
    " Diagonal only: relief designed without the neighbours' loads (Mark, Eq. 5.4), applied to teeth with coupling."
)
_LOADING = "data.design.task.loading"

RELIEF_SHEET = Sheet(
    answer=RELIEF_ANSWER,
    of=ReliefShown,
    name=lambda asked: asked.asked.name,
    tables=(
        grinding_table("grinding_{name}", "Tip relief to grind on {name}", "grinding"),
        OVER_RANGE,
        Rows(
            "loading_candidates_{name}", "Loadings of {name} evaluated for minimum stress",
            ("family", "peak", "root_tension", "hertz_pressure"), of="tried", when="tried",
        ),
        Rows(
            "relief_{one.label}", "Relief of gear {one.gear} in pair {name}",
            (
                Every("flank"),
                Cell("relief", "diagonal", name="relief_diagonal", meaning="without tooth coupling (Mark 5.4)"),
                Off("relief", "error"),
            ),
            of="table", each="reliefs",
        ),
        Rows(
            "relief_points_{one.label}", "Relief of gear {one.gear} in pair {name} at the requested angles",
            (
                "roll_angle", "radius", "x", "load", "deflection", "relief",
                Cell("relief", "above_least", name="relief_over_least", meaning="minus the minimum of these rows"),
            ),
            of="table", each="points",
        ),
        GRINDABLE,
        Rows(
            "harris_map_{name}", "Harris map of {name}",
            (
                Each(
                    "left",
                    Cell(
                        "map.transmission_error", name=lambda seen: f"te_{_key(seen)}",
                        meaning="transmission error, {key}",
                    ),
                    Off(
                        "map.transmission_error", "map_error", "repeatability of the search",
                        name=lambda seen: f"te_{_key(seen)}",
                    ),
                ),
            ),
            of=lambda seen: next(iter(seen.data.left.values())).map, on=("load", "x"),
        ),
    ),
    values=(
        Number("root_tension", of="least_stress", name="design_root_tension",
               meaning="maximum of both gears, design load"),
        Number("hertz_pressure", of="least_stress", name="design_hertz_pressure"),
        tip_numbers("best_tips", "{one.shape}_tip_"),
        Number("te.peak_to_peak", "rounded_error", of="left.designed", si="rounded", name="te_peak_to_peak.as_rounded",
               meaning="relief to grind with the rounded numbers of the grinding table, design load"),
        Each(
            "best_first",
            Number("te.peak_to_peak", "error.peak_to_peak", name=lambda seen: f"te_peak_to_peak.{_key(seen)}",
                   meaning=lambda seen: f"{_meant(seen)}, design load", zero=_is_taken_away),
            Number("te.effective_error", "error.effective", name=lambda seen: f"te_effective.{_key(seen)}",
                   meaning=lambda seen: f"A_e, {_meant(seen)}, design load", zero=_is_taken_away),
        ),
        Number("te.peak_to_peak", of="left.designed", si="data.design.tables_leave",
               name="te_peak_to_peak.relief_tables",
               meaning="designed, relief tables interpolated linearly, design load"),
        Number("te.mean", of="left.designed", name="te_mean.designed", meaning="design load"),
        tip_numbers("other_tips", "{one.shape}_tip_"),
        TIME_MEANS,
        Number("relief", of="table", si=lambda seen: seen.one.table.relief.max(), owner="{name}.{one.member}",
               name="largest_relief", meaning="over the path", each="reliefs"),
    ),
    figures=(
        RANGE_CHART,
        k_chart("profile_charts"),
        Chart(
            "relief_{name}", "Profile relief of pair {name}",
            "Pair {name}: relief of both gears for {d.load:said} over the active profile, and the load "
            "of the tooth. Shaded: the design zone, where the tooth is loaded at the design load. Grindable reliefs "
            "are tip reliefs only; a constant offset has no effect.",
            (
                Over(
                    "roll_angle",
                    (
                        _removal("relief", "designed", error="error"),
                        _removal("relief", "diagonal only", si="diagonal"),
                        Line("relief", "{key}", "{key}", each=Family("ground"), look={"markers": False}),
                    ),
                    title="{one.member}: gear {one.gear}", each="reliefs", of="table", marks="marked",
                ),
                Over(
                    "roll_angle",
                    (Line("load", "load of the design", "grey", look={"dash": "solid", "markers": False}),),
                    options={"zero": True}, title="{one.member}: load", panel={"height": 0.6}, each="reliefs",
                    of="table", marks="marked",
                ),
            ),
            columns=2, under="{d.load:said}",
        ),
        Chart(
            "relief_points_{name}", "Loads, deflections and relief of pair {name}",
            "Pair {name}: at the specified roll angles, design load, flank deflection and compensating relief, "
            "relative to the minimum of these points.",
            (
                _at_points("load"), _at_points("deflection"),
                _at_points("relief", "relief from the minimum", si="above_least"),
            ),
            when="points", under="{d.load:said}",
        ),
        Chart(
            "relief_candidates_{name}", "Transmission error of pair {name} with and without relief",
            lambda seen: seen.said(_LEFT_CAPTION) + (_DIAGONAL_CAPTION if "diagonal only" in seen.data.left else ""),
            (
                Over(
                    BASE_PITCH,
                    (
                        Line(
                            "minus_mean", "{key}: {one.peak_to_peak} peak to peak", "{key}", each=Family("left"),
                            look={"markers": False},
                        ),
                    ),
                    marks=lambda seen: pitch_marks(seen.data.data.pair.pair, next(iter(seen.data.left.values())).x),
                ),
            ),
            under="{d.load:said}",
        ),
        HARRIS_CHART,
    ),
    remarks=(
        Remark(
            "Pair {name}: each relief compensates half the oil film at the design load; the remaining transmission "
            "error includes the film, assumed equally thick at all loads. Grindable tip reliefs are searched without "
            "it.",
            when=lambda seen: seen.asked.part.film is not None,
        ),
        Remark(_diagonal_remark, when=lambda seen: "diagonal only" in seen.data.left),
        said_of_flat_optima,
        _neglected,
    ),
    settings={
        "design_load": "load",
        "design_contact_ratio": lambda seen: seen.find(_LOADING).length / seen.find(_LOADING).base_pitch,
        "peak": f"{_LOADING}.peak", "slope": f"{_LOADING}.ramp.slope",
        "exponent": lambda seen: seen.find(_LOADING).ramp.exponent or 0, "centre": f"{_LOADING}.centre",
    },
)  # fmt: skip
