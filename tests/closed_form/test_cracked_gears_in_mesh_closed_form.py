"""Gears with a cracked tooth in mesh: laws of numbered teeth, and the table of depths that whole gears were held to."""

import functools
import math
from dataclasses import astuple, replace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.base.store import Store
from fegear.contact.load import load
from fegear.contact.pair_spec import PairSpec
from fegear.contact.plane.base_pitch import roll_positions
from fegear.contact.plane.crack_in_mesh import crack_in_mesh
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.odd_compliance import odd_compliance, odd_neighbours_shifted_by_error, odd_shifted_by_error
from fegear.contact.plane.over_revolution import over_revolution
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.sidebands import condition_indicators, indicator_errors
from fegear.contact.plane.stress_over_revolution import stress_over_revolution
from fegear.fem.plane.influence import SIDES
from fegear.fem.plane.odd.crack import mouth_at_tangent, straight_crack
from fegear.fem.plane.odd.odd_gear import OddGearInfluence
from fegear.fem.plane.odd.odd_influence import solve_odd_influence
from fegear.fem.plane.odd.odd_solution import solve_cracked_gear
from fegear.fem.plane.odd.tooth_kind import OddTooth
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.rack import BasicRack

#: The pair of the table: 60 N m on 25 teeth, module 2 mm, face 20 mm, bores half of the roots, E = 206 GPa.
STEEL, TORQUE, Z = Material(206e9), 60.0, (25, 30)
#: By the share of the way through the tooth (crack from the 30 degree tangent under 70 degrees): how much lower the
#: lowest secant stiffness is, and the largest residual [um]; of a prototype that was held to whole gears by a mesh, a
#: code and a contact of their own, within 8e-4 of the transmission error at 50 %.
TABLE = {0.1: (0.029, 0.311), 0.3: (0.149, 1.684), 0.5: (0.314, 4.378), 0.7: (0.513, 10.06)}


def gear(teeth):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25))
    return Gear(tooth, 2e-3, tooth.root_radius * 1e-3, 20e-3, STEEL)


PAIR = GearPair(*(gear(z) for z in Z))
LOAD = TORQUE / PAIR.driver.base_radius


@functools.cache
def ordinary(member, estimates=True):
    return solve_gear(PAIR.gear(member), settings_at(-3), reach=2, estimate_error=estimates)


def crack_of(member, share, back=False):
    tooth = PAIR.gear(member).tooth
    mouth = mouth_at_tangent(tooth, math.radians(30.0))
    return straight_crack(tooth, mouth, math.radians(70.0), share=share, back=back)


@functools.cache
def cracked(member, share, number=0):
    return solve_cracked_gear(ordinary(member), {number: crack_of(member, share)})


@functools.cache
def healthy(member):
    """Tooth 0 by itself, and as all others."""
    plain = ordinary(member)
    fine, s = plain.fine, plain.settings
    odd = {0: OddTooth(fine.tooth, fine.mesh)}
    found = solve_odd_influence(fine.tooth, fine.mesh, odd, fine.poisson_ratio, fine.plane, s, reach=3, two_orders=True)
    return OddGearInfluence(plain, found)


def engagement(*odd, corner=True, **more):
    """With the gears that are given in the place of ordinary ones."""
    known = {member: ordinary(member) for member in MEMBERS}
    sources = {member: finite_element_compliance(one) for member, one in known.items()}
    for one in odd:
        sources["driver" if one.gear.teeth == Z[0] else "driven"] = odd_compliance(one)
    return Engagement(PairCompliance(PAIR, *sources.values()), corner_contact=corner, **more)


@pytest.mark.dear("driver")
@pytest.mark.parametrize("member", MEMBERS)
def test_a_healthy_odd_tooth_changes_nothing(member):
    even = engagement()
    odd = engagement(healthy(member))
    found, usual = over_revolution(odd, LOAD, 24), over_revolution(even, LOAD, 24)
    assert found.solved == 9
    assert usual.solved == 1
    assert found.transmission_error == pytest.approx(
        np.broadcast_to(usual.transmission_error, found.transmission_error.shape), rel=1e-10
    )
    source, plain = odd.compliance.source(member), even.compliance.source(member)
    radii = np.linspace(plain.influence.lowest_radius, plain.influence.highest_radius, 5)[1:-1]
    for side in SIDES:
        for i, j in ((0, 0), (1, 0), (0, -1), (3, 1)):
            stress = source.root_stress(i, j, radii, side)
            assert stress == pytest.approx(plain.root_stress(i, j, radii, side), rel=1e-9, abs=1e-9 * abs(stress).max())
    error = source.influence.own_error(0, radii, source.reference_half_width(radii))
    assert error == pytest.approx(
        plain.influence.self_error(radii, source.reference_half_width(radii)), rel=1e-3, abs=0.0
    )


