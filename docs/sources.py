"""Hook of mkdocs: the pages "Sources", figure by figure what the five papers print and what fegear gives."""

from __future__ import annotations

from typing import TYPE_CHECKING

from gallery import MADE, case_name
from gallery import cases as run_cases
from mkdocs.exceptions import PluginError
from mkdocs.structure.files import File
from source_rows import JUDGEMENTS, Row, Run, Source, cases, faults_of_runs, sources

from fegear.engine.citation import bibliography

if TYPE_CHECKING:
    from source_rows import Number

_HEAD = "| printed as | what it is | made by | in print | fegear | difference | |\n|---|---|---|---|---|---|---|"

#: Numbers of a row that the first page shows.
_SHOWN = 3
_WORDS = """\
What the papers that fegear implements print, figure by figure, and what fegear gives. Each number is made by the case
beside it when these pages are built, and a test holds it. A paper's own page shows the pictures, drawn with the paper's
axes, and what is to be said of each. Where the text of a paper is damaged, the equation was derived anew and checked
against another method; nothing is tuned to hit a print."""


def _made(case: str) -> bool:
    """Whether the gallery has run the case for this site; a shortened one leaves cases out."""
    return case in map(case_name, run_cases())


def _number(number: Number, case: str) -> tuple[str, str, str]:
    """In print, fegear's and the difference: a cell each."""
    if not _made(case):
        return number.printed or number.statement or "", "not run", ""
    got = number.read(Run.in_folder(MADE / case))
    printed = number.in_print()
    if printed is None:
        return f"{number.what}: {number.statement}", f"{got.value:.5g} {got.unit}", ""
    apart = f"{got.value - printed.value:+.2g}" if printed.value == 0.0 else f"{got.value / printed.value - 1.0:+.2%}"
    return f"{number.what}: {number.printed}", f"{got.value:.5g} {got.unit}", apart


def _maker(row: Row, top: str) -> str:
    if row.case:
        return f"[{row.case.rpartition('/')[2]}]({top}gallery/{row.case}.md)"
    return f"`{row.command or row.function}`"


def _lines(row: Row, paper: str) -> list[str]:
    """A line of the table for each number; the first says what it is all about."""
    numbers = [_number(n, case) for n, case in zip(row.number, row.cases_of_numbers(), strict=True)] or [("", "", "")]
    if len(numbers) > _SHOWN:
        numbers = [
            *numbers[: _SHOWN - 1],
            (f"and {len(numbers) - _SHOWN + 1} more numbers on the paper's page", "", ""),
        ]
    name = f"[{', '.join(row.covers)}]({paper}.md#{_anchor(row)})"
    first = [(name, row.shows, _maker(row, "../"), *numbers[0], row.judgement)]
    return [_cells(line) for line in first + [("", "", "", *number, "") for number in numbers[1:]]]


def _cells(parts: tuple[str, ...]) -> str:
    return "| " + " | ".join(part.replace("|", "\\|") for part in parts) + " |"


def _anchor(row: Row) -> str:
    return "item-" + "".join(letter if letter.isalnum() else "-" for letter in row.covers[0].lower())


def _count(rows: list[Row]) -> str:
    found = {word: sum(row.judgement == word for row in rows) for word in JUDGEMENTS}
    return ", ".join(f"{count} {word}" for word, count in found.items() if count)


def overview() -> str:
    """Text of the first page: what the words mean, how many rows have which, and a table for each paper."""
    rows = [row for source in sources().values() for row in source.row]
    meanings = "\n".join(
        f"| {word} | {sum(row.judgement == word for row in rows)} | {means} |" for word, means in JUDGEMENTS.items()
    )
    parts = [
        "# Sources",
        _WORDS,
        f"| judgement | rows | meaning |\n|---|---|---|\n{meanings}",
    ]
    for name, source in sources().items():
        table = "\n".join([_HEAD, *(line for row in source.row for line in _lines(row, name))])
        parts.append(f"## [{source.title}]({name}.md)\n\n{_count(list(source.row))}.\n\n{table}")
    return "\n\n".join(parts) + "\n"


def page(source: Source) -> str:
    """Text of a paper's page: its rows with their pictures and remarks."""
    parts = [f"# {source.title}", f"{bibliography()[source.citation].full}", f"{_count(list(source.row))}."]
    for row in source.row:
        lines = [
            f'<a id="{_anchor(row)}"></a>\n\n## {", ".join(row.covers)}',
            f"{row.shows}. **{row.judgement.capitalize()}.** {row.remark}",
        ]
        cells = [_number(n, case) for n, case in zip(row.number, row.cases_of_numbers(), strict=True)]
        if cells:
            table = "\n".join(_cells(cell) for cell in cells)
            lines.append(f"| in print | fegear | difference |\n|---|---|---|\n{table}")
        lines.append(f"Made by {_maker(row, '../')}.")
        if row.picture and _made(row.case or ""):
            if row.picture not in Run.in_folder(MADE / (row.case or "")).pictures:
                raise PluginError(f"{source.title}, {row.covers}: cases/{row.case}.toml draws no {row.picture}")
            lines.append(f"![{', '.join(row.covers)}](../gallery/{row.case}/plots/{row.picture})")
        parts += lines
    return "\n\n".join(parts) + "\n"


# ---- what mkdocs calls -------------------------------------------------------------------------------------------
def on_config(config):
    """Put the pages into the navigation, after the theory."""
    pages = [{source.title.partition(":")[0]: f"sources/{name}.md"} for name, source in sources().items()]
    place = next(k for k, part in enumerate(config.nav) if "Theory" in part) + 1
    config.nav.insert(place, {"Sources": [{"All figures and tables": "sources/index.md"}, *pages]})
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
