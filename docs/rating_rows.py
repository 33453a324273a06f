"""The tables of ``docs/rating-examples.md``: published numbers of ISO 6336 compared with fegear's, factor by factor.

``python docs/rating_rows.py`` writes them anew; ``test_rating_examples_literature.py`` holds them.
"""

from __future__ import annotations

from pathlib import Path

from fegear.verify.iso6336_examples import Row, rows
from fegear.verify.kept import examples

PAGE = Path(__file__).resolve().parent / "rating-examples.md"
_START, _END = "<!-- made by docs/rating_rows.py -->", "<!-- end -->"


def _verdict(row: Row) -> str:
    if row.used:
        return "K_v of the stresses is taken from it"
    if row.same:
        return "printed digits"
    return "printed digits, but for the rounding of inputs" if row.rounded else row.reason


def _line(row: Row) -> str:
    found = [f"{f:.{len(p.partition('.')[2]) + 2}f}" for p, f in zip(row.printed, row.found, strict=True)]
    apart = max((f / float(p) - 1.0 for p, f in zip(row.printed, row.found, strict=True)), key=abs)
    unit = f" [{row.unit}]" if row.unit else ""
    cells = (row.symbol + unit, row.clause, " / ".join(row.printed), " / ".join(found), f"{apart:+.1e}", _verdict(row))
    return f"| {' | '.join(cells)} |"


def table() -> str:
    """The tables of the page."""
    parts = []
    for example in examples().values():
        held = rows(example)
        same, free = sum(row.rounded and not row.used for row in held), sum(not row.used for row in held)
        parts += [
            f"## {example['title']}\n",
            f"Source: {example['source']} ({example['kind']}).\n",
            f"Of {free} printed factors {same} fall on the printed digits.\n",
            "| factor | clause | printed | fegear | largest relative difference | judgement |",
            "|---|---|---|---|---|---|",
            *map(_line, held),
            "",
        ]
    return "\n".join(parts)


def page() -> str:
    """The page with its tables made anew."""
    text = PAGE.read_text("utf-8")
    head, tail = text.partition(_START)[0], text.partition(_END)[2]
    return f"{head}{_START}\n\n{table()}\n{_END}{tail}"


if __name__ == "__main__":
    PAGE.write_text(page(), "utf-8")
