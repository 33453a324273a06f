"""A REXS model as one case: its gears, stages, shafts, bearings and loads, with remarks on all that was read."""

from __future__ import annotations

import math
from collections import defaultdict
from itertools import pairwise
from typing import TYPE_CHECKING

from fegear.base.errors import InputError
from fegear.exchange.case_tables import Key, Table, case_text, inline, listed, number, plain_name, quantity, text
from fegear.exchange.rexs.drive import Mesh, Torque, driven
from fegear.exchange.rexs.places import BEARINGS, bodies_of, direction, middle_on_shaft, places_of, shaft_of, stages_of
from fegear.exchange.rexs.said import Said
from fegear.exchange.rexs.sets import flow_through, planetary_of, set_table
from fegear.exchange.rexs.shafts import OnShaft, bearing_table, bearings_of, diameter_below, sections_of, shaft_table
from fegear.exchange.rexs.teeth import flank_of, gear_keys, module_of, profile_shift
from fegear.geometry.involute import inv

if TYPE_CHECKING:
    from fegear.exchange.rexs.drive import Driven, PlanetSet
    from fegear.exchange.rexs.model import Component, LoadCase, Model
    from fegear.exchange.rexs.places import Place, Stage
    from fegear.exchange.rexs.sets import Planetary

_RESULTS = ("geometry", "misalignment", "shaft-deflection", "load-distribution", "transmission-error", "rating")
#: What a pair gets where the model says nothing: torque per mm of face and module squared [Pa], speed, oil.
_ASSUMED_LOAD = 10e6
#: Rim below which a gear is no body of its own on its shaft [modules].
_LEAST_RIM = 2.7
#: Digits of what was solved: those behind them mean nothing.
_SOLVED = 12
#: Faces may stand beside each other by so much without being told [m].
_APART = 1e-9
_OIL = 'viscosity_40 = "220 mm^2/s", viscosity_100 = "19 mm^2/s", density_15 = "890 kg/m^3"'
#: Stages that are not cylindrical.
_OTHER_STAGES = ("bevel_stage", "worm_stage")


def case_of(model: Model, load_case: int | None = None, source: str = "") -> str:
    """The text of a case file.

    Parameters
    ----------
    model : Model
    load_case : int, optional
        Number of the load case whose torques and speeds are taken; the first by default.
    source : str
        Name of the file, for the first line.

    Raises
    ------
    InputError
        If what a case needs is missing or contradicts itself.
    """
    chosen = _load_case(model, load_case)
    said = Said(model, chosen.attributes if chosen else {})
    stages = stages_of(said)
    for one in model.of(*_OTHER_STAGES):
        said.notes.append(f"{one.said} is not read.")
    sets = planetary_of(said, stages)
    inside = {number for one in sets for number in one.stages}
    everything, stages = stages, [stage for stage in stages if stage.component.id not in inside]
    gears = {gear.id: gear for stage in stages for gear in stage.gears}
    of_sets = {gear.id: gear for one in sets for gear in one.gears if gear.id not in gears}
    names = _names((*gears.values(), *of_sets.values()), "gear")
    on = {n: shaft_of(said, gear) for n, gear in (gears | of_sets).items()}
    if lost := next((gear for n, gear in (gears | of_sets).items() if on[n] is None), None):
        raise InputError(lost.said, "(on no shaft)", "is part of no shaft", "complete its relation of type assembly")
    shafts = {shaft.id: shaft for n in gears if (shaft := on[n]) is not None}
    middles = _middles(said, gears, on)
    turning = _flow(said, stages, sets, on)
    flow = turning[:2]
    bent = bool(shafts) and _held(said, shafts)
    tables = [_head(stages, sets, said, bent=bent)]
    for n, gear in (gears | of_sets).items():
        bore = _bore(said, gear, on[n], middles) if n in gears else None
        keys = gear_keys(said, gear, _rest_of_shift(said, gear, everything), bore)
        tables.append(Table(f"gear.{names[n]}", keys, f"{gear.said} {gear.name}".strip()))
    relieved = any(key.name in ("relief", "lead") for table in tables for key in table.keys)
    places = places_of(said, stages, middles)
    heights = {n: _height(places[on[n].id], middles[n]) for n in gears}  # type: ignore[union-attr]
    tables += [_pair(said, stage, names, flow, n, heights if bent else {}) for n, stage in enumerate(stages)]
    tables += [
        set_table(said, one, names, whole, flow[0], n, turning[2])
        for n, (one, whole) in enumerate(zip(sets, turning[3], strict=True))
    ]
    tables += _shafts(said, shafts, places, gears, names, on, middles, flow) if bent else []
    tables.append(_effects(bent=bent, relieved=relieved))
    about = f"Imported from {source}" if source else "Imported"
    head = (
        f"{about}: REXS {model.version}, written by {model.program or 'an unnamed program'}"
        + (f", load case {chosen.id}" if chosen else "") + ".",
        "Behind each key stands the attribute that it comes from, or what was assumed.",
    )  # fmt: skip
    return case_text(head, tables, (*(f"Note: {note}" for note in said.notes), *_unread(said)))


