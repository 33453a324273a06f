"""Modes, modes over a parameter and forces of helical pairs, asked for from case files."""

import math
from pathlib import Path

import numpy as np
import pytest
from solved_once import CACHE

from fegear.base.errors import InputError, RangeError
from fegear.case.reading import read_scene
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.results.catalogue import STAGES

CASES = Path(__file__).parents[2] / "cases"


def run(case, *overrides):
    scene = read_scene(case if isinstance(case, Path) else CASES / f"{case}.toml", overrides)
    results = run_plan(scene, make_plan(scene, STAGES), cache=CACHE)
    tables = {table.name: {column.name: column.values for column in table.columns} for table in results.tables}
    figures = {figure.key: figure for outcome in results.outcomes.values() for figure in outcome.figures}
    return tables, {value.name: value.value for value in results.values}, figures, results.remarks


@pytest.fixture(scope="module")
def spur():
    return run("sources/blankenship_singh_spur")


@pytest.fixture(scope="module")
def helical():
    return run("sources/blankenship_singh_helical")


def test_mode_shapes_as_a_table_are_those_of_figure_2(spur):
    shapes = spur[0]["mode_shapes_I"]
    assert list(shapes) == ["mode", "Lambda", "y", "z", "b_theta_x", "a_theta_y", "a_theta_z"]
    found = np.array([shapes[name] for name in list(shapes)[2:]])
    assert np.linalg.norm(found, axis=0) == pytest.approx(np.ones(5), rel=1e-12)
    # y + a theta_z: they add up in the first mode, and all but cancel in the second (Fig. 2, .23607).
    y, torsion = found[0], found[4]
    assert y[0] * torsion[0] > 0.0 > y[1] * torsion[1]
    assert abs(y[1] + torsion[1]) / abs(y[0] + torsion[0]) == pytest.approx(0.23607, abs=0.51e-5)
    assert found[2] == pytest.approx([0.0, 0.0, 1.0, 0.0, 0.0], abs=1e-12)


def test_mode_shapes_are_drawn(spur):
    _, _, figures, _ = spur
    bars, drawing = figures["mode_shapes_I"], figures["mesh_mode_shapes_I"]
    assert len(bars.panels) == 5
    assert [panel.title.split(",")[0] for panel in drawing.panels] == ["mode 1", "mode 2"], "the others do not show"
    driver, driven = bars.panels[0].items
    # Of equal gears the driven one mirrors the driver: y against, theta_z along.
    assert np.asarray(driven.y) == pytest.approx(np.asarray(driver.y) * [-1, -1, -1, 1, 1], abs=1e-12)
    assert np.abs(driver.y).max() == pytest.approx(1.0)
    circles = [item for item in drawing.panels[0].items if item.name == "driver"]
    rest = [item for item in drawing.panels[0].items if item.name == "at rest"]
    assert np.mean(circles[0].y[:-1]) > np.mean(rest[0].y[:-1]), "the driver moves along y"


def test_the_general_pair_has_shapes_of_both_gears(tmp_path):
    tables, _, figures, _ = run(general(tmp_path))
    shapes = tables["mode_shapes_I"]
    assert {"y_driver", "a_theta_z_driven"} <= set(shapes)
    assert len(shapes) == 12
    assert len(figures["mode_shapes_I"].panels) == 9, "the rigid-body motion is no mode to draw"
    assert len(figures["transmissibility_axial_I"].panels) == 2


def test_g_minus_a_is_a_column_that_keeps_its_digits(spur):
    response = spur[0]["transmissibility_I"]
    k_m = 300.0
    found = response["G_minus_a_theta_z_y_abs"] / k_m
    g = response["G_theta_z_y_re"] + 1j * response["G_theta_z_y_im"]
    assert found == pytest.approx(np.abs(g / k_m - 1.0), rel=1e-9)
    # Far above all resonances it falls with the square of the frequency; a difference of columns would have lost it.
    far, _, _, _ = run(
        "sources/blankenship_singh_spur", 'results=["transmissibility"]', "transmissibility.I.lambda_from=1e5",
        "transmissibility.I.lambda_to=2e5", "transmissibility.I.frequencies=2",
    )  # fmt: skip
    dynamic = far["transmissibility_I"]["G_minus_a_theta_z_y_abs"]
    assert dynamic[0] / dynamic[1] == pytest.approx(4.0, rel=1e-5)


def drawn_names(figure):
    return {name for item in figure.panels[0].items for name in item.name.split(" = ")}


