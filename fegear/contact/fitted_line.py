"""What is linear in a measured curve laid over a computed one: offset, scale and drift, and their standard errors."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

import numpy as np

if TYPE_CHECKING:
    from fegear.base.arrays import Array

Fitted = Literal["offset", "scale", "shift", "drift"]
FITTED: tuple[Fitted, ...] = ("offset", "scale", "shift", "drift")
#: Largest correlation of neighbouring residuals with which standard errors are counted.
_MOST_CORRELATED = 0.99


@dataclass(frozen=True)
class FittedLine:
    """What is linear in a fit: measured = offset + drift * turn + scale * curve."""

    offset: float
    scale: float
    drift: float

    def less(self, measured: Array, turn: Array) -> Array:
        """Measured without offset and drift."""
        return np.asarray(measured - self.offset - (self.drift * turn if self.drift else 0.0))


def linear(curve: Array, measured: Array, turn: Array, asked: tuple[Fitted, ...]) -> FittedLine:
    """Offset, scale and drift by least squares, those that are asked for; the mean of the turns is zero."""
    scale, size = 1.0, float(turn @ turn) if "drift" in asked else 0.0

    def free(of: Array) -> Array:  # of what offset and drift take up
        one = of - of.mean() if "offset" in asked else of
        return np.asarray(one - float(turn @ one) / size * turn if size else one)

    if "scale" in asked:
        c = free(curve)
        power = float(c @ c)
        scale = float(c @ free(measured)) / power if power else 0.0
    rest = measured - scale * curve
    return FittedLine(
        float(rest.mean()) if "offset" in asked else 0.0, scale, float(turn @ rest) / size if size else 0.0
    )  # fmt: skip


def squares_left(curve: Array, measured: Array, turn: Array, asked: tuple[Fitted, ...]) -> float:
    """What least squares of `linear` leave."""
    line = linear(curve, measured, turn, asked)
    residual = line.less(measured, turn) - line.scale * curve
    return float(residual @ residual)


def standard_errors(
    curve: Array, slope: Array, scale: float, residual: Array, asked: tuple[Fitted, ...], turn: Array | None = None,
    noise: float | None = None,
) -> dict[Fitted, float]:  # fmt: skip
    """Of what is fitted; neighbouring residuals that go together count as fewer samples, unless the noise is given."""
    columns: dict[Fitted, Array] = {"offset": np.ones(curve.size), "scale": curve, "shift": -scale * slope}
    if turn is not None:
        columns["drift"] = turn
    if not asked:
        return {}
    matrix = np.stack([columns[one] for one in asked], axis=1)
    size = np.linalg.norm(matrix, axis=0)
    size[size == 0.0] = 1.0
    squares = float(residual @ residual)
    variance = squares / max(curve.size - len(asked), 1)
    follows = float(residual[1:] @ residual[:-1]) / squares if squares else 0.0
    follows = min(max(follows, 0.0), _MOST_CORRELATED)
    variance *= (1.0 + follows) / (1.0 - follows)
    if noise is not None:
        variance = noise**2
    spread = np.diag(np.linalg.pinv((matrix / size).T @ (matrix / size))) * variance
    return {one: float(math.sqrt(max(spread[i], 0.0)) / size[i]) for i, one in enumerate(asked)}
