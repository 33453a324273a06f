"""Says which keys of a case file a class of Python takes, in its signature and in its documentation."""

from __future__ import annotations

import inspect
import textwrap
from collections.abc import Callable
from typing import TypeVar

from fegear.case.part import Part

_C = TypeVar("_C", bound=type)
_HEAD = "\n\nOther Parameters\n----------------\n"


def takes_keys_of(part: type[Part]) -> Callable[[_C], _C]:
    """Mark a class whose keyword arguments are the keys of a part of a case.

    Its signature lists every key that is no parameter of its own, in their order, and its documentation what each is.
    """

    def mark(kind: _C) -> _C:
        signature = inspect.signature(kind)
        own = [one for one in signature.parameters.values() if one.kind is not one.VAR_KEYWORD]
        keys = {name: field for name, field in part.model_fields.items() if name not in signature.parameters}
        more = [inspect.Parameter(name, inspect.Parameter.KEYWORD_ONLY, default=None) for name in keys]
        kind.__signature__ = signature.replace(parameters=[*own, *more])  # type: ignore[attr-defined]  # inspect reads it
        listed = "\n".join(
            f"{name}\n{textwrap.indent(field.description or '', '    ')}" for name, field in keys.items()
        )
        kind.__doc__ = inspect.cleandoc(kind.__doc__ or "") + _HEAD + listed
        return kind

    return mark
