"""Where each closed form stands against fegear's own finite elements: the tables of docs/formulas.md.

This is a comparison, not a validation: the finite elements have their own references. FE root stress is the largest
tangential stress of the fillet (full ring, bore at half the root radius); its own error estimate here is below 0.1 %.
"""

import math
import re
from pathlib import Path

import numpy as np
import pytest

from fegear.fem.plane.table import stiffness_table
from fegear.formulas import cornell_heywood as cornell
from fegear.formulas import hertz
from fegear.formulas.root_section import load_line
from fegear.formulas.root_stress_formulas import root_stress_table
from fegear.formulas.sources import SOURCES
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.rack import BasicRack

M = 3.175e-3
PAPER_TOOTH = Tooth(28, BasicRack(1.0, 1.34225, 0.22972), thickness_allowance=0.04203926)
PAPER = cornell.RootSection(
    1.75 * 25.4e-3 * math.cos(math.radians(20.0)), math.radians(3.98222), 1.016e-3, 40.909406e-3, 5.6958151e-3
)
ROLLS = np.array([0.2208, 0.2922, 0.3640, 0.4350, 0.5080])


@pytest.fixture(scope="module")
def paper_gear_fe():
    gear = Gear(PAPER_TOOTH, M, 0.5 * PAPER_TOOTH.root_radius * M, 6.35e-3, plane="stress")
    radii = gear.base_radius * np.hypot(1.0, ROLLS)
    return radii, stiffness_table(gear, radii, 8e-5)


def documented(start: str) -> dict[str, np.ndarray]:
    """Rows of the tables in docs/formulas.md whose first cell starts with `start`."""
    text = (Path(__file__).parents[2] / "docs" / "formulas.md").read_text()
    found = re.findall(r"^\| `(" + start + r"[^|]*) \|((?: \d\.\d\d \|){5})$", text, re.MULTILINE)
    return {name.replace("`", ""): np.array([float(v) for v in row.split("|")[:5]]) for name, row in found}


def test_cornells_five_percent_claim_for_the_papers_gear(paper_gear_fe):
    # Cornell's abstract: within about 5 % of test and finite elements. Measured here, from the start of the flank to
    # the tip: +1 %, +5 %, +11 %, +17 %, +22 % of FE. The claim holds near the base circle only; above it the formula
    # is on the safe side. The place drifts from 4 to 16 degrees of tangent angle above that of FE.
    _, fe = paper_gear_fe
    found = cornell.root_stress(PAPER, ROLLS)
    ratio = found.stress / fe.root_tension
    np.testing.assert_allclose(ratio, documented("cornell")["cornell, the paper's numbers"], atol=0.011)
    assert ratio[0] < 1.05 < ratio[1] < ratio[-1]
    shift = np.degrees(fe.root_tension_angle - found.angle)
    assert np.all(np.diff(shift) > 0.0)
    assert 2.0 < shift[0] < shift[-1] < 18.0


def test_every_formula_has_its_documented_ratio(paper_gear_fe):
    # to the two printed digits, with room for the finite elements' own 0.5 %
    radii, fe = paper_gear_fe
    table = root_stress_table(PAPER_TOOTH, radii / M)
    rows = documented("")
    for name, outcomes in table.items():
        ratio = np.array([o.unwrap().stress for o in outcomes]) / M / fe.root_tension
        # the generated tooth has the paper's root to its digits, so one row serves both
        row = rows["cornell, the paper's numbers" if name == "cornell" else name]
        np.testing.assert_allclose(ratio, row, atol=0.011, err_msg=name)


@pytest.mark.dear("0.25")
@pytest.mark.parametrize("bore", [0.5, 0.25])
def test_tooth_compliance_in_plane_stress(bore):
    tooth = Tooth(28, BasicRack(1.0, 1.25, 0.25))
    gear = Gear(tooth, 1e-3, bore * tooth.root_radius * 1e-3, plane="stress")
    radii = np.linspace(1.01 * gear.form_radius, 0.99 * gear.tip_radius, 5)
    width = 0.02e-3
    # the tooth alone: FE less the contact zone down to the tooth's centre line along the line of action
    depth = load_line(tooth, radii / 1e-3).depth * 1e-3
    m = gear.material
    contact = hertz.approach(1.0, width, depth, m.young_modulus, m.poisson_ratio, "stress")
    body = stiffness_table(gear, radii, width).c_self - contact
    for name, source in SOURCES.items():
        ratio = source.tooth(gear, radii).total / body
        np.testing.assert_allclose(ratio, documented(name)[f"{name}, bore {bore:.2f}"], atol=0.011, err_msg=name)
