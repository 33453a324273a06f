"""Solid gears with odd teeth: laws of their rings and contacts, and the limit of plane teeth."""

import functools
import math
from itertools import product

import numpy as np
import pytest

from fegear.base.errors import InputError, RangeError
from fegear.base.solution_cache import cache_on_disk
from fegear.contact.odd_flank import OddFlank, Pit, ToothProfile
from fegear.contact.pair_spec import FlankSpec, PairSpec
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.odd_compliance import odd_compliance
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.stress_over_revolution import stress_over_revolution
from fegear.contact.wide.over_revolution import follow_flanks, revolving_flanks, wide_over_revolution
from fegear.contact.wide.root_stress import places_along, rooted_lines
from fegear.contact.wide.stress_over_revolution import wide_stress_over_revolution
from fegear.contact.wide_spec import WideSpec
from fegear.fem.plane.odd.crack import mouth_at_tangent, straight_crack
from fegear.fem.plane.odd.cracked_sector import cracked_sector
from fegear.fem.plane.odd.odd_influence import solve_odd_influence
from fegear.fem.plane.odd.odd_solution import solve_cracked_gear
from fegear.fem.plane.odd.other_outline import Missing
from fegear.fem.plane.odd.tooth_kind import OddTooth
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.fem.solid.bands import bands
from fegear.fem.solid.odd.odd_solid_influence import odd_solid_influence
from fegear.fem.solid.odd.odd_solid_solution import solve_odd_solid
from fegear.fem.solid.sector import section_mesh
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.gear_body import GearBody
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief_spec import ReliefSpec, TipReliefSpec

SETTINGS = SolidSettings().scaled(1.7)
TOOTH = Tooth(19, BasicRack(1.0, 1.25, 0.25), profile_shift=0.1)
BORE, TAU = 0.6 * TOOTH.root_radius, math.tan(math.radians(15.0)) / 9.5
CRACK = straight_crack(TOOTH, mouth_at_tangent(TOOTH, math.radians(30.0)), math.radians(70.0), depth=0.5)
RADII = np.array([9.0, 9.6, 10.2])
MODULE, LOAD = 3e-3, 2000.0


def solid(odd, tau=0.0, width=3.0, **how):
    return solve_odd_solid(TOOTH, tau, width, 0.3, BORE, SETTINGS, odd=odd, **{"reach": 2, **how})


def band(half_width=0.2, reach=1.0, z=0.2):
    return bands(RADII, z, reach, half_width)


@pytest.mark.dear("0.0", "0.028205178150644494")
@pytest.mark.parametrize("tau", [0.0, TAU])
def test_a_healthy_odd_tooth_is_the_plain_ring(tau):
    plain = solve_solid(TOOTH, tau, 3.0, 0.3, BORE, SETTINGS, reach=2)
    found = solid({4: section_mesh(TOOTH, BORE, SETTINGS.section, None, frontal=True)}, tau)
    own, scale = band(), float(plain.deflection(0, band(), band()).max())
    for i, j in product(range(2, 7), repeat=2):
        if abs(i - j) <= 2:
            assert found.deflection(i, j, own, own) == pytest.approx(
                plain.deflection(i - j, own, own), abs=1e-9 * scale
            )
    for i, side in product((3, 4, 5), ("tension", "compression")):
        stress = found.largest_root_stress(i, 4, side, own, [0.0, 1.3])
        for value, usual in zip(stress, plain.largest_root_stress(i - 4, side, own, [0.0, 1.3]), strict=True):
            assert value == pytest.approx(usual, abs=1e-9)


@pytest.fixture(scope="module")
def cracked():
    return solid({4: CRACK}, TAU)


def test_couplings_are_reciprocal_and_the_cracked_tooth_is_softer(cracked):
    own = band()
    for i, j in product(range(2, 7), repeat=2):
        if abs(i - j) <= 2:
            here, there = cracked.deflection(i, j, own, own), cracked.deflection(j, i, own, own)
            assert here == pytest.approx(there.T, rel=1e-12)
    loss = cracked.deflection(4, 4, own, own) - cracked.usual.deflection(0, own, own)
    assert (loss > 0.0).all()  # a crack with open faces takes stiffness away
    assert np.diag(loss).argmax() == 2
    assert cracked.deflection(4, 5, own, own)[1, 1] < cracked.usual.deflection(-1, own, own)[1, 1]
    assert cracked.deflection(4, 3, own, own)[1, 1] > cracked.usual.deflection(1, own, own)[1, 1]


