"""``fegear import``: a case from another program's model of a gearbox."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

from fegear.commands.arguments import Quiet
from fegear.commands.terminal import Voice
from fegear.exchange.importers import IMPORTERS

#: Kinds of models of fegear itself.
_KINDS = "; ".join(row.about for row in IMPORTERS.values())


def import_(
    model: Annotated[Path, typer.Argument(metavar="MODEL", help=f"{_KINDS}.", show_default=False)],
    out: Annotated[
        str | None, typer.Option("--out", metavar="CASE", help="Case file to write. Default: name of the model.")
    ] = None,
    load_case: Annotated[
        int | None, typer.Option("--load-case", metavar="N", help="Number of the load case. Default: first.")
    ] = None,
    spectrum: Annotated[
        bool | None,
        typer.Option(
            "--spectrum/--no-spectrum",
            help="Use all load cases as load spectrum for the ratings. Default: if all have a duration.",
            show_default=False,
        ),
    ] = None,
    kind: Annotated[
        str | None,
        typer.Option(
            "--as",
            metavar="KIND",
            help=f"Model format, if not recognised by the file extension. Default: {next(iter(IMPORTERS))}.",
        ),
    ] = None,
    unchecked: Annotated[
        bool, typer.Option("--unchecked", help="Write the case even if it cannot be computed.")
    ] = False,
    force: Annotated[bool, typer.Option("--force", help="Overwrite an existing file.")] = False,
    quiet: Quiet = False,
) -> None:
    """Write a commented case: gears, stages, shafts, bearings and loads of a gearbox, and what was assumed of each."""
    from fegear.case.text_file import write_file
    from fegear.commands.new import case_file
    from fegear.exchange.importers import importer_for

    voice = Voice(quiet)
    text = importer_for(model, kind).case_of(model, {"load_case": load_case, "spectrum": spectrum})
    if not unchecked:
        refuse_unplanned(text, model.name)
    path = case_file(out or model.stem.replace(".", "_"), force=force)
    write_file(path, text.encode(), "--out")
    notes = sum(line.startswith("# Note: ") for line in text.splitlines())
    voice.say(f"Wrote {path}, with {notes} notes at the end; next: fegear run {path} --cache")


def refuse_unplanned(text: str, name: str) -> None:
    """Refuse a model whose case `fegear plan` would refuse.

    Parameters
    ----------
    text : str
        The case.
    name : str
        Of the model's file.

    Raises
    ------
    InputError
        With what the plan says.
    """
    from fegear.base.errors import FegearError, InputError, shown
    from fegear.case.reading import build_scene, parse_document
    from fegear.engine.plan import make_plan
    from fegear.results.catalogue import STAGES

    try:
        make_plan(build_scene(parse_document(text, "(its text)"), "case", Path()), STAGES)
    except FegearError as error:
        rule = f"gives a case that cannot be computed: {str(error).rstrip('.')}"
        remedy = "correct the model, or import with --unchecked and correct the case"
        raise InputError("MODEL", shown(name), rule, remedy) from None


import_.__name__ = "import"  # the command's name, which is a word of Python
