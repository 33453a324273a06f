"""What is the same in every page, kept from one run to the next: plotly.js compressed, templates compiled.

Making it takes a tenth of a short run. Nothing of it depends on a case. Compiled templates are code: they are where
Python keeps compiled modules, which who may write there could change as well, never in a cache that others may share.
"""

from __future__ import annotations

import contextlib
import hashlib
import sys
from collections.abc import Callable
from importlib.util import cache_from_source
from pathlib import Path

from fegear.base.store import Store

#: Some versions of plotly.js at 1.5 MB each, and of the templates.
_LIMIT = 20 * (1 << 20)


def recalled(of: str) -> bytes | None:
    """What is kept under a name that says all that it depends on; None: nothing, or nothing sound."""
    return _store().read(_key(of))


def keep(of: str, content: bytes) -> None:
    """Keep something under a name that says all that it depends on, if Python may keep compiled modules there.

    Parameters
    ----------
    of : str
    content : bytes
    """
    if not sys.dont_write_bytecode:
        with contextlib.suppress(OSError):
            _store().write(_key(of), content)


def kept(of: str, make: Callable[[], bytes]) -> bytes:
    """Recall something, or make and keep it.

    Parameters
    ----------
    of : str
        Everything that it depends on.
    make : callable
        ``make()`` -> bytes.

    Returns
    -------
    bytes
    """
    known = recalled(of)
    if known is None:
        known = make()
        keep(of, known)
    return known


def _store() -> Store:
    return Store(Path(cache_from_source(__file__)).parent / "pages", _LIMIT)


def _key(of: str) -> str:
    return hashlib.sha256(of.encode()).hexdigest()
