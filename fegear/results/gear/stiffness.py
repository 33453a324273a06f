"""Result ``stiffness``: the table of one gear by finite elements on the whole ring.

Figures of a gear's compliance and root stress over the position of the load.
"""

from __future__ import annotations

from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, first_of_largest
from fegear.case.built.tooth_influence import solution_settings
from fegear.engine.citation import citing
from fegear.engine.declared import axis_of, column_of, columns_of, drawn, error_column, value_of
from fegear.engine.figure.axis import Axis, Scale
from fegear.engine.figure.figure import DeferredFigure, Figure
from fegear.engine.figure.items import Curve, Mark
from fegear.engine.figure.panel import Panel
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.results.forecasts import HERTZ, PATCH, RING
from fegear.results.gear.drawing import tooth_figure
from fegear.results.gear.load_positions import StiffnessInputs, check_contacts_of, chosen_gears, stiffness_inputs
from fegear.results.gear.solved_gear import needs_solution

if TYPE_CHECKING:
    from fegear.case.reading import Scene
    from fegear.fem.plane.table import StiffnessTable
    from fegear.fem.solid.table import SolidTable
    from fegear.geometry.gear import Gear


#: Reading off one position of a solved gear [s].
_SECONDS_PER_POSITION = 3e-4


#: The error estimates of a table [s].
_SECONDS_OF_TABLE = 0.05


_SIDES = ("root_tension", "root_compression")


def compliance_errors(t: StiffnessTable | SolidTable) -> tuple[Column, Column]:
    """Estimated errors of the loaded tooth's compliance, and of its neighbours', of a plane or a solid gear."""
    own, next_one = (np.ravel(t.errors[key]) for key in ("c_self", "c_neighbour"))
    meaning = "estimated error of c_prev and c_next"
    return (
        error_column(column_of(t, "c_self"), own),
        column_of(t, "c_next", next_one, name="c_neighbour_error", meaning=meaning),
    )


def _table(name: str, t: StiffnessTable) -> Table:
    columns = (
        *columns_of(t, table="flank"), *compliance_errors(t),
        *(error_column(column_of(t, key), t.errors[key]) for key in _SIDES),
        *columns_of(t, "root_tension_angle", "root_compression_angle", "c_self_reduction"),
    )  # fmt: skip
    return Table(f"stiffness_{name}", columns, f"Compliance and root stress of gear {name}")


def _values(name: str, gear: Gear, t: StiffnessTable) -> tuple[Value, ...]:
    found = []
    low, high = gear.involute_radii
    if low <= gear.pitch_radius <= high:
        known, at = t.influence, np.array([gear.pitch_radius])
        b = np.interp(gear.pitch_radius, t.radius[np.argsort(t.radius)], t.half_width[np.argsort(t.radius)])
        for key, (c, off), meaning in (
            ("c_self", known.contact(at, b)[:2], "self compliance"),
            ("c_prev", known.neighbour_with_error(-1, at, at), "tooth before"),
            ("c_next", known.neighbour_with_error(1, at, at), "tooth after"),
        ):
            words = f"{meaning}, load on the pitch circle"
            found.append(value_of(t, key, name, off.item(), si=c.item(), name=f"{key}_at_pitch", meaning=words))
    for key, largest in zip(_SIDES, map(first_of_largest, (t.root_tension, -t.root_compression)), strict=True):
        words = f"per line load, load at radius {t.radius[largest] * 1e3:.6g} mm"
        error, value = float(t.errors[key][largest]), getattr(t, key)[largest]
        found.append(value_of(t, key, name, error, si=value, name=f"largest_{key}", meaning=words))
    return tuple(found)


def tolerance_remarks(who: str, label: str, relative: Array, radius: Array, tolerance: float, of: str) -> list[str]:
    """Where the estimated relative errors of a quantity over the radius [m] miss the tolerance, if anywhere."""
    i = int(first_of_largest(relative))
    said = (
        f"{who}: the estimated error of {label} reaches {relative[i]:.1e} (tolerance {tolerance:.0e}), at radius "
        f"{radius[i] * 1e3:.6g} mm; at {np.mean(relative <= tolerance):.0%} of the {of} it is within the tolerance."
    )
    return [said] if relative[i] > tolerance else []


def _remarks(asked: StiffnessInputs, t: StiffnessTable) -> tuple[str, ...]:
    remarks: list[str] = []
    # The neighbour's deflection is small compared with the loaded tooth's, to which it is added: that is its scale.
    for label, value, error in (
        ("c_self", t.c_self, t.errors["c_self"]),
        ("c_next over c_self", t.c_self, t.errors["c_neighbour"]),
        ("root tension", t.root_tension, t.errors["root_tension"]),
        ("root compression", t.root_compression, t.errors["root_compression"]),
    ):
        relative = np.abs(error) / np.maximum(np.abs(value), 0.1 * np.abs(value).max())
        remarks += tolerance_remarks(f"Gear {asked.name}", label, relative, t.radius, asked.tolerance, "positions")
    return (*remarks, *asked.assumed)


