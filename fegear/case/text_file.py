"""Text files that a user names: case files and tables, in the one encoding that both have."""

from __future__ import annotations

import codecs
import contextlib
import errno
import hashlib
import json
import os
import stat
import tempfile
import unicodedata
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import NamedTuple

from fegear.base.errors import PATH, InputError, shown

#: Largest file that is read [bytes]; a table of a million lines is smaller.
_LARGEST = 100_000_000


#: What other programs save as text; a file in UTF-16 begins with its mark, and so does one in UTF-32.
_MARKS = {codecs.BOM_UTF16_LE: "UTF-16", codecs.BOM_UTF16_BE: "UTF-16", codecs.BOM_UTF32_BE: "UTF-32"}


class TextFile(NamedTuple):
    """A file as it was read.

    Attributes
    ----------
    text : str
        With line feeds alone at the ends of its lines, without a byte order mark.
    digest : str
        SHA-256 of its bytes.
    ends : str
        What most of its lines end with.
    mark : bool
        Whether it begins with a byte order mark.
    """

    text: str
    digest: str = ""
    ends: str = "\n"
    mark: bool = False

    def written(self, text: str) -> bytes:
        """Another text in the form of this file.

        Raises
        ------
        UnicodeEncodeError
            If it holds half a character.
        """
        return (codecs.BOM_UTF8 if self.mark else b"") + text.replace("\n", self.ends).encode()


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
    return read_file(path, key).text


def read_file(path: Path, key: str) -> TextFile:
    """Return the text of a file, and what tells whether and how it was changed; as `read_text`."""
    data = _data(path, key)
    for mark, name in _MARKS.items():
        if data.startswith(mark):
            raise InputError(key, f'"{path.name}"', f"is in {name}, not in UTF-8", "save it as UTF-8")
    if b"\0" in data:
        raise InputError(key, f'"{path.name}"', "is not a text file", "check which file it is")
    try:
        text = data.decode("utf-8-sig")
    except UnicodeDecodeError as error:
        line = data[: error.start].count(b"\n") + 1
        raise InputError(
            key, f'"{path.name}"', f"is not in UTF-8: line {line} has the byte {data[error.start]:#04x}",
            "save it as UTF-8, not in an encoding such as Latin-1 or Windows-1252",
        ) from None  # fmt: skip
    ends = "\r\n" if 2 * text.count("\r\n") > text.count("\n") else "\n"
    return TextFile(text.replace("\r\n", "\n"), digest_of(data), ends, data.startswith(codecs.BOM_UTF8))


def read_table_text(path: Path, key: str) -> str:
    """Return the text of a table: in UTF-8, in UTF-16 with its mark, else in Windows-1252, as other programs save it.

    Parameters
    ----------
    path : Path
    key : str
        Where the file is named, for messages.

    Raises
    ------
    InputError
        If it is not there, cannot be read, is too large or not a text.
    """
    data = _data(path, key)
    wide = data.startswith((codecs.BOM_UTF16_LE, codecs.BOM_UTF16_BE))
    for encoding in ("utf-16",) if wide else ("utf-8-sig", "cp1252", "latin-1"):
        try:
            text = data.decode(encoding)
        except UnicodeDecodeError:
            continue
        if "\0" not in text:
            return text.replace("\r\n", "\n")
    raise InputError(key, f'"{path.name}"', "is not a text file", "check which file it is")


def digest_of(data: bytes) -> str:
    """SHA-256 of the content of a file."""
    return hashlib.sha256(data).hexdigest()


def digest_of_file(path: Path) -> str | None:
    """SHA-256 of the content of an ordinary file; None where a path leads to none, or to one that cannot be read."""
    if not leads_to(path, stat.S_ISREG):  # some devices act on being opened
        return None
    try:
        with open(path, "rb", opener=_at_once) as file:
            if stat.S_ISREG(os.fstat(file.fileno()).st_mode):
                return hashlib.file_digest(file, "sha256").hexdigest()
    except (OSError, ValueError):
        pass
    return None


