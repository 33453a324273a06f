"""Measurements of a case that no wanted result compares with: they would be passed over without a word."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.base.notes import Note, neglecting

if TYPE_CHECKING:
    from collections.abc import Collection, Iterator

    from fegear.case.model import Case

#: Tables of measurements, and the results that read them.
_READ_BY = {"gauge": ("gauge", "dynamic-strain"), "encoders": ("measured-transmission-error",)}


def unused_measurements(case: Case, results: Collection[str]) -> Iterator[Note]:
    """Say which measurements nothing is compared with.

    Parameters
    ----------
    case : Case
    results : collection of str
        Results of the stages that run.
    """
    for table, readers in _READ_BY.items():
        for name in getattr(case, table):
            if not any(one in results for one in readers):
                yield _unused(f"{table}.{name}", readers)
    if case.dynamics is not None and case.dynamics.measured_frequencies and "natural-modes" not in results:
        yield _unused("dynamics.measured_frequencies", ("natural-modes",))


def _unused(key: str, readers: tuple[str, ...]) -> Note:
    who = " or ".join(f'"{one}"' for one in readers)
    return neglecting(f"{key} is not used by the requested results; request {who}, or remove it.")
