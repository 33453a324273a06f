"""From a REXS file, XML or JSON, to its model: bounded, without entities and without a network."""

from __future__ import annotations

import base64
import binascii
import json
import re
import stat
import struct
from collections.abc import Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any
from xml.parsers import expat

from fegear.base.errors import InputError, shown
from fegear.case.text_file import leads_to, read_text
from fegear.exchange.rexs.archive import archived_text
from fegear.exchange.rexs.model import MOST_COMPONENTS, Attribute, Component, LoadCase, Model, Relation

KEY = "MODEL"
#: Largest file [characters], and the deepest nesting of its elements.
_LARGEST, _DEEPEST = 50_000_000, 40
#: What escapes half of a character in JSON, alone or before its other half.
_HALF = re.compile(r"\\u[dD][89a-fA-F]")
#: Versions whose attributes are known.
_VERSIONS = tuple(f"1.{minor}" for minor in range(8))
#: Whole numbers by which parts are known, with so many digits at most.
_WHOLE = re.compile(r"[-+]?[0-9]{1,18}")
#: How numbers are packed in coded arrays.
_CODES = {"float32": "<{}f", "float64": "<{}d", "int32": "<{}i"}


def read_model(path: Path) -> Model:
    """Read a REXS model.

    Parameters
    ----------
    path : Path
        XML or JSON, told by its first sign, or an archive with one of them.

    Raises
    ------
    InputError
        If it is none, is damaged or too large, declares entities, has another version, or relates what is not there.
    """
    if leads_to(path, stat.S_ISREG) and _begins(path) == b"PK":
        return model_of(archived_text(path, lambda rule, remedy: _refusal(path, rule, remedy)), path)
    return model_of(read_text(path, KEY), path)


def _begins(path: Path) -> bytes:
    """The first two bytes of a file; none where it cannot be read."""
    try:
        with path.open("rb") as file:
            return file.read(2)
    except OSError:
        return b""


def model_of(text: str, path: Path) -> Model:
    """The model that a text describes; `read_model` says what is refused."""
    if len(text) > _LARGEST:
        rule = f"is larger than {_LARGEST // 1_000_000} MB"
        raise _refusal(path, rule, "export the gearbox only, without meshes and results")
    begin = text.lstrip()[:1]
    if begin not in ("<", "{"):
        raise _refusal(path, "is neither XML nor JSON", "check which file it is")
    tree = _xml(text, path) if begin == "<" else _json(text, path)
    return _model(tree, path)


def _refusal(path: Path, rule: str, remedy: str) -> InputError:
    return InputError(KEY, shown(path.name), rule, remedy)


@dataclass
class _Element:
    """An element of XML while it is read."""

    tag: str
    given: dict[str, str]
    parts: list[_Element] = field(default_factory=list)
    text: list[str] = field(default_factory=list)

    def all(self, tag: str) -> list[_Element]:
        return [one for one in self.parts if one.tag == tag]


