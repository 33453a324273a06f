"""A wedge's face pressed near its corner by a half-plane, and the tip of a tooth of finite elements by the same.

Lengths in half-widths of Hertz's contact between two half-planes, deflections per kappa and unit load. The wedge's own
answer is its Mellin symbol: a pressure r^(i tau - 1) on one face moves it by r^(i tau - 1) H(i tau) per r, from the
Airy functions r^(1 + i tau) cos and sin of (i tau +- 1) theta of both loaded faces, symmetric and antisymmetric.
"""

import math

import numpy as np
from scipy.interpolate import CubicSpline

from fegear.fem.plane.contact_width import wedge_slope
from fegear.fem.plane.trace import lagrange

#: Logarithms of two places' ratio up to which the symbol is turned back; beyond it the answer is straight.
_FAR = 40.0


def wedge_beyond_half_plane(angle):
    """By how much more the face of a wedge sinks at r under a unit load at q than a half-plane: a function of both."""
    x, w = np.polynomial.legendre.leggauss(12)
    ends = np.linspace(0.0, 30.0, 601)
    half = 0.5 * np.diff(ends)[:, None]
    tau, weight = (0.5 * (ends[1:] + ends[:-1])[:, None] + half * x).ravel(), (half * w).ravel()
    e = np.exp(-tau * angle)
    cosh, sinh = 0.5 * (1.0 + e * e), 0.5 * (1.0 - e * e)  # times e
    wedge = (cosh - math.cos(angle) * e) / (sinh + tau * math.sin(angle) * e)
    wedge += (cosh + math.cos(angle) * e) / (sinh - tau * math.sin(angle) * e)
    symbol = weight * (wedge - 2.0 / np.tanh(math.pi * tau)) / tau
    z = np.concatenate([np.linspace(0.0, 3.0, 301), np.linspace(3.05, _FAR, 740)])
    even = CubicSpline(z, [-np.sum(symbol * np.sin(0.5 * tau * at) ** 2) for at in z])
    steep = 0.5 * (0.5 * math.pi * wedge_slope(angle) - 1.0)

    def answer(r, q):
        apart = np.abs(np.log(r / q))
        return even(np.minimum(apart, _FAR)) - steep * (np.maximum(apart - _FAR, 0.0) + np.log(r) + np.log(q))

    return answer


def logarithms(knots):
    """Means of -ln|s - s'| over pairs of intervals between knots."""
    whole = lambda d: np.where(d == 0.0, 0.0, d * d * (0.5 * np.log(np.abs(np.where(d == 0.0, 1.0, d))) - 0.75))  # noqa: E731
    a, b = knots[:-1], knots[1:]
    total = whole(b[:, None] - a) + whole(a[:, None] - b) - whole(a[:, None] - a) - whole(b[:, None] - b)
    return -total / np.multiply.outer(b - a, b - a)


def approach(compliance, gap):
    """Approach under a unit load of contacts that only push, by active sets; and which of them press."""
    on = np.ones(gap.size, dtype=bool)
    for _ in range(200):
        at = np.flatnonzero(on)
        system = np.zeros((at.size + 1, at.size + 1))
        system[:-1, :-1], system[:-1, -1], system[-1, :-1] = compliance[np.ix_(at, at)], -1.0, 1.0
        found = np.linalg.solve(system, np.append(-gap[at], 1.0))
        force = np.zeros(gap.size)
        force[at] = found[:-1]
        enters = ~on & (compliance @ force + gap - found[-1] < -1e-12)
        if (force >= 0.0).all() and not enters.any():
            return float(found[-1]), on
        on = (on & (force >= 0.0)) | enters
    raise AssertionError("no set of contacts settles")


def of_wedge(t, share, answer, count=120):
    """psi of the wedge with this share of kappa, and no room: approach beyond Hertz's centre of two half-planes."""
    y = 2.0 / (t + math.sqrt(t * t + 3.0))
    u = np.linspace(0.0, 1.0, count + 1)
    graded = np.where(u < 0.5, 0.5 * (2.0 * u) ** 4, 1.0 - 0.5 * (2.0 - 2.0 * u) ** 4)
    end = 2.5 * y
    for _ in range(4):  # end the knots where the contact does
        knots = end * graded
        middle = 0.5 * (knots[1:] + knots[:-1])
        gap = (np.diff(knots**3) / 3.0 + t * np.diff(knots**2)) / np.diff(knots)
        found, on = approach(logarithms(knots) + share * answer(middle[:, None], middle), gap)
        end = 1.02 * knots[np.flatnonzero(on)[-1] + 1]
    return found + min(t, 0.0) ** 2 - math.log(2.0) - 0.5


def of_tooth(known, t, half_width, parts=3):
    """Approach under a unit load of a tooth's tip and a half-plane of the same material [1/E]."""
    flank, kappa = known.flank, 2.0 * known.log_slope
    end = flank.flank_end
    reach = end - 2.2 * half_width * 2.0 / (t + math.sqrt(t * t + 3.0))
    edges = [e for e in range(flank.after_flank_edge) if flank.arc[e + 1] > reach]
    shares = np.arange(parts) / parts
    knots = np.concatenate([flank.arc[e] + shares * (flank.arc[e + 1] - flank.arc[e]) for e in edges])
    knots = np.append(knots, end)
    x, w = np.polynomial.legendre.leggauss(8)
    x, w = 0.5 + 0.5 * x, 0.5 * w
    loads, gap = np.zeros((2, flank.nodes, knots.size - 1)), np.zeros(knots.size - 1)
    for i in range(gap.size):
        e, s = edges[i // parts], knots[i] + (knots[i + 1] - knots[i]) * x
        along = (s - flank.arc[e]) / (flank.arc[e + 1] - flank.arc[e])
        inward = flank._normal(np.array([e]), along[None])[:, 0]
        nodes = slice(e * flank.order, (e + 1) * flank.order + 1)
        loads[:, nodes, i] += np.einsum("iq,cq->ci", lagrange(flank.order, along), inward * w)
        gap[i] = kappa * (w @ (((end - s) / half_width) ** 2 + 2.0 * t * (end - s) / half_width))
    loads = loads.reshape(-1, gap.size)
    own = loads.T @ known.compliance[0] @ loads + known.log_slope * logarithms(knots)
    return approach(own, gap)[0] + kappa * min(t, 0.0) ** 2
