"""Slices coupled along the face: their limits, reciprocity, mirror image, and how near they are to solid gears."""

import dataclasses
import functools
import math

import numpy as np
import pytest

from fegear.base.errors import RangeError
from fegear.fem.solid.bands import bands
from fegear.fem.solid.contact import line_compliance
from fegear.fem.solid.influence import contact_line, solid_influence
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.slice_laws import LAWS, SliceLaws
from fegear.fem.solid.slices import plane_compliance, plane_section, solve_slices
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

TOOTH = Tooth(23, BasicRack(1.0, 1.25, 0.25))
BORE = 0.6 * TOOTH.root_radius
TAU = math.tan(math.radians(12.0)) / 11.5
SETTINGS = SolidSettings().scaled(1.3)


@functools.cache
def plane():
    return plane_section(TOOTH, 0.3, BORE, SETTINGS, 1)


def sliced(width, tau=0.0, laws=LAWS):
    return solve_slices(TOOTH, tau, width, 0.3, BORE, SETTINGS, laws=laws, plane=plane())


def alone():
    """Plane compliance of a band a quarter of a module wide, own tooth and next."""
    radius = np.array([11.6])
    up = plane().flank.normal_patches(plane().flank.arc_of_radius(radius), np.array([0.25]))
    return [float((up.T @ plane_compliance(plane())[k] @ up)[0, 0]) for k in (0, 1)]


@pytest.mark.dear
def test_an_even_load_on_a_wide_face_is_plane_strain():
    """In the middle; exactly so for the next tooth, which knows no ends."""
    found = sliced(40.0)
    even = bands(11.6, 0.0, 20.0, 0.25, profile="even")
    middle = bands(11.6, 0.0, 1.0, 0.25)
    own, following = alone()
    assert 40.0 * found.deflection(0, middle, even)[0, 0] == pytest.approx(own, rel=2e-5)
    assert 40.0 * found.deflection(1, middle, even)[0, 0] == pytest.approx(following, rel=1e-9)


def test_without_coupling_slices_are_thin():
    """Loads answer where they stand and nowhere else, with the plane compliance; no dent spreads less than that."""
    none = {
        f.name: tuple(0.0 for _ in value) if isinstance(value := getattr(LAWS, f.name), tuple) else 0.0
        for f in dataclasses.fields(SliceLaws)
    }
    laws = SliceLaws(**{**none, "end_reach": LAWS.end_reach})
    found = sliced(6.0, laws=laws)
    own, following = alone()
    # Profiles that the functions along the face hold exactly: even over the face, and a polynomial by its moments.
    even = bands(11.6, 0.0, 3.0, 0.25, profile="even")
    assert 6.0 * found.deflection(0, even, even)[0, 0] == pytest.approx(own, rel=1e-9)
    assert 6.0 * found.deflection(1, even, even)[0, 0] == pytest.approx(following, rel=1e-9)
    n, count = found.flank.nodes, found.face.count
    thin = np.linalg.inv(found.face.products[0])
    wanted = np.einsum("ij,kl->ikjl", plane_compliance(plane())[0], thin).reshape(n * count, -1)
    assert found.compliance[0] == pytest.approx(wanted, rel=1e-6, abs=1e-8 * np.abs(wanted).max())


@pytest.mark.parametrize("tau", [0.0, TAU])
def test_slices_are_reciprocal_and_give_way(tau):
    found = sliced(6.0, tau)
    for k in (0, 1):
        assert np.abs(found.compliance[k] - found.compliance[-k].T).max() < 1e-13 * found.compliance[0].max()
    joined = np.block([[found.compliance[0], found.compliance[-1]], [found.compliance[1], found.compliance[0]]])
    assert np.linalg.eigvalsh(joined).min() > 0.0


def test_the_other_hand_is_the_mirror_image():
    right, left = sliced(6.0, TAU), sliced(6.0, -TAU)
    at = bands(11.6, [-2.0, 0.5], 0.5, 0.2)
    mirrored = bands(11.6, [2.0, -0.5], 0.5, 0.2)
    for k in (0, 1):
        assert right.deflection(k, at, at) == pytest.approx(left.deflection(k, mirrored, mirrored), rel=1e-10)


def test_a_hub_narrower_than_the_face_is_refused():
    with pytest.raises(
        RangeError, match='is not available with width = "slices" \\(bore fixed over the full face width\\)'
    ):
        solid_influence(TOOTH, 0.0, 4.0, 0.3, BORE, dataclasses.replace(SETTINGS, source="slices"), held=(-1.0, 1.0))


@pytest.mark.parametrize("tau", [pytest.param(0.0, marks=pytest.mark.long), TAU])
def test_near_a_solid_gear_that_was_not_in_the_fit(tau):
    """Where thin slices are a fifth off in the middle and blind beside the load."""
    solid = solve_solid(TOOTH, tau, 5.0, 0.3, BORE, SETTINGS)
    found = sliced(5.0, tau)
    stations = np.linspace(-2.5, 2.5, 11)
    radius = np.hypot(TOOTH.base_radius, np.sqrt(11.7**2 - TOOTH.base_radius**2) - tau * TOOTH.base_radius * stations)
    exact, near = (line_compliance(x, contact_line(x, radius, stations), 0.02) for x in (solid, found))
    own = exact[5, 5]
    assert near[5, 5] == pytest.approx(own, rel=0.03)
    assert np.abs(near - exact)[5].max() < 0.04 * own
    assert np.diagonal(near)[[0, -1]] == pytest.approx(np.diagonal(exact)[[0, -1]], rel=0.1)
    assert near.sum() == pytest.approx(exact.sum(), rel=0.03)
