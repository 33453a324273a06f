"""Hook of mkdocs, the first: makes all that takes long, in one queue, before the others show it.

Cases of the gallery, the pages' own runs and what is filmed of the window need nothing of each other: as many run at a
time as there are processors, and the window, which mostly waits, beside them. Pages come before cases, the last of
which take a second each, so that no processor waits long for the last one.
"""

from __future__ import annotations

import os
from concurrent.futures import ThreadPoolExecutor, as_completed

import executed
import film
import gallery
import window_tutorial


def _window() -> None:
    film.make()
    window_tutorial.make()


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
