"""How far the page reaches: it opens and writes files below folders that the user opened, and no others.

Links count as what they lead to. The command line has no such bounds: who types there may read and write anyway.
"""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, NamedTuple

from fegear.base.errors import PATH, InputError, shown
from fegear.case.text_file import is_below

if TYPE_CHECKING:
    from collections.abc import Sequence


class Reach(NamedTuple):
    """Folders and files that the user named when the window was opened.

    Attributes
    ----------
    folders : tuple of str
        Below these files are read and written; a file stands for itself.
    sources : tuple of str
        Below these they are read only.
    """

    folders: tuple[str, ...]
    sources: tuple[str, ...] = ()

    @classmethod
    def of(cls, case: Path | None, folders: Sequence[Path] = (), sources: Sequence[Path] = ()) -> Reach:
        """The working folder, that of a case file and others.

        Raises
        ------
        InputError
            If one of the others is no folder.
        """
        for folder in folders:
            if not os.path.isdir(folder):  # noqa: PTH112  (Path's own raises where a name is too long)
                raise InputError("--folder", shown(str(folder), PATH), "is not a folder", "specify an existing folder")
        own = [case.parent, case] if case is not None else []
        return cls(
            tuple(dict.fromkeys(os.path.realpath(one) for one in (Path.cwd(), *own, *folders))),
            tuple(os.path.realpath(one) for one in sources),
        )

    def check(self, path: Path, key: str) -> Path:
        """Return a path that may be read and written.

        Raises
        ------
        InputError
            If it leads elsewhere; the sentence is the same whether or not anything is there.
        """
        if not is_below(path, self.folders):
            raise InputError(
                key, shown(str(path), PATH), f"is outside the open folders ({', '.join(self.folders)})",
                "start fegear open with --folder FOLDER",
            )  # fmt: skip
        return path

    @property
    def readable(self) -> tuple[str, ...]:
        """Below which files that a case names are read."""
        return (*self.folders, *self.sources)
