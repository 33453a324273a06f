"""Dynamic increments of any train in many digits, from the plain matrix equation."""

import mpmath
import numpy as np

from fegear.dynamics.train.matrices import elements


def exact_increments(train, omega, digits=40):
    """Q of every mesh from A H = U and W = (g H - zeta)/C (2.38 to 2.44)."""
    with mpmath.workdps(digits):
        mp, w, n, m = mpmath.mpf, mpmath.mpf(float(omega)), train.size, len(train.meshes)
        A, G = mpmath.matrix(n, n), mpmath.matrix(m, n)
        for i in range(n):
            A[i, i] = -w * w * mp(float(train.inertia[i]))
        for e in elements(train):
            y = mpmath.mpc(mp(e.stiffness), w * mp(e.damping))
            ends = [(e.a, mp(e.radius_a))] + ([(e.b, mp(e.radius_b))] if e.b >= 0 else [])
            for p, rp in ends:
                if e.mesh >= 0:
                    G[e.mesh, p] = rp
                for q, rq in ends:
                    A[p, q] += y * rp * rq
        found = np.empty((m, m), dtype=complex)
        for j, source in enumerate(train.meshes):
            h = mpmath.lu_solve(A, G[j, :].T * mp(source.stiffness))
            for i, mesh in enumerate(train.meshes):
                lag = 1 + mpmath.mpc(0, w * mp(mesh.damping) / mp(mesh.stiffness))
                found[i, j] = complex((G[i, :] * h)[0] * lag - (1 if i == j else 0))
        return found
