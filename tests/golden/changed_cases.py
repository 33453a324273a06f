"""What becomes of cases of which one key is changed, kept in ``changed_cases.json``: refused, or planned anew.

    python tests/golden/changed_cases.py [--accept]

Of every key that a case of ``cases/`` or of the folder ``small`` has, the smallest such case is read and planned with
it left out, negative, zero, larger or another word, one of them by turns. It is kept which key a refusal names;
otherwise how many tasks and remarks the plan has, and of what they ask for how many numbers are no defaults, and a sum
in which every place has a weight of its own. Sentences do not count.
"""

import argparse
import copy
import dataclasses
import json
import re
import tomllib
import zlib
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
KEPT = Path(__file__).with_suffix(".json")
#: Tables whose second part is a name.
NAMED = ("gear", "pair", "shaft", "bearing", "gauge", "planetary", "compound", "transmissibility", "coupling")
#: What is done to a number, and to what is none.
TO_NUMBERS = ("left out", "negative", "larger", "zero", "left out", "larger")
TO_WORDS = ("left out", "another")
#: How deep what a task asks for is looked into.
DEEP = 12
_NUMBER = re.compile(r"^([-+]?\d+\.?\d*(?:e[-+]?\d+)?)(.*)$", re.DOTALL)


def cases():
    """Paths of the cases, the smallest first."""
    found = [*(ROOT / "cases").glob("*.toml"), *(Path(__file__).parent / "small").glob("*.toml")]
    return sorted(found, key=lambda path: (path.stat().st_size, path.name))


def leaves(thing, way=()):
    """Ways to all keys of a document; a list of numbers or words is one."""
    if isinstance(thing, dict):
        for key, one in thing.items():
            yield from leaves(one, (*way, key))
    elif isinstance(thing, list) and thing and isinstance(thing[0], dict):
        for number, one in enumerate(thing[:1]):
            yield from leaves(one, (*way, number))
    else:
        yield way, thing


def chosen():
    """Of every key the smallest case that has it, the way to it and what is done to it."""
    known = set()
    for path in cases():
        for way, value in leaves(tomllib.loads(path.read_text("utf-8"))):
            key = ".".join("*" if n == 1 and way[0] in NAMED else str(part) for n, part in enumerate(way))
            if key not in known and way != ("title",):
                known.add(key)
                kinds = TO_NUMBERS if _larger(value, 1.3) != value else TO_WORDS
                yield path, way, kinds[zlib.crc32(key.encode()) % len(kinds)]


def _larger(value, factor):
    """A number, with a unit or without, or a list of them, times a factor; anything else as it is."""
    if isinstance(value, bool):
        return value
    if isinstance(value, (int, float)):
        return type(value)(round(value * factor)) if isinstance(value, int) else value * factor
    if isinstance(value, list):
        return [_larger(one, factor) for one in value]
    if isinstance(value, str) and (found := _NUMBER.match(value)):
        return f"{float(found[1]) * factor:.12g}{found[2]}"
    return value


def changed(document, way, change):
    """The document with one key changed."""
    made = copy.deepcopy(document)
    table = made
    for part in way[:-1]:
        table = table[part]
    value = table[way[-1]]
    if change == "left out":
        del table[way[-1]]
    elif change == "another":
        table[way[-1]] = (not value) if isinstance(value, bool) else "another" if isinstance(value, str) else []
    else:
        table[way[-1]] = _larger(value, {"negative": -1.0, "larger": 1.3, "zero": 0.0}[change])
    return made


def _default(field):
    """What a field of a dataclass or of a model is where nothing is given, or nothing."""
    value = getattr(field, "default", None)
    return value if isinstance(value, (bool, int, float, str, tuple, type(None))) else None


def _given(thing):
    """Fields of a thing that are not at their defaults, with their values: a new field with one changes nothing."""
    if dataclasses.is_dataclass(thing) and not isinstance(thing, type):
        fields = {field.name: field for field in dataclasses.fields(thing)}
    else:
        fields = getattr(type(thing), "model_fields", {})
    values = {name: getattr(thing, name, None) for name in fields}
    return {
        name: value
        for name, value in values.items()
        if type(value) is not type(_default(fields[name])) or value != _default(fields[name])
    }


