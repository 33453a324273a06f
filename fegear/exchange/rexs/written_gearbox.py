"""A case as a REXS model: gears, stages, planetary stages, shafts, bearings, loads, and what was computed of them."""

from __future__ import annotations

import math
from collections.abc import Mapping
from dataclasses import dataclass, field

from fegear.base.errors import InputError
from fegear.case.pair import PairPart
from fegear.case.planetary import MESHES, PlanetaryPart, angles_of, set_pair
from fegear.case.reading import Scene
from fegear.case.set_pairs import set_teeth
from fegear.exchange.rexs.operation import OILS
from fegear.exchange.rexs.written import Found, Part, Written
from fegear.exchange.rexs.written_gears import left_out, write_gear
from fegear.exchange.rexs.written_shafts import place, write_shaft, write_shaft_results
from fegear.shafts.gearbox import ROUNDED

#: Keys of tables that are written, or say how fegear computes.
_PAIR = frozenset(
    {
        "driver", "driven", "centre_distance", "load", "torque", "speed", "width", "lubricant", "operation",
        "iso_6336", "compliance", "root_stress", "friction", "power", "shift_distribution",
    }
)  # fmt: skip
_OIL = frozenset({"viscosity_40", "viscosity_100", "density_15", "temperature", "kind"})
_OPERATION = frozenset({"application_factor", "life"})
_SET = frozenset(
    {
        "double_helical",
        "sun",
        "planet",
        "ring",
        "planets",
        "angles",
        "fixed",
        "input",
        "torque",
        "speed",
        "centre_distance",
        "clockwise",
        "stiffness",
        "floating",
    }
)
#: Attributes of a stage by the values of a pair; those of editions of ISO 6336 end with its year.
_OF_STAGE = {
    "contact_ratio": "radial_contact_ratio",
    "overlap_ratio": "overlap_contact_ratio",
    "total_contact_ratio": "total_contact_ratio",
    "K_Hbeta": "face_load_factor_flank",
    "K_v_rated": "dynamic_factor_iso_6336_{}",
    "K_Hbeta_rated": "face_load_factor_contact_stress_iso_6336_{}",
    "K_Halpha_rated": "transverse_load_factor_contact_stress_iso_6336_{}",
}
#: Attributes of a gear in a stage.
_OF_GEAR = {
    "S_H": ("number", "safety_factor_pitting_iso_6336_{}"),
    "S_F": ("number", "safety_factor_tooth_root_iso_6336_{}"),
    "sigma_H": ("stress", "contact_stress_iso_6336_{}"),
    "sigma_F": ("stress", "tooth_root_stress_iso_6336_{}"),
}
#: What marks the second gear of a pair that names one twice.
_LIKE = ", identical stage"
_NOTHING = Found()
#: A torque below so much of all on its shaft balances.
_BALANCED = 1e-9


@dataclass
class _Bodies:
    """Shafts while torques and speeds are carried through them: sense and speed [rad/s], torque from outside [N m]."""

    shaft: dict[str, Part] = field(default_factory=dict)
    speed: dict[int, float] = field(default_factory=dict)
    sense: dict[int, float] = field(default_factory=dict)
    torques: dict[int, list[float]] = field(default_factory=dict)
    train: dict[int, int] = field(default_factory=dict)

    def join(self, *shafts: int) -> None:
        """Shafts that turn each other."""
        old = {self.train.setdefault(one, one) for one in shafts}
        self.train = {one: min(old) if train in old else train for one, train in self.train.items()}


