"""The stiffness of sectors and sections is assembled by scikit-fem from the weak forms of `fegear.fem.forms`.

The reference is what fegear assembled by itself before: products of shape functions' gradients, summed with einsum.
"""

import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.sparse import coo_array
from skfem import Basis, BilinearForm, ElementVector, MappingAffine, MappingIsoparametric

from fegear.fem import forms
from fegear.fem.plane import elasticity
from fegear.fem.plane.elements import _element, sector_elements
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.fem.solid.scikit_fem_solver import assembled_zones
from fegear.fem.solid.section import _stiffness, make_section
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

NU, TAU = 0.3, 0.05
ORDERS = (2, 3, 4)


@pytest.fixture(scope="module")
def meshes():
    tooth = Tooth(28, BasicRack(1.0, 1.25, 0.25))
    return {
        order: mesh_sector(tooth, 0.5 * tooth.root_radius, replace(settings_at(-3), order=order)) for order in ORDERS
    }


def basis_of(elements, element, chosen=None, *, straight=False):
    """scikit-fem's own basis and maps."""
    grid = elements.grid
    curves = MappingAffine(grid) if straight else MappingIsoparametric(grid, grid.elem())
    return Basis(grid, element, curves, intorder=12, elements=chosen, disable_doflocs=True)


def former_plane_stiffness(elements, lam, mu):
    n = elements.element_nodes.shape[1]
    stiffness = np.empty((elements.curved.size, n, 2, n, 2))
    for chosen, straight in ((elements.curved, False), (~elements.curved, True)):
        basis = basis_of(elements, _element(elements.order), np.flatnonzero(chosen), straight=straight)
        gradient = np.stack([shape.grad for (shape,) in basis.basis])
        d = np.einsum("iamq,jbmq,mq->miajb", gradient, gradient, basis.dx, optimize=True)
        k = lam * d + mu * d.transpose(0, 1, 4, 3, 2)
        trace = mu * (d[:, :, 0, :, 0] + d[:, :, 1, :, 1])
        k[:, :, 0, :, 0] += trace
        k[:, :, 1, :, 1] += trace
        stiffness[chosen] = k
    return stiffness.reshape(-1, 2 * n, 2 * n)


def former_section_stiffness(elements, axes, tau, nu):
    basis = basis_of(elements, _element(elements.order))
    x, y = basis.mapping.F(basis.X) + elements.tip
    value = np.stack([np.asarray(shape) for (shape,) in basis.basis])
    dx, dy = np.stack([shape.grad for (shape,) in basis.basis]).transpose(1, 0, 2, 3)
    b0, b1 = np.zeros((2, 6, 3, *value.shape))
    b0[0, 0] = b0[3, 1] = b0[4, 2] = dx
    b0[1, 1] = b0[3, 0] = b0[5, 2] = dy
    b0[2, 2] = b0[4, 0] = b0[5, 1] = tau * (y * dx - x * dy)
    b0[4, 1], b0[5, 0] = -tau * value, tau * value
    b1[2, 2] = b1[4, 0] = b1[5, 1] = value
    mu = 0.5 / (1.0 + nu)
    hooke = np.diag([2.0 * mu] * 3 + [mu] * 3)
    hooke[:3, :3] += nu / ((1.0 + nu) * (1.0 - 2.0 * nu))
    turned = [np.einsum("scnmq,mncd->mqsnd", b, axes).reshape(*basis.dx.shape, 6, -1) for b in (b0, b1)]
    weighted = [np.einsum("st,mqtu,mq->mqsu", hooke, b, basis.dx, optimize=True) for b in turned]
    return [np.einsum("mqsu,mqsv->muv", turned[i], weighted[j], optimize=True) for i, j in ((0, 0), (0, 1), (1, 1))]


def assert_same(found, known):
    """To 1e-12 of each element's largest entry."""
    assert found.shape == known.shape
    assert (np.abs(found - known).max(axis=(1, 2)) <= 1e-12 * np.abs(known).max(axis=(1, 2))).all()


@pytest.mark.parametrize("plane", ["strain", "stress"])
@pytest.mark.parametrize("order", ORDERS)
def test_the_plane_stiffness_is_what_it_was(meshes, order, plane):
    found = elasticity.assemble(meshes[order], NU, plane, order).stiffness
    known = former_plane_stiffness(sector_elements(meshes[order], order), *elasticity.lame(NU, plane))
    assert_same(found, known)


@pytest.mark.parametrize("order", [2, 3])
def test_the_section_s_stiffness_is_what_it_was(meshes, order):
    section = make_section(meshes[order], order, TAU, NU, 12.0)
    elements = sector_elements(meshes[order], order)
    known = former_section_stiffness(elements, section.axes[elements.element_nodes], TAU, NU)
    for found, before in zip(section.stiffness, known, strict=True):
        assert_same(found, before)


