"""Parts of a cost study by themselves: its ladder, its forecast, formulas as sources, tables and figures of rows."""

from __future__ import annotations

import csv
import math
import tomllib
from dataclasses import dataclass, replace
from pathlib import Path
from types import SimpleNamespace

import numpy as np
import pytest

import fegear
from fegear.base.errors import FegearError, InputError, RangeError
from fegear.case.built.solid_influence import seconds_of_solid_gear
from fegear.case.built.tooth_influence import seconds_of_gear
from fegear.case.reading import build_scene, read_scene
from fegear.case.studies import CostPart
from fegear.contact.compared import crosscheck
from fegear.fem.plane.settings import MeshSettings
from fegear.fem.solid.settings import SolidSettings, solid_settings
from fegear.formulas.hertz import relative_curvature
from fegear.formulas.iso6336.part3_root_stress import tooth_root_stress
from fegear.formulas.sources import SOURCES
from fegear.formulas.sources import pair_compliance as formula_pair
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import GearPair
from fegear.geometry.rack import BasicRack
from fegear.output.cost import cheapest_lines, cost_page
from fegear.output.tables import write_table
from fegear.studies.cost import knobs, measure, study
from fegear.studies.cost.answers import (
    CaseTable,
    ComplianceFormula,
    StressFormula,
    answer,
    factor_at,
    largest_force,
    pair_compliance,
    pair_error,
    speed_looked_at,
    train_of,
    without_neighbours,
)
from fegear.studies.cost.asked import asked
from fegear.studies.cost.ladder import Configuration, flank_ladder, flank_seconds, make_ladder
from fegear.studies.cost.quantities import Miss, Quantity
from fegear.studies.cost.result import ALL, CostResults, Measured, Seconds, make_knob, timed
from fegear.studies.cost.tables import cost_figures, cost_table, tables

CASES = Path(__file__).parents[2] / "cases"
PAIR = """
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


def scene_of(**changes):
    document = tomllib.loads(PAIR)
    for key, value in changes.items():
        *tables_, last = key.split("__")
        place = document
        for name in tables_:
            place = place.setdefault(name, {})
        place[last] = value
    return build_scene(document, "pair", CASES)


@pytest.fixture(scope="module")
def pair():
    return asked(scene_of())


@pytest.fixture(scope="module")
def rig():
    """A train whose teeth's compliances stand in a table of the case."""
    return asked(read_scene(CASES / "four_square_dynamics.toml"))


# ---- the ladder ------------------------------------------------------------------------------------------------------
def steps(ladder):
    """Family, order, edges over the usual, patches, teeth of each group."""
    found = []
    for group in ladder.meshes:
        first = group[0].settings
        usual = MeshSettings().scaled(group[0].factor)
        assert first == replace(usual, order=first.order, patch_half_width=first.patch_half_width,
                                solver=first.solver, rim_fraction=min(usual.rim_fraction, 1.0),
                                body_fraction=min(usual.body_fraction, 10.0))  # fmt: skip
        patches = tuple(round(one.settings.patch_half_width, 9) for one in group)
        found.append((group[0].family, first.order, group[0].factor, patches, group[0].teeth))
        assert {(one.family, one.factor, one.settings.order, one.teeth) for one in group} == {
            (group[0].family, group[0].factor, first.order, group[0].teeth)
        }
    return found


def test_the_ladder_goes_from_edges_of_four_times_the_usual_to_half_with_pressures_that_the_mesh_resolves():
    found = make_ladder(0.05, ["c_0", "root-stress"], 10)
    ring = [step for step in steps(found) if step[0] == "ring"]
    wide, usual, half, true = 0.36, 0.18, 0.09, 0.05
    many = {2: (2, 2, 3, 3, 4, 4, 4), 3: (2, 3, 3, 4, 4, 4), 4: (3, 3, 4, 4, 4, 4)}  # widths that each mesh resolves
    factors = (4.0, 2.8, 2.0, 1.4, 1.0, 0.7, 0.5)
    assert ring == [
        ("ring", order, factor, (wide, usual, half, true)[:count], 0)
        for order in (2, 3, 4)
        for factor, count in zip(factors, many[order], strict=False)
    ]
    assert steps(found)[len(ring) :] == [
        ("scikit-fem", 4, 1.4, (0.18,), 0),
        *(("sector", 4, 1.4, (0.18,), n) for n in (3, 5, 7, 9)),  # 13 are more than the gear has
    ]
    assert [one.tolerance for one in found.others if one.family == "tolerance"] == [1e-1, 1e-2, 1e-3, 1e-4, 1e-5]
    quick = make_ladder(0.05, ["c_0", "root-stress"], 14, quick=True)
    assert [step[1:4] for step in steps(quick) if step[0] == "ring"] == [
        (2, 4.0, (0.36, 0.18)), (2, 2.0, (0.36, 0.18)), (2, 1.0, (0.36, 0.18, 0.05)), (3, 4.0, (0.36, 0.18)),
        (3, 2.0, (0.36, 0.18)), (4, 2.8, (0.36, 0.18)), (4, 1.4, (0.36, 0.18, 0.05)),
    ]  # fmt: skip
    assert [step[4] for step in steps(quick) if step[0] == "sector"] == [3, 5, 9]
    assert [one.tolerance for one in quick.others if one.family == "tolerance"] == [1e-1, 1e-2, 1e-3]
    assert [step[4] for step in steps(make_ladder(0.05, ["c_0"], 9)) if step[0] == "sector"] == [3, 5, 7]
    assert [step[4] for step in steps(make_ladder(0.05, ["c_0"], 14)) if step[0] == "sector"] == [3, 5, 7, 9, 13]


def test_the_reference_is_finer_than_all_and_its_check_a_step_coarser():
    found = make_ladder(0.05, ["c_0"], 20)
    usual = MeshSettings()
    fine = found.reference.settings
    assert fine == replace(
        usual, order=4, patch_half_width=0.05, flank_edge_length=0.0125, root_edge_length=0.02, root_fraction=0.1,
        tip_edge_length=0.008, junction_edge_length=0.008,
    )  # fmt: skip
    assert found.reference.factor == pytest.approx(0.0125 / usual.flank_edge_length)
    assert found.check.settings == fine.scaled(1.4)
    assert found.check.factor == pytest.approx(1.4 * 0.0125 / usual.flank_edge_length)
    quick = make_ladder(0.05, ["c_0"], 20, quick=True)
    assert quick.reference.settings == fine.scaled(2.0)
    assert quick.check.settings == fine.scaled(2.0 * 1.4)
    # The true contact's half-width within bounds that the mesh resolves; none is taken as wide.
    widths = {0.01: 0.04, 0.06: 0.06, 0.3: 0.08, 0.0: 0.08, math.nan: 0.08}
    assert {
        a: make_ladder(a, ["c_0"], 20).reference.settings.patch_half_width for a in list(widths)[:-1]
    } == {a: b for a, b in widths.items() if not math.isnan(a)}  # fmt: skip
    assert make_ladder(math.nan, ["c_0"], 20).reference.settings.patch_half_width == 0.08


