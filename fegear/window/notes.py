"""Notes of a run as a page shows them: by the task that makes each, and those to act on first before the others."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from fegear.base.notes import class_of, counted, open_and_folded

if TYPE_CHECKING:
    from fegear.base.notes import Note
    from fegear.engine.run import Results


def notes_by_task(results: Results) -> list[tuple[str, str, str, str]]:
    """Notes with the task that makes each, the gear or pair that the task is about, and their class."""
    return [
        (str(task), task.subject, str(remark), class_of(remark).name.lower())
        for task, outcome in results.outcomes.items()
        for remark in outcome.remarks
    ]


def notes_of(results: Results) -> dict[str, Any]:
    """Notes that stand open and those that are folded: class, its words and the note; and how many of which class."""
    shown, folded = open_and_folded(results.notes(information=False))

    def row(note: Note) -> tuple[str, str, str]:
        return note.kind.name.lower(), note.kind.words, str(note)

    return {"open": [*map(row, shown)], "folded": [*map(row, folded)], "counted": counted(folded) if folded else ""}
