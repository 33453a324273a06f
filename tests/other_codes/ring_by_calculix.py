"""A planet in its ring gear: frictionless contact of both whole gears in CalculiX.

Nothing of fegear's solution is used but the approach that is tried: CalculiX' quadratic elements on explicit meshes of
all teeth, its own contact (surface to surface, penalty) and its own solver. One layer of solid elements, held along the
axis, is plane strain. The ring is held at its outside, the planet's bore is turned by the approach. The planet's centre
is the origin, the pitch point lies above it, the ring's centre below.
"""

import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np

from fegear.case.reading import read_scene
from fegear.fem.plane.boundary import sector_boundary
from fegear.fem.plane.gear_section import gear_section
from fegear.fem.plane.root_stress import extreme
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.tooth_meshing import mesh_inside
from fegear.fem.solid.extruded import extruded

sys.path.insert(0, str(Path(__file__).parent))
from pair_by_calculix import _element_cards, read_steps, side_faces

MM = 1e3
CASE = Path(__file__).parents[2] / "cases" / "planet_and_ring.toml"
#: Load per millimetre of face [N/mm], and roll positions as shares of a base pitch after the start of the path.
LINE_LOAD = 290.0
POSITIONS = {"two pairs": 0.25, "one pair and a tip corner": 0.97}
PENALTY = 1e9  # MPa/mm
THICKNESS = 1.0  # of the layer [mm]
#: Half-width of what the meshes resolve about each contact [modules], half the Hertzian one.
HALF_WIDTH = 0.035
_FINE = MeshSettings(
    root_edge_length=0.05, root_fraction=0.2, flank_edge_length=0.15, tip_edge_length=0.05, junction_edge_length=0.05,
    back_edge_length=0.4, growth=0.35, tip_growth=0.35, side_growth=0.45, body_fraction=1.0, rim_fraction=0.35, order=2,
)  # fmt: skip
_AT_CORNER = MeshSettings(
    root_edge_length=0.05, root_fraction=0.2, flank_edge_length=0.15, tip_edge_length=0.002, junction_edge_length=0.05,
    back_edge_length=0.4, growth=0.35, tip_growth=0.25, side_growth=0.45, body_fraction=1.0, rim_fraction=0.35, order=2,
)  # fmt: skip
_COARSE = MeshSettings(
    root_edge_length=0.6, root_fraction=2.0, flank_edge_length=0.9, tip_edge_length=0.9, junction_edge_length=0.6,
    back_edge_length=0.9, growth=0.7, tip_growth=0.7, side_growth=0.8, body_fraction=1.5, rim_fraction=0.6, order=2,
)  # fmt: skip


#: Of the sides and the bore of all teeth, which loaded teeth share.
_SIDES = replace(_COARSE, root_edge_length=0.25, side_growth=0.5, body_fraction=1.0, rim_fraction=0.4)


def the_pair():
    """That of the case."""
    return read_scene(CASE).pairs["I"]


def contacts_at(pair, share):
    """Roll position [m] and, by pair number, places on both flanks: radius [m] and whether a tip corner is there."""
    from fegear.contact.plane.meshing import Meshing

    x0 = pair.x_start + share * pair.base_pitch
    found = Meshing(pair, corner_contact=True).contacts([x0])
    radii = {"driver": found.radius_driver[:, 0], "driven": found.radius_driven[:, 0]}
    near = found.gap[:, 0] < 20e-6
    return x0, {
        int(j): {
            member: (float(radii[member][i]), bool(abs(radii[member][i] - pair.gear(member).tip_radius) < 1e-9))
            for member in radii
        }
        for i, j in enumerate(found.number)
        if near[i]
    }


def clockwise(angle, points):
    """Points turned clockwise about the origin."""
    c, s = math.cos(angle), math.sin(angle)
    return np.vstack([c * points[0] + s * points[1], c * points[1] - s * points[0], points[2:]])


