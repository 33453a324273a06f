"""Texts of two pages merged, and journals taken up: laws over random ones, and who comes too late."""

import numpy as np
import pytest

from fegear.window import inputs
from fegear.window.document import Desk
from fegear.window.inputs import merged, stepped
from fegear.window.journal import Journal, Kept, Left, drop, left_behind
from fegear.workbench.pair import _apart


def lines(*words):
    return [f"{word}\n" for word in words]


@pytest.mark.parametrize("seed", range(4))
def test_changes_lead_from_one_text_to_the_other_however_often_lines_come_again(seed):
    chance = np.random.default_rng(seed)
    for _ in range(150):
        old, new = (lines(*chance.choice(["a", "b"], size=chance.integers(6))) for _ in range(2))
        made, at = [], 0
        for first, last, start, end in inputs._changes(old, new):
            assert at <= first <= last <= len(old)
            made += [*old[at:first], *new[start:end]]
            at = last
        assert [*made, *old[at:]] == new


def test_long_texts_are_one_change_between_the_first_and_the_last(monkeypatch):
    monkeypatch.setattr(inputs, "_PAIRS", 3)
    old, new = lines("a", "b", "c", "d"), lines("a", "x", "y", "d")
    assert list(inputs._changes(old, new)) == [(1, 3, 1, 3)]
    monkeypatch.setattr(inputs, "_PAIRS", 4)
    assert list(inputs._changes(lines("a", "b", "c", "b", "d"), lines("a", "c", "d"))) == [(1, 2, 1, 1), (3, 4, 2, 2)]


@pytest.mark.parametrize("seed", range(4))
def test_what_is_typed_in_one_place_and_changed_in_another_is_both(seed):
    """Between them a line that nobody has changed; all others may come again and again."""
    chance = np.random.default_rng(seed)

    def some(most=4):
        return lines(*chance.choice(["a", "b"], size=chance.integers(most)))

    for _ in range(150):
        above, below, other_above, other_below = some(), some(), some(), some()
        fence = lines("first fence", "second fence")
        base, mine, theirs = ("".join([*up, *fence, *down]) for up, down in (
            (above, below), (other_above, below), (above, other_below)
        ))  # fmt: skip
        assert merged(base, mine, theirs) == "".join([*other_above, *fence, *other_below])
        assert merged(base, theirs, mine) == "".join([*other_above, *fence, *other_below])


def test_who_has_not_changed_a_text_takes_the_other_s():
    assert merged("a\n", "a\n", "b\n") == "b\n"
    assert merged("a\n", "b\n", "a\n") == "b\n"
    assert merged("a\nb\nc\n", "a\nx\nc\n", "a\ny\nc\n") == "a\nx\nc\n"  # the same line: what was typed last


def test_a_journal_that_is_gone_or_held_is_not_taken(tmp_path, monkeypatch):
    monkeypatch.setenv("FEGEAR_STATE", str(tmp_path))
    state = Kept("text", str(tmp_path), "c", "now")
    window = Journal(None)
    window.keep(state)
    assert left_behind(None) == []  # it lives
    (place,) = tmp_path.glob("*.json")
    late = Journal(None)
    assert late.take(Left(place, state)) is False
    window.leave()
    (left,) = left_behind(None)
    assert left.kept == state
    assert late.take(left) is True
    late.forget()
    assert not place.exists()
    assert Journal(None).take(left) is False
    drop(left)  # nothing is there to be dropped


@pytest.mark.parametrize(
    ("text", "steps", "made"),
    [("23", 1, "24"), ("0.30", -1, "0.29"), ("20 deg", 10, "30 deg"), ("-1.5 um", 1, "-1.4 um"), (" 2e-3", 1, "0.003"),
     ("1E2", 1, "2E+2"), (".5", 1, "0.6"), ("none", 1, None), ("", 1, None)],
)  # fmt: skip
def test_a_step_is_a_unit_of_the_last_digit(text, steps, made):
    assert stepped(text, steps) == made


def test_gears_that_were_one_get_names_of_their_roles():
    assert _apart(("a", "a")) == ("driver", "driven")
    assert _apart(("a", "b")) == ("a", "b")


def test_a_text_is_kept_once_and_no_more_after_it_was_saved(tmp_path, monkeypatch):
    """Pages ask again and again to keep up: what is kept already, or in the file, is not written another time."""
    monkeypatch.setenv("FEGEAR_STATE", str(tmp_path / "state"))
    done = []
    keep, forget = Journal.keep, Journal.forget
    monkeypatch.setattr(Journal, "keep", lambda self, kept: done.append("keep") or keep(self, kept))
    monkeypatch.setattr(Journal, "forget", lambda self: done.append("forget") or forget(self))
    path = tmp_path / "c.toml"
    path.write_text('title = "a"\n')
    desk = Desk.of_file(path)
    done.clear()
    desk.change('title = "b"\n')
    desk.keep_up()
    desk.keep_up()
    assert done == ["keep"]
    desk.save()
    assert path.read_text() == 'title = "b"\n'
    done.clear()
    desk.keep_up()
    assert done == []
    desk.change('title = "c"\n')
    desk.change('title = "b"\n')
    desk.keep_up()
    assert done[-1] == "forget"  # what the file has is not kept beside it
    count = len(done)
    desk.keep_up()
    assert len(done) == count
