"""Random pairs with an odd tooth, 3D or plane, over a revolution: how stated errors compare with true ones.

The truth is the same pair by finer sections, more functions along the face, narrower bands, panels of half the length
(`true_errors.fine_solid`) and three times as many roll positions: at the crack's tip and mouth, too, where edges are
half as long and rays twice as many. That of plane pairs is of level 2 of the ladder and finer (`true_errors.TRUTH`).

python tests/helpers/random_odd_pairs.py SEED COUNT [--plane] [--first N] [--tolerance T]
"""

import argparse
import sys
import time
from contextlib import ExitStack
from dataclasses import replace
from pathlib import Path
from unittest.mock import patch

import numpy as np

from fegear.base.errors import FegearError
from fegear.base.solution_cache import SolutionCache
from fegear.case.built import solid_influence
from fegear.case.reading import build_scene
from fegear.contact.wide import over_revolution
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.fem.plane.odd import cracked_sector
from fegear.results.catalogue import STAGES
from fegear.results.pair import mesh_stiffness_revolution
from tests.helpers.random_cracks import FINER
from tests.helpers.true_errors import FINEST, PANELS, TRUTH, fine_solid
from tests.helpers.true_errors import drawn as drawn_pair

#: Part of a value that the truth itself may be off.
ROUGH = 5e-5
VALUES = ("mesh_stiffness_min", "mesh_stiffness_min_ordinary", "mesh_stiffness_loss", "te_max", "te_residual_max")
INDICATORS = (
    "residual_rms", "residual_kurtosis", "fm0", "fm4", "m6a", "energy_ratio", "sideband_level_factor"
)  # fmt: skip


def drawn(rng, *, plane=False):
    """A case, which may prove impossible."""
    case = drawn_pair("pair" if plane else "wide pair", rng) | {"results": ["mesh-stiffness-revolution"]}
    kind = rng.choice(["crack", "crack", "crack", "missing", "pit"])
    if kind == "crack":
        odd = {"crack": {
            "tangent_angle": f"{rng.uniform(25.0, 55.0):.2f} deg", "angle": f"{rng.uniform(45.0, 90.0):.2f} deg",
            "depth_ratio": round(float(rng.uniform(0.1, 0.7)), 3),
        }}  # fmt: skip
    elif kind == "missing":
        odd = {"missing": True}
    else:
        low = round(float(rng.uniform(0.45, 0.6)), 3)
        odd = {"pits": [{"roll": low, "face_share": round(float(rng.uniform(0.2, 0.6)), 3)}]}
    if not plane:
        case["pair"]["I"]["width"] = "solid"
    gear = case["gear"][str(rng.choice(["a", "b"]))]
    gear["odd_tooth"] = [{"tooth": int(rng.integers(0, 12)), **odd}]
    case["effects"] |= {"odd_teeth": True, "corner_contact": bool(rng.random() < 0.5 or kind == "missing")}
    return case


def with_pit(case, scene):
    """Pits between the diameters that stand at places of the flank."""
    for name, keys in case["gear"].items():
        for tooth in keys.get("odd_tooth", []):
            for pit in tooth.get("pits", []):
                if "roll" in pit:
                    low, high = scene.gears[name].involute_radii
                    at = pit.pop("roll")
                    ends = (2e3 * (low + part * (high - low)) for part in (at - 0.15, at + 0.15))
                    pit["diameter"] = [f"{end:.4f} mm" for end in ends]
    return case


def plan_of(case, accuracy, estimates=True):
    """The scene of a case, and its plan."""
    scene = replace(build_scene({**case, "accuracy": accuracy}, "odd pairs", Path()), estimates=estimates)
    return scene, make_plan(scene, STAGES)


def case_of(seed, number, *, plane=False):
    """One of a seed's; drawn again until fegear plans it."""
    rng = np.random.default_rng([seed, number])
    for _ in range(200):
        case = drawn(rng, plane=plane)
        try:
            bare = {
                **case,
                "gear": {n: {k: v for k, v in g.items() if k != "odd_tooth"} for n, g in case["gear"].items()},
            }
            case = with_pit(case, build_scene(bare, "odd pairs", Path()))
            plan_of(case, {"tolerance": 1e-2})
        except FegearError:
            continue
        return case
    raise AssertionError("nothing that can be drawn")


