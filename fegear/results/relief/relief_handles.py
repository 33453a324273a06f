"""The relief of a gear as it is changed by hand: its curve over the roll angle, and the points that can be moved."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Literal

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import InputError
from fegear.base.shown import shown
from fegear.case.built.flank_modifications import described_relief
from fegear.case.built.members import gear_name
from fegear.case.reading import Scene
from fegear.case.relief import STARTS as STARTS  # noqa: PLC0414  (for the window)
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.seen import Seen
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.geometry.path_of_contact import active_profile
from fegear.geometry.relief import CombinedRelief, Crowning, EndRelief, Relief
from fegear.results.gear.path_marks import roll_marks

#: Parts of a relief that can be moved, in the order in which `ReliefSpec.built` takes them.
ENDS: tuple[Literal["tip"], Literal["root"], Literal["crowning"]] = ("tip", "root", "crowning")
#: Places at which the curve is drawn, and the least height of its axis [um].
_PLACES, _LEAST = 201, 20.0


@dataclass(frozen=True, slots=True)
class Handle:
    """A part of a relief that can be moved.

    Parameters
    ----------
    end : {"tip", "root", "crowning"}
    index : int
        Which of several of that kind, as the case lists them.
    start, at : float
        Where it starts and where its amount is measured [deg]; a crowning's ends.
    amount : float
        [um].
    power : float
        Of the removal over the way from its start, or of a crowning from its middle.
    base_radius : float
        Of the gear [mm].
    """

    end: Literal["tip", "root", "crowning"]
    index: int
    start: float
    amount: float
    at: float
    power: float
    base_radius: float


@dataclass(frozen=True, slots=True)
class HandledRelief:
    """The relief of one gear of a pair.

    Parameters
    ----------
    gear : str
    low, high : float
        Roll angles of the active profile [deg].
    usual : dict
        For each end, where a relief usually starts: the highest or lowest point of single contact [deg].
    handles : tuple of Handle
        Tip and root reliefs and crownings.
    figure : Figure
    """

    gear: str
    low: float
    high: float
    usual: dict[str, float]
    handles: tuple[Handle, ...]
    figure: Figure


@dataclass(frozen=True)
class _Drawn:
    """The relief of a gear over the active profile, and the points that can be moved."""

    gear: str
    member: Member
    pair: GearPair
    roll: Array = shown("deg", "roll angle")
    removal: Array = shown("um", "removal")
    places: Array = shown("deg", "roll angle")
    amounts: Array = shown("um", "removal")

    @property
    def section(self) -> str:
        """Which section it is of, where that has to be said."""
        return " in any transverse section" if self.pair.driver.helix_angle else ""

    @property
    def movable(self) -> str:
        """What can be done with the points, where there are any."""
        return " The points can be moved." if self.places.size else ""

    @property
    def along(self) -> Axis:
        """With room at both ends."""
        low, high = np.degrees(self.roll[[0, -1]]).tolist()
        room = 0.06 * (high - low)
        return Axis("roll angle", "deg", limits=(low - room, high + room))

    @property
    def across(self) -> Axis:
        """To above all that is drawn."""
        top = max(_LEAST, 1.25e6 * float(max(self.removal.max(), *self.amounts, 0.0)))
        return Axis("removal", "um", limits=(-0.06 * top, top))


_FIGURE = Chart(
    "relief_of_{name}_{d.member}",
    "Relief of gear {d.gear}",
    "Modification of the {d.member} flanks over the active profile{d.section}; A to E: points of the path of "
    "contact.{d.movable}",
    (
        Over(
            lambda seen: seen.data.along,
            (
                Line("removal", role="designed", x="roll", look={"markers": False}),
                Line(
                    "amounts", role="ink", x="places", kind="points", look={"symbol": "circle", "size": 9.0},
                    when="places",
                ),
            ),
            lambda seen: seen.data.across,
            marks=lambda seen: roll_marks(seen.data.pair, seen.data.member),
        ),
    ),
)  # fmt: skip


def handled_relief(scene: Scene, name: str, member: Member) -> HandledRelief:
    """The relief of a gear of a pair, ready to be changed by hand.

    Parameters
    ----------
    scene : Scene
    name : str
        Of the pair.
    member : {"driver", "driven"}
    """
    pair, gear = scene.pairs[name], gear_name(scene, name, member)
    first, last = sorted(float(pair.roll_angle(x, member)) for x in (pair.x_start, pair.x_end))
    relief, roll = _relief(scene, gear), np.linspace(first, last, _PLACES)
    removal = np.zeros(_PLACES) if relief is None else relief.removal(roll)
    handles = tuple(_handles(scene, gear, relief))
    points = [(one.start, 0.0) for one in handles if one.end != "crowning"] + [(one.at, one.amount) for one in handles]
    places, amounts = np.array(points).reshape(-1, 2).T
    drawn = _Drawn(gear, member, pair, roll, removal, np.radians(places), amounts * 1e-6)
    (figure,) = _FIGURE.figures(Seen(drawn, name=name))
    ends = math.degrees(first), math.degrees(last)
    alone = active_profile(pair, member)
    usual = {
        end: math.degrees(float(_roll(scene, gear, radius)))
        for end, radius in (("tip", alone.highest_single), ("root", alone.lowest_single))
        if math.isfinite(radius)
    }
    middle = 0.5 * (ends[0] + ends[1])
    return HandledRelief(gear, ends[0], ends[1], {"tip": middle, "root": middle} | usual, handles, figure)


def _relief(scene: Scene, gear: str) -> Relief | None:
    try:
        return described_relief(scene, gear).relief
    except InputError:  # refused where it counts; the case's own sentence is reported then
        return None


def _roll(scene: Scene, gear: str, radius: float) -> float:
    one = scene.gears[gear]
    return one.tooth.side * math.sqrt(max((radius / one.base_radius) ** 2 - 1.0, 0.0))


def _handles(scene: Scene, gear: str, relief: object) -> list[Handle]:
    part = scene.case.gear[gear].relief  # whose handles move this key
    if part is None or scene.gears[gear].asymmetric or not isinstance(relief, CombinedRelief):
        return []
    kinds: list[tuple[Literal["tip", "root", "crowning"], int]] = []
    for end in ENDS:
        kinds += [(end, index) for index in range(len(getattr(part, end)))]
    found = [one for one in relief.parts if isinstance(one, (EndRelief, Crowning))]  # in the order of the keys
    return [
        Handle(
            end, index, math.degrees(one.start), one.amount * 1e6, math.degrees(one.end),
            one.power if isinstance(one, EndRelief) else 2.0, scene.gears[gear].base_radius * 1e3,
        )
        for (end, index), one in zip(kinds, found, strict=True)
    ]  # fmt: skip


def handle_of(scene: Scene, gear: str, end: str, index: int) -> Handle | None:
    """One part of the relief of a gear as a case has it; None where it has no such part, or no pair has the gear."""
    if not any(gear_name(scene, name, member) == gear for name in scene.pairs for member in MEMBERS):
        return None
    found = _handles(scene, gear, _relief(scene, gear))
    return next((one for one in found if (one.end, one.index) == (end, index)), None)


def start_as_given(given: Mapping[str, object], handle: Handle | None, start: float) -> tuple[str, str]:
    """The key that says where a part of a relief starts, and what a case writes there; the key stays what it was.

    Parameters
    ----------
    given : mapping
        Keys of the part in the case.
    handle : Handle or None
        The part as it is; None for a new one.
    start : float
        Where it shall start [deg].
    """
    if handle is not None:
        on = math.radians(start)
        if "start_radius" in given:
            return "start_radius", f'"{math.hypot(1.0, on) * handle.base_radius:.4f} mm"'
        if "length" in given:
            return "length", f'"{abs(math.radians(handle.at) - on) * handle.base_radius:.4f} mm"'
        if "normalised_length" in given:
            share = (handle.at - start) / (handle.at - handle.start)
            return "normalised_length", f"{float(str(given['normalised_length'])) * share:.5g}"
    return "start_roll_angle", f'"{start:.3f} deg"'
