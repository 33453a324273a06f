"""Crack faces that may press on each other: complementarity by trying all sets, degree one, open and shut cracks."""

import functools
import itertools
import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.fem.plane.influence import SIDES
from fegear.fem.plane.odd.crack import Crack, fillet_point, mouth_at_tangent, straight_crack
from fegear.fem.plane.odd.crack_faces import opening_rows, pressed
from fegear.fem.plane.odd.cracked_sector import FACES, cracked_sector
from fegear.fem.plane.odd.odd_influence import solve_odd_influence
from fegear.fem.plane.odd.odd_solution import solve_cracked_gear
from fegear.fem.plane.odd.tooth_kind import OddTooth
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.fem.plane.supported_section import assemble_section
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.fem.plane.trace import lagrange
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.rack import BasicRack

NU, SETTINGS = 0.3, settings_at(-3)
TOOTH = Tooth(28, BasicRack())
BORE = 0.5 * TOOTH.root_radius
PATCH = SETTINGS.patch_half_width
RADII = [13.5, 14.1, 14.6]


@functools.cache
def ordinary():
    return mesh_sector(TOOTH, BORE, SETTINGS)


def crack(depth, *, back, closing):
    mouth = mouth_at_tangent(TOOTH, math.radians(30.0))
    straight = straight_crack(TOOTH, mouth, math.radians(70.0), depth=depth, back=back)
    return replace(straight, closing=closing)


@functools.cache
def solved(depth, *, back=True, closing=True):
    """Tooth 0 cracked; ordinary with no depth."""
    sector = cracked_sector(TOOTH, BORE, SETTINGS, crack(depth, back=back, closing=closing)) if depth else ordinary()
    return solve_odd_influence(TOOTH, ordinary(), {0: OddTooth(TOOTH, sector)}, NU, "strain", SETTINGS)


def loads(found, tooth, radii):
    return found.tooth(tooth).remote(radii, PATCH)


def by_trying(compliance, opening):
    """The only one of all sets of pressed nodes with no tension and no gap below zero."""
    count = opening.size
    for closed in itertools.product([False, True], repeat=count):
        at = np.flatnonzero(closed)
        force = np.zeros(count)
        if at.size:
            force[at] = np.linalg.solve(compliance[np.ix_(at, at)], -opening[at])
        if (force >= -1e-12).all() and (opening + compliance @ force >= -1e-12).all():
            return force
    raise AssertionError("no set")


def test_every_set_of_pressed_nodes_tried():
    """Random symmetric matrices, nearly singular ones among them, whose openings are of both signs."""
    rng = np.random.default_rng(51)
    for count in range(1, 8):
        for _ in range(12):
            factor = rng.normal(size=(count, count)) * 10.0 ** rng.uniform(-2.0, 2.0, count)[:, None]
            compliance = factor @ factor.T + 1e-6 * np.trace(factor @ factor.T) / count * np.eye(count)
            opening = rng.normal(size=(count, 4))
            found = pressed(compliance, opening)
            assert (found >= 0.0).all()
            for load in range(4):
                scale = 1.0 + np.abs(found[:, load]).max()
                assert found[:, load] == pytest.approx(by_trying(compliance, opening[:, load]), abs=1e-7 * scale)


def test_a_set_that_goes_round_is_left_one_by_one(monkeypatch):
    """The sets tried one from the other need not end; nodes taken one by one do."""
    from fegear.fem.plane.odd import crack_faces

    rng = np.random.default_rng(7)
    factor = rng.normal(size=(9, 9))
    compliance, opening = factor @ factor.T + 0.1 * np.eye(9), rng.normal(size=(9, 6))
    usual = pressed(compliance, opening)
    monkeypatch.setattr(crack_faces, "_MOST_SETS", 0)
    assert pressed(compliance, opening) == pytest.approx(usual, abs=1e-9)


def test_openings_and_forces_of_faces_from_a_crack_that_is_pulled_apart():
    """A crack with a bend: rows have opposite nodes, point from the right face to the left and leave out the tip."""
    mouth = mouth_at_tangent(TOOTH, math.radians(30.0))
    start = fillet_point(TOOTH, mouth)
    corners = tuple(tuple((start + off).tolist()) for off in np.array([[-0.3, -0.1], [-0.5, -0.35]]))
    sector = cracked_sector(TOOTH, BORE, SETTINGS, Crack(mouth, corners, closing=True))
    elasticity = assemble_section(sector.mesh, NU, "strain", SETTINGS.order, SETTINGS.solver, None)
    unknowns, rows, _ = opening_rows(sector.mesh, elasticity)
    faces = [elasticity.edge_dofs[name] for name in FACES]
    tip = np.intersect1d(*faces)
    assert not np.isin(tip, unknowns).any()
    assert rows.shape[0] == SETTINGS.order * sector.mesh.edges[FACES[0]].shape[1]
    assert rows.sum(axis=1) == pytest.approx(0.0, abs=1e-12)  # a motion of the whole opens nothing
    assert (rows**2).sum(axis=1) == pytest.approx(2.0)
    left = np.isin(unknowns, faces[0])
    way = np.array([-0.3, -0.1]) / math.hypot(0.3, 0.1)
    apart = np.where(left, np.where(unknowns % 2 == 0, -way[1], way[0]), 0.0)
    opening = rows @ apart
    assert opening[0] == pytest.approx(1.0)  # at the mouth, whose first piece this is
    assert (opening > 0.8).all()
    assert np.isclose(opening, 1.0).any()
    assert not np.isclose(opening, 1.0).all()


