"""How a run shows its progress: a progress bar on a terminal, plain lines elsewhere."""

from __future__ import annotations

import contextlib
import time
from typing import TYPE_CHECKING, Any, TextIO

from fegear.base.printed import percent

if TYPE_CHECKING:
    from collections.abc import Iterator

    from rich.progress import Progress, TaskID

    from fegear.engine.run import Watcher


#: Seconds between two signs of life in a notebook.
_OFTEN = 0.2


#: Seconds after which a log is told how far a stage is, and again.
_LONG = 60.0


class PlainLines:
    """One line per finished stage, for logs and pipes; of a long stage every minute how far it is."""

    def __init__(self, stream: TextIO) -> None:
        self._stream, self._title = stream, ""
        self._begun = self._said = time.monotonic()

    def begin(self, title: str, number: int, count: int) -> None:
        """Remember the title; a line appears when the stage is finished."""
        self._title = f"[{number}/{count}] {title}"
        self._begun = self._said = time.monotonic()

    def advance(self, fraction: float) -> None:
        """Say of a long stage how far it is, and how long it has taken."""
        if (now := time.monotonic()) - self._said >= _LONG:
            self._said = now
            self._write(f"{percent(fraction, whole=True)} after {(now - self._begun) / 60.0:.0f} min")

    def end(self, seconds: float) -> None:
        """Write the line."""
        self._write(f"{seconds:.2f} s")

    def _write(self, text: str) -> None:
        with contextlib.suppress(OSError, ValueError):  # a log that is full or closed takes no run with it
            self._stream.write(f"{self._title}: {text}\n")
            self._stream.flush()


class Bar:
    """A bar per stage that stays on the terminal with the stage's seconds."""

    def __init__(self, progress: Progress) -> None:
        self._progress = progress
        self._task: TaskID | None = None

    def begin(self, title: str, number: int, count: int) -> None:
        """Add a bar."""
        self._task = self._progress.add_task(f"[{number}/{count}] {title}".replace("[", r"\["), total=1.0)

    def advance(self, fraction: float) -> None:
        """Move the bar."""
        if self._task is not None:
            self._progress.update(self._task, completed=fraction)

    def end(self, seconds: float) -> None:  # noqa: ARG002  (rich shows the seconds it measured itself)
        """Fill the bar."""
        self.advance(1.0)


class NotebookLine:
    """One line in the output of a notebook's cell, which changes in place and says at the end what it took."""

    def __init__(self) -> None:
        from IPython.display import display

        self._handle: Any = display({"text/plain": ""}, raw=True, display_id=True)
        self._title, self._said, self._steps, self._seconds = "", 0.0, 0, 0.0

    def _say(self, text: str) -> None:
        self._handle.update({"text/plain": text}, raw=True)

    def begin(self, title: str, number: int, count: int) -> None:
        """Name the stage."""
        self._title = f"[{number}/{count}] {title}"
        self._say(self._title)

    def advance(self, fraction: float) -> None:
        """Say how far it is, a few times a second."""
        if time.monotonic() - self._said > _OFTEN:
            self._said = time.monotonic()
            self._say(f"{self._title}: {100.0 * fraction:.0f} %")

    def end(self, seconds: float) -> None:
        """Count it."""
        self._steps, self._seconds = self._steps + 1, self._seconds + seconds
        self._say(f"{self._steps} step{'' if self._steps == 1 else 's'} in {self._seconds:.2f} s")


@contextlib.contextmanager
def watcher(stream: TextIO, *, remaining: bool = False, notebook: bool = False) -> Iterator[Watcher]:
    """Give the watcher that suits a stream.

    Parameters
    ----------
    stream : text stream
    remaining : bool
        Whether a bar predicts the time that is left, which makes sense for many alike steps.
    notebook : bool
        Whether the output is that of a notebook's cell and not the stream.
    """
    if notebook:
        yield NotebookLine()
        return
    if not stream.isatty():
        yield PlainLines(stream)
        return
    from rich.console import Console
    from rich.progress import BarColumn, Progress, TextColumn, TimeElapsedColumn, TimeRemainingColumn

    columns = (TextColumn("{task.description}"), BarColumn(bar_width=30), TimeElapsedColumn())
    ahead = (TextColumn("remaining"), TimeRemainingColumn(elapsed_when_finished=False)) if remaining else ()
    with Progress(*columns, *ahead, console=Console(file=stream)) as progress:
        yield Bar(progress)
