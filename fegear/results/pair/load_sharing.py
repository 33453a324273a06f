"""Stage ``load-sharing``: one tooth pair followed over the path of contact, plane or with its width."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass

import numpy as np

from fegear.base.arrays import Array
from fegear.base.printed import percent
from fegear.base.shown import shown, shows
from fegear.case.reading import Scene
from fegear.contact.loaded_teeth import POSITIONS, LoadedTeeth, LoadHistory
from fegear.engine.citation import Citation, citing
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import LOADS, Chart, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Every, EveryLoad, Off, Rows
from fegear.engine.sheet.seen import Seen
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Subject, Upstream, Work
from fegear.results import forecasts
from fegear.results.forecasts import HERTZ
from fegear.results.gear.path_marks import LINE_OF_ACTION, path_marks
from fegear.results.pair.loaded_teeth import loaded_teeth, teeth_stage
from fegear.results.pair.over_loads import OVER_LOADS

#: One engagement followed over its path [s], what corners off the path add to it, and a pair with a width.
_HISTORY, _HISTORY_CORNERS, _WIDE = 0.035, 0.03, 0.05
#: From this share on a tooth pair carries the whole load.
_WHOLE = 1.0 - 1e-6


@dataclass(frozen=True)
class CornerLoads:
    """What tip corners carry off the path under every load: from which load on there is tip interference.

    Parameters
    ----------
    total_load, corner_load : ndarray, shape (L,)
        [N].
    """

    total_load: Array = shown("N", "mesh force")
    corner_load: Array = shown("N", "maximum load of a tooth pair in corner contact outside the path of contact")

    @property
    @shows("", "corner_load / total_load")
    def share(self) -> Array:
        """Shape (L,)."""
        return self.corner_load / self.total_load


@dataclass(frozen=True)
class LoadSharingData:
    """The loaded teeth, and one pair of them followed over its path."""

    teeth: LoadedTeeth
    history: LoadHistory

    @property
    def corners(self) -> CornerLoads | None:
        """Of several loads, where tip corners can touch off the path."""
        loads, corner = np.asarray(self.teeth.loads), self.history.corner
        if corner is None or loads.size < 2:
            return None
        return CornerLoads(loads, (corner[:, None] * self.history.found.load).max(axis=0))

    @property
    @shows("N", "load carried by corner contact outside the path of contact, at nominal load")
    def on_corners(self) -> float:
        """[N]."""
        h = self.history
        return 0.0 if h.corner is None else float((h.corner * h.found.load[:, h.at]).max())

    @property
    @shows("N.m", "torque on the driver")
    def torque(self) -> float:
        """Nominal [N m]."""
        return self.teeth.nominal * self.teeth.pair.driver.base_radius

    @property
    def alone(self) -> float:
        """Part of the base pitch over which one tooth pair carries the whole nominal load."""
        found = self.history.found
        whole = np.where(found.share[:, self.history.at] > _WHOLE, 1.0, 0.0)
        return float(np.trapezoid(whole, found.x)) / self.teeth.pair.base_pitch

    @property
    def share_on_corners(self) -> float:
        """Of the nominal load."""
        return self.on_corners / self.teeth.nominal


def _compute(inputs: Subject, upstream: Upstream, _work: Work) -> LoadSharingData:
    teeth = loaded_teeth(upstream, inputs.name)
    return LoadSharingData(teeth, teeth.history())


def _alone(seen: Seen) -> Iterator[str]:
    if seen.data.alone > 0.0:
        share = percent(seen.data.alone)
        yield f"Pair {seen.name}: one tooth pair carries the whole load over {share} of a base pitch."


_TITLE = "Load on one tooth pair of {name}"
_LOAD = Line("load", error="history.load_error", each=LOADS)
_SHEET = Sheet(
    loads="teeth.loads",
    nominal="history.at",
    tables=(
        Rows(
            "load_sharing_{name}", _TITLE + ", {load:said}",
            (Every("path"), Cell("corner", of="history"), Off("load", "history.load_error")), of="history.found",
        ),
        EveryLoad(
            "load_sharing_loads_{name}", _TITLE + " for every load", (Every("path"),), "history.found", OVER_LOADS
        ),
        Rows(
            "tip_corner_loads_{name}", "Corner contact load of {name} for every load",
            ("total_load", "corner_load", "share"), of="corners",
        ),
    ),
    values=(
        Number("largest_load", "history.largest_load_error", "history"),
        Number("largest_share", "history.largest_share_error", "history"),
        Number(
            "largest_hertz_pressure", "history.largest_pressure_error", "history",
            further=", {d.history.hardest_pressed_at}",
        ),
    ),
    figures=(
        Chart(
            "load_sharing_{name}", "Load on a tooth pair of pair {name}",
            "Pair {name}: one tooth pair from first to last contact; A to E: points of the path of "
            "contact{d.history.where}. {d.teeth.about}",
            tuple(
                Over(
                    LINE_OF_ACTION, (line,), options={"zero": True},
                    marks=lambda seen: path_marks(seen.data.teeth.pair),
                )
                for line in (_LOAD, Line("hertz_pressure", each=LOADS))
            ),
            of="history.found",
            under=LOADS,
        ),
    ),
    remarks=(
        Remark(
            lambda seen: seen.said("Pair {name}: corner contact outside the path of contact, up to {d.on_corners:.4g} ")
            + f"({percent(seen.data.share_on_corners)}); hertz_pressure there is for smooth flanks and underestimates "
            "the pressure at the tip edge.",
            when="on_corners",
        ),
    ),
    settings={"positions": "history.positions"},
    answer=Answer(
        "Pair {name} at {d.torque:.3g}: one tooth pair carries at most {v[largest_share]:%} of the load, "
        "{v[largest_load]}.",
        "Pair {name}: maximum Hertzian pressure {v[largest_hertz_pressure]}.",
        _alone,
        figure="load_sharing_{name}",
    ),
)  # fmt: skip


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
    present=_SHEET.present,
    cites=citing(Citation("mark", "load sharing of the tooth pairs", "Appendix A"), HERTZ),
    forecast=_forecast,
)
