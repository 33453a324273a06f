"""Bearings estimated from catalogues: ratings of ISO 76 and ISO 281 are kept, drawn insides lie within the error."""

from __future__ import annotations

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import brentq

from fegear.shafts.catalogue_bearing import CatalogueBearing
from fegear.shafts.designations import KNOWN as KNOWN_DESIGNATIONS
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
    if printed.kind != "tapered":
        usual = 1.3 * 1.05 if printed.kind == "ball" else 1.1 * 1.15
        assert dynamic_rating(only.inside, usual) == pytest.approx(printed.dynamic_rating, rel=1e-9)


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
    # C_0 gives the product of length and diameter; of tapered rollers the diameter is less certain than the length.
    assert bare.error > (0.85 if printed.kind == "tapered" else 1.0) * printed.error > 0.02


def known_insides() -> list[tuple[CatalogueBearing, RollingBearing]]:
    """36 bearings whose inside is drawn by walls, gaps and rims, not by the shares that the estimate assumes.

    The rings leave the room for elements; balls are put in until the last one just passes, rollers stand a cage bar
    apart; rims and chamfers shorten rollers. A catalogue prints their ratings by ISO 76 and ISO 281.
    """
    rng, found = np.random.default_rng(20), []
    for name in rng.choice(sorted(KNOWN_DESIGNATIONS), 36, replace=False):
        k = KNOWN_DESIGNATIONS[name]
        section = 0.5 * (k.outside_diameter - k.bore)
        angle = k.contact_angle + (math.radians(rng.normal(0.0, 0.4)) if k.kind == "tapered" else 0.0)
        walls = {"ball": (0.18, 0.215), "cylindrical": (0.2, 0.27), "tapered": (0.22, 0.33), "spherical": (0.2, 0.28)}
        inner, outer = rng.uniform(*walls[k.kind], 2) * section
        size = (section - inner - outer) * math.cos(angle if k.kind != "ball" else 0.0)
        if k.kind == "ball" and 1.16 * k.width < section:  # balls do not stand out of narrow rings
            size = rng.uniform(0.62, 0.79) * k.width
            inner = outer = 0.5 * (section - size)
        pitch = k.bore + 2.0 * inner + size / (math.cos(angle) if k.kind != "ball" else 1.0)
        if k.kind == "ball":
            count = 1 + round(0.5 * math.radians(rng.uniform(175.0, 200.0)) / math.asin(size / pitch))
            if angle:
                count = int(math.pi / math.asin(size * (1.0 + rng.uniform(0.0, 0.12)) / pitch))
            grooves = tuple(rng.normal(0.525, 0.003, 2))
            made = RollingBearing("ball", count, size, pitch, angle, grooves)
        else:
            bar = size * (rng.uniform(0.12, 0.3) if k.kind == "cylindrical" else rng.uniform(0.03, 0.14))
            steep = math.degrees(angle) > 20.0
            rims = rng.uniform(0.22, 0.35) if k.kind == "tapered" else rng.uniform(0.33, 0.55)
            rims = rng.uniform(0.57, 0.67) if k.kind == "spherical" else rng.uniform(0.36, 0.5) if steep else rims
            length = (1.0 - rims) * k.width / math.cos(angle)
            count = int(math.pi / math.asin((size + bar) / pitch))
            aligning = k.kind == "spherical"
            made = RollingBearing("roller", count, size, pitch, angle, roller_length=length, aligning=aligning)
        steel = 1.3 * rng.uniform(0.95, 1.15) if k.kind == "ball" else 1.1 * rng.uniform(1.05, 1.25)
        printed = CatalogueBearing(
            k.kind, k.bore, k.outside_diameter, k.width, dynamic_rating(made, steel), static_rating(made),
            k.contact_angle or None,
        )  # fmt: skip
        found.append((printed, made))
    return found


DRAWN = known_insides()


@pytest.mark.parametrize("without", [(), ("static_rating",), ("static_rating", "dynamic_rating")])
def test_the_stiffness_of_drawn_insides_is_within_the_stated_error(without):
    """With C_0, with C only, from the envelope only."""
    shares = []
    for printed, made in DRAWN:
        estimated = replace(printed, **dict.fromkeys(without))
        load = 0.05 * static_rating(made)
        off = stiffness(estimated.inside, load) / stiffness(made, load) - 1.0
        assert estimated.error < 0.42
        shares.append(abs(off) / estimated.error)
    assert np.mean(np.array(shares) <= 1.0) >= 0.95
    assert max(shares) < 1.25
    assert np.median(shares) > 0.1  # no error stated out of all proportion
