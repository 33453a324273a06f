"""A page of the window without a browser: it says what it likes over the page's own connection, and hears all."""

from __future__ import annotations

import contextlib
import json
import re
import threading
import time
import urllib.error
import urllib.request
import uuid
from urllib.parse import urlencode

_ESCAPES = (("&#36;", "$"), ("&#96;", "`"), ("&gt;", ">"), ("&lt;", "<"), ("&amp;", "&"))


class Page:
    """One page; close it, or use it as a context.

    Parameters
    ----------
    address : str
        As `fegear open` prints it, or without a key if `cookie` is given.
    cookie : str
        Of a page that was opened before.

    Attributes
    ----------
    elements : dict
        What the page was built of.
    heard : list of str
        What the server has said.
    """

    def __init__(self, address: str, cookie: str = "") -> None:
        from websockets.sync.client import connect

        bare = address.partition("?")[0]
        if not cookie:
            cookie = urllib.request.urlopen(address).headers["set-cookie"].partition(";")[0]  # noqa: S310
        self.cookie = cookie
        page = urllib.request.urlopen(urllib.request.Request(bare, headers={"Cookie": cookie})).read().decode()  # noqa: S310
        query = re.search(r"query\s*:\s*(\{.*?\})", page, re.DOTALL)[1].replace("'", '"').replace("True", "true")
        told = json.loads(query)
        self.client = told["client_id"]
        told |= {"document_id": str(uuid.uuid4()), "tab_id": str(uuid.uuid4()), "EIO": 4, "transport": "websocket"}
        told["implicit_handshake"] = "true"
        text = re.search(r"parseElements\(String\.raw`(.*?)`\)", page, re.DOTALL)[1]
        for escape, sign in _ESCAPES:
            text = text.replace(escape, sign)
        self.elements = json.loads(text)
        self.heard: list[str] = []
        self.is_open = True
        self._held = contextlib.ExitStack()
        self._connection = self._held.enter_context(connect(
            f"{bare.replace('http', 'ws')}_nicegui_ws/socket.io/?{urlencode(told)}", max_size=None,
            additional_headers={"Cookie": cookie},
        ))  # fmt: skip
        self._connection.recv()
        self.send("40")
        threading.Thread(target=self._listen, daemon=True).start()
        self.until(lambda: any(one.startswith("40") for one in self.heard))

    def __enter__(self) -> Page:
        return self

    def __exit__(self, *_exception: object) -> None:
        self.close()

    def close(self) -> None:
        """Close the page."""
        self._held.close()

    def _listen(self) -> None:
        from websockets.exceptions import ConnectionClosed

        with contextlib.suppress(ConnectionClosed):
            for said in self._connection:
                if said == "2":
                    self.send("3")
                else:
                    self.heard.append(str(said))
        self.is_open = False

    def send(self, frame: str) -> None:
        """Say anything at all."""
        self._connection.send(frame)

    def listener(self, kind: str, element: str = "0") -> str:
        """Name of what listens for a kind of event."""
        return next(one["listener_id"] for one in self.elements[element]["events"] if one["type"] == kind)

    def event(self, kind: str, said: object, element: str = "0") -> dict:
        """What a page says with an event."""
        return {
            "id": int(element), "client_id": self.client, "listener_id": self.listener(kind, element),
            "args": [json.dumps(said)],
        }  # fmt: skip

    def say(self, kind: str, said: object, element: str = "0") -> None:
        """Say an event."""
        self.send(f"42{json.dumps(['event', self.event(kind, said, element)])}")

    def element(self, **props: str) -> str:
        """Number of the first element with such properties."""
        return next(
            number for number, one in self.elements.items()
            if all(str(one.get("props", {}).get(name.replace("_", "-"))) == value for name, value in props.items())
        )  # fmt: skip

    def until(self, holds, patience: float = 60.0) -> None:
        """Wait until something holds."""
        end = time.monotonic() + patience
        while not holds():
            assert time.monotonic() < end, "waited in vain"
            time.sleep(0.02)


def status(address: str, **heads: str) -> int:
    """What an address is answered with."""
    try:
        with urllib.request.urlopen(urllib.request.Request(address, headers=heads)) as answer:  # noqa: S310
            return answer.status
    except urllib.error.HTTPError as refused:
        return refused.code


def closed() -> type[Exception]:
    """What is raised where the server has closed a connection."""
    from websockets.exceptions import ConnectionClosed

    return ConnectionClosed
