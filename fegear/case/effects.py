"""``[effects]``: what a case calls for; everything is off unless named."""

from __future__ import annotations

from typing import Literal

from fegear.case.part import Part


class EffectsPart(Part):
    """Physical effects by name."""

    neighbour_coupling: bool = False
    hertz: Literal["load-dependent", "linear", "none"] = "none"
    relief: bool = False
    spacing_errors: bool = False
    corner_contact: bool = False
    contact_loss: bool = False
    friction: bool = False
    parametric: bool = False
    misalignment: bool = False

    def is_on(self, name: str) -> bool:
        """Whether an effect is switched on."""
        return getattr(self, name) not in (False, "none")

    def example(self, name: str) -> str:
        """Value that switches an effect on, as a case file writes it."""
        return '"load-dependent"' if name == "hertz" else "true"

    def on(self) -> tuple[str, ...]:
        """Names of the effects that are on."""
        return tuple(name for name in type(self).model_fields if self.is_on(name))
