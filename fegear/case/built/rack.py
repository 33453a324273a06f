"""From ``[rack.NAME]`` to the rack and pinion of the mechanics."""

from __future__ import annotations

import math
import re
from dataclasses import dataclass, field, replace
from typing import TYPE_CHECKING

from fegear.base.errors import InputError, RangeError
from fegear.case.built.gear_flanks import gear_flanks
from fegear.case.nearest import nearest
from fegear.case.part import at
from fegear.contact.rack.rack_flanks import RackFlanks
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack_and_pinion import OTHER_HAND, RackAndPinion, distance_of_backlash
from fegear.geometry.rack_relief import RackReliefSpec
from fegear.geometry.rack_tooth import RackTooth
from fegear.geometry.relief import UNMODIFIED
from fegear.geometry.toothed_rack import Rack

if TYPE_CHECKING:
    from fegear.case.rack import RackAndPinionPart
    from fegear.case.reading import Scene
    from fegear.geometry.gear import Gear
    from fegear.geometry.rack_relief import RackRelief
    from fegear.geometry.relief import EndRelief, Relief
    from fegear.geometry.relief_spec import ReliefSpec, TipReliefSpec

#: Keys of the rack's teeth under other names in a case.
_KEYS = {"rack": "basic_rack", "tip_rounding": "tip_radius_rounding", "body":
         "reference_height", "module": "pinion", "pressure_angle": "pinion"}  # fmt: skip
