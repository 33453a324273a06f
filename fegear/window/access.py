"""Who may speak to the page: this machine, by its own name, the account that runs it, with the secret of its cookie.

An address brings a key: what it opens gets the cookie. The printed one works again for another browser where the system
tells that it is one of the account that runs the window, as others are refused whatever they know; elsewhere it works
once, and the next one is printed. A second key, of those who look on, works as often as it is used: its cookie reads,
and what would change anything is answered by 403, requests and messages alike, before anything else sees them. A
browser that fegear itself starts gets its address, which works once, by a file that its owner only can read, as command
lines are read by everybody.
"""

from __future__ import annotations

import contextlib
import hmac
import html
import os
import re
import secrets
import sys
from ipaddress import ip_address
from pathlib import Path
from typing import TYPE_CHECKING, Any
from urllib.parse import parse_qs

if TYPE_CHECKING:
    from collections.abc import Awaitable, Callable, MutableMapping

    Scope = MutableMapping[str, Any]
    App = Callable[[Scope, Callable[..., Awaitable[Any]], Callable[..., Awaitable[None]]], Awaitable[None]]

#: What the page may fetch: nothing but from its own server.
_POLICY = (
    "default-src 'self'; script-src 'self' 'unsafe-inline' 'unsafe-eval'; style-src 'self' 'unsafe-inline'; "
    "img-src 'self' data: blob:; font-src 'self' data:; connect-src 'self'; worker-src 'self' blob:; "
    "frame-ancestors 'none'; form-action 'self'; base-uri 'self'"
)
#: A page that leads to another, which is then no longer asked for by another site or by a file.
_LEADS = (
    '<!DOCTYPE html><html lang="en-US"><head><meta charset="utf-8"><meta name="referrer" content="no-referrer">'
    '<meta http-equiv="refresh" content="1; url={address}"><title>fegear</title></head>'
    '<body><script>location.replace({quoted})</script><a href="{address}">fegear</a></body></html>\n'
)
_REFUSED = "Access denied: open the address printed last by fegear open, in the user account that runs it.\n"
#: Where Linux tells which account a connection belongs to.
_CONNECTIONS = (Path("/proc/net/tcp"), Path("/proc/net/tcp6"))
_ROOT = 0
#: How frames of a page begin: the end, an answer to a ping, a message, another transport (engine.io).
_FRAMES = ("1", "3", "4", "5")
#: Of these, what a page that only looks on may say: that it ends, hears, begins, has shown what was sent.
_UPKEEP = re.compile(r'(1|3|41)\Z|40(\{|\Z)|42\["(handshake|ack)",')
#: A message that waits for its answer, by its number.
_ANSWERED = re.compile(r"42(\d+)\[")
#: In the scope of a request of who only looks on.
LOOKS = "fegear_looks"
_LITTLE = sys.byteorder == "little"
#: Whose connection was closed meanwhile: the system counts it as that of the first account, who may do everything.
_NOBODY = -1


class Keys:
    """Keys that work once, or again for one account, and the secret that they are exchanged for.

    Attributes
    ----------
    secret : str
        Of the cookie.
    look, look_secret : str
        The key of those who look on, and the secret that it is exchanged for.
    """

    def __init__(self) -> None:
        self.secret, self.look, self.look_secret = (secrets.token_urlsafe(24) for _ in range(3))
        self._open: dict[str, Callable[[], object]] = {}
        self._lasting: set[str] = set()

    def another(self, used: Callable[[], object], *, again: bool = False) -> str:
        """Make a key; `used` is called when it is used up: with `again` not by the account that runs the window."""
        key = secrets.token_urlsafe(24)
        self._open[key] = used
        if again:
            self._lasting.add(key)
        return key

    def is_open(self, key: str) -> bool:
        """Whether a key has not been used."""
        return key in self._open

    def take(self, key: str, *, own: bool = False) -> bool:
        """Use a key; False if it is none, or has been used up. `own` is whether the account that asks is known."""
        for one in list(self._open):
            if hmac.compare_digest(one.encode(), key.encode()):
                if not (own and one in self._lasting):
                    self._open.pop(one)()
                return True
        return False


