"""Cracked teeth by potential energy: limits, a prototype's numbers, and the study beside finite elements."""

import importlib.util
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import RangeError
from fegear.formulas import potential_energy
from fegear.formulas.potential_energy_crack import cracked_tooth_compliance

_PLACE = Path(__file__).parents[2] / "benchmarks" / "cracked_stiffness_study.py"
_spec = importlib.util.spec_from_file_location("cracked_stiffness_study", _PLACE)
study = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(study)
RADII = np.array([23.9e-3, 25.0e-3, 26.5e-3])


def test_a_crack_on_the_outline_is_none():
    gear = study.gear()
    whole = potential_energy.tooth_compliance(gear, RADII)
    for tip in ((3.0, 11.5), (0.1, 20.0)):  # outside the tooth; above its tip
        found = cracked_tooth_compliance(gear, RADII, tip)
        for part in ("bending", "shear", "axial", "foundation"):
            assert getattr(found, part) == pytest.approx(getattr(whole, part), rel=1e-12)


def test_half_a_tooth_bends_eight_times_as_much():
    """Dead up to the centre line over the whole beam: half the depth, an eighth of the moment of inertia."""
    gear = study.gear()
    whole, half = potential_energy.tooth_compliance(gear, RADII), cracked_tooth_compliance(gear, RADII, (0.0, 0.0))
    assert half.bending == pytest.approx(8.0 * whole.bending, rel=1e-9)
    assert half.shear == pytest.approx(2.0 * whole.shear, rel=1e-9)
    assert half.foundation == pytest.approx(whole.foundation, rel=1e-12)
    with pytest.raises(RangeError, match="must leave material in every beam section"):
        cracked_tooth_compliance(gear, RADII, (-1.2, 0.0))


def test_losses_are_those_of_a_prototype():
    """Written apart, on the same profile: 25 teeth, in per cent as printed."""
    wanted = {0.05: (0.3, 0.5), 0.1: (1.6, 2.2), 0.2: (5.7, 6.1), 0.3: (11.3, 11.3), 0.4: (18.7, 18.7),
              0.5: (29.4, 29.4), 0.6: (44.7, 44.7), 0.7: (65.4, 65.4)}  # fmt: skip
    for depth, losses in wanted.items():
        found = [100.0 * study.by_potential_energy(angle, depth) for angle in (70, 45)]
        assert found == pytest.approx(losses, abs=0.06)


def test_the_table_of_the_study_is_whole_and_says_what_its_page_says():
    rows = {(int(r["angle [deg]"]), float(r["depth"])): [float(r[name]) for name in study.HEAD[2:]]
            for r in study.table()}  # fmt: skip
    assert set(rows) == {(angle, depth) for angle in study.ANGLES for depth in study.DEPTHS}
    assert all(rows[angle, 0.1][1] < 0.6 * rows[angle, 0.1][0] for angle in study.ANGLES)
    assert all(rows[angle, 0.8][1] > 1.2 * rows[angle, 0.8][0] for angle in study.ANGLES)
    assert rows[45, 0.7][1] == rows[70, 0.7][1]
    for angle, depth in ((70, 0.05), (45, 0.7)):
        assert 100.0 * study.by_potential_energy(angle, depth) == pytest.approx(rows[angle, depth][1], rel=1e-3)


@pytest.mark.dear
def test_a_row_of_finite_elements_is_what_comes_out_now():
    rows = {(int(r["angle [deg]"]), float(r["depth"])): float(r["finite_elements [%]"]) for r in study.table()}
    assert 100.0 * study.by_finite_elements(70, 0.3) == pytest.approx(rows[70, 0.3], rel=2e-3)
