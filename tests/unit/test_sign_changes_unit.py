"""All changes of sign between sample points: of several functions in one cell, and of one that turns back."""

import numpy as np
import pytest

from fegear.contact.sign_changes import sign_changes


def found(functions, samples=13, passes=6):
    x = np.linspace(0.0, 1.0, samples)
    return sign_changes(lambda at: np.array([f(at) for f in functions]), x, np.zeros(samples, dtype=int), passes)


def test_two_functions_change_in_one_cell():
    assert found([lambda x: x - 0.51, lambda x: 0.53 - x, lambda x: x - 0.55]) == pytest.approx([0.51, 0.53, 0.55])


@pytest.mark.parametrize("sign", [1.0, -1.0])
@pytest.mark.parametrize("half", [0.03, 0.01, 1e-3])
def test_a_function_that_turns_back_within_a_cell_has_two_changes(half, sign):
    assert found([lambda x: sign * ((x - 0.54) ** 2 - half**2)]) == pytest.approx([0.54 - half, 0.54 + half])


def test_a_function_that_comes_near_and_turns_has_none():
    assert found([lambda x: (x - 0.54) ** 2 + 1e-6]).size == 0


def test_jumps_between_pieces_are_no_changes():
    x, piece = np.linspace(0.0, 1.0, 8), np.repeat([0, 1], 4)
    assert sign_changes(lambda at: np.where(at < 0.5, 1.0, -1.0)[None], x, piece, 3).size == 0


def test_what_is_out_of_reach_and_comes_into_it_apart_is_no_change():
    assert found([lambda x: np.where(x < 0.3, -np.inf, -1.0)]).size == 0


@pytest.mark.parametrize("seed", range(20))
def test_random_cubics_change_at_their_roots(seed):
    draw = np.random.default_rng(seed)
    roots = draw.uniform(0.05, 0.95, (3, 3))
    got = found([lambda x, r=r: np.prod(x[..., None] - r, axis=-1) for r in roots], samples=48)
    assert got == pytest.approx(np.sort(roots.ravel()), abs=1e-9)


def test_a_function_that_hovers_at_zero_ends_with_a_few_changes():
    """Flanks designed to touch without load: round-off there multiplied the cells with every pass, without end."""
    rng = np.random.default_rng(4)
    asked = []

    def nearness(at):
        asked.append(at.size)
        noise = 1e-17 * rng.standard_normal(at.size)
        return np.where(at < 0.3, noise, at - 0.3)[None]

    x = np.linspace(0.0, 1.0, 49)
    found = sign_changes(nearness, x, np.zeros(x.size, dtype=int), 6)
    assert 1 <= found.size <= 2 * x.size
    assert max(asked) < 100 * x.size
    # where it leaves the noise for good is found to the last of its cells
    assert found[-1] == pytest.approx(0.3, abs=1.5 / 48)
