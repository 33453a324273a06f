"""The version of code that binds what is kept: every byte of what a package is made by, and of nothing else."""

from __future__ import annotations

import importlib.util
import json
import os
import shutil
import subprocess
import sys
from pathlib import Path

import pytest

from fegear.base import code_version as versions
from fegear.base.code_version import code_version, made_by, package_folder, unlike

if "source_tree" not in sys.modules:
    _spec = importlib.util.spec_from_file_location("source_tree", Path(__file__).with_name("source_tree.py"))
    sys.modules["source_tree"] = importlib.util.module_from_spec(_spec)
    _spec.loader.exec_module(sys.modules["source_tree"])
source_tree = sys.modules["source_tree"]

PACKAGES = sorted(place.name for place in package_folder().iterdir() if (place / "__init__.py").is_file())
#: Those of the ordinary run, at the bottom, in the middle and at the top.
QUICK = ("base", "fem", "results", "window")


def forget():
    for function in (versions._places, versions._package, code_version):
        function.cache_clear()


@pytest.fixture(scope="module")
def below():
    """What each package and module at the top imports, by the syntax tree, in steps of any number."""
    tops = {*PACKAGES, "cli", "__main__"}
    edges = {name: {name} for name in tops}
    for one in source_tree.all_imports():
        here, there = (name.split(".")[1] if "." in name else "" for name in (one.importer, one.imported))
        if here in tops and there in tops and one.imported.split(".")[0] == "fegear":
            edges[here].add(there)
    for _ in tops:
        edges = {name: set().union(*(edges[other] for other in others)) for name, others in edges.items()}
    return edges


@pytest.fixture(scope="module")
def copy(tmp_path_factory):
    root = tmp_path_factory.mktemp("checkout") / "fegear"
    shutil.copytree(package_folder(), root, ignore=shutil.ignore_patterns("__pycache__"))
    return root


@pytest.fixture(scope="module")
def unchanged(copy, below):
    """Versions of all and of each package of the copy as it is before each test and after it."""
    forget()
    return code_version(root=copy), {name: code_version(name, root=copy) for name in below}


def test_a_copy_elsewhere_has_the_version_of_the_original(copy):
    forget()
    assert code_version(root=copy) == code_version()
    assert len({code_version(name, root=copy) for name in PACKAGES}) == len(PACKAGES)


@pytest.mark.parametrize("changed", [pytest.param(p, marks=() if p in QUICK else pytest.mark.dear) for p in PACKAGES])
def test_one_byte_changes_the_version_of_everything_above_and_nothing_else(changed, below, copy, unchanged):
    whole, before = unchanged
    path = max((copy / changed).rglob("*.py"), key=lambda one: (len(one.parts), one))
    kept = path.read_bytes()
    try:
        path.write_bytes(bytes([kept[0] ^ 1]) + kept[1:])  # in its opening text
        forget()
        other = {name for name in below if code_version(name, root=copy) != before[name]}
        assert other == {name for name, made_of in below.items() if changed in made_of}
        assert code_version(root=copy) != whole
    finally:
        path.write_bytes(kept)
        forget()


def test_a_byte_of_a_data_file_counts_and_compiled_files_do_not(copy):
    forget()
    before = code_version("formulas", root=copy), code_version("fem", root=copy)
    table = copy / "formulas" / "iso6336" / "part5_table1.csv"
    kept = table.read_bytes()
    (copy / "fem" / "__pycache__").mkdir()
    (copy / "fem" / "__pycache__" / "forms.cpython-311.pyc").write_bytes(b"compiled")
    try:
        table.write_bytes(kept.replace(b"1", b"2", 1))
        forget()
        assert code_version("formulas", root=copy) != before[0]
        assert code_version("fem", root=copy) == before[1]
    finally:
        table.write_bytes(kept)
        shutil.rmtree(copy / "fem" / "__pycache__")
        forget()


def test_a_file_that_takes_anothers_name_changes_the_version(copy):
    forget()
    before = code_version("fem", root=copy)
    first, second = copy / "fem" / "forms.py", copy / "fem" / "revolved_body.py"
    contents = first.read_bytes(), second.read_bytes()
    try:
        first.write_bytes(contents[1])
        second.write_bytes(contents[0])
        forget()
        assert code_version("fem", root=copy) != before
    finally:
        first.write_bytes(contents[0])
        second.write_bytes(contents[1])
        forget()


