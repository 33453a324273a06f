"""Internal teeth are the envelope of their cutter: rolled by brute force, without any equation of meshing."""

import math
from functools import lru_cache
from typing import Any

import numpy as np
import pytest

from fegear.base.errors import GeometryError
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.verify.own import random_internal_teeth
from fegear.verify.rolled import nearest


@lru_cache
def random_teeth(count: int = 200) -> list[InternalTooth]:
    return list(random_internal_teeth(count))


@pytest.mark.dear("200")
@pytest.mark.parametrize("count", [40, 200])
def test_outlines_of_random_teeth_are_the_envelope_of_their_cutter_to_1e_12(count) -> None:
    worst = 0.0
    for tooth in random_teeth(count):
        for curve in (tooth.fillet, tooth.involute):
            points = curve.points(np.linspace(curve.start, curve.end, 9))
            worst = max(worst, float(np.abs(nearest(tooth, points)).max()))
    assert worst < 1e-12


def test_curves_of_an_internal_tooth_join_with_their_own_normals_and_curvatures() -> None:
    """Of the derivatives of the points; the material lies on the right of travel from the space to the tooth's tip."""
    for tooth in random_teeth(40):
        last = None
        for name, curve in tooth.outline.items():
            u = np.linspace(curve.start, curve.end, 9)
            h = 1e-4 * (curve.end - curve.start)
            inner = u[1:-1]
            ahead, back = curve.points(inner + h), curve.points(inner - h)
            tangent = (ahead - back) / (2 * abs(h))
            turn = (curve.normals(inner + h) - curve.normals(inner - h)) / (2 * abs(h))
            speed, normal = np.hypot(*tangent), curve.normals(inner)
            assert curve.speed(inner) == pytest.approx(speed, rel=1e-6)
            assert np.abs((tangent * normal).sum(axis=0) / speed).max() < 1e-6
            assert (tangent[0] * normal[1] - tangent[1] * normal[0] > 0.0).all(), name
            curvature = (turn * tangent).sum(axis=0) / speed**2
            assert curve.curvatures(inner) == pytest.approx(curvature, rel=1e-4, abs=1e-6)
            if last is not None:
                assert curve.points(curve.start) == pytest.approx(last, abs=1e-12)
            last = curve.points(curve.end)


def test_space_of_an_internal_gear_is_the_external_tooth_of_the_opposite_shift() -> None:
    ring = InternalTooth(60, PinionCutter(20), profile_shift=0.3, tip_radius=29.2)
    pinion = Tooth(60, profile_shift=-0.3)
    radii = np.linspace(ring.tip_radius, 30.4, 5)
    assert math.pi / 60 - ring.half_thickness_angle(radii) == pytest.approx(
        pinion.half_thickness_angle(radii), abs=1e-14
    )


def test_ring_of_the_published_planetary_set_of_18_36_and_93_teeth() -> None:
    """Its tip diameter is printed as 1906.081 mm, at module 21 mm and x3 = .1171."""
    ring = InternalTooth(93, PinionCutter(30), profile_shift=0.1171)
    assert 2.0 * 21.0 * ring.tip_radius == pytest.approx(1906.081, abs=1e-3)


def test_root_diameter_and_addendum_describe_the_same_cutter() -> None:
    by_addendum = InternalTooth(
        60, PinionCutter(20, 0.1, 1.3), profile_shift=0.2, thickness_allowance=0.02, tip_radius=29.2
    )
    by_root = InternalTooth(
        60, PinionCutter(20, 0.1, root_radius=by_addendum.root_radius), profile_shift=0.2, thickness_allowance=0.02,
        tip_radius=29.2,
    )  # fmt: skip
    assert by_root.cutter.addendum == pytest.approx(1.3, abs=1e-13)
    assert by_root.form_radius == pytest.approx(by_addendum.form_radius, abs=1e-13)


RING = {"teeth": 60, "cutter": PinionCutter(20), "tip_radius": 29.1}


@pytest.mark.parametrize(
    ("changed", "key", "rule", "remedy"),
    [
        ({"tip_radius": 29.0}, "tip_radius", "is inside 29.0088 modules", "at least 58.0178 modules"),
        (
            {"tip_radius": 31.1},
            "tip_radius",
            "gives no involute (ends at",
            "reduce the tip diameter or the profile shift",
        ),
        (
            {"cutter": PinionCutter(20, tip_radius=0.4)},
            "cutter.tip_radius",
            "is too large for the cutter tip",
            "at most 0.346",
        ),
        ({"cutter": PinionCutter(20, 0.2, 1.9, tip_radius=0.0)}, "cutter.addendum", "pointed", "smaller addendum"),
        ({"cutter": PinionCutter(58)}, "cutter.teeth", "difference below 3", "at most 57 teeth"),
        ({"cutter": PinionCutter(56)}, "cutter.teeth", "trim", "fewer teeth"),
        ({"profile_shift": 0.9}, "profile_shift", "gives no working pressure angle of gear and", "below 0.818"),
        (
            {"cutter": PinionCutter(20, 0.0, -0.45)},
            "cutter.addendum",
            "inside its base circle",
            "increase addendum or profile shift of the",
        ),
        ({"tip_rounding": 0.9}, "tip_rounding", "", "use at most 0.6577"),
        ({"tip_chamfer": 0.7}, "tip_chamfer", "is too large for the tip", "use at most 0.6895"),
        ({"helix_angle": -0.1}, "helix_angle", "between 0 and 60", "the hand"),
    ],
)
def test_internal_teeth_that_cannot_be_are_refused(changed: dict[str, Any], key: str, rule: str, remedy: str) -> None:
    with pytest.raises(GeometryError) as refused:
        InternalTooth(**{**RING, **changed})
    assert refused.value.key == key
    assert rule in refused.value.rule
    assert remedy in refused.value.remedy
