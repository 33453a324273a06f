"""The server of the page: on this machine alone, for one case at a time, until it is asked to end."""

from __future__ import annotations

import contextlib
import secrets
import signal
import socket
import sys
import threading
import webbrowser
from typing import TYPE_CHECKING

from fegear.base.errors import InputError, MissingLibraryError
from fegear.engine.processes import end_tracker, loading
from fegear.window.access import Doorkeeper
from fegear.window.computing import Computing

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator
    from pathlib import Path

HOST = "127.0.0.1"
#: What the web server's library imports for clients that this server has none of.
_CLIENTS = ("aiohttp", "requests")
#: What `fegear open` needs beside fegear.
EXTRA = (
    "fegear open needs NiceGUI; in a copy of the source run ./open.sh, which installs it, "
    "elsewhere: pip install 'fegear[workbench]'"
)


def free_port(wanted: int | None) -> int:
    """A port that nobody listens on: the wanted one, or any.

    Raises
    ------
    InputError
        If the wanted one is taken or is none.
    """
    with socket.socket(socket.AF_INET, socket.SOCK_STREAM) as probe:
        probe.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            probe.bind((HOST, wanted or 0))
        except (OSError, OverflowError) as error:
            raise InputError(
                "--port", wanted, f"cannot be listened on ({error})", "leave it out to have a free one chosen"
            ) from None
        return int(probe.getsockname()[1])


@contextlib.contextmanager
def _without_clients() -> Iterator[None]:
    """Import without libraries that ask other servers for something: optional, and a third of the time."""
    absent = [name for name in _CLIENTS if name not in sys.modules]
    sys.modules.update(dict.fromkeys(absent))  # type: ignore[arg-type]
    try:
        yield
    finally:
        for name in absent:
            if sys.modules.get(name) is None:
                sys.modules.pop(name, None)


def _end_with_the_terminal() -> None:
    """Take a terminal that is closed for a request to end, unless it has been said not to matter (`nohup`).

    The web server knows that request, and lets pages and computing process end in order.
    """
    hang_up = getattr(signal, "SIGHUP", None)
    if hang_up is not None and signal.getsignal(hang_up) != signal.SIG_IGN:
        signal.signal(hang_up, lambda *_: signal.raise_signal(signal.SIGTERM))


def serve(case: Path | None, port: int | None, *, browser: bool, say: Callable[[str], None]) -> None:
    """Serve the page until the process is asked to end.

    Parameters
    ----------
    case : Path, optional
        The case to begin with; without one the page offers templates.
    port : int, optional
    browser : bool
        Whether to open the page.
    say : callable
        Receives the address.

    Raises
    ------
    InputError
        If the port cannot be listened on, or the case cannot be read.
    MissingLibraryError
        If NiceGUI is not installed.
    """
    port = free_port(port)
    computing = Computing()  # it loads what computes while this process loads what serves, which takes as long
    try:
        _serve(case, port, computing, browser=browser, say=say)
    finally:
        computing.close()
        end_tracker()


def _serve(case: Path | None, port: int, computing: Computing, *, browser: bool, say: Callable[[str], None]) -> None:
    with loading():
        from fegear.window.bench import Bench

        bench = Bench(case, computing)
        with _without_clients():
            try:
                import nicegui
            except ImportError:
                raise MissingLibraryError(EXTRA) from None
        from nicegui import ui

        from fegear.window.page import show

    secret = secrets.token_urlsafe(24)
    address = f"http://{HOST}:{port}/?key={secret}"

    def opened() -> None:
        bench.begin()
        say(f"Open {address}")
        say("It ends with Ctrl-C; what is not saved is kept for the next time.")
        if browser:
            threading.Thread(target=webbrowser.open, args=(address,), daemon=True).start()

    _end_with_the_terminal()
    nicegui.app.on_startup(opened)
    nicegui.app.on_shutdown(computing.close)
    nicegui.app.add_middleware(Doorkeeper, port=port, secret=secret)
    ui.run(
        lambda: show(bench), host=HOST, port=port, title="fegear", language="en-US", dark=None, reload=False,
        show=False, show_welcome_message=False, favicon="data:,", reconnect_timeout=30.0, tailwind=False,
        gzip_middleware_factory=None, ws_per_message_deflate=False,  # nothing is far away
        message_history_length=100,  # each may be a figure of a hundred kilobytes
    )  # fmt: skip
