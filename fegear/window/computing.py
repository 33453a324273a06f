"""The computing process seen from the page: asked, listened to, stopped where it does not listen, started again.

What a page has been told already, so that it is sent only what has become different.
"""

from __future__ import annotations

import contextlib
import threading
import time
from typing import TYPE_CHECKING, Any

from fegear.engine.processes import start_process
from fegear.window.job_queue import Compute, Newer, Said, Stop
from fegear.window.journal import Scratch

if TYPE_CHECKING:
    from collections.abc import Callable
    from multiprocessing.connection import Connection
    from multiprocessing.process import BaseProcess
    from pathlib import Path

    from fegear.window.job_queue import Job


#: What the process runs; loaded there, not here.
_WORKER = "fegear.window.worker"


#: A computation that is no longer wanted is stopped with its process if it has not noticed after this time [s].
PATIENCE = 5.0


#: A process that is asked to end is killed after this [s].
_GRACE = 2.0


class Computing:
    """One computing process at a time.

    Attributes
    ----------
    hear : callable or None
        Receives every `Said`, in a thread of its own; whoever asks for something sets it before.
    """

    def __init__(self) -> None:
        self.hear: Callable[[Said], None] | None = None
        self._scratch = Scratch()
        self._lock = threading.Lock()
        self._open: dict[int, Job] = {}
        self._unwanted: dict[int, float] = {}  # since when
        self._timer: threading.Timer | None = None
        self._closed = self._loaded = False
        self._process: BaseProcess
        self._connection: Connection
        self._start()

    @property
    def folder(self) -> Path:
        """A folder of this process, which no other account can look into; removed at the end."""
        return self._scratch.folder

    @property
    def pid(self) -> int | None:
        """Of the process that computes now."""
        return self._process.pid

    def _start(self) -> None:
        from multiprocessing import Pipe

        self._loaded = False
        self._connection, theirs = Pipe()
        self._process = start_process(_WORKER, theirs, str(self._scratch.folder))
        theirs.close()
        threading.Thread(target=self._listen, args=(self._connection, self._process), daemon=True).start()

    def ask(self, job: Job) -> None:
        """Hand a job over; a computation before it is given up if this is one, too."""
        with self._lock:
            if self._closed:
                return
            if isinstance(job, Newer):
                now = time.monotonic()
                for number, one in self._open.items():
                    if isinstance(one, Compute) or isinstance(job, Stop):
                        self._unwanted.setdefault(number, now)
                self._be_patient()
            self._open[job.number] = job
            with contextlib.suppress(OSError):
                self._connection.send(job)

    def _be_patient(self) -> None:
        """Look again when the computation that has been unwanted for longest should have noticed."""
        if self._timer is None and self._unwanted:
            self._timer = threading.Timer(min(self._unwanted.values()) + PATIENCE - time.monotonic(), self._insist)
            self._timer.daemon = True  # the end does not wait for it
            self._timer.start()

    def _insist(self) -> None:
        """Stop a process that still computes what nobody wants, and have another do what is."""
        with self._lock:
            self._timer = None
            if self._closed:
                return
            now = time.monotonic()
            if not self._loaded:  # it takes what is wanted as soon as it is there; another would be there later
                self._unwanted = dict.fromkeys(self._unwanted, now)
            elif any(now - since >= PATIENCE for since in self._unwanted.values()):
                for number in self._unwanted:
                    self._open.pop(number, None)
                self._again()
            self._be_patient()

    def _again(self) -> None:
        end(self._process)
        self._unwanted.clear()
        self._start()
        for job in self._open.values():
            with contextlib.suppress(OSError):
                self._connection.send(job)

    def _listen(self, connection: Connection, process: BaseProcess) -> None:
        while True:
            try:
                said: Said = connection.recv()
            except (EOFError, OSError):
                break
            if process is self._process:
                self._loaded = True
            if said.what in ("done", "refused", "dropped", "stopped", "exported", "compared", "designed"):
                with self._lock:
                    self._open.pop(said.number, None)
                    self._unwanted.pop(said.number, None)
            if self.hear is not None:
                self.hear(said)
        with self._lock:
            if self._closed or process is not self._process:
                return
            lost = list(self._open)  # it died by itself: what it was at would kill the next one, too
            self._open.clear()
            self._again()
        for number in lost:
            if self.hear is not None:
                self.hear(Said(number, "refused", {"sentence": "Computation terminated unexpectedly (out of memory?).",
                                                   "key": ""}))  # fmt: skip

    def close(self) -> None:
        """End the process and remove what it kept."""
        with self._lock:
            self._closed = True
            if self._timer is not None:
                self._timer.cancel()
            end(self._process)
        self._scratch.remove()


def end(process: BaseProcess) -> None:
    """Ask a process to end, and see to it."""
    process.terminate()
    process.join(_GRACE)
    if process.is_alive():
        process.kill()
        process.join(_GRACE)


_Content = dict[str, Any]


#: What stands for all of a figure that is to stay as it is.
SAME = {"same": True}


class Sent:
    """What was sent last, by task; a figure that is the same again travels as its key alone."""

    def __init__(self) -> None:
        self._figures: dict[tuple[str, str], _Content] = {}
        self._empty: set[str] = set()

    def news(self, content: _Content) -> _Content | None:
        """What of a task's results is different from what was sent last; None where it has nothing to show, again.

        Parameters
        ----------
        content : dict
            Of ``found``; `whole` is the reverse.
        """
        if not (content["figures"] or content["values"] or content["loads"]):
            if content["task"] in self._empty:
                return None
            self._empty.add(content["task"])
        else:
            self._empty.discard(content["task"])
        figures = []
        for one in content["figures"]:
            if one.get("same"):
                figures.append(one)
                continue
            place = content["task"], one["key"]
            figures.append({"key": one["key"], **SAME} if self._figures.get(place) == one else one)
            self._figures[place] = one
        return {**content, "figures": figures}

    def knows(self, task: str, figure: str = "") -> bool:
        """Whether a figure was sent before, or any of the task."""
        return (task, figure) in self._figures if figure else any(of == task for of, _ in self._figures)

    def forget_others(self, tasks: list[str]) -> None:
        """Forget what is on the page no longer."""
        self._figures = {place: text for place, text in self._figures.items() if place[0] in tasks}
        self._empty &= set(tasks)


def whole(content: _Content, before: _Content | None) -> _Content:
    """Results of a task with all figures and values, those that were not sent again from what was known before."""
    known = {one["key"]: one for one in (before or {}).get("figures", ())}
    figures = [known[one["key"]] if one.get("same") else one for one in content["figures"]]
    values = {"values": (before or {}).get("values", "")} if content.get("values", "") is None else {}
    return {**content, "figures": figures, **values}


def with_gears(content: _Content, before: _Content | None) -> _Content:
    """What changes by hand, with the gears in mesh, or all else, where they were not sent again."""
    known = (before or {}).get("pairs", {})
    pairs = {
        name: {**known.get(name, {}), **one, "mesh": one["mesh"] or known.get(name, {}).get("mesh")}
        for name, one in content["pairs"].items()
    }
    return {**content, "pairs": pairs}
