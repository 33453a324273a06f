"""``[effects]``: what a case calls for; everything is off unless named."""

from __future__ import annotations

from typing import Literal

from pydantic import Field

from fegear.case.part import Part


class EffectsPart(Part):
    """Physical effects by name."""

    neighbour_coupling: bool = Field(
        default=False, description="Whether a loaded tooth bends its neighbours through the body."
    )
    hertz: Literal["load-dependent", "linear", "none"] = Field(
        default="none",
        description="Contact deformation: as it grows with the load, linearised at the nominal load, or neglected.",
    )
    relief: bool = Field(default=False, description="Whether profile and flank modifications count.")
    spacing_errors: bool = Field(default=False, description="Whether spacing errors of the teeth count.")
    corner_contact: bool = Field(
        default=False, description="Whether deflected teeth meet before and after the nominal path of contact."
    )
    contact_loss: bool = Field(default=False, description="Loss of contact and impacts in motion.")
    friction: bool = Field(default=False, description="Sliding friction between the teeth.")
    parametric: bool = Field(default=False, description="Whether the mesh stiffness varies in time.")
    misalignment: bool = Field(default=False, description="Whether misalignment and line errors of a pair count.")

    def is_on(self, name: str) -> bool:
        """Whether an effect is switched on."""
        return getattr(self, name) not in (False, "none")

    def example(self, name: str) -> str:
        """Value that switches an effect on, as a case file writes it."""
        return '"load-dependent"' if name == "hertz" else "true"

    def on(self) -> tuple[str, ...]:
        """Names of the effects that are on."""
        return tuple(name for name in type(self).model_fields if self.is_on(name))
