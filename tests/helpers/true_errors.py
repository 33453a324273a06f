"""Random cases, and how the errors that a tolerance states of them compare with the true ones.

The truth of plane teeth is a solution whose edges are a quarter to a tenth as long, whose pressures are a third as
wide and whose edges grow in another way: what two levels of the ladder have in common it does not share. That of solid
teeth has shorter edges of order 4, more functions along the face and narrower bands than the finest tolerance takes,
panels of half the length, and twice as many roll positions for what is stated of a whole base pitch; what spur pairs
over the face have of plane teeth is compared with the truth of these. Largest loads, pressures and root stresses, and
ratios of them, are looked for at six (over the face) and eight times as many positions: between those of a table none
is seen.
It knows nothing of what contacts that reach a tip's corner leave to a formula, for it uses that formula as well
(`test_edge_law_closed_form.py` compares that part with solved contacts): how far stated errors are above the true ones
is judged without it.

Run by hand it prints a table of ratios; what is solved is kept in a folder, if one is named, so that a run that was
stopped goes on:

python tests/helpers/true_errors.py KIND SEED COUNT [TOLERANCE ...] [--keep FOLDER]
"""

import argparse
import math
import pickle
import sys
from contextlib import ExitStack
from dataclasses import dataclass, replace
from pathlib import Path
from unittest.mock import patch

import numpy as np
from scipy.ndimage import maximum_filter1d

from fegear.base.code_version import code_version
from fegear.base.errors import FegearError
from fegear.base.solution_cache import SolutionCache
from fegear.case.built import solid_influence
from fegear.case.reading import build_scene
from fegear.contact.plane import loaded_pair, shifted_compliance
from fegear.contact.wide import over_pitch
from fegear.engine.least_errors import ROUND_OFF, error_columns
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.fem.solid.settings import solid_settings
from fegear.results.catalogue import STAGES

#: Level 2 of the ladder and finer; no setting stands in the ratio to the others that it has there.
TRUTH = {
    "root_edge_length": 0.022, "root_fraction": 0.045, "flank_edge_length": 0.016, "tip_edge_length": 0.0015,
    "junction_edge_length": 0.0004, "back_edge_length": 0.13, "growth": 0.16, "tip_growth": 0.11, "side_growth": 0.22,
    "body_fraction": 0.6, "rim_fraction": 0.19, "corner_distance": 0.0031, "patch_half_width": 0.08, "order": 4,
}  # fmt: skip
#: Roll positions of plane pairs for the truth of their largest loads and pressures, as often as usually.
MORE_POSITIONS = 8
#: Panels of wide pairs over their four modules of face, in place of 16; roll positions over a base pitch, of 48.
PANELS, POSITIONS = 32, 96
#: Begin so: single numbers that stand between the positions of a table.
BETWEEN_POSITIONS = ("value largest_", "value K_F", "value K_H", "value root_stress_range")
TOLERANCES = (1e-2, 1e-3, 1e-4)
#: What solid teeth are solved to at most.
FINEST = {"tolerance": 3e-3}
#: Of its largest value, what the truth is taken to be off at most.
_ROUGH = 2e-5
#: Of a value, what is stated where nothing but its digits is uncertain, at most.
_DIGITS = 1e-7
#: Under what a truth has the code that made it.
_MADE_BY = ("code", "")
#: Places on either side of a crossing that belong to it, at least.
_BESIDE = 2
KINDS = ("gear", "ring", "pair", "internal pair", "body", "wide pair", "planetary set")
#: First of these columns that a table has says where its rows stand.
PLACES = ("radius", "x", "n", "t", "speed", "mode")
EFFECTS = {"neighbour_coupling": True, "hertz": "load-dependent"}


