"""A wide helical ring in a spline and on pins compared with CalculiX: quadratic solids of all its teeth."""

import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from fegear.fem.plane.root_stress import extreme
from fegear.fem.solid.bands import bands
from fegear.fem.solid.settings import solid_settings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.rim_support import RimSupport

sys.path.insert(0, str(Path(__file__).parent))
import solid_by_calculix as calculix
import wide_rim_by_calculix as ring


def band(name):
    low, top, high = calculix.hat(calculix.BANDS[name][1])
    return bands(ring.RING.radius, top, top - low, calculix.HALF_WIDTH, after=high - top)


@pytest.mark.long
@pytest.mark.parametrize("load", ["middle", "front"])
def test_a_whole_wide_ring_in_a_spline_is_that_of_calculix(tmp_path, program, load):
    """70 s of CalculiX a load, 72,000 nodes. Seen: deflections .2 %; root compression .4 % of the largest."""
    beta = math.radians(20.0)
    mesh, named = calculix.solid(beta, 1.0, (0.5,), 0.5, shape=ring.RING)
    moved = ring.solve(tmp_path, mesh, named[load], program("ccx"))
    known = solve_solid(
        ring.RING.tooth, calculix.twist_of(beta, ring.RING), calculix.FACE, calculix.NU, ring.RING.bore,
        solid_settings(3e-3), support=RimSupport(),
    )  # fmt: skip
    for name, (tooth, _) in calculix.BANDS.items():
        mine = float(known.deflection(tooth, band(name), band(load))[0, 0])
        assert mine == pytest.approx(calculix.deflection(moved, named[name]), rel=3e-3)
    mine = known.largest_root_stress(0, "compression", band(load), calculix.STATIONS)[0][:, 0]
    wanted = calculix.largest_along(mesh, moved, "back_fillet", -1, -1)
    np.testing.assert_allclose(mine, wanted, atol=8e-3 * np.abs(wanted).max())


#: The kinks of a hat ask for short waves along the face: with fewer of them all teeth give way .05 less.
WAVES = replace(solid_settings(3e-3), waves_per_module=3.5, fewest_waves=9.0, wave_reach=4.0)
PINS = RimSupport(5, 1.5, 0.1)


def largest_over_the_face(mesh, moved, name, sign):
    zeta, arc, stress = calculix.surface_stress(mesh, moved, mesh.section.boundaries[name, 0], -1)
    value = extreme(stress[0].T, arc, sign, arc[-1])[0]
    return sign * CubicSpline(zeta, sign * value)(np.linspace(zeta[0], zeta[-1], 201)).max()


@pytest.mark.long
def test_a_whole_wide_ring_on_pins_is_that_of_calculix(tmp_path, program):
    """150 s of CalculiX a tooth. Seen: deflections .3 %, root compression .1 %, root tension .3 %."""
    beta, pitch = math.radians(20.0), 2.0 * math.pi / ring.RING.tooth.teeth
    known = solve_solid(
        ring.RING.tooth, calculix.twist_of(beta, ring.RING), calculix.FACE, calculix.NU, ring.RING.bore, WAVES,
        support=PINS, compared=band("middle"),
    ).uneven  # fmt: skip
    mesh, named = calculix.solid(beta, 1.0, (0.5,), 0.5, shape=ring.RING)
    for tooth in (0, 1):  # the second gives way half as much
        held = ring.held_by_pins(mesh, replace(PINS, angle=PINS.angle - tooth * pitch), 5)
        moved = ring.solve(tmp_path, mesh, named["middle"], program("ccx"), held)
        wanted = calculix.deflection(moved, named["middle"])
        assert known.deflection[tooth] == pytest.approx(wanted, rel=5e-3)
        compression = largest_over_the_face(mesh, moved, "back_fillet", -1.0)
        assert known.root_compression[tooth] == pytest.approx(compression, rel=1e-2)
        tension = largest_over_the_face(mesh, moved, "fillet", 1.0)
        assert known.root_tension[tooth] == pytest.approx(tension, rel=2e-2)


def test_tractions_of_the_spline_have_the_cylinder_s_area_and_moments():
    mesh, _ = calculix.solid(0.0, 6.0, (0.5,), 0.5, shape=ring.RING)
    work = np.einsum("rcn,scn->rs", ring.rigid(mesh.points), ring.even_tractions(mesh))
    outer, width = ring.RING.bore, calculix.FACE
    tilt = 0.5 * outer**2 + width**2 / 12.0
    wanted = 2.0 * math.pi * outer * width * np.diag([1.0, 1.0, 1.0, tilt, tilt, outer**2])
    np.testing.assert_allclose(work, wanted, atol=1e-4 * wanted.max())
