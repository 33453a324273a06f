"""Where shafts of a REXS model stand, what is on them, and what turns together.

REXS draws with u along the gearbox; a case with z along its shafts: z = u, x = v, y = w.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fegear.exchange.rexs.model import Component
    from fegear.exchange.rexs.said import Said

GEARS = ("cylindrical_gear", "ring_gear")
BEARINGS = (
    "concept_bearing",
    "rolling_bearing_with_catalog_geometry",
    "rolling_bearing_with_detailed_geometry",
    "slide_bearing",
    "hydrodynamic_radial_plain_bearing",
)
COUPLINGS = ("coupling", "switchable_coupling")
#: Axes are parallel to so much.
_PARALLEL = 1e-6
#: By so much of the centre distance axes may stand elsewhere than a stage says.
_APART = 1e-3


@dataclass(frozen=True, slots=True)
class Place:
    """Left end of a shaft [m], along u, v and w of the gearbox, and whether its own u runs against the gearbox's."""

    u: float
    v: float
    w: float
    reversed: bool = False


@dataclass(frozen=True, slots=True)
class Stage:
    """A cylindrical stage: its component and its two gears."""

    component: Component
    gears: tuple[Component, Component]

    @property
    def internal(self) -> bool:
        """Whether one of them is a ring."""
        return any(one.type == "ring_gear" for one in self.gears)


def stages_of(said: Said) -> list[Stage]:
    """Every cylindrical stage with two gears.

    Raises
    ------
    InputError
        If a stage lacks a gear, or there is none at all.
    """
    found = []
    for stage in said.model.of("cylindrical_stage"):
        gears = [
            *said.linked(stage, "stage", "stage", "gear_1", *GEARS),
            *said.linked(stage, "stage", "stage", "gear_2", *GEARS),
        ]
        if len(gears) != 2:
            raise InputError(
                stage.said, f"{len(gears)} gears", "must have a cylindrical gear as gear_1 and one as gear_2",
                "complete its relation of type stage",
            )  # fmt: skip
        found.append(Stage(stage, (gears[0], gears[1])))
    if not found:
        others = sorted({one.type for one in said.model.components.values() if one.type.endswith("_stage")})
        what = f"has {', '.join(others)} alone" if others else "has no stage"
        raise InputError("cylindrical_stage", "(none)", what, "give a model with cylindrical gears in mesh")
    return found


def shaft_of(said: Said, part: Component) -> Component | None:
    """The shaft that a gear or a load stands on."""
    return next(iter(said.linked(part, "part", "assembly", "assembly", "shaft")), None)


def bodies_of(said: Said, joined: Iterable[tuple[Component, Component]] = ()) -> tuple[dict[int, int], set[int]]:
    """Shafts that turn together: the body of each shaft, and the bodies that couplings hold to the casing.

    Parameters
    ----------
    said : Said
    joined : iterable of two shafts
        Those that turn together for another reason.
    """
    shafts = [one.id for one in said.model.of("shaft")]
    leader = {one: one for one in shafts}

    def top(one: int) -> int:
        while leader[one] != one:
            one = leader[one]
        return one

    for one, other in joined:
        leader[top(one.id)] = top(other.id)
    held = []
    for coupling in said.model.of(*COUPLINGS):
        if said.yes(coupling, "is_engaged") is False:
            continue
        sides = [
            *said.linked(coupling, "assembly", "side", "inner_part"),
            *said.linked(coupling, "assembly", "side", "outer_part"),
        ]
        turning = [one.id for one in sides if one.type == "shaft"]
        if len(turning) == 2:
            leader[top(turning[0])] = top(turning[1])
        elif turning and any(one.type == "gear_casing" for one in sides):
            held.append(turning[0])
    numbers = {one: n for n, one in enumerate(sorted({top(shaft) for shaft in shafts}))}
    return {shaft: numbers[top(shaft)] for shaft in shafts}, {numbers[top(one)] for one in held}


def direction(said: Said, shaft: Component) -> bool:
    """Whether a shaft's own u runs against that of the gearbox.

    Raises
    ------
    InputError
        If its axis is not parallel to the gearbox's.
    """
    axis = said.vector(shaft, "u_axis_vector") or (1e-3, 0.0, 0.0)
    length = math.hypot(*axis)
    if length == 0.0 or math.hypot(axis[1], axis[2]) > _PARALLEL * length:
        raise InputError(
            "u_axis_vector", " ".join(f"{one * 1e3:.6g}" for one in axis),
            f"of {shaft.said} is not parallel to the u-axis of the gearbox", "fegear knows parallel shafts alone",
        )  # fmt: skip
    return axis[0] < 0.0


