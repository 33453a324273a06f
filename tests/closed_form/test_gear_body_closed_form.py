"""Gears whose teeth stand on rim, web and hub: limits, symmetries and sums that hold whatever the shape."""

import functools
import math
from dataclasses import replace

import numpy as np
import pytest
from scipy.integrate import quad

from fegear.base.errors import GeometryError, RangeError
from fegear.fem.plane.body import zones
from fegear.fem.plane.gear_section import uneven_section
from fegear.fem.solid import face
from fegear.fem.solid.bands import bands
from fegear.fem.solid.contact import line_compliance
from fegear.fem.solid.extruded import extruded
from fegear.fem.solid.influence import contact_line
from fegear.fem.solid.sector import section_mesh
from fegear.fem.solid.settings import SolidSettings, solid_settings
from fegear.fem.solid.solution import solve_solid
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear
from fegear.geometry.gear_body import GearBody
from fegear.geometry.rack import BasicRack

TOOTH = Tooth(18, BasicRack(1.0, 1.25, 0.25), 0.1)
WIDTH, BORE, NU = 4.0, 3.0, 0.3
RIM, HUB = 6.6, 4.2
FACE = (-0.5 * WIDTH, 0.5 * WIDTH)
COARSE = replace(SolidSettings().scaled(3.0), least_degree=5)
PLACES = (-2.0, -1.0, 0.0, 1.0, 2.0)


def body(web=(-0.5, 0.5), hub=FACE):
    return GearBody(RIM, HUB, web, hub)


def band(place):
    low, high = max(place - 0.5, FACE[0]), min(place + 0.5, FACE[1])
    return bands(9.0, place, place - low, 0.25, after=high - place)


@functools.cache  # several tests ask the same gear
def solved(given, tau=0.0, **more):
    return solve_solid(TOOTH, tau, WIDTH, NU, BORE, COARSE, body=given, **more)


def deflections(solution, k=0):
    return np.array([[float(solution.deflection(k, band(a), band(b))[0, 0]) for b in PLACES] for a in PLACES])


@pytest.mark.dear("0.02", "0.0")
@pytest.mark.parametrize("tau", [0.0, 0.02])
def test_a_web_as_wide_as_the_face_is_a_disc(tau):
    """To the last digits on the same section; on the disc's own, whose body is meshed otherwise, nearly."""
    full = body(FACE)
    own = deflections(solved(full, tau))
    disc = solve_solid(
        TOOTH,
        tau,
        WIDTH,
        NU,
        BORE,
        COARSE,
        mesh=section_mesh(TOOTH, BORE, COARSE.section, full, frontal=True, fewest=COARSE.body_layers),
    )
    assert own == pytest.approx(deflections(disc), rel=1e-10)
    assert own == pytest.approx(deflections(solved(None, tau)), rel=0.03)


def test_a_body_that_fills_the_face_is_solved_as_a_disc():
    """So that both agree to the last digit; rim and hub are radii without a meaning then."""
    m = 2e-3
    gear = Gear(TOOTH, m, BORE * m, WIDTH * m, body=body(FACE).scaled(m))
    assert gear.body_in_modules is None
    assert replace(gear, body=body((-2.0, 1.9)).scaled(m)).body_in_modules is not None


@pytest.mark.dear
def test_symmetries():
    """What moves here under a force there moves there under it here; a web on the other side is the mirrored gear."""
    one, other = solved(body((-1.6, -0.6))), solved(body((0.6, 1.6)))
    found = deflections(one)
    assert found == pytest.approx(found.T, rel=1e-9)
    assert deflections(other) == pytest.approx(found[::-1, ::-1], rel=1e-9)
    # The neighbour before sees what the neighbour after does: c_k(p, q) = c_-k(q, p).
    assert deflections(one, 1) == pytest.approx(deflections(one, -1).T, rel=1e-9)


@pytest.mark.dear
def test_less_material_gives_way_more():
    """At every place, and most where it was taken away; energy bounds it from below by the disc."""
    disc, wide, thin = (deflections(solved(given)) for given in (None, body((-1.0, 1.0)), body((-0.5, 0.5))))
    off = deflections(solved(body((-1.6, -0.6))))
    assert (np.diag(thin) > np.diag(wide)).all()
    assert (np.diag(wide) > 0.999 * np.diag(disc)).all()
    assert np.linalg.eigvalsh(thin - wide).min() > -2e-3 * thin.max()
    assert thin == pytest.approx(thin[::-1, ::-1], rel=1e-9)
    assert off[0, 0] < thin[0, 0] < off[-1, -1]


