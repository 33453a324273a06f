"""The tables of the page on what accuracy costs, from a study's: a cell without a number is empty there."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "benchmarks"))
import cost_study


def written(folder, name, *lines):
    (folder / "tables").mkdir(exist_ok=True)
    (folder / "tables" / f"{name}.csv").write_text("\n".join(lines) + "\n", encoding="utf-8")


def test_what_is_not_reached_and_has_no_order_is_written_so(tmp_path):
    """Studies write nothing where they once wrote nan, and the page could not be made any more."""
    written(
        tmp_path, "cost_cheapest", "quantity,tolerance,configuration,seconds [s]",
        'c_0,0.1,"whole gear, order 2, edges x 4, patch 0.18",0.017', "c_0,1e-05,not reached,",
    )  # fmt: skip
    written(
        tmp_path, "cost_orders", "quantity,knob,order,configurations_used,configurations",
        "c_0,patch half-width,2.04,5,5", "c_1,patch half-width,,0,5",
    )  # fmt: skip
    last = cost_study.cheapest(tmp_path).splitlines()[-1]
    assert last == "| c_0 | order 2, edges x 4, patch 0.18: 0.017 s |  |  |  | not reached |"
    assert cost_study.orders(tmp_path).splitlines()[-1] == "| patch half-width | 2.0 (5 of 5) | none |"


def test_an_error_that_is_not_known_leaves_its_cell_empty(tmp_path):
    written(
        tmp_path, "cost", "quantity,configuration,family,error,seconds [s]",
        '"c_0","cornell, compliance",compliance-formula,0.1,0.001', '"c_1","cornell, compliance",compliance-formula,,',
        "c_0,tolerance = 1e-01,tolerance,0.0007,0.053",
    )  # fmt: skip
    assert cost_study.errors(tmp_path).splitlines()[2:] == [
        "| cornell, compliance | 10 % (0.001 s) |  |  |  |  |",
        "| tolerance = 1e-01 | 0.07 % (0.053 s) |  |  |  |  |",
    ]
