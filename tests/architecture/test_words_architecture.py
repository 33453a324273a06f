"""Pages and messages speak as a gear engineer does: words that once stood there for better ones do not come back."""

from __future__ import annotations

import ast
import re
import tomllib
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
    paths = [*(ROOT / "fegear" / "case" / "drafts").rglob("*.toml"), *(ROOT / "cases").rglob("*.toml")]
    assert len(paths) > 30
    texts = {path: path.read_text("utf-8") for path in paths}
    drafts = ROOT / "fegear" / "case" / "drafts" / "text.py"
    texts[drafts] = "\n".join(messages(drafts.read_text("utf-8")))
    found = [f"{path.relative_to(ROOT)}: {one[0]}" for path, text in texts.items()
             for rule in (WORDS, OF_MESSAGES, OF_OTHERS, OF_DRAFTS) for one in rule.finditer(text)]  # fmt: skip
    assert found == []


#: What other texts that people read have in no place: their numbers have a zero before the point.
OF_OTHERS = re.compile(
    r"(?<![\w.\d)\]:\"'/*%])\.\d+(?![\w.]*[/;)])|\b(?:is|are) apart\b|\bheld (?:fast|all round|over|by the)\b|"
    r"\bacross (?:the|its) ax[ei]s\b|\balike\b|\b0-peak\b|processor seconds|\bwithout it does\b"
)
#: What no comment of a template says: a default is called one, and a place is one's own to fill in.
OF_DRAFTS = re.compile(r"\bwithout it\b|\bput (?:yours?|those|the drawing's)\b|\basked for\b|\brules of thumb\b")
#: What JavaScript says, and not the names of its classes and the shapes that it draws.
OF_SCRIPTS = re.compile(r"\"((?:[^\"\\\n]|\\.)*)\"|`((?:[^`\\]|\\.)*)`")
SENTENCE = re.compile(r"[A-Za-z}]{2,},? [a-z{]{2,}")
#: Classes of an element, some of which have a hyphen.
CLASSES = re.compile(r"[a-z]+( [a-z]+)*( ?[a-z]+-[a-z-]+)+( [a-z-]+)*")

#: Code for the browser and the look of pages, which is no text.
FOR_BROWSERS = re.compile(r"[{;]\s|=>|px|document\.")


def said_by_script(source: str) -> list[str]:
    """Texts of a script of the page, what stands for values being {}."""
    found = (one or other for one, other in OF_SCRIPTS.findall(re.sub(r"(?m)^\s*//.*$|\s// .*$", "", source)))
    return [
        re.sub(r"\$\{[^}]*\}", "{}", text) for text in found if SENTENCE.search(text) and not CLASSES.fullmatch(text)
    ]


def texts_within(table: object) -> list[str]:
    """Every text of a table of TOML but those that a paper prints."""
    if isinstance(table, str):
        return [table]
    if isinstance(table, list):
        return [text for one in table for text in texts_within(one)]
    if isinstance(table, dict):
        return [text for key, one in table.items() if key not in ("printed", "statement") for text in texts_within(one)]
    return []


def other_texts() -> dict[Path, list[str]]:
    """Texts of the sources' lists, the page's scripts, the shell's, the newest version of the changelog, benchmarks."""
    found = {
        path: texts_within(tomllib.loads(path.read_text("utf-8"))) for path in (ROOT / "docs/sources").glob("*.toml")
    }
    found |= {path: said_by_script(path.read_text("utf-8")) for path in (ROOT / "fegear" / "window").glob("*.js")}
    found |= {path: [path.read_text("utf-8")] for path in ROOT.glob("*.sh")}
    changes = (ROOT / "CHANGELOG.md").read_text("utf-8")
    newest = re.split(r"(?m)^## ", changes)[1]
    found[ROOT / "CHANGELOG.md"] = [re.sub(r"`[^`]*`", "", newest)]
    for path in [*(ROOT / "benchmarks").glob("*.py"), *(ROOT / "docs").glob("*.py")]:
        tree = ast.parse(path.read_text("utf-8"))
        lone = {id(node.value) for node in ast.walk(tree) if isinstance(node, ast.Expr)}
        whole_texts = (whole(node) for node in ast.walk(tree) if isinstance(node, ast.expr) and id(node) not in lone)
        found[path] = [text for text in whole_texts if text and " " in text and not FOR_BROWSERS.search(text)]
    return found


def test_sources_scripts_changelog_and_benchmarks_have_the_words_of_the_trade():
    texts = other_texts()
    assert {path.suffix for path in texts} == {".toml", ".js", ".sh", ".md", ".py"}
    found = [f"{path.relative_to(ROOT)}: {one[0]} in {text[max(0, one.start() - 40) : one.end() + 40]!r}"
             for path, all_of_it in texts.items() for text in all_of_it
             for rule in (WORDS, OF_MESSAGES, OF_OTHERS) for one in rule.finditer(text)]  # fmt: skip
    assert found == []


def test_other_texts_are_found_and_their_rules_refuse():
    assert said_by_script('// not "this one here"\nx = "quiet"; y = `the ${z.w} drives, held`;') == [
        "the {} drives, held"
    ]
    assert texts_within({"a": ["x"], "printed": {"b": "20% .5"}, "c": {"d": "y"}}) == ["x", "y"]
    for refused in ("off by .5 %", "gears that are alike", "within (.3 mm)", "the teeth are apart", "held all round"):
        assert OF_OTHERS.search(refused), refused
    for said in ("0.5 %", "version 0.2.0", "cases/x.toml", "a .toml file", "row.5 of it", "equal gears"):
        assert not OF_OTHERS.search(said), said


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
