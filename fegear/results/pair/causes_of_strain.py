"""Causes of a measured strain: other reliefs, torques, pitches, places, low passes and bridges beside a trace."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from functools import cached_property
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.contact.plane.possible_flanks import Possible, possible_flanks, possible_pitches
from fegear.contact.trace_causes import Causes, Traced, likeliest_causes
from fegear.contact.trace_low_pass import HIGHER, MOST_OF_CURVE, WIDTH_OF_AVERAGE, delay, filtered, filtered_higher
from fegear.results.gear.solved_gear import solution_of
from fegear.results.pair.loaded_teeth import loaded_pair
from fegear.results.pair.placed_gauge import gauges_on, placed_gauge

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.base.arrays import Array
    from fegear.case.built.gauges import Gauge
    from fegear.contact.fitted_curve import FittedCurve
    from fegear.contact.gauge_strain import GaugeHistory
    from fegear.contact.plane.engagement import Engagement
    from fegear.contact.trace_causes import Cause
    from fegear.contact.trace_low_pass import Kind
    from fegear.engine.stage import Upstream

#: Places of the averaged trace, and roll positions over the base pitch.
_PLACES, _POSITIONS = 240, 60
#: Shift to either side of the fitted one, where the zero of the angle is fitted [tooth pitches].
_SHIFT = 0.15
#: Times the placement tolerance to which a grid is displaced; in a straight line where it has to be computed anew.
_BEYOND, _BEYOND_LINE = 4.0, 2.5
#: Times the placement tolerance that are still within it, which is no sharp line.
_NO_SHARP_LINE = 1.25
#: Angles of the time constant of a low pass [rad].
_LAGS = math.radians(0.1), math.radians(20.0)
#: Scales of a trace; arms that a bridge over both fillets may have been divided by.
_SCALES, _ARMS = (0.2, 5.0), (1, 2)
#: Tolerances that make a low pass, and one of higher order, and a bridge over both fillets as likely.
_LOW_PASS, _HIGHER_ORDER, _BRIDGE = 2.0, 2.5, 2.0


@dataclass(frozen=True)
class SeenStrain:
    """A computed strain beside which a trace is laid; P positions, G places of the grid.

    Parameters
    ----------
    angle, strain : ndarray, shape (P,)
        [rad].
    displacement : ndarray, shape (G,)
        Towards the tip [m]; zero is among them.
    displaced : ndarray, shape (P, G)
    opposite : ndarray, shape (P,), optional
        Under an equal grid in the other fillet of the tooth.
    """

    angle: Array
    strain: Array
    displacement: Array
    displaced: Array
    opposite: Array | None = None

    @property
    def reach(self) -> float:
        """Times the largest displacement up to which others follow in a straight line."""
        return _BEYOND_LINE

    def at_place(self, value: float) -> tuple[Array, Array]:
        """Angle and strain of a grid elsewhere."""
        place, curves = self.displacement, self.displaced.T
        k = int(np.clip(np.searchsorted(place, value), 1, place.size - 1))
        part = (value - place[k - 1]) / (place[k] - place[k - 1])
        return self.angle, curves[k - 1] + part * (curves[k] - curves[k - 1])


@dataclass(frozen=True)
class PlaneStrain(SeenStrain):
    """Of plane gears, whose strain is computed again with other flanks.

    Parameters
    ----------
    gauge : Gauge
    upstream : mapping
    load : float
        [N].
    """

    gauge: Gauge | None = None
    upstream: Upstream | None = None
    load: float = 0.0

    @property
    def reach(self) -> float:
        """They are computed."""
        return 1.0

    @cached_property
    def engagement(self) -> Engagement:
        """Of the pair."""
        return loaded_pair(*self._of).engagement

    @property
    def _of(self) -> tuple[Upstream, str]:
        return cast("Upstream", self.upstream), cast("Gauge", self.gauge).pair

    @cached_property
    def far(self) -> SeenStrain:
        """With the grid displaced beyond its tolerance."""
        gauge = cast("Gauge", self.gauge)
        found = self._followed(self.engagement, self.load, replace(gauge, placement=_BEYOND * gauge.placement))
        return SeenStrain(found.angle, found.strain[:, 0], found.displacement, found.displaced[:, 0])

    def changed(self, possible: Possible, value: float) -> tuple[Array, Array]:
        """Angle and strain with another flank or load."""
        changed, factor = possible.made(value)
        found = self._followed(changed, factor * self.load, replace(cast("Gauge", self.gauge), placement=0.0))
        return found.angle, found.strain[:, 0]

    def _followed(self, e: Engagement, load: float, gauge: Gauge) -> GaugeHistory:
        from fegear.contact.plane.gauge_history import gauge_history

        solved = solution_of(cast("Upstream", self.upstream), gauge.gear)
        place = placed_gauge(gauge, solved)
        grids, opposite = gauges_on(gauge, place, solved)
        return gauge_history(
            e, (), [load], load, gauge.member, grids, opposite, place.displacement, gauge.tooth,
            estimates=False, positions=_POSITIONS,
        )  # fmt: skip


def causes_of_strain(
    gauge: Gauge, found: FittedCurve, seen: SeenStrain, tolerance: float, teeth: int,
    progress: Callable[[float], None] = lambda _part: None,
) -> Causes:  # fmt: skip
    """What explains a measured strain: relief, torque or pitch of plane gears, place, scale, low pass or bridge.

    Parameters
    ----------
    gauge : Gauge
    found : FittedCurve
        Its trace beside the computed strain.
    seen : SeenStrain
        The computed strain.
    tolerance : float
        Relative difference of measured and computed strain by load, gauge factor, place and computation.
    teeth : int
        Of its gear.
    progress : callable, optional
        Takes the part that is done.
    """
    free, known = "shift" in found.fit, gauge.load_tolerance
    plane = seen if isinstance(seen, PlaneStrain) else None
    possible = [*_of_plane(plane, known)] if plane else [
        Possible("scale", (), 1.0, *_SCALES, _nothing, tolerance=known)
    ]  # fmt: skip
    as_stated = seen.angle, seen.strain
    possible += _of_measuring(gauge, seen)
    known_curves: dict[tuple[int, float], tuple[Array, Array]] = {}

    def curve_of(one: Possible, value: float) -> tuple[Array, Array]:
        if value == one.stated:
            return as_stated
        if one.kind == "scale":
            return seen.angle, value * seen.strain
        if one.kind == "place":
            return (plane.far if plane else seen).at_place(value)
        if one.kind == "filter":
            return _behind(seen, one, math.exp(value), delayed=not free)
        if one.kind == "bridge":
            return seen.angle, (seen.strain - cast("Array", seen.opposite)) / value
        key = possible.index(one), value
        if key not in known_curves:
            known_curves[key] = cast("PlaneStrain", plane).changed(one, value)
            progress(1.0 - 1.0 / (1.0 + len(known_curves) / 50.0))
        return known_curves[key]

    places, values, noise = _averaged(found)
    shift = _SHIFT * 2.0 * math.pi / abs(teeth) if free else 0.0
    trace = Traced(places, values, noise, "offset" in found.fit, shift, tolerance, load_tolerance=known)

    def within(cause: Cause) -> bool:
        off = abs(cause.value - cause.of.stated) - 2.0 * cause.error
        if cause.of.kind == "place":
            return off <= _NO_SHARP_LINE * gauge.placement
        return cause.of.kind in ("scale", "load") and off <= tolerance

    causes = likeliest_causes([trace], possible, lambda one, value: [curve_of(one, value)], within)
    best = causes.best
    if best is not None and best.of.kind == "filter":  # its delay is not that of the angle
        causes = replace(causes, curves=[_behind(seen, best.of, math.exp(best.value), delayed=True)])
    return causes


def _nothing(_value: float) -> tuple[Engagement, float]:
    raise NotImplementedError


def _of_plane(seen: PlaneStrain, load_tolerance: float) -> tuple[Possible, ...]:
    """What may be otherwise of flanks and load of a plane pair."""
    gauge, e = cast("Gauge", seen.gauge), seen.engagement
    return *possible_flanks(e, load_tolerance), *possible_pitches(e, gauge.member, gauge.tooth)


def _of_measuring(gauge: Gauge, seen: SeenStrain) -> list[Possible]:
    """What may be otherwise of grid, amplifier and bridge."""
    possible: list[Possible] = []
    if seen.displacement.size > 1:
        place = (seen.far if isinstance(seen, PlaneStrain) else seen).displacement
        ends = seen.reach * float(place[0]), seen.reach * float(place[-1])
        if ends[0] < 0.0 < ends[1]:
            possible.append(Possible("place", (gauge.member,), 0.0, *ends, _nothing, tolerance=gauge.placement))
    if _increasing(gauge):  # time goes with the angle
        width = math.log(MOST_OF_CURVE * float(seen.angle[-1] - seen.angle[0]) / WIDTH_OF_AVERAGE)
        lags = math.log(_LAGS[0]), math.log(_LAGS[1])
        possible += [
            Possible(
                "filter", (), -math.inf, lags[0], min(lags[1], width if kind == "moving average" else math.inf),
                _nothing, unlikely=_HIGHER_ORDER if kind else _LOW_PASS, called=kind, order=order,
            )
            for kind, order in (("", 1), *HIGHER)
        ]  # fmt: skip
    if seen.opposite is not None:
        possible += [
            Possible("bridge", (), math.inf, arms, arms, _nothing, unlikely=_BRIDGE, called=str(arms)) for arms in _ARMS
        ]
    return possible


def _increasing(gauge: Gauge) -> bool:
    """Whether the angle of its trace increases."""
    measured = gauge.measured
    return measured is not None and float(np.median(np.diff(np.unwrap(measured.angle)))) > 0.0


def _behind(seen: SeenStrain, of: Possible, lag: float, *, delayed: bool) -> tuple[Array, Array]:
    """The computed strain behind a low pass, with its delay or without."""
    kind = cast("Kind", of.called)
    angle, strain = (
        filtered_higher(seen.angle, seen.strain, lag, kind, of.order) if kind else
        filtered(seen.angle, seen.strain, lag)
    )  # fmt: skip
    return (angle if delayed else angle - delay(kind, of.order) * lag), strain


def _averaged(found: FittedCurve) -> tuple[Array, Array, float]:
    """Means of the samples about even places, less the fitted offset, and their standard error."""
    low, high = float(found.angle.min()), float(found.angle.max())
    cell = np.minimum((_PLACES * (found.angle - low) / (high - low)).astype(int), _PLACES - 1)
    count = np.bincount(cell, minlength=_PLACES)
    some = count > 0
    places, values = (np.bincount(cell, of, _PLACES)[some] / count[some] for of in (found.angle, found.as_measured))
    return places, values, found.noise * abs(found.scale) / math.sqrt(float(count[some].mean()))
