"""The functions that numba compiles for arrays of pairs, run as plain Python: each line of them against single pairs.

As machine code they leave no trace, and take ten seconds to compile; a few positions of two pairs take a tenth of one.
"""

from __future__ import annotations

import functools
import inspect
import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.atlas import many_pairs as atlas_many
from fegear.atlas.many_pairs import ManySpurPairs, known_pairs
from fegear.atlas.shipped import shipped_atlas
from fegear.contact.many import (
    changes,
    corners,
    followed_peaks,
    kernel,
    many_load_sharing,
    many_roots,
    over_fillets,
    over_mesh,
)
from fegear.contact.many.arrays import ManyReliefs
from fegear.contact.plane import peaks
from fegear.contact.plane import tooth_stress as plane_stress
from fegear.contact.plane.base_pitch import roll_positions
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.root_stress_history import root_stress_history
from fegear.contact.plane.tooth_stress import loaded_states, tooth_stress, with_peaks
from fegear.contact.plane.transmission_error import transmission_error
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import EndRelief

LOADS = np.array([600.0, 9000.0])
GEARS = (((17, 0.3), (60, -0.1)), ((24, 0.2), (31, 0.1)))
M, FACE = 3e-3, 0.02
RELIEFS = ManyReliefs(np.array([[8e-6, 0.0], [5e-6, 12e-6]]), np.full((2, 2), 0.7), np.array([[1.0, 1.0], [2.0, 1.0]]))


class Unwritten:
    """numpy whose empty arrays show where something is read before it was written."""

    def __getattr__(self, name):
        return getattr(np, name)

    @staticmethod
    def empty(shape, dtype=float):
        return np.full(shape, math.nan if dtype is float else -(10**9), dtype)


@pytest.fixture(autouse=True)
def plain(monkeypatch):
    """None of them compiled, whether another test of this process has compiled them or not."""
    for module in (corners, kernel, changes, over_mesh, over_fillets, followed_peaks):
        for name, function in list(vars(module).items()):
            if callable(function):
                monkeypatch.setattr(module, name, getattr(function, "py_func", function))
        if hasattr(module, "np"):
            monkeypatch.setattr(module, "np", Unwritten())
    own = {name: function for module in (over_mesh, over_fillets, followed_peaks)
           for name, function in vars(module).items() if inspect.isfunction(function)}  # fmt: skip
    for module in (many_load_sharing, many_roots):
        monkeypatch.setattr(module, "compiled", lambda: own)


def _gear(teeth: int, shift: float) -> Gear:
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.38), shift)
    return Gear(tooth, M, 0.5 * tooth.root_radius * M, face_width=FACE)


@pytest.fixture(scope="module")
def pairs() -> list[GearPair]:
    return [GearPair(*(_gear(*one) for one in both)) for both in GEARS]


@pytest.fixture(scope="module")
def many(pairs) -> ManySpurPairs:
    def each(of) -> np.ndarray:
        return np.array([[of(gear) for gear in members] for members in
                         zip(*((one.driver, one.driven) for one in pairs), strict=True)], dtype=float)  # fmt: skip

    return ManySpurPairs(
        each(lambda g: g.teeth), each(lambda g: g.tooth.generating_shift), each(lambda g: g.tip_radius),
        each(lambda g: g.bore_radius), np.full(2, M), np.array([one.centre_distance for one in pairs]),
        np.full(2, FACE), each(lambda g: g.material.young_modulus),
    )  # fmt: skip


def _engagement(pair: GearPair, corners: bool, reliefs: ManyReliefs | None, i: int) -> Engagement:
    atlas = shipped_atlas("A")
    compliance = PairCompliance(pair, atlas.compliance(pair.driver), atlas.compliance(pair.driven))
    engagement = Engagement(compliance, corner_contact=corners)
    if reliefs is None:
        return engagement
    found = []
    for member, gear in enumerate((pair.driver, pair.driven)):
        low, high = (math.sqrt(r**2 - gear.base_radius**2) / gear.base_radius for r in gear.involute_radii)
        begins = low + reliefs.start[member, i] * (high - low)
        found.append(EndRelief(float(reliefs.amount[member, i]), begins, high, float(reliefs.power[member, i])))
    return replace(engagement, driver_relief=found[0], driven_relief=found[1])


