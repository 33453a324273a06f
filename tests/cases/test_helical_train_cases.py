"""A train with a helical stage: its springs, its mesh stiffness matrix, and what knows plane teeth only is refused."""

import math
from pathlib import Path

import numpy as np
import pytest
from solids import of_gear

from fegear.base.errors import InputError
from fegear.base.solution_cache import SolutionCache
from fegear.case.reading import read_scene
from fegear.contact.wide.load_sharing import hat_averages
from fegear.contact.wide.mesh_matrix import tilt_lever
from fegear.contact.wide.transmission_error import series_over_pitch
from fegear.dynamics.train.mesh_force_spectrum import mesh_force_spectrum
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.results.catalogue import STAGES
from fegear.studies.cost.asked import asked

CASE = Path(__file__).parents[2] / "cases" / "helical_stage_train.toml"
COARSE = (
    "accuracy.tolerance=1e-1", "load_distribution.positions=12", "load_distribution.panels=6",
    'pair.first.width="slices"', 'gear.pinion_1.face_width="8 mm"', 'gear.wheel_1.face_width="8 mm"',
)  # fmt: skip
RIGID = '{ y = "1e12 N/m", z = "1e12 N/m", theta_x = "1e8 N*m/rad", theta_y = "1e8 N*m/rad" }'
RESULTS = [
    "gear-train", "mesh-force-spectrum", "tooth-force", "mesh-stiffness-matrix", "transmissibility",
    "pair-forced-response",
]  # fmt: skip
ASKED = (
    f"results={RESULTS}", "effects.corner_contact=false",
    f"transmissibility.stage.driver.bearing={RIGID}", f"transmissibility.stage.driven.bearing={RIGID}",
    "transmissibility.stage.frequencies=5", 'transmissibility.stage.excitation.speeds=["0.01 rpm"]',
    "transmissibility.stage.excitation.transmission_error.harmonics=2",
)  # fmt: skip


@pytest.fixture(scope="module")
def outcomes():
    scene = read_scene(CASE, [*COARSE, *ASKED])
    return run_plan(scene, make_plan(scene, STAGES), cache=SolutionCache()).outcomes


def test_the_helical_stage_moves_the_train(outcomes):
    data = outcomes[Task("gear-train")].data
    first, second = data.meshes
    pair = first.pair
    # torques through the transverse base circles
    assert first.force == pytest.approx(60.0 / pair.driver.base_radius, rel=1e-9)
    assert second.force == pytest.approx(99.0 / second.pair.driver.base_radius, rel=1e-9)
    flanks = outcomes[Task("loaded-flanks", "first")].data
    te = flanks.found.transmission_error[:, flanks.at]
    s = np.mod(flanks.found.lines.roll / pair.base_pitch, 1.0)
    np.testing.assert_allclose(first.error(s), te, rtol=1e-5)
    assert first.error.mean == pytest.approx(float(flanks.found.mean_transmission_error[flanks.at]), rel=2e-3)
    values = {value.name: value for value in outcomes[Task("gear-train")].values}
    helix = pair.driver.base_helix_angle
    assert values["first.axial_force"].si == pytest.approx(first.force * math.tan(helix))
    assert "second.axial_force" not in values
    assert 0.0 < values["first.mean_stiffness"].si_error < 0.1 * values["first.mean_stiffness"].si
    assert 0.0 < values["first.static_te_peak_to_peak"].si_error < values["first.static_te_peak_to_peak"].si
    assert values["second.mean_stiffness"].si_error is None
    assert any(
        "axial force of" in remark and "on bearings assumed rigid" in remark
        for remark in outcomes[Task("gear-train")].remarks
    )


def test_spectra_of_both_stages_have_lines_from_each_other(outcomes):
    data = outcomes[Task("gear-train")].data
    table = outcomes[Task("mesh-force-spectrum", "second")].tables[0]
    columns = {column.head: np.asarray(column.values) for column in table.columns}
    own = columns["from_pair"] == "first"
    # mesh frequency of the helical stage: 20 teeth at 3000 rpm
    np.testing.assert_allclose(columns["frequency [Hz]"][own], 1000.0 * columns["n"][own], rtol=1e-12)
    assert columns["force [N]"][own].max() > 1.0
    # without the first stage's error its lines go
    still = mesh_force_spectrum(
        data.train, (data.errors[0].scaled(0.0), data.errors[1]), [data.speed_ratio * 314.159], 4
    )  # fmt: skip
    assert np.abs(still.amplitudes[1, 0]).max() == 0.0


