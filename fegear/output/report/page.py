"""The page itself: head, navigation, sections, and the files that it carries.

The door to Jinja2: templates become a page, every text in it escaped.

plotly.js, compressed, from plotly's wheel.

What a page needs, whatever it will say: made in threads while the results are computed.
"""

from __future__ import annotations

import base64
import gzip
import io
import re
import threading
import zipfile
from concurrent.futures import Future
from dataclasses import dataclass, field
from functools import cache
from importlib import resources
from importlib.util import find_spec
from pathlib import Path, PurePosixPath
from typing import TYPE_CHECKING, TypeVar

import fegear
from fegear.base.errors import MissingLibraryError
from fegear.base.interrupts import deaf
from fegear.output.draw_plotly.layout import darker, plotly_json, template
from fegear.output.file_names import file_name
from fegear.output.numbers import pretty_unit
from fegear.output.report.blocks import Block, as_words, readable
from fegear.output.report.kept import keep, kept, recalled
from fegear.output.tables import KINDS, table_bytes, table_file

if TYPE_CHECKING:
    from collections.abc import Callable, Iterable, Mapping

    from jinja2 import Environment
    from jinja2.bccache import Bucket

    from fegear.engine.figure.figure import Figure
    from fegear.engine.table import Table


#: Files in archives carry this date, so that equal content is equal bytes.
_DATE = (1980, 1, 1, 0, 0, 0)
#: The sign of a negative number in a sentence; of `key = -0.2` it is that of the case.
_NEGATIVE = re.compile(r"(?<![^\s(])(?<!= )-(?=\.?\d)")


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
    tables = {
        str(PurePosixPath("tables", table_file(table)).with_suffix(f".{kind}")): table_bytes(table, kind)
        for table in page.tables for kind in (KINDS if table.matlab else KINDS[:1])
    }  # fmt: skip
    files = tables | dict(page.files)
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


def _resource(name: str) -> str:
    return resources.files("fegear.output.report").joinpath(name).read_text("utf-8")


def _base64(content: bytes) -> str:
    return base64.b64encode(content).decode()


def _symbols(text: str) -> list[tuple[str, str]]:
    """Words of a text that names symbols as d_b: what stands on the line and what stands lower, in turns."""
    parts = re.split(r"(?<=\b\w)_(\w+)", text)
    return list(zip(parts[::2], [*parts[1::2], ""], strict=True))


def _known_symbols(text: str) -> list[tuple[str, str]]:
    """The same of sentences and heads, for symbols of the trade only: S_H, K_Hβ, C_β; names of gears stay.

    The arrow of a change (1.26 -> 1.13) is one letter: a line may not end within it, nor before it. The hyphen before a
    negative number is a minus sign, but for that of a key's value, which may be pasted into a case.
    """
    text = _NEGATIVE.sub("−", text.replace(" -> ", "\N{NO-BREAK SPACE}→ "))
    parts = re.split(r"(?<=\b[A-Zσ])_([A-Zαβ][A-Za-zαβ]*|yield)", text)
    return list(zip(parts[::2], [*parts[1::2], ""], strict=True))


@cache
def templates() -> Future[Environment]:
    """Jinja2 with the compiled templates, in a thread: most of a run holds no lock of the interpreter."""
    return begun(_environment)


def _environment() -> Environment:
    # taking time, which only pages should cost
    from jinja2 import BytecodeCache, Environment, PackageLoader, StrictUndefined, __version__

    class Compiled(BytecodeCache):
        """Templates compiled by an earlier run; jinja2 looks whether they are of this text and this Python."""

        def load_bytecode(self, bucket: Bucket) -> None:
            known = recalled(f"{bucket.key} {__version__}")
            if known is not None:
                bucket.bytecode_from_string(known)

        def dump_bytecode(self, bucket: Bucket) -> None:
            keep(f"{bucket.key} {__version__}", bucket.bytecode_to_string())

    made = Environment(
        loader=PackageLoader("fegear.output.report"), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True, auto_reload=False,
        bytecode_cache=Compiled(),
    )  # fmt: skip
    # JSON that can stand inside a script: `tojson` writes <, > and & as \u003c, \u003e and \u0026.
    made.policies["json.dumps_kwargs"] = {"ensure_ascii": False, "separators": (",", ":"), "allow_nan": False}

    def drawn(item: object) -> str:
        block = item if isinstance(item, Block) else readable(item)
        if isinstance(block, str):
            return block
        return getattr(made.get_template("blocks.html").module, type(block).__name__)(block)

    made.filters.update(
        symbols=_symbols,
        known_symbols=_known_symbols,
        base64=_base64,
        drawn=drawn,
        resource=_resource,
        unit=pretty_unit,
        words=as_words,
    )
    for name in ("page.html", "blocks.html"):
        made.get_template(name)
    return made


def render(template: str, **content: object) -> str:
    """Render a template of the folder ``templates``.

    Parameters
    ----------
    template : str
    **content
        What the template names; a name that is missing is an error (`jinja2.UndefinedError`).
    """
    return templates().result().get_template(template).render(content)


def fragment(blocks: Iterable[Block]) -> str:
    """Some blocks of a page by themselves, as HTML."""
    drawn = templates().result().filters["drawn"]
    return "".join(str(drawn(block)) for block in blocks)


#: Quick, and only 4 % larger than the best.
_LEVEL = 4


def compressed_plotly() -> str:
    """Return plotly.js as base64 of gzip, 2 MB; the page's script unpacks it.

    The library is found without importing plotly, which would take half as long as a whole run.

    Raises
    ------
    MissingLibraryError
        If plotly's wheel is not there or has no script.
    """
    return compression().result()


@cache
def compression() -> Future[str]:
    """Compression in a thread of its own: zlib holds nobody up."""
    return begun(_compressed)


def _compressed() -> str:
    path = plotly_file()
    state = path.stat()
    of = f"{path} {state.st_size} {state.st_mtime_ns} {_LEVEL}"
    return base64.b64encode(kept(of, lambda: gzip.compress(path.read_bytes(), _LEVEL, mtime=0))).decode()


def plotly_file() -> Path:
    """Where plotly.js lies.

    Raises
    ------
    MissingLibraryError
        If plotly's wheel is not there or has no script.
    """
    spec = find_spec("plotly")
    folders = (spec.submodule_search_locations or []) if spec else []
    for folder in folders:
        path = Path(folder) / "package_data" / "plotly.min.js"
        if path.is_file():
            return path
    raise MissingLibraryError("plotly.js is missing, so the report has no plots; run: pip install plotly")


T = TypeVar("T")


def begun(make: Callable[[], T]) -> Future[T]:
    """Start making something in a thread of its own; what goes wrong there is raised where the result is asked for.

    The program never waits for the thread at its end: a stop that strikes while a module is loaded can leave Python's
    lock of imports taken, and a thread that loads one itself would then wait for ever.

    Requests to stop wait for the main thread: while gmsh starts there, this one would end the program by them, for gmsh
    has given their handlers back to the system. What is made must start no program, which would not hear them either.
    """
    made: Future[T] = Future()

    def work() -> None:
        try:
            made.set_result(make())
        except BaseException as problem:  # noqa: BLE001  (raised by `result`)
            made.set_exception(problem)

    with deaf():
        threading.Thread(target=work, daemon=True).start()
    return made
