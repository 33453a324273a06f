"""What pages say to the window's server: floods, long texts, halves of characters, nonsense, and other accounts."""

from __future__ import annotations

import contextlib
import importlib.util
import json
import os
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

import pytest

pytest.importorskip("nicegui", reason="nicegui is missing; pip install 'fegear[workbench]'")

_spec = importlib.util.spec_from_file_location("window_page", Path(__file__).with_name("window_page.py"))
assert _spec is not None
assert _spec.loader is not None
window_page = importlib.util.module_from_spec(_spec)
sys.modules["window_page"] = window_page
_spec.loader.exec_module(window_page)

TEXT = """title = "a pair"
results = ["load-sharing"]
[gear.a]
teeth = 28
module = "3 mm"
face_width = "20 mm"
[pair.I]
driver = "a"
driven = "a"
load = "5 kN"
compliance = { source = "weber-banaschek" }
"""
UPGRADE = (
    "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
)
GEAR = '[gear.g{0}]\nteeth = {1}\nmodule = "3 mm"\nface_width = "20 mm"\n'


class Served:
    """`fegear open` in a process of its own."""

    def __init__(self, folder: Path, *options: str) -> None:
        self.folder, self.errors = folder, folder / "errors"
        (folder / "scratch").mkdir()
        (folder / "c.toml").write_text(TEXT)
        kept = {name: value for name, value in os.environ.items() if not name.startswith("PYTEST")}
        self.process = subprocess.Popen(
            [sys.executable, "-m", "fegear", "open", "--no-browser", *options, "c.toml"],
            stdout=subprocess.PIPE, text=True, stderr=self.errors.open("w"), cwd=folder, env=kept | {
                "FEGEAR_STATE": str(folder / "state"), "PYTHONUNBUFFERED": "1", "TMPDIR": str(folder / "scratch"),
            },
        )  # fmt: skip
        self.address = self.process.stdout.readline().split()[-1]
        self.bare = self.address.partition("?")[0]

    def kept(self) -> list[str]:
        """Texts that are kept beyond a crash."""
        found = []
        for place in (self.folder / "state").glob("*.json"):
            with contextlib.suppress(OSError, ValueError):
                found.append(json.loads(place.read_text())["text"])
        return found

    def end(self) -> float:
        """How long it takes to end [s]."""
        started = time.monotonic()
        self.process.send_signal(signal.SIGTERM)
        self.process.stdout.close()
        assert self.process.wait(60) == 128 + signal.SIGTERM
        assert "Traceback" not in self.errors.read_text()
        return time.monotonic() - started


@pytest.fixture
def served(tmp_path):
    made = Served(tmp_path)
    yield made
    if made.process.poll() is None:
        made.process.kill()
        made.process.wait()


def typed(page, text: str) -> None:
    """A text in the text's field, in pieces as a page sends it."""
    said = json.dumps(page.event("update:value", text, page.element(type="textarea")))
    pieces = [said[i : i + 100_000] for i in range(0, len(said), 100_000)]
    for at, piece in enumerate(pieces):
        told = {"client_id": page.client, "name": str(id(said)), "count": len(pieces), "at": at, "text": piece}
        page.send(f"42{json.dumps(['piece', told])}")


def as_other_account(port: int, request: str) -> str:
    """First line of what an account is answered that is not the server's."""
    program = f'exec 3<>/dev/tcp/127.0.0.1/{port}; printf \'%b\' "$0" >&3; read -r -t 20 line <&3; echo "$line"'
    command = [shutil.which("bash"), "-c", program, request.replace("\r\n", "\\r\\n")]
    return subprocess.run(command, capture_output=True, text=True, check=False, user=65534, cwd="/").stdout.strip()


