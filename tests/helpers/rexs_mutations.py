"""REXS models with something wrong in their structure, as JSON, XML or an archive; always the same for one number."""

from __future__ import annotations

import copy
import io
import json
import random
import zipfile
from xml.sax.saxutils import escape, quoteattr

from rexs_boxes import random_box
from rexs_models import link, part, planetary_set, ring_stage, two_stages

#: Written into JSON in place of this: a number that overflows.
OVERFLOW = "(overflow)"
VALUES = (
    0, -0.0, -1, 1e300, -1e-300, 1e9, 10**400, OVERFLOW, "", "x", None, [], {}, [1, 2], [[1.0]], True, False,
    "nan", "-inf", "1e999", "1_000", "１２", "٣", "0x10", " 7 ", "\ud800", "a\udfffb", "\x00", "\x7f", "n" * 3000, "é",
    {"code": "float64", "value": "AAAA"}, {"code": "float32", "value": "AACAPwAAgD8AAIA/"}, {"code": 1},
)  # fmt: skip
UNITS = ("", "mm", "m", "mum", "rad", "deg", "N", "N m", "kg", "1/min", "N/mm", "h", "%", None, 3)
TYPES = (
    "shaft", "cylindrical_gear", "ring_gear", "external_load", "x", "planetary_stage", "concept_bearing", "coupling",
    "planet_carrier", "cylindrical_stage", "bevel_stage", "side_plate", "shaft_section", "", None,
)  # fmt: skip
ROLES = ("gear_1", "gear_2", "stage", "assembly", "part", "inner_part", "outer_part", "origin", "referenced", "", None)
LINKS = ("assembly", "ordered_assembly", "stage", "side", "reference", "flank", "x", "", None)
FACTORS = (-1.0, 0.0, 10.0, 0.1, 1e3, 1e-3, 1e6, 1.001)


def loaded_box(seed: int) -> dict:
    """A gearbox with three load cases, and how long they last."""
    draw = random.Random(seed)  # noqa: S311
    unit = draw.choice((("load_duration_fraction", "%"), ("operating_time", "h")))
    cases = [
        {"id": n, "components": [part(1, "gear_unit", **{unit[0]: (share, unit[1])}),
                                 part(31, "external_load", torque_around_u_axis=(torque, "N m"))]}
        for n, (share, torque) in enumerate(((50.0, 100.0), (30.0, 60.0), (20.0, 130.0)), 1)
    ]  # fmt: skip
    return {**two_stages(), "load_spectrum": {"id": 1, "load_cases": cases}}


def whole(draw: random.Random) -> dict:
    """A model with nothing wrong."""
    seed = draw.randrange(1000)
    kinds = (two_stages, planetary_set, ring_stage, lambda: random_box(seed), lambda: loaded_box(seed))
    return copy.deepcopy(draw.choice(kinds)())


def _component(draw: random.Random, tree: dict) -> None:
    parts = tree["components"]
    one = draw.choice(parts)
    kind = draw.randrange(8)
    if kind == 0:
        parts.remove(one)
    elif kind == 1:
        parts.append({**copy.deepcopy(one), "id": draw.choice((one["id"], 9000 + draw.randrange(99)))})
    elif kind == 2:
        one["type"] = draw.choice(TYPES)
    elif kind == 3:
        one["id"] = draw.choice((*VALUES, *(other["id"] for other in parts), -1, 10**30, 1.0, "7"))
    elif kind == 4:
        one["name"] = draw.choice(VALUES)
    elif kind == 5:
        one["attributes"] = draw.choice(VALUES)
    elif kind == 6:
        one.pop(draw.choice(sorted(one)))
    else:
        other = draw.choice(parts)
        one["attributes"], other["attributes"] = other.get("attributes", []), one.get("attributes", [])


