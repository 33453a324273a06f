"""One solid ring solved: what flank and fillets answer to forces on the flank; module 1, Young's modulus 1."""

from __future__ import annotations

import math
import time
from collections import deque
from collections.abc import Mapping, MutableSequence
from dataclasses import dataclass, field, replace

import numpy as np

from fegear.base.arrays import Array
from fegear.base.errors import RangeError
from fegear.base.one_thread import one_thread
from fegear.base.tally import tallied
from fegear.fem.plane.body import RING
from fegear.fem.plane.influence import Side
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.ring_closure import closed_ring
from fegear.fem.plane.sector_sides import BetweenSides
from fegear.fem.plane.trace import LoadedFlank
from fegear.fem.solid.bands import Bands, bands, loads_of
from fegear.fem.solid.dissection import condense_solid
from fegear.fem.solid.face import FaceFunctions
from fegear.fem.solid.fillet import SolidFillet
from fegear.fem.solid.holed_teeth import HoledHalf, HoledTeeth, holed_teeth
from fegear.fem.solid.holed_web import holes_of
from fegear.fem.solid.pinned_rim import pinned_response, pins_on
from fegear.fem.solid.rim import free_ring, solid_rim, splined_response
from fegear.fem.solid.sector import FILLETS, SolidSector, section_mesh, solid_sector
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solved_flank import SolvedFlank
from fegear.fem.solid.uneven_teeth import UnevenTeeth, teeth_apart
from fegear.geometry.gear_body import GearBody
from fegear.geometry.involute_side import InvoluteSide
from fegear.geometry.rim_support import RimSupport


@dataclass(frozen=True)
class SolidSolution(SolvedFlank):
    """What one solid ring answers: deflections of the flank and of the fillets under forces on the flank.

    Parameters
    ----------
    tooth : InvoluteSide
        The transverse section.
    tau : float
        Twist [rad/module], positive for a right hand.
    width : float
        [modules].
    bore_radius : float
        [modules].
    held : (float, float) or None
        Part of the width on which the bore is held.
    body : GearBody or None
        Web and hub that carry the rim; None of a disc as wide as the face.
    poisson_ratio : float
    plane_strain : bool
        Whether nothing moves along the axis.
    face : FaceFunctions
    flank : LoadedFlank
    compliance : mapping of int to ndarray, shape (n, n)
        Approach -N . u of the flank of tooth k under forces on tooth 0; node by node, function by function.
    fillets : mapping of {"tension", "compression"} to SolidFillet
    displacement : mapping of (int, side) to ndarray, shape (nodes, 3, functions, n)
        Of a fillet's nodes on tooth k, in the axes of its own tooth.
    reach, unknowns : int
        K: neighbours -K..K are known; size of the sector's system.
    settings : SolidSettings
    seconds : mapping of str to float
    support : RimSupport or None
        Of a ring gear's rim; None of an outer cylinder that is held, and of external gears. On pins compliance and
        displacement are the mean over all teeth.
    uneven : UnevenTeeth or None
        How the teeth differ.
    holed : HoledTeeth or None
        What each tooth owes to the holes of its web; compliance and displacement are the mean over all teeth.
    """

    #: Its section turns along the face.
    slide = 0.0

    tooth: InvoluteSide
    tau: float
    width: float
    bore_radius: float
    held: tuple[float, float] | None
    body: GearBody | None
    poisson_ratio: float
    plane_strain: bool
    face: FaceFunctions
    flank: LoadedFlank
    compliance: Mapping[int, Array]
    fillets: Mapping[Side, SolidFillet]
    displacement: Mapping[tuple[int, Side], Array]
    reach: int
    unknowns: int
    settings: SolidSettings
    seconds: Mapping[str, float] = field(compare=False)
    support: RimSupport | None = None
    uneven: UnevenTeeth | None = None
    holed: HoledTeeth | None = None


