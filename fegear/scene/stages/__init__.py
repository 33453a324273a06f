"""The stages that fegear knows, one module per topic; each imports its heavy libraries only when it runs."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.scene.stages import geometry, stiffness, tooth_contact, transmissibility

if TYPE_CHECKING:
    from fegear.scene.stage import Stage

#: Every stage, in the order in which plans list those that they skip.
STAGES: tuple[Stage, ...] = (
    geometry.GEOMETRY,
    stiffness.STIFFNESS,
    stiffness.ROOT_STRESS,
    tooth_contact.TOOTH_CONTACT,
    transmissibility.TRANSMISSIBILITY,
)
