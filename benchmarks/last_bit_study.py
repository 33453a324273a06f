"""How far the numbers of every case move with the last bit, by their stated errors: docs/studies/last_bit.csv.

Run as ``python benchmarks/last_bit_study.py FOLDER [NAME ...]`` to make the table anew: hours of one core for all. Each
run's numbers are kept in the folder, so a study that was ended goes on where it was, and names (of groups or cases) add
to what is there; rows of others stay in the table. Every case is computed as it is, under noise of one unit in the last
place where rounding enters (tests/helpers/other_processor, what another processor would compute), and with every
quantity of the case file off by up to 1e-12 of itself; so are the random and the unusual gears of tests/golden at a
tolerance of 1e-3, and ten searches for reliefs of random pairs. A number that has a stated error is compared with it;
any other, and one that is stated as exact, with the largest magnitude in its unit in its table or among the values.
"""

from __future__ import annotations

import argparse
import csv
import importlib
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile
import time
from pathlib import Path
from typing import Any

import numpy as np

DOCS = Path(__file__).resolve().parents[1] / "docs"
CASES = DOCS.parent / "cases"
OTHER = DOCS.parent / "tests" / "helpers" / "other_processor"
GOLDEN = DOCS.parent / "tests" / "golden"
TABLE = DOCS / "studies" / "last_bit.csv"
PAGE = DOCS / "hard-cases.md"
#: Of the table on the page; the lines below it belong to it up to the first that does not start like a row.
PAGE_HEAD = (
    "| case | draws | numbers with an error | last bit | inputs | numbers without | last bit | inputs |",
    "|---|---|---|---|---|---|---|---|",
)
COMMAND = "# python benchmarks/last_bit_study.py"
_NUMBERS = ("with_error", "of_its_error", "which", "without_error", "of_its_size", "which_of_these")
HEAD = ("case", "cases", "noise", "draws", *_NUMBERS)
SEEDS = (1, 2, 3)
INPUT = 1e-12
#: A slope, a share or an angle [rad] below this is compared with it: it is round-off of numbers near one where zero.
BARE = 1e-5
ANGLES = ("", "rad", "mrad", "deg", "arcmin", "arcsec")
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
    from fegear.engine.least_errors import error_columns

    of_unit: dict[str, float] = {}
    for v in results.values:
        if v.unit and np.isfinite(v.si):
            of_unit[v.unit] = max(of_unit.get(v.unit, 0.0), abs(v.si))
    numbers = {
        v.name: ([v.si], None if v.si_error is None else [v.si_error], of_unit.get(v.unit, abs(v.si)))
        for v in results.values
    }
    for table in results.tables:
        columns = {column.name: column for column in table.columns if column.si.dtype.kind == "f"}
        errors = error_columns(table)
        size: dict[str, float] = {}
        for column in columns.values():
            largest = float(np.max(np.abs(column.si), initial=0.0, where=np.isfinite(column.si)))
            least = BARE if column.unit in ANGLES else 0.0
            size[column.unit] = max(size.get(column.unit, least), largest)
        for name, column in columns.items():
            if name not in errors.values():
                error = columns[errors[name]].si.tolist() if name in errors else None
                numbers[f"{table.name}.{name}"] = column.si.tolist(), error, size[column.unit]
    return numbers


def computed(folder: Path, kept: Path, run: str, names: list[str]) -> None:
    """Compute cases in this process and write down the numbers of each, or its refusal, as soon as it is done."""
    import fegear
    from fegear.base.errors import FegearError

    for name in names:
        start = time.process_time()
        try:
            numbers: Any = found(fegear.run(folder / f"{name}.toml", progress=False))
        except FegearError as problem:
            numbers = str(problem)
        out = kept / name / f"{run}.json"
        out.parent.mkdir(parents=True, exist_ok=True)
        part = out.with_suffix(".part")
        part.write_text(json.dumps({"seconds": time.process_time() - start, "numbers": numbers}))
        part.rename(out)
        print(run, name, f"{time.process_time() - start:.1f} s", flush=True)


def under(noise: str, seed: int, names: list[str], kept: Path) -> None:
    """Compute what is missing of the cases under one noise, in a process of its own."""
    names = [name for name in names if not _kept(kept, name, noise, seed).exists()]
    if not names:
        return
    with tempfile.TemporaryDirectory() as made:
        folder = Path(made) / "cases"
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
        run = _kept(kept, "", noise, seed).stem
        command = [sys.executable, __file__, "--computed", str(folder), str(kept), run, *names]
        subprocess.run(command, env=environment, check=True)


def _kept(kept: Path, name: str, noise: str, seed: int) -> Path:
    return kept / name / f"{noise.replace(' ', '_')}_{seed}.json"


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
        x = np.array(values, dtype=float)
        error = np.full(x.shape, np.nan if errors is None else errors, dtype=float)
        stated = error > 0.0
        size = np.where(stated, error, largest)
        for kind, these in ((True, stated), (False, ~stated)):
            count[kind] += int(these.sum())
            for other in others if these.any() else ():
                ratio = _moved(x, other, name, size, these)
                if not ratio <= worst[kind][0]:
                    worst[kind] = ratio, name
    return count[True], *worst[True], count[False], *worst[False]


