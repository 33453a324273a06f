"""The command line: every command stands in a module of `fegear.commands`."""

from __future__ import annotations

import os
import signal
import sys
from importlib import import_module
from keyword import iskeyword
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

import fegear
from fegear.base.errors import NO_ROOM, FegearError, lacks_memory
from fegear.base.interrupts import between_imports, heed_ctrl_c
from fegear.base.streams import give_up
from fegear.commands.help_texts import Command, Group, context_settings
from fegear.commands.terminal import INTERRUPTED, leave

if TYPE_CHECKING:
    from collections.abc import Sequence
    from types import FrameType


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"fegear {fegear.__version__}")
        raise typer.Exit


def _options(
    _show_version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Options of the program itself."""


#: The commands in the order of ``fegear --help``: name, module of `fegear.commands`, what the help says of it.
COMMANDS = (
    ("new", "new", "Write a commented case to start from."),
    ("import", "import_model", "Create a case from a REXS gearbox model."),
    ("migrate", "migrate", "Update a case file to the current key names."),
    ("open", "open", "Open the interactive workbench in the browser."),
    ("results", "schema", "List the available results."),
    ("run", "run", "Compute a case: tables, figures, report."),
    ("plan", "run", "Show the calculation plan and the estimated time."),
    ("compare", "studies", "Compare two runs or two cases."),
    ("sweep", "studies", "Parameter study over a grid of values."),
    ("size", "size", "Choose the teeth of a pair for a requirement."),
    ("effects", "studies", "Influence of each effect on the results."),
    ("cost", "studies", "Accuracy versus computing time."),
    ("check", "studies", "Independent FE solution (scikit-fem) of the spur gears, compared with the estimated errors."),
    ("verify", "verify", "Run the verification against published values, other programs and independent code."),
    ("apply", "apply", "Write a designed relief or lead correction into a case."),
    ("export", "export", "Export drawings, solids and meshes."),
    ("schema", "schema", "Write the JSON schema for editors."),
)


def program(words: Sequence[str] = ()) -> typer.Typer:
    """The program with the command that is called, or all of them where help, a slip or completion wants to know them.

    Modules and options of all commands would take a third of the time that the program needs to start.

    Parameters
    ----------
    words : sequence of str
        The command line after the program's name.
    """
    made = typer.Typer(
        help="Finite-element workbench for gear teeth.",
        no_args_is_help=True,
        pretty_exceptions_enable=False,
        rich_markup_mode=None,  # plain text: it can be searched, no option is cut short where the terminal is narrow
        cls=Group,
        context_settings=context_settings(),
        callback=_options,
    )
    called = [row for row in COMMANDS if list(words[:1]) == [row[0]]]
    for name, home, short in called or (() if list(words) == ["--version"] else COMMANDS):
        function = getattr(import_module(f"fegear.commands.{home}"), f"{name}_" if iskeyword(name) else name)
        made.command(name, cls=Command, short_help=short)(function)
    return made


_NO_MEMORY = (
    "out of memory; results of earlier runs are unchanged. Reduce the problem size or increase the memory limit."
)


def main() -> None:
    """Entry point: every foreseen error is one line on stderr and exit code 2; Ctrl-C is 130."""
    # The dense blocks of a sector are too small for threads: two take twice the work of one for no gain in time, and
    # on a busy machine they wait for each other. Set before numpy is loaded; a user's own choice stands.
    for library in ("OMP", "OPENBLAS", "MKL"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")
    _heed_requests_to_stop()
    try:
        program(sys.argv[1:])()
        sys.stdout.flush()
    except KeyboardInterrupt:
        leave(INTERRUPTED, 130)
    except _Stopped as request:
        leave(f"stopped by {request.name}; results of earlier runs are unchanged.", 128 + request.number)
    except FegearError as error:
        leave(str(error), 2)
    except MemoryError:
        leave(_NO_MEMORY, 2)
    except ImportError as error:
        if not lacks_memory(error):
            raise
        leave(_NO_MEMORY, 2)  # where memory ends while a library is loaded
    except OSError as error:
        give_up(sys.stdout)
        if lacks_memory(error):
            leave(_NO_MEMORY, 2)
        if error.errno not in NO_ROOM:
            if _nowhere():
                leave("the current folder no longer exists; change to another one.", 2)
            raise
        where = f" to {error.filename}" if error.filename else ""
        leave(f"cannot write{where} ({error.strerror}); existing output folders are intact.", 2)


def _nowhere() -> bool:
    """Whether the working folder has been deleted, on which whatever asks for it fails."""
    try:
        Path.cwd()
    except OSError:
        return True
    return False


class _Stopped(BaseException):
    """Somebody asked the program to end: a batch system, a terminal that was closed."""

    def __init__(self, number: int) -> None:
        self.number, self.name = number, signal.Signals(number).name


def _heed_requests_to_stop() -> None:
    """Let a request to stop end the program as Ctrl-C does, so that it clears away what is unfinished."""

    def stop(number: int, _frame: FrameType | None) -> None:
        signal.signal(number, signal.SIG_IGN)  # once is enough
        raise _Stopped(number)

    for name in ("SIGTERM", "SIGHUP"):
        if hasattr(signal, name) and signal.getsignal(getattr(signal, name)) == signal.SIG_DFL:
            signal.signal(getattr(signal, name), between_imports(stop))
    heed_ctrl_c()
