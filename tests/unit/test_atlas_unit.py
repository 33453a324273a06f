"""An atlas of few coarse gears: at a node it is the solved gear, between nodes it is within its stated error."""

from __future__ import annotations

import math
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fegear.atlas.atlas import Atlas, load_atlas
from fegear.atlas.build import Region, build_atlas
from fegear.atlas.domain import Domain
from fegear.atlas.family import Family, Place, place_of
from fegear.atlas.interpolation import contracted, left_out, series, truncation, weights
from fegear.base.errors import InputError, RangeError
from fegear.base.solution_cache import cache_on_disk
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

FAMILY = Family()
SETTINGS = settings_at(-6.0)
DOMAIN = Domain((24, 48), (0.1, 0.3))


@pytest.fixture(scope="module")
def atlas() -> Atlas:
    return build_atlas(FAMILY, [Region(DOMAIN, (3, 3, 1, 1))], SETTINGS)


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


def test_at_a_node_it_is_the_solved_gear(atlas):
    gear = FAMILY.gear(Place(34, 0.3, 1.0, 0.5))
    off = differences(atlas, gear)
    assert off["c_self"] < 2e-6
    assert off["c_neighbour"] < 2e-6
    # Stress is taken from the edges' Gauss points to other places, along fillets of few edges.
    assert max(off.values()) < 2e-3
    piece = atlas.pieces[0]
    nodes = [place for place in piece.nodes.places(piece.domain, FAMILY) if place.teeth == 34]
    assert [round(place.shift, 12) for place in nodes] == [0.1, 0.2, 0.3]
    assert atlas.gear(gear).errors["c_self"] < 5e-3  # of the solved gears only


@pytest.mark.parametrize("place", [Place(29, 0.22, 1.0, 0.5), Place(41, 0.15, 1.0, 0.5)])
def test_between_nodes_it_is_within_its_stated_error(atlas, place):
    gear = FAMILY.gear(place)
    off, stated = differences(atlas, gear), atlas.gear(gear).errors
    assert stated.keys() == off.keys()
    assert [key for key in off if off[key] > stated[key]] == []
    assert stated["c_self"] < 2e-2
    assert stated["tension 0"] < 5e-2
    node = atlas.gear(FAMILY.gear(place._replace(teeth=34, shift=0.3))).errors
    assert stated["c_self"] > node["c_self"]


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
        (lambda: steel_gear(50), "teeth = 50: is outside the atlas, 24 to 48"),
        (lambda: steel_gear(30, 0.31), "profile_shift = 0.31: is outside the atlas, 0.1 to 0.3"),
        (lambda: replace(steel_gear(), bore_radius=0.02), "bore ratio = "),
        (lambda: replace(steel_gear(), tooth=replace(steel_gear().tooth, tip_radius=16.6)), "tip height = 0.93: "),
        (lambda: steel_gear(plane="stress"), 'plane = "stress": must be "strain" in this atlas'),
        (lambda: steel_gear(material=Material(poisson_ratio=0.25)), "poisson_ratio = 0.25: must be 0.3 in this atlas"),
        (lambda: Gear(Tooth(31, BasicRack(), 0.17), 3e-3, 0.02), "rack.tip_radius = 0.25: must be 0.38"),
        (
            lambda: Gear(Tooth(31, BasicRack(1.0, 1.25, 0.38), 0.17, helix_angle=0.2), 3e-3, 0.02, hand="left"),
            "helix_angle = 0.2: must be 0",
        ),
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
    under = Domain((12, 16), (-0.2, 0.6), side="undercut")
    under.check(FAMILY)
    assert whole.shift_ends(FAMILY, 14) == (line, 0.5)
    for domain, cut in ((whole, False), (under, True)):
        places = domain.nodes((3, 3, 1, 1)).places(domain, FAMILY)
        assert len(places) == 9
        inside = [p for p in places if p.shift > domain.shift_ends(FAMILY, p.teeth)[0]]
        assert {FAMILY.gear(place).tooth.undercut for place in inside} == {cut}
        for place in places:
            assert domain.outside(FAMILY, place) is None
    with pytest.raises(InputError, match="leaves nothing"):
        Domain((30, 40), (-0.2, 0.6), side="undercut").check(FAMILY)


