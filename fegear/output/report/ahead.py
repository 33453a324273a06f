"""What a page needs, whatever it will say: made in threads while the results are computed."""

from __future__ import annotations

from concurrent.futures import Future, ThreadPoolExecutor
from typing import TYPE_CHECKING, TypeVar

if TYPE_CHECKING:
    from collections.abc import Callable

T = TypeVar("T")


def begun(make: Callable[[], T]) -> Future[T]:
    """Start making something in a thread of its own; what goes wrong there is raised where the result is asked for."""
    pool = ThreadPoolExecutor(1)
    made = pool.submit(make)
    pool.shutdown(wait=False)
    return made
