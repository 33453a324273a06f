"""Rows against CalculiX: whole gears and pairs on explicit meshes, whose answers are kept."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from functools import cache
from pathlib import Path
from typing import Any

import numpy as np

from fegear.base.arrays import Array
from fegear.base.effects import AT_REST, switched_on
from fegear.contact.plane.engagement import Engagement, Loaded
from fegear.geometry.pair import GearPair, Member
from fegear.verify.kept import kept
from fegear.verify.row import Compared, Rows, near

ROWS = Rows()
_WHOLE = "CalculiX 2.20, frictionless contact of both whole gears"
_PLANE = f"{_WHOLE}: 28/28 teeth, 66,000 nodes (119,000 change 3e-5)"
_RING = f"{_WHOLE}: planet and ring, 23/60 teeth, 54,000 nodes"
_SOLID = "CalculiX 2.20, a whole gear of ten teeth, 43,000 and 110,000 nodes, extrapolated"
_WEB = "CalculiX 2.20, a whole gear of 16 teeth on a web, 153,000 nodes under load, 10,000 in a sector's modes"
_LEANING = "CalculiX 2.20, a whole gear of 16 teeth on a web inclined by 20 deg, 141,000 nodes"
_HOLES = "CalculiX 2.20, whole gears of 16 teeth over six holes in their web, 123,000 nodes each"
_FLANKS = f"{_WHOLE}: 18/18 teeth, 12 deg of helix, 42,000 nodes and more"


# ---- plane pairs ------------------------------------------------------------------------------------------------
@cache
def _plane_pair(corner: bool) -> Engagement:
    from fegear.contact.pair_spec import PairSpec
    from fegear.contact.plane.maker import load_plane
    from fegear.fem.plane.solution import solve_gear
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.gear import Gear
    from fegear.geometry.pair import GearPair
    from fegear.geometry.rack import BasicRack

    tooth, module = Tooth(28, BasicRack(1.0, 1.25, 0.25)), 3.175e-3
    gear = Gear(tooth, module, tooth.root_radius * module / 2.0, 1e-3)
    if corner:
        return replace(_plane_pair(False), corner_contact=True)
    solved = solve_gear(gear, reach=3, estimate_error=False)
    spec = PairSpec(GearPair(gear, gear), (350.0,), corner_contact=False)
    return load_plane(spec, (solved, solved)).engagement


def _at(place: float, corner: bool = False) -> Loaded:
    """Under 350 N on 1 mm of face, at a roll position [m]."""
    engagement = _plane_pair(corner)
    return engagement.solve(engagement.grid([place]), [350.0])


@ROWS.add("transmission error of a loaded spur pair", "program", _PLANE)
def calculix_transmission_error() -> Iterator[Compared]:
    """Two pairs in contact, and one with the tips kept from touching."""
    for place, wanted in ((3.0e-3, 17.361), (1.5e-3, 25.467)):
        yield from near(_at(place).transmission_error[0, 0] * 1e6, wanted, 1e-3)


@ROWS.add("load sharing of a spur pair", "program", _PLANE)
def calculix_load_sharing() -> Iterator[Compared]:
    """Loads of two pairs, of the whole load."""
    state = _at(3.0e-3)
    pitch = _plane_pair(False).pair.base_pitch
    for place, wanted in ((3.0e-3, 193.6), (3.0e-3 - pitch, 156.4)):
        row = int(np.argmin(np.abs(state.pair_x[:, 0] - place)))
        yield from near(state.loads[row, 0, 0], wanted, 1e-3, scale=350.0)


@ROWS.add("corner contact outside the path of contact", "program", _PLANE)
def calculix_corner() -> Iterator[Compared]:
    """A corner .197 mm before the path: gap, its load and the transmission error."""
    state = _at(1.5e-3, corner=True)
    row = int(np.argmin(state.pair_x[:, 0] + np.where(state.loads[:, 0, 0] > 0.0, 0.0, 1.0)))
    yield from near(state.transmission_error[0, 0] * 1e6, 18.56, 0.02)
    yield from near(state.loads[row, 0, 0], 125.0, 0.02)
    yield from near(state.grid.contacts.gap[row, 0] * 1e6, 1.05, 0.02)


@ROWS.add("maximum root stress (tension side) of a loaded spur pair", "program", _PLANE)
def calculix_root_tension() -> Iterator[Compared]:
    """Both gears, both pairs in contact."""
    from fegear.contact.plane.root_stress_history import root_stress_history
    from fegear.geometry.pair import MEMBERS

    engagement, state = _plane_pair(False), _at(3.0e-3)
    here, behind = (
        int(np.argmin(np.abs(state.pair_x[:, 0] - place))) for place in (3e-3, 3e-3 - engagement.pair.base_pitch)
    )
    for member, wanted in zip(MEMBERS, ((194.0, 102.2), (136.5, 190.3)), strict=True):
        stress = root_stress_history(engagement, state, member).stress[:, 0, 0]
        yield from near(stress[[here, behind]] * 1e-6, wanted, 5e-3)


# ---- a planet in its ring ---------------------------------------------------------------------------------------
@cache
def _planet_and_ring() -> Engagement:
    from fegear.case.built.pair_spec import pair_spec
    from fegear.case.reading import build_scene
    from fegear.contact.plane.maker import load_plane
    from fegear.fem.plane.solution import solve_gear

    gears = {
        "planet": {"teeth": 23, "profile_shift": 0.3, "bore_radius": "22 mm"},
        "ring": {
            "internal": True, "teeth": 60, "profile_shift": -0.3, "tip_diameter": "236 mm", "rim_thickness": "16 mm",
            "cutter": {"teeth": 25, "profile_shift": 0.1, "addendum": 1.25, "tip_radius": 0.2},
            "thickness_allowance": "80 um",
        },
    }  # fmt: skip
    common = {"module": "4 mm", "face_width": "40 mm"}
    case = {
        "results": ["load-sharing"],
        "gear": {name: gear | common for name, gear in gears.items()},
        "pair": {"I": {"driver": "planet", "driven": "ring", "torque": "500 N*m"}},
        "effects": switched_on(*AT_REST),
    }
    spec = pair_spec(build_scene(case, "case", Path()), "I")
    solved = [solve_gear(gear, reach=3, estimate_error=False) for gear in (spec.pair.driver, spec.pair.driven)]
    return load_plane(spec, solved).engagement


def _ring_state(position: str) -> tuple[dict[str, Any], Loaded]:
    """What CalculiX gave at a position, and fegear's solution under the load of some 290 N/mm with its approach."""
    engagement = _planet_and_ring()
    pair = engagement.pair
    place = pair.x_start + {"two pairs": 0.25, "one pair and a tip corner": 0.97}[position] * pair.base_pitch
    known = kept("ring_calculix")[position]
    return known, under_approach(engagement, place, 290e3 * pair.face_width, known["approach_um"] * 1e-6)


