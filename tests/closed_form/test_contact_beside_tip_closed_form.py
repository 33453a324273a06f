"""c_0 beside the tip against a true contact: a rigid parabola pressed on the tooth, with the pressure that it finds."""

import functools
from dataclasses import replace

import numpy as np
import pytest
from scipy.optimize import nnls

from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solved_ring import solve_influence
from fegear.fem.plane.table import stiffness_table
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.fem.plane.trace import lagrange
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material

#: Parts of an edge on which the pressure is linear: fewer than its nodes, so that each is felt by itself.
_PARTS = 2
TOOTH = Tooth(28)


@functools.cache
def fine():
    settings = replace(settings_at(3), flank_edge_length=0.008)
    return solve_influence(TOOTH, mesh_sector(TOOTH, 0.5 * TOOTH.root_radius, settings), 0.3, "strain")


def rigid_parabola(known, place, half_width):
    """Approach under a unit load of the parabola that on a half-plane has this half-width, aimed at an arc length."""
    flank, radius = known.flank, half_width**2 / (2.0 * known.log_slope)
    edges = [
        e for e in range(flank.after_flank_edge)
        if flank.arc[e + 1] > place - 2.5 * half_width and flank.arc[e] < place + 2.5 * half_width
    ]  # fmt: skip
    parts = np.arange(_PARTS) / _PARTS
    knots = np.append(np.concatenate([flank.arc[e] + parts * (flank.arc[e + 1] - flank.arc[e]) for e in edges]),
                      flank.arc[edges[-1] + 1])  # fmt: skip
    x, w = np.polynomial.legendre.leggauss(8)
    x, w = 0.5 + 0.5 * x, 0.5 * w
    loads, share, gap = np.zeros((2, flank.nodes, knots.size)), np.zeros(knots.size), np.zeros(knots.size)
    for i in range(knots.size - 1):
        e, s = edges[i // _PARTS], knots[i] + (knots[i + 1] - knots[i]) * x
        along = (s - flank.arc[e]) / (flank.arc[e + 1] - flank.arc[e])
        inward = flank._normal(np.array([e]), along[None])[:, 0]
        nodes = slice(e * flank.order, (e + 1) * flank.order + 1)
        for knot, hat in ((i, 1.0 - x), (i + 1, x)):
            weight = w * (knots[i + 1] - knots[i]) * hat
            share[knot] += weight.sum()
            gap[knot] += weight @ (s - place) ** 2 / (2.0 * radius)
            loads[:, nodes, knot] += np.einsum("iq,cq->ci", lagrange(flank.order, along), inward * weight)
    loads = loads.reshape(-1, knots.size)
    compliance = loads.T @ known.compliance[0] @ loads
    # Least energy under pressures that only push: least squares with the Cholesky factor, the total load weighing much.
    factor = np.linalg.cholesky(compliance)
    much = 1e3 * np.abs(factor).max() / share.max()
    at = np.flatnonzero(nnls(np.vstack([factor.T, much * share]), np.append(-np.linalg.solve(factor, gap), much))[0])
    system = np.zeros((at.size + 1, at.size + 1))
    system[:-1, :-1], system[:-1, -1], system[-1, :-1] = compliance[np.ix_(at, at)], -share[at], share[at]
    return float(np.linalg.solve(system, np.append(-gap[at], 1.0))[-1])


@pytest.mark.dear("0.01", "0.02")
@pytest.mark.parametrize("half_width", [0.01, 0.02])
def test_a_table_tells_how_much_less_a_true_contact_gives_way_beside_the_tip(half_width):
    """Up to 3.7e-3 are between both within .05 modules of the tip: no error of the mesh, and a column of its own."""
    known = fine()
    arc = known.flank.flank_end - np.array([half_width, 0.025, 0.035, 0.05])
    gear = Gear(TOOTH, 1.0, 0.5 * TOOTH.root_radius, material=Material(1.0, 0.3))
    radii = np.minimum(known.flank.radius_of_arc(arc), gear.involute_tip_radius)
    table = stiffness_table(gear, radii, half_width)
    exact = np.array([rigid_parabola(known, place, half_width) for place in arc])
    true, told = table.c_self - exact, table.c_self_reduction
    assert (true > 0.0).all()  # a true contact finds the stiffer place
    assert (true < 1.5 * (told + table.errors["c_self"]) + 5e-5 * exact).all()
    assert (told < 3.0 * true).all()
    assert (table.errors["c_self"] < 0.3 * told).all()
