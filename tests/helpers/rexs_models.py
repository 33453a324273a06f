"""REXS models for tests, written from the standard's attributes."""

from __future__ import annotations

import json
import math


def part(number, kind, name="", **attributes):
    """A component; values with a unit as (value, unit)."""
    listed = [{"id": key, "unit": one[1], "float": one[0]} if isinstance(one, tuple) else {"id": key, "value": one}
              for key, one in attributes.items()]  # fmt: skip
    return {"id": number, "type": kind, "name": name, "attributes": listed}


def link(number, kind, **refs):
    return {"id": number, "type": kind, "refs": [{"role": role, "id": one} for role, one in refs.items()]}


def gear(number, teeth, helix, face=20.0, module=2.0, at=50.0, **more):
    return part(
        number, "cylindrical_gear", f"gear {number}", number_of_teeth=(teeth, "none"), normal_module=(module, "mm"),
        helix_angle_reference_diameter=(helix, "deg"), face_width=(face, "mm"), u_coordinate_on_shaft=(at, "mm"),
        addendum_modification_coefficient=(0.0, "none"), **more,
    )  # fmt: skip


def shaft(number, v, w, **more):
    place = {"support_vector": ([0.0, v, w], "mm"), "u_axis_vector": ([1.0, 0.0, 0.0], "mm")}
    return part(number, "shaft", f"shaft {number}", **place, **more)


def two_stages(**changed):
    """20/60 and 21/63 teeth on three shafts in one plane; 100 N m and 1500 rpm on the first."""
    helix = 10.0
    first = 0.5 * 80 * 2.0 / math.cos(math.radians(helix))
    second = 0.5 * 84 * 2.0
    components = [
        part(1, "gear_unit", "Two stages"),
        part(2, "gear_casing"),
        shaft(3, 0.0, 0.0, rotational_speed=(1500.0, "1/min"), defines_speed="true"),
        shaft(4, first, 0.0),
        shaft(5, first + second, 0.0),
        gear(11, 20, helix), gear(12, 60, -helix), gear(13, 21, 0.0, at=90.0), gear(14, 63, 0.0, at=90.0),
        part(21, "cylindrical_stage", "one", center_distance=(first, "mm")),
        part(22, "cylindrical_stage", "two", center_distance=(second, "mm")),
        part(31, "external_load", "in", torque_around_u_axis=(100.0, "N m"), u_coordinate_on_shaft=(0.0, "mm"),
             transmits_torque="true", defines_torque="true"),
        part(32, "external_load", "out", u_coordinate_on_shaft=(120.0, "mm"), transmits_torque="true"),
    ]  # fmt: skip
    relations = [
        link(101, "stage", stage=21, gear_1=11, gear_2=12), link(102, "stage", stage=22, gear_1=13, gear_2=14),
        *(link(110 + n, "assembly", assembly=s, part=g) for n, (s, g) in enumerate(
            ((3, 11), (4, 12), (4, 13), (5, 14), (3, 31), (5, 32)))),
    ]  # fmt: skip
    for n, (one, size) in enumerate(((3, 25.0), (4, 30.0), (5, 40.0))):
        section = part(41 + n, "shaft_section", length=(120.0, "mm"), outer_diameter_begin=(size, "mm"))
        components.append(section)
        relations.append(link(130 + n, "ordered_assembly", assembly=one, part=41 + n))
        for m, at in enumerate((10.0, 110.0)):
            number = 51 + 2 * n + m
            components.append(
                part(number, "concept_bearing", f"bearing {number}", u_coordinate_on_shaft_inner_side=(at, "mm"),
                     radial_stiffness=(4e5, "N/mm"), axial_stiffness=(1e5, "N/mm"))
            )  # fmt: skip
            relations.append(link(140 + number, "side", assembly=number, inner_part=one, outer_part=2))
    tree = {"version": "1.4", "applicationId": "test", "components": components, "relations": relations}
    return {**tree, **changed}


def in_json(tree):
    return json.dumps({"model": tree})


