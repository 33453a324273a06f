"""Hook of mkdocs: the menu holds every page, its groups are not too large, and some begin with a page of contents.

What a group's page says of a page are that page's own first words.
"""

from __future__ import annotations

import re
from pathlib import Path
from typing import TYPE_CHECKING, Any

from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File

if TYPE_CHECKING:
    from collections.abc import Iterator

DOCS = Path(__file__).resolve().parent
#: Entries of a group that a reader takes in at a glance.
LARGEST_GROUP = 8
#: Groups whose first page is their table of contents, and what it says before it.
_CONTENTS = {
    "How to": "One page for each task, with input, results and accuracy.",
    "Theory": "Equations, sources and verification.",
}


def pages_of(group: list[Any]) -> Iterator[tuple[str, str]]:
    """Title and path of every page of a group and of the groups in it; index pages have no title."""
    for entry in group:
        for title, inside in entry.items() if isinstance(entry, dict) else [("", entry)]:
            if isinstance(inside, str):
                yield title, inside
            else:
                yield from pages_of(inside)


def faults(nav: list[Any], docs: Path) -> list[str]:
    """Groups that are too large, and pages of the folder that stand in none."""

    def groups(name: str, entries: list[Any]) -> Iterator[str]:
        listed = [entry for entry in entries if isinstance(entry, dict)]
        if len(listed) > LARGEST_GROUP:
            yield f"{name} has {len(listed)} entries; {LARGEST_GROUP} are taken in at a glance"
        for entry in listed:
            for title, inside in entry.items():
                if isinstance(inside, list):
                    yield from groups(f"{name} > {title}", inside)

    there = {path.relative_to(docs).as_posix() for path in docs.rglob("*.md")}
    lost = sorted(there - {path for _, path in pages_of(nav)})
    return [*groups("the menu", nav), *(f"docs/{name} stands in no group of mkdocs.yml" for name in lost)]


def _about(path: str) -> str:
    """The first sentence of a page, its question in bold or what it is about."""
    text = (DOCS / path).read_text("utf-8").split("\n\n")
    words = next(part for part in text[1:] if part and not part.startswith(("#", "!", "|", "`", "*Code")))
    sentence = re.split(r"(?<=[^.\d]\.)\s|(?<=[a-z]\.)\s", " ".join(words.split()))[0]
    sentence = sentence.replace("**", "")
    inside = path.rpartition("/")[0]
    return re.sub(r"\]\((?!\w+:|/)([^)]+)\)", lambda link: f"]({link[1]})" if inside else link[0], sentence)


def _contents(title: str, words: str, group: list[Any]) -> str:
    parts = [f"# {title}", words]
    for entry in group:
        if isinstance(entry, str):
            continue
        for name, inside in entry.items():
            pages = [(name, inside)] if isinstance(inside, str) else list(pages_of(inside))
            if not isinstance(inside, str):
                parts.append(f"## {name}")
            parts.append("\n".join(f"- [{page}]({Path(path).name}): {_about(path)}" for page, path in pages))
    return "\n\n".join(parts) + "\n"


# ---- what mkdocs calls -------------------------------------------------------------------------------------------
def on_config(config):
    """Refuse a menu that has lost a page or grown too long."""
    if wrong := faults(config.nav, DOCS):
        raise PluginError("the menu of the site:\n" + "\n".join(wrong))
    return config


def on_files(files, config):
    """Make the tables of contents."""
    groups = {title: inside for entry in config.nav for title, inside in entry.items()}
    for name, words in _CONTENTS.items():
        first = next(entry for entry in groups[name] if isinstance(entry, str))
        files.append(File.generated(config, first, content=_contents(name, words, groups[name])))
    return files
