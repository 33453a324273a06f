"""One name for each load: what is tangential at the reference circle never goes where the line of action is meant.

F_t and F_bt differ by cos(alpha_t), six per cent, and a formula takes either without complaint. So formulas say in
their arguments which one they take (`specific_load`, `tangential...`: F_t; `line_load`: w = F_bt / b), and a call that
hands the one over under the name of the other is found.
"""

from __future__ import annotations

import ast
import re
from pathlib import Path

HOUSE = Path(__file__).resolve().parents[2] / "fegear"
#: Names of loads at the reference circle, and along the line of action.
TANGENTIAL = re.compile(r"^(specific_load|tangential(_load)?|applied_load|unit_load)$")
ALONG = re.compile(r"^(line_loads?|loads?|normal_load|forces?|w)$")
#: What makes the one of the other.
CONVERTS = {"tangential_load", "specific_load", "law_load"}
#: Arguments that hold more than a number, and the one that takes what a law is stated for.
OTHER_LOADS = {"ToothLoad", "LoadLine", "LoadFactors"}
EITHER = {("mean_friction", "load")}


def functions(source: str) -> list[ast.FunctionDef]:
    return [node for node in ast.walk(ast.parse(source)) if isinstance(node, ast.FunctionDef)]


def arguments(function: ast.FunctionDef) -> list[ast.arg]:
    return [*function.args.posonlyargs, *function.args.args, *function.args.kwonlyargs]


def described(function: ast.FunctionDef, name: str) -> str:
    """What a docstring says of an argument; all of it where it is one line."""
    text = ast.get_docstring(function) or ""
    found = re.search(rf"^{name} : .*\n((?:    .*\n?)*)", text, re.MULTILINE)
    return found.group(1) if found else text


def ambiguous(source: str) -> list[str]:
    """Arguments of formulas that are a load and do not say which."""
    faults = []
    for function in functions(source):
        for argument in arguments(function):
            name, kind = argument.arg, ast.unparse(argument.annotation) if argument.annotation else ""
            if kind in OTHER_LOADS or (function.name, name) in EITHER:
                continue
            said = described(function, name)
            if ALONG.match(name) and name not in ("line_load", "w"):
                faults.append(f"{function.name}({name}): which load?")
            elif ALONG.match(name) and re.search(r"F_(t|m|tH)\b", said):
                faults.append(f"{function.name}({name}) is F_t by its description")
            elif TANGENTIAL.match(name) and said and not function.name.startswith("_") and "F_" not in said:
                faults.append(f"{function.name}({name}) does not say F_t")
    return faults


def loads_in(value: ast.expr) -> set[str]:
    """Names of loads that an argument is made of, those inside of a conversion left out."""
    if isinstance(value, ast.Call) and getattr(value.func, "attr", getattr(value.func, "id", "")) in CONVERTS:
        return {"specific_load"}
    if isinstance(value, ast.Attribute) and (TANGENTIAL.match(value.attr) or ALONG.match(value.attr)):
        return {value.attr}
    here = {value.id} if isinstance(value, ast.Name) else set()
    return here.union(*(loads_in(part) for part in ast.iter_child_nodes(value) if isinstance(part, ast.expr)))


def imported_elsewhere(nodes: list[ast.AST]) -> set[str]:
    """Names of functions that a module takes from other rooms than the formulas, whose names may be the same."""
    rows = (node for node in nodes if isinstance(node, ast.ImportFrom))
    return {one.name for row in rows if not (row.module or "").startswith("fegear.formulas") for one in row.names}


def mixed(sources: dict[str, str], takers: dict[str, list[str]]) -> list[str]:
    """Calls that hand a load of one kind over under the name of the other."""
    faults = []
    called_at_all = re.compile(rf"\b(?:{'|'.join(takers)})\b")
    for name, source in sources.items():
        if not called_at_all.search(source):
            continue
        nodes = list(ast.walk(ast.parse(source)))
        elsewhere = imported_elsewhere(nodes)
        for call in (node for node in nodes if isinstance(node, ast.Call)):
            called = getattr(call.func, "attr", getattr(call.func, "id", ""))
            given, keywords = list(call.args), {one.arg: one.value for one in call.keywords}
            if called == "partial" and given:
                called = getattr(given[0], "attr", getattr(given[0], "id", ""))
                given = given[1:]
            if called not in takers or called in elsewhere:
                continue
            pairs = [*zip(takers[called], given, strict=False), *keywords.items()]
            for wanted, value in pairs:
                names = loads_in(value)
                wrong = ALONG if TANGENTIAL.match(wanted or "") else TANGENTIAL if ALONG.match(wanted or "") else None
                if wrong is not None and (called, wanted) not in EITHER:
                    place = f"{name}:{value.lineno} {called}({wanted})"
                    faults += [f"{place} takes {one}" for one in names if wrong.match(one)]
    return faults


def test_formulas_say_which_load_they_take():
    faults = [fault for path in sorted((HOUSE / "formulas").rglob("*.py")) for fault in ambiguous(path.read_text())]
    assert not faults, "\n".join(faults)


def test_no_call_hands_one_load_over_for_the_other():
    sources = {str(path.relative_to(HOUSE)): path.read_text() for path in sorted(HOUSE.rglob("*.py"))}
    takers = {
        function.name: [one.arg for one in arguments(function) if one.arg != "self"]
        for path in (HOUSE / "formulas").rglob("*.py")
        for function in functions(path.read_text())
        if any(TANGENTIAL.match(one.arg) or ALONG.match(one.arg) for one in arguments(function))
    }
    assert {"pair_stiffness", "method_c", "rate_spur", "flash_temperature"} <= set(takers)
    faults = mixed(sources, takers)
    assert not faults, "\n".join(faults)


def test_the_check_finds_what_was_wrong():
    takers = {"pair_stiffness": ["pair", "specific_load"], "rate_spur": ["pair", "member", "line_load"]}
    wrong = {
        "a": "attempt(partial(pair_stiffness, pair, w))",
        "b": "pair_stiffness(pair, factors.application * load / pair.face_width)",
        "c": "rate_spur(pair, member, duty.tangential / b)",
    }
    assert len(mixed(wrong, takers)) == 3
    right = {"a": "pair_stiffness(pair, specific_load=k * pair.tangential_load(w))", "b": "rate_spur(pair, m, w)"}
    assert not mixed(right, takers)
    assert ambiguous("def f(load: float):\n    '''Of a load.'''") == ["f(load): which load?"]
    assert ambiguous("def f(line_load: float):\n    '''Of F_t/b.'''") == ["f(line_load) is F_t by its description"]
