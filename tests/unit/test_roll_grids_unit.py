"""What is kept of a pair at roll positions is what would be evaluated anew, to the last bit."""

import pickle
from dataclasses import dataclass, fields, is_dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.coupled_teeth import PairMatrices
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.loaded_pair import LoadedPair
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.pair_history import followed
from fegear.contact.plane.roll_grids import _KEPT, _STATES, RollGrids
from fegear.contact.plane.root_stress_history import root_stress_history
from fegear.contact.plane.stress_rows import StressRows
from fegear.contact.plane.transmission_error import (
    pair_stiffness,
    quick_points,
    quick_transmission_errors,
    thinned,
    transmission_error,
)
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import CombinedRelief, tip_relief

PAIR = GearPair(*(Gear(Tooth(z, BasicRack(1.0, 1.25, 0.2), 0.0), 2e-3, 4e-3, 1e-2) for z in (21, 34)))


@dataclass(frozen=True)
class Coupled:
    """A closed form with neighbours of its own."""

    base: object
    reach: int = 2

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self.base, name)

    def between(self, i, j, p, q):
        p, q = (p, q) if i <= j else (q, p)  # reciprocity
        return 1e-13 * np.exp(-abs(i - j)) * (1.0 + np.sin(300.0 * p) * np.cos(200.0 * q))

    def root_stress(self, i, j, radius, side):
        sign = 1.0 if side == "tension" else -1.0
        return sign * np.exp(-abs(i - j)) * np.sin(np.arange(1, 6)[:, None] * 400.0 * np.asarray(radius)) ** 2


def compliance(coupling=True, **more):
    return PairCompliance(
        PAIR,
        *(Coupled(closed_form_compliance(PAIR.gear(m), "cornell")) for m in ("driver", "driven")),
        coupling,
        **more,
    )


def same(one, other):
    assert np.array_equal(one.x, other.x)
    parts = [(one.contacts, other.contacts), (one.matrices, other.matrices)]
    while parts:
        part, wanted = parts.pop()
        for field in fields(part):
            a, b = getattr(part, field.name), getattr(wanted, field.name)
            if is_dataclass(a):
                parts.append((a, b))
            else:
                assert np.array_equal(*np.broadcast_arrays(a, b)), field.name


@pytest.mark.parametrize("corners", [False, True])
def test_grids_of_any_positions_in_any_order_are_those_evaluated_anew(corners):
    chance, of = np.random.default_rng(4), compliance()
    kept, anew = RollGrids(of, corners), RollGrids(of, corners)
    start, pitch = PAIR.x_start, PAIR.base_pitch
    pool = np.concatenate([start + pitch * chance.uniform(-1.5, 1.5, 60), [start, start + pitch, start - pitch]])
    for _ in range(40):
        x = chance.choice(pool, chance.integers(1, 50), replace=chance.random() < 0.3)
        fresh = start + pitch * chance.random(chance.integers(0, 4))
        same(kept.at(np.concatenate([x, fresh])), anew.new(np.concatenate([x, fresh])))


def test_a_grid_is_recalled_for_other_loads_and_reliefs_and_not_for_another_pair():
    one = Engagement(compliance(nominal_load=500.0), corner_contact=True)
    x = np.linspace(PAIR.x_start, PAIR.x_start + PAIR.base_pitch, 30)
    grid = one.grid(x)
    relief = CombinedRelief((tip_relief(PAIR.driver, 8e-6, length=0.4e-3),))
    assert replace(one, driver_relief=relief).grid(x) is grid
    assert replace(one, compliance=replace(one.compliance, nominal_load=900.0)).grid(x) is grid
    uncoupled = replace(one, compliance=replace(one.compliance, coupling=False))
    same(uncoupled.grid(x), RollGrids(uncoupled.compliance, True).new(x))
    without = replace(one, corner_contact=False)
    same(without.grid(x), RollGrids(one.compliance, False).new(x))
    linear = replace(one, compliance=replace(one.compliance, hertz="linear"))
    other = replace(linear, compliance=replace(linear.compliance, nominal_load=900.0))
    assert linear.grid(x) is not other.grid(x)
    same(other.grid(x), RollGrids(other.compliance, True).new(x))


