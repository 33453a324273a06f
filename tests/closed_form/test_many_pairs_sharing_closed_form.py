"""Load sharing of arrays of pairs, external and internal, is that of each pair, to round-off."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.contact.many.arrays import ManyReliefs, engagements_of
from fegear.contact.many.many_load_sharing import shares_at, transmission_errors
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.fe_compliance import finite_element_compliance
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.transmission_error import transmission_error
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import UNMODIFIED, EndRelief

LOADS = np.array([500.0, 12000.0])
PAIRS = ((0, 2), (1, 1), (2, 0), (3, 2))
#: Teeth, shift and tip height of ring gears, and which gear each runs with, as driver or as driven.
RINGS = ((60, -0.1, 0.85), (81, 0.0, 0.75))
IN_RINGS = ((0, 1, False), (0, 0, True), (1, 3, True), (1, 0, False))


def _gear(teeth: int, shift: float) -> Gear:
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.38), shift)
    return Gear(tooth, 3e-3, 0.5 * tooth.root_radius * 3e-3, face_width=0.02)


def _ring(teeth: int, shift: float, height: float) -> Gear:
    tooth = InternalTooth(
        teeth, PinionCutter(20, 0.0, 1.25, tip_radius=0.2), profile_shift=shift, tip_radius=0.5 * teeth - shift - height
    )
    return Gear(tooth, 3e-3, 1.15 * tooth.root_radius * 3e-3, face_width=0.02)


@pytest.fixture(scope="module")
def pairs() -> list[PairCompliance]:
    """Of one gear that is undercut, and of contact ratios from 1.3 to 1.9; the last ones with ring gears."""
    gears = [_gear(*one) for one in ((17, 0.3), (24, 0.2), (60, -0.1), (14, 0.1))] + [_ring(*one) for one in RINGS]
    solved = [
        finite_element_compliance(solve_gear(gear, settings_at(-6.0), reach=2, estimate_error=False)) for gear in gears
    ]
    rings = [(4 + ring, gear) if drives else (gear, 4 + ring) for ring, gear, drives in IN_RINGS]
    return [PairCompliance(GearPair(gears[a], gears[b]), solved[a], solved[b]) for a, b in (*PAIRS, *rings)]


@pytest.mark.dear
@pytest.mark.parametrize("corners", [False, True])
def test_transmission_error_and_shares_are_those_of_each_pair(pairs, corners):
    each = [Engagement(pair, corner_contact=corners) for pair in pairs]
    many = engagements_of(each)
    found = transmission_errors(many, LOADS, waves=8, samples=48, order=16)
    at = np.linspace(0.0, 1.0, 40, endpoint=False) + 1e-3
    shared = shares_at(many, LOADS[1], at)
    for i, one in enumerate(each):
        for k, load in enumerate(LOADS.tolist()):
            known = transmission_error(one, load, 8, order=16)
            assert found.mean[i, k] == pytest.approx(known.mean, rel=1e-13)
            # under the small load a deflection is a micrometre
            tolerance = 5e-13 if corners else 1e-13
            assert abs(found.peak_to_peak[i, k] - known.peak_to_peak) < tolerance * known.mean
            assert abs(found.largest_share[i, k] - known.loaded.shared.shares.max()) < tolerance
        x = one.pair.x_start + one.pair.base_pitch * at
        known = one.solve(one.grid(x), [LOADS[1]])
        pairs_here = known.grid.contacts.number - shared.first[i]
        shares = np.zeros_like(shared.shares[i])
        shares[:, pairs_here] = known.shared.shares[:, :, 0].T
        tolerance = 4e-13 if corners else 1e-13  # round-off, that of other processors too
        np.testing.assert_allclose(shared.shares[i], shares, atol=tolerance)
        np.testing.assert_allclose(shared.transmission_error[i], known.transmission_error[:, 0], rtol=tolerance)
    # what is taken by itself is within the errors that its page states
    fewer = transmission_errors(many, LOADS)
    np.testing.assert_allclose(fewer.mean, found.mean, rtol=2e-5)
    assert (np.abs(fewer.peak_to_peak - found.peak_to_peak) < 1e-4 * found.mean).all()


@pytest.mark.dear
def test_tip_reliefs_are_those_of_each_pair(pairs):
    each = [Engagement(pair, corner_contact=True) for pair in (pairs[0], pairs[4])]
    many = engagements_of(each)
    amount, start, power = (
        np.array([[8e-6, 0.0], [5e-6, 12e-6]]),
        np.full((2, 2), 0.7),
        np.array([[1.0, 1.0], [2.0, 1.0]]),
    )
    found = transmission_errors(
        replace(many, reliefs=ManyReliefs(amount, start, power)), LOADS, waves=8, samples=48, order=16
    )
    for i, one in enumerate(each):
        reliefs = []
        for member, gear in enumerate((one.pair.driver, one.pair.driven)):
            low, high = sorted(
                gear.tooth.side * math.sqrt(r**2 - gear.base_radius**2) / gear.base_radius for r in gear.involute_radii
            )
            begins = low + start[member, i] * (high - low)
            relief = EndRelief(float(amount[member, i]), begins, high, float(power[member, i]))
            reliefs.append(relief if amount[member, i] else UNMODIFIED)  # a relief of nothing has a kink all the same
        relieved = replace(one, driver_relief=reliefs[0], driven_relief=reliefs[1])
        for k, load in enumerate(LOADS.tolist()):
            known = transmission_error(relieved, load, 8, order=16)
            assert found.mean[i, k] == pytest.approx(known.mean, rel=1e-13)
            assert abs(found.peak_to_peak[i, k] - known.peak_to_peak) < 5e-13 * known.mean


def test_pairs_that_are_none_have_no_answer_and_no_neighbours(pairs):
    many = engagements_of([Engagement(pair) for pair in pairs[:3]])
    own = many.flanks.own.copy()
    own[0, 1] = np.nan  # outside an atlas
    apart = many.centre_distance.copy()
    apart[2] *= 1.2
    odd = replace(many, flanks=replace(many.flanks, own=own), centre_distance=apart)
    found, known = transmission_errors(odd, LOADS), transmission_errors(many, LOADS)
    np.testing.assert_array_equal(found.mean[0], known.mean[0])
    assert np.isnan(found.mean[1:]).all()
    assert np.isnan(shares_at(odd, 500.0, [0.5]).transmission_error[1:]).all()
    with pytest.raises(InputError, match="at least 0 and below 1"):
        ManyReliefs(np.zeros((2, 1)), np.ones((2, 1)), np.ones((2, 1)))


def test_rounded_tips_are_refused(pairs):
    one = pairs[0]
    tooth = replace(one.pair.driver.tooth, tip_rounding=0.05)
    rounded = replace(one, pair=replace(one.pair, driver=replace(one.pair.driver, tooth=tooth)))
    with pytest.raises(InputError, match="must be of solved gears with sharp tips"):
        engagements_of([Engagement(rounded)])