def test_a_tooth_pair_carries_through_the_whole_plane_of_action(outcomes):
    made = outcomes[Task("tooth-force", "first")].data
    force, pair = made.force, made.train.meshes[0].pair
    reach = 0.5 * pair.face_width * math.tan(pair.driver.base_helix_angle)
    assert force.x[0] == pytest.approx(pair.x_start - reach, abs=1e-6 * pair.base_pitch)
    assert force.x[-1] == pytest.approx(pair.x_end + reach, abs=1e-6 * pair.base_pitch)
    # pairs a base pitch apart share the load
    share = np.interp(force.x, force.x, force.static)
    at = np.linspace(pair.x_start - reach, pair.x_start - reach + pair.base_pitch, 41)[1:-1]
    total = sum(np.interp(at + k * pair.base_pitch, force.x, share, left=0.0, right=0.0) for k in range(4))
    np.testing.assert_allclose(total, made.train.forces[0], rtol=0.02)


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        (["effects.friction=true", "effects.neighbour_coupling=false", "effects.corner_contact=false"],
         "applies to point contact on the path; the teeth"),
        (["effects.spacing_errors=true", f"gear.wheel_1.spacing_errors={33 * ['1 um']}"],
            "is not supported in a train with the 3D flanks"),
        (['train.mesh.second.like={pair="first"}'], "uses a 3D load distribution, which cannot be"),
        (["train.mesh.first.pair=\"third\""], "is not a pair of this case"),
        (['pair.first.torque="50 N*m"'], "make the load and the torques agree"),
    ],
)  # fmt: skip
def test_what_a_train_with_a_width_does_not_know_is_refused(overrides, words):
    def planned():
        result = () if any("results" in one for one in overrides) else ('results=["dynamic-factor"]',)
        scene = read_scene(CASE, [*COARSE, *result, *overrides])
        make_plan(scene, STAGES)

    with pytest.raises(InputError, match=words):
        planned()


def columns(outcome, name):
    (table,) = (table for table in outcome.tables if table.name == name)
    return {column.head: np.asarray(column.values) for column in table.columns}


def test_transmissibility_takes_the_mean_matrix_of_the_teeth(outcomes):
    data = outcomes[Task("mesh-stiffness-matrix", "first")].data
    made = outcomes[Task("transmissibility", "stage")].data
    moments = data.found.moments[:, :, data.flanks.at] @ data.flanks.found.lines.weight
    c, b = math.cos(made.mesh.base_helix_angle), 4e-3
    assert made.mesh.stiffness == pytest.approx(moments[0] / c**2, rel=1e-12)
    assert made.mesh.kappa == pytest.approx(c * moments[1] / moments[0] / b, rel=1e-9)
    assert made.mesh.mu == pytest.approx(c**2 * moments[2] / moments[0] / b**2, rel=1e-12)
    assert made.mesh.base_helix_angle == pytest.approx(data.found.pair.driver.base_helix_angle)
    values = {value.name: value for value in outcomes[Task("transmissibility", "stage")].values}
    assert 0.0 < values["stage.mesh_stiffness"].si_error < 0.1 * made.mesh.stiffness
    assert values["stage.omega"].si_error / values["stage.omega"].si == pytest.approx(
        0.5 * values["stage.mesh_stiffness"].si_error / made.mesh.stiffness
    )
    # masses of the case's own gears, teeth and bores
    mass, spin, _, tilt = of_gear(data.found.pair.driver)
    assert made.model.driver.mass == pytest.approx(mass, rel=1e-7)
    assert made.model.driver.inertia == pytest.approx((tilt, tilt, spin), rel=1e-7)
    # rigid bearings leave one torsional mode; the whole matrix has the same
    table = columns(outcomes[Task("transmissibility", "stage")], "helical_modes_stage")
    own, full = table["frequency [Hz]"], table["frequency_full_matrix [Hz]"]
    torsional = np.argmin(np.abs(own * 2 * math.pi - made.model.natural_frequency))
    assert own[torsional] * 2 * math.pi == pytest.approx(c * made.model.natural_frequency, rel=0.05)
    assert full[torsional] == pytest.approx(own[torsional], rel=1e-3)


