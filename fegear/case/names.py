"""The known names, the nearest one first, for messages about unknown ones."""

from __future__ import annotations

import difflib
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterable


def nearest(name: str, known: Iterable[str]) -> str:
    """Return a remedy that lists the known names, and says which is nearest to `name` if one is."""
    names = sorted(known)
    near = difflib.get_close_matches(name.lower(), names, n=1, cutoff=0.5)
    listed = f"known here: {', '.join(names)}" if names else "none is known here"
    return f'the nearest known name is "{near[0]}"; {listed}' if near and len(names) > 1 else listed
