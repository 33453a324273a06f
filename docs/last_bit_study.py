"""How far the numbers of every case move with the last bit, by their stated errors: docs/studies/last_bit.csv.

Run as ``python docs/last_bit_study.py [CASE ...]`` (an hour of one core for all) to make the table anew. Every case is
computed as it is, under noise of one unit in the last place where rounding enters (tests/helpers/other_processor, what
another processor would compute), and with every quantity of the case file off by up to 1e-12 of itself. A number that
has a stated error is compared with it, any other with the largest magnitude in its unit in its table.
"""

from __future__ import annotations

import csv
import importlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path
from typing import Any

import numpy as np

DOCS = Path(__file__).parent
CASES = DOCS.parent / "cases"
OTHER = DOCS.parent / "tests" / "helpers" / "other_processor"
TABLE = DOCS / "studies" / "last_bit.csv"
COMMAND = "# python docs/last_bit_study.py"
HEAD = ("case", "noise", "with_error", "of_its_error", "which", "without_error", "of_its_size", "which_of_these")
SEEDS = (1, 2, 3)
INPUT = 1e-12
#: A number that stands by itself: with a unit in quotes, or with a point or an exponent outside of quotes.
_NUMBER = re.compile(
    r'(?<=")[+-]?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?(?= [A-Za-z/(])|(?<![\w."-])[+-]?\d+\.\d+(?:[eE][+-]?\d+)?(?![\w."])'
)


def found(results: Any) -> dict[str, tuple[list[float], list[float] | None, float]]:
    """Every number of a run by its name, its stated errors where it has some, and what its size is compared with."""
    from fegear.engine.stated_errors import error_columns

    numbers = {v.name: ([v.si], None if v.si_error is None else [v.si_error], abs(v.si)) for v in results.values}
    for table in results.tables:
        columns = {column.name: column for column in table.columns if column.si.dtype.kind == "f"}
        errors = error_columns(table)
        size: dict[str, float] = {}
        for column in columns.values():
            largest = float(np.max(np.abs(column.si), initial=0.0, where=np.isfinite(column.si)))
            size[column.unit] = max(size.get(column.unit, 0.0), largest)
        for name, column in columns.items():
            if name not in errors.values():
                error = columns[errors[name]].si.tolist() if name in errors else None
                numbers[f"{table.name}.{name}"] = column.si.tolist(), error, size[column.unit]
    return numbers


def computed(folder: Path, names: list[str], out: Path) -> None:
    """Compute cases in this process and write their numbers down."""
    import fegear
    from fegear.errors import FegearError

    every = {}
    for name in names:
        try:
            every[name] = found(fegear.run(folder / f"{name}.toml", progress=False))
        except FegearError as problem:
            every[name] = str(problem)
    out.write_text(json.dumps(every))


def under(noise: str, seed: int, names: list[str]) -> dict[str, Any]:
    """Numbers of the cases under one noise, computed in a process of its own."""
    with tempfile.TemporaryDirectory() as made:
        folder, out = Path(made) / "cases", Path(made) / "found.json"
        shutil.copytree(CASES, folder)
        if noise == "input":
            sys.path.insert(0, str(OTHER))
            noisy = importlib.import_module("last_bit").noisy
            for case in folder.glob("*.toml"):
                case.write_text(off_by(case.read_text("utf-8"), seed, noisy), "utf-8")
        environment = {**os.environ, "OMP_NUM_THREADS": "1", "OPENBLAS_NUM_THREADS": "1"}
        paths = [str(DOCS.parent), *os.environ.get("PYTHONPATH", "").split(os.pathsep)]
        if noise == "last bit":
            environment["FEGEAR_LAST_BIT"] = str(seed)
            paths.insert(0, str(OTHER))
        environment["PYTHONPATH"] = os.pathsep.join(p for p in paths if p)
        command = [sys.executable, __file__, "--computed", str(folder), str(out), *names]
        subprocess.run(command, env=environment, check=True)
        return json.loads(out.read_text())


def off_by(text: str, seed: int, noisy: Any) -> str:
    """Text of a case whose quantities are off by up to `INPUT` of themselves, like ones alike."""

    def moved(match: re.Match[str]) -> str:
        x = float(match[0])
        unit = float(noisy(np.array([x]), seed)[0]) - x
        return repr(float(x * (1.0 + INPUT * np.sign(unit))))

    lines = text.splitlines(keepends=True)
    return "".join(line if line.lstrip().startswith("#") else _NUMBER.sub(moved, line) for line in lines)


def spread(exact: Any, others: list[Any]) -> tuple[int, float, str, int, float, str]:
    """Largest move of a number over its stated error, and of one without over its column's size, and which they are."""
    if isinstance(exact, str):
        same = all(other == exact for other in others)
        return 0, 0.0, "refused" if same else "refused or not", 0, 0.0, ""
    worst = {True: (0.0, ""), False: (0.0, "")}
    count = {True: 0, False: 0}
    for name, (values, errors, largest) in exact.items():
        stated = errors is not None
        count[stated] += 1
        x = np.array(values, dtype=float)
        size = np.array(errors, dtype=float) if stated else np.full(x.shape, largest)
        for other in others:
            y = np.array(other[name][0], dtype=float) if not isinstance(other, str) and name in other else np.array([])
            if y.shape != x.shape:
                ratio = np.inf
            else:
                moved = np.where(x == y, 0.0, np.abs(y - x))
                moved[np.isnan(x) & np.isnan(y)] = 0.0
                # a number stated as exact may be off by its own round-off
                bare = np.where(size > 0.0, size, np.where(stated, 1e-13 * np.abs(x), 1.0))
                ratio = float(
                    np.max(np.divide(moved, bare, out=np.where(moved > 0, np.inf, 0.0), where=bare > 0), initial=0.0)
                )
            if not ratio <= worst[stated][0]:
                worst[stated] = ratio, name
    return count[True], *worst[True], count[False], *worst[False]


def main(names: list[str]) -> None:
    """Make the table."""
    names = names or sorted(path.stem for path in CASES.glob("*.toml"))
    tasks = [("none", 0), *(("last bit", seed) for seed in SEEDS), *(("input", seed) for seed in SEEDS)]
    with ThreadPoolExecutor(os.cpu_count()) as threads:
        every = dict(zip(tasks, threads.map(lambda task: under(*task, names), tasks), strict=True))
    rows = []
    for name in names:
        for noise in ("last bit", "input"):
            others = [every[noise, seed][name] for seed in SEEDS]
            a, b, c, d, e, f = spread(every["none", 0][name], others)
            rows.append((name, noise, a, f"{b:.2g}", c, d, f"{e:.2g}", f))
            print(*rows[-1], sep="  ", flush=True)
    with TABLE.open("w", newline="", encoding="utf-8") as file:
        file.write(COMMAND + "\n")
        csv.writer(file, lineterminator="\n").writerows([HEAD, *rows])


if __name__ == "__main__":
    if sys.argv[1:2] == ["--computed"]:
        computed(Path(sys.argv[2]), sys.argv[4:], Path(sys.argv[3]))
    else:
        main(sys.argv[1:])
