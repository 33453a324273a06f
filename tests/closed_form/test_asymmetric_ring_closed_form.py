"""The plane ring with teeth whose flanks differ: equal flanks as ever, either flank loaded, mirrored, turned round."""

import math
from dataclasses import replace

import numpy as np
import pytest

from fegear.fem.plane.elasticity import assemble
from fegear.fem.plane.mesh import SectorMesh
from fegear.fem.plane.ring_closure import close_ring
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import influence_of_shape
from fegear.fem.plane.solved_ring import solve_influence
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.fem.plane.trace import loaded_flank
from fegear.geometry.asymmetric_rack import AsymmetricRack, RackFlank
from fegear.geometry.asymmetric_tooth import AsymmetricTooth
from fegear.geometry.external_tooth import Tooth

NU, WIDTH = 0.3, 0.1
SETTINGS = settings_at(-3).scaled(2.0)
TOOTH = AsymmetricTooth(
    20, AsymmetricRack(RackFlank(math.radians(20.0), 0.25), RackFlank(math.radians(30.0), 0.2)), 0.2, tip_rounding=0.08
)


def solved(side, settings=SETTINGS):
    return influence_of_shape(side, 0.6 * side.root_radius, NU, "strain", settings, 1)


def radii(side):
    low, high = side.involute_radii
    return np.sqrt(np.linspace(low**2, high**2, 6)[1:-1])


def answers(found, at):
    """All that a ring is asked for: own and neighbours' compliance, stress in both fillets of three teeth."""
    yield found.self_compliance(at, 0.2, WIDTH)
    for k in (-1, 1):
        yield found.neighbour(k, at, at, 0.2)
    for k in (-1, 0, 1):
        for side in ("tension", "compression"):
            yield found.largest_root_stress(k, side, at, WIDTH)[0]


def test_equal_flanks_give_the_digits_of_the_symmetric_tooth():
    equal = AsymmetricTooth(17, AsymmetricRack(), 0.2)
    usual = Tooth(17, profile_shift=0.2)
    at = radii(usual)
    wanted = list(answers(solved(usual), at))
    for side in (equal.drive, equal.coast):
        for one, other in zip(answers(solved(side), at), wanted, strict=True):
            assert np.array_equal(one, other)


def test_a_gear_turned_round_is_loaded_on_its_other_flank():
    at = radii(TOOTH.coast)
    for one, other in zip(answers(solved(TOOTH.coast), at), answers(solved(TOOTH.reversed.drive), at), strict=True):
        assert one == pytest.approx(other, rel=1e-12)


def test_pressing_the_left_flank_is_pressing_the_right_one_of_the_mirrored_mesh():
    """One mesh, made for the drive flank: its coast flank pressed where it stands, and in the mirror by the ring."""
    tooth = replace(TOOTH, tip_rounding=0.0)
    mesh = mesh_sector(tooth.drive, 0.6 * tooth.root_radius, SETTINGS)
    swap = {"flank": "back_flank", "fillet": "back_fillet"} | {"back_flank": "flank", "back_fillet": "fillet"}
    names = {swap.get(name, name): edges[[1, 0, 2]] for name, edges in mesh.edges.items()}
    # the sides run from the bore outward on either
    names |= {"side_a": mesh.edges["side_b"], "side_b": mesh.edges["side_a"]}
    flip = np.array([[-1.0], [1.0]])
    mirrored = SectorMesh(flip * mesh.points, mesh.triangles[[0, 2, 1, 5, 4, 3]], names, mesh.teeth, mesh.origin)
    here, there = (assemble(one, NU, "strain", 2) for one in (mesh, mirrored))
    flank = loaded_flank(mirrored, there, tooth.coast, 0.15)
    at = flank.arc_of_radius(radii(tooth.coast)[:3])
    loads = flank.patches(at, np.full(at.size, WIDTH))
    across, up = (
        [{int(dof): node for node, dof in enumerate(there.node_dofs[i])}[int(dof)] for dof in half]
        for i, half in enumerate(np.split(flank.dofs, 2))
    )
    dofs = np.concatenate([here.node_dofs[0][across], here.node_dofs[1][up]])
    pushed = loads * np.repeat([-1.0, 1.0], flank.nodes)[:, None]
    left = close_ring(mesh, here, dofs, 1).respond(dofs, dofs)
    right = close_ring(mirrored, there, flank.dofs, 1).respond(flank.dofs, flank.dofs)
    for k in (-1, 0, 1):
        assert pushed.T @ left[k] @ pushed == pytest.approx(loads.T @ right[-k] @ loads, rel=1e-12)
    found = solve_influence(tooth.coast, mirrored, NU, "strain", order=2)
    assert found.compliance[0] == pytest.approx(right[0], rel=1e-12)


def test_neighbours_are_reciprocal_on_either_flank():
    for side in (TOOTH.drive, TOOTH.coast):
        found, at = solved(side), radii(side)
        assert found.neighbour(1, at, at, 0.2) == pytest.approx(found.neighbour(-1, at, at, 0.2).T, rel=1e-12)
