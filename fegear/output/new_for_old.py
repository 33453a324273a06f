"""New files of a folder for old ones: all of them or none, and none lost that fegear did not write itself."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import shutil
from collections.abc import Iterable, Mapping
from pathlib import Path, PurePosixPath

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
            raise OSError(f"its {part} is {'a link' if folder.is_symlink() else 'a file'} instead of a folder")
        if folder.stat().st_dev != device:
            raise OSError(f"its folder {part} is on another file system")
        if not os.access(folder, os.W_OK | os.X_OK):
            raise OSError(f"its folder {part} is read-only")
    for name in names:
        if (target / name).is_dir() and not (target / name).is_symlink():
            raise OSError(f"its {name} is a folder instead of a file")


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
