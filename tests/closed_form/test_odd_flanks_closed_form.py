"""Pairs with one tooth missing, lower, pitted or ground otherwise: laws of contact, and what nothing changes."""

import functools
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.base.store import Store
from fegear.contact.load import load
from fegear.contact.odd_flank import OddFlank, Pit, ToothProfile
from fegear.contact.pair_spec import FlankSpec, PairSpec
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.odd_compliance import odd_compliance, odd_neighbours_shifted_by_error
from fegear.contact.plane.over_revolution import over_revolution
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.stress_over_revolution import stress_over_revolution
from fegear.fem.plane.odd.odd_solution import solve_cracked_gear
from fegear.fem.plane.odd.other_outline import Missing, OtherTip
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import TabulatedRelief
from fegear.geometry.relief_spec import ReliefSpec, TipReliefSpec


def gear(teeth):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25))
    return Gear(tooth, 2e-3, tooth.root_radius * 1e-3, 20e-3, Material(206e9))


PAIR = GearPair(gear(25), gear(30))
LOAD = 60.0 / PAIR.driver.base_radius


@functools.cache
def ordinary(member):
    return solve_gear(PAIR.gear(member), settings_at(-3), reach=2, estimate_error=True)


@functools.cache
def odd_gear(member, shape, number=0):
    return solve_cracked_gear(ordinary(member), {number: shape})


def engagement(*odd, hertz="load-dependent", **more):
    sources = {member: finite_element_compliance(ordinary(member)) for member in MEMBERS}
    for one in odd:
        sources["driver" if one.gear.teeth == 25 else "driven"] = odd_compliance(one)
    compliance = PairCompliance(PAIR, *sources.values(), hertz=hertz, nominal_load=LOAD)
    return Engagement(compliance, **{"corner_contact": True, **more})


def te(found):
    return found.transmission_error


@pytest.mark.dear
@pytest.mark.parametrize("member", MEMBERS)
def test_the_ordinary_tip_diameter_changes_nothing(member):
    same = PAIR.gear(member).tooth.tip_radius
    flank = {f"{member}_odd": {0: OddFlank(tip_radius=same * 2e-3)}}
    found = over_revolution(engagement(odd_gear(member, OtherTip(same)), **flank), LOAD, 12)
    usual = over_revolution(engagement(), LOAD, 12)
    assert te(found).shape[0] == PAIR.gear(member).teeth
    assert te(found) == pytest.approx(np.broadcast_to(te(usual), te(found).shape), rel=1e-10)
    # The contact by itself, on the same compliances: to round-off.
    alone = over_revolution(engagement(**flank), LOAD, 12)
    assert te(alone) == pytest.approx(np.broadcast_to(te(usual), te(alone).shape), rel=1e-12)


@functools.cache
def without_tooth(member="driver"):
    e = engagement(odd_gear(member, Missing()), **{f"{member}_odd": {0: OddFlank(missing=True)}})
    return e, over_revolution(e, LOAD, 50)


@pytest.mark.dear
def test_a_missing_tooth_carries_no_load_and_its_neighbours_do():
    """Transmission error and compliances of a prototype with a ring and contact of its own: 9.5 to 67.8 um."""
    _, found = without_tooth()
    assert found.number.tolist() == [-1, 0, 1, 2]
    for row, number in enumerate(found.number):
        assert (found.loads[int(number) % 25, row] == 0.0).all()  # tooth 0 is on pair j in base pitch j
    assert found.loads.sum(axis=1) == pytest.approx(LOAD, rel=1e-9)
    assert np.median(te(found), axis=0).max() * 1e6 == pytest.approx(9.5, rel=5e-3)
    assert te(found).max() * 1e6 == pytest.approx(67.8, rel=3e-3)
    known, plain = odd_gear("driver", Missing()), ordinary("driver")
    r, half = np.linspace(plain.lowest_radius, plain.highest_radius, 7)[1:-1], np.full(5, 4e-5)
    for i in (1, -1):
        more = known.own(i, r, half) / plain.self_compliance(r, half) - 1.0
        assert more.min() > 1.5e-3
        assert more.max() < 4e-3
        assert (known.own_error(i, r, half) > 0.0).all()
    across = known.between(1, -1, r, r) / plain.neighbour(2, r, r) - 1.0
    assert across[2, 2] == pytest.approx(-0.017, abs=1e-3)
    with pytest.raises(InputError, match="is missing"):
        known.own(0, r, half)