def _attribute(draw: random.Random, tree: dict) -> None:
    listed = [one["attributes"] for one in tree["components"] if isinstance(one.get("attributes"), list)]
    listed = [one for one in listed if one and all(isinstance(a, dict) for a in one)]
    if not listed:
        return
    attributes = draw.choice(listed)
    one = draw.choice(attributes)
    key = next((k for k in ("float", "value") if k in one), "value")
    kind = draw.randrange(8)
    if kind == 0:
        attributes.remove(one)
    elif kind == 1:
        attributes.append({**one, key: draw.choice(VALUES)})
    elif kind == 2:
        one["unit"] = draw.choice(UNITS)
    elif kind == 3:
        one["id"] = draw.choice(("number_of_teeth", "center_distance", "face_width", "x", "", None, 3))
    elif kind == 4 and isinstance(one.get(key), list) and one[key]:
        one[key] = draw.choice((one[key][:-1], [*one[key], 1.0], [draw.choice(VALUES), *one[key][1:]]))
    elif isinstance(one.get(key), int | float) and kind < 7:
        one[key] = one[key] * draw.choice(FACTORS)
    else:
        one[key] = draw.choice(VALUES)


def _relation(draw: random.Random, tree: dict) -> None:
    links = tree["relations"]
    one = draw.choice(links)
    kind = draw.randrange(8)
    if kind == 0:
        links.remove(one)
    elif kind == 1:
        links.append(copy.deepcopy(one))
    elif kind == 2:
        one["type"] = draw.choice(LINKS)
    elif kind == 3 and one["refs"]:
        draw.choice(one["refs"])["role"] = draw.choice(ROLES)
    elif kind == 4 and one["refs"]:
        draw.choice(one["refs"])["id"] = draw.choice((*VALUES, *(p.get("id") for p in tree["components"])))
    elif kind == 5:
        one["refs"] = draw.choice((*VALUES, [], one["refs"][:-1], one["refs"] + one["refs"][:1]))
    elif kind == 6:
        one["order"] = draw.choice(VALUES)
    else:
        some = [p["id"] for p in tree["components"] if isinstance(p.get("id"), int)]
        links.append(link(8000 + draw.randrange(99), draw.choice(("assembly", "side", "reference")),
                          assembly=draw.choice(some), part=draw.choice(some)))  # fmt: skip


def _top(draw: random.Random, tree: dict) -> None:
    key = draw.choice((*sorted(tree), "load_spectrum"))
    kind = draw.randrange(4)
    cases = tree.get("load_spectrum", {}).get("load_cases") if isinstance(tree.get("load_spectrum"), dict) else None
    if cases and kind:
        case = draw.choice(cases)
        draw.choice((
            lambda: cases.remove(case), lambda: cases.append(copy.deepcopy(case)),
            lambda: case.update(id=draw.choice(VALUES)), lambda: case.update(components=draw.choice(VALUES)),
            lambda: _attribute(draw, case),
        ))()  # fmt: skip
    elif kind == 0:
        tree[key] = draw.choice(VALUES)
    elif kind == 1:
        tree.pop(key, None)
    elif kind == 2:
        draw.shuffle(tree["components"])
    else:
        draw.shuffle(tree["relations"])


def mutated(seed: int) -> dict:
    """A model with one to three things wrong."""
    draw = random.Random(seed)  # noqa: S311
    tree = whole(draw)
    for _ in range(draw.choice((1, 1, 2, 3))):
        change = draw.choice((_component, _attribute, _attribute, _attribute, _relation, _relation, _top))
        try:
            change(draw, tree)
        except (KeyError, TypeError, IndexError, AttributeError):  # what an earlier change left has no such part
            continue
    return tree


def as_json(tree: dict) -> str:
    """The model as JSON; halves of characters stay."""
    return json.dumps({"model": tree}).replace(f'"{OVERFLOW}"', "1e999")


