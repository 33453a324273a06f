"""Stages ``stiffness`` and ``root-stress``: the tables of one gear by finite elements on the whole ring."""

from __future__ import annotations

from dataclasses import dataclass, field, replace
from functools import partial
from typing import TYPE_CHECKING, cast

import numpy as np

from fegear.engine.citation import Citation, citing
from fegear.engine.figure import (
    Axis,
    Curve,
    DeferredFigure,
    Figure,
    Mark,
    Panel,
    Scale,
)
from fegear.engine.outcome import Column, Outcome, Table, Value
from fegear.engine.stage import Forecast, Stage, Task
from fegear.errors import InputError
from fegear.models.assumed import bore_remarks
from fegear.models.tooth_influence import solution_settings
from fegear.results.drawn_gear import deformed_figure, tooth_figure
from fegear.results.gear_solution import needs_solution
from fegear.results.sources import HERTZ, PATCH, RING

if TYPE_CHECKING:
    from fegear.arrays import Array
    from fegear.case.reading import Scene
    from fegear.engine.stage import Upstream, Work
    from fegear.fem import GearInfluence, StiffnessTable
    from fegear.geometry import Gear, GearPair
    from fegear.geometry.pair import Member


#: Line load of the deformed gear's picture when the case names none [N/m].
_USUAL_LINE_LOAD = 100e3
#: Angle of the fillet's tangent with the tooth's centre line at which ISO 6336-3 looks [deg].
_ISO_TANGENT = 30.0
#: Half-width of the contact in modules when the case gives neither a width nor a load.
USUAL_HALF_WIDTH = 0.02
#: Reading off one position of a solved gear [s].
_SECONDS_PER_POSITION = 3e-4
#: The error estimates of a table [s].
_SECONDS_OF_TABLE = 0.05


def _gear(scene: Scene) -> tuple[str, ...]:
    """The gear that ``[stiffness]`` names; every gear of the case if it names none."""
    return (scene.case.stiffness.gear,) if scene.case.stiffness.gear else tuple(scene.gears)


def _pair_of(scene: Scene, name: str) -> tuple[GearPair, Member] | None:
    """The pair in which the gear's contact is looked at, and its role there; None if it meshes with nothing."""
    for key, part in scene.case.pair.items():
        if scene.case.stiffness.pair in (None, key) and name in (part.driver, part.driven):
            return scene.pairs[key], "driver" if part.driver == name else "driven"
    return None


def _check(scene: Scene, name: str) -> None:
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
        low, high = gear.form_radius, gear.involute_tip_radius
        if not low * (1 - 1e-9) <= radius <= high * (1 + 1e-9):
            raise InputError(
                f"stiffness.radii[{i}]",
                f"{radius * 1e3:.9g} mm",
                f"lies off the involute flank of gear {name}",
                f"it runs from {low * 1e3:.9g} mm to {high * 1e3:.9g} mm",
            )
    if part.contact_half_width is not None:
        from fegear.fem.table import check_contacts

        check_contacts(gear, load_radii(scene, name), part.contact_half_width, "stiffness.contact_half_width")


def load_radii(scene: Scene, name: str) -> Array:
    """Radii of the table [m]: those of the case, or positions equally spaced in roll angle over the active profile."""
    part, gear = scene.case.stiffness, scene.gears[name]
    if part.radii is not None:
        return np.array(part.radii)
    found = _pair_of(scene, name)
    if found:
        pair, member = found
        ends = np.sort(pair.radius(np.array([pair.x_start, pair.x_end]), member))
    else:
        ends = np.array([gear.form_radius, gear.involute_tip_radius])
    low, high = np.clip(ends, gear.form_radius, gear.involute_tip_radius)
    first, last = (float(np.sqrt((r - gear.base_radius) * (r + gear.base_radius))) for r in (low, high))
    return np.clip(np.hypot(gear.base_radius, np.linspace(first, last, part.positions)), low, high)


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
            ("c_self", known.self_compliance(at, b)[0], known.self_error(at, b)[0], "self compliance"),
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
            *_figures(name, table),
        ),
    )


