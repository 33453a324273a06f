"""Errors of a shipped atlas: random gears of its family, interpolated and solved with the same mesh settings.

`python benchmarks/atlas_errors.py RACK COUNT [SEED]`: two in five gears of the region without undercut and with many
teeth, a quarter of that with few, 15 % undercut, a fifth with 150 teeth and more; one of seven on an end of its region.
Root stress is compared between the contacts of the tables too, and where contacts become narrower at the flank's start.
Prints largest and 90 % errors, how often they exceed 2e-4, and how the estimated errors cover them.
"""

from __future__ import annotations

import sys
import time
from typing import TYPE_CHECKING

import numpy as np

from fegear.atlas.shipped import shipped_atlas
from fegear.atlas.tables import row_of
from fegear.fem.plane.solution import solve_gear

if TYPE_CHECKING:
    from fegear.atlas.atlas_gear import AtlasGear
    from fegear.atlas.interpolation import Atlas
    from fegear.fem.plane.gear import GearInfluence
    from fegear.geometry.gear import Gear

#: Contacts above the flank's start where root stress bends [modules], and how many over the flank besides.
_BENDS, _EVEN = (0.0, 5e-5, 1e-4, 2e-4, 1e-3, 5e-3, 0.01, 0.015, 0.02, 0.021, 0.03, 0.05, 0.07), 40
SHARES, ON_AN_END, WANTED = (0.4, 0.25, 0.15, 0.2), 0.15, 2e-4


def random_gear(atlas: Atlas, rng: np.random.Generator) -> Gear:
    """Of pure numbers, that an atlas holds."""
    while True:
        domain = atlas.domains[int(rng.choice(len(atlas.domains), p=SHARES))]
        at = rng.uniform(-1.0, 1.0, 4)
        if rng.random() < ON_AN_END:
            at[rng.integers(4)] = rng.choice([-1.0, 1.0])
        gear = atlas.family.gear(domain.place(atlas.family, at))
        if atlas.holds(gear):
            return gear


def stress_errors(known: AtlasGear, solved: GearInfluence) -> list[float]:
    """Largest errors of the largest stress of each fillet under contacts over the flank, over that of the own tooth."""
    low, high, base = solved.lowest_radius, solved.highest_radius, solved.gear.base_radius
    above = np.concatenate([_BENDS, np.linspace(_BENDS[-1], 0.5 * (high**2 - low**2) / base, _EVEN)])
    radii = np.clip(np.sqrt(low**2 + 2.0 * base * above), low, high)
    true = {kernel: solved.largest_root_stress(*kernel, radii)[0] for kernel in known.layout.kernels}
    return [
        np.abs(known.largest_root_stress(k, side, radii)[0] - stress).max() / np.abs(true[0, side]).max()
        for (k, side), stress in true.items()
    ]


def errors(rack: str, count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """True and estimated errors of random gears, shapes (count, quantities)."""
    atlas, rng, found = shipped_atlas(rack), np.random.default_rng(seed), []
    for _ in range(count):
        gear = random_gear(atlas, rng)
        solved = solve_gear(gear, atlas.settings, reach=atlas.reach, estimate_error=False)
        row, known = row_of(solved), atlas.gear(gear)
        estimated = [known.errors[name] for name in atlas.layout.quantities]
        compliances = atlas.layout.differences(row, known.row - row)[:2]
        found.append(([*compliances, *stress_errors(known, solved)], estimated))
    true, stated = np.array(found).transpose(1, 0, 2)
    return true, stated


def main(rack: str, count: int, seed: int) -> None:
    """Draw, solve and print."""
    begun, names = time.process_time(), shipped_atlas(rack).layout.quantities
    true, stated = errors(rack, count, seed)
    print(f"rack {rack}, {count} gears, seed {seed}: {time.process_time() - begun:.0f} s of CPU time")
    print("quantity          maximum    90 %    above 2e-4    estimated/true: median, minimum")
    for name, off, said in zip(names, true.T, stated.T, strict=True):
        ratio = said / off
        print(f"{name:15s}{off.max():10.1e}{np.quantile(off, 0.9):10.1e}{(off > WANTED).mean():11.2%}"
              f"{np.median(ratio):16.1f}{ratio.min():10.2f}")  # fmt: skip


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]) if len(sys.argv) > 3 else 1)
