"""How soon `fegear open` answers in chromium, beside what was asked for.

    python benchmarks/bench_window.py [--answers 30] [--case NAME] [--against CHECKOUT]
    python benchmarks/bench_window.py --soak MINUTES [--case NAME]

Every change is made in the page, and its answer counts when load sharing, transmission error and root stress of that
very change are there and what is in sight is painted. Printed: median and 95th percentile of the milliseconds, and the
processor milliseconds that server, computing process and browser take for one change (a machine that does other things
as well stretches the first, not the second). `--against` measures another checkout in between, change by change kind,
and prints the ratios.

The soak makes random changes of every kind for so many minutes and prints how much memory server, computing process and
browser have grown since the end of the first tenth, and what they leave behind.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib.util
import os
import random
import shutil
import subprocess
import sys
import tempfile
import time
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CASES = ("pinion_and_wheel", "nasa_relief_design")
WATCH = """
(() => {
  const wanted = ["load-sharing of I", "transmission-error of I", "root-stress-history of I"];
  const hear = fegear.hear;
  let seen = new Set(), first = 0, waiting = null, number = null, moved = [];
  const delays = window.delays = [];
  fegear.hear = (what, content) => {
    const line = hear(what, content);
    if (what === "asked" && number === null) { number = content.number ?? 0; seen = new Set(); first = 0; }
    if (what === "asked") for (const one of moved) one.number ??= content.number ?? 0;
    if (what === "found") line.then(() => requestAnimationFrame(() => {
      const now = performance.now();
      if (content.task === wanted[2]) {
        for (const one of moved.filter((one) => one.number <= (content.number ?? 0))) delays.push(now - one.at);
        moved = moved.filter((one) => !(one.number <= (content.number ?? 0)));
      }
      if (number === null || (content.number ?? number) < number) return;
      if (wanted.includes(content.task)) first ||= now;
      if (wanted.includes(content.task) && !content.draft) seen.add(content.task);
      if (seen.size === wanted.length && waiting) { waiting([first, now]); waiting = null; }
    }));
    return line;
  };
  window.answer = (change) => new Promise((done) => {
    const start = performance.now();
    number = null;
    waiting = (times) => done(times.map((one) => one - start));
    change();
  });
  window.moveOn = (change) => { moved.push({ at: performance.now() }); change(); };
})()
"""
IDLE = (
    "!document.body.classList.contains('computing') && !document.querySelector('#results .stale')"
    " && document.querySelectorAll('#results .js-plotly-plot, #small .small-plot').length > 2"
)


def _browser():
    spec = importlib.util.spec_from_file_location("chromium", ROOT / "tests" / "cases" / "chromium.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules["chromium"] = module
    spec.loader.exec_module(module)
    return module.Browser(shutil.which("chromium") or shutil.which("chromium-browser"))


def _family(pid: int) -> list[tuple[int, int]]:
    """A process and those it has started, with their memory [kB]."""
    found = subprocess.run(["ps", "-o", "pid=,ppid=,rss=", "-A"], capture_output=True, text=True, check=True).stdout
    rows = [tuple(map(int, line.split())) for line in found.splitlines()]
    family = {pid}
    for _ in range(4):
        family |= {one for one, parent, _ in rows if parent in family}
    return [(one, size) for one, _, size in rows if one in family]


def memory(pid: int) -> float:
    """Of a process and its children [MB]."""
    return sum(size for _, size in _family(pid)) / 1024


def processor(pids: list[int]) -> float:
    """Seconds that processes have taken."""
    ticks = 0
    for pid in pids:
        with contextlib.suppress(OSError):
            ticks += sum(map(int, Path(f"/proc/{pid}/stat").read_text().rpartition(")")[2].split()[11:13]))
    return ticks / os.sysconf("SC_CLK_TCK")


@dataclass
class Measured:
    """Milliseconds of one kind of change."""

    first: list[float] = field(default_factory=list)
    whole: list[float] = field(default_factory=list)
    server: float = 0.0
    browser: float = 0.0


def at_share(values: list[float], share: float) -> float:
    return sorted(values)[min(int(share * len(values)), len(values) - 1)] if values else float("nan")


class Window:
    """A server of one checkout with one case, and a browser that looks at it."""

    def __init__(self, checkout: Path, case: str | Path) -> None:
        path = case if isinstance(case, Path) else ROOT / "cases" / f"{case}.toml"
        self._state = tempfile.TemporaryDirectory()
        self.scratch = Path(self._state.name) / "scratch"
        self.scratch.mkdir()
        self.browser = _browser()
        # so that the start measured is that of a machine on which fegear has run before
        env = os.environ | {
            "FEGEAR_STATE": self._state.name, "TMPDIR": str(self.scratch), "PYTHONUNBUFFERED": "1",
            "PYTHONPATH": str(checkout),
        }  # fmt: skip
        env.pop("PYTHONDONTWRITEBYTECODE", None)  # else every start compiles all of fegear's source
        self.started = time.monotonic()
        self.server = subprocess.Popen(
            [sys.executable, "-m", "fegear", "open", "--no-browser", str(path)],
            stdout=subprocess.PIPE, text=True, env=env, cwd=checkout,
        )  # fmt: skip
        self.address = self.server.stdout.readline().split()[-1]
        self.listening = time.monotonic() - self.started
        self.load()
        self.usable = time.monotonic() - self.started
        self.text = path.read_text()

    def load(self) -> None:
        """Open the page and wait until it can be used."""
        self.browser("Page.navigate", url=self.address)
        self.browser.until("document.documentElement?.dataset.ready !== undefined"
                           " && document.querySelector('[data-key]') !== null")  # fmt: skip

    def rest(self) -> None:
        """Let go of what was moved, and wait for all of its results."""
        self.browser.run(self.relief(4.0, moving=False))
        self.settle()

    def settle(self) -> None:
        """Wait until everything is computed."""
        for _ in range(6):
            with contextlib.suppress(TimeoutError):
                self.browser.until(IDLE)
                return

    def ready(self) -> None:
        """Wait for the first results, and hook in."""
        self.settle()
        self.browser.run(WATCH)
        self.gear = self.browser.run("document.querySelector('[data-key$=\".teeth\"]').dataset.key.split('.')[1]")
        self.gears = self.browser.run(
            "[...document.querySelectorAll('[data-key$=\".teeth\"]')].map((one) => one.dataset.key.split('.')[1])"
        )
        self.key = "torque" if "torque" in self.text else "load"

    def pids(self) -> tuple[list[int], list[int]]:
        """Of the server with its computing process, and of the browser."""
        server = [pid for pid, _ in _family(self.server.pid)]
        return server, [pid for pid, _ in _family(self.browser.pid)]

    def answers(self, changes: list[str], found: Measured) -> None:
        """Make changes and add what their answers took; the processor's part is of all of them together."""
        pids = self.pids()
        before = [processor(one) for one in pids]
        for change in changes:
            first, whole = self.browser.run(f"answer(() => {{ {change} }})")
            found.first.append(first)
            found.whole.append(whole)
        after = [processor(one) for one in pids]
        found.server += 1e3 * (after[0] - before[0])
        found.browser += 1e3 * (after[1] - before[1])

    def relief(self, amount: float, *, moving: bool = True) -> str:
        """A tip relief of so many micrometres."""
        now = "true" if moving else "false"
        return f"emitEvent('relief', {{gear: '{self.gear}', end: 'tip', start: 26, amount: {amount}, moving: {now}}})"

    def load_of(self, share: float, *, moving: bool = True) -> str:
        """So much of the pair's load."""
        base, unit = (90, "N*m") if self.key == "torque" else (1615, "N")
        now, text = "true" if moving else "false", f"{base * share:.5g} {unit}"
        return f"emitEvent('load', {{pair: 'I', key: '{self.key}', text: '{text}', moving: {now}}})"

    def typed(self, key: str, value: str) -> str:
        """Something typed into a field and confirmed; what is left out by default is unfolded before."""
        return self._typed_at(self.gear, key, value)

    def typed_everywhere(self, key: str, value: str) -> str:
        """The same on every gear: gears in mesh share a pressure angle, and the case holds when the last one has it."""
        return "; setTimeout(() => {".join(self._typed_at(gear, key, value) for gear in self.gears) + "}, 50)" * (
            len(self.gears) - 1
        )

    def _typed_at(self, gear: str, key: str, value: str) -> str:
        find = f"document.querySelector('[data-key=\"gear.{gear}.{key}\"]')"
        if not self.browser.run(f"{find} !== null"):
            self.browser.run(
                "[...document.querySelectorAll('.q-expansion-item .q-item')].forEach((one) => one.click())"
            )
            self.browser.until(f"{find} !== null")
        return (
            f"(() => {{ const one = {find}; one.focus(); one.value = '{value}';"
            "one.dispatchEvent(new InputEvent('input', {bubbles: true}));"
            "setTimeout(() => one.dispatchEvent(new KeyboardEvent('keydown', {key: 'Enter', bubbles: true})), 0); })()"
        )

    def stroke(self, seconds: float) -> list[float]:
        """Move a relief ten times a second; the delay of every answer [ms]."""
        self.browser.run("delays.length = 0")
        end, i = time.monotonic() + seconds, 0
        while time.monotonic() < end:
            started = time.monotonic()
            i += 1
            self.browser.run(f"moveOn(() => {self.relief(8 + 0.01 * i)})")
            time.sleep(max(0.0, 0.1 - (time.monotonic() - started)))
        time.sleep(1.0)
        return self.browser.run("delays")

    def close(self) -> list[str]:
        """End both; returns the processes and folders that the server leaves behind half a second later."""
        family = [pid for pid, _ in _family(self.server.pid)]
        self.server.terminate()
        self.server.wait(20)
        time.sleep(0.5)
        left = [f"process {pid}" for pid in family if Path(f"/proc/{pid}").exists()]
        left += [path.name for path in self.scratch.iterdir()]
        self.browser.close()
        self._state.cleanup()
        return left