def answers(case, accuracy, estimates=True):
    """Places over the revolution; by name values and stated errors; root stress of every tooth of both gears."""
    scene, plan = plan_of(case, accuracy, estimates)
    results = run_plan(scene, plan, cache=SolutionCache())
    tables = {table.name: table for one in results.outcomes.values() for table in one.tables}
    known = {value.name.rpartition(".")[2]: value for one in results.outcomes.values() for value in one.values}
    curves = tables["mesh_stiffness_revolution_I"]
    found = {
        name: (curves.column(name).si, curves.column(f"{name}_error").si if estimates else None)
        for name in ("te",)
    }  # fmt: skip
    names = [name for name in (*VALUES, *INDICATORS) if name in known]  # without a residual some are none
    found |= {name: (np.array([known[name].si]), np.array([known[name].si_error or np.nan])) for name in names}
    roots = {gear: tables[f"root_stress_teeth_I_{gear}"] for gear in ("a", "b")}
    roots = {
        gear: (table.column("root_tension").si, table.column("root_tension_error").si if estimates else None)
        for gear, table in roots.items()
    }
    return curves.column("driver_angle").si, found, roots


def judged(case, tolerance):
    """True and stated errors, largest over the revolution, and the largest value, by what they are of."""
    at, found, roots = answers(case, {"tolerance": tolerance})
    solid = case["pair"]["I"].get("width") == "solid"
    with ExitStack() as finer:
        finer.enter_context(patch.multiple(cracked_sector, **FINER))
        if solid:
            finer.enter_context(patch.object(solid_influence, "settings_of_case", fine_solid))
            finer.enter_context(patch.object(over_revolution.revolving_flanks, "__defaults__", (None, 96)))
            there, truth, true_roots = answers(case | {"load_distribution": {"panels": PANELS}}, FINEST, False)
        else:
            finer.enter_context(patch.object(mesh_stiffness_revolution, "POSITIONS", 300))
            there, truth, true_roots = answers(case, {"tolerance": 1e-6, **TRUTH}, False)
    each = {}
    for name, (value, stated) in found.items():
        true = truth[name][0] if value.size == 1 else np.interp(at, there, truth[name][0])
        size = float(np.abs(true).max())
        each[name] = max(float(np.abs(value - true).max()) - ROUGH * size, 0.0), float(stated.max()), size
    for gear, (value, stated) in roots.items():
        true, size = true_roots[gear][0], float(true_roots[gear][0].max())
        off = np.maximum(np.abs(value - true) - ROUGH * size, 0.0)
        worst = int(np.argmax(off / np.maximum(stated, 1e-9 * size)))  # every tooth has an error of its own
        each[f"root_{gear}"] = float(off[worst]), float(stated[worst]), size
    return each


def main():
    """Judge so many, and print what is worst."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("seed", type=int)
    options.add_argument("count", type=int)
    options.add_argument("--plane", action="store_true")
    options.add_argument("--first", type=int, default=0)
    options.add_argument("--tolerance", type=float, default=1e-2)
    given = options.parse_args()
    for number in range(given.first, given.first + given.count):
        started, case = time.process_time(), case_of(given.seed, number, plane=given.plane)
        try:
            each = judged(case, given.tolerance)
        except FegearError as why:
            print(f"{number}: {why}", flush=True)
            continue
        odd = next(gear["odd_tooth"] for gear in case["gear"].values() if "odd_tooth" in gear)
        print(f"{number}: {odd}, {time.process_time() - started:.0f} s; true / stated, part of the largest:")
        for name, (true, stated, size) in each.items():
            print(
                f"  {name}: {true / max(stated, 1e-300):.2f}, {true / (size or 1.0):.1e}, {stated / (size or 1.0):.1e}",
                flush=True,
            )


if __name__ == "__main__":
    sys.exit(main())
