"""Tooth stiffness and root stress of random spur pairs by the atlas, beside ISO 6336, and a fit of the stiffness.

`python benchmarks/million_pairs_study.py RACK COUNT [FOLDER]`: random pairs of a rack of ISO 53 without corner contact,
300 N/mm along the line of action; writes `million_pairs_<rack>.csv`, percentiles of finite elements over formulas by
bins of teeth and shift, and prints coefficients and errors of the fit on pairs that it was not fitted to. The pairs are
drawn and computed in parts of 25,000, each by a seed of its own, on all processors: their number changes no pair.
"""

from __future__ import annotations

import contextlib
import csv
import math
import resource
import sys
import time
from concurrent.futures import ProcessPoolExecutor
from functools import partial
from pathlib import Path

import numpy as np

from fegear.atlas.many_pairs import known_pairs, spur_pairs
from fegear.atlas.shipped import RACKS, shipped_atlas
from fegear.base.errors import FegearError
from fegear.contact.many.arrays import ManyEngagements
from fegear.contact.many.many_load_sharing import transmission_errors
from fegear.contact.many.many_roots import root_stresses
from fegear.formulas.agma import agma908
from fegear.formulas.fitted_stiffness import terms
from fegear.formulas.iso6336 import part1_stiffness as iso
from fegear.formulas.many.pairs import ManyPairs
from fegear.formulas.many.roots import root_forms
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.many_pairs import ManyGearPairs
from fegear.geometry.rack import BasicRack

MODULE, WIDTH, LOAD, STEEL = 3e-3, 20e-3, 300e3, 2.06e11
AT_ONCE, PART, FIRST, BINS = 256, 25_000, 2000, ((12, 18), (18, 25), (25, 40), (40, 80), (80, 150), (150, 401))
SHIFTS = ((-0.7, -0.2), (-0.2, 0.0), (0.0, 0.2), (0.2, 0.4), (0.4, 0.71))


def drawn(rng: np.random.Generator, count: int, rack: str) -> ManyGearPairs:
    """Random pairs without backlash: teeth by their logarithm, shifts, tips shortened to the clearance of the rack."""
    dedendum, rounding = RACKS[rack]
    z = np.rint(np.exp(rng.uniform(math.log(12), math.log(400), (2, count))))
    x = rng.uniform(-0.5, 0.7, (2, count))
    alpha = math.radians(20.0)
    wanted = math.tan(alpha) - alpha + 2.0 * x.sum(axis=0) / z.sum(axis=0) * math.tan(alpha)
    angle = np.cbrt(3.0 * np.maximum(wanted, 1e-4))
    for _ in range(30):
        angle -= (np.tan(angle) - angle - wanted) / np.tan(angle) ** 2
    centre = 0.5 * z.sum(axis=0) * math.cos(alpha) / np.cos(angle)
    alteration = centre - 0.5 * z.sum(axis=0) - x.sum(axis=0)
    whole = np.full(count, 1.0)
    return ManyGearPairs(
        z, x, MODULE * whole, alpha * whole, 0.0 * whole, whole, dedendum * whole, rounding * whole, alteration,
        MODULE * centre, WIDTH * whole,
    )  # fmt: skip


def rated(pairs: ManyGearPairs) -> ManyPairs:
    """The same as ISO 6336 sees them."""
    count = len(pairs)
    both = np.full((2, count), 1.0)
    return ManyPairs(
        pairs.teeth, pairs.profile_shift, pairs.profile_shift, pairs.tip_diameters, pairs.tip_diameters,
        pairs.root_diameters, 0.5 * pairs.root_diameters, WIDTH * both, pairs.dedendum * both,
        pairs.rack_tip_radius * both, 0.0 * both, np.inf * both, np.nan * both, STEEL * both, 0.3 * both, 7850.0 * both,
        pairs.module, pairs.pressure_angle, pairs.helix_angle, pairs.centre_distance, pairs.contact_ratio,
        pairs.face_width,
    )  # fmt: skip


