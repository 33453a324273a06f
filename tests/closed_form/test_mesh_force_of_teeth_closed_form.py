"""The force in a mesh as the sum of the forces on its teeth (Mark, after Eq. 3.36), against laws that it must obey."""

import math
from functools import cache
from pathlib import Path

import numpy as np
import pytest
from solved_once import CACHE

from fegear.case.reading import read_scene
from fegear.dynamics.train.mesh_excitation import tooth_pair_at
from fegear.dynamics.train.mesh_force_spectrum import mesh_force_spectrum
from fegear.dynamics.train.single_tooth import mesh_force
from fegear.engine.plan import make_plan
from fegear.engine.run import run_plan
from fegear.engine.stage import Task
from fegear.results.catalogue import STAGES

CASES = Path(__file__).parents[2] / "cases"
UNEVEN = "gear.test.spacing_errors=['0 um', '3 um', '0 um', '-4 um', *]".replace("*", ", ".join(["'0 um'"] * 24))
RIGS: dict[str, tuple[str, ...]] = {"even": (), "uneven": (UNEVEN, "effects.spacing_errors=true")}
HARMONICS = 256


@cache
def train(rig):
    scene = read_scene(CASES / "four_square_dynamics.toml", ("results=['gear-train']", *RIGS[rig]))
    return run_plan(scene, make_plan(scene, STAGES), cache=CACHE).outcomes[Task("gear-train")].data


def stiffness_of_all(data, i, phase):
    """Stiffness of the loaded tooth pairs together, each at its own place."""
    mesh, total = data.meshes[i], np.zeros(phase.size)
    for j in range(math.floor(phase[0]) - 3, math.ceil(phase[-1]) + 4):
        k, m = tooth_pair_at(mesh.excitation, (phase - j) * mesh.pair.base_pitch, mesh.pair.base_pitch, j)
        total += np.where(mesh.error(phase) > m, k, 0.0)
    return total


@pytest.mark.parametrize("rig", RIGS)
@pytest.mark.parametrize("number", [0, 2])
def test_teeth_answer_a_vibration_with_the_stiffness_of_that_moment(rig, number):
    """And at rest they carry the mean force at every phase."""
    data = train(rig)
    for i in range(2):
        mean, spring = data.forces[i], data.train.meshes[i].stiffness
        found = mesh_force(data, i, 600.0, 41, HARMONICS, number)
        share = stiffness_of_all(data, i, found.phase) / spring
        np.testing.assert_allclose(found.of_teeth - mean, share * (found.by_mean_stiffness - mean), atol=1e-6 * mean)
        assert np.ptp(share) > 0.3
        assert found.phase[0] == number
        assert set(found.pairs) == {1, 2}


def test_by_the_mean_stiffness_it_is_the_sum_of_its_lines():
    """Lines of both meshes; above 256 harmonics the teeth follow the static transmission error without inertia."""
    data, speed = train("even"), 800.0
    found = mesh_force(data, 0, speed, 41, HARMONICS)
    reference = speed / data.speed_ratio
    lines = mesh_force_spectrum(data.train, data.errors, [reference], HARMONICS, phases=data.phases)
    at = found.time - data.phases[0] / float(data.train.mesh_frequencies(reference)[0])
    waves = np.exp(2j * math.pi * np.multiply.outer(lines.frequencies[:, :, 0], at))
    total = data.forces[0] + 2.0 * np.real(np.einsum("jn,jnt->t", lines.coefficients[0, :, :, 0], waves))
    n, error = np.arange(1, HARMONICS + 1), data.errors[0]
    summed = error.mean + 2.0 * np.real(np.exp(2j * math.pi * np.outer(found.phase, n)) @ error.fourier(n))
    total += data.train.meshes[0].stiffness * (summed - error(found.phase))
    np.testing.assert_allclose(found.by_mean_stiffness, total, atol=1e-9 * data.forces[0])
