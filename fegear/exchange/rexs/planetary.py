"""Planetary stages of a REXS model: which gears are sun, planets and ring, and what carries them."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.exchange.rexs.drive import PlanetSet
from fegear.exchange.rexs.places import shaft_of
from fegear.exchange.rexs.teeth import teeth_of

if TYPE_CHECKING:
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
                "is not a planetary set of one sun, planets and one ring", "import its meshes as single stages",
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
