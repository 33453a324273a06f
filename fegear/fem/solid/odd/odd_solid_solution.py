"""Solve a solid gear some of whose teeth are cracked or missing: one ring of ordinary sectors, and the odd ones."""

from __future__ import annotations

import time
from collections.abc import Mapping
from dataclasses import replace
from itertools import pairwise
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.base.one_thread import one_thread
from fegear.base.tally import tallied
from fegear.fem.plane.body import with_body
from fegear.fem.plane.elements import sector_elements
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.odd.crack import Crack
from fegear.fem.plane.odd.cracked_sector import CrackedSector, cracked_sector
from fegear.fem.plane.odd.odd_ring import odd_ring
from fegear.fem.plane.odd.other_outline import Missing
from fegear.fem.plane.odd.other_sector import empty_sector
from fegear.fem.solid.odd.front_intensity import front_rows
from fegear.fem.solid.odd.odd_solid import OddSolid
from fegear.fem.solid.odd.odd_window import TOUCHED, OddWindow
from fegear.fem.solid.odd.solid_kind import SolidKind, between, motion, solid_kind
from fegear.fem.solid.sector import SolidSector, solid_sector
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import SolvedSector, solve_with_sector

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.fem.plane.sector_sides import BetweenSides
    from fegear.geometry.gear_body import GearBody
    from fegear.geometry.involute_tooth import InvoluteTooth

    SolidOddity = Crack | Missing | SectorMesh


@tallied("tooth shapes")
@tallied("odd sectors")
def solve_odd_solid(
    tooth: InvoluteTooth,
    tau: float,
    width: float,
    poisson_ratio: float,
    bore_radius: float,
    settings: SolidSettings | None = None,
    *,
    odd: Mapping[int, SolidOddity],
    reach: int = 1,
    body: GearBody | None = None,
    mesh: SectorMesh | None = None,
    plane_strain: bool = False,
    intensity: bool = False,
) -> OddSolid:
    """Solve a solid ring with odd teeth for all that can be asked of its flanks and fillets.

    Parameters
    ----------
    tooth, tau, width, poisson_ratio, bore_radius, settings, reach, body, mesh, plane_strain
        As of `fegear.fem.solid.solution.solve_solid`.
    odd : mapping of int to Crack, Missing or SectorMesh
        By the number of the tooth: a crack through the whole face, straight along it (along the helix of a helical
        gear), whose faces do not touch; no tooth; or a mesh of its section, sides as the ordinary one's.
    intensity : bool
        Whether stress intensity along cracks will be asked for, of spur gears; it takes memory.

    Raises
    ------
    InputError
        If no tooth is odd, one is named twice, a crack does not fit its tooth, or an odd sector's sides are not the
        ordinary one's.
    RangeError
        If the gear cannot be meshed, or its web has holes.
    FegearError
        If a stiffness is not positive definite.
    """
    settings, started = settings or SolidSettings(), time.perf_counter()
    z = tooth.teeth
    _refuse(odd, z, tooth, body)
    _refuse_intensity(tau, intensity=intensity)
    usual = solve_with_sector(
        tooth, tau, width, poisson_ratio, bore_radius, settings, reach=reach, body=body, mesh=mesh,
        plane_strain=plane_strain,
    )  # fmt: skip
    solved = time.perf_counter()

    def sector_of(mesh: SectorMesh) -> SolidSector:
        return solid_sector(
            tooth, tau, width, poisson_ratio, mesh, settings, body, plane_strain=plane_strain, beside=usual.sector
        )

    with one_thread():
        kinds: dict[int, SolidKind] = {}
        parts: dict[int, tuple[BetweenSides, ...]] = {}
        for number, one in odd.items():
            first = next(other for other, what in odd.items() if what is one or what == one)
            if first not in parts:
                section, cracked = _section(tooth, bore_radius, settings, body, one)
                sector, rows = sector_of(section), None
                if cracked is not None and intensity:
                    whole = replace(cracked, mesh=section)
                    rows = front_rows(whole, poisson_ratio, sector_elements(section, settings.section.order))
                parts[first] = tuple(between(sector, alone, expandable=rows is not None) for alone in sector.halves())
                if not isinstance(one, Missing):
                    kinds[first] = _kind(sector, parts[first], cracked, rows)
            parts[number] = parts[first]
            if first in kinds:
                kinds[number] = kinds[first]
        condensed = time.perf_counter()
        ordinary = _kind(usual.sector, usual.parts)
        windows = tuple(_window(usual, ordinary, kinds, parts, group, z) for group in _groups(list(odd), z))
    seconds = {
        **usual.solution.seconds, "odd sectors": condensed - solved, "odd ring": time.perf_counter() - condensed,
        "total": time.perf_counter() - started,
    }  # fmt: skip
    return OddSolid(usual.solution, windows, seconds)


