"""What narrows a pressed band to a contact: the half-space's spectrum, profiles along the face, the plane limit."""

import itertools
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad
from scipy.special import j1

from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import influence_of_shape
from fegear.fem.solid.bands import (
    band_cosines,
    band_spectrum,
    bands,
    function_cosines,
    hats,
    overlap,
    profile_moments,
    profiles_at,
)
from fegear.fem.solid.contact import line_compliance
from fegear.fem.solid.face import face_functions
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

TOOTH = Tooth(28, BasicRack(1.0, 1.25, 0.25))
BORE = 0.7 * TOOTH.root_radius


@pytest.mark.parametrize("kw", [0.03, 1.0, 7.0])
def test_the_spectrum_of_a_band_is_the_one_of_its_pressure_s_transform(kw):
    """Independent: the transform of a semi-ellipse is 2 J_1(t) / t, a line load's answer 1 / sqrt(t^2 + k^2)."""

    def transform(t):
        return 8.0 * j1(t) ** 2 / (t**2 * math.hypot(t, kw))

    ends = np.concatenate([[0.0, min(kw, 1.0)], np.arange(1.0, 400.0) * np.pi])
    wanted = sum(quad(transform, low, high)[0] for low, high in itertools.pairwise(ends))
    tail = 8.0 / (np.pi * 3.0 * ends[-1] ** 3)  # J_1^2 is 1 / (pi t) on average
    assert band_spectrum(np.array([kw]))[0] == pytest.approx(wanted + tail, rel=1e-8)


def test_long_and_short_waves_have_their_limits():
    long, short = np.array([0.99e-4, 1.01e-4, 1e-9]), np.array([1e3, 1e4])
    np.testing.assert_allclose(band_spectrum(long), 2.0 * (np.log(4.0 / long) - np.euler_gamma + 0.25), rtol=1e-8)
    np.testing.assert_allclose(band_spectrum(short), 32.0 / (3.0 * np.pi * short), rtol=1e-4)


PROFILES = [
    hats(14.0, np.array([-2.0, -0.7, 0.1, 2.0]), 0.2),
    bands(14.0, [-1.2, 0.3], 0.8, 0.2, profile="even"),
    bands(14.0, [-1.2, 0.3], [0.8, 0.5], 0.2),  # hats that stand in no row
    bands(14.0, [-2.0, 0.3, 2.0], [0.0, 0.9, 0.4], 0.2, after=[0.7, 0.6, 0.0]),  # halves at the ends of the face
]


@pytest.mark.parametrize("line", PROFILES)
def test_integrals_of_profiles_are_what_a_quadrature_finds(line):
    face, width = face_functions(4.0, 9), 4.0
    found, moments, common = band_cosines(line, width, 12), profile_moments(line, face), overlap(line)
    for i in range(line.count):
        at = line.zeta[i]
        ends = (at - line.before[i], at, at + line.after[i])
        z, weight = np.polynomial.legendre.leggauss(40)
        points = [(0.5 * (low + high) + 0.5 * (high - low) * z, 0.5 * (high - low) * weight)
                  for low, high in itertools.pairwise(ends)]  # fmt: skip
        z, weight = np.concatenate([x for x, _ in points]), np.concatenate([w for _, w in points])
        load = profiles_at(line, z)[i] * weight
        assert load.sum() == pytest.approx(1.0, abs=1e-12)
        waves = np.cos(np.multiply.outer(np.arange(13) * np.pi / width, z + 0.5 * width)) @ load
        np.testing.assert_allclose(found[i], waves, atol=1e-12)
        np.testing.assert_allclose(moments[:, i], face.at(z)[0] @ load, atol=1e-12)
        assert common[i, i] == pytest.approx(profiles_at(line, z)[i] @ load, abs=1e-12)


def test_cosines_of_the_functions_along_the_face():
    face = face_functions(3.0, 7, (-1.5, 0.2))
    cosines, plain = function_cosines(face, 40)
    z, weight = np.polynomial.legendre.leggauss(400)
    ends = np.array(face.breaks)
    for k in (0, 2, face.count - 1):
        total, waves = 0.0, np.zeros(40)
        for low, high in itertools.pairwise(ends):
            at = 0.5 * (low + high) + 0.5 * (high - low) * z
            values = face.at(at)[0][k] * weight * 0.5 * (high - low)
            total += values.sum()
            waves += np.cos(np.multiply.outer(np.arange(1, 41) * np.pi / 3.0, at + 1.5)) @ values
        assert plain[k] == pytest.approx(total, abs=1e-12)
        np.testing.assert_allclose(cosines[k], waves, atol=1e-12)


