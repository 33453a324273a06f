"""Parts of fillets, gauges, bores, webs and ends of the program that only costly runs reach: laws by hand."""

import math
import threading
import time
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base import ending
from fegear.contact.wide.load_sharing import _as_beside
from fegear.contact.wide.roots_about_load import RootsAboutLoad, roots_about_load
from fegear.fem.plane.boundary import SHORTEST_BORE_EDGE, finer_bore, sector_boundary
from fegear.fem.plane.odd.crack import mouth_at_tangent, straight_crack
from fegear.fem.plane.odd.keyway import Keyway
from fegear.fem.plane.odd.odd_solution import solve_cracked_gear
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.fem.solid.fillet import SolidFillet
from fegear.fem.solid.gauge import GridOnFace
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.rack import BasicRack
from fegear.geometry.rim_support import RimSupport

SETTINGS = settings_at(-6)
MODULE, TOOTH = 2e-3, Tooth(19, BasicRack(), profile_shift=0.2)
STEEL = Material(206e9, 0.3)


def gear(bore, plane="strain", support=None):
    return Gear(TOOTH, MODULE, MODULE * bore, 20e-3, STEEL, plane, support=support)


# ---- fillets of 3D teeth ---------------------------------------------------------------------------------------------
def fillet(mouth=math.nan, length=1.0):
    arc = np.linspace(0.0125, length - 0.0125, 40)
    nothing = np.zeros((2, 40))
    return SolidFillet(np.zeros(0, int), nothing, nothing, nothing, nothing, arc, np.zeros(40), length, mouth)


def hill(at):
    return lambda arc: 5.0 - 20.0 * (arc - at) ** 2


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("mouth", [math.nan, 0.5])
def test_the_largest_of_a_fillet_is_found_on_either_side_of_a_mouth(mouth, sign):
    one = fillet(mouth)
    stress = sign * np.stack([hill(0.2)(one.arc), hill(0.8)(one.arc) + 1.0], axis=1)
    value, place = one.largest(stress, sign, np.ones(2))
    assert value == pytest.approx(sign * np.array([5.0, 6.0]), rel=1e-9)
    assert place == pytest.approx([0.2, 0.8], abs=1e-6)
    # up to where it is looked for: the slope ends there, before the mouth and beyond it
    for end in (0.3, 0.7):
        value, place = one.largest(stress[:, 1:], sign, np.array([end]))
        assert place == pytest.approx([end], abs=1e-9)
        assert value == pytest.approx([sign * (hill(0.8)(end) + 1.0)], rel=1e-9)


def test_the_first_and_the_last_points_of_both_pieces_count():
    """A curve of fifth degree that is largest at an end of a piece, whose points there decide where it goes."""
    cut = fillet(0.5)
    for end in (0.0, 0.5, 1.0):
        rise = 1.0 if end else -1.0
        stress = np.where((cut.arc < 0.5) == (end < 0.75), rise * (cut.arc - end) * 3.0 + 7.0, -9.0)[:, None]
        stress[np.abs(cut.arc - end).argmin()] += 2.0
        value, place = cut.largest(stress, 1.0, np.ones(1))
        assert value[0] > 7.5
        assert place[0] == pytest.approx(end, abs=0.02)


def test_a_mouth_parts_the_fillet_and_no_curve_goes_through_it():
    """Stress jumps at the mouth: each side keeps its own largest value, of whatever sign."""
    cut = fillet(0.5)
    below = cut.arc < 0.5
    stress = np.stack([np.where(below, 3.0 * cut.arc, -4.0), np.where(below, -4.0, 3.0 - 2.0 * cut.arc)], axis=1)
    value, place = cut.largest(stress, 1.0, np.ones(2))
    assert value == pytest.approx([1.5, 2.0], rel=1e-9)
    assert place == pytest.approx([0.5, 0.5], abs=1e-9)
    value, place = cut.largest(stress, -1.0, np.array([1.0, 0.45]))
    assert value == pytest.approx([-4.0, -4.0])
    assert place[0] >= 0.5 > place[1]


