"""Stage ``load-sharing``: one tooth pair followed over the path of contact, plane or with its width."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array
from fegear.case.reading import Scene
from fegear.contact.loaded_teeth import POSITIONS, LoadedTeeth, LoadHistory
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import axis_of, column_of, columns_of, curve_of, error_column, value_of
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Subject, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results import forecasts
from fegear.results.forecasts import HERTZ
from fegear.results.gear.drawing import LINE_OF_ACTION, path_marks
from fegear.results.pair.loaded_teeth import drawn_loads, loaded_teeth, over_loads, teeth_stage, under_load

#: One engagement followed over its path [s], what corners off the path add to it, and a pair with a width.
_HISTORY, _HISTORY_CORNERS, _WIDE = 0.006, 0.02, 0.05


@dataclass(frozen=True)
class LoadSharingData:
    """The loaded teeth, and one pair of them followed over its path."""

    teeth: LoadedTeeth
    history: LoadHistory


def _compute(inputs: Subject, upstream: Upstream, _work: Work) -> LoadSharingData:
    teeth = loaded_teeth(upstream, inputs.name)
    return LoadSharingData(teeth, teeth.history())


def _tables(name: str, data: LoadSharingData) -> tuple[Table, ...]:
    """The pair at the nominal load, and under every load."""
    h, loads = data.history, data.teeth.loads
    columns = [*columns_of(h.found, table="path", load=h.at)]
    error = None if h.load_error is None else error_column(column_of(h.found, "load"), h.load_error[:, h.at])
    if h.corner is not None:
        columns.append(column_of(h, "corner"))
    columns += [] if error is None else [error]
    title = f"Load on one tooth pair of {name}"
    tables = [Table(f"load_sharing_{name}", tuple(columns), f"{title}, {loads[h.at]:.6g} N")]
    if len(loads) > 1:
        every = over_loads(loads, [columns_of(h.found, table="path", load=k) for k in range(len(loads))])
        tables.append(Table(f"load_sharing_loads_{name}", every, f"{title} for every load"))
    if len(loads) > 1 and h.corner is not None:
        tables.append(_corners(name, h.found.load, h.corner, np.asarray(loads)))
    return tuple(tables)


def _corners(name: str, load: Array, corner: Array, loads: Array) -> Table:
    """What tip corners carry off the path under every load: from which load on there is tip interference."""
    carried = (corner[:, None] * load).max(axis=0)
    columns = (
        Column("total_load", loads, "N", "mesh force"),
        Column("corner_load", carried, "N", "largest load on one tooth pair whose tip corner touches off the path"),
        Column("share", carried / loads, "", "corner_load over total_load"),
    )
    return Table(f"tip_corner_loads_{name}", columns, f"Load on tip corners of {name} for every load")


def _values(name: str, h: LoadHistory) -> tuple[Value, ...]:
    return (
        value_of(h, "largest_load", name, h.largest_load_error),
        value_of(h, "largest_share", name, h.largest_share_error),
        value_of(h, "largest_hertz_pressure", name, h.largest_pressure_error, further=f", {h.hardest_pressed_at}"),
    )


def _figure(name: str, data: LoadSharingData) -> Figure:
    """Load and largest pressure over the path, for a few of the loads."""
    teeth, h = data.teeth, data.history
    marks, panels = path_marks(teeth.pair), []
    for key in ("load", "hertz_pressure"):
        errors = h.load_error if key == "load" else None
        curves = [
            curve_of(h.found, "x", key, label, role, errors[:, i] if errors is not None and i == h.at else None, load=i)
            for i, label, role in drawn_loads(teeth.loads, teeth.nominal)
        ]
        panels.append(Panel(LINE_OF_ACTION, axis_of(type(h.found), key, zero=True), tuple(curves), marks))
    return Figure(
        f"load_sharing_{name}",
        f"Load on a tooth pair of pair {name}",
        f"Pair {name}: one tooth pair from its first to its last contact; A to E: points of the path{h.where}. "
        f"{teeth.about}",
        tuple(panels),
        under=under_load(teeth.loads),
    )


def _remarks(name: str, data: LoadSharingData) -> tuple[str, ...]:
    h = data.history
    worst = 0.0 if h.corner is None else float((h.corner * h.found.load[:, h.at]).max())
    if worst == 0.0:
        return ()
    said = (
        f"Pair {name}: tip corners touch off the path and carry up to {worst:.4g} N "
        f"({worst / data.teeth.nominal:.1%}); hertz_pressure there is that of smooth flanks, the true one is higher."
    )
    return (said,)


def _present(data: LoadSharingData, inputs: Subject) -> Outcome:
    name, h = inputs.name, data.history
    settings = {"positions": h.positions}
    figures = (_figure(name, data),)
    return Outcome(data, _tables(name, data), _values(name, h), settings, _remarks(name, data), figures)


def _forecast(scene: Scene, name: str) -> Forecast:
    """One history for each engagement of plane teeth."""
    if name in scene.wide_pairs:
        return forecasts.constant(_WIDE)
    each = _HISTORY + (_HISTORY_CORNERS if scene.case.effects.corner_contact else 0.0)
    settings = {"positions": POSITIONS, "loads": forecasts.loads(scene, name)}
    return Forecast(settings, each * forecasts.engagements(scene, name))


LOAD_SHARING = teeth_stage(
    answers=("load on a tooth pair",),
    every_load=True,
    inputs=Subject.of,
    compute=_compute,
    present=_present,
    cites=citing(Citation("mark", "load sharing of the tooth pairs in reach", "Appendix A"), HERTZ),
    forecast=_forecast,
)