@pytest.mark.parametrize(("member", "number"), [("driver", 0), ("driven", 7)])
def test_what_teeth_of_a_cracked_gear_do_to_each_other_is_reciprocal(member, number):
    """And windows of teeth that are said to be alike answer alike, round the whole gear."""
    base = odd_compliance(cracked(member, 0.5, number))
    z, known = base.period, base.ordinary.influence
    p = np.linspace(known.lowest_radius, known.highest_radius, 6)[1:-1]
    q = p[::-1]
    for source in (base, odd_shifted_by_error(base), odd_neighbours_shifted_by_error(base)):
        for i in range(number - 4, number + 5):
            for j in (i - 2, i - 1, i + 1, i + z - 1):
                assert source.between(i, j, p, q) == pytest.approx(source.between(j, i, q, p), rel=1e-9, abs=0.0)
        for first in range(-2, z + 2):
            for count in (1, 2, 4):
                like = source.same_as(first, count)
                assert source.same_as(like, count) == like
                for n in range(count):
                    assert np.array_equal(source.own(first + n, p), source.own(like + n, p))
                    if n:
                        one, other = (source.between(start + n, start, p, q) for start in (first, like))
                        assert np.array_equal(one, other)
        assert len({source.same_as(first, 2) for first in range(z)}) == 7  # with the tooth or two beside it, and one
    assert base.own(number, p).min() > 1.1 * base.own(number + 2, p).min()
    assert base.own(number + z, p) == pytest.approx(base.own(number, p), rel=1e-15, abs=0.0)


def test_the_third_teeth_from_a_crack_are_ordinary(monkeypatch):
    """What `same_as` takes for granted: they change little, and the transmission error is the same to 4e-4."""
    known, radii = cracked("driver", 0.5), [23.9e-3, 25.0e-3, 26.5e-3]
    farther = solve_cracked_gear(ordinary("driver"), {0: crack_of("driver", 0.5)}, beside=3)
    half = 0.02 * 2e-3
    usual = ordinary("driver").self_compliance(radii, half)
    off = {i: np.abs(farther.own(i, radii, half) / usual - 1.0).max() for i in (-3, -2, 2, 3)}
    assert max(off[-2], off[2]) > 1e-3
    assert max(off[-3], off[3]) < 6e-4
    one = over_revolution(engagement(known, corner=False), LOAD, 12)
    monkeypatch.setattr("fegear.fem.plane.odd.odd_gear.TOUCHED", 3)
    other = over_revolution(engagement(farther, corner=False), LOAD, 12)
    assert (one.solved, other.solved) == (7, 9)
    assert one.transmission_error == pytest.approx(other.transmission_error, rel=4e-4)


@pytest.mark.dear
@pytest.mark.parametrize("share", TABLE)
def test_the_table_of_depths(share):
    """25 and 30 teeth: how much lower the mesh stiffness is, and what is left of the transmission error."""
    found = over_revolution(engagement(cracked("driver", share)), LOAD, 100)
    drop, residual = TABLE[share]
    assert found.transmission_error.shape[0] == Z[0]
    assert found.solved == 9  # of four rows of pairs, two of them corner contacts: those and four, and the ordinary one
    assert 1.0 - found.lowest_stiffness / found.ordinary_lowest_stiffness == pytest.approx(drop, abs=2e-3)
    assert np.abs(found.residual).max() * 1e6 == pytest.approx(residual, rel=1e-2)


def mirrored(source):
    """Teeth counted the wrong way round."""
    return _Mirrored(source)


class _Mirrored:
    def __init__(self, base):
        self.base = base

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self.base, name)

    def same_as(self, first, count):
        return self.base.same_as(-first - count + 1, count)

    def own(self, i, radius):
        return self.base.own(-i, radius)

    def between(self, i, j, p, q):
        return self.base.between(-i, -j, p, q)


