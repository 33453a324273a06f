"""Ctrl-C and requests to stop, heard where Python can raise what they ask for."""

from __future__ import annotations

import os
import signal
import threading
from collections.abc import Callable, Iterable, Iterator
from contextlib import contextmanager
from types import FrameType

Heard = Callable[[int, FrameType | None], object]
#: How long a request waits for an import to go on [s].
_LATER = 0.02
#: What asks a program to end.
REQUESTS_TO_STOP = tuple(getattr(signal, n) for n in ("SIGINT", "SIGTERM", "SIGHUP") if hasattr(signal, n))
#: What a script may make raise besides: its timers, and what others send it.
OF_SCRIPTS = tuple(
    getattr(signal, n) for n in ("SIGALRM", "SIGVTALRM", "SIGPROF", "SIGUSR1", "SIGUSR2") if hasattr(signal, n)
)


@contextmanager
def deaf(numbers: Iterable[int] = REQUESTS_TO_STOP) -> Iterator[None]:
    """Let signals to this thread wait meanwhile, on systems that can; a thread that it starts is deaf to them for good.

    What waits is heard at the end of the block, or by a thread that is not deaf.
    """
    mask = getattr(signal, "pthread_sigmask", None)
    if mask is None:
        yield
        return
    before = mask(signal.SIG_BLOCK, numbers)
    try:
        yield
    finally:
        mask(signal.SIG_SETMASK, before)


def between_imports(act: Heard) -> Heard:
    """Let a handler of signals act beside imports, which let go of their locks in callbacks of weak references.

    What is raised in such a callback is printed and lost.
    """

    def heard(number: int, frame: FrameType | None) -> None:
        if frame is not None and frame.f_code.co_filename.startswith("<frozen importlib"):
            with deaf():
                threading.Timer(_LATER, _sent_again, [number]).start()
            return
        act(number, frame)

    return heard


def _sent_again(number: int) -> None:
    """Send a signal to the program once more.

    Raised in this thread it would end the program while gmsh starts in the main one, which keeps all signals waiting,
    for their handlers are the system's until it has started.
    """
    if hasattr(signal, "pthread_sigmask"):
        os.kill(os.getpid(), number)
    else:
        signal.raise_signal(number)


def heed_ctrl_c() -> None:
    """Hear Ctrl-C beside imports; not where it has another meaning, or none as in the background of a shell."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, between_imports(signal.default_int_handler))
