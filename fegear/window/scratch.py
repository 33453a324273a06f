"""The folder that a computing process keeps solved teeth in, and what servers that were killed have left of theirs."""

from __future__ import annotations

import contextlib
import os
import shutil
import tempfile
from pathlib import Path
from typing import IO

_PREFIX = "fegear-open-"
#: Held by the server as long as it lives; the system lets go of it when the server dies, however that is.
_HELD = "held"


class Scratch:
    """A folder of this process alone, removed at the end.

    Attributes
    ----------
    folder : Path
    """

    def __init__(self) -> None:
        sweep()
        self.folder = Path(tempfile.mkdtemp(prefix=_PREFIX))
        self._held = _hold(self.folder)

    def remove(self) -> None:
        """Remove it with all that is in it."""
        if self._held is not None:
            self._held.close()
        shutil.rmtree(self.folder, ignore_errors=True)


def _hold(folder: Path) -> IO[bytes] | None:
    try:
        import fcntl
    except ImportError:  # Windows: what a killed server leaves there stays until the system cleans up
        return None
    made = (folder / f".{_HELD}").open("wb")
    with contextlib.suppress(OSError):  # a file system without locks
        fcntl.flock(made, fcntl.LOCK_EX | fcntl.LOCK_NB)
        (folder / f".{_HELD}").rename(folder / _HELD)  # found by others only after it is held
    return made


def sweep() -> list[Path]:
    """Remove folders of this user's servers that are dead.

    Returns
    -------
    list of Path
        What was removed; what nobody is known to have held is left alone.
    """
    try:
        import fcntl
    except ImportError:
        return []
    gone = []
    for folder in sorted(Path(tempfile.gettempdir()).glob(f"{_PREFIX}*")):
        with contextlib.suppress(OSError):  # somebody else's, gone meanwhile, or held: then it is in use
            if folder.is_symlink() or folder.stat().st_uid != os.getuid():
                continue
            with (folder / _HELD).open("rb") as held:
                fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
                shutil.rmtree(folder)
            gone.append(folder)
    return gone
