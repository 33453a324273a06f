"""What one result comes to: a few sentences with rounded numbers, and one figure."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

if TYPE_CHECKING:
    from collections.abc import Callable, Sequence

    from fegear.engine.table import Table

#: Sentences of one result, and of all wanted results together unless more are wanted.
MOST = 5


class Deciding(str):
    """A sentence of an answer that a reader decides by: said before other further sentences where room is short."""


@dataclass(frozen=True, slots=True)
class Answered:
    """What one result comes to.

    Parameters
    ----------
    sentences : tuple of str
        The most important first, at most five.
    figure : str
        Key of the figure that shows it; empty for none.
    rank : float or None
        The smaller, the sooner a reader has to act, among pairs or gears with the same result; None where they are not
        compared.
    among : str
        Clause at the end of the first sentence where it is the first of several, with ``{count}``.
    covers : tuple of str
        Results that it sums up: their own sentences are not needed beside it.
    background : bool
        Whether it describes what is given, not what follows: behind the others, whatever the order asked for.
    tables : tuple of str
        Keys of short tables that a page shows below the figure.
    leads : bool
        Whether it stands before the others, whatever the order asked for: what the case is about, as odd teeth.
    overviews : tuple of Table
        A table with a row for each of several subjects, in the order of the case; of one subject its row.
    fact : object
        What it adds to the common sentence of several subjects.
    common : callable, optional
        That sentence, before those of the subjects, from all their facts; empty for none.
    across : callable, optional
        A sentence from the facts of all results that have it, before all others; empty for none.
    """

    sentences: tuple[str, ...]
    figure: str = ""
    rank: float | None = None
    among: str = ""
    covers: tuple[str, ...] = ()
    background: bool = False
    tables: tuple[str, ...] = ()
    leads: bool = False
    overviews: tuple[Table, ...] = ()
    fact: Any = None
    common: Callable[[Sequence[Any]], str] | None = None
    across: Callable[[Sequence[Any]], str] | None = None
