"""The helical case files, run as users run them."""

import json
import math
from pathlib import Path

import numpy as np
import pytest
from solved_once import CACHE

from fegear.base.errors import InputError
from fegear.case.reading import read_scene
from fegear.cli import program
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

CASES = Path(__file__).parents[2] / "cases"


def run(name, *overrides):
    scene = read_scene(CASES / f"{name}.toml", overrides)
    results = run_plan(scene, make_plan(scene, STAGES), cache=CACHE)
    tables = {table.name: {column.name: column.values for column in table.columns} for table in results.tables}
    return tables, {value.name: value.value for value in results.values}, results


@pytest.mark.dear(
    "litvin_lead-kinds1-4.3015",
    "litvin_combined-kinds3-1.4386",
    "litvin_localised-kinds4-12.3332",
    "sources/litvin_fig07-kinds5-1.5356",
    "sources/litvin_fig09-kinds6-0.0",
)
@pytest.mark.parametrize(
    ("name", "kinds", "peak_to_peak"),
    [
        ("litvin_shaft_angle", {"gear tip", "gear face end", "pinion face end", "corner"}, 4.3000),
        ("litvin_lead", {"gear tip", "pinion face end", "corner"}, 4.3015),
        ("litvin_profile_angle", {"gear tip"}, 0.0),
        ("litvin_combined", {"pinion tip", "gear face end", "pinion face end", "corner"}, 1.4386),
        # A dense search finds 12.33324; the bottom lies where another pair takes the lead.
        ("litvin_localised", {"surface", "gear face end", "pinion face end"}, 12.3332),
        # tests/closed_form/test_tooth_contact_closed_form.py finds these extremes by plain search.
        ("sources/litvin_fig07", {"pinion face end", "corner"}, 1.5356),
        ("sources/litvin_fig09", {"surface"}, 0.0),
    ],
)
def test_litvin_cases(name, kinds, peak_to_peak):
    tables, values, _ = run(name)
    table = tables["tooth_contact_I"]
    assert list(table)[:7] == ["phi1", "te", "contact", "r1", "z1", "r2", "z2"]
    assert len(table["phi1"]) == 400
    assert set(table["contact"]) <= kinds
    assert values["I.unloaded_te_peak_to_peak"] == pytest.approx(peak_to_peak, abs=2e-4)
    # 400 samples of pieces with slopes up to 50 arcsec per pitch come that near to the exact extremes.
    assert np.ptp(table["te"]) == pytest.approx(peak_to_peak, abs=0.15)


def test_without_the_effect_the_drive_is_aligned_or_the_table_refused():
    with pytest.raises(InputError, match="effect is off"):
        run("litvin_lead", "effects.misalignment=false")
    _, values, results = run("litvin_lead", "pair.I.misalignment={ lead_angle = '0 deg' }")
    assert values["I.unloaded_te_peak_to_peak"] < 1e-6
    assert any("ill-defined" in remark for remark in results.remarks)


@pytest.mark.dear
def test_a_lead_error_counts_by_equation_18():
    """TM-107451, Eq. 18; the lead of the pinion that Appendix 2 then makes is told beside it."""
    _, by_lead, results = run("sources/litvin_eq18", "tooth_contact.positions=20")
    _, by_angle, _ = run("litvin_lead", "tooth_contact.positions=20")
    assert by_lead["I.lead_angle_error"] == pytest.approx(180.0, abs=1e-3)
    assert by_lead["I.unloaded_te_peak_to_peak"] == pytest.approx(by_angle["I.unloaded_te_peak_to_peak"], rel=1e-5)
    assert by_lead["I.lead_error_as_cut"] == pytest.approx(0.75 * 1.92979, rel=3e-3)
    told = "\n".join(results.remarks)
    angle = told.split('lead_angle = "')[1].split('"')[0]
    _, exact, _ = run("litvin_lead", f"pair.I.misalignment.lead_angle='{angle}'", "tooth_contact.positions=20")
    assert exact["I.lead_error_as_cut"] == pytest.approx(1.92979, rel=1e-7), "the angle told in words"


