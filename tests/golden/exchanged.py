"""What REXS models become as cases, and cases as models, kept in ``exchanged.json``.

    python tests/golden/exchanged.py [--accept]

A few models, each as it is and with one attribute changed at a time: every one that a kind of component gives left out
and a tenth larger, and every one that is asked for and not given put in. Of the case that comes out it is kept how many
keys, texts and remarks it has, a checksum of keys and words, and a sum of its numbers in which every one has a weight
of its own; of a refusal the key and the numbers. The same of the models that these cases are written as. Sentences do
not count.
"""

import argparse
import json
import re
import sys
import tomllib
import zlib
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
KEPT = Path(__file__).with_suffix(".json")
sys.path.insert(0, str(ROOT / "tests" / "helpers"))
HERE = Path("model.rexs")
#: Gearboxes that lie askew in space, as they are.
TURNED = (1, 2, 3)
_NUMBER = re.compile(r"[-+]?\d+\.?\d*(?:e[-+]?\d+)?")


def models():
    """Models by name: stages, a ring, sets, and one that has all of a flank, its oil and its bearings."""
    from rexs_boxes import random_box, rotated
    from rexs_cases import with_all_of_a_flank
    from rexs_models import planetary_set, ring_stage, two_stages
    from rexs_mutations import loaded_box

    from fegear.exchange.rexs.reading import _xml
    from fegear.exchange.rexs.written_gearbox import model_text

    rich, _ = model_text(with_all_of_a_flank(), "2026-01-01T00:00:00")
    return {
        "two stages": two_stages(), "ring": ring_stage(), "rich": _xml(rich, HERE), "box": random_box(4),
        "set": planetary_set(15.0, (0.0, 30 * 360 / 84, 240.0)), "load cases": loaded_box(3),
        **{f"turned {seed}": rotated(random_box(seed), seed) for seed in TURNED},
    }  # fmt: skip


def told(numbers, words):
    """Count of numbers and words, checksum of the words, and a weighted sum of the numbers over the largest."""
    found = np.array([*numbers, 0.0], dtype=float)
    weights = np.cos(1.0 + 2.399963 * np.arange(found.size))  # turned by the golden angle: no two alike
    size = np.maximum(np.abs(found), 1e-12)
    mixed = np.dot(weights, np.sign(found) * np.log(1.0 + size / 1e-12))  # small ones count like large ones
    return [len(numbers), len(words), zlib.crc32("\n".join(words).encode()), float(f"{mixed:.7g}")]


def leaves(thing, path=""):
    """Ends of a document and where they are."""
    if isinstance(thing, dict):
        for key, one in thing.items():
            yield from leaves(one, f"{path}.{key}")
    elif isinstance(thing, list):
        for number, one in enumerate(thing):
            yield from leaves(one, f"{path}.{number}")
    elif path != ".title":
        yield path, thing


def of_case(text):
    """What is kept of the text of a case."""
    numbers, words = [], []
    for path, value in leaves(tomllib.loads(text)):
        numbers += [float(one) for one in _NUMBER.findall(str(value))]
        words.append(path + _NUMBER.sub("#", str(value)))
    remarks = sum(line.startswith("#") for line in text.splitlines())
    return [*told(numbers, words), remarks]


def of_model(text):
    """What is kept of the text of a model."""
    body = text[text.index("<relations>") :]
    return told([float(one) for one in _NUMBER.findall(body)], [_NUMBER.sub("#", body)])


def outcome(tree):
    """What a model becomes, or the key of its refusal."""
    from rexs_models import in_json

    from fegear.base.errors import InputError
    from fegear.exchange.rexs.model_to_case import case_of
    from fegear.exchange.rexs.reading import model_of

    try:
        return of_case(case_of(model_of(in_json(tree), HERE)))
    except InputError as error:
        return refusal(error)


def refusal(error):
    """What is kept of a refusal: its key, and the numbers that it says."""
    return [f"refused: {error.key}", *told([float(one) for one in _NUMBER.findall(str(error))], [])]


