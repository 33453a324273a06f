"""The page itself: head, navigation, sections, and the files that it carries."""

from __future__ import annotations

import io
import re
import zipfile
from dataclasses import dataclass, field
from typing import TYPE_CHECKING

import fegear
from fegear.errors import MissingLibraryError
from fegear.output.draw_plotly import darker, plotly_json, template
from fegear.output.file_names import file_name
from fegear.output.report.library import compressed_plotly, compression
from fegear.output.report.rendering import render, templates
from fegear.output.tables import table_file, table_text

if TYPE_CHECKING:
    from collections.abc import Mapping
    from pathlib import Path

    from fegear.engine.figure import Figure
    from fegear.engine.outcome import Table
    from fegear.output.report.blocks import Block

#: Files in archives carry this date, so that equal content is equal bytes.
_DATE = (1980, 1, 1, 0, 0, 0)


def begin_page() -> None:
    """Let what every page needs be made while something else is computed: plotly.js compressed, templates compiled."""
    compression()
    templates()


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


def _figures(page: Page) -> list[Figure]:
    def within(block: object) -> list[Figure]:
        found = getattr(block, "figure", None)
        inner = [figure for part in getattr(block, "blocks", ()) for figure in within(part)]
        return ([found] if found is not None else []) + inner

    return [figure for section in page.sections for block in section.blocks for figure in within(block)]


def _library() -> dict[str, str]:
    """plotly.js, or why there is none: a run's results are not lost for want of their plots."""
    try:
        return {"plotly": compressed_plotly(), "missing": ""}
    except MissingLibraryError as error:
        return {"plotly": "", "missing": f"{error}."}


def page_text(page: Page) -> str:
    """Make the page.

    Returns
    -------
    str
        HTML without any reference to other files.
    """
    files = {f"tables/{table_file(table)}": table_text(table).encode() for table in page.tables} | dict(page.files)
    figures = _figures(page)
    return render(
        "page.html",
        page=page,
        sections=[section for section in page.sections if section.blocks],
        files=archive(files) if files else b"",
        figures=[{"key": figure.key, **plotly_json(figure)} for figure in figures],
        shades={"template": template(), "darker": darker(figures)},
        archive=file_name(page.name),
        version=fegear.__version__,
        **(_library() if figures else {"plotly": "", "missing": ""}),
    )


def write_page(path: Path, page: Page) -> None:
    """Write a page into one file."""
    path.write_text(page_text(page), encoding="utf-8", newline="\n")
