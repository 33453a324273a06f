"""Shafts and bearings of a case as components of REXS, counted from the left end of each shaft."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.exchange.rexs.written_gears import left_out, write_elasticity

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.reading import Scene
    from fegear.case.shaft import BearingPart, BearingPlacePart, ShaftInSpacePart
    from fegear.exchange.rexs.written import Columns, Part, Written

#: Keys that are written.
_BEARING = frozenset({"radial", "axial", "tilting", "fixed", "radial_clearance", "elements", "life",
                      "designation", "catalogue"})  # fmt: skip
_SHAFT = frozenset({"axis", "start", "sections", "material", "rigid", "gears", "bearings", "coupling", "loads",
                    "clockwise", "yield_strength"})  # fmt: skip
#: Stiffness of a body that does not bend [Pa]: the import takes it for rigid.
_RIGID = 1e16
#: Every shaft lies along u; where v begins does not matter.
_ALONG = (1e-3, 0.0, 0.0)


#: Types of bearings, by what rolls and whether under a contact angle.
_TYPES = {
    ("ball", False): "radial_grooved_ball_bearing",
    ("ball", True): "angular_contact_ball_bearing",
    ("roller", False): "radial_roller_bearing",
    ("roller", True): "radial_tapered_roller_bearing",
}
_SPHERICAL = "radial_spherical_roller_bearing"


def write_shaft(
    written: Written, scene: Scene, name: str, holders: Mapping[str | None, Part], gears: Mapping[str, Part]
) -> Part:
    """A shaft of a case with its sections, gears, bearings and forces.

    Parameters
    ----------
    written : Written
    scene : Scene
    name : str
    holders : mapping
        What holds the outer rings: the casing (None), and all shafts by name.
    gears : mapping
        Components of the gears by name.
    """
    part = scene.case.shaft[name]
    left_out(written, f"Shaft {name}", part, _SHAFT)
    made = place(holders[name], (part.start, part.axis[0], part.axis[1]))
    begin = 0.0
    for one in part.sections:
        section = written.part("shaft_section").say(
            "length", length=one.length, outer_diameter_begin=one.outer, inner_diameter_begin=one.inner or None,
            outer_diameter_end=one.outer_end, inner_diameter_end=one.inner_end, u_coordinate_on_shaft=begin,
        )  # fmt: skip
        begin += one.length
        written.relate("assembly", assembly=made, part=section)
    material = written.part("material", f"{name}, material")
    if part.rigid:
        material.say("stress", elastic_modulus=_RIGID)
    else:
        write_elasticity(material, part.material)
    yields = "yield_strength" in part.model_fields_set
    material.say("stress", yield_strength=part.yield_strength if yields else None)
    if part.rigid or yields or part.material.model_fields_set:
        written.relate("reference", origin=made, referenced=material)
    else:
        written.parts.remove(material)
    for there in part.gears:
        left_out(written, f"Gear {there.gear} on shaft {name}", there, {"gear", "at"})
        gears[there.gear].say("length", u_coordinate_on_shaft=there.at)
        written.relate("assembly", assembly=made, part=gears[there.gear])
    for seat in part.bearings:
        start = part.start if seat.around is None else scene.case.shaft[seat.around].start
        outer = seat.at + part.start - start
        _bearing(written, scene.case.bearing[seat.bearing], seat, (made, holders[seat.around]), outer)
    _loads(written, name, part, made)
    return made


def place(made: Part, at: tuple[float, float, float] = (0.0, 0.0, 0.0)) -> Part:
    """Say where a shaft stands: u, v and w [m]."""
    return made.say("length", support_vector=at, u_axis_vector=_ALONG, w_axis_vector=(0.0, 0.0, 1e-3))


def _bearing(
    written: Written, part: BearingPart, seat: BearingPlacePart, sides: tuple[Part, Part], outer_at: float
) -> None:
    """A bearing on its seat: what rolls in it, or its stiffness."""
    left_out(written, f"Bearing {seat.bearing}", part, _BEARING)
    elements, life = part.elements, part.life
    detailed = "rolling_bearing_with_detailed_geometry"
    rolling = detailed if elements else "rolling_bearing_with_catalog_geometry"
    printed = part.printed
    plain = elements is None and printed is None and life is None and not part.radial_clearance
    made = written.part("concept_bearing" if plain else rolling, seat.bearing)
    made.say("length", u_coordinate_on_shaft_inner_side=seat.at, u_coordinate_on_shaft_outer_side=outer_at)
    made.word(axial_force_absorption=_holds(part, reversed_=seat.reversed), radial_force_absorption=part.radial != 0.0)
    made.say("stiffness", radial_stiffness=part.radial, axial_stiffness=part.axial)
    made.say("tilting stiffness", bending_stiffness=part.tilting if "tilting" in part.model_fields_set else None)
    if part.radial_clearance:
        made.say("small length", operating_radial_bearing_clearance=2.0 * part.radial_clearance)
    rating = part.rating
    kind = elements.kind if elements else rating.kind if rating else None
    angle = elements.contact_angle if elements else 0.0
    if printed is not None:
        kind, angle = printed.inside.kind, printed.given_angle
        made.say("length", inner_diameter=printed.bore, outer_diameter=printed.outside_diameter, width=printed.width)
        made.say("small length", operating_radial_bearing_clearance=printed.clearance or None)
        made.say("large force", radial_static_load_rating=printed.static_rating)
        made.word(catalogue_designation=part.designation)
        if life is None or "dynamic_rating" not in life.given:
            made.say("large force", radial_dynamic_load_rating=printed.dynamic_rating)
        row = written.part("rolling_bearing_row").say("angle", pressure_angle=abs(angle))
        written.relate("ordered_assembly", 1, assembly=made, part=row)
    made.word(bearing_type=_SPHERICAL if printed and printed.inside.aligning else _TYPES.get((kind or "", bool(angle))))
    if life is not None:
        if "dynamic_rating" in life.given:
            made.say("large force", radial_dynamic_load_rating=life.dynamic_rating)
        if rating is not None and (life.axial_factor or life.limit):
            made.say(
                "number", radial_factor_x_2=rating.radial_factor, axial_factor_y_2=rating.axial_factor,
                catalogue_value_e=rating.limit,
            )  # fmt: skip
    if elements is not None:
        made.say("small length", operating_radial_bearing_clearance=elements.clearance or None)
        row, roller = written.part("rolling_bearing_row"), written.part("rolling_element")
        ball = elements.kind == "ball"
        inner, outer = (ratio * elements.diameter for ratio in elements.groove_ratio)
        row.say("number", number_of_rolling_elements=float(elements.count))
        row.say("angle", pressure_angle=abs(elements.contact_angle))
        row.say(
            "length", reference_diameter=elements.pitch_diameter, raceway_radius_of_inner_ring=inner if ball else None,
            raceway_radius_of_outer_ring=outer if ball else None,
        )  # fmt: skip
        roller.say(
            "length", diameter_of_rolling_element=elements.diameter, length_of_rolling_element=elements.roller_length
        )
        written.relate("ordered_assembly", 1, assembly=made, part=row)
        written.relate("ordered_assembly", 1, assembly=row, part=roller)
    written.relate("side", assembly=made, inner_part=sides[0], outer_part=sides[1])


def _holds(part: BearingPart, *, reversed_: bool) -> str:
    """Which way a bearing holds its shaft along the axis."""
    printed, elements = part.printed, part.elements
    rolls = printed is not None or elements is not None
    angle = printed.given_angle if printed else elements.contact_angle if elements else 0.0
    balls = (printed.kind if printed else elements.kind if elements else "") == "ball"
    if part.housing_axial is not None and rolls:
        return "no_direction"  # it slides in its seat, or nearly
    if printed is not None and printed.inside.aligning:
        return "both_directions"
    if angle:
        return "negative" if reversed_ != (angle < 0.0) else "positive"
    along = part.fixed or bool(part.axial) or balls or part.ribs is not None
    return "both_directions" if along else "no_direction"


def _loads(written: Written, name: str, part: ShaftInSpacePart, shaft: Part) -> None:
    for n, one in enumerate(part.loads):
        force, moment = one.force or [0.0] * 3, one.moment or [0.0] * 3
        if moment[2]:
            written.remarks.append(f"Shaft {name}, loads.{n}: moment about the axis not written to REXS.")
        made = written.part("external_load", f"{name}, load {n + 1}").say("length", u_coordinate_on_shaft=one.at)
        made.say("force", force_u_direction=force[2], force_v_direction=force[0], force_w_direction=force[1])
        made.say("torque", torque_around_v_axis=moment[0], torque_around_w_axis=moment[1])
        written.relate("assembly", assembly=shaft, part=made)


def write_shaft_results(written: Written, shafts: Mapping[str, Part], tables: Mapping[str, Columns]) -> None:
    """Bent shafts and the forces in their bearings, of the tables of a run."""
    for name, shaft in shafts.items():
        if (columns := tables.get(f"shaft_deflection_{name}")) is not None:
            shaft.say("length", u_coordinates_of_beam_nodes=list(columns["z"]))
            shaft.say(
                "small length", displacement_u_of_nodes=list(columns["along"]),
                displacement_v_of_nodes=list(columns["x"]), displacement_w_of_nodes=list(columns["y"]),
            )  # fmt: skip
            shaft.say("angle", torsion_u=list(columns["twist"]))
    if (columns := tables.get("bearing_forces")) is None:
        return
    seats = {
        (dict(roles)["inner_part"].name, dict(roles)["assembly"].name): dict(roles)["assembly"]
        for kind, _, roles in written.relations
        if kind == "side" and "inner_part" in dict(roles)
    }
    wanted = ("shaft", "bearing", "force_axial", "force_x", "force_y")
    if not all(key in columns for key in wanted):  # a table that was changed since
        return
    rows = zip(*(columns[key] for key in wanted), strict=True)
    for shaft_name, bearing, along, x, y in rows:
        if (seat := seats.get((str(shaft_name), str(bearing)))) is not None:
            seat.say(
                "force", force_acting_on_inner_component_u=float(along), force_acting_on_inner_component_v=float(x),
                force_acting_on_inner_component_w=float(y),
            )  # fmt: skip