def test_every_entry_that_the_paper_draws_is_drawn(spur, helical):
    factor = drawn_names(spur[2]["dynamic_load_factor_I"])
    assert factor == {"(G − a_{M})_{θz,y} / K_{M}", "R_{θz,θz}", "R_{y,y}"}
    figures = helical[2]
    assert {"R_{y,y}", "R_{θz,θz}", "R_{θz,y}"} <= drawn_names(figures["transmissibility_normal_I"])
    assert {"R_{z,z}", "R_{z,y}", "R_{z,θz}"} <= drawn_names(figures["transmissibility_axial_I"])
    rocking = {"R_{θy,y}", "R_{θy,θy}", "R_{θy,θz}", "R_{θy,z}"}
    assert rocking <= drawn_names(figures["transmissibility_rocking_I"])
    _, _, bending, _ = run("blankenship_singh", 'results=["transmissibility"]')
    four = {"R_{θx,y}", "R_{θx,z}", "R_{θx,θy}", "R_{θx,θz}"}
    assert four <= drawn_names(bending["transmissibility_bending_I"])
    # Without kappa nothing drives bending: what is zero is left out.
    assert drawn_names(figures["transmissibility_bending_I"]) == {"R_{θx,θx}"}


def test_drawn_curves_reach_peaks_and_part_at_poles_whatever_the_grid():
    settings = ('results=["transmissibility"]', "transmissibility.I.frequencies=5")
    lightly, _, figures, _ = run("sources/blankenship_singh_spur", *settings, "transmissibility.I.damping_ratio=1e-4")
    curve = figures["dynamic_load_factor_I"].panels[0].items[0]
    modes = lightly["helical_modes_I"]["Lambda"]
    x, y = np.asarray(curve.x), np.asarray(curve.y)
    # The peak of the first mode: 2 (n . phi)^2 / (2 zeta Lambda^2), some 9 / 4e-2 at zeta = .04.
    assert y.max() == pytest.approx(400.0 * 9.06, rel=0.02)
    assert np.abs(x - modes[0]).min() < 1e-6
    _, _, figures, _ = run("sources/blankenship_singh_spur", *settings, "transmissibility.I.damping_ratio=0.0")
    panel = figures["dynamic_load_factor_I"].panels[0]
    x, y = np.asarray(panel.items[0].x), np.asarray(panel.items[0].y)
    for pole in modes:
        (gap,) = np.flatnonzero(np.abs(x - pole) < 1e-12)
        assert np.isnan(y[gap])
    low, high = panel.y.limits
    assert 0.0 < low < 1e-2
    assert 1e2 < high < np.nanmax(y)


def test_a_resonance_without_damping_is_a_clear_error():
    modes = run("sources/blankenship_singh_spur", 'results=["transmissibility"]')[0]["helical_modes_I"]["Lambda"]
    with pytest.raises(RangeError, match=r"transmissibility\.I\.frequency = .* is an undamped resonance"):
        run(
            "sources/blankenship_singh_spur", 'results=["transmissibility"]', "transmissibility.I.damping_ratio=0.0",
            f"transmissibility.I.lambda_from={float(modes[1])!r}",
        )  # fmt: skip


def test_modes_over_bearing_stiffness_follow_the_closed_form_of_figure_3(spur):
    """Two coordinates, y and theta_z: Lambda^4 - (2 + alpha/2) Lambda^2 + alpha/2 = 0."""
    table = spur[0]["modes_over_alpha_y_I"]
    alpha = table["alpha_y"]
    half = 1.0 + 0.25 * alpha
    root = np.sqrt(half**2 - 0.5 * alpha)
    assert table["Lambda_1"] == pytest.approx(np.sqrt(half + root), rel=1e-9)
    assert table["Lambda_2"] == pytest.approx(np.sqrt(0.5 * alpha / (half + root)), rel=1e-9)
    assert table["frequency_1"] == pytest.approx(table["Lambda_1"] * spur[1]["I.omega"], rel=1e-12)
    # Fig. 3(b): the second mode's index rises to one.
    assert (np.diff(table["Delta_normal_2"]) > 0.0).all()
    assert np.all(table["Delta_normal_1"] == 1.0)
    assert [p.y.label for p in spur[2]["modes_over_alpha_y_I"].panels] == ["Λ_{r}", "Δ_{η}", "Δ_{θx}"]
    (remark,) = [r for r in spur[3] if "crossings" in r]
    assert "modes 2 and 4 at alpha_y = 0.9" in remark


