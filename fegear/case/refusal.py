"""What pydantic finds wrong in a case, as one of fegear's own sentences: key, value, rule, remedy."""

from __future__ import annotations

import re
from difflib import get_close_matches
from typing import TYPE_CHECKING, Any

from fegear.base.errors import PATH, InputError, shown
from fegear.case.known_keys import keys_at, places_of, words_at
from fegear.case.nearest import nearest, other_number
from fegear.case.trade_words import Meaning, of_key, of_value

if TYPE_CHECKING:
    from collections.abc import Collection, Mapping, Sequence

    from pydantic import ValidationError
    from pydantic_core import ErrorDetails


#: A key that stands in more tables than these says nothing of the one that is meant.
_FEW_PLACES = 2
#: How alike two spellings are of which one is a slip of the other: `torques`, `torque`.
_ALL_BUT = 0.9


def meant(word: str, known: Collection[str] = ()) -> Meaning | None:
    """What an unknown key means: a known one in the other number, a word of the trade, or a key of another table.

    Of another table unless it is all but a known one. `gears` beside `results` are tables of the case: `[gear.NAME]`.
    """
    if "results" not in known and (key := other_number(word, known)):
        return Meaning((key,))
    found = of_key(word, known)
    places = () if found or get_close_matches(word, known, n=1, cutoff=_ALL_BUT) else tuple(places_of(word))
    return Meaning(places) if 0 < len(places) <= _FEW_PLACES else found


_KINDS = {
    "int_type": "must be a whole number",
    "int_from_float": "must be a whole number",
    "float_type": "must be a number",
    "string_type": "must be a text in quotes",
    "bool_type": "must be true or false",
    "list_type": "must be a list in square brackets",
    "tuple_type": "must be a text in quotes or a list of them",
    "dict_type": "must be a table",
    "model_type": "must be a table of keys and values",
    "finite_number": "must be finite",
}


def refusal(error: ValidationError, document: Mapping[str, Any] | None = None) -> InputError:
    """Return the sentence about the first thing that is wrong.

    Parameters
    ----------
    error : ValidationError
    document : mapping, optional
        What was read; a list of it that stands for a table (`torques`) is named as the user wrote it.
    """
    found = error.errors(include_url=False)
    # A misspelt key comes first: what is said to be missing is often its right spelling.
    first = next((one for one in found if one["type"] == "extra_forbidden"), found[0])
    told = _sentence(first, document)
    if first["type"] in _KINDS:  # the other things that the value may be, where there are several kinds
        others = [
            one["ctx"]["expected"] for one in found if one["type"] == "literal_error" and _place(one) == _place(first)
        ]
        return InputError(told.key, told.value, " or ".join([told.rule, *others]), told.remedy)
    return told


def _place(error: ErrorDetails) -> list[str]:
    """Keys down to the one that is wrong, without pydantic's own names of the kinds that a value may have."""
    steps: list[str] = []
    for step in map(str, error["loc"]):
        known = keys_at(steps)
        if step.isdigit() or not known or step in known or error["type"] == "extra_forbidden":
            steps.append(step)
    return steps


def _as_written(loc: list[str], document: Any) -> list[str]:
    """The same without the key of the list that a list for a table stands for."""
    for i, step in enumerate(loc):
        if isinstance(document, list):
            if step == "values":
                return loc[:i] + loc[i + 1 :]
            if not step.isdigit() or int(step) >= len(document):
                return loc
            document = document[int(step)]
        elif isinstance(document, dict):
            document = document.get(step)
        else:
            return loc
    return loc