def test_a_place_has_its_coordinates():
    domain = Domain((12, 40), (0.5, 0.7), (0.8, 1.1), (0.3, 0.7))
    at = (0.3, -0.6, 0.9)
    place = domain.place(FAMILY, 21, at)
    found = domain.coordinates(FAMILY, place)
    np.testing.assert_allclose(found[1:], at, atol=1e-12)
    assert found[0] == pytest.approx(2.0 * math.log(21 / 12) / math.log(40 / 12) - 1.0)
    counts = domain.nodes((6, 4, 3, 3))
    assert counts.shape == (6, 4, 3, 3)
    assert counts.teeth[0] == 12
    assert counts.teeth[-1] == 40
    with pytest.raises(InputError, match="nodes of bore"):
        domain.nodes((6, 4, 3, 1))


def test_a_polynomial_is_itself_and_what_is_left_out_is_estimated():
    first, second = -np.cos(np.pi * np.arange(6) / 5), -np.cos(np.pi * np.arange(4) / 3)
    at = 0.37, -0.81
    factors = [weights(first, at[0]), weights(second, at[1])]
    grid = np.meshgrid(first, second, indexing="ij")
    cubic = grid[0] ** 5 - 2.0 * grid[0] * grid[1] ** 3
    assert contracted(cubic, factors) == pytest.approx(at[0] ** 5 - 2.0 * at[0] * at[1] ** 3, abs=1e-13)
    np.testing.assert_allclose(series(second) @ (4.0 * second**3), [0.0, 3.0, 0.0, 1.0], atol=1e-13)
    smooth = 1.0 / (grid[0] + 2.5) + 1.0 / (grid[1] + 4.0)
    stated = sum(truncation([np.abs(one) for one in last]) for last in left_out(smooth, (first, second), at))
    true = max(
        abs(contracted(smooth, [weights(first, x), weights(second, y)]) - 1.0 / (x + 2.5) - 1.0 / (y + 4.0))
        for x in np.linspace(-1, 1, 41) for y in np.linspace(-1, 1, 41)
    )  # fmt: skip
    assert true < stated < 6.0 * true


def test_a_gear_at_the_undercut_line_is_on_the_whole_side():
    domain = Domain((13, 15), (-0.4, 0.5))
    alone = build_atlas(FAMILY, [Region(domain, (2, 2, 1, 1))], SETTINGS)
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
        assert again.gear(gear).errors[key] == pytest.approx(error, rel=1e-5)
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
    monkeypatch.setattr("fegear.atlas.atlas.VERSION", 0)
    atlas.save(tmp_path / "old.npz")
    monkeypatch.undo()
    with pytest.raises(InputError, match="build it again"):
        load_atlas(tmp_path / "old.npz")


def test_building_goes_on_where_it_was_stopped(tmp_path: Path):
    regions = [Region(Domain((24, 48), (0.2, 0.2)), (3, 1, 1, 1))]
    seen = []

    def stop(done: int, total: int) -> None:
        seen.append((done, total))
        if done == 2:
            raise KeyboardInterrupt

    with pytest.raises(KeyboardInterrupt):
        build_atlas(FAMILY, regions, SETTINGS, cache=cache_on_disk(tmp_path), progress=stop)
    assert seen == [(1, 3), (2, 3)]
    cache = cache_on_disk(tmp_path)
    whole = build_atlas(FAMILY, regions, SETTINGS, cache=cache)
    assert (cache.shapes.computed, cache.shapes.from_disk) == (1, 2)
    again = build_atlas(FAMILY, regions, SETTINGS, cache=cache_on_disk(tmp_path))
    np.testing.assert_array_equal(again.basis, whole.basis)