def test_formulas_and_tables_are_tried_for_what_they_know():
    def named(*quantities, **more):
        return [(one.family, one.formula) for one in make_ladder(0.05, quantities, 20, **more).others
                if one.family != "tolerance"]  # fmt: skip

    compliance = [("compliance-formula", name) for name in (*SOURCES, "iso6336-stiffness")]
    stress = [("stress-formula", name) for name in ("cornell-heywood", "cornell-trochoid", "heywood", "iso-6336-3",
                                                    "agma-908", "dolan-broghamer")]  # fmt: skip
    assert named("c_0") == compliance
    assert {family for family, _ in named("root-stress")} == {"stress-formula"}
    assert len(named("root-stress")) == len(stress)
    assert named("c_1", "root-stress") == compliance + named("root-stress")
    assert named("c_0", tabled=True) == [("table", ""), *compliance]
    nothing = make_ladder(0.05, [], 20, tabled=True)
    assert (nothing.meshes, [one.family for one in nothing.others]) == ((), ["table"])
    assert make_ladder(0.05, [], 20).configurations == ()


@pytest.mark.parametrize("quick", [False, True])
def test_the_ladder_of_a_pair_over_its_face(quick):
    found = flank_ladder(6, quick=quick)
    tolerances = (1e-1, 3e-2) if quick else (1e-1, 3e-2, 1e-2)
    groups = [[(one.family, one.panels, one.solid) for one in group] for group in found.meshes]
    expected = []
    for body in ("thin-slices", "coupled-slices", "solid"):
        for tolerance in tolerances:
            usual, last = solid_settings(tolerance), tolerance == tolerances[-1]
            panels = (3, 6, 12) if body == "solid" or last else (6,)
            expected.append([(f"{body}-alone", 6, usual)] * last + [(body, count, usual) for count in panels])
    assert groups == expected
    assert [group[0].body for group in flank_ladder(6, quick=quick, internal=True).meshes] == [
        *["thin-slices"] * len(tolerances), *["solid"] * len(tolerances),
    ]  # fmt: skip
    best = solid_settings(1e-2 if quick else 3e-3)
    assert (found.reference.family, found.reference.solid, found.reference.panels) == ("solid", best, 18)
    assert found.check.solid == replace(best.scaled(1.35), room_share=0.7 * best.room_share)
    assert (found.check.family, found.check.panels) == ("solid", 12)
    assert found.reference.settings == replace(best.section, patch_half_width=best.band_half_width)
    assert found.check.factor == pytest.approx(1.35 * found.reference.factor)
    assert found.reference.factor == best.section.root_edge_length / SolidSettings().section.root_edge_length
    assert [one.panels for one in flank_ladder(2, quick=True).meshes[-1]] == [2, 2, 4]  # no fewer than two
    alone = [one.neighbours for group in found.meshes for one in group]
    assert alone == [not family.endswith("-alone") for group in groups for family, _, _ in group]


def test_what_is_pasted_asks_a_case_for_the_configuration():
    usual = solid_settings(1e-2)
    solid, slices, thin = (
        flank_ladder(6).meshes[i][-1] for i in (8, 5, 2)
    )  # fmt: skip
    assert (solid.solid == SolidSettings()) == (usual == SolidSettings())
    assert solid.paste("I").splitlines() == [
        'pair.I.width = "solid"', "accuracy.tolerance = 0.01", "effects.neighbour_coupling = true",
        "load_distribution.panels = 12",
    ]  # fmt: skip
    assert slices.paste("I").splitlines()[0] == 'pair.I.width = "slices"'
    assert (thin.paste("I"), solid.paste("")) == ("", "")
    assert flank_ladder(6).meshes[6][0].paste("I") == ""  # of coarser gears no line of a case knows
    alone = flank_ladder(6).meshes[8][0]
    assert "effects.neighbour_coupling = false" in alone.paste("I")
    assert Configuration("compliance-formula", formula="cornell").paste("I") == (
        'pair.I.compliance = { source = "cornell" }'
    )
    for nothing in (("iso6336-stiffness", "I"), ("cornell", "")):
        assert Configuration("compliance-formula", formula=nothing[0]).paste(nothing[1]) == ""
    assert Configuration("tolerance", tolerance=1e-2).paste("I") == "accuracy = { tolerance = 0.01 }"
    for order in (2, 4):
        ring = Configuration("ring", replace(MeshSettings().scaled(2.0), order=order, patch_half_width=0.36), 2.0)
        document = tomllib.loads(PAIR) | tomllib.loads(ring.paste("I"))
        from fegear.case.built.tooth_influence import mesh_settings

        read = mesh_settings(build_scene(document, "pasted", CASES).case.accuracy)
        for name in MeshSettings.__dataclass_fields__:
            value = getattr(ring.settings, name)
            assert getattr(read, name) == (value if isinstance(value, str) else pytest.approx(value, rel=1e-5))
    plain = Configuration("sector", MeshSettings(), 1.0, teeth=5)
    assert plain.paste("I") == ""
    assert plain.label == "sector of 5 teeth, order 4, edges x 1, patch 0.18"


# ---- how long it takes -----------------------------------------------------------------------------------------------
def test_the_forecast_adds_gears_answers_and_knobs(pair, monkeypatch):
    ladder = make_ladder(0.05, ["c_0"], 20, quick=True)
    solved = [ladder.reference, ladder.check, *(group[0] for group in ladder.meshes)]

    def gears(count):
        one = [seconds_of_gear(configuration.settings) for configuration in solved]
        assert min(one) < 0.3 < max(one)
        return sum(count * seconds * (3.0 if seconds < 0.3 else 1.0) for seconds in one)

    answers = len(ladder.configurations) + 2
    only = replace(pair, quantities=pair.quantities[:1], pair="")  # c_0
    assert study.forecast(only, ladder) == pytest.approx(gears(1) + 0.02 * answers)
    with_pair = replace(pair, quantities=pair.quantities[3:])  # te-peak-to-peak, tooth-force
    assert study.forecast(with_pair, ladder) == pytest.approx(gears(1) + 0.3 * answers + 3.0)
    motion = replace(pair, quantities=(Quantity("dynamic-factor", "I", "", ""),))
    assert study.forecast(motion, ladder) == pytest.approx(gears(1) + 2.0 * answers + 3.0)
    document = tomllib.loads(PAIR) | {"results": ["stiffness"], "stiffness": {"face_positions": 3}}
    over_face = asked(build_scene(document, "x", CASES))
    more = 12.0 * seconds_of_solid_gear(SolidSettings(), 10.0)
    assert study.forecast(replace(over_face, quantities=()), ladder) == pytest.approx(more)
    two = replace(pair, quantities=pair.quantities[:1], pair="", gear="a")
    monkeypatch.setattr(type(two), "gears", property(lambda _: ("a", "b")))
    assert study.forecast(two, ladder) == pytest.approx(gears(2) + 0.02 * answers)