KINDS = (
    ("dragged relief point", lambda w, i: w.relief(6 + 0.1 * i), (None, 100, 200)),
    ("load slider", lambda w, i: w.load_of(0.5 + 0.01 * i), (None, 100, 200)),
    ("tooth number", lambda w, i: w.typed("teeth", str(24 + i + 6 * (w.key == "load"))), (600, 1500, 1500)),
    ("profile shift", lambda w, i: w.typed("profile_shift", f"{0.05 + 0.002 * i:.3f}"), (600, 1500, 1500)),
    (
        "pressure angle",
        lambda w, i: w.typed_everywhere("pressure_angle", f"{20.1 + 0.05 * i:.2f} deg"),
        (600, 1500, 1500),
    ),
)


def measure(case: str, count: int, checkouts: list[Path]) -> None:
    """Print what one case takes, in this checkout and another."""
    print(case)
    windows = []
    for checkout in checkouts:
        window = Window(checkout, case)
        window.ready()
        started = time.monotonic()
        window.load()
        again = time.monotonic() - started
        window.ready()
        listening = f"listening after {window.listening:.2f}"
        there = f"with the browser and the server there {again:.2f} s (asked 1)"
        print(f"  {checkout.name}: usable after {window.usable:.2f} s (asked 3; {listening}), {there}", flush=True)
        windows.append(window)
    try:
        for kind, change, asked in KINDS:
            found = [Measured() for _ in windows]
            batches = 3 if asked[0] is None else 2
            each = count // batches if asked[0] is None else max(2, count // 10)
            for window in windows:
                window.answers([change(window, 0)], Measured())
                window.rest()
            for batch in range(batches):  # one checkout after the other, so that both meet the same company
                for window, one in zip(windows, found, strict=True):
                    steps = range(1 + batch * each, 1 + (batch + 1) * each)
                    if asked[0] is None:
                        window.answers([change(window, i) for i in steps], one)
                    else:
                        for i in steps:
                            window.answers([change(window, i)], one)
                            window.settle()
            for window, checkout, one in zip(windows, checkouts, found, strict=True):
                n = len(one.whole)
                first = f"first {at_share(one.first, 0.5):.0f} ms (asked {asked[0]}), " if asked[0] else ""
                print(
                    f"  {kind}, {checkout.name}: {first}median {at_share(one.whole, 0.5):.0f} ms (asked {asked[1]}), "
                    f"95 % {at_share(one.whole, 0.95):.0f} ms (asked {asked[2]}); "
                    f"processor: server {one.server / n:.0f} ms, browser {one.browser / n:.0f} ms",
                    flush=True,
                )
                window.rest()
        for window, checkout in zip(windows, checkouts, strict=True):
            delays = window.stroke(5.0)
            half = len(delays) // 2
            print(f"  ten changes a second, {checkout.name}: {len(delays)} answered, delay first half"
                  f" {at_share(delays[:half], 0.5):.0f} ms, second half {at_share(delays[half:], 0.5):.0f} ms,"
                  f" longest {max(delays, default=0.0):.0f} ms", flush=True)  # fmt: skip
            window.rest()
            print(f"  memory, {checkout.name}: {memory(window.server.pid):.0f} MB")
    finally:
        for window in windows:
            window.close()


