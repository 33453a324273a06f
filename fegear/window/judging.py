"""Long texts of cases are judged in a thread of their own, one after the other, so that typing does not wait."""

from __future__ import annotations

import contextlib
import threading
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    import asyncio
    from collections.abc import Callable

    from fegear.window.document import Desk, Verdict


class Judging:
    """The one thread, and the text that is next: of those that come while it works the last.

    Parameters
    ----------
    taken : callable
        ``taken(desk, text, verdict)``, called in the loop of the pages.
    """

    def __init__(self, taken: Callable[[Desk, str, Verdict], None]) -> None:
        self._taken = taken
        self._next: tuple[Desk, str, Callable[[], Verdict]] | None = None
        self._works = False

    def begin(self, desk: Desk | None, loop: asyncio.AbstractEventLoop) -> None:
        """Judge the text of a desk if it is long, or what waits."""
        if desk is not None and desk.heavy:
            self._next = desk, desk.text, desk.hand_out()
        if self._next is None or self._works:
            return
        of, text, judge = self._next
        self._next, self._works = None, True

        def run() -> None:
            verdict = judge()
            with contextlib.suppress(RuntimeError):  # the window is closed
                loop.call_soon_threadsafe(self._end, of, text, verdict)

        threading.Thread(target=run, daemon=True).start()  # the end does not wait for it

    def _end(self, desk: Desk, text: str, verdict: Verdict) -> None:
        self._works = False
        self._taken(desk, text, verdict)
