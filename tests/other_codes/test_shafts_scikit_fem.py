"""Shafts against Timoshenko frames by finite elements of scikit-fem: stepped, conical and hollow, on three bearings.

Nothing of fegear's beams is used but the data: displacement and turn are polynomials of the fourth degree on elements
of 5 mm, bearings are springs at their nodes. Asked is .1 %; both agree to 1e-6 of the largest value, and on the cone,
whose section the elements follow at their quadrature points, too.
"""

import math

import numpy as np
import pytest
from scipy.sparse import bmat
from scipy.sparse.linalg import spsolve
from skfem import Basis, BilinearForm, ElementLinePp, MeshLine

from fegear.shafts.beam import Shaft
from fegear.shafts.bearing import stiff
from fegear.shafts.deflection import deflect
from fegear.shafts.held import LoadedShaft, Seat
from fegear.shafts.section import Section

E, NU, STEP, DEGREE = 206e9, 0.3, 5e-3, 4

#: Sections; bearings: place, radial and tilting stiffness; forces across and moments: place, F, M.
SHAFTS = {
    "stepped": (
        ((0.06, 0.03), (0.09, 0.045), (0.05, 0.06), (0.08, 0.035)),
        ((0.015, 2e8, 0.0), (0.265, 3e8, 0.0)),
        ((0.11, 4000.0, 0.0), (0.18, -2500.0, 60.0)),
    ),
    "hollow cone": (
        ((0.05, 0.04, 0.01), (0.15, 0.04, 0.01, 0.07, 0.03), (0.10, 0.07, 0.03)),
        ((0.02, 1e9, 1e5), (0.28, 5e8, 0.0)),
        ((0.13, 3000.0, 0.0), (0.20, 5000.0, -100.0)),
    ),
    "overhung on three": (
        ((0.25, 0.05), (0.20, 0.04), (0.05, 0.08)),
        ((0.02, 4e8, 0.0), (0.20, 2e8, 2e5), (0.38, 6e8, 0.0)),
        ((0.10, -2000.0, 0.0), (0.475, 6000.0, 150.0)),
    ),
}


def _frame(sections, bearings, forces):
    """Places, deflections and turns by scikit-fem."""
    ends = np.concatenate([[0.0], np.cumsum([one[0] for one in sections])])
    nodes = np.unique(np.round(np.concatenate([np.arange(0.0, ends[-1] + STEP / 2, STEP), ends]), 9))
    basis = Basis(MeshLine(nodes), ElementLinePp(DEGREE), intorder=4 * DEGREE)

    def stiffness(z):
        """E I and kappa G A, linear diameters between the ends of each section."""
        which = np.clip(np.searchsorted(ends, z, side="right") - 1, 0, len(sections) - 1)
        full = [(*one, 0.0) if len(one) == 2 else one for one in sections]
        full = np.array([(*one[:3], *(one[3:] or one[1:3])) for one in full])[which]
        share = (z - ends[which]) / full[..., 0]
        d, h = (full[..., k] + share * (full[..., k + 2] - full[..., k]) for k in (1, 2))
        m = (h / d) ** 2
        kappa = 6 * (1 + NU) * (1 + m) ** 2 / ((7 + 6 * NU) * (1 + m) ** 2 + (20 + 12 * NU) * m)
        return E * math.pi / 64 * (d**4 - h**4), kappa * E / 2 / (1 + NU) * math.pi / 4 * (d**2 - h**2)

    bend = BilinearForm(lambda t, p, w: stiffness(w.x[0])[0] * t.grad[0] * p.grad[0])
    turn = BilinearForm(lambda t, p, w: stiffness(w.x[0])[1] * t * p)
    shear = BilinearForm(lambda u, v, w: stiffness(w.x[0])[1] * u.grad[0] * v.grad[0])
    mixed = BilinearForm(lambda t, v, w: -stiffness(w.x[0])[1] * t * v.grad[0])
    cross = mixed.assemble(basis)
    matrix = bmat([[shear.assemble(basis), cross], [cross.T, (bend.assemble(basis) + turn.assemble(basis))]]).tolil()
    right = np.zeros(matrix.shape[0])
    at = {round(float(z), 9): int(k) for z, k in zip(basis.mesh.p[0], basis.nodal_dofs[0], strict=True)}
    for z, across, tilting in bearings:
        matrix[at[z], at[z]] += across
        matrix[basis.N + at[z], basis.N + at[z]] += tilting
    for z, force, moment in forces:
        right[at[z]] += force
        right[basis.N + at[z]] += moment
    found = spsolve(matrix.tocsr(), right)
    dofs = basis.nodal_dofs[0]
    return basis.mesh.p[0], found[dofs], found[basis.N + dofs]


@pytest.mark.parametrize("name", SHAFTS)
def test_deflections_of_three_shafts(name):
    sections, bearings, forces = SHAFTS[name]
    z, deflection, slope = _frame(sections, bearings, forces)
    made = Shaft(tuple(Section(*one[:3], *one[3:]) for one in sections), E, NU)
    seats = tuple(Seat(stiff(across, 1e8, tilting), at) for at, across, tilting in bearings)
    loads = np.array([[force, 0.0, 0.0, 0.0, moment, 0.0] for _, force, moment in forces])
    (found,) = deflect((LoadedShaft(made, seats, np.array([at for at, *_ in forces]), loads, name),))
    u = found.at(z)
    assert u[:, 0] == pytest.approx(deflection, abs=1e-6 * np.abs(deflection).max())
    assert u[:, 4] == pytest.approx(slope, abs=1e-6 * np.abs(slope).max())
