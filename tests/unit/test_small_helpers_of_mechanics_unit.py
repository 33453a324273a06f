"""Small parts that many results stand on and no test named: exact equations, levers, numbers of unknowns, errors."""

from fractions import Fraction
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.double_helical.double_error import double_error
from fegear.contact.plane.tooth_in_mesh import ToothInMesh
from fegear.dynamics.compound.whole_numbers import echelon, null_vectors, reduced, solved
from fegear.fem.solid.unknowns import unknowns
from fegear.shafts.carried import carry


def systems():
    """Whole numbers of a few rows, some of them sums of others."""
    chance = np.random.default_rng(7)
    for rows, columns, rank in ((2, 3, 2), (3, 3, 3), (4, 3, 2), (3, 5, 2), (5, 5, 4), (2, 2, 0), (4, 6, 4)):
        left, right = chance.integers(-4, 5, (rows, rank)), chance.integers(-4, 5, (rank, columns))
        yield (left @ right).astype(int)


@pytest.mark.parametrize("matrix", list(systems()), ids=lambda one: "x".join(map(str, one.shape)))
def test_whole_equations_are_solved_exactly(matrix):
    rank = int(np.linalg.matrix_rank(matrix))
    rows = matrix.tolist()
    done, leading = reduced(rows)
    assert len(done) == len(leading) == rank
    for k, column in enumerate(leading):  # ones where they lead, nothing else in those columns, nothing before
        assert [row[column] for row in done] == [Fraction(int(m == k)) for m in range(rank)]
        assert not any(done[k][:column])
    assert np.linalg.matrix_rank(np.vstack([matrix, np.array(done, dtype=float).reshape(-1, matrix.shape[1])])) == rank
    nothing = null_vectors(rows, matrix.shape[1])
    assert len(nothing) == matrix.shape[1] - rank
    assert all(sum(a * b for a, b in zip(row, one, strict=True)) == 0 for row in rows for one in nothing)
    assert np.linalg.matrix_rank(np.array(nothing, dtype=float).reshape(-1, matrix.shape[1])) == len(nothing)
    made, form, found = echelon(rows)
    assert found == rank
    np.testing.assert_array_equal(np.array(made) @ matrix, form)
    assert abs(round(np.linalg.det(np.array(made, dtype=float)))) == 1
    assert not np.any(form[rank:])
    starts = [next(k for k, one in enumerate(row) if one) for row in form[:rank]]
    assert starts == sorted(set(starts))
    wanted = [Fraction(k + 1, 3) for k in range(matrix.shape[1])]
    right = [sum(a * b for a, b in zip(row, wanted, strict=True)) for row in rows]
    assert solved(rows, right) == (wanted if rank == matrix.shape[1] else None)
    if rank == matrix.shape[1] and len(rows) > rank:
        assert solved(rows, [right[0] + 1, *right[1:]]) is None


def test_equations_that_contradict_each_other_have_no_solution_and_none_at_all_leaves_all_free():
    assert solved([[1, 2], [2, 4], [0, 1]], [1, 3, 5]) is None
    assert solved([[1, 2], [2, 4], [0, 1]], [1, 2, 5]) == [-9, 5]
    assert null_vectors([], 2) == [[1, 0], [0, 1]]
    assert echelon([]) == ([], [], 0)


def test_a_force_is_carried_along_the_axis_with_its_moment():
    force, moment = np.array([3.0, -5.0, 7.0]), np.array([0.2, 0.3, -0.4])
    for arm in (0.0, 0.6, -1.1):
        found = carry(arm) @ np.concatenate([force, moment])
        np.testing.assert_allclose(found[:3], force)
        np.testing.assert_allclose(found[3:], moment + np.cross([0.0, 0.0, arm], force))
    several = carry([0.25, -0.5])
    np.testing.assert_allclose(several[0] @ several[1], carry(-0.25))


def test_unknowns_are_numbered_row_by_row_and_anew_in_parts():
    has = np.array([[True, False, True], [False, False, False], [True, True, False]])
    whole = unknowns(has)
    assert whole.number.tolist() == [[0, -1, 1], [-1, -1, -1], [2, 3, -1]]
    assert whole.size == 4
    assert whole.of(np.array([2, 0])).tolist() == [2, 3, 0, 1]
    within, beyond = whole.split(np.array([[True] * 3, [True] * 3, [False, True, True]]))
    assert within.number.tolist() == [[0, -1, 1], [-1, -1, -1], [-1, 2, -1]]
    assert beyond.number.tolist() == [[-1, -1, -1], [-1, -1, -1], [0, -1, -1]]
    assert (within.size, beyond.size, unknowns(has & False).size) == (3, 1, 0)


# ---- a double helical pair -------------------------------------------------------------------------------------------
X, PERIOD = np.arange(8.0), 8.0


