"""Points on a Dask cluster: its only door."""

from __future__ import annotations

import contextlib
import logging
import threading
import time
from importlib import import_module
from importlib.util import find_spec
from typing import TYPE_CHECKING

from fegear.base.code_version import made_by, unlike
from fegear.base.errors import InputError, MissingLibraryError
from fegear.engine.processes import Job, Reply, failed

if TYPE_CHECKING:
    from collections.abc import Generator, Iterator, Mapping

    from dask.distributed import Client, Future

    Todo = Mapping[int, object]

#: How long a scheduler may take to answer, and to have a worker [s].
_PATIENCE = 15.0
#: What is added to it, so that Dask's own words come first [s].
_GRACE = 3.0
#: How long a cluster may be without any worker while there is work: nannies and queues start new ones [s].
_WITHOUT_WORKERS = 60.0
#: Between two looks at what is finished [s].
_PAUSE = 0.02


def on_cluster(job: Job, todo: Todo, address: str) -> Generator[tuple[int, Reply]]:
    """Compute points on the workers of a running scheduler; yields the point's number with its reply.

    Raises
    ------
    InputError
        If the scheduler does not answer, has no workers, or loses all of them.
    MissingLibraryError
        If Dask is missing here, or fegear there.
    """
    try:
        import dask.distributed  # noqa: F401  (only whether it is there)
    except ImportError:
        raise MissingLibraryError(
            "--scheduler requires Dask; install it with: pip install 'fegear[distributed]'"
        ) from None
    with _quiet("distributed"):
        yield from _computed(job, todo, address)


def _computed(job: Job, todo: Todo, address: str) -> Generator[tuple[int, Reply]]:
    from dask.distributed import CancelledError, KilledWorker

    client = _connected(address)
    with client, client.as_current():
        _check_workers(client, address)
        futures = {client.submit(job, point, pure=False): i for i, point in todo.items()}
        for future in _finished(client, list(futures), address):
            try:
                reply = future.result()
            except KilledWorker as error:
                reply = Reply(failed(error), lasting=False)
            except CancelledError:
                raise _gone(address) from None
            except ImportError as problem:
                raise MissingLibraryError(f"the workers of {address} cannot import fegear ({problem})") from None
            yield futures.pop(future), reply


def _refused(address: str, rule: str, remedy: str) -> InputError:
    return InputError("--scheduler", f'"{address}"', rule, remedy)


def _gone(address: str) -> InputError:
    return _refused(address, "is no longer available", "start it again; finished points are kept")


def _connected(address: str) -> Client:
    """Connect to a scheduler, or say why that fails."""
    from dask.distributed import Client

    remedy = "start one with `dask scheduler` and specify its address, for example tcp://10.0.0.5:8786"
    client = Client.__new__(Client)
    problems = ["connection accepted but no reply"]

    def connect() -> None:
        try:
            client.__init__(address, timeout=_PATIENCE, set_as_default=False)
            problems.clear()
        except Exception as problem:  # noqa: BLE001  (every transport has errors of its own)
            problems[:] = [(str(problem).splitlines() or [""])[0].rstrip(".") or type(problem).__name__]

    # Dask's own patience ends where a listener takes the connection.
    connecting = threading.Thread(target=connect, daemon=True)
    connecting.start()
    connecting.join(_PATIENCE + _GRACE)
    if problems:
        client.status = "closed"  # else it tries to close what was never open, and fails, when the program ends
        raise _refused(address, f"does not answer ({problems[0]})", remedy)
    return client


@contextlib.contextmanager
def _quiet(library: str) -> Iterator[None]:
    """Keep a library from logging tracebacks of what is said here in a sentence."""
    names = [name for name in logging.root.manager.loggerDict if name.partition(".")[0] == library]
    before = {name: logging.getLogger(name).level for name in names}
    for name in names:
        logging.getLogger(name).setLevel(logging.CRITICAL + 1)
    try:
        yield
    finally:
        for name, level in before.items():
            logging.getLogger(name).setLevel(level)


def _check_workers(client: Client, address: str) -> None:
    """Refuse a cluster without workers, or one that has no fegear: a worker that cannot read a point just dies.

    One of other code or other libraries is refused, too: what it computes would be kept as if this program had.
    """
    from distributed.comm import CommClosedError

    try:
        client.wait_for_workers(1, timeout=_PATIENCE)
        found = {"scheduler": client.run_on_scheduler(find_spec, "fegear"), **client.run(find_spec, "fegear")}
        without = [name for name, spec in found.items() if spec is None]
        if without:
            raise MissingLibraryError(
                f"--scheduler {address}: fegear is not installed on {', '.join(without)}; scheduler and workers "
                "need the same environment as this program."
            )
        # One that is too old to say what it is answers with an error.
        told = client.run(lambda: dict(import_module("fegear.base.code_version").made_by()), on_error="return")
    except CommClosedError:
        raise _gone(address) from None
    except TimeoutError:
        raise _refused(address, "has no workers", f"start some with `dask worker {address} --nthreads 1`") from None
    ours = made_by()
    for name, there in told.items():
        older = {**ours, "fegear": "of an older release"}
        differ = unlike(ours, there if isinstance(there, dict) else older)
        if differ:
            raise _refused(
                address, f"worker {name} has {differ[1]} where this program has {differ[0]}",
                "start its workers with the same code and libraries",
            )  # fmt: skip


def _finished(client: Client, futures: list[Future], address: str) -> Iterator[Future]:
    """Futures as they are finished; refuses to wait for workers that are all gone."""
    from dask.distributed import as_completed

    coming = as_completed(futures)
    seen = time.monotonic()  # when there was work or somebody to do it
    while coming.count():
        batch = coming.next_batch(block=False)
        yield from batch
        now = time.monotonic()
        if batch or client.scheduler_info()["workers"]:
            seen = now
        elif now - seen > _WITHOUT_WORKERS:
            raise _refused(address, "has lost all its workers", "restart them; finished points are kept")
        if not batch:
            time.sleep(_PAUSE)
