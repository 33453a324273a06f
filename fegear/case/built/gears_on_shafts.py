"""Bodies of gears that sit fast on their shafts, or are cut into them: what stiffens a shaft below its gears."""

from __future__ import annotations

from dataclasses import dataclass, replace
from itertools import pairwise
from typing import TYPE_CHECKING

import numpy as np

from fegear.case.built.teeth_in_shafts import PIECE, SAME
from fegear.fem.revolved_body import RevolvedBody
from fegear.shafts.gear_on_shaft import GearOnShaft
from fegear.shafts.section import Section

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.case.shaft import GearPlacePart
    from fegear.geometry.gear import Gear
    from fegear.shafts.beam import Shaft

#: A body thinner than this share of the root circle's radius is the shaft itself.
_THIN = 0.03


@dataclass(frozen=True)
class StiffenedShaft:
    """A shaft with the bodies of its gears.

    Parameters
    ----------
    shaft : Shaft
    bodies : dict of str to GearOnShaft
        By gear; of those that stiffen it.
    said : tuple of str
        What was assumed.
    """

    shaft: Shaft
    bodies: dict[str, GearOnShaft]
    said: tuple[str, ...]


def stiffened(scene: Scene, name: str, bare: Shaft, senses: dict[str, int]) -> StiffenedShaft:
    """Give a shaft the bodies of its gears.

    Below a body the shaft reaches to the radius at which the gear is held, where the body begins: of a gear that is
    pressed on that is its surface. Teeth that are cut into a shaft have no seat inside of it: their body begins at its
    surface, and there is none of a pinion whose root circle lies there. A core that ended at the circle at which the
    solved gear is held would be a neck between the body and the thick shaft beside it.

    Parameters
    ----------
    scene : Scene
    name : str
        Of the shaft.
    bare : Shaft
        As its sections say.
    senses : dict of str to int
        `MeshPlace.sense` by gear, which says where its end II lies; of bodies alike to both sides of no effect.
    """
    shaft, bodies, said = bare, {}, []
    for place in scene.case.shaft[name].gears:
        gear = scene.gears[place.gear]
        if not place.stiffens or gear.tooth.internal:
            continue
        found = _body(gear, place, senses.get(place.gear, 1))
        if gear.body is not None and gear.body.holes is not None:
            said.append(f"stiffening by {place.gear} is computed without the holes of its web")
        low, high = (min(max(place.at + end, 0.0), bare.length) for end in found.held)
        if not high - low > PIECE * bare.length:
            said.append(f"{place.gear} is not seated on its shaft and does not stiffen it")
            continue
        outer, inner = bare.diameters(np.linspace(low, high, 17)[1:-1])
        if inner.max() > 2.0 * found.seat * (1.0 - SAME):
            said.append(
                f"{place.gear} is fixed at a radius of {found.seat * 1e3:.4g} mm, inside the bore of its shaft, and "
                "does not stiffen it"
            )
            continue
        if outer.max() > 2.0 * found.seat * (1.0 + SAME):
            said.append(f"{place.gear} is treated as integral with its shaft, solid up to its root circle")
            if gear.body is None:
                surface = 0.5 * float(outer.max())
                if surface > gear.root_radius * (1.0 - _THIN):
                    shaft = _filled(shaft, low, high, 2.0 * gear.root_radius)
                    continue
                found = replace(found, rings=((surface, *found.rings[0][1:]),))
        elif outer.min() < 2.0 * found.seat * (1.0 - SAME):
            said.append(f"{place.gear} is treated as solid between shaft and bore_radius")
        shaft = _filled(shaft, low, high, 2.0 * found.seat)
        bodies[place.gear] = GearOnShaft(found, place.at, gear.material.young_modulus)
    return StiffenedShaft(replace(shaft, gears=tuple(bodies.values())), bodies, tuple(said))


def strained(scene: Scene, name: str) -> Shaft:
    """A shaft by its sections, no thicker than the root circles of gears that are cut into it: what carries it.

    Parameters
    ----------
    scene : Scene
    name : str
        Of the shaft.
    """
    part = scene.case.shaft[name]
    shaft = part.build()
    for place in part.gears:
        gear = scene.gears[place.gear]
        if not gear.tooth.internal:
            half = 0.5 * gear.face_width
            low, high = (min(max(place.at + end, 0.0), shaft.length) for end in (-half, half))
            if high - low > PIECE * shaft.length:
                shaft = _filled(shaft, low, high, 2.0 * gear.root_radius, thinner=True)
    return shaft


def _body(gear: Gear, place: GearPlacePart, sense: int) -> RevolvedBody:
    """What lies between the held radius of a gear and its root circle, along its shaft."""
    half = 0.5 * gear.face_width
    rings, lean = [(gear.bore_radius, -half, half)], 0.0
    if gear.body is not None:
        lean = gear.body.lean
        rings = [(gear.body.rim_radius, -half, half), (gear.body.hub_radius, *gear.body.web)]
        if gear.body.hub_radius > gear.bore_radius * (1.0 + PIECE):
            rings.append((gear.bore_radius, *gear.body.hub))
    if sense > 0:  # toward end II is toward the left end of the shaft
        rings, lean = [(inner, -high, -low) for inner, low, high in rings], -lean
    low, high = rings[-1][1:]
    if len(rings) == 2:  # a web that is its own hub
        shift = lean * (rings[0][0] - rings[1][0])
        low, high = low + shift, high + shift
    reach = half if place.seat is None else 0.5 * place.seat
    return RevolvedBody(
        gear.root_radius, gear.face_width, tuple(rings), (max(low, -reach), min(high, reach)),
        gear.material.poisson_ratio, lean,
    )  # fmt: skip


def _filled(shaft: Shaft, low: float, high: float, outer: float, *, thinner: bool = False) -> Shaft:
    """The shaft with another outer diameter between two places, `thinner`: where it is thicker."""
    found = []
    for section, start in zip(shaft.sections, shaft.steps, strict=False):
        end = start + section.length
        cuts = [start, *(one for one in (low, high) if start + PIECE < one < end - PIECE), end]
        (d0, d1), (h0, h1) = section.ends
        for a, b in pairwise(cuts):
            s, t = (a - start) / section.length, (b - start) / section.length
            hole = h0 + (h1 - h0) * s, h0 + (h1 - h0) * t
            inside = low - PIECE < a and b < high + PIECE
            ends = d0 + (d1 - d0) * s, d0 + (d1 - d0) * t
            if inside:
                ends = (min(ends[0], outer), min(ends[1], outer)) if thinner else (outer, outer)
            found.append(Section(b - a, ends[0], hole[0], ends[1], hole[1]))
    return replace(shaft, sections=tuple(found))
