"""A designed relief written into a case: what is written, what stays as it was, and what is refused."""

import math
import tomllib
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from typer.testing import CliRunner

from fegear.base.errors import InputError
from fegear.case.changed_text import with_values
from fegear.case.reading import build_scene
from fegear.cli import program
from fegear.design.flanks.flank_tolerance import FlankTolerance, LeadTolerance
from fegear.design.flanks.forms import GroundRelief
from fegear.design.tip_relief.tip_tolerance import TipTolerance
from fegear.engine.table import Column, Table
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.results.relief.applied_design import applied_design, designs_of, keys_of_design
from fegear.results.relief.applied_left import without_stale_comments
from fegear.results.relief.ground_flank_keys import ground_rows, keys_of

CASE = """# A drive of mine.
results = [ "transmission-error" ]   # wanted

[gear.p]
teeth = 25
module = "2.5 mm"   # as drawn
profile_shift = 0.2
{p}
[gear.w]
teeth = 67
module = "2.5 mm"
profile_shift = 0.1
{w}
[pair.I]
driver = "p"
driven = "w"
torque = "300 N*m"
compliance = {{ source = "weber-banaschek" }}
{more}"""


def case(p="", w="", more=""):
    return CASE.format(p=p, w=w, more=more)


def grinding(rows):
    """A grinding table, an object for each row."""
    names = ("gear", "design", "modification", "shape", "amount", "start_diameter", "end_diameter", "face_length")
    units = {"amount": "um", "start_diameter": "mm", "end_diameter": "mm", "face_length": "mm"}
    return Table(
        "grinding_I",
        tuple(Column(name, np.array([row.get(name, np.nan) for row in rows]), units.get(name, "")) for name in names),
    )


def tip(gear, amount, start, end, shape="linear"):
    design = f"{shape} tip relief"
    return {
        "gear": gear, "design": design, "modification": "tip relief", "shape": shape, "amount": amount,
        "start_diameter": start, "end_diameter": end,
    }  # fmt: skip


TABLES = {
    "grinding_I": grinding([
        tip("p", 6.3e-6, 66.4e-3, 68.5e-3), tip("w", 18e-6, 168.7e-3, 173e-3),
        tip("p", 12e-6, 61.6e-3, 68.5e-3, "parabolic"), tip("w", 0.0, 167e-3, 173e-3, "parabolic"),
    ]),
    "relief_I_p": Table("relief_I_p", (
        Column("roll_angle", np.radians([10.0, 20.0, 30.0]), "deg"),
        Column("relief", np.array([0.0, 1e-6, 9e-6]), "um"),
    )),
    "relief_I_w": Table("relief_I_w", (
        Column("roll_angle", np.radians([18.0, 22.0]), "deg"), Column("relief", np.array([0.0, 4e-6]), "um"),
    )),
}  # fmt: skip


def applied(text, design="", pair="", tables=TABLES, document=None):
    document = tomllib.loads(case()) if document is None else document
    return applied_design(text, Path("drive.toml"), document, tables, "results/drive", design, pair)


@pytest.mark.parametrize("design", ["", "linear", "linear tip relief"])
def test_a_design_is_written_with_where_it_came_from_and_all_else_stays(design):
    made = applied(case(), design).text
    lines, before = made.splitlines(), case().splitlines()
    assert [line for line in before if line and line not in lines] == []
    assert (
        'relief = { tip = { amount = "6.3 um", start_radius = "33.2 mm" } }  '
        "# fegear apply: linear tip relief, results/drive, pair I"
    ) in lines
    scene = build_scene(tomllib.loads(made), "drive", Path())
    assert scene.case.effects.relief
    assert scene.case.gear["w"].relief.tip[0].amount == pytest.approx(18e-6)
    assert scene.case.gear["w"].relief.tip[0].start_radius == pytest.approx(84.35e-3)


def test_a_tip_relief_leaves_the_lead_that_is_there():
    """Its design says nothing of the lead: only one with a lead or a twist of its own takes their place."""
    made = applied(case(p='lead = { slope = "2 um" }\nbias = "3 um"\n'), "linear").text
    gear = tomllib.loads(made)["gear"]["p"]
    assert gear["relief"]["tip"]["amount"] == "6.3 um"
    assert (gear["lead"], gear["bias"]) == ({"slope": "2 um"}, "3 um")


def test_the_same_design_again_changes_nothing_and_another_takes_its_place():
    made = applied(case()).text
    assert applied(made).text == made
    other = applied(made, "parabolic").text
    assert other.count("fegear apply") == 1
    assert 'shape = "parabolic"' in other
    assert "relief" not in tomllib.loads(other)["gear"]["w"]  # none is ground there