def rack(rng, long=False):
    """A rack of a random gear, and its pressure angle [deg]; long teeth reach a contact ratio of 2."""
    angle = 20.0 if long else float(rng.choice([20.0, 20.0, 14.5, 17.5, 22.5, 25.0]))
    addendum = round(rng.uniform(0.8, 1.2), 3) if not long else round(rng.uniform(1.2, 1.35), 3)
    clearance = round(rng.uniform(0.2, 0.4), 3)
    dedendum = addendum + clearance
    full = (math.pi / 4 - dedendum * math.tan(math.radians(angle))) * math.cos(math.radians(angle))
    full /= 1.0 - math.sin(math.radians(angle))
    tip = round(float(rng.uniform(0.3, 0.95)) * min(full, 0.4), 4)
    return {"addendum": addendum, "dedendum": round(dedendum, 3), "tip_radius": tip}, f"{angle} deg"


def external(rng, face="20 mm", most=200, long=False):
    """Keys of an external gear of module 3 mm."""
    tool, angle = rack(rng, long)
    z = round(math.exp(rng.uniform(math.log(40 if long else 12), math.log(most))))
    shift = 0.0 if long else round(rng.uniform(-0.2, 0.6), 3)
    root = 1.5 * z + 3.0 * (shift - tool["dedendum"])
    found = {
        "teeth": z, "module": "3 mm", "pressure_angle": angle, "profile_shift": shift, "rack": tool,
        "bore_radius": f"{rng.uniform(0.3, 0.9) * root:.4f} mm", "face_width": face,
        "material": {"poisson_ratio": round(rng.uniform(0.25, 0.4), 3)},
        "plane": str(rng.choice(["strain", "stress"])),
    }  # fmt: skip
    if rng.random() < 0.25:
        found["tip_radius_rounding"] = "0.15 mm"
    return found


def internal(rng, face="20 mm"):
    """Keys of a ring gear of module 3 mm."""
    z, shift = int(rng.integers(40, 130)), round(rng.uniform(-0.4, 0.5), 3)
    return {
        "internal": True, "teeth": z, "module": "3 mm", "profile_shift": shift, "face_width": face,
        "cutter": {"teeth": int(rng.integers(14, 30)), "profile_shift": round(rng.uniform(-0.2, 0.3), 3),
                   "addendum": 1.25, "tip_radius": round(rng.uniform(0.1, 0.3), 3)},
        "tip_diameter": f"{3.0 * (z - 2.0 * shift - 2.0 * rng.uniform(0.6, 0.95)):.4f} mm",
        "rim_thickness": f"{3.0 * rng.uniform(1.5, 8.0):.4f} mm",
    }  # fmt: skip


def drawn(kind, rng):
    """A case of one kind, which may prove impossible."""
    if kind in ("gear", "ring"):
        gear = external(rng) if kind == "gear" else internal(rng)
        return {"results": ["stiffness"], "gear": {"a": gear}, "stiffness": {"positions": 31}}
    if kind == "planetary set":
        return planetary_set(rng)
    if kind == "body":
        gear = external(rng, f"{rng.uniform(6.0, 12.0):.2f} mm", 28) | {"bore_radius": "5 mm"}
        gear["body"] = {"rim_thickness": f"{rng.uniform(4.5, 8.0):.3f} mm",
                        "web_thickness": f"{rng.uniform(0.2, 0.7) * float(gear['face_width'].split()[0]):.3f} mm",
                        "hub_radius": "9 mm"}  # fmt: skip
        gear.pop("plane")
        return {
            "results": ["stiffness"], "gear": {"a": gear},
            "stiffness": {"positions": 4, "face_positions": 3, "contact_half_width": "0.09 mm"},
        }  # fmt: skip
    results = ["load-sharing", "transmission-error", "root-stress-history"]
    if kind == "internal pair":
        planet, ring = external(rng, most=40), internal(rng)
        ring |= {"pressure_angle": planet["pressure_angle"], "profile_shift": -planet["profile_shift"]}
        ring["tip_diameter"] = f"{3.0 * (ring['teeth'] - 1.5):.4f} mm"
        ring["thickness_allowance"] = "90 um"
        gears = {"a": planet, "b": ring}
    else:
        long = kind == "pair" and rng.random() < 0.25
        first = external(rng, long=long)
        second = external(rng, long=long) | {key: first[key] for key in ("rack", "pressure_angle")}
        gears = {"a": first, "b": second}
    helix, face = rng.choice([0.0, 12.0]), rng.choice([6.0, 9.0])
    for gear in gears.values():
        if rng.random() < 0.5 and not gear.get("internal"):
            gear["relief"] = {"tip": {"amount": f"{rng.uniform(2.0, 25.0):.2f} um", "length": "2 mm"}}
        if kind == "wide pair":
            gear |= {"teeth": min(gear["teeth"], 28), "bore_radius": "9 mm", "face_width": f"{face} mm"}
            gear.pop("plane")
            if helix:
                gear |= {"normal_module": gear.pop("module"), "helix_angle": f"{helix} deg"}
    if kind == "wide pair":
        if helix:
            gears["a"]["hand"], gears["b"]["hand"] = "right", "left"
        results = ["load-distribution", "transmission-error", "root-stress-history"]
    load = 10.0 ** rng.uniform(2.9, 4.1)
    return {
        "results": results, "gear": gears,
        "pair": {"I": {"driver": "a", "driven": "b", "loads": [f"{load:.1f} N"], "load": f"{load:.1f} N"}},
        "effects": {**EFFECTS, "relief": True, "corner_contact": bool(rng.random() < 0.5)},
    }  # fmt: skip


