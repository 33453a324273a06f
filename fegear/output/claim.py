"""A folder for unfinished work that one process holds at a time: what a killed one left there, the next one clears."""

from __future__ import annotations

import contextlib
import json
import os
import platform
import shutil
import stat
import tempfile
import time
from typing import TYPE_CHECKING, TextIO

from fegear.output.undisturbed import undisturbed

if TYPE_CHECKING:
    from collections.abc import Iterator
    from pathlib import Path

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
        If it cannot be made.
    """
    with contextlib.ExitStack() as held:
        with undisturbed():  # a stop between making the folder and knowing of it would leave it behind
            holder = _locked(folder)
            if holder is None:
                folder = folder.with_name(f"{folder.name}-{os.getpid()}")
                shutil.rmtree(folder, ignore_errors=True)
                folder.mkdir()
            else:
                held.enter_context(holder)
            held.callback(_removed, folder)
        yield folder


def clear_abandoned(base: Path, keep: str) -> None:
    """Remove folders of work below `base` that nobody holds; those that hold a file `keep` wait for their own."""
    for folder in base.glob(f"{_PREFIX}*"):
        if (folder / HOLDER).is_file() and not (folder / keep).exists():
            with contextlib.suppress(HeldError, OSError), claimed(folder):
                pass


def _removed(folder: Path) -> None:
    """Remove a folder that we hold; its holder's file last, for without it the folder is anybody's."""
    with undisturbed(at_the_end=True):
        with contextlib.suppress(OSError):
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
            folder.mkdir(exist_ok=True)
        except FileExistsError:
            with contextlib.suppress(FileNotFoundError):  # the last holder removed it while mkdir looked what it is
                if not stat.S_ISDIR(folder.lstat().st_mode):
                    raise
            continue
        try:
            file = (folder / HOLDER).open("a+", encoding="utf-8")
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


def _is_still(file: TextIO, path: Path) -> bool:
    """Whether an open file is the one at `path`, and not one that was removed meanwhile."""
    try:
        return os.path.samestat(os.fstat(file.fileno()), path.stat())
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
