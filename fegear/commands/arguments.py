"""Arguments and options of commands that mean the same everywhere."""

from __future__ import annotations

import json
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer
import typer.core

if TYPE_CHECKING:
    from typer.models import OptionInfo


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
