"""Root stress of arrays of pairs over the mesh is that of each pair: to round-off at positions, nearly so at peaks."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.atlas.many_pairs import ManySpurPairs, known_pairs, loaded_pairs
from fegear.atlas.shipped import shipped_atlas
from fegear.contact.many.arrays import ManyReliefs
from fegear.contact.many.many_load_sharing import transmission_errors
from fegear.contact.many.many_roots import root_stress_at, root_stresses
from fegear.contact.plane.base_pitch import roll_positions
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.root_stress_history import root_stress_history
from fegear.contact.plane.tooth_stress import loaded_states, tooth_stress, with_peaks
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.relief import EndRelief

LOADS = np.array([600.0, 9000.0])
GEARS = (((17, 0.3), (60, -0.1)), ((24, 0.2), (24, 0.2)), ((31, 0.1), (140, 0.0)))
M, FACE = 3e-3, 0.02


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

    count = len(pairs)
    return ManySpurPairs(
        each(lambda g: g.teeth), each(lambda g: g.tooth.generating_shift), each(lambda g: g.tip_radius),
        each(lambda g: g.bore_radius), np.full(count, M), np.array([one.centre_distance for one in pairs]),
        np.full(count, FACE), each(lambda g: g.material.young_modulus),
    )  # fmt: skip


def _engagement(pair: GearPair, corners: bool, reliefs: ManyReliefs | None, i: int) -> Engagement:
    atlas = shipped_atlas("A")
    engagement = Engagement(
        PairCompliance(pair, atlas.compliance(pair.driver), atlas.compliance(pair.driven)), corner_contact=corners
    )
    if reliefs is None:
        return engagement
    found = []
    for member, gear in enumerate((pair.driver, pair.driven)):
        low, high = (math.sqrt(r**2 - gear.base_radius**2) / gear.base_radius for r in gear.involute_radii)
        begins = low + reliefs.start[member, i] * (high - low)
        found.append(EndRelief(float(reliefs.amount[member, i]), begins, high, float(reliefs.power[member, i])))
    return replace(engagement, driver_relief=found[0], driven_relief=found[1])


RELIEFS = ManyReliefs(
    np.array([[8e-6, 0.0, 5e-6], [5e-6, 12e-6, 6e-6]]),
    np.full((2, 3), 0.7),
    np.array([[1.0, 1.0, 2.0], [2.0, 1.0, 1.0]]),
)


@pytest.mark.dear
@pytest.mark.parametrize(("corners", "reliefs"), [(False, None), (True, None), (True, RELIEFS)])
def test_root_stress_is_that_of_each_pair(pairs, many, corners, reliefs):
    known = known_pairs(shipped_atlas("A"), many, corner_contact=corners, reliefs=reliefs, root_stress=True)
    at = np.linspace(0.0, 1.0, 12, endpoint=False) + 1e-3
    histories = root_stress_at(known.engagements, known.fillets, LOADS[1], at)
    largest = root_stresses(known.engagements, known.fillets, LOADS)
    for i, pair in enumerate(pairs):
        one = _engagement(pair, corners, reliefs, i)
        state = one.solve(one.grid(pair.x_start + pair.base_pitch * at), [LOADS[1]])
        sources = {member: (one.compliance.source(member),) for member in ("driver", "driven")}
        states = [
            loaded_states(one, (), [load], with_peaks(one, load, roll_positions(one, 64), sources)) for load in LOADS
        ]
        for m, member in enumerate(("driver", "driven")):
            for side, name in enumerate(("tension", "compression")):
                stress = root_stress_history(one, state, member, name, 1).stress[..., 0]
                rows = state.grid.contacts.number[0] - 1 - histories.first[i] + np.arange(stress.shape[0])
                mine = histories.stress[m, i, side][rows]
                here = np.isfinite(mine)
                assert here.sum() >= 3 * at.size
                np.testing.assert_allclose(mine[here], stress[here], atol=1e-11 * np.abs(stress).max(), rtol=0.0)
            for k, under in enumerate(states):
                each = tooth_stress(one, under, member, estimates=False)
                tension, compression = float(each.largest_tension[0]), float(each.largest_compression[0])
                assert largest.tension[m, i, k] == pytest.approx(tension, rel=1e-4)
                assert largest.compression[m, i, k] == pytest.approx(compression, rel=1e-4)
                assert abs(largest.tension_range[m, i, k] - float(each.tension_range[0])) < 5e-4 * tension


@pytest.mark.dear
def test_any_number_of_pairs_in_bounded_memory(many):
    atlas = shipped_atlas("A")
    outside = replace(many, teeth=np.where(np.arange(3) == 1, 5.0, many.teeth))
    found = loaded_pairs(atlas, outside, LOADS, at_once=2)
    assert found.held.tolist() == [True, False, True]
    known = known_pairs(atlas, many, root_stress=True)
    stress = root_stresses(known.engagements, known.fillets, LOADS)
    error = transmission_errors(known.engagements, LOADS)
    assert np.isnan(found.root_stress.tension[:, 1]).all()
    for i in (0, 2):
        np.testing.assert_allclose(found.root_stress.tension[:, i], stress.tension[:, i], rtol=1e-12)
        np.testing.assert_allclose(found.transmission_error.mean[i], error.mean[i], rtol=1e-12)
        assert (found.stress_error[:, i] < 5e-3).all()
    fewer = loaded_pairs(atlas, many, LOADS, root_stress=False)
    assert fewer.root_stress is None
    np.testing.assert_allclose(fewer.transmission_error.mean, error.mean, rtol=1e-12)
