"""Where two cases differ: in what they mean, not in how it is written."""

from __future__ import annotations

import math
from typing import TYPE_CHECKING, NamedTuple

from fegear.case.keys import flat, meaning_of

if TYPE_CHECKING:
    from collections.abc import Mapping

#: Numbers that differ by less than this share are the same: 3 mm and 0.003 m.
_SAME = 1e-12


class Input(NamedTuple):
    """A key that differs, with what each case writes: None where it is not given."""

    key: str
    first: object
    second: object


def different_inputs(first: Mapping[str, object], second: Mapping[str, object]) -> tuple[Input, ...]:
    """Return the keys whose meanings differ; a key at its default is the same as one not given.

    Parameters
    ----------
    first, second : mapping
        Cases as they are written.
    """
    written = flat(first), flat(second)
    meant = meaning_of(first), meaning_of(second)
    keys = dict.fromkeys([*meant[0], *meant[1]])
    found = [key for key in keys if not _same(meant[0].get(key), meant[1].get(key))]
    told = [Input(key, *(_written(key, text) for text in written)) for key in found]
    # What neither writes are defaults within a table that one of them has, which its own keys tell.
    return tuple(one for one in told if one.first is not None or one.second is not None)


def _written(key: str, written: Mapping[str, object]) -> object:
    """What a case writes for a key, or for the table that it stands in (``rack = "ISO 53 A"``)."""
    while key:
        for form in (key, key.replace("[0]", "")):  # one table stands for a list of one
            if form in written:
                return written[form]
        key = key.rpartition(".")[0]
    return None


def _same(a: object, b: object) -> bool:
    if isinstance(a, float) and isinstance(b, float):
        return math.isclose(a, b, rel_tol=_SAME, abs_tol=0.0)
    if isinstance(a, (list, tuple)) and isinstance(b, (list, tuple)):
        return len(a) == len(b) and all(_same(x, y) for x, y in zip(a, b, strict=True))
    return a == b
