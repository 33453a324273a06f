"""Which pictures belong to which stage's results."""

from __future__ import annotations

from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.engine.figure import DeferredFigure
from fegear.engine.stage import Task
from fegear.errors import MissingLibraryError
from fegear.fem.mesh_files import write_mesh_file
from fegear.output.draw_png import draw_pictures

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

    from fegear.engine.figure import Figure, MeshField
    from fegear.engine.run import Results
    from fegear.fem import StiffnessTable
    from fegear.output.pictures.style import Picture
    from fegear.results.crosscheck import CrosscheckData
    from fegear.results.design_chart import DesignChartData
    from fegear.results.dynamic_factor import DynamicFactorData
    from fegear.results.dynamic_root_stress import DynamicRootStress
    from fegear.results.load_sharing import LoadSharingData
    from fegear.results.mesh_force_spectrum import SpectrumData
    from fegear.results.root_stress_history import RootStressData
    from fegear.results.stiffness import FilletCurves
    from fegear.results.tooth_contact import ToothContactData
    from fegear.results.tooth_force import ToothForceData
    from fegear.results.train_response import IncrementsData, ModesData
    from fegear.results.transmissibility import TransmissibilityData
    from fegear.results.transmission_error import TransmissionErrorData

#: Line load of the deformed gear's picture when the case names none [N/m].
_USUAL_LINE_LOAD = 100e3


def _stiffness(results: Results, task: Task, folder: Path) -> Iterator[Picture]:
    from fegear.output.pictures.stiffness import draw_compliance, draw_root_stress
    from fegear.output.pictures.tooth import draw_tooth

    outcome, name = results.outcomes[task], task.subject
    data, gear = cast("StiffnessTable", outcome.data), results.scene.gears[name]
    yield draw_tooth(gear, data.influence.fine.mesh, folder / f"tooth_{name}.png", name)
    yield draw_compliance(gear, outcome.tables[0], folder / f"compliance_{name}.png", name)
    yield draw_root_stress(gear, outcome.tables[0], folder / f"root_stress_{name}.png", name)


def _root_stress(results: Results, task: Task, folder: Path) -> Iterator[Picture]:
    from fegear.fem.loaded_gear import loaded_gear, nodal_fields
    from fegear.fem.mesh import GENERATED
    from fegear.fem.mesh_files import write_mesh_file
    from fegear.output.pictures.deformed import draw_deformed
    from fegear.output.pictures.stiffness import draw_fillet

    outcome, name = results.outcomes[task], task.subject
    yield draw_fillet(outcome.tables[0], cast("FilletCurves", outcome.data).radius, folder / f"fillet_{name}.png", name)
    gear, data = results.scene.gears[name], cast("StiffnessTable", results.outcomes[Task("stiffness", name)].data)
    mesh = data.influence.fine.mesh
    whole, field = loaded_gear(gear, data.influence.settings, None if mesh.origin == GENERATED else mesh)
    line_load = results.scene.case.stiffness.load or _USUAL_LINE_LOAD
    fields = nodal_fields(gear, whole, field, line_load)
    vtu = folder.parent / "fields" / f"{name}.vtu"
    vtu.parent.mkdir(exist_ok=True)
    write_mesh_file(vtu, whole.points * gear.module * 1e3, whole.triangles, {}, fields)
    yield draw_deformed(gear, whole, fields, folder / f"deformed_{name}.png", name, line_load)


def _tooth_contact(results: Results, task: Task, folder: Path) -> Iterator[Picture]:
    from fegear.output.pictures.helical import draw_bearing, draw_contact_pattern, draw_flanks, draw_transmission_error

    name, data = task.subject, cast("ToothContactData", results.outcomes[task].data)
    yield draw_transmission_error(data.contact, folder / f"transmission_error_{name}.png", name)
    yield draw_contact_pattern(data.contact, folder / f"contact_pattern_{name}.png", name, data.bearing)
    load = results.scene.case.tooth_contact.load
    if data.bearing is not None and load is not None:
        yield draw_bearing(data.contact, data.bearing, folder / f"contact_ellipses_{name}.png", name, load)
    yield draw_flanks(data.contact, folder / f"flanks_{name}.png", name)


