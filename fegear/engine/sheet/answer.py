"""What a sheet comes to: a few sentences with rounded numbers, and the figure that shows them."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Iterator, Sequence
from dataclasses import dataclass, replace
from typing import Any, Protocol

from fegear.engine.answered import MOST, Answered
from fegear.engine.sheet.rows import Rows
from fegear.engine.sheet.seen import MissingValueError, Seen, Text, Where
from fegear.engine.value import Value


class _Says(Protocol):
    """A sentence under a condition, or for each of some objects: `Remark`, `Each`."""

    def sentences(self, seen: Seen) -> Iterable[str]:
        """Those that hold."""


@dataclass(frozen=True)
class Answer:
    """What a result comes to.

    Parameters
    ----------
    *said : str, Remark, Each or callable
        Sentences, the most important first, of which five are kept; a sentence that names a single value which the
        result has not (``{v[...]}``) is left out. A function of all that is seen gives sentences.
    figure : text
        Key of the figure that shows it.
    rank : where, optional
        The smaller, the sooner a reader has to act, among several subjects.
    among : str
        Clause that ends the first sentence of the first of several: ``"the weakest of {count}"``.
    covers, background, tables
        As those of `Answered`.
    leads : where, optional
        Whether it does, as of `Answered`.
    overview : Rows, optional
        A table of one row, which several subjects make one table.
    fact : callable, optional
        As of `Answered`, from all that is seen.
    common, across : callable, optional
        As of `Answered`.
    """

    said: tuple[str | _Says | Callable[[Seen], Iterable[str]], ...]
    figure: Text
    rank: Where | None
    among: str
    covers: tuple[str, ...]
    background: bool
    tables: tuple[str, ...]
    leads: Where | None
    overview: Rows | None
    fact: Callable[[Seen], Any] | None
    common: Callable[[Sequence[Any]], str] | None
    across: Callable[[Sequence[Any]], str] | None

    def __init__(
        self, *said: str | _Says | Callable[[Seen], Iterable[str]], figure: Text = "", rank: Where | None = None,
        among: str = "", covers: tuple[str, ...] = (), background: bool = False, tables: tuple[str, ...] = (),
        leads: Where | None = None, overview: Rows | None = None,
        fact: Callable[[Seen], Any] | None = None, common: Callable[[Sequence[Any]], str] | None = None,
        across: Callable[[Sequence[Any]], str] | None = None,
    ) -> None:  # fmt: skip
        for name, given in (
            ("said", said), ("figure", figure), ("rank", rank), ("among", among), ("covers", covers),
            ("background", background), ("tables", tables), ("leads", leads), ("overview", overview),
            ("fact", fact), ("common", common), ("across", across),
        ):  # fmt: skip
            object.__setattr__(self, name, given)

    def of(self, seen: Seen, values: Sequence[Value]) -> Answered:
        """Filled from all that is seen and from the sheet's single values."""
        seen = replace(seen, values={value.name: value for value in values})
        found = tuple(sentence for one in self.said for sentence in _sentences(one, seen) if sentence)
        rank = None if self.rank is None else seen.find(self.rank)
        return Answered(
            found[:MOST], seen.said(self.figure), None if rank is None else float(rank), self.among, self.covers,
            self.background, self.tables, self.leads is not None and seen.holds(self.leads),
            () if self.overview is None else tuple(self.overview.tables(seen)),
            None if self.fact is None else self.fact(seen), self.common, self.across,
        )  # fmt: skip


def _sentences(one: str | _Says | Callable[[Seen], Iterable[str]], seen: Seen) -> Iterator[str]:
    try:
        if isinstance(one, str):
            yield seen.said(one)
        else:
            yield from one(seen) if callable(one) else one.sentences(seen)
    except MissingValueError:
        return
