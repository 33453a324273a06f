"""Libraries that only some results need, and the sentence that says how to get one."""

from __future__ import annotations

from importlib.util import find_spec

#: Extras of pyproject.toml by name: their library, and what it is needed for.
EXTRAS = {
    "motion": ("numba", "motion in the time domain requires numba"),
    "space": ("pyvista", "3D figures require pyvista"),
}


def install(extra: str) -> str:
    """What is missing, and the line that installs it."""
    library, why = EXTRAS[extra]
    return f"{why}; {library} is not installed. Install it with: pip install 'fegear[{extra}]'"


def absent(extra: str) -> bool:
    """Whether its library is not installed."""
    return find_spec(EXTRAS[extra][0]) is None
