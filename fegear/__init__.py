"""fegear: a finite-element workbench for gear teeth.

What a script needs stands at the top: `run` computes a case; `Gear`, `Pair` and the questions about them do without
one. They are loaded when they are first used. Below them lie the packages of the mechanics, in SI throughout.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from fegear.workbench.results import Results
    from fegear.workbench.run import run

__version__ = "0.2.0"

__all__ = ["Results", "__version__", "run"]

#: Where each name of the top is described.
_HOMES = {
    "Results": "fegear.workbench.results",
    "run": "fegear.workbench.run",
}


def __getattr__(name: str) -> Any:
    """Load a name of the top at its first use."""
    if name not in _HOMES:
        raise AttributeError(f"module 'fegear' has no attribute {name!r}; it has {', '.join(sorted(_HOMES))}")
    found = getattr(importlib.import_module(_HOMES[name]), name)
    globals()[name] = found
    return found


def __dir__() -> list[str]:
    return sorted(__all__)
