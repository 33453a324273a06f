"""Loaded flanks by brute force: compliances line by line from influence functions, non-negative least squares.

Nothing of `fegear.contact.wide` is used but what is tried: the lines are the equation of the plane of action, the
approach is found by bisection on the load that non-negative least squares give for it (scipy).
"""

import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq, nnls

from fegear.contact.wide.compliance import flank_compliance
from fegear.contact.wide.gaps import FlankGaps
from fegear.contact.wide.lines import contact_lines
from fegear.contact.wide.load_sharing import solve_contact
from fegear.contact.wide.loaded import FlankPair
from fegear.fem.solid.influence import contact_line, solid_influence
from fegear.fem.solid.settings import solid_settings
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.pair import MEMBERS, GearPair
from fegear.geometry.rack import BasicRack
from fegear.geometry.shaft_tilt import ShaftTilt

MODULE = 2e-3


@pytest.fixture(scope="module", params=["usual", "stub"])
def solved(request):
    """Gears of usual height, and stub ones that always have lines in contact but not in every section of the face."""
    beta, gears, stub = math.radians(15.0), [], request.param == "stub"
    for teeth, hand in ((20, "right"), (31, "left")):
        tooth = Tooth(teeth, BasicRack(0.5 if stub else 1.0, 1.25, 0.25), helix_angle=beta)
        gears.append(Gear(tooth, MODULE, 0.5 * tooth.root_radius * MODULE, 4.0 * MODULE, hand=hand))
    known = {}
    for member, g in zip(MEMBERS, gears, strict=True):
        size = g.twist * MODULE, g.face_width / MODULE, g.material.poisson_ratio, g.bore_radius / MODULE
        known[member] = solid_influence(g.tooth, *size, solid_settings(0.1), reach=1, estimate_error=False)
    pair = GearPair(*gears)
    assert (pair.contact_ratio < 1.0) == stub
    assert pair.total_contact_ratio > 1.1
    return pair, known


def own_lines(pair, roll, panel):
    """Number, x and z of the stations of each line at a roll position."""
    slope, half = pair.driver.twist * pair.driver.base_radius, 0.5 * pair.face_width
    found = []
    for j in range(-5, 6):
        at = roll + j * pair.base_pitch
        ends = sorted(((at - pair.x_start) / slope, (at - pair.x_end) / slope))
        low, high = max(ends[0], -half), min(ends[1], half)
        if high - low > 0.15 * MODULE:
            z = np.linspace(low, high, math.ceil((high - low) / panel - 1e-9) + 1)
            found.append((j, at - slope * z, z))
    return found


def own_compliance(pair, known, lines, half_width):
    """Approach of each station per force on each other, both gears, contacts of one half-width [m/N]."""
    ends = np.cumsum([0, *(z.size for _, _, z in lines)])
    spans = [slice(a, b) for a, b in pairwise(ends)]
    total = np.zeros((ends[-1], ends[-1]))
    for member in MEMBERS:
        gear, influence = pair.gear(member), known[member]
        softer, forward = 1.0 / (gear.material.young_modulus * MODULE), 1 if member == "driver" else -1
        radii = [
            np.clip(pair.radius(x, member) / MODULE, influence.lowest_radius, influence.highest_radius)
            for _, x, _ in lines
        ]
        bands = [contact_line(influence.fine, r, z / MODULE) for r, (_, _, z) in zip(radii, lines, strict=True)]
        for a, (j, _, z) in enumerate(lines):
            total[spans[a], spans[a]] += softer * influence.contact_compliance(
                radii[a], z / MODULE, half_width / MODULE
            )
            for b, (i, _, _) in enumerate(lines):
                if abs(i - j) == 1:
                    total[spans[a], spans[b]] += softer * influence.deflection(forward * (j - i), bands[a], bands[b])
    return total


def own_contact(compliance, gap, load):
    """Approach and forces: the least squares of ||L^T f - L^-1 (zeta - gap)|| are the conditions of contact."""
    lower = np.linalg.cholesky(0.5 * (compliance + compliance.T))

    def forces(zeta):
        return nnls(lower.T, np.linalg.solve(lower, zeta - gap))[0]

    # Above what a single station under all of the load takes: there the search would end on its own root.
    most = gap.min() + 1.5 * load * compliance.diagonal().max()
    zeta = brentq(lambda at: forces(at).sum() - load, gap.min() + 1e-15, most, rtol=1e-13, xtol=1e-18)
    return zeta, forces(zeta)


def hat_means(z, gap):
    """Means of what is straight between stations over their hats."""
    h = np.diff(z)
    weight, total = np.zeros(z.size), np.zeros(z.size)
    for here, there in ((slice(None, -1), slice(1, None)), (slice(1, None), slice(None, -1))):
        weight[here] += 0.5 * h
        total[here] += h * (gap[here] / 3.0 + gap[there] / 6.0)
    return total / weight


@pytest.mark.parametrize("share", [0.1, 0.63])
@pytest.mark.parametrize(("load", "over_face"), [(2e3, 0.0), (2e3, 30e-6), (1.0, 30e-6), (50.0, -60e-6)])
def test_forces_and_approach_are_those_of_brute_force(solved, share, load, over_face):
    """To what pressed widths leave: fegear presses bands of a few widths, brute force of one for each station."""
    pair, known = solved
    roll, panel = pair.x_start + share * pair.base_pitch, 0.5 * MODULE
    tilt = FlankGaps(tilt=ShaftTilt(out_of_plane=over_face / pair.face_width))
    lines = contact_lines(pair, [roll], panel)
    gears = {member: known[member].fine for member in MEMBERS}
    compliance = flank_compliance(pair, gears, lines, load, hertz="none")
    found = solve_contact(compliance, np.where(lines.present, tilt.at(pair, lines), 0.0), np.array([load]))
    mine = own_lines(pair, roll, panel)
    x = np.concatenate([line[1] for line in mine])
    assert x == pytest.approx(lines.x[0][lines.present[0]], abs=1e-12)
    kappa = over_face / pair.face_width * math.cos(pair.working_pressure_angle)
    lean = pair.driver.twist * pair.driver.base_radius
    gap = np.concatenate([hat_means(zj, kappa * (zj - lean * xj)) for _, xj, zj in mine])
    zeta, forces = own_contact(own_compliance(pair, known, mine, 0.08 * MODULE), gap, load)
    assert forces.sum() == pytest.approx(load, rel=1e-9)
    assert found.approach[0, 0] - gap.min() == pytest.approx(zeta - gap.min(), rel=3e-3)
    assert found.force[0, :, 0][lines.present[0]] == pytest.approx(forces, abs=2e-2 * forces.max())


def test_a_load_that_no_tooth_bears_is_still_in_balance(solved):
    """30 kN/mm at a module of 2 mm: contacts as wide as teeth are high, for which Hertz's law was not made."""
    pair, known = solved
    flanks = FlankPair(pair, {member: known[member].fine for member in MEMBERS}, positions=4)
    found = flanks.solve(2e5)
    assert np.isfinite(found.transmission_error).all()
    assert found.equilibrium.max() < 1e-9
