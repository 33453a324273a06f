"""Lead correction of the meshes of a gearbox: helix slope and crowning that even out the load over the torque range.

The load over the face follows from shafts and flanks together, so that a corrected mesh bends its shafts otherwise than
an uncorrected one. The correction is searched with the gaps that the shafts open under the present flanks; all meshes
with their corrections are then loaded together once more, and again from there, and what is stated is of that state.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import minimize

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.contact.loaded_teeth import silent
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.on_shafts import FlankForces, LoadedShafts, MeshForces, load_gearbox
from fegear.contact.wide.over_pitch import over_pitch
from fegear.contact.wide.shaft_gaps import ShaftGaps
from fegear.geometry.flank_modification import FlankModification, HelixSlope, LeadCrowning
from fegear.shafts.gearbox import Gearbox

#: Amounts are whole multiples of this [m]: what is ground is not finer.
GRADUATION = 0.5e-6
#: Times that corrections are searched and all meshes loaded with them.
_ROUNDS = 2
#: Evaluations of one search, and its end: amounts and K_Hbeta.
_EVALUATIONS, _AMOUNT, _FACTOR = 60, 0.2e-6, 1e-3
#: Most multiples of the shafts' tilt that a single slope is tried with.
_TIMES = 4


@dataclass(frozen=True)
class LeadCorrection(ReadOnlyArrays):
    """What is ground on the driver of a mesh besides its present flanks, and what that does.

    Parameters
    ----------
    slope, crowning : float
        Helix slope, from zero at end I to this at end II, and crowning, over the driver's own face [m].
    loads : ndarray, shape (L,)
        Along the transverse line of action [N].
    before, after : ndarray, shape (L,)
        K_Hbeta.
    left : ndarray, shape (L,)
        What the shafts' gaps at one round less change of `after`.
    """

    slope: float
    crowning: float
    loads: Array
    before: Array
    after: Array
    left: Array


def lead_modifications(slope: float, crowning: float, width: float) -> tuple[FlankModification, ...]:
    """Both as modifications over a face of this width [m]; nothing where an amount is zero."""
    return (
        *((LeadCrowning(crowning, width),) if crowning else ()),
        *((HelixSlope(slope, width),) if slope else ()),
    )


@dataclass(frozen=True)
class LevelLead:
    """A helix slope on the driver against the tilt of the shafts, under one load.

    Parameters
    ----------
    slope : float
        From zero at end I to this at end II, over the driver's own face [m].
    before, after : float
        K_Hbeta in the gaps of the present flanks.
    """

    slope: float
    before: float
    after: float


def level_lead(mesh: FlankForces, shafts: ShaftGaps, load: float) -> LevelLead | None:
    """The helix slope that takes away the tilt of the shafts, or as many times that as still lower K_Hbeta.

    None where the tilt is below what is ground, or a slope against it gains nothing.

    Parameters
    ----------
    mesh : FlankForces
        With the present flanks.
    shafts : ShaftGaps
    load : float
        Along the transverse line of action [N].
    """
    tilt = GRADUATION * round(_tilt(mesh, shafts, load) / GRADUATION)
    if not tilt:
        return None
    best = LevelLead(0.0, *2 * (float(face_load_factors(mesh, shafts, np.array([load]), load)[0]),))
    for times in range(1, _TIMES + 1):
        ground = replace(mesh, gaps=_ground(mesh, times * tilt, 0.0))
        after = float(face_load_factors(ground, shafts, np.array([load]), load)[0])
        if after >= best.after:
            break
        best = replace(best, slope=times * tilt, after=after)
    return best if best.slope else None


def correct_leads(
    gearbox: Gearbox,
    meshes: Sequence[MeshForces],
    present: LoadedShafts,
    progress: Callable[[float], None] = silent,
) -> tuple[LeadCorrection | None, ...]:
    """Correct every mesh whose flanks are loaded with the shafts; None for the others.

    Parameters
    ----------
    gearbox : Gearbox
    meshes : sequence of MeshForces
        With the present flanks.
    present : LoadedShafts
        Under them.
    progress : callable, optional
    """
    scales = [state.scale for state in present.states]
    feeding = [n for n, mesh in enumerate(meshes) if isinstance(mesh, FlankForces)]
    amounts: dict[int, tuple[float, float]] = dict.fromkeys(feeding, (0.0, 0.0))
    found, before = present, present
    for turn in range(_ROUNDS):
        before = found
        for k, n in enumerate(feeding):
            mesh = gearbox.meshes[n]
            amounts[n] = _searched(_flanks(meshes[n]), before.gaps_of(mesh.pair), scales, mesh.load, amounts[n])
            progress((turn * (len(feeding) + 1) + k + 1) / (_ROUNDS * (len(feeding) + 1)))
        corrected = [_with(mesh, *amounts[n]) if n in amounts else mesh for n, mesh in enumerate(meshes)]
        found = LoadedShafts(gearbox, load_gearbox(gearbox, corrected, scales), present.feeding)
    made: list[LeadCorrection | None] = []
    for n, mesh in enumerate(gearbox.meshes):
        if n not in amounts:
            made.append(None)
            continue
        own, loads = _flanks(meshes[n]), np.array(scales) * mesh.load
        factors = [
            face_load_factors(_with(own, *one) if any(one) else own, shafts.gaps_of(mesh.pair), loads, mesh.load)
            for one, shafts in (((0.0, 0.0), present), (amounts[n], before), (amounts[n], found))
        ]
        made.append(LeadCorrection(*amounts[n], loads, factors[0], factors[2], np.abs(factors[2] - factors[1])))
    progress(1.0)
    return tuple(made)


def face_load_factors(mesh: FlankForces, shafts: ShaftGaps, loads: Array, nominal: float) -> Array:
    """K_Hbeta of a mesh in the gaps of its shafts, as it is stated of the whole base pitch, shape (L,)."""
    gaps = replace(mesh.gaps, shafts=shafts)
    found = mesh.flanks.solve(loads, gaps, mesh.known)
    return np.asarray(over_pitch(mesh.flanks, found, gaps, nominal, peaks=False).stated.face_load_factor)


def _flanks(mesh: MeshForces) -> FlankForces:
    assert isinstance(mesh, FlankForces)  # noqa: S101  (for mypy: all meshes of 3D gears are)
    return mesh


def _with(mesh: MeshForces, slope: float, crowning: float) -> FlankForces:
    """The same with a correction on the driver."""
    own = _flanks(mesh)
    return replace(own, gaps=_ground(own, slope, crowning))


def _ground(mesh: FlankForces, slope: float, crowning: float) -> FlankGaps:
    more = lead_modifications(slope, crowning, mesh.flanks.pair.driver.face_width)
    return replace(mesh.gaps, driver_flank=(*mesh.gaps.driver_flank, *more))


def _tilt(mesh: FlankForces, shafts: ShaftGaps, load: float) -> float:
    """Helix slope over the driver's face that takes away the linear part of the gap of the shafts [m]."""
    at, width = shafts.under(load), mesh.flanks.pair.driver.face_width
    return -float(np.polyfit(at.height, at.gap[-1, 0], 1)[0]) * width if at.given else 0.0


