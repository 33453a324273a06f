"""One point's work as every executor does it: alone in one thread, its result or its failure as bytes."""

from __future__ import annotations

import contextlib
import threading
from dataclasses import dataclass, field
from pathlib import Path
from typing import TYPE_CHECKING, Any, cast

from fegear.errors import FegearError, MissingLibraryError
from fegear.plain import code_version, pack, unpack
from fegear.store import keeping_shapes

if TYPE_CHECKING:
    from collections.abc import Callable

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


@dataclass(frozen=True)
class Reply:
    """What comes back for a point: packed result or failure, whether it will always be so, and the shapes used."""

    payload: bytes
    lasting: bool = True
    shapes: tuple[int, int, float] = (0, 0, 0.0)


def failed(error: Exception) -> bytes:
    """Pack a failure for its way back."""
    return pack({"kind": type(error).__name__, "reason": str(error) or type(error).__name__})


@dataclass(frozen=True)
class Job:
    """A function with what its process must know, sent along with each point."""

    function: Callable[[Any], object]
    keep_shapes: bool
    folder: str | None
    version: str = field(default_factory=code_version)

    def __call__(self, point: object) -> Reply:
        """Compute one point in this process."""
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
                payload, lasting = failed(error), True
            except Exception as error:  # noqa: BLE001  (one point's bug must not take the others' results with it)
                payload, lasting = failed(error), False
            finally:
                _inside.worker = False
        shapes = (keeper.solved, keeper.read, keeper.spared) if keeper else (0, 0, 0.0)
        return Reply(payload, lasting, shapes)


def opened(payload: bytes) -> object:
    """Unpack a result or a `Failure`."""
    found = cast("dict[str, Any]", unpack(payload))
    return found["result"] if "result" in found else Failure(found["kind"], found["reason"])


def inside_a_worker() -> bool:
    """Whether this code runs for one point of a `Job` already."""
    return getattr(_inside, "worker", False)


def here(function: Callable[[Any], object], point: object) -> Reply:
    """Inside a worker: its cores are busy already, and it holds the lock and the shapes' store."""
    try:
        return Reply(pack({"result": function(point)}))
    except MissingLibraryError:
        raise
    except FegearError as error:
        return Reply(failed(error))
