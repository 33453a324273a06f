"""``fegear open``: the live workbench."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fegear.commands.terminal import leave


def open(  # noqa: A001 - it is the name of the command
    case: Annotated[Path | None, typer.Argument(metavar="CASE", help="Case file (TOML). Default: templates.")] = None,
    port: Annotated[int | None, typer.Option("--port", help="Port. Default: a free port.")] = None,
    no_browser: Annotated[
        bool, typer.Option("--no-browser", help="Print the address without opening a browser.")
    ] = False,
    folder: Annotated[
        list[Path] | None,
        typer.Option(
            "--folder",
            metavar="FOLDER",
            help="Additional folder the page may read and write (besides the current one and that of CASE); "
            "repeatable.",
        ),
    ] = None,
    read_only_link: Annotated[
        bool, typer.Option("--read-only-link", help="Print a second, read-only address for viewers.")
    ] = False,
) -> None:
    """Open the live workbench in the browser: change a case and see the results follow.

    It listens on this machine alone, fetches nothing, and ends with Ctrl-C.
    """
    from fegear.window.server import serve

    try:
        serve(case, port, browser=not no_browser, say=typer.echo, folders=folder or (), look=read_only_link)
    except KeyboardInterrupt:
        leave("closed; unsaved changes are kept for the next start.", 130)