def planetary_set(rng):
    """Three or four planets between a sun and a ring, of known stiffness or a gear, with errors of their pins."""
    sun, planet, count = int(rng.integers(15, 32)), int(rng.integers(16, 36)), int(rng.integers(3, 5))
    ring = sun + 2 * planet
    while (sun + ring) % count:
        sun, ring = sun + 1, ring + 1
    shifts = [round(rng.uniform(0.1, 0.4), 3) for _ in range(2)]
    gears = {
        name: {"teeth": z, "module": "3 mm", "profile_shift": x, "face_width": "25 mm",
               "bore_radius": f"{rng.uniform(0.3, 0.6) * 1.5 * z:.3f} mm"}
        for name, z, x in (("sun", sun, shifts[0]), ("planet", planet, shifts[1]))
    }  # fmt: skip
    if rng.random() < 0.5:
        gears["planet"]["relief"] = {"tip": {"amount": f"{rng.uniform(2.0, 25.0):.2f} um", "length": "2 mm"}}
    part = {
        "sun": "sun", "planet": "planet", "planets": count, "fixed": "ring", "input": "sun", "speed": "1800 rpm",
        "torque": f"{10.0 ** rng.uniform(2.0, 3.2):.1f} N*m", "floating": ["sun"],
        "speeds": {"start": f"{rng.uniform(50.0, 400.0):.1f} rpm", "stop": f"{rng.uniform(3e3, 9e3):.1f} rpm",
                   "count": 31},
        "stiffness": {"pin": f"{10.0 ** rng.uniform(2.0, 3.0):.1f} N/um", "carrier": "150 N/um"},
        "pin_errors": {"tangential": [f"{one:.1f} um" for one in rng.uniform(-15.0, 15.0, count)]},
        "body": {"carrier": {"mass": "5 kg", "inertia": "0.02 kg*m^2"}},
    }  # fmt: skip
    if rng.random() < 0.5:
        x = -(shifts[0] + 2.0 * shifts[1])
        gears["ring"] = {
            "internal": True, "teeth": ring, "module": "3 mm", "profile_shift": round(x, 3), "face_width": "25 mm",
            "cutter": {"teeth": 25, "addendum": 1.25, "tip_radius": 0.2}, "thickness_allowance": "80 um",
            "tip_diameter": f"{3.0 * (ring - 2.0 * x - 1.8):.4f} mm",
            "rim_thickness": f"{rng.uniform(5.0, 20.0):.3f} mm",
        }  # fmt: skip
        part["ring"] = "ring"
    else:
        part |= {"ring_teeth": ring}
        part["stiffness"]["ring_mesh"] = f"{rng.uniform(300.0, 700.0):.1f} N/um"
    effects = {**EFFECTS, "relief": True, "corner_contact": bool(rng.random() < 0.5)}
    return {"results": ["planet-vibration"], "gear": gears, "planetary": {"P": part}, "effects": effects}