def test_teeth_have_to_be_counted_the_right_way_round():
    """Over the whole revolution against the compliances of the ring itself, put in by hand (no table, no `same_as`)."""
    known, plain = cracked("driver", 0.5), finite_element_compliance(ordinary("driven"))
    e = engagement(known, corner=False)
    wrong = replace(e, compliance=replace(e.compliance, driver=mirrored(e.compliance.driver)))
    x = np.array([PAIR.x_start + 0.2 * PAIR.base_pitch, PAIR.x_start + 0.5 * PAIR.base_pitch])
    off = {"right": 0.0, "wrong": 0.0}
    for cycle in (0, 1):
        for at in x:
            contacts = e.grid([at]).contacts
            radius = contacts.radius_driver[:, 0], contacts.radius_driven[:, 0]
            # A driver turns toward its loaded flanks, clockwise: pair 1, which has come before, is on the next tooth
            # clockwise. One base pitch later tooth 0 is where tooth 1 was.
            first, second = 0 - cycle, 1 - cycle
            matrix = e.compliance.matrices(contacts, 5).compliance[:, :, 0] * e.compliance.face_width
            change = np.zeros((2, 2))
            for a, (i, r) in enumerate(zip((first, second), radius[0], strict=True)):
                for b, (j, other) in enumerate(zip((first, second), radius[0], strict=True)):
                    if a == b:
                        half = np.array([0.04e-3])
                        usual = ordinary("driver").self_compliance([r], half)
                        change[a, a] = known.own(i, [r], half)[0] - usual[0]
                    else:
                        usual = ordinary("driver").neighbour(i - j, [r], [other])
                        change[a, b] = (known.between(i, j, [r], [other]) - usual)[0, 0]
            for name, one in (("right", e), ("wrong", wrong)):
                got = one.compliance.matrices(contacts, cycle).compliance[:, :, 0] * e.compliance.face_width
                off[name] = max(off[name], float(np.abs(got - matrix - change).max() / matrix[0, 0]))
    assert plain.reach == 2
    assert off["right"] < 1e-4
    assert off["wrong"] > 3e-3


@pytest.mark.parametrize("member", MEMBERS)
def test_the_cracked_tooth_shows_while_it_is_in_mesh(member):
    """Driver and driven gear: the softest base pitches are those with the tooth, which carries less than its share."""
    found = over_revolution(engagement(cracked(member, 0.5), corner=False), LOAD, 20)
    z = PAIR.gear(member).teeth
    assert found.transmission_error.shape[0] == z
    assert found.solved == 7
    peak = np.abs(found.residual).max(axis=1)
    # tooth 0 is pair 0 in base pitch 0, and pair 1 in the next one
    assert set(np.argsort(peak)[-2:]) == {0, 1}
    assert (peak[2:] < 0.05 * peak.max()).all()
    together = (found.loads[5] > 0.0).all(axis=0)
    row = int(np.flatnonzero(found.number == 0)[0])
    assert (found.loads[0, row, together] < 0.95 * found.loads[5, row, together]).all()


def test_a_driver_with_a_crack_is_the_driven_gear_of_the_reversed_pair():
    """Driver and driven exchanged, the path runs the other way; the same flanks touch, so the same numbers come out."""
    e = engagement(cracked("driver", 0.5), corner=False)
    back = e.reversed()
    x = PAIR.x_start + PAIR.base_pitch * np.array([0.13, 0.45, 0.81])
    one = {c: e.solve(e.grid(x), [LOAD], c).transmission_error[:, 0] for c in range(-2, 4)}
    other = back.meshing.reduced(-x)
    turns = np.round((other + x) / PAIR.base_pitch).astype(int)
    for cycle, wanted in one.items():
        got = [
            float(back.solve(back.grid([at]), [LOAD], -cycle - int(turn)).transmission_error[0, 0])
            for at, turn in zip(other, turns, strict=True)
        ]
        assert got == pytest.approx(wanted, rel=1e-6)


