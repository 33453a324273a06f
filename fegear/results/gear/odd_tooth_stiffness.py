"""Result ``odd-tooth-stiffness``: how stiff a cracked tooth is along its flank, and the teeth beside it."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.base.arrays import Array, Index
from fegear.base.printed import percent
from fegear.base.shown import shown
from fegear.case.built.odd_gears import cracked_gears
from fegear.case.built.odd_teeth import OddTeeth, odd_teeth_of
from fegear.engine.citation import citing
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import DeferredFigure, Figure
from fegear.engine.figure.items import edges, outline
from fegear.engine.figure.panel import Panel
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Family, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Every, Off, Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.fem.alike_teeth import meshing_order
from fegear.geometry.outline import tooth_outline
from fegear.results.forecasts import HERTZ, PATCH
from fegear.results.gear.odd_gear import CRACKS, needs_odd_solution, odd_solution_of

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.reading import Scene
    from fegear.engine.sheet.seen import Seen
    from fegear.fem.plane.odd.crack import Crack
    from fegear.fem.plane.odd.odd_gear import OddGearInfluence
    from fegear.geometry.gear import Gear
    from fegear.geometry.pair import Member

#: Load positions over the flank, without its outermost ends where the pressed band is narrow.
_POSITIONS, _FROM, _TO = 41, 0.02, 0.98
#: Seconds of them.
_SECONDS = 0.3


@dataclass(frozen=True)
class OddTooth:
    """A tooth that answers otherwise than the ordinary ones, over load positions on its flank, shape (P,)."""

    number: int
    cracked: bool
    c_self_error: Array
    c_next_error: Array
    tooth: Index = shown("", "number of the tooth in meshing order", table="odd")
    radius: Array = shown("mm", "radius of the load", table="odd")
    roll_angle: Array = shown("deg", "roll angle of the load", table="odd")
    c_self: Array = shown("um.mm/N", "self-compliance c_0 of the tooth", table="odd")
    c_self_ordinary: Array = shown("um.mm/N", "self-compliance c_0 of an ordinary tooth", table="odd")
    stiffness: Array = shown(
        "N/(mm.um)", "stiffness of the tooth per face width, 1 / c_0", label="stiffness", table="odd"
    )
    stiffness_loss: Array = shown(
        "%", "loss of stiffness compared with an ordinary tooth", label="loss of stiffness", table="odd"
    )
    c_prev: Array = shown("um.mm/N", "deflection of the previous tooth (in meshing order) per line load", table="odd")
    c_next: Array = shown("um.mm/N", "deflection of the next tooth (in meshing order) per line load", table="odd")
    contact_half_width: Array = shown("mm", "half-width of the contact", table="odd")

    @property
    def label(self) -> str:
        """In the legend."""
        return f"tooth {self.number}, cracked" if self.cracked else f"tooth {self.number}"


@dataclass(frozen=True)
class LargestLoss:
    """The largest loss of a cracked tooth, and where."""

    tooth: int
    error: float
    stiffness_loss: float = shown("%", "maximum loss of tooth stiffness")
    radius: float = shown("mm", "radius of the load")


@dataclass(frozen=True)
class OddTeethData:
    """All teeth of a gear that answer otherwise than ordinary ones, in meshing order."""

    gear: Gear
    teeth: tuple[OddTooth, ...]
    influence: OddGearInfluence = field(repr=False)

    @property
    def faces(self) -> str:
        """Of its cracks, in words."""
        fine = self.influence.fine
        closing = {near in fine.closing for near, kind in fine.odd.items() if kind.cracked}
        return "open and closing" if len(closing) > 1 else "closing" if True in closing else "open"

    @property
    def largest(self) -> dict[str, LargestLoss]:
        """Of each cracked tooth."""
        found = {}
        for one in self.teeth:
            if one.cracked:
                i = int(np.argmax(one.stiffness_loss))
                # 1 - c / c_odd: the errors of both compliances are of one kind and of one sign.
                off = float(one.c_self_error[i] / one.c_self[i] * (1.0 - one.stiffness_loss[i]))
                found[str(one.number)] = LargestLoss(
                    one.number, off, float(one.stiffness_loss[i]), float(one.radius[i])
                )
        return found


def _compute(asked: OddTeeth, upstream: Upstream, _work: Work) -> OddTeethData:
    known = odd_solution_of(upstream, asked.name)
    gear, plain = known.gear, known.ordinary
    low, high = gear.involute_radii
    low, high = max(low, plain.lowest_radius), min(high, plain.highest_radius)
    first, last = (float(np.sqrt(max((r / gear.base_radius) ** 2 - 1.0, 0.0))) for r in (low, high))
    roll = first + (last - first) * np.linspace(_FROM, _TO, _POSITIONS)
    radius = gear.base_radius * np.hypot(1.0, roll)
    half = np.full(radius.shape, plain.reference_half_width)
    ordinary = plain.self_compliance(radius, half)
    teeth, cracked = [], {tooth for tooth, _ in asked.cracks}
    # The next tooth in meshing order is behind on a driving gear, ahead on a driven one.
    ahead = -1 if asked.member == "driver" else 1
    other = {known.from_middle(number) for number in asked.by_number(gear.teeth)} - {
        known.from_middle(meshing_order(tooth, gear.teeth, asked.member)) for tooth in cracked
    }
    for near in known.touched:
        if near in other:  # missing or shorter: not what the result is about
            continue
        number = known.middle + near
        own = known.own(number, radius, half)
        prev, next_ = (_beside(known, number, k * ahead, radius) for k in (-1, 1))
        order = meshing_order(number, gear.teeth, asked.member)
        teeth.append(
            OddTooth(
                order, order in cracked, known.own_error(number, radius, half), np.maximum(prev[1], next_[1]),
                np.full(radius.size, order), radius, roll, own, ordinary, 1.0 / own, 1.0 - ordinary / own, prev[0],
                next_[0], half,
            )
        )  # fmt: skip
    return OddTeethData(gear, tuple(teeth[::ahead]), known)


def _beside(known: OddGearInfluence, number: int, k: int, radius: Array) -> tuple[Array, Array]:
    """Deflection of a tooth's k-th neighbour at the radius of the load, and its estimated error, shape (P,)."""
    there = number + k
    if known.from_middle(there) in known.fine.missing:
        return np.zeros(radius.shape), np.zeros(radius.shape)
    if known.from_middle(there) in known.known:
        seen = np.minimum(radius, known.ends(known.from_middle(there))[1])
        both = known.between(there, number, seen, radius), known.between_error(there, number, radius, radius)
    else:
        both = known.ordinary.neighbour_with_error(k, radius, radius)
    return np.diagonal(both[0]), np.diagonal(both[1])


