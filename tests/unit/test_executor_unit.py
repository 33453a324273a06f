"""Points are computed once, in parallel, whoever computes them; what goes wrong at one is that one's value."""

from __future__ import annotations

import contextlib
import functools
import importlib
import math
import operator
import os
import re
import signal
import socket
import subprocess
import sys
import threading
import time
from pathlib import Path

import pytest
from distributed.comm import CommClosedError

import fegear
from fegear.base.code_version import made_by
from fegear.base.errors import FegearError, InputError
from fegear.base.solution_cache import SolutionCache
from fegear.base.store import Store
from fegear.engine.executor import Executor, count_kept, map_points
from fegear.engine.processes import Failure
from fegear.engine.run import NOTHING_FOR_A_CLUSTER
from fegear.results.catalogue import STAGES

ENVIRONMENT = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}


@pytest.mark.dear
def test_results_come_in_order_and_failures_are_values(tmp_path):
    told = []
    store = Store(tmp_path)
    points = [4.0, -1.0, 2.0, 4.0]
    found = map_points(math.sqrt, points, cache=SolutionCache(store), progress=told.append)
    assert found[0] == found[3] == 2.0
    assert found[2] == math.sqrt(2.0)
    assert isinstance(found[1], Failure)
    assert found[1].kind == "ValueError"
    assert told[0] == 0.0
    assert told[-1] == 1.0
    assert told == sorted(told)
    # An unforeseen error is no lasting result; the others are.
    assert count_kept(math.sqrt, points, SolutionCache(store)) == 3
    assert map_points(math.sqrt, points, Executor(here=True), SolutionCache(store)) == found


@pytest.mark.dear
def test_a_process_that_dies_takes_no_other_point_with_it():
    found = map_points(functools.partial(map, os._exit), [7], Executor(workers=2))
    assert isinstance(found[0], Failure)  # a map is no plain data, and nothing died yet
    died = map_points(os._exit, [3, 4], Executor(workers=2))
    assert all(isinstance(one, Failure) and "the process terminated while computing this" in one.reason for one in died)


def test_functions_without_a_name_are_refused():
    with pytest.raises(ValueError, match="is not a module-level function and cannot be imported by other processes"):
        map_points(lambda x: x, [1])


