"""Causes of a measured strain: the computed strain with other reliefs, torques, pitches and places beside a trace."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.trace_causes import Causes, Traced, likeliest_causes
from fegear.results.gear.solved_gear import solution_of
from fegear.results.pair.loaded_teeth import loaded_pair
from fegear.results.pair.placed_gauge import gauges_on, placed_gauge

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.built.gauges import Gauge
    from fegear.contact.fitted_curve import FittedCurve
    from fegear.contact.gauge_strain import GaugeHistory
    from fegear.contact.plane.possible_flanks import Possible
    from fegear.contact.trace_causes import Cause
    from fegear.engine.stage import Upstream

#: Places of the averaged trace, and roll positions over the base pitch.
_PLACES, _POSITIONS = 240, 60
#: Shift to either side of the fitted one, where the zero of the angle is fitted [tooth pitches].
_SHIFT = 0.15
#: Times the placement tolerance to which a grid is displaced.
_BEYOND = 1.0


def causes_of_strain(
    gauge: Gauge, found: FittedCurve, history: GaugeHistory, at: int, upstream: Upstream, load: float, tolerance: float
) -> Causes:
    """Which relief, torque or pitch explains what a plane gauge measured; none where a displaced grid does.

    Parameters
    ----------
    gauge : Gauge
    found : FittedCurve
        Its trace beside the computed strain.
    history : GaugeHistory
    at : int
        Number of the nominal load.
    upstream : mapping
    load : float
        The nominal one [N].
    tolerance : float
        Relative difference of measured and computed strain by load, gauge factor, place and computation.
    """
    from fegear.contact.plane.gauge_history import gauge_history
    from fegear.contact.plane.possible_flanks import Possible, possible_flanks, possible_pitches

    e, solved = loaded_pair(upstream, gauge.pair).engagement, solution_of(upstream, gauge.gear)
    place = placed_gauge(gauge, solved)
    grids, opposite = gauges_on(gauge, place, solved)
    alone, nowhere = grids.only(int(np.argmin(np.abs(place.displacement)))), np.zeros(1)

    def curves_of(possible: Possible, value: float) -> list[tuple[Array, Array]]:
        if possible.kind == "place":
            by_place = history.displaced[:, at]
            return [(history.angle, np.array([np.interp(value, history.displacement, one) for one in by_place]))]
        changed, factor = possible.made(value)
        seen = gauge_history(
            changed, (), [factor * load], factor * load, gauge.member, alone, opposite, nowhere, gauge.tooth,
            estimates=False, positions=_POSITIONS,
        )  # fmt: skip
        return [(seen.angle, (value if possible.kind == "scale" else 1.0) * seen.strain[:, 0])]

    possible = [*possible_flanks(e), *possible_pitches(e, gauge.member, gauge.tooth)]
    if history.displacement.size > 1:
        ends = _BEYOND * float(history.displacement[0]), _BEYOND * float(history.displacement[-1])
        possible.append(Possible("place", (gauge.member,), 0.0, *ends, lambda _value: (e, 1.0)))
    places, values, noise = _averaged(found)
    shift = _SHIFT * 2.0 * math.pi / abs(e.pair.gear(gauge.member).teeth) if "shift" in found.fit else 0.0
    trace = Traced(
        places, values, noise, "offset" in found.fit, shift, tolerance, load_tolerance=gauge.load_tolerance
    )  # fmt: skip

    def within(cause: Cause) -> bool:
        kind = cause.of.kind  # a size that nothing but the flanks explains is judged as such
        return kind in ("place", "scale") or (kind == "load" and abs(cause.value - 1.0) <= gauge.load_tolerance)

    return likeliest_causes([trace], possible, curves_of, within)


def _averaged(found: FittedCurve) -> tuple[Array, Array, float]:
    """Means of the samples about even places, less the fitted offset, and their standard error."""
    low, high = float(found.angle.min()), float(found.angle.max())
    cell = np.minimum((_PLACES * (found.angle - low) / (high - low)).astype(int), _PLACES - 1)
    count = np.bincount(cell, minlength=_PLACES)
    some = count > 0
    places, values = (np.bincount(cell, of, _PLACES)[some] / count[some] for of in (found.angle, found.as_measured))
    return places, values, found.noise * abs(found.scale) / math.sqrt(float(count[some].mean()))
