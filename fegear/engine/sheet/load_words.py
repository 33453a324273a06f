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
    """Meanwhile loads are called as the case gives those of this pair; of what belongs to no pair, by the force."""
    name = pair_of_subject(scene, subject)
    token = _LEVER.set(None if name is None else scene.case.pair[name].lever(scene.pairs[name]))
    try:
        yield
    finally:
        _LEVER.reset(token)


def pair_of_subject(scene: Scene, subject: str) -> str | None:
    """Name of the pair whose loads a subject of a result has: itself, or that of a gauge or of encoders."""
    case = scene.case
    if subject in case.pair:
        return subject
    if (gauge := case.gauge.get(subject)) is not None:
        mine = [name for name, pair in case.pair.items() if gauge.gear in (pair.driver, pair.driven)]
        return gauge.pair or (mine[0] if len(mine) == 1 else None)
    if (encoders := case.encoders.get(subject)) is not None:
        return encoders.pair or (next(iter(case.pair)) if len(case.pair) == 1 else None)
    return None
