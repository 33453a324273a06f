"""Keys of what is computed: the function, its arguments by what they are, and the code that makes the answer.

Nobody lists by hand what an answer depends on: on the arguments of the call, all of them. What a type says does not
count (fields of dataclasses with ``compare=False``: names that appear in words only, caches, progress) does not count
here either. What a call has made is known by the key of that call, so that large solutions need not be read again.
"""

from __future__ import annotations

import dataclasses
import functools
import hashlib
import inspect
import json
import sys
import weakref
from collections.abc import Callable, Collection, Mapping, Sequence
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

from fegear.base.code_version import code_version
from fegear.base.plain import PLAIN_KINDS


@dataclass(frozen=True)
class Key:
    """What an answer is known by.

    Parameters
    ----------
    digest : str
        Within this program: 64 hexadecimal digits (SHA-256) of the function's name and the arguments' content.
    packages : frozenset of str
        Packages of fegear whose code makes the answer.
    read : frozenset of int
        Identities of the objects that it was made of.
    """

    digest: str
    packages: frozenset[str] = field(compare=False)
    read: frozenset[int] = field(default=frozenset(), compare=False, repr=False)

    @classmethod
    def of(cls, name: str, *parts: object) -> Key:
        """Of what no function of a module answers alone: a name of its own, and all that the answer depends on."""
        content = _Content(set())
        digest = content.digest([name, *parts])
        return cls(digest, frozenset(content.packages), frozenset(content.read))

    @property
    def lasting(self) -> str:
        """Beyond this program: it changes with the code and the libraries that make the answer."""
        return lasting_key(self.digest, self.packages)


def lasting_key(content: object, packages: Collection[str] = ()) -> str:
    """Key of what is kept beyond this program: bound to the code of packages of fegear, by default of all of them."""
    return content_key(code_version(*sorted(packages)), content)


def call_key(function: Callable[..., object], args: Sequence[object], named: Mapping[str, object]) -> Key:
    """Key of a call: the same for equal arguments, however they are given, and for written-out defaults.

    Parameters
    ----------
    function : callable
        Of a module; what it answers depends on its arguments only.
    args, named : sequence, mapping of str
        See `content_key`.

    Raises
    ------
    TypeError
        If an argument has no content that a key can be made of, or the function does not take the arguments.
    ValueError
        If it is no function of a module: a lambda, or one within another, whose name says nothing of what it holds.
    """
    name = function_name(function)
    given = _signature(function).bind(*args, **named)
    given.apply_defaults()
    content = _Content({_package(function)} if isinstance(name, str) else {""})
    digest = content.digest([name, dict(given.arguments)])
    # Code of other packages than fegear's is in the name; what it calls of fegear may be anything.
    packages = frozenset() if "" in content.packages else frozenset(content.packages)
    return Key(digest, packages, frozenset(content.read))


@functools.cache
def _signature(function: Callable[..., object]) -> inspect.Signature:
    return inspect.signature(function)


def _package(function: Callable[..., object]) -> str:
    return function.__module__.split(".")[1]


def function_name(function: Callable[..., object]) -> object:
    """What a function of a module, or a `functools.partial` of one, is known by.

    Of one that is not fegear's, whose version says nothing of it, the digest of its file belongs to that.

    Raises
    ------
    ValueError
        If other processes could not import it: a lambda, or a function within another.
    """
    if isinstance(function, functools.partial):
        return [function_name(function.func), function.args, function.keywords]
    name = f"{function.__module__}.{function.__qualname__}"
    if "<" in name:
        raise ValueError(f"{name} is not a module-level function and cannot be imported by other processes")
    return name if name.startswith("fegear.") else [name, _foreign_code(function.__module__)]


def _foreign_code(module: str) -> str:
    place = Path(getattr(sys.modules.get(module), "__file__", None) or "")
    return hashlib.sha256(place.read_bytes()).hexdigest() if place.suffix == ".py" and place.is_file() else ""


