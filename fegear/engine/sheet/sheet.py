"""A result's sheet: what it shows of its data, so that `present` is no code of its own."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from dataclasses import dataclass, field
from typing import TYPE_CHECKING, Any

from fegear.base.notes import Note, class_of
from fegear.engine.outcome import Outcome
from fegear.engine.sheet.answer import Answer
from fegear.engine.sheet.each import Each
from fegear.engine.sheet.number import Number
from fegear.engine.sheet.rows import EveryLoad, Rows
from fegear.engine.sheet.seen import Seen, Text, Where
from fegear.engine.value import Value

if TYPE_CHECKING:
    from fegear.engine.figure.figure import DeferredFigure, Figure
    from fegear.engine.sheet.chart import Chart
    from fegear.engine.table import Table


@dataclass(frozen=True)
class Remark:
    """A note that the user should read, where a condition holds, for each of some objects; of its text's class."""

    text: Text
    when: Where | None = None
    each: Where | None = None

    def sentences(self, seen: Seen) -> Iterable[Note]:
        """Those that hold."""
        return [self._note(one) for one in seen.each(self.each) if one.holds(self.when)]

    def _note(self, seen: Seen) -> Note:
        said = seen.said(self.text)
        return said if isinstance(said, Note) else Note(said, class_of(self.text))


@dataclass(frozen=True)
class Sheet:
    """What a result shows, in the order in which it is shown.

    Parameters
    ----------
    tables, values, figures : tuple
        Elements (`Rows`, `EveryLoad`, `Number`, `Chart`, `Each` of them), and for what no element can say functions of
        all that is seen, which give tables, values or figures.
    remarks : tuple of Remark or callable
        A function gives sentences.
    settings : mapping of str to where, or callable
        What it was computed with; a setting that is None is left out. A function gives all of them.
    of : callable, optional
        ``of(data, asked)`` -> what is shown in place of the data themselves.
    loads, nominal : where, optional
        Loads of the last axis of what is shown [N], and the number of the one that single values are for.
    name : callable
        ``name(asked)`` -> of the subject.
    sharper_by : str
        As that of `Outcome`.
    answer : Answer, optional
        What it comes to in a few sentences, and the figure that shows it.
    """

    tables: tuple[Rows | EveryLoad | Each | Callable[[Seen], Iterable[Table]], ...] = ()
    values: tuple[Number | Each | str | Callable[[Seen], Iterable[Value]], ...] = ()
    figures: tuple[Chart | Each | Callable[[Seen], Iterable[Figure | DeferredFigure]], ...] = ()
    remarks: tuple[Remark | Each | Callable[[Seen], Iterable[str]], ...] = ()
    settings: Mapping[str, Where] | Callable[[Seen], Mapping[str, object]] = field(default_factory=dict)
    of: Callable[[Any, Any], Any] | None = None
    loads: Where | None = None
    nominal: Where | None = None
    name: Callable[[Any], str] = lambda asked: str(asked.name)
    sharper_by: str = "reduce accuracy.tolerance"
    answer: Answer | None = None

    def present(self, data: Any, asked: Any) -> Outcome:
        """As `Stage.present`: the sheet filled from a result's data and from what it was asked for."""
        seen = Seen(data if self.of is None else self.of(data, asked), asked, self.name(asked))
        if self.loads is not None:
            seen = Seen(seen.data, asked, seen.name, seen.find(self.loads), seen.find(self.nominal or ""))
        given = self.settings
        settings = given(seen) if callable(given) else {key: seen.find(where) for key, where in given.items()}
        values = tuple(value for one in self.values for value in _values(one, seen))
        return Outcome(
            data,
            tuple(table for one in self.tables for table in (one(seen) if callable(one) else one.tables(seen))),
            values,
            {key: setting for key, setting in settings.items() if setting is not None},
            tuple(line for one in self.remarks for line in (one(seen) if callable(one) else one.sentences(seen))),
            tuple(figure for one in self.figures for figure in (one(seen) if callable(one) else one.figures(seen))),
            self.sharper_by,
            None if self.answer is None else self.answer.of(seen, values),
        )


#: Of a result for the stages after it: nothing of it is shown.
UNSHOWN = Sheet(name=lambda _asked: "")


def _values(one: Number | Each | str | Callable[[Seen], Iterable[Value]], seen: Seen) -> Iterable[Value]:
    if isinstance(one, str):
        one = Number(one)
    return one(seen) if callable(one) else one.values(seen)
