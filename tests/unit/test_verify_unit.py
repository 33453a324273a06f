"""Rows of `fegear verify`: each holds, no name twice, and a row that does not hold is found."""

import importlib.util
import json
import math
from pathlib import Path

import pytest

from fegear.base.errors import InputError, MissingLibraryError
from fegear.cli import program
from fegear.verify.row import AGAINST, Compared, Outcome, Row, near, printed, run
from fegear.verify.rows import ALL, chosen

_SPEC = importlib.util.spec_from_file_location("rows_of_verify", Path(__file__).parents[1] / "golden/rows_of_verify.py")
rows_of_verify = importlib.util.module_from_spec(_SPEC)
_SPEC.loader.exec_module(rows_of_verify)
KEPT = rows_of_verify.kept()

#: Rows that take seconds: the site runs them for its page of proofs; what they compare has tests with smaller gears
#: (test_check_command_unit.py here, loaded flanks, solid gears and gear bodies of other_codes).
DEAR = {
    "whole-gear-compliance", "whole-gear-root-stress", "ring-supports", "calculix-flanks", "calculix-flank-shares",
    "calculix-flank-root-stress",
    "calculix-web-deflection", "calculix-web-root-tension", "calculix-web-frequencies",
    "calculix-inclined-web-deflection", "calculix-inclined-web-root-tension",
    "calculix-web-holes-deflection", "calculix-web-holes-root-tension",
    "calculix-solid-deflection", "calculix-solid-root-stress",
}  # fmt: skip


@pytest.mark.dear("planetary-phases", "fmu", "edge-cracks", "calculix-planet-and-ring", "fillets-rolled")
@pytest.mark.parametrize(
    "row",
    [pytest.param(row, marks=[pytest.mark.long] * (row.name in DEAR)) for row in ALL],
    ids=[row.name for row in ALL],
)
def test_every_row_holds(row):
    found = run(row)
    assert found.holds, found.wrong
    assert row.what.endswith(".")
    assert row.source
    # With other inputs a row holds as well; what it compares is kept.
    assert row.name not in KEPT or rows_of_verify.same(KEPT[row.name], rows_of_verify.of_row(found))


def test_there_are_rows_of_every_kind_and_no_name_twice():
    assert len(ALL) >= 80
    assert len({row.name for row in ALL}) == len(ALL)
    assert {row.against for row in ALL} == set(AGAINST)
    assert {row.name for row in ALL} > DEAR
    assert set(KEPT) == {row.name for row in ALL} - DEAR


def test_a_printed_number_holds_within_half_a_unit_of_its_last_digit():
    assert printed(1.2349, "1.23").holds
    assert not printed(1.2352, "1.23").holds
    assert printed(1.2352, "1.23", input_moves=3e-4).holds
    assert printed(0.04, "0.0").holds


def made(*compared: Compared) -> Outcome:
    return run(Row("x", "capability", "own", "source", "What.", lambda: compared))


def test_a_row_that_is_off_or_empty_does_not_hold():
    (good,), (bad,) = near(1.0, 1.0 + 1e-9, 1e-8), near(1.0, 1.1, 1e-3)
    assert made(good).holds
    assert not made(good, bad).holds
    assert not made().holds
    assert not made(next(near(math.nan, 1.0, 1.0))).holds
    # A number that is known to differ has to: once it holds, the list is wrong.
    assert made(good, bad.known("why")).holds
    assert made(good, bad.known("why")).largest is good
    assert not made(good.known("why"), good).holds


def test_names_are_looked_up_and_corrected():
    assert [row.name for row in chosen(["beams", "cones"])] == ["beams", "cones"]
    assert {row.against for row in chosen([], "program")} == {"program"}
    with pytest.raises(InputError, match="did you mean beams"):
        chosen(["beam"])
    with pytest.raises(InputError, match="must be one of printed, program, own"):
        chosen([], "others")


def missing():
    raise MissingLibraryError("numba is not there.")


def test_the_command_says_what_it_found_and_ends_with_1_where_a_row_does_not_hold(capsys, monkeypatch):
    program()(["verify", "beams", "--json"], standalone_mode=False)
    told = json.loads(capsys.readouterr().out)
    assert told["holding"] == 1
    assert told["rows"][0]["largest_difference"] < 1e-10
    bare = Row("bare", "capability", "own", "source", "What.", lambda: missing())
    monkeypatch.setattr("fegear.verify.rows.ALL", (bare,))
    assert program()(["verify"], standalone_mode=False) in (None, 0)
    assert "not run: numba is not there" in capsys.readouterr().out
    wrong = Row("wrong", "capability", "own", "source", "What.", lambda: near(1.0, 2.0, 1e-3))
    monkeypatch.setattr("fegear.verify.rows.ALL", (wrong,))
    assert program()(["verify"], standalone_mode=False) == 1
    assert "FAILED" in capsys.readouterr().out


def test_what_is_kept_of_a_row_changes_with_each_of_its_numbers():
    def of(*compared):
        return rows_of_verify.of_row(made(*compared))

    one, other = Compared(1.0, 1.0, 1.0, 1e-3), Compared(2.0, 3.0, 4.0, 1e-4)
    first = of(one, other)
    assert rows_of_verify.same(first, of(one, other))
    assert rows_of_verify.same(first, of(Compared(1.5, 1.0, 1.0, 1e-3), other))  # fegear's own
    for changed in (
        of(one), of(other, one), of(one, Compared(2.0, 3.01, 4.0, 1e-4)), of(one, Compared(2.0, 3.0, 4.4, 1e-4)),
        of(one, Compared(2.0, 3.0, 4.0, 1.1e-4)), of(one, other, other),
    ):  # fmt: skip
        assert not rows_of_verify.same(first, changed)


def test_the_worst_number_is_told_with_what_is_stated_and_allowed():
    from fegear.verify.rows import said

    found = made(
        Compared(1.02, 1.0, 1.0, 0.05, 0.03), Compared(7.0, 7.1, 10.0, 0.05), Compared(3.0, 2.0, 4.0, 0.1).known("why")
    )
    assert found.largest.found == 1.02
    assert found.plain() == {
        "name": "x", "against": "own", "capability": "capability", "source": "source", "what": "What.", "numbers": 3,
        "known_to_differ": 1, "largest_difference": pytest.approx(0.02), "stated_error": 0.03, "allowed": 0.05,
        "holds": True, "seconds": pytest.approx(0.0, abs=1.0),
    }  # fmt: skip
    assert said(found).splitlines()[1].strip() == (
        "numbers: 3, 1 with known differences, largest difference 2.0e-02, estimated error 3.0e-02, allowed 5e-02"
    )
    off = made(Compared(1.02, 1.0, 1.0, 0.01))
    lines = said(off).splitlines()
    assert lines[1].endswith("allowed 1e-02  FAILED")
    assert lines[2].strip() == "1.02 instead of 1"
    assert Compared(1.0 + 1e-3 * (1.0 + 1e-10), 1.0, 1.0, 1e-3).holds
    assert not Compared(1.0 + 1.0001e-3, 1.0, 1.0, 1e-3).holds
    one, two = near([2.0, 3.0], [2.5, 0.0], 0.1, stated=[0.5, 0.6])
    assert (one.scale, one.deviation, one.stated) == (2.5, pytest.approx(0.2), pytest.approx(0.2))
    assert (two.scale, two.deviation, two.stated) == (1.0, 3.0, 0.6)
    (three,) = near(1.0, 2.0, 0.1, scale=4.0)
    assert (three.deviation, three.stated) == (0.25, None)
