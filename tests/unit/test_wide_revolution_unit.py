"""Pairs with a width over whole revolutions, coarse: which tooth a crack shows on, loads, roots, what errors are of."""

import math
from dataclasses import dataclass, replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.contact.pair_spec import FlankSpec, PairSpec
from fegear.contact.plane.stress_over_revolution import peak_positions
from fegear.contact.wide.over_revolution import _far_enough, follow_flanks, revolving_flanks
from fegear.contact.wide.stress_over_revolution import _stress, usual_errors, wide_stress_over_revolution
from fegear.contact.wide_spec import WideSpec
from fegear.fem.plane.odd.crack import mouth_at_tangent, straight_crack
from fegear.fem.solid.odd.odd_solid import OddSolid
from fegear.fem.solid.odd.odd_solid_solution import solve_odd_solid
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

MODULE, LOAD, CRACKED, Z = 3e-3, 2000.0, 4, 13
SETTINGS, PITCHES = SolidSettings().scaled(3.0), np.arange(Z)


def gear(teeth):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), profile_shift=0.2)
    return Gear(tooth, MODULE, 0.6 * tooth.root_radius * MODULE, 6e-3, Material(206.8e9), "strain", "spur")


def solved(one, odd=None):
    m = one.module
    parts = one.symmetric_tooth, 0.0, one.face_width / m, 0.3, one.bore_radius / m, SETTINGS
    return solve_odd_solid(*parts, odd=odd, reach=2) if odd else solve_solid(*parts, reach=2)


PAIR = GearPair(gear(Z), gear(14))
SPEC = PairSpec(PAIR, (LOAD,), width="solid", corner_contact=False, wide=WideSpec(panels=4))


@pytest.fixture(scope="module")
def plain():
    return {"driver": solved(PAIR.driver), "driven": solved(PAIR.driven)}


@pytest.fixture(scope="module")
def cracked(plain):
    tooth = PAIR.driver.symmetric_tooth
    crack = straight_crack(tooth, mouth_at_tangent(tooth, math.radians(30.0)), math.radians(70.0), depth=0.8)
    return {**plain, "driver": solved(PAIR.driver, {CRACKED: crack})}


@dataclass(frozen=True)
class Flanks:
    """What of a pair says how far its lines go on."""

    most_gap: float
    roll: str = "roll"


def followed(gears, coarse=None, spec=SPEC, base_pitches=1, positions=5):
    return follow_flanks(revolving_flanks(spec, gears, coarse, positions=positions), base_pitches)


@pytest.fixture(scope="module")
def revolution(cracked):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("fegear.contact.wide.over_revolution._ROUNDS", 1)
        return followed(cracked, cracked)


def test_a_crack_shows_in_the_base_pitches_in_which_its_tooth_is_loaded(revolution, plain):
    over, usual = revolution.over, followed(plain, base_pitches=3).over
    assert over.transmission_error.shape == over.stiffness.shape == over.tangent.shape == (Z, over.x.size)
    assert over.loads.sum(axis=1) == pytest.approx(np.full(over.transmission_error.shape, LOAD), rel=1e-9)
    assert over.along[2] - over.along[0] == pytest.approx(2.0 * PAIR.base_pitch)
    # tooth -n of the driver is on pair 0 in base pitch n, and on pair 1 in the next one
    off = np.abs(over.residual).max(axis=1)
    assert set(np.argsort(off)[-2:]) == {Z - CRACKED, Z - CRACKED + 1}
    assert off[[n for n in PITCHES if abs(n - Z + CRACKED) > 4]].max() < 2e-3 * off.max()
    assert over.residual[Z - CRACKED].max() > 0.05 * over.transmission_error[0].max()
    common = np.isin(over.x, usual.x)
    far = over.transmission_error[2]
    assert far[common] == pytest.approx(usual.transmission_error[0][np.isin(usual.x, over.x)], rel=1e-4)
    assert usual.transmission_error.shape[0] == 3  # of teeth that are all alike as many as are asked for
    assert np.ptp(usual.transmission_error, axis=0).max() == 0.0
    (row,) = np.flatnonzero(over.number == 0)
    two = (over.loads[Z - CRACKED] > 0.0).sum(axis=0) > 1
    assert two.any()
    assert (over.loads[Z - CRACKED, row, two] < over.loads[2, row, two]).all()


