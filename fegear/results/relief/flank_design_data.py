"""What the design of a pair's flanks depends on, what comes of it, and as its sheet reads it."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from functools import cached_property
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.case.flank_design import FlankDesignPart
from fegear.design.flanks.forms import lead_bearer
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.geometry.path_of_contact import active_profile
from fegear.results.relief.grinding import Grinding
from fegear.results.relief.ground_flank_keys import ground_rows
from fegear.results.relief.lead_charts import LeadChart, lead_chart
from fegear.results.relief.profile_charts import ProfileChart, profile_chart
from fegear.results.relief.recommended import recommended_design
from fegear.results.relief.relief_over_range import LeftOverRange

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.design.flanks.designed_flanks import FlankDesign, FlankState
    from fegear.design.flanks.families import FamilyBest
    from fegear.design.flanks.flank_tolerance import FlankTolerance
    from fegear.design.load_range import LoadRange

#: Sections of the charts: heights over half the face, and parts of the path of contact.
_HEIGHTS, _DEPTHS = (-0.9, 0.0, 0.9), (0.1, 0.5, 0.9)
#: Points of the maps and curves.
_ACROSS, _ALONG = 121, 81
#: Reliefs that leave less than this share of the unrelieved transmission error have a panel of their own.
_SMALL = 0.25
#: How much of the topography each gear gets, by the gear that the case names.
_SHARES: dict[str, dict[Member, float]] = {
    "driver": {"driver": 1.0},
    "driven": {"driven": 1.0},
    "both": dict.fromkeys(MEMBERS, 0.5),
}


@dataclass(frozen=True)
class FlankDesignInputs:
    """What the design of a pair's flanks depends on, besides its loaded flanks.

    Parameters
    ----------
    part : FlankDesignPart
    name : str
        Of the pair.
    gears : mapping of str to str
        Names of driver and driven.
    over : LoadRange, optional
        Loads that what can be ground is chosen for together.
    tolerance : FlankTolerance
        Of what is ground.
    misaligned : str
        The misalignment that counts as given, in words; empty for none.
    """

    part: FlankDesignPart
    name: str
    gears: Mapping[Member, str]
    over: LoadRange | None
    tolerance: FlankTolerance
    misaligned: str = field(default="", compare=False)


@dataclass(frozen=True)
class FlankDesignData:
    """A design and its pair."""

    pair: GearPair
    design: FlankDesign
    on_shafts: bool = False


@dataclass(frozen=True)
class FlankPoints:
    """Points of the exact topography of one gear; arrays of shape (N,).

    Parameters
    ----------
    gear : str
    """

    gear: str
    roll_angle: Array = shown("deg", "roll angle of the flank point")
    z: Array = shown("mm", "face position of the gear, from mid-face")
    removal: Array = shown("um", "amount of modification, normal to the flank in the transverse section")
    diameter: Array = shown("mm", "diameter of the flank point")
    x: Array = shown("mm", "position on the line of action, positive towards the driver's tip")
    line_load: Array = shown("N/mm", "design line load of the pair")


@dataclass(frozen=True)
class Section:
    """Removal by both gears over the profile or over the face, where the other of both places is fixed."""

    label: str
    removal: Array = shown("um", "removal")
    roll: Array | None = shown("deg", "roll angle of the driver", default=None)
    z: Array | None = shown("mm", "face position z", default=None)


@dataclass(frozen=True)
class WayToRelieve:
    """One way to relieve the flanks, and what it leaves.

    Parameters
    ----------
    state : FlankState
    best : FamilyBest or None
        Of its family; None where nothing was searched for.
    data : FlankDesignData
    """

    state: FlankState
    best: FamilyBest | None
    data: FlankDesignData

    @property
    @shows("", "type of modification")
    def relief(self) -> str:
        """Its name."""
        return self.state.label

    @property
    def word(self) -> str:
        """Its name in names of columns and values."""
        return self.relief.replace("-", "_").replace(" ", "_")

    @property
    @shows("um", "transmission error")
    def te(self) -> Array:
        """At the design load, over the roll positions."""
        return self.state.te

    @property
    @shows("um", "transmission error minus mean")
    def minus_mean(self) -> Array:
        """At the design load, over the roll positions."""
        return self.te - self.te.mean()

    @property
    @shows("mm", "mesh position: x of tooth pair 0 at mid-face")
    def roll(self) -> Array:
        """Of the transmission error [m]."""
        return self.data.design.roll

    @property
    def left(self) -> float:
        """Peak-to-peak transmission error at the design load [m]."""
        return self.state.judged.peak_to_peak.value

    @property
    def unrelieved(self) -> bool:
        """Whether it is none."""
        return self.state is self.data.design.unrelieved

    @property
    @shows("um", "additional misalignment: gap at +b/2 minus gap at -b/2")
    def over_face(self) -> Array:
        """Of its map."""
        return np.array(self.data.design.task.map_over_face)

    @property
    @shows("N", "total load along the line of action")
    def load(self) -> Array:
        """Of its map."""
        return np.array(self.data.design.task.map_loads)

    @property
    def x(self) -> Array:
        """Positions on the line of action at which its surface is drawn [m]."""
        return np.linspace(self.data.design.x[0], self.data.design.x[-1], _ACROSS)

    @property
    @shows("deg", "roll angle of the driver")
    def roll_angle(self) -> Array:
        """At these."""
        return np.asarray(self.data.pair.roll_angle(self.x, "driver"))

    @property
    @shows("mm", "face position z")
    def z(self) -> Array:
        """At which its surface is drawn."""
        return np.linspace(self.data.design.z[0], self.data.design.z[-1], _ALONG)

    def _removal(self, x: Array, z: Array) -> Array:
        """By both gears over a grid, counted from its least, shape (x, z) [m]."""
        from scipy.interpolate import RegularGridInterpolator

        first, second = np.meshgrid(x, z, indexing="ij")
        if self.state.relief is not None:
            found = self.state.relief.removal(self.data.pair, first, second)
        else:
            design = self.data.design
            found = RegularGridInterpolator((design.x, design.z), design.removal)((first, second))
        return np.asarray(found - found.min())

    @cached_property
    @shows("um", "removal")
    def removal(self) -> Array:
        """Of its surface, shape (z, x)."""
        return self._removal(self.x, self.z).T

    @property
    def profiles(self) -> list[Section]:
        """Over the profile in three sections across the axis."""
        heights, z = 0.5 * self.data.pair.face_width * np.array(_HEIGHTS), self.z
        found = self._removal(self.x, np.sort(np.append(heights, z[[0, -1]])))[:, 1:-1]
        return [Section(f"z = {h * 1e3:.3g} mm", found[:, k], roll=self.roll_angle) for k, h in enumerate(heights)]

    @property
    def leads(self) -> list[Section]:
        """Over the face on three diameters of the driver."""
        pair, x = self.data.pair, self.x
        places = pair.x_start + pair.path_length * np.array(_DEPTHS)
        found = self._removal(np.sort(np.append(places, x[[0, -1]])), self.z)[1:-1]
        diameters = 2.0 * np.asarray(pair.radius(places, "driver"))
        return [
            Section(f"diameter {d * 1e3:.5g} mm", found[k], z=self.z) for k, d in enumerate(diameters)
        ]  # fmt: skip


@dataclass(frozen=True)
class Left:
    """What every way leaves, beside each other; arrays with a place for each, the last of them lowest.

    The last two are None where misalignment does not scatter.
    """

    place: Array = shown("", "way to relieve the flanks")
    peak_to_peak: Array = shown("um", "transmission error, peak to peak")
    factor: Array = shown("", "K_Hbeta")
    mean: Array | None = shown("um", "transmission error, peak to peak")
    worst: Array | None = shown("", "K_Hbeta")


@dataclass(frozen=True)
class LikeWays:
    """Ways that leave transmission errors of like size."""

    title: str
    ways: Sequence[WayToRelieve]


@dataclass(frozen=True)
class FlanksShown:
    """Designed flanks as their sheet reads them."""

    data: FlankDesignData
    asked: FlankDesignInputs

    @property
    def design(self) -> FlankDesign:
        """All of it."""
        return self.data.design

    @property
    def load(self) -> float:
        """Design load [N]."""
        return self.design.task.load

    @property
    def driver(self) -> str:
        """Name of the gear."""
        return self.asked.gears["driver"]

    @property
    @shows("um", "maximum amount of the ideal topography (sum of both gears)")
    def topography_depth(self) -> float:
        """[m]."""
        return float(np.ptp(self.design.removal))

    @cached_property
    def topographies(self) -> list[FlankPoints]:
        """Of the gears that get one."""
        shares = _SHARES[self.asked.part.gear]
        return [topography_points(self.data, m, self.asked.gears[m], share) for m, share in shares.items()]

    @cached_property
    def over_range(self) -> dict[str, LeftOverRange]:
        """What each way leaves at each torque of a range."""
        task, pair = self.design.task, self.data.pair
        load = np.array(task.loads)
        weights = np.ones(load.size) if task.weights is None else np.array(task.weights)
        over, best = self.asked.over, self.design.best.label if self.design.found else ""
        shares = None if over is None or over.shares is None else np.array(over.shares)
        return {
            state.label: LeftOverRange(
                load * pair.driver.base_radius, load, weights / weights.max(), state.over_peak_to_peak,
                state.over_first, state.over_most if state.label in self.design.found else None, state.over_error,
                mean=state.over_mean if self.scattered else None, share=shares,
                finer=self.design.finer if state.label == best else 0,
                slopes=self.design.unrelieved_most if state is self.design.unrelieved else None,
            )
            for state in self.design.states
        }  # fmt: skip

    @cached_property
    def grinding(self) -> tuple[Grinding, ...]:
        """What can be ground: first what is to be, then by what is left."""
        design, found = self.design, self.design.found
        ordered = sorted(
            (state for state in design.states if state.label in found),
            key=lambda state: (bool(found) and state is not design.best, design.left_by(state)),
        )  # fmt: skip
        return tuple(
            row
            for state in ordered
            for row in ground_rows(
                found[state.label].relief, self.data.pair, self.asked.gears, state.label, self.asked.tolerance
            )
        )  # fmt: skip

    @cached_property
    def recommended(self) -> str:
        """Name of the design to be ground; empty where none is worth it."""
        return recommended_design(self.grinding, self.over_range)

    @cached_property
    def profile_charts(self) -> dict[str, tuple[ProfileChart, ...]]:
        """Of both gears for each design with tip relief, the one to be ground first."""
        from fegear.design.flanks.flank_tolerance import end_reliefs

        pair, found = self.data.pair, self.design.found
        reliefs = {label: found[label].relief for label in dict.fromkeys(row.design for row in self.grinding)}
        return {
            label: tuple(
                profile_chart(
                    self.asked.gears[member], pair.gear(member), tip, allowed, active=active_profile(pair, member),
                    recommended=label == self.recommended,
                )
                for member, tip, allowed in zip(
                    MEMBERS, end_reliefs(relief.numbers, pair, relief.tip_power), self.asked.tolerance.tips, strict=True
                )
            )
            for label, relief in reliefs.items()
            if relief.driver_tip or relief.driven_tip
        }  # fmt: skip

    @cached_property
    def lead_charts(self) -> dict[str, LeadChart]:
        """Of the gear that has the lead, for each design with one."""
        pair, found, lead = self.data.pair, self.design.found, self.asked.tolerance.lead
        bearer = lead_bearer(pair)
        charts = {
            label: lead_chart(
                self.asked.gears[bearer], found[label].relief, pair, bearer, lead, recommended=label == self.recommended
            )
            for label in dict.fromkeys(row.design for row in self.grinding)
            if lead is not None
        }
        return {label: chart for label, chart in charts.items() if chart is not None}

    @cached_property
    def ways(self) -> list[WayToRelieve]:
        """All ways to relieve the flanks."""
        found = self.design.found
        return [WayToRelieve(state, found.get(state.label), self.data) for state in self.design.states]

    @cached_property
    def drawn(self) -> list[WayToRelieve]:
        """The exact topography, and what is ground best."""
        return [next(way for way in self.ways if way.state is s) for s in (self.design.exact, *self.design.chosen)]

    @property
    def mapped(self) -> list[WayToRelieve]:
        """Those with maps over misalignment and load."""
        return [self.ways[0], *self.drawn]

    @property
    def deepest(self) -> tuple[float, float]:
        """Ends of the scale of the surfaces [m]."""
        return 0.0, max(float(way.removal.max()) for way in self.drawn)

    def highest(self, quantity: str) -> float:
        """Of the maps over misalignment and load."""
        return max(float(getattr(way.state.mapped, quantity).max()) for way in self.mapped)

    @property
    def scattered(self) -> bool:
        """Whether misalignment scatters."""
        return self.design.scattered

    @cached_property
    def left(self) -> Left:
        """What every way leaves."""
        judged = [way.state.judged for way in reversed(self.ways)]

        def of(key: str) -> Array:
            return np.array([getattr(one, key).value for one in judged])

        more = [of("mean_over_scatter"), of("factor_over_scatter")] if self.scattered else [None, None]
        return Left(np.arange(len(judged), dtype=float), of("peak_to_peak"), of("face_load_factor"), *more)

    @property
    def by_size(self) -> list[LikeWays]:
        """Ways that leave much, and such that leave little."""
        small = _SMALL * self.ways[0].left
        found = [
            LikeWays("modifications with high transmission error", [w for w in self.ways if w.left >= small]),
            LikeWays("reliefs with small remaining transmission error", [w for w in self.ways if w.left < small]),
        ]
        return [like for like in found if like.ways]

    @property
    def unproven(self) -> str:
        """Families whose optimum is not proven."""
        return ", ".join(label for label, best in self.design.found.items() if not best.proven)


def topography_points(data: FlankDesignData, member: Member, gear: str, share: float) -> FlankPoints:
    """A gear's share of the exact topography, at the nodes of its table.

    Parameters
    ----------
    data : FlankDesignData
    member : {"driver", "driven"}
    gear : str
    share : float
        Of the removal by both gears.
    """
    design, pair = data.design, data.pair
    x, z = (grid.ravel() for grid in np.meshgrid(design.x, design.z, indexing="ij"))
    return FlankPoints(
        gear, np.asarray(pair.roll_angle(x, member)), z + pair.face_height(member), share * design.removal.ravel(),
        2.0 * np.asarray(pair.radius(x, member)), x, design.task.load * design.task.loading.line_load(x, z),
    )  # fmt: skip
