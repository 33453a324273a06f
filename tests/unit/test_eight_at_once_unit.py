"""Eight at once, threads or processes, have the numbers of one gear after the other: plane ones to the last bit."""

import math
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


def in_a_ring(teeth):
    """A planet of its own in a ring, and the shaft that carries it with another gear."""
    gear = {"module": "3 mm", "face_width": "10 mm"}
    ring = {"internal": True, "teeth": 90 + teeth, "rim_thickness": "12 mm", "cutter": {"teeth": 25}} | gear
    helical = {"teeth": teeth, "normal_module": "3 mm", "helix_angle": "10 deg", "face_width": "10 mm"}
    ball = {"kind": "ball", "count": 9, "diameter": "12.7 mm", "pitch_diameter": "65 mm"}
    return {
        "results": ["transmission-error", "shaft-deflection"],
        "gear": {
            "planet": gear | {"teeth": teeth}, "ring": ring,
            "a": helical | {"hand": "right"}, "b": helical | {"hand": "left"},
        },
        "pair": {
            "I": {"driver": "planet", "driven": "ring", "load": "2 kN"},
            "II": {"driver": "a", "driven": "b", "torque": "50 N*m"},
        },
        "shaft": {
            name: {
                "axis": [f"{at!r} m", "0 mm"], "sections": [{"length": "80 mm", "outer": "20 mm"}], "coupling": "0 mm",
                "gears": [{"gear": name, "at": "30 mm"}],
                "bearings": [{"bearing": "ball", "at": "5 mm"}, {"bearing": "fixed", "at": "75 mm"}],
            } for name, at in (("a", 0.0), ("b", teeth * 3e-3 / math.cos(math.radians(10.0))))
        },
        "bearing": {"ball": {"elements": ball}, "fixed": {"radial": "200 N/um", "fixed": True}},
        "accuracy": {"tolerance": 3e-2},
    }  # fmt: skip


TEETH = (18, 21, 24, 28, 33, 39, 47, 60)


def numbers(results):
    """Every number but the times."""
    found = {
        f"{t.name}.{c.name}": np.asarray(c.si) for t in results.tables for c in t.columns if "seconds" not in c.name
    }
    return found | {v.name: np.array([v.si]) for v in results.values}


def solved(made):
    return numbers(fegear.run(made, progress=False, cache=SolutionCache()))


@pytest.mark.long
@pytest.mark.parametrize("make", [document, in_a_ring])
def test_eight_threads_and_eight_processes_have_the_numbers_of_one_after_the_other(make):
    made = [make(teeth) for teeth in TEETH]
    wanted = [solved(one) for one in made]
    assert len({one["I.te_mean"][0] for one in wanted}) == len(TEETH)
    with ThreadPoolExecutor(8) as threads:
        threaded = list(threads.map(solved, made))
    with ProcessPoolExecutor(8, mp_context=get_context("spawn")) as processes:
        jobs = [processes.submit(fegear.run, one, progress=False) for one in made]
        apart = [numbers(job.result()) for job in jobs]
    for found in (threaded, apart):
        for one, other in zip(found, wanted, strict=True):
            assert one.keys() == other.keys()
            for name, value in other.items():
                if make is document or value.dtype.kind != "f":
                    assert np.array_equal(one[name], value, equal_nan=value.dtype.kind == "f"), name
                else:  # with a width the last bit hangs on where an array lies, in one thread too
                    largest = np.abs(value).max(initial=0.0, where=np.isfinite(value))
                    np.testing.assert_allclose(one[name], value, rtol=0.0, atol=1e-12 * largest + 1e-18, err_msg=name)
