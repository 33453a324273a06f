"""Jobs as they come in while another is being done; of the cases to compute the last one counts, and is told at once.

A thread reads the connection. Where what is being done is no longer wanted, it knocks: a signal of this process to
itself, which the interpreter delivers between two steps of the computation.

What the page asks of the computing process, and what comes back: plain data that travel between processes.
"""

from __future__ import annotations

import _thread
import signal
import threading
from collections import deque
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any, Literal, NamedTuple

from fegear.base.code_version import package_folder

if TYPE_CHECKING:
    from collections.abc import Callable
    from multiprocessing.connection import Connection
    from types import CodeType, FrameType


#: What the thread knocks with; on Windows the only one that it may.
_KNOCK = signal.Signals["SIGUSR1" if hasattr(signal, "SIGUSR1") else "SIGBREAK"]


#: How long it waits before it knocks again where nobody could answer [s].
_AGAIN = 0.05


#: Where fegear's own code lies.
_OWN = str(package_folder())


#: Code that must not be left half-way: a module half imported, a message half sent, a place half registered.
_WHOLE = ("<frozen importlib", "multiprocessing/connection.py", "threading.py", "/weakref.py", "/tempfile.py")


class Unwanted(BaseException):
    """The case that is being computed is no longer wanted; nothing on the way takes this for a failure of its own."""


class Inbox:
    """What is asked of a process over a connection.

    Parameters
    ----------
    connection : Connection

    Attributes
    ----------
    given_up : bool
        Whether what is watched has been told that it is unwanted; whatever ends it then, this is why.
    """

    def __init__(self, connection: Connection) -> None:
        self._connection = connection
        self._jobs: deque[Job] = deque()
        self._news, self._mouth = threading.Condition(), threading.Lock()
        self._ended = False
        self._unwanted: Callable[[Newer], bool] | None = None
        self._within: CodeType | None = None
        self.given_up = False

    def open(self) -> None:
        """Begin to listen; in the main thread, which alone is interrupted."""
        signal.signal(_KNOCK, self._knocked)
        threading.Thread(target=self._listen, daemon=True).start()

    def _listen(self) -> None:
        while True:
            try:
                while self.newest is not None and not self._connection.poll(_AGAIN):
                    self._knock()
                job = self._connection.recv()
            except (EOFError, OSError):
                with self._news:
                    self._ended = True
                    self._news.notify()
                return
            self.put(job)
            self._knock()

    def _knock(self) -> None:
        if self._unwanted is not None:
            _thread.interrupt_main(_KNOCK)

    def put(self, job: Job) -> None:
        """Lay a job to the others; cases that wait are no longer wanted if it is one."""
        with self._news:
            replaced = Job if isinstance(job, Stop) else Newer
            old = [one for one in self._jobs if isinstance(one, replaced)] if isinstance(job, Newer) else []
            for one in old:
                self._jobs.remove(one)
            self._jobs.append(job)
            self._news.notify()
        for one in old:
            self.say(Said(one.number, "dropped"))

    def take(self) -> Job:
        """The next job, as soon as there is one.

        Raises
        ------
        EOFError
            If nobody is there to ask.
        """
        with self._news:
            while not self._jobs and not self._ended:
                self._news.wait()
            if not self._jobs:
                raise EOFError
            return self._jobs.popleft()

    def wait(self, seconds: float) -> None:
        """Wait for another job."""
        with self._news:
            if not self._jobs and not self._ended:
                self._news.wait(seconds)

    def say(self, said: Said) -> None:
        """Answer."""
        with self._mouth:
            self._connection.send(said)

    @property
    def empty(self) -> bool:
        """Whether nothing waits to be done."""
        return not self._jobs

    @property
    def newest(self) -> Newer | None:
        """The case that waits to be computed, or the wish that none be."""
        return next((one for one in list(self._jobs) if isinstance(one, Newer)), None)

    def watch(self, unwanted: Callable[[Newer], bool] | None, within: CodeType | None = None) -> None:
        """Say who decides whether what is being done gives way to another case; None where it never does.

        `within` is the function that does it: outside of it, where its end is dealt with, nobody is interrupted.
        """
        self._unwanted, self._within = unwanted, within
        if unwanted is not None:
            self.given_up = False

    def look(self) -> None:
        """Give up what is being done if another case is wanted.

        Raises
        ------
        Unwanted
            If so.
        """
        newest = self.newest
        if self._unwanted is not None and (self.given_up or (newest is not None and self._unwanted(newest))):
            self.given_up = True
            raise Unwanted

    def _knocked(self, _signal: int, frame: FrameType | None) -> None:
        # Only in fegear's own code: a library's compiled code may take what is raised below it for something else.
        if frame is None or not frame.f_code.co_filename.startswith(_OWN):
            return
        inside = False
        while frame is not None:
            inside = inside or frame.f_code is self._within
            if any(name in frame.f_code.co_filename.replace("\\", "/") for name in _WHOLE):
                return  # the thread knocks again
            frame = frame.f_back
        if inside:
            self.look()


