"""A second process that draws, so that one core makes pictures while another computes.

A copy of it, made once its libraries are loaded, draws every other figure: when nothing is left to compute, both cores
draw.

Nothing depends on it: where there is none (a single core, no processes, one that died) the same figures are drawn in
this process, to the same bytes.
"""

from __future__ import annotations

import contextlib
import gc
import os
import pickle
import signal
import subprocess
import sys
from concurrent.futures import Future, ThreadPoolExecutor
from dataclasses import dataclass
from queue import SimpleQueue
from typing import IO, TYPE_CHECKING

if TYPE_CHECKING:
    from pathlib import Path

    from fegear.engine.figure.figure import Figure
    from fegear.output.draw_png import Picture

    Pictures = tuple[Picture, ...] | None


#: What the other process runs, with the search path of this one. Not multiprocessing's: that would load the main
#: module once more, and run a script whose main part nothing guards a second time.
_PROGRAM = (
    "import sys; copy = [int(one) for one in sys.argv[1].split()]; sys.path[:] = sys.argv[2:]; "
    "from fegear.output.picture_process import serve; serve(*copy)"
)


@dataclass(frozen=True)
class _Line:
    """Both ends of what is said with one process that draws, one figure at a time."""

    requests: IO[bytes]
    answers: IO[bytes]

    def drawn(self, figure: Figure, folder: Path, kind: str = "png") -> Pictures:
        """Have a figure drawn; None if that fails."""
        try:
            # Whole before it is sent: half of one would confuse the other side.
            request = pickle.dumps((figure, folder, kind))
            self.requests.write(request)
            self.requests.flush()
            return pickle.load(self.answers)  # noqa: S301  (our own process's answer)
        except (OSError, EOFError, ValueError, TypeError, AttributeError, pickle.PickleError):
            return None

    def close(self) -> None:
        """Hang up."""
        for pipe in (self.requests, self.answers):
            with contextlib.suppress(OSError):  # what was not read any more
                pipe.close()


class PictureProcess:
    """Draws figures in another process and its copy, begun in the order in which they are sent.

    A context: leaving it ends the process and its copy, whatever they are doing.
    """

    def __init__(self) -> None:
        self._child, self._lines = _started()
        self._talk = ThreadPoolExecutor(max(len(self._lines), 1))
        self._free: SimpleQueue[_Line | None] = SimpleQueue()
        for line in self._lines or (None,):
            self._free.put(line)

    def __enter__(self) -> PictureProcess:
        """Itself."""
        return self

    def __exit__(self, *_problem: object) -> None:
        """End it."""
        if self._child is not None:
            _end(self._child)
        self._talk.shutdown(wait=True, cancel_futures=True)
        if self._child is not None:
            self._child.wait()
        for line in self._lines:
            line.close()

    def draw(self, figure: Figure, folder: Path, kind: str = "png") -> Future[Pictures]:
        """Begin to draw a figure into a folder, as ``png``, ``svg`` or ``pdf``; None if it must be drawn here instead.

        Whatever goes wrong there shows itself again, in its own words, when the figure is drawn here.
        """
        return self._talk.submit(self._drawn, figure, folder, kind)

    def _drawn(self, figure: Figure, folder: Path, kind: str) -> Pictures:
        line = self._free.get()
        try:
            return None if line is None else line.drawn(figure, folder, kind)
        finally:
            self._free.put(line)


def _pays() -> bool:
    """Whether a second process saves time: not on one core, nor where matplotlib is loaded already."""
    from fegear.engine.processes import cores  # late: the process that draws asks for none of its rooms

    return cores() > 1 and "matplotlib" not in sys.modules


def _started() -> tuple[subprocess.Popen[bytes] | None, list[_Line]]:
    """Start the process, with lines to it and to its copy; nothing where it would not pay or cannot be had."""
    if not _pays() or not sys.executable or getattr(sys, "frozen", False):
        return None, []
    # Only on Linux may a process that has loaded its libraries be copied, whatever these are.
    its, lines = _line_to_copy() if sys.platform == "linux" else ((), [])
    try:
        child = subprocess.Popen(  # noqa: S603  (this Python, running this program)
            [sys.executable, "-c", _PROGRAM, " ".join(map(str, its)), *sys.path],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            pass_fds=its,
            # Ctrl-C on the terminal is this process's business.
            start_new_session=True,
            creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),
        )
    except OSError:
        for line in lines:
            line.close()
        return None, []
    finally:
        for end in its:
            os.close(end)
    return child, [_Line(child.stdin, child.stdout), *lines]  # type: ignore[arg-type]  # both are pipes


def _line_to_copy() -> tuple[tuple[int, ...], list[_Line]]:
    """The ends of a copy, its requests and its answers, and the line to it; nothing where no pipe is left."""
    try:
        its_requests, requests = os.pipe()
    except OSError:
        return (), []
    try:
        answers, its_answers = os.pipe()
    except OSError:
        for end in (its_requests, requests):
            os.close(end)
        return (), []
    return (its_requests, its_answers), [_Line(os.fdopen(requests, "wb"), os.fdopen(answers, "rb"))]


def _end(child: subprocess.Popen[bytes]) -> None:
    """End the process and its copy, which is of its session."""
    if sys.platform == "linux":
        with contextlib.suppress(ProcessLookupError):
            os.killpg(child.pid, signal.SIGKILL)
    child.kill()


def serve(*copy: int) -> None:
    """Draw what arrives on stdin and answer on stdout, until stdin ends: the other side of `PictureProcess`.

    Parameters
    ----------
    *copy : int
        Descriptors on which requests come to a copy of the process, and its answers go.
    """
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    gc.disable()
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints is no answer
    from fegear.output.draw_png import warm_up

    warm_up()
    gc.freeze()  # what is loaded stays: looking for cycles in it took a twelfth of the time until all was
    gc.set_threshold(100_000)  # as in the program itself; what is drawn is freed figure by figure
    gc.enable()
    if copy:
        with contextlib.suppress(OSError):  # where no copy is to be had, this process draws what it can
            if os.fork() == 0:  # it holds no end of a pipe that the other process reads or writes
                os.dup2(copy[0], 0)
                os.dup2(copy[1], answers.fileno())
        for end in copy:
            os.close(end)
    with contextlib.suppress(EOFError, pickle.UnpicklingError, BrokenPipeError):  # until the other side ends
        while True:
            figure, target, kind = pickle.load(sys.stdin.buffer)  # noqa: S301  (from the process that started this one)
            pickle.dump(_pictures(figure, target, kind), answers)
            answers.flush()
    gc.freeze()


def _pictures(figure: Figure, folder: Path, kind: str) -> Pictures:
    from fegear.output.draw_png import draw_pictures

    try:
        return tuple(draw_pictures(figure, folder, kind))
    except Exception:  # noqa: BLE001  (the other side draws it again and reports what is wrong)
        return None
