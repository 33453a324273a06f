"""Hook of mkdocs, the first: makes all that takes long, in one queue, before the others show it.

Cases of the gallery, the pages' own runs and what is filmed of the window need nothing of each other: as many run at a
time as there are processors, and the window, which mostly waits, beside them. Pages come before cases, the last of
which take a second each, so that no processor waits long for the last one.
"""

from __future__ import annotations

import logging
import os
from concurrent.futures import ThreadPoolExecutor, as_completed

import executed
import film
import gallery
import window_tutorial

log = logging.getLogger("mkdocs.plugins.made")

#: A browser on a busy machine may lose its page in the middle: what is filmed is taken so many times at most.
_TAKES = 3


def _window() -> None:
    for make in (film.make, window_tutorial.make):
        for left in reversed(range(_TAKES)):
            try:
                make()
                break
            except (RuntimeError, TimeoutError):
                if not left:
                    raise
                log.info("The browser lost the page of the window: taken again", exc_info=True)


def on_files(files, **_others):
    """Make what is not there yet; the first fault ends it."""
    with ThreadPoolExecutor(1 + max(1, min(4, os.cpu_count() or 1))) as pool:
        jobs = [pool.submit(one) for one in (_window, *executed.jobs(), *gallery.jobs())]
        try:
            for job in as_completed(jobs):
                job.result()
        finally:
            pool.shutdown(cancel_futures=True)
    return files
