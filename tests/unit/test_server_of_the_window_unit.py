"""The window's server: where it listens, who may ask, what the framework is told, and what ends with it."""

import signal
import socket
from types import SimpleNamespace

import pytest

pytest.importorskip("nicegui", reason="nicegui is missing; pip install 'fegear[workbench]'")

import nicegui

from fegear.base.errors import InputError
from fegear.window import bench as benches
from fegear.window import page, server
from fegear.window.access import Doorkeeper


def test_a_port_that_is_taken_is_refused_and_a_free_one_is_found():
    assert server.HOST == "127.0.0.1"
    with socket.socket() as taken:
        taken.bind((server.HOST, 0))
        taken.listen()
        number = taken.getsockname()[1]
        with pytest.raises(InputError, match="--port"):
            server.free_port(number)
    assert server.free_port(number) == number
    assert 0 < server.free_port(None) < 65536
    with pytest.raises(InputError, match="--port"):
        server.free_port(10**6)


@pytest.mark.parametrize("browser", [True, False])
@pytest.mark.parametrize("look", [True, False])
def test_the_page_is_served_here_only_behind_the_doorkeeper_and_ends_with_the_computing_process(
    monkeypatch, tmp_path, browser, look
):
    done, told, ran = [], [], {}
    computing = SimpleNamespace(folder=tmp_path, close=lambda: done.append("closed"))
    bench = SimpleNamespace(begin=lambda: done.append("begun"))
    app = SimpleNamespace(
        on_startup=lambda act: ran.update(startup=act), on_shutdown=lambda act: ran.update(shutdown=act),
        add_middleware=lambda kind, **more: ran.update(kind=kind, middleware=more),
    )  # fmt: skip
    monkeypatch.setattr(benches, "Bench", lambda case, process, reach: told.append((case, process, reach)) or bench)
    monkeypatch.setattr(nicegui, "app", app)
    monkeypatch.setattr(nicegui, "ui", SimpleNamespace(run=lambda root, **more: ran.update(root=root, **more)))
    monkeypatch.setattr(page, "show", lambda of: done.append(("shown", of)))
    monkeypatch.setattr(server, "_end_with_the_terminal", lambda: done.append("terminal"))
    door = SimpleNamespace(keys="keys", begin=lambda *, browser: done.append(("door", browser)))
    monkeypatch.setattr(
        server, "_Door", lambda port, folder, say, *, look: told.append((port, folder, say, look)) or door
    )
    server._serve("case", 81, computing, "reach", browser=browser, say="say", look=look)
    assert told == [("case", computing, "reach"), (81, tmp_path, "say", look)]
    assert done == ["terminal"]
    ran["startup"]()
    ran["root"]()
    ran["shutdown"]()
    assert done[1:] == ["begun", ("door", browser), ("shown", bench), "closed"]
    assert (ran["kind"], ran["middleware"]) == (Doorkeeper, {"port": 81, "keys": "keys"})
    assert (ran["host"], ran["port"], ran["title"]) == ("127.0.0.1", 81, "fegear")
    # The framework opens no browser, prints nothing, reloads nothing, trusts no head that says who asks, and nothing
    # is packed for a way that leads nowhere.
    off = ("reload", "show", "show_welcome_message", "tailwind", "ws_per_message_deflate", "proxy_headers")
    assert [ran[name] for name in off] == [False] * len(off)
    assert ran["gzip_middleware_factory"] is None


def test_whatever_happens_the_computing_process_and_its_tracker_end(monkeypatch):
    done = []
    made = SimpleNamespace(close=lambda: done.append("closed"))
    monkeypatch.setattr(server, "free_port", lambda port: port or 4242)
    monkeypatch.setattr(server, "Reach", SimpleNamespace(of=lambda case, folders: (case, folders)))
    monkeypatch.setattr(server, "Computing", lambda: made)
    monkeypatch.setattr(server, "end_tracker", lambda: done.append("tracker"))

    def serve(*given, **more):
        done.append((given, more))
        raise KeyboardInterrupt

    monkeypatch.setattr(server, "_serve", serve)
    with pytest.raises(KeyboardInterrupt):
        server.serve("c", None, browser=False, say="say", folders=("f",), look=True)
    assert done == [
        (("c", 4242, made, ("c", ("f",))), {"browser": False, "say": "say", "look": True}), "closed", "tracker",
    ]  # fmt: skip


@pytest.mark.parametrize("heard", [True, False])
@pytest.mark.skipif(not hasattr(signal, "SIGHUP"), reason="Windows has no SIGHUP")
def test_a_terminal_that_closes_asks_to_end_unless_it_does_not_matter(monkeypatch, heard):
    put, raised = [], []
    monkeypatch.setattr(server.signal, "getsignal", lambda number: signal.SIG_DFL if heard else signal.SIG_IGN)
    monkeypatch.setattr(server.signal, "signal", lambda number, act: put.append((number, act)))
    monkeypatch.setattr(server.signal, "raise_signal", raised.append)
    server._end_with_the_terminal()
    assert len(put) == heard
    for number, act in put:
        act(number, None)
        assert (number, raised) == (signal.SIGHUP, [signal.SIGTERM])


def test_libraries_that_would_ask_others_are_not_loaded_and_may_be_afterwards(monkeypatch):
    import sys

    monkeypatch.setattr(server, "_CLIENTS", ("fegear_no_such_library", "json"))
    with server._without_clients():
        assert sys.modules["fegear_no_such_library"] is None
        assert sys.modules["json"] is not None
        with pytest.raises(ImportError):
            __import__("fegear_no_such_library")
    assert "fegear_no_such_library" not in sys.modules
    assert "json" in sys.modules
