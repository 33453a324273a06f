"""Keys of what is kept are made in one place, of all arguments: nobody lists by hand what an answer depends on."""

from __future__ import annotations

import ast
from collections.abc import Iterator
from pathlib import Path

HOUSE = Path(__file__).resolve().parents[2] / "fegear"
MECHANICS = ("geometry", "formulas", "fem", "shafts", "contact", "design", "dynamics")
#: Fields of the mechanics that its types keep out of keys, and why they change no answer.
UNCOUNTED = {
    "fem/plane/gear.py": {"seconds", "rounds"},  # how long it took, and what was tried before
    "fem/plane/influence.py": {"seconds", "rows"},  # its own sector, which its mesh and its tooth determine
    "fem/plane/mesh.py": {"seconds"},
    "fem/plane/odd/odd_gear.py": {"seconds"},
    "fem/plane/odd/odd_influence.py": {"seconds"},
    "fem/solid/influence.py": {"seconds", "known_error"},  # what its own `error` found before
    "fem/solid/odd/odd_solid.py": {"seconds"},
    "fem/solid/odd/odd_solid_influence.py": {"seconds"},
    "fem/solid/rack/rack_flank.py": {  # what its spec determines
        "face",
        "flank",
        "compliance",
        "fillets",
        "displacement",
    },
    "fem/solid/rack/solid_rack.py": {  # likewise
        "face",
        "flank",
        "fillets",
        "ports",
        "axes",
        "rows",
        "motions",
        "unknowns",
        "seconds",
    },
    "fem/solid/solution.py": {"seconds"},
    "contact/double_helical/double_spec.py": {"name"},  # in messages
    "contact/pair_spec.py": {"name", "gear", "written", "key", "load_key", "measured", "wrong"},  # words, stop nothing
    "contact/plane/engagement.py": {"grids"},  # what it has evaluated before
    "contact/plane/loaded_pair.py": {"neglected"},  # asked of it once more
    "contact/plane/roll_grids.py": {"others"},  # the same grid with other teeth, evaluated before
    "contact/wide/loaded.py": {"cache", "progress"},
    "design/tip_relief/tip_tolerance.py": {"origin"},  # in sentences
}


def _sources(folder: Path, named: str) -> Iterator[tuple[str, ast.Module]]:
    """Modules in which a name stands, one after the other: trees of all of them at once are a million objects."""
    for path in sorted(folder.rglob("*.py")):
        if named in (source := path.read_text()):
            yield path.relative_to(HOUSE).as_posix(), ast.parse(source)


def keys_by_hand(tree: ast.Module) -> set[str]:
    """What a module makes keys with."""
    found = {
        name.name
        for node in ast.walk(tree)
        if isinstance(node, ast.ImportFrom) and node.module == "fegear.base.cache_keys"
        for name in node.names
    }
    return found - {"Key"}


def uncounted(tree: ast.Module) -> set[str]:
    """Fields of dataclasses that do not count in comparisons, and so not in keys."""
    return {
        node.target.id
        for node in ast.walk(tree)
        if isinstance(node, ast.AnnAssign)
        and isinstance(node.value, ast.Call)
        and any(k.arg == "compare" and getattr(k.value, "value", True) is False for k in node.value.keywords)
    }


def test_only_base_and_the_executor_make_keys():
    """The executor knows points by the function of whoever asks, which need not be fegear's."""
    found = {name: keys_by_hand(tree) for name, tree in _sources(HOUSE, "cache_keys") if not name.startswith("base/")}
    assert {name: made for name, made in found.items() if made} == {
        "engine/executor.py": {"function_name", "lasting_key"}
    }


def test_what_the_mechanics_keeps_out_of_keys_is_said_by_its_types_and_listed_here():
    found = {name: uncounted(tree) for room in MECHANICS for name, tree in _sources(HOUSE / room, "compare")}
    assert {name: fields for name, fields in found.items() if fields} == UNCOUNTED


def test_keys_by_hand_and_uncounted_fields_are_found():
    assert keys_by_hand(ast.parse("from fegear.base.cache_keys import Key, content_key")) == {"content_key"}
    assert uncounted(ast.parse("class A:\n    a: int = field(compare=False)\n    b: int = field(default=1)")) == {"a"}
