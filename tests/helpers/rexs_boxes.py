"""Random gearboxes of one to three stages as REXS models, and the same gearboxes written otherwise."""

from __future__ import annotations

import copy
import math
import random

import numpy as np
from rexs_models import gear, link, part, shaft
from scipy.optimize import brentq

#: Middles of the faces of three stages along the gearbox [mm].
_MIDDLES = (20.0, 65.0, 110.0)


def random_box(seed: int) -> dict:
    """Helical and spur stages, shafts round each other, cones, bearings that tilt, loads from outside."""
    rng = random.Random(seed)  # noqa: S311
    stages = 1 + seed % 3
    where, before = np.array([0.0, 0.0, 0.0]), None
    parts, links = [part(1, "gear_unit", "box"), part(2, "gear_casing")], []
    speed = rng.choice([-1.0, 1.0]) * rng.uniform(500.0, 2500.0)
    for n in range(stages + 1):
        number = 10 + n
        where[0] = rng.uniform(-30.0, 30.0)
        given = {"rotational_speed": (speed, "1/min"), "defines_speed": "true"} if n == 0 else {}
        parts.append(_put(shaft(number, 0.0, 0.0, w_axis_vector=([0.0, 0.0, 1.0], "mm"), **given),
                          support_vector=where.tolist()))  # fmt: skip
        if before is not None:
            parts.append(_put(before, u_coordinate_on_shaft=before["middle"] - where[0]))
            links.append(link(220 + n, "assembly", assembly=number, part=before["id"]))
        if n < stages:
            first, before, distance = _pair(rng, n, stages, where[0])
            parts += [first, part(60 + n, "cylindrical_stage", center_distance=(distance, "mm"))]
            links += [link(200 + n, "assembly", assembly=number, part=first["id"]),
                      link(240 + n, "stage", stage=60 + n, gear_1=first["id"], gear_2=before["id"])]  # fmt: skip
        made = _on_shaft(rng, n, where[0])
        parts, links = parts + made[0], links + made[1]
        if n in (0, stages):
            torque = math.copysign(rng.uniform(80.0, 200.0), speed) if n == 0 else None
            load = _load(rng, 700 + n, (-50.0 if n == 0 else 170.0) - where[0], torque)
            parts.append(load)
            links.append(link(800 + n, "assembly", assembly=number, part=load["id"]))
        if n < stages:
            turn = rng.uniform(0.0, 2.0 * math.pi)
            where = where + distance * np.array([0.0, math.cos(turn), math.sin(turn)])
    return {"version": "1.4", "applicationId": "test", "components": parts, "relations": links}


def _pair(rng: random.Random, n: int, stages: int, start: float) -> tuple[dict, dict, float]:
    """Both gears of a stage, the second with its middle along the gearbox, and their centre distance [mm]."""
    teeth, shifts = (rng.randint(18, 28), rng.randint(40, 70)), (rng.uniform(0.0, 0.4), rng.uniform(-0.1, 0.3))
    module, helix = 2.0 * 1.25**n, rng.choice([0.0, rng.uniform(5.0, 20.0), -rng.uniform(5.0, 20.0)])
    cosine = math.cos(math.radians(helix))
    alpha = math.atan(math.tan(math.radians(20.0)) / cosine)
    wanted = math.tan(alpha) - alpha + 2.0 * sum(shifts) * math.tan(math.radians(20.0)) / sum(teeth)
    working = brentq(lambda a: math.tan(a) - a - wanted, 0.1, 1.0, xtol=1e-15)
    distance = 0.5 * sum(teeth) * module / cosine * math.cos(alpha) / math.cos(working)
    face, middle = rng.uniform(8.0, 11.0) * module, _MIDDLES[(n + stages) % 3] + rng.uniform(-4.0, 4.0)
    one, two = (
        _put(gear(30 + 2 * n + m, teeth[m], helix * (-1.0) ** m, face, module, at=middle - start),
             addendum_modification_coefficient=shifts[m])
        for m in (0, 1)
    )  # fmt: skip
    return one, {**two, "middle": middle}, distance


def _on_shaft(rng: random.Random, n: int, start: float) -> tuple[list[dict], list[dict]]:
    """Three conical sections and two bearings."""
    parts, links, at, step = [], [], -60.0 - start, rng.uniform(40.0, 80.0)
    for m, length in enumerate((step + 60.0, 60.0, 130.0 - step)):
        size = rng.uniform(25.0, 40.0) * 1.15**n
        number = 300 + 10 * n + m
        parts.append(part(number, "shaft_section", length=(length, "mm"), u_coordinate_on_shaft=(at, "mm"),
                          outer_diameter_begin=(size, "mm"), outer_diameter_end=(size * rng.uniform(0.9, 1.1), "mm"))
                     )  # fmt: skip
        links.append(link(100 + number, "ordered_assembly", assembly=10 + n, part=number))
        at += length
    for m, place in enumerate((rng.uniform(-30.0, 0.0), rng.uniform(120.0, 160.0))):
        number = 500 + 2 * n + m
        parts.append(
            part(number, "concept_bearing", f"bearing {number}", u_coordinate_on_shaft_inner_side=(place - start, "mm"),
                 radial_stiffness=(rng.uniform(2e5, 6e5), "N/mm"), axial_stiffness=(rng.uniform(1e5, 2e5), "N/mm"),
                 bending_stiffness=(rng.uniform(0.0, 1e8), "N mm/rad"),
                 axial_force_absorption=("both_directions", "no_direction")[m])
        )  # fmt: skip
        links.append(link(100 + number, "side", assembly=number, inner_part=10 + n, outer_part=2))
    return parts, links