def test_what_is_kept_is_bounded_and_does_not_travel():
    grids = RollGrids(compliance(), True)
    empty = len(pickle.dumps(grids))
    for shift in np.linspace(0.0, 0.4, 30):
        grids.at(PAIR.x_start + PAIR.base_pitch * (shift + np.linspace(0.0, 0.5, 40)))
    assert len(grids._kept) < 20
    assert len(pickle.dumps(grids)) == empty


def test_who_is_interrupted_keeps_nothing_half():
    grids, x = RollGrids(compliance(), True), PAIR.x_start + PAIR.base_pitch * np.linspace(0.0, 1.0, 20)
    matrices = PairCompliance.matrices

    def stop(_self, _contacts):
        raise KeyboardInterrupt

    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(PairCompliance, "matrices", stop)
        with pytest.raises(KeyboardInterrupt):
            grids.at(x)
    assert PairCompliance.matrices is matrices
    same(grids.at(x), RollGrids(compliance(), True).new(x))


def test_rows_of_any_contacts_are_those_evaluated_anew_and_are_bounded():
    chance, rows, asked = np.random.default_rng(2), StressRows(), []

    def evaluate(radius):
        asked.append(radius.size)
        return {k: np.sin(np.multiply.outer(radius, np.arange(1.0, 5.0) + k)) for k in (-1, 0, 1)}

    assert rows.at(np.empty(0), evaluate)[0].shape == (0, 4)  # nothing carries load, and then something does
    pool = chance.random(200)
    for _ in range(60):
        radius = np.concatenate([chance.choice(pool, 25), chance.random(chance.integers(0, 3))])
        found = rows.at(radius, evaluate)
        for k in (-1, 0, 1):
            assert np.array_equal(found[k], np.sin(np.multiply.outer(radius, np.arange(1.0, 5.0) + k)))
        assert rows._table.row.size <= 4 * 27 + 27
    assert sum(asked) < 0.9 * 60 * 25
    before = len(asked)
    rows.at(radius[::-1], evaluate)
    assert len(asked) == before


@pytest.mark.parametrize("member", ["driver", "driven"])
@pytest.mark.parametrize("side", ["tension", "compression"])
def test_superposed_stress_is_the_sum_over_every_load_on_every_tooth(member, side):
    e = Engagement(compliance(), corner_contact=True)
    x = PAIR.x_start + PAIR.base_pitch * np.linspace(0.0, 1.0, 13)
    state = e.solve(e.grid(x), [300.0, 3000.0])
    source, n = e.compliance.source(member), state.loads.shape[0]
    radius = state.grid.contacts.radius_driver if member == "driver" else state.grid.contacts.radius_driven
    towards = 1 if member == "driver" else -1
    wanted = np.zeros((n + 2, x.size, 2, 5))
    for tooth in range(-1, n + 1):
        for other in range(n):
            if abs(tooth - other) <= 2:
                kernel = source.root_stress(towards * (tooth - other), 0, radius[other], side)
                wanted[tooth + 1] += np.einsum("ip,pl->pli", kernel, state.loads[other] / 0.01)
    largest = wanted.max(axis=-1) if side == "tension" else wanted.min(axis=-1)
    found = root_stress_history(e, state, member, side, 1)
    assert found.stress == pytest.approx(largest, rel=1e-13)


def test_stress_that_is_not_asked_for_changes_none_that_is():
    e = Engagement(compliance(), corner_contact=True)
    x = PAIR.x_start + PAIR.base_pitch * np.linspace(0.0, 1.0, 13)
    state = e.solve(e.grid(x), [300.0, 3000.0])
    whole = root_stress_history(e, state, "driven", "tension", 1)
    within = PAIR.x_start - PAIR.base_pitch, PAIR.x_end
    part = root_stress_history(e, state, "driven", "tension", 1, within=within).stress
    asked = (whole.x > within[0]) & (whole.x < within[1])
    assert np.array_equal(part[asked], whole.stress[asked])
    assert np.isnan(part[~asked]).all()
    assert not asked.all()


