"""``fegear schema``: what editors need to complete and check case files.

``fegear results``: what can be asked for.
"""

from __future__ import annotations

import functools
import json
import os
from pathlib import Path
from typing import Annotated

import typer

from fegear.base.errors import PATH, InputError, shown
from fegear.commands.common import AsJson, Voice, out_option
from fegear.commands.help_texts import two_columns
from fegear.engine.stage import Stage

#: Name by which drafted cases ask for it.
SCHEMA_FILE = "fegear.schema.json"


def schema(
    out: Annotated[Path | None, out_option(f"File, e.g. {SCHEMA_FILE}. Default: stdout.")] = None,
    force: Annotated[bool, typer.Option("--force", help="Overwrite an existing file.")] = False,
) -> None:
    """Print the JSON schema of case files: keys, units, choices.

    Editors that know Taplo (Even Better TOML) use it in files whose first line is: #:schema ./fegear.schema.json
    """
    if out is None:
        typer.echo(schema_text(), nl=False)
    else:
        write_schema(out, "--out", force=force)
        typer.echo(f"Wrote {out}")


def write_schema(
    path: Path, key: str, *, force: bool = False, remedy: str = "choose another name, or overwrite it with --force"
) -> None:
    """Write the schema; a file in its place is replaced if it is an earlier schema.

    Parameters
    ----------
    path : Path
    key : str
        Where it is named, for messages.
    force : bool
        Whether any file is replaced.
    remedy : str
        What to do where another file stands there.

    Raises
    ------
    InputError
        If it cannot be written, or something else stands there.
    """
    from fegear.case.text_file import read_text, write_file

    there = os.path.isfile(path)  # noqa: PTH113  (the method of Path raises where a name is too long)
    if there and not force and not _is_schema(read_text(path, key)):
        raise InputError(
            key, shown(str(path), PATH), "already exists and is not a fegear schema",
            remedy,
        )  # fmt: skip
    write_file(path, schema_text().encode(), key)


def _is_schema(text: str) -> bool:
    """Whether a text is a schema that fegear wrote, of whatever version."""
    from fegear.case.schema import TITLE

    try:
        found = json.loads(text)
    except (ValueError, RecursionError):
        return False
    return isinstance(found, dict) and found.get("title") == TITLE


@functools.cache
def schema_text() -> str:
    """The schema as JSON."""
    from fegear.case.schema import case_schema
    from fegear.results.catalogue import STAGES

    results = {name: entry.about for entry in STAGES.with_added.entries for name in entry.results}
    results |= {old: f"former name of {new}" for old, new in STAGES.former().items()}
    return json.dumps(case_schema(results), indent=1, ensure_ascii=False) + "\n"


def results(as_json: AsJson = False) -> None:
    """List the results that a case can ask for, by subject."""
    from fegear.results.catalogue import RESULTS, STAGES, SUBJECTS

    voice = Voice(as_json=as_json)
    subjects = {subject: [STAGES.called(entry.name) for entry in entries] for subject, entries in SUBJECTS.items()}
    if added := STAGES.with_added[len(STAGES) :]:
        subjects["From other distributions"] = list(added)
    column = max(map(len, (*RESULTS, *(name for stage in added for name in stage.results))))
    for subject, stages in subjects.items():
        voice.say(f"{subject}:")
        # Several stages may give one result, each for gears and pairs of its kind.
        once = {name: _meaning(stage, name) for stage in reversed(stages) for name in reversed(stage.results)}
        for line in two_columns(list(reversed(once.items())), column):
            voice.say(line)
    for error in STAGES.with_added.broken.values():
        voice.note(str(error))
    voice.say('Request them with results = ["geometry", ...] in a case, or with --results geometry,stiffness.')
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
    about = stage.about if name == first else f"same as {first}"
    return f"{about} (requires the effect{'s' * (len(needed) > 1)} {' and '.join(needed)})" if needed else about


def _needed(stage: Stage, name: str) -> list[str]:
    return [need.effect for need in stage.requires if not need.results or name in need.results]
