"""``fegear cost`` as users meet it: what it studies, what it writes, what it refuses, what Ctrl-C keeps."""

from __future__ import annotations

import csv
import json
import os
import signal
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest

import fegear.studies.cost.ladder as ladders
from fegear.base.errors import InputError
from fegear.case.reading import build_scene, read_scene
from fegear.cli import program
from fegear.studies.cost.asked import asked
from fegear.studies.cost.study import forecast, ladder_of

CASES = Path(__file__).parents[2] / "cases"
CASE = """
title = "A pair"
results = ["stiffness", "root-stress", "transmission-error", "load-sharing"]
[gear.a]
teeth = 20
module = "2 mm"
face_width = "20 mm"
[pair.I]
driver = "a"
driven = "a"
load = "4000 N"
[stiffness]
positions = 7
load = "200 N/mm"
[effects]
neighbour_coupling = true
hertz = "load-dependent"
"""
NAMES = ["c_0", "c_1", "root-stress", "te-peak-to-peak", "tooth-force"]


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    path = tmp_path_factory.mktemp("cost") / "pair.toml"
    path.write_text(CASE)
    return path


def rows(folder, name):
    with (folder / "tables" / f"{name}.csv").open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def shortened(patch):
    """Give the study a ladder of a few coarse configurations."""
    patch.setattr(ladders, "_QUICK_FACTORS", {2: (4.0, 2.8, 2.0)})
    patch.setattr(ladders, "_QUICK_PATCHES", (2.0,))
    patch.setattr(ladders, "_QUICKER", 3.0)
    patch.setattr(ladders, "_TOLERANCES", (1e-1,))


@pytest.fixture(scope="module")
def short(case):
    """The command on a ladder of a few coarse configurations."""
    with pytest.MonkeyPatch.context() as patch:
        shortened(patch)
        out = case.parent / "o"
        with pytest.raises(SystemExit) as left:
            program()(["cost", str(case), "--quick", "--out", str(out)])
    assert left.value.code in (0, None)
    return out


@pytest.mark.dear
def test_finer_meshes_have_smaller_errors_and_the_cheapest_within_a_tolerance_is_one_of_them(
    case, tmp_path, monkeypatch
):
    """The shortest study, of the ordinary run; the next tests read all that a longer one writes."""
    shortened(monkeypatch)
    asked_for = ["--quick", "--no-plots", "--set", 'results=["stiffness"]', "--out", str(tmp_path / "o")]
    with pytest.raises(SystemExit) as left:
        program()(["cost", str(case), *asked_for])
    assert left.value.code in (0, None)
    found = {row["configuration"]: row for row in rows(tmp_path / "o", "cost") if row["quantity"] == "c_0"}
    finer = [row for name, row in found.items() if name.startswith("full gear, order 2")]
    finer.sort(key=lambda row: -float(row["root_edge_length"]))  # the table's own order is that of the seconds measured
    errors = [float(row["error"]) for row in finer]
    assert len(errors) == 3
    assert errors == sorted(errors, reverse=True)
    within = {name: float(row["error"]) for name, row in found.items() if row["answered"] == "1"}
    cheapest = [row for row in rows(tmp_path / "o", "cost_cheapest") if row["quantity"] == "c_0"]
    assert len(cheapest) > 3
    for name, tolerance in ((row["configuration"], float(row["tolerance"])) for row in cheapest):
        assert (name == "not reached") == (min(within.values()) > tolerance)
        assert name == "not reached" or within[name] <= tolerance