def test_modes_over_the_helix_angle_and_responses_of_figures_5_and_6(helical):
    table, _, figures, _ = helical
    over, response = table["modes_over_base_helix_angle_I"], table["response_over_base_helix_angle_I"]
    modes = table["helical_modes_I"]["Lambda"]
    (at_30,) = np.flatnonzero(np.isclose(over["base_helix_angle"], 30.0))
    assert [over[f"Lambda_{r}"][at_30] for r in range(1, 6)] == pytest.approx(list(modes), rel=1e-9)
    spur_modes = run("sources/blankenship_singh_spur", 'results=["transmissibility"]')[0]["helical_modes_I"]["Lambda"]
    assert [over[f"Lambda_{r}"][0] for r in range(1, 6)] == pytest.approx(list(spur_modes), rel=1e-9)
    assert set(response["base_helix_angle"].round(9)) == {0.0, 20.0, 30.0, 40.0}
    # Section 5.2: the resonant amplitude falls by about cos^2 psi_b, at the first mode closely.
    at = {psi: np.isclose(response["base_helix_angle"], psi) for psi in (0.0, 20.0, 30.0, 40.0)}
    peak = {psi: response["G_minus_a_theta_z_y_abs"][rows].max() for psi, rows in at.items()}
    for psi in (20.0, 30.0, 40.0):
        assert peak[psi] / peak[0.0] == pytest.approx(math.cos(math.radians(psi)) ** 2, rel=0.15)
    curves = figures["response_over_base_helix_angle_I"].panels[0].items
    assert [curve.name for curve in curves] == [f"ψ_{{b}} = {psi} deg" for psi in (0, 20, 30, 40)]


def test_modes_over_kappa_of_figures_10_and_11():
    tables, _, _, _ = run("blankenship_singh", 'results=["mode-tracking"]')
    over = tables["modes_over_kappa_I"]
    assert over["Lambda_3"] == pytest.approx(over["Lambda_3"][::-1], rel=1e-9), "kappa's sign mirrors the pair"
    middle = np.argmin(np.abs(over["kappa"]))
    assert over["coupling_3"][middle] == pytest.approx(0.0, abs=1e-9)
    (at_half,) = np.flatnonzero(np.isclose(over["kappa"], 0.5))
    found = [over[f"coupling_{r}"][at_half] for r in range(1, 6)]
    assert found == pytest.approx([0.0032, 0.0198, 0.8575, 0.1598, 0.0606], abs=0.51e-4), "Table 3(c), in mode order"
    assert max(np.ptp(over[f"Lambda_{r}"]) / over[f"Lambda_{r}"].max() for r in range(1, 6)) < 0.02, "minor influence"
    assert all((over[f"coupling_{r}"] <= 1.0 + 1e-12).all() for r in range(1, 6))
    # Given as a number, mu stays where it is, and must be large enough for every kappa.
    with pytest.raises(InputError, match=r"transmissibility\.I\.follow\.kappa = -1\.0.*at least kappa\^2 = 1;"):
        run("blankenship_singh", 'results=["mode-tracking"]', "transmissibility.I.mesh.mu=0.5")


GEAR = (
    'mass = "3 kg", inertia_x = "0.01 kg*m^2", inertia_y = "0.01 kg*m^2", inertia_z = "0.02 kg*m^2", '
    'base_radius = "70 mm", half_face_width = "10 mm", '
    'bearing = { y = "6e8 N/m", z = "1e8 N/m", theta_x = "2e5 N*m/rad", theta_y = "3e5 N*m/rad" }'
)


def general(tmp_path, results='"transmissibility"', more="", helix="20 deg"):
    case = tmp_path / "general.toml"
    case.write_text(
        f"results = [{results}]\n[transmissibility.I]\n"
        f'mesh = {{ stiffness = "3e8 N/m", kappa = 0.2, base_helix_angle = "{helix}" }}\n'
        f"driver = {{ {GEAR} }}\ndriven = {{ {GEAR.replace('3 kg', '5 kg').replace('70 mm', '140 mm')} }}\n"
        f"damping_ratio = 0.03\nfrequencies = 20\n{more}"
    )
    return case


