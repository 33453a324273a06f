"""The server of the page: on this machine alone, for one case at a time, until it is asked to end."""

from __future__ import annotations

import asyncio
import contextlib
import signal
import socket
import sys
import threading
import webbrowser
from typing import TYPE_CHECKING

from fegear.base.errors import InputError, MissingLibraryError
from fegear.engine.processes import end_tracker, loading
from fegear.window.access import Doorkeeper, Keys, file_leading_to
from fegear.window.computing import Computing
from fegear.window.reach import Reach

if TYPE_CHECKING:
    from collections.abc import Callable, Iterator, Sequence
    from pathlib import Path

HOST = "127.0.0.1"
#: What the web server's library imports for clients that this server has none of.
_CLIENTS = ("aiohttp", "requests")
#: How often the page is tried before its address is printed, and how long is waited between [s].
_TRIES, _PAUSE = 500, 0.01
#: A browser that has not come to the page after this time may not be able to read what leads there [s].
_ARRIVAL = 15.0
#: What `fegear open` needs beside fegear.
EXTRA = "fegear open requires NiceGUI: run ./open.sh in the source folder, or pip install 'fegear[workbench]'"


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
            raise InputError("--port", wanted, f"is not available ({error})", "remove it to use a free port") from None
        return int(probe.getsockname()[1])


@contextlib.contextmanager
def _without_clients() -> Iterator[None]:
    """Import without libraries that ask other servers for something: optional, and a third of the time."""
    absent = [name for name in _CLIENTS if name not in sys.modules]
    sys.modules.update(dict.fromkeys(absent))  # type: ignore[arg-type]  # None forbids an import
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


def serve(
    case: Path | None,
    port: int | None,
    *,
    browser: bool,
    say: Callable[[str], None],
    folders: Sequence[Path] = (),
    look: bool = False,
) -> None:
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
    folders : sequence of Path
        Whose files the page may open and write, besides the working folder and that of the case.
    look : bool
        Whether an address is printed by which others look on and change nothing.

    Raises
    ------
    InputError
        If the port cannot be listened on, or the case cannot be read.
    MissingLibraryError
        If NiceGUI is not installed.
    """
    port = free_port(port)
    reach = Reach.of(case, folders)
    computing = Computing()  # it loads what computes while this process loads what serves, which takes as long
    try:
        _serve(case, port, computing, reach, browser=browser, say=say, look=look)
    finally:
        computing.close()
        end_tracker()


def _serve(
    case: Path | None,
    port: int,
    computing: Computing,
    reach: Reach,
    *,
    browser: bool,
    say: Callable[[str], None],
    look: bool,
) -> None:
    with loading():
        from fegear.window.bench import Bench

        bench = Bench(case, computing, reach)
        with _without_clients():
            try:
                import nicegui
            except ImportError:
                raise MissingLibraryError(EXTRA) from None
        from nicegui import ui

        from fegear.window.page import show

    door = _Door(port, computing.folder, say, look=look)

    def opened() -> None:
        bench.begin()
        door.begin(browser=browser)

    _end_with_the_terminal()
    nicegui.app.on_startup(opened)
    nicegui.app.on_shutdown(computing.close)
    nicegui.app.add_middleware(Doorkeeper, port=port, keys=door.keys)
    ui.run(
        lambda: show(bench), host=HOST, port=port, title="fegear", language="en-US", dark=None, reload=False,
        show=False, show_welcome_message=False, favicon="data:,", reconnect_timeout=30.0, tailwind=False,
        gzip_middleware_factory=None, ws_per_message_deflate=False,  # nothing is far away
        message_history_length=100,  # each may be a figure of a hundred kilobytes
        proxy_headers=False,  # who asks is who has connected, whatever a request says of itself
    )  # fmt: skip


class _Door:
    """Addresses of the page: one that is printed, one that leads a browser at the start, one of those who look on.

    Parameters
    ----------
    port : int
    folder : Path
        Of this process, which no other account can look into.
    say : callable
    look : bool
        Whether the address of those who look on is printed.
    """

    def __init__(self, port: int, folder: Path, say: Callable[[str], None], *, look: bool = False) -> None:
        self.keys = Keys()
        self._port, self._folder, self._say, self._look = port, folder, say, look
        self._opening: asyncio.Task[None] | None = None

    def begin(self, *, browser: bool) -> None:
        """Print an address as soon as it answers, and lead a browser to another; called within the loop."""
        self._opening = asyncio.get_running_loop().create_task(self._open(browser=browser))

    def _address(self, used: Callable[[], object], *, again: bool = False) -> str:
        return f"http://{HOST}:{self._port}/?key={self.keys.another(used, again=again)}"

    async def _open(self, *, browser: bool) -> None:
        for _ in range(_TRIES):
            with contextlib.suppress(OSError):
                _, connection = await asyncio.open_connection(HOST, self._port)
                connection.close()
                break
            await asyncio.sleep(_PAUSE)
        self._say(f"Open {self._address(self._print_another, again=True)}")
        if self._look:
            self._say(f"Read-only, as often as it is used: http://{HOST}:{self._port}/?look={self.keys.look}")
        self._say("Stop with Ctrl-C; unsaved changes are kept for the next start.")
        if browser:
            await self._lead()

    def _print_another(self) -> None:
        with contextlib.suppress(OSError):  # of a terminal that is closed
            self._say(
                f"This address has been used; for another browser open {self._address(self._print_another, again=True)}"
            )

    async def _lead(self) -> None:
        """Open a browser by a file: what stands on its command line is read by every account of this machine."""
        arrived = asyncio.Event()
        try:
            place = file_leading_to(self._address(arrived.set), self._folder)
        except OSError:
            self._say("Browser not opened: redirect file could not be written.")
            return
        threading.Thread(target=webbrowser.open, args=(place.as_uri(),), daemon=True).start()
        try:
            await asyncio.wait_for(arrived.wait(), _ARRIVAL)
        except TimeoutError:
            self._say("No page opened yet. A sandboxed browser (snap) cannot read the redirect file;")
            self._say("copy the address above into the browser.")
            await arrived.wait()
        place.unlink(missing_ok=True)
