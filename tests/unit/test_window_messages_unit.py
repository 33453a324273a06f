"""What becomes of an event that a page sends: acted on, refused in a sentence, or taken for nothing; pages made up."""

import asyncio
import json
from types import SimpleNamespace

import pytest
from nicegui.elements.input import Input
from nicegui.elements.mixins.value_element import ValueElement

from fegear.window import messages
from fegear.window.messages import Messages


def element(kind, value, event="update:model-value"):
    """An element of the framework without a page, with one listener."""
    found = object.__new__(kind)
    found.__dict__.update(
        _event_listeners={"l": SimpleNamespace(type=event)}, _event_args_to_value=lambda told: told.args, _props={}
    )
    found.__dict__["value"] = value
    return found


class Values(ValueElement):
    value = None


class Texts(Input):
    value = None


@pytest.fixture
def page(monkeypatch):
    """A page with a number, a text and a switch; what it acts on and what it refuses."""
    client = SimpleNamespace(
        id="c", is_deleted=False, acted=[], refused=[],
        elements={1: element(Values, 3.0), 2: element(Texts, "text"), 3: element(Values, True),
                  4: element(Values, 3.0, "click")},
    )  # fmt: skip
    client.handle_event = client.acted.append
    monkeypatch.setattr(messages.Client, "instances", {"c": client})
    monkeypatch.setattr(messages, "refuse", lambda of, sentence: of.refused.append(sentence))
    return client


def say(number, *args, listener="l", client="c"):
    return {"client_id": client, "id": number, "listener_id": listener, "args": [json.dumps(one) for one in args]}


@pytest.mark.parametrize(
    ("number", "value", "taken"),
    [(1, 4.5, True), (1, None, True), (2, "other", True), (2, None, True), (2, 7, False), (2, ["a"], False),
     (3, False, True), (3, 1, False), (3, "true", False), (4, 7, True)],
)  # fmt: skip
def test_a_value_is_taken_where_its_element_can_have_it(page, number, value, taken):
    messages._act(say(number, value))
    assert (len(page.acted), page.refused) == ((1, []) if taken else (0, [messages._NOT_TAKEN]))


def test_what_no_page_or_no_element_sends_is_refused_or_taken_for_nothing(page):
    messages._act(say(1, 2.0, client="other"))
    messages._act("no message")
    assert (page.acted, page.refused) == ([], [])
    for broken in (say(1, 2.0, listener="none"), {**say(1), "args": ["{"]}, {**say(1), "args": 5}):
        messages._act(broken)
    assert (page.acted, page.refused) == ([], [messages._NOT_TAKEN] * 3)


def test_a_text_for_an_element_that_is_gone_is_said_to_be_lost_and_a_click_is_not(page):
    messages._act(say(9, "typed"))
    assert page.refused == [messages._GONE]
    messages._act(say(9, 5))
    assert page.refused == [messages._GONE]
    assert [one["id"] for one in page.acted] == [9, 9]
    messages._act({**say(1), "args": [None, json.dumps(2.0)]})
    assert page.acted[2]["args"] == [None, "2.0"]


def test_half_a_character_is_read_as_what_stands_for_it():
    assert messages._decoded('"ab"') == '"ab"'
    found = messages._decoded('"a\\ud800b"')
    assert json.loads(found) == f"a{messages.HALF}b"
    with pytest.raises(ValueError, match=r"."):
        messages._decoded("{")


def test_what_waits_is_acted_on_when_the_window_is_closed_but_not_for_ever(monkeypatch):
    acted, clock = [], iter([0.0, 1.0, 2.0, 4.0, 5.0])
    monkeypatch.setattr(messages, "_act", acted.append)
    monkeypatch.setattr(messages.time, "monotonic", lambda: next(clock))
    heard = Messages()
    for name in "abcd":
        heard._waiting.append({"client_id": name})
    heard.end()
    assert [one["client_id"] for one in acted] == ["a", "b"]  # three seconds of farewell


def test_a_sentence_is_shown_on_a_page_that_is_there(monkeypatch):
    said = []
    monkeypatch.setattr(messages.ui, "notify", lambda text, **how: said.append((text, how["type"], how["timeout"])))

    class Page:
        is_deleted = False

        def __enter__(self):
            said.append("in")

        def __exit__(self, *given):
            said.append("out")

    page = Page()
    messages.refuse(page, "Not so.")
    assert said == ["in", ("Not so.", "warning", 10_000), "out"]
    page.is_deleted = True
    messages.refuse(page, "Not so.")
    assert len(said) == 3


@pytest.mark.parametrize(("level", "printed"), [("warning", True), ("error", True), ("info", False)])
def test_what_a_page_s_scripts_complain_of_is_printed(page, level, printed, monkeypatch):
    said = []
    monkeypatch.setattr(messages, "complain", said.append)
    messages._log("socket", {"client_id": "c", "level": level, "message": "two\nlines"})
    assert len(said) == printed
    assert all("\n" not in one and "two" in one for one in said)
    messages._log("socket", {"client_id": "x", "level": "error", "message": "m"})
    messages._log("socket", "nothing")
    assert len(said) == printed


def test_what_is_not_understood_is_taken_for_nothing_said():
    async def later(value):
        return {"a": 1}[value]

    assert asyncio.run(messages._guarded(later)("a")) == 1
    assert asyncio.run(messages._guarded(later)("b")) is False
    assert asyncio.run(messages._guarded(lambda value: value + 1)(1)) == 2
    assert asyncio.run(messages._guarded(lambda value: value + 1)("x")) is False
