"""The whole design of loaded flanks: exact topography, what can be ground, and how each holds up."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import replace
from itertools import product
from typing import NamedTuple

import numpy as np

from fegear.base.arrays import Array
from fegear.base.one_thread import one_thread
from fegear.contact.wide.compliance import FlankCompliance, flank_compliance
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.lines import ContactLines
from fegear.contact.wide.loaded import FlankPair
from fegear.design.flanks.designed_flanks import (
    EXACT,
    ROBUST,
    UNRELIEVED,
    FlankDesign,
    FlankDesignTask,
    FlankState,
)
from fegear.design.flanks.families import FamilyBest, best_of_family, led_on
from fegear.design.flanks.flank_tolerance import (
    decisive_tolerances,
    unrelieved_within,
    within_tolerances,
)
from fegear.design.flanks.forms import GroundRelief
from fegear.design.flanks.grid import FAMILIES, held_by, usual_grid
from fegear.design.flanks.judge import FlankJudge, flank_judge, mean_over_scatter
from fegear.design.flanks.scatter import Scatter
from fegear.design.flanks.topography import (
    design_force,
    design_lines,
    station_relief,
    table_nodes,
    tabulated,
    topography,
)
from fegear.design.flanks.trials import FlankTrials
from fegear.design.preferred import classes_finer
from fegear.design.tip_relief.tip_tolerance import Decisive
from fegear.fem.solid.flank_body import FlankBody
from fegear.geometry.flank_modification import Topography
from fegear.geometry.pair import GearPair, Member


def design_flanks(
    flanks: FlankPair,
    coarse: Mapping[Member, FlankBody],
    known: FlankCompliance,
    apart: FlankGaps,
    task: FlankDesignTask,
    progress: Callable[[float], None] | None = None,
) -> FlankDesign:
    """Design the flanks of a pair.

    Parameters
    ----------
    flanks : FlankPair
    coarse : mapping of {"driver", "driven"} to FlankBody
        The gears' coarser solutions, for errors.
    known : FlankCompliance
        Of the roll positions of the pair's other results, at which all combinations of a grid are tried.
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
    pair, aligned = flanks.pair, apart.under(task.load)
    panel = flanks.panel * pair.driver.module
    lines = design_lines(pair, task.loading, task.positions, panel)

    def compliance_at(lines: ContactLines) -> FlankCompliance:
        with one_thread():
            return flank_compliance(
                pair, flanks.gears, lines, task.load, coupling=flanks.coupling, hertz=flanks.hertz, cache=flanks.cache
            )

    own = compliance_at(lines)
    report(0.3)
    gap = aligned.at(pair, lines)
    station = station_relief(own, gap, task.loading, task.load)
    x, z = table_nodes(station, pair)
    removal = tabulated(station, pair, x, z)
    table = topography(pair, "driver", x, z, removal)
    grid = task.grid or usual_grid(float(np.ptp(removal)), pair.path_length, pair.face_width, pair.base_pitch)
    judge = flank_judge(flanks, coarse, aligned, task.load, task.deviation)
    plain = judge.plain.known
    # What is ground leaves most where contact lines begin and end, and may leave as much between few roll positions:
    # grids and leaps are tried at few, reliefs are chosen by those that the judge has on both sides of these places.
    loads = np.array(task.loads)
    few = FlankTrials(pair, known, apart.at(pair, known.lines, loads), loads, weights=task.weights)
    force = design_force(known.lines, task.loading, task.load)
    more = FlankTrials(pair, plain, apart.at(pair, plain.lines, loads), loads, weights=task.weights)
    found: dict[str, FamilyBest] = {}
    wanted = [family for family in FAMILIES if family in task.families]
    for number, family in enumerate(wanted):
        starts = _starts([found[held] for held in held_by(family) if held in found])

        def ahead(part: float, first: float = number / len(wanted), share: float = 1.0 / len(wanted)) -> None:
            report(0.3 + 0.4 * (first + share * part))

        found[family] = best_of_family(more, family, grid, force, task.most_factor, starts, few, ahead)
        grid = found[family].grid  # what a family needs, those that hold it need, too
        ahead(1.0)
    if wanted and task.scatter.over_face.size > 1:
        starts = [one.relief for one in found.values() if one.family in (*held_by(wanted[-1]), wanted[-1])]
        scattered, scan = (replace(one, scatter=task.scatter) for one in (more, few))
        found[ROBUST] = best_of_family(scattered, wanted[-1], grid, force, task.most_factor, starts, scan)
        grid = found[ROBUST].grid
        # One start more: where scattered misalignment leads may be the better valley without it, too.
        found[wanted[-1]] = led_on(more, found[wanted[-1]], grid, found[ROBUST].relief, task.most_factor)
    report(0.8)
    reliefs: dict[str, GroundRelief | Topography] = {
        UNRELIEVED: GroundRelief(),
        EXACT: table,
        **{label: one.relief for label, one in found.items()},
    }
    here = replace(few, loads=np.array([task.load]), apart=aligned.at(pair, known.lines), weights=None)
    over = _OverLoads(judge.under(loads, apart), replace(more, weights=None))
    judged: list[FlankState] = []
    for label, relief in reliefs.items():
        judged.append(_state(label, relief, here, judge, over, task))
        report(0.8 + 0.2 * len(judged) / len(reliefs))
    states = tuple(judged)
    design = FlankDesign(task, station, x, z, removal, known.lines.roll, states, found, grid)
    design = replace(design, unrelieved_most=_unrelieved_most(over, pair, design))
    return replace(design, finer=_classes_finer(over, pair, design), decisive=_decisive(over, pair, design))