def test_the_general_pair_follows_all_bearings_at_once(tmp_path):
    more = "[transmissibility.I.follow]\nbearing_stiffness = { start = 0.5, stop = 2.0, count = 7 }\n"
    tables, _, _, _ = run(general(tmp_path, '"transmissibility", "mode-tracking"', more))
    over = tables["modes_over_bearing_stiffness_I"]
    (own,) = np.flatnonzero(np.isclose(over["bearing_stiffness"], 1.0))
    found = [over[f"Lambda_{r}"][own] for r in range(1, 11)]
    assert found == pytest.approx(list(tables["helical_modes_I"]["Lambda"]), rel=1e-9)
    assert all((np.diff(over[f"frequency_{r}"]) >= -1e-9).all() for r in range(1, 11)), "stiffer bearings"
    refused = more.replace("bearing_stiffness", "alpha_y")
    with pytest.raises(InputError, match=r"follow\.alpha_y.*requires unity_ratio"):
        run(general(tmp_path, '"mode-tracking"', refused))


FORCES = "sources/blankenship_singh_forces"


def test_forces_over_speed_are_g_and_r_times_the_excitation():
    tables, values, figures, _ = run(FORCES)
    over, lines = tables["pair_forces_I"], tables["pair_force_spectrum_I"]
    assert len(over["speed"]) == 119
    assert set(lines["source"]) == {"transmission error", "external 1"}
    assert over["mesh_frequency"] == pytest.approx(50.0 * over["speed"] / 60.0)
    # The same from the matrices that the transmissibility result writes, interpolated nowhere: one speed, one Lambda.
    rpm = float(over["speed"][60])
    ratio = 50.0 * rpm / 60.0 * 2.0 * math.pi / math.sqrt(2.0 * 3e8 / 2.882)
    matrices, _, _, _ = run(
        FORCES, 'results=["transmissibility"]', f"transmissibility.I.lambda_from={ratio!r}",
        f"transmissibility.I.lambda_to={2.0 * ratio!r}", "transmissibility.I.frequencies=2",
    )  # fmt: skip
    g = matrices["transmissibility_I"]
    row = (np.abs(lines["speed"] - rpm) < 1e-9) & (lines["order"] == 50.0)
    for key, size in (("y", 1.0), ("z", 1.0), ("theta_x", 0.3 * 0.07048), ("theta_y", 0.07048), ("theta_z", 0.07048)):
        expected = math.hypot(g[f"G_{key}_y_re"][0], g[f"G_{key}_y_im"][0]) * 1.0 * size
        assert lines[f"mesh_{key}"][row] == pytest.approx(expected, rel=1e-9)
    # Root mean square over both lines.
    both = np.abs(lines["speed"] - rpm) < 1e-9
    assert over["mesh_normal"][60] == pytest.approx(math.sqrt(0.5 * (lines["mesh_normal"][both] ** 2).sum()), rel=1e-12)
    assert values["I.largest_mesh_force"] == pytest.approx(over["mesh_normal"].max())
    peak = figures["pair_forces_I"].panels[0].items[0]
    assert np.nanmax(peak.y) >= lines["mesh_normal"].max() / math.sqrt(2.0), "the picture passes no peak over"
    assert figures["pair_force_spectrum_I"].under == f"{values['I.largest_mesh_force_speed']:.6g} rpm"


def test_harmonics_from_a_table_are_those_of_the_amplitudes(tmp_path):
    case = tmp_path / "forces.toml"
    text = (CASES / f"{FORCES}.toml").read_text()
    (tmp_path / "te.csv").write_text("n,cosine [um],sine [um]\n1,0.6,-0.8\n3,0.0,0.5\n")
    case.write_text(text.replace('{ amplitude = "1 um" }', '{ file = "te.csv" }'))
    lines = run(case)[0]["pair_force_spectrum_I"]
    one = run(FORCES)[0]["pair_force_spectrum_I"]
    assert set(lines["order"]) == {2.0, 50.0, 150.0}
    for key in ("mesh_normal", "bearing_driver_z", "bearing_driven_theta_y"):
        assert lines[key][lines["order"] == 50.0] == pytest.approx(one[key][one["order"] == 50.0], rel=1e-9)
    third = run(FORCES, "transmissibility.I.excitation.transmission_error={amplitude='0.5 um', harmonic=3}")
    third = third[0]["pair_force_spectrum_I"]
    assert lines["mesh_y"][lines["order"] == 150.0] == pytest.approx(third["mesh_y"][third["order"] == 150.0], rel=1e-9)
    for text, words in (
        ("n,cosine [um]\n1.5,1\n", "contains invalid harmonic numbers n"),
        ("n [mm],cosine [um]\n1,1\n", "has a unit in the head of column"),
        ("n,other\n1,1\n", "no columns n"),
    ):
        (tmp_path / "te.csv").write_text(text)
        with pytest.raises(InputError, match=words):
            run(case)


