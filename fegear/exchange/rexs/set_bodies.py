"""Where the planets of a REXS set stand, what holds its members, and what its carrier weighs.

REXS draws with u along the gearbox; a case looks from +z = u on x = v and y = w, so that planets are counted
counter-clockwise from v to w.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.exchange.case_tables import Key, inline, listed, quantity, text
from fegear.exchange.rexs.places import BEARINGS, COUPLINGS, distance_of, shaft_of
from fegear.exchange.rexs.said import RIGID
from fegear.exchange.rexs.shafts import sections_of
from fegear.exchange.rexs.teeth import teeth_of

if TYPE_CHECKING:
    from collections.abc import Iterable

    from fegear.exchange.rexs.flow import Flow
    from fegear.exchange.rexs.model import Component
    from fegear.exchange.rexs.places import Stage
    from fegear.exchange.rexs.planetary import Planetary
    from fegear.exchange.rexs.said import Said

#: Planets may stand so far off the places that the teeth allow, by the step of these, as lengths are rounded.
_ROUNDED = 0.02
#: By so much of the centre distance a planet may stand elsewhere than its stage says, and pins may differ.
_APART = 1e-3
#: Where nothing is said of a material [kg/m^3].
_STEEL = 7850.0
_MEMBERS = ("sun", "ring", "carrier")


def planet_keys(said: Said, one: Planetary, stages: list[Stage]) -> list[Key]:
    """``planets`` or ``angles``, and ``centre_distance``.

    Raises
    ------
    InputError
        If planets stand elsewhere than at the centre distance, or two of them in one place.
    """
    mine = [stage for stage in stages if stage.component.id in one.stages and not stage.internal]
    distance = distance_of(said, mine[0])
    placed = [_angle(said, one, stage, distance) for stage in mine]
    keys = _spacing(said, one, placed)
    if distance is not None:
        keys.append(Key("centre_distance", quantity(distance, "mm"), f"of {mine[0].component.said}"))
    return keys


def _angle(said: Said, one: Planetary, stage: Stage, distance: float | None) -> float | None:
    """Angle of the planet of a stage about the sun [rad]: by both shafts, else by the stage; None where not said."""
    planet = next(gear for gear in stage.gears if gear.id != one.sun.id)
    shafts = shaft_of(said, one.sun), shaft_of(said, planet)
    there = [None if shaft is None else said.vector(shaft, "support_vector") for shaft in shafts]
    frames = {said.word(shaft, "reference_component_for_position") for shaft in shafts if shaft is not None}
    sun, own = there
    if sun is not None and own is not None and len(frames) == 1:
        v, w = own[1] - sun[1], own[2] - sun[2]
        apart = math.hypot(v, w)
        if apart > 0.0:
            if distance is not None and abs(apart - distance) > _APART * distance:
                raise InputError(
                    "center_distance", f"{distance * 1e3:.6g} mm",
                    f"of {stage.component.said} contradicts the distance of its shafts, {apart * 1e3:.6g} mm",
                    "correct the support vectors or the distance",
                )  # fmt: skip
            return math.atan2(w, v)
    turn = said.number(stage.component, "angle", "rotating_angle_around_neg_u_axis")
    if turn is None:
        return None
    # The angle counts from w toward v where gear_1 is the sun, and back where it is the planet.
    return 0.5 * math.pi - turn + (0.0 if stage.gears[0].id == one.sun.id else math.pi)


def _spacing(said: Said, one: Planetary, placed: list[float | None]) -> list[Key]:
    count = len(one.planets)
    even = Key("planets", str(count), "equal spacing assumed (positions not specified)")
    angles = [angle for angle in placed if angle is not None]
    if len(angles) < count:
        return [even]
    first = angles[0]
    found = sorted((angle - first + 1e-9) % math.tau - 1e-9 for angle in angles)
    if count > 1 and found[-1] < 1e-6:
        said.notes.append(f"{one.component.said}: all planets at the same position; equal spacing assumed.")
        return [even]
    step = math.tau / (teeth_of(said, one.sun) + abs(teeth_of(said, one.ring)))
    off = max(abs(angle - math.tau * n / count) for n, angle in enumerate(found))
    if off <= _ROUNDED * step:
        return [Key("planets", str(count), "equally spaced, from the positions of their shafts")]
    if any(b - a < 1e-6 for a, b in pairwise(found)):
        raise InputError(one.component.said, "two planets", "are at the same position", "correct their support vectors")
    whole = [step * round(angle / step) for angle in found]
    missed = max(abs(a - b) for a, b in zip(found, whole, strict=True))
    about = "from the positions of their shafts, relative to the first planet"
    if missed <= _ROUNDED * step:
        found = whole
        about += (
            (f", corrected by at most {math.degrees(missed):.2g} deg to the assembly condition")
            if missed > 1e-9
            else ""
        )
    return [Key("angles", listed(quantity(abs(angle), "deg", 12) for angle in found), about)]


def support_keys(said: Said, one: Planetary, flow: Flow, n: int, fixed: str) -> list[Key]:
    """``stiffness`` of pins, bearings and of what holds the fixed member, and ``floating``.

    Parameters
    ----------
    said : Said
    one : Planetary
    flow : Flow
    n : int
        Number of the set.
    fixed : str
        The member that the casing holds.
    """
    keys: dict[str, str | None] = {}
    pin = _pin(said, one)
    keys["pin"] = None if pin is None else quantity(pin, "N/um")
    whole = flow.sets[n]
    supports = {role: _supports(said, getattr(whole, role), flow) for role in _MEMBERS}
    told = any(kind == "bearing" for given in supports.values() for kind, _ in given)
    loose = []
    for role, given in supports.items():
        stiffness = [size for _, size in given if size is None or size > 0.0]
        if stiffness and None not in stiffness:
            keys[role] = quantity(sum(size or 0.0 for size in stiffness), "N/um")
        elif not stiffness:
            loose.append(role)
    turning = _turning(said, getattr(whole, fixed), flow)
    keys["turning"] = None if turning is None else quantity(turning, "N*m/rad")
    found = []
    if told and len(loose) < len(_MEMBERS):
        found.append(Key("floating", listed(map(text, loose)), "members whose shafts have no radial bearing"))
    if not told or len(loose) == len(_MEMBERS):
        keys = {key: value for key, value in keys.items() if key not in _MEMBERS}
    if any(keys.values()):
        about = "radial_stiffness of bearings, those of a planet in parallel; pins themselves are rigid"
        found.append(Key("stiffness", inline(**keys), about))
    return found


def _pin(said: Said, one: Planetary) -> float | None:
    """Radial stiffness of the bearings of a planet [N/m], the mean of all planets; None where it is rigid."""
    sums = []
    for planet in one.planets:
        shaft = shaft_of(said, planet)
        bearings = [] if shaft is None else list(said.linked(shaft, "outer_part", "side", "assembly", *BEARINGS))
        given = [_radial(said, bearing) for bearing in bearings]
        soft = [size for size in given if size is not None]
        rolling = [bearing for bearing in bearings if said.linked(bearing, "assembly", "assembly", "part")]
        if rolling and len(soft) < len(given):
            said.notes.append(
                f"{one.component.said}: rolling elements of the planet bearings ignored; rigid pins assumed."
            )
        sums.append(sum(soft) if soft and len(soft) == len(given) else None)
    known = [size for size in sums if size]
    if not known or len(known) < len(sums):
        return None
    mean = sum(known) / len(known)
    if max(known) - min(known) > _APART * mean:
        said.notes.append(
            f"{one.component.said}: unequal pin stiffness; mean value {mean * 1e-6:.4g} N/um used for all."
        )
    return mean


def _radial(said: Said, one: Component) -> float | None:
    """Radial stiffness of a bearing or coupling [N/m]: zero where it holds nothing, None where it is rigid."""
    if said.yes(one, "radial_force_absorption") is False:
        return 0.0
    radial = said.number(one, "stiffness", "radial_stiffness")
    if radial is not None and radial < 0.0:
        raise InputError(
            "radial_stiffness", f"{radial:g} N/m", f"of {one.said} must not be negative", "correct the value"
        )
    if radial is None or radial >= RIGID:
        return None
    return radial if radial or one.type in COUPLINGS else None


def _supports(said: Said, body: int, flow: Flow) -> list[tuple[str, float | None]]:
    """What joins a body to the casing, and its radial stiffness."""
    found: list[tuple[str, float | None]] = []
    for shaft in said.model.of("shaft"):
        if flow.bodies[shaft.id] != body:
            continue
        for side, other in (("inner_part", "outer_part"), ("outer_part", "inner_part")):
            for one in said.linked(shaft, side, "side", "assembly", *BEARINGS, *COUPLINGS):
                mates = list(said.linked(one, "assembly", "side", other))
                if not any(mate.type == "gear_casing" for mate in mates):
                    continue
                if one.type in COUPLINGS and said.yes(one, "is_engaged") is False:
                    continue
                found.append(("coupling" if one.type in COUPLINGS else "bearing", _radial(said, one)))
    return found


def _turning(said: Said, body: int, flow: Flow) -> float | None:
    """Torsional stiffness of the couplings that hold a body [N m/rad]; None where it is rigid or not said."""
    total = 0.0
    for coupling in said.model.of(*COUPLINGS):
        sides = [
            mate for role in ("inner_part", "outer_part") for mate in said.linked(coupling, "assembly", "side", role)
        ]
        here = any(one.type == "shaft" and flow.bodies[one.id] == body for one in sides)
        if not here or not any(one.type == "gear_casing" for one in sides):
            continue
        if said.yes(coupling, "is_engaged") is False:
            continue
        size = said.number(coupling, "tilting stiffness", "rotational_stiffness")
        if size is None or not 0.0 < size < RIGID:
            return None
        total += size
    return total or None


def body_keys(said: Said, one: Planetary, distance: float | None) -> list[Key]:
    """``body`` of the carrier, from its plates, shafts and pins; none where the model gives no sizes of them."""
    mass = inertia = 0.0
    used = []
    for part, radius in _carrier_parts(said, one, distance):
        density = _density(said, part)
        for length, outer, inner in _cylinders(said, part):
            own = density * (_volume(length, *outer) - _volume(length, *inner))
            mass += own
            inertia += density * (_polar(length, *outer) - _polar(length, *inner)) + own * radius**2
            used.append(part.said)
    if not used or not (mass > 0.0 and inertia > 0.0):
        return []
    made = inline(mass=quantity(mass, "kg", 6), inertia=quantity(inertia, "kg*m^2", 6))
    return [Key("body", inline(carrier=made), f"of {', '.join(dict.fromkeys(used))}")]


def _carrier_parts(said: Said, one: Planetary, distance: float | None) -> Iterable[tuple[Component, float]]:
    """Plates, shafts and pins of a carrier, and how far from its axis each stands [m]."""
    for shaft in one.carriers:
        yield shaft, 0.0
    for carrier in said.linked(one.component, "assembly", "assembly", "part", "planet_carrier"):
        for plate in said.linked(carrier, "assembly", "assembly", "part", "side_plate"):
            yield plate, 0.0
        for pin in said.linked(carrier, "assembly", "assembly", "part", "shaft"):
            if pin.id not in {shaft.id for shaft in one.carriers}:
                yield pin, distance or 0.0


Ends = tuple[float, float]


def _cylinders(said: Said, part: Component) -> list[tuple[float, Ends, Ends]]:
    """Length, outer and inner diameters at both ends [m] of what a part is made of."""
    if part.type == "shaft":
        return [(one.length, one.outer, one.inner) for one in sections_of(said, part)]
    length, outer = (said.number(part, "length", key) for key in ("length", "outer_diameter"))
    inner = said.number(part, "length", "inner_diameter") or 0.0
    if length is None or outer is None or not 0.0 <= inner < outer or not length > 0.0:
        return []
    return [(length, (outer, outer), (inner, inner))]


def _volume(length: float, begin: float, end: float) -> float:
    """Of a cone between two diameters [m^3]."""
    return math.pi * length / 12.0 * (begin**2 + begin * end + end**2)


def _polar(length: float, begin: float, end: float) -> float:
    """Its moment of inertia about the axis over the density [m^5]."""
    return math.pi * length / 160.0 * sum(begin ** (4 - n) * end**n for n in range(5))


def _density(said: Said, part: Component) -> float:
    found = said.linked(part, "origin", "reference", "referenced", "material")
    density = said.number(found[0], "density", "density") if found else None
    return density or _STEEL
