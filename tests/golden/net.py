"""The golden net: everything that the cases of ``cases/`` give, compared with what is kept in ``tests/golden/net/``.

Run it before and after a change of the program's structure:

    python tests/golden/net.py [CASE ...] [--accept] [--jobs N]

Every case is computed anew in a process and a store of its own. Compared are all columns, values, remarks, figure
descriptions and the plan; neglected are seconds, dates, versions, paths, and where functions live. Columns and figures
are kept as digests of their numbers to 10 digits, with a few of these, which show whether a difference is noise. A
difference is printed and ends in exit code 1; ``--accept`` keeps what was found.
"""

import argparse
import concurrent.futures
import dataclasses
import hashlib
import json
import os
import re
import subprocess
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
CASES, KEPT = ROOT / "cases", Path(__file__).with_suffix("")
#: Digits of numbers, of those in sentences, and of errors.
DIGITS, DIGITS_OF_WORDS, DIGITS_OF_ERRORS = 10, 6, 3
#: Share of an array's largest number below which its digits are noise.
NOISE = 1e-12
#: An array without a larger number is the round-off of zero, in the unit in which it is shown.
ZERO = 1e-10

_NEGLECTED = (
    (re.compile(re.escape(str(ROOT))), "."),
    (re.compile(r"\b\d{4}-\d\d-\d\d\b"), "(date)"),
    (re.compile(r"\b\d+\.\d+\.\d+\b"), "(version)"),
    (re.compile(r"\b\d+(\.\d+)?(e[-+]?\d+)? s\b"), "(time) s"),
)
_NUMBER = re.compile(r"(?<![\w.])-?\d+\.\d+(e[-+]?\d+)?|(?<![\w.])-?\d+e[-+]?\d+")


def cases():
    """Names of all cases, ``lin_table1`` or ``sources/litvin_fig01``."""
    return sorted(path.relative_to(CASES).with_suffix("").as_posix() for path in CASES.rglob("*.toml"))


def worded(text):
    """A sentence without what depends on time and place, its numbers to 6 digits."""
    for pattern, instead in _NEGLECTED:
        text = pattern.sub(instead, text)
    return _NUMBER.sub(lambda found: f"{float(found.group()):.{DIGITS_OF_WORDS}g}", text)


def rounded(values, digits=DIGITS):
    """Numbers to so many digits, and none finer than 1e-12 of the largest; no negative zeros."""
    values = np.asarray(values, dtype=float)
    size = np.abs(np.where(np.isfinite(values), values, 0.0))
    if not size.any():
        return values + 0.0
    with np.errstate(divide="ignore"):
        power = np.floor(np.log10(size)) - (digits - 1)
    power = np.maximum(power, np.floor(np.log10(size.max()) + np.log10(NOISE)))
    # Two steps: a power of ten may lie beyond what a float can be, its halves do not.
    half = 10.0 ** np.trunc(power / 2)
    rest = 10.0 ** (power - np.trunc(power / 2))
    steps = np.where(np.isfinite(values), np.rint(np.where(np.isfinite(values), values, 0.0) / half / rest), values)
    return steps * half * rest + 0.0


def digest(texts):
    """A short name of a sequence of texts."""
    return hashlib.sha256("\n".join(texts).encode()).hexdigest()[:16]


def _plain(number, digits=DIGITS):
    return float(f"{number:.{digits}g}") if np.isfinite(number) else str(number)


def sampled(values):
    """First, last, smallest, largest and mean of numbers, to 10 digits."""
    finite = values[np.isfinite(values)]
    if not finite.size:
        return []
    return [_plain(one) for one in (finite[0], finite[-1], finite.min(), finite.max(), rounded([finite.mean()])[0])]


def of_array(values):
    """Digest of an array, with samples where it holds numbers."""
    values = np.asarray(values)
    if values.dtype.kind == "c":
        values = np.stack([values.real, values.imag])
    if values.dtype.kind not in "fiu":
        return {"digest": digest([str(values.shape), *(worded(str(one)) for one in values.ravel().tolist())])}
    made = rounded(values)
    return {
        "digest": digest([str(made.shape), *(f"{one:.{DIGITS}g}" for one in made.ravel().tolist())]),
        "sampled": sampled(made),
    }


