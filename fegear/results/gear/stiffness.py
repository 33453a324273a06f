"""Result ``stiffness``: the table of one gear by finite elements on the whole ring.

Figures of a gear's compliance and root stress over the position of the load.

Where and how widely the teeth of one gear are loaded: ``[stiffness]``, read and checked.

Stage ``gear-solution``: the influence functions of a gear by finite elements, for every result that needs them.
"""

from __future__ import annotations

from dataclasses import asdict, dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, Any, cast

import numpy as np

from fegear.base.arrays import first_of_largest
from fegear.base.errors import InputError
from fegear.case.built.rated_duty import bore_remarks
from fegear.case.built.tooth_influence import (
    gear_to_solve,
    mesh_settings,
    solution_remarks,
    solution_settings,
    solve_influence_functions,
)
from fegear.engine.citation import citing
from fegear.engine.declared import axis_of, column_of, columns_of, drawn, error_column, value_of
from fegear.engine.figure.figure import Axis, DeferredFigure, Figure, Panel, Scale
from fegear.engine.figure.items import Curve, Mark
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage, Task
from fegear.engine.table import Table
from fegear.results import forecasts
from fegear.results.forecasts import HERTZ, PATCH, RING
from fegear.results.gear.drawing import tooth_figure

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.base.arrays import Array
    from fegear.case.built.tooth_influence import GearToSolve
    from fegear.case.reading import Scene
    from fegear.engine.outcome import Value
    from fegear.engine.stage import Upstream, Work
    from fegear.fem.plane.gear import GearInfluence
    from fegear.fem.plane.influence import Influence
    from fegear.fem.plane.table import StiffnessTable
    from fegear.geometry.gear import Gear
    from fegear.geometry.pair import GearPair, Member


#: Reading off one position of a solved gear [s].
_SECONDS_PER_POSITION = 3e-4


#: The error estimates of a table [s].
_SECONDS_OF_TABLE = 0.05


_SIDES = ("root_tension", "root_compression")


def _table(name: str, t: StiffnessTable) -> Table:
    errors = {key: error_column(column_of(t, key), t.errors[key]) for key in ("c_self", *_SIDES)}
    neighbour = column_of(
        t, "c_next", t.errors["c_neighbour"], name="c_neighbour_error", meaning="estimated error of c_prev and c_next"
    )
    columns = (
        *columns_of(t, table="flank"), errors.pop("c_self"), neighbour, *errors.values(),
        *columns_of(t, "root_tension_angle", "root_compression_angle"),
    )  # fmt: skip
    return Table(f"stiffness_{name}", columns, f"Compliance and root stress of gear {name}")


