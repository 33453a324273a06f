"""The page of difficult cases: each one that is required has a line, and the tests of every line exist."""

import ast
import re
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
#: What has to hold, as it begins a line of the page.
MUST_HOLD = (
    "undercut pinions", "full-fillet racks", "tip rounding", "thin rims", "8 to 500 teeth", "Poisson's ratio 0.49",
    "loads from 1e-3 to 1e4 N/mm", "load at the tip edge and at the start of the involute",
    "contact ratio just above 1", "contact ratio exactly 2", "contact ratio 3.2", "contact ratio below 1",
    "relief so large that contact is lost", "identical and hunting numbers of teeth",
    "s = 0 and s = r loading functions", "q = 0 and q = 1 in their spectra", "zero damping at resonance",
    "speed to zero", "backlash with impacts on both flanks", "a shaft of zero stiffness",
    "a shaft of infinite stiffness", "a helix angle of zero",
    "misalignment tending to zero in tooth contact analysis",
    "rims below a backup ratio of 1.2", "tip interference of internal pairs", "rings with unknown cutter",
    "mass and inertia of shifted", "3D pairs with a transverse contact ratio below 1", "user tables",
    "one load in several definitions", "lives of ring gears", "a formula or a load level that fails",
    "no backlash due to rounding", "motions without a steady state", "forces of sets and meshes with jumps",
    "planetary stages of REXS models", "REXS models with invalid structure", "folders of runs, changed in any way",
    "pairs driven by their other gear", "documented defaults", "one byte of the program changed",
    "the window: other accounts",
)  # fmt: skip


def lines():
    text = (ROOT / "docs" / "hard-cases.md").read_text(encoding="utf-8")
    rows = [
        [cell.strip() for cell in line.strip("|").split("|")] for line in text.splitlines() if line.startswith("| ")
    ]
    return [row for row in rows if row[2] != "test"]


@pytest.mark.parametrize("case", MUST_HOLD)
def test_every_hard_case_has_a_line(case):
    found = [row for row in lines() if row[0].startswith(case)]
    assert len(found) == 1
    assert found[0][1]
    assert re.search(r"`test_\w+`", found[0][2])


def test_every_line_s_tests_exist_once():
    written = [
        name
        for path in (ROOT / "tests").rglob("test_*.py")
        for name in re.findall(r"^def (test_\w+)\(", path.read_text(encoding="utf-8"), re.MULTILINE)
    ]
    named = [name for row in lines() for name in re.findall(r"`(test_\w+)`", row[2])]
    assert len(named) > 60
    assert {name: written.count(name) for name in named} == dict.fromkeys(named, 1)


def test_tests_of_hard_cases_are_on_the_page():
    """A test under tests/hard that no line names would not be found by those who look for what holds."""
    text = (ROOT / "docs" / "hard-cases.md").read_text(encoding="utf-8")
    own = [
        node.name
        for path in (ROOT / "tests" / "hard").glob("test_*.py")
        if path != Path(__file__)
        for node in ast.parse(path.read_text(encoding="utf-8")).body
        if isinstance(node, ast.FunctionDef) and node.name.startswith("test_")
    ]
    minor = {
        "test_at_the_start_of_the_involute_the_limit_is_crossed_within_the_reported_error",
        "test_undamped_motion_beside_resonance_is_finite_on_both_sides",
        "test_a_new_body_s_torque_may_be_set_and_a_misspelt_table_is_named",
        "test_an_output_folder_below_a_file_is_reported_as_such",
        "test_an_interrupt_while_the_program_is_still_loading_is_reported_in_one_line",
    }
    assert {name for name in own if f"`{name}`" not in text} == minor
