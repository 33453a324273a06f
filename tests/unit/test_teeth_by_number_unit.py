"""A tooth has a number: a made-up gear of odd teeth goes through load sharing over a turn, like ones are kept once."""

from __future__ import annotations

import math
from dataclasses import dataclass, field, replace
from itertools import product

import numpy as np
import pytest
from smooth_tooth import SmoothTooth

from fegear.base.errors import InputError
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement, solve_again
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.pair_history import pair_history
from fegear.contact.plane.root_stress_history import root_stress_history
from fegear.contact.plane.shifted_compliance import ShiftedCompliance
from fegear.contact.plane.tooth_stress import loaded_states, tooth_stress
from fegear.contact.plane.tooth_table import light
from fegear.contact.plane.transmission_error import revolution
from fegear.design.root_stress_loading import design_stress
from fegear.dynamics.train.mesh_excitation import mesh_excitation
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.rack import BasicRack

Z = 11, 13
PAIR = GearPair(*(Gear(Tooth(z, BasicRack(1.0, 1.25, 0.2), 0.3), 2e-3, 4e-3, 1e-2) for z in Z))
LOAD = 900.0
#: How much softer teeth are than the others: 0 twice, and the one toward the load a little, so that sides count.
SOFTER = {0: 2.0, 1: 1.3}


@dataclass(frozen=True)
class Odd:
    """Teeth like those of a source, but some: what a ring with a cracked tooth answers."""

    base: object
    teeth: int
    softer: dict = field(default_factory=lambda: SOFTER)

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self.base, name)

    @property
    def period(self):
        return self.teeth

    def same_as(self, first, count):
        window = {(first + n) % self.teeth for n in range(count)}
        return first % self.teeth if window & self.softer.keys() else max(self.softer, default=-1) + 1

    def _by(self, i):
        return self.softer.get(i % self.teeth, 1.0)

    def own(self, i, radius):
        return self._by(i) * self.base.own(i, radius)

    def between(self, i, j, p, q):
        return math.sqrt(self._by(i) * self._by(j)) * self.base.between(i, j, p, q)

    def fillet_curve(self, i, side):
        return None

    def root_stress(self, i, j, radius, side):
        points = 5 if self._by(i) == 1.0 else 8  # another mesh
        waves = np.sin(np.arange(1, points + 1)[:, None] * 400.0 * np.asarray(radius)) ** 2
        return (1.0 if side == "tension" else -1.0) * 0.3 ** abs(i - j) * self._by(i) * (1.0 + waves)

    def root_stress_error(self, i, j, radius, side="tension"):
        return 0.01 * self._by(i) * np.ones(np.shape(radius))


def engagement(odd=(), coupling=True, hertz="load-dependent", **more):
    sources = [SmoothTooth(PAIR.gear(m)) for m in MEMBERS]
    made = [Odd(s, z) if m in odd else s for s, z, m in zip(sources, Z, MEMBERS, strict=True)]
    return Engagement(PairCompliance(PAIR, *made, coupling, hertz), **more)


X = PAIR.x_start + PAIR.base_pitch * (np.arange(23) + 0.37) / 23