def _described(thing, into, numbers):
    """Add the parts of a description to `into` as texts, and its arrays of numbers to `numbers`."""
    if dataclasses.is_dataclass(thing) and not isinstance(thing, type):
        into.append(type(thing).__name__)
        thing = {field.name: getattr(thing, field.name) for field in dataclasses.fields(thing)}
    if isinstance(thing, Mapping):
        for key, one in thing.items():
            into.append(f"{key}:")
            _described(one, into, numbers)
    elif isinstance(thing, np.ndarray) or (isinstance(thing, (int, float)) and not isinstance(thing, bool)):
        into.append(of_array(thing)["digest"])
        numbers.append(np.ravel(thing))
    elif isinstance(thing, (tuple, list)):
        into.append(f"{len(thing)} of")
        for one in thing:
            _described(one, into, numbers)
    else:
        into.append(worded(str(thing)))


def of_figure(figure):
    """A figure: what a reader sees first in words, and a digest of all of it."""
    made, parts, numbers = figure.made(), [], []
    _described(made, parts, numbers)
    panels = [f"{p.title}: {p.x.label} [{p.x.unit}] | {p.y.label} [{p.y.unit}]" for p in made.all_panels]
    flat = [one.astype(float) for one in numbers if one.dtype.kind in "fiu"]
    return {
        "title": worded(made.heading),
        "caption": worded(made.caption),
        "panels": list(dict.fromkeys(map(worded, panels))),
        "digest": digest(parts),
        "sampled": sampled(np.concatenate(flat)) if flat else [],
    }


def of_value(value):
    """A value in its unit, with its error."""
    error = value.error
    return {
        "value": _plain(value.value),
        "unit": value.unit,
        "meaning": worded(value.meaning),
        "error": None if error is None else _plain(error, DIGITS_OF_ERRORS),
    }


def _settings(thing):
    """Settings of a task: floats to 10 digits, no seconds."""
    if isinstance(thing, Mapping):
        return {str(key): _settings(one) for key, one in thing.items() if key != "seconds"}
    if isinstance(thing, (tuple, list)):
        return [_settings(one) for one in thing]
    if isinstance(thing, (float, np.floating)):
        return _plain(float(thing))
    return worded(str(thing))


def of_results(found):
    """All that is compared of a run, as plain mappings with one entry a quantity."""
    return {
        "plan": {str(step.task): "" for step in found.plan.steps},
        "settings": {str(task): _settings(outcome.settings) for task, outcome in found.outcomes.items()},
        "tables": {table.name: {"title": worded(table.title), "rows": len(table)} for table in found.tables},
        "columns": {
            f"{table.name} / {column.name}": {"unit": column.unit, "meaning": worded(column.meaning)}
            | of_array(column.values)
            for table in found.tables
            for column in table.columns
        },
        "values": {value.name: of_value(value) for value in found.values},
        "remarks": dict.fromkeys(map(worded, found.remarks), ""),
        "figures": {figure.name: of_figure(figure) for figure in found.figures},
    }


def computed(case):
    """Compute a case in this process; one that fegear refuses gives its message."""
    import fegear

    try:
        return of_results(fegear.run(CASES / f"{case}.toml", progress=False))
    except fegear.FegearError as refusal:
        return {"refused": {worded(str(refusal)): ""}}


def computed_apart(case):
    """Compute a case in a process and a store of its own; returns what it gives, and processor seconds."""
    with tempfile.TemporaryDirectory() as folder:
        lone = {f"{name}_NUM_THREADS": "1" for name in ("OMP", "OPENBLAS", "MKL")}
        path = os.pathsep.join([str(ROOT), *filter(None, [os.environ.get("PYTHONPATH")])])
        environment = {**os.environ, **lone, "FEGEAR_CACHE": folder, "PYTHONPATH": path}
        asked = [sys.executable, __file__, "--one", case]
        done = subprocess.run(asked, env=environment, stdout=subprocess.PIPE, text=True, check=True)
    answer = json.loads(done.stdout.splitlines()[-1])
    return answer["found"], answer["seconds"]


def _apart(kept, found):
    """How far two lists of samples are apart, as a share of the largest kept; None where they cannot be compared."""
    pairs = [(kept, found)] if not isinstance(kept, list) else list(zip(kept, found, strict=False))
    if not pairs or isinstance(kept, list) != isinstance(found, list) or isinstance(kept, list) > (kept != []):
        return None
    if not all(isinstance(one, (int, float)) for pair in pairs for one in pair):
        return None
    size = max(abs(one) for pair in pairs for one in pair)
    return max(abs(one - other) for one, other in pairs) / size if size else 0.0


