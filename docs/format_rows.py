"""The table of formats in docs/how-to/export.md, made from their rows; run as a program it writes it."""

from __future__ import annotations

import re
from pathlib import Path

from fegear.output.export_formats import FORMATS

PAGE = Path(__file__).resolve().parent / "how-to" / "export.md"
_BLOCK = re.compile(r"<!-- formats -->\n.*?<!-- end of formats -->", re.DOTALL)


def page_with_formats(text: str) -> str:
    """The page with its table as the rows have it."""
    rows = ["| `--format` | file | for, and what is in it |", "|---|---|---|"]
    for name, row in FORMATS.items():
        files = ", ".join(f"`{file}`" for file in row.files.split(", "))
        rows.append(f"| `{name}` | {files} | {row.contents} |")
    return _BLOCK.sub("\n".join(["<!-- formats -->", *rows, "<!-- end of formats -->"]), text)


if __name__ == "__main__":
    PAGE.write_text(page_with_formats(PAGE.read_text("utf-8")), "utf-8")