def single_stiffness(engagements: ManyEngagements) -> np.ndarray:
    """c' of one tooth pair in contact at the pitch point under the whole load [Pa]."""
    f, m = engagements.flanks, engagements.module
    angle = np.arccos(np.minimum(f.base_radius.sum(axis=0) / engagements.centre_distance, 1.0))
    at = f.base_radius * np.tan(angle)
    half = 48
    s = np.linspace(0.0, 1.0, half)
    corner = np.minimum(0.1 * m * f.base_radius / f.highest, 0.3 * (f.highest - f.lowest))[..., None]
    low, high = f.lowest[..., None], f.highest[..., None]
    x = np.concatenate([(low + (high - corner - low) * (s * s * (3.0 - 2.0 * s)))[..., :-1], high - corner * (1.0 - s)],
                       axis=-1)  # fmt: skip
    i = np.clip((x < at[..., None]).sum(axis=-1) - 2, 0, x.shape[-1] - 4)[..., None] + np.arange(4)
    places, values = np.take_along_axis(x, i, axis=-1), np.take_along_axis(f.own, i, axis=-1)
    c = np.zeros(at.shape)
    for k in range(4):  # the cubic through the four nearest
        others = [j for j in range(4) if j != k]
        c += values[..., k] * np.prod(
            [(at - places[..., j]) / (places[..., k] - places[..., j]) for j in others], axis=0
        )
    modulus = 1.0 / (1.0 / f.plane_modulus).sum(axis=0)
    width = np.sqrt(4.0 * LOAD / (math.pi * modulus) / (1.0 / at).sum(axis=0))
    total = c.sum(axis=0) + f.log_slope.sum(axis=0) * np.log(0.08 * m / width)
    inside = ((at > f.lowest) & (at < f.highest)).all(axis=0)
    return np.where(inside, 1.0 / total, np.nan)


def computed(rack: str, count: int) -> dict[str, np.ndarray]:
    """All that is compared, of the pairs that mesh and that the atlas holds."""
    with ProcessPoolExecutor() as pool:
        parts = list(pool.map(partial(part_of, rack), range(1, 1 + math.ceil(count / PART))))
    return {key: np.concatenate([one[key] for one in parts], axis=-1)[..., :count] for key in parts[0]}


def part_of(rack: str, seed: int) -> dict[str, np.ndarray]:
    """The same of as many pairs as a part has."""
    atlas, rng, parts = shipped_atlas(rack), np.random.default_rng(seed), []
    while sum(one["z"].shape[1] for one in parts) < PART:
        pairs = drawn(rng, 4 * AT_ONCE, rack)
        forms = root_forms(rated(pairs))
        meshes = (pairs.contact_ratio > 1.05) & (pairs.contact_ratio < 2.0) & (pairs.involute_reserve > 0.0).all(axis=0)
        thick = (pairs.tip_thicknesses > 0.2 * pairs.module).all(axis=0)
        good = np.flatnonzero(meshes & thick & forms.exists.all(axis=0))
        for first in range(0, good.size, AT_ONCE):
            some = pairs.at(good[first : first + AT_ONCE])
            known = known_pairs(atlas, spur_pairs(some, 0.5, STEEL), corner_contact=False, root_stress=True)
            held, load = np.flatnonzero(known.held), [LOAD * WIDTH]
            error = transmission_errors(known.engagements, load)
            stress = root_stresses(known.engagements, known.fillets, load)
            form = root_forms(rated(some))
            tangential, c_b = LOAD * math.cos(math.radians(20.0)) / MODULE, iso.rack_factor(RACKS[rack][0])
            at = 0.5 * some.base_diameters * np.tan(some.working_pressure_angle) / MODULE
            q = iso_flexibility(some.teeth, some.profile_shift)
            found = {
                "z": some.teeth, "x": some.profile_shift, "single": single_stiffness(known.engagements),
                "mesh": LOAD / error.mean[:, 0], "ratio": some.contact_ratio, "tension": stress.tension[..., 0],
                "iso_tension": tangential * form.Y_F * form.Y_S, "iso_single": 0.8 * c_b / q,
                "outer": at + math.pi * math.cos(math.radians(20.0)) - (some.tip_rolls / MODULE - at)[::-1],
            }  # fmt: skip
            parts.append({key: value[..., held] for key, value in found.items()})
    return {key: np.concatenate([one[key] for one in parts], axis=-1)[..., :PART] for key in parts[0]}


def iso_flexibility(z: np.ndarray, x: np.ndarray) -> np.ndarray:
    """q' of ISO 6336-1 [1/Pa], pinions first."""
    (z1, z2), (x1, x2) = np.sort(z, axis=0), np.take_along_axis(x, np.argsort(z, axis=0), axis=0)
    each = (np.ones_like(z1), 1 / z1, 1 / z2, x1, x1 / z1, x2, x2 / z2, x1 * x1, x2 * x2)
    return sum(c * t for c, t in zip(iso.COEFFICIENTS, each, strict=True)) / iso.UNIT


