"""Which wrong lines would the ordinary tests notice? A long run, by hand; nothing of it is part of the ordinary tests.

    python tests/mutation/run.py record               once, some 20 minutes: which test executes which line of fegear
    python tests/mutation/run.py record tests/unit    again those of a folder or file, after tests were added
    python tests/mutation/run.py draw 200 --seed 1    200 wrong lines, each in turn, against the tests that execute it
    python tests/mutation/run.py holes                lines of functions that no ordinary test executes

Every mutant is put into a copy of the repository. The tests that execute its line run nearest and cheapest first until
one fails. A test that takes 20 s of a processor, or a minute by the clock, and 15 times as long as usual has failed: it
may never end. A line that no test executes survives at once. Tests of `tests/architecture`, which read the source, do
not count. Outcomes are kept as they come (`.mutation/drawn-SEED.jsonl`): the same draw again goes on where it was
interrupted, and tries survivors against tests that have been recorded since. Another source makes another draw of the
same seed.
"""

from __future__ import annotations

import argparse
import ast
import contextlib
import difflib
import functools
import importlib
import json
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections import Counter, defaultdict
from concurrent.futures import ProcessPoolExecutor
from dataclasses import asdict, dataclass, field
from multiprocessing import get_context
from pathlib import Path

HERE = Path(__file__).parent
ROOT = HERE.parents[1]
WORK = (ROOT / ".mutation").resolve()
sys.path.insert(0, str(HERE))
from mutants import Mutant, draw, mutants_of, room_of  # noqa: E402

#: Tests of the first rounds: most mutants end there, and few files are collected for them.
ROUNDS = (15, 120, 10**6)
#: Seconds of a processor for the tests of one mutant; what is left of them is said.
BUDGET = 150.0
#: Seconds of a processor that a test may take besides 15 times its own; what numba compiles anew takes longer.
PATIENCE, PATIENCE_TO_COMPILE = 20.0, 240.0
#: Seconds by the clock that it may take so: one that waits for what never comes uses no processor.
CLOCK = 60.0
#: What pytest ends with where none of the tests that were asked for exists.
NO_TESTS = 5
#: Functions that numba compiles leave no trace: those who call them do.
CALLERS = {
    "fegear/dynamics/motion/kernel/": "fegear/dynamics/motion/motion.py",
    "fegear/contact/many/corners.py": "fegear/contact/many/many_load_sharing.py",
    "fegear/contact/many/changes.py": "fegear/contact/many/many_load_sharing.py",
    "fegear/contact/many/followed_peaks.py": "fegear/contact/many/many_roots.py",
    "fegear/contact/many/kernel.py": "fegear/contact/many/many_load_sharing.py",
    "fegear/contact/many/over_mesh.py": "fegear/contact/many/many_load_sharing.py",
    "fegear/contact/many/over_fillets.py": "fegear/contact/many/many_roots.py",
}
COMPILED = tuple(CALLERS)
#: What looks at the numbers of all modules as they are once imported: constants, defaults, bounds.
OF_CONSTANTS = "tests/golden/test_constants_golden.py"
HEAVY = [
    *("numpy", "scipy.optimize", "scipy.interpolate", "scipy.sparse.linalg", "scipy.integrate", "scipy.stats"),
    *("pytest", "hypothesis.strategies", "pint", "pydantic", "skfem", "gmsh", "meshio", "typer", "numba"),
]


