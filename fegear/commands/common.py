"""What the commands share: arguments that mean the same everywhere, what they print, and how one is left early."""

from __future__ import annotations

import contextlib
import json
import sys
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, NoReturn

import typer
import typer.core

from fegear.base.notes import counted, open_and_folded
from fegear.base.streams import complain

if TYPE_CHECKING:
    from collections.abc import Mapping, Sequence
    from contextlib import AbstractContextManager

    from typer.models import OptionInfo

    from fegear.base.notes import Note
    from fegear.engine.run import Watcher


INTERRUPTED = "interrupted; results of earlier runs are unchanged."


def _complete_results(incomplete: str) -> list[str]:
    """What may follow in a list of results that is being typed."""
    from fegear.results.catalogue import RESULTS

    before, comma, last = incomplete.rpartition(",")
    return [f"{before}{comma}{name}" for name in RESULTS if name.startswith(last)]


def complete_effects(incomplete: str) -> list[str]:
    """What an effect that is being typed may become."""
    from fegear.base.effects import EFFECTS

    return [name for name in sorted(EFFECTS) if name.startswith(incomplete)]


CaseFile = Annotated[Path, typer.Argument(metavar="CASE", help="Case file (TOML).")]


Overrides = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Override a key of the case, e.g. --set gear.a.teeth=30."),
]


Wanted = Annotated[
    str | None,
    typer.Option(
        "--results",
        metavar="A,B",
        help="Results to compute instead of those in the case (see fegear results).",
        autocompletion=_complete_results,
    ),
]


def named(text: str) -> Path:
    """Path of an option; a text that can be none is refused."""
    from fegear.case.text_file import named_path

    return named_path(text, "--out")


def out_option(about: str) -> OptionInfo:
    """The option ``--out`` with its meaning."""
    return typer.Option("--out", help=about, parser=named, metavar="PATH")


Out = Annotated[Path | None, out_option("Output folder. Default: results/<case>.")]


NoPlots = Annotated[bool, typer.Option("--no-plots", help="No figures; tables, dataset and report only.")]


def picture_kind(text: str) -> str:
    """Format of pictures of an option; another is refused."""
    from fegear.base.errors import InputError, shown
    from fegear.output.draw_png import KINDS

    if text not in KINDS:
        raise InputError("--plots", shown(text), "is not a supported figure format", "choose png, svg or pdf")
    return text


Plots = Annotated[
    str | None,
    typer.Option(
        "--plots",
        metavar="FORMAT",
        parser=picture_kind,
        help="Format of the figures in plots/: png, svg or pdf; stress fields and 3D figures stay png. Default: png.",
    ),
]


Scheduler = Annotated[
    str | None,
    typer.Option(
        "--scheduler", metavar="ADDRESS", help="Address of a running Dask scheduler, e.g. tcp://10.0.0.5:8786."
    ),
]


Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print notes and errors only (stderr).")]


AsJson = Annotated[bool, typer.Option("--json", help="Print the results as JSON only (stdout).")]


def changes(overrides: list[str] | None, results: str | None = None) -> list[str]:
    """Overrides of a case: those of ``--set``, and ``--results a,b`` as one of them."""
    found = list(overrides or ())
    if results is not None:
        names = [name.strip() for name in results.split(",")]
        found.append(f"results={json.dumps([name for name in names if name])}")
    return found


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
            self.note(f"{counted(others)} ({where}).")

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
        from fegear.output.terminal import watcher

        return contextlib.nullcontext(Silence()) if self.quiet else watcher(sys.stderr, remaining=remaining)


def leave(message: str, code: int) -> NoReturn:
    """End the program with a sentence on stderr and an exit code."""
    complain(f"fegear: {message}")
    raise SystemExit(code)
