"""A formula's answer at one point of a study: a value, or the reason in words why there is none."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Generic, TypeVar

from fegear.errors import ConvergenceError, FegearError, InputError, RangeError

if TYPE_CHECKING:
    from collections.abc import Callable

T = TypeVar("T")


@dataclass(frozen=True, slots=True)
class Outcome(Generic[T]):
    """Either a value or a reason.

    Parameters
    ----------
    value : T or None
        What the formula gives; None when it gives nothing.
    reason : str
        Why there is no value; empty when there is one.
    """

    value: T | None
    reason: str = ""

    def __post_init__(self) -> None:
        """Refuse outcomes that say both or nothing."""
        if (self.value is None) != bool(self.reason):
            raise InputError("outcome", self, "must hold either a value or a reason")

    @property
    def ok(self) -> bool:
        """Whether there is a value."""
        return self.value is not None

    def unwrap(self) -> T:
        """Return the value, or raise a `RangeError` that carries the reason."""
        if self.value is None:
            raise RangeError("outcome", "none", self.reason)
        return self.value


def attempt(formula: Callable[[], T]) -> Outcome[T]:
    """Evaluate a formula; an argument outside its range becomes an outcome with a reason.

    Only the errors that a formula raises about its arguments are caught; a programming error still surfaces.
    """
    try:
        return Outcome(formula())
    except (InputError, ConvergenceError) as problem:
        return Outcome(None, _words(problem))


def _words(problem: FegearError) -> str:
    return str(problem) or type(problem).__name__
