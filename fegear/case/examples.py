"""The cases that come with fegear, by name: `cases/` of its tree, `fegear/examples` where it is installed.

Tooth meshes that they name lie beside them: `meshes/` of the tree, `fegear/meshes` where it is installed.
"""

from __future__ import annotations

import re
from pathlib import Path

from fegear.base.code_version import package_folder
from fegear.base.errors import FegearError, InputError, shown
from fegear.case.nearest import nearest

#: Files that a case names by a path of its own.
_NAMED = re.compile(r'"((?:data|meshes)/[\w./-]+)"')


def folder() -> Path:
    """Where they are.

    Raises
    ------
    FegearError
        If this installation has none.
    """
    package = package_folder().resolve()
    for place in (package / "examples", package.parent / "cases"):
        if place.is_dir():
            return place
    raise FegearError("the examples are missing; reinstall fegear.")


def names() -> list[str]:
    """All of them, those of papers as ``sources/...``."""
    place = folder()
    return sorted(path.relative_to(place).with_suffix("").as_posix() for path in place.rglob("*.toml"))


def example(name: str) -> tuple[str, dict[str, bytes]]:
    """An example's text, and the files that it names, by their paths below the case.

    Raises
    ------
    InputError
        If there is none of that name.
    """
    known = names()
    if name not in known:
        raise InputError("--example", shown(name), "is not an example", nearest(name, known))
    path = folder() / f"{name}.toml"
    # Cases of papers lie a folder deeper than what they name, and meshes beside all cases: a copy has both below it.
    text = path.read_text("utf-8").replace('"../data/', '"data/').replace('"../meshes/', '"meshes/')
    return text, {named: _place(named).read_bytes() for named in dict.fromkeys(_NAMED.findall(text))}


def _place(named: str) -> Path:
    """Where a file that a copied example names lies."""
    return (folder().parent if named.startswith("meshes/") else folder()) / named
