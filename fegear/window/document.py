"""The case on the desk: its text, its earlier and later states, what is wrong with it, and the file it belongs to."""

from __future__ import annotations

import os
import traceback
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING, Any, NamedTuple

from fegear.base.errors import PATH, FegearError, InputError, shown
from fegear.case.changed_text import with_value
from fegear.case.reading import build_scene, parse_document
from fegear.case.text_file import TextFile, digest_of, read_file, write_file
from fegear.engine.plan import make_plan
from fegear.results.catalogue import STAGES
from fegear.window.journal import HALVES, Journal, Kept, Left, drop, left_behind, now

if TYPE_CHECKING:
    from collections.abc import Callable, Mapping

    from fegear.case.reading import Scene
    from fegear.window.reach import Reach

#: Earlier states that can be gone back to, and the characters that all of them may have.
_STATES, _CHARACTERS = 500, 30_000_000
#: A text of more characters is judged where nobody waits for it: 3000 gears take two seconds.
_LONG = 30_000
#: Most characters of a case that the window takes.
LARGEST = 4_000_000


class Verdict(NamedTuple):
    """What a text says.

    Attributes
    ----------
    document : mapping or None
        As plain tables; None where it is no TOML.
    scene : Scene or None
        What it describes; None where it describes none.
    refusal : FegearError or None
        What is wrong with it.
    """

    document: Mapping[str, Any] | None
    scene: Scene | None
    refusal: FegearError | None


def judged(text: str, name: str, folder: Path, within: tuple[str, ...] | None) -> Verdict:
    """Read a case and say what is wrong with it.

    Parameters
    ----------
    text, name : str
    folder : Path
        Where relative file names in the case start.
    within : tuple of str, optional
        Below which folders they must lie.
    """
    document = scene = None
    try:
        document = parse_document(text, f'"{name}.toml"')
        scene = build_scene(document, name, folder, within=within)
        make_plan(scene, STAGES)
    except FegearError as error:
        return Verdict(document, scene, error)
    return Verdict(document, scene, None)


class OverwriteError(InputError):
    """What is asked for would write over a file that is not the case's, as it was read: it may be asked for again."""


