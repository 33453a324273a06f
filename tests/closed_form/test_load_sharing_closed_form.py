"""Load sharing against brute force and closed forms, on arrays: no gear needed."""

from itertools import product

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.optimize import brentq

from fegear.base.errors import InputError, RangeError
from fegear.contact.contact_law import ContactLaw
from fegear.contact.plane.load_sharing import share_load


def own(w, c, kappa, ref):
    return c * w - (0.5 * kappa * w * np.log(w / ref) if w > 0 else 0.0)


def brute_force(c, e, total, kappa, ref):
    """Every set of loaded pairs, its equations solved by a general root finder in high-level form; small n only."""
    from scipy.optimize import root

    n = len(e)
    answers = []
    scale = float(np.max(np.diag(c)) * total)
    for bits in product((0, 1), repeat=n):
        s = [j for j in range(n) if bits[j]]
        if not s or not all(np.isfinite(e[s])):
            continue

        def equations(y, s=s):
            w, z = np.abs(y[:-1]) * total, y[-1] * scale
            rows = []
            for a, j in enumerate(s):
                others = sum(c[j, k] * w[b] for b, k in enumerate(s) if k != j)
                rows.append((own(w[a], c[j, j], kappa[j], ref[j]) + others + e[j] - z) / scale)
            return np.array([*rows, np.sum(y[:-1]) - 1.0])

        c_mean = np.diag(c)[s]
        guess = (1 / c_mean) / (1 / c_mean).sum()
        # Where one load is small, the search from equal shares may end at its mirror image below zero.
        starts = [guess, *(np.where(np.arange(len(s)) == a, 1e-2, guess) for a in range(len(s)))]
        level = (guess @ c_mean + np.mean(e[s]) / total) * total / scale
        tries = (root(equations, [*start, level], tol=1e-15) for start in starts)
        found = (t for t in tries if np.abs(equations(t.x)).max() <= 1e-11 and (t.x[:-1] >= -1e-11).all())
        solution = next(found, None)
        if solution is None:
            continue
        w = np.zeros(n)
        w[s] = solution.x[:-1] * total
        z = solution.x[-1] * scale
        gaps = [c[j] @ w + e[j] - z for j in range(n) if not bits[j] and np.isfinite(e[j])]
        if all(g >= -1e-11 * scale for g in gaps):
            answers.append((w, z))
    return answers


@st.composite
def problems(draw):
    n = draw(st.integers(1, 4))
    own_c = np.array([draw(st.floats(0.5, 4.0)) for _ in range(n)])
    coupling = draw(st.sampled_from([0.0, 0.1, 0.3]))
    c = np.diag(own_c)
    for j in range(n):
        for k in range(j):
            c[j, k] = c[k, j] = coupling ** (j - k) * np.sqrt(own_c[j] * own_c[k]) * draw(st.floats(-0.3, 1.0))
    e = np.array([draw(st.floats(-2.0, 2.0)) for _ in range(n)])
    total = 10.0 ** draw(st.floats(-3.0, 1.0))
    kappa = np.full(n, draw(st.sampled_from([0.0, 0.02, 0.1])))
    return c, e, total, kappa, np.ones(n)


@given(problems())
def test_agrees_with_brute_force(problem):
    c, e, total, kappa, ref = problem
    got = share_load(c[:, :, None], e[:, None], [total], ContactLaw(kappa[:, None], ref[:, None]))
    w, z = got.loads[:, 0, 0], got.transmission_error[0, 0]
    answers = brute_force(c, e, total, kappa, ref)
    assert answers, "brute force found nothing"
    assert min(np.abs(w - a[0]).max() for a in answers) <= 1e-10 * total
    assert min(abs(z - a[1]) for a in answers) <= 1e-10 * (np.diag(c).max() * total + np.abs(e).max())
    assert w.sum() == pytest.approx(total, rel=1e-14)
    assert (w >= 0).all()
    deflection = [own(w[j], c[j, j], kappa[j], 1.0) + sum(c[j, k] * w[k] for k in range(len(w)) if k != j)
                  for j in range(len(w))]  # fmt: skip
    gap = np.array(deflection) + e - z
    scale = np.diag(c).max() * total + np.abs(e).max()
    assert gap.min() >= -1e-12 * scale  # no penetration
    assert np.abs(gap[w > 1e-9 * total]).max() <= 1e-12 * scale  # contact where loaded


@given(problems(), st.integers(0, 10**6))
def test_the_order_of_the_pairs_does_not_matter(problem, seed):
    c, e, total, kappa, ref = problem
    order = np.random.default_rng(seed).permutation(len(e))
    law = ContactLaw(kappa[:, None], ref[:, None])
    a = share_load(c[:, :, None], e[:, None], [total], law)
    b = share_load(
        c[np.ix_(order, order)][:, :, None], e[order][:, None], [total], ContactLaw(kappa[:, None], ref[:, None])
    )
    np.testing.assert_allclose(b.loads[:, 0, 0], a.loads[order, 0, 0], atol=1e-12 * total)


