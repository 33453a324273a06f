"""The command line: every command stands in a module of `fegear.commands`."""

from __future__ import annotations

import copy
import os
import signal
import sys
from pathlib import Path
from typing import TYPE_CHECKING, Annotated, Any

import typer

import fegear
from fegear.base.errors import NO_ROOM, FegearError, lacks_memory
from fegear.base.interrupts import between_imports, heed_ctrl_c
from fegear.base.streams import give_up
from fegear.commands.apply import apply
from fegear.commands.common import INTERRUPTED, leave
from fegear.commands.export import export
from fegear.commands.help_texts import Command, Group, context_settings
from fegear.commands.import_model import import_
from fegear.commands.migrate import migrate
from fegear.commands.new import new
from fegear.commands.open import open  # noqa: A004  (the name of the command)
from fegear.commands.run import plan, run
from fegear.commands.schema import results, schema
from fegear.commands.size import size
from fegear.commands.studies import check, compare, cost, effects, sweep
from fegear.commands.verify import verify

if TYPE_CHECKING:
    from types import FrameType


class _Program(typer.Typer):
    """The program, which reads the options of the one command that is called.

    Those of all would take a quarter of the time that the program needs to start.
    """

    def __call__(self, args: Any = None, **more: Any) -> Any:
        """Run the command line, by default that of the process."""
        words = sys.argv[1:] if args is None else args
        called = [one for one in self.registered_commands if words and _name(one) == words[0]]
        if not called:  # help, a slip, completion: what there is must be known
            return super().__call__(args, **more)
        alone = copy.copy(self)
        alone.registered_commands = called
        return super(_Program, alone).__call__(args, **more)


def _name(command: typer.models.CommandInfo) -> str:
    """What a command is called by; Python keeps some words for itself."""
    return command.callback.__name__.rstrip("_") if command.callback else ""


app = _Program(
    help="Finite-element workbench for gear teeth.",
    no_args_is_help=True,
    pretty_exceptions_enable=False,
    rich_markup_mode=None,  # plain text: it can be searched, and no option is cut short where the terminal is narrow
    cls=Group,
    context_settings=context_settings(),
)


def _version(wanted: bool) -> None:
    if wanted:
        typer.echo(f"fegear {fegear.__version__}")
        raise typer.Exit


@app.callback()
def _options(
    _show_version: Annotated[
        bool, typer.Option("--version", callback=_version, is_eager=True, help="Print the version.")
    ] = False,
) -> None:
    """Options of the program itself."""


#: The commands in the order of ``fegear --help``, and what it says of each.
COMMANDS = (
    (new, "Write a commented case to start from."),
    (import_, "Create a case from a REXS gearbox model."),
    (migrate, "Update a case file to the current key names."),
    (open, "Open the interactive workbench in the browser."),
    (results, "List the available results."),
    (run, "Compute a case: tables, figures, report."),
    (plan, "Show the calculation plan and the estimated time."),
    (compare, "Compare two runs or two cases."),
    (sweep, "Parameter study over a grid of values."),
    (size, "Choose the teeth of a pair for a requirement."),
    (effects, "Influence of each effect on the results."),
    (cost, "Accuracy versus computing time."),
    (check, "Independent FE solution (scikit-fem) of the spur gears, compared with the estimated errors."),
    (verify, "Run the verification against published values, other programs and independent code."),
    (apply, "Write a designed relief or lead correction into a case."),
    (export, "Export drawings, solids and meshes."),
    (schema, "Write the JSON schema for editors."),
)

for _command, _short in COMMANDS:
    app.command(cls=Command, short_help=_short)(_command)


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
        app()
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
