"""What ``fegear check`` compares: places on the flank, numbers, scales; the whole gear's answers are made up."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.case.reading import build_scene
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import solve_gear
from fegear.studies import check

CASE = {
    "results": ["stiffness"],
    "gear": {"a": {"teeth": 15, "module": "3 mm", "face_width": "20 mm", "bore_radius": "9 mm", "profile_shift": 0.3}},
}


@pytest.fixture(scope="module")
def known():
    """A gear on a coarse mesh, with its error estimate."""
    from pathlib import Path

    scene = build_scene(CASE, "case", Path())
    return scene, solve_gear(scene.gears["a"], MeshSettings().scaled(3.0), reach=1)


@pytest.fixture
def checked(known, monkeypatch):
    """Check it against answers of one's own, which are fegear's times a factor, or off by a share of c_self."""
    scene, solved = known
    asked = {}
    monkeypatch.setattr(check, "solve_influence_functions", lambda *given: solved)
    monkeypatch.setattr(check, "compare_solvers", lambda found: ("solvers of", found is solved))

    def checked(positions, factor=1.0, beside=0.0):
        def alone(tooth, bore, poisson, plane, settings, radius, half_width, support):
            asked.update(tooth=tooth, bore=bore, poisson=poisson, plane=plane, settings=settings, radius=radius,
                         half_width=half_width, support=support)  # fmt: skip
            gear, r, b = solved.gear, radius * solved.gear.module, solved.reference_half_width
            modulus, own = gear.material.young_modulus, solved.self_compliance(r, b)
            stress = [solved.largest_root_stress(0, side, r)[0] for side in ("tension", "compression")]
            following, before = (np.diagonal(solved.neighbour(k, r, r)) for k in (1, -1))
            return SimpleNamespace(
                c_self=factor * own * modulus, c_next=(following + beside * own) * modulus,
                c_prev=(before - beside * own) * modulus, root_tension=factor * stress[0] * gear.module,
                root_compression=factor * stress[1] * gear.module, unknowns=4321,
            )  # fmt: skip

        monkeypatch.setattr("fegear.fem.plane.scikit_fem_alone.solve_alone", alone)
        return check.check_gear(scene, "a", positions), asked

    return checked


QUANTITIES = ["c_self", "c_next", "c_prev", "root_tension", "root_compression"]


def test_the_same_numbers_differ_by_nothing_and_are_told_in_the_units_of_the_table(known, checked):
    _, solved = known
    found, asked = checked(2)
    gear = solved.gear
    assert (found.gear, found.unknowns, found.solvers) == ("a", 4321, ("solvers of", True))
    assert [one.quantity for one in found.compared] == [name for name in QUANTITIES for _ in range(2)]
    radii = asked["radius"] * gear.module
    for number, one in enumerate(found.compared):
        assert one.difference == pytest.approx(0.0, abs=1e-12)
        assert one.covered
        assert one.radius == pytest.approx(radii[number % 2] * 1e3)
        assert one.fegear == pytest.approx(one.scikit_fem, rel=1e-12)
        assert one.unit == ("um.mm/N" if one.quantity.startswith("c_") else "MPa.mm/N")
    own = solved.self_compliance(radii, solved.reference_half_width)
    assert [one.fegear for one in found.compared[:2]] == pytest.approx((own * 1e9).tolist())
    error = solved.self_error(radii, solved.reference_half_width)
    assert [one.stated_error for one in found.compared[:2]] == pytest.approx((error / own).tolist())
    following = np.diagonal(solved.neighbour_error(1, radii, radii))
    assert [one.stated_error for one in found.compared[2:4]] == pytest.approx((following / own).tolist())
    tension = solved.largest_root_stress(0, "tension", radii)[0]
    doubt = solved.root_stress_error(0, "tension", radii)
    assert [one.stated_error for one in found.compared[6:8]] == pytest.approx((doubt / np.abs(tension)).tolist())
    assert (found.compared[8].fegear < 0.0) == (solved.largest_root_stress(0, "compression", radii)[0][0] < 0.0)
    assert (asked["bore"], asked["poisson"], asked["plane"]) == (
        pytest.approx(3.0), gear.material.poisson_ratio, gear.plane_assumption,
    )  # fmt: skip
    assert asked["half_width"] == pytest.approx(solved.reference_half_width / gear.module)
    assert asked["settings"] == solved.settings


def test_places_lie_in_the_middle_of_equal_steps_of_the_roll_and_two_half_widths_off_the_ends(known, checked):
    _, solved = known
    _, asked = checked(5)
    gear, flank = solved.gear, solved.fine.flank
    base = gear.base_radius
    rolls = np.sqrt((asked["radius"] * gear.module) ** 2 / base**2 - 1.0)
    first, last = (np.sqrt(max(r, base) ** 2 / base**2 - 1.0) for r in (gear.form_radius, gear.involute_tip_radius))
    even = first + (last - first) * (np.arange(5) + 0.5) / 5.0
    room = 2.0 * solved.reference_half_width / gear.module
    arcs = flank.arc_of_radius(asked["radius"])
    assert arcs.min() >= flank.flank_start + room - 1e-9
    assert arcs.max() <= flank.flank_end - room + 1e-9
    inside = np.isclose(rolls, even, rtol=1e-6)
    assert inside[1:4].all()
    at_ends = np.isclose(arcs, flank.flank_start + room) | np.isclose(arcs, flank.flank_end - room)
    assert (inside | at_ends).all()


def test_on_a_flank_shorter_than_what_is_kept_off_its_ends_all_places_are_in_its_middle(known, checked, monkeypatch):
    monkeypatch.setattr(check, "_ROOM", 1e4)
    flank = known[1].fine.flank
    arcs = flank.arc_of_radius(checked(3)[1]["radius"])
    assert arcs == pytest.approx(0.5 * (flank.flank_start + flank.flank_end) * np.ones(3), rel=1e-9)


def test_on_a_flank_without_room_for_wide_contacts_all_are_in_its_middle(known, checked, monkeypatch):
    _, solved = known
    monkeypatch.setattr(check, "_ROOM", 1e3)
    _, asked = checked(3)
    flank = solved.fine.flank
    assert flank.arc_of_radius(asked["radius"]) == pytest.approx(
        np.full(3, 0.5 * (flank.flank_start + flank.flank_end))
    )


def test_differences_are_relative_and_those_of_neighbours_to_the_tooth_s_own(checked):
    found, _ = checked(1, factor=1.01, beside=0.003)
    off = {one.quantity: one.difference for one in found.compared}
    assert off == {
        "c_self": pytest.approx(0.01), "c_next": pytest.approx(0.003), "c_prev": pytest.approx(0.003),
        "root_tension": pytest.approx(0.01), "root_compression": pytest.approx(0.01),
    }  # fmt: skip
    for one in found.compared:
        assert one.covered == (one.difference <= one.stated_error + 2e-5)
    plain = found.compared[0]
    just = check.Compared("c_self", 1.0, 1.0, 1.0, "", 1e-3 + 1.9e-5, 1e-3)
    assert just.covered
    assert not check.Compared("c_self", 1.0, 1.0, 1.0, "", 1e-3 + 2.1e-5, 1e-3).covered
    assert plain.quantity == "c_self"


def test_both_solvers_are_compared_on_the_gear_s_own_mesh_kind_by_kind(known, monkeypatch):
    _, solved = known
    asked, clock = [], iter([10.0, 10.5, 20.0, 23.0])
    monkeypatch.setattr(check.time, "process_time", lambda: next(clock))

    def solve(tooth, mesh, poisson, plane, *, order, reach, support, solver):
        asked.append((mesh is solved.fine.mesh, order, reach, solver))
        off = 0.0 if len(asked) == 1 else 1.0
        return SimpleNamespace(
            compliance={0: np.array([4.0, 2.0 + 0.02 * off]), 1: np.array([1.0, 0.5 - 0.01 * off])},
            stress={(k, side): np.array([-10.0 * (k + 1), 3.0 + 0.3 * off * (side == "compression")])
                    for k in (0, 1) for side in ("tension", "compression")},
        )  # fmt: skip

    monkeypatch.setattr("fegear.fem.plane.solved_ring.solve_influence", solve)
    found = check.compare_solvers(solved)
    # 0.02 of 4 of compliances, 0.3 of 20 of compressions.
    assert found.difference == pytest.approx(max(0.02 / 4.0, 0.3 / 20.0))
    assert (found.condensed, found.scikit_fem, found.ratio) == (0.5, 3.0, 6.0)
    assert asked == [(True, solved.settings.order, 1, "condensed"), (True, solved.settings.order, 1, "scikit-fem")]


# ---- a rim's support -------------------------------------------------------------------------------------------------
def test_means_that_are_held_are_none_and_their_forces_leave_by_nothing_else():
    from scipy.sparse import csc_array

    from fegear.fem.plane.scikit_fem_alone import _on_average

    random = np.random.default_rng(5)
    own = random.standard_normal((12, 9))
    stiffness = csc_array(own @ own.T)  # three motions are free, which the means hold
    held, loads = random.standard_normal((12, 4)), random.standard_normal((12, 2))
    found = _on_average(stiffness, held, loads)
    np.testing.assert_allclose(held.T @ found, 0.0, atol=1e-9)
    left = stiffness @ found - loads
    np.testing.assert_allclose(left, held @ np.linalg.lstsq(held, left, rcond=None)[0], atol=1e-8)


@pytest.fixture(scope="module")
def whole_ring():
    """A ring of few teeth, meshed coarsely and whole; its outer radius, and both translations of all its unknowns."""
    from fegear.fem.plane.scikit_fem_alone import _Ring, _whole_gear
    from fegear.fem.plane.settings import settings_at
    from fegear.geometry.internal_tooth import InternalTooth, PinionCutter

    tooth = InternalTooth(24, PinionCutter(12, 0.0, 1.2, tip_radius=0.2), profile_shift=0.0, tip_radius=11.5)
    outer = tooth.root_radius + 1.5
    ring = _Ring(_whole_gear(tooth, outer, settings_at(-3).scaled(3.5), []), tooth.side)
    dofs, moved = ring.dofs, np.zeros((2, ring.dofs.N))
    for numbers in (dofs.nodal_dofs, dofs.facet_dofs, dofs.interior_dofs):
        for c in range(2):
            moved[c, numbers[c::2]] = 1.0
    return ring, outer, moved


@pytest.mark.parametrize(("pins", "angle", "width"), [(3, 0.3, 2.0), (5, -1.1, 0.4)])
def test_each_pin_holds_the_mean_of_its_arc_across_and_along(whole_ring, pins, angle, width):
    from fegear.geometry.rim_support import RimSupport

    ring, outer, moved = whole_ring
    held = ring.on_average(RimSupport(pins, width, angle))
    assert held.shape == (moved.shape[1], 2 * pins)
    np.testing.assert_allclose(moved @ held, np.tile(np.eye(2), pins), atol=1e-9)
    # Where it stands: the mean of the place itself, by the same weights on a motion that is the place.
    vertices = ring._grid.p + np.reshape(ring._elements.tip, (2, 1))
    on_circle = np.abs(np.hypot(*vertices) - outer) < 1e-9
    for pin in range(pins):
        at = 0.5 * np.pi - angle - 2.0 * np.pi * pin / pins
        weights = held[ring.dofs.nodal_dofs[0], 2 * pin]
        felt = np.flatnonzero(np.abs(weights) > 1e-12)
        assert on_circle[felt].all()
        off = (np.arctan2(vertices[1, felt], vertices[0, felt]) - at + np.pi) % (2.0 * np.pi) - np.pi
        assert (np.abs(off) < 0.5 * width / outer + 0.5).all()
        assert abs(np.average(off, weights=np.abs(weights[felt]))) < 0.1


def test_a_spline_holds_what_moves_the_whole_circle(whole_ring):
    from fegear.geometry.rim_support import RimSupport

    ring, outer, moved = whole_ring
    held = ring.on_average(RimSupport())
    assert held.shape == (moved.shape[1], 3)
    around = 2.0 * np.pi * outer
    np.testing.assert_allclose(moved @ held[:, :2], around * np.eye(2), atol=1e-3 * around)
    np.testing.assert_allclose(moved @ held[:, 2], 0.0, atol=1e-6 * around * outer)
    vertices = ring._grid.p + np.reshape(ring._elements.tip, (2, 1))
    # A turn is what the third one holds: its sign is that of the turn at every corner of an edge.
    for c, way in ((0, -vertices[1]), (1, vertices[0])):
        weights = held[ring.dofs.nodal_dofs[c], 2]
        felt = np.abs(weights) > 1e-9 * np.abs(held[:, 2]).max()
        assert (np.sign(weights[felt]) == np.sign(way[: weights.size][felt])).mean() > 0.9
