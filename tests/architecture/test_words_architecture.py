"""Pages and messages speak as a gear engineer does: words that once stood there for better ones do not come back."""

from __future__ import annotations

import ast
import re
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
#: What is read instead: compared with, is used instead of, not known, reported or distinguished, deflects, excites.
WORDS = re.compile(
    r"\b(held against|hold(?:s|ing)? [^.|;\n]{0,40}\bagainst|stands? in for|nobody|told|"
    r"knows? nothing of|given? way|gives way|giving way|tells?|foretells?|shak(?:e|es|en|ing)|"
    # what is compared or added is not beside: that is a place
    r"beside (?:finite|those of|usual|the (?:standards?|finite|formulas?|tolerances?|seconds|quadrature|exact)"
    r"|ISO|AGMA|CalculiX|[\d.]+ (?:and|um|MPa|%)))\b|^#+ Beside\b",
    re.IGNORECASE | re.MULTILINE,
)


#: Where two lines of one text meet.
JOINT = re.compile(r"""["']\s*\n\s*f?["']""")


def messages(source: str) -> list[str]:
    """Texts of a module that are no docstrings and no names."""
    lone, found = set(), []
    for node in ast.walk(ast.parse(source)):  # a statement comes before its parts
        if isinstance(node, ast.Expr):
            lone.add(id(node.value))
        elif isinstance(node, ast.Constant) and isinstance(node.value, str) and " " in node.value:
            found += [] if id(node) in lone else [node.value]
    return found


def test_pages_and_messages_have_no_words_that_were_replaced():
    pages = {path: [path.read_text("utf-8")] for path in (ROOT / "docs").rglob("*.md")}
    pages |= {path: [path.read_text("utf-8")] for path in (ROOT / "README.md", ROOT / "CONTRIBUTING.md")}
    modules = {path: path.read_text("utf-8") for path in (ROOT / "fegear").rglob("*.py")}
    assert len(pages) + len(modules) > 500
    # what no message can say, however its lines are joined, is not looked for among the messages
    pages |= {path: messages(text) for path, text in modules.items() if WORDS.search(JOINT.sub("", text))}
    found = [f"{path.relative_to(ROOT)}: {one[0]}" for path, texts in pages.items() for text in texts
             for one in WORDS.finditer(text)]  # fmt: skip
    assert found == []


#: What no message says any more (its values are written as {}).
OF_MESSAGES = re.compile(
    r"\b(?:teeth|flanks|pairs|planets) part\b|\bparts and meets\b|\bits likes?\b|\bfrom memory\b|\brecalled\b|"
    r"\bat hand\b|"
    r"\bwith (?:its|their|a) width\b|\bbears\b|from peak to peak|s(?:econds)? of (?:one core|a? ?processor)\b|"
    r"\b(?:leave (?:it|them|one of them) out|give (?:either|both)\b|write for example)|\bis needed (?:for|by)\b"
)


def whole(node: ast.expr) -> str | None:
    """Text of a string, what stands for values in an f-string being {}."""
    if isinstance(node, ast.JoinedStr):
        return "".join(str(one.value) if isinstance(one, ast.Constant) else "{}" for one in node.values)
    return node.value if isinstance(node, ast.Constant) and isinstance(node.value, str) else None


def test_messages_are_read_whole_and_have_the_words_of_the_trade():
    found = []
    for path in (ROOT / "fegear").rglob("*.py"):
        source = path.read_text("utf-8")
        if not OF_MESSAGES.search(JOINT.sub("", source)):
            continue
        tree = ast.parse(source)
        lone = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
        texts = {whole(node) for node in ast.walk(tree) if isinstance(node, ast.expr) and id(node) not in lone}
        found += [f"{path.relative_to(ROOT)}: {text}" for text in texts if text and " " in text
                  and OF_MESSAGES.search(text)]  # fmt: skip
    assert found == []


def test_templates_and_cases_have_no_words_that_were_replaced():
    paths = [*(ROOT / "fegear" / "case" / "drafts").rglob("*.toml"), *(ROOT / "cases").glob("*.toml")]
    assert len(paths) > 30
    found = [f"{path.relative_to(ROOT)}: {one[0]}" for path in paths for one in WORDS.finditer(path.read_text("utf-8"))]
    assert found == []


def test_lines_of_a_message_are_read_as_one():
    source = 'print(\n    "as it is held "\n    f"against {1}"\n)\n'
    assert WORDS.search(JOINT.sub("", source))
    assert not WORDS.search(source)
    assert WORDS.search("".join(messages(source)))


def test_docstrings_and_names_are_no_messages():
    source = '"""Nobody knows."""\ntold = {"told": f"as it was told {1}"}\n'
    assert messages(source) == ["as it was told "]


def test_beside_is_a_place_and_no_comparison():
    for refused in ("small beside the finite elements", "1.60 beside 1.64 and 1.12", "## Beside the load"):
        assert WORDS.search(refused), refused
    for place in ("root tension beside a contact", "`[rating] beside = []`", "a tooth beside the loaded one"):
        assert not WORDS.search(place), place