def _transmissibility(results: Results, task: Task, folder: Path) -> Iterator[Picture]:
    from fegear.output.pictures.transmissibility import draw_modes, draw_transmissibility

    name, data = task.subject, cast("TransmissibilityData", results.outcomes[task].data)
    yield draw_modes(data.modes, folder / f"helical_modes_{name}.png", name)
    yield draw_transmissibility(data.response, data.mesh, folder / f"transmissibility_{name}.png", name)


def _crosscheck(results: Results, task: Task, folder: Path) -> Iterator[Picture]:
    from fegear.output.pictures.crosscheck import draw_compliance_check, draw_root_stress_check

    outcome = results.outcomes[task]
    tables, data = {table.name: table for table in outcome.tables}, cast("CrosscheckData", outcome.data)
    for name in data.gears:
        root = tables[f"crosscheck_root_stress_{name}"]
        yield draw_root_stress_check(root, folder / f"crosscheck_root_stress_{name}.png", name)
    for name in (*data.gears, *data.pairs):
        table = tables[f"crosscheck_compliance_{name}"]
        yield draw_compliance_check(table, folder / f"crosscheck_compliance_{name}.png")


def _root_stress_study(results: Results, task: Task, folder: Path) -> Iterator[Picture]:
    from fegear.output.pictures.root_stress_study import draw_root_stress_study

    yield draw_root_stress_study(results.outcomes[task].tables[0], folder / "root_stress_study.png")


def _gear_names(results: Results, name: str) -> dict[str, str]:
    part = results.scene.case.pair[name]
    return {"driver": part.driver, "driven": part.driven}


def _load_sharing(results: Results, task: Task, folder: Path) -> Iterator[Picture]:
    from fegear.output.pictures.loaded_teeth import draw_load_sharing

    data = cast("LoadSharingData", results.outcomes[task].data)
    yield draw_load_sharing(data, folder / f"load_sharing_{task.subject}.png", task.subject)


def _transmission_error(results: Results, task: Task, folder: Path) -> Iterator[Picture]:
    from fegear.output.pictures.loaded_teeth import draw_harmonics, draw_te

    data, name = cast("TransmissionErrorData", results.outcomes[task].data), task.subject
    yield draw_te(data, folder / f"transmission_error_{name}.png", name)
    yield draw_harmonics(data, folder / f"transmission_error_harmonics_{name}.png", name)


def _root_stress_history(results: Results, task: Task, folder: Path) -> Iterator[Picture]:
    from fegear.output.pictures.loaded_teeth import draw_root_stress

    data, name = cast("RootStressData", results.outcomes[task].data), task.subject
    yield draw_root_stress(data, folder / f"root_stress_history_{name}.png", name, _gear_names(results, name))


def _natural_modes(results: Results, task: Task, folder: Path) -> Iterator[Picture]:
    from fegear.output.pictures.dynamics import draw_campbell, draw_modes

    outcome = results.outcomes[task]
    data = cast("ModesData", outcome.data)
    if data.modes.frequencies.size > 1:
        yield draw_modes(outcome.tables[0], folder / "natural_modes.png")
        if data.campbell is not None and data.campbell.speeds.size > 1:
            yield draw_campbell(data, folder / "campbell.png")


def _dynamic_increments(results: Results, task: Task, folder: Path) -> Iterator[Picture]:
    from fegear.output.pictures.dynamics import draw_increments

    yield draw_increments(cast("IncrementsData", results.outcomes[task].data), folder / "dynamic_increments.png")


def _mesh_force_spectrum(results: Results, task: Task, folder: Path) -> Iterator[Picture]:
    from fegear.output.pictures.dynamics import draw_spectrum, draw_waterfall

    name, data = task.subject, cast("SpectrumData", results.outcomes[task].data)
    yield draw_spectrum(data, folder / f"mesh_force_spectrum_{name}.png")
    if data.waterfall is not None:
        yield draw_waterfall(data, folder / f"mesh_force_waterfall_{name}.png")


