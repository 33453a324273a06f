"""How tooth pairs are to share a design load over the plane of action: Mark's loading functions, spread over the face.

The line load is f(x, z) = W w(x) q(z): w is a loading function of the path whose values at all pairs add up to one, q a
distribution over the face with the integral one. At every height z the pairs in reach then carry W q(z) together at
every roll position, whatever the helix angle, for their positions are a base pitch apart there; the forces of all
contact lines add up to W, and the load over the face is q at every instant. (Mark, Eqs. 4.9 to 4.14, taken along the
contact lines.)
"""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING

import numpy as np

from fegear.errors import RangeError

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.arrays import Array
    from fegear.design.loading import LoadingFunction


@dataclass(frozen=True, slots=True)
class FlankLoading:
    """Design load of a tooth pair per length of face, over the plane of action.

    Parameters
    ----------
    over_path : LoadingFunction
    face_width : float
        [m].
    end_length : float
        Length at both ends of the face over which the load falls to nothing, as half a wave of a cosine [m].

    Raises
    ------
    RangeError
        If both ends are longer than the face.
    """

    over_path: LoadingFunction
    face_width: float
    end_length: float = 0.0

    def __post_init__(self) -> None:
        """Refuse ends that meet."""
        if not 0.0 <= self.end_length <= 0.5 * self.face_width * (1.0 + 1e-12):
            raise RangeError(
                "flank_design.end_length", f"{self.end_length * 1e3:.6g} mm",
                f"must lie between zero and half the face, {0.5e3 * self.face_width:.6g} mm",
            )  # fmt: skip

    @property
    def face_load_factor(self) -> float:
        """K_Hbeta of the design load: largest q(z) over 1/b."""
        return self.face_width / (self.face_width - self.end_length)

    def over_face(self, z: ArrayLike) -> Array:
        """q(z) [1/m] at heights from the middle of the face [m]; zero beyond its ends."""
        inside = 0.5 * self.face_width - np.abs(np.asarray(z, dtype=float))
        whole = 1.0 / (self.face_width - self.end_length)
        if self.end_length == 0.0:
            return np.where(inside >= -1e-9 * self.face_width, whole, 0.0)
        return np.asarray(0.5 * whole * (1.0 - np.cos(np.pi * np.clip(inside / self.end_length, 0.0, 1.0))))

    def line_load(self, x: ArrayLike, z: ArrayLike) -> Array:
        """f(x, z) / W [1/m]: share of the load on a tooth pair per length of face."""
        return np.asarray(self.over_path.fraction(x) * self.over_face(z))
