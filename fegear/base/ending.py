"""The end of the program, while threads that nobody waits for still run."""

from __future__ import annotations

import atexit
import contextlib
import os
import sys
import threading
from collections.abc import Iterator


@contextlib.contextmanager
def leaving_with() -> Iterator[None]:
    """Run the program's own work; whatever it leaves with is the code that the process ends with.

    A daemon thread is unwound where it next asks for the interpreter that is gone, through whatever called it:
    libraries written in Rust (pydantic's core) or C++ abort the process there, with signal 6 in place of its code. So
    where one is left the process is ended here, last of all that was registered for its end.
    """
    code = 1

    def end() -> None:
        own = threading.current_thread()
        if all(one is own or not one.daemon for one in threading.enumerate()):
            return
        for stream in (sys.stdout, sys.stderr):
            with contextlib.suppress(OSError, ValueError):
                stream.flush()
        os._exit(code)

    atexit.register(end)  # the first to be registered is the last to be called
    try:
        yield
        code = 0
    except SystemExit as leaving:
        code = 0 if leaving.code is None else leaving.code if isinstance(leaving.code, int) else 1
        raise
    except KeyboardInterrupt:
        code = 130
        raise
