"""How often the costly kernels run, counted while somebody asks: what an effect costs, measured without a clock."""

from __future__ import annotations

import contextlib
import functools
from collections import Counter
from collections.abc import Callable, Iterator
from contextvars import ContextVar
from types import MappingProxyType
from typing import ParamSpec, TypeVar

from fegear.base.effects import EFFECTS

P = ParamSpec("P")
R = TypeVar("R")

#: The kernels that count, and what one call of each does.
KERNELS = MappingProxyType(
    {
        "tooth shapes": "one tooth shape solved by FE",
        "load sharing": "contact problems at many positions and loads",
        "Hertz widths": "half-widths of contacts at many positions",
        "steady motions": "steady-state motion at one speed",
        "passages": "time integration over one interval",
        "tooth contacts": "first contact of helical flanks at many angles",
        "neglected effects": "estimate of an effect that is off, for one pair, design or motion",
        **{kernel: what for effect in EFFECTS.values() for kernel, what in effect.kernels.items()},
    }
)

_counts: ContextVar[Counter[str] | None] = ContextVar("counts", default=None)


def note(kernel: str, count: int = 1) -> None:
    """Count calls of a kernel, if anybody asks."""
    counts = _counts.get()
    if counts is not None and count:
        counts[kernel] += count


def tallied(kernel: str) -> Callable[[Callable[P, R]], Callable[P, R]]:
    """Decorate a function whose every call counts.

    Parameters
    ----------
    kernel : str
        One of `KERNELS`.
    """
    if kernel not in KERNELS:
        raise KeyError(kernel)

    def decorate(function: Callable[P, R]) -> Callable[P, R]:
        @functools.wraps(function)
        def counted(*args: P.args, **kwargs: P.kwargs) -> R:
            note(kernel)
            return function(*args, **kwargs)

        return counted

    return decorate


@contextlib.contextmanager
def tallying() -> Iterator[Counter[str]]:
    """Count the kernels that run inside, in this process.

    An inner count keeps its own: what runs in it does not count outside.
    """
    counts: Counter[str] = Counter()
    token = _counts.set(counts)
    try:
        yield counts
    finally:
        _counts.reset(token)