def _compute(asked: StiffnessInputs, upstream: Upstream, _work: Work) -> StiffnessTable:
    from fegear.fem.plane.table import stiffness_table

    (influence,) = upstream.values()
    return stiffness_table(asked.gear, asked.radii, asked.half_widths, influence=influence)


def _present(table: StiffnessTable, asked: StiffnessInputs) -> Outcome:
    name = asked.name
    return Outcome(
        table,
        (_table(name, table),),
        _values(name, asked.gear, table),
        solution_settings(table.influence),
        _remarks(asked, table),
        (
            DeferredFigure(
                f"tooth_{name}",
                f"Tooth, tool and mesh of gear {name}",
                partial(tooth_figure, name, asked.gear, table.influence.fine.mesh),
            ),
            *stiffness_figures(name, table),
        ),
    )


def _forecast(scene: Scene, _name: str) -> Forecast:
    positions = len(scene.case.stiffness.radii or ()) or scene.case.stiffness.load_positions
    return Forecast({"positions": positions}, _SECONDS_OF_TABLE + _SECONDS_PER_POSITION * positions)


def _roll_axis(gear: Gear, t: StiffnessTable, roll: Array) -> Axis:
    """Roll angle of the load, with the radius that belongs to it on the far side."""
    room = 0.05 * float(np.ptp(roll))
    first, last = float(roll.min()) - room, float(roll.max()) + room
    at = np.linspace(max(first, 0.0) if first + last > 0.0 else first, last, 200)
    radius = gear.base_radius * 1e3 * np.hypot(1.0, np.deg2rad(at))
    return axis_of(t, "roll_angle", second=Scale("load radius", "mm", at, radius))


def _pitch_mark(gear: Gear, roll: Array) -> tuple[Mark, ...]:
    at = gear.tooth.side * float(np.rad2deg(np.sqrt(max((gear.pitch_radius / gear.base_radius) ** 2 - 1.0, 0.0))))
    return (Mark("x", at, "pitch point"),) if roll.min() <= at <= roll.max() else ()


def stiffness_figures(name: str, t: StiffnessTable) -> tuple[Figure, ...]:
    """Compliances and root stresses of a gear over the roll angle of the load."""
    gear, order = t.influence.gear, np.argsort(t.roll_angle)
    roll = drawn(t, "roll_angle")[order]
    x, marks = _roll_axis(gear, t, roll), _pitch_mark(gear, roll)

    def curve(key: str, error: str, label: str, role: str, sign: float = 1.0) -> Curve:
        return Curve(roll, sign * drawn(t, key)[order], label, role, drawn(t, key, t.errors[error])[order])

    compliance = axis_of(t, "c_self")
    width = f"{t.half_width.min() * 1e3:.4g}"
    if t.half_width.max() > 1.0001 * t.half_width.min():
        width += f" to {t.half_width.max() * 1e3:.4g}"
    i = int(first_of_largest(t.root_tension))
    worst = float(np.max(np.abs(t.errors["c_self"] / t.c_self)))
    return (
        Figure(
            f"compliance_{name}",
            f"Compliance of gear {name}",
            f"Gear {name}: deflection per line load of the loaded tooth and of its neighbours at the same radius, "
            f"whole ring, contact half-width {width} mm. Bands: estimated error, for c_0 at most {worst:.1e} of it.",
            (
                Panel(x, compliance, (curve("c_self", "c_self", "c_{0}, loaded tooth", "loaded tooth"),), marks),
                Panel(replace(x, second=None), compliance, (
                    curve("c_next", "c_neighbour", "c_{+1}, next tooth", "next tooth"),
                    curve("c_prev", "c_neighbour", "c_{−1}, previous tooth", "previous tooth"),
                ), marks),
            ),
        ),
        Figure(
            f"root_stress_{name}",
            f"Root stress of gear {name}",
            f"Gear {name}: largest tangential fillet stress per line load. At its largest the tension sits at radius "
            f"{t.root_tension_radius[i] * 1e3:.5g} mm, where the fillet's tangent makes "
            f"{np.rad2deg(t.root_tension_angle[i]):.1f} deg with the tooth's centre line (ISO 6336-3 looks at 30 deg).",
            (
                Panel(x, axis_of(t, "root_tension", zero=True), (
                    curve("root_tension", "root_tension", "tension, fillet below the loaded flank", "tension"),
                    curve("root_compression", "root_compression", "compression, other fillet (magnitude)",
                          "compression", sign=-1.0),
                ), marks),
            ),
        ),
    )  # fmt: skip


STIFFNESS = Stage(
    subjects=lambda scene: chosen_gears(scene) if scene.case.stiffness.face_positions is None else (),
    needs=lambda _scene, name: needs_solution(name),
    inputs=stiffness_inputs,
    compute=_compute,
    present=_present,
    check=check_contacts_of,
    cites=citing(*RING, PATCH, HERTZ),
    forecast=_forecast,
    internal=True,
)