# ---- strain under grids ----------------------------------------------------------------------------------------------
@pytest.mark.parametrize("direction", [0.0, 0.5, -0.5, math.pi / 2.0])
def test_strain_in_a_direction_is_that_of_hooke_and_of_mohr(direction):
    """Against the tensor: strain of plane stress turned into the direction; in plane strain what is left of it."""
    rng, e, nu = np.random.default_rng(1), STEEL.young_modulus, STEEL.poisson_ratio
    surface = rng.normal(size=(3, 4, 2, 5)) * 1e8  # points, places, teeth
    at, weights = np.array([0, 1, 1]), rng.uniform(size=(2, 3, 4))
    grid = GridOnFace(SimpleNamespace(), direction, np.array([-1.0, 1.0]), at, weights)
    strain, stress = grid.means(surface, STEEL, plane_strain=False)
    way = np.array([math.cos(direction), math.sin(direction)])
    compliance = np.array([[1.0, -nu, 0.0], [-nu, 1.0, 0.0], [0.0, 0.0, 1.0 + nu]]) / e
    tensor = np.einsum("ij,jpqt->ipqt", compliance, surface)
    along = way[0] ** 2 * tensor[0] + way[1] ** 2 * tensor[1] + 2.0 * way[0] * way[1] * tensor[2]
    expected, mean = (
        np.array([[sum(weights[g, q, p] * of[p, at[q], t] for q in range(3) for p in range(4)) for t in range(5)]
                  for g in range(2)]) for of in (along, surface[0])
    )  # fmt: skip
    assert strain == pytest.approx(expected)
    assert stress == pytest.approx(mean)
    flat, same = grid.means(surface, STEEL, plane_strain=True)
    assert same == pytest.approx(mean)
    (profile, _), (own, _) = (
        GridOnFace(SimpleNamespace(), turn, np.array([-1.0, 1.0]), at, weights).means(surface, STEEL, plane_strain=True)
        for turn in (0.0, direction)
    )
    assert own == pytest.approx(way[0] ** 2 * profile, abs=1e-15)
    # across the profile nothing strains: what is needed for it is nu times the stress along
    held = np.stack([surface[0], nu * surface[0], 0.0 * surface[2]])
    by_hand = grid.means(held, STEEL, plane_strain=False)[0]
    across = grid.means(np.stack([held[1], held[0], held[2]]), STEEL, plane_strain=False)[0]
    if direction == 0.0:
        assert flat == pytest.approx(by_hand)
    elif direction == math.pi / 2.0:
        assert flat == pytest.approx(np.zeros((2, 5)), abs=1e-15)
        assert across == pytest.approx(mean * (1.0 - nu**2) / e)


# ---- bores -----------------------------------------------------------------------------------------------------------
@pytest.mark.parametrize("share", [0.2, 0.5])
def test_edges_along_a_bore_are_halved_near_points_and_stay_on_it(share):
    chains = sector_boundary(TOOTH, 6.0, SETTINGS)
    (bore,) = [one for one in chains if one.name == "bore"]
    points = np.array([[0.3, -0.9], [6.1, 6.5]])
    found = finer_bore(bore, points, share)
    assert found.name == "bore"
    for places in (found.vertices, found.middles):
        assert np.hypot(*places) == pytest.approx(np.full(places.shape[1], 6.0), rel=1e-12)
    middle = 0.5 * (found.vertices[:, 1:] + found.vertices[:, :-1])
    assert np.hypot(*(found.middles - 6.0 * middle / np.hypot(*middle))) == pytest.approx(
        np.zeros(middle.shape[1]), abs=1e-9
    )
    assert np.hypot(*found.tangents) == pytest.approx(np.ones(found.vertices.shape[1]))
    assert (found.tangents * found.vertices).sum(axis=0) == pytest.approx(np.zeros(found.vertices.shape[1]), abs=1e-9)
    length = np.hypot(*np.diff(found.vertices))
    away = np.hypot(*(found.middles[:, :, None] - points[:, None])).min(axis=1)
    assert (length <= share * np.maximum(away, SHORTEST_BORE_EDGE)).all()
    assert length.size > bore.middles.shape[1]
    # no finer than is needed: each edge is one of the bore's, or its like of twice the length was too long
    known = {tuple(one) for one in bore.vertices.T.tolist()}
    assert known <= {tuple(one) for one in found.vertices.T.tolist()}
    assert (length > 0.2 * share * np.minimum(away, length.max())).all()
    far = finer_bore(bore, np.array([[0.0], [60.0]]), share)
    assert np.array_equal(far.vertices, bore.vertices)
    assert np.array_equal(far.middles, bore.middles)


