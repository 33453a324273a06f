"""Write solid_gears.json: gears with a width at which two levels of fegear's elements might be wrong alike.

Undercut, thin rims, narrow and wide faces, helices of both hands up to 35 degrees. The references are fegear's own
solid, set up so that they share as little as possible with its usual settings: elements of order 4 on a section of
other edges, more functions along the face and all of them at every node (of faces wider than 8 modules: twice as many
of them), and pressures half as wide, so that little is left for what widths and end faces are exchanged with. The
second reference, between both, shows what the first leaves. Run by hand, ten minutes of processor time and more than
3 GB for the widest gear:

python tests/golden/make_solid_gears.py [first|second] [NAME ...]
"""

import json
import math
import sys
import time
from dataclasses import replace
from pathlib import Path

import numpy as np

from fegear.fem.plane.settings import MeshSettings
from fegear.fem.solid.bands import bands, hats
from fegear.fem.solid.contact import line_compliance
from fegear.fem.solid.influence import contact_line
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

OUT = Path(__file__).parent / "solid_gears.json"
USUAL = {"x": 0.0, "beta": 0.0, "nu": 0.3}
#: Teeth, helix angle [deg] (left hands negative), width [normal modules], bore over root radius.
GEARS = {
    "z 12, undercut": {"teeth": 12, "width": 3.0, "bore": 0.5},
    "z 20, rim": {"teeth": 20, "width": 5.0, "bore": 0.93},
    "z 33, 35 degrees left": {"teeth": 33, "x": 0.2, "beta": -35.0, "width": 3.0, "bore": 0.8},
    "z 17, 10 degrees left": {"teeth": 17, "beta": -10.0, "width": 3.0, "bore": 0.7, "nu": 0.33},
    "z 12, 20 degrees": {"teeth": 12, "x": 0.4, "beta": 20.0, "width": 4.0, "bore": 0.3, "nu": 0.25},
    "z 80, 20 degrees left": {"teeth": 80, "beta": -20.0, "width": 3.0, "bore": 0.9},
    "z 24, 30 degrees": {"teeth": 24, "beta": 30.0, "width": 4.0, "bore": 0.6},
    "z 40, 35 degrees, rim": {"teeth": 40, "beta": 35.0, "width": 5.0, "bore": 0.93},
    "z 56, 10 degrees": {"teeth": 56, "beta": 10.0, "width": 4.0, "bore": 0.4, "nu": 0.28},
    "z 28, 20 degrees left": {"teeth": 28, "beta": -20.0, "width": 6.0, "bore": 0.5},
    "z 120, 30 degrees left, wide": {"teeth": 120, "x": 0.3, "beta": -30.0, "width": 12.0, "bore": 0.85},
    "z 45, 10 degrees, widest": {"teeth": 45, "beta": 10.0, "width": 20.0, "bore": 0.5},
}
#: Middles of the contact lines as shares of the flank's length, half-widths of contacts and of pressed bands.
UP, CONTACTS, PRESSED = (0.25, 0.5, 0.75), (0.02, 0.1), 0.25
#: Nearer to the ends of the flank than this share of it a line is left out.
FOOT = 0.1

_SECTION = MeshSettings(
    root_edge_length=0.14, root_fraction=0.45, flank_edge_length=0.21, tip_edge_length=0.07, junction_edge_length=0.08,
    back_edge_length=0.65, growth=0.55, tip_growth=0.45, side_growth=0.75, body_fraction=1.5, rim_fraction=0.4, order=4,
)  # fmt: skip
_ALL = 1e6


def settings_of(which, width):
    """Of the first reference, or of the second."""
    reach = (_ALL, _ALL) if width <= 8.0 else (5.0, 10.0)
    if which == "first":
        degree = (2.0, 14) if width <= 15.0 else (1.75, 14)
        return SolidSettings(_SECTION, *degree, *reach, band_half_width=0.12)
    section = replace(_SECTION.scaled(1.3), back_edge_length=0.75)
    return SolidSettings(section, 1.7, 12, 4.0, 8.0, band_half_width=0.17)


