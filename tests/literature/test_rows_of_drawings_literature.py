"""Tables that drawings and catalogues lean on: every number by the rule that its standard made it with."""

import itertools
import math

import numpy as np
import pytest

from fegear.case import strength
from fegear.formulas import din3967
from fegear.geometry import named_racks, over_balls
from fegear.shafts import load_ratings

#: Renard's preferred numbers, ISO 3, unrounded: 10^(k/40).
EXACT_R40 = 10.0 ** (np.arange(41) / 40.0)


def test_preferred_numbers_are_renards():
    known = np.array(over_balls._R40)
    assert known.size == 41
    assert np.abs(known / EXACT_R40 - 1.0).max() < 0.016  # ISO 3's own roundings, R"40
    assert (np.diff(known) > 0.0).all()
    assert known[::10] == pytest.approx([1.0, 1.8, 3.15, 5.6, 10.0], rel=0.013)


def test_tolerances_of_din_3967_are_one_row_of_steps_moved_on():
    """Every row goes through preferred numbers of the same series, about R 5, from a start of its own."""
    table = np.array(din3967._TOLERANCE)
    ratios = table[:, 1:] / table[:, :-1]
    assert ratios.min() >= 1.5
    assert ratios.max() <= 5.0 / 3.0 + 1e-12
    assert (table[1:] / table[:-1]).min() >= 1.17
    assert (table[1:] / table[:-1]).max() <= 5.0 / 3.0 + 1e-12
    mantissa = table / 10.0 ** np.floor(np.log10(table))
    allowed = {1.0, 1.2, 1.3, 1.6, 2.0, 2.4, 2.5, 3.0, 4.0, 5.0, 6.0, 8.0}
    assert {round(float(one), 6) for one in mantissa.ravel()} <= allowed
    rows = [(3, 5, 8, 12, 20, 30, 50, 80, 130, 200), (12, 20, 30, 50, 80, 130, 200, 300, 500, 800)]
    assert [din3967._TOLERANCE[0], din3967._TOLERANCE[5]] == rows


def test_every_row_of_din_3967_is_read_as_it_is_printed():
    """Tables 1 and 2 once more, by series: upper allowance and tolerance [um] of the eleven rows of diameters."""
    ends = (10, 50, 125, 280, 560, 1000, 1600, 2500, 4000, 6300, 10000)
    upper = {
        "a": (100, 135, 180, 250, 330, 450, 600, 820, 1100, 1500, 2000),
        "ab": (85, 110, 150, 200, 280, 370, 500, 680, 920, 1250, 1650),
        "b": (70, 95, 125, 170, 230, 310, 420, 560, 760, 1020, 1350),
        "bc": (58, 75, 105, 140, 190, 260, 340, 460, 620, 840, 1150),
        "c": (48, 65, 85, 115, 155, 210, 290, 390, 520, 700, 940),
        "cd": (40, 54, 70, 95, 130, 175, 240, 320, 430, 580, 780),
        "d": (33, 44, 60, 80, 110, 145, 200, 270, 360, 480, 640),
        "e": (22, 30, 40, 56, 75, 100, 135, 180, 250, 330, 450),
        "f": (10, 14, 19, 26, 35, 48, 64, 85, 115, 155, 210),
        "g": (5, 7, 9, 12, 17, 22, 30, 41, 56, 75, 100),
        "h": (0,) * 11,
    }
    tolerance = {
        21: (3, 5, 6, 8, 10, 12, 16, 20, 25, 30, 40), 22: (5, 8, 10, 12, 16, 20, 25, 30, 40, 50, 60),
        23: (8, 12, 16, 20, 25, 30, 40, 50, 60, 80, 100), 24: (12, 20, 25, 30, 40, 50, 60, 80, 100, 130, 160),
        25: (20, 30, 40, 50, 60, 80, 100, 130, 160, 200, 250), 26: (30, 50, 60, 80, 100, 130, 160, 200, 250, 300, 400),
        27: (50, 80, 100, 130, 160, 200, 250, 300, 400, 500, 600),
        28: (80, 130, 160, 200, 250, 300, 400, 500, 600, 800, 1000),
        29: (130, 200, 250, 300, 400, 500, 600, 800, 1000, 1300, 1600),
        30: (200, 300, 400, 500, 600, 800, 1000, 1300, 1600, 2000, 2400),
    }  # fmt: skip
    for row, end in enumerate(ends):
        for millimetres in (end, (ends[row - 1] if row else 0) + 1e-3):
            for letter, of_rows in upper.items():
                found = din3967.thickness_limits(f"{letter}25", millimetres * 1e-3)
                assert found == pytest.approx((of_rows[row] * 1e-6, tolerance[25][row] * 1e-6), rel=1e-9)
            for number, of_rows in tolerance.items():
                found = din3967.thickness_limits(f"cd{number}", millimetres * 1e-3)
                assert found == pytest.approx((upper["cd"][row] * 1e-6, of_rows[row] * 1e-6), rel=1e-9)


