"""Values that a case gives as a list, or by the first, the last and how many there are: speeds, torques."""

from __future__ import annotations

from typing import Any, ClassVar, Self

import numpy as np
from numpy.typing import NDArray
from pydantic import model_validator

from fegear.case.part import Part, refuse, spelt_also


class EvenlySpaced(Part):
    """``{ start, stop, count }``, evenly spaced, or a list; a subclass says of what."""

    model_config = spelt_also(lambda table: table["properties"]["values"])

    #: How a user writes it, for the refusal of a table that lacks something.
    example: ClassVar[str] = ""

    values: list[float] | None = None
    start: float | None = None
    stop: float | None = None
    count: int | None = None

    @model_validator(mode="before")
    @classmethod
    def _list_alone(cls, value: Any) -> Any:
        return {"values": value} if isinstance(value, list) else value

    @model_validator(mode="after")
    def _one_way(self) -> Self:
        given = [key for key in ("start", "stop", "count") if getattr(self, key) is not None]
        if self.values is not None and given:
            raise refuse("contradicts the list of values", "specify only one", key=given[0])
        if self.values is None and len(given) < 3:
            raise refuse("is incomplete", self.example, value=", ".join(given) or "(not given)")
        if self.start is not None and self.stop is not None and self.stop <= self.start:
            raise refuse("must be greater than start", key="stop")
        return self

    @property
    def in_order(self) -> NDArray[np.float64]:
        """All values as the case has them [SI]."""
        if self.values is not None:
            return np.array(self.values)
        if self.start is None or self.stop is None or self.count is None:  # refused before
            return np.zeros(0)
        return np.linspace(self.start, self.stop, self.count)

    @property
    def array(self) -> NDArray[np.float64]:
        """All values, increasing, each once [SI]."""
        return self.in_order if self.values is None else np.array(sorted(set(self.values)))