@pytest.mark.parametrize(
    "held",
    [
        'relief = { root = { amount = "3 um", length = "1 mm" } }  # from the last drawing',
        'relief.tip = { amount = "3 um", length = "1 mm" }',
        '[gear.p.relief.tip]  # mine\namount = "3 um"\nlength = "1 mm"\n',
        '[gear.p.relief]\ntip = [{ amount = "3 um", length = "1 mm" }]\n',
    ],
)
def test_a_relief_that_is_there_is_replaced_however_it_is_written(held):
    made = applied(case(p=held), "exact").text
    relief = tomllib.loads(made)["gear"]["p"]["relief"]
    assert relief["table"]["removals"][-1] == "9 um"
    assert set(relief) == {"table"}
    if "last drawing" in held:
        assert "# from the last drawing; fegear apply: exact" in made


def test_a_lead_in_the_grinding_table_is_written_too():
    rows = [
        tip("p", 6e-6, 66e-3, 67.9e-3),
        *({"gear": "p", "design": "linear tip relief", "modification": kind, "shape": "linear", "amount": amount,
           "face_length": 2e-3} for kind, amount in (
            ("helix slope", -5e-6), ("crowning", 3e-6), ("end relief", 8e-6), ("flank twist", 2e-6))),
    ]  # fmt: skip
    found = keys_of_design({"grinding_I": grinding(rows)}, "I", ("p", "w"))
    assert found["w"] == {}
    assert found["p"]["relief"]["tip"]["at_radius"] == "33.95 mm"
    assert found["p"]["lead"] == {
        "slope": "-5 um", "crowning": "3 um", "end_relief": {"amount": "8 um", "length": "2 mm"}
    }  # fmt: skip
    assert found["p"]["bias"] == "2 um"


def lead(gear, slope, crowning):
    return {"lead_grinding_I": grinding([
        {"gear": gear, "design": "lead correction", "modification": kind, "shape": "linear", "amount": amount}
        for kind, amount in (("helix slope", slope), ("crowning", crowning))
    ])}  # fmt: skip


WIDE = 'lead = { slope = "2 um", end_relief = { amount = "8 um", length = "2 mm" } }\nbias = "3 um"\n'


def test_a_lead_correction_leaves_all_else_of_the_flanks_as_it_is():
    text = case(p=WIDE, w='bias = "1 um"', more="[effects]\nrelief = true\n")
    made = applied_design(text, Path("drive.toml"), tomllib.loads(text), TABLES | lead("p", -5e-6, 0.0), "r", "lead")
    before, after = (tomllib.loads(one)["gear"] for one in (text, made.text))
    assert after["p"]["lead"] == {"slope": "-5 um", "end_relief": before["p"]["lead"]["end_relief"]}
    assert {**after["p"], "lead": 0} == {**before["p"], "lead": 0}
    assert after["w"] == before["w"]
    assert made.said.endswith("gear p lead (helix slope -5 um, end relief).")


def test_a_corrected_lead_of_nothing_takes_the_present_one_away():
    text = case(p='lead = { slope = "2 um" }', more="[effects]\nrelief = true\n")
    made = applied_design(text, Path("drive.toml"), tomllib.loads(text), lead("p", 0.0, 0.0), "r")
    assert "lead" not in tomllib.loads(made.text)["gear"]["p"]


def test_a_lead_correction_of_flanks_whose_modifications_did_not_count_takes_their_place():
    text = case(p=WIDE)
    made = applied_design(text, Path("drive.toml"), tomllib.loads(text), lead("p", -5e-6, 1e-6), "r")
    gears = tomllib.loads(made.text)["gear"]
    assert gears["p"]["lead"] == {"slope": "-5 um", "crowning": "1 um"}
    assert "bias" not in gears["p"]


TOLERANCE = FlankTolerance((TipTolerance(4e-6, None, 0.0),) * 2, LeadTolerance(3e-6, 2e-6, 5e-6))