def under_approach(engagement: Engagement, x: float, load: float, approach: float) -> Loaded:
    """Solution at a roll position [m] under the load near to one [N] that makes the gears approach so far [m]."""
    grid, total = engagement.grid([x]), load
    for _ in range(4):  # Newton's method on a nearly straight line
        state = engagement.solve(grid, [total])
        total += float(state.local_stiffness[0, 0]) * (approach - float(state.transmission_error[0, 0]))
    return engagement.solve(grid, [total])


def _ring_loads(position: str, allowed: float) -> Iterator[Compared]:
    known, state = _ring_state(position)
    for number, load in zip(state.grid.contacts.number, state.loads[:, 0, 0], strict=True):
        if str(number) in known["loads"]:
            mine = load / _planet_and_ring().pair.face_width * 1e-3
            yield from near(mine, known["loads"][str(number)], allowed, scale=290.0)


@ROWS.add("load sharing of planet and ring", "program", _RING)
def calculix_planet_and_ring() -> Iterator[Compared]:
    """Loads of two pairs under the same approach, of the whole load."""
    yield from _ring_loads("two pairs", 2e-3)


@ROWS.add("corner contact of a ring gear", "program", _RING)
def calculix_ring_corner() -> Iterator[Compared]:
    """Loads of a pair and of a tip corner under the same approach, of the whole load."""
    yield from _ring_loads("one pair and a tip corner", 5e-3)


