"""The table of a mesh for other programs: even over one tooth of the driver, periodic, and read back from .mat."""

import math

import numpy as np
import pytest
from scipy.io import loadmat

import fegear
from fegear.contact.error_over_pitch import over_pitch
from fegear.output.tables import write_table

CASE = {
    "title": "A mesh for another program",
    "results": ["transmission-error"],
    "gear": {
        "a": {"teeth": 23, "module": "3 mm", "face_width": "10 mm", "bore_radius": "15 mm"},
        "b": {"teeth": 41, "module": "3 mm", "face_width": "10 mm", "bore_radius": "15 mm"},
    },
    "pair": {"I": {"driver": "a", "driven": "b", "load": "2 kN", "compliance": {"source": "weber-banaschek"}}},
    "transmission_error": {"even_positions": 500},
}


@pytest.fixture(scope="module")
def results():
    return fegear.run(CASE, progress=False)


def test_it_is_read_back_from_mat_as_it_was_computed(results, tmp_path):
    table = results.tables["mesh_table_I"]
    write_table(tmp_path, table)
    first = (tmp_path / "mesh_table_I.mat").read_bytes()
    write_table(tmp_path, table)
    assert (tmp_path / "mesh_table_I.mat").read_bytes() == first
    read = loadmat(tmp_path / "mesh_table_I.mat", simplify_cells=True)
    assert read["units"]["local_stiffness"] == "N/um"
    for column in table.columns:
        np.testing.assert_array_equal(read[column.name], column.values)
    angle = read["driver_angle"]
    np.testing.assert_allclose(np.diff(angle), 360.0 / 23 / 500, rtol=1e-9)
    assert angle[0] == 0.0


def test_its_means_are_those_of_the_curves(results):
    table = results.tables["mesh_table_I"]
    te, slope = (np.asarray(table.column(name).values, dtype=float) for name in ("te", "local_stiffness"))
    values = {name: one.value for name, one in results.values.items()}
    # A jump stands at most half a step from its place.
    assert te.mean() == pytest.approx(values["I.te_mean"], abs=np.ptp(te) / 500)
    assert slope.mean() == pytest.approx(values["I.local_stiffness_mean"], abs=2.0 * np.ptp(slope) / 500)
    assert np.ptp(te) == pytest.approx(values["I.te_peak_to_peak"], rel=5e-3)
    # From the pitch point, as the curve: there the same transmission error stands beside the same angle.
    angle = table.column("driver_angle_from_pitch_point").si
    np.testing.assert_allclose(np.diff(angle), np.diff(table.column("driver_angle").si), rtol=1e-9)
    curve = results.tables["transmission_error_I"]
    assert angle[0] == pytest.approx(curve.column("driver_angle").si[0], rel=1e-12)
    found = np.interp(angle, curve.column("driver_angle").si, np.asarray(curve.column("te").values, dtype=float))
    np.testing.assert_allclose(te, found, atol=1e-6 * np.ptp(te))
    assert any("mesh_table_I has 500 equal steps" in remark for remark in results.remarks)


def test_rows_of_the_curve_have_the_rotation_of_the_driver_from_the_pitch_point(results):
    table = results.tables["transmission_error_I"]
    angle, x = table.column("driver_angle").si, table.column("x").si
    assert [one.name for one in table.columns[-2:]] == ["driver_angle", "te_0"]  # behind those that were there
    assert table.column("driver_angle").unit == "deg"
    radius = 23 * 1.5e-3 * math.cos(math.radians(20.0))
    np.testing.assert_allclose(angle, x / radius, rtol=1e-12, atol=1e-15)
    assert np.ptp(angle) == pytest.approx(2.0 * math.pi / 23)
    # Positive as the driver turns, towards its tip; `mesh_stiffness` counts as the column does.
    for key, at in (("local_stiffness", results.mesh_stiffness), ("te", results.transmission_error)):
        once = np.r_[np.diff(x) > 0.0, False] & np.r_[True, np.diff(x) > 0.0]
        np.testing.assert_allclose(at(angle)[once], table.column(key).si[once], rtol=1e-9)


def test_stiffness_and_error_are_functions_of_the_drivers_rotation(results):
    (found,) = (one.data.found for task, one in results.outcomes.items() if task.stage == "transmission-error")
    table = results.tables["mesh_table_I"]
    first = results.tables["transmission_error_I"].column("driver_angle").si[0]  # there the equal steps begin
    angle, tooth = first + table.column("driver_angle").si, 2.0 * math.pi / 23
    for turned in (angle, angle + 5 * tooth, angle - 40 * tooth):
        np.testing.assert_allclose(found.stiffness(turned)[1:], table.column("local_stiffness").si[1:], rtol=1e-6)
        np.testing.assert_allclose(
            found.stiffness(turned, secant=True)[1:], table.column("mesh_stiffness").si[1:], rtol=1e-6
        )
        np.testing.assert_allclose(found.error(turned)[1:], table.column("te").si[1:], rtol=1e-6)
    assert found.stiffness(0.1).shape == ()