def _data(path: Path, key: str) -> bytes:
    """The bytes of an ordinary file: a pipe or a device may never end, or never begin."""
    try:
        # A pipe that is put there between looking and opening must not be waited for.
        with open(path, "rb", opener=_at_once) as file:
            state = os.fstat(file.fileno())
            if not stat.S_ISREG(state.st_mode):
                raise InputError(
                    key, shown(str(path), PATH), "is a pipe or a device, not a file", "save it as a file first"
                )
            if state.st_size > _LARGEST:
                rule = f"is larger than {_LARGEST // 1_000_000} MB"
                raise InputError(key, shown(str(path), PATH), rule, "check which file it is")
            return file.read()
    except FileNotFoundError:
        raise InputError(key, shown(str(path), PATH), "does not exist", f"check the path of the {key} file") from None
    except OSError as error:
        raise InputError(key, shown(str(path), PATH), f"cannot be read ({error.strerror or error})") from None
    except ValueError:
        raise InputError(key, shown(str(path), PATH), "is not a valid file name", "check its characters") from None


def _at_once(name: str, flags: int) -> int:
    return os.open(name, flags | getattr(os, "O_NONBLOCK", 0))


def leads_to(path: Path, kind: Callable[[int], bool]) -> bool:
    """Whether a path leads to something of a kind, `stat.S_ISDIR` say; a name that no file can have leads nowhere."""
    try:
        return kind(path.stat().st_mode)
    except (OSError, ValueError):
        return False


def is_below(path: Path, folders: Sequence[str]) -> bool:
    """Whether a path leads to one of some real folders or files, or to something below one, links followed."""
    try:
        real = Path(os.path.realpath(path))
    except (OSError, ValueError):
        return False
    return any(real.is_relative_to(one) for one in folders)


def named_path(text: str, key: str, *, home: bool = False) -> Path:
    """Return the path that somebody typed.

    Parameters
    ----------
    text : str
    key : str
        Where it was typed, for messages.
    home : bool
        Whether ``~`` begins a home folder; on the command line the shell has seen to that.

    Raises
    ------
    InputError
        If it can be no path: empty, of a home folder that nobody has, of characters that no file's name may have.
    """
    if not text.strip():
        raise InputError(key, shown(text), "must not be empty", 'for example "drive" or "." for this folder')
    if any(unicodedata.category(sign) in ("Cc", "Cs") for sign in text):
        raise InputError(key, shown(text), "contains a character not allowed in file names", "remove it")
    try:
        return Path(text).expanduser() if home else Path(text)
    except RuntimeError:
        raise InputError(key, shown(text), "refers to an unknown home folder", "use an absolute path") from None


def write_file(path: Path, data: bytes, key: str) -> None:
    """Write a file, which is whole at any moment; a link stays one, and what it leads to is written.

    Parameters
    ----------
    path : Path
    data : bytes
    key : str
        Where the file is named, for messages.

    Raises
    ------
    InputError
        If it cannot be written.
    """
    try:
        place = Path(os.path.realpath(path))
        mode = 0o666 & ~_umask()
        with contextlib.suppress(FileNotFoundError):
            state = place.stat()
            if not stat.S_ISREG(state.st_mode):
                raise InputError(
                    key, shown(str(path), PATH), "is a folder, a pipe or a device, not a file", "choose another file"
                )
            mode = state.st_mode & 0o777
        handle, scratch = tempfile.mkstemp(prefix=".", dir=place.parent)
        try:
            with os.fdopen(handle, "wb") as file:
                file.write(data)
            Path(scratch).chmod(mode)
            Path(scratch).replace(place)
        except BaseException:
            with contextlib.suppress(OSError):
                Path(scratch).unlink()
            raise
    except OSError as error:
        reason = error.strerror or error
        remedy = "make room" if error.errno in (errno.ENOSPC, errno.EDQUOT) else "choose another name"
        raise InputError(key, shown(str(path), PATH), f"cannot be written ({reason})", remedy) from None
    except ValueError:
        raise InputError(key, shown(str(path), PATH), "is not a valid file name", "check its characters") from None


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask


def toml_string(text: str) -> str:
    """A text as TOML writes it: in quotes like JSON's, which leave one control character as it is."""
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
