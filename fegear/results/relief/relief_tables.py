"""Tables and single values of a designed relief.

Harris maps: transmission error over the mesh cycle for a family of loads, of a design and beside a load slider.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.case.design import DesignPart
from fegear.case.effects import EffectsPart
from fegear.contact.loaded_teeth import POSITIONS, LoadedTeeth
from fegear.contact.pair_spec import PairSpec
from fegear.engine.declared import column_of, column_over, columns_of, error_column, value_of
from fegear.engine.figure.axis import Axis
from fegear.engine.figure.figure import Figure
from fegear.engine.figure.items import Curve, Item, Points
from fegear.engine.figure.panel import Panel
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.geometry.pair import MEMBERS, GearPair, Member
from fegear.results.pair.loaded_teeth import BASE_PITCH, drawn_loads, pitch_marks

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence

    from fegear.base.arrays import Array
    from fegear.contact.plane.engagement import Loaded
    from fegear.contact.plane.transmission_error import TransmissionError
    from fegear.design.minimum_excitation import ReliefTable
    from fegear.design.relief_design import ReliefDesign
    from fegear.design.root_stress_loading import StressOptimum
    from fegear.design.tip_relief.grindable import TipReliefPair
    from fegear.geometry.relief import Shape


@dataclass(frozen=True)
class ReliefInputs:
    """What the design of a pair's relief depends on.

    Parameters
    ----------
    part : DesignPart
    asked : PairSpec
    tolerance : float
        That neglected effects are compared with.
    effects : EffectsPart
        All of the case, for the remedies.
    neglected : bool
        Whether the sizes of effects that are off are estimated.
    labels, gears : mapping of str to str
        Names of the tables and of the gears by member.
    """

    part: DesignPart
    asked: PairSpec
    tolerance: float
    effects: EffectsPart = field(compare=False)
    neglected: bool
    labels: Mapping[Member, str] = field(compare=False)
    gears: Mapping[Member, str] = field(compare=False)


def least_stress_table(name: str, best: StressOptimum, load: float) -> tuple[Table, tuple[Value, ...]]:
    """Loadings that were tried for the least stress, and the stresses of the one chosen."""
    exponents, peaks, tensions, pressures = zip(*best.candidates, strict=True)
    labels = ["sinusoidal" if r is None else f"polynomial, r = {r}" for r in exponents]
    at_load = math.sqrt(load)
    table = Table(
        f"loading_candidates_{name}",
        (
            Column("family", np.array(labels), "", "family of the ramps"),
            Column("peak", np.array(peaks), "", "F, best of its family"),
            Column("root_tension", np.array(tensions) * load, "MPa", "maximum of both gears"),
            Column("hertz_pressure", np.array(pressures) * at_load, "MPa", "maximum over the path of contact"),
        ),
        f"Loadings of {name} evaluated for minimum stress",
    )
    about = "maximum of both gears, design load"
    return table, (
        Value(f"{name}.design_root_tension", best.stress * load, "MPa", None, about),
        Value(
            f"{name}.design_hertz_pressure", best.pressure * at_load, "MPa", None, "maximum over the path of contact"
        ),
    )


def relief_tables(name: str, design: ReliefDesign, inputs: ReliefInputs) -> list[Table]:
    """Relief over the flank of both gears."""
    tables = []
    for member, label in inputs.labels.items():
        found = design.reliefs[member]
        t = found.table
        columns = [*columns_of(t, table="flank")]
        if found.diagonal is not None:
            meaning = "without tooth coupling (Mark 5.4)"
            columns.append(column_of(t, "relief", found.diagonal, name="relief_diagonal", meaning=meaning))
        if found.error is not None:
            columns.append(error_column(column_of(t, "relief"), found.error))
        title = f"Relief of gear {inputs.gears[member]} in pair {name}"
        tables.append(Table(f"relief_{label}", tuple(columns), title))
    return tables


def points_table(name: str, label: str, gear: str, t: ReliefTable) -> Table:
    """Relief at the roll angles that a case asks for, also counted from the least of them."""
    above = t.relief - t.relief.min()
    columns = (
        *columns_of(t, "roll_angle", "radius", "x", "load", "deflection", "relief"),
        column_of(t, "relief", above, name="relief_over_least", meaning="minus the minimum of these rows"),
    )
    return Table(f"relief_points_{label}", columns, f"Relief of gear {gear} in pair {name} at the requested angles")


def grindable_table(
    name: str, ground: Mapping[Shape, TipReliefPair], te: Mapping[str, TransmissionError], p: GearPair
) -> Table:
    """Tip reliefs that come nearest, and what they leave."""
    # What is left comes from the same evaluation as the single values, not from the search's coarser one.
    rows = [(shape, m, g) for shape, g in ground.items() for m in MEMBERS]
    reliefs = [getattr(g, m) for _, m, g in rows]
    first, last = zip(*(getattr(g, f"{m}_band") for _, m, g in rows), strict=True)
    left = [te[f"{shape} tip relief"] for shape, *_ in rows]
    start, base = np.array([r.start for r in reliefs]), np.array([p.gear(m).base_radius for _, m, _ in rows])
    errors = np.concatenate(
        [np.vstack([g.error, g.band_error]).reshape(3, 2, 2).swapaxes(0, 1) for g in ground.values()]
    )
    amount, begin, ripple = (
        column_over(reliefs, "amount"), column_over(reliefs, "start"),
        column_over(left, "peak_to_peak", meaning="remaining at design load"),
    )  # fmt: skip
    ends = [
        column_over(one, key, name=name, meaning=meaning)
        for one, key, name, meaning in (
            (first, "amount", "amount_from", "lower end of near-optimum range (within 1 % of the minimum)"),
            (last, "amount", "amount_to", "equally good"),
            (last, "start", "start_from", "equally good, roll angle"),
            (first, "start", "start_to", "equally good, roll angle"),
        )
    ]
    ends_off = [
        error_column(end, errors[:, which, what], f"how much {how} {end.name} may be")
        for end, which, what, how in zip(ends, (1, 2, 2, 1), (0, 0, 1, 1), ("less", "more") * 2, strict=True)
    ]

    radius = Column("start_radius", base * np.hypot(1.0, start), "mm", "as radius")
    radius_off = error_column(radius, base * start / np.hypot(1.0, start) * errors[:, 0, 1])

    def of(key: str, unit: str, meaning: str) -> Column:
        return Column(key, np.array([getattr(g, key) for *_, g in rows]), unit, meaning)

    return Table(
        f"grindable_{name}",
        (
            Column("shape", np.array([shape for shape, *_ in rows]), "", "of the tip relief"),
            Column("gear", np.array([m for _, m, _ in rows]), "", "driver or driven"),
            amount, error_column(amount, errors[:, 0, 0]), begin, error_column(begin, errors[:, 0, 1]),
            radius, radius_off, ripple,
            error_column(
                ripple, [g.objective_error for *_, g in rows], "estimated error of te_peak_to_peak and te_effective"
            ),
            column_over(left, "effective_error", meaning="remaining A_e"),
            of("least", "um", "minimum found"),
            of("least_error", "um", "difference between two independent searches"),
            *ends[:2], *ends_off[:2], *ends[2:], *ends_off[2:],
            of("candidates", "", "number of reliefs scanned"),
            of("starts", "", "number of start points of the search"),
        ),
        f"Grindable tip reliefs of {name}",
    )  # fmt: skip


def tip_values(key: str, ground: TipReliefPair, member: Member) -> list[Value]:
    """Amount and start of a tip relief to grind; what is equally good is named with each.

    Parameters
    ----------
    key : str
        Start of the values' names.
    ground : TipReliefPair
    member : Member
    """
    relief, (first, last) = getattr(ground, member), getattr(ground, f"{member}_band")
    low, high = (math.degrees(one.start) for one in (last, first))
    own = ground.error[:2] if member == "driver" else ground.error[2:]
    amounts = f"amount to grind; equally good: {first.amount * 1e6:.4g} to {last.amount * 1e6:.4g} um"
    starts = f"roll angle; equally good: {low:.5g} to {high:.5g} deg"
    owner, _, head = key.rpartition(".")
    return [
        value_of(relief, "amount", owner, float(own[0]), name=f"{head}amount", meaning=amounts),
        value_of(relief, "start", owner, float(own[1]), name=f"{head}start", meaning=starts),
    ]


_BY_RELIEF = "repeatability of the search"


def harris_table(name: str, curves: Mapping[str, Loaded], ground: Mapping[Shape, TipReliefPair]) -> Table:
    """Transmission error over the mesh cycle for a family of loads, with each relief; a searched one has an error."""
    from fegear.design.charts import ReliefChart

    first = next(iter(curves.values()))
    n, loads = first.x.size, first.load
    columns = [
        column_of(ReliefChart, "loads", np.repeat(loads, n)),
        Column("x", np.tile(first.x, loads.size), "mm", "mesh position over one base pitch"),
    ]
    for label, curve in curves.items():
        head = "te_" + label.replace(" ", "_")
        columns.append(Column(head, curve.transmission_error.T.ravel(), "um", f"transmission error, {label}"))
        found = next((one for shape, one in ground.items() if label == f"{shape} tip relief"), None)
        if found is not None:
            columns.append(error_column(columns[-1], np.full(n * loads.size, found.removal_error), _BY_RELIEF))
    return Table(f"harris_map_{name}", tuple(columns), f"Harris map of {name}")


def relief_values(name: str, design: ReliefDesign) -> list[Value]:
    """What each relief leaves at the design load, and the largest removals."""
    values = []
    for label, t in design.te.items():
        key = label.replace(" ", "_")
        shape = next((one for one in design.ground if label == f"{one} tip relief"), None)
        error = design.left if label == "designed" else None if shape is None else design.ground[shape].objective_error
        values += [
            value_of(t, "peak_to_peak", name, error, name=f"te_peak_to_peak.{key}", meaning=f"{label}, design load"),
            value_of(
                t, "effective_error", name, error, name=f"te_effective.{key}", meaning=f"A_e, {label}, design load"
            ),
        ]
    te = design.te["designed"]
    values += [
        value_of(
            te, "peak_to_peak", name, si=design.tables_leave, name="te_peak_to_peak.relief_tables",
            meaning="designed, relief tables interpolated linearly, design load",
        ),
        value_of(te, "mean", name, name="te_mean.designed", meaning="design load"),
    ]  # fmt: skip
    for shape, ground in design.ground.items():
        for member in MEMBERS:
            values += tip_values(f"{name}.{member}.{shape}_tip_", ground, member)
    for member, found in design.reliefs.items():
        largest = found.table.relief.max()
        values.append(value_of(
            found.table, "relief", f"{name}.{member}", si=largest, name="largest_relief", meaning="over the path"
        ))  # fmt: skip
    return values


#: Loads of a family up to the greatest, and roll positions of the curve that follows a slider.
_FAMILY, _QUICK = 10, 60
#: Name of the curve and the point that are for the present load.
NOW = "present load"


class HarrisCurves(NamedTuple):
    """Transmission error of a pair over a base pitch, for several loads.

    Attributes
    ----------
    x : ndarray, shape (P,)
        Roll positions [m].
    load : ndarray, shape (L,)
        [N].
    transmission_error : ndarray, shape (P, L)
        [m].
    """

    x: Array
    load: Array
    transmission_error: Array


def harris_panel(
    curve: Loaded | HarrisCurves, pair: GearPair, load: float, word: str, more: Sequence[Item] = ()
) -> Panel:
    """Transmission error over one base pitch, a curve for each load; the one that is `load` is wide.

    Parameters
    ----------
    curve : Loaded or HarrisCurves
    pair : GearPair
    load : float
        [N]; nan where none of them stands out.
    word : str
        What that load is called.
    more : sequence of items
        Further curves over the same axes.
    """
    loads = [float(w) for w in curve.load]
    items = tuple(
        Curve(
            curve.x * 1e3, curve.transmission_error[:, i] * 1e6, text, role,
            width=3.0 if loads[i] == load else 1.4, markers=False if more else None,
        )
        for i, text, role in drawn_loads(loads, load, word)
    )  # fmt: skip
    axis = Axis("transmission error", "um", zero=True)
    return Panel(BASE_PITCH, axis, (*items, *more), pitch_marks(pair, curve.x))


def _round_step(about: float) -> float:
    """The next step of 1, 2, 2.5 or 5 times a power of ten that is no longer than this."""
    power = 10.0 ** math.floor(math.log10(about))
    return max(one for one in (1.0, 2.0, 2.5, 5.0) if one <= about / power * (1.0 + 1e-9)) * power


def _now(teeth: LoadedTeeth, positions: int) -> HarrisCurves:
    """The pair under its nominal load."""
    return HarrisCurves(*teeth.error_under([teeth.nominal], positions))


def load_now(teeth: LoadedTeeth) -> tuple[float, Array, Array]:
    """The transmission error at the nominal load, at a few roll positions, while a slider moves: N, mm and um."""
    now = _now(teeth, _QUICK)
    return float(now.load[0]), now.x * 1e3, now.transmission_error[:, 0] * 1e6


def slider_map(name: str, teeth: LoadedTeeth, greatest: float) -> Figure:
    """The Harris map beside a load slider: the family up to the greatest load, and the present load in it.

    Parameters
    ----------
    name : str
        Of the pair.
    teeth : LoadedTeeth
        Its reliefs, errors and effects are those of the case.
    greatest : float
        Load to which the slider goes [N].
    """
    step = _round_step(greatest / _FAMILY)
    loads = step * np.arange(1.0, math.floor(greatest / step * (1.0 + 1e-9)) + 1.0)
    curve, present = HarrisCurves(*teeth.error_under(loads, POSITIONS)), _now(teeth, POSITIONS)
    x, now, error = present.x, present.load, present.transmission_error * 1e6
    wide = Curve(x * 1e3, error[:, 0], NOW, "ink", dash="solid", width=3.2, markers=False)
    over_roll = harris_panel(curve, teeth.pair, math.nan, "", (wide,))
    over_load = Panel(
        Axis("load along the line of action", "N", zero=True),
        Axis("peak to peak", "um", zero=True),
        (
            Curve(loads, np.ptp(curve.transmission_error, axis=0) * 1e6, "", "designed", markers=True),
            Points(now, np.ptp(error, axis=0), NOW, "ink", symbol="circle", size=11.0),
        ),
        height=0.7,
    )
    return Figure(
        f"slider_map_{name}",
        f"Harris map of pair {name}",
        f"Pair {name}: transmission error over the mesh cycle for loads up to {greatest:.5g} N with the reliefs of "
        "the case, and peak-to-peak values; thick line and large point: present load.",
        (over_roll, over_load),
    )
