"""How soon the pictures of `fegear open` follow a relief point that is dragged: from pointer event to painted curve.

    python benchmarks/bench_drag.py [--moves 60] [--case NAME] [--against CHECKOUT]

A real pointer takes the point of the driver's tip relief and moves it ten times a second (five times for a pair with
its width) in sight of the small pictures; the arrows of the pinion's tooth number and profile shift likewise, one step
a move. Every move counts when the pictures that answer it, drawn from that very case or a later one, have been painted:
of a number those of transmission error, load sharing and root stress. Half of the profile shifts lie outside the atlas.
The next numbers of a row are computed ahead; with `--steps` a move is two or three steps, which is foreseen in part.

Printed for each case: median, 95th percentile and largest of the milliseconds, the median of the first and second half
(a delay that grows shows there), and the processor milliseconds for one move of the page's server, the computing
process and the browser: a machine that does other things as well stretches the first, not these. `--against` drags in
another checkout in turn, so that both meet the same company, and prints the ratios.
"""

from __future__ import annotations

import argparse
import contextlib
import importlib.util
import json
import sys
import time
from dataclasses import dataclass, field
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
ERROR = {"te": "transmission-error"}
ANSWERS = {**ERROR, "sharing": "load-sharing", "root": "root-stress-history"}
#: Case, the small pictures that answer with their stages, changes a second, and the milliseconds asked for: median and
#: 95 %.
CASES = {
    "drive": (ERROR, 10.0, (100, 200)),
    "helical_load": ({"line-load": "load-distribution"}, 5.0, (250, 500)),
    "teeth": (ANSWERS, 10.0, (50, 100)),
    "profile_shift": (ANSWERS, 10.0, (50, 100)),
}
#: Numbers of the pinion that are dragged in the form, and pixels of a step; of all other cases the tip relief's point.
NUMBERS = {"teeth": 12.0, "profile_shift": 4.0}
#: The spur pair of the tutorial with tip reliefs, solved by finite elements, the stress inside shown.
DRIVE = """title = "Drag"
results = ["load-sharing", "transmission-error", "root-stress-history"]
[gear.pinion]
teeth = 21
module = "3 mm"
profile_shift = 0.3
face_width = "30 mm"
relief = { tip = { amount = "20 um", length = "4 mm" } }
[gear.wheel]
teeth = 53
module = "3 mm"
profile_shift = 0.1
face_width = "30 mm"
relief = { tip = { amount = "20 um", length = "4 mm" } }
[pair.I]
driver = "pinion"
driven = "wheel"
torque = "260 N*m"
[effects]
neighbour_coupling = true
hertz = "load-dependent"
relief = true
corner_contact = true
"""
WATCH = """
(() => {
  const made = ([name, stage]) => ({ name, task: `${stage} of I`, newest: 0, painted: 0 });
  const pictures = Object.entries(%s).map(made), hear = fegear.hear;
  let moved = [];
  const delays = window.delays = [];
  const answered = () => {
    const now = performance.now(), number = Math.min(...pictures.map((one) => one.painted));
    for (const one of moved) if (one.number <= number) delays.push(now - one.at);
    moved = moved.filter((one) => !(one.number <= number));
  };
  addEventListener("pointermove", ({ buttons }) => { if (buttons) moved.push({ at: performance.now() }); }, true);
  fegear.hear = (what, content) => {
    if (what === "asked") for (const one of moved) one.number ??= content.number ?? 0;
    const line = hear(what, content), of = what === "found" && pictures.find((one) => one.task === content.task);
    if (of) line.then(() => {
      of.newest = Math.max(of.newest, content.number ?? 0);
      if (content.figures.every((one) => one.same)) { of.painted = of.newest; answered(); } // it stays as it is
    });
    return line;
  };
  for (const one of pictures) new MutationObserver(() => {
    const number = one.newest; // drawn within this frame: painted before the next
    requestAnimationFrame(() => { one.painted = Math.max(one.painted, number); answered(); });
  }).observe(document.querySelector(`[data-picture="${one.name}"]`), {
    attributes: true, attributeFilter: ["data-count"],
  });
  window.unanswered = () => moved.length;
})()
"""


