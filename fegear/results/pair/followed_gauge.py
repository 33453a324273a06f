"""A gauge on its way through the mesh, in plane (2D) and on 3D teeth: place, strain, strain with further effects."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.contact.gauge_strain import GaugeHistory, StrainWith
from fegear.results.gear.solved_gear import solid_solution_of, solution_of
from fegear.results.pair.loaded_teeth import loaded_pair, loaded_teeth
from fegear.results.pair.placed_gauge import PlacedGauge, gauges_on, placed_gauge, placed_on_face

if TYPE_CHECKING:
    from fegear.case.built.gauges import Gauge
    from fegear.contact.wide.loaded_pair import LoadedWidePair
    from fegear.engine.stage import Upstream


@dataclass(frozen=True)
class FollowedGauge:
    """A gauge on its way through the mesh: place, strain, clearance [modules], strain with more effects."""

    place: PlacedGauge
    history: GaugeHistory
    clearance: float
    more: dict[str, StrainWith]


def gauge_in_plane(gauge: Gauge, upstream: Upstream, *, estimates: bool, neglected: bool) -> FollowedGauge:
    """On a plane tooth."""
    from fegear.contact.plane.gauge_history import gauge_history, gauge_neglects

    solved = solution_of(upstream, gauge.gear)
    teeth, place = loaded_pair(upstream, gauge.pair), placed_gauge(gauge, solved)
    grids, opposite = gauges_on(gauge, place, solved)
    history = gauge_history(
        teeth.engagement, teeth.shifted, teeth.loads, teeth.nominal, gauge.member, grids, opposite,
        place.displacement, gauge.tooth, estimates=estimates,
    )  # fmt: skip
    more = {}
    if neglected:
        alone = grids.only(int(np.argmin(np.abs(place.displacement))))
        more = gauge_neglects(teeth.spec, teeth.engagement, gauge.member, alone, opposite, gauge.tooth)
    clearance = place.clearance(history.pair, gauge.member, gauge.side, solved.fine.flank)
    return FollowedGauge(place, history, clearance, more)


def gauge_on_face(gauge: Gauge, upstream: Upstream, *, neglected: bool) -> FollowedGauge:
    """On a 3D tooth; its errors are those of the solution of its pair."""
    from fegear.contact.wide.gauge_on_face import wide_gauge_history, wide_gauge_neglects

    solved = solid_solution_of(upstream, gauge.gear)
    teeth = cast("LoadedWidePair", loaded_teeth(upstream, gauge.pair))
    place = placed_on_face(gauge, solved, teeth.pair.gear(gauge.member))
    history = wide_gauge_history(
        teeth, gauge.member, gauge.side, gauge.grid, place.middle, place.displacement, gauge.z, solved
    )
    more = {}
    if neglected:
        more = wide_gauge_neglects(teeth, gauge.member, gauge.side, gauge.grid, place.middle, gauge.z, solved)
    clearance = place.clearance(teeth.pair, gauge.member, gauge.side, solved.fine.flank)
    return FollowedGauge(place, history, clearance, more)
