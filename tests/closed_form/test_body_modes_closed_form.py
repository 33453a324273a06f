"""Natural frequencies of an annulus held at its bore: torsion of a disc, bending and stretching of a thin plate.

The sector of `body_modes` is that of a plain ring, whose waves are Bessel functions of the radius:

- torsion without nodal diameters of a disc of any width, v = A J1(k r) + B Y1(k r) with k = omega / c_shear (exact);
- bending of a thin plate (S. M. Vogel, D. W. Skinner, J. Appl. Mech. 32 (1965) 926; A. W. Leissa, Vibration of Plates,
  NASA SP-160 (1969), chapter 2), w = A J_n + B Y_n + C I_n + D K_n;
- plane stress of the same plate, potentials of both wave speeds.
"""

import functools
import math
from itertools import pairwise

import numpy as np
import pytest
from scipy.optimize import brentq
from scipy.special import iv, jv, kv, yv

from fegear.fem.plane.mesh import SectorMesh, with_middle_nodes
from fegear.fem.solid import body_modes as module
from fegear.fem.solid.settings import SolidSettings
from fegear.geometry.external_tooth import Tooth
from fegear.geometry.rack import BasicRack

TEETH, INNER, OUTER, NU = 24, 2.5, 5.0, 0.3
THIN = 0.05
SHEAR = 0.5 / (1.0 + NU)


def annulus(radial, around):
    """A sector of a plain ring; its outside is called flank."""
    half = math.pi / TEETH
    # Finer toward the bore, where a plate is clamped.
    radii = INNER + (OUTER - INNER) * np.linspace(0.0, 1.0, radial + 1) ** 2
    angles = np.linspace(-half, half, around + 1)
    r, t = np.meshgrid(radii, angles, indexing="ij")
    number = np.arange(r.size).reshape(r.shape)
    a, b, c, d = (x.ravel() for x in (number[:-1, :-1], number[:-1, 1:], number[1:, 1:], number[1:, :-1]))

    def place(r, t):
        return np.stack([r * np.sin(t), r * np.cos(t)])

    def mid(v):
        return 0.5 * (v[1:] + v[:-1])

    chains = {"bore": number[0], "flank": number[-1, ::-1], "side_a": number[::-1, 0], "side_b": number[:, -1]}
    middles = {
        "bore": place(INNER, mid(angles)), "flank": place(OUTER, mid(angles[::-1])),
        "side_a": place(mid(radii[::-1]), -half), "side_b": place(mid(radii), half),
    }  # fmt: skip
    triangles = np.hstack([np.stack([a, b, c]), np.stack([a, c, d])])
    points, six, edges = with_middle_nodes(place(r.ravel(), t.ravel()), triangles, chains, middles)
    return SectorMesh(points, six, edges, TEETH)


@functools.cache
def found(width):
    """Waves of the plain ring, by nodal diameters."""
    tooth, settings = Tooth(TEETH, BasicRack(1.0, 1.25, 0.25)), SolidSettings()
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(module, "section_mesh", lambda *_, **__: annulus(8, 2))
        modes = module.body_modes(tooth, 0.0, width, NU, INNER, settings, diameters=3, each=6).modes
    return [[mode for mode in modes if mode.diameters == n] for n in range(4)]


def roots(function, low, high, count):
    """The lowest zeros, between places where the sign changes."""
    at = np.linspace(low, high, 400)
    value = [function(x) for x in at]
    ends = [pair for pair, signs in zip(pairwise(at), pairwise(np.sign(value)), strict=True) if signs[0] != signs[1]]
    return [brentq(function, *pair, xtol=1e-13) for pair in ends[:count]]


def derivatives(f, n, x):
    """A Bessel function with its first three derivatives, from its neighbours' by its own recurrence."""
    sign = {jv: (0.5, -0.5), yv: (0.5, -0.5), iv: (0.5, 0.5), kv: (-0.5, -0.5)}[f]

    def slope(order, times):
        if times == 0:
            return f(order, x)
        return sign[0] * slope(order - 1, times - 1) + sign[1] * slope(order + 1, times - 1)

    return [slope(n, times) for times in range(4)]


def bending(n, lam):
    """Determinant of a thin plate, clamped inside and free outside; omega = lam^2 / OUTER^2 sqrt(D / rho h)."""
    k, rows = lam / OUTER, []
    for f in (jv, yv, iv, kv):
        w, slope, *_ = derivatives(f, n, k * INNER)
        w1, d1, d2, d3 = (v * k**i for i, v in enumerate(derivatives(f, n, k * OUTER)))
        r = OUTER
        moment = d2 + NU * (d1 / r - n * n * w1 / r**2)
        force = d3 + d2 / r - (1 + n * n * (2 - NU)) * d1 / r**2 + n * n * (3 - NU) * w1 / r**3
        rows.append(np.array([w, slope * k, moment, force]) / (iv(n, lam) if f is iv else 1.0))
    return float(np.linalg.det(np.array(rows)))


def stretching(n, omega):
    """Determinant of plane stress, held inside and free outside."""
    fast, slow = omega * math.sqrt(1 - NU**2), omega / math.sqrt(SHEAR)
    rows = []
    for k, curl in ((fast, False), (slow, True)):
        for f in (jv, yv):
            columns = []
            for r in (INNER, OUTER):
                p, d, dd = (v * k**i for i, v in enumerate(derivatives(f, n, k * r)[:3]))
                # u = outward and v = round the axis, times cos and sin of n theta, with their slopes along r.
                u, v = (n * p / r, -d) if curl else (d, -n * p / r)
                du, dv = (n * (d / r - p / r**2), -dd) if curl else (dd, -n * (d / r - p / r**2))
                columns.append((u, v, du + NU * (u + n * v) / r, dv - (v + n * u) / r))
            rows.append([*columns[0][:2], *columns[1][2:]])
    return float(np.linalg.det(np.array(rows)))


@pytest.mark.dear("3.0", "0.05")
@pytest.mark.parametrize("width", [0.05, 3.0])
def test_torsion_of_a_disc(width):
    """Exact whatever the width: only the mesh of the section is in the way."""

    def held_and_free(k):
        return jv(1, k * INNER) * yv(2, k * OUTER) - yv(1, k * INNER) * jv(2, k * OUTER)

    wanted = math.sqrt(SHEAR) * roots(held_and_free, 0.05, 3.0, 1)[0]
    first = next(mode for mode in found(width)[0] if mode.tangential > 0.999)
    assert first.frequency == pytest.approx(wanted, rel=1e-6)


@pytest.mark.parametrize("n", range(4))
def test_a_thin_plate_bends(n):
    """A fiftieth of its breadth thick: shear and rotary inertia take .2 % of the second wave."""
    unit = math.sqrt(THIN**2 / (12.0 * (1.0 - NU**2))) / OUTER**2
    wanted = [unit * lam**2 for lam in roots(lambda lam: bending(n, lam), 0.5, 14.0, 2)]
    modes = [mode.frequency for mode in found(THIN)[n] if mode.axial > 0.9]
    assert modes[0] == pytest.approx(wanted[0], rel=1e-3)
    assert modes[1] == pytest.approx(wanted[1], rel=3e-3)


@pytest.mark.parametrize("n", range(3))
def test_a_thin_plate_stretches(n):
    """In its plane: torsion, then sideways, then oval."""
    wanted = roots(lambda omega: stretching(n, omega), 0.05, 3.0, 1)[0]
    first = next(mode for mode in found(THIN)[n] if mode.axial < 0.1)
    assert first.frequency == pytest.approx(wanted, rel=2e-4)