@dataclass
class Kept:
    """What is held after garbage has been collected."""

    server: float
    browser: float
    heap: float
    counts: dict[str, int]
    scratch: float
    threads: int
    files: int

    @classmethod
    def now(cls, window: Window) -> Kept:
        """Of a window at rest with its case as it was at first.

        The browser lets garbage lie as long as memory is free, so it is told to collect it.
        """
        for words in ("Unpin A", "normal", "Give up changes"):
            window.browser.run(_press(words))
        for switch in ("Root stress", "Deformed", "Tool"):
            window.browser.run(
                "[...document.querySelectorAll('.mesh-tools [aria-pressed=true]')]"
                f".find((one) => one.textContent === '{switch}')?.click()"
            )
        time.sleep(1.0)
        window.settle()
        window.browser("HeapProfiler.collectGarbage")
        heap = window.browser("Runtime.getHeapUsage")["usedSize"] / 1e6
        pids = window.pids()[0]
        sizes = []  # what comes after the results, pictures for one, takes memory for a moment
        for _ in range(10):
            sizes.append(memory(window.server.pid))
            time.sleep(0.3)
        return cls(
            min(sizes), memory(window.browser.pid), heap, window.browser("Memory.getDOMCounters"),
            sum(path.stat().st_size for path in window.scratch.rglob("*") if path.is_file()) / 1e6,
            sum(len(list(Path(f"/proc/{pid}/task").iterdir())) for pid in pids),
            sum(len(list(Path(f"/proc/{pid}/fd").iterdir())) for pid in pids),
        )  # fmt: skip

    def __str__(self) -> str:
        counts = self.counts
        return (
            f"server and computing process {self.server:.0f} MB, {self.threads} threads, {self.files} files open, "
            f"scratch folder {self.scratch:.0f} MB; browser {self.browser:.0f} MB, script's heap {self.heap:.1f} MB, "
            f"{counts['nodes']} nodes, {counts['jsEventListeners']} listeners"
        )


