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
from fegear.geometry.asymmetric_tooth import AsymmetricSide
from fegear.geometry.conjugate_rack import conjugate_rack
from fegear.geometry.pair import GearPair, Member
from fegear.geometry.shaped_side import FilletKey, ShapedSide

if TYPE_CHECKING:
    from fegear.design.fillet.fillet_bench import Objective
    from fegear.design.fillet.fillet_design import FilletDesign, Stressed
    from fegear.geometry.involute_side import InvoluteSide

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
    solved : mapping of str to str
        The same of their solutions: asymmetric gears have one for each flank.
    other : str
        Name of the pair that loads the other flanks of the gear; empty without.
    other_gears : mapping of str to str
        Names of the solutions of its driver and driven.
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
    solved: Mapping[Member, str] = field(compare=False)
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
class DesignedFillet:
    """One designed fillet, which a case reads back as ``fillet`` or ``coast_fillet``.

    Parameters
    ----------
    key : {"fillet", "coast_fillet"}
    side : str
        " drive" or " coast" of asymmetric teeth, in words of titles; empty of equal flanks.
    x, y : ndarray, shape (N,)
        Points [m].
    """

    key: FilletKey
    side: str
    x: Array = shown("mm", "distance from the centre line of the tooth")
    y: Array = shown("mm", "distance from the gear axis along the centre line of the tooth")
    minimum_radius: float = shown("mm", "minimum radius of curvature of the designed fillet")
    form_diameter: float = shown("mm", "root form diameter, where the designed fillet ends")
    minimum_tool_radius: float | None = shown(
        "mm", "minimum radius of curvature of the tip of the rack that generates the designed fillet"
    )

    @property
    def suffix(self) -> str:
        """In names of tables and values."""
        return self.side.replace(" ", "_")


@dataclass(frozen=True)
class ToolTip:
    """Half a tooth of the rack that generates a fillet, from the middle of its tip; arrays of shape (N,).

    Parameters
    ----------
    role, dash : str
        Of its curve: that of the fillet.
    side : str
        As of `DesignedFillet`.
    drawn : ndarray
        Distance from the centre line, negative on the coast side where both are drawn [m].
    """

    role: str
    dash: str
    side: str
    drawn: Array
    half_width: Array = shown("mm", "distance from the centre line of the tool's tooth")
    height: Array = shown(
        "mm", "height above the tool's reference line, where its tooth is half a pitch wide",
        label="height above the reference line",
    )  # fmt: skip

    @property
    def suffix(self) -> str:
        """In names of tables."""
        return self.side.replace(" ", "_")


@dataclass(frozen=True)
class LargestStress:
    """Largest stress with a fillet, or with both.

    Parameters
    ----------
    word, fillet : str
        In names of values, and in their meaning.
    error : float
        Estimated [Pa].
    """

    word: str
    fillet: str
    error: float
    largest: float = shown("MPa", "maximum root stress over the mesh", name="root_stress")