@pytest.mark.dear
def test_a_missing_tooth_has_no_root_stress():
    e, _ = without_tooth()
    largest = stress_over_revolution(e, LOAD, "driver", positions=12).largest
    assert largest[0] == 0.0
    assert max(largest[1], largest[-1]) > 1.3 * largest[10]  # one of them carries all where two did
    assert largest[5:20] == pytest.approx(largest[10], rel=1e-6)


@pytest.mark.dear
@pytest.mark.parametrize("member", MEMBERS)
def test_a_lower_tooth_ends_contact_at_its_own_tip(member):
    gear = PAIR.gear(member)
    tip = gear.tooth.tip_radius - 0.3
    known = odd_gear(member, OtherTip(tip), 3)
    order = -3 % gear.teeth if member == "driver" else 3
    flanks = {f"{member}_odd": {order: OddFlank(tip_radius=tip * 2e-3)}}
    found = over_revolution(engagement(known, corner_contact=False, **flanks), LOAD, 40)
    end, row = float(PAIR.x_of_radius(tip * 2e-3, member)), {int(j): n for n, j in enumerate(found.number)}
    shared = 0.0
    for number in (0, 1):
        x = found.x + number * PAIR.base_pitch
        on, other = (found.loads[(order + number) % gear.teeth, row[number]], found.loads[10, row[number]])
        beyond = x > end + 1e-9 if member == "driver" else x < end - 1e-9
        assert (on[beyond] == 0.0).all()
        inside = (other > 0.0) & ~beyond & (abs(x - end) > 1e-8)
        assert (on[inside] > 0.0).all()
        shared = max(shared, float(other[beyond].max(initial=0.0)))
    assert shared == pytest.approx(LOAD, rel=0.8)  # an ordinary tooth carries load where this one does not
    r, half = gear.module * np.linspace(gear.tooth.form_radius + 0.3, tip - 0.3, 4), np.full(4, 4e-5)
    more = known.own(3, r, half) / ordinary(member).self_compliance(r, half) - 1.0
    assert more[-1] > 1e-4  # by material that is gone
    assert more.min() > -5e-5
    assert more.max() < 3e-3


@pytest.mark.dear
def test_a_pit_of_no_share_and_no_depth_changes_nothing():
    usual = over_revolution(engagement(), LOAD, 12)
    for pit in (Pit(0.0, 1.0, 0.0, 1e-3), Pit(0.0, 1.0, 1.0, 0.0), Pit(0.0, 1.0, 0.0, 0.0), Pit(0.0, 1e-3, 1.0, 1e-3)):
        found = over_revolution(engagement(driver_odd={0: OddFlank(pits=(pit,))}), LOAD, 12)
        assert te(found) == pytest.approx(np.broadcast_to(te(usual), te(found).shape), rel=1e-13)


@pytest.mark.dear("driver")
@pytest.mark.parametrize("member", MEMBERS)
def test_a_pit_over_a_whole_flank_is_a_pitch_deviation_and_a_deep_one_leaves_no_tooth(member):
    depth, z = 3e-6, PAIR.gear(member).teeth
    spacing = np.zeros(z)
    spacing[4] = depth
    pit = over_revolution(engagement(**{f"{member}_odd": {4: OddFlank(pits=(Pit(0.0, 1.0, 1.0, depth),))}}), LOAD, 12)
    spaced = over_revolution(engagement(**{f"{member}_spacing": spacing}), LOAD, 12)
    assert te(pit) == pytest.approx(te(spaced), rel=1e-13)
    deep = over_revolution(engagement(**{f"{member}_odd": {4: OddFlank(pits=(Pit(0.0, 1.0, 1.0, 1e-2),))}}), LOAD, 12)
    gone = over_revolution(engagement(**{f"{member}_odd": {4: OddFlank(missing=True)}}), LOAD, 12)
    assert te(deep) == pytest.approx(te(gone), rel=1e-12)


