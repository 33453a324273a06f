"""How much deeper bands sink beside free end faces than their mirrors say: the table of `fegear.fem.solid.bands`.

An even load over a whole face of two modules is pressed on wider and narrower bands. Half the face on either side of
its middle is watched, and what the change of width does far from the faces is taken off. Takes some minutes.
"""

import json
import math
import sys
from dataclasses import replace

from fegear.fem.solid.bands import bands
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

TOOTH = Tooth(28, BasicRack(1.0, 1.25, 0.25))
WIDTH, RADIUS = 2.0, 13.9
WIDE, NARROW = 0.2, 0.1


def settings(degree, edge):
    section = replace(SolidSettings().section, flank_edge_length=edge, growth=0.4, order=3)
    return replace(SolidSettings(), section=section, least_degree=degree, waves_per_module=1e-3)


def end_slopes(angle, poisson_ratio, degree=20, edge=0.08, wide=WIDE, narrow=NARROW):
    """Acute and obtuse end of a base helix angle [deg]."""
    lean = 1.0 / math.cos(math.radians(angle))
    tau = math.tan(math.radians(angle)) / TOOTH.base_radius
    known = solve_solid(TOOTH, tau, WIDTH, poisson_ratio, 0.7 * TOOTH.root_radius, settings(degree, edge), reach=0)
    found = []
    for a in (wide, narrow):
        pressed = bands(RADIUS, 0.0, 0.5 * WIDTH, a, profile="even")
        halves = bands(RADIUS, [-0.25 * WIDTH, 0.25 * WIDTH], 0.25 * WIDTH, a, profile="even")
        middle = bands(RADIUS, 0.0, 0.15 * WIDTH, a)
        logarithm = (1.0 - poisson_ratio**2) / math.pi * lean / WIDTH * 2.0 * math.log(a)
        found.append([known.deflection(0, w, pressed)[:, 0] + logarithm for w in (halves, middle)])
    (ends, far), (narrow_ends, narrow_far) = found
    return (narrow_ends - ends - narrow_far + far) / lean * WIDTH * (0.5 * WIDTH) / (wide - narrow)


if __name__ == "__main__":
    table = {}
    for nu in (0.0, 0.15, 0.3, 0.45):
        for angle in (0.0, 8.0, 16.0, 24.0, 32.0, 40.0):
            acute, obtuse = end_slopes(angle, nu)
            table.setdefault(nu, {}).update({angle: round(acute, 4), -angle: round(obtuse, 4)})
    json.dump({str(nu): [row[a] for a in sorted(row)] for nu, row in table.items()}, sys.stdout, indent=1)