@pytest.mark.parametrize("member", MEMBERS)
def test_root_stress_of_every_tooth_over_a_revolution(member):
    """The crack unloads its own fillet; a tooth next to it carries more, far ones carry as much as ever."""
    z = PAIR.gear(member).teeth
    found = stress_over_revolution(engagement(cracked(member, 0.5, 3), corner=False), LOAD, member, positions=12)
    usual = stress_over_revolution(engagement(corner=False), LOAD, member, positions=12)
    largest, ordinary_one = found.largest, usual.largest.max()
    assert largest.shape == (z,)
    assert largest[10] == pytest.approx(ordinary_one, rel=1e-9)
    assert largest[3] < 0.9 * ordinary_one
    assert max(largest[2], largest[4]) > 1.002 * ordinary_one


@pytest.mark.parametrize("member", MEMBERS)
def test_root_stress_of_teeth_that_are_alike_is_the_ordinary_one_and_states_its_error(member):
    loaded = load(PairSpec(PAIR, loads=(LOAD,), corner_contact=True), [ordinary("driver"), ordinary("driven")])
    found = stress_over_revolution(loaded.engagement, LOAD, member, positions=24, shifted=loaded.shifted)
    usual = loaded.root_stress({m: {"fe": loaded.engagement.compliance.source(m)} for m in MEMBERS}).stress[member][
        "fe"
    ]
    assert found.largest.shape == found.largest_error.shape == (1,)
    assert abs(found.largest[0] - usual.largest_tension[0]) <= found.largest_error[0]
    assert found.off[0] == pytest.approx(usual.error(0), rel=0.05)
    assert found.beyond[0] < 2e-3 * found.largest[0]


@pytest.mark.dear("tension")
@pytest.mark.parametrize("side", SIDES)
def test_root_stress_between_roll_positions_is_looked_for_and_what_is_left_is_stated(side):
    """Few positions find what many do, of a cracked tooth and of those beside it, too."""
    e = engagement(cracked("driver", 0.5, 3))
    few, many = (stress_over_revolution(e, LOAD, "driver", side, positions=count) for count in (16, 160))
    missed = few.sign * (many.largest - few.largest)
    assert (missed <= few.beyond + many.beyond + 1e-9 * np.abs(many.largest)).all()
    assert np.abs(missed / many.largest).max() < 5e-3
    at_first = few.only(roll_positions(e, 16)).largest
    assert (few.sign * (many.largest - at_first) / np.abs(many.largest)).max() > 5e-3
    assert few.off is few.largest_error is None  # nothing states the errors of gears


@pytest.mark.dear
def test_the_loaded_pair_takes_a_cracked_gear_and_states_its_errors():
    spec = PairSpec(PAIR, loads=(LOAD,), corner_contact=True)
    loaded = load(spec, [cracked("driver", 0.5), ordinary("driven")])
    found = loaded.over_revolution(16)
    assert "tooth 0 cracked" in loaded.about
    assert found.transmission_error.shape[0] == Z[0]
    assert (found.transmission_error_error > 0.0).all()
    assert (found.transmission_error_error < 5e-3 * found.transmission_error).all()
    assert loaded.transmission_error().rotational is not None
    stress = stress_over_revolution(loaded.engagement, LOAD, "driver", positions=16, shifted=loaded.shifted)
    off = stress.largest_error / stress.largest
    assert (off > 0.0).all()
    assert off[1:].max() < 0.02
    assert off[0] < 0.1


@pytest.mark.dear
def test_condition_indicators_state_what_few_positions_leave_open():
    loaded = load(PairSpec(PAIR, loads=(LOAD,), corner_contact=True), [cracked("driver", 0.5), ordinary("driven")])
    (few, left), (many, _) = (
        (
            np.array(astuple(of(loaded.over_revolution(count), (Z[0],))))
            for of in (condition_indicators, indicator_errors)
        )
        for count in (24, 160)
    )
    assert (np.abs(few - many) <= 1.5 * left).all()
    assert (left > 0.0).all()
    assert (left[[0, 5, 6]] < 0.05 * few[[0, 5, 6]]).all()


