"""Linear algebra on one thread."""

from __future__ import annotations

import contextlib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator


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
    if with_scipy:
        import scipy.linalg  # noqa: F401  (loaded before it is limited)
    from threadpoolctl import threadpool_limits

    with threadpool_limits(limits=1):
        yield