def _forecast(scene: Scene, _name: str) -> Forecast:
    positions = len(scene.case.stiffness.radii or ()) or scene.case.stiffness.positions
    return Forecast({"positions": positions}, _SECONDS_OF_TABLE + _SECONDS_PER_POSITION * positions)


_COMPLIANCE_AXIS = Axis("compliance", "um.mm/N")


def _roll_axis(gear: Gear, roll: Array) -> Axis:
    """Roll angle of the load, with the radius that belongs to it on the far side."""
    room = 0.05 * float(np.ptp(roll))
    shown = np.linspace(max(float(roll.min()) - room, 0.0), float(roll.max()) + room, 200)
    radius = gear.base_radius * 1e3 * np.hypot(1.0, np.deg2rad(shown))
    return Axis("roll angle of the load", "deg", second=Scale("load radius", "mm", shown, radius))


def _pitch_mark(gear: Gear, roll: Array) -> tuple[Mark, ...]:
    at = float(np.rad2deg(np.sqrt(max((gear.pitch_radius / gear.base_radius) ** 2 - 1.0, 0.0))))
    return (Mark("x", at, "pitch point"),) if roll.min() <= at <= roll.max() else ()


def _figures(name: str, t: StiffnessTable) -> tuple[Figure, ...]:
    gear, order = t.influence.gear, np.argsort(t.roll_angle)
    roll = np.rad2deg(t.roll_angle[order])
    x, marks = _roll_axis(gear, roll), _pitch_mark(gear, roll)

    def curve(values: Array, error: str, label: str, role: str, scale: float) -> Curve:
        return Curve(roll, values[order] * scale, label, role, t.errors[error][order] * scale)

    compliance, stress = 1e9, 1e-3
    width = f"{t.half_width.min() * 1e3:.4g}"
    if t.half_width.max() > 1.0001 * t.half_width.min():
        width += f" to {t.half_width.max() * 1e3:.4g}"
    i = int(np.argmax(t.root_tension))
    worst = float(np.max(np.abs(t.errors["c_self"] / t.c_self)))
    return (
        Figure(
            f"compliance_{name}",
            f"Compliance of gear {name}",
            f"Gear {name}: deflection per line load of the loaded tooth and of its neighbours at the same radius, "
            f"whole ring, contact half-width {width} mm. Bands: estimated error, for c_0 at most {worst:.1e} of it.",
            (
                Panel(x, _COMPLIANCE_AXIS, (
                    curve(t.c_self, "c_self", "c_{0}, loaded tooth", "loaded tooth", compliance),
                ), marks),
                Panel(replace(x, second=None), _COMPLIANCE_AXIS, (
                    curve(t.c_next, "c_neighbour", "c_{+1}, next tooth", "next tooth", compliance),
                    curve(t.c_prev, "c_neighbour", "c_{−1}, previous tooth", "previous tooth", compliance),
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
                Panel(x, Axis("largest root stress per line load", "MPa.mm/N", zero=True), (
                    curve(t.root_tension, "root_tension", "tension, fillet below the loaded flank", "tension", stress),
                    curve(-t.root_compression, "root_compression", "compression, other fillet (magnitude)",
                          "compression", stress),
                ), marks),
            ),
        ),
    )  # fmt: skip


STIFFNESS = Stage(
    name="stiffness",
    title="Compliance and root stress, whole gear",
    results=("stiffness",),
    subjects=_gear,
    needs=lambda _scene, name: needs_solution(name),
    inputs=_inputs,
    compute=_compute,
    present=_present,
    check=_check,
    cites=citing(*RING, PATCH, HERTZ),
    forecast=_forecast,
)


def _curve_columns(influence: GearInfluence, radius: float) -> tuple[Column, ...]:
    m, at = influence.gear.module, np.array([radius])
    fillets = [influence.fine.fillets[side] for side in ("tension", "compression")]
    stress = {
        k: np.concatenate([influence.fillet_stress(k, side, at)[:, 0] for side in ("tension", "compression")])
        for k in (-1, 0, 1)
    }
    side = np.repeat(np.array(["tension", "compression"]), [fillet.arc.size for fillet in fillets])

    def both(attribute: str, scale: float) -> Array:
        return np.concatenate([getattr(fillet, attribute) for fillet in fillets]) * scale

    return (
        Column("arc", both("arc", m), "mm", "arc length along the fillet from the root land"),
        Column("side", side, "", "fillet below the loaded flank (tension) or the other one"),
        Column("radius", both("radius", m), "mm", "distance from the gear's centre"),
        Column("angle", both("angle", 1.0), "deg", "clockwise angle from the tooth's centre line"),
        Column("tangent_angle", both("tangent_angle", 1.0), "deg", "fillet tangent to tooth centre line"),
        Column("stress", stress[0], "MPa.mm/N", "tangential stress per line load on the same tooth"),
        Column("stress_prev", stress[-1], "MPa.mm/N", "the same on the tooth before the loaded one"),
        Column("stress_next", stress[1], "MPa.mm/N", "the same on the tooth after the loaded one"),
    )


@dataclass(frozen=True)
class FilletCurves:
    """Stress along both fillets under the load that gives the largest root tension.

    Parameters
    ----------
    table : StiffnessTable
    radius : float
        Of the contact [m].
    """

    table: StiffnessTable
    radius: float


@dataclass(frozen=True)
class FilletInputs:
    """What the curves read: the gear's name and the line load of the picture of the deformed gear [N/m]."""

    line_load: float = field(compare=False)
    name: str = field(compare=False)

    @classmethod
    def of(cls, scene: Scene, name: str) -> FilletInputs:
        """As `Stage.inputs`."""
        return cls(scene.case.stiffness.load or _USUAL_LINE_LOAD, name)


def _worst_load(_asked: FilletInputs, upstream: Upstream, _work: Work) -> FilletCurves:
    (table,) = upstream.values()
    return FilletCurves(table, float(table.radius[int(np.argmax(table.root_tension))]))


def _present_curves(found: FilletCurves, asked: FilletInputs) -> Outcome:
    name, radius = asked.name, found.radius
    title = f"Root stress along the fillets of gear {name}, load at radius {radius * 1e3:.6g} mm"
    influence = found.table.influence
    table = Table(f"root_stress_{name}", _curve_columns(influence, radius), title)
    figures: tuple[Figure | DeferredFigure, ...] = (
        _fillet_figure(name, radius, table),
        DeferredFigure(
            f"deformed_{name}", f"Deformed gear {name}", partial(deformed_figure, name, influence, asked.line_load)
        ),
    )
    return Outcome(found, (table,), figures=figures)


def _fillet_figure(name: str, radius: float, table: Table) -> Figure:
    panels = []
    columns = {column.name: column.values for column in table.columns}
    for side, title in (("tension", "Fillet below the loaded flank"), ("compression", "Fillet of the other flank")):
        here = columns["side"] == side
        arc, tangent = (np.asarray(columns[key][here], dtype=float) for key in ("arc", "tangent_angle"))
        marks = [Mark("y", 0.0)]
        if tangent.min() < _ISO_TANGENT < tangent.max():
            marks.append(Mark("x", float(np.interp(-_ISO_TANGENT, -tangent, arc)), "30° tangent"))
        curves = tuple(
            Curve(arc, np.asarray(columns[key][here], dtype=float), role, role, markers=False)
            for key, role in (
                ("stress", "loaded tooth"), ("stress_next", "next tooth"), ("stress_prev", "previous tooth")
            )
        )  # fmt: skip
        axes = Axis("arc length from the root land", "mm"), Axis("tangential stress per line load", "MPa.mm/N")
        panels.append(Panel(*axes, curves, tuple(marks), title))
    return Figure(
        f"fillet_{name}",
        f"Stress along the fillets of gear {name}",
        f"Gear {name}: tangential stress along both fillets with the load at radius {radius * 1e3:.6g} mm.",
        tuple(panels),
        columns=2,
    )


ROOT_STRESS = Stage(
    name="root-stress",
    title="Root stress along the fillets",
    results=("root-stress",),
    subjects=_gear,
    needs=lambda _scene, name: (Task("stiffness", name),),
    inputs=FilletInputs.of,
    compute=_worst_load,
    present=_present_curves,
    cites=citing(*RING, Citation("iso-6336-3", "the 30 degree tangent that the place is compared with", "clause 6")),
    forecast=lambda _scene, _name: Forecast({}, 0.01),
)
