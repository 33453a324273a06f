"""Gears on an inclined web: limits, symmetries and sums that hold whatever the inclination."""

import functools
import math
from dataclasses import replace

import numpy as np
import pytest
import scipy.sparse.linalg
from scipy.integrate import quad
from skfem import Basis, BilinearForm, ElementTriP2, MeshTri

from fegear.base.errors import GeometryError
from fegear.fem.plane.gear_section import uneven_section
from fegear.fem.revolved_body import RevolvedBody, condensed
from fegear.fem.solid.bands import bands
from fegear.fem.solid.body_modes import body_modes
from fegear.fem.solid.extruded import extruded
from fegear.fem.solid.field import solid_field
from fegear.fem.solid.settings import SolidSettings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.body_along import body_along
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.gear_body import GearBody
from fegear.geometry.rack import BasicRack

TOOTH = Tooth(18, BasicRack(1.0, 1.25, 0.25), 0.1)
WIDTH, BORE, NU = 2.4, 3.0, 0.3
RIM, HUB = 5.9, 4.2
FACE = (-0.5 * WIDTH, 0.5 * WIDTH)
COARSE = replace(SolidSettings().scaled(3.0), least_degree=5)
COARSE = replace(COARSE, section=replace(COARSE.section, order=2))
PLACES = (-1.2, -0.6, 0.0, 0.6, 1.2)


def body(lean, web=(-0.9, -0.3), hub=FACE):
    return GearBody(RIM, HUB, web, hub, lean)


def mirrored(given):
    (a, b), (c, d) = given.web, given.hub
    return replace(given, web=(-b, -a), hub=(-d, -c), lean=-given.lean)


def band(place):
    low, high = max(place - 0.5, FACE[0]), min(place + 0.5, FACE[1])
    return bands(9.0, place, place - low, 0.25, after=high - place)


@functools.cache  # several tests ask the same gear
def solved(given, tau=0.0):
    return solve_solid(TOOTH, tau, WIDTH, NU, BORE, COARSE, body=given)


def deflections(solution, k=0):
    return np.array([[float(solution.deflection(k, band(a), band(b))[0, 0]) for b in PLACES] for a in PLACES])


def tension(solution):
    return np.array([solution.largest_root_stress(0, "tension", band(a), PLACES)[0][:, 0] for a in PLACES])


@pytest.mark.dear
def test_a_web_that_is_hardly_inclined_is_a_straight_one():
    """As the first power of the inclination, to which the straight web's solution is the limit."""
    straight, hardly, little = (solved(body(lean)) for lean in (0.0, 1e-9, 1e-4))
    assert hardly.unknowns == straight.unknowns
    assert deflections(hardly) == pytest.approx(deflections(straight), rel=1e-8)
    assert tension(hardly) == pytest.approx(tension(straight), rel=1e-8)
    apart = np.abs(deflections(little) / deflections(straight) - 1.0).max()
    assert 1e-6 < apart < 3e-4


@pytest.mark.dear
@pytest.mark.parametrize("tau", [0.0, 0.03])
def test_symmetries(tau):
    """What moves here under a force there moves there under it here; the mirrored gear leans the other way."""
    given = body(0.45, hub=(-1.0, 1.2))
    one, other = solved(given, tau), solved(mirrored(given), -tau)
    found = deflections(one)
    assert found == pytest.approx(found.T, rel=1e-9)
    assert deflections(other) == pytest.approx(found[::-1, ::-1], rel=1e-9)
    assert tension(other) == pytest.approx(tension(one)[::-1, ::-1], rel=1e-8)
    assert deflections(one, 1) == pytest.approx(deflections(one, -1).T, rel=1e-9)
    # The inclination is felt: the straight web of the same place answers otherwise.
    assert np.abs(deflections(solved(replace(given, lean=0.0), tau)) / found - 1.0).max() > 0.05


@pytest.mark.long
def test_no_random_inclined_body_is_stiffer_with_a_thinner_web():
    """A thin web within a thick one, spur and helical: at five places along the face, under a force at each of them."""
    rng = np.random.default_rng(31)
    for i in range(12):
        thick, lean, tau = rng.uniform(0.5, 1.0), rng.uniform(-0.57, 0.57), rng.choice([0.0, 0.02])
        shift = lean * (RIM - HUB)
        low = rng.uniform(max(-1.0, -1.0 - shift), min(1.0, 1.0 - shift) - thick)
        first, last = low + np.array([rng.uniform(0.0, 0.2), 1.0 - rng.uniform(0.05, 0.2)]) * thick
        found = [np.diag(deflections(solved(body(lean, span), tau))) for span in ((low, low + thick), (first, last))]
        assert (found[1] > found[0]).all(), i