def test_slow_gears_on_rigid_bearings_feel_the_force_wander_over_the_face(outcomes):
    """Speed to zero: no dynamic force, but its moment about x is that of the static force."""
    data = outcomes[Task("mesh-stiffness-matrix", "first")].data
    flanks, forces = data.flanks, outcomes[Task("pair-forced-response", "stage")].data.spectrum
    lever = tilt_lever(data.found.pair, flanks.found.lines)
    force = flanks.found.contact.force[:, :, flanks.at]
    moment = np.einsum("pm,pm->p", force, hat_averages(flanks.found.lines, lever))
    wave = 2.0 * series_over_pitch(flanks.flanks.points, moment).coefficients
    for n in (1, 2):
        wanted = wave[n]
        assert abs(forces.mesh[n - 1, 0, 2]) == pytest.approx(abs(wanted), rel=1e-3)
        assert abs(forces.normal[n - 1, 0]) < 1e-3 * abs(wanted) / 4e-3
    assert abs(forces.mesh[0, 0, 2]) > 0.01  # N m: there is something to feel


def test_tables_of_the_matrix(outcomes):
    outcome = outcomes[Task("mesh-stiffness-matrix", "first")]
    roll = columns(outcome, "mesh_stiffness_matrix_first")
    values = {value.name: value for value in outcome.values}
    weight = outcome.data.flanks.found.lines.weight
    assert np.ptp(weight) > 0.01  # a quadrature between the places where lines begin and end
    assert roll["K_M [N/um]"] @ weight == pytest.approx(values["first.K_M"].value, rel=1e-12)
    mean = columns(outcome, "mesh_stiffness_mean_first")
    heads = [head for head in mean if head != "coordinate"]
    matrix = np.array([mean[head] for head in heads]).T
    assert matrix.shape == (10, 10)
    np.testing.assert_allclose(matrix, matrix.T, rtol=1e-9, atol=1e-9 * matrix.max())
    c = math.cos(outcome.data.found.pair.driver.base_helix_angle)
    assert matrix[0, 0] == pytest.approx(values["first.K_M"].value * c**2, rel=1e-12)
    harmonics = columns(outcome, "mesh_stiffness_harmonics_first")
    assert harmonics["n"].tolist() == [1, 2, 3, 4, 5, 6]  # half of the positions
    assert harmonics["K_M [N/um]"][0] <= 2.0 / math.pi * np.ptp(roll["K_M [N/um]"])  # a square wave at most
    assert all(value.si_error is None or value.si_error >= 0.0 for value in outcome.values)
    assert values["first.mesh_mu"].si > 1.3 * values["first.mesh_mu_even"].si


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        (['transmissibility.stage.mesh.stiffness="3e8 N/m"'], "is already defined by the pair"),
        (["transmissibility.stage.driver.half_face_width=\"5 mm\""], "is not half the common face width"),
        (["transmissibility.stage.excitation.transmission_error.harmonics=4"], "is too low for 4 harmonics"),
        (['transmissibility.stage.excitation.transmission_error.flanks="rigid"'],
            "requires the mesh of the loaded flanks of the"),
        (["transmissibility.stage.mesh={}"], "is required, or a distribution over the face width, or a pair"),
        (['transmissibility.stage.mesh={stiffness="3e8 N/m"}'], "driver.mass"),
        (['transmissibility.stage.mesh.pair="second"'], "has no axial variation, which"),
    ],
)  # fmt: skip
def test_what_contradicts_the_teeth_is_refused(overrides, words):
    def planned():
        scene = read_scene(CASE, [*COARSE, 'results=["transmissibility","pair-forced-response"]', *overrides])
        make_plan(scene, STAGES)
        for stage in STAGES:
            if stage.name in ("transmissibility", "pair-forced-response"):
                stage.inputs(scene, "stage")

    with pytest.raises(InputError, match=words):
        planned()


def test_unknown_pairs_are_named():
    with pytest.raises(InputError, match="is not a pair of this case"):
        read_scene(CASE, ['transmissibility.stage.mesh.pair="J"'])


def test_the_cost_of_teeth_over_their_face_is_not_studied():
    with pytest.raises(InputError, match=r"requires plane \(2D\) teeth in the entire train; pair first is 3D"):
        asked(read_scene(CASE, [*COARSE, 'cost.quantities=["dynamic-factor"]']))
    found = asked(read_scene(CASE, COARSE))  # at rest instead, and said
    assert not {quantity.name for quantity in found.quantities} & {"dynamic-factor", "tooth-force"}
    assert "pair first is 3D" in found.notes[0]
    scene = read_scene(CASE, [*COARSE, 'cost.quantities=["te-peak-to-peak"]'])
    assert asked(scene).pairs == ("second",)
