"""Many independent points on all cores or on a Dask cluster (its only door), each kept as soon as it is finished.

The numbers do not depend on who computes them: every point runs alone in one thread, and every result passes through
the same bytes whether it was just computed, came over the network or from the store.
"""

from __future__ import annotations

import contextlib
import functools
import os
import threading
from contextvars import ContextVar
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from fegear.errors import FegearError, InputError, MissingLibraryError
from fegear.plain import code_version, content_key, pack, unpack
from fegear.store import keeping_shapes, shape_keeper

if TYPE_CHECKING:
    from collections.abc import Callable, Generator, Iterator, Mapping, Sequence

    from fegear.scene.stage import Progress
    from fegear.store import Store

    Todo = Mapping[int, object]

#: Libraries of linear algebra that would start threads of their own.
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")
#: How long a scheduler may take to answer, and to have a worker [s].
_PATIENCE = 15.0

#: One point at a time in a process: gmsh keeps its model in global variables.
_alone = threading.Lock()
_inside = threading.local()


@dataclass(frozen=True, slots=True)
class Failure:
    """A point without a result, and why.

    Parameters
    ----------
    kind : str
        Name of the error's class.
    reason : str
        Its message.
    """

    kind: str
    reason: str


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


@dataclass(frozen=True)
class _Reply:
    """What comes back for a point: packed result or failure, whether it will always be so, and the shapes used."""

    payload: bytes
    lasting: bool = True
    shapes: tuple[int, int, float] = (0, 0, 0.0)


def _failed(error: Exception) -> bytes:
    return pack({"kind": type(error).__name__, "reason": str(error) or type(error).__name__})


@dataclass(frozen=True)
class _Job:
    """A function with what its process must know, sent along with each point."""

    function: Callable[[Any], object]
    keep_shapes: bool
    folder: str | None
    version: str = field(default_factory=code_version)

    def __call__(self, point: object) -> _Reply:
        if self.version != code_version():
            raise FegearError("the workers run another version of fegear or of its libraries than this program.")
        # A worker that somebody else started may have loaded its BLAS with many threads, and sums with other last bits.
        import scipy.linalg  # noqa: F401  (loaded before it is limited: scipy brings a BLAS of its own)
        from threadpoolctl import threadpool_limits

        with _alone, contextlib.ExitStack() as stack:
            stack.enter_context(threadpool_limits(limits=1))
            keeper = None
            if self.keep_shapes:
                keeper = stack.enter_context(keeping_shapes(Path(self.folder) if self.folder else None))
            _inside.worker = True
            try:
                payload, lasting = pack({"result": self.function(point)}), True
            except MissingLibraryError:
                raise  # every other point would fail alike
            except FegearError as error:
                payload, lasting = _failed(error), True
            except Exception as error:  # noqa: BLE001  (one point's bug must not take the others' results with it)
                payload, lasting = _failed(error), False
            finally:
                _inside.worker = False
        shapes = (keeper.solved, keeper.read, keeper.spared) if keeper else (0, 0, 0.0)
        return _Reply(payload, lasting, shapes)


def _opened(payload: bytes) -> object:
    found = cast("dict[str, Any]", unpack(payload))
    return found["result"] if "result" in found else Failure(found["kind"], found["reason"])


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
    return tuple(_opened(payloads[one]) for one in keys)


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
) -> Generator[tuple[int, _Reply]]:
    keeper = shape_keeper()
    if not todo:
        return
    if getattr(_inside, "worker", False):
        yield from ((i, _here(function, point)) for i, point in todo.items())
    elif scheduler is not None:
        # Folders of this machine mean nothing on others: workers of a cluster keep shapes where they keep theirs.
        yield from _on_cluster(_Job(function, keeper is not None, None), todo, scheduler)
    else:
        job = _Job(function, keeper is not None, str(keeper.store.folder.parent) if keeper else None)
        yield from _on_cores(job, todo, workers or _cores())


