"""Stage ``geometry``: the numbers of every gear and pair that a drawing would carry.

The gear data of a drawing, gear beside gear: what stands in the corner of a drawing and at the head of a report.

What is ground off the flanks of a gear, for its gear data: the amounts that a drawing states.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np

from fegear.base.errors import GeometryError
from fegear.case.gear import GearPart
from fegear.case.reading import Scene
from fegear.engine.citation import Citation, citing
from fegear.engine.declared import column_over, value_of
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Stage
from fegear.engine.table import Column, Table
from fegear.engine.value import Value
from fegear.geometry.checks import tip_thickness
from fegear.geometry.gear import Gear
from fegear.geometry.inspection import usual_span
from fegear.geometry.internal_tooth import InternalTooth
from fegear.geometry.over_balls import OverBalls, over_balls, touching_ball, usual_ball
from fegear.geometry.pair import MEMBERS, GearPair, active_profile, specific_sliding
from fegear.geometry.tip_interference import interference
from fegear.results.forecasts import INVOLUTE
from fegear.results.gear.body_section import body_figures
from fegear.results.gear.drawing import Drawing, pair_figure

#: Of a pair, as single values.
_OF_PAIR = ("contact_ratio", "centre_distance", "working_pressure_angle", "path_length", "base_pitch")
#: Of a gear, in the table of all gears.
_SHOWN = (
    "teeth", "module", "tip_radius", "involute_tip_radius", "pitch_radius", "base_radius", "form_radius",
    "root_radius", "bore_radius", "face_width",
)  # fmt: skip


def _everything(scene: Scene) -> tuple[str, ...]:
    return ("",) if scene.gears else ()


def _present(_found: Drawing, drawing: Drawing) -> Outcome:
    gears, pairs = drawing.gears, drawing.pairs
    names = list(gears)
    measures = {column.name: column for column in measurement_columns(drawing, names)}

    table = Table(
        "geometry",
        (
            Column("gear", np.array(names), "", "name of the gear"),
            *(column_over(tuple(gears.values()), attribute) for attribute in _SHOWN),
            *(measures[name] for name in ("span_teeth", "span", "ball_diameter", "over_balls")),
            *(measures[name] for name in ("tooth_thickness", "tip_thickness")),
        ),
        "Gears",
        printed=True,
    )
    bodies = mass_table(gears)
    values = tuple(value for name, pair in pairs.items() for value in pair_values(name, pair))
    remarks = tuple(
        f"Pair {name}: the contact ratio of {pair.total_contact_ratio:.4f} is below 1: no teeth are on the path at "
        "some roll positions. Lengthen the teeth, raise their number or lower the centre distance."
        for name, pair in pairs.items()
        if pair.total_contact_ratio < 1.0
    )
    remarks += tuple(
        f"Pair {name}: {sentence}."
        for name, pair in pairs.items()
        for sentence in (interference(pair, "driver").sentence, interference(pair, "driven").sentence)
        if sentence
    )
    remarks += tuple(
        f"Pair {name}: {one.of_pinion.sentence(pair.driver.module)}."
        for name, pair in pairs.items()
        for one in pair.internal_checks
        if one.margin < 0.0 and (one.fouls(pair.driver.module) or not one.refused)
    )
    remarks += tuple(
        f"Pair {name}: these gears cannot run; {pair.clearing} to clear all tips."
        for name, pair in pairs.items()
        if pair.clearing
    )
    lone = lone_table(drawing)
    tables = (table, bodies, *(pair_table(name, drawing) for name in pairs), *(() if lone is None else (lone,)))
    figures = (*(pair_figure(name, drawing) for name in pairs), *body_figures(gears))
    return Outcome(drawing, tables, values, {}, (*remarks, *drawing.assumed, *unmeasured_remarks(drawing)), figures)


def drawing_of(scene: Scene) -> Drawing:
    """What a case says of its gears and pairs."""
    parts = scene.case.pair
    members = {name: (parts[name].driver, parts[name].driven) for name in scene.pairs}
    balls = {name: d for name in scene.gears if (d := scene.case.gear[name].ball_diameter) is not None}
    ground = {name: amounts for name in scene.gears if (amounts := ground_off(scene.case.gear[name]))}
    return Drawing(scene.gears, scene.pairs, members, balls, ground, (*assumed_cutters(scene), *assumed_bodies(scene)))


def assumed_cutters(scene: Scene) -> tuple[str, ...]:
    """Sentences on ring gears whose cutter the case leaves open."""
    return tuple(
        f"Gear {name}: cutter.teeth is not given; assumed default: {gear.tooth.cutter.teeth} teeth, the largest cutter "
        "that trims no tip of the ring. It makes the fillet, not the flanks."
        for name, gear in scene.gears.items()
        if isinstance(gear.tooth, InternalTooth)
        and (part := scene.case.gear[name].cutter) is not None
        and part.teeth is None
    )


def assumed_bodies(scene: Scene) -> tuple[str, ...]:
    """Sentences on gears whose mass is that of an assumed bore or face width."""
    found = []
    for name, part in scene.case.gear.items():
        gear, lacking = scene.gears[name], []
        if not part.gives_rim:
            key = "outer_radius" if part.internal else "bore_radius"
            lacking.append(f"{key} = {gear.bore_radius * 1e3:.6g} mm")
        if part.face_width is None:
            lacking.append(f"face_width = {gear.face_width * 1e3:.6g} mm")
        if lacking:
            found.append(f"Gear {name}: mass and inertia are those of the default {' and '.join(lacking)}.")
    return tuple(found)


def mass_table(gears: Mapping[str, Gear]) -> Table:
    """Mass, moments of inertia and centre of gravity of all gears, teeth integrated."""
    bodies = tuple(gear.mass_properties for gear in gears.values())
    names = Column("gear", np.array(list(gears)), "", "name of the gear")
    attributes = ("mass", "inertia", "transverse_inertia", "centre_of_gravity")
    columns = (column_over(bodies, attribute) for attribute in attributes)
    return Table("mass_and_inertia", (names, *columns), "Mass and inertia of gears", printed=True)


def measured(gear: Gear, ball_diameter: float | None = None) -> OverBalls | None:
    """Dimension over the given balls, or over usual ones; None where no ball touches the flanks."""
    if ball_diameter is not None:
        return over_balls(gear, ball_diameter)
    for diameter in (usual_ball(gear), touching_ball(gear)):
        try:
            return over_balls(gear, diameter)
        except GeometryError:
            continue
    return None


def measurement_columns(drawing: Drawing, names: Sequence[str]) -> tuple[Column, ...]:
    """Thicknesses, span and dimension over balls of some gears."""
    gears = [drawing.gears[name] for name in names]
    found = [measured(drawing.gears[name], drawing.balls.get(name)) for name in names]
    spans = [usual_span(gear) or (np.nan, np.nan) for gear in gears]
    normal = "normal tooth thickness s_n" if _helical(gears) else "tooth thickness s"
    kinds = {gear.tooth.internal for gear in gears}
    where = "over (internal gears: between)" if len(kinds) == 2 else "between" if kinds == {True} else "over"

    return (
        Column("tooth_thickness", np.array([gear.normal_thickness(gear.pitch_radius) for gear in gears]), "mm",
               f"{normal} at d"),
        Column("tip_thickness", np.array([tip_thickness(gear) for gear in gears]), "mm",
               f"{normal.rpartition(' ')[0]} at d_Fa"),
        Column("span_teeth", np.array([count for count, _ in spans]), "", "teeth in the span k"),
        Column("span", np.array([length for _, length in spans]), "mm", "span W_k"),
        Column("ball_diameter", np.array([np.nan if one is None else one.ball_diameter for one in found]), "mm",
               "ball or pin D_M"),
        Column("over_balls", np.array([np.nan if one is None else one.dimension for one in found]), "mm",
               f"{where} balls or pins M_dK"),
    )  # fmt: skip


def _helical(gears: Sequence[Gear]) -> bool:
    return any(gear.helix_angle != 0.0 for gear in gears)


def unmeasured_remarks(drawing: Drawing) -> tuple[str, ...]:
    """Which gears have no span or no dimension over balls, and why."""
    spanless = tuple(
        f"Gear {name} has no span: its face is too narrow for discs that touch its leaning flanks."
        for name, gear in drawing.gears.items()
        if usual_span(gear) is None and not gear.tooth.internal
    )
    return spanless + tuple(
        f"Gear {name} has no dimension over or between balls: none that touches both flanks stands out of the tooth "
        "space."
        if gear.tooth.internal
        else f"Gear {name} has no dimension over balls: none that touches both flanks stands out of the tooth space."
        for name, gear in drawing.gears.items()
        if measured(gear, drawing.balls.get(name)) is None
    )


def _tooth_columns(names: Sequence[str], gears: Sequence[Gear]) -> tuple[Column, ...]:
    def column(name: str, values: Sequence[float], unit: str, meaning: str) -> Column:
        return Column(name, np.array(values), unit, meaning)

    def diameter(name: str, attribute: str, meaning: str) -> Column:
        return column(name, [2.0 * getattr(gear, attribute) for gear in gears], "mm", meaning)

    return (
        Column("gear", np.array(names), "", "gear"),
        column("teeth", [gear.teeth for gear in gears], "", "number of teeth z"),
        *_section_columns(gears),
        column("profile_shift", [gear.tooth.profile_shift for gear in gears], "", "profile shift coefficient x"),
        column("face_width", [gear.face_width for gear in gears], "mm", "face width b"),
        diameter("reference_diameter", "pitch_radius", "reference diameter d"),
        diameter("base_diameter", "base_radius", "base diameter d_b"),
        diameter("tip_diameter", "tip_radius", "tip diameter d_a"),
        diameter("root_diameter", "root_radius", "root diameter d_f"),
        diameter("root_form_diameter", "form_radius", "root form diameter d_Ff"),
        diameter("tip_form_diameter", "involute_tip_radius", "tip form diameter d_Fa"),
    )


def _section_columns(gears: Sequence[Gear]) -> tuple[Column, ...]:
    """Module and pressure angle of the rack, and for helical gears what they become across the axis."""

    def column(name: str, attribute: str, unit: str, meaning: str) -> Column:
        return Column(name, np.array([getattr(gear, attribute) for gear in gears]), unit, meaning)

    if not _helical(gears):
        return (
            column("module", "module", "mm", "module m"),
            column("pressure_angle", "normal_pressure_angle", "deg", "pressure angle α"),
        )
    return (
        column("module", "module", "mm", "normal module m_n"),
        column("pressure_angle", "normal_pressure_angle", "deg", "normal pressure angle α_n"),
        column("helix_angle", "helix_angle", "deg", "helix angle β"),
        column("hand", "hand", "", "hand of the helix"),
        column("lead", "lead", "mm", "lead p_z"),
        column("transverse_module", "transverse_module", "mm", "transverse module m_t"),
        column("transverse_pressure_angle", "transverse_pressure_angle", "deg", "transverse pressure angle α_t"),
        column("base_helix_angle", "base_helix_angle", "deg", "base helix angle β_b"),
    )


def _mesh_columns(pair: GearPair) -> tuple[Column, ...]:
    profiles = [active_profile(pair, member) for member in MEMBERS]
    ends = pair.x_start, pair.x_end

    def diameter(name: str, attribute: str, meaning: str) -> Column:
        return Column(name, np.array([2.0 * getattr(one, attribute) for one in profiles]), "mm", meaning)

    sliding = [[float(specific_sliding(pair, x, member)) for x in ends] for member in MEMBERS]
    return (
        diameter("active_root_diameter", "start", "start of active profile d_Nf"),
        diameter("lpstc_diameter", "lowest_single", "lowest single contact (LPSTC)"),
        diameter("hpstc_diameter", "highest_single", "highest single contact (HPSTC)"),
        diameter("active_tip_diameter", "end", "end of active profile d_Na"),
        Column("tip_clearance", np.array([pair.tip_clearance(member) for member in MEMBERS]), "mm",
               "tip clearance c"),
        Column("specific_sliding_start", np.array([one[0] for one in sliding]), "", "specific sliding ζ at A"),
        Column("specific_sliding_end", np.array([one[1] for one in sliding]), "", "specific sliding ζ at E"),
    )  # fmt: skip


def _modified(drawing: Drawing, names: Sequence[str]) -> tuple[Column, ...]:
    return modification_columns([drawing.ground.get(name, {}) for name in names])


def pair_table(name: str, drawing: Drawing) -> Table:
    """Gear data of a pair: driver first, driven gear second."""
    pair, names = drawing.pairs[name], drawing.members[name]
    gears = [pair.gear(member) for member in MEMBERS]
    columns = (
        *_tooth_columns(names, gears), *_mesh_columns(pair), *measurement_columns(drawing, names),
        *_modified(drawing, names),
    )  # fmt: skip
    return Table(f"gear_data_{name}", columns, f"Gear data of pair {name}")


def lone_table(drawing: Drawing) -> Table | None:
    """Gear data of the gears that are in no pair, if any."""
    paired = {name for names in drawing.members.values() for name in names}
    names = [name for name in drawing.gears if name not in paired]
    if not names:
        return None
    columns = (
        *_tooth_columns(names, [drawing.gears[name] for name in names]),
        *measurement_columns(drawing, names),
        *_modified(drawing, names),
    )
    return Table("gear_data", columns, "Gear data")


def pair_values(name: str, pair: GearPair) -> tuple[Value, ...]:
    """The numbers of a pair as a whole."""
    helical = pair.driver.helix_angle != 0.0
    backlash = "" if helical else "backlash along the line of action"
    more = ("overlap_ratio", "total_contact_ratio", "working_helix_angle", "circumferential_backlash")
    return (
        *(value_of(pair, attribute, name, 0.0) for attribute in _OF_PAIR),
        value_of(pair, "normal_backlash", name, 0.0, meaning=backlash),
        *(value_of(pair, attribute, name, 0.0) for attribute in more if helical),
        *_losses(name, pair),
    )


def _losses(name: str, pair: GearPair) -> tuple[Value, ...]:
    """What teeth without deflection lose; nothing where at times none of them is in contact."""
    from fegear.formulas.friction import wimmer

    if pair.contact_ratio < 1.0 or pair.internal:
        return ()
    return (Value(f"{name}.rigid_loss_factor", wimmer(pair), "", 0.0, "tooth loss factor H_V of rigid gears"),)


#: Amounts that a drawing states, in its order, with their symbols of ISO 21771.
MEANINGS = {
    "tip_relief": "tip relief C_αa",
    "root_relief": "root relief C_αf",
    "profile_crowning": "profile crowning C_α",
    "crowning": "crowning of the lead C_β",
    "helix_slope": "helix slope modification C_Hβ",
    "end_relief_I": "end relief at end I",
    "end_relief_II": "end relief at end II",
    "bias": "twist S_α",
}


def ground_off(part: GearPart) -> dict[str, float]:
    """Amounts that a case gives for a gear [m], by `MEANINGS`; tables, files and amounts in Delta have none."""
    found: dict[str, float] = {}

    def add(key: str, amount: float | None) -> None:
        if amount:
            found[key] = found.get(key, 0.0) + amount

    if part.relief is not None:
        for key, ends in (("tip_relief", part.relief.tip), ("root_relief", part.relief.root)):
            for end in ends:
                add(key, end.amount)
        for crown in part.relief.crowning:
            add("profile_crowning", crown.amount)
    if part.lead is not None:
        add("crowning", part.lead.crowning)
        add("helix_slope", part.lead.slope)
        for relief in part.lead.end_relief:
            for side in ("I", "II"):
                if relief.end in (side, "both"):
                    add(f"end_relief_{side}", relief.amount)
    if part.bias is not None:
        add("bias", part.bias.amount)
    return found


def modification_columns(amounts: Sequence[Mapping[str, float]]) -> tuple[Column, ...]:
    """A column for every modification that some of the gears have."""
    return tuple(
        Column(key, np.array([one.get(key, 0.0) for one in amounts]), "um", meaning)
        for key, meaning in MEANINGS.items()
        if any(key in one for one in amounts)
    )


GEOMETRY = Stage(
    subjects=_everything,
    inputs=lambda scene, _subject: drawing_of(scene),
    compute=lambda drawing, _upstream, _work: drawing,
    present=_present,
    cites=citing(INVOLUTE, Citation("iso-53", "standard basic racks", "Table 1")),
    forecast=lambda _scene, _subject: Forecast({}, 0.01),
    internal=True,
)