@pytest.mark.dear
def test_a_thin_web_bends():
    """Functions along the face that are cut far from the flank leave a web its bending.

    Linear over its thickness it could not thin and thicken as it bends: 26 % too stiff at a Poisson's ratio of .45.
    """
    web = (-0.9, -0.5)
    every = replace(COARSE, wave_reach=60.0, fewest_waves=200.0)
    cut, whole = (
        np.diag(deflections(solve_solid(TOOTH, 0.0, WIDTH, 0.45, BORE, s, reach=0, body=GearBody(RIM, BORE, web, web))))
        for s in (COARSE, every)
    )
    assert cut == pytest.approx(whole, rel=0.02)
    assert (cut < 1.001 * whole).all()


@pytest.mark.dear
def test_teeth_of_a_deep_rim_feel_no_breaks(monkeypatch):
    """Functions of their own over the whole face, instead of the body's pieces: what the body does stays."""
    given = GearBody(5.9, HUB, (-1.5, -0.5), FACE)
    own = solve_solid(TOOTH, 0.02, WIDTH, NU, BORE, COARSE, body=given)
    monkeypatch.setattr(face, "_DEEP", math.inf)
    pieces = solve_solid(TOOTH, 0.02, WIDTH, NU, BORE, COARSE, body=given)
    assert len(own.face.breaks) == 2 < len(pieces.face.breaks)
    assert own.unknowns < 0.75 * pieces.unknowns
    assert deflections(own, 1) == pytest.approx(deflections(pieces, 1), abs=3e-3 * deflections(pieces).max())


@pytest.mark.long  # the ordinary run has three webs
def test_no_random_body_is_stiffer_with_a_thinner_web():
    """Coarse settings: at seven places along the face, under the load there and under an even one."""
    settings = replace(SolidSettings().scaled(2.5), least_degree=6)
    rng = np.random.default_rng(29)
    for i in range(27):
        teeth, width, nu = int(rng.integers(16, 30)), rng.uniform(2.0, 8.0), rng.choice([0.2, 0.3, 0.45])
        tooth = Tooth(teeth, BasicRack(1.0, 1.25, 0.25), rng.uniform(0.0, 0.3))
        rim, bore = tooth.root_radius - rng.uniform(0.6, 2.0), rng.uniform(0.25, 0.4) * tooth.root_radius
        hub, web = bore + rng.uniform(0.25, 0.5) * (rim - bore), rng.uniform(0.12, 0.85) * width
        low = rng.uniform(-0.5, 0.5) * (width - web) - 0.5 * web
        first, last = low + np.array([rng.uniform(0.0, 0.17), 1.0 - rng.uniform(0.03, 0.17)]) * web
        places, found = np.linspace(-0.5 * width, 0.5 * width, 7), []
        for span in ((low, low + web), (first, last)):
            given = GearBody(rim, hub, span, (-0.5 * width, 0.5 * width))
            gear = solve_solid(tooth, 0.0, width, nu, bore, settings, reach=0, body=given)
            compliance = line_compliance(gear, contact_line(gear, np.full(7, tooth.tip_radius - 1.0), places), 0.02)
            found.append(np.concatenate([np.diag(compliance), compliance.sum(axis=1)]))
        assert (found[1] > found[0]).all(), i


def test_the_solution_that_shows_the_error_has_two_degrees_less_on_every_piece():
    """One less is a function that is odd or even, which a load of the other kind does not feel: no error is seen."""
    rng = np.random.default_rng(29)
    for _ in range(300):
        fine, width = solid_settings(math.exp(rng.uniform(math.log(1.1e-3), math.log(0.1)))), rng.uniform(0.5, 20.0)
        cuts = np.sort(rng.uniform(-0.5, 0.5, 2)) * width
        degrees, fewer = (
            np.array(
                face.face_functions(width, one.degree(width), cuts, one.least_piece_degree, one.fewer_on_pieces).degrees
            )
            for one in (fine, fine.coarser(width))
        )
        assert (degrees >= 5).all()
        assert (fewer <= degrees - 2).all()


@pytest.mark.dear
def test_held_web_and_hub():
    """A hub no wider than the web is the web down to the bore; a wider hub holds it more firmly."""
    web = (-0.5, 0.5)
    down = GearBody(RIM, BORE, web, web)
    assert np.diag(deflections(solved(down))) == pytest.approx(np.diag(deflections(solved(body(web, web)))), rel=5e-3)
    assert (np.diag(deflections(solved(body(web)))) < np.diag(deflections(solved(down)))).all()


