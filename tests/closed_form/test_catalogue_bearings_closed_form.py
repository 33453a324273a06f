"""Bearings estimated from catalogues: ratings of ISO 76 and ISO 281 are kept, known insides lie within the error."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from fegear.shafts.catalogue_bearing import CatalogueBearing
from fegear.shafts.load_ratings import dynamic_rating, static_rating
from fegear.shafts.rolling_bearing import RollingBearing

#: Of three kinds: d, D and B [m], C and C_0 [N].
PRINTED = (
    CatalogueBearing("ball", 0.030, 0.062, 0.016, 19.5e3, 11.2e3),
    CatalogueBearing("ball", 0.060, 0.130, 0.031, 85.2e3, 52e3),
    CatalogueBearing("cylindrical", 0.050, 0.110, 0.027, 127e3, 112e3),
    CatalogueBearing("tapered", 0.030, 0.062, 0.016, 46e3, 49e3, math.radians(14.0)),
)


def stiffness(bearing: RollingBearing, load: float) -> float:
    """Slope of the radial force under a radial load [N/m]."""

    def force(shift: float) -> float:
        return float(bearing.reaction(np.array([shift, 0.0, 0.0, 0.0, 0.0]))[0][0])

    shift = brentq(lambda one: force(one) - load, 0.0, 1e-3, xtol=1e-14)
    return float(bearing.reaction(np.array([shift, 0.0, 0.0, 0.0, 0.0]))[1][0, 0])


@pytest.mark.parametrize("printed", PRINTED)
def test_the_inside_has_both_ratings(printed):
    assert static_rating(printed.inside) == pytest.approx(printed.static_rating, rel=1e-9)
    assert printed.rating_factor is not None
    assert dynamic_rating(printed.inside, printed.rating_factor) == pytest.approx(printed.dynamic_rating, rel=1e-9)
    only = replace(printed, static_rating=None)
    if printed.kind == "ball":
        assert dynamic_rating(only.inside, 1.3 * 1.05) == pytest.approx(printed.dynamic_rating, rel=1e-9)


@pytest.mark.parametrize("printed", PRINTED)
def test_a_bearing_twice_as_large_has_four_times_the_rating(printed):
    large = CatalogueBearing(
        printed.kind, 2 * printed.bore, 2 * printed.outside_diameter, 2 * printed.width,
        static_rating=4 * printed.static_rating, contact_angle=printed.contact_angle,
    )  # fmt: skip
    assert large.inside.count == printed.inside.count
    assert large.inside.element_diameter == pytest.approx(2 * printed.inside.element_diameter, rel=1e-9)
    assert large.inside.roller_length == pytest.approx(2 * printed.inside.roller_length, rel=1e-9)
    assert large.error == pytest.approx(printed.error, rel=1e-9)


@pytest.mark.parametrize("printed", PRINTED)
def test_a_higher_static_rating_is_a_larger_element_and_less_is_known_without_one(printed):
    rated = [replace(printed, dynamic_rating=None, static_rating=share * printed.static_rating).inside
             for share in (0.7, 0.8, 0.9, 1.0, 1.1)]  # fmt: skip
    sizes = [one.element_diameter if printed.kind == "ball" else one.roller_length for one in rated]
    assert np.all(np.diff(sizes) > 0.0)
    if printed.kind != "ball":  # of larger balls fewer have room
        assert np.all(np.diff([stiffness(one, 1000.0) for one in rated]) > 0.0)
    bare = replace(printed, dynamic_rating=None, static_rating=None)
    assert bare.error > printed.error > 0.02


def known_insides() -> list[tuple[CatalogueBearing, RollingBearing]]:
    """Bearings whose inside is drawn first; a catalogue prints their ratings by ISO 76 and ISO 281."""
    rng, found = np.random.default_rng(76281), []
    for kind, bore, outside, width in (
        ("ball", 15, 35, 11), ("ball", 25, 52, 15), ("ball", 30, 72, 19), ("ball", 50, 80, 16), ("ball", 60, 130, 31),
        ("ball", 100, 180, 34), ("cylindrical", 20, 47, 14), ("cylindrical", 50, 110, 27), ("cylindrical", 80, 140, 26),
        ("cylindrical", 100, 215, 47), ("tapered", 30, 62, 16), ("tapered", 40, 80, 23), ("tapered", 60, 130, 31),
    ):  # fmt: skip
        for _ in range(3):
            d, large, b = bore * 1e-3, outside * 1e-3, width * 1e-3
            pitch = 0.5 * (d + large) * rng.uniform(0.995, 1.015)
            angle = math.radians(rng.uniform(11.0, 16.5)) if kind == "tapered" else 0.0
            if kind == "ball":
                size = 0.5 * (large - d) * rng.uniform(0.57, 0.64)
                count = round(1 + 0.5 * math.radians(rng.uniform(180.0, 196.0)) / math.asin(size / pitch))
                grooves = rng.uniform(0.514, 0.526), rng.uniform(0.524, 0.536)
                made = RollingBearing("ball", count, size, pitch, 0.0, grooves)
            else:
                size = 0.5 * (large - d) * (rng.uniform(0.52, 0.58) if kind == "cylindrical" else rng.uniform(0.4, 0.5))
                filling = rng.uniform(0.77, 0.89) if kind == "cylindrical" else rng.uniform(0.83, 0.92)
                count = math.floor(filling * math.pi / math.asin(size / pitch))
                length = b * rng.uniform(0.53, 0.67) + (0.1 * b if kind == "tapered" else 0.0)
                made = RollingBearing("roller", count, size, pitch, angle, roller_length=length)
            printed = CatalogueBearing(
                kind, d, large, b, dynamic_rating(made), static_rating(made), angle if kind == "tapered" else None
            )
            found.append((printed, made))
    return found


KNOWN = known_insides()


@pytest.mark.parametrize("without", [(), ("static_rating",), ("static_rating", "dynamic_rating")])
def test_the_stiffness_of_known_insides_is_within_the_stated_error(without):
    """39 bearings: with C_0, with C only, from the envelope only; the errors stated are of use, below 25 %."""
    shares = []
    for printed, made in KNOWN:
        estimated = replace(printed, **dict.fromkeys(without))
        load = 0.05 * static_rating(made)
        off = stiffness(estimated.inside, load) / stiffness(made, load) - 1.0
        assert estimated.error < 0.25
        shares.append(abs(off) / estimated.error)
    assert len(shares) == 39
    assert max(shares) <= 1.0
    assert np.median(shares) > 0.05  # no error stated out of all proportion
