"""What has been computed, by the content of its inputs: kept in memory, and on disk where asked."""

from __future__ import annotations

import contextlib
import struct
import time
from collections import Counter, OrderedDict
from collections.abc import Callable, Mapping
from dataclasses import asdict, dataclass
from functools import partial
from pathlib import Path
from types import MappingProxyType
from typing import Any, Generic, Literal, NamedTuple, ParamSpec, TypeVar

import numpy as np

from fegear.base.cache_keys import Key, call_key, remember_made
from fegear.base.plain import pack, unpack
from fegear.base.store import Store, cache_folder

P = ParamSpec("P")
T = TypeVar("T")
Source = Literal["computed", "memory", "disk"]
_SECONDS = struct.Struct("<d")
#: Solutions that wait to be written at most; each takes memory, some 15 MB of a gear.
_MOST_UNWRITTEN = 4


class Codec(NamedTuple, Generic[T]):
    """How solutions of one kind become bytes and come back; `read` gives None for bytes that it cannot use."""

    write: Callable[[T], bytes]
    read: Callable[[bytes | memoryview], T | None]


def fields_codec(kind: type[T]) -> Codec[T]:
    """How dataclasses of numbers, arrays and texts are kept, field by field; bytes with other fields are not used."""

    def read(data: bytes | memoryview) -> T | None:
        try:
            return kind(**unpack(data))  # type: ignore[arg-type]  # what is wrong shows itself
        except (ValueError, KeyError, TypeError):
            return None

    return Codec(lambda found: pack(asdict(found)), read)  # type: ignore[call-overload]  # a dataclass


class Solution(NamedTuple, Generic[T]):
    """A computed value, the seconds that computing it took, and where it comes from now."""

    value: T
    seconds: float
    source: Source


@dataclass
class Account:
    """How often a cache computed and recalled, and the seconds that the recalled solutions took when computed."""

    computed: int = 0
    recalled: int = 0
    from_disk: int = 0
    spared: float = 0.0

    def add(self, computed: int, recalled: int, from_disk: int, spared: float) -> None:
        """Count in what happened elsewhere, in another process for example."""
        self.computed += computed
        self.recalled += recalled
        self.from_disk += from_disk
        self.spared += spared

    def since(self, earlier: tuple[int, int, int, float]) -> Account:
        """What has been counted since `state` was taken."""
        now = self.state
        return Account(now[0] - earlier[0], now[1] - earlier[1], now[2] - earlier[2], now[3] - earlier[3])

    @property
    def state(self) -> tuple[int, int, int, float]:
        """The numbers, to compare with later."""
        return self.computed, self.recalled, self.from_disk, self.spared


