"""Tables of a case whose keys a spec of the mechanics declares: type, bounds, default and help are those of `given`.

    if TYPE_CHECKING:

        class _SectionKeys(Part, Section): ...

    else:
        _SectionKeys = keys_of(Section)

    class SectionPart(_SectionKeys): ...  # other keys, rules between keys

A key that a case takes in another way than the spec is written out in the part and keeps its place among the others.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import MISSING, fields
from types import UnionType
from typing import Annotated, Any, Union, get_args, get_origin, get_type_hints

from pydantic import Field, create_model

from fegear.base.given import Given, all_given
from fegear.case.part import Number, Part, quantity

#: Bounds by the names that pydantic has for them, in the order in which they are checked.
_BOUNDS = {"gt": "above", "ge": "at_least", "le": "at_most"}


def keys_of(
    spec: type, *, base: type[Part] = Part, first: Sequence[str] = (), otherwise: Mapping[str, str] | None = None
) -> type[Part]:
    """Make a table of the keys that a spec declares; keys of `base` stand before them.

    Parameters
    ----------
    spec : type
        A dataclass with fields of `fegear.base.given.given`.
    base : type of Part
        What the table has besides.
    first : sequence of str
        Keys that stand before the others of the spec.
    otherwise : mapping of str to str, optional
        Keys that a case may leave out although the spec has a number for them, with what they follow from.
    """
    declared, hints = all_given(spec), get_type_hints(spec)
    defaults = {entry.name: entry.default for entry in fields(spec)}
    keys: dict[str, Any] = {}
    for key in dict.fromkeys((*first, *declared)):
        if key in base.model_fields:
            continue
        how, kind, default = declared[key], hints[key], defaults[key]
        about = how.meaning
        if otherwise and key in otherwise:
            kind, default, about = kind | None, None, f"{about} Default: {otherwise[key]}."
        keys[key] = (_read(kind, how), Field(default=... if default is MISSING else default, description=about))
    return create_model(f"{spec.__name__}Keys", __base__=base, __module__=__name__, **keys)


def _read(kind: Any, how: Given) -> Any:
    """The type of a key: that of the field, read with its unit and within its bounds."""
    if get_origin(kind) in (Union, UnionType):
        (single,) = (part for part in get_args(kind) if part is not type(None))
        return _read(single, how) | None
    if how.dimension:
        if how.at_most is not None or how.above not in (None, 0.0) or how.at_least not in (None, 0.0):
            raise TypeError(f"a quantity has no bound but zero: {how}")
        return Annotated[float, quantity(how.dimension, positive=how.above == 0.0, not_negative=how.at_least == 0.0)]
    kind = Number if kind is float else kind
    bounds = {name: bound for name, key in _BOUNDS.items() if (bound := getattr(how, key)) is not None}
    return Annotated[kind, Field(**bounds)] if bounds else kind