@pytest.mark.long
def test_modes_of_the_mirrored_gear_are_the_same():
    settings = replace(COARSE, section=COARSE.section.scaled(2.0))

    def found(given, tau):
        modes = body_modes(TOOTH, tau, WIDTH, NU, BORE, settings, given, diameters=1, each=1, fineness=0.6).modes
        return [mode.frequency for mode in modes]

    assert found(mirrored(body(0.4)), -0.02) == pytest.approx(found(body(0.4), 0.02), rel=1e-8)


def test_places_in_the_hub_are_those_along_the_face():
    """From end to end and one to one, the web's own by the shift alone; nearly those of a straight web of no slope."""
    rng = np.random.default_rng(3)
    for _ in range(300):
        width = rng.uniform(1.0, 6.0)
        half, thick = 0.5 * width, rng.uniform(0.1, 0.5) * width
        low, start = rng.uniform(-half, half - thick, 2)  # of the web at the rim, and at the hub
        web, hub = (low, low + thick), (rng.uniform(-half, start), rng.uniform(start + thick, half))
        along = body_along(web, hub, start - low, width)
        places = np.linspace(*along.hub, 41)
        found = along.in_hub(places)
        assert found[[0, -1]] == pytest.approx(hub, abs=1e-9)
        assert (np.diff(found) > 0.0).all()
        assert -half <= along.hub[0] <= low
        assert low + thick <= along.hub[1] <= half
        assert along.in_hub(np.array(web)) == pytest.approx(np.array(web) + start - low, abs=1e-12)
        assert along.of_hub(found) == pytest.approx(places, abs=1e-9)
        middle, step = 0.5 * (places[1:] + places[:-1]), np.diff(places)
        smooth = np.all([np.abs(middle - one) > step[0] for one in web], axis=0)
        assert along.stretched(middle)[smooth] == pytest.approx((np.diff(found) / step)[smooth], rel=1e-6)
    hardly = body_along((-0.5, 0.5), (-1.0, 2.0), 1e-12, 5.0)
    assert hardly.hub == (-1.0, 2.0)
    assert hardly.stretch == pytest.approx((1.0, 1.0))


