"""Waiting for a cluster: how long without workers, whose code; with a client and a clock that are made up."""

import itertools
from types import SimpleNamespace

import pytest

from fegear.base.errors import InputError, MissingLibraryError
from fegear.engine import cluster


@pytest.fixture
def waiting(monkeypatch):
    """Batches as they come and whether somebody works; a second passes at each look."""

    def prepare(batches, workers):
        left, naps = list(batches), []
        coming = SimpleNamespace(count=lambda: len(left), next_batch=lambda block: left.pop(0))
        monkeypatch.setattr("dask.distributed.as_completed", lambda futures: coming)
        clock = itertools.count(100.0)
        monkeypatch.setattr(cluster.time, "monotonic", lambda: next(clock))
        monkeypatch.setattr(cluster.time, "sleep", naps.append)
        present = iter(workers)
        client = SimpleNamespace(scheduler_info=lambda: {"workers": next(present)})
        return cluster._finished(client, [], "tcp://there"), naps

    return prepare


def test_a_cluster_may_be_without_workers_for_a_minute(waiting):
    finished, naps = waiting([[]] * 60 + [["a"]], [{}] * 60)
    assert list(finished) == ["a"]
    assert naps == [0.02] * 60
    finished, _ = waiting([[]] * 61 + [["a"]], [{}] * 61)
    with pytest.raises(InputError, match="has lost all its workers"):
        list(finished)


def test_work_that_comes_and_workers_that_are_there_begin_the_minute_anew(waiting):
    finished, _ = waiting([[]] * 40 + [["a"]] + [[]] * 40 + [["b", "c"]], [{}] * 80)
    assert list(finished) == ["a", "b", "c"]
    finished, naps = waiting([[]] * 50 + [[]] + [[]] * 50 + [["a"]], [{}] * 50 + [{"w": 1}] + [{}] * 50)
    assert list(finished) == ["a"]
    assert len(naps) == 101  # no nap behind what has come


def client(**more):
    ours = cluster.made_by()
    return SimpleNamespace(**{
        "wait_for_workers": lambda count, timeout: None,
        "run_on_scheduler": lambda find, name: "spec",
        "run": lambda function, *given, on_error=None: {"w1": "spec"} if given else {"w1": dict(ours)},
    } | more)  # fmt: skip


def test_scheduler_and_workers_must_have_fegear_of_the_same_code():
    cluster._check_workers(client(), "tcp://there")
    with pytest.raises(MissingLibraryError, match="not installed on scheduler;"):
        cluster._check_workers(client(run_on_scheduler=lambda find, name: None), "tcp://there")
    with pytest.raises(MissingLibraryError, match="not installed on w1;"):
        cluster._check_workers(client(run=lambda *given, **how: {"w1": None}), "tcp://there")

    def other(function, *given, on_error=None):
        return {"w1": "spec", "w2": "spec"} if given else {"w1": dict(cluster.made_by()), "w2": OSError("old")}

    with pytest.raises(InputError, match=r"worker w2 has .*of an older release"):
        cluster._check_workers(client(run=other), "tcp://there")

    def none(count, timeout):
        assert (count, timeout) == (1, 15.0)
        raise TimeoutError

    with pytest.raises(InputError, match="has no workers"):
        cluster._check_workers(client(wait_for_workers=none), "tcp://there")


@pytest.fixture
def computed(monkeypatch):
    """What comes back of points by what becomes of each."""

    def run(outcomes):
        class Client:
            def __enter__(self):
                return self

            def __exit__(self, *given):
                return False

            def as_current(self):
                return self

            def submit(self, job, point, *, pure):
                assert (job, pure) == ("job", False)
                future = type("Future", (), {})()
                future.result = lambda: result(point)
                return future

        def result(point):
            if isinstance(outcomes[point], Exception):
                raise outcomes[point]
            return outcomes[point]

        monkeypatch.setattr(cluster, "_connected", lambda address: Client())
        monkeypatch.setattr(cluster, "_check_workers", lambda client, address: None)
        monkeypatch.setattr(cluster, "_finished", lambda client, futures, address: reversed(futures))
        return list(cluster._computed("job", {7: "a", 9: "b"}, "tcp://there"))

    return run


def test_points_come_back_under_their_numbers_and_those_of_a_killed_worker_are_tried_again_by_the_next_sweep(computed):
    from dask.distributed import CancelledError, KilledWorker

    assert computed({"a": "first", "b": "second"}) == [(9, "second"), (7, "first")]
    (number, reply), other = computed({"a": "first", "b": KilledWorker("b", SimpleNamespace(address="w1"), 3)})
    assert (number, other) == (9, (7, "first"))
    assert not reply.lasting
    with pytest.raises(
        InputError, match=r"tcp://there.*is no longer available; start it again; finished points are kept"
    ):
        computed({"a": "first", "b": CancelledError("b")})
    with pytest.raises(MissingLibraryError, match=r"the workers of tcp://there cannot import fegear \(no module\)"):
        computed({"a": "first", "b": ImportError("no module")})
