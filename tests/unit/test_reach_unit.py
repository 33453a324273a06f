"""Which stretch of a pinion helix faces the mating flank: every place of it is tried, and its bounds are named."""

from __future__ import annotations

import math

import numpy as np
import pytest

from fegear.contact.unloaded.placement import Placement
from fegear.contact.unloaded.reach import Bound, reach

ALPHA, BASE_1, BASE_2 = math.radians(20.0), 0.03 * math.cos(math.radians(20.0)), 0.06 * math.cos(math.radians(20.0))
TIP_1, PLACES = 0.0325, 2001


def placement(helix=0.3, lean=0.0, crown=0.0, offset=0.0, width_2=0.018):
    return Placement(
        distance=0.09, cos=math.cos(lean), sin=math.sin(lean), twist_1=math.tan(helix) / 0.03, crown=crown,
        twist_2=-math.tan(helix) / 0.06, base_1=BASE_1, base_2=BASE_2, tip_2=0.0622, form_2=0.0579, offset_2=0.0,
        pressure_angle=ALPHA, ratio=0.5, face_1=(-0.01, 0.01), face_2=(offset - 0.5 * width_2, offset + 0.5 * width_2),
    )  # fmt: skip


def faces(p, w):
    """Places along one helix that face the flank, and which of the conditions hold at each."""
    z = np.linspace(*p.face_1, PLACES)
    q = w * np.exp(1j * (p.twist_1 * z - p.crown * z * z))
    x2, y2 = p.distance - q.real, -q.imag * p.cos - z * p.sin
    z2 = z * p.cos - q.imag * p.sin
    r2 = np.hypot(x2, y2)
    passed = np.angle(w) + p.twist_1 * z >= -p.pressure_angle - math.acos(min(p.base_1 / abs(w), 1.0))
    held = {
        (Bound.GEAR_FACE_LOW, Bound.GEAR_FACE_HIGH): (z2 >= p.face_2[0]) & (z2 <= p.face_2[1]),
        (Bound.GEAR_TIP,): r2 <= p.tip_2, (Bound.BASE_TANGENT,): passed,
    }  # fmt: skip
    some = np.logical_and.reduce([*held.values()])
    if some.any():  # of what is below the form circle only the side remains that lies above where it is deepest
        deepest = np.flatnonzero(some)[np.argmin(r2[some])]
        if r2[deepest] < p.form_2:
            along = np.gradient(q.imag * p.cos + z * p.sin, z)[deepest]
            side = z < z[deepest] if along < 0.0 else z > z[deepest]
            held[Bound.GEAR_FORM,] = (r2 >= p.form_2) & side
    return z, np.logical_and.reduce([*held.values()]), held


@pytest.mark.parametrize("helix", [0.0, 0.3, -0.3])
@pytest.mark.parametrize(
    "given",
    [{}, {"lean": 4e-3}, {"lean": -0.02}, {"offset": 6e-3}, {"offset": -8e-3, "lean": 5e-3}, {"crown": 40.0},
     {"width_2": 5e-3}],
)  # fmt: skip
def test_the_reach_is_every_place_that_faces_the_flank(helix, given):
    p = placement(helix, **given)
    rng = np.random.default_rng(11)
    w = rng.uniform(0.9999 * BASE_1, TIP_1, 60) * np.exp(1j * rng.uniform(-0.45, 0.45, 60))
    found, named = reach(p, w), set()
    step = (p.face_1[1] - p.face_1[0]) / (PLACES - 1)
    for i, one in enumerate(w):
        z, inside, held = faces(p, one)
        if found.outside[i]:
            assert inside.sum() <= 2
            continue
        if not inside.any():
            assert found.hi[i] - found.lo[i] <= 2.0 * step
            continue
        first, last = z[inside][[0, -1]]
        assert np.ptp(np.flatnonzero(inside)) == inside.sum() - 1, "one stretch"
        assert found.lo[i] == pytest.approx(first, abs=1.01 * step)
        assert found.hi[i] == pytest.approx(last, abs=1.01 * step)
        for bound, at, beyond in ((found.lo_bound[i], 0, -1), (found.hi_bound[i], -1, 1)):
            here = np.flatnonzero(inside)[at] + beyond
            named.add(Bound(int(bound)))
            if 0 <= here < PLACES:  # what ends it is what fails beside it
                failing = [bounds for bounds, good in held.items() if not good[here]]
                assert any(bound in bounds for bounds in failing), (bound, failing)
            else:
                assert bound in (Bound.PINION_FACE_LOW, Bound.PINION_FACE_HIGH)
                assert (bound == Bound.PINION_FACE_HIGH) == (beyond > 0)
    assert len(named) >= 2
    assert (found.outside == 0).sum() > 10