def test_stiffness_is_load_over_deflection_and_what_lies_between_positions_is_small(revolution):
    over = revolution.over
    assert over.stiffness * over.transmission_error == pytest.approx(LOAD, rel=0.15)
    assert (over.tangent >= 0.9 * over.stiffness).all()
    assert over.lowest_stiffness == over.stiffness.min() < over.ordinary_lowest_stiffness
    for beyond, value in (
        (over.beyond.stiffness, over.lowest_stiffness),
        (over.beyond.ordinary_stiffness, over.ordinary_lowest_stiffness),
        (over.beyond.transmission_error, over.largest_error),
        (over.beyond.residual, over.largest_residual),
    ):
        assert 0.0 <= beyond < 0.1 * value
    steps = np.mod(over.x - over.x[0], PAIR.base_pitch) / PAIR.base_pitch
    assert steps.size > 5  # positions are added where extremes are likely
    assert (np.diff(over.x) > 0.0).all()
    assert np.isin(np.arange(5), np.round(5.0 * steps, 6)).all()


def test_errors_are_those_of_longer_panels_and_of_coarser_gears(revolution, cracked, plain):
    """The coarser gears are the gears themselves: nothing is left but what longer panels change."""
    assert followed(plain).less_exactly(np.array([0.0])) == ()
    longer, coarser = revolution.less_exactly(revolution.over.x)
    assert longer.flanks.panel > revolution.flanks.panel == coarser.flanks.panel
    # all positions at once or in parts: which teeth are like others does not depend on it
    assert coarser.over.transmission_error == pytest.approx(revolution.over.transmission_error, rel=1e-9)
    changed = np.abs(longer.over.transmission_error - revolution.over.transmission_error)
    assert revolution.over.transmission_error_error == pytest.approx(1.5 * changed)
    assert 0.0 < changed.max() < 0.02 * revolution.over.largest_error
    assert longer.over.number is revolution.over.number


def test_spacing_errors_are_teeth_that_differ_and_too_many_base_pitches_are_refused(plain):
    spacing = np.zeros(Z)
    spacing[3] = 4e-6
    spec = replace(SPEC, driver=FlankSpec(spacing=spacing))
    over = followed(plain, spec=spec).over
    assert over.transmission_error.shape[0] == Z
    assert over.solved < Z
    # the driver's tooth 3 stands ahead or behind in the base pitches in which it can touch only
    assert set(np.flatnonzero(np.abs(over.residual).max(axis=1) > 1e-7)) <= {2, 3, 4}
    assert np.abs(over.residual).max() == pytest.approx(4e-6, rel=0.5)
    both = replace(spec, driven=FlankSpec(spacing=np.arange(14) * 1e-7))
    revolving = revolving_flanks(both, plain, None, positions=5)
    assert revolving.cycles == Z * 14
    alone = replace(revolving, gaps=replace(revolving.gaps, driver_spacing=np.zeros(0)))
    assert alone.cycles == 14


def test_tip_edges_take_load_before_the_path_and_are_followed_as_far_as_they_do(plain):
    bare, found = (followed(plain, spec=replace(SPEC, corner_contact=corner), positions=8) for corner in (False, True))
    assert bare.flanks.most_gap == 0.0 < found.flanks.most_gap
    assert found.over.number.size > bare.over.number.size
    assert found.over.loads.sum(axis=1) == pytest.approx(np.full((1, found.over.x.size), LOAD), rel=1e-9)
    assert found.over.largest_error < bare.over.largest_error


def test_lines_go_on_along_tip_edges_until_the_last_of_these_are_not_loaded(monkeypatch):
    tried = []

    def edges(enough, key="", refused=0.0):
        def loaded(_revolving, flanks, count, roll):
            tried.append((flanks.most_gap, count, roll))
            if flanks.most_gap < refused:
                raise InputError(key, "", "leaves no tooth pair in contact")
            return SimpleNamespace(reaches_the_last_edges=flanks.most_gap < enough, gap=flanks.most_gap)

        monkeypatch.setattr("fegear.contact.wide.over_revolution._followed", loaded)
        return loaded

    def found(gap=1.0):
        tried.clear()
        return _far_enough(SimpleNamespace(flanks=Flanks(gap)), 7).gap

    edges(3.0)
    assert found() == 4.0
    assert tried == [(gap, 7, "roll") for gap in (1.0, 2.0, 4.0)]
    edges(math.inf)
    assert found() == 16.0  # no farther
    edges(0.0, "odd_tooth", 3.0)
    assert found() == 4.0
    edges(0.0, "load", 3.0)
    with pytest.raises(InputError, match="no tooth pair"):
        found()
    assert len(tried) == 1
    for gap, times in ((0.0, 1), (0.1, 5)):
        edges(0.0, "odd_tooth", 3.0)
        with pytest.raises(InputError, match="no tooth pair"):
            found(gap)
        assert len(tried) == times