@pytest.mark.parametrize(("corners", "reliefs"), [(False, None), (True, RELIEFS), (True, None)])
def test_positions_are_those_of_each_pair(pairs, many, corners, reliefs):
    known = known_pairs(shipped_atlas("A"), many, corner_contact=corners, reliefs=reliefs, root_stress=True)
    at = np.array([0.0007, 0.3, 0.985])
    shared = many_load_sharing.shares_at(known.engagements, LOADS[1], at)
    histories = many_roots.root_stress_at(known.engagements, known.fillets, LOADS[1], at)
    for i, pair in enumerate(pairs):
        one = _engagement(pair, corners, reliefs, i)
        state = one.solve(one.grid(pair.x_start + pair.base_pitch * at), [LOADS[1]])
        shares = np.zeros_like(shared.shares[i])
        shares[:, state.grid.contacts.number - shared.first[i]] = state.shared.shares[:, :, 0].T
        np.testing.assert_allclose(shared.shares[i], shares, atol=1e-11)
        np.testing.assert_allclose(shared.transmission_error[i], state.transmission_error[:, 0], rtol=1e-11)
        for m, member in enumerate(("driver", "driven")):
            for side, name in enumerate(("tension", "compression")):
                stress = root_stress_history(one, state, member, name, 1).stress[..., 0]
                rows = state.grid.contacts.number[0] - 1 - histories.first[i] + np.arange(stress.shape[0])
                mine = histories.stress[m, i, side][rows]
                here = np.isfinite(mine)
                assert here.sum() >= 3 * at.size
                np.testing.assert_allclose(mine[here], stress[here], atol=1e-11 * np.abs(stress).max(), rtol=0.0)


def test_errors_over_the_mesh_are_those_of_each_pair(pairs, many):
    known = known_pairs(shipped_atlas("A"), many, reliefs=RELIEFS)
    found = many_load_sharing.transmission_errors(known.engagements, LOADS[1:], waves=1, samples=16, order=3)
    for i, pair in enumerate(pairs):
        exact = transmission_error(_engagement(pair, True, RELIEFS, i), LOADS[1], 8)
        assert found.mean[i, 0] == pytest.approx(exact.mean, rel=8e-4)
        assert abs(found.peak_to_peak[i, 0] - exact.peak_to_peak) < 1e-7 * exact.mean
    np.testing.assert_allclose(found.largest_share, 1.0, atol=1e-12)


def test_largest_root_stresses_are_those_of_a_pair(pairs, many):
    two = known_pairs(shipped_atlas("A"), many, reliefs=RELIEFS, root_stress=True)
    fillets = replace(two.fillets, length=two.fillets.length * np.array([1.0, np.nan]))
    found = many_roots.root_stresses(two.engagements, fillets, LOADS[1:], samples=7)
    one = _engagement(pairs[0], True, RELIEFS, 0)
    sources = {member: (one.compliance.source(member),) for member in ("driver", "driven")}
    states = loaded_states(one, (), [LOADS[1]], with_peaks(one, LOADS[1], roll_positions(one, 32), sources))
    for m, member in enumerate(("driver", "driven")):
        each = tooth_stress(one, states, member, estimates=False)
        tension, compression = float(each.largest_tension[0]), float(each.largest_compression[0])
        assert found.tension[m, 0, 0] == pytest.approx(tension, rel=1e-5)
        assert found.compression[m, 0, 0] == pytest.approx(compression, rel=1e-5)
        assert abs(found.tension_range[m, 0, 0] - float(each.tension_range[0])) < 1e-5 * tension
    assert np.isnan(found.tension[:, 1]).all()


