"""Points on a Dask cluster: its only door."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.engine.point_job import Reply, failed
from fegear.errors import InputError, MissingLibraryError

if TYPE_CHECKING:
    from collections.abc import Generator, Mapping

    from fegear.engine.point_job import Job

    Todo = Mapping[int, object]

#: How long a scheduler may take to answer, and to have a worker [s].
_PATIENCE = 15.0


def on_cluster(job: Job, todo: Todo, address: str) -> Generator[tuple[int, Reply]]:
    """Compute points on the workers of a running scheduler; yields the point's number with its reply.

    Raises
    ------
    InputError
        If the scheduler does not answer or has no workers.
    MissingLibraryError
        If Dask is missing here, or fegear there.
    """
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
                reply = Reply(failed(error), lasting=False)
            except ImportError as problem:
                raise MissingLibraryError(f"the workers of {address} cannot import fegear ({problem})") from None
            yield futures.pop(future), reply