def _load(rng: random.Random, number: int, at: float, torque: float | None) -> dict:
    forces = {f"force_{axis}_direction": (rng.uniform(-900.0, 900.0), "N") for axis in "uvw"}
    moments = {f"torque_around_{axis}_axis": (rng.uniform(-20.0, 20.0), "N m") for axis in "vw"}
    own = {} if torque is None else {"torque_around_u_axis": (torque, "N m"), "defines_torque": "true"}
    return part(number, "external_load", u_coordinate_on_shaft=(at, "mm"), transmits_torque="true", **forces, **moments,
                **own)  # fmt: skip


def _put(one: dict, **values: object) -> dict:
    changed = [{**a, "float": values[a["id"]]} if a["id"] in values else a for a in one["attributes"]]
    return {**one, "attributes": changed}


def _turned(tree: dict, matrix: np.ndarray, shift: np.ndarray) -> dict:
    parts = []
    for one in tree["components"]:
        new = {a["id"]: (matrix @ a["float"] + shift * (a["id"] == "support_vector")).tolist()
               for a in one["attributes"] if a["id"].endswith("_vector")}  # fmt: skip
        parts.append(_put(one, **new))
    return {**tree, "components": parts}


def rotated(tree: dict, seed: int) -> dict:
    """The gearbox turned and moved in space."""
    rng = np.random.default_rng(seed)
    matrix, _ = np.linalg.qr(rng.normal(size=(3, 3)))
    return _turned(tree, matrix * np.linalg.det(matrix), rng.uniform(-500.0, 500.0, 3))


def mirrored(tree: dict) -> dict:
    """The gearbox in a mirror across v: along its own axes v of forces and u and w of moments turn, and all hands."""
    turn = {"helix_angle_reference_diameter", "rotational_speed", "force_v_direction", "torque_around_u_axis",
            "torque_around_w_axis"}  # fmt: skip
    made = _turned(tree, np.diag([1.0, -1.0, 1.0]), np.zeros(3))
    return {**made, "components": [_signs(one, turn) for one in made["components"]]}


def _signs(one: dict, names: set[str]) -> dict:
    return _put(one, **{a["id"]: -a["float"] for a in one["attributes"] if a["id"] in names})


def from_the_other_end(tree: dict) -> dict:
    """The same gearbox, each shaft described from its other end: own u and v turn, w stays."""
    turn = {"rotational_speed", "u_coordinate_on_shaft", "u_coordinate_on_shaft_inner_side", "force_u_direction",
            "force_v_direction", "torque_around_u_axis", "torque_around_v_axis"}  # fmt: skip
    parts = []
    for one in tree["components"]:
        made = _signs(one, turn)
        given = {a["id"]: a["float"] for a in made["attributes"] if "float" in a}
        if one["type"] == "shaft":
            made = _put(made, u_axis_vector=[-1.0, 0.0, 0.0])
        if one["type"] == "shaft_section":
            made = _put(made, u_coordinate_on_shaft=given["u_coordinate_on_shaft"] - given["length"],
                        outer_diameter_begin=given["outer_diameter_end"],
                        outer_diameter_end=given["outer_diameter_begin"])  # fmt: skip
        parts.append(made)
    return {**tree, "components": parts}


def scaled(tree: dict, factor: float) -> dict:
    """All lengths longer, at the same stresses: forces with the square, torques with the cube."""
    powers = {"mm": 1, "N": 2, "N m": 3, "N/mm": 1, "N mm/rad": 3, "1/min": -1}
    parts = []
    for one in tree["components"]:
        new = {a["id"]: (np.array(a["float"]) * factor ** powers.get(a["unit"], 0)).tolist()
               for a in one["attributes"] if "float" in a}  # fmt: skip
        parts.append(_put(one, **new))
    return {**tree, "components": parts}


def in_another_order(tree: dict, seed: int) -> dict:
    """Components and relations shuffled, the gears of every stage exchanged."""
    made, rng = copy.deepcopy(tree), random.Random(seed)  # noqa: S311
    for one in made["relations"]:
        if one["type"] == "stage":
            first, second = one["refs"][1:]
            first["id"], second["id"] = second["id"], first["id"]
    rng.shuffle(made["components"])
    rng.shuffle(made["relations"])
    return made
