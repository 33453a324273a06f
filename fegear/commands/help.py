"""Help texts that stay readable in narrow terminals and in logs."""

from __future__ import annotations

import functools
import shutil
from typing import TYPE_CHECKING, Any

import typer.core

if TYPE_CHECKING:
    from collections.abc import Callable

#: Columns below which an option stands on a line of its own, with its meaning below it.
_NARROW = 60
#: Columns beyond which lines are tiring to read.
_WIDE = 100


def context_settings() -> dict[str, Any]:
    """What every command answers to, and how wide its help is."""
    # The full width of the terminal: left to itself the library takes at least fifty columns and lets lines break.
    return {"help_option_names": ["-h", "--help"], "terminal_width": min(shutil.get_terminal_size().columns, _WIDE)}


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
