"""What ISO/TS 6336-20, -21 and -22 ask of a gear pair: load and its factors, speed, oil, flanks."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import TYPE_CHECKING

from fegear.errors import RangeError
from fegear.formulas.flank_speeds import FlankSpeeds, flank_speeds
from fegear.formulas.flash_temperature import reduced_modulus

if TYPE_CHECKING:
    from numpy.typing import ArrayLike

    from fegear.formulas.friction_mean import Surface
    from fegear.geometry import GearPair

#: X_S, lubrication: how hot the teeth become beside the oil (ISO/TR 13989-1, clause 6; 15144-1, clause 10).
SUPPLY_FACTOR = {"dip": 1.0, "spray": 1.2, "spray-with-dip": 1.0, "submerged": 0.2}
#: X_W, structural (welding) factor of the flanks (ISO/TR 13989-1, Table 2; -2, Table 3).
STRUCTURE_FACTOR = {
    "through-hardened": 1.0,
    "phosphated": 1.25,
    "copper-plated": 1.5,
    "nitrided": 1.5,
    "case-carburized-low-austenite": 1.15,
    "case-carburized": 1.0,
    "case-carburized-high-austenite": 0.85,
    "austenitic": 0.45,
}


@dataclass(frozen=True)
class LoadFactors:
    """K_A, K_v, K_Hbeta and K_Halpha (K_Bbeta and K_Balpha of scuffing are the same).

    Parameters
    ----------
    application, dynamic, face, transverse : float
    """

    application: float = 1.0
    dynamic: float = 1.0
    face: float = 1.0
    transverse: float = 1.0

    @property
    def product(self) -> float:
        """All four."""
        return self.application * self.dynamic * self.face * self.transverse


@dataclass(frozen=True)
class RatedSurface:
    """A pair whose flanks are rated.

    Parameters
    ----------
    pair : GearPair
    speed : float
        Of the driver [rad/s].
    load : float
        F_bt, nominal force in the plane of action in the section across the axes [N].
    factors : LoadFactors
    surface : Surface
    supply : float
        X_S.
    structure : float
        X_W, the smaller one of both gears.
    tip_relief : (float, float)
        C_a of driver and driven gear [m].
    single_stiffness, mesh_stiffness : float
        c' and c_gamma per face width [Pa].
    grade : int
        ISO 1328-1 tolerance class of the flanks, the coarser one.

    Raises
    ------
    RangeError
        Where speed, load or a factor is not positive.
    """

    pair: GearPair
    speed: float
    load: float
    factors: LoadFactors
    surface: Surface
    supply: float = 1.0
    structure: float = 1.0
    tip_relief: tuple[float, float] = (0.0, 0.0)
    single_stiffness: float = 14e9
    mesh_stiffness: float = 20e9
    grade: int = 6

    def __post_init__(self) -> None:
        """Refuse what no film and no temperature can be given for."""
        if not (math.isfinite(self.speed) and self.speed > 0.0):
            raise RangeError("speed", f"{self.speed:.6g} rad/s", "must be above zero")
        if not (math.isfinite(self.load) and self.load > 0.0):
            raise RangeError("load", f"{self.load:.6g} N", "must be above zero")
        if not self.factors.product > 0.0:
            raise RangeError("load factors", self.factors.product, "must be above zero")

    @property
    def modulus(self) -> float:
        """E_r [Pa]."""
        one, other = self.pair.driver.material, self.pair.driven.material
        return reduced_modulus(
            (one.young_modulus, other.young_modulus), (one.poisson_ratio, other.poisson_ratio)
        )  # fmt: skip

    @property
    def tangential_load(self) -> float:
        """F_t at the reference cylinders [N]."""
        return self.load * math.cos(self.pair.driver.transverse_pressure_angle)

    @property
    def unit_load(self) -> float:
        """w_Bt = K_A K_v K_Bbeta K_Balpha F_t / b [N/m] (ISO/TR 13989-1, Eq. 11)."""
        return self.factors.product * self.tangential_load / self.pair.face_width

    @property
    def line_load(self) -> float:
        """The same in the plane of action, K_A K_v K_Hbeta K_Halpha F_bt / b [N/m]."""
        return self.factors.product * self.load / self.pair.face_width

    @property
    def optimal_relief(self) -> float:
        """C_eff = K_A F_t / (b cos(alpha_t) c_gamma) [m] (ISO/TR 13989-1, Eq. B.1)."""
        return self.factors.application * self.load / (self.pair.face_width * self.mesh_stiffness)

    @property
    def power(self) -> float:
        """Nominal power that the pair transmits [W]."""
        return self.load * self.speed * self.pair.driver.base_radius

    @property
    def reference_speed(self) -> float:
        """Circumferential speed of the reference cylinders [m/s]."""
        return self.speed * self.pair.driver.pitch_radius

    @property
    def pitch_line_speed(self) -> float:
        """v_t, circumferential speed of the working pitch cylinders [m/s]."""
        return self.speed * self.pair.driver.base_radius / math.cos(self.pair.working_pressure_angle)

    def at(self, x: ArrayLike) -> FlankSpeeds:
        """Curvature and speeds at places on the path of contact [m]."""
        return flank_speeds(self.pair, x, self.speed)
