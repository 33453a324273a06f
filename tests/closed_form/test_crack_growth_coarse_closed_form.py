"""Growing cracks on coarse meshes, so cheap that every run has them: the laws of the fine ones, and what was found."""

import math
from types import SimpleNamespace

import numpy as np
import pytest

from fegear.contact.plane.growing_crack import GrowingCrack, growing_crack
from fegear.fem.plane.odd.crack import mouth_at_tangent, straight_crack
from fegear.fem.plane.odd.crack_over_sectors import patch_boundary, rest_of_ring, sectors_beside
from fegear.fem.plane.odd.growth import equivalent, grow, turning
from fegear.fem.plane.odd.odd_solution import solve_cracked_gear
from fegear.fem.plane.odd.other_sector import empty_sector
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solution import solve_gear
from fegear.formulas.paris import ParisLaw, cycles_to, length_at
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.gear import Gear, Material
from fegear.geometry.outline import tooth_outline
from fegear.geometry.rim_support import RimSupport
from fegear.results.pair import crack_path
from fegear.verify import cracked_strip
from fegear.verify.cracked_strip import KAYA_ERDOGAN, intensity, strip

TOOTH, NU, COARSE = Tooth(20), 0.3, settings_at(-5.0)
DEPTH = TOOTH.tip_radius - TOOTH.root_radius
LOADS = np.array([9.5, 10.3]), np.array([1.0, 0.5])
CRACK = straight_crack(TOOTH, mouth_at_tangent(TOOTH, math.radians(45.0)), math.radians(45.0), depth=0.3)


def bore(backup):
    return TOOTH.root_radius - backup * DEPTH


def grown(backup, support=None, loads=LOADS, steps=1):
    return grow(TOOTH, bore(backup), NU, "stress", CRACK, loads, step=0.2, steps=steps, support=support,
                settings=COARSE)  # fmt: skip


def test_the_first_step_is_the_ring_with_one_cracked_sector():
    """Of a patch of three sectors in a held ring; and one that is all of a free arc stands where it stood."""
    found = grown(2.0, steps=0)
    gear = Gear(TOOTH, 1.0, bore(2.0), 1.0, Material(1.0, NU, 1.0), "stress")
    known = solve_cracked_gear(solve_gear(gear, COARSE, reach=1, estimate_error=False), {0: CRACK})
    k = known.stress_intensity(0, 0, LOADS[0])[0] * LOADS[1]
    worst = int(k[0].argmax())
    assert [found.k_1[0], found.k_2[0]] == pytest.approx(k[:, worst], abs=8e-3 * k[0, worst])  # coarse neighbours
    assert found.radius[0] == found.middle == LOADS[0][worst]
    assert found.turn[0] == turning(found.k_1[0], found.k_2[0])
    assert found.length.tolist() == pytest.approx([0.3])
    assert found.end == "tooth"
    assert found.stopped == "steps"
    arc = grown(1.0, RimSupport(free_teeth=3), steps=0)
    assert [*arc.k_1, *arc.k_2, *arc.compliance] == pytest.approx([1.424186, 0.065307, 6.510912], rel=1e-4)
    assert arc.end == "rim"


