"""Result ``stiffness``: the table of one gear by finite elements on the whole ring.

Figures of a gear's compliance and root stress over the position of the load.
"""

from __future__ import annotations

from dataclasses import dataclass
from functools import partial
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.arrays import Array, first_of_largest
from fegear.base.notes import exceeding
from fegear.base.printed import percent, rounded
from fegear.base.shown import shown
from fegear.case.built.tooth_influence import solution_settings
from fegear.engine.citation import citing
from fegear.engine.declared import axis_of, drawn
from fegear.engine.figure.axis import Axis, Scale
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.chart import Chart, Line, Over
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import Cell, Every, Off, Rows
from fegear.engine.sheet.sheet import Sheet
from fegear.engine.stage import Forecast, Stage, Upstream, Work
from fegear.results.forecasts import HERTZ, PATCH, RING
from fegear.results.gear.load_positions import StiffnessInputs, check_contacts_of, chosen_gears, stiffness_inputs
from fegear.results.gear.solved_gear import needs_solution

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.reading import Scene
    from fegear.engine.figure.figure import DeferredFigure
    from fegear.engine.figure.items import Mark
    from fegear.engine.sheet.seen import Seen
    from fegear.fem.plane.neighbour_table import NeighbourTable
    from fegear.fem.plane.table import StiffnessTable


#: Reading off one position of a solved gear [s].
_SECONDS_PER_POSITION = 3e-4


#: The error estimates of a table [s].
_SECONDS_OF_TABLE = 0.05


#: Line load whose deflection an answer says [N/m].
_EXAMPLE = 100e3


@dataclass(frozen=True)
class AtPitch:
    """A compliance under a load on the pitch circle, with its estimated error."""

    error: float
    word: str
    compliance: float = shown("um.mm/N")


@dataclass(frozen=True)
class LargestStress:
    """Largest root stress over all positions of the load, with its estimated error and the radius of the load."""

    error: float
    stress: float = shown("MPa.mm/N")
    radius: float = shown("mm")


#: Estimated errors of the loaded tooth's compliance, and of its neighbours', of a plane or a solid gear.
COMPLIANCE_ERRORS = (
    Off("c_self", lambda seen: np.ravel(seen.data.errors["c_self"])),
    Cell(
        "c_next", si=lambda seen: np.ravel(seen.data.errors["c_neighbour"]), name="c_neighbour_error",
        meaning="estimated error of c_prev and c_next",
    ),
)  # fmt: skip


def _at_pitch(seen: Seen) -> dict[str, AtPitch]:
    """Compliances under a load on the pitch circle, where the flank has it."""
    t: StiffnessTable = seen.data
    gear, known, at = t.influence.gear, t.influence, np.array([t.influence.gear.pitch_radius])
    low, high = gear.involute_radii
    if not low <= gear.pitch_radius <= high:
        return {}
    order = np.argsort(t.radius)
    b = np.interp(gear.pitch_radius, t.radius[order], t.half_width[order])
    found = {
        "c_self": (known.contact(at, b)[:2], "self-compliance c_0"),
        "c_prev": (known.neighbour_with_error(-1, at, at), "previous tooth"),
        "c_next": (known.neighbour_with_error(1, at, at), "next tooth"),
    }
    return {key: AtPitch(off.item(), word, c.item()) for key, ((c, off), word) in found.items()}


def _largest(seen: Seen) -> dict[str, LargestStress]:
    t: StiffnessTable = seen.data
    at = {"root_tension": t.root_tension, "root_compression": -t.root_compression}
    places = {key: int(first_of_largest(size)) for key, size in at.items()}
    return {
        key: LargestStress(float(t.errors[key][i]), float(getattr(t, key)[i]), float(t.radius[i]))
        for key, i in places.items()
    }


def tolerance_remarks(who: str, label: str, relative: Array, radius: Array, tolerance: float, of: str) -> list[str]:
    """Where the estimated relative errors of a quantity over the radius [m] miss the tolerance, if anywhere."""
    i = int(first_of_largest(relative))
    within, reached = percent(float(np.mean(relative <= tolerance))), percent(float(relative[i]))
    said = exceeding(
        f"{who}: estimated error of {label} up to {reached} (tolerance {100.0 * tolerance:g} %) at radius "
        f"{radius[i] * 1e3:.6g} mm; within tolerance at {within} of the {of}."
    )
    return [said] if relative[i] > tolerance else []


