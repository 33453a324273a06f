"""What pages say, looked at before anything acts on it: whole, of the right kind, and not too long.

A page takes a long message apart, for the web server closes connections over a megabyte; here it is put together. What
cannot be taken is answered with a sentence on the page: nothing that somebody has changed is dropped without a word.
"""

from __future__ import annotations

import asyncio
import json
import math
import time
from collections import deque
from types import SimpleNamespace
from typing import TYPE_CHECKING, Any

from nicegui import core, ui
from nicegui import json as wire
from nicegui.client import Client
from nicegui.elements.input import Input
from nicegui.elements.mixins.value_element import ValueElement

from fegear.base.errors import PATH, InputError, shown
from fegear.base.streams import complain
from fegear.window.document import LARGEST
from fegear.window.journal import HALF, HALVES

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, Mapping

#: Characters of one piece, and of all pieces of a message: a text with every character escaped.
PIECE, _MOST = 100_000, 7 * LARGEST
#: For so long messages are acted on before connections are read again, and for so long they are [s].
_SPELL, _REST = 0.03, 0.02
#: For so long messages that wait are acted on when the window is closed [s].
_FAREWELL = 3.0
#: Messages that come in pieces at the same time from one page.
_OPEN = 8
_NOT_TAKEN = "Input from this page could not be read. Repeat the change or reload the page."
#: What is said where somebody puts in more than a case may have.
TOO_LONG = (
    f"Not inserted: the text would exceed {LARGEST} characters; move tables to separate files, or use fegear run."
)
_GONE = "The case was changed in another page; the last input was not accepted."
#: What is said with each kind of event, and what each part of it must be.
EVENTS: dict[str, dict[str, type]] = {
    "relief": {"gear": str, "end": str, "index": int, "start": float, "amount": float, "moving": bool},
    "load": {"pair": str, "key": str, "text": str, "moving": bool},
    "crack": {"gear": str, "place": int, "depth": float, "angle": float, "moving": bool},
    "drop": {"gear": str},
    "name_driven": {"pair": str},
    "design": {"pair": str, "how": str},
    "shows": {"pair": str, "kind": str, "on": bool},
    "sight": {"tasks": list},
    "value": {"field": str, "text": str, "moving": bool},
}
#: What parts may be where that is not free.
_ONE_OF = {
    "end": ("tip", "root", "crowning"), "key": ("load", "torque"), "how": ("exact", "ground"),
    "kind": ("stress", "deformed", "tool"),
}  # fmt: skip
#: Parts that change while a value is moved.
_ON_ITS_WAY = {"start", "amount", "text", "depth", "angle"}
#: Parts that may be left out.
_FREE = {"index", "how"}


def checked(kind: str, said: object) -> dict[str, Any]:
    """Return what a page says with an event.

    Parameters
    ----------
    kind : str
        A key of `EVENTS`.
    said : object

    Raises
    ------
    InputError
        If a part is missing, is another or is not what it must be.
    """
    parts = EVENTS[kind]
    if not isinstance(said, dict) or not set(parts) - _FREE <= set(said) <= set(parts):
        raise InputError(f"page.{kind}", _short(said), f"must have {', '.join(parts)}", "reload the page")
    for name, value in said.items():
        if not _is_a(value, parts[name]):
            raise InputError(f"page.{kind}.{name}", _short(value), f"must be {_KINDS[parts[name]]}")
        if value not in (known := _ONE_OF.get(name, (value,))):
            raise InputError(f"page.{kind}.{name}", _short(value), f"must be one of {', '.join(known)}")
    return dict(said)


_KINDS = {
    str: "a text",
    int: "a whole number, at least 0",
    float: "a finite number",
    bool: "true or false",
    list: "names",
}


def _is_a(value: object, kind: type) -> bool:
    if kind is float:  # JSON has no infinity: what a page without room for its axes sends arrives as None
        return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)
    if kind is int:
        return isinstance(value, int) and not isinstance(value, bool) and value >= 0
    if kind is list:
        return isinstance(value, list) and all(_is_a(one, str) for one in value)
    if kind is str:
        return isinstance(value, str) and HALVES.search(value) is None
    return isinstance(value, kind)


def _short(value: object) -> str:
    text = json.dumps(value)
    return text if len(text) <= 60 else f"{text[:60]}..."