def test_a_step_goes_on_where_the_stress_is_largest_and_numbers_are_in_si():
    support = RimSupport(free_teeth=7)
    gear = Gear(TOOTH, 3e-3, 3e-3 * bore(1.0), 0.02, Material(2e11, NU), "stress", support=support)
    law = ParisLaw(6.9e-12, 3.0)
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("fegear.fem.plane.odd.growth.LEVEL", -5.0)
        found = growing_crack(gear, CRACK, (3e-3 * LOADS[0], 1e5 * LOADS[1]), step=0.6e-3, steps=1, law=law,
                              toughness=2.8e6, factors=(1.0, 0.5), shares=(0.9, 0.1))  # fmt: skip
    # what was found when a step of the fine mesh was that of the ring (`test_crack_growth_closed_form`); K_I with edges
    # that meet their circles: 2e-4 less
    scale = 1e5 / math.sqrt(3e-3)
    assert found.k_1 / scale == pytest.approx([1.42744, 1.63811], rel=1e-4)
    assert found.k_2 / scale == pytest.approx([0.06098, 0.03434], abs=1e-4)
    assert found.stiffness == pytest.approx(2e11 / np.array([9.71311, 10.65714]), rel=1e-4)
    assert found.stiffness_loss == pytest.approx([0.0, 1.0 - 9.71311 / 10.65714], abs=1e-5)
    assert (found.stiffness_error > 1e-5 * found.stiffness).all()  # as a share that of the compliance
    assert (found.stiffness_error < 1e-2 * found.stiffness).all()
    assert found.load_radius == pytest.approx(np.full(2, 9.5 * 3e-3))
    assert found.length == pytest.approx([0.9e-3, 1.5e-3], rel=1e-9)
    assert found.end == "rim"
    way = np.diff(found.path[:, -3:]) / np.hypot(*np.diff(found.path[:, -3:]))
    cross = way[0, 0] * way[1, 1] - way[1, 0] * way[0, 1]
    assert math.asin(cross) == pytest.approx(found.turn[0], rel=1e-6)
    assert [found.x[1], found.y[1]] == pytest.approx(found.path[:, -1])
    assert [found.x[0], found.y[0]] == pytest.approx(found.path[:, -2])
    opened = equivalent(found.k_1, found.k_2)
    rate = law.rate(opened, (1.0, 0.5), (0.9, 0.1))
    assert found.growth_rate == pytest.approx(rate, rel=1e-9)
    assert found.cycles == pytest.approx(cycles_to(found.length, rate), rel=1e-9)
    assert found.fracture == pytest.approx(length_at(found.length, opened, 2.8e6), rel=1e-9)
    assert found.cycles_to_fracture == pytest.approx(np.interp(found.fracture, found.length, found.cycles))


def test_patches_are_wider_below_thin_rims_and_no_wider_than_the_free_arc():
    for backup, support, half in (
        (1.0, None, 2), (2.0, None, 1), (1.4, RimSupport(free_teeth=3), 1), (1.4, RimSupport(free_teeth=9), 2),
    ):  # fmt: skip
        assert sectors_beside(TOOTH, bore(backup), support) == half
    few = SimpleNamespace(teeth=5, tip_radius=3.5, root_radius=2.0)
    assert sectors_beside(few, 1.0, None) == 1
    chains = patch_boundary(TOOTH, bore(2.0), COARSE, 1, None)
    for one, following in zip(chains, [*chains[1:], chains[0]], strict=True):
        np.testing.assert_array_equal(one.vertices[:, -1], following.vertices[:, 0])
    x, y = np.hstack([one.vertices[:, :-1] for one in chains])
    area = 0.5 * float(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))
    u, v = np.hstack([tooth_outline(TOOTH)])
    tooth = 0.5 * float(np.sum(u[1:] * v[:-1] - v[1:] * u[:-1]))
    assert area == pytest.approx(3.0 * (tooth - math.pi * bore(2.0) ** 2 / TOOTH.teeth), rel=5e-3)
    assert [one.name for one in chains].count("bore") == 3


def test_the_rest_of_a_ring_is_still_where_the_patch_is_and_symmetric():
    """A ring turned as a whole: the held bore alone resists, and the more the nearer it is."""
    for support in (None, RimSupport(free_teeth=9)):
        rest = rest_of_ring(TOOTH, bore(1.2), NU, "stress", COARSE, support)
        assert rest.half == 2
        assert rest.stiffness.shape == (rest.moves.size,) * 2
        np.testing.assert_allclose(rest.stiffness, rest.stiffness.T, atol=1e-9 * np.abs(rest.stiffness).max())
        assert np.linalg.eigvalsh(rest.stiffness[np.ix_(rest.moves, rest.moves)]).min() > -1e-9


