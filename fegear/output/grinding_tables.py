"""The relief of a gear for who grinds it: a fine table over the profile, and the points of its profile chart."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.case.built.flank_modifications import described_relief
from fegear.case.built.members import gear_name
from fegear.engine.table import Column, Table
from fegear.geometry.pair import MEMBERS
from fegear.geometry.path_of_contact import active_profile
from fegear.geometry.relief import Relief, chart_points, roll_in_drawing, roll_of_radius
from fegear.output.file_names import file_name
from fegear.output.tables import write_table

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.case.reading import Scene
    from fegear.geometry.gear import Gear
    from fegear.output.export_formats import Request, Written

#: Places of the fine table, and how far the relief may lie from the lines between points of the chart [m].
_PLACES, _WITHIN = 101, 1e-7


def written_relief(request: Request) -> Written:
    """Write the relief of a gear as two CSV files, its profile from the start to the end of the involute.

    ``<gear>_relief.csv`` at even roll angles and kinks, ``<gear>_k_chart.csv`` with the chart's points.
    """
    scene, name = request.scene, request.name
    found = described_relief(scene, name).relief
    if found is None:
        given = scene.case.gear[name].relief is not None
        return (), () if given else (f"Gear {name}, RELIEF: no relief specified, no table written.",)
    return [write_table(request.folder, table) for table in relief_tables_of(scene, name, found)], ()


def relief_tables_of(scene: Scene, name: str, relief: Relief) -> tuple[Table, Table]:
    """The fine table and that of the profile chart."""
    gear = scene.gears[name]
    low, high = (float(roll_of_radius(gear, r)) for r in (gear.form_radius, gear.involute_tip_radius))
    named = {low: "start of involute", high: "end of involute"}
    for pair_name, pair in scene.pairs.items():
        for member in MEMBERS:
            if gear_name(scene, pair_name, member) == name:
                alone = active_profile(pair, member)
                for end, radius in (("start", alone.start), ("end", alone.end)):
                    roll = float(roll_of_radius(gear, radius))
                    if low + 1e-9 < roll < high - 1e-9:
                        named.setdefault(roll, f"{end} of active profile, pair {pair_name}")
    chart = chart_points(relief, low, high, _WITHIN, tuple(named))
    words = [next((word for at, word in named.items() if abs(at - roll) < 1e-12), "") for roll in chart]
    kinks = [kink for kink in relief.kinks if low < kink < high]
    fine = np.unique(np.concatenate([np.linspace(low, high, _PLACES), kinks]))
    stem = file_name(name)
    point = Column(
        "point", np.array(words), "", "end of the involute or of an active profile; empty: kink of the relief"
    )
    return (
        Table(f"{stem}_relief", _columns(gear, fine, relief), f"Relief of gear {name}"),
        Table(f"{stem}_k_chart", (point, *_columns(gear, chart, relief)), f"Profile chart of gear {name}"),
    )


def _columns(gear: Gear, roll: Array, relief: Relief) -> tuple[Column, ...]:
    base, drawn = gear.base_radius, roll_in_drawing(gear, roll)
    return (
        Column("diameter", 2.0 * base * np.hypot(1.0, roll), "mm", "diameter of the flank point"),
        Column("roll_angle", drawn, "deg", "roll angle of the gear"),
        Column("roll_length", base * drawn, "mm", "roll length from the base circle, along the line of action"),
        Column("removal", relief.removal(roll), "um", "amount of modification, normal to the involute"),
    )