@ROWS.add("root tension of planet and ring", "program", _RING)
def calculix_ring_root_tension() -> Iterator[Compared]:
    """Both gears, two pairs in contact."""
    from fegear.contact.plane.root_stress_history import root_stress_history
    from fegear.geometry.pair import MEMBERS

    known, state = _ring_state("two pairs")
    for member in MEMBERS:
        stress = root_stress_history(_planet_and_ring(), state, member).stress[:, 0, 0] * 1e-6
        for number, one in zip(state.grid.contacts.number, stress, strict=True):
            if f"{member} {number}" in known["root_tension"]:
                yield from near(one, known["root_tension"][f"{member} {number}"], 8e-3)


# ---- solid gears ------------------------------------------------------------------------------------------------
def _extrapolated(case: str, *keys: str) -> Array:
    """Of two meshes of quadratic elements, edges of the second half as long: third order."""
    coarse, fine = (kept("solid_calculix")[case][level] for level in ("coarse", "fine"))
    for key in keys:
        coarse, fine = coarse[key], fine[key]
    return np.array(fine) + (np.array(fine) - np.array(coarse)) / 7.0


#: Places along the face where root stresses are compared, in modules.
_STATIONS = np.array([-1.9, -1.5, -1.0, -0.5, 0.0, 0.5, 1.0, 1.5, 1.9])


@cache
def _solid(case: str) -> tuple[Any, dict[str, Any]]:
    """The solved gear and its pressed bands by name."""
    from dataclasses import replace

    from fegear.fem.solid.bands import bands
    from fegear.fem.solid.settings import SolidSettings
    from fegear.fem.solid.solution import solve_solid
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.rack import BasicRack

    tooth, half = Tooth(10, BasicRack(1.0, 1.25, 0.25), 0.55), 2.0
    twist = math.tan(math.radians(kept("solid_calculix")[case]["helix_angle"])) / tooth.pitch_radius
    settings = replace(SolidSettings().scaled(1.2), waves_per_module=3.0)
    places = {"middle": (0, 0.0), "beside": (0, 1.0), "front": (0, half), "back": (0, -half), "next": (1, 0.0)}
    pressed = {}
    for name, (k, top) in places.items():
        low, high = max(top - 0.5, -half), min(top + 0.5, half)
        pressed[name] = k, bands(5.5, top, top - low, 0.25, after=high - top)
    return solve_solid(tooth, twist, 2.0 * half, 0.3, 2.5, settings, reach=1), pressed


def _solid_deflections(case: str) -> Iterator[Compared]:
    solution, pressed = _solid(case)
    for loaded in ("middle", "front"):
        own = float(_extrapolated(case, "deflection", loaded, loaded))
        for name, (k, band) in pressed.items():
            if name in kept("solid_calculix")[case]["fine"]["deflection"][loaded]:
                mine = float(solution.deflection(k, band, pressed[loaded][1])[0, 0])
                yield from near(mine, _extrapolated(case, "deflection", loaded, name), 0.018, scale=own)


def _solid_stresses(case: str) -> Iterator[Compared]:
    solution, pressed = _solid(case)
    for loaded in ("middle", "front"):
        for side in ("tension", "compression"):
            wanted = _extrapolated(case, side, loaded)
            mine = solution.largest_root_stress(0, side, pressed[loaded][1], _STATIONS)[0][:, 0]
            yield from near(mine, wanted, 0.018, scale=float(np.abs(wanted).max()))


