"""What a tolerance costs over the cheapest settings that hold it, which only he knows who knows the true error.

Run as ``python benchmarks/cost_of_a_tolerance.py [GEARS]``: the gears of three cases (external, a ring, a pinion and
its wheel), whose true errors are those from level 2, and the first of the random gears of ``tests/golden`` (seven by
default), whose converged c_0, c_1 and root stresses are kept there. For each tolerance the cheapest fixed settings
whose true error is within it are looked for among orders 2 to 4 on all levels. Then ``accuracy.tolerance`` and they
are solved in turn, and the median of the ratios of their processor seconds is printed twice: over fixed settings as a
run solves them, with an estimate of their error, and over them without one. Half a minute a gear.
"""

from __future__ import annotations

import importlib
import json
import sys
import time
from dataclasses import replace
from functools import partial
from itertools import product
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.case.reading import read_scene
from fegear.fem.plane.settings import COARSEST_LEVEL, MeshSettings, settings_at
from fegear.fem.plane.solution import solve_gear, solve_to_tolerance
from fegear.geometry.gear import Gear, Material

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator

    from fegear.fem.plane.gear import GearInfluence

ROOT = Path(__file__).resolve().parents[1]
GOLDEN, CASES = ROOT / "tests" / "golden", ("nasa_four_square", "ring_gear", "pinion_and_wheel")
TOLERANCES = 1e-1, 1e-2, 1e-3
#: Levels of the ladder by halves, one coarser than a tolerance asks for among them; contacts' half-width [modules].
LEVELS, ORDERS, HALF_WIDTH = np.arange(COARSEST_LEVEL - 1.0, -0.9, 0.5), (2, 3, 4), 0.02
#: Level whose values count as true for gears of cases; positions over the flank.
TRUE, POSITIONS = 2.0, 17
PAIRS = 7


def known_values(gear: Gear) -> dict[str, Any]:
    """Of a gear of a case, as those of the random gears: c_0, c_1 and both root stresses at radii over the flank."""
    found = solve_gear(gear, settings_at(TRUE), estimate_error=False)
    radii = np.linspace(found.lowest_radius, found.highest_radius, POSITIONS)
    stresses = {f"root_{side}": found.largest_root_stress(0, side, radii)[0] for side in ("tension", "compression")}
    own = found.self_compliance(radii, HALF_WIDTH * gear.module)
    return {"radii": radii, "c_self": own, "c_next": np.diagonal(found.neighbour(1, radii, radii)), **stresses}


def true_error(found: GearInfluence, known: dict[str, Any]) -> float:
    """The largest relative error over the flank of c_0, c_1 over c_0, and both root stresses."""
    radii = np.clip(known["radii"], found.lowest_radius, found.highest_radius)
    c_0 = np.array(known["c_self"])
    errors = [
        found.self_compliance(radii, HALF_WIDTH * found.gear.module) / c_0 - 1.0,
        (np.diagonal(found.neighbour(1, radii, radii)) - known["c_next"]) / c_0,
        *(
            found.largest_root_stress(0, side, radii)[0] / np.array(known[f"root_{side}"]) - 1.0
            for side in ("tension", "compression")
        ),
    ]
    return float(np.abs(errors).max())


def seconds(job: Callable[[], GearInfluence]) -> tuple[float, GearInfluence]:
    """Processor seconds of a solution and its errors, and what it finds."""
    started = time.process_time()
    found = job()
    found.largest_errors()
    return time.process_time() - started, found


def cheapest(gear: Gear, known: dict[str, Any]) -> dict[float, MeshSettings]:
    """For each tolerance the fixed settings that hold it for the least time (the shorter of two runs)."""
    rows = []
    for order, level in product(ORDERS, LEVELS):
        settings = replace(settings_at(level), order=order)
        runs = [seconds(partial(solve_gear, gear, settings, estimate_error=False)) for _ in range(2)]
        rows.append((min(taken for taken, _ in runs), true_error(runs[0][1], known), settings))
    return {
        tolerance: min((row for row in rows if row[1] <= tolerance), key=lambda row: row[0])[2]
        for tolerance in TOLERANCES
    }


def measure(gear: Gear, known: dict[str, Any]) -> list[tuple[float, float, float, int]]:
    """For each tolerance: cost over the cheapest settings with and without estimate, true error, and rounds."""
    rows = []
    for tolerance, settings in cheapest(gear, known).items():
        jobs = (
            partial(solve_to_tolerance, gear, tolerance),
            partial(solve_gear, gear, settings),
            partial(solve_gear, gear, settings, estimate_error=False),
        )
        turns = [[seconds(job) for job in jobs] for _ in range(PAIRS)]
        found = turns[0][0][1]
        over, alone = np.median([[one[0][0] / one[i][0] for i in (1, 2)] for one in turns], axis=0).tolist()
        rows.append((over, alone, true_error(found, known), len(found.rounds)))
    return rows


def gears(count: int) -> Iterator[tuple[str, Gear, dict[str, Any]]]:
    """Names, gears, and what is known of them."""
    for case in CASES:
        for name, gear in read_scene(ROOT / "cases" / f"{case}.toml", ()).gears.items():
            yield f"{case}, {name}", gear, known_values(gear)
    sys.path.insert(0, str(GOLDEN))
    tooth_of = importlib.import_module("make_random_gears").tooth_of
    for g in json.loads((GOLDEN / "random_gears.json").read_text())[:count]:
        tooth = tooth_of(g)
        material = Material(1.0, g["poisson_ratio"])
        gear = Gear(tooth, 1.0, g["bore"] * tooth.root_radius, material=material, plane=g["plane"])
        yield f"random, {tooth.teeth} teeth", gear, g


def main() -> None:
    """Print a table."""
    found = []
    print("gear: ratios with, and without an error estimate of the fixed settings, at", *TOLERANCES)
    for name, gear, known in gears(int(sys.argv[1]) if len(sys.argv) > 1 else 7):
        found.append(measure(gear, known))
        print(f"{name:28}", *(f"{over:6.2f} {alone:5.2f}" for over, alone, *_ in found[-1]), flush=True)
    print("tolerance | with estimate: median, largest | without: median, largest | true error over tolerance | again")
    for i, tolerance in enumerate(TOLERANCES):
        over, alone, error, rounds = np.array(found)[:, i].T
        print(
            f"{tolerance:.0e} | {np.median(over):.2f}, {over.max():.2f} | {np.median(alone):.2f}, {alone.max():.2f} | "
            f"{error.max() / tolerance:.2f} | {(rounds > 1).sum()}"
        )


if __name__ == "__main__":
    main()
