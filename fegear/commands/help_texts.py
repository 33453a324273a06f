"""Help texts and lists that stay readable in narrow terminals and in logs."""

from __future__ import annotations

import contextlib
import functools
import re
import shutil
import textwrap
from typing import TYPE_CHECKING, Any

import typer
import typer.core

from fegear.commands.terminal import INTERRUPTED, leave

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence


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