# ---- webs ------------------------------------------------------------------------------------------------------------
RADII = MODULE * np.array([9.3, 9.8, 10.3])


@pytest.mark.dear
def test_a_web_as_thick_as_the_face_is_the_solid_body():
    """Of plane stress, fixed where the web is; a thin one gives way, by either solver alike."""
    width = np.full(3, 1e-4)
    solid = solve_gear(gear(4.0, "stress"), SETTINGS, reach=1)

    def on_web(share, solver="condensed"):
        support = RimSupport(web=share, inner_radius=MODULE * 4.0)
        return solve_gear(gear(7.3, "stress", support), replace(SETTINGS, solver=solver), reach=1)

    whole, thin, other = on_web(1.0), on_web(0.2), on_web(0.2, "scikit-fem")
    usual = solid.self_compliance(RADII, width)
    assert whole.self_compliance(RADII, width) == pytest.approx(usual, rel=2e-3)
    assert whole.neighbour(1, RADII, RADII) == pytest.approx(solid.neighbour(1, RADII, RADII), rel=2e-2)
    assert (thin.self_compliance(RADII, width) > 1.02 * usual).all()
    assert other.self_compliance(RADII, width) == pytest.approx(thin.self_compliance(RADII, width), rel=1e-8)
    assert other.fine.lower.compliance[1] == pytest.approx(thin.fine.lower.compliance[1], rel=1e-6, abs=1e-8)


# ---- seconds ---------------------------------------------------------------------------------------------------------
def within(seconds, passed):
    """Parts of the time that passed: none is negative, and none begins with the clock's own zero."""
    assert seconds
    assert all(0.0 <= one <= passed for one in seconds.values())


def test_seconds_that_solutions_state_are_parts_of_the_time_that_passed():
    started = time.perf_counter()
    mouth = mouth_at_tangent(TOOTH, math.radians(30.0))
    crack = straight_crack(TOOTH, mouth, math.radians(70.0), depth=0.4)
    plain = solve_gear(gear(6.0), SETTINGS, reach=1)
    free = solve_gear(gear(7.3, support=RimSupport(free_teeth=3)), SETTINGS, reach=1)
    odd = [solve_cracked_gear(plain, {0: one}) for one in (crack, Keyway(2.0, 1.0))]
    passed = time.perf_counter() - started
    for one in (plain, free, *odd):
        within(one.seconds, passed)
        within(one.fine.seconds, passed)
        within(one.fine.lower.seconds, passed)
        known = one.seconds
        assert known["total"] >= known["ring"] + known["condensation"] > 0.0
    keyed = odd[1].fine.seconds["mesh"]
    assert keyed > plain.fine.mesh.seconds > 0.0


