"""How texts, titles and legends call the load of a pair: by the torque where the case gives torques."""

from __future__ import annotations

from contextlib import contextmanager
from contextvars import ContextVar
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from collections.abc import Iterator

    from fegear.case.reading import Scene

#: Lever of the driver [m], by which loads along the line of action are called; None for the loads themselves.
_LEVER: ContextVar[float | None] = ContextVar("lever", default=None)


def load_words(load: float, digits: int = 5) -> str:
    """A load along the transverse line of action [N] as readers know it, ``8783.7 N`` or ``190 N m``.

    Parameters
    ----------
    load : float
        [N].
    digits : int
        Significant ones.
    """
    lever = _LEVER.get()
    return f"{load:.{digits}g} N" if lever is None else f"{load * lever:.{digits}g} N m"


@contextmanager
def loads_as_given(scene: Scene, subject: str) -> Iterator[None]:
    """Meanwhile loads are called as the case gives those of this pair; of what is no pair, by the force."""
    part = scene.case.pair.get(subject)
    token = _LEVER.set(None if part is None else part.lever(scene.pairs[subject]))
    try:
        yield
    finally:
        _LEVER.reset(token)
