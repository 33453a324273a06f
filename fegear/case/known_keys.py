"""What keys a case file knows, table by table."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from types import UnionType
from typing import Annotated, Any, Literal, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError

from fegear.case.model import Case
from fegear.case.part import Later
from fegear.case.renamed import current

#: A list of more names than these is shown by what they are.
_MANY = 12


Node = Mapping[str, Any]


def unit_note(node: Node) -> str:
    """What the description of a quantity says at its end of units."""
    return f" ({node['title']})" if "title" in node and "pattern" in node else ""


def _range(kind: Node) -> list[str]:
    words = []
    if "exclusiveMinimum" in kind:
        words.append(f"greater than {kind['exclusiveMinimum']:g}")
    low, high = kind.get("minimum"), kind.get("maximum")
    if low is not None or high is not None:
        words.append(f"{low:g} to {high:g}" if low is not None and high is not None else
                     f"at least {low:g}" if low is not None else f"at most {high:g}")  # fmt: skip
    if kind.get("type") == "integer":
        words.append("a whole number")
    return words


def help_of(node: Node) -> str:
    """What a key means, as a sentence; its units are distinguished from it."""
    text = str(node.get("description", "")).removesuffix(unit_note(node)).strip()
    if not text:
        return ""
    first = text if text[:2].isupper() or not text[0].isalpha() else text[0].upper() + text[1:]
    return first if first.endswith(".") else f"{first}."


def part_models(annotation: object) -> list[type[BaseModel]]:
    """Tables that an annotation allows: ``Part``, ``Part | None``, ``Annotated[Part, ...]``, ``dict[str, Part]``."""
    if isinstance(annotation, Later):
        return [annotation.part]
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        return [annotation]
    if get_origin(annotation) is Annotated:
        return part_models(get_args(annotation)[0])
    if get_origin(annotation) is dict:
        return part_models(get_args(annotation)[1])
    if get_origin(annotation) is list:
        return part_models(get_args(annotation)[0])
    if get_origin(annotation) in (Union, UnionType):
        return [model for argument in get_args(annotation) for model in part_models(argument)]
    return []


def keys_at(loc: Sequence[str]) -> list[str]:
    """Return the known keys of the table at `loc`; none where the tables carry names of the user's choice."""
    return sorted({name for model in _models_at(loc) for name in model.model_fields})


def words_at(loc: Sequence[str]) -> list[str]:
    """The words that the key at `loc` takes; none where it takes other values."""
    fields = [model.model_fields.get(loc[-1]) for model in _models_at(loc[:-1])]
    return sorted({word for field in fields if field is not None for word in _words(field.annotation)})


def _words(annotation: object) -> Iterator[str]:
    for inner in get_args(annotation):
        if get_origin(annotation) is not Literal:
            yield from _words(inner)
        elif isinstance(inner, str):
            yield inner


def _models_at(loc: Sequence[str]) -> list[type[BaseModel]]:
    models: list[type[BaseModel]] = [Case]
    steps = list(loc)
    while steps:
        step = steps.pop(0)
        annotations = [model.model_fields[step].annotation for model in models if step in model.model_fields]
        if any(get_origin(annotation) is dict for annotation in annotations):
            if not steps:
                return []
            steps.pop(0)  # the name that the user gave
        models = [model for annotation in annotations for model in part_models(annotation)] or models
    return models


def places_of(key: str) -> list[str]:
    """Where a case file has a key of this name: ``gear.NAME.face_width``."""
    found: list[str] = []

    def look(model: type[BaseModel], prefix: str, above: tuple[type[BaseModel], ...]) -> None:
        for name, field in model.model_fields.items():
            here = f"{prefix}{name}"
            found.extend([here] if name == key else [])
            named = ".NAME." if get_origin(field.annotation) is dict else "."
            for inner in part_models(field.annotation):
                if inner not in above:
                    look(inner, f"{here}{named}", (*above, inner))

    look(Case, "", (Case,))
    return found


def flat(document: Mapping[str, object], prefix: str = "") -> dict[str, object]:
    """Tables within tables as dotted keys; lists of tables are numbered."""
    found: dict[str, object] = {}
    for key, value in document.items():
        if isinstance(value, Mapping):
            found |= flat(value, f"{prefix}{key}.")
        elif isinstance(value, (list, tuple)) and any(isinstance(one, Mapping) for one in value):
            for number, one in enumerate(value):
                found |= flat(one, f"{prefix}{key}[{number}].") if isinstance(one, Mapping) else {}
        else:
            found[f"{prefix}{key}"] = value
    return found


def meaning_of(document: Mapping[str, object]) -> dict[str, object]:
    """A case by dotted keys in SI, with the defaults of what it does not give; as it is written if it is no case."""
    try:
        return flat(Case.model_validate(current(document)[0]).model_dump())
    except ValidationError:
        return flat(document)