@pytest.mark.parametrize("offset", [0.0, 3e-3])  # the driver bears lead and twist, or the driven gear does
def test_rows_of_ground_flanks_become_the_keys_that_a_design_names(offset):
    gears = [
        Gear(Tooth(z, BasicRack(), helix_angle=math.radians(15.0)), 3e-3, 15e-3, face, hand=hand)
        for z, hand, face in ((20, "right", 20e-3 + 2.0 * offset), (31, "left", 20e-3))
    ]
    pair, names = GearPair(*gears), {"driver": "p", "driven": "w"}
    relief = GroundRelief(18e-6, 3e-3, 12e-6, 2e-3, 3e-6, 6e-6, 2.5e-3, -4e-6, 8e-6)
    rows = ground_rows(relief, pair, names, "profile", TOLERANCE)
    units = {"amount": "um", "start_diameter": "mm", "end_diameter": "mm", "face_length": "mm"}
    columns = [
        Column(name, np.array([getattr(row, name) for row in rows]), units.get(name, ""))
        for name in ("gear", "design", "modification", "shape", *units)
    ]
    found = keys_of_design({"grinding_I": Table("grinding_I", tuple(columns))}, "I", ("p", "w"))
    wanted = tomllib.loads("\n".join(keys_of(relief, pair, names)))["gear"]
    kept, exact = numbers(found), numbers(wanted)
    assert kept.keys() == exact.keys()
    for key, number in kept.items():  # as a shop reads them, and radii to a micron
        step = 1e-3 if key.endswith("radius") else 1e-2
        assert number == pytest.approx(exact[key], abs=0.5 * step + 1e-5), key
        assert number == pytest.approx(round(number / step) * step, abs=1e-9), key
    assert rows[0].length == pytest.approx(3e-3)
    assert rows[1].length_tolerance == pytest.approx(0.2e-3)
    assert [row.amount_tolerance for row in rows] == [4e-6, 4e-6, 2e-6, 2e-6, 3e-6, 5e-6]


@pytest.mark.parametrize("offset", [0.0, 3e-3])
def test_a_root_relief_over_the_same_part_of_the_path_stands_for_the_tip_relief_of_the_mate(offset):
    gears = [
        Gear(Tooth(z, BasicRack(), helix_angle=math.radians(15.0)), 3e-3, 15e-3, face, hand=hand)
        for z, hand, face in ((20, "right", 20e-3 + 2.0 * offset), (31, "left", 20e-3))
    ]
    pair, names = GearPair(*gears), {"driver": "p", "driven": "w"}
    relief = GroundRelief(18e-6, 3e-3, 12e-6, 2e-3, crowning=3e-6)
    both = tomllib.loads("\n".join(keys_of(relief, pair, names)))["gear"]
    own, mate = ("driver", "driven") if offset == 0.0 else ("driven", "driver")
    found = tomllib.loads("\n".join(keys_of(relief, pair, names, on_one=True)))["gear"]
    assert list(found) == [names[own]]
    keys, others = found[names[own]], both[names[mate]]["relief"]["tip"]
    assert keys["lead"] == both[names[own]]["lead"]
    assert keys["relief"]["tip"] == both[names[own]]["relief"]["tip"]
    root = keys["relief"]["root"]
    assert root["amount"] == others["amount"]

    def on_path(member, radius):
        base = pair.gear(member).base_radius
        return float(pair.x_of_roll(math.sqrt((float(radius.split()[0]) * 1e-3 / base) ** 2 - 1.0), member))

    for one, other in (("start_radius", "start_radius"), ("end_radius", "at_radius")):
        assert on_path(own, root[one]) == pytest.approx(on_path(mate, others[other]), abs=1e-7)


@pytest.mark.parametrize(
    ("amount", "error", "written"),
    [
        (12.72513e-6, None, ("12.73 um", "33.211 mm")),
        (0.272513e-6, None, ("0.273 um", "33.2112 mm")),  # of small gears as much of the amount is lost
        (12.72513e-6, 0.02e-6, ("12.72513 um", "33.2111725 mm")),  # the design states its errors, and is kept
    ],
)
def test_amounts_are_rounded_where_their_effect_is_below_the_error(amount, error, written):
    row = {**tip("p", amount, 66.422345e-3, 68.5e-3), "amount_error": error}
    table = grinding([row])
    if error is not None:
        table = Table("grinding_I", (*table.columns, Column("amount_error", np.array([error]), "um")))
    found = keys_of_design({"grinding_I": table}, "I", ("p", "w"))["p"]["relief"]["tip"]
    assert (found["amount"], found["start_radius"]) == written


def numbers(keys, head=""):
    """Numbers of tables in tables by their paths."""
    found = {}
    for key, one in keys.items():
        found |= numbers(one, f"{head}.{key}") if isinstance(one, dict) else {f"{head}.{key}": float(one.split()[0])}
    return found


@pytest.mark.parametrize(
    ("text", "design", "pair", "tables", "key"),
    [
        (case(), "elliptic", "", TABLES, "--relief"),
        (case(), "", "II", TABLES, "--pair"),
        (case(), "", "", {}, "RESULTS"),
        (case(), "", "", TABLES | {"grinding_II": TABLES["grinding_I"]}, "--pair"),
        (case().replace("teeth = 25", "teeth = 26"), "", "", TABLES, r"gear\.p\.teeth"),
        (case().replace('module = "2.5 mm"\nprofile_shift = 0.1', 'module = "2.5 mm"\nprofile_shift = 0.2'), "", "",
         TABLES, r"gear\.w\.profile_shift"),
        (case().replace("pair.I", "pair.J"), "", "", TABLES, "--case"),
        (case().replace('driven = "w"', 'driven = "p"'), "", "", TABLES, r"pair\.I"),
    ],
)  # fmt: skip
def test_what_does_not_fit_is_refused_by_its_key(text, design, pair, tables, key):
    with pytest.raises(InputError, match=key):
        applied(text, design, pair, tables)


