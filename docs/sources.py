"""Hook of mkdocs: the pages "Sources", figure by figure what the five papers print and what fegear gives."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gallery import MADE, case_name
from gallery import cases as run_cases
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File
from source_numbers import NUMBERS, ORIGINS
from source_rows import ROWS, Row, Source, cases, faults_of_runs, kept, sources
from source_runs import Run

from fegear.engine.citation import bibliography

if TYPE_CHECKING:
    from source_rows import Number

_HEAD = "| printed as | what it is | made by | number | in print | fegear | difference | kind |\n" + "|---" * 8 + "|"

#: Numbers of a row that the first page shows.
_SHOWN = 3
_WORDS = """\
What the papers that fegear implements print, figure by figure, and what fegear gives. Numbers are of several kinds,
which are counted separately: reproduced is only what is printed and comes out within the print, from an input that
does not hold it. A zero by construction, arithmetic on what is given and what a constant was inferred from are
input. Where the place of a maximum is read, the grid is finer than the print: on a coarser one a member of the grid
would be found. Each number is made by the case named with it when these pages are built, and tests hold it. A
paper's own page shows the pictures, drawn with the paper's axes, and what is to be said of each. Where the text of a
paper is damaged, the equation was derived anew and checked against another method; nothing is tuned to hit a print.
Where a number differs for good, the page shows what was tried."""


def _made(case: str) -> bool:
    """Whether the gallery has run the case for this site; a shortened one leaves cases out."""
    return case in map(case_name, run_cases())


def _number(number: Number, case: str) -> tuple[str, str, str, str, str]:
    """What it is, in print, fegear's, the difference and the kind: a cell each."""
    printed = number.in_print()
    shown = number.printed or (f'"{number.statement}"' if number.statement else "")
    if not (number.kept or _made(case)):
        return number.what, shown, "not run", "", number.kind
    got = number.read(kept(number.kept) if number.kept else Run.in_folder(MADE / case))
    if printed is None:
        apart = ""
    elif printed.value == 0.0:
        apart = f"{got.value - printed.value:+.2g}"
    else:
        apart = f"{got.value / printed.value - 1.0:+.2%}"
    return number.what, shown, f"{got.value:.5g} {got.unit}", apart, number.kind


def _why(number: Number) -> str:
    """The kind, and why it differs or is no answer, how accurately it is read and on which grid it was found."""
    kind = number.kind if number.origin is None else f"{number.kind} ({number.origin})"
    within = f" within {number.reading:g}" if number.reading is not None else ""
    grid = f", on a grid of {number.grid.step:g}" if number.grid is not None else ""
    why = number.because or number.by.replace("**", "^").replace("*", "×")
    return f"{kind}{within}{grid}: {why}" if why else f"{kind}{within}{grid}"


def _tried(row: Row, paper: str) -> str:
    """What was tried where numbers differ: a line for each, with what each number came to."""
    wanted = [number for number in row.numbers if any(number.what in tried.gave for tried in row.tried)]
    lines = [_cells(("tried", *(number.what for number in wanted))), "|---" * (len(wanted) + 1) + "|"]
    lines.append(_cells(("**in print**", *(number.printed or f'"{number.statement}"' for number in wanted))))
    lines.append(_cells(("as made here", *(f"{number.found:.5g}" for number in wanted))))
    for tried in row.tried:
        gave = (f"{tried.gave[number.what]:.5g}" if number.what in tried.gave else "" for number in wanted)
        lines.append(_cells((tried.what, *gave)))
    common = f" with `{'`, `'.join(row.trial)}`" if row.trial else ""
    again = f'`python docs/source_tried.py {paper} "{row.covers[0]}"`'
    return "\n".join(lines) + f"\n\nTried{common}; run again by {again}."


def _maker(row: Row, top: str) -> str:
    if row.case:
        return f"[{row.case.rpartition('/')[2]}]({top}gallery/{row.case}.md)"
    return f"`{row.command or row.function}`"


def _lines(row: Row, paper: str) -> list[str]:
    """A line of the table for each number; the first says what it is all about."""
    cells = [_number(n, case) for n, case in zip(row.numbers, row.cases_of_numbers(), strict=True)]
    if len(cells) > _SHOWN:
        more = f"and {len(cells) - _SHOWN + 1} more numbers on the paper's page"
        cells = [*cells[: _SHOWN - 1], (more, "", "", "", "")]
    name = f"[{', '.join(row.covers)}]({paper}.md#{_anchor(row)})"
    first, *rest = cells or [("", "", "", "", row.kind)]
    return [
        _cells((name, row.shows, _maker(row, "../"), *first)), *(_cells(("", "", "", *one)) for one in rest)
    ]  # fmt: skip


def _cells(parts: tuple[str, ...]) -> str:
    return "| " + " | ".join(part.replace("|", "\\|") for part in parts) + " |"


def _anchor(row: Row) -> str:
    return "item-" + "".join(letter if letter.isalnum() else "-" for letter in row.covers[0].lower())


