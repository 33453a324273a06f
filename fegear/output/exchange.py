"""New files of a folder for old ones: all of them or none, and none lost that fegear did not write itself.

A folder for unfinished work that one process holds at a time: what a killed one left there, the next one clears.

Moments in which Ctrl-C and requests to stop wait: what was begun on the disk is then either done or undone.
"""

from __future__ import annotations

import contextlib
import errno
import hashlib
import json
import os
import platform
import shutil
import signal
import stat
import tempfile
import threading
import time
from collections.abc import Iterable, Iterator, Mapping
from pathlib import Path, PurePosixPath
from typing import TextIO

import fegear
from fegear.base.errors import InputError
from fegear.case.json_file import read_json

#: What fegear wrote into a folder, with a digest of each file: what differs from it is somebody else's.
RECORD = ".fegear-files.json"
#: In the folder of work while files are exchanged: what has to be undone if that is cut short.
JOURNAL = "journal.json"
_OLD = "old"


def check_room(target: Path, names: Iterable[str]) -> None:
    """Refuse a folder in which files of these names could not be placed.

    Parameters
    ----------
    target : Path
        Need not exist.
    names : iterable of str
        Relative names of files.

    Raises
    ------
    OSError
        If a folder stands where a file must go, or a file, a link, another file system or a read-only folder where a
        folder must.
    """
    if not target.is_dir():
        return
    device = target.stat().st_dev
    for part in dict.fromkeys(parent for name in names for parent in PurePosixPath(name).parents):
        folder = target / part
        if folder == target or not os.path.lexists(folder):
            continue
        if folder.is_symlink() or not folder.is_dir():
            raise OSError(f"its {part} is {'a link' if folder.is_symlink() else 'a file'} where a folder must be")
        if folder.stat().st_dev != device:
            raise OSError(f"its folder {part} lies on another file system")
        if not os.access(folder, os.W_OK | os.X_OK):
            raise OSError(f"its folder {part} is read-only")
    for name in names:
        if (target / name).is_dir() and not (target / name).is_symlink():
            raise OSError(f"its {name} is a folder where a file must be")


def exchange(work: Path, scratch: Path, target: Path, *, all_of_it: bool) -> dict[str, str]:
    """Move the files of `scratch` into `target`.

    Parameters
    ----------
    work : Path
        Where old files are kept until all new ones are in place; on the file system of `target`.
    scratch, target : Path
    all_of_it : bool
        Whether files that fegear wrote there earlier and that are not among the new ones are removed.

    Returns
    -------
    dict
        Files that fegear did not write, or that were changed since, and the names under which they are kept.

    Raises
    ------
    OSError
        If a file cannot be moved; `target` is as it was.
    """
    written = digests(scratch)
    if not target.exists():
        _write_record(scratch, written)
        scratch.rename(target)
        return {}
    check_room(target, written)
    recorded = read_record(target)
    earlier = {name for name, digest in recorded.items() if _is_file(target, name) and _digest(target / name) == digest}
    gone = earlier.difference(written) if all_of_it else set()
    strange = [name for name in written if os.path.lexists(target / name) and name not in earlier]
    kept = {name: _free_name(target, name) for name in strange}
    _write_record(scratch, written if all_of_it else recorded | written)
    new = {RECORD: _digest(scratch / RECORD), **written}
    replaced = [name for name in new if name not in kept and os.path.lexists(target / name)]
    journal = {
        "made": {name: digest for name, digest in new.items() if name not in replaced},
        "old": [*replaced, *gone],
        "kept": kept,
    }
    (work / JOURNAL).write_text(json.dumps(journal), encoding="utf-8")
    try:
        for name in journal["old"]:
            _set_aside(target / name, work / _OLD / name, leave=name in new)
        for name, other in kept.items():
            (target / name).rename(target / other)
        for name in new:
            place = target / name
            place.parent.mkdir(parents=True, exist_ok=True)
            (scratch / name).replace(place)
    except BaseException:
        put_back(work, target)
        raise
    (work / JOURNAL).unlink()
    for name in gone:
        with contextlib.suppress(OSError):
            (target / name).parent.rmdir()
    return kept


