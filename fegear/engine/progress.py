"""How far a computation is, for those who watch it."""

from __future__ import annotations

from typing import Protocol


class Progress(Protocol):
    """Where a running stage reports how far it is."""

    def __call__(self, fraction: float) -> None:
        """Report the fraction done, 0 to 1."""