@pytest.mark.parametrize("hertz", ["load-dependent", "linear"])
def test_a_pit_over_part_of_the_face_presses_the_rest_harder(hertz):
    """One pair in contact at the pitch point, against Weber's contact of each tooth on less of the face by hand."""
    share, x = 0.4, np.array([0.0])
    r = PAIR.driver.pitch_radius
    pit = OddFlank(pits=(Pit(r - 1e-4, r + 1e-4, share),))
    even, odd = (engagement(hertz=hertz, corner_contact=False, driver_odd=flanks) for flanks in ({}, {0: pit}))
    got, usual = (e.solve(e.grid(x), [LOAD]).transmission_error[0, 0] for e in (odd, even))
    alpha, nu, young, added = math.radians(20.0), 0.3, 206e9, 0.0
    relative = math.sin(alpha) / (1.0 / 25e-3 + 1.0 / 30e-3)
    for w, sign in ((LOAD / (1.0 - share) / 20e-3, 1.0), (LOAD / 20e-3, -1.0)):
        b = math.sqrt(4.0 * w * relative / math.pi * 2.0 * (1.0 - nu**2) / young)
        for z in (25, 30):
            half = math.pi / 2.0 / z
            h = z * 1e-3 * math.sin(half) / math.cos(alpha - half)
            added += sign * 2.0 * (1.0 - nu**2) / math.pi / young * w * (math.log(2.0 * h / b) - nu / (1.0 - nu) / 2.0)
    assert added > 0.1 * usual
    assert got - usual == pytest.approx(added, rel=1e-3)  # by hand for h >> b
    beside = odd.grid([4e-4])  # outside the pit
    assert float(odd.solve(beside, [LOAD]).transmission_error[0, 0]) == pytest.approx(
        float(even.solve(beside, [LOAD]).transmission_error[0, 0]), rel=1e-12
    )


def test_without_corner_contact_a_missing_tooth_leaves_positions_without_contact():
    with pytest.raises(InputError, match="leaves no tooth pair in contact"):
        over_revolution(engagement(driver_odd={0: OddFlank(missing=True)}, corner_contact=False), LOAD, 12)


def test_reversed_the_flanks_change_places():
    e = engagement(driver_odd={2: OddFlank(missing=True)})
    assert e.reversed().driven_odd == {2: OddFlank(missing=True)}
    assert e.reversed().driver_odd == {}
    assert e.cycles == e.reversed().cycles == 25


@pytest.mark.dear
def test_a_loaded_pair_takes_odd_flanks_and_says_what_its_gear_is():
    tip = PAIR.driver.tooth.tip_radius - 0.2
    shapes = {0: OtherTip(tip), 1: Missing()}
    known = solve_cracked_gear(ordinary("driver"), shapes)
    odd = ((0, OddFlank(tip_radius=tip * 2e-3)), (24, OddFlank(missing=True)))
    loaded = load(
        PairSpec(PAIR, loads=(LOAD,), corner_contact=True, driver=FlankSpec(odd=odd)), [known, ordinary("driven")]
    )
    assert "tooth 0 shorter, tooth 1 missing" in loaded.about
    found = loaded.over_revolution(8)
    assert found.transmission_error_error.min() > 0.0
    gone = found.loads[24, int(np.flatnonzero(found.number == 0)[0])]
    assert (gone == 0.0).all()


