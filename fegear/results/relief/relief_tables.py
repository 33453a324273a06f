"""Tables and single values of a designed relief."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.outcome import Value
from fegear.engine.table import Column, Table
from fegear.geometry.pair import MEMBERS

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.contact.plane.engagement import Loaded
    from fegear.contact.plane.transmission_error import TransmissionError
    from fegear.design.minimum_excitation import ReliefTable
    from fegear.design.relief_design import ReliefDesign
    from fegear.design.root_stress_loading import StressOptimum
    from fegear.design.tip_relief.grindable import TipReliefPair
    from fegear.geometry.pair import GearPair, Member
    from fegear.geometry.relief import Shape
    from fegear.results.relief.relief import ReliefInputs


def least_stress_table(name: str, best: StressOptimum, load: float) -> tuple[Table, tuple[Value, ...]]:
    """Loadings that were tried for the least stress, and the stresses of the one chosen."""
    exponents, peaks, tensions, pressures = zip(*best.candidates, strict=True)
    labels = ["sinusoidal" if r is None else f"polynomial, r = {r}" for r in exponents]
    at_load = math.sqrt(load)
    table = Table(
        f"loading_candidates_{name}",
        (
            Column("family", np.array(labels), "", "of the ramps"),
            Column("peak", np.array(peaks), "", "F, best of its family"),
            Column("root_tension", np.array(tensions) * load, "MPa", "largest of both gears"),
            Column("hertz_pressure", np.array(pressures) * at_load, "MPa", "largest over the path"),
        ),
        f"Loadings of {name} tried for the least stress",
    )
    about = "largest of both gears, design load"
    return table, (
        Value(f"{name}.design_root_tension", best.stress * load, "MPa", None, about),
        Value(f"{name}.design_hertz_pressure", best.pressure * at_load, "MPa", None, "largest over the path"),
    )


def relief_tables(name: str, design: ReliefDesign, inputs: ReliefInputs) -> list[Table]:
    """Relief over the flank of both gears."""
    tables = []
    for member, label in inputs.labels.items():
        found = design.reliefs[member]
        t = found.table
        columns = [
            Column("x", t.x, "mm", "position on the line of action, positive toward the driver's tip"),
            Column("radius", t.radius, "mm", "radius of the flank point"),
            Column("roll_angle", t.roll_angle, "deg", "roll angle of the flank point"),
            Column("load", t.load, "N", "design load on the pair there"),
            Column("relief", t.relief, "um", "material to remove, along the normal"),
            Column(
                "deflection", t.deflection, "um", "of this flank under the design loads, which the relief makes up for"
            ),
        ]
        if found.diagonal is not None:
            columns.append(Column("relief_diagonal", found.diagonal, "um", "without the neighbours' loads (Mark 5.4)"))
        if found.error is not None:
            columns.append(Column("relief_error", found.error, "um", "estimated error of relief"))
        title = f"Relief of gear {inputs.gears[member]} in pair {name}"
        tables.append(Table(f"relief_{label}", tuple(columns), title))
    return tables


def points_table(name: str, label: str, gear: str, t: ReliefTable) -> Table:
    """Relief at the roll angles that a case asks for, also counted from the least of them."""
    columns = (
        Column("roll_angle", t.roll_angle, "deg", "roll angle of the flank point"),
        Column("radius", t.radius, "mm", "radius of the flank point"),
        Column("x", t.x, "mm", "position on the line of action, positive toward the driver's tip"),
        Column("load", t.load, "N", "design load on the pair there"),
        Column("deflection", t.deflection, "um", "of this flank under the design loads"),
        Column("relief", t.relief, "um", "material to remove, along the normal"),
        Column("relief_over_least", t.relief - t.relief.min(), "um", "less the least of these rows"),
    )
    return Table(f"relief_points_{label}", columns, f"Relief of gear {gear} in pair {name} at the angles asked for")


def grindable_table(
    name: str, ground: Mapping[Shape, TipReliefPair], te: Mapping[str, TransmissionError], p: GearPair
) -> Table:
    """Tip reliefs that come nearest, and what they leave."""
    # What is left comes from the same evaluation as the single values, not from the search's coarser one.
    rows = [(shape, m, te[f"{shape} tip relief"], getattr(g, m)) for shape, g in ground.items() for m in MEMBERS]
    bands = [getattr(g, f"{m}_band") for g in ground.values() for m in MEMBERS]
    errors = np.concatenate(
        [np.vstack([g.error, g.band_error]).reshape(3, 2, 2).swapaxes(0, 1) for g in ground.values()]
    )
    start = np.array([r.start for *_, r in rows])
    runner_up = np.array([ground[shape].runner_up for shape, *_ in rows])
    doubt = np.array([ground[shape].runner_up_error for shape, *_ in rows])
    left_off = np.array([ground[shape].objective_error for shape, *_ in rows])
    base = np.array([p.gear(m).base_radius for _, m, *_ in rows])
    return Table(
        f"grindable_{name}",
        (
            Column("shape", np.array([shape for shape, *_ in rows]), "", "of the tip relief"),
            Column("gear", np.array([m for _, m, *_ in rows]), "", "driver or driven"),
            Column("amount", np.array([r.amount for *_, r in rows]), "um", "removal at the tip"),
            Column("amount_error", errors[:, 0, 0], "um", "estimated error of amount"),
            Column("start_roll_angle", start, "deg", "where the relief starts"),
            Column("start_roll_angle_error", errors[:, 0, 1], "deg", "estimated error of start_roll_angle"),
            Column("start_radius", base * np.hypot(1.0, start), "mm", "the same as a radius"),
            Column("te_peak_to_peak", np.array([t.peak_to_peak for _, _, t, _ in rows]), "um", "left at design load"),
            Column("te_peak_to_peak_error", left_off, "um", "estimated error of te_peak_to_peak and te_effective"),
            Column("te_effective", np.array([t.effective_error for _, _, t, _ in rows]), "um", "A_e left"),
            Column("least", np.array([ground[shape].least for shape, *_ in rows]), "um", "left by the best of all"),
            Column(
                "amount_from", np.array([a.amount for a, _ in bands]), "um", "equally good: up to 1 % above the least"
            ),
            Column("amount_to", np.array([b.amount for _, b in bands]), "um", "equally good"),
            Column("amount_from_error", errors[:, 1, 0], "um", "how much less amount_from may be"),
            Column("amount_to_error", errors[:, 2, 0], "um", "how much more amount_to may be"),
            Column("start_from", np.array([b.start for _, b in bands]), "deg", "equally good, roll angle"),
            Column("start_to", np.array([a.start for a, _ in bands]), "deg", "equally good, roll angle"),
            Column("start_from_error", errors[:, 2, 1], "deg", "how much less start_from may be"),
            Column("start_to_error", errors[:, 1, 1], "deg", "how much more start_to may be"),
            Column("candidates", np.array([ground[shape].candidates for shape, *_ in rows]), "", "reliefs scanned"),
            Column("starts", np.array([ground[shape].starts for shape, *_ in rows]), "", "valleys searched to the end"),
            Column("agreeing", np.array([ground[shape].agreeing for shape, *_ in rows]), "", "of them, within 5 %"),
            Column("runner_up", runner_up, "um", "the least that the other valleys leave"),
            Column("runner_up_error", doubt, "um", "how much less runner_up may be"),
        ),
        f"Tip reliefs of {name} that a shop can grind",
    )


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
    starts = f"{low:.5g} to {high:.5g} deg"
    amounts = f"{first.amount * 1e6:.4g} to {last.amount * 1e6:.4g} um"
    return [
        Value(f"{key}amount", relief.amount, "um", float(own[0]), f"to grind; equally good with the rest: {amounts}"),
        Value(f"{key}start", relief.start, "deg", float(own[1]), f"roll angle; equally good: {starts}"),
    ]


def harris_table(name: str, curves: Mapping[str, Loaded]) -> Table:
    """Transmission error over the mesh cycle for a family of loads, with each relief."""
    first = next(iter(curves.values()))
    n, loads = first.x.size, first.load
    columns = [
        Column("total_load", np.repeat(loads, n), "N", "along the line of action"),
        Column("x", np.tile(first.x, loads.size), "mm", "roll position over one base pitch"),
    ]
    for label, curve in curves.items():
        head = "te_" + label.replace(" ", "_")
        columns.append(Column(head, curve.transmission_error.T.ravel(), "um", f"transmission error, {label}"))
    return Table(f"harris_map_{name}", tuple(columns), f"Harris map of {name}")


def relief_values(name: str, design: ReliefDesign) -> list[Value]:
    """What each relief leaves at the design load, and the largest removals."""
    values = []
    for label, t in design.te.items():
        key = label.replace(" ", "_")
        shape = next((one for one in design.ground if label == f"{one} tip relief"), None)
        error = design.left if label == "designed" else None if shape is None else design.ground[shape].objective_error
        values.append(Value(f"{name}.te_peak_to_peak.{key}", t.peak_to_peak, "um", error, f"{label}, design load"))
        values.append(Value(f"{name}.te_effective.{key}", t.effective_error, "um", None, f"A_e, {label}, design load"))
    about = "designed, its relief tables read back linearly, design load"
    values.append(Value(f"{name}.te_peak_to_peak.relief_tables", design.tables_leave, "um", None, about))
    values.append(Value(f"{name}.te_mean.designed", design.te["designed"].mean, "um", None, "design load"))
    for shape, ground in design.ground.items():
        for member in MEMBERS:
            values += tip_values(f"{name}.{member}.{shape}_tip_", ground, member)
    for member, found in design.reliefs.items():
        largest = float(found.table.relief.max())
        values.append(Value(f"{name}.{member}.largest_relief", largest, "um", None, "over the path"))
    return values
