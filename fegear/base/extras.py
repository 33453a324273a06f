"""Libraries that only some results need, and the sentence that says how to get one."""

from __future__ import annotations

from importlib.util import find_spec

#: Extras of pyproject.toml by name: their library, and what it is needed for.
EXTRAS = {
    "motion": ("numba", "motion over time is computed by machine code that numba makes"),
    "space": ("pyvista", "pictures in space are drawn by pyvista"),
}


def install(extra: str) -> str:
    """What is missing, and the line that installs it."""
    library, why = EXTRAS[extra]
    return f"{why}, and {library} is not installed; install it with: pip install 'fegear[{extra}]'"


def absent(extra: str) -> bool:
    """Whether its library is not installed."""
    return find_spec(EXTRAS[extra][0]) is None