def test_volume_of_the_drawn_body():
    """Elements of the exported solid fill rim, web and hub and nothing else."""
    given = body((-1.5, 0.25), (-2.0, 1.0))
    section = uneven_section(TOOTH, BORE, 3.0, 3.0, given)
    mesh = extruded(section, np.array([-2.0, -1.5, -0.6, 0.25, 1.0, 2.0]), 0.0, given)
    disc = extruded(section, mesh.stations, 0.0)

    def volume(mesh):
        corners = np.hstack([mesh.wedges[[0, 1, 2]], mesh.hexahedra[[0, 1, 2]], mesh.hexahedra[[0, 2, 3]]])
        tops = np.hstack([mesh.wedges[3], mesh.hexahedra[4], mesh.hexahedra[4]])
        x, y, z = mesh.points
        a, b, c = corners
        area = 0.5 * ((x[b] - x[a]) * (y[c] - y[a]) - (x[c] - x[a]) * (y[b] - y[a]))
        return float((area * (z[tops] - z[a])).sum())

    missing = math.pi * ((RIM**2 - HUB**2) * (WIDTH - 1.75) + (HUB**2 - BORE**2) * (WIDTH - 3.0))
    assert volume(disc) - volume(mesh) == pytest.approx(missing, rel=3e-3)  # circles of chords
    with pytest.raises(Exception, match="must include the end positions of web and hub"):
        extruded(section, np.array([-2.0, -1.0, 2.0]), 0.0, given)


def test_every_element_lies_in_one_zone():
    mesh = section_mesh(TOOTH, BORE, COARSE.section, body())
    radius = np.hypot(*mesh.points[:, mesh.triangles[:3]])
    for zone, (low, high) in enumerate(((RIM, 99.0), (HUB, RIM), (BORE, HUB))):
        inside = radius[:, zones(body(), mesh.points, mesh.triangles[:3]) == zone]
        assert inside.size
        assert inside.min() > low * (1 - 1e-9)
        assert inside.max() < high * (1 + 1e-9)


def test_mass_and_inertia_are_integrals():
    m = 2e-3
    given = body((-1.5, 0.25), (-2.0, 1.0)).scaled(m)
    gear = Gear(TOOTH, m, BORE * m, WIDTH * m, body=given)
    radii, parts = (RIM * m, HUB * m, BORE * m), (given.web, given.hub)
    mass = spin = tilt = 0.0
    for outer, inner, (low, high) in zip(radii[:-1], radii[1:], parts, strict=True):

        def over(f, outer=outer, inner=inner, low=low, high=high):
            return quad(lambda r: quad(lambda z: 2 * math.pi * r * f(r, z), low, high)[0], inner, outer)[0]

        mass += over(lambda r, z: 1.0)
        spin += over(lambda r, z: r * r)
        tilt += over(lambda r, z: 0.5 * r * r + z * z)
    rho = gear.material.density
    ring = replace(gear, body=None, bore_radius=RIM * m).mass_properties  # the teeth on their rim
    found = gear.mass_properties
    assert (found.mass - ring.mass, found.inertia - ring.inertia) == pytest.approx((rho * mass, rho * spin), rel=1e-11)
    assert found.inertia_at_mid_face - ring.inertia_at_mid_face == pytest.approx(rho * tilt, rel=1e-11)


@pytest.mark.parametrize(
    ("given", "key"),
    [
        (body((-2.5, 0.0)), "body.web"),
        (body((0.0, 0.1)), "body.web_thickness"),
        (body((-1.0, 1.0), (-0.5, 2.0)), "body.hub"),
        (GearBody(7.8, HUB, (-1.0, 1.0), FACE), "body.rim_thickness"),
        (GearBody(-1.0, HUB, (-1.0, 1.0), FACE), "body.rim_thickness"),
        (GearBody(RIM, 6.5, (-1.0, 1.0), FACE), "body.hub_radius"),
        (GearBody(RIM, 2.0, (-1.0, 1.0), FACE), "body.hub_radius"),
        (GearBody(math.nan, HUB, (-1.0, 1.0), FACE), "body.rim_thickness"),
        (body((math.nan, 1.0)), "body.web"),
    ],
)
def test_bodies_that_cannot_be_are_refused(given, key):
    with pytest.raises(GeometryError) as refused:
        Gear(TOOTH, 1e-3, BORE * 1e-3, WIDTH * 1e-3, body=given.scaled(1e-3))
    assert refused.value.key == key


def test_slices_know_no_web():
    from fegear.fem.solid.influence import solid_influence

    with pytest.raises(RangeError, match="disc"):
        solid_influence(TOOTH, 0.0, WIDTH, NU, BORE, replace(COARSE, source="slices"), body=body())
