"""The small net: what cheap runs give, nearly every result among them, compared with what ``small_net.json`` keeps.

    python tests/golden/small_net.py [RUN ...] [--accept]

The golden net (net.py) computes every case at its own tolerance, digit by digit, and takes hours of a processor; this
one is part of the ordinary tests and notices a wrong line of code: of every column, value and figure it keeps the
number of numbers, the smallest, largest and mean, and a sum in which every number has a weight of its own, so that none
changes place unnoticed; of notes and answer the numbers in them, and how many notes there are of each class; in which
order values, tables and figures come; of a figure how many texts it has, of the report how many parts of each kind.
Beside the numbers of figures those of their looks would drown: widths, sizes, limits and choices of axes and curves
have a sum of their own in ``small_net_looks.json``, and so have those of tables and the answer's figure.
Words do not count, nor differences below a millionth of the largest number, in errors of 0.1 %, in sentences of one in
the last digit printed. Cases of the folder ``small`` take each key of a subject.
"""

import argparse
import dataclasses
import json
import math
import re
import sys
import tomllib
import zlib
from collections import Counter
from pathlib import Path

import numpy as np

from fegear.base.notes import NoteClass, class_of
from fegear.output.figures import described
from fegear.output.report.run import run_page

ROOT = Path(__file__).resolve().parents[2]
KEPT = Path(__file__).with_suffix(".json")
LOOKS = KEPT.with_stem("small_net_looks")
#: Fields of figures whose texts are choices, not words.
CHOICES = {"axis", "dash", "role", "symbol", "unit"}
COARSE = {"accuracy.tolerance": 0.1}
ROUGH = {"accuracy.tolerance": 0.3, "load_distribution.positions": 4, "load_distribution.panels": 4}
TRAIN = [
    "natural-modes", "campbell", "dynamic-increments", "mesh-force-spectrum", "tooth-force", "dynamic-root-stress",
    "tooth-friction",
]  # fmt: skip
OVER_FACE = ["gear-mesh-power-loss", "flank-surface", "load-distribution"]
GRID = {
    "tip_amounts": ["12 um", "18 um"], "tip_lengths": ["3 mm"], "crownings": ["3 um"], "end_amounts": ["6 um"],
    "end_lengths": ["2 mm"],
}  # fmt: skip
#: Cases of ``cases/``, or of the folder ``small`` beside this file, with what makes them cheap; by the name of the run.
RUNS = {
    "absorbed": ("small/absorbed", {}),
    "averaging": ("small/averaging", {}),
    "blankenship_singh": ("blankenship_singh", {"transmissibility.I.frequencies": 60}),
    "body_modes": ("thin_rim", {"results": ["body-modes"], "accuracy.tolerance": 0.2}),
    "contact_lines": ("litvin_combined", {"results": ["contact-lines"], "tooth_contact.positions": 40}),
    "cornell_test_gear": ("cornell_test_gear", COARSE),
    "cracked_tooth": ("cracked_tooth", COARSE),
    "crack_growth": ("small/crack_growth", {}),
    "cracked_in_train": ("small/crack_growth", {"results": ["vibration-revolution"]}),
    "crowned_helical": ("small/crowned_helical", {}),
    "design_chart": (
        "lin_design_chart",
        {"dynamics.speeds": ["9000 rpm"], "dynamics.chart": {"amounts": [1.0], "lengths": [0.6, 1.1]}},
    ),
    "design_options": ("small/design_options", {}),
    "determinants": ("four_square_dynamics", {"results": ["dynamic-increments"], "dynamics.determinants": True}),
    "double_helical": (
        "double_helical",
        {
            "accuracy.tolerance": 0.3,
            "pair.I.width": "slices",
            "load_distribution.positions": 4,
            "load_distribution.panels": 4,
            "pair.I.double_helical.axial_play": "6 um",
        },
    ),
    "fillet_design": ("small/fillet_design", {}),
    "flank_design": (
        "helical_flank_design",
        {
            **ROUGH,
            "flank_design.positions": 8,
            "flank_design.grid": GRID,
            "flank_design.families": ["profile", "lead", "profile-and-lead"],
        },
    ),
    "flank_design_options": ("small/flank_design", {}),
    "flank_generation": ("litvin_combined", {"results": ["flank-generation"], "tooth_contact.positions": 40}),
    "forced_response": ("small/forced_response", {}),
    "four_square_dynamics": ("four_square_dynamics", {}),
    "four_square_minimum_excitation": ("four_square_minimum_excitation", {}),
    "fracture_options": ("small/fracture_options", {}),
    "gauges": ("small/gauges", {}),
    "gauges_on_the_face": ("small/gauges_on_the_face", {}),
    "gear_details": ("small/gear_details", {}),
    "gearbox": ("small/gearbox", {}),
    "gearbox_misaligned": ("gearbox_misaligned", ROUGH),
    "helical_rack": ("small/helical_rack", {}),
    "helical_set": (
        "helical_planetary_set",
        {
            **ROUGH,
            "gear.sun.face_width": "5 mm",
            "gear.planet.face_width": "5 mm",
            "gear.ring.face_width": "5 mm",
            "planetary.P.speeds.count": 3,
        },
    ),
    "helical_stage": (
        "helical_stage_train",
        {
            **ROUGH,
            "results": ["mesh-stiffness-matrix", "pair-forced-response"],
            "gear.pinion_1.face_width": "6 mm",
            "gear.wheel_1.face_width": "6 mm",
            "transmissibility.stage.excitation.speeds.count": 5,
        },
    ),
    "high_contact_ratio": ("high_contact_ratio", COARSE),
    "hollow_shafts": ("small/hollow_shafts", {}),
    "idler": ("small/idler", {}),
    "internal_rating": ("small/internal_rating", {}),
    "lead_correction": ("gearbox_misaligned", {**ROUGH, "results": ["lead-correction"]}),
    "least_stress": ("small/least_stress", {}),
    "lin_table1": ("lin_table1", COARSE),
    "litvin_localised": ("litvin_localised", {}),
    "litvin_profile_angle": ("litvin_profile_angle", {}),
    "loading_above_two": ("small/loading_above_two", {}),
    "loading_spectrum": ("small/loading_spectrum", {}),
    "local_friction": ("small/local_friction", {}),
    "mark_minimum_excitation": ("mark_minimum_excitation", {}),
    "mark_tip_relief": ("mark_tip_relief", {}),
    "measured_flanks": ("measured_flanks", {"accuracy.tolerance": 0.2}),
    "measured_gauges": ("strain_gauges", COARSE),
    "measured_transmission_error": ("measured_transmission_error", COARSE),
    "mesh_by_keys": ("small/mesh_by_keys", {}),
    "neighbours_in_train": ("small/neighbours_in_train", {}),
    "odd_planet": ("small/odd_planet", {}),
    "own_mesh": ("own_mesh", COARSE),
    "pinion_and_wheel": ("pinion_and_wheel", COARSE),
    "planet_and_ring": ("planet_and_ring", COARSE),
    "planetary_set": ("planetary_set", {}),
    "planets_in_ring_gear": ("planets_in_ring_gear", COARSE),
    "rack": ("small/rack", {}),
    "rated_in_slices": ("small/rated_in_slices", {}),
    "rated_plane": ("small/rated_plane", {}),
    "rating_factors": ("small/rating_factors", {}),
    "rating_helical": ("rating_helical", {}),
    "rating_options": ("small/rating_options", {}),
    "rating_spur": ("rating_spur", {}),
    "ravigneaux_set": ("ravigneaux_set", {}),
    "relief_chart": (
        "lin_tip_relief",
        {"results": ["relief-chart", "relief-curves"], "design.chart": {"lengths": [0.7]}, "pair.I.loads": ["4445 N"]},
    ),
    "reliefs": ("small/reliefs", {}),
    "ring_check": ("ring_gear", {"results": ["tooth-geometry-check", "geometry"]}),
    "ring_gear": ("ring_gear", COARSE),
    "robust_in_slices": ("small/robust_in_slices", {}),
    "robust_options": ("small/robust_options", {}),
    "robustness": (
        "robust_pair",
        {"robustness.draws": 24, "robustness.reliefs": {"draws": 20}, "accuracy.tolerance": 0.1},
    ),
    "root_stress_study": ("root_stress_population", {"study.samples": 3, "accuracy": {"tolerance": 0.1}}),
    "set_motion": ("small/set_motion", {}),
    "shaft_details": ("small/shaft_details", {}),
    "sizing": ("small/sizing", {}),
    "spur_misaligned": ("spur_misaligned", {"accuracy.tolerance": 0.2}),
    "stiffness_over_face": ("small/stiffness_over_face", {}),
    "stiffness_study": (
        "root_stress_population",
        {
            "results": ["stiffness-study"],
            "study": {"samples": 4, "seed": 1, "teeth": [18, 60], "profile_shift": [-0.2, 0.4]},
        },
    ),
    "surface_and_loss": ("surface_and_loss", COARSE),
    "surface_over_the_face": ("surface_and_loss", {"results": OVER_FACE, "gear.pinion.face_width": "4 mm", **ROUGH}),
    "thin_rim": ("thin_rim", COARSE),
    "train": ("two_stage_gearbox", {"results": TRAIN, "dynamics.speeds": ["4000 rpm"]}),
    "train_in_time": ("small/train_in_time", {}),
    "train_ripple": ("small/train_ripple", {}),
    "two_stage_shafts": ("two_stage_shafts", {}),
    "wide_flanks": ("small/wide_flanks", {}),
}
#: Share of the largest number below which a difference is another processor's.
NOISE = 1e-6
#: The same of what is searched, by a part of its name: where a minimum is flat, the last bit decides where in it a
#: search ends, and which of two extremes that tie it finds. ``OPENBLAS_CORETYPE=SkylakeX`` (``Haswell``,
#: ``Sandybridge``) computes as such a processor does.
SOUGHT = {"robust": 1e-2, "_nominal_best": 1e-2, ".optimum_": 1e-3, "grindable_": 2e-3, "grinding_": 2e-3}
#: What a note says of another minimum that ties hangs on it, too.
TIES = "tip relief to grind"