def test_contact_lines_of_the_aligned_drive():
    tables, values, results = run("sources/litvin_fig01")
    lines, length = tables["contact_lines_I"], tables["contact_line_length_I"]
    assert list(lines)[:4] == ["line", "phi1", "u1", "theta1"]
    # (A.1.1) for the left-hand pinion, with the parameters of the table alone.
    rb, p = 30 * 5.08 / 2 / math.cos(math.radians(30)), 957.5574402 / (2.0 * math.pi)
    rb *= math.cos(math.atan(math.tan(math.radians(20)) / math.cos(math.radians(30))))
    slant = math.atan2(p, rb)
    assert lines["r1"] == pytest.approx(np.hypot(rb, lines["u1"] * math.cos(slant)), rel=1e-9)
    assert lines["z"] == pytest.approx(p * np.radians(lines["theta1"]) - lines["u1"] * math.sin(slant), abs=1e-7)
    assert (length["length"].min(), length["length"].max()) == pytest.approx(
        (values["I.contact_line_least"], values["I.contact_line_largest"]), rel=1e-6
    )
    assert not results.remarks
    extra = ("effects.misalignment=true", "pair.I.misalignment={ shaft_angle = '3 arcmin' }")
    _, same, results = run("sources/litvin_fig01", *extra)
    assert same == values
    assert "Pair I: contact lines of the aligned," in results.remarks[0]


def test_contact_lines_of_spur_gears_have_no_u():
    spur = [f"gear.{g}.{key}" for g in ("pinion", "gear") for key in ("helix_angle='0 deg'", "hand='spur'")]
    tables, _, results = run("sources/litvin_fig01", *spur)
    assert {"u1", "u2"} & set(tables["contact_lines_I"]) == set()
    assert "Pair I: contact lines of spur gears are" in results.remarks[0]


def test_generation_of_flanks():
    """TM-107451, Appendices 1, 2 and 5: what is tabled obeys the printed equations."""
    tables, values, results = run("sources/litvin_fig10")
    assert values["I.generated_apart"] < 1e-9
    design, pinion = tables["flank_design_I"], tables["generated_flank_I_pinion"]
    assert list(design["gear"]) == ["pinion", "gear"], "a shaft angle does not change the pinion as cut"
    assert np.tan(np.radians(design["lambda_b"])) * design["r_b"] == pytest.approx(design["p"], rel=1e-12)
    assert design["mu"] + design["eta"] == pytest.approx(180.0 / design["teeth"], rel=1e-12)
    assert 2.0 * design["s_t"] * design["teeth"] == pytest.approx(2.0 * math.pi * design["r_p"], rel=1e-12)
    assert design["s_t"] == pytest.approx(design["w_t"], rel=1e-12)
    assert pinion["r"].min() >= 83.0
    assert pinion["r"].max() == pytest.approx(design["r_p"][0] + 5.08, rel=1e-9)
    assert sorted(set(np.round(pinion["z"], 9))) == pytest.approx([-20.32, 0.0, 20.32], abs=1e-9)
    assert np.hypot(np.hypot(pinion["nx"], pinion["ny"]), pinion["nz"]) == pytest.approx(1.0, rel=1e-12)
    u, a_c = pinion["u"], 0.08 / 25.4
    sin, cos = math.sin(math.radians(20.0)), math.cos(math.radians(20.0))  # A.5.14
    lead = u * (1.0 + 2.0 * (a_c * u) ** 2) * math.cos(math.radians(30.0)) / (sin - 2.0 * a_c * u * cos)
    way = 0.5 * pinion["l"] + values["I.rack_half_width"] * math.cos(math.radians(30.0)) - lead
    assert design["r_p"][0] * np.radians(pinion["psi"]) == pytest.approx(way, abs=1e-9)
    assert not results.remarks
    figures = {figure.key for outcome in results.outcomes.values() for figure in outcome.figures}
    assert figures == {
        f"{key}_I" for key in ("rack_cutters", "cutter_surfaces", "cutter_frames", "generation", "sections", "frames")
    }


def test_generation_of_wrong_crowned_and_spur_flanks():
    wrong = ("pair.I.misalignment={ lead_angle = '3 arcmin' }", "pair.I.modification.crown='10 um'")
    tables, values, results = run("sources/litvin_fig10", *wrong)
    assert list(tables["flank_design_I"]["gear"]) == ["pinion", "gear", "pinion as cut"]
    assert values["I.generated_apart"] < 1e-9
    assert ": lead crowning is not part of the rack cutter" in results.remarks[0]
    shifted = ("gear.pinion.profile_shift=0.2", "gear.gear.profile_shift=0.1", "gear.gear.thickness_allowance='40 um'")
    tables, values, _ = run("sources/litvin_fig10", *shifted)
    assert values["I.generated_apart"] < 1e-9
    assert tables["flank_design_I"]["s_t"][0] > tables["flank_design_I"]["w_t"][0]
    spur = [f"gear.{g}.{key}" for g in ("pinion", "gear") for key in ("helix_angle='0 deg'", "hand='spur'")]
    tables, values, results = run("sources/litvin_fig10", *spur, "pair.I.modification.parabola='0 / inch'")
    assert not {"p", "H"} & set(tables["flank_design_I"])
    assert values["I.generated_apart"] < 1e-9
    assert values["I.largest_departure"] == 0.0
    assert "infinite and not listed" in results.remarks[0]