def test_a_transmission_error_in_the_hand_keeps_its_points_and_is_near_that_at_rest():
    e = Engagement(compliance(hertz="load-dependent"), corner_contact=True)
    known = None
    for amount in (2e-6, 5e-6, 9e-6):
        relieved = replace(e, driver_relief=tip_relief(PAIR.driver, amount, length=0.6e-3))
        loads = (300.0, 3000.0)
        for load, moving in zip(loads, quick_transmission_errors(relieved, loads), strict=True):
            (alone,) = quick_transmission_errors(relieved, (load,))
            assert alone.values == pytest.approx(moving.values, rel=1e-13)
            assert alone.average_stiffness == pytest.approx(moving.average_stiffness, rel=1e-13)
            assert alone.series.amplitude == pytest.approx(moving.series.amplitude, rel=1e-11, abs=1e-16)
            rest = transmission_error(relieved, load)
            assert known is None or moving.loaded.grid is known
            known = moving.loaded.grid
            assert moving.mean == pytest.approx(rest.mean, rel=1e-4)
            assert moving.peak_to_peak == pytest.approx(rest.peak_to_peak, rel=1e-2)
            assert rest.loaded.grid is not known  # contact changes between the geometric jumps, so the two differ


def loaded_pair(corner_contact=True, exact=False):
    relief = tip_relief(PAIR.driver, 5e-6, length=0.6e-3)
    e = Engagement(compliance(hertz="load-dependent"), relief, corner_contact=corner_contact)
    return LoadedPair(e, (), SimpleNamespace(loads=(300.0, 3000.0), nominal=3000.0), ("a", "b"), exact=exact)


@pytest.mark.parametrize("corner_contact", [True, False])
def test_while_a_value_moves_a_pair_is_followed_by_the_state_of_its_transmission_error(corner_contact, monkeypatch):
    pair, counted = loaded_pair(corner_contact), []
    e, share = pair.engagement, PairMatrices.share
    monkeypatch.setattr(PairMatrices, "share", lambda *given: counted.append(1) or share(*given))
    found, error = pair.history().found, pair.transmission_error()
    assert len(counted) == 2  # as it is, and perfect flanks
    again, _ = followed(replace(e, grids=None), pair.loads, found.x)
    assert (np.diff(found.x) >= 0.0).all()
    inside = slice(1, -1)  # at the ends a pair may stand in the base pitch before or behind
    for one in fields(found):
        scale = np.abs(getattr(again, one.name)).max()
        np.testing.assert_allclose(
            getattr(found, one.name)[inside], getattr(again, one.name)[inside], atol=1e-9 * scale
        )
    rest = loaded_pair(corner_contact, exact=True)
    at_rest = rest.transmission_error()
    np.testing.assert_allclose(error.te_mean, at_rest.te_mean, rtol=1e-4)
    np.testing.assert_allclose(error.te_peak_to_peak, at_rest.te_peak_to_peak, rtol=3e-3)
    assert pair.history().largest_share == pytest.approx(rest.history().largest_share, rel=5e-3)
    assert error.mesh_compliance_mean == pytest.approx(at_rest.mesh_compliance_mean, rel=1e-5)


def test_a_state_at_some_positions_is_what_would_be_solved_there():
    e = Engagement(compliance(hertz="load-dependent"), tip_relief(PAIR.driver, 5e-6, length=0.6e-3))
    points = quick_points(e)
    which = thinned(points)
    assert set(np.flatnonzero(points.weights == 0.0)) <= set(which)
    assert which.size < 0.6 * points.x.size
    part = e.solve(e.grid(points.x), (300.0, 3000.0)).at(which)
    anew = replace(e, grids=None)
    there = anew.solve(anew.grid(points.x[which]), (300.0, 3000.0))
    for one in ("x", "pair_x", "loads", "transmission_error", "deflection", "local_stiffness"):
        np.testing.assert_allclose(getattr(part, one), getattr(there, one), rtol=1e-12, atol=1e-18)


def test_perfect_flanks_are_loaded_once_while_a_relief_moves(monkeypatch):
    one, counted = Engagement(compliance()), []
    share = PairMatrices.share
    monkeypatch.setattr(PairMatrices, "share", lambda *given: counted.append(1) or share(*given))
    for amount in (3e-6, 5e-6, 8e-6):
        moved = replace(one, driver_relief=CombinedRelief((tip_relief(PAIR.driver, amount, length=0.4e-3),)))
        quick_transmission_errors(moved, (400.0,))
        found = pair_stiffness(moved, 400.0)
        assert np.array_equal(found.pair, pair_stiffness(replace(moved, grids=None), 400.0).pair)
    assert len(counted) == 3 + 1 + 3  # each relief, perfect flanks, and these anew each time
    grid = one.grid(found.points.x)
    for load in np.geomspace(1.0, 1e3, 40):
        one.solve(grid, load)
    assert len(one.grids._shared) <= _KEPT * _STATES
