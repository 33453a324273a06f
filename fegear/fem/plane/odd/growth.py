"""The path of a growing crack: by the maximum tangential stress, in steps; lengths in modules.

The crack turns by theta = 2 atan((K_I - sqrt(K_I^2 + 8 K_II^2)) / (4 K_II)) (Erdogan and Sih 1963), where the
tangential stress beside its tip is largest. Each step meshes only the patch of sectors that the crack is in; all else
is condensed once (`patch`). Loads stand on the flank of the cracked tooth, where they stress the crack most.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, replace
from typing import TYPE_CHECKING, Literal

import numpy as np

from fegear.base.errors import FegearError, InputError
from fegear.base.one_thread import one_thread
from fegear.fem.plane.odd.crack import fillet_length
from fegear.fem.plane.odd.patch import Rest, cracked_patch, rest_of_ring
from fegear.fem.plane.odd.stress_intensity import interaction
from fegear.fem.plane.rim import rigid_motions
from fegear.fem.plane.sector_sides import between_sides, condensed_sector, ports_of
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.supported_section import assemble_section
from fegear.fem.plane.trace import loaded_flank
from fegear.geometry.outline import tooth_outline, turned

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.fem.plane.odd.crack import Crack
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


@dataclass(frozen=True)
class Grown:
    """A crack on its way, E = 1, per unit of the largest line load.

    Parameters
    ----------
    crack : Crack
        With all its pieces.
    path : ndarray, shape (2, n)
        Mouth, corners, and last the tip.
    k_1, k_2 : ndarray, shape (S,)
        Stress intensity of each step at the load that makes the largest K_I [1/sqrt(module)].
    turn : ndarray, shape (S,)
        By what angle the crack turns after the step, positive to its left [rad].
    length : ndarray, shape (S,)
        Of the crack.
    radius : ndarray, shape (S,)
        Of that load.
    compliance : ndarray, shape (S,)
        Deflection of the tooth at `middle` under a load there.
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
    turn: Array
    length: Array
    radius: Array
    compliance: Array
    middle: float
    end: End
    stopped: Literal["surface", "steps", "closed"]


def turning(k_1: float, k_2: float) -> float:
    """By what angle a crack turns, positive to its left [rad]: where the tangential stress is largest.

    K_II is positive where its left face moves toward the tip.
    """
    return -2.0 * math.atan2(2.0 * k_2, k_1 + math.sqrt(k_1 * k_1 + 8.0 * k_2 * k_2))


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

    Raises
    ------
    InputError
        If the first crack does not fit its tooth.
    """
    settings = settings_at(LEVEL) if settings is None else settings
    with one_thread():
        rest = rest_of_ring(tooth, bore_radius, poisson_ratio, plane, settings, support)
        rows: list[tuple[float, ...]] = []
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
            middle = found[-1] if math.isnan(middle) else middle
            turn = turning(found[0], found[1])
            rows.append((*found[:2], turn, crack.length(tooth), *found[2:4]))
            if found[0] <= 0.0:
                stopped = "closed"
                break
            if len(rows) > steps:
                break
            crack = replace(crack, corners=(*crack.corners, _next(crack.path(tooth), turn, step)))
    k_1, k_2, turns, length, radius, compliance = np.array(rows).T
    path = crack.path(tooth)
    end = _ends_in(tooth, bore_radius, path, float(turns[-1]), rest.half)
    return Grown(crack, path, k_1, k_2, turns, length, radius, compliance, middle, end, stopped)


def _next(path: Array, turn: float, step: float) -> tuple[float, float]:
    way = path[:, -1] - path[:, -2]
    way = way / np.hypot(*way)
    c, s = math.cos(turn), math.sin(turn)
    x, y = path[:, -1] + step * np.array([c * way[0] - s * way[1], s * way[0] + c * way[1]])
    return float(x), float(y)


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
) -> tuple[float, float, float, float, float]:
    """K_I and K_II under the worst load, its radius, the compliance at `middle`, and that radius."""
    sector = cracked_patch(tooth, bore_radius, settings, crack, rest.half, support)
    mesh = sector.mesh
    elasticity = assemble_section(mesh, poisson_ratio, plane, settings.order, settings.solver, support)
    margin = _MARGIN if crack.back else min(_MARGIN, _ABOVE_MOUTH * _above(tooth, crack))
    flank = loaded_flank(mesh, elasticity, tooth, margin)
    free = support is not None and support.kind == "free_arc"
    motions = rigid_motions(elasticity) if free else None
    condensed, side, turn, _ = condensed_sector(
        mesh, elasticity, flank.dofs, expandable=True, motions=motions, sectors=2 * rest.half + 1
    )
    part = between_sides(condensed, side, turn)
    follow = np.hstack([part.follow_a, part.follow_b])
    at = np.flatnonzero(rest.moves)
    stiffness = (part.held + rest.stiffness)[np.ix_(at, at)]
    radius, force = loads
    first = math.isnan(middle)
    every = np.append(radius, [] if first else [middle])
    arc = np.clip(flank.arc_of_radius(every), flank.flank_start + _HALF_WIDTH, flank.flank_end - _HALF_WIDTH)
    pressed = flank.patches(arc, np.full(arc.shape, _HALF_WIDTH))
    run = ports_of(condensed, flank.dofs)
    moved = np.linalg.solve(stiffness, follow[run][:, at].T @ pressed)
    gathered = condensed.collect(interaction(sector, poisson_ratio, plane, elasticity.elements))
    k = gathered.T @ (follow[:, at] @ moved + part.own[:, run] @ pressed)
    own = np.einsum("ip,ip->p", pressed, follow[run][:, at] @ moved + part.own[np.ix_(run, run)] @ pressed)
    by_load = k[:, : radius.size] * force
    worst = int(np.argmax(by_load[0]))
    place = float(radius[worst]) if first else middle
    compliance = float(own[worst] if first else own[-1])
    return float(by_load[0, worst]), float(by_load[1, worst]), float(radius[worst]), compliance, place


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
