"""The figures of a run: described, drawn, and the fields behind them written."""

from __future__ import annotations

from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.engine.figure import Figure
from fegear.errors import MissingLibraryError
from fegear.output.file_names import file_name

if TYPE_CHECKING:
    from collections.abc import Callable
    from pathlib import Path

    from fegear.engine.figure import MeshField
    from fegear.engine.run import Results
    from fegear.engine.stage import Task
    from fegear.output.draw_png import Picture


class Drawn(NamedTuple):
    """A figure, the task whose results it shows, and its pictures on disk, if any."""

    task: Task
    figure: Figure
    pictures: tuple[Picture, ...] = ()


def described(results: Results) -> list[Drawn]:
    """The figures that cost nothing to describe, without pictures."""
    return [
        Drawn(task, figure)
        for task, outcome in results.outcomes.items()
        for figure in outcome.figures
        if isinstance(figure, Figure)
    ]


def draw_all(results: Results, folder: Path, advance: Callable[[float], None]) -> tuple[list[Drawn], list[str]]:
    """Draw every figure of a run as PNG.

    Parameters
    ----------
    results : Results
    folder : Path
        Made if needed.
    advance : callable
        Called with the fraction done.

    Returns
    -------
    drawn : list of Drawn
    missing : list of str
        Sentences about pictures that could not be drawn for want of a system library.
    """
    from fegear.output.draw_png import draw_pictures

    folder.mkdir(exist_ok=True)
    found = [(task, figure) for task, outcome in results.outcomes.items() for figure in outcome.figures]
    drawn: list[Drawn] = []
    missing: list[str] = []
    for number, (task, figure) in enumerate(found, start=1):
        try:
            made = figure.made()
            if made.field is not None:
                _write_field(made.field, folder.parent / "fields")
            drawn.append(Drawn(task, made, tuple(draw_pictures(made, folder))))
        except MissingLibraryError as error:
            missing.append(f"{error}".rstrip(".") + ".")
        advance(number / len(found))
    return drawn, missing


def _write_field(field: MeshField, folder: Path) -> None:
    """Write ``<name>.vtu`` for ParaView."""
    from fegear.fem.mesh_files import write_mesh_file

    folder.mkdir(exist_ok=True)
    write_mesh_file(
        folder / f"{file_name(field.name)}.vtu",
        np.asarray(field.points),
        field.triangles,
        {},
        field.values,
        single=True,
    )
