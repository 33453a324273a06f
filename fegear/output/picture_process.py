"""A second process that draws, so that one core makes pictures while another computes.

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
from typing import TYPE_CHECKING

from fegear.engine.figure.figure import Figure
from fegear.engine.processes import cores

if TYPE_CHECKING:
    from pathlib import Path

    from fegear.output.draw_png import Picture

    Pictures = tuple[Picture, ...] | None


#: What the other process runs, with the search path of this one. Not multiprocessing's: that would load the main
#: module once more, and run a script whose main part nothing guards a second time.
_PROGRAM = "import sys; sys.path[:] = sys.argv[1:]; from fegear.output.picture_process import serve; serve()"


class PictureProcess:
    """Draws figures in another process, one after the other, in the order in which they are sent.

    A context: leaving it ends the process, whatever it is doing.
    """

    def __init__(self) -> None:
        self._child = _started()
        self._talk = ThreadPoolExecutor(1)

    def __enter__(self) -> PictureProcess:
        """Itself."""
        return self

    def __exit__(self, *_problem: object) -> None:
        """End it."""
        if self._child is not None:
            self._child.kill()
        self._talk.shutdown(wait=True, cancel_futures=True)
        if self._child is not None:
            self._child.wait()
            for pipe in (self._child.stdin, self._child.stdout):
                with contextlib.suppress(OSError):  # what was not read any more
                    pipe.close()  # type: ignore[union-attr]  # both are pipes

    def draw(self, figure: Figure, folder: Path) -> Future[Pictures]:
        """Begin to draw a figure into a folder; the pictures are None if it must be drawn here instead.

        Whatever goes wrong there shows itself again, in its own words, when the figure is drawn here.
        """
        return self._talk.submit(self._drawn, figure, folder)

    def close(self) -> None:
        """Send no more figures: the process may end."""
        if self._child is not None:
            self._talk.submit(self._child.stdin.close)  # type: ignore[union-attr]  # a pipe

    def _drawn(self, figure: Figure, folder: Path) -> Pictures:
        if self._child is None:
            return None
        try:
            request = pickle.dumps(
                (figure, folder)
            )  # whole before it is sent: half of one would confuse the other side
            self._child.stdin.write(request)  # type: ignore[union-attr]  # a pipe
            self._child.stdin.flush()  # type: ignore[union-attr]  # a pipe
            return pickle.load(self._child.stdout)  # type: ignore[arg-type]  # noqa: S301  (our own process's answer)
        except (OSError, EOFError, ValueError, TypeError, AttributeError, pickle.PickleError):
            return None


def _pays() -> bool:
    """Whether a second process saves time: not on one core, nor where matplotlib is loaded already."""
    return cores() > 1 and "matplotlib" not in sys.modules


def _started() -> subprocess.Popen[bytes] | None:
    """Start the process; none where it would not pay or cannot be had."""
    if not _pays() or not sys.executable or getattr(sys, "frozen", False):
        return None
    try:
        return subprocess.Popen(  # noqa: S603  (this Python, running this program)
            [sys.executable, "-c", _PROGRAM, *sys.path],
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
            # Ctrl-C on the terminal is this process's business.
            start_new_session=True,
            creationflags=getattr(subprocess, "CREATE_NEW_PROCESS_GROUP", 0),
        )
    except OSError:
        return None


def serve() -> None:
    """Draw what arrives on stdin and answer on stdout, until stdin ends: the other side of `PictureProcess`."""
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    gc.set_threshold(100_000)  # as in the program itself; what is drawn is freed figure by figure
    answers = os.fdopen(os.dup(1), "wb")
    os.dup2(2, 1)  # what a library prints is no answer
    from fegear.output.draw_png import warm_up

    warm_up()
    with contextlib.suppress(EOFError, pickle.UnpicklingError, BrokenPipeError):  # until the other side ends
        while True:
            figure, target = pickle.load(sys.stdin.buffer)  # noqa: S301  (from the process that started this one)
            pickle.dump(_pictures(figure, target), answers)
            answers.flush()
    gc.freeze()


def _pictures(figure: Figure, folder: Path) -> Pictures:
    from fegear.output.draw_png import draw_pictures

    try:
        return tuple(draw_pictures(figure, folder))
    except Exception:  # noqa: BLE001  (the other side draws it again and reports what is wrong)
        return None
