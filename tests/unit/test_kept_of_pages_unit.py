"""What is the same in every page is kept beside compiled modules: sound, of this text and library, or made anew."""

import importlib.util
import os
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from fegear.output.report import kept as kept_module
from fegear.output.report.kept import keep, kept, recalled

PAGE = """
import hashlib
from fegear.output.report.blocks import Facts, Paragraph
from fegear.output.report.page import compressed_plotly, fragment
print(hashlib.sha256(compressed_plotly().encode()).hexdigest())
print(fragment((Paragraph("Ring < gear"), Facts({"teeth": 28}))))
"""


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """Python's compiled modules in a folder of this test."""
    monkeypatch.setattr(sys, "pycache_prefix", str(tmp_path))
    monkeypatch.setattr(sys, "dont_write_bytecode", False)
    return Path(importlib.util.cache_from_source(kept_module.__file__)).parent / "pages"


def entries(folder):
    return sorted(path for path in folder.rglob("*") if path.is_file())


def test_a_thing_is_made_once_and_recalled_after_that(folder):
    made = []

    def make():
        made.append(1)
        return b"content"

    assert [kept("plotly 6.1 4", make) for _ in range(3)] == [b"content"] * 3
    assert len(made) == len(entries(folder)) == 1
    assert kept("plotly 6.2 4", lambda: b"other") == b"other"
    assert recalled("plotly 6.1 4") == b"content"


@pytest.mark.parametrize("spoil", [
    lambda whole: b"", lambda whole: whole[:-1], lambda whole: whole[:-1] + b"?", lambda whole: b"?" + whole[1:],
])  # fmt: skip
def test_what_is_damaged_is_made_anew(folder, spoil):
    keep("a", b"content")
    (path,) = entries(folder)
    path.write_bytes(spoil(path.read_bytes()))
    assert recalled("a") is None
    assert kept("a", lambda: b"content") == b"content"
    assert recalled("a") == b"content"


def test_an_entry_that_was_moved_to_another_name_is_not_taken(folder):
    keep("a", b"of a")
    keep("b", b"of b")
    one, other = entries(folder)
    other.write_bytes(one.read_bytes())
    assert {recalled("a"), recalled("b")} < {b"of a", b"of b", None}
    assert None in {recalled("a"), recalled("b")}


def test_nothing_is_written_where_python_writes_no_compiled_modules(folder, monkeypatch):
    monkeypatch.setattr(sys, "dont_write_bytecode", True)
    assert kept("a", lambda: b"content") == b"content"
    assert not folder.exists()


def test_a_folder_that_cannot_be_written_to_costs_time_only(folder):
    folder.parent.mkdir(parents=True)
    folder.write_text("a file stands in the way")
    assert kept("a", lambda: b"content") == b"content"
    assert recalled("a") is None


def test_many_threads_see_the_whole_or_make_it(folder):
    found = []
    content = os.urandom(200_000)
    threads = [threading.Thread(target=lambda: found.append(kept("a", lambda: content))) for _ in range(8)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert found == [content] * 8
    assert len(entries(folder)) == 1


@pytest.mark.dear
def test_pages_of_a_second_run_are_those_of_the_first(tmp_path):
    environment = {**os.environ, "PYTHONPYCACHEPREFIX": str(tmp_path)}
    environment.pop("PYTHONDONTWRITEBYTECODE", None)
    (first, second) = (
        subprocess.run([sys.executable, "-c", PAGE], capture_output=True, text=True, check=True, env=environment).stdout
        for _ in range(2)
    )
    assert first == second
    assert "Ring &lt; gear" in first
    pages = [path for path in tmp_path.rglob("*.entry") if path.parts[-3] == "pages"]
    assert len(pages) >= 3  # plotly.js, and two templates at least