def test_teeth_far_from_odd_ones_are_ordinary_and_numbers_go_round(cracked):
    z, own = TOOTH.teeth, band()
    assert cracked.period == z
    assert len({cracked.same_as(first, 1) for first in range(z)}) == 6  # the tooth, two on either side, all others
    assert cracked.same_as(4 + z, 3) == cracked.same_as(4, 3)
    for i, j in ((10, 11), (7, 9), (1, 0)):
        assert cracked.deflection(i, j, own, own) == pytest.approx(cracked.usual.deflection(i - j, own, own), rel=1e-12)
    assert cracked.deflection(4 + z, 5 + z, own, own) == pytest.approx(cracked.deflection(4, 5, own, own), rel=0.0)
    ordinary = cracked.usual.deflection(0, own, own)
    assert cracked.deflection(6, 6, own, own) == pytest.approx(ordinary, rel=5e-4)
    assert cracked.deflection(6, 6, own, own) != pytest.approx(ordinary, rel=1e-6)


@pytest.mark.dear
def test_two_cracked_teeth_far_apart_are_rings_of_their_own(cracked):
    both, own = solid({4: CRACK, 13: CRACK}, TAU), band()
    assert len(both.windows) == 2
    for i in (3, 4, 5):
        assert both.deflection(i, 4, own, own) == pytest.approx(cracked.deflection(i, 4, own, own), rel=1e-12)
        assert both.deflection(i + 9, 13, own, own) == pytest.approx(cracked.deflection(i, 4, own, own), rel=1e-12)
    beside = solid({18: CRACK, 0: CRACK}, TAU)
    assert len(beside.windows) == 1
    assert beside.deflection(18, 18, own, own)[1, 1] != beside.deflection(0, 0, own, own)[1, 1]


@pytest.mark.dear
def test_without_motion_along_the_axis_it_is_the_plane_ring():
    """The same section mesh and order, loads even along the face: what a crack changes of c_ij is that of plane strain.

    But of the loads on its own tooth: they have narrower bands than edges of the flank, which the cracked section has
    others of than the ordinary one.
    """
    width = 3.0
    found = solid({0: CRACK}, plane_strain=True, width=width)
    mesh, settings = section_mesh(TOOTH, BORE, SETTINGS.section, None, frontal=True), SETTINGS.section
    cracked, ordinary = (
        solve_odd_influence(TOOTH, mesh, {0: OddTooth(TOOTH, one)}, 0.3, "strain", settings)
        for one in (cracked_sector(TOOTH, BORE, settings, CRACK), mesh)
    )
    own = bands(RADII, 0.0, 0.5 * width, 0.1, profile="even")
    largest = float(width * found.deflection(0, 0, own, own).max())
    for i, j in product((-2, -1, 0, 1, 2), repeat=2):
        if abs(i - j) <= 2 and (i, j) != (0, 0):
            change = width * (found.deflection(i, j, own, own) - found.usual.deflection(i - j, own, own))
            expected = cracked.between(i, j, RADII, RADII, 0.1) - ordinary.between(i, j, RADII, RADII, 0.1)
            assert change == pytest.approx(expected, abs=4e-5 * largest)
            assert i * j or np.abs(change).max() > 1e-3 * largest


@pytest.mark.dear
def test_a_missing_tooth_softens_the_next_ones_a_little():
    found, own = solid({4: Missing()}), band()
    for i in (3, 5):
        ratio = found.deflection(i, i, own, own) / found.usual.deflection(0, own, own)
        assert (ratio > 1.0).all()
        assert (ratio < 1.01).all()
    assert found.deflection(3, 5, own, own)[1, 1] < found.usual.deflection(-2, own, own)[1, 1]
    with pytest.raises(RangeError, match="missing"):
        found.fillet_stress(4, 5, "tension", own, [0.0])


@pytest.mark.dear
def test_what_cannot_be_is_refused():
    for odd, said in (({}, "at least one tooth"), ({1: CRACK, 20: CRACK}, "twice")):
        with pytest.raises(InputError, match=said):
            solid(odd)
    other = section_mesh(TOOTH, BORE, SETTINGS.section.scaled(0.6), None, frontal=True)
    with pytest.raises(InputError, match="other nodes"):
        solid({0: other})


