"""Ctrl-C and requests to stop, heard where Python can raise what they ask for."""

from __future__ import annotations

import signal
import threading
from collections.abc import Callable
from types import FrameType

Heard = Callable[[int, FrameType | None], object]
#: How long a request waits for an import to go on [s].
_LATER = 0.02


def between_imports(act: Heard) -> Heard:
    """Let a handler of signals act beside imports, which let go of their locks in callbacks of weak references.

    What is raised in such a callback is printed and lost.
    """

    def heard(number: int, frame: FrameType | None) -> None:
        if frame is not None and frame.f_code.co_filename.startswith("<frozen importlib"):
            threading.Timer(_LATER, signal.raise_signal, [number]).start()
            return
        act(number, frame)

    return heard


def heed_ctrl_c() -> None:
    """Hear Ctrl-C beside imports; not where it has another meaning, or none as in the background of a shell."""
    if signal.getsignal(signal.SIGINT) is signal.default_int_handler:
        signal.signal(signal.SIGINT, between_imports(signal.default_int_handler))
