"""The stages that fegear knows, by subject."""

from __future__ import annotations

import copyreg
from types import MappingProxyType
from typing import TYPE_CHECKING, Any

from fegear.engine.stage import Stage
from fegear.results import (
    contact_lines,
    contact_pattern,
    crosscheck,
    deformed_in_mesh,
    design_chart,
    dynamic_factor,
    dynamic_increments,
    dynamic_root_stress,
    flank_design,
    flank_generation,
    flank_load_factors,
    flank_load_sharing,
    flank_root_stress,
    flank_stress_in_mesh,
    flank_surface,
    flank_tolerance_robustness,
    flank_transmission_error,
    followed_modes,
    gear_solution,
    gear_train,
    geometry,
    load_distribution,
    load_sharing,
    loaded_flanks,
    loaded_pair,
    loading_spectrum,
    mesh_force_spectrum,
    mesh_stiffness_matrix,
    motion,
    natural_modes,
    pair_forces,
    rating,
    relief,
    relief_chart,
    relief_curves,
    root_stress,
    root_stress_history,
    root_stress_study,
    solid_solution,
    solid_stiffness,
    stiffness,
    stress_in_mesh,
    tolerance_robustness,
    tooth_contact,
    tooth_force,
    tooth_friction,
    tooth_geometry_check,
    tooth_loss,
    train_loss,
    transmissibility,
    transmission_error,
)

if TYPE_CHECKING:
    from collections.abc import Mapping


#: Every stage by the subject of its results, in the order in which plans list those that they skip.
SUBJECTS: Mapping[str, tuple[Stage, ...]] = MappingProxyType(
    {
        "A gear and its teeth": (
            geometry.GEOMETRY,
            tooth_geometry_check.TOOTH_GEOMETRY_CHECK,
            gear_solution.GEAR_SOLUTION,
            stiffness.STIFFNESS,
            solid_solution.SOLID_SOLUTION,
            solid_stiffness.SOLID_STIFFNESS,
            root_stress.ROOT_STRESS,
            crosscheck.CROSSCHECK,
            root_stress_study.ROOT_STRESS_STUDY,
        ),
        "A pair under load": (
            loaded_pair.LOADED_PAIR,
            load_sharing.LOAD_SHARING,
            transmission_error.TRANSMISSION_ERROR,
            root_stress_history.ROOT_STRESS_HISTORY,
            stress_in_mesh.STRESS_IN_MESH,
            deformed_in_mesh.OUTLINE_MOTION,
            deformed_in_mesh.DEFORMED_IN_MESH,
            loaded_flanks.LOADED_FLANKS,
            flank_load_sharing.FLANK_LOAD_SHARING,
            flank_transmission_error.FLANK_TRANSMISSION_ERROR,
            flank_root_stress.FLANK_ROOT_STRESS,
            flank_stress_in_mesh.FLANK_STRESS_IN_MESH,
            load_distribution.LOAD_DISTRIBUTION,
            flank_load_factors.FLANK_LOAD_FACTORS,
            contact_pattern.CONTACT_PATTERN,
            mesh_stiffness_matrix.MESH_STIFFNESS_MATRIX,
            rating.RATING,
            flank_surface.FLANK_SURFACE,
            flank_surface.WIDE_FLANK_SURFACE,
            tooth_loss.TOOTH_LOSS,
            tooth_loss.WIDE_TOOTH_LOSS,
        ),
        "Profile relief": (
            relief.RELIEF,
            relief_curves.RELIEF_CURVES,
            relief_chart.RELIEF_CHART,
            relief_chart.ROBUSTNESS,
            tolerance_robustness.TOLERANCE_ROBUSTNESS,
            flank_tolerance_robustness.FLANK_TOLERANCE_ROBUSTNESS,
            loading_spectrum.LOADING_SPECTRUM,
            flank_design.FLANK_DESIGN,
        ),
        "Helical pairs": (
            tooth_contact.TOOTH_CONTACT,
            contact_lines.CONTACT_LINES,
            flank_generation.FLANK_GENERATION,
            transmissibility.TRANSMISSIBILITY,
            followed_modes.FOLLOWED_MODES,
            pair_forces.PAIR_FORCES,
        ),
        "Gear trains in motion": (
            gear_train.GEAR_TRAIN,
            natural_modes.NATURAL_MODES,
            dynamic_increments.DYNAMIC_INCREMENTS,
            mesh_force_spectrum.MESH_FORCE_SPECTRUM,
            tooth_force.TOOTH_FORCE,
            dynamic_root_stress.DYNAMIC_ROOT_STRESS,
            tooth_friction.TOOTH_FRICTION,
            train_loss.TRAIN_LOSS,
            motion.MOTION,
            dynamic_factor.DYNAMIC_FACTOR,
            design_chart.DESIGN_CHART,
        ),
    }
)

#: Every stage.
STAGES: tuple[Stage, ...] = tuple(stage for stages in SUBJECTS.values() for stage in stages)

_BY_NAME = MappingProxyType({stage.name: stage for stage in STAGES})


def stage_called(name: str) -> Stage:
    """A stage by its name."""
    return _BY_NAME[name]


def _reduced(stage: Stage) -> str | tuple[Any, ...]:
    """How a stage travels between processes: by its name, for its functions have none."""
    return (stage_called, (stage.name,)) if _BY_NAME.get(stage.name) is stage else stage.__reduce_ex__(4)


copyreg.pickle(Stage, _reduced)

#: Every name by which a case may ask for a result.
RESULTS: tuple[str, ...] = tuple(dict.fromkeys(name for stage in STAGES for name in stage.results))
