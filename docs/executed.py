"""Hook of mkdocs: every page's commands and programs are run, and the page shows the pictures that they made.

A page links to what its reader will find, ``results/drive/plots/tooth.png``; the site has that file from the page's own
run. Runs are kept in ``results/pages`` and made anew when the page or the program changes. ``FEGEAR_GALLERY``, if set,
names the pages to run as it names the cases.
"""

from __future__ import annotations

import logging
import re
import textwrap
from functools import partial
from pathlib import Path
from typing import TYPE_CHECKING

from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File
from shortened import chosen
from snippets import execute, runs

from fegear.base.cache_keys import content_key
from fegear.base.code_version import code_version

if TYPE_CHECKING:
    from collections.abc import Callable

DOCS = Path(__file__).resolve().parent
MADE = DOCS.parent / "results" / "pages"
log = logging.getLogger("mkdocs.plugins.executed")
_NOTE = re.compile(r"^Note: .{79,}$", re.MULTILINE)
_MADE_LINK = re.compile(r"\]\((results/[^)#]+)\)")
#: A whole link to a file of a run, or its picture.
_MADE = re.compile(r"!?\[([^\]]*)\]\(results/[^)]+\)")


def pages() -> list[Path]:
    """Pages with something to run."""
    return [page for page in sorted(DOCS.rglob("*.md")) if runs(page) and chosen(page.stem)]


def _folder(page: Path) -> Path:
    return MADE / page.relative_to(DOCS).with_suffix("")


def _run(page: Path) -> None:
    folder = _folder(page)
    stamp = folder.with_suffix(".key")
    key = content_key(code_version(), page.read_text("utf-8"), (DOCS / "snippets.py").read_text("utf-8"))
    if stamp.is_file() and stamp.read_text() == key:
        return
    log.info("Running the commands of docs/%s", page.relative_to(DOCS))
    stamp.unlink(missing_ok=True)
    if fault := execute(page, folder):
        raise PluginError(f"{page.relative_to(DOCS.parent)} does not do what it says: {fault}")
    stamp.write_text(key)


def jobs() -> list[Callable[[], None]]:
    """What is to be run before the pages can show it."""
    return [partial(_run, page) for page in pages()]


def on_files(files, config):
    """Add the files that the pages show, which docs/made.py has run."""
    for page in pages():
        relative = page.relative_to(DOCS)
        for link in dict.fromkeys(_MADE_LINK.findall(page.read_text("utf-8"))):
            made = _folder(page) / link
            if not made.is_file():
                raise PluginError(f"{relative} shows {link}, which its commands do not make")
            shown = relative.with_suffix("").as_posix() + f"_files/{link}"
            files.append(File.generated(config, shown, abs_src_path=str(made)))
    return files


def on_page_markdown(markdown, page, **_others):
    """Let links to results lead to the page's own run, if it was run, and fold the long sentences of its notes."""
    if not chosen(Path(page.file.src_uri).stem):
        markdown = _MADE.sub(r"\1 (not run for this shortened site)", markdown)
    linked = _MADE_LINK.sub(rf"]({Path(page.file.src_uri).stem}_files/\1)", markdown)
    return _NOTE.sub(lambda found: textwrap.fill(found[0], 84, subsequent_indent="      "), linked)
