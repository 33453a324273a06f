"""The stages that fegear knows, one module per topic; each imports its heavy libraries only when it runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.scene.stages import crosscheck, geometry, root_stress_study, stiffness, tooth_contact, transmissibility

if TYPE_CHECKING:
    from fegear.scene.stage import Stage

#: Every stage, in the order in which plans list those that they skip.
STAGES: tuple[Stage, ...] = (
    geometry.GEOMETRY,
    stiffness.STIFFNESS,
    stiffness.ROOT_STRESS,
    crosscheck.CROSSCHECK,
    root_stress_study.ROOT_STRESS_STUDY,
    tooth_contact.TOOTH_CONTACT,
    transmissibility.TRANSMISSIBILITY,
)