def by_hand(e, x, cycle, load=LOAD):
    """Loads and approach by trying every set of pairs, c_ij of the teeth as the order of meshing numbers them."""
    c, pair = e.compliance, e.pair
    numbers = [j for j in range(-1, 4) if pair.x_start <= x + j * pair.base_pitch <= pair.x_end]
    places = [x + j * pair.base_pitch for j in numbers]
    radii = {m: [float(pair.radius(at, m)) for at in places] for m in MEMBERS}
    # pair j is on the teeth that come into mesh as number cycle - j; a driver's run against its numbers
    teeth = {"driver": [-(cycle - j) for j in numbers], "driven": [cycle - j for j in numbers]}
    n = len(numbers)
    matrix = np.zeros((n, n))
    for m in MEMBERS:
        source = c.source(m)
        for i, j in product(range(n), repeat=2):
            if i == j:
                rho = np.prod([float(pair.flank_curvature_radius(places[i], m)) for m in MEMBERS])
                rho /= sum(float(pair.flank_curvature_radius(places[i], m)) for m in MEMBERS)
                b = float(c.half_width(np.array(1.0), np.array(rho)))
                at = np.array(radii[m][i])
                matrix[i, i] += float(source.own(teeth[m][i], at))
                matrix[i, i] += source.log_slope * math.log(float(source.reference_half_width(at)) / b)
            elif c.coupling:
                matrix[i, j] += float(source.between(teeth[m][i], teeth[m][j], radii[m][i], radii[m][j]))
    matrix /= c.face_width
    slope = c.log_slope
    for on in sorted(product((True, False), repeat=n), key=sum, reverse=True):
        rows = [i for i in range(n) if on[i]]
        if not rows:
            continue
        w = np.full(len(rows), load / len(rows))
        for _ in range(60):
            secant = matrix[np.ix_(rows, rows)] - 0.5 * slope * np.diag(np.log(np.maximum(w, 1e-30)))
            per = np.linalg.solve(secant, np.ones(len(rows)))
            w = np.maximum(load * per / per.sum(), 1e-12)
        if (per > 0.0).all():
            return dict(zip([numbers[i] for i in rows], w, strict=True)), load / per.sum()
    raise AssertionError


@pytest.mark.parametrize("odd", [("driver",), ("driven",), MEMBERS], ids="+".join)
@pytest.mark.parametrize("coupling", [True, False])
def test_each_base_pitch_shares_the_load_by_the_teeth_that_are_in_it(odd, coupling):
    e = engagement(odd, coupling)
    assert e.cycles == math.prod(z for z, m in zip(Z, MEMBERS, strict=True) if m in odd)
    grid = e.grid(X)
    for cycle in (0, 1, -1, 60, e.cycles + 2):
        state = e.solve(grid, [LOAD], cycle)
        for at in (1, 12):
            loads, approach = by_hand(e, float(X[at]), cycle)
            assert state.transmission_error[at, 0] == pytest.approx(approach, rel=1e-9)
            for row, number in enumerate(state.grid.contacts.number):
                assert state.loads[row, at, 0] == pytest.approx(loads.get(int(number), 0.0), rel=1e-9, abs=1e-9 * LOAD)


@pytest.mark.parametrize("member", MEMBERS)
def test_odd_teeth_show_where_they_are_in_contact_and_nowhere_else(member):
    e, even = engagement((member,)), engagement()
    ordinary = even.solve(even.grid(X), [LOAD])
    count = e.cycles
    different = {}
    for cycle in range(count):
        state = e.solve(e.grid(X), [LOAD], cycle)
        apart = state.transmission_error[:, 0] != ordinary.transmission_error[:, 0]
        step = 1 if member == "driver" else -1
        touching = np.zeros(X.size, dtype=bool)
        for row, number in enumerate(state.grid.contacts.number):
            if step * (int(number) - cycle) % count in SOFTER:
                touching |= state.grid.contacts.present[row]
        assert np.array_equal(apart, touching)  # to the last bit where none is in contact
        different[cycle] = bool(apart.any())
    # the softer tooth passes two base pitches, and so does the one ahead of a driver's, or behind a driven gear's
    wanted = {0, 1, count - 1} if member == "driver" else {0, 1, 2}
    assert {cycle for cycle, odd in different.items() if odd} == wanted
    assert len(e.grid(X).others) <= len(wanted)