PAIR = """
[gear.a]
teeth = 28
module = "3 mm"
face_width = "20 mm"
bore_radius = "20 mm"
material = { young_modulus = "206.8 GPa", poisson_ratio = 0.3 }
[pair.teeth]
driver = "a"
driven = "a"
load = "1000 N"
compliance = { source = "weber-banaschek" }
"""


def test_the_case_s_own_pair_excites(tmp_path):
    excitation = (
        '[transmissibility.I.excitation]\nspeeds = { start = "1000 rpm", stop = "4000 rpm", count = 4 }\n'
        'transmission_error = { pair = "teeth", harmonics = 3 }\n'
    )
    case = general(tmp_path, '"pair-forced-response", "transmission-error"', excitation + PAIR, "0 deg")
    tables, _, _, _ = run(case)
    lines, te = tables["pair_force_spectrum_I"], tables["transmission_error_harmonics_teeth"]
    assert sorted(set(lines["order"])) == [28.0, 56.0, 84.0]
    for n in (1, 2, 3):
        size = float(te["amplitude"][n - 1])
        given = f"transmissibility.I.excitation.transmission_error={{amplitude='{size!r} um', harmonic={n}}}"
        one = run(case, 'results=["pair-forced-response"]', given, "transmissibility.I.excitation.teeth=28")
        one = one[0]["pair_force_spectrum_I"]["mesh_normal"]
        assert lines["mesh_normal"][lines["order"] == 28.0 * n] == pytest.approx(one, rel=1e-9)
    with pytest.raises(InputError, match="base_helix_angle = 20 deg: contradicts pair teeth, 0 deg"):
        run(case, "transmissibility.I.mesh.base_helix_angle='20 deg'")
    with pytest.raises(InputError, match="is not a pair of this case"):
        run(case, "transmissibility.I.excitation.transmission_error={pair='tooth'}")


@pytest.mark.dear
def test_a_helical_pair_excites_with_its_tooth_contact(tmp_path):
    text = (CASES / "litvin_shaft_angle.toml").read_text()
    scene = read_scene(CASES / "litvin_shaft_angle.toml")
    helical = next(iter(scene.helical_pairs.values()))
    psi = math.degrees(abs(helical.gear.base_helix_angle))
    case = general(tmp_path, '"pair-forced-response", "tooth-contact"', (
        '[transmissibility.I.excitation]\nspeeds = ["600 rpm"]\ntransmission_error = { pair = "I", harmonics = 4 }\n'
    ), f"{psi!r} deg")  # fmt: skip
    case.write_text(case.read_text() + "\n".join(text.split("\n")[text.split("\n").index("[gear.pinion]") :]))
    tables, values, _, _ = run(case, "tooth_contact.positions=61")
    lines, contact = tables["pair_force_spectrum_I"], tables["tooth_contact_I"]
    teeth = helical.pinion.teeth
    assert sorted(set(lines["order"])) == [teeth, 2 * teeth, 3 * teeth, 4 * teeth]
    # The first harmonic by the trapezoidal rule over the table's own columns.
    te = contact["te"] * math.pi / 648_000.0 * helical.gear.base_radius * 1e6
    angle = 2.0 * math.pi * np.arange(te.size) / te.size
    size = float(2.0 * abs(np.mean(te * np.exp(-1j * angle))))
    given = f"transmissibility.I.excitation.transmission_error={{amplitude='{size!r} um'}}"
    one = run(case, 'results=["pair-forced-response"]', given, f"transmissibility.I.excitation.teeth={teeth}")
    assert lines["mesh_normal"][0] == pytest.approx(one[0]["pair_force_spectrum_I"]["mesh_normal"][0], rel=1e-6)
    # What more positions change is within the estimated error.
    _, fine, _, _ = run(case, "tooth_contact.positions=240", 'results=["pair-forced-response"]')
    error = tables["pair_forces_I"]["mesh_normal_error"][0]
    assert 0.0 < error < 0.05 * values["I.largest_mesh_force"]
    assert abs(values["I.largest_mesh_force"] - fine["I.largest_mesh_force"]) < error
    with pytest.raises(InputError, match="positions = 12: is too low for 4 harmonics; set at least 16"):
        run(case, "tooth_contact.positions=12")


