"""Hook of mkdocs: the tables of "Verification", from the page's run of ``fegear verify`` and the papers' cases."""

from __future__ import annotations

import json
from typing import TYPE_CHECKING, Any

from executed import MADE as PAGES
from gallery import MADE as RUNS
from gallery import case_name
from gallery import cases as run_cases
from source_rows import kept, sources
from source_runs import Run

if TYPE_CHECKING:
    from collections.abc import Iterator

_HEAD = (
    "| what, and the command that repeats it | compared with | numbers | largest difference | stated there | allowed |"
)
_KEPT = PAGES / "proofs" / "verify.json"


def _line(*cells: str) -> str:
    return f"| {' | '.join(cell.replace('|', chr(92) + '|') for cell in cells)} |"


def _of_verify(kind: str) -> Iterator[str]:
    for row in json.loads(_KEPT.read_text("utf-8"))["rows"]:
        if row["against"] == kind:
            words = f"**{row['capability'][0].upper()}{row['capability'][1:]}.** {row['what'].rstrip('.')}"
            count = f"{row['numbers']}" + (f" ({row['known_to_differ']} differ)" if row["known_to_differ"] else "")
            stated = "" if row["stated_error"] is None else f"{row['stated_error']:.1e}"
            sizes = f"{row['largest_difference']:.1e}", stated, f"{row['allowed']:.1e}"
            yield _line(f"{words}<br>`fegear verify {row['name']}`", row["source"], count, *sizes)


def _of_papers() -> Iterator[str]:
    """Rows of the papers that print a number which no input holds; what differs is counted with it."""
    made = set(map(case_name, run_cases()))
    for name, source in sources().items():
        for row in source.row:
            pairs = list(zip(row.numbers, row.cases_of_numbers(), strict=True))
            held = [(number, case) for number, case in pairs if number.kind == "printed"]
            if not held or not {case for number, case in held if not number.kept} <= made:
                continue
            largest = max(_apart(number, case) for number, case in held)
            differing = sum(number.kind == "differs" for number, _ in pairs)
            count = str(len(held) + differing) + (f" ({differing} differ)" if differing else "")
            paper = f"[{source.title.partition(':')[0]}](sources/{name}.md), {', '.join(row.covers)}"
            case = row.case or held[0][1]
            words = f"**{row.shows}**<br>`fegear run cases/{case}.toml`"
            yield _line(words, paper, count, f"{largest:.1e}", "", "the print")


def _apart(number: Any, case: str) -> float:
    """Relative difference from the print."""
    run = kept(number.kept) if number.kept else Run.in_folder(RUNS / case)
    wanted = number.in_print().value
    return abs(number.read(run).value - wanted) / (abs(wanted) or 1.0)


def on_page_markdown(markdown, page, **_others):
    """Put the tables in place; a shortened site that has not run the page says so."""
    if page.file.src_uri != "proofs.md":
        return markdown
    for kind in ("printed", "program", "own"):
        lines = [*_of_verify(kind)] if _KEPT.is_file() else ["| not run in this shortened site | | | | | |"]
        if kind == "printed":
            lines += _of_papers()
        table = "\n".join([_HEAD, "|---" * 6 + "|", *lines])
        markdown = markdown.replace(f"<!-- {kind} -->", f"{len(lines)} rows.\n\n{table}")
    return markdown
