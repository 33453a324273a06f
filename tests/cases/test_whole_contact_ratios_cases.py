"""Contact ratios at and beside whole numbers: the peak to peak that jumps is remarked on, with corners it does not."""

from __future__ import annotations

import functools
from pathlib import Path

import pytest
from scipy.optimize import brentq

from fegear.base.errors import InputError
from fegear.case.reading import build_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES


def scene(tip_diameter: float, *, teeth: int, addendum: float, corners: bool, **more):
    """Two equal gears of module 2 mm, tips turned to a diameter [mm], 3 kN on 10 mm of face."""
    gear = {
        "teeth": teeth, "module": "2 mm", "bore_radius": "8 mm", "face_width": "10 mm",
        "tip_diameter": f"{tip_diameter!r} mm", "rack": {"addendum": addendum, "dedendum": 1.6, "tip_radius": 0.2},
    }  # fmt: skip
    pair = {"driver": "a", "driven": "b", "load": "3000 N", "compliance": {"source": "weber-banaschek"}}
    effects = {"hertz": "load-dependent", "corner_contact": corners}
    parts = {"results": ["transmission-error"], "gear": {"a": gear, "b": gear}, "pair": {"I": pair}, "effects": effects}
    return build_scene({**parts, **more}, "case", Path())


@functools.cache
def tip_of(whole: int, teeth: int, addendum: float) -> float:
    """Tip diameter [mm] at which the contact ratio is a whole number."""

    def off(diameter: float) -> float:
        made = scene(diameter, teeth=teeth, addendum=addendum, corners=True)
        return made.pairs["I"].contact_ratio - whole

    usual = 2.0 * teeth
    return brentq(off, usual + 1.0, usual + 4.0 * addendum + 0.2, xtol=1e-13, rtol=1e-15)


def run(off: float, whole: int, *, corners: bool, **more):
    teeth, addendum = {1: (40, 1.0), 2: (80, 1.3)}[whole]
    made = scene(tip_of(whole, teeth, addendum) + off, teeth=teeth, addendum=addendum, corners=corners, **more)
    return run_plan(made, make_plan(made, STAGES))


def remarks(results) -> list[str]:
    return [r for r in results.remarks if "within 0.001 of an integer" in r]


def test_peak_to_peak_jumps_at_a_whole_contact_ratio_with_a_remark():
    a, b = (run(off, 2, corners=False) for off in (-1e-10, 1e-10))
    jump = b.values["I.te_peak_to_peak"].si / a.values["I.te_peak_to_peak"].si
    assert max(jump, 1.0 / jump) > 1.2
    for results in (a, b, run(1e-10, 1, corners=False)):
        (said,) = remarks(results)
        assert "Set corner_contact = true under [effects]." in said


@pytest.mark.parametrize("whole", [1, 2])
def test_with_corner_contact_it_is_continuous_and_nothing_is_remarked(whole):
    a, b = (run(off, whole, corners=True) for off in (-1e-10, 1e-10))
    assert b.values["I.te_peak_to_peak"].si == pytest.approx(a.values["I.te_peak_to_peak"].si, rel=1e-8)
    assert not remarks(a)
    assert not remarks(b)


def test_away_from_whole_numbers_nothing_is_remarked():
    assert not remarks(run(0.5, 2, corners=False))


@pytest.mark.long
def test_a_relief_that_is_designed_at_a_whole_contact_ratio_is_remarked_on_too():
    assert len(remarks(run(1e-6, 2, corners=False, results=["relief"]))) == 1


@pytest.mark.parametrize("below", [1e-9, 1e-3, 0.3])
def test_below_a_contact_ratio_of_one_corners_alone_carry_where_no_pair_is_on_the_path(below):
    """The documented way: corner_contact; the mean compliance of Mark's perfect flanks does not exist there."""
    results = run(-below, 1, corners=True)
    above = run(1e-9, 1, corners=True)
    assert results.values["I.te_peak_to_peak"].si > 0.0
    assert "I.mesh_compliance_mean" not in results.values
    assert any("I.mesh_compliance_mean" in r and "positions with corner contact only" in r for r in results.remarks)
    assert "I.mesh_compliance_mean" in above.values
    if below < 1e-6:
        assert results.values["I.te_mean"].si == pytest.approx(above.values["I.te_mean"].si, rel=1e-6)


def test_mark_s_series_below_a_contact_ratio_of_one_is_refused_with_what_does():
    with pytest.raises(InputError, match=r'K_T.*method = "quadrature"'):
        run(-0.1, 1, corners=True, transmission_error={"method": "mark-series"})
