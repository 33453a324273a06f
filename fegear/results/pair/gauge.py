"""Stage ``gauge``: strain under a gauge in a root fillet over the rotation of its gear, and what was measured."""

from __future__ import annotations

from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.printed import figures
from fegear.case.built.gauges import Gauge, check_gauge, gauge_of, seconds_of_bridges, sharper_strain
from fegear.case.built.neglected_effects import including
from fegear.engine.citation import Citation
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.results import forecasts
from fegear.results.forecasts import ROOT_STRESS_CITATIONS
from fegear.results.pair.causes_of_strain import PlaneStrain, SeenStrain, causes_of_strain
from fegear.results.pair.followed_gauge import gauge_in_plane, gauge_on_face
from fegear.results.pair.gauge_data import GaugeData, GaugeInputs
from fegear.results.pair.gauge_otherwise import Otherwise
from fegear.results.pair.gauge_sheet import GAUGE_SHEET
from fegear.results.pair.half_bridge import HalfBridge
from fegear.results.pair.likeliest_flank import LikeliestFlank
from fegear.results.pair.loaded_teeth import check_teeth, kind_of, loaded_teeth, needs_teeth
from fegear.results.pair.placed_gauge import better_described, compared
from fegear.results.pair.trace_levels import over_torque

if TYPE_CHECKING:
    from collections.abc import Iterator, Sequence

    from fegear.case.reading import Scene
    from fegear.contact.fitted_curve import FittedCurve
    from fegear.contact.gauge_strain import GaugeHistory, StrainWith

#: Seconds of both fillets over the path.
_SECONDS = 0.4
#: Part of the time after which the gauge is followed, and causes are sought.
_FOLLOWED = 0.2
#: Of 3D gears, for each load: both fillets of both solutions.
_SECONDS_WIDE = 0.5


def _inputs(scene: Scene, name: str) -> GaugeInputs:
    gauge = gauge_of(scene, name)
    speed, pair = scene.case.pair[gauge.pair].speed, scene.pairs[gauge.pair]
    if speed is not None and gauge.member == "driven":
        speed /= pair.ratio
    in_bridge = name in seconds_of_bridges(scene)
    wide, sharper = gauge.pair in scene.wide_pairs, sharper_strain(scene, gauge.pair)
    finer = sharper
    if wide and scene.width_of(gauge.pair) != "slices":
        finer = f"increase load_distribution.positions ({scene.case.load_distribution.positions})"
    return GaugeInputs(
        gauge, speed, scene.estimates, wide, sharper, name, finer, scene.case.accuracy.tolerance, scene.case.effects,
        scene.case.pair[gauge.pair].halves,
        scene.sizes_neglected or (scene.estimates and (gauge.measured is not None or in_bridge)),  # for the verdict
        in_bridge,
    )  # fmt: skip


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    gauge = gauge_of(scene, name)
    second = (Task("gauge", gauge.second),) if gauge.second else ()
    return (*needs_teeth(scene, gauge.pair), *kind_of(scene, gauge.pair).solutions(gauge.gear), *second)


def _compute(asked: GaugeInputs, upstream: Upstream, work: Work) -> GaugeData:
    gauge, teeth = asked.gauge, loaded_teeth(upstream, asked.gauge.pair)
    followed = (
        gauge_on_face(gauge, upstream, neglected=asked.neglected) if asked.wide else
        gauge_in_plane(gauge, upstream, estimates=asked.estimates, neglected=asked.neglected)
    )  # fmt: skip
    at, bridge = teeth.loads.index(teeth.nominal), None
    if gauge.second:
        other: GaugeData = upstream[Task("gauge", gauge.second)]
        bridge = HalfBridge.of(gauge.second, followed.history, other.history, at, followed.more, other.with_effects)
    history = bridge.history if bridge else followed.history
    strain = history.strain[:, at]
    speed = gauge.trace_speed or asked.speed
    found = compared(gauge, history.angle, strain, speed)
    opposite, pair = None if bridge else history.strain_opposite[:, at], history.pair
    better = better_described(gauge, found, pair, history.angle, strain, opposite)
    neglected, of_trace = (
        {effect: one for effect, one in more.items() if abs(one.change) > asked.tolerance}
        for more in (followed.more, bridge.with_effects if bridge else followed.more)
    )
    levels = over_torque(gauge, found, history, teeth.loads, at)
    torques = {} if levels else _torques(history, teeth.loads, at, asked.halves)  # a measured torque is known
    data = GaugeData(
        teeth.loads, at, followed.history, followed.place.place, followed.clearance, followed.place.clipped,
        gauge.load_tolerance, asked.speed, found,
        Otherwise(
            better, gauge.side, pair.gear(gauge.member).teeth, torques, gauge.second,
            0.0 if bridge else _other_fillet(history, at, free=found is not None and "offset" in found.fit),
            None, speed, pair.mate(gauge.member).teeth, gauge.over_time,
        ),
        gauge.measured.reading if gauge.measured else "", asked.estimates, asked.sharper,
        levels, {effect: one.change for effect, one in neglected.items()},
        including(dict.fromkeys([*neglected, *of_trace]), asked.effects), _gains(gauge, found, of_trace), bridge,
        followed.more if asked.in_bridge else {},
    )  # fmt: skip
    work.progress(_FOLLOWED)
    ranked, explained = _ranked(asked, data, upstream, work)
    return replace(data, otherwise=replace(data.otherwise, ranked=ranked, explained=explained))


