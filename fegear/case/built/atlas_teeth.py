"""Which plane gears of a case are taken from an atlas in place of being solved: `accuracy.source`."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import lru_cache
from typing import TYPE_CHECKING

from fegear.base.errors import RangeError
from fegear.base.notes import exceeding
from fegear.base.printed import percent
from fegear.case.part import at

if TYPE_CHECKING:
    from fegear.atlas.atlas_gear import AtlasGear
    from fegear.case.reading import Scene
    from fegear.geometry.gear import Gear


@dataclass(frozen=True)
class GearFromAtlas:
    """All that an atlas's answer about a gear depends on.

    Parameters
    ----------
    gear : Gear
    made_from : str
        Digest of the atlases that come with fegear.
    name : str
        Of the gear, for messages.
    tolerance : float
        Which its errors are compared with.
    """

    gear: Gear
    made_from: str
    name: str = field(default="", compare=False)
    tolerance: float = field(default=1e-3, compare=False)

    @classmethod
    def of(cls, scene: Scene, name: str) -> GearFromAtlas:
        """As `Stage.inputs`."""
        from fegear.atlas.shipped import fingerprint

        return cls(scene.gears[name], fingerprint(), name, scene.case.accuracy.tolerance)


def from_atlas(scene: Scene, name: str) -> bool:
    """Whether contact takes a gear from an atlas."""
    source = scene.case.accuracy.source
    return source == "atlas" or name in scene.previews or (source == "auto" and not why_solved(scene, name))


def why_solved(scene: Scene, name: str) -> str:
    """Why a gear that might be taken from an atlas is solved; empty where none might, or none is."""
    return why_not_known(scene, name, scene.case.accuracy.tolerance) if scene.case.accuracy.source == "auto" else ""


def why_not_known(scene: Scene, name: str, tolerance: float) -> str:
    """Why no atlas answers about a gear with a tolerance; empty where one does."""
    if scene.case.gear[name].tooth_mesh is not None:
        return "it has its own mesh"
    try:
        known = known_teeth(scene.gears[name])
    except RangeError as error:
        return str(error).split(";")[0]
    worst = max(known.largest_errors().values())
    return "" if worst <= tolerance else f"estimated error {percent(worst)} (tolerance {percent(tolerance)})"


@lru_cache(maxsize=8)
def known_teeth(gear: Gear) -> AtlasGear:
    """What the shipped atlas says of a gear.

    Raises
    ------
    RangeError
        If it does not contain it.
    """
    from fegear.atlas.shipped import nearest_atlas

    return nearest_atlas(gear).gear(gear)


def check_atlas_gear(scene: Scene, name: str) -> None:
    """Refuse a gear that no atlas contains.

    Raises
    ------
    RangeError
        Under its key in the case.
    """
    if scene.case.gear[name].tooth_mesh is not None:
        raise RangeError(
            f"gear.{name}.tooth_mesh", f'"{scene.case.gear[name].tooth_mesh}"', "is not used by an atlas", _SOLVE
        )
    try:
        known_teeth(scene.gears[name])
    except RangeError as error:
        raise at(f"gear.{name}", error) from None


_SOLVE = 'set accuracy.source = "solve" or "auto"'


def atlas_remarks(asked: GearFromAtlas, known: AtlasGear) -> tuple[str, ...]:
    """Say that a gear was taken from an atlas, and with which errors."""
    errors = known.largest_errors()
    root = max(errors["root_tension"], errors["root_compression"])
    said = (
        f"Gear {asked.name}: compliance and root stress interpolated from an atlas of solved gears; estimated errors "
        f'{percent(errors["c_self"])} (c_self), {percent(root)} (root stress); set accuracy.source = "solve" to solve '
        "the gear."
    )
    return (exceeding(said) if max(errors.values()) > asked.tolerance else said,)


#: What says of a gear that it was solved although the case would take it from an atlas.
SOLVED_AFTER_ALL = "solved by finite elements, not taken from an atlas"


def solved_remarks(name: str, why: str) -> tuple[str, ...]:
    """Say that a gear was solved although the case would take it from an atlas."""
    return (f"Gear {name}: {SOLVED_AFTER_ALL} ({why}).",) if why else ()