@pytest.mark.dear
def test_tables_hold_every_configuration_with_error_and_seconds(short):
    found = rows(short, "cost")
    assert {row["quantity"] for row in found} == set(NAMES)
    families = {row["family"] for row in found}
    assert families == {"ring", "scikit-fem", "sector", "compliance-formula", "stress-formula", "tolerance"}
    assert {row["teeth"] for row in found if row["family"] == "sector"} == {"3", "5", "9"}
    for row in found:
        assert float(row["seconds [s]"]) >= float(row["seconds_solving [s]"])
        assert (float(row["seconds_solving [s]"]) > 0.0) == (
            row["family"] in ("ring", "scikit-fem", "sector", "tolerance")
        )
        refused = row["configuration"].split(",")[0] == "potential-energy" and row["quantity"] != "c_1"
        assert ("Sainsot" in row["reason"]) == refused  # his polynomials end at about 24 teeth
        assert (row["answered"] == "0") == refused
        if row["answered"] == "1":
            assert float(row["error"]) >= float(row["floor"]) > 0.0
    closed = [row for row in found if row["family"] == "compliance-formula" and row["quantity"] == "c_1"]
    assert [float(row["error"]) for row in closed] == [1.0] * 5  # none of them knows the next tooth
    # A sector cut out of the gear is too soft, the more so the fewer teeth; whole gears err by far less.
    sector, ring = (
        {
            int(row["teeth"]): float(row["error"])
            for row in found
            if row["family"] == family and row["quantity"] == "c_0"
        }
        for family in ("sector", "ring")
    )
    assert sector[3] > sector[5] > sector[9] > 0.05
    assert ring[0] < 0.05
    # One pair carries all of the load somewhere: statics, whatever the settings.
    force = [row for row in found if row["quantity"] == "tooth-force"]
    assert {(row["error"], row["below_floor"]) for row in force if not row["reason"]} == {("1e-13", "1")}


@pytest.mark.dear
def test_front_and_cheapest_follow_from_the_table(short):
    found = [row for row in rows(short, "cost") if row["family"] != "tolerance"]
    cheapest = {(row["quantity"], float(row["tolerance"])): row for row in rows(short, "cost_cheapest")}
    assert set(cheapest) == {(name, t) for name in [*NAMES, "all"] for t in (1e-1, 1e-2, 1e-3, 1e-4, 1e-5)}
    for (name, tolerance), row in cheapest.items():
        if name == "all":
            continue
        errors = ("error", "compliance_error")
        good = [
            r for r in found if r["quantity"] == name and all(float(r[key] or "inf") <= tolerance for key in errors)
        ]
        if row["configuration"] == "not reached":
            assert good == []
            assert row["seconds [s]"] == ""
        else:
            # eleven digits in a file: what is equally cheap there may differ by the last
            compared = {id(r): float(r["seconds [s]"]) - float(r["seconds_fixed [s]"]) for r in good}
            least = min(compared.values())
            near = [r for r in good if compared[id(r)] <= least + 1e-9]
            assert (row["configuration"], row["seconds [s]"]) in [(r["configuration"], r["seconds [s]"]) for r in near]


@pytest.mark.dear
def test_a_formula_that_is_right_with_a_wrong_compliance_is_not_the_cheapest(short):
    """Statics alone decides the largest tooth force: every formula has it, with a c_0 that is 5 to 50 % off."""
    found = [r for r in rows(short, "cost") if r["quantity"] == "tooth-force" and not r["reason"]]
    formulas = [r for r in found if r["family"] == "compliance-formula"]
    assert formulas
    assert all(float(r["error"]) <= 1e-12 and 0.01 < float(r["compliance_error"]) < 1.0 for r in formulas)
    best = {float(r["tolerance"]): r for r in rows(short, "cost_cheapest") if r["quantity"] == "tooth-force"}
    within = [r for r in found if float(r["compliance_error"]) <= 1e-2 and r["family"] != "tolerance"]
    assert best[1e-2]["configuration"] in [*(r["configuration"] for r in within), *["not reached"] * (not within)]


@pytest.mark.dear
def test_seconds_common_to_all_configurations_are_not_compared(short):
    """One row is cheapest for all quantities by what its gears take, whatever the dynamics took that time."""
    results = [r for r in rows(short, "cost") if r["quantity"] == "tooth-force" and not r["reason"]]
    for row in results:
        assert float(row["seconds_fixed [s]"]) == pytest.approx(
            float(row["seconds [s]"]) - float(row["seconds_solving [s]"]), abs=1e-8
        )
    for row in (r for r in rows(short, "cost") if r["quantity"] == "c_0"):
        assert float(row["seconds_fixed [s]"]) == 0.0


@pytest.mark.dear
def test_all_quantities_at_once_are_cheapest_for_a_configuration(short):
    cheapest = {(row["quantity"], float(row["tolerance"])): row for row in rows(short, "cost_cheapest")}
    at_once = cheapest["all", 1e-1]
    assert at_once["configuration"].startswith("full gear")
    assert float(at_once["seconds [s]"]) >= float(cheapest["c_1", 1e-1]["seconds [s]"])