class Doorkeeper:
    """Wraps an ASGI application; refuses every request that does not come from the page that was opened.

    Parameters
    ----------
    app : ASGI application
    port : int
        On which it listens.
    keys : Keys
        The first request brings one of them as ``?key=``, the others their secret as a cookie of this port.
    """

    def __init__(self, app: App, port: int, keys: Keys) -> None:
        self._app, self._keys, self._port = app, keys, port
        self._hosts = {f"127.0.0.1:{port}", f"localhost:{port}"}

    async def __call__(
        self, scope: Scope, receive: Callable[..., Awaitable[Any]], send: Callable[..., Awaitable[None]]
    ) -> None:
        """Let a request in, or refuse it before anything else sees it."""
        if scope["type"] not in ("http", "websocket"):
            await self._app(scope, receive, send)
            return
        heads: dict[str, str] = {}
        for name, value in scope["headers"]:
            head = name.decode("latin-1").lower()
            heads[head] = "; ".join(filter(None, [heads.get(head), value.decode("latin-1")]))
        asking = account_of(scope.get("client"), self._port)
        if not self._is_ours(asking, heads):
            await _refuse(scope, send)
        elif _opens(scope, heads) and self._keys.take(
            _key_of(scope), own=asking is not None
        ):  # though it has the cookie
            cookie = f"fegear-{self._port}={self._keys.secret}; HttpOnly; SameSite=Strict; Path=/"
            await _answer(_with_heads(send), 200, leading_to("/"), "text/html", [(b"set-cookie", cookie.encode())])
        elif self._has_cookie(heads, f"fegear-{self._port}", self._keys.secret):
            await self._app(scope, _whole_frames(receive), _with_heads(send))
        elif _opens(scope, heads) and hmac.compare_digest(_key_of(scope, "look").encode(), self._keys.look.encode()):
            cookie = f"fegear-look-{self._port}={self._keys.look_secret}; HttpOnly; SameSite=Strict; Path=/"
            await _answer(_with_heads(send), 200, leading_to("/"), "text/html", [(b"set-cookie", cookie.encode())])
        elif _only_reads(scope) and self._has_cookie(heads, f"fegear-look-{self._port}", self._keys.look_secret):
            scope[LOOKS] = True
            await self._app(scope, _frames_that_read(receive, send), _with_heads(send))
        else:
            await _refuse(scope, send)

    def _is_ours(self, asking: int | None, heads: dict[str, str]) -> bool:
        """Whether it comes to this machine by its own name, from no other site's page and from no other account."""
        if heads.get("host") not in self._hosts:  # another name for this machine is another site's (DNS rebinding)
            return False
        origin = heads.get("origin")
        if origin is not None and origin.removeprefix("http://") not in self._hosts:
            return False
        return asking is None or asking in (_ROOT, os.getuid())

    @staticmethod
    def _has_cookie(heads: dict[str, str], name: str, secret: str) -> bool:
        if heads.get("sec-fetch-site", "none") not in ("none", "same-origin"):
            return False
        shown = _cookies(heads.get("cookie", ""), name)
        return any(hmac.compare_digest(one.encode(), secret.encode()) for one in shown)


def leading_to(address: str) -> str:
    """A page that leads to an address."""
    return _LEADS.format(address=html.escape(address), quoted=f'"{address}"')


def file_leading_to(address: str, folder: Path) -> Path:
    """Write a page that leads to an address, which its owner only can read.

    Raises
    ------
    OSError
        If it cannot be written.
    """
    place = folder / "open.html"
    with os.fdopen(os.open(place, os.O_WRONLY | os.O_CREAT | os.O_EXCL, 0o600), "w", encoding="utf-8") as file:
        file.write(leading_to(address))
    return place