def test_solved_gears_are_kept_on_disk(tmp_path):
    plain = ordinary("driver", estimates=False)
    crack, radii = {4: crack_of("driver", 0.4), 5: crack_of("driver", 0.2)}, [24e-3, 25e-3]
    one = solve_cracked_gear(plain, crack, cache=SolutionCache(Store(tmp_path)))
    cache = SolutionCache(Store(tmp_path))
    other = solve_cracked_gear(plain, crack, cache=cache)
    assert cache.shapes.from_disk == 1
    for i, j in ((4, 5), (5, 4), (6, 5)):
        assert np.array_equal(one.between(i, j, radii, radii), other.between(i, j, radii, radii))
    for side in SIDES:
        assert np.array_equal(one.largest_root_stress(4, 5, side, radii), other.largest_root_stress(4, 5, side, radii))
    assert np.array_equal(one.stress_intensity(5, 5, radii)[0], other.stress_intensity(5, 5, radii)[0])
    assert np.isnan(one.own_error(4, radii, 1e-4)).all()
    assert one.stress_intensity(4, 4, radii)[0][0].min() > 0.0


def test_what_is_no_cracked_gear_is_refused():
    plain = ordinary("driver")
    with pytest.raises(InputError, match="at least one tooth"):
        solve_cracked_gear(plain, {})
    with pytest.raises(InputError, match="twice"):
        solve_cracked_gear(plain, {0: crack_of("driver", 0.2), 25: crack_of("driver", 0.3)})
    with pytest.raises(InputError, match="near the odd teeth"):
        cracked("driver", 0.5).own(12, [25e-3], 1e-4)


@pytest.mark.dear
def test_stress_intensity_in_the_mesh_of_faces_that_may_close():
    """Of a crack that its load opens that of open faces; of one that it shuts no K_I, over the whole passage."""
    found = {}
    for back, closing in ((False, False), (False, True), (True, True)):
        one = solve_cracked_gear(ordinary("driver"), {0: replace(crack_of("driver", 0.4, back), closing=closing)})
        e = engagement(one, corner=False)
        found[back, closing] = crack_in_mesh(e, over_revolution(e, LOAD, 8), "driver", one, 0)
    opened, same, shut = found.values()
    assert same.tooth == opened.tooth == shut.tooth
    bears = opened.load > 0.2 * LOAD
    for mode in ("k_1", "k_2"):
        one, other = getattr(opened, mode), getattr(same, mode)
        assert other[bears] == pytest.approx(one[bears], rel=1e-9, abs=1e-9 * opened.k_1.max())
    assert opened.k_1.min() < -0.01 * opened.k_1.max()
    assert same.k_1.min() >= 0.0
    assert shut.k_1.min() >= 0.0
    loaded = shut.load > 0.2 * LOAD
    assert shut.k_1[loaded].max() < 0.02 * opened.k_1.max()
    assert np.abs(shut.k_2[loaded]).max() > 0.1 * opened.k_1.max()
    assert (shut.k_1_error >= 0.0).all()


def test_a_fillet_that_a_load_compresses_has_the_error_of_its_stress():
    """Its largest tension nearly vanishes where the next tooth is loaded; its error does not."""
    known, radii = cracked("driver", 0.5), np.array([24.2e-3, 25.0e-3, 26.2e-3])
    for side in SIDES:
        for i, j in ((0, 1), (1, 0), (-1, 0), (0, 0)):
            error = known.root_stress_error(i, j, side, radii)
            assert (error >= ordinary("driver").root_stress_error(i - j, side, radii)).all()
            along = np.abs(known.fillet_stress(i, j, side, radii)).max(axis=0)
            assert (error >= 1e-4 * along).all()
    assert (known.between_error(1, -1, radii, radii) >= ordinary("driver").neighbour_error(2, radii, radii)).all()
    value, error = known.stress_intensity(0, 1, radii)
    assert error.min() > 1e-4 * np.hypot(*value).max()


@pytest.mark.dear
def test_extremes_over_a_revolution_are_those_where_contact_changes():
    """Tip edges bear beyond the path: between even positions the lowest stiffness would be missed."""
    of, load = engagement(cracked("driver", 0.4)), LOAD
    coarse, fine = (over_revolution(of, load, count) for count in (25, 400))
    assert coarse.lowest_stiffness == pytest.approx(fine.lowest_stiffness, rel=1e-4)
    assert coarse.ordinary_lowest_stiffness == pytest.approx(fine.ordinary_lowest_stiffness, rel=1e-4)
    assert coarse.transmission_error.max() == pytest.approx(fine.transmission_error.max(), rel=1e-4)