def test_kinds_of_contact_add_up():
    tables, values, _ = run("litvin_localised", "tooth_contact.positions=100")
    kinds, cycle = tables["tooth_contact_kinds_I"], tables["tooth_contact_I"]
    assert kinds["share"].sum() == pytest.approx(1.0)
    (surface,) = kinds["share"][kinds["contact"] == "surface"]
    assert values["I.surface_share"] == surface == np.mean(cycle["contact"] == "surface")
    assert kinds["rise"] == pytest.approx(kinds["slope"] * 360.0 / 30.0 * 3600.0, rel=1e-12)
    assert kinds["slope"] @ kinds["share"] == pytest.approx(cycle["slope"].mean(), rel=1e-12)


def test_a_load_that_changes_nothing_is_said_to():
    for key, value in (("load", "1000 N"), ("torque", "100 N*m")):
        _, _, results = run("litvin_lead", f"pair.I.{key}='{value}'", "tooth_contact.positions=8")
        assert any(f"Pair I: {key} is ignored in tooth contact" in remark for remark in results.remarks), key
    _, _, results = run("litvin_lead", "tooth_contact.positions=8")
    assert not any("is ignored in tooth contact analysis (rigid" in remark for remark in results.remarks)


def test_a_shifted_pair_has_its_gear_data_and_its_contact_and_its_relief_is_said_to_change_nothing():
    relief = "gear.pinion.relief={ tip = { amount = '20 um', start_radius = '90 mm' } }"
    shift = ("gear.pinion.profile_shift=0.2", "gear.gear.profile_shift=-0.05", "gear.gear.ball_diameter='9 mm'")
    tables, values, results = run(
        "litvin_lead", *shift, relief, "results=['geometry', 'tooth-contact', 'tooth-geometry-check']",
        "pair.I.misalignment={ lead_angle = '0 deg' }", "tooth_contact.positions=4",
    )  # fmt: skip
    assert any("topography of gear pinion ignored: tooth contact analysis" in remark for remark in results.remarks)
    assert values["I.unloaded_te_peak_to_peak"] < 1e-6
    data, pair = tables["gear_data_I"], results.scene.pairs["I"]
    assert list(data["hand"]) == ["left", "right"]
    assert data["helix_angle"] == pytest.approx([30.0, 30.0])
    assert data["ball_diameter"][1] == pytest.approx(9.0)
    assert data["span_teeth"][0] == 6
    assert np.isnan(data["span"][1])
    assert any("Gear gear: span measurement not possible" in remark for remark in results.remarks)
    assert values["I.total_contact_ratio"] == pytest.approx(pair.contact_ratio + values["I.overlap_ratio"])
    assert values["I.centre_distance"] > 381.0
    rules = list(tables["tooth_geometry_check"]["rule"])
    assert "total contact ratio" in rules


def test_a_contact_ratio_below_one_and_ellipses_past_the_face_are_remarked():
    """0.7 and ellipses longer than the face went without a word."""
    narrow = [f"gear.{gear}.face_width='4 mm'" for gear in ("pinion", "gear")]
    short = ["gear.pinion.tip_diameter='178 mm'", "gear.gear.tip_diameter='589 mm'"]
    _, values, results = run(
        "litvin_localised", *narrow, *short, "tooth_contact.positions=40", "tooth_contact.load='20 kN'"
    )
    total = values["I.transverse_contact_ratio"] + values["I.common_overlap_ratio"]
    assert total < 1.0
    told = "\n".join(results.remarks)
    assert f"total contact ratio {total:.3g} is below 1" in told
    assert "reaches past an end of the face" in told
    assert "longer than the common face of 4 mm" in told
    _, _, results = run("litvin_localised", "tooth_contact.positions=40", "tooth_contact.load='0.001 N'")
    assert not any("below 1" in remark or "past an end" in remark for remark in results.remarks)


