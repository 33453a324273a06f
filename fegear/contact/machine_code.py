"""Functions as machine code, kept on disk by numba for the next process: a place that may fail in any way."""

from __future__ import annotations

import hashlib
import logging
import pickle
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numba
from numba.core.caching import IndexDataCacheFile

_DIGEST = 32


class _CheckedFiles(IndexDataCacheFile):  # type: ignore[misc]  # numba has no types
    """Numba's files with a digest in front, and with what they were made for.

    Numba itself takes every file for what it should be: a flipped bit is another program, and of two processes that
    save at once the one may find the other's code under its own signature.
    """

    def save(self, key: object, data: object) -> None:
        super().save(key, (repr(key), data))

    def load(self, key: object) -> object:
        found = super().load(key)
        return found[1] if found is not None and found[0] == repr(key) else None

    def _dump(self, obj: object) -> bytes:
        data: bytes = super()._dump(obj)
        return hashlib.sha256(data).digest() + data

    def _load_data(self, name: str) -> Any:
        return self._checked(Path(self._data_path(name)).read_bytes())

    def _load_index(self) -> dict[Any, str]:
        try:
            data = Path(self._index_path).read_bytes()
        except OSError:
            return {}
        head = pickle.dumps(self._version, protocol=-1)
        found = self._checked(data[len(head) :]) if data.startswith(head) else None
        return found[1] if found is not None and found[0] == self._source_stamp else {}

    @staticmethod
    def _checked(data: bytes) -> Any:
        """Read what has its digest in front; None where that does not fit."""
        digest, rest = data[:_DIGEST], data[_DIGEST:]
        return pickle.loads(rest) if hashlib.sha256(rest).digest() == digest else None  # noqa: S301  (ours: see above)


class _Forgiving:
    """A cache of numba's that costs time where it fails, and nothing else; it says so where that time is long."""

    def __init__(self, cache: Any, long: str) -> None:
        self._cache = cache
        self._long = long

    def __getattr__(self, name: str) -> Any:
        return getattr(self._cache, name)

    def load_overload(self, *what: object) -> object:
        """Return what was kept; None for whatever cannot be read."""
        try:
            found = self._cache.load_overload(*what)
        except Exception:  # noqa: BLE001  (anything may stand in a file)
            found = None
        if found is None and self._long:
            logging.getLogger(__name__).warning("%s", self._long)
        return found

    def save_overload(self, *what: object) -> None:
        """Keep it, if that can be done."""
        try:
            self._cache.save_overload(*what)
        except Exception:  # noqa: BLE001  (a full disk, a folder that has vanished, no rights)
            return


def machine_code(function: Callable[..., Any], made_from: str = "", long: str = "") -> Callable[..., Any]:
    """Compile a function at its first call, or take the machine code of an earlier process.

    Parameters
    ----------
    function : callable
        Plain Python on arrays, as numba takes it.
    made_from : str
        Digest of what else its machine code is made from: numba looks at the age of the function's own file alone.
    long : str
        Warning that is logged before it is compiled, where that takes long.

    Returns
    -------
    callable
        The same numbers whatever the disk holds: code is read only where its digest, its signature and the source that
        it was made from fit; without a folder to keep it in, each process compiles for itself.
    """
    try:
        made = numba.njit(cache=True, no_cfunc_wrapper=True)(function)  # nobody calls it from C
    except RuntimeError:  # neither the package's folder nor the user's can be written to
        return numba.njit(no_cfunc_wrapper=True)(function)
    kept = made._cache  # noqa: SLF001  (numba has no open door to it)
    files = kept._cache_file  # noqa: SLF001  (as above)
    kept._cache_file = _CheckedFiles(kept.cache_path, kept._impl.filename_base, (files._source_stamp, made_from))  # noqa: SLF001  (as above)
    made._cache = _Forgiving(kept, long)  # noqa: SLF001  (as above)
    return made