def _drawing(seen: Seen) -> Iterator[DeferredFigure]:
    """Every cracked tooth with its crack and its mesh."""
    for tooth, crack in seen.asked.cracks:
        draw = partial(crack_figure, seen.name, seen.data.influence, tooth, crack, seen.asked.member)
        yield DeferredFigure(f"crack_{seen.name}_{tooth}", f"Crack of tooth {tooth} of gear {seen.name}", draw)


def crack_figure(name: str, known: OddGearInfluence, tooth: int, crack: Crack, member: Member) -> Figure:
    """A cracked tooth and the mesh around its crack."""
    gear, m = known.gear, known.gear.module * 1e3
    mesh = known.fine.odd[known.from_middle(meshing_order(tooth, gear.teeth, member))].mesh
    shape, path = tooth_outline(gear.symmetric_tooth) * m, crack.path(gear.symmetric_tooth) * m
    points, t = mesh.points * m, mesh.triangles
    sides = np.hstack([t[[a, b, c]] for a, b, c in ((0, 3, 1), (1, 4, 2), (2, 5, 0))])
    sides = sides[:, np.unique(sides[1], return_index=True)[1]]
    height, tip = float(np.ptp(shape[1])), path[:, -1]
    half, near = 0.75 * max(height, float(np.ptp(shape[0]))), 1.3 * crack.length(gear.symmetric_tooth) * m
    middle = float(shape[1].max()) - 0.6 * height

    line = outline(path, f"crack, {crack.length(gear.symmetric_tooth) * m:.4g} mm", "red", width=2.2)
    return Figure(
        f"crack_{name}_{tooth}",
        f"Crack of tooth {tooth} of gear {name}",
        f"Gear {name}: crack of tooth {tooth} (number in meshing order), "
        f"{crack.length(gear.symmetric_tooth) * m:.4g} mm long, loaded flank on the right; FE mesh around the crack, "
        "quarter-point elements at its tip.",
        (
            Panel(
                Axis("x", "mm", limits=(-half, half)), Axis("y", "mm", limits=(middle - half, middle + half)),
                (outline(shape, "tooth", "outline", width=2.0), line), title="Cracked tooth", equal=True,
                height=1.5,
            ),
            Panel(
                Axis("x", "mm", limits=(tip[0] - near, tip[0] + near)),
                Axis("y", "mm", limits=(tip[1] - near, tip[1] + near)),
                (outline(edges(points, sides), "element", "grey", width=0.4), line),
                title="Mesh around the crack", equal=True, height=1.5,
            ),
        ),
        columns=2,
    )  # fmt: skip


