"""Names of gears and pairs become names of files: ordinary ones unchanged, all others safe and different."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fegear.case.reading import build_scene
from fegear.output.export import export_gears
from fegear.output.file_names import file_name
from fegear.output.folder import whole_or_nothing


@pytest.mark.parametrize("name", ["a", "pinion", "stiffness_a", "I-II", "v1.2", "my gear", "_", "2nd (left)", "A+B,C"])
def test_ordinary_names_are_unchanged(name):
    assert file_name(name) == name


@pytest.mark.parametrize(
    "name",
    ["", ".", "..", "../a", "/etc/passwd", "a/b", "a\\b", "c:", ".hidden", "-rf", "a.", "a ", "con", "NUL.txt", "a\nb",
     "a\0b", "Größe", "歯車", "x" * 300, "a~b", "<b>", "$(x)", "`x`", "a:b", "*", "?", '"', "%2e", "é", "e\u0301"],
)  # fmt: skip
def test_others_are_safe_and_no_paths(name):
    found = file_name(name)
    assert re.fullmatch(r"[A-Za-z0-9_-]{1,80}~[0-9a-f]{8}", found)
    assert not found.startswith("-")


def test_letters_are_kept_where_ascii_has_them():
    assert file_name("Größe").startswith("Grosse~")
    assert file_name("../../pinion").startswith("pinion~")


@given(st.text(), st.text())
def test_different_names_stay_different(a, b):
    assert (file_name(a) == file_name(b)) == (a == b)
    assert len(file_name(a)) <= 100
    assert "/" not in file_name(a)


def test_an_export_stays_in_its_folder(tmp_path):
    names = ["../../evil", "/evil", "Größe/x", "x" * 300]
    gears = {name: {"teeth": 8, "module": "1 mm", "profile_shift": 0.5} for name in names}
    scene = build_scene({"results": ["geometry"], "gear": gears}, "case", tmp_path)
    out = tmp_path / "deep" / "out"
    with whole_or_nothing(out) as scratch:
        export_gears(scene, scratch, names, "dxf")
    found = [path for path in tmp_path.rglob("*") if path.is_file()]
    assert {path.parent for path in found} == {out}
    assert len({path.name for path in found if path.suffix == ".dxf"}) == 16
