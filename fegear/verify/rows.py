"""All rows, chosen by name or by what they are compared with, and what is said of each when it has run."""

from __future__ import annotations

from collections.abc import Sequence
from difflib import get_close_matches

from fegear.base.errors import InputError
from fegear.verify import (
    calculix,
    cracked_strip,
    gearboxes,
    handed_on,
    measured,
    own,
    own_motion,
    own_shafts,
    printed,
    programs,
)
from fegear.verify.row import AGAINST, Outcome, Row

#: In the order of the page: printed numbers first.
ALL: tuple[Row, ...] = tuple(
    row
    for one in (printed, cracked_strip, calculix, programs, handed_on, own, own_motion, own_shafts, gearboxes, measured)
    for row in one.ROWS.all
)


def chosen(names: Sequence[str], against: str | None = None) -> tuple[Row, ...]:
    """Rows by name, all without names, of one kind if it is named.

    Raises
    ------
    InputError
        If there is no such row or kind.
    """
    if against is not None and against not in AGAINST:
        raise InputError("against", against, f"must be one of {', '.join(AGAINST)}")
    known = {row.name: row for row in ALL}
    for name in names:
        if name not in known:
            like = get_close_matches(name, known, 1)
            hint = f"did you mean {like[0]}?" if like else "see fegear verify --list"
            raise InputError("row", name, "is unknown", hint)
    rows = tuple(known[name] for name in names) if names else ALL
    return tuple(row for row in rows if against is None or row.against == against)


def said(outcome: Outcome) -> str:
    """A row that has run, for the terminal: two lines, and one for each number that is not as it should be."""
    row, largest = outcome.row, outcome.largest
    differing = len(outcome.compared) - len(outcome.held)
    count = f"{len(outcome.compared)}" + (f", {differing} with known differences" if differing else "")
    stated = "" if largest.stated is None else f", estimated error {largest.stated:.1e}"
    sizes = f"largest difference {largest.deviation:.1e}{stated}, allowed {largest.allowed:.0e}"
    verdict = "" if outcome.holds else "  FAILED"
    lines = [f"  {row.name:42} {row.capability}", f"  {'':42} numbers: {count}, {sizes}{verdict}"]
    lines += [f"  {'':42} {one.found:.9g} instead of {one.wanted:.9g}" for one in outcome.wrong]
    return "\n".join(lines)
