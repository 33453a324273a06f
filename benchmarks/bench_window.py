"""How soon `fegear open` answers in chromium: a dragged relief point, the load slider, another tooth number, the start.

    python benchmarks/bench_window.py [ANSWERS]

Every change is made in the page, and its answer counts when load sharing, transmission error and root stress are there
and what is in sight is painted. Printed: median and 95th percentile of the milliseconds over so many answers (30), the
delay of the last answer after five seconds of ten changes a second, and the memory of the server and its computing
process before and after.
"""

from __future__ import annotations

import importlib.util
import os
import shutil
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

ROOT = Path(__file__).resolve().parents[1]
CASES = ("pinion_and_wheel", "nasa_relief_design")
WATCH = """
(() => {
  const wanted = ["load-sharing of I", "transmission-error of I", "root-stress-history of I"];
  const hear = fegear.hear;
  let seen = new Set(), first = 0, waiting = null;
  fegear.hear = (what, content) => {
    const line = hear(what, content);
    if (what === "asked") { seen = new Set(); first = 0; }
    if (what === "found") line.then(() => requestAnimationFrame(() => {
      if (content.values) first ||= performance.now();
      if (wanted.includes(content.task)) seen.add(content.task);
      if (seen.size === wanted.length && waiting) { waiting([first, performance.now()]); waiting = null; }
    }));
    return line;
  };
  window.answer = (change) => new Promise((done) => {
    const start = performance.now();
    waiting = (times) => done(times.map((one) => one - start));
    change();
  });
})()
"""


def _browser():
    spec = importlib.util.spec_from_file_location("chromium", ROOT / "tests" / "cases" / "chromium.py")
    module = importlib.util.module_from_spec(spec)
    sys.modules["chromium"] = module
    spec.loader.exec_module(module)
    return module.Browser(shutil.which("chromium") or shutil.which("chromium-browser"))


def memory(pid: int) -> float:
    """Of a process and its children [MB]."""
    found = subprocess.run(["ps", "-o", "pid=,ppid=,rss=", "-A"], capture_output=True, text=True, check=True).stdout
    rows = [tuple(map(int, line.split())) for line in found.splitlines()]
    family = {pid}
    for _ in range(3):
        family |= {one for one, parent, _ in rows if parent in family}
    return sum(size for one, _, size in rows if one in family) / 1024


def told(name: str, times: list[list[float]], column: int = 1) -> None:
    """Print median and 95th percentile of some answers."""
    found = sorted(one[column] for one in times)
    print(f"  {name}: {statistics.median(found):.0f} ms, 95 %: {found[int(0.95 * (len(found) - 1))]:.0f} ms")


def measure(name: str, count: int) -> None:
    """Print what one case takes."""
    with tempfile.TemporaryDirectory() as state, _browser() as browser:
        started = time.monotonic()
        server = subprocess.Popen(
            [sys.executable, "-m", "fegear", "open", "--no-browser", str(ROOT / "cases" / f"{name}.toml")],
            stdout=subprocess.PIPE, text=True, env=os.environ | {"FEGEAR_STATE": state, "PYTHONUNBUFFERED": "1"},
        )  # fmt: skip
        try:
            browser("Page.navigate", url=server.stdout.readline().split()[-1])
            browser.until("document.documentElement?.dataset.ready !== undefined")
            print(f"{name}\n  usable after {time.monotonic() - started:.2f} s")
            browser.until("!document.body.classList.contains('computing') && window.fegear !== null"
                          " && document.querySelectorAll('#results .js-plotly-plot').length > 3")  # fmt: skip
            browser.run(WATCH)
            gear = browser.run("document.querySelector('[data-key$=\".teeth\"]').dataset.key.split('.')[1]")
            key = "torque" if "torque" in (ROOT / "cases" / f"{name}.toml").read_text() else "load"
            unit = "N*m" if key == "torque" else "N"
            base = 90 if key == "torque" else 1615

            def relief(amount: float) -> str:
                content = f"{{gear: '{gear}', end: 'tip', start: 30, amount: {amount}, moving: true}}"
                return f"emitEvent('relief', {content})"

            def load(share: float) -> str:
                return (
                    f"emitEvent('load', {{pair: 'I', key: '{key}', text: '{base * share:.5g} {unit}', moving: true}})"
                )

            browser.run(f"answer(() => {relief(5.0)})")
            before = memory(server.pid)
            told("dragged relief point", [browser.run(f"answer(() => {relief(6 + 0.1 * i)})") for i in range(count)])
            told("load slider", [browser.run(f"answer(() => {load(0.5 + 0.01 * i)})") for i in range(count)])
            end = time.monotonic() + 5.0
            i = 0
            while time.monotonic() < end:
                i += 1
                browser.run(relief(8 + 0.01 * i))
                time.sleep(0.1)
            last = browser.run(f"answer(() => {relief(3.3)})")
            print(f"  after {i} changes in 5 s the last is answered within {last[1]:.0f} ms")
            field = f"document.querySelector('[data-key=\"gear.{gear}.teeth\"]')"
            browser.run(f"{field}.focus()")
            press = f"{field}.dispatchEvent(new KeyboardEvent('keydown', {{key: 'ArrowUp', bubbles: true}}))"
            teeth = [browser.run(f"answer(() => {press})") for _ in range(max(4, count // 6))]
            told("another tooth number, first answer", teeth, 0)
            told("another tooth number, all of it", teeth)
            print(f"  memory {before:.0f} MB, then {memory(server.pid):.0f} MB")
        finally:
            server.terminate()
            server.wait(20)


if __name__ == "__main__":
    for case in CASES:
        measure(case, int(sys.argv[1]) if len(sys.argv) > 1 else 30)
