"""Errors of a shipped atlas in mesh: random pairs of its gears, interpolated and solved, with tip relief and corners.

`python benchmarks/atlas_pairs.py RACK PAIRS [SEED]`: pairs of few random gears of the rack (drawn as in
`atlas_errors.py`), each with its own load of 50 to 450 N/mm and tip reliefs of both gears up to 20 um, linear or
parabolic. Prints quantiles of the errors beside what is asked, and how the stated errors cover them. A pair takes
half a second, a gear a quarter.
"""

from __future__ import annotations

import sys
import time
from dataclasses import replace
from typing import NamedTuple

import numpy as np
from atlas_errors import random_gear

from fegear.atlas.shipped import shipped_atlas
from fegear.base.errors import FegearError
from fegear.contact.load import load
from fegear.contact.pair_spec import FlankSpec, PairSpec
from fegear.contact.plane.base_pitch import roll_positions
from fegear.contact.plane.shifted_loads import transmission_error_shift
from fegear.contact.plane.tooth_stress import loaded_states, tooth_stress
from fegear.contact.plane.transmission_error import transmission_error
from fegear.fem.plane.solution import solve_gear
from fegear.geometry.gear import Gear, Material
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.relief_spec import ReliefSpec, TipReliefSpec

MODULE, FACE, POSITIONS, HARMONICS = 3e-3, 0.02, 64, 16
#: What is compared, and the largest error that was asked for; of the mean transmission error, or of the largest stress.
ASKED = {"mean": 1e-5, "peak to peak": 2e-4, "share": 1e-4, "largest root stress": 5e-4, "root stress": 5e-4}


class Answers(NamedTuple):
    """Of a loaded pair: mean and peak-to-peak transmission error [m], shares, and root stress by gear and side [Pa]."""

    mean: float
    peak_to_peak: float
    shares: np.ndarray
    stress: list[np.ndarray]


def drawn_spec(gears: list[Gear], rng: np.random.Generator) -> tuple[PairSpec, tuple[int, int]] | None:
    """A random pair with its load and reliefs, and which gears; None where they do not mesh."""
    first, second = (int(k) for k in rng.integers(len(gears), size=2))
    width, flanks = rng.uniform(50e3, 450e3), []
    for _ in MEMBERS:
        relief = TipReliefSpec(amount=rng.uniform(2e-6, 20e-6), length=rng.uniform(0.15, 0.5) * MODULE,
                               shape=("linear", "parabolic")[rng.integers(2)])  # fmt: skip
        flanks.append(FlankSpec(ReliefSpec((relief,))))
    try:
        pair = GearPair(gears[first], gears[second])
        pair.refuse_fouling()
    except FegearError:
        return None
    if pair.contact_ratio < 1.0:
        return None
    force = width * FACE
    return PairSpec(pair, (force,), force, driver=flanks[0], driven=flanks[1]), (first, second)


def answers(loaded, force: float) -> tuple[Answers, list[float]]:
    """What is compared, and the stated errors of mean, peak to peak and the largest stress where there are any."""
    e, shifted = loaded.engagement, loaded.shifted
    te, x = transmission_error(e, force, HARMONICS), roll_positions(e, POSITIONS)
    states = loaded_states(e, shifted, [force], x)
    stress, stated = [], []
    for member in MEMBERS:
        tooth = tooth_stress(e, states, member, estimates=bool(shifted))
        stress += [tooth.tension[:, 0], -tooth.compression[:, 0]]
        if shifted:
            stated += [tooth.error(0) / tooth.largest_tension[0],
                       tooth.compression_off(0) / -tooth.largest_compression[0]]  # fmt: skip
    shift = transmission_error_shift(te, shifted)
    if shift is not None:
        stated = [shift.mean / te.mean, shift.peak_to_peak / te.mean, *stated]
    return Answers(te.mean, te.peak_to_peak, states.rows[0].shared.shares[:, :, 0], stress), stated


def errors(rack: str, count: int, seed: int) -> tuple[np.ndarray, np.ndarray]:
    """Errors as `ASKED`, shape (count, 5), and true over stated ones of mean, peak to peak and four stresses."""
    atlas, rng = shipped_atlas(rack), np.random.default_rng(seed)
    pure = [random_gear(atlas, rng) for _ in range(max(12, count // 3))]
    gears = [replace(one, module=MODULE, bore_radius=one.bore_radius * MODULE, face_width=FACE,
                     material=Material(2.06e11)) for one in pure]  # fmt: skip
    known = [atlas.gear(one) for one in gears]
    solved: dict[int, object] = {}
    found, covers = [], []
    while len(found) < count:
        spec_of = drawn_spec(gears, rng)
        if spec_of is None:
            continue
        spec, both = spec_of
        for k in both:
            if k not in solved:
                solved[k] = solve_gear(gears[k], atlas.settings, reach=atlas.reach, estimate_error=False)
        try:
            by_atlas = load(spec, [known[k] for k in both])
        except FegearError:  # a relief that does not fit the flank in mesh
            continue
        truth = replace(load(spec, [solved[k] for k in both], estimates=False), exact=True, shifted=())
        one, stated = answers(by_atlas, spec.nominal)
        true, _ = answers(truth, spec.nominal)
        largest = [abs(a.max() / b.max() - 1.0) for a, b in zip(one.stress, true.stress, strict=True)]
        mean, peaks = abs(one.mean / true.mean - 1.0), abs(one.peak_to_peak - true.peak_to_peak) / true.mean
        over = max(np.abs(a - b).max() / b.max() for a, b in zip(one.stress, true.stress, strict=True))
        found.append((mean, peaks, np.abs(one.shares - true.shares).max(), max(largest), over))
        covers.append(np.array([mean, peaks, *largest]) / stated)
    return np.array(found), np.array(covers)


def main(rack: str, count: int, seed: int) -> None:
    """Draw, solve, load and print."""
    begun = time.process_time()
    found, covers = errors(rack, count, seed)
    print(f"rack {rack}, {count} pairs, seed {seed}: {time.process_time() - begun:.0f} s of CPU time")
    print("quantity                asked     maximum    95 %      median")
    for name, off in zip(ASKED, found.T, strict=True):
        print(f"{name:22s}{ASKED[name]:9.0e}{off.max():12.1e}{np.quantile(off, 0.95):10.1e}{np.median(off):10.1e}")
    print("true over stated error: maximum, median")
    for name, ratio in zip(("mean", "peak to peak", "root stress"), np.split(covers.T, [1, 2]), strict=True):
        print(f"{name:22s}{ratio.max():9.2f}{np.median(ratio):12.2f}")


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]) if len(sys.argv) > 3 else 1)