def _sentence(error: ErrorDetails, document: Mapping[str, Any] | None = None) -> InputError:
    """Turn one of pydantic's errors into fegear's."""
    kind, context, value = error["type"], error.get("ctx", {}), error.get("input")
    loc = _as_written(_place(error), document)
    if kind == "fegear" and context["key"]:
        loc.append(context["key"])
    key = _dotted(loc)
    if kind == "fegear":
        shown = context["shown"]
        if shown is None:
            shown = value.get(loc[-1], "(not given)") if isinstance(value, dict) and context["key"] else _show(value)
        return InputError(key, shown, context["rule"], context["remedy"])
    if kind == "extra_forbidden":
        if len(loc) > 3 and loc[-2].isdigit() and loc[-1] in keys_at(loc[:-3]):  # of the table that has the list
            return InputError(key, _show(value), "is an unknown key", f"use {_dotted([*loc[:-3], loc[-1]])}")
        known = keys_at(loc[:-1])
        return InputError(key, _show(value), "is an unknown key", nearest(loc[-1], known, words=meant))
    if kind == "missing":
        return InputError(key, "(not given)", "is required", _train_of_a_pair(document) if key == "train.body" else "")
    if kind == "literal_error":
        return InputError(key, _show(value), f"must be {context['expected']}", of_value(key, value))
    if kind in ("too_short", "too_long"):
        return InputError(key, _show(value), _entries(kind, context), of_value(key, value))
    if kind == "model_type":
        return InputError(key, _show(value), _KINDS[kind], of_value(key, value) or _as_table(loc, value))
    rule = _KINDS.get(kind) or error["msg"].replace("Input should", "must").replace("List should", "the list must")
    remedy = of_value(key, value) or (_as_share(value) if kind == "float_type" else "")
    return InputError(key, _show(value), rule[0].lower() + rule[1:], remedy)


def _train_of_a_pair(document: Mapping[str, Any] | None) -> str:
    """The tables of a train of both gears of the first pair, with their own inertia between constant torques."""
    pairs = (document or {}).get("pair")
    for name, pair in pairs.items() if isinstance(pairs, dict) else ():
        first, second = (pair.get(role) if isinstance(pair, dict) else None for role in ("driver", "driven"))
        if isinstance(first, str) and isinstance(second, str):
            bodies = f'driver = {{ gears = ["{first}"] }}, driven = {{ gears = ["{second}"] }}'
            return (
                f"for both gears with their own inertia set train.body = {{ {bodies} }}, train.mesh.{name}.driver = "
                f'"driver", train.mesh.{name}.driven = "driven", train.torque = {{ driver = "..." }} and '
                'train.balance = "driven"'
            )
    return ""


def _as_share(value: object) -> str:
    """How a percentage is written where a number is wanted; empty for all else."""
    found = re.fullmatch(r"\s*(\d+(?:\.\d*)?)\s*%\s*", value) if isinstance(value, str) else None
    return f"write it as a share, {float(found[1]) / 100.0:g}" if found else ""


#: A table with more keys than these is not written out in a remedy.
_FEW_KEYS = 8


def _as_table(loc: Sequence[str], value: object) -> str:
    """How a table is written in whose place there is a single value: with the value as its source, or which keys."""
    known = keys_at(loc)
    if "source" in known and isinstance(value, str):
        words = words_at([*loc, "source"])
        near = get_close_matches(value.lower(), words, n=1)
        if near and value not in words:
            return f'did you mean {loc[-1]} = {{ source = "{near[0]}" }}? The sources are {", ".join(words)}'
        return f"use {loc[-1]} = {{ source = {shown(value, PATH)} }}"
    return f"use {loc[-1]} = {{ ... }} with its keys: {', '.join(known)}" if 0 < len(known) <= _FEW_KEYS else ""


def _entries(kind: str, context: Mapping[str, Any]) -> str:
    """How many entries a list must have."""
    if kind == "too_long":
        return f"must have at most {context['max_length']} entries"
    least = context["min_length"]
    return "must not be empty" if least == 1 else f"must have at least {least} entries"


def _dotted(loc: list[str]) -> str:
    text = ""
    for step in loc:
        text += f"[{step}]" if step.isdigit() else f".{step}"
    return text.removeprefix(".") or "case"


def _show(value: object) -> str:
    if isinstance(value, str):
        return shown(value, PATH)
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, (dict, list)) and len(str(value)) > 60:
        return "(a table)" if isinstance(value, dict) else "(a list)"
    text = str(value)
    return text if len(text) <= PATH else f"{text[:PATH]}..."
