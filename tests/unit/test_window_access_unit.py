"""Who gets into the window, and how far the page reaches: keys that work once, accounts, folders that were opened."""

from __future__ import annotations

import asyncio
import os
import shutil
import socket
import stat
import subprocess
from types import SimpleNamespace

import pytest

from fegear.base.errors import InputError
from fegear.case.reading import build_scene, parse_document
from fegear.window import access
from fegear.window.access import LOOKS, Doorkeeper, Keys, account_of, file_leading_to
from fegear.window.bench import Bench
from fegear.window.document import Desk
from fegear.window.reach import Reach
from fegear.window.server import _Door
from fegear.window.worker import scene_of

HOST = {"host": "127.0.0.1:5000"}
TEXT = """results = ["load-sharing"]
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


@pytest.fixture(autouse=True)
def state(tmp_path, monkeypatch):
    monkeypatch.setenv("FEGEAR_STATE", str(tmp_path / "state"))


def asked(door: Doorkeeper, query: str = "", kind: str = "http", path: str = "/", **heads: str) -> dict:
    """The head of an answer, by name."""
    sent = []

    async def send(message):
        sent.append(message)

    heads = HOST | {name.replace("_", "-"): value for name, value in heads.items()}
    scope = {
        "type": kind, "method": heads.pop("method", "GET"), "path": path, "query_string": query.encode(),
        "headers": [(k.encode(), v.encode("latin-1")) for k, v in heads.items()], "client": ("127.0.0.1", 1),
    }  # fmt: skip
    asyncio.run(door(scope, None, send))
    found = {name.decode(): value.decode() for name, value in sent[0].get("headers", ())}
    return found | {"status": sent[0].get("status", sent[0].get("code")), "body": sent[-1].get("body", b"")}


async def page(scope, receive, send):
    await send({"type": "http.response.start", "status": 200, "headers": []})
    await send({"type": "http.response.body", "body": b"the page"})


def test_a_key_opens_the_page_once_and_its_cookie_from_then_on():
    """One secret stood in the address for as long as the window was open, and on the browser's command line."""
    keys, used = Keys(), []
    door, key = Doorkeeper(page, 5000, keys), keys.another(lambda: used.append("used"))
    first = asked(door, f"key={key}")
    name, *rest = first["set-cookie"].split("; ")
    assert (first["status"], set(rest)) == (200, {"HttpOnly", "SameSite=Strict", "Path=/"})
    assert name == f"fegear-5000={keys.secret}"
    assert b"the page" not in first["body"]
    assert key not in keys.secret
    assert keys.secret.encode() not in first["body"]
    assert used == ["used"]
    assert asked(door, f"key={key}")["status"] == 403  # whoever has read it on a command line meanwhile
    assert asked(door, cookie=name)["body"] == b"the page"
    assert asked(door, f"key={key}", cookie=name)["body"] == b"the page"  # the same browser, by its history
    again = keys.another(lambda: None)
    asked(door, f"key={again}", cookie=name)  # a browser that needs none uses it up all the same
    assert asked(door, f"key={again}")["status"] == 403


@pytest.mark.parametrize(("account", "again"), [(lambda: os.getuid(), 200), (lambda: None, 403)])
def test_the_printed_address_opens_another_browser_of_the_account_that_runs_the_window(monkeypatch, account, again):
    """A projector's browser that was started again was refused; where no system tells the account it still is."""
    monkeypatch.setattr("fegear.window.access.account_of", lambda *_: account())
    keys, used = Keys(), []
    door, key = Doorkeeper(page, 5000, keys), keys.another(lambda: used.append("used"), again=True)
    assert asked(door, f"key={key}")["status"] == 200
    second = asked(door, f"key={key}")
    assert second["status"] == again
    assert ("set-cookie" in second) == keys.is_open(key) == (not used) == (again == 200)
    led = keys.another(lambda: None)  # by the file at the start: once
    assert [asked(door, f"key={led}")["status"] for _ in range(2)] == [200, 403]


@pytest.mark.skipif(not hasattr(os, "getuid"), reason="accounts have numbers on POSIX only")
def test_another_account_is_refused_with_the_printed_address(monkeypatch):
    monkeypatch.setattr("fegear.window.access.account_of", lambda *_: os.getuid() + 1)
    keys = Keys()
    door, key = Doorkeeper(page, 5000, keys), keys.another(lambda: None, again=True)
    if os.getuid() + 1 != 0:
        assert asked(door, f"key={key}")["status"] == 403
        assert asked(door, cookie=f"fegear-5000={keys.secret}")["status"] == 403


