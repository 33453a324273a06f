"""Planetary stages of a REXS model: which gears are sun, planets and ring, and what carries them."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.exchange.case_tables import Key, Table, quantity, text
from fegear.exchange.rexs.drive import PlanetSet
from fegear.exchange.rexs.places import distance_of, shaft_of
from fegear.exchange.rexs.set_bodies import body_keys, planet_keys, support_keys
from fegear.exchange.rexs.teeth import teeth_of

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.exchange.rexs.loads import Flow
    from fegear.exchange.rexs.model import Component
    from fegear.exchange.rexs.places import Stage
    from fegear.exchange.rexs.said import Said


@dataclass(frozen=True, slots=True)
class Planetary:
    """A planetary stage: its stages, sun, planets and ring, and the shafts of its carrier."""

    component: Component
    stages: tuple[int, ...]
    sun: Component
    planets: tuple[Component, ...]
    ring: Component
    carriers: tuple[Component, ...]

    @property
    def planet(self) -> Component:
        """The one that stands for all in a case."""
        return self.planets[0]

    @property
    def gears(self) -> tuple[Component, Component, Component]:
        """Those that a case describes."""
        return self.sun, self.planet, self.ring


def planetary_of(said: Said, stages: list[Stage]) -> list[Planetary]:
    """Every planetary stage with one sun, one ring and planets between them.

    Raises
    ------
    InputError
        If it is another kind of set.
    """
    found = []
    for one in said.model.of("planetary_stage"):
        parts = {part.id for part in said.linked(one, "assembly", "assembly", "part", "cylindrical_stage")}
        mine = [stage for stage in stages if stage.component.id in parts]
        in_ring = {gear.id: gear for stage in mine if stage.internal for gear in stage.gears}
        rings = [gear for gear in in_ring.values() if gear.type == "ring_gear"]
        planets = [gear for gear in in_ring.values() if gear.type != "ring_gear"]
        suns = {gear.id: gear for stage in mine if not stage.internal for gear in stage.gears if gear.id not in in_ring}
        in_sun = {gear.id for stage in mine if not stage.internal for gear in stage.gears}
        if len(suns) != 1 or len(rings) != 1 or not planets or not {planet.id for planet in planets} <= in_sun:
            raise InputError(
                one.said, f"{len(suns)} suns, {len(planets)} planets, {len(rings)} rings",
                "is no set of one sun, planets and one ring", "import its meshes as single stages",
            )  # fmt: skip
        (sun,) = suns.values()
        carriers = [
            shaft
            for carrier in said.linked(one, "assembly", "assembly", "part", "planet_carrier")
            for shaft in said.linked(carrier, "assembly", "assembly", "part", "shaft")
            if shaft.id not in {pin.id for pin in _pins(said, planets)}
        ]
        # Pins are parts of the carrier, too; what turns with it is whatever of its shafts stands on the common axis.
        found.append(Planetary(one, tuple(sorted(parts)), sun, tuple(planets), rings[0], tuple(carriers)))
    return found


def _pins(said: Said, planets: list[Component]) -> list[Component]:
    """Shafts that planets turn on: those that bearings of the planets' shafts hold."""
    found = []
    for planet in planets:
        shaft = shaft_of(said, planet)
        bearings = [] if shaft is None else said.linked(shaft, "outer_part", "side", "assembly")
        found += [
            pin for bearing in bearings for pin in said.linked(bearing, "assembly", "side", "inner_part", "shaft")
        ]
    return found


def flow_through(said: Said, one: Planetary, bodies: dict[int, int]) -> PlanetSet:
    """Its bodies and teeth.

    Raises
    ------
    InputError
        If sun, ring or carrier stand on no shaft.
    """
    shafts = {
        "sun": shaft_of(said, one.sun),
        "ring": shaft_of(said, one.ring),
        "carrier": next(iter(one.carriers), None),
    }
    lost = [name for name, shaft in shafts.items() if shaft is None]
    if lost:
        raise InputError(one.component.said, f"no shaft of its {lost[0]}", "is incomplete", "complete its relations")
    numbers = {name: bodies[shaft.id] for name, shaft in shafts.items() if shaft is not None}
    teeth = teeth_of(said, one.sun), abs(teeth_of(said, one.ring))
    return PlanetSet(numbers["sun"], numbers["ring"], numbers["carrier"], teeth)