def _load_case(model: Model, asked: int | None) -> LoadCase | None:
    known = {one.id: one for one in model.load_cases}
    if asked is not None and asked not in known:
        listed_ones = ", ".join(map(str, known)) or "none"
        raise InputError("--load-case", asked, "is none of the model", f"it has {listed_ones}")
    return known[asked] if asked is not None else next(iter(known.values()), None)


def _names(components: object, other: str) -> dict[int, str]:
    found: dict[int, str] = {}
    for one in components:  # type: ignore[attr-defined]
        found[one.id] = plain_name(one.name, f"{other}_{one.id}", set(found.values()))
    return found


def _middles(said: Said, gears: dict[int, Component], on: dict[int, Component | None]) -> dict[int, float]:
    """Middle of every face on its shaft [m]; in the middle of the shaft where nothing is said."""
    found = {}
    for n, gear in gears.items():
        shaft = on[n]
        at = None if shaft is None else middle_on_shaft(said, gear, shaft)
        if at is None and shaft is not None:
            sections = sections_of(said, shaft)
            at = 0.5 * (sections[0].begin + sections[-1].end) if sections else 0.0
            said.notes.append(f"{gear.said} has no place on {shaft.said}: its middle is assumed.")
        found[n] = at or 0.0
    return found


def _flow(
    said: Said, stages: list[Stage], sets: list[Planetary], on: dict[int, Component | None]
) -> tuple[Driven, dict[int, int], set[int], list[PlanetSet]]:
    """Torques and speeds, the body of every shaft, bodies that are held, and the planetary sets by bodies."""
    bodies, held = bodies_of(said, [pair for one in sets for pair in pairwise(one.carriers)])
    whole = [flow_through(said, one, bodies) for one in sets]
    meshes = [
        Mesh(
            (bodies[on[one.id].id], bodies[on[two.id].id]),  # type: ignore[union-attr]
            tuple(said.whole(gear, "number_of_teeth") for gear in (one, two)),  # type: ignore[arg-type]
        )
        for one, two in (stage.gears for stage in stages)
    ]
    torques, speeds = [], {}
    for shaft in said.model.of("shaft"):
        sign = -1.0 if direction(said, shaft) else 1.0
        for load in said.linked(shaft, "assembly", "assembly", "part", "external_load"):
            value = said.number(load, "torque", "torque_around_u_axis")
            through = said.yes(load, "transmits_torque")
            if said.yes(load, "defines_torque") is False or (value is None and through):
                torques.append(Torque(bodies[shaft.id], None))
            elif value:
                torques.append(Torque(bodies[shaft.id], sign * value))
        speed = said.number(shaft, "speed", "rotational_speed")
        if speed and said.yes(shaft, "defines_speed") is not False:
            speeds[bodies[shaft.id]] = sign * speed
    if stages and len(torques) == 1 and torques[0].value is not None:
        # One torque alone: it leaves at the last wheel.
        last = stages[-1].gears[1]
        torques.append(Torque(bodies[on[last.id].id], None))  # type: ignore[union-attr]
        said.notes.append(f"The torque is assumed to leave at {last.said}: nothing else takes it.")
    count = max(bodies.values(), default=-1) + 1
    return driven(count, meshes, whole, torques, speeds, sorted(held)), bodies, held, whole


def _head(stages: list[Stage], sets: list[Planetary], said: Said, *, bent: bool) -> Table:
    internal = bool(sets) or any(stage.internal for stage in stages)
    left_out = [*(("rating", "load-distribution") * internal), *(("misalignment", "shaft-deflection") * (not bent))]
    results = [one for one in _RESULTS if one not in left_out]
    results += ["planet-set", "planet-load-sharing", "root-stress-history"] if sets else []
    if internal:
        said.notes.append("load-distribution and rating are not asked for: a stage has a ring gear.")
    title = next((one.name for one in said.model.of("gear_unit") if one.name), "") or "An imported gearbox"
    return Table("", (Key("title", text(title)), Key("results", listed(map(text, results)))))


