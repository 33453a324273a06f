"""plotly.js, compressed, from plotly's wheel."""

from __future__ import annotations

import base64
import gzip
from concurrent.futures import Future, ThreadPoolExecutor
from functools import cache
from importlib.util import find_spec
from pathlib import Path

from fegear.errors import MissingLibraryError

#: Quick, and only 4 % larger than the best.
_LEVEL = 4


def begin_compressing() -> None:
    """Let plotly.js be compressed in a thread of its own while something else is computed: zlib holds nobody up."""
    _compression()


def compressed_plotly() -> str:
    """Return plotly.js as base64 of gzip, 2 MB; the page's script unpacks it.

    The library is found without importing plotly, which would take half as long as a whole run.

    Raises
    ------
    MissingLibraryError
        If plotly's wheel is not there or has no script.
    """
    return _compression().result()


@cache
def _compression() -> Future[str]:
    pool = ThreadPoolExecutor(1)
    begun = pool.submit(_compressed)
    pool.shutdown(wait=False)
    return begun


def _compressed() -> str:
    spec = find_spec("plotly")
    folders = (spec.submodule_search_locations or []) if spec else []
    for folder in folders:
        path = Path(folder) / "package_data" / "plotly.min.js"
        if path.is_file():
            return base64.b64encode(gzip.compress(path.read_bytes(), _LEVEL, mtime=0)).decode()
    raise MissingLibraryError("plotly.js is missing, so the report has no plots; run: pip install plotly")
