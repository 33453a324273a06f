"""A plane gear's influence in SI: another module and steel change every quantity by a known factor, and its place."""

from dataclasses import replace

import numpy as np
import pytest

from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.fem.plane.gear import GearInfluence
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.rack import BasicRack

LARGER, STIFFER = 2.5, 1.7
SIDES = ("tension", "compression")


def close(wanted, rel=1e-9):
    """`pytest.approx` without its absolute tolerance of 1e-12, which is a tenth of a compliance [m^2/N]."""
    size = 1e-12 * np.abs(wanted).max()
    return pytest.approx(wanted, rel=rel, abs=size)


@pytest.fixture(scope="module")
def both():
    """One solution for gears of two sizes and steels."""
    tooth = Tooth(23, BasicRack(1.0, 1.25, 0.3))
    small = Gear(tooth, 2e-3, 0.6 * tooth.root_radius * 2e-3, 0.02, Material(2e11, 0.3))
    bore = LARGER * small.bore_radius
    large = replace(small, module=LARGER * 2e-3, bore_radius=bore, material=Material(STIFFER * 2e11, 0.3))
    known = solve_gear(small, settings_at(-5.0))
    return known, replace(known, gear=large)


@pytest.fixture(scope="module")
def radius(both):
    known = both[0]
    return np.linspace(known.lowest_radius, known.highest_radius, 7)[1:-1]


def test_lengths_go_with_the_module(both):
    one, other = both
    for name in ("lowest_radius", "highest_radius", "reference_half_width"):
        assert getattr(other, name) == close(LARGER * getattr(one, name), rel=1e-14)
    assert one.reference_half_width == close(0.02 * 2e-3)
    low, high = one.gear.involute_radii
    assert one.lowest_radius == close(low, rel=1e-3)
    assert one.highest_radius == close(high, rel=1e-3)


def test_compliances_go_with_the_steel_only(both, radius):
    one, other = both
    b = np.full(radius.shape, 3e-5)
    assert other.log_slope == close(one.log_slope / STIFFER)
    assert one.log_slope == close(2.0 * (1.0 - 0.09) / (np.pi * 2e11))
    for name in ("self_compliance", "self_error"):
        small, large = getattr(one, name)(radius, b), getattr(other, name)(LARGER * radius, LARGER * b)
        assert large == close(small / STIFFER, rel=1e-12)
        assert (small > 0.0).all()
    for small, large in zip(one.contact(radius, b), other.contact(LARGER * radius, LARGER * b), strict=True):
        assert large == close(small / STIFFER, rel=1e-12)
    assert one.contact(radius, b)[0] == close(one.self_compliance(radius, b), rel=1e-12)
    assert one.contact(radius, b)[1] == close(one.self_error(radius, b), rel=1e-12)
    p, q = radius[:2], radius[2:]
    for k in (1, -1):
        assert other.neighbour(k, LARGER * p, LARGER * q) == close(one.neighbour(k, p, q) / STIFFER)
        value, error = one.neighbour_with_error(k, p, q)
        assert value == close(one.neighbour(k, p, q), rel=1e-12)
        assert error == close(one.neighbour_error(k, p, q), rel=1e-12)
        assert other.neighbour_error(k, LARGER * p, LARGER * q) == close(error / STIFFER)
        assert value.shape == error.shape == (2, 3)


def test_wider_contacts_give_way_less_by_the_logarithm(both, radius):
    one = both[0]
    narrow, wide = (one.self_compliance(radius, b) for b in (1e-5, 4e-5))
    assert narrow - wide == close(np.full(radius.shape, one.log_slope * np.log(4.0)), rel=0.01)


