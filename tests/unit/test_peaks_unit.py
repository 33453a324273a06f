"""Largest values of curves between their samples: smooth maxima, kinks, jumps, and several curves at a time."""

import numpy as np
import pytest

from fegear.contact.plane.peaks import refined_peaks

X = np.linspace(0.0, 1.0, 33)


def smooth(x):
    return 3.0 - (x - 0.3141) ** 2


def kink(x):
    """As a tooth's stress where the next pair begins to bear: it rises slowly and falls steeply."""
    return np.where(x < 0.7077, 1.0 + 0.2 * x, 1.0 + 0.2 * 0.7077 - 9.0 * (x - 0.7077))


def jump(x):
    return np.where(x < 0.5, 2.0 * x, 0.0)


def two_hills(x):
    """The hill whose samples are the lower one is the higher."""
    return np.maximum(1.0 - 3.0 * np.abs(x - 0.25), 1.03 - 3.0 * np.abs(x - 0.734375))


def negative(x):
    return -5.0 - np.abs(x - 0.111)


@pytest.mark.parametrize(
    ("curve", "at", "largest", "off"),
    [
        (smooth, 0.3141, 3.0, 1e-9),
        (kink, 0.7077, 1.0 + 0.2 * 0.7077, 2e-4),
        (two_hills, 0.734375, 1.03, 1e-4),
        (negative, 0.111, -5.0, 1e-4),
    ],
)
def test_one_curve(curve, at, largest, off):
    (found,), (value,) = refined_peaks(lambda x: curve(x)[None], X)
    assert found == pytest.approx(at, abs=1e-4)
    assert value == pytest.approx(largest, abs=off)
    assert value >= curve(X).max()


def test_both_sides_of_a_jump_among_the_samples_keep_its_height():
    x = np.sort(np.append(X, [0.5 - 1e-7, 0.5 + 1e-7]))
    (found,), (value,) = refined_peaks(lambda x: jump(x)[None], x)
    assert value == pytest.approx(1.0, abs=1e-6)
    assert found < 0.5


def test_several_curves_are_followed_each_to_its_own_peak():
    curves = (smooth, kink, two_hills, negative)
    at, value = refined_peaks(lambda x: np.array([curve(x) for curve in curves]), X)
    for number, curve in enumerate(curves):
        alone = refined_peaks(lambda x, curve=curve: curve(x)[None], X)
        assert (at[number], value[number]) == (alone[0][0], alone[1][0])


def test_the_largest_sample_at_an_end_stays_within_the_samples():
    (found,), (value,) = refined_peaks(lambda x: -x[None], X)
    assert (found, value) == (0.0, 0.0)


@pytest.mark.parametrize("sign", [1.0, -1.0])
def test_of_two_peaks_that_are_alike_the_last_bit_chooses_none(sign):
    """A symmetric pair: the place of its largest pressure changed its sign with the last bit of either peak."""

    def hills(x):
        higher = np.where(sign * (x - 0.5) > 0.0, 1.0 + 4e-16, 1.0)
        return (higher * (2.0 - np.abs(np.abs(x - 0.5) - 0.203)))[None]

    (at,), (largest,) = refined_peaks(hills, X)
    assert at == pytest.approx(0.297, abs=1e-4)
    assert largest == pytest.approx(2.0, abs=1e-4)