def content_key(*parts: object) -> str:
    """Key of data by what they are: equal content, equal key, in every process and on every machine.

    Parameters
    ----------
    *parts : plain data, paths (by name), parts of a case, dataclasses of these, what calls have made
        Dataclasses count by the fields that count in comparisons.

    Returns
    -------
    str
        64 hexadecimal digits (SHA-256).

    Raises
    ------
    TypeError
        If a part is none of these.
    """
    return _Content(set()).digest(parts)


#: What calls have made, by the object's identity, as long as it lives.
_MADE: dict[int, tuple[weakref.ref[Any], Key]] = {}


def remember_made(value: object, key: Key) -> None:
    """Remember by which call an object was made.

    One that the call was given, or that cannot be referred to weakly, stays known by its content; one that an earlier
    call made, by that.
    """
    number = id(value)
    if number in key.read or (number in _MADE and _MADE[number][0]() is value):
        return
    try:
        alive = weakref.ref(value, functools.partial(_forget, number))
    except TypeError:
        return
    _MADE[number] = alive, key


def _forget(number: int, gone: weakref.ref[Any]) -> None:
    if number in _MADE and _MADE[number][0] is gone:  # else another object has taken the number
        del _MADE[number]


@functools.cache
def _counting(kind: type) -> tuple[str, ...] | None:
    """Fields of a dataclass that count; None of another type, and of one that is a list, a mapping or a case's part."""
    if not dataclasses.is_dataclass(kind) or issubclass(kind, (list, tuple, Mapping, Path, type)):
        return None
    return (
        None
        if callable(getattr(kind, "model_dump", None))
        else tuple(f.name for f in dataclasses.fields(kind) if f.compare)
    )


class _Content:
    """Objects as plain texts and lists, the same for equal content; with whose code made what it met."""

    def __init__(self, packages: set[str]) -> None:
        self.packages, self.read = packages, set[int]()

    def digest(self, parts: Sequence[object]) -> str:
        """SHA-256 of the parts."""
        text = json.dumps([self.canonical(part) for part in parts], separators=(",", ":"))
        return hashlib.sha256(text.encode()).hexdigest()

    def canonical(self, item: object) -> object:
        """An object as JSON takes it."""
        if type(item) is float:  # most of all that is met
            return ["float", (item + 0.0).hex()]  # so that -0.0 is 0.0
        if isinstance(item, np.generic):
            item = item.item()
        if item is None or isinstance(item, (bool, int, str)):
            return item
        if isinstance(item, float):
            return ["float", (item + 0.0).hex()]
        return self._canonical_object(item)

    def _canonical_object(self, item: object) -> object:
        """The same of what is neither a number nor a text."""
        self.read.add(id(item))
        alive, key = _MADE.get(id(item), (None, None))
        if alive is not None and alive() is item:
            item = key
        if isinstance(item, Key):
            self.packages |= item.packages or {""}
            return ["made", item.digest]
        if isinstance(item, np.ndarray) and item.dtype.kind in PLAIN_KINDS:
            digest = hashlib.sha256(np.ascontiguousarray(item).tobytes()).hexdigest()
            return ["array", item.dtype.str, list(item.shape), digest]
        names = _counting(type(item))  # type: ignore[arg-type]  # every type can be a key of a cache
        if names is not None:
            return ["data", type(item).__qualname__, *([name, self.canonical(getattr(item, name))] for name in names)]
        if isinstance(item, Path):
            return ["path", item.as_posix()]
        if isinstance(item, (list, tuple)):
            return ["list", *(self.canonical(x) for x in item)]
        if isinstance(item, Mapping):
            pairs = [[self.canonical(k), self.canonical(v)] for k, v in item.items()]
            return ["map", *sorted(pairs, key=lambda pair: json.dumps(pair[0]))]
        dump = getattr(item, "model_dump", None)
        if callable(dump):  # a part of a case
            return ["part", type(item).__qualname__, self.canonical(dump())]
        raise TypeError(f"{type(item).__name__} has no content key")
