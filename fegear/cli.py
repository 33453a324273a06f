"""The command line: every command stands in a module of `fegear.commands`."""

from __future__ import annotations

import os
from typing import Annotated

import typer

import fegear
from fegear.commands.common import INTERRUPTED, leave
from fegear.commands.cost import cost
from fegear.commands.effects import effects
from fegear.commands.export import export
from fegear.commands.plan import plan
from fegear.commands.run import run
from fegear.commands.sweep import sweep
from fegear.errors import FegearError

app = typer.Typer(
    help="Finite-element workbench for gear teeth.",
    no_args_is_help=True,
    add_completion=False,
    pretty_exceptions_enable=False,
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


for _command in (run, plan, cost, sweep, effects, export):  # in the order of ``fegear --help``
    app.command()(_command)


def main() -> None:
    """Entry point: every foreseen error is one line on stderr and exit code 2; Ctrl-C is 130."""
    # The dense blocks of a sector are too small for threads: two take twice the work of one for no gain in time, and
    # on a busy machine they wait for each other. Set before numpy is loaded; a user's own choice stands.
    for library in ("OMP", "OPENBLAS", "MKL"):
        os.environ.setdefault(f"{library}_NUM_THREADS", "1")
    try:
        app()
    except KeyboardInterrupt:
        leave(INTERRUPTED, 130)
    except FegearError as error:
        leave(str(error), 2)
