"""What teeth with a width need besides what plane teeth need: errors over the face, and how it is divided."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.wide.shaft_gaps import RIGID, ShaftGaps
from fegear.geometry.shaft_tilt import PARALLEL, ShaftTilt

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.geometry.flank_modification import FlankModification


@dataclass(frozen=True)
class Misalignment:
    """Errors of a pair of teeth with a width that the effect `misalignment` counts.

    Parameters
    ----------
    face_position, line_gap : ndarray, shape (n,)
        Gap over the face [m]; empty for none.
    tilt : ShaftTilt
        Deviation of the axes.
    cutting : tuple of FlankModification
        Errors of the pinion's profile and lead angle.
    apart : float
        Error of the centre distance [m].
    shafts : ShaftGaps
        What shafts open as they are loaded.
    """

    face_position: Array = field(default_factory=lambda: np.empty(0))
    line_gap: Array = field(default_factory=lambda: np.empty(0))
    tilt: ShaftTilt = PARALLEL
    cutting: tuple[FlankModification, ...] = ()
    apart: float = 0.0
    shafts: ShaftGaps = RIGID

    @property
    def given(self) -> bool:
        """Whether there are any."""
        own = bool(self.line_gap.size or self.cutting or self.apart or self.tilt != PARALLEL)
        return own or self.shafts.given


@dataclass(frozen=True)
class WideSpec:
    """Fields of a `fegear.contact.pair_spec.PairSpec` that plane teeth do not have.

    Parameters
    ----------
    errors : Misalignment
    cutter : tuple of FlankModification
        What the pinion's cutter leaves, counted with the effect `relief`.
    positions : int
        Roll positions over one base pitch.
    panels : int
        Parts of the common face; 0 for one to a quarter of a module.
    base_pitch : int
        Which teeth meet where they have spacing errors.
    """

    errors: Misalignment = field(default_factory=Misalignment)
    cutter: tuple[FlankModification, ...] = ()
    positions: int = 16
    panels: int = 0
    base_pitch: int = 0
