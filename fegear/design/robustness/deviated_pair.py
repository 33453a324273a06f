"""A loaded pair with deviations of manufacture and housing: the tooth shapes stay, contact is found anew."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from fegear.base.arrays import Array
from fegear.base.errors import FegearError
from fegear.contact.fourier import Panels, panels
from fegear.contact.plane.compliance import RootStressInfluence
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.roll_grids import RollGrid
from fegear.contact.plane.root_stress import Felt, RootStress
from fegear.contact.plane.tooth_table import light, root_table
from fegear.contact.plane.transmission_error import transmission_error
from fegear.design.robustness.tolerance_draws import Deviations, ProfileDeviation
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.geometry.relief import CombinedRelief, Relief

#: Harmonics of the transmission error that are kept.
HARMONICS = 4


#: What is kept of a draw, in the order of its numbers.
OUTCOMES = (
    "te_peak_to_peak", "te_mean", *(f"te_harmonic_{n}" for n in range(1, HARMONICS + 1)), "driver_root_tension",
    "driven_root_tension", "hertz_pressure", "largest_load",
)  # fmt: skip


#: Points over one base pitch: two waves to a subdivision, crowded at the ends of each piece.
_WAVES, _ORDER = 12, 12


#: Points laid between two that differ in the pairs that touch.
_BETWEEN = 6


class DrawBench(Protocol):
    """A pair of any kind set up for deviations, see `Bench` and `FlankBenches`."""

    @property
    def load(self) -> float:
        """Along the line of action [N]."""

    @property
    def teeth(self) -> int:
        """Teeth on either side of one whose spacing counts."""

    @property
    def names(self) -> tuple[str, ...]:
        """Of the numbers that are kept of a draw."""

    @property
    def exact(self) -> float:
        """Peak-to-peak transmission error without deviations, with points at its jumps [m]; NaN where unknown."""

    def of_draw(self, deviations: Deviations, row: int) -> Array:
        """Numbers of one draw, in the order of their names."""


@dataclass(frozen=True)
class Bench:
    """A pair set up for deviations: small enough to be sent to other processes.

    Parameters
    ----------
    engagement : Engagement
        With the reliefs and the effects of its case, without spacing errors.
    load : float
        Along the line of action [N].
    roots : tuple of (RootStress, RootStress)
        Of driver and driven, by tables.
    """

    engagement: Engagement
    load: float
    roots: tuple[RootStress, RootStress]

    @property
    def teeth(self) -> int:
        """Teeth on either side of one that meet while it is in contact."""
        numbers = self.engagement.meshing.pair_numbers
        return int(numbers.max() - numbers.min())

    @property
    def names(self) -> tuple[str, ...]:
        """Of the numbers that are kept of a draw."""
        return OUTCOMES

    @property
    def exact(self) -> float:
        """Peak-to-peak transmission error of the pair without deviations, with points at its jumps [m]."""
        return transmission_error(self.engagement, self.load, 12).peak_to_peak

    def of_draw(self, deviations: Deviations, row: int) -> Array:
        """Numbers of one draw."""
        return outcomes(self, deviated(self, deviations, row))


class State(NamedTuple):
    """A deviated pair under load at some roll positions.

    Attributes
    ----------
    grid : RollGrid
    cycles : ndarray, shape (C,)
        Base pitches during which teeth 0 are in contact: pair j carries them in base pitch j.
    loads : ndarray, shape (n, P, C)
        [N].
    transmission_error : ndarray, shape (P, C)
        [m].
    """

    grid: RollGrid
    cycles: NDArray[np.int64]
    loads: Array
    transmission_error: Array


def bench(engagement: Engagement, load: float, sources: tuple[RootStressInfluence, RootStressInfluence]) -> Bench:
    """Set a pair up: tables of its compliances and root stress.

    Parameters
    ----------
    engagement : Engagement
        Its spacing errors are left out.
    load : float
        [N].
    sources : (RootStressInfluence, RootStressInfluence)
        Of the root stress of driver and driven.
    """
    pair, none = engagement.pair, np.empty(0)
    engagement.compliance.refuse_unequal("draws of deviations")
    compliance = replace(
        engagement.compliance, driver=light(engagement.compliance.driver), driven=light(engagement.compliance.driven)
    )
    roots = []
    for member, source in zip(MEMBERS, sources, strict=True):
        gear = pair.gear(member)
        table = root_table(source, gear, *gear.involute_radii, coupled=compliance.coupling)
        roots.append(RootStress.of(compliance, member, source=table))
    lean = replace(engagement, compliance=compliance, driver_spacing=none, driven_spacing=none)
    return Bench(lean, load, (roots[0], roots[1]))


def deviated(bench: Bench, deviations: Deviations, row: int) -> Engagement:
    """The engagement of one draw.

    Raises
    ------
    InputError
        If the teeth jam at its centre distance, or lose contact.
    """
    e = bench.engagement
    pair, moved = e.pair, float(deviations.centre_distance[row])
    if moved:
        pair = GearPair(pair.driver, pair.driven, pair.centre_distance + moved, pair.axial_offset)
    reliefs: list[Relief] = []
    for i, (member, own) in enumerate(zip(MEMBERS, (e.driver_relief, e.driven_relief), strict=True)):
        # The profile is evaluated over what is active at the drawing's centre distance.
        low, high = sorted(float(e.pair.roll_angle(x, member)) for x in (e.pair.x_start, e.pair.x_end))
        off = ProfileDeviation(
            low, high, float(deviations.profile_slope[row, i]), float(deviations.profile_form[row, i]),
            float(deviations.waves[row, i]), float(deviations.phase[row, i]),
        )  # fmt: skip
        reliefs.append(CombinedRelief((own, off)))
    driver, driven = (deviations.spacing(row, i, pair.gear(member).teeth) for i, member in enumerate(MEMBERS))
    return replace(
        e, compliance=replace(e.compliance, pair=pair), driver_relief=reliefs[0], driven_relief=reliefs[1],
        driver_spacing=driver, driven_spacing=driven,
    )  # fmt: skip


def quadrature(engagement: Engagement, kinks_of: Engagement) -> Panels:
    """Points over the base pitch in which teeth 0 come into contact.

    Parameters
    ----------
    engagement : Engagement
    kinks_of : Engagement
        Whose reliefs' kinks are break points.
    """
    pair = engagement.pair
    own: tuple[tuple[tuple[float, ...], Member], ...] = (
        (kinks_of.driver_relief.kinks, "driver"), (kinks_of.driven_relief.kinks, "driven")
    )  # fmt: skip
    kinks = [float(pair.x_of_roll(roll, member)) for found, member in own for roll in found]
    places = [pair.x_start, pair.x_end, *(x for x in kinks if pair.x_start <= x <= pair.x_end)]
    breaks = sorted({float(x) for x in engagement.meshing.reduced(places)})
    return panels(pair.x_start, pair.base_pitch, breaks, waves=_WAVES, order=_ORDER)


def loaded(engagement: Engagement, load: float, x: Array) -> State:
    """Share the load at roll positions x [m] in every base pitch that teeth 0 pass."""
    grid = engagement.grid(x)
    c = grid.contacts
    separation = np.stack([engagement.separation(c, int(cycle)) for cycle in c.number], axis=2)
    shared = grid.matrices.share(separation, np.full(c.number.size, load))
    return State(grid, c.number, shared.loads, shared.transmission_error)


def outcomes(bench: Bench, engagement: Engagement) -> Array:
    """What comes of a deviated pair, in the order of `OUTCOMES`.

    Extremes sit where pairs come into and out of contact: between two points that differ in the loaded pairs more are
    laid.

    Parameters
    ----------
    bench : Bench
    engagement : Engagement
        From `deviated`.
    """
    points = quadrature(engagement, bench.engagement)
    state = loaded(engagement, bench.load, points.x)
    te = np.ascontiguousarray(state.transmission_error[:, state.cycles == 0][:, 0])
    share = points.weights / points.period
    waves = np.exp(-2j * np.pi / points.period * np.multiply.outer(np.arange(1, HARMONICS + 1), points.x))
    amplitudes = 2.0 * np.abs((waves * (share * te)).sum(axis=1))
    touching = state.loads > 0.0
    changes = np.flatnonzero((touching[:, 1:] != touching[:, :-1]).any(axis=(0, 2)))
    found = [_extremes(bench, engagement, state)]
    if changes.size:
        low, high = points.x[changes], points.x[changes + 1]
        between = low[:, None] + (high - low)[:, None] * (np.arange(1, _BETWEEN + 1) / (_BETWEEN + 1))
        found.append(_extremes(bench, engagement, loaded(engagement, bench.load, between.ravel())))
    most = np.max(found, axis=0)
    return np.array([most[0] + most[1], (share * te).sum(), *amplitudes, *most[2:]])


def _extremes(bench: Bench, engagement: Engagement, state: State) -> Array:
    """Largest and minus the smallest transmission error, root tensions, pressure and load of teeth 0."""
    c = state.grid.contacts
    te = state.transmission_error[:, state.cycles == 0]
    rows = np.arange(state.cycles.size)
    own = state.loads[rows, :, rows]  # of teeth 0 in each of the base pitches that they pass, (n, P)
    pressure = engagement.compliance.pressure(own, c.relative_radius)
    line_load = state.loads / engagement.compliance.face_width
    roots = [
        _root_tension(of_gear, radius, line_load)
        for of_gear, radius in zip(bench.roots, (c.radius_driver, c.radius_driven), strict=True)
    ]
    return np.array([te.max(), -te.min(), *roots, pressure.max(), own.max()])


def _root_tension(roots: RootStress, radius: Array, line_load: Array) -> float:
    """Largest root tension of tooth 0 over its way through the mesh, its neighbours' loads included [Pa]."""
    unloaded = np.zeros((1, roots.known_row(0, 0, radius[0, :1]).shape[1]))
    along, touching = [unloaded], [np.array([np.inf])]
    for row in range(radius.shape[0]):
        loads = line_load[:, :, row]
        felt = []
        for other in np.flatnonzero((loads > 0.0).any(axis=1)).tolist():
            k = roots.tooth(row - other)
            if abs(k) <= roots.reach:
                felt.append(Felt(loads[other], roots.known_row(k, 0, radius[other])))
        if felt:
            along.append(roots.superposed(felt, felt[0].row.shape))
            touching.append(np.where(loads[row] > 0.0, radius[row], np.inf))
    return float(roots.largest(0, np.concatenate(along), np.concatenate(touching)).max())


class Drawn(NamedTuple):
    """What came of some draws: numbers of shape (D, outcomes), NaN where there are none, and why by row."""

    values: Array
    reasons: dict[int, str]


def drawn_outcomes(bench: DrawBench, deviations: Deviations) -> Drawn:
    """Outcomes of every draw, each computed alone, so that its bits are the same in any company."""
    values, reasons = np.full((len(deviations), len(bench.names)), np.nan), {}
    for row in range(len(deviations)):
        try:
            values[row] = bench.of_draw(deviations, row)
        except FegearError as error:
            reasons[row] = str(error)
    return Drawn(values, reasons)
