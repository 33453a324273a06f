"""The pieces that pages are made of: texts, facts, values, tables, plots, pictures, folded parts."""

from __future__ import annotations

import base64
import html
from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.output.numbers import plain_number, pretty_unit, with_error
from fegear.output.tables import cell

if TYPE_CHECKING:
    from fegear.engine.figure import Figure
    from fegear.engine.outcome import Column, Table, Value
    from fegear.output.draw_png import Picture
    from fegear.output.report.page import Block

#: Rows of a table that stand in the page as text; the others are a click away.
_ROWS = 6
#: Larger errors than this share of the value are given as absolute numbers alone.
_MEANINGLESS = 0.5


def text(value: object) -> str:
    """Escape a text for HTML."""
    return html.escape(str(value))


def readable(value: object) -> str:
    """Anything plain as HTML: numbers short, mappings and lists of mappings as tables, lists in a row."""
    if isinstance(value, bool):
        return "yes" if value else "no"
    if isinstance(value, float):
        return plain_number(value)
    if isinstance(value, Mapping):
        return _pairs(value)
    if isinstance(value, Sequence) and not isinstance(value, str):
        if value and all(isinstance(item, Mapping) for item in value):
            heads = list(dict.fromkeys(str(key) for item in value for key in item))
            head = "".join(f"<th scope='col'>{_words(key)}</th>" for key in heads)
            rows = "".join(
                "<tr>" + "".join(f"<td>{readable(item.get(key, ''))}</td>" for key in heads) + "</tr>" for item in value
            )
            return f"<div class='wide'><table><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></div>"
        return ", ".join(readable(item) for item in value) or "none"
    return text(value)


def _words(key: object) -> str:
    """A name as words; names with dots are keys and stay as they are written."""
    name = str(key)
    return text(name if "." in name else name.replace("_", " "))


def _head(column: Column) -> str:
    """Name and unit of a column; some tables have the unit in the name."""
    name, _, unit = (
        column.name.removesuffix("]").partition(" [") if column.name.endswith("]") else (column.name, "", "")
    )
    unit = pretty_unit(column.unit or unit)
    return _words(name) + (f" <span class='unit'>{text(unit)}</span>" if unit else "")


def _pairs(found: Mapping[str, object]) -> str:
    rows = "".join(
        f"<tr><th scope='row'>{_words(key)}</th><td>{readable(value)}</td></tr>" for key, value in found.items()
    )
    return f"<table class='facts'><tbody>{rows}</tbody></table>"


@dataclass(frozen=True)
class Paragraph:
    """A paragraph."""

    words: str
    kind: str = ""

    def html(self) -> str:
        """Return it as HTML."""
        return f"<p class='{self.kind}'>{text(self.words)}</p>" if self.kind else f"<p>{text(self.words)}</p>"


@dataclass(frozen=True)
class Heading:
    """A heading inside a section."""

    words: str
    anchor: str = ""

    def html(self) -> str:
        """Return it as HTML."""
        name = f" id='{text(self.anchor)}'" if self.anchor else ""
        return f"<h3{name}>{text(self.words)}</h3>"


@dataclass(frozen=True)
class Notes:
    """Sentences that the reader should see; `kind` is ``warning`` where they change what the numbers mean."""

    sentences: Sequence[str]
    kind: str = "note-list"

    def html(self) -> str:
        """Return them as HTML."""
        items = "".join(f"<li>{text(sentence)}</li>" for sentence in self.sentences)
        return f"<ul class='{self.kind}'>{items}</ul>" if items else ""


@dataclass(frozen=True)
class Facts:
    """Names and what belongs to them."""

    found: Mapping[str, object]

    def html(self) -> str:
        """Return them as HTML."""
        return _pairs(self.found)


@dataclass(frozen=True)
class Grid:
    """A small table of texts."""

    heads: Sequence[str]
    rows: Sequence[Sequence[object]]
    kind: str = ""

    def html(self) -> str:
        """Return it as HTML."""
        head = "".join(f"<th scope='col'>{text(item)}</th>" for item in self.heads)
        rows = "".join("<tr>" + "".join(f"<td>{readable(item)}</td>" for item in row) + "</tr>" for row in self.rows)
        table = f"<table class='{self.kind}'><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table>"
        return f"<div class='wide'>{table}</div>"


@dataclass(frozen=True)
class Bars:
    """What each part took, as bars that print."""

    parts: Mapping[str, float]
    unit: str

    def html(self) -> str:
        """Return them as HTML."""
        largest = max(self.parts.values(), default=0.0) or 1.0
        rows = "".join(
            f"<tr><th scope='row'>{text(name)}</th><td class='bar'><span style='width:{100 * value / largest:.1f}%'>"
            f"</span></td><td class='number'>{value:.3f} {text(self.unit)}</td></tr>"
            for name, value in self.parts.items()
        )
        return f"<table class='bars'><tbody>{rows}</tbody></table>"


@dataclass(frozen=True)
class Folded:
    """Blocks behind a line to click on."""

    title: str
    blocks: tuple[Block, ...]
    opened: bool = False

    def html(self) -> str:
        """Return it as HTML."""
        inner = "".join(block.html() for block in self.blocks)
        state = " open" if self.opened else ""
        return f"<details{state}><summary>{text(self.title)}</summary>{inner}</details>" if inner else ""


