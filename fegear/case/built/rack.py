"""From ``[rack.NAME]`` to the rack and pinion of the mechanics."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.case.nearest import nearest
from fegear.case.part import at
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack_and_pinion import RackAndPinion, distance_of_backlash
from fegear.geometry.rack_tooth import RackTooth
from fegear.geometry.toothed_rack import Rack

if TYPE_CHECKING:
    from fegear.case.rack import RackAndPinionPart
    from fegear.case.reading import Scene
    from fegear.geometry.gear import Gear

#: Keys of the rack's teeth under other names in a case.
_KEYS = {"rack": "basic_rack", "tip_rounding": "tip_radius_rounding", "contact_ratio": "distance", "body":
         "reference_height", "module": "pinion", "pressure_angle": "pinion"}  # fmt: skip


@dataclass(frozen=True)
class RackInputs:
    """A rack and pinion, and its load.

    Parameters
    ----------
    pair : RackAndPinion
    force : float
        Along the rack [N]; 0 where the case has none.
    positions : int
        In a base pitch.
    name, pinion : str
        Of the rack and of its pinion.
    """

    pair: RackAndPinion
    force: float
    positions: int
    name: str = field(compare=False)
    pinion: str = field(compare=False)


def racks(scene: Scene) -> tuple[str, ...]:
    """All racks of a case."""
    return tuple(scene.case.rack)


def rack_pinion(scene: Scene, name: str) -> str:
    """Name of the pinion on a rack.

    Raises
    ------
    InputError
        If it is not a gear of the case.
    """
    pinion = scene.case.rack[name].pinion
    if pinion not in scene.gears:
        raise InputError(f"rack.{name}.pinion", f'"{pinion}"', "is not a gear of this case",
                         nearest(pinion, scene.gears))  # fmt: skip
    return pinion


def rack_inputs(scene: Scene, name: str) -> RackInputs:
    """Collect what a case says of a rack.

    Raises
    ------
    InputError
        Under its key in the case.
    """
    part, key = scene.case.rack[name], f"rack.{name}"
    pinion = rack_pinion(scene, name)
    gear = scene.gears[pinion]
    try:
        pair = _pair(part, gear)
    except InputError as error:
        first, _, rest = error.key.partition(".")
        known = _KEYS.get(first, first)
        raise at(key, replace_key(error, f"{known}.{rest}" if rest else known)) from None
    force = part.force or 0.0
    if part.torque is not None:
        force = part.torque / gear.pitch_radius
    return RackInputs(pair, force, part.positions, name, pinion)


def replace_key(error: InputError, key: str) -> InputError:
    """The same refusal of another key."""
    return type(error)(key, error.value, error.rule, error.remedy)


def _pair(part: RackAndPinionPart, gear: Gear) -> RackAndPinion:
    tooth, module = gear.tooth, gear.module
    if not isinstance(tooth, Tooth):
        raise InputError("pinion", f'"{part.pinion}"', "must be an external spur gear with equal flanks cut by a rack",
                         "remove internal, fillet or coast_pressure_angle of the gear")  # fmt: skip
    if gear.helix_angle != 0.0:
        raise InputError("pinion", f'"{part.pinion}"', "is helical, which is not available with racks",
                         "use a spur pinion")  # fmt: skip
    if part.basic_rack is None:
        basic = replace(tooth.rack, protuberance=0.0, grinding_allowance=0.0) if tooth.rack.protuberance else tooth.rack
    elif part.basic_rack.coast_tip_radius is not None:
        raise InputError("basic_rack.coast_tip_radius", part.basic_rack.coast_tip_radius,
                         "is not available for racks (equal flanks)", "remove it")  # fmt: skip
    else:
        basic = part.basic_rack.build(tooth.rack.pressure_angle, module)
    straight = RackTooth(
        basic, part.thickness_allowance / module, part.tip_radius_rounding / module, part.tip_chamfer / module
    )
    rack = Rack(
        straight, module, part.teeth, part.reference_height,
        gear.face_width if part.face_width is None else part.face_width,
        gear.material if part.material is None else part.material.build(), gear.plane_assumption, part.pins(module),
    )  # fmt: skip
    distance = part.distance
    if distance is None:
        backlash = part.backlash or 0.0
        if not math.isfinite(backlash) or backlash < 0.0:
            raise InputError("backlash", f"{backlash * 1e6:.6g} um", "must not be negative")
        distance = distance_of_backlash(gear, rack, backlash)
    return RackAndPinion(gear, rack, distance)


def loaded_rack_inputs(scene: Scene, name: str) -> RackInputs:
    """As `rack_inputs`, of a rack that has a load.

    Raises
    ------
    InputError
    """
    found = rack_inputs(scene, name)
    if not found.force:
        raise InputError(f"rack.{name}.force", "(not given)", "is required for this result", 'set force = "1 kN"')
    return found