@dataclass(frozen=True)
class StressedFillet:
    """One fillet and the stress along it; arrays of shape (S,).

    Parameters
    ----------
    label, role, dash : str
        Of its curves.
    word, side : str
        In names of values; as of `DesignedFillet` where both fillets are designed.
    error : float
        Estimated, of the largest stress [Pa].
    x, y : ndarray, shape (N,)
        Half of the tooth from the middle of the space to above the fillet: the right one, of the other side of
        asymmetric teeth the left one [m].
    """

    label: str
    role: str
    dash: str
    word: str
    side: str
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
    def both(self) -> bool:
        """Whether fillets of both sides are designed."""
        return self.design.best.back is not None

    def _side(self, side: InvoluteSide, *, always: bool = False) -> str:
        """Word of a side of asymmetric teeth, where fillets of both are meant or always."""
        return f" {side.working_flank}" if side.working_flank and (always or self.both) else ""

    @cached_property
    def designed(self) -> list[DesignedFillet]:
        """Each designed fillet."""
        found, m = [], self.module
        made = self.design.tools
        tools = made if made and all(one.exists for one in made) else (None,) * len(self.design.shapes)
        for shape, (side, _), tool in zip(self.design.shapes, self.design.best.sides, tools, strict=True):
            x, y = np.array(shape.points).T * m
            curvature = side.fillet.curvatures(np.linspace(side.fillet.start, side.fillet.end, _MEASURED))
            key = side.fillet_key if isinstance(side, ShapedSide) else None
            found.append(
                DesignedFillet(
                    key or "fillet", self._side(side, always=True), x, y, float(m / np.abs(curvature).max()),
                    2.0 * m * side.form_radius,
                    None if tool is None else m * tool.smallest_radius,
                )
            )  # fmt: skip
        return found

    @property
    def largest(self) -> list[LargestStress]:
        """Largest stress with each of them."""
        return [LargestStress(_WORDS[one.name], one.name, one.error, one.stress) for one in self._rows]

    @property
    def of_sides(self) -> list[LargestStress]:
        """The same in each of both fillets."""
        return [
            LargestStress(f"{one.word}{one.side.replace(' ', '_')}", one.fillet, one.error, one.largest)
            for one in self.fillets if one.side
        ]  # fmt: skip

    @cached_property
    def fillets(self) -> list[StressedFillet]:
        """Present, that of a rack with a full radius where there is one, and the designed one; of both sides."""
        return [
            self._stressed(one, side, along, left=n > 0)
            for one in self._rows for n, (side, along) in enumerate(one.sides)
        ]  # fmt: skip

    @property
    def _rows(self) -> list[Stressed]:
        design = self.design
        return [one for one in (design.present, design.full, design.best) if one is not None]

    @cached_property
    def tools(self) -> list[ToolTip]:
        """Tips of the racks that generate these fillets, of those that one generates."""
        return [
            self._tip(one.name, side, left=n > 0)
            for one in self._rows if not one.tooth.internal
            for n, (side, _) in enumerate(one.sides) if all(conjugate_rack(each).exists for each, _ in one.sides)
        ]  # fmt: skip

    def _tip(self, name: str, side: InvoluteSide, *, left: bool) -> ToolTip:
        """Beside one fillet; of asymmetric teeth from the middle of the tool's tooth at its reference line."""
        tip, made = conjugate_rack(side), side.as_generated if isinstance(side, ShapedSide) else side
        width = tip.half_width
        if isinstance(made, AsymmetricSide):
            width = width + side.pitch_radius * (side.base_half_angle - made.base_half_angle) + made.beside
        m, dash = self.module, "dash" if left else "solid"
        drawn = (-width if left else width) * m
        return ToolTip(_ROLES[name], dash, self._side(side, always=True), drawn, width * m, tip.height * m)

    @property
    def tool(self) -> list[ToolTip]:
        """Of the designed fillet; none where no rack generates it."""
        made = self.design.tools
        return self.tools[-len(made) :] if made and all(one.exists for one in made) else []

    @property
    def window(self) -> tuple[tuple[float, float], tuple[float, float]]:
        """Ends of a square around the drawn fillets, in x and in y [mm]."""
        x, y = (np.concatenate([getattr(one, axis) for one in self.fillets]) * 1e3 for axis in ("x", "y"))
        half = 0.5 * max(float(np.ptp(x)), float(np.ptp(y))) + _ROOM * self.module * 1e3
        middle = [0.5 * float(one.min() + one.max()) for one in (x, y)]
        return (middle[0] - half, middle[0] + half), (middle[1] - half, middle[1] + half)

    def _stressed(self, one: Stressed, side: InvoluteSide, along: Array, *, left: bool) -> StressedFillet:
        from fegear.design.fillet.fillet_bench import SHARES
        from fegear.geometry.outline import tooth_outline, turned

        m, named = self.module, self._side(side)
        x, y = side.fillet.points(np.linspace(side.fillet.start, side.fillet.end, _MEASURED)) * m
        arc = np.concatenate([[0.0], np.cumsum(np.hypot(np.diff(x), np.diff(y)))])
        land = float(np.hypot(x[0], y[0])) * (math.pi / side.teeth - math.atan2(abs(float(x[0])), float(y[0])))
        places = SHARES * arc[-1]
        diameter = 2.0 * np.interp(places, arc, np.hypot(x, y))
        half = tooth_outline(side, _CHORD) * m
        up = side.side * (half[1] - 0.5 * diameter[-1])
        half = half[:, (half[0] >= 0.0) & (up <= _ABOVE * m)][:, ::-1]
        if side.working_flank:  # flanks of all fillets on each other, about the centre line of the generated tooth
            reference = self.design.present.sides[int(left)][0]
            made = reference.as_generated if isinstance(reference, ShapedSide) else reference
            half = turned(half, made.base_half_angle - side.base_half_angle)
        largest = one.stress if one.back is None else float(along.max())
        name = f"{one.name},{named}" if named else one.name
        return StressedFillet(
            f"{name}: {largest * 1e-6:.4g} MPa", _ROLES[one.name], "dash" if left else "solid", _WORDS[one.name], named,
            one.error, -half[0] if left else half[0], half[1], largest, name, land + places, diameter, along,
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
