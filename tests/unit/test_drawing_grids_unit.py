"""Corners drawn on grids, maps of curved elements that keep what was asked last, and steps of a growing crack."""

from types import SimpleNamespace

import numpy as np
import pytest
from skfem import MappingIsoparametric

from fegear.fem.plane.curved_map import CurvedMap
from fegear.fem.plane.drawing_grid import GRID, line_on_a_grid, on_a_grid, rounded
from fegear.fem.plane.elements import sector_elements
from fegear.fem.plane.odd import growth
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

POLYGON = np.array([[0.1, 3.3, 3.31, 0.7], [0.2, 0.1, 0.13, 2.9]])


def grids(shorter):
    """The largest power of two that is no larger than a thousandth of the shorter edge."""
    return 2.0 ** np.floor(np.log2(GRID * shorter))


def test_corners_are_on_the_grid_of_their_shorter_edge_and_last_bits_leave_them():
    length = np.hypot(*(np.roll(POLYGON, -1, axis=1) - POLYGON))
    grid = grids(np.array([min(length[n - 1], length[n]) for n in range(4)]))
    drawn, edges = on_a_grid(POLYGON)
    assert np.array_equal(np.round(drawn / grid), drawn / grid)
    assert (np.abs(drawn - POLYGON) <= 0.5 * grid).all()
    assert edges == pytest.approx([np.hypot(*(drawn[:, (n + 1) % 4] - drawn[:, n])) for n in range(4)])
    assert np.array_equal(on_a_grid(POLYGON * (1.0 + 1e-15))[0], drawn)
    assert grid.min() < 1e-4 < grid.max()  # the short edge has a grid of its own


def test_an_open_line_is_drawn_without_its_first_vertex():
    drawn, edges = line_on_a_grid(POLYGON)
    length = np.hypot(*np.diff(POLYGON))
    grid = grids(np.array([min(length[0], length[1]), min(length[1], length[2]), length[2]]))
    assert drawn.shape == (2, 3)
    assert np.array_equal(np.round(drawn / grid), drawn / grid)
    assert (np.abs(drawn - POLYGON[:, 1:]) <= 0.5 * grid).all()
    every = np.column_stack([POLYGON[:, 0], drawn])
    assert edges == pytest.approx(np.hypot(*np.diff(every)))


@pytest.mark.parametrize("size", [0.3, 0.25, 1.0, 1.7, 3e-4])
def test_grids_are_powers_of_two_no_larger_than_asked(size):
    points = np.linspace(-5.0, 5.0, 37) * np.pi
    found = rounded(points, size)
    grid = 2.0 ** np.floor(np.log2(size))
    assert 0.5 * size < grid <= size
    assert np.abs(found - points).max() <= 0.5 * grid
    assert np.array_equal(found, np.round(points / grid) * grid)


def test_a_map_keeps_what_was_asked_last_and_answers_as_scikit_fem():
    mesh = mesh_sector(Tooth(23, BasicRack()), 7.0, settings_at(-6))
    grid = sector_elements(mesh, 2).grid
    one, other = CurvedMap(grid), MappingIsoparametric(grid, grid.elem())
    at, chosen = np.array([[0.2, 0.6, 0.1], [0.3, 0.1, 0.8]]), np.array([3, 0, 7])
    for which in (None, chosen):
        assert one.invDF(at, which) == pytest.approx(other.invDF(at, which))
        for i in (0, 1):
            for j in (0, 1):
                assert one.J(i, j, at, which) == pytest.approx(other.J(i, j, at, which))
    assert one.invDF(at, chosen) is one.invDF(at, chosen)
    elsewhere = at[:, ::-1].copy()
    assert one.J(0, 1, elsewhere, chosen) == pytest.approx(other.J(0, 1, elsewhere, chosen))
    assert one.J(0, 1, elsewhere) == pytest.approx(other.J(0, 1, elsewhere))


@pytest.mark.parametrize("estimated", [True, False])
@pytest.mark.parametrize("first", [True, False])
def test_a_step_is_that_of_the_load_that_opens_it_most_and_errs_by_orders_and_rings(first, estimated, monkeypatch):
    """K by two rings under three loads and, after the first step, of the middle found then; line loads 1, 4 and 2."""
    count = 3 if first else 4
    k_1, k_2 = np.array([5.0, 3.0, 4.0, 9.0])[:count], np.array([1.0, -2.0, 0.5, 7.0])[:count]
    fine = np.stack([np.stack([k_1, k_2]), np.stack([k_1 + 0.1, k_2 - 0.02])])
    lower = np.stack([np.stack([k_1 - 0.3, k_2 + 0.01])] * 2)
    asked, rest = [], SimpleNamespace(lower="lower" if estimated else None, half=1)

    def under(tooth, crack, sector, elasticity, ring, radius, poisson_ratio, plane, support):
        asked.append((elasticity, ring, radius.tolist(), poisson_ratio, plane, support))
        coarse, own = elasticity == "coarse", np.array([10.0, 20.0, 30.0, 40.0])[:count]
        return (lower if coarse else fine), own - 0.5 * coarse, np.array([0.1, 0.2, 0.3, 0.4])[:count]

    monkeypatch.setattr(growth, "_under", under)
    monkeypatch.setattr(growth, "cracked_patch", lambda *_asked: SimpleNamespace(mesh="mesh"))
    monkeypatch.setattr(growth, "assemble_section", lambda *_asked: "fine")
    monkeypatch.setattr(growth, "assemble_section_two_orders", lambda *_asked: ("fine", "coarse"))
    loads, middle = (np.array([9.1, 9.4, 9.9]), np.array([1.0, 4.0, 2.0])), np.nan if first else 9.6
    settings = SimpleNamespace(order=4, solver="condensed")
    found = growth._one("tooth", 7.0, 0.3, "strain", "crack", loads, rest, settings, None, middle)
    radii = [9.1, 9.4, 9.9] if first else [9.1, 9.4, 9.9, 9.6]
    assert asked[0] == ("fine", rest, radii, 0.3, "strain", None)
    assert asked[1:] == ([("coarse", "lower", radii, 0.3, "strain", None)] if estimated else [])
    # of 5, 12 and 8 the second load's; it is followed where that load acts, its compliance in the middle found first
    assert found.k == pytest.approx([12.0, -8.0])
    assert (found.radius, found.middle, found.shut) == (9.4, 9.4 if first else 9.6, 0.2)
    assert found.compliance == (20.0 if first else 40.0)
    if estimated:
        # rings change 0.1 and 0.02, orders 0.3 and 0.01, four times; one mode by chance no less than half of the other
        assert found.k_error == pytest.approx([1.6, 0.8])
        assert found.compliance_error == pytest.approx(0.5)
    else:
        assert np.isnan([*found.k_error, found.compliance_error]).all()