def asked_for(tree):
    """Attributes that are asked for, with the quantity, by kind of component and name."""
    from fegear.exchange.rexs.said import Said

    found, number = {}, Said.number

    def noticed(self, component, quantity, *names, **more):
        for name in names:
            found.setdefault((component.type, name), quantity)
        return number(self, component, quantity, *names, **more)

    Said.number = noticed
    try:
        outcome(tree)
    finally:
        Said.number = number
    return found


def changed(tree):
    """The model with one attribute changed at a time, by what changes; the first component of a kind stands for all."""
    from fegear.exchange.rexs.written import _UNITS

    asked, known = asked_for(tree), set()
    for at, one in enumerate(tree["components"]):

        def put(attributes, at=at, one=one):
            parts = [*tree["components"]]
            parts[at] = {**one, "attributes": attributes}
            return {**tree, "components": parts}

        given = {attribute["id"]: attribute for attribute in one["attributes"]}
        for name, attribute in given.items():
            if (one["type"], name) in known:
                continue
            known.add((one["type"], name))
            rest = [other for other in one["attributes"] if other is not attribute]
            yield f"{one['type']}.{name} left out", put(rest)
            larger = {key: _larger(value) if key in ("float", "value") else value for key, value in attribute.items()}
            if larger != attribute:
                yield f"{one['type']}.{name} larger", put([*rest, larger])
        for (kind, name), quantity in asked.items():
            if kind == one["type"] and name not in given and (kind, name) not in known:
                known.add((kind, name))
                for size in (1.7, 30.0):
                    added = {"id": name, "unit": _UNITS.get(quantity, "none"), "float": size}
                    yield f"{kind}.{name} of {size:g} put in", put([*one["attributes"], added])


def _larger(value):
    if isinstance(value, list):
        return [_larger(one) for one in value]
    try:
        return 1.1 * float(value) if not isinstance(value, bool) else not value
    except (TypeError, ValueError):
        return {"true": "false", "false": "true"}.get(value, value)


def of_model_named(name):
    """Of a model by its name."""
    return of_tree(models()[name], alone=name.startswith("turned"))


def of_tree(tree, *, alone=False):
    """Of a model and its changes, or of it alone."""
    from rexs_cases import imported

    from fegear.base.errors import InputError
    from fegear.exchange.rexs.written_gearbox import model_text

    found = {"as it is": outcome(tree)}
    try:
        text, left = model_text(imported(tree), "2026-01-01T00:00:00")
        found["written"] = [*of_model(text), len(left)]
    except InputError as error:
        found["written"] = refusal(error)
    return found if alone else found | {change: outcome(other) for change, other in changed(tree)}


def kept():
    """All that is kept, by model and change."""
    return json.loads(KEPT.read_text("utf-8")) if KEPT.exists() else {}


def differences(old, new):
    """What differs of one model, in words."""
    return [
        f"{change}: {before} was kept, {new.get(change)} is found"
        for change, before in old.items() if not same(before, new.get(change))
    ]  # fmt: skip


def same(one, other):
    """Whether two outcomes are the same but for round-off."""
    if not isinstance(other, list) or len(one) != len(other):
        return False
    return all(
        abs(old - new) <= 1e-5 * max(1.0, abs(old)) if isinstance(old, float) else old == new
        for old, new in zip(one, other, strict=True)
    )


def main():
    """Compare, or keep."""
    wishes = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    wishes.add_argument("--accept", action="store_true", help="keep what is found")
    asked, new = wishes.parse_args(), {name: of_model_named(name) for name in models()}
    for name, changes in new.items():
        print(name, *differences(kept().get(name, {}), changes), sep="\n  ")
    if asked.accept:
        parts = []
        for name, changes in new.items():
            lines = [f"  {json.dumps(change)}: {json.dumps(one)}" for change, one in changes.items()]
            parts.append(f" {json.dumps(name)}: {{\n" + ",\n".join(lines) + "\n }")
        KEPT.write_text("{\n" + ",\n".join(parts) + "\n}\n", encoding="utf-8")


if __name__ == "__main__":
    main()