@tallied("tooth shapes")
def solve_solid(
    tooth: InvoluteSide,
    tau: float,
    width: float,
    poisson_ratio: float,
    bore_radius: float,
    settings: SolidSettings | None = None,
    *,
    reach: int = 1,
    held: tuple[float, float] | None = None,
    body: GearBody | None = None,
    mesh: SectorMesh | None = None,
    sector_teeth: int = 0,
    plane_strain: bool = False,
    support: RimSupport | None = None,
    compared: Bands | None = None,
) -> SolidSolution:
    """Solve one solid ring for all that can be asked of its teeth.

    Parameters
    ----------
    tooth : InvoluteSide
        The transverse section.
    tau : float
        Twist tan(beta) / r [rad/module], positive for a right hand (z along the axis, out of the drawing).
    width : float
        [modules].
    poisson_ratio : float
    bore_radius : float
        [modules].
    settings : SolidSettings, optional
    reach : int
        K: neighbours -K..K; at most (z - 1) // 2.
    held : (float, float), optional
        Part of the width, from -width / 2 to width / 2, on which the bore is held; by default all of it, or all of
        the hub.
    body : GearBody, optional
        Web and hub that carry the rim; by default a disc as wide as the face.
    mesh : SectorMesh, optional
        A section's mesh instead of the generated one.
    sector_teeth : int
        Solve a row of so many teeth with free sides, loaded in the middle, instead of the ring.
    plane_strain : bool
        Nothing moves along the axis: a check, which without a twist is the plane problem.
    support : RimSupport, optional
        Of a ring gear's rim, pins or a spline; by default its whole outer cylinder is held.
    compared : Bands, optional
        One band, under which the teeth of a ring on pins are compared; by default one at half height in the middle of
        the face.

    Returns
    -------
    SolidSolution

    Raises
    ------
    RangeError
        If a support or holes are asked for that a whole ring alone can have.
    """
    settings = settings or SolidSettings()
    if body is not None and body.holes is not None and (sector_teeth or plane_strain):
        raise RangeError("body.holes", body.holes.count, "are available for full 3D gears only")
    if support is not None:
        _check_support(support, tooth, alone=held is None and body is None and not sector_teeth)
    with one_thread():
        return _solve(
            tooth, tau, width, poisson_ratio, bore_radius, settings, reach, held, body, mesh, sector_teeth,
            plane_strain, support, compared, deque(maxlen=0),
        )[0]  # fmt: skip


@dataclass(frozen=True)
class SolvedSector:
    """A solid ring, and its sector by itself: what a ring is made of in which other sectors stand, too.

    Parameters
    ----------
    solution : SolidSolution
    sector : SolidSector
    parts : tuple of BetweenSides
        The sector between its sides, of each of `SolidSector.halves`.
    """

    solution: SolidSolution
    sector: SolidSector
    parts: tuple[BetweenSides, ...]


def solve_with_sector(
    tooth: InvoluteSide, tau: float, width: float, poisson_ratio: float, bore_radius: float, settings: SolidSettings,
    *, reach: int, body: GearBody | None = None, mesh: SectorMesh | None = None, plane_strain: bool = False,
) -> SolvedSector:  # fmt: skip
    """As `solve_solid`, of a whole ring whose bore is held, with its sector."""
    parts: list[BetweenSides] = []
    with one_thread():
        solution, sector = _solve(
            tooth, tau, width, poisson_ratio, bore_radius, settings, reach, None, body, mesh, 0, plane_strain, None,
            None, parts,
        )  # fmt: skip
    return SolvedSector(solution, sector, tuple(parts))


