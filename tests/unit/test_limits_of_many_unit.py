"""Limits of arrays of pairs: what just meets one is kept, what lies beyond is excluded, and for that reason only."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import RangeError
from fegear.design.sizing.limits import SizingLimits, broken, masses
from fegear.formulas.iso6336.part3_pair import ToothLoad
from fegear.formulas.many.pairs import ManyPairs
from fegear.formulas.many.ratings import _refused
from fegear.geometry.many_pairs import ManyGearPairs

ALPHA = np.radians(20.0)


def gear_pairs(z=(25, 41), x=(0.2, -0.1), rounding=0.38, distance=None, beta=0.2):
    """One pair of 2 mm and 30 mm of width."""
    m = 2e-3
    a = 0.5 * m * sum(z) / np.cos(beta) + m * sum(x) * 0.98 if distance is None else distance
    one = np.array
    return ManyGearPairs(
        one(z, dtype=float)[:, None], one(x)[:, None], one([m]), one([ALPHA]), one([beta]), one([1.0]), one([1.25]),
        one([rounding]), one([0.0]), one([a]), one([30e-3]),
    )  # fmt: skip


#: Limits that exclude nothing.
WIDE = SizingLimits(-9.0, 0.1, 0.0, -9.0, -1e3, 99.0, None, None, (-9.0, 9.0), None)


def reasons(pairs, limits=WIDE):
    return [words for words, mask in broken(pairs, limits) if mask[0]]


def disc_masses(pairs, density):
    mean = 0.5 * (pairs.tip_diameters + pairs.root_diameters)
    return float((density * 30e-3 * np.pi / 4.0 * (mean**2 - pairs.root_diameters**2 / 4.0)).sum())


@pytest.mark.parametrize("z", [(25, 41), (41, 25)])
def test_what_just_meets_a_limit_is_kept_and_a_little_beyond_excluded_for_that_reason(z):
    pairs = gear_pairs(z, (0.2, -0.1) if z[0] < z[1] else (-0.1, 0.2))
    assert reasons(pairs) == []
    low = {
        "tip_thickness": ("tip thickness", pairs.tip_thicknesses.min()),
        "contact_ratio": ("contact ratio", pairs.contact_ratio[0]),
        "overlap_ratio": ("overlap ratio", 30e-3 * np.sin(0.2) / (np.pi * 2e-3)),
        "tip_clearance": ("tip clearance", pairs.tip_clearances.min()),
        "specific_sliding": ("specific sliding", pairs.specific_sliding.min()),
    }
    high = {
        "width_ratio": ("b/d_1", 30e-3 / (z[0] * 2e-3 / np.cos(0.2))),
        "tip_diameter": ("tip diameter", pairs.tip_diameters.max()),
        "mass": ("mass", disc_masses(pairs, 7000.0)),
    }
    wide = replace(WIDE, density=7000.0)
    for sign, limits in ((1.0, low), (-1.0, high)):
        for name, (said, value) in limits.items():
            rounded = sign * 3e-10 * (1.0 if sign > 0.0 else value)  # met but for the last digits of a limit
            assert reasons(pairs, replace(wide, **{name: value + rounded})) == [], name
            assert reasons(pairs, replace(wide, **{name: value + sign * 1e-6 * abs(value)})) == [said], name
    assert masses(pairs, 7000.0)[0] == pytest.approx(disc_masses(pairs, 7000.0))


def test_sums_of_shifts_and_distances_have_two_ends():
    pairs = gear_pairs()
    total, a = 0.1, float(pairs.centre_distance[0])
    for name, said, value, last in (
        ("shift_sum", "sum of profile shifts", total, 3e-10),
        ("distances", "centre distance outside its range", a, 3e-10 * a),
    ):
        step = 1e-6 * value
        assert reasons(pairs, replace(WIDE, **{name: (value + last, 9.0)})) == []
        assert reasons(pairs, replace(WIDE, **{name: (-9.0, value - last)})) == []
        assert reasons(pairs, replace(WIDE, **{name: (value + step, 9.0)})) == [said]
        assert reasons(pairs, replace(WIDE, **{name: (-9.0, value - step)})) == [said]


def test_teeth_that_cannot_be_are_excluded():
    # A rack of 1.25 modules dedendum has room for a rounding of 0.4719 modules.
    assert reasons(gear_pairs(rounding=0.4718)) == []
    assert reasons(gear_pairs(rounding=0.4720)) == ["tip rounding of the basic rack does not fit"]
    # Undercut ends where x = h (1 - z / 17.097), h the depth of the straight flank: exactly one module here.
    rounding = 0.25 / (1.0 - np.sin(ALPHA))
    for z, x in (((12, 40), (0.2982, 0.4)), ((40, 12), (0.4, 0.2982))):
        assert reasons(gear_pairs(z, x, rounding, beta=0.0)) == []
        lower = (x[0] - 4e-4, x[1]) if z[0] == 12 else (x[0], x[1] - 4e-4)
        assert reasons(gear_pairs(z, lower, rounding, beta=0.0)) == ["undercut"]
    near = gear_pairs(distance=0.5 * 2e-3 * 66 / np.cos(0.2) * np.cos(0.4))
    assert reasons(near)[0] == "centre distance not reached (no working pressure angle)"
    # A wheel of many teeth reaches as deep as a rack of its addendum: deeper than 0.94 modules of straight flank.
    for z in ((24, 400), (400, 24)):
        assert reasons(gear_pairs(z, (0.0, 0.0), 0.47, beta=0.0)) == ["interference (mating tip below the involute)"]
        assert reasons(gear_pairs(z, (0.0, 0.0), 0.25 / (1.0 - np.sin(ALPHA)), beta=0.0)) == []


@pytest.mark.parametrize("gear", [0, 1])
def test_teeth_just_without_undercut_or_interference_are_kept(gear):
    for name, bad in (("undercut", 1.0), ("involute_reserve", -1.0)):
        for amount, count in ((3e-10, 0), (3e-9, 1)):
            pairs = gear_pairs()
            pairs.__dict__[name] = np.full((2, 1), -bad)
            pairs.__dict__[name][gear] = bad * amount
            assert len(reasons(pairs)) == count, name
    for rounding, count in ((3e-10, 0), (3e-9, 1)):  # of the largest that has room
        largest = (0.25 * np.pi - 1.25 * np.tan(ALPHA)) * np.cos(ALPHA) / (1.0 - np.sin(ALPHA))
        assert len(reasons(gear_pairs(rounding=largest + rounding * np.cos(ALPHA) / (1.0 - np.sin(ALPHA))))) == count


# ---- ratings by ISO 6336 ---------------------------------------------------------------------------------------------
def rated(**changes):
    """A pair that ISO 6336 covers, but for what is changed; 2 x 25 mm of rim and depth below."""
    m, z = 3e-3, np.array([[25.0], [41.0]])
    beta = changes.get("helix_angle", 0.0)
    d = z * changes.get("module", m) / np.cos(beta)
    both = {
        "profile_shift": 0.0, "generating_shift": 0.0, "bore_diameter": 0.0, "face_widths": 30e-3, "dedendum": 1.25,
        "rack_tip_radius": 0.3, "residual_undercut": 0.0, "rim_thickness": np.inf, "web_ratio": np.nan,
        "young_modulus": 206e9, "poisson_ratio": 0.3, "density": 7850.0,
    }  # fmt: skip
    pair = {
        "module": m, "pressure_angle": ALPHA, "helix_angle": beta, "centre_distance": 0.1, "contact_ratio": 1.6,
        "face_width": 30e-3,
    }  # fmt: skip
    values = {"teeth": z, "tip_diameter": d + 2.0 * m, "root_diameter": d - 2.5 * m}
    values["active_tip_diameter"] = values["tip_diameter"]
    values |= {name: np.full((2, 1), one) for name, one in both.items()}
    values |= {name: np.array([one]) for name, one in pair.items()}
    for name, value in changes.items():
        values[name] = np.reshape(value, (2, 1)) if np.size(value) == 2 else np.full(values[name].shape, value)
    return ManyPairs(**values)


def refusals(pairs, factors=(1.0, 1.0, 1.0), forms=(True, True)):
    k_v, k_h, single = (np.array([one]) for one in factors)
    exists, ranged = (np.array([[True], [one]]) for one in forms)
    found = _refused(
        pairs, SimpleNamespace(K_v=k_v, K_Hbeta=k_h, single_stiffness=single),
        SimpleNamespace(exists=exists, notch_in_range=ranged),
    )  # fmt: skip
    return [words for words, mask in found if mask[0]]


SIZE, RIM = "size outside ISO 1328-1", "rim too thin for ISO 6336-3"
RATIO = "contact ratio beyond ISO 6336-1"


@pytest.mark.parametrize(
    ("inside", "outside", "said"),
    [
        ({"contact_ratio": 1.0}, {"contact_ratio": 0.999}, "contact ratio below 1"),
        # ISO 1328-1:2013: d 5 to 15 000 mm, m_n 0.5 to 70 mm, b 4 to 1200 mm
        ({"module": 0.5e-3}, {"module": 0.499e-3}, SIZE),
        ({"module": 70e-3}, {"module": 70.1e-3}, SIZE),
        ({"face_widths": (4e-3, 1.2)}, {"face_widths": (3.9e-3, 1.2)}, SIZE),
        ({"face_widths": (1.2, 4e-3)}, {"face_widths": (4e-3, 1.21)}, SIZE),
        ({"teeth": (10.0, 5000.0)}, {"teeth": (10.0, 5001.0)}, SIZE),
        ({"teeth": (10.0, -5000.0)}, {"teeth": (10.0, -5001.0)}, SIZE),
        ({"teeth": (10.0, 20.0), "module": 0.5e-3}, {"teeth": (9.0, 20.0), "module": 0.5e-3}, SIZE),
        (
            {"helix_angle": np.radians(44.9), "contact_ratio": 1.1},
            {"helix_angle": np.radians(45.1), "contact_ratio": 1.1},
            "helix angle above 45 deg",
        ),
        # Mesh stiffness and K_Halpha of spur pairs end at 2.5
        ({"contact_ratio": 2.499}, {"contact_ratio": 2.5}, RATIO),
        # epsilon_alpha / cos^2 beta_b of 3 or more has no load application of ISO 6336-3
        (
            {"helix_angle": 0.2, "contact_ratio": 2.99 * (1.0 - (np.sin(0.2) * np.cos(ALPHA)) ** 2)},
            {"helix_angle": 0.2, "contact_ratio": 3.01 * (1.0 - (np.sin(0.2) * np.cos(ALPHA)) ** 2)},
            "virtual contact ratio of 3 or more",
        ),
        # Y_B: s_R above 0.5 h_t, of rings above 1.75 m_n; h_t = 2.25 m_n here
        ({"rim_thickness": (3.38e-3, np.inf)}, {"rim_thickness": (3.37e-3, np.inf)}, RIM),
        ({"rim_thickness": (np.inf, 3.38e-3)}, {"rim_thickness": (np.inf, 3.37e-3)}, RIM),
        (
            {"teeth": (25.0, -75.0), "rim_thickness": (np.inf, 5.26e-3)},
            {"teeth": (25.0, -75.0), "rim_thickness": (np.inf, 5.24e-3)},
            RIM,
        ),
    ],
)
def test_pairs_are_refused_from_the_limits_of_the_standards_on(inside, outside, said):
    assert refusals(rated(**inside)) == []
    assert refusals(rated(**outside)) == [said]


def test_helical_pairs_have_no_contact_ratio_of_spur_ones():
    """Z_epsilon^2 = (4 - e) / 3 (1 - b) + b / e: of no pair below 0 but above e = 4 with little overlap."""
    wide = {"helix_angle": 0.3, "face_width": 60e-3}
    assert RATIO not in refusals(rated(contact_ratio=2.6, **wide))
    assert RATIO not in refusals(rated(contact_ratio=4.2, **wide))
    assert RATIO in refusals(rated(contact_ratio=4.2, helix_angle=0.3, face_width=1e-4))


def test_factors_and_sections_that_the_standard_does_not_have_are_refused():
    pairs, of_loads = rated(), "load factors outside ISO 6336-1"
    for factors in ((np.nan, 1.0, 1.0), (1.0, np.inf, 1.0), (1.0, 1.0, 0.0)):
        assert refusals(pairs, factors) == [of_loads]
    assert refusals(pairs, forms=(False, True)) == ["no root section of ISO 6336-3"]
    assert refusals(pairs, forms=(True, False)) == ["notch parameter q_s outside 1 to 8"]


@pytest.mark.parametrize(("deep", "most"), [(False, 2.0), (True, 3.0)])
def test_a_single_contact_point_has_contact_ratios_of_its_own(deep, most):
    """From 1 to below 2, and to below 3 where the load is applied as Y_DT presumes."""
    for ratio in (1.0, most - 1e-6):
        assert ToothLoad(1e5, ratio, deep=deep).contact_ratio == ratio
    for ratio in (1.0 - 1e-6, most):
        with pytest.raises(RangeError, match=f"must be between 1 and {most:g} for a single contact point"):
            ToothLoad(1e5, ratio, deep=deep)
