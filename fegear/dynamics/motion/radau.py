"""Radau IIA collocation: the tables by which the integrator steps over stretches where nothing vibrates."""

from __future__ import annotations

import math
from functools import cache

import numpy as np

from fegear.dynamics.motion.kernel.arrays import Collocation

#: Stages of a step.
STAGES = 10


@cache
def radau(stages: int = STAGES) -> Collocation:
    """Nodes on (0, 1], integration matrix, and what turns values at 0 and the nodes into a polynomial.

    The nodes are the zeros of P_S - P_(S-1), the end of the step among them: a vibration that the step is too long to
    follow is damped away (Hairer and Wanner, Solving Ordinary Differential Equations II, IV.5).

    Parameters
    ----------
    stages : int
        S.

    Returns
    -------
    Collocation
        nodes (S,), integrate (S, S): integrals from 0 to each node of the polynomials that are 1 at one node;
        legendre (S + 1, S + 1): from values at 0 and the nodes to Legendre coefficients; powers (S + 1, S + 1): whole
        numbers that take these to powers. One after the other: their product would lose seven digits.
    """
    difference = np.zeros(stages + 1)
    difference[-2:] = -1.0, 1.0
    z = np.sort(np.polynomial.legendre.legroots(difference).real)
    z[-1] = 1.0
    legendre = np.polynomial.legendre
    integrals = np.column_stack(
        [legendre.legval(z, legendre.legint(np.eye(stages)[k], lbnd=-1)) for k in range(stages)]
    )
    integrate = 0.5 * integrals @ np.linalg.inv(legendre.legvander(z, stages - 1))
    to_legendre = np.linalg.inv(legendre.legvander(np.append(-1.0, z), stages))
    shifted = np.zeros((stages + 1, stages + 1))
    for n in range(stages + 1):
        for k in range(n + 1):
            shifted[k, n] = (-1) ** (n + k) * math.comb(n, k) * math.comb(n + k, k)
    return Collocation(0.5 * (z + 1.0), integrate, to_legendre, shifted)
