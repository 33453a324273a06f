"""The whole design of loaded flanks: exact topography, what can be ground, and how each holds up."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import TYPE_CHECKING

import numpy as np

from fegear.contact.flank import flank_compliance
from fegear.design.flank_forms import GroundRelief
from fegear.design.flank_grid import FAMILIES, held_by, usual_grid
from fegear.design.flank_scatter import NOMINAL, Scatter
from fegear.design.flank_search import best_of_family, led_on
from fegear.design.flank_topography import (
    design_force,
    design_lines,
    lines_at,
    station_relief,
    table_nodes,
    tabulated,
    topography,
)
from fegear.design.flank_trials import FlankTrials, Tried
from fegear.frozen import ReadOnlyArrays
from fegear.one_thread import one_thread

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fegear.arrays import Array
    from fegear.contact.flank import FlankCompliance, FlankGaps, FlankPair
    from fegear.contact.flank.lines import ContactLines
    from fegear.design.flank_grid import Family, ReliefGrid
    from fegear.design.flank_loading import FlankLoading
    from fegear.design.flank_search import FamilyBest
    from fegear.design.flank_topography import StationRelief
    from fegear.geometry.flank_modification import Topography

UNRELIEVED, EXACT, ROBUST = "no relief", "exact topography", "robust"


@dataclass(frozen=True)
class FlankDesignTask:
    """What flanks are designed for.

    Parameters
    ----------
    loading : FlankLoading
    load : float
        W_d [N].
    loads : tuple of float
        Over which what can be ground is chosen: the worst of them, in proportion to its load [N].
    families : tuple of str
    grid : ReliefGrid or None
        None for `usual_grid`.
    most_factor : float
        Largest K_Hbeta that ground reliefs may have at those loads.
    scatter : Scatter
        Of the misalignment, over which the robust relief is chosen.
    positions : int
        Roll positions over a base pitch.
    map_over_face, map_loads : tuple of float
        Misalignments [m] and loads [N] of the maps.
    """

    loading: FlankLoading
    load: float
    loads: tuple[float, ...]
    families: tuple[Family, ...]
    grid: ReliefGrid | None
    most_factor: float
    scatter: Scatter
    positions: int
    map_over_face: tuple[float, ...]
    map_loads: tuple[float, ...]


@dataclass(frozen=True)
class FlankState(ReadOnlyArrays):
    """One way to relieve the flanks and what it leaves at the design load.

    Parameters
    ----------
    label : str
    relief : GroundRelief or None
        None for the exact topography.
    te : ndarray, shape (P,)
        Transmission error at the roll positions of the pair's other results, which the topography has not seen [m].
    peak_to_peak, peak_to_peak_error : float
        The larger of that over these positions and over those of the design, and by how much they differ [m].
    face_load_factor, pressure : float
        K_Hbeta, and the largest Hertzian pressure away from tips and form circles [Pa].
    scattered : Tried
        Over the misalignments of the scatter, at the design load.
    mapped : Tried
        Over the misalignments and loads of the maps.
    """

    label: str
    relief: GroundRelief | None
    te: Array
    peak_to_peak: float
    peak_to_peak_error: float
    face_load_factor: float
    pressure: float
    scattered: Tried
    mapped: Tried


@dataclass(frozen=True)
class FlankDesign(ReadOnlyArrays):
    """A design of loaded flanks.

    Parameters
    ----------
    task : FlankDesignTask
    station : StationRelief
    x, z : ndarray, shapes (n,), (m,)
        Nodes of the topography in the plane of action [m].
    removal : ndarray, shape (n, m)
        By both gears together [m].
    roll : ndarray, shape (P,)
        Positions of `FlankState.te` [m].
    states : tuple of FlankState
        Without relief, exact topography, the best of every family, and the robust one if misalignment scatters.
    found : mapping of str to FamilyBest
        By the labels of what can be ground.
    grid : ReliefGrid
    """

    task: FlankDesignTask
    station: StationRelief
    x: Array
    z: Array
    removal: Array
    roll: Array
    states: tuple[FlankState, ...]
    found: Mapping[str, FamilyBest]
    grid: ReliefGrid

    @property
    def unrelieved(self) -> FlankState:
        """Without relief."""
        return self.states[0]

    @property
    def exact(self) -> FlankState:
        """With the exact topography."""
        return self.states[1]

    @property
    def robust(self) -> tuple[FlankState, ...]:
        """What can be ground and leaves the least over the scatter; empty where misalignment does not scatter."""
        return tuple(state for state in self.states if state.label == ROBUST)

    @property
    def best(self) -> FlankState:
        """What can be ground and leaves the least at the design load, aligned as given."""
        return min((s for s in self.states if s.label in self.found and s.label != ROBUST),
                   key=lambda s: self.found[s.label].value)  # fmt: skip


def design_flanks(
    flanks: FlankPair,
    known: FlankCompliance,
    apart: FlankGaps,
    task: FlankDesignTask,
    progress: Callable[[float], None] | None = None,
) -> FlankDesign:
    """Design the flanks of a pair.

    Parameters
    ----------
    flanks : FlankPair
    known : FlankCompliance
        Of the roll positions at which reliefs to grind are tried and the exact topography is checked.
    apart : FlankGaps
        What keeps the flanks apart besides the relief: misalignment that is known.
    task : FlankDesignTask
    progress : callable, optional

    Raises
    ------
    RangeError
        If no relief of a family keeps to the largest K_Hbeta.
    """
    report = progress or (lambda _fraction: None)
    pair = flanks.pair
    lines = design_lines(pair, task.loading, task.positions, flanks.panel * pair.driver.module)

    def compliance_at(lines: ContactLines) -> FlankCompliance:
        with one_thread():
            return flank_compliance(
                pair, flanks.gears, lines, task.load, coupling=flanks.coupling, hertz=flanks.hertz, cache=flanks.cache
            )

    own = compliance_at(lines)
    report(0.3)
    gap = apart.at(pair, lines)
    station = station_relief(own, gap, task.loading, task.load)
    x, z = table_nodes(station, pair)
    removal = tabulated(station, pair, x, z)
    table = topography(pair, "driver", x, z, removal)
    grid = task.grid or usual_grid(float(np.ptp(removal)), pair.path_length, pair.face_width, pair.base_pitch)
    # What is ground leaves most where contact lines begin and end, where the positions of the other results stand, and
    # may leave as much between few of them: it is chosen by both.
    scan = FlankTrials(pair, known, apart.at(pair, known.lines), np.array(task.loads))
    force = design_force(known.lines, task.loading, task.load)
    roll = np.mod(np.concatenate([known.lines.roll, lines.roll]) - pair.x_start, pair.base_pitch) + pair.x_start
    dense = lines_at(pair, np.unique(roll), flanks.panel * pair.driver.module)
    trials = FlankTrials(pair, compliance_at(dense), apart.at(pair, dense), scan.loads)
    found: dict[str, FamilyBest] = {}
    wanted = [family for family in FAMILIES if family in task.families]
    for number, family in enumerate(wanted):
        starts = [found[held].relief for held in held_by(family) if held in found]
        found[family] = best_of_family(trials, family, grid, force, task.most_factor, starts, scan)
        report(0.3 + 0.4 * (number + 1) / len(wanted))
    if wanted and task.scatter.over_face.size > 1:
        scattered = replace(trials, scatter=task.scatter)
        starts = [one.relief for one in found.values() if one.family in (*held_by(wanted[-1]), wanted[-1])]
        found[ROBUST] = best_of_family(
            scattered, wanted[-1], grid, force, task.most_factor, starts, replace(scan, scatter=task.scatter)
        )
        # One start more: where scattered misalignment leads may be the better valley without it, too.
        found[wanted[-1]] = led_on(trials, found[wanted[-1]], grid, found[ROBUST].relief, task.most_factor)
    report(0.9)
    trials = replace(scan, loads=np.array([task.load]))
    designed = FlankTrials(pair, own, gap, trials.loads)
    reliefs: dict[str, GroundRelief | Topography] = {
        UNRELIEVED: GroundRelief(),
        EXACT: table,
        **{label: one.relief for label, one in found.items()},
    }
    states = tuple(_state(label, relief, trials, designed, task)
                   for label, relief in reliefs.items())  # fmt: skip
    return FlankDesign(task, station, x, z, removal, known.lines.roll, states, found, grid)


def _state(
    label: str, relief: GroundRelief | Topography, trials: FlankTrials, designed: FlankTrials, task: FlankDesignTask
) -> FlankState:
    """Evaluate a relief on both sets of roll positions, over the scatter and over the maps."""

    def gap(lines: ContactLines) -> Array:
        if isinstance(relief, GroundRelief):
            removed = relief.removal(trials.pair, lines.x, lines.z)
        else:
            height = lines.z + trials.pair.face_height("driver")
            removed = relief.removal(trials.pair.roll_angle(lines.x, "driver"), height)
        return np.where(lines.present, removed, 0.0)

    here = gap(trials.known.lines)
    found, other = trials.of_gap(here), designed.of_gap(gap(designed.known.lines))
    ripple = [float(one.peak_to_peak[0, 0]) for one in (found, other)]
    count = len(task.map_over_face)
    over = Scatter(np.array(task.map_over_face), np.full(count, 1.0 / count))
    return FlankState(
        label, relief if isinstance(relief, GroundRelief) else None, found.te[0, :, 0], max(ripple),
        abs(ripple[0] - ripple[1]), float(found.face_load_factor[0, 0]), float(found.pressure[0, 0]),
        replace(trials, scatter=task.scatter).of_gap(here) if task.scatter is not NOMINAL else found,
        replace(trials, scatter=over, loads=np.array(task.map_loads)).of_gap(here),
    )  # fmt: skip
