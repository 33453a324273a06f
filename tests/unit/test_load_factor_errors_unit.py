"""Errors of the root factors of solved flanks: what two solutions share by chance is not stated as certain."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.wide import load_factors
from fegear.contact.wide.load_factors import (
    FactorsLeft,
    RootFactors,
    left_of_largest,
    root_factors,
    transverse_left_by_positions,
)
from fegear.results.pair.load_factors import _OF_LOAD, FlankLoadFactorsData


def factors(face, transverse, left=(0.0, 0.0)):
    return SimpleNamespace(face=face, transverse=transverse, left_by_positions=FactorsLeft(*left, 0.0))


def off(factor, coarse, by_load=0.0037, longer=None, left=(0.0, 0.0)):
    loaded = SimpleNamespace(
        at=1, error=SimpleNamespace(face_load_factor=np.array([9.0, by_load * 1.25])),
        stated=SimpleNamespace(face_load_factor=np.array([7.0, 1.25])),
    )  # fmt: skip
    root = {"driver": factors(1.0, 1.1), "driven": factors(1.2, 1.0, left)}
    again = {
        member: (root[member], *((longer[member],) if longer else ()), *((one,) if one else ()))
        for member, one in coarse.items()
    }
    return FlankLoadFactorsData.off(SimpleNamespace(loaded=loaded, root=root, again=again), factor)


def test_the_root_factor_of_the_face_errs_by_a_part_of_what_the_load_over_it_does():
    """Of a spur pair K_Fbeta was 7e-5 off where 1e-5 was stated, for both solutions agreed by chance."""
    alike = {"driver": factors(1.0 - 1e-5, 1.1017), "driven": factors(1.2, 1.0)}
    assert off("face", alike) == pytest.approx(_OF_LOAD * 0.0037)
    assert off("face", alike, by_load=0.0) == pytest.approx(1e-5)
    assert off("transverse", alike) == pytest.approx(0.0017)
    assert off("face", {"driver": factors(1.01, 1.1), "driven": factors(1.25, 1.0)}) == pytest.approx(0.05)
    assert off("face", {"driver": None, "driven": None}) is None


def test_opposite_changes_of_longer_panels_and_coarser_gears_add_up():
    """K_Falpha of a helical gear: 1.08491, 1.08535 on longer panels, 1.08517 of coarser gears, 5e-4 off."""
    longer = {"driver": factors(1.0, 1.1), "driven": factors(1.2, 1.00044)}
    coarse = {"driver": factors(1.0, 1.1), "driven": factors(1.2, 1.00026)}
    assert off("transverse", coarse) == pytest.approx(0.00026)
    assert off("transverse", coarse, longer=longer) == pytest.approx(0.00044 + 0.00018)
    # what roll positions leave open comes on top, of whichever gear it is more
    assert off("transverse", coarse, longer=longer, left=(0.0, 0.03)) == pytest.approx(0.03062)
    assert off("face", coarse, by_load=0.0, left=(0.002, 0.03)) == pytest.approx(0.002)


class Rooted:
    """A root whose largest tension is a share's, at the places that count."""

    member = "driver"

    def surface(self, _side, force, _z):
        return force

    def largest(self, _side, force, _z, surface, *, across, at=None):
        assert across
        assert surface is force
        return float(force[slice(None) if at is None else at].max())


@pytest.mark.parametrize("beside", [0.0, 0.1, 0.37, 0.5, 0.9])
@pytest.mark.parametrize("count", [8, 16, 33])
def test_what_roll_positions_miss_of_largest_shares_is_an_error_of_the_factors(monkeypatch, count, beside):
    """A share of 1.3 at a kink that stands between the positions, over one of 1 everywhere."""
    x = (np.arange(count) - count // 2 + beside) / count
    share = 1.3 - np.abs(x)
    lines = SimpleNamespace(roll=x, low=0.0, high=1.0)
    pair = SimpleNamespace(driver=SimpleNamespace(helix_angle=0.0, module=0.1))
    found, perfect = (
        SimpleNamespace(contact=SimpleNamespace(force=one[:, None, None]), pair=pair, lines=lines,
                        pair_load=one[None, :, None]) for one in (share, np.ones(count))
    )  # fmt: skip
    monkeypatch.setattr(load_factors, "even_along_the_lines", lambda _lines, force, _shortest: force)
    root = root_factors(found, perfect, Rooted(), np.zeros(1), 0)
    assert (root.face, root.left_by_positions.face) == (1.0, 0.0)
    assert root.transverse == share.max()
    left = root.left_by_positions.transverse
    assert transverse_left_by_positions(found, perfect)[0] == left
    assert 1.3 - root.transverse <= left <= 1.01 / count
    assert root.left_by_positions.largest == left  # the same share is the largest tension here
    # what is the same everywhere leaves nothing open
    assert root_factors(perfect, perfect, Rooted(), np.zeros(1), 0) == RootFactors(1.0, 1.0, 1.0)


def test_few_roll_positions_are_parted_as_far_as_they_go():
    for count, parts in ((1, 2), (2, 4), (3, 5), (16, 5)):
        every = load_factors.fewer_positions(count)
        assert len(every) == parts
        assert all(at.any() and at.size == count for _, at in every)


def test_many_roll_positions_leave_half_as_much_open():
    """Largest values of 48 positions come with the second power of their distance, of fewer as at a kink."""
    for (few, one), (many, other) in zip(
        load_factors.fewer_positions(47), load_factors.fewer_positions(48), strict=True
    ):
        assert (many, one.tolist()) == (0.5 * few, other[:47].tolist())


@pytest.mark.parametrize("count", [48, 96])
def test_largest_stress_between_positions_is_within_what_is_left_of_smooth_curves(count):
    """Two loads; smooth peaks anywhere between the positions, each position with two teeth of which one is low."""
    position = np.repeat(np.arange(count), 2)
    for beside in np.linspace(0.0, 1.0, 7):
        turn = 2.0 * np.pi * (np.arange(count) + beside) / count
        values = np.stack([3.0 + np.cos(turn), 5.0 + np.cos(turn - 0.3) ** 3], axis=1)
        both = np.stack([values, 0.5 * values], axis=1).reshape(2 * count, 2)
        left = left_of_largest(both, position, count)
        missed = np.array([4.0, 6.0]) - values.max(axis=0)
        assert (missed <= 1.5 * left + 1e-12).all()
        assert (left <= 0.04 * (48 / count) ** 2).all()
