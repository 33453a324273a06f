"""A REXS model as one case: its gears, stages, shafts, bearings and loads, with remarks on all that was read."""

from __future__ import annotations

import math
from collections import defaultdict
from dataclasses import replace
from functools import partial
from typing import TYPE_CHECKING

from fegear.base.effects import HERTZ, MISALIGNMENT, NEIGHBOUR_COUPLING, RELIEF
from fegear.base.errors import InputError
from fegear.exchange.case_tables import Key, Table, case_text, listed, plain_name, quantity, text
from fegear.exchange.rexs.bearings import bearing_tables, bearings_of, fixed_bearing, stopped_along
from fegear.exchange.rexs.halves import double_helical_notes
from fegear.exchange.rexs.loads import Spectrum, chosen_load_case, flow_of, spectrum_of
from fegear.exchange.rexs.operation import lubricant_key, operation_key
from fegear.exchange.rexs.places import (
    BEARINGS,
    BEVEL,
    bevels_of,
    direction,
    distance_of,
    middle_on_shaft,
    places_of,
    shaft_of,
    stages_of,
    turn_to_axes,
)
from fegear.exchange.rexs.planetary import planetary_of
from fegear.exchange.rexs.reading import read_model
from fegear.exchange.rexs.said import Said
from fegear.exchange.rexs.sets import set_tables
from fegear.exchange.rexs.shafts import (
    OnShaft,
    coupling_of,
    diameter_below,
    hole_below,
    is_rigid,
    sections_of,
    shaft_table,
)
from fegear.exchange.rexs.teeth import flank_of, gear_keys, module_of, profile_shift, refuse_equal_hands, teeth_of
from fegear.geometry.involute import inv

if TYPE_CHECKING:
    from pathlib import Path

    from fegear.exchange.rexs.flow import Flow
    from fegear.exchange.rexs.loads import Bins
    from fegear.exchange.rexs.model import Component, Model
    from fegear.exchange.rexs.modifications import End
    from fegear.exchange.rexs.places import Place, Stage
    from fegear.exchange.rexs.planetary import Planetary

_RESULTS = (
    "gearbox",
    "geometry",
    "misalignment",
    "shaft-deflection",
    "load-distribution",
    "transmission-error",
    "rating",
)
#: Rim below which a gear is no body of its own on its shaft [modules].
_LEAST_RIM = 2.7
#: Relative error and panels over the face with which load distributions of a gearbox are computed.
_TOLERANCE, _PANELS = 0.05, 24
#: Faces above it are loaded as coupled slices [modules]: solid gears take minutes each there.
_WIDEST_SOLID = 40.0
_WIDTHS = {"solid": "3D gears", "slices": "coupled slices"}
#: Digits of what was solved: those behind them mean nothing.
_SOLVED = 12
#: A torque of so much of the largest is none.
_IDLE = 1e-9
#: Faces may stand beside each other by so much without being told [m].
_APART = 1e-9
#: Stages that are not cylindrical.
_OTHER_STAGES = (BEVEL, "worm_stage")


def read_case(path: Path, load_case: int | None = None, *, spectrum: bool | None = None) -> str:
    """The text of the case that a REXS file makes; see `case_of`."""
    return case_of(read_model(path), load_case, path.name, spectrum=spectrum)