#: Positions in a base pitch where the case does not say: of plane racks, and of those with their width.
_POSITIONS, _WIDE_POSITIONS = 32, 24
#: Keys of its tooth that a case gives as lengths.
_LENGTHS = ("thickness_allowance", "tip_rounding", "tip_chamfer")


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
    flanks : RackFlanks
        Reliefs of both; none where the effect is off.
    name, pinion : str
        Of the rack and of its pinion.
    left_out : tuple of str
        Keys of reliefs that do not count, for the effect is off.
    wide : bool
        Whether the teeth are solved with their width (3D).
    """

    pair: RackAndPinion
    force: float
    positions: int
    flanks: RackFlanks
    name: str = field(compare=False)
    pinion: str = field(compare=False)
    left_out: tuple[str, ...] = field(default=(), compare=False)
    wide: bool = False


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


def is_wide_rack(scene: Scene, name: str) -> bool:
    """Whether a rack is solved with its width: as given, else helical ones.

    Raises
    ------
    InputError
        If a helical rack is to be plane, or its pinion is not a gear of the case.
    """
    given, helical = scene.case.rack[name].width, scene.gears[rack_pinion(scene, name)].helix_angle != 0.0
    if helical and given == "plane":
        raise InputError(f"rack.{name}.width", '"plane"', "is available for spur racks only", "remove width")
    return helical or given == "solid"


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
        error = _by_backlash(part, _from_the_back(part, _in_lengths(error, gear.module)))
        first, _, rest = error.key.partition(".")
        known = _KEYS.get(first, first)
        raise at(key, replace_key(error, f"{known}.{rest}" if rest else known)) from None
    force = part.force or 0.0
    if part.torque is not None:
        force = part.torque / gear.pitch_radius
    wide = is_wide_rack(scene, name)
    positions = part.positions or (_WIDE_POSITIONS if wide else _POSITIONS)
    if scene.case.effects.relief:
        return RackInputs(pair, force, positions, _flanks(scene, name, pair), name, pinion, wide=wide)
    return RackInputs(pair, force, positions, RackFlanks(), name, pinion, relieved_parts(scene, name), wide)


def check_body(name: str, rack: Rack) -> None:
    """Refuse bodies that finite elements cannot have.

    Raises
    ------
    RangeError
        Under its key in the case.
    """
    from fegear.fem.plane.rack.rack_mesh import THICKEST_BODY, THINNEST_BODY

    if not THINNEST_BODY <= rack.body / rack.module <= THICKEST_BODY:
        low, high = ((one - rack.tooth.root_height) * rack.module * 1e3 for one in (THINNEST_BODY, THICKEST_BODY))
        raise RangeError(f"rack.{name}.reference_height", f"{rack.reference_height * 1e3:.6g} mm",
                         f"must be between {low:.4g} and {high:.4g} mm for finite elements")  # fmt: skip


def relieved_parts(scene: Scene, name: str) -> tuple[str, ...]:
    """Keys of the reliefs that a case gives a rack and its pinion."""
    pinion = rack_pinion(scene, name)
    gear = scene.case.gear[pinion]
    found = [f"gear.{pinion}.{key}" for key in ("relief", "measured") if getattr(gear, key) is not None]
    return (*found, *([f"rack.{name}.tip_relief"] if scene.case.rack[name].tip_relief is not None else []))


def _flanks(scene: Scene, name: str, pair: RackAndPinion) -> RackFlanks:
    """Reliefs of pinion and rack.

    Raises
    ------
    InputError
        If one does not fit its teeth, or is given by what only a pair of gears has.
    """
    part, pinion = scene.case.rack[name], rack_pinion(scene, name)
    given = gear_flanks(scene, pinion)
    relief: Relief = UNMODIFIED
    if given.relief is not None:
        try:
            relief = _pinion_relief(given.relief, pair)
        except InputError as error:
            raise at(f"gear.{pinion}", error) from None
    return RackFlanks(relief, _rack_relief(part, name, pair.rack))


def _rack_relief(part: RackAndPinionPart, name: str, rack: Rack) -> RackRelief | None:
    if part.tip_relief is None:
        return None
    try:
        return RackReliefSpec(**dict(part.tip_relief)).built(rack)
    except InputError as error:
        raise at(f"rack.{name}", error) from None


def _pinion_relief(spec: ReliefSpec, pair: RackAndPinion) -> Relief:
    if spec.wants_delta:
        raise InputError("relief.amount_over_delta", "(given)", "requires a pair of gears", "set amount")
    ends = pair.x_start, pair.x_end
    rolls = [float(pair.roll_length(x)) / pair.pinion.base_radius for x in ends]

    def normalised(tip: TipReliefSpec, _amount: float) -> EndRelief:
        raise InputError("relief.tip.normalised_length", tip.normalised_length, "requires a pair of gears",
                         "set length, start_radius or start_roll_angle")  # fmt: skip

    radii = float(pair.radius(ends[0])), float(pair.radius(ends[1]))
    return spec.over(pair.pinion, radii, (rolls[0], rolls[1]), normalised)


def _in_lengths(error: InputError, module: float) -> InputError:
    """A refusal of what a case gives as a length, which the tooth of a rack knows in modules, in millimetres."""
    if error.key not in _LENGTHS:
        return error

    def length(found: re.Match[str]) -> str:
        return f"{float(found[1]) * module * 1e3:.4g} mm"

    value = f"{error.value * module * 1e3:.6g} mm" if isinstance(error.value, float) else str(error.value)
    said = (re.sub(r"(-?[0-9.]+(?:e-?[0-9]+)?) modules", length, one) for one in (value, error.rule, error.remedy))
    return type(error)(error.key, *said)


def _by_backlash(part: RackAndPinionPart, error: InputError) -> InputError:
    """A refusal of a distance that follows from a backlash as one of the backlash."""
    if error.key != "distance" or part.backlash is None or part.distance is not None:
        return error
    return type(error)(
        "backlash", f"{part.backlash * 1e6:.6g} um", error.rule, error.remedy.replace("distance", "backlash")
    )


def _from_the_back(part: RackAndPinionPart, error: InputError) -> InputError:
    """A refusal of the distance to the reference line as one of the mounting distance, where that is given."""
    if part.mounting_distance is None or error.key != "distance":
        return error

    def moved(found: re.Match[str]) -> str:
        return f"{found[1]}{float(found[2]) + part.reference_height * 1e3:.6g} mm"

    remedy = re.sub(r"((?:increase|reduce|set) distance(?: to at least )?)([0-9.]+) mm", moved, error.remedy)
    value = f"{part.mounting_distance * 1e3:.6g} mm"
    return type(error)("mounting_distance", value, error.rule, remedy.replace("distance", "mounting_distance"))


def replace_key(error: InputError, key: str) -> InputError:
    """The same refusal of another key."""
    return type(error)(key, error.value, error.rule, error.remedy)


def _pair(part: RackAndPinionPart, gear: Gear) -> RackAndPinion:
    tooth, module = gear.tooth, gear.module
    if not isinstance(tooth, Tooth):
        raise InputError("pinion", f'"{part.pinion}"', "must be an external gear with equal flanks cut by a rack",
                         "remove internal, fillet or coast_pressure_angle of the gear")  # fmt: skip
    if part.basic_rack is None:
        basic = replace(tooth.rack, protuberance=0.0, grinding_allowance=0.0) if tooth.rack.protuberance else tooth.rack
    elif part.basic_rack.coast_tip_radius is not None:
        raise InputError("basic_rack.coast_tip_radius", part.basic_rack.coast_tip_radius,
                         "is not available for racks (equal flanks)", "remove it")  # fmt: skip
    else:
        basic = part.basic_rack.build(tooth.rack.pressure_angle, module)
    straight = RackTooth(
        basic, part.thickness_allowance / module, part.tip_radius_rounding / module, part.tip_chamfer / module,
        gear.helix_angle,
    )  # fmt: skip
    rack = Rack(
        straight, module, part.teeth, part.reference_height,
        gear.face_width if part.face_width is None else part.face_width,
        gear.material if part.material is None else part.material.build(), gear.plane_assumption, part.pins(module),
        OTHER_HAND[gear.hand],
    )  # fmt: skip
    distance = part.distance
    if part.mounting_distance is not None:
        distance = part.mounting_distance - part.reference_height
        if not distance > 0.0:
            raise InputError("mounting_distance", f"{part.mounting_distance * 1e3:.6g} mm",
                             f"must exceed reference_height, {part.reference_height * 1e3:.6g} mm")  # fmt: skip
    if distance is None:
        backlash = part.backlash or 0.0
        if not math.isfinite(backlash) or backlash < 0.0:
            raise InputError("backlash", f"{backlash * 1e6:.6g} um", "must not be negative")
        distance = distance_of_backlash(gear, rack, backlash)
    return RackAndPinion(gear, rack, distance)


def drawn_rack(scene: Scene, name: str) -> tuple[Rack, RackRelief | None]:
    """A rack and the tip relief that the case gives it, whether or not it counts.

    Raises
    ------
    InputError
        Under its key in the case.
    """
    rack, part = rack_inputs(scene, name).pair.rack, scene.case.rack[name]
    return rack, _rack_relief(part, name, rack)


def loaded_rack_inputs(scene: Scene, name: str) -> RackInputs:
    """As `rack_inputs`, of a rack that has a load.

    Raises
    ------
    InputError
    """
    found = rack_inputs(scene, name)
    if not found.force:
        raise InputError(f"rack.{name}.force", "(not given)", "is required for this result", 'set force = "1 kN"')
    if scene.case.gear[found.pinion].odd_tooth:
        raise InputError(f"gear.{found.pinion}.odd_tooth", "(given)", "is not available for the pinion of a rack",
                         "remove it")  # fmt: skip
    return found