def _press(words: str) -> str:
    return (
        f"[...document.querySelectorAll('button')].find((one) => one.textContent.trim() === '{words}' && !one.disabled)"
        "?.click()"
    )


def soak(case: str, minutes: float) -> None:
    """Print how much memory random changes leave taken."""
    window = Window(ROOT, case)
    window.ready()
    chance, count, base = random.Random(17), 0, None  # noqa: S311 - no secret
    begin = told = time.monotonic()
    end = begin + 60.0 * minutes
    kinds = {
        lambda: window.relief(chance.uniform(1, 12)): 6,
        lambda: window.load_of(chance.uniform(0.3, 1.5)): 6,
        lambda: window.relief(chance.uniform(1, 12), moving=False): 2,
        lambda: window.load_of(chance.uniform(0.3, 1.5), moving=False): 2,
        lambda: window.typed("teeth", str(chance.randint(20, 40))): 1,
        lambda: window.typed("profile_shift", f"{chance.uniform(-0.1, 0.3):.3f}"): 1,
        lambda: _press("Undo"): 1,
        lambda: _press("Redo"): 0.5,
        lambda: _press(chance.choice(("Pin as A", "Unpin A"))): 0.3,
        lambda: _press(chance.choice(("draft", "normal"))): 0.3,
        lambda: _press(chance.choice(("Root stress", "Deformed", "Tool"))): 0.3,
    }
    while time.monotonic() < end:
        window.browser.run(chance.choices(list(kinds), weights=kinds.values())[0]())
        count += 1
        time.sleep(chance.choice((0.05, 0.1, 0.1, 0.4, 1.5)))
        now = time.monotonic()
        if base is None and now - begin > 6.0 * minutes:
            base = Kept.now(window)
            print(f"{case}, after the first tenth: {base}", flush=True)
        if now - told > 60.0:
            told = now
            print(f"  after {(now - begin) / 60:.0f} min, {count} changes: {Kept.now(window)}", flush=True)
    last = Kept.now(window)
    print(f"{case}, {count} changes in {minutes:g} min: {last}")
    more = {name: last.counts[name] - before for name, before in base.counts.items()}
    print(f"  grown since the first tenth: server and computing process by {last.server - base.server:.0f} MB"
          f" (asked: less than 50 in an hour), browser by {last.browser - base.browser:.0f} MB,"
          f" its script's heap by {last.heap - base.heap:.1f} MB, {more['nodes']} nodes,"
          f" {more['jsEventListeners']} listeners;"
          f" left behind half a second after the end: {window.close() or 'nothing'}")  # fmt: skip


if __name__ == "__main__":
    parser = argparse.ArgumentParser()
    parser.add_argument("--answers", type=int, default=30)
    parser.add_argument("--case", choices=CASES)
    parser.add_argument("--against", type=Path)
    parser.add_argument("--soak", type=float)
    asked_for = parser.parse_args()
    for name in [asked_for.case] if asked_for.case else CASES:
        if asked_for.soak:
            soak(name, asked_for.soak)
        else:
            against = [asked_for.against.resolve()] if asked_for.against else []
            measure(name, asked_for.answers, [ROOT, *against])