def possible(kind, count, seed):
    """So many cases of one kind that fegear plans; what cannot exist is drawn again."""
    rng = np.random.default_rng([seed, KINDS.index(kind)])
    found = []
    while len(found) < count:
        case = drawn(kind, rng)
        try:
            scene_of(case, {"tolerance": 1e-2})
        except FegearError:
            continue
        found.append(case)
    return found


def scene_of(case, accuracy):
    """The scene of a case with such an accuracy, and its plan."""
    scene = build_scene({**case, "accuracy": accuracy}, "errors", Path())
    return scene, make_plan(scene, STAGES)


def answers(case, accuracy, cache=None):
    """Numbers of a case by what they are: places (in their unit), values, stated errors, what digits are worth."""
    scene, plan = scene_of(case, accuracy)
    results = run_plan(scene, plan, cache=cache or SolutionCache())
    found = {}
    for outcome in results.outcomes.values():
        for table in outcome.tables:
            place = next((c.si for c in table.columns if c.name in PLACES), None)
            for name, error in error_columns(table).items():
                column, off = table.column(name), table.column(error)
                if column.si.dtype.kind == "f" and place is not None:
                    where = place
                    if "face_position" in {c.name for c in table.columns}:
                        where = place + 1e3 * table.column("face_position").si
                    found[f"{table.name.split('_')[0]}...{name}", table.name] = (
                        where, column.si, off.si, digits_of(table, column),
                    )  # fmt: skip
        for value in outcome.values:
            key = value.name.rpartition(".")[2].rstrip("0123456789")
            error = np.nan if value.si_error is None else value.si_error
            found[f"value {key}", value.name] = (np.zeros(1), np.array([value.si]), np.array([error]), 0.0)
    return found


def digits_of(table, column):
    """What the digits of a column are worth to the engine, of all that has its unit: what cancels has no others."""
    alike = [np.abs(c.si) for c in table.columns if c.si.dtype.kind == "f" and c.unit == column.unit != ""]
    return ROUND_OFF * float(np.nanmax(np.concatenate(alike))) if alike else 0.0


def of_elements(case, accuracy):
    """`answers` whose stated errors have no part of contacts at tips: that of finite elements is left."""
    with patch.object(shifted_compliance, "_TIP", 1.0):
        return answers(case, accuracy)


def both_answers(case, accuracy):
    """`answers`, and the same `of_elements`; None where nothing plane touches with its tip: gears, helical pairs."""
    found = answers(case, accuracy)
    plane = not any(gear.get("helix_angle") for gear in case["gear"].values())
    return found, of_elements(case, accuracy) if plane and (case.get("pair") or case.get("planetary")) else None


