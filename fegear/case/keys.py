"""What keys a case file knows, table by table."""

from __future__ import annotations

from collections.abc import Mapping
from types import UnionType
from typing import TYPE_CHECKING, Annotated, Union, get_args, get_origin

from pydantic import BaseModel, ValidationError

from fegear.case.model import Case

if TYPE_CHECKING:
    from collections.abc import Sequence


def part_models(annotation: object) -> list[type[BaseModel]]:
    """Tables that an annotation allows: ``Part``, ``Part | None``, ``Annotated[Part, ...]``, ``dict[str, Part]``."""
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
    return sorted({name for model in models for name in model.model_fields})


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
        return flat(Case.model_validate(document).model_dump())
    except ValidationError:
        return flat(document)
