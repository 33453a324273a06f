"""The nearest known name, for messages about unknown ones."""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable


def nearest(name: str, known: Iterable[str]) -> str:
    """Return a remedy that shows the known name nearest to `name`, or all of them when none is near."""
    names = sorted(known)
    near = difflib.get_close_matches(name.lower(), names, n=1, cutoff=0.5)
    if near:
        return f'the nearest known name is "{near[0]}"'
    return f"known here: {', '.join(names)}" if names else "none is known here"
