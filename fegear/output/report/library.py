"""plotly.js, compressed, from plotly's wheel."""

from __future__ import annotations

import base64
import gzip
from functools import cache
from importlib.util import find_spec
from pathlib import Path
from typing import TYPE_CHECKING

from fegear.errors import MissingLibraryError
from fegear.output.report.ahead import begun

if TYPE_CHECKING:
    from concurrent.futures import Future

#: Quick, and only 4 % larger than the best.
_LEVEL = 4


def compressed_plotly() -> str:
    """Return plotly.js as base64 of gzip, 2 MB; the page's script unpacks it.

    The library is found without importing plotly, which would take half as long as a whole run.

    Raises
    ------
    MissingLibraryError
        If plotly's wheel is not there or has no script.
    """
    return compression().result()


@cache
def compression() -> Future[str]:
    """Compression in a thread of its own: zlib holds nobody up."""
    return begun(_compressed)


def _compressed() -> str:
    return base64.b64encode(gzip.compress(plotly_file().read_bytes(), _LEVEL, mtime=0)).decode()


def plotly_file() -> Path:
    """Where plotly.js lies.

    Raises
    ------
    MissingLibraryError
        If plotly's wheel is not there or has no script.
    """
    spec = find_spec("plotly")
    folders = (spec.submodule_search_locations or []) if spec else []
    for folder in folders:
        path = Path(folder) / "package_data" / "plotly.min.js"
        if path.is_file():
            return path
    raise MissingLibraryError("plotly.js is missing, so the report has no plots; run: pip install plotly")
