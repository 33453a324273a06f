"""Load sharing, charts and a full case: what the issue asks 0.15 s, 3 s and 4 s for.

Run with ``pytest benchmarks/bench_contact.py --benchmark-only``.
"""

import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.transmission_error import transmission_error
from fegear.design.charts import relief_chart
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack


@pytest.fixture(scope="module")
def engagement():
    tooth = Tooth(28, BasicRack(1.0, 1.25, 0.25))
    gear = Gear(tooth, 3.175e-3, 0.02, 6.35e-3)
    source = finite_element_compliance(solve_gear(gear, reach=2, estimate_error=False))
    return Engagement(PairCompliance(GearPair(gear, gear), source, source))


@pytest.mark.parametrize("corner_contact", [False, True])
def test_200_positions_by_50_loads(benchmark, engagement, corner_contact):
    e = Engagement(engagement.compliance, corner_contact=corner_contact)
    x = e.pair.x_start + e.pair.base_pitch * (np.arange(200) + 0.5) / 200
    grid, loads = e.grid(x), np.geomspace(1.0, 6e4, 50)
    got = benchmark(e.solve, grid, loads)
    assert got.loads.shape[1:] == (200, 50)


def test_relief_chart_20_by_30_by_5(benchmark, engagement):
    chart = benchmark(
        relief_chart, engagement, np.linspace(1e-6, 3e-5, 20), np.linspace(0.1, 1.28, 30), np.linspace(500, 2500, 5)
    )
    assert chart.effective_error.shape == (20, 30, 5)


def test_transmission_error_with_64_harmonics(benchmark, engagement):
    assert benchmark(transmission_error, engagement, 1615.0).peak_to_peak > 0


COLD = """
import numpy as np
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.transmission_error import transmission_error
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.external_tooth import Tooth
gears = [Gear(Tooth(z, BasicRack(1.0, 1.25, 0.25)), 3e-3, b, 10e-3) for z, b in ((23, 0.015), (57, 0.04))]
sources = [finite_element_compliance(solve_gear(g, reach=2, estimate_error=False)) for g in gears]
e = Engagement(PairCompliance(GearPair(*gears), *sources))
x = e.pair.x_start + e.pair.base_pitch * (np.arange(200) + 0.5) / 200
e.solve(e.grid(x), [3000.0])
print(transmission_error(e, 3000.0).effective_error)
"""


def test_two_different_gears_from_cold(benchmark):
    benchmark.pedantic(lambda: subprocess.run([sys.executable, "-c", COLD], check=True, capture_output=True), rounds=3)


def test_full_case_from_cold(benchmark, tmp_path):
    """`fegear run` of two different gears: influence functions with errors, sharing, harmonics, root stress, tables."""
    case = Path(__file__).parents[1] / "cases" / "pinion_and_wheel.toml"
    command = "from fegear.cli import main; main()"
    arguments = [sys.executable, "-c", command, "run", str(case), "--no-plots", "--out", str(tmp_path / "out")]
    benchmark.pedantic(lambda: subprocess.run(arguments, check=True, capture_output=True), rounds=3)
