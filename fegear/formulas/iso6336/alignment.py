"""What K_Hbeta by method C of ISO 6336-1 asks for: the pinion's shaft, what is done to the flanks, what is known."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Literal

from fegear.errors import RangeError

#: Where a pinion sits between or beside its bearings: figure 13 of ISO 6336-1:2006, a to e.
Arrangement = Literal["a", "b", "c", "d", "e"]
#: What is done to the flanks along the face: table 8 of ISO 6336-1:2006, rows 1 to 6.
HelixModification = Literal[
    "none", "crowned", "crowned for manufacture", "helix corrected", "helix corrected and crowned", "end relief"
]
#: What is known of the contact pattern: nothing, that deformation and manufacture offset each other, that it is ideal.
ContactPattern = Literal["unknown", "favourable", "verified"]


@dataclass(frozen=True, slots=True)
class PinionShaft:
    """The pinion and its shaft (ISO 6336-1, figure 13).

    Parameters
    ----------
    arrangement : {"a", "b", "c", "d", "e"}
    bearing_span : float
        l [m].
    offset : float
        s, of the pinion's middle from that of the span; of an overhung pinion (c) from the nearer bearing [m].
    diameter : float
        d_sh, nominal outside diameter of the shaft that bends [m].
    power_share : float
        Part of the power that goes through this mesh, above 0 to 1 (B*); 1 where all of it does.
    """

    arrangement: Arrangement
    bearing_span: float
    offset: float
    diameter: float
    power_share: float = 1.0

    def __post_init__(self) -> None:
        """Refuse shafts that are none."""
        for name in ("bearing_span", "diameter"):
            value = getattr(self, name)
            if not (math.isfinite(value) and value > 0.0):
                raise RangeError(name, value, "must be positive and finite")
        if not (math.isfinite(self.offset) and self.offset >= 0.0):
            raise RangeError("offset", self.offset, "must be finite and not negative")
        if not 0.0 < self.power_share <= 1.0:
            raise RangeError("power_share", self.power_share, "must be above 0 and at most 1")


@dataclass(frozen=True, slots=True)
class Alignment:
    """What K_Hbeta by method C asks for; lengths [m].

    Parameters
    ----------
    shaft : PinionShaft, optional
        For f_sh; not needed where `deformation` or `face_load_factor` is given.
    deformation : float, optional
        f_sh, if it is known better.
    manufacture : float, optional
        f_ma; by default the root of the sum of squares of both f_Hbeta.
    modification : HelixModification
    contact_pattern : ContactPattern
    helix_slope_5 : float, optional
        f_Hbeta5, tolerance of grade 5, which a favourable contact pattern takes off.
    face_load_factor : float, optional
        K_Hbeta itself, where it is given.
    """

    shaft: PinionShaft | None = None
    deformation: float | None = None
    manufacture: float | None = None
    modification: HelixModification = "none"
    contact_pattern: ContactPattern = "unknown"
    helix_slope_5: float | None = None
    face_load_factor: float | None = None