def test_the_forecast_over_the_face_adds_both_gears_of_each_group_and_every_load():
    scene = read_scene(CASES / "helical_load.toml", ["load_distribution.positions=5", "load_distribution.panels=4"])
    found = asked(scene)
    assert found.over_face
    ladder = study.ladder_of(found, quick=True)
    gears = scene.pairs[found.pair]
    width = gears.face_width / gears.driver.module
    total = 0.012 * 5 * (len(ladder.configurations) + 2)
    for one in (ladder.reference, ladder.check, *(group[0] for group in ladder.meshes)):
        source = "solid" if one.family.startswith("solid") else "slices"
        total += 2.0 * seconds_of_solid_gear(replace(one.solid, source=source), width)
    assert flank_seconds(found, ladder) == pytest.approx(total)
    assert study.forecast(found, ladder) == pytest.approx(total)


def test_short_work_is_done_three_times_and_the_median_counts(monkeypatch):
    from fegear.studies.cost import result

    def clocks(*taken):
        cpu = iter(np.cumsum([x for t in taken for x in (10.0, t)]).tolist())
        wall = iter(np.cumsum([x for t in taken for x in (7.0, 2.0 * t)]).tolist())
        monkeypatch.setattr(result.time, "process_time", lambda: next(cpu))
        monkeypatch.setattr(result.time, "perf_counter", lambda: next(wall))

    calls = []

    def work():
        calls.append(1)
        return len(calls)

    clocks(0.02, 0.07, 0.03)
    assert timed(work) == (3, Seconds(pytest.approx(0.03), pytest.approx(0.06)))
    clocks(0.02)
    assert timed(work, repeat=False) == (4, Seconds(pytest.approx(0.02), pytest.approx(0.04)))
    clocks(0.11)
    assert timed(work) == (5, Seconds(pytest.approx(0.11), pytest.approx(0.22)))
    assert Seconds(1.0, 2.0).plus(Seconds(3.0, 5.0)) == Seconds(4.0, 7.0)


# ---- what is asked ---------------------------------------------------------------------------------------------------
def test_what_is_studied_follows_the_results():
    def names(results, **more):
        found = asked(scene_of(results=results, **more))
        return [one.name for one in found.quantities], found.gear, found.pair, found.mesh

    assert names(["stiffness"]) == (["c_0", "c_1"], "a", "", "")
    assert names(["crosscheck"]) == (["c_0", "root-stress"], "a", "", "")
    assert names(["root-stress-history"]) == (["root-stress"], "a", "", "")
    assert names(["load-sharing", "root-stress"]) == (["root-stress", "tooth-force"], "a", "I", "")
    assert names(["relief", "robustness", "transmission-error"]) == (["te-peak-to-peak"], "", "I", "")
    assert names(["load-sharing"], cost__quantities=["c_1", "c_0", "c_1"])[0] == ["c_1", "c_0"]
    instead = asked(scene_of(results=["geometry"]))
    assert [one.name for one in instead.quantities] == ["te-peak-to-peak", "tooth-force"]
    assert "contain nothing with selectable accuracy" in instead.notes[0]


def test_a_train_is_studied_by_its_mesh_at_one_speed_or_with_its_motion(rig):
    assert [(one.name, one.subject) for one in rig.quantities] == [("root-stress", "test"), ("tooth-force", "I")]
    assert (rig.gear, rig.pair, rig.mesh, rig.pairs, rig.tabled) == ("test", "I", "I", ("I",), True)
    assert rig.quantities[1].meaning == "maximum force on one tooth pair of mesh I at 10000 rpm"
    assert [rig.solves(one) for one in rig.quantities] == [True, False]
    assert [rig.gears_for(one) for one in rig.quantities] == [("test",), ()]
    assert rig.gears == ("test",)
    slow = asked(read_scene(CASES / "four_square_dynamics.toml", ["dynamics.speed=1234.5678 rpm"]))
    assert slow.quantities[1].meaning.endswith("at 1234.57 rpm")
    lin = asked(read_scene(CASES / "lin_dynamic_factor.toml"))
    assert [(one.name, one.subject) for one in lin.quantities] == [("dynamic-factor", "I")]
    assert speed_looked_at(lin) == pytest.approx(9000.0 * math.pi / 30.0)  # the middle of 2000 to 16000
    assert speed_looked_at(rig) == pytest.approx(10000.0 * math.pi / 30.0)


def test_the_load_of_formulas_is_that_of_the_table_or_of_the_pair_and_contacts_are_hertzian():
    assert asked(scene_of()).line_load == 200e3
    document = tomllib.loads(PAIR)
    del document["stiffness"]["load"]
    assert asked(build_scene(document, "x", CASES)).line_load == pytest.approx(4000.0 / 0.02)
    del document["pair"]["I"]["load"]
    bare = asked(build_scene({**document, "results": ["stiffness"]}, "x", CASES))
    assert bare.line_load == 100e3
    assert bare.usual_half_width == pytest.approx(0.02)
    # Hertz's half-width at the pitch point: b^2 = 4 w rho / (pi E*), rho = r sin(alpha) / 2, E* = E / (2 (1 - nu^2)).
    found = asked(scene_of(results=["transmission-error"]))
    assert found.half_width.size == 0
    gear = found.scene.gears["a"]
    rho = 0.5 * 0.02 * math.sin(math.radians(20.0))
    steel = gear.material
    effective = 0.5 * steel.young_modulus / (1.0 - steel.poisson_ratio**2)
    assert found.usual_half_width == pytest.approx(math.sqrt(4.0 * 200e3 * rho / (math.pi * effective)) / 0.002)
    whole = asked(scene_of())
    assert whole.usual_half_width == pytest.approx(float(np.median(whole.half_width)) / 0.002)
    assert math.isnan(replace(bare, half_width=np.empty(0)).usual_half_width)


def test_wide_pairs_are_studied_over_their_face_where_the_plane_has_no_say():
    def over_face(*changes):
        return asked(read_scene(CASES / "helical_load.toml", list(changes)))

    found = over_face()
    assert [one.name for one in found.quantities] == ["te-mean", "te-peak-to-peak", "face-load-factor"]
    assert (found.over_face, found.gear, found.mesh, found.radii.size) == (True, "", "", 0)
    assert math.isnan(found.line_load)
    some = over_face('cost.quantities=["face-load-factor", "te-mean", "te-mean"]')
    assert [one.name for one in some.quantities] == ["face-load-factor", "te-mean"]
    with pytest.raises(InputError, match="applies to a 3D pair and cannot be combined"):
        over_face('cost.quantities=["face-load-factor", "c_0"]')