def case_of(model: Model, load_case: int | None = None, source: str = "", *, spectrum: bool | None = None) -> str:
    """The text of a case file.

    Parameters
    ----------
    model : Model
    load_case : int, optional
        Number of the load case whose torques and speeds are taken; the first by default.
    source : str
        Name of the file, for the first line.
    spectrum : bool, optional
        Whether all load cases together are the load spectrum of every pair's rating; by default where no load case is
        asked for and all say how long they last.

    Raises
    ------
    InputError
        If what a case needs is missing or contradicts itself.
    """
    chosen = chosen_load_case(model, load_case)
    said = Said(model, chosen.attributes if chosen else {})
    if chosen is not None and len(model.load_cases) > 1:
        others = ", ".join(str(one.id) for one in model.load_cases if one is not chosen)
        said.notes.append(f"Torques and speeds from load case {chosen.id}; other load cases in the model: {others}.")
    stages = stages_of(said)
    refuse_equal_hands(said, stages)
    turn_to_axes(said, stages)
    bevels = bevels_of(said)
    through = {stage.component.id for stage in bevels}
    for one in model.of(*_OTHER_STAGES):
        also = ": torque and speed are transmitted, its forces on the shafts are neglected" if one.id in through else ""
        said.notes.append(f"{one.said} ignored{also}.")
    sets = planetary_of(said, stages)
    inside = {number for one in sets for number in one.stages}
    everything, stages = stages, [stage for stage in stages if stage.component.id not in inside]
    gears = {gear.id: gear for stage in stages for gear in stage.gears}
    of_sets = {gear.id: gear for one in sets for gear in one.gears if gear.id not in gears}
    names = _names((*gears.values(), *of_sets.values()), "gear")
    on = {n: shaft_of(said, gear) for n, gear in (gears | of_sets).items()}
    planets = {gear.id: gear for one in sets for gear in one.planets}
    if lost := next((one for one in (gears | of_sets | planets).values() if shaft_of(said, one) is None), None):
        raise InputError(
            lost.said, "(on no shaft)", "does not belong to a shaft", "complete its relation of type assembly"
        )
    middles = _middles(said, gears, on)
    every = [*stages, *bevels]
    on |= {gear.id: shaft_of(said, gear) for stage in bevels for gear in stage.gears}
    flow = flow_of(said, every, sets, on)
    bins = _bins(said, every, sets, on, flow, spectrum=spectrum if load_case is None else bool(spectrum))
    loaded = _loaded(said, stages, flow, bins)
    said.notes += double_helical_notes(said, [stages[n] for n in loaded], on, middles)
    gears = {n: gear for n, gear in gears.items() if any(gear in stages[one].gears for one in loaded)}
    names = {n: name for n, name in names.items() if n in gears or n in of_sets}
    shafts = {shaft.id: shaft for n in gears if (shaft := on[n]) is not None}
    places = places_of(said, stages, middles)
    bent = bool(shafts) and _held(said, shafts, {n: places[n] for n in shafts if n in places})
    rest = {n: _rest_of_shift(said, gear, everything) for n, gear in (gears | of_sets).items()}
    tables = [_head(sets, said, bent=bent)]
    for n, gear in (gears | of_sets).items():
        bore = _bore(said, gear, on[n], middles) if n in gears else _bore_in_set(said, gear, on[n], sets)
        keys = gear_keys(said, gear, rest[n], bore, _far_end(said, gear, stages, flow))
        tables.append(Table(f"gear.{names[n]}", keys, f"{gear.said} {gear.name}".strip()))
    relieved = any(key.name in ("relief", "lead") for table in tables for key in table.keys)
    width = _width(said, [stages[n] for n in loaded])
    heights = {n: _height(places[on[n].id], middles[n]) for n in gears}  # type: ignore[union-attr]  # gears on no shaft are refused before
    tables += [
        _pair(said, stage, names, flow, n, heights if bent else {}, bins, width)
        for n, stage in enumerate(stages)
        if n in loaded
    ]
    for n, planetary in enumerate(sets):
        of_mesh = partial(_keys_in_set, said, bins=bins.sets[n] if bins.sets else (), life=bins.life)
        tables += set_tables(said, planetary, names, n, flow, everything, of_mesh)
    tables += _shafts(said, shafts, places, stages, names, on, middles, flow) if bent else []
    tables.append(_effects(bent=bent, relieved=relieved))
    if any(not stages[n].internal for n in loaded):
        tables += [
            Table("load_distribution", (Key("panels", str(_PANELS), "over the face width: K_Hbeta within 1 %"),)),
            Table("accuracy", (Key("tolerance", f"{_TOLERANCE:g}", "K_Hbeta within 5 % with 3D gears"),)),
        ]
    if loaded:
        tables.append(Table("rating", (Key("beside", "[]", 'ISO 6336 only; "agma-2101" and "computed" besides'),)))
    about = f"Imported from {source}" if source else "Imported"
    head = (
        f"{about}: REXS {model.version}, written by {model.program or 'an unnamed program'}"
        + (f", load case {chosen.id}" if chosen else "") + ".",
        "Comments show the REXS attribute of each value, or the assumption made.",
    )  # fmt: skip
    return case_text(head, tables, (*(f"Note: {note}" for note in dict.fromkeys(said.notes)), *_unread(said)))