@ROWS.add("deflections of a solid helical gear", "program", _SOLID)
def calculix_solid_deflection() -> Iterator[Compared]:
    """Loaded in the middle and at the front of the face, 20 degrees of helix; of the loaded band's own deflection."""
    yield from _solid_deflections("helical")


@ROWS.add("root stress of a solid helical gear", "program", _SOLID)
def calculix_solid_root_stress() -> Iterator[Compared]:
    """Nine stations along the fillet, tension and compression, of the largest."""
    yield from _solid_stresses("helical")


# ---- gears on a web ---------------------------------------------------------------------------------------------
#: Their holes: number, radius of the circle of their middles, radius of each [modules].
_SIX = (6, 4.35, 0.9)


@cache
def _on_a_web(which: str) -> tuple[Any, list[Any]]:
    """The solved gear, and bands at five places from end to end."""
    from dataclasses import replace

    from fegear.fem.solid.bands import bands
    from fegear.fem.solid.settings import SolidSettings
    from fegear.fem.solid.solution import solve_solid

    tooth, body = _web_gear(which)
    settings = replace(SolidSettings().scaled(1.2 if which == "off" else 1.6), waves_per_module=2.5)
    places = ((max(top - 0.5, -2.0), top, min(top + 0.5, 2.0)) for top in (-2.0, -1.0, 0.0, 1.0, 2.0))
    pressed = [bands(8.2, top, top - low, 0.25, after=high - top) for low, top, high in places]
    return solve_solid(tooth, 0.0, 4.0, 0.3, 2.0, settings, body=body), pressed


def _web_gear(which: str) -> tuple[Any, Any]:
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.gear_body import GearBody, WebHoles
    from fegear.geometry.rack import BasicRack

    web = (-0.5, 0.5) if which in ("middle", "holes") else (-1.5, -0.5)
    lean = math.tan(math.radians(20.0)) if which == "inclined" else 0.0
    holes = WebHoles(*_SIX) if which == "holes" else None
    return Tooth(16, BasicRack(1.0, 1.25, 0.25), 0.2), GearBody(5.7, 3.0, web, (-2.0, 2.0), lean, holes)


def _web_deflections(solution: Any, pressed: list[Any], known: Any, allowed: float) -> Iterator[Compared]:
    """Of each loaded band's own."""
    for at, wanted in enumerate(known["deflection"]):
        found = [float(solution.deflection(0, band, pressed[at])[0, 0]) for band in pressed]
        yield from near(found, wanted, allowed, scale=wanted[at])


def _web_tensions(solution: Any, pressed: list[Any], known: Any) -> Iterator[Compared]:
    """Of the largest under each load."""
    for load, wanted in zip(pressed, known["tension"], strict=True):
        found = solution.largest_root_stress(0, "tension", load, _STATIONS)[0][:, 0]
        yield from near(found, wanted, 0.01, scale=max(wanted))


@ROWS.add("deflections of a gear on an offset web", "program", _WEB)
def calculix_web_deflection() -> Iterator[Compared]:
    """Five places along the face under a load at each of them; of the loaded band's own deflection."""
    yield from _web_deflections(*_on_a_web("off"), kept("gear_body_calculix")["off"], 0.008)


@ROWS.add("root stress of a gear on an offset web", "program", _WEB)
def calculix_web_root_tension() -> Iterator[Compared]:
    """Along the face under a load at each of five places, of the largest."""
    yield from _web_tensions(*_on_a_web("off"), kept("gear_body_calculix")["off"])


@ROWS.add("deflections of a gear on an inclined web", "program", _LEANING)
def calculix_inclined_web_deflection() -> Iterator[Compared]:
    """Five places along the face under a load at each of them; of the loaded band's own deflection."""
    yield from _web_deflections(*_on_a_web("inclined"), kept("gear_body_calculix")["inclined"], 0.008)


