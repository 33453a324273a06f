"""The figures of a run: described, drawn, and the fields behind them written."""

from __future__ import annotations

import contextlib
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

import numpy as np

from fegear.engine.figure import Figure, SolidMeshField
from fegear.errors import MissingLibraryError
from fegear.output.file_names import file_name

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from concurrent.futures import Future
    from pathlib import Path

    from fegear.engine.figure import MeshField
    from fegear.engine.outcome import Outcome
    from fegear.engine.run import Results
    from fegear.engine.stage import Task
    from fegear.output.draw_png import Picture
    from fegear.output.picture_process import PictureProcess


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


class Drawing:
    """The pictures of a run, begun as soon as there is something to draw.

    Parameters
    ----------
    folder : Path
        Made if needed.
    process : PictureProcess, optional
        Who draws; here, at the end, without.
    case : str
        Name that stands at the head of every picture.
    """

    def __init__(self, folder: Path, process: PictureProcess | None = None, case: str = "") -> None:
        self._folder, self._process, self._case = folder, process, case
        self._begun: list[tuple[Task, Figure, Future[tuple[Picture, ...] | None] | None]] = []
        self._missing: list[str] = []

    def begin(self, task: Task, outcome: Outcome) -> None:
        """Describe the figures of a task, and have them drawn if there is a process for it."""
        self._folder.mkdir(exist_ok=True)
        for figure in outcome.figures:
            with self._remarked():
                made = replace(figure.made(), case=self._case)
                # What a picture shows of a field is in its panels; the field itself stays here.
                sent = self._process.draw(replace(made, field=None), self._folder) if self._process else None
                self._begun.append((task, made, sent))

    def finish(self, advance: Callable[[float], None]) -> tuple[list[Drawn], list[str]]:
        """Write the fields, and wait for the pictures or draw them.

        Parameters
        ----------
        advance : callable
            Called with the fraction done.

        Returns
        -------
        drawn : list of Drawn
        missing : list of str
            Sentences about pictures that could not be drawn for want of a system library.
        """
        if self._process:
            self._process.close()
        for _, figure, _ in self._begun:
            if figure.field is not None:
                _write_field(figure.field, self._folder.parent / "fields")
        drawn: list[Drawn] = []
        for number, (task, figure, sent) in enumerate(self._begun, start=1):
            with self._remarked():
                drawn.append(Drawn(task, figure, (sent.result() if sent else None) or self._drawn_here(figure)))
            advance(number / len(self._begun))
        return drawn, self._missing

    def _drawn_here(self, figure: Figure) -> tuple[Picture, ...]:
        from fegear.output.draw_png import draw_pictures

        return tuple(draw_pictures(figure, self._folder))

    @contextlib.contextmanager
    def _remarked(self) -> Iterator[None]:
        try:
            yield
        except MissingLibraryError as error:
            self._missing.append(f"{error}".rstrip(".") + ".")


def _write_field(field: MeshField | SolidMeshField, folder: Path) -> None:
    """Write ``<name>.vtu`` for ParaView."""
    from fegear.fem.mesh_files import write_mesh_file, write_solid_file

    folder.mkdir(exist_ok=True)
    path = folder / f"{file_name(field.name)}.vtu"
    if isinstance(field, SolidMeshField):
        none = np.empty((20, 0), dtype=np.int64)
        write_solid_file(path, np.asarray(field.points), field.wedges, none, field.values)
        return
    write_mesh_file(
        path,
        np.asarray(field.points),
        field.triangles,
        {},
        field.values,
        single=True,
    )
