"""Many independent points on all cores or on a Dask cluster, each kept as soon as it is finished.

The numbers do not depend on who computes them: every point runs alone in one thread, and every result passes through
the same bytes whether it was just computed, came over the network or from the store.
"""

from __future__ import annotations

import contextlib
from collections.abc import Callable, Generator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any

from fegear.base.cache_keys import function_name, lasting_key
from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.base.store import Store
from fegear.engine.cluster import on_cluster
from fegear.engine.processes import Job, Reply, cores, here, on_cores, opened, tidy
from fegear.engine.progress import Progress

Todo = Mapping[int, object]


@dataclass(frozen=True, slots=True)
class Executor:
    """Who computes points that do not depend on each other.

    Parameters
    ----------
    scheduler : str or None
        Address of a running Dask scheduler, for example ``"tcp://10.0.0.5:8786"``; None for processes on this machine.
    workers : int or None
        How many processes; by default one for each core.
    here : bool
        One after the other in this process, whose cores are busy already: what a worker hands down.
    """

    scheduler: str | None = None
    workers: int | None = None
    here: bool = False

    def __post_init__(self) -> None:
        """Refuse an address that is none: it is what an unset variable of a shell leaves."""
        if self.scheduler is not None and not self.scheduler.strip():
            raise InputError(
                "--scheduler", f'"{self.scheduler}"', "is not a valid address",
                "for example tcp://10.0.0.5:8786, or remove --scheduler to compute on this machine",
            )  # fmt: skip


def map_points(
    function: Callable[..., object],
    points: Sequence[Any],
    executor: Executor | None = None,
    cache: SolutionCache | None = None,
    *,
    key: Callable[[Any], object] | None = None,
    shares_cache: bool = False,
    progress: Progress | None = None,
) -> tuple[Any, ...]:
    """Apply a function to every point, in parallel, never twice to the same.

    Parameters
    ----------
    function : callable
        Of a module (or `functools.partial` of one); takes a point and returns plain data (see
        `fegear.base.plain.pack`).
    points : sequence
        Anything that can be pickled; with a cache on disk, what `fegear.base.cache_keys` knows by its content, unless
        `key` is given.
    executor : Executor, optional
        By default processes on this machine.
    cache : SolutionCache, optional
        Where it has a disk, finished points are kept there at once and read from there if they were computed before by
        the same code, so that a killed run loses only what it was at.
    key : callable, optional
        ``key(point)`` is all that the result depends on, by default the point itself.
    shares_cache : bool
        Whether the function is called as ``function(point, cache)`` with the cache of the process that it runs in, so
        that points there share tooth shapes.
    progress : callable, optional
        Receives the fraction of points done.

    Returns
    -------
    tuple
        For each point its result, or a `Failure` with the reason. Tuples stay tuples, arrays arrays; the bits are
        the same whoever computed them.

    Raises
    ------
    InputError
        If the scheduler does not answer, or the disk cannot be written to.
    MissingLibraryError
        If something is missing that every point needs.
    """
    executor, cache = executor or Executor(), SolutionCache() if cache is None else cache
    name, store = function_name(function), cache.disk and cache.disk.of_points()
    keys = _keys(name, points, key, store)
    payloads: dict[str, bytes] = {}
    for one in set(keys) if store else ():
        kept = store.read(one) if store else None
        if kept is not None:
            payloads[one] = kept
    first = {one: i for i, one in reversed(list(enumerate(keys))) if one not in payloads}
    todo = {i: points[i] for i in sorted(first.values())}
    report = progress or _silent
    count = len(set(keys)) or 1
    report(len(payloads) / count)
    with contextlib.closing(_replies(function, todo, executor, cache, shares_cache)) as replies:
        for i, reply in replies:
            payloads[keys[i]] = reply.payload
            if store and reply.lasting:
                _keep(store, keys[i], reply.payload)
            cache.shapes.add(*reply.shapes)
            report(len(payloads) / count)
    return tuple(opened(payloads[one]) for one in keys)


def count_kept(
    function: Callable[..., object],
    points: Sequence[Any],
    cache: SolutionCache,
    key: Callable[[Any], object] | None = None,
) -> int:
    """How many of the points `map_points` would find on the cache's disk."""
    store = cache.disk and cache.disk.of_points()
    return sum(one in store for one in _keys(function_name(function), points, key, store)) if store else 0


def _silent(fraction: float) -> None:
    """Report nothing."""


def _keys(name: object, points: Sequence[Any], key: Callable[[Any], object] | None, store: Store | None) -> list[str]:
    if store is None:
        return [str(i) for i in range(len(points))]
    return [lasting_key([name, key(point) if key else point]) for point in points]


def _keep(store: Store, key: str, payload: bytes) -> None:
    try:
        store.write(key, payload)
    except OSError as error:
        raise InputError(
            "FEGEAR_CACHE",
            store.folder,
            f"is not writable ({error.strerror or error})",
            "set FEGEAR_CACHE to a folder with free space, or use --no-cache",
        ) from None


def _replies(
    function: Callable[..., object], todo: Todo, executor: Executor, cache: SolutionCache, shares_cache: bool
) -> Generator[tuple[int, Reply]]:
    if not todo:
        return
    if executor.here:
        for i, point in todo.items():
            yield i, here(function, point, cache if shares_cache else None)
            tidy()
    elif executor.scheduler is not None:
        # Folders of this machine mean nothing on others: workers of a cluster keep solutions where they keep theirs.
        yield from on_cluster(Job(function, shares_cache, cache.disk is not None, None), todo, executor.scheduler)
    else:
        folder = str(cache.disk.folder.parent) if cache.disk else None
        while cache.write_one():  # the processes find there what has been solved
            pass
        yield from on_cores(
            Job(function, shares_cache, cache.disk is not None, folder), todo, executor.workers or cores()
        )