@pytest.mark.dear
def test_solved_shorter_and_missing_teeth_are_kept_on_disk(tmp_path):
    shapes = {0: OtherTip(PAIR.driver.tooth.tip_radius - 0.2), 1: Missing()}
    one = solve_cracked_gear(ordinary("driver"), shapes, cache=SolutionCache(Store(tmp_path)))
    cache = SolutionCache(Store(tmp_path))
    other = solve_cracked_gear(ordinary("driver"), shapes, cache=cache)
    assert cache.shapes.from_disk == 1
    assert other.fine.missing == one.fine.missing
    radii, half = [24e-3, 25e-3], np.full(2, 4e-5)
    for i in (0, 2):
        assert np.array_equal(one.own(i, radii, half), other.own(i, radii, half))
        assert np.array_equal(one.own_error(i, radii, half), other.own_error(i, radii, half))
    assert np.array_equal(one.between(0, 2, radii, radii), other.between(0, 2, radii, radii))


@pytest.mark.parametrize("off", [0.01, -2.2])
def test_tips_that_no_tooth_has_are_refused(off):
    with pytest.raises(InputError, match="must be a radius above the root form circle"):
        solve_cracked_gear(ordinary("driver"), {0: OtherTip(PAIR.driver.tooth.tip_radius + off)})


# ---- profiles of single teeth ----------------------------------------------------------------------------------------
def roll_of(gear, radius):
    return np.sqrt((np.asarray(radius) / gear.base_radius) ** 2 - 1.0)


def toward_tip(member, amount, power=2.0):
    """A deviation that grows from the pitch circle to the tip, in many straight pieces."""
    one = PAIR.gear(member)
    roll = roll_of(one, np.linspace(one.pitch_radius, one.involute_tip_radius, 9))
    share = (roll - roll[0]) / (roll[-1] - roll[0])
    return TabulatedRelief(roll, amount * share**power)


def each_pitch(e, x, cycles):
    return np.array([e.solve(e.grid(x), [LOAD], cycle).transmission_error[:, 0] for cycle in cycles])


@pytest.mark.parametrize("member", MEMBERS)
def test_a_profile_deviation_of_zero_changes_nothing_to_the_last_bit(member):
    ground = {f"{one}_relief": toward_tip(one, 6e-6) for one in MEMBERS}
    usual, x = engagement(**ground), np.linspace(PAIR.x_start, PAIR.x_start + PAIR.base_pitch, 23)[:-1]
    for flank in (OddFlank(deviation=toward_tip(member, 0.0)), OddFlank()):
        e = engagement(**ground, **{f"{member}_odd": {3: flank}})
        assert np.array_equal(each_pitch(e, x, range(7)), np.broadcast_to(each_pitch(usual, x, [0]), (7, x.size)))


@pytest.mark.parametrize("member", MEMBERS)
@pytest.mark.parametrize("as_deviation", [False, True])
def test_the_same_profile_on_every_tooth_is_the_gears_own_relief(member, as_deviation):
    own = [toward_tip(member, 8e-6) for _ in range(PAIR.gear(member).teeth)]  # alike, not the same
    flanks = {n: OddFlank(deviation=one) if as_deviation else OddFlank(relief=one) for n, one in enumerate(own)}
    other = {"driven": "driver", "driver": "driven"}[member]
    ground = {f"{other}_relief": toward_tip(other, 5e-6)}
    if not as_deviation:
        ground[f"{member}_relief"] = toward_tip(member, 40e-6)  # of no tooth
    found = over_revolution(engagement(**ground, **{f"{member}_odd": flanks}), LOAD, 12)
    ground[f"{member}_relief"] = toward_tip(member, 8e-6)
    usual = over_revolution(engagement(**ground), LOAD, 12)
    assert found.solved == 1
    assert te(found).shape[0] == PAIR.gear(member).teeth
    at = np.searchsorted(found.x, usual.x)
    assert found.x[at] == pytest.approx(usual.x, rel=1e-12)
    assert te(found)[:, at] == pytest.approx(np.broadcast_to(te(usual), (te(found).shape[0], at.size)), rel=1e-13)


