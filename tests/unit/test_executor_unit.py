"""Points are computed once, in parallel, whoever computes them; what goes wrong at one is that one's value."""

from __future__ import annotations

import functools
import math
import operator
import os
import re
import signal
import subprocess
import sys
import time

import pytest

from fegear.engine.executor import Executor, count_kept, map_points
from fegear.engine.point_job import Failure
from fegear.errors import InputError
from fegear.solution_cache import SolutionCache
from fegear.store import Store

ENVIRONMENT = {**os.environ, "PYTHONPATH": os.pathsep.join(p for p in sys.path if p)}


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
    assert map_points(math.sqrt, points, cache=SolutionCache(store)) == found


def test_a_process_that_dies_takes_no_other_point_with_it():
    found = map_points(functools.partial(map, os._exit), [7], Executor(workers=2))
    assert isinstance(found[0], Failure)  # a map is no plain data, and nothing died yet
    died = map_points(os._exit, [3, 4], Executor(workers=2))
    assert all(isinstance(one, Failure) and "process died" in one.reason for one in died)


def test_functions_without_a_name_are_refused():
    with pytest.raises(ValueError, match="function of a module"):
        map_points(lambda x: x, [1])


def test_workers_use_one_thread_each_and_leave_the_environment_alone(monkeypatch):
    monkeypatch.setenv("OMP_NUM_THREADS", "7")
    assert map_points(os.getenv, ["OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS"]) == ("1", "1")
    assert os.environ["OMP_NUM_THREADS"] == "7"


def test_a_store_that_cannot_be_written_to_is_reported(tmp_path):
    (tmp_path / "file").write_text("")
    with pytest.raises(InputError, match="cannot be written to"):
        map_points(math.sqrt, [1.0], cache=SolutionCache(Store(tmp_path / "file")))


def test_a_cluster_gives_the_same(scheduler, tmp_path):
    points = [2.0, -1.0, 3.0]
    assert map_points(math.sqrt, points, Executor(scheduler)) == map_points(math.sqrt, points)
    cache = SolutionCache(Store(tmp_path))
    assert map_points(operator.neg, [1, 2.5], Executor(scheduler), cache) == (-1, -2.5)
    assert count_kept(operator.neg, [1, 2.5], cache) == 2


def test_a_scheduler_that_does_not_answer_is_refused(monkeypatch):
    monkeypatch.setattr("fegear.engine.cluster._PATIENCE", 0.5)
    with pytest.raises(InputError, match=re.escape("--scheduler = tcp://127.0.0.1:9: does not answer")):
        map_points(math.sqrt, [1.0], Executor("tcp://127.0.0.1:9"))


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