@pytest.mark.dear
def test_it_is_recalled_from_disk_bit_for_bit(tmp_path):
    def solved(cache):
        return odd_solid_influence(
            TOOTH, 0.0, 3.0, 0.3, BORE, SETTINGS, {0: CRACK}, estimate_error=False, cache=cache
        ).fine  # fmt: skip

    first, again = solved(cache_on_disk(tmp_path)), cache_on_disk(tmp_path)
    second = solved(again)
    assert again.shapes.from_disk == 1
    for i in (0, 1):
        assert np.array_equal(first.deflection(i, 0, band(), band()), second.deflection(i, 0, band(), band()))
        assert np.array_equal(*(x.fillet_stress(i, 0, "tension", band(), [0.1]) for x in (first, second)))


@pytest.mark.dear
def test_teeth_on_rim_and_web_crack_as_well():
    body = GearBody(7.2, 4.5, (-0.4, 0.4), (-1.0, 1.0))
    coarse = SolidSettings().scaled(2.5)
    found = solve_odd_solid(TOOTH, 0.0, 2.0, 0.3, BORE, coarse, odd={0: CRACK}, reach=1, body=body)
    own = band(0.3, 0.6)
    assert found.deflection(0, 0, own, own)[1, 1] > 1.05 * found.usual.deflection(0, own, own)[1, 1]


# ---- in mesh -------------------------------------------------------------------------------------------------------
def gear(hand, teeth, beta):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), helix_angle=math.radians(beta))
    steel = Material(206.8e9, 0.3, 7850.0)
    return Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, 9e-3, steel, "strain", hand if beta else "spur")


def made(one, odd=None, **how):
    m = one.module
    parts = one.symmetric_tooth, one.flank_twist * m, one.face_width / m, 0.3, one.bore_radius / m, SETTINGS
    return solve_odd_solid(*parts, odd=odd, reach=3, **how) if odd else solve_solid(*parts, reach=3, **how)


def together_at(*each):
    """Transmission errors over the positions that several have in common."""
    common = functools.reduce(np.intersect1d, [one.x for one in each])
    return [one.transmission_error[:, np.isin(one.x, common)] for one in each]


class Mesh:
    """Two gears, solved, and their cracked likes."""

    def __init__(self, beta):
        self.gears = {"driver": gear("right", 20, beta), "driven": gear("left", 23, beta)}
        self.pair, self.plain = GearPair(*self.gears.values()), {m: made(one) for m, one in self.gears.items()}
        self.crack = {}
        for member, one in self.gears.items():
            tooth = one.symmetric_tooth
            mouth = mouth_at_tangent(tooth, math.radians(30.0))
            self.crack[member] = straight_crack(tooth, mouth, math.radians(70.0), depth=0.8)

    def cracked(self, member, number):
        return {**self.plain, member: made(self.gears[member], {number: self.crack[member]})}

    def revolving(self, gears=None, positions=12, **how):
        spec = PairSpec(self.pair, (LOAD,), width="solid", wide=WideSpec(panels=8), **how)
        return revolving_flanks(spec, gears or self.plain, None, positions=positions)

    def over(self, gears=None, positions=12, **how):
        return wide_over_revolution(self.revolving(gears, positions, **how))

    def roots(self, member, gears=None, side="tension"):
        return wide_stress_over_revolution(follow_flanks(self.revolving(gears)), member, side)


@pytest.fixture(scope="module")
def spur():
    return Mesh(0.0)


@pytest.fixture(scope="module")
def helical():
    return Mesh(15.0)


@pytest.mark.dear
@pytest.mark.parametrize(("mesh", "member"), [("spur", "driver"), ("helical", "driven")])
def test_a_crack_shows_in_the_base_pitches_in_which_it_is_loaded(mesh, member, request):
    mesh, order = request.getfixturevalue(mesh), 6
    z = mesh.gears[member].teeth
    number = -order if member == "driver" else order  # meshing order of a tooth by its own number
    found = mesh.over(mesh.cracked(member, number))
    assert found.transmission_error.shape[0] == z
    assert found.solved <= 9
    assert found.loads.sum(axis=1) == pytest.approx(LOAD, rel=1e-9)
    here, usually = together_at(found, mesh.over())
    assert here.shape[1] >= 12
    assert np.median(here, axis=0) == pytest.approx(usually[0], rel=1e-6)
    off = np.abs(found.residual).max(axis=1)
    # tooth n of either gear is on pair 0 in base pitch n, on the pairs beside it before and after
    assert off.argmax() in (order, order - 1, order + 1)
    assert off[[(order + k) % z for k in range(5, z - 4)]].max() < 2e-3 * off.max()
    cycle = int(np.abs(found.residual).max(axis=1).argmax())
    on = found.number == cycle - order
    shares, usual = found.loads[cycle] / LOAD, found.loads[(order + 10) % z] / LOAD
    assert on.any()
    assert (shares[on] <= usual[on] + 1e-9).all()  # the cracked tooth carries less
    assert 0.05 < found.stiffness_loss < 0.5


