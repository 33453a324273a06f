"""Teeth with equal involute flanks, external and internal: their thickness, and limits of the tip's edge."""

from __future__ import annotations

import math
from abc import abstractmethod
from functools import cached_property

from numpy.typing import ArrayLike

from fegear.base.arrays import Array
from fegear.base.errors import GeometryError
from fegear.geometry.involute import inv
from fegear.geometry.involute_side import InvoluteSide


class InvoluteTooth(InvoluteSide):
    """A tooth whose involute flanks are alike: the mirror image of its right side is its left one.

    All that is true of such teeth only (standards, half angles, drawings that mirror) demands this type; what looks at
    one loaded flank takes an `InvoluteSide`.
    """

    # ---- what the tool decides -------------------------------------------------------------------------------------
    @property
    @abstractmethod
    def dedendum(self) -> float:
        """h_fP of the basic rack [modules]; of an internal tooth what its cutter makes of it."""

    # ---- circles and angles -------------------------------------------------------------------------------------
    @property
    def back(self) -> InvoluteSide:
        """The tooth itself."""
        return self

    @property
    def generating_shift(self) -> float:
        """x_E, generating profile shift coefficient: the shift less what the thickness allowance takes."""
        return self.profile_shift - self.thickness_allowance / (2.0 * math.tan(self.normal_pressure_angle))

    @cached_property
    def base_half_angle(self) -> float:
        """psi_b, half the tooth's angle on the base circle [rad]; that of an internal tooth may be negative."""
        thickness = math.pi / 2 + 2.0 * self.generating_shift * math.tan(self.normal_pressure_angle)
        return thickness / self.teeth + self.side * float(inv(self.pressure_angle))

    def half_thickness_angle(self, radius: ArrayLike) -> Array:
        """Half the tooth's angle [rad] between its two involutes at `radius` [modules]."""
        return self.flank_angle(radius)

    # ---- the tip ---------------------------------------------------------------------------------------------------
    def _check_tip_edge(self) -> None:
        key, size = self._edge_key, self.tip_rounding + self.tip_chamfer
        if size == 0.0 or self._edge_fits(key, size):
            return
        left = self.side * (self._involute_end(key, size) - self.form_radius)
        rule = "removes the entire involute" if not left > 0.0 else "is too large for the tip"
        low, high = 0.0, size
        for _ in range(60):
            middle = 0.5 * (low + high)
            low, high = (middle, high) if self._edge_fits(key, middle) else (low, middle)
        fits = math.floor(low * 1e4) * 1e-4
        raise GeometryError(key, f"{size:.6g}", rule, f"use at most {fits:.4f} modules")

    def _edge_fits(self, key: str, size: float) -> bool:
        """Whether a rounding or chamfer of this size leaves some involute and some tip land."""
        end = self._involute_end(key, size)
        return self.side * (end - self.form_radius) > 0.0 and self._land_half_angle(key, size, end) > 0.0
