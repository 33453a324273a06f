"""What has been changed and not saved, kept beyond a crash: one small file for each case in the user's state folder."""

from __future__ import annotations

import contextlib
import hashlib
import json
import os
import tempfile
import time
from pathlib import Path
from typing import NamedTuple


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
    """

    text: str
    origin: str
    name: str
    when: str


def journal_folder() -> Path:
    """Where the journals are: ``FEGEAR_STATE``, else the user's folder for such things of the system."""
    given = os.environ.get("FEGEAR_STATE")
    if given:
        return Path(given)
    import platformdirs

    return Path(platformdirs.user_state_dir("fegear", appauthor=False)) / "unsaved"


def _place(path: Path | None) -> Path:
    """The journal of a case file, or the one of cases without a file."""
    if path is None:
        return journal_folder() / "unnamed.json"
    digest = hashlib.sha256(str(path.resolve()).encode("utf-8", "surrogatepass")).hexdigest()[:16]
    return journal_folder() / f"{digest}.json"


def keep(path: Path | None, text: str, origin: Path, name: str) -> None:
    """Keep a state; what was kept of that case before is replaced as a whole.

    Raises
    ------
    OSError
        If the folder cannot be written to.
    """
    place = _place(path)
    place.parent.mkdir(parents=True, exist_ok=True)
    kept = Kept(text, str(origin), name, time.strftime("%Y-%m-%d %H:%M"))
    handle, scratch = tempfile.mkstemp(prefix=".", dir=place.parent)  # readable by its owner alone
    try:
        with os.fdopen(handle, "w", encoding="utf-8") as file:
            json.dump(kept._asdict(), file, ensure_ascii=False)
        Path(scratch).replace(place)
    except BaseException:
        with contextlib.suppress(OSError):
            Path(scratch).unlink()
        raise


def kept(path: Path | None) -> Kept | None:
    """What was kept of a case; None if nothing was, or it cannot be read."""
    try:
        found = json.loads(_place(path).read_text("utf-8"))
        return Kept(*(str(found[key]) for key in Kept._fields))
    except (OSError, ValueError, KeyError, TypeError):
        return None


def forget(path: Path | None) -> None:
    """Keep nothing of a case any more: it is saved, or its changes were given up."""
    with contextlib.suppress(OSError):
        _place(path).unlink()