def check_text(text: str, key: str = "case") -> str:
    """Return a text that a case file can have.

    Raises
    ------
    InputError
        If it holds half a character or is too long.
    """
    if len(text) > LARGEST:
        rule = f"has {len(text)} characters; the maximum is {LARGEST}"
        raise InputError(key, "(text)", rule, "move tables to separate files, or use fegear run")
    if (half := HALVES.search(text)) is not None:
        line = text.count("\n", 0, half.start()) + 1
        raise InputError(key, "(text)", f"contains an invalid character (surrogate) in line {line}", "remove it")
    return text


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
    reach : Reach, optional
        Where files are read and written; None for anywhere.

    Attributes
    ----------
    restored : str
        What became of unsaved changes that an earlier window left behind, in a sentence; empty where there were none.
    trouble : str
        Why the state cannot be kept beyond a crash; empty as a rule.
    patient : bool
        Whether every change waits for `keep_up`: somebody calls it after several.
    pending : bool
        Whether the text is being judged where nobody waits for it; `document`, `scene` and `refusal` are those before.
    """

    def __init__(
        self, text: str, name: str, folder: Path, path: Path | None = None, reach: Reach | None = None
    ) -> None:
        self.name, self.folder, self.path = name, folder, path
        self._reach = reach
        self.patient = self.pending = False
        self.restored = self.trouble = ""
        self._document: Mapping[str, Any] = {}
        self._scene: Scene | None = None
        self._refusal: FegearError | None = None
        self._saved = text if path else ""
        self._file = TextFile("")
        self._journal = Journal(path)
        self._outdated: Left | None = None
        self._states, self._at = [text], 0
        self._stroke = self._unkept = self._judged = False
        if not self.heavy:
            self._judge()

    @classmethod
    def of_file(cls, path: Path, reach: Reach | None = None) -> Desk:
        """Lay a case file on the desk, with the changes that were made and not saved when it last lay there.

        Raises
        ------
        InputError
            If it cannot be read as a text, or must not be.
        """
        file = read_file(path if reach is None else reach.check(path, "case"), "case")
        desk = cls(file.text, path.stem, path.parent, path, reach)
        desk._file = file
        outdated: list[Left] = []
        for left in left_behind(path):
            if left.kept.text == file.text:
                drop(left)
            elif left.kept.base != file.digest:
                outdated.append(left)
            elif not desk.restored and desk._journal.take(left):
                desk.change(left.kept.text)
                desk.restored = f"Unsaved changes of {left.kept.when} restored."
        if outdated and not desk.restored:
            desk._outdated = left = outdated[0]
            desk._states, desk._at = [left.kept.text, file.text], 1
            desk.restored = (
                f"The file was modified since the unsaved changes of {left.kept.when}; Undo restores the case with "
                "these changes."
            )
        return desk

    @classmethod
    def of_left(cls, left: Left, reach: Reach | None = None) -> Desk:
        """Lay a case without a file on the desk that an earlier window left behind.

        Raises
        ------
        InputError
            If another window has taken it meanwhile.
        """
        desk = cls(left.kept.text, left.kept.name, Path(left.kept.origin), None, reach)
        if not desk._journal.take(left):
            raise InputError("case", f'"{left.kept.name}"', "is now open in another window", "continue there")
        desk.restored = f"Unsaved changes of {left.kept.when} restored."
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
        return not self.pending and (self._refusal is None or self.refusal is None)

    @property
    def heavy(self) -> bool:
        """Whether the text has not been judged, and that takes so long that nobody should wait for it."""
        return not self._judged and len(self.text) > _LONG

    def hand_out(self) -> Callable[[], Verdict]:
        """What judges the text as it is now, to be called elsewhere; `take_verdict` has what comes of it."""
        self._judged = self.pending = True
        return partial(self._verdict, self.text)

    def take_verdict(self, text: str, verdict: Verdict) -> bool:
        """Take what was found of a text; False if it is another one now."""
        if not self.pending or text != self.text:
            return False
        self._take(verdict)
        return True

    def _verdict(self, text: str) -> Verdict:
        within = self._reach.readable if self._reach is not None else None
        try:
            return judged(text, self.name, self.folder, within)
        except Exception as error:  # noqa: BLE001 - printed, and said where a refusal is
            traceback.print_exc()
            fault = (
                f"Internal error in fegear ({type(error).__name__}: {error}), not caused by the case; see the "
                "terminal for details."
            )
            return Verdict(None, None, FegearError(fault))

    def _judge_late(self) -> None:
        if not self._judged:
            self._judge()

    def _judge(self) -> None:
        """Read the case and say what is wrong with it."""
        self._take(self._verdict(self.text))

    def _take(self, verdict: Verdict) -> None:
        self._judged, self.pending = True, False
        self._document = self._document if verdict.document is None else verdict.document
        self._scene = self._scene if verdict.scene is None else verdict.scene
        self._refusal = verdict.refusal

    def change(self, text: str, *, stroke: bool = False) -> None:
        """Take another text; a state that is the same as now is none.

        Parameters
        ----------
        text : str
        stroke : bool
            Whether a value is being moved: the states of one stroke are undone together, and each waits for `keep_up`.

        Raises
        ------
        InputError
            If no case file can have it; the case stays as it is.
        """
        if check_text(text) == self.text:
            return
        kept = self._at + 1 - (stroke and self._stroke)
        self._states = [*self._states[:kept], text][-_STATES:]
        if len(text) > _CHARACTERS // _STATES:
            while len(self._states) > 2 and sum(map(len, self._states)) > _CHARACTERS:
                del self._states[0]
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
                "case", f'"{self.name}.toml"', f"invalid TOML: {error}", "correct the text first"
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
        self._judged, self._unkept, self.pending = False, True, False
        self.restored = ""
        if not (late or self.patient):
            self.keep_up()

    def keep_up(self) -> None:
        """Judge the case as it is now and keep it beyond a crash, where that has waited for something more urgent.

        What could not be kept is tried again.
        """
        if not self.heavy:
            self._judge_late()
        if not self._unkept:
            return
        try:
            if self.changed:
                self._journal.keep(Kept(self.text, str(self.folder), self.name, now(), self._file.digest))
            else:
                self._journal.forget()
            self._unkept = False
            self.trouble = ""
        except OSError as error:
            place = f" ({error.filename})" if error.filename else ""
            self.trouble = (
                f"Changes cannot be recovered after a crash: {error.strerror or error}{place}; free disk space."
            )

    def save(self, *, over_others: bool = False) -> None:
        """Write the text into its file, which is then whole at any moment.

        Raises
        ------
        InputError
            If it has no file, the file was changed by somebody else, or it cannot be written.
        """
        if self.path is None:
            raise InputError("case", self.name, "has no file yet", "save it first")
        path = self._within_reach(self.path)
        if not over_others and path.exists() and read_file(path, "case").digest != self._file.digest:
            raise OverwriteError(
                "case", shown(str(self.path), PATH), "was modified by another program since it was opened",
                "save under another name, or save again to overwrite it",
            )  # fmt: skip
        self._write(path)
        self._settled()

    def _within_reach(self, path: Path) -> Path:
        return path if self._reach is None else self._reach.check(path, "case")

    def save_as(self, path: Path, *, replace: bool = False) -> None:
        """Write the text into another file, which is the case's from then on.

        Raises
        ------
        InputError
            If the file is there already or its folder is not, or it cannot be written.
        """
        told = shown(str(path), PATH)
        if path.name in ("", ".."):
            raise InputError("case", told, "is a folder, not a file name", "add a file name")
        path = self._within_reach(path if path.suffix == ".toml" else path.with_name(f"{path.name}.toml"))
        if not os.path.isdir(path.parent):  # noqa: PTH112  (Path's own raises where a name is too long)
            raise InputError("case", told, "is in a folder that does not exist", "choose another, or create it first")
        if os.path.lexists(path) and not replace:
            raise OverwriteError("case", told, "already exists", "choose another name")
        self._write(path)
        self._journal.forget()
        self._journal = Journal(path)
        self._outdated = None  # of the file that it was before, with which it stays
        self.path, self.name, self.folder = path, path.stem, path.parent
        self._settled()
        self._judged = False

    def _write(self, path: Path) -> None:
        try:
            data = self._file.written(self.text)
        except UnicodeEncodeError:
            raise InputError(
                "case", f'"{self.name}"', "contains an invalid character (surrogate)", "correct the text"
            ) from None
        write_file(path, data, "case")
        self._file = self._file._replace(text=self.text, digest=digest_of(data))

    def _settled(self) -> None:
        """Keep nothing beside the file any more: it has what is open."""
        self._saved = self.text
        self._unkept, self.trouble = False, ""
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
            self._file = read_file(self._within_reach(self.path), "case")
            self._saved = self._file.text
            self.change(self._saved)
        self._settled()

    def leave(self) -> None:
        """Clear the desk: what is not saved is left behind for the next window."""
        self.keep_up()
        self._journal.leave()
