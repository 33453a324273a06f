"""Help texts and lists that stay readable in narrow terminals and in logs."""

from __future__ import annotations

import functools
import shutil
import textwrap
from typing import TYPE_CHECKING, Any

import typer.core

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

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
    """A command whose help fits into any terminal."""

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Write the help."""
        _stacked(formatter)
        super().format_help(ctx, formatter)


class Group(typer.core.TyperGroup):
    """The program itself."""

    def format_help(self, ctx: Any, formatter: Any) -> None:
        """Write the help."""
        _stacked(formatter)
        super().format_help(ctx, formatter)
