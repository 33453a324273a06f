"""Example of annex C of ISO 6336-6: load cycles to pitting and damage of a load spectrum, level by level.

Source: ISO 6336-6:2019, annex C (table C.2), transcribed by G. Reboucas, github.com/gfsReboucas/Drivetrain,
data/table_C2.csv and MATISO_6336.m (example_load_spectra): sigma_Hlim = 1500 MPa, Z_L = 1.02, Z_v = .943, Z_R = 1.01.
"""

import math

import pytest

from fegear.formulas.iso6336.life import Knots
from fegear.formulas.iso6336.part6_spectrum import Bin, annex_c_line, cycles_to_failure, damage, spectrum_safety

#: sigma_H times the safety [MPa], load cycles, N_i and U_i of the levels with load, 3 to 44.
TABLE_C2 = (
    (2349, 2203, 90500, 0.0243), (2344, 1285, 92900, 0.0138), (2344, 825.9, 92900, 0.00889),
    (2340, 1285, 95400, 0.0135), (2335, 2570, 97900, 0.0262), (2330, 1285, 101000, 0.0128),
    (2326, 825.9, 103000, 0.008), (2321, 1744, 106000, 0.0165), (2316, 2570, 109000, 0.0236),
    (2312, 3028, 112000, 0.0271), (2307, 2203, 115000, 0.0192), (2297, 2203, 121000, 0.0182),
    (2293, 1744, 125000, 0.014), (2283, 2386, 132000, 0.0181), (2274, 4772, 139000, 0.0343),
    (2264, 4313, 147000, 0.0293), (2250, 5690, 160000, 0.0355), (2240, 8076, 170000, 0.0476),
    (2225, 6057, 185000, 0.0328), (2211, 14960, 202000, 0.0741), (2191, 16520, 227000, 0.0727),
    (2176, 7617, 249000, 0.0306), (2156, 18350, 281000, 0.0653), (2131, 19460, 329000, 0.0592),
    (2110, 9544, 373000, 0.0256), (2084, 21840, 440000, 0.0497), (2053, 23220, 538000, 0.0432),
    (2021, 18350, 662000, 0.0277), (1988, 18900, 820000, 0.023), (1955, 27260, 1020000, 0.0266),
    (1916, 29000, 1340000, 0.0217), (1870, 30650, 1850000, 0.0166), (1823, 32300, 2580000, 0.0125),
    (1785, 25150, 3420000, 0.00736), (1742, 26250, 4700000, 0.00558), (1693, 37080, 6860000, 0.0054),
    (1643, 39370, 10200000, 0.00385), (1593, 41210, 15400000, 0.00268), (1534, 42950, 25200000, 0.0017),
    (1467, 27810, 45700000, 0.000609), (1398, 16150, 190000000, 8.48e-05), (1318, 1101, 1310000000, 8.42e-07),
)  # fmt: skip
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
