"""The other direction of rotation of a gearbox: lives of its bearings while all coast flanks carry the load.

Tangential and axial forces of all meshes change their sign, radial ones do not: on shafts with two meshes, and where
the axial force of helical teeth finds another bearing, lives differ. Loads are uniform over the face here; how the
coast flanks share the load over it takes a run of its own.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.base.printed import figures
from fegear.case.built.shafts import gearbox_of, mesh_places
from fegear.contact.wide.on_shafts import EvenForces, load_gearbox

if TYPE_CHECKING:
    from collections.abc import Sequence

    from fegear.case.reading import Scene
    from fegear.results.shafts.at_glance import BearingAtGlance
    from fegear.shafts.gearbox import Gearbox
    from fegear.shafts.life import LifeRating

#: Lives that differ by less are the same.
_SAME = 0.01


@dataclass(frozen=True)
class OtherDirection:
    """A gearbox that turns the other way.

    Parameters
    ----------
    gearbox : Gearbox
    changes : tuple of str
        Keys of the case that turn it, as ``shaft.input.clockwise=true``.
    """

    gearbox: Gearbox
    changes: tuple[str, ...]


def other_direction(scene: Scene) -> OtherDirection | None:
    """The gearbox of a case with the other direction of rotation; None of asymmetric teeth, or where it cannot turn.

    Parameters
    ----------
    scene : Scene
    """
    driven = {mesh.shafts[1] for mesh in mesh_places(scene)}
    turned = {name: not one.clockwise for name, one in scene.case.shaft.items() if name not in driven}
    if any(gear.asymmetric for gear in scene.gears.values()):
        return None
    shafts = {
        name: one.model_copy(update={"clockwise": turned[name]}) if name in turned else one
        for name, one in scene.case.shaft.items()
    }
    try:
        box = gearbox_of(replace(scene, case=scene.case.model_copy(update={"shaft": shafts})))
    except InputError:
        return None
    driving = {mesh.shafts[0] for mesh in box.meshes}
    return OtherDirection(
        box, tuple(f"shaft.{name}.clockwise={str(on).lower()}" for name, on in turned.items() if name in driving)
    )


def lives_under_uniform_load(box: Gearbox, lives: Sequence[Sequence[LifeRating | None]]) -> list[list[float]]:
    """Basic rating lives of every bearing by shafts, in revolutions; NaN without a rating.

    Parameters
    ----------
    box : Gearbox
    lives : sequence of sequence of LifeRating or None
        Ratings of its bearings.
    """
    even = [EvenForces(mesh.even / mesh.load) for mesh in box.meshes]
    (state,) = load_gearbox(box, even, [1.0])
    each = zip(state.bent, lives, strict=True)
    return [[float(one) for one in bent.bearing_loads(tuple(rated)).life] for bent, rated in each]


def shares_of_life(
    box: Gearbox, other: OtherDirection | None, lives: Sequence[Sequence[LifeRating | None]]
) -> list[list[float]] | None:
    """Lives in the other direction over those in this one, both under uniform load; None where all are the same.

    Parameters
    ----------
    box : Gearbox
        In this direction.
    other : OtherDirection or None
    lives : sequence of sequence of LifeRating or None
    """
    if other is None:
        return None
    both = (lives_under_uniform_load(one, lives) for one in (other.gearbox, box))
    found = [[one / two for one, two in zip(*row, strict=True)] for row in zip(*both, strict=True)]
    return found if any(abs(one - 1.0) > _SAME for row in found for one in row if math.isfinite(one)) else None


def said_of_other_direction(
    bearings: Sequence[BearingAtGlance], required_hours: float, changes: Sequence[str]
) -> list[str]:
    """The shortest life in the other direction, and how its load distribution and safeties are computed."""
    known = [one for one in bearings if math.isfinite(one.other)]
    if not known:
        return []
    first = min(known, key=lambda one: one.other)
    required = ""
    if math.isfinite(required_hours):
        verdict = "fails, " if first.other < required_hours else ""
        required = f" ({verdict}{figures(required_hours / 3600.0)} h required)"
    said = f"Other direction of rotation (coast flanks): minimum life {figures(first.other / 3600.0)} h, bearing "
    keys = " --set ".join(changes)
    return [f"{said}{first.bearing}{required}; its K_Hβ, S_H and S_F by a run with --set {keys}."]