@pytest.mark.dear
def test_both_ways_of_a_spur_pair_see_the_same_crack(spur):
    """Teeth counted the wrong way round, or flanks mistaken, would change the transmission error."""
    gears = spur.cracked("driver", 0)
    found = spur.over(gears)
    reversed_pair = GearPair(spur.gears["driven"], spur.gears["driver"])
    spec = PairSpec(reversed_pair, (LOAD,), width="solid", wide=WideSpec(panels=8))
    other = {"driver": gears["driven"], "driven": gears["driver"]}
    again = wide_over_revolution(revolving_flanks(spec, other, None, positions=12))
    assert again.transmission_error.max() == pytest.approx(found.transmission_error.max(), rel=2e-3)
    assert again.lowest_stiffness == pytest.approx(found.lowest_stiffness, rel=2e-3)


@pytest.mark.dear
def test_flanks_of_single_teeth(spur):
    relief = ReliefSpec((TipReliefSpec(amount=20e-6, start_roll_angle=math.radians(22.0)),))
    plain, one = spur.over(), ToothProfile(deviation=relief)
    low, high = spur.gears["driver"].involute_radii
    all_over = OddFlank(pits=(Pit(0.9 * low, 1.1 * high, 1.0, 5e-6),))
    pitted = spur.over(driver=FlankSpec(odd=((3, all_over),)))
    spacing = np.zeros(20)
    spacing[3] = 5e-6
    spaced = spur.over(driver=FlankSpec(spacing=spacing))
    assert pitted.transmission_error == pytest.approx(spaced.transmission_error, rel=1e-9)
    assert np.ptp(plain.transmission_error, axis=0).max() < 1e-12
    nothing = spur.over(driver=FlankSpec(odd=((3, OddFlank(pits=(Pit(low, high, 1.0, 0.0),))),)))
    assert np.array_equal(nothing.transmission_error[0], plain.transmission_error[0])
    ground = spur.over(driver=FlankSpec(profiles=((3, one),)))
    every = spur.over(driver=FlankSpec(relief=relief))
    assert np.abs(ground.residual).max(axis=1).argmax() in (2, 3, 4)
    here, usually = together_at(ground, plain)
    assert np.array_equal(np.median(here, axis=0), usually[0])
    all_teeth = spur.over(driver=FlankSpec(profiles=tuple((n, one) for n in range(20))))
    here, usually = together_at(all_teeth, every)
    assert here == pytest.approx(np.tile(usually[0], (20, 1)), rel=1e-12)


@pytest.mark.dear
def test_a_pit_over_a_part_of_the_face_leaves_the_load_beside_it(spur):
    low, high = spur.gears["driver"].involute_radii
    pits = [
        spur.over(driver=FlankSpec(odd=((3, OddFlank(pits=(Pit(low, high, share, 0.0, z),))),)))
        for share, z in ((0.3, 0.0), (0.5, 0.0), (0.3, 2.2e-3), (0.3, -2.2e-3))
    ]
    largest = [float(one.residual.max()) for one in pits]
    assert 0.0 < largest[0] < largest[1]
    assert largest[2] == pytest.approx(largest[3], rel=1e-6)  # mirrored at the middle of the face
    assert abs(largest[2] / largest[0] - 1.0) > 0.05
    deep = spur.over(driver=FlankSpec(odd=((3, OddFlank(pits=(Pit(low, high, 0.3, 1e-3),))),)))
    assert deep.transmission_error == pytest.approx(pits[0].transmission_error, rel=2e-3)


