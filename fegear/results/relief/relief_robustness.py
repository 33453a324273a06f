"""Stage ``robustness``: how designed reliefs hold up when load, pitch and depth deviate."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import figures, percent
from fegear.base.shown import shown
from fegear.design.preferred import CLEARLY
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Bundle, Chart, Family, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Task, Upstream, Work
from fegear.results.relief.answer_numbers import microns, told_apart, torque_words
from fegear.results.relief.relief import design_pairs, design_part, relief_stage
from fegear.results.relief.relief_chart import CITES

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence

    from fegear.base.arrays import Array
    from fegear.case.design import RobustnessPart
    from fegear.case.reading import Scene
    from fegear.contact.plane.transmission_error import TransmissionError
    from fegear.design.charts import Metric
    from fegear.design.held_relief import Robustness
    from fegear.design.load_range import LoadRange
    from fegear.engine.sheet.seen import Seen
    from fegear.results.relief.relief_data import ReliefData


NO_RELIEF, OWN_RELIEF = "no relief", "relief of the case"


@dataclass(frozen=True)
class RobustnessData:
    """How each candidate holds up, by its name; `recommended` is the one that the design says to grind.

    `torque` is that of the driver at the design load [N m].
    """

    candidates: Mapping[str, Robustness]
    recommended: str
    torque: float
    candidate: str = shown("", "relief", default="")


@dataclass(frozen=True)
class RobustnessInputs:
    """What the robustness of a pair's reliefs depends on.

    Parameters
    ----------
    part : RobustnessPart
    metric : str
    own_relief : bool
        Whether the relief of the case is a candidate too.
    base_radius : float
        Of the driver [m].
    name : str
        Of the pair.
    """

    part: RobustnessPart
    metric: Metric
    own_relief: bool
    base_radius: float
    name: str = field(compare=False)


def robustness_inputs(scene: Scene, name: str) -> RobustnessInputs:
    """Collect what a case says of the robustness of a pair's reliefs."""
    part = design_part(scene)
    radius = scene.pairs[name].driver.base_radius
    return RobustnessInputs(part.robustness, part.measure, scene.case.effects.relief, radius, name)


def load_factors(asked: RobustnessPart, over: LoadRange | None, load: float) -> list[float]:
    """Loads over the design load: those asked for, or of a range."""
    if over is None or "load_factors" in asked.given:
        return asked.load_factors
    return [one / load for one in over.loads]


def _compute_robustness(inputs: RobustnessInputs, upstream: Upstream, work: Work) -> RobustnessData:
    from fegear.design.held_relief import robustness
    from fegear.geometry.relief import UNMODIFIED

    designed: ReliefData = next(found for task, found in upstream.items() if task.stage == "relief")
    asked, design = inputs.part, designed.design
    factors = load_factors(asked, design.task.over, design.task.load)
    states = {"designed": design.designed}
    states |= {f"{shape} tip relief": g.applied(design.designed) for shape, g in design.ground.items()}
    if inputs.own_relief:
        own = designed.pair.engagement
        states[OWN_RELIEF] = replace(own, driver_spacing=np.empty(0), driven_spacing=np.empty(0))
    states[NO_RELIEF] = replace(design.designed, driver_relief=UNMODIFIED, driven_relief=UNMODIFIED)
    found: dict[str, Robustness] = {}
    for label, state in states.items():
        found[label] = as_designed(
            robustness(state, design.task.load, factors, asked.spacing_errors, asked.relief_errors, inputs.metric),
            design.te.get("present relief" if label == OWN_RELIEF else label) if design.task.film is None else None,
            inputs.metric,
        )
        work.progress(len(found) / len(states))
    shapes = [f"{shape} tip relief" for shape in design.shapes]
    return RobustnessData(found, recommended(shapes, states), design.task.load * inputs.base_radius)


def as_designed(found: Robustness, te: TransmissionError | None, metric: Metric) -> Robustness:
    """With the value at the design load that the relief's other sentences state: the grid's may round otherwise."""
    return found if te is None else replace(found, nominal=float(getattr(te, metric)))


def recommended(shapes: Sequence[str], candidates: Iterable[str]) -> str:
    """The first shape to grind; where none pays, the first candidate."""
    return next(iter((*shapes, *candidates)))


def _worst_combination(seen: Seen) -> str:
    """Which combination is worst, in words."""
    found: Robustness = seen.one
    at = tuple(np.unravel_index(int(found.values.argmax()), found.values.shape))
    where = _combination(found, at, seen.data.torque)
    return f"{seen.key}, maximum of the {found.values.size} combinations: {where}"


def _over_load(extreme: Callable[..., Array], width: float) -> Line:
    """The extreme of all combinations at each load, over the torques in their order."""
    return Line(
        "values", "{key}", si=lambda seen: extreme(seen.one.values, axis=(1, 2))[np.argsort(seen.one.load_factors)],
        x="load_factors", x_si=lambda seen: np.sort(seen.one.load_factors) * seen.data.torque,
        look={"width": width, "markers": width > 1.0},
    )  # fmt: skip


_EXCITATION = {"peak_to_peak": "peak-to-peak", "effective_error": "effective"}


