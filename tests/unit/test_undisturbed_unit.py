"""Requests to stop wait while something is begun on the disk, and beside imports."""

import signal
import subprocess
import sys
import threading
from types import SimpleNamespace

import pytest

from fegear.base import interrupts
from fegear.base.interrupts import between_imports, heed_ctrl_c
from fegear.output.report.page import begun
from fegear.output.undisturbed import undisturbed


@pytest.fixture
def heard():
    """What is heard of a signal that nobody else uses here."""
    calls = []
    before = {n: signal.getsignal(n) for n in (signal.SIGTERM, signal.SIGHUP)}
    for number in before:
        signal.signal(number, lambda n, _: calls.append(n))
    yield calls
    for number, handler in before.items():
        signal.signal(number, handler)


def test_a_request_to_stop_acts_once_when_the_block_is_over(heard):
    with undisturbed():
        signal.raise_signal(signal.SIGTERM)
        signal.raise_signal(signal.SIGHUP)
        assert heard == []
    assert heard == [signal.SIGTERM]  # the first of them: one stop is enough
    signal.raise_signal(signal.SIGHUP)
    assert heard == [signal.SIGTERM, signal.SIGHUP]  # what was there before hears again


def test_at_the_end_of_all_work_there_is_nothing_left_to_stop(heard):
    with undisturbed(at_the_end=True):
        signal.raise_signal(signal.SIGTERM)
    assert heard == []


def test_what_fails_inside_leaves_signals_as_they_were(heard):
    with pytest.raises(OSError, match="full"), undisturbed():
        raise OSError("full")
    signal.raise_signal(signal.SIGTERM)
    assert heard == [signal.SIGTERM]


def test_other_threads_hold_nothing_back():
    """Only the main thread may set what hears a signal."""
    found = []

    def work():
        try:
            with undisturbed():
                found.append("done")
        except ValueError as error:
            found.append(str(error))

    thread = threading.Thread(target=work)
    thread.start()
    thread.join()
    assert found == ["done"]


def test_a_request_amid_an_import_comes_again_a_little_later(monkeypatch):
    acted, later = [], []
    monkeypatch.setattr(
        interrupts.threading,
        "Timer",
        lambda wait, act, given: later.append((wait, act, given)) or SimpleNamespace(start=int),
    )
    hear = between_imports(lambda number, frame: acted.append((number, frame)))
    amid = SimpleNamespace(f_code=SimpleNamespace(co_filename="<frozen importlib._bootstrap>"))
    hear(2, amid)
    assert acted == []
    assert [(wait, given) for wait, _, given in later] == [(0.02, [2])]
    beside = SimpleNamespace(f_code=SimpleNamespace(co_filename="/somewhere.py"))
    hear(2, beside)
    hear(2, None)
    assert acted == [(2, beside), (2, None)]


@pytest.mark.skipif(not hasattr(signal, "pthread_sigmask"), reason="no signals wait on this system")
@pytest.mark.parametrize("number", [signal.SIGTERM, signal.SIGINT])
def test_a_request_amid_an_import_waits_until_gmsh_has_given_the_handlers_back(number):
    """While gmsh starts they are the system's, which ends the program; the request comes again in that very moment."""
    program = f"""
import signal, time
from types import SimpleNamespace
from fegear.base.interrupts import between_imports, deaf
number, heard = {int(number)}, []
hear = between_imports(lambda n, _: heard.append(n))
signal.signal(number, hear)
hear(number, SimpleNamespace(f_code=SimpleNamespace(co_filename="<frozen importlib._bootstrap>")))
with deaf():
    before = signal.signal(number, signal.SIG_DFL)
    time.sleep(0.2)
    signal.signal(number, before)
print(heard)
"""
    run = subprocess.run([sys.executable, "-c", program], check=False, capture_output=True, text=True, timeout=60)
    assert (run.returncode, run.stdout) == (0, f"[{int(number)}]\n"), run.stderr


def test_work_begun_ahead_is_deaf_from_its_first_moment():
    """A thread that begins to wait only in its own code would hear a request between its start and that."""
    found = begun(lambda: signal.pthread_sigmask(signal.SIG_BLOCK, ())).result(10)
    assert set(interrupts.REQUESTS_TO_STOP) <= found
    assert not set(interrupts.REQUESTS_TO_STOP) & signal.pthread_sigmask(signal.SIG_BLOCK, ())


def test_ctrl_c_is_heard_only_where_it_has_its_usual_meaning():
    before = signal.getsignal(signal.SIGINT)
    try:
        signal.signal(signal.SIGINT, signal.default_int_handler)
        heed_ctrl_c()
        assert signal.getsignal(signal.SIGINT) is not signal.default_int_handler
        hear = signal.getsignal(signal.SIGINT)
        with pytest.raises(KeyboardInterrupt):
            hear(signal.SIGINT, None)
        signal.signal(signal.SIGINT, signal.SIG_IGN)
        heed_ctrl_c()
        assert signal.getsignal(signal.SIGINT) is signal.SIG_IGN
    finally:
        signal.signal(signal.SIGINT, before)