READS = ["40", "40{}", "41", "1", "3", '42["handshake",{"client_id":"x"}]', '42["ack",{}]']
WRITES = [
    '42["event",{"id":1}]', '42["piece",{}]', '42["log",{}]', '42["javascript_response",{}]', '42["handshake2",{}]',
    '42/other,["event",{}]', '42["handshake",{}]\x1e42["event",{}]', '42 ["handshake",{}]', '42["event","ack"]',
    '4 2["event",{}]', ' 42["event",{}]', '45["event",{}]', '451-["event",{}]', '46[]', "40/other,", "3probe", "5", "2",
    "4", "", '42["\\u0065vent",{}]', "43[]",
]  # fmt: skip


def look_on(door: Doorkeeper, cookie: str, frames: list[dict]) -> list[str]:
    """What is answered to the messages of a page."""
    sent, left = [], [*frames, {"type": "websocket.disconnect"}]

    async def receive():
        return left.pop(0)

    async def send(message):
        sent.append(message.get("text"))

    heads = [(k.encode(), v.encode()) for k, v in (HOST | {"cookie": cookie}).items()]
    scope = {
        "type": "websocket", "path": "/_nicegui_ws/socket.io/", "query_string": b"", "headers": heads,
        "client": ("127.0.0.1", 1),
    }  # fmt: skip
    asyncio.run(door(scope, receive, send))
    return sent


def test_who_looks_on_reads_and_changes_nothing():
    """Everything that the page says to change something, and everything that might pass for what it may say."""
    heard, scopes = [], []

    async def framework(scope, receive, send):
        scopes.append(scope)
        while scope["type"] == "websocket" and (message := await receive())["type"] != "websocket.disconnect":
            heard.append(message.get("text") or message.get("bytes"))
        if scope["type"] == "http":
            await page(scope, receive, send)

    keys = Keys()
    door = Doorkeeper(framework, 5000, keys)
    opened = [asked(door, f"look={keys.look}") for _ in range(2)]  # as often as it is used
    (cookie,) = {one["set-cookie"].partition(";")[0] for one in opened}
    assert cookie == f"fegear-look-5000={keys.look_secret}"
    assert keys.secret not in str(opened)
    assert asked(door, cookie=cookie)["body"] == b"the page"
    assert scopes[-1][LOOKS] is True
    for method in ("POST", "PUT", "DELETE", "PATCH", "OPTIONS", "TRACE"):
        assert asked(door, cookie=cookie, method=method)["status"] == 403
    for method in ("GET", "POST"):  # by requests in place of a connection
        polled = asked(door, "EIO=4&transport=polling", path="/_nicegui_ws/socket.io/", cookie=cookie, method=method)
        assert polled["status"] == 403
    frames = [{"type": "websocket.receive", "text": one} for one in READS + WRITES]
    answers = look_on(door, cookie, [*frames, {"type": "websocket.receive", "bytes": b'42["event"]'}])
    assert heard == READS
    assert answers == ['42["refused",403]'] * (len(WRITES) + 1)
    assert look_on(door, cookie, [{"type": "websocket.receive", "text": '427["event",{}]'}]) == ["437[403]"]
    heard.clear()
    look_on(door, f"fegear-5000={keys.secret}", frames[:1] + frames[len(READS) : len(READS) + 1])
    assert heard == ["40", WRITES[0]]  # whose page it is
    assert LOOKS not in scopes[-1]
    # One secret is not the other, nor is one key.
    assert asked(door, cookie=f"fegear-5000={keys.look_secret}")["status"] == 403
    assert asked(door, cookie=f"fegear-look-5000={keys.secret}")["status"] == 403
    assert asked(door, f"key={keys.look}")["status"] == asked(door, "look=")["status"] == 403
    assert asked(door, f"look={keys.look}", origin="http://evil.example")["status"] == 403


@pytest.mark.parametrize(
    "heads",
    [
        {"host": "evil.example:5000"}, {"host": "127.0.0.1:5001"}, {"origin": "http://evil.example"},
        {"origin": "null"}, {"sec_fetch_site": "cross-site", "sec_fetch_dest": "iframe"},
        {"sec_fetch_site": "same-site", "sec_fetch_dest": "empty"}, {"method": "POST"}, {"kind": "websocket"},
        {"path": "/fegear/window.js"},
    ],
)  # fmt: skip
def test_a_key_opens_nothing_for_others_and_is_not_used_up_by_them(heads):
    keys = Keys()
    door, key = Doorkeeper(page, 5000, keys), keys.another(lambda: None)
    assert asked(door, f"key={key}", **heads)["status"] in (403, 1008)
    assert keys.is_open(key)
    led = asked(door, f"key={key}", sec_fetch_site="cross-site", sec_fetch_dest="document")  # by the file
    assert led["status"] == 200


