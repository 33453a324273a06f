"""What one gauge says beside others: its ratio and limits, its verdict, the angle of its tooth, the other fillet."""

from __future__ import annotations

from types import SimpleNamespace as Space

import pytest

from fegear.base.notes import NoteClass
from fegear.results.pair import gauges_together
from fegear.results.pair.gauges_together import _mean_limit, _other_fillet, common_factor, gain_of
from fegear.results.pair.trace_verdict import Judged

KINDS = [(kind, kind is NoteClass.INFORMATION) for kind in NoteClass]


def gauge(**given):
    usual = {"name": "g", "pair": "I", "gear": "pinion", "member": "driver", "tooth": 3, "side": "tension",
             "load_tolerance": 0.02, "measured": Space(file="trace.csv")}  # fmt: skip
    return Space(**usual | given)


def beside(*, found=True, judged=None, better=None, low_pass=None, shift=0.25, likeness=0.95, gain=1.07, kinds=None):
    fit = {"shift": shift} if shift is not None else {}
    compared = Space(gain=gain, fit=fit, shift=shift, likeness=likeness) if found else None
    told = Judged("said", NoteClass.INFORMATION) if judged is None else judged
    ranked = None if kinds is None else Space(as_likely=[Space(of=Space(kind=kind)) for kind in kinds])
    otherwise = Space(better=better, low_pass=low_pass, teeth=25, ranked=ranked)
    return Space(compared=compared, judged=told, otherwise=otherwise)


def peak(compared):
    def limits_of(found):
        assert found is compared
        return Space(together=lambda way: {-1.0: 0.03, 1.0: 0.05}[way])

    return Space(limits_of=limits_of)


def told(monkeypatch, data, same=True, **given):
    def alike(found, otherwise):
        assert (found, otherwise) == (data.compared, data.otherwise)
        return same

    monkeypatch.setattr(gauges_together, "alike", alike)
    return gain_of(gauge(**given), data, peak(data.compared))


@pytest.mark.parametrize(("kind", "agrees"), KINDS)
def test_a_gauge_agrees_where_its_own_verdict_is_only_information(monkeypatch, kind, agrees):
    one = told(monkeypatch, beside(judged=Judged("said", kind)))
    assert one.agrees is agrees
    assert (one.name, one.gain, one.below, one.above, one.load) == ("g", 1.07, 0.03, 0.05, 0.02)
    assert one.limit == pytest.approx(0.04)
    assert one.alike is True
    assert (one.explained, one.fits) == (False, None)


def test_a_gauge_without_a_trace_or_a_verdict_says_nothing(monkeypatch):
    assert told(monkeypatch, beside(found=False)) is None
    assert told(monkeypatch, beside(judged=Judged(""))) is None


@pytest.mark.parametrize(
    ("given", "of_gauge", "fitted"),
    [
        ({}, {}, True), ({"likeness": 0.949}, {}, False), ({"gain": -0.1}, {}, False), ({"shift": None}, {}, False),
        ({}, {"measured": None}, False), ({"better": [Space(changes=("shift",))]}, {}, False),
        ({"shift": 0.0}, {}, True),
    ],
)  # fmt: skip
def test_its_tooth_has_an_angle_where_shapes_are_alike_and_the_angle_was_fitted(monkeypatch, given, of_gauge, fitted):
    one = told(monkeypatch, beside(**given), **of_gauge)
    place = "I", "pinion", "driver", "trace.csv"
    expected = gauges_together.TraceZero(place, 3, 25, given.get("shift", 0.25)) if fitted else None
    assert one.zero == expected


@pytest.mark.parametrize(
    ("kinds", "same"),
    [((), True), (("scale", "shape"), True), (("load",), True), (("place",), True), (("shape",), False)],
)
def test_a_named_cause_explains_a_trace_and_only_one_of_size_may_be_common(monkeypatch, kinds, same):
    data = beside(kinds=kinds)
    one = told(monkeypatch, data)
    assert (one.explained, one.alike) == (bool(kinds), same)
    assert not told(monkeypatch, data, same=False).alike
    if not kinds:
        assert one.cause is None
        return
    assert one.cause == gauges_together.NamedCause("gauge", "g", "I", data.otherwise.ranked, 3)


@pytest.mark.parametrize(
    ("better", "low_pass", "explained"), [(None, None, False), ("low pass", None, True), (None, "low pass", True)]
)
def test_another_description_or_a_low_pass_explains_a_trace(monkeypatch, better, low_pass, explained):
    given = None if better is None else [Space(changes=("shift",))]
    assert told(monkeypatch, beside(better=given, low_pass=low_pass)).explained is explained


@pytest.mark.parametrize(("side", "other"), [("tension", "compression"), ("compression", "tension")])
def test_a_trace_that_fits_the_other_curve_fits_the_other_fillet_of_its_tooth(side, other):
    for changes, found in ((("curve",), True), (("curve", "shift"), False), (("shift",), False), ((), False)):
        data = beside(better=[Space(changes=changes)])
        expected = ("I", "pinion", 3, other) if found else None
        assert _other_fillet(gauge(side=side), data) == expected
    assert _other_fillet(gauge(side=side), beside()) is None


def test_a_strain_is_within_its_own_limit_of_a_computed_one_times_a_factor(monkeypatch):
    one = told(monkeypatch, beside())  # 1.07 - 3 % + 5 %
    factors = 1.07 / 1.0499, 1.07 / 1.0501, 1.07 / 0.9701, 1.07 / 0.9699
    assert [one.within(factor) for factor in factors] == [True, False, True, False]
    assert not told(monkeypatch, beside(), same=False).within(1.07)


def test_common_factor_and_limit_of_the_mean_weigh_each_by_its_own_limit():
    gains = [Space(gain=1.1, limit=0.02), Space(gain=1.3, limit=0.04)]
    assert common_factor(gains) == pytest.approx((1.1**4 * 1.3) ** 0.2, rel=1e-12)
    assert _mean_limit(gains) == pytest.approx(0.5 * (0.02**2 + 0.04**2) ** 0.5, rel=1e-12)
    assert common_factor([Space(gain=1.1, limit=0.0), Space(gain=1.3, limit=1e-6)]) == pytest.approx((1.1 * 1.3) ** 0.5)
