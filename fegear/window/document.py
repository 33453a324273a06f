"""The case on the desk: its text, its earlier and later states, what is wrong with it, and the file it belongs to."""

from __future__ import annotations

import os
from pathlib import Path
from typing import TYPE_CHECKING, Any

from fegear.base.errors import PATH, FegearError, InputError, shown
from fegear.case.reading import build_scene, parse_document
from fegear.case.text_file import TextFile, digest_of, read_file, write_file
from fegear.engine.plan import make_plan
from fegear.results.catalogue import STAGES
from fegear.window.case_text import with_value
from fegear.window.journal import Journal, Kept, Left, drop, left_behind, now

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.case.reading import Scene

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
    restored : str
        What became of unsaved changes that an earlier window left behind, in a sentence; empty where there were none.
    trouble : str
        Why the state cannot be kept beyond a crash; empty as a rule.
    """

    def __init__(self, text: str, name: str, folder: Path, path: Path | None = None) -> None:
        self.name, self.folder, self.path = name, folder, path
        self.restored = self.trouble = ""
        self._document: Mapping[str, Any] = {}
        self._scene: Scene | None = None
        self._refusal: FegearError | None = None
        self._saved = text if path else ""
        self._file = TextFile("")
        self._journal = Journal(path)
        self._outdated: Left | None = None
        self._states, self._at = [text], 0
        self._stroke = self._unkept = False
        self._judge()

    @classmethod
    def of_file(cls, path: Path) -> Desk:
        """Lay a case file on the desk, with the changes that were made and not saved when it last lay there.

        Raises
        ------
        InputError
            If it cannot be read as a text.
        """
        file = read_file(path, "case")
        desk = cls(file.text, path.stem, path.parent, path)
        desk._file = file
        outdated: list[Left] = []
        for left in left_behind(path):
            if left.kept.text == file.text:
                drop(left)
            elif left.kept.base != file.digest:
                outdated.append(left)
            elif not desk.restored and desk._journal.take(left):
                desk.change(left.kept.text)
                desk.restored = f"Changes of {left.kept.when} that were not saved are here again."
        if outdated and not desk.restored:
            desk._outdated = left = outdated[0]
            desk._states, desk._at = [left.kept.text, file.text], 1
            desk.restored = (
                f"The file is no longer what changes of {left.kept.when} began with, which were not saved; "
                "Undo has the case with them."
            )
        return desk

    @classmethod
    def of_left(cls, left: Left) -> Desk:
        """Lay a case without a file on the desk that an earlier window left behind.

        Raises
        ------
        InputError
            If another window has taken it meanwhile.
        """
        desk = cls(left.kept.text, left.kept.name, Path(left.kept.origin))
        if not desk._journal.take(left):
            raise InputError("case", f'"{left.kept.name}"', "is open in another window by now", "go on there")
        desk.restored = f"Changes of {left.kept.when} that were not saved are here again."
        return desk

    @property
    def text(self) -> str:
        """As it is now."""
        return self._states[self._at]

    @property
    def document(self) -> Mapping[str, Any]:
        """As plain tables, of the last text that was valid TOML."""
        self._judge_late()
        return self._document

    @property
    def scene(self) -> Scene | None:
        """What the last text that described one describes."""
        self._judge_late()
        return self._scene

    @property
    def refusal(self) -> FegearError | None:
        """What is wrong with it: the sentence that the command line prints."""
        self._judge_late()
        return self._refusal

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

    def may_be_asked(self) -> bool:
        """Whether nothing is known to be wrong: a value that is moved is judged after its answer has been asked for."""
        return self._refusal is None or self.refusal is None

    def _judge_late(self) -> None:
        if not self._judged:
            self._judge()

    def _judge(self) -> None:
        """Read the case and say what is wrong with it."""
        self._judged = True
        try:
            self._document = parse_document(self.text, f'"{self.name}.toml"')
            self._scene = build_scene(self._document, self.name, self.folder)
            make_plan(self._scene, STAGES)
            self._refusal = None
        except FegearError as error:
            self._refusal = error

    def change(self, text: str, *, stroke: bool = False) -> None:
        """Take another text; a state that is the same as now is none.

        Parameters
        ----------
        text : str
        stroke : bool
            Whether a value is being moved: the states of one stroke are undone together, and each waits for `keep_up`.
        """
        if text == self.text:
            return
        kept = self._at + 1 - (stroke and self._stroke)
        self._states = [*self._states[:kept], text][-_STATES:]
        self._at = len(self._states) - 1
        self._stroke = stroke
        self._moved(late=stroke)

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
                "case", f'"{self.name}.toml"', f"is no valid TOML: {error}", "correct the text first"
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

    def _moved(self, *, late: bool = False) -> None:
        self._judged, self._unkept = False, True
        self.restored = ""
        if not late:
            self.keep_up()

    def keep_up(self) -> None:
        """Judge the case as it is now and keep it beyond a crash, where that has waited for something more urgent."""
        self._judge_late()
        if not self._unkept:
            return
        self._unkept = False
        try:
            if self.changed:
                self._journal.keep(Kept(self.text, str(self.folder), self.name, now(), self._file.digest))
            else:
                self._journal.forget()
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
        if not over_others and self.path.exists() and read_file(self.path, "case").digest != self._file.digest:
            raise InputError(
                "case", shown(str(self.path), PATH), "was changed by somebody else since it was opened",
                "save under another name, or save again to replace it",
            )  # fmt: skip
        self._write(self.path)
        self._settled()

    def save_as(self, path: Path, *, replace: bool = False) -> None:
        """Write the text into another file, which is the case's from then on.

        Raises
        ------
        InputError
            If the file is there already or its folder is not, or it cannot be written.
        """
        told = shown(str(path), PATH)
        if path.name in ("", ".."):
            raise InputError("case", told, "is a folder, not a file's name", "write a name behind it")
        path = path if path.suffix == ".toml" else path.with_name(f"{path.name}.toml")
        if not os.path.isdir(path.parent):  # noqa: PTH112  (Path's own raises where a name is too long)
            raise InputError("case", told, "lies in a folder that is not there", "choose another, or make it first")
        if os.path.lexists(path) and not replace:
            raise InputError("case", told, "is there already", "choose another name")
        self._write(path)
        self._journal.forget()
        self._journal = Journal(path)
        self._outdated = None  # of the file that it was before, with which it stays
        self.path, self.name, self.folder = path, path.stem, path.parent
        self._settled()
        self._judge()

    def _write(self, path: Path) -> None:
        try:
            data = self._file.written(self.text)
        except UnicodeEncodeError:
            raise InputError(
                "case", f'"{self.name}"', "holds half a character, which no file takes", "correct the text"
            ) from None
        write_file(path, data, "case")
        self._file = self._file._replace(text=self.text, digest=digest_of(data))

    def _settled(self) -> None:
        """Keep nothing beside the file any more: it has what is open."""
        self._saved = self.text
        self._unkept = False
        self.restored = ""
        self._journal.forget()
        if self._outdated is not None:  # whoever saves has been told of it
            drop(self._outdated)
            self._outdated = None

    def give_up(self) -> None:
        """Go back to what the file has now; the states in between can be gone back to.

        Raises
        ------
        InputError
            If the file cannot be read any more.
        """
        if self.path is not None:
            self._file = read_file(self.path, "case")
            self._saved = self._file.text
            self.change(self._saved)
        self._settled()

    def leave(self) -> None:
        """Clear the desk: what is not saved is left behind for the next window."""
        self.keep_up()
        self._journal.leave()
