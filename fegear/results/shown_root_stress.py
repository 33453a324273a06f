"""Tables, values and figure of root stress on a tooth's way through the mesh, in the plane and over the face."""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.figure import Axis, Curve, Figure, Mark, Panel
from fegear.engine.outcome import Column, Table, Value
from fegear.results.drawn_pair import path_marks
from fegear.results.root_stress_parts import ending, told

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.contact.tooth_stress import ToothStress
    from fegear.geometry import GearPair
    from fegear.geometry.pair import Member


def stress_table(
    name: str,
    gear: str,
    found: Mapping[str, ToothStress],
    i: int,
    rate: float | None,
    loads: tuple[float, ...],
    more: tuple[Column, ...] = (),
) -> Table:
    """One tooth of a gear by every source, at load `i` and the others; `rate` [m/s] makes a time of its way."""
    sources = tuple(found)
    first = found[sources[0]]
    columns = [Column("x", first.x, "mm", "position of the tooth's contact on the line of action")]
    if rate is not None:
        columns.insert(0, Column("t", (first.x - first.x[0]) / rate, "s", "from the first position"))
    for k, (source, s) in enumerate(found.items()):
        end = ending(sources, k)
        meaning = f"largest tangential tension of the fillet below the loaded flank, by {told(source)}"
        columns.append(Column(f"stress{end}", s.tension[:, i], "MPa", meaning))
        if s.compression is not None:
            columns.append(
                Column(f"compression{end}", s.compression[:, i], "MPa", "most negative stress of the other fillet")
            )
        if not np.isnan(s.tension_error).any():
            columns.append(
                Column(f"stress_error{end}", s.tension_error[:, i], "MPa", f"estimated error of stress{end}")
            )
        for j, load in enumerate(loads):
            if j != i:
                head = f"stress{end} at {load:.6g} N"
                columns.append(Column(head, s.tension[:, j], "MPa", f"as stress{end}, under this load"))
    return Table(f"root_stress_history_{name}", (*columns, *more), f"Root stress of a tooth of gear {gear} in the mesh")


def stress_values(of: str, end: str, by: str, s: ToothStress, i: int) -> list[Value]:
    """Largest stresses by one source, under load `i`."""
    worst = int(np.argmax(s.tension[:, i]))
    error = float(s.tension_error[worst, i])
    values = [
        Value(
            f"{of}.largest_root_tension{end}", float(s.tension[worst, i]), "MPa", None if np.isnan(error) else error,
            f"{by}, contact at x = {s.x[worst] * 1e3:.5g} mm",
        ),
        Value(
            f"{of}.root_stress_range{end}", float(np.ptp(s.tension[:, i])), "MPa", None,
            "largest less smallest stress below the loaded flank over the mesh",
        ),
    ]  # fmt: skip
    if s.compression is not None:
        least = int(np.argmin(s.compression[:, i]))
        place = f"{by}, contact at x = {s.x[least] * 1e3:.5g} mm"
        values.insert(
            1, Value(f"{of}.largest_root_compression{end}", float(s.compression[least, i]), "MPa", None, place)
        )
    return values


def stress_figure(
    name: str,
    pair: GearPair,
    load: float,
    stress: Mapping[Member, Mapping[str, ToothStress]],
    i: int,
    gears: Mapping[Member, str],
) -> Figure:
    """Draw the largest stresses of both gears over the way of a tooth at load `i`, which is `load` [N]."""
    curves, largest = [], []
    several = len(stress["driver"]) > 1
    for g, (member, found) in enumerate(stress.items()):
        for k, (source, s) in enumerate(found.items()):
            label = f"{member} {gears[member]}" + (f", {told(source)}" if several else "")
            tension, error = s.tension[:, i] * 1e-6, s.tension_error[:, i] * 1e-6
            role = f"series:{g + 2 * k}" if k else member
            curves.append(
                Curve(s.x * 1e3, tension, f"{label}, tension", role, None if np.isnan(error).any() else error)
            )
            if s.compression is not None:
                style = f"{member} compression"
                curves.append(Curve(s.x * 1e3, s.compression[:, i] * 1e-6, f"{label}, compression", style, width=1.2))
            largest.append(f"{tension.max():.4g} MPa ({member}{f', {told(source)}' if several else ''})")
    x = Axis("position of the tooth's contact on the line of action", "mm")
    return Figure(
        f"root_stress_history_{name}",
        f"Root stress through the mesh of pair {name}",
        f"Pair {name} at {load:.5g} N: fillet stress of one tooth; by finite elements its own load's and its "
        f"neighbours' added. A to E: points of the path of contact. Largest tension {' and '.join(largest)}.",
        (Panel(x, Axis("largest root stress", "MPa"), tuple(curves), (*path_marks(pair), Mark("y", 0.0))),),
        under=f"{load:.5g} N",
    )
