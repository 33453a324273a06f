"""Reliefs that a design found, as keys of a case and in a sentence; the design is made up."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.results.relief.relief_data import ReliefData
from fegear.results.relief.relief_in_case import relief_for_case, what_it_leaves

ROLL = np.array([30.0, 10.0, 20.0])
REMOVAL = {"a": np.array([12.0, 0.0, 4.0]), "b": np.array([0.0, 9.0, 3.0])}


def tip(amount, start):
    return SimpleNamespace(amount=amount * 1e-6, start=math.radians(start))


def results(shape="linear", driver=(12.3456, 25.5), driven=(8.0, 31.25), te=None, least_error=0.02):
    ground = {
        "linear": SimpleNamespace(driver=tip(*driver), driven=tip(*driven), candidates=12345, least=1.5e-6,
                                  least_error=least_error * 1.5e-6),
        "parabolic": SimpleNamespace(driver=tip(*driver), driven=tip(*driven), candidates=54321, least=0.0,
                                     least_error=1.0),
    }  # fmt: skip
    te = {"no relief": 5.4321, "designed": 0.001, "linear tip relief": 1.5, "parabolic tip relief": 1.75} | (te or {})
    data = object.__new__(ReliefData)
    object.__setattr__(data, "design", SimpleNamespace(
        best_ground=(shape, ground[shape]), ground=ground, task=SimpleNamespace(load=1234.567),
        te={label: SimpleNamespace(peak_to_peak=one * 1e-6) for label, one in te.items()},
    ))  # fmt: skip
    part = SimpleNamespace(driver="a", driven="b")
    return SimpleNamespace(
        scene=SimpleNamespace(case=SimpleNamespace(pair={"I": part})),
        outcomes={"one": SimpleNamespace(data="of another result"), "two": SimpleNamespace(data=data)},
        tables={f"relief_I_{name}": {"roll_angle": ROLL, "relief": one} for name, one in REMOVAL.items()},
    )


def test_an_exact_relief_is_a_table_of_straight_lines_by_rising_roll_angle():
    found = relief_for_case(results(), "I", "exact")
    for name in ("a", "b"):
        table = found[name]["table"]
        rolls, removals = ([float(one.split()[0]) for one in table[key]] for key in ("roll_angles", "removals"))
        assert len(rolls) == len(removals) > 50
        assert {one.split()[1] for one in table["roll_angles"]} == {"deg"}
        assert {one.split()[1] for one in table["removals"]} == {"um"}
        order = np.argsort(ROLL)
        np.testing.assert_allclose(rolls, np.linspace(10.0, 30.0, len(rolls)), rtol=1e-5)
        np.testing.assert_allclose(removals, np.interp(rolls, ROLL[order], REMOVAL[name][order]), rtol=1e-3, atol=1e-4)


@pytest.mark.parametrize("shape", ["linear", "parabolic"])
def test_a_ground_relief_is_amount_and_start_and_none_where_nothing_is_removed(shape):
    found = relief_for_case(results(shape), "I", "ground")
    more = {} if shape == "linear" else {"shape": "parabolic"}
    assert found["a"] == {"tip": {"amount": "12.35 um", "start_roll_angle": "25.5 deg", **more}}
    assert found["b"] == {"tip": {"amount": "8 um", "start_roll_angle": "31.25 deg", **more}}
    assert relief_for_case(results(shape, driver=(0.004, 20.0)), "I", "ground")["a"] is None
    assert relief_for_case(results(shape, driven=(0.006, 20.0)), "I", "ground")["b"] is not None


def test_what_is_left_is_said_of_the_relief_that_was_taken():
    exact = what_it_leaves(results(), "exact")
    assert exact.endswith("transmission error 0 um peak to peak (5.43 um without relief, at 1234.6 N).")
    assert "error 0.006 um" in what_it_leaves(results(te={"designed": 0.006}), "exact")
    ground = what_it_leaves(results(), "ground")
    assert ground.startswith("Best linear tip relief: transmission error 1.5 um peak to peak (5.43 um without relief")
    assert "; parabolic ones 1.75 um." in ground
    assert "(after a scan of 12,345 reliefs) agree within 2.0 %." in ground
    other = what_it_leaves(results("parabolic"), "ground")
    assert other.startswith("Best parabolic tip relief: transmission error 1.75 um")
    assert "; linear ones 1.5 um." in other
    assert "agree within 0 %" in other
