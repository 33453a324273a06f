"""Eight threads and eight processes on different gears have the numbers of one after the other, to the last bit."""

from concurrent.futures import ProcessPoolExecutor, ThreadPoolExecutor
from multiprocessing import get_context

import numpy as np
import pytest

import fegear
from fegear.base.solution_cache import SolutionCache


def document(teeth):
    """Influence functions, root stress and the transmission error of a pair of its own."""
    gear = {"teeth": teeth, "module": "3 mm", "face_width": "10 mm"}
    return {
        "results": ["stiffness", "root-stress", "transmission-error"],
        "gear": {"a": gear, "b": gear | {"teeth": teeth + 7}},
        "pair": {"I": {"driver": "a", "driven": "b", "load": "2 kN"}},
        "stiffness": {"gear": "a", "positions": 5}, "accuracy": {"tolerance": 1e-2},
    }  # fmt: skip


TEETH = (18, 21, 24, 28, 33, 39, 47, 60)


def numbers(results):
    """Every number but the times."""
    found = {
        f"{t.name}.{c.name}": np.asarray(c.si) for t in results.tables for c in t.columns if "seconds" not in c.name
    }
    return found | {v.name: np.array([v.si]) for v in results.values}


def solved(teeth):
    return numbers(fegear.run(document(teeth), progress=False, cache=SolutionCache()))


@pytest.mark.long
def test_eight_threads_and_eight_processes_have_the_numbers_of_one_after_the_other():
    wanted = [solved(teeth) for teeth in TEETH]
    assert len({one["I.te_mean"][0] for one in wanted}) == len(TEETH)
    with ThreadPoolExecutor(8) as threads:
        threaded = list(threads.map(solved, TEETH))
    with ProcessPoolExecutor(8, mp_context=get_context("spawn")) as processes:
        jobs = [processes.submit(fegear.run, document(teeth), progress=False) for teeth in TEETH]
        apart = [numbers(job.result()) for job in jobs]
    for found in (threaded, apart):
        for one, other in zip(found, wanted, strict=True):
            assert one.keys() == other.keys()
            for name, value in other.items():
                assert np.array_equal(one[name], value, equal_nan=value.dtype.kind == "f"), name
