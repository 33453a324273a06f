"""What designed flanks show: topographies, charts for the drawing, what each relief leaves, maps over misalignment."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

from fegear.base.notes import assuming
from fegear.contact.wide.lines import ContactLines
from fegear.design.flanks.forms import lead_bearer
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.chart import Chart, Family, Line, Map, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Off, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.results.relief.flank_design_answer import FLANK_DESIGN_ANSWER
from fegear.results.relief.flank_design_data import FlanksShown
from fegear.results.relief.flank_design_ends import end_notes
from fegear.results.relief.grinding import NOTHING, grinding_table
from fegear.results.relief.ground_flank_keys import keys_of
from fegear.results.relief.lead_charts import lead_k_chart
from fegear.results.relief.profile_charts import k_chart
from fegear.results.relief.relief_over_range import (
    OVER_RANGE,
    RANGE_CHART,
    TIME_MEANS,
)

if TYPE_CHECKING:
    from fegear.base.notes import Note
    from fegear.design.flanks.forms import GroundRelief
    from fegear.engine.sheet.seen import Seen

#: What is stated of every relief; the last three where misalignment scatters.
_JUDGED = (
    "peak_to_peak", "face_load_factor", "pressure", "mean_over_scatter", "most_over_scatter", "factor_over_scatter"
)  # fmt: skip
#: Numbers of a relief that can be ground.
_GROUND = (
    "driver_tip", "driver_tip_length", "driven_tip", "driven_tip_length", "crowning", "end_relief",
    "end_relief_length", "slope", "bias",
)  # fmt: skip

#: Topography of a gear, which a case reads back as its ``topography``.
TOPOGRAPHY = Rows(
    "flank_topography_{name}_{one.gear}", "Topographic relief of gear {one.gear} in pair {name}",
    ("roll_angle", "z", "removal", "diameter", "x", "line_load"), each="topographies",
)  # fmt: skip


def _judged(key: str) -> tuple[Cell, Off]:
    """A number of every way with its error."""

    def of(which: str) -> Callable[[Seen], list[float]]:
        return lambda seen: [getattr(getattr(way.state.judged, key), which) for way in seen.data.ways]

    return Cell(f"state.judged.{key}", of("value")), Off(f"state.judged.{key}", of("error"))


def _ground(key: str) -> Cell:
    """A number of what is ground; zero where nothing of the kind is."""
    return Cell(
        key, lambda seen: [_size(way.state.relief, key) for way in seen.data.ways],
        lambda seen: seen.data.design.best.relief,
    )  # fmt: skip


def _size(relief: GroundRelief | None, key: str) -> float:
    """A number of what is ground; zero where it is nothing but round-off of a grid."""
    size = getattr(relief, key) if relief else 0.0
    return size if abs(size) > NOTHING else 0.0


def _searched(key: str, without: float = 0) -> Cell:
    """How the best of a family was searched for."""
    return Cell(
        key, lambda seen: [without if way.best is None else getattr(way.best, key) for way in seen.data.ways],
        lambda seen: next(iter(seen.data.design.found.values())),
    )  # fmt: skip


def _judged_value(key: str) -> Number:
    over_scatter = key in _JUDGED[3:]
    return Number(
        key, lambda seen: getattr(seen.one.state.judged, key).error, "state.judged",
        lambda seen: getattr(seen.one.state.judged, key).value, "{name}.{one.word}", further=": {one.relief}",
        when=(lambda seen: seen.data.design.task.deviation) if over_scatter else None,
    )  # fmt: skip


def _sections(where: str, axis: Callable[[Seen], Axis], along: str, title: str) -> Over:
    line = Line("removal", "{one.label}", x=along, each=Family(where, role="ramp"),
                look={"dash": "solid", "markers": False})  # fmt: skip
    return Over(axis, (line,), Axis("removal", "um", zero=True), title=title)


def _roll_axis(seen: Seen) -> Axis:
    return Axis(f"roll angle of {seen.data.driver}", "deg")


def _face_axis(_seen: Seen) -> Axis:
    return Axis("face position z", "mm")


def _beside(x: Axis, nominal: str, scattered: str, label: str, role: str) -> Over:
    """What every way leaves, aligned as given and over the scatter."""
    look: dict[str, Any] = {"size": 9}
    return Over(
        x,
        (
            Line("place", "alignment as specified", "series:0", x=nominal, kind="points", look=look),
            Line("place", label, role, x=scattered, kind="points", look=look, when="scattered"),
        ),
        lambda seen: Axis(categories=tuple(way.relief.replace("-", " ") for way in reversed(seen.data.ways))),
    )  # fmt: skip


def _beside_caption(seen: Seen) -> str:
    caption = seen.said("Pair {name} at the design load: remaining transmission error with each relief, and K_Hβ.")
    if not seen.data.scattered:
        return caption
    deviation = seen.data.design.task.deviation
    return f"{caption} Scatter: misalignment over the face width, standard deviation {deviation * 1e6:.3g} µm."


def _tiles(quantity: str, label: str, title: str, floor: float) -> Over:
    """A map over misalignment and load."""
    return Over(
        Axis("misalignment over the face width", "um"),
        (
            Map(
                f"state.mapped.{quantity}", "load", "over_face", lambda _: label, numbers=True,
                si=lambda seen: getattr(seen.one.state.mapped, quantity).T,
                limits=lambda seen: (floor, seen.data.highest(quantity)),
            ),
        ),
        Axis("load", "N"),
        title=title,
    )  # fmt: skip


def _keys(seen: Seen) -> str:
    data, asked = seen.data.data, seen.asked
    relief = data.design.found[seen.one.label].relief
    keys, on_one = ("; ".join(keys_of(relief, data.pair, asked.gears, on_one=on_one)) for on_one in (False, True))
    said = f"Pair {asked.name}, {seen.one.label}: keys of the gears: {keys or 'none'}."
    if on_one == keys:
        return said
    return f"{said} With the same gaps, ground on {asked.gears[lead_bearer(data.pair)]} only: {on_one}."


def _ends(seen: Seen) -> Iterator[Note]:
    """Ends of what was searched at which that to be ground lies, and what leaves the least."""
    design = seen.data.design
    for label in dict.fromkeys(state.label for state in (*design.chosen, design.least)):
        yield from end_notes(f"Pair {seen.name}, {label}", design.found[label], seen.data.data.pair, seen.asked.gears)


_UNDER = "{d.load:said}"

FLANK_DESIGN_SHEET = Sheet(
    of=FlanksShown,
    tables=(
        grinding_table("grinding_{name}", "Modifications to grind on {name}", "grinding"),
        OVER_RANGE,
        TOPOGRAPHY,
        Rows(
            "flank_designs_{name}", "Flank modifications of pair {name} and remaining transmission error",
            (
                "relief", *(column for key in _JUDGED for column in _judged(key)), *map(_ground, _GROUND),
                _searched("candidates"), _searched("exact"), _searched("value_on_grid", 0.0),
                _searched("quick_error", math.nan),
                Cell("proven", lambda seen: [float(way.best is None or way.best.proven) for way in seen.data.ways],
                     lambda seen: next(iter(seen.data.design.found.values()))),
            ),
            of="ways",
        ),
        Rows(
            "flank_map_{name}", "Reliefs of pair {name} over misalignment and load",
            ("relief", *(f"state.mapped.{key}" for key in _JUDGED[:3])), stacked="ways", on=("over_face", "load"),
        ),
        Rows(
            "flank_design_roll_{name}", "Transmission error of pair {name} at the design load",
            (
                Cell("roll", "design.roll", lambda _: ContactLines),
                Cell("te", name="te_{one.word}", meaning="with {one.relief}", each="ways"),
            ),
        ),
    ),
    values=("topography_depth", Each("ways", *map(_judged_value, _JUDGED)), TIME_MEANS),
    figures=(
        RANGE_CHART,
        k_chart("profile_charts"),
        lead_k_chart("lead_charts"),
        Chart(
            "flank_topography_{name}", "Flank modification of pair {name}",
            "Pair {name}: total modification of both gears over roll angle of {d.driver} (driver, tip at right) "
            "and face width. Exact topography: zero transmission error at the design load; others: best grindable "
            "modifications.",
            (
                Over(
                    _roll_axis, (Map("removal", "z", "roll_angle", limits=lambda seen: seen.data.deepest),),
                    Axis("face position z", "mm"), title="{one.relief}",
                ),
            ),
            views="drawn", view="{one.relief}", under=_UNDER,
        ),
        Chart(
            "flank_charts_{name}", "Profile and lead charts of pair {name}",
            "Pair {name}: relief of both gears together in three sections across the axis (profile) and on three "
            "diameters of {d.driver} (lead), as in a gear inspection report, relative to the highest point.",
            (
                Each(
                    "drawn",
                    _sections("profiles", _roll_axis, "roll", "{one.relief}: profile"),
                    _sections("leads", _face_axis, "z", "{one.relief}: lead"),
                ),
            ),
            columns=2, under=_UNDER,
        ),
        Chart(
            "flank_designs_{name}", "Transmission error with each modification, pair {name}", _beside_caption,
            (
                _beside(
                    Axis("transmission error, peak to peak", "um", log=True), "peak_to_peak", "mean",
                    "mean over the scatter", "series:1",
                ),
                _beside(Axis("K_{Hβ}"), "factor", "worst", "95th percentile of the scatter", "series:3"),
            ),
            of="left", columns=2, under=_UNDER,
        ),
        Chart(
            "flank_design_roll_{name}", "Transmission error of pair {name} with each relief",
            "Pair {name}: transmission error minus mean over a base pitch, at mesh positions not used in the design. "
            "Legend: peak to peak.",
            (
                Each(
                    "by_size",
                    Over(
                        Axis("mesh position", "mm"),
                        (
                            Line(
                                "minus_mean", lambda seen: f"{seen.one.relief}: {seen.one.left * 1e6:.3g} µm",
                                lambda seen: "no relief" if seen.one.unrelieved else "", x="roll",
                                each=Family("ways", most=100), look={"markers": False},
                            ),
                        ),
                        title="{one.title}",
                    ),
                ),
            ),
            under=_UNDER,
        ),
        Chart(
            "flank_map_{name}", "Pair {name} over misalignment and load",
            "Pair {name}: transmission error, peak to peak, and K_Hβ over misalignment and load with each relief; "
            "design load {d.load:said}.",
            (
                _tiles("peak_to_peak", "peak to peak", "{one.relief}: transmission error", 0.0),
                _tiles("face_load_factor", "K_{Hβ}", "{one.relief}: K_{{Hβ}}", 1.0),
            ),
            views="mapped", view="{one.relief}", columns=2,
        ),
    ),
    answer=FLANK_DESIGN_ANSWER,
    remarks=(
        Remark(_keys, each="design.chosen"),
        _ends,
        Remark(
            lambda seen: assuming(
                f"Pair {seen.name}: designed for {seen.asked.misaligned} with its sign; with the opposite sign or none "
                "these flanks can result in more transmission error than no relief. If the sign varies, set "
                "flank_design.scatter."
            ),
            when=lambda seen: bool(seen.asked.misaligned) and not seen.data.design.scattered,
        ),
        Remark(
            "Pair {name}: shaft deflection is kept at that of the present flanks during the design; rerun with the "
            "designed modification to update it.",
            when="data.on_shafts",
        ),
        Remark(
            "Pair {name}: {d.unproven}: too many combinations are too close to the minimum to compute all of "
            "them exactly; the optimum is likely but not proven. Choose a coarser grid for a proof.",
            when="unproven",
        ),
    ),
    settings={
        "design_load": "load",
        "design_contact_ratio": lambda seen: (
            seen.data.design.task.loading.over_path.length / seen.data.design.task.loading.over_path.base_pitch
        ),
        "slope": "design.task.loading.over_path.ramp.slope",
        "end_length": "design.task.loading.end_length",
        "positions": "design.task.positions",
        "combinations": lambda seen: sum(best.candidates for best in seen.data.design.found.values()),
        "loaded_exactly": lambda seen: sum(best.exact for best in seen.data.design.found.values()),
    },
)  # fmt: skip
