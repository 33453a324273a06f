"""Results kept on disk by their content: whole or absent, checked on reading, bounded in size."""

from __future__ import annotations

import contextlib
import hashlib
import math
import os
import tempfile
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

#: First bytes of an entry; the SHA-256 of its key and of the rest follows.
_MAGIC = b"fegear3\n"
_HEAD = len(_MAGIC) + 32
_SUFFIX = ".entry"
#: After pruning, this share of the limit is left, so that not every write prunes.
_KEEP = 0.9
#: Share of the limit that is written, on the average, between two looks at all entries, by whatever processes.
_BETWEEN_LOOKS = 1 / 64
#: What an entry takes of a disk at least [bytes].
_BLOCK = 4096
#: Temporary files older than this were left behind by a killed process [s].
_ABANDONED = 3600.0
_GIB = 1 << 30
#: Folder of points, their share of the limit, and by how much clocks of machine and disk may differ [s].
_POINTS, _POINTS_SHARE, _CLOCKS = "points", 0.25, 60.0


def cache_folder() -> Path:
    """Where fegear keeps results between runs: ``FEGEAR_CACHE``, else the user's cache folder of the system."""
    given = os.environ.get("FEGEAR_CACHE")
    if given:
        return Path(given)
    import platformdirs

    return Path(platformdirs.user_cache_dir("fegear", appauthor=False))


def _head(key: str, payload: bytes) -> bytes:
    """What an entry begins with: it binds what is kept to its key, wherever the file is moved."""
    digest = hashlib.sha256(key.encode() + b"\n")
    digest.update(payload)  # which may be large: not copied
    return _MAGIC + digest.digest()


def _within(folder: Path) -> Iterator[os.DirEntry[str]]:
    """Files in the folders of a folder; none of one that is not there."""
    with contextlib.suppress(OSError), os.scandir(folder) as parts:
        for part in parts:
            with contextlib.suppress(OSError), os.scandir(part) as files:
                yield from files


@dataclass(frozen=True, slots=True)
class Store:
    """A folder of entries by key.

    Parameters
    ----------
    folder : Path
        Made when the first entry is written.
    limit : int
        Bytes that all entries together may take, and now and then some hundredths more; the ones unused for longest go
        first.
    since : float
        What was used after it stays, whatever the limit [s since 1970].
    """

    folder: Path
    limit: int = _GIB
    since: float = math.inf

    def of_points(self) -> Store:
        """A store of its own within the folder, of what one stretch of work finds point by point.

        Nothing that this stretch keeps or takes from it is dropped; large entries beside it drop none.
        """
        return Store(self.folder / _POINTS, int(_POINTS_SHARE * self.limit), time.time() - _CLOCKS)

    def _place(self, key: str) -> Path:
        return self.folder / key[:2] / f"{key}{_SUFFIX}"

    def __contains__(self, key: str) -> bool:
        """Whether there is an entry, sound or not."""
        return self._place(key).is_file()

    def read(self, key: str) -> bytes | None:
        """Return an entry; None if there is none, it is damaged, or it was made for another key."""
        place = self._place(key)
        try:
            with place.open("rb") as file:
                head, payload = file.read(_HEAD), file.read()
        except OSError:
            return None
        if head != _head(key, payload):
            return None
        with contextlib.suppress(OSError):  # records when it was last of use; a folder may be read-only
            os.utime(place)
        return payload

    def write(self, key: str, payload: bytes) -> None:
        """Keep an entry: it appears whole or not at all, even if the process is killed meanwhile.

        Raises
        ------
        OSError
            If the folder cannot be written to.
        """
        place = self._place(key)
        place.parent.mkdir(parents=True, exist_ok=True)
        handle, name = tempfile.mkstemp(prefix=".", dir=place.parent)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(_head(key, payload) + payload)
            Path(name).replace(place)
        except BaseException:
            with contextlib.suppress(OSError):
                Path(name).unlink()
            raise
        if self._look_due(key, len(payload)):
            self._prune()

    def _look_due(self, key: str, size: int) -> bool:
        """Whether to look at all entries now, which takes as long as there are many.

        Keys are as good as random, so that it falls on all processes alike, however few entries each of them writes.
        """
        drawn = int.from_bytes(hashlib.sha256(key.encode()).digest()[:8]) / 2**64
        return drawn < max(size, _BLOCK) / (_BETWEEN_LOOKS * self.limit)

    def _prune(self) -> None:
        now, entries, total = time.time(), [], 0
        for found in _within(self.folder):
            with contextlib.suppress(OSError):  # another process may prune as well
                stat = found.stat()
                if found.name.endswith(_SUFFIX):
                    total += stat.st_size
                    if stat.st_mtime >= self.since:
                        continue
                    entries.append((stat.st_mtime, stat.st_size, found.path))
                elif found.name.startswith(".") and now - stat.st_mtime > _ABANDONED:
                    Path(found.path).unlink()
        if total <= self.limit:
            return
        for _, size, path in sorted(entries):
            with contextlib.suppress(OSError):
                Path(path).unlink()
            total -= size
            if total <= _KEEP * self.limit:
                return

    @contextlib.contextmanager
    def claim(self, key: str) -> Iterator[None]:
        """Hold a key, so that of several processes that want the same entry one makes it and the others wait.

        The system releases it when a process dies. Where it cannot be held (a file system without locks, Windows),
        nothing is: then two processes may make the same entry, which is whole all the same.
        """
        try:
            import fcntl

            place = self.folder / "claims" / key[:2]
            place.parent.mkdir(parents=True, exist_ok=True)
            file = place.open("ab")
        except (ImportError, OSError):
            yield
            return
        with file:
            with contextlib.suppress(OSError):
                fcntl.flock(file, fcntl.LOCK_EX)
            yield