def model_text(scene: Scene, date: str, results: Found = _NOTHING) -> tuple[str, tuple[str, ...]]:
    """The REXS file of a case, and remarks on what it leaves out.

    Parameters
    ----------
    scene : Scene
    date : str
        By ISO 8601.
    results : Found, optional
        By a run of this case.

    Raises
    ------
    InputError
        If the case has neither pairs nor planetary sets.
    """
    written = Written()
    unit, casing = written.part("gear_unit", scene.case.title or scene.name), written.part("gear_casing")
    written.relate("assembly", assembly=unit, part=casing)
    in_sets = {set_pair(name, mesh) for name in scene.case.planetary for mesh in ("sun", "ring")}
    pairs = {name: part for name, part in scene.case.pair.items() if name not in in_sets}
    sets = {name: part for name, part in scene.case.planetary.items() if part.ring is not None}
    if not pairs and not sets:
        raise InputError("pair", "(not given)", "is required: a REXS model contains gears in mesh", "add [pair.NAME]")
    written.remarks += [
        f"Set {name}: ring is not a gear of the case; not written to REXS."
        for name in scene.case.planetary if name not in sets
    ]  # fmt: skip
    used = dict.fromkeys(gear for part in pairs.values() for gear in (part.driver, _mate(part)))
    used |= dict.fromkeys(gear for part in sets.values() for gear in (part.sun, part.planet, part.ring) if gear)
    gears = {name: write_gear(written, scene, name.removesuffix(_LIKE)) for name in used}
    bodies = _Bodies()
    holders: dict[str | None, Part] = {None: casing}
    holders |= {name: written.part("shaft", name) for name in scene.case.shaft}
    for name in scene.case.shaft:
        made = write_shaft(written, scene, name, holders, gears)
        bodies.shaft |= {there.gear: made for there in scene.case.shaft[name].gears}
        written.relate("assembly", assembly=unit, part=made)
    planets = {part.planet for part in sets.values()}
    for name, gear in gears.items():
        if name not in bodies.shaft and name not in planets:
            bodies.shaft[name] = made = written.part("shaft", f"shaft of {name}")
            written.relate("assembly", assembly=made, part=gear)
            written.relate("assembly", assembly=unit, part=made)
    _flow(scene, pairs, bodies)
    for name, part in pairs.items():
        _stage(written, scene, name, part, gears, bodies, unit, results)
    for name, one in sets.items():
        _set(written, scene, name, one, gears, bodies, (unit, casing))
    _lives(unit, scene.case.pair)
    _drives(written, scene, bodies)
    shafts = {one.name: one for one in written.parts if one.type == "shaft"}
    write_shaft_results(written, shafts, results.tables)
    return written.text(date), tuple(dict.fromkeys(written.remarks))


def _mate(part: PairPart) -> str:
    """The driven gear; one of its own where the driver drives its like."""
    return part.driven if part.driven != part.driver else part.driven + _LIKE


def _flow(scene: Scene, pairs: Mapping[str, PairPart], bodies: _Bodies) -> None:
    """Speeds of all shafts and the torques that their gears leave."""
    clockwise = {
        bodies.shaft[there.gear].id: part.clockwise for part in scene.case.shaft.values() for there in part.gears
    }
    driven = {bodies.shaft[_mate(part)].id for part in pairs.values()}
    for one in bodies.shaft.values():
        if one.id not in driven:
            bodies.sense[one.id] = -1.0 if clockwise.get(one.id) else 1.0
    left = dict(pairs)
    while left:
        ready = [name for name, part in left.items() if bodies.shaft[part.driver].id in bodies.sense]
        for name in ready or list(left)[:1]:
            part, pair = left.pop(name), scene.pairs[name]
            first, second = (bodies.shaft[gear].id for gear in (part.driver, _mate(part)))
            bodies.join(first, second)
            sense = bodies.sense.setdefault(first, 1.0)
            ratio = pair.driver.tooth.teeth / pair.driven.tooth.teeth
            bodies.sense.setdefault(second, -pair.side * sense)
            if part.speed is not None:
                bodies.speed[first] = sense * part.speed
                bodies.speed.setdefault(second, -pair.side * sense * part.speed * ratio)
            load = part.normal_load(pair)
            if load is not None:
                torque = sense * load * pair.driver.base_radius
                bodies.torques.setdefault(first, []).append(torque)
                bodies.torques.setdefault(second, []).append(pair.side * torque / ratio)