@pytest.mark.parametrize("followed", [False, True])
def test_pairs_without_fillets_have_no_root_stress_none_of_them(many, followed):
    known = known_pairs(shipped_atlas("A"), many, reliefs=RELIEFS, root_stress=True)
    fillets = replace(known.fillets, length=np.nan * known.fillets.length)
    found = many_roots.root_stresses(known.engagements, fillets, LOADS, samples=2, followed=followed)
    for one in (found.tension, found.compression, found.tension_range):
        assert one.shape == (2, 2, 2)
        assert np.isnan(one).all()
    at = many_roots.root_stress_at(known.engagements, fillets, LOADS[0], [0.2, 0.7])
    assert np.isnan(at.stress).all()
    assert at.first.tolist() == [-1, -1]


@pytest.mark.dear
def test_followed_root_stresses_are_those_of_a_pair_to_round_off(pairs, many):
    known = known_pairs(shipped_atlas("A"), many, reliefs=RELIEFS, root_stress=True)
    fillets = replace(known.fillets, length=known.fillets.length * np.array([1.0, np.nan]))
    found = many_roots.root_stresses(known.engagements, fillets, LOADS[1:], samples=4, followed=True)
    one = _engagement(pairs[0], True, RELIEFS, 0)
    sources = {member: (one.compliance.source(member),) for member in ("driver", "driven")}
    states = loaded_states(one, (), [LOADS[1]], with_peaks(one, LOADS[1], roll_positions(one, 4), sources))
    for m, member in enumerate(("driver", "driven")):
        each = tooth_stress(one, states, member, estimates=False)
        tension, compression = float(each.largest_tension[0]), float(each.largest_compression[0])
        assert found.tension[m, 0, 0] == pytest.approx(tension, rel=1e-12)
        assert found.compression[m, 0, 0] == pytest.approx(compression, rel=1e-12)
        assert abs(found.tension_range[m, 0, 0] - float(each.tension_range[0])) < 1e-12 * tension
    assert np.isnan(found.tension[:, 1]).all()


def test_peaks_followed_less_far_are_still_those_of_a_pair_under_each_of_its_loads(pairs, many, monkeypatch):
    """The same search cut short in both: two maxima of a curve, two passes, one point on either side."""
    for name, value in (("_FOLLOWED", 2), ("_PASSES", 2), ("_EACH_SIDE", 1)):
        monkeypatch.setattr(followed_peaks, name, value)
    monkeypatch.setattr(peaks, "_POINTS", 1)
    monkeypatch.setattr(plane_stress, "refined_peaks", functools.partial(peaks.refined_peaks, followed=2, passes=2))
    known = known_pairs(shipped_atlas("A"), many, reliefs=RELIEFS, root_stress=True)
    fillets = replace(known.fillets, length=known.fillets.length * np.array([1.0, np.nan]))
    # the larger load first: nothing of it is left for the next one
    found = many_roots.root_stresses(known.engagements, fillets, LOADS[::-1], samples=3, followed=True)
    one = _engagement(pairs[0], True, RELIEFS, 0)
    sources = {member: (one.compliance.source(member),) for member in ("driver", "driven")}
    for k, load in enumerate(LOADS[::-1].tolist()):
        states = loaded_states(one, (), [load], with_peaks(one, load, roll_positions(one, 3), sources))
        for m, member in enumerate(("driver", "driven")):
            each = tooth_stress(one, states, member, estimates=False)
            tension, compression = float(each.largest_tension[0]), float(each.largest_compression[0])
            assert found.tension[m, 0, k] == pytest.approx(tension, rel=1e-12)
            assert found.compression[m, 0, k] == pytest.approx(compression, rel=1e-12)
            assert abs(found.tension_range[m, 0, k] - float(each.tension_range[0])) < 1e-12 * tension
    assert np.isnan(found.tension[:, 1]).all()


