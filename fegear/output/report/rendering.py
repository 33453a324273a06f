"""The door to Jinja2: templates become a page, every text in it escaped."""

from __future__ import annotations

import base64
import re
from functools import cache
from importlib import resources
from typing import TYPE_CHECKING

from fegear.output.numbers import pretty_unit
from fegear.output.report.ahead import begun
from fegear.output.report.blocks import Block, as_words, readable

if TYPE_CHECKING:
    from collections.abc import Iterable
    from concurrent.futures import Future

    from jinja2 import Environment


def _resource(name: str) -> str:
    return resources.files("fegear.output.report").joinpath(name).read_text("utf-8")


def _base64(content: bytes) -> str:
    return base64.b64encode(content).decode()


def _symbols(text: str) -> list[tuple[str, str]]:
    """Words of a text that names symbols as d_b: what stands on the line and what stands lower, in turns."""
    parts = re.split(r"(?<=\b\w)_(\w+)", text)
    return list(zip(parts[::2], [*parts[1::2], ""], strict=True))


@cache
def templates() -> Future[Environment]:
    """Jinja2 with the compiled templates, .1 s of work, in a thread: most of a run holds no lock of the interpreter."""
    return begun(_environment)


def _environment() -> Environment:
    from jinja2 import Environment, PackageLoader, StrictUndefined  # takes time, which only pages should cost

    made = Environment(
        loader=PackageLoader("fegear.output.report"), autoescape=True, undefined=StrictUndefined,
        trim_blocks=True, lstrip_blocks=True, keep_trailing_newline=True, auto_reload=False,
    )  # fmt: skip
    # JSON that can stand inside a script: `tojson` writes <, > and & as \u003c, \u003e and \u0026.
    made.policies["json.dumps_kwargs"] = {"ensure_ascii": False, "separators": (",", ":"), "allow_nan": False}

    def drawn(item: object) -> str:
        block = item if isinstance(item, Block) else readable(item)
        if isinstance(block, str):
            return block
        return getattr(made.get_template("blocks.html").module, type(block).__name__)(block)

    made.filters.update(
        symbols=_symbols, base64=_base64, drawn=drawn, resource=_resource, unit=pretty_unit, words=as_words
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
