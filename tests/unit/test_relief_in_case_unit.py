"""Reliefs that a design found, as keys of a case and in a sentence; the design is made up."""

from types import SimpleNamespace

import numpy as np
import pytest

from fegear.engine.table import Column, Table
from fegear.results.relief.relief_data import ReliefData
from fegear.results.relief.relief_in_case import relief_for_case, what_it_leaves

ROLL = np.array([30.0, 10.0, 20.0])
REMOVAL = {"a": np.array([12.0, 0.0, 4.0]), "b": np.array([0.0, 9.0, 3.0])}


def results(
    shape="linear", driver=(12.3456, 25.5), driven=(8.0, 31.25), te=None, least_error=0.02, over=None, rounded=None
):
    ground = {
        "linear": SimpleNamespace(candidates=12345, least=1.5e-6,
                                  least_error=least_error * 1.5e-6),
        "parabolic": SimpleNamespace(candidates=54321, least=0.0,
                                     least_error=1.0),
    }  # fmt: skip
    te = {"no relief": 5.4321, "designed": 0.001, "linear tip relief": 1.5, "parabolic tip relief": 1.75} | (te or {})
    data = object.__new__(ReliefData)
    object.__setattr__(data, "design", SimpleNamespace(
        best_ground=(shape, ground[shape]), ground=ground, rounded=rounded or {},
        task=SimpleNamespace(load=1234.567, over=over, over_loads=(600.0, 1234.567)),
        te={label: SimpleNamespace(peak_to_peak=one * 1e-6) for label, one in te.items()},
    ))  # fmt: skip
    part = SimpleNamespace(driver="a", driven="b")
    words = {"gear": ["a", "b"], "design": [f"{shape} tip relief"] * 2, "modification": ["tip relief"] * 2,
             "shape": [shape] * 2}  # fmt: skip
    sizes = {"amount": ("um", [1e-6 * one[0] for one in (driver, driven)]),
             "start_diameter": ("mm", [2e-3 * one[1] for one in (driver, driven)]),
             "end_diameter": ("mm", [0.08, 0.09])}  # fmt: skip
    columns = [Column(name, np.array(cells)) for name, cells in words.items()]
    columns += [Column(name, np.array(si), unit) for name, (unit, si) in sizes.items()]
    gears = {name: SimpleNamespace(involute_tip_radius=radius) for name, radius in (("a", 0.04), ("b", 0.046))}
    return SimpleNamespace(
        scene=SimpleNamespace(case=SimpleNamespace(pair={"I": part}), gears=gears),
        outcomes={"one": SimpleNamespace(data="of another result"), "two": SimpleNamespace(data=data)},
        tables={f"relief_I_{name}": {"roll_angle": ROLL, "relief": one} for name, one in REMOVAL.items()}
        | {"grinding_I": Table("grinding_I", tuple(columns))},
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
    assert found["a"] == {"tip": {"amount": "12.35 um", "start_radius": "25.5 mm", **more}}
    assert found["b"] == {"tip": {"amount": "8 um", "start_radius": "31.25 mm", "at_radius": "45 mm", **more}}
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
    rounded = what_it_leaves(results(rounded={"linear": np.array([0.7e-6, 1.53e-6])}), "ground")
    assert rounded.startswith("Best linear tip relief: transmission error 1.53 um peak to peak (5.43 um without relief")
    assert "; parabolic ones 1.75 um." in rounded
    other = what_it_leaves(results("parabolic"), "ground")
    assert other.startswith("Best parabolic tip relief: transmission error 1.75 um")
    assert "; linear ones 1.5 um." in other
    assert "agree within 0 %" in other


def test_of_a_range_of_torques_both_ends_are_said():
    made = results(over=SimpleNamespace(loads=(1000.0, 2000.0)))
    (data,) = (one.data for one in made.outcomes.values() if isinstance(one.data, ReliefData))
    object.__setattr__(data, "pair", SimpleNamespace(pair=SimpleNamespace(driver=SimpleNamespace(base_radius=0.03))))
    data.design.over_range = {
        label: [SimpleNamespace(peak_to_peak=one * 1e-6) for one in both]
        for label, both in (("no relief", (3.7, 7.0)), ("linear tip relief", (1.2, 2.4)))
    }
    said = what_it_leaves(made, "ground")
    left = "transmission error 1.2 to 2.4 um peak to peak (3.7 to 7 um without relief)"
    assert said.startswith(f"Best linear tip relief for 30 to 60 N m: {left}")
    data.design.rounded = {"linear": np.array([1.3e-6, 2.3e-6, 2.5e-6])}
    assert "transmission error 1.3 to 2.5 um peak to peak (3.7 to 7 um without" in what_it_leaves(made, "ground")