def numbers(thing, into, seen, way=0, deep=0):
    """All numbers of what a task asks for that are no defaults, each with a number for its place."""
    if id(thing) in seen or deep > DEEP:
        return
    if isinstance(thing, (bool, int, float)):
        into.append((way, float(thing)))
        return
    if isinstance(thing, np.ndarray):
        thing = np.ravel(thing).tolist() if thing.dtype.kind in "fiub" else ()
    elif fields := _given(thing):
        seen.add(id(thing))
        thing = fields
    named = thing.items() if isinstance(thing, dict) else enumerate(thing) if isinstance(thing, (list, tuple)) else ()
    for name, one in named:
        numbers(one, into, seen, zlib.crc32(f"{way} {name}".encode()), deep + 1)


def of_asked(asked):
    """How many numbers it is, and a sum of their logarithms in which every place has a weight of its own."""
    found = []
    numbers(asked, found, set())
    ways, values = np.array([*found, (0, 0.0)]).T
    known = np.nan_to_num(values, nan=-1.2345, posinf=1e12, neginf=-1e12)
    mixed = np.dot(np.cos(ways), np.sign(known) * np.log(1.0 + np.abs(known) / 1e-12))
    return [len(found), float(f"{mixed:.8g}")]


def outcome(document, path):
    """What becomes of a case: the key of its refusal, or what its tasks ask for."""
    from fegear.base.errors import FegearError
    from fegear.case.reading import build_scene
    from fegear.engine.plan import make_plan
    from fegear.results.catalogue import STAGES

    try:
        scene = build_scene(document, path.stem, path.parent)
        plan = make_plan(scene, STAGES)
        asked = [step.inputs(scene) for step in plan.steps]
    except FegearError as error:
        return f"refused: {getattr(error, 'key', '')}"
    return [len(plan.steps), len(plan.remarks), *of_asked(asked)]


def found(entries):
    """Outcomes of changes by case, key and what is done."""
    made = {}
    for path, way, change in entries:
        text = f"{'.'.join(map(str, way))} {change}"
        document = tomllib.loads(path.read_text("utf-8"))
        made.setdefault(path.relative_to(ROOT).as_posix(), {})[text] = outcome(changed(document, way, change), path)
    return made


def again(case, known):
    """What differs of a case whose outcomes are known, in words."""
    path, said = ROOT / case, []
    document = tomllib.loads(path.read_text("utf-8"))
    ways = {".".join(map(str, way)): way for way, _ in leaves(document)}
    for text, before in known.items():
        key, _, change = text.partition(" ")
        if key in ways:  # of a case that was changed the rest counts
            after = outcome(changed(document, ways[key], change), path)
            if not same(before, after):
                said.append(f"{case} with {text}: {before} was kept, {after} is found")
    return said


def same(one, other):
    """Whether two outcomes are the same but for round-off."""
    if isinstance(one, str) or isinstance(other, str) or len(one) != len(other):
        return one == other
    return one[:-1] == other[:-1] and abs(one[-1] - other[-1]) <= 1e-6 * max(1.0, abs(one[-1]))


def kept():
    """All that is kept, by case."""
    return json.loads(KEPT.read_text("utf-8")) if KEPT.exists() else {}


def main():
    """Compare, or keep."""
    wishes = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    wishes.add_argument("--accept", action="store_true", help="keep what is found")
    if not wishes.parse_args().accept:
        for case, known in kept().items():
            print(*again(case, known), sep="\n")
        return
    parts = []
    for case, outcomes in sorted(found(chosen()).items()):
        lines = [f"  {json.dumps(text)}: {json.dumps(one)}" for text, one in outcomes.items()]
        parts.append(f" {json.dumps(case)}: {{\n" + ",\n".join(lines) + "\n }")
    KEPT.write_text("{\n" + ",\n".join(parts) + "\n}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
