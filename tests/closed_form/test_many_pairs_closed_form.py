"""Geometry of arrays of pairs against teeth, gears and pairs that are made one by one."""

import math

import numpy as np
import pytest

from fegear.base.errors import GeometryError
from fegear.formulas.friction import ohlendorf, overlapping
from fegear.geometry.checks import tip_thickness
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.many_pairs import ManyGearPairs
from fegear.geometry.pair import GearPair
from fegear.geometry.path_of_contact import specific_sliding
from fegear.geometry.rack import BasicRack

COUNT = 50


def drawn() -> ManyGearPairs:
    rng = np.random.default_rng(11)
    teeth = np.array([rng.integers(10, 40, COUNT), rng.integers(20, 120, COUNT)], dtype=float)
    shift = np.array([rng.uniform(-0.3, 0.7, COUNT), rng.uniform(-0.6, 0.5, COUNT)])
    module = rng.choice([1.0, 2.0, 2.75, 4.0], COUNT) * 1e-3
    alpha = np.radians(rng.choice([20.0, 20.0, 17.5], COUNT))
    beta = np.radians(rng.choice([0.0, 8.0, 15.0, 25.0], COUNT))
    deep = rng.choice([1.0, 1.0, 1.25], COUNT)  # the long tips run into fillets
    a_t = np.arctan(np.tan(alpha) / np.cos(beta))
    distances = []
    for k in range(COUNT):
        wanted = math.tan(a_t[k]) - a_t[k] + 2.0 * shift[:, k].sum() * math.tan(alpha[k]) / teeth[:, k].sum()
        low, high = 1e-3, 1.2
        for _ in range(80):
            middle = 0.5 * (low + high)
            low, high = (low, middle) if math.tan(middle) - middle > wanted else (middle, high)
        distances.append(0.5 * module[k] * teeth[:, k].sum() / math.cos(beta[k]) * math.cos(a_t[k]) / math.cos(low))
    a = np.array(distances)
    shortened = np.minimum(a / module - 0.5 * teeth.sum(axis=0) / np.cos(beta) - shift.sum(axis=0), 0.0)
    width = module * rng.uniform(8.0, 15.0, COUNT)
    return ManyGearPairs(
        teeth, shift, module, alpha, beta, deep, np.full(COUNT, 1.25), np.full(COUNT, 0.3), shortened, a, width
    )


def test_every_circle_and_ratio_is_that_of_the_pair_made_alone():
    many, compared, undercut, apart = drawn(), 0, 0, 0
    for k in range(COUNT):
        rack = BasicRack(many.addendum[k], many.dedendum[k], 0.3, float(many.pressure_angle[k]))
        m, hands = float(many.module[k]), ("spur", "spur") if many.helix_angle[k] == 0.0 else ("right", "left")
        teeth = []
        try:
            for i in (0, 1):
                tip = float(many.tip_diameters[i, k]) / 2.0 / m
                teeth.append(
                    Tooth(
                        int(many.teeth[i, k]),
                        rack,
                        float(many.profile_shift[i, k]),
                        tip_radius=tip,
                        helix_angle=float(many.helix_angle[k]),
                    )
                )
        except GeometryError:
            assert (many.tip_thicknesses[:, k] < 0.05).any() or (many.undercut[:, k] > 0.0).any()
            continue
        assert [t.undercut for t in teeth] == (many.undercut[:, k] > 0.0).tolist()
        gears = [
            Gear(t, m, 0.5 * t.root_radius * m, float(many.face_width[k]), hand=h)
            for t, h in zip(teeth, hands, strict=True)
        ]
        assert [g.root_radius for g in gears] == pytest.approx(0.5 * many.root_diameters[:, k], rel=1e-13)
        assert [tip_thickness(g) / m for g in gears] == pytest.approx(many.tip_thicknesses[:, k], abs=1e-12)
        if any(t.undercut for t in teeth):
            undercut += 1
            continue
        assert [g.form_radius for g in gears] == pytest.approx(0.5 * many.form_diameters[:, k], rel=1e-12)
        pair = GearPair(gears[0], gears[1], float(many.centre_distance[k]))
        by_tips = pair.x_end - pair.x_start
        if (many.involute_reserve[:, k] < 0.0).any():
            apart += 1
            assert by_tips / pair.base_pitch < many.contact_ratio[k]
            continue
        compared += 1
        assert pair.contact_ratio == pytest.approx(many.contact_ratio[k], abs=1e-12)
        assert pair.overlap_ratio == pytest.approx(many.overlap_ratio[k], abs=1e-12)
        for i, member in enumerate(("driver", "driven")):
            assert pair.tip_clearance(member) / m == pytest.approx(many.tip_clearances[i, k], abs=1e-11)
            ends = specific_sliding(pair, [pair.x_start, pair.x_end], member)
            assert ends.min() == pytest.approx(many.specific_sliding[i, k], rel=1e-9)
        spur = many.helix_angle[k] == 0.0 and pair.contact_ratio <= 2.0
        assert (ohlendorf if spur else overlapping)(pair) == pytest.approx(many.tooth_loss_factor[k], rel=1e-12)
    assert min(undercut, apart) > 1
    assert compared > 15
