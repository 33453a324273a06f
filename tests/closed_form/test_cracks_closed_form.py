"""Cracked teeth in the ring: laws that hold to round-off, stress intensity in strips (Kaya and Erdogan), by energy."""

import functools
import math

import numpy as np
import pytest

from fegear.base.errors import InputError
from fegear.fem.plane import supported_section
from fegear.fem.plane.influence import SIDES
from fegear.fem.plane.odd.crack import fillet_length, mouth_at_radius, mouth_at_tangent, straight_crack
from fegear.fem.plane.odd.cracked_sector import cracked_sector
from fegear.fem.plane.odd.odd_influence import solve_odd_influence
from fegear.fem.plane.odd.stress_intensity import RINGS
from fegear.fem.plane.odd.tooth_kind import OddTooth
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import shape_codec
from fegear.fem.plane.solved_ring import solve_influence
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack
from fegear.verify.cracked_strip import KAYA_ERDOGAN, intensity, pulled, strip

NU = 0.3
SETTINGS = settings_at(-3)
TOOTH, BORE = Tooth(28, BasicRack(1.0, 1.25, 0.25)), 6.375
PATCH = SETTINGS.patch_half_width


@pytest.mark.dear
def test_quarter_points_take_the_error_of_the_tip_away():
    """Without them it goes with the first power of the edges at the tip; with them the tip does not count."""
    exact = KAYA_ERDOGAN[0.5][0]
    edges = (0.1, 0.05, 0.025)
    plain = [intensity(strip(0.5, edge, quarter=False), 4)[0] / exact - 1.0 for edge in edges]
    order = np.log2(plain[0] / plain[1]), np.log2(plain[1] / plain[2])
    assert all(0.7 < one < 1.3 for one in order)
    assert all(abs(intensity(strip(0.5, edge), 4)[0] / exact - 1.0) < 0.1 * abs(plain[-1]) for edge in edges)


@pytest.mark.dear
def test_slanted_crack_gives_back_the_energy():
    """K_I^2 + K_II^2 = E' dC/da / 2 of a strip pulled at its ends, and both rings of integration agree."""
    work = []
    for share in (0.496, 0.504):
        moved, loads = pulled(strip(share, 0.04, angle=45.0), 4, np.ones_like)
        work.append(loads @ moved)
    release = 0.5 * (work[1] - work[0]) / 0.008 / (1.0 - NU**2) / (math.pi * 0.5)
    found = [intensity(strip(0.5, 0.04, angle=45.0), 4, ring=ring) for ring in RINGS]
    assert found[0][1] < -0.3  # the left face, above, moves toward the mouth
    assert found[0] @ found[0] == pytest.approx(release, rel=1e-3)
    assert found[1] == pytest.approx(found[0], rel=2e-3)


@functools.cache
def ordinary(teeth=28):
    """Mesh and ring of gears whose teeth are all alike."""
    tooth = Tooth(teeth, TOOTH.rack)
    bore = 0.45 * teeth / 2.0
    mesh = mesh_sector(tooth, bore, SETTINGS)
    known = solve_influence(
        tooth, mesh, NU, "strain", order=SETTINGS.order, reach=2, corner_distance=SETTINGS.corner_distance
    )
    return tooth, bore, mesh, known


@functools.cache
def cracked(depth, back=False, teeth=28, neighbour=0.0):
    """The same gear, its tooth 0 cracked, and tooth 1 as well."""
    tooth, bore, mesh, _ = ordinary(teeth)

    def one(deep, in_back):
        crack = straight_crack(
            tooth, mouth_at_tangent(tooth, math.radians(30.0)), math.radians(70.0), depth=deep, back=in_back
        )
        return OddTooth(tooth, cracked_sector(tooth, bore, SETTINGS, crack))

    odd = {0: one(depth, back)} | ({1: one(neighbour, back)} if neighbour else {})
    return solve_odd_influence(tooth, mesh, odd, NU, "strain", SETTINGS, two_orders=True)