def _bins(
    said: Said, stages: list[Stage], sets: list[Planetary], on: dict[int, Component | None], flow: Flow,
    *, spectrum: bool | None,
) -> Spectrum:  # fmt: skip
    """All load cases as the load spectrum where that is asked for, or not refused and they say how long they last."""
    none = Spectrum(((),) * len(stages))
    cases = said.model.load_cases
    if spectrum is False or (spectrum is None and len(cases) < 2):
        return none
    try:
        found = spectrum_of(said, stages, sets, on, flow)
    except InputError as error:
        if spectrum:
            raise
        said.notes.append(f"The {len(cases)} load cases are not used as a load spectrum: {error.value} {error.rule}.")
        return none
    if spectrum is None:
        said.notes.append(
            f"The {len(cases)} load cases with their durations are used as load spectrum for the ratings."
        )
    return found


def _loaded(said: Said, stages: list[Stage], flow: Flow, spectrum: Spectrum) -> list[int]:
    """Stages that carry a load; a note on those that turn without, as gears of another speed do."""
    size = [
        max([abs(flow.into(n)[1]), *(torque for torque, _, _ in bins)])
        for n, bins in zip(range(len(stages)), spectrum.bins, strict=False)
    ]
    most = max([*size, *(abs(one) for one in flow.driven.set_torque if math.isfinite(one))], default=0.0)
    loaded = [n for n, one in enumerate(size) if not one <= _IDLE * most]
    idle = [stages[n].component.said for n in range(len(stages)) if n not in loaded]
    if idle:
        said.notes.append(f"No torque in {', '.join(idle)} in this load case: {_are(idle)} not in the case.")
    return loaded


def _far_end(said: Said, gear: Component, stages: list[Stage], flow: Flow) -> End | None:
    """End of a gear's face that is not its datum face; None where nothing says which way the gear or its mate turns.

    End II is that from which the driver turns clockwise: toward -u where it turns about +u.
    """
    number = next((n for n, stage in enumerate(stages) if any(one.id == gear.id for one in stage.gears)), None)
    orientation = said.word(gear, "datum_face_orientation")
    if number is None or orientation is None:
        return None
    speed = flow.into(number)[2]
    if not speed or not math.isfinite(speed):
        return None
    far_up = (orientation == "negative") != direction(said, gear)
    return "I" if far_up == (speed > 0.0) else "II"


def _are(several: list[str]) -> str:
    return "it is" if len(several) == 1 else "they are"


def _names(components: object, other: str) -> dict[int, str]:
    found: dict[int, str] = {}
    for one in components:  # type: ignore[attr-defined]  # several kinds of components
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
            said.notes.append(f"{gear.said}: position on {shaft.said} not specified; mid-shaft assumed.")
        found[n] = at or 0.0
    return found


def _head(sets: list[Planetary], said: Said, *, bent: bool) -> Table:
    left_out = () if bent else ("gearbox", "misalignment", "shaft-deflection")
    results = [one for one in _RESULTS if one not in left_out]
    results += ["planet-set", "planet-load-sharing", "root-stress-history"] if sets else []
    title = next((one.name for one in said.model.of("gear_unit") if one.name), "") or "An imported gearbox"
    return Table("", (Key("title", text(title)), Key("results", listed(map(text, results)))))