@given(st.floats(-3, 7), st.floats(-7, -4), st.floats(0.0, 1.0))
def test_two_pairs_with_a_logarithm_over_ten_decades_of_load(log_load, log_error, skew):
    """Two uncoupled pairs: one monotone equation in the first load, solved by bracketing."""
    total, e2 = 10.0**log_load, 10.0**log_error * skew  # [N/m], [m]
    c1, c2, kappa, ref = 8e-11, 9e-11, 5.6e-12, 3.5e5
    got = share_load(np.diag([c1, c2])[:, :, None], [[0.0], [e2]], [total], ContactLaw(kappa, ref))

    def misfit(w):
        return own(w, c1, kappa, ref) - own(total - w, c2, kappa, ref) - e2

    w1 = total if misfit(total) <= 0 else brentq(misfit, 0.0, total, xtol=1e-16 * total, rtol=1e-15)
    assert got.loads[0, 0, 0] == pytest.approx(w1, abs=1e-12 * total)
    assert got.transmission_error[0, 0] == pytest.approx(own(w1, c1, kappa, ref), rel=1e-10, abs=0.0)


def test_many_positions_and_loads_are_the_same_as_one_by_one():
    rng = np.random.default_rng(3)
    n, positions, loads = 3, 7, np.array([1e-3, 0.1, 1.0, 5.0])
    c = np.zeros((n, n, positions))
    for p in range(positions):
        a = rng.random((n, n))
        c[:, :, p] = np.eye(n) * 2 + 0.1 * (a + a.T)
    e = rng.normal(size=(n, positions))
    e[2, :3] = np.inf
    together = share_load(c, e, loads, ContactLaw(0.05))
    for p in range(positions):
        for i, w in enumerate(loads):
            alone = share_load(c[:, :, [p]], e[:, [p]], [w], ContactLaw(0.05))
            np.testing.assert_allclose(together.loads[:, p, i], alone.loads[:, 0, 0], rtol=0, atol=1e-13 * w)
    assert (together.loads[2, :3] == 0).all()


def test_a_small_load_rests_on_the_nearest_pair_alone():
    got = share_load(np.diag([1.0, 1.0])[:, :, None], [[1e-3], [0.0]], [1e-6], ContactLaw(0.03))
    assert got.loads[0, 0, 0] == 0.0
    assert got.loads[1, 0, 0] == pytest.approx(1e-6, rel=1e-14)
    assert got.pairs_in_contact[0, 0] == 1


def test_wrong_questions_are_refused():
    with pytest.raises(InputError, match="must be positive"):
        share_load(np.ones((1, 1, 1)), [[0.0]], [0.0])
    with pytest.raises(InputError, match="no tooth pair in contact there"):
        share_load(np.ones((1, 1, 2)), [[0.0, np.inf]], [1.0])
    with pytest.raises(RangeError, match="is too high"):
        share_load(np.ones((1, 1, 1)), [[0.0]], [1e30], ContactLaw(0.1))


def test_a_pair_that_only_just_touches_is_settled_like_any_other():
    """Its share keeps moving by the round-off of the whole load; that once cost forty steps and all sets in turn."""
    c, kappa, ref, total = np.array([[2.1e-9, 3.3e-10], [3.3e-10, 1.9e-9]]), 3.7e-10, 1000.0, 1234.5
    apart = own(total, c[0, 0], kappa, ref) - c[1, 0] * total  # the second pair is just not reached
    short = apart * (1.0 - 10.0 ** -np.linspace(4.0, 13.0, 200))
    found = share_load(
        np.tile(c[:, :, None], short.size), np.stack([np.zeros(short.size), short]), [total], ContactLaw(kappa, ref)
    )
    assert found.steps < 15
    w, z = found.loads[:, :, 0], found.transmission_error[:, 0]
    assert (w[1] > 0.0).sum() > 150
    assert (np.diff(w[1]) <= 1e-15 * total).all()
    deflected = np.array([own(one, c[1, 1], kappa, ref) for one in w[1]]) + c[1, 0] * w[0] + short
    np.testing.assert_allclose(deflected[w[1] > 0.0], z[w[1] > 0.0], rtol=1e-13)
    # pairs that are nowhere in reach change nothing
    wide = np.zeros((4, 4, short.size))
    wide[1:3, 1:3] = c[:, :, None]
    wide[0, 0] = wide[3, 3] = 1.0
    far = np.full((1, short.size), np.inf)
    again = share_load(
        wide, np.concatenate([far, np.zeros((1, short.size)), short[None], far]), [total], ContactLaw(kappa, ref)
    )
    assert (again.loads[1:3] == found.loads).all()
    assert not again.loads[[0, 3]].any()
    assert (again.transmission_error == found.transmission_error).all()
