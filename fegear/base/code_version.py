"""Which code and which libraries make a result: what is kept between runs, or computed elsewhere, is bound to both.

A package's version counts every file of it and of the packages that it imports, as its source states it, and those
libraries among them that decide numbers.
"""

from __future__ import annotations

import functools
import hashlib
import re
from collections.abc import Mapping, Sequence
from pathlib import Path
from types import MappingProxyType
from typing import NamedTuple

import fegear

#: Libraries whose version may change the last bits of a result: the name that is imported, the one that is installed.
LIBRARIES = MappingProxyType(
    {"gmsh": "gmsh", "numba": "numba", "numpy": "numpy", "scipy": "scipy", "skfem": "scikit-fem"}
)
#: Packages of fegear that are named in a source, and what stands before the name where it is imported.
_NAMED = re.compile(rb"fegear\.(\w+)")
_STATEMENTS = frozenset({b"from", b"import"})
_QUOTES = (b'"', b"'")
#: Folders of what is made from the source.
_SCRATCH = frozenset({"__pycache__"})
#: Digits of a version that a sentence repeats.
_DIGITS = 8


class _Package(NamedTuple):
    """A package's own digest, and the packages of fegear and libraries that its source imports."""

    digest: str
    packages: frozenset[str]
    libraries: frozenset[str]


def package_folder() -> Path:
    """Where fegear's code lies, wherever the module that asks does."""
    return Path(fegear.__path__[0])


def _imported(source: bytes) -> set[str]:
    """Packages of fegear that a module imports wherever it does, by a statement or by a text."""
    found = set[str]()
    for named in _NAMED.finditer(source):
        before = source[source.rfind(b"\n", 0, named.start()) + 1 : named.start()]
        if before.strip() in _STATEMENTS or before.endswith(_QUOTES):
            found.add(named[1].decode())
    return found


@functools.cache
def _places(root: Path) -> Mapping[str, Path]:
    """Folders of the packages right below `root`, and modules beside them, by name."""
    found = {place.name: place for place in sorted(root.iterdir()) if (place / "__init__.py").is_file()}
    # The top loads whatever is asked of it, and is nothing that results are made by.
    found |= {place.stem: place for place in sorted(root.glob("*.py")) if place.stem != "__init__"}
    if not found:
        raise RuntimeError(f"{root} contains no fegear source code (required for the version of results)")
    return MappingProxyType(found)


@functools.cache
def _package(root: Path, name: str) -> _Package:
    place = _places(root)[name]
    files = [place] if place.is_file() else [p for p in sorted(place.rglob("*")) if p.is_file()]
    digest, packages, libraries = hashlib.sha256(), set[str](), set[str]()
    for path in files:
        if not _SCRATCH.isdisjoint(path.parts):
            continue
        content = path.read_bytes()
        inside = path.relative_to(root).as_posix().encode()
        digest.update(b"%d %d\n" % (len(inside), len(content)) + inside + content)
        if path.suffix == ".py":
            packages |= _imported(content)
            libraries |= {
                one for one in LIBRARIES if f"import {one}".encode() in content or f"from {one}".encode() in content
            }
    return _Package(digest.hexdigest(), frozenset(packages & _places(root).keys()), frozenset(libraries))


@functools.cache
def installed() -> Mapping[str, str]:
    """Versions of the libraries that decide numbers, by the names under which they are installed."""
    from importlib.metadata import PackageNotFoundError, version  # takes longer than all else here

    found = {}
    for name in LIBRARIES.values():
        try:
            found[name] = version(name)
        except PackageNotFoundError:  # a program without it makes no result that depends on it
            continue
    return MappingProxyType(found)


@functools.cache
def code_version(*names: str, root: Path | None = None) -> str:
    """Version of the code that makes results, with those of the libraries that decide its numbers.

    Parameters
    ----------
    *names : str
        Subpackages of fegear that the results are made by, with all that they import; all of fegear by default.
    root : Path, optional
        Folder of the package; that of this program by default.

    Returns
    -------
    str
        64 hexadecimal digits (SHA-256).

    Raises
    ------
    ValueError
        If fegear has no such subpackage.
    """
    counted = _with_imported(names, root or package_folder())
    wanted = {LIBRARIES[one] for package in counted.values() for one in package.libraries}
    libraries = [f"{name} {number}" for name, number in installed().items() if name in wanted]
    return hashlib.sha256("\n".join([_digest(counted), *libraries]).encode()).hexdigest()


def _with_imported(names: Sequence[str], root: Path) -> Mapping[str, _Package]:
    places = _places(root)
    unknown = [name for name in names if name not in places]
    if unknown:
        raise ValueError(f"fegear has no package {', '.join(unknown)}; it has {', '.join(places)}")
    counted, todo = dict[str, _Package](), list(names or places)
    while todo:
        name = todo.pop()
        if name not in counted:
            counted[name] = _package(root, name)
            todo += counted[name].packages
    return counted


def _digest(counted: Mapping[str, _Package]) -> str:
    text = "\n".join(f"{name} {counted[name].digest}" for name in sorted(counted))
    return hashlib.sha256(text.encode()).hexdigest()


@functools.cache
def made_by() -> Mapping[str, str]:
    """What this program's results are made by: fegear with the version of its code, and the libraries."""
    code = _digest(_with_imported((), package_folder()))[:_DIGITS]
    return MappingProxyType({"fegear": f"{fegear.__version__} (code {code})", **installed()})


def unlike(here: Mapping[str, str], there: Mapping[str, str]) -> tuple[str, str] | None:
    """What two programs are made by where it differs, each as the words of a sentence; None where they are the same.

    Parameters
    ----------
    here, there : mapping of str to str
        See `made_by`.
    """
    names = [name for name in {**here, **there} if here.get(name) != there.get(name)]
    if not names:
        return None
    ours, theirs = (", ".join(f"{n} {m[n]}" if n in m else f"no {n}" for n in names) for m in (here, there))
    return ours, theirs