def test_a_browser_is_led_to_the_page_by_a_file_of_its_owner(tmp_path, monkeypatch):
    """Its command line was read in the list of processes, from any account."""
    said, opened = [], []
    monkeypatch.setattr("webbrowser.open", opened.append)

    async def led():
        server = await asyncio.start_server(lambda *_: None, "127.0.0.1", 0)
        door = _Door(server.sockets[0].getsockname()[1], tmp_path, said.append)
        door.begin(browser=True)
        place = tmp_path / "open.html"
        while not opened:
            await asyncio.sleep(0.01)
        assert opened == [place.as_uri()]
        assert stat.S_IMODE(place.stat().st_mode) == 0o600
        text = place.read_text()
        key = text.partition("key=")[2].partition('"')[0]
        assert key not in said[0]
        assert not door.keys.take("another")
        assert door.keys.take(key)
        while place.exists():  # it has led where it should
            await asyncio.sleep(0.01)
        shown = said[0].partition("key=")[2]
        assert door.keys.take(shown)
        assert said[-1].startswith("This address has been used; for another browser open http://127.0.0.1:")
        assert door.keys.take(said[-1].partition("key=")[2])
        server.close()

    asyncio.run(led())


def test_the_file_that_leads_is_never_one_that_lies_there(tmp_path):
    (tmp_path / "open.html").symlink_to(tmp_path / "elsewhere")
    with pytest.raises(OSError, match="exists"):
        file_leading_to("http://127.0.0.1:5000/", tmp_path)


@pytest.fixture
def listening():
    with socket.socket() as made:
        made.bind(("127.0.0.1", 0))
        made.listen()
        yield made


@pytest.mark.skipif(not os.path.exists("/proc/net/tcp"), reason="only Linux tells whose a connection is")  # noqa: PTH110
@pytest.mark.parametrize("family", [socket.AF_INET, socket.AF_INET6])
def test_the_account_of_a_connection_is_known(listening, family):
    port = listening.getsockname()[1]
    address = ("127.0.0.1", port) if family == socket.AF_INET else ("::ffff:127.0.0.1", port)
    with socket.socket(family) as asking:
        asking.connect(address)
        accepted, client = listening.accept()
        with accepted:
            assert account_of(client, port) == os.getuid()
            assert account_of((client[0], client[1] ^ 1), port) is None
            assert account_of(("127.0.0.2", client[1]), port) is None
            asking.close()
            assert account_of(client, port) in (None, -1)  # who is gone is not taken for the first account
    for client in (None, ("", 0), ("testclient", 50000)):
        assert account_of(client, port) is None


@pytest.mark.skipif(not hasattr(os, "getuid") or os.getuid() != 0, reason="only root can be another account")
@pytest.mark.skipif(shutil.which("bash") is None, reason="bash is missing")
def test_another_account_is_refused_whatever_it_knows(listening):
    port = listening.getsockname()[1]
    keys = Keys()
    door, key, sent = Doorkeeper(page, port, keys), keys.another(lambda: None), []
    program = f"exec 3<>/dev/tcp/127.0.0.1/{port}; read -r -t 60 line <&3"
    with subprocess.Popen([shutil.which("bash"), "-c", program], user=65534, cwd="/") as other:
        accepted, client = listening.accept()

        async def send(message):
            sent.append(message)

        with accepted:
            assert account_of(client, port) == 65534
            cookie = (b"cookie", f"fegear-{port}={keys.secret}".encode())
            for kind in ("http", "websocket"):
                scope = {
                    "type": kind, "method": "GET", "path": "/", "query_string": f"key={key}".encode(),
                    "headers": [(b"host", f"127.0.0.1:{port}".encode()), cookie], "client": client,
                }  # fmt: skip
                asyncio.run(door(scope, None, send))
        other.kill()
    assert [one.get("status", one.get("code")) for one in sent if "body" not in one] == [403, 1008]
    assert keys.is_open(key)


# ---- folders ---------------------------------------------------------------------------------------------------------
@pytest.fixture
def places(tmp_path, monkeypatch):
    """A folder that was opened, one that was not, and links between them."""
    mine, others = tmp_path / "mine", tmp_path / "others"
    for folder in (mine / "below", others):
        folder.mkdir(parents=True)
        (folder / "c.toml").write_text(TEXT)
    (mine / "link.toml").symlink_to(others / "c.toml")
    (mine / "way").symlink_to(others)
    (others / "back").symlink_to(mine)
    monkeypatch.chdir(mine)
    return SimpleNamespace(mine=mine, others=others, reach=Reach.of(None))


OUTSIDE = "is outside the open folders"