def middle_on_shaft(said: Said, gear: Component, shaft: Component) -> float | None:
    """Middle of a gear's face from the left end of its shaft, in the shaft's own sense [m]; None where nothing is said.

    The support vector of a gear is the middle of its face; ``u_coordinate_on_shaft`` is that, too, but the left end of
    the face in files of version 1.0.
    """
    at, there = said.vector(gear, "support_vector"), said.vector(shaft, "support_vector")
    same = said.word(gear, "reference_component_for_position") == said.word(shaft, "reference_component_for_position")
    along = said.number(gear, "length", "u_coordinate_on_shaft")
    if at is not None and there is not None and same:
        return (at[0] - there[0]) * (-1.0 if direction(said, shaft) else 1.0)
    if along is None:
        return None
    begins = 0.5 * said.needed(gear, "length", "face_width") if said.model.version == "1.0" else 0.0
    return along + begins


def places_of(said: Said, stages: Iterable[Stage], middles: dict[int, float]) -> dict[int, Place]:
    """Where the shafts of stages stand: as their support vectors say, else one after the other from centre distances.

    Parameters
    ----------
    said : Said
    stages : iterable of Stage
    middles : dict
        Middle of every gear's face on its shaft [m].

    Raises
    ------
    InputError
        If vectors and centre distances contradict each other.
    """
    found: dict[int, Place] = {}
    for shaft in said.model.of("shaft"):
        at = said.vector(shaft, "support_vector")
        if at is not None:
            found[shaft.id] = Place(*at, reversed=direction(said, shaft))
    left = list(stages)
    while left:
        stage = next((one for one in left if _placed(said, one, found)), left[0])
        left.remove(stage)
        _place_stage(said, stage, found, middles)
    return found


def _placed(said: Said, stage: Stage, found: dict[int, Place]) -> bool:
    return any((shaft := shaft_of(said, gear)) is not None and shaft.id in found for gear in stage.gears)


def _place_stage(said: Said, stage: Stage, found: dict[int, Place], middles: dict[int, float]) -> None:
    """Put the shafts of a stage at its centre distance."""
    shafts = [shaft_of(said, gear) for gear in stage.gears]
    first, second = shafts
    if first is None or second is None:
        return
    distance = said.number(stage.component, "length", "center_distance")
    turn = said.number(stage.component, "angle", "rotating_angle_around_neg_u_axis")
    if first.id not in found and second.id not in found:
        found[first.id] = Place(0.0, 0.0, 0.0, direction(said, first))
    if first.id in found and second.id in found:
        one, two = found[first.id], found[second.id]
        apart = math.hypot(two.v - one.v, two.w - one.w)
        if distance is None or apart == distance:
            return
        if abs(apart - distance) > _APART * distance:
            raise InputError(
                "center_distance", f"{distance * 1e3:.6g} mm",
                f"of {stage.component.said} contradicts its shafts, whose axes stand {apart * 1e3:.6g} mm apart",
                "correct the support vectors or the distance",
            )  # fmt: skip
        grown = distance / apart
        found[second.id] = Place(
            two.u, one.v + grown * (two.v - one.v), one.w + grown * (two.w - one.w), two.reversed
        )  # fmt: skip
        return
    if distance is None:
        raise InputError(
            "center_distance", "(not given)", f"is missing in {stage.component.said}, whose shafts have no places",
            "complete the model where it was made",
        )  # fmt: skip
    back = first.id not in found
    known, new = (second, first) if back else (first, second)
    angle = (turn or 0.0) + (math.pi if back else 0.0)
    at = found[known.id]
    gears = stage.gears[::-1] if back else stage.gears
    turned = direction(said, new)
    face = at.u + middles.get(gears[0].id, 0.0) * (-1.0 if at.reversed else 1.0)
    start = face - middles.get(gears[1].id, 0.0) * (-1.0 if turned else 1.0)
    said.notes.append(f"{new.said} has no support_vector: it is placed by {stage.component.said}.")
    found[new.id] = Place(start, at.v + distance * math.sin(angle), at.w + distance * math.cos(angle), turned)
