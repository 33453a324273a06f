"""A pair's motion beside Newmark's method on the mesh stiffness and the transmission error that Python hands out."""

import numpy as np
import pytest

import fegear

#: Steps of Newmark's method over a tooth; teeth until the motion is steady (0.44 of a transient is left per tooth).
STEPS, TEETH = 1000, 25


def newmark(mass, damping, stiffness, te, force, step):
    """Largest force of spring and damper over the mean force, in the last tooth."""
    d, v, largest = te[0], 0.0, 0.0
    a = -damping * v / mass
    for n in range(1, TEETH * STEPS + 1):
        k, e = stiffness[n % STEPS], te[n % STEPS]
        d_0, v_0 = d + step * v + 0.25 * step**2 * a, v + 0.5 * step * a
        a = -(damping * v_0 + k * (d_0 - e)) / (mass + 0.5 * step * damping + 0.25 * step**2 * k)
        d, v = d_0 + 0.25 * step**2 * a, v_0 + 0.5 * step * a
        if n > (TEETH - 1) * STEPS:
            largest = max(largest, force + k * (d - e) + damping * v)
    return largest / force


@pytest.mark.dear
def test_newmark_on_the_curves_of_a_pair_is_its_motion():
    """Without loss of contact, near a third and half of the resonance: tangent, damping at the mean compliance."""
    pinion = fegear.Gear(23, "3 mm", profile_shift=0.3, bore_radius="15 mm", face_width="10 mm", name="pinion")
    wheel = fegear.Gear(57, "3 mm", profile_shift=-0.1, bore_radius="40 mm", face_width="10 mm", name="wheel")
    pair, speeds, zeta = fegear.Pair(pinion, wheel), (5000.0, 8000.0), 0.07
    asked = {"torque": "90 N*m", "tolerance": 3e-3}
    mesh = fegear.transmission_error(pair, **asked)
    motion = fegear.dynamic_factor(
        pair, speeds=[f"{n} rpm" for n in speeds], damping_ratio=zeta, effects={"contact_loss": False}, **asked
    )
    radii = np.array([gear.geometry.base_radius for gear in (pinion, wheel)])
    inertias = np.array([motion.values[f"{gear}.inertia"].si for gear in ("driver", "driven")])
    mass, force = 1.0 / np.sum(radii**2 / inertias), 90.0 / radii[0]
    angle = 2.0 * np.pi / 23 * np.arange(STEPS) / STEPS
    stiffness, te = mesh.mesh_stiffness(angle), mesh.transmission_error(angle)
    mean = 1.0 / np.mean(1.0 / stiffness)
    assert motion.values["I.mean_stiffness"].si == pytest.approx(mean, rel=1e-3)
    damping = 2.0 * zeta * np.sqrt(mean * mass)
    factors = motion.tables["dynamic_factor_I"]["mesh_force_factor"]
    for rpm, factor in zip(speeds, factors, strict=True):
        own = newmark(mass, damping, stiffness, te, force, 60.0 / (rpm * 23 * STEPS))
        assert factor == pytest.approx(own, rel=2e-3)
        assert factor > 1.3
