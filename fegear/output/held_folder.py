"""A folder for unfinished work that one process holds at a time: what a killed one left there, the next one clears."""

from __future__ import annotations

import contextlib
import errno
import json
import os
import platform
import shutil
import stat
import tempfile
import time
from collections.abc import Iterator
from pathlib import Path
from typing import TextIO

from fegear.output.undisturbed import undisturbed

#: Who is at work; locked while he is, by a lock that the system releases when he dies.
HOLDER = "holder.json"

_PREFIX = ".fegear-"


class HeldError(Exception):
    """Another process is at work in the folder; the text says which, and since when."""


def folder_for(base: Path, name: str) -> Path:
    """Where work on `name` is done below `base`: the same for everyone who works on it."""
    return base / f"{_PREFIX}{name}"


@contextlib.contextmanager
def claimed(folder: Path) -> Iterator[Path]:
    """Hold a folder: made, locked, removed at the end with all that is in it.

    It is one that was made here, never what a link leads to and never a folder that somebody else filled.

    Parameters
    ----------
    folder : Path
        From `folder_for`.

    Yields
    ------
    Path
        The folder, or where the file system knows no locks one of its own beside it.

    Raises
    ------
    HeldError
        If another process holds it.
    OSError
        If it cannot be made, or what stands there is not fegear's.
    """
    with contextlib.ExitStack() as held:
        with undisturbed():  # a stop between making the folder and knowing of it would leave it behind
            holder = _locked(folder)
            if holder is None:
                folder = Path(tempfile.mkdtemp(prefix=f"{folder.name}-", dir=folder.parent))
            else:
                held.enter_context(holder)
            held.callback(_removed, folder, folder.lstat())
        yield folder


def clear_abandoned(base: Path, keep: str) -> None:
    """Remove folders of work below `base` that nobody holds; those that hold a file `keep` wait for their own."""
    for folder in base.glob(f"{_PREFIX}*"):
        if (folder / HOLDER).is_file() and not (folder / keep).exists():
            with contextlib.suppress(HeldError, OSError), claimed(folder):
                pass


def _removed(folder: Path, made: os.stat_result) -> None:
    """Remove a folder that we hold; its holder's file last, for without it the folder is anybody's."""
    with undisturbed(at_the_end=True):
        with contextlib.suppress(OSError):
            if not os.path.samestat(folder.lstat(), made):  # somebody put another one in its place
                return
            for item in folder.iterdir():
                if item.is_dir() and not item.is_symlink():
                    shutil.rmtree(item, ignore_errors=True)
                elif item.name != HOLDER:
                    item.unlink()
        with contextlib.suppress(OSError):
            (folder / HOLDER).unlink(missing_ok=True)
            folder.rmdir()


def _locked(folder: Path) -> TextIO | None:
    """Open and lock the holder's file; None where there are no locks."""
    try:
        import fcntl
    except ImportError:
        return None
    while True:
        try:
            folder.mkdir()
        except FileExistsError:
            with contextlib.suppress(FileNotFoundError):  # the last holder removed it while mkdir looked what it is
                _refuse_what_is_not_ours(folder)
        try:
            file = _opened(folder)
        except FileNotFoundError:  # the last holder has just removed the folder
            continue
        try:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
            if not _is_still(file, folder / HOLDER):
                file.close()
                continue
            file.truncate(0)
            facts = {"process": os.getpid(), "computer": platform.node(), "since": time.strftime("%Y-%m-%d %H:%M:%S")}
            json.dump(facts, file)
            file.flush()
        except BlockingIOError:
            file.seek(0)
            text = file.read()
            file.close()
            raise HeldError(_who(text)) from None
        except OSError:
            file.close()
            if _lockable(folder):
                raise
            return None
        return file


def _refuse_what_is_not_ours(folder: Path) -> None:
    """Refuse a link, a file, or a folder that fegear did not make: one with something in it, but no holder's file."""
    if not stat.S_ISDIR(folder.lstat().st_mode):
        raise FileExistsError(errno.EEXIST, f"temporary folder {folder.name} is a link or a file")
    inside = {item.name for item in folder.iterdir()}  # at one moment: the holder removes his file last
    if inside and HOLDER not in inside:
        raise FileExistsError(errno.EEXIST, f"temporary folder {folder.name} belongs to another user or program")


def _opened(folder: Path) -> TextIO:
    """The holder's file, of the folder itself and not of what a link leads to."""
    inside = os.open(folder, os.O_RDONLY | os.O_DIRECTORY | os.O_NOFOLLOW)
    try:
        number = os.open(HOLDER, os.O_RDWR | os.O_CREAT | os.O_APPEND | os.O_NOFOLLOW, 0o666, dir_fd=inside)
    finally:
        os.close(inside)
    return os.fdopen(number, "a+", encoding="utf-8")


def _is_still(file: TextIO, path: Path) -> bool:
    """Whether an open file is the one at `path`, and not one that was removed meanwhile."""
    try:
        return os.path.samestat(os.fstat(file.fileno()), path.lstat())
    except OSError:
        return False


def _lockable(folder: Path) -> bool:
    """Whether the file system has locks, so that a failure means something else (a full disk)."""
    import fcntl

    try:
        with tempfile.TemporaryFile(dir=folder) as file:
            fcntl.flock(file, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError:
        return False
    return True


def _who(text: str) -> str:
    try:
        facts = json.loads(text)
        return f"process {facts['process']} on {facts['computer']}, since {facts['since']}"
    except (ValueError, KeyError, TypeError):
        return "another process"