@ROWS.add("root tension of a gear on an inclined web", "program", _LEANING)
def calculix_inclined_web_root_tension() -> Iterator[Compared]:
    """Along the face under a load at each of five places, of the largest."""
    yield from _web_tensions(*_on_a_web("inclined"), kept("gear_body_calculix")["inclined"])


def _over_holes() -> Iterator[tuple[Any, list[Any], Any]]:
    """A tooth above a hole, and one between two, of one solution, each with what CalculiX gave on a gear of its own."""
    from fegear.fem.solid.tooth_over_holes import tooth_over_holes

    solution, pressed = _on_a_web("holes")
    for which, tooth in (("below", 0), ("between", 4)):
        yield tooth_over_holes(solution, tooth), pressed, kept("web_holes_calculix")[which]


@ROWS.add("deflections of teeth over the holes of a web", "program", _HOLES)
def calculix_web_holes_deflection() -> Iterator[Compared]:
    """A tooth above a hole and one between two, at five places along the face; of the loaded band's own deflection."""
    for solution, pressed, known in _over_holes():
        yield from _web_deflections(solution, pressed, known, 0.008)


@ROWS.add("root tension of teeth over the holes of a web", "program", _HOLES)
def calculix_web_holes_root_tension() -> Iterator[Compared]:
    """A tooth above a hole and one between two, along the face under five loads, of the largest."""
    for solution, pressed, known in _over_holes():
        yield from _web_tensions(solution, pressed, known)


@ROWS.add("natural frequencies of a gear on a web", "program", _WEB)
def calculix_web_frequencies() -> Iterator[Compared]:
    """Umbrella and torsion of the rim, with coarse elements."""
    from dataclasses import replace

    from fegear.fem.solid.body_modes import body_modes
    from fegear.fem.solid.settings import SolidSettings

    tooth, body = _web_gear("middle")
    settings = SolidSettings()
    settings = replace(settings, section=replace(settings.section.scaled(4.0), order=2))
    modes = body_modes(tooth, 0.0, 4.0, 0.3, 2.0, settings, body, diameters=0, each=2, fineness=0.6).modes
    found = [mode.frequency for mode in modes]
    yield from near(found, kept("gear_body_calculix")["middle"]["frequencies"][0], 0.005)


# ---- loaded flanks ----------------------------------------------------------------------------------------------
#: Roll positions as shares of a base pitch after the start of the path.
_PLACES = {"two whole lines": 0.25, "a line that ends at the tip": 0.02}


@cache
def _flanks() -> tuple[GearPair, dict[Member, Any]]:
    from fegear.fem.solid.settings import solid_settings
    from fegear.fem.solid.solution import solve_solid
    from fegear.geometry.external_tooth import Tooth
    from fegear.geometry.gear import Gear, Material
    from fegear.geometry.pair import MEMBERS, GearPair
    from fegear.geometry.rack import BasicRack

    tooth = Tooth(18, BasicRack(1.0, 1.25, 0.25), 0.0, helix_angle=math.radians(12.0))
    bore = 0.5 * tooth.root_radius * 1e-3
    steel = Material(206.8e9, 0.3)
    right, left = Gear(tooth, 1e-3, bore, 3e-3, steel, hand="right"), Gear(tooth, 1e-3, bore, 3e-3, steel, hand="left")
    pair = GearPair(right, left)
    solved: dict[Member, Any] = {}
    for member in MEMBERS:
        gear = pair.gear(member)
        size = gear.twist * 1e-3, gear.face_width / 1e-3, gear.material.poisson_ratio, gear.bore_radius / 1e-3
        solved[member] = solve_solid(tooth, *size, solid_settings(1e-2), reach=1)
    return pair, solved


