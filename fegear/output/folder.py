"""An output folder that is whole at any moment: files are made elsewhere and moved in when all of them exist."""

from __future__ import annotations

import contextlib
import errno
import os
from collections.abc import Callable, Iterator
from pathlib import Path

from fegear.base.errors import NO_ROOM, PATH, InputError, shown
from fegear.base.streams import complain
from fegear.case.text_file import named_path
from fegear.output.file_names import file_name
from fegear.output.held_folder import HeldError, claimed, clear_abandoned, folder_for
from fegear.output.new_for_old import JOURNAL, RECORD, check_room, exchange, put_back
from fegear.output.undisturbed import undisturbed

#: The file that lists all others; with it, a folder's earlier files are replaced as a whole.
SUMMARY = "summary.json"


#: What every command writes into, checked in the folder before anything is computed.
_KNOWN = (SUMMARY, RECORD, "report.html", "results.nc", "sweep.nc", "tables/*", "plots/*", "fields/*")


def default_folder(name: str, ending: str = "") -> Path:
    """Where a command writes without ``--out``: ``results/<case><ending>``."""
    return Path("results") / f"{file_name(name)}{ending}"


def _say(sentence: str) -> None:
    """Tell the user what became of a file of his own."""
    complain(f"Note: {sentence}")


@contextlib.contextmanager
def whole_or_nothing(target: Path, key: str = "--out", say: Callable[[str], None] = _say) -> Iterator[Path]:
    """Give a scratch folder whose files replace those of `target` when the block ends well.

    An error or an interrupt inside the block leaves `target` exactly as it was, and no folder behind that was not
    there before. What a killed process left behind is put right first.

    Parameters
    ----------
    target : Path
        Output folder; made if needed, and held by this process meanwhile. Files that an earlier run wrote and
        that this one does not make are removed, if they still are what it wrote. Files of others are left alone;
        those that stand where a new one must go are kept under another name.
    key : str
        Name of the option for error messages.
    say : callable
        Receives a sentence for the user about files that were kept.

    Yields
    ------
    Path
        The scratch folder, on the file system of `target`, so that moving is a rename.

    Raises
    ------
    InputError
        If the folder cannot be made or written to, or another process writes it.
    """
    made: list[Path] = []
    target = named_path(str(target), key)
    with contextlib.ExitStack() as held:
        with undisturbed(), _refusals(key, target):
            target = _real(target, key)
            made = _made_parents(target.parent)
            held.callback(_remove_empty, made)
            base, name = _workplace(target)
            clear_abandoned(base, JOURNAL)
            work = held.enter_context(claimed(folder_for(base, name)))
            put_back(work, target)
            check_room(target, _KNOWN)
            scratch = _emptied(work / "new")
        with _refusals(key, target, NO_ROOM):
            yield scratch
        with undisturbed(at_the_end=True), _refusals(key, target):
            kept = exchange(work, scratch, target, all_of_it=(scratch / SUMMARY).is_file())
        for old, new in kept.items():
            say(f"{target / old} was not written by fegear; kept as {new}.")


@contextlib.contextmanager
def _refusals(key: str, target: Path, kinds: frozenset[int] = frozenset()) -> Iterator[None]:
    """Say what the system refuses as a sentence; with `kinds`, these refusals alone: others are bugs and remain."""
    try:
        yield
    except HeldError as holder:
        raise InputError(
            key, shown(str(target), PATH), f"is being written by another run ({holder})",
            "wait until it has finished, or choose another folder with --out",
        ) from None  # fmt: skip
    except OSError as error:
        if kinds and error.errno not in kinds:
            raise
        reason = error.strerror or str(error)
        remedy = "free disk space, or " if error.errno in NO_ROOM else ""
        raise InputError(
            key,
            shown(str(target), PATH),
            f"is not writable ({reason})",
            f"{remedy}choose another folder with --out",
        ) from None


def _real(target: Path, key: str) -> Path:
    """The folder itself where `target` is a link to one; refuses what can be none."""
    if target.is_symlink() and not target.exists():
        raise InputError(
            key, shown(str(target), PATH), "is a link to something that does not exist", "choose another folder"
        )
    target = Path(os.path.realpath(target))
    below = next((folder for folder in target.parents if folder.exists()), target)
    if not below.is_dir():
        raise InputError(
            key, shown(str(target), PATH), f'lies below "{below}", which is a file', "choose another folder"
        )
    if target.exists() and not target.is_dir():
        raise InputError(key, shown(str(target), PATH), "is a file, not a folder", "choose another folder")
    if target.is_dir() and not os.access(target, os.W_OK | os.X_OK):
        raise PermissionError(errno.EACCES, "the folder is read-only")
    return target


def _workplace(target: Path) -> tuple[Path, str]:
    """Where the scratch folder goes: beside the target, or in it where it is a mount point or nothing else is ours."""
    beside = target.parent
    if target.is_dir() and (
        target.stat().st_dev != beside.stat().st_dev or not os.access(beside, os.W_OK | os.X_OK) or target == beside
    ):
        return target, "work"
    return beside, file_name(target.name)


def _made_parents(target: Path) -> list[Path]:
    """Create the folders above `target`; return those that were not there, innermost first."""
    missing = [folder for folder in [target, *target.parents] if not folder.exists()]
    try:
        target.mkdir(parents=True, exist_ok=True)
    except OSError:
        _remove_empty(missing)
        raise
    return missing


def _emptied(folder: Path) -> Path:
    folder.mkdir()
    return folder


def _remove_empty(folders: list[Path]) -> None:
    for folder in folders:
        with contextlib.suppress(OSError):
            folder.rmdir()


def files_in(folder: Path) -> list[str]:
    """Relative names of all files below a folder, sorted."""
    return sorted(path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file())
