"""Gauges on teeth with a width: which forces, gears, places and errors they are asked of; solutions are made up."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.contact.error_over_pitch import TransmissionErrorShift
from fegear.contact.wide import gauge_on_face, loaded_pair
from fegear.contact.wide.gauge_on_face import gauge_about_load, wide_gauge_history, wide_gauge_neglects
from fegear.fem.plane.gauge import Grid
from fegear.fem.solid.gauge import grid_on_face, half_up_fillet, lean_at
from fegear.geometry.gear import Material

STEEL, MIDDLE, MODULE, X = Material(200e9, 0.3), 5.0, 2.0, np.array([0.0, 1.0, 2.0, 4.0])
#: What the fine and the coarse gear answer under a unit force: the coarse one at other positions, a tenth higher.
FINE, COARSE = {"tension": 1.0, "compression": -3.0}, {"tension": 1.1, "compression": -3.3}


class Rooted:
    """Stress along the profile, straight over the position, in proportion to the force on the first station."""

    def __init__(self, x, sizes):
        self.x, self.solution, self.sizes = x, self, sizes

    def surface(self, side, force, z):
        z = np.asarray(z)
        along = self.sizes[side] * force[0, 0] * (10.0 + self.x) * (1.0 + 0.1 * z[:, None])
        return np.stack([along[None], 0.0 * along[None], 0.0 * along[None]])


class OnFace:
    """A grid that has the mean of its only point, 1 % more for each metre that it is displaced."""

    def __init__(self, arc, z):
        self.zeta, self.displaced = np.array([z / MODULE]), 1.0 + 0.01 * (arc - MIDDLE)

    def means(self, surface, material, *, plane_strain):
        along = surface[0, 0, 0] * (0.5 if plane_strain else 1.0)
        stress = self.displaced[:, None] * along
        return stress / material.young_modulus, stress


def forces(*sizes):
    found = np.zeros((2, 3, len(sizes)))
    found[0, 0] = sizes
    return found


def lines(*sizes):
    return SimpleNamespace(contact=SimpleNamespace(force=forces(*sizes)))


class Loaded(SimpleNamespace):
    """A pair under 100 and 300 N, the latter nominal."""

    def __init__(self, **changes):
        found = lines(100.0, 300.0)
        found.load = np.array([100.0, 300.0])
        coarse = lines(100.0, 300.0)
        gear = SimpleNamespace(material=STEEL, base_radius=8.0)
        given = {
            "found": found, "error": SimpleNamespace(coarse=coarse), "estimated": True, "missed": (), "at": 1,
            "pair": SimpleNamespace(driver=SimpleNamespace(module=MODULE), gear=lambda member: gear), "gaps": "gaps",
            "flanks": SimpleNamespace(points="points", solve=lambda loads, *_known: lines(*loads)), "known": "known",
            "over": SimpleNamespace(found=found), "nominal": 300.0, "coupling": True, "spec": "spec",
        }  # fmt: skip
        super().__init__(**{**given, **changes})

    def rooted(self, member, found, solution):
        assert member == "driven"
        return Rooted(X if solution == "fine" else X + 0.5, FINE if solution == "fine" else COARSE)


@pytest.fixture(autouse=True)
def made_up(monkeypatch):
    def grid_on_face(solution, side, grid, arc, z, module):
        assert module == MODULE
        return OnFace(arc, z)

    monkeypatch.setattr(gauge_on_face, "grid_on_face", grid_on_face)
    monkeypatch.setattr(
        gauge_on_face, "mesh_stiffness",
        lambda found, points: SimpleNamespace(stations=7.0 * found.contact.force if points == "points" else None),
    )  # fmt: skip


def influence(coarse="coarse", **shares):
    return SimpleNamespace(fine="fine", coarse=coarse, entry_shares=shares, error={"root_tension": 0.05})


def expected(side, force, z=0.0, sizes=FINE, x=X):
    return sizes[side] * force * (10.0 + x) * (1.0 + 0.1 * z) / MODULE**2


SHIFTS = np.array([-1.0, 0.0, 2.0])


def history(side="tension", grid=None, known=None, z=3.0, **changes):
    known = known or influence(root_tension=0.5, root_compression=0.25)
    grid = grid or Grid(1e-3, 1e-3, 0.0)
    return wide_gauge_history(Loaded(**changes), "driven", side, grid, MIDDLE, SHIFTS, z, known)


@pytest.mark.parametrize(("side", "other"), [("tension", "compression"), ("compression", "tension")])
def test_a_gauge_sees_its_own_fillet_under_every_load_and_the_opposite_one_in_the_middle(side, other):
    found = history(side)
    assert found.x is X
    for case, force in enumerate((100.0, 300.0)):
        for n, shift in enumerate(SHIFTS):
            strain = (1.0 + 0.01 * shift) * expected(side, force, 3.0) / STEEL.young_modulus
            assert found.displaced[:, case, n] == pytest.approx(strain)
        assert found.strain[:, case] == pytest.approx(expected(side, force, 3.0) / STEEL.young_modulus)
        assert found.stress[:, case] == pytest.approx(expected(side, force, 3.0))
        assert found.strain_opposite[:, case] == pytest.approx(expected(other, force, 3.0) / STEEL.young_modulus)


@pytest.mark.parametrize("side", ["tension", "compression"])
def test_its_sense_is_that_of_the_fillet_or_the_other_way_where_it_lies_across(side):
    along, across = Grid(1e-3, 1e-3, 0.0), Grid(1e-3, 1e-3, np.pi / 2.0)
    sense = 1.0 if side == "tension" else -1.0
    assert history(side, along).sense == sense
    assert history(side, across).sense == -sense


@pytest.mark.parametrize(("side", "share"), [("tension", 0.5), ("compression", 0.25)])
def test_errors_are_a_share_of_what_the_coarser_gear_changes_at_any_displacement(side, share):
    """And of curves that are straight over the position nothing is missed between."""
    found = history(side)
    inner = X + 0.0
    at = np.clip(inner, 0.5, None)  # the coarser gear's positions begin there
    for case, force in enumerate((100.0, 300.0)):
        change = (
            np.abs(expected(side, force, 3.0, COARSE, at) - expected(side, force, 3.0)) * 1.02
        )  # farthest up the fillet
        assert found.stress_error[:, case] == pytest.approx(share * change, rel=1e-9)
        assert found.known_error[:, case] == pytest.approx(share * change / STEEL.young_modulus, rel=1e-9)


def test_slices_state_a_share_and_do_not_strain_across_the_profile():
    found = history(known=influence(None), missed=(1,))
    assert found.stress[:, 1] == pytest.approx(0.5 * expected("tension", 300.0, 3.0))
    assert found.stress_error == pytest.approx(0.05 * found.stress)
    assert np.isnan(history("compression", known=influence(None)).stress_error).all()  # no share is known
    assert np.isnan(history(estimated=False).stress_error).all()
    assert history(estimated=False).stress_error.shape == (4, 2)


def test_about_a_load_strain_and_its_tangent_are_those_of_its_forces():
    found = gauge_about_load(
        Loaded(), "driven", "tension", Grid(1e-3, 1e-3, 0.0), MIDDLE, SHIFTS, 3.0, influence(root_tension=0.5), 450.0
    )
    for n, shift in enumerate(SHIFTS):
        strain = (1.0 + 0.01 * shift) * expected("tension", 450.0, 3.0) / STEEL.young_modulus
        assert found.strain[:, n] == pytest.approx(strain)
        assert found.slope[:, n] == pytest.approx(7.0 * strain)
    nominal = history()
    assert found.error == pytest.approx(nominal.known_error[:, 1])  # errors are those at the nominal load
    assert found.slope_error == pytest.approx(7.0 * nominal.known_error[:, 1])


def test_what_effects_that_are_off_change_of_the_peak(monkeypatch):
    asked = []
    monkeypatch.setattr(gauge_on_face, "effects_off", lambda spec: ["neighbour_coupling", "shafts", "wrong"])
    twice = {"neighbour_coupling": 330.0, "shafts": 270.0}

    def flanks_with(effect, *given):
        assert given[0] == "spec"
        if effect == "wrong":
            raise InputError("key", "value", "is wrong")
        one = lines(twice[effect])
        one.pair, one.lines, one.name = loaded.pair, "lines", effect
        return one

    def rooted_lines(pair, member, lines_, solution, *, coupling):
        asked.append(coupling)
        assert (pair, member, lines_, solution) == (loaded.pair, "driven", "lines", "fine")
        return Rooted(X, FINE)

    for coupling in (True, False):
        loaded = Loaded(coupling=coupling)
        loaded.over.found.pair, loaded.over.found.lines = loaded.pair, "lines"
        monkeypatch.setattr(gauge_on_face, "flanks_with", flanks_with)
        monkeypatch.setattr(gauge_on_face, "rooted_lines", rooted_lines)
        asked.clear()
        found = wide_gauge_neglects(
            loaded, "driven", "compression", Grid(1e-3, 1e-3, 0.0), MIDDLE, 3.0, influence(root_compression=0.5)
        )
        assert asked == [coupling, True, coupling]
        assert list(found) == ["neighbour_coupling", "shafts"]
        for effect, force in twice.items():
            assert found[effect].change == pytest.approx(force / 300.0 - 1.0)
            assert found[effect].angle == pytest.approx(X / 8.0)
            assert found[effect].strain == pytest.approx(expected("compression", force, 3.0) / STEEL.young_modulus)


# ---- points of a grid ------------------------------------------------------------------------------------------------
class Tooth:
    """A fillet along a line at 2 modules from the centre plane, whose tangent goes up; twisted by `tau`."""

    def __init__(self, tau=0.0):
        arc = np.linspace(0.0125, 0.9875, 40)
        place, tangent = np.stack([np.full(40, 2.0), 8.0 + arc]), np.stack([np.zeros(40), np.ones(40)])
        self.fillet = SimpleNamespace(arc=arc, place=place, tangent=tangent, length=1.0)
        self.fillets, self.tau = {"tension": self.fillet}, tau


@pytest.mark.parametrize("direction", [0.0, 0.4, -0.4, np.pi / 2.0])
@pytest.mark.parametrize("tau", [0.0, 0.05])
def test_the_mean_under_a_grid_is_that_over_its_turned_rectangle(direction, tau):
    """Of stress that is a polynomial of the place: by moments of a rectangle, which leans with the helix."""
    tooth, length, width = Tooth(tau), 0.3 * MODULE, 0.2 * MODULE
    middles, z = np.array([0.45, 0.55]) * MODULE, 1.4 * MODULE
    grid = grid_on_face(tooth, "tension", Grid(length, width, direction), middles, z, MODULE)
    arc = tooth.fillet.arc[:, None]

    def mean(of):
        return grid._mean(of(arc, grid.zeta)[:, :, None])[:, 0]

    # a step along the helix goes (-tau y, tau x, 1): by tau x = 2 tau up the fillet, and by the rest across it
    skew, across = 2.0 * tau, np.sqrt(1.0 + tau**2 * 8.5**2)
    assert lean_at(tooth.fillet, tau, 0.5) == pytest.approx((skew, across), rel=1e-3)
    c, s, (a, b) = np.cos(direction), np.sin(direction), np.array([length, width]) / MODULE
    up, over = (np.array(one) for one in ((c, -s), (s, c)))  # by steps along the grid, and across it
    step = np.stack([up - skew / across * over, over / across])  # up the fillet, and along the face
    second = step @ np.diag([a * a, b * b]) @ step.T / 12.0
    at, zeta = middles / MODULE, z / MODULE
    assert mean(lambda s, z: 1.0 + 0.0 * s * z) == pytest.approx([1.0, 1.0])
    assert mean(lambda s, z: s + 0.0 * z) == pytest.approx(at)
    assert mean(lambda s, z: 0.0 * s + z) == pytest.approx([zeta, zeta])
    assert mean(lambda s, z: s**2 + 0.0 * z) == pytest.approx(at**2 + second[0, 0], rel=1e-5)
    assert mean(lambda s, z: 0.0 * s + z**2) == pytest.approx([zeta**2 + second[1, 1]] * 2, rel=1e-5)
    assert mean(lambda s, z: s * z) == pytest.approx(at * zeta + second[0, 1], rel=1e-5)
    reach = half_up_fillet(Grid(length, width, direction), skew / across)
    assert reach == pytest.approx(0.5 * MODULE * (abs(step[0, 0]) * a + abs(step[0, 1]) * b), rel=1e-3)


def test_a_grid_of_no_size_is_a_point():
    grid = grid_on_face(Tooth(), "tension", Grid(0.0, 0.0, 0.3), np.array([0.5 * MODULE]), 0.0, MODULE)
    assert (grid.zeta.tolist(), grid.weights.shape[:2]) == ([0.0], (1, 1))
    assert grid._mean(Tooth().fillet.arc[:, None, None] ** 3)[0, 0] == pytest.approx(0.125)


# ---- loads for the surface, and what slices miss ---------------------------------------------------------------------
def test_at_edges_the_line_load_is_that_of_the_station_beside_them():
    at_edge = np.array([[True, False, False, True, True, True], [False] * 6])
    lines = SimpleNamespace(
        roll=np.zeros(2), at_edge=at_edge, z=np.tile(np.arange(6.0), (2, 1)),
        at=lambda p: [slice(0, 4), slice(4, 6)] if p == 0 else [slice(0, 6)],
    )  # fmt: skip
    load = np.array([[9.0, 2.0, 3.0, 9.0, 7.0, 8.0], [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]])
    found = SimpleNamespace(lines=lines, line_load=np.stack([0.0 * load, load], axis=2))
    assert loaded_pair._without_edges(found, 1).tolist() == [[2.0, 2.0, 3.0, 3.0, 7.0, 8.0], load[1].tolist()]
    assert found.line_load[0, 0, 1] == 9.0  # what was given stays


def test_places_go_nearly_from_end_to_end_with_the_pitch_point():
    places = loaded_pair._between(-2.0, 3.0, 7)
    assert places.size == 8
    assert 0.0 in places
    assert (np.diff(places) > 0.0).all()
    assert 0.0 < places[0] + 2.0 == pytest.approx(3.0 - places[-1])
    assert places[0] + 2.0 < 0.05
    other = loaded_pair._between(1.0, 3.0, 7)
    assert other.size == 7
    assert np.diff(other) == pytest.approx(np.full(6, other[1] - other[0]))


def test_what_slices_miss_adds_its_share_of_each_answer():
    names = ("mean", "peak_to_peak", "effective", "amplitude", "stiffness")
    shift = TransmissionErrorShift(**dict.fromkeys(names, 1.0))
    te = SimpleNamespace(
        mean=20.0, peak_to_peak=30.0, effective_error=40.0, series=SimpleNamespace(amplitude=np.array([50.0, 60.0])),
        mean_secant=70.0,
    )  # fmt: skip
    found = loaded_pair._missed_too(shift, te, 0.1)
    assert (found.mean, found.peak_to_peak, found.effective, found.stiffness) == pytest.approx((3.0, 4.0, 5.0, 8.0))
    assert found.amplitude == pytest.approx([6.0, 7.0])