@pytest.mark.dear
def test_what_is_cheapest_can_be_pasted_into_a_case(short, case):
    import tomllib

    from fegear.case.built.tooth_influence import mesh_settings

    for row in rows(short, "cost_cheapest"):
        if row["case_line"].startswith("accuracy"):
            document = tomllib.loads(CASE) | tomllib.loads(row["case_line"])
            settings = mesh_settings(build_scene(document, "pasted", case.parent).case.accuracy)
            assert f"order {settings.order}, " in row["configuration"]
            assert f"patch {settings.patch_half_width:.4g}" in row["configuration"]
            assert row["configuration"].endswith("by scikit-fem") == (settings.solver == "scikit-fem")
    assert any(row["case_line"].startswith("accuracy") for row in rows(short, "cost_cheapest"))


@pytest.mark.dear
def test_orders_tell_what_they_rest_on(short):
    found = rows(short, "cost_orders")
    knobs = {(row["quantity"], row["knob"]) for row in found}
    even = "positions per base pitch, equally spaced"
    assert {("c_0", "edge length, order 2"), ("c_1", "patch half-width"), ("te-harmonics", even)} <= knobs
    for row in found:
        assert (row["order"] == "") == row["rests_on"].startswith("none")
        assert int(row["configurations_used"]) <= int(row["configurations"])
    # The mesh stiffness jumps: a trapezoidal rule converges with 1 / N, whatever N is.
    (jumps,) = (row for row in found if row["quantity"] == "stiffness-harmonics" and row["knob"] == even)
    assert float(jumps["order"]) == pytest.approx(1.0, abs=0.25)


@pytest.mark.dear
def test_summary_and_pictures(short):
    summary = json.loads((short / "summary.json").read_text())
    assert summary["configurations"]["planned"] == summary["configurations"]["finished"]
    assert set(summary["results"]) == {"a.c_0", "a.c_1", "a.root-stress", "I.te-peak-to-peak", "I.tooth-force"}
    assert summary["results"]["I.tooth-force"]["value"] == pytest.approx(4000.0)
    assert all((short / name).is_file() for name in summary["files"])
    assert {path.name for path in (short / "plots").iterdir()} == {
        "cost.png", "cost_knobs.png", *(f"cost_{name}.png" for name in NAMES),
    }  # fmt: skip


def test_no_configuration_profits_from_an_earlier_one(case, monkeypatch):
    """Every finite-element configuration is meshed and solved in its own time, past all caches."""
    import fegear.studies.cost.measure as measure
    from fegear.studies.cost import result as timing
    from fegear.studies.cost.answers import FiniteElements
    from fegear.studies.cost.ladder import Configuration

    monkeypatch.setattr(timing, "_SHORT", np.inf)  # a busy machine may take longer
    solved = []
    plain = measure.solve_influence
    monkeypatch.setattr(measure, "solve_influence", lambda *a, **k: (solved.append(k), plain(*a, **k))[1])
    studied = asked(read_scene(case, ['results=["stiffness"]']))
    configuration = Configuration("ring", ladders.MeshSettings().scaled(5.6), 5.6)
    for _ in range(2):
        influences, seconds = measure.solve_gears(studied, configuration)
        assert seconds["a"].cpu > 0.0
    assert len(solved) == 6  # three times each, for the median
    assert np.isfinite(measure.finite_elements(studied, configuration, influences).of_gear("c_0", studied)).all()
    assert isinstance(measure.finite_elements(studied, configuration, influences), FiniteElements)


def test_only_what_the_case_asks_for_is_studied(case):
    scene = read_scene(case, ['results=["stiffness"]'])
    assert [q.name for q in asked(scene).quantities] == ["c_0", "c_1"]
    assert asked(scene).pair == ""
    assert asked(scene).gears == ("a",)
    stress = asked(read_scene(case, ['cost.quantities=["root-stress"]']))
    assert [configuration.family for configuration in ladder_of(stress).others][:1] == ["stress-formula"]
    force = asked(read_scene(case, ['cost.quantities=["tooth-force"]']))
    assert force.gear == ""
    assert "static" in force.quantities[0].meaning
    assert forecast(force, ladder_of(force, quick=True)) < forecast(force, ladder_of(force))