def _searched(
    mesh: FlankForces, shafts: ShaftGaps, scales: Sequence[float], nominal: float, start: tuple[float, float]
) -> tuple[float, float]:
    """Slope and crowning of the least mean K_Hbeta over the loads, each weighted by itself, in whole graduations."""
    loads = np.array(scales) * nominal
    size = max(abs(_tilt(mesh, shafts, float(loads[-1]))), 2.0 * GRADUATION)

    def uneven(amounts: Array) -> float:
        slope, crowning = (float(one) * size for one in amounts)
        gaps = replace(_ground(mesh, slope, max(crowning, 0.0)), shafts=shafts)
        factors = mesh.flanks.solve(loads, gaps, mesh.known).face_load_factor
        return float(factors @ loads / loads.sum()) + 10.0 * max(-crowning, 0.0) / size

    first = np.array([start[0] / size if any(start) else 1.0, start[1] / size if any(start) else 0.2])
    corners = first + 0.4 * np.array([[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]])
    best = minimize(
        uneven, first, method="Nelder-Mead",
        options={"initial_simplex": corners, "maxfev": _EVALUATIONS, "xatol": _AMOUNT / size, "fatol": _FACTOR},
    ).x  # fmt: skip
    slope, crowning = (GRADUATION * round(float(one) * size / GRADUATION) for one in (best[0], max(best[1], 0.0)))
    return (slope, crowning) if uneven(np.array([slope, crowning]) / size) < uneven(np.zeros(2)) else (0.0, 0.0)
