"""Random gears with a random crack, and how the errors that their solutions state compare with the true ones.

The truth is the same gear by finer elements everywhere: at the crack's tip and mouth, too, where edges are half as long
and rays twice as many. Compared are the largest true and the largest stated errors over the flank, of compliances,
root stress and stress intensity.

python tests/helpers/random_cracks.py SEED COUNT [--first N]
"""

import argparse
import math
import sys
import time
from dataclasses import dataclass
from pathlib import Path
from unittest.mock import patch

import numpy as np

from fegear.base.errors import FegearError
from fegear.case.built.odd_teeth import crack_of
from fegear.case.reading import build_scene
from fegear.fem.plane.influence import SIDES
from fegear.fem.plane.odd import cracked_sector
from fegear.fem.plane.odd.odd_solution import solve_cracked_gear
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from tests.helpers.true_errors import external, internal

#: Levels that are judged, and that of the truth; edges at tip and mouth and rays of the truth.
LEVELS, TRUTH = (-4.5, -3.0, -2.0), 0.0
FINER = {"_RAYS": 16, "_TIP_EDGE": 0.04, "_TIP_SHARE": 0.07, "_MOUTH_SHARE": 0.12}
#: Part of the largest value of its kind that the truth itself may be off.
ROUGH = 2e-5
#: Teeth, from the cracked one, that are loaded or looked at.
PAIRS = ((0, 0), (1, 1), (0, 1), (-1, 0), (1, -1))
#: Roll positions over the flank.
POSITIONS = 9


@dataclass(frozen=True)
class Judged:
    """Largest true and stated error of one quantity over the flank, and its largest value."""

    what: str
    true: float
    stated: float
    size: float

    @property
    def ratio(self):
        """True error over the stated one."""
        return self.true / max(self.stated, 1e-300)


def drawn(rng):
    """Keys of a gear with a cracked tooth, which may prove impossible, and the level that it is solved at."""
    if rng.random() < 0.2:
        gear = internal(rng)
    else:
        gear = external(rng, most=90)
        z, rack, shift = gear["teeth"], gear["rack"], gear["profile_shift"]
        root, depth = 1.5 * z + 3.0 * (shift - rack["dedendum"]), 3.0 * (rack["addendum"] + rack["dedendum"])
        kind = rng.choice(["solid", "rim", "free_arc", "web"])
        if kind != "solid" and root > 3.0 * depth:
            bore = root - rng.uniform(0.4, 1.6) * depth
            gear["bore_radius"] = f"{bore:.4f} mm"
            if kind == "free_arc":
                gear["rim_support"] = {"kind": kind, "teeth": int(rng.choice([3, 5, 7, 11]))}
            if kind == "web":
                gear["rim_support"] = {
                    "kind": kind, "web_thickness": f"{rng.uniform(4.0, 12.0):.3f} mm",
                    "web_radius": f"{rng.uniform(0.3, 0.8) * bore:.4f} mm",
                }  # fmt: skip
    lean = rng.uniform(55.0, 70.0) if gear.get("internal") else rng.uniform(20.0, 60.0)
    crack = {
        "fillet": "compression" if rng.random() < 1 / 7 else "tension", "tangent_angle": f"{lean:.2f} deg",
        "angle": f"{rng.uniform(35.0, 95.0):.2f} deg",
    }  # fmt: skip
    if rng.random() < 0.25:
        crack["depth"] = f"{3.0 * math.exp(rng.uniform(math.log(0.02), math.log(0.3))):.4f} mm"
    else:
        crack["depth_ratio"] = round(math.exp(rng.uniform(math.log(0.05), math.log(0.8))), 4)
    gear["odd_tooth"] = [{"tooth": 0, "crack": crack}]
    return gear, float(rng.choice(LEVELS))


def case(seed, number):
    """One of a seed's: its keys, gear and crack, and level; drawn again until the gear exists and has this crack."""
    rng = np.random.default_rng([seed, number])
    for _ in range(100):
        keys, level = drawn(rng)
        document = {"results": ["odd-tooth-stiffness"], "gear": {"a": keys}}
        try:
            scene = build_scene(document, "cracks", Path())
            gear = scene.gears["a"]
            crack = crack_of(gear, scene.case.gear["a"].odd_tooth[0].crack, "crack")
        except FegearError:
            continue
        return keys, gear, crack, level
    raise AssertionError("nothing that can be drawn")


def answers(gear, crack, level, radii, half_width, estimates):
    """Values and stated errors by what they are, shape (P,) each."""
    found = solve_cracked_gear(solve_gear(gear, settings_at(level), reach=2, estimate_error=estimates), {0: crack})
    each = {}
    for i in (-1, 0, 1):
        each[f"c_{i}{i}"] = found.own(i, radii, half_width), found.own_error(i, radii, half_width)
    for i, j in PAIRS:
        if i != j:
            each[f"c_{i}{j}"] = found.between(i, j, radii, radii), found.between_error(i, j, radii, radii)
        for side in SIDES:
            stress = found.largest_root_stress(i, j, side, radii)[0]
            each[f"root_{side}_{i}{j}"] = stress, found.root_stress_error(i, j, side, radii)
    for j in (-1, 0, 1):
        each[f"K_{j}"] = found.stress_intensity(0, j, radii)
    return each


def judged(gear, crack, level):
    """Largest errors of one cracked gear.

    Raises
    ------
    FegearError
        If it is refused.
    """
    low, high = gear.involute_radii
    radii = np.linspace(low, high, POSITIONS + 2)[1:-1]
    half_width = np.full(POSITIONS, 0.02 * gear.module)
    found = answers(gear, crack, level, radii, half_width, True)
    with patch.multiple(cracked_sector, **FINER):
        truth = answers(gear, crack, TRUTH, radii, half_width, False)
    sizes = {}
    for what, (value, _) in truth.items():
        kind = what.split("_")[0]
        sizes[kind] = max(sizes.get(kind, 0.0), float(np.abs(value).max()))
    every = []
    for what, (value, stated) in found.items():
        off = np.maximum(np.abs(value - truth[what][0]) - ROUGH * sizes[what.split("_")[0]], 0.0)
        every.append(Judged(what, float(off.max()), float(stated.max()), float(np.abs(truth[what][0]).max())))
    return every, sizes


def main():
    """Judge so many, and print what is worst."""
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("seed", type=int)
    options.add_argument("count", type=int)
    options.add_argument("--first", type=int, default=0)
    given = options.parse_args()
    worst, refused, beyond, ran = {}, 0, 0, 0
    for number in range(given.first, given.first + given.count):
        started = time.process_time()
        keys, gear, crack, level = case(given.seed, number)
        try:
            every, sizes = judged(gear, crack, level)
        except FegearError as why:
            refused += 1
            print(f"{number}: {why}", flush=True)
            continue
        ran += 1
        largest = max(every, key=lambda one: one.ratio)
        beyond += largest.ratio > 1.5
        for one in every:
            what = one.what.split("_")[0]
            worst[what] = max(worst.get(what, 0.0), one.ratio)
            if one.ratio > 1.5:
                part = one.true / sizes[what]
                print(f"{number}: {one.what} {one.ratio:.2f}, {part:.1e} of the largest; level {level:g}, {keys}")
        print(f"{number}: {largest.what} {largest.ratio:.2f}, {time.process_time() - started:.1f} s", flush=True)
    print(f"{ran} ran, {refused} refused, {beyond} beyond 1.5 times; " + ", ".join(
        f"{what} {ratio:.2f}" for what, ratio in worst.items()))  # fmt: skip


if __name__ == "__main__":
    sys.exit(main())