def _xml(text: str, path: Path) -> dict[str, Any]:
    """The tree of an XML file in the form of a JSON file."""
    parser = expat.ParserCreate("utf-8")
    root = _Element("", {})
    open_ones, count = [root], 0

    def start(tag: str, given: dict[str, str]) -> None:
        nonlocal count
        count += tag == "component"
        if len(open_ones) > _DEEPEST:
            raise _refusal(path, f"nests elements more than {_DEEPEST} deep", "check the file")
        open_ones.append(_Element(tag, given))
        open_ones[-2].parts.append(open_ones[-1])

    def end(_tag: str) -> None:
        open_ones.pop()

    def characters(part: str) -> None:
        open_ones[-1].text.append(part)

    def doctype(*_: object) -> None:
        raise _refusal(path, "contains a document type declaration", "remove the line <!DOCTYPE ...>")

    parser.StartElementHandler, parser.EndElementHandler = start, end
    parser.CharacterDataHandler, parser.StartDoctypeDeclHandler = characters, doctype
    try:
        # What is declared of the encoding no longer holds of a text: it was read as UTF-8 already.
        parser.Parse(text.encode(), True)
    except expat.ExpatError as error:
        why = expat.errors.messages.get(error.code, str(error.code))
        rule = f"is damaged XML in line {error.lineno}: {why}"
        raise _refusal(path, rule, "export it again") from None
    (top,) = root.parts
    if top.tag != "model":
        raise _refusal(path, f"begins with the element {shown(top.tag)}, not with model", "specify a REXS model")
    return {
        **top.given,
        "relations": [
            {**one.given, "refs": [ref.given for ref in one.all("ref")]}
            for part in top.all("relations")
            for one in part.all("relation")
        ],
        "components": [one for part in top.all("components") for one in map(_xml_component, part.all("component"))],
        "load_spectrum": [
            {
                "load_cases": [
                    {**case.given, "components": [_xml_component(one) for one in case.all("component")]}
                    for case in part.all("load_case")
                ]
            }
            for part in top.all("load_spectrum")
        ],
    }


def _xml_component(element: _Element) -> dict[str, Any]:
    return {**element.given, "attributes": [_xml_attribute(one) for one in element.all("attribute")]}


def _xml_attribute(element: _Element) -> dict[str, Any]:
    value: Any = "".join(element.text).strip()
    for array in element.all("array"):
        coded = array.given.get("code")
        cells: list[Any] = ["".join(cell.text).strip() for cell in array.all("c")]
        value = {"code": coded, "value": "".join(array.text).strip()} if coded else cells
    if element.all("matrix") or element.all("array_of_arrays"):
        value = ["(matrix)"]
    return {"id": element.given.get("id"), "unit": element.given.get("unit", ""), "value": value}


def _json(text: str, path: Path) -> dict[str, Any]:
    """The tree of a JSON file."""

    def refuse_constant(name: str) -> float:
        raise _refusal(path, f"contains {name}, not a number", "export it again")

    try:
        tree = json.loads(text, parse_constant=refuse_constant)
    except json.JSONDecodeError as error:
        rule = f"is damaged JSON in line {error.lineno}: {error.msg}"
        raise _refusal(path, rule, "export it again") from None
    except (RecursionError, ValueError):
        raise _refusal(path, "nests its values too deep, or has numbers too long", "check the file") from None
    if _HALF.search(text):
        try:
            json.dumps(tree, ensure_ascii=False).encode()
        except UnicodeEncodeError:
            raise _refusal(path, "contains an invalid character (surrogate)", "export it again") from None
    model = tree.get("model") if isinstance(tree, dict) else None
    if not isinstance(model, dict):
        raise _refusal(path, "has no object model at its top", "specify a REXS model")
    return model


def _model(tree: Mapping[str, Any], path: Path) -> Model:
    """Check what both forms have in common."""
    version = str(tree.get("version", ""))
    if version not in _VERSIONS:
        remedy = f"export it as {_VERSIONS[0]} to {_VERSIONS[-1]}"
        raise _refusal(path, f"has the version {shown(version)} of REXS", remedy)
    listed = _list(tree, "components", path)
    if len(listed) > MOST_COMPONENTS:
        rule = f"has {len(listed)} components, more than the maximum of {MOST_COMPONENTS}"
        raise _refusal(path, rule, "export the gearbox only")
    components: dict[int, Component] = {}
    for one in listed:
        made = _component(one, path)
        if made.id in components:
            raise _refusal(path, f"has two components of the number {made.id}", "export it again")
        components[made.id] = made
    relations = tuple(_relation(one, components, path) for one in _list(tree, "relations", path))
    spectra = tree.get("load_spectrum") or []
    spectra = [spectra] if isinstance(spectra, dict) else spectra
    cases = []
    for spectrum in _dicts(spectra, "load_spectrum", path):
        for case in _list(spectrum, "load_cases", path):
            parts = [_component(one, path, known=components) for one in _list(case, "components", path)]
            cases.append(LoadCase(_number(case, "id", path), {one.id: one.attributes for one in parts}))
    program = " ".join(str(tree.get(key, "")) for key in ("applicationId", "applicationVersion")).strip()
    return Model(version, program, components, relations, tuple(cases))


