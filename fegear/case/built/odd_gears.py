"""Which gears of a case have odd teeth that count, and by which flanks their pairs load them."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.effects import ODD_TEETH

if TYPE_CHECKING:
    from fegear.case.reading import Scene


def odd_gears(scene: Scene) -> tuple[str, ...]:
    """Gears with odd teeth that count."""
    if not scene.case.effects.is_on(ODD_TEETH.name):
        return ()
    return tuple(name for name in scene.gears if scene.case.gear[name].odd_tooth)


def reshaped_gears(scene: Scene) -> tuple[str, ...]:
    """Those of plane teeth of which bodies of teeth differ, not only flanks."""
    return tuple(name for name in odd_gears(scene) if name in scene.spur_gears and _reshaped(scene, name))


def reshaped_solid_gears(scene: Scene) -> tuple[str, ...]:
    """Those in 3D pairs."""
    paired = {gear for pair in scene.wide_pairs for gear in odd_gears_in(scene, pair)}
    return tuple(name for name in scene.gears if name in paired and _reshaped(scene, name))


def _reshaped(scene: Scene, name: str) -> bool:
    return any(tooth.reshaped for tooth in scene.case.gear[name].odd_tooth)


def cracked_gears(scene: Scene) -> tuple[str, ...]:
    """Those of plane teeth with a cracked tooth."""
    cracked = (name for name in odd_gears(scene) if any(tooth.crack for tooth in scene.case.gear[name].odd_tooth))
    return tuple(name for name in cracked if name in scene.spur_gears)


def odd_gears_of(scene: Scene, pair: str) -> tuple[str, ...]:
    """Those of a plane pair; of 3D pairs none: other results than those over a revolution take their teeth alike."""
    return odd_gears_in(scene, pair) if pair in scene.plane_pairs else ()


def odd_gears_in(scene: Scene, pair: str) -> tuple[str, ...]:
    """Those of a pair, plane or 3D."""
    part, odd = scene.case.pair[pair], odd_gears(scene)
    return tuple(name for name in dict.fromkeys((part.driver, part.driven)) if name in odd)


def on_other_flank(scene: Scene, pair: str, gear: str) -> bool:
    """Whether a pair loads the flank of a gear that is not the one by which it is driven: planets drive with it."""
    driven = any(part.driven == gear for name, part in scene.case.pair.items() if name in scene.plane_pairs)
    return scene.case.pair[pair].driver == gear and driven


def loaded_on_both_flanks(scene: Scene) -> tuple[str, ...]:
    """Gears with odd teeth of which bodies differ and that drive one pair and are driven in another."""
    return tuple(
        gear for gear in reshaped_gears(scene) if any(on_other_flank(scene, pair, gear) for pair in scene.plane_pairs)
    )