@pytest.mark.parametrize("member", MEMBERS)
def test_an_even_profile_deviation_is_a_pitch_deviation_of_its_tooth(member):
    """To the last bit; teeth that are counted the wrong way round, or from another one, are not."""
    one, x = PAIR.gear(member), np.linspace(PAIR.x_start, PAIR.x_start + PAIR.base_pitch, 23)[:-1]
    even = TabulatedRelief(roll_of(one, [one.pitch_radius, one.involute_tip_radius]), np.full(2, 3e-6))
    spacing = np.zeros(one.teeth)
    spacing[4] = 3e-6
    spaced = each_pitch(engagement(**{f"{member}_spacing": spacing}), x, range(one.teeth))
    found = each_pitch(engagement(**{f"{member}_odd": {4: OddFlank(deviation=even)}}), x, range(one.teeth))
    assert np.array_equal(found, spaced)
    for wrong in (one.teeth - 4, 3, 5):
        off = each_pitch(engagement(**{f"{member}_odd": {wrong: OddFlank(deviation=even)}}), x, range(one.teeth))
        assert np.abs(off - spaced).max() > 1e-6


def by_two_pairs(cycle, x, member, tooth, deviation):
    """Transmission error and loads of pairs 0 and 1 by hand: compliances of solved gears, Hertz's widths, a root."""
    alpha, width, nu, young = math.radians(20.0), 20e-3, 0.3, 206e9
    gears = PAIR.driver, PAIR.driven
    solved = ordinary("driver"), ordinary("driven")
    along = x + PAIR.base_pitch * np.arange(2)
    lengths = [g.base_radius * math.tan(alpha) + sign * along for g, sign in zip(gears, (1.0, -1.0), strict=True)]
    radii = [np.hypot(g.base_radius, length) for g, length in zip(gears, lengths, strict=True)]
    relative = 1.0 / (1.0 / lengths[0] + 1.0 / lengths[1])
    apart = np.zeros(2)
    pair = cycle - tooth
    if pair in (0, 1):
        which = MEMBERS.index(member)
        roll = lengths[which][pair] / gears[which].base_radius
        apart[pair] = np.interp(roll, deviation.roll, deviation.values)
    between = solved[0].neighbour(-1, radii[0][:1], radii[0][1:]) + solved[1].neighbour(1, radii[1][:1], radii[1][1:])

    def deflections(first):
        loads = np.array([first, LOAD - first]) / width
        half = np.sqrt(np.maximum(8.0 * loads * relative * (1.0 - nu**2) / math.pi / young, 1e-18))
        own = sum(one.self_compliance(r, half) for one, r in zip(solved, radii, strict=True))
        return own * loads + between[0, 0] * loads[::-1] + apart

    shared = brentq(lambda first: np.diff(deflections(first))[0], 1e-6 * LOAD, (1.0 - 1e-6) * LOAD, xtol=1e-9)
    return float(deflections(shared)[0]), np.array([shared, LOAD - shared])


@pytest.mark.parametrize("member", MEMBERS)
def test_one_ground_tooth_beside_a_contact_of_two_pairs_by_hand(member):
    deviation, tooth = toward_tip(member, 7e-6, power=1.0), 4
    e = engagement(corner_contact=False, **{f"{member}_odd": {tooth: OddFlank(deviation=deviation)}})
    two = PAIR.contact_ratio - 1.0  # of the base pitch
    x = PAIR.x_start + PAIR.base_pitch * two * np.array([0.2, 0.8])
    most = 0.0
    for cycle in (4, 5):
        state = e.solve(e.grid(x), [LOAD], cycle)
        row = [int(np.flatnonzero(state.grid.contacts.number == n)[0]) for n in (0, 1)]
        for n, place in enumerate(x):
            wanted, loads = by_two_pairs(cycle, place, member, tooth, deviation)
            assert state.transmission_error[n, 0] == pytest.approx(wanted, rel=3e-4)
            assert state.loads[row, n, 0] == pytest.approx(loads, abs=1e-3 * LOAD)
            plain, _ = by_two_pairs(3, place, member, tooth, deviation)
            most = max(most, abs(wanted / plain - 1.0))
    assert most > 0.05  # it shows