def _values(name: str, gear: Gear, t: StiffnessTable) -> tuple[Value, ...]:
    found = []
    low, high = gear.involute_radii
    if low <= gear.pitch_radius <= high:
        known, at = t.influence, np.array([gear.pitch_radius])
        b = np.interp(gear.pitch_radius, t.radius[np.argsort(t.radius)], t.half_width[np.argsort(t.radius)])
        for key, (c, off), meaning in (
            ("c_self", known.contact(at, b), "self compliance"),
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
    i = int(np.argmax(relative))
    said = (
        f"{who}: the estimated error of {label} reaches {relative[i]:.1e} (tolerance {tolerance:.0e}), at radius "
        f"{radius[i] * 1e3:.6g} mm; at {np.mean(relative <= tolerance):.0%} of the {of} it is within the tolerance."
    )
    return [said] if relative[i] > tolerance else []


def _remarks(asked: StiffnessInputs, t: StiffnessTable) -> tuple[str, ...]:
    remarks: list[str] = []
    # The neighbour's deflection is small beside the loaded tooth's, to which it is added: that is its scale.
    for label, value, error in (
        ("c_self", t.c_self, t.errors["c_self"]),
        ("c_next over c_self", t.c_self, t.errors["c_neighbour"]),
        ("root tension", t.root_tension, t.errors["root_tension"]),
        ("root compression", t.root_compression, t.errors["root_compression"]),
    ):
        relative = np.abs(error / value)
        remarks += tolerance_remarks(f"Gear {asked.name}", label, relative, t.radius, asked.tolerance, "positions")
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
        That estimated errors are compared with.
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
    positions = len(scene.case.stiffness.radii or ()) or scene.case.stiffness.positions
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


#: Half-width of the contact in modules when the case gives neither a width nor a load.
USUAL_HALF_WIDTH = 0.02


#: Share of the flank's length at either end where bands on a solid gear want a finer section than the usual one.
END_SHARE = 0.07


def chosen_gears(scene: Scene) -> tuple[str, ...]:
    """The spur gear that ``[stiffness]`` names; every spur gear of the case if it names none."""
    named = scene.case.stiffness.gear
    if named is not None and named not in scene.spur_gears:
        raise InputError(
            "stiffness.gear", f'"{named}"', "is helical, and its teeth are no plane problem", "name a spur gear"
        )
    return tuple(scene.spur_gears) if named is None else (named,)


def _pair_of(scene: Scene, name: str) -> tuple[GearPair, Member] | None:
    """The pair in which the gear's contact is looked at, and its role there; None if it meshes with nothing."""
    for key, part in scene.case.pair.items():
        if scene.case.stiffness.pair in (None, key) and name in (part.driver, part.driven):
            return scene.pairs[key], "driver" if part.driver == name else "driven"
    return None


def check_contacts_of(scene: Scene, name: str) -> None:
    """Refuse loads without a mate, and contacts that lie off the flank or are wider than it."""
    part = scene.case.stiffness
    if part.pair is not None and _pair_of(scene, name) is None:
        raise InputError("stiffness.pair", f'"{part.pair}"', f"does not hold gear {name}", "name a pair of that gear")
    if part.load is not None and _pair_of(scene, name) is None:
        raise InputError(
            "stiffness.load",
            f"{part.load * 1e-3:.6g} N/mm",
            "gives a contact width only together with the mating flank",
            f"describe a pair with gear {name}, or give contact_half_width",
        )
    gear = scene.gears[name]
    for i, radius in enumerate(part.radii or ()):
        low, high = gear.involute_radii
        if not low * (1 - 1e-9) <= radius <= high * (1 + 1e-9):
            raise InputError(
                f"stiffness.radii[{i}]",
                f"{radius * 1e3:.9g} mm",
                f"lies off the involute flank of gear {name}",
                f"it runs from {low * 1e3:.9g} mm to {high * 1e3:.9g} mm",
            )
    if part.contact_half_width is not None:
        from fegear.fem.plane.table import check_contacts

        check_contacts(gear, load_radii(scene, name), part.contact_half_width, "stiffness.contact_half_width")


def load_radii(scene: Scene, name: str) -> Array:
    """Radii of the table [m]: those of the case, or positions equally spaced in roll angle over the active profile.

    Those of a solid's bands keep off the very ends of the flank.
    """
    part, gear = scene.case.stiffness, scene.gears[name]
    if part.radii is not None:
        return np.array(part.radii)
    found = _pair_of(scene, name)
    if found:
        pair, member = found
        ends = np.sort(pair.radius(np.array([pair.x_start, pair.x_end]), member))
    else:
        ends = np.array(gear.involute_radii)
    low, high = np.clip(ends, *gear.involute_radii)
    first, last = (float(np.sqrt((r - gear.base_radius) * (r + gear.base_radius))) for r in (low, high))
    if part.face_positions is None:
        return np.clip(np.hypot(gear.base_radius, np.linspace(first, last, part.positions)), low, high)
    # Arc lengths go with the squares; within this share of the flank's ends a solid's bands are poorly resolved.
    low_2, high_2 = (r**2 - gear.base_radius**2 for r in gear.involute_radii)
    inner = [np.sqrt(low_2 + share * (high_2 - low_2)) for share in (END_SHARE, 1.0 - END_SHARE)]
    return np.hypot(gear.base_radius, np.linspace(max(first, inner[0]), min(last, inner[1]), part.band_radii))


def contact_half_width(scene: Scene, name: str, radii: Array) -> Array:
    """Half-width of the contact at every radius [m]: given, from Hertz for a load and a mate, or 0.02 modules."""
    part, gear = scene.case.stiffness, scene.gears[name]
    if part.contact_half_width is not None:
        return np.full(radii.shape, part.contact_half_width)
    if part.load is None:
        return np.full(radii.shape, USUAL_HALF_WIDTH * gear.module)
    from fegear.formulas.hertz import line_contact, relative_curvature

    pair, member = cast("tuple[GearPair, Member]", _pair_of(scene, name))
    mate: Member = "driven" if member == "driver" else "driver"
    x = np.clip(pair.x_of_radius(radii, member), pair.x_start, pair.x_end)
    curvature = relative_curvature(pair.flank_curvature_radius(x, member), pair.flank_curvature_radius(x, mate))
    modulus = 1.0 / (1.0 / gear.plane_modulus + 1.0 / pair.gear(mate).plane_modulus)
    return line_contact(part.load, curvature, modulus).half_width


#: How many times a solution reports that it goes on, about.
_STEPS = 4


def needs_solution(*gears: str) -> tuple[Task, ...]:
    """The tasks of this stage for gears, each once."""
    return tuple(Task("gear-solution", name) for name in dict.fromkeys(gears))


def solution_of(upstream: Upstream, gear: str) -> GearInfluence:
    """What this stage computed for a gear."""
    return cast("GearInfluence", upstream[Task("gear-solution", gear)])


def _solve_gears(asked: GearToSolve, _upstream: Upstream, work: Work) -> GearInfluence:
    steps = iter(range(_STEPS))
    return solve_influence_functions(asked, work.cache, lambda _title: work.progress(next(steps, _STEPS) / _STEPS))


def _present_solution(influence: GearInfluence, asked: GearToSolve) -> Outcome:
    remarks = solution_remarks(asked.name, influence, asked.tolerance)
    return Outcome(influence, settings=solution_settings(influence), remarks=remarks)


def _solving_forecast(scene: Scene, name: str) -> Forecast:
    settings = mesh_settings(scene.case.accuracy)
    if scene.case.gear[name].tooth_mesh is not None:
        return Forecast({"mesh": scene.case.gear[name].tooth_mesh, "order": settings.order})
    return Forecast(asdict(settings), 0.0, forecasts.shapes(scene, [name]))


@dataclass(frozen=True)
class Reach:
    """What a table of unit loads on one gear depends on beside the gear's solution."""

    teeth: int


def of_solved_gear(compute: Callable[[Influence, int], Any], reach: int, seconds: float) -> Stage:
    """The stage of what one solved spur gear gives by itself, for results of its pairs.

    Parameters
    ----------
    compute : callable
        ``compute(fine, reach)``, of the gear's finer solution.
    reach : int
        Neighbours to either side of the loaded tooth that it is known for.
    seconds : float
        What it takes.
    """

    def found(asked: Reach, upstream: Upstream, _work: Work) -> Any:
        (influence,) = upstream.values()
        return compute(cast("GearInfluence", influence).fine, asked.teeth)

    return Stage(
        subjects=lambda scene: tuple(scene.spur_gears),
        needs=lambda _scene, name: needs_solution(name),
        inputs=lambda _scene, _name: Reach(reach),
        compute=found,
        present=lambda data, _inputs: Outcome(data),
        cites=citing(*RING),
        forecast=lambda _scene, _name: forecasts.constant(seconds),
        internal=True,
    )


STIFFNESS = Stage(
    subjects=lambda scene: chosen_gears(scene) if scene.case.stiffness.face_positions is None else (),
    needs=lambda _scene, name: needs_solution(name),
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=check_contacts_of,
    cites=citing(*RING, PATCH, HERTZ),
    forecast=_forecast,
    internal=True,
)


GEAR_SOLUTION = Stage(
    subjects=lambda scene: tuple(scene.spur_gears),
    inputs=gear_to_solve,
    compute=_solve_gears,
    present=_present_solution,
    cites=citing(*RING),
    forecast=_solving_forecast,
    internal=True,
)
