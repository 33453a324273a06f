"""What tip reliefs of teeth with a width show: the grinding table, what is left over torque, profile charts, maps."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.notes import assuming
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Off, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.results.pair.loaded_teeth import BASE_PITCH, pitch_marks
from fegear.results.relief.grinding import grinding_table
from fegear.results.relief.grinding_words import said_at
from fegear.results.relief.ground_tips import tip_numbers
from fegear.results.relief.harris import HARRIS_CHART
from fegear.results.relief.interference_words import said_of_interference
from fegear.results.relief.profile_charts import k_chart
from fegear.results.relief.relief_over_face_data import TipsShown
from fegear.results.relief.relief_over_range import OVER_RANGE, RANGE_CHART, TIME_MEANS

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.engine.sheet.seen import Seen


def _key(seen: Seen) -> str:
    return seen.key.replace(" ", "_")


def _interference(seen: Seen) -> Iterator[str]:
    yield from said_of_interference(seen.name, seen.data.data.pair, seen.asked.gears)


def _grind(seen: Seen) -> Iterator[str]:
    if seen.data.shapes:
        yield from said_at(seen, seen.data.ends, seen.data.ends)


def _figure(seen: Seen) -> str:
    several = len(seen.data.ends) > 1
    return f"relief_over_torque_{seen.name}" if several else f"relief_candidates_{seen.name}"


RELIEF_OVER_FACE_SHEET = Sheet(
    of=TipsShown,
    answer=Answer(_interference, _grind, figure=_figure),
    tables=(
        grinding_table("grinding_{name}", "Tip relief to grind on {name}", "grinding"),
        OVER_RANGE,
        Rows(
            "harris_map_{name}", "Harris map of {name}",
            (
                Each(
                    "left",
                    Cell(
                        "map.transmission_error", name=lambda seen: f"te_{_key(seen)}",
                        meaning="transmission error, {key}",
                    ),
                    Off("map.transmission_error", "map_error", name=lambda seen: f"te_{_key(seen)}"),
                ),
            ),
            of=lambda seen: next(iter(seen.data.left.values())).map, on=("load", "x"),
        ),
    ),
    values=(
        Each(
            "left",
            Number("peak_to_peak", "error", name=lambda seen: f"te_peak_to_peak.{_key(seen)}",
                   meaning="{key}, design load"),
            Number("effective", "error", name=lambda seen: f"te_effective.{_key(seen)}",
                   meaning="A_e, {key}, design load"),
        ),
        TIME_MEANS,
        tip_numbers("tips", "{one.shape}_tip_"),
    ),
    figures=(
        RANGE_CHART,
        k_chart("profile_charts"),
        Chart(
            "relief_candidates_{name}", "Transmission error of pair {name} with and without relief",
            "Pair {name}: remaining transmission error with each relief at the design load, {d.load:said}.",
            (
                Over(
                    BASE_PITCH,
                    (
                        Line(
                            "minus_mean", "{key}: {one.words} peak to peak", "{key}", each=Family("left"),
                            look={"markers": False},
                        ),
                    ),
                    marks=lambda seen: pitch_marks(seen.data.data.pair, next(iter(seen.data.left.values())).x),
                ),
            ),
            under="{d.load:said}",
        ),
        HARRIS_CHART,
    ),
    remarks=(
        Remark(
            lambda seen: assuming(
                f"Pair {seen.name}: designed for {seen.asked.misaligned} with its sign; with the opposite sign or none "
                "this relief can result in more transmission error than no relief. If the sign varies, request "
                "flank-design with flank_design.scatter, which designs for both."
            ),
            when=lambda seen: bool(seen.asked.misaligned),
        ),
        Remark(
            "Pair {name}: shaft deflection is kept at that of the present flanks during the design; rerun with the "
            "designed relief to update it.",
            when="data.on_shafts",
        ),
        Remark(
            "Pair {name}: {d.unproven}: too many combinations are too close to the minimum to compute all of them "
            "exactly; the optimum is likely but not proven.",
            when="unproven",
        ),
    ),
    settings={
        "design_load": "load",
        "combinations": lambda seen: sum(best.candidates for best in seen.data.design.found.values()),
        "loaded_exactly": lambda seen: sum(best.exact for best in seen.data.design.found.values()),
    },
)  # fmt: skip
