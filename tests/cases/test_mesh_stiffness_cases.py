"""Mesh stiffness matrix of a case's own teeth: its tables, and what transmissibility and pair forces take from it."""

import math
from pathlib import Path

import numpy as np
import pytest

from fegear.case.reading import read_scene
from fegear.contact.flank.complementarity import hat_averages
from fegear.contact.flank.mesh_matrix import tilt_lever
from fegear.contact.flank.transmission_error import series_over_pitch
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.errors import InputError
from fegear.results.catalogue import STAGES
from fegear.solution_cache import SolutionCache

CASE = """
results = ["mesh-stiffness-matrix", "transmissibility", "pair-forces"]

[gear.pinion]
teeth = 20
normal_module = "3 mm"
helix_angle = "15 deg"
hand = "right"
face_width = "6 mm"

[gear.wheel]
teeth = 28
normal_module = "3 mm"
helix_angle = "15 deg"
hand = "left"
face_width = "6 mm"

[pair.I]
driver = "pinion"
driven = "wheel"
load = "1800 N"

[transmissibility.A]
mesh = { pair = "I" }
driver = { bearing = { y = "1e12 N/m", z = "1e12 N/m", theta_x = "1e8 N*m/rad", theta_y = "1e8 N*m/rad" } }
driven = { bearing = { y = "1e12 N/m", z = "1e12 N/m", theta_x = "1e8 N*m/rad", theta_y = "1e8 N*m/rad" } }
frequencies = 5
damping_ratio = 0.03

[transmissibility.A.excitation]
speeds = ["0.01 rpm"]
transmission_error = { pair = "I", shuttling = true, harmonics = 2 }

[load_distribution]
positions = 12
panels = 6

[effects]
neighbour_coupling = true

[accuracy]
tolerance = 1e-1
"""


@pytest.fixture(scope="module")
def folder(tmp_path_factory):
    return tmp_path_factory.mktemp("mesh")


@pytest.fixture(scope="module")
def cache():
    return SolutionCache()


def scene_of(folder, *overrides, text=CASE):
    path = folder / "case.toml"
    path.write_text(text, encoding="utf-8")
    return read_scene(path, overrides)


@pytest.fixture(scope="module")
def outcomes(folder, cache):
    scene = scene_of(folder)
    return run_plan(scene, make_plan(scene, STAGES), cache=cache).outcomes


def columns(outcome, name):
    (table,) = (table for table in outcome.tables if table.name == name)
    return {column.head: np.asarray(column.values) for column in table.columns}


def test_transmissibility_takes_the_mean_matrix_of_the_teeth(outcomes):
    data = outcomes[Task("mesh-stiffness-matrix", "I")].data
    made = outcomes[Task("transmissibility", "A")].data
    moments = data.found.moments[:, :, data.flanks.nominal] @ data.flanks.found.lines.weight
    c, b = math.cos(made.mesh.base_helix_angle), 3e-3
    assert made.mesh.stiffness == pytest.approx(moments[0] / c**2, rel=1e-12)
    assert made.mesh.kappa == pytest.approx(c * moments[1] / moments[0] / b, rel=1e-9)
    assert made.mesh.mu == pytest.approx(c**2 * moments[2] / moments[0] / b**2, rel=1e-12)
    assert made.mesh.base_helix_angle == pytest.approx(data.found.pair.driver.base_helix_angle)
    values = {value.name: value for value in outcomes[Task("transmissibility", "A")].values}
    assert 0.0 < values["A.mesh_stiffness"].si_error < 0.1 * made.mesh.stiffness
    assert values["A.omega"].si_error / values["A.omega"].si == pytest.approx(
        0.5 * values["A.mesh_stiffness"].si_error / made.mesh.stiffness
    )
    # masses of the case's own gears, discs with their bores
    pinion = data.found.pair.driver
    mass = 7850.0 * math.pi * (pinion.pitch_radius**2 - pinion.bore_radius**2) * 6e-3
    assert made.model.driver.mass == pytest.approx(mass, rel=0.01)
    # rigid bearings leave one torsional mode; the whole matrix has the same
    table = columns(outcomes[Task("transmissibility", "A")], "helical_modes_A")
    own, full = table["frequency [Hz]"], table["frequency_full_matrix [Hz]"]
    torsional = np.argmin(np.abs(own * 2 * math.pi - made.model.natural_frequency))
    assert own[torsional] * 2 * math.pi == pytest.approx(c * made.model.natural_frequency, rel=0.05)
    assert full[torsional] == pytest.approx(own[torsional], rel=1e-3)