# ---- formulas as sources ---------------------------------------------------------------------------------------------
def test_a_formula_s_self_compliances_of_a_pair_are_its_pair_compliance(pair):
    gears = pair.scene.pairs["I"]
    x = np.array([-2.0e-3, 0.0, 1.5e-3])
    radii, mirrored = gears.radius(x, "driver"), gears.radius(x, "driven")
    curvature = relative_curvature(*(gears.flank_curvature_radius(x, m) for m in ("driver", "driven")))
    steel = gears.driver.material
    effective = 0.5 * steel.young_modulus / (1.0 - steel.poisson_ratio**2)
    b = np.sqrt(4.0 * 200e3 / (math.pi * effective * curvature))
    for name in ("cornell", "weber-banaschek"):
        both = [ComplianceFormula(name).of_gear("c_0", replace(pair, radii=r, half_width=b)) for r in (radii, mirrored)]
        np.testing.assert_allclose(sum(both), formula_pair(SOURCES[name], gears, x, 200e3).total, rtol=1e-9)
        assert (ComplianceFormula(name).of_gear("c_1", replace(pair, radii=radii)) == 0.0).all()


@pytest.mark.parametrize("load", [200e3, 50e3])
def test_the_stiffness_of_iso_6336_is_shared_by_both_gears(pair, load):
    """c' = .8 C_B / q', q' of z = 20 without shift, dedendum 1.25 m, 20 degrees; below 100 N/mm of F_t/b its law."""
    q = 0.04723 + 0.15551 / 20.0 + 0.25791 / 20.0
    single = 0.8 * (1.0 + 0.5 * (1.2 - 1.25)) / q * 1e9
    single *= pair.scene.gears["a"].material.young_modulus / 206e9
    tangential = load * math.cos(math.radians(20.0))
    single *= min(tangential / 100e3, 1.0) ** 0.25
    source = ComplianceFormula("iso6336-stiffness")
    here = replace(pair, line_load=load)
    np.testing.assert_allclose(source.of_gear("c_0", here), np.full(7, 0.5 / single), rtol=1e-9)
    whole = pair_compliance(here, source)
    np.testing.assert_allclose(whole, np.full(whole.size, 1.0 / (0.02 * single)), rtol=1e-9)
    # Twelve places of a base pitch, those of them with two pairs counted twice: the contact ratio's share.
    assert 12 < whole.size < 24
    assert whole.size == pytest.approx(12.0 * pair.scene.pairs["I"].contact_ratio, abs=1.0)


def test_answers_of_a_pair_by_a_formula_are_those_of_a_run_with_it(pair):
    source = ComplianceFormula("weber-banaschek")
    changes = {
        "pair.I.compliance.source": "weber-banaschek", "effects.neighbour_coupling": False,
        "results": ["transmission-error", "load-sharing"],
    }  # fmt: skip
    run = fegear.run(_document(pair), changes, progress=False)
    here = without_neighbours(pair)
    assert not here.scene.case.effects.neighbour_coupling
    assert pair.scene.case.effects.neighbour_coupling
    te, force = pair.quantities[3:]
    assert answer(here, te, source) == pytest.approx([run.values["I.te_peak_to_peak"].si], rel=1e-6)
    assert answer(here, te, source, 6) == pytest.approx([run.values["I.te_peak_to_peak"].si], rel=1e-6)
    assert answer(here, force, source) == pytest.approx([4000.0])
    assert pair_error(here, source, 6).points.x.size < pair_error(here, source, 16).points.x.size
    assert pair_error(here, source).series.coefficients.size == 65


def _document(found):
    return tomllib.loads(PAIR)


def test_root_stress_formulas_are_per_line_load_of_the_gear_s_size(pair):
    found = StressFormula("iso-6336-3").of_gear("root-stress", pair)
    gear = pair.scene.gears["a"]
    expected = [tooth_root_stress(gear.external_tooth, float(r)).stress / 0.002 for r in pair.radii / 0.002]
    known = np.isfinite(found)
    assert known.any()
    np.testing.assert_allclose(found[known], np.array(expected)[known])
    assert (found[known] > 0.0).all()
    far = replace(pair, radii=np.array([1.0]))
    with pytest.raises(RangeError):
        StressFormula("iso-6336-3").of_gear("root-stress", far)
    with pytest.raises(RangeError, match="is not available with a root-stress formula"):
        StressFormula("iso-6336-3").compliance("I", "driver", pair)
    with pytest.raises(RangeError, match="is not in the pair's table"):
        CaseTable().of_gear("c_0", pair)


def test_the_largest_force_of_a_train_is_that_of_a_run(rig):
    run = fegear.run(CASES / "four_square_dynamics.toml", {"results": ["tooth-force"]}, progress=False)
    data = train_of(rig, CaseTable())
    found = largest_force(rig, data)
    own = run.values["I.largest_tooth_force_own_mesh"].si
    assert found == pytest.approx(own, rel=5e-3)
    assert answer(rig, rig.quantities[1], CaseTable()) == pytest.approx([found], rel=1e-12)
    with_many = read_scene(CASES / "four_square_dynamics.toml", ["dynamics.harmonics=300"])
    many = largest_force(replace(rig, scene=with_many), data)  # no fewer than the case itself asks for
    assert many == pytest.approx(largest_force(rig, data, 300), rel=1e-12)
    assert found == pytest.approx(largest_force(rig, data, 255), rel=1e-3)
    assert largest_force(rig, data, 2) != pytest.approx(found, rel=1e-6)
    assert largest_force(rig, data, 2, 11) <= largest_force(rig, data, 2, 401)  # fewer places meet it less well


def test_the_dynamic_factor_at_a_speed_is_that_of_a_run():
    changes = ["effects.parametric=false", "effects.contact_loss=true"]
    lin = asked(read_scene(CASES / "lin_dynamic_factor.toml", changes))
    data = train_of(lin, ComplianceFormula("cornell"))
    found = factor_at(lin, data, 9000.0 * math.pi / 30.0, 1e-4)
    run = fegear.run(
        CASES / "lin_dynamic_factor.toml",
        {"results": ["dynamic-factor"], "effects.parametric": False, "dynamics.speeds": ["9000 rpm"]}, progress=False,
    )  # fmt: skip
    assert found == pytest.approx(float(run.tables["dynamic_factor_I"]["dynamic_factor"][0]), rel=1e-3)


