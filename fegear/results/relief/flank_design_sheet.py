"""What designed flanks show: topographies, charts for the drawing, what each relief leaves, maps over misalignment."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.notes import assuming
from fegear.base.printed import percent
from fegear.contact.wide.lines import ContactLines
from fegear.design.flanks.forms import lead_bearer
from fegear.design.preferred import CLASS_STEP
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Family, Line, Map, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Off, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.results.relief.allowed_words import allowed_words, decisive_words
from fegear.results.relief.answer_numbers import microns, told_apart, torque_words
from fegear.results.relief.flank_design_data import FlanksShown
from fegear.results.relief.flank_design_ends import end_notes
from fegear.results.relief.grinding import NOTHING, TIP, grinding_table
from fegear.results.relief.ground_flank_keys import keys_of
from fegear.results.relief.interference_words import said_of_interference
from fegear.results.relief.lead_charts import lead_k_chart
from fegear.results.relief.profile_charts import k_chart
from fegear.results.relief.recommended import nothing_words
from fegear.results.relief.relief_over_range import (
    OVER_RANGE,
    RANGE_CHART,
    TIME_MEANS,
    left_words,
    said_of_spectrum,
)
from fegear.results.relief.within_words import lost_words, within_words

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.base.notes import Note
    from fegear.design.flanks.designed_flanks import FlankState
    from fegear.design.flanks.forms import GroundRelief
    from fegear.engine.sheet.seen import Seen
    from fegear.results.relief.grinding import Grinding

#: A transmission error below this is none [m]; by this share of it less is worth a word.
_NONE, _CLEARLY = 1e-12, 0.05

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


def _left(seen: Seen, label: str) -> tuple[Array, Array]:
    """Torques [N m] and what a way leaves under each [m], aligned as given: of a range, or at the design load."""
    data = seen.data
    if data.over_range[label].torque.size > 1 or seen.asked.over is not None:
        return data.over_range[label].torque, data.over_range[label].peak_to_peak
    state = next(state for state in data.design.states if state.label == label)
    return np.array([data.load * data.data.pair.driver.base_radius]), np.array([state.judged.peak_to_peak.value])


def _interference(seen: Seen) -> Iterator[str]:
    yield from said_of_interference(seen.name, seen.data.data.pair, seen.asked.gears)


def _grind(seen: Seen) -> Iterator[str]:
    """What to grind and what it leaves, from the largest to the smallest torque of a range; why no more is ground."""
    design = seen.data.design
    best, least = design.best, design.least
    torque, none = _left(seen, design.unrelieved.label)
    after = _left(seen, best.label)[1]
    ground = _rows(seen, best)
    within = _at_most(best, torque) if ground else None
    first = seen.data.over_range[design.unrelieved.label]
    ends = first.named if torque.size == first.torque.size else (0,)

    def allowed(classes: int) -> str:
        return _allowed(seen, ground, classes)

    # What tolerances decide is not what deviations of zero leave.
    other = least is not best and not design.alike(best) and not design.within_tolerance(best)
    named = f"{best.label} " if other else ""
    slopes = first.slopes if torque.size == first.torque.size else None
    compared = none if slopes is None else slopes
    lost = ""
    if within is not None:
        lost = lost_words(compared, within, torque, design.finer, allowed, named, slopes=slopes is not None)
    if lost:
        yield f"Pair {seen.name}: {lost}."
    if lost and other:
        drawn, most, rows = _left(seen, least.label)[1], _at_most(least, torque), _rows(seen, least)
    else:
        drawn, most, rows = after, within, ground
    if rows and all(row.is_faint for row in rows):
        yield nothing_words(seen.name, rows, torque, none)
        return
    left = left_words(none, drawn, most, torque, ends, first.share)
    do = f"{'without deviations ' if lost else ''}grind {', '.join(row.words for row in rows) or 'nothing'}"
    over = "" if first.share is None else " over the load spectrum"
    yield f"Pair {seen.name}: {do}: transmission error{over} {left}, peak to peak."
    ground_as = seen.data.over_range[(least if lost and other else best).label]
    yield from said_of_spectrum(seen.name, first, ground_as)
    if within is not None and not lost:
        i = int(np.argmax(within / np.maximum(compared, _NONE)))
        same = None if slopes is None else float(slopes[i])
        yield f"Pair {seen.name}: {within_words(none[i], within[i], torque[i], design.finer, allowed, same)}."
    if within is not None and design.decisive:
        i = int(np.argmax(within / np.maximum(compared, _NONE)))
        gears = {row.member: row.gear for row in ground}
        if decides := decisive_words(after[i], within[i], torque[i], design.decisive[i], gears):
            yield f"Pair {seen.name}: {decides}."
    if least is not best:
        why = "within the estimated error" if design.alike(best) else f"by {_further(seen, best, least)}"
        than = f"than {best.label} ({best.modifications})"
        if not design.alike(best) and not design.within_tolerance(best):
            said = f"is better {than} as drawn{_drawn(seen, best, least)}, but worse within its tolerances"
            said += _within(seen, best, least)
        else:
            gain = percent((design.left_by(best) - design.left_by(least)) / design.left_by(best))
            said = f"is only {gain} better {than}, {why}"
        yield f"Pair {seen.name}: {least.label} ({least.modifications} modifications) {said}."


def _rows(seen: Seen, state: FlankState) -> list[Grinding]:
    """What is ground of a way."""
    return [row for row in seen.data.grinding if row.design == state.label and row.words]


def _at_most(state: FlankState, torque: Array) -> Array | None:
    """What a way leaves at most within its tolerances under each torque [m]; None where it is not known."""
    return state.over_most if state.over_most is not None and state.over_most.size == torque.size else None


def _allowed(seen: Seen, ground: list[Grinding], classes: int) -> str:
    """Tolerances of what is ground, so many classes finer: of tips, and of everything else by its kind."""
    tips, allowed = [row for row in ground if row.modification == TIP], seen.asked.tolerance.tips
    tip = [allowed_words([one.finer(classes) if classes else one for one in allowed], tips)] if tips else []
    rest = [
        f"± {microns(row.amount_tolerance / CLASS_STEP**classes)} µm {row.modification}"
        for row in ground
        if row.modification != TIP
    ]
    return ", ".join([*tip, *dict.fromkeys(rest)])


def _drawn(seen: Seen, best: FlankState, least: FlankState) -> str:
    """What two ways leave as drawn, at the torque at which the one that leaves less in proportion is ahead.

    Values of one torque, as the table of the range has them: what ways are compared by is in proportion to the load.
    """
    design, torque = seen.data.design, _left(seen, best.label)[0]
    if torque.size == 1:
        ours, theirs, i = design.left_by(best), design.left_by(least), 0
    else:
        left = design.left_under(best)
        i = design.worst_load(left)
        ours, theirs = float(left[i]), float(design.left_under(least)[i])
    less, more = told_apart(theirs, ours)
    return f" ({less}, not {more} µm at {torque_words(torque[i])})"


def _within(seen: Seen, best: FlankState, least: FlankState) -> str:
    """What two ways leave at most within their tolerances, at the torque at which it counts most; empty if unknown."""
    torque = _left(seen, best.label)[0]
    most, ours = _at_most(least, torque), _at_most(best, torque)
    if most is None or ours is None:
        return ""
    i = seen.data.design.worst_load(most)
    more, less = told_apart(most[i], ours[i])
    return f" (at most {more}, not {less} µm at {torque_words(torque[i])})"


def _further(seen: Seen, best: FlankState, least: FlankState) -> str:
    """What a way has besides the one to be ground, each below its tolerance."""
    rows = seen.data.grinding
    ours = {(row.gear, row.modification) for row in rows if row.design == best.label}
    more = [
        f"{microns(row.amount)} ± {microns(row.amount_tolerance)} µm {row.modification}"
        for row in rows
        if row.design == least.label and row.words and (row.gear, row.modification) not in ours
    ]
    return f"modifications below their tolerances ({', '.join(more)})"


def _exact(seen: Seen) -> Iterator[str]:
    """What the topography leaves at the design load, and where in a range it leaves more than no relief."""
    design = seen.data.design
    before, after = (state.judged.peak_to_peak.value for state in (design.unrelieved, design.exact))
    at = torque_words(seen.data.load * seen.data.data.pair.driver.base_radius)
    said = (
        f"Pair {seen.name}: the exact topography reduces the transmission error from {microns(before)} to "
        f"{microns(after)} µm at {at}"
    )
    (torque, none), left = _left(seen, design.unrelieved.label), _left(seen, design.exact.label)[1]
    worst = int(np.argmax(left / np.maximum(none, _NONE)))
    if left[worst] > none[worst]:
        more, less = told_apart(left[worst], none[worst])
        said += f"; at {torque_words(torque[worst])} it is {more} µm, more than without relief ({less} µm)"
    yield f"{said}."


def _scattered(seen: Seen) -> Iterator[str]:
    """By what a relief for scattered misalignment is chosen, and which leaves less aligned as specified."""
    design = seen.data.design
    if not design.scattered or not design.ground:
        return
    best, torque = design.best, _left(seen, design.best.label)[0]

    def means(state: FlankState) -> Array:
        """Over the scatter at each torque [m]; at the design load as it is stated."""
        return state.over_mean if torque.size > 1 else np.array([state.judged.mean_over_scatter.value])

    before, after = means(design.unrelieved), means(best)
    left = ", ".join(
        f"{microns(before[i])} -> {microns(after[i])} µm at {torque_words(torque[i])}"
        for i in dict.fromkeys(i % torque.size for i in (-1, 0))
    )
    worst = " (maximum over the torques relative to the torque)" if torque.size > 1 else ""
    said = f"Pair {seen.name}: {best.label} is chosen by the mean over the scatter of misalignment{worst}: {left}"
    aligned = min(design.ground, key=lambda state: float(_left(seen, state.label)[1][-1]))
    mine, other = (float(_left(seen, state.label)[1][-1]) for state in (best, aligned))
    if other < (1.0 - _CLEARLY) * mine:
        said += f"; aligned as specified {aligned.label} leaves less, {microns(other)} µm at {torque_words(torque[-1])}"
    yield f"{said}."


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
    answer=Answer(
        _interference, _grind, _scattered, _exact,
        figure=lambda seen: seen.said(
            "relief_over_torque_{name}" if len(seen.data.design.task.loads) > 1 else "flank_topography_{name}"
        ),
    ),
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