def kept_of(values):
    """What is kept of numbers: how many, smallest, largest, mean, weighted sum over the largest; [] of no numbers."""
    flat = np.ravel(values)
    if flat.dtype.kind == "c":
        flat = np.concatenate([flat.real, flat.imag])
    if flat.dtype.kind not in "fiub":
        return []
    flat = flat.astype(float)
    finite = np.isfinite(flat)
    numbers = np.where(finite, flat, 0.0)
    weights = np.cos(1.0 + 2.399963 * np.arange(flat.size))  # turned by the golden angle: no two alike
    told = (
        [int(finite.sum()), numbers.min(), numbers.max(), numbers.mean(), (weights * numbers).mean()]
        if flat.size
        else []
    )
    return [one if isinstance(one, int) else float(f"{one:.9g}") for one in told]


def _numbers(thing, into):
    """All numbers of a description of a figure."""
    if dataclasses.is_dataclass(thing) and not isinstance(thing, type):
        thing = [getattr(thing, field.name) for field in dataclasses.fields(thing)]
    if isinstance(thing, dict):
        thing = list(thing.values())
    if isinstance(thing, np.ndarray):
        into.append(np.ravel(thing))
    elif isinstance(thing, (int, float)):
        into.append(np.array([float(thing)]))
    elif isinstance(thing, (list, tuple)):
        for one in thing:
            _numbers(one, into)