class Messages:
    """Hears what pages say before the web framework does."""

    def __init__(self) -> None:
        self._pieces: dict[tuple[str, str], list[str]] = {}
        self._waiting: deque[object] = deque()
        self._moves: dict[tuple[str, ...], dict[str, Any]] = {}
        self._is_acting = False

    def install(self) -> None:
        """Take the place of what hears of pages; once for a server."""
        heard: Mapping[str, Callable[..., Any]] = core.sio.handlers["/"]
        for name in ("handshake", "javascript_response", "ack"):
            core.sio.on(name, _guarded(heard[name]))
        core.sio.on("log", _log)
        connection = core.sio.eio
        connection.on("message", _guarded(connection.handlers["message"]))  # what is no message at all
        core.sio.on("event", self.event)
        core.sio.on("piece", self.piece)

    async def event(self, _socket: str, said: object = None, *_more: object) -> None:
        """Act on an event of a page, at once or behind those that wait: a page that is not heard for long is lost."""
        if not self._replaces(said):
            self._waiting.append(said)
        if self._is_acting:
            return
        self._is_acting = True
        try:
            begun = time.monotonic()
            while self._waiting:
                self._act_on_next()
                if time.monotonic() - begun > _SPELL or not self._waiting:  # what has come is read, and joins the rest
                    await asyncio.sleep(_REST)
                    begun = time.monotonic()
        finally:
            self._is_acting = False

    def end(self) -> None:
        """Act on what waits: the window is closed."""
        end = time.monotonic() + _FAREWELL
        while self._waiting and time.monotonic() < end:
            self._act_on_next()

    def _act_on_next(self) -> None:
        said = self._waiting.popleft()
        self._moves = {place: one for place, one in self._moves.items() if one is not said}
        _act(said)

    def _replaces(self, said: object) -> bool:
        """Whether a value that is being moved is further than where a message that waits has it: one stroke."""
        place = _moved(said) if isinstance(said, dict) else None
        if place is None or not isinstance(said, dict):  # what comes before something else stays before it
            self._moves = {}
            return False
        if (before := self._moves.get(place)) is not None:
            before["args"] = said["args"]
            return True
        self._moves[place] = said
        return False

    async def piece(self, socket: str, said: object = None, *_more: object) -> None:
        """Put a message together; act on it when the last piece is here."""
        client = _client_of(said)
        if client is None or not isinstance(said, dict):
            return
        name, count, at, text = (said.get(key) for key in ("name", "count", "at", "text"))
        place = (client.id, str(name)[:60])
        self._pieces = {place: begun for place, begun in self._pieces.items() if place[0] in Client.instances}
        begun = self._pieces.pop(place, []) if at != 0 else []  # said again from the first: its connection was lost
        open_now = sum(of == client.id and one != name for of, one in self._pieces)
        fits = isinstance(at, int) and isinstance(count, int) and isinstance(text, str) and at == len(begun) < count
        if not fits or sum(map(len, begun)) + len(str(text)) > _MOST or open_now >= _OPEN:
            refuse(client, _NOT_TAKEN)
            return
        begun.append(str(text))
        if len(begun) < int(str(count)):
            self._pieces[place] = begun
            return
        try:
            whole = json.loads("".join(begun))
        except (ValueError, RecursionError):
            whole = None
        if isinstance(whole, dict) and whole.get("client_id") == client.id:
            await self.event(socket, whole)
        else:
            refuse(client, _NOT_TAKEN)


def _moved(said: Mapping[str, Any]) -> tuple[str, ...] | None:
    """What a message moves on its way, by its page and all but numbers; None for others."""
    try:
        (text,) = said["args"]
        parts = json.loads(text) if len(text) < 1000 else None
        if not isinstance(parts, dict) or parts.get("moving") is not True:
            return None
        fixed = [f"{name} {one}" for name, one in sorted(parts.items()) if name not in _ON_ITS_WAY]
        return (str(said["client_id"]), str(said["listener_id"]), *fixed)
    except (KeyError, TypeError, ValueError, RecursionError):
        return None


def _act(said: object) -> None:
    """Act on an event of a page as long as the page is known, though its connection may be gone by now."""
    client = _client_of(said)
    if client is None or not isinstance(said, dict):
        return
    try:
        message = {**said, "args": [None if one is None else _decoded(one) for one in said.get("args", [])]}
        known = _is_of_its_kind(client, message)
    except (ValueError, TypeError, KeyError, AttributeError, IndexError, RecursionError):
        known = False
    if not known:
        refuse(client, _NOT_TAKEN)
        return
    if message["id"] not in client.elements and any(str(one).startswith('"') for one in message["args"]):
        refuse(client, _GONE)  # a text, typed where another page has laid another case
    client.handle_event(message)


def refuse(client: Client, sentence: str) -> None:
    """Say on a page what is not taken."""
    if client.is_deleted:
        return
    with client:
        ui.notify(sentence, type="warning", multi_line=True, timeout=10_000)


def _log(_socket: str, said: object = None, *_more: object) -> None:
    """Print what a page's scripts complain of, on one line whatever it is."""
    if _client_of(said) is not None and isinstance(said, dict) and said.get("level") in ("warning", "error"):
        complain(f"Browser message: {shown(said.get('message', ''), PATH)}")


def _guarded(hear: Callable[..., Any]) -> Callable[..., Awaitable[Any]]:
    """The same that takes what is not understood for nothing said."""

    async def guarded(*said: Any) -> Any:
        try:
            found = hear(*said)
            return await found if hasattr(found, "__await__") else found
        except (KeyError, TypeError, ValueError, AttributeError, IndexError, OverflowError):
            return False

    return guarded


def _client_of(said: object) -> Client | None:
    name = said.get("client_id") if isinstance(said, dict) else None
    return Client.instances.get(name) if isinstance(name, str) else None


def _decoded(text: str) -> str:
    """One argument as the framework reads it: half a character, which it cannot read, as what stands for it."""
    try:
        wire.loads(text)
    except ValueError:
        text = HALVES.sub(HALF, json.dumps(json.loads(text), ensure_ascii=False))
        wire.loads(text)
    return text


def _is_of_its_kind(client: Client, message: dict[str, Any]) -> bool:
    """Whether an event is one that its element hears of, with a value that it can have."""
    sender = client.elements.get(message["id"])
    if sender is None:  # gone with the form that it was of
        return True
    listener = sender._event_listeners[message["listener_id"]]  # noqa: SLF001 - the framework looks there, too
    if listener.type.startswith("sub_pages"):  # of the framework, which this page has none of
        return False
    if not isinstance(sender, ValueElement) or not listener.type.startswith("update:"):
        return True
    values = [None if one is None else wire.loads(one) for one in message["args"]]
    told: Any = SimpleNamespace(args=values[0] if len(values) == 1 else values)
    value = sender._event_args_to_value(told)  # noqa: SLF001 - as it will read it itself
    if isinstance(sender, Input):
        return value is None or isinstance(value, str)
    return not isinstance(sender.value, bool) or isinstance(value, bool)