def _rest_of_shift(said: Said, gear: Component, stages: list[Stage]) -> float | None:
    """Profile shift that the centre distance leaves to a gear which has none of its own."""
    if profile_shift(said, gear) is not None:
        return None
    mine = [one for one in stages if gear.id in (two.id for two in one.gears)]
    stage = next((one for one in mine if not one.internal), mine[0])  # a planet's mesh with the sun comes first
    distance = distance_of(said, stage)
    mate = next(one for one in stage.gears if one.id != gear.id)
    if distance is None:
        return 0.0
    teeth = abs(sum(teeth_of(said, one) for one in stage.gears))
    helix = said.number(gear, "angle", "helix_angle_reference_diameter") or 0.0
    flank = flank_of(said, gear)
    normal = (said.number(flank, "angle", "normal_pressure_angle") if flank else None) or math.radians(20.0)
    alpha = math.atan(math.tan(normal) / math.cos(helix))
    cosine = 0.5 * teeth * module_of(said, gear) / math.cos(helix) * math.cos(alpha) / distance
    if not 0.0 < cosine <= 1.0:
        raise InputError(
            "center_distance", f"{distance * 1e3:.6g} mm", f"is too small for the teeth of {stage.component.said}",
            "correct the value",
        )  # fmt: skip
    both = float(inv(math.acos(cosine)) - inv(alpha)) * (-teeth if stage.internal else teeth) / (2.0 * math.tan(normal))
    other = profile_shift(said, mate)
    if other is None and stage.internal:  # the mate's shift is that of its mesh with the sun, or none
        other = _rest_of_shift(said, mate, stages) if gear.type == "ring_gear" else 0.0
    return 0.5 * both if other is None else both - (other or 0.0)


def _bore(said: Said, gear: Component, shaft: Component | None, middles: dict[int, float]) -> float | None:
    """Radius of the shaft below a gear, or around a ring [m]; None where teeth are cut into the shaft, or nearly."""
    below = None if shaft is None else diameter_below(sections_of(said, shaft), middles[gear.id])
    if not below or gear.type == "ring_gear":
        return 0.5 * below if below else None
    module, helix = module_of(said, gear), said.number(gear, "angle", "helix_angle_reference_diameter") or 0.0
    teeth = abs(teeth_of(said, gear))
    root = module * (0.5 * teeth / math.cos(helix) - 1.25 + (profile_shift(said, gear) or 0.0))
    if root - 0.5 * below < _LEAST_RIM * module:
        said.notes.append(f"{gear.said} treated as integral with its shaft (radius {0.5e3 * below:.4g} mm).")
        return None
    return 0.5 * below


def _bore_in_set(said: Said, gear: Component, shaft: Component | None, sets: list[Planetary]) -> float | None:
    """Bore of a sun, by its shaft, or of a planet: the hole of its sleeve, or its outside where the sleeve is rigid."""
    if shaft is None:
        return None
    at = middle_on_shaft(said, gear, shaft)
    if at is None:
        return None
    if any(gear.id == planet.id for one in sets for planet in one.planets):
        sections, rigid = sections_of(said, shaft), is_rigid(said, shaft)
        below = diameter_below(sections, at) if rigid else hole_below(sections, at)
        if below:
            return 0.5 * below
    return _bore(said, gear, shaft, {gear.id: at})


def _height(place: Place, middle: float) -> float:
    """Middle of a face along the gearbox [m]."""
    return place.u + (-middle if place.reversed else middle)


