"""What verifying twenty variants of a sizing by 3D gears costs: helical pairs whose faces are 15 modules wide.

Run as ``python benchmarks/twenty_solids.py [PAIRS] [--jobs N]``: pairs of m_n 2.5 mm, 15 degrees, each the run of its
own case as `[sizing]` has it (transmission error and root stress with estimated errors), nothing recalled. In one
process, with CPU seconds and memory of each pair, or in N processes as `[sizing]` computes them, with the run time.
"""

from __future__ import annotations

import argparse
import math
import resource
import statistics
import time

from fegear.base.solution_cache import SolutionCache
from fegear.design.sizing.space import Variant
from fegear.engine.executor import Executor, map_points
from fegear.results.sizing.by_fe import COARSE, compute_variant
from fegear.results.sizing.variant_case import case_of_variant

RESULTS = ("transmission-error", "root-stress-history")
MODULE, WIDTH, HELIX = 2.5e-3, 15, math.radians(15.0)
ASKED = {
    "power": 2900.0, "speed": 725.0 * math.pi / 30.0, "strength": {"material": "case-hardened-steel"},
    "operation": {"application_factor": 1.25, "life": 5000.0 * 3600.0},
}  # fmt: skip


def variant(i: int) -> Variant:
    """A pair of a ratio of about 2.5."""
    teeth = 20 + i // 2, round(2.5 * (20 + i // 2)) + 1 + i % 2
    pitch = [MODULE * z / math.cos(HELIX) for z in teeth]
    return Variant(
        teeth, (0.0, 0.0), (pitch[0] + 2.0 * MODULE, pitch[1] + 2.0 * MODULE), MODULE, math.radians(20.0), HELIX,
        1.0, 1.25, 0.38, 0.5 * sum(pitch), WIDTH * MODULE,
    )  # fmt: skip


def point(i: int) -> dict[str, object]:
    """What computes the numbers of a pair."""
    document = case_of_variant(ASKED, variant(i), RESULTS, width="solid", tolerance=COARSE)
    return {"document": document, "folder": ".", "estimates": True}


def timed(number: int) -> tuple[float, float, dict[str, float]]:
    """CPU time [s] and memory of the process so far [GB] of a pair, and its numbers."""
    started = time.process_time()
    numbers = compute_variant(point(number), SolutionCache())
    memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
    return time.process_time() - started, memory, numbers


def main() -> None:
    """Print a line for every pair, and their mean."""
    parser = argparse.ArgumentParser()
    parser.add_argument("pairs", type=int, nargs="?", default=20)
    parser.add_argument("--jobs", type=int, default=1)
    asked = parser.parse_args()
    executor, seconds = Executor(here=True) if asked.jobs == 1 else Executor(workers=asked.jobs), []
    started = time.perf_counter()
    for i, (took, memory, numbers) in enumerate(map_points(timed, list(range(asked.pairs)), executor)):
        seconds.append(took)
        print(
            f"{'/'.join(str(z) for z in variant(i).teeth):>7s}  {took:5.1f} s  {memory:4.2f} GB  "
            f"peak to peak {1e6 * numbers['te']:.4f} +- {1e6 * numbers['te_error']:.4f} um",
            flush=True,
        )
    print(f"mean {statistics.mean(seconds):.1f} s of CPU time; run time {time.perf_counter() - started:.0f} s")


if __name__ == "__main__":
    main()
