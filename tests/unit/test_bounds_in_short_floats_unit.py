"""Elimination in floats of four bytes beside that in long ones: its bounds of round-off hold, and are not idle.

Random networks of up to seven nodes, trees and loops, with dampers to ground and dampers that slip.
"""

import numpy as np
import pytest

from fegear.dynamics.train.branches import Branches, Ways
from fegear.dynamics.train.network import Link, Network, Slip
from fegear.dynamics.train.star_mesh import respond

EPS = float(np.finfo(np.float32).eps)
W = np.geomspace(1e-3, 60.0, 12).astype(np.float32)


def network(seed, kind, loops, slips):
    """The same numbers in floats of any kind: those of four bytes."""
    chance = np.random.default_rng(seed)
    size = int(chance.integers(3, 8))

    def short(low=-2.0, high=2.0):
        return kind(np.float32(10.0 ** chance.uniform(low, high)))

    ends = [(node, int(chance.integers(node))) for node in range(1, size)]
    ends += [tuple(int(one) for one in chance.choice(size, 2, replace=False)) for _ in range(loops)]
    links = tuple(Link(a, b, short(), short(-4.0, 0.0), mesh if mesh < 2 else -1) for mesh, (a, b) in enumerate(ends))
    turns = np.array([short(), -short()], dtype=kind)
    slipping = []
    for _ in range(slips):
        a, b = (int(one) for one in chance.choice(size, 2, replace=False))
        slipping.append(Slip(a, b, short(-1.0, 1.0), -short(-1.0, 1.0), short(-3.0, 1.0)))
    mass = np.array([short() for _ in range(size)], dtype=kind)
    ground = np.array([short(-3.0, 1.0) * (chance.random() < 0.4) for _ in range(size)], dtype=kind)
    return Network(size, mass, ground, links, tuple(slipping), turns)


def answers(one, w, mesh, variant):
    """Own increment and lag of the other pair, with their bounds; of trees both ways to them."""
    order = one.order(mesh, variant)
    found = [respond(one, w, mesh, order)]
    if one.branches_only and not variant:
        found.append(Ways(one, Branches.of(one), w).respond(mesh))
    return [(part.value, part.error) for each in found for part in (each.own, each.lags[1 - mesh])]


@pytest.mark.parametrize(("loops", "slips", "usual"), [(0, 0, 29.0), (2, 0, 29.0), (0, 1, 54.0), (1, 2, 92.0)])
def test_bounds_hold_and_are_near(loops, slips, usual):
    """None is exceeded; how many times the error they are shows a term too few or too many."""
    ratios, exact_ones = [], []
    for seed in range(12):
        short, long = (network(seed, kind, loops, slips) for kind in (np.float32, np.longdouble))
        for mesh, variant in ((0, 0), (1, 0), (0, 1)):
            exact = answers(long, W.astype(np.longdouble), mesh, variant)
            for (value, error), (true, _) in zip(answers(short, W, mesh, variant), exact, strict=True):
                off = np.abs(value.astype(np.clongdouble) - true).astype(float)
                bound = EPS * error.astype(float)
                assert (off <= bound + 1e-37).all(), (seed, mesh, variant)
                ratios += (bound / np.maximum(off, 1e-300))[off > 0.0].tolist()
            exact_ones.append(exact)
    assert np.median(ratios) == pytest.approx(usual, rel=0.12)
    # both orders of elimination are of one mind, and along branches both ways
    for first, other in zip(exact_ones[::3], exact_ones[2::3], strict=True):
        for k, (value, _) in enumerate(first):
            again = other[k % 2][0]
            np.testing.assert_allclose(value.astype(complex), again.astype(complex), rtol=1e-9, atol=1e-300)
