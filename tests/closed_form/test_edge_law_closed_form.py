"""What a tip's corner adds to the approach, compared with solved wedges and with teeth of finite elements."""

import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
import pytest

from fegear.contact.plane.edge_law import edge_law, room_slope
from fegear.contact.plane.shifted_compliance import _TIP
from fegear.fem.plane.contact_width import corner_angles, wedge_slope
from fegear.fem.plane.settings import settings_at
from fegear.fem.plane.solved_ring import solve_influence
from fegear.fem.plane.tooth_meshing import mesh_sector
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.internal_tooth import InternalTooth, PinionCutter

sys.path.insert(0, str(Path(__file__).parents[1] / "helpers"))
import edge_contact

TILTS = (-0.9, -0.5, 0.0, 0.7, 3.0, 20.0)


def test_the_wedge_of_two_right_angles_is_the_half_plane():
    answer = edge_contact.wedge_beyond_half_plane(math.pi)
    for t in TILTS:
        assert edge_contact.of_wedge(t, 0.5, answer) == pytest.approx(float(edge_law(t)[0]), abs=1e-4)


def test_a_load_far_from_the_corner_and_one_at_it_sink_as_the_half_plane_s_and_the_wedge_s_logarithm():
    """A pressure's distance from the corner ten times as large: beyond the half-plane by 1 - sigma times ln 10."""
    angle = math.radians(107.0)
    answer, sigma = edge_contact.wedge_beyond_half_plane(angle), 0.5 * math.pi * wedge_slope(angle)
    near, far = (float(answer(np.array(d), np.array(d * (1.0 + 1e-9)))) for d in (1.0, 10.0))
    assert far - near == pytest.approx((1.0 - sigma) * math.log(10.0), rel=1e-6)
    # seen from far along the face a load at the corner is the force at the apex
    assert float(answer(np.array(1e6), np.array(1.0)) - answer(np.array(1e7), np.array(1.0))) == pytest.approx(
        (sigma - 1.0) * math.log(10.0), rel=1e-5
    )


@pytest.mark.parametrize(("degrees", "share"), [(107.0, 0.5), (122.0, 0.5), (115.0, 0.3)])
def test_edge_law_is_that_of_solved_wedges(degrees, share):
    angle = math.radians(degrees)
    answer = edge_contact.wedge_beyond_half_plane(angle)
    gamma = share * (0.5 * math.pi * wedge_slope(angle) - 1.0)
    half_planes = [float(edge_law(t)[0]) for t in TILTS]
    found = [edge_contact.of_wedge(t, share, answer, 80) for t in TILTS]
    # no room: one half-width of it is gamma ln 1, but where the corner lies deeper than that
    mine = [float(edge_law(t, gamma, 1.0)[0]) for t in TILTS]
    assert np.abs(np.array(mine) - found).max() < 0.025
    assert np.abs(np.array(half_planes) - found).max() > 0.1


@pytest.mark.parametrize("gamma", [0.05, 0.466, 0.95])
@pytest.mark.parametrize("room", [0.2, 0.63, 1.6])
def test_slopes(gamma, room):
    h = 1e-6
    for t in (-3.0, -1.3, -0.99, -0.7, -0.3, 0.01, 0.9, 4.0, 30.0):
        by_load = [float(edge_law(t / math.sqrt(w), gamma, room / math.sqrt(w))[0]) for w in (1.0 - h, 1.0 + h)]
        assert (by_load[0] - by_load[1]) / h == pytest.approx(float(edge_law(t, gamma, room)[1]), abs=2e-5)
        by_room = [float(edge_law(t, gamma, room * (1.0 + d))[0]) for d in (-h, h)]
        assert (by_room[1] - by_room[0]) / (2.0 * h) == pytest.approx(float(room_slope(t, gamma, room)), abs=1e-5)


def test_far_from_the_corner_nothing_changes_to_the_last_digit():
    t = np.array([-np.inf, -1e10, -5.0, -1.7])
    assert (np.array(edge_law(t, np.full(4, 0.5), np.full(4, 1.6))) == 0.0).all()
    t = np.linspace(-1.0, 50.0, 300)
    assert np.array_equal(edge_law(t, 0.0, 1.6), edge_law(t))


RING = InternalTooth(60, PinionCutter(20, 0.1, 1.25, tip_radius=0.2), tip_radius=29.2)


@pytest.mark.parametrize(
    ("tooth", "body"), [(RING, 33.0), pytest.param(Tooth(28), 6.4, marks=pytest.mark.long)], ids=["ring", "z28"]
)
def test_approach_of_a_tip_s_corner_and_a_half_plane(tooth, body):
    """Contacts resolved on finite elements of .0015 modules at the corner: half-planes were off by up to 9 %."""
    fine = replace(settings_at(1), tip_edge_length=0.0015, tip_growth=0.35)
    known = solve_influence(tooth, mesh_sector(tooth, body, fine), 0.3, "strain", order=4)
    usual = solve_influence(tooth, mesh_sector(tooth, body, settings_at(0)), 0.3, "strain", order=3)
    place, kappa_t = 0.02, known.log_slope
    gamma = 0.5 * (0.5 * math.pi * wedge_slope(corner_angles(tooth)[1]) - 1.0)
    worst, beyond = [], []
    for half_width in (0.01, 0.03):
        for t in (-0.5, 0.0, 1.0, 3.0):
            radius = usual.flank.radius_of_arc(np.array([usual.flank.flank_end + min(t, 0.0) * half_width]))
            own = float(usual.self_compliance(radius, settings_at(0).patch_half_width, place)[0])
            hertz = own + kappa_t * (math.log(place / half_width) + math.log(2.0 / half_width) + 0.5)
            true = edge_contact.of_tooth(known, t, half_width)
            psi = [float(edge_law(t, g, place / half_width)[0]) for g in (0.0, gamma)]
            stated = float(edge_law(t, gamma, _TIP * place / half_width)[0]) - psi[1]
            beyond.append((true - hertz) / (2.0 * kappa_t) - psi[1] - 1.5 * stated)
            worst.append([(hertz + 2.0 * kappa_t * p) / true - 1.0 for p in psi])
    half_planes, wedges = np.abs(worst).max(axis=0)
    assert wedges < 8e-3
    assert max(beyond) < 5e-3  # kappa
    assert half_planes > 2e-2