def _stage(
    written: Written, scene: Scene, name: str, part: PairPart, gears: Mapping[str, Part], bodies: _Bodies, unit: Part,
    results: Found,
) -> None:  # fmt: skip
    """A pair: its stage with oil, K_A, and the data of both gears in it."""
    standing = {there.gear for one in scene.case.shaft.values() for there in one.gears}
    placed = part.driver in standing and part.driven in standing
    left_out(written, f"Pair {name}", part, _PAIR | ({"axial_offset"} if placed else set()))
    left_out(written, f"Pair {name}, operation", part.operation, _OPERATION)
    if part.double_helical is not None:
        written.remarks.append(
            f"Pair {name}: only one half (end I) of the double helical pair written to REXS, with half of the torque."
        )
    pair = scene.pairs[name]
    stage = written.part("cylindrical_stage", name).say("length", center_distance=pair.centre_distance)
    written.relate("assembly", assembly=unit, part=stage)
    written.relate("stage", stage=stage, gear_1=gears[part.driver], gear_2=gears[_mate(part)])
    year = _application_factor(part, stage)
    _oil(written, part, stage, name)
    found = results.values
    for key, attribute in _OF_STAGE.items():
        if (value := found.get(f"{name}.{key}")) is not None:
            stage.say("number", **{attribute.format(year): value})
    load = part.normal_load(pair)
    for role, gear in (("driver", part.driver), ("driven", _mate(part))):
        data = written.part("cylindrical_stage_gear_data", f"{name}, {gear}").word(is_driving_gear=role == "driver")
        written.relate("stage_gear_data", stage=stage, gear=gears[gear], stage_gear_data=data)
        if load is not None:
            data.say("torque", torque=load * getattr(pair, role).base_radius)
        for key, (quantity, attribute) in _OF_GEAR.items():
            if (value := found.get(f"{name}.{role}.{key}")) is not None:
                data.say(quantity, **{attribute.format(year): value})
    # Faces are counted from end I, that of +u where the driver turns about it: it is the datum face.
    along = -bodies.sense[bodies.shaft[part.driver].id]
    for gear in (part.driver, _mate(part)):
        lead = scene.case.gear[gear.removesuffix(_LIKE)].lead
        if lead is not None and (lead.slope or lead.end_relief):
            gears[gear].word(datum_face_orientation="positive" if along < 0.0 else "negative")
    _load_over_face(written, stage, name, along, min(pair.driver.face_width, pair.driven.face_width), results)


def _load_over_face(written: Written, stage: Part, name: str, along: float, width: float, results: Found) -> None:
    """The line load over the face, from end I, where a run has its table."""
    over = results.tables.get(f"load_over_face_{name}", {})
    if {"z", "mean_line_load"} <= over.keys():
        rows = sorted((along * float(z), float(q)) for z, q in zip(over["z"], over["mean_line_load"], strict=True))
        stage.say("length", load_distribution_node_positions=[z + 0.5 * width for z, _ in rows])
        stage.say("line load", load_distribution_along_face_width=[q for _, q in rows])
    elif over:
        written.remarks.append(f"Pair {name}: load distribution not written (table has no z or mean_line_load).")


def _application_factor(part: PairPart, stage: Part) -> int:
    """K_A of a pair with its stage, where it is given; the year of the edition of ISO 6336 that is followed."""
    year = part.iso_6336.edition or 2019
    if "application_factor" in part.operation.model_fields_set:
        stage.say("number", **{f"application_factor_iso_6336_{year}": part.operation.application_factor})
    return year


