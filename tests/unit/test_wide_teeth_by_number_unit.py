"""Flanks with a width ask for teeth by their numbers: a made-up odd gear shows where its tooth is in contact."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
import pytest

from fegear.base.solution_cache import SolutionCache
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.loaded import FlankPair
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.slices import ThinLines, solve_thin_slices
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.rack import BasicRack

LOAD = 4000.0
#: How much softer teeth are than the others.
SOFTER = {0: 2.0, 1: 1.3}


def gear(teeth):
    tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25))
    return Gear(tooth, 3e-3, 0.5 * tooth.root_radius * 3e-3, 12e-3)


PAIR = GearPair(gear(20), gear(23))


@dataclass(frozen=True)
class OddLines:
    lines: ThinLines
    factors: list

    def between(self, i, j, pairs):
        blocks = self.lines.between(i, j, pairs)
        own = self.lines.own()
        return [
            block + (self.factors[a] - 1.0) * own[a] if a == b else math.sqrt(self.factors[a] * self.factors[b]) * block
            for (a, b), block in zip(pairs, blocks, strict=True)
        ]


@dataclass(frozen=True)
class Odd:
    """Teeth like those of a body, but some."""

    base: object
    period: int

    def __getattr__(self, name):
        if name.startswith("__"):
            raise AttributeError(name)
        return getattr(self.base, name)

    @property
    def usual(self):
        return self.base

    def differ(self, i, j):
        return bool({i % self.period, j % self.period} & SOFTER.keys())

    def same_as(self, first, count):
        window = {(first + n) % self.period for n in range(count)}
        return first % self.period if window & SOFTER.keys() else max(SOFTER) + 1

    def pressed(self, line, spans, teeth):
        factors = [SOFTER.get(tooth % self.period, 1.0) for tooth in teeth]
        return OddLines(self.base.pressed(line, spans, teeth), factors)


@pytest.fixture(scope="module")
def bodies():
    settings = SolidSettings().scaled(2.0)
    return {
        member: solve_thin_slices(one.tooth, 0.0, one.face_width / 3e-3, 0.3, one.bore_radius / 3e-3, settings)
        for member, one in zip(MEMBERS, (PAIR.driver, PAIR.driven), strict=True)
    }


@pytest.mark.parametrize("member", MEMBERS)
def test_odd_teeth_show_where_they_are_in_contact(bodies, member):
    even = FlankPair(PAIR, bodies, panel=1.5, positions=6)
    z = PAIR.gear(member).tooth.teeth
    odd = FlankPair(PAIR, {**bodies, member: Odd(bodies[member], z)}, panel=1.5, positions=6)
    ordinary = even.solve([LOAD])
    step = 1 if member == "driver" else -1
    for cycle in (0, 1, 2, 7, z - 1, z):
        found = odd.solve([LOAD], FlankGaps(base_pitch=cycle))
        apart = found.transmission_error[:, 0] - ordinary.transmission_error[:, 0]
        lines = found.lines
        numbers = [{step * (int(lines.pair[p, s.start]) - cycle) % z for s in lines.at(p)} for p in range(apart.size)]
        touching = np.array([bool(teeth & SOFTER.keys()) for teeth in numbers])
        assert np.array_equal(apart != 0.0, touching)
        assert (apart[touching] > 0.0).all()
        assert found.pair_load.sum(axis=0)[:, 0] == pytest.approx(LOAD, rel=1e-9)
        m = odd.compliance(LOAD, cycle=cycle).matrix
        assert m == pytest.approx(np.swapaxes(m, 1, 2), rel=1e-12, abs=1e-20)  # Maxwell
    # one tooth alone in contact, twice as soft on one of two gears
    alone = np.array([teeth == {0} for teeth in numbers])
    assert alone.any()
    assert (apart[alone] > 0.2 * ordinary.transmission_error[alone, 0]).all()


def test_base_pitches_with_like_teeth_are_one(bodies):
    caches = [SolutionCache(), SolutionCache()]
    even, odd = (
        FlankPair(PAIR, gears, panel=1.5, positions=6, cache=cache)
        for gears, cache in zip((bodies, {**bodies, "driver": Odd(bodies["driver"], 20)}), caches, strict=True)
    )
    assert even.compliance(LOAD, cycle=3) is even.compliance(LOAD)
    first = odd.compliance(LOAD, cycle=5)
    computed = caches[1].shapes.computed
    assert np.array_equal(odd.compliance(LOAD, cycle=9).matrix, first.matrix)
    assert caches[1].shapes.computed == computed  # other teeth, which are like those: recalled
    assert not np.array_equal(odd.compliance(LOAD, cycle=0).matrix, first.matrix)
    assert odd.compliance(LOAD, cycle=20) is odd.compliance(LOAD, cycle=0)
