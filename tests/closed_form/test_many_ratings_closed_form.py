"""Arrays of pairs are rated as each pair is rated alone: random pairs of all materials, rims, methods and spectra.

Two codes of the same standard: `fegear.formulas.iso6336` with one pair, `fegear.formulas.many` with all of them.
"""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.base.errors import ConvergenceError, GeometryError, RangeError
from fegear.formulas.iso1328 import flank_tolerances
from fegear.formulas.iso6336.conditions import Conditions, Replacement
from fegear.formulas.iso6336.pair_geometry import GearShape, PairGeometry
from fegear.formulas.iso6336.part1_face_load import Alignment, PinionShaft
from fegear.formulas.iso6336.part3_strength import mean_stress_factor, mean_stress_ratio
from fegear.formulas.iso6336.part5_materials import MATERIALS
from fegear.formulas.iso6336.rated import Duty, Quality, Strength
from fegear.formulas.iso6336.rating import _root_rating
from fegear.formulas.iso6336.safety import rate_pair, rate_spectrum
from fegear.formulas.many.pairs import many_pairs
from fegear.formulas.many.ratings import ManyLevels, rate_many, rate_many_spectra
from fegear.formulas.many.shared import ManyConditions, ManyDuties, qualities_of_class
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.rack import BasicRack

GROUPS = tuple(dict.fromkeys(MATERIALS.values()))
ROUGH = (4.8e-6, 20e-6)


def draw_pair(rng: np.random.Generator, *, rims: bool) -> PairGeometry:
    module = float(rng.choice([0.8, 1.5, 2.0, 3.0, 6.0, 12.0])) * 1e-3
    z_1 = int(rng.integers(14, 45))
    z_2 = round(z_1 * rng.uniform(1.0, 6.0))
    beta = math.radians(float(rng.choice([0.0, 0.0, 8.0, 15.0, 28.0, 36.0])))
    deep = float(rng.choice([1.0, 1.0, 1.3]))
    x_1, x_2 = rng.uniform(-0.1, 0.6), rng.uniform(-0.8, 0.5)
    alpha = math.radians(20.0)
    a_t = math.atan(math.tan(alpha) / math.cos(beta))
    wanted = math.tan(a_t) - a_t + 2.0 * (x_1 + x_2) * math.tan(alpha) / (z_1 + z_2)
    low, high = 0.01, 1.2
    for _ in range(80):
        middle = 0.5 * (low + high)
        low, high = (low, middle) if math.tan(middle) - middle > wanted else (middle, high)
    distance = 0.5 * module * (z_1 + z_2) / math.cos(beta) * math.cos(a_t) / math.cos(low)
    width = module * rng.uniform(6.0, 25.0)
    shapes = []
    for z, x in ((z_1, x_1), (z_2, x_2)):
        d = z * module / math.cos(beta)
        tip, root = d + 2.0 * module * (deep + x), d - 2.0 * module * (deep + 0.25 - x)
        rim = float(rng.uniform(0.3, 3.0)) * 0.5 * (tip - root) if rims else None
        shapes.append(
            GearShape(
                z,
                x,
                tip,
                root,
                width * rng.uniform(1.0, 1.2),
                deep + 0.25,
                0.3 if deep == 1.0 else 0.2,
                bore_diameter=float(rng.uniform(0.0, 0.6)) * root,
                generating_shift=x - rng.uniform(0.0, 0.03),
                rim_thickness=rim,
                web_ratio=float(rng.uniform(0.1, 1.3)) if rims else None,
            )
        )
    return PairGeometry((shapes[0], shapes[1]), module, alpha, beta, distance)