@pytest.mark.long
def test_whatever_a_page_says_that_looks_on_nothing_changes(tmp_path):
    """Every event of every element, every message of the page's scripts, on its own page and on its owner's."""
    from fegear.window.messages import EVENTS

    served = Served(tmp_path, "--read-only-link")
    look = served.process.stdout.readline().split()[-1]
    try:
        with window_page.Page(served.address) as owner, window_page.Page(look) as page:
            assert page.cookie.startswith("fegear-look-")
            assert any("fegearLook.begin" in one for one in page.heard) or page.elements
            values = {str: "gear", int: 0, float: 1.0, bool: False, list: []}
            count = 0
            for of in (page, owner):
                for kind, parts in EVENTS.items():
                    said = {name: values[one] for name, one in parts.items()} | {"gear": "a", "pair": "I"}
                    said |= {"field": "gear.a.teeth", "text": "30"} if kind == "value" else {}
                    page.send(f"42{json.dumps(['event', of.event(kind, said)])}")
                    count += 1
                for number, one in of.elements.items():
                    for event in one.get("events", ()):
                        told = {"id": int(number), "client_id": of.client, "listener_id": event["listener_id"],
                                "args": [json.dumps("changed")]}  # fmt: skip
                        page.send(f"42{json.dumps(['event', told])}")
                        count += 1
                typed(of, TEXT)  # its pieces
            page.until(lambda: sum("403" in one for one in page.heard) >= count)
            cookie = {"Cookie": page.cookie}
            assert window_page.status(served.bare, **cookie) == 200
            assert window_page.status(served.bare + "_nicegui_ws/socket.io/?EIO=4&transport=polling", **cookie) == 403
            owner.say("load", {"pair": "I", "key": "load", "text": "6 kN", "moving": False})  # it still hears its owner
            owner.until(lambda: any("6 kN" in one for one in served.kept()))
            assert [one for one in served.kept() if one != TEXT.replace("5 kN", "6 kN")] == []
        assert (tmp_path / "c.toml").read_text() == TEXT
        served.end()
    finally:
        if served.process.poll() is None:
            served.process.kill()
            served.process.wait()


@pytest.mark.dear
def test_others_are_refused_everywhere(served):
    """With the address and the cookie in their hands, too."""
    port = int(served.bare.rstrip("/").rpartition(":")[2])
    with window_page.Page(served.address) as page:
        own = {"Cookie": page.cookie}
        places = ("", "fegear/window.js", "_nicegui_ws/socket.io/?EIO=4&transport=polling", "any", "favicon.ico")
        for place in places:
            assert window_page.status(served.bare + place) == 403
            assert window_page.status(served.bare + place, **own, Host=f"rebound.example:{port}") == 403
            assert window_page.status(served.bare + place, **own, Origin="http://evil.example") == 403
            assert window_page.status(served.bare + place, **own, Origin=f"http://127.0.0.1:{port + 1}") == 403
            assert window_page.status(served.bare + place, Cookie=f"fegear-{port}=guessed") == 403
        told = Path("/proc/net/tcp").exists()  # by whom a connection is: this account may come again by its key
        assert window_page.status(served.address) == (200 if told else 403)
        assert window_page.status(served.bare, **own) == 200
        for line in Path(f"/proc/{served.process.pid}/task").glob("*/children"):
            for child in line.read_text().split():
                assert b"key=" not in Path(f"/proc/{child}/cmdline").read_bytes()
        readable = [one for one in (served.folder / "scratch").iterdir() if one.stat().st_mode & 0o077]
        assert readable == []
        if os.getuid() == 0 and shutil.which("bash"):
            for place in (*places, f"?key={served.address.rpartition('key=')[2]}"):
                for head in ("", UPGRADE, "X-Forwarded-For: 10.0.0.1\r\n"):
                    own_heads = f"Host: 127.0.0.1:{port}\r\nCookie: {page.cookie}\r\n{head}"
                    request = f"GET /{place} HTTP/1.1\r\n{own_heads}\r\n"
                    assert "403" in as_other_account(port, request), (place, head)
    served.end()


@pytest.mark.dear
def test_half_a_character_is_refused_in_words_and_nothing_else_is_lost(served):
    """It was dropped by the framework, with a traceback in the terminal."""
    with window_page.Page(served.address) as page:
        half = TEXT.replace("a pair", "a \ud800 pair")
        page.say("update:value", half, page.element(type="textarea"))
        page.until(lambda: any("contains an invalid character (surrogate) in line 1" in one for one in page.heard))
        assert served.kept() == []
        field = page.element(data_key="gear.a.module")
        page.say("update:value", "3 \udfff mm", field)
        page.say("blur", None, field)
        page.until(
            lambda: any(
                "gear.a.module = (text): contains an invalid character (surrogate)" in one for one in page.heard
            )
        )
        page.say("load", {"pair": "I", "key": "load", "text": "6 kN", "moving": False})
        page.until(lambda: served.kept() == [TEXT.replace("5 kN", "6 kN")])
        time.sleep(1.5)  # the text is shown anew where nobody has typed for a while: not over what is not taken
        page.say("update:value", TEXT.replace("a pair", "my pair"), page.element(type="textarea"))
        page.until(lambda: served.kept() == [TEXT.replace("5 kN", "6 kN").replace("a pair", "my pair")])
    served.end()


