"""Names of gears and pairs become names of files: ordinary ones unchanged, all others safe and different."""

from __future__ import annotations

import re

import pytest
from hypothesis import given
from hypothesis import strategies as st

from fegear.output.file_names import file_name


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
