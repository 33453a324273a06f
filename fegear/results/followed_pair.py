"""Tables, values and figure of one tooth pair from first to last contact, in the plane and over the face."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Curve, Figure, Panel
from fegear.engine.outcome import Column, Table, Value
from fegear.results.drawn_pair import LINE_OF_ACTION, path_marks
from fegear.results.loaded_pair import drawn_loads, over_loads

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.contact import PairHistory
    from fegear.geometry import GearPair


@dataclass(frozen=True)
class FollowedPair:
    """A tooth pair followed under every load, ready to be shown.

    Parameters
    ----------
    name : str
        Of the pair of gears.
    pair : GearPair
    loads : tuple of float
        Ascending [N].
    nominal : int
        Number of the nominal one.
    history : PairHistory
    load_error : ndarray, shape (P, L), or None
        Estimated error of its loads [N].
    corner : ndarray, shape (P,), or None
        1 where a tip corner touches off the path, whose pressure is not that of smooth flanks; None where none can.
    about : str
        What else its figure tells.
    pressure_error : float or None
        Estimated error of the largest pressure at the nominal load, where it is known by itself [Pa].
    """

    name: str
    pair: GearPair
    loads: tuple[float, ...]
    nominal: int
    history: PairHistory
    load_error: Array | None
    corner: Array | None
    about: str
    pressure_error: float | None = None


def _columns(h: PairHistory, i: int) -> tuple[Column, ...]:
    return (
        Column("x", h.x, "mm", "position of the pair on the line of action, from the pitch point"),
        Column("roll_angle", h.driver_roll_angle, "deg", "of the contact point on the driver"),
        Column("load", h.load[:, i], "N", "on the pair along the line of action"),
        Column("share", h.share[:, i], "", "of the total load"),
        Column("deflection", h.deflection[:, i], "um", "of both teeth and their contact"),
        Column("hertz_pressure", h.hertz_pressure[:, i], "MPa", "largest pressure of smooth flanks"),
    )


def history_tables(f: FollowedPair, more: tuple[Column, ...] = ()) -> tuple[Table, ...]:
    """The pair at the nominal load, with `more` columns behind, and under every load."""
    i, name, history = f.nominal, f.name, f.history
    columns = [*_columns(history, i), *more]
    if f.corner is not None:
        columns.append(Column("corner", f.corner, "", "1 where a tip corner touches off the path"))
    if f.load_error is not None:
        columns.append(Column("load_error", f.load_error[:, i], "N", "estimated error of load"))
    title = f"Load on one tooth pair of {name}"
    tables = [Table(f"load_sharing_{name}", tuple(columns), f"{title}, {f.loads[i]:.6g} N")]
    if len(f.loads) > 1:
        columns_of = over_loads(f.loads, [_columns(history, k) for k in range(len(f.loads))])
        tables.append(Table(f"load_sharing_loads_{name}", columns_of, f"{title} for every load"))
    return tuple(tables)


def history_values(f: FollowedPair) -> tuple[Value, ...]:
    """Largest load, share and pressure at the nominal load."""
    name, history, i = f.name, f.history, f.nominal
    largest = int(np.argmax(history.load[:, i]))
    pressure = history.hertz_pressure[:, i] * (1.0 if f.corner is None else 1.0 - f.corner)
    hardest = int(np.argmax(pressure))
    error = None if f.load_error is None else float(f.load_error[largest, i])
    relative = None if error is None else error / history.load[largest, i]
    where = f"at x = {history.x[hardest] * 1e3:.5g} mm"
    by_load = 0.5 * relative * float(pressure[hardest]) if relative else None
    return (
        Value(f"{name}.largest_load", float(history.load[largest, i]), "N", error, "on one tooth pair"),
        Value(f"{name}.largest_share", float(history.share[largest, i]), "", relative, "of one tooth pair"),
        Value(
            f"{name}.largest_hertz_pressure", float(pressure[hardest]), "MPa",
            # Never exact: where the load has no error, what Hertz leaves out is still not estimated.
            by_load if f.pressure_error is None else f.pressure_error, f"smooth flanks, {where}",
        ),
    )  # fmt: skip


def history_figure(f: FollowedPair) -> Figure:
    """Load and largest pressure over the path, for a few of the loads."""
    h, x, marks = f.history, f.history.x * 1e3, path_marks(f.pair)
    load, pressure = [], []
    for i, label, role in drawn_loads(f.loads, f.loads[f.nominal]):
        error = f.load_error[:, i] if f.load_error is not None and i == f.nominal else None
        load.append(Curve(x, h.load[:, i], label, role, error))
        pressure.append(Curve(x, h.hertz_pressure[:, i] * 1e-6, label, role))
    return Figure(
        f"load_sharing_{f.name}",
        f"Load on a tooth pair of pair {f.name}",
        f"Pair {f.name}: one tooth pair from its first to its last contact; A to E: points of the path{f.about}",
        (
            Panel(LINE_OF_ACTION, Axis("load on the pair", "N", zero=True), tuple(load), marks),
            Panel(LINE_OF_ACTION, Axis("largest Hertzian pressure", "MPa", zero=True), tuple(pressure), marks),
        ),
        under=f"{f.loads[f.nominal]:.5g} N" if len(f.loads) == 1 else "",
    )