def draw_ring_pair(rng: np.random.Generator, *, rims: bool) -> PairGeometry:
    """A pinion in a ring gear that a pinion-type cutter has made."""
    for _ in range(200):
        module, z_1 = float(rng.choice([1.5, 2.0, 3.0, 6.0])) * 1e-3, int(rng.integers(15, 40))
        z_2 = int(z_1 * rng.uniform(2.0, 4.0)) + 12
        beta = math.radians(float(rng.choice([0.0, 0.0, 10.0, 20.0])))
        x_1, x_2 = rng.uniform(-0.1, 0.5), rng.uniform(-0.4, 0.2)
        rounding = float(rng.uniform(0.1, 0.3))
        cutter = PinionCutter(int(rng.integers(12, 25)), float(rng.uniform(-0.1, 0.2)), 1.25, tip_radius=rounding)
        alpha = math.radians(20.0)
        a_t = math.atan(math.tan(alpha) / math.cos(beta))
        wanted = math.tan(a_t) - a_t + 2.0 * (x_1 + x_2) * math.tan(alpha) / (z_1 - z_2)
        low, high = 0.01, 1.2
        for _ in range(80):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if math.tan(middle) - middle > wanted else (middle, high)
        distance = 0.5 * module * (z_2 - z_1) / math.cos(beta) * math.cos(a_t) / math.cos(low)
        width, d = module * rng.uniform(6.0, 25.0), z_1 * module / math.cos(beta)
        tip, root = d + 2.0 * module * (1.0 + x_1), d - 2.0 * module * (1.25 - x_1)
        try:
            ring = InternalTooth(z_2, cutter, profile_shift=x_2, thickness_allowance=0.02, helix_angle=beta)
            outer = ring.root_radius * rng.uniform(1.1, 1.3)
            rim = (float(rng.uniform(1.5, 5.0)) if rims else 1.9) * module
            wheel = GearShape(
                z_2, x_2, 2.0 * ring.tip_radius * module, 2.0 * ring.root_radius * module, width, ring.dedendum,
                bore_diameter=2.0 * outer * module, rim_thickness=rim if rims else None, outline=ring,
                fixed=bool(rng.integers(0, 2)),
            )  # fmt: skip
            return PairGeometry(
                (GearShape(z_1, x_1, tip, root, width, 1.25, 0.3, bore_diameter=0.4 * root), wheel), module, alpha,
                beta, distance,
            )  # fmt: skip
        except (GeometryError, RangeError):
            continue
    raise AssertionError


def draw_strength(rng: np.random.Generator, group: str) -> Strength:
    iron = group == "GG"
    return Strength(
        group, float(rng.uniform(400e6, 1500e6)), float(rng.uniform(100e6, 500e6)), float(rng.uniform(120.0, 500.0)),
        math.nan if iron else float(rng.uniform(200e6, 1100e6)), float(rng.uniform(120e6, 320e6)) if iron else math.nan,
        bool(rng.integers(0, 2)), (float(rng.uniform(0.85, 1.0)), float(rng.uniform(0.85, 1.0))),
    )  # fmt: skip


def draw_alignment(rng: np.random.Generator, kind: int) -> Alignment:
    modification = str(rng.choice(["none", "crowned", "end relief", "helix corrected"]))
    if kind == 0:
        return Alignment(deformation=float(rng.uniform(0.0, 20e-6)), modification=modification)
    if kind == 1:
        shaft = PinionShaft("a", 0.2, float(rng.uniform(0.0, 0.05)), 0.03, float(rng.uniform(0.3, 1.0)))
        return Alignment(
            shaft=shaft, modification=modification, contact_pattern=str(rng.choice(["unknown", "verified"]))
        )
    if kind == 2:
        return Alignment(computed=float(rng.uniform(0.0, 1e-10)), contact_pattern="favourable")
    return Alignment(face_load_factor=1.3)