def copied(to: Path) -> Path:
    """A fresh copy of the repository's files, those that git does not know yet, too."""
    command = ["git", "ls-files", "-z", "--cached", "--others", "--exclude-standard"]
    names = subprocess.run(command, cwd=ROOT, capture_output=True, check=True).stdout.decode().split("\0")
    shutil.rmtree(to, ignore_errors=True)
    for name in filter(None, names):
        if (ROOT / name).is_file():
            (to / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy2(ROOT / name, to / name)
    return to


def environment(tree: Path, **more: str) -> dict[str, str]:
    """What programs see: this tree, one thread, and caches of nobody else."""
    threads = dict.fromkeys(("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS"), "1")
    return os.environ | threads | {"PYTHONPATH": str(tree)} | more


def record(tests: list[str]) -> None:
    """Run the ordinary tests under `coverage`, or the named ones: a record more beside the earlier ones."""
    if not tests:
        for earlier in WORK.glob("record-*"):
            shutil.rmtree(earlier)
    place = WORK / f"record-{time.time_ns()}"
    tree, settings = copied(place / "tree"), place / "coveragerc"
    settings.write_text(
        f"[run]\nsource = {tree / 'fegear'}\ndata_file = {place / 'coverage'}\nparallel = true\n"
        "patch = subprocess\nsigterm = true\ncontext = ${MUTATION_TEST-}\n"
    )
    asked = environment(tree, MUTATION_FOUND=str(place / "found.json"), FEGEAR_CACHE=str(place / "cache"))
    asked["PYTHONPATH"] += os.pathsep + str(HERE)
    coverage = [sys.executable, "-m", "coverage"]
    pytest = ["-m", "pytest", "-n", "0", "-p", "no:cacheprovider", "-p", "recording"]
    given = tests or ["--ignore=tests/architecture", "tests"]
    subprocess.run([*coverage, "run", f"--rcfile={settings}", *pytest, *given], cwd=tree, env=asked, check=False)
    subprocess.run([*coverage, "combine", "--quiet", f"--rcfile={settings}"], cwd=tree, check=False)


class Record:
    """Which tests execute a line, nearest and cheapest first."""

    def __init__(self) -> None:
        from coverage import CoverageData

        self.seconds: dict[str, float] = {}
        self.heirs: dict[str, set[str]] = defaultdict(set)
        self.lines: list[tuple[Path, CoverageData]] = []
        for place in sorted(one.resolve() for one in WORK.glob("record-*")):  # one that is shared is a link
            if not ((place / "coverage").exists() and (place / "found.json").exists()):  # not finished
                continue
            data = CoverageData(str(place / "coverage"))
            data.read()
            self.lines.append((place / "tree", data))
            found = json.loads((place / "found.json").read_text())
            self.seconds |= found["seconds"]
            for failed in found["failed"]:
                self.seconds.pop(failed, None)
            for maker, heirs in found["heirs"].items():
                self.heirs[maker].update(heirs)
        self.seconds = {name: taken for name, taken in self.seconds.items() if (ROOT / name.split("::")[0]).exists()}
        self.of_file: dict[str, list[str]] = defaultdict(list)
        for name in self.seconds:
            self.of_file[name.split("::")[0]].append(name)

    @functools.cached_property
    def texts(self) -> dict[str, str]:
        """What the test files say."""
        return {name: (ROOT / name).read_text() for name in self.of_file if (ROOT / name).exists()}

    @functools.cached_property
    def importers(self) -> dict[tuple[str, str], set[str]]:
        """Modules that import a name of a module."""
        found = defaultdict(set)
        for path in (ROOT / "fegear").rglob("*.py"):
            for node in ast.walk(ast.parse(path.read_bytes())):
                if isinstance(node, ast.ImportFrom):
                    for one in node.names:
                        found[f"{node.module}", one.name].add(path.relative_to(ROOT).as_posix())
        return found

    @functools.lru_cache(maxsize=8)  # noqa: B019
    def contexts(self, path: str) -> dict[int, set[str]]:
        """Tests by the lines of today's file that the recorded ones had, too."""
        found: dict[int, set[str]] = {}
        new = (ROOT / path).read_text().splitlines()
        for tree, data in self.lines:
            if not (tree / path).exists():
                continue
            old, by_line = (tree / path).read_text().splitlines(), data.contexts_by_lineno(str(tree / path))
            for block in difflib.SequenceMatcher(None, old, new, autojunk=False).get_matching_blocks():
                for k in range(block.size):
                    names = by_line.get(block.a + k + 1, ())
                    split = (({name} if name in self.seconds else name.split("|")) for name in names)
                    found.setdefault(block.b + k + 1, set()).update(*split)
        return found

    def executed(self, path: str, lines: set[int]) -> set[str]:
        """Contexts that execute one of these lines."""
        by_line = self.contexts(path)
        return {name for line in lines for name in by_line.get(line, ())}

    def _names(self, test: str, path: str) -> bool:
        """Whether the file of a test imports a module by name."""
        return any(said in self.texts.get(test.partition("::")[0], "") for said in module_imports(path))

    def tests(self, mutant: Mutant) -> list[str]:
        """Those that execute its line, or use what it made; for what is made at import, those that run what uses it."""
        path, tree = mutant.path, ast.parse((ROOT / mutant.path).read_bytes())
        inner, outer = _statements(tree, mutant.line)
        if path.startswith(COMPILED):
            callers = next(by for start, by in CALLERS.items() if path.startswith(start))
            found = self.executed(callers, _function_lines(callers)) | self.executed(path, _function_lines(path))
        elif isinstance(outer[-1], ast.FunctionDef):
            known = inner & set(self.contexts(path))  # of a line that is new: the function's
            found = self.executed(path, known or set(range(outer[-1].lineno, outer[-1].end_lineno + 1)))
        else:
            names = {one.id for one in ast.walk(outer[0]) if isinstance(one, ast.Name)} | {
                getattr(outer[0], "name", "")
            }
            module = path.removesuffix(".py").removesuffix("/__init__").replace("/", ".")
            users = {path}.union(*(self.importers[module, name] for name in names))
            found = set().union(*(self.executed(user, _function_lines(user)) for user in users))
            found |= {name for name in self.seconds if self._names(name, path)}  # a table is read where nothing runs
        if not isinstance(outer[-1], ast.FunctionDef) or mutant.line < outer[-1].body[0].lineno:
            found |= set(self.of_file[OF_CONSTANTS])
        more = {heir for name in found for heir in self.heirs.get(name, ())}
        files = {name.split("::")[0] for name in found if "::" in name}
        remembering = [
            one for one in files if "scope=" in self.texts.get(one, "") or "cache" in self.texts.get(one, "")
        ]
        more |= {name for one in remembering for name in self.of_file[one]}
        more |= {name for one in found if one.endswith("::*") for name in self.of_file[one[:-3]]}
        far = {name: not self._names(name, path) for name in self.seconds}
        far |= dict.fromkeys(self.of_file[OF_CONSTANTS], False)
        first = sorted(found & set(self.seconds), key=lambda name: (far[name], self.seconds[name]))
        return first + sorted((more - found) & set(self.seconds), key=self.seconds.__getitem__)


def module_imports(path: str) -> tuple[str, str]:
    """How a test that is about a module imports it."""
    parts = path.removesuffix(".py").removesuffix("/__init__").split("/")
    return f"from {'.'.join(parts)} import", f"from {'.'.join(parts[:-1])} import {parts[-1]}"


def _statements(tree: ast.Module, line: int) -> tuple[set[int], list[ast.stmt]]:
    """Lines of the innermost statement at a line, and the definitions around it (the statement if there are none)."""
    around = [
        node for node in ast.walk(tree) if isinstance(node, ast.stmt) and node.lineno <= line <= node.end_lineno
    ]  # outermost first  # fmt: skip
    inner = around[-1]
    body = getattr(inner, "body", None)
    last = inner.end_lineno if not body or isinstance(inner, ast.FunctionDef) else body[0].lineno - 1
    outer = [node for node in around if isinstance(node, ast.FunctionDef | ast.ClassDef)]
    return set(range(inner.lineno, last + 1)), outer or [inner]


@functools.cache
def _function_lines(path: str) -> set[int]:
    tree = ast.parse((ROOT / path).read_bytes())
    functions = [node for node in ast.walk(tree) if isinstance(node, ast.FunctionDef)]
    return {line for node in functions for line in range(node.body[0].lineno, node.end_lineno + 1)}


@dataclass
class Outcome:
    """What became of a mutant: the test that noticed it, or how many did not."""

    mutant: Mutant
    killer: str = ""
    ran: list[str] = field(default_factory=list)
    left: int = 0
    seconds: float = 0.0


class _Chosen:
    """Plugin of pytest: only these tests, in this order; a test that takes far too long ends the process."""

    def __init__(self, names: list[str], limits: dict[str, float], told: Path, patience: float) -> None:
        self.names, self.limits, self.told, self.patience = names, limits, told, patience

    def pytest_collection_modifyitems(self, items):
        by_name = {item.nodeid: item for item in items}
        # tests of a table bear its numbers in their names: a wrong number is a name that nobody recorded
        lost = {name.partition("[")[0] for name in self.names if name not in by_name}
        new = [name for name in by_name if name not in self.limits and name.partition("[")[0] in lost]
        items[:] = [by_name[name] for name in (*self.names, *new) if name in by_name]

    def pytest_runtest_logstart(self, nodeid):
        self.told.write_text(nodeid)
        signal.setitimer(signal.ITIMER_VIRTUAL, self.patience + 15.0 * self.limits.get(nodeid, 1.0))

    def pytest_runtest_logreport(self, report):
        if report.failed:
            self.told.write_text(report.nodeid)
            os._exit(1)

    def pytest_collectreport(self, report):
        if report.failed:
            self.told.write_text(f"collecting {report.nodeid}")
            os._exit(1)


def passed(tree: Path, names: list[str], seconds: dict[str, float], patience: float = PATIENCE) -> str:
    """Run tests in a process of their own; the one that failed, or nothing."""
    for heavy in HEAVY:
        importlib.import_module(heavy)
    with tempfile.TemporaryDirectory() as folder:
        scratch = Path(folder)
        if not (child := os.fork()):
            _run_tests(tree, names, seconds, scratch, patience)
        running, code, started = "", None, time.monotonic()
        while code is None:
            done, status = os.waitpid(child, os.WNOHANG)
            code = os.waitstatus_to_exitcode(status) if done else None
            if code is None:
                time.sleep(0.05)
                before, running = running, _told(scratch)
                started = started if running == before else time.monotonic()
                limit = max(CLOCK, patience) + 15.0 * seconds.get(running, 4.0)
                if time.monotonic() - started > limit * _crowded():
                    os.kill(child, signal.SIGKILL)
        with contextlib.suppress(ProcessLookupError):  # programs that its tests left behind
            os.killpg(child, signal.SIGKILL)
        last = _told(scratch)
        code = 0 if code == NO_TESTS else code  # renamed since they were recorded
        if code > 0 and not last:
            raise RuntimeError(f"no test could run:\n{(scratch / 'out').read_text()}")
        return "" if not code else (last or "collecting") + ("" if code == 1 else f" (ended by signal {-code})")


def _told(scratch: Path) -> str:
    """Which test the child runs; nothing while it collects them."""
    with contextlib.suppress(FileNotFoundError):
        return (scratch / "told").read_text()
    return ""


def _crowded() -> float:
    """How many programs share a processor: with others beside it a test takes so many times as long by the clock."""
    return max(1.0, *(load / (os.cpu_count() or 1) for load in os.getloadavg()))


def _run_tests(tree: Path, names: list[str], seconds: dict[str, float], scratch: Path, patience: float) -> None:
    """In the child: pytest on a copy of the repository, and the end of the process."""
    import pytest

    os.setpgid(0, 0)  # a group to be ended as one; in the session, whose share of the processor is given
    os.chdir(tree)
    os.environ.update(environment(tree, FEGEAR_CACHE=str(scratch / "cache"), FEGEAR_STATE=str(scratch / "state")))
    sys.path[:] = [str(tree), *(one for one in sys.path if Path(one or ".").resolve() not in (HERE, ROOT))]
    out = os.open(scratch / "out", os.O_CREAT | os.O_WRONLY)
    os.dup2(out, 1)
    os.dup2(out, 2)
    files = list(dict.fromkeys(name.split("::")[0] for name in names))
    options = ["-n", "0", "-p", "no:cacheprovider", "--basetemp", str(scratch / "tmp")]
    os._exit(pytest.main([*options, *files], plugins=[_Chosen(names, seconds, scratch / "told", patience)]))


def tried(asked: tuple[Mutant, list[str], dict[str, float], float]) -> Outcome:
    """Put a mutant into this process's copy of the repository and run its tests."""
    mutant, names, taken, budget = asked
    tree = _own_tree()
    outcome, started, spent = Outcome(mutant), time.monotonic(), 0.0
    path = tree / mutant.path
    source = path.read_bytes()
    compiled = mutant.path.startswith(COMPILED)
    machine_code = tree / (f"numba-{mutant.start}" if compiled else "numba")
    os.environ["NUMBA_CACHE_DIR"] = str(machine_code)
    try:
        _written(path, mutant.applied(source))
        for first, last in zip((0, *ROUNDS), ROUNDS, strict=False):
            part = []
            for name in names[first:last]:
                spent += taken[name]
                part += [name] if spent < budget or not first else []
            if part and not outcome.killer:
                compiles = compiled or (mutant.path in CALLERS.values() and not machine_code.exists())
                patience = PATIENCE_TO_COMPILE if compiles else PATIENCE
                outcome.killer = passed(tree, part, taken, patience)
                outcome.ran += part
    finally:
        _written(path, source)
    outcome.left = 0 if outcome.killer else len(names) - len(outcome.ran)
    outcome.seconds = time.monotonic() - started
    return outcome


def _own_tree() -> Path:
    """The copy of the repository that this process changes: its name has that of the draw, others may run beside it."""
    tree = WORK / f"run-{os.getppid()}-{os.getpid()}"
    return tree if tree.exists() else copied(tree)


def _written(path: Path, source: bytes) -> None:
    """Write a module and forget its bytecode: Python compares whole seconds and sizes."""
    path.write_bytes(source)
    for kept in path.parent.glob(f"__pycache__/{path.stem}.*.pyc"):
        kept.unlink()


def main() -> None:
    """See the module's docstring."""
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    doing = parser.add_subparsers(dest="doing", required=True)
    doing.add_parser("record").add_argument("tests", nargs="*")
    doing.add_parser("holes")
    drawing = doing.add_parser("draw")
    drawing.add_argument("count", type=int)
    drawing.add_argument("--seed", type=int, required=True)
    drawing.add_argument("--rooms", default="", help="only these, with commas between them")
    drawing.add_argument("--workers", type=int, default=1)
    drawing.add_argument("--budget", type=float, default=BUDGET, help="seconds of a processor for a mutant's tests")
    asked = parser.parse_args()
    WORK.mkdir(exist_ok=True)
    if asked.doing == "record":
        record(asked.tests)
        return
    if asked.doing == "holes":
        holes(Record())
        return
    known, rooms = Record(), tuple(filter(None, asked.rooms.split(",")))
    mutants = list(draw(ROOT, asked.count, asked.seed, rooms))
    report(mutants, known, asked.workers, asked.budget, WORK / f"drawn-{asked.seed}.jsonl")


def holes(known: Record) -> None:
    """Lines of functions that could be wrong and that no ordinary test executes."""
    whole, missed = Counter(), defaultdict(list)
    for path in sorted((ROOT / "fegear").rglob("*.py")):
        name, source = path.relative_to(ROOT).as_posix(), path.read_bytes()
        tree, contexts = ast.parse(source), known.contexts(name)
        for line in sorted({one.line for one in mutants_of(name, source)}):
            inner, outer = _statements(tree, line)
            if isinstance(outer[-1], ast.FunctionDef) and not name.startswith(COMPILED):
                whole[room_of(name)] += 1
                tests = {test for at in inner for test in contexts.get(at, ())}
                if not any(test in known.seconds or test.endswith("::*") for test in tests):
                    missed[name].append(line)
    for name, lines in sorted(missed.items(), key=lambda item: -len(item[1])):
        print(f"{name}: {', '.join(map(str, lines))}")
    for room, count in sorted(whole.items()):
        left = sum(len(lines) for name, lines in missed.items() if room_of(name) == room)
        print(f"{room:12} {left:5} of {count:5} lines are executed by no ordinary test")


def earlier(kept: Path) -> dict[str, Outcome]:
    """Outcomes of a draw that was interrupted, or ran before other tests were recorded: by what the mutants change."""
    found: dict[str, Outcome] = {}
    for line in kept.read_text().splitlines() if kept.exists() else ():
        one = json.loads(line)
        shown = one.pop("shown")
        outcome = Outcome(Mutant(**one.pop("mutant")), **one)
        if shown in found and not outcome.killer:
            outcome.ran = found[shown].ran + outcome.ran
        found[shown] = outcome
    return found


def report(mutants: list[Mutant], known: Record, workers: int, budget: float, kept: Path) -> None:
    """Try all, keep and say each at once, and say what each room kept in the end."""
    taken, before = known.seconds, earlier(kept)
    shown = {mutant: mutant.shown((ROOT / mutant.path).read_bytes()) for mutant in mutants}
    tests = {mutant: known.tests(mutant) for mutant in mutants}
    outcomes = [before[shown[one]] for one in mutants if shown[one] in before and before[shown[one]].killer]
    done = {shown[one.mutant] for one in outcomes}
    ran = {one: set(before[shown[one]].ran) if shown[one] in before else set() for one in mutants}
    asked = [
        (one, [name for name in tests[one] if name not in ran[one]], taken, budget)
        for one in mutants if shown[one] not in done
    ]  # fmt: skip
    with ProcessPoolExecutor(workers, mp_context=get_context("fork")) as pool:
        for outcome in pool.map(tried, asked):
            outcomes.append(outcome)
            with kept.open("a") as file:
                print(json.dumps({"shown": shown[outcome.mutant], **asdict(outcome)}), file=file)
            said(outcome)
            print(f"{len(outcomes)} of {len(mutants)}", end="\r", file=sys.stderr, flush=True)
        # A test that fails without any mutant has noticed nothing.
        names = sorted({outcome.killer.split(" (ended")[0] for outcome in outcomes} & set(taken))
        failing = {name for name, fails in zip(names, pool.map(_alone, names), strict=True) if fails}
        again = [outcome for outcome in outcomes if outcome.killer.split(" (ended")[0] in failing]
        left = [
            (one.mutant, [name for name in tests[one.mutant] if name not in failing], taken, budget) for one in again
        ]
        outcomes = [outcome for outcome in outcomes if outcome not in again]
        for outcome in pool.map(tried, left):
            outcomes.append(outcome)
            said(outcome)
    for tree in WORK.glob(f"run-{os.getpid()}-*"):
        shutil.rmtree(tree)
    rooms = defaultdict(list)
    for outcome in outcomes:
        rooms[outcome.mutant.room].append(bool(outcome.killer))
        rooms["all"].append(bool(outcome.killer))
    for room, noticed in sorted(rooms.items(), key=lambda item: (item[0] == "all", item[0])):
        print(f"{room:12} {sum(noticed):4} of {len(noticed):4}  {100 * sum(noticed) / len(noticed):5.1f} %")
    print(f"{sum(one.seconds for one in outcomes):.0f} s; fail without a mutant:", *sorted(failing))


def said(outcome: Outcome) -> None:
    """A survivor as it is found."""
    if not outcome.killer:
        shown = outcome.mutant.shown((ROOT / outcome.mutant.path).read_bytes())
        more = f", {outcome.left} not run" if outcome.left else ""
        print(f"survived {len(outcome.ran)} tests{more}: {shown}", flush=True)


def _alone(name: str) -> str:
    return passed(_own_tree(), [name], {name: 30.0})


if __name__ == "__main__":
    main()