def _remarks(seen: Seen) -> list[str]:
    t, asked, remarks = seen.data, seen.asked, []
    # The neighbour's deflection is small compared with the loaded tooth's, to which it is added: that is its scale.
    for label, value, error in (
        ("c_self", t.c_self, t.errors["c_self"]),
        ("c_next / c_self", t.c_self, t.errors["c_neighbour"]),
        ("root tension", t.root_tension, t.errors["root_tension"]),
        ("root compression", t.root_compression, t.errors["root_compression"]),
    ):
        relative = np.abs(error) / np.maximum(np.abs(value), 0.1 * np.abs(value).max())
        remarks += tolerance_remarks(f"Gear {asked.name}", label, relative, t.radius, asked.tolerance, "positions")
    return [*remarks, *asked.assumed]


def _compute(asked: StiffnessInputs, upstream: Upstream, _work: Work) -> StiffnessTable:
    from fegear.fem.plane.table import stiffness_table

    (influence,) = upstream.values()
    return stiffness_table(asked.gear, asked.radii, asked.half_widths, influence=influence)


def _forecast(scene: Scene, _name: str) -> Forecast:
    positions = len(scene.case.stiffness.radii or ()) or scene.case.stiffness.load_positions
    return Forecast({"positions": positions}, _SECONDS_OF_TABLE + _SECONDS_PER_POSITION * positions)


def _tooth(seen: Seen) -> Iterator[DeferredFigure]:
    """The tooth with its tool and mesh."""
    from fegear.engine.figure.figure import DeferredFigure
    from fegear.results.gear.drawing import tooth_figure

    name, known = seen.name, seen.data.influence
    draw = partial(tooth_figure, name, known.gear, known.fine.mesh)
    yield DeferredFigure(f"tooth_{name}", f"Tooth, tool and mesh of gear {name}", draw)


def _roll_axis(seen: Seen) -> Axis:
    """Roll angle of the load, with the radius that belongs to it on the far side."""
    t: StiffnessTable = seen.data
    roll = drawn(t.over_roll, "roll_angle")
    room = 0.05 * float(np.ptp(roll))
    first, last = float(roll.min()) - room, float(roll.max()) + room
    at = np.linspace(max(first, 0.0) if first + last > 0.0 else first, last, 200)
    radius = t.influence.gear.base_radius * 1e3 * np.hypot(1.0, np.deg2rad(at))
    return axis_of(t, "roll_angle", second=Scale("load radius", "mm", at, radius))


def _pitch_mark(seen: Seen) -> tuple[Mark, ...]:
    from fegear.engine.figure.items import Mark

    gear, roll = seen.data.influence.gear, drawn(seen.data.over_roll, "roll_angle")
    at = gear.tooth.side * float(np.rad2deg(np.sqrt(max((gear.pitch_radius / gear.base_radius) ** 2 - 1.0, 0.0))))
    return (Mark("x", at, "pitch point"),) if roll.min() <= at <= roll.max() else ()


def _contact_width(t: StiffnessTable) -> str:
    low, high = t.half_width.min(), t.half_width.max()
    return f"{low * 1e3:.4g}" + (f" to {high * 1e3:.4g}" if high > 1.0001 * low else "")


def _on_compliance(seen: Seen) -> str:
    t: StiffnessTable = seen.data
    return (
        f"Gear {seen.name}: deflection per line load of the loaded tooth and of its neighbours at the same radius, "
        f"whole ring, contact half-width {_contact_width(t)} mm. Bands: estimated error, for c_0 at most "
        f"{np.max(np.abs(t.errors['c_self'] / t.c_self)):.1e} of it."
    )


