"""What a page needs, whatever it will say: made in threads while the results are computed."""

from __future__ import annotations

import threading
from concurrent.futures import Future
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

T = TypeVar("T")


def begun(make: Callable[[], T]) -> Future[T]:
    """Start making something in a thread of its own; what goes wrong there is raised where the result is asked for.

    The program never waits for the thread at its end: a stop that strikes while a module is loaded can leave Python's
    lock of imports taken, and a thread that loads one itself would then wait for ever.
    """
    made: Future[T] = Future()

    def work() -> None:
        try:
            made.set_result(make())
        except BaseException as problem:  # noqa: BLE001  (raised by `result`)
            made.set_exception(problem)

    threading.Thread(target=work, daemon=True).start()
    return made
