"""Tables and single values of designed flanks."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.shown import declared
from fegear.contact.wide.lines import ContactLines
from fegear.engine.declared import column_of, column_over, error_column, value_of
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.geometry.pair import MEMBERS, GearPair, Member

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.design.flanks.flank_design import FlankDesign
    from fegear.design.flanks.forms import GroundRelief


#: What is stated of every relief; the last three where misalignment scatters.
_JUDGED = (
    "peak_to_peak", "face_load_factor", "pressure", "mean_over_scatter", "most_over_scatter", "factor_over_scatter"
)  # fmt: skip


@dataclass(frozen=True)
class FlankDesignData:
    """A design and its pair."""

    pair: GearPair
    design: FlankDesign
    on_shafts: bool = False


def topography_table(name: str, gear: str, member: Member, share: float, data: FlankDesignData) -> Table:
    """Exact topography of one gear, which a case reads back as its ``topography``."""
    from fegear.design.minimum_excitation import ReliefTable

    design, pair = data.design, data.pair
    x, z = (grid.ravel() for grid in np.meshgrid(design.x, design.z, indexing="ij"))
    own = z + pair.face_height(member)
    task = design.task
    columns = (
        column_of(ReliefTable, "roll_angle", np.asarray(pair.roll_angle(x, member))),
        Column("z", own, "mm", "face position of the gear, from mid-face"),
        Column(
            "removal",
            share * design.removal.ravel(),
            "um",
            "amount of modification, normal to the flank in the transverse section",
        ),
        Column("diameter", 2.0 * np.asarray(pair.radius(x, member)), "mm", "diameter of the flank point"),
        column_of(ReliefTable, "x", x),
        Column("line_load", task.load * task.loading.line_load(x, z), "N/mm", "design line load of the pair"),
    )
    return Table(f"flank_topography_{name}_{gear}", columns, f"Topographic relief of gear {gear} in pair {name}")


def designs_table(name: str, data: FlankDesignData) -> Table:
    """Every way to relieve the flanks, its numbers and what it leaves."""
    from fegear.design.flanks.forms import NUMBERS, GroundRelief

    design = data.design
    states, found = design.states, design.found
    counted = [found.get(s.label) for s in states]
    columns = [Column("relief", np.array([s.label for s in states]), "", "type of modification")]
    for key in _JUDGED:
        numbers = [getattr(s.judged, key) for s in states]
        column = column_of(states[0].judged, key, [one.value for one in numbers])
        columns += [column, error_column(column, [one.error for one in numbers])]
    ground = [s.relief or GroundRelief() for s in states]
    columns += [column_over(ground, key) for key in NUMBERS]
    columns += [
        Column("combinations", np.array([one.candidates if one else 0 for one in counted]), "",
            "number of combinations evaluated"),
        Column("loaded_exactly", np.array([one.exact if one else 0 for one in counted]), "", "computed exactly"),
        Column("best_on_grid", np.array([one.value_on_grid if one else 0.0 for one in counted]), "um",
               "best value on the grid before local optimisation; 0: no search"),
        Column("quick_error", np.array([one.quick_error if one else 0.0 for one in counted]), "um",
               "largest observed overestimate of the approximate method used to screen the combinations"),
        Column("proven", np.array([float(one.proven) if one else 1.0 for one in counted]), "",
               "1: optimum on the grid proven"),
    ]  # fmt: skip
    return Table(
        f"flank_designs_{name}", tuple(columns), f"Flank modifications of pair {name} and remaining transmission error"
    )


def map_table(name: str, design: FlankDesign) -> Table:
    """Transmission error and K_Hbeta over misalignment and load."""
    from fegear.design.charts import ReliefChart

    over_face, loads = np.array(design.task.map_over_face), np.array(design.task.map_loads)
    per, states = over_face.size * loads.size, design.states
    columns = (
        Column("relief", np.repeat(np.array([s.label for s in states]), per), "", "type of modification"),
        Column("over_face", np.tile(np.repeat(over_face, loads.size), len(states)), "um",
               "additional misalignment: gap at +b/2 minus gap at -b/2"),
        column_of(ReliefChart, "loads", np.tile(loads, len(states) * over_face.size), name="load"),
        *(
            column_of(states[0].mapped, key, np.concatenate([getattr(s.mapped, key).ravel() for s in states]))
            for key in ("peak_to_peak", "face_load_factor", "pressure")
        ),
    )  # fmt: skip
    return Table(f"flank_map_{name}", columns, f"Reliefs of pair {name} over misalignment and load")


def roll_table(name: str, design: FlankDesign) -> Table:
    """Transmission error at the design load over the roll positions."""
    columns = [column_of(ContactLines, "roll", design.roll)]
    columns += [
        Column(f"te_{state.label.replace('-', '_').replace(' ', '_')}", state.te, "um", f"with {state.label}")
        for state in design.states
    ]
    return Table(f"flank_design_roll_{name}", tuple(columns), f"Transmission error of pair {name} at the design load")


def values_of(name: str, design: FlankDesign) -> tuple[Value, ...]:
    """Single values: without relief, of the exact topography, and of the best that can be ground."""
    values = [
        Value(f"{name}.topography_depth", float(np.ptp(design.removal)), "um", None,
              "maximum amount of the ideal topography (sum of both gears)"),
    ]  # fmt: skip
    for state in design.states:
        key = state.label.replace("-", "_").replace(" ", "_")
        for attribute in _JUDGED if design.task.deviation else _JUDGED[:3]:
            number = getattr(state.judged, attribute)
            words = f"{declared(type(state.judged), attribute).meaning}: {state.label}"
            owner = f"{name}.{key}"
            values.append(value_of(state.judged, attribute, owner, number.error, si=number.value, meaning=words))
    return tuple(values)


def keys_of(relief: GroundRelief, pair: GearPair, gears: Mapping[Member, str]) -> list[str]:
    """The relief as keys of both gears; lead and bias are those of the first whose face is the common one.

    Where both faces reach beyond the common one, lead and bias are given for the driver all the same, and count over
    the common face.
    """
    lines = []
    tips: tuple[tuple[Member, float, float, float], ...] = (
        ("driver", relief.driver_tip, pair.x_end, pair.x_end - relief.driver_tip_length),
        ("driven", relief.driven_tip, pair.x_start, pair.x_start + relief.driven_tip_length),
    )
    by_gear: dict[str, list[str]] = {gear: [] for gear in gears.values()}
    for member, amount, end, start in tips:
        if amount:
            radii = [float(pair.radius(at, member)) for at in (start, end)]
            by_gear[gears[member]].append(
                f'relief = {{ tip = {{ amount = "{_um(amount)}", start_radius = "{_mm(radii[0])}", '
                f'at_radius = "{_mm(radii[1])}" }} }}'
            )
    lead = [
        f'{key} = "{_um(value)}"' for key, value in (("crowning", relief.crowning), ("slope", relief.slope)) if value
    ]
    if relief.end_relief:
        ends = f'amount = "{_um(relief.end_relief)}", length = "{_mm(relief.end_relief_length)}"'
        lead.append(f"end_relief = {{ {ends} }}")
    bearer: Member = next((m for m in MEMBERS if _is_common(pair, m)), "driver")
    if lead:
        by_gear[gears[bearer]].append(f"lead = {{ {', '.join(lead)} }}")
    if relief.bias:
        # The driven gear's tip is where the driver's root is.
        bias = relief.bias if bearer == "driver" else -relief.bias
        by_gear[gears[bearer]].append(f'bias = "{_um(bias)}"')
    for gear, keys in by_gear.items():
        lines += [f"gear.{gear}.{key}" for key in keys]
    return lines


def _is_common(pair: GearPair, member: Member) -> bool:
    """Whether a gear's face is the common one."""
    slack = 1e-9 * pair.face_width
    return abs(pair.gear(member).face_width - pair.face_width) <= slack and abs(pair.face_height(member)) <= slack


def _um(value: float) -> str:
    return f"{value * 1e6:.5g} um"


def _mm(value: float) -> str:
    return f"{value * 1e3:.7g} mm"