@pytest.mark.parametrize("teeth", [28, 6, 5])
def test_healthy_odd_sectors_are_the_plain_ring(teeth):
    """Wherever an odd sector stands; with as few teeth as are told apart (5) there is no chain of others left."""
    tooth, _, mesh, known = ordinary(teeth)
    same = OddTooth(tooth, mesh)
    found = solve_odd_influence(tooth, mesh, {0: same, 2: same}, NU, "strain", SETTINGS)
    radii = [tooth.form_radius + share * (tooth.tip_radius - tooth.form_radius) for share in (0.1, 0.5, 0.9)]
    scale, stress = known.neighbour(0, radii, radii, PATCH).max(), known.fillet_stress(0, "tension", radii).max()
    for i in range(-2, 3):
        assert (
            np.abs(found.tooth(i).compliance[0] - known.compliance[0]).max() < 1e-12 * np.abs(known.compliance[0]).max()
        )
        for j in range(max(-2, i - 2), min(2, i + 2) + 1):
            off = found.between(i, j, radii, radii, PATCH) - known.neighbour(i - j, radii, radii, PATCH)
            assert np.abs(off).max() < 1e-12 * scale
            for side in SIDES:
                off = found.fillet_stress(i, j, side, radii) - known.fillet_stress(i - j, side, radii)
                assert np.abs(off).max() < 1e-11 * stress


def test_the_ordinary_sector_of_a_solved_ring_is_not_solved_again(monkeypatch):
    """What the plain ring keeps of its sector is what solving it again gives, to the last bit, of both orders."""
    tooth, bore, settings = Tooth(12, TOOTH.rack), 0.45 * 6.0, settings_at(-4)
    mesh = mesh_sector(tooth, bore, settings)
    known = solve_influence(
        tooth, mesh, NU, "strain", order=settings.order, corner_distance=settings.corner_distance, two_orders=True
    )
    crack = straight_crack(tooth, mouth_at_tangent(tooth, math.radians(30.0)), math.radians(70.0), depth=0.5)
    odd = {0: OddTooth(tooth, cracked_sector(tooth, bore, settings, crack))}
    solve, meshes = functools.partial(solve_odd_influence, tooth, mesh, odd, NU, "strain", settings), []
    again = solve(two_orders=True)
    usual = supported_section.assemble_section_two_orders
    monkeypatch.setattr(
        supported_section, "assemble_section_two_orders", lambda one, *rest: meshes.append(one) or usual(one, *rest)
    )
    found = solve(two_orders=True, known=known)
    assert len(meshes) == 1
    assert meshes[0] is odd[0].mesh
    for one, other in ((found, again), (found.lower, again.lower)):
        assert np.array_equal(one.ring.motion, other.ring.motion)
        for name in ("flank_follows", "flank_own"):
            assert np.array_equal(getattr(one.ordinary, name), getattr(other.ordinary, name))
        for side in SIDES:
            assert np.array_equal(one.ordinary.stress_follows[side], other.ordinary.stress_follows[side])
            assert np.array_equal(one.ordinary.stress_own[side], other.ordinary.stress_own[side])
    codec = shape_codec(tooth)
    recalled = codec.read(codec.write(known))
    assert recalled is not None
    assert recalled.rows is recalled.lower.rows is None  # no more on disk than before: then it is solved again
    solve(two_orders=True, known=recalled)
    assert len(meshes) == 3


@pytest.mark.parametrize("neighbour", [0.0, 0.3])
def test_reciprocity_is_left(neighbour):
    """c_ij(p, q) = c_ji(q, p) whichever teeth are cracked, and no longer c_01 = c_10."""
    found, radii = cracked(0.5, neighbour=neighbour), [13.4, 14.0, 14.8]
    for i in range(-2, 3):
        for j in range(-2, 3):
            there, back = found.between(i, j, radii, radii, PATCH), found.between(j, i, radii, radii, PATCH)
            assert there == pytest.approx(back.T, rel=1e-9)
    assert np.abs(found.between(0, 1, radii, radii, PATCH) / found.between(1, 0, radii, radii, PATCH) - 1).max() > 0.01


def test_teeth_are_counted_clockwise():
    """The crack lies on the side of tooth 1: a load there presses on it, one on tooth -1 pulls it open."""
    found = cracked(0.5)
    (ahead, _), (behind, _) = (found.stress_intensity(0, j, [14.0], PATCH)[0] for j in (1, -1))
    assert ahead[0] < 0.0 < behind[0]


@pytest.mark.dear
@pytest.mark.parametrize(("depth", "back"), [(0.2, False), (0.9, False), (0.6, True)])
def test_a_crack_gives_back_the_energy(depth, back):
    """(K_p K_q) = E' / 2 dc_00(p, q) / da for every two places of the load, in the fillet of either flank."""
    step, radii = 0.008 * depth, [13.4, 14.0, 14.8]
    c = [cracked(depth + off, back).between(0, 0, radii, radii, PATCH) for off in (-step, step)]
    k, error = cracked(depth, back).stress_intensity(0, 0, radii, PATCH)
    released = 0.5 * (c[1] - c[0]) / (2.0 * step) / (1.0 - NU**2)
    assert k.T @ k == pytest.approx(released, rel=2.5e-3)
    assert error.max() < 5e-3 * np.hypot(*k).max()


