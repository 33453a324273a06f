"""What has been changed and not saved, kept beyond a crash: a small file for each window and case in the user's folder.

Every window has its own, which it holds locked as long as it lives: what a living window keeps nobody else takes up,
and nobody else forgets it.

The folder that a computing process keeps solved teeth in, and what servers that were killed have left of theirs.
"""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import re
import secrets
import shutil
import tempfile
import time
from pathlib import Path
from typing import IO, TYPE_CHECKING, NamedTuple

if TYPE_CHECKING:
    from typing import TextIO


#: Half a character, which JSON can say and no file takes, and what stands for it on its way from a page.
HALF, HALVES = "\uffff", re.compile("[\ud800-\udfff\uffff]")


class Kept(NamedTuple):
    """A kept state.

    Attributes
    ----------
    text : str
        The case as it was left.
    origin : str
        The case's folder, where relative file names start; that of a template or a case of the gallery is not its own.
    name : str
        Its name.
    when : str
        Local time.
    base : str
        Digest of what its file had when the changes began; empty where there was none.
    """

    text: str
    origin: str
    name: str
    when: str
    base: str = ""


class Left(NamedTuple):
    """A state that a window left behind which is no more, and its file."""

    place: Path
    kept: Kept


def journal_folder() -> Path:
    """Where the journals are: ``FEGEAR_STATE``, else the user's folder for such things of the system."""
    given = os.environ.get("FEGEAR_STATE")
    if given:
        return Path(given)
    import platformdirs

    return Path(platformdirs.user_state_dir("fegear", appauthor=False)) / "unsaved"


def stem_of(path: Path | None) -> str:
    """How the journals of a case file begin, or those of cases without a file."""
    if path is None:
        return "unnamed"
    return hashlib.sha256(os.path.realpath(path).encode("utf-8", "surrogatepass")).hexdigest()[:16]


class Journal:
    """What one window keeps of one case.

    Parameters
    ----------
    path : Path, optional
        The case's file; None for a case without one.
    """

    def __init__(self, path: Path | None) -> None:
        self._path = path
        self._place: Path | None = None
        self._held: TextIO | None = None

    def keep(self, state: Kept) -> None:
        """Keep a state; the one before is replaced as a whole.

        Raises
        ------
        OSError
            If the folder cannot be written to.
        """
        folder = journal_folder()
        folder.mkdir(parents=True, exist_ok=True)
        place = self._place or folder / f"{stem_of(self._path)}-{secrets.token_hex(4)}.json"
        handle, scratch = tempfile.mkstemp(prefix=".", dir=folder)  # readable by its owner alone
        file = os.fdopen(handle, "w", encoding="utf-8")
        try:
            json.dump(state._asdict(), file)
            file.flush()
            _lock(file)  # before it stands where others look
            Path(scratch).replace(place)
        except BaseException:
            with contextlib.suppress(OSError):
                file.close()  # writes what is left in memory, which fails again where the disk is full
            with contextlib.suppress(OSError):
                Path(scratch).unlink()
            raise
        self.leave()
        self._place, self._held = place, file

    def take(self, left: Left) -> bool:
        """Hold what another window left behind as one's own; False if somebody else has taken it meanwhile."""
        try:
            file = left.place.open("r+", encoding="utf-8")
        except OSError:
            return False
        if not (_lock(file) and _is_still(file, left.place)):
            file.close()
            return False
        self.leave()
        self._place, self._held = left.place, file
        return True

    def forget(self) -> None:
        """Keep nothing any more: the case is saved, or its changes were given up."""
        if self._place is not None:
            with contextlib.suppress(OSError):
                self._place.unlink()
        self.leave()
        self._place = None

    def leave(self) -> None:
        """Hold it no longer: what it keeps is left behind for the next window."""
        if self._held is not None:
            self._held.close()
            self._held = None


def left_behind(path: Path | None) -> list[Left]:
    """What windows that are no more kept of a case file, or of cases without one; the newest first."""
    found: list[tuple[float, Left]] = []
    for place in journal_folder().glob(f"{stem_of(path)}*.json"):
        try:
            if not place.is_file():  # what is written into a pipe nobody may wait for
                continue
            with place.open(encoding="utf-8") as file:
                if not (_lock(file) and _is_still(file, place)):
                    continue
                content = json.load(file)
                base = str(content.get("base", ""))
                text, origin, name, when = (str(content[key]) for key in ("text", "origin", "name", "when"))
                text = HALVES.sub("\ufffd", text)  # earlier versions kept what no page can be sent
                found.append((os.fstat(file.fileno()).st_mtime, Left(place, Kept(text, origin, name, when, base))))
        except (OSError, ValueError, KeyError, TypeError, AttributeError, RecursionError):
            continue
    return [left for _, left in sorted(found, key=lambda one: one[0], reverse=True)]


def drop(left: Left) -> None:
    """Forget a state that was left behind, unless somebody has taken it."""
    journal = Journal(None)
    if journal.take(left):
        journal.forget()


def now() -> str:
    """Local time, as a journal says when a state was left."""
    return time.strftime("%Y-%m-%d %H:%M")


def _lock(file: TextIO) -> bool:
    """Hold a file until it is closed; False if another window holds it."""
    try:
        import fcntl
    except ImportError:
        return True  # Windows: the journal of a living window may be taken up by another, which changes no file
    try:
        fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except BlockingIOError:
        return False
    except OSError:  # a file system without locks
        return True
    return True


def _is_still(file: TextIO, place: Path) -> bool:
    """Whether an open file is the one at its place, and not one that was replaced meanwhile."""
    try:
        return os.path.samestat(os.fstat(file.fileno()), place.lstat())
    except OSError:
        return False


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
            if folder.is_symlink() or folder.stat().st_uid != os.getuid() or not (folder / _HELD).is_file():
                continue
            with (folder / _HELD).open("rb") as held:
                fcntl.flock(held, fcntl.LOCK_EX | fcntl.LOCK_NB)
                shutil.rmtree(folder)
            gone.append(folder)
    return gone
