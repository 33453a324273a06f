"""Ring gears compared with a prototype of the project: compliances, neighbours and root stress of one ring.

``fegear/verify/data/ring_prototype.json`` has inputs, definitions and numbers on two levels: 60 teeth, 5 positions
over the flank. It is no literature. `solve_alone` has the whole ring in scikit-fem, without ring closure or
reference elements.
"""

from __future__ import annotations

from dataclasses import replace

import numpy as np
import pytest

from fegear.fem.plane.estimate import Estimate
from fegear.fem.plane.influence import Influence
from fegear.fem.plane.scikit_fem_alone import solve_alone
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solved_ring import solve_influence
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter
from fegear.verify.kept import kept

RING = kept("ring_prototype")["case"]
INPUTS = RING["inputs"]
WIDTH = np.asarray(0.02)
RADII = np.array([row["R"] for row in RING["rows"]])


def column(name: str) -> np.ndarray:
    return np.array([row[name] for row in RING["rows"]])


def solved_ring(tooth: InternalTooth, rim: float, level: int) -> Influence:
    settings = settings_at(level)
    mesh = mesh_sector(tooth, tooth.root_radius + rim, settings)
    corner = settings.corner_distance
    return solve_influence(
        tooth, mesh, RING["nu"], "strain", order=settings.order, reach=1, corner_distance=corner, two_orders=True
    )


def estimate_of(fine: Influence, level: int) -> Estimate:
    coarser = settings_at(level - 1)
    lower = replace(fine.lower, corner_distance=coarser.corner_distance)
    return Estimate(fine, lower, settings_at(level).patch_half_width, coarser.patch_half_width)


@pytest.fixture(scope="module")
def tooth() -> InternalTooth:
    cutter = INPUTS["cutter"]
    made = PinionCutter(cutter["z0"], cutter["x0"], cutter["ha0"], tip_radius=cutter["rho"])
    return InternalTooth(INPUTS["z"], made, profile_shift=INPUTS["x"], tip_radius=INPUTS["ra"])


@pytest.fixture(scope="module")
def solved(tooth):
    return solved_ring(tooth, INPUTS["rim"], 0)


@pytest.fixture(scope="module")
def estimate(solved):
    return estimate_of(solved, 0)


def test_circles_and_thicknesses_are_those_of_the_prototype(tooth):
    numbers = RING["numbers"]
    assert 2.0 * tooth.root_radius == pytest.approx(numbers["d_f"], rel=1e-13)
    assert 2.0 * tooth.form_radius == pytest.approx(numbers["d_Ff"], rel=1e-13)
    assert 2.0 * tooth.base_radius == pytest.approx(numbers["d_b"], rel=1e-13)
    assert 2.0 * tooth.limit_radius == pytest.approx(numbers["d_tip_limit"], rel=1e-13)
    for radius, thickness in ((tooth.tip_radius, "s_a"), (tooth.form_radius, "s_Ff"), (tooth.pitch_radius, "s_ref")):
        assert 2.0 * radius * float(tooth.half_thickness_angle(radius)) == pytest.approx(numbers[thickness], rel=1e-12)


def test_own_compliance(estimate):
    value, error, _ = estimate.contact(RADII, WIDTH)
    off = np.abs(value - column("c0_fegear"))
    assert (off <= 2e-4 * value).all()
    between = np.abs(column("c0_fegear") - column("c0_fegear_coarse_level"))
    assert (off <= 1.5 * error + between).all()


@pytest.mark.parametrize(("k", "name"), [(1, "next"), (-1, "prev")])
def test_neighbours(estimate, k, name):
    """A held rim is stiff: beside the tip the neighbour moves toward the load, by a negative c_next."""
    value, error = estimate.neighbour(k, RADII, RADII)
    wanted = np.array(RING["neighbour_matrices"][name])
    off = np.abs(value - wanted)
    assert (off <= 2e-4 * column("c0_fegear")).all()
    assert (off <= 1.5 * error + 1.2e-3 * np.abs(wanted)).all()  # levels of the prototype differ by so much
    assert value[0, 0] < 0.0


@pytest.mark.parametrize("side", ["tension", "compression"])
def test_root_stress(estimate, side):
    value, _, error = estimate.root_stress(0, side, RADII, WIDTH)
    off = np.abs(value - column(f"root_{side}"))
    assert (off <= 2e-4 * np.abs(value)).all()
    between = np.abs(column(f"root_{side}") - column(f"root_{side}_coarse"))
    assert (off <= 1.5 * error + between).all()


@pytest.mark.long
@pytest.mark.parametrize(
    ("x", "cutter", "rim"), [(0.0, PinionCutter(25, tip_radius=0.3), 3.5), (0.3, PinionCutter(20, 0.1), 1.2)]
)
def test_the_whole_ring_by_scikit_fem_alone(x, cutter, rim):
    """Another discretisation: all teeth in one system, pressures resolved below each contact."""
    tooth = InternalTooth(50, cutter, profile_shift=x, tip_radius=24.0)
    radii = tooth.radius_of_roll(
        np.linspace(*(float(tooth.roll(r)) for r in (tooth.form_radius, tooth.tip_radius)), 7)[1:-1]
    )
    told = estimate_of(solved_ring(tooth, rim, -1), -1)
    alone = solve_alone(tooth, tooth.root_radius + rim, 0.3, "strain", settings_at(-1), radii, WIDTH)
    own, error, _ = told.contact(radii, WIDTH)
    assert (np.abs(own - alone.c_self) <= 1.5 * error + 2e-5 * own).all()
    for k, wanted in ((1, alone.c_next), (-1, alone.c_prev)):
        value, error = told.neighbour(k, radii, radii)
        assert (np.abs(np.diag(value) - wanted) <= 1.5 * np.diag(error) + 2e-6 * own).all()
    for side, wanted in (("tension", alone.root_tension), ("compression", alone.root_compression)):
        value, _, error = told.root_stress(0, side, radii, WIDTH)
        assert (np.abs(value - wanted) <= 1.5 * error + 1e-4 * np.abs(value)).all()


def test_maxwell_s_reciprocity(solved):
    """c_next(p, q) is c_prev(q, p), on a hollow flank as on any."""
    after = solved.neighbour(1, RADII, RADII, settings_at(0).patch_half_width)
    before = solved.neighbour(-1, RADII, RADII, settings_at(0).patch_half_width)
    np.testing.assert_allclose(after, before.T, rtol=1e-10, atol=1e-12)
