"""Stage ``dynamic-strain``: strain under a gauge in a root fillet in the vibrating train, and what was measured."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from fegear.base.effects import RootEffects
from fegear.base.errors import InputError
from fegear.case.built.gauges import Gauge, check_plane_gauge, gauge_of
from fegear.case.built.odd_gears import odd_gears_of
from fegear.case.built.train import train_part
from fegear.engine.citation import Citation
from fegear.engine.figure.items import Mark
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Every, Off, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.engine.stage import Forecast, Stage, Task, Upstream, Work
from fegear.results import forecasts
from fegear.results.forecasts import ROOT_STRESS_CITATIONS
from fegear.results.gear.solved_gear import needs_solution, solution_of
from fegear.results.pair.gauge_data import thinned, verdict
from fegear.results.pair.placed_gauge import (
    MEASURED,
    RESIDUAL,
    compared,
    comparison_table,
    comparison_values,
    gauges_on,
    placed_gauge,
)
from fegear.results.train.gear_train import ORDINARY_ROOTS, RPM, needs_one_speed, own_meshes

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.contact.fitted_curve import FittedCurve
    from fegear.dynamics.train.tooth_strain import ToothStrain
    from fegear.results.train.tooth_force import ToothForceData

#: Seconds of the forces on a tooth and on those around it.
_SECONDS = 0.3


@dataclass(frozen=True)
class DynamicStrainInputs:
    """What the strain in motion depends on besides the train and its gears.

    Parameters
    ----------
    gauge : Gauge
    mesh : str
    speed : float
        Of the body that speeds refer to [rad/s].
    positions : int
    coupled : bool
        Whether the forces on the teeth around count.
    effects : RootEffects
    name : str
    odd : bool
        Whether some of the teeth differ from the others.
    """

    gauge: Gauge
    mesh: str
    speed: float
    positions: int
    coupled: bool
    effects: RootEffects
    name: str = field(compare=False)
    odd: bool = field(default=False, compare=False)


@dataclass(frozen=True)
class DynamicStrain:
    """Strain of a gauge in motion, and what it measured.

    Parameters
    ----------
    found : ToothStrain
    alone : bool
        Whether nothing but the own mesh excites the train.
    load_tolerance : float
    compared : FittedCurve or None
    """

    found: ToothStrain
    alone: bool
    load_tolerance: float
    compared: FittedCurve | None

    @property
    def drawn(self) -> FittedCurve | None:
        """The comparison by as many samples as a figure can show."""
        return None if self.compared is None else thinned(self.compared)

    @property
    def error(self) -> Array | None:
        """Estimated, shape (P,); None where it is not known."""
        return None if self.found.peak_error is None else self.found.error

    @property
    def others(self) -> bool:
        """Whether other meshes, or fluctuating torques, excite the train."""
        return not self.alone

    @property
    def verdict(self) -> str:
        """Measured against computed strain; empty where nothing was measured."""
        if self.compared is None:
            return ""
        found = self.found
        return verdict(
            self.compared, found.peak, found.change_by_placement, found.peak_error or 0.0, self.load_tolerance
        )


def _mesh(scene: Scene, name: str) -> str:
    """Mesh of the train that loads a gauge."""
    pair = gauge_of(scene, name).pair
    part = train_part(scene)
    for mesh in own_meshes(scene):
        if part.pair_of(mesh) == pair:
            return mesh
    raise InputError(
        f"gauge.{name}.pair", f'"{pair}"', "is not a mesh of the train with solved teeth",
        "add the mesh to [train] or remove dynamic-strain from results",
    )  # fmt: skip


def _check(scene: Scene, name: str) -> None:
    _mesh(scene, name)
    needs_one_speed(scene, name)
    check_plane_gauge(scene, name)


def _needs(scene: Scene, name: str) -> tuple[Task, ...]:
    return (Task("tooth-force", _mesh(scene, name)), *needs_solution(gauge_of(scene, name).gear))


def _inputs(scene: Scene, name: str) -> DynamicStrainInputs:
    part = scene.case.dynamics
    return DynamicStrainInputs(
        gauge_of(scene, name), _mesh(scene, name), part.one_speed, part.positions,
        scene.case.effects.neighbour_coupling, RootEffects.of(scene.case.effects), name,
        bool(odd_gears_of(scene, gauge_of(scene, name).pair)),
    )  # fmt: skip


def _compute(asked: DynamicStrainInputs, upstream: Upstream, _work: Work) -> DynamicStrain:
    from fegear.dynamics.train.tooth_strain import tooth_strain

    force: ToothForceData = upstream[Task("tooth-force", asked.mesh)]
    gauge, mesh = asked.gauge, force.train.meshes[force.mesh]
    solved = solution_of(upstream, gauge.gear)
    place = placed_gauge(gauge, solved)
    gauges = gauges_on(gauge, place, solved)[0]
    number = gauge.tooth if mesh.error.pitches > 1 else 0
    found = tooth_strain(
        force.train, force.mesh, mesh.role(gauge.member), gauges, place.displacement, asked.speed,
        asked.positions, force.harmonics, number, coupled=asked.coupled, effects=asked.effects,
    )  # fmt: skip
    alone = len(force.train.exciters) == 1
    return DynamicStrain(found, alone, gauge.load_tolerance, compared(gauge, found.angle, found.total))


_SHEET = Sheet(
    tables=(
        Rows(
            "dynamic_strain_{name}", "Dynamic strain of gauge {name} over the rotation of the gear",
            (Every("strain"), Off("total", "error", name="strain")), of="found",
        ),
        comparison_table("dynamic_measured_{name}", "Measured and dynamic strain of gauge {name}"),
    ),
    values=(
        Number("peak", "found.peak_error", of="found"),
        Number("peak_angle", of="found"),
        Number("ratio", of="found"),
        Number("change_by_placement", of="found"),
        *comparison_values("dynamic_"),
    ),
    figures=(
        Chart(
            "dynamic_strain_{name}", "Dynamic strain of gauge {name}",
            "Gauge {name}: mean strain under the grid over the rotation of the gear, with and without vibration; its "
            "tooth in contact at the pitch point at zero.",
            (
                Over(
                    "angle",
                    (
                        MEASURED,
                        Line("own", "static and own increment", look={"markers": False}),
                        Line("total", "with other meshes", "with other meshes", look={"width": 1.2}, when="others"),
                        Line("static", "quasi-static", "static"),
                    ),
                    "total",
                    marks=lambda _seen: (Mark("y", 0.0),),
                ),
                RESIDUAL,
            ),
            of="found", under=lambda seen: f"{seen.asked.speed * RPM:.6g} rpm",
        ),
    ),
    remarks=(
        Remark(ORDINARY_ROOTS, when=lambda seen: seen.asked.odd),
        Remark(lambda seen: f"Gauge {seen.name}, in motion: {seen.data.verdict}.", when="compared"),
    ),
    sharper_by="",
)  # fmt: skip


def _cites(_scene: Scene, _name: str) -> Iterator[Citation]:
    yield Citation("mark", "root stress of a single tooth in motion", "Eq. 3.37")
    yield from ROOT_STRESS_CITATIONS["fe"]


def _forecast(_scene: Scene, _name: str) -> Forecast:
    return forecasts.constant(_SECONDS)


DYNAMIC_STRAIN = Stage(
    subjects=lambda scene: tuple(scene.case.gauge),
    needs=_needs,
    inputs=_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=_check,
    cites=_cites,
    forecast=_forecast,
)