class Group:
    """Pairs that share materials, method, edition, alignment and tolerance class."""

    def __init__(self, seed: int, count: int, rings: bool = False) -> None:
        rng = np.random.default_rng(seed)
        self.strength = (draw_strength(rng, GROUPS[seed % len(GROUPS)]), draw_strength(rng, str(rng.choice(GROUPS))))
        self.edition, self.method = (2019, 2006)[seed % 2], "C" if seed % 5 == 3 else "B"
        self.grade = int(rng.integers(3, 9))
        self.alignment = draw_alignment(rng, seed % 4)
        self.relief = (30e-6, 40e-6) if seed % 3 == 0 else (0.0, 0.0)
        self.ratio = (-1.2, 0.0) if seed % 6 == 1 else (0.0, 0.0)
        self.computed = Replacement(K_v=1.2) if seed % 7 == 2 else Replacement()
        self.meshes = (3, 1) if seed % 4 == 2 else (1, 1)
        self.pairs = [(draw_ring_pair if rings and k % 4 else draw_pair)(rng, rims=seed % 3 == 1) for k in range(count)]
        self.loads = [float(10.0 ** rng.uniform(1.5, 2.9)) * p.face_width * 1e3 for p in self.pairs]
        self.speeds = [float(10.0 ** rng.uniform(0.5, 3.0)) / p.diameters[0] * 0.2 for p in self.pairs]
        if self.method == "C":
            self.speeds = [0.1 * v for v in self.speeds]
        self.cycles = [(n := float(10.0 ** rng.uniform(2.0, 10.5)), n / p.ratio_of) for p in map(_Ratio, self.pairs)]

    def conditions(self, k: int) -> Conditions:
        pair = self.pairs[k]
        quality = []
        for gear, d, relief in zip(pair.gears, pair.diameters, self.relief, strict=True):
            t = flank_tolerances(self.grade, d, pair.module, gear.face_width).rounded
            pitch = t.base_pitch(pair.transverse_pressure_angle)
            quality.append(Quality(self.grade, pitch, t.profile_form, t.helix_slope, *ROUGH, relief))
        slope = max(
            flank_tolerances(5, d, pair.module, gear.face_width).rounded.helix_slope
            for gear, d in zip(pair.gears, pair.diameters, strict=True)
        )
        duty = Duty(self.loads[k], self.speeds[k], self.cycles[k], 220e-6, 1.25, 1.1, meshes=self.meshes)
        return Conditions(
            pair, self.strength, (quality[0], quality[1]), duty, replace(self.alignment, helix_slope_5=slope),
            self.edition, self.method,
        )  # fmt: skip

    def rated_alone(self, k: int):
        conditions = self.conditions(k)
        if any(self.ratio):
            y_s = rate_pair(conditions, self.computed)["Y_S"].values
            both = [
                tuple(
                    mean_stress_factor(mean_stress_ratio(s.group, y, static=static), r) if r else 1.0
                    for s, y, r in zip(self.strength, y_s, self.ratio, strict=True)
                )
                for static in (False, True)
            ]
            conditions = replace(
                conditions, duty=replace(conditions.duty, mean_stress=both[0], mean_stress_static=both[1])
            )
        return conditions, rate_pair(conditions, self.computed)

    def together(self) -> ManyConditions:
        pairs = many_pairs(self.pairs)
        quality = qualities_of_class(self.grade, pairs, (ROUGH[0],) * 2, (ROUGH[1],) * 2, self.relief)
        duty = ManyDuties(
            np.array(self.loads), np.array(self.speeds), np.array(self.cycles).T, 220e-6, 1.25, 1.1, self.meshes,
            self.ratio,
        )  # fmt: skip
        return ManyConditions(
            pairs, self.strength, quality, duty, self.alignment, self.edition, self.method, computed=self.computed
        )


class _Ratio:
    def __init__(self, pair: PairGeometry) -> None:
        self.ratio_of = abs(pair.signed_ratio)


def compared(seed: int, count: int, rings: bool = False) -> tuple[float, int]:
    """Largest relative difference of stresses and safeties, and how many pairs were rated."""
    group = Group(seed, count, rings)
    many = rate_many(group.together())
    worst, rated = 0.0, 0
    for k in range(count):
        try:
            _, alone = group.rated_alone(k)
        except (RangeError, ConvergenceError):
            assert not many.rated[k], seed
            assert np.isnan(many.contact_safety[:, k]).all()
            continue
        assert many.rated[k], (seed, k, [words for words, mask in many.refused if mask[k]])
        rated += 1
        for name in ("contact_stress", "contact_safety", "bending_stress", "bending_safety"):
            off = getattr(many, name)[:, k] / np.array(getattr(alone, name)) - 1.0
            worst = max(worst, float(np.abs(off).max()))
        loads = (many.factors.K_v[k], many.factors.K_Hbeta[k], many.factors.K_Halpha[k])
        factors = tuple(alone[name].value for name in ("K_v", "K_Hbeta", "K_Halpha"))
        assert loads == pytest.approx(factors, rel=1e-12)
    return worst, rated


