"""A case as a form: sections and fields made from the model of case files, filled from a document."""

from __future__ import annotations

import json
import re
from dataclasses import dataclass
from functools import cache
from importlib.metadata import version
from typing import TYPE_CHECKING, Any, Literal

from fegear.base.code_version import code_version
from fegear.case.changed_text import as_typed, literal, value_at
from fegear.case.known_keys import help_of
from fegear.case.schema import case_schema
from fegear.case.schema_nodes import SchemaNodes
from fegear.output.report.kept import kept
from fegear.results.catalogue import STAGES

if TYPE_CHECKING:
    from collections.abc import Iterator, Mapping, Sequence

    from fegear.case.changed_text import Path

Kind = Literal["text", "toml", "number", "choice", "switch", "several"]
#: Tables that carry names of the user's choice.
NAMED = ("gear", "pair", "shaft", "bearing", "transmissibility", "planetary", "compound", "rack", "gauge", "encoders")


@dataclass(frozen=True, slots=True)
class Field:
    """One key of a case.

    Parameters
    ----------
    path : tuple of str
    kind : str
        ``text`` and ``choice`` stand in quotes in the case; ``toml`` and ``number`` as they are; ``switch`` is true or
        false; ``several`` a list of names out of `choices`.
    given : bool
        Whether the case has it.
    value : object
        What it has, or the default.
    default : str
        As the case would write it, without quotes; empty where the default follows from other keys.
    hint : str
        What may be typed: unit, range, example.
    choices : mapping of str to str
        Values with what each means.
    required : bool
    about : str
        What it means, in one sentence.
    whole : bool
        Whether it takes whole numbers only.
    """

    path: Path
    kind: Kind
    given: bool
    value: Any
    default: str
    hint: str
    choices: Mapping[str, str]
    required: bool
    about: str = ""
    whole: bool = False

    @property
    def key(self) -> str:
        """Its dotted path, as messages name it."""
        return ".".join(self.path)

    @property
    def label(self) -> str:
        """Its key as words."""
        return self.path[-1].replace("_", " ")

    @property
    def shown(self) -> str:
        """What stands in the field; empty where the case does not give it."""
        if not self.given:
            return ""
        return self.value if isinstance(self.value, str) else literal(self.value)

    def written(self, text: str) -> str | None:
        """What the case shall have for what was typed, as TOML; None to leave the key out."""
        if not text.strip():
            return None
        return literal(text.strip()) if self.kind in ("text", "choice") else as_typed(text)


@dataclass(frozen=True, slots=True)
class Section:
    """A table of a case: its fields, those that are given first, and the tables in it."""

    path: Path
    about: str
    fields: tuple[Field, ...]
    sections: tuple[Section, ...]

    @property
    def title(self) -> str:
        """Its key as words."""
        return " ".join(self.path).replace("_", " ") or "case"

    @property
    def given(self) -> tuple[Field, ...]:
        """What the case gives, or must give."""
        return tuple(field for field in self.fields if field.given or field.required)

    @property
    def left_out(self) -> tuple[Field, ...]:
        """What has its default."""
        return tuple(field for field in self.fields if not (field.given or field.required))


@cache
def _nodes() -> SchemaNodes:
    """Of the schema of cases, which takes a quarter of a second to make and depends on no case."""
    results = {name: entry.about for entry in STAGES.with_added.entries for name in entry.results}
    made_of = json.dumps([version("pydantic"), code_version("case"), results])
    return SchemaNodes(json.loads(kept(f"schema {made_of}", lambda: json.dumps(case_schema(results)).encode())))


def form(document: Mapping[str, Any]) -> tuple[Section, ...]:
    """Make the form of a case.

    Parameters
    ----------
    document : mapping
        The case as plain tables, as far as it goes; it need not be without faults.

    Returns
    -------
    tuple of Section
        First what stands outside of all tables, then the tables in the order of the model.
    """
    top = _nodes().top
    plain = [
        _field((key,), node, document, required=key == "results") for key, node in top.items() if not _tabular(node)
    ]
    found = [Section((), "", tuple(plain), ())]
    for key, node in top.items():
        value = document.get(key)
        if key in NAMED:
            named = value if isinstance(value, dict) else {}
            each = _nodes().meant(node)["additionalProperties"]
            found += [
                _section((key, name), _nodes().meant(each), document)
                for name, one in named.items()
                if isinstance(one, dict)
            ]
        elif _tabular(node) and isinstance(value, dict):
            table = _nodes().table(node)
            found += [_section((key,), table, document, help_of(node))] if table else []
    return tuple(found)


def beside(sections: Sequence[Section], document: Mapping[str, Any]) -> tuple[tuple[Section, ...], ...]:
    """Sections as they stand below each other; those of the two gears of a pair, of which each is in it only, beside.

    Parameters
    ----------
    sections : sequence of Section
    document : mapping
        The case as plain tables, as far as it goes.
    """
    gears = {one.path[1]: one for one in sections if len(one.path) == 2 and one.path[0] == "gear"}
    pairs = document.get("pair")
    mate: dict[str, str] = {}
    for pair in pairs.values() if isinstance(pairs, dict) else ():
        named = [pair.get(key) for key in ("driver", "driven")] if isinstance(pair, dict) else []
        two = [one for one in named if isinstance(one, str) and one in gears and one not in mate]
        if len(set(two)) == 2:
            mate |= {two[0]: two[1], two[1]: ""}
    rows: list[tuple[Section, ...]] = []
    for one in sections:
        name = one.path[1] if len(one.path) == 2 and one.path[0] == "gear" else None
        if name is None or name not in mate:
            rows.append((one,))
        elif mate[name]:
            rows.append((one, gears[mate[name]]))
    return tuple(rows)