def _solve(
    tooth: InvoluteSide, tau: float, width: float, nu: float, bore_radius: float, settings: SolidSettings, reach: int,
    held: tuple[float, float] | None, body: GearBody | None, mesh: SectorMesh | None, sector_teeth: int,
    plane_strain: bool, support: RimSupport | None, compared: Bands | None, parts: MutableSequence[BetweenSides],
) -> tuple[SolidSolution, SolidSector]:  # fmt: skip
    started = time.perf_counter()
    reach = min(reach, ((sector_teeth or tooth.teeth) - 1) // 2)
    if mesh is None:
        mesh = section_mesh(tooth, bore_radius, settings.section, body, frontal=True, fewest=settings.body_layers)
    sector = solid_sector(
        tooth, tau, width, nu, mesh, settings, body, held, plane_strain=plane_strain, bore_held=support is None
    )
    section, known, own, flank, fillets = sector.section, sector.known, sector.face, sector.flank, sector.fillets
    face, columns = sector.body_face, sector.columns
    integrated = time.perf_counter()
    sides, ports, seen = sector.sides, sector.ports, list(sector.seen.values())
    counts = (known.number[::3] >= 0).sum(axis=1)
    rim = None if support is None else solid_rim(section, face, counts, plane_strain=plane_strain)
    pins = pins_on(section, face, counts, support, tooth.teeth) if support is not None and support.pins else None
    band = _half_height(tooth, flank, own, settings, tau) if compared is None else compared
    holes = holes_of(body, section, face, settings, tooth.root_radius, nu)
    reference = np.zeros(0) if pins is None and holes is None else loads_of(band, flank, own)[:, 0]
    others = (3 * section.nodes_of(*(RING if rim is None else ("bore",)))[:, None] + np.arange(3)).ravel()
    inner = np.setdiff1d(np.concatenate([ports, *seen, others]), np.concatenate(sides))
    on_flank = known.number[ports] >= 0
    size = int(on_flank.sum())
    compliance = {k: np.zeros((size, size)) for k in range(-reach, reach + 1)}
    local = {(k, side): np.zeros((part.size, own.count, size))
             for k in compliance for side, part in zip(FILLETS, seen, strict=True)}  # fmt: skip
    teeth = 1 if pins is None else pins.different
    each = {side: np.zeros((part.size, own.count, teeth)) for side, part in zip(FILLETS, seen, strict=True)}
    approach = np.zeros(teeth)
    halves: list[HoledHalf] = []
    seconds = {"section": integrated - started, "condensation": 0.0, "ring": 0.0, "influence": 0.0}
    for alone in sector.halves():
        begun = time.perf_counter()
        condensed = condense_solid(section, sector.joined, alone, np.concatenate([*sides, inner]))
        joint, loaded = alone.of(sides[0]).size, alone.of(ports)
        watch = np.concatenate([loaded, *(alone.of(part) for part in seen)])
        mine = np.flatnonzero((alone.number[ports] >= 0)[on_flank])
        apart = None
        if rim is None:
            ring = closed_ring(condensed, joint, None, tooth.teeth, reach, sector_teeth=sector_teeth, started=begun)
            response = ring.respond(loaded, watch)
            if holes is not None:
                there = [np.nonzero(alone.number[part][:, columns] >= 0) for part in seen]
                halves.append(holes.closed(ring, alone, watch, mine, there))
                response = halves[-1].added_to(response)
        else:
            free = free_ring(condensed, joint, rim, alone, tooth.teeth, reach, begun)
            ring = free.ring
            if pins is None:
                response = splined_response(free, loaded, watch)
            else:
                load = reference[mine]
                response, apart = pinned_response(free, pins, alone, loaded, watch, load)
                approach += apart[:, : loaded.size] @ load
        for k, u in response.items():
            compliance[k][np.ix_(mine, mine)] = u[: loaded.size]
            row = loaded.size
            for side, part in zip(FILLETS, seen, strict=True):
                node, function = np.nonzero(alone.number[part][:, columns] >= 0)
                local[k, side][node[:, None], function[:, None], mine] = u[row : row + node.size]
                if k == 0 and apart is not None:
                    each[side][node, function] = apart[:, row : row + node.size].T
                row += node.size
        parts.append(ring.part)
        after = time.perf_counter() - begun - sum(ring.seconds.values())
        for what, spent in {**ring.seconds, "influence": after}.items():
            seconds[what] += spent

    displacement = {(k, side): sector.in_space(side, moved) for (k, side), moved in local.items()}
    found = SolidSolution(
        tooth, tau, width, bore_radius, sector.held if body is None else body.hub, body, nu, plane_strain, own, flank,
        compliance, fillets, displacement,
        reach, known.size, settings, seconds, support,
    )  # fmt: skip
    moved = {side: sector.in_space(side, apart) for side, apart in each.items()}
    if halves:
        shapes = {side: (part.size, own.count) for side, part in zip(FILLETS, seen, strict=True)}
        holed = holed_teeth(halves, size, shapes, sector.in_space)
        approach, moved = holed.apart(reference)
        found = replace(found, holed=holed)
    if reference.size:
        found = replace(found, uneven=teeth_apart(found, band, reference, approach, moved))
    return found, sector


def _half_height(
    tooth: InvoluteSide, flank: LoadedFlank, face: FaceFunctions, settings: SolidSettings, tau: float
) -> Bands:
    """A band of a module's length at half height in the middle of the face."""
    arc = 0.5 * (flank.flank_start + flank.flank_end)
    (radius,) = flank.radius_of_arc(np.array([arc]))
    width = min(settings.band_half_width, settings.room_share * (flank.flank_end - arc))
    slope = -tau * math.sqrt(max(radius**2 - tooth.base_radius**2, 0.0))
    return bands(radius, 0.0, min(0.5, 0.5 * face.width), width, slope=slope)


def _check_support(support: RimSupport, tooth: InvoluteSide, *, alone: bool) -> None:
    if not (tooth.internal and alone):
        raise RangeError(
            "rim_support.kind", f'"{support.kind}"',
            "is available for complete internal rings only, without a body or a fixed part",
            "specify rim and web of a 3D external gear in body",
        )  # fmt: skip