class Asked(NamedTuple):
    """A case as it is asked for.

    Attributes
    ----------
    text, name, folder : str
        Its text, its name, and where relative file names in it start.
    loosened : float
        Factor of its tolerance: 1 computes it as it is written.
    moving : bool
        Whether a value of it is being moved: its numbers are wanted at once, their errors when it stands still.
    sight : tuple of str
        Tasks whose results are in sight on a page: they are wanted before those that are not.
    shows : tuple of (str, str)
        Pair and kind of what is switched on at the gears in mesh.
    laid : int
        How many cases have lain on the desk before it: what was reported of those is forgotten.
    pictures : tuple of str or None
        Small pictures that are chosen at a glance (none: the usual ones); None where the case alone is wanted.
    field : bool
        Whether stress inside the teeth is shown.
    within : tuple of str, optional
        Folders below which the files lie that the case may name; None for anywhere.
    """

    text: str
    name: str
    folder: str
    loosened: float = 1.0
    moving: bool = False
    sight: tuple[str, ...] = ()
    shows: tuple[tuple[str, str], ...] = ()
    laid: int = 0
    pictures: tuple[str, ...] | None = None
    field: bool = False
    within: tuple[str, ...] | None = None


@dataclass(frozen=True, slots=True)
class Compute:
    """Compute a case for the page; a later one of these makes it unwanted."""

    number: int
    asked: Asked


@dataclass(frozen=True, slots=True)
class Stop:
    """Give up what is being done, whatever it is, and compute nothing."""

    number: int


@dataclass(frozen=True, slots=True)
class Export:
    """Write into a folder what a command writes.

    ``report``: all that ``fegear run`` writes; ``tables``: its tables only; else a format of ``fegear export``.
    """

    number: int
    asked: Asked
    what: str
    target: str


@dataclass(frozen=True, slots=True)
class Compare:
    """Compare a pinned case with another, as ``fegear compare`` does."""

    number: int
    first: Asked
    second: Asked


@dataclass(frozen=True, slots=True)
class Design:
    """Find reliefs of a pair by theory, as the result ``relief`` does.

    ``exact``: those that remove its transmission error (Mark, Eq. 4.6); ``ground``: the tip reliefs to grind that leave
    the least.
    """

    number: int
    asked: Asked
    pair: str
    how: Literal["exact", "ground"] = "exact"


Job = Compute | Stop | Export | Compare | Design
#: Of these the last one counts.
Newer = Compute | Stop


@dataclass(frozen=True, slots=True)
class Said:
    """What the computing process says of a job.

    Parameters
    ----------
    number : int
        The job's.
    what : str
        ``plan`` (tasks, in order), ``hands`` (gears in mesh, reliefs and loads that are changed by hand), ``begin`` (a
        task), ``advance`` (how far it is), ``found`` (a task's results), ``meshed`` (what is shown on the gears in
        mesh), ``picture``, ``done``, ``refused``, ``exported``, ``compared``, ``designed``, ``dropped`` (another is
        wanted) or ``stopped``.
    content : dict
        Plain data for the page.
    """

    number: int
    what: str
    content: dict[str, Any] = field(default_factory=dict)
