"""``report.html``: one self-contained page with what was asked, what was computed, numbers, seconds and pictures."""

from __future__ import annotations

import base64
import html
from importlib import resources
from typing import TYPE_CHECKING

import fegear
from fegear.show.tables import cell, table_text

if TYPE_CHECKING:
    from collections.abc import Iterable, Sequence
    from pathlib import Path

    from fegear.scene.outcome import Table, Value
    from fegear.scene.run import Results
    from fegear.show.pictures.style import Picture

#: Rows of a table that the page shows; the whole table is a click away, inside the page.
_ROWS = 12


def _text(value: object) -> str:
    return html.escape(str(value))


def _rows(rows: Iterable[Iterable[str]], tag: str = "td") -> str:
    return "\n".join("<tr>" + "".join(f"<{tag}>{item}</{tag}>" for item in row) + "</tr>" for row in rows)


def _section(title: str, body: str) -> str:
    return f"<section>\n<h2>{_text(title)}</h2>\n{body}\n</section>\n" if body else ""


def _data_uri(kind: str, content: bytes) -> str:
    return f"data:{kind};base64,{base64.b64encode(content).decode()}"


def _asked(results: Results) -> str:
    case, plan = results.scene.case, results.plan
    steps = _rows(
        (
            f"<b>{_text(step.task)}</b>",
            _text("; ".join(step.reasons)),
            _text(", ".join(step.effects) or "none"),
            f"{results.seconds[step.task]:.3f}",
        )
        for step in plan.steps
    )
    skipped = "".join(f"<li><b>{_text(name)}</b>: {_text(reason)}</li>" for name, reason in plan.skipped)
    return (
        f"<p>Wanted: {_text(', '.join(case.results))}. Tolerance {case.accuracy.tolerance:g}. "
        f"Effects that are on: {_text(', '.join(case.effects.on()) or 'none')}.</p>"
        "<table><thead><tr><th>Computed</th><th>Why</th><th>Effects used</th><th>Seconds</th></tr></thead>"
        f"<tbody>{steps}</tbody></table>"
        + (f"<details><summary>Not computed</summary><ul>{skipped}</ul></details>" if skipped else "")
    )


def _value_row(value: Value) -> tuple[str, ...]:
    error = value.shown_error
    shown = "exact" if error == 0.0 else "not estimated" if error is None else f"± {error:.1e}"
    return (
        f"<code>{_text(value.name)}</code>",
        f"<b>{value.shown:.6g}</b>",
        _text(value.unit),
        shown,
        _text(value.meaning),
    )


def _numbers(values: Sequence[Value]) -> str:
    if not values:
        return ""
    head = "<tr><th>Quantity</th><th>Value</th><th>Unit</th><th>Estimated error</th><th>Meaning</th></tr>"
    return f"<table class='numbers'><thead>{head}</thead><tbody>{_rows(map(_value_row, values))}</tbody></table>"


def _table(table: Table) -> str:
    count = len(table.columns[0].values)
    picked = range(count) if count <= _ROWS else [round(i * (count - 1) / (_ROWS - 1)) for i in range(_ROWS)]
    shown = [column.shown for column in table.columns]
    head = _rows([[f'<span title="{_text(c.meaning)}">{_text(c.head)}</span>' for c in table.columns]], "th")
    body = _rows([_short(cell(column[i])) for column in shown] for i in picked)
    link = _data_uri("text/csv", table_text(table).encode())
    note = f"{count} rows" if count <= _ROWS else f"{_ROWS} of {count} rows"
    return (
        f"<h3>{_text(table.title or table.name)}</h3><div class='wide'><table class='data'><thead>{head}</thead>"
        f"<tbody>{body}</tbody></table></div>"
        f"<p class='note'>{note}; <a download='{_text(table.name)}.csv' href='{link}'>{_text(table.name)}.csv</a></p>"
    )


def _short(text: str) -> str:
    try:
        return f"{float(text):.6g}"
    except ValueError:
        return _text(text)


def _picture(picture: Picture) -> str:
    image = _data_uri("image/png", picture.path.read_bytes())
    return (
        f"<figure><img src='{image}' alt='{_text(picture.title)}'>"
        f"<figcaption><b>{_text(picture.title)}.</b> {_text(picture.caption)}</figcaption></figure>"
    )


def _settings(results: Results) -> str:
    blocks = []
    for task, outcome in results.outcomes.items():
        if outcome.settings:
            rows = _rows((f"<code>{_text(key)}</code>", _text(value)) for key, value in outcome.settings.items())
            blocks.append(f"<details><summary>{_text(task)}</summary><table><tbody>{rows}</tbody></table></details>")
    return "".join(blocks)


def report(results: Results, pictures: Sequence[Picture], remarks: Sequence[str]) -> str:
    """Make the page.

    Parameters
    ----------
    results : Results
    pictures : sequence of Picture
        Embedded; their files are read here.
    remarks : sequence of str
        Sentences that the reader should see first.

    Returns
    -------
    str
        HTML without any reference to other files.
    """
    title = results.scene.case.title or results.scene.name
    total = sum(results.seconds.values())
    notes = "".join(f"<li>{_text(remark)}</li>" for remark in remarks)
    style = resources.files("fegear.show").joinpath("report.css").read_text("utf-8")
    return (
        f"<!DOCTYPE html>\n<html lang='en'>\n<head><meta charset='utf-8'><title>{_text(title)}</title>\n"
        "<meta name='viewport' content='width=device-width, initial-scale=1'>\n"
        f"<style>{style}</style></head>\n<body>\n<header><h1>{_text(title)}</h1>"
        f"<p class='note'>Case {_text(results.scene.name)}, computed by fegear {fegear.__version__} "
        f"in {total:.2f} s.</p></header>\n"
        + _section("To know first", f"<ul>{notes}</ul>" if notes else "")
        + _section("What was asked, what was computed", _asked(results))
        + _section("Numbers", _numbers(results.values))
        + _section("Pictures", "".join(map(_picture, pictures)))
        + _section("Tables", "".join(map(_table, results.tables)))
        + _section("Settings", _settings(results))
        + "</body>\n</html>\n"
    )


def write_report(path: Path, results: Results, pictures: Sequence[Picture], remarks: Sequence[str]) -> None:
    """Write the page."""
    path.write_text(report(results, pictures, remarks), encoding="utf-8")
