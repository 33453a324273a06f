"""Gauges on teeth with a width: which forces, gears, places and errors they are asked of; solutions are made up."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.contact.wide import gauge_on_face
from fegear.contact.wide.gauge_on_face import gauge_about_load, wide_gauge_history, wide_gauge_neglects
from fegear.fem.plane.gauge import Grid
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
