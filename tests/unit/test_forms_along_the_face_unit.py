"""Weak forms of a twisted prism, split into sections and functions along the face: against the strains of the whole."""

from types import SimpleNamespace

import numpy as np
import pytest
from scipy.sparse import csr_array
from skfem.element import DiscreteField

from fegear.fem import forms
from fegear.fem.solid import whole_sector

LAM, MU, TAU = 1.7, 0.6, 0.23


@pytest.fixture
def fields():
    """Two displacements of a section at five points, with slopes along xi and eta; and where the points are."""
    rng = np.random.default_rng(11)
    made = [DiscreteField(rng.normal(size=(3, 5)), grad=rng.normal(size=(3, 2, 5))) for _ in range(2)]
    place = rng.uniform(2.0, 5.0, (2, 5))
    return made, place


def parameters(place, lean=0.0):
    return {"lam": LAM, "mu": MU, "tau": TAU, "place": place, "lean": np.full(5, lean)}


def whole(u, place, f, slope, lean=0.0):
    """Strains of u f(z) at f and f', the web's functions rising by `lean` toward the axis's way."""
    x, y = (u.grad[:, k] + slope * lean * place[k] / np.hypot(*place) * np.asarray(u) / f for k in (0, 1))
    d = TAU * (place[1] * u.grad[:, 0] - place[0] * u.grad[:, 1]) * f + np.asarray(u) * slope
    return forms.turned_strains(np.asarray(u) * f, np.stack([x * f, y * f, d], axis=1), TAU)


@pytest.mark.parametrize("lean", [0.0, 0.4])
def test_strains_are_those_of_the_section_and_of_the_change_along_the_face(fields, lean):
    (u, _), place = fields
    w = parameters(place, lean)
    split = forms._in_section(u, w) * 1.3 + forms._along_face(u, w) * -0.7
    assert split == pytest.approx(whole(u, place, 1.3, -0.7, lean), abs=1e-12)


@pytest.mark.parametrize("lean", [0.0, 0.4])
def test_the_three_products_are_the_work_of_the_whole(fields, lean):
    """Of u f and v g: f g B0'CB0 + f' g B0'CB1 + f g' B1'CB0 + f' g' B1'CB1."""
    (u, v), place = fields
    w = parameters(place, lean)
    f, f1, g, g1 = 1.3, -0.7, 0.4, 2.1
    strain_u, strain_v = whole(u, place, f, f1, lean), whole(v, place, g, g1, lean)
    pressure = LAM * strain_u[:3].sum(axis=0)
    stress = np.concatenate([pressure + 2.0 * MU * strain_u[:3], MU * strain_u[3:]])
    found = (
        f * g * forms.turned_section.form(u, v, w)
        + f1 * g * forms.turned_mixed.form(u, v, w)
        + f * g1 * forms.turned_mixed.form(v, u, w)
        + f1 * g1 * forms.turned_along.form(u, v, w)
    )
    assert found == pytest.approx((stress * strain_v).sum(axis=0), abs=1e-11)


def test_rigid_motions_of_a_twisted_prism_are_free_of_strain():
    """Translations and rotations of space, seen in axes that turn with the sections."""
    rng = np.random.default_rng(3)
    xi, eta, z = rng.uniform(-2.0, 2.0, (3, 6))
    turn, moved = rng.normal(size=3), rng.normal(size=3)

    def motion(x, y, height):
        c, s = np.cos(TAU * height), np.sin(TAU * height)
        place = np.stack([c * x - s * y, s * x + c * y, height])
        u = moved[:, None] + np.cross(turn, place.T).T
        return np.stack([c * u[0] + s * u[1], -s * u[0] + c * u[1], u[2]])

    h = 1e-5
    x, y = ((motion(xi + a * h, eta + b * h, z) - motion(xi - a * h, eta - b * h, z)) / (2.0 * h)
            for a, b in ((1, 0), (0, 1)))  # fmt: skip
    d = (motion(xi, eta, z + h) - motion(xi, eta, z - h)) / (2.0 * h) + TAU * (eta * x - xi * y)
    strains = forms.turned_strains(motion(xi, eta, z), np.stack([x, y, d], axis=1), TAU)
    assert np.abs(strains).max() < 1e-8


def test_a_sector_assembled_whole_is_its_sections_times_what_is_along_the_face():
    rng = np.random.default_rng(5)
    zones, along = [], []
    for _ in range(2):
        zones.append(tuple(csr_array(rng.normal(size=(4, 4))) for _ in range(3)))
        along.append(tuple(rng.normal(size=(3, 3)) for _ in range(3)))
    zones[1] = (zones[1][0], csr_array((4, 4)), zones[1][2])
    number = np.arange(12).reshape(4, 3)
    number[1, 2] = number[3, 0] = -1
    section = SimpleNamespace(products_along=lambda face: along if face == "face" else None)
    found = whole_sector.assembled_sector(section, tuple(zones), "face", SimpleNamespace(number=number)).toarray()
    wanted = np.zeros((12, 12))
    for (inner, mixed, last), (m0, m1, m2) in zip(zones, along, strict=True):
        a, b, c = inner.toarray(), mixed.toarray(), last.toarray()
        wanted += np.kron(a, m0) + np.kron(b, m1) + np.kron(b.T, m1.T) + np.kron(c, m2)
    there = number.reshape(-1) >= 0
    assert found == pytest.approx(wanted[there][:, there], abs=1e-12)


def test_a_sector_condensed_whole_keeps_what_is_asked_for(monkeypatch):
    asked = []

    def between(stiffness, wanted, held, motions):
        asked.append((stiffness, wanted.tolist(), held.size, motions))
        return "between", "motions"

    monkeypatch.setattr(whole_sector, "between_kept", between)
    monkeypatch.setattr(whole_sector, "assembled_sector", lambda *given: given)
    known = SimpleNamespace(of=lambda kept: np.array(kept) * 10, size=99)
    found = whole_sector.condense_whole("section", "zones", "face", known, [1, 4], expandable=True)
    assert asked == [(("section", "zones", "face", known), [10, 40], 0, True)]
    assert (found.kept.tolist(), found.stiffness, found.size, found.steps) == ([10, 40], "between", 99, ())
    assert found.motions == "motions"
    whole_sector.condense_whole("section", "zones", "face", known, [1, 4])
    assert asked[1][3] is False
