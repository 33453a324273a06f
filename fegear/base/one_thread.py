"""Linear algebra on one thread."""

from __future__ import annotations

import contextlib
import functools
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from threadpoolctl import ThreadpoolController


@contextlib.contextmanager
def one_thread(*, with_scipy: bool = True) -> Iterator[None]:
    """Keep the libraries of linear algebra to one thread while the block runs.

    The matrices of a gear are many and small: on a busy machine a second thread makes them ten times slower, never
    faster, and sums come out with other last bits. Processor seconds are then those of one core.

    Parameters
    ----------
    with_scipy : bool
        Whether the block may call scipy's, which is a library of its own; loading it takes a quarter of a second.
    """
    with _controller(with_scipy).limit(limits=1):
        yield


@functools.cache
def _controller(with_scipy: bool) -> ThreadpoolController:
    """Looking for the libraries of linear algebra takes as long as the mesh of a gear: once, when they are loaded."""
    if with_scipy:
        import scipy.linalg  # noqa: F401  (loaded before it is limited)
    from threadpoolctl import ThreadpoolController

    return ThreadpoolController()