def _tilt_gap(pair: Any, lines: Any, over_face: float) -> Array:
    """What turning the driver in the plane of action opens, `over_face` from end to end [m], less its mean.

    CalculiX' driver turns about its own middle, fegear's about its axis: what is the same everywhere is the difference.
    """
    from fegear.contact.wide.gaps import FlankGaps
    from fegear.contact.wide.lines import base_twist
    from fegear.geometry.shaft_tilt import ShaftTilt

    turn, alpha = over_face / pair.face_width, pair.working_pressure_angle
    tilt = ShaftTilt(in_plane=turn * math.sin(alpha), out_of_plane=turn * math.cos(alpha))
    even = turn * base_twist(pair) * float(pair.flank_curvature_radius(0.0, "driver"))
    return np.where(lines.present, FlankGaps(tilt=tilt).at(pair, lines) - even, 0.0)


@cache
def _pressed(position: str, tilt: float) -> tuple[Any, Any]:
    """Lines and contact under 900 N, the driver tilted by so many um over the face."""
    from fegear.contact.wide.compliance import flank_compliance
    from fegear.contact.wide.lines import contact_lines
    from fegear.contact.wide.load_sharing import solve_contact
    from fegear.contact.wide.tip_edges import usual_gap

    pair, gears = _flanks()
    roll, load = pair.x_start + _PLACES[position] * pair.base_pitch, 900.0
    lines = contact_lines(pair, [roll], 0.25e-3, most_gap=usual_gap(pair, load))
    gap = _tilt_gap(pair, lines, tilt * 1e-6)
    return lines, solve_contact(flank_compliance(pair, gears, lines, load), gap, np.array([load]))


def _steps(*levels: str) -> Iterator[tuple[dict[str, Any], Any, Any]]:
    """What CalculiX gave on meshes of some levels, and fegear's lines and contact."""
    for position, found in kept("pair_calculix").items():
        for level in levels:
            for step in found[level]["steps"]:
                yield step, *_pressed(position, step["tilt_um"])


@ROWS.add("transmission error of loaded helical flanks", "program", _FLANKS)
def calculix_flanks() -> Iterator[Compared]:
    """Approach under 900 N, aligned and tilted, where contact lines are whole and where one ends at the tip."""
    for step, _, contact in _steps("coarse", "fillets"):
        load = float(np.mean(list(step["load_by_bore"].values())))
        wanted = step["approach_um"] * 1e-6 - (load - 900.0) / contact.stiffness[0, 0]
        yield from near(contact.approach[0, 0], wanted, 0.01)


@ROWS.add("load sharing of loaded helical flanks", "program", _FLANKS)
def calculix_flank_shares() -> Iterator[Compared]:
    """Shares of the tooth pairs, of the whole load."""
    for step, lines, contact in _steps("coarse", "fillets"):
        total = sum(map(sum, step["quarters"].values()))
        for at in lines.at(0):
            share = float(contact.force[0, at, 0].sum()) / 900.0
            theirs = sum(step["quarters"][str(int(lines.pair[0, at.start]))]) / total
            yield from near(share, theirs, 0.02, scale=1.0)


@ROWS.add("root stress of loaded helical flanks", "program", _FLANKS)
def calculix_flank_root_stress() -> Iterator[Compared]:
    """Largest root tension of both gears, on CalculiX' finer fillets, with the driver tilted."""
    from fegear.contact.wide.root_stress import rooted_lines
    from fegear.geometry.pair import MEMBERS

    pair, gears = _flanks()
    stations = np.linspace(-1.4, 1.4, 15) * 1e-3
    for step, lines, contact in _steps("fillets"):
        scale = 900.0 / sum(map(sum, step["quarters"].values()))
        for member in MEMBERS:
            rooted = rooted_lines(pair, member, lines, gears[member], coupling=True)
            tension = rooted.stress("tension", contact.force[:, :, 0], stations).value.max() * 1e-6
            wanted = max(max(v) for key, v in step["root_stress"].items() if key.startswith(f"{member} tension"))
            yield from near(tension, wanted * scale, 0.03)