def test_slow_gears_on_rigid_bearings_feel_the_force_wander_over_the_face(outcomes):
    """Speed to zero: no dynamic force, but its moment about x is that of the static force."""
    data = outcomes[Task("mesh-stiffness-matrix", "I")].data
    flanks, forces = data.flanks, outcomes[Task("pair-forces", "A")].data.spectrum
    lever = tilt_lever(data.found.pair, flanks.found.lines)
    force = flanks.found.contact.force[:, :, flanks.nominal]
    moment = np.einsum("pm,pm->p", force, hat_averages(flanks.found.lines, lever))
    wave = 2.0 * series_over_pitch(flanks.flanks.points, moment).coefficients
    for n in (1, 2):
        wanted = wave[n]
        assert abs(forces.mesh[n - 1, 0, 2]) == pytest.approx(abs(wanted), rel=1e-3)
        assert abs(forces.normal[n - 1, 0]) < 1e-3 * abs(wanted) / 3e-3
    assert abs(forces.mesh[0, 0, 2]) > 0.01  # N m: there is something to feel


def test_tables_of_the_matrix(outcomes):
    outcome = outcomes[Task("mesh-stiffness-matrix", "I")]
    roll = columns(outcome, "mesh_stiffness_matrix_I")
    values = {value.name: value for value in outcome.values}
    weight = outcome.data.flanks.found.lines.weight
    assert np.ptp(weight) > 0.01  # a quadrature between the places where lines begin and end
    assert roll["K_M [N/um]"] @ weight == pytest.approx(values["I.K_M"].value, rel=1e-12)
    mean = columns(outcome, "mesh_stiffness_mean_I")
    heads = [head for head in mean if head != "coordinate"]
    matrix = np.array([mean[head] for head in heads]).T
    assert matrix.shape == (10, 10)
    np.testing.assert_allclose(matrix, matrix.T, rtol=1e-9, atol=1e-9 * matrix.max())
    c = math.cos(outcome.data.found.pair.driver.base_helix_angle)
    assert matrix[0, 0] == pytest.approx(values["I.K_M"].value * c**2, rel=1e-12)
    harmonics = columns(outcome, "mesh_stiffness_harmonics_I")
    assert harmonics["n"].tolist() == [1, 2, 3, 4, 5, 6]  # half of the positions
    assert harmonics["K_M [N/um]"][0] <= 2.0 / math.pi * np.ptp(roll["K_M [N/um]"])  # a square wave at most
    assert all(value.si_error is None or value.si_error >= 0.0 for value in outcome.values)
    assert values["I.mesh_mu"].si > 1.3 * values["I.mesh_mu_even"].si


@pytest.mark.parametrize(
    ("overrides", "words"),
    [
        (['transmissibility.A.mesh.stiffness="3e8 N/m"'], "comes from the teeth of the pair already"),
        (["transmissibility.A.driver.half_face_width=\"5 mm\""], "is not half the common face width"),
        (["transmissibility.A.excitation.transmission_error.harmonics=4"], "too few for 4 harmonics"),
        (['transmissibility.A.excitation.transmission_error.flanks="rigid"'], "known of the loaded flanks"),
        (["transmissibility.A.mesh={}"], "distribution over the face or a pair"),
        (['transmissibility.A.mesh={stiffness="3e8 N/m"}'], "driver.mass"),
        (['gear.pinion.helix_angle="0 deg"', 'gear.pinion.hand="spur"', 'gear.wheel.helix_angle="0 deg"',
          'gear.wheel.hand="spur"'], "knows no motion along the face"),
    ],
)  # fmt: skip
def test_what_contradicts_the_teeth_is_refused(folder, overrides, words):
    def planned():
        scene = scene_of(folder, *overrides, 'results=["transmissibility","pair-forces"]')
        make_plan(scene, STAGES)
        for stage in STAGES:
            if stage.name in ("transmissibility", "pair-forces"):
                stage.inputs(scene, "A")

    with pytest.raises(InputError, match=words):
        planned()


def test_unknown_pairs_are_named(folder):
    with pytest.raises(InputError, match="is no pair of this case"):
        scene_of(Path(folder), 'transmissibility.A.mesh.pair="J"')
