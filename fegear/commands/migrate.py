"""``fegear migrate``: a case file by the names of now."""

from __future__ import annotations

import re
import tomllib
from collections.abc import Mapping
from typing import Annotated

import typer

from fegear.commands.arguments import CaseFile, Quiet
from fegear.commands.terminal import Voice

#: The list of wanted results in a case file.
_RESULTS = re.compile(r"^(results[ \t]*=[ \t]*\[)(.*?)(\])", re.DOTALL | re.MULTILINE)


def migrate(
    case: CaseFile,
    dry_run: Annotated[bool, typer.Option("--dry-run", help="Show the changes without writing.")] = False,
    quiet: Quiet = False,
) -> None:
    """Write a case file anew where keys or results have other names now; comments and order stay.

    The file as it was is kept beside it as CASE.toml.old.
    """
    from fegear.base.errors import InputError
    from fegear.case.reading import build_scene, parse_document
    from fegear.case.text_file import leads_to, read_file, write_file

    voice = Voice(quiet)
    file = read_file(case, "case")
    text, said = migrated(file.text, parse_document(file.text, f'"{case}"'))
    build_scene(tomllib.loads(text), case.stem, case.parent)
    if not said:
        voice.say(f"{case} is up to date.")
        return
    for sentence in said:
        voice.say(sentence)
    if dry_run:
        return
    kept = case.with_name(case.name + ".old")
    if kept.is_symlink() or leads_to(kept, lambda _mode: True):
        raise InputError("case", f'"{kept}"', "already exists (name of the backup of the case)", "rename or move it")
    write_file(kept, file.written(file.text), "case")
    write_file(case, file.written(text), "case")
    voice.say(f"Wrote {case}; backup: {kept}")


def migrated(text: str, document: Mapping[str, object]) -> tuple[str, list[str]]:
    """The text of a case by the names of now, and what was changed.

    Raises
    ------
    InputError
        If a key stands where it cannot be changed by itself, or was written for a later version.
    """
    from fegear.case.changed_text import literal, value_at, with_values
    from fegear.case.renamed import SCHEMA_VERSION, changes, current
    from fegear.results.catalogue import STAGES

    current(document)  # refuses what cannot be read
    edits: dict[tuple[str, ...], str | None] = {}
    said = []
    for old, new, remark in changes(document):
        edits[old] = None
        if new:
            edits[new] = literal(value_at(document, old))
        said.append(remark.partition(";")[0] + ".")
    former = STAGES.former()
    wanted = document.get("results")
    if isinstance(wanted, list) and (renamed := [name for name in wanted if name in former]):
        said += [f'results: "{name}" was renamed "{former[name]}".' for name in renamed]
        results = list(dict.fromkeys(former.get(name, str(name)) for name in wanted))
        text = _with_results(text, results, former)
        edits["results",] = literal(results)
    if said and "schema_version" in document:
        edits["schema_version",] = str(SCHEMA_VERSION)
    return with_values(text, edits), said


def _with_results(text: str, results: list[str], former: Mapping[str, str]) -> str:
    """Names of results in the text of a case renamed where they stand, which leaves comments between them alone."""

    def renamed(found: re.Match[str]) -> str:
        inside = re.sub(r'"([\w-]+)"', lambda name: f'"{former.get(name[1], name[1])}"', found[2])
        return found[1] + inside + found[3]

    made = _RESULTS.sub(renamed, text, count=1)
    return made if tomllib.loads(made).get("results") == results else text
