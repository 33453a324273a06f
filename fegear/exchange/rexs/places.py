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
    from fegear.exchange.rexs.said import Frame, Said, Vector

GEARS = ("cylindrical_gear", "ring_gear")
BEVEL = "bevel_stage"
BEARINGS = (
    "concept_bearing",
    "rolling_bearing_with_catalog_geometry",
    "rolling_bearing_with_detailed_geometry",
    "slide_bearing",
    "hydrodynamic_radial_plain_bearing",
)
COUPLINGS = ("coupling", "switchable_coupling")
#: What joins a hub to its shaft.
HUBS = (
    "cylindrical_interference_fit", "tapered_interference_fit", "feather_key_connection", "involute_spline_connection",
)  # fmt: skip
#: Most stages of a model, far more than a gearbox has.
_MOST_STAGES = 200
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
        If a stage lacks a gear, or there is none at all, or far more than a gearbox has.
    """
    found = []
    every = said.model.of("cylindrical_stage")
    if len(every) > _MOST_STAGES:
        raise InputError(
            "cylindrical_stage", f"{len(every)} of them", f"exceed the maximum of {_MOST_STAGES}",
            "export a part of the gearbox",
        )  # fmt: skip
    for stage in every:
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
        what = f"has only {', '.join(others)}" if others else "has no stage"
        raise InputError("cylindrical_stage", "(none)", what, "specify a model with cylindrical gears in mesh")
    return found


def bevels_of(said: Said) -> list[Stage]:
    """Bevel stages on shafts: a case has none, but what flows through the gearbox flows through them."""
    found = []
    for stage in said.model.of(BEVEL):
        one, two = (said.linked(stage, "stage", "stage", role, "bevel_gear")[:1] for role in ("gear_1", "gear_2"))
        if one and two and shaft_of(said, one[0]) and shaft_of(said, two[0]):
            found.append(Stage(stage, (one[0], two[0])))
    return found


def shaft_of(said: Said, part: Component) -> Component | None:
    """The shaft that a gear or a load stands on, as its part or by a fit, key or spline."""
    own = said.linked(part, "part", "assembly", "assembly", "shaft")
    if not own:
        hubs = said.linked(part, "outer_part", "side", "assembly", *HUBS)
        own = [shaft for hub in hubs for shaft in said.linked(hub, "assembly", "side", "inner_part", "shaft")]
    return next(iter(own), None)


def turn_to_axes(said: Said, stages: Iterable[Stage]) -> None:
    """Turn the model so that the shafts of its cylindrical stages run along u; shafts without such gears may not."""
    shafts = [shaft for stage in stages for gear in stage.gears if (shaft := shaft_of(said, gear)) is not None]
    axes = [axis for shaft in shafts if (axis := said.vector(shaft, "u_axis_vector")) is not None and any(axis)]
    if axes and _off_u(axes[0]) > _PARALLEL:
        said.turn = _frame(axes[0], None)
        said.notes.append(f"Model rotated: the axis of {shafts[0].said} is along u.")
    carrying = {shaft.id for shaft in shafts}
    for shaft in said.model.of("shaft"):
        axis = said.vector(shaft, "u_axis_vector")
        if shaft.id not in carrying and axis is not None and _off_u(axis) > _PARALLEL:
            said.across.add(shaft.id)


def own_axes(said: Said, shaft: Component) -> Frame:
    """The axes of a shaft that is parallel to the gearbox: unit vectors along its own u, v and w."""
    u = (-1.0 if direction(said, shaft) else 1.0, 0.0, 0.0)
    return _frame(u, said.vector(shaft, "w_axis_vector") or (0.0, 0.0, u[0]))


def _frame(axis: Vector, beside: Vector | None) -> Frame:
    """Unit vectors: along an axis, across it, and across it in its plane with another vector."""
    u = _unit(axis)
    if beside is None or math.hypot(*_cross(beside, u)) <= _PARALLEL * math.hypot(*beside):
        beside = tuple(float(n == min(range(3), key=lambda m: abs(u[m]))) for n in range(3))  # type: ignore[assignment]  # three numbers
    v = _unit(_cross(beside, u))  # type: ignore[arg-type]  # as above
    return u, v, _cross(u, v)


def _unit(one: Vector) -> Vector:
    length = math.hypot(*one)
    return one[0] / length, one[1] / length, one[2] / length


def _cross(a: Vector, b: Vector) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _off_u(axis: Vector) -> float:
    length = math.hypot(*axis)
    return math.hypot(axis[1], axis[2]) / length if length else math.inf


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
    for coupling in said.model.of(*COUPLINGS, *HUBS):
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
    """Whether a shaft's own u runs against that of the gearbox; one across it counts by its own u.

    Raises
    ------
    InputError
        If its axis is not parallel to the gearbox's.
    """
    if shaft.id in said.across:
        return False
    axis = said.vector(shaft, "u_axis_vector") or (1e-3, 0.0, 0.0)
    if _off_u(axis) > _PARALLEL:
        raise InputError(
            "u_axis_vector", " ".join(f"{one * 1e3:.6g}" for one in axis),
            f"of {shaft.said} is not parallel to the other shafts with cylindrical gears",
            "only parallel shafts are supported",
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


def joints_of(said: Said, shaft: Component) -> tuple[float, ...]:
    """Where torque enters or leaves a shaft through other parts: couplings to shafts and bevel gears [m]."""
    found = []
    for side, other, name in (("inner_part", "outer_part", "inner"), ("outer_part", "inner_part", "outer")):
        for joint in said.linked(shaft, side, "side", "assembly", *COUPLINGS):
            turns = said.linked(joint, "assembly", "side", other, "shaft")
            if turns and said.yes(joint, "is_engaged") is not False:
                found.append(said.number(joint, "length", f"u_coordinate_on_shaft_{name}_side"))
    bevels = said.linked(shaft, "assembly", "assembly", "part", "bevel_gear")
    found += [middle_on_shaft(said, gear, shaft) for gear in bevels]
    return tuple(at for at in found if at is not None)


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
        if at is not None and shaft.id not in said.across:
            found[shaft.id] = Place(*at, reversed=direction(said, shaft))
    left = list(stages)
    while left:
        stage = next((one for one in left if _placed(said, one, found)), left[0])
        left.remove(stage)
        _place_stage(said, stage, found, middles)
    return found


def distance_of(said: Said, stage: Stage) -> float | None:
    """Centre distance of a stage [m], above zero: its own, else that of both shafts' axes; None without either."""
    given = _own_distance(said, stage)
    shafts = [shaft_of(said, gear) for gear in stage.gears]
    at = [said.vector(shaft, "support_vector") for shaft in shafts if shaft is not None]
    if given is not None or len(at) < 2 or at[0] is None or at[1] is None:
        return given
    return math.hypot(at[0][1] - at[1][1], at[0][2] - at[1][2]) or None


