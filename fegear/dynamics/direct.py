"""The equations of a train solved as they stand, for frequencies at which elimination finds no good pivot.

On a loop a body whose own springs hold it at its own resonance leaves nothing to divide by. Gaussian elimination with
pivots finds its way round; steps of refinement with residuals in long floats give back the digits. At low frequency,
where inertia disappears beside stiffness, `star_mesh` is far better: whoever asks compares the bounds of round-off.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from fegear.dynamics.rounded import Rounded

if TYPE_CHECKING:
    from numpy.typing import NDArray

    from fegear.dynamics.network import Network

#: Steps of refinement; each gains what doubles leave of a condition number.
REFINEMENTS = 4


def _add(
    matrix: NDArray[np.clongdouble], a: int, b: int, turn_a: np.floating, turn_b: np.floating, y: np.complexfloating
) -> None:
    """Put in what acts on ``turn_a q_a + turn_b q_b``."""
    for p, turn_p in ((a, turn_a), (b, turn_b)):
        for q, turn_q in ((a, turn_a), (b, turn_b)):
            matrix[p, q] += y * turn_p * turn_q


def _matrix(network: Network, w: np.longdouble) -> NDArray[np.clongdouble]:
    matrix = np.diag((-w * w * network.mass + 1j * w * network.ground).astype(np.clongdouble))
    one = np.longdouble(1.0)
    for link in network.links:
        _add(matrix, link.a, link.b, one, -one, link.stiffness + 1j * w * link.damping)
    for slip in network.slips:
        _add(matrix, slip.a, slip.b, slip.turn_a, slip.turn_b, 1j * w * slip.damping)
    return matrix


def lags_by_pivots(network: Network, w: NDArray[np.longdouble], mesh: int) -> list[Rounded]:
    """Difference of approach of every gear pair per unit force on the approach of one [m/N].

    Parameters
    ----------
    network : Network
        In long floats.
    w : ndarray, shape (frequencies,)
        Angular frequencies [rad/s], positive.
    mesh : int
        The gear pair on which the force acts.
    """
    count, eps = network.turns.size, np.finfo(np.longdouble).eps
    rows = np.zeros((count, network.size), dtype=np.longdouble)
    for link in network.links:
        if link.mesh >= 0:
            rows[link.mesh, link.a] += network.turns[link.mesh]
            rows[link.mesh, link.b] -= network.turns[link.mesh]
    value = np.zeros((count, w.size), dtype=np.clongdouble)
    error = np.full((count, w.size), np.inf, dtype=np.longdouble)
    for n, at in enumerate(w):
        matrix = _matrix(network, at)
        # equal scales on the diagonal, so that light bodies have their say among heavy ones
        scale = 1.0 / np.sqrt(np.abs(matrix).sum(axis=1))
        matrix = scale[:, None] * matrix * scale
        load = scale * rows[mesh]
        try:
            inverse = np.linalg.inv(matrix.astype(complex))
        except np.linalg.LinAlgError:
            continue
        x = np.zeros(network.size, dtype=np.clongdouble)
        for _ in range(REFINEMENTS):
            change = inverse @ (load - matrix @ x).astype(complex)
            x = x + change
        residual = 4.0 * (np.abs(matrix) @ np.abs(x) + np.abs(load))
        value[:, n] = rows @ (scale * x)
        scaled = rows * scale
        error[:, n] = np.abs(scaled.astype(float) @ inverse) @ residual + np.abs(scaled) @ np.abs(change) / eps
    return [Rounded(value[i], error[i]) for i in range(count)]