def planetary_set(helix=0.0, angles=(0.0, 120.0, 240.0)):
    """18/24/66 teeth, planets at angles [deg], the ring held by the casing; 90 N m and 1000 rpm on the sun."""
    distance = 0.5 * 42 * 2.0 / math.cos(math.radians(helix))
    components = [
        part(1, "gear_unit", "A set"), part(2, "gear_casing"), part(9, "planetary_stage"), part(10, "planet_carrier"),
        shaft(3, 0.0, 0.0, rotational_speed=(1000.0, "1/min"), defines_speed="true"), shaft(4, 0.0, 0.0),
        shaft(5, 0.0, 0.0), gear(11, 18, helix), part(7, "coupling", "held", is_engaged="true"),
        {**gear(15, 66, -helix), "type": "ring_gear"},
        part(31, "external_load", torque_around_u_axis=(90.0, "N m"), u_coordinate_on_shaft=(0.0, "mm"),
             defines_torque="true"),
        part(32, "external_load", u_coordinate_on_shaft=(0.0, "mm"), transmits_torque="true"),
    ]  # fmt: skip
    pairs = [(9, 10), (3, 11), (4, 15), (3, 31), (5, 32), (10, 5)]
    stages = []
    for n, angle in enumerate(map(math.radians, angles)):
        place = distance * math.cos(angle), distance * math.sin(angle)
        components += [
            gear(120 + n, 24, -helix), shaft(41 + n, *place), shaft(51 + n, *place),
            part(61 + n, "concept_bearing", f"pin {n}"),
            part(21 + n, "cylindrical_stage", center_distance=(distance, "mm")),
            part(24 + n, "cylindrical_stage", center_distance=(distance, "mm")),
        ]  # fmt: skip
        pairs += [(41 + n, 120 + n), (10, 51 + n), (9, 21 + n), (9, 24 + n)]
        stages += [
            link(200 + n, "stage", stage=21 + n, gear_1=11, gear_2=120 + n),
            link(210 + n, "stage", stage=24 + n, gear_1=120 + n, gear_2=15),
            link(220 + n, "side", assembly=61 + n, outer_part=41 + n, inner_part=51 + n),
        ]  # fmt: skip
    links = [link(300 + n, "assembly", assembly=one, part=other) for n, (one, other) in enumerate(pairs)]
    held = link(230, "side", assembly=7, inner_part=4, outer_part=2)
    return {"version": "1.4", "components": components, "relations": [*stages, *links, held]}


def ring_stage():
    """A pinion in a ring, 20/60 teeth of module 2 mm; 50 N m and 1000 rpm on the pinion, both on shafts in bearings."""
    components = [
        part(1, "gear_unit", "A ring"), part(2, "gear_casing"),
        shaft(3, 0.0, 0.0, rotational_speed=(1000.0, "1/min"), defines_speed="true"), shaft(4, 40.0, 0.0),
        gear(11, 20, 0.0), {**gear(12, 60, 0.0), "type": "ring_gear"},
        part(21, "cylindrical_stage", center_distance=(-40.0, "mm")),
        part(31, "external_load", torque_around_u_axis=(50.0, "N m"), u_coordinate_on_shaft=(0.0, "mm"),
             transmits_torque="true", defines_torque="true"),
        part(32, "external_load", u_coordinate_on_shaft=(100.0, "mm"), transmits_torque="true"),
    ]  # fmt: skip
    links = [link(101, "stage", stage=21, gear_1=11, gear_2=12)]
    links += [link(110 + n, "assembly", assembly=s, part=g) for n, (s, g) in enumerate(
        ((3, 11), (4, 12), (3, 31), (4, 32)))]  # fmt: skip
    for n, (one, size) in enumerate(((3, 25.0), (4, 30.0))):
        components.append(part(41 + n, "shaft_section", length=(100.0, "mm"), outer_diameter_begin=(size, "mm")))
        links.append(link(130 + n, "ordered_assembly", assembly=one, part=41 + n))
        for m, at in enumerate((10.0, 90.0)):
            number = 51 + 2 * n + m
            components.append(
                part(number, "concept_bearing", f"bearing {number}", u_coordinate_on_shaft_inner_side=(at, "mm"),
                     radial_stiffness=(4e5, "N/mm"), axial_stiffness=(1e5, "N/mm"))
            )  # fmt: skip
            links.append(link(140 + number, "side", assembly=number, inner_part=one, outer_part=2))
    return {"version": "1.4", "applicationId": "test", "components": components, "relations": links}