def _own_distance(said: Said, stage: Stage) -> float | None:
    """The centre distance that a stage gives [m], above zero: that of a ring is written with either sign.

    Raises
    ------
    InputError
        If it is zero, or below zero without a ring.
    """
    given = said.number(stage.component, "length", "center_distance")
    if given is None or given > 0.0 or (given < 0.0 and stage.internal):
        return None if given is None else abs(given)
    rule = f"of {stage.component.said} must be positive"
    raise InputError("center_distance", f"{given * 1e3:.6g} mm", rule, "correct the value")


def _placed(said: Said, stage: Stage, found: dict[int, Place]) -> bool:
    return any((shaft := shaft_of(said, gear)) is not None and shaft.id in found for gear in stage.gears)


def _place_stage(said: Said, stage: Stage, found: dict[int, Place], middles: dict[int, float]) -> None:
    """Put the shafts of a stage at its centre distance."""
    shafts = [shaft_of(said, gear) for gear in stage.gears]
    first, second = shafts
    if first is None or second is None:
        return
    distance = _own_distance(said, stage)
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
                f"of {stage.component.said} contradicts the distance of its shafts, {apart * 1e3:.6g} mm",
                "correct the support vectors or the distance",
            )  # fmt: skip
        grown = distance / apart
        found[second.id] = Place(
            two.u, one.v + grown * (two.v - one.v), one.w + grown * (two.w - one.w), two.reversed
        )  # fmt: skip
        return
    if distance is None:
        raise InputError(
            "center_distance", "(not given)", f"is missing in {stage.component.said}, whose shafts have no position",
            "complete the model in its source program",
        )  # fmt: skip
    back = first.id not in found
    known, new = (second, first) if back else (first, second)
    angle = (turn or 0.0) + (math.pi if back else 0.0)
    at = found[known.id]
    gears = stage.gears[::-1] if back else stage.gears
    turned = direction(said, new)
    face = at.u + middles.get(gears[0].id, 0.0) * (-1.0 if at.reversed else 1.0)
    start = face - middles.get(gears[1].id, 0.0) * (-1.0 if turned else 1.0)
    said.notes.append(f"{new.said}: no support_vector; positioned by {stage.component.said}.")
    found[new.id] = Place(start, at.v + distance * math.sin(angle), at.w + distance * math.cos(angle), turned)
