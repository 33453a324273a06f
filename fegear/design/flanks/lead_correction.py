"""Lead correction of the meshes of a gearbox: helix slope and crowning that even out the load over the torque range.

The load over the face follows from shafts and flanks together, so that a corrected mesh bends its shafts otherwise than
an uncorrected one. The correction is searched with the gaps that the shafts open under the present flanks; all meshes
with their corrections are then loaded together once more, and again from there, and what is stated is of that state.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace

import numpy as np

from fegear.base.arrays import Array, ReadOnlyArrays
from fegear.contact.loaded_teeth import silent
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.on_shafts import FlankForces, LoadedShafts, MeshForces, load_gearbox
from fegear.contact.wide.over_pitch import POSITIONS, over_pitch
from fegear.contact.wide.shaft_gaps import ShaftGaps
from fegear.geometry.flank_modification import FlankModification, HelixSlope, LeadCrowning
from fegear.shafts.gearbox import Gearbox

#: Amounts are whole multiples of this [m]: what is ground is not finer.
GRADUATION = 0.5e-6
#: Times that corrections are searched and all meshes loaded with them.
_ROUNDS = 2
#: Most multiples of the shafts' tilt that a single slope is tried with.
_TIMES = 4
#: A crowning is worth naming from this share of the K_Hbeta with the slope alone.
_WORTH = 0.95
#: Graduations around the minimum among which none is better, and around which every longer step looks.
_AROUND, _STEP_AROUND = 2, 1


@dataclass(frozen=True)
class LeadCorrection(ReadOnlyArrays):
    """Lead of the driver of a mesh, in place of its present slope and crowning, and what that does.

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
    kept : ndarray, shape (L,)
        K_Hbeta with this slope and the present crowning.
    """

    slope: float
    crowning: float
    loads: Array
    before: Array
    after: Array
    left: Array
    kept: Array


def lead_modifications(slope: float, crowning: float, width: float) -> tuple[FlankModification, ...]:
    """Both as modifications over a face of this width [m]; nothing where an amount is zero."""
    return (
        *((LeadCrowning(crowning, width),) if crowning else ()),
        *((HelixSlope(slope, width),) if slope else ()),
    )


@dataclass(frozen=True)
class LevelLead:
    """A helix slope on the driver against the tilt of the shafts, and crowning against their sag, under one load.

    Parameters
    ----------
    slope : float
        From zero at end I to this at end II, over the driver's own face [m].
    before, after : float
        K_Hbeta in the gaps of the present flanks.
    crowning : float
        Besides the present one; zero where the slope is nearly as good without [m].
    """

    slope: float
    before: float
    after: float
    crowning: float = 0.0


def level_lead(mesh: FlankForces, shafts: ShaftGaps, load: float) -> LevelLead | None:
    """The helix slope that takes away the tilt of the shafts, or as many times that as still lower K_Hbeta.

    Shafts that bend over the face leave both ends loaded, whatever the slope: crowning against the sag joins the slope
    where that is much better. None where tilt and sag are below what is ground, or nothing is gained.

    Parameters
    ----------
    mesh : FlankForces
        With the present flanks.
    shafts : ShaftGaps
    load : float
        Along the transverse line of action [N].
    """
    tilt, sag = (GRADUATION * round(one / GRADUATION) for one in _tilt_and_sag(mesh, shafts, load))
    present = float(face_load_factors(mesh, shafts, np.array([load]), load)[0])

    def best_of(slope: float, crowning: float) -> LevelLead:
        best = LevelLead(0.0, present, present)
        for times in range(1, _TIMES + 1):
            lead = times * slope, times * crowning
            after = float(
                face_load_factors(replace(mesh, gaps=_ground(mesh, *lead)), shafts, np.array([load]), load)[0]
            )
            if after >= best.after:
                break
            best = LevelLead(lead[0], present, after, lead[1])
        return best

    best = best_of(tilt, 0.0) if tilt else LevelLead(0.0, present, present)
    if sag > 0.0 and (both := best_of(tilt, sag)).after < _WORTH * best.after:
        best = both
    return best if best.after < present else None


def correct_leads(
    gearbox: Gearbox,
    meshes: Sequence[MeshForces],
    present: LoadedShafts,
    leads: Sequence[tuple[float, float]],
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
    leads : sequence of (float, float)
        Helix slope and crowning of the driver of every mesh that its present flanks contain: a correction takes their
        place, and may be less crowning [m].
    progress : callable, optional
    """
    scales = [state.scale for state in present.states]
    feeding = [n for n, mesh in enumerate(meshes) if isinstance(mesh, FlankForces)]
    amounts: dict[int, tuple[float, float]] = {n: leads[n] for n in feeding}
    found, before = present, present
    for turn in range(_ROUNDS):
        before = found
        for k, n in enumerate(feeding):
            mesh = gearbox.meshes[n]
            start = None if turn == 0 else amounts[n]
            amounts[n] = _searched(_flanks(meshes[n]), before.gaps_of(mesh.pair), scales, mesh.load, leads[n], start)
            progress((turn * (len(feeding) + 1) + k + 1) / (_ROUNDS * (len(feeding) + 1)))
        corrected = [_with(mesh, leads[n], amounts[n]) if n in amounts else mesh for n, mesh in enumerate(meshes)]
        found = LoadedShafts(gearbox, load_gearbox(gearbox, corrected, scales), present.feeding)
    made: list[LeadCorrection | None] = []
    for n, mesh in enumerate(gearbox.meshes):
        if n not in amounts:
            made.append(None)
            continue
        own, loads = _flanks(meshes[n]), np.array(scales) * mesh.load
        slope, crowning = amounts[n]
        was, last, now, kept = (
            face_load_factors(_with(own, leads[n], lead), shafts.gaps_of(mesh.pair), loads, mesh.load)
            for lead, shafts in (
                (leads[n], present), (amounts[n], before), (amounts[n], found), ((slope, leads[n][1]), found)
            )
        )  # fmt: skip
        made.append(LeadCorrection(slope, crowning, loads, was, now, np.abs(now - last), kept))
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


