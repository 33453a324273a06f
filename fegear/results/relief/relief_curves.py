"""Result ``relief-curves``: transmission error and load of a tooth pair over its engagement, relief by relief."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import product
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import column_of, column_over, columns_of, repeated, stacked
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, ramp
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Reads, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results.gear.drawing import roll_marks
from fegear.results.relief.relief import design_part, relief_stage

if TYPE_CHECKING:
    from fegear.case.design import ChartPart
    from fegear.case.reading import Scene
    from fegear.contact.plane.engagement import Engagement
    from fegear.contact.plane.loaded_pair import LoadedPair
    from fegear.contact.plane.pair_history import PairHistory
    from fegear.contact.plane.transmission_error import TransmissionError

_POSITIONS, _HARMONICS, _TOLD = 200, 12, 4
#: Reliefs that one figure still tells apart.
_MOST = 24
#: One relief followed and integrated [s].
_EACH = 0.02


@dataclass(frozen=True)
class ReliefCurve:
    """What one relief makes of the pair.

    Parameters
    ----------
    amount : float
        At both tips [m]; zero for perfect involutes.
    length : float
        L_n of TM-89901.
    history : PairHistory
        One tooth pair over the path of contact.
    error : TransmissionError
        Over the base pitch.
    """

    amount: float
    length: float
    history: PairHistory
    error: TransmissionError


@dataclass(frozen=True)
class ReliefCurvesData:
    """Every relief, perfect involutes first, and Welbourn's Delta [m]."""

    pair: LoadedPair
    delta: float
    curves: tuple[ReliefCurve, ...]


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
    curves = [_curve(plain, pair.nominal, 0.0, 0.0)]
    wanted = list(product(sorted(amounts), sorted(part.lengths or [1.0])))
    for amount, length in wanted:
        relieved = replace(
            plain,
            driver_relief=normalised_tip_relief(plain.pair, "driver", amount, length, part.shape),
            driven_relief=normalised_tip_relief(plain.pair, "driven", amount, length, part.shape),
        )
        curves.append(_curve(relieved, pair.nominal, amount, length))
        work.progress(len(curves) / (1 + len(wanted)))
    return ReliefCurvesData(pair, delta, tuple(curves))


def _curve(engagement: Engagement, load: float, amount: float, length: float) -> ReliefCurve:
    from fegear.contact.plane.pair_history import pair_history
    from fegear.contact.plane.transmission_error import transmission_error

    history = pair_history(engagement, [load], _POSITIONS)
    return ReliefCurve(amount, length, history, transmission_error(engagement, load, _HARMONICS))


def _along(history: PairHistory) -> tuple[Column, ...]:
    return (
        *columns_of(history, "x", "driver_roll_angle", load=0),
        column_of(history, "transmission_error", load=0, name="te"),
        *columns_of(history, "load", "share", load=0),
    )


def _present(data: ReliefCurvesData, inputs: Reads[ChartPart]) -> Outcome:
    from fegear.design.charts import ReliefChart, meaning_of_unit

    name, curves = inputs.name, data.curves
    amounts, lengths = np.array([c.amount for c in curves]), np.array([c.length for c in curves])
    relief = column_of(ReliefChart, "amounts", amounts), column_of(ReliefChart, "lengths", lengths)
    history = Table(
        f"relief_curves_{name}",
        (
            *repeated(relief, [curve.history.x.size for curve in curves]),
            *stacked([_along(curve.history) for curve in curves]),
        ),
        f"Transmission error and load of a tooth pair of {name} for each relief, {data.pair.nominal:.6g} N",
    )
    series = np.array([curve.error.series.amplitude[:_TOLD] for curve in curves])
    summary = Table(
        f"relief_curves_summary_{name}",
        (
            relief[0],
            Column("amount_over_delta", amounts / data.delta, "", "amount / Welbourn's Delta"),
            relief[1],
            *(column_over([curve.error for curve in curves], key) for key in ("peak_to_peak", "effective_error")),
            *(Column(f"amplitude_{n + 1}", series[:, n], "um", "harmonic, amplitude") for n in range(_TOLD)),
        ),
        f"Transmission error of {name} for each relief",
    )
    value = Value(f"{name}.delta", data.delta, "um", None, meaning_of_unit(data.pair.pair))
    return Outcome(data, (history, summary), (value,), {"reliefs": len(curves) - 1}, figures=(_figure(name, data),))


def _figure(name: str, data: ReliefCurvesData) -> Figure:
    """Transmission error and load over the roll angle, one curve for each relief."""
    roll = Axis("roll angle of the driver", "deg")
    looks = [("no relief", "no relief")]
    looks += [
        (f"{curve.amount / data.delta:.3g} Δ, L_{{n}} = {curve.length:.3g}", role)
        for curve, role in zip(data.curves[1:], ramp(len(data.curves) - 1), strict=True)
    ]

    def curves(key: str, factor: float) -> tuple[Curve, ...]:
        return tuple(
            Curve(
                np.degrees(curve.history.driver_roll_angle), np.ravel(getattr(curve.history, key)) * factor, text, role,
                markers=False,
            )
            for curve, (text, role) in zip(data.curves, looks, strict=True)
        )  # fmt: skip

    marks = roll_marks(data.pair.engagement.pair, "driver")
    return Figure(
        f"relief_curves_{name}",
        f"Reliefs of pair {name}",
        f"Pair {name}: static transmission error, and load on one tooth pair from its first to its last contact, with "
        f"equal tip relief on both gears: amount over Δ = {data.delta * 1e6:.4g} µm, length 1 from tip to HPSTC.",
        (
            Panel(roll, Axis("transmission error", "um"), curves("transmission_error", 1e6), marks),
            Panel(roll, Axis("load on the pair", "N", zero=True), curves("load", 1.0), marks),
        ),
        under=f"{data.pair.nominal:.5g} N",
    )


def _forecast(scene: Scene, _name: str) -> Forecast:
    """Each relief alike; tip corners off the path cost three times as much."""
    part = design_part(scene).chart
    count = 1 + len(part.amounts or part.amounts_over_delta or [1.0]) * len(part.lengths or [1.0])
    return Forecast({"reliefs": count}, count * _EACH * (3.0 if scene.case.effects.corner_contact else 1.0))


RELIEF_CURVES = relief_stage(
    answers=("transmission error",),
    inputs=Reads.of(lambda scene: design_part(scene).chart),
    compute=_compute,
    present=_present,
    check=_check,
    cites=citing(Citation("lin-townsend-oswald", "tip reliefs by amount over Delta and length L_n", "Figs. 3 to 6")),
    forecast=_forecast,
)