def _ranked(
    asked: GaugeInputs, data: GaugeData, upstream: Upstream, work: Work
) -> tuple[LikeliestFlank | None, FittedCurve | None]:  # fmt: skip
    """What explains the trace of a gauge that is described as it is, and the trace over the curve with that."""
    found, gauge, otherwise = data.compared, asked.gauge, data.otherwise
    if found is None or not asked.estimates or otherwise.better or found.gain <= 0.0:
        return None, None
    history, at, load = data.traced, data.at, data.loads[data.at]
    of_strain = history.angle, history.strain[:, at], history.displacement, history.displaced[:, at]
    seen = (
        SeenStrain(*of_strain, None if data.bridge else history.strain_opposite[:, at])
        if asked.wide or gauge.second
        else PlaneStrain(*of_strain, history.strain_opposite[:, at], gauge, upstream, load)
    )
    causes = causes_of_strain(
        gauge, found, seen, data.tolerance, otherwise.teeth,
        lambda part: work.progress(_FOLLOWED + (1.0 - _FOLLOWED) * part),
    )  # fmt: skip
    if not causes.causes:
        return None, None
    torque = load * history.pair.driver.base_radius * asked.halves
    ranked = LikeliestFlank(
        causes, history.pair, (torque,), abs(data.traced_peak), "the peak", otherwise.speed, of_gauge=True
    )
    if causes.best is None or ranked.of_size:
        return ranked, None
    return ranked, compared(gauge, *causes.curves[0], otherwise.speed)


def _other_fillet(history: GaugeHistory, at: int, *, free: bool) -> float:
    """Strain of an equal gauge in the other fillet over that of the gauge, in size, by least squares over the curve.

    Peaks have another ratio: the strain before and after the contact of the tooth has one sign in both fillets.

    Parameters
    ----------
    history : GaugeHistory
    at : int
        Number of the load.
    free : bool
        Whether an offset is fitted.
    """
    rotation = np.linspace(history.angle[0], history.angle[-1], 2 * history.angle.size)  # samples are uniform in it
    own, other = (np.interp(rotation, history.angle, of[:, at]) for of in (history.strain, history.strain_opposite))
    if free:
        own, other = own - own.mean(), other - other.mean()
    return abs(float(own @ other / (own @ own)))


def _gains(gauge: Gauge, found: FittedCurve | None, more: dict[str, StrainWith]) -> dict[str, float]:
    """Relative change of measured / computed strain with each further effect; empty without a trace."""
    if found is None or not found.gain:
        return {}
    fits = {effect: compared(gauge, one.angle, one.strain) for effect, one in more.items()}
    return {effect: one.gain / found.gain - 1.0 for effect, one in fits.items() if one is not None}


def _torques(history: GaugeHistory, loads: Sequence[float], at: int, halves: int) -> dict[str, float]:
    """Peak under each other load of the pair over that under the nominal one, by its torque on the driver."""
    peaks = [float(history.strain[history.peak_position(i), i]) for i in range(len(loads))]
    lever = history.pair.driver.base_radius * halves
    return {f"{figures(loads[i] * lever, 5)} N m": peak / peaks[at] for i, peak in enumerate(peaks) if i != at}


def _check(scene: Scene, name: str) -> None:
    check_gauge(scene, name)
    check_teeth(scene, gauge_of(scene, name).pair)


def _cites(_scene: Scene, _name: str) -> Iterator[Citation]:
    yield from ROOT_STRESS_CITATIONS["fe"]
    yield Citation("iso-6336-3", "30 degree tangent (internal gears: 60 degree)", "clause 6")


def _forecast(scene: Scene, name: str) -> Forecast:
    """Both fillets over the path, and once more for each error of a compliance."""
    pair = gauge_of(scene, name).pair
    if pair in scene.wide_pairs:
        return forecasts.constant(_SECONDS_WIDE * forecasts.loads(scene, pair))
    return forecasts.constant(_SECONDS * (0.5 + 0.25 * forecasts.engagements(scene, pair)))


GAUGE = Stage(
    subjects=lambda scene: tuple(scene.case.gauge),
    every_load=True,
    answers=("root tension",),
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=GAUGE_SHEET.present,
    check=_check,
    cites=_cites,
    forecast=_forecast,
)
