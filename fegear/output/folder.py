"""An output folder that is whole at any moment: files are made elsewhere and moved in when all of them exist."""

from __future__ import annotations

import contextlib
import json
import os
import shutil
import signal
import tempfile
import threading
from pathlib import Path
from typing import TYPE_CHECKING

from fegear.errors import InputError

if TYPE_CHECKING:
    from collections.abc import Iterator

#: The file that lists all others, so that a later run can clear away what it no longer makes; moved in last.
SUMMARY = "summary.json"


def _made_parents(target: Path) -> list[Path]:
    """Create the folders above `target`; return those that were not there, innermost first."""
    missing = [folder for folder in [target, *target.parents] if not folder.exists()]
    target.mkdir(parents=True, exist_ok=True)
    return missing


@contextlib.contextmanager
def whole_or_nothing(target: Path, key: str = "--out") -> Iterator[Path]:
    """Give a scratch folder whose files replace those of `target` when the block ends well.

    An error or an interrupt inside the block leaves `target` exactly as it was, and no folder behind that was not
    there before.

    Parameters
    ----------
    target : Path
        Output folder; made if needed. Files that an earlier run listed in its summary and that the new one does not
        make are removed; files of others are left alone.
    key : str
        Name of the option for error messages.

    Yields
    ------
    Path
        The scratch folder, beside `target` so that moving is a rename.

    Raises
    ------
    InputError
        If the folder cannot be made or written to.
    """
    target = target.absolute()
    made: list[Path] = []
    below = next((folder for folder in target.parents if folder.exists()), target)
    if not below.is_dir():
        raise InputError(key, f'"{target}"', f'lies below "{below}", which is a file', "choose another folder")
    try:
        made = _made_parents(target.parent)
        if target.exists() and not target.is_dir():
            raise InputError(key, f'"{target}"', "is a file, not a folder", "choose another folder")
        if target.is_dir() and not os.access(target, os.W_OK | os.X_OK):
            raise PermissionError(13, "the folder is read-only")
        scratch = Path(tempfile.mkdtemp(prefix=f".{target.name}-", dir=target.parent))
    except OSError as error:
        _remove_empty(made)
        reason = error.strerror or str(error)
        raise InputError(
            key, f'"{target}"', f"cannot be written to ({reason})", "choose another folder with --out"
        ) from None
    try:
        yield scratch
        with _undisturbed():
            _move_in(scratch, target)
    finally:
        shutil.rmtree(scratch, ignore_errors=True)
        _remove_empty(made)


def check_target(target: Path) -> None:
    """Refuse a folder that `whole_or_nothing` could not fill, before long work is begun; leaves nothing behind.

    Raises
    ------
    InputError
        If the folder cannot be made or written to.
    """

    class Enough(Exception):  # noqa: N818  (no error: it ends the block without moving anything)
        pass

    with contextlib.suppress(Enough), whole_or_nothing(target):
        raise Enough


def _remove_empty(folders: list[Path]) -> None:
    for folder in folders:
        with contextlib.suppress(OSError):
            folder.rmdir()


@contextlib.contextmanager
def _undisturbed() -> Iterator[None]:
    """Hold Ctrl-C back for the few milliseconds in which finished files are moved."""
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    previous = signal.signal(signal.SIGINT, signal.SIG_IGN)
    try:
        yield
    finally:
        signal.signal(signal.SIGINT, previous)


def files_in(folder: Path) -> list[str]:
    """Relative names of all files below a folder, sorted."""
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())


def _listed(target: Path) -> set[str]:
    """Files that an earlier run says it made; none if there was no run or its summary is not ours."""
    try:
        listed = json.loads((target / SUMMARY).read_text(encoding="utf-8")).get("files", [])
        return {name for name in listed if isinstance(name, str) and not Path(name).is_absolute() and ".." not in name}
    except (OSError, ValueError, AttributeError):
        return set()


def _move_in(scratch: Path, target: Path) -> None:
    earlier, new = _listed(target), files_in(scratch)
    for name in sorted(new, key=lambda name: name == SUMMARY):
        place = target / name
        place.parent.mkdir(parents=True, exist_ok=True)
        (scratch / name).replace(place)
    for name in earlier.difference(new):
        (target / name).unlink(missing_ok=True)
        with contextlib.suppress(OSError):
            (target / name).parent.rmdir()
