"""Points on the cores of this machine: one process of one thread for each.

One point's work as every executor does it: alone in one thread, its result or its failure as bytes.
"""

from __future__ import annotations

import contextlib
import functools
import gc
import importlib
import os
import shutil
import sys
import threading
import time
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from types import ModuleType
from typing import TYPE_CHECKING, Any, cast

from fegear.base.code_version import code_version, made_by, unlike
from fegear.base.errors import FegearError, MissingLibraryError
from fegear.base.interrupts import deaf
from fegear.base.memory import give_back, resident
from fegear.base.one_thread import one_thread
from fegear.base.plain import pack, unpack
from fegear.base.solution_cache import SolutionCache, cache_on_disk

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator, Mapping
    from multiprocessing.connection import Connection
    from multiprocessing.process import BaseProcess

    Todo = Mapping[int, object]


#: One point at a time in a process: gmsh keeps its model in global variables.
_alone = threading.Lock()
#: What a worker process has solved so far, by the folder where it keeps it; a worker lives for many points.
_caches: dict[str, SolutionCache] = {}
#: By how much a process may grow before it is tidied, and what solutions not used since the last time may take [bytes].
_GROWN, _KEPT = 256 << 20, 512 << 20
#: What a process had left when it was tidied last [bytes].
_left = {"memory": 0}


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


@dataclass(frozen=True)
class Reply:
    """What comes back for a point: packed result or failure, whether it will always be so, and the shapes used.

    The shapes count as in `fegear.base.solution_cache.Account`.
    """

    payload: bytes
    lasting: bool = True
    shapes: tuple[int, int, int, float] = (0, 0, 0, 0.0)


def failed(error: Exception) -> bytes:
    """Pack a failure for its way back."""
    return pack({"kind": type(error).__name__, "reason": str(error) or type(error).__name__})


@dataclass(frozen=True)
class Job:
    """A function with what its process must know, sent along with each point.

    Parameters
    ----------
    function : callable
    shares_cache : bool
        Whether it takes the process's cache besides the point.
    on_disk : bool
        Whether tooth shapes are kept beyond the process.
    folder : str or None
        Where; None for the worker's own cache folder.
    made_by : dict of str to str
        The code and the libraries that a worker must have.
    version : str
        What workers of 0.2.0 compare, which may join when the others have begun.
    """

    function: Callable[..., object]
    shares_cache: bool
    on_disk: bool
    folder: str | None
    made_by: dict[str, str] = field(default_factory=lambda: dict(made_by()))
    version: str = field(default_factory=code_version)

    def __call__(self, point: object) -> Reply:
        """Compute one point in this process.

        Raises
        ------
        FegearError
            If this process has other code or other libraries than the one that wants the result.
        """
        differ = unlike(self.made_by, made_by())
        if differ:
            raise FegearError(
                f"A worker has {differ[1]} where this program has {differ[0]}; restart it with the same code and "
                "libraries."
            )
        # A worker that somebody else started may have loaded its BLAS with many threads, and sums with other last bits.
        with _alone, one_thread():
            cache = self._cache()
            before = cache.shapes.state
            reply = here(self.function, point, cache if self.shares_cache else None)
            tidy(cache)
            return replace(reply, shapes=cache.shapes.since(before).state)

    def _cache(self) -> SolutionCache:
        name = f"{self.folder or ''}" if self.on_disk else "memory"
        if name not in _caches:
            _caches[name] = (
                cache_on_disk(Path(self.folder) if self.folder else None) if self.on_disk else SolutionCache()
            )
        return _caches[name]


def tidy(cache: SolutionCache | None = None) -> None:
    """Bound the memory of a process that computes point after point: solutions that are free, in pieces, would add up.

    Parameters
    ----------
    cache : SolutionCache, optional
        Solutions in it that were not used since the last time go, too, those unused for longest first.
    """
    now = resident()
    if now is None or now < _left["memory"] + _GROWN:
        return
    if cache is not None:
        cache.shrink(_KEPT)
    give_back()
    _left["memory"] = resident() or now


def opened(payload: bytes) -> object:
    """Unpack a result or a `Failure`."""
    found = cast("dict[str, Any]", unpack(payload))
    return found["result"] if "result" in found else Failure(found["kind"], found["reason"])


def _passing(error: BaseException | None) -> bool:
    """Whether a failure lies in the circumstances (disk, memory, a foreign library) and may be none the next time."""
    while error is not None:
        if isinstance(error, (OSError, MemoryError)) or type(error) in (Exception, RuntimeError):
            return True
        error = error.__cause__ or error.__context__
    return False


def here(function: Callable[..., object], point: object, cache: SolutionCache | None) -> Reply:
    """Compute one point in this process; a failure is a reply like any other."""
    try:
        return Reply(pack({"result": function(point) if cache is None else function(point, cache)}))
    except MissingLibraryError:
        raise  # every other point would fail alike
    except FegearError as error:
        return Reply(failed(error), lasting=not _passing(error))
    except Exception as error:  # noqa: BLE001  (one point's bug must not take the others' results with it)
        return Reply(failed(error), lasting=False)


#: Who is spoken to no longer waits so long for the end of the parent, in whose place it clears away [s].
_FAREWELL = 2.0
#: Libraries of linear algebra that would start threads of their own.
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS")


def cores() -> int:
    """Cores that this process may use."""
    return len(os.sched_getaffinity(0)) if hasattr(os, "sched_getaffinity") else os.cpu_count() or 1


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