def test_functions_of_pieces_that_mirror_each_other_are_even_or_odd_and_span_the_same():
    """Of a face whose web ends alike on both sides, a function for each end and each degree of each piece."""
    plain, face = (face_functions(6.0, 8, (-1.0, 1.0), mirrored=both) for both in (False, True))
    z = np.linspace(-3.0, 3.0, 61)
    (values, slopes), (own, own_slopes) = face.at(z), plain.at(z)
    assert face.odd.shape == (face.count,)
    assert 0 < face.odd.sum() < face.count
    for sign, chosen in ((1.0, ~face.odd), (-1.0, face.odd)):
        np.testing.assert_allclose(values[chosen][:, ::-1], sign * values[chosen], atol=1e-12)
        np.testing.assert_allclose(face.values(z)[chosen], values[chosen], atol=1e-14)
    # The same space: one basis in the other without anything left, and slopes by the same numbers.
    by = np.linalg.lstsq(own.T, values.T, rcond=None)[0].T
    np.testing.assert_allclose(by @ own, values, atol=1e-10)
    inside = (np.abs(np.abs(z) - 1.0) > 1e-9) & (np.abs(z) < 3.0)
    np.testing.assert_allclose((by @ own_slopes)[:, inside], slopes[:, inside], atol=1e-9)
    assert np.linalg.matrix_rank(by) == face.count
    one = face_functions(6.0, 8)
    np.testing.assert_allclose(one.values(z)[one.odd][:, ::-1], -one.values(z)[one.odd], atol=1e-12)
    np.testing.assert_allclose(one.values(z)[~one.odd][:, ::-1], one.values(z)[~one.odd], atol=1e-12)
    # Those of a piece that rise no further than a degree: its two ends, and the others below it.
    low = plain.low_on(-1.0, 1.0, 3)
    assert low.size == 4
    within = (z > -1.0) & (z < 1.0)
    for k in low:
        fit = np.polynomial.polynomial.polyval(
            z[within], np.polynomial.polynomial.polyfit(z[within], own[k][within], 3)
        )
        np.testing.assert_allclose(fit, own[k][within], atol=1e-10)


@pytest.mark.parametrize("stretch", [1.0, 1.6])
def test_products_over_a_stretched_piece_are_those_of_a_longer_one(stretch):
    """Where every length is so many times as long, slopes are less and what is integrated over is more."""
    face = face_functions(6.0, 6, (-1.0, 1.0))
    plain = face.products_over(-1.0, 1.0)
    found = face.products_over(-1.0, 1.0, lambda place: np.full(place.size, stretch))
    for one, other, power in zip(plain, found, (1, 0, -1), strict=True):
        np.testing.assert_allclose(other, one * stretch**power, rtol=1e-12, atol=1e-12 * np.abs(one).max())


@pytest.mark.dear
def test_narrowed_bands_of_a_plane_tooth_are_the_plane_contacts():
    """Within .1 % over the middle of the flank, .6 % down to 7 % of its length from both ends."""
    fine = settings_at(0)
    plane = influence_of_shape(TOOTH, BORE, 0.3, "strain", fine, 0)
    settings = replace(SolidSettings(), least_degree=3, waves_per_module=1e-3)
    solid = solve_solid(TOOTH, 0.0, 2.0, 0.3, BORE, settings, reach=0, plane_strain=True)
    share = np.array([0.07, 0.15, 0.3, 0.5, 0.7, 0.85, 0.93])
    flank = solid.flank
    radius = flank.radius_of_arc(flank.flank_start + share * (flank.flank_end - flank.flank_start))
    wanted = plane.self_compliance(radius, fine.patch_half_width, 0.02)
    found = [
        2.0 * line_compliance(solid, bands(r, 0.0, 1.0, solid.band_half_width(r), profile="even"), 0.02)[0, 0]
        for r in radius
    ]
    error = np.abs(np.array(found) / wanted - 1.0)
    assert error.max() < 6e-3
    assert error[1:-1].max() < 1.2e-3


@pytest.mark.dear
@pytest.mark.parametrize("twist", [pytest.param(0.0, marks=pytest.mark.long), 0.026])
def test_a_contact_does_not_know_how_wide_it_was_pressed_nor_on_which_polynomials(twist):
    """Wide bands on few functions and narrow ones on many, both narrowed to the same contacts, at the end faces too."""
    base, found = SolidSettings(), []
    for degree, width, edge in ((5, 0.25, 0.3), (8, 0.17, 0.2)):
        section = replace(base.section, flank_edge_length=edge)
        settings = replace(base, section=section, least_degree=degree, waves_per_module=1e-3, band_half_width=width)
        known = solve_solid(TOOTH, twist, 2.0, 0.3, 0.85 * TOOTH.root_radius, settings, reach=0)
        stations = np.linspace(-1.0, 1.0, 5)
        rolled = math.sqrt(13.95**2 - TOOTH.base_radius**2) - twist * TOOTH.base_radius * stations
        radius = np.hypot(TOOTH.base_radius, rolled)
        line = hats(radius, stations, known.band_half_width(radius), slope=known.line_slope(radius))
        raw = known.deflection(0, line, line)
        found.append((line_compliance(known, line, 0.02), raw))
    (wide, raw_wide), (narrow, raw_narrow) = found
    size = np.sqrt(np.outer(np.diagonal(narrow), np.diagonal(narrow)))
    assert np.abs((wide - narrow) / size).max() < 6e-3
    assert np.abs((raw_wide - raw_narrow) / np.diagonal(raw_narrow)).max() > 0.02
    np.testing.assert_allclose(wide, wide.T, rtol=1e-9)