def _with(mesh: MeshForces, present: tuple[float, float], lead: tuple[float, float]) -> FlankForces:
    """The same with this slope and crowning of the driver in place of the present ones."""
    own = _flanks(mesh)
    return replace(own, gaps=_ground(own, lead[0] - present[0], lead[1] - present[1]))


def _ground(mesh: FlankForces, slope: float, crowning: float) -> FlankGaps:
    more = lead_modifications(slope, crowning, mesh.flanks.pair.driver.face_width)
    return replace(mesh.gaps, driver_flank=(*mesh.gaps.driver_flank, *more))


def _tilt_and_sag(mesh: FlankForces, shafts: ShaftGaps, load: float) -> tuple[float, float]:
    """Helix slope and crowning over the driver's face that take away tilt and sag of the shafts' gap [m]."""
    at, width = shafts.under(load), mesh.flanks.pair.driver.face_width
    if not at.given:
        return 0.0, 0.0
    height, gap = at.height, at.gap[-1, 0]
    slope = float(np.polyfit(height, gap, 1)[0])
    sag = float(np.polyfit(height, gap, 2)[0]) if len(height) > 2 else 0.0
    return -slope * width, -sag * (0.5 * width) ** 2


def _searched(
    mesh: FlankForces,
    shafts: ShaftGaps,
    scales: Sequence[float],
    nominal: float,
    present: tuple[float, float],
    start: tuple[float, float] | None = None,
) -> tuple[float, float]:
    """Slope and crowning of the minimum mean K_Hbeta over the loads, each weighted by itself, in whole graduations.

    It begins at the slope that the shafts want without crowning, with long steps, or at `start` with the shortest. The
    present lead stays where nothing is better.
    """
    loads = np.array(scales) * nominal
    flanks, known = mesh.flanks, mesh.known
    if flanks.positions < POSITIONS:  # the minimum of what is stated is searched: of the whole base pitch
        flanks = replace(flanks, positions=POSITIONS)
        known = flanks.compliance(nominal)

    def uneven(slope: float, crowning: float) -> float:
        gaps = replace(_ground(mesh, slope - present[0], crowning - present[1]), shafts=shafts)
        return float(flanks.solve(loads, gaps, known).face_load_factor @ loads / loads.sum())

    if start is None:
        tilt, _ = _tilt_and_sag(mesh, shafts, float(loads[-1]))
        first, longest = (round(tilt / GRADUATION), 0), max(1, round(0.25 * abs(tilt) / GRADUATION))
    else:
        first, longest = (round(start[0] / GRADUATION), round(start[1] / GRADUATION)), 1
    found = least_of_grid(lambda k, n: uneven(k * GRADUATION, n * GRADUATION), first, longest)
    slope, crowning = (GRADUATION * one for one in found)
    return (slope, crowning) if uneven(slope, crowning) < uneven(*present) else present


def least_of_grid(value: Callable[[int, int], float], first: tuple[int, int], longest: int) -> tuple[int, int]:
    """Where a function of two whole numbers, the second not negative, has its minimum.

    A pattern search: to the best of the eight neighbours at a step as long as one is better, then with half the step
    (R. Hooke and T. A. Jeeves, J. ACM 8, 1961). At step one all numbers up to `_AROUND` away are neighbours, as
    valleys of a largest value of several have sharp floors, along which neighbours on both sides lie higher.

    Parameters
    ----------
    value : callable
        Every place is asked for once.
    first : (int, int)
    longest : int
        Longest step, at least 1.
    """
    known: dict[tuple[int, int], float] = {}

    def at(place: tuple[int, int]) -> float:
        if place not in known:
            known[place] = value(*place)
        return known[place]

    best, step = first, longest
    while True:
        for around in (_STEP_AROUND, _AROUND) if step == 1 else (_STEP_AROUND,):
            ways = range(-around * step, around * step + 1, step)
            near = min(((best[0] + k, best[1] + n) for k in ways for n in ways if best[1] + n >= 0), key=at)
            if at(near) < at(best):
                best = near
                break
        else:
            if step == 1:
                return best
            step //= 2