def _kind(
    sector: SolidSector,
    parts: tuple[BetweenSides, ...],
    cracked: CrackedSector | None = None,
    front: Array | None = None,
) -> SolidKind:
    """What stands in a sector that is condensed."""
    motions = tuple(motion(sector, alone, part, front) for alone, part in zip(sector.halves(), parts, strict=True))
    if cracked is None:
        return solid_kind(sector, motions)
    return solid_kind(sector, motions, cracked.mouth, back=cracked.back)


def _refuse_intensity(tau: float, *, intensity: bool) -> None:
    if intensity and tau != 0.0:
        raise InputError("intensity", "true", "is available for spur gears only (the crack front runs along the axis)")


def _refuse(odd: Mapping[int, SolidOddity], teeth: int, tooth: InvoluteTooth, body: GearBody | None) -> None:
    if not odd:
        raise InputError("odd", "(none)", "must name at least one tooth")
    if len({number % teeth for number in odd}) < len(odd):
        raise InputError("odd", sorted(odd), f"name one of {teeth} teeth twice")
    if tooth.internal:
        raise InputError("internal", "true", "is not available for a 3D gear with odd teeth")
    if body is not None and body.holes is not None:
        raise InputError("body.holes", body.holes.count, "are not available for a gear with odd teeth")


def _section(
    tooth: InvoluteTooth, bore_radius: float, settings: SolidSettings, body: GearBody | None, one: SolidOddity
) -> tuple[SectorMesh, CrackedSector | None]:
    """Mesh of an odd sector, and where its crack is."""
    if isinstance(one, SectorMesh):
        return one, None
    inside = bore_radius if body is None else body.rim_radius
    cracked = None if isinstance(one, Missing) else cracked_sector(tooth, inside, settings.section, one)
    mesh = empty_sector(tooth, inside, settings.section) if cracked is None else cracked.mesh
    if body is not None:
        mesh = with_body(mesh, body, bore_radius, settings.section.rim_fraction, settings.body_layers)
    return mesh, cracked


def _groups(numbers: list[int], teeth: int) -> list[list[int]]:
    """Odd teeth so near to each other that teeth between them answer to both."""
    at = sorted(numbers, key=lambda number: number % teeth)
    found = [[at[0]]]
    for before, after in pairwise(at):
        if (after - before) % teeth <= 2 * TOUCHED + 1:
            found[-1].append(after)
        else:
            found.append([after])
    if len(found) > 1 and (at[0] - at[-1]) % teeth <= 2 * TOUCHED + 1:
        found[0] = [*found.pop(), *found[0]]
    return found


def _window(
    usual: SolvedSector,
    ordinary: SolidKind,
    kinds: Mapping[int, SolidKind],
    parts: Mapping[int, tuple[BetweenSides, ...]],
    group: list[int],
    teeth: int,
) -> OddWindow:
    span = (group[-1] - group[0]) % teeth
    middle = (group[0] + span // 2) % teeth
    near = {(number - middle + teeth // 2) % teeth - teeth // 2: number for number in group}
    reach = min(max(map(abs, near)) + TOUCHED, (teeth - 1) // 2)
    rings = tuple(
        odd_ring(part.held, {k: parts[number][n] for k, number in near.items()}, teeth, reach)
        for n, part in enumerate(usual.parts)
    )
    return OddWindow(
        middle, teeth, usual.solution.face.count, ordinary,
        {k: kinds[number] for k, number in near.items() if number in kinds},
        tuple(k for k, number in near.items() if number not in kinds), rings,
    )  # fmt: skip