def agma_stresses(rack: str, found: dict[str, np.ndarray]) -> np.ndarray:
    """Root stress by AGMA 908 of the first pairs, one gear after the other [Pa]; NaN of others and where it is none."""
    dedendum, rounding = RACKS[rack]
    shape, stress = BasicRack(1.0, dedendum, rounding), np.full(found["z"].shape, np.nan)
    for i in range(min(FIRST, stress.shape[1])):
        for member in (0, 1):
            tooth = Tooth(int(found["z"][member, i]), shape, float(found["x"][member, i]))
            with contextlib.suppress(FegearError):
                radius = float(np.hypot(found["outer"][member, i], tooth.base_radius))
                stress[member, i] = LOAD / MODULE * agma908.tooth_root_stress(tooth, radius).stress
    return stress


def percentiles(values: np.ndarray) -> list[str]:
    """Of finite elements over a formula."""
    return [f"{one:.4f}" for one in np.nanpercentile(values, (5, 50, 95))]


def write(rack: str, found: dict[str, np.ndarray], path: Path) -> None:
    """Percentiles by bins of each gear's teeth and shift; stiffness counts for both gears."""
    iso_mesh = found["iso_single"] * (0.75 * found["ratio"] + 0.25)
    ratios = {
        "root stress, ISO 6336-3": found["tension"] / found["iso_tension"],
        "root stress, AGMA 908": found["tension"] / agma_stresses(rack, found),
        "c'": np.broadcast_to(found["single"] / found["iso_single"], found["z"].shape),
        "c_gamma_alpha": np.broadcast_to(found["mesh"] / iso_mesh, found["z"].shape),
    }
    with path.open("w", newline="") as file:
        table = csv.writer(file, lineterminator="\n")
        file.write(f"# python benchmarks/million_pairs_study.py {rack} {found['z'].shape[1]}\n")
        table.writerow(
            ["quantity", "teeth_from", "teeth_below", "shift_from", "shift_below", "gears", "p5", "p50", "p95"]
        )
        for name, values in ratios.items():
            for low, high in ((12, 401), *BINS):
                for least, most in ((-0.7, 0.71), *SHIFTS):
                    z, x = found["z"], found["x"]
                    here = (z >= low) & (z < high) & (x >= least) & (x < most)
                    here &= np.isfinite(values)
                    if here.sum() >= 20:
                        table.writerow([name, low, high, least, most, int(here.sum()), *percentiles(values[here])])


def main(rack: str, count: int, folder: Path) -> None:
    """Run the study."""
    started = time.perf_counter()
    found = computed(rack, count)
    own, workers = (resource.getrusage(who) for who in (resource.RUSAGE_SELF, resource.RUSAGE_CHILDREN))
    cpu = sum(one.ru_utime + one.ru_stime for one in (own, workers))
    memory = [one.ru_maxrss / 2**20 for one in (own, workers)]  # KiB on Linux
    print(f"{count} pairs: {cpu:.0f} s of CPU time, {time.perf_counter() - started:.0f} s; at most {memory[0]:.2f} GiB"
          f" here and {memory[1]:.2f} GiB in a worker")  # fmt: skip
    write(rack, found, folder / f"million_pairs_{rack.lower()}.csv")
    good = np.flatnonzero(np.isfinite(found["single"]))
    z, x, q = found["z"][:, good], found["x"][:, good], 1e9 / found["single"][good]
    each, train = terms(*z, *x), np.arange(good.size) % 5 != 0
    weight = 1.0 / q
    coefficients = np.linalg.lstsq((each * weight).T[train], np.ones(train.sum()), rcond=None)[0]
    off = (coefficients @ each) / q - 1.0
    print("coefficients", ", ".join(f"{one:.6g}" for one in coefficients))
    held = np.abs(off[~train])
    print(
        f"fit on others: rms {np.sqrt((held**2).mean()):.2%}, 95 % {np.quantile(held, 0.95):.2%}, max {held.max():.2%}"
    )
    for name, value in (
        ("root stress", found["tension"] / found["iso_tension"]),
        ("c'", found["single"] / found["iso_single"]),
    ):
        print(name, "finite elements over ISO 6336: 5, 50, 95 %", np.nanpercentile(value, (5, 50, 95)).round(3))


if __name__ == "__main__":
    main(sys.argv[1], int(sys.argv[2]), Path(sys.argv[3] if len(sys.argv) > 3 else "docs/studies"))
