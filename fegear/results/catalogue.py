"""The stages that fegear knows, in the order in which plans list them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.results import (
    crosscheck,
    design_chart,
    dynamic_factor,
    dynamic_root_stress,
    gear_solution,
    gear_train,
    geometry,
    load_sharing,
    loaded_pair,
    mesh_force_spectrum,
    motion,
    relief,
    relief_chart,
    root_stress,
    root_stress_history,
    root_stress_study,
    stiffness,
    tooth_contact,
    tooth_force,
    tooth_geometry_check,
    train_response,
    transmissibility,
    transmission_error,
)

if TYPE_CHECKING:
    from fegear.engine.stage import Stage

#: Every stage, in the order in which plans list those that they skip.
STAGES: tuple[Stage, ...] = (
    geometry.GEOMETRY,
    tooth_geometry_check.TOOTH_GEOMETRY_CHECK,
    gear_solution.GEAR_SOLUTION,
    stiffness.STIFFNESS,
    root_stress.ROOT_STRESS,
    crosscheck.CROSSCHECK,
    root_stress_study.ROOT_STRESS_STUDY,
    loaded_pair.LOADED_PAIR,
    load_sharing.LOAD_SHARING,
    transmission_error.TRANSMISSION_ERROR,
    root_stress_history.ROOT_STRESS_HISTORY,
    relief.RELIEF,
    relief_chart.RELIEF_CHART,
    relief_chart.ROBUSTNESS,
    tooth_contact.TOOTH_CONTACT,
    gear_train.GEAR_TRAIN,
    train_response.NATURAL_MODES,
    train_response.DYNAMIC_INCREMENTS,
    mesh_force_spectrum.MESH_FORCE_SPECTRUM,
    tooth_force.TOOTH_FORCE,
    dynamic_root_stress.DYNAMIC_ROOT_STRESS,
    motion.MOTION,
    dynamic_factor.DYNAMIC_FACTOR,
    design_chart.DESIGN_CHART,
    transmissibility.TRANSMISSIBILITY,
)