def _oil(written: Written, part: PairPart, stage: Part, name: str) -> None:
    """The lubricant of a pair and its temperature, with its stage."""
    oil = part.lubricant
    if oil is None:
        return
    left_out(written, f"Pair {name}, lubricant", oil, _OIL)
    made = written.part("lubricant", f"{name}, lubricant").word(kind="oil")
    made.word(lubricant_type_iso_6336_2019=next(rexs for rexs, case in OILS.items() if case == oil.kind))
    made.say(
        "viscosity", viscosity_at_40_degree_celsius=oil.viscosity_40, viscosity_at_100_degree_celsius=oil.viscosity_100
    )
    made.say("density", density_at_15_degree_celsius=oil.density_15 if "density_15" in oil.model_fields_set else None)
    written.relate("reference", origin=stage, referenced=made)
    stage.say("temperature", temperature_lubricant=oil.temperature)


def _set(
    written: Written, scene: Scene, name: str, part: PlanetaryPart, gears: Mapping[str, Part], bodies: _Bodies,
    around: tuple[Part, Part],
) -> None:  # fmt: skip
    """A planetary stage: its meshes, carrier, pins, and the coupling that holds a member."""
    left_out(written, f"Set {name}", part, _SET)
    if part.double_helical:
        written.remarks.append(
            f"Set {name}: only one half (end I) of the double helical gears written to REXS, with half of the torque."
        )
    unit, casing = around
    sun, ring = gears[part.sun], gears[str(part.ring)]
    distance = scene.pairs[set_pair(name, "sun")].centre_distance
    whole, carrier = written.part("planetary_stage", name), written.part("planet_carrier")
    start, across, up = _axis(scene, part, bodies)
    turning = place(written.part("shaft", f"{name}, carrier"), (start, across, up))
    written.relate("assembly", assembly=unit, part=whole)
    written.relate("assembly", assembly=whole, part=carrier)
    written.relate("assembly", assembly=carrier, part=turning)
    stiff = part.stiffness
    left_out(written, f"Set {name}, stiffness", stiff, {"pin", "sun", "ring", "carrier", "turning"})
    for n, angle in enumerate(angles_of(part)):
        there = start, across + distance * math.cos(angle), up + distance * math.sin(angle)
        planet = gears[part.planet] if n == 0 else write_gear(written, scene, part.planet)
        own, pin = (place(written.part("shaft", f"{name}, {what} {n + 1}"), there) for what in ("planet", "pin"))
        bearing = written.part("concept_bearing", f"{name}, pin {n + 1}").say("stiffness", radial_stiffness=stiff.pin)
        written.relate("assembly", assembly=own, part=planet)
        written.relate("assembly", assembly=carrier, part=pin)
        written.relate("side", assembly=bearing, outer_part=own, inner_part=pin)
        for mesh, first, second in zip(MESHES, (sun, planet), (planet, ring), strict=True):
            stage = written.part("cylindrical_stage").say("length", center_distance=distance)
            pair = scene.case.pair[set_pair(name, mesh)]
            _oil(written, pair, stage, f"{name}, {mesh} {n + 1}")
            _application_factor(pair, stage)
            if pair.operation.spectrum:
                written.remarks.append(f"Pair {set_pair(name, mesh)}, operation: spectrum not written to REXS.")
            written.relate("assembly", assembly=whole, part=stage)
            written.relate("stage", stage=stage, gear_1=first, gear_2=second)
    bodies.join(bodies.shaft[part.sun].id, bodies.shaft[str(part.ring)].id, turning.id)
    members = {"sun": bodies.shaft[part.sun], "ring": bodies.shaft[str(part.ring)], "carrier": turning}
    _supports(written, name, part, members, casing)
    held = written.part("coupling", f"{name}, {part.fixed} fixed").say(
        "tilting stiffness", rotational_stiffness=stiff.turning
    )
    if part.fixed in part.floating:
        held.say("stiffness", radial_stiffness=0.0)
    written.relate("side", assembly=held, inner_part=members[part.fixed], outer_part=casing)
    teeth = set_teeth(scene.case, part)
    share = {"sun": teeth.sun, "ring": teeth.ring, "carrier": -teeth.sun - teeth.ring}
    sense = -1.0 if part.clockwise else 1.0
    driving = members[part.input]
    if part.speed is not None:
        bodies.speed[driving.id] = sense * part.speed
    for role, member in members.items():
        if role != part.fixed:
            torque = sense * part.torque / part.halves * share[role] / share[part.input]
            bodies.torques.setdefault(member.id, []).append(torque)


