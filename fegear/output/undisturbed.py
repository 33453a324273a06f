"""Moments in which Ctrl-C and requests to stop wait: what was begun on the disk is then either done or undone."""

from __future__ import annotations

import contextlib
import signal
import threading
from collections.abc import Iterator

from fegear.base.interrupts import REQUESTS_TO_STOP


@contextlib.contextmanager
def undisturbed(*, at_the_end: bool = False) -> Iterator[None]:
    """Hold Ctrl-C and requests to stop back for the few milliseconds of the block.

    They act when it is over; `at_the_end` of all work they are dropped, for there is nothing left to stop, and who was
    told of a stop would take finished results for unfinished ones.

    Signals reach the main thread alone, so in any other thread there is nothing to hold back.
    """
    if threading.current_thread() is not threading.main_thread():
        yield
        return
    waiting: list[int] = []
    # A blocked signal mask would not do: the system hands the signal to another thread, and Python acts on it here.
    before = {n: h for n in REQUESTS_TO_STOP if callable(h := signal.getsignal(n))}
    for number in before:
        signal.signal(number, lambda n, _: waiting.append(n))
    try:
        yield
    finally:
        for number, handler in before.items():
            signal.signal(number, handler)
        for number in [] if at_the_end else waiting[:1]:
            signal.raise_signal(number)
