"""Write unusual_gears.json: gears and contacts at which two levels of fegear's elements might be wrong alike.

Short and sharp fillets, few teeth, thin rims, undercut, roundings and chamfers; contacts from the start of the involute
to the tip corner, narrower than any mesh of fegear's resolves and as wide as a flank holds. Solved as whole gears by
scikit-fem (whole_gear_by_scikit_fem.py), good to 1e-5 in c_self, 2e-5 in root stress and 2e-6 of c_self in c_next.
Run by hand; it takes ten minutes of processor and 3 GB:

python tests/golden/make_unusual_gears.py [NAME ...]
"""

import json
import math
import sys
from pathlib import Path

import numpy as np
from whole_gear_by_scikit_fem import whole_gear

from fegear.geometry.curves import arc_length
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

HERE = Path(__file__).parent
USUAL = {"x": 0.0, "tip": 0.25, "angle": 20.0, "addendum": 1.0, "dedendum": 1.25, "nu": 0.3, "plane": "strain"}
GEARS = {
    "z 8, bore .4": {"teeth": 8, "x": 0.4, "bore": 0.4},
    "z 8, undercut": {"teeth": 8, "x": 0.1, "tip": 0.3, "bore": 0.5},
    "z 10, undercut": {"teeth": 10, "bore": 0.5},
    "z 5, bore .3": {"teeth": 5, "x": 0.4, "tip": 0.2, "addendum": 0.8, "bore": 0.3},
    "z 6": {"teeth": 6, "x": 0.4, "addendum": 0.9, "bore": 0.4},
    "z 9, rim": {"teeth": 9, "x": 0.5, "bore": 0.9},
    "z 12": {"teeth": 12, "x": 0.3, "bore": 0.6, "plane": "stress"},
    "z 15, x .7": {"teeth": 15, "x": 0.7, "bore": 0.5},
    "z 17": {"teeth": 17, "bore": 0.5},
    "z 20, rim": {"teeth": 20, "bore": 0.93},
    "z 28, usual": {"teeth": 28, "bore": 0.5},
    "z 24, long": {"teeth": 24, "addendum": 1.2, "dedendum": 1.5, "tip": 0.3, "bore": 0.5, "plane": "stress"},
    "z 25, 25 degrees": {"teeth": 25, "angle": 25.0, "bore": 0.5, "plane": "stress"},
    "z 25, 14.5 degrees": {"teeth": 25, "angle": 14.5, "x": 0.1, "bore": 0.5, "nu": 0.25},
    "z 30, nu .49": {"teeth": 30, "x": 0.2, "bore": 0.5, "nu": 0.49},
    "z 30, rack tip .02": {"teeth": 30, "x": 0.5, "tip": 0.02, "bore": 0.6},
    "z 33, chamfer": {"teeth": 33, "x": 0.1, "bore": 0.5, "tip_chamfer": 0.05},
    "z 35, x -.4": {"teeth": 35, "x": -0.4, "bore": 0.6},
    "z 40, rounding": {"teeth": 40, "bore": 0.7, "tip_rounding": 0.1},
    "z 45, rack tip .1": {"teeth": 45, "x": 0.8, "tip": 0.1, "bore": 0.6},
    "z 50, full fillet": {"teeth": 50, "x": 0.2, "tip": 0.38, "bore": 0.6},
    "z 60, rack tip .05": {"teeth": 60, "x": 0.9, "tip": 0.05, "bore": 0.7},
    "z 80, sharp rack": {"teeth": 80, "tip": 0.01, "bore": 0.7},
    "z 80, sharp rack, x .8": {"teeth": 80, "x": 0.8, "tip": 0.0, "bore": 0.7},
    # Drawn after fillet edges followed a radius of curvature of .005 modules: of .009 and .0022 modules.
    "z 45, sharp rack, x .8": {"teeth": 45, "x": 0.8, "tip": 0.0, "bore": 0.6},
    "z 36, sharp rack, x 1.05": {"teeth": 36, "x": 1.05, "tip": 0.0, "addendum": 0.7, "bore": 0.5},
}


def tooth_of(gear):
    """The tooth of one of these gears."""
    g = USUAL | gear
    rack = BasicRack(g["addendum"], g["dedendum"], g["tip"], math.radians(g["angle"]))
    more = {key: g[key] for key in ("tip_rounding", "tip_chamfer") if key in g}
    return Tooth(g["teeth"], rack, g["x"], **more)


def contacts_of(tooth):
    """Arc lengths from the start of the flank and half-widths [modules]."""
    end = float(arc_length(tooth.involute)[1][-1])
    return [
        (0.006, 0.005), (0.02, 0.02), (0.05, 0.02), (0.1, 0.02), (0.04, 0.002), (0.3 * end, 0.02), (0.45 * end, 0.02),
        (0.55 * end, 0.1), (0.5 * end, min(0.5, 0.45 * end)), (0.7 * end, 0.02), (0.85 * end, 0.02), (end - 0.1, 0.02),
        (end - 0.045, 0.02), (end - 0.021, 0.02), (end - 0.0015, 0.0014), (end - 0.012, 0.005), (end - 0.05, 0.002),
        (end - 0.3, 0.2),
    ]  # fmt: skip


def largest(arc, stress, sign, end):
    """Largest value of smooth curves: of a polynomial through the twenty points round the largest, up to an end."""
    found = []
    for j in range(stress.shape[1]):
        s, y = arc[arc < end[j]], sign * stress[arc < end[j], j]
        top = int(np.argmax(y))
        first = int(np.clip(top - 10, 0, max(s.size - 20, 0)))
        few = slice(first, first + 20)
        fit = np.polynomial.chebyshev.Chebyshev.fit(s[few], y[few], min(7, s[few].size - 1))
        places = np.linspace(s[max(top - 2, 0)], s[min(top + 2, s.size - 1)], 401)
        found.append(sign * float(fit(places).max()))
    return found


def told(gear):
    """One gear's values at its contacts."""
    g, tooth = USUAL | gear, tooth_of(gear)
    contacts = contacts_of(tooth)
    solved = whole_gear(tooth, g["bore"] * tooth.root_radius, g["nu"], g["plane"], contacts)
    place, width = np.array(contacts).T
    # Where a contact presses on the fillet, the stress there is its own pressure.
    end = float(arc_length(tooth.fillet)[1][-1]) - np.maximum(1.05 * width - place, 0.0)
    start = max(tooth.form_radius, tooth.base_radius)
    return gear | {
        "radii": np.sqrt(start**2 + 2.0 * tooth.base_radius * place).tolist(),
        "half_widths": width.tolist(),
        **{name: solved[name].tolist() for name in ("c_self", "c_next", "c_prev")},
        "root_tension": largest(*solved["tension"], 1.0, end),
        "root_compression": largest(*solved["compression"], -1.0, np.full(place.size, np.inf)),
    }


if __name__ == "__main__":
    out = HERE / "unusual_gears.json"
    known = json.loads(out.read_text()) if out.exists() else {}
    for name in sys.argv[1:] or GEARS:
        known[name] = told(GEARS[name])
        out.write_text(json.dumps(known, indent=1) + "\n")
        print(name, flush=True)
