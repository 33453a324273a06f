"""What 2,000 draws of cases/pinion_and_wheel.toml inside tolerance class 6 take, with everything from cold.

    python benchmarks/bench_robustness.py [DRAWS]

Printed: seconds on the wall and of processors (this process and its workers) for the whole run, with the tooth shapes,
and the same with the search for the best tip reliefs, which draws three states of relief.
"""

from __future__ import annotations

import resource
import sys
import time
from pathlib import Path

from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import read_scene
from fegear.engine.executor import Executor
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

CASE = Path(__file__).resolve().parents[1] / "cases" / "pinion_and_wheel.toml"


def _processor_seconds() -> float:
    return sum(
        used.ru_utime + used.ru_stime
        for used in map(resource.getrusage, (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    )


def main() -> None:
    """Measure and print."""
    draws = int(sys.argv[1]) if len(sys.argv) > 1 else 2000
    common = [
        'results=["robustness"]', "gear.pinion.tolerance_class=6", "gear.wheel.tolerance_class=6",
        'gear.pinion.thickness_allowance="50 um"', 'robustness.centre_distance="20 um"', f"robustness.draws={draws}",
    ]  # fmt: skip
    for name, more in (("draws alone", []), ("with the best reliefs", ["robustness.reliefs.draws=512"])):
        scene = read_scene(CASE, [*common, *more])
        plan = make_plan(scene, STAGES)
        wall, processors = time.perf_counter(), _processor_seconds()
        run_plan(scene, plan, cache=SolutionCache(), executor=Executor())
        wall, processors = time.perf_counter() - wall, _processor_seconds() - processors
        print(f"{name}: {draws} draws in {wall:.1f} s, {processors:.1f} s of processors")


if __name__ == "__main__":
    main()
