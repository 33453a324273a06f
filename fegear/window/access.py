"""Who may speak to the page: this machine, by its own name and with the secret of the address; no other site's page."""

from __future__ import annotations

import hmac
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


class Doorkeeper:
    """Wraps an ASGI application; refuses every request that does not come from the page that was opened.

    Parameters
    ----------
    app : ASGI application
    port : int
        On which it listens.
    secret : str
        Of the address; the first request brings it as ``?key=``, the others as a cookie of this port.
    """

    def __init__(self, app: App, port: int, secret: str) -> None:
        self._app, self._secret, self._port = app, secret, port
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
        key = parse_qs(scope.get("query_string", b"").decode("latin-1")).get("key", [""])[0]
        if not self._welcome(heads, key):
            await _refuse(scope, send)
            return

        async def with_heads(message: MutableMapping[str, Any]) -> None:
            if message["type"] == "http.response.start":
                more = [
                    (b"content-security-policy", _POLICY.encode()),
                    (b"referrer-policy", b"no-referrer"),
                    (b"x-content-type-options", b"nosniff"),
                ]
                if key:
                    cookie = f"fegear-{self._port}={self._secret}; HttpOnly; SameSite=Strict; Path=/"
                    more.append((b"set-cookie", cookie.encode()))
                message = {**message, "headers": [*message.get("headers", ()), *more]}
            await send(message)

        await self._app(scope, receive, with_heads)

    def _welcome(self, heads: dict[str, str], key: str) -> bool:
        if heads.get("host") not in self._hosts:  # another name for this machine is another site's (DNS rebinding)
            return False
        origin = heads.get("origin")
        if origin is not None and origin.removeprefix("http://") not in self._hosts:
            return False
        if heads.get("sec-fetch-site", "none") not in ("none", "same-origin"):
            return False
        shown = [key, *_cookies(heads.get("cookie", ""), f"fegear-{self._port}")]
        return any(hmac.compare_digest(one.encode(), self._secret.encode()) for one in shown)


def _cookies(head: str, name: str) -> list[str]:
    """All cookies of a name, whatever other programs on this machine have put beside them."""
    parts = (part.partition("=") for part in head.split(";"))
    return [value.strip() for one, _, value in parts if one.strip() == name]


async def _refuse(scope: Scope, send: Callable[..., Awaitable[None]]) -> None:
    if scope["type"] == "websocket":
        await send({"type": "websocket.close", "code": 1008})
        return
    said = b"Refused: open the address that fegear open printed.\n"
    heads = [(b"content-type", b"text/plain; charset=utf-8"), (b"content-length", str(len(said)).encode())]
    await send({"type": "http.response.start", "status": 403, "headers": heads})
    await send({"type": "http.response.body", "body": said})
