"""The case files of the main job, run as users run them, with the numbers that they must give."""

from __future__ import annotations

import csv
import json
import math
from pathlib import Path

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.case.reading import read_scene
from fegear.cli import program
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

CASES = Path(__file__).parents[2] / "cases"

#: 2 (1 - nu^2) / (pi E) in um.mm/N for E = 206.8 GPa, nu = 0.3: what c_self changes with the logarithm of the width.
LOG_SLOPE = 2 * (1 - 0.3**2) / (math.pi * 206.8e3) * 1e3

#: The contract on which others build.
STIFFNESS_HEADS = [
    "radius [mm]",
    "roll_angle [deg]",
    "c_self [um.mm/N]",
    "c_prev [um.mm/N]",
    "c_next [um.mm/N]",
    "contact_half_width [mm]",
    "root_tension [MPa.mm/N]",
    "root_tension_radius [mm]",
    "root_compression [MPa.mm/N]",
    "root_compression_radius [mm]",
]


def run(name: str, *overrides: str):
    scene = read_scene(CASES / f"{name}.toml", overrides)
    results = run_plan(scene, make_plan(scene, STAGES))
    tables = {table.name: {column.name: column.values for column in table.columns} for table in results.tables}
    return tables, {value.name: value.value for value in results.values}, results


def test_four_square_test_gears():
    tables, values, results = run("nasa_four_square")
    # Printed by the paper: base pitch and, from the same centre distance, the slave gears' 35 teeth of 2.54 mm.
    assert values["I.base_pitch"] == pytest.approx(9.3730, abs=5e-5)
    assert values["I.centre_distance"] == pytest.approx(values["II.centre_distance"], rel=1e-12)
    # The rounding of 0.381 mm shortens the active flank: 1.638 without it, 1.466 if all of it were lost.
    assert 1.466 < values["I.contact_ratio"] < 1.638
    assert results.scene.gears["test"].plane_assumption == "stress"
    assert results.scene.gears["slave"].plane_assumption == "strain"
    table = tables["stiffness_test"]
    assert len(table["radius"]) == 100
    # Hertz at the pitch point: b = sqrt(8 w R (1/E) / pi) with R = rho / 2, both bodies in plane stress.
    pitch = np.interp(44.45, table["radius"], table["contact_half_width"])
    rho = 44.45 * math.sin(math.radians(20.0))
    assert pitch == pytest.approx(math.sqrt(4 * 254.33 * (rho / 2) * 2 / (math.pi * 206.8e3)), rel=1e-4)
    assert table["root_tension"][-1] == pytest.approx(1.2137, rel=5e-3)
    # Tooth 1 and tooth -1 see the load from either side of the same body: the same body deflection.
    assert table["c_next"] == pytest.approx(table["c_prev"], rel=1e-12)


def test_lin_table1():
    tables, values, _ = run("lin_table1")
    assert values["I.contact_ratio"] == pytest.approx(1.638, abs=5e-4)
    # DESIGN's full ring for a half-width of 0.08 mm, brought to Hertz's width for 350 N/mm by the exact logarithm.
    rho = 44.45 * math.sin(math.radians(20.0))
    b = math.sqrt(4 * 350.0 * (rho / 2) * 2 * (1 - 0.3**2) / (math.pi * 206.8e3))
    c_self = 3.811e-2 + LOG_SLOPE * math.log(0.08 / b)
    assert values["a.c_self_at_pitch"] == pytest.approx(c_self, rel=1e-3)
    assert values["a.c_next_at_pitch"] == pytest.approx(7.752e-3, rel=1e-3)
    table = tables["stiffness_a"]
    assert table["radius"][-1] == pytest.approx(47.625, rel=1e-12)
    assert np.diff(table["roll_angle"]) == pytest.approx(np.diff(table["roll_angle"])[0], rel=1e-9)
    curve = tables["root_stress_a"]
    assert curve["stress"].max() == pytest.approx(table["root_tension"].max(), rel=5e-3)