@pytest.mark.dear
def test_absorbing_the_linear_error():
    tables, values, results = run("litvin_localised", "pair.I.modification.absorb=true")
    assert set(tables["tooth_contact_I"]["contact"]) == {"surface"}
    assert values["I.unloaded_te_peak_to_peak"] == pytest.approx(values["I.predesigned_te"], rel=0.06)
    assert values["I.crown"] == pytest.approx(19.8, abs=0.5)
    # The crown told in words gives the same drive when it is written into the case.
    crown = f"pair.I.modification.crown='{values['I.crown']:.12g} um'"
    _, again, drawn = run("litvin_localised", crown)
    assert again["I.unloaded_te_peak_to_peak"] == pytest.approx(values["I.unloaded_te_peak_to_peak"], rel=1e-6)
    assert "contact_ellipses_I" in tables
    (remark,) = results.remarks
    assert "9.8 % of the positions the contact ellipse reaches past an end of the face" in remark
    figures = {figure.key: figure for outcome in drawn.outcomes.values() for figure in outcome.figures}
    pattern = figures["unloaded_contact_pattern_I"]
    items = {getattr(item, "name", ""): item for item in pattern.panels[0].items}
    flank, ellipses = items[""], items["contact ellipses"]
    for axis in ("x", "y"):
        drawn_at, ends = getattr(ellipses, axis), getattr(flank, axis)
        assert ends.min() <= np.nanmin(drawn_at) < np.nanmax(drawn_at) <= ends.max()
    assert np.nanmax(ellipses.x) == flank.x.max()  # one of them is cut at the end of the face
    assert pattern.under == figures["contact_ellipses_I"].under != ""


def test_blankenship_singh():
    tables, values, _ = run("blankenship_singh")
    modes, response = tables["helical_modes_I"], tables["transmissibility_I"]
    assert modes["Lambda"] == pytest.approx([1.65451, 0.78400, 0.44871, 0.39390, 0.26800], abs=0.51e-5)
    assert modes["Delta_normal"] == pytest.approx([1.0, 0.1956, 0.2628, 0.0282, 0.0442], abs=0.51e-4)
    assert len(response["Lambda"]) == 2000
    assert len(response) == 2 + 2 * 2 * 25 + 25
    assert values["I.omega"] == pytest.approx(math.sqrt(2.0 * 3e8 / 2.882) / (2.0 * math.pi), rel=1e-12)
    spur, _, _ = run("blankenship_singh", "transmissibility.I.mesh={ stiffness = '3e8 N/m' }")
    assert spur["helical_modes_I"]["Lambda"][0] == pytest.approx(1.61803, abs=0.51e-5)