@pytest.mark.parametrize(("account", "let_in"), [(0, True), (1, False), (1000, True), (1001, False), (None, True)])
def test_only_the_owner_of_the_window_and_the_administrator_come_in(monkeypatch, account, let_in):
    """Whoever runs the window: here account 1000. Where the system does not tell who asks, the key decides."""
    monkeypatch.setattr(access.os, "getuid", lambda: 1000)
    monkeypatch.setattr(access, "account_of", lambda _client, _port: account)
    door = Doorkeeper(page, 5000, keys := Keys())
    opened = asked(door, f"key={keys.another(lambda: None, again=True)}")
    assert opened["status"] == (200 if let_in else 403)
    assert door._is_ours(account, HOST) is let_in


def test_the_page_opens_files_below_the_folders_that_were_opened(places):
    """It opened whatever its account may read."""
    bench = Bench(None, None, places.reach)
    bench.from_file(places.mine / "below" / "c.toml")
    bench.from_file(places.others / "back" / "below" / "c.toml")  # a link that leads home
    laid = bench.desk
    for path in (
        places.others / "c.toml", places.mine / "link.toml", places.mine / "way" / "c.toml",
        places.mine / ".." / "others" / "c.toml", places.others / "missing.toml", places.mine / "way" / "missing",
    ):  # fmt: skip
        with pytest.raises(InputError, match=f"{OUTSIDE}.*--folder FOLDER"):
            bench.from_file(path)
    assert bench.desk is laid


def test_a_case_named_on_the_command_line_is_opened_wherever_it_lies(places):
    linked = places.mine / "link.toml"
    bench = Bench(linked, None, Reach.of(linked))
    bench.desk.set(("pair", "I", "load"), '"6 kN"')
    bench.desk.save()
    assert "6 kN" in (places.others / "c.toml").read_text()
    with pytest.raises(InputError, match=OUTSIDE):
        bench.desk.save_as(places.others / "d.toml")
    of_others = Bench(None, None, Reach.of(None, [places.others]))
    of_others.from_file(places.others / "c.toml")
    with pytest.raises(InputError, match=r"--folder = .*is not a folder"):
        Reach.of(None, [places.others / "c.toml"])


def test_the_page_writes_below_the_folders_that_were_opened(places):
    jobs = []
    bench = Bench(None, SimpleNamespace(ask=jobs.append), places.reach)
    bench.from_template("pair")
    for path in (places.others / "d", places.mine / "way" / "d", places.mine / "link.toml"):
        with pytest.raises(InputError, match=OUTSIDE):
            bench.desk.save_as(path, replace=True)
    count = len(jobs)
    for target in (places.others / "out", places.mine / "way", places.mine / "way" / "out"):
        with pytest.raises(InputError, match=OUTSIDE):
            bench.export("report", str(target))
    assert len(jobs) == count
    bench.desk.save_as(places.mine / "d")
    (places.mine / "d.toml").unlink()
    (places.mine / "d.toml").symlink_to(places.others / "c.toml")  # by somebody, since
    with pytest.raises(InputError, match=OUTSIDE):
        bench.desk.save(over_others=True)
    with pytest.raises(InputError, match=OUTSIDE):
        bench.desk.give_up()
    assert (places.others / "c.toml").read_text() == TEXT
    assert sorted(one.name for one in places.others.iterdir()) == ["back", "c.toml"]


def test_a_case_of_the_page_names_files_below_the_folders_that_were_opened(places):
    """A table's refusal repeats what stands in the file: any file could be read by naming it."""
    table = "x [mm],own [um/N]\n0,1\n1,1\n"
    for folder in (places.mine, places.others):
        (folder / "secret.csv").write_text("root:x:0:0\nroot:x:0:0\n")
        (folder / "t.csv").write_text(table)
    jobs = []
    bench = Bench(None, SimpleNamespace(ask=jobs.append), places.reach)
    for name, outside in (
        ("t.csv", False), ("../others/t.csv", True), ("way/t.csv", True), (str(places.others / "secret.csv"), True),
        ("/nowhere/at/all.csv", True),
    ):  # fmt: skip
        text = TEXT.replace('"weber-banaschek"', f'"table", file = "{name}"')
        bench.lay(Desk(text, "c", places.mine, None, bench.reach))
        scene = scene_of(bench.asked()._replace(text=text))
        if outside:
            with pytest.raises(InputError, match=OUTSIDE) as refused:
                scene.file(name, "pair.I.compliance.file")
            assert "root:x" not in str(refused.value)
        else:
            assert scene.file(name, "pair.I.compliance.file").is_file()
    free = build_scene(parse_document(text, "c"), "c", places.mine)  # what a command runs names any file
    assert free.file(str(places.others / "secret.csv"), "file").is_file()
