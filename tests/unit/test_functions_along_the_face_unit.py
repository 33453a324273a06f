"""Functions along the face, of one piece or several: polynomials, continuity, mirror images, integrals, numbers."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.fem.solid.face import FaceFunctions, JoinedFunctions, face_functions, own_of_teeth

FACES = {
    "one piece": FaceFunctions((-2.5, 2.5), (6,)),
    "one piece, mirrored": FaceFunctions((-2.5, 2.5), (5,), mirrored=True),
    "web": FaceFunctions((-3.0, -1.0, 1.0, 3.0), (4, 5, 4)),
    "web, mirrored": FaceFunctions((-3.0, -1.0, 1.0, 3.0), (4, 5, 4), mirrored=True),
    "uneven": FaceFunctions((-3.0, 0.5, 1.0, 3.0), (6, 3, 4)),
}
each = pytest.mark.parametrize("face", FACES.values(), ids=FACES)


@each
def test_they_are_continuous_and_span_polynomials(face):
    ends, least = np.array(face.breaks), min(face.degrees)
    z = np.linspace(ends[0], ends[-1], 201)
    values, slopes = face.at(z)
    assert values.shape == slopes.shape == (face.count, 201)
    np.testing.assert_allclose(face.values(z), values, rtol=0, atol=0)
    for inner in ends[1:-1]:
        before, after = face.values(np.array([inner - 1e-9, inner + 1e-9])).T
        np.testing.assert_allclose(before, after, atol=1e-7)
    for n in range(least + 1):
        share, *_ = np.linalg.lstsq(values.T, z**n, rcond=None)
        np.testing.assert_allclose(share @ values, z**n, atol=1e-9 * 3.0**n)
        np.testing.assert_allclose(share @ slopes, n * z ** max(n - 1, 0), atol=1e-8 * 3.0**n)
    assert np.linalg.matrix_rank(values) == face.count


@each
def test_slopes_are_those_of_the_values(face):
    z = np.linspace(face.breaks[0] + 0.01, face.breaks[-1] - 0.013, 60)
    z = z[np.abs(z[:, None] - np.array(face.breaks)).min(axis=1) > 1e-3]
    h = 1e-6
    by_difference = (face.values(z + h) - face.values(z - h)) / (2.0 * h)
    np.testing.assert_allclose(face.at(z)[1], by_difference, atol=1e-7)


@each
def test_integrals_of_products_are_those_of_a_fine_rule(face):
    low, high = face.breaks[0], face.breaks[-1]
    x, w = np.polynomial.legendre.leggauss(12)
    z = np.concatenate([0.5 * (a + b) + 0.5 * (b - a) * x for a, b in zip(face.breaks, face.breaks[1:], strict=False)])
    weight = np.concatenate([0.5 * (b - a) * w for a, b in zip(face.breaks, face.breaks[1:], strict=False)])
    values, slopes = face.at(z)
    for found, left, right in zip(face.products, (values, values, slopes), (values, slopes, slopes), strict=True):
        np.testing.assert_allclose(found, (left * weight) @ right.T, atol=1e-11)
    part = face.products_over(face.breaks[0], face.breaks[1])
    rest = face.products_over(face.breaks[1], high) if len(face.breaks) > 2 else (0.0, 0.0, 0.0)
    for whole, one, other in zip(face.products, part, rest, strict=True):
        np.testing.assert_allclose(one + other, whole, atol=1e-11)
    stretch = face.products_over(low, high, lambda place: 1.0 + 0.0 * place + 0.5)
    for k, (found, plain) in enumerate(zip(stretch, face.products, strict=True)):
        np.testing.assert_allclose(found, plain * 1.5 ** (1 - k), atol=1e-11)


@pytest.mark.parametrize("name", ["one piece", "one piece, mirrored", "web, mirrored"])
def test_even_and_odd_functions_are_even_and_odd(name):
    face = FACES[name]
    z = np.linspace(0.05, face.breaks[-1] - 0.05, 37)
    sign = np.where(face.odd, -1.0, 1.0)[:, None]
    np.testing.assert_allclose(face.values(-z), sign * face.values(z), atol=1e-10)
    assert face.odd.any()
    assert not face.odd.all()


def test_pieces_that_mirror_each_other_have_the_same_functions_joined():
    """The even one of each pair first: their sum, and then their difference."""
    plain, joined = FACES["web"], FACES["web, mirrored"]
    z = np.linspace(-3.0, 3.0, 101)
    own, both = plain.values(z), joined.values(z)
    assert np.linalg.matrix_rank(np.vstack([own, both])) == plain.count
    for i, (other, sign) in enumerate(joined._mirror):
        np.testing.assert_allclose(plain.values(-z)[i], sign * own[other], atol=1e-10)
        if i < other:
            np.testing.assert_allclose(both[i], own[i] + sign * own[other], atol=1e-12)
            np.testing.assert_allclose(both[other], own[i] - sign * own[other], atol=1e-12)


@each
def test_functions_of_a_piece_are_known_by_number(face):
    """Those that vanish on it, those of a low degree, and how many treat pieces of one length alike."""
    for i, (low, high) in enumerate(zip(face.breaks, face.breaks[1:], strict=False)):
        z = np.linspace(low + 1e-6, high - 1e-6, 41)
        there = np.abs(FaceFunctions(face.breaks, face.degrees).values(z)).max(axis=1) > 1e-9
        assert face.vanishing_on(low, high).tolist() == np.flatnonzero(~there).tolist()
        assert face.degree_on(low, high) == face.degrees[i]
        few = face.low_on(low, high, 2)
        assert few.size == 3
        assert set(few) <= set(np.flatnonzero(there))
    assert face.degree_on(-math.inf, math.inf) == max(face.degrees)
    assert face.vanishing_on(-math.inf, math.inf).size == 0
    assert face.vanishing_on(50.0, 60.0).tolist() == list(range(face.count))


def test_counts_never_part_pieces_of_one_length():
    face = FACES["web"]  # four ends, then by degree over length: pieces of 2, each of a degree 2, then 3, ...
    waves = [wave for wave, _, _ in face._inner]
    assert waves == sorted(waves)
    counts = face.full_counts
    assert counts.size == face.count + 1
    assert (np.diff(counts) >= 0).all()
    assert (counts >= np.arange(face.count + 1)).all()
    assert counts[-1] == face.count
    ends = len(face.breaks)
    for count in set(counts.tolist()):
        if ends < count < face.count:
            assert waves[count - ends] > waves[count - ends - 1]
    one = FACES["one piece"].full_counts
    assert one[-1] == 7


def test_points_of_the_rule_integrate_what_they_can():
    face = FACES["uneven"]
    for least, degree in ((0, 7), (8, 17)):
        z, w = face.quadrature(least=least)
        for n in range(degree + 1):
            exact = (3.0 ** (n + 1) - (-3.0) ** (n + 1)) / (n + 1)
            assert w @ z**n == pytest.approx(exact, rel=1e-11, abs=1e-7)
    z, w = face.quadrature(0.5, 1.0)
    assert w.sum() == pytest.approx(0.5)
    assert ((z > 0.5) & (z < 1.0)).all()


def test_functions_of_a_body_and_of_teeth_stand_behind_one_another():
    both = JoinedFunctions(FACES["web"], FACES["one piece"])
    assert both.odd.size == FACES["web"].count + FACES["one piece"].count
    wide = FaceFunctions((-3.0, 3.0), (6,))
    found = JoinedFunctions(FACES["web"], wide).products_over(-math.inf, math.inf)
    n = FACES["web"].count
    for part, body, teeth in zip(found, FACES["web"].products, wide.products, strict=True):
        np.testing.assert_allclose(part[:n, :n], body, atol=1e-11)
        np.testing.assert_allclose(part[n:, n:], teeth, atol=1e-11)
    np.testing.assert_allclose(found[1][:n, n:] + found[1][n:, :n].T, _ends(FACES["web"], wide), atol=1e-10)


def _ends(one, other):
    """Integral of (P Q)': by parts, what stands at the ends of the face."""
    at = np.array([-3.0, 3.0])
    left, right = one.values(at), other.values(at)
    return np.outer(left[:, 1], right[:, 1]) - np.outer(left[:, 0], right[:, 0])


def test_cuts_become_breaks_and_degrees_follow_lengths():
    face = face_functions(6.0, 10, cuts=(1.0, -1.0, 3.0, -3.0, 1.0 + 1e-9), least=4, fewer=1, mirrored=True)
    assert face.breaks == (-3.0, -1.0, 1.0, 3.0)
    assert face.degrees == (4, 4, 4)
    assert face.mirrored
    long = face_functions(6.0, 20, cuts=(-2.0,))
    assert long.breaks == (-3.0, -2.0, 3.0)
    assert long.degrees == (round(20 * (1 / 6) ** 0.6), round(20 * (5 / 6) ** 0.6))
    assert face_functions(5.0, 7).degrees == (7,)
    assert face_functions(5.0, 7, cuts=(2.5, -2.5, 9.0)).breaks == (-2.5, 2.5)


def test_teeth_on_a_deep_rim_have_functions_of_their_own():
    body, web = SimpleNamespace(rim_radius=10.0), FACES["web"]
    assert own_of_teeth(web, body, 12.0) == 11.0
    assert own_of_teeth(web, body, 11.3) == math.inf
    assert own_of_teeth(web, None, 12.0) == math.inf
    assert own_of_teeth(FACES["one piece"], body, 12.0) == math.inf