# ---- one setting at a time -------------------------------------------------------------------------------------------
def test_settings_of_load_sharing_are_varied_one_at_a_time_and_jumps_cost_even_positions_their_order(pair):
    found = {(one.quantity, one.name): one for one in knobs.pair_knobs(pair, ComplianceFormula("weber-banaschek"))}
    even, between = "positions per base pitch, equally spaced", "Gauss points per interval between discontinuities"
    te, stiffness = "te-harmonics", "stiffness-harmonics"
    sums = "harmonics of the transmission error"
    assert list(found) == [
        ("te-peak-to-peak", even), ("te-peak-to-peak", between), ("te-peak-to-peak", sums),
        (te, even), (te, between), (stiffness, even), (stiffness, between),
    ]  # fmt: skip
    for (quantity, name), knob in found.items():
        if name == even:
            assert knob.settings.tolist() == [8, 13, 21, 34, 55, 89, 144, 233, 377, 610]
            assert knob.order.slope == pytest.approx(1.0, abs=0.1)  # the mesh stiffness jumps
            assert (knob.error[:-1] / knob.error[1:] < 3.0).all()
        elif name == between:
            assert knob.settings.tolist() == [2, 3, 4, 6, 8, 12, 16]
            assert knob.error[1:].max() < 1e-8
        else:
            assert knob.settings.tolist() == [2, 4, 8, 16, 32, 64]
            assert 0.1 < knob.error.min() < knob.error[0] == knob.error.max() < 0.25  # Gibbs: none of them reaches it
        assert 0.0 < knob.floor < 1e-8
        assert knob.floor == found["te-peak-to-peak" if quantity == "te-peak-to-peak" else quantity, even].floor
        np.testing.assert_allclose(knob.step, 1.0 / knob.settings)


def test_settings_of_a_train_are_varied_one_at_a_time(rig, monkeypatch):
    calls = []

    def force(asked, data, harmonics, positions):
        calls.append((harmonics, positions))
        return 100.0 * (1.0 + 3.0 / harmonics**2 - 1.0 / positions)

    def factor(asked, data, speed, tolerance):
        assert speed == pytest.approx(10000.0 * math.pi / 30.0)
        return 2.0 * (1.0 - tolerance)

    monkeypatch.setattr(knobs, "train_of", lambda asked, source: "train")
    monkeypatch.setattr(knobs, "largest_force", force)
    monkeypatch.setattr(knobs, "factor_at", factor)
    both = replace(rig, quantities=(rig.quantities[1], Quantity("dynamic-factor", "I", "", "")))
    harmonics, positions, tolerance = knobs.pair_knobs(both, CaseTable())
    best = 1.0 + 3.0 / 512**2 - 1.0 / 401
    assert harmonics.settings.tolist() == [4, 8, 16, 32, 64, 128]
    np.testing.assert_allclose(harmonics.error, [(1 + 3 / n**2 - 1 / 401) / best - 1 for n in harmonics.settings])
    assert positions.settings.tolist() == [11, 21, 41, 81, 161]
    np.testing.assert_allclose(positions.error, [1 - (1 + 3 / 512**2 - 1 / n) / best for n in positions.settings])
    assert tolerance.settings.tolist() == tolerance.step.tolist() == [1e-2, 1e-3, 1e-4, 1e-5]
    np.testing.assert_allclose(tolerance.error, [(t - 1e-8) / (1.0 - 1e-8) for t in tolerance.settings], rtol=1e-9)
    assert tolerance.at == "at 10000 rpm, relative to 1e-08"
    assert (tolerance.seconds >= 0.0).all()
    assert [one.quantity for one in (harmonics, positions, tolerance)] == ["tooth-force"] * 2 + ["dynamic-factor"]
    assert knobs.pair_knobs(replace(both, mesh=""), CaseTable()) == []


def test_settings_of_a_solid_gear_are_varied_one_at_a_time(pair, monkeypatch):
    """Each set stands for a number; the last of each kind is what the others are compared with."""

    class Bands:
        def __init__(self, settings):
            self.size = settings.section.root_edge_length * settings.waves_per_module
            self.settings = settings

        def apart(self, other):
            off = abs(other.size / self.size - 1.0)
            return {name: np.array([0.1 * off, k * off]) for k, name in enumerate(knobs._NAMES, start=1)}

    monkeypatch.setattr(knobs, "_answer", lambda asked, settings: Bands(settings))
    usual = SolidSettings()
    edge = usual.section.root_edge_length
    found = knobs.solid_knobs(pair)
    assert [(one.name, one.quantity) for one in found] == [
        (name, quantity)
        for name in ("edges of the section", "functions per module of face", "edges of the section, slices")
        for quantity in (
            "c_0 over the face width",
            "c_1 over the face width",
            "root stress (tension side) over the face width",
        )
    ]
    factors, waves = np.array([1.5, 1.25, 1.0, 0.8]), np.array([0.75, 1.0, 1.5, 2.0])
    for k, knob in enumerate(found[:3], start=1):
        np.testing.assert_allclose(knob.settings, edge * factors)
        np.testing.assert_allclose(knob.step, knob.settings)
        np.testing.assert_allclose(knob.error, k * (factors / 0.6 - 1.0))
        assert knob.at == (
            f"{usual.waves_per_module:g} functions per module of face, relative to 0.12; largest of the bands"
        )
    for k, knob in enumerate(found[3:6], start=1):
        np.testing.assert_allclose(knob.settings, waves)
        np.testing.assert_allclose(knob.step, 1.0 / waves)
        np.testing.assert_allclose(knob.error, k * (1.0 - waves / 3.0))
        assert knob.at == f"edges of {edge:g} modules, relative to 3; largest of the bands"
    for k, knob in enumerate(found[6:], start=1):
        np.testing.assert_allclose(knob.settings, edge * factors)
        np.testing.assert_allclose(knob.error, k * abs(factors - 1.0), atol=1e-12)
        assert knob.at.endswith("relative to 3D gear; largest of the bands")
        assert knob.seconds.size == 4


