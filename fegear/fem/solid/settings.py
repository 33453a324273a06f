"""Every choice that trades accuracy against time for teeth with a width, in modules."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, fields, replace
from typing import Literal

from fegear.errors import InputError
from fegear.fem.settings import MeshSettings

#: A section as coarse as its order allows: some 200 triangles.
_SECTION = MeshSettings(
    root_edge_length=0.2, root_fraction=0.7, flank_edge_length=0.3, tip_edge_length=0.1, junction_edge_length=0.1,
    back_edge_length=0.8, growth=0.6, tip_growth=0.5, side_growth=0.8, body_fraction=1.8, rim_fraction=0.45,
    order=3,
)  # fmt: skip

#: By how much the solution that shows the error is coarser.
_COARSER = 1.35
#: How much less room its bands take beside the ends of the flank, where room alone decides how wide they are.
_OTHER_ROOM = 0.7
#: What the usual settings and the finer ones meet, and the power of the tolerance that edges go with.
_USUAL, _FINE, _ORDER = 1e-2, 3e-3, 0.33


@dataclass(frozen=True, slots=True)
class SolidSettings:
    """Edge lengths and order of the section, functions along the face, and the width of the pressed bands.

    Parameters
    ----------
    section : MeshSettings
        Of the section's mesh and the order of its elements.
    waves_per_module : float
        Degree of the polynomials along the face per module of width.
    least_degree : int
        Their lowest degree, for narrow gears.
    wave_reach, fewest_waves : float
        A node at the distance d from the loaded flank has wave_reach * width / (2 d) + fewest_waves functions along
        the face, at most all.
    band_half_width : float
        Half-width of the pressure that loads the flank.
    room_share : float
        Share of the room to the nearer end of the flank that it takes at most.
    source : {"solid", "slices"}
        The whole solid, or slices of its plane section that are coupled along the face (`slices`).
    """

    section: MeshSettings = field(default=_SECTION)
    waves_per_module: float = 1.5
    least_degree: int = 8
    wave_reach: float = 2.5
    fewest_waves: float = 6.0
    band_half_width: float = 0.25
    room_share: float = 0.7
    source: Literal["solid", "slices"] = "solid"

    def __post_init__(self) -> None:
        """Refuse settings that make no mesh."""
        for f in fields(self):
            value = getattr(self, f.name)
            if f.name not in ("section", "source") and not (math.isfinite(value) and value > 0.0):
                raise InputError(f"accuracy.{f.name}", value, "must be positive and finite")
        if self.room_share > 0.95:
            raise InputError("accuracy.room_share", self.room_share, "must be at most 0.95: a band stays on the flank")
        if self.fewest_waves < 2.0:  # a rigid motion along the face takes two
            raise InputError("accuracy.fewest_waves", self.fewest_waves, "must be at least 2")
        if self.least_degree < 3:
            raise InputError("accuracy.least_degree", self.least_degree, "must be at least 3")

    def degree(self, width: float) -> int:
        """Degree of the polynomials along a face [modules]."""
        return max(int(self.least_degree), whole(self.waves_per_module * width, up=True))

    def scaled(self, factor: float) -> SolidSettings:
        """Return a coarser (factor > 1) or finer set: everything that leaves an error changes."""
        return replace(
            self,
            section=self.section.scaled(factor),
            waves_per_module=self.waves_per_module / factor,
            least_degree=max(3, round(self.least_degree / factor)),
            wave_reach=self.wave_reach / factor,
            fewest_waves=self.fewest_waves / factor,
            band_half_width=min(self.band_half_width * math.sqrt(factor), 0.5),
        )

    def coarser(self) -> SolidSettings:
        """The set whose solution shows the error of this one's: nothing that leaves an error is the same."""
        other = SolidSettings() if self == _THIRD else self.scaled(_COARSER)
        return replace(other, room_share=_OTHER_ROOM * self.room_share)


#: By how much what a count is made of may be off; no count hangs on so little.
_ROUND_OFF = 1e-9
#: Elements of order 4, more functions along the face, narrower bands.
_THIRD = SolidSettings(
    section=replace(_SECTION, order=4), waves_per_module=2.0, least_degree=11, wave_reach=3.0, band_half_width=0.2
)


def whole(number: float, *, up: bool = False) -> int:
    """Nearest whole number, or the next one above: round-off of a face of five modules makes no sixth part of it."""
    return math.ceil(number - _ROUND_OFF) if up else math.floor(number + 0.5 + _ROUND_OFF)


def solid_settings(tolerance: float) -> SolidSettings:
    """Settings that usually meet a relative tolerance for contacts in reach of the usual part of the flank.

    Parameters
    ----------
    tolerance : float
        1e-2 takes elements of order 3, 3e-3 those of order 4; others make these finer or coarser, .1 to 1e-3 at most.
    """
    if not 1e-3 <= tolerance <= 0.1:
        raise InputError("accuracy.tolerance", tolerance, "must lie between 1e-3 and 0.1 for teeth with a width")
    if tolerance >= _USUAL:
        return SolidSettings() if tolerance == _USUAL else SolidSettings().scaled((tolerance / _USUAL) ** _ORDER)
    if tolerance >= _FINE:
        return _THIRD
    return _THIRD.scaled((tolerance / _FINE) ** _ORDER)
