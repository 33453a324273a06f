"""Names of gears, pairs and cases as names of files: the one place where the one becomes the other."""

from __future__ import annotations

import hashlib
import re
import unicodedata

#: What every file system takes, and no shell takes for an option or a path.
_ORDINARY = re.compile(r"[A-Za-z0-9_](?:[A-Za-z0-9_.,+() -]*[A-Za-z0-9_,+()-])?")
_DEVICES = {"con", "prn", "aux", "nul", *(f"{kind}{n}" for kind in ("com", "lpt") for n in range(1, 10))}
#: Letters of a file's name before its ending; encrypted file systems take 143 bytes in all.
_LONGEST, _LETTERS, _DIGITS = 100, 60, 8


def file_name(name: str) -> str:
    """Name of a file for what a case calls `name`.

    Parameters
    ----------
    name : str
        Anything: letters of any script, slashes, nothing at all.

    Returns
    -------
    str
        `name` itself where it is ordinary ASCII. Otherwise its nearest ASCII letters and, after ``~``, eight digits of
        its SHA-256, so that different names stay different; no ordinary name holds a ``~``. Never a path, never longer
        than 100 letters.
    """
    device = name.split(".", maxsplit=1)[0].rstrip().lower() in _DEVICES
    if _ORDINARY.fullmatch(name) and len(name) <= _LONGEST and not device:
        return name
    ascii_letters = unicodedata.normalize("NFKD", name.replace("ß", "ss")).encode("ascii", "ignore").decode()
    letters = re.sub(r"[^A-Za-z0-9_]+", "-", ascii_letters).strip("-")[:_LETTERS].rstrip("-")
    digest = hashlib.sha256(name.encode("utf-8", "surrogatepass")).hexdigest()[:_DIGITS]
    return f"{letters or 'name'}~{digest}"