def test_workers_use_one_thread_each_and_leave_the_environment_alone(monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    names = ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"]
    assert map_points(os.getenv, names, Executor(workers=1)) == ("1", "1")
    assert os.environ["OMP_NUM_THREADS"] == "7"


def test_a_store_that_cannot_be_written_to_is_reported(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="is not writable \\("):
        map_points(math.sqrt, [1.0], cache=SolutionCache(Store(tmp_path / "file")))


def test_a_cluster_gives_the_same(scheduler, tmp_path):
    points = [2.0, -1.0, 3.0]
    assert map_points(math.sqrt, points, Executor(scheduler)) == map_points(math.sqrt, points, Executor(here=True))
    cache = SolutionCache(Store(tmp_path))
    assert map_points(operator.neg, [1, 2.5], Executor(scheduler), cache) == (-1, -2.5)
    assert count_kept(operator.neg, [1, 2.5], cache) == 2


@pytest.mark.parametrize(
    ("here", "sentence"),
    [
        ({"numpy": "1.99.0"}, r"worker tcp://\S+ has numpy [\d.]+ where this program has numpy 1\.99\.0; start its"),
        (
            {"fegear": "0.2.0 (code 12345678)"},
            r"worker tcp://\S+ has fegear \S+ \(code (?!12345678)\w{8}\) where this program has fegear \S+ \(code 1",
        ),
    ],
)
def test_a_worker_of_other_code_or_libraries_is_refused_with_both_named(
    scheduler, monkeypatch, tmp_path, here, sentence
):
    monkeypatch.setattr("fegear.engine.cluster.made_by", lambda: {**made_by(), **here})
    cache = SolutionCache(Store(tmp_path))
    with pytest.raises(InputError, match=sentence):
        map_points(operator.neg, [1, 2.5], Executor(scheduler), cache)
    assert count_kept(operator.neg, [1, 2.5], cache) == 0


def no_such_module(name: str) -> None:
    raise ModuleNotFoundError(name)


def test_a_worker_too_old_to_say_what_it_is_is_refused(scheduler, monkeypatch):
    monkeypatch.setattr("fegear.engine.cluster.import_module", no_such_module)
    with pytest.raises(InputError, match=r"has fegear of an older release where this program has fegear 0\.\d"):
        map_points(math.sqrt, [1.0], Executor(scheduler))


def test_a_worker_that_joins_later_is_refused_as_well(scheduler, monkeypatch):
    monkeypatch.setattr("fegear.engine.cluster._check_workers", lambda *_: None)
    monkeypatch.setattr("fegear.engine.processes.made_by", lambda: {**made_by(), "scipy": "1.0.0"})
    with pytest.raises(
        FegearError, match=r"^A worker has scipy [\d.]+ where this program has scipy 1\.0\.0; restart it"
    ):
        map_points(math.sqrt, [1.0], Executor(scheduler))


def test_a_process_that_finds_other_code_is_refused(monkeypatch):
    """The files may have changed since the program that wants the points has begun."""
    monkeypatch.setattr("fegear.engine.processes.made_by", lambda: {**made_by(), "fegear": "0.2.0 (code 12345678)"})
    with pytest.raises(
        FegearError, match=r"has fegear 0\S+ \(code \w{8}\) where this program has fegear 0\.2\.0 \(code 1"
    ):
        map_points(math.sqrt, [1.0], Executor(workers=1))


def test_points_of_a_users_function_are_computed_again_when_its_file_has_changed(tmp_path, monkeypatch):
    monkeypatch.syspath_prepend(tmp_path)
    cache, found = SolutionCache(Store(tmp_path / "kept")), []
    for factor in (2, 3):
        (tmp_path / "users_own.py").write_text(f"def scaled(x):\n    return {factor} * x\n")
        sys.modules.pop("users_own", None)
        importlib.invalidate_caches()
        monkeypatch.setattr(sys, "dont_write_bytecode", True)
        found.append(map_points(importlib.import_module("users_own").scaled, [1.0], Executor(here=True), cache))
    assert found == [(2.0,), (3.0,)]


def test_a_scheduler_that_does_not_answer_is_refused(monkeypatch):
    monkeypatch.setattr("fegear.engine.cluster._PATIENCE", 0.5)
    with pytest.raises(InputError, match=re.escape('--scheduler = "tcp://127.0.0.1:9": does not answer')):
        map_points(math.sqrt, [1.0], Executor("tcp://127.0.0.1:9"))


@pytest.mark.dear
def test_an_address_of_no_scheduler_is_one_sentence():
    """In a process of their own: a client that fails half-made complains when the interpreter ends."""
    addresses = ["tls://127.0.0.1:9", "foo", "tcp://[::1", "http://127.0.0.1:9"]
    program = (
        "import math, sys\n"
        "from fegear.engine.executor import Executor, map_points\n"
        "from fegear.base.errors import InputError\n"
        "for address in sys.argv[1:]:\n"
        "    try:\n"
        "        map_points(math.sqrt, [1.0], Executor(address))\n"
        "    except InputError as refusal:\n"
        "        print(refusal)\n"
    )
    done = subprocess.run(
        [sys.executable, "-c", program, *addresses], capture_output=True, text=True, env=ENVIRONMENT, check=False
    )
    told = done.stdout.splitlines()
    assert [line.partition(" (")[0] for line in told] == [f'--scheduler = "{a}": does not answer' for a in addresses]
    assert done.stderr == ""


def test_an_empty_address_is_no_wish_to_compute_here():
    for address in ("", " "):
        with pytest.raises(InputError, match="--scheduler"):
            Executor(address)


def test_an_address_that_no_result_of_a_run_can_use_is_no_use_said_aloud():
    case = {"gear": {"a": {"teeth": 20, "module": "2 mm"}}, "results": ["geometry"]}
    assert NOTHING_FOR_A_CLUSTER in fegear.run(case, scheduler="tcp://127.0.0.1:9").remarks
    assert NOTHING_FOR_A_CLUSTER not in fegear.run(case).remarks


def test_results_that_have_points_for_a_cluster_are_marked_as_such():
    folder = Path(fegear.__file__).parent / "results"
    called = {"by_fe": "sizing", "by_atlas": "sizing"}  # from which module, where another has the stage
    found = (path.stem for path in folder.rglob("*.py") if "map_points(" in path.read_text("utf-8"))
    spreading = {called.get(stem, stem) for stem in found}
    assert {stage.compute.__module__.rpartition(".")[2] for stage in STAGES if stage.in_points} == spreading


def test_a_listener_that_says_nothing_is_no_scheduler(monkeypatch):
    monkeypatch.setattr("fegear.engine.cluster._PATIENCE", 0.5)
    monkeypatch.setattr("fegear.engine.cluster._GRACE", 0.1)
    with socket.create_server(("127.0.0.1", 0)) as silent:
        address = f"tcp://127.0.0.1:{silent.getsockname()[1]}"
        with pytest.raises(InputError, match="does not answer"):
            map_points(math.sqrt, [1.0], Executor(address))


@pytest.mark.dear
@pytest.mark.parametrize("lost", [pytest.param("workers", marks=pytest.mark.long), "scheduler"])
def test_a_cluster_that_is_lost_ends_the_wait(monkeypatch, capfd, lost):
    program = (
        "from dask.distributed import LocalCluster\n"
        "import sys\n"
        "if __name__ == '__main__':\n"
        "    with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as cluster:\n"
        "        print(cluster.scheduler_address, flush=True)\n"
        "        sys.stdin.readline()\n"
        "        cluster.scale(0)\n"
        "        sys.stdin.readline()\n"
    )
    monkeypatch.setattr("fegear.engine.cluster._WITHOUT_WORKERS", 1.0)
    cluster = subprocess.Popen(
        [sys.executable, "-c", program], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL,
        text=True, env=ENVIRONMENT, start_new_session=True,
    )  # fmt: skip

    def lose() -> None:
        if lost == "scheduler":
            os.killpg(cluster.pid, signal.SIGKILL)
        else:
            cluster.stdin.write("\n")
            cluster.stdin.flush()

    try:
        address = cluster.stdout.readline().strip()
        threading.Timer(1.5, lose).start()
        with pytest.raises(InputError, match=r"is no longer available|has lost all its workers"):
            map_points(time.sleep, [600.0], Executor(address))
        assert capfd.readouterr().err == ""
    finally:
        with contextlib.suppress(ProcessLookupError):
            os.killpg(cluster.pid, signal.SIGKILL)
        cluster.wait()


@pytest.mark.parametrize("at", ["wait_for_workers", "run"])
def test_a_scheduler_lost_while_its_workers_are_looked_at_is_one_sentence(scheduler, monkeypatch, at):
    def closed(*_arguments, **_options):
        raise CommClosedError("in <TCP (closed)>: Stream is closed")

    monkeypatch.setattr(f"distributed.Client.{at}", closed)
    with pytest.raises(InputError, match="is no longer available"):
        map_points(math.sqrt, [1.0], Executor(scheduler))


def refused_for_want_of(error: type[Exception], point: float) -> float:
    """Fail as a stage does whose library or disk has failed it."""
    raise FegearError(f"could not solve {point}: the disk is full") from error("the disk is full")


@pytest.mark.parametrize(("error", "kept"), [(OSError, 0), (MemoryError, 0), (Exception, 0), (ValueError, 1)])
def test_failures_of_the_circumstances_are_not_kept(tmp_path, monkeypatch, error, kept):
    monkeypatch.setattr("fegear.engine.executor.function_name", lambda function: "refused")
    cache, function = SolutionCache(Store(tmp_path)), functools.partial(refused_for_want_of, error)
    (failure,) = map_points(function, [2.0], Executor(here=True), cache)
    assert failure == Failure("FegearError", "could not solve 2.0: the disk is full")
    assert count_kept(function, [2.0], cache) == kept


@pytest.mark.dear
def test_nobody_waits_for_what_is_under_way_when_a_run_is_stopped(tmp_path):
    program = (
        "import signal\n"
        "from fegear.engine.executor import Executor, map_points\n"
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"  # a shell's background job ignores Ctrl-C
        "work = 'import pathlib, time; pathlib.Path({!r}).touch(); time.sleep(600)'\n"
        "if __name__ == '__main__':\n"
        "    map_points(exec, [work.format(name) for name in ('first', 'second')], Executor(workers=2))\n"
    )
    run = subprocess.Popen([sys.executable, "-c", program], cwd=tmp_path, env=ENVIRONMENT, stderr=subprocess.DEVNULL)
    for _ in range(1200):
        if len(list(tmp_path.iterdir())) == 2:
            break
        time.sleep(0.05)
    run.send_signal(signal.SIGINT)
    assert run.wait(timeout=60) != 0


def test_a_folder_is_removed_when_its_process_has_ended_and_not_before(tmp_path):
    program = (
        "import os, sys, time\n"
        "from fegear.engine.processes import _remove_after_the_end\n"
        "own = os.getpid()\n"
        "_remove_after_the_end(sys.argv[1])\n"
        "if os.getpid() != own:\n"
        "    os._exit(0)\n"
        "time.sleep(0.05)\n"
        "print(os.path.isdir(sys.argv[1]))\n"
    )
    (scratch := tmp_path / "scratch").mkdir()
    command = [sys.executable, "-c", program, str(scratch)]
    ran = subprocess.run(command, env=ENVIRONMENT, capture_output=True, text=True, timeout=60, check=True)
    assert ran.stdout == "True\n"  # read to its end, which is that of the process that removes
    assert not scratch.exists()


@pytest.mark.dear
def test_no_worker_outlives_a_killed_parent(tmp_path):
    program = (
        "from fegear.engine.executor import Executor, map_points\n"
        "work = 'import pathlib, time; pathlib.Path({!r}).touch(); time.sleep(600)'\n"
        "if __name__ == '__main__':\n"
        "    map_points(exec, [work.format(name) for name in ('first', 'second')], Executor(workers=2))\n"
    )
    group = subprocess.Popen([sys.executable, "-c", program], cwd=tmp_path, env=ENVIRONMENT, start_new_session=True)

    def wait_until(holds) -> bool:
        for _ in range(600):
            if holds():
                return True
            time.sleep(0.1)
        return False

    def nobody_is_left() -> bool:
        try:
            os.killpg(group.pid, 0)
        except ProcessLookupError:
            return True
        return False

    try:
        assert wait_until(lambda: len(list(tmp_path.iterdir())) == 2), "both workers are at it"
        assert not nobody_is_left()
        group.kill()
        group.wait()
        assert wait_until(nobody_is_left)
    finally:
        if not nobody_is_left():
            os.killpg(group.pid, signal.SIGKILL)


@pytest.mark.dear
@pytest.mark.parametrize("own", [False, True])
def test_a_script_is_run_again_only_for_its_own_functions(own, tmp_path):
    """Spawned processes import the file of ``__main__``: a script without a guard would start itself anew in each."""
    (tmp_path / "script.py").write_text(
        "import math\n"
        "from fegear.engine.executor import Executor, map_points\n"
        "def half(x):\n"
        "    return 0.5 * x\n"
        + ("if __name__ == '__main__':\n" if own else "open('runs', 'a').write('x')\nif True:\n")
        + f"    print(map_points({'half' if own else 'math.sqrt'}, [4.0, 9.0, 16.0], Executor(workers=2)))\n"
    )
    ran = subprocess.run(
        [sys.executable, "script.py"], cwd=tmp_path, env=ENVIRONMENT, capture_output=True, text=True, check=False
    )
    assert ran.returncode == 0, ran.stderr
    assert ran.stdout.strip() == ("(2.0, 4.5, 8.0)" if own else "(2.0, 3.0, 4.0)")
    assert own or (tmp_path / "runs").read_text() == "x"