@pytest.mark.parametrize(
    ("override", "words"),
    [
        ("excitation.transmission_error={}", "must be specified in one way"),
        ("excitation.transmission_error={amplitude='1 um', file='te.csv'}", "must be specified in one way"),
        ("excitation.transmission_error={file='te.csv', harmonic=2}", "belongs to amplitude"),
        ("excitation.transmission_error={amplitude='1 um', harmonics=2}", "is not used with amplitude"),
        ("excitation.transmission_error={amplitude='0 um'}", "gives no excitation; specify a non-zero amplitude"),
        ("excitation.external=[{on='driver', theta_z='1 N*m'}]", "or a frequency instead"),
        ("excitation.external=[{on='driver', order=2}]", "must have a force or moment"),
        ("excitation.external=[{on='driver', order=-2, y='1 N'}]", "greater than 0"),
        ("excitation.external=[{on='gear', order=2, y='1 N'}]", "driver"),
        ("excitation.speeds=['0 rpm']", "greater than zero"),
        ("unity_ratio.base_radius='-1 mm'", "greater than zero"),
    ],
)
def test_excitations_that_make_no_sense_are_refused(override, words):
    alone = ("transmissibility.I.excitation.external=[]",) if "0 um" in override else ()
    with pytest.raises(InputError, match=words):
        run(FORCES, f"transmissibility.I.{override}", *alone)


def test_what_is_missing_is_told_with_its_remedy(tmp_path):
    with pytest.raises(
        InputError, match=r"transmissibility\.I\.excitation .*is required for pair-forced-response; set excitation = "
    ):
        run("blankenship_singh", 'results=["pair-forced-response"]')
    with pytest.raises(InputError, match=r"transmissibility\.I\.follow .*is required for mode-tracking"):
        run(FORCES, 'results=["mode-tracking"]')
    text = (CASES / f"{FORCES}.toml").read_text()
    case = tmp_path / "case.toml"
    case.write_text(text.replace('base_radius = "70.48 mm"\n', ""))
    with pytest.raises(InputError, match=r"unity_ratio\.base_radius .*required for moments"):
        run(case)
    case.write_text(text.replace("teeth = 50\n", ""))
    with pytest.raises(
        InputError,
        match=r"excitation\.teeth .*is required for the frequency of the transmission error",
    ):
        run(case)
    case.write_text(text.replace("damping_ratio = 0.04\n", ""))
    tables, _, figures, _ = run(case)
    panel = figures["pair_forces_I"].panels[0]
    assert panel.y.limits is not None
    assert np.isnan(panel.items[0].y).sum() >= 9, "the line parts at every pole"
    resonance = tables["pair_force_spectrum_I"]
    assert np.isfinite(resonance["mesh_normal"]).all()


def test_a_speed_upon_a_resonance_without_damping_is_refused(tmp_path):
    case = tmp_path / "case.toml"
    text = (CASES / f"{FORCES}.toml").read_text().replace("damping_ratio = 0.04\n", "")
    case.write_text(text)
    modes = run(case, 'results=["transmissibility"]')[0]["helical_modes_I"]["frequency"]
    with pytest.raises(RangeError, match=r"frequency = .* Hz: is an undamped resonance: unbounded") as caught:
        run(case, f"transmissibility.I.excitation.speeds=['{60.0 * float(modes[0]) / 50.0!r} rpm']")
    assert float(str(caught.value).split(" = ")[1].split(" Hz")[0]) == pytest.approx(float(modes[0]), rel=1e-6)


def test_a_range_over_parameters_that_makes_no_sense_is_refused():
    for given, words in (
        ("{}", "must have at least one parameter"),
        ("{kappa={start=1, stop=0}}", "greater than start"),
        ("{alpha_y={start=0, stop=1, spacing='logarithmic'}}", "logarithmic"),
        ("{alpha_y={start=-1, stop=1}}", "must not be negative"),
        ("{alpha={start=0, stop=1}}", "alpha_y"),
        ("{base_helix_angle={start='0 deg', stop='95 deg'}}", "must be between -90 and 90 deg"),
        ("{bearing_stiffness={start=-1, stop=1}}", "greater than or equal to 0"),
    ):
        with pytest.raises(InputError, match=words):
            run("blankenship_singh", 'results=["mode-tracking"]', f"transmissibility.I.follow={given}")
