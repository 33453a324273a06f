"""Asymmetric teeth with a width, slices and solid: equal flanks as ever, turned round, in a mirror, plane strain."""

import copy
import functools
import math
from dataclasses import replace

import numpy as np
import pytest

import fegear
from fegear.base.solution_cache import SolutionCache
from fegear.fem.plane.solved_ring import solve_influence
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.fem.solid.bands import bands
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.slices import solve_slices
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.asymmetric_rack import AsymmetricRack, RackFlank
from fegear.geometry.asymmetric_tooth import AsymmetricTooth
from fegear.geometry.external_tooth import Tooth

BETA, NU, FACE = math.radians(15.0), 0.3, 3.0
#: Four functions along the face.
CUBIC = replace(SolidSettings().scaled(1.3), least_degree=3, waves_per_module=1e-3)
RACK = AsymmetricRack(RackFlank(math.radians(28.0), 0.15), RackFlank(math.radians(20.0), 0.25))
ASYMMETRIC = AsymmetricTooth(17, RACK, 0.1, helix_angle=BETA)
SOLVERS = {"slices": solve_slices, "solid": solve_solid}


@functools.cache
def solved(how, side):
    return SOLVERS[how](side, side.twist, FACE, NU, 0.6 * side.root_radius, CUBIC, reach=1)


def answers(found, radius):
    """Deflections of three teeth and stress of both fillets under a band off the middle of the face."""
    one = bands(radius, 0.2, 0.5, 0.25)
    moved = [found.deflection(k, one, one)[0] for k in (-1, 0, 1)]
    return np.hstack([*moved, *(found.largest_root_stress(0, side, one, [0.0, 0.5])[0].ravel()
                                for side in ("tension", "compression"))])  # fmt: skip


@pytest.mark.dear("slices", "solid")
@pytest.mark.parametrize("how", SOLVERS)
def test_equal_flanks_give_the_digits_of_the_symmetric_tooth(how):
    usual, equal = Tooth(17, profile_shift=0.2, helix_angle=BETA), AsymmetricTooth(17, AsymmetricRack(), 0.2,
                                                                                  helix_angle=BETA)  # fmt: skip
    wanted = answers(solved(how, usual), 8.9)
    for side in (equal.drive, equal.coast):
        assert np.array_equal(answers(solved(how, side), 8.9), wanted)


@pytest.mark.dear("slices", "solid")
@pytest.mark.parametrize("how", SOLVERS)
def test_a_gear_turned_round_is_loaded_on_its_other_flank(how):
    one, other = (answers(solved(how, side), 9.0) for side in (ASYMMETRIC.coast, ASYMMETRIC.reversed.drive))
    assert one == pytest.approx(other, rel=1e-12)
    assert np.abs(answers(solved(how, ASYMMETRIC.drive), 9.0) / one - 1.0).min() > 0.01


@pytest.mark.parametrize("flank", ["drive", "coast"])
def test_without_twist_and_axial_motion_it_is_the_plane_ring(flank):
    side = AsymmetricTooth(17, RACK, 0.1).side(flank)
    held = 0.6 * side.root_radius
    mesh = mesh_sector(side, held, CUBIC.section)
    plane = solve_influence(side, mesh, NU, "strain", order=3, margin=0.0)
    solid = solve_solid(side, 0.0, 2.0, NU, held, CUBIC, mesh=mesh, plane_strain=True)
    radius = np.sqrt(np.linspace(side.form_radius**2, side.involute_tip_radius**2, 5)[1:-1])
    everywhere = bands(radius, 0.0, 1.0, np.full(3, 0.2), profile="even")
    loads = plane.flank.patches(plane.flank.arc_of_radius(radius), np.full(3, 0.2))
    for k in (-1, 0, 1):
        found = 2.0 * solid.deflection(k, everywhere, everywhere)
        np.testing.assert_allclose(found, loads.T @ plane.compliance[k] @ loads, rtol=2e-4)
        for fillet in ("tension", "compression"):
            stress = 2.0 * solid.fillet_stress(k, fillet, everywhere, [0.3])[0, :, 0]
            wanted = plane.stress[k, fillet] @ loads
            np.testing.assert_allclose(stress, wanted, atol=2e-4 * np.abs(wanted).max())


def case(flanks, flank, width):
    """A helical pair."""
    (drive, tip), (coast, beside) = flanks

    def gear(teeth, shift, bore, hand):
        return {
            "teeth": teeth, "normal_module": "3 mm", "helix_angle": "16 deg", "hand": hand, "profile_shift": shift,
            "pressure_angle": f"{drive} deg", "coast_pressure_angle": f"{coast} deg", "bore_radius": bore,
            "rack": {"tip_radius": tip, "coast_tip_radius": beside}, "face_width": "12 mm",
            "thickness_allowance": "30 um",
        }  # fmt: skip

    return {
        "results": ["load-distribution", "transmission-error", "root-stress-history"],
        "gear": {"p": gear(17, 0.2, "10 mm", "right"), "w": gear(25, 0.0, "18 mm", "left")},
        "pair": {"I": {"driver": "p", "driven": "w", "load": "3 kN", "width": width, "flank": flank}},
        "effects": {"neighbour_coupling": True, "hertz": "load-dependent"}, "accuracy": {"tolerance": 5e-2},
    }  # fmt: skip


@pytest.mark.dear
@pytest.mark.parametrize("width", ["slices", "solid"])
def test_a_helical_pair_with_exchanged_flanks_is_the_same_pair(width):
    steep, flat = (28, 0.15), (20, 0.25)
    cache = SolutionCache()

    def values(*asked):
        found = fegear.run(copy.deepcopy(case(*asked, width)), cache=cache).values
        return {key: float(one.value) for key, one in found.items() if isinstance(one.value, (int, float))}

    one, other = values((steep, flat), "coast"), values((flat, steep), "drive")
    assert len(one) > 15
    assert one.keys() == other.keys()
    for key, value in one.items():
        assert other[key] == pytest.approx(value, rel=1e-12, abs=1e-15), key
    assert "I.K_Hbeta" in one
    assert "I.K_Hbeta_iso" not in one  # the standard knows equal flanks only
    if width == "slices":
        crowned = case((steep, flat), "coast", width)
        crowned["effects"]["relief"] = True
        for gear in crowned["gear"].values():
            gear["lead"] = {"crowning": "6 um"}
        found = fegear.run(crowned, cache=cache).values
        assert float(found["I.K_Hbeta"].value) > 1.05 * one["I.K_Hbeta"]