def test_a_crack_that_opens_has_the_open_numbers():
    one, other = (solved(0.7, back=False, closing=closing) for closing in (False, True))
    for i, j in itertools.product(range(-2, 3), repeat=2):
        usual = one.between(i, j, RADII, RADII, PATCH)
        assert np.abs(other.between(i, j, RADII, RADII, PATCH) - usual).max() < 1e-12 * np.abs(usual).max()
        for side in SIDES:
            usual = one.fillet_stress(i, j, side, RADII)
            # Rounding only: 1e-11 to 1.1e-10 of the largest, by the processor.
            assert np.abs(other.fillet_stress(i, j, side, RADII) - usual).max() < 1e-9 * np.abs(usual).max()
    assert other.own(0, RADII, PATCH) == pytest.approx(one.own(0, RADII, PATCH), rel=1e-12)
    assert not other.face_forces(0, 0, loads(other, 0, RADII)).any()


@pytest.mark.parametrize(("depth", "opened", "shut"), [(0.5, 0.37, 0.012), (1.0, 1.46, 0.029), (1.4, 3.71, 0.041)])
def test_a_reversed_flank(depth, opened, shut):
    """An own program with contact of the faces: a load on one edge of the flank, 1.2, 2.9 and 4.1 % softer."""
    healthy, found = solved(0.0), solved(depth)
    at, inward = _edge()
    press, press_healthy = (_even(one.kind(0).flank, at, inward) for one in (found, healthy))
    usual = (press_healthy.T @ healthy.tooth(0).compliance[0] @ press_healthy)[0, 0]
    softer = (press.T @ found.tooth(0).compliance[0] @ press)[0, 0]
    less = (found.opening(0, 0, press) * found.face_forces(0, 0, press)).sum()
    assert softer / usual - 1.0 == pytest.approx(opened, rel=0.015)
    assert (softer + less) / usual - 1.0 == pytest.approx(shut, abs=1e-3)


@pytest.mark.parametrize("depth", [0.5, 1.4])
def test_contact_is_softer_than_no_crack_and_stiffer_than_none(depth):
    """Faces grown together may not slide, free ones may go through each other; at 1.4 modules only a part is shut."""
    healthy, found, free = solved(0.0), solved(depth), solved(depth, closing=False)
    least, own, most = (one.own(0, RADII, PATCH) for one in (healthy, found, free))
    assert (least < own).all()
    assert (own < 1.1 * least).all()
    assert (own < 0.9 * most).all()
    share = (found.face_forces(0, 0, loads(found, 0, RADII)) > 0.0).mean(axis=0)
    assert (share.min() < 1.0) == (depth > 1.0)
    for side in SIDES:  # root stress goes by the forces between the faces as well
        off = [
            np.abs(
                one.largest_root_stress(1, 0, side, RADII)[0] / healthy.largest_root_stress(1, 0, side, RADII)[0] - 1
            )
            for one in (found, free)
        ]
        assert (off[0] < off[1]).all()


def _edge():
    """Radii of an edge of that program's flank, and the direction of its load."""
    radii = np.array([13.84325798, 14.23357694])
    return radii, np.array([-0.95507055, -0.29637856])


def _even(flank, radii, inward, count=400):
    """An even pressure between two radii, as forces on the unknowns of a flank, shape (2 n, 1)."""
    first, last = flank.arc_of_radius(radii)
    s = first + (last - first) * (np.arange(count) + 0.5) / count
    edge = np.searchsorted(flank.arc, s) - 1
    shares = lagrange(flank.order, (s - flank.arc[edge]) / np.diff(flank.arc)[edge]) / count
    forces = np.zeros((2, flank.nodes))
    for n, share in enumerate(shares):
        for component in range(2):
            np.add.at(forces[component], edge * flank.order + n, inward[component] * share)
    return forces.reshape(-1, 1)


@pytest.mark.parametrize(("depth", "back"), [(1.4, True), (0.8, True), (0.8, False)])
def test_complementarity_under_loads_on_several_teeth(depth, back):
    """Neither a gap below zero nor a tension at any node, whatever the loads; all of degree one."""
    found, rng = solved(depth, back=back), np.random.default_rng(3)
    compliance = found.face_compliance(0)
    for _ in range(10):
        force = rng.uniform(0.05, 1.0, 3) * rng.choice([1e-6, 1.0, 1e6])
        opening = sum(w * found.opening(0, j, loads(found, j, [14.0])) for j, w in zip((-1, 0, 1), force, strict=True))
        pressure = pressed(compliance, opening)
        gap, size = opening + compliance @ pressure, np.abs(opening).max()
        assert (pressure >= 0.0).all()
        assert (gap >= -1e-11 * size).all()
        assert abs((gap * pressure).sum()) < 1e-10 * size * pressure.max(initial=1e-300)
        assert pressed(compliance, 1e7 * opening) == pytest.approx(1e7 * pressure, rel=1e-9, abs=1e-12 * size)