def of_figure(figure):
    """What is kept of the numbers of a figure."""
    parts = []
    _numbers(figure.made(), parts)
    parts = [part.astype(float) for part in parts if part.dtype.kind in "fiub"]
    return kept_of(np.concatenate(parts)) if parts else []


def _look(thing, into):
    """Every choice of a description besides its arrays, large numbers by their logarithm."""
    if dataclasses.is_dataclass(thing) and not isinstance(thing, type):
        for field in dataclasses.fields(thing):
            value = getattr(thing, field.name)
            if field.name in CHOICES:
                into.append(zlib.crc32(str(value).encode()) % 1009 / 1009)
            else:
                _look(value, into)
    elif isinstance(thing, dict):
        _look(list(thing.values()), into)
    elif isinstance(thing, (int, float)):
        into.append(math.copysign(math.log1p(abs(thing)), thing) if math.isfinite(thing) else math.nan)
    elif isinstance(thing, (list, tuple)):
        for one in thing:
            _look(one, into)


def _of_choices(thing):
    chosen = []
    _look(thing, chosen)
    return kept_of(np.array(chosen, dtype=float))


def looks_of(found):
    """What is kept of how a run shows its numbers, by name."""
    kept = {f"figure {figure.name}": _of_choices(figure.made()) for figure in found.figures}
    kept["tables"] = _of_choices([(table.printed, table.matlab) for table in found.tables])
    figures, tables = [one.name for one in found.figures], [one.name for one in found.tables]
    said = found.answer
    kept["figure and tables of the answer"] = [
        figures.index(said.figure) if said.figure in figures else -1, *map(tables.index, said.tables),
        *(len(one.columns) for one in said.overviews),
    ]  # fmt: skip
    return kept