def _axis(scene: Scene, part: PlanetaryPart, bodies: _Bodies) -> tuple[float, float, float]:
    """Where the axis of a set begins [m], along u, v and w: as the shaft of its sun or ring stands, else at zero."""
    members = [bodies.shaft[str(gear)] for gear in (part.sun, part.ring)]
    placed = [scene.case.shaft[one.name] for one in members if one.name in scene.case.shaft]
    at = (placed[0].start, placed[0].axis[0], placed[0].axis[1]) if placed else (0.0, 0.0, 0.0)
    for one in members:
        if one.name not in scene.case.shaft and not any(key == "support_vector" for key, _, _ in one.attributes):
            place(one, at)
    return at


def _supports(written: Written, name: str, part: PlanetaryPart, members: Mapping[str, Part], casing: Part) -> None:
    """Bearings of the members that do not float, where that is not the default of a case."""
    given = {role: getattr(part.stiffness, role) for role in members}
    if part.floating == ["sun"] and not any(given.values()):
        return
    for role, shaft in members.items():
        if role in part.floating:
            continue
        bearing = written.part("concept_bearing", f"{name}, bearing of the {role}")
        bearing.say("stiffness", radial_stiffness=given[role]).say("length", u_coordinate_on_shaft_inner_side=0.0)
        written.relate("side", assembly=bearing, inner_part=shaft, outer_part=casing)


def _lives(unit: Part, pairs: Mapping[str, PairPart]) -> None:
    """The operating time, where all pairs have one."""
    lives = {part.operation.life for part in pairs.values()}
    if len(lives) == 1 and (life := lives.pop()) is not None:
        unit.say("time", operating_time=life)


def _drives(written: Written, scene: Scene, bodies: _Bodies) -> None:
    """Loads where torque enters and leaves, and the speeds of shafts; what balance tells is not given twice."""
    ends = {one.name: scene.case.shaft[one.name] for one in bodies.shaft.values() if one.name in scene.case.shaft}
    shafts = [one for one in written.parts if one.type == "shaft"]
    net = {}
    for shaft in shafts:
        parts, end = bodies.torques.get(shaft.id, []), ends.get(shaft.name)
        # Torques of a shaft that nothing but its gears turns balance but for the digits that they are typed with.
        least = _BALANCED if end is None or end.coupling is not None else ROUNDED
        if abs(sum(parts)) > least * sum(map(abs, parts)):
            net[shaft.id] = sum(parts)
    driving = {n for n, torque in net.items() if torque * bodies.speed.get(n, bodies.sense.get(n, 1.0)) > 0.0}
    # One torque of every train follows from the others: the last that leaves it.
    told = {bodies.train.get(n, n): n for n in net if n not in driving}
    given = driving | (net.keys() - told.values())
    for shaft in shafts:
        if shaft.id in bodies.speed:
            shaft.say("speed", rotational_speed=bodies.speed[shaft.id])
            shaft.word(defines_speed=shaft.id in driving or not driving)
        end = ends.get(shaft.name)
        if shaft.id not in net and (end is None or end.coupling is None):
            continue
        at = 0.0 if end is None or end.coupling is None else end.coupling
        load = written.part("external_load", f"{shaft.name}, torque").say("length", u_coordinate_on_shaft=at)
        load.word(transmits_torque=True, defines_torque=shaft.id in given)
        if shaft.id in given:
            load.say("torque", torque_around_u_axis=net[shaft.id])
        written.relate("assembly", assembly=shaft, part=load)
