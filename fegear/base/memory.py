"""Memory of this process: how much of it the system counts, and handing back what is free."""

from __future__ import annotations

import contextlib
import gc
import os
from pathlib import Path


def resident() -> int | None:
    """Bytes of this process in memory; None where the system does not say so in `/proc`."""
    with contextlib.suppress(OSError, ValueError, IndexError, AttributeError):
        return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    return None


def give_back() -> None:
    """Hand freed memory back to the system; the C library keeps it otherwise, in pieces."""
    import ctypes

    gc.collect()
    with contextlib.suppress(OSError, AttributeError, TypeError):  # only glibc has it
        ctypes.CDLL(None).malloc_trim(0)
