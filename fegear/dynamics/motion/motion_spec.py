"""What is asked of a train's motion: effects, friction, speeds, and how its steady motions are found."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.dynamics.train.charts import Direction
    from fegear.dynamics.train.friction_law import FrictionLaw


@dataclass(frozen=True)
class MotionSpec:
    """How a train moves: effects, friction, speeds, and how its steady motions are found.

    Parameters
    ----------
    contact_loss, parametric, friction : bool
        Effects that are on.
    law : FrictionLaw
    taken_by : str
        Body that takes what friction loses; empty where nothing is said.
    direction : {"up", "down", "static", "rest"}
        How speeds are gone through, and from what each motion starts.
    tolerance : float
    speeds : ndarray
        Of the body that speeds refer to [rad/s].
    method : {"shooting", "averaging"}
        How a steady motion is found.
    """

    contact_loss: bool
    parametric: bool
    friction: bool
    law: FrictionLaw
    taken_by: str
    direction: Direction
    tolerance: float
    speeds: Array
    method: Literal["shooting", "averaging"] = "shooting"

    @property
    def in_time(self) -> bool:
        """Whether it is computed in time: an effect calls for it that the linearised train does not know."""
        return self.contact_loss or self.parametric or self.friction

    @property
    def start(self) -> str:
        """From what the first motion starts."""
        return "rest" if self.direction == "rest" else "static"