def test_edges_patches_and_sectors_are_varied_with_the_answers_of_the_ladder(pair, monkeypatch):
    """Answers are made of settings: edges err by their square, patches by their width, sectors by 3 over teeth."""
    only = replace(pair, quantities=pair.quantities[:1], pair="")
    ladder = make_ladder(0.05, ["c_0"], 20)

    def value(patch):
        return np.array([2.0, 4.0]) * (1.0 + patch)

    best = SimpleNamespace(solved={"a": SolvedGear(MeshSettings())})
    monkeypatch.setattr(knobs, "answer", lambda asked, quantity, source: value(
        source.solved["a"].settings.patch_half_width))  # fmt: skip
    found = measure.Found(only)
    found.mesh_floors, found.floors = {"c_0": 1e-9}, {"c_0": 1e-8}
    for one in ladder.configurations:
        if one.settings is not None:
            answered = value(one.settings.patch_half_width) * (1.0 + 0.01 * one.factor**2)
            found.values[one, "c_0"] = answered
            off = Miss(9.0, 3.0 / one.teeth if one.teeth else 0.0, 1.0)
            found.rows.append(Measured(one, "c_0", 1.0, off, Seconds(one.factor, 0.0), Seconds(0.5, 0.0)))
    edges = knobs.ladder_knobs(found, ladder, best)
    assert [one.name for one in edges] == [
        "edge length, order 2", "edge length, order 3", "edge length, order 4", "patch half-width",
        "number of teeth of a sector with free sides",
    ]  # fmt: skip
    for knob, finest, patch in zip(edges, (0.5, 0.7, 0.7), (0.18, 0.18, 0.09), strict=False):
        factors = np.array([4.0, 2.8, 2.0, 1.4, 1.0, 0.7, 0.5])
        factors = factors[factors >= finest]
        np.testing.assert_allclose(knob.settings, factors * MeshSettings().root_edge_length)
        np.testing.assert_allclose(knob.error, 0.01 * factors**2)
        np.testing.assert_allclose(knob.seconds, factors + 0.5)
        assert knob.order.slope == pytest.approx(2.0)
        assert knob.floor == 1e-9
        assert f"patch {patch:g} modules" in knob.at
    widths = 0.36 / 2.0 ** (np.arange(6) / 2.0)
    np.testing.assert_allclose(edges[3].settings, widths[:-1])
    np.testing.assert_allclose(edges[3].error, (widths[:-1] - widths[1:]) / (1.0 + widths[1:]))
    assert np.isnan(edges[3].seconds).all()
    assert edges[4].settings.tolist() == [3, 5, 7, 9, 13]
    np.testing.assert_allclose(edges[4].error, 3.0 / edges[4].settings)
    np.testing.assert_allclose(edges[4].step, 1.0 / edges[4].settings)
    assert (edges[4].floor, edges[4].order.slope) == (1e-8, pytest.approx(1.0))
    assert (edges[4].seconds == 1.9).all()


# ---- measuring -------------------------------------------------------------------------------------------------------
class Sized:
    """A source whose answers are a number times what is right; it refuses root stress."""

    def __init__(self, size):
        self.size = size


RIGHT = {"c_0": np.array([1.0, -2.0]), "te-peak-to-peak": np.array([5.0]), "tooth-force": np.array([7.0])}


@pytest.fixture
def measured(pair, monkeypatch):
    """Answers by size; works are measured to take 1, 2, 3 ... seconds."""
    counts = iter(range(1, 100))

    def respond(asked, quantity, source, order=16):
        if quantity.name == "root-stress":
            raise FegearError("x", "y", "is refused here")
        if quantity.name == "c_1":
            return np.array([math.nan, math.nan])
        return RIGHT[quantity.name] * source.size

    monkeypatch.setattr(measure, "answer", respond)
    monkeypatch.setattr(measure, "pair_compliance", lambda asked, source: np.array([3.0]) * source.size**2)
    monkeypatch.setattr(measure, "timed", lambda work, repeat=True: (work(), Seconds(float(next(counts)), 0.5)))
    monkeypatch.setattr(measure, "solve_gears", lambda asked, one: ({"a": one}, {"a": Seconds(40.0, 4.0)}))
    monkeypatch.setattr(
        measure, "finite_elements", lambda asked, one, solved: Sized(SIZES[one.label, solved["a"].label])
    )
    return measure.Found(pair)


SIZES: dict[tuple[str, str], float] = {}


def plain(factor, patch=0.18):
    return Configuration("ring", replace(MeshSettings(), patch_half_width=patch), factor)


def test_the_reference_is_doubted_by_a_coarser_mesh_and_a_wider_pressure_together_and_by_the_mesh_alone(measured):
    best, check, wider = plain(1.0), plain(2.0), plain(2.0, 1.25 * 0.18)
    SIZES.update({
        (best.label, best.label): 1.0, (wider.label, check.label): 1.1, (check.label, check.label): 0.95,
    })  # fmt: skip
    measured.asked = replace(measured.asked, quantities=tuple(
        one for one in measured.asked.quantities if one.name in RIGHT))  # fmt: skip
    source = measure.refer(measured, SimpleNamespace(reference=best, check=check))
    assert source.size == 1.0
    assert measured.compliance.tolist() == [3.0]
    assert {name: values.tolist() for name, values in measured.reference.items()} == {
        name: values.tolist() for name, values in RIGHT.items()
    }
    assert list(measured.floors.values()) == pytest.approx([0.1] * 3)
    assert list(measured.mesh_floors.values()) == pytest.approx([0.05] * 3)
    SIZES[wider.label, check.label] = 1.0
    measure.refer(measured, SimpleNamespace(reference=best, check=check))
    assert set(measured.floors.values()) == {1e-13}  # what statics decides is not known better than round-off


def test_a_configuration_is_charged_for_its_gears_and_its_answer_and_judged_by_its_compliance_too(measured):
    measured.reference, measured.compliance = {**RIGHT, "c_1": RIGHT["c_0"], "root-stress": None}, np.array([3.0])
    SIZES[plain(1.0).label, plain(1.0).label] = 1.2
    measure.measure_meshes(measured, (plain(1.0),))
    rows = {row.quantity: row for row in measured.rows}
    assert list(rows) == ["c_0", "c_1", "root-stress", "te-peak-to-peak", "tooth-force"]
    assert [rows[name].miss.largest for name in RIGHT] == pytest.approx([0.2] * 3)
    assert [rows[name].value for name in RIGHT] == pytest.approx([-2.4, 6.0, 8.4])
    assert (rows["root-stress"].reason != "", rows["root-stress"].miss.answered) == (True, 0.0)
    assert "is refused here" in rows["root-stress"].reason
    assert math.isnan(rows["root-stress"].value)
    assert math.isnan(rows["c_1"].value)
    assert {row.solve.cpu for row in rows.values()} == {40.0}
    assert [rows[name].own.cpu for name in rows] == [1.0, 2.0, 0.0, 3.0, 4.0]
    assert [rows[name].fixed.cpu for name in rows] == [0.0, 0.0, 0.0, 3.0, 4.0]
    assert [rows[name].compliance_error for name in rows] == pytest.approx([0.0, 0.0, 0.0, 0.44, 0.44])
    assert rows["te-peak-to-peak"].seconds == Seconds(43.0, 4.5)
    assert rows["te-peak-to-peak"].compared == 40.0
    assert rows["c_0"].compared == 41.0
    assert set(measured.values) == {(plain(1.0), name) for name in (*RIGHT, "c_1")}