@pytest.mark.parametrize("begins", [(), (0.0,), (0.3, 1.7), (0.25, 0.3, 1.0)])
def test_positions_of_followed_peaks_are_those_of_a_base_pitch(begins):
    start, pitch, count = -0.4, 2.0, 8
    numbers, edges, out = np.zeros(32), start + np.array([*begins, 9.0]), np.full(60, np.nan)
    numbers[corners.START], numbers[corners.PITCH] = start, pitch
    found = followed_peaks.positions(numbers, count, edges, len(begins), out)
    engagement = SimpleNamespace(
        pair=SimpleNamespace(x_start=start, base_pitch=pitch), breaks=tuple(edges[: len(begins)].tolist())
    )
    np.testing.assert_allclose(out[:found], roll_positions(engagement, count), rtol=0.0, atol=1e-15)
    assert np.isnan(out[found + 2 :]).all()


def test_local_maxima_are_followed_by_their_heights():
    """At most four, the highest first, of equal ones the first; none lower than the highest by more than 5 %."""

    def found(*curve):
        out = np.full(6, -7, dtype=np.int64)
        count = followed_peaks.peaks_of(np.array([*curve, 1e9]), len(curve), out)
        assert (out[count:] == -7).all()
        return out[:count].tolist()

    assert found(1.0, 3.0, 2.0, 2.9, 0.0) == [1, 3]
    assert found(3.0, 1.0, 2.86, 1.0, 2.84) == [0, 2]
    assert found(0.0, 1.0, 2.9, 2.9, 1.0, 3.0) == [5, 2, 3]
    assert found(2.9, 0.0, 2.95, 0.0, 3.0, 0.0, 2.98, 0.0, 2.97) == [4, 6, 8, 2]
    assert found(-4.0, -3.0, -4.0, -3.1, -4.0, -3.2) == [1, 3]
    assert found(2.0) == [0]


def test_of_maxima_of_one_height_the_first_place_counts():
    def first(at, value, count):
        return followed_peaks.first_of_tied(np.array(at), np.array(value), count)

    assert first([3.0, 1.0, 2.0], [5.0, 4.0, 5.0], 3) == 2
    assert first([3.0, 1.0, 2.0], [5.0, 5.0 * (1.0 - 1e-10), 9.0], 2) == 1
    assert first([3.0, 1.0, 2.0], [5.0, 5.0 * (1.0 - 1e-8), 5.0 * (1.0 + 1e-10)], 3) == 2
    assert first([3.0, 1.0], [-5.0, -5.0 * (1.0 + 1e-10)], 2) == 1
    assert first([3.0, 1.0], [-5.0, -5.0 * (1.0 + 1e-8)], 2) == 0


def test_undercut_flanks_begin_where_those_of_a_gear_do(many):
    gear = _gear(14, 0.05)
    assert gear.tooth.undercut
    one = replace(
        many, teeth=np.full((2, 2), 14.0), generating_shift=np.full((2, 2), 0.05),
        tip_radius=np.full((2, 2), gear.tip_radius), bore_radius=np.full((2, 2), gear.bore_radius),
        centre_distance=np.full(2, 2.0 * gear.pitch_radius + 3e-4),
    )  # fmt: skip
    found = known_pairs(shipped_atlas("A"), one)
    assert found.held.all()
    low = math.sqrt((gear.form_radius - gear.base_radius) * (gear.form_radius + gear.base_radius))
    np.testing.assert_allclose(found.engagements.flanks.lowest, low, rtol=1e-12)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_the_largest_stress_of_a_fillet_is_that_of_its_smooth_curve_below_the_contact(sign):
    """Of a parabola, inside and at the end; what a contact does above the end of the search is faded out."""
    arc = np.linspace(0.02, 0.98, 40)
    fit = many_roots._fitted(arc.tobytes())

    def largest(values, end):
        return over_fillets.largest(sign * values, sign, end, 1.2, arc, *fit, np.empty(40), np.empty(40))

    for top in (0.3, 0.55):
        values = 3.0 - 4.0 * (arc - top) ** 2
        assert largest(values, 1.0) == pytest.approx(3.0, rel=1e-9)
        assert largest(values, 0.7) == pytest.approx(3.0, rel=1e-3)
    assert largest(2.0 + arc, 1.0) == pytest.approx(3.0, rel=1e-9)  # at the very end, beyond the last point
    assert largest(3.0 - arc, 1.0) == pytest.approx(3.0, rel=1e-9)
    level = np.full(40, 7.0)
    assert largest(level, 0.6) == pytest.approx(7.0, rel=1e-9)
    assert largest(np.where(arc > 0.66, 500.0, 7.0), 0.6) == pytest.approx(7.0, rel=1e-9)
    rough = over_fillets.roughly(sign * np.where(arc > 0.66, 500.0, arc), sign, 0.6, arc)
    assert 0.6 <= rough < 0.66