def test_reciprocity_stays_and_neighbours_are_those_of_an_ordinary_tooth():
    """Couplings of a shut crack are within 2 % of the healthy ones, of an open one up to a third off."""
    healthy, shut, opened = solved(0.0), solved(1.0), solved(1.0, closing=False)
    for i, j in itertools.product(range(-2, 3), repeat=2):
        found = shut.between(i, j, RADII, RADII, PATCH)
        if i != j:
            assert found == pytest.approx(shut.between(j, i, RADII, RADII, PATCH).T, rel=1e-9)
    usual = healthy.between(0, 1, RADII, RADII, PATCH)
    assert np.abs(shut.between(0, 1, RADII, RADII, PATCH) / usual - 1.0).max() < 0.05
    assert np.abs(opened.between(0, 1, RADII, RADII, PATCH) / usual - 1.0).max() > 0.05


def test_two_cracks_that_feel_each_other():
    """Forces at the nodes of both under loads on both teeth: no gap below zero, and other than of each by itself."""
    sector = cracked_sector(TOOTH, BORE, SETTINGS, crack(1.0, back=True, closing=True))
    odd = {number: OddTooth(TOOTH, sector) for number in (0, 1)}
    found = solve_odd_influence(TOOTH, ordinary(), odd, NU, "strain", SETTINGS)
    assert found.faces_compliance == pytest.approx(found.faces_compliance.T, rel=1e-9)
    load = np.array([1.0, 0.7])
    opening = sum(w * found.openings(j, loads(found, j, RADII)) for j, w in enumerate(load))
    forces = found.faces_under({j: (np.array(RADII), np.full(3, w)) for j, w in enumerate(load)}, PATCH)
    gap, size = opening + found.faces_compliance @ forces, np.abs(opening).max()
    assert (forces >= 0.0).all()
    assert (gap >= -1e-11 * size).all()
    for at in found.faces_at.values():
        assert forces[at].any()
        alone = pressed(found.faces_compliance[at, at], opening[at])
        assert 1e-4 < np.abs(alone - forces[at]).max() / forces[at].max() < 0.1
    own, usual = found.by_closing(0, RADII, PATCH), solved(1.0).by_closing(0, RADII, PATCH)
    assert own == pytest.approx(usual, rel=0.05)


@pytest.mark.dear
def test_the_stated_error_is_that_of_closing_faces():
    """No less than the true one, and not that of open faces, which is ten times as large."""
    gear = Gear(TOOTH, 2e-3, BORE * 2e-3, 20e-3, Material(206e9))
    radii, width = np.array([27e-3, 28.2e-3, 29.2e-3]), np.full(3, 1e-4)
    coarse, fine = (solve_gear(gear, settings_at(level), reach=2, estimate_error=level < -2) for level in (-3, -1))
    one, other, free = (
        solve_cracked_gear(known, {0: crack(0.9, back=True, closing=closing)})
        for known, closing in ((coarse, True), (fine, True), (coarse, False))
    )
    stated, true = one.own_error(0, radii, width), np.abs(one.own(0, radii, width) - other.own(0, radii, width))
    assert (stated > true).all()
    assert (stated < 15.0 * true).all()
    assert (stated < 0.5 * free.own_error(0, radii, width)).all()
    assert (one.faces_under(0, {0: (radii, np.ones(3))}) == 1.0).all()


@pytest.mark.dear
def test_stress_intensity_of_closed_faces_gives_back_their_energy():
    """A crack in the back fillet, which its own tooth shuts: no K_I is left, and K_II is that of sliding."""
    radii, step = np.array(RADII), 0.04
    low, found, high = (solved(depth) for depth in (0.5 - step, 0.5, 0.5 + step))
    release = 0.5 * (high.own(0, radii, PATCH) - low.own(0, radii, PATCH)) / (2.0 * step) / (1.0 - NU**2)
    opened = found.by_ring(0, 0, radii, PATCH)
    forces = found.face_forces(0, 0, loads(found, 0, radii))
    both = opened + found.closed_intensity(0, forces)
    assert both[1] == pytest.approx(both[0], abs=2e-3 * np.abs(opened).max())
    k = both[0]
    assert (opened[0, 0] < -1.0).all()
    assert np.abs(k[0]).max() < 0.04
    assert np.abs(k[1]).min() > 0.2
    assert (np.abs((k**2).sum(axis=0) - release) < 2e-3 * (opened[0] ** 2).sum(axis=0)).all()
