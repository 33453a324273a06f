"""Loading functions of a case: length and load with their defaults, every combination, refusals, teeth as beams."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace as Space

import numpy as np
import pytest

from fegear.base.errors import InputError, RangeError
from fegear.case.loading import LoadingPart
from fegear.results.relief import loading_spectrum
from fegear.results.relief.loading_spectrum import (
    _check,
    _forecast,
    _frequencies,
    _inputs,
    _subjects,
    loading_functions,
)

PAIR = Space(base_pitch=9e-3, path_length=15e-3, x_start=-7e-3, x_end=8e-3, internal=False)


def scene(load=500.0, pair=PAIR, **given):
    of_pair = {} if pair is None else {"pair": "I"}
    part = LoadingPart(**({"slopes": [1.0]} | of_pair | given))
    own = Space(normal_load=lambda of: load if of is pair else None)
    return Space(pairs={"I": pair}, case=Space(loading=part, pair={"I": own}))


def test_without_a_pair_lengths_are_base_pitches():
    found = _inputs(scene(pair=None, contact_ratio=1.7), "")
    assert (found.length, found.base_pitch, found.centre, found.load) == (1.7, 1.0, 0.0, 1.0)
    assert math.isnan(found.path)
    assert (found.name, found.gears) == ("", None)
    assert _subjects(scene(pair=None, contact_ratio=1.7)) == ("",)
    assert _subjects(scene()) == ("I",)
    assert _subjects(Space(case=Space(loading=None))) == ()


@pytest.mark.parametrize(
    ("given", "length"),
    [({}, 15e-3), ({"contact_ratio": 1.4}, 1.4 * 9e-3), ({"length": "12 mm"}, 12e-3)],
)
def test_of_a_pair_the_path_is_loaded_unless_less_is_asked_for(given, length):
    found = _inputs(scene(pair=PAIR, **given), "I")
    assert found.length == pytest.approx(length)
    assert (found.base_pitch, found.centre, found.path) == (9e-3, 0.5e-3, 15e-3)
    assert (found.load, found.name, found.gears) == (500.0, "I", None)
    assert _inputs(scene(load=700.0, **given), "I").load == 700.0
    assert _inputs(scene(speed="100 rpm", **given), "I").gears is PAIR


def test_a_pair_without_load_needs_one():
    with pytest.raises(InputError, match=r"loading.load"):
        _inputs(scene(load=None), "I")


def asked(**given):
    return _inputs(scene(pair=None, **({"contact_ratio": 1.6} | given)), "")


def test_functions_are_all_combinations_of_exponents_slopes_and_peaks():
    found = loading_functions(
        asked(
            contact_ratio=2.4,
            family="polynomial",
            exponents=[3, 7],
            slopes=[1.0, 1.5],
            peaks=[0.6, 0.9],
            inner_slope=0.7,
        )
    )
    assert [(one.ramp.exponent, one.ramp.slope, one.peak) for one in found] == [
        (r, slope, peak) for r in (3, 7) for slope in (1.0, 1.5) for peak in (0.6, 0.9)
    ]
    assert {(one.length, one.base_pitch, one.centre) for one in found} == {(2.4, 1.0, 0.0)}
    assert {(one.inner_ramp.slope, one.inner_ramp.exponent) for one in found} == {(0.7, 3), (0.7, 7)}
    (usual,) = loading_functions(asked(family="polynomial"))
    assert usual.ramp.exponent == loading_spectrum._EXPONENT


@pytest.mark.parametrize(
    ("given", "key"),
    [({"contact_ratio": 0.99}, "loading.contact_ratio"),
     ({"contact_ratio": loading_spectrum._LARGEST_RATIO + 0.01}, "loading.contact_ratio")],
)  # fmt: skip
def test_contact_ratios_that_cannot_be_are_refused(given, key):
    with pytest.raises(RangeError, match=key):
        loading_functions(asked(**given))
    long = replace(
        asked(), part=LoadingPart(slopes=[1.0], length="1 m", pair="I"), length=loading_spectrum._LARGEST_RATIO + 0.1
    )
    with pytest.raises(RangeError, match=r"loading.length"):
        loading_functions(long)


def test_rings_with_a_speed_need_the_frequency_of_their_teeth(monkeypatch):
    monkeypatch.setattr(loading_spectrum, "loading_functions", lambda given: ())
    ring = Space(**{**vars(PAIR), "internal": True})
    with pytest.raises(InputError, match=r"loading.tooth_frequency"):
        _check(scene(pair=ring, speed="100 rpm"), "I")
    _check(scene(pair=ring, speed="100 rpm", tooth_frequency="30 kHz"), "I")
    _check(scene(pair=ring), "I")
    _check(scene(speed="100 rpm"), "I")


@pytest.mark.parametrize("given", [None, 2e4])
def test_each_gear_vibrates_at_its_own_order_of_the_mesh(monkeypatch, given):
    gears = {"driver": Space(tooth=Space(teeth=21)), "driven": Space(tooth=Space(teeth=53))}
    pair = Space(driver=gears["driver"], gear=gears.get)
    monkeypatch.setattr("fegear.formulas.tooth_vibration.tooth_frequency", lambda gear: 1000.0 * gear.tooth.teeth)
    monkeypatch.setattr("fegear.design.loading.tooth_response", lambda f, orders: (f, *orders))
    one = Space(gears=pair, part=Space(speed=10.0 * math.pi, tooth_frequency=given))
    found = loading_spectrum._own_vibrations(one, ("f", "g"))
    frequencies = [given or 21e3, given or 53e3]
    assert [(each.member, each.frequency) for each in found] == list(zip(gears, frequencies, strict=True))
    assert [each.order for each in found] == pytest.approx([f / (5.0 * 21) for f in frequencies])
    assert found[0].response == (("f", found[0].order), ("g", found[0].order))
    assert loading_spectrum._own_vibrations(Space(gears=None, part=one.part), ("f",)) == ()


def test_frequencies_rise_in_even_ratios_and_then_in_even_steps():
    found, m = _frequencies(40.0), loading_spectrum
    assert (found[0], found[m._BELOW], found[-1]) == (m._LOWEST, m._LOBES, 40.0)
    assert found.size == m._BELOW + m._ABOVE
    assert np.ptp(np.diff(np.log(found[: m._BELOW + 1]))) < 1e-9
    assert np.ptp(np.diff(found[m._BELOW :])) < 1e-9


def test_a_forecast_counts_the_functions():
    found = _forecast(scene(contact_ratio=1.6, slopes=[1.0, 2.0], exponents=[3, 5, 7], family="polynomial"), "I")
    assert found.settings == {"functions": 6}
    assert found.seconds == pytest.approx(0.02 + 0.36)