def body(pair, member, share):
    """Solid mesh of a gear in its place [mm], the numbers of its teeth in contact by pair, and its centre."""
    gear, (x0, touched) = pair.gear(member), contacts_at(pair, share)
    tooth, bore = gear.tooth, gear.bore_radius / gear.module
    forward = 1 if member == "driver" else -1
    shared = {c.name: c for c in sector_boundary(tooth, bore, _SIDES) if c.name in ("bore", "side_a", "side_b")}
    plain = mesh_inside([shared.get(c.name, c) for c in sector_boundary(tooth, bore, _COARSE)], tooth.teeth)
    start = 0.5 * tooth.base_radius * float(tooth.roll(tooth.form_radius)) ** 2
    sectors, teeth = {}, {}
    for j, places in touched.items():
        radius, at_tip = places[member]
        arc = tooth.side * (0.5 * tooth.base_radius * float(tooth.roll(radius / gear.module)) ** 2 - start)
        settings = _AT_CORNER if at_tip else _FINE
        half = HALF_WIDTH if not any(one[1] for one in places.values()) else 0.015
        chains = sector_boundary(tooth, bore, settings, [] if at_tip else [(arc, half)])
        teeth[j] = forward * j
        sectors[teeth[j]] = mesh_inside([shared.get(c.name, c) for c in chains], tooth.teeth, growth=0.45)
    first = -((tooth.teeth - 1) // 2)
    section = gear_section({k: sectors.get(k, plain) for k in range(first, first + tooth.teeth)})
    half_layer = 0.5 * THICKNESS / (gear.module * MM)
    mesh = extruded(section, np.array([-half_layer, half_layer]), 0.0)
    points = mesh.points * gear.module * MM
    working = gear.base_radius / math.cos(pair.working_pressure_angle)
    half_angle = float(tooth.flank_angle(working / gear.module))
    # The loaded flanks touch at the pitch point when both are turned back by half a tooth; then both roll by x.
    points = clockwise(forward * x0 / gear.base_radius - half_angle, points)
    centre = np.zeros(3)
    if member == "driven":
        # half a turn about the centre line inside a ring, about the axis outside another gear
        points = points * np.array([[-1.0], [-pair.side], [pair.side]])
        centre[1] = pair.side * pair.centre_distance * MM
        points[1] += centre[1]
    return {"member": member, "gear": gear, "mesh": mesh, "points": points, "teeth": teeth, "centre": centre}


def write_deck(path, pair, bodies, approach):
    """One step: the planet's bore turned by an approach along the line of action [m]; first node of each gear."""
    nodes, elements, sets, faces, first = ["*NODE, NSET=NALL"], [], [], [], {}
    offset = before = 0
    held = []
    for one in bodies:
        mesh, name = one["mesh"], one["member"].upper()
        first[one["member"]] = offset
        nodes += [f"{offset + i}, {x:.12e}, {y:.12e}, {z:.12e}" for i, (x, y, z) in enumerate(one["points"].T, 1)]
        elements += _element_cards("C3D15", mesh.wedges + 1 + offset, before + 1)
        elements += _element_cards("C3D20", mesh.hexahedra + 1 + offset, before + mesh.wedges.shape[1] + 1)
        for j, k in one["teeth"].items():
            element, face = side_faces(mesh, mesh.section.boundaries["flank", k])
            faces += [f"*SURFACE, NAME={name}_P{j + 5}, TYPE=ELEMENT"]
            faces += [f"{before + e + 1}, S{f}" for e, f in zip(element.ravel(), face.ravel(), strict=True)]
        bore = mesh.nodes_of(mesh.section.edges("bore"))
        sets += [f"*NSET, NSET={name}_BORE", *(f"{n + 1 + offset}," for n in bore)]
        fillets = np.unique(np.concatenate([
            mesh.nodes_of(mesh.section.boundaries[side, k]) for side in ("fillet", "back_fillet")
            for k in one["teeth"].values()
        ]))  # fmt: skip
        sets += [f"*NSET, NSET={name}_FILLET", *(f"{n + 1 + offset}," for n in fillets)]
        if one["member"] == "driven":
            held += ["DRIVEN_BORE, 1, 2"]
        else:
            arm = one["points"][:2, bore] - one["centre"][:2, None]
            turn = approach / pair.driver.base_radius
            for node, x, y in zip(bore, turn * arm[1], -turn * arm[0], strict=True):
                held += [f"{node + 1 + offset}, 1, 1, {x:.12e}", f"{node + 1 + offset}, 2, 2, {y:.12e}"]
        offset += one["points"].shape[1]
        before += mesh.wedges.shape[1] + mesh.hexahedra.shape[1]
    couples = [(f"DRIVEN_P{j + 5}", f"DRIVER_P{j + 5}") for j in bodies[0]["teeth"]]
    material = pair.driver.material
    law = [
        "*MATERIAL, NAME=STEEL", "*ELASTIC", f"{material.young_modulus * 1e-6}, {material.poisson_ratio}",
        "*SOLID SECTION, ELSET=EALL, MATERIAL=STEEL",
        "*SURFACE INTERACTION, NAME=I", "*SURFACE BEHAVIOR, PRESSURE-OVERCLOSURE=LINEAR", f"{PENALTY:g}",
    ]  # fmt: skip
    for couple in couples:
        law += ["*CONTACT PAIR, INTERACTION=I, TYPE=SURFACE TO SURFACE", ", ".join(couple)]
    law += ["*STEP, INC=100", "*STATIC", "1., 1.", "*BOUNDARY", "NALL, 3, 3", *held]
    for couple in couples:
        law += ["*CONTACT PRINT, SLAVE={}, MASTER={}".format(*couple), "CF"]
    for one in bodies:
        name = one["member"].upper()
        law += [f"*NODE PRINT, NSET={name}_FILLET", "U", f"*NODE PRINT, NSET={name}_BORE", "RF"]
    law += ["*END STEP"]
    path.write_text("\n".join([*nodes, *elements, *sets, *faces, *law]) + "\n", encoding="ascii")
    return first


def told(pair, bodies, first, path):
    """Line load of each pair, and of both bores by their torques [N/mm]."""
    (step,) = read_steps(path)
    result = {"loads": {}}
    for name, (moment, _) in step["moment"].items():
        load = abs(moment) / (pair.driver.base_radius * MM) / THICKNESS
        result["loads"][str(int(name.split("_P")[1]) - 5)] = round(load, 4)
    for one in bodies:
        name, start = one["member"], first[one["member"]]
        rows = step["nodes"][f"{name}_bore".upper()]
        arm = one["points"][:2, np.array(list(rows)) - 1 - start] - one["centre"][:2, None]
        force = np.array(list(rows.values())).T
        torque = abs(float((arm[0] * force[1] - arm[1] * force[0]).sum()))
        result[f"load_by_{name}_bore"] = round(torque / (one["gear"].base_radius * MM) / THICKNESS, 4)
    result["root_tension"] = {
        f"{one['member']} {j}": round(_root_tension(one, k, step, first), 3)
        for one in bodies
        for j, k in one["teeth"].items()
    }
    return result


def _root_tension(one, tooth, step, first):
    """Largest tangential stress of the fillet below the loaded flank [MPa]: from the strain along its own edges."""
    rows = step["nodes"][f"{one['member']}_fillet".upper()]
    u = np.full((3, one["points"].shape[1]), np.nan)
    u[:, np.array(list(rows)) - 1 - first[one["member"]]] = np.array(list(rows.values())).T
    mesh, material = one["mesh"], one["gear"].material
    a, b, m = (mesh.at_station(nodes, 0) for nodes in mesh.section.boundaries["fillet", tooth])
    middle = one["points"][:2, m] - one["centre"][:2, None]
    order = np.argsort(one["gear"].tooth.side * np.hypot(*middle))
    arcs, strains, before = [], [], 0.0
    for e in order:  # from the root land up
        ends = np.array([a[e], b[e]])
        away = one["gear"].tooth.side * np.hypot(*(one["points"][:2, ends] - one["centre"][:2, None]))
        low, high = ends[np.argsort(away)]
        places = one["points"][:2][:, [low, high, m[e]]]
        moved = u[:2][:, [low, high, m[e]]]
        length = float(np.hypot(*(places[:, 1] - places[:, 0])))
        for s in (-1.0 / math.sqrt(3.0), 1.0 / math.sqrt(3.0)):  # where quadratic edges are most accurate
            slope = np.array([s - 0.5, s + 0.5, -2.0 * s])
            tangent, stretch = places @ slope, moved @ slope
            strains.append(float(tangent @ stretch / (tangent @ tangent)))
            arcs.append(before + 0.5 * (1.0 + s) * length)
        before += length
    modulus = material.young_modulus * 1e-6 / (1.0 - material.poisson_ratio**2)
    values = np.array(strains) * modulus
    value, _ = extreme(values[:, None], np.array(arcs), 1.0, before)
    return float(value[0])
