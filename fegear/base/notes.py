"""Notes of a run: sentences that a reader should see, each of a class, so that what matters comes first.

A note is a text that knows its class; a plain text among notes is information.
"""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterable, Sequence
from enum import IntEnum
from typing import NamedTuple


class NoteClass(IntEnum):
    """What a note means for the numbers; the smaller, the sooner a reader has to act."""

    FAILS = 1
    BEYOND_TOLERANCE = 2
    NEGLECTED = 3
    ASSUMED = 4
    INFORMATION = 5

    @property
    def words(self) -> str:
        """As people read it."""
        return _WORDS[self]


_WORDS = {
    NoteClass.FAILS: "fails",
    NoteClass.BEYOND_TOLERANCE: "beyond the tolerance",
    NoteClass.NEGLECTED: "neglected",
    NoteClass.ASSUMED: "assumed",
    NoteClass.INFORMATION: "information",
}


class Note(str):
    """A sentence with its class.

    Parameters
    ----------
    text : str
    kind : NoteClass
    margin : float
        What is there over what is required, of something that falls short: the smaller, the sooner among its class. 0
        where that has no measure.
    """

    __slots__ = ("kind", "margin")
    kind: NoteClass
    margin: float

    def __new__(cls, text: str, kind: NoteClass = NoteClass.INFORMATION, margin: float = 0.0) -> Note:
        """Make the text and remember its class."""
        made = super().__new__(cls, text)
        made.kind, made.margin = kind, margin
        return made

    def __reduce__(self) -> tuple[type[Note], tuple[str, NoteClass, float]]:
        """Travel to other processes with the class."""
        return Note, (str(self), self.kind, self.margin)


def failing(text: str, margin: float = 0.0) -> Note:
    """Something does not hold: a safety below the required one, by its `margin`; tips that jam."""
    return Note(text, NoteClass.FAILS, margin)


def exceeding(text: str) -> Note:
    """An estimated error exceeds what the case allows, or a formula is used outside its range."""
    return Note(text, NoteClass.BEYOND_TOLERANCE)


def neglecting(text: str) -> Note:
    """An effect or a part is left out that changes what is wanted."""
    return Note(text, NoteClass.NEGLECTED)


def assuming(text: str) -> Note:
    """A value was taken that the case does not give."""
    return Note(text, NoteClass.ASSUMED)


def class_of(note: object) -> NoteClass:
    """Class of a note; anything else is information."""
    return note.kind if isinstance(note, Note) else NoteClass.INFORMATION


def about(subject: str, clause: str) -> Note:
    """A clause as a sentence on its subject, of the clause's class."""
    return Note(f"{subject}: {clause}.", class_of(clause), getattr(clause, "margin", 0.0))


#: Notes that stand open on a page, a terminal and in the window, besides all that fail; others are folded or counted.
OPEN = 2
#: Subjects that a merged note names.
_NAMED = 6
_SUBJECT = re.compile(
    r"(Gear|Pair|Mesh|Set|Shaft|Bearing|Gauge|Encoders) ([^\s:,]+(?:, [\d.]+ N m)?)((?: over [^:]*)?: .*)", re.DOTALL
)
_NUMBER = re.compile(r"(?<![\w.])[-+]?\d+(?:\.\d+)?(?:e[-+]?\d+)?(?![\w.]*\w)")
_PLURAL = {"Mesh": "Meshes", "Encoders": "Encoders"}


class _Subject(NamedTuple):
    """Where one of several notes that say the same comes from."""

    name: str
    note: str
    rest: str
    margin: float


def ordered(notes: Iterable[str]) -> tuple[Note, ...]:
    """Notes with repeats merged, the class to act on first; within a class by margin, else as they were.

    Notes that say the same of several gears, pairs or shafts become one, "Gears p1, w1: ..."; where their numbers
    differ, the merged one has those of two, or the range of more.
    """
    groups: dict[tuple[NoteClass, str, str], list[_Subject]] = {}
    for note in dict.fromkeys(notes):
        found = _SUBJECT.fullmatch(note)
        noun, name, rest = found.groups() if found else ("", "", str(note))
        key = (class_of(note), noun, _NUMBER.sub("#", rest) if found else rest)
        if any(one.name == name for one in groups.get(key, ())):  # two numbers of one subject are two notes
            key = (*key[:2], rest)
        groups.setdefault(key, []).append(_Subject(name, str(note), rest, getattr(note, "margin", 0.0)))
    merged = [
        Note(_merged(noun, members), kind, min(one.margin for one in members))
        for (kind, noun, _), members in groups.items()
    ]
    return tuple(sorted(merged, key=lambda note: (note.kind, note.margin)))


def _merged(noun: str, members: Sequence[_Subject]) -> str:
    if len(members) == 1:
        return members[0].note
    names, count = _names([one.name for one in members])
    more = f" and {count - _NAMED} more" if count > _NAMED else ""
    numbers = iter(zip(*(_NUMBER.findall(one.rest) for one in members), strict=True))
    rest = _NUMBER.sub(lambda _: _together(next(numbers)), members[0].rest)
    return f"{_PLURAL.get(noun, noun + 's')} {names}{more}{rest}"


def _names(subjects: Sequence[str]) -> tuple[str, int]:
    """Subjects of a merged note, each with its torques where it has some, and how many there are."""
    torques: dict[str, list[str]] = {}
    for one in dict.fromkeys(subjects):
        name, _, torque = one.partition(", ")
        torques.setdefault(name, []).extend([torque.removesuffix(" N m")] if torque else [])
    if not any(torques.values()):
        return ", ".join(dict.fromkeys(subjects[:_NAMED])), len(subjects)
    parts = [f"{name}, {', '.join(of)} N m" if of else name for name, of in torques.items()]
    return "; ".join(parts[:_NAMED]), len(parts)


def _together(numbers: Sequence[str]) -> str:
    """Numbers of one place in several notes."""
    if len(set(numbers)) == 1:
        return numbers[0]
    if len(numbers) == 2:
        return " and ".join(numbers)
    return f"{min(numbers, key=float)} to {max(numbers, key=float)}"


def open_and_folded(notes: Sequence[Note]) -> tuple[Sequence[Note], Sequence[Note]]:
    """Those to show at once, all that fail among them, and those behind a line to click on, which one is not worth.

    Parameters
    ----------
    notes : sequence of Note
        In order.
    """
    count = max(OPEN, sum(note.kind is NoteClass.FAILS for note in notes))
    if len(notes) <= count + 1:
        count = len(notes)
    return notes[:count], notes[count:]


def counted(notes: Sequence[Note]) -> str:
    """How many of which class: ``"5 further notes (2 neglected, 3 assumed)"``, ``"2 further notes (assumed)"``."""
    count = Counter(note.kind for note in notes)
    kinds = [kind for kind in NoteClass if count[kind]]
    counts = kinds[0].words if len(kinds) == 1 else ", ".join(f"{count[kind]} {kind.words}" for kind in kinds)
    return f"{len(notes)} further note{'' if len(notes) == 1 else 's'} ({counts})"
