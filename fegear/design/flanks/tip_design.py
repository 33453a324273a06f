"""Tip reliefs of teeth with a width that a shop can grind, for one load or a range, and what each leaves."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass, replace

import numpy as np

from fegear.base.arrays import Array, Mask, ReadOnlyArrays
from fegear.contact.fourier import Panels
from fegear.contact.wide.compliance import FlankCompliance
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.loaded import FlankPair
from fegear.design.flanks.families import FamilyBest
from fegear.design.flanks.flank_tolerance import (
    FlankTolerance,
    decisive_tolerances,
    powers_with_slopes,
    unrelieved_within,
    within_tolerances,
)
from fegear.design.flanks.tip_bench import Read, TipReader, tip_reader, tip_trials, without_tips
from fegear.design.flanks.tip_search import best_tips
from fegear.design.load_range import LoadRange, proportions
from fegear.design.preferred import classes_finer, preferred
from fegear.design.tip_relief.tip_tolerance import Decisive
from fegear.fem.solid.flank_body import FlankBody
from fegear.geometry.pair import GearPair, Member
from fegear.geometry.relief import Shape

#: Exponents of the shapes.
POWERS: Mapping[Shape, float] = {"linear": 1.0, "parabolic": 2.0}


@dataclass(frozen=True)
class TipDesignTask:
    """What tip reliefs are designed for.

    Parameters
    ----------
    load : float
        Design load [N].
    over : LoadRange or None
        Loads that they are designed for together in place of this one.
    grind : tuple of str
        Shapes.
    tolerance : FlankTolerance
    map_loads : tuple of float
        Under which what is left is wanted besides [N].
    """

    load: float
    over: LoadRange | None
    grind: tuple[Shape, ...]
    tolerance: FlankTolerance
    map_loads: tuple[float, ...]

    @property
    def one_load(self) -> LoadRange:
        """The design load only."""
        return LoadRange((self.load,))

    @property
    def loads(self) -> tuple[float, ...]:
        """All loads under which what is left is read, ascending [N]."""
        return tuple(sorted({self.load, *(self.over.loads if self.over else ()), *self.map_loads}))

    @property
    def counts(self) -> Mask:
        """Which of them the reliefs are designed for, shape (L,)."""
        return np.isin(np.array(self.loads), (self.over or self.one_load).loads)

    @property
    def proportions(self) -> Array:
        """By what these count."""
        over = self.over or self.one_load
        weights = None if over.weights is None else np.array(over.weights)
        return np.asarray(proportions(np.array(over.loads), weights), dtype=float)


@dataclass(frozen=True)
class TipDesign(ReadOnlyArrays):
    """Tip reliefs of teeth with a width.

    Parameters
    ----------
    task : TipDesignTask
    points : Panels
        Roll positions of what is left.
    found : mapping of shape to FamilyBest
        To grind: for the range of the task, or for the design load.
    for_one_load : mapping of shape to FamilyBest
        For the design load only; empty without a range.
    left : mapping of str to Read
        Under `TipDesignTask.loads`: "no relief", each shape ("linear tip relief"), with a range also each for one load
        ("linear tip relief for one load"), and "present relief" where the pair has one.
    most : mapping of shape to ndarray, shape (L,)
        Largest peak-to-peak value within the tolerances [m].
    finer : int or None
        By how many classes these would have to be finer for the shape to be ground to leave no more than no relief
        with profile slopes inside the same tolerances under any load that it is designed for: 0 where they do, None
        where none does.
    decisive : tuple of Decisive or None
        Which tolerance decides `most` of the shape to be ground under each load.
    unrelieved_most : ndarray, shape (L,), or None
        Largest peak-to-peak value without relief, with profile slopes inside the tolerances [m]; None where the shape
        to be ground leaves no more than no relief without deviations.
    """

    task: TipDesignTask
    points: Panels
    found: Mapping[Shape, FamilyBest]
    for_one_load: Mapping[Shape, FamilyBest]
    left: Mapping[str, Read]
    most: Mapping[Shape, Array]
    finer: int | None = 0
    decisive: tuple[Decisive | None, ...] = ()
    unrelieved_most: Array | None = None

    @property
    def shapes(self) -> list[Shape]:
        """The one to be ground first: by what they leave, also within their tolerances."""
        part, counts = self.task.proportions, self.task.counts

        def worst(left: Array) -> float:
            return float((left[counts] * part).max())

        drawn = {shape: worst(self.left[f"{shape} tip relief"].peak_to_peak) for shape in self.found}
        return preferred(drawn, {shape: worst(most) for shape, most in self.most.items()})


def design_tips(
    flanks: FlankPair,
    coarse: Mapping[Member, FlankBody],
    known: FlankCompliance,
    gaps: FlankGaps,
    task: TipDesignTask,
    *,
    present: bool = False,
    progress: Callable[[float], None] | None = None,
) -> TipDesign:
    """Design the tip reliefs of a pair of teeth with a width.

    Parameters
    ----------
    flanks : FlankPair
    coarse : mapping of {"driver", "driven"} to FlankBody
        The gears' coarser solutions, for errors.
    known : FlankCompliance
        Of the roll positions of the pair's other results.
    gaps : FlankGaps
        What keeps the flanks apart; its profile reliefs are replaced, all else stays.
    task : TipDesignTask
    present : bool
        Whether what the pair has now is of interest, too.
    progress : callable, optional
    """
    report = progress or (lambda _fraction: None)
    pair, apart, loads = flanks.pair, without_tips(gaps), np.array(task.loads)
    trials = tip_trials(flanks, known, apart, task.load)
    report(0.2)
    reader = tip_reader(flanks, coarse, apart, task.load).under(loads, apart)
    report(0.5)
    left: dict[str, Read] = {"no relief": reader.read()}
    if present:
        none = np.empty(0)
        left["present relief"] = reader.read(apart=replace(gaps, driver_spacing=none, driven_spacing=none))
    found: dict[Shape, FamilyBest] = {}
    single: dict[Shape, FamilyBest] = {}
    most: dict[Shape, Array] = {}
    off: dict[Shape, TipReader] = {}
    for number, shape in enumerate(task.grind):
        power = POWERS[shape]
        of_shape = reader.shaped(power)
        found[shape] = best_tips(trials.over(task.over or task.one_load, power, apart))
        numbers = found[shape].relief.numbers
        left[f"{shape} tip relief"] = of_shape.read(numbers)
        off[shape] = reader.shaped(powers_with_slopes(numbers, power))
        most[shape] = _left(off[shape], within_tolerances(off[shape].plain, pair, numbers, task.tolerance))
        if task.over is not None:
            single[shape] = best_tips(trials.over(task.one_load, power, apart))
            left[f"{shape} tip relief for one load"] = of_shape.read(single[shape].relief.numbers)
        report(0.5 + 0.5 * (number + 1) / len(task.grind))
    design = TipDesign(task, reader.points, found, single, left, most)
    shape = design.shapes[0]
    numbers = found[shape].relief.numbers
    design = replace(design, unrelieved_most=_unrelieved_most(reader, pair, design, shape))
    return replace(
        design, finer=_classes_finer(off[shape], pair, design, shape),
        decisive=decisive_tolerances(off[shape].plain, pair, numbers, task.tolerance, most[shape]),
    )  # fmt: skip


def _left(reader: TipReader, numbers: Array) -> Array:
    """What the numbers that are the worst under each load leave under it, shape (L,) [m]."""
    return np.array([np.ptp(reader.dense.of_numbers(one).te[0, :, i]) for i, one in enumerate(numbers)])


def _unrelieved(
    reader: TipReader, pair: GearPair, design: TipDesign, shape: Shape, tolerance: FlankTolerance
) -> Array:  # fmt: skip
    """What no relief leaves at most with profile slopes inside tolerances, shape (L,) [m]."""
    straight, numbers = reader.shaped(POWERS["linear"]), design.found[shape].relief.numbers
    most = _left(straight, unrelieved_within(straight.plain, pair, numbers, tolerance))
    return np.maximum(most, design.left["no relief"].peak_to_peak)


def _unrelieved_most(reader: TipReader, pair: GearPair, design: TipDesign, shape: Shape) -> Array | None:
    """What no relief leaves at most within the same tolerances; None where even without deviations it leaves more."""
    counts = design.task.counts
    if not np.any(design.most[shape][counts] > design.left["no relief"].peak_to_peak[counts]):
        return None
    return _unrelieved(reader, pair, design, shape, design.task.tolerance)


def _classes_finer(reader: TipReader, pair: GearPair, design: TipDesign, shape: Shape) -> int | None:
    """By how many classes tolerances would have to be finer for a shape to pay under every load that counts."""
    task, numbers = design.task, design.found[shape].relief.numbers
    if design.unrelieved_most is None:
        return 0

    def share(classes: int) -> Array:
        """Of what no relief leaves within tolerances that are so many classes finer."""
        tolerance = task.tolerance.finer(classes)
        most = _left(reader, within_tolerances(reader.plain, pair, numbers, tolerance))
        return np.asarray((most / _unrelieved(reader, pair, design, shape, tolerance))[task.counts])

    as_given = (design.most[shape] / design.unrelieved_most)[task.counts]
    return classes_finer(as_given, np.ones(as_given.size), share, task.tolerance.finest)
