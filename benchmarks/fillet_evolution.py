"""Designed fillets beside an own differential evolution over the same numbers, under the same limits.

    python benchmarks/fillet_evolution.py [--pairs 10] [--first 0] [--seed 7] [--evaluations 900]

Random pairs of external gears; every second fillet is one that a rack makes, every third for the least alternating
stress. Evolution (rand/1/bin and half of it toward the best, Storn and Price 1997) knows nothing of slopes or kinks; of
two fillets that keep their limits the less stressed one is better, of others the one that breaks them by less (Deb
2000). It begins with the start of the search and numbers about it, and ends after so many fillets. Printed: stress of
the search over that of evolution (below 1: the search is better), what is left of the limits of both, and fillets that
each has solved.
"""

from __future__ import annotations

import argparse
import time
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import FegearError
from fegear.contact.pair_spec import PairSpec
from fegear.contact.plane.maker import load_plane
from fegear.design.fillet.fillet_design import WAVES, LoadedSolved, design_fillet
from fegear.design.fillet.fillet_limits import Limits
from fegear.design.fillet.moved_ellipses import MovedEllipses
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.design.fillet.fillet_bench import FilletBench

#: Members of the population, scale of differences and share of numbers that are exchanged.
MEMBERS, SCALE, EXCHANGED = 24, 0.6, 0.8


def random_pair(rng: np.random.Generator) -> tuple[LoadedSolved, str]:
    """A pair of plane gears under a moderate load, solved, and what it is."""
    while True:
        teeth = (int(rng.integers(17, 40)), int(rng.integers(20, 80)))
        shifts = rng.uniform(-0.1, 0.5, 2)
        rack = BasicRack(1.0, 1.25, float(rng.uniform(0.2, 0.35)))
        module = 3e-3
        try:
            gears = []
            for z, x in zip(teeth, shifts, strict=True):
                tooth = Tooth(z, rack, profile_shift=float(x))
                gears.append(Gear(tooth, module, 0.5 * tooth.root_radius * module, 20e-3))
            spec = PairSpec(GearPair(*gears), (float(rng.uniform(50.0, 200.0)) * 20.0,))
            solved = tuple(solve_gear(gear, settings_at(-3.0)) for gear in gears)
            loaded = load_plane(spec, solved)
        except FegearError:
            continue
        return LoadedSolved(loaded, spec, solved, "driver"), f"z {teeth[0]}/{teeth[1]} x {shifts.round(2).tolist()}"


class Judge:
    """Stress and broken limits of numbers, and how many fillets were solved."""

    def __init__(self, bench: FilletBench, family: MovedEllipses) -> None:
        self.bench, self.family, self.tried = bench, family, 0

    def __call__(self, numbers: Array) -> tuple[float, float]:
        """(how far limits are broken, stress)."""
        self.tried += 1
        try:
            judged = self.bench.judged(self.bench.tooth(self.family.shape(numbers)))
        except FegearError:
            return np.inf, np.inf
        return max(0.0, -float(judged.room.min()) - 1e-6), float(judged.stress.max())


def evolution(
    judge: Judge, start: Array, rng: np.random.Generator, evaluations: int
) -> tuple[Array, tuple[float, float]]:
    """Best numbers, and what they are."""
    spread = judge.family.spread
    people = start + spread * rng.normal(0.0, 0.7, (MEMBERS, start.size))
    people[0] = start
    values = [judge(one) for one in people]
    while judge.tried < evaluations:
        for i in range(MEMBERS):
            a, b, c = people[rng.choice(np.delete(np.arange(MEMBERS), i), 3, replace=False)]
            best = people[min(range(MEMBERS), key=values.__getitem__)]
            base = a if rng.random() < 0.5 else people[i] + rng.random() * (best - people[i])
            changed = base + SCALE * (b - c)
            trial = np.where(rng.random(start.size) < EXCHANGED, changed, people[i])
            value = judge(trial)
            if value <= values[i]:
                people[i], values[i] = trial, value
    top = min(range(MEMBERS), key=values.__getitem__)
    return people[top], values[top]


def main() -> None:
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--pairs", type=int, default=10)
    parser.add_argument("--first", type=int, default=0, help="number of the first pair")
    parser.add_argument("--seed", type=int, default=7)
    parser.add_argument("--evaluations", type=int, default=900)
    asked = parser.parse_args()
    for n in range(asked.first, asked.first + asked.pairs):
        rng = np.random.default_rng([asked.seed, n])
        pair, what = random_pair(rng)
        limits = Limits(generated=n % 2 == 1)
        objective = "alternating" if n % 3 == 2 else "tension"
        begun = time.process_time()
        found = design_fillet(pair, limits, objective)
        ours, of_search = found.found[found.first], time.process_time() - begun
        bench = pair.bench(limits, objective)
        tooth = bench.gear.symmetric_tooth
        family = MovedEllipses(bench.flank(tooth.root_radius), bench.active_roll, "waves", WAVES)
        judge = Judge(bench, family)
        begun = time.process_time()
        start = np.zeros(family.count + 1)
        _, (broken, stress) = evolution(judge, start, rng, asked.evaluations)
        room = float(bench.room(bench.tooth(ours.shape)).min())
        print(
            f"{n} {what} {objective}{', by a rack' if limits.generated else ''}: search / evolution "
            f"{ours.stress / stress:.4f}; limits left {room:.1e}, {-broken:.1e}; fillets {found.tried}, {judge.tried}; "
            f"CPU {of_search:.0f}, {time.process_time() - begun:.0f} s",
            flush=True,
        )


if __name__ == "__main__":
    main()
