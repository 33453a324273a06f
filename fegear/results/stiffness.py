"""Result ``stiffness``: the table of one gear by finite elements on the whole ring."""

from __future__ import annotations

from dataclasses import dataclass, field
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fegear.engine.citation import citing
from fegear.engine.figure import DeferredFigure
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Forecast, Stage
from fegear.models.assumed import bore_remarks
from fegear.models.tooth_influence import solution_settings
from fegear.results.drawn_gear import tooth_figure
from fegear.results.drawn_stiffness import stiffness_figures
from fegear.results.gear_contacts import (
    USUAL_HALF_WIDTH,
    check_contacts_of,
    chosen_gears,
    contact_half_width,
    load_radii,
)
from fegear.results.gear_solution import needs_solution
from fegear.results.sources import HERTZ, PATCH, RING

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.case.reading import Scene
    from fegear.engine.stage import Upstream, Work
    from fegear.fem import StiffnessTable
    from fegear.geometry import Gear

#: Reading off one position of a solved gear [s].
_SECONDS_PER_POSITION = 3e-4
#: The error estimates of a table [s].
_SECONDS_OF_TABLE = 0.05


def _tables(name: str, t: StiffnessTable) -> tuple[Table, ...]:
    compliance, stress = "um.mm/N", "MPa.mm/N"
    columns = (
        Column("radius", t.radius, "mm", "radius of the contact point"),
        Column("roll_angle", t.roll_angle, "deg", "roll angle of the contact point"),
        Column("c_self", t.c_self, compliance, "deflection of the loaded tooth at the contact per line load"),
        Column("c_prev", t.c_prev, compliance, "deflection of the tooth before it at the same radius"),
        Column("c_next", t.c_next, compliance, "deflection of the tooth after it (which the loaded flank faces)"),
        Column("contact_half_width", t.half_width, "mm", "half-width of the contact that c_self is for"),
        Column(
            "root_tension", t.root_tension, stress, "largest tangential stress of the fillet below the loaded flank"
        ),
        Column("root_tension_radius", t.root_tension_radius, "mm", "where it sits"),
        Column("root_compression", t.root_compression, stress, "most negative tangential stress of the other fillet"),
        Column("root_compression_radius", t.root_compression_radius, "mm", "where it sits"),
        Column("c_self_error", t.errors["c_self"], compliance, "estimated error of c_self"),
        Column("c_neighbour_error", t.errors["c_neighbour"], compliance, "estimated error of c_prev and c_next"),
        Column("root_tension_error", t.errors["root_tension"], stress, "estimated error of root_tension"),
        Column("root_compression_error", t.errors["root_compression"], stress, "estimated error of root_compression"),
        Column("root_tension_angle", t.root_tension_angle, "deg", "fillet tangent to tooth centre line there"),
        Column("root_compression_angle", t.root_compression_angle, "deg", "the same on the other fillet"),
    )
    return (Table(f"stiffness_{name}", columns, f"Compliance and root stress of gear {name}"),)


def _values(name: str, gear: Gear, t: StiffnessTable) -> tuple[Value, ...]:
    tension, compression = int(np.argmax(t.root_tension)), int(np.argmin(t.root_compression))
    stress, found = "MPa.mm/N", []
    if gear.form_radius <= gear.pitch_radius <= gear.involute_tip_radius:
        known, at = t.influence, np.array([gear.pitch_radius])
        b = np.interp(gear.pitch_radius, t.radius[np.argsort(t.radius)], t.half_width[np.argsort(t.radius)])
        for key, c, error, meaning in (
            ("c_self", known.self_compliance(at, b)[0], known.contact_error(at, b)[0], "self compliance"),
            ("c_prev", known.neighbour(-1, at, at)[0, 0], known.neighbour_error(-1, at, at)[0, 0], "tooth before"),
            ("c_next", known.neighbour(1, at, at)[0, 0], known.neighbour_error(1, at, at)[0, 0], "tooth after"),
        ):
            found.append(Value(f"{name}.{key}_at_pitch", c, "um.mm/N", error, f"{meaning}, load on the pitch circle"))
    for key, i, value, error in (
        ("largest_root_tension", tension, t.root_tension, t.errors["root_tension"]),
        ("largest_root_compression", compression, t.root_compression, t.errors["root_compression"]),
    ):
        where = f"load at radius {t.radius[i] * 1e3:.6g} mm"
        found.append(Value(f"{name}.{key}", float(value[i]), stress, float(error[i]), f"per line load, {where}"))
    return tuple(found)


def _remarks(asked: StiffnessInputs, t: StiffnessTable) -> tuple[str, ...]:
    name, tolerance, remarks = asked.name, asked.tolerance, []
    # The neighbour's deflection is small beside the loaded tooth's, to which it is added: that is its scale.
    for label, value, error in (
        ("c_self", t.c_self, t.errors["c_self"]),
        ("c_next over c_self", t.c_self, t.errors["c_neighbour"]),
        ("root tension", t.root_tension, t.errors["root_tension"]),
        ("root compression", t.root_compression, t.errors["root_compression"]),
    ):
        relative = np.abs(error / value)
        i = int(np.argmax(relative))
        if relative[i] > tolerance:
            remarks.append(
                f"Gear {name}: the estimated error of {label} reaches {relative[i]:.1e} (tolerance {tolerance:.0e}), "
                f"at radius {t.radius[i] * 1e3:.6g} mm; at {np.mean(relative <= tolerance):.0%} of the positions it is "
                "within the tolerance."
            )
    return (*remarks, *asked.assumed)


@dataclass(frozen=True)
class StiffnessInputs:
    """What the table of a gear depends on beside its influence functions.

    Parameters
    ----------
    gear : Gear
    radii, half_widths : ndarray, shape (P,)
        Of the contacts [m].
    tolerance : float
        That estimated errors are held against.
    assumed : tuple of str
        Sentences about values that the case does not give.
    name : str
        Of the gear.
    """

    gear: Gear
    radii: Array
    half_widths: Array
    tolerance: float
    assumed: tuple[str, ...] = field(default=(), compare=False)
    name: str = field(default="", compare=False)


def _inputs(scene: Scene, name: str) -> StiffnessInputs:
    part, radii = scene.case.stiffness, load_radii(scene, name)
    assumed = bore_remarks(scene, name)
    if part.contact_half_width is None and part.load is None:
        usual = (
            f"Gear {name}: no contact_half_width or load was given, so c_self is for a half-width of "
            f"{USUAL_HALF_WIDTH} modules."
        )
        assumed = (usual, *assumed)
    widths = contact_half_width(scene, name, radii)
    return StiffnessInputs(scene.gears[name], radii, widths, scene.case.accuracy.tolerance, assumed, name)


def _compute(asked: StiffnessInputs, upstream: Upstream, _work: Work) -> StiffnessTable:
    from fegear.fem import stiffness_table

    (influence,) = upstream.values()
    return stiffness_table(asked.gear, asked.radii, asked.half_widths, influence=influence)


def _present(table: StiffnessTable, asked: StiffnessInputs) -> Outcome:
    name = asked.name
    return Outcome(
        table,
        _tables(name, table),
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
    positions = len(scene.case.stiffness.radii or ()) or scene.case.stiffness.positions
    return Forecast({"positions": positions}, _SECONDS_OF_TABLE + _SECONDS_PER_POSITION * positions)


STIFFNESS = Stage(
    subjects=lambda scene: chosen_gears(scene) if scene.case.stiffness.face_positions is None else (),
    needs=lambda _scene, name: needs_solution(name),
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=check_contacts_of,
    cites=citing(*RING, PATCH, HERTZ),
    forecast=_forecast,
)
