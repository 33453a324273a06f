"""Designed fillets beside an own differential evolution over the same numbers, under the same limits.

    python benchmarks/fillet_evolution.py [--pairs 10] [--first 0] [--seed 7] [--evaluations 900] [--waves 7]
        [--asymmetric]

Random pairs of external gears; every second fillet is one that a rack makes, every third for the least alternating
stress. Of asymmetric gears every second one has both fillets designed, under a smaller load on the coast flanks.
Evolution (rand/1/bin and half of it toward the best, Storn and Price 1997) knows nothing of slopes or kinks; of two
fillets that keep their limits the less stressed one is better, of others the one that breaks them by less (Deb 2000).
It begins with the start of the search and numbers about it, and ends after so many fillets. Printed: stress of the
search over that of evolution (below 1: the search is better), what is left of the limits of both, and fillets that each
has solved.
"""

from __future__ import annotations

import argparse
import time
from typing import TYPE_CHECKING

import numpy as np

from fegear.base.errors import FegearError
from fegear.contact.pair_spec import PairSpec
from fegear.contact.plane.maker import load_plane
from fegear.design.fillet.fillet_design import WAVES, LoadedSolved, design_fillet, family_of
from fegear.design.fillet.fillet_limits import Limits
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.asymmetric_rack import AsymmetricRack, RackFlank
from fegear.geometry.asymmetric_tooth import AsymmetricTooth
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import MEMBERS as MEMBERS_OF_PAIR
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack

if TYPE_CHECKING:
    from fegear.base.arrays import Array
    from fegear.design.fillet.fillet_bench import FilletBench
    from fegear.design.fillet.fillet_search import Family

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


def asymmetric_pair(rng: np.random.Generator) -> tuple[LoadedSolved, LoadedSolved, str]:
    """The same of asymmetric gears, and with driver and driven exchanged, which loads the other flanks by less."""
    while True:
        teeth = (int(rng.integers(17, 40)), int(rng.integers(20, 80)))
        angles, module = np.radians([rng.uniform(24.0, 32.0), rng.uniform(16.0, 22.0)]), 3e-3
        load, share = float(rng.uniform(50.0, 200.0)) * 20.0, float(rng.uniform(0.4, 0.8))
        try:
            drive, coast = (RackFlank(float(angle), float(rng.uniform(0.12, 0.2))) for angle in angles)
            gears = []
            for z in teeth:
                tooth = AsymmetricTooth(z, AsymmetricRack(drive, coast), thickness_allowance=0.02)
                gears.append(Gear(tooth.drive, module, 0.5 * tooth.root_radius * module, 20e-3))
            pairs = []
            for one, force in ((gears, load), ([gear.from_the_back for gear in gears[::-1]], share * load)):
                spec = PairSpec(GearPair(*one), (force,))
                solved = tuple(solve_gear(gear, settings_at(-3.0)) for gear in one)
                member = MEMBERS_OF_PAIR[one is not gears]
                pairs.append(LoadedSolved(load_plane(spec, solved), spec, solved, member))
        except FegearError:
            continue
        what = f"z {teeth[0]}/{teeth[1]} {np.degrees(angles).round(1).tolist()} deg, {share:.2f} of the load on coast"
        return pairs[0], pairs[1], what


class Judge:
    """Stress and broken limits of numbers, and how many fillets were solved."""

    def __init__(self, bench: FilletBench, family: Family) -> None:
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
    parser.add_argument("--waves", type=int, default=WAVES)
    parser.add_argument("--asymmetric", action="store_true")
    asked = parser.parse_args()
    for n in range(asked.first, asked.first + asked.pairs):
        rng = np.random.default_rng([asked.seed, n])
        other = None
        if asked.asymmetric:
            pair, back, what = asymmetric_pair(rng)
            other = back if n % 2 else None
            limits, what = Limits(generated=n % 4 == 2), f"{what}, {'both fillets' if other else 'drive fillet'}"
        else:
            pair, what = random_pair(rng)
            limits = Limits(generated=n % 2 == 1)
        objective = "alternating" if n % 3 == 2 and (other or not asked.asymmetric) else "tension"
        begun = time.process_time()
        found = design_fillet(pair, limits, objective, waves=asked.waves, other=other)
        ours, of_search = found.found[found.first], time.process_time() - begun
        bench = pair.bench(limits, objective, None if other is None else other.bench(limits, objective))
        family = family_of(bench, "waves", asked.waves)
        judge = Judge(bench, family)
        begun = time.process_time()
        start = family.start(0.0, 0.0)
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