def set_name(n: int) -> str:
    """Name of a set in the case, by its number."""
    return "P" if n == 0 else f"P{n + 1}"


def set_tables(
    said: Said, one: Planetary, names: dict[int, str], n: int, flow: Flow, stages: list[Stage],
    mesh_keys: Callable[[Stage, Component], tuple[Key, ...]],
) -> list[Table]:  # fmt: skip
    """``[planetary.P]``: gears, planets, what is held and what drives, what holds them; and the pairs of its meshes.

    Parameters
    ----------
    said : Said
    one : Planetary
    names : dict
        Of its gears in the case.
    n : int
        Its number among the sets.
    flow : Flow
    stages : list of Stage
        All of the model.
    mesh_keys : callable
        Keys that the pair of a mesh has of its stage and driver.

    Raises
    ------
    InputError
        If nothing is held.
    """
    whole, held = flow.sets[n], flow.held
    members = {"sun": whole.sun, "ring": whole.ring, "carrier": whole.carrier}
    fixed = [name for name, body in members.items() if body in held]
    if len(fixed) != 1:
        raise InputError(
            one.component.said, f"{len(fixed)} members held", "needs one of sun, ring and carrier held by the casing",
            "join it to the casing by a coupling",
        )  # fmt: skip
    sun, ring = whole.teeth
    on_sun = flow.driven.set_torque[n]
    torques = {"sun": on_sun, "ring": on_sun * ring / sun, "carrier": -on_sun * (sun + ring) / sun}
    speeds = {name: flow.driven.speed[body] for name, body in members.items()}
    free = [name for name in members if name != fixed[0]]
    # The planets take power from the member that drives.
    driving = next((name for name in free if torques[name] * speeds[name] < 0.0), free[0])
    keys = [
        *(Key(role, text(names[gear.id])) for role, gear in zip(("sun", "planet", "ring"), one.gears, strict=True)),
        *planet_keys(said, one, stages),
        Key("fixed", text(fixed[0]), "its coupling to the casing"),
        Key("input", text(driving)),
    ]
    for key, value, unit in (("torque", torques[driving], "N*m"), ("speed", speeds[driving], "rpm")):
        if math.isfinite(value) and value:
            keys.append(Key(key, quantity(abs(value), unit, 12), "of external_load, or through the gearbox"))
        else:
            assumed = {"N*m": 1.0, "rpm": 1500.0 * math.tau / 60.0}[unit]
            keys.append(Key(key, quantity(assumed, unit), "assumed: none reaches it"))
    backward = speeds[driving] if math.isfinite(speeds[driving]) and speeds[driving] else torques[driving]
    if backward < 0.0:
        keys.append(Key("clockwise", "true", "rotational_speed below zero"))
    mine = [stage for stage in stages if stage.component.id in one.stages]
    distance = distance_of(said, next(stage for stage in mine if not stage.internal))
    keys += [*support_keys(said, one, flow, n, fixed[0]), *body_keys(said, one, distance)]
    sun_drives = driving == "sun" or (driving == "carrier" and fixed[0] == "sun")
    made = [Table(f"planetary.{set_name(n)}", tuple(keys), f"{one.component.said} {one.component.name}")]
    for mesh, central in (("sun", one.sun), ("ring", one.ring)):
        planet_drives = sun_drives == (mesh == "ring")
        driver, wheel = (one.planet, central) if planet_drives else (central, one.planet)
        stage = next(stage for stage in mine if {central.id, one.planet.id} == {gear.id for gear in stage.gears})
        roles = (Key("driver", text(names[driver.id]), "as power rolls"), Key("driven", text(names[wheel.id])))
        about = f"{stage.component.said}, for all its like"
        made.append(Table(f"pair.{set_name(n)}_{mesh}", (*roles, *mesh_keys(stage, driver)), about))
    return made