def test_the_drawn_solid_leans_by_the_slope_and_keeps_its_volume():
    given = body(0.4, (-1.0, -0.4), (-0.8, 1.2))
    section = uneven_section(TOOTH, BORE, 3.0, 3.0, given)

    def drawn(one):
        places = np.unique([*np.linspace(*FACE, 7), *one.along(WIDTH).ends])
        return extruded(section, places[np.append(True, np.diff(places) > 1e-9)], 0.0, one)

    def volume(mesh):
        corners = np.hstack([mesh.wedges[[0, 1, 2]], mesh.hexahedra[[0, 1, 2]], mesh.hexahedra[[0, 2, 3]]])
        tops = np.hstack([mesh.wedges[3:6], mesh.hexahedra[4:7], mesh.hexahedra[[4, 6, 7]]])
        x, y, z = mesh.points
        a, b, c = corners
        area = 0.5 * ((x[b] - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (y[b] - y[a]))
        return float((area * (z[tops] - z[corners]).mean(axis=0)).sum())

    mesh = drawn(given)
    assert volume(mesh) == pytest.approx(volume(drawn(replace(given, lean=0.0))), rel=1e-12)
    used = np.unique(np.concatenate([mesh.wedges.ravel(), mesh.hexahedra.ravel()]))
    radius, height = np.hypot(*mesh.points[:2, used]), mesh.points[2, used]
    web = (radius < RIM - 1e-6) & (radius > HUB + 1e-6)
    rise = height[web] - 0.4 * (RIM - radius[web])
    assert (rise.min(), rise.max()) == pytest.approx(given.web)
    hub = radius < HUB - 1e-6
    assert (height[hub].min(), height[hub].max()) == pytest.approx(given.hub)


def test_mass_and_inertia_are_integrals():
    m, lean = 2e-3, -0.35
    given = GearBody(RIM, HUB, (0.1, 0.7), (-1.2, 0.9), lean).scaled(m)
    gear = Gear(TOOTH, m, BORE * m, WIDTH * m, body=given)
    parts = ((RIM * m, HUB * m, given.web, lean), (HUB * m, BORE * m, given.hub, 0.0))
    mass = spin = tilt = 0.0
    for outer, inner, (low, high), slope in parts:

        def over(f, outer=outer, inner=inner, low=low, high=high, slope=slope):
            def across(r):
                up = slope * (outer - r)
                return quad(lambda z: 2 * math.pi * r * f(r, z), low + up, high + up)[0]

            return quad(across, inner, outer)[0]

        mass += over(lambda r, z: 1.0)
        spin += over(lambda r, z: r * r)
        tilt += over(lambda r, z: 0.5 * r * r + z * z)
    rho = gear.material.density
    ring = replace(gear, body=None, bore_radius=RIM * m).mass_properties  # the teeth on their rim
    found = gear.mass_properties
    assert (found.mass - ring.mass, found.inertia - ring.inertia) == pytest.approx((rho * mass, rho * spin), rel=1e-10)
    assert found.inertia_at_mid_face - ring.inertia_at_mid_face == pytest.approx(rho * tilt, rel=1e-10)


@pytest.mark.parametrize(
    ("given", "key"),
    [
        (body(0.6), "body.web_inclination"),
        (body(math.nan), "body.web_inclination"),
        (body(0.5, (0.3, 0.9)), "body.web_inclination"),
        (body(0.3, hub=(-0.5, -0.2)), "body.hub"),
        (body(0.3, (-1.2, -0.6)), "body.web_offset"),
        (body(-0.3, (0.0, 1.2)), "body.web_offset"),
    ],
)
def test_bodies_that_cannot_be_are_refused(given, key):
    with pytest.raises(GeometryError) as refused:
        Gear(TOOTH, 1e-3, BORE * 1e-3, WIDTH * 1e-3, body=given.scaled(1e-3))
    assert refused.value.key == key


def test_a_web_from_the_end_of_the_rim_to_that_of_the_hub_is_a_body():
    given = body(0.3, (-1.2, -0.6), (-1.2 + 0.3 * (RIM - HUB), 1.2))
    assert Gear(TOOTH, 1e-3, BORE * 1e-3, WIDTH * 1e-3, body=given.scaled(1e-3)).body_in_modules is not None
    assert not given.even
    assert not replace(given, web=(-0.3, 0.3), hub=FACE, lean=0.1).even
    assert given.foot == pytest.approx((-1.2 + 0.51, -0.6 + 0.51))
    assert given.along(WIDTH) == body_along(given.web, given.hub, given.foot[0] - given.web[0], WIDTH)


@pytest.mark.dear
@pytest.mark.parametrize("tau", [0.0, 0.03])
def test_stress_of_pictures_is_that_of_the_displaced_wedges(tau):
    """In web and hub as near as in those of a straight web; wedges know nothing of places that follow the web."""

    def apart(lean):
        given = body(lean)
        field = solid_field(TOOTH, tau, WIDTH, NU, BORE, COARSE, band(0.6), np.linspace(*FACE, 13), body=given)
        at, slope = _in_the_middle_of_wedges()
        wedges = field.mesh.wedges
        jacobian, moved = (
            np.einsum("an,cne->eac", slope, part[:, wedges]) for part in (field.mesh.points, field.displacement[0])
        )
        gradient = np.linalg.solve(jacobian, moved)
        strain = 0.5 * (gradient + gradient.transpose(0, 2, 1))
        shear = strain - np.trace(strain, axis1=1, axis2=2)[:, None, None] * np.eye(3) / 3.0
        stress = np.sqrt(1.5 * ((shear / (1.0 + NU)) ** 2).sum(axis=(1, 2)))
        radius = np.hypot(*field.mesh.points[:2, wedges].mean(axis=1))
        found = at @ field.von_mises[0][wedges]
        zones = (radius < RIM) & (radius > HUB), radius < HUB
        return [np.linalg.norm((found - stress)[zone]) / np.linalg.norm(stress[zone]) for zone in zones]

    straight, inclined = apart(0.0), apart(0.4)
    assert inclined[0] < 1.2 * straight[0]
    assert inclined[1] < 1.2 * straight[1] < 0.12


def _in_the_middle_of_wedges():
    """Functions of the wedge of 15 nodes in its middle, shape (15,), and their slopes by differences, (3, 15)."""

    def functions(r, s, t):
        corner = (1.0 - r - s, r, s)
        found = [0.5 * a * ((2 * a - 1) * (1 + up * t) - (1 - t * t)) for up in (-1, 1) for a in corner]
        pairs = ((0, 1), (1, 2), (2, 0))
        found += [2 * corner[a] * corner[b] * (1 + up * t) for up in (-1, 1) for a, b in pairs]
        return np.array(found + [a * (1 - t * t) for a in corner])

    at, h = np.array([1.0 / 3.0, 1.0 / 3.0, 0.0]), 1e-5
    slopes = [(functions(*(at + h * way)) - functions(*(at - h * way))) / (2 * h) for way in np.eye(3)]
    return functions(*at), np.array(slopes)


RINGS = ((RIM, -1.2, 1.2), (HUB, -0.9, -0.3), (BORE, -1.0, 1.2))


def test_a_body_on_a_shaft_and_its_mirror_image():
    flipped = tuple((inner, -high, -low) for inner, low, high in RINGS)
    one = condensed(RevolvedBody(7.8, WIDTH, RINGS, (-1.0, 1.2), NU, 0.4))
    other = condensed(RevolvedBody(7.8, WIDTH, flipped, (-1.2, 1.0), NU, -0.4))
    assert other.seat == pytest.approx(-one.seat[::-1])
    assert other.torsion @ other.torsion.T == pytest.approx((one.torsion @ one.torsion.T)[::-1, ::-1], abs=1e-9)
    assert other.turned == pytest.approx(one.turned[::-1, ::-1], abs=1e-9)


def test_torsion_of_a_body_on_a_shaft_by_triangles_of_its_outline():
    """Quadratic triangles in rim, inclined web and hub as they are, with none of the body's coordinates."""
    lean, foot = 0.4, -0.9 + 0.4 * (RIM - HUB)
    known = condensed(RevolvedBody(7.8, WIDTH, RINGS, (-1.0, 1.2), NU, lean), 2)

    def block(radii, low, high, rise):
        """Triangles between two radii and two heights, which rise inward."""
        r, z = np.linspace(*radii, 25), np.linspace(low, high, 2 * round((high - low) / 0.06) + 1)
        mesh = MeshTri.init_tensor(r, z)
        return mesh.p + np.stack([0.0 * mesh.p[0], rise * (radii[1] - mesh.p[0])]), mesh.t

    parts = [
        block((RIM, 7.8), *span, 0.0) for span in ((-1.2, -0.9), (-0.9, -0.3), (-0.3, 1.2))
    ] + [block((HUB, RIM), -0.9, -0.3, lean)] + [
        block((BORE, HUB), *span, 0.0) for span in ((-1.0, foot), (foot, foot + 0.6), (foot + 0.6, 1.2))
    ]  # fmt: skip
    points, triangles, count = [], [], 0
    for p, t in parts:
        points.append(p)
        triangles.append(t + count)
        count += p.shape[1]
    _, first, inverse = np.unique(np.round(np.hstack(points), 7), axis=1, return_index=True, return_inverse=True)
    basis = Basis(MeshTri(np.hstack(points)[:, first], inverse.ravel()[np.hstack(triangles)]), ElementTriP2())

    @BilinearForm
    def torsion(u, v, w):  # of u_theta = r u: shear r grad u
        return 2.0 * math.pi * w.x[0] ** 3 * (u.grad[0] * v.grad[0] + u.grad[1] * v.grad[1]) / (2.0 + 2.0 * NU)

    stiffness = torsion.assemble(basis).tocsc()
    r, z = basis.doflocs
    seat = np.flatnonzero(r < BORE + 1e-9)
    free = np.setdiff1d(np.arange(z.size), seat)
    for turn in (lambda z: z, lambda z: z**2):
        u = np.zeros(z.size)
        u[seat] = turn(z[seat])
        u[free] = scipy.sparse.linalg.spsolve(stiffness[free][:, free], -(stiffness[free][:, seat] @ u[seat]))
        assert np.sum((known.torsion.T @ turn(known.seat)) ** 2) == pytest.approx(u @ stiffness @ u, rel=0.01)
        teeth = np.flatnonzero(r > 7.8 - 1e-9)
        wanted = np.interp(known.teeth, *np.stack([z, u])[:, teeth[np.argsort(z[teeth])]])
        assert known.turned @ turn(known.seat) == pytest.approx(wanted, abs=0.01 * np.abs(wanted).max())
