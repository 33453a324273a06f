"""The model in a REXS archive (``.rexsz``, ``.rexs.zip``): read in memory, bounded, without unpacking anything."""

from __future__ import annotations

import lzma
import struct
import zipfile
import zlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from fegear.base.errors import InputError

#: Most entries of an archive, and the most bytes of the model in it.
_MOST_ENTRIES, _LARGEST = 10_000, 100_000_000
#: What the library says of damaged archives, by the way in which they are packed.
_DAMAGED = (
    zipfile.BadZipFile, zlib.error, lzma.LZMAError, struct.error, NotImplementedError, EOFError, OSError, OverflowError,
    RuntimeError, ValueError,
)  # fmt: skip


def archived_text(path: Path, refusal: Callable[[str, str], InputError]) -> str:
    """The text of the one model in an archive.

    Parameters
    ----------
    path : Path
    refusal : callable
        Makes the error of a rule and a remedy.

    Raises
    ------
    InputError
        If the archive is damaged, encrypted or too large, or holds no model or several.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            entries = archive.infolist()
            if len(entries) > _MOST_ENTRIES:
                raise refusal(f"is an archive of more than {_MOST_ENTRIES} files", "pack only the model")
            models = [one for one in entries if _is_model(one.filename)]
            if len(models) != 1:
                names = ", ".join(one.filename for one in models[:3])
                what = f"{len(models)} models ({names})" if models else "no model (.rexs or .rexsj)"
                raise refusal(f"is an archive with {what}", "specify one of them")
            (model,) = models
            if model.flag_bits & 1:
                raise refusal("is an encrypted archive", "pack the model without a password")
            with archive.open(model) as file:
                data = file.read(_LARGEST + 1)  # what the archive claims of its size is not believed
    except _DAMAGED as error:
        raise refusal(f"is a damaged archive ({error})", "pack it again") from None
    if len(data) > _LARGEST:
        raise refusal(f"contains a model of more than {_LARGEST // 1_000_000} MB", "export the gearbox only")
    try:
        return data.decode("utf-8-sig")
    except UnicodeDecodeError:
        raise refusal("contains a model that is not in UTF-8", "export it again") from None


def _is_model(name: str) -> bool:
    """Whether a file of an archive is a model: those that an operating system adds are none."""
    *folders, last = name.split("/")
    return last.lower().endswith((".rexs", ".rexsj")) and not last.startswith("._") and "__MACOSX" not in folders