# ---- stress about a load ---------------------------------------------------------------------------------------------
def about_load():
    """Straight over the position at every place: interpolation is exact."""
    one = fillet()
    x, z = np.array([-3.0, -1.0, 0.0, 2.0]), np.array([-5.0, 5.0])
    shape = hill(0.4)(one.arc)[:, None, None] * np.array([1.0, 1.2])[None, :, None]
    stress, slope = shape * (10.0 + x), shape * (2.0 - x)
    end = np.array([[1.0, 0.8, 0.3, 1.0], [1.0, 1.0, 1.0, 0.1]])
    return RootsAboutLoad(x, z, stress, slope, end, 0.1 + 0.01 * x, one)


def test_between_positions_stress_goes_straight_and_is_looked_for_up_to_the_lower_end():
    known = about_load()
    found = known.at(np.array([-3.0, -2.0, -0.5, 0.0, 1.95, 9.0, -9.0]))
    kept = np.array([-3.0, -2.0, -0.5, 0.0, 1.95, 2.0, -3.0])
    assert found.stress[7, 1] == pytest.approx(known.stress[7, 1, 0] * (10.0 + kept) / 7.0)
    assert found.slope[7, 0] == pytest.approx(known.slope[7, 0, 0] * (2.0 - kept) / 5.0)
    assert found.share == pytest.approx(0.1 + 0.01 * kept)
    assert found.end[0].tolist() == [1.0, 0.8, 0.3, 0.3, 0.3, 1.0, 1.0]
    assert found.end[1].tolist() == [1.0, 1.0, 1.0, 1.0, 0.1, 0.1, 1.0]
    assert found.x.tolist() == [-3.0, -2.0, -0.5, 0.0, 1.95, 9.0, -9.0]
    back = known.at(np.array([2.0, -1.5]), mirrored=True)
    assert back.x.tolist() == [2.0, -1.5]
    assert back.stress == pytest.approx(known.at(np.array([-2.0, 1.5])).stress)


def test_more_transmission_error_adds_its_stress_at_every_place():
    known = about_load()
    found = known.largest(np.array([0.0, 0.5, 0.0, 100.0]))
    # second place: 1.2 times as much, but where a contact ends it at 0.1
    by_hand = 6.0 * np.array([7.0, 9.0 + 0.5 * 3.0, 10.0])
    assert found.tension[:3] == pytest.approx(by_hand, rel=1e-9)
    assert found.z[:3].tolist() == [5.0, 5.0, 5.0]
    assert (found.tension[3], found.z[3]) == (pytest.approx(5.0 * 12.0), -5.0)
    assert known.largest(np.zeros(4)).tension == pytest.approx([42.0, 54.0, 60.0, 60.0])