def solution(te, share, **other):
    te, share = np.asarray(te, dtype=float)[:, None], np.stack([share, 1.0 - np.asarray(share)])[:, :, None]
    values = {
        "points": SimpleNamespace(x=X, period=PERIOD, breaks=np.zeros(0), piece=np.zeros(8, dtype=int)),
        "transmission_error": te, "share": share, "share_of_first": share[0], "axial_motion": 0.0 * te,
        "mean_transmission_error": te.mean(axis=0), "peak_to_peak": np.ptp(te, axis=0), "load_factor": np.array([1.25]),
        "face_load_factors": np.array([[1.5], [1.1]]), "mean": lambda values: values.mean(axis=0),
        "spec": SimpleNamespace(nominal_parts=(0.4, 0.6)),
        "balance": SimpleNamespace(free=np.array([[True]] * 4 + [[False]] * 4), position=np.full((8, 1), -2e-6)),
    }  # fmt: skip
    return SimpleNamespace(**values | other)


@pytest.fixture
def every_other(monkeypatch):
    monkeypatch.setattr("fegear.contact.double_helical.double_error.every_second", lambda points: np.arange(0, 8, 2))


def numbers(error):
    return [np.asarray(getattr(error, name), dtype=float) for name in error.__dataclass_fields__]


@pytest.mark.usefixtures("every_other")
def test_nothing_that_changes_is_no_error_but_what_half_of_the_positions_leave():
    level, even = np.full(8, 3e-6), np.full(8, 0.4)
    assert not any(one.any() for one in numbers(double_error([solution(level, even)] * 3, 0.0)))
    spike = level.copy()
    spike[3] += 8e-6  # between two that are kept: all of it is missed, in the mean an eighth, half of which is stated
    te, _, _, mean, peak, _, _ = numbers(double_error([solution(spike, even)], 0.0))
    assert not te.any()
    assert mean == pytest.approx([0.5e-6])
    assert peak == pytest.approx([8e-6])
    shared = even.copy()
    shared[5] += 0.16
    factor = numbers(double_error([solution(level, shared)], 0.0))[5]
    assert factor == pytest.approx([0.5 * 0.02 / 0.4])


@pytest.mark.usefixtures("every_other")
def test_what_each_step_changes_adds_up_and_what_slices_miss_is_a_share():
    level, even = np.full(8, 3e-6), np.full(8, 0.4)
    steps = [
        solution(level + by, even + share, axial_motion=np.full((8, 1), motion), load_factor=np.array([1.25 + share]))
        for by, share, motion in ((0.0, 0.0, 0.0), (1e-6, -0.02, 3e-6), (0.5e-6, 0.01, 2e-6))
    ]
    te, share, motion, mean, peak, factor, face = numbers(double_error(steps, 0.0))
    np.testing.assert_allclose(te, 1.5e-6)
    np.testing.assert_allclose(share, 0.05)
    np.testing.assert_allclose(motion, 4e-6)
    np.testing.assert_allclose(mean, 1.5e-6)
    np.testing.assert_allclose(peak, 0.0, atol=1e-18)
    np.testing.assert_allclose(factor, 0.05)
    np.testing.assert_allclose(face, 0.0)
    te, share, motion, mean, _, factor, face = numbers(double_error([solution(level, even + 0.1)], 0.2))
    np.testing.assert_allclose(te, 0.6e-6)
    np.testing.assert_allclose(share, 0.02)
    np.testing.assert_allclose(motion[:, 0], [0.4e-6] * 4 + [0.0] * 4)
    np.testing.assert_allclose(mean, 0.6e-6)
    np.testing.assert_allclose(factor, 0.05)
    np.testing.assert_allclose(face, [[0.1], [0.02]])


# ---- one tooth through the mesh --------------------------------------------------------------------------------------
@pytest.mark.parametrize("member", ["driver", "driven"])
def test_a_tooth_finds_its_loads_in_the_base_pitch_in_which_it_is_on_the_pair(member):
    """After tooth 0 tooth -1 of the driver comes into mesh, tooth 1 of the driven gear."""
    teeth, cycles = 7, 14
    contacts = SimpleNamespace(radius_driver=np.array([[1.0, 5.0]]), radius_driven=np.array([[2.0, 9.0]]))
    of = SimpleNamespace(face_width=0.02, tooth=lambda member, row, cycle: (member, row, cycle))
    engagement = SimpleNamespace(compliance=of, grid=lambda x: SimpleNamespace(contacts=contacts))
    found = SimpleNamespace(x=np.zeros(2), number=np.array([-1, 0, 1]), loads=np.arange(cycles) * 10.0)
    influence = SimpleNamespace(
        gear=SimpleNamespace(teeth=teeth), ordinary=SimpleNamespace(lowest_radius=1.5, highest_radius=6.0)
    )
    tooth = ToothInMesh(engagement, found, member, influence, 3)
    assert tooth.width == 0.02
    assert tooth.radius.tolist() == ([[1.5, 5.0]] if member == "driver" else [[2.0, 6.0]])
    assert tooth.order == (4 if member == "driver" else 3)
    for pitch in (0, 2, cycles):
        loads, beside = tooth.in_pitch(pitch)
        assert loads == 10.0 * ((tooth.order + pitch) % cycles)
        assert beside == [(member, row, tooth.order + pitch) for row in (-1, 0, 1)]