def _tooth_force(results: Results, task: Task, folder: Path) -> Iterator[Picture]:
    from fegear.output.pictures.dynamics import draw_tooth_force

    yield draw_tooth_force(
        cast("ToothForceData", results.outcomes[task].data), folder / f"tooth_force_{task.subject}.png"
    )


def _dynamic_root_stress(results: Results, task: Task, folder: Path) -> Iterator[Picture]:
    from fegear.output.pictures.dynamics import draw_root_stress

    data = cast("DynamicRootStress", results.outcomes[task].data)
    yield draw_root_stress(data, folder / f"dynamic_root_stress_{task.subject}.png")


def _dynamic_factor(results: Results, task: Task, folder: Path) -> Iterator[Picture]:
    from fegear.output.pictures.dynamics import draw_dynamic_factor

    data = cast("DynamicFactorData | None", results.outcomes[task].data)
    if data is not None and data.chart.speeds.size > 1:
        yield draw_dynamic_factor(data, folder / f"dynamic_factor_{task.subject}.png", task.subject)


def _design_chart(results: Results, task: Task, folder: Path) -> Iterator[Picture]:
    from fegear.output.pictures.dynamics import draw_design_chart

    data = cast("DesignChartData", results.outcomes[task].data)
    if data.lengths.size > 1:
        yield draw_design_chart(data, folder / "design_chart.png")


#: For each stage that has pictures, what draws them; others follow the same shape.
DRAWERS: dict[str, Callable[[Results, Task, Path], Iterator[Picture]]] = {
    "stiffness": _stiffness,
    "root-stress": _root_stress,
    "crosscheck": _crosscheck,
    "root-stress-study": _root_stress_study,
    "load-sharing": _load_sharing,
    "transmission-error": _transmission_error,
    "root-stress-history": _root_stress_history,
    "tooth-contact": _tooth_contact,
    "transmissibility": _transmissibility,
    "natural-modes": _natural_modes,
    "dynamic-increments": _dynamic_increments,
    "mesh-force-spectrum": _mesh_force_spectrum,
    "tooth-force": _tooth_force,
    "dynamic-root-stress": _dynamic_root_stress,
    "dynamic-factor": _dynamic_factor,
    "design-chart": _design_chart,
}


def draw_figure(figure: Figure | DeferredFigure, folder: Path) -> Iterator[Picture]:
    """Draw one figure, describing it first where that was put off."""
    made = figure.make() if isinstance(figure, DeferredFigure) else figure
    if made.field is not None:
        write_field(made.field, folder.parent / "fields")
    yield from draw_pictures(made, folder)


def write_field(field: MeshField, folder: Path) -> None:
    """Write ``<name>.vtu`` for ParaView."""
    folder.mkdir(exist_ok=True)
    write_mesh_file(folder / f"{field.name}.vtu", np.asarray(field.points), field.triangles, {}, field.values)


def draw_all(
    results: Results, folder: Path, advance: Callable[[float], None]
) -> tuple[list[tuple[Task, Picture]], list[str]]:
    """Draw every picture of a run.

    Parameters
    ----------
    results : Results
    folder : Path
        Made if needed.
    advance : callable
        Told the fraction done.

    Returns
    -------
    pictures : list of (Task, Picture)
        Each with the task whose results it shows.
    missing : list of str
        Sentences about pictures that could not be drawn for want of a system library.
    """
    folder.mkdir(exist_ok=True)
    pictures: list[tuple[Task, Picture]] = []
    missing: list[str] = []
    tasks = [task for task, outcome in results.outcomes.items() if outcome.figures or task.stage in DRAWERS]
    for number, task in enumerate(tasks, start=1):
        try:
            if results.outcomes[task].figures:
                pictures += ((task, p) for f in results.outcomes[task].figures for p in draw_figure(f, folder))
            else:
                pictures += ((task, picture) for picture in DRAWERS[task.stage](results, task, folder))
        except MissingLibraryError as error:
            missing.append(f"{error}".rstrip(".") + ".")
        advance(number / len(tasks))
    return pictures, missing
