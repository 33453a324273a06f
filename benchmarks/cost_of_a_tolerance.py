"""What a tolerance costs over the cheapest ring that holds it, which only he knows who knows the true error.

Run as ``python benchmarks/cost_of_a_tolerance.py [GEARS]``: the first of the random gears of ``tests/golden`` (all
forty by default), whose converged c_0, c_1 and root stresses are kept there. For each tolerance the processor seconds
of what ``accuracy.tolerance`` does (mesh, both orders, estimates, further rounds) over those of one solution without
estimate at the coarsest level whose true error is within it; the least of three runs each. Half a minute a gear.
"""

from __future__ import annotations

import importlib
import json
import sys
import time
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from fegear.fem.plane.settings import COARSEST_LEVEL, settings_at
from fegear.fem.plane.solution import solve_gear, solve_to_tolerance
from fegear.geometry.gear import Gear, Material

if TYPE_CHECKING:
    from collections.abc import Callable

    from fegear.fem.plane.gear import GearInfluence

GOLDEN = Path(__file__).resolve().parents[1] / "tests" / "golden"
TOLERANCES = 1e-2, 1e-3, 1e-4
#: Levels of the ladder by halves, and contacts' half-width [modules].
LEVELS, HALF_WIDTH = np.arange(COARSEST_LEVEL, 3.0, 0.5), 0.02
RUNS = 3


def true_error(found: GearInfluence, known: dict[str, Any]) -> float:
    """The largest relative error over the flank of c_0, c_1 over c_0, and both root stresses."""
    radii = np.clip(known["radii"], found.lowest_radius, found.highest_radius)
    c_0 = np.array(known["c_self"])
    errors = [
        found.self_compliance(radii, HALF_WIDTH) / c_0 - 1.0,
        (np.diagonal(found.neighbour(1, radii, radii)) - known["c_next"]) / c_0,
        *(
            found.largest_root_stress(0, side, radii)[0] / np.array(known[f"root_{side}"]) - 1.0
            for side in ("tension", "compression")
        ),
    ]
    return float(np.abs(errors).max())


def seconds(job: Callable[[], GearInfluence]) -> tuple[float, GearInfluence]:
    """The least processor seconds of some runs, and what one of them finds."""
    taken = []
    for _ in range(RUNS):
        started = time.process_time()
        found = job()
        taken.append(time.process_time() - started)
    return min(taken), found


def measure(gear: Gear, known: dict[str, Any]) -> list[tuple[float, float, int]]:
    """For each tolerance: cost over the cheapest ring's, true error, and rounds."""
    rings = [seconds(partial(solve_gear, gear, settings_at(level), estimate_error=False)) for level in LEVELS]
    errors = np.array([true_error(ring, known) for _, ring in rings])
    costs = np.array([taken for taken, _ in rings])
    rows = []
    for tolerance in TOLERANCES:
        holds = errors <= tolerance
        least = costs[holds.argmax()] if holds.any() else np.nan  # the references end before it
        taken, found = seconds(partial(solve_to_tolerance, gear, tolerance))
        rows.append((taken / least, true_error(found, known), len(found.rounds)))
    return rows


def main() -> None:
    """Print a table."""
    sys.path.insert(0, str(GOLDEN))
    tooth_of = importlib.import_module("make_random_gears").tooth_of
    gears = json.loads((GOLDEN / "random_gears.json").read_text())
    found = []
    for g in gears[: int(sys.argv[1]) if len(sys.argv) > 1 else None]:
        tooth = tooth_of(g)
        material = Material(1.0, g["poisson_ratio"])
        gear = Gear(tooth, 1.0, g["bore"] * tooth.root_radius, material=material, plane=g["plane"])
        found.append(measure(gear, g))
        print(f"{tooth.teeth:4} teeth:", *(f"{ratio:6.2f}" for ratio, *_ in found[-1]), flush=True)
    print("tolerance | over the cheapest ring: median, nine tenths | true error over tolerance: largest | solved again")
    for i, tolerance in enumerate(TOLERANCES):
        ratio, error, rounds = np.array(found)[:, i].T
        middle, most = np.nanquantile(ratio, [0.5, 0.9])
        print(f"{tolerance:.0e} | {middle:.1f}, {most:.1f} | {error.max() / tolerance:.2f} | {(rounds > 1).sum()}")


if __name__ == "__main__":
    main()
