"""Loaded pairs of asymmetric teeth: equal flanks as ever, exchanged flanks and exchanged gears."""

import math

import numpy as np
import pytest

from fegear.contact.load import load
from fegear.contact.pair_spec import PairSpec
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.asymmetric_rack import AsymmetricRack, RackFlank
from fegear.geometry.asymmetric_tooth import AsymmetricTooth
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.rack import BasicRack

M = 3e-3


def rack(angles, tips):
    return AsymmetricRack(*(RackFlank(math.radians(a), r) for a, r in zip(angles, tips, strict=True)))


def answers(teeth, distance=math.nan):
    """Centre distance, transmission error, load sharing and root stress of both gears, with all effects.

    Coarse meshes: what is compared has the same one.
    """
    pair = GearPair(*(Gear(tooth, M, 0.6 * tooth.root_radius * M, 20e-3) for tooth in teeth), distance)
    solved = {gear: solve_gear(gear, settings_at(-2), estimate_error=False) for gear in (pair.driver, pair.driven)}
    loaded = load(PairSpec(pair, (2000.0, 6000.0)), [solved[gear] for gear in (pair.driver, pair.driven)])
    error = loaded.transmission_error()
    sources = {member: {"fe": loaded.engagement.compliance.source(member)} for member in MEMBERS}
    stress = {member: one["fe"] for member, one in loaded.root_stress(sources, estimates=False).stress.items()}
    return {
        "distance": pair.centre_distance, "mean": error.te_mean, "peak to peak": error.te_peak_to_peak,
        "load": loaded.history().found.load, **{m: stress[m].tension for m in MEMBERS},
        **{f"compression of {m}": stress[m].compression for m in MEMBERS},
    }  # fmt: skip


def same(one, other, limit):
    for key, value in one.items():
        found = np.asarray(other[key])
        assert np.abs(np.asarray(value) - found).max() <= limit * np.abs(found).max(), key


@pytest.mark.dear
def test_loaded_coast_flanks_are_the_drive_flanks_of_an_exchanged_rack():
    teeth = [AsymmetricTooth(z, rack((30.0, 20.0), (0.15, 0.3)), x, 0.01) for z, x in ((18, 0.2), (27, 0.0))]
    coast = answers([tooth.coast for tooth in teeth])
    same(answers([tooth.reversed.drive for tooth in teeth]), coast, 1e-12)
    drive = answers([tooth.drive for tooth in teeth], coast["distance"])
    assert drive["mean"] != pytest.approx(coast["mean"], rel=1e-2)


def test_a_loaded_pair_of_equal_flanks_is_the_usual_one():
    numbers = ((18, 0.2), (27, 0.0))
    usual = answers([Tooth(z, BasicRack(), x, 0.01) for z, x in numbers])
    same(
        answers([AsymmetricTooth(z, rack((20.0, 20.0), (0.25, 0.25)), x, 0.01).drive for z, x in numbers]), usual, 1e-12
    )
