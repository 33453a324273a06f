"""Stage ``gauge``: strain under a gauge in a root fillet over the rotation of its gear, and what was measured."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.effects import PLANE_EFFECTS
from fegear.base.errors import InputError
from fegear.case.built.gauges import Gauge, check_gauge, gauge_of, place_gauge
from fegear.case.built.pair_checks import check_relief
from fegear.contact.fitted_curve import FITTED, NothingToCompareError, fit_curve
from fegear.engine.citation import Citation
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number, exact
from fegear.engine.sheet.rows import Cell, Every, EveryLoad, Off, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.results import forecasts
from fegear.results.forecasts import ROOT_STRESS_CITATIONS
from fegear.results.gear.solved_gear import needs_solution, solution_of
from fegear.results.pair.gauge_data import GaugeData, GaugePlace
from fegear.results.pair.loaded_teeth import OVER_LOADS, loaded_pair

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.reading import Scene
    from fegear.contact.fitted_curve import Fitted, FittedCurve
    from fegear.contact.plane.gauge_history import GaugeHistory
    from fegear.fem.plane.gear import GearInfluence

#: Places to either side of the grid's at which the peak is computed.
_PLACES = 10
#: Seconds of both fillets over the path.
_SECONDS = 0.4


@dataclass(frozen=True)
class GaugeInputs:
    """What this stage reads: the gauge, the speed of its gear [rad/s], and whether errors are estimated."""

    gauge: Gauge
    speed: float | None
    estimates: bool
    name: str = field(compare=False)


def _inputs(scene: Scene, name: str) -> GaugeInputs:
    gauge = gauge_of(scene, name)
    speed, pair = scene.case.pair[gauge.pair].speed, scene.pairs[gauge.pair]
    if speed is not None and gauge.member == "driven":
        speed /= pair.ratio
    return GaugeInputs(gauge, speed, scene.estimates, name)


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    gauge = gauge_of(scene, name)
    return (Task("loaded-pair", gauge.pair), *needs_solution(gauge.gear))


def _compute(asked: GaugeInputs, upstream: Upstream, _work: Work) -> GaugeData:
    from fegear.contact.plane.gauge_history import gauge_history
    from fegear.fem.plane.gauge import FilletProfile, GaugesOnFillet

    gauge = asked.gauge
    teeth, solved = loaded_pair(upstream, gauge.pair), solution_of(upstream, gauge.gear)
    profile = FilletProfile.of_mesh(solved.fine.fillets[gauge.side], solved.gear)
    middle, length, half = place_gauge(gauge, profile), float(profile.arc[-1]), gauge.grid.half
    low, high = max(-gauge.placement, half - middle), min(gauge.placement, length - half - middle)
    low, high = min(low, 0.0), max(high, 0.0)
    displacement = np.unique(np.concatenate([np.linspace(low, 0.0, _PLACES + 1), np.linspace(0.0, high, _PLACES + 1)]))
    gauges = GaugesOnFillet(solved, gauge.side, gauge.grid, middle + displacement)
    opposite = GaugesOnFillet(
        solved, "compression" if gauge.side == "tension" else "tension", gauge.grid, np.array([middle])
    )
    history = gauge_history(
        teeth.engagement, teeth.shifted, teeth.loads, teeth.nominal, gauge.member, gauges, opposite, displacement,
        gauge.tooth, estimates=asked.estimates,
    )  # fmt: skip
    at, place = teeth.loads.index(teeth.nominal), profile.at(middle)
    return GaugeData(
        teeth.loads, at, history,
        GaugePlace(middle, 2.0 * place["radius"], place["tangent_angle"], place["centre_angle"]),
        _clearance(asked, history, solved, length - half - middle),
        high - low < 2.0 * gauge.placement * (1.0 - 1e-9),
        gauge.load_tolerance, asked.speed, _compared(asked, history, at),
    )  # fmt: skip


def _clearance(asked: GaugeInputs, history: GaugeHistory, solved: GearInfluence, above: float) -> float:
    """From the end of the grid up to the lowest contact on the flank above it, along the profile [modules]."""
    if asked.gauge.side == "compression":
        return float("inf")
    pair, flank, module = history.pair, solved.fine.flank, solved.gear.module
    ends = pair.radius(np.array([pair.x_start, pair.x_end]), asked.gauge.member) / module
    return float(np.min(flank.arc_of_radius(ends)) - flank.flank_start) + above / module


def _compared(asked: GaugeInputs, history: GaugeHistory, at: int) -> FittedCurve | None:
    measured = asked.gauge.measured
    if measured is None:
        return None
    try:
        return fit_curve(measured.angle, measured.strain, history.angle, history.strain[:, at], measured.fit)
    except NothingToCompareError:
        ends = np.rad2deg(history.angle[[0, -1]])
        raise InputError(
            f"gauge.{asked.name}.measured.file", f'"{measured.file}"',
            f"has too few samples within the computed engagement, {ends[0]:.4g} to {ends[1]:.4g} deg",
            "check the unit of the angle" if "shift" in measured.fit else 'set fit = ["shift"]',
        ) from None  # fmt: skip


def _fitted(name: Fitted) -> Each:
    """A fitted number and its standard error, where it was fitted."""
    return Each(
        lambda seen: [seen.data.compared], Number(name), Number(f"{name}_error"),
        when=lambda seen: seen.one is not None and name in seen.one.fit,
    )  # fmt: skip


#: Looks of curves and of samples.
_DASHED, _DOTS = {"dash": "dash", "width": 1.0}, {"size": 3.0, "symbol": "circle"}
_ERROR = Off("strain", "history.strain_error")
_SHEET = Sheet(
    loads="loads",
    nominal="at",
    tables=(
        Rows(
            "gauge_{name}", "Strain of gauge {name} over the rotation of the gear, {load:.6g} N",
            (Cell("t", of=lambda seen: seen.data), Every("gauge"), "stress", _ERROR), of="history",
        ),
        EveryLoad(
            "gauge_loads_{name}", "Strain of gauge {name} for every load", (Every("gauge"),), "history", OVER_LOADS
        ),
        Rows(
            "gauge_places_{name}", "Peak strain of gauge {name} over the place of the grid",
            ("displacement", "peak"), of="places",
        ),
        Rows(
            "gauge_measured_{name}", "Measured and computed strain of gauge {name}",
            ("angle", "measured", "computed", "residual"), of="compared",
        ),
    ),
    values=(
        Number("peak_strain", "peak_error"),
        Number("peak_stress", "peak_stress_error"),
        Number("strain_range"),
        Number("peak_angle"),
        Number("peak_x"),
        Number("peak_strain_opposite"),
        Number("fillet_ratio"),
        Number("peak_change_by_placement"),
        Number("arc", exact, of="place"),
        Number("diameter", exact, of="place"),
        Number("tangent_angle", exact, of="place"),
        Number("centre_angle", exact, of="place"),
        *map(_fitted, FITTED),
        Number("gain", of="compared"),
        Number("gain_error", of="compared"),
        Number("rms", of="compared"),
        Number("correlation", of="compared"),
        Number("samples", exact, of="compared"),
    ),
    figures=(
        Chart(
            "gauge_{name}", "Strain of gauge {name}",
            "Gauge {name}: mean strain under the grid over the rotation of the gear, its tooth in contact at the pitch "
            "point at zero; dashed: grid displaced by the placement tolerance.",
            (
                Over(
                    "angle",
                    (
                        Line(
                            "measured", "measured", "series:1", of="drawn", kind="points",
                            look=_DOTS,
                        ),
                        Line("strain", "computed", error="history.strain_error", look={"markers": False}),
                        Line("strain_towards_root", "grid towards the root", "grey", look=_DASHED),
                        Line("strain_towards_tip", "grid towards the tip", "grey", look=_DASHED),
                        Line("strain_opposite", "opposite fillet", "series:2", look={"width": 1.2}),
                    ),
                    "strain",
                    marks=lambda _seen: (Mark("y", 0.0),),
                ),
                Over(
                    "angle",
                    (
                        Line(
                            "residual", "measured less computed", "series:1", kind="points",
                            look=_DOTS,
                        ),
                    ),
                    of="drawn",
                    marks=lambda _seen: (Mark("y", 0.0),), when="compared",
                ),
            ),
            of="history", under="{load:.5g} N",
        ),
        Chart(
            "gauge_places_{name}", "Peak strain over the place of gauge {name}",
            "Gauge {name}: peak strain with the grid displaced along the fillet within the placement tolerance.",
            (Over("displacement", (Line("peak"),), marks=lambda _seen: (Mark("x", 0.0),)),),
            of="places", under="{load:.5g} N",
        ),
    ),
    remarks=(
        Remark(lambda seen: f"Gauge {seen.name}: {seen.data.verdict}.", when="compared"),
        Remark(
            lambda seen: f"Gauge {seen.name}: the contact comes within {seen.data.clearance:.2f} modules of the grid; "
            "strain at the lowest contact is not resolved; move the gauge towards the root.",
            when="near_contact",
        ),
        Remark(
            lambda seen: f"Gauge {seen.name}: placement_tolerance reaches beyond the fillet; displacements from "
            f"{seen.data.history.displacement[0] * 1e3:.3g} to {seen.data.history.displacement[-1] * 1e3:.3g} mm only.",
            when="clipped",
        ),
    ),
    sharper_by="",
)  # fmt: skip


def _check(scene: Scene, name: str) -> None:
    check_gauge(scene, name)
    check_relief(scene, gauge_of(scene, name).pair)


def _cites(_scene: Scene, _name: str) -> Iterator[Citation]:
    yield from ROOT_STRESS_CITATIONS["fe"]
    yield Citation("iso-6336-3", "30 degree tangent (internal gears: 60 degree)", "clause 6")


def _forecast(scene: Scene, name: str) -> Forecast:
    """Both fillets over the path, and once more for each error of a compliance."""
    pair = gauge_of(scene, name).pair
    return forecasts.constant(_SECONDS * (0.5 + 0.25 * forecasts.engagements(scene, pair)))


GAUGE = Stage(
    subjects=lambda scene: tuple(scene.case.gauge),
    every_load=True,
    answers=("root tension",),
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=_cites,
    forecast=_forecast,
    effects_of=lambda _scene, _name: PLANE_EFFECTS,
)