def test_random_pairs_are_rated_as_each_alone():
    found = [compared(seed, 4) for seed in range(42)]
    assert sum(rated for _, rated in found) > 130
    assert max(worst for worst, _ in found) < 1e-13


def test_ring_gears_are_rated_as_each_alone_beside_external_ones():
    found = [compared(seed, 4, rings=True) for seed in range(200, 228)]
    assert sum(rated for _, rated in found) > 60
    assert max(worst for worst, _ in found) < 1e-13
    pairs = Group(205, 4, rings=True).together().pairs
    assert pairs.internal.tolist() == [False, True, True, True]
    assert (pairs.at(np.array([0, 2])).teeth[1] < 0.0).tolist() == [False, True]
    assert (pairs.ratio[pairs.internal] < -1.0).all()


@pytest.mark.dear
def test_thousand_random_pairs_of_all_materials_are_rated_as_each_alone():
    found = [compared(seed, 25) for seed in range(100, 144)]
    assert sum(rated for _, rated in found) > 1000
    assert max(worst for worst, _ in found) < 1e-13


@pytest.mark.dear
def test_spectra_of_many_pairs_are_those_of_each_alone():
    shares = ((1.4, 1.0, 1e-4), (1.0, 1.0, 0.1), (0.6, 1.3, 0.5), (0.0, 1.0, 0.4))
    rated = 0
    for seed in (0, 1, 4, 5, 10):
        group = Group(seed, 6)
        asked = group.together()
        levels = [
            ManyLevels(asked.duty.tangential * f, asked.duty.speed * n, asked.duty.cycles * s) for f, n, s in shares
        ]
        many = rate_many_spectra(asked, levels)
        for k in range(6):
            try:
                conditions, _ = group.rated_alone(k)
            except (RangeError, ConvergenceError):
                continue
            duty = conditions.duty
            alone = rate_spectrum(
                conditions,
                [
                    (
                        replace(duty, tangential=duty.tangential * f, speed=duty.speed * n) if f else None,
                        (duty.cycles[0] * s, duty.cycles[1] * s),
                    )
                    for f, n, s in shares
                ],
                group.computed,
            )
            rated += 1
            for name in ("contact_safety", "bending_safety"):
                assert getattr(many, name)[:, k] == pytest.approx(getattr(alone, name), rel=1e-12)
            for name in ("contact_damage", "bending_damage"):
                assert getattr(many, name)[:, k] == pytest.approx(getattr(alone, name), rel=1e-9)
    assert rated > 20


def test_some_of_many_pairs_are_rated_as_among_all():
    asked = Group(4, 6).together()
    whole, rows = rate_many(asked), np.array([4, 1, 5])
    some = replace(asked, pairs=asked.pairs.at(rows), quality=asked.quality.at(rows), duty=asked.duty.at(rows))
    found = rate_many(some)
    for name in ("contact_stress", "contact_safety", "bending_stress", "bending_safety"):
        np.testing.assert_array_equal(getattr(found, name), getattr(whole, name)[:, rows])


