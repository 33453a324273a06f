"""Which odd teeth 3D gears can have, and what solving such a gear depends on."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.case.built.odd_gears import odd_gears_in
from fegear.case.built.odd_teeth import OddTeeth, check_crack, odd_teeth_of
from fegear.case.built.solid_influence import SolidGearToSolve, keys_of_the_case, parts_in_modules, solid_gear_to_solve

if TYPE_CHECKING:
    from fegear.base.solution_cache import SolutionCache
    from fegear.case.odd_tooth import OddToothPart
    from fegear.case.reading import Scene
    from fegear.fem.solid.odd.odd_solid_influence import OddSolidInfluence


@dataclass(frozen=True)
class OddSolidToSolve:
    """A 3D gear and its odd teeth."""

    gear: SolidGearToSolve
    teeth: OddTeeth

    @property
    def name(self) -> str:
        """Of the gear."""
        return self.teeth.name


def odd_solid_to_solve(scene: Scene, name: str) -> OddSolidToSolve:
    """What a case asks of a 3D gear with odd teeth."""
    return OddSolidToSolve(solid_gear_to_solve(scene, name), odd_teeth_of(scene, name))


def solve_odd_solid_gear(asked: OddSolidToSolve, cache: SolutionCache | None = None) -> OddSolidInfluence:
    """Solve a gear with its width and its odd teeth, or recall it from a cache.

    Raises
    ------
    RangeError
        If it cannot be meshed, under the key of the case.
    """
    from fegear.fem.solid.odd.odd_solid_influence import odd_solid_influence

    gear = asked.gear.gear
    _, twist, width, poisson_ratio = parts_in_modules(gear)
    with keys_of_the_case(asked.gear.name):
        return odd_solid_influence(
            gear.symmetric_tooth,
            twist,
            width,
            poisson_ratio,
            gear.bore_radius / gear.module,
            asked.gear.settings,
            asked.teeth.in_solid(gear.teeth),
            reach=asked.gear.reach,
            body=gear.body_in_modules,
            cache=cache,
        )


def check_odd_solid_gear(scene: Scene, name: str) -> None:
    """Refuse odd teeth that 3D gears cannot have yet.

    Raises
    ------
    InputError
    """
    part, key = scene.case.gear[name], f"gear.{name}.odd_tooth"
    for n, tooth in enumerate(part.odd_tooth):
        _check_tooth(tooth, f"{key}[{n}]")
    if part.internal and any(tooth.reshaped for tooth in part.odd_tooth):
        raise InputError(
            key, "(given)", "is not available for internal gears in 3D pairs yet, other than pits and profiles",
            "remove it, or switch effects.odd_teeth off",
        )  # fmt: skip
    if part.body is not None and part.body.holes is not None:
        raise InputError(
            f"gear.{name}.body.holes", "(given)", "is not available for a 3D gear with odd teeth", "remove one of both"
        )
    meshes = [(pair, scene.case.pair[pair]) for pair in scene.wide_pairs if name in odd_gears_in(scene, pair)]
    drives = next((pair for pair, one in meshes if one.driver == name), None)
    driven = next((pair for pair, one in meshes if one.driven == name), None)
    if drives is not None and driven is not None:
        raise InputError(
            key, "(given)", f"is not available for idlers yet: pairs {driven} and {drives} load opposite flanks",
            "use one case for each pair",
        )  # fmt: skip
    for n in range(len(part.odd_tooth)):
        check_crack(scene, name, n)


def _check_tooth(tooth: OddToothPart, prefix: str) -> None:
    for key in ("hole", "keyway"):
        if getattr(tooth, key) is not None:
            raise InputError(f"{prefix}.{key}", "(given)", "is available for plane (2D) pairs only", "remove it")
    for outline in ("broken_at", "tip_diameter"):
        if getattr(tooth, outline) is not None:
            raise InputError(
                f"{prefix}.{outline}", f"{getattr(tooth, outline) * 1e3:.6g} mm",
                "is available for plane (2D) pairs only", "set missing = true",
            )  # fmt: skip
    if tooth.crack is not None and tooth.crack.crack_faces == "closing":
        raise InputError(
            f"{prefix}.crack.crack_faces", '"closing"', "is available for plane (2D) pairs only",
            'set crack_faces = "open"',
        )  # fmt: skip


def check_odd_wide_pair(scene: Scene, name: str) -> None:
    """Refuse 3D pairs over a revolution that are none of solid gears, or that a missing tooth leaves without contact.

    Raises
    ------
    InputError
    """
    part, pair = scene.case.pair[name], scene.pairs[name]
    if part.width == "slices":
        raise InputError(f"pair.{name}.width", '"slices"', "is not available over a revolution", 'set width = "solid"')
    odd = odd_gears_in(scene, name)
    if part.halves > 1 and odd:
        raise InputError(
            f"gear.{odd[0]}.odd_tooth", "(given)", "is not available for double helical pairs yet",
            "describe one half as a helical pair",
        )  # fmt: skip
    for gear in odd:
        check_odd_solid_gear(scene, gear)
    gone = any(flank.missing for gear in odd for _, flank in odd_teeth_of(scene, gear).flanks)
    if gone and not scene.case.effects.corner_contact and pair.total_contact_ratio < 2.0:
        raise InputError(
            "effects.corner_contact", "false",
            "leaves no tooth pair in contact at a missing tooth (total contact ratio "
            f"{pair.total_contact_ratio:.3f})",
            "set effects.corner_contact = true",
        )  # fmt: skip