def test_thin_rim():
    tables, values, _ = run("thin_rim")
    _, solid, _ = run("thin_rim", "gear.rim.bore_radius=20.24 mm")
    # With the body held just below the fillets the neighbours hardly know of the load...
    assert values["rim.c_next_at_pitch"] < 0.05 * solid["rim.c_next_at_pitch"]
    assert values["rim.c_next_at_pitch"] == pytest.approx(3.62e-4, rel=5e-3)
    # ...and what is left of the loaded tooth's own deflection is its bending and its contact.
    assert values["rim.c_self_at_pitch"] == pytest.approx(2.486e-2, rel=2e-3)
    assert solid["rim.c_self_at_pitch"] == pytest.approx(3.811e-2, rel=1e-3)
    assert np.isfinite(tables["stiffness_rim"]["c_self"]).all()


def test_compliance_does_not_depend_on_size_and_stress_scales_with_it():
    tables, _, _ = run("lin_table1", 'stiffness={gear="a", positions=5, contact_half_width="0.08 mm"}', "pair={}")
    larger, _, _ = run(
        "lin_table1",
        "gear.a.diametral_pitch=4 / inch",
        "gear.a.bore_radius=40.48125 mm",
        'stiffness={gear="a", positions=5, contact_half_width="0.16 mm"}',
        "pair={}",
    )
    assert larger["stiffness_a"]["c_self"] == pytest.approx(tables["stiffness_a"]["c_self"], rel=1e-12)
    assert larger["stiffness_a"]["root_tension"] == pytest.approx(tables["stiffness_a"]["root_tension"] / 2, rel=1e-12)


def test_the_command_writes_the_table_that_others_build_on(tmp_path, capsys):
    with pytest.raises(SystemExit) as left:
        program()(["run", str(CASES / "lin_table1.toml"), "--out", str(tmp_path / "o"), "--no-plots"])
    assert left.value.code in (0, None)
    with (tmp_path / "o" / "tables" / "stiffness_a.csv").open(newline="", encoding="utf-8") as stream:
        rows = list(csv.reader(stream))
    assert rows[0][: len(STIFFNESS_HEADS)] == STIFFNESS_HEADS
    assert len(rows) == 101
    summary = json.loads((tmp_path / "o" / "summary.json").read_text())
    assert summary["results"]["a.c_next_at_pitch"]["error"] < 1e-3 * summary["results"]["a.c_next_at_pitch"]["value"]
    assert summary["timings"]["total"] > 0.0
    assert "Wrote" in capsys.readouterr().out


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        (['stiffness={radii=["60 mm"]}'], "60 mm: is outside the involute flank of gear a; valid range"),
        (['stiffness={radii=["40 mm"]}'], "40 mm: is outside the involute flank of gear a; valid range"),
        (["stiffness.gear=b"], "is not a gear of this case"),
        (["stiffness.pair=II"], "is not a pair of this case"),
        (["pair={}"], "requires a mating flank for the contact width"),
    ],
)
def test_what_the_table_cannot_be_made_for_is_refused(overrides, words):
    with pytest.raises(InputError, match=words):
        run("lin_table1", *overrides)


@pytest.mark.dear
def test_a_tooth_mesh_of_the_users_own_takes_the_place_of_the_generated_one():
    own = 'gear.a.tooth_mesh="../meshes/four_square_test_gear.msh"'
    table = 'stiffness={gear="a", radii=["44.45 mm"], contact_half_width="0.08 mm"}'
    _, values, results = run("lin_table1", own, table)
    _, generated, _ = run("lin_table1", table)
    for name in ("a.c_self_at_pitch", "a.c_next_at_pitch", "a.largest_root_tension"):
        assert values[name] == pytest.approx(generated[name], rel=5e-3)
        assert values[name] != generated[name]
    assert "four_square_test_gear.msh" in str([outcome.settings for outcome in results.outcomes.values()])
    with pytest.raises(InputError, match=r"gear\.a\.tooth_mesh = .*file not found"):
        run("lin_table1", "gear.a.tooth_mesh=none.msh")
