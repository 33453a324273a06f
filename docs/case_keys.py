"""The tables of keys in docs/case-files.md, made from the model of case files; run as a program it writes them.

What a key means stands at the key, as ``Field(description=...)`` in `fegear/case`, or as `given` at the spec from which
a table has its keys; window and editors show the same.
"""

from __future__ import annotations

import re
from pathlib import Path

from fegear.case.schema import case_schema
from fegear.case.schema_nodes import KeyHelp, SchemaNodes
from fegear.results.catalogue import STAGES

PAGE = Path(__file__).resolve().parent / "case-files.md"
_BLOCK = re.compile(r"<!-- keys of (\S+) -->\n.*?<!-- end of keys -->", re.DOTALL)


def _cell(text: str) -> str:
    return text.replace("|", "\\|")


def _row(one: KeyHelp) -> str:
    default = "required" if one.required else f"`{one.default}`" if one.default not in ("", '""') else ""
    return f"| `{one.key}` | {_cell(one.help)} | {_cell(one.value)} | {_cell(default)} |"


def page_with_keys(text: str) -> str:
    """The page with its tables as the model has them."""
    nodes = SchemaNodes(case_schema({name: entry.about for entry in STAGES.entries for name in entry.results}))

    def made(found: re.Match[str]) -> str:
        name = found[1]
        rows = [_row(one) for one in nodes.keys("" if name == "case" else name)]
        head = ["| key | meaning | value | default |", "|---|---|---|---|"]
        return "\n".join([f"<!-- keys of {name} -->", *head, *rows, "<!-- end of keys -->"])

    return _BLOCK.sub(made, text)


if __name__ == "__main__":
    PAGE.write_text(page_with_keys(PAGE.read_text("utf-8")), "utf-8")