@pytest.mark.dear
def test_beside_a_missing_tooth_tip_edges_carry(spur):
    gone = FlankSpec(odd=((4, OddFlank(missing=True)),))
    gears = {**spur.plain, "driver": made(spur.gears["driver"], {-4: Missing()})}
    with pytest.raises(InputError, match="leaves no tooth pair in contact"):
        spur.over(gears, driver=gone, corner_contact=False)
    found = spur.over(gears, driver=gone, corner_contact=True)
    for cycle in range(20):
        on = found.number == cycle - 4
        assert (found.loads[cycle, on] == 0.0).all()
    ordinary = np.median(found.transmission_error, axis=0)
    assert found.transmission_error.max() > 3.0 * ordinary.max()
    assert found.loads.sum(axis=1) == pytest.approx(LOAD, rel=1e-9)


@pytest.mark.dear
def test_extreme_values_stand_where_more_positions_find_them(spur):
    """With contact at tip edges, where the curves have kinks and jumps at places that only the loads know."""
    gears = spur.cracked("driver", 6)
    few, many = (spur.over(gears, positions, corner_contact=True) for positions in (24, 192))
    for found, truth, left in (
        (few.lowest_stiffness, many.lowest_stiffness, few.beyond.stiffness),
        (few.ordinary_lowest_stiffness, many.ordinary_lowest_stiffness, few.beyond.ordinary_stiffness),
        (few.largest_error, many.largest_error, few.beyond.transmission_error),
        (few.largest_residual, many.largest_residual, few.beyond.residual),
    ):
        assert abs(found - truth) <= 1.5 * left + 5e-4 * truth
        assert found == pytest.approx(truth, rel=4e-3)
    bare = few.transmission_error[:, np.isin(few.x, spur.revolving(gears, 24, corner_contact=True).flanks.roll)]
    assert bare.shape[1] < few.x.size  # without places that are added the largest is missed
    assert few.largest_error > (1.0 + 1e-4) * bare.max()


# ---- root stress of each tooth -------------------------------------------------------------------------------------
@pytest.mark.dear
@pytest.mark.parametrize(("mesh", "member"), [("spur", "driver"), ("helical", "driven")])
def test_root_stress_of_a_tooth_that_differs_in_nothing_is_that_of_all_others(mesh, member, request):
    """And that of all others is the ordinary root stress over the face, the largest of a base pitch."""
    mesh = request.getfixturevalue(mesh)
    one, followed = mesh.gears[member], follow_flanks(mesh.revolving())
    like = section_mesh(one.symmetric_tooth, one.bore_radius / MODULE, SETTINGS.section, None, frontal=True)
    odd = follow_flanks(mesh.revolving({**mesh.plain, member: made(one, {6: like})}))
    assert len(odd.pitches) > 5
    for side, sign in (("tension", 1.0), ("compression", -1.0)):
        alike = wide_stress_over_revolution(followed, member, side)
        state = followed.flanks.solve([LOAD], known=followed.flanks.compliance(LOAD, alike.x))
        rooted = rooted_lines(mesh.pair, member, state.lines, mesh.plain[member], coupling=True)
        z = places_along(state.lines, MODULE)
        usual = sign * (sign * rooted.stress(side, state.contact.force[:, :, 0], z).largest(sign)[0]).max()
        assert alike.largest == pytest.approx([usual], rel=1e-12)
        found = wide_stress_over_revolution(odd, member, side)
        assert found.teeth == one.teeth
        assert found.largest == pytest.approx(np.full(one.teeth, usual), rel=1e-10)


@pytest.mark.dear
@pytest.mark.parametrize(("mesh", "member"), [("spur", "driver"), ("helical", "driven")])
def test_root_stress_of_a_cracked_tooth_falls_and_its_number_is_the_right_one(mesh, member, request):
    mesh = request.getfixturevalue(mesh)
    found = mesh.roots(member, mesh.cracked(member, 6)).largest
    usual = float(np.median(found))
    assert found.argmin() == 6
    assert found[6] < 0.4 * usual  # the crack takes the stress away on either side of its mouth
    beside = found[[5, 7]] / usual - 1.0
    assert np.abs(beside).max() < 0.02
    assert np.abs(beside).min() > 5e-4
    far = np.setdiff1d(np.arange(mesh.gears[member].teeth), np.arange(2, 11))
    assert found[far] == pytest.approx(np.full(far.size, usual), rel=1e-6)