@pytest.mark.parametrize("side", SIDES)
@pytest.mark.parametrize("k", [0, 1, -1])
def test_root_stress_goes_with_the_module_and_so_does_its_place(both, radius, side, k):
    one, other = both
    small, place = one.largest_root_stress(k, side, radius)
    large, there = other.largest_root_stress(k, side, LARGER * radius)
    assert large == close(small / LARGER, rel=1e-12)
    assert there == close(LARGER * place, rel=1e-12)
    curve = one.fillet_stress(k, side, radius)
    assert other.fillet_stress(k, side, LARGER * radius) == close(curve / LARGER, rel=1e-12)
    value, arc, error = one.root_stress_with_error(k, side, radius)
    assert value.tolist() == small.tolist()
    assert arc.tolist() == place.tolist()
    assert error == close(one.root_stress_error(k, side, radius), rel=1e-12)
    assert other.root_stress_error(k, side, LARGER * radius) == close(error / LARGER, rel=1e-12)
    wide = one.largest_root_stress(k, side, radius, 1.5e-4)[0]
    assert other.largest_root_stress(k, side, LARGER * radius, LARGER * 1.5e-4)[0] == close(wide / LARGER)


@pytest.mark.parametrize("module", [1.0, 3e-3])
@pytest.mark.parametrize("side", SIDES)
def test_a_fillet_s_curve_in_metres_finds_what_it_finds_in_modules(both, side, module):
    """Radii of contacts and places are in the unit of the module; stress is what it was given."""
    known = both[0].fine
    radius = np.linspace(known.flank.lowest_radius + 0.02, known.flank.highest_radius - 0.1, 5)
    stress = known.fillet_stress(0, side, radius, 0.02)
    value, place = known.fillet_curve(side, module).largest(stress, module * radius, 0.02)
    wanted, there = known.largest_root_stress(0, side, radius, 0.02)
    assert value == close(wanted, rel=1e-12)
    assert place == close(module * there, rel=1e-12)
    free = known.fillet_curve(side, module).largest(stress)
    assert (np.abs(free[0]) >= np.abs(wanted) * (1.0 - 1e-9)).all()


def test_without_a_second_solution_errors_are_no_numbers(both, radius):
    alone = replace(both[0], estimate=None)
    assert isinstance(alone, GearInfluence)
    assert alone.coarse is None
    assert both[0].coarse is both[0].estimate.coarse
    for found in (
        alone.self_error(radius, 3e-5), alone.contact(radius, 3e-5)[1], alone.neighbour_error(1, radius, radius),
        alone.root_stress_error(0, "tension", radius),
    ):  # fmt: skip
        assert np.isnan(found).all()
    assert alone.contact(radius, 3e-5)[0] == close(both[0].contact(radius, 3e-5)[0])
    assert alone.contact(radius, 3e-5)[2] == close(both[0].contact(radius, 3e-5)[2])
    assert all(np.isnan(one) for one in alone.largest_errors().values())
    assert alone.common_errors() == (0.0, 0.0)


def test_a_source_of_compliance_asks_its_gear(both, radius):
    one = both[0]
    small, large = (finite_element_compliance(known) for known in both)
    width = small.reference_half_width(radius)
    assert small.own(0, radius) == close(one.self_compliance(radius, width), rel=1e-3)
    assert large.reference_half_width(LARGER * radius) == close(LARGER * width)
    assert large.own(3, LARGER * radius) == close(small.own(3, radius) / STIFFER, rel=1e-9)
    assert large.between(2, 1, LARGER * radius, LARGER * radius) == close(
        small.between(2, 1, radius, radius) / STIFFER, rel=1e-9
    )
    assert small.between(2, 1, radius, radius) == close(np.diagonal(one.neighbour(1, radius, radius)), rel=1e-3)
    for side in SIDES:
        assert large.root_stress(0, 0, LARGER * radius, side) == close(
            small.root_stress(0, 0, radius, side) / LARGER, rel=1e-9
        )
        assert small.root_stress(0, 0, radius, side) == close(one.fillet_stress(0, side, radius, width), rel=5e-3)
        error = small.root_stress_error(1, 0, radius, side)
        assert error == close(one.root_stress_error(1, side, radius), rel=1e-6)
    beyond = np.array([0.5 * radius[0], 2.0 * radius[-1]])
    ends = np.array([one.lowest_radius, one.highest_radius])
    assert small.root_stress_error(0, 0, beyond) == close(one.root_stress_error(0, "tension", ends))