def _count(rows: list[Row]) -> str:
    """How many numbers of each kind, and how many rows without one in print."""
    numbers = ", ".join(f"{n} {kind}" for kind in NUMBERS if (n := sum(row.count(kind) for row in rows)))
    words = ", ".join(f"{n} {kind}" for kind in ROWS if (n := sum(row.kind == kind for row in rows)))
    return f"Numbers: {numbers or 'none'}. Rows: {words}."


def _inventory() -> str:
    """Of every item of every paper: held, or differs, with what was tried."""
    verdicts = [verdict for source in sources().values() for verdict in source.verdicts().values()]
    items, held = sum(len(source.items) for source in sources().values()), verdicts.count("held")
    return (
        f"Of {items} figures, tables and groups of equations {held} are held and {len(verdicts) - held} differ, in "
        "whole or in part; the page of the paper shows what was tried of these."
    )


def _counts() -> str:
    """Numbers of each kind by paper."""
    papers = {name: list(source.row) for name, source in sources().items()}
    head = f"| numbers | {' | '.join(f'[{name}]({name}.md)' for name in papers)} | all | meaning |"
    lines = [head, "|---" * (len(papers) + 3) + "|"]
    for kind, means in NUMBERS.items():
        found = [sum(row.count(kind) for row in rows) for rows in papers.values()]
        lines.append(_cells((kind, *map(str, found), str(sum(found)), means)))
        if kind == "input":
            lines += [_origin(origin, papers) for origin in ORIGINS]
    return "\n".join(lines)


def _origin(origin: str, papers: dict[str, list[Row]]) -> str:
    """The line of the counts for one origin of input."""
    found = [sum(n.origin == origin for row in rows for n in row.numbers) for rows in papers.values()]
    return _cells((f"of these {origin}", *map(str, found), str(sum(found)), ORIGINS[origin]))


def overview() -> str:
    """Text of the first page: numbers of each kind by paper, what kinds of rows mean, and a table for each paper."""
    rows = [row for source in sources().values() for row in source.row]
    meanings = "\n".join(
        _cells((kind, str(sum(row.kind == kind for row in rows)), means)) for kind, means in ROWS.items()
    )
    repaired = sum(row.repaired for row in rows)
    parts = [
        "# Sources",
        _WORDS,
        _inventory(),
        _counts(),
        f"| row | rows | meaning |\n|---|---|---|\n{meanings}",
        f"In {repaired} rows an equation is damaged in the text and was repaired.",
    ]
    for name, source in sources().items():
        table = "\n".join([_HEAD, *(line for row in source.row for line in _lines(row, name))])
        parts.append(f"## [{source.title}]({name}.md)\n\n{_count(list(source.row))}\n\n{table}")
    return "\n\n".join(parts) + "\n"


def page(source: Source) -> str:
    """Text of a paper's page: its rows with their pictures and remarks."""
    parts = [f"# {source.title}", f"{bibliography()[source.citation].full}", _count(list(source.row))]
    for row in source.row:
        repaired = ", an equation of the text repaired" if row.repaired else ""
        lines = [
            f'<a id="{_anchor(row)}"></a>\n\n## {", ".join(row.covers)}',
            f"{row.shows}. **{row.kind.capitalize()}{repaired}.** {row.remark}",
        ]
        cells = [(*_number(n, case)[:-1], _why(n)) for n, case in zip(row.numbers, row.cases_of_numbers(), strict=True)]
        if cells:
            table = "\n".join(_cells(cell) for cell in cells)
            lines.append(f"| number | in print | fegear | difference | kind |\n|---|---|---|---|---|\n{table}")
        if row.tried:
            lines.append(_tried(row, source.citation.replace("-", "_")))
        held = f" Tests: {', '.join(f'`{name}`' for name in row.tests)}." if row.tests else ""
        lines.append(f"Made by {_maker(row, '../')}.{held}")
        if row.picture and _made(row.case or ""):
            if row.picture not in Run.in_folder(MADE / (row.case or "")).pictures:
                raise PluginError(f"{source.title}, {row.covers}: cases/{row.case}.toml draws no {row.picture}")
            lines.append(f"![{', '.join(row.covers)}](../gallery/{row.case}/plots/{row.picture})")
        parts += lines
    return "\n\n".join(parts) + "\n"


# ---- what mkdocs calls -------------------------------------------------------------------------------------------
def on_config(config):
    """Put the pages into the menu, among the proofs."""
    pages = [{source.title.partition(":")[0]: f"sources/{name}.md"} for name, source in sources().items()]
    (proofs,) = (group["Verification"] for group in config.nav if "Verification" in group)
    proofs.append({"Results of five papers": ["sources/index.md", *pages]})
    return config


def on_files(files, config):
    """Make the pages; the gallery has run the cases."""
    wrong = [fault for case in cases() if _made(case) for fault in faults_of_runs(case, Run.in_folder(MADE / case))]
    wrong += [f"{name}: {fault}" for name, source in sources().items() for fault in source.faults()]
    if wrong:
        raise PluginError("the list of sources does not hold:\n" + "\n".join(wrong))
    files.append(File.generated(config, "sources/index.md", content=overview()))
    for name, source in sources().items():
        files.append(File.generated(config, f"sources/{name}.md", content=page(source)))
    return files