def test_what_has_no_compliance_is_right_by_luck_and_what_needs_none_is_not(measured, monkeypatch):
    def refuse(asked, source):
        raise FegearError("x", "y", "Version of the case file format; newer versions")

    monkeypatch.setattr(measure, "pair_compliance", refuse)
    assert measure._compliance_error(measured, measured.asked, Sized(1.0)) == 0.0
    measured.compliance = np.array([3.0])
    assert measure._compliance_error(measured, measured.asked, Sized(1.0)) == math.inf


def test_each_configuration_is_asked_for_what_it_knows(pair, rig):
    def names(studied, family):
        return [one.name for one in measure.answered(studied, Configuration(family))]

    every = ["c_0", "c_1", "root-stress", "te-peak-to-peak", "tooth-force"]
    assert names(pair, "ring") == names(pair, "sector") == names(pair, "tolerance") == every
    assert names(pair, "compliance-formula") == ["c_0", "c_1", "te-peak-to-peak", "tooth-force"]
    assert names(pair, "stress-formula") == ["root-stress"]
    assert names(pair, "table") == []
    assert (names(rig, "ring"), names(rig, "table")) == (["root-stress"], ["tooth-force"])


def test_gears_of_one_shape_are_solved_once(pair, monkeypatch):
    solved = []
    monkeypatch.setattr(measure, "_solve", lambda gear, settings, reach, teeth: solved.append((gear, reach, teeth)))
    document = tomllib.loads(PAIR)
    document["gear"]["b"] = {**document["gear"]["a"], "face_width": "30 mm"}  # a plane problem knows no width
    document["gear"]["c"] = {**document["gear"]["a"], "profile_shift": 0.1}
    document["pair"]["I"]["driven"] = "b"
    document["pair"]["II"] = {"driver": "c", "driven": "b", "load": "4000 N"}
    scene = build_scene(document, "x", CASES)
    two = replace(pair, scene=scene)
    found, seconds = measure.solve_gears(two, Configuration("sector", MeshSettings(), 1.0, teeth=7))
    assert list(found) == ["a", "b"]
    assert [teeth for _, _, teeth in solved] == [7] * len(solved)
    assert len({gear.face_width for gear, _, _ in solved}) == 1
    assert seconds["b"] == Seconds(0.0, 0.0)
    assert seconds["a"].cpu >= 0.0
    with pytest.raises(ValueError, match="is not an FE configuration"):
        measure.solve_gears(two, Configuration("tolerance", tolerance=1e-2))


def test_scikit_fem_s_time_is_compared_on_the_same_mesh_and_quantity():
    settings = MeshSettings()
    by, like, other = (
        Configuration(family, replace(settings, solver=solver, order=order), 1.4)
        for family, solver, order in (
            ("scikit-fem", "scikit-fem", 4),
            ("ring", "condensed", 4),
            ("ring", "condensed", 3),
        )
    )

    def row(one, quantity, seconds):
        return Measured(one, quantity, 1.0, Miss(0.0, 0.0, 1.0), Seconds(seconds, 0.0))

    rows = [row(other, "c_0", 1.0), row(like, "c_1", 9.0), row(like, "c_0", 2.0), row(by, "c_0", 7.0)]
    assert "takes 7 s of CPU time, 3.5 times the 2 s of nested dissection" in study._saved_by_condensation(rows)
    assert study._saved_by_condensation(rows[:3]) == study._saved_by_condensation([rows[0], rows[3]]) == ""


# ---- tables, figures and words of rows -------------------------------------------------------------------------------
@pytest.fixture(scope="module")
def results(pair):
    """Two quantities by four configurations; errors and seconds as given here."""
    studied = replace(pair, quantities=(pair.quantities[0], pair.quantities[3]))
    ring = [Configuration("ring", replace(MeshSettings(), order=order), 1.0) for order in (2, 3)]
    formula = Configuration("compliance-formula", formula="cornell")
    tolerance = Configuration("tolerance", tolerance=1e-2)
    rows = []
    for one, error, answered, spent, doubt in (
        (ring[0], 0.05, 1.0, 1.0, 0.0), (ring[1], 1e-6, 1.0, 4.0, 0.0), (formula, 0.3, 0.5, 0.01, 0.2),
        (tolerance, 1e-3, 1.0, 0.5, 0.0),
    ):  # fmt: skip
        gear = Seconds(spent, 2.0 * spent)
        rows.append(Measured(one, "c_0", 3e-11, Miss(error, error / 2, answered), gear, Seconds(0.1, 0.1)))
        te = Miss(error / 10.0, error / 10.0, 1.0)
        fixed = Seconds(0.7, 0.8)
        rows.append(Measured(one, "te-peak-to-peak", 4e-6, te, gear, fixed, "", doubt, fixed))
    rows.append(Measured(ring[0], "x", math.nan, Miss(math.nan, math.nan, 0.0), reason="refused"))
    knob = make_knob("c_0", "edge length, order 2", "fine", [4.0, 2.0, 1.0], [4.0, 2.0, 1.0], [0.16, 0.04, 0.01], 1e-5)
    return CostResults(
        studied, ring[1], {"c_0": 3e-11, "te-peak-to-peak": 4e-6}, {"c_0": 1e-4, "te-peak-to-peak": 1e-3},
        tuple(rows[:-1]), (knob,), 4, 12.4, ("Noted.",),
    )  # fmt: skip


def written(table, folder):
    write_table(folder, table)
    with (folder / f"{table.name}.csv").open(newline="", encoding="utf-8") as stream:
        return list(csv.DictReader(stream))


def test_the_table_of_configurations_rises_in_time_and_claims_no_error_below_the_reference_s(results):
    table = cost_table(results)
    column = {one.name: list(one.values) for one in table.columns}
    assert column["quantity"] == ["c_0"] * 4 + ["te-peak-to-peak"] * 4
    assert column["family"] == ["compliance-formula", "tolerance", "ring", "ring"] * 2
    assert column["seconds"] == pytest.approx([0.11, 0.6, 1.1, 4.1, 0.71, 1.2, 1.7, 4.7])
    assert column["seconds_wall"] == pytest.approx([0.12, 1.1, 2.1, 8.1, 0.82, 1.8, 2.8, 8.8])
    assert column["seconds_solving"] == [0.01, 0.5, 1.0, 4.0] * 2
    assert column["seconds_fixed"] == [0.0] * 4 + [0.7] * 4
    np.testing.assert_allclose(column["error"], [math.nan, 1e-3, 0.05, 1e-4, 0.03, 1e-3, 5e-3, 1e-3])
    np.testing.assert_allclose(column["error_where_answered"], [0.3, 1e-3, 0.05, 1e-4, 0.03, 1e-3, 5e-3, 1e-3])
    assert column["below_floor"] == [0, 0, 0, 1, 0, 1, 0, 1]
    assert column["floor"] == [1e-4] * 4 + [1e-3] * 4
    assert column["compliance_error"] == [0.0] * 4 + [0.2, 0.0, 0.0, 0.0]
    assert column["answered"] == [0.5, 1.0, 1.0, 1.0] + [1.0] * 4
    # The formula leaves positions out; a tolerance stands apart.
    assert column["on_front"] == [0, 0, 1, 1, 1, 0, 1, 1]
    assert column["value"] == pytest.approx([3e-2] * 4 + [4.0] * 4)
    assert column["unit"] == ["um.mm/N"] * 4 + ["um"] * 4
    np.testing.assert_array_equal(column["order"], [math.nan, math.nan, 2.0, 3.0] * 2)
    np.testing.assert_array_equal(column["root_edge_length"], [math.nan, math.nan, 0.055, 0.055] * 2)
    assert column["teeth"] == column["panels"] == [0] * 8
    assert column["case_line"][0] == 'pair.I.compliance = { source = "cornell" }'