def _moved(x: Any, other: Any, name: str, size: Any, these: Any) -> float:
    """Largest move of those numbers of a column, over their sizes; infinite where the other has no such column."""
    y = np.array(other[name][0], dtype=float) if not isinstance(other, str) and name in other else np.array([])
    if y.shape != x.shape:
        return np.inf
    with np.errstate(invalid="ignore", divide="ignore"):
        alike = (x == y) | (np.isnan(x) & np.isnan(y))
        moves = np.where(alike, 0.0, np.abs(y - x) / size)[these]
    return float(np.max(np.where(np.isnan(moves), np.inf, moves), initial=0.0))


def rows(groups: dict[str, list[str]], kept: Path) -> list[tuple[Any, ...]]:
    """Two rows for each case, and for each group of gears or searches its worst, of all that has been computed."""
    found = []
    for group, members in groups.items():
        both = [_row(group, noise, members, kept) for noise in ("last bit", "input")]
        found += [row for row in both if all(both)]
    return found


def _row(group: str, noise: str, members: list[str], kept: Path) -> tuple[Any, ...]:
    """The worst of a group under one noise; empty where nothing has been computed."""
    spreads, draws = [], []
    for name in members:
        seen = [path for seed in SEEDS if (path := _kept(kept, name, noise, seed)).exists()]
        if seen and (plain := _kept(kept, name, "none", 0)).exists():
            exact, *others = (json.loads(path.read_text())["numbers"] for path in (plain, *seen))
            spreads.append(spread(exact, others))
            draws.append(len(seen))
    if not spreads:
        return ()
    stated, bare = max(spreads, key=lambda row: row[1]), max(spreads, key=lambda row: row[4])
    counts = sum(row[0] for row in spreads), sum(row[3] for row in spreads)
    worst = f"{stated[1]:.2g}", stated[2], counts[1], f"{bare[4]:.2g}", bare[5]
    return group, len(spreads), noise, min(draws), counts[0], *worst


def _table() -> list[dict[str, str]]:
    """Rows of the table that is kept."""
    with TABLE.open(encoding="utf-8") as file:
        next(file)
        return list(csv.DictReader(file))


def page_lines() -> list[str]:
    """Rows of the table of the page, of the table that is kept: both noises of a case side by side."""
    kept = _table()
    lines = list(PAGE_HEAD)
    for bit, inputs in zip(kept[::2], kept[1::2], strict=True):
        assert (bit["case"], bit["noise"], inputs["noise"]) == (inputs["case"], "last bit", "input")
        name = f"{bit['cases']} {bit['case']}" if " " in bit["case"] else f"`{bit['case']}`"
        cells = [name, bit["draws"]]
        for count, ratio in (("with_error", "of_its_error"), ("without_error", "of_its_size")):
            numbers = int(bit[count])
            cells += [f"{numbers:,}", *(row[ratio] if numbers else "" for row in (bit, inputs))]
        lines.append(f"| {' | '.join(cells)} |")
    return lines


def write_page() -> None:
    """Put the rows of the table that is kept on the page."""
    lines = PAGE.read_text("utf-8").splitlines()
    start = lines.index(PAGE_HEAD[0])
    end = next((i for i in range(start, len(lines)) if not lines[i].startswith("|")), len(lines))
    PAGE.write_text("\n".join([*lines[:start], *page_lines(), *lines[end:], ""]), "utf-8")


def main(arguments: list[str]) -> None:
    """Compute what is missing and make the table of all that is there."""
    parser = argparse.ArgumentParser()
    parser.add_argument("folder", type=Path, help="where the numbers of each run are kept")
    parser.add_argument("names", nargs="*", help="groups or cases to compute; none for all")
    parser.add_argument("--draws", type=int, default=len(SEEDS), help="of each noise; 0 for the cases as they are")
    parser.add_argument("--table", action="store_true", help="compute nothing")
    given = parser.parse_intermixed_args(arguments)
    with tempfile.TemporaryDirectory() as made:
        groups = written(Path(made))
    groups |= {path.stem: [path.stem] for path in sorted(CASES.glob("*.toml"))}
    every = [name for group in groups.values() for name in group]
    names = [one for name in given.names or groups for one in groups.get(name, [name])]
    if unknown := set(names) - set(every):
        parser.error(f"no such case: {', '.join(sorted(unknown))}")
    tasks = [("none", 0), *((noise, seed) for seed in SEEDS[: given.draws] for noise in ("last bit", "input"))]
    for task in [] if given.table else tasks:
        under(*task, names, given.folder)
    # Rows of what is not in the folder stay.
    found = {(row[0], row[2]): row for row in (*(tuple(one.values()) for one in _table()), *rows(groups, given.folder))}
    ordered = [found[one] for group in groups for noise in ("last bit", "input") if (one := (group, noise)) in found]
    with TABLE.open("w", newline="", encoding="utf-8") as file:
        file.write(COMMAND + "\n")
        csv.writer(file, lineterminator="\n").writerows([HEAD, *ordered])
    write_page()


if __name__ == "__main__":
    if sys.argv[1:2] == ["--computed"]:
        computed(Path(sys.argv[2]), Path(sys.argv[3]), sys.argv[4], sys.argv[5:])
    else:
        main(sys.argv[1:])