def _list(tree: Mapping[str, Any], key: str, path: Path) -> list[Mapping[str, Any]]:
    return _dicts(tree.get(key) or [], key, path)


def _dicts(value: object, key: str, path: Path) -> list[Mapping[str, Any]]:
    if not isinstance(value, list) or not all(isinstance(one, dict) for one in value):
        raise _refusal(path, f"has no list of objects as {key}", "export it again")
    return value


def _number(given: Mapping[str, Any], key: str, path: Path) -> int:
    """A whole number by which a part is known; texts of XML and floats of JSON that are one count."""
    value = given.get(key)
    if isinstance(value, float) and value.is_integer():
        value = int(value)
    said = str(value) if isinstance(value, int) and not isinstance(value, bool) else value
    if isinstance(said, str) and _WHOLE.fullmatch(said.strip()):
        return int(said)
    what = f"the number {shown(value)}" if value is not None else "no number"
    raise _refusal(path, f"has a component, relation or load case with {what} as {key}", "export it again")


def _component(given: Mapping[str, Any], path: Path, known: Mapping[int, Component] | None = None) -> Component:
    number = _number(given, "id", path)
    if known is not None and number not in known:
        rule = f"has a load on component {number}, which does not exist"
        raise _refusal(path, rule, "export it again")
    attributes: dict[str, Attribute] = {}
    for one in _list(given, "attributes", path):
        made = _attribute(one, number, path)
        if made.name in attributes and attributes[made.name] != made:
            rule = f"defines {made.name} of component {number} twice with different values"
            raise _refusal(path, rule, "keep the correct one")
        attributes[made.name] = made
    name = given.get("name")
    return Component(number, str(given.get("type", "")), name if isinstance(name, str) else "", attributes)


def _attribute(given: Mapping[str, Any], number: int, path: Path) -> Attribute:
    name = given.get("id")
    if not isinstance(name, str) or not name:
        raise _refusal(path, f"has an attribute without a name in component {number}", "export it again")
    value = next((one for key, one in given.items() if key not in ("id", "unit")), "")
    if isinstance(value, dict):
        value = _decoded(value, name, number, path)
    if isinstance(value, list):
        # Matrices have no place in a case: their rows are not read.
        plain: Any = tuple(one if isinstance(one, str | int | float) else "(row)" for one in value)
    else:
        plain = value if isinstance(value, str | int | float) else ""
    return Attribute(name, str(given.get("unit") or ""), plain)


def _decoded(value: Mapping[str, Any], name: str, number: int, path: Path) -> list[float] | str:
    """The numbers of an array that is packed; those of matrices are not read."""
    layout = _CODES.get(str(value.get("code")))
    if layout is None or "rows" in value or not isinstance(value.get("value"), str):
        return "(matrix)"
    try:
        data = base64.b64decode(value["value"], validate=True)
        size = struct.calcsize(layout.format(1))
        return [float(one) for one in struct.unpack(layout.format(len(data) // size), data)]
    except (binascii.Error, struct.error):
        raise _refusal(path, f"has damaged data for {name} of component {number}", "export it again") from None


def _relation(given: Mapping[str, Any], components: Mapping[int, Component], path: Path) -> Relation:
    number = _number(given, "id", path)
    refs: list[tuple[str, int]] = []
    for ref in _list(given, "refs", path):
        there = _number(ref, "id", path)
        if there not in components:
            rule = f"has a relation {number} to component {there}, which does not exist"
            raise _refusal(path, rule, "export it again")
        refs.append((str(ref.get("role", "")), there))
    order = _number(given, "order", path) if given.get("order") not in (None, "") else 0
    return Relation(number, str(given.get("type", "")), order, tuple(refs))
