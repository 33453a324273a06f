"""A compliance that every test can write down: one tooth, softer at its tip, and its neighbours."""

import math
from dataclasses import dataclass

import numpy as np

from fegear.fem.alike_teeth import AlikeTeeth
from fegear.geometry.gear import Gear


@dataclass(frozen=True)
class SmoothTooth(AlikeTeeth):
    """A tooth that is softer at its tip, with exponentially fading, reciprocal neighbour coupling."""

    gear: Gear
    coupling: float = 0.2
    reach: int = 3

    power = 0.0
    tip_wedge = (0.0, 0.0)
    kinks = ()

    @property
    def log_slope(self):
        return 2.0 / math.pi / self.gear.plane_modulus

    def _s(self, radius):
        return (np.asarray(radius) - self.gear.root_radius) / (self.gear.tip_radius - self.gear.root_radius)

    def own(self, i, radius):
        return (6.0 + 8.0 * self._s(radius) ** 2) / self.gear.plane_modulus

    def reference_half_width(self, radius):
        return np.full(np.shape(radius), 0.1 * self.gear.module)

    def between(self, i, j, radius_p, radius_q):
        shape = (1.0 + 0.5 * self._s(radius_p)) * (1.0 + 0.5 * self._s(radius_q))
        return 2.0 * self.coupling ** abs(i - j) * shape / self.gear.plane_modulus

    def root_stress(self, i, j, radius_q, side):
        return None

    def fillet_curve(self, i, side):
        return None

    def describe(self):
        return "made up"