def test_a_sector_without_its_tooth_ends_at_the_root_circle():
    mesh = empty_sector(TOOTH, bore(1.0), COARSE)
    radius = np.hypot(*mesh.points)
    assert radius.max() == pytest.approx(TOOTH.root_radius, rel=1e-12)
    assert radius.min() == pytest.approx(bore(1.0) * math.cos(0.25 * math.pi / 20), rel=1e-2)
    top = np.unique(mesh.edges["root_land"])
    assert radius[top] == pytest.approx(np.full(top.size, TOOTH.root_radius), rel=1e-12)
    x, y = mesh.points[:, mesh.triangles[:3]]
    area = 0.5 * float(np.sum((x[1] - x[0]) * (y[2] - y[0]) - (x[2] - x[0]) * (y[1] - y[0])))
    assert area == pytest.approx(math.pi * (TOOTH.root_radius**2 - bore(1.0) ** 2) / 20, rel=2e-3)
    angle = np.sort(np.arctan2(*mesh.points[:, top]))
    assert -angle[0] == pytest.approx(math.pi / 20, rel=1e-9)
    assert angle[-1] == pytest.approx(math.pi / 20, rel=1e-9)
    # short beside the neighbours' fillets, and the longer the farther from them
    steps = np.diff(angle[::2])
    assert steps == pytest.approx(steps[::-1], rel=1e-6)
    assert (np.diff(steps[: steps.size // 2]) > 0.0).all()


def test_a_coarse_strip_is_near_its_printed_stress_intensity():
    sector = strip(0.3, 0.03, edge=0.15)
    for stress, printed in zip((cracked_strip._tension, cracked_strip._bending), KAYA_ERDOGAN[0.3], strict=True):
        assert intensity(sector, 3, stress) == pytest.approx([printed, 0.0], abs=5e-4)


def _path(**changes):
    fields = {
        "crack": CRACK, "path": np.array([[1.0, 2.0, 3.0], [26.0, 25.0, 24.5]]) * 1e-3, "end": "tooth",
        "stopped": "surface", "fracture": None, "length": np.array([1e-3, 2e-3]), "x": np.array([2e-3, 3e-3]),
        "y": np.array([25e-3, 24.5e-3]), "k_1": np.array([4e6, 5e6]), "k_2": np.zeros(2), "turn": np.zeros(2),
        "load_radius": np.zeros(2), "stiffness": np.array([4e8, 3e8]), "stiffness_loss": np.array([0.0, 0.25]),
        "tip_error": np.zeros(2),
    }  # fmt: skip
    gear = Gear(TOOTH, 3e-3, 3e-3 * bore(1.0), 0.02)
    return crack_path.Path("pinion", gear, 4, GrowingCrack(**fields | changes), 2e-3, None)


def _said(one):
    (sentence,) = crack_path._answer(SimpleNamespace(name="I", data=crack_path.CrackPathData((one,))))
    return sentence.removeprefix("Pair I, crack of tooth 4 of gear pinion: ")


def test_what_is_said_of_a_path():
    one = _path()
    assert _said(one) == "breaks through the tooth, 1 to 2 mm; stiffness of the tooth decreases by 25 %."
    assert "heads through the rim, 1 to 2 mm, fracture at 1.5 mm;" in _said(
        _path(end="rim", stopped="steps", fracture=1.5e-3)
    )
    assert _said(_path(stopped="closed")) == "no growth, the loads on its tooth do not open it."
    for cycles, text in ((2.5e6, ", 2.5e+06 load cycles;"), (math.inf, ", stops below the threshold;")):
        assert text in _said(crack_path.Path("pinion", one.made, 4, one.found, 2e-3, cycles))
    assert crack_path._first(SimpleNamespace(data=crack_path.CrackPathData((one,)))) == ("pinion", 4)


def test_a_path_is_drawn_from_the_mouth_on_in_millimetres():
    one = _path()
    figure = crack_path.path_figure("crack", "title", one)
    (panel,) = figure.panels
    lines = {item.name: item for item in panel.items}
    np.testing.assert_allclose([lines["growth to 2 mm"].x, lines["growth to 2 mm"].y], one.found.path[:, 1:] * 1e3)
    np.testing.assert_allclose(
        [lines["crack of the case, 1 mm"].x, lines["crack of the case, 1 mm"].y], one.found.path[:, :2] * 1e3
    )
    assert np.hypot(lines["bore"].x, lines["bore"].y) == pytest.approx(np.full(61, 3.0 * bore(1.0)))
    assert "in 1 steps" in figure.caption
    assert panel.x.limits[0] == -panel.x.limits[1]
    assert panel.y.limits[1] == pytest.approx(3.0 * (TOOTH.tip_radius + 0.2))
    assert panel.y.limits[0] == pytest.approx(max(3.0 * bore(1.0), 24.5 - 6.0) - 0.9)
