"""Figs. 26 to 29 of NASA CR-3626 (W. D. Mark 1982): what the text says of root stress by Cornell's formula."""

import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest

from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.formulas import cornell_heywood as cornell
from fegear.results.catalogue import STAGES

SOURCES = Path(__file__).parents[2] / "cases" / "sources"
R_B = 44.45e-3 * math.cos(math.radians(20.0))
BASE_PITCH = 2.0 * math.pi * R_B / 28
#: The paper's own numbers (5.18 to 5.22).
SECTION = cornell.RootSection(R_B, math.radians(3.98222), 1.016e-3, 40.909406e-3, 5.6958151e-3)
FACE = 6.35e-3
STRAIGHT, LEAST = ("mark_fig22", 13.7450e-3), ("mark_fig23", 12.2971e-3)


@cache
def histories(name):
    """Tables of the force on a tooth, and of the stress of the driving and the driven gear."""
    scene = read_scene(SOURCES / f"{name}.toml", ("pair.I.root_stress={source='cornell'}",))
    tables = run_plan(scene, make_plan(scene, STAGES)).tables
    found = {table.name: {column.head: column.values for column in table.columns} for table in tables}
    return (found["tooth_force_I"], found["root_stress_history_I_test"], found["root_stress_history_I_test_driven"])


@pytest.mark.parametrize(("name", "length"), [STRAIGHT, LEAST])
def test_stress_is_the_force_of_figs_22_and_23_times_the_papers_own_section(name, length):
    """Eq. 3.37 with 5.17 to 5.22, from the generated tooth and by hand: to the digits of the rack, 1e-5."""
    force, driving, driven = histories(name)
    for table, sign in ((driving, 1.0), (driven, -1.0)):
        roll = (R_B * math.tan(math.radians(20.0)) + sign * force["x [mm]"] * 1e-3) / R_B
        expected = cornell.root_stress(SECTION, roll).stress * force["force [N]"] / FACE * 1e-6
        np.testing.assert_allclose(table["stress_own_mesh [MPa]"], expected, rtol=2e-5, atol=1e-3)


@pytest.mark.parametrize(("name", "length"), [STRAIGHT, LEAST])
def test_stress_is_largest_at_the_highest_point_of_single_tooth_contact(name, length):
    _, driving, driven = histories(name)
    hpstc = (BASE_PITCH - 0.5 * length) * 1e3
    for table, sign in ((driving, 1.0), (driven, -1.0)):
        worst = table["x [mm]"][int(np.argmax(table["stress_own_mesh [MPa]"]))]
        assert sign * worst == pytest.approx(hpstc, abs=0.03)


@pytest.mark.parametrize(("name", "off"), [(STRAIGHT[0], 0.02), (LEAST[0], 1e-3)])
def test_driving_and_driven_gear_are_mirror_images(name, off):
    """Almost, with straight relief; almost perfectly, with that of least excitation."""
    _, driving, driven = histories(name)
    mirrored = np.interp(-driving["x [mm]"], driven["x [mm]"], driven["stress_own_mesh [MPa]"])
    difference = np.abs(mirrored - driving["stress_own_mesh [MPa]"]).max() / driving["stress_own_mesh [MPa]"].max()
    assert 0.5 * off < difference < off


def test_stresses_of_straight_relief_run_lower():
    """Where one tooth pair carries all, and for most of the engagement; not where contact begins with a step."""
    x = np.linspace(-6.1, 6.1, 401)
    for member in (1, 2):
        straight, least = (
            np.interp(x, histories(name)[member]["x [mm]"], histories(name)[member]["stress_own_mesh [MPa]"])
            for name, _ in (STRAIGHT, LEAST)
        )
        alone = np.abs(x) < (BASE_PITCH - 0.5 * STRAIGHT[1]) * 1e3
        assert (straight[alone] < least[alone]).all()
        assert np.mean(straight < least) > 0.65
        assert straight.max() < 0.9 * least.max()
        assert straight[0] > least[0]
