"""Result ``relief-curves``: transmission error and load of a tooth pair over its engagement, relief by relief."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from itertools import product
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.base.shown import shown
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.family import ramp
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Reads, Upstream, Work
from fegear.results.gear.path_marks import roll_marks
from fegear.results.relief.relief import design_part, relief_stage
from fegear.results.relief.relief_chart import unit_in_words

if TYPE_CHECKING:
    from fegear.case.design import ChartPart
    from fegear.case.reading import Scene
    from fegear.contact.plane.engagement import Engagement
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.contact.plane.pair_history import PairHistory
    from fegear.contact.plane.transmission_error import TransmissionError
    from fegear.engine.sheet.seen import Seen

_POSITIONS, _HARMONICS, _TOLD = 200, 12, 4
#: Reliefs that one figure still tells apart.
_MOST = 24
#: One relief followed and integrated [s].
_EACH = 0.02


@dataclass(frozen=True)
class ReliefCurve:
    """What one relief makes of the pair; without an amount there are perfect involutes.

    Parameters
    ----------
    history : PairHistory
        One tooth pair over the path of contact.
    error : TransmissionError
        Over the base pitch.
    """

    history: PairHistory
    error: TransmissionError
    amount: float = shown("um", "amount of relief at both tips")
    amount_over_delta: float = shown("", "amount / Welbourn's Delta")
    length: float = shown("", "relief length relative to the length from tip to HPSTC on the line of action")
    amplitude: float = shown("um", "harmonic, amplitude", default=math.nan)


@dataclass(frozen=True)
class ReliefCurvesData:
    """Every relief, perfect involutes first, and Welbourn's Delta."""

    pair: LoadedPair
    curves: tuple[ReliefCurve, ...]
    delta: float = shown("um", "unit of the amounts")


def _check(scene: Scene, name: str) -> None:
    ratio = scene.pairs[name].contact_ratio
    if not 1.0 <= ratio < 2.0:
        raise InputError(
            f"pair.{name}", f"contact ratio {ratio:.4f}", "has no highest point of single tooth contact (reference "
                                                          "of the relief length)", "request relief-chart",
        )  # fmt: skip
    part = design_part(scene).chart
    count = len(part.amounts or part.amounts_over_delta or [1.0]) * len(part.lengths or [1.0])
    if count > _MOST:
        raise InputError(
            "design.chart", f"{count} reliefs", f"exceed the maximum of {_MOST} in relief-curves",
            "reduce amounts or lengths",
        )  # fmt: skip


def _compute(inputs: Reads[ChartPart], upstream: Upstream, work: Work) -> ReliefCurvesData:
    from fegear.contact.plane.flanks import welbourn_amount
    from fegear.geometry.relief import normalised_tip_relief

    pair: LoadedPair
    (pair,) = upstream.values()
    plain, part = pair.engagement.unmodified(), inputs.part
    delta = welbourn_amount(plain, pair.nominal)
    amounts = part.amounts or [delta * share for share in part.amounts_over_delta or [1.0]]
    curves = [_curve(plain, pair.nominal, 0.0, 0.0, 0.0)]
    wanted = list(product(sorted(amounts), sorted(part.lengths or [1.0])))
    for amount, length in wanted:
        relieved = replace(
            plain,
            driver_relief=normalised_tip_relief(plain.pair, "driver", amount, length, part.shape),
            driven_relief=normalised_tip_relief(plain.pair, "driven", amount, length, part.shape),
        )
        curves.append(_curve(relieved, pair.nominal, amount, amount / delta, length))
        work.progress(len(curves) / (1 + len(wanted)))
    return ReliefCurvesData(pair, tuple(curves), delta)


def _curve(engagement: Engagement, load: float, *relief: float) -> ReliefCurve:
    from fegear.contact.plane.pair_history import pair_history
    from fegear.contact.plane.transmission_error import transmission_error

    history = pair_history(engagement, [load], _POSITIONS)
    return ReliefCurve(history, transmission_error(engagement, load, _HARMONICS), *relief)


def _told(seen: Seen) -> str:
    """The relief of a curve in the legend."""
    one: ReliefCurve = seen.one
    return f"{one.amount_over_delta:.3g} Δ, L_{{n}} = {one.length:.3g}" if one.amount_over_delta else "no relief"


def _role(seen: Seen) -> str:
    number = int(seen.key)
    return ramp(len(seen.data.curves) - 1)[number - 1] if number else "no relief"


def _over_roll(quantity: str, axis: Axis) -> Over:
    """A quantity of the tooth pair over the roll angle, a curve for each relief."""
    line = Line(
        f"history.{quantity}", _told, _role, x="history.driver_roll_angle", each=Family("curves", most=_MOST + 1),
        look={"markers": False},
    )  # fmt: skip
    return Over(
        Axis("roll angle of the driver", "deg"), (line,), axis,
        marks=lambda seen: roll_marks(seen.data.pair.pair, "driver"),
    )  # fmt: skip


def _amplitude(n: int) -> Cell:
    return Cell("amplitude", lambda seen: [one.error.series.amplitude[n] for one in seen.data.curves],
                name=f"amplitude_{n + 1}")  # fmt: skip


_SHEET = Sheet(
    loads=lambda seen: [seen.data.pair.nominal],
    nominal=lambda _: 0,
    tables=(
        Rows(
            "relief_curves_{name}",
            "Transmission error and load of a tooth pair of {name} for each relief, {load:said}",
            (
                "amount", "length", "history.x", "history.driver_roll_angle",
                Cell("history.transmission_error", name="te"), "history.load", "history.share",
            ),
            stacked="curves",
        ),
        Rows(
            "relief_curves_summary_{name}", "Transmission error of {name} for each relief",
            (
                "amount", "amount_over_delta", "length", "error.peak_to_peak", "error.effective_error",
                *(_amplitude(n) for n in range(_TOLD)),
            ),
            of="curves",
        ),
    ),
    values=(Number("delta", meaning=unit_in_words),),
    figures=(
        Chart(
            "relief_curves_{name}", "Reliefs of pair {name}",
            "Pair {name}: static transmission error, and load on one tooth pair from its first to its last contact, "
            "with equal tip relief on both gears: amount over Δ = {d.delta:.4g}, length 1 from tip to HPSTC.",
            (
                _over_roll("transmission_error", Axis("transmission error", "um")),
                _over_roll("load", Axis("load on the pair", "N", zero=True)),
            ),
            under="{load:said}",
        ),
    ),
    settings={"reliefs": lambda seen: len(seen.data.curves) - 1},
)  # fmt: skip


def _forecast(scene: Scene, _name: str) -> Forecast:
    """Each relief alike; tip corners off the path cost three times as much."""
    part = design_part(scene).chart
    count = 1 + len(part.amounts or part.amounts_over_delta or [1.0]) * len(part.lengths or [1.0])
    return Forecast({"reliefs": count}, count * _EACH * (3.0 if scene.case.effects.corner_contact else 1.0))


RELIEF_CURVES = relief_stage(
    answers=("transmission error",),
    inputs=Reads.of(lambda scene: design_part(scene).chart),
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=citing(Citation("lin-townsend-oswald", "tip reliefs by amount over Delta and length L_n", "Figs. 3 to 6")),
    forecast=_forecast,
)