def _pair(
    said: Said, stage: Stage, names: dict[int, str], flow: Flow, n: int, heights: dict[int, float],
    spectrum: Spectrum, width: str,
) -> Table:  # fmt: skip
    """``[pair.NAME]``: who drives, distance, torque and speed."""
    first, second = stage.gears
    drives, on_driver, speed = flow.into(n)
    driver, wheel = (first, second) if drives else (second, first)
    distance = distance_of(said, stage)
    keys = [Key("driver", text(names[driver.id])), Key("driven", text(names[wheel.id]))]
    if distance is not None:
        given = "center_distance" in said.attributes_of(stage.component)
        where = "center_distance" if given else "from support_vector of both shafts"
        keys.append(Key("centre_distance", quantity(distance, "mm"), where))
    # End I is that from which the driver turns counter-clockwise: the end of +u where it turns about +u.
    higher = heights.get(wheel.id, 0.0) - heights.get(driver.id, 0.0)
    higher *= -1.0 if speed < 0.0 else 1.0
    if abs(higher) > _APART:
        # a difference of positions: its last digits are theirs
        keys.append(Key("axial_offset", quantity(higher, "mm", _SOLVED), "from the positions of both shafts"))
    assumed = "assumed, and calculated through the gearbox"
    where = assumed if n in flow.assumed_torque else "calculated through the gearbox from the torque of external_load"
    keys.append(Key("torque", quantity(on_driver, "N*m", _SOLVED), where))
    where = assumed if n in flow.assumed_speed else "calculated through the gearbox from rotational_speed"
    keys.append(Key("speed", quantity(abs(speed), "rpm", _SOLVED), where))
    if not stage.internal:  # of internal spur pairs the plane section is taken
        keys.append(Key("width", text(width), "load over the face from " + _WIDTHS[width]))
    keys += _surface_keys(said, stage, bins=spectrum.bins[n], life=spectrum.life)
    return Table(f"pair.{_roman(n + 1)}", tuple(keys), f"{stage.component.said} {stage.component.name}".strip())


def _width(said: Said, stages: list[Stage]) -> str:
    """How external gears are loaded over their faces: as solids, all of them, for a gear may be in several pairs."""
    wide = [
        gear
        for stage in stages
        if not stage.internal
        for gear in stage.gears
        if (said.number(gear, "length", "face_width") or 0.0) > _WIDEST_SOLID * module_of(said, gear)
    ]
    if wide and not any(stage.internal for stage in stages):
        gears = ", ".join(dict.fromkeys(gear.said for gear in wide))
        said.notes.append(
            f"{gears}: faces of more than {_WIDEST_SOLID:g} modules; external pairs are coupled slices; the "
            'error of K_Hbeta may exceed 5 %. Set width = "solid" for 3D gears, which take minutes each.'
        )
        return "slices"
    return "solid"


def _surface_keys(said: Said, stage: Stage, *, bins: Bins, life: float | None) -> tuple[Key, ...]:
    """Oil and operation of a pair."""
    return lubricant_key(said, stage.component), operation_key(said, stage.component, bins, life)


def _keys_in_set(said: Said, stage: Stage, driver: Component, *, bins: Bins, life: float | None) -> tuple[Key, ...]:
    """Oil and operation of a set's pair; its driver turns relative to the carrier as its teeth say."""
    own = tuple((factor, rate / abs(teeth_of(said, driver)), share) for factor, rate, share in bins)
    return lubricant_key(said, stage.component), operation_key(said, stage.component, own, life, of_nominal=True)


