"""Example of annex C of ISO 6336-6: load cycles to pitting and damage of a load spectrum, level by level.

Source: ISO 6336-6:2019, annex C (table C.2), transcribed by G. Reboucas, github.com/gfsReboucas/Drivetrain,
data/table_C2.csv and MATISO_6336.m (example_load_spectra): sigma_Hlim = 1500 MPa, Z_L = 1.02, Z_v = .943, Z_R = 1.01.
"""

import math

import pytest

from fegear.formulas.iso6336.life import Knots
from fegear.formulas.iso6336.part6_spectrum import Bin, annex_c_line, cycles_to_failure, damage, spectrum_safety
from fegear.verify.kept import kept

#: sigma_H times the safety [MPa], load cycles, N_i and U_i of the levels with load, 3 to 44.
TABLE_C2 = tuple(map(tuple, kept("iso6336_6_annex_c")["levels"]))
#: Z_NT of case-hardened steel, and the film factors that the example prints.
LIFE = Knots((1e5, 5e7, 1e10), (1.6, 1.0, 0.85))
FILM = 1.02 * 0.943 * 1.01
ANNEX = annex_c_line(LIFE, 1500e6 * FILM)
#: ISO 6336-2: no film factors at rest.
PART_2 = Knots(LIFE.cycles, (1500e6 * 1.6, 1500e6 * FILM, 1500e6 * FILM * 0.85))


def bins(line):
    return [Bin(stress * 1e6, cycles, line) for stress, cycles, *_ in TABLE_C2]


@pytest.mark.parametrize("level", TABLE_C2[::3])
def test_load_cycles_to_pitting_are_those_of_the_table(level):
    stress, cycles, borne, harm = level
    found = cycles_to_failure(ANNEX, stress * 1e6)
    # half a unit of the stress moves N by .3 % above the knee and 1.2 % below it; N_i has three digits
    assert found == pytest.approx(borne, rel=0.006 if borne < 5e7 else 0.02)
    assert cycles / found == pytest.approx(harm, rel=0.012 if borne < 5e7 else 0.025)


def test_the_damage_of_the_example_is_1_and_the_line_of_part_2_is_2_percent_above():
    assert sum(harm for *_, harm in TABLE_C2) == pytest.approx(1.0, abs=1e-3)
    assert damage(bins(ANNEX)) == pytest.approx(1.0, abs=3e-3)
    assert spectrum_safety(bins(ANNEX)) == pytest.approx(1.0, abs=3e-4)
    assert spectrum_safety(bins(PART_2)) == pytest.approx(1.022, abs=5e-4)


def test_the_line_of_annex_c_goes_on_straight_above_static_strength():
    assert ANNEX.cycles[0] == 1e4
    slope = [
        math.log(a / b) / math.log(n / m)
        for (a, b), (m, n) in zip(
            zip(ANNEX.values[:2], ANNEX.values[1:3], strict=True),
            zip(ANNEX.cycles[:2], ANNEX.cycles[1:3], strict=True),
            strict=True,
        )
    ]
    assert slope[0] == pytest.approx(slope[1], rel=1e-12)
    assert ANNEX.at(5e7) == pytest.approx(1500e6 * FILM, rel=1e-12)