def _combination(found: Robustness, at: tuple[np.intp, ...], design_torque: float) -> str:
    """Torque, pitch deviation and depth of one combination."""
    factor, spacing, depth = (
        float(of[i]) for of, i in zip((found.load_factors, found.spacing_errors, found.relief_errors), at, strict=True)
    )
    torque = torque_words(factor * design_torque)
    return f"{torque}, pitch deviation {spacing * 1e6:g} µm, {_amount(depth)}"


def _deviations(found: Robustness, design_torque: float) -> str:
    """What is combined: other deviations than the tolerances of the grinding table."""
    torques = [figures(float(end(found.load_factors)) * design_torque, 4) for end in (np.min, np.max)]
    spacing = [f"{float(end(found.spacing_errors)) * 1e6:g}" for end in (np.min, np.max)]
    depth = [float(end(found.relief_errors)) for end in (np.min, np.max)]
    amount = _amount(depth[0]) + (f" to {percent(depth[1], signed=True)}" if depth[1] > depth[0] else "")
    return (
        f"{' to '.join(dict.fromkeys(torques))} N m, pitch deviation {' to '.join(dict.fromkeys(spacing))} µm, {amount}"
    )


def _amount(error: float) -> str:
    """By how much amounts of relief are off, in words."""
    return f"amount {percent(error, signed=True)}" if error else "amount as designed"


def _worst_in_words(seen: Seen) -> Iterator[str]:
    """What the relief to grind gives at most, beside no relief; which other one gives clearly less at most."""
    label, every, torque = seen.data.recommended, seen.data.candidates, seen.data.torque
    found, none = every[label], every[NO_RELIEF]
    at = np.unravel_index(int(found.values.argmax()), found.values.shape)
    nominal, worst = microns(found.nominal), microns(max(found.worst, found.nominal))
    yield (
        f"Pair {seen.name}, {label}: {nominal} µm at {torque_words(torque)} without deviations; with those of "
        f"design.robustness ({_deviations(found, torque)}) at most {worst} µm ({_combination(found, at, torque)}). "
        f"Without relief {microns(none.nominal)} and at most {microns(none.worst)} µm."
    )
    if label != NO_RELIEF:
        yield f"Pair {seen.name}, {label}: {_beside_none(found, none, torque)}."
    least = min(every, key=lambda key: every[key].worst)
    if every[least].worst < CLEARLY * found.worst:
        yield f"Pair {seen.name}: {least} gives the smallest maximum, {microns(every[least].worst)} µm."


def _beside_none(found: Robustness, none: Robustness, torque: float) -> str:
    """In how many combinations a relief gives more than none, and in which most of all."""
    worse = int((found.values > none.values).sum())
    if not worse:
        return f"less than without relief in all {found.values.size} combinations"
    at = np.unravel_index(int((found.values / none.values).argmax()), found.values.shape)
    more, less = told_apart(float(found.values[at]), float(none.values[at]))
    return (
        f"more than without relief in {worse} of {found.values.size} combinations, e.g. {more}, not {less} µm "
        f"({_combination(found, at, torque)})"
    )


ROBUSTNESS_SHEET = Sheet(
    answer=Answer(_worst_in_words, figure="robustness_{name}"),
    tables=(
        Rows(
            "robustness_{name}", "Robustness of the reliefs of {name}",
            (
                Cell("candidate", lambda seen: seen.key, lambda _: RobustnessData),
                Cell("values", name="{asked.metric}"),
            ),
            stacked="candidates", on=("load_factors", "spacing_errors", "relief_errors"),
        ),
    ),
    values=(
        Number(
            "values", si="worst", each="candidates", meaning=_worst_combination,
            name=lambda seen: f"worst_{seen.asked.metric}.{seen.key.replace(' ', '_')}",
        ),
    ),
    figures=(
        Chart(
            "robustness_{name}", "Robustness of the reliefs of pair {name}",
            "Pair {name}: maximum (marked) and minimum (thin) over all combinations of pitch deviation and relief "
            "tolerance.",
            (
                Over(
                    Axis("torque on the driver", "N.m"),
                    (Bundle(Family("candidates", role="{key}"), (_over_load(np.max, 1.8), _over_load(np.min, 0.8))),),
                    lambda seen: Axis(f"{_EXCITATION[seen.asked.metric]} transmission error", "um", zero=True),
                ),
            ),
            of=lambda seen: next(iter(seen.data.candidates.values())),
        ),
    ),
    settings={"metric": lambda seen: seen.asked.metric},
)  # fmt: skip


def _robustness_pairs(scene: Scene) -> tuple[str, ...]:
    """Those of the design, unless the case asks for draws inside tolerances alone."""
    return () if scene.case.robustness is not None and scene.case.design is None else design_pairs(scene)


def _robustness_forecast(scene: Scene, _name: str) -> Forecast:
    """Every deviation with every other, for each candidate."""
    part = scene.case.design.robustness if scene.case.design else None
    count = len(part.load_factors) * len(part.spacing_errors) * len(part.relief_errors) if part else 15
    return Forecast({"deviations": count}, 0.005 + 5e-4 * count)


ROBUSTNESS = relief_stage(
    subjects=_robustness_pairs,
    needs=lambda _scene, name: (Task("relief", name),),
    inputs=robustness_inputs,
    compute=_compute_robustness,
    present=ROBUSTNESS_SHEET.present,
    cites=CITES,
    forecast=_robustness_forecast,
)
