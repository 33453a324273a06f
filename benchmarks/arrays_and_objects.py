"""Arrays of pairs beside the same pairs one by one: the largest difference of each quantity, and what a pair costs.

`python benchmarks/arrays_and_objects.py RACK PAIRS [SEED]`: random pairs of gears of a shipped atlas (drawn as in
`atlas_errors.py`), with corner contact, each with its own load of 50 to 450 N/mm and tip reliefs of both gears up to
20 um, linear or parabolic. Prints quantiles of the differences of transmission error and shares at positions, of mean,
peak-to-peak value and largest share, and of root stress at positions and its largest values over the mesh.
"""

from __future__ import annotations

import math
import sys
import time
from dataclasses import replace

import numpy as np
from atlas_errors import random_gear

from fegear.atlas.many_pairs import ManySpurPairs, known_pairs
from fegear.atlas.shipped import shipped_atlas
from fegear.base.errors import FegearError
from fegear.contact.many.arrays import ManyReliefs
from fegear.contact.many.many_load_sharing import shares_at, transmission_errors
from fegear.contact.many.many_roots import root_stress_at, root_stresses
from fegear.contact.plane.base_pitch import roll_positions
from fegear.contact.plane.engagement import Engagement
from fegear.contact.plane.pair_compliance import PairCompliance
from fegear.contact.plane.root_stress_history import root_stress_history
from fegear.contact.plane.tooth_stress import loaded_states, tooth_stress, with_peaks
from fegear.contact.plane.transmission_error import transmission_error
from fegear.geometry.gear import Material
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.relief import EndRelief

MODULE, FACE, HARMONICS, ORDER, SAMPLES, POSITIONS = 3e-3, 0.02, 8, 16, 48, 64
#: What is compared; over the mean transmission error, the load, or the largest stress.
QUANTITIES = (
    "error at positions", "shares at positions", "mean", "peak to peak", "largest share", "stress at positions",
    "largest tension", "largest compression", "range of tension",
)  # fmt: skip
#: Places in the base pitch, none of them on a change of contact but by chance.
AT = np.linspace(0.0, 1.0, 24, endpoint=False) + 1e-3