def test_a_long_text_is_said_again_from_its_first_piece_and_what_others_have_begun_keeps_nobody_from_it(served):
    """A page says it again whose connection was lost; eight texts that were never ended had kept all others out."""
    long = TEXT.replace("5 kN", "6 kN") + "# µ\n" * 60_000
    with window_page.Page(served.address) as begun, window_page.Page(served.address, begun.cookie) as page:
        for i in range(8):
            told = {"client_id": begun.client, "name": f"n{i}", "count": 2, "at": 0, "text": "{"}
            begun.send(f"42{json.dumps(['piece', told])}")
        begun.say("load", {"pair": "I", "key": "load", "text": "5.5 kN", "moving": False})
        page.until(lambda: served.kept() == [TEXT.replace("5 kN", "5.5 kN")])  # all of them are there
        name = {"count": 3, "name": "n"}
        said = json.dumps(page.event("update:value", long, page.element(type="textarea")))
        size = len(said) // 3 + 1
        pieces = [
            name | {"client_id": page.client, "at": at, "text": said[at * size : (at + 1) * size]} for at in range(3)
        ]
        for piece in (*pieces[:2], *pieces):
            page.send(f"42{json.dumps(['piece', piece])}")
        page.until(lambda: long in served.kept())
        assert not any("could not be read" in one for one in page.heard)
    served.end()


@pytest.mark.dear
@pytest.mark.parametrize("moving", [False, True])
def test_a_flood_of_changes_from_two_pages_is_taken_and_the_pages_stay(served, moving):
    """95 % of them were dropped: pages that were not heard for half a minute lost their connection."""
    with window_page.Page(served.address) as first, window_page.Page(served.address, first.cookie) as second:
        for i in range(2000):
            for number, page in enumerate((first, second), start=1):
                text = f"{number}{i:04d} N"
                page.say("load", {"pair": "I", "key": "load", "text": text, "moving": moving})
        last = {TEXT.replace("5 kN", f"{number}1999 N") for number in (1, 2)}
        first.until(lambda: last & set(served.kept()), 120.0)
        for page in (first, second):
            page.say("load", {"pair": "I", "key": "load", "text": "7 kN", "moving": False})
            page.until(lambda: served.kept() == [TEXT.replace("5 kN", "7 kN")])
            page.say("load", {"pair": "I", "key": "load", "text": "8 kN", "moving": False})
            page.until(lambda: served.kept() == [TEXT.replace("5 kN", "8 kN")])
            assert page.is_open
            assert not any("reload" in one for one in page.heard)
    assert served.end() < 10.0


@pytest.mark.dear
def test_long_texts_are_taken_and_block_nobody(served):
    """Above a megabyte they were dropped; 3000 gears blocked the server for a minute, and its end, too."""
    gears = TEXT + "".join(GEAR.format(i, 20 + i % 60) for i in range(3000))
    long = TEXT.replace("5 kN", "6 kN") + '# "µ" and more of it\n' * 70_000
    with window_page.Page(served.address) as page:
        for text in (long, gears):
            typed(page, text)
            page.until(lambda text=text: text in served.kept())
            slowest, end = 0.0, time.monotonic() + 3.5
            while time.monotonic() < end:
                started = time.monotonic()
                assert window_page.status(served.bare) == 403
                slowest = max(slowest, time.monotonic() - started)
                time.sleep(0.02)
            assert slowest < 3.0  # a hundred times less on an idle machine than what is asked of a busy one
        typed(page, TEXT + "#" * 4_000_000)
        page.until(lambda: any("the maximum is 4000000" in one for one in page.heard))
        assert served.kept() == [gears]
        typed(page, TEXT + "".join(GEAR.format(i, 20 + i % 60) for i in range(9000)))
        time.sleep(0.5)  # it is being judged
    assert served.end() < 10.0


# ---- nonsense --------------------------------------------------------------------------------------------------------
JUNK = [
    None, True, False, 0, -1, 10**30, 1e308, 0.5, "", "x", "I", "\ud800", "x" * 5000, "\0", "../../etc/passwd", [], {},
    [None], {"a": 1}, {"value": 10**9}, {"value": 0}, [{"value": "x"}], [[[]]], {"shiftKey": "x"}, "tip", "NaN",
]  # fmt: skip
FRAMES = [
    "", "4", "42", "42[", '42["event"', "42[]", "42{}", '42["event"]', "9", "5", "6", "43[]", "41", '42["none",{}]',
    "452-[]", "b4AA", '42["event",' + "[" * 3000,
]  # fmt: skip
SAID = {
    "relief": {"gear": "a", "end": "tip", "index": 0, "start": 28.0, "amount": 5.0, "moving": False},
    "load": {"pair": "I", "key": "load", "text": "6 kN", "moving": True},
    "drop": {"gear": "a"},
    "name_driven": {"pair": "I"},
    "design": {"pair": "I", "how": "ground"},
    "shows": {"pair": "I", "kind": "stress", "on": True},
    "sight": {"tasks": ["load-sharing of I"]},
    "view": {"pictures": ["te"], "measure": "mises", "folded": False, "report": False, "middle": ""},
    "untaken": {},
    "unwritten": {},
    "save": {},
}