def test_a_tooth_has_its_own_relief_in_place_of_the_gears_and_a_deviation_beside_it():
    """By a spec: in which pitches, and nothing of it where the effect is off; Welbourn's Delta of the gear counts."""
    tip = TipReliefSpec(amount_over_delta=1.0, normalised_length=1.0)
    deviation = ReliefSpec(tables=(toward_tip("driver", 4e-6),))
    profiles = (
        (2, ToothProfile(relief=ReliefSpec())),
        (5, ToothProfile(deviation=deviation)),
        (9, ToothProfile(relief=ReliefSpec(tip=(tip,)))),
    )
    flank = FlankSpec(relief=ReliefSpec(tip=(tip,)), profiles=profiles)
    spec = PairSpec(PAIR, loads=(LOAD,), relief=True, driver=flank)
    loaded = load(spec, [ordinary("driver"), ordinary("driven")], estimates=False)
    e, x = loaded.engagement, np.array([PAIR.x_end - 0.01 * PAIR.base_pitch])
    contacts = e.grid(x).contacts
    row = int(np.abs(contacts.x[:, 0] - x[0]).argmin())
    pair = int(contacts.number[row])
    off = {tooth: float(e.modification(contacts, tooth + pair)[row, 0]) for tooth in (0, 2, 5, 9)}
    assert off[0] == off[9] > 5e-6
    assert off[2] == 0.0
    beside = toward_tip("driver", 4e-6).removal(contacts.roll_driver[row])
    assert off[5] - off[0] == pytest.approx(float(beside[0])) != 0.0
    assert e.unmodified().modification(contacts, 5 + pair).max() == 0.0
    plain = load(replace(spec, relief=False), [ordinary("driver"), ordinary("driven")], estimates=False).engagement
    assert plain.odd is None
    assert e.breaks != plain.breaks


def test_a_profile_that_no_tooth_has_is_refused_under_its_key():
    deep = ToothProfile(deviation=ReliefSpec(tables=(toward_tip("driver", 5e-3),)), prefix="gear.a.odd_tooth[0]")
    spec = PairSpec(PAIR, loads=(LOAD,), relief=True, driver=FlankSpec(profiles=((0, deep),)))
    with pytest.raises(InputError, match=r"gear\.a\.odd_tooth\[0\]\.deviation = 5000 um .* times the maximum"):
        load(spec, [ordinary("driver"), ordinary("driven")], estimates=False)


def test_neighbours_are_softer_by_the_largest_error_of_their_flanks_which_is_that_at_the_tips():
    """Made to rise with both radii: the whole of what is said at the tips counts, on every pair of teeth its own."""

    class Rising:
        gear, middle, fine = odd_gear("driver", Missing()).gear, odd_gear("driver", Missing()).middle, None

        def between_error(self, i, j, radius_p, radius_q):
            assert (i, j) != (self.middle, self.middle)
            return 1e-12 * (4.0 + i - self.middle) * (np.asarray(radius_p) + np.asarray(radius_q))

    base = odd_compliance(odd_gear("driver", Missing()))
    shifted = odd_neighbours_shifted_by_error(replace(base, influence=Rising()))
    tip = base.influence.ordinary.highest_radius
    assert base.series
    for (i, j), series in shifted.series.items():
        raised = series - base.series[i, j]
        assert raised[0, 0] == pytest.approx(2e-12 * (4.0 + i) * tip, rel=1e-9)
        assert np.count_nonzero(raised) == 1