def of_run(found):
    """What is kept of a run, by name."""
    kept = {}
    for table in found.tables:
        for column in table.columns:
            of_optimum = table.name.startswith("grindable") and column.name.endswith("_error")
            if of_optimum or column.name == "loaded_exactly":
                continue  # of a flat optimum: another processor finds another one, in other steps
            kept[f"{table.name} / {column.name} [{column.unit}]"] = kept_of(column.values)
    for value in found.values:
        error = [] if value.error is None else [float(f"{value.error:.9g}")]
        kept[f"value {value.name} [{value.unit}]"] = [float(f"{value.value:.9g}"), *error]
    for figure in found.figures:
        kept[f"figure {figure.name}"] = of_figure(figure)
    notes = [note for note in found.remarks if "keys of the gears" not in note]  # of a flat optimum, too
    kept["notes"] = sorted((text for note in notes if TIES not in note for text in numbers_of(note)), key=float)
    classes = Counter(class_of(note) for note in found.remarks)
    kept["notes of each class"] = [classes[kind] for kind in NoteClass]
    if not any(".optimum_" in value.name for value in found.values):
        kept["answer"] = [text for sentence in found.answer.sentences for text in numbers_of(sentence)]
    for kind in ("values", "tables", "figures"):
        names = [one.name for one in getattr(found, kind)]
        kept[f"order of {kind}"] = kept_of(np.argsort(names))
    kept["texts of figures"] = [_parts(figure.made())["text"] for figure in found.figures]
    parts = _parts(run_page(found, described(found), list(found.remarks)).sections)
    kept["parts of the report"] = [parts[kind] for kind in sorted(parts) if kind != "text"]
    return kept


def _parts(thing):
    """How many texts and how many objects of each kind a description is made of."""
    if isinstance(thing, str):
        return Counter(text=1) if thing else Counter()
    found = Counter()
    if dataclasses.is_dataclass(thing) and not isinstance(thing, type):
        found[type(thing).__name__] = 1
        thing = [getattr(thing, field.name) for field in dataclasses.fields(thing)]
    if isinstance(thing, dict):
        thing = list(thing.values())
    if isinstance(thing, (list, tuple)):
        for one in thing:
            found += _parts(one)
    return found


