"""What a stage leaves: tables, single values, remarks, and the numerical result itself."""

from __future__ import annotations

from dataclasses import dataclass, field
from typing import TYPE_CHECKING

from fegear.base.arrays import Alike
from fegear.base.notes import exceeding
from fegear.base.printed import with_its_error
from fegear.engine.least_errors import _NAMED, _ROUGH, _is_rough, with_least_error_columns, with_least_errors
from fegear.engine.value import Value

if TYPE_CHECKING:
    from collections.abc import Mapping

    from fegear.engine.answered import Answered
    from fegear.engine.figure.figure import DeferredFigure, Figure
    from fegear.engine.table import Table


@dataclass(frozen=True, slots=True)
class Outcome(Alike):
    """Result of one stage; no estimated error in it is below what another processor gives (`stated_errors`).

    Parameters
    ----------
    data : object
        The numerical layer's own frozen result, for later stages and for pictures.
    tables, values : tuples
        What is written down.
    settings : mapping
        The settings that it was computed with, plain numbers and texts.
    remarks : tuple of str
        Sentences that the user should read.
    figures : tuple of Figure or DeferredFigure
        What can be drawn.
    sharper_by : str
        What makes the estimated errors of its values smaller: key and verb of a remedy; empty where nothing does.
    answer : Answered or None
        What it comes to, in a few sentences; None where its sheet says none.
    """

    data: object = None
    tables: tuple[Table, ...] = ()
    values: tuple[Value, ...] = ()
    settings: Mapping[str, object] = field(default_factory=dict)
    remarks: tuple[str, ...] = ()
    figures: tuple[Figure | DeferredFigure, ...] = ()
    sharper_by: str = "reduce accuracy.tolerance"
    answer: Answered | None = None

    def __post_init__(self) -> None:
        """Raise errors that are below what the digits of their numbers are worth; note those that are large."""
        object.__setattr__(self, "values", with_least_errors(self.values))
        object.__setattr__(self, "remarks", tuple(dict.fromkeys((*self.remarks, *self._rough_values))))
        object.__setattr__(self, "tables", tuple(with_least_error_columns(table) for table in self.tables))

    @property
    def rough(self) -> tuple[Value, ...]:
        """Values whose estimated error is a large part of them, where something makes it smaller."""
        return tuple(value for value in self.values if _is_rough(value, self.values)) if self.sharper_by else ()

    @property
    def _rough_values(self) -> tuple[str, ...]:
        """One note for all values whose estimated error exceeds a fifth of them."""
        rough = self.rough
        if not rough:
            return ()
        shown = [
            f"{one.name} ({with_its_error(one.value, one.error or 0.0)} {one.unit}".rstrip() + ")"
            for one in rough[:_NAMED]
        ]
        more = f" and {len(rough) - _NAMED} more" if len(rough) > _NAMED else ""
        limit = f"{100.0 * _ROUGH:g} % of the value"
        return (exceeding(f"{', '.join(shown)}{more}: estimated error above {limit}; {self.sharper_by}."),)