def account_of(client: tuple[str, int] | None, port: int) -> int | None:
    """The account that a connection of this machine belongs to; None where the system does not tell.

    Parameters
    ----------
    client : (str, int), optional
        Address and port of who has connected.
    port : int
        To which.
    """
    if client is None or not hasattr(os, "getuid"):
        return None
    try:
        own = ip_address(client[0])
    except ValueError:
        return None
    ends = (f":{client[1]:04X}", f":{port:04X}")
    for place in _CONNECTIONS:
        with contextlib.suppress(OSError, ValueError, IndexError):
            for line in place.read_text("ascii").splitlines()[1:]:
                _, here, there, _, _, _, _, uid, _, inode, *_ = line.split()
                if here.endswith(ends[0]) and there.endswith(ends[1]) and _is_at(here.partition(":")[0], own.packed):
                    return int(uid) if inode != "0" else _NOBODY
    return None


def _is_at(told: str, packed: bytes) -> bool:
    """Whether four bytes, the last ones of the system's notation, are an address: each word is turned about."""
    words = bytes.fromhex(told)
    return words[-4:][::-1] == packed[-4:] if _LITTLE else words[-4:] == packed[-4:]


def _opens(scope: Scope, heads: dict[str, str]) -> bool:
    """Whether a request opens a page in a window of its own: by hand, by a program, or led there by a file."""
    if scope["type"] != "http" or scope.get("method", "GET") != "GET" or scope.get("path", "/") != "/":
        return False
    whence = heads.get("sec-fetch-site", "none")
    return whence in ("none", "same-origin") or heads.get("sec-fetch-dest") == "document"


def _key_of(scope: Scope, name: str = "key") -> str:
    return parse_qs(scope.get("query_string", b"").decode("latin-1")).get(name, [""])[0]


def _only_reads(scope: Scope) -> bool:
    """Whether a request can change nothing: what travels along a connection is looked at frame by frame."""
    if scope["type"] == "websocket":
        return True
    return scope.get("method") in ("GET", "HEAD") and not scope.get("path", "").startswith("/_nicegui_ws")


def _frames_that_read(
    receive: Callable[..., Awaitable[Any]], send: Callable[..., Awaitable[None]]
) -> Callable[..., Awaitable[Any]]:
    """Let through what keeps a connection up; answer every other message by 403."""

    async def received() -> Any:
        while True:
            message = await receive()
            if message["type"] != "websocket.receive":
                return message
            text = message.get("text") or ""
            if _UPKEEP.match(text) and "\x1e" not in text:  # which would begin another message
                return message
            asked = _ANSWERED.match(text)
            refused = f"43{asked[1]}[403]" if asked is not None else '42["refused",403]'
            await send({"type": "websocket.send", "text": refused})

    return received


def _cookies(head: str, name: str) -> list[str]:
    """All cookies of a name, whatever other programs on this machine have put beside them."""
    parts = (part.partition("=") for part in head.split(";"))
    return [value.strip() for one, _, value in parts if one.strip() == name]


def _whole_frames(receive: Callable[..., Awaitable[Any]]) -> Callable[..., Awaitable[Any]]:
    """Pass over what no page says on a connection, and what the web framework has no answer to but to fail."""

    async def received() -> Any:
        while True:
            message = await receive()
            if message["type"] != "websocket.receive" or (message.get("text") or "")[:1] in _FRAMES:
                return message

    return received


def _with_heads(send: Callable[..., Awaitable[None]]) -> Callable[..., Awaitable[None]]:
    async def with_heads(message: MutableMapping[str, Any]) -> None:
        if message["type"] == "http.response.start":
            more = [
                (b"content-security-policy", _POLICY.encode()),
                (b"referrer-policy", b"no-referrer"),
                (b"x-content-type-options", b"nosniff"),
            ]
            message = {**message, "headers": [*message.get("headers", ()), *more]}
        await send(message)

    return with_heads


async def _answer(
    send: Callable[..., Awaitable[None]], status: int, text: str, kind: str, more: list[tuple[bytes, bytes]]
) -> None:
    said = text.encode()
    heads = [
        (b"content-type", f"{kind}; charset=utf-8".encode()), (b"content-length", str(len(said)).encode()),
        (b"cache-control", b"no-store"), *more,
    ]  # fmt: skip
    await send({"type": "http.response.start", "status": status, "headers": heads})
    await send({"type": "http.response.body", "body": said})


async def _refuse(scope: Scope, send: Callable[..., Awaitable[None]]) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008})
        return
    await _answer(send, 403, _REFUSED, "text/plain", [])
