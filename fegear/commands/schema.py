"""``fegear schema``: what editors need to complete and check case files.

``fegear results``: what can be asked for.
"""

from __future__ import annotations

import functools
import json
import os
from pathlib import Path
from typing import TYPE_CHECKING, Annotated

import typer

from fegear.base.errors import PATH, InputError, shown
from fegear.commands.arguments import AsJson, out_option
from fegear.commands.help_texts import two_columns
from fegear.commands.terminal import Voice

if TYPE_CHECKING:
    from fegear.engine.catalogue import Entry

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
    subjects = dict(SUBJECTS)
    if added := STAGES.with_added.entries[len(STAGES) :]:
        subjects["From other distributions"] = added
    column = max(map(len, (*RESULTS, *(name for entry in added for name in entry.results))))
    for subject, entries in subjects.items():
        voice.say(f"{subject}:")
        # Several stages may give one result, each for gears and pairs of its kind.
        once = {name: _meaning(entry, name) for entry in reversed(entries) for name in reversed(entry.results)}
        for line in two_columns(list(reversed(once.items())), column):
            voice.say(line)
    for error in STAGES.with_added.broken.values():
        voice.note(str(error))
    voice.say('Request them with results = ["geometry", ...] in a case, or with --results geometry,stiffness.')
    found = [
        (subject, entry, name) for subject, entries in subjects.items() for entry in entries for name in entry.results
    ]
    voice.tell(
        {
            name: {"subject": subject, "about": entry.about, "needs_effects": _needed(entry, name)}
            for subject, entry, name in found
        }
    )


def _meaning(entry: Entry, name: str) -> str:
    first, needed = entry.results[0], _needed(entry, name)
    about = entry.about if name == first else f"same as {first}"
    return f"{about} (requires the effect{'s' * (len(needed) > 1)} {' and '.join(needed)})" if needed else about


def _needed(entry: Entry, name: str) -> list[str]:
    return [need.effect for need in entry.requires if not need.results or name in need.results]