def test_a_peak_is_narrowed_about_the_vertex_of_a_parabola():
    for top in (0.4, 1.1, 1.6):
        x = np.array([0.0, 1.0, 2.0])
        f = 5.0 - (x - top) ** 2
        place = over_fillets.vertex(x, f, -10.0)
        assert place == pytest.approx(top, rel=1e-12)
        over_fillets.narrowed(x, f, place, 5.0)
        assert x[1] == place
        assert x[0] <= place <= x[2]
        assert f[1] == 5.0
    x, f = np.array([0.0, 1.0, 2.0]), np.array([1.0, 5.0, 1.0])
    assert abs(over_fillets.vertex(x, f, -10.0) - 1.0) == pytest.approx(0.04)  # away from what is known
    over_fillets.narrowed(x, f, 1.3, 4.0)
    assert x.tolist() == [0.0, 1.0, 1.3]


def test_pairs_that_are_looked_up_in_parts_stand_in_their_order(many, monkeypatch):
    """What is asked of each part is recorded: the numbers themselves are those of the tests above."""
    three = ManySpurPairs(*(np.concatenate([a, a[..., :1]], axis=-1) for a in vars(many).values()))
    three = replace(three, teeth=np.where(np.arange(3) == 1, 5.0, three.teeth))
    loads = np.arange(6.0).reshape(3, 2)

    def errors(engagements, given):
        assert engagements.module.size == len(given) <= 2
        return many_load_sharing.ManyErrors(given, given + 10.0, given + 20.0)

    def stresses(engagements, fillets, given):
        assert fillets.length.shape == (2, len(given))
        return many_roots.ManyRootStress(*(np.stack([given + k, given - k]) for k in (30.0, 40.0, 50.0)))

    monkeypatch.setattr(atlas_many, "transmission_errors", errors)
    monkeypatch.setattr(atlas_many, "root_stresses", stresses)
    atlas = shipped_atlas("A")
    found = atlas_many.loaded_pairs(atlas, three, loads, at_once=2)
    assert found.held.tolist() == [True, False, True]
    for k, part in enumerate(found.transmission_error):
        np.testing.assert_array_equal(part, loads + 10.0 * k)
    for k, part in zip((30.0, 40.0, 50.0), found.root_stress, strict=True):
        np.testing.assert_array_equal(part, np.stack([loads + k, loads - k]))
    np.testing.assert_array_equal(found.error[:, 0], found.error[:, 2])
    np.testing.assert_array_equal(found.stress_error[:, 0], found.stress_error[:, 2])
    assert ((found.error[:, 0] > 0.0) & (found.error[:, 0] < 5e-3)).all()
    assert found.error.shape == (2, 3)
    assert found.stress_error.shape == (2, 3, 2)
    assert atlas_many.loaded_pairs(atlas, three, loads, root_stress=False, at_once=2).root_stress is None
    for held, name in ((found.error[:, 0], "c_self"), (found.stress_error[:, 0, 0], "tension 0"), (
        found.stress_error[:, 0, 1], "compression 0")):  # fmt: skip
        np.testing.assert_allclose(held, [atlas.gear(_gear(*one)).errors[name] for one in GEARS[0]])