@dataclass(frozen=True)
class Code:
    """A file as it is."""

    content: str

    def html(self) -> str:
        """Return it as HTML."""
        return f"<pre tabindex='0'><code>{text(self.content)}</code></pre>"


@dataclass(frozen=True)
class Download:
    """A button that hands out a file of the page."""

    file: str

    def html(self) -> str:
        """Return it as HTML."""
        return f"<button type='button' class='button' data-file='{text(self.file)}'>Download {text(self.file)}</button>"


def value_cells(value: Value) -> tuple[str, str]:
    """Value and error of a result as two texts."""
    error = value.shown_error
    if error is None:
        return plain_number(value.shown), "not estimated"
    if error <= 0.0:
        return plain_number(value.shown), "exact"
    return with_error(value.shown, error)


@dataclass(frozen=True)
class Values:
    """Single results with their errors, and how these compare with the tolerance."""

    values: Sequence[Value]
    tolerance: float | None = None

    def html(self) -> str:
        """Return them as HTML."""
        rows = "".join(map(self._row, self.values))
        heads = ("Quantity", "Value", "Estimated error", "Unit")
        head = "".join(f"<th scope='col'>{item}</th>" for item in heads)
        return (
            f"<div class='wide'><table class='values'><thead><tr>{head}</tr></thead><tbody>{rows}</tbody></table></div>"
        )

    def _row(self, value: Value) -> str:
        number, error = value_cells(value)
        exact = error in ("exact", "not estimated")
        mark = f"<span class='quiet'>{error}</span>" if exact else f"± {error}{self._share(value)}"
        meaning = f"<span class='quiet'>{text(value.meaning)}</span>" if value.meaning else ""
        unit = pretty_unit(value.unit)
        return (
            f"<tr><th scope='row'><code>{text(value.name)}</code>{meaning}</th>"
            f"<td class='number'><b>{number}</b></td><td class='error'>{mark}</td><td>{text(unit)}</td></tr>"
        )

    def _share(self, value: Value) -> str:
        share = relative_error(value)
        if share is None:
            return ""
        over = self.tolerance is not None and share > self.tolerance
        percent = plain_number(100.0 * share, 2)
        return (
            f" <span class='{'over' if over else 'quiet'}'>({percent} %{', over the tolerance' if over else ''})</span>"
        )


def relative_error(value: Value) -> float | None:
    """Estimated error over the value; None where there is no estimate or the value is as good as zero."""
    if not value.error or not value.value:
        return None
    share = abs(value.error / value.value)
    return share if share <= _MEANINGLESS else None


@dataclass(frozen=True)
class DataTable:
    """The beginning of a table, with what it takes to see all of it, to sort it and to download it."""

    table: Table

    def html(self) -> str:
        """Return it as HTML."""
        table = self.table
        count = len(table.columns[0].values)
        shown = [column.shown[:_ROWS] for column in table.columns]
        head = "".join(
            f"<th scope='col' title='{text(c.meaning)}'><button type='button' class='sort'>{_head(c)}</button></th>"
            for c in table.columns
        )
        rows = "".join(
            "<tr>" + "".join(f"<td>{_short(cell(column[i]))}</td>" for column in shown) + "</tr>"
            for i in range(min(count, _ROWS))
        )
        file = f"tables/{table.name}.csv"
        more = f"<button type='button' class='more'>Show all {count} rows</button>" if count > _ROWS else ""
        note = f"{count} rows" if count != 1 else "1 row"
        title = table.title or table.name
        return (
            f"<div class='data' data-file='{text(file)}'><p class='table-title'><b>{text(title)}</b> "
            f"<span class='quiet'>{note}</span></p>"
            f"<div class='wide' tabindex='0' role='region' aria-label='{text(title)}'><table><thead><tr>{head}</tr>"
            f"</thead><tbody>{rows}</tbody></table></div><p class='tools'>{more}"
            f"<button type='button' class='button' data-file='{text(file)}'>Download {text(table.name)}.csv</button>"
            "</p></div>"
        )


def _short(cell: str) -> str:
    try:
        return plain_number(float(cell)) if not cell.lstrip("-").isdigit() else cell.replace("-", "−")
    except ValueError:
        return text(cell)


@dataclass(frozen=True)
class Plot:
    """An interactive figure; the page's script draws it."""

    figure: Figure

    def html(self) -> str:
        """Return its place as HTML."""
        f = self.figure
        return (
            f"<figure class='plot-figure'><div class='plot-title'>{text(f.title)}</div>"
            f"<div class='plot' id='plot-{text(f.key)}' role='img' aria-label='{text(f.title)}. {text(f.caption)}'>"
            "<noscript>The plots of this page need JavaScript; the same pictures are in the folder plots/.</noscript>"
            f"</div><figcaption>{text(f.caption)}</figcaption></figure>"
        )


@dataclass(frozen=True)
class Still:
    """A picture of the folder ``plots``, embedded."""

    picture: Picture

    def html(self) -> str:
        """Return it as HTML."""
        p = self.picture
        image = f"data:image/png;base64,{base64.b64encode(p.path.read_bytes()).decode()}"
        return (
            f"<figure><div class='plot-title'>{text(p.title)}</div>"
            f"<img src='{image}' alt='{text(p.title)}. {text(p.caption)}'>"
            f"<figcaption>{text(p.caption)}</figcaption></figure>"
        )