def test_allowances_of_din_3967_fall_along_the_letters_and_grow_with_the_diameter():
    table = np.array(din3967._UPPER, dtype=float)
    assert (table[:, -1] == 0.0).all()
    along, down = table[:, :-1] / np.maximum(table[:, 1:], 1e-9), table[1:, :-1] / table[:-1, :-1]
    assert along[:, :-1].min() > 1.15
    assert along[:, :7].max() < 1.51
    assert down.min() > 1.2
    assert down.max() < 1.5
    # About geometric in both directions: each number by those beside it.
    log = np.log(table[:, :7])
    assert np.abs(log[:, 2:] - 2.0 * log[:, 1:-1] + log[:, :-2]).max() < 0.18
    assert np.abs(log[2:] - 2.0 * log[1:-1] + log[:-2]).max() < 0.13
    assert din3967._UPPER[3] == (250, 200, 170, 140, 115, 95, 80, 56, 26, 12, 0)


def test_tip_roundings_of_din_3972_are_a_fifth_of_the_module_from_2_5_mm_on():
    for module, rounding in named_racks._TIP_ROUNDING.items():
        if module >= 3.5:
            assert rounding == pytest.approx(0.2 * module, abs=0.051)
        assert rounding <= 0.2 * module + 1e-12
    sizes = list(named_racks._TIP_ROUNDING.items())
    assert all(a[0] < b[0] and a[1] <= b[1] for a, b in itertools.pairwise(sizes))
    small = {1.0: 0.08, 1.25: 0.12, 1.5: 0.2, 1.75: 0.25, 2.0: 0.3, 2.25: 0.4, 2.5: 0.5, 2.75: 0.5, 3.0: 0.6, 3.25: 0.6}
    assert {module: named_racks._TIP_ROUNDING[module] for module in small} == small
    assert all(rounding == pytest.approx(0.2 * module) for module, rounding in sizes if module >= 4.0 or module == 3.5)


def test_rockwell_of_vickers_is_smooth_and_passes_printed_pairs():
    """ISO 18265, table A.1."""
    hv, hrc = np.array(strength._HV, dtype=float), np.array(strength._HRC)
    assert hv.size == hrc.size
    printed = {240: 20.3, 300: 29.8, 400: 40.8, 500: 49.1, 600: 55.2, 700: 60.1, 800: 64.0, 900: 67.0, 940: 68.0}
    assert {one: float(hrc[hv == one][0]) for one in printed} == printed
    slope = np.diff(hrc) / np.diff(hv)
    assert (slope > 0.0).all()
    assert np.abs(np.diff(slope)).max() < 0.031
    for one, wanted in printed.items():
        text = strength._rockwell(f"{wanted} HRC")
        assert float(text.removesuffix(" HV")) == pytest.approx(one, rel=1e-8)


def test_f_c_of_rollers_is_iso_281s_formula():
    """ISO/TR 1281-1 (Harris, eq. 18.154): 207.9 lambda nu of the size of line contact, with lambda nu = 0.83."""
    gamma = 0.01 * np.arange(1, 31)
    ratio = (1.0 - gamma) / (1.0 + gamma)
    outer = (1.0 + (1.04 * ratio ** (143.0 / 108.0)) ** 4.5) ** (-2.0 / 9.0)
    formula = gamma ** (2.0 / 9.0) * (1.0 - gamma) ** (29.0 / 27.0) / (1.0 + gamma) ** 0.25 * outer
    share = np.array(load_ratings._F_C_ROLLER) / formula
    assert share == pytest.approx(np.full(30, share.mean()), rel=1.5e-3)
    assert share.mean() == pytest.approx(207.9 * 0.83, rel=0.01)


def test_f_c_of_balls_is_iso_281s_formula():
    """The same of point contact with grooves of 0.52: 0.0899 of (41.2 ...) in newtons; one factor for all rows."""
    gamma = 0.01 * np.arange(1, 41)
    ratio = (1.0 - gamma) / (1.0 + gamma)
    outer = (1.0 + (1.04 * ratio**1.72) ** (10.0 / 3.0)) ** -0.3
    formula = gamma**0.3 * (1.0 - gamma) ** 1.39 / (1.0 + gamma) ** (1.0 / 3.0) * outer
    share = np.array(load_ratings._F_C_BALL) / formula
    assert share == pytest.approx(np.full(40, share.mean()), rel=2e-3)


def test_f_0_rises_to_its_kink_and_falls_after_it():
    """ISO 76: the inner ring decides below gamma = 0.09, the outer one above; both branches all but straight."""
    table = np.array(load_ratings._F_0)
    assert int(table.argmax()) == 9
    assert np.diff(table[:10]) == pytest.approx(np.full(9, 0.2), abs=1e-9)
    assert ((np.diff(table[9:]) < -0.05) & (np.diff(table[9:]) > -0.35)).all()
    assert table[[0, 9, 20, 40]].tolist() == [14.7, 16.5, 14.0, 9.4]


def test_ratings_read_their_rows_at_gamma_and_between():
    for table, first in (
        (load_ratings._F_0, 0.0), (load_ratings._F_C_BALL, 0.01), (load_ratings._F_C_ROLLER, 0.01)
    ):  # fmt: skip
        for k in (0, 7, len(table) - 1):
            assert load_ratings._factor(table, first + 0.01 * k, first) == pytest.approx(table[k], rel=1e-9)
        between = load_ratings._factor(table, first + 0.035, first)
        assert math.isclose(between, 0.5 * (table[3] + table[4]), rel_tol=1e-9)