def _rest_of_shift(said: Said, gear: Component, stages: list[Stage]) -> float | None:
    """Profile shift that the centre distance leaves to a gear which has none of its own."""
    if profile_shift(said, gear) is not None:
        return None
    stage = next(one for one in stages if gear.id in (two.id for two in one.gears))
    distance = said.number(stage.component, "length", "center_distance")
    mate = next(one for one in stage.gears if one.id != gear.id)
    if distance is None or stage.internal:
        return 0.0
    teeth = sum(abs(said.whole(one, "number_of_teeth")) for one in stage.gears)
    helix = said.number(gear, "angle", "helix_angle_reference_diameter") or 0.0
    flank = flank_of(said, gear)
    normal = (said.number(flank, "angle", "normal_pressure_angle") if flank else None) or math.radians(20.0)
    alpha = math.atan(math.tan(normal) / math.cos(helix))
    cosine = 0.5 * teeth * module_of(said, gear) / math.cos(helix) * math.cos(alpha) / distance
    if not 0.0 < cosine <= 1.0:
        raise InputError(
            "center_distance", f"{distance * 1e3:.6g} mm", f"is too small for the teeth of {stage.component.said}",
            "correct it",
        )  # fmt: skip
    both = float(inv(math.acos(cosine)) - inv(alpha)) * teeth / (2.0 * math.tan(normal))
    other = profile_shift(said, mate)
    return 0.5 * both if other is None else both - other


def _bore(said: Said, gear: Component, shaft: Component | None, middles: dict[int, float]) -> float | None:
    """Radius of the shaft below a gear [m]; None where the teeth are cut into the shaft, or nearly."""
    below = None if shaft is None else diameter_below(sections_of(said, shaft), middles[gear.id])
    if below is None:
        return None
    module, helix = module_of(said, gear), said.number(gear, "angle", "helix_angle_reference_diameter") or 0.0
    teeth = abs(said.whole(gear, "number_of_teeth"))
    root = module * (0.5 * teeth / math.cos(helix) - 1.25 + (profile_shift(said, gear) or 0.0))
    if root - 0.5 * below < _LEAST_RIM * module:
        said.notes.append(f"{gear.said} is taken as cut into its shaft, whose radius is {0.5e3 * below:.4g} mm.")
        return None
    return 0.5 * below


def _height(place: Place, middle: float) -> float:
    """Middle of a face along the gearbox [m]."""
    return place.u + (-middle if place.reversed else middle)


def _pair(
    said: Said, stage: Stage, names: dict[int, str], flow: tuple[Driven, dict[int, int]], n: int,
    heights: dict[int, float],
) -> Table:  # fmt: skip
    """``[pair.NAME]``: who drives, distance, torque and speed."""
    found, bodies = flow
    first, second = stage.gears
    torque = found.mesh_torque[n] if n < len(found.mesh_torque) else math.nan
    speeds = [found.speed[bodies[shaft_of(said, gear).id]] for gear in stage.gears]  # type: ignore[union-attr]
    drives = not torque * speeds[0] > 0.0  # the mate takes power from a gear that drives
    driver, wheel = (first, second) if drives else (second, first)
    teeth = [abs(said.whole(gear, "number_of_teeth")) for gear in (first, second)]
    on_driver = abs(torque) if drives else abs(torque) * teeth[1] / teeth[0]
    speed = abs(speeds[0] if drives else speeds[1])
    distance = said.number(stage.component, "length", "center_distance")
    keys = [Key("driver", text(names[driver.id])), Key("driven", text(names[wheel.id]))]
    if distance is not None:
        keys.append(Key("centre_distance", quantity(abs(distance), "mm"), "center_distance"))
    # End I is that from which the driver turns counter-clockwise: the end of +u where it turns about +u.
    higher = heights.get(wheel.id, 0.0) - heights.get(driver.id, 0.0)
    higher *= -1.0 if (speeds[0] if drives else speeds[1]) < 0.0 else 1.0
    if abs(higher) > _APART:
        keys.append(Key("axial_offset", quantity(higher, "mm"), "from the places of both shafts"))
    if math.isfinite(on_driver) and on_driver > 0.0:
        keys.append(
            Key("torque", quantity(on_driver, "N*m", _SOLVED), "through the gearbox from the torque of external_load")
        )
    else:
        width, module = said.needed(driver, "length", "face_width"), module_of(said, driver)
        pinion = teeth[0] if drives else teeth[1]
        load = _ASSUMED_LOAD * width * module * 0.5 * module * pinion
        keys.append(Key("torque", quantity(float(f"{load:.3g}"), "N*m"), "assumed: no torque reaches this mesh"))
    if math.isfinite(speed) and speed > 0.0:
        keys.append(Key("speed", quantity(speed, "rpm", _SOLVED), "through the gearbox from rotational_speed"))
    else:
        keys.append(Key("speed", quantity(1500.0 * 2.0 * math.pi / 60.0, "rpm"), "assumed: no speed reaches this mesh"))
    if not stage.internal:
        keys.append(Key("width", text("slices"), "cheaper than solid gears"))
        keys.append(Key("lubricant", f'{{ {_OIL}, temperature = "70 degC" }}', "assumed: mineral oil ISO VG 220"))
        factor = said.number(stage.component, "number", "application_factor")
        life = inline(application_factor=number(factor or 1.0), life='"20000 h"')
        keys.append(Key("operation", life, "application_factor" if factor else "assumed"))
    return Table(f"pair.{_roman(n + 1)}", tuple(keys), f"{stage.component.said} {stage.component.name}".strip())


