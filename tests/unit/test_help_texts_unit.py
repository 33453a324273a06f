"""Helps in terminals of any width, numbers that follow an option, and the one line where Ctrl-C is heard by nobody."""

from __future__ import annotations

import shutil
from os import terminal_size
from types import SimpleNamespace as Space

import pytest
import typer.core

from fegear.commands import help_texts
from fegear.commands.help_texts import Command, Group, _is_number, _stacked, context_settings, two_columns
from fegear.commands.terminal import INTERRUPTED


def wide(monkeypatch, columns):
    monkeypatch.setattr(shutil, "get_terminal_size", lambda: terminal_size((columns, 24)))


@pytest.mark.parametrize(("columns", "width"), [(40, 40), (99, 99), (100, 100), (101, 100), (300, 100)])
def test_helps_are_as_wide_as_the_terminal_up_to_what_is_read_well(monkeypatch, columns, width):
    wide(monkeypatch, columns)
    assert context_settings() == {"help_option_names": ["-h", "--help"], "terminal_width": width}


def test_names_and_meanings_stand_beside_or_below_each_other(monkeypatch):
    rows = [("one", "a meaning of more than thirty-two characters in all"), ("second", "short")]
    wide(monkeypatch, 60)
    lines = two_columns(rows, 10)
    assert lines == [
        "  one         a meaning of more than thirty-two characters", " " * 14 + "in all", "  second      short",
    ]  # fmt: skip
    wide(monkeypatch, 59)
    assert two_columns(rows, 10) == [
        "  one", "      a meaning of more than thirty-two characters in all", "  second", "      short",
    ]  # fmt: skip
    wide(monkeypatch, 20)  # no narrower than that
    assert two_columns(rows[:1], 10) == [
        "  one",
        "      a meaning of more",
        "      than thirty-two",
        "      characters in all",
    ]


class Formatter:
    """Of a help; remembers how lists are written."""

    def __init__(self, width):
        self.width, self.columns = width, []

    def write_dl(self, rows, col_max=30):
        self.columns.append(col_max)


@pytest.mark.parametrize(("width", "column"), [(59, 4), (60, 30), (30, 4), (100, 30)])
@pytest.mark.parametrize("of", [Command, Group, None])
def test_options_of_a_narrow_help_stand_on_lines_of_their_own(monkeypatch, width, column, of):
    formatter, context = Formatter(width), object()

    def written(_self, ctx, given):
        assert ctx is context
        given.write_dl([("--option", "meaning")])

    for one in (typer.core.TyperCommand, typer.core.TyperGroup):
        monkeypatch.setattr(one, "format_help", written)
    if of is None:
        _stacked(formatter)
        written(None, context, formatter)
    else:
        of.format_help(object.__new__(of), context, formatter)
    assert formatter.columns == [column]


@pytest.mark.parametrize("word", ["1", "-1", "+2.5", ".5", "3.", "-.25", "10.0"])
def test_a_number_is_one(word):
    assert _is_number(word)


@pytest.mark.parametrize("word", ["", "a", "--teeth", "1e3", "1mm", ".", "-", "1 2", "1.2.3"])
def test_what_is_no_number_is_a_word_of_its_own(word):
    assert not _is_number(word)


@pytest.mark.parametrize(
    ("given", "read"),
    [
        (["--teeth", "21", "53"], ["--teeth", "21 53"]),
        (["--teeth", "21", "53", "60", "x"], ["--teeth", "21 53 60", "x"]),
        (["-z", "21", "53"], ["-z", "21 53"]),
        (["--module", "2", "3"], ["--module", "2", "3"]),
        (["x", "--teeth", "21", "-1.5"], ["x", "--teeth", "21 -1.5"]),
        (["--teeth", "pinion", "53"], ["--teeth", "pinion", "53"]),
        (["--teeth", "53"], ["--teeth", "53"]),
        (["7", "8"], ["7", "8"]),
        ([], []),
    ],
)
def test_numbers_behind_an_option_that_takes_several_are_one_value(monkeypatch, given, read):
    monkeypatch.setattr(typer.core.TyperCommand, "parse_args", lambda self, ctx, words: (ctx, words))
    command = object.__new__(Command)
    command.params = [Space(metavar="N [N]", opts=["--teeth", "-z"]), Space(metavar="M", opts=["--module"]),
                      Space(metavar=None, opts=["--plain"])]  # fmt: skip
    assert command.parse_args("context", given) == ("context", read)


def test_ctrl_c_while_a_command_loads_ends_with_a_line(monkeypatch):
    left = []
    monkeypatch.setattr(help_texts, "leave", lambda words, code: left.append((words, code)))

    def interrupted(*given, **more):
        left.append((given[1:], more))
        raise KeyboardInterrupt

    group = object.__new__(Group)
    for name in ("make_context", "invoke"):
        monkeypatch.setattr(typer.core.TyperGroup, name, interrupted)
    assert group.make_context("name", ["run"], parent=None) is None
    assert group.invoke("context") is None
    assert left == [
        (("name", ["run"]), {"parent": None}), (INTERRUPTED, 130), (("context",), {}), (INTERRUPTED, 130),
    ]  # fmt: skip
    for name in ("make_context", "invoke"):
        monkeypatch.setattr(typer.core.TyperGroup, name, lambda self, *given, **more: (given, more))
    assert group.make_context("name", ["run"], parent=None) == (("name", ["run"]), {"parent": None})
    assert group.invoke("context") == (("context",), {})
