"""Random shafts within shafts on soft bearings, beside a frame of Timoshenko elements that is made here alone."""

from __future__ import annotations

import math
from itertools import pairwise

import numpy as np
import pytest

from fegear.shafts.beam import Shaft
from fegear.shafts.bearing import stiff
from fegear.shafts.deflection import deflect, response
from fegear.shafts.held import Around, LoadedShaft, Seat
from fegear.shafts.section import Section

E, NU = 206e9, 0.3


def element(length, d, h):
    """Stiffness of a prism against (x, turn about y) of both its ends, with shear; shape (4, 4)."""
    m = (h / d) ** 2
    kappa = 6 * (1 + NU) * (1 + m) ** 2 / ((7 + 6 * NU) * (1 + m) ** 2 + (20 + 12 * NU) * m)
    bending = E * math.pi / 64 * (d**4 - h**4)
    shear = 12 * bending / (kappa * E / (2 * (1 + NU)) * math.pi / 4 * (d * d - h * h) * length**2)
    k, a, b = 12.0, (4 + shear) * length**2, (2 - shear) * length**2
    c = 6.0 * length
    rows = [[k, c, -k, c], [c, a, -c, b], [-k, -c, k, -c], [c, b, -c, a]]
    return bending / (length**3 * (1 + shear)) * np.array(rows)


def frame(shafts, forces):
    """Displacements x and turns at all places: shafts as (sections, places, seats), forces as (shaft, place, F)."""
    numbers, count = [], 0
    for _, places, _ in shafts:
        numbers.append(dict(zip(places, range(count, count + len(places)), strict=True)))
        count += len(places)
    matrix, right = np.zeros((2 * count, 2 * count)), np.zeros(2 * count)
    for (sections, places, seats), own in zip(shafts, numbers, strict=True):
        steps = np.cumsum([0.0, *(one[0] for one in sections)])
        for low, high in pairwise(places):
            _, d, h = sections[int(np.searchsorted(steps, 0.5 * (low + high))) - 1]
            at = [2 * own[low], 2 * own[low] + 1, 2 * own[high], 2 * own[high] + 1]
            matrix[np.ix_(at, at)] += element(high - low, d, h)
        for at, across, tilting, around in seats:
            for k, way in ((across, 0), (tilting, 1)):
                on = [2 * own[at] + way]
                if around is not None:
                    on.append(2 * numbers[around[0]][around[1]] + way)
                sign = np.array([1.0, -1.0])[: len(on)]
                matrix[np.ix_(on, on)] += k * np.outer(sign, sign)
    for shaft, at, force in forces:
        right[2 * numbers[shaft][at]] += force
    scale = 1.0 / np.sqrt(np.diag(matrix))
    found = scale * np.linalg.solve(scale[:, None] * matrix * scale, scale * right)
    return [found.reshape(-1, 2)[list(own.values())] for own in numbers]


def drawn(seed):
    """Two to four shafts, each but the first held in an earlier one or in the housing, with two to four bearings."""
    rng = np.random.default_rng(seed)
    count, shafts = int(rng.integers(2, 5)), []
    for n in range(count):
        pieces = rng.uniform([0.02, 0.02, 0.0], [0.3, 0.12, 0.8], (int(rng.integers(1, 4)), 3)).tolist()
        sections = [(length, outer, outer * share) for length, outer, share in pieces]
        length = sum(one[0] for one in sections)
        places = {*np.cumsum([0.0, *(one[0] for one in sections)]).tolist(), float(rng.uniform(0, length))}
        seats = []
        for share in np.linspace(0.05, 0.95, int(rng.integers(2, 5))):
            around = None
            if n and rng.uniform() < 0.7:
                within = int(rng.integers(n))
                around = within, float(rng.uniform(0, sum(one[0] for one in shafts[within][0])))
                shafts[within][1].add(around[1])
            seats.append((float(share * length), 10 ** rng.uniform(7, 10), 10 ** rng.uniform(2, 6), around))
            places.add(seats[-1][0])
        shafts.append((sections, places, seats))
    return [(sections, sorted(places), seats) for sections, places, seats in shafts], rng


@pytest.mark.parametrize("seed", range(12))
def test_random_shafts_within_shafts_agree_with_a_frame(seed):
    shafts, rng = drawn(seed)
    forces = [(n, places[int(rng.integers(len(places)))], float(rng.normal(0, 1e3))) for n, (_, places, _) in
              enumerate(shafts)]  # fmt: skip
    loaded = tuple(
        LoadedShaft(
            Shaft(tuple(Section(*one) for one in sections), E, NU),
            tuple(Seat(stiff(k, 1e8, t), at, around=around and Around(*around)) for at, k, t, around in seats),
            np.array([at]), np.array([[force, 0.0, 0.0, 0.0, 0.0, 0.0]]), f"shaft {n}",
        )
        for n, ((sections, _, seats), (_, at, force)) in enumerate(zip(shafts, forces, strict=True))
    )  # fmt: skip
    bent, known = deflect(loaded), frame(shafts, forces)
    most = max(float(np.abs(one[:, 0]).max()) for one in known)
    for one, (_, places, _), expected in zip(bent, shafts, known, strict=True):
        assert one.at(places)[:, [0, 4]] == pytest.approx(expected, rel=1e-7, abs=1e-7 * most)
        assert one.balance.max() < 1e-9
    # The bearings are linear: the response to the same forces is the deflection, and it is symmetric.
    answer = response(bent, tuple(one.loads_at for one in loaded))
    assert answer == pytest.approx(answer.T, rel=1e-9, abs=1e-9 * np.abs(answer).max())
    moved = answer @ np.concatenate([one.loads[0] for one in loaded])
    found = np.concatenate([one.at(two.loads_at)[0] for one, two in zip(bent, loaded, strict=True)])
    assert moved[::6] == pytest.approx(found[::6], rel=1e-8, abs=1e-9 * most)