def _roman(n: int) -> str:
    found = ""
    for value, sign in ((10, "X"), (9, "IX"), (5, "V"), (4, "IV"), (1, "I")):
        found, n = found + sign * (n // value), n % value
    return found


def _shafts(
    said: Said, shafts: dict[int, Component], places: dict[int, Place], gears: dict[int, Component],
    names: dict[int, str], on: dict[int, Component | None], middles: dict[int, float],
    flow: tuple[Driven, dict[int, int]],
) -> list[Table]:  # fmt: skip
    """All shafts with gears, the first as the origin, and their bearings."""
    found, bodies = flow
    called = _names(shafts.values(), "shaft")
    held = _names(said.model.of(*BEARINGS), "bearing")
    origin = places[next(iter(shafts))]
    made: list[Table] = []
    seats: list[Table] = []
    for n, shaft in shafts.items():
        mine = tuple((names[m], middles[m]) for m in gears if on[m] is shaft)
        ends = tuple(
            said.needed(one, "length", "u_coordinate_on_shaft")
            for one in said.linked(shaft, "assembly", "assembly", "part", "external_load")
            if said.yes(one, "transmits_torque") or said.number(one, "torque", "torque_around_u_axis")
        )
        bearings = bearings_of(said, shaft, held)
        along = [one for one in bearings if _absorbs(said, one.component)] or bearings[:1]
        for one in bearings:  # between two shafts it comes twice
            if f"bearing.{one.name}" not in {seat.name for seat in seats}:
                seats.append(bearing_table(said, one, fixed=one is along[0]))
        clockwise = found.speed[bodies[n]] < 0.0
        made.append(
            shaft_table(said, shaft, called[n], places[n], OnShaft(mine, ends), bearings, origin, clockwise=clockwise)
        )
    return [*made, *seats]


def _held(said: Said, shafts: dict[int, Component]) -> bool:
    """Whether every shaft has sections and bearings; a note where one has not."""
    for shaft in shafts.values():
        for what, there in (("sections", sections_of(said, shaft)), ("bearings", bearings_of(said, shaft, _Any()))):
            if not there:
                said.notes.append(f"{shaft.said} has no {what}: shafts and bearings are not imported.")
                return False
    return True


class _Any(dict[int, str]):
    """A name for whatever is asked."""

    def __missing__(self, key: int) -> str:
        return str(key)


def _effects(*, bent: bool, relieved: bool) -> Table:
    keys = [Key("neighbour_coupling", "true"), Key("hertz", text("load-dependent"))]
    keys += [Key("relief", "true", "relief and lead of the gears")] if relieved else []
    keys += [Key("misalignment", "true", "the shafts tilt the flanks")] if bent else []
    return Table("effects", tuple(keys))


def _absorbs(said: Said, bearing: Component) -> bool:
    """Whether a bearing holds its shaft along the axis."""
    word = said.word(bearing, "axial_force_absorption")
    return word is not None and word.lower() not in ("none", "false", "no", "not_absorbed", "")


def _unread(said: Said) -> list[str]:
    """What the model says besides, by type of component: nothing is passed over in silence."""
    left: dict[str, set[str]] = defaultdict(set)
    for component in said.model.components.values():
        for name in component.attributes:
            if (component.id, name) not in said.used:
                left[component.type].add(name)
    return [f"Not used of {kind}: {', '.join(sorted(names))}." for kind, names in sorted(left.items())]
