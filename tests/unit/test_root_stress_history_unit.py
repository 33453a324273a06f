"""Root stress of a tooth on its way through the mesh: the largest of the curve along its fillet, between any points."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.plane import tooth_stress as tooth_stresses
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.formula_root_stress import formula_root_stress
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.root_stress import Felt, RootStress
from fegear.contact.plane.root_stress_history import root_stress_history, superposed_stress, touching_radius
from fegear.contact.plane.tooth_stress import ToothStress, _by_each_load, loaded_states, tooth_stress
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

MODULE, WIDTH, LOAD = 3e-3, 0.02, 4000.0


@pytest.fixture(scope="module")
def engagement():
    teeth = [Tooth(z, BasicRack(1.0, 1.25, 0.38)) for z in (21, 34)]
    gears = [Gear(one, MODULE, 0.5 * one.root_radius * MODULE, WIDTH) for one in teeth]
    sources = [finite_element_compliance(solve_gear(one, MeshSettings().scaled(2.0), reach=1)) for one in gears]
    return Engagement(PairCompliance(GearPair(*gears), *sources))


@pytest.mark.parametrize("member", ["driver", "driven"])
@pytest.mark.parametrize("side", ["tension", "compression"])
def test_a_tooth_that_bears_alone_has_the_root_stress_of_its_load(engagement, member, side):
    pair = engagement.pair
    alone = PairCompliance(pair, engagement.compliance.driver, engagement.compliance.driven, coupling=False)
    e = Engagement(alone)
    x = np.linspace(pair.x_end - pair.base_pitch, pair.x_start + pair.base_pitch, 25)[1:-1]
    state = e.solve(e.grid(x), [LOAD])
    history = root_stress_history(e, state, member, side)
    own = int(np.flatnonzero(state.grid.contacts.number == 0)[0])
    assert state.loads[own] == pytest.approx(np.full((x.size, 1), LOAD), rel=1e-12)
    value, _ = e.compliance.source(member).influence.largest_root_stress(0, side, pair.radius(x, member))
    assert history.stress[own, :, 0] == pytest.approx(value * LOAD / WIDTH, rel=1e-9)


@pytest.mark.parametrize("member", ["driver", "driven"])
@pytest.mark.parametrize("side", ["tension", "compression"])
def test_it_is_smooth_over_the_roll_where_a_tooth_bears_alone(engagement, member, side):
    """The place of the largest wanders along the fillet; from point to point of the mesh the curve would have corners.

    Neighbours without load feel this tooth's: theirs is smooth, too.
    """
    pair = engagement.pair
    x = np.linspace(pair.x_end - pair.base_pitch, pair.x_start + pair.base_pitch, 402)[1:-1]
    state = engagement.solve(engagement.grid(x), [LOAD])
    stress = root_stress_history(engagement, state, member, side, 1).stress[:, :, 0]
    feel = stress.any(axis=1)
    assert feel.sum() == 3
    for one in stress[feel]:
        bend = np.diff(one, 2) / np.abs(one).max()
        assert np.abs(np.diff(bend)).max() < 5e-7


@pytest.mark.parametrize("member", ["driver", "driven"])
def test_a_tooth_on_the_path_without_load_has_its_neighbours_stress_as_beyond_the_path(engagement, member):
    """Spaced so far back that it does not touch: no contact hides a part of its fillet, and no jump ends the path."""
    pair = engagement.pair
    e = replace(engagement, driver_spacing=np.array([0.0, 3e-4] * 20))  # every other tooth bears all
    x = pair.x_start + pair.base_pitch * (np.arange(40) + 0.5) / 40
    state = e.solve(e.grid(x), [LOAD])
    history = root_stress_history(e, state, member, "tension", 1)
    idle = np.pad(state.loads[:, :, 0], ((1, 1), (0, 0))) == 0.0
    on_path = np.pad(state.grid.contacts.present, ((1, 1), (0, 0)))
    assert (idle & on_path).sum() > 20
    assert np.isinf(touching_radius(state, member, 1)[:, :, 0][idle]).all()
    assert np.isfinite(touching_radius(state, member, 1)[:, :, 0][~idle]).all()
    roots = RootStress.of(e.compliance, member, "tension")
    for along, found, free in zip(superposed_stress(e, state, member, "tension", 1), history.stress, idle, strict=True):
        if free.any():
            assert found[free, 0] == pytest.approx(roots.largest(0, along[free, 0]), rel=1e-12)


@pytest.mark.dear
@pytest.mark.parametrize("member", ["driver", "driven"])
def test_of_a_tooth_without_load_another_load_changes_what_it_has_at_the_place_of_the_largest(
    engagement, member, monkeypatch
):
    """Elsewhere along its fillet it may have many times as much of the other sign, which does not move the largest.

    Where it passes through zero at that place a part of that counts: the place moves.
    """
    pair = engagement.pair
    x = pair.x_start + pair.base_pitch * (np.arange(11) + 0.5) / 11
    state = engagement.solve(engagement.grid(x), [LOAD])
    off = np.zeros_like(state.loads)
    one = int(np.flatnonzero(state.grid.contacts.number == 0)[0])
    off[one] = 1e-6 * state.loads[one]
    more = replace(state, shared=replace(state.shared, loads=state.loads + off))
    found, again = (root_stress_history(engagement, loaded, member, "tension", 1) for loaded in (state, more))
    stated, _ = _by_each_load(engagement, found, state, off, None)
    monkeypatch.setattr(tooth_stresses, "_OF_LARGEST", 0.0)
    by_load, _ = _by_each_load(engagement, found, state, off, None)
    idle = np.pad(state.loads == 0.0, ((1, 1), (0, 0), (0, 0)), constant_values=True)
    change = np.abs(again.stress - found.stress)[idle]
    assert (change > 0.0).sum() >= 12
    assert by_load[idle] == pytest.approx(change, rel=0.02, abs=1e-3 * change.max())
    assert (stated[idle] >= by_load[idle]).all()
    assert np.median(stated[idle]) < 3.0 * np.median(by_load[idle])


@pytest.mark.dear
def test_largest_compression_and_the_range_of_stress_state_errors_that_finer_gears_confirm():
    """Gears of edges three times as short lie within the stated errors, and these are no blanket."""

    def followed(factor):
        teeth = [Tooth(z, BasicRack(1.0, 1.25, 0.38)) for z in (21, 34)]
        gears = [Gear(one, MODULE, 0.5 * one.root_radius * MODULE, WIDTH) for one in teeth]
        solved = [solve_gear(one, MeshSettings().scaled(factor), reach=1) for one in gears]
        e = Engagement(PairCompliance(GearPair(*gears), *(finite_element_compliance(one) for one in solved)))
        x = e.pair.x_start + e.pair.base_pitch * (np.arange(40) + 0.5) / 40
        states = loaded_states(e, (), [LOAD], x)
        return [tooth_stress(e, states, member) for member in ("driver", "driven")]

    for rough, fine in zip(followed(2.0), followed(0.65), strict=True):
        for name, stated in (("largest_compression", rough.compression_off(0)), ("tension_range", rough.range_off(0))):
            value, true = getattr(rough, name)[0], getattr(fine, name)[0]
            assert abs(value - true) < 1.5 * stated
            assert stated < 0.03 * abs(value)


def test_a_formula_knows_no_compression_and_no_error(engagement):
    x = engagement.pair.x_start + engagement.pair.base_pitch * np.array([0.2, 0.7])
    states = loaded_states(engagement, (), [LOAD], x)
    pair = engagement.pair
    ends = [pair.radius(end, "driver") for end in (pair.x_start, pair.x_end)]
    source = formula_root_stress(pair.driver, "agma-908", *ends)
    found = tooth_stress(engagement, states, "driver", source)
    assert found.compression is found.compression_error is None
    assert found.compression_off(0) is found.range_off(0) is found.largest_pressed(0) is None
    off = tooth_stress(engagement, states, "driver", estimates=False)
    assert off.compression_off(0) is off.range_off(0) is None
    assert off.largest_pressed(0) is not None


def test_what_a_formula_does_not_know_is_neither_largest_nor_least():
    """At the ends of a path a formula may give none: extremes and their errors are those of the rest."""
    tension = np.array([[np.nan, 5.0], [3.0, np.nan], [7.0, 2.0], [1.0, np.nan]])
    error = np.array([[np.nan, 0.5], [0.3, np.nan], [0.7, 0.2], [0.1, np.nan]])
    pressed = np.array([[-4.0, -1.0], [-9.0, -3.0], [-2.0, -8.0], [-1.0, -2.0]])
    found = ToothStress(np.arange(4.0), tension, pressed, error, -0.01 * pressed)
    assert [found.worst(i) for i in (0, 1)] == [2, 0]
    assert [found.error(i) for i in (0, 1)] == [0.7, 0.5]
    assert found.largest_tension.tolist() == [7.0, 5.0]
    assert found.tension_range.tolist() == [6.0, 3.0]
    assert [found.range_off(i) for i in (0, 1)] == pytest.approx([0.8, 0.7])
    assert found.largest_compression.tolist() == [-9.0, -8.0]
    assert [found.largest_pressed(i) for i in (0, 1)] == [1, 2]
    assert [found.compression_off(i) for i in (0, 1)] == pytest.approx([0.09, 0.08])
    assert not found.knows_error
    alone = replace(found, compression=None, compression_error=None, tension_error=np.full((4, 2), np.nan))
    assert (alone.largest_compression, alone.largest_pressed(0), alone.compression_off(0)) == (None, None, None)
    assert (alone.error(0), alone.range_off(1)) == (None, None)


def test_what_loads_may_have_besides_counts_with_the_sign_that_stresses_a_point_more():
    """By hand: -4 to 5 N/mm besides, on points with 2 and -3 per load; one state has the other load, too."""
    known = SimpleNamespace(superposed=lambda _felt, shape: np.full(shape, 10.0))
    felt = [Felt(np.ones(2), np.array([2.0, -3.0])), Felt(np.ones(1), np.array([[1.0, 0.0]]), np.array([1]))]
    low, high = [np.full(2, -4.0), np.zeros(1)], [np.array([5.0, 0.0]), np.full(1, 7.0)]
    assert RootStress.bound(known, felt, low, high, (2, 2)).tolist() == [[20.0, 22.0], [17.0, 22.0]]
    none = [np.zeros(2), np.zeros(1)]
    assert RootStress.bound(known, felt, none, none, (2, 2)).tolist() == [[10.0, 10.0]] * 2
