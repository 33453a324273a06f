"""The page itself: head, navigation, sections, and the files that it carries."""

from __future__ import annotations

import base64
import html
import io
import json
import re
import zipfile
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING, Protocol

import fegear
from fegear.errors import MissingLibraryError
from fegear.output.draw_plotly import darker, plotly_json, template
from fegear.output.report.library import compressed_plotly
from fegear.output.tables import table_text

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from fegear.engine.figure import Figure
    from fegear.engine.outcome import Table

#: Files in archives carry this date, so that equal content is equal bytes.
_DATE = (1980, 1, 1, 0, 0, 0)


class Block(Protocol):
    """A piece of a page."""

    def html(self) -> str:
        """Return the piece as HTML."""


@dataclass(frozen=True)
class Section:
    """A heading and what stands below it; empty sections are not shown."""

    title: str
    blocks: tuple[Block, ...]

    @property
    def anchor(self) -> str:
        """Name by which links find it."""
        return re.sub(r"[^a-z0-9]+", "-", self.title.lower()).strip("-")


@dataclass(frozen=True)
class Page:
    """A whole page.

    Attributes
    ----------
    title : str
    note : str
        One line below the title.
    sections : tuple of Section
    tables : tuple of Table
        Carried as ``tables/<name>.csv``.
    files : mapping of str to bytes
        Other files that the page offers for download, the case file for one.
    name : str
        Stem of the archive of all files.
    """

    title: str
    note: str
    sections: tuple[Section, ...]
    tables: tuple[Table, ...] = ()
    files: Mapping[str, bytes] = field(default_factory=dict)
    name: str = "results"


def archive(files: Mapping[str, bytes]) -> bytes:
    """Pack files into a ZIP archive; equal files give equal bytes."""
    stream = io.BytesIO()
    with zipfile.ZipFile(stream, "w", zipfile.ZIP_DEFLATED, compresslevel=6) as packed:
        for name, content in files.items():
            packed.writestr(zipfile.ZipInfo(name, _DATE), content, zipfile.ZIP_DEFLATED)
    return stream.getvalue()


@cache
def _resource(name: str) -> str:
    return resources.files("fegear.output.report").joinpath(name).read_text("utf-8")


def _figures(page: Page) -> list[Figure]:
    def within(block: object) -> list[Figure]:
        found = getattr(block, "figure", None)
        inner = [figure for part in getattr(block, "blocks", ()) for figure in within(part)]
        return ([found] if found is not None else []) + inner

    return [figure for section in page.sections for block in section.blocks for figure in within(block)]


def _embedded(identity: str, kind: str, content: str) -> str:
    return f"<script type='{kind}' id='{identity}'>{content}</script>\n"


def _json(content: object) -> str:
    """JSON that can stand inside a script of a page."""
    return json.dumps(content, ensure_ascii=False, separators=(",", ":"), allow_nan=False).replace("<", "\\u003c")


def _library() -> str:
    """plotly.js, or why there is none: a run's results are not lost for want of their plots."""
    try:
        return _embedded("plotly", "text/plain", compressed_plotly())
    except MissingLibraryError as error:
        return _embedded("plotly-missing", "text/plain", html.escape(f"{error}.", quote=False))


def page_text(page: Page) -> str:
    """Make the page.

    Returns
    -------
    str
        HTML without any reference to other files.
    """
    files = {f"tables/{table.name}.csv": table_text(table).encode() for table in page.tables} | dict(page.files)
    sections = [section for section in page.sections if section.blocks]
    title = html.escape(page.title)
    links = "".join(f"<li><a href='#{s.anchor}'>{html.escape(s.title)}</a></li>" for s in sections)
    body = "".join(
        f"<section id='{s.anchor}' aria-labelledby='{s.anchor}-title'>\n<h2 id='{s.anchor}-title'>"
        f"{html.escape(s.title)}</h2>\n" + "\n".join(block.html() for block in s.blocks) + "\n</section>\n"
        for s in sections
    )
    figures = _figures(page)
    packed = base64.b64encode(archive(files)).decode()
    content = "all tables" + (" and the case file" if page.files else "")
    everything = (
        f"<p class='all'><a id='all-files' class='button' download='{html.escape(page.name)}.zip' "
        f"href='data:application/zip;base64,{packed}'>Download {content} (ZIP)</a></p>"
        if files
        else ""
    )
    scripts = _embedded("figures", "application/json", _json([{"key": f.key, **plotly_json(f)} for f in figures]))
    scripts += _embedded("shades", "application/json", _json({"template": template(), "darker": darker(figures)}))
    if figures:
        scripts += _library()
    return (
        f"<!DOCTYPE html>\n<html lang='en'>\n<head><meta charset='utf-8'><title>{title}</title>\n"
        "<meta name='viewport' content='width=device-width, initial-scale=1'>\n"
        "<meta name='color-scheme' content='light dark'><link rel='icon' href='data:,'>\n"
        f"<style>{_resource('page.css')}</style></head>\n<body>\n"
        f"<a class='skip' href='#content'>To the content</a>\n<header><h1>{title}</h1>"
        f"<p class='note'>{html.escape(page.note)}</p>{everything}</header>\n"
        f"<nav aria-label='Contents'><ul>{links}</ul></nav>\n"
        f"<main id='content'>\n{body}</main>\n"
        f"<footer><p class='note'>Made by fegear {fegear.__version__}. The page is whole in itself: it fetches nothing "
        "and can be sent as one file.</p></footer>\n"
        f"{scripts}<script>{_resource('page.js')}</script>\n</body>\n</html>\n"
    )


def write_page(path: Path, page: Page) -> None:
    """Write a page into one file."""
    path.write_text(page_text(page), encoding="utf-8", newline="\n")