def _roman(n: int) -> str:
    found = ""
    for value, sign in ((10, "X"), (9, "IX"), (5, "V"), (4, "IV"), (1, "I")):
        found, n = found + sign * (n // value), n % value
    return found


def _shafts(
    said: Said, shafts: dict[int, Component], places: dict[int, Place], stages: list[Stage],
    names: dict[int, str], on: dict[int, Component | None], middles: dict[int, float], flow: Flow,
) -> list[Table]:  # fmt: skip
    """All shafts with gears, the first as the origin, and their bearings."""
    every = {gear.id: gear for stage in stages for gear in stage.gears if gear.id in names}
    called = _names(shafts.values(), "shaft")
    held = _names(said.model.of(*BEARINGS), "bearing")
    origin = places[next(iter(shafts))]
    standing = {n: places[n] for n in shafts}
    on_bearings, fixed, stopped = {}, set(), set()
    for n, shaft in shafts.items():
        bearings = bearings_of(said, shaft, held, standing)
        push = (-1.0 if places[n].reversed else 1.0) * flow.push(said, stages, _standing(every, on, shaft))
        along = fixed_bearing(said, shaft, bearings, push)
        on_bearings[n] = stopped_along(said, shaft, bearings, along)
        fixed.add(along.component.id)
        stopped |= {one.component.id for one in on_bearings[n] if one.stopped}
    made: list[Table] = []
    seats: dict[str, Table] = {}
    for n, shaft in shafts.items():
        gears = _standing(every, on, shaft)
        mine = tuple((names[one.id], middles[one.id]) for one in gears)
        coupling, twisting = coupling_of(said, shaft)
        if coupling is None and flow.left_by(stages, gears):
            coupling = sections_of(said, shaft)[-1].end
            said.notes.append(f"{shaft.said}: position of the coupling not specified; shaft end assumed.")
        bearings = [
            replace(one, stopped=one.component.id in stopped)
            for one in on_bearings[n] if one.joins is None or not one.outside
        ]  # fmt: skip
        for one in bearings:  # between shafts of which the case has no other it comes twice
            for table in bearing_tables(said, one, fixed=one.component.id in fixed):
                seats.setdefault(table.name, table)
        clockwise = flow.driven.speed[flow.bodies[n]] < 0.0
        around = {one.name: called[one.joins.id] for one in bearings if one.joins is not None}
        on_it = OnShaft(mine, coupling, twisting, around)
        made.append(shaft_table(said, shaft, called[n], places[n], on_it, bearings, origin, clockwise=clockwise))
    return [*made, *seats.values()]


def _standing(gears: dict[int, Component], on: dict[int, Component | None], shaft: Component) -> list[Component]:
    return [one for one in gears.values() if on[one.id] is shaft]


def _held(said: Said, shafts: dict[int, Component], places: dict[int, Place]) -> bool:
    """Whether every shaft has sections and bearings that hold it; a note where one has not."""
    for shaft in shafts.values():
        bearings = bearings_of(said, shaft, _Any(), places)
        why = "no sections" if not sections_of(said, shaft) else "no bearings" if not bearings else None
        if len({one.at for one in bearings}) == 1 and not any(one.tilts(said) for one in bearings):
            why = "only one bearing (free to tilt); connections to other shafts are not imported"
        if why:
            said.notes.append(f"{shaft.said} has {why}; shafts and bearings are not imported.")
            return False
    return True


class _Any(dict[int, str]):
    """A name for whatever is asked."""

    def __missing__(self, key: int) -> str:
        return str(key)


def _effects(*, bent: bool, relieved: bool) -> Table:
    keys = [Key(NEIGHBOUR_COUPLING.name, "true"), Key(HERTZ.name, text("load-dependent"))]
    keys += [Key(RELIEF.name, "true", "relief and lead of the gears")] if relieved else []
    keys += [Key(MISALIGNMENT.name, "true", "misalignment from the shafts")] if bent else []
    return Table("effects", tuple(keys))


def _unread(said: Said) -> list[str]:
    """What the model says besides, by type of component: nothing is passed over in silence."""
    left: dict[str, set[str]] = defaultdict(set)
    for component in said.model.components.values():
        for name in component.attributes:
            if (component.id, name) not in said.used:
                left[component.type].add(name)
    return [f"Ignored attributes of {kind}: {', '.join(sorted(names))}." for kind, names in sorted(left.items())]
