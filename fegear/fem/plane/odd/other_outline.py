"""Teeth of another outline than the ordinary one: with another tip circle, or none at all; lengths in modules."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.errors import GeometryError, InputError
from fegear.geometry.custom_fillet_tooth import with_tip

if TYPE_CHECKING:
    from fegear.geometry.involute_tooth import InvoluteTooth

#: A tooth ends at least so far above its root form circle [modules]: a shorter flank has no room for a contact.
SHORTEST_FLANK = 0.05


@dataclass(frozen=True)
class OtherTip:
    """A tooth that ends at another radius [modules]: ground lower, or broken off."""

    radius: float

    def tooth(self, ordinary: InvoluteTooth) -> InvoluteTooth:
        """The tooth, its flanks and fillets those of the ordinary one.

        Raises
        ------
        InputError
            If its tip is above the ordinary one's, or too near to the start of the flank.
        """
        refuse_tip(ordinary, self.radius)
        try:
            return with_tip(ordinary, self.radius)
        except GeometryError as error:
            raise InputError("tip_radius", f"{self.radius:.6g} modules", error.rule, error.remedy) from None


@dataclass(frozen=True)
class Missing:
    """No tooth: a sector that ends at the root circle."""


def refuse_tip(ordinary: InvoluteTooth, radius: float) -> None:
    """Refuse a tip circle that a tooth cannot end at.

    Raises
    ------
    InputError
    """
    least, most = ordinary.form_radius + SHORTEST_FLANK, ordinary.tip_radius
    if not least <= radius <= most * (1.0 + 1e-12):
        raise InputError(
            "tip_radius", f"{radius:.6g} modules",
            f"must be a radius above the root form circle and up to the tip circle, {least:.6g} to {most:.6g} modules",
        )  # fmt: skip
