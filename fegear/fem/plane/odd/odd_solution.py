"""A real gear with odd teeth (cracked, shorter, missing, above a hole), from the same gear of ordinary teeth."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.fem.plane.gear import GearInfluence
from fegear.fem.plane.influence import Influence
from fegear.fem.plane.mesh import GENERATED, SectorMesh
from fegear.fem.plane.odd.crack_faces import CrackFaces
from fegear.fem.plane.odd.cracked_sector import cracked_sector
from fegear.fem.plane.odd.hole import Hole, holed_sector
from fegear.fem.plane.odd.keyway import Keyway, keyed_patch, refuse_keyway
from fegear.fem.plane.odd.odd_gear import TOUCHED, OddGearInfluence
from fegear.fem.plane.odd.odd_influence import OddInfluence, solve_odd_influence
from fegear.fem.plane.odd.odd_ring import OddRing
from fegear.fem.plane.odd.other_outline import Missing, OtherTip
from fegear.fem.plane.odd.other_sector import empty_sector, shorter_sector
from fegear.fem.plane.odd.patch_kinds import Patch
from fegear.fem.plane.odd.patched_influence import solve_patched_influence
from fegear.fem.plane.odd.tooth_kind import OddTooth, ToothKind
from fegear.fem.plane.root_stress import FilletStrain
from fegear.fem.plane.solution import shape_codec
from fegear.fem.plane.trace import LoadedFlank
from fegear.geometry.involute_tooth import InvoluteTooth

if TYPE_CHECKING:
    from fegear.fem.plane.odd.crack import Crack
    from fegear.fem.plane.settings import MeshSettings
    from fegear.geometry.rim_support import RimSupport

    Oddity = Crack | OtherTip | Missing | Hole | Keyway

#: What a solved ring with odd teeth consists of.
_KINDS: tuple[type, ...] = (
    OddInfluence, ToothKind, CrackFaces, OddRing, Patch, SectorMesh, LoadedFlank, FilletStrain
)  # fmt: skip
#: So many teeth on either side of the outermost odd ones are known by number at least; on either side of a keyway's
#: sectors: of 25 teeth it changes c_ii of the first of these by 4 %, and of each further one by half as much.
_BESIDE, _BESIDE_KEYWAY = 2, 5


def solve_cracked_gear(
    ordinary: GearInfluence,
    cracks: Mapping[int, Oddity],
    *,
    beside: int | None = None,
    cache: SolutionCache | None = None,
) -> OddGearInfluence:
    """Solve a gear some of whose teeth are cracked, shorter, missing or above a hole, from the one of ordinary teeth.

    Parameters
    ----------
    ordinary : GearInfluence
        Its settings are taken, and whether errors are estimated.
    cracks : mapping of int to Crack, OtherTip, Missing, Hole or Keyway
        By the number of the tooth.
    beside : int, optional
        Teeth on either side of the outermost odd ones that are known by number, where there are so many; by default
        as many as neighbours are known of the ordinary gear, and two at least.
    cache : SolutionCache, optional
        Where solved gears are recalled from and kept.

    Raises
    ------
    InputError
        If all teeth are ordinary; if a crack or a tip does not fit its tooth; of a gear with a mesh of its own, or a
        rim on pins.
    """
    started, gear = time.perf_counter(), ordinary.gear
    known = SolutionCache() if cache is None else cache
    _refuse(ordinary, cracks)
    middle, numbers = _numbers(cracks, gear.teeth)
    beside = max(_BESIDE, ordinary.reach) if beside is None else max(beside, TOUCHED)
    keyways = [one for one in cracks.values() if isinstance(one, Keyway)]
    if keyways:
        bore = gear.bore_radius / gear.module
        refuse_keyway(gear.symmetric_tooth, bore, keyways[0])
        half = keyways[0].sectors_beside(gear.teeth, bore)
        reach = min(half + max(beside, _BESIDE_KEYWAY), (gear.teeth - 2) // 2)
    else:
        reach = min(max(map(abs, numbers)) + beside, (gear.teeth - 1) // 2)
    fine = known.call_kept(
        shape_codec(gear.tooth, _KINDS), _solve, ordinary.fine, gear.bore_radius / gear.module, ordinary.settings,
        tuple(zip(numbers, cracks.values(), strict=True)), reach, ordinary.fine.lower is not None,
    ).value  # fmt: skip
    fine = _with_teeth(fine, dict(zip(numbers, cracks.values(), strict=True)), gear.symmetric_tooth)
    return OddGearInfluence(ordinary, fine, middle, {**fine.seconds, "total": time.perf_counter() - started})


def _with_teeth(fine: OddInfluence, unlike: Mapping[int, Oddity], ordinary: InvoluteTooth) -> OddInfluence:
    """A solution whose shorter teeth know their outline: what is recalled from disk has the ordinary tooth for all."""
    shorter = {number: one.tooth(ordinary) for number, one in unlike.items() if isinstance(one, OtherTip)}
    if not shorter:
        return fine
    odd = {
        number: replace(kind, tooth=shorter[number]) if number in shorter else kind for number, kind in fine.odd.items()
    }
    lower = None if fine.lower is None else _with_teeth(fine.lower, unlike, ordinary)
    return replace(fine, odd=odd, lower=lower)


def _refuse(ordinary: GearInfluence, cracks: Mapping[int, Oddity]) -> None:
    if not cracks:
        raise InputError("cracks", "(none)", "must name at least one tooth")
    z = ordinary.gear.teeth
    if len({number % z for number in cracks}) < len(cracks):
        raise InputError("cracks", sorted(cracks), f"name one of {z} teeth twice")
    support = ordinary.fine.support
    if support is not None and support.kind not in ("free_arc", "web"):
        raise InputError(
            "rim_support.kind", f'"{support.kind}"', "is not available for a gear with odd teeth",
            'set kind = "free_arc" or "web"',
        )  # fmt: skip
    if len(cracks) > 1 and any(isinstance(one, Keyway) for one in cracks.values()):
        raise InputError("keyway", "(given)", "is not available beside other odd teeth", "remove one of them")
    if support is not None and any(isinstance(one, Keyway) for one in cracks.values()):
        raise InputError(
            "rim_support.kind", f'"{support.kind}"', "is not available for a gear with a keyway",
            "remove rim_support (the bore is fixed)",
        )  # fmt: skip
    if ordinary.fine.mesh.origin != GENERATED:
        raise InputError("mesh", ordinary.fine.mesh.origin, "of a gear with odd teeth must be a generated one")


def _numbers(cracks: Mapping[int, Oddity], teeth: int) -> tuple[int, list[int]]:
    """Tooth in the middle of the shortest arc with all odd ones, and their numbers from it, in their order."""
    at = sorted(number % teeth for number in cracks)
    gaps = [(after - before) % teeth or teeth for before, after in zip(at, at[1:] + at[:1], strict=True)]
    widest = int(np.argmax(gaps))
    first, span = at[(widest + 1) % len(at)], teeth - gaps[widest]
    middle = first + span // 2
    return middle % teeth, [(number - middle + teeth // 2) % teeth - teeth // 2 for number in cracks]


def _solve(
    fine: Influence,
    bore_radius: float,
    settings: MeshSettings,
    cracks: tuple[tuple[int, Oddity], ...],
    reach: int,
    two_orders: bool,
) -> OddInfluence:
    tooth = fine.tooth
    if not isinstance(tooth, InvoluteTooth):
        raise TypeError("odd teeth are placed on gears with equal flanks only")
    ((_, first), *_) = cracks
    if isinstance(first, Keyway):
        half = first.sectors_beside(tooth.teeth, bore_radius)
        return solve_patched_influence(
            tooth, fine.mesh, keyed_patch(tooth, bore_radius, settings, first), half, fine.poisson_ratio, fine.plane,
            settings, reach=reach, two_orders=two_orders, known=fine,
        )  # fmt: skip
    odd = {
        number: _odd_tooth(tooth, fine.support, bore_radius, settings, one)
        for number, one in cracks
        if not isinstance(one, Missing | Keyway)
    }
    missing = {
        number: empty_sector(tooth, bore_radius, settings, fine.support)
        for number, one in cracks
        if isinstance(one, Missing)
    }
    return solve_odd_influence(
        tooth, fine.mesh, odd, fine.poisson_ratio, fine.plane, settings, reach=reach, two_orders=two_orders,
        missing=missing, support=fine.support, known=fine,
    )  # fmt: skip


def _odd_tooth(
    tooth: InvoluteTooth,
    support: RimSupport | None,
    bore_radius: float,
    settings: MeshSettings,
    one: Crack | OtherTip | Hole,
) -> OddTooth:
    if isinstance(one, Hole):
        return OddTooth(tooth, holed_sector(tooth, bore_radius, settings, one, support))
    if isinstance(one, OtherTip):
        return OddTooth(*shorter_sector(tooth, bore_radius, settings, one, support))
    return OddTooth(tooth, cracked_sector(tooth, bore_radius, settings, one, support))
