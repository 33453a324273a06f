"""Hook of mkdocs: docs/case-files.md, one page in the repository, is a page for each group of tables on the site.

Links to a table lead to the page that holds it.
"""

from __future__ import annotations

import re
from pathlib import Path

from markdown.extensions.toc import slugify
from mkdocs.structure.files import File

PAGE = Path(__file__).resolve().parent / "case-files.md"
#: Pages by name: title and the tables that they hold; what stands in none stays on the first page.
PAGES = {
    "case-files-gears.md": ("Case files: gears", ("gear",)),
    "case-files-pairs.md": ("Case files: pairs", ("pair",)),
    "case-files-trains.md": (
        "Case files: trains, sets and shafts", ("train", "dynamics", "planetary", "shaft", "transmissibility"),
    ),
    "case-files-results.md": (
        "Case files: what single results read",
        ("stiffness", "study", "tooth_contact", "load_distribution", "transmission_error", "loading", "cost"),
    ),
    "case-files-design.md": (
        "Case files: design and tolerances", ("design", "robustness", "flank_design", "fillet_design"),
    ),
    "case-files-accuracy.md": ("Case files: effects, accuracy and rating", ("effects", "accuracy", "rating")),
}  # fmt: skip
_HEAD = re.compile(r"^(#{2,3}) (.+)$", re.MULTILINE)


def split(text: str) -> tuple[dict[str, str], dict[str, str]]:
    """The text of every page, and the page of every heading by its anchor."""
    first, *sections = re.split(r"^(?=## )", text, flags=re.MULTILINE)
    parts = {PAGE.name: [first]} | {name: [f"# {title}\n\n"] for name, (title, _) in PAGES.items()}
    homes = {}
    for section in sections:
        table = re.match(r"## `\[(\w+)", section)
        name = next((page for page, (_, tables) in PAGES.items() if table and table[1] in tables), PAGE.name)
        parts[name].append(section)
        homes |= {slugify(head[2].replace("`", ""), "-"): name for head in _HEAD.finditer(section)}
    listed = "".join(
        f"- [{title.partition(': ')[2].capitalize()}]({name}): {', '.join(f'`[{table}]`' for table in tables)}\n"
        for name, (title, tables) in PAGES.items()
    )
    parts[PAGE.name].insert(1, f"## The tables\n\n{listed}\n")
    return {name: "".join(inside) for name, inside in parts.items()}, homes


def relinked(markdown: str, own: str, homes: dict[str, str]) -> str:
    """Links of a page that lead to a heading of docs/case-files.md, to the page where that stands."""
    if own in (PAGE.name, *PAGES):
        markdown = re.sub(
            r"\]\(#([\w-]+)\)", lambda link: f"]({homes[link[1]]}#{link[1]})" if link[1] in homes else link[0], markdown
        )
    return re.sub(
        r"case-files\.md#([\w-]+)", lambda link: f"{homes.get(link[1], PAGE.name)}#{link[1]}", markdown
    )  # fmt: skip


# ---- what mkdocs calls -------------------------------------------------------------------------------------------
def on_files(files, config):
    """Add the pages of the groups."""
    texts, _ = split(PAGE.read_text("utf-8"))
    for name in PAGES:
        files.append(File.generated(config, name, content=texts[name]))
    return files


def on_page_markdown(markdown, page, **_others):
    """The first page without the others' tables, and links that find them."""
    texts, homes = split(PAGE.read_text("utf-8"))
    if page.file.src_uri == PAGE.name:
        markdown = texts[PAGE.name]
    return relinked(markdown, page.file.src_uri, homes)