def _starts(held: Sequence[FamilyBest]) -> list[GroundRelief]:
    """Where a family's search begins besides its grid: valleys of those that it holds, and their sums."""
    found = [valley for one in held for valley in one.valleys]
    tips, leads = ([one for one in held if one.family == family] for family in ("profile", "lead"))
    sums = [
        GroundRelief.of(profile.numbers + lead.numbers, profile.tip_power)
        for first in tips for second in leads for profile, lead in product(first.valleys, second.valleys)
    ]  # fmt: skip
    return [*found, *sums]


class _OverLoads(NamedTuple):
    """The pair under the task's loads: as what is left is judged, and as it is searched."""

    judge: FlankJudge
    searched: FlankTrials


def _state(
    label: str, relief: GroundRelief | Topography, here: FlankTrials, judge: FlankJudge, over_loads: _OverLoads,
    task: FlankDesignTask,
) -> FlankState:  # fmt: skip
    """Judge a relief, and map what it leaves."""

    def gap(lines: ContactLines) -> Array:
        if isinstance(relief, GroundRelief):
            removed = relief.removal_on(here.pair, lines)
        else:
            height = lines.z + here.pair.face_height("driver")
            removed = relief.removal(lines.roll_angle(here.pair, "driver"), height)
        return np.where(lines.present, removed, 0.0)

    count = len(task.map_over_face)
    over = Scatter(np.array(task.map_over_face), np.full(count, 1.0 / count))
    mapped = replace(judge.plain, scatter=over, loads=np.array(task.map_loads))
    te, error = over_loads.judge.left(gap)
    left = np.ptp(te, axis=0)
    mean = left
    if task.scatter.over_face.size > 1:
        dense = over_loads.judge.dense
        mean = mean_over_scatter(dense, gap(dense.known.lines), task.deviation)
    most: Array | None = None
    if task.tolerance is not None and isinstance(relief, GroundRelief) and label != UNRELIEVED:
        dense = over_loads.judge.dense
        off = within_tolerances(over_loads.searched, here.pair, relief.numbers, task.tolerance)
        most = np.array([np.ptp(dense.of_numbers(one).te[0, :, i]) for i, one in enumerate(off)])
        most = np.maximum(most, left)
    lines = over_loads.judge.dense.known.lines
    phase = 2j * np.pi * lines.roll / here.pair.base_pitch
    first = 2.0 * np.abs(lines.mean(np.exp(-phase)[:, None] * (te - lines.mean(te))))
    return FlankState(
        label, relief if isinstance(relief, GroundRelief) else None, here.of_gap(gap(here.known.lines)).te[0, :, 0],
        judge.judge(gap), mapped.of_gap(gap(mapped.known.lines)), left, first, mean, error, most,
    )  # fmt: skip


def _left_densely(over: _OverLoads, numbers: Array) -> Array:
    """Peak-to-peak value of nine numbers of its own under each load, shape (L,) [m]."""
    return np.array([np.ptp(over.judge.dense.of_numbers(one).te[0, :, i]) for i, one in enumerate(numbers)])


def _unrelieved_most(over: _OverLoads, pair: GearPair, design: FlankDesign) -> Array | None:
    """What no relief leaves at most within the same tolerances; None where even without deviations it leaves more."""
    tolerance, none = design.task.tolerance, design.unrelieved.over_peak_to_peak
    if tolerance is None or not design.found:
        return None
    relief, most = design.best.relief, design.best.over_most
    if relief is None or most is None or not np.any(most > none):
        return None
    return np.maximum(_left_densely(over, unrelieved_within(over.searched, pair, relief.numbers, tolerance)), none)


def _classes_finer(over: _OverLoads, pair: GearPair, design: FlankDesign) -> int | None:
    """By how many classes tolerances would have to be finer for what is to be ground to pay under every load."""
    tolerance, compared = design.task.tolerance, design.unrelieved_most
    if tolerance is None or not design.found or compared is None:
        return 0
    relief, most = design.best.relief, design.best.over_most
    if relief is None or most is None:
        return 0

    def share(classes: int) -> Array:
        """Of what no relief leaves within tolerances that are so many classes finer."""
        allowed = tolerance.finer(classes)
        left, none = (
            _left_densely(over, of(over.searched, pair, relief.numbers, allowed))
            for of in (within_tolerances, unrelieved_within)
        )
        return np.asarray(left / np.maximum(none, design.unrelieved.over_peak_to_peak))

    return classes_finer(most / compared, np.ones(most.size), share, tolerance.finest)


def _decisive(over: _OverLoads, pair: GearPair, design: FlankDesign) -> tuple[Decisive | None, ...]:
    """Which tolerance decides the most that is left of what is to be ground; empty where nothing has any."""
    tolerance = design.task.tolerance
    if tolerance is None or not design.found:
        return ()
    relief, most = design.best.relief, design.best.over_most
    if relief is None or most is None:
        return ()
    return decisive_tolerances(over.searched, pair, relief.numbers, tolerance, most)
