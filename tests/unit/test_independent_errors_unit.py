"""Errors of single tooth pairs reach the loads and the transmission error as solving again with them does."""

from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.plane import independent_errors as module
from fegear.contact.plane.closed_form_compliance import closed_form_compliance
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.independent_errors import independent_errors
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair

SOFTER = 1e-6


@pytest.fixture(scope="module")
def loaded():
    gears = [Gear(Tooth(z), 3e-3, 0.3 * z * 3e-3, 0.02) for z in (28, 41)]
    pair = GearPair(*gears)
    sources = [closed_form_compliance(gear, "weber-banaschek") for gear in gears]
    e = Engagement(PairCompliance(pair, *sources, False, "load-dependent", 2000.0))
    x = pair.x_start + pair.base_pitch * (np.arange(9) + 0.37) / 9
    return e.solve(e.grid(x), [500.0, 2000.0])


def softened(matrices, pairs):
    """Matrices whose pairs are softer by a share of their own compliance."""
    c = matrices.compliance.copy()
    for j in pairs:
        c[j, j] *= 1.0 + SOFTER
    return replace(matrices, compliance=c)


def errors(loaded):
    matrices = loaded.grid.matrices
    every = softened(matrices, range(loaded.loads.shape[0]))
    shifted = SimpleNamespace(matrices=lambda _contacts, _cycle: every)
    contacts = loaded.grid.contacts
    return independent_errors(loaded, [shifted], (float(contacts.x.min()), float(contacts.x.max())))


def solved_again(loaded, pairs):
    m = softened(loaded.grid.matrices, pairs)
    return m.share(loaded.separation, loaded.load)


def test_loads_change_as_with_each_pair_softer_by_itself(loaded):
    n = loaded.loads.shape[0]
    single = [solved_again(loaded, [j]).loads - loaded.loads for j in range(n)]
    wanted = module._OWN_PART * np.sqrt(np.sum(np.square(single), axis=0))
    got = errors(loaded).load
    assert got == pytest.approx(wanted, abs=3e-4 * wanted.max())
    two = (loaded.loads > 0.0).sum(axis=0) > 1
    assert two.any()
    assert not two.all()
    # two pairs that are softer alike hardly change the sharing; by themselves they do, at every position
    alike = np.abs(solved_again(loaded, range(n)).loads - loaded.loads)
    carrying = (loaded.loads > 0.0) & two
    assert (got[carrying] > 0.1 * got.max()).all()
    assert alike[carrying].min() < 0.1 * got[carrying].min()


def test_a_pair_that_carries_all_has_an_exact_load(loaded):
    alone = (loaded.loads > 0.0).sum(axis=0) == 1
    assert errors(loaded).load[:, alone] == pytest.approx(0.0, abs=1e-12 * loaded.load.max())


def test_the_transmission_error_changes_its_sign_along_the_path_where_one_pair_carries(loaded):
    change = errors(loaded).transmission_error[0]
    first = solved_again(loaded, range(loaded.loads.shape[0])).transmission_error - loaded.transmission_error
    assert (np.abs(change) <= module._ALONG_PART * first * (1.0 + 1e-3)).all()
    assert np.ptp(change[:, 0]) > 0.0