def answer(data: OddTeethData, name: str) -> str:
    """The answer in one sentence."""
    worst = max(data.largest.values(), key=lambda one: one.stiffness_loss)
    beside = max((one for one in data.teeth if not one.cracked), key=lambda one: float(one.stiffness_loss.max()))
    return (
        f"Gear {name}: the crack lowers the stiffness of tooth {worst.tooth} by up to "
        f"{percent(worst.stiffness_loss)} (load at radius {worst.radius * 1e3:.4g} mm), of tooth {beside.number} "
        f"next to it by up to {percent(float(beside.stiffness_loss.max()))}."
    )


def _first(seen: Seen) -> OddTooth:
    return cast("OddTeethData", seen.data).teeth[0]


_SHEET = Sheet(
    tables=(
        Rows(
            "odd_tooth_stiffness_{name}", "Stiffness of the cracked teeth of gear {name} and of their neighbours",
            (Every("odd"), Off("c_self", "c_self_error"), Off("c_next", "c_next_error")), stacked="teeth",
        ),
    ),
    values=(
        Number(
            "stiffness_loss", "error", each="largest", name="stiffness_loss_tooth_{key}",
            further=", load at radius {one.radius:.5g}",
        ),
    ),
    figures=(
        _drawing,
        Chart(
            "odd_tooth_stiffness_{name}", "Stiffness of the teeth of gear {name}",
            "Gear {name}: stiffness of single teeth over the load position, complete ring, and its loss compared with "
            "an ordinary tooth. Numbers in meshing order; {d.faces} crack faces.",
            (
                Over("roll_angle", (Line("stiffness", each=Family("teeth", "{one.label}")),), of=_first),
                Over("roll_angle", (Line("stiffness_loss", each=Family("teeth", "{one.label}")),), of=_first),
            ),
        ),
    ),
    answer=Answer(
        lambda seen: [answer(seen.data, seen.name)], figure="odd_tooth_stiffness_{name}",
        rank=lambda seen: -max(one.stiffness_loss for one in seen.data.largest.values()),
        among="the largest of {count} gears",
    ),
)  # fmt: skip


def _forecast(_scene: Scene, _name: str) -> Forecast:
    return Forecast({"positions": _POSITIONS}, _SECONDS)


ODD_TOOTH_STIFFNESS = Stage(
    subjects=cracked_gears,
    needs=lambda _scene, name: needs_odd_solution(name),
    inputs=odd_teeth_of,
    compute=_compute,
    present=_SHEET.present,
    cites=citing(*CRACKS, PATCH, HERTZ),
    forecast=_forecast,
)
