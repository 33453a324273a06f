"""Numbers that the code states: constants and tables, defaults, flags and bounds of fields.

    python tests/golden/constants.py [--accept]

Tables of standards and of makers were compared with their print when they were typed in; what a key or an argument is
where it is not given is a promise; how finely something is searched, how large an error is stated and how a figure
looks was measured or looked at. None of it is to change unseen: ``constants.json`` keeps what names in capitals stand
for, what functions take where nothing is given, and of classes that hold data the defaults, whether fields count in
comparisons, and bounds. Of every result it keeps what it takes and for what it asks, and in which files its tables
stand. Long tables are kept as a sum in which every number has a weight of its own. Only what is kept and still there is
compared; after a change that is meant, ``--accept`` keeps what is found.
"""

import argparse
import dataclasses
import enum
import importlib.util
import inspect
import json
import re
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
KEPT = Path(__file__).with_suffix(".json")
#: All packages; the window only where its libraries are.
ROOMS = tuple(
    sorted(folder.name for folder in (ROOT / "fegear").iterdir()
           if any(folder.glob("*.py")) and (folder.name != "window" or importlib.util.find_spec("nicegui")))
)  # fmt: skip
#: So many numbers are kept as they are.
FEW = 12
_GIVEN = re.compile(r"^(_?[A-Z][A-Z0-9_]*(?:, _?[A-Z][A-Z0-9_]*)*)(?:: [^=\n]+)? = (?!\{\}|\[\]|TypeVar)", re.MULTILINE)
#: How many fields of a class of data do not count in comparisons, and so in the keys of results; kept where there are.
UNSEEN = "not compared"
#: How deep what a name stands for is looked into: rows of tables of dataclasses.
DEEP = 8


def modules():
    """Names of all modules, with what is written in them."""
    for path in sorted(path for room in ROOMS for path in (ROOT / "fegear" / room).rglob("*.py")):
        yield ".".join(path.relative_to(ROOT).with_suffix("").parts).removesuffix(".__init__"), path


def assigned(path):
    """Names in capitals that a module gives a value at its top; what begins empty is filled as the program runs."""
    for names in _GIVEN.findall(path.read_text("utf-8")):
        yield from names.split(", ")


def numbers(thing, deep=0):
    """All numbers in what a name stands for, in its order."""
    if isinstance(thing, (bool, int, float, np.number, np.bool_)):
        return [float(thing)]
    if isinstance(thing, np.ndarray):
        return [float(one) for one in thing.ravel()] if thing.dtype.kind in "biuf" else []
    if isinstance(thing, dict):
        thing = [part for pair in thing.items() for part in pair]
    elif isinstance(thing, (set, frozenset)):
        thing = sorted(thing, key=repr)
    elif dataclasses.is_dataclass(thing) and not isinstance(thing, type) and not isinstance(thing, enum.Enum):
        thing = [getattr(thing, field.name, None) for field in dataclasses.fields(thing)]
    if isinstance(thing, (list, tuple)) and deep < DEEP:
        return [number for part in thing for number in numbers(part, deep + 1)]
    return []


def short(found):
    """Few numbers as they are; of many their count and a weighted sum over the largest."""
    if len(found) <= FEW:
        return [float(f"{one:.10g}") for one in found]
    known = np.nan_to_num(found, nan=-1.2345, posinf=1e9, neginf=-1e9)
    largest = max(float(np.abs(known).max()), 1e-300)
    weights = np.cos(1.0 + 2.399963 * np.arange(len(found)))  # turned by the golden angle: no two alike
    return [float(len(found)), float(f"{largest:.10g}"), float(f"{np.dot(weights, known / largest):.10g}")]