def in_rows(two: tuple[Section, Section]) -> tuple[tuple[Field, Field], ...]:
    """Fields of two sections of one kind, key by key, that either of them gives; in the order of the model."""
    given = [{field.path[-1]: field for field in one.fields} for one in two]
    wanted = {field.path[-1] for one in two for field in one.given}
    table = _nodes().table(_nodes().meant(_nodes().top[two[0].path[0]])["additionalProperties"]) or {}
    order = list(table.get("properties", ()))
    return tuple((given[0][key], given[1][key]) for key in order if key in wanted and all(key in one for one in given))


#: Tables of one kind that a form shows: the fields of 3000 gears are built in a minute, and nobody scrolls to them.
_TABLES = 40


def shortened(document: Mapping[str, Any]) -> tuple[dict[str, Any], int]:
    """A case with so many tables as a form shows, and how many it leaves out."""
    found: dict[str, Any] = {}
    left = 0
    for key, value in document.items():
        if not isinstance(value, dict):
            found[key] = value
            continue
        named = [name for name, one in value.items() if isinstance(one, dict)]
        gone = set(named[_TABLES:])
        found[key], inside = shortened({name: one for name, one in value.items() if name not in gone})
        left += len(gone) + inside
    return found, left


def tables_to_add(document: Mapping[str, Any]) -> dict[str, str]:
    """Tables that a case may have besides, with what each is."""
    top = _nodes().top
    found = {}
    for key, node in top.items():
        if key not in NAMED and _tabular(node) and key not in document:
            found[key] = help_of(node).replace("`", "")
    return found


def _tabular(node: Mapping[str, Any]) -> bool:
    return _nodes().table(node) is not None or "additionalProperties" in _nodes().meant(node)


def _section(path: Path, table: Mapping[str, Any], document: Mapping[str, Any], about: str = "") -> Section:
    fields, sections = [], []
    required = table.get("required", ())
    for key, node in table["properties"].items():
        here, value = (*path, key), value_at(document, (*path, key))
        inner = _nodes().table(node)
        if (
            isinstance(value, dict)
            and inner is not None
            and "additionalProperties" not in _nodes().meant(node).get("type", "")
        ):
            sections.append(_section(here, inner, document, help_of(node)))
        elif isinstance(value, dict) and isinstance(_nodes().meant(node).get("additionalProperties"), dict):
            each = _nodes().table(_nodes().meant(node)["additionalProperties"])
            sections += [_section((*here, name), each, document) for name in value] if each else []
            if each is None:
                fields.append(_field(here, node, document, required=key in required))
        else:
            fields.append(_field(here, node, document, required=key in required))
    fields.sort(key=lambda one: not (one.given or one.required))
    about = (about or str(table.get("description", ""))).replace("`", "")
    return Section(path, about, tuple(fields), tuple(sections))


def _field(path: Path, node: Mapping[str, Any], document: Mapping[str, Any], *, required: bool) -> Field:
    kinds, value = _nodes().kinds(node), value_at(document, path)
    default = _nodes().meant(node).get("default")
    shown = "" if default is None else default if isinstance(default, str) else literal(default)
    return Field(
        path, _kind(kinds), value is not None, default if value is None else value, shown,
        "; ".join(dict.fromkeys(filter(None, map(_nodes().hint, kinds)))), _nodes().choices(kinds), required,
        help_of(node).replace("`", ""), {one.get("type") for one in kinds} == {"integer"},
    )  # fmt: skip


def _kind(kinds: list[Mapping[str, Any]]) -> Kind:
    types = {kind.get("type", "string" if "enum" in kind or "const" in kind else "") for kind in kinds}
    if types == {"boolean"}:
        return "switch"
    if types == {"array"} and any("const" in one for one in _nodes().kinds(kinds[0]["items"])):
        return "several"
    if types == {"string"}:
        return "choice" if all("enum" in kind or "const" in kind for kind in kinds) else "text"
    return "number" if types <= {"integer", "number"} else "toml"


#: How notes name a key: "face_width not specified", "Set corner_contact = true", "effects.relief is off".
_NAMED_KEY = re.compile(r"\b(\w+) not specified\b|\b(\w+) = |\beffects\.(\w+)|\b(\w+) is off")


def fields_told(sections: tuple[Section, ...], remarks: Sequence[str]) -> dict[Path, str]:
    """Fields that remarks of a run are about, with what is said of them: assumed values, effects that are off.

    Parameters
    ----------
    sections : tuple of Section
    remarks : sequence of str

    Returns
    -------
    dict
        Remarks by the path of the field.
    """
    found: dict[Path, str] = {}
    named: dict[str, list[Field]] = {}
    for field in fields(sections):
        if len(field.path) == (3 if field.path[0] in NAMED else 2):
            named.setdefault(field.path[-1], []).append(field)
    for remark in remarks:
        keys = {key for one in _NAMED_KEY.finditer(remark) for key in one.groups() if key}
        words = set(re.findall(r"[^\s:;,]+", remark.replace("[", " ").replace("]", " ").replace(".", " ")))
        for field in (one for key in keys for one in named.get(key, ())):
            table = field.path[0]
            if table not in NAMED or (field.path[1] in words and table.capitalize() in words):
                found[field.path] = f"{found[field.path]} {remark}" if field.path in found else remark
    return found


def fields(sections: tuple[Section, ...]) -> Iterator[Field]:
    """Every field of a form."""
    for section in sections:
        yield from section.fields
        yield from fields(section.sections)
