"""The tool that draws wrong lines: what it changes, what it leaves alone, that a seed draws the same ones again."""

import ast
import importlib.util
import sys
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]


@pytest.fixture(scope="module")
def tool():
    """Both modules, imported as by hand: from their own folder."""
    made = {}
    for name in ("mutants", "run"):
        spec = importlib.util.spec_from_file_location(name, ROOT / "tests" / "mutation" / f"{name}.py")
        made[name] = sys.modules[name] = importlib.util.module_from_spec(spec)
        try:
            spec.loader.exec_module(made[name])
        finally:
            sys.modules.pop(name) if name != "mutants" else None
    yield made
    sys.modules.pop("mutants")
    sys.path.remove(str(ROOT / "tests" / "mutation"))


SOURCE = b'''"""Sum of 2 and 3."""
from dataclasses import dataclass

LIMIT = 0.25  # of 4

@dataclass(frozen=True)
class Asked:
    width: float = shown("mm", "width of 2 gears")
    teeth: int = 17

def stress(force: float, width: "tuple[float, 2]", at: int = 0) -> float:
    """2 + 3."""
    if force < LIMIT and not at == 1:
        raise ValueError(f"{force:.4g} is below {2 + 2}")
    longest = max(width[0], width[-1])
    return hypot(force, width) * longest - ratio(force, longest) + float(
        1e-9 * at
    )
'''


def changed(tool, source=SOURCE):
    found = tool["mutants"].mutants_of("fegear/formulas/made_up.py", source)
    return {one.shown(source).splitlines()[-1].strip("+ ") for one in found}, found


def test_what_only_guards_stays(tool):
    lines, _ = changed(tool, b"pairs = zip(a, b, strict=True), some(a, b, deep=True)\n")
    assert any("deep=False" in line for line in lines)
    assert not any("strict=False" in line for line in lines)


def test_every_kind_of_wrong_line_is_offered(tool):
    lines, found = changed(tool)
    for wrong in (
        "if force >= LIMIT and not at == 1:", "if force < LIMIT or not at == 1:", "if force < LIMIT and (at == 1):",
        "if force < LIMIT and not at != 1:", "longest = min(width[0], width[-1])", "longest = max(width[1], width[-1])",
        "longest = max(width[0], width[(1)])", "LIMIT = 0.275  # of 4", "LIMIT = 0.5  # of 4", "teeth: int = 18",
    ):  # fmt: skip
        assert wrong in lines, wrong
    texts = {(one.kind, one.text) for one in found}
    assert ("arguments swapped", "longest, force") in texts
    assert ("arguments swapped", "width, force") not in texts  # hypot knows no order
    assert ("term dropped", "(hypot(force, width))") in texts
    assert {one.room for one in found} == {"formulas"}
    for one in found:
        ast.parse(one.applied(SOURCE))
        assert one.applied(SOURCE) != SOURCE


def test_text_annotations_and_guards_stay(tool):
    lines, found = changed(tool)
    assert not any("mm" in line or "raise" in line or "2 + 3" in line for line in lines)
    assert not any(one.kind == "index" and one.line == 11 for one in found)
    assert not any("1e-09" in one.text or "1.1e-09" in one.text for one in found)


def test_a_seed_draws_the_same_lines_again_and_no_line_twice(tool):
    draw = tool["mutants"].draw
    one, same, other = (list(draw(ROOT, 12, seed, ("shafts",))) for seed in (1, 1, 2))
    assert one == same != other
    assert len({(mutant.path, mutant.line) for mutant in one}) == 12
    assert {mutant.room for mutant in one} == {"shafts"}


def test_lines_of_a_statement_and_what_is_around_it(tool):
    tree = ast.parse(SOURCE)
    inner, outer = tool["run"]._statements(tree, 17)
    assert inner == {16, 17, 18}
    assert [one.name for one in outer] == ["stress"]
    inner, outer = tool["run"]._statements(tree, 9)
    assert [one.name for one in outer] == ["Asked"]
    inner, outer = tool["run"]._statements(tree, 13)
    assert inner == {13}


def test_a_mutant_that_ends_no_more_is_told_by_its_signal(tool, tmp_path):
    """Two tests in a copy: one passes, one fails; the process that runs them tells which."""
    (tmp_path / "test_made_up.py").write_text("def test_holds():\n    pass\n\ndef test_breaks():\n    assert False\n")
    seconds = {"test_made_up.py::test_holds": 0.1, "test_made_up.py::test_breaks": 0.1}
    tool["run"].HEAVY.clear()
    assert tool["run"].passed(tmp_path, list(seconds), seconds) == "test_made_up.py::test_breaks"
    assert tool["run"].passed(tmp_path, list(seconds)[:1], seconds) == ""
