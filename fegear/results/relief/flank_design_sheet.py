"""What designed flanks show: topographies, charts for the drawing, what each relief leaves, maps over misalignment."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.base.arrays import Array
from fegear.base.shown import shown, shows
from fegear.contact.wide.lines import ContactLines
from fegear.engine.figure.axis import Axis
from fegear.engine.sheet.chart import Chart, Family, Line, Map, Over
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Off, Rows
from fegear.engine.sheet.sheet import Remark, Sheet
from fegear.geometry.pair import MEMBERS, Member
from fegear.results.relief.ground_flank_keys import keys_of

if TYPE_CHECKING:
    from fegear.design.flanks.families import FamilyBest
    from fegear.design.flanks.flank_design import FlankDesign, FlankState
    from fegear.engine.sheet.seen import Seen
    from fegear.results.relief.flank_design_data import FlankDesignData, FlankDesignInputs

#: What is stated of every relief; the last three where misalignment scatters.
_JUDGED = (
    "peak_to_peak", "face_load_factor", "pressure", "mean_over_scatter", "most_over_scatter", "factor_over_scatter"
)  # fmt: skip
#: Numbers of a relief that can be ground.
_GROUND = (
    "driver_tip", "driver_tip_length", "driven_tip", "driven_tip_length", "crowning", "end_relief",
    "end_relief_length", "slope", "bias",
)  # fmt: skip
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
    def ways(self) -> list[WayToRelieve]:
        """All ways to relieve the flanks."""
        found = self.design.found
        return [WayToRelieve(state, found.get(state.label), self.data) for state in self.design.states]

    @cached_property
    def drawn(self) -> list[WayToRelieve]:
        """The exact topography, and what is ground best."""
        chosen = (self.design.exact, self.design.best, *self.design.robust)
        return [next(way for way in self.ways if way.state is state) for state in chosen]

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
        return self.design.task.scatter.over_face.size > 1

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


#: Topography of a gear, which a case reads back as its ``topography``.
TOPOGRAPHY = Rows(
    "flank_topography_{name}_{one.gear}", "Topographic relief of gear {one.gear} in pair {name}",
    ("roll_angle", "z", "removal", "diameter", "x", "line_load"), each="topographies",
)  # fmt: skip


def _judged(key: str) -> tuple[Cell, Off]:
    """A number of every way with its error."""

    def of(which: str) -> Callable[[Seen], list[float]]:
        return lambda seen: [getattr(getattr(way.state.judged, key), which) for way in seen.data.ways]

    return Cell(f"state.judged.{key}", of("value")), Off(f"state.judged.{key}", of("error"))


def _ground(key: str) -> Cell:
    """A number of what is ground; zero where nothing of the kind is."""
    return Cell(
        key, lambda seen: [getattr(way.state.relief, key) if way.state.relief else 0.0 for way in seen.data.ways],
        lambda seen: seen.data.design.best.relief,
    )  # fmt: skip


def _searched(key: str, without: float = 0) -> Cell:
    """How the best of a family was searched for."""
    return Cell(
        key, lambda seen: [without if way.best is None else getattr(way.best, key) for way in seen.data.ways],
        lambda seen: next(iter(seen.data.design.found.values())),
    )  # fmt: skip


def _judged_value(key: str) -> Number:
    over_scatter = key in _JUDGED[3:]
    return Number(
        key, lambda seen: getattr(seen.one.state.judged, key).error, "state.judged",
        lambda seen: getattr(seen.one.state.judged, key).value, "{name}.{one.word}", further=": {one.relief}",
        when=(lambda seen: seen.data.design.task.deviation) if over_scatter else None,
    )  # fmt: skip


def _sections(where: str, axis: Callable[[Seen], Axis], along: str, title: str) -> Over:
    line = Line("removal", "{one.label}", x=along, each=Family(where, role="ramp"),
                look={"dash": "solid", "markers": False})  # fmt: skip
    return Over(axis, (line,), Axis("removal", "um", zero=True), title=title)


def _roll_axis(seen: Seen) -> Axis:
    return Axis(f"roll angle of {seen.data.driver}", "deg")


def _face_axis(_seen: Seen) -> Axis:
    return Axis("face position z", "mm")


def _beside(x: Axis, nominal: str, scattered: str, label: str, role: str) -> Over:
    """What every way leaves, aligned as given and over the scatter."""
    look: dict[str, Any] = {"size": 9}
    return Over(
        x,
        (
            Line("place", "alignment as specified", "series:0", x=nominal, kind="points", look=look),
            Line("place", label, role, x=scattered, kind="points", look=look, when="scattered"),
        ),
        lambda seen: Axis(categories=tuple(way.relief.replace("-", " ") for way in reversed(seen.data.ways))),
    )  # fmt: skip


def _beside_caption(seen: Seen) -> str:
    caption = seen.said("Pair {name} at the design load: remaining transmission error with each relief, and K_Hβ.")
    if not seen.data.scattered:
        return caption
    deviation = seen.data.design.task.deviation
    return f"{caption} Scatter: misalignment over the face width, standard deviation {deviation * 1e6:.3g} µm."


def _tiles(quantity: str, label: str, title: str, floor: float) -> Over:
    """A map over misalignment and load."""
    return Over(
        Axis("misalignment over the face width", "um"),
        (
            Map(
                f"state.mapped.{quantity}", "load", "over_face", lambda _: label, numbers=True,
                si=lambda seen: getattr(seen.one.state.mapped, quantity).T,
                limits=lambda seen: (floor, seen.data.highest(quantity)),
            ),
        ),
        Axis("load", "N"),
        title=title,
    )  # fmt: skip


def _keys(seen: Seen) -> str:
    data, asked = seen.data.data, seen.asked
    keys = "; ".join(keys_of(data.design.found[seen.one.label].relief, data.pair, asked.gears))
    return f"Pair {asked.name}, {seen.one.label}: keys of the gears: {keys or 'none'}."


_UNDER = "{d.load:.5g} N"

FLANK_DESIGN_SHEET = Sheet(
    of=FlanksShown,
    tables=(
        TOPOGRAPHY,
        Rows(
            "flank_designs_{name}", "Flank modifications of pair {name} and remaining transmission error",
            (
                "relief", *(column for key in _JUDGED for column in _judged(key)), *map(_ground, _GROUND),
                _searched("candidates"), _searched("exact"), _searched("value_on_grid", 0.0),
                _searched("quick_error", 0.0),
                Cell("proven", lambda seen: [float(way.best is None or way.best.proven) for way in seen.data.ways],
                     lambda seen: next(iter(seen.data.design.found.values()))),
            ),
            of="ways",
        ),
        Rows(
            "flank_map_{name}", "Reliefs of pair {name} over misalignment and load",
            ("relief", *(f"state.mapped.{key}" for key in _JUDGED[:3])), stacked="ways", on=("over_face", "load"),
        ),
        Rows(
            "flank_design_roll_{name}", "Transmission error of pair {name} at the design load",
            (
                Cell("roll", "design.roll", lambda _: ContactLines),
                Cell("te", name="te_{one.word}", meaning="with {one.relief}", each="ways"),
            ),
        ),
    ),
    values=("topography_depth", Each("ways", *map(_judged_value, _JUDGED))),
    figures=(
        Chart(
            "flank_topography_{name}", "Flank modification of pair {name}",
            "Pair {name}: total modification of both gears over roll angle of {d.driver} (driver, tip at right) "
            "and face width. Exact topography: zero transmission error at the design load; others: best grindable "
            "modifications.",
            (
                Over(
                    _roll_axis, (Map("removal", "z", "roll_angle", limits=lambda seen: seen.data.deepest),),
                    Axis("face position z", "mm"), title="{one.relief}",
                ),
            ),
            views="drawn", view="{one.relief}", under=_UNDER,
        ),
        Chart(
            "flank_charts_{name}", "Profile and lead charts of pair {name}",
            "Pair {name}: relief of both gears together in three sections across the axis (profile) and on three "
            "diameters of {d.driver} (lead), as in a gear inspection report, relative to the highest point.",
            (
                Each(
                    "drawn",
                    _sections("profiles", _roll_axis, "roll", "{one.relief}: profile"),
                    _sections("leads", _face_axis, "z", "{one.relief}: lead"),
                ),
            ),
            columns=2, under=_UNDER,
        ),
        Chart(
            "flank_designs_{name}", "Transmission error with each modification, pair {name}", _beside_caption,
            (
                _beside(
                    Axis("transmission error, peak to peak", "um", log=True), "peak_to_peak", "mean",
                    "mean over the scatter", "series:1",
                ),
                _beside(Axis("K_{Hβ}"), "factor", "worst", "95th percentile of the scatter", "series:3"),
            ),
            of="left", columns=2, under=_UNDER,
        ),
        Chart(
            "flank_design_roll_{name}", "Transmission error of pair {name} with each relief",
            "Pair {name}: transmission error minus mean over a base pitch, at mesh positions not used in the design. "
            "Legend: peak to peak.",
            (
                Each(
                    "by_size",
                    Over(
                        Axis("mesh position", "mm"),
                        (
                            Line(
                                "minus_mean", lambda seen: f"{seen.one.relief}: {seen.one.left * 1e6:.3g} µm",
                                lambda seen: "no relief" if seen.one.unrelieved else "", x="roll",
                                each=Family("ways", most=100), look={"markers": False},
                            ),
                        ),
                        title="{one.title}",
                    ),
                ),
            ),
            under=_UNDER,
        ),
        Chart(
            "flank_map_{name}", "Pair {name} over misalignment and load",
            "Pair {name}: transmission error, peak to peak, and K_Hβ over misalignment and load with each relief; "
            "design load {d.load:.5g} N.",
            (
                _tiles("peak_to_peak", "peak to peak", "{one.relief}: transmission error", 0.0),
                _tiles("face_load_factor", "K_{Hβ}", "{one.relief}: K_{{Hβ}}", 1.0),
            ),
            views="mapped", view="{one.relief}", columns=2,
        ),
    ),
    remarks=(
        Remark(_keys, each=lambda seen: (seen.data.design.best, *seen.data.design.robust)),
        Remark(
            "Pair {name}: shaft deflection is kept at that of the present flanks during the design; rerun with the "
            "designed modification to update it.",
            when="data.on_shafts",
        ),
        Remark(
            "Pair {name}: {d.unproven}: too many combinations come so near the least that not all of them "
            "were computed exactly; the optimum is likely but not proven. A coarser grid can be proven.",
            when="unproven",
        ),
    ),
    settings={
        "design_load": "load",
        "design_contact_ratio": lambda seen: (
            seen.data.design.task.loading.over_path.length / seen.data.design.task.loading.over_path.base_pitch
        ),
        "slope": "design.task.loading.over_path.ramp.slope",
        "end_length": "design.task.loading.end_length",
        "positions": "design.task.positions",
        "combinations": lambda seen: sum(best.candidates for best in seen.data.design.found.values()),
        "loaded_exactly": lambda seen: sum(best.exact for best in seen.data.design.found.values()),
    },
)  # fmt: skip
