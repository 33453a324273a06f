"""The tree is what the pages say of it: rooms with their purpose, a map that finds its files, one subject a module."""

from __future__ import annotations

import ast
import re
from collections import Counter, defaultdict
from itertools import pairwise
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
HOUSE = ROOT / "fegear"
PAGE = (ROOT / "docs" / "developers" / "architecture.md").read_text(encoding="utf-8")
MAP = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")

#: Folders of one room that mirror each other on purpose: two models, a table of a case and what it describes, what is
#: written and its page. Their files bear the same names.
MIRRORS = (
    {"contact/plane", "contact/wide"},
    {"fem/plane", "fem/solid"},
    {"design/tip_relief", "design/flanks"},
    {"case", "case/built"},
    {"output", "output/report"},
)
#: No module is longer: one subject of mechanics with its docstrings.
LONGEST = 500


def _purpose(package: Path) -> str:
    text = ast.get_docstring(ast.parse((package / "__init__.py").read_text(encoding="utf-8"))) or ""
    return text.split("\n\n", maxsplit=1)[0].replace("\n", " ").rstrip(".")


def test_the_page_names_every_room_with_its_purpose():
    stated = dict(re.findall(r"^\| `([a-z0-9_/]+)/` \| (.+) \|$", PAGE, re.MULTILINE))
    rooms = {str(path.parent.relative_to(HOUSE)): _purpose(path.parent) for path in HOUSE.rglob("*/__init__.py")}
    assert stated == rooms


def _layers() -> dict[str, float]:
    """The order of imports that the test of layers enforces."""
    source = Path(__file__).with_name("test_layers_architecture.py").read_text(encoding="utf-8")
    (found,) = (
        node.value
        for node in ast.parse(source).body
        if isinstance(node, ast.Assign) and ast.unparse(node.targets[0]) == "LAYERS"
    )
    layers: dict[str, float] = ast.literal_eval(found)
    return layers


def test_the_page_says_what_a_room_may_import():
    layers = _layers()
    line = re.search(r"^`(base <.+)`$", PAGE, re.MULTILINE)
    assert line is not None
    stated = [re.split(r", ", step) for step in line.group(1).split(" < ")]
    order = [[layers[room] for room in step] for step in stated]
    assert all(len(set(step)) == 1 for step in order)
    assert all(low[0] < high[0] for low, high in pairwise(order))
    assert {room for step in stated for room in step} == {path.parent.name for path in HOUSE.glob("*/__init__.py")}


def test_the_map_finds_its_files():
    rows = re.findall(r"^\| (.+\?) \| (.+) \|$", MAP, re.MULTILINE)
    places = [re.findall(r"`fegear/([a-z0-9_/.]+)`", answer) for _, answer in rows]
    assert len(rows) >= 60
    assert [question for (question, _), named in zip(rows, places, strict=True) if not named] == []
    assert [place for named in places for place in named if not (HOUSE / place).exists()] == []
    first = Counter(named[0] for named in places)
    twice = [place for place, times in first.items() if times > 1]
    assert twice == [], "two questions of CONTRIBUTING.md have one answer: make them one"


def test_no_file_name_stands_twice_in_a_room_but_for_mirrored_models():
    seen: dict[tuple[str, str], list[str]] = defaultdict(list)
    for path in HOUSE.rglob("*.py"):
        folder = str(path.parent.relative_to(HOUSE))
        if path.stem != "__init__":
            seen[folder.split("/", maxsplit=1)[0], path.stem].append(folder)
    twice = {name: folders for name, folders in seen.items() if len(folders) > 1}
    assert {name: found for name, found in twice.items() if not any(set(found) <= pair for pair in MIRRORS)} == {}


def test_no_module_is_longer_than_its_subject():
    lengths = {str(path.relative_to(HOUSE)): len(path.read_text("utf-8").splitlines()) for path in HOUSE.rglob("*.py")}
    assert {name: lines for name, lines in lengths.items() if lines > LONGEST} == {}
