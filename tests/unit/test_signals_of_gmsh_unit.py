"""Signals while gmsh starts: none is lost, and none ends the process unheard."""

import ctypes
import signal

from fegear.fem.plane import gmsh_session


def test_a_stop_that_comes_while_gmsh_starts_finds_its_handler(monkeypatch):
    """Gmsh gives signals back to the system: for a moment a request to stop ended the process, with nothing cleared."""
    heard = []
    before = signal.signal(signal.SIGTERM, lambda number, _frame: heard.append(number))

    class Gmsh:
        """Does what gmsh does, and is stopped at the worst moment."""

        @staticmethod
        def initialize(*, interruptible):
            ctypes.pythonapi.PyOS_setsig.restype = ctypes.c_void_p
            ctypes.pythonapi.PyOS_setsig(int(signal.SIGTERM), ctypes.c_void_p(0))
            signal.raise_signal(signal.SIGTERM)  # to this thread
            assert heard == []
            assert not interruptible

    try:
        gmsh_session._initialize(Gmsh)
        assert heard == [signal.SIGTERM]
    finally:
        signal.signal(signal.SIGTERM, before)