@contextlib.contextmanager
def _deaf_to_ctrl_c() -> Iterator[None]:
    """Start processes that Ctrl-C does not reach: it would find them loading, and each would end in a traceback.

    A blocked signal stays blocked in the new process; in this one it is delivered at the end of the block.
    """
    import signal
    from multiprocessing import resource_tracker

    if not hasattr(signal, "pthread_sigmask"):
        yield
        return
    resource_tracker.ensure_running()  # which lets Ctrl-C through again when it starts its own process
    with deaf([signal.SIGINT]):
        yield


@contextlib.contextmanager
def loading() -> Iterator[None]:
    """Load code without a search for cyclic garbage on the way, which takes a fifth of the time and finds nothing.

    What is loaded stays; later searches leave it out, too.
    """
    before = gc.isenabled()
    gc.disable()
    try:
        yield
    finally:
        gc.freeze()
        if before:
            gc.enable()


def settle(scratch: str = "") -> threading.Thread:
    """Begin a worker's life: what ends the parent is the parent's business, and no worker outlives one that was killed.

    Parameters
    ----------
    scratch : str
        Folder that the parent would have removed.

    Returns
    -------
    Thread
        What waits for the end of the parent, and then ends this process.
    """
    import signal
    from multiprocessing import connection, parent_process

    for name in ("SIGINT", "SIGHUP"):
        if hasattr(signal, name):
            signal.signal(getattr(signal, name), signal.SIG_IGN)
    parent = parent_process()

    def follow() -> None:
        if parent is not None:
            connection.wait([parent.sentinel])
            if scratch:
                _remove_after_the_end(scratch)
            os._exit(1)

    following = threading.Thread(target=follow, daemon=True)
    following.start()
    return following


def _remove_after_the_end(scratch: str) -> None:
    """Remove a folder as soon as this process has ended, which may be writing into it until then."""
    own = os.getpid()
    if not hasattr(os, "fork") or os.fork() == 0:  # what is forked is this thread alone
        while hasattr(os, "fork") and os.getppid() == own:
            time.sleep(0.005)
        shutil.rmtree(scratch, ignore_errors=True)


def on_cores(job: Job, todo: Todo, workers: int) -> Generator[tuple[int, Reply]]:
    """Compute points in processes; yields the point's number with its reply. A point that kills its process fails."""
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
                    died = FegearError("the process terminated while computing this point (out of memory?)")
                    reply = Reply(failed(died), lasting=False)
                del left[i]
                yield i, reply


def _from_main(job: Job) -> bool:
    """Whether the function stands in the user's own script."""
    function: object = job.function
    while isinstance(function, functools.partial):
        function = function.func
    return getattr(function, "__module__", "") == "__main__"


@contextlib.contextmanager
def _without_main() -> Iterator[None]:
    """Start processes that do not run the user's script again, which has no guard against that and needs none.

    A spawned process imports the file of ``__main__`` for what may be defined there; jobs and points are fegear's.
    """
    main = sys.modules["__main__"]
    sys.modules["__main__"] = ModuleType("__main__")
    try:
        yield
    finally:
        sys.modules["__main__"] = main


def start_process(module: str, connection: Connection, scratch: str) -> BaseProcess:
    """Start one process of one thread that Ctrl-C does not reach and that ends with its parent, however that ends.

    Parameters
    ----------
    module : str
        Its ``serve`` receives the other two.
    connection : Connection
    scratch : str
        Folder that is removed if the parent is killed.
    """
    from multiprocessing import get_context

    process = get_context("spawn").Process(target=_begin, args=(module, connection, scratch))
    with _one_thread_each(), _deaf_to_ctrl_c(), _without_main():
        process.start()
    return process


def _begin(module: str, connection: Connection, scratch: str) -> None:
    following = settle(scratch)  # before anything is loaded, which takes a second
    with loading():
        found = importlib.import_module(module)
    found.serve(connection, scratch)
    following.join(_FAREWELL)


def end_tracker(patience: float = 2.0) -> None:
    """End the process that multiprocessing starts beside the first; it would outlive this one for a moment.

    For a program that starts no more. Python has no public way to it; without this one it ends a little later.
    """
    from multiprocessing import resource_tracker

    stop = getattr(getattr(resource_tracker, "_resource_tracker", None), "_stop", None)
    if stop is not None:
        ending = threading.Thread(target=stop, daemon=True)  # waits for whoever else still holds it
        ending.start()
        ending.join(patience)


def _pool(job: Job, todo: Todo, workers: int) -> Generator[tuple[int, Reply]]:
    from concurrent.futures import ProcessPoolExecutor, as_completed
    from multiprocessing import active_children, get_context

    with _one_thread_each():
        # Spawned, not forked: a fork would share gmsh's, numba's and OpenBLAS's state with its parent.
        others = {child.pid for child in active_children()}
        pool = ProcessPoolExecutor(workers, mp_context=get_context("spawn"), initializer=settle)
        try:
            with _deaf_to_ctrl_c(), contextlib.nullcontext() if _from_main(job) else _without_main():
                futures = {pool.submit(job, point): i for i, point in todo.items()}
            for future in as_completed(futures):
                yield futures[future], future.result()
        except BaseException:
            # An interrupt, or whoever asks for the replies has failed: no one waits for what is under way.
            for child in active_children():
                if child.pid not in others:
                    child.terminate()
            raise
        finally:
            pool.shutdown(wait=True, cancel_futures=True)
