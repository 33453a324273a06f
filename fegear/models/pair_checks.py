"""What makes a pair of a case impossible to load as the case asks."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.case.part import at
from fegear.errors import InputError
from fegear.geometry.pair import MEMBERS
from fegear.geometry.plausible import refuse_load
from fegear.models.loaded_pair import build_relief
from fegear.models.pair_inputs import pair_inputs

if TYPE_CHECKING:
    from fegear.case.reading import Scene


def check_pair(scene: Scene, name: str) -> None:
    """Refuse pairs that cannot be loaded as the case asks, and effects without data or data against an effect."""
    part, effects = scene.case.pair[name], scene.case.effects
    pair, key = scene.pairs[name], f"pair.{name}"
    if part.normal_load(pair) is None:
        raise InputError(f"{key}.load", "(not given)", "is needed for load sharing", "give load, loads or torque")
    if pair.contact_ratio < 1.0 and not effects.corner_contact:
        raise InputError(
            key, f"contact ratio {pair.contact_ratio:.4f}",
            "is below 1: at some roll positions no tooth pair is on the path of contact",
            "lengthen the teeth, raise the number of teeth, or set effects.corner_contact = true",
        )  # fmt: skip
    try:
        refuse_load(pair, max(part.all_loads(pair)))
    except InputError as error:
        raise at(key, error) from None
    source = part.compliance.source
    if effects.neighbour_coupling and source != "fe":
        raise InputError(
            "effects.neighbour_coupling", "true", f'is not known to the compliances of {key}, source = "{source}"',
            f'set {key}.compliance.source = "fe", or leave the effect out',
        )  # fmt: skip
    if source == "table" and effects.hertz != "none":
        raise InputError(
            "effects.hertz", f'"{effects.hertz}"', f"cannot change the contact that the table of {key} holds already",
            'set effects.hertz = "none"',
        )  # fmt: skip
    if source == "table" and part.compliance.of != "pair" and pair.driver.base_radius != pair.driven.base_radius:
        raise InputError(
            f"{key}.compliance.of", '"tooth"', "takes the table for a tooth of either gear, but the gears differ",
            'give the compliance of the pair and set of = "pair"',
        )  # fmt: skip
    if effects.spacing_errors and all(gear.spacing_errors is None for gear in scene.case.gear.values()):
        raise InputError(
            "effects.spacing_errors", "true", "finds no gear with spacing_errors in this case",
            f"give gear.{part.driver}.spacing_errors, or leave the effect out",
        )  # fmt: skip
    _check_flanks(scene, name)


def _check_flanks(scene: Scene, name: str) -> None:
    """Read reliefs and spacing errors and refuse what does not fit the teeth, before anything is solved."""
    asked = pair_inputs(scene, name)
    for member in MEMBERS if asked.effects.relief else ():
        flank = asked.flank(member)
        try:
            # What is given in Welbourn's Delta is held against the tooth when that is known.
            build_relief(asked.pair, member, flank, 0.0)
        except InputError as error:
            raise at(f"gear.{flank.gear}", error) from None


def check_relief(scene: Scene, name: str) -> None:
    """Refuse the effect relief where no gear of the case has any: other pairs may do without."""
    part = scene.case.pair[name]
    if scene.case.effects.relief and all(gear.relief is None for gear in scene.case.gear.values()):
        raise InputError(
            "effects.relief", "true", "finds no gear with a relief in this case",
            f"give gear.{part.driver}.relief, or leave the effect out",
        )  # fmt: skip