def test_a_curve_with_a_jump_is_followed_and_closes():
    x = np.array([2.0, 3.0, 3.0 + 1e-9, 4.9999])
    values = np.array([1.0, 1.0, 5.0, 5.0])
    part = np.arange(8) / 8
    found = over_pitch(x, values, 3.0, part)
    np.testing.assert_allclose(found[:3], 1.0)  # up to x = 2.75
    np.testing.assert_allclose(found[3:], 5.0, atol=1e-12)  # from 3.125 to 4.625
    smooth = np.linspace(0.0, 1.0, 400, endpoint=False)
    again = over_pitch(smooth, np.cos(2.0 * math.pi * smooth), 1.0, np.arange(64) / 64)
    np.testing.assert_allclose(again, np.cos(2.0 * math.pi * np.arange(64) / 64), atol=1e-4)


@pytest.fixture(scope="module")
def helical():
    """A helical pair by coupled slices under several torques, and its case."""
    gears = {
        name: {"teeth": teeth, "normal_module": "3 mm", "helix_angle": "15 deg", "hand": hand, "face_width": "10 mm"}
        for name, teeth, hand in (("a", 23, "right"), ("b", 41, "left"))
    }
    case = CASE | {
        "gear": gears,
        "pair": {"I": {"driver": "a", "driven": "b", "width": "slices", "loads": ["700 N", "1990 N", "2 kN", "4 kN"]}},
        "load_distribution": {"positions": 13, "panels": 6},
        "accuracy": {"tolerance": 0.1},
    }
    return fegear.run(case, progress=False)


@pytest.mark.dear
def test_a_helical_pair_has_its_curves_under_every_torque(helical, tmp_path):
    """As its table, and the tangent as what the transmission error changes from 1990 to 2000 N."""
    (e,) = (one.data.found for task, one in helical.outcomes.items() if task.stage == "transmission-error")
    torques, tooth = [f"{one!r} N*m" for one in e.driver_torque.tolist()], 2.0 * math.pi / 23
    for turns in (0, 7):
        for i, torque in enumerate(torques):
            angle = e.driver_angle[1:-1] + turns * tooth
            for kind, column in (("tangent", e.local_stiffness), ("secant", e.mesh_stiffness)):
                found = helical.mesh_stiffness(angle, kind=kind, torque=torque)
                np.testing.assert_allclose(found, column[1:-1, i], rtol=1e-7)
            np.testing.assert_allclose(helical.transmission_error(angle, torque=torque), e.te[1:-1, i], rtol=1e-7)
    at = e.driver_angle[1:-1]
    one, two = (helical.transmission_error(at, torque=torques[i]) for i in (1, 2))
    slopes = [helical.mesh_stiffness(at, torque=torques[i]) for i in (1, 2)]
    np.testing.assert_allclose(10.0 / (two - one), 0.5 * (slopes[0] + slopes[1]), rtol=1e-4)
    np.testing.assert_array_equal(helical.mesh_stiffness(at), helical.mesh_stiffness(at, torque=torques[e.at]))
    write_table(tmp_path, table := helical.tables["mesh_table_I"])
    read = loadmat(tmp_path / "mesh_table_I.mat", simplify_cells=True)
    for column in table.columns:
        np.testing.assert_array_equal(read[column.name], column.values)
    angle = np.radians(read["driver_angle_from_pitch_point"])
    np.testing.assert_allclose(helical.mesh_stiffness(angle), 1e6 * read["local_stiffness"], rtol=1e-6)
    np.testing.assert_allclose(helical.mesh_stiffness(angle, kind="secant"), 1e6 * read["mesh_stiffness"], rtol=1e-6)
    np.testing.assert_allclose(1e6 * helical.transmission_error(angle), read["te"], rtol=1e-6)


def test_the_kind_of_a_stiffness_and_its_torque_are_said_plainly(results):
    at = np.array([0.0, 0.1])
    np.testing.assert_array_equal(results.mesh_stiffness(at, kind="tangent"), results.mesh_stiffness(at))
    np.testing.assert_array_equal(results.mesh_stiffness(at, kind="secant"), results.mesh_stiffness(at, secant=True))
    (e,) = (one.data.found for task, one in results.outcomes.items() if task.stage == "transmission-error")
    torque = float(e.driver_torque[0])
    np.testing.assert_array_equal(results.mesh_stiffness(at, torque=torque), results.mesh_stiffness(at))
    for wrong, rule in (
        ({"kind": "chord"}, 'kind = "chord": must be "tangent" (slope dF/dTE) or "secant"'),
        ({"kind": "tangent", "secant": True}, "contradicts secant = True"),
        ({"torque": "70 N*m"}, f"is not a torque on the driver that was computed; use one of {torque:.6g} N*m"),
        ({"torque": "2 kN"}, "is not a torque"),
    ):
        with pytest.raises(fegear.InputError) as refused:
            results.mesh_stiffness(at, **wrong)
        assert rule in str(refused.value)
    with pytest.raises(fegear.InputError, match="was computed"):
        results.transmission_error(at, torque=-torque)
