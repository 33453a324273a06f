"""Many independent points on all cores or on a Dask cluster, each kept as soon as it is finished.

The numbers do not depend on who computes them: every point runs alone in one thread, and every result passes through
the same bytes whether it was just computed, came over the network or from the store.
"""

from __future__ import annotations

import contextlib
import functools
from contextvars import ContextVar
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from fegear.engine.cluster import on_cluster
from fegear.engine.point_job import Job, Reply, here, inside_a_worker, opened
from fegear.engine.processes import cores, on_cores
from fegear.errors import InputError
from fegear.plain import code_version, content_key
from fegear.store import shape_keeper

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterator, Mapping, Sequence

    from fegear.engine.stage import Progress
    from fegear.store import Store

    Todo = Mapping[int, object]


@dataclass(frozen=True, slots=True)
class Executor:
    """Who computes, where a call does not say it itself.

    Parameters
    ----------
    scheduler : str or None
        Address of a Dask scheduler; None for processes on this machine.
    workers : int or None
        How many processes; by default one for each core.
    """

    scheduler: str | None = None
    workers: int | None = None


_executor: ContextVar[Executor] = ContextVar("fegear_executor", default=Executor())  # noqa: B039  (it is frozen)


@contextlib.contextmanager
def computing_by(scheduler: str | None = None, workers: int | None = None) -> Iterator[None]:
    """Set who computes for every `map_points` inside the block that does not say it itself."""
    token = _executor.set(Executor(scheduler, workers))
    try:
        yield
    finally:
        _executor.reset(token)


def _name(function: Callable[[Any], object]) -> object:
    if isinstance(function, functools.partial):
        return [_name(function.func), function.args, function.keywords]
    name = f"{function.__module__}.{function.__qualname__}"
    if "<" in name:
        raise ValueError(f"map_points needs a function of a module, not {name}, so that other processes can import it")
    return name


def map_points(
    function: Callable[[Any], object],
    points: Sequence[Any],
    *,
    store: Store | None = None,
    key: Callable[[Any], object] | None = None,
    scheduler: str | None = None,
    workers: int | None = None,
    progress: Progress | None = None,
) -> tuple[Any, ...]:
    """Apply a function to every point, in parallel, never twice to the same.

    Parameters
    ----------
    function : callable
        Of a module (or `functools.partial` of one); takes a point and returns plain data (see `fegear.plain.pack`).
    points : sequence
        Anything that can be pickled; with a store, what `fegear.plain.content_key` takes, unless `key` is given.
    store : Store, optional
        Finished points are kept there at once and read from there if they were computed before by the same code, so
        that a killed run loses only what it was at.
    key : callable, optional
        ``key(point)`` is all that the result depends on, by default the point itself.
    scheduler : str, optional
        Address of a running Dask scheduler, for example ``"tcp://10.0.0.5:8786"``; by default one process for each
        core of this machine. Inside a worker the points are computed one after the other.
    workers : int, optional
        Number of processes.
    progress : callable, optional
        Is told the fraction of points done.

    Returns
    -------
    tuple
        For each point its result, or a `Failure` with the reason. Tuples stay tuples, arrays arrays; the bits are
        the same whoever computed them.

    Raises
    ------
    InputError
        If the scheduler does not answer, or the store cannot be written to.
    MissingLibraryError
        If something is missing that every point needs.
    """
    name = _name(function)
    own = _executor.get()
    scheduler, workers = scheduler or own.scheduler, workers or own.workers
    keys = _keys(name, points, key, store)
    payloads: dict[str, bytes] = {}
    for one in set(keys) if store else ():
        kept = store.read(one) if store else None
        if kept is not None:
            payloads[one] = kept
    first = {one: i for i, one in reversed(list(enumerate(keys))) if one not in payloads}
    todo = {i: points[i] for i in sorted(first.values())}
    tell = progress or _silent
    count = len(set(keys)) or 1
    tell(len(payloads) / count)
    with contextlib.closing(_replies(function, todo, scheduler, workers)) as replies:
        for i, reply in replies:
            payloads[keys[i]] = reply.payload
            if store and reply.lasting:
                _keep(store, keys[i], reply.payload)
            keeper = shape_keeper()
            if keeper:
                keeper.count(*reply.shapes)
            tell(len(payloads) / count)
    return tuple(opened(payloads[one]) for one in keys)


def count_kept(
    function: Callable[[Any], object], points: Sequence[Any], store: Store, key: Callable[[Any], object] | None = None
) -> int:
    """How many of the points `map_points` would find in the store."""
    return sum(one in store for one in _keys(_name(function), points, key, store))


def _silent(fraction: float) -> None:
    """Tell nobody."""


def _keys(name: object, points: Sequence[Any], key: Callable[[Any], object] | None, store: Store | None) -> list[str]:
    if store is None:
        return [str(i) for i in range(len(points))]
    version = code_version()
    return [content_key(version, name, key(point) if key else point) for point in points]


def _keep(store: Store, key: str, payload: bytes) -> None:
    try:
        store.write(key, payload)
    except OSError as error:
        raise InputError(
            "FEGEAR_CACHE",
            store.folder,
            f"cannot be written to ({error.strerror or error})",
            "set FEGEAR_CACHE to a folder with room, or take --no-cache",
        ) from None


def _replies(
    function: Callable[[Any], object], todo: Todo, scheduler: str | None, workers: int | None
) -> Generator[tuple[int, Reply]]:
    keeper = shape_keeper()
    if not todo:
        return
    if inside_a_worker():
        yield from ((i, here(function, point)) for i, point in todo.items())
    elif scheduler is not None:
        # Folders of this machine mean nothing on others: workers of a cluster keep shapes where they keep theirs.
        yield from on_cluster(Job(function, keeper is not None, None), todo, scheduler)
    else:
        job = Job(function, keeper is not None, str(keeper.store.folder.parent) if keeper else None)
        yield from on_cores(job, todo, workers or cores())
