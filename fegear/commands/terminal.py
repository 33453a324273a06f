"""What a command prints on the terminal: its lines, notes and progress, or JSON, and how it is left early."""

from __future__ import annotations

import contextlib
import json
import sys
from dataclasses import dataclass
from typing import TYPE_CHECKING, NoReturn

import typer

from fegear.base.notes import counted, open_and_folded
from fegear.base.streams import complain

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from contextlib import AbstractContextManager
    from pathlib import Path

    from fegear.base.notes import Note
    from fegear.engine.run import Watcher


INTERRUPTED = "interrupted; results of earlier runs are unchanged."


@dataclass(frozen=True)
class Voice:
    """What a command says, and where.

    Parameters
    ----------
    quiet : bool
        Nothing but notes, on stderr.
    as_json : bool
        One JSON object on stdout in place of words; notes are part of it.
    """

    quiet: bool = False
    as_json: bool = False

    def say(self, line: str) -> None:
        """Print a line for people."""
        if not (self.quiet or self.as_json):
            typer.echo(line)

    def aside(self, line: str) -> None:
        """Print a line beside the progress, which is no result (stderr)."""
        if not self.quiet:
            complain(line)

    def note(self, remark: str) -> None:
        """Print what the user should read."""
        if not self.as_json:
            (complain if self.quiet else typer.echo)(f"Note: {remark}")

    def notes(self, notes: Sequence[Note], where: str) -> None:
        """Print the notes to act on first, and how many of which class stand where."""
        shown, others = open_and_folded(notes)
        for one in shown:
            self.note(one)
        if others:
            self.note(f"{counted(others)} in {where}.")

    def tell(self, content: Mapping[str, object]) -> None:
        """Print what programs read."""
        if self.as_json:
            typer.echo(json.dumps(content, indent=2, ensure_ascii=False, allow_nan=False))

    def tell_folder(self, folder: Path) -> None:
        """Print the summary of an output folder, for programs."""
        if self.as_json:
            from fegear.output.folder import SUMMARY

            self.tell({"folder": str(folder), **json.loads((folder / SUMMARY).read_text("utf-8"))})

    def watcher(self, *, remaining: bool = False) -> AbstractContextManager[Watcher]:
        """Who shows the progress: a bar or lines on stderr, or nobody."""
        from fegear.engine.run import Silence
        from fegear.output.progress_bar import watcher

        return contextlib.nullcontext(Silence()) if self.quiet else watcher(sys.stderr, remaining=remaining)


def leave(message: str, code: int) -> NoReturn:
    """End the program with a sentence on stderr and an exit code."""
    complain(f"fegear: {message}")
    raise SystemExit(code)
