"""Tip relief of a rack's straight flank, and what drawings say of it: an amount, and a height or a length.

A place on the flank of a rack is a height above its reference line; the removal is measured along the normal of the
flank, which is the line of action, positive where material is removed.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.errors import InputError
from fegear.base.given import given
from fegear.geometry.curves import Arc, Line, Stretched
from fegear.geometry.plausible_flanks import DEEPEST_RELIEF
from fegear.geometry.relief import Shape

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.base.arrays import Array
    from fegear.geometry.curves import Drawn
    from fegear.geometry.rack_tooth import RackTooth
    from fegear.geometry.toothed_rack import Rack

#: Shortest relief over the height of the flank: too short to be ground.
_SHORTEST = 2e-3


@dataclass(frozen=True, slots=True)
class RackRelief:
    """Tip relief: nothing up to the height `start`, `amount` at the height `end`, by a power of the height between.

    Parameters
    ----------
    amount : float
        [m].
    start, end : float
        Heights above the reference line [m].
    power : float
        1: linear, 2: parabolic.
    """

    amount: float
    start: float
    end: float
    power: float = 1.0

    def removal(self, height: ArrayLike) -> Array:
        """Material removed along the normal at heights above the reference line [m]."""
        along = (np.asarray(height, dtype=float) - self.start) / (self.end - self.start)
        return np.asarray(self.amount * np.maximum(along, 0.0) ** self.power)


@dataclass(frozen=True, kw_only=True)
class RackReliefSpec:
    """Tip relief of the teeth of a rack, from the end of their flanks."""

    amount: float = given("length", "Amount of the tip relief (C_a) at the end of the flank.")
    height: float | None = given(
        "length", "Height of the relief, across the rack; alternatively `length`.", default=None, above=0.0
    )
    length: float | None = given(
        "length", "Length of the relief along the line of action, height over sin(alpha); alternatively `height`.",
        default=None, above=0.0,
    )  # fmt: skip
    shape: Shape = given(meaning="Shape of the relief from its start: linear or parabolic.", default="linear")

    def built(self, rack: Rack) -> RackRelief:
        """The relief of a rack.

        Raises
        ------
        InputError
            If it is given in none or both ways, is longer than the flank, or takes more than the tooth has.
        """
        tooth, module = rack.tooth, rack.module
        if (self.height is None) == (self.length is None):
            raise InputError("tip_relief.height", "(not given)" if self.height is None else "(given)",
                             "must be specified, or length, not both", 'for example height = "0.8 mm"')  # fmt: skip
        key = "tip_relief.length" if self.height is None else "tip_relief.height"
        along = math.sin(rack.pressure_angle) if self.height is None else 1.0
        deep = (self.length or 0.0) * along if self.height is None else self.height
        end = tooth.flank_end * module
        room = end - tooth.form_height * module
        if not _SHORTEST * room <= deep <= room:
            raise InputError(
                key, f"{deep / along * 1e3:.6g} mm",
                f"must be between {_SHORTEST * room / along * 1e3:.3g} and {room / along * 1e3:.4g} mm, the flank of "
                "the rack", "check the unit",
            )  # fmt: skip
        half = float(tooth.half_thickness(tooth.flank_end)) * module * math.cos(rack.pressure_angle)
        most = min(DEEPEST_RELIEF * module, half)
        if abs(self.amount) > most:
            raise InputError(
                "tip_relief.amount", f"{self.amount * 1e6:.6g} um",
                f"must be at most {most * 1e6:.4g} um ({DEEPEST_RELIEF:g} modules, half the tooth thickness)",
                "check the unit: reliefs are some tens of micrometres",
            )  # fmt: skip
        return RackRelief(self.amount, end - deep, end, 1.0 if self.shape == "linear" else 2.0)


@dataclass(frozen=True, slots=True)
class RelievedRackFlank:
    """The relieved part of a right flank, parameter height on the flank as generated [modules].

    Parameters
    ----------
    tooth : RackTooth
    relief : RackRelief
    module : float
        [m].
    start, end : float
        Heights [modules].
    """

    tooth: RackTooth
    relief: RackRelief
    module: float
    start: float
    end: float

    def points(self, parameter: ArrayLike) -> Array:
        """The straight flank less the removal along its normal [modules]."""
        y = np.asarray(parameter, dtype=float)
        off = self.relief.removal(y * self.module) / self.module
        alpha = self.tooth.pressure_angle
        return np.stack([self.tooth.half_thickness(y) - off * math.cos(alpha), y - off * math.sin(alpha)])


def relieved_rack_outline(rack: Rack, relief: RackRelief) -> list[Drawn]:
    """Half of a tooth's outline from the middle of the space to the middle of the tip, the relief ground off.

    The rounding or chamfer of the tip is moved towards the middle of the tooth as it is; a sharp tip stays as high as
    it was.

    Raises
    ------
    InputError
        If the relief takes away the tip.
    """
    tooth, module = rack.tooth, rack.module
    first = relief.start / module
    before: list[Drawn] = [one for one in (tooth.root_land, tooth.fillet) if one is not None]
    x, y = tooth.involute.a
    foot = Line((x, y), (float(tooth.half_thickness(first)), first))
    flank = RelievedRackFlank(tooth, relief, module, first, tooth.flank_end)
    end = tooth.flank_end
    for _ in range(50):  # a height of the flank as generated whose ground point is as high as the flank's end was
        end += tooth.flank_end - float(flank.points(end)[1])
    flank = RelievedRackFlank(tooth, relief, module, first, end)
    top_x, top_y = (float(one) for one in flank.points(end))
    inward = float(tooth.half_thickness(tooth.flank_end)) - top_x
    land = tooth.tip_land.a[0] - inward
    if not land > 0.0:
        raise InputError("tip_relief.amount", f"{relief.amount * 1e6:.6g} um", "removes the entire tip", "reduce it")
    after: list[Drawn] = []
    if isinstance(tooth.tip_edge, Arc):
        edge = tooth.tip_edge
        after.append(Arc((edge.centre[0] - inward, edge.centre[1]), edge.radius, edge.start, edge.end))
    elif isinstance(ellipse := cast("object", tooth.tip_edge), Stretched):
        after.append(ellipse.moved(-inward))
    elif tooth.tip_edge is not None:
        after.append(Line((top_x, top_y), (land, tooth.tip_height)))
    return [*before, foot, flank, *after, Line((land, tooth.tip_height), (0.0, tooth.tip_height))]