def of_class(kind):
    """Defaults, flags and bounds of the fields that a class of data declares."""
    found = {}
    for name, field in getattr(kind, "model_fields", {}).items():
        if name in inspect.get_annotations(kind):
            found[name] = [*numbers(field.default), *numbers(list(field.metadata))]
    if dataclasses.is_dataclass(kind):
        for field in dataclasses.fields(kind):
            if field.name in inspect.get_annotations(kind):
                flags = [] if field.compare and field.repr else [float(field.compare), float(field.repr)]
                found[field.name] = [*numbers(field.default), *flags]
        found[UNSEEN] = [float(sum(not field.compare for field in dataclasses.fields(kind)))]
        found = {name: kept for name, kept in found.items() if name != UNSEEN or kept != [0.0]}
    return found


def defaults(function):
    """What a function takes where nothing is given, by argument."""
    function = inspect.unwrap(getattr(function, "py_func", getattr(function, "fget", None) or function))
    try:
        given = inspect.signature(function).parameters.values()
    except (TypeError, ValueError):
        return {}
    return {one.name: numbers(one.default) for one in given if one.default is not inspect.Parameter.empty}


def of_module(name, path):
    """All that is kept of a module."""
    module, found = importlib.import_module(name), {}
    for known in dict.fromkeys(assigned(path)):
        found[known] = numbers(getattr(module, known, None))
    for known, thing in list(vars(module).items()):
        if getattr(thing, "__module__", None) != name:
            continue
        if isinstance(thing, type):
            found |= {f"{known}.{field}": kept for field, kept in of_class(thing).items()}
            for method, function in list(vars(thing).items()):
                if not (dataclasses.is_dataclass(thing) and method.startswith("__")):
                    given = defaults(getattr(function, "__func__", function))
                    found |= {f"{known}.{method}({one})": kept for one, kept in given.items()}
        elif callable(thing):
            found |= {f"{known}({one})": kept for one, kept in defaults(thing).items()}
    return {known: short(kept) for known, kept in found.items() if kept}


def of_results():
    """Whether stages are for every load, and in points; where their tables stand, by name."""
    from fegear.results.catalogue import STAGES

    kept = {}
    for stage in STAGES:
        kept[stage.name] = [float(stage.every_load), float(stage.in_points)]
        tables, number = list(getattr(getattr(stage.present, "__self__", None), "tables", ())), 0
        while tables:
            one = tables.pop(0)
            tables[:0] = vars(one).get("elements", ()) if dataclasses.is_dataclass(one) else ()
            if hasattr(one, "matlab"):
                name = one.name if isinstance(one.name, str) else number
                kept[f"{stage.name}: {name}"], number = [float(one.printed), float(one.matlab)], number + 1
    return kept


def found():
    """Of all modules, and of all results."""
    return {name: of_module(name, path) for name, path in modules()} | {"results": of_results()}


def kept():
    """All that is kept, by module."""
    return json.loads(KEPT.read_text("utf-8")) if KEPT.exists() else {}


def differences(old, new):
    """What differs of what is in both, in words; a module of which nothing is found any more is there all the same."""
    return [
        f"{module}.{name}: {old[module][name]} was kept, {new[module].get(name, [0])} is found"
        for module in old if module in new
        for name in old[module] if name in new[module] or name.endswith(UNSEEN)
        if not same(old[module][name], new[module].get(name, [0]))
    ]  # fmt: skip


def whole(number):
    """The same, written without a point where it has no digits after it."""
    return int(number) if number.is_integer() and abs(number) < 1e15 else number


def same(one, other):
    """Whether two lists have the same numbers."""
    return len(one) == len(other) and bool(
        np.allclose(np.array(one, float), other, rtol=1e-8, atol=0.0, equal_nan=True)
    )


def main():
    """Compare, or keep."""
    wishes = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    wishes.add_argument("--accept", action="store_true", help="keep what is found")
    asked, new = wishes.parse_args(), found()
    print(*differences(kept(), new), sep="\n")
    if asked.accept:
        parts = []
        for module in sorted(name for name, of_name in new.items() if of_name):
            told = {name: [whole(one) for one in of_name] for name, of_name in new[module].items()}
            parts.append(f" {json.dumps(module)}: {json.dumps(told, sort_keys=True)}")
        KEPT.write_text("{\n" + ",\n".join(parts) + "\n}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