def test_effects_that_only_the_cost_study_depends_on_are_not_idle(case):
    from fegear.engine.plan import make_plan
    from fegear.results.catalogue import STAGES

    wanted = 'results=["stiffness"]'
    idle = make_plan(read_scene(case, [wanted]), STAGES).idle_effects
    assert idle == ("neighbour_coupling", "hertz")
    studied = read_scene(case, [wanted, 'cost.quantities=["te-peak-to-peak"]'])
    assert make_plan(studied, STAGES).idle_effects == ()


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ('cost.quantities=["c0"]', "cost.quantities"),
        ("cost.quantity=1", "unknown key"),
        ("cost.gear=b", 'cost.gear = "b": is not a spur gear of this case'),
        ("cost.pair=J", 'cost.pair = "J": is not a pair of this case'),
        ('cost.quantities=["dynamic-factor"]', "requires a train, speeds, and an effect in the"),
    ],
)
def test_what_cannot_be_studied_is_refused_with_the_remedy(case, override, words):
    with pytest.raises(InputError, match=words):
        asked(read_scene(case, [override]))


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("effects.hertz=none", "leaves the contact width equal to the mesh"),
        ("gear.a.tooth_mesh=own.msh", "fixes the mesh"),
    ],
)
def test_what_is_named_under_cost_is_refused_where_the_usual_study_takes_its_place(case, override, words):
    named = 'cost.quantities=["te-peak-to-peak", "c_0"]'
    with pytest.raises(InputError, match=words):
        asked(read_scene(case, [override, named]))
    found = asked(read_scene(case, [override]))
    assert {"c_0", "root-stress"} <= {quantity.name for quantity in found.quantities}
    assert words in found.notes[0]
    assert found.notes[0].startswith("Studied instead of the requested results:")


def test_a_case_without_a_load_has_no_pair_to_study(tmp_path):
    path = tmp_path / "bare.toml"
    path.write_text(CASE.replace('load = "4000 N"\n', ""))
    with pytest.raises(InputError, match=r"must be a loaded spur pair"):
        asked(read_scene(path, ['cost.quantities=["te-peak-to-peak"]']))
    found = asked(read_scene(path))
    assert [quantity.name for quantity in found.quantities] == ["c_0", "c_1", "root-stress"]
    assert "must be a loaded spur pair" in found.notes[0]


@pytest.mark.parametrize("name", sorted(path.stem for path in CASES.glob("*.toml")))
def test_every_shipped_case_can_be_studied(name):
    scene = read_scene(CASES / f"{name}.toml")
    if not scene.gears:  # rigid gears on springs, gears that are sought: nothing to choose, which the command says
        assert name in ("blankenship_singh", "sizing_spur")
        return
    found = asked(scene)
    assert found.quantities
    assert ladder_of(found, quick=True).configurations


def test_a_case_without_gears_has_nothing_to_choose(capsys):
    program()(["cost", str(CASES / "blankenship_singh.toml"), "--quick"], standalone_mode=False)
    assert (
        "Cost study: the case has no gears, so there is no mesh, formula or tolerance to choose."
    ) in capsys.readouterr().out


@pytest.mark.dear
def test_ctrl_c_leaves_what_is_finished(case, tmp_path):
    slow = (
        "import signal; signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "import fegear.studies.cost.ladder as l; l._QUICK_FACTORS = {2: (4.0, 2.8)}; l._QUICKER = 4.0\n"
        "import fegear.studies.cost.measure as m, time\n"
        "m._tolerance = lambda *a: (print('waiting', flush=True), time.sleep(60))\n"
        "from fegear.cli import main; main()"
    )
    process = subprocess.Popen(
        [sys.executable, "-c", slow, "cost", str(case), "--quick", "--no-plots", "--set", 'cost.quantities=["c_0"]'],
        cwd=tmp_path, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True,
    )  # fmt: skip
    assert process.stdout is not None
    lines = iter(process.stdout.readline, "")
    assert next(lines).startswith("Cost study: ")
    assert next(lines).startswith("Estimated CPU time: about ")
    assert next(lines) == "waiting\n"
    os.kill(process.pid, signal.SIGINT)
    _, errors = process.communicate(timeout=60)
    assert process.returncode == 130
    assert "fegear: interrupted; " in errors
    out = tmp_path / "results" / "pair_cost"
    summary = json.loads((out / "summary.json").read_text())
    assert 0 < summary["configurations"]["finished"] < summary["configurations"]["planned"]
    assert {row["family"] for row in rows(out, "cost")} == {"ring", "scikit-fem", "sector", "compliance-formula"}
