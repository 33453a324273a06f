"""One point's work as every executor does it: alone in one thread, its result or its failure as bytes."""

from __future__ import annotations

import threading
from collections.abc import Callable
from dataclasses import dataclass, field, replace
from pathlib import Path
from typing import Any, cast

from fegear.base.errors import FegearError, MissingLibraryError
from fegear.base.one_thread import one_thread
from fegear.base.plain import code_version, pack, unpack
from fegear.base.solution_cache import SolutionCache, cache_on_disk

#: One point at a time in a process: gmsh keeps its model in global variables.
_alone = threading.Lock()
#: What a worker process has solved so far, by the folder where it keeps it; a worker lives for many points.
_caches: dict[str, SolutionCache] = {}


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
    """

    function: Callable[..., object]
    shares_cache: bool
    on_disk: bool
    folder: str | None
    version: str = field(default_factory=code_version)

    def __call__(self, point: object) -> Reply:
        """Compute one point in this process."""
        if self.version != code_version():
            raise FegearError("the workers run another version of fegear or of its libraries than this program.")
        # A worker that somebody else started may have loaded its BLAS with many threads, and sums with other last bits.
        with _alone, one_thread():
            cache = self._cache()
            before = cache.shapes.state
            reply = here(self.function, point, cache if self.shares_cache else None)
            return replace(reply, shapes=cache.shapes.since(before).state)

    def _cache(self) -> SolutionCache:
        name = f"{self.folder or ''}" if self.on_disk else "memory"
        if name not in _caches:
            _caches[name] = (
                cache_on_disk(Path(self.folder) if self.folder else None) if self.on_disk else SolutionCache()
            )
        return _caches[name]


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
