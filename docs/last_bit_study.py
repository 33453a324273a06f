"""How far the numbers of every case move with the last bit, by their stated errors: docs/studies/last_bit.csv.

Run as ``python docs/last_bit_study.py [CASE ...]`` (an hour of one core for all) to make the table anew. Every case is
computed as it is, under noise of one unit in the last place where rounding enters (tests/helpers/other_processor, what
another processor would compute), and with every quantity of the case file off by up to 1e-12 of itself; so are the
random and the unusual gears of tests/golden at a tolerance of 1e-3, and ten searches for reliefs of random pairs.
A number that has a stated error is compared with it, any other with the largest magnitude in its unit in its table.
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
GOLDEN = DOCS.parent / "tests" / "golden"
TABLE = DOCS / "studies" / "last_bit.csv"
COMMAND = "# python docs/last_bit_study.py"
HEAD = ("case", "noise", "with_error", "of_its_error", "which", "without_error", "of_its_size", "which_of_these")
SEEDS = (1, 2, 3)
INPUT = 1e-12
GEAR = """results = ["stiffness"]
[gear.a]
teeth = {teeth}
module = "1 mm"
pressure_angle = "{angle!r} deg"
profile_shift = {shift!r}
rack = {{ addendum = {addendum!r}, dedendum = {dedendum!r}, tip_radius = {tip!r} }}
bore_radius = "{bore!r} mm"
face_width = "1 mm"
plane = "{plane}"
material = {{ young_modulus = "206.8 GPa", poisson_ratio = {nu!r}, density = "7850 kg/m^3" }}
{more}
[stiffness]
gear = "a"
positions = 20
contact_half_width = "0.02 mm"
[accuracy]
tolerance = 1e-3
"""
PAIR = """results = ["transmission-error", "relief"]
[gear.p]
teeth = {z1}
module = "3 mm"
profile_shift = {x!r}
face_width = "30 mm"
[gear.w]
teeth = {z2}
module = "3 mm"
profile_shift = {minus_x!r}
face_width = "30 mm"
[pair.I]
driver = "p"
driven = "w"
load = "{load!r} N"
compliance = {{ source = "weber-banaschek" }}
[design]
pair = "I"
load = "{load!r} N"
"""
#: A number that stands by itself: with a unit in quotes, or with a point or an exponent outside of quotes.
_NUMBER = re.compile(
    r'(?<=")[+-]?\d+(?:\.\d+)?(?:[eE][+-]?\d+)?(?= [A-Za-z/(])|(?<![\w."-])[+-]?\d+\.\d+(?:[eE][+-]?\d+)?(?![\w."])'
)


def gear_text(g: dict[str, Any], bore_radius: float) -> str:
    """Case of one gear of tests/golden."""
    more = f'tip_radius_rounding = "{g["tip_rounding"]!r} mm"' if g.get("tip_rounding") else ""
    more += f'tip_chamfer = "{g["tip_chamfer"]!r} mm"' if g.get("tip_chamfer") else ""
    angle = g["angle"] if "angle" in g else float(np.degrees(g["pressure_angle"]))
    return GEAR.format(
        teeth=g["teeth"], angle=angle, shift=g.get("x", g.get("profile_shift", 0.0)), addendum=g["addendum"],
        dedendum=g["dedendum"], tip=g.get("tip", g.get("rack_tip_radius")), bore=float(bore_radius), plane=g["plane"],
        nu=g.get("nu", g.get("poisson_ratio")), more=more,
    )  # fmt: skip


def written(folder: Path) -> dict[str, list[str]]:
    """Write the cases of gears and of searches into a folder; their names by group."""
    sys.path[:0] = [str(GOLDEN)]
    random, unusual = (importlib.import_module(f"make_{name}_gears") for name in ("random", "unusual"))
    texts: dict[str, list[str]] = {}
    gears = json.loads((GOLDEN / "random_gears.json").read_text())
    texts["random gears"] = [gear_text(g, g["bore"] * random.tooth_of(g).root_radius) for g in gears]
    texts["unusual gears"] = [
        gear_text(unusual.USUAL | g, g["bore"] * unusual.tooth_of(g).root_radius) for g in unusual.GEARS.values()
    ]
    rng = np.random.default_rng(24)
    drawn = [(rng.integers(17, 41, 2), rng.uniform(-0.2, 0.4), rng.uniform(1500.0, 15000.0)) for _ in range(10)]
    texts["relief searches"] = [
        PAIR.format(z1=int(z.min()), z2=int(z.max()), x=x, minus_x=-x, load=load) for z, x, load in drawn
    ]
    groups: dict[str, list[str]] = {}
    for group, every in texts.items():
        groups[group] = [f"{group.replace(' ', '_')}_{i}" for i in range(len(every))]
        for name, text in zip(groups[group], every, strict=True):
            (folder / f"{name}.toml").write_text(text, "utf-8")
    return groups


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
        written(folder)
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
    """Make the table: a row for each case, and for each group of gears or searches its worst."""
    with tempfile.TemporaryDirectory() as made:
        groups = written(Path(made))
    groups |= {path.stem: [path.stem] for path in sorted(CASES.glob("*.toml"))}
    groups = {group: groups[group] for group in names or groups}
    every = [name for group in groups.values() for name in group]
    tasks = [("none", 0), *(("last bit", seed) for seed in SEEDS), *(("input", seed) for seed in SEEDS)]
    with ThreadPoolExecutor(os.cpu_count()) as threads:
        known = dict(zip(tasks, threads.map(lambda task: under(*task, every), tasks), strict=True))
    rows = []
    for group, members in groups.items():
        for noise in ("last bit", "input"):
            spreads = [spread(known["none", 0][m], [known[noise, seed][m] for seed in SEEDS]) for m in members]
            stated, bare = max(spreads, key=lambda row: row[1]), max(spreads, key=lambda row: row[4])
            counts = sum(row[0] for row in spreads), sum(row[3] for row in spreads)
            rows.append((group, noise, counts[0], f"{stated[1]:.2g}", stated[2], counts[1], f"{bare[4]:.2g}", bare[5]))
            print(*rows[-1], sep="  ", flush=True)
    with TABLE.open("w", newline="", encoding="utf-8") as file:
        file.write(COMMAND + "\n")
        csv.writer(file, lineterminator="\n").writerows([HEAD, *rows])


if __name__ == "__main__":
    if sys.argv[1:2] == ["--computed"]:
        computed(Path(sys.argv[2]), sys.argv[4:], Path(sys.argv[3]))
    else:
        main(sys.argv[1:])
