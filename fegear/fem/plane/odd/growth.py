"""The path of a growing crack: by the maximum tangential stress, in steps; lengths in modules.

The crack turns by theta = 2 atan((K_I - sqrt(K_I^2 + 8 K_II^2)) / (4 K_II)) (Erdogan and Sih 1963), where the
tangential stress beside its tip is largest. Each step meshes only the patch of sectors that the crack is in; all else
is condensed once (`patch`). Loads stand on the flank of the cracked tooth, where they stress the crack most. Elements
of two orders and two rings of integration show the error of each step; faces that may close press on each other as
`crack_faces` says.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.base.errors import FegearError, InputError
from fegear.base.one_thread import one_thread
from fegear.fem.plane.odd.crack import fillet_length
from fegear.fem.plane.odd.crack_faces import opening_rows, pressed
from fegear.fem.plane.odd.crack_over_sectors import Rest, cracked_patch, rest_of_ring
from fegear.fem.plane.odd.stress_intensity import RINGS, by_faces, interaction
from fegear.fem.plane.rim import rigid_motions
from fegear.fem.plane.sector_sides import between_sides, condensed_sector, ports_of
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.supported_section import assemble_section, assemble_section_two_orders
from fegear.fem.plane.trace import loaded_flank
from fegear.geometry.outline import tooth_outline, turned

if TYPE_CHECKING:
    from fegear.base.arrays import Array, Index
    from fegear.fem.plane.elasticity import SectorElasticity
    from fegear.fem.plane.odd.crack import Crack
    from fegear.fem.plane.odd.cracked_sector import CrackedSector
    from fegear.fem.plane.settings import MeshSettings
    from fegear.geometry.gear import Plane
    from fegear.geometry.involute_tooth import InvoluteTooth
    from fegear.geometry.rim_support import RimSupport

End = Literal["tooth", "rim"]

#: Meshes of a growing crack.
LEVEL = -3.0
#: Half-width of the pressure on the flank [modules]; no nearer to a flank's end.
_HALF_WIDTH = 0.1
#: Depth of a flank that the mouth of a crack may take from patches, as of `odd_influence`.
_MARGIN, _ABOVE_MOUTH = 0.15, 0.97
#: Part of the estimated error of one mode that the other one has at least, as of `odd_gear`.
_OTHER_MODE = 0.5
#: K_I of a crack whose faces press, as a share of both modes, below which its tip is shut.
_SHUT = 0.02


@dataclass(frozen=True)
class Grown:
    """A crack on its way, E = 1, per unit of the largest line load.

    Parameters
    ----------
    crack : Crack
        With all its pieces.
    path : ndarray, shape (2, n)
        Mouth, corners, and last the tip.
    k_1, k_2, k_1_error, k_2_error : ndarray, shape (S,)
        Stress intensity of each step at the load that makes the largest K_I, and its error [1/sqrt(module)].
    turn : ndarray, shape (S,)
        By what angle the crack turns after the step, positive to its left [rad].
    length : ndarray, shape (S,)
        Of the crack.
    radius : ndarray, shape (S,)
        Of that load.
    compliance, compliance_error : ndarray, shape (S,)
        Deflection of the tooth at `middle` under a load there.
    shut : ndarray, shape (S,)
        Share of the faces that presses under the load of the step; zero where faces are taken as open.
    middle : float
        Radius of the load of the first step.
    end : {"tooth", "rim"}
        What the crack breaks off, or heads for.
    stopped : str
        Why it ended: at a surface, after all steps, or since no mesh was sound.
    """

    crack: Crack
    path: Array
    k_1: Array
    k_2: Array
    k_1_error: Array
    k_2_error: Array
    turn: Array
    length: Array
    radius: Array
    compliance: Array
    compliance_error: Array
    shut: Array
    middle: float
    end: End
    stopped: Literal["surface", "steps", "closed"]

    @property
    def tip_error(self) -> Array:
        """How far the tip may lie beside the path of vanishing steps and elements, shape (S,) [modules].

        A direction that is wrong turns the crack back in the next step, and leaves an offset; so does a step that is
        straight where the path bends, by half of the next turn.
        """
        each = zip(self.k_1, self.k_2, self.k_1_error, self.k_2_error, strict=True)
        off = np.array([turn_error(*one) for one in each])[:-1] + 0.5 * np.abs(self.turn[1:])
        return np.append(0.0, np.cumsum(off * np.diff(self.length)))

    @property
    def off_the_path(self) -> Array:
        """What `tip_error` may change of K_I: as much as if the tip were so far behind or ahead, shape (S,)."""
        if self.length.size < 2:
            return np.zeros(self.length.size)
        return np.asarray(np.abs(np.gradient(self.k_1, self.length)) * self.tip_error)


def turning(k_1: float, k_2: float) -> float:
    """By what angle a crack turns, positive to its left [rad]: where the tangential stress is largest.

    K_II is positive where its left face moves toward the tip.
    """
    return -2.0 * math.atan2(2.0 * k_2, k_1 + math.sqrt(k_1 * k_1 + 8.0 * k_2 * k_2))


def turn_error(k_1: float, k_2: float, k_1_error: float, k_2_error: float) -> float:
    """What errors of both modes change of `turning` [rad]."""
    usual = turning(k_1, k_2)
    changed = (turning(max(k_1 - k_1_error, 0.0), k_2), turning(k_1, k_2 - k_2_error), turning(k_1, k_2 + k_2_error))
    by_one, below, above = (abs(one - usual) for one in changed)
    return by_one + max(below, above)


def equivalent(k_1: Array, k_2: Array) -> Array:
    """K_I of the same tangential stress: cos^2(t/2) (K_I cos(t/2) - 3 K_II sin(t/2)) with t the turn."""
    half = 0.5 * np.array([turning(float(a), float(b)) for a, b in zip(k_1, k_2, strict=True)])
    return np.asarray(np.cos(half) ** 2 * (k_1 * np.cos(half) - 3.0 * k_2 * np.sin(half)))


def grow(
    tooth: InvoluteTooth,
    bore_radius: float,
    poisson_ratio: float,
    plane: Plane,
    crack: Crack,
    loads: tuple[Array, Array],
    *,
    step: float,
    steps: int,
    support: RimSupport | None = None,
    settings: MeshSettings | None = None,
    estimates: bool = True,
) -> Grown:
    """Follow a crack step by step.

    Parameters
    ----------
    tooth : InvoluteTooth
    bore_radius : float
    poisson_ratio : float
    plane : {"strain", "stress"}
    crack : Crack
        Where it begins.
    loads : (ndarray, ndarray), shape (P,) each
        Radii on the flank, and line loads there.
    step : float
        Length of every straight piece that is added.
    steps : int
    support : RimSupport, optional
    settings : MeshSettings, optional
    estimates : bool
        Whether errors are estimated, which takes .7 of the time again; without, they are not numbers.

    Raises
    ------
    InputError
        If the first crack does not fit its tooth.
    """
    settings = settings_at(LEVEL) if settings is None else settings
    with one_thread():
        rest = rest_of_ring(tooth, bore_radius, poisson_ratio, plane, settings, support, two_orders=estimates)
        rows: list[_Step] = []
        turns: list[float] = []
        lengths: list[float] = []
        stopped: Literal["surface", "steps", "closed"] = "steps"
        middle = math.nan
        while True:
            try:
                found = _one(tooth, bore_radius, poisson_ratio, plane, crack, loads, rest, settings, support, middle)
            except (InputError, FegearError):
                if not rows:
                    raise
                stopped = "surface"
                crack = replace(crack, corners=crack.corners[:-1])
                break
            middle = found.middle
            rows.append(found)
            turns.append(turning(*found.k.tolist()))
            lengths.append(crack.length(tooth))
            # A tip that is pressed together has no K_I but what nodes leave of it.
            if found.k[0] <= (_SHUT * float(np.hypot(*found.k)) if found.shut else 0.0):
                stopped = "closed"
                break
            if len(rows) > steps:
                break
            crack = replace(crack, corners=(*crack.corners, _next(crack.path(tooth), turns[-1], step)))
    path = crack.path(tooth)
    return Grown(
        crack=crack,
        path=path,
        k_1=np.array([one.k[0] for one in rows]),
        k_2=np.array([one.k[1] for one in rows]),
        k_1_error=np.array([one.k_error[0] for one in rows]),
        k_2_error=np.array([one.k_error[1] for one in rows]),
        turn=np.array(turns),
        length=np.array(lengths),
        radius=np.array([one.radius for one in rows]),
        compliance=np.array([one.compliance for one in rows]),
        compliance_error=np.array([one.compliance_error for one in rows]),
        shut=np.array([one.shut for one in rows]),
        middle=middle,
        end=_ends_in(tooth, bore_radius, path, turns[-1], rest.half),
        stopped=stopped,
    )


def _next(path: Array, turn: float, step: float) -> tuple[float, float]:
    way = path[:, -1] - path[:, -2]
    way = way / np.hypot(*way)
    c, s = math.cos(turn), math.sin(turn)
    x, y = path[:, -1] + step * np.array([c * way[0] - s * way[1], s * way[0] + c * way[1]])
    return float(x), float(y)


@dataclass(frozen=True)
class _Step:
    """A crack under the load that opens it most; errors from elements one order lower and another ring."""

    k: Array
    k_error: Array
    radius: float
    compliance: float
    compliance_error: float
    middle: float
    shut: float


def _one(
    tooth: InvoluteTooth,
    bore_radius: float,
    poisson_ratio: float,
    plane: Plane,
    crack: Crack,
    loads: tuple[Array, Array],
    rest: Rest,
    settings: MeshSettings,
    support: RimSupport | None,
    middle: float,
) -> _Step:
    sector = cracked_patch(tooth, bore_radius, settings, crack, rest.half, support)
    asked = sector.mesh, poisson_ratio, plane, settings.order, settings.solver, support
    if rest.lower is not None:
        fine, coarse = assemble_section_two_orders(*asked)
    else:
        fine = assemble_section(*asked)
    first = math.isnan(middle)
    radius = np.append(loads[0], [] if first else [middle])
    rings, own, shut = _under(tooth, crack, sector, fine, rest, radius, poisson_ratio, plane, support)
    below, softer = np.full((1, *rings.shape[1:]), math.nan), np.full(own.shape, math.nan)
    if rest.lower is not None:
        below, softer, _ = _under(tooth, crack, sector, coarse, rest.lower, radius, poisson_ratio, plane, support)
    by_load = rings[0, :, : loads[0].size] * loads[1]
    worst = int(np.argmax(by_load[0]))
    off = np.abs(rings[1] - rings[0]) + np.abs(below[0] - rings[0])
    off = loads[1][worst] * off[:, worst]
    at = worst if first else -1
    return _Step(
        k=by_load[:, worst],
        k_error=np.maximum(off, _OTHER_MODE * off[::-1]),  # one mode may be right by chance
        radius=float(radius[worst]),
        compliance=float(own[at]),
        compliance_error=float(abs(own[at] - softer[at])),
        middle=float(radius[worst]) if first else middle,
        shut=float(shut[worst]),
    )


def _under(
    tooth: InvoluteTooth,
    crack: Crack,
    sector: CrackedSector,
    elasticity: SectorElasticity,
    rest: Rest,
    radius: Array,
    poisson_ratio: float,
    plane: Plane,
    support: RimSupport | None,
) -> tuple[Array, Array, Array]:
    """K by each ring of integration, shape (rings, 2, P), deflections, and share of the faces that is shut, (P,) each.

    Per unit load at radii of the flank of the cracked tooth.
    """
    mesh = sector.mesh
    margin = _MARGIN if crack.back else min(_MARGIN, _ABOVE_MOUTH * _above(tooth, crack))
    flank = loaded_flank(mesh, elasticity, tooth, margin)
    free = support is not None and support.kind == "free_arc"
    motions = rigid_motions(elasticity) if free else None
    face, opening, places = flank.dofs[:0], np.zeros((0, 0)), np.zeros((2, 0))
    if crack.closing:
        face, opening, places = opening_rows(mesh, elasticity)
    condensed, side, turn, _ = condensed_sector(
        mesh, elasticity, np.unique(np.concatenate([flank.dofs, face])), expandable=True, motions=motions,
        sectors=2 * rest.half + 1,
    )  # fmt: skip
    part = between_sides(condensed, side, turn)
    at = np.flatnonzero(rest.moves)
    follow = np.hstack([part.follow_a, part.follow_b])[:, at]
    stiffness = (part.held + rest.stiffness)[np.ix_(at, at)]
    arc = np.clip(flank.arc_of_radius(radius), flank.flank_start + _HALF_WIDTH, flank.flank_end - _HALF_WIDTH)
    pushed = flank.patches(arc, np.full(arc.shape, _HALF_WIDTH))
    run, on = ports_of(condensed, flank.dofs), ports_of(condensed, face)

    def moved(ports: Index, forces: Array) -> Array:
        """Motion of all ports under forces on some."""
        sides = np.linalg.solve(stiffness, follow[ports].T @ forces)
        return np.asarray(follow @ sides + part.own[:, ports] @ forces)

    every = moved(run, pushed)
    own, shut = np.einsum("ip,ip->p", pushed, every[run]), np.zeros(radius.size)
    by_face = np.zeros((0, radius.size))
    if crack.closing:
        back = moved(on, opening.T)
        by_face = pressed(opening @ back[on], opening @ every[on])
        own = own + ((opening @ every[on]) * by_face).sum(axis=0)
        every, shut = every + back @ by_face, (by_face > 0.0).mean(axis=0)
    found = []
    for ring in RINGS:
        forces = condensed.collect(interaction(sector, poisson_ratio, plane, elasticity.elements, ring))
        found.append(forces.T @ every + (by_faces(sector, places, ring) @ by_face if crack.closing else 0.0))
    return np.stack(found), own, shut


def _above(tooth: InvoluteTooth, crack: Crack) -> float:
    return fillet_length(tooth) - crack.mouth


def _ends_in(tooth: InvoluteTooth, bore_radius: float, path: Array, turn: float, half: int) -> End:
    """Whether a crack meets the bore or an outline first, straight on in its last direction."""
    way = path[:, -1] - path[:, -2]
    way = way / np.hypot(*way)
    c, s = math.cos(turn), math.sin(turn)
    way = np.array([c * way[0] - s * way[1], s * way[0] + c * way[1]])
    tip = path[:, -1]
    across, out = float(tip @ way), float(tip @ tip) - bore_radius**2
    room = across**2 - out
    to_bore = -across - math.sqrt(room) if room > 0.0 and across < 0.0 else math.inf
    outline = tooth_outline(tooth)
    to_outline = math.inf
    for k in range(-half - 1, half + 2):
        line = turned(outline, 2.0 * math.pi * k / tooth.teeth)
        first, chord = line[:, :-1] - tip[:, None], np.diff(line)
        cross = way[0] * chord[1] - way[1] * chord[0]
        with np.errstate(divide="ignore", invalid="ignore"):
            along = (first[0] * chord[1] - first[1] * chord[0]) / cross
            share = (first[0] * way[1] - first[1] * way[0]) / cross
        met = along[(share >= 0.0) & (share <= 1.0) & (along > 0.0)]
        to_outline = min(to_outline, float(met.min(initial=math.inf)))
    return "rim" if to_bore < to_outline else "tooth"