@dataclass
class Judged:
    """A quantity of one case: true and stated errors at the places that both solutions have.

    `of_elements` is what is stated without the part of contacts at tips.
    """

    what: str
    name: str
    size: np.ndarray
    true: np.ndarray
    stated: np.ndarray
    rough: np.ndarray
    of_elements: np.ndarray

    @property
    def worst(self):
        """Largest true error over the stated one, less what the truth itself may be off."""
        return self._worst(self.stated)

    @property
    def worst_of_elements(self):
        """The same over what is stated of elements."""
        return self._worst(self.of_elements)

    def _worst(self, stated):
        known = np.isfinite(stated) & np.isfinite(self.true)
        over = np.maximum(np.abs(self.true) - self.rough, 0.0)[known] / np.maximum(stated[known], 1e-300)
        return float(over.max(initial=0.0))

    @property
    def beyond(self):
        """Part of the places at which the true error is beyond 1.5 times the stated one."""
        known = np.isfinite(self.stated) & np.isfinite(self.true)
        over = np.maximum(np.abs(self.true) - self.rough, 0.0)[known] > 1.5 * self.stated[known]
        return float(over.mean()) if over.size else 0.0

    @property
    def generous(self):
        """What is stated of elements over the true error: the median over the places; NaN where none is known."""
        known = np.isfinite(self.of_elements) & (np.abs(self.true) > self.rough) & (self.of_elements > 0.0)
        return float(np.median(self.of_elements[known] / np.abs(self.true[known]))) if known.any() else np.nan

    @property
    def generous_rms(self):
        """The same of both errors' root mean squares: no crossing enters."""
        known = np.isfinite(self.of_elements) & np.isfinite(self.true)
        if not known.any():
            return np.nan
        true = np.sqrt(np.mean(self.true[known] ** 2))
        rough = np.sqrt(np.mean(self.rough[known] ** 2))
        return float(np.sqrt(np.mean(self.of_elements[known] ** 2)) / true) if true > rough else np.nan

    @property
    def far_above(self):
        """Places at which the stated error is above 20 times the true one, and how many were judged.

        True is the largest true error within a twentieth of the places on either side, for it passes through zero. Not
        judged is what is exact but for its digits.
        """
        known = np.isfinite(self.stated) & np.isfinite(self.true)
        beside = max(_BESIDE, known.size // 20)
        true = maximum_filter1d(np.maximum(np.abs(np.nan_to_num(self.true)), self.rough), 2 * beside + 1)
        looked_at = known & (self.of_elements > _DIGITS * self.size)
        return int((looked_at & (self.of_elements > 20.0 * true)).sum()), int(looked_at.sum())


def judged(found, truth, elements=None):
    """Every quantity of a solution beside the truth; `elements` has the errors of finite elements by themselves."""
    every = []
    for (what, name), (place, value, stated, *digits) in found.items():
        if (what, name) not in truth:
            continue
        at, exact, rough = truth[what, name][:3]
        mine, theirs = np.round(place, 12), np.round(at, 12)
        both, i, j = np.intersect1d(mine, theirs, return_indices=True)
        if not both.size:
            continue
        # What the truth's own elements may be off: its error also has what no elements tell, of contacts beside tips.
        small = np.minimum(np.nan_to_num(rough[j], nan=0.0), _ROUGH * np.abs(exact).max(initial=0.0))
        small = np.maximum(small, sum(digits))
        own = (elements or found)[what, name][2][i]
        every.append(Judged(what, name, np.abs(exact[j]), value[i] - exact[j], stated[i], small, own))
    return every


def kept(folder, name, make):
    """What was made before under a name, or what is made now; None where fegear refuses."""
    at = None if folder is None else folder / f"{name}.pickle"
    if at is not None and at.exists():
        return pickle.loads(at.read_bytes())  # noqa: S301 - of this program
    try:
        made = make()
    except FegearError as why:
        print(f"{name}: {why}", file=sys.stderr)
        made = None
    if at is not None:
        at.parent.mkdir(parents=True, exist_ok=True)
        part = at.with_suffix(".part")
        part.write_bytes(pickle.dumps(made))
        part.rename(at)
    return made


def table(kind, seed, count, tolerances, folder=None):
    """Judge random cases of a kind, and print by quantity what is worst.

    With a folder truths are kept in it, which know no changes of the code, and answers by the code that gave them. How
    many truths are of other code is printed: errors of neighbours at the ends of ring flanks seemed to be 15 times the
    stated ones, since the truth had been made with wider pressures.
    """
    every, older = {tolerance: [] for tolerance in tolerances}, 0
    code = code_version()[:12]
    for number, case in enumerate(possible(kind, count, seed)):
        name = f"{kind.replace(' ', '_')}-{seed}-{number}"
        truth = kept(folder, name, lambda case=case: true_answers(kind, case) | {_MADE_BY: code})
        if truth is None:
            continue
        older += truth.get(_MADE_BY) != code
        for tolerance in tolerances:
            found = kept(
                folder,
                f"{code}/{name}-{tolerance:g}",
                lambda case=case, to=tolerance: both_answers(case, {"tolerance": to}),
            )
            if found is not None:
                every[tolerance].append((number, judged(found[0], truth, found[1])))
    if older:
        print(f"{older} truths are of other code: what is beyond them may be their own error (remove them to know)")
    for tolerance, cases in every.items():
        print(f"-- {kind}, seed {seed}, tolerance {tolerance:g}, {len(cases)} cases")
        by = {}
        for number, several in cases:
            for one in several:
                by.setdefault(one.what, []).append((number, one))
        heads = ("worst", "case", "bare", "beyond", "median", "rms", "most", "above 20", "lacking")
        print(f"{'quantity':36}" + "".join(f"{head:>9}" for head in heads))
        for what, several in sorted(by.items()):
            print(f"{what:36}" + "".join(f"{number:9.3g}" for number in row_of(several)))


def row_of(several):
    """Numbers of the table for one quantity of several cases."""
    worst = max(several, key=lambda one: one[1].worst)
    beyond = np.mean([one.beyond for _, one in several])
    generous = np.array([one.generous for _, one in several])
    rms = np.array([one.generous_rms for _, one in several])
    lacking = sum(not np.isfinite(one.stated).any() for _, one in several)
    above, places = np.sum([one.far_above for _, one in several], axis=0)
    ratios = [np.nan] * 3
    if np.isfinite(rms).any():
        ratios = [np.nanmedian(generous), np.nanmedian(rms), np.nanmax(rms)]
    bare = max(one.worst_of_elements for _, one in several)
    return worst[1].worst, worst[0], bare, beyond, *ratios, above / max(places, 1), lacking


def fine_solid(_accuracy):
    """Settings of solid gears finer than any tolerance's; every node has all functions along the face."""
    third = solid_settings(3e-3)
    return replace(
        third, section=third.section.scaled(0.75), waves_per_module=2.6, least_degree=14, least_piece_degree=7,
        body_layers=4, wave_reach=3.6, fewest_waves=100.0, band_half_width=0.16, room_share=0.6,
    )  # fmt: skip


def true_answers(kind, case):
    """Numbers of a case that are as good as true."""
    if kind not in ("body", "wide pair"):
        exact, cache = {"tolerance": 1e-6, **TRUTH}, SolutionCache()
        found = answers(case, exact, cache)
        if "pair" in kind:  # largest values stand between the positions of tables
            with patch.object(loaded_pair, "POSITIONS", MORE_POSITIONS * loaded_pair.POSITIONS):
                found |= {
                    key: one
                    for key, one in answers(case | {"results": ["load-sharing"]}, exact, cache).items()
                    if key[0].startswith("value largest_")
                }
        return found
    cache, panels = SolutionCache(), {"panels": PANELS}
    with ExitStack() as finer:
        finer.enter_context(patch.object(solid_influence, "settings_of_case", fine_solid))
        finer.enter_context(patch.object(over_pitch, "POSITIONS", POSITIONS))
        found = answers(case | ({"load_distribution": panels} if kind == "wide pair" else {}), FINEST, cache)
        if kind == "wide pair":
            many = answers(case | {"load_distribution": {**panels, "positions": POSITIONS}}, FINEST, cache)
            found |= {key: one for key, one in many.items() if key[0].startswith(BETWEEN_POSITIONS)}
    if kind == "wide pair" and not any(gear.get("helix_angle") for gear in case["gear"].values()):
        # spur pairs have these of plane teeth
        plane = [one for one in case["results"] if one in ("transmission-error", "root-stress-history")]
        found |= answers(case | {"results": plane}, {"tolerance": 1e-6, **TRUTH})
    return found


if __name__ == "__main__":
    options = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    options.add_argument("kind", choices=KINDS)
    options.add_argument("seed", type=int)
    options.add_argument("count", type=int)
    options.add_argument("tolerances", type=float, nargs="*", default=TOLERANCES)
    options.add_argument("--keep", type=Path)
    given = options.parse_args()
    table(given.kind, given.seed, given.count, tuple(given.tolerances), given.keep)
