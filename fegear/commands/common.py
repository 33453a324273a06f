"""What the commands share: arguments that mean the same everywhere, what they print, and how one is left early.

Help texts and lists that stay readable in narrow terminals and in logs.
"""

from __future__ import annotations

import contextlib
import functools
import json
import re
import shutil
import sys
import textwrap
from dataclasses import dataclass
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any, NoReturn

import typer
import typer.core

from fegear.base.streams import complain

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping, Sequence
    from contextlib import AbstractContextManager

    from typer.models import OptionInfo

    from fegear.engine.run import Watcher


INTERRUPTED = "interrupted; results of earlier runs are as they were."


def _complete_results(incomplete: str) -> list[str]:
    """What may follow in a list of results that is being typed."""
    from fegear.results.catalogue import RESULTS

    before, comma, last = incomplete.rpartition(",")
    return [f"{before}{comma}{name}" for name in RESULTS if name.startswith(last)]


def complete_effects(incomplete: str) -> list[str]:
    """What an effect that is being typed may become."""
    from fegear.case.effects import EFFECTS

    return [name for name in sorted(EFFECTS) if name.startswith(incomplete)]


CaseFile = Annotated[Path, typer.Argument(metavar="CASE", help="Case file (TOML).")]


Overrides = Annotated[
    list[str] | None,
    typer.Option("--set", metavar="KEY=VALUE", help="Change a key of the case, e.g. --set gear.a.teeth=30."),
]


Wanted = Annotated[
    str | None,
    typer.Option(
        "--results",
        metavar="A,B",
        help="Compute these results in place of the case's; fegear results lists them.",
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


Out = Annotated[Path | None, out_option("Output folder; default results/<case>.")]


NoPlots = Annotated[bool, typer.Option("--no-plots", help="Draw nothing: tables, dataset and report alone.")]


Scheduler = Annotated[
    str | None,
    typer.Option("--scheduler", metavar="ADDRESS", help="A running Dask scheduler, e.g. tcp://10.0.0.5:8786."),
]


Quiet = Annotated[bool, typer.Option("--quiet", "-q", help="Print notes and errors alone, on stderr.")]


AsJson = Annotated[bool, typer.Option("--json", help="Print what was found as JSON on stdout, nothing else.")]


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

    def note(self, remark: str) -> None:
        """Print what the user should read."""
        if not self.as_json:
            (complain if self.quiet else typer.echo)(f"Note: {remark}")

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


#: Columns below which an option stands on a line of its own, with its meaning below it.
_NARROW = 60


#: Columns beyond which lines are tiring to read.
_WIDE = 100


def context_settings() -> dict[str, Any]:
    """What every command answers to, and how wide its help is."""
    # The full width of the terminal: left to itself the library takes at least fifty columns and lets lines break.
    return {"help_option_names": ["-h", "--help"], "terminal_width": _width()}


def _width() -> int:
    return min(shutil.get_terminal_size().columns, _WIDE)


def two_columns(rows: Sequence[tuple[str, str]], column: int) -> list[str]:
    """Lines of names with their meanings: beside each other, or below each other in a narrow terminal.

    Parameters
    ----------
    rows : sequence of (name, meaning)
    column : int
        Width of the column of names.
    """
    stacked = _width() < _NARROW
    indent = " " * (6 if stacked else column + 4)
    lines: list[str] = []
    for name, meaning in rows:
        told = textwrap.wrap(meaning, max(_width() - len(indent), 20), break_on_hyphens=False)
        lines += [f"  {name}"] if stacked else [f"  {name:<{column}}  {told.pop(0)}"]
        lines += [indent + line for line in told]
    return lines


def _stacked(formatter: Any) -> None:
    if formatter.width < _NARROW:
        write: Callable[..., None] = formatter.write_dl
        formatter.write_dl = functools.partial(write, col_max=4)


class Command(typer.core.TyperCommand):
    """A command whose help fits into any terminal, and whose options may take a number for each gear.

    ``--teeth 21 53`` is one value where the option says so by its metavar, ``N [N]``.
    """

    def parse_args(self, ctx: Any, args: list[str]) -> list[str]:
        """Bring numbers that follow one another behind such an option together."""
        several = {name for one in self.params if (one.metavar or "").endswith("]") for name in one.opts}
        words: list[str] = []
        for word in args:
            if len(words) > 1 and words[-2] in several and all(map(_is_number, (*words[-1].split(), word))):
                words[-1] += f" {word}"
            else:
                words.append(word)
        return super().parse_args(ctx, words)

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Write the help."""
        _stacked(formatter)
        super().format_help(ctx, formatter)


def _is_number(word: str) -> bool:
    return re.fullmatch(r"[-+]?([0-9]+\.?[0-9]*|\.[0-9]+)", word) is not None


@contextlib.contextmanager
def _one_line() -> Iterator[None]:
    """End with a line where no part of a command hears Ctrl-C, as while it loads what it needs."""
    try:
        yield
    except KeyboardInterrupt:  # typer would end with the code alone
        leave(INTERRUPTED, 130)


class Group(typer.core.TyperGroup):
    """The program itself."""

    def make_context(self, *names: Any, **more: Any) -> Any:
        """Read the options, for which a library is loaded."""
        with _one_line():
            return super().make_context(*names, **more)

    def invoke(self, ctx: Any) -> Any:
        """Run a command."""
        with _one_line():
            return super().invoke(ctx)

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Write the help."""
        _stacked(formatter)
        super().format_help(ctx, formatter)
