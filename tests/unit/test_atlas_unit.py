"""An atlas of few coarse gears is within its stated error of solving others; its polynomials, file and refusals."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.atlas.atlas_gear import AtlasGear
from fegear.atlas.build import Budget, _known, _sum, build_atlas
from fegear.atlas.common_rows import KEPT, common_rows
from fegear.atlas.domain import Domain
from fegear.atlas.family import Family, Place, place_of
from fegear.atlas.interpolation import Atlas, load_atlas
from fegear.atlas.polynomials import chosen, degrees_within, fitted, next_degrees, products
from fegear.atlas.refining import compliances, refined
from fegear.atlas.tables import Layout, over_contacts, row_of
from fegear.base.errors import InputError, RangeError
from fegear.base.solution_cache import SolutionCache, cache_on_disk
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.transmission_error import transmission_error
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.rim_support import RimSupport

FAMILY = Family()
SETTINGS = settings_at(-6.0)
DOMAIN = Domain((24, 48), (0.1, 0.3))


@pytest.fixture(scope="module")
def atlas() -> Atlas:
    return build_atlas(FAMILY, [DOMAIN], SETTINGS, budget=Budget(1.0))


def steel_gear(teeth: int = 31, shift: float = 0.17, **others: object) -> Gear:
    rack = BasicRack(1.0, 1.25, 0.38)
    tooth = Tooth(teeth, rack, shift)
    return Gear(tooth, 3e-3, 0.5 * tooth.root_radius * 3e-3, **others)  # type: ignore[arg-type]


def differences(atlas: Atlas, gear: Gear) -> dict[str, float]:
    """What the atlas is off by, in the proportions of its stated errors."""
    known, mine = solve_gear(gear, atlas.settings, estimate_error=False), atlas.gear(gear)
    solved, source = finite_element_compliance(known), finite_element_compliance(mine)
    r = np.linspace(known.lowest_radius * (1 + 1e-9), known.highest_radius * (1 - 1e-9), 15)
    own = solved.own(0, r)
    beside = [np.abs(source.between(k, 0, r[:, None], r) - solved.between(k, 0, r[:, None], r)).max() for k in (1, -1)]
    found = {"c_self": np.abs(source.own(0, r) / own - 1.0).max(), "c_neighbour": max(beside) / own.min()}
    for k, side in mine.layout.kernels:
        value, _ = known.largest_root_stress(k, side, r)
        off = np.abs(mine.largest_root_stress(k, side, r)[0] - value).max()
        found[f"{side} {k}"] = off / np.abs(known.largest_root_stress(0, side, r)[0]).max()
    return {key: float(value) for key, value in found.items()}


@pytest.mark.parametrize("place", [Place(29, 0.22, 1.0, 0.5), Place(41, 0.15, 1.0, 0.5)])
def test_of_other_gears_it_is_within_its_stated_error(atlas, place):
    gear = FAMILY.gear(place)
    off, stated = differences(atlas, gear), atlas.gear(gear).errors
    assert stated.keys() == off.keys()
    assert [key for key in off if off[key] > stated[key]] == []
    assert stated["c_self"] < 2e-2
    assert stated["tension 0"] < 5e-2


def test_a_region_that_an_atlas_of_the_family_has_is_taken_over(atlas):
    """With others beside it, whose numbers of regions are other ones; nothing is solved."""
    cache = SolutionCache()
    other = replace(atlas, family=replace(FAMILY, rounding=0.2))
    again = build_atlas(FAMILY, [DOMAIN], SETTINGS, budget=Budget(1.0), cache=cache, like=[other, atlas])
    assert cache.shapes.computed == 0
    places = np.array([(29, 0.22, 1.0, 0.5), (41, 0.15, 1.0, 0.5)]).T
    found, known = (one.tables(places) for one in (again, atlas))
    np.testing.assert_allclose(found.rows, known.rows, rtol=1e-4, atol=1e-4 * np.abs(known.rows).max())
    np.testing.assert_array_equal(again.pieces[0].solved, atlas.pieces[0].solved)
    np.testing.assert_array_equal(again.pieces[0].errors, atlas.pieces[0].errors)


@pytest.mark.dear
def test_of_a_family_like_others_only_what_differs_is_sought(atlas):
    """Fewer gears; of two atlases with the same numbers as much as of one of them, wherever it lies between both."""
    family, cache = replace(FAMILY, rounding=0.3), SolutionCache()
    place = np.array([(31, 0.17, 1.0, 0.5)]).T
    ends = [replace(atlas, family=replace(FAMILY, rounding=rounding)) for rounding in (0.38, 0.1)]
    one, two = (
        build_atlas(family, [DOMAIN], SETTINGS, budget=Budget(1.0), cache=cache, like=like)
        for like in ([atlas], ends)
    )  # fmt: skip
    assert cache.shapes.computed == one.pieces[0].solved.shape[1] < atlas.pieces[0].solved.shape[1]
    rows = [found.tables(place).rows[0] for found in (one, two)]
    np.testing.assert_allclose(*rows, rtol=1e-3, atol=1e-4 * np.abs(rows[0]).max())
    gear = family.gear(Place(31, 0.17, 1.0, 0.5))
    off, stated = differences(one, gear), one.gear(gear).errors
    assert [key for key in off if off[key] > stated[key]] == []
    # the other family is another one: without what was sought it would be off
    assert off["tension 0"] < 0.5 * abs(atlas.tables(place).rows[0][:-2].max() / rows[0][:-2].max() - 1.0)


def test_what_a_region_is_made_like():
    """The same region, or two others of its number that enclose its rounding; one of them where both have one."""
    here = Family(rounding=0.3)
    first, second, third, twin = (
        SimpleNamespace(family=Family(rounding=rounding), pieces=["a", "b"], domains=["u", "v"])
        for rounding in (0.2, 0.4, 0.35, 0.4)
    )
    same = SimpleNamespace(family=here, pieces=["a", "b"], domains=["u", DOMAIN])
    short = SimpleNamespace(family=Family(rounding=0.25), pieces=["a"], domains=["u"])

    def found(*like, number=1):
        return [(one.atlas, one.number, pytest.approx(one.weight)) for one in _known(like, here, DOMAIN, number)]

    assert found(first, same, second) == [(same, 1, 1.0)]
    assert found(first, second) == [(first, 1, 0.5), (second, 1, 0.5)]
    assert found(second, first, third, number=0) == [(first, 0, 1.0 / 3.0), (third, 0, 2.0 / 3.0)]
    assert found(second, twin) == [(twin, 1, 1.0)]
    assert found(first, short, second) == [(first, 1, 0.5), (second, 1, 0.5)]
    assert found(short) == found() == []
    elsewhere = SimpleNamespace(family=here, pieces=["a", "b"], domains=["u", "v"])
    assert found(elsewhere, second) == [(second, 1, 1.0)]


def test_sums_of_products_add_up():
    some, others = (np.array(degrees) for degrees in ([[0, 0, 1, 0], [2, 1, 0, 0]], [[2, 1, 0, 0], [0, 3, 0, 0]]))
    one, other = np.array([[1.0, 2.0], [3.0, 4.0]]), np.array([[10.0, 20.0], [30.0, 40.0]])
    at = np.random.default_rng(2).uniform(-1.0, 1.0, (4, 6))
    degrees, coefficients = _sum(some, one, others, other)
    expected = products(some, at) @ one + products(others, at) @ other
    np.testing.assert_allclose(products(degrees, at) @ coefficients, expected, rtol=1e-12)
    assert degrees.shape == (3, 4)


@pytest.mark.dear
def test_finer_compliances_are_nearer_and_leave_the_rest(atlas, tmp_path):
    told = []
    cache = cache_on_disk(tmp_path / "cache")
    finer = refined(atlas, cache=cache, progress=lambda done, wanted: told.append((done, wanted)))
    assert told[-1][0] == told[-1][1] > 1.4 * len(atlas.pieces[0].degrees)
    off: dict[str, list[float]] = {"before": [], "after": []}
    for place in (Place(29, 0.22, 1.0, 0.5), Place(35, 0.13, 1.0, 0.5), Place(44, 0.27, 1.0, 0.5)):
        gear = FAMILY.gear(place)
        known = compliances(gear, SETTINGS, atlas.reach)["compliances"]
        for name, one in (("before", atlas), ("after", finer)):
            row = one.tables(np.array(place, dtype=float)[:, None], stress=False).rows[0]
            off[name].append(np.abs(row / known - 1.0)[:95].max())
        before, after = (one.gear(gear) for one in (atlas, finer))
        assert after.errors == before.errors
        np.testing.assert_array_equal(after.row[known.size :], before.row[known.size :])
    assert max(off["after"]) < 0.5 * max(off["before"])
    finer.save(tmp_path / "a.npz")
    again = load_atlas(tmp_path / "a.npz")
    places = np.array([(31, 0.17, 1.0, 0.5)], dtype=float).T
    rows = [one.tables(places).rows[0] for one in (finer, again)]
    np.testing.assert_allclose(rows[1][:95], rows[0][:95], rtol=3e-6)
    solved = cache.shapes.computed
    assert solved > 0
    recalled = cache_on_disk(tmp_path / "cache")
    refined(atlas, cache=recalled)
    assert recalled.shapes.computed == 0


def test_many_gears_have_the_tables_of_each(atlas):
    places = np.array([(29, 0.22, 1.0, 0.5), (31, 0.17, 1.0, 0.5), (31, 0.9, 1.0, 0.5), (60, 0.2, 1.0, 0.5)]).T
    found, some = atlas.tables(places), atlas.tables(places, stress=False)
    one = atlas.gear(FAMILY.gear(Place(31, 0.17, 1.0, 0.5)))
    np.testing.assert_allclose(found.rows[1], one.row, rtol=1e-12, atol=1e-12 * np.abs(one.row).max())
    np.testing.assert_allclose(found.errors[1], list(one.errors.values()), rtol=1e-12)
    np.testing.assert_allclose(some.rows[:2], found.rows[:2, : some.rows.shape[1]], rtol=1e-12, atol=1e-12)
    assert np.isnan(found.rows[2:]).all()  # outside
    assert np.isinf(found.errors[2:]).all()
    assert np.isnan(atlas.ends(places)[2:]).all()
    gear = one.gear
    lowest = math.sqrt(gear.involute_radii[0] ** 2 - gear.base_radius**2)
    assert atlas.ends(places)[1, 0] == pytest.approx(lowest, rel=1e-3)
    assert FAMILY.lowest_roll_length(np.array([31.0]), np.array([0.17]))[0] == pytest.approx(lowest, rel=1e-9)


def test_neighbours_are_reciprocal_and_errors_have_their_places(atlas):
    mine = atlas.gear(steel_gear())
    r = np.linspace(mine.lowest_radius, mine.highest_radius, 5)
    np.testing.assert_allclose(mine.neighbour(1, r, r), mine.neighbour(-1, r, r).T, rtol=1e-12)
    half = mine.reference_half_width
    np.testing.assert_allclose(mine.self_error(r, half), mine.errors["c_self"] * mine.self_compliance(r, half))
    assert mine.neighbour_error(1, r, r[:2]).shape == (5, 2)
    largest = np.abs(mine.largest_root_stress(0, "tension", r)[0]).max()
    assert mine.root_stress_error(1, "tension", r)[0] == pytest.approx(mine.errors["tension 1"] * largest, rel=1e-3)
    assert set(mine.largest_errors()) == {"c_self", "c_neighbour", "root_tension", "root_compression"}
    narrower = mine.self_compliance(r, 0.5 * half) - mine.self_compliance(r, half)
    np.testing.assert_allclose(narrower, mine.log_slope * math.log(2.0), rtol=1e-9)


@pytest.mark.parametrize("beyond_the_line", [0.2, -0.1])
def test_root_tension_follows_contacts_that_become_narrower_at_the_start_of_the_flank(beyond_the_line):
    """Between the contacts of the tables too, and of gears whose flank starts in a corner."""
    gear = FAMILY.gear(Place(14, FAMILY.least_shift(14) + beyond_the_line, 1.0, 0.5))
    solved = solve_gear(gear, settings_at(-1.0), estimate_error=False)
    row = row_of(solved)
    known = AtlasGear(gear, Layout(1), row, {})
    low, high = gear.involute_radii
    above = np.concatenate([
        (0.0, 5e-5, 1e-4, 3e-4, 1e-3, 0.005, 0.01, 0.015, 0.02, 0.021, 0.03),
        np.linspace(0.05, 0.5 * (high**2 - low**2) / gear.base_radius, 20),
    ])  # fmt: skip
    r = np.minimum(np.sqrt(low**2 + 2.0 * gear.base_radius * above), high)
    true = solved.largest_root_stress(0, "tension", r)[0]
    np.testing.assert_allclose(known.largest_root_stress(0, "tension", r)[0], true, atol=1.5e-4 * true.max(), rtol=0.0)
    lengths = np.sqrt(np.maximum((r - gear.base_radius) * (r + gear.base_radius), 0.0))
    shares = (lengths - lengths[0]) / (lengths[-1] - lengths[0])
    as_forces = (over_contacts(shares) @ Layout(1).stress(row, (0, "tension"))).T
    off = np.abs(known.fillet_curve("tension").largest(as_forces, r)[0] - true).max()
    assert off > 5e-4 * true.max()  # the width of contacts counts


def test_size_and_steel_scale_and_a_thickness_allowance_is_a_shift(atlas):
    steel, pure = steel_gear(), FAMILY.gear(Place(31, 0.17, 1.0, 0.5))
    one, other = atlas.gear(steel), atlas.gear(pure)
    np.testing.assert_allclose(one.row, other.row, rtol=1e-9)
    r = np.linspace(*pure.involute_radii, 5)
    modulus, m = steel.material.young_modulus, steel.module
    at = r * m
    np.testing.assert_allclose(modulus * one.self_compliance(at, 0.02 * m), other.self_compliance(r, 0.02), rtol=1e-9)
    stress = one.largest_root_stress(0, "tension", at)[0] * m
    np.testing.assert_allclose(stress, other.largest_root_stress(0, "tension", r)[0], rtol=1e-6)
    assert one.log_slope * modulus == pytest.approx(other.log_slope)
    thinner = Tooth(31, BasicRack(1.0, 1.25, 0.38), 0.27, 0.2 * math.tan(math.radians(20.0)), steel.tooth.tip_radius)
    assert place_of(Gear(thinner, m, steel.bore_radius)) == pytest.approx(place_of(steel))


@pytest.mark.parametrize(
    ("gear", "text"),
    [
        (lambda: steel_gear(50), "teeth = 50: is outside the range of the atlas, 24 to 48"),
        (lambda: steel_gear(30, 0.31), "profile_shift = 0.31: is outside the range of the atlas, 0.1 to 0.3"),
        (lambda: replace(steel_gear(), bore_radius=0.02), "bore_radius = "),
        (
            lambda: replace(steel_gear(), tooth=replace(steel_gear().tooth, tip_radius=16.6)),
            "tip circle 0.93 modules above",
        ),
        (lambda: steel_gear(plane="stress"), 'plane = "stress": must be "strain" in this atlas'),
        (lambda: steel_gear(material=Material(poisson_ratio=0.25)), "poisson_ratio = 0.25: must be 0.3 in this atlas"),
        (lambda: Gear(Tooth(31, BasicRack(), 0.17), 3e-3, 0.02), "rack.tip_radius = 0.25: must be 0.38"),
        (
            lambda: Gear(Tooth(31, BasicRack(1.0, 1.25, 0.38), 0.17, helix_angle=0.2), 3e-3, 0.02, hand="left"),
            "helix_angle = 0.2: must be 0",
        ),
        (lambda: steel_gear(support=RimSupport(free_teeth=3)), "rim_support = given: is not in an atlas"),
        (lambda: Gear(Tooth(12, BasicRack(1.0, 1.25, 0.38)), 3e-3, 0.005), "has undercut, unlike the gears"),
    ],
)
def test_outside_it_refuses(atlas, gear, text):
    with pytest.raises(RangeError, match="solve the gear") as refused:
        atlas.gear(gear())
    assert text in str(refused.value)


def test_regions_end_at_the_undercut_line():
    line = FAMILY.least_shift(14)
    whole = Domain((12, 20), (-0.4, 0.5))
    with pytest.raises(InputError, match=r"crosses the undercut line at z = 23\.\d+ .* end one region at 23 teeth"):
        Domain((12, 40), (-0.4, 0.5)).check(FAMILY)
    whole.check(FAMILY)
    under = Domain((12, 16), (-0.3, -0.002), side="undercut")
    under.check(FAMILY)
    assert whole.shift_ends(FAMILY, 14) == (line, 0.5)
    for domain, cut in ((whole, False), (under, True)):
        places = domain.candidates(FAMILY, 20)
        assert len(set(places)) == len(places)
        inside = [p for p in places[:12] if p.shift > domain.shift_ends(FAMILY, p.teeth)[0] + 1e-6]
        assert {FAMILY.gear(place).tooth.undercut for place in inside} == {cut}
        for place in places:
            assert domain.outside(FAMILY, place) is None
    with pytest.raises(InputError, match="has no gears on its side"):
        Domain((12, 14), (-0.2, 0.1)).check(FAMILY)
    with pytest.raises(InputError, match="must be below 0 on the undercut side"):
        Domain((12, 16), (-0.2, 0.6), side="undercut")


def test_a_place_has_its_coordinates():
    domain = Domain((12, 40), (0.3, 0.7), (0.8, 1.1), (0.3, 0.7), highest_at_first=0.5)
    at = np.array((0.0, 0.3, -0.6, 0.9))
    place = domain.place(FAMILY, at)
    found = domain.coordinates(FAMILY, np.array(place, dtype=float)[:, None])[:, 0]
    np.testing.assert_allclose(found[1:], at[1:], atol=1e-12)
    assert found[0] == pytest.approx(2.0 * math.log(place.teeth / 12) / math.log(40 / 12) - 1.0)
    assert domain.shift_ends(FAMILY, 12) == pytest.approx((0.3, 0.5))  # small gears become pointed
    assert domain.shift_ends(FAMILY, 40) == pytest.approx((0.3, 0.7))
    outside = np.array([place, place._replace(shift=0.9), place._replace(bore=0.2)], dtype=float).T
    assert domain.holds(FAMILY, outside).tolist() == [True, False, False]


def test_polynomials_are_fitted_and_their_errors_those_of_a_fit_without_the_place():
    degrees = degrees_within((3, 2))
    assert degrees.tolist() == [[0, 0], [0, 1], [0, 2], [1, 0], [1, 1], [2, 0], [3, 0]]
    rng = np.random.default_rng(4)
    others = rng.uniform(-1.0, 1.0, (2, 60))
    taken = chosen(np.zeros((0, 7)), products(degrees, others), 10)
    assert len(set(taken)) == 10
    at = others[:, taken]
    assert np.linalg.cond(products(degrees, at)) < 6.0
    exact = (1.0 + at[0] ** 3 - 2.0 * at[0] * at[1])[:, None]
    coefficients, off = fitted(exact, products(degrees, at))
    np.testing.assert_allclose(off, 0.0, atol=1e-13)
    np.testing.assert_allclose(products(degrees, others) @ coefficients,
                               (1.0 + others[0] ** 3 - 2.0 * others[0] * others[1])[:, None], atol=1e-12)  # fmt: skip
    noisy = exact + rng.normal(size=exact.shape)
    off = fitted(noisy, products(degrees, at))[1]
    left = np.arange(10) != 3
    without = fitted(noisy[left], products(degrees, at[:, left]))[0]
    assert off[3, 0] == pytest.approx(float((noisy[3] - products(degrees, at[:, 3:4]) @ without)[0, 0]))
    more = next_degrees(degrees, np.array([1.0, 1.0, 1e-6, 1.0, 1.0, 1.0, 0.5]), (9, 9), 1.5)
    assert more.shape == (10, 2)
    new = {tuple(one) for one in more.tolist()} - {tuple(one) for one in degrees.tolist()}
    assert {(2, 1), (4, 0)} <= new  # not along the coordinate whose terms have vanished
    assert (0, 3) not in new
    assert next_degrees(degrees, np.ones(7), (3, 2), 9.0).shape == (12, 2)  # all that there are


def test_few_common_rows_stand_for_many():
    layout, rng = Layout(1), np.random.default_rng(5)
    rows = (
        1.0 + rng.normal(size=(30, 3)) @ rng.normal(size=(3, layout.size)) + 1e-8 * rng.normal(size=(30, layout.size))
    )
    found = common_rows(rows, layout)
    assert found.rows.shape == (4, layout.size)
    assert np.abs(found.parts(rows) @ found.rows - rows).max() < 2.0 * KEPT * np.abs(rows).max()
    again = type(found).of(found.kept(layout), layout)
    np.testing.assert_array_equal(again.rows, found.rows)


def test_a_gear_at_the_undercut_line_is_on_the_whole_side():
    alone = build_atlas(FAMILY, [Domain((14, 15), (-0.4, 0.5))], SETTINGS, budget=Budget(1.0))
    line = FAMILY.least_shift(14)
    assert alone.gear(FAMILY.gear(Place(14, line, 1.0, 0.5))).errors["c_self"] > 0.0
    with pytest.raises(RangeError, match="has undercut"):
        alone.gear(FAMILY.gear(Place(14, line - 1e-6, 1.0, 0.5)))


def test_contact_takes_it_for_a_solved_gear(atlas):
    """Mean and peak-to-peak transmission error of a pair, with corner contact, are those of solved gears."""
    gears = [steel_gear(31, 0.17), steel_gear(41, 0.22)]
    pair, load = GearPair(*gears), 200e3 * gears[0].face_width
    solved = [finite_element_compliance(solve_gear(gear, SETTINGS, estimate_error=False)) for gear in gears]
    mine = [atlas.compliance(gear) for gear in gears]
    assert "interpolated from an atlas" in mine[0].describe()
    stated = max(atlas.gear(gear).errors["c_self"] for gear in gears)
    one, other = (
        transmission_error(Engagement(PairCompliance(pair, *sources), corner_contact=True), load, 24)
        for sources in (mine, solved)
    )
    assert one.mean == pytest.approx(other.mean, rel=stated)
    assert abs(one.peak_to_peak - other.peak_to_peak) < stated * other.mean
    assert stated < 0.02


def test_it_is_kept_as_one_file(atlas, tmp_path):
    path = tmp_path / "a.npz"
    atlas.save(path)
    assert [one.name for one in tmp_path.iterdir()] == ["a.npz"]
    again, gear = load_atlas(path), steel_gear()
    np.testing.assert_array_equal(again.gear(gear).row, atlas.gear(gear).row)
    for key, error in atlas.gear(gear).errors.items():
        assert again.gear(gear).errors[key] == error
    assert (again.family, again.settings, again.version) == (atlas.family, atlas.settings, atlas.version)
    whole = path.read_bytes()
    middle = len(whole) // 2
    for content in (b"", b"text", whole[:2000], whole[:middle] + bytes(64) + whole[middle + 64 :]):
        path.write_bytes(content)
        with pytest.raises(InputError, match="is not an atlas of fegear"):
            load_atlas(path)
    with pytest.raises(FileNotFoundError):
        load_atlas(tmp_path / "b.npz")


def test_rows_of_another_kind_are_refused(atlas, tmp_path, monkeypatch):
    monkeypatch.setattr("fegear.atlas.interpolation.VERSION", 0)
    atlas.save(tmp_path / "old.npz")
    monkeypatch.undo()
    with pytest.raises(InputError, match="build it again"):
        load_atlas(tmp_path / "old.npz")


@pytest.mark.dear
def test_building_goes_on_where_it_was_stopped(tmp_path: Path):
    domains, budget = [Domain((24, 48), (0.2, 0.2))], Budget(1.0)
    seen = []

    def stop(done: int, total: int) -> None:
        seen.append((done, total))
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        build_atlas(FAMILY, domains, SETTINGS, budget=budget, cache=cache_on_disk(tmp_path), progress=stop)
    assert seen == [(1, 10), (2, 10)]
    cache = cache_on_disk(tmp_path)
    whole = build_atlas(FAMILY, domains, SETTINGS, budget=budget, cache=cache)
    assert (cache.shapes.computed, cache.shapes.from_disk) == (8, 2)
    again = build_atlas(FAMILY, domains, SETTINGS, budget=budget, cache=cache_on_disk(tmp_path))
    np.testing.assert_array_equal(again.common.rows, whole.common.rows)
