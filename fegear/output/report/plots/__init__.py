"""Which interactive figures belong to which stage's results; each is made of the columns of the stage's tables."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.output.report.plots import gears, helical, loaded_teeth, motion, relief

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from fegear.engine.outcome import Outcome
    from fegear.engine.stage import Task
    from fegear.output.report.figure import Figure

#: For each stage that has curves, what describes them. A figure whose key is the stem of a picture takes its place.
FIGURES: dict[str, Callable[[Outcome, Task], Iterator[Figure]]] = {
    "stiffness": gears.stiffness,
    "root-stress": gears.fillets,
    "crosscheck": gears.crosscheck,
    "root-stress-study": gears.study,
    "load-sharing": loaded_teeth.load_sharing,
    "transmission-error": loaded_teeth.transmission_error,
    "root-stress-history": loaded_teeth.root_stress_history,
    "relief": relief.reliefs,
    "relief-chart": relief.chart,
    "robustness": relief.robustness,
    "tooth-contact": helical.tooth_contact,
    "transmissibility": helical.transmissibility,
    "natural-modes": motion.modes,
    "dynamic-increments": motion.increments,
    "mesh-force-spectrum": motion.spectrum,
    "tooth-force": motion.tooth_force,
    "dynamic-root-stress": motion.root_stress,
    "dynamic-factor": motion.dynamic_factor,
    "design-chart": motion.design_chart,
}


def figures(outcome: Outcome, task: Task) -> list[Figure]:
    """Describe the figures of one task; none for a stage without curves."""
    if outcome.figures:
        return []
    found = FIGURES.get(task.stage)
    return list(found(outcome, task)) if found else []
