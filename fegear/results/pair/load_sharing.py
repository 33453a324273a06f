"""Stage ``load-sharing``: one tooth pair followed from first to last contact.

Stage ``flank-load-sharing``: result ``load-sharing`` of pairs that are loaded with their width.

Tables, values and figure of one tooth pair from first to last contact, in the plane and over the face.
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.case.built.loaded_flanks import FLANK_EFFECTS
from fegear.case.built.loaded_pair import check_relief
from fegear.engine.citation import Citation, citing
from fegear.engine.figure.figure import Axis, Figure, Panel
from fegear.engine.figure.items import Curve
from fegear.engine.outcome import Outcome, Value
from fegear.engine.stage import Forecast, Stage, Subject
from fegear.engine.table import Column, Table
from fegear.results import forecasts
from fegear.results.forecasts import HERTZ
from fegear.results.gear.drawing import LINE_OF_ACTION, path_marks
from fegear.results.pair.loaded_flanks import loaded_flanks, needs_flanks, wide_pairs
from fegear.results.pair.loaded_pair import EFFECTS, drawn_loads, needs_pair, over_loads, plane_pairs

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.built.loaded_pair import LoadedPair
    from fegear.case.reading import Scene
    from fegear.contact.plane.pair_history import PairHistory
    from fegear.engine.stage import Upstream, Work
    from fegear.geometry.pair import GearPair
    from fegear.results.pair.loaded_flanks import LoadedFlanksData


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


def _at_corner(pair: LoadedPair, h: PairHistory) -> Array:
    p = pair.engagement.pair
    return np.where((h.x < p.x_start) | (h.x > p.x_end), 1.0, 0.0)


def _compute(_inputs: Subject, upstream: Upstream, _work: Work) -> LoadSharingData:
    from fegear.contact.plane.pair_history import pair_history
    from fegear.contact.plane.shifted_compliance import load_shift

    (found,) = upstream.values()
    pair: LoadedPair = found.pair
    history = pair_history(pair.engagement, pair.loads, _POSITIONS)
    shifts = [load_shift(history, pair_history(other, pair.loads, _POSITIONS)) for other in pair.shifted]
    return LoadSharingData(pair, history, np.sum(shifts, axis=0) if shifts else None)


def _present(data: LoadSharingData, inputs: Subject) -> Outcome:
    name, pair, history = inputs.name, data.pair, data.history
    i, off_path = pair.loads.index(pair.nominal), _at_corner(pair, history)
    beyond = ", outside which tip corners touch" if pair.engagement.corner_contact else ""
    shown = FollowedPair(
        name, pair.engagement.pair, pair.loads, i, history, data.load_error, off_path,
        f"{beyond}. Compliances: {'; '.join(pair.sources)}.",
    )  # fmt: skip
    remarks = []
    worst = float((off_path * history.load[:, i]).max())
    if pair.engagement.corner_contact and worst > 0.0:
        remarks.append(
            f"Pair {name}: tip corners touch off the path and carry up to {worst:.4g} N ({worst / pair.nominal:.1%}); "
            "hertz_pressure there is that of smooth flanks, the true one is higher."
        )
    settings = {"positions": _POSITIONS}
    return Outcome(
        data, history_tables(shown), history_values(shown), settings, tuple(remarks), (history_figure(shown),)
    )


def _forecast(scene: Scene, name: str) -> Forecast:
    """One history for each engagement."""
    each = _HISTORY + (_HISTORY_CORNERS if scene.case.effects.corner_contact else 0.0)
    return Forecast(
        {"positions": 200, "loads": forecasts.loads(scene, name)}, each * forecasts.engagements(scene, name)
    )


@dataclass(frozen=True)
class FlankLoadSharingData:
    """What the stage hands to tables and pictures.

    Parameters
    ----------
    loaded : LoadedFlanksData
    history : PairHistory
        Under every load of the case.
    load_error : ndarray, shape (P, L)
        Estimated error of its loads [N].
    pressure_error : float
        Of the largest pressure at the nominal load [Pa].
    """

    loaded: LoadedFlanksData
    history: PairHistory
    load_error: Array
    pressure_error: float


def _compute_wide(inputs: Subject, upstream: Upstream, _work: Work) -> FlankLoadSharingData:
    from fegear.contact.wide.pair_history import flank_pair_history, history_error

    loaded = loaded_flanks(upstream, inputs.name)
    found, coarse, pair = loaded.found, loaded.error.coarse, loaded.found.pair
    history = flank_pair_history(found, loaded.gaps.at(pair, found.lines))
    again = flank_pair_history(coarse, loaded.gaps.at(pair, coarse.lines))
    largest, other = (one.hertz_pressure[:, loaded.nominal].max() for one in (history, again))
    missed = loaded.missed  # by slices, of compliances
    error = history_error(history, again) + missed * history.load * (1.0 - history.share)
    return FlankLoadSharingData(loaded, history, error, float(abs(other - largest) + 0.5 * missed * largest))


def _present_wide(data: FlankLoadSharingData, inputs: Subject) -> Outcome:
    loaded, history, pair = data.loaded, data.history, data.loaded.found.pair
    helical = pair.driver.helix_angle != 0.0
    about = (
        " in the middle of the face, before and after which the contact line crosses a part of it. "
        if helical
        else ". "
    )
    shown = FollowedPair(
        inputs.name, pair, loaded.asked.loads, loaded.nominal, history, data.load_error, None,
        f"{about}Gears with their width, {'coupled slices' if loaded.asked.width == 'slices' else 'solid'}.",
        data.pressure_error,
    )  # fmt: skip
    settings = {"positions": history.x.size}
    return Outcome(data, history_tables(shown), history_values(shown), settings, (), (history_figure(shown),))


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


LOAD_SHARING = Stage(
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


FLANK_LOAD_SHARING = Stage(
    subjects=wide_pairs,
    needs=needs_flanks,
    inputs=Subject.of,
    compute=_compute_wide,
    present=_present_wide,
    effects=FLANK_EFFECTS,
    cites=citing(Citation("mark", "load sharing of the tooth pairs in reach", "Appendix A"), HERTZ),
    forecast=lambda _scene, _name: forecasts.constant(0.05),
)