def as_xml(tree: dict) -> str:
    """The model as XML, as far as XML has it."""

    def plain(value: object) -> str:
        text = value if isinstance(value, str) else json.dumps(value)
        return "".join(sign for sign in text if sign >= " " and not "\ud800" <= sign <= "\udfff")

    def dicts(value: object) -> list[dict]:
        return [one for one in value if isinstance(one, dict)] if isinstance(value, list) else []

    def given(one: dict, *keys: str) -> str:
        return "".join(f" {key}={quoteattr(plain(one[key]))}" for key in keys if key in one)

    def attribute(one: dict) -> str:
        value = next((v for k, v in one.items() if k not in ("id", "unit")), "")
        cells = value if isinstance(value, list) else None
        inside = "<array>" + "".join(f"<c>{escape(plain(c))}</c>" for c in cells) + "</array>" if cells else ""
        if isinstance(value, dict):
            inside = f"<array{given(value, 'code')}>{escape(plain(value.get('value', '')))}</array>"
        return f"<attribute{given(one, 'id', 'unit')}>{inside or escape(plain(value))}</attribute>"

    def component(one: dict) -> str:
        listed = "".join(map(attribute, dicts(one.get("attributes"))))
        return f"<component{given(one, 'id', 'type', 'name')}>{listed}</component>"

    def relation(one: dict) -> str:
        refs = "".join(f"<ref{given(ref, 'id', 'role')}/>" for ref in dicts(one.get("refs")))
        return f"<relation{given(one, 'id', 'type', 'order')}>{refs}</relation>"

    def several(key: str, made) -> str:
        return f"<{key}>{''.join(map(made, dicts(tree.get(key))))}</{key}>"

    spectrum = tree.get("load_spectrum")
    cases = spectrum.get("load_cases") if isinstance(spectrum, dict) else None
    loads = "".join(
        f"<load_case{given(case, 'id')}>{''.join(map(component, dicts(case.get('components'))))}</load_case>"
        for case in dicts(cases)
    )
    return (
        f"<?xml version='1.0'?><model{given(tree, 'version', 'applicationId')}>{several('relations', relation)}"
        f"{several('components', component)}<load_spectrum>{loads}</load_spectrum></model>"
    )


def _cut(draw: random.Random, text: str) -> str:
    """Now and then a text with a piece lost, doubled or exchanged."""
    if draw.random() > 0.15 or len(text) < 10:
        return text
    a, b = sorted((draw.randrange(len(text)), draw.randrange(len(text))))
    b = min(b, a + 40)
    piece = draw.choice(("", text[a:b] * 2, "NaN", "1e999", '"', "<", "}", "&amp;", "&#0;", "\\ud800", "\ufeff", "９"))
    return text[:a] + piece + text[b:]


def _archive(draw: random.Random, name: str, text: str) -> bytes:
    """An archive with the model, now and then damaged or with other things in it."""
    data, kind = io.BytesIO(), draw.randrange(8)
    method = draw.choice((zipfile.ZIP_STORED, zipfile.ZIP_DEFLATED, zipfile.ZIP_BZIP2, zipfile.ZIP_LZMA))
    with zipfile.ZipFile(data, "w", method) as archive:
        inside = {0: "folder/" + name, 1: "../" + name, 2: "x.txt"}.get(kind, name)
        archive.writestr(inside, text.encode("utf-8", "surrogatepass"))
        if kind == 3:
            archive.writestr("second.rexs", text.encode("utf-8", "surrogatepass"))
        if kind == 4:
            archive.writestr("__MACOSX/._" + name, b"\x00\x05")
    made = bytearray(data.getvalue())
    if kind == 5:
        made = made[: draw.randrange(len(made))]
    elif kind == 6:
        for _ in range(draw.randint(1, 4)):
            made[draw.randrange(len(made))] = draw.randrange(256)
    return bytes(made)


def mutated_file(seed: int) -> tuple[str, bytes]:
    """Name and content of a file."""
    draw = random.Random(f"form {seed}")  # noqa: S311
    tree, form = mutated(seed), draw.choice(("json", "json", "xml", "xml", "archive"))
    inner = form if form != "archive" else draw.choice(("json", "xml"))
    text = _cut(draw, as_json(tree) if inner == "json" else as_xml(tree))
    name = "model.rexsj" if inner == "json" else "model.rexs"
    if form == "archive":
        return "model.rexsz", _archive(draw, name, text)
    return name, text.encode("utf-8", "surrogatepass")
