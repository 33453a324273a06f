"""The figures of a run: described, drawn, and the fields behind them written."""

from __future__ import annotations

import contextlib
from dataclasses import replace
from typing import TYPE_CHECKING, NamedTuple

from fegear.base.errors import MissingLibraryError
from fegear.engine.figure.figure import Figure
from fegear.output.fields import FOLDER, FieldFile, in_space, write_field
from fegear.output.picture_process import PictureProcess

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Mapping
    from concurrent.futures import Future
    from pathlib import Path

    from fegear.engine.outcome import Outcome
    from fegear.engine.run import Results
    from fegear.engine.stage import Task
    from fegear.geometry.gear import Gear
    from fegear.output.draw_png import Picture

    Pictures = tuple[Picture, ...] | None


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


def with_fields(results: Results) -> list[Drawn]:
    """The figures that cost something to describe and show a part of a field, without pictures."""
    deferred = (
        Drawn(task, figure.made())
        for task, outcome in results.outcomes.items()
        for figure in outcome.figures
        if not isinstance(figure, Figure)
    )
    return [one for one in deferred if one.figure.field is not None]


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
    spatial : mapping of str to Gear, optional
        Gears whose plane fields are drawn in space, too, by the names of the fields.
    kind : {"png", "svg", "pdf"}
        Of pictures; stress fields and 3D figures are PNG, as the report embeds them.

    Attributes
    ----------
    fields : list of FieldFile
        What was written for other programs, when finished.
    """

    def __init__(
        self,
        folder: Path,
        process: PictureProcess | None = None,
        case: str = "",
        spatial: Mapping[str, Gear] | None = None,
        kind: str = "png",
    ) -> None:
        self._kind = kind
        self._folder, self._process, self._case, self._spatial = folder, process, case, spatial or {}
        self.fields: list[FieldFile] = []
        self._begun: list[tuple[Task, Figure, Future[tuple[Picture, ...] | None] | None]] = []
        self._missing: list[str] = []

    def begin(self, task: Task, outcome: Outcome) -> None:
        """Describe the figures of a task, and have them drawn if there is a process for it."""
        self._folder.mkdir(exist_ok=True)
        for figure in outcome.figures:
            with self._remarked():
                made = replace(figure.made(), case=self._case)
                self._send(task, made)
                gear = self._spatial.get(made.field.name) if made.field else None
                spatial = None if gear is None else in_space(made, gear)
                if spatial is not None:
                    self._send(task, spatial)

    def _send(self, task: Task, figure: Figure) -> None:
        # What a picture shows of a field is in its panels; the field itself stays here.
        sent = (
            self._process.draw(replace(figure, field=None), self._folder, self._kind_of(figure))
            if self._process
            else None
        )
        self._begun.append((task, figure, sent))

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
        written = (write_field(figure, self._folder.parent / FOLDER) for _, figure, _ in self._begun)
        self.fields += [one for one in written if one]
        drawn: list[Drawn] = []
        for number, (task, figure, sent) in enumerate(self._begun, start=1):
            with self._remarked():
                drawn.append(Drawn(task, figure, (sent.result() if sent else None) or self._drawn_here(figure)))
            advance(number / len(self._begun))
        return drawn, self._missing

    def _drawn_here(self, figure: Figure) -> tuple[Picture, ...]:
        from fegear.output.draw_png import draw_pictures

        return tuple(draw_pictures(figure, self._folder, self._kind_of(figure)))

    def _kind_of(self, figure: Figure) -> str:
        return self._kind if figure.drawable_in_page else "png"

    @contextlib.contextmanager
    def _remarked(self) -> Iterator[None]:
        try:
            yield
        except MissingLibraryError as error:
            self._missing.append(f"{error}".rstrip(".") + ".")
