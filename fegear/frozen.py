"""Results that cannot be changed: dataclasses with read-only arrays."""

from __future__ import annotations

from dataclasses import fields

import numpy as np


class ReadOnlyArrays:
    """Base of frozen dataclasses that makes every array of theirs read-only."""

    __slots__ = ()

    def __post_init__(self) -> None:
        """Make the arrays read-only."""
        for field in fields(self):  # type: ignore[arg-type]
            value = getattr(self, field.name)
            if isinstance(value, np.ndarray):
                value.setflags(write=False)
