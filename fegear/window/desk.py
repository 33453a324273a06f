"""The case on the desk: its text, its earlier and later states, what is wrong with it, and the file it belongs to."""

from __future__ import annotations

import contextlib
import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fegear.case.reading import build_scene, parse_document
from fegear.case.text_file import read_text
from fegear.engine.plan import make_plan
from fegear.errors import FegearError, InputError
from fegear.results.catalogue import STAGES
from fegear.window.case_text import with_value
from fegear.window.journal import forget, keep, kept

if TYPE_CHECKING:
    from collections.abc import Mapping

#: Earlier states that can be gone back to.
_STATES = 500


class Desk:
    """One case that is being changed.

    Parameters
    ----------
    text : str
    name : str
        Of the case, as its file is called.
    folder : Path
        Where relative file names in the case start.
    path : Path, optional
        Its file; None for a new case.

    Attributes
    ----------
    text : str
        As it is now, whether or not it can be read.
    document : mapping
        As plain tables, of the last text that was valid TOML.
    refusal : FegearError or None
        What is wrong with it: the sentence that the command line prints.
    restored : str
        When the unsaved changes were made with which it came; empty where there were none.
    trouble : str
        Why the state cannot be kept beyond a crash; empty as a rule.
    """

    def __init__(self, text: str, name: str, folder: Path, path: Path | None = None) -> None:
        self.name, self.folder, self.path = name, folder, path
        self.restored = self.trouble = ""
        self.document: Mapping[str, Any] = {}
        self.refusal: FegearError | None = None
        self._saved = text if path else ""
        self._states, self._at = [text], 0
        self._stroke = False
        self.judge()

    @classmethod
    def of_file(cls, path: Path) -> Desk:
        """Lay a case file on the desk, with the changes that were made and not saved when it last lay there.

        Raises
        ------
        InputError
            If it cannot be read as a text.
        """
        desk = cls(read_text(path, "case"), path.stem, path.parent, path)
        left = kept(path)
        if left is not None and left.text != desk.text:
            desk.change(left.text)
            desk.restored = left.when
        return desk

    @classmethod
    def left_behind(cls) -> Desk | None:
        """The case without a file that was not saved, if there is one."""
        left = kept(None)
        if left is None:
            return None
        desk = cls(left.text, left.name, Path(left.origin))
        desk.restored = left.when
        return desk

    @property
    def text(self) -> str:
        """As it is now."""
        return self._states[self._at]

    @property
    def changed(self) -> bool:
        """Whether it differs from its file, or has none."""
        return self.path is None or self.text != self._saved

    @property
    def can_undo(self) -> bool:
        """Whether there is an earlier state."""
        return self._at > 0

    @property
    def can_redo(self) -> bool:
        """Whether there is a later state."""
        return self._at + 1 < len(self._states)

    def judge(self) -> None:
        """Read the case and say what is wrong with it."""
        try:
            self.document = parse_document(self.text, f'"{self.name}.toml"')
            make_plan(build_scene(self.document, self.name, self.folder), STAGES)
            self.refusal = None
        except FegearError as error:
            self.refusal = error

    def change(self, text: str, *, stroke: bool = False) -> None:
        """Take another text; a state that is the same as now is none.

        Parameters
        ----------
        text : str
        stroke : bool
            Whether a value is being moved: the states of one stroke are undone together.
        """
        if text == self.text:
            return
        kept = self._at + 1 - (stroke and self._stroke)
        self._states = [*self._states[:kept], text][-_STATES:]
        self._at = len(self._states) - 1
        self._stroke = stroke
        self._moved()

    def end_stroke(self) -> None:
        """Let go of what was moved."""
        self._stroke = False

    def set(self, path: tuple[str, ...], value: str | None) -> None:
        """Change one key; `value` as TOML writes it, None to leave the key out.

        Raises
        ------
        InputError
            If the text is no valid TOML, or the key cannot be changed by itself.
        """
        try:
            self.change(with_value(self.text, path, value))
        except ValueError as error:
            raise InputError(
                "case", f'"{self.name}.toml"', f"is no valid TOML: {error}", "mend the text first"
            ) from None

    def undo(self) -> None:
        """Go back to the state before."""
        if self.can_undo:
            self._stroke = False
            self._at -= 1
            self._moved()

    def redo(self) -> None:
        """Go forward again."""
        if self.can_redo:
            self._stroke = False
            self._at += 1
            self._moved()

    def _moved(self) -> None:
        self.judge()
        self.restored = ""
        try:
            if self.changed:
                keep(self.path, self.text, self.folder, self.name)
            else:
                forget(self.path)
            self.trouble = ""
        except OSError as error:
            self.trouble = f"Changes are not kept beyond a crash: {error.filename or ''} {error.strerror or error}"

    def save(self, *, over_others: bool = False) -> None:
        """Write the text into its file, which is then whole at any moment.

        Raises
        ------
        InputError
            If it has no file, the file was changed by somebody else, or it cannot be written.
        """
        if self.path is None:
            raise InputError("case", self.name, "has no file yet", "save it under a name")
        if not over_others and self.path.exists() and read_text(self.path, "case") != self._saved:
            raise InputError(
                "case", f'"{self.path}"', "was changed by somebody else since it was opened",
                "save under another name, or save again to replace it",
            )  # fmt: skip
        _write(self.path, self.text)
        self._saved = self.text
        self.restored = ""
        forget(self.path)

    def save_as(self, path: Path, *, replace: bool = False) -> None:
        """Write the text into another file, which is the case's from then on.

        Raises
        ------
        InputError
            If the file is there already or its folder is not, or it cannot be written.
        """
        path = path if path.suffix == ".toml" else path.with_name(f"{path.name}.toml")
        if not path.parent.is_dir():
            raise InputError("case", f'"{path}"', "lies in a folder that is not there")
        if path.exists() and not replace:
            raise InputError("case", f'"{path}"', "is there already", "choose another name")
        _write(path, self.text)
        forget(self.path)
        self.path, self.name, self.folder, self._saved = path, path.stem, path.parent, self.text
        self.restored = ""
        self.judge()

    def give_up(self) -> None:
        """Go back to what the file has; the states in between can be gone back to."""
        if self.path is not None:
            self.change(self._saved)
        forget(self.path)


def _write(path: Path, text: str) -> None:
    mode = path.stat().st_mode & 0o777 if path.exists() else 0o666 & ~_umask()
    try:
        handle, scratch = tempfile.mkstemp(prefix=".", dir=path.parent)
        try:
            with os.fdopen(handle, "w", encoding="utf-8", newline="\n") as file:
                file.write(text)
            Path(scratch).chmod(mode)
            Path(scratch).replace(path)
        except BaseException:
            with contextlib.suppress(OSError):
                Path(scratch).unlink()
            raise
    except OSError as error:
        raise InputError("case", f'"{path}"', f"cannot be written ({error.strerror or error})") from None


def _umask() -> int:
    mask = os.umask(0)
    os.umask(mask)
    return mask
