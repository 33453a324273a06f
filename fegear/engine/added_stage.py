"""A stage of another distribution: whatever goes wrong in its functions is a sentence with its distribution and line.

What the engine would stumble over later (an answer of another type, a task of no stage, a unit that is none) is refused
where it is answered, for nobody else knows whose it was.
"""

from __future__ import annotations

from collections.abc import Callable, Collection, Sequence
from dataclasses import replace
from typing import Any

from fegear.base.cache_keys import Key
from fegear.base.extensions import Guarded, held_to_words
from fegear.engine.citation import Citation, bibliography
from fegear.engine.outcome import Outcome
from fegear.engine.stage import Forecast, Need, Stage, Task
from fegear.engine.table import Table
from fegear.engine.value import Value

_Right = Callable[[Any], object]


def guarded(stage: Stage, name: str, whose: str, known: Collection[str]) -> Stage:
    """The stage, called as its entry point.

    Parameters
    ----------
    stage : Stage
    name : str
    whose : str
        Of the distribution, for messages.
    known : collection of str
        Names of all stages.

    Raises
    ------
    InputError
        If what it says of itself is not what a stage has.
    """

    def tasks(found: Any) -> None:
        _all(found, Task, "needs")
        for task in found:
            if task.stage not in known:
                raise ValueError(f'needs() asks for "{task.stage}", which is not a stage')

    with held_to_words("results", whose):
        for key, kind in (("requires", Need), ("holds", str), ("effects", str), ("answers", str)):
            _all(getattr(stage, key), kind, key)
        for key in ("title", "about", "extra"):
            _one(getattr(stage, key), str, key)
    rights: dict[str, _Right | None] = {
        "subjects": lambda found: _all(found, str, "subjects"),
        "inputs": lambda found: Key.of(name, found),
        "compute": None,
        "present": _presented,
        "needs": tasks,
        "check": None,
        "effects_of": lambda found: _all(found, str, "effects_of"),
        "forecast": lambda found: _one(found, Forecast, "forecast"),
        "cites": _cited,
        "for_readers": lambda found: Key.of(name, found),
    }
    functions: dict[str, Any] = {
        key: Guarded(function, "results", whose, right)
        for key, right in rights.items() if (function := getattr(stage, key)) is not None
    }  # fmt: skip
    return replace(stage, name=name, results=(name,), **functions)


def _one(found: object, kind: type, what: str) -> None:
    if not isinstance(found, kind):
        raise TypeError(f"{what} must be of type {kind.__name__}, and is {found!r}")


def _all(found: Any, kind: type, what: str) -> None:
    _one(found, tuple, what)
    for one in found:
        _one(one, kind, f"each of {what}")


def _cited(found: Any) -> None:
    _all(found, Citation, "cites")
    for one in found:
        if one.key not in bibliography():
            raise ValueError(f'cites() names "{one.key}", which the bibliography of fegear does not hold')


def _presented(found: Any) -> None:
    """An outcome whose tables and values can be written: of known units, each with a name of its own."""
    _one(found, Outcome, "present()")
    for what, kind in (("tables", Table), ("values", Value), ("remarks", str)):
        _all(getattr(found, what), kind, what)
    for table in found.tables:
        for column in table.columns:
            _ = column.values
    for value in found.values:
        _ = value.value, value.error
    for what, names in (("table", [t.name for t in found.tables]), ("value", [v.name for v in found.values])):
        _distinct(what, names)


def _distinct(what: str, names: Sequence[str]) -> None:
    for name in names:
        if names.count(name) > 1:
            raise ValueError(f'two {what}s are called "{name}"')