def test_the_cheapest_is_told_for_each_tolerance_and_for_all_quantities_at_once(results, tmp_path):
    rows = written(tables(results)[3], tmp_path)
    assert [(row["quantity"], float(row["tolerance"])) for row in rows] == [
        (name, tolerance) for name in ("c_0", "te-peak-to-peak", ALL) for tolerance in (1e-1, 1e-2, 1e-3, 1e-4, 1e-5)
    ]
    orders = [
        row["configuration"].split("order ")[1][0] if "order" in row["configuration"] else row["configuration"]
        for row in rows
    ]
    none = "not reached"
    # A formula with a compliance 20 % off has met no tolerance; the reference knows c_0 to 1e-4 and the error to 1e-3.
    assert orders == ["2", "3", "3", "3", none, "2", "2", "3", none, none, "2", "3", "3", none, none]
    seconds = [float(row["seconds [s]"]) if row["seconds [s]"] else None for row in rows]
    assert seconds[:5] == [1.1, 4.1, 4.1, 4.1, None]
    assert seconds[10:12] == [1.8, 4.8]  # the gears once, both answers
    assert [float(row["error"]) for row in rows[10:12]] == [0.05, 1e-3]
    lines = cheapest_lines(results)
    assert lines[0] == "c_0 (error of the reference: 1e-04):"
    assert lines[1] == "  1e-01        1.1 s  full gear, order 2, edges x 1, patch 0.18"
    assert lines[12] == "all:"
    assert [line.endswith("not reached") for line in lines].count(True) == orders.count(none)
    assert (results.finished, results.complete) == (4, True)
    assert not replace(results, planned=5).complete


def test_orders_and_knobs_stand_row_by_row(results, tmp_path):
    _, orders, turned, _ = tables(results)
    (order,) = written(orders, tmp_path)
    assert float(order["order"]) == pytest.approx(2.0)
    assert (order["configurations_used"], order["configurations"]) == ("3", "3")
    rows = written(turned, tmp_path)
    assert [float(row["setting"]) for row in rows] == [4.0, 2.0, 1.0]
    assert [float(row["error"]) for row in rows] == [0.16, 0.04, 0.01]
    assert {(row["quantity"], row["floor"], row["seconds [s]"]) for row in rows} == {("c_0", "1e-05", "")}


def test_figures_show_every_configuration_the_front_and_what_the_reference_does_not_know(results):
    together, c_0, te, turned = cost_figures(results)
    assert (together.key, c_0.key, te.key, turned.key) == (
        "cost", "cost_c_0", "cost_te-peak-to-peak", "cost_knobs",
    )  # fmt: skip
    assert (len(together.panels), together.columns) == (2, 2)
    (panel,) = c_0.panels
    drawn = {item.name: item for item in panel.items}
    assert list(drawn["ring, order 2"].x) == [1.1]
    assert list(drawn["ring, order 3"].y) == [1e-4]
    assert list(drawn["closed form"].y) == [0.3]
    assert drawn["closed form"].notes == ("cornell (50 % of the flank)",)
    assert list(drawn["selected by accuracy.tolerance, including error estimation"].x) == [0.6]
    assert (drawn["ring, order 2"].size, drawn["closed form"].size) == (5.0, 8.0)
    assert [drawn[name].written for name in ("ring, order 2", "closed form")] == [False, True]
    front = drawn["Pareto front"]
    assert (list(front.x), list(front.y)) == ([1.1, 4.1], [0.05, 1e-4])
    zone, mark = panel.marks
    assert (zone.axis, zone.low, zone.high) == ("y", pytest.approx(0.3e-4), 1e-4)
    assert (mark.axis, mark.at) == ("y", 1e-4)
    assert "(1e-04)" in c_0.caption
    (knob,) = turned.panels
    assert knob.title == "order: c_0 2.0"
    assert list(knob.items[0].y) == [0.16, 0.04, 0.01]
    page = cost_page(results, cost_figures(results))
    assert page.note == "4 of 4 configurations in 12 s"
    assert [section.title for section in page.sections] == [
        "Cheapest settings for a tolerance", "Cost of c_0", "Cost of te-peak-to-peak", "Influence of each setting",
        "All configurations",
    ]  # fmt: skip
    assert len(page.sections[0].blocks) == 4


@dataclass(frozen=True)
class SolvedGear:
    """What knobs replace the settings of."""

    settings: MeshSettings


@pytest.mark.parametrize(
    ("quantities", "stages"),
    [(None, ()), (["c_0", "root-stress"], ()), (["te-peak-to-peak"], ("loaded-pair",)),
     (["te-mean"], ("loaded-flanks",)), (["tooth-force", "face-load-factor"], ("loaded-pair", "loaded-flanks")),
     (["dynamic-factor"], ("loaded-pair", "motion"))],
)  # fmt: skip
def test_effects_of_what_is_studied_are_those_of_its_stages(quantities, stages):
    assert CostPart(quantities=quantities).stages == stages


@pytest.mark.parametrize(("width", "fits"), [(0.1, True), (6.0, False)])
def test_contacts_that_are_wider_than_any_place_of_the_flanks_are_refused(monkeypatch, width, fits):
    """Half-widths in modules, the same at every position."""
    tooth = Tooth(25, BasicRack(1.0, 1.25, 0.25))
    pair = GearPair(*(Gear(tooth, 2e-3, 10e-3, 20e-3) for _ in range(2)))
    monkeypatch.setattr(crosscheck, "contact_half_width", lambda _pair, x, _load: np.full(x.shape, 2e-3 * width))
    if fits:
        crosscheck.refuse_wide_contacts(pair, 2e5, "pair.I.load")
    else:
        with pytest.raises(InputError, match=r"pair.I.load = 200 N/mm: gives a contact half-width of at least 12 mm"):
            crosscheck.refuse_wide_contacts(pair, 2e5, "pair.I.load")