def _on_root_stress(seen: Seen) -> str:
    t: StiffnessTable = seen.data
    i = int(first_of_largest(t.root_tension))
    return (
        f"Gear {seen.name}: maximum tangential fillet stress per line load. The maximum on the tension side is at "
        f"radius {t.root_tension_radius[i] * 1e3:.5g} mm, where the tangent of the fillet is at "
        f"{np.rad2deg(t.root_tension_angle[i]):.1f} deg to the tooth centre line (30 deg in ISO 6336-3)."
    )


def _line(key: str, error: str, label: str, role: str) -> Line:
    return Line(key, label, role, error=f"over_roll.errors.{error}", x="roll_angle")


def _at_a_load(seen: Seen) -> Iterator[str]:
    """What the compliance is at a load that one can imagine."""
    if (one := _at_pitch(seen).get("c_self")) is not None:
        moved = rounded(one.compliance * _EXAMPLE * 1e6, one.error * _EXAMPLE * 1e6)
        yield f"Gear {seen.name}: {_EXAMPLE * 1e-3:g} N/mm deflect the loaded tooth by {moved} µm."


def _neighbours(seen: Seen) -> NeighbourTable | None:
    """Deflection of the next teeth over a grid of radii; None of a gear solved without neighbours."""
    from fegear.fem.plane.neighbour_table import neighbour_table

    return neighbour_table(seen.data.influence) if seen.data.influence.reach else None


_SHEET = Sheet(
    tables=(
        Rows(
            "stiffness_{name}", "Compliance and root stress of gear {name}",
            (
                Every("flank"), *COMPLIANCE_ERRORS,
                *(Off(key, f"errors.{key}") for key in ("root_tension", "root_compression")),
                "root_tension_angle", "root_compression_angle", "c_self_reduction",
            ),
        ),
        Rows(
            "neighbour_compliance_{name}", "Compliance between the teeth of gear {name} at two radii",
            (Every("neighbours"),), of=_neighbours, matlab=True,
        ),
    ),
    values=(
        Number(
            "compliance", "error", each=_at_pitch, name="{key}_at_pitch", meaning="{one.word}, load on the pitch circle"
        ),
        Number(
            "stress", "error", each=_largest, name="largest_{key}",
            meaning="per line load, load at radius {one.radius:.6g}",
        ),
    ),
    figures=(
        _tooth,
        Chart(
            "compliance_{name}", "Compliance of gear {name}", _on_compliance,
            (
                Over(
                    _roll_axis, (_line("c_self", "c_self", "c_{{0}}, loaded tooth", "loaded tooth"),), marks=_pitch_mark
                ),
                Over(
                    "roll_angle",
                    (
                        _line("c_next", "c_neighbour", "c_{{+1}}, next tooth", "next tooth"),
                        _line("c_prev", "c_neighbour", "c_{{−1}}, previous tooth", "previous tooth"),
                    ),
                    marks=_pitch_mark,
                ),
            ),
            of="over_roll",
        ),
        Chart(
            "root_stress_{name}", "Root stress of gear {name}", _on_root_stress,
            (
                Over(
                    _roll_axis,
                    (
                        _line("root_tension", "root_tension", "tension side (fillet of the loaded flank)", "tension"),
                        _line(
                            "root_compression", "root_compression", "compression side (magnitude)",
                            "compression",
                        ),
                    ),
                    options={"zero": True}, marks=_pitch_mark,
                ),
            ),
            of="over_roll",
        ),
    ),
    remarks=(_remarks,),
    answer=Answer(
        "Gear {name}, load on the pitch circle: compliance {v[c_self_at_pitch]} of the loaded tooth, "
        "{v[c_next_at_pitch]} of the next one.",
        _at_a_load,
        "Gear {name}: root stress at most {v[largest_root_tension]} (tension) and {v[largest_root_compression]} "
        "(compression).",
        figure="compliance_{name}",
    ),
    settings=lambda seen: solution_settings(seen.data.influence),
)  # fmt: skip


STIFFNESS = Stage(
    subjects=lambda scene: chosen_gears(scene) if scene.case.stiffness.face_positions is None else (),
    needs=lambda _scene, name: needs_solution(name),
    inputs=stiffness_inputs,
    compute=_compute,
    present=_SHEET.present,
    check=check_contacts_of,
    cites=citing(*RING, PATCH, HERTZ),
    forecast=_forecast,
)