def test_a_package_that_does_not_exist_is_refused():
    with pytest.raises(ValueError, match=r"no package nonsense; it has .*fem"):
        code_version("fem", "nonsense")


def test_a_folder_without_source_code_has_no_version(tmp_path):
    with pytest.raises(RuntimeError, match="contains no fegear source code"):
        code_version(root=tmp_path)


def test_libraries_count_where_they_decide_numbers(monkeypatch):
    before = code_version("fem"), code_version("dynamics"), code_version()
    known = versions.installed()
    assert {"numpy", "scipy", "scikit-fem", "gmsh"} <= set(known)
    for library, fem_too in (("numpy", True), ("scipy", True), ("scikit-fem", True), ("gmsh", True), ("numba", False)):
        with monkeypatch.context() as patch:
            patch.setattr(versions, "installed", lambda library=library: {**known, library: "0.0.1"})
            code_version.cache_clear()
            other = code_version("fem"), code_version("dynamics"), code_version()
        assert (other[0] != before[0]) is fem_too
        assert other[1] != before[1]
        assert other[2] != before[2]
    code_version.cache_clear()


def test_what_differs_is_named_and_nothing_else():
    here = {"fegear": "0.2.0 (code 11111111)", "numpy": "2.4.6", "numba": "0.68.1"}
    assert unlike(here, dict(here)) is None
    assert unlike(here, {**here, "numpy": "2.3.0"}) == ("numpy 2.4.6", "numpy 2.3.0")
    assert unlike(here, {"fegear": "0.2.0 (code 22222222)", "numpy": "2.4.6"}) == (
        "fegear 0.2.0 (code 11111111), numba 0.68.1", "fegear 0.2.0 (code 22222222), no numba",
    )  # fmt: skip
    assert next(iter(made_by())) == "fegear"


CASE = """
results = ["stiffness"]
[gear.a]
teeth = 28
module = "3 mm"
bore_radius = "15 mm"
face_width = "20 mm"
[stiffness]
gear = "a"
radii = ["41.5 mm"]
contact_half_width = "0.05 mm"
[accuracy]
tolerance = 1e-2
"""


@pytest.mark.dear
def test_two_checkouts_that_share_a_cache_give_their_own_answers(tmp_path):
    """Run and sweep, each twice: each checkout computes once, and takes nothing of the other's."""
    (tmp_path / "case.toml").write_text(CASE)
    for name in ("one", "other"):
        shutil.copytree(package_folder(), tmp_path / name / "fegear")  # with bytecode: that of a change is made anew
    law = tmp_path / "other" / "fegear" / "fem" / "plane" / "elasticity.py"
    text = law.read_text()
    law.write_text(text.replace("mu = 0.5 / (1.0 + nu)", "mu = 0.45 / (1.0 + nu)"))
    assert law.read_text() != text

    def found(name, out, *arguments):
        done = subprocess.run(
            [sys.executable, "-m", "fegear", *arguments, "case.toml", "--no-plots", "--out", out], cwd=tmp_path,
            capture_output=True, text=True, check=False,
            env={**os.environ, "PYTHONPATH": str(tmp_path / name), "FEGEAR_CACHE": str(tmp_path / "cache")},
        )  # fmt: skip
        assert done.returncode == 0, done.stderr
        return json.loads((tmp_path / out / "summary.json").read_text()), done.stdout

    run, sweep = ("run", "--cache"), ("sweep", "--over", "gear.a.teeth=28")
    answer, swept = {}, {}
    for turn in ("first", "again"):
        for name in ("one", "other"):
            summary, _ = found(name, f"run_{name}_{turn}", *run)
            value = summary["results"]["a.c_self_at_pitch"]["value"]
            assert answer.setdefault(name, value) == value
            _, said = found(name, f"sweep_{name}_{turn}", *sweep)
            table = (tmp_path / f"sweep_{name}_{turn}" / "tables" / "sweep.csv").read_text().splitlines()[1]
            assert float(table.split(",")[1]) == pytest.approx(answer[name], rel=1e-9)
            assert ("taken from an earlier sweep" in said) is (turn == "again")
            assert swept.setdefault(name, table) == table
    assert answer["other"] > 1.02 * answer["one"]