OVER_TORQUE = Table("relief_over_torque_I", (
    Column("torque", np.array([100.0, 200.0, 300.0]), "N.m"), Column("weight", np.ones(3)),
    Column("te_peak_to_peak_no_relief", np.array([2.0, 4.0, 6.0]) * 1e-6, "um"),
    Column("te_peak_to_peak_designed", np.array([4.5, 2.0, 0.01]) * 1e-6, "um"),
    Column("te_peak_to_peak_linear_tip_relief", np.array([1.0, 1.5, 3.0]) * 1e-6, "um"),
    Column("te_peak_to_peak_rounded_linear_tip_relief", np.array([1.01, 1.51, 3.01]) * 1e-6, "um"),
))  # fmt: skip


def test_a_relief_for_one_torque_of_several_says_so_and_what_it_leaves_at_the_others():
    torques = case().replace('torque = "300 N*m"', 'torques = ["100 N*m", "200 N*m", "300 N*m"]')
    tables, document = TABLES | {"relief_over_torque_I": OVER_TORQUE}, tomllib.loads(torques)
    exact = applied(torques, "exact", tables=tables, document=document)
    assert exact.said.startswith("exact relief of results/drive in ")
    assert exact.said.endswith(
        "It is for 300 N m only: transmission error 6 -> 0.01 µm at 300 N m, 4 -> 2 µm at 200 N m, 2 -> 4.5 µm at "
        "100 N m (more than without relief), peak to peak."
    )
    assert exact.text.count("# fegear apply: exact, results/drive, pair I, for 300 N m only") == 2
    linear = applied(torques, tables=tables, document=document)
    assert linear.said.endswith(  # as it is rounded in the grinding table, which is what is written
        "Transmission error 6 -> 3.01 µm at 300 N m, 4 -> 1.51 µm at 200 N m, 2 -> 1.01 µm at 100 N m, peak to peak."
    )
    assert " only" not in linear.text
    assert applied(torques, "parabolic", tables=tables, document=document).said.endswith("no modification.")
    alone = Table("relief_over_torque_I", tuple(
        replace(one, si=np.array([0.0, 0.0, 1.0])) if one.name == "weight" else one for one in OVER_TORQUE.columns
    ))  # fmt: skip
    one = applied(torques, tables=TABLES | {"relief_over_torque_I": alone}, document=document)
    assert "It is for 300 N m only: transmission error 6 -> 3.01" in one.said


def test_comments_of_a_drafted_case_that_a_relief_ends_are_renewed_or_go():
    draft = (
        '    "transmission-error",      # transmission error without relief\n'
        "# relief = true                # off: for the final check, with relief of the gears\n"
    )
    assert without_stale_comments(draft, ()) == (
        '    "transmission-error",      # transmission error with the relief of the gears\n'
    )
    example = '# relief = { tip = { amount = "15 um", length = "4 mm" } }\n'
    gears = f"[gear.p]\nteeth = 20\n{example}[gear.w]\n{example}"
    assert without_stale_comments(gears, ("p",)) == f"[gear.p]\nteeth = 20\n[gear.w]\n{example}"
    assert without_stale_comments(gears, ("w",)) == f"[gear.p]\nteeth = 20\n{example}[gear.w]\n"
    assert without_stale_comments(gears, ("x",)) == gears
    text = applied(case(p=example)).text
    assert example not in text


def test_designs_are_those_of_the_table_and_the_one_of_theory():
    assert designs_of(TABLES, "I") == ["linear tip relief", "parabolic tip relief", "exact"]


def test_a_remark_stands_where_a_line_ends_only():
    text = "gear = { p = { teeth = 25 } }\n[effects]\n"
    made = with_values(text, {("gear", "p", "teeth"): "26"}, {("gear", "p", "teeth"): "fegear apply: x"})
    assert tomllib.loads(made)["gear"]["p"]["teeth"] == 26


def test_the_command_names_what_is_missing(tmp_path):
    (tmp_path / "drive.toml").write_text(case(), "utf-8")
    run = CliRunner().invoke(program(), ["apply", str(tmp_path), "--case", str(tmp_path / "drive.toml")])
    assert isinstance(run.exception, InputError)
    assert "is not a results folder" in str(run.exception)
    assert (tmp_path / "drive.toml").read_text("utf-8") == case()