@pytest.mark.parametrize("member", MEMBERS)
def test_teeth_are_numbered_as_spacing_errors_are(member):
    """One that is far back by its spacing error, and one that is very soft, carry nothing in the same base pitch."""
    z = Z[MEMBERS.index(member)]
    for meshes_as in (0, 1, 4):
        errors = np.zeros(z)
        errors[meshes_as] = 1e-3
        back = replace(engagement(), **{f"{member}_spacing": errors})
        number = -meshes_as % z if member == "driver" else meshes_as
        source = Odd(SmoothTooth(PAIR.gear(member)), z, {number: 1e6})
        soft = engagement()
        soft = replace(soft, compliance=replace(soft.compliance, **{member: source}))
        for cycle in range(z):
            one, other = (e.solve(e.grid(X), [LOAD], cycle) for e in (back, soft))
            several = (one.grid.contacts.present.sum(axis=0) > 1)[None]
            assert np.array_equal((one.loads[..., 0] > 0.0) & several, (other.loads[..., 0] > 1e-3 * LOAD) & several)


def test_a_turn_is_the_sum_of_its_base_pitches():
    e = engagement(("driver",))
    found = revolution(e, LOAD, e.cycles, 3 * e.cycles)
    from fegear.contact.fourier import panels

    points = panels(PAIR.x_start, PAIR.base_pitch, e.breaks, waves=12, order=8)
    period = e.cycles * PAIR.base_pitch
    for n in (0, 1, 2, e.cycles, e.cycles + 1):
        total = 0.0
        for cycle in range(e.cycles):
            te = e.solve(e.grid(points.x), [LOAD], cycle).transmission_error[:, 0]
            along = points.x + cycle * PAIR.base_pitch
            total += (np.exp(-2j * math.pi * n * along / period) * te) @ points.weights / period
        assert found.coefficients[n] == pytest.approx(total, rel=1e-9, abs=1e-15)
    assert abs(found.coefficients[1]) > 1e-3 * abs(found.coefficients[0])


def test_like_teeth_are_kept_once():
    e = engagement()
    grid = e.grid(X)
    states = [e.solve(grid, [LOAD], cycle) for cycle in (0, 1, 5)]
    assert e.cycles == 1
    assert not e.uneven
    assert all(state.grid is grid and state.shared is states[0].shared for state in states)
    assert not grid.others
    odd = engagement(("driven",))
    ordinary = [odd.solve(odd.grid(X), [LOAD], cycle) for cycle in (5, 6, 7)]
    assert all(state.grid is ordinary[0].grid and state.shared is ordinary[0].shared for state in ordinary)
    assert odd.solve(odd.grid(X), [LOAD], 0).grid is not ordinary[0].grid


def test_a_pair_that_is_followed_keeps_its_teeth():
    e, even = engagement(("driver",)), engagement()
    ordinary = pair_history(even, [LOAD], 41)
    far, own = pair_history(e, [LOAD], 41, 5), pair_history(e, [LOAD], 41, 0)
    assert np.array_equal(far.load, ordinary.load)
    shared = (ordinary.load[:, 0] < 0.99 * LOAD) & (ordinary.load[:, 0] > 0.01 * LOAD)
    assert (own.load[shared, 0] < 0.97 * ordinary.load[shared, 0]).all()  # the softer tooth carries less
    assert own.load[~shared, 0] == pytest.approx(ordinary.load[~shared, 0], abs=0.05 * LOAD)


@pytest.mark.parametrize("member", MEMBERS)
@pytest.mark.parametrize("side", ["tension", "compression"])
def test_stress_of_every_fillet_is_the_sum_over_the_loads_on_every_tooth(member, side):
    e = engagement((member,))
    source, step = e.compliance.source(member), 1 if member == "driver" else -1
    z = Z[MEMBERS.index(member)]
    for cycle in (0, 1, 3, z - 1):
        state = e.solve(e.grid(X), [LOAD, 2.0 * LOAD], cycle)
        contacts, n = state.grid.contacts, state.loads.shape[0]
        radius = contacts.radius_driver if member == "driver" else contacts.radius_driven
        found = root_stress_history(e, state, member, side, 1)
        for row in range(-1, n + 1):
            i = step * (int(contacts.number[0]) + row - cycle)
            total = 0.0
            for other in range(n):
                j = step * (int(contacts.number[other]) - cycle)
                if abs(i - j) <= 3:
                    kernel = source.root_stress(i, j, radius[other], side)
                    total = total + kernel[:, :, None] * state.loads[other] / e.compliance.face_width
            wanted = total.max(axis=0) if side == "tension" else total.min(axis=0)
            assert found.stress[row + 1] == pytest.approx(wanted, rel=1e-12)


