"""The other side of the process that draws: what it answers, in which order, and what its copy reads and writes."""

from __future__ import annotations

import io
import os
import pickle
import sys
from types import SimpleNamespace as Space

import pytest

from fegear.output import picture_process
from fegear.output.picture_process import serve


class Steps(list):
    """What is asked of the system, in order."""

    def told(self, name, answer=None):
        def one(*given):
            self.append((name, *given))
            return answer

        return one


@pytest.fixture
def steps(monkeypatch, tmp_path):
    found = Steps()
    answers = os.open(tmp_path / "answers", os.O_CREAT | os.O_RDWR)
    found.path, found.answers = tmp_path / "answers", answers
    system = {name: found.told(name, 1) for name in ("dup2", "close", "fork")}
    found.system = Space(dup=found.told("dup", answers), fdopen=os.fdopen, **system)
    monkeypatch.setattr(picture_process, "os", found.system)
    cycles = {name: found.told(name) for name in ("freeze", "enable", "disable", "set_threshold")}
    monkeypatch.setattr(picture_process, "gc", Space(**cycles))
    monkeypatch.setattr(picture_process, "signal", Space(signal=found.told("signal"), SIGINT="int", SIG_IGN="ignored"))
    monkeypatch.setitem(sys.modules, "fegear.output.draw_png", Space(warm_up=found.told("warm up")))
    monkeypatch.setattr(picture_process, "_pictures", lambda *given: (*given, "drawn"))
    return found


def sent(monkeypatch, *requests, ends=b""):
    data = io.BytesIO(b"".join(map(pickle.dumps, requests)) + ends)
    monkeypatch.setattr(sys, "stdin", Space(buffer=data))


def answers(steps):
    data = io.BytesIO(steps.path.read_bytes())
    found = []
    while data.tell() < len(data.getvalue()):
        found.append(pickle.load(data))  # noqa: S301
    return found


@pytest.mark.parametrize("ends", [b"", b"no pickle", pickle.dumps((1, 2, 3))[:-2]], ids=["end", "wrong", "part"])
def test_it_answers_every_figure_in_turn_until_what_it_reads_ends(steps, monkeypatch, ends):
    sent(monkeypatch, ("wave", "folder", "png"), ("bars", "other", "svg"), ends=ends)
    serve()
    assert answers(steps) == [("wave", "folder", "png", "drawn"), ("bars", "other", "svg", "drawn")]
    assert steps == [
        ("signal", "int", "ignored"), ("disable",), ("dup", 1), ("dup2", 2, 1), ("warm up",), ("freeze",),
        ("set_threshold", 100_000), ("enable",), ("freeze",),
    ]  # fmt: skip


def test_a_request_of_another_form_is_no_end(steps, monkeypatch):
    sent(monkeypatch, ("wave", "folder"))
    with pytest.raises(ValueError, match="unpack"):
        serve()


@pytest.mark.parametrize("child", [0, 7])
def test_its_copy_reads_and_writes_at_the_ends_that_it_was_given(steps, monkeypatch, child):
    steps.system.fork = steps.told("fork", child)
    sent(monkeypatch, ("wave", "folder", "png"))
    serve(11, 12)
    assert answers(steps) == [("wave", "folder", "png", "drawn")]
    turned = [("dup2", 11, 0), ("dup2", 12, steps.answers)] if child == 0 else []
    begun = steps.index(("enable",)) + 1
    assert steps[begun:] == [("fork",), *turned, ("close", 11), ("close", 12), ("freeze",)]


def test_where_no_copy_is_to_be_had_it_draws_what_it_can(steps, monkeypatch):
    def none():
        raise OSError

    steps.system.fork = none
    sent(monkeypatch, ("wave", "folder", "png"))
    serve(11, 12)
    assert answers(steps) == [("wave", "folder", "png", "drawn")]
    assert ("close", 12) in steps
