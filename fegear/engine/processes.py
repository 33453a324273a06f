"""Points on the cores of this machine: one process of one thread for each."""

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
from types import ModuleType
from typing import TYPE_CHECKING

from fegear.base.errors import FegearError
from fegear.engine.point_job import Job, Reply, failed

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator, Mapping
    from multiprocessing.connection import Connection
    from multiprocessing.process import BaseProcess

    Todo = Mapping[int, object]

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
    before = signal.pthread_sigmask(signal.SIG_BLOCK, {signal.SIGINT})
    try:
        yield
    finally:
        signal.pthread_sigmask(signal.SIG_SETMASK, before)


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
                    died = FegearError("the process died while it computed this point (out of memory?)")
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
