"""Whether the main job has become slower: two versions of fegear in turn, from cold, with and without pictures.

Run as ``python benchmarks/against.py OTHER_PYTHON [RUNS]`` with this version's Python; OTHER_PYTHON is the Python of an
environment in which another version is installed (a ``git worktree`` of it with its own ``.venv``). Both run
``cases/lin_table1.toml`` of this version, in processes of their own whose seconds the system counts: A B A B ...,
after one run of each that does not count and leaves the bytecode of all that is loaded, as any first run does. Medians,
and the median of the ratios pair by pair: these hold on a machine that others load, seconds do not. POSIX alone.
"""

from __future__ import annotations

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from statistics import median
from typing import NamedTuple

CASE = Path(__file__).resolve().parents[1] / "cases" / "lin_table1.toml"
#: Without bytecode each run compiles all its libraries, which takes as long as the job.
_BYTECODE = "PYTHONDONTWRITEBYTECODE", "PYTHONPYCACHEPREFIX"
COMMAND = ("-c", "from fegear.__main__ import main; main()", "run", str(CASE))


class Seconds(NamedTuple):
    """Processor seconds (user and system, of all its processes) and wall seconds of one run."""

    processor: float
    wall: float


def run(python: str, folder: Path, *more: str) -> Seconds:
    """One cold run into a folder that does not exist yet."""
    started = time.perf_counter()
    process = subprocess.Popen(
        [python, *COMMAND, "--out", str(folder), *more],
        cwd=folder.parent,
        stdout=subprocess.DEVNULL,
        stderr=subprocess.DEVNULL,
        env={k: v for k, v in os.environ.items() if not k.startswith(_BYTECODE)} | {"OMP_NUM_THREADS": "1"},
    )
    _, status, used = os.wait4(process.pid, 0)
    process.returncode = os.waitstatus_to_exitcode(status)
    assert process.returncode == 0, f"{python} {' '.join(COMMAND)} ended with {process.returncode}"
    return Seconds(used.ru_utime + used.ru_stime, time.perf_counter() - started)


def pairs(pythons: tuple[str, str], runs: int, *more: str) -> list[tuple[Seconds, Seconds]]:
    """Runs of both, one after the other."""
    with tempfile.TemporaryDirectory() as folder:
        found = []
        for number in range(runs + 1):
            here, other = (run(python, Path(folder) / f"{number}_{i}", *more) for i, python in enumerate(pythons))
            found.append((here, other))
    return found[1:]


def main() -> None:
    """Print a table."""
    other, runs = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 7
    print(f"medians of {runs} pairs of runs; load average {os.getloadavg()[0]:.1f}")
    print(f"{'':18s} {'':10s} {'this':>8s} {'other':>8s} {'ratio':>6s}")
    for name, more in (("without pictures", ("--no-plots",)), ("with pictures", ())):
        found = pairs((sys.executable, other), runs, *more)
        for i, kind in enumerate(Seconds._fields):
            this, that = median(here[i] for here, _ in found), median(there[i] for _, there in found)
            ratio = median(here[i] / there[i] for here, there in found)
            print(f"{name:18s} {kind:10s} {this:8.2f} {that:8.2f} {ratio:6.2f}", flush=True)


if __name__ == "__main__":
    main()