def test_general_pair_and_mesh_from_a_load_distribution(tmp_path):
    rows = "\n".join(f"{z},{100.0},{10.0}" for z in range(-10, 1))
    (tmp_path / "face.csv").write_text("z [mm],load [N/mm],deflection [um]\n" + rows + "\n")
    gear = (
        'mass = "3 kg", inertia_x = "0.01 kg*m^2", inertia_y = "0.01 kg*m^2", inertia_z = "0.02 kg*m^2", '
        'base_radius = "70 mm", half_face_width = "10 mm", '
        'bearing = { y = "6e8 N/m", z = "1e8 N/m", theta_x = "2e5 N*m/rad", theta_y = "3e5 N*m/rad" }'
    )
    case = tmp_path / "general.toml"
    case.write_text(
        'results = ["transmissibility"]\n[transmissibility.I]\n'
        'mesh = { distribution = "face.csv", face_width = "20 mm", base_helix_angle = "20 deg" }\n'
        f"driver = {{ {gear} }}\ndriven = {{ {gear.replace('3 kg', '5 kg')} }}\ndamping_ratio = 0.03\n"
    )
    tables, values, _ = run(case.with_suffix(""))
    assert values["I.kappa"] == pytest.approx(-0.5, rel=1e-12)
    assert values["I.mesh_stiffness"] == pytest.approx(100.0, rel=1e-12)
    assert len(tables["helical_modes_I"]["Lambda"]) == 10
    assert (tables["helical_modes_I"]["Lambda"] == 0.0).sum() == 1
    assert {"R_ii_y_y_re", "R_ij_theta_z_z_im"} <= set(tables["transmissibility_I"])
    (tmp_path / "face.csv").write_text("z [mm],load [N/mm]\n0,1\n")
    with pytest.raises(InputError, match=r"has no column deflection \[um\]"):
        run(case.with_suffix(""))


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("gear.gear.hand='left'", "opposite hands"),
        ("gear.gear.helix_angle='20 deg'", "equal by design"),
        ("gear.pinion.tip_diameter='150 mm'", "must exceed the base radius"),
        ("gear.pinion.module='5 mm'", "gear.pinion.module = 5 mm: is for spur gears only; use normal_module"),
        ("gear.pinion.plane='stress'", "is not available for helical gears"),
        ("gear.pinion.spacing_errors={ errors = ['1 um'] }", "gear.pinion.spacing_errors"),
        ("gear.pinion.profile_shift=2.5", "gear.pinion.profile_shift"),
        (
            "pair.I.compliance={ source = 'cornell' }",
            r"pair.I.compliance.*for the plane \(2D\) model only.*remove compliance",
        ),
        ("pair.I.width='plane'", "pair.I.width.*is not available for helical gears"),
        ("gear.pinion.normal_module='5 mm'", "must be specified exactly once for a helical gear"),
        ("gear.pinion.hand='spur'", "contradicts the helix angle"),
        ("pair.I.axial_offset='100 mm'", "leaves no common face width"),
        (
            "pair.I.centre_distance='381 mm'",
            r"centre_distance = 381 mm: leaves no backlash: both flanks are in contact at 381\.282 mm",
        ),
        ("pair.I.misalignment={ lead = '1 mm', lead_angle = '3 arcmin' }", "misalignment.lead.*contradicts lead_angle"),
        ("pair.I.misalignment={ lead = '1 m' }", "pair.I.misalignment.lead.*is not small relative to the lead of 957"),
        ("pair.I.misalignment={ lead = '150 mm' }", "pair.I.misalignment.lead.*is not small"),
        ("pair.I.misalignment={ shaft_angle = '10 deg' }", "pair.I.misalignment.shaft_angle.*is not small"),
        ("pair.I.modification={ parabola = '90 / mm' }", "pair.I.modification.parabola.*no regular flank"),
        ("pair.I.modification={ absorb = true }", "pair.I.modification.parabola.*must be positive"),
        ("tooth_contact.positions=1", "positions"),
        ("results=['load-sharing']", "pair.I.load.*is required for the load distribution"),
    ],
)
def test_nonsense_is_refused_under_the_users_own_key(override, words):
    with pytest.raises(InputError, match=words):
        run("litvin_shaft_angle", override)


def test_helical_and_spur_gears_do_not_mix(tmp_path):
    case = tmp_path / "mixed.toml"
    text = (CASES / "litvin_lead.toml").read_text()
    text += '\n[gear.spur]\nteeth = 28\nmodule = "5 mm"\n'
    case.write_text(text.replace('driven = "gear"', 'driven = "spur"'))
    with pytest.raises(InputError, match="only one of the two gears is helical"):
        read_scene(case)


@pytest.mark.dear
def test_a_run_leaves_tables_and_pictures(tmp_path):
    from typer.testing import CliRunner

    out = tmp_path / "out"
    case = str(CASES / "litvin_localised.toml")
    done = CliRunner().invoke(program(), ["run", case, "--out", str(out), "--set", "tooth_contact.positions=16"])
    assert done.exit_code == 0, done.output
    head = (out / "tables" / "tooth_contact_I.csv").read_text().splitlines()[0]
    assert head.startswith("phi1 [deg],te [arcsec],contact,r1 [mm],z1 [mm],r2 [mm],z2 [mm]")
    summary = json.loads((out / "summary.json").read_text())["results"]
    assert summary["I.unloaded_te_peak_to_peak"]["unit"] == "arcsec"
    pictures = {picture.name for picture in (out / "plots").glob("*.png")}
    assert {"unloaded_transmission_error_I.png", "unloaded_contact_pattern_I.png", "contact_ellipses_I.png"} <= pictures


@pytest.mark.dear
def test_the_example_of_the_documentation_runs_and_prints_its_number(capsys):
    text = (CASES.parent / "docs" / "helical.md").read_text()
    block = text.split("```python\n")[1].split("```")[0]
    exec(compile(block, "helical.md", "exec"), {})  # noqa: S102  (our own documentation)
    printed = capsys.readouterr().out.splitlines()
    assert float(printed[0].split()[0]) == pytest.approx(4.300, abs=5e-4)
    assert any("gear tip" in line for line in printed)