def _windows():
    spec = importlib.util.spec_from_file_location("bench_window", ROOT / "benchmarks" / "bench_window.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules["bench_window"] = module
    spec.loader.exec_module(module)
    return module


@dataclass
class Dragged:
    """Milliseconds of every move, and of processors over all of them."""

    delays: list[float] = field(default_factory=list)
    halves: tuple[list[float], list[float]] = field(default_factory=lambda: ([], []))
    moves: int = 0
    server: float = 0.0
    computing: float = 0.0
    browser: float = 0.0


class Drag:
    """One checkout's window with a case, ready to be dragged in."""

    def __init__(
        self, bench, checkout: Path, case: Path, pictures: dict[str, str], number: str = "", *, irregular: bool = False
    ) -> None:
        self.bench, self.window, self.step = bench, bench.Window(checkout, case), NUMBERS.get(number, 0.0)
        self._irregular, self._along = irregular, 0
        self.browser = self.window.browser
        self.browser.size(1300, 800)
        self.browser("Network.disable")  # else every message to the page is written down for who drives the browser
        plot = f"document.querySelector('[data-picture=\"{next(iter(pictures))}\"] .small-plot path')"
        for _ in range(6):
            with contextlib.suppress(TimeoutError):
                self.browser.until(f"!document.body.classList.contains('computing') && {plot} !== null")
                break
        self.browser.run(WATCH % json.dumps(pictures))
        find = "document.querySelector('[data-handle$=\" tip amount\"]')"
        if not self.browser.run(f"{find} !== null"):  # no relief yet: 10 um from the usual point
            self.browser.click(
                "[...document.querySelectorAll('button')].find((one) => one.textContent === 'Add tip relief')"
            )
            self.browser.until(f"{find} !== null && !document.body.classList.contains('computing')")
        if number:
            field = f"document.querySelector('[data-key=\"gear.pinion.{number}\"]')"
            self.browser.until(f"{field} !== null")
            find = f"{field}.closest('.scrubs').querySelector('.q-field__inner')"
            self.browser.run(f"{find}.scrollIntoView({{ block: 'center' }})")
        self._rounds = 0
        self.at = self.browser.run(f"(b => [b.x + b.width / 2, b.y + b.height / 2])({find}.getBoundingClientRect())")
        if number:  # the arrow in the corner
            self.at = self.browser.run(f"(b => [b.right - 7, b.top + 7])({find}.getBoundingClientRect())")

    def _mouse(self, kind: str, along: float) -> None:
        x, y = self.at
        x, y = (x + along, y) if self.step else (x, y + along)
        self.browser("Input.dispatchMouseEvent", type=kind, x=x, y=y, button="left", buttons=1, clickCount=1)

    def drag(self, moves: int, every: float, found: Dragged) -> None:
        """Take the point, move it so many times up and down, and let go where it was; never twice to one place."""
        self._rounds += 1
        server, browser = self.window.pids()
        parts = [server[:1], server[1:], browser]
        before = [self.bench.processor(one) for one in parts]
        self.browser.run("delays.length = 0")
        self._mouse("mousePressed", 0.0)
        for i in range(moves):
            started = time.monotonic()
            further = 3.0 + (i % 8) * 2.0 + 0.3 * (i // 8) + 0.07 * self._rounds
            self._along += 2 + i % 2 if self._irregular else 1
            self._mouse("mouseMoved", self.step * self._along if self.step else further)
            time.sleep(max(0.0, every - (time.monotonic() - started)))
        for _ in range(100):
            if self.browser.run("unanswered()") == 0:
                break
            time.sleep(0.02)
        delays = self.browser.run("[...delays]")
        after = [self.bench.processor(one) for one in parts]
        self._mouse("mouseMoved", 0.0)
        self._mouse("mouseReleased", 0.0)
        self.browser.until("!document.body.classList.contains('computing')")
        half = len(delays) // 2
        found.delays += delays
        found.halves[0].extend(delays[:half])
        found.halves[1].extend(delays[half:])
        found.moves += moves
        spent = [1e3 * (b - a) for a, b in zip(before, after, strict=True)]
        found.server, found.computing, found.browser = (
            x + y for x, y in zip((found.server, found.computing, found.browser), spent, strict=True)
        )


def measure(name: str, moves: int, checkouts: list[Path], folder: Path, *, irregular: bool = False) -> None:
    """Print the table of one case."""
    bench = _windows()
    pictures, rate, asked = CASES.get(name, CASES["drive"])
    case = ROOT / "cases" / f"{name}.toml"
    if name in ("drive", *NUMBERS):
        case = folder / "drive.toml"
        case.write_text(DRIVE)
    number = name if name in NUMBERS else ""
    drags = [Drag(bench, checkout, case, pictures, number, irregular=irregular) for checkout in checkouts]
    found = [Dragged() for _ in drags]
    try:
        for drag in drags:
            drag.drag(8, 1.0 / rate, Dragged())
        for _ in range(3):
            for drag, one in zip(drags, found, strict=True):
                drag.drag(max(moves // 3, 4), 1.0 / rate, one)
    finally:
        for drag in drags:
            drag.window.close()
    print(f"{name}, {rate:g} moves a second, asked: median {asked[0]} ms, 95 % {asked[1]} ms")
    print(f"  {'checkout':<12}{'moves':>6}{'lost':>5}{'median':>8}{'95 %':>7}{'most':>7}{'1st half':>9}{'2nd half':>9}"
          f"{'server':>8}{'computing':>10}{'browser':>8}   [ms]")  # fmt: skip
    for checkout, one in zip(checkouts, found, strict=True):
        at, n = bench.at_share, max(one.moves, 1)
        print(
            f"  {checkout.name:<12}{one.moves:>6}{one.moves - len(one.delays):>5}{at(one.delays, 0.5):>8.0f}"
            f"{at(one.delays, 0.95):>7.0f}{max(one.delays, default=0.0):>7.0f}{at(one.halves[0], 0.5):>9.0f}"
            f"{at(one.halves[1], 0.5):>9.0f}{one.server / n:>8.0f}{one.computing / n:>10.0f}{one.browser / n:>8.0f}",
            flush=True,
        )
    if len(found) == 2:
        first, second = found
        shares = [(bench.at_share(first.delays, 0.5), bench.at_share(second.delays, 0.5))]
        shares += [(getattr(first, part), getattr(second, part)) for part in ("server", "computing", "browser")]
        ratios = [f"{a / b:.2f}" if b else "-" for a, b in shares]
        print("  ratios (median, server, computing, browser): " + ", ".join(ratios))


if __name__ == "__main__":
    import tempfile

    parser = argparse.ArgumentParser()
    parser.add_argument("--moves", type=int, default=60)
    parser.add_argument("--case", help="one of the four, or a spur pair of cases/ with a relief to drag")
    parser.add_argument("--steps", action="store_true", help="two and three steps a move in turn, of numbers")
    parser.add_argument("--against", type=Path)
    asked_for = parser.parse_args()
    trees = [ROOT] + ([asked_for.against.resolve()] if asked_for.against else [])
    with tempfile.TemporaryDirectory() as scratch:
        for one in [asked_for.case] if asked_for.case else CASES:
            measure(one, asked_for.moves, trees, Path(scratch), irregular=asked_for.steps)