def test_the_stress_of_a_tooth_through_the_mesh_is_its_own():
    e, even = engagement(("driver",)), engagement()
    soft = replace(e, compliance=replace(e.compliance, driver=Odd(SmoothTooth(PAIR.driver), Z[0], {})))
    known = {}
    for name, one in (("odd", e), ("alike", soft)):
        states = loaded_states(one, (), [LOAD], X)
        known[name] = tooth_stress(one, states, "driver").largest_tension[0]
    assert known["odd"] > 1.5 * known["alike"]  # twice the stress per load, on a tooth that carries less
    assert even.cycles == 1


def test_the_springs_of_a_train_are_those_of_each_base_pitch():
    e = engagement(("driver",), coupling=False, hertz="none")
    found = mesh_excitation(e, LOAD)
    assert found.stiffness[0].pitches == Z[0]
    sums = set()
    for cycle, place in product(range(Z[0]), (0.21, 0.63)):
        x = place * PAIR.base_pitch
        before = round(float(e.meshing.reduced(x) - x) / PAIR.base_pitch)
        state = e.solve(e.grid([x]), [LOAD], cycle - before)
        total = sum(float(k(place + cycle)) for k in found.stiffness)
        assert total == pytest.approx(float(state.local_stiffness[0, 0]), rel=1e-4)
        sums.add(round(total, -4))
    assert len(sums) > 4  # two of the ordinary pitches, and those of the softer teeth


@pytest.fixture(scope="module")
def solved():
    gear = Gear(Tooth(17, BasicRack(1.0, 1.25, 0.2), 0.2), 2e-3, 8e-3, 1e-2)
    return finite_element_compliance(solve_gear(gear, MeshSettings().scaled(2.0), estimate_error=False))


@pytest.mark.parametrize("kind", ["finite elements", "tables", "shifted", "formula", "made up", "odd"])
def test_what_teeth_do_to_each_other_is_reciprocal(solved, kind):
    """c_ij(p, q) = c_ji(q, p) (Maxwell), and a source that says that windows of teeth are alike answers alike."""
    gear = solved.influence.gear
    source = {
        "finite elements": solved, "tables": light(solved),
        "shifted": ShiftedCompliance(solved, np.array([16e-3, 19e-3]), np.zeros(2), 1e-14),
        "formula": closed_form_compliance(gear, "cornell"), "made up": SmoothTooth(gear), "odd": Odd(solved, 17),
    }[kind]  # fmt: skip
    p, q = np.linspace(16.4e-3, 19.0e-3, 5), np.linspace(16.8e-3, 18.7e-3, 5)
    size = float(np.abs(source.own(0, p)).max())
    for i, j in product(range(-3, 4), (-2, 0, 1, 16)):
        if i != j:
            assert source.between(i, j, p, q) == pytest.approx(source.between(j, i, q, p), rel=1e-12, abs=1e-14 * size)
    for first, count in product(range(-2, 19), (1, 3)):
        like = source.same_as(first, count)
        assert source.same_as(like, count) == like
        for n, m in product(range(count), repeat=2):
            if n == m:
                assert np.array_equal(source.own(first + n, p), source.own(like + n, p))
            else:
                one, other = source.between(first + n, first + m, p, q), source.between(like + n, like + m, p, q)
                assert np.array_equal(one, other)


def test_what_takes_one_tooth_for_all_refuses_teeth_that_differ():
    e = engagement(("driver",))
    with pytest.raises(InputError, match="teeth that differ: are not known to loadings by root stress"):
        design_stress(e.compliance)
    state = e.solve(e.grid(X), [LOAD], 1)
    again = solve_again(engagement(("driver",)), state)
    assert np.array_equal(again.loads, state.loads)
