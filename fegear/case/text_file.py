"""Text files that a user names: case files and tables, in the one encoding that both have."""

from __future__ import annotations

import codecs
from typing import TYPE_CHECKING

from fegear.errors import InputError

if TYPE_CHECKING:
    from pathlib import Path

#: Largest file that is read [bytes]; a table of a million lines is smaller.
_LARGEST = 100_000_000
#: What other programs save as text; a file in UTF-16 begins with its mark, and so does one in UTF-32.
_MARKS = {codecs.BOM_UTF16_LE: "UTF-16", codecs.BOM_UTF16_BE: "UTF-16", codecs.BOM_UTF32_BE: "UTF-32"}


def read_text(path: Path, key: str) -> str:
    """Return the text of a file in UTF-8, with or without a byte order mark.

    Parameters
    ----------
    path : Path
    key : str
        Where the file is named, for messages.

    Raises
    ------
    InputError
        If it is not there, cannot be read, is too large or in another encoding.
    """
    try:
        if path.is_file() and path.stat().st_size > _LARGEST:
            raise InputError(key, f'"{path}"', f"is larger than {_LARGEST // 1_000_000} MB", "check which file it is")
        data = path.read_bytes()
    except FileNotFoundError:
        raise InputError(key, f'"{path}"', "does not exist", f"check the path of the {key} file") from None
    except OSError as error:
        raise InputError(key, f'"{path}"', f"cannot be read ({error.strerror or error})") from None
    for mark, name in _MARKS.items():
        if data.startswith(mark):
            raise InputError(key, f'"{path.name}"', f"is in {name}, not in UTF-8", "save it as UTF-8")
    if b"\0" in data:
        raise InputError(key, f'"{path.name}"', "is no text", "check which file it is")
    try:
        return data.decode("utf-8-sig").replace("\r\n", "\n")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise InputError(
            key, f'"{path.name}"', f"is not in UTF-8: line {line} has the byte {data[error.start]:#04x}",
            "save it as UTF-8, not in an encoding such as Latin-1 or Windows-1252",
        ) from None  # fmt: skip