def tooth_of(gear):
    """Its transverse section."""
    g = USUAL | gear
    rack = BasicRack(1.0, 1.25, 0.25, math.radians(20.0))
    return Tooth(g["teeth"], rack, g["x"], helix_angle=math.radians(abs(g["beta"])))


def problem_of(gear):
    """What `solid_influence` takes, in normal modules."""
    g, tooth = USUAL | gear, tooth_of(gear)
    return tooth, math.copysign(tooth.twist, g["beta"]), g["width"], g["nu"], g["bore"] * tooth.root_radius


def lines_of(gear):
    """Radii and stations of the contact lines that are asked."""
    tooth, tau, width, _, _ = problem_of(gear)
    rb = tooth.base_radius
    low, high = max(tooth.form_radius, rb), tooth.involute_tip_radius
    stations = np.linspace(-0.5, 0.5, 2 * round(min(width, 12.0)) + 1) * width

    def arc(r):
        return (r**2 - rb**2) / (2.0 * rb)

    for share in UP:
        middle = arc(low) + share * (arc(high) - arc(low))
        rolled = math.sqrt(2.0 * rb * middle) - tau * rb * stations
        radius = np.hypot(rb, np.maximum(rolled, 0.0))
        place = (arc(radius) - arc(low)) / (arc(high) - arc(low))
        on = (rolled > 0.0) & (place > FOOT) & (place < 1.0 - FOOT)
        yield radius[on], stations[on]


def pressed_line(solution, radius, stations):
    """Hats as wide up the flank as the usual settings have them, whatever this solution's are."""
    flank = solution.flank
    arc = flank.arc_of_radius(radius)
    room = np.minimum(arc - flank.flank_start, flank.flank_end - arc)
    return hats(radius, stations, np.minimum(0.7 * room, PRESSED), slope=solution.line_slope(radius))


def loads_among(count):
    """Stations whose loads neighbours and fillets answer to: both ends of the line and its middle."""
    return [0, count // 2, count - 1]


def quantities(solution, gear):
    """What is compared: a list over the contact lines of arrays by name."""
    found = []
    for radius, stations in lines_of(gear):
        wide = pressed_line(solution, radius, stations)
        arc = solution.flank.arc_of_radius(radius) - solution.flank.flank_start
        place = arc / (solution.flank.flank_end - solution.flank.flank_start)
        one = {"radius": radius, "stations": stations, "place": place}
        for b in CONTACTS:
            c = line_compliance(solution, contact_line(solution, radius, stations), b)
            one |= {f"own {b}": np.diagonal(c), f"even {b}": c.sum(axis=1), f"beside {b}": np.diagonal(c, 1)}
        few = loads_among(stations.size)
        for k, name in ((1, "next"), (-1, "prev")):
            one[name] = solution.deflection(k, wide, wide)[few]
        pressed = bands(*(getattr(wide, x)[few] for x in ("radius", "zeta", "before", "half_width")),
                        after=wide.after[few], slope=wide.slope[few])  # fmt: skip
        for side in ("tension", "compression"):
            one[side] = solution.largest_root_stress(0, side, pressed, stations)[0]
        found.append(one)
    return found


def told(which, name):
    """The quantities of one gear, by one of the references."""
    started = time.process_time()
    tooth, tau, width, nu, bore = problem_of(GEARS[name])
    solution = solve_solid(tooth, tau, width, nu, bore, settings_of(which, width))
    found = quantities(solution, GEARS[name])
    print(name, which, solution.unknowns, round(time.process_time() - started, 1), "s", flush=True)
    return [{key: np.round(value, 8).tolist() for key, value in line.items()} for line in found]


if __name__ == "__main__":
    which, *names = sys.argv[1:] or ["first"]
    for name in names or GEARS:
        found = told(which, name)
        known = json.loads(OUT.read_text()) if OUT.exists() else {}
        gear = known.setdefault(name, {})
        gear[which] = found
        OUT.write_text(json.dumps(known) + "\n")