def another(rng: random.Random, value: object) -> object:
    """Something like a value, with one part that is not."""
    if isinstance(value, dict) and value and rng.random() < 0.8:
        name, made = rng.choice(sorted(value)), dict(value)
        what = rng.randrange(4)
        if what == 0:
            del made[name]
        elif what == 1:
            made[str(rng.choice(JUNK))] = rng.choice(JUNK)
        else:
            made[name] = another(rng, made[name])
        return made
    if isinstance(value, list) and value and rng.random() < 0.5:
        return [*value[1:], rng.choice(JUNK)]
    if isinstance(value, str) and value and rng.random() < 0.3:
        at = rng.randrange(len(value))
        return value[:at] + rng.choice(["", "\ud800", '"', "\0", "\n", "9"]) + value[at + 1 :]
    return rng.choice(JUNK)


def nonsense(rng: random.Random, page) -> str:
    """A frame with something in it that no page says."""
    what = rng.randrange(12)
    if what == 0:  # of the connection
        return rng.choice(FRAMES)
    if what == 1:  # of the framework
        name = rng.choice(["handshake", "ack", "log", "javascript_response", "piece"])
        told = {
            "client_id": page.client, "next_message_id": 1, "tab_id": "x", "document_id": "x", "level": "error",
            "message": "x", "request_id": "x", "result": 1, "name": "x", "count": 2, "at": 0, "text": "{",
        }  # fmt: skip
        return f"42{json.dumps([name, another(rng, told)])}"
    if what < 6:
        kind = rng.choice(sorted(SAID))
        said = page.event(kind, another(rng, SAID[kind]))
    else:
        number = rng.choice([number for number, one in page.elements.items() if one.get("events")])
        listener = rng.choice(page.elements[number]["events"])["listener_id"]
        text = json.dumps(rng.choice(JUNK))
        args = [[text], [], [text, text], ["{"], [None], ["NaN"], [1], None, text, ["[" * 3000]]
        said = {"id": int(number), "client_id": page.client, "listener_id": listener,
                "args": args[0] if rng.random() < 0.5 else rng.choice(args)}  # fmt: skip
    return f"42{json.dumps(['event', another(rng, said) if rng.random() < 0.2 else said])}"


def hold_on(served, number: int, cookie: str) -> None:
    """A change made by a new page is taken and kept, or refused in words: some nonsense clears the desk."""
    text = TEXT.replace("5 kN", f"{number} N")

    def taken() -> bool:  # perhaps with what a page before has changed at the same time
        return any(f'"{number} N"' in one for one in served.kept())

    for _ in range(5):
        with window_page.Page(served.bare, cookie) as page:
            offers = [key for key, one in page.elements.items() if "offer" in one.get("class", ())]
            if offers:
                page.say("click", None, offers[0])
                page.until(lambda: any("laid" in one for one in page.heard))
                continue
            page.say("update:value", text, page.element(type="textarea"))
            page.until(lambda: taken() or any("not accepted" in one for one in page.heard))
            if taken():
                return
    raise AssertionError("refused again and again")


def say_nonsense(served, seed: int, count: int) -> None:
    rng = random.Random(seed)  # noqa: S311 - the same ones each time
    page = window_page.Page(served.address)
    cookie = page.cookie
    for number in range(count):
        if not page.is_open or number % 25 == 24:
            page.close()
            hold_on(served, 1000 + number, cookie)
            page = window_page.Page(served.bare, cookie)
        with contextlib.suppress(OSError, window_page.closed()):
            page.send(nonsense(rng, page))
    page.close()
    hold_on(served, 9999, cookie)
    assert served.end() < 10.0


@pytest.mark.parametrize("count", [pytest.param(40, id="handful"), pytest.param(1000, marks=pytest.mark.long)])
def test_nonsense_of_a_page_is_refused_and_what_follows_is_taken(served, count):
    say_nonsense(served, 18_19 + count, count)