def numbers_of(note):
    """Numbers of a sentence as printed but estimates of errors; those that are part of a word are none."""
    plain = re.sub(r"\+- [\d.e+-]+", "", note.replace(",", ""))
    return re.findall(r"(?<![\w.])-?(?:\d+\.?\d*|\.\d+)(?:e[+-]?\d+)?(?![\w])", plain)


def path_of(case):
    """The file of a case: of the folder ``small`` beside this file, or of ``cases/``."""
    folder = Path(__file__).parent if "/" in case else ROOT / "cases"
    return folder / f"{case}.toml"


def wanted(name):
    """Results that a run asks for."""
    case, changes = RUNS[name]
    return changes.get("results") or tomllib.loads(path_of(case).read_text("utf-8"))["results"]


def computed(name, cache=None):
    """Run a case in this process."""
    import fegear
    from fegear.base.solution_cache import SolutionCache

    case, changes = RUNS[name]
    return fegear.run(path_of(case), changes, progress=False, cache=cache or SolutionCache())


def kept(path=KEPT):
    """All that is kept, by run."""
    return json.loads(path.read_text("utf-8")) if path.exists() else {}


def keep(path, known):
    """Write what is kept: a line for each name."""
    runs = []
    for name in sorted(set(RUNS) & set(known)):
        lines = [f"  {json.dumps(key)}: {json.dumps(one)}" for key, one in known[name].items()]
        runs.append(f" {json.dumps(name)}: {{\n" + ",\n".join(lines) + "\n }")
    path.write_text("{\n" + ",\n".join(runs) + "\n}\n", encoding="utf-8")


def differences(old, new):
    """What differs, in words; what is new besides is no difference."""
    said = [f"{name} is lost" for name in old if name not in new]
    for name in old:
        if name in new and not _same(name, old[name], new[name]):
            said.append(f"{name}: {old[name]} was kept, {new[name]} is found")
    return said


def _same(name, old, new):
    """Whether two summaries say the same numbers; errors, which noise in the last place changes more, to 0.1 %."""
    if len(old) != len(new):
        return False
    if name in ("notes", "answer"):
        return all(abs(float(one) - float(other)) <= last_digit(one) for one, other in zip(old, new, strict=True))
    of_value = name.startswith("value ")
    size = 0.0 if of_value else max((abs(one) for one in (*old[1:], *new[1:])), default=0.0)
    for place, (one, other) in enumerate(zip(old, new, strict=True)):
        error = "_error" in name.partition(" / ")[2] or (of_value and place == 1)
        sought = next((share for part, share in SOUGHT.items() if part in name), 0.0)
        loose, least = (max(1e-3, min(50.0 * sought, 0.5)), 1e-5) if error else (max(NOISE, sought), 1e-6)
        if one != other and not abs(one - other) <= loose * max(size, abs(one), least):
            return False
    return True


def last_digit(text):
    """What one in the last digit of a printed number is worth, and a little more."""
    digits, _, power = text.partition("e")
    return 1.001 * 10.0 ** (int(power or 0) - len(digits.partition(".")[2]))


def main():
    """Compare, or keep."""
    wishes = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    wishes.add_argument("runs", nargs="*", metavar="RUN")
    wishes.add_argument("--accept", action="store_true", help="keep what is found")
    asked = wishes.parse_args()
    known, looks, changed = kept(), kept(LOOKS), 0
    for name in asked.runs or RUNS:
        found = computed(name)
        new, seen = of_run(found), looks_of(found)
        said = differences(known.get(name, {}), new) + differences(looks.get(name, {}), seen)
        changed += len(said)
        print(f"{name}: {len(said)} differences", *said[:20], sep="\n  ", flush=True)
        if asked.accept:
            known[name], looks[name] = new, seen
    if asked.accept:
        keep(KEPT, known)
        keep(LOOKS, looks)
    elif changed:
        sys.exit(1)


if __name__ == "__main__":
    main()
