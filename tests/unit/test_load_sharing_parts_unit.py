"""Parts of the sharing of loads that its search comes to seldom."""

import numpy as np
import pytest

from fegear.contact.contact_law import ContactLaw
from fegear.contact.plane import load_sharing
from fegear.contact.plane.load_sharing import share_load


@pytest.mark.parametrize("seed", range(4))
@pytest.mark.parametrize("coupled", [0.0, 0.3])
def test_trying_every_set_of_pairs_finds_what_the_active_sets_find(monkeypatch, seed, coupled):
    chance = np.random.default_rng(seed)
    n, positions = 3, 6
    c = coupled * chance.uniform(0.0, 1.0, (n, n, positions)) * 1e-9
    c = 0.5 * (c + c.transpose(1, 0, 2))
    c[np.arange(n), np.arange(n)] = chance.uniform(8.0, 12.0, (n, positions)) * 1e-9
    gap = chance.uniform(0.0, 20e-6, (n, positions))
    gap[0, :2] = np.inf
    law = ContactLaw(log_slope=chance.uniform(0.0, 0.5e-9, (n, positions)), reference_load=np.full((n, positions), 1e3))
    found, solve = [], load_sharing._solve

    def both(problem):
        found.append((solve(problem), load_sharing._enumerate(problem)))
        return found[-1][0]

    monkeypatch.setattr(load_sharing, "_solve", both)
    shared = share_load(c, gap, np.array([500.0, 3000.0]), law)
    (((v, z, _), (shares, approach)),) = found
    np.testing.assert_allclose(shares, v, atol=1e-10)
    np.testing.assert_allclose(approach, z, rtol=1e-9)
    np.testing.assert_allclose(shared.loads.sum(axis=0), np.broadcast_to([500.0, 3000.0], (positions, 2)), rtol=1e-12)
    assert 1 <= shared.pairs_in_contact.min() < shared.pairs_in_contact.max()


def test_where_no_set_of_pairs_holds_it_is_said(monkeypatch):
    monkeypatch.setattr(load_sharing, "_newton_step", lambda problem, active, v: (v + 0.1, np.zeros(v.shape[1])))
    problem = load_sharing._Problem(None, np.ones((2, 1)), np.zeros((2, 1)), np.ones((2, 1), dtype=bool), ContactLaw())
    with pytest.raises(load_sharing.ConvergenceError):
        load_sharing._enumerate(problem)