@pytest.mark.parametrize("estimated", [True, False])
def test_stress_about_a_load_is_by_its_forces_and_their_change_over_the_teeth_s_approach(estimated, monkeypatch):
    force, more = np.full((2, 3, 1), 7.0), np.full((2, 3, 1), 11.0)
    asked, one = {}, fillet()
    x = np.array([0.0, 1.0])
    rooted = SimpleNamespace(
        x=x, surface=lambda side, by, z: np.stack([np.full((40, 2, 2), by[0, 0]), np.zeros((40, 2, 2))]),
        ends=lambda side: SimpleNamespace(at=lambda zeta, by: (side, zeta.tolist(), by[0, 0])),
        solution=SimpleNamespace(fillets={"tension": one}),
    )  # fmt: skip
    about = SimpleNamespace(contact=SimpleNamespace(force=force))

    class Flanks(SimpleNamespace):
        def __replace__(self, **changes):
            return Flanks(**{**vars(self), **changes})

    def solve(loads, gaps, known):
        asked.update(loads=loads, gaps=gaps, known=known)
        return about

    many = SimpleNamespace(lines=SimpleNamespace(roll=np.zeros(9)), known="known")
    errors = SimpleNamespace(
        largest_tension=np.array([0.0, 50.0]), x=np.array([-1.0, 1.0]),
        tension_error=np.array([[9.0, -12.0], [9.0, 20.0]]),
        error=lambda case: 5.0 if case == 1 else None,
    )  # fmt: skip
    loaded = SimpleNamespace(
        over=SimpleNamespace(found=many, points="points"), places_along=np.array([-4.0, 4.0]), at=1, gaps="gaps",
        pair=SimpleNamespace(driver=SimpleNamespace(module=2.0)), flanks=Flanks(solve=solve), estimated=estimated,
        rooted=lambda member, found, solution: rooted if (member, found, solution) == ("driven", about, "fine") else 0,
        tooth_stress=lambda member, influence: errors if (member, influence.fine) == ("driven", "fine") else 0,
    )  # fmt: skip
    place = "fegear.contact.wide.roots_about_load"
    monkeypatch.setattr(f"{place}.replace", lambda flanks, **changes: asked.update(changes) or flanks)
    monkeypatch.setattr(
        f"{place}.mesh_stiffness",
        lambda found, points: SimpleNamespace(stations=more) if (found, points) == (about, "points") else 0,
    )
    found = roots_about_load(loaded, "driven", SimpleNamespace(fine="fine"), 800.0)
    assert asked == {"positions": 9, "loads": [800.0], "gaps": "gaps", "known": "known"}
    assert (found.stress == 7.0 / 4.0).all()
    assert (found.slope == 11.0 / 4.0).all()
    assert found.end == ("tension", [-2.0, 2.0], 7.0)
    assert found.fillet is one
    assert found.x is x
    assert found.z.tolist() == [-4.0, 4.0]
    if estimated:
        assert found.share.tolist() == [0.1, 0.4]  # no less than that of the largest
    else:
        assert np.isnan(found.share).all()


# ---- gaps where flanks are missing -----------------------------------------------------------------------------------
def test_gaps_of_missing_flanks_are_those_of_the_nearest_stations():
    there = np.array([[False, True, True, False, False], [True] * 5])
    present = np.array([[True, True, True, True, False], [True] * 5])
    gap = np.array([[9.0, 1.0, 2.0, 9.0, 9.0], [1.0, 2.0, 3.0, 4.0, 5.0]])
    assert _as_beside(there, present, gap).tolist() == [[1.0, 1.0, 2.0, 2.0, 9.0], gap[1].tolist()]
    assert gap[0, 0] == 9.0  # what was given stays


# ---- the end of the program ------------------------------------------------------------------------------------------
@pytest.fixture
def leaving(monkeypatch):
    """What is registered for the end, and the code that the process would end with where a daemon thread is left."""
    registered, codes, flushed = [], [], []
    monkeypatch.setattr(ending.atexit, "register", registered.append)
    monkeypatch.setattr(ending.os, "_exit", codes.append)
    for name in ("stdout", "stderr"):
        stream = SimpleNamespace(flush=lambda name=name: flushed.append(name))
        monkeypatch.setattr(ending, "sys", SimpleNamespace(**{**vars(ending.sys), name: stream}))

    def end(threads):
        monkeypatch.setattr(ending.threading, "enumerate", lambda: [threading.current_thread(), *threads])
        (last,) = registered
        codes.clear()
        flushed.clear()
        last()
        return codes[:], flushed[:]

    return end


@pytest.mark.parametrize(
    ("left_with", "code"),
    [(None, 0), (SystemExit(), 0), (SystemExit(7), 7), (SystemExit("word"), 1), (KeyboardInterrupt(), 130),
     (ValueError(), 1)],
)  # fmt: skip
def test_the_process_ends_with_the_code_of_what_it_was_left_with(leaving, left_with, code):
    def work():
        with ending.leaving_with():
            if left_with is not None:
                raise left_with

    if left_with is None:
        work()
    else:
        with pytest.raises(type(left_with)):
            work()
    daemon, other = SimpleNamespace(daemon=True), SimpleNamespace(daemon=False)
    assert leaving([other, daemon]) == ([code], ["stdout", "stderr"])
    assert leaving([other]) == ([], [])  # threads that are waited for end by themselves
    assert leaving([]) == ([], [])