def test_more_base_pitches_than_are_looked_at_are_refused(plain, monkeypatch):
    monkeypatch.setattr("fegear.contact.wide.over_revolution.MOST_PITCHES", Z - 1)
    spec = replace(SPEC, driver=FlankSpec(spacing=np.eye(Z)[0] * 1e-6))
    with pytest.raises(InputError, match="13 base pitches until the same teeth mesh again"):
        followed(plain, spec=spec)


# ---- root stress ---------------------------------------------------------------------------------------------------
@pytest.fixture(scope="module")
def roots(revolution):
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("fegear.contact.plane.stress_over_revolution._ROUNDS", 1)
        return wide_stress_over_revolution(revolution, "driver")


def test_root_stress_has_the_number_of_its_tooth_and_falls_beside_a_crack(roots, plain):
    alike = followed(plain)
    ordinary, pressed = (wide_stress_over_revolution(alike, "driver", side) for side in ("tension", "compression"))
    assert ordinary.largest.shape == pressed.largest.shape == (1,)
    assert pressed.largest[0] < 0.0 < ordinary.largest[0] < -pressed.largest[0]
    assert ordinary.off is None  # nothing states the errors of gears
    far = [n for n in PITCHES if abs(n - CRACKED) > 3]
    assert roots.largest[far] == pytest.approx(np.full(len(far), ordinary.largest[0]), rel=5e-3)
    assert roots.teeth == roots.largest.size == Z
    assert roots.x.size == roots.stress.shape[2]
    assert (np.diff(roots.x) > 0.0).all()
    assert roots.largest.argmin() == CRACKED
    assert roots.largest[CRACKED] < 0.5 * ordinary.largest[0]
    # stress where a tooth is on a line, none elsewhere
    pair_on = roots.x + PAIR.base_pitch * roots.number[:, None]
    inside = (pair_on > PAIR.x_start) & (pair_on < PAIR.x_end)
    assert ((roots.stress[0] > 0.0) == inside).mean() > 0.9


def test_teeth_of_the_driven_gear_count_the_other_way(revolution):
    for member, forward in (("driver", -1), ("driven", 1)):
        found = _stress(revolution, member, "tension")
        (zero,), (one,) = (np.flatnonzero(found.number == n) for n in (0, 1))
        assert found.teeth == Z  # of the driven gear as well: so many base pitches pass
        assert found.tooth[5, zero] == (forward * 5) % Z
        assert found.tooth[6, one] == (forward * 5) % Z  # on pair 1 a base pitch later
        assert (found.x == revolution.over.x).all()


def test_errors_of_root_stress_are_twice_what_panels_and_coarser_gears_change(roots, revolution):
    """The coarser gears are the gears themselves: only longer panels change what they are."""
    assert roots.off.shape == (Z,)
    at = peak_positions(roots)
    here = roots.only(at)
    longer, same = (_stress(one, "driver", "tension") for one in revolution.less_exactly(at))
    assert same.stress == pytest.approx(here.stress, rel=1e-9)
    most = here.of_each(here.stress + 2.0 * np.abs(longer.stress - here.stress)) - here.of_each(here.stress)
    assert roots.off == pytest.approx(most, rel=1e-9)
    assert 0.0 < roots.off.max() < 0.05 * roots.largest.max()


def test_runs_of_teeth_are_like_ordinary_ones_only_where_all_of_them_are():
    """A run that began with the first ordinary tooth and reached one beside a crack was taken for ordinary teeth."""
    window = SimpleNamespace(touched=range(-2, 3), near=lambda tooth: (tooth - CRACKED + 6) % Z - 6)
    ring = OddSolid(ordinary=SimpleNamespace(tooth=SimpleNamespace(teeth=Z)), windows=(window,), seconds={})
    odd = range(CRACKED - 2, CRACKED + 3)
    for count in (1, 2, 3, 5):
        alike = {}
        for first in range(-Z, 2 * Z):
            run = tuple((first + n) % Z if (first + n) % Z in odd else None for n in range(count))
            alike.setdefault(ring.same_as(first, count), set()).add(run)
        assert all(len(runs) == 1 for runs in alike.values())
        assert len(alike) == len(set().union(*alike.values()))


def test_no_tooth_errs_relatively_less_than_most_teeth_of_either_gear(roots):
    found = roots
    size = np.abs(found.largest)
    careful = replace(found, off=0.03 * size)
    chance = replace(found, off=np.where(PITCHES == 2, 0.2, 0.001) * size)
    one, other = usual_errors(careful, chance)
    assert one.off == pytest.approx(0.03 * size)
    assert other.off[2] == pytest.approx(0.2 * size[2])
    assert np.delete(other.off / size, 2) == pytest.approx(np.full(Z - 1, 0.03), rel=0.02)
    unknown = replace(found, off=None)
    assert usual_errors(unknown, careful)[0] is unknown
    assert usual_errors(unknown) == (unknown,)
