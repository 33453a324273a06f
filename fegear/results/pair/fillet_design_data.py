"""What the design of a fillet depends on, what comes of it, and as its sheet reads it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.design.fillet.fillet_limits import Limits
from fegear.geometry.conjugate_rack import conjugate_rack
from fegear.geometry.pair import GearPair, Member

if TYPE_CHECKING:
    from fegear.design.fillet.fillet_bench import Objective
    from fegear.design.fillet.fillet_design import FilletDesign, Stressed

#: Points by which the length of a fillet is measured.
_MEASURED = 1001
#: Chords of a drawn tooth stay this close to it [modules].
_CHORD = 1e-4
#: How far above a fillet the tooth is drawn, and room around the drawing [modules].
_ABOVE, _ROOM = 0.6, 0.1
#: Words of names of values, and roles of curves, by what a fillet is called.
_WORDS = {"present": "present", "full fillet of a rack": "full_rounded", "optimum": "optimum"}
_ROLES = {"present": "series:3", "full fillet of a rack": "series:1", "optimum": "series:0"}


@dataclass(frozen=True)
class FilletDesignInputs:
    """What the design of a fillet depends on, besides its loaded pair and the solutions of both gears.

    Parameters
    ----------
    objective : {"tension", "alternating"}
    limits : Limits
    waves, searches : int
    member : {"driver", "driven"}
        That gets the fillet.
    alike : bool
        Whether a gear meshes with its like.
    tolerance : float
        Of the final solutions.
    other_member : str
        Which gear of the pair it is that loads its other flanks; empty without.
    name : str
        Of the pair.
    gears : mapping of str to str
        Names of driver and driven.
    other : str
        Name of the pair that loads the other flanks of the gear; empty without.
    other_gears : mapping of str to str
        Names of its driver and driven.
    """

    objective: Objective
    limits: Limits
    waves: int
    searches: int
    member: Member
    alike: bool
    tolerance: float
    other_member: Member | None
    name: str = field(compare=False)
    gears: Mapping[Member, str] = field(compare=False)
    other: str = field(default="", compare=False)
    other_gears: Mapping[Member, str] = field(default_factory=dict, compare=False)

    @property
    def gear(self) -> str:
        """Name of the gear that gets the fillet."""
        return self.gears[self.member]


@dataclass(frozen=True)
class FilletDesignData:
    """A design, its present pair and the load [N]."""

    pair: GearPair
    load: float
    design: FilletDesign


@dataclass(frozen=True)
class FilletPoints:
    """Points of the designed fillet, which a case reads back as ``fillet``; arrays of shape (N,)."""

    x: Array = shown("mm", "distance from the centre line of the tooth")
    y: Array = shown("mm", "distance from the gear axis along the centre line of the tooth")


@dataclass(frozen=True)
class ToolTip:
    """Half a tooth of the rack that generates a fillet, from the middle of its tip; arrays of shape (N,).

    Parameters
    ----------
    role : str
        Of its curve: that of the fillet.
    """

    role: str
    half_width: Array = shown("mm", "distance from the centre line of the tool's tooth")
    height: Array = shown(
        "mm", "height above the tool's reference line, where its tooth is half a pitch wide",
        label="height above the reference line",
    )  # fmt: skip


@dataclass(frozen=True)
class StressedFillet:
    """One fillet and the stress along it; arrays of shape (S,).

    Parameters
    ----------
    label, role : str
        Of its curves.
    word : str
        In names of values.
    error : float
        Estimated, of the largest stress [Pa].
    x, y : ndarray, shape (N,)
        Right half of the tooth from the middle of the space to above the fillet [m].
    """

    label: str
    role: str
    word: str
    error: float
    x: Array = shown("mm", "distance from the centre line of the tooth")
    y: Array = shown("mm", "distance from the gear axis")
    largest: float = shown("MPa", "maximum root stress over the mesh", name="root_stress")
    fillet: str = shown("", "fillet")
    arc: Array = shown(
        "mm", "arc length from the middle of the tooth space", label="arc length from the middle of the tooth space"
    )
    diameter: Array = shown("mm", "diameter of the fillet point")
    stress: Array = shown("MPa", "maximum root stress over the mesh", label="root stress, maximum over the mesh")


@dataclass(frozen=True)
class FilletShown:
    """A design as its sheet reads it.

    Parameters
    ----------
    data : FilletDesignData
    asked : FilletDesignInputs
    """

    data: FilletDesignData
    asked: FilletDesignInputs

    @property
    def design(self) -> FilletDesign:
        """The design."""
        return self.data.design

    @property
    def module(self) -> float:
        """[m]."""
        return self.data.pair.driver.module

    @property
    def points(self) -> FilletPoints:
        """Of the designed fillet."""
        x, y = np.array(self.design.shape.points).T * self.module
        return FilletPoints(x, y)

    @cached_property
    def fillets(self) -> list[StressedFillet]:
        """Present, that of a rack with a full radius where there is one, and the designed one."""
        return [self._stressed(one) for one in self._rows]

    @property
    def _rows(self) -> list[Stressed]:
        design = self.design
        return [one for one in (design.present, design.full, design.best) if one is not None]

    @cached_property
    def tools(self) -> list[ToolTip]:
        """Tips of the racks that generate these fillets, of those that one generates."""
        found = [(one, conjugate_rack(one.tooth)) for one in self._rows if not one.tooth.internal]
        return [
            ToolTip(_ROLES[one.name], tip.half_width * self.module, tip.height * self.module)
            for one, tip in found
            if tip.exists
        ]

    @property
    def tool(self) -> ToolTip | None:
        """Of the designed fillet; None where no rack generates it."""
        made = self.design.tool
        return self.tools[-1] if made is not None and made.exists else None

    @property
    def window(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Ends of a square around the drawn fillets, in x and in y [mm]."""
        x, y = (np.concatenate([getattr(one, axis) for one in self.fillets]) * 1e3 for axis in ("x", "y"))
        half = 0.5 * max(float(np.ptp(x)), float(np.ptp(y))) + _ROOM * self.module * 1e3
        middle = [0.5 * float(one.min() + one.max()) for one in (x, y)]
        return (middle[0] - half, middle[0] + half), (middle[1] - half, middle[1] + half)

    def _stressed(self, one: Stressed) -> StressedFillet:
        from fegear.design.fillet.fillet_bench import SHARES
        from fegear.geometry.outline import tooth_outline

        tooth, m = one.tooth, self.module
        x, y = tooth.fillet.points(np.linspace(tooth.fillet.start, tooth.fillet.end, _MEASURED)) * m
        arc = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
        land = float(np.hypot(x[0], y[0])) * (math.pi / tooth.teeth - math.atan2(abs(float(x[0])), float(y[0])))
        places = SHARES * arc[-1]
        diameter = 2.0 * np.interp(places, arc, np.hypot(x, y))
        half = tooth_outline(tooth, _CHORD) * m
        up = tooth.side * (half[1] - 0.5 * diameter[-1])
        half = half[:, (half[0] >= 0.0) & (up <= _ABOVE * m)][:, ::-1]
        return StressedFillet(
            f"{one.name}: {one.stress * 1e-6:.4g} MPa", _ROLES[one.name], _WORDS[one.name], one.error, half[0], half[1],
            one.stress, one.name, land + places, diameter, one.along,
        )  # fmt: skip

    @property
    @shows("", "reduction of the maximum root stress by the designed fillet")
    def gain(self) -> float:
        """Over the present fillet."""
        return self.design.gain(self.design.present)[0]

    @property
    def gain_error(self) -> float:
        """Of it."""
        return self.design.gain(self.design.present)[1]

    @property
    @shows("", "reduction of the maximum root stress compared with the full fillet of a rack")
    def gain_over_full_rounded(self) -> float | None:
        """None where no rack makes the gear."""
        return None if self.design.full is None else self.design.gain(self.design.full)[0]

    @property
    def gain_over_full_rounded_error(self) -> float | None:
        """Of it."""
        return None if self.design.full is None else self.design.gain(self.design.full)[1]

    @property
    @shows("", "largest difference of the searches, relative")
    def spread_of_searches(self) -> float | None:
        """None of a single search."""
        return self.design.spread if len(self.design.found) > 1 else None

    @property
    @shows("", "increase of the maximum root stress, fillet 0.01 modules deeper at half its length")
    def increase_if_deeper(self) -> float:
        """NaN where there is no such fillet."""
        return self.design.off[0]

    @property
    @shows("", "increase of the maximum root stress, fillet 0.01 modules higher at half its length")
    def increase_if_higher(self) -> float:
        """NaN where there is no such fillet."""
        return self.design.off[1]

    @property
    @shows("mm", "minimum radius of curvature of the designed fillet")
    def minimum_radius(self) -> float:
        """Along the fillet [m]."""
        fillet = self.design.best.tooth.fillet
        curvature = np.abs(fillet.curvatures(np.linspace(fillet.start, fillet.end, _MEASURED)))
        return float(self.module / curvature.max())

    @property
    @shows("mm", "minimum radius of curvature of the tip of the rack that generates the designed fillet")
    def minimum_tool_radius(self) -> float | None:
        """None where no rack generates it."""
        tool = self.design.tool
        return self.module * tool.smallest_radius if tool is not None and tool.exists else None

    @property
    @shows("mm", "root form diameter, where the designed fillet ends")
    def form_diameter(self) -> float:
        """[m]."""
        return 2.0 * self.module * self.design.best.tooth.form_radius
