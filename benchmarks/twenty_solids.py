"""What verifying twenty variants of a sizing by 3D gears costs: helical pairs whose faces are 15 modules wide.

Run as ``python benchmarks/twenty_solids.py [PAIRS]``: pairs of m_n 2.5 mm, 15 degrees, each the run of its own case as
`[sizing]` has it (transmission error and root stress with estimated errors), in one process, nothing recalled. CPU
seconds; on two cores twenty take ten times the mean.
"""

from __future__ import annotations

import math
import resource
import statistics
import sys
import time

from fegear.base.solution_cache import SolutionCache
from fegear.design.sizing.space import Variant
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


def main() -> None:
    """Print a line for every pair, and their mean."""
    found = []
    for i in range(int(sys.argv[1]) if len(sys.argv) > 1 else 20):
        document = case_of_variant(ASKED, variant(i), RESULTS, width="solid", tolerance=COARSE)
        started = time.process_time()
        numbers = compute_variant({"document": document, "folder": ".", "estimates": True}, SolutionCache())
        found.append(time.process_time() - started)
        memory = resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1e6
        print(
            f"{'/'.join(str(z) for z in variant(i).teeth):>7s}  {found[-1]:5.1f} s  {memory:4.2f} GB  "
            f"peak to peak {1e6 * numbers['te']:.4f} +- {1e6 * numbers['te_error']:.4f} um",
            flush=True,
        )
    print(f"mean {statistics.mean(found):.1f} s; twenty on two cores {10.0 * statistics.mean(found) / 60.0:.1f} min")


if __name__ == "__main__":
    main()