@pytest.mark.parametrize(("seed", "line"), [(0, "annex-c"), (5, "annex-c"), (5, "part-2")])
def test_spectra_of_some_pairs_are_those_of_each_alone_on_either_line_of_the_flanks(seed, line):
    """Loads high enough that annex C, which bears more at few load cycles, makes a difference."""
    group = Group(seed, 3)
    asked = replace(group.together(), annex_c=line == "annex-c")
    shares = ((1.6, 1e-5), (1.0, 0.3), (0.0, 0.5))
    many = rate_many_spectra(
        asked, [ManyLevels(asked.duty.tangential * f, asked.duty.speed, asked.duty.cycles * s) for f, s in shares]
    )
    rated = 0
    for k in range(3):
        try:
            conditions, _ = group.rated_alone(k)
        except (RangeError, ConvergenceError):
            continue
        duty = conditions.duty
        levels = [
            (replace(duty, tangential=duty.tangential * f) if f else None, (duty.cycles[0] * s, duty.cycles[1] * s))
            for f, s in shares
        ]
        alone = rate_spectrum(replace(conditions, spectrum_line=line), levels, group.computed)
        for name in ("contact_safety", "bending_safety", "contact_damage", "bending_damage"):
            assert getattr(many, name)[:, k] == pytest.approx(getattr(alone, name), rel=1e-9)
        rated += 1
    assert rated


def test_given_transverse_factors_stand_in_for_those_of_the_standard():
    group = Group(0, 3)
    group.computed = Replacement(K_Halpha=1.15, K_Falpha=(1.3, 1.3))
    many = rate_many(group.together())
    for k in np.flatnonzero(many.rated):
        _, alone = group.rated_alone(int(k))
        assert many.bending_stress[:, k] == pytest.approx(alone.bending_stress, rel=1e-12)
        assert many.contact_stress[:, k] == pytest.approx(alone.contact_stress, rel=1e-12)
    assert set(many.factors.K_Halpha) == {1.15}
    assert set(many.factors.K_Falpha) == {1.3}


@pytest.mark.parametrize("backup", [None, 0.8, 1.3])
def test_an_outline_that_a_rack_makes_is_rated_as_the_rack_says_with_a_rim_as_without(backup):
    """Of spur teeth the section of the outline is that of the standard's equations."""
    group, m, width = Group(0, 1), 3e-3, 30e-3
    shapes = [
        GearShape(z, x, m * (z + 2.0 + 2.0 * x), m * (z - 2.5 + 2.0 * x), width, 1.25, 0.3, generating_shift=x)
        for z, x in ((25, 0.2), (41, -0.2))
    ]
    if backup is not None:
        shapes = [replace(one, rim_thickness=backup * one.depth) for one in shapes]
    formed = [replace(one, formed=Tooth(one.teeth, BasicRack(1.0, 1.25, 0.3), one.profile_shift)) for one in shapes]
    conditions = group.conditions(0)
    by_rack, by_outline = (
        replace(conditions, geometry=PairGeometry((both[0], both[1]), m, math.radians(20.0), 0.0, 0.5 * m * 66))
        for both in (shapes, formed)
    )
    for i in (0, 1):
        one, other = _root_rating(by_rack, i), _root_rating(by_outline, i)
        for name in ("teeth", "load_diameter", "load_distribution", "rim", "stress"):
            assert getattr(other, name) == pytest.approx(getattr(one, name), rel=2e-6), name
        assert (other.rim > 1.0) is (backup == 0.8)


def test_a_spectrum_takes_given_factors_where_the_standard_has_none_of_its_own():
    """K_v by method C ends at some speed: given ones serve for the S-N curves too, whichever level comes first."""
    group = Group(3, 1)
    assert group.method == "C"
    conditions = group.conditions(0)
    duty = replace(conditions.duty, speed=1e4 * conditions.duty.speed)
    conditions, given = replace(conditions, duty=duty), Replacement(K_v=1.3)
    with pytest.raises(RangeError, match="K_v"):
        rate_pair(conditions)
    loaded, idle = (duty, (1e6, 4e5)), (None, (1e3, 4e2))
    found = rate_spectrum(conditions, [idle, loaded], [None, given])
    alone = rate_spectrum(conditions, [loaded], given)
    for name in ("contact_safety", "bending_safety", "contact_damage", "bending_damage"):
        assert getattr(found, name) == pytest.approx(getattr(alone, name), rel=1e-12)