def test_zones_of_a_section_assembled_whole_are_the_sums_of_their_elements(meshes):
    """By weak forms of vector-valued functions, beside products of shape functions; a web leans in its own zone."""
    section, elements = make_section(meshes[2], 2, TAU, NU, 12.0), sector_elements(meshes[2], 2)
    count = len(elements.element_nodes)
    number = np.arange(count)  # few of the elements, and none of zone 1
    zone = np.select([number % 12 == 0, number % 12 == 1], [2, 0], -1)
    lean = np.where(zone == 2, 0.4, 0.0)
    found = assembled_zones(elements, section.axes, TAU, NU, zone, lean)
    known = _stiffness(elements, section.axes[elements.element_nodes], (TAU, 0.0), NU, lean)
    dofs = (3 * elements.element_nodes[:, :, None] + np.arange(3)).reshape(count, -1)
    assert len(found) == 3
    for number, matrices in enumerate(found):
        chosen = zone == number
        for whole, parts in zip(matrices, known, strict=True):
            at = np.broadcast_arrays(dofs[chosen][:, :, None], dofs[chosen][:, None])
            own = coo_array((parts[chosen].ravel(), tuple(one.ravel() for one in at)), shape=whole.shape)
            assert abs(whole - own.tocsr()).max() <= 1e-12 * max(np.abs(parts).max(), 1.0)
    assert np.abs(known[1] - section.stiffness[1])[zone == 2].max() > 1e-3 * np.abs(section.stiffness[1]).max()
    assert_same(known[2][zone == 0], section.stiffness[2][zone == 0])


def test_scikit_fem_assembles_the_equation_itself_to_the_same_matrix(meshes):
    """With vector-valued elements and `BilinearForm.assemble`, in its own numbering."""
    mesh, order = meshes[2], 2
    known = elasticity.assemble(mesh, NU, "strain", order)
    elements = sector_elements(mesh, order)
    lam, mu = elasticity.lame(NU, "strain")
    basis = basis_of(elements, ElementVector(_element(order)))
    whole = forms.plane_elasticity.assemble(basis, lam=lam, mu=mu)
    number = np.empty(known.size, dtype=np.int64)  # of fegear's unknowns
    number[known.element_dofs] = basis.element_dofs.T
    own = np.zeros(whole.shape)
    rows, columns = number[known.element_dofs][:, :, None], number[known.element_dofs][:, None]
    np.add.at(own, (rows, columns), known.stiffness)
    assert np.abs(whole.toarray() - own).max() <= 1e-12 * np.abs(own).max()


@pytest.mark.parametrize("name", ["plane_elasticity", "turned_elasticity"])
def test_who_changes_the_equation_changes_the_stiffness(meshes, monkeypatch, name):
    """It stands nowhere else: twice the work makes twice the stiffness."""

    def both():
        section = make_section(meshes[2], 2, TAU, NU, 12.0)
        return [elasticity.assemble(meshes[2], NU, "strain", 2).stiffness], list(section.stiffness)

    before, form = both(), getattr(forms, name)
    equation = form.form
    monkeypatch.setattr(form, "form", lambda u, v, w: 2.0 * equation(u, v, w))
    after = both()
    for factor, old, new in zip((2.0, 1.0) if name == "plane_elasticity" else (1.0, 2.0), before, after, strict=True):
        for one, other in zip(old, new, strict=True):
            assert np.array_equal(factor * one, other)


def test_every_element_matrix_comes_out_of_scikit_fem_s_assembly(meshes, monkeypatch):
    """Whatever `BilinearForm` integrates doubled is doubled in every element: none is made beside it."""
    assemble = BilinearForm._assemble

    def doubled(self, *args, **parameters):
        indices, data, *shapes = assemble(self, *args, **parameters)
        return indices, 2.0 * data, *shapes

    def every():
        section = make_section(meshes[2], 2, TAU, NU, 12.0)
        return [elasticity.assemble(meshes[2], NU, "strain", 2).stiffness, *section.stiffness]

    before = every()
    monkeypatch.setattr(BilinearForm, "_assemble", doubled)
    for one, other in zip(before, every(), strict=True):
        assert np.array_equal(2.0 * one, other)


def test_rigid_motions_strain_no_twisted_prism():
    """In turned axes at z: u = R' (t + omega x X), of which D follows by turning the axes back and along z."""
    place = np.array([1.7, -2.3])
    for t, omega in [(one, np.zeros(3)) for one in np.eye(3)] + [(np.zeros(3), one) for one in np.eye(3)]:

        def components(xi, eta, z, t=t, omega=omega):
            c, s = math.cos(TAU * z), math.sin(TAU * z)
            turn = np.array([[c, -s, 0.0], [s, c, 0.0], [0.0, 0.0, 1.0]])
            return turn.T @ (t + np.cross(omega, turn @ np.array([xi, eta, z])))

        step = 1e-4
        for z in (0.0, 3.0):
            at = np.array([*place, z])
            slope = np.stack(
                [(components(*(at + step * e)) - components(*(at - step * e))) / (2.0 * step) for e in np.eye(3)],
                axis=1,
            )
            slope[:, 2] += TAU * (place[1] * slope[:, 0] - place[0] * slope[:, 1])
            assert np.abs(forms.turned_strains(components(*at), slope, TAU)).max() < 1e-8
    stretched = forms.turned_strains(np.zeros(3), np.diag([1.0, 2.0, 3.0]), TAU)
    assert stretched.tolist() == [1.0, 2.0, 3.0, 0.0, 0.0, 0.0]
