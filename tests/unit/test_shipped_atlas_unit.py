"""The atlas that comes with fegear: what it holds, what it states, and arrays of pairs through it."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.atlas.__main__ import main
from fegear.atlas.family import Place
from fegear.atlas.many_pairs import ManySpurPairs, known_pairs
from fegear.atlas.shipped import RACKS, atlas_of, domains_of, family_of, file_name, nearest_atlas, shipped_atlas
from fegear.base.errors import InputError, RangeError
from fegear.contact.many.many_load_sharing import transmission_errors
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.transmission_error import transmission_error
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack


def _gear(teeth: int, shift: float, module: float = 3e-3, **others: object) -> Gear:
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.38), shift)
    return Gear(tooth, module, 0.5 * tooth.root_radius * module, face_width=0.02, **others)  # type: ignore[arg-type]


def test_it_states_its_errors_and_is_found_by_gear():
    atlas = shipped_atlas("A")
    assert atlas.reach == 2
    assert atlas.tolerance == 2e-4
    errors = atlas.gear(_gear(31, 0.1)).errors
    assert max(errors["c_self"], errors["c_neighbour"], errors["tension 0"]) < 2e-3
    assert atlas_of(_gear(31, 0.1)) is atlas
    assert atlas_of(_gear(14, 0.1)) is atlas  # undercut
    assert atlas_of(_gear(200, 0.0)) is atlas
    assert atlas_of(_gear(401, 0.0)) is None
    default = Tooth(31, BasicRack(1.0, 1.25, 0.25), 0.1)
    assert atlas_of(Gear(default, 3e-3, 1.5e-3 * default.root_radius)) is shipped_atlas("C")
    between = Tooth(31, BasicRack(1.0, 1.25, 0.3), 0.1)
    assert atlas_of(Gear(between, 3e-3, 1.5e-3 * between.root_radius)) is shipped_atlas("B")
    assert atlas_of(_gear(31, 0.1, plane="stress")) is None
    assert atlas.domains == tuple(domains_of(atlas.family))
    for rack in RACKS:
        for domain in domains_of(family_of(rack)):
            domain.check(family_of(rack))
    deep = Tooth(31, BasicRack(1.0, 1.4, 0.39), 0.1)
    assert atlas_of(Gear(deep, 3e-3, 1.5e-3 * deep.root_radius)) is shipped_atlas("D")
    with pytest.raises(InputError, match=r"python -m fegear\.atlas"):
        shipped_atlas("E")
    with pytest.raises(InputError, match="must be one of A, B, C, D"):
        family_of("E")
    assert main(["E"]) == 2
    assert file_name("A") == "iso53_a.npz"


@pytest.mark.dear
def test_of_a_gear_that_is_solved_it_is_within_its_stated_error():
    from fegear.atlas.build import solved

    atlas = shipped_atlas("A")
    for place in (Place(37, 0.21, 0.97, 0.43), Place(15, 0.33, 1.0, 0.5), Place(16, -0.1, 1.0, 0.5)):
        gear = atlas.family.gear(place)
        row, known = solved(gear, atlas.settings, atlas.reach)["row"], atlas.gear(gear)
        off = dict(zip(atlas.layout.quantities, atlas.layout.differences(row, known.row - row), strict=True))
        assert [key for key in off if off[key] > 1.5 * known.errors[key]] == []
        assert max(off["c_self"], off["c_neighbour"]) < 8e-5  # finer than stresses
        assert off["tension 0"] < 1e-3


@pytest.mark.dear
def test_a_gear_on_the_undercut_line_is_within_its_stated_error():
    """Those of rack C lie 3e-17 below it and began in a corner: 1.6e-3 off for 3e-4."""
    atlas = shipped_atlas("C")
    gear = atlas.family.gear(Place(12, atlas.family.least_shift(12), 1.0, 0.5))
    solved, known = solve_gear(gear, atlas.settings, estimate_error=False), atlas.gear(gear)
    r = np.linspace(gear.involute_radii[0] + 1e-9, gear.involute_radii[1] - 1e-9, 15)
    own, interpolated = (finite_element_compliance(one).own(0, r) for one in (solved, known))
    assert np.abs(interpolated / own - 1.0).max() < min(3e-4, known.errors["c_self"])


@pytest.mark.dear
def test_arrays_of_pairs_through_an_atlas_are_pairs_of_its_gears():
    gears = [(_gear(17, 0.3), _gear(60, -0.1)), (_gear(15, 0.1), _gear(24, 0.2)), (_gear(31, 0.1), _gear(450, 0.0))]
    pairs = [GearPair(*both) for both in gears]

    def each(of) -> np.ndarray:
        return np.array([[of(both[i]) for both in gears] for i in (0, 1)], dtype=float)

    many = ManySpurPairs(
        each(lambda g: g.teeth), each(lambda g: g.tooth.generating_shift), each(lambda g: g.tip_radius),
        each(lambda g: g.bore_radius), np.full(3, 3e-3), np.array([pair.centre_distance for pair in pairs]),
        np.full(3, 0.02), each(lambda g: g.material.young_modulus),
    )  # fmt: skip
    atlas = shipped_atlas("A")
    known = known_pairs(atlas, many)
    assert known.held.tolist() == [True, True, False]
    assert known.error[:, :2].max() < 5e-3
    found = transmission_errors(known.engagements, [4000.0], waves=8, samples=48, order=16)
    assert math.isnan(found.mean[2, 0])
    for i in (0, 1):
        sources = [atlas.compliance(gear) for gear in gears[i]]
        one = Engagement(PairCompliance(pairs[i], *sources), corner_contact=True)
        alone = transmission_error(one, 4000.0, 8, order=16)
        # where the flank of an undercut gear begins is interpolated
        tolerance = 1e-9 if i == 0 else 1e-3
        assert found.mean[i, 0] == pytest.approx(alone.mean, rel=tolerance)
        assert abs(found.peak_to_peak[i, 0] - alone.peak_to_peak) < max(tolerance, 1e-6) * alone.mean


def test_a_gear_of_no_atlas_is_refused_by_what_differs_from_the_nearest_one():
    """By its Poisson's ratio, not by the rack of another atlas; in words of its keys and with a remedy of a case."""
    tooth = Tooth(31, BasicRack(1.0, 1.4, 0.39))
    soft = Gear(tooth, 3e-3, 1.5e-3 * tooth.root_radius, material=Material(2.9e9, 0.35, 1410.0))
    with pytest.raises(RangeError, match=r"poisson_ratio = 0.35: must be 0.3 in this atlas; .*accuracy.source"):
        nearest_atlas(soft).gear(soft)
    thick = Gear(tooth, 3e-3, 0.9 * 3e-3 * tooth.root_radius)
    outside = r"bore_radius = 0.9 root radii: is outside the range of the atlas, 0.35 to 0.65"
    with pytest.raises(RangeError, match=outside):
        nearest_atlas(thick).gear(thick)
    flat = Gear(replace(tooth, tip_radius=tooth.tip_radius - 0.4), 3e-3, 1.5e-3 * tooth.root_radius)
    with pytest.raises(RangeError, match=r"tip_diameter = tip circle 0.6 modules above"):
        nearest_atlas(flat).gear(flat)
    assert atlas_of(soft) is atlas_of(thick) is atlas_of(flat) is None
    leaning = replace(tooth, helix_angle=0.2, tip_radius=math.nan)
    helical = Gear(leaning, 3e-3, 1.5e-3 * leaning.root_radius, hand="left")
    assert atlas_of(helical) is None