@pytest.mark.dear
def test_root_stress_without_motion_along_the_axis_is_that_of_plane_teeth(spur):
    """What a crack changes of each tooth's largest stress, by the plane ring and its own contact."""
    number, driver = 6, spur.gears["driver"]
    odd = made(driver, {number: spur.crack["driver"]}, plane_strain=True)
    found = spur.roots("driver", {"driver": odd, "driven": made(spur.gears["driven"], plane_strain=True)})
    usual = float(np.median(found.largest))
    found, left = found.largest / usual, float(found.beyond.max()) / usual
    plane = {m: solve_gear(one, settings_at(-3), reach=2, estimate_error=False) for m, one in spur.gears.items()}
    cracked = solve_cracked_gear(plane["driver"], {number: spur.crack["driver"]})
    driven = finite_element_compliance(plane["driven"])
    before, after = (
        stress_over_revolution(Engagement(PairCompliance(spur.pair, one, driven)), LOAD, "driver", positions=24).largest
        for one in (finite_element_compliance(plane["driver"]), odd_compliance(cracked))
    )
    off = np.abs(found - after / before)
    assert off[number] < 0.01  # the largest stress is beside the crack's mouth
    assert np.delete(off, number).max() < 2e-4 + left  # the largest of both are looked for between their own positions
    assert left < 3e-4
    assert np.abs(after / before - 1.0)[[number - 1, number + 1]].min() > 2e-3


@pytest.mark.dear
def test_stress_intensity_without_motion_along_the_axis_is_that_of_the_plane():
    """Loads even along the face: K of plane strain at every place, and no K_III."""
    width = 3.0
    found = solid({0: CRACK}, plane_strain=True, width=width, intensity=True)
    mesh, settings = section_mesh(TOOTH, BORE, SETTINGS.section, None, frontal=True), SETTINGS.section
    sector = cracked_sector(TOOTH, BORE, settings, CRACK)
    plane = solve_odd_influence(TOOTH, mesh, {0: OddTooth(TOOTH, sector)}, 0.3, "strain", settings)
    own = bands(RADII[1:], 0.0, 0.5 * width, 0.1, profile="even")
    for j in (-1, 0, 1):
        value, error = found.stress_intensity(0, j, own, [-1.2, 0.0, 0.7])
        expected = plane.by_ring(0, j, RADII[1:], 0.1)[0] / width
        largest = np.hypot(*expected).max()
        assert np.abs(value - value[:, :1]).max() < 1e-10 * largest
        assert np.abs(value[:2, 0] - expected).max() < 2e-3 * largest
        assert np.abs(value[2]).max() < 1e-10 * largest
        assert error.max() < 5e-3 * largest
    with pytest.raises(RangeError, match="intensity=True"):
        found.stress_intensity(1, 1, own, [0.0])
    with pytest.raises(RangeError, match="outside the face width"):
        found.stress_intensity(0, 0, own, [2.0])
    with pytest.raises(InputError, match="spur gears only"):
        solid({0: CRACK}, TAU, intensity=True)


@pytest.mark.dear
def test_stress_intensity_along_the_front_gives_back_the_energy():
    """A load off the middle of the face, three modes: int G dz = dc/da / 2, and a mirrored load mirrors them."""
    settings, width, step = SolidSettings().scaled(1.2), 3.0, 0.06
    one, mirrored = (bands(np.array([10.2]), z, 0.5, 0.2) for z in (0.4, -0.4))

    def solved(depth, **how):
        crack = straight_crack(
            TOOTH, mouth_at_tangent(TOOTH, math.radians(30.0)), math.radians(70.0), depth=depth
        )  # fmt: skip
        return solve_odd_solid(TOOTH, 0.0, width, 0.3, BORE, settings, odd={0: crack}, reach=1, **how)

    low, high = (solved(0.5 + off).deflection(0, 0, one, one)[0, 0] for off in (-step, step))
    found = solved(0.5, intensity=True)
    x, weight = np.polynomial.legendre.leggauss(20)
    k, error = (values[:, :, 0] for values in found.stress_intensity(0, 0, one, 0.5 * width * x))
    release = (1.0 - 0.3**2) * (k[0] ** 2 + k[1] ** 2) + (1.0 + 0.3) * k[2] ** 2
    assert 0.5 * width * weight @ release == pytest.approx(0.5 * (high - low) / (2.0 * step), rel=4e-3)
    assert np.abs(k[2]).max() > 0.05 * k[0].max()
    assert error.max() < 0.02 * k[0].max()
    other = found.stress_intensity(0, 0, mirrored, -0.5 * width * x)[0][:, :, 0]
    assert other == pytest.approx(k * np.array([[1.0], [1.0], [-1.0]]), abs=1e-9 * k[0].max())