def test_a_crack_that_goes_to_nothing_leaves_the_ordinary_gear():
    """The change of c_00 goes with the square of the depth, at places beside the load: below it elements count."""
    known, radii = ordinary()[3], [13.4, 14.0, 14.8]
    change = [
        cracked(depth).between(0, 0, radii, radii, PATCH) / known.neighbour(0, radii, radii, PATCH) - 1.0
        for depth in (0.08, 0.04)
    ]
    beside = ~np.eye(3, dtype=bool)
    assert np.log2(change[0] / change[1])[beside] == pytest.approx(np.full(6, 2.0), abs=0.35)


def test_root_stress_is_looked_for_on_either_side_of_the_mouth():
    """A deep crack unloads its own fillet and leaves those of the neighbours."""
    found, known, radii = cracked(0.9), ordinary()[3], [13.8, 14.6]
    healthy, _ = known.largest_root_stress(0, "tension", radii)
    stress, place = found.largest_root_stress(0, 0, "tension", radii)
    assert (stress > 0.0).all()
    assert (stress < 0.5 * healthy).all()
    assert ((place >= 0.0) & (place <= (1.0 + 1e-6) * fillet_length(TOOTH))).all()  # edges of the mesh are summed
    assert found.largest_root_stress(1, 1, "tension", radii)[0] == pytest.approx(healthy, rel=0.02)
    points = found.fillet_stress(0, 0, "tension", radii)
    for start, _, chosen in found.kind(0).pieces("tension"):
        arc = found.kind(0).fillets["tension"].arc[chosen]
        inside = (place[:, None] >= arc[0] - 0.05) & (place[:, None] <= arc[-1] + 0.05)
        assert start in (0.0, found.kind(0).mouth)
        assert (points[chosen].max(axis=0) <= 1.05 * stress).all() or inside.any()


@pytest.mark.parametrize(
    ("depth", "angle", "mouth"),
    [(6.0, 70.0, 0.3), (0.001, 70.0, 0.3), (0.5, 180.0, 0.3), (0.5, -60.0, 0.3), (0.5, 70.0, 9.0)],
)
def test_cracks_that_are_none_are_refused(depth, angle, mouth):
    """Out of the tooth, too short, along the fillet or out of it, and from no fillet."""
    with pytest.raises(InputError, match=r"depth|mouth"):
        cracked_sector(TOOTH, BORE, SETTINGS, straight_crack(TOOTH, mouth, math.radians(angle), depth=depth))


def test_mouths_are_found_by_tangent_and_by_radius():
    """Both name the same place; what the fillet has not is refused with what it has."""
    arc = mouth_at_tangent(TOOTH, math.radians(30.0))
    x, y = straight_crack(TOOTH, arc, math.radians(70.0), depth=0.5).path(TOOTH)[:, 0]
    assert mouth_at_radius(TOOTH, math.hypot(x, y)) == pytest.approx(arc, abs=1e-5)
    with pytest.raises(InputError, match="tangents, "):
        mouth_at_tangent(TOOTH, math.radians(1.0))
    with pytest.raises(InputError, match="radius of the fillet, "):
        mouth_at_radius(TOOTH, 14.9)


@pytest.mark.parametrize(
    ("teeth", "shift", "lean", "share", "angle"), [(25, 0.0, 15, 0.4, 70), (20, 0.3, 30, 0.15, 60)]
)
def test_root_stress_of_the_cracked_tooth_itself_in_coarse_meshes(teeth, shift, lean, share, angle):
    """Its largest tension is at the root land: within 2.5e-3 where the ordinary fillet's edges left 9e-3 and 1.5e-2."""
    tooth = Tooth(teeth, BasicRack(), shift)
    mouth = mouth_at_tangent(tooth, math.radians(lean))
    crack = straight_crack(tooth, mouth, math.radians(angle), share=share)
    bore, (low, high), stress = 0.5 * tooth.root_radius, tooth.involute_radii, []
    for level in (-4.0, -0.5):
        settings = settings_at(level)
        meshes = mesh_sector(tooth, bore, settings), cracked_sector(tooth, bore, settings, crack)
        odd = {0: OddTooth(tooth, meshes[1])}
        found = solve_odd_influence(tooth, meshes[0], odd, 0.3, "strain", settings, reach=1)
        radii = np.linspace(low, high, 7)[1:-1]
        stress.append([found.largest_root_stress(0, 0, side, radii)[0] for side in SIDES])
    assert np.array(stress[0]) == pytest.approx(np.array(stress[1]), rel=2.5e-3)