def put_back(work: Path, target: Path) -> None:
    """Undo an exchange that was cut short, and empty the folder of work but for its holder."""
    journal = _read_json(work / JOURNAL)
    for name, digest in _names(journal.get("made")).items():
        if _is_file(target, name) and _digest(target / name) == digest:
            (target / name).unlink()
            with contextlib.suppress(OSError):
                (target / name).parent.rmdir()
    for name, other in _names(journal.get("kept")).items():
        if _inside(other) and _is_file(target, other) and not os.path.lexists(target / name):
            (target / other).rename(target / name)
    for name in () if (work / _OLD).is_symlink() else files_below(work / _OLD):
        (target / name).parent.mkdir(parents=True, exist_ok=True)
        (work / _OLD / name).replace(target / name)
    for item in ("new", _OLD):
        shutil.rmtree(work / item, ignore_errors=True)
    (work / JOURNAL).unlink(missing_ok=True)


def files_below(folder: Path) -> list[str]:
    """Relative names of all files below a folder, sorted, the summary last: readers go by it."""
    names = [path.relative_to(folder).as_posix() for path in folder.rglob("*") if path.is_file()]
    return sorted(names, key=lambda name: (name == "summary.json", name))


def digests(folder: Path) -> dict[str, str]:
    """SHA-256 of every file below a folder."""
    return {name: _digest(folder / name) for name in files_below(folder)}


def read_record(target: Path) -> dict[str, str]:
    """What fegear wrote into a folder, as its record says; nothing where there is none or it is not fegear's."""
    return _names(_read_json(target / RECORD).get("files"))


def _write_record(folder: Path, written: Mapping[str, str]) -> None:
    content = {"fegear": fegear.__version__, "files": dict(sorted(written.items()))}
    (folder / RECORD).write_text(json.dumps(content, indent=1) + "\n", encoding="utf-8")


def _read_json(path: Path) -> dict[str, object]:
    try:
        return read_json(path, path.name)
    except InputError:
        return {}


def _names(found: object) -> dict[str, str]:
    """Texts by relative names that stay inside their folder; anything else is left out."""
    pairs = found.items() if isinstance(found, dict) else ()
    return {name: text for name, text in pairs if isinstance(text, str) and isinstance(name, str) and _inside(name)}


def _inside(name: str) -> bool:
    path = Path(name)
    return bool(name) and not path.is_absolute() and not path.drive and ".." not in path.parts and "\0" not in name


def _is_file(target: Path, name: str) -> bool:
    """Whether it is a plain file below `target`, reached over no link."""
    place = target / name
    folders = [target / part for part in PurePosixPath(name).parents if str(part) != "."]
    return place.is_file() and not place.is_symlink() and not any(folder.is_symlink() for folder in folders)


def _digest(path: Path) -> str:
    with path.open("rb") as file:
        return hashlib.file_digest(file, "sha256").hexdigest()


def _free_name(target: Path, name: str) -> str:
    path = PurePosixPath(name)
    number = 1
    while True:
        other = path.with_name(f"{path.stem}.kept{number if number > 1 else ''}{path.suffix}")
        if not os.path.lexists(target / other):
            return other.as_posix()
        number += 1


def _set_aside(place: Path, aside: Path, *, leave: bool) -> None:
    """Keep an old file; where a new one follows it stays in place until then, if the file system can do that."""
    aside.parent.mkdir(parents=True, exist_ok=True)
    if leave:
        with contextlib.suppress(OSError):
            os.link(place, aside, follow_symlinks=False)
            return
    place.rename(aside)


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
        raise FileExistsError(errno.EEXIST, f"{folder.name}, where it works meanwhile, is a link or a file")
    inside = {item.name for item in folder.iterdir()}  # at one moment: the holder removes his file last
    if inside and HOLDER not in inside:
        raise FileExistsError(errno.EEXIST, f"{folder.name}, where it works meanwhile, is a folder of somebody else's")


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


_NAMES = ("SIGINT", "SIGTERM", "SIGHUP")


@contextlib.contextmanager
def undisturbed(*, at_the_end: bool = False) -> Iterator[None]:
    """Hold Ctrl-C and requests to stop back for the few milliseconds of the block.

    They act when it is over; `at_the_end` of all work they are dropped, for there is nothing left to stop, and who was
    told of a stop would take finished results for unfinished ones.

    Signals reach the main thread alone, so in any other thread there is nothing to hold back.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    waiting: list[int] = []
    # A blocked signal mask would not do: the system hands the signal to another thread, and Python acts on it here.
    numbers = [getattr(signal, name) for name in _NAMES if hasattr(signal, name)]
    before = {n: h for n in numbers if callable(h := signal.getsignal(n))}
    for number in before:
        signal.signal(number, lambda n, _: waiting.append(n))
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        for number in [] if at_the_end else waiting[:1]:
            signal.raise_signal(number)