def _zero(samples):
    """Whether all numbers of an array are round-off of what is zero, in the unit in which they are shown."""
    return bool(samples) and all(isinstance(one, (int, float)) and abs(one) < ZERO for one in samples)


def _differences_of_entry(where, kept, found):
    if not isinstance(kept, dict) or not isinstance(found, dict):
        return [] if kept == found else [f"{where}: {kept} was kept, {found} is found"]
    said = []
    for key in dict.fromkeys([*kept, *found]):
        old, new = kept.get(key), found.get(key)
        if old == new or key == "sampled":
            continue
        if key == "digest" and _zero(kept.get("sampled")) and _zero(found.get("sampled")):
            continue
        share = _apart(kept.get("sampled"), found.get("sampled")) if key == "digest" else _apart(old, new)
        if key == "digest":
            seen = "its samples are the same" if not share else f"its samples differ by {share:.2g} of the largest"
            said.append(f"{where}: numbers or words differ; {seen}")
        else:
            far = "" if share is None else f" (relative difference {share:.2g})"
            said.append(f"{where}, {key}: {old!r} was kept, {new!r} is found{far}")
    return said


def differences(kept, found):
    """Sentences about all that differs between what is kept of a case and what is found."""
    said = []
    for part in dict.fromkeys([*kept, *found]):
        old, new = kept.get(part, {}), found.get(part, {})
        said += [f"{part}: {name} is lost" for name in old if name not in new]
        said += [f"{part}: {name} is new" for name in new if name not in old]
        both = [name for name in old if name in new]
        if both != [name for name in new if name in old]:
            said.append(f"{part}: the order differs")
        for name in both:
            said += _differences_of_entry(f"{part}: {name}", old[name], new[name])
    return said


def place(case):
    """File that keeps a case."""
    return KEPT / f"{case}.json"


def keep(case, found):
    """Write what a case gives, one entry a line so that changes can be read."""
    parts = []
    for part, entries in found.items():
        lines = [f"  {json.dumps(name)}: {json.dumps(one, ensure_ascii=False)}" for name, one in entries.items()]
        parts.append(f" {json.dumps(part)}: {{\n" + ",\n".join(lines) + "\n }")
    place(case).parent.mkdir(parents=True, exist_ok=True)
    place(case).write_text("{\n" + ",\n".join(parts) + "\n}\n", encoding="utf-8")


def checked(case, *, accept=False):
    """Compute a case and compare; returns what differs, and processor seconds."""
    found, seconds = computed_apart(case)
    kept = json.loads(place(case).read_text(encoding="utf-8")) if place(case).exists() else {}
    said = differences(kept, found)
    if accept and said:
        keep(case, found)
    return said, seconds


def _told(case):
    """Print what a case gives, for `computed_apart`."""
    found = computed(case)
    print(json.dumps({"found": found, "seconds": sum(os.times()[:4])}))


def main():
    wishes = argparse.ArgumentParser(description=__doc__.partition("\n")[0])
    wishes.add_argument("cases", nargs="*", metavar="CASE", help="names of cases; all by default")
    wishes.add_argument("--accept", action="store_true", help="keep what is found")
    wishes.add_argument("--jobs", type=int, default=1, metavar="N", help="cases at a time")
    wishes.add_argument("--one", metavar="CASE", help=argparse.SUPPRESS)
    asked = wishes.parse_args()
    if asked.one:
        _told(asked.one)
        return
    known = cases()
    if unknown := sorted({*asked.cases} - {*known}):
        wishes.error(f"{unknown[0]} is no case; there are {', '.join(known)}")
    chosen = asked.cases or known
    changed = 0
    with concurrent.futures.ThreadPoolExecutor(asked.jobs) as pool:
        running = {pool.submit(checked, case, accept=asked.accept): case for case in chosen}
        for done in concurrent.futures.as_completed(running):
            said, seconds = done.result()
            changed += bool(said)
            verdict = f"{len(said)} differences" if said else "the same"
            print(f"{running[done]}: {verdict} ({seconds:.1f} s)", flush=True)
            for line in said[: 5 if asked.accept else None]:
                print(f"  {running[done]}, {line}", flush=True)
    if not asked.cases:
        for path in sorted(KEPT.rglob("*.json")):
            if (case := path.relative_to(KEPT).with_suffix("").as_posix()) not in known:
                print(f"{case}: kept, but no case any more", flush=True)
                changed += 1
                if asked.accept:
                    path.unlink()
    if changed and not asked.accept:
        sys.exit(1)


if __name__ == "__main__":
    main()
