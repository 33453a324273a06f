"""Stage ``load-sharing``: one tooth pair followed from first to last contact."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.figure import Axis, Curve, Figure, Panel
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Forecast, Stage, Subject
from fegear.models.pair_checks import check_relief
from fegear.results import forecasts
from fegear.results.drawn_pair import LINE_OF_ACTION
from fegear.results.loaded_pair import (
    EFFECTS,
    drawn_loads,
    engagement_marks,
    needs_pair,
    over_loads,
    plane_pairs,
    under,
)
from fegear.results.sources import HERTZ

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.case.reading import Scene
    from fegear.contact import PairHistory
    from fegear.engine.stage import Upstream, Work
    from fegear.models.loaded_pair import LoadedPair


_POSITIONS = 200


#: One engagement followed over its path [s], and what corners off the path add to it.
_HISTORY, _HISTORY_CORNERS = 0.006, 0.02


@dataclass(frozen=True)
class LoadSharingData:
    """What the stage hands to pictures.

    Parameters
    ----------
    pair : LoadedPair
    history : PairHistory
        Under every load of the case.
    load_error : ndarray or None
        Estimated error of its loads [N].
    """

    pair: LoadedPair
    history: PairHistory
    load_error: Array | None


def _columns(h: PairHistory, i: int) -> tuple[Column, ...]:
    return (
        Column("x", h.x, "mm", "position of the pair on the line of action, from the pitch point"),
        Column("roll_angle", h.driver_roll_angle, "deg", "of the contact point on the driver"),
        Column("load", h.load[:, i], "N", "on the pair along the line of action"),
        Column("share", h.share[:, i], "", "of the total load"),
        Column("deflection", h.deflection[:, i], "um", "of both teeth and their contact"),
        Column("hertz_pressure", h.hertz_pressure[:, i], "MPa", "largest pressure of smooth flanks"),
    )


def _at_corner(pair: LoadedPair, h: PairHistory) -> Array:
    p = pair.engagement.pair
    return np.where((h.x < p.x_start) | (h.x > p.x_end), 1.0, 0.0)


def _compute(_inputs: Subject, upstream: Upstream, _work: Work) -> LoadSharingData:
    from fegear.contact import pair_history
    from fegear.contact.error_by_shift import load_shift

    (found,) = upstream.values()
    pair: LoadedPair = found.pair
    history = pair_history(pair.engagement, pair.loads, _POSITIONS)
    shifts = [load_shift(history, pair_history(other, pair.loads, _POSITIONS)) for other in pair.shifted]
    return LoadSharingData(pair, history, np.sum(shifts, axis=0) if shifts else None)


def _present(data: LoadSharingData, inputs: Subject) -> Outcome:
    name, pair, history = inputs.name, data.pair, data.history
    i = pair.loads.index(pair.nominal)
    load_error = None if data.load_error is None else data.load_error[:, i]
    off_path = _at_corner(pair, history)
    columns = [*_columns(history, i), Column("corner", off_path, "", "1 where a tip corner touches off the path")]
    if load_error is not None:
        columns.append(Column("load_error", load_error, "N", "estimated error of load"))
    tables = [Table(f"load_sharing_{name}", tuple(columns), f"Load on one tooth pair of {name}, {pair.nominal:.6g} N")]
    if len(pair.loads) > 1:
        columns_of = over_loads(pair.loads, [_columns(history, k) for k in range(len(pair.loads))])
        title = f"Load on one tooth pair of {name} for every load"
        tables.append(Table(f"load_sharing_loads_{name}", columns_of, title))
    largest = int(np.argmax(history.load[:, i]))
    pressure = history.hertz_pressure[:, i] * (1.0 - off_path)
    hardest = int(np.argmax(pressure))
    error = None if load_error is None else float(load_error[largest])
    relative = None if error is None else error / history.load[largest, i]
    where = f"at x = {history.x[hardest] * 1e3:.5g} mm"
    values = (
        Value(f"{name}.largest_load", float(history.load[largest, i]), "N", error, "on one tooth pair"),
        Value(f"{name}.largest_share", float(history.share[largest, i]), "", relative, "of one tooth pair"),
        Value(
            f"{name}.largest_hertz_pressure", float(pressure[hardest]), "MPa",
            # Never exact: where the load has no error, what Hertz leaves out is still not estimated.
            0.5 * relative * float(pressure[hardest]) if relative else None, f"smooth flanks, {where}",
        ),
    )  # fmt: skip
    remarks = []
    worst = float((off_path * history.load[:, i]).max())
    if pair.engagement.corner_contact and worst > 0.0:
        remarks.append(
            f"Pair {name}: tip corners touch off the path and carry up to {worst:.4g} N ({worst / pair.nominal:.1%}); "
            "hertz_pressure there is that of smooth flanks, the true one is higher."
        )
    figures = (_figure(name, data, load_error),)
    return Outcome(data, tuple(tables), values, {"positions": _POSITIONS}, tuple(remarks), figures)


def _figure(name: str, data: LoadSharingData, load_error: Array | None) -> Figure:
    h, pair = data.history, data.pair
    x, marks = h.x * 1e3, engagement_marks(pair)
    load, pressure = [], []
    for i, label, role in drawn_loads(pair.loads, pair.nominal):
        error = load_error if pair.loads[i] == pair.nominal else None
        load.append(Curve(x, h.load[:, i], label, role, error))
        pressure.append(Curve(x, h.hertz_pressure[:, i] * 1e-6, label, role))
    beyond = ", outside which tip corners touch" if pair.engagement.corner_contact else ""
    return Figure(
        f"load_sharing_{name}",
        f"Load on a tooth pair of pair {name}",
        f"Pair {name}: one tooth pair from its first to its last contact; A to E: points of the path{beyond}. "
        f"Compliances: {'; '.join(pair.sources)}.",
        (
            Panel(LINE_OF_ACTION, Axis("load on the pair", "N", zero=True), tuple(load), marks),
            Panel(LINE_OF_ACTION, Axis("largest Hertzian pressure", "MPa", zero=True), tuple(pressure), marks),
        ),
        under=under(pair),
    )


def _forecast(scene: Scene, name: str) -> Forecast:
    """One history for each engagement."""
    each = _HISTORY + (_HISTORY_CORNERS if scene.case.effects.corner_contact else 0.0)
    return Forecast(
        {"positions": 200, "loads": forecasts.loads(scene, name)}, each * forecasts.engagements(scene, name)
    )


LOAD_SHARING = Stage(
    name="load-sharing",
    title="Load sharing",
    results=("load-sharing",),
    about="load, deflection and contact pressure of a tooth pair from first to last contact",
    subjects=plane_pairs,
    needs=needs_pair,
    inputs=Subject.of,
    compute=_compute,
    present=_present,
    check=check_relief,
    effects=EFFECTS,
    cites=citing(Citation("mark", "load sharing of the tooth pairs in reach", "Appendix A"), HERTZ),
    forecast=_forecast,
)