def _here(function: Callable[[Any], object], point: object) -> _Reply:
    """Inside a worker: its cores are busy already, and it holds the lock and the shapes' store."""
    try:
        return _Reply(pack({"result": function(point)}))
    except MissingLibraryError:
        raise
    except FegearError as error:
        return _Reply(_failed(error))


def _cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


# ---- processes of this machine -----------------------------------------------------------------------------------
@contextlib.contextmanager
def _one_thread_each() -> Iterator[None]:
    """Set the environment that new processes inherit before they load numpy."""
    before = {name: os.environ.get(name) for name in _THREADS}
    os.environ.update(dict.fromkeys(_THREADS, "1"))
    try:
        yield
    finally:
        for name, value in before.items():
            if value is None:
                os.environ.pop(name, None)
            else:
                os.environ[name] = value


def _settle() -> None:
    """Begin a worker's life: Ctrl-C is the parent's business, and no worker outlives a parent that was killed."""
    import signal
    from multiprocessing import connection, parent_process

    signal.signal(signal.SIGINT, signal.SIG_IGN)
    parent = parent_process()

    def follow() -> None:
        if parent is not None:
            connection.wait([parent.sentinel])
            os._exit(1)

    threading.Thread(target=follow, daemon=True).start()


def _on_cores(job: _Job, todo: Todo, workers: int) -> Generator[tuple[int, _Reply]]:
    from concurrent.futures.process import BrokenProcessPool

    left = dict(todo)
    while left:
        count = min(workers, len(left))
        try:
            for i, reply in _pool(job, left, count):
                del left[i]
                yield i, reply
        except BrokenProcessPool:
            # A process died (memory, a crash in a library). The point that killed it is among those handed out first;
            # alone in a process each shows whether it was the one.
            for i in list(left)[: 2 * count + 1]:
                try:
                    ((_, reply),) = _pool(job, {i: left[i]}, 1)
                except BrokenProcessPool:
                    died = FegearError("the process died while it computed this point (out of memory?)")
                    reply = _Reply(_failed(died), lasting=False)
                del left[i]
                yield i, reply


def _pool(job: _Job, todo: Todo, workers: int) -> Generator[tuple[int, _Reply]]:
    from concurrent.futures import ProcessPoolExecutor, as_completed
    from multiprocessing import get_context

    with _one_thread_each():
        # Spawned, not forked: a fork would share gmsh's, numba's and OpenBLAS's state with its parent.
        pool = ProcessPoolExecutor(workers, mp_context=get_context("spawn"), initializer=_settle)
        try:
            futures = {pool.submit(job, point): i for i, point in todo.items()}
            for future in as_completed(futures):
                yield futures[future], future.result()
        finally:
            pool.shutdown(wait=True, cancel_futures=True)


# ---- a cluster ---------------------------------------------------------------------------------------------------
def _on_cluster(job: _Job, todo: Todo, address: str) -> Generator[tuple[int, _Reply]]:
    try:
        from dask.distributed import Client, KilledWorker, as_completed
    except ImportError:
        raise MissingLibraryError(
            "--scheduler needs Dask; install it with: pip install 'fegear[distributed]'"
        ) from None
    try:
        client = Client(address, timeout=_PATIENCE, set_as_default=False)
    except (OSError, ValueError) as problem:
        reason = str(problem).splitlines()[0] if str(problem) else type(problem).__name__
        raise InputError(
            "--scheduler",
            address,
            f"does not answer ({reason})",
            "start one with `dask scheduler` and give its address",
        ) from None
    with client, client.as_current():
        try:
            client.wait_for_workers(1, timeout=_PATIENCE)
        except OSError:
            raise InputError(
                "--scheduler", address, "has no workers", f"start some with `dask worker {address} --nthreads 1`"
            ) from None
        futures = {client.submit(job, point, pure=False): i for i, point in todo.items()}
        for future in as_completed(list(futures)):
            try:
                reply = future.result()
            except KilledWorker as error:
                reply = _Reply(_failed(error), lasting=False)
            except ImportError as problem:
                raise MissingLibraryError(f"the workers of {address} cannot import fegear ({problem})") from None
            yield futures.pop(future), reply