class SolutionCache:
    """Solutions by key; an object that its owner hands down, so that equal inputs are computed once where it is shared.

    Parameters
    ----------
    disk : Store, optional
        Where solutions of kinds that have a `Codec` are kept beyond this process.
    most : int
        Solutions in memory; the ones unused for longest go first. A gear's influence functions take some 10 MB.
    check : callable, optional
        Called before something computed is kept; what it raises is raised on, and nothing is kept.
    at_leisure : bool
        Whether what is to go to the disk waits for `write_one`: nobody who wants an answer then waits for it.

    Attributes
    ----------
    solutions, shapes : Account
        Whole results, and the tooth shapes among what they are made of.
    """

    def __init__(
        self, disk: Store | None = None, most: int = 128, check: Callable[[], None] | None = None, *,
        at_leisure: bool = False,
    ) -> None:  # fmt: skip
        self.disk, self._check = disk, check
        self._at_leisure = at_leisure
        self._unwritten: dict[str, Callable[[], None]] = {}
        self.solutions, self.shapes = Account(), Account()
        self._memory: OrderedDict[str, tuple[Any, float]] = OrderedDict()
        self._most = most
        self._new: set[str] = set()
        self._used: set[str] = set()
        self._held: dict[str, dict[int, int]] = {}
        self._holders: Counter[int] = Counter()
        self._sizes: dict[int, int] = {}
        self._total = 0

    def __contains__(self, key: str | Key) -> bool:
        """Whether a solution is in memory."""
        return (key.digest if isinstance(key, Key) else key) in self._memory

    def begin(self) -> None:
        """Start a stretch of work: what is computed in it and used again in it does not count as recalled."""
        self._new.clear()

    def call(self, function: Callable[P, T], *args: P.args, **named: P.kwargs) -> Solution[T]:
        """Recall what a function answers to arguments, or ask it and keep the answer in memory.

        Parameters
        ----------
        function : callable
            Of a module; see `fegear.base.cache_keys.call_key`. What it raises is raised on and nothing is kept.
        *args, **named
            All that the answer depends on; see `fegear.base.cache_keys.content_key`.
        """
        return self._called(None, function, args, named)

    def call_kept(self, codec: Codec[T], function: Callable[P, T], *args: P.args, **named: P.kwargs) -> Solution[T]:
        """The same as `call`; where the cache has a disk, answers are kept there too, bound to the code that made them.

        Parameters
        ----------
        codec : Codec
            How answers become bytes.
        function, *args, **named
            See `call`.
        """
        return self._called(codec, function, args, named)

    def call_kept_if_known(self, codec: Codec[T], function: Callable[P, T], *args: P.args, **named: P.kwargs) -> T:
        """The answer as `call_kept` has it; asked each time where an argument holds a function, which has no key."""
        try:
            call_key(function, args, named)
        except TypeError:
            return self._timed(partial(function, *args, **named)).value
        return self._called(codec, function, args, named).value

    def _called(
        self, codec: Codec[T] | None, function: Callable[..., T], args: tuple[Any, ...], named: dict[str, Any]
    ) -> Solution[T]:
        key = call_key(function, args, named)
        found = self.solve(key, partial(function, *args, **named), codec)
        if found.source != "memory":
            remember_made(found.value, key)
        return found

    def solve(self, key: str | Key, compute: Callable[[], T], codec: Codec[T] | None = None) -> Solution[T]:
        """Recall a solution, or compute and keep it; what `call` does once it has the key.

        Parameters
        ----------
        key : str or Key
            A text is the same in memory and on disk.
        compute : callable
            What it raises is raised on and nothing is kept.
        codec : Codec, optional
            With it, and where the cache has a disk, solutions are kept there too.
        """
        account = self.shapes if codec else self.solutions
        name = key.digest if isinstance(key, Key) else key
        self._used.add(name)
        if name in self._memory:
            self._memory.move_to_end(name)
            value, seconds = self._memory[name]
            if name not in self._new:
                account.add(0, 1, 0, seconds)
            return Solution(value, seconds, "memory")
        if codec is None or self.disk is None:
            found = self._timed(compute)
        else:
            on_disk = key.lasting if isinstance(key, Key) else key
            # Of several processes that want the same solution one computes it and the others wait.
            with self.disk.claim(on_disk):
                found = _read(self.disk.read(on_disk), codec) or self._computed_and_written(on_disk, compute, codec)
        account.add(*((1, 0, 0, 0.0) if found.source == "computed" else (0, 1, 1, found.seconds)))
        self._forget(name)
        self._memory[name] = found.value, found.seconds
        self._new.add(name)
        while len(self._memory) > self._most:
            self._forget(next(iter(self._memory)))
        return found

    def shrink(self, most: int) -> bool:
        """Forget what has been unused for longest until the arrays of what is left take no more than so many bytes.

        What was used since the last time stays, however much that is: it will be asked for again.

        Returns
        -------
        bool
            Whether anything was forgotten.
        """
        known = {id(value): self._held[key] for key, (value, _) in self._memory.items() if key in self._held}
        for key, (value, _) in self._memory.items():
            if key not in self._held:  # the others are counted already
                known[id(value)] = self._held[key] = arrays_of(value, known)
                for array, size in self._held[key].items():
                    self._holders[array] += 1
                    if array not in self._sizes:
                        self._sizes[array] = size
                        self._total += size
        unused = [key for key in self._memory if key not in self._used]
        self._used.clear()
        for number, key in enumerate(unused):
            if self._total <= most:
                return number > 0
            self._forget(key)
        return bool(unused)

    def _forget(self, key: str) -> None:
        """Drop a solution, if it is there, and what it alone holds from the count."""
        self._memory.pop(key, None)
        for array in self._held.pop(key, ()):
            self._holders[array] -= 1
            if not self._holders[array]:
                del self._holders[array]
                self._total -= self._sizes.pop(array)

    def _timed(self, compute: Callable[[], T]) -> Solution[T]:
        started = time.perf_counter()
        value = compute()
        if self._check is not None:
            self._check()
        return Solution(value, time.perf_counter() - started, "computed")

    def _computed_and_written(self, key: str, compute: Callable[[], T], codec: Codec[T]) -> Solution[T]:
        found = self._timed(compute)
        self._unwritten[key] = partial(self._write, key, found, codec)
        while len(self._unwritten) > (_MOST_UNWRITTEN if self._at_leisure else 0):
            self.write_one()
        return found

    def _write(self, key: str, found: Solution[T], codec: Codec[T]) -> None:
        if self.disk is not None:
            with contextlib.suppress(OSError):  # a full disk or a read-only folder costs the next run time, no more
                self.disk.write(key, _SECONDS.pack(found.seconds) + codec.write(found.value))

    def write_one(self) -> bool:
        """Write what has waited for longest to go to the disk; whether there was anything."""
        if not self._unwritten:
            return False
        self._unwritten.pop(next(iter(self._unwritten)))()
        return True


def cache_on_disk(folder: Path | None = None) -> SolutionCache:
    """A cache that keeps solutions between runs, by default in `fegear.base.store.cache_folder`."""
    return SolutionCache(Store((folder or cache_folder()) / "solutions"))


def arrays_of(value: object, known: Mapping[int, Mapping[int, int]] = MappingProxyType({})) -> dict[int, int]:
    """Bytes of every array that an object holds, however deep, by the array's identity: shared ones are the same.

    `known` has those of objects that have been looked through, by the object's identity. What lies in a cache that an
    object recalls from is the cache's, not the object's.
    """
    found: dict[int, int] = {}
    seen: set[int] = set()
    todo: list[object] = [value]
    while todo:
        one = todo.pop()
        if isinstance(one, np.ndarray):
            while isinstance(one.base, np.ndarray):  # of a part the whole is held
                one = one.base
            found[id(one)] = one.nbytes
            if one.dtype != object:
                continue
        if isinstance(one, (str, bytes, int, float, type(None), SolutionCache)) or id(one) in seen:
            continue
        seen.add(id(one))
        if id(one) in known:
            found.update(known[id(one)])
        elif isinstance(one, Mapping):
            todo.extend(one.values())
        elif isinstance(one, (list, tuple, set, frozenset)):
            todo.extend(one)
        else:
            todo.extend(getattr(one, "__dict__", {}).values())
            slots = [name for kind in type(one).__mro__ for name in getattr(kind, "__slots__", ())]
            todo.extend(getattr(one, name, None) for name in slots)
    return found


def _read(data: bytes | None, codec: Codec[T]) -> Solution[T] | None:
    if data is None or len(data) < _SECONDS.size:
        return None
    value = codec.read(memoryview(data)[_SECONDS.size :])  # may be large: not copied
    return None if value is None else Solution(value, _SECONDS.unpack_from(data)[0], "disk")
