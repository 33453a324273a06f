"""``fegear results``: what can be asked for."""

from __future__ import annotations

from typing import TYPE_CHECKING

from fegear.commands.common import AsJson, Voice
from fegear.commands.help import two_columns

if TYPE_CHECKING:
    from fegear.engine.stage import Stage


def results(as_json: AsJson = False) -> None:
    """List the results that a case can ask for, by subject."""
    from fegear.results.catalogue import RESULTS, STAGES, SUBJECTS

    voice = Voice(as_json=as_json)
    column = max(map(len, RESULTS))
    subjects = {subject: [STAGES.called(entry.name) for entry in entries] for subject, entries in SUBJECTS.items()}
    for subject, stages in subjects.items():
        voice.say(f"{subject}:")
        # Several stages may give one result, each for gears and pairs of its kind.
        once = {name: _meaning(stage, name) for stage in reversed(stages) for name in reversed(stage.results)}
        for line in two_columns(list(reversed(once.items())), column):
            voice.say(line)
    voice.say('Ask for them by results = ["geometry", ...] in a case, or by --results geometry,stiffness.')
    found = [
        (subject, stage, name) for subject, stages in subjects.items() for stage in stages for name in stage.results
    ]
    voice.tell(
        {
            name: {"subject": subject, "about": stage.about, "needs_effects": _needed(stage, name)}
            for subject, stage, name in found
        }
    )


def _meaning(stage: Stage, name: str) -> str:
    first, needed = stage.results[0], _needed(stage, name)
    about = stage.about if name == first else f"the same as {first}"
    return f"{about} (needs the effect{'s' * (len(needed) > 1)} {' and '.join(needed)})" if needed else about


def _needed(stage: Stage, name: str) -> list[str]:
    return [need.effect for need in stage.requires if not need.results or name in need.results]
