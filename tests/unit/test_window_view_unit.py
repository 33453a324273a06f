"""How a page was left: what is kept of it, and what is taken of what somebody else has put in its place."""

from __future__ import annotations

import json
import os
import threading
from pathlib import Path

import platformdirs
import pytest

from fegear.window.document import Desk
from fegear.window.glance import View, keep_view, read_view
from fegear.window.journal import Scratch, journal_folder, left_behind, sweep

LEFT = View(("te", "root"), "tension", folded=True, report=True, middle="I")
HERE = Path(__file__).parents[2] / "fegear" / "window"


@pytest.fixture(autouse=True)
def state(tmp_path, monkeypatch):
    monkeypatch.setenv("FEGEAR_STATE", str(tmp_path / "state"))


def place() -> Path:
    (one,) = (journal_folder() / "views").iterdir()
    return one


def at_once(do):
    """What a function returns that waits for nobody."""
    found = []
    thread = threading.Thread(target=lambda: found.append(do()), daemon=True)
    thread.start()
    thread.join(10.0)
    assert not thread.is_alive(), "waits"
    return found[0]


def test_a_page_is_shown_as_it_was_left(tmp_path):
    keep_view(tmp_path / "c.toml", LEFT)
    assert read_view(tmp_path / "c.toml") == LEFT
    assert read_view(None) == View()


@pytest.mark.parametrize(
    "content",
    [
        b"", b"{", b"[]", b"7", b'"x"', b"\xff", b"\0", b'{"folded": NaN}', b"[" * 200_000, b'{"a":' * 200_000,
        b'{"pictures": [[], {}, null, 1, "none"]}', b'{"measure": "none of these"}', b'{"middle": "\\ud800"}',
        b'{"folded": 1, "report": "yes", "middle": [], "measure": {}, "_replace": "x"}', b"9" * 10_000,
    ],
    ids=lambda content: content[:30].decode("latin-1"),
)  # fmt: skip
def test_what_is_no_view_is_the_usual_one(content):
    keep_view(None, LEFT)
    place().write_bytes(content)
    found = read_view(None)
    assert found == View(pictures=found.pictures)
    assert found.pictures in ((), LEFT.pictures)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="the system has no pipes with names")
def test_nobody_waits_for_a_pipe_in_place_of_what_was_kept(tmp_path, monkeypatch):
    path = tmp_path / "c.toml"
    path.write_text("x = 1\n")
    keep_view(path, LEFT)
    there = place()
    there.unlink()
    os.mkfifo(there)
    assert at_once(lambda: read_view(path)) == View()
    at_once(lambda: keep_view(path, LEFT))
    Desk.of_file(path).change("x = 2\n")
    (journal,) = journal_folder().glob("*.json")
    journal.unlink()
    os.mkfifo(journal)
    assert at_once(lambda: left_behind(path)) == []
    monkeypatch.setattr("tempfile.tempdir", str(tmp_path))
    scratch = Scratch()
    held = scratch.folder / next(name for name in os.listdir(scratch.folder))  # noqa: PTH208 - hidden ones, too
    held.unlink()
    os.mkfifo(held)
    assert at_once(sweep) == []


def test_the_page_knows_the_measures_that_are_kept():
    script = (HERE / "field.js").read_text("utf-8")
    for name in ("mises", "tension", "pressure"):
        assert f"{name}: [" in script
    for name in ("mises", "tension", "pressure", "none"):
        assert View().changed({"measure": name}).measure == name
    assert View().changed(json.loads('{"measure": "x"}')).measure == "mises"


def test_what_tests_keep_beyond_a_crash_is_not_among_what_the_user_has():
    """Whatever a test sets or forgets to set: one of them offered its case to whoever opened the window next."""
    assert journal_folder() != Path(platformdirs.user_state_dir("fegear", appauthor=False)) / "unsaved"
