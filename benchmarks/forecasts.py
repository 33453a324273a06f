"""How far the seconds that `fegear plan` foretells are from those that a run takes, task by task over all the cases.

Run as ``python benchmarks/forecasts.py [CASE ...]``: each case in a process of its own, so that libraries are loaded as
in a run. Processor seconds; tasks below a twentieth of a second count as a twentieth.
"""

from __future__ import annotations

import itertools
import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.engine.plan_in_words import forecast_seconds
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

CASES = Path(__file__).resolve().parents[1] / "cases"
#: Takes minutes on all cores, in processes whose seconds are not this one's.
SKIPPED = ("lin_design_chart",)
LEAST = 0.05


def ratio(foretold: float, taken: float) -> float:
    """Foretold over taken, where anybody cares."""
    return max(foretold, LEAST) / max(taken, LEAST)


def measure(path: Path) -> list[tuple[str, float, float]]:
    """Task, seconds foretold and seconds taken."""
    scene = read_scene(path)
    plan = make_plan(scene, STAGES)
    ends = [time.process_time()]
    run_plan(scene, plan, found=lambda _task, _outcome: ends.append(time.process_time()))
    foretold = forecast_seconds(scene, plan)
    taken = [end - start for start, end in itertools.pairwise(ends)]
    return [(str(step.task), f or 0.0, t) for step, f, t in zip(plan.steps, foretold, taken, strict=True)]


def main() -> None:
    """Print a line for each task and case."""
    if os.environ.get("FORECASTS_ONE"):
        path = Path(sys.argv[1])
        rows = measure(path)
        rows.append(("all", sum(r[1] for r in rows), sum(r[2] for r in rows)))
        for task, foretold, taken in rows:
            print(f"{path.stem:32s} {task:36s} {foretold:8.3f} {taken:8.3f} {ratio(foretold, taken):6.2f}", flush=True)
        return
    chosen = [Path(name) for name in sys.argv[1:]] or sorted(CASES.glob("*.toml"))
    print(f"{'case':32s} {'task':36s} {'foretold':>8s} {'taken':>8s} {'ratio':>6s}", flush=True)
    for path in chosen:
        if path.stem not in SKIPPED:
            with tempfile.TemporaryDirectory() as cache:
                more = {"FORECASTS_ONE": "1", "FEGEAR_CACHE": cache, "OMP_NUM_THREADS": "1"}
                subprocess.run([sys.executable, __file__, str(path)], env=os.environ | more, check=True)


if __name__ == "__main__":
    main()