def drawn(atlas, count: int, rng: np.random.Generator) -> list[GearPair]:
    """Pairs that run."""
    gears = [replace(one, module=MODULE, bore_radius=one.bore_radius * MODULE, face_width=FACE,
                     material=Material(2.06e11)) for one in
             (random_gear(atlas, rng) for _ in range(max(12, count // 2)))]  # fmt: skip
    found: list[GearPair] = []
    while len(found) < count:
        first, second = (gears[int(k)] for k in rng.integers(len(gears), size=2))
        try:
            pair = GearPair(first, second)
            pair.refuse_fouling()
        except FegearError:
            continue
        if pair.contact_ratio >= 1.0:
            found.append(pair)
    return found


def arrays_of(pairs: list[GearPair]) -> ManySpurPairs:
    """The same as arrays."""

    def each(of) -> np.ndarray:
        return np.array([[of(one.gear(member)) for one in pairs] for member in MEMBERS], dtype=float)

    return ManySpurPairs(
        each(lambda g: g.teeth), each(lambda g: g.tooth.generating_shift), each(lambda g: g.tip_radius),
        each(lambda g: g.bore_radius), np.array([one.driver.module for one in pairs]),
        np.array([one.centre_distance for one in pairs]), np.array([one.face_width for one in pairs]),
        each(lambda g: g.material.young_modulus),
    )  # fmt: skip


def engagement(atlas, pair: GearPair, reliefs: ManyReliefs, i: int) -> Engagement:
    """One pair by itself."""
    found = []
    for member, gear in enumerate((pair.driver, pair.driven)):
        low, high = (math.sqrt(r**2 - gear.base_radius**2) / gear.base_radius for r in gear.involute_radii)
        begins = low + reliefs.start[member, i] * (high - low)
        found.append(EndRelief(float(reliefs.amount[member, i]), begins, high, float(reliefs.power[member, i])))
    compliance = PairCompliance(pair, atlas.compliance(pair.driver), atlas.compliance(pair.driven))
    return Engagement(compliance, found[0], found[1], corner_contact=True)


def differences(rack: str, count: int, seed: int) -> tuple[np.ndarray, list[float]]:
    """Differences, shape (count, quantities), and seconds of CPU time of arrays and of objects."""
    atlas, rng = shipped_atlas(rack), np.random.default_rng(seed)
    pairs = drawn(atlas, count, rng)
    loads = rng.uniform(50e3, 450e3, count) * FACE
    reliefs = ManyReliefs(
        rng.uniform(2e-6, 20e-6, (2, count)), rng.uniform(0.5, 0.9, (2, count)),
        rng.integers(1, 3, (2, count)).astype(float),
    )  # fmt: skip
    found, seconds = [], [0.0, 0.0]
    for first in range(0, count, 128):
        part = slice(first, first + 128)
        some = ManyReliefs(reliefs.amount[:, part], reliefs.start[:, part], reliefs.power[:, part])
        begun = time.process_time()
        known = known_pairs(atlas, arrays_of(pairs[part]), reliefs=some, root_stress=True)
        e = known.engagements
        shared, errors = (
            shares_at(e, loads[part], AT),
            transmission_errors(e, loads[part, None], waves=HARMONICS, samples=SAMPLES, order=ORDER),
        )
        histories = root_stress_at(e, known.fillets, loads[part], AT)
        largest = root_stresses(e, known.fillets, loads[part, None], samples=POSITIONS, followed=True)
        seconds[0] += time.process_time() - begun
        for i, pair in enumerate(pairs[part]):
            begun = time.process_time()
            one, load = engagement(atlas, pair, some, i), float(loads[first + i])
            state = one.solve(one.grid(pair.x_start + pair.base_pitch * AT), [load])
            te = transmission_error(one, load, HARMONICS, order=ORDER)
            sources = {member: (one.compliance.source(member),) for member in MEMBERS}
            states = loaded_states(one, (), [load], with_peaks(one, load, roll_positions(one, POSITIONS), sources))
            off = [np.abs(shared.transmission_error[i] - state.transmission_error[:, 0]).max() / te.mean]
            shares = np.zeros_like(shared.shares[i])
            shares[:, state.grid.contacts.number - shared.first[i]] = state.shared.shares[:, :, 0].T
            off.append(np.abs(shared.shares[i] - shares).max())
            off += [abs(errors.mean[i, 0] / te.mean - 1.0), abs(errors.peak_to_peak[i, 0] - te.peak_to_peak) / te.mean]
            off.append(abs(errors.largest_share[i, 0] - te.loaded.shared.shares.max()))
            at_places, mesh = [], []
            for m, member in enumerate(MEMBERS):
                for side, name in enumerate(("tension", "compression")):
                    stress = root_stress_history(one, state, member, name, 1).stress[..., 0]
                    rows = state.grid.contacts.number[0] - 1 - histories.first[i] + np.arange(stress.shape[0])
                    mine = histories.stress[m, i, side][rows]
                    here = np.isfinite(mine)
                    at_places.append(np.abs(mine - stress)[here].max() / np.abs(stress).max())
                tooth = tooth_stress(one, states, member, estimates=False)
                tension, compression = float(tooth.largest_tension[0]), float(tooth.largest_compression[0])
                mesh.append([
                    abs(largest.tension[m, i, 0] / tension - 1.0),
                    abs(largest.compression[m, i, 0] / compression - 1.0),
                    abs(largest.tension_range[m, i, 0] - float(tooth.tension_range[0])) / tension,
                ])  # fmt: skip
            found.append([*off, max(at_places), *np.max(mesh, axis=0)])
            seconds[1] += time.process_time() - begun
    return np.array(found), seconds


def main(rack: str, count: int, seed: int) -> None:
    """Draw, load both ways and print."""
    shares_at(known_pairs(shipped_atlas(rack), arrays_of(drawn(shipped_atlas(rack), 1, np.random.default_rng(0)))
                          ).engagements, 1e3, [0.5])  # compile first  # fmt: skip
    found, seconds = differences(rack, count, seed)
    print(f"rack {rack}, {count} pairs, seed {seed}: {1e3 * seconds[0] / count:.2f} ms a pair in arrays, "
          f"{1e3 * seconds[1] / count:.0f} ms each alone")  # fmt: skip
    print("quantity               maximum    99 %      median")
    for name, off in zip(QUANTITIES, found.T, strict=True):
        print(f"{name:20s}{off.max():10.1e}{np.quantile(off, 0.99):10.1e}{np.median(off):10.1e}")


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), int(sys.argv[3]) if len(sys.argv) > 3 else 1)
